//! From the study file to what each ask means: in SI, in the robot's base, checked.

use std::path::Path;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::{Answers, BranchChoice};
use armill_core::load::{LoadCases, LoadFrame};
use armill_core::map::BoxGrid;
use armill_core::nalgebra::{Point2, Point3, Vector2, Vector3};
use armill_core::path::Shape;
use armill_core::robot::JointCompliance;
use armill_core::spatial::Wrench;
use armill_core::workpiece::{Grid, Plane};
use armill_formats::document::{Document, Problem, Problems};
use armill_formats::robot::RobotDescription;

use super::format::{
    AskKind, AskTable, ComplianceTable, HalfSize, LoadFrameName, LoadTable, PlaneTable, StatementTable, StudyFile,
};
use super::places::Places;
use crate::error::StudyError;
use crate::robots;

/// Most memory that the answers of one ask may take: what a laptop can spare.
const MOST_BYTES: f64 = 4.0 * 1024.0 * 1024.0 * 1024.0;
/// What tables and pictures take beside the answers, bytes a point.
const BYTES_BESIDE: usize = 256;
/// A circle is sampled every degree where the ask says nothing.
const CIRCLE_SAMPLES: f64 = 360.0;

/// A study that can be run.
#[derive(Clone, Debug)]
pub struct Study {
    /// Title of the report.
    pub title: String,
    /// The question in words.
    pub question: Option<String>,
    /// The robot, with the compliance of the study if it brings one.
    pub robot: RobotDescription,
    /// Compliances that the study brings: their source, and whether they are assumed.
    pub own_compliance: Option<(String, bool)>,
    /// Where the load comes from.
    pub load_source: Option<String>,
    /// What is asked.
    pub asks: Vec<Ask>,
    /// What others state.
    pub statements: Vec<StatementTable>,
}

/// One ask, worked out.
#[derive(Clone, Debug)]
pub struct Ask {
    /// Its name.
    pub name: String,
    /// What it is about.
    pub subject: Subject,
}

/// What an ask is about.
#[derive(Clone, Debug)]
pub enum Subject {
    /// One plane.
    Map(Sheet),
    /// Several planes, each with its label.
    Sections(Vec<(String, Sheet)>),
    /// A box of points.
    Volume(Setting, BoxGrid),
    /// A path on a plane.
    Path(Setting, Shape, f64),
}

/// A plane with its grid.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// How the points are asked.
    pub setting: Setting,
    /// Which points.
    pub grid: Grid,
}

/// Everything that a point needs to be answered, SI, base.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Name of the frame that coordinates count from.
    pub base_name: String,
    /// That frame in base.
    pub base_from_counted: Isometry,
    /// Flange to tool centre point.
    pub flange_from_tool: Isometry,
    /// The workpiece plane.
    pub plane: Plane,
    /// Its tilt as asked, rad, where it was given by one.
    pub tilt: Option<f64>,
    /// Load cases in base.
    pub cases: Vec<Wrench>,
    /// The tolerance, m.
    pub limit: f64,
    /// Which posture.
    pub choice: BranchChoice,
}

impl Setting {
    /// Name of the posture asked for: words of a branch, or `best`.
    pub fn branch(&self) -> String {
        match self.choice {
            BranchChoice::Of(pattern) => pattern.to_string(),
            BranchChoice::Best => "best".to_owned(),
        }
    }

    /// A point of base told in the frame that the study counts from, m.
    pub fn counted(&self, in_base: &Point3<f64>) -> Point3<f64> {
        self.base_from_counted.inverse_transform_point(in_base)
    }
}

/// The study in this text; `shown` is what errors call it, robot files are looked for in `folder`.
///
/// # Errors
/// Every problem of the file, each with its place.
pub fn read(shown: &str, folder: &Path, bytes: &[u8]) -> Result<Study, StudyError> {
    let document = Document::from_bytes(shown, bytes)?;
    let file: StudyFile = document.read()?;
    let mut places = Places::new(&document, None);
    let robot = find_robot(&mut places, &file, folder)?;
    check_statements(&mut places, &file);
    let mut problems = std::mem::take(&mut places.problems);
    let mut asks = Vec::new();
    let default_ask = [whole_plane()];
    let tables = if file.ask.is_empty() { &default_ask[..] } else { &file.ask };
    for (index, table) in tables.iter().enumerate() {
        let own = (!file.ask.is_empty()).then_some(index);
        let mut places = Places::new(&document, own);
        let resolver = Resolver { file: &file, robot: robot.as_ref(), table };
        let name = table.name.clone().unwrap_or_else(|| format!("{} {}", kind_name(table.kind), index + 1));
        if let Some(subject) = resolver.subject(&mut places) {
            asks.push(Ask { name, subject });
        }
        problems.append(&mut places.problems);
    }
    problems.extend(repeated_names(&document, &file));
    Problems::from(without_repeats(problems)).into_result()?;
    let Some(robot) = robot else {
        return Err(StudyError::value(format!("{shown}: no robot"), "name one with `robot = ...`"));
    };
    Ok(Study {
        title: file.title.unwrap_or_else(|| format!("Deviation of {} under load", robot.title)),
        question: file.question,
        own_compliance: file.compliance.map(|c| (c.source, c.assumed)),
        load_source: file.load.source,
        robot,
        asks,
        statements: file.statement,
    })
}

/// An ask for one map of the study's plane.
fn whole_plane() -> AskTable {
    AskTable {
        kind: AskKind::Map,
        name: Some("map".to_owned()),
        plane: None,
        tool: None,
        load: None,
        base: None,
        limit_um: None,
        posture: None,
        distances_mm: None,
        tilts_deg: None,
        in_box: None,
        circle: None,
        line: None,
        polyline_mm: None,
        rectangle: None,
        step_mm: None,
    }
}

fn kind_name(kind: AskKind) -> &'static str {
    match kind {
        AskKind::Map => "map",
        AskKind::Sections => "sections",
        AskKind::Volume => "volume",
        AskKind::Path => "path",
    }
}

/// A value of the study that several asks take is wrong once, not once an ask.
fn without_repeats(problems: Vec<Problem>) -> Vec<Problem> {
    let mut kept: Vec<Problem> = Vec::new();
    for problem in problems {
        if !kept.contains(&problem) {
            kept.push(problem);
        }
    }
    kept
}

fn find_robot(
    places: &mut Places<'_>,
    file: &StudyFile,
    folder: &Path,
) -> Result<Option<RobotDescription>, StudyError> {
    let mut found = match robots::find(&file.robot, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            places.problem("robot", message, &hint);
            return Ok(None);
        }
        Err(problems) => return Err(problems),
    };
    if found.robot.ortho_parallel().is_none() {
        let message = format!("robot `{}` has no closed-form inverse: it can be posed by its joints only", file.robot);
        places.problem("robot", message, "maps need six joints in ortho-parallel order with a spherical wrist");
    }
    let joints = found.robot.joints().len();
    match &file.compliance {
        Some(table) => {
            if let Some(compliance) = compliance(places, table, joints) {
                let refused = |error: armill_core::robot::RobotError| StudyError::value(error.to_string(), "");
                found.robot = found.robot.with_compliance(compliance).map_err(refused)?;
            }
        }
        None if found.robot.compliance().is_none() => {
            let message = format!("no joint compliance is known for robot `{}`", file.robot);
            let hint = "measure it, or add [compliance] with rad_per_n_m = [...] (one a joint), source = \"...\", assumed = true";
            places.problem("robot", message, hint);
        }
        None => {}
    }
    Ok(Some(found))
}

fn compliance(places: &mut Places<'_>, table: &ComplianceTable, joints: usize) -> Option<Vec<JointCompliance>> {
    let before = places.problems.len();
    let lists = [("rad_per_n_m", Some(&table.rad_per_n_m)), ("u_rad_per_n_m", table.u_rad_per_n_m.as_ref())];
    for (key, list) in lists {
        let Some(list) = list else { continue };
        let path = format!("compliance.{key}");
        if list.len() != joints {
            let message = format!("{} values for the {joints} joints of the robot", list.len());
            places.problem(&path, message, "one a joint, base to flange; 0 for a rigid joint");
        }
        for (index, value) in list.iter().enumerate().filter(|(_, value)| **value < 0.0) {
            let message = format!("{value} rad/(N m) is below 0");
            places.problem(&format!("{path}[{index}]"), message, "a joint yields with its load: 0 or more");
        }
    }
    let u = table.u_rad_per_n_m.clone().unwrap_or_else(|| vec![0.0; joints]);
    (places.problems.len() == before).then(|| {
        let both = table.rad_per_n_m.iter().zip(u);
        both.map(|(value, u)| JointCompliance { value: *value, standard_uncertainty: u }).collect()
    })
}

fn check_statements(places: &mut Places<'_>, file: &StudyFile) {
    for (index, statement) in file.statement.iter().enumerate() {
        for (k, name) in statement.of.iter().enumerate() {
            if !file.ask.iter().any(|ask| ask.name.as_deref() == Some(name)) {
                let message = format!("no ask is called `{name}`");
                places.problem(&format!("statement[{index}].of[{k}]"), message, "give an ask this `name`");
            }
        }
    }
}

fn repeated_names(document: &Document, file: &StudyFile) -> Vec<Problem> {
    let named = |index: usize| file.ask[index].name.as_deref();
    let repeated = (0..file.ask.len()).filter(|i| named(*i).is_some() && (0..*i).any(|j| slug_of(named(j)) == slug_of(named(*i))));
    let problem = |i: usize| {
        let message = format!("another ask is called `{}` (or like it, for a file name)", named(i).unwrap_or_default());
        document.problem(&format!("ask[{i}].name"), message, Some("each ask needs a name of its own"))
    };
    repeated.map(problem).collect()
}

fn slug_of(name: Option<&str>) -> Option<String> {
    name.map(crate::output::slug)
}

/// One ask against its study.
struct Resolver<'a> {
    file: &'a StudyFile,
    robot: Option<&'a RobotDescription>,
    table: &'a AskTable,
}

impl Resolver<'_> {
    fn subject(&self, places: &mut Places<'_>) -> Option<Subject> {
        self.refuse_keys_of_other_kinds(places);
        let plane = self.plane_table();
        let grid = grid(places, &plane);
        let setting = self.setting(places, &plane);
        match self.table.kind {
            AskKind::Map => Some(Subject::Map(self.sheet(places, setting?, grid?)?)),
            AskKind::Sections => self.sections(places, setting?, grid?),
            AskKind::Volume => self.volume(places, setting?),
            AskKind::Path => self.path(places, setting?),
        }
    }

    fn refuse_keys_of_other_kinds(&self, places: &mut Places<'_>) {
        let t = self.table;
        let given = [
            ("distances_mm", AskKind::Sections, t.distances_mm.is_some()),
            ("tilts_deg", AskKind::Sections, t.tilts_deg.is_some()),
            ("box", AskKind::Volume, t.in_box.is_some()),
            ("circle", AskKind::Path, t.circle.is_some()),
            ("line", AskKind::Path, t.line.is_some()),
            ("polyline_mm", AskKind::Path, t.polyline_mm.is_some()),
            ("rectangle", AskKind::Path, t.rectangle.is_some()),
            ("step_mm", AskKind::Path, t.step_mm.is_some()),
        ];
        for (key, kind, _) in given.iter().filter(|(_, kind, given)| *given && *kind != t.kind) {
            let message = format!("`{key}` means nothing to a {}", kind_name(t.kind));
            let hint = format!("it belongs to kind = \"{}\"; the grid of a map is plane.step_mm", kind_name(*kind));
            places.problem(key, message, &hint);
        }
    }

    fn plane_table(&self) -> PlaneTable {
        let mut plane = self.file.plane.clone();
        if let Some(change) = &self.table.plane {
            plane.centre_mm = change.centre_mm.unwrap_or(plane.centre_mm);
            if change.tilt_deg.is_some() || change.rotation_deg.is_some() {
                (plane.tilt_deg, plane.rotation_deg) = (change.tilt_deg, change.rotation_deg);
            }
            plane.half_size_mm = change.half_size_mm.unwrap_or(plane.half_size_mm);
            plane.step_mm = change.step_mm.unwrap_or(plane.step_mm);
        }
        plane
    }

    fn setting(&self, places: &mut Places<'_>, plane: &PlaneTable) -> Option<Setting> {
        let robot = &self.robot?.robot;
        let base_name = self.table.base.clone().or_else(|| self.file.base.clone());
        let base_name = base_name.unwrap_or_else(|| crate::BASE_LINK.to_owned());
        let base_from_counted = match crate::base_from_counted(robot, &base_name) {
            Ok(frame) => frame,
            Err(known) => {
                let message = format!("robot `{}` has no frame `{base_name}`", robot.name());
                places.problem("base", message, &format!("it has: {known}"));
                return None;
            }
        };
        let choice = self.choice(places)?;
        let limit_um = self.table.limit_um.unwrap_or(self.file.limit_um);
        let (plane, tilt) = plane_at(places, plane, &base_from_counted)?;
        let load = self.table.load.as_ref().unwrap_or(&self.file.load);
        let cases = load_cases(places, load)?.in_base(&plane.base_from_part);
        let tool = self.table.tool.as_ref().or(self.file.tool.as_ref());
        let flange_from_tool = tool.map_or_else(Isometry::identity, |t| pose_mm_deg(&t.flange_from_tool_mm_deg));
        let limit = limit_um * 1e-6;
        Some(Setting { base_name, base_from_counted, flange_from_tool, plane, tilt, cases, limit, choice })
    }

    fn choice(&self, places: &mut Places<'_>) -> Option<BranchChoice> {
        let nominal = self.robot?.robot.nominal_branch();
        let posture = self.table.posture.as_ref().or(self.file.posture.as_ref());
        match crate::branch_choice(posture.map_or("nominal", |p| p.branch.as_str()), nominal) {
            Ok(choice) => Some(choice),
            Err(message) => {
                places.problem("posture.branch", message, "or write `nominal` or `best`");
                None
            }
        }
    }

    fn sheet(&self, places: &mut Places<'_>, setting: Setting, grid: Grid) -> Option<Sheet> {
        let points = grid.columns as f64 * grid.rows as f64;
        self.enough_memory(places, "plane.step_mm", points, &setting)?;
        Some(Sheet { setting, grid })
    }

    fn sections(&self, places: &mut Places<'_>, setting: Setting, grid: Grid) -> Option<Subject> {
        let mut sections = Vec::new();
        let mut add = |places: &mut Places<'_>, label: String, plane: PlaneTable| {
            let (plane, tilt) = plane_at(places, &plane, &setting.base_from_counted)?;
            let setting = Setting { plane, tilt, ..setting.clone() };
            sections.push((label, self.sheet(places, setting, grid)?));
            Some(())
        };
        match (&self.table.distances_mm, &self.table.tilts_deg) {
            (Some(distances), None) if !distances.is_empty() => {
                for distance in distances {
                    let mut plane = self.plane_table();
                    plane.centre_mm[0] = *distance;
                    add(places, format!("x = {distance} mm"), plane)?;
                }
            }
            (None, Some(tilts)) if !tilts.is_empty() => {
                for tilt in tilts {
                    let plane = PlaneTable { tilt_deg: Some(*tilt), rotation_deg: None, ..self.plane_table() };
                    add(places, format!("tilt {tilt}°").replace('-', "−"), plane)?;
                }
            }
            _ => {
                let hint = "distances_mm = [600, 800, 1000] or tilts_deg = [-60, 0, 60]";
                places.problem_here("sections vary either `distances_mm` or `tilts_deg`", hint);
                return None;
            }
        }
        Some(Subject::Sections(sections))
    }

    fn volume(&self, places: &mut Places<'_>, setting: Setting) -> Option<Subject> {
        let Some(table) = &self.table.in_box else {
            let hint = "box = { half_size_mm = [400, 400, 400], step_mm = 20 }";
            places.problem_here("a volume needs its `box`", hint);
            return None;
        };
        let half_size = sizes(places, "box.half_size_mm", &table.half_size_mm)?;
        let step = positive(places, "box.step_mm", table.step_mm)?;
        let centre = table.centre_mm.unwrap_or_else(|| self.plane_table().centre_mm);
        let centre = setting.base_from_counted * Point3::from(Vector3::from(centre) * 1e-3);
        let points: f64 = half_size.iter().map(|half| 2.0 * (half / step).floor() + 1.0).product();
        self.enough_memory(places, "box.step_mm", points, &setting)?;
        let grid = BoxGrid::within(centre, [half_size[0], half_size[1], half_size[2]], step);
        Some(Subject::Volume(setting, grid))
    }

    fn path(&self, places: &mut Places<'_>, setting: Setting) -> Option<Subject> {
        let t = self.table;
        let at = |[y, z]: [f64; 2]| Point2::new(-y * 1e-3, z * 1e-3);
        let shapes: Vec<Shape> = [
            t.circle.as_ref().map(|c| {
                let radius = c.radius_mm * 1e-3;
                Shape::Circle { centre: at(c.centre_mm.unwrap_or_default()), radius }
            }),
            t.line.as_ref().map(|l| Shape::Polyline(vec![at(l.from_mm), at(l.to_mm)])),
            t.polyline_mm.as_ref().map(|points| Shape::Polyline(points.iter().copied().map(at).collect())),
            t.rectangle.as_ref().map(|r| {
                let size = Vector2::from(r.size_mm) * 1e-3;
                Shape::rectangle(at(r.centre_mm.unwrap_or_default()), size)
            }),
        ]
        .into_iter()
        .flatten()
        .collect();
        let [shape] = &shapes[..] else {
            let hint = "circle = { radius_mm = 100 }, line, polyline_mm or rectangle";
            places.problem_here("a path has exactly one shape", hint);
            return None;
        };
        if let Some(circle) = &t.circle {
            positive(places, "circle.radius_mm", circle.radius_mm)?;
        }
        let length = shape.length();
        if length <= 0.0 {
            places.problem_here("the path has length 0 mm", "give it at least two different points");
            return None;
        }
        let step = match (t.step_mm, shape) {
            (Some(step), _) => positive(places, "step_mm", step)?,
            (None, Shape::Circle { .. }) => length / CIRCLE_SAMPLES,
            (None, Shape::Polyline(_)) => positive(places, "plane.step_mm", self.plane_table().step_mm)?,
        };
        self.enough_memory(places, "step_mm", length / step, &setting)?;
        Some(Subject::Path(setting, shape.clone(), step))
    }

    fn enough_memory(&self, places: &mut Places<'_>, path: &str, points: f64, setting: &Setting) -> Option<()> {
        let joints = self.robot?.robot.joints().len();
        let bytes = points * (Answers::bytes_per_point(joints, setting.cases.len()) + BYTES_BESIDE) as f64;
        if bytes <= MOST_BYTES {
            return Some(());
        }
        let message = format!(
            "{points:.0} points would take {:.1} GiB of memory, more than {:.0} GiB",
            bytes / 1024_f64.powi(3),
            MOST_BYTES / 1024_f64.powi(3)
        );
        places.problem(path, message, "a larger step, or a smaller plane");
        None
    }
}

fn positive(places: &mut Places<'_>, path: &str, value_mm: f64) -> Option<f64> {
    if value_mm > 0.0 {
        return Some(value_mm * 1e-3);
    }
    places.problem(path, format!("{value_mm} mm is not above 0 mm"), "a length above 0");
    None
}

fn sizes(places: &mut Places<'_>, path: &str, half_size_mm: &[f64]) -> Option<Vec<f64>> {
    if half_size_mm.iter().all(|half| *half >= 0.0) {
        return Some(half_size_mm.iter().map(|half| half * 1e-3).collect());
    }
    places.problem(path, "a half size is below 0 mm", "0 (a single line of points) or more");
    None
}

fn grid(places: &mut Places<'_>, plane: &PlaneTable) -> Option<Grid> {
    let step = positive(places, "plane.step_mm", plane.step_mm);
    let half_mm = match plane.half_size_mm {
        HalfSize::Square(half) => [half, half],
        HalfSize::Oblong(halves) => halves,
    };
    let half = sizes(places, "plane.half_size_mm", &half_mm);
    let (step, half) = (step?, half?);
    // Counted as numbers first: a grid too large for memory must not overflow an index.
    if half.iter().any(|h| h / step > 1e8) {
        let message = format!("a grid of {:.0e} points", half.iter().map(|h| 2.0 * h / step).product::<f64>());
        let bytes = half.iter().map(|h| 2.0 * h / step).product::<f64>() * 500.0 / 1024_f64.powi(3);
        places.problem("plane.step_mm", format!("{message} would take about {bytes:.1e} GiB of memory"), "a larger step");
        return None;
    }
    Some(Grid::within([half[0], half[1]], step))
}

fn plane_at(places: &mut Places<'_>, table: &PlaneTable, base_from_counted: &Isometry) -> Option<(Plane, Option<f64>)> {
    let centre = Point3::from(Vector3::from(table.centre_mm) * 1e-3);
    let (counted_from_part, tilt) = match (table.tilt_deg, table.rotation_deg) {
        (Some(_), Some(_)) => {
            places.problem("plane.rotation_deg", "a plane has either `tilt_deg` or `rotation_deg`", "remove one");
            return None;
        }
        (None, Some(angles)) => {
            let rotation = Vector3::from(angles).map(f64::to_radians);
            (from_xyz_and_fixed_angles(centre.coords, rotation), None)
        }
        (tilt, None) => {
            let tilt = tilt.unwrap_or(0.0).to_radians();
            (Plane::tilted(centre, tilt).base_from_part, Some(tilt))
        }
    };
    Some((Plane { base_from_part: base_from_counted * counted_from_part }, tilt))
}

fn load_cases(places: &mut Places<'_>, table: &LoadTable) -> Option<LoadCases> {
    if table.cases_n.is_empty() {
        places.problem("load.cases_n", "the load has no case", "cases_n = [[3, 5, 5]]: force on the tool, x, y, z");
        return None;
    }
    let moments = table.moments_n_m.clone().unwrap_or_else(|| vec![[0.0; 3]; table.cases_n.len()]);
    if moments.len() != table.cases_n.len() {
        let message = format!("{} moments for {} cases", moments.len(), table.cases_n.len());
        places.problem("load.moments_n_m", message, "one a case, in the same order");
        return None;
    }
    let cases = table.cases_n.iter().zip(moments).map(|(f, m)| Wrench { force: (*f).into(), moment: m.into() });
    let frame = match table.frame {
        None | Some(LoadFrameName::Base) => LoadFrame::Base,
        Some(LoadFrameName::Part) => LoadFrame::Part,
    };
    Some(LoadCases { frame, cases: cases.collect() })
}

/// The pose of six numbers: x, y, z in mm, turns about fixed x, y, z in degrees.
pub fn pose_mm_deg(values: &[f64; 6]) -> Isometry {
    let [x, y, z, rx, ry, rz] = *values;
    let angles = Vector3::new(rx, ry, rz).map(f64::to_radians);
    from_xyz_and_fixed_angles(Vector3::new(x, y, z) * 1e-3, angles)
}

//! One ask against its study: what it does not say it takes from there.

use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::load::{Doubt, LoadCases, LoadFrame};
use armill_core::map::BoxGrid;
use armill_core::nalgebra::{Point2, Point3, Vector2, Vector3};
use armill_core::path::Shape;
use armill_core::robot::BranchPattern;
use armill_core::workpiece::Grid;
use armill_formats::robot::RobotDescription;

use super::cut::{self, CutTable};
use super::drill;
use super::format::{AskKind, AskTable, LoadFrameName, LoadTable, PlaneTable, PostureTable, StudyFile};
use super::measured::SynchroniseName;
use super::memory;
use super::places::Places;
use super::program::{self, Pushes};
use super::quantities::{grid, load_cases, plane_at, pose_mm_deg, positive, sizes};
use super::resolve::{Setting, Sheet, Subject};
use super::stiffness;
use crate::StudyError;

mod reason;

/// A circle is sampled every degree where the ask says nothing.
const CIRCLE_SAMPLES: f64 = 360.0;

/// The word for a kind of ask.
pub(super) fn kind_name(kind: AskKind) -> &'static str {
    match kind {
        AskKind::Map => "map",
        AskKind::Sections => "sections",
        AskKind::Volume => "volume",
        AskKind::Path => "path",
        AskKind::Program => "program",
    }
}

/// One ask against its study.
pub(super) struct Resolver<'a> {
    pub file: &'a StudyFile,
    pub robot: Option<&'a RobotDescription>,
    pub table: &'a AskTable,
    /// Where files of the study are looked for.
    pub folder: &'a Path,
}

impl Resolver<'_> {
    /// What the ask is about; `None` where it has problems.
    ///
    /// # Errors
    /// The problems of a file that the ask names.
    pub(super) fn subject(&self, places: &mut Places<'_>) -> Result<Option<Subject>, StudyError> {
        self.refuse_keys_of_other_kinds(places);
        if self.load().is_none() && !self.brings_forces() {
            let hint = "[load] cases_n = [[3, 5, 5]]: force on the tool, x, y, z; along a program [cut] does as well";
            places.problem(
                "load",
                "nothing pushes on the tool: the study has no `load`",
                hint,
            );
        }
        self.refuse_what_no_cell_has(places);
        let plane = self.plane_table();
        let grid = grid(places, &plane);
        let setting = self.setting(places, &plane);
        // Each is checked whether the others are fine or not: all problems are told at once.
        Ok(match self.table.kind {
            AskKind::Map => setting
                .zip(grid)
                .and_then(|(setting, grid)| self.sheet(places, setting, grid))
                .map(Subject::Map),
            AskKind::Sections => self.sections(places, setting, grid),
            AskKind::Volume => self.volume(places, setting),
            AskKind::Path => self.path(places, setting),
            AskKind::Program => self.program(places, setting)?,
        })
    }

    fn program(
        &self,
        places: &mut Places<'_>,
        setting: Option<Setting>,
    ) -> Result<Option<Subject>, StudyError> {
        let Some(table) = &self.table.program else {
            let hint = "program = { file = \"part.ngc\" }";
            places.problem_here("a program needs its `program`", hint);
            return Ok(None);
        };
        let pushes = match (self.cut(), self.load()) {
            (cut, _) if table.measured.is_some() => self.measured(places, cut),
            _ if table.drill.is_some() => self.drill(places),
            (Some(cut), _) => cut::resolve(places, cut).map(|cut| Pushes::Cut(Box::new(cut))),
            (None, Some(load)) => load_cases(places, load).map(Pushes::Cases),
            (None, None) => None,
        };
        let Some((setting, pushes)) = setting.zip(pushes) else {
            return Ok(None);
        };
        let read = program::read(places, table, self.folder, setting, pushes)?;
        Ok(read.map(|read| Subject::Program(Box::new(read))))
    }

    fn load(&self) -> Option<&LoadTable> {
        self.table.load.as_ref().or(self.file.load.as_ref())
    }

    /// The cut that takes the place of the load: of a program that has no load of its own.
    fn cut(&self) -> Option<&CutTable> {
        let of_study = self.file.cut.as_ref().filter(|_| self.table.load.is_none());
        let cut = self.table.cut.as_ref().or(of_study);
        cut.filter(|_| self.table.kind == AskKind::Program)
    }

    /// Whether the forces come with the program: from its cut, its drill, or as they were measured.
    fn brings_forces(&self) -> bool {
        let program = self.table.program.as_ref();
        let brings = program.is_some_and(|program| program.measured.is_some() || program.drill.is_some());
        self.cut().is_some() || brings && self.table.kind == AskKind::Program
    }

    /// Measured forces, with the cut if it is to predict them.
    fn measured(&self, places: &mut Places<'_>, cut: Option<&CutTable>) -> Option<Pushes> {
        if self.table.load.is_some() {
            let message = "this program has measured forces and a load";
            places.problem("load", message, "remove one");
            return None;
        }
        let program = self.table.program.as_ref()?;
        if program.drill.is_some() {
            let message = "this program has measured forces and a drill";
            places.problem("program.drill", message, "remove one");
            return None;
        }
        let measured = program.measured.as_ref()?;
        let predicts = measured.synchronise == Some(SynchroniseName::Predicted);
        match cut.filter(|_| predicts) {
            Some(cut) => Some(Pushes::Measured(Some(Box::new(cut::resolve(places, cut)?)))),
            None => Some(Pushes::Measured(None)),
        }
    }

    /// The drill, if nothing else pushes.
    fn drill(&self, places: &mut Places<'_>) -> Option<Pushes> {
        let program = self.table.program.as_ref()?;
        if self.table.load.is_some() || self.table.cut.is_some() {
            let message = "this program has a drill, and a load or a cut";
            places.problem("program.drill", message, "remove one");
            return None;
        }
        let drill = drill::resolve(places, program.drill.as_ref()?)?;
        Some(Pushes::Drill(Box::new(drill)))
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
            ("program", AskKind::Program, t.program.is_some()),
            ("cut", AskKind::Program, t.cut.is_some()),
        ];
        if t.kind != AskKind::Program
            && matches!(self.load().and_then(|load| load.frame), Some(LoadFrameName::Feed))
        {
            let message = format!("a {} has no feed that a load could turn with", kind_name(t.kind));
            places.problem("load.frame", message, "`base` or `part`; `feed` along a program");
        }
        for (key, kind, _) in given.iter().filter(|(_, kind, given)| *given && *kind != t.kind) {
            let message = format!("`{key}` means nothing to a {}", kind_name(t.kind));
            let hint = format!(
                "it belongs to kind = \"{}\"; the grid of a map is plane.step_mm",
                kind_name(*kind)
            );
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
        let base_name = self.table.base.clone().or_else(|| self.file.base.clone());
        let base_name = base_name.unwrap_or_else(|| crate::BASE_LINK.to_owned());
        let base_from_counted = self.base_from_counted(places, &base_name);
        let choice = self.choice(places);
        let home = self.home(places);
        let limit_um = self.table.limit_um.unwrap_or(self.file.limit_um);
        let plane = plane_at(
            places,
            plane,
            &base_from_counted.unwrap_or_else(Isometry::identity),
        );
        // The forces of a cut, and measured ones, come with the program.
        let load = self.load().filter(|_| !self.brings_forces());
        let cases = match load {
            Some(load) => load_cases(places, load),
            None => Some(LoadCases {
                frame: LoadFrame::Base,
                cases: Vec::new(),
            }),
        };
        let tool = self.table.tool.as_ref().or(self.file.tool.as_ref());
        let model = self
            .robot
            .and_then(|found| stiffness::model(places, self.file, tool, &found.robot));
        let (base_from_counted, choice, (plane, tilt)) = (base_from_counted?, choice?, plane?);
        let (model, cases) = (model?, cases?);
        let doubt = Doubt {
            relative: load.and_then(|load| load.u_percent).unwrap_or(0.0) / 100.0,
            tool_length: tool.and_then(|t| t.u_length_mm).unwrap_or(0.0) * 1e-3,
            ..Doubt::NONE
        };
        let u_n = load.and_then(|load| load.u_n).unwrap_or_default();
        // What turns with the feed the program turns; here it is told as if the feed went along part x.
        let frame = match cases.frame {
            LoadFrame::Feed => LoadFrame::Part,
            told => told,
        };
        let cases = LoadCases { frame, ..cases };
        let doubt = doubt.of_components(u_n, frame, &plane.base_from_part)?;
        let cases = cases.in_base(&plane.base_from_part)?;
        let flange_from_tool =
            tool.map_or_else(Isometry::identity, |t| pose_mm_deg(&t.flange_from_tool_mm_deg));
        let limit = limit_um * 1e-6;
        Some(Setting {
            base_name,
            base_from_counted,
            flange_from_tool,
            model,
            plane,
            tilt,
            cases,
            doubt,
            limit,
            choice,
            home,
        })
    }

    fn base_from_counted(&self, places: &mut Places<'_>, name: &str) -> Option<Isometry> {
        let robot = &self.robot?.robot;
        let found = crate::base_from_counted(robot, name);
        let tell = |known: String| {
            let message = format!("robot `{}` has no frame `{name}`", robot.name());
            places.problem("base", message, &format!("it has: {known}"));
        };
        found.map_err(tell).ok()
    }

    fn posture(&self) -> Option<&PostureTable> {
        self.table.posture.as_ref().or(self.file.posture.as_ref())
    }

    fn choice(&self, places: &mut Places<'_>) -> Option<BranchChoice> {
        let words = self.posture().map_or("nominal", |p| p.branch.as_str());
        let choice = match self.robot {
            Some(found) => crate::branch_choice_of(&found.robot, words),
            None => crate::branch_choice(words, BranchPattern::FRONT_ELBOW_UP),
        };
        let tell = |message| places.problem("posture.branch", message, "or write `nominal` or `best`");
        choice.map_err(tell).ok()
    }

    /// Where a rail stands and what joints to spare are drawn to; `None` also where that is wrong.
    fn home(&self, places: &mut Places<'_>) -> Option<Vec<f64>> {
        let given = self.posture()?.home_deg.as_ref()?;
        match crate::pose::joint_positions(self.robot?, given) {
            Ok(home) => Some(home),
            Err(StudyError::Value { message, hint }) => {
                places.problem("posture.home_deg", message, &hint);
                None
            }
            Err(_) => None,
        }
    }

    fn sheet(&self, places: &mut Places<'_>, setting: Setting, grid: Grid) -> Option<Sheet> {
        let points = grid.columns as f64 * grid.rows as f64;
        self.enough_memory(places, "plane.step_mm", points, &setting)?;
        Some(Sheet { setting, grid })
    }

    fn sections(
        &self,
        places: &mut Places<'_>,
        setting: Option<Setting>,
        grid: Option<Grid>,
    ) -> Option<Subject> {
        let given = |list: &Option<Vec<f64>>| list.as_ref().is_some_and(|list| !list.is_empty());
        if given(&self.table.distances_mm) == given(&self.table.tilts_deg) {
            let hint = "distances_mm = [600, 800, 1000] or tilts_deg = [-60, 0, 60]";
            places.problem_here("sections vary either `distances_mm` or `tilts_deg`", hint);
            return None;
        }
        let lists = [
            ("distances_mm", &self.table.distances_mm),
            ("tilts_deg", &self.table.tilts_deg),
        ];
        for (key, values) in lists {
            let values = values.as_deref().unwrap_or_default();
            for i in (1..values.len()).filter(|i| values[..*i].contains(&values[*i])) {
                let message = format!("{} stands twice in `{key}`", values[i]);
                places.problem(
                    &format!("{key}[{i}]"),
                    message,
                    "each section once: its name comes of it",
                );
            }
        }
        let (setting, grid) = (setting?, grid?);
        let mut sections = Vec::new();
        let mut add = |places: &mut Places<'_>, label: String, plane: PlaneTable| {
            let (plane, tilt) = plane_at(places, &plane, &setting.base_from_counted)?;
            let setting = Setting {
                plane,
                tilt,
                ..setting.clone()
            };
            sections.push((label, self.sheet(places, setting, grid)?));
            Some(())
        };
        for distance in self.table.distances_mm.iter().flatten() {
            let mut plane = self.plane_table();
            plane.centre_mm[0] = *distance;
            add(places, format!("x = {distance} mm"), plane)?;
        }
        for tilt in self.table.tilts_deg.iter().flatten() {
            let plane = PlaneTable {
                tilt_deg: Some(*tilt),
                rotation_deg: None,
                ..self.plane_table()
            };
            add(places, format!("tilt {tilt} deg"), plane)?;
        }
        Some(Subject::Sections(sections))
    }

    fn volume(&self, places: &mut Places<'_>, setting: Option<Setting>) -> Option<Subject> {
        let Some(table) = &self.table.in_box else {
            let hint = "box = { half_size_mm = [400, 400, 400], step_mm = 20 }";
            places.problem_here("a volume needs its `box`", hint);
            return None;
        };
        let half_size = sizes(places, "box.half_size_mm", &table.half_size_mm);
        let step = positive(places, "box.step_mm", table.step_mm);
        let (half_size, step, setting) = (half_size?, step?, setting?);
        let centre = table.centre_mm.unwrap_or_else(|| self.plane_table().centre_mm);
        let centre = setting.base_from_counted * Point3::from(Vector3::from(centre) * 1e-3);
        let points: f64 = half_size
            .iter()
            .map(|half| 2.0 * (half / step).floor() + 1.0)
            .product();
        self.enough_memory(places, "box.step_mm", points, &setting)?;
        let grid = BoxGrid::within(centre, [half_size[0], half_size[1], half_size[2]], step);
        Some(Subject::Volume(setting, grid))
    }

    fn path(&self, places: &mut Places<'_>, setting: Option<Setting>) -> Option<Subject> {
        let t = self.table;
        let at = |[y, z]: [f64; 2]| Point2::new(-y * 1e-3, z * 1e-3);
        let shapes: Vec<Shape> = [
            t.circle.as_ref().map(|c| {
                let radius = c.radius_mm * 1e-3;
                Shape::Circle {
                    centre: at(c.centre_mm.unwrap_or_default()),
                    radius,
                }
            }),
            t.line
                .as_ref()
                .map(|l| Shape::Polyline(vec![at(l.from_mm), at(l.to_mm)])),
            t.polyline_mm
                .as_ref()
                .map(|points| Shape::Polyline(points.iter().copied().map(at).collect())),
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
            places.problem_here(
                "the path has length 0 mm",
                "give it at least two different points",
            );
            return None;
        }
        let step = match (t.step_mm, shape) {
            (Some(step), _) => positive(places, "step_mm", step)?,
            (None, Shape::Circle { .. }) => length / CIRCLE_SAMPLES,
            (None, Shape::Polyline(_)) => positive(places, "plane.step_mm", self.plane_table().step_mm)?,
        };
        let setting = setting?;
        self.enough_memory(places, "step_mm", length / step, &setting)?;
        Some(Subject::Path(setting, shape.clone(), step))
    }

    fn enough_memory(
        &self,
        places: &mut Places<'_>,
        path: &str,
        points: f64,
        setting: &Setting,
    ) -> Option<()> {
        memory::check_points(places, path, points, (self.robot?, setting))
    }
}

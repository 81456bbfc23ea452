//! One ask against its study: what it does not say it takes from there.
//!
//! | of the ask | against the study's |
//! |---|---|
//! | `plane`, `posture` | key by key; one way of telling the rotation of a plane replaces the other |
//! | `tool`, `load`, `cut`, `base`, `tolerance_um` | in place of it, whole |
//!
//! Every part is checked whether the others are fine or not, so that all problems of an ask are told at once. Along a
//! path the study's cut comes before its load.

use std::path::Path;
use std::sync::Arc;

use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::load::{InputUncertainty, LoadCases, LoadFrame};
use armill_core::map::BoxGrid;
use armill_core::nalgebra::{Translation3, Vector3};
use armill_core::optimize::PostureSearch;
use armill_core::robot::{BranchPattern, Robot};
use armill_core::workpiece::Grid;
use armill_formats::robot::RobotDescription;

use super::format::{AnalysisKind, AnalysisTable, LoadFrameName, PlaneTable, PostureTable, StudyFile, ToolTable};
use super::holes;
use super::memory;
use super::path::{self, Push};
use super::places::Places;
use super::posture_search::{ComponentName, SearchTable};
use super::quantities::{grid, load_cases, plane_at, pose_mm_deg, sizes, step};
use super::resolve::{Setting, Sheet, Subject};
use super::stiffness;
use crate::StudyError;

/// The word for a kind of ask.
pub(crate) fn kind_name(kind: AnalysisKind) -> &'static str {
    match kind {
        AnalysisKind::Map => "map",
        AnalysisKind::Sections => "sections",
        AnalysisKind::Volume => "volume",
        AnalysisKind::Path => "path",
        AnalysisKind::Holes => "holes",
    }
}

/// What one of this kind is called in a sentence.
pub(super) fn kind_noun(kind: AnalysisKind) -> &'static str {
    match kind {
        AnalysisKind::Holes => "set of holes",
        other => kind_name(other),
    }
}

/// The plane of the study with what the ask changes of it.
pub(crate) fn plane_of(file: &StudyFile, analysis: &AnalysisTable) -> PlaneTable {
    let mut plane = file.plane.clone();
    if let Some(change) = &analysis.plane {
        plane.centre_mm = change.centre_mm.unwrap_or(plane.centre_mm);
        if change.tilt_deg.is_some() || change.rotation_deg.is_some() {
            (plane.tilt_deg, plane.rotation_deg) = (change.tilt_deg, change.rotation_deg);
        }
        plane.half_size_mm = change.half_size_mm.unwrap_or(plane.half_size_mm);
        plane.step_mm = change.step_mm.unwrap_or(plane.step_mm);
    }
    plane
}

/// One ask against its study.
pub(super) struct Resolver<'a> {
    pub file: &'a StudyFile,
    pub robot: Option<&'a RobotDescription>,
    /// The robot as it was measured, where its controller reckons with `robot`.
    pub actual: Option<&'a Arc<Robot>>,
    pub table: &'a AnalysisTable,
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
        let push = Push::of(self.file, self.table);
        if push.is_none() {
            let hint =
                "[load] cases_n = [[3, 5, 5]]: force on the tool, x, y, z; along a path [cut] does as well";
            places.problem(
                "load",
                "nothing pushes on the tool: the study has no `load`",
                hint,
            );
        }
        Push::refuse_two(places, self.table);
        let plane = self.plane_table();
        let grid = grid(places, &plane);
        let setting = self.setting(places, &plane, push);
        // Each is checked whether the others are fine or not: all problems are told at once.
        Ok(match self.table.kind {
            AnalysisKind::Map => setting
                .zip(grid)
                .and_then(|(setting, grid)| self.sheet(places, setting, grid))
                .map(Subject::Map),
            AnalysisKind::Sections => self.sections(places, setting.and(push), grid),
            AnalysisKind::Volume => self.volume(places, setting),
            AnalysisKind::Path => {
                let table = (self.table, plane.step_mm);
                let cell = (self.folder, self.robot.map(|found| &found.robot));
                let path = path::resolve(places, table, cell, (setting, push))?;
                path.and_then(|path| {
                    let of = (self.robot?, &path.setting, path.load.case_count());
                    let points = (AnalysisKind::Path, path.track.len() as f64);
                    memory::check_points(places, "step_mm", points, of)?;
                    Some(Subject::Path(Box::new(path)))
                })
            }
            AnalysisKind::Holes => {
                let search = setting
                    .as_ref()
                    .and_then(|setting| self.hole_search(places, setting));
                let cell = (self.folder, self.robot.map(|found| &found.robot));
                let holes = holes::resolve(places, self.table, cell, (setting, push, search))?;
                holes.and_then(|holes| {
                    let path = &holes.path;
                    let of = (self.robot?, &path.setting, path.load.case_count());
                    let points = (AnalysisKind::Holes, path.track.len() as f64);
                    memory::check_points(places, "holes", points, of)?;
                    Some(Subject::Holes(Box::new(holes)))
                })
            }
        })
    }

    /// Tells keys that mean nothing to this kind of ask, and a load that turns with a feed where nothing feeds: no key
    /// is passed over in silence.
    fn refuse_keys_of_other_kinds(&self, places: &mut Places<'_>) {
        let t = self.table;
        let search = t.posture.as_ref().and_then(|posture| posture.search.as_ref());
        // What two kinds have belongs to the one that is asked.
        let with_tool = match t.kind {
            AnalysisKind::Holes => AnalysisKind::Holes,
            _ => AnalysisKind::Path,
        };
        let given = [
            ("distances_mm", AnalysisKind::Sections, t.distances_mm.is_some()),
            ("tilts_deg", AnalysisKind::Sections, t.tilts_deg.is_some()),
            ("box", AnalysisKind::Volume, t.in_box.is_some()),
            ("circle", AnalysisKind::Path, t.circle.is_some()),
            ("line", AnalysisKind::Path, t.line.is_some()),
            ("polyline_mm", AnalysisKind::Path, t.polyline_mm.is_some()),
            ("rectangle", AnalysisKind::Path, t.rectangle.is_some()),
            ("step_mm", AnalysisKind::Path, t.step_mm.is_some()),
            ("program", with_tool, t.program.is_some()),
            ("spin_deg", AnalysisKind::Path, t.spin_deg.is_some()),
            ("cut", AnalysisKind::Path, t.cut.is_some()),
            ("posture.search", with_tool, search.is_some()),
            ("holes", AnalysisKind::Holes, t.holes.is_some()),
        ];
        let load = t.load.as_ref().or(self.file.load.as_ref());
        if t.kind != with_tool && load.and_then(|load| load.frame) == Some(LoadFrameName::Feed) {
            let message = format!("a {} has no feed that a load could turn with", kind_noun(t.kind));
            places.problem("load.frame", message, "`base` or `part`; `feed` along a path");
        }
        for (key, kind, _) in given.iter().filter(|(_, kind, given)| *given && *kind != t.kind) {
            let message = format!("`{key}` means nothing to a {}", kind_noun(t.kind));
            let hint = format!(
                "it belongs to kind = \"{}\"; the grid of a map is plane.step_mm",
                kind_name(*kind)
            );
            places.problem(key, message, &hint);
        }
    }

    /// The plane of the study with what the ask changes of it.
    fn plane_table(&self) -> PlaneTable {
        plane_of(self.file, self.table)
    }

    /// What all points of the ask share; `None` where something of it is wrong, told at its place. Forces that come
    /// with a path leave the cases empty.
    fn setting(
        &self,
        places: &mut Places<'_>,
        plane: &PlaneTable,
        push: Option<Push<'_>>,
    ) -> Option<Setting> {
        let base_name = self.table.base.clone().or_else(|| self.file.base.clone());
        let base_name = base_name.unwrap_or_else(|| crate::BASE_LINK.to_owned());
        let base_from_reference = self.base_from_reference(places, &base_name);
        let choice = self.choice(places);
        let home = self.home(places);
        // Words bound a search; without any, each branch is tried.
        let reported = self.of_posture(|posture| posture.branch.as_ref());
        let open = match (reported, choice) {
            (Some(_), Some(BranchChoice::Of(pattern))) => pattern,
            _ => BranchPattern::default(),
        };
        let search = self.search(places, open);
        let tolerance_um = self.table.tolerance_um.unwrap_or(self.file.tolerance_um);
        let plane = plane_at(
            places,
            plane,
            &base_from_reference.unwrap_or_else(Isometry::identity),
        );
        // Other forces come with the path.
        let given = match push {
            Some(Push::Load(table)) => Some(table),
            _ => None,
        };
        let load = match given {
            Some(table) => load_cases(places, table),
            None => Some(LoadCases {
                frame: LoadFrame::Base,
                cases: Vec::new(),
            }),
        };
        let tool = self.table.tool.as_ref().or(self.file.tool.as_ref());
        let model = self
            .robot
            .and_then(|found| stiffness::model(places, self.file, tool, (&found.robot, self.actual)));
        let (base_from_reference, choice, (plane, tilt)) = (base_from_reference?, choice?, plane?);
        let (model, load) = (model?, load?);
        let uncertainty = InputUncertainty {
            relative: given.and_then(|load| load.u_percent).unwrap_or(0.0) / 100.0,
            tool_length: tool.and_then(|t| t.length_u_mm).unwrap_or(0.0) * 1e-3,
            ..InputUncertainty::NONE
        };
        let u_n = given.and_then(|load| load.u_n).unwrap_or_default();
        // What turns with the feed turns on the path; here it is as if the feed went along x of the part.
        let frame = match load.frame {
            LoadFrame::Feed => LoadFrame::Part,
            reported => reported,
        };
        let as_told = LoadCases {
            frame,
            ..load.clone()
        };
        let uncertainty = uncertainty.of_components(u_n, frame, &plane.base_from_part)?;
        let cases = as_told.in_base(&plane.base_from_part)?;
        let flange_from_tool =
            tool.map_or_else(Isometry::identity, |t| pose_mm_deg(&t.flange_from_tool_mm_deg));
        let limit = tolerance_um * 1e-6;
        Some(Setting {
            base_name,
            base_from_reference,
            flange_from_tool,
            model,
            plane,
            tilt,
            load,
            cases,
            load_source: given.and_then(|load| load.source.clone()),
            tool_sources: tool.map_or_else(Vec::new, ToolTable::sources),
            uncertainty,
            limit,
            choice,
            home,
            open,
            search,
        })
    }

    /// What is searched for along a path; `None` also where that is wrong.
    fn search(&self, places: &mut Places<'_>, open: BranchPattern) -> Option<PostureSearch> {
        let table = self.of_posture(|posture| posture.search.as_ref());
        let table = table.filter(|_| self.table.kind == AnalysisKind::Path)?;
        let tolerance_um = self.table.tolerance_um.unwrap_or(self.file.tolerance_um);
        table.resolve(places, tolerance_um * 1e-6, open)
    }

    /// What is searched for at holes, as usual where nothing is said; `None` also where that is wrong. Each hole is for
    /// itself: what joins points of a path has no meaning.
    fn hole_search(&self, places: &mut Places<'_>, setting: &Setting) -> Option<PostureSearch> {
        let own = self
            .table
            .posture
            .as_ref()
            .and_then(|posture| posture.search.as_ref());
        let given = [
            ("goal", own.is_some_and(|table| table.objective.is_some())),
            (
                "turn_deg_per_mm",
                own.is_some_and(|table| table.turn_deg_per_mm.is_some()),
            ),
            (
                "reversal_um_mm",
                own.is_some_and(|table| table.reversal_um_mm.is_some()),
            ),
        ];
        for (key, _) in given.iter().filter(|(_, given)| *given) {
            let message = format!("`{key}` means nothing to holes: each is held for itself");
            places.problem(
                &format!("posture.search.{key}"),
                message,
                "it belongs to kind = \"path\"",
            );
        }
        let table = self.of_posture(|posture| posture.search.as_ref());
        if table.and_then(|table| table.counts) == Some(ComponentName::CrossTrack) {
            let hint = "`in-plane` or `axial`";
            places.problem("posture.search.counts", "a hole has no track to go across", hint);
            return None;
        }
        let usual = SearchTable::default();
        table
            .unwrap_or(&usual)
            .resolve(places, setting.limit, setting.open)
    }

    /// The frame that coordinates count from, in base.
    fn base_from_reference(&self, places: &mut Places<'_>, name: &str) -> Option<Isometry> {
        let robot = &self.robot?.robot;
        let found = crate::base_from_reference(robot, name);
        let tell = |known: String| {
            let message = format!("robot `{}` has no frame `{name}`", robot.name());
            places.problem("base", message, &format!("it has: {known}"));
        };
        found.map_err(tell).ok()
    }

    /// Of the posture what the ask says, else what the study says.
    fn of_posture<T>(&self, get: impl Fn(&'_ PostureTable) -> Option<&T>) -> Option<&T> {
        let own = self.table.posture.as_ref().and_then(&get);
        own.or_else(|| self.file.posture.as_ref().and_then(&get))
    }

    /// The posture asked for, of this robot where it is known.
    fn choice(&self, places: &mut Places<'_>) -> Option<BranchChoice> {
        let words = self.of_posture(|posture| posture.branch.as_ref());
        let words = words.map_or("nominal", String::as_str);
        let choice = match self.robot {
            Some(found) => crate::branch_choice_of(&found.robot, words),
            None => crate::naming::branch_choice(words, BranchPattern::FRONT_ELBOW_UP),
        };
        let tell = |message| places.problem("posture.branch", message, "or write `nominal` or `best`");
        choice.map_err(tell).ok()
    }

    /// Where a rail stands and what joints to spare are drawn to; `None` also where that is wrong.
    fn home(&self, places: &mut Places<'_>) -> Option<Vec<f64>> {
        let given = self.of_posture(|posture| posture.home_deg.as_ref())?;
        match crate::pose::joint_positions(self.robot?, given) {
            Ok(home) => Some(home),
            Err(StudyError::Value { message, hint }) => {
                places.problem("posture.home_deg", message, &hint);
                None
            }
            Err(_) => None,
        }
    }

    /// The plane with its grid, if its answers fit into memory.
    fn sheet(&self, places: &mut Places<'_>, setting: Setting, grid: Grid) -> Option<Sheet> {
        let points = grid.columns as f64 * grid.rows as f64;
        self.enough_memory(places, "plane.step_mm", points, &setting)?;
        Some(Sheet { setting, grid })
    }

    /// The planes of a series, each with its label: the centre at each distance, or the plane at each tilt.
    fn sections(
        &self,
        places: &mut Places<'_>,
        push: Option<Push<'_>>,
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
        let (push, grid) = (push?, grid?);
        let mut sections = Vec::new();
        let mut add = |places: &mut Places<'_>, label: String, plane: PlaneTable| {
            // A load told in the part turns with the plane of each section.
            let setting = self.setting(places, &plane, Some(push))?;
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

    /// The points of a box along the axes that its centre is told in.
    fn volume(&self, places: &mut Places<'_>, setting: Option<Setting>) -> Option<Subject> {
        let Some(table) = &self.table.in_box else {
            let hint = "box = { half_size_mm = [400, 400, 400], step_mm = 20 }";
            places.problem_here("a volume needs its `box`", hint);
            return None;
        };
        let half_size = sizes(places, "box.half_size_mm", &table.half_size_mm);
        let step = step(places, "box.step_mm", table.step_mm);
        let (half_size, step, setting) = (half_size?, step?, setting?);
        let centre = table.centre_mm.unwrap_or_else(|| self.plane_table().centre_mm);
        // The sides of the box go along the axes that its centre is told in.
        let base_from_centre = setting.base_from_reference * Translation3::from(Vector3::from(centre) * 1e-3);
        let points: f64 = half_size
            .iter()
            .map(|half| 2.0 * (half / step).floor() + 1.0)
            .product();
        self.enough_memory(places, "box.step_mm", points, &setting)?;
        let grid = BoxGrid::within(
            &base_from_centre,
            [half_size[0], half_size[1], half_size[2]],
            step,
        );
        Some(Subject::Volume(setting, grid))
    }

    /// `None`, and a problem at `path`, where so many points take more memory than a study may.
    fn enough_memory(
        &self,
        places: &mut Places<'_>,
        path: &str,
        points: f64,
        setting: &Setting,
    ) -> Option<()> {
        let of = (self.robot?, setting, setting.cases.len());
        memory::check_points(places, path, (self.table.kind, points), of)
    }
}

//! One analysis resolved against its study: what it does not specify is taken from the study.
//!
//! | key of the analysis | effect on that of the study |
//! |---|---|
//! | `plane`, `posture` | merged key by key; one specification of the rotation of a plane replaces the other |
//! | `tool`, `load`, `cut`, `base`, `tolerance_um` | replaced as a whole |
//!
//! Every part is checked even if others have problems, so that all problems of an analysis are reported at once. Along
//! a path the cut of the study takes precedence over its load.

use std::path::Path;
use std::sync::Arc;

use armill_core::clearance::ArmBody;
use armill_core::frame::Isometry;
use armill_core::kernel::BranchChoice;
use armill_core::load::{InputUncertainty, LoadCases, LoadFrame};
use armill_core::nalgebra::{Matrix3, Rotation3, Vector3};
use armill_core::optimize::PostureSearch;
use armill_core::robot::{BranchPattern, Damping, Robot};
use armill_core::source::StiffnessModel;
use armill_core::units::{from_deg, from_mm, from_um};
use armill_core::workpiece::{Grid, Plane};
use armill_formats::robot::RobotDescription;

use crate::StudyError;
use crate::analysis::path::cut::CutTable;
use crate::analysis::path::{LoadSource, cut};
use crate::analysis::study_tables::StudyTables;
use crate::analysis::table::{AnalysisKind, AnalysisTable};
use crate::analysis::{Sheet, Subject};
use crate::input::cell::CellBodies;
use crate::input::cell::bodies::tool_bodies;
use crate::input::cell::permanent::report_permanent_contacts;
use crate::input::cell::placed::{CellFrames, placed_cell};
use crate::input::freedoms::ToolEnd;
use crate::input::memory::{OF_FIELD, OF_MAP, PointMemory};
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::{grid, load_cases, plane_at, pose_mm_deg};
use crate::input::setting::Setting;
use crate::input::stiffness;
use crate::input::tables::{LoadFrameName, PlaneTable, PostureTable, ToolTable};
use crate::input::vibration::{CutAtPoint, VibrationSetting, VibrationTable, modes_of};
use crate::naming::usual_reference;

/// The plane of the study with the changes of the analysis.
pub fn plane_of(plane: &PlaneTable, analysis: &AnalysisTable) -> PlaneTable {
    let mut plane = plane.clone();
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

/// The cut of the study with its feed along one direction of the plane; `None` if it has problems.
fn cut_on_plane(
    log: &mut ProblemLog<'_>,
    table: &CutTable,
    plane: &Plane,
    feed_deg: f64,
) -> Option<CutAtPoint> {
    let cut = cut::resolve(log, table)?;
    let (Some(spindle), Some(feed)) = (cut.cutting.spindle, cut.cutting.feed) else {
        let message = "the stable depth at a point of a map needs the spindle speed and the feed of the cut";
        log.problem("cut", message, "spindle_rpm = 12000, feed_mm_per_min = 1800");
        return None;
    };
    let milling = cut.milling([spindle, feed], None).map_err(|error| {
        log.problem("cut", error.to_string(), "check depth, feed and spindle speed");
    });
    // y' = -x and z' = y of the part frame; z is the outward normal.
    let (sin, cos) = from_deg(feed_deg).sin_cos();
    let along = Vector3::new(-cos, sin, 0.0);
    let axes = Matrix3::from_columns(&[along, Vector3::z().cross(&along), Vector3::z()]);
    let part_from_feed = Rotation3::from_matrix_unchecked(axes);
    Some(CutAtPoint {
        milling: milling.ok()?,
        spindle,
        base_from_feed: plane.base_from_part.rotation.to_rotation_matrix() * part_from_feed,
    })
}

/// One analysis and its study.
pub struct Resolver<'a> {
    /// What the study gives to every analysis.
    pub common: &'a StudyTables<'a>,
    /// The robot, if it was found.
    pub robot: Option<&'a RobotDescription>,
    /// The calibrated robot, where the controller uses the nominal model `robot`.
    pub actual: Option<&'a Arc<Robot>>,
    /// The analysis as written.
    pub table: &'a AnalysisTable,
    /// Where files of the study are looked for.
    pub folder: &'a Path,
    /// The bodies of the cell, if the study has any.
    pub bodies: Option<&'a CellBodies>,
    /// Whether they have problems, and are missing for that reason.
    pub bodies_have_problems: bool,
}

impl Resolver<'_> {
    /// The subject of the analysis; `None` if it has problems.
    ///
    /// # Errors
    /// The problems of a file that the analysis names.
    pub fn subject(&self, log: &mut ProblemLog<'_>) -> Result<Option<Subject>, StudyError> {
        self.refuse_keys_of_other_kinds(log);
        let push = LoadSource::of(self.common, self.table);
        if push.is_none() {
            let hint = "[load] cases_n = [[3, 5, 5]]: force on the tool, x, y, z; along a path [cut] can be used instead";
            log.problem("load", "no force on the tool: the study has no `load`", hint);
        }
        LoadSource::refuse_two(log, self.table);
        let plane = self.plane_table();
        let grid = grid(log, &plane);
        let tool = self.tool_bodies(log)?;
        let setting = self
            .setting(log, &plane, push)
            .zip(tool)
            .map(|(setting, tool)| self.in_cell(log, setting, tool));
        // Each is checked even if others have problems: all problems are reported at once.
        Ok(match self.table.kind {
            AnalysisKind::Map => setting
                .zip(grid)
                .and_then(|(setting, grid)| self.sheet(log, setting, grid))
                .map(Subject::Map),
            AnalysisKind::Sections => self.sections(log, setting.and(push), grid).map(Subject::Sections),
            AnalysisKind::Volume => self
                .volume(log, setting)
                .map(|(setting, grid)| Subject::Volume(setting, grid)),
            AnalysisKind::Path => {
                let path = self.path(log, setting, push)?;
                path.and_then(|path| {
                    path.memory(self.robot?).check(log, "step_mm")?;
                    Some(Subject::Path(Box::new(path)))
                })
            }
            AnalysisKind::Holes => {
                let holes = self.holes(log, setting, push)?;
                holes.and_then(|holes| {
                    holes.path.memory(self.robot?).check(log, "holes")?;
                    Some(Subject::Holes(Box::new(holes)))
                })
            }
        })
    }

    /// Reports keys that are not valid for this kind of analysis, and a load that turns with the feed where there is no
    /// feed: no key is ignored silently.
    fn refuse_keys_of_other_kinds(&self, log: &mut ProblemLog<'_>) {
        let t = self.table;
        let search = t.posture.as_ref().and_then(|posture| posture.search.as_ref());
        // Keys of two kinds are attributed to the kind of this analysis.
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
            (
                "spin_curve_mm_deg",
                AnalysisKind::Path,
                t.spin_curve_mm_deg.is_some(),
            ),
            ("cut", AnalysisKind::Path, t.cut.is_some()),
            ("posture.search", with_tool, search.is_some()),
            ("holes", AnalysisKind::Holes, t.holes.is_some()),
        ];
        let load = t.load.as_ref().or(self.common.load);
        if t.kind != with_tool && load.and_then(|load| load.frame) == Some(LoadFrameName::Feed) {
            let message = format!(
                "`feed` is not valid for a {}, which has no feed direction",
                t.kind.noun()
            );
            log.problem(
                "load.frame",
                message,
                "use `base` or `part`; `feed` is valid along a path",
            );
        }
        for (key, kind, _) in given.iter().filter(|(_, kind, given)| *given && *kind != t.kind) {
            let message = format!("`{key}` is not valid for a {}", t.kind.noun());
            let hint = format!(
                "it belongs to kind = \"{}\"; the grid of a map is plane.step_mm",
                kind.name()
            );
            log.problem(key, message, &hint);
        }
    }

    /// The plane of the study with the changes of the analysis.
    pub fn plane_table(&self) -> PlaneTable {
        plane_of(self.common.plane, self.table)
    }

    /// What all points of the analysis share; `None` if part of it has problems, which are reported at their keys. If
    /// the forces come with a path, the cases are empty.
    pub fn setting(
        &self,
        log: &mut ProblemLog<'_>,
        plane: &PlaneTable,
        push: Option<LoadSource<'_>>,
    ) -> Option<Setting> {
        let base_name = self
            .table
            .base
            .clone()
            .or_else(|| self.common.base.map(str::to_owned));
        let usual = self
            .robot
            .map_or(crate::BASE_LINK, |found| usual_reference(&found.robot));
        let base_is_given = base_name.is_some();
        let base_name = base_name.unwrap_or_else(|| usual.to_owned());
        let base_from_reference = self.base_from_reference(log, &base_name);
        let choice = self.choice(log);
        let home = self.home(log);
        // Words bound a search; without any, each branch is tried.
        let reported = self.of_posture(|posture| posture.branch.as_ref());
        let open = match (reported, choice) {
            (Some(_), Some(BranchChoice::Of(pattern))) => pattern,
            _ => BranchPattern::default(),
        };
        let search = self.search(log, open, push.map_or(ToolEnd::NotGiven, LoadSource::tool_end));
        let tolerance_um = self.table.tolerance_um.unwrap_or(self.common.tolerance_um);
        let plane = plane_at(
            log,
            plane,
            &base_from_reference.unwrap_or_else(Isometry::identity),
        );
        // Other forces come with the path.
        let given = match push {
            Some(LoadSource::Load(table)) => Some(table),
            _ => None,
        };
        let base_from_link = self.base_from_link();
        self.refuse_load_of_base(log, push);
        if let Some(LoadSource::Measured(table, _)) = push
            && table.frame.frame() == LoadFrame::Base
            && base_from_link != Isometry::identity()
        {
            let message = "forces in the axes of base_link are not known of a part on a positioner";
            log.problem("program.measured.frame", message, "`part` or `feed`");
        }
        let load = match given {
            Some(table) => load_cases(log, table, &base_from_link),
            None => Some(LoadCases {
                frame: LoadFrame::Base,
                cases: Vec::new(),
            }),
        };
        let tool = self.table.tool.as_ref().or(self.common.tool);
        let model = self
            .robot
            .and_then(|found| stiffness::model(log, &self.common.stiffness, tool, &found.robot, self.actual));
        let (base_from_reference, choice, (plane, tilt)) = (base_from_reference?, choice?, plane?);
        let (mut model, load) = (model?, load?);
        let vibration = match self.common.vibration {
            Some(table) => Some(self.vibration(log, table, &plane, &mut model)?),
            None => None,
        };
        let uncertainty = InputUncertainty {
            relative: given.and_then(|load| load.u_percent).unwrap_or(0.0) / 100.0,
            tool_length: from_mm(tool.and_then(|t| t.length_u_mm).unwrap_or(0.0)),
            ..InputUncertainty::NONE
        };
        let u_n = given.and_then(|load| load.u_n).unwrap_or_default();
        // What turns with the feed turns on the path; here it is as if the feed went along x of the part.
        let frame = match load.frame {
            LoadFrame::Feed => LoadFrame::Part,
            reported => reported,
        };
        let with_frame = LoadCases {
            frame,
            ..load.clone()
        };
        let uncertainty = match frame {
            // Components along the axes of base_link, like those of a part that is there.
            LoadFrame::Base => uncertainty.of_components(u_n, LoadFrame::Part, &base_from_link)?,
            frame => uncertainty.of_components(u_n, frame, &plane.base_from_part)?,
        };
        let cases = with_frame.in_base(&plane.base_from_part)?;
        let flange_from_tool =
            tool.map_or_else(Isometry::identity, |t| pose_mm_deg(&t.flange_from_tool_mm_deg));
        let tolerance = from_um(tolerance_um);
        Some(Setting {
            base_name,
            base_is_given,
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
            tolerance,
            least_gain: self.common.improvement.unwrap_or_default().least_gain(tolerance),
            choice,
            home,
            open,
            search,
            motion: None,
            vibration,
            cell: None,
        })
    }

    /// What is asked of the vibration, with the damping of its table in `model`; `None` if it has problems.
    fn vibration(
        &self,
        log: &mut ProblemLog<'_>,
        table: &VibrationTable,
        plane: &Plane,
        model: &mut StiffnessModel,
    ) -> Option<VibrationSetting> {
        if let Some(ratio) = table.damping_ratio {
            model.structure.damping = Some(Damping::Ratio(ratio));
        }
        let mut found = VibrationSetting {
            must_be_stable: table.must_be_stable.unwrap_or(false),
            ..VibrationSetting::default()
        };
        if let Some(file) = &table.tool_modes {
            match modes_of(&self.folder.join(file)) {
                Ok(data) => {
                    found.tool_modes_from = Some(format!("{} ({})", data.name, data.source));
                    found.tool_modes = data.modes;
                }
                Err(error) => {
                    log.problem("vibration.tool_modes", error.to_string(), "a file of modal data");
                    return None;
                }
            }
        }
        if found.tool_modes.is_empty() && !model.structure.has_inertia() {
            let message =
                "nothing vibrates: neither robot nor tool has a mass, and there are no modes of the tool";
            let hint = "add [[mass]] to the robot file, or tool_modes = \"modes.toml\" here";
            log.problem("vibration", message, hint);
            return None;
        }
        let on_plane = self.table.kind != AnalysisKind::Path && self.table.kind != AnalysisKind::Holes;
        if let Some(cut) = self.common.cut.filter(|_| on_plane) {
            found.on_plane = Some(cut_on_plane(log, cut, plane, table.feed_deg.unwrap_or(0.0))?);
        }
        Some(found)
    }

    /// The bodies of the tool; `None` if they have problems.
    fn tool_bodies(&self, log: &mut ProblemLog<'_>) -> Result<Option<Vec<ArmBody>>, StudyError> {
        let tool = self.table.tool.as_ref().or(self.common.tool);
        tool_bodies(log, tool, self.folder)
    }

    /// The setting with the bodies of the cell, if the study has any.
    fn in_cell(&self, log: &mut ProblemLog<'_>, setting: Setting, tool: Vec<ArmBody>) -> Setting {
        let of_study = self.robot.zip(self.bodies);
        let cell = of_study.map(|(robot, bodies)| {
            let frames = CellFrames {
                base_from_reference: &setting.base_from_reference,
                base_from_part: &setting.plane.base_from_part,
                flange_from_tool: &setting.flange_from_tool,
            };
            let found = placed_cell(&robot.robot, bodies, tool, frames);
            report_permanent_contacts(log, bodies, &robot.robot, &found, &frames);
            found
        });
        Setting { cell, ..setting }
    }

    /// What is searched for along a path; `None` also where that is wrong.
    fn search(&self, log: &mut ProblemLog<'_>, open: BranchPattern, tool: ToolEnd) -> Option<PostureSearch> {
        let table = self.of_posture(|posture| posture.search.as_ref());
        let table = table.filter(|_| self.table.kind == AnalysisKind::Path)?;
        let tolerance_um = self.table.tolerance_um.unwrap_or(self.common.tolerance_um);
        let arm = (self.robot.map(|found| &found.robot), tool);
        table.resolve_along(log, from_um(tolerance_um), open, arm)
    }

    /// The frame that coordinates count from, in base.
    fn base_from_reference(&self, log: &mut ProblemLog<'_>, name: &str) -> Option<Isometry> {
        let robot = &self.robot?.robot;
        let found = crate::base_from_reference(robot, name);
        let report = |known: String| {
            let message = format!("robot `{}` has no frame `{name}`", robot.name());
            log.problem("base", message, &format!("it has: {known}"));
        };
        found.map_err(report).ok()
    }

    /// The base of the robot in the base of the chain: as seen from the table of a positioner at home; the same without one.
    fn base_from_link(&self) -> Isometry {
        let found = self
            .robot
            .map(|found| crate::base_from_reference(&found.robot, crate::BASE_LINK));
        found.and_then(Result::ok).unwrap_or_else(Isometry::identity)
    }

    /// Whether the robot holds the part.
    fn part_is_in_hand(&self) -> bool {
        self.robot
            .is_some_and(|found| found.robot.chain().ground().part_is_in_hand())
    }

    /// Reports forces along the axes of the base of a robot that turns the part below them.
    fn refuse_load_of_base(&self, log: &mut ProblemLog<'_>, push: Option<LoadSource<'_>>) {
        let key = match push {
            Some(LoadSource::Load(table)) => (table.frame.map_or(LoadFrame::Base, LoadFrameName::frame)
                == LoadFrame::Base)
                .then_some("load.frame"),
            Some(LoadSource::Measured(table, _)) => {
                (table.frame.frame() == LoadFrame::Base).then_some("program.measured.frame")
            }
            _ => None,
        };
        if let Some(key) = key.filter(|_| self.part_is_in_hand()) {
            let message = "forces in the axes of base_link are not known of a part in the hand, which turns";
            log.problem(key, message, "`part`, or along a path `feed`");
        }
    }

    /// The value of the analysis for a key of the posture, else that of the study.
    pub fn of_posture<T>(&self, get: impl Fn(&'_ PostureTable) -> Option<&T>) -> Option<&T> {
        let own = self.table.posture.as_ref().and_then(&get);
        own.or_else(|| self.common.posture.and_then(&get))
    }

    /// The requested posture, checked against this robot if it is known.
    fn choice(&self, log: &mut ProblemLog<'_>) -> Option<BranchChoice> {
        let words = self.of_posture(|posture| posture.branch.as_ref());
        let words = words.map_or("nominal", String::as_str);
        let choice = match self.robot {
            Some(found) => crate::branch_choice_of(&found.robot, words),
            None => crate::naming::branch_choice(words, BranchPattern::FRONT_ELBOW_UP),
        };
        let report = |message| log.problem("posture.branch", message, "or write `nominal` or `best`");
        choice.map_err(report).ok()
    }

    /// The position of a rail and the preferred positions of redundant joints; `None` also if that has problems.
    fn home(&self, log: &mut ProblemLog<'_>) -> Option<Vec<f64>> {
        let given = self.of_posture(|posture| posture.home_deg.as_ref())?;
        match crate::joint_order::joint_positions(&self.robot?.robot, given) {
            Ok(home) => Some(home),
            Err(StudyError::Value { message, hint }) => {
                log.problem("posture.home_deg", message, &hint);
                None
            }
            Err(_) => None,
        }
    }

    /// The plane with its grid, if its answers fit into memory.
    pub fn sheet(&self, log: &mut ProblemLog<'_>, setting: Setting, grid: Grid) -> Option<Sheet> {
        let points = grid.columns as f64 * grid.rows as f64;
        self.enough_memory(log, "plane.step_mm", points, &setting)?;
        Some(Sheet { setting, grid })
    }

    /// `None`, and a problem at `path`, where so many points take more memory than a study may.
    pub fn enough_memory(
        &self,
        log: &mut ProblemLog<'_>,
        path: &str,
        points: f64,
        setting: &Setting,
    ) -> Option<()> {
        let memory = PointMemory {
            robot: self.robot?,
            setting,
            cases: setting.cases.len(),
            points,
            extra: match self.table.kind {
                AnalysisKind::Map => &OF_MAP,
                _ => &OF_FIELD,
            },
        };
        memory.check(log, path)
    }
}

//! A path of an analysis: a shape on the plane or a program, its placement in the cell, and its load.
//!
//! ```text
//! circle | line | polyline_mm | rectangle   part x, y on the plane, tool against its normal
//! program.file                              part_from_path_mm_deg, tool_axis, spin
//! ```
//!
//! `shape` and [`program`] (`machine_program`, [`robot_program`]) give its points, [`feature`] marks stretches of them;
//! `load` puts on the load: given cases, a [`cut`], a [`drill`], or [`measured`] forces.

pub mod cut;
pub mod drill;
pub mod feature;
mod load;
mod machine_program;
pub mod measured;
pub mod program;
pub mod robot_program;
mod shape;

pub use cut::Cut;
pub use drill::DrillCut;
pub use feature::FeatureTable;
pub(super) use load::{LoadSource, put_on};
pub use measured::MeasuredForces;
pub use robot_program::RobotPath;

use std::path::Path;

use armill_core::load::PathLoad;
use armill_core::path::{ForceSummary, Placing, Shape, Spin, Track};
use armill_core::robot::Robot;
use armill_formats::toolpath::Summary;

use super::format::AnalysisTable;
use super::problem_log::ProblemLog;
use super::resolve::Setting;
use crate::StudyError;

/// A path with its load.
#[derive(Clone, Debug)]
pub struct PathAnalysis {
    /// How its points are evaluated; cases in base as far as they do not turn with the feed.
    pub setting: Setting,
    /// Source of the points.
    pub source: PathSource,
    /// The points and their placement.
    pub track: Track,
    /// The load; of a cut in a stock as if the engagement were constant.
    pub load: PathLoad,
    /// The cut of the forces, in place of given cases.
    pub cut: Option<Cut>,
    /// The drill, if there is one.
    pub drill: Option<DrillCut>,
    /// Statistics of the forces of either.
    pub forces: Option<ForceSummary>,
    /// The record of the forces.
    pub measured: Option<Box<MeasuredForces>>,
    /// Whether the process limits that meet the tolerance are requested.
    pub wants_limits: bool,
    /// Requested features.
    pub features: Vec<FeatureTable>,
}

/// Source of the points of a path.
#[derive(Clone, Debug)]
pub enum PathSource {
    /// A shape on the plane.
    Shape(Shape),
    /// A program.
    Program {
        /// Its file, as the study calls it.
        file: String,
        /// What was read.
        summary: Summary,
        /// What only a robot program has.
        robot: Option<Box<RobotPath>>,
    },
    /// A list of holes, which no path joins.
    Holes {
        /// Its file, as named in the study; none if the study lists them itself.
        file: Option<String>,
    },
}

impl PathSource {
    /// The robot program, if it is one.
    pub fn robot(&self) -> Option<&RobotPath> {
        match self {
            PathSource::Program { robot, .. } => robot.as_deref(),
            PathSource::Shape(_) | PathSource::Holes { .. } => None,
        }
    }
}

impl PathAnalysis {
    /// Whether the process limits are requested and can be computed.
    ///
    /// A model in which the load changes the arm permits no limits.
    pub fn reports_limits(&self) -> bool {
        self.wants_limits && self.setting.model.is_affine()
    }

    /// Whether its cut specifies the stock.
    pub fn has_stock(&self) -> bool {
        self.cut.as_ref().is_some_and(|cut| cut.stock.is_some())
    }

    /// Its name in messages: its file, or its shape.
    pub fn shown(&self) -> &str {
        match &self.source {
            PathSource::Shape(Shape::Circle { .. }) => "circle",
            PathSource::Shape(Shape::Polyline(_)) => "line",
            PathSource::Program { file, .. } => file,
            PathSource::Holes { file } => file.as_deref().unwrap_or("holes"),
        }
    }

    /// Length of all cuts, or of the shape, m.
    pub fn length(&self) -> f64 {
        self.shape()
            .map_or_else(|| self.track.path.length(), Shape::length)
    }

    /// The shape, if it is one.
    pub fn shape(&self) -> Option<&Shape> {
        match &self.source {
            PathSource::Shape(shape) => Some(shape),
            PathSource::Program { .. } | PathSource::Holes { .. } => None,
        }
    }
}

/// The path of this analysis; `None` if it has problems, reported at their keys. `step_mm` is the pitch of the
/// plane.
///
/// # Errors
/// The problems of the files that it names.
pub(super) fn resolve(
    log: &mut ProblemLog<'_>,
    (table, step_mm): (&AnalysisTable, f64),
    (folder, robot): (&Path, Option<&Robot>),
    (mut setting, push): (Option<Setting>, Option<LoadSource<'_>>),
) -> Result<Option<PathAnalysis>, StudyError> {
    if usize::from(table.program.is_some()) + shape::count(table) != 1 {
        let hint = "circle = { radius_mm = 100 }, line, polyline_mm, rectangle, or program = { file = \"part.ngc\" }";
        log.problem_here("a path has exactly one shape or program", hint);
        return Ok(None);
    }
    let (path, source) = match &table.program {
        Some(of) => match program::read(log, of, (folder, robot.zip(setting.as_ref())))? {
            Some(mut found) => {
                if let (Some(program), Some(robot), Some(setting)) = (&found.robot, robot, &mut setting) {
                    let note = robot_program::take_posture(setting, &program.followed, robot);
                    found.summary.notes.extend(note);
                }
                let source = PathSource::Program {
                    file: of.file.clone(),
                    summary: found.summary,
                    robot: found.robot,
                };
                (found.path, source)
            }
            None => return Ok(None),
        },
        None => match shape::resolve(log, table, step_mm) {
            Some((path, shape)) => (path, PathSource::Shape(shape)),
            None => return Ok(None),
        },
    };
    let (Some(setting), Some(push)) = (setting, push) else {
        return Ok(None);
    };
    let base_from_part = setting.plane.base_from_part;
    let placing = match &table.program {
        Some(of) => program::placing(of, &base_from_part, source.robot()),
        None => Placing {
            spin: Spin::Fixed(table.spin_deg.unwrap_or(0.0).to_radians()),
            ..Placing::on_plane(&setting.plane)
        },
    };
    if table.program.is_some() && table.spin_deg.is_some() {
        let hint = "use program.spin_deg";
        log.problem("spin_deg", "`spin_deg` is valid for shapes only", hint);
        return Ok(None);
    }
    let mut analysis = PathAnalysis {
        source,
        track: Track {
            path,
            placing,
            base_from_part,
            spins: None,
        },
        load: PathLoad::Cases(setting.load.clone()),
        cut: None,
        drill: None,
        forces: None,
        measured: None,
        wants_limits: table.program.as_ref().is_some_and(|of| of.limits.unwrap_or(true)),
        features: table
            .program
            .as_ref()
            .map_or_else(Vec::new, |of| of.feature.clone()),
        setting,
    };
    let pushes = put_on(log, push, folder, &mut analysis)?;
    Ok(pushes.then_some(analysis))
}

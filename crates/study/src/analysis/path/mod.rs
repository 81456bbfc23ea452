//! The deviation along a path: a shape on the plane or a program, its placement in the cell, and its load.
//!
//! ```text
//! circle | line | polyline_mm | rectangle   part x, y on the plane, tool against its normal
//! program.file                              part_from_path_mm_deg, tool_axis, spin
//! ```
//!
//! `shape` and [`program`] (its keys [`program_table`], its file `program_file`, then `machine_program` or
//! [`robot_program`]) give its points, [`feature`] marks stretches of them; `load` puts on the load: given cases, a [`cut`], a [`drill`], or [`measured`] forces; `shape_tables`: the tables of
//! shapes; `spin_curve`: a spin that changes along the path. [`resolve`](mod@resolve) joins these, [`run`] evaluates the path, [`motion`] what the controller makes of it. [`answer`], [`sentence`], [`warnings`] are
//! its answer; [`columns`], [`pictures`] (with `track_views`, [`point_groups`], `turns`, [`process_limits`], `motion_columns`, `corner_picture`) and [`report`] its files. [`process_loads`]:
//! what the cut asks of tool and spindle; [`machined_part`]: the part that comes out; [`to_measure`]: its points for the journal of the arm; [`vibration`]: the cuts whose stability is evaluated.

pub mod answer;
pub mod columns;
mod corner_picture;
pub mod cut;
pub mod drill;
pub mod feature;
pub mod load;
mod machine_program;
pub mod machined_part;
pub mod measured;
pub mod motion;
mod motion_columns;
pub mod pictures;
pub mod point_groups;
pub mod process_limits;
pub mod process_loads;
pub mod program;
pub(crate) mod program_file;
pub mod program_table;
pub mod report;
pub mod resolve;
pub mod robot_program;
pub mod run;
pub mod sentence;
mod shape;
pub mod shape_tables;
mod spin_curve;
pub mod to_measure;
mod track_views;
mod turns;
pub mod vibration;
pub mod warnings;

pub use cut::Cut;
pub use drill::DrillCut;
pub use feature::FeatureTable;
pub use load::{LoadSource, put_on};
pub use measured::MeasuredForces;
pub use robot_program::RobotPath;

use armill_core::load::PathLoad;
use armill_core::machined::MachiningPath;
use armill_core::path::{ForceSummary, Shape, SpinCurve, Stock, Track};
use armill_formats::robot::RobotDescription;
use armill_formats::toolpath::Summary;

use crate::analysis::path::machined_part::MachinedSetting;
use crate::input::memory::{OF_PATH, PointMemory};
use crate::input::setting::Setting;

/// A path with its load.
#[derive(Clone, Debug)]
pub struct PathAnalysis {
    /// How its points are evaluated; cases in base as far as they do not turn with the feed.
    pub setting: Setting,
    /// Source of the points.
    pub source: PathSource,
    /// The points and their placement, with the spins of the curve.
    pub track: Track,
    /// The spin that changes along the path, in addition to the constant one.
    pub spin_curve: Option<SpinCurve>,
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
    /// The part that comes out, if it is requested.
    pub machined_part: Option<Box<MachinedSetting>>,
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
        self.cut_in_stock().is_some()
    }

    /// Its cut and the uncut stock, if it specifies one.
    pub fn cut_in_stock(&self) -> Option<(&Cut, &Stock)> {
        let cut = self.cut.as_ref()?;
        Some((cut, cut.stock.as_ref()?))
    }

    /// Its points in memory.
    pub fn memory<'a>(&'a self, robot: &'a RobotDescription) -> PointMemory<'a> {
        PointMemory {
            robot,
            setting: &self.setting,
            cases: self.load.case_count(),
            points: self.track.len() as f64,
            extra: &OF_PATH,
        }
    }

    /// Steps of the removal of its part, as its progress counts them; 0 without one.
    pub fn machining_steps(&self) -> usize {
        self.machined_part.as_ref().map_or(0, |part| {
            let path = MachiningPath {
                track: &self.track,
                tools: &part.tools,
                turn_tolerance: 0.0,
            };
            self.track.len() + 2 * path.move_count()
        })
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

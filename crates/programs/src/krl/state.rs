//! State while lines are read: modal settings, the end of the previous move, names, and what was read so far.

use std::collections::HashSet;

use super::points::Names;
use crate::messages::ProgramMessages;
use crate::program::{Frame, RobotMove, Speed};
use crate::text::ProgramText;

/// Settings for the next move.
#[derive(Clone, Debug)]
pub(super) struct Modal {
    pub base: Frame,
    pub tool: Frame,
    pub speed: Speed,
    /// `$APO.CDIS`, m; none if it is not known.
    pub blend: Option<f64>,
    /// The workpiece is on the flange and the tool is stationary (`#TCP`).
    pub tool_is_stationary: bool,
}

impl Default for Modal {
    fn default() -> Modal {
        Modal {
            base: Frame::Unknown,
            tool: Frame::Unknown,
            speed: Speed::Unknown,
            blend: None,
            tool_is_stationary: false,
        }
    }
}

/// End of the previous move: default of missing components.
#[derive(Clone, Debug)]
pub(super) enum Former {
    /// Components of a pose, with frame and tool.
    Pose([f64; 6], Frame, Frame),
    /// Axes, deg.
    Axes([f64; 6]),
}

/// State while lines are read.
pub(super) struct Reader<'a> {
    pub messages: ProgramMessages<'a>,
    /// The module of the text that is being read.
    pub module: String,
    pub names: Names,
    pub modal: Modal,
    /// Settings to restore at the end of a spline block.
    pub before_spline: Option<Modal>,
    /// The speed of the set that `LDAT_ACT` names.
    pub path_speed: Option<f64>,
    /// End of the previous move.
    pub former: Option<Former>,
    pub routines: HashSet<String>,
    pub moves: Vec<RobotMove>,
}

impl<'a> Reader<'a> {
    pub fn new(texts: &'a [ProgramText]) -> Reader<'a> {
        Reader {
            messages: ProgramMessages::new(texts),
            module: String::new(),
            names: Names::default(),
            modal: Modal::default(),
            before_spline: None,
            path_speed: None,
            former: None,
            routines: HashSet::new(),
            moves: Vec::new(),
        }
    }
}

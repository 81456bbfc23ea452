//! Values of expressions: poses with their positions in the text, joints, numbers.

use std::ops::Range;

use armill_core::frame::Isometry;

use crate::program::Spelled;

/// Value of an expression, as far as it is known.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    Pose(Posed),
    Numbers(Vec<f64>),
    /// Computed while the program runs, or not supported.
    Unknown,
    /// Invalid, and reported as a problem.
    Wrong,
}

/// A pose and its position in the text.
#[derive(Clone, Debug)]
pub(super) struct Posed {
    /// Its reference: robot base to frame.
    pub frame: Isometry,
    pub pose: Isometry,
    pub spelled: Spelled,
}

impl Posed {
    /// Robot base to tool.
    pub fn in_base(&self) -> Isometry {
        self.frame * self.pose
    }
}

/// An argument with its name, if it has one, and its position.
pub(super) struct Argument {
    pub name: Option<String>,
    pub value: Value,
    pub bytes: Range<usize>,
}

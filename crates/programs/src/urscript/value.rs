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
    pub frame: Reference,
    pub pose: Isometry,
    pub spelled: Spelled,
}

/// Reference of a pose.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Reference {
    /// Robot base to frame.
    Given(Isometry),
    /// A feature of the installation: only the controller knows its pose.
    Feature(String),
}

impl Posed {
    /// Robot base to tool; `None` relative to a feature of the installation.
    pub fn in_base(&self) -> Option<Isometry> {
        match &self.frame {
            Reference::Given(frame) => Some(frame * self.pose),
            Reference::Feature(_) => None,
        }
    }
}

/// An argument with its name, if it has one, and its position.
pub(super) struct Argument {
    pub name: Option<String>,
    pub value: Value,
    pub bytes: Range<usize>,
}

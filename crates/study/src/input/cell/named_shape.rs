//! A body of the cell as its table gives it.

use armill_core::clearance::{FixedBody, Shape};
use armill_core::frame::Isometry;

/// Name of the floor among the bodies.
pub(super) const FLOOR: &str = "floor";

/// A body with its position in its frame.
#[derive(Clone, Debug)]
pub struct NamedShape {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// From the frame that it is given in.
    pub frame_from_body: Isometry,
    /// The table that gives it.
    pub table: String,
}

impl NamedShape {
    /// The body that stands still, whose frame is at `frame`.
    pub(super) fn fixed(&self, frame: &Isometry, is_part: bool) -> FixedBody {
        FixedBody {
            name: self.name.clone(),
            shape: self.shape.clone(),
            frame_from_body: frame * self.frame_from_body,
            is_part,
        }
    }
}

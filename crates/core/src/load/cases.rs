//! Load cases: a set of given wrenches, each of which may act.
//!
//! A wrench acts *on the tool* at the TCP; a dynamometer under the part reads the opposite sign. N, N m.

use crate::frame::Isometry;
use crate::spatial::Wrench;

/// The axes that the components of a load are told in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadFrame {
    /// The base frame of the robot.
    Base,
    /// The workpiece frame: z is its outward normal.
    Part,
    /// The feed frame of a path: x along the feed, z from the tip towards the spindle ([`crate::path::placing`]).
    Feed,
}

/// Wrenches, each of which may act at every point.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCases {
    /// Axes of the components.
    pub frame: LoadFrame,
    /// At least one; reference point TCP.
    pub cases: Vec<Wrench>,
}

impl LoadCases {
    /// The cases told in base, for a part that lies at `base_from_part`. No path tells where the feed goes: along part x.
    pub fn in_base(&self, base_from_part: &Isometry) -> Vec<Wrench> {
        let turned = |wrench: &Wrench| match self.frame {
            LoadFrame::Base => *wrench,
            LoadFrame::Part | LoadFrame::Feed => Wrench {
                force: base_from_part * wrench.force,
                moment: base_from_part * wrench.moment,
            },
        };
        self.cases.iter().map(turned).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workpiece::Plane;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn a_load_told_in_the_part_turns_with_it() {
        let plane = Plane::tilted(Point3::new(0.8, 0.0, 0.8), 0.3);
        let push = Wrench::from_force(Vector3::new(0.0, 0.0, -7.0));
        let load = LoadCases {
            frame: LoadFrame::Part,
            cases: vec![push],
        };
        let in_base = load.in_base(&plane.base_from_part)[0];
        // A push into the part is along the tool axis.
        assert!((in_base.force - plane.tool_axis().into_inner() * 7.0).norm() < 1e-14);
    }
}

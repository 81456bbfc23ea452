//! Load cases: a set of given wrenches, each of which may act.
//!
//! A wrench acts *on the tool* at the TCP; a dynamometer under the part reads the opposite sign. N, N m.

use nalgebra::Rotation3;

use crate::frame::Isometry;
use crate::spatial::Wrench;

/// The axes of the components of a load.
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

impl LoadFrame {
    /// These axes in base, for a part placed at `base_from_part` and a feed frame with this rotation in base; `None`
    /// for the feed frame where no path gives it.
    pub fn axes(
        self,
        base_from_part: &Isometry,
        base_from_feed: Option<&Rotation3<f64>>,
    ) -> Option<Rotation3<f64>> {
        match self {
            LoadFrame::Base => Some(Rotation3::identity()),
            LoadFrame::Part => Some(base_from_part.rotation.to_rotation_matrix()),
            LoadFrame::Feed => base_from_feed.copied(),
        }
    }
}

impl LoadCases {
    /// The cases in base axes, for a part placed at `base_from_part`; `None` where they turn with a feed.
    pub fn in_base(&self, base_from_part: &Isometry) -> Option<Vec<Wrench>> {
        let axes = self.frame.axes(base_from_part, None)?;
        Some(self.cases.iter().map(|given| turned(given, &axes)).collect())
    }
}

/// A wrench given in `axes`, in the reference axes of `axes`.
pub(super) fn turned(given: &Wrench, axes: &Rotation3<f64>) -> Wrench {
    Wrench {
        force: axes * given.force,
        moment: axes * given.moment,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workpiece::Plane;
    use nalgebra::{Point3, Vector3};

    #[test]
    fn a_load_given_in_the_part_frame_turns_with_the_part() {
        let plane = Plane::tilted(Point3::new(0.8, 0.0, 0.8), 0.3);
        let push = Wrench::from_force(Vector3::new(0.0, 0.0, -7.0));
        let load = LoadCases {
            frame: LoadFrame::Part,
            cases: vec![push],
        };
        let in_base = load.in_base(&plane.base_from_part).unwrap()[0];
        // A push into the part is along the tool axis.
        assert!((in_base.force - plane.tool_axis().into_inner() * 7.0).norm() < 1e-14);
    }

    #[test]
    fn axes_that_turn_with_the_feed_require_a_feed() {
        let part = crate::frame::from_xyz_and_fixed_angles(Vector3::x(), Vector3::new(0.3, -0.8, 2.0));
        let feed = Rotation3::new(Vector3::new(-0.4, 1.1, 0.2));
        let load = |frame| LoadCases {
            frame,
            cases: vec![Wrench::from_force(Vector3::x())],
        };
        assert_eq!(load(LoadFrame::Feed).in_base(&part), None);
        assert_eq!(LoadFrame::Feed.axes(&part, Some(&feed)), Some(feed));
        for frame in [LoadFrame::Base, LoadFrame::Part] {
            assert_eq!(frame.axes(&part, Some(&feed)), frame.axes(&part, None));
            let given = load(frame).in_base(&part).unwrap()[0];
            assert_eq!(given.force, frame.axes(&part, None).unwrap() * Vector3::x());
        }
    }
}

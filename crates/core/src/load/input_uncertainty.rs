//! Uncertainty of the load and of the tool.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `relative` | standard uncertainty of the size of the load, all cases alike | 1 |
//! | `forces` | three directions, each as long as the standard uncertainty of the force along it; independent | N, base |
//! | `tool_length` | standard uncertainty of the position of the TCP along the tool axis | m |

use nalgebra::Vector3;

use super::LoadFrame;
use crate::frame::Isometry;

/// Standard uncertainties of load and tool, independent of each other; see the module page.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InputUncertainty {
    /// Relative.
    pub relative: f64,
    /// N, base.
    pub forces: [Vector3<f64>; 3],
    /// m
    pub tool_length: f64,
}

impl InputUncertainty {
    /// No uncertainty.
    pub const NONE: InputUncertainty = InputUncertainty {
        relative: 0.0,
        forces: [Vector3::new(0.0, 0.0, 0.0); 3],
        tool_length: 0.0,
    };

    /// With this standard uncertainty (N) of the force components in `frame`, for a part placed at `base_from_part`;
    /// `None` where they turn with a feed.
    pub fn of_components(
        self,
        u: [f64; 3],
        frame: LoadFrame,
        base_from_part: &Isometry,
    ) -> Option<InputUncertainty> {
        let axes = frame.axes(base_from_part, None)?;
        let axis = |k: usize| axes * Vector3::ith(k, u[k]);
        Some(InputUncertainty {
            forces: [axis(0), axis(1), axis(2)],
            ..self
        })
    }

    /// Whether all inputs are exact.
    pub fn is_none(&self) -> bool {
        *self == InputUncertainty::NONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::from_xyz_and_fixed_angles;

    const U: [f64; 3] = [1.0, 2.0, 0.5];

    #[test]
    fn uncertainty_given_in_the_part_frame_turns_with_the_part_and_keeps_its_size() {
        let part = from_xyz_and_fixed_angles(Vector3::x(), Vector3::new(0.3, -0.8, 2.0));
        let uncertainty = InputUncertainty {
            relative: 0.1,
            ..InputUncertainty::NONE
        };
        let given = uncertainty.of_components(U, LoadFrame::Part, &part).unwrap();
        assert_eq!(given.relative, 0.1);
        // Variance along any direction: the sum of squares of the parts along it.
        let along = Vector3::new(0.48, -0.6, 0.64);
        let variance: f64 = given.forces.iter().map(|u| u.dot(&along).powi(2)).sum();
        let in_part = part.rotation.inverse() * along;
        let expected: f64 = (0..3).map(|k| (U[k] * in_part[k]).powi(2)).sum();
        assert!(
            (variance - expected).abs() < 1e-15 * 10.0,
            "{variance} {expected}"
        );
        let in_base = uncertainty.of_components(U, LoadFrame::Base, &part).unwrap();
        assert_eq!(in_base.forces[1], Vector3::new(0.0, 2.0, 0.0));
    }

    #[test]
    fn uncertainty_that_turns_with_a_feed_requires_a_feed() {
        let given = InputUncertainty::NONE.of_components(U, LoadFrame::Feed, &Isometry::identity());
        assert_eq!(given, None);
        assert!(InputUncertainty::NONE.is_none());
        let some = InputUncertainty::NONE.of_components(U, LoadFrame::Base, &Isometry::identity());
        assert!(!some.unwrap().is_none());
    }
}

//! How sure the load and the tool are.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `relative` | standard uncertainty of the size of the load, all cases alike | 1 |
//! | `forces` | three directions, each as long as the standard uncertainty of the force along it; independent | N, base |
//! | `tool_length` | standard uncertainty of the place of the TCP along the tool axis | m |

use nalgebra::Vector3;

use super::LoadFrame;
use crate::frame::Isometry;

/// Standard uncertainties of load and tool, independent of each other; see the module page.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Doubt {
    /// Relative.
    pub relative: f64,
    /// N, base.
    pub forces: [Vector3<f64>; 3],
    /// m
    pub tool_length: f64,
}

impl Doubt {
    /// No doubt.
    pub const NONE: Doubt = Doubt {
        relative: 0.0,
        forces: [Vector3::new(0.0, 0.0, 0.0); 3],
        tool_length: 0.0,
    };

    /// Doubt of the force's components in `frame`, for a part that lies at `base_from_part`.
    #[must_use]
    pub fn of_components(self, u: [f64; 3], frame: LoadFrame, base_from_part: &Isometry) -> Doubt {
        let axis = |k: usize| {
            let axis = Vector3::ith(k, u[k]);
            match frame {
                LoadFrame::Base => axis,
                LoadFrame::Part | LoadFrame::Feed => base_from_part * axis,
            }
        };
        Doubt {
            forces: [axis(0), axis(1), axis(2)],
            ..self
        }
    }

    /// Whether everything is sure.
    pub fn is_none(&self) -> bool {
        *self == Doubt::NONE
    }
}

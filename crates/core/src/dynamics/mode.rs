//! A mode of vibration, as the tool takes part in it.
//!
//! The shape `phi` is normalised by mass: of the modal coordinate `eta`, driven by the wrench `w` at the tool,
//!
//! ```text
//! x = phi eta        d2eta/dt2 + 2 zeta omega deta/dt + omega^2 eta = phi^T w
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `omega`, `zeta` | undamped angular frequency, damping ratio | rad/s, - |
//! | `x`, `w` | twist and wrench at the tool: translation above rotation, force above moment | m, rad; N, N m |
//! | `phi` | shape at the tool | 1/sqrt(kg), rad/(m sqrt(kg)) |
//!
//! The modal mass in a direction `n` of the tool's translation is `1/(n.phi)^2`, kg. Source: Ewins, Modal testing (recalled); any text on vibration.

use nalgebra::{Rotation3, Vector3, Vector6};

/// A mode of vibration at the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// `omega`: undamped angular frequency, rad/s.
    pub angular_frequency: f64,
    /// `zeta`: damping ratio, below 1.
    pub damping_ratio: f64,
    /// `phi`: translation (1/sqrt(kg)) above rotation (rad/(m sqrt(kg))) of the tool, normalised by mass.
    pub shape: Vector6<f64>,
}

impl Mode {
    /// Undamped natural frequency, Hz.
    pub fn frequency_hz(&self) -> f64 {
        self.angular_frequency / std::f64::consts::TAU
    }

    /// The same with its shape in other axes, which `from` turns into those of this one.
    #[must_use]
    pub fn in_axes(&self, from: &Rotation3<f64>) -> Mode {
        let turned = |first: usize| from.inverse() * Vector3::from(self.shape.fixed_rows::<3>(first));
        let (translation, rotation) = (turned(0), turned(3));
        Mode {
            shape: Vector6::from_fn(|k, _| if k < 3 { translation[k] } else { rotation[k - 3] }),
            ..*self
        }
    }
}

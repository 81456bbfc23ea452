//! A mode with its name and the uncertainty of its parameters.
//!
//! The three relative standard uncertainties are independent: of the frequency, of the damping ratio and of the stiffness. At a given
//! frequency the shape, normalised by mass, is proportional to `1/sqrt(stiffness)`:
//!
//! ```text
//! k = omega^2/(n.phi)^2        phi' = phi (omega'/omega)/sqrt(k'/k)
//! ```
//!
//! so a change of the frequency alone keeps the stiffness, and the modal mass changes.

use crate::dynamics::Mode;

/// A mode at the tool, in the feed frame, with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMode {
    /// Name for people.
    pub name: String,
    /// The mode; its shape in the feed frame of [`crate::load::engagement`].
    pub mode: Mode,
    /// Relative standard uncertainties.
    pub uncertainty: ModeUncertainty,
}

/// Relative standard uncertainties of a mode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModeUncertainty {
    /// Of the frequency.
    pub frequency: f64,
    /// Of the damping ratio.
    pub damping: f64,
    /// Of the modal stiffness, at the same frequency.
    pub stiffness: f64,
}

/// Factors on frequency, damping ratio and stiffness of a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factors(pub(super) [f64; 3]);

impl ModeUncertainty {
    /// In the order of [`Factors`].
    pub(super) fn as_array(self) -> [f64; 3] {
        [self.frequency, self.damping, self.stiffness]
    }
}

impl Factors {
    /// The mode with these factors on its parameters.
    pub(super) fn on(self, mode: &Mode) -> Mode {
        let [frequency, damping, stiffness] = self.0;
        Mode {
            angular_frequency: mode.angular_frequency * frequency,
            damping_ratio: mode.damping_ratio * damping,
            shape: mode.shape * (frequency / stiffness.sqrt()),
        }
    }
}

/// The modes alone, in their order.
pub fn modes(named: &[NamedMode]) -> Vec<Mode> {
    named.iter().map(|named| named.mode).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector6;

    use super::*;
    use crate::dynamics::receptance;

    #[test]
    fn a_factor_on_the_frequency_keeps_the_stiffness_and_one_on_the_stiffness_divides_the_compliance() {
        let mode = Mode {
            angular_frequency: 100.0,
            damping_ratio: 0.02,
            shape: Vector6::new(0.5, 0.1, 0.0, 0.0, 0.0, 0.0),
        };
        let still = |mode: Mode| receptance(&[mode], 0.0)[(0, 0)].re;
        let faster = Factors([1.3, 1.0, 1.0]).on(&mode);
        assert!((still(faster) / still(mode) - 1.0).abs() < 1e-14);
        let stiffer = Factors([1.0, 2.0, 4.0]).on(&mode);
        assert!((still(stiffer) / still(mode) - 0.25).abs() < 1e-14);
        assert_eq!(stiffer.damping_ratio, 0.04);
    }
}

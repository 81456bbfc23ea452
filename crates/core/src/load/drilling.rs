//! Drilling: thrust and torque of a twist drill with two lips, in Kienzle's form.
//!
//! ```text
//! b = d/(2 sin(sigma/2)),   h = (f/2) sin(sigma/2)                 chip of one lip
//! Fc = kc1 b h (h/h0)^-mc                                          cutting force of one lip
//! M = Fc d/2                                                       both lips, each at a quarter of the diameter
//! Ff = 2 r Fc sin(sigma/2)                                         thrust; r: force normal to the lip over Fc
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d`, `sigma` | diameter, point angle | m, rad |
//! | `f` | feed per revolution | m |
//! | `kc1`, `mc` | Kienzle values | Pa, - |
//! | `r` | normal over cutting force on a lip: the radial ratio of the law | - |
//!
//! The formulas are \[recalled\] (Victor's extension of Kienzle's law to drills): no worked case with its source is at
//! hand, so they are no more than an estimate. Left out: the chisel edge, which can make half of the thrust where no
//! pilot hole is, friction of the margins, wear.

use nalgebra::{Matrix2, Matrix2x4, Vector2, Vector3};

use super::error::{CuttingError, checked};
use super::kienzle::Kienzle;
use crate::spatial::Wrench;

/// A drill with its feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drilling {
    /// m
    pub diameter: f64,
    /// Full angle of the point, rad; 118 deg is the common drill.
    pub point_angle: f64,
    /// Feed per revolution, m.
    pub feed: f64,
    /// Kienzle's law; its radial ratio is the force normal to a lip over the cutting force, its axial ratio unused.
    pub law: Kienzle,
}

/// Thrust and torque on the drill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrillingForce {
    /// Along the axis, from the part to the spindle, N.
    pub thrust: f64,
    /// Against the turn of the spindle, N m.
    pub torque: f64,
    /// Covariance of thrust and torque, from the values of the law; N², N² m, N² m².
    pub covariance: Matrix2<f64>,
}

/// Number of lips.
const LIPS: f64 = 2.0;
/// Bluntest and sharpest point, rad: 180 deg is a flat one.
const POINT_ANGLES: [f64; 2] = [std::f64::consts::FRAC_PI_6, std::f64::consts::PI];

impl Drilling {
    /// Thrust and torque while the whole point is in the part.
    ///
    /// # Errors
    /// A diameter, feed or point angle out of range.
    pub fn force(&self) -> Result<DrillingForce, CuttingError> {
        let d = checked("diameter of the drill", self.diameter, [1e-5, 1.0], "m")?;
        let sigma = checked("point angle", self.point_angle, POINT_ANGLES, "rad")?;
        let f = checked("feed per revolution", self.feed, [0.0, d], "m")?;
        let half_sine = (sigma / 2.0).sin();
        let (b, h) = (d / (2.0 * half_sine), f / LIPS * half_sine);

        let on_lip = self.law.force(h) * b;
        let (cutting, normal) = (on_lip.x, on_lip.y);
        let thrust_and_torque =
            |cutting: f64, normal: f64| Vector2::new(LIPS * normal * half_sine, LIPS * cutting * d / 4.0);
        let total = thrust_and_torque(cutting, normal);

        let derivatives = self.law.derivatives(h) * b;
        let columns: [Vector2<f64>; 4] =
            std::array::from_fn(|k| thrust_and_torque(derivatives[(0, k)], derivatives[(1, k)]));
        let by_values = Matrix2x4::from_columns(&columns);
        let values = self.law.covariance().fixed_view::<4, 4>(0, 0).into_owned();
        Ok(DrillingForce {
            thrust: total.x,
            torque: total.y,
            covariance: by_values * values * by_values.transpose(),
        })
    }
}

impl DrillingForce {
    /// The wrench on the drill at its tip, in axes of which z points from the part to the spindle; clockwise spindle.
    pub fn wrench(&self) -> Wrench {
        Wrench {
            force: Vector3::z() * self.thrust,
            // The spindle turns about -z, the part reacts against it.
            moment: Vector3::z() * self.torque,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::kienzle::{Estimate, KienzleValues};

    fn estimate(value: f64, relative: f64) -> Estimate {
        Estimate {
            value,
            standard_uncertainty: value * relative,
        }
    }

    fn drilling(relative: f64) -> Drilling {
        Drilling {
            diameter: 10e-3,
            point_angle: 118_f64.to_radians(),
            feed: 0.2e-3,
            law: Kienzle::new(KienzleValues {
                specific_force: estimate(800e6, relative),
                exponent: estimate(0.25, 0.0),
                radial_ratio: estimate(0.5, relative),
                axial_ratio: estimate(0.0, 0.0),
            })
            .unwrap(),
        }
    }

    #[test]
    fn torque_is_the_specific_force_on_the_section_of_the_hole() {
        // Both lips take d f/2 of section each revolution, at d/4 on average: M = kc d^2 f/8, whatever the point angle.
        let drilling = drilling(0.0);
        let h_mm = 0.1 * 59_f64.to_radians().sin();
        let kc = 800.0 * h_mm.powf(-0.25);
        let torque = kc * 10.0 * 10.0 * 0.2 / 8.0 * 1e-3;
        let force = drilling.force().unwrap();
        assert!((force.torque - torque).abs() < 1e-12, "{} N m", force.torque);
        // Thrust: half of the cutting force of both lips, along the axis: 0.5 kc d f/2 sin 59 deg.
        let thrust = 0.5 * kc * 10.0 * 0.2 / 2.0 * 59_f64.to_radians().sin();
        assert!((force.thrust - thrust).abs() < 1e-9, "{} N", force.thrust);
    }

    #[test]
    fn uncertainty_of_kc1_moves_both_and_that_of_the_ratio_thrust_alone() {
        let force = drilling(0.1).force().unwrap();
        let u = force.covariance.diagonal().map(f64::sqrt);
        assert!((u.y - 0.1 * force.torque).abs() < 1e-12);
        assert!((u.x - 0.1 * 2_f64.sqrt() * force.thrust).abs() < 1e-9);
    }

    #[test]
    fn the_part_pushes_the_drill_back_and_reacts_against_its_rotation() {
        let wrench = drilling(0.0).force().unwrap().wrench();
        assert!(wrench.force.z > 0.0 && wrench.moment.z > 0.0);
    }

    #[test]
    fn no_feed_gives_no_force_and_invalid_drills_are_refused() {
        let still = Drilling {
            feed: 0.0,
            ..drilling(0.0)
        };
        assert_eq!(still.force().unwrap().thrust, 0.0);
        for wrong in [
            Drilling {
                diameter: 0.0,
                ..still
            },
            Drilling {
                point_angle: 4.0,
                ..still
            },
            Drilling { feed: 1.0, ..still },
            Drilling {
                feed: f64::NAN,
                ..still
            },
        ] {
            assert!(wrong.force().is_err(), "{wrong:?}");
        }
    }
}

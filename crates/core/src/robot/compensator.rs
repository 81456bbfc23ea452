//! Masses, and the gravity compensator.
//!
//! A compensator is a spring between a fixed point, at distance `a` from the axis of its joint, and a point
//! of the arm at radius `L`:
//!
//! ```text
//! s^2 = a^2 + L^2 + 2 a L cos(alpha + theta)        E = K (s - s0)^2 / 2
//! M = -dE/dtheta = K (1 - s0/s) a L sin(alpha + theta)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `theta` | chain position of the joint | rad |
//! | `s`, `s0` | length of the spring, its length without force | m |
//! | `K` | its stiffness | N/m |
//! | `M` | torque on the joint, by the right hand about its axis in the chain | N m |
//!
//! Its torque adds to gravity's, and its slope to the joint: stiffness `k - dM/dtheta`. Source: Klimchik, Wu, Dumas,
//! Caro, Furet & Pashkevich 2013, arXiv:1311.6810.

use nalgebra::{Matrix3, Point3};

use super::spring::Attachment;
use crate::frame::Isometry;

/// A body with mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Its attachment.
    pub attachment: Attachment,
    /// kg
    pub mass: f64,
    /// Centre of mass in the frame of the attachment, m.
    pub centre: Point3<f64>,
    /// Inertia about the centre of mass, in the axes of the attachment, kg m^2; `None` where it is not known: the body is
    /// then a point. Gravity does not depend on it.
    pub inertia: Option<Matrix3<f64>>,
    /// Standard uncertainty of the mass, and of the inertia with it, as a fraction of it; 0 where none is given.
    pub relative_uncertainty: f64,
}

impl Mass {
    /// The same body at another attachment, whose frame has the old one at `new_from_old`.
    #[must_use]
    pub fn attached_to(&self, attachment: Attachment, new_from_old: &Isometry) -> Mass {
        let turn = new_from_old.rotation.to_rotation_matrix();
        Mass {
            attachment,
            mass: self.mass,
            centre: new_from_old * self.centre,
            inertia: self.inertia.map(|own| turn * own * turn.transpose()),
            relative_uncertainty: self.relative_uncertainty,
        }
    }
}

/// A spring that balances one joint against gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensator {
    /// Index of the joint, a revolute one.
    pub joint: usize,
    /// `a`: from the axis to the fixed point, m.
    pub fixed_radius: f64,
    /// `L`: from the axis to the point of the arm, m.
    pub arm_radius: f64,
    /// `alpha`: angle between the two where the joint's chain position is zero, against the stretched spring, rad.
    pub angle: f64,
    /// `s0`, m.
    pub free_length: f64,
    /// `K`, N/m.
    pub stiffness: f64,
}

impl Compensator {
    /// Torque `M` on the joint at chain position `theta`, N m.
    pub fn torque(&self, theta: f64) -> f64 {
        let (al, s, (sin, _)) = self.at(theta);
        self.stiffness * (1.0 - self.free_length / s) * al * sin
    }

    /// `dM/dtheta`, N m/rad: reduces the stiffness of the joint.
    pub fn slope(&self, theta: f64) -> f64 {
        let (al, s, (sin, cos)) = self.at(theta);
        self.stiffness
            * al
            * (cos * (1.0 - self.free_length / s) - self.free_length * al * sin * sin / s.powi(3))
    }

    fn at(&self, theta: f64) -> (f64, f64, (f64, f64)) {
        let (a, l) = (self.fixed_radius, self.arm_radius);
        let (sin, cos) = (self.angle + theta).sin_cos();
        (a * l, (a * a + l * l + 2.0 * a * l * cos).sqrt(), (sin, cos))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arms::spring_energy;

    fn some() -> Compensator {
        Compensator {
            joint: 1,
            fixed_radius: 0.69,
            arm_radius: 0.185,
            angle: 0.17,
            free_length: 0.458,
            stiffness: 7e6,
        }
    }

    #[test]
    fn torque_is_the_negative_energy_gradient_and_slope_its_derivative() {
        let (c, h) = (some(), 1e-5);
        for i in 0..40 {
            let theta = -2.0 + 0.1 * f64::from(i);
            let torque = -(spring_energy(&c, theta + h) - spring_energy(&c, theta - h)) / (2.0 * h);
            let slope = (c.torque(theta + h) - c.torque(theta - h)) / (2.0 * h);
            // h^2 of the third derivative (some 1e6) and the rounding of 1e6 J over h.
            assert!((c.torque(theta) - torque).abs() < 1e-4, "{theta}: {torque}");
            assert!((c.slope(theta) - slope).abs() < 1e-3, "{theta}: {slope}");
        }
    }

    #[test]
    fn a_spring_along_the_lever_makes_no_torque() {
        let c = some();
        assert!(c.torque(-c.angle).abs() < 1e-9);
    }

    /// Counterbalance of a KUKA KR 300 R2500 ultra: gas in a cylinder between two points. The spring is a line by least squares (numpy) through nine measured pressures over the length.
    /// It meets them within 1.6 bar, the rms of their law `p = n R T/(V - A (s - s_0))` from the same source being 1.8 bar, and the torque of that law within 1.2 % of its maximum.
    /// Source: Weigand, Gajanan, Harttig 2021, data of a KR 300 (MIT licence).
    #[test]
    fn a_gas_counterbalance_is_a_spring_between_two_points() {
        let pressures = [170.0, 167.0, 164.0, 162.0, 164.0, 170.0, 180.0, 190.0, 200.0];
        let area = std::f64::consts::PI / 4.0 * (0.055_f64.powi(2) - 0.03_f64.powi(2));
        let spring = Compensator {
            joint: 1,
            fixed_radius: 0.8,
            arm_radius: 0.2,
            angle: (95.0_f64 - 180.0).to_radians(),
            free_length: 0.157_38,
            stiffness: 61_144.7,
        };
        let lever = |theta: f64| {
            let (al, s, (sin, _)) = spring.at(theta);
            (al * sin / s, s)
        };
        for (step, bar) in pressures.into_iter().enumerate() {
            let theta = (-120.0 + 10.0 * step as f64).to_radians();
            let found = spring.torque(theta) / lever(theta).0 / area / 1e5;
            assert!((found - bar).abs() < 1.6, "{theta}: {found} bar for {bar}");
        }
        for degree in -120..=-40 {
            let theta = f64::from(degree).to_radians();
            let (arm, s) = lever(theta);
            let gas = 1.01 * 296.8 * 328.0 * 0.159 / (0.000_96 - (s - 0.6) * area) * area * arm;
            assert!(
                (spring.torque(theta) - gas).abs() < 0.012 * 6179.0,
                "{degree}: {gas}"
            );
        }
    }
}

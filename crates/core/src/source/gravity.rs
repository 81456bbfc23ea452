//! Gravity: what the masses do to drives and springs.
//!
//! A drive or spring carries every mass between itself and the tool. Told at the TCP, the weight of what it carries is
//! a wrench, and its torque is the work of that wrench on its screw:
//!
//! ```text
//! tau_k = s_k . [ M_k g ; S_k x g ]        M_k = sum m,  S_k = sum m (r - p)  over the masses that k carries
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `g` | acceleration of free fall, base | m/s^2 |
//! | `m`, `r` | a mass, its centre in base | kg, m |
//! | `p` | TCP in base | m |
//! | `tau_k` | torque on drive or spring k | N m (N) |
//!
//! Source: principle of virtual work; `docs/theory/gravity.md`.

use nalgebra::{IsometryMatrix3, Vector3};

use crate::robot::{Mass, Seat};
use crate::spatial::{Twist, Wrench};

/// The masses that one seat and all after it carry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// `M`, kg.
    pub mass: f64,
    /// `S`: mass times distance from the TCP, kg m, base.
    pub moment: Vector3<f64>,
}

impl Carried {
    /// Nothing is carried.
    pub const NOTHING: Carried = Carried {
        mass: 0.0,
        moment: Vector3::new(0.0, 0.0, 0.0),
    };

    /// The weight as a wrench at the TCP, base; `g` in m/s^2.
    pub fn weight(&self, g: &Vector3<f64>) -> Wrench {
        Wrench {
            force: g * self.mass,
            moment: self.moment.cross(g),
        }
    }
}

/// What each seat carries, by [`Seat::rank`], into `carried`: as many as seats. `seat_frame` gives a seat in base.
pub fn carry_into(
    masses: &[Mass],
    seat_frame: impl Fn(Seat) -> IsometryMatrix3<f64>,
    tcp: Vector3<f64>,
    carried: &mut [Carried],
) {
    let joints = carried.len().saturating_sub(Seat::count(0));
    carried.fill(Carried::NOTHING);
    for mass in masses {
        let here = &mut carried[mass.seat.rank(joints)];
        let centre = (seat_frame(mass.seat) * mass.centre).coords;
        here.mass += mass.mass;
        here.moment += (centre - tcp) * mass.mass;
    }
    for rank in (1..carried.len()).rev() {
        let after = carried[rank];
        let here = &mut carried[rank - 1];
        here.mass += after.mass;
        here.moment += after.moment;
    }
}

/// Torque of the carried weight on a drive or spring with this screw at the TCP, N m (N).
pub fn torque(screw: &Twist, carried: &Carried, g: &Vector3<f64>) -> f64 {
    screw.dot(&carried.weight(g))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn a_mass_on_a_lever_pulls_with_its_arm() {
        // 10 kg at 0.5 m from an axis along y: 10 x 9.81 x 0.5 N m, by the right hand about +y.
        let masses = [Mass {
            seat: Seat::Joint(0),
            mass: 10.0,
            centre: Point3::new(0.5, 0.0, 0.2),
        }];
        let tcp = Vector3::new(1.0, 0.0, 0.0);
        let mut carried = [Carried::NOTHING; 4];
        carry_into(&masses, |_| IsometryMatrix3::identity(), tcp, &mut carried);
        let screw = Twist {
            linear: Vector3::y().cross(&tcp),
            angular: Vector3::y(),
        };
        let g = Vector3::new(0.0, 0.0, -9.81);
        assert!((torque(&screw, &carried[1], &g) - 49.05).abs() < 1e-12);
        assert_eq!(carried[2], Carried::NOTHING);
    }
}

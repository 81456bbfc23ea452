//! Gravity: torques of the masses on drives and springs.
//!
//! A drive or spring carries every mass between itself and the tool. Expressed at the TCP, the weight that it carries
//! is a wrench, and its torque is the work of that wrench on its screw:
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
//! A joint or spring between the part and the ground, of a positioner or of an arm that holds the part, carries the masses on
//! the other side: those of the part and of the links between it and the part. Its motion moves them against its screw:
//! `tau_k = -s_k . [ M_k g ; S_k x g ]`.
//!
//! Source: principle of virtual work; `docs/theory/gravity.md`.

use nalgebra::{IsometryMatrix3, Vector3};

use crate::robot::{Attachment, Mass, MovedBy};
use crate::spatial::{Twist, Wrench};

/// The masses carried by one attachment and all after it.
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

/// Fills `carried` with the masses carried by each attachment, by [`Attachment::rank`]. `attachment_frame` gives the
/// frame of an attachment in base.
pub fn carry_into(
    masses: &[Mass],
    attachment_frame: impl Fn(Attachment) -> IsometryMatrix3<f64>,
    tcp: Vector3<f64>,
    carried: &mut [Carried],
) {
    let joints = carried.len().saturating_sub(Attachment::count(0));
    carried.fill(Carried::NOTHING);
    for mass in masses {
        let here = &mut carried[mass.attachment.rank(joints)];
        let centre = (attachment_frame(mass.attachment) * mass.centre).coords;
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

/// Torque of the weight on a drive or spring with this screw at the TCP, N m (N), by what it moves. `carried` is given by rank.
pub fn torque_by(screw: &Twist, carried: &[Carried], moved: MovedBy, g: &Vector3<f64>) -> f64 {
    match moved {
        MovedBy::Behind(rank) => torque(screw, &carried[rank], g),
        MovedBy::InFront(ranks) => torque_in_front(screw, carried, ranks, g),
    }
}

/// Torque of the weight on a drive or spring between the part and the ground with this screw at the TCP, N m (N). `carried` is
/// given by rank; the masses of the first `ranks` ranks are on its other side.
fn torque_in_front(screw: &Twist, carried: &[Carried], ranks: usize, g: &Vector3<f64>) -> f64 {
    let (all, behind) = (carried[0], carried[ranks]);
    let in_front = Carried {
        mass: all.mass - behind.mass,
        moment: all.moment - behind.moment,
    };
    -torque(screw, &in_front, g)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn the_torque_of_a_mass_is_its_weight_times_its_lever() {
        // 10 kg at 0.5 m from an axis along y: 10 x 9.81 x 0.5 N m, by the right hand about +y.
        let masses = [Mass {
            attachment: Attachment::Joint(0),
            mass: 10.0,
            centre: Point3::new(0.5, 0.0, 0.2),
            inertia: None,
            relative_uncertainty: 0.0,
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

    /// Masses on every attachment of an arm of two joints.
    fn masses() -> Vec<Mass> {
        let mass = |attachment, mass, x| Mass {
            attachment,
            mass,
            centre: Point3::new(x, 0.2, -0.1),
            inertia: None,
            relative_uncertainty: 0.0,
        };
        vec![
            mass(Attachment::Tool, 1.0, 0.3),
            mass(Attachment::Base, 100.0, -0.4),
            mass(Attachment::Joint(0), 30.0, 0.1),
            mass(Attachment::Joint(1), 20.0, 0.5),
            mass(Attachment::Joint(1), 5.0, -0.2),
            mass(Attachment::Flange, 7.0, 0.0),
        ]
    }

    /// A different frame for every attachment.
    fn frame(attachment: Attachment) -> IsometryMatrix3<f64> {
        let rank = attachment.rank(2) as f64;
        IsometryMatrix3::new(
            Vector3::new(rank, 0.1 * rank, 1.0),
            Vector3::new(0.2, -0.3, 0.5) * rank,
        )
    }

    #[test]
    fn the_base_carries_the_whole_weight_and_its_moment() {
        let (tcp, mut carried) = (Vector3::new(1.0, -0.3, 0.4), [Carried::NOTHING; 5]);
        carry_into(&masses(), frame, tcp, &mut carried);
        let g = Vector3::new(0.0, 0.0, -9.81);
        let weight = carried[0].weight(&g);
        assert!((weight.force - g * 163.0).norm() < 1e-12);
        let moment: Vector3<f64> = masses()
            .iter()
            .map(|mass| ((frame(mass.attachment) * mass.centre).coords - tcp).cross(&(g * mass.mass)))
            .sum();
        assert!((weight.moment - moment).norm() < 1e-12);
        // Tool, then flange and tool, then joint 2 and all after it.
        assert_eq!(
            [4, 3, 2, 1].map(|rank: usize| carried[rank].mass),
            [1.0, 8.0, 33.0, 63.0]
        );
    }

    #[test]
    fn a_mass_on_the_base_loads_no_drive() {
        let on_base: Vec<Mass> = masses()
            .into_iter()
            .filter(|mass| mass.attachment == Attachment::Base)
            .collect();
        let mut carried = [Carried::NOTHING; 5];
        carry_into(&on_base, frame, Vector3::zeros(), &mut carried);
        assert!(carried[0].mass == 100.0 && carried[1..].iter().all(|carried| *carried == Carried::NOTHING));
    }

    #[test]
    fn earlier_results_are_overwritten_and_the_order_of_masses_has_no_effect() {
        let (mut once, mut twice) = ([Carried::NOTHING; 5], [Carried::NOTHING; 5]);
        carry_into(&masses(), frame, Vector3::x(), &mut once);
        let mut reversed = masses();
        reversed.reverse();
        for masses in [masses(), reversed] {
            carry_into(&masses, frame, Vector3::x(), &mut twice);
            for (a, b) in once.iter().zip(&twice) {
                assert!((a.mass - b.mass).abs() < 1e-13 && (a.moment - b.moment).norm() < 1e-13);
            }
        }
    }

    #[test]
    fn the_torque_of_a_weight_does_not_depend_on_where_the_tool_is() {
        let axis = Twist::about(Vector3::new(0.0, 0.6, 0.8));
        let g = Vector3::new(0.3, -0.2, -9.81);
        let of = |tcp: Vector3<f64>| {
            let mut carried = [Carried::NOTHING; 5];
            carry_into(&masses(), frame, tcp, &mut carried);
            // The axis goes through (0.5, 0, 0).
            torque(&axis.moved(tcp - Vector3::x() * 0.5), &carried[2], &g)
        };
        let (here, there) = (of(Vector3::zeros()), of(Vector3::new(2.0, -1.0, 3.0)));
        // Some kN m.
        assert!((here - there).abs() < 1e-11, "{here} {there}");
        assert!(here.abs() > 1.0);
    }
}

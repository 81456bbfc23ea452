//! Inertia of the bodies that a drive or spring moves, about one point.
//!
//! Of bodies that move together by the twist `[v; w]` of the point `p`, the momentum is
//!
//! ```text
//! P = m v + w x S          L = S x v + I w          T = (v . P + w . L) / 2
//! S = sum m_b d_b          I = sum ( I_b + m_b (d_b^2 1 - d_b d_b^T) )          d_b = r_b - p
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `m_b`, `r_b`, `I_b` | mass of a body, its centre, its inertia about its centre; base | kg, m, kg m^2 |
//! | `p` | reference point: the TCP; base | m |
//! | `P`, `L` | momentum, angular momentum about `p` | kg m/s, kg m^2/s |
//! | `T` | kinetic energy | J |
//!
//! Source: any textbook on mechanics of rigid bodies; Featherstone, Rigid body dynamics algorithms, 2.13 (recalled).

use nalgebra::{IsometryMatrix3, Matrix3, Vector3};

use crate::robot::{Attachment, Mass, MovedBy};
use crate::spatial::{Twist, Wrench};

/// Inertia of bodies that move together, about the TCP, base axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// `m`, kg.
    pub mass: f64,
    /// `S`, kg m.
    pub moment: Vector3<f64>,
    /// `I`, kg m^2.
    pub inertia: Matrix3<f64>,
}

impl Inertia {
    /// Of no body.
    pub const NONE: Inertia = Inertia {
        mass: 0.0,
        moment: Vector3::new(0.0, 0.0, 0.0),
        inertia: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    /// Of one body whose attachment is in this frame (base), about `tcp` (m, base).
    pub fn of_mass(mass: &Mass, base_from_attachment: &IsometryMatrix3<f64>, tcp: &Vector3<f64>) -> Inertia {
        let d = (base_from_attachment * mass.centre).coords - tcp;
        let turn = base_from_attachment.rotation.matrix();
        let own = mass
            .inertia
            .map_or_else(Matrix3::zeros, |own| turn * own * turn.transpose());
        Inertia {
            mass: mass.mass,
            moment: d * mass.mass,
            inertia: own + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * mass.mass,
        }
    }

    /// Adds further bodies that move together with these.
    pub fn add(&mut self, other: &Inertia) {
        self.mass += other.mass;
        self.moment += other.moment;
        self.inertia += other.inertia;
    }

    /// Momentum and angular momentum per unit of motion by this twist of the TCP, base.
    pub fn momentum(&self, twist: &Twist) -> Wrench {
        Wrench {
            force: twist.linear * self.mass + twist.angular.cross(&self.moment),
            moment: self.moment.cross(&twist.linear) + self.inertia * twist.angular,
        }
    }
}

/// Inertia of the bodies that each attachment carries.
#[derive(Clone, Debug)]
pub struct CarriedInertia {
    /// Of each attachment and all behind it, by rank.
    behind: Vec<Inertia>,
    /// Of each attachment and all in front of it, by rank.
    in_front: Vec<Inertia>,
}

impl CarriedInertia {
    /// Of a chain of this many joints, without bodies.
    pub fn for_joints(joints: usize) -> CarriedInertia {
        let none = vec![Inertia::NONE; Attachment::count(joints)];
        CarriedInertia {
            behind: none.clone(),
            in_front: none,
        }
    }

    /// Evaluates it for these bodies about `tcp` (m, base); `attachment_frame` gives the frame of an attachment in base.
    pub fn set(
        &mut self,
        masses: &[Mass],
        attachment_frame: impl Fn(Attachment) -> IsometryMatrix3<f64>,
        tcp: &Vector3<f64>,
    ) {
        let ranks = self.behind.len();
        let joints = ranks - Attachment::count(0);
        self.behind.fill(Inertia::NONE);
        for mass in masses {
            let frame = attachment_frame(mass.attachment);
            self.behind[mass.attachment.rank(joints)].add(&Inertia::of_mass(mass, &frame, tcp));
        }
        self.in_front.copy_from_slice(&self.behind);
        for rank in 1..ranks {
            let before = self.in_front[rank - 1];
            self.in_front[rank].add(&before);
        }
        for rank in (1..ranks).rev() {
            let after = self.behind[rank];
            self.behind[rank - 1].add(&after);
        }
    }

    /// Inertia of the bodies that both of two drives or springs move; `None` where they move different bodies.
    pub fn moved_by_both(&self, one: MovedBy, other: MovedBy) -> Option<&Inertia> {
        match (one, other) {
            (MovedBy::Behind(a), MovedBy::Behind(b)) => self.behind.get(a.max(b)),
            (MovedBy::InFront(a), MovedBy::InFront(b)) => self.in_front.get(a.min(b).checked_sub(1)?),
            // The ground is between them.
            (MovedBy::Behind(_), MovedBy::InFront(_)) | (MovedBy::InFront(_), MovedBy::Behind(_)) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;

    #[test]
    fn kinetic_energy_is_that_of_a_rod_about_its_end() {
        // A rod of 2 m and 3 kg along x about z: m l^2 / 3 = 4 kg m^2 at its end.
        let rod = Mass {
            attachment: Attachment::Base,
            mass: 3.0,
            centre: Point3::new(1.0, 0.0, 0.0),
            inertia: Some(Matrix3::from_diagonal(&Vector3::new(0.0, 1.0, 1.0))),
            relative_uncertainty: 0.0,
        };
        let at_end = Inertia::of_mass(&rod, &IsometryMatrix3::identity(), &Vector3::zeros());
        let turn = Twist::about(Vector3::z());
        assert!((turn.dot(&at_end.momentum(&turn)) - 4.0).abs() < 1e-14);
        // The same turn about the same axis, with another reference point.
        let by = Vector3::new(0.3, -2.0, 0.7);
        let elsewhere = Inertia::of_mass(&rod, &IsometryMatrix3::identity(), &by);
        let moved = turn.moved(by);
        assert!((moved.dot(&elsewhere.momentum(&moved)) - 4.0).abs() < 1e-13);
    }

    #[test]
    fn inertia_turns_with_its_attachment() {
        let rod = Mass {
            attachment: Attachment::Base,
            mass: 0.0,
            centre: Point3::origin(),
            inertia: Some(Matrix3::from_diagonal(&Vector3::new(0.0, 1.0, 1.0))),
            relative_uncertainty: 0.0,
        };
        let frame = IsometryMatrix3::rotation(Vector3::z() * std::f64::consts::FRAC_PI_2);
        let turned = Inertia::of_mass(&rod, &frame, &Vector3::zeros()).inertia;
        assert!((turned - Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0))).norm() < 1e-15);
    }
}

//! One joint: its coordinate in the controller, limits, speed and compliance.
//!
//! The controller's (or URDF's) position `q` and the chain's position `theta` are tied by
//!
//! `theta_i = sign_i (q_i + sum_j k_ij q_j) + offset_i`
//!
//! with `k_ij` the coupling to earlier joints (FANUC measures joint 3 from the horizontal: `k_32 = 1`).
//! Limits and speeds refer to `q`; the compliance is that of the joint itself and therefore of `theta`.
//!
//! | symbol | unit | range |
//! |---|---|---|
//! | `q`, `theta`, `offset`, limits | rad (m for a prismatic joint) | finite |
//! | compliance `c` and its standard uncertainty | rad/(N m) (m/N) | >= 0 |

/// The range of a joint in controller coordinates, rad or m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least position.
    pub lower: f64,
    /// Greatest position.
    pub upper: f64,
}

impl Limits {
    /// Distance to the nearer limit, negative outside.
    pub fn margin(&self, q: f64) -> f64 {
        (q - self.lower).min(self.upper - q)
    }

    /// The middle of the range.
    pub fn middle(&self) -> f64 {
        0.5 * (self.lower + self.upper)
    }
}

/// Rotation of a joint per moment about its axis; drive and control loop included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointCompliance {
    /// `c`, rad/(N m) or m/N.
    pub value: f64,
    /// Standard uncertainty of `c`, same unit; zero where it is not known.
    pub standard_uncertainty: f64,
}

impl JointCompliance {
    /// The standard uncertainty; `None` where it is not known.
    pub fn known_uncertainty(&self) -> Option<f64> {
        (self.standard_uncertainty > 0.0).then_some(self.standard_uncertainty)
    }
}

/// Softest joint, rad/(N m) (m/N): a newton metre turns no machining joint by a radian.
pub const SOFTEST: f64 = 1.0;

/// An earlier joint whose position is added to this one's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Index of the other joint: an earlier one.
    pub joint: usize,
    /// Factor `k_ij`.
    pub factor: f64,
}

/// Positive direction of a joint relative to the right hand about its axis in the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// With the right hand.
    Positive,
    /// Against it.
    Negative,
}

impl Sign {
    /// 1 or -1.
    pub fn factor(self) -> f64 {
        match self {
            Sign::Positive => 1.0,
            Sign::Negative => -1.0,
        }
    }
}

/// A joint in the coordinates of its controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The maker's name, such as `S` or `A1`.
    pub name: String,
    /// Positive direction.
    pub sign: Sign,
    /// Chain position at the controller's zero, rad or m.
    pub zero_offset: f64,
    /// Coupled earlier joints.
    pub coupling: Vec<Coupling>,
    /// Range, if known.
    pub limits: Option<Limits>,
    /// Greatest speed, rad/s or m/s, if known.
    pub max_speed: Option<f64>,
}

impl Joint {
    /// A joint with the coordinate of the chain, without known limits or speed.
    pub fn plain(name: impl Into<String>) -> Joint {
        Joint {
            name: name.into(),
            sign: Sign::Positive,
            zero_offset: 0.0,
            coupling: Vec::new(),
            limits: None,
            max_speed: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margin_is_the_distance_to_the_nearer_limit_and_negative_outside() {
        let limits = Limits {
            lower: -1.0,
            upper: 2.0,
        };
        assert_eq!(limits.margin(1.5), 0.5);
        assert_eq!(limits.margin(-1.25), -0.25);
    }

    #[test]
    fn the_margin_is_largest_in_the_middle_and_zero_at_the_limits() {
        let limits = Limits {
            lower: -1.0,
            upper: 2.0,
        };
        assert_eq!(limits.middle(), 0.5);
        assert_eq!(limits.margin(limits.middle()), 1.5);
        assert_eq!((limits.margin(-1.0), limits.margin(2.0)), (0.0, 0.0));
        for step in 0..100 {
            let q = -3.0 + 0.08 * f64::from(step);
            assert!(limits.margin(q) <= 1.5);
            assert_eq!(limits.margin(q) >= 0.0, (-1.0..=2.0).contains(&q));
        }
    }

    #[test]
    fn a_plain_joint_has_the_coordinate_of_the_chain() {
        let plain = Joint::plain("A1");
        assert_eq!(
            (plain.name.as_str(), plain.sign.factor(), plain.zero_offset),
            ("A1", 1.0, 0.0)
        );
        assert!(plain.coupling.is_empty() && plain.limits.is_none() && plain.max_speed.is_none());
        assert_eq!(Sign::Negative.factor(), -1.0);
    }
}

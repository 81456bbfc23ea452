//! Why a tool pose has no posture, and by how much it is missed.

use std::fmt;

/// Why a tool pose has no posture, and by how much it misses. Lengths m, angles rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreachable {
    /// The wrist centre is `by` farther from the shoulder than the stretched arm.
    TooFar {
        /// m
        by: f64,
    },
    /// The wrist centre is `by` nearer to the shoulder than the folded arm.
    TooNear {
        /// m
        by: f64,
    },
    /// The wrist centre is `by` inside the lateral offset about the first axis.
    InsideLateralOffset {
        /// m
        by: f64,
    },
    /// No start of a search led to the pose, which may still be within reach; the nearest posture found misses it by
    /// `by` and `turned`.
    NotFound {
        /// m
        by: f64,
        /// rad
        turned: f64,
    },
    /// The closed form gave a posture whose forward kinematics misses the pose by `by`: the geometry is inconsistent.
    Unverified {
        /// m
        by: f64,
    },
    /// Every requested posture leaves the range of a joint; in the best one, joint `joint` by `by`.
    OutsideLimits {
        /// Index of the joint, from 0.
        joint: usize,
        /// By how much.
        by: Overrun,
    },
    /// The pose has postures, but none in the requested branches.
    OtherBranch,
    /// The pose has a posture, but under this load case the arm has no stable equilibrium.
    Unstable {
        /// Index of the load case, from 0.
        case: usize,
    },
    /// Every requested posture has two bodies nearer to each other than demanded.
    InCollision {
        /// How much of the demanded clearance is missing in the best one, m.
        missing: f64,
        /// The two bodies: indices of [`crate::clearance::Cell::name`].
        bodies: [usize; 2],
    },
}

/// By how much a joint is outside its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Overrun {
    /// A revolute joint, rad.
    Turned(f64),
    /// A prismatic joint, m.
    Slid(f64),
}

impl Unreachable {
    /// By how much it misses, m; `None` where no length is missed: a revolute joint outside its limits, another branch,
    /// an arm without equilibrium.
    pub fn amount(&self) -> Option<f64> {
        match *self {
            Unreachable::TooFar { by }
            | Unreachable::TooNear { by }
            | Unreachable::InsideLateralOffset { by }
            | Unreachable::NotFound { by, .. }
            | Unreachable::Unverified { by }
            | Unreachable::InCollision { missing: by, .. }
            | Unreachable::OutsideLimits {
                by: Overrun::Slid(by),
                ..
            } => Some(by),
            Unreachable::OutsideLimits { .. } | Unreachable::OtherBranch | Unreachable::Unstable { .. } => {
                None
            }
        }
    }

    /// Whether this misses by less than `other`. A radian outside a limit equals a metre; an arm without equilibrium
    /// misses most.
    pub(crate) fn is_nearer_than(&self, other: &Unreachable) -> bool {
        let size = |miss: &Unreachable| match *miss {
            Unreachable::OutsideLimits {
                by: Overrun::Turned(by),
                ..
            } => by,
            _ => miss.amount().unwrap_or(f64::INFINITY),
        };
        size(self) < size(other)
    }

    /// One word for tables.
    pub fn word(&self) -> &'static str {
        match self {
            Unreachable::TooFar { .. } => "too_far",
            Unreachable::TooNear { .. } => "too_near",
            Unreachable::InsideLateralOffset { .. } => "inside_lateral_offset",
            Unreachable::NotFound { .. } => "not_found",
            Unreachable::Unverified { .. } => "unverified",
            Unreachable::OutsideLimits { .. } => "no_posture_inside_limits",
            Unreachable::OtherBranch => "other_branch",
            Unreachable::Unstable { .. } => "unstable",
            Unreachable::InCollision { .. } => "in_collision",
        }
    }
}

impl fmt::Display for Unreachable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unreachable::TooFar { by } => {
                write!(
                    f,
                    "out of reach: the wrist centre is {:.1} mm beyond the stretched arm",
                    by * 1e3
                )
            }
            Unreachable::TooNear { by } => {
                write!(
                    f,
                    "too near: the wrist centre is {:.1} mm inside the folded arm",
                    by * 1e3
                )
            }
            Unreachable::InsideLateralOffset { by } => {
                write!(
                    f,
                    "too near: the wrist centre is {:.1} mm inside the lateral offset",
                    by * 1e3
                )
            }
            Unreachable::NotFound { by, turned } => {
                write!(
                    f,
                    "no posture was found, which does not prove that there is none: the nearest misses by {:.1} mm and {:.2} deg",
                    by * 1e3,
                    turned.to_degrees()
                )
            }
            Unreachable::Unverified { by } => {
                write!(
                    f,
                    "the inverse kinematics misses the pose by {:.6} mm: no posture is reported",
                    by * 1e3
                )
            }
            Unreachable::OutsideLimits { joint, by } => {
                let joint = joint + 1;
                f.write_str(
                    "no posture is within the joint limits: the best one exceeds the range of joint number ",
                )?;
                match by {
                    Overrun::Turned(by) => write!(f, "{joint} by {:.1} deg", by.to_degrees()),
                    Overrun::Slid(by) => write!(f, "{joint} by {:.1} mm", by * 1e3),
                }
            }
            Unreachable::OtherBranch => {
                f.write_str("the pose has a posture, but none in the requested branches")
            }
            Unreachable::Unstable { case } => write!(
                f,
                "the arm has no stable equilibrium under load case {}: it buckles, or is far too compliant",
                case + 1
            ),
            Unreachable::InCollision { missing, .. } => {
                f.write_str("no posture keeps the demanded clearance: ")?;
                if *missing > 0.0 {
                    write!(f, "in the best one {:.1} mm are missing", missing * 1e3)
                } else {
                    f.write_str("in the best one two bodies touch")
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outside(by: Overrun) -> Unreachable {
        Unreachable::OutsideLimits { joint: 2, by }
    }

    /// Each reason with its word, its amount (m) and the end of its sentence.
    fn all() -> [(Unreachable, &'static str, Option<f64>, &'static str); 11] {
        let collision = |missing: f64| Unreachable::InCollision {
            missing,
            bodies: [1, 7],
        };
        [
            (
                collision(0.0123),
                "in_collision",
                Some(0.0123),
                "12.3 mm are missing",
            ),
            (collision(0.0), "in_collision", Some(0.0), "two bodies touch"),
            (
                Unreachable::TooFar { by: 0.0123 },
                "too_far",
                Some(0.0123),
                "is 12.3 mm beyond the stretched arm",
            ),
            (
                Unreachable::TooNear { by: 0.0123 },
                "too_near",
                Some(0.0123),
                "is 12.3 mm inside the folded arm",
            ),
            (
                Unreachable::InsideLateralOffset { by: 0.0123 },
                "inside_lateral_offset",
                Some(0.0123),
                "is 12.3 mm inside the lateral offset",
            ),
            (
                Unreachable::NotFound {
                    by: 0.0123,
                    turned: 0.5_f64.to_radians(),
                },
                "not_found",
                Some(0.0123),
                "the nearest misses by 12.3 mm and 0.50 deg",
            ),
            (
                Unreachable::Unverified { by: 2e-6 },
                "unverified",
                Some(2e-6),
                "by 0.002000 mm: no posture is reported",
            ),
            (
                outside(Overrun::Turned(1.5_f64.to_radians())),
                "no_posture_inside_limits",
                None,
                "the range of joint number 3 by 1.5 deg",
            ),
            (
                outside(Overrun::Slid(0.0123)),
                "no_posture_inside_limits",
                Some(0.0123),
                "the range of joint number 3 by 12.3 mm",
            ),
            (
                Unreachable::OtherBranch,
                "other_branch",
                None,
                "but none in the requested branches",
            ),
            (
                Unreachable::Unstable { case: 1 },
                "unstable",
                None,
                "under load case 2: it buckles, or is far too compliant",
            ),
        ]
    }

    #[test]
    fn every_reason_has_a_word_an_amount_and_a_sentence_with_its_unit() {
        for (miss, word, amount, ends) in all() {
            assert_eq!((miss.word(), miss.amount()), (word, amount));
            assert!(miss.to_string().ends_with(ends), "{miss}");
        }
    }

    #[test]
    fn the_smaller_miss_is_nearer_and_an_arm_without_equilibrium_the_farthest() {
        let (small, large) = (
            Unreachable::TooFar { by: 1e-3 },
            Unreachable::TooNear { by: 2e-3 },
        );
        assert!(small.is_nearer_than(&large) && !large.is_nearer_than(&small));
        assert!(!small.is_nearer_than(&small));
        // A radian equals a metre.
        assert!(outside(Overrun::Turned(1.5e-3)).is_nearer_than(&large));
        assert!(small.is_nearer_than(&outside(Overrun::Turned(1.5e-3))));
        assert!(outside(Overrun::Slid(1.5e-3)).is_nearer_than(&large));
        for (miss, ..) in all() {
            let unstable = Unreachable::Unstable { case: 0 };
            assert!(!unstable.is_nearer_than(&miss));
            let has_size = miss.amount().is_some() || matches!(miss, Unreachable::OutsideLimits { .. });
            assert_eq!(miss.is_nearer_than(&unstable), has_size);
        }
    }
}

//! The kind of inverse of an arm: a closed list, determined once from the chain.
//!
//! | kind | arm | postures |
//! |---|---|---|
//! | [`Inverse::Closed`] | a [`ClosedForm`] is exact | up to eight, by name |
//! | [`Inverse::Polished`] | within 10 mm and 10 mrad of a closed form: a calibrated arm | those of the ideal arm, by name, each refined by damped least squares |
//! | [`Inverse::SphericalWrist`] | the axes of three joints at one end meet in a point, within 10 mm | up to eight, without names |
//! | [`Inverse::OneFixed`] | seven revolute joints, one of which can be fixed so that a spherical wrist remains | those of the other six |
//! | [`Inverse::Searched`] | any other chain | those that descents from many starts find |
//! | [`Inverse::InHand`] | an arm that holds the part, read from its flange back | those of the arm |
//! | [`Inverse::OnRail`] | external axes first: prismatic joints of a chain of more than six, joints of a positioner, joints stated to be external | the external axes are fixed, the rest has its own inverse |

use std::fmt;

use super::super::chain::{Amount, Chain, Motion};
use super::closed_form::ClosedForm;
use super::fixed_joint::FixedJoint;
use super::ortho_parallel::OrthoParallel;
use super::spherical_wrist::SphericalWrist;
use crate::frame::Isometry;

/// How the postures of a chain are found.
#[derive(Clone, Debug)]
pub enum Inverse {
    /// In closed form.
    Closed(ClosedForm),
    /// From the closed form of the ideal arm next to it.
    Polished(ClosedForm),
    /// In closed form, or from the closed form of the arm with intersecting wrist axes.
    SphericalWrist(Box<SphericalWrist>),
    /// One redundant joint is fixed, the others have a spherical wrist.
    OneFixed(Box<FixedJoint>),
    /// From many starts.
    Searched,
    /// On fixed external axes.
    OnRail(Box<Rail>),
    /// That of the arm that holds the part.
    InHand(Box<Inverse>),
}

/// External axes in front of an arm: a rail or gantry that carries it, a positioner that carries the part.
#[derive(Clone, Debug)]
pub struct Rail {
    /// Number of external axes.
    pub(super) joints: usize,
    /// The motions of the external axes, base to arm.
    pub(super) motions: Vec<Motion>,
    /// The chain on the rail.
    pub(super) chain: Chain,
    /// The inverse of that chain; never itself a rail.
    pub(super) inverse: Inverse,
}

impl Rail {
    /// Number of external axes.
    pub(crate) fn joints(&self) -> usize {
        self.joints
    }

    /// The chain on the rail.
    pub(crate) fn chain(&self) -> &Chain {
        &self.chain
    }

    /// Frame of the rail's end for the chain position `theta` of each joint, rad (m).
    pub(crate) fn base_from_arm(&self, theta: impl Fn(usize) -> f64) -> Isometry {
        end_of(&self.motions, theta)
    }
}

/// Frame at the end of the `motions` of a rail for the chain position `theta` of each joint, rad (m).
pub(super) fn end_of(motions: &[Motion], theta: impl Fn(usize) -> f64) -> Isometry {
    let amount = |motion: &Motion| match motion.amount() {
        Amount::Constant(value) => value,
        Amount::Joint(joint) => theta(joint),
    };
    let displacements = motions.iter().map(|motion| motion.displacement(amount(motion)));
    displacements.fold(Isometry::identity(), |end, displacement| end * displacement)
}

/// Joints needed for any pose: further ones are redundant.
pub(super) const ENOUGH: usize = 6;

impl Inverse {
    /// The inverse of `chain`.
    pub fn recognise(chain: &Chain) -> Inverse {
        Inverse::on_rail(chain).unwrap_or_else(|| {
            let closed = ClosedForm::recognise(chain).map(Inverse::Closed);
            // Names first: an arm close to one with named branches has the names, even where its wrist is exact.
            closed
                .or_else(|| ClosedForm::next_to(chain).map(Inverse::Polished))
                .or_else(|| Inverse::with_wrist(chain))
                .unwrap_or(Inverse::Searched)
        })
    }

    fn with_wrist(chain: &Chain) -> Option<Inverse> {
        let wrist = SphericalWrist::recognise(chain).or_else(|| SphericalWrist::next_to(chain));
        let six = wrist.map(|wrist| Inverse::SphericalWrist(Box::new(wrist)));
        six.or_else(|| Some(Inverse::OneFixed(Box::new(FixedJoint::recognise(chain)?))))
    }

    fn on_rail(chain: &Chain) -> Option<Inverse> {
        let slides = |motion: &Motion| matches!(motion, Motion::Along(..));
        let external = chain.external();
        let to_spare = chain.links().len().saturating_sub(ENOUGH);
        let more = chain.links().iter().take(to_spare).skip(external);
        let joints = external + more.take_while(|link| slides(&link.motion)).count();
        let (motions, rest) = (joints > 0).then(|| chain.split(joints))??;
        let inverse = Inverse::recognise(&rest);
        Some(Inverse::OnRail(Box::new(Rail {
            joints,
            motions,
            chain: rest,
            inverse,
        })))
    }

    /// The inverse of the arm itself, without a rail.
    pub(crate) fn of_arm(&self) -> &Inverse {
        match self {
            Inverse::OnRail(rail) => &rail.inverse,
            Inverse::InHand(arm) => arm.of_arm(),
            own => own,
        }
    }

    /// Number of external axes in front of the arm.
    pub(crate) fn rail_joints(&self) -> usize {
        match self {
            Inverse::OnRail(rail) => rail.joints,
            _ => 0,
        }
    }

    /// The closed form that names the branches of the arm, if they have names.
    pub(super) fn names(&self) -> Option<&ClosedForm> {
        match self.of_arm() {
            Inverse::Closed(form) | Inverse::Polished(form) => Some(form),
            _ => None,
        }
    }

    /// Whether its branches have names.
    pub fn has_branches(&self) -> bool {
        self.names().is_some()
    }

    /// Whether flip and no-flip give the same compliance.
    pub fn flips_are_alike(&self) -> bool {
        matches!(self.of_arm(), Inverse::Closed(form) if form.flips_are_alike())
    }

    /// The ortho-parallel geometry, of an arm of exactly this kind.
    pub fn ortho_parallel(&self) -> Option<&OrthoParallel> {
        match self {
            Inverse::Closed(ClosedForm::OrthoParallel(arm)) => Some(arm),
            _ => None,
        }
    }

    /// One word for JSON: `closed_form`, `polished`, `searched`; for an arm on a rail that of the arm.
    pub fn word(&self) -> &'static str {
        match self.of_arm() {
            Inverse::Closed(_) => "closed_form",
            Inverse::SphericalWrist(form) if form.is_exact() => "closed_form",
            Inverse::OneFixed(fixed) if fixed.is_exact() => "closed_form",
            Inverse::Polished(_) | Inverse::SphericalWrist(_) | Inverse::OneFixed(_) => "polished",
            _ => "searched",
        }
    }
}

impl fmt::Display for Inverse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = |form: &ClosedForm| match form {
            ClosedForm::OrthoParallel(_) => "ortho-parallel arm with spherical wrist",
            ClosedForm::ThreeParallel(_) => "arm with three parallel axes",
        };
        match self {
            Inverse::Closed(form) => write!(f, "closed form, up to 8 postures ({})", of(form)),
            Inverse::Polished(form) => write!(
                f,
                "numeric from a closed form, up to 8 postures (nearly an {})",
                of(form)
            ),
            Inverse::SphericalWrist(form) if form.is_exact() => {
                f.write_str("closed form, up to 8 postures without names (spherical wrist)")
            }
            Inverse::SphericalWrist(_) => f.write_str(
                "numeric from a closed form, up to 8 postures without names (nearly a spherical wrist)",
            ),
            Inverse::OneFixed(fixed) => write!(
                f,
                "{}, up to 8 postures without names (spherical wrist); joint {} is fixed",
                if fixed.is_exact() {
                    "closed form"
                } else {
                    "numeric from a closed form"
                },
                fixed.joint + 1
            ),
            Inverse::InHand(arm) => write!(f, "{arm}; the part is in its hand"),
            Inverse::Searched => f.write_str("numeric from many starts: the postures that are found"),
            Inverse::OnRail(rail) => write!(
                f,
                "{}; the first {} fixed",
                rail.inverse,
                if rail.joints == 1 {
                    "joint is".to_owned()
                } else {
                    format!("{} joints are", rail.joints)
                }
            ),
        }
    }
}

#[cfg(test)]
mod tests;

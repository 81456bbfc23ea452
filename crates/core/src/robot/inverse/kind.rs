//! Which inverse an arm has: a closed list, read off the chain once.
//!
//! | kind | arm | postures |
//! |---|---|---|
//! | [`Inverse::Closed`] | a [`ClosedForm`] holds exactly | up to eight, by name |
//! | [`Inverse::Polished`] | within 10 mm and 10 mrad of a closed form: a calibrated arm | those of the ideal arm, by name, each brought to the true one by damped least squares |
//! | [`Inverse::SphericalWrist`] | the axes of three joints at one end meet in a point, within 10 mm | up to eight, without names |
//! | [`Inverse::OneStands`] | seven turning joints, one of which can stand still and leave a spherical wrist | those of the other six |
//! | [`Inverse::Searched`] | any other chain | those that descents from many starts find |
//! | [`Inverse::OnRail`] | more than six joints, sliding ones first | the sliding joints stand still, the rest has an inverse of its own |

use std::fmt;

use super::super::chain::{Chain, Motion};
use super::closed_form::ClosedForm;
use super::ortho_parallel::OrthoParallel;
use super::spherical_wrist::SphericalWrist;
use super::fixed_joint::FixedJoint;

/// How the postures of a chain are found.
#[derive(Clone, Debug)]
pub enum Inverse {
    /// In closed form.
    Closed(ClosedForm),
    /// From the closed form of the ideal arm next to it.
    Polished(ClosedForm),
    /// In closed form, or from the closed form of the arm whose wrist axes meet.
    SphericalWrist(Box<SphericalWrist>),
    /// One joint to spare stands still, the others have a spherical wrist.
    OneStands(Box<FixedJoint>),
    /// From many starts.
    Searched,
    /// On sliding joints that stand still.
    OnRail(Box<Rail>),
}

/// Sliding joints that carry an arm.
#[derive(Clone, Debug)]
pub struct Rail {
    /// How many slide.
    pub(super) joints: usize,
    /// The motions of the rail, base to arm.
    pub(super) motions: Vec<Motion>,
    /// The chain that it carries.
    pub(super) chain: Chain,
    /// The inverse of that chain; never a rail itself.
    pub(super) inverse: Inverse,
}

/// Joints that hold any pose: more of them leave some to spare.
pub(super) const ENOUGH: usize = 6;

impl Inverse {
    /// The inverse of `chain`.
    pub fn recognise(chain: &Chain) -> Inverse {
        Inverse::on_rail(chain).unwrap_or_else(|| {
            let closed = ClosedForm::recognise(chain).map(Inverse::Closed);
            // Names first: an arm that is nearly one with names keeps them, even where its wrist is exact.
            closed
                .or_else(|| ClosedForm::next_to(chain).map(Inverse::Polished))
                .or_else(|| Inverse::with_wrist(chain))
                .unwrap_or(Inverse::Searched)
        })
    }

    fn with_wrist(chain: &Chain) -> Option<Inverse> {
        let wrist = SphericalWrist::recognise(chain).or_else(|| SphericalWrist::next_to(chain));
        let six = wrist.map(|wrist| Inverse::SphericalWrist(Box::new(wrist)));
        six.or_else(|| Some(Inverse::OneStands(Box::new(FixedJoint::recognise(chain)?))))
    }

    fn on_rail(chain: &Chain) -> Option<Inverse> {
        let slides = |motion: &Motion| matches!(motion, Motion::Along(..));
        let to_spare = chain.links().len().saturating_sub(ENOUGH);
        let joints = chain
            .links()
            .iter()
            .take(to_spare)
            .take_while(|link| slides(&link.motion))
            .count();
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
    pub(super) fn of_arm(&self) -> &Inverse {
        match self {
            Inverse::OnRail(rail) => &rail.inverse,
            own => own,
        }
    }

    /// The closed form that names the branches of the arm, if they have names.
    pub(super) fn names(&self) -> Option<&ClosedForm> {
        match self.of_arm() {
            Inverse::Closed(form) | Inverse::Polished(form) => Some(form),
            _ => None,
        }
    }

    /// Whether its postures are branches with names.
    pub fn has_branches(&self) -> bool {
        self.names().is_some()
    }

    /// Whether flip and no-flip give the same compliance.
    pub fn flips_are_alike(&self) -> bool {
        matches!(self.of_arm(), Inverse::Closed(form) if form.flips_are_alike())
    }

    /// The ortho-parallel geometry, of an arm that is nothing but it.
    pub fn ortho_parallel(&self) -> Option<&OrthoParallel> {
        match self {
            Inverse::Closed(ClosedForm::OrthoParallel(arm)) => Some(arm),
            _ => None,
        }
    }

    /// One word for JSON: `closed_form`, `polished`, `searched`; of an arm on a rail that of the arm.
    pub fn word(&self) -> &'static str {
        match self.of_arm() {
            Inverse::Closed(_) => "closed_form",
            Inverse::SphericalWrist(form) if form.is_exact() => "closed_form",
            Inverse::OneStands(arm_state) if arm_state.is_exact() => "closed_form",
            Inverse::Polished(_) | Inverse::SphericalWrist(_) | Inverse::OneStands(_) => "polished",
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
            Inverse::OneStands(arm_state) => write!(
                f,
                "{}, up to 8 postures without names (spherical wrist); joint {} stands still",
                if arm_state.is_exact() {
                    "closed form"
                } else {
                    "numeric from a closed form"
                },
                arm_state.joint + 1
            ),
            Inverse::Searched => f.write_str("numeric from many starts: the postures that are found"),
            Inverse::OnRail(rail) => write!(
                f,
                "{}; the first {} stand{} still",
                rail.inverse,
                if rail.joints == 1 {
                    "joint".to_owned()
                } else {
                    format!("{} joints", rail.joints)
                },
                if rail.joints == 1 { "s" } else { "" }
            ),
        }
    }
}

#[cfg(test)]
mod tests;

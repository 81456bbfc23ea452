//! **The main idea.** Input: posture and load. Output: the deviation of the tool, with its parts.
//!
//! An arm positions a tool in a posture (`robot::inverse`). Its joints are lines in space; at the tool each is a screw.
//! The load is a wrench on the tool. Each source of error gives a small displacement of the tool, and these add:
//!
//! ```text
//! pose -> posture -> screws s_i        load -> wrench w
//! deviation = elastic(s_i, c_i, w) + gravity(s_i, c_i, masses) + geometric + thermal + learnt + backlash(s_i, b_i, links, w)
//! ```
//!
//! `c_i` is the compliance of joint i (rad/(N m)), `b_i` its backlash from one side to the other (rad). The posture is
//! in `arm_state`. `links`: where in its backlash each link rests (rad, or m for prismatic joints); where the caller does
//! not know it, it is decided from the load and written here. Shares are displacements: they add up to the deviation.
//! Repeatability adds uncertainty only.
//!
//! Maps, holes and single poses use the whole sum. Searches for placements and for the posture of a path use load and
//! gravity only. Along a path geometry, thermal growth, learnt residual and backlash are added in a second step
//! (`map/backlash_geometry.rs`), because friction decides from point to point at which side of its backlash each link
//! rests. `kernel/lanes/load/deviation.rs` repeats the drives-only part for many points per instruction, and
//! `kernel/lanes/whole/` all but a load-dependent equilibrium and a torque curve on the joint of a compensator; both are
//! tested against this function. [`elastic::predict`](crate::source::elastic::predict) is the simple model: joint
//! drives only.
//!
//! Deviation: attained minus commanded position of the tool. Reference point: TCP. Basis: base. Unit: metres here,
//! micrometres in the answers of `study`.

pub use crate::source::Deviation;
use crate::source::{ArmState, Links, Unstable, repeatability};
use crate::spatial::{Twist, Wrench};

/// The deviation of the tool under `wrench`, at the current posture of the arm, by all sources.
///
/// # Errors
/// [`Unstable`] where the arm has no stable equilibrium under the load.
pub fn predict(
    arm_state: &mut ArmState<'_>,
    wrench: &Wrench,
    links: &mut Links<'_>,
) -> Result<Deviation, Unstable> {
    let twist = deviation_of(arm_state, wrench, links)?;
    let (mut shares, mut covariance) = (arm_state.shares(), arm_state.covariance());
    arm_state.add_unloaded(links, wrench, &mut shares, &mut covariance);
    Ok(Deviation {
        twist,
        shares,
        covariance: covariance + repeatability::covariance(arm_state.scatter()),
    })
}

/// The sum of the sources.
pub(crate) fn deviation_of(
    arm_state: &mut ArmState<'_>,
    wrench: &Wrench,
    links: &mut Links<'_>,
) -> Result<Twist, Unstable> {
    let (elastic, gravity) = (arm_state.elastic(wrench)?, arm_state.gravity()?);
    let by_load = gravity.map_or(elastic, |gravity| elastic + gravity);
    arm_state.settle(links, &by_load.linear, wrench);
    Ok(match links.positions() {
        None => by_load,
        Some(links) => by_load + unloaded(arm_state, links, wrench),
    })
}

/// Deviation by geometry, thermal growth, learnt residual and backlash; the `links` are at these positions within their backlash,
/// rad (m).
pub(crate) fn unloaded(arm_state: &ArmState<'_>, links: &[f64], wrench: &Wrench) -> Twist {
    arm_state.geometric() + arm_state.thermal() + arm_state.learnt() + arm_state.backlash(links, wrench)
}

//! **The main idea.** Input: posture and load. Output: the deviation of the tool, with its parts.
//!
//! An arm positions a tool in a posture (`robot::inverse`). Its joints are lines in space; at the tool each is a screw.
//! The load is a wrench on the tool. Each source of error gives a small displacement of the tool, and these add:
//!
//! ```text
//! pose -> posture -> screws s_i        load -> wrench w
//! deviation = elastic(s_i, c_i, w) + gravity(s_i, c_i, masses) + geometric + backlash(s_i, u_i)
//! ```
//!
//! Maps, holes, searches and single poses use this sum. Along a path, geometry and backlash are added in a second step:
//! friction decides from point to point on which side of the backlash the links are.
//! [`elastic::predict`](crate::source::elastic::predict) is the simple model on its own.
//! Reference point: TCP. Basis: base. Deviation = attained position of the tool minus its commanded position.

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
    arm_state.add_unloaded(links, wrench, (&mut shares, &mut covariance));
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
        Some(links) => by_load + geometry_and_backlash(arm_state, links, wrench),
    })
}

/// Deviation by geometry and backlash, with the `links` at these positions within their backlash, rad (m).
pub(crate) fn geometry_and_backlash(arm_state: &ArmState<'_>, links: &[f64], wrench: &Wrench) -> Twist {
    arm_state.geometric() + arm_state.backlash(links, wrench)
}

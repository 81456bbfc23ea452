//! **The main idea.** Posture and load in, deviation of the tool out, with its parts.
//!
//! An arm holds a tool in a posture (`robot::inverse`). Its joints are lines in space; seen from the tool each is a screw.
//! The load is a wrench on the tool. Each source of error gives a small displacement of the tool, and these add:
//!
//! ```text
//! pose -> posture -> screws s_i        load -> wrench w
//! deviation = elastic(s_i, c_i, w) + gravity(s_i, c_i, masses) + geometric + backlash(s_i, u_i)
//! ```
//!
//! Maps, holes, searches and single poses take this sum. Along a path geometry and backlash come in a second step: friction
//! drags links from point to point. [`elastic::predict`](crate::source::elastic::predict) is the simple model by itself.
//! Reference point: TCP. Basis: base. Deviation = where the tool is minus where it was asked to be.

pub use crate::source::Deviation;
use crate::source::{Links, ArmState, Unstable, repeatability};
use crate::spatial::{Twist, Wrench};

/// The deviation of the tool of an arm in its posture, under `wrench`, from every source.
///
/// # Errors
/// [`Unstable`] where the arm finds no stable rest under the load.
pub fn predict(
    arm_state: &mut ArmState<'_>,
    wrench: &Wrench,
    links: &mut Links<'_>,
) -> Result<Deviation, Unstable> {
    let twist = deviation_of(arm_state, wrench, links)?;
    let (mut shares, mut covariance) = (arm_state.shares(), arm_state.covariance());
    arm_state.add_backlash(links, wrench, (&mut shares, &mut covariance));
    Ok(Deviation {
        twist,
        shares,
        covariance: covariance + repeatability::covariance(arm_state.scatter()),
    })
}

/// The sources in their row.
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

/// Geometry and backlash, with the `links` of the joints at these positions in their gaps, rad (m).
pub(crate) fn geometry_and_backlash(arm_state: &ArmState<'_>, links: &[f64], wrench: &Wrench) -> Twist {
    arm_state.geometric() + arm_state.backlash(links, wrench)
}

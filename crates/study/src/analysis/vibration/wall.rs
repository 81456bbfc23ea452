//! Error of the wall by the vibration under the teeth at every point of a path, with its change by each uncertain parameter of the modes.
//!
//! ```text
//! e = (least + greatest)/2 over the depth, without the mean        d_p = (e(p + u_p) - e(p - u_p))/2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `e` | error of the wall, positive where the wall is deeper in the part ([`armill_core::stability::forced`]) | m |
//! | `p`, `u_p` | frequency, damping ratio and stiffness of a mode; its relative standard uncertainty | - |
//!
//! Only of cuts with one wall: of a slot it is not known which of them counts. Parameters of modes with the same number, by rising
//! frequency, are the same unknown at all points. Source: JCGM 100 (GUM), 5.1.3 \[recalled\].

use armill_core::dynamics::Mode;
use armill_core::kernel::Answers;
use armill_core::robot::Robot;
use armill_core::stability::named_mode::modes;
use armill_core::stability::{Forced, NamedMode, ToothForces, WallSide};
use rayon::prelude::*;

use super::arm_modes::named_at_tip;
use super::points::Cuts;
use crate::input::setting::Setting;
use crate::input::vibration::CutAtPoint;

/// Errors of the wall along a path.
#[derive(Clone, Debug)]
pub struct WallErrors {
    /// Side of the wall.
    pub side: WallSide,
    /// At each point, m.
    pub errors: Vec<f64>,
    /// Change at each point by one standard uncertainty of each parameter, m.
    pub changes: Vec<Vec<f64>>,
}

/// Parameters of a mode: frequency, damping ratio, stiffness.
const PARAMETERS: usize = 3;
/// Least factor on a parameter, where its uncertainty is nearly as large as itself.
const LEAST_FACTOR: f64 = 0.05;

impl WallErrors {
    /// Along a path with these cuts; none where a point has no cut or no posture, or the wall is not one and the same.
    pub fn of(robot: &Robot, setting: &Setting, answers: &Answers, cuts: &Cuts<'_>) -> Option<WallErrors> {
        let count = answers.points.len();
        let side = side_of(&(cuts.at)(0)?)?;
        let at = |index: usize| -> Option<(f64, Vec<f64>)> {
            answers.points[index].as_ref().ok()?;
            let cut = (cuts.at)(index)?;
            let forces = ToothForces::new(&cut.milling).ok()?;
            let named = named_at_tip(robot, setting, answers.joints_at(index), &cut.base_from_feed)?;
            let error = |modes: &[Mode]| {
                let forced = Forced::under(&forces, modes, cut.spindle).without_mean();
                let error = forced.surface_error(side);
                0.5 * (error.least + error.greatest)
            };
            let changes = (0..PARAMETERS * named.len()).map(|parameter| {
                let changed = |sign: f64| error(&with_change(&named, parameter, sign));
                0.5 * (changed(1.0) - changed(-1.0))
            });
            (side_of(&cut)? == side).then(|| (error(&modes(&named)), changes.collect()))
        };
        let found: Vec<(f64, Vec<f64>)> = (0..count).into_par_iter().map(at).collect::<Option<_>>()?;
        let parameters = found.iter().map(|(_, changes)| changes.len()).min()?;
        let curve =
            |parameter: usize| -> Vec<f64> { found.iter().map(|(_, changes)| changes[parameter]).collect() };
        Some(WallErrors {
            side,
            changes: (0..parameters).map(curve).collect(),
            errors: found.iter().map(|(error, _)| *error).collect(),
        })
    }
}

/// The only wall of a cut.
fn side_of(cut: &CutAtPoint) -> Option<WallSide> {
    let mut walls = WallSide::of(&cut.milling);
    let first = walls.next()?;
    walls.next().is_none().then_some(first)
}

/// The modes with one parameter changed by its standard uncertainty, upwards or downwards; the frequency keeps the stiffness.
fn with_change(named: &[NamedMode], parameter: usize, sign: f64) -> Vec<Mode> {
    let mut changed = modes(named);
    let (index, which) = (parameter / PARAMETERS, parameter % PARAMETERS);
    let u = named[index].uncertainty;
    let factor = |u: f64| (1.0 + sign * u).max(LEAST_FACTOR);
    let mode = &mut changed[index];
    match which {
        0 => {
            mode.angular_frequency *= factor(u.frequency);
            mode.shape *= factor(u.frequency);
        }
        1 => mode.damping_ratio *= factor(u.damping),
        _ => mode.shape /= factor(u.stiffness).sqrt(),
    }
    changed
}

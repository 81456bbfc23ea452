//! Breakthrough of a drill: its thrust ends at once, and the arm that it bent springs forward.
//!
//! ```text
//! v = f + F(f) g        f' : v(f') = 2 f, at most f
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f`, `v` | feed, greatest speed of the drill at breakthrough | m/s |
//! | `F` | thrust at a feed | N |
//! | `g` | greatest speed along the drill over the force that is released ([`release`](mod@armill_core::dynamics::release)) | m/(s N) |

use std::f64::consts::TAU;

use armill_core::dynamics::{Mode, Release, release};
use armill_core::load::drilling::Drilling;
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_um};

use crate::analysis::holes::HolesAnalysis;
use crate::analysis::numbers::Numbers;
use crate::analysis::quantity::Quantity;
use crate::analysis::vibration::arm_modes::has_modes;
use crate::analysis::vibration::points::of_modes;
use crate::analysis::vibration_quantity::{BREAKTHROUGH_FEED, BREAKTHROUGH_OVERSHOOT, BREAKTHROUGH_SPEED};

/// Greatest speed at breakthrough over the programmed feed for which the feed need not be reduced.
const PERMITTED: f64 = 2.0;
/// Halvings that find the permitted feed.
const HALVINGS: usize = 30;

/// The columns of holes; none if the study does not ask for the vibration, or without a drill.
pub fn columns<'a>(robot: &'a Robot, analysis: &'a HolesAnalysis) -> Vec<Numbers<'a>> {
    let setting = &analysis.path.setting;
    let is_asked = setting.vibration.is_some() && has_modes(robot, setting);
    if !is_asked || analysis.path.drill.is_none() {
        return Vec::new();
    }
    let column = |quantity: &'static Quantity, value: fn(&Breakthrough) -> f64| Numbers {
        quantity,
        name: quantity.key.to_owned(),
        fill: Box::new(move |rows, points, values| {
            let of_point = |arm: &[Mode], (): &mut (), index: usize| {
                Breakthrough::of(arm, analysis, index).as_ref().map(value)
            };
            let found = of_modes(robot, rows.setting, rows.answers, points, &of_point);
            values.extend(found.into_iter().map(Option::flatten));
        }),
    };
    vec![
        column(&BREAKTHROUGH_SPEED, |found| {
            to_mm(found.feed + found.released.peak_speed)
        }),
        column(&BREAKTHROUGH_OVERSHOOT, |found| to_um(found.released.overshoot)),
        column(&BREAKTHROUGH_FEED, Breakthrough::permitted_part),
    ]
}

/// The breakthrough of a hole.
struct Breakthrough {
    drilling: Drilling,
    /// Feed, m/s.
    feed: f64,
    /// Thrust, N.
    thrust: f64,
    released: Release,
}

impl Breakthrough {
    /// That of a hole, with these modes of the arm, base axes.
    fn of(arm: &[Mode], analysis: &HolesAnalysis, index: usize) -> Option<Breakthrough> {
        let path = &analysis.path;
        let drill = &path.drill.as_ref()?.drill;
        let feed = path.track.path.points[index].pace.feed().or(drill.feed)?;
        let drilling = Drilling {
            diameter: drill.diameter,
            point_angle: drill.point_angle,
            feed: feed * TAU / drill.spindle?,
            law: drill.law,
        };
        let thrust = drilling.force().ok()?.thrust;
        let forward = path.track.base_from_feed(index) * -Vector3::z();
        Some(Breakthrough {
            released: release(arm, &forward, thrust),
            drilling,
            feed,
            thrust,
        })
    }

    /// Part of the feed with which the drill is at most twice as fast at breakthrough as programmed.
    fn permitted_part(&self) -> f64 {
        let per_force = self.released.peak_speed / self.thrust;
        let is_permitted = |part: f64| {
            let slower = Drilling {
                feed: part * self.drilling.feed,
                ..self.drilling
            };
            let thrust = slower.force().map_or(self.thrust, |force| force.thrust);
            part * self.feed + thrust * per_force <= PERMITTED * self.feed
        };
        if is_permitted(1.0) {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if is_permitted(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

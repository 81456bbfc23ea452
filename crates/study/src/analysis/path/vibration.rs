//! The cuts along a path whose stability and vibration are evaluated: as the forces have them, in the stock with its engagement.

use armill_core::kernel::Answers;
use armill_core::load::{Milling, PathLoad};
use armill_core::path::{Cutting, LoadedTrack, Track};
use armill_core::robot::Robot;

use crate::analysis::path::PathAnalysis;
use crate::analysis::vibration::Cuts;
use crate::analysis::vibration::points::CutStability;
use crate::input::vibration::CutAtPoint;

/// The cuts along a path followed on `track` under `load`; none of a load that is not from a cut. A point without a spindle speed has no cut.
pub fn cuts<'a>(analysis: &'a PathAnalysis, track: &'a Track, load: &'a PathLoad) -> Option<Cuts<'a>> {
    let PathLoad::Cuts(along) = load else {
        return None;
    };
    let cutting = &analysis.cut.as_ref()?.cutting;
    let spindles = spindles(cutting, track);
    Some(Cuts {
        at: Box::new(move |index| {
            let here = &along.points[index];
            let milling = Milling::new(along.cutters[here.cutter], along.law, here.cut?).ok()?;
            Some(CutAtPoint {
                milling,
                spindle: spindles[index]?,
                base_from_feed: track.base_from_feed(index),
            })
        }),
        are_followed: true,
    })
}

/// Stability of the cuts along a path followed on `track` under `load`; none if the study does not ask for the vibration, or without a cut.
pub fn stability(
    robot: &Robot,
    analysis: &PathAnalysis,
    followed: LoadedTrack<'_>,
    answers: &Answers,
) -> Option<CutStability> {
    let cuts = cuts(analysis, followed.track, followed.load)?;
    let still = Cuts {
        are_followed: false,
        ..cuts
    };
    CutStability::of(robot, &analysis.setting, answers, &still)
}

/// The same with `times` the spindle speed and the same feed per tooth.
pub fn stability_at_speed(
    robot: &Robot,
    analysis: &PathAnalysis,
    followed: LoadedTrack<'_>,
    answers: &Answers,
    times: f64,
) -> Option<CutStability> {
    let cuts = cuts(analysis, followed.track, followed.load)?;
    let turned = Cuts {
        at: Box::new(|index| {
            let cut = (cuts.at)(index)?;
            Some(CutAtPoint {
                spindle: times * cut.spindle,
                ..cut
            })
        }),
        are_followed: false,
    };
    CutStability::of(robot, &analysis.setting, answers, &turned)
}

/// Where depth and engagement come from, in one word.
pub fn engagement(analysis: &PathAnalysis) -> &'static str {
    match analysis.has_stock() {
        true => "stock",
        false => "cut",
    }
}

/// The spindle speed at each point, rad/s: of the program, else of the cut.
fn spindles(cutting: &Cutting, track: &Track) -> Vec<Option<f64>> {
    let turns = |speed: &f64| *speed > 0.0;
    let points = track.path.with_operations();
    points
        .map(|(_, _, operation)| {
            let given = operation.and_then(|operation| operation.spindle).map(f64::abs);
            given.filter(turns).or(cutting.spindle.filter(turns))
        })
        .collect()
}

//! What a program permits, and what its cut met and did, in the answer.

use armill_core::map::{CutLimits, Permitted, PermittedForces, PointLimits, Rested};
use armill_core::path::Met;
use serde::Serialize;

use super::point::tidy;
use crate::file::program::ProgramAsk;
use crate::run::ProgramFound;

/// What keeps the tolerance on the whole of a program: the least of its points.
#[derive(Clone, Debug, Serialize)]
pub struct LimitsResult {
    /// Points that were asked: spread over the path, the worst among them.
    pub points: usize,
    /// Force that every direction permits.
    pub any_direction: Option<LimitResult>,
    /// Force along the feed.
    pub along: Option<LimitResult>,
    /// Force across it.
    pub cross: Option<LimitResult>,
    /// Force along the tool.
    pub axial: Option<LimitResult>,
    /// Axial depth of the cut, all else as the study has it.
    pub axial_depth: Option<LimitResult>,
    /// Radial depth, likewise; none of a slot.
    pub radial_depth: Option<LimitResult>,
    /// Feed per tooth, likewise.
    pub feed_per_tooth: Option<LimitResult>,
}

/// A limit, and where it comes from.
#[derive(Clone, Debug, Serialize)]
pub struct LimitResult {
    /// How much.
    // unit: the one told beside it
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// `up to`, `at least` (more was not looked at), or `nothing`.
    pub verdict: &'static str,
    /// Line of the program that permits no more.
    pub line: u32,
}

/// What the tool met in the stock.
#[derive(Clone, Debug, Serialize)]
pub struct StockResult {
    /// Points with nothing ahead of the tool.
    pub points_in_air: usize,
    /// Points with material over its whole width.
    pub points_in_slot: usize,
    /// Points at which it leans, with the engagement of the study.
    pub points_leaning: usize,
    /// Deepest cut.
    pub largest_axial_depth_mm: f64,
    /// Widest cut.
    pub largest_radial_depth_mm: f64,
    /// Taken away in all.
    pub removed_mm3: f64,
}

/// How the force gave way with the tool.
#[derive(Clone, Debug, Serialize)]
pub struct RestResult {
    /// Largest deviation across the tool if the force stayed as drawn.
    pub max_in_plane_if_drawn_um: f64,
    /// Points at which force and tool do not rest: the cut draws the tool in.
    pub points_unsettled: usize,
    /// Line of the first of them.
    pub first_unsettled_line: Option<u32>,
}

/// Deviations that differ by less than this part with and without giving way need no word.
const MATTERS: f64 = 0.05;

impl LimitsResult {
    pub(super) fn of(ask: &ProgramAsk, found: &ProgramFound) -> Option<LimitsResult> {
        let limits = found.limits.as_ref()?;
        let line = |point: &PointLimits| ask.track.points[point.index].line;
        let force = |of: fn(&PermittedForces) -> f64| {
            let points = limits.points.iter();
            let least = points.min_by(|a, b| of(&a.forces).total_cmp(&of(&b.forces)))?;
            Some(LimitResult {
                value: tidy(of(&least.forces)),
                unit: "N",
                verdict: "up to",
                line: line(least),
            })
        };
        let cut = |part: fn(&CutLimits) -> Option<Permitted>| {
            limits.least(part).map(|(point, permitted)| LimitResult {
                value: permitted.value() * 1e3,
                unit: "mm",
                verdict: verdict(permitted),
                line: line(point),
            })
        };
        Some(LimitsResult {
            points: limits.points.len(),
            any_direction: force(|forces| forces.weakest),
            along: force(|forces| forces.along),
            cross: force(|forces| forces.across),
            axial: force(|forces| forces.normal),
            axial_depth: cut(|cut| Some(cut.depth)),
            radial_depth: cut(|cut| cut.width),
            feed_per_tooth: cut(|cut| Some(cut.feed_per_tooth)),
        })
    }
}

/// In one word.
pub(crate) fn verdict(permitted: Permitted) -> &'static str {
    match permitted {
        Permitted::UpTo(_) => "up to",
        Permitted::AtLeast(_) => "at least",
        Permitted::Nothing => "nothing",
    }
}

impl StockResult {
    pub(super) fn of(met: &Met) -> StockResult {
        StockResult {
            points_in_air: met.in_air,
            points_in_slot: met.slots,
            points_leaning: met.leaning,
            largest_axial_depth_mm: met.largest_depth * 1e3,
            largest_radial_depth_mm: met.largest_width * 1e3,
            removed_mm3: met.removed * 1e9,
        }
    }
}

impl RestResult {
    pub(super) fn of(ask: &ProgramAsk, rested: &Rested) -> RestResult {
        RestResult {
            max_in_plane_if_drawn_um: rested.largest_if_drawn * 1e6,
            points_unsettled: rested.unsettled,
            first_unsettled_line: rested.first_unsettled.map(|index| ask.track.points[index].line),
        }
    }
}

/// Diameters of tools that differ by more than this part are told.
const OTHER_DIAMETER: f64 = 0.01;

/// Tools of the program of another size than the cutter of the study.
fn other_tools(ask: &ProgramAsk) -> Option<String> {
    let cutter_mm = ask.cut.as_ref()?.cutting.cutter.diameter() * 1e3;
    let mut others: Vec<String> = Vec::new();
    for (_, operation) in &ask.operations {
        let Some(diameter_mm) = operation.diameter.map(|diameter| diameter * 1e3) else {
            continue;
        };
        let told = format!("{} mm", tidy(diameter_mm));
        if (diameter_mm / cutter_mm - 1.0).abs() > OTHER_DIAMETER && !others.contains(&told) {
            others.push(told);
        }
    }
    (!others.is_empty()).then(|| {
        format!(
            "the program tells tools of {}: they cut with that size, and with all else of the cutter of {} mm that the study \
             tells",
            others.join(", "),
            tidy(cutter_mm)
        )
    })
}

/// What a user should know of the engagement and of how the force gave way.
pub(super) fn notes(ask: &ProgramAsk, found: &ProgramFound) -> Vec<String> {
    let mut notes: Vec<String> = other_tools(ask).into_iter().collect();
    match found.forces.and_then(|forces| forces.met) {
        None => notes.push(
            "forces are those of the same engagement everywhere: what earlier passes took away is not looked at; \
             `cut.stock` tells the box that the part is cut from"
                .to_owned(),
        ),
        Some(met) => {
            notes.push(
                "depths are those that the tool finds in the stock, as if every pass before had left what is drawn"
                    .to_owned(),
            );
            if met.leaning > 0 {
                notes.push(format!(
                    "{} points have the engagement that the study tells: the tool leans there, and a stock is cut by \
                     upright tools alone",
                    met.leaning
                ));
            }
        }
    }
    let largest = found
        .answer
        .answers
        .worst()
        .map_or(0.0, |(_, held)| held.in_plane);
    match &found.answer.rested {
        None => notes.push(
            "the force does not give way with the tool here: this stiffness model changes with the load"
                .to_owned(),
        ),
        Some(rested) => {
            let ratio = rested.largest_if_drawn / largest.max(f64::MIN_POSITIVE);
            if (ratio - 1.0).abs() > MATTERS {
                notes.push(format!(
                    "the tool strays so far that the cut changes: the largest deviation across it is {:.1} µm where force \
                     and tool rest, {:.1} µm under the force of the cut as drawn",
                    largest * 1e6,
                    rested.largest_if_drawn * 1e6
                ));
            }
            if let Some(first) = rested.first_unsettled {
                notes.push(format!(
                    "at {} points, the first on line {}, the cut draws the tool in and neither rests; the force of the cut \
                     as drawn stands there",
                    rested.unsettled, ask.track.points[first].line
                ));
            }
        }
    }
    notes
}

//! What cuts along a path, what it met in the stock, and how its force gave way, in the answer.
//!
//! Largest forces are those of the cut as drawn, the tool where the program has it; deviations are those of the force
//! at rest. Notes tell what was taken for granted on the way.

use armill_core::map::Rested;
use armill_core::path::Met;
use schemars::JsonSchema;
use serde::Serialize;

use crate::file::path::PathAnalysis;
use crate::number::without_rounding;
use crate::run::PathFound;

/// What cuts or drills along a path, and the forces of it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CutAnswer {
    /// Material that the forces are those of.
    pub material: String,
    /// Largest mean force of a revolution along the path, of the cut as drawn.
    pub largest_mean_n: f64,
    /// Largest force within a revolution, likewise.
    pub largest_peak_n: f64,
    /// Points whose cut has no force: plunges and steep dives, where the bottom of the cutter is not modelled.
    pub points_without_force: usize,
    /// What the tool met in the stock, where the study tells one.
    pub stock: Option<StockAnswer>,
    /// How the force of the cut gave way with the tool.
    pub rest: Option<RestAnswer>,
}

/// What the tool met in the stock.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StockAnswer {
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
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RestAnswer {
    /// Largest deviation across the tool if the force stayed as drawn.
    pub nominal_max_in_plane_um: f64,
    /// Points at which force and tool do not rest: the cut draws the tool in.
    pub points_unsettled: usize,
    /// Line of the first of them.
    pub first_unsettled_line: Option<u32>,
}

/// Deviations that differ by less than this part with and without giving way need no word.
const MATTERS: f64 = 0.05;

impl CutAnswer {
    /// `None` where the study tells neither cut nor drill.
    pub(super) fn of(analysis: &PathAnalysis, found: &PathFound) -> Option<CutAnswer> {
        let of_cut = analysis.cut.as_ref().map(|cut| &cut.material);
        let material = of_cut.or(analysis.drill.as_ref().map(|drill| &drill.material))?;
        let forces = found.forces?;
        Some(CutAnswer {
            material: material.name.clone(),
            largest_mean_n: forces.largest_mean,
            largest_peak_n: forces.greatest,
            points_without_force: forces.without_force,
            stock: forces.met.map(|met| StockAnswer::of(&met)),
            rest: found.along.rested.map(|rested| RestAnswer::of(analysis, &rested)),
        })
    }
}

impl StockAnswer {
    /// What was met, in mm.
    pub(super) fn of(met: &Met) -> StockAnswer {
        StockAnswer {
            points_in_air: met.in_air,
            points_in_slot: met.slots,
            points_leaning: met.leaning,
            largest_axial_depth_mm: met.largest_depth * 1e3,
            largest_radial_depth_mm: met.largest_width * 1e3,
            removed_mm3: met.removed * 1e9,
        }
    }
}

impl RestAnswer {
    /// How forces and tool rested, with the line where they first do not.
    pub(super) fn of(analysis: &PathAnalysis, rested: &Rested) -> RestAnswer {
        RestAnswer {
            nominal_max_in_plane_um: rested.largest_if_drawn * 1e6,
            points_unsettled: rested.unsettled,
            first_unsettled_line: rested
                .first_unsettled
                .map(|index| analysis.track.path.points[index].line),
        }
    }
}

/// Diameters of tools that differ by more than this part are told.
const OTHER_DIAMETER: f64 = 0.01;

/// Tools of the program of another size than the cutter of the study.
fn other_tools(analysis: &PathAnalysis) -> Option<String> {
    let cutter_mm = analysis.cut.as_ref()?.cutting.cutter.diameter() * 1e3;
    let mut others: Vec<String> = Vec::new();
    for (_, operation) in &analysis.track.path.operations {
        let Some(diameter_mm) = operation.diameter.map(|diameter| diameter * 1e3) else {
            continue;
        };
        let given = format!("{} mm", without_rounding(diameter_mm));
        if (diameter_mm / cutter_mm - 1.0).abs() > OTHER_DIAMETER && !others.contains(&given) {
            others.push(given);
        }
    }
    (!others.is_empty()).then(|| {
        format!(
            "the program tells tools of {}: they cut with that size, and with all else of the cutter of {} mm that the study \
             tells",
            others.join(", "),
            without_rounding(cutter_mm)
        )
    })
}

/// What a user should know of cut or drill.
pub(super) fn notes(analysis: &PathAnalysis, found: &PathFound) -> Vec<String> {
    let of_cut = analysis.cut.as_ref().map(|cut| {
        let mut notes = of_engagement(analysis, found);
        notes.extend(of_rest(analysis, found));
        notes.extend(cut.remarks.iter().cloned());
        notes
    });
    let of_drill = analysis.drill.as_ref().map(|drill| drill.remarks.clone());
    of_cut.or(of_drill).unwrap_or_default()
}

/// What a user should know of the engagement.
fn of_engagement(analysis: &PathAnalysis, found: &PathFound) -> Vec<String> {
    let mut notes: Vec<String> = other_tools(analysis).into_iter().collect();
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
    notes
}

/// What a user should know of how the force gave way.
fn of_rest(analysis: &PathAnalysis, found: &PathFound) -> Vec<String> {
    let mut notes = Vec::new();
    let largest = found.along.answers.worst().map_or(0.0, |(_, evaluation)| evaluation.in_plane);
    match &found.along.rested {
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
                    rested.unsettled, analysis.track.path.points[first].line
                ));
            }
        }
    }
    notes
}

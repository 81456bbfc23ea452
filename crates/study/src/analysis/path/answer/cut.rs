//! The cut along a path, its engagement in the stock, and its force-deflection equilibrium, in the answer.
//!
//! Largest forces are those of the nominal cut, without deflection; deviations are those of the force in
//! equilibrium. Notes state the assumptions.

use armill_core::map::EquilibriumSummary;
use armill_core::path::StockEngagement;
use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::process_loads::ProcessPoint;
use crate::analysis::path::run::PathResult;
use crate::number::without_rounding;

/// The cut or drill along a path, and its forces.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CutAnswer {
    /// Material that the forces are those of.
    pub material: String,
    /// Largest mean force of a revolution along the path, of the nominal cut.
    pub largest_mean_n: f64,
    /// Largest force within a revolution, of the nominal cut.
    pub largest_peak_n: f64,
    /// Largest mean torque of a revolution; none of a drill.
    pub largest_mean_torque_n_m: Option<f64>,
    /// Greatest torque within a revolution where its mean is largest.
    pub largest_torque_n_m: Option<f64>,
    /// Largest chip thickness.
    pub largest_chip_um: Option<f64>,
    /// Points with chips thicker than a fifth of the radius of the cutter.
    pub points_with_thick_chips: usize,
    /// Line of the first of them.
    pub first_thick_chip_line: Option<u32>,
    /// Largest material removal rate.
    pub largest_removal_mm3_per_s: Option<f64>,
    /// Points whose cut has no force: plunges and steep ramps, where the bottom of the cutter is not modelled.
    pub points_without_force: usize,
    /// Engagement in the stock, if the study has one.
    pub stock: Option<StockAnswer>,
    /// Force-deflection equilibrium of the cut.
    pub rest: Option<RestAnswer>,
}

/// Engagement of the tool in the stock.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StockAnswer {
    /// Points with nothing ahead of the tool.
    pub points_in_air: usize,
    /// Points with full-width engagement.
    pub points_in_slot: usize,
    /// Points at which it is tilted, with the engagement of the study.
    pub points_leaning: usize,
    /// Deepest cut.
    pub largest_axial_depth_mm: f64,
    /// Widest cut.
    pub largest_radial_depth_mm: f64,
    /// Volume removed in total.
    pub removed_mm3: f64,
}

/// The force-deflection equilibrium.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RestAnswer {
    /// Largest deviation across the tool if the force stayed nominal.
    pub nominal_max_in_plane_um: f64,
    /// Points without force-deflection equilibrium: the cut pulls the tool in.
    pub points_unsettled: usize,
    /// Line of the first of them.
    pub first_unsettled_line: Option<u32>,
}

/// Relative difference of the deviations with and without the equilibrium below which no note is given.
const MATTERS: f64 = 0.05;

impl CutAnswer {
    /// `None` if the study has neither cut nor drill.
    pub fn of(analysis: &PathAnalysis, found: &PathResult) -> Option<CutAnswer> {
        let of_cut = analysis.cut.as_ref().map(|cut| &cut.material);
        let material = of_cut.or(analysis.drill.as_ref().map(|drill| &drill.material))?;
        let forces = found.forces?;
        let largest =
            |of: fn(&ProcessPoint) -> f64| found.process.as_ref().map(|process| process.largest(of));
        Some(CutAnswer {
            largest_mean_torque_n_m: largest(|point| point.torque),
            largest_torque_n_m: found.process.as_ref().map(|process| process.greatest_torque),
            largest_chip_um: largest(|point| point.chip).map(to_um),
            points_with_thick_chips: found.process.as_ref().map_or(0, |process| process.thick),
            first_thick_chip_line: found
                .process
                .as_ref()
                .and_then(|process| process.first_thick)
                .map(|index| analysis.track.path.points[index].line),
            largest_removal_mm3_per_s: largest(|point| point.removal_rate).map(|rate| rate * 1e9),
            material: material.name.clone(),
            largest_mean_n: forces.largest_mean,
            largest_peak_n: forces.greatest,
            points_without_force: forces.without_force,
            stock: forces.stock_engagement.map(|met| StockAnswer::of(&met)),
            rest: found
                .along
                .equilibrium
                .map(|equilibrium| RestAnswer::of(analysis, &equilibrium)),
        })
    }
}

impl StockAnswer {
    /// The engagement, in mm.
    pub fn of(engagement: &StockEngagement) -> StockAnswer {
        StockAnswer {
            points_in_air: engagement.in_air,
            points_in_slot: engagement.slots,
            points_leaning: engagement.leaning,
            largest_axial_depth_mm: to_mm(engagement.largest_depth),
            largest_radial_depth_mm: to_mm(engagement.largest_width),
            removed_mm3: engagement.removed * 1e9,
        }
    }
}

impl RestAnswer {
    /// The equilibrium of force and tool, with the line where it first does not exist.
    pub fn of(analysis: &PathAnalysis, equilibrium: &EquilibriumSummary) -> RestAnswer {
        RestAnswer {
            nominal_max_in_plane_um: to_um(equilibrium.largest_nominal),
            points_unsettled: equilibrium.unsettled,
            first_unsettled_line: equilibrium
                .first_unsettled
                .map(|index| analysis.track.path.points[index].line),
        }
    }
}

/// Diameters of tools that differ by more than this part are reported.
const OTHER_DIAMETER: f64 = 0.01;

/// Tools of the program of another size than the cutter of the study.
fn other_tools(analysis: &PathAnalysis) -> Option<String> {
    let cutter_mm = to_mm(analysis.cut.as_ref()?.cutting.cutter.diameter());
    let mut others: Vec<String> = Vec::new();
    for (_, operation) in &analysis.track.path.operations {
        let Some(diameter_mm) = operation.diameter.map(to_mm) else {
            continue;
        };
        let given = format!("{} mm", without_rounding(diameter_mm));
        if (diameter_mm / cutter_mm - 1.0).abs() > OTHER_DIAMETER && !others.contains(&given) {
            others.push(given);
        }
    }
    (!others.is_empty()).then(|| {
        format!(
            "the program specifies tools of {}: they are evaluated with that size and otherwise as the cutter of {} mm of the \
             study",
            others.join(", "),
            without_rounding(cutter_mm)
        )
    })
}

/// Notes on the cut or drill.
pub fn notes(analysis: &PathAnalysis, found: &PathResult) -> Vec<String> {
    let of_cut = analysis.cut.as_ref().map(|cut| {
        let mut notes = of_engagement(analysis, found);
        notes.extend(of_rest(analysis, found));
        notes.extend(cut.remarks.iter().cloned());
        notes
    });
    let of_drill = analysis.drill.as_ref().map(|drill| drill.remarks.clone());
    of_cut.or(of_drill).unwrap_or_default()
}

/// Notes on the engagement.
fn of_engagement(analysis: &PathAnalysis, found: &PathResult) -> Vec<String> {
    let mut notes: Vec<String> = other_tools(analysis).into_iter().collect();
    match found.forces.and_then(|forces| forces.stock_engagement) {
        None => notes.push(
            "forces are those of a constant engagement: material removed by earlier passes is not considered; \
             specify the stock with `cut.stock`"
                .to_owned(),
        ),
        Some(met) => {
            notes.push(
                "depths are those of the tool in the stock, as if every pass before had left the nominal shape"
                    .to_owned(),
            );
            if met.leaning > 0 {
                notes.push(format!(
                    "{} points have the engagement of the study: the tool is tilted there, and the engagement in a stock is \
                     computed for upright tools only",
                    met.leaning
                ));
            }
        }
    }
    notes
}

/// Notes on the force-deflection equilibrium.
fn of_rest(analysis: &PathAnalysis, found: &PathResult) -> Vec<String> {
    let mut notes = Vec::new();
    let largest = found
        .along
        .answers
        .worst()
        .map_or(0.0, |(_, evaluation)| evaluation.in_plane);
    match &found.along.equilibrium {
        None => notes.push(
            "the change of the force with the deflection is neglected: this stiffness model changes with the load"
                .to_owned(),
        ),
        Some(equilibrium) => {
            let ratio = equilibrium.largest_nominal / largest.max(f64::MIN_POSITIVE);
            if (ratio - 1.0).abs() > MATTERS {
                notes.push(format!(
                    "the tool deflects so far that the cut changes: the largest deviation across it is {:.1} µm in \
                     force-deflection equilibrium, {:.1} µm under the nominal force",
                    to_um(largest),
                    to_um(equilibrium.largest_nominal)
                ));
            }
            if let Some(first) = equilibrium.first_unsettled {
                notes.push(format!(
                    "at {} points, the first on line {}, the cut pulls the tool in and there is no equilibrium; the nominal force is \
                     used there",
                    equilibrium.unsettled, analysis.track.path.points[first].line
                ));
            }
        }
    }
    notes
}

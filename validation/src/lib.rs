//! Comparison of armill with the numbers of others.
//!
//! Every case is a folder of `validation/`: `README.md` describes the comparison and the source of the reference,
//! `case.rs` contains its numbers and returns its checks. [`CASES`] lists them; the program writes [`table`], and
//! the tests assert that every case passes and that the committed table is up to date.
//!
//! | kind of reference | what it shows |
//! |---|---|
//! | published numbers | that the model is the one that others mean |
//! | an independent computation from published inputs | that inputs are read as meant and the arithmetic is right |
//! | another program | that nothing is missing over very many random inputs |
//! | the same quantity on a second path | that two derivations agree to rounding |
//!
//! Cases are seeded: each run compares the same numbers, on any machine and any number of threads.

pub mod check;
#[expect(
    clippy::panic,
    reason = "a sample that is missing, or that determines nothing, is a failed comparison"
)]
pub mod measured;
pub mod table;

mod arms;
mod random;
mod studies;

#[path = "../ballbar-closed-forms/case.rs"]
mod ballbar_closed_forms;
#[path = "../budget-circles/case.rs"]
mod budget_circles;
#[path = "../clearance-coal/case.rs"]
mod clearance_coal;
#[path = "../compliance-two-ways/case.rs"]
mod compliance_two_ways;
#[path = "../drilled-holes/case.rs"]
mod drilled_holes;
#[path = "../estimated-masses/case.rs"]
mod estimated_masses;
#[path = "../fanuc-identification/case.rs"]
mod fanuc_identification;
#[path = "../fanuc-rows/case.rs"]
mod fanuc_rows;
#[path = "../force-to-deflection/case.rs"]
mod force_to_deflection;
#[path = "../inverse-vs-opw/case.rs"]
mod inverse_vs_opw;
#[path = "../irb6640-logs/case.rs"]
mod irb6640_logs;
#[path = "../jacobian-differences/case.rs"]
mod jacobian_differences;
#[path = "../joint-backlash-closed-forms/case.rs"]
mod joint_backlash_closed_forms;
#[path = "../leaning-tool-force/case.rs"]
mod leaning_tool_force;
#[path = "../machined-part-closed-forms/case.rs"]
mod machined_part_closed_forms;
#[path = "../mh12-fractions/case.rs"]
mod mh12_fractions;
#[path = "../mh12-readings/case.rs"]
mod mh12_readings;
#[path = "../mh12-regression/case.rs"]
mod mh12_regression;
#[path = "../milling-mean-force/case.rs"]
mod milling_mean_force;
#[path = "../nist-circles/case.rs"]
mod nist_circles;
#[path = "../path-accuracy/case.rs"]
mod path_accuracy;
#[path = "../path-and-hole-columns/case.rs"]
mod path_and_hole_columns;
#[path = "../planar-modes/case.rs"]
mod planar_modes;
#[path = "../plane-split/case.rs"]
mod plane_split;
#[path = "../shares-and-uncertainty/case.rs"]
mod shares_and_uncertainty;
#[path = "../stability-lobes/case.rs"]
mod stability_lobes;
#[path = "../thermal-growth/case.rs"]
mod thermal_growth;
#[path = "../tx200-compliance/case.rs"]
mod tx200_compliance;
#[path = "../tx200-modes/case.rs"]
mod tx200_modes;
#[path = "../ur10-pose-accuracy/case.rs"]
mod ur10_pose_accuracy;
#[path = "../urdf-forward/case.rs"]
mod urdf_forward;

pub use check::Check;

use rayon::prelude::*;

/// A comparison with a reference.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its folder in `validation/`.
    pub folder: &'static str,
    /// Computes its checks.
    pub checks: fn() -> Vec<Check>,
}

/// Every case: published numbers first, then independent computations, then one way against another.
pub const CASES: &[Case] = &[
    Case {
        folder: "tx200-compliance",
        checks: tx200_compliance::checks,
    },
    Case {
        folder: "tx200-modes",
        checks: tx200_modes::checks,
    },
    Case {
        folder: "force-to-deflection",
        checks: force_to_deflection::checks,
    },
    Case {
        folder: "milling-mean-force",
        checks: milling_mean_force::checks,
    },
    Case {
        folder: "leaning-tool-force",
        checks: leaning_tool_force::checks,
    },
    Case {
        folder: "nist-circles",
        checks: nist_circles::checks,
    },
    Case {
        folder: "ur10-pose-accuracy",
        checks: ur10_pose_accuracy::checks,
    },
    Case {
        folder: "fanuc-rows",
        checks: fanuc_rows::checks,
    },
    Case {
        folder: "drilled-holes",
        checks: drilled_holes::checks,
    },
    Case {
        folder: "fanuc-identification",
        checks: fanuc_identification::checks,
    },
    Case {
        folder: "mh12-regression",
        checks: mh12_regression::checks,
    },
    Case {
        folder: "mh12-readings",
        checks: mh12_readings::checks,
    },
    Case {
        folder: "mh12-fractions",
        checks: mh12_fractions::checks,
    },
    Case {
        folder: "path-accuracy",
        checks: path_accuracy::checks,
    },
    Case {
        folder: "irb6640-logs",
        checks: irb6640_logs::checks,
    },
    Case {
        folder: "stability-lobes",
        checks: stability_lobes::checks,
    },
    Case {
        folder: "inverse-vs-opw",
        checks: inverse_vs_opw::checks,
    },
    Case {
        folder: "clearance-coal",
        checks: clearance_coal::checks,
    },
    Case {
        folder: "thermal-growth",
        checks: thermal_growth::checks,
    },
    Case {
        folder: "compliance-two-ways",
        checks: compliance_two_ways::checks,
    },
    Case {
        folder: "shares-and-uncertainty",
        checks: shares_and_uncertainty::checks,
    },
    Case {
        folder: "path-and-hole-columns",
        checks: path_and_hole_columns::checks,
    },
    Case {
        folder: "jacobian-differences",
        checks: jacobian_differences::checks,
    },
    Case {
        folder: "ballbar-closed-forms",
        checks: ballbar_closed_forms::checks,
    },
    Case {
        folder: "budget-circles",
        checks: budget_circles::checks,
    },
    Case {
        folder: "joint-backlash-closed-forms",
        checks: joint_backlash_closed_forms::checks,
    },
    Case {
        folder: "estimated-masses",
        checks: estimated_masses::checks,
    },
    Case {
        folder: "planar-modes",
        checks: planar_modes::checks,
    },
    Case {
        folder: "plane-split",
        checks: plane_split::checks,
    },
    Case {
        folder: "urdf-forward",
        checks: urdf_forward::checks,
    },
    Case {
        folder: "machined-part-closed-forms",
        checks: machined_part_closed_forms::checks,
    },
];

/// The checks of every case, in the order of [`CASES`], computed on all threads.
pub fn results() -> Vec<(&'static Case, Vec<Check>)> {
    CASES.par_iter().map(|case| (case, (case.checks)())).collect()
}

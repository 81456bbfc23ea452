//! Predictions held against measurements of real arms: the page *Measured*, `docs/measured.md`.
//!
//! In reading order: [`comparison`] (errors of one model on one set), [`samples`] (the folder of the measurements), `poses` (of arms, by three models), [`page`].
//! Sets: `fanuc_load_tests`, `drilled_holes`, `ur10_tracker`, `tx90l_tracker`, `irb120_tracker`, `circle_points`, `iiwa7_payload`, `hilti_column`,
//! `ur_path`, `irb6640_logs`, `kr300_encoders`. Each is a folder of `validation/measured/`: `README.md` says what was measured, what was predicted without it, and what
//! explains the rest; `set.rs` computes the rows of its table.
//!
//! The measurements are not part of this repository. They are found in the folder that `ARMILL_SAMPLES` names; without it the
//! page stays as it is, and its test says that it was skipped.

pub mod comparison;
pub mod page;
mod poses;
pub mod samples;

#[path = "../../measured/circle-points/set.rs"]
mod circle_points;
#[path = "../../measured/drilled-holes/set.rs"]
mod drilled_holes;
#[path = "../../measured/fanuc-load-tests/set.rs"]
mod fanuc_load_tests;
#[path = "../../measured/hilti-column/set.rs"]
mod hilti_column;
#[path = "../../measured/iiwa7-payload/set.rs"]
mod iiwa7_payload;
#[path = "../../measured/irb120-tracker/set.rs"]
mod irb120_tracker;
#[path = "../../measured/irb6640-logs/set.rs"]
mod irb6640_logs;
#[path = "../../measured/kr300-encoders/set.rs"]
mod kr300_encoders;
#[path = "../../measured/tx90l-tracker/set.rs"]
mod tx90l_tracker;
#[path = "../../measured/ur10-tracker/set.rs"]
mod ur10_tracker;
#[path = "../../measured/ur-path/set.rs"]
mod ur_path;

pub use comparison::{Comparison, NORMAL_95, Stated};
pub use samples::Samples;

/// Measurements of one arm.
#[derive(Clone, Copy, Debug)]
pub struct Set {
    /// What was measured and predicted, Markdown; its first line is the title.
    pub text: &'static str,
    /// Errors of the models; reads the measurements.
    pub comparisons: fn(&Samples) -> Vec<Comparison>,
}

/// All sets, in the order of the page.
pub const SETS: &[Set] = &[
    Set {
        text: include_str!("../../measured/fanuc-load-tests/README.md"),
        comparisons: fanuc_load_tests::comparisons,
    },
    Set {
        text: include_str!("../../measured/drilled-holes/README.md"),
        comparisons: drilled_holes::comparisons,
    },
    Set {
        text: include_str!("../../measured/ur10-tracker/README.md"),
        comparisons: ur10_tracker::comparisons,
    },
    Set {
        text: include_str!("../../measured/tx90l-tracker/README.md"),
        comparisons: tx90l_tracker::comparisons,
    },
    Set {
        text: include_str!("../../measured/irb120-tracker/README.md"),
        comparisons: irb120_tracker::comparisons,
    },
    Set {
        text: include_str!("../../measured/circle-points/README.md"),
        comparisons: circle_points::comparisons,
    },
    Set {
        text: include_str!("../../measured/iiwa7-payload/README.md"),
        comparisons: iiwa7_payload::comparisons,
    },
    Set {
        text: include_str!("../../measured/hilti-column/README.md"),
        comparisons: hilti_column::comparisons,
    },
    Set {
        text: include_str!("../../measured/ur-path/README.md"),
        comparisons: ur_path::comparisons,
    },
    Set {
        text: include_str!("../../measured/irb6640-logs/README.md"),
        comparisons: irb6640_logs::comparisons,
    },
    Set {
        text: include_str!("../../measured/kr300-encoders/README.md"),
        comparisons: kr300_encoders::comparisons,
    },
];

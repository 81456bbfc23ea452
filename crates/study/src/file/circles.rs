//! `ballbar`: circular tests on circles of the study, in which joints turn back.
//!
//! Angles of the files are converted to those of the circle as in [`crate::file::experiment`].

use std::path::Path;

use armill_core::measure::ballbar::CircularTest;
use armill_core::units::to_mm;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::file::ResolvedAnalyses;
use crate::file::experiment::{AngleMapping, bar, circle, turned_test};
use crate::input::problem_log::ProblemLog;

/// A circular test on one circle of the study.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BallbarTable {
    /// Name of the path that was driven, a circle; required if the study has several.
    pub analysis: Option<String>,
    /// Runs of the ball-bar, relative to the study.
    #[schemars(length(min = 1, max = 100))]
    pub files: Vec<String>,
    /// Nominal radius, if a file does not specify it.
    #[schemars(range(min = 0.001, max = 1e4))]
    pub radius_mm: Option<f64>,
    /// Position of angle 0 of the files on the circle, from +y' towards z'; 0 if left out.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub zero_deg: Option<f64>,
    /// Whether angles of the files grow from z' towards y'.
    #[serde(default)]
    pub mirrored: bool,
}

/// A circular test in the angles of its circle.
#[derive(Clone, Debug)]
pub struct MeasuredCircle {
    /// Name of the path.
    pub analysis: String,
    /// Its files.
    pub files: Vec<String>,
    /// Its runs.
    pub test: CircularTest,
    /// Names of these.
    pub runs: Vec<String>,
    /// Notes for the user on the files, each a sentence.
    pub notes: Vec<String>,
}

/// Relative difference of the radii of ball-bar and circle above which they belong to different circles.
const SAME_RADIUS: f64 = 0.01;

impl MeasuredCircle {
    /// Reads the files of table number `index`; `None` if there are problems, reported at their keys.
    pub(super) fn read(
        log: &mut ProblemLog<'_>,
        index: usize,
        table: &BallbarTable,
        folder: &Path,
        analyses: ResolvedAnalyses<'_>,
    ) -> Option<MeasuredCircle> {
        let key = format!("ballbar[{index}]");
        let circle = circle(log, &key, table.analysis.as_ref(), analyses);
        let files = format!("{key}.files");
        // Files are read even if the circle is not known: their problems belong to the same list.
        let measured = bar(log, &files, &table.files, folder, table.radius_mm)?;
        let turned = AngleMapping::new(table.zero_deg, table.mirrored);
        let test = turned_test(log, &files, &measured, turned, false)?;
        let (analysis, radius) = circle?;
        if (test.radius() / radius - 1.0).abs() > SAME_RADIUS {
            let message = format!(
                "the ball-bar circle has a radius of {} mm, `{analysis}` has {} mm",
                crate::number::decimals(to_mm(test.radius()), 3),
                crate::number::decimals(to_mm(radius), 3)
            );
            log.problem(&files, message, "use the path that was driven, with its radius");
            return None;
        }
        Some(MeasuredCircle {
            analysis,
            files: table.files.clone(),
            runs: measured.origins.into_iter().map(|origin| origin.name).collect(),
            test,
            notes: measured.notes,
        })
    }
}

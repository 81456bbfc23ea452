//! `ballbar`: circular tests on circles of the study, in which joints turn back.
//!
//! Angles of the files are turned onto the circle as those of [`super::experiment`].

use std::path::Path;

use armill_core::measure::ballbar::CircularTest;
use schemars::JsonSchema;
use serde::Deserialize;

use super::experiment::{Turned, bar, circle, turned_test};
use super::places::Places;
use super::resolve::Ask;

/// A circular test on one circle of the study.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BallbarTable {
    /// Name of the path that was driven, a circle; needed where the study asks for several.
    pub analysis: Option<String>,
    /// Runs of the ball-bar, relative to the study.
    #[schemars(length(min = 1, max = 100))]
    pub files: Vec<String>,
    /// Nominal radius, where a file does not tell it.
    #[schemars(range(min = 0.001, max = 1e4))]
    pub radius_mm: Option<f64>,
    /// Where angle 0 of the files lies on the circle, from +y' towards z'; 0 if left out.
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
    /// What a user must know of the files, each a sentence.
    pub notes: Vec<String>,
}

/// A bar that is longer or shorter than its circle by more than this part was on another.
const SAME_RADIUS: f64 = 0.01;

impl MeasuredCircle {
    /// Reads what table number `index` names; `None` where something of it is wrong, told at its place.
    pub(super) fn read(
        places: &mut Places<'_>,
        (index, table): (usize, &BallbarTable),
        folder: &Path,
        analyses: (&[Ask], bool),
    ) -> Option<MeasuredCircle> {
        let key = format!("ballbar[{index}]");
        let circle = circle(places, (&key, table.analysis.as_ref()), analyses);
        let mut notes = Vec::new();
        let files = format!("{key}.files");
        // Files are read even where the circle is not known: their problems belong to the same list.
        let of = (files.as_str(), &table.files[..]);
        let measured = bar(places, of, (folder, table.radius_mm), &mut notes)?;
        let turned = Turned::new(table.zero_deg, table.mirrored);
        let test = turned_test(places, &files, &measured, (turned, false))?;
        let (analysis, radius) = circle?;
        if (test.radius() / radius - 1.0).abs() > SAME_RADIUS {
            let message = format!(
                "the bar went round a circle of {} mm, `{analysis}` has {} mm",
                crate::number::decimals(test.radius() * 1e3, 3),
                crate::number::decimals(radius * 1e3, 3)
            );
            places.problem(&files, message, "the path that was driven, with its radius");
            return None;
        }
        Some(MeasuredCircle {
            analysis,
            files: table.files.clone(),
            runs: measured.origins.into_iter().map(|origin| origin.name).collect(),
            test,
            notes,
        })
    }
}

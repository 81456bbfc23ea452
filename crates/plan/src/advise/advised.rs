//! What an advice leaves for use: the study as advised, the path to command, and the numbers of the steps.
//!
//! ```text
//! study.toml                the study with this path only, as advised: `armill run` gives the advised numbers
//! steps.csv                 one row a step: nominal, placement, spin, compensation
//! NAME.commanded.csv        the path to command, as from `armill compensate`; NAME-compensated.svg: before and after
//! ```
//!
//! For a path from a robot program, that program is written too, with changed targets.

use std::path::Path;

use armill_core::kernel::Answers;
use armill_core::path::Track;
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_study::error::StudyError;
use armill_study::input::setting::Setting;
use armill_study::studies::FoundStudy;
use toml_edit::{InlineTable, Value};

use super::answer::StepAnswer;
use crate::compensate::Commanded;
use crate::place::PlacementResult;
use crate::study_text::StudyText;

/// The files, and the path to command for a robot program.
#[derive(Clone, Debug)]
pub struct AdvisedFiles {
    found: FoundStudy,
    analysis: usize,
    turns: bool,
    others: Vec<(String, Vec<u8>)>,
    /// The setting of the path.
    pub setting: Setting,
    /// The path to command, and its postures.
    pub path: (Track, Answers),
    /// Top of the path without compensation, m.
    pub top: f64,
    /// Speed of the spindle if the path does not specify it, rad/s.
    pub spindle: Option<f64>,
    /// What the study file cannot express, a sentence each.
    pub notes: Vec<String>,
}

impl AdvisedFiles {
    /// Those of the study `found` at its advised placement; `turns`: with spins along the path.
    pub(super) fn of(
        found: &FoundStudy,
        placed: &PlacementResult,
        turns: bool,
        steps: &[StepAnswer],
        commanded: Commanded<'_>,
    ) -> Result<AdvisedFiles, StudyError> {
        let file = commanded.given.file.clone();
        let picture = file.replace(".commanded.csv", "-compensated.svg");
        let mut others = vec![
            ("steps.csv".to_owned(), csv::write(&table(steps)?)),
            (file, commanded.csv),
        ];
        others.extend(commanded.picture.map(|svg| (picture, svg.into_bytes())));
        others.extend(commanded.program);
        let own_spins = placed.has_own_spins() && placed.answer.is_improvement;
        Ok(AdvisedFiles {
            found: found.clone(),
            analysis: placed.analysis(),
            turns,
            others,
            setting: commanded.setting.clone(),
            path: commanded.path,
            top: commanded.top,
            spindle: commanded.spindle,
            notes: own_spins
                .then(|| {
                    "the study as advised has the spin of the tool of the nominal placement: the tool turns with the part, which a study expresses with spin = \"along-feed\" alone".to_owned()
                })
                .into_iter()
                .collect(),
        })
    }

    /// Names and bytes of all files, to be written into `folder`: files that the study names are found from there.
    ///
    /// # Errors
    /// A study that is not TOML.
    pub fn files(&self, folder: &Path) -> Result<Vec<(String, Vec<u8>)>, StudyError> {
        let mut text = StudyText::of(&self.found)?;
        if self.turns && !text.has(self.analysis, &["posture", "search"]) {
            text.set(
                self.analysis,
                &["posture", "search"],
                Some(Value::InlineTable(InlineTable::new())),
            );
        }
        text.keep_only(self.analysis);
        text.move_files(&self.found.folder, folder);
        let study = ("study.toml".to_owned(), text.text().into_bytes());
        Ok([study].into_iter().chain(self.others.iter().cloned()).collect())
    }
}

/// A row a step.
fn table(steps: &[StepAnswer]) -> Result<Table, StudyError> {
    let column = |name: &str, unit: Option<&str>, description: &str, data: ColumnData| Column {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        description: description.to_owned(),
        decimals: Some(6),
        data,
    };
    let number =
        |of: fn(&StepAnswer) -> Option<f64>| ColumnData::OptionalFloat(steps.iter().map(of).collect());
    let text = |of: fn(&StepAnswer) -> &'static str| {
        ColumnData::Text(steps.iter().map(|step| of(step).to_owned()).collect())
    };
    let columns = vec![
        column(
            "step",
            None,
            "nominal, placement, spin, compensation",
            text(|step| step.step),
        ),
        column(
            "is_advised",
            None,
            "whether the step is advised",
            ColumnData::Flag(steps.iter().map(|step| step.is_advised).collect()),
        ),
        column(
            "largest_um",
            Some("um"),
            "largest in-plane deviation with this step; of the compensation in any direction",
            number(|step| step.largest_um),
        ),
        column(
            "mean_um",
            Some("um"),
            "mean in-plane deviation",
            number(|step| step.mean_um),
        ),
        column(
            "fraction_within",
            None,
            "points within the tolerance over all points",
            number(|step| step.fraction_within),
        ),
        column(
            "gain_um",
            Some("um"),
            "decrease of the objective",
            number(|step| step.gain_um),
        ),
        column(
            "gain_u_um",
            Some("um"),
            "its standard uncertainty",
            number(|step| step.gain_u_um),
        ),
        column("costs", None, "what the step costs", text(|step| step.costs)),
    ];
    Ok(Table::new("steps", columns)?)
}

//! `armill budget`: contributions to the error of a measured circle, and how much of it is predicted.
//!
//! Stdout has a [`BudgetAnswer`], as text or JSON; `--out` receives the table and the pictures.
//!
//! ```text
//! circle: radius 100 mm, 72 angles over 360 deg; centre least-squares, radius least-squares     circle, datum
//! contribution   largest um   at deg   rms um   scatter um   u um   alone %   without %         each contribution
//! sums                                                                                          their combinations
//! without load, predicted                                                                       compared with the measurement
//! part, residual                                                                                how much is explained
//! waves   part um   predicted um   phase deg   explained %                                      per harmonic
//! ```

use armill_study::StudyError;
use armill_study::budget::answer::PartAnswer;
use armill_study::budget::{BudgetAnswer, budget, point_count};
use armill_study::{output, studies};

use crate::arguments::BudgetArguments;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{print, say};

/// Runs the circle, writes the requested files and prints the result.
///
/// # Errors
/// No such study, or its problems; no measurements; a folder or stdout that cannot be written.
pub(crate) fn run(arguments: &BudgetArguments) -> Result<Outcome, StudyError> {
    let study = studies::find(&arguments.study)?.read()?;
    let progress = Progress::new(point_count(&study)?);
    let (combined, given) = progress.watch(|watch| budget(&study, watch))?;
    if let Some(out) = &arguments.out {
        output::budget::write(
            &given,
            &combined,
            &arguments.writing.writer("budget").folder(out)?,
        )?;
        say(&format!("table and pictures in {}", out.display()));
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&given)?,
        false => as_text(&given),
    })?;
    Ok(Outcome::Fine)
}

/// The result as text, see the documentation of this module.
fn as_text(given: &BudgetAnswer) -> String {
    let mut lines = vec![format!(
        "{} ({}): radius {} mm, {} angles over {:.0} deg; centre {}, radius {}",
        given.analysis,
        given.branch,
        given.radius_mm,
        given.angles,
        given.arc_deg,
        given.datum.centre,
        given.datum.radius
    )];
    lines.extend(
        given
            .files
            .iter()
            .map(|file| format!("{:<18} {}", file.of, file.file)),
    );
    lines.push(String::new());
    lines.push(format!(
        "{:<34} {:>10} {:>8} {:>8} {:>10} {:>7} {:>8} {:>9}",
        "contribution", "largest um", "at deg", "rms um", "scatter um", "u um", "alone %", "without %"
    ));
    let percent = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1}"));
    lines.extend(given.contributions.iter().map(|one| {
        format!(
            "{:<34} {:>10.2} {:>8.1} {:>8.2} {:>10.2} {:>7} {:>8} {:>9}",
            one.name,
            one.largest_um,
            one.largest_at_deg,
            one.rms_um,
            one.scatter_um,
            one.bias_u_um.map_or("-".to_owned(), |um| format!("{um:.2}")),
            percent(one.explained_alone_percent),
            percent(one.explained_without_percent)
        )
    }));
    let sums = &given.sums;
    lines.push(String::new());
    lines.push(format!("{:<34} {:>10}", "largest of the sum", "um"));
    lines.extend(
        [
            ("signed sum", sums.as_functions_um),
            ("signed sum and twice the scatter", sums.with_scatter_um),
            ("root sum square", sums.root_sum_square_um),
        ]
        .map(|(name, um)| format!("{name:<30} {um:>10.2}")),
    );
    lines.push(format!(
        "{:<34} {:>10.2}   load {:.2} and path without load {:.2}",
        "plain sum", sums.plain_um, sums.load_um, sums.unloaded_um
    ));
    if let Some(reference) = &given.without_load {
        lines.push(format!(
            "{:<34} {:>10.2}   at {:.1} deg; measured {:.2} at {:.1} deg, explained {:.1} %; not part of the sums",
            "without load, predicted",
            reference.predicted_um,
            reference.predicted_at_deg,
            reference.measured_um,
            reference.measured_at_deg,
            reference.explained_percent
        ));
    }
    if let Some(part) = &given.part {
        lines.extend(of_part(part));
    }
    lines.push(String::new());
    lines.extend(given.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(given.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

/// The part and its harmonics.
fn of_part(part: &PartAnswer) -> Vec<String> {
    let percent = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.1}"));
    let mut lines = vec![
        format!(
            "{:<34} {:>10.2}   at {:.1} deg; rms {:.2} um, {} points",
            "part", part.largest_um, part.largest_at_deg, part.rms_um, part.points
        ),
        format!(
            "{:<34} {:>10.2}   at {:.1} deg; rms {:.2} um, {:.2} um beyond known scatter and uncertainty",
            "residual",
            part.residual.largest_um,
            part.residual.largest_at_deg,
            part.residual.rms_um,
            part.residual.beyond_known_um
        ),
        String::new(),
        format!(
            "explained {:.1} % of the part, explainable {:.1} %",
            part.explained_percent, part.explainable_percent
        ),
        format!(
            "similarity of shape {} %, best-fit size {} % of the predicted; a rotated prediction fits as well at {} % \
             of all angles",
            percent(part.likeness_percent),
            percent(part.best_size_percent),
            percent(part.turns_as_good_percent)
        ),
    ];
    if !part.waves.is_empty() {
        lines.push(String::new());
        lines.push(format!(
            "{:>5} {:>9} {:>13} {:>21} {:>12}",
            "waves", "part um", "predicted um", "phase difference deg", "explained %"
        ));
    }
    lines.extend(part.waves.iter().map(|wave| {
        format!(
            "{:>5} {:>9.2} {:>13.2} {:>21} {:>12}",
            wave.waves,
            wave.measured_um,
            wave.predicted_um,
            percent(wave.phase_difference_deg),
            percent(wave.explained_percent)
        )
    }));
    lines
}

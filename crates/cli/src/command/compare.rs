//! `armill compare`: the same paths in several cells.
//!
//! Files go into `--out` (`compare` next to the first study). Stdout has one table per analysis, paths first, each with
//! its ranking as text, the differences, and what limits the comparison; or with `--json` all of `result.json`.

use armill_plan::compare::{
    CellNumbers, ComparedAnswer, ComparisonAnswer, Placing, cells, comparable, compare, progress_count, write,
};
use armill_study::output::Pictures;
use armill_study::{StudyError, studies};

use super::run::in_pool;
use crate::arguments::CompareArguments;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::terminal::{Align, columns, print, say};

/// Compares and writes the results.
///
/// # Errors
/// No such study, its problems, or nothing to compare; a folder that cannot be written (reported before the work
/// starts).
pub(crate) fn run(arguments: &CompareArguments) -> Result<Outcome, StudyError> {
    let of = comparable(cells(&arguments.studies, &arguments.robots)?)?;
    let writer = arguments.writing.writer("compare");
    let out = match (&arguments.out, arguments.studies.first()) {
        (Some(out), _) => writer.folder(out)?,
        (None, Some(first)) => writer.folder_in(&studies::find(first)?.folder, "compare")?,
        (None, None) => writer.folder_in(".".as_ref(), "compare")?,
    };
    let requested = if arguments.no_pictures {
        Pictures::None
    } else {
        Pictures::Drawn
    };
    let placing = match arguments.given_placement {
        true => Placing::Given,
        false => Placing::BestForEach,
    };
    let compared = in_pool(arguments.threads, || {
        let progress = Progress::of("points and placements", progress_count(&of, placing));
        let note = |what: &str| progress.set_message(what);
        let compared = progress.watch(|watch| compare(&of, placing, watch, &note))?;
        write(&compared, &out, requested, &|name| progress.set_message(name))?;
        Ok::<_, StudyError>(compared)
    })??;
    let answer = &compared.answer;
    print(&if arguments.json {
        serde_json::to_string(answer)?
    } else {
        as_text(answer)
    })?;
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    say(&format!("results in {}", out.path().display()));
    Ok(Outcome::Fine)
}

/// One paragraph per analysis.
fn as_text(answer: &ComparisonAnswer) -> String {
    let mut lines = Vec::new();
    let mut given: Vec<String> = Vec::new();
    for analysis in &answer.analyses {
        if !lines.is_empty() {
            lines.push(String::new());
        }
        lines.extend(of_analysis(analysis));
        // Sentences that all analyses have in common are printed once.
        let notes = differences(analysis)
            .into_iter()
            .chain(analysis.notes.iter().cloned());
        for note in notes {
            if !given.contains(&note) {
                lines.push(note.clone());
                given.push(note);
            }
        }
    }
    if !answer.left_out.is_empty() {
        lines.push(String::new());
        lines.extend(answer.left_out.iter().cloned());
    }
    lines.join("\n")
}

/// The ranking and the table of one analysis, um.
fn of_analysis(analysis: &ComparedAnswer) -> Vec<String> {
    let head = [
        "cell",
        "robot",
        "branch",
        "compliance",
        "reached",
        "in limits",
        "mean",
        "95 %",
        "largest",
        "± (k=2)",
        "normal",
        "tolerance",
        "within",
        "largest share",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(analysis.cells.iter().map(row));
    let aligned = [
        Align::Left,
        Align::Left,
        Align::Left,
        Align::Left,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Right,
        Align::Left,
    ];
    let mut lines = vec![analysis.answer.clone()];
    let order = match analysis.is_ranked {
        true => "best cell first",
        false => "in the order of the nominal numbers, which is no ranking",
    };
    lines.push(format!("In-plane deviation in µm, {order}:"));
    lines.extend(
        columns(&rows, &aligned)
            .into_iter()
            .map(|line| format!("  {line}")),
    );
    lines
}

fn row(cell: &CellNumbers) -> Vec<String> {
    let um = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |um| format!("{um:.1}"));
    let of_all = |points: usize| format!("{points}/{}", cell.points);
    let by = cell.mostly_by.as_ref().zip(cell.mostly_by_percent);
    vec![
        cell.cell.clone(),
        cell.robot.clone(),
        cell.branch.clone(),
        if cell.compliance_assumed {
            "assumed"
        } else {
            "given"
        }
        .to_owned(),
        of_all(cell.reached),
        of_all(cell.inside_joint_limits),
        um(cell.mean_in_plane_um),
        um(cell.p95_in_plane_um),
        um(cell.max_in_plane_um),
        um(cell.max_in_plane_u_um.map(|u| 2.0 * u)),
        um(cell.max_normal_um),
        um(Some(cell.tolerance_um)),
        format!("{:.1} %", cell.fraction_within_and_inside_joint_limits * 100.0),
        by.map_or_else(String::new, |(by, part)| format!("{by} ({})", share(part))),
    ]
}

/// A share in the room of a table: above 100 % others act against it, below zero it acts against the deviation.
fn share(percent: f64) -> String {
    match percent {
        percent if percent > 100.5 => "> 100 %".to_owned(),
        percent if percent < 0.0 => "< 0 %".to_owned(),
        percent => format!("{percent:.0} %"),
    }
}

/// Differences that have a column in the table.
const IN_COLUMNS: [&str; 3] = ["robot", "compliance", "tolerance"];

/// Differences between the cells that are not in the table, one line each.
fn differences(analysis: &ComparedAnswer) -> Vec<String> {
    let differing = analysis
        .traits
        .iter()
        .filter(|one| one.differs && !IN_COLUMNS.contains(&one.what));
    differing
        .map(|one| {
            let of = analysis.cells.iter().zip(&one.of);
            let given: Vec<String> = of
                .map(|(cell, given)| format!("{}: {given}", cell.cell))
                .collect();
            format!("Differs: {}. {}.", one.what, given.join("; "))
        })
        .collect()
}

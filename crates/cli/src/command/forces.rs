//! `armill forces`: a dynamometer record before and after removal of drift and filtering.
//!
//! `--rate-hz`, `--columns` and `--channels` control how the file is read, `--air-s` or `--no-drift`, `--low-pass-hz`
//! and `--spindle-rpm` how it is processed. Stdout has a [`ForcesAnswer`], as text or JSON; `--out` receives tables and
//! pictures.
//!
//! ```text
//! groove.txt: DynoWare, cycle 1 of 2                                 file, format
//! 30000 samples from 0 s to 2.9999 s, 10000 Hz; Fx, Fy, Fz           what was read
//! unused columns: Ch4                                                columns not used
//! drift        (ox, oy, oz) N and (rx, ry, rz) N/s                   at the first sample, and its rate; or "not removed"
//! N            mean least greatest   mean least greatest             as measured | as used: Fx, Fy, Fz, size
//! ```
//!
//! Times and rates are reported to a microsecond, forces to a hundredth of a newton.

use armill_core::load::ActsOn;
use armill_formats::measurement::format::ForceReadOptions;
use armill_measure::forces::{ForcesAnswer, RangeAnswer, SummaryAnswer, answer, output};
use armill_study::StudyError;
use armill_study::analysis::path::answer::measured::DriftAnswer;
use armill_study::measured::force_record::{Unread, read};
use armill_study::measured::treatment::{Air, Refusal, Treatment, treat};
use armill_study::number::decimals;

use crate::arguments::ForcesArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Reads, processes, writes the requested files and prints the result.
///
/// # Errors
/// A file that cannot be read, or its problems; an invalid setting, under the name of its option; a
/// folder or stdout that cannot be written.
pub(crate) fn run(arguments: &ForcesArguments) -> Result<Outcome, StudyError> {
    let shown = arguments.file.display().to_string();
    let requested = ForceReadOptions {
        rate_hz: arguments.rate_hz,
        columns: arguments.columns.clone(),
        channels: arguments.channels.clone(),
    };
    let treatment = Treatment {
        air: air(arguments)?,
        low_pass_hz: arguments.low_pass_hz,
        spindle_rpm: arguments.spindle_rpm,
    };
    // The direction of the force (on tool or part) is not needed here: numbers are reported as in the file.
    let measured = read(&shown, &arguments.file, ActsOn::Part, &requested, arguments.cycle);
    let measured = measured.map_err(|unread| match unread {
        Unread::File(problems) => problems,
        Unread::Value(refusal) => refused(refusal),
    })?;
    let treated = treat(measured.record.clone(), &treatment).map_err(refused)?;
    let answer = answer(&shown, &measured, &treatment, &treated);
    for warning in &answer.warnings {
        say(&format!("warning: {warning}"));
    }
    if let Some(out) = &arguments.out {
        output::write(
            &answer,
            &treated,
            &arguments.writing.writer("forces").folder(out)?,
        )?;
        say(&format!("tables and pictures in {}", out.display()));
    }
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    Ok(Outcome::Fine)
}

/// An error of `armill_study`, under the name of the option instead of that of the key.
fn refused(refusal: Refusal) -> StudyError {
    let message = match refusal.key {
        "file" => refusal.message,
        "cycle" => format!("--cycle: {}", refusal.message),
        "air_s" => {
            let hint = format!("{} (--air-s 0,0.5 or --no-drift)", refusal.hint);
            return StudyError::value(format!("--air-s: {}", refusal.message), hint);
        }
        key => format!("--{}: {}", key.replace('_', "-"), refusal.message),
    };
    StudyError::value(message, refusal.hint)
}

/// Intervals without cutting: `--no-drift` keeps the drift, `--air-s` gives the intervals, otherwise they are
/// detected.
fn air(arguments: &ForcesArguments) -> Result<Air, StudyError> {
    if arguments.no_drift {
        return Ok(Air::NotRemoved);
    }
    if arguments.air_s.is_empty() {
        return Ok(Air::Detected);
    }
    let stretch = |text: &String| {
        let numbers: Vec<f64> = text
            .split(',')
            .filter_map(|part| part.trim().parse().ok())
            .collect();
        match numbers[..] {
            [from, to] if text.split(',').count() == 2 => Ok([from, to]),
            _ => Err(StudyError::value(
                format!("--air-s: `{text}` is not an interval"),
                "begin and end in seconds, such as 0,0.5; repeat the option for several intervals",
            )),
        }
    };
    Ok(Air::Given(
        arguments.air_s.iter().map(stretch).collect::<Result<_, _>>()?,
    ))
}

/// The result as text, see the documentation of this module.
fn as_text(answer: &ForcesAnswer) -> String {
    let [cycle, cycles] = answer.cycle_of;
    let of_cycles = match cycles {
        1 => String::new(),
        _ => format!(", cycle {cycle} of {cycles}"),
    };
    let mut lines = vec![
        format!("{}: {}{of_cycles}", answer.file, answer.format),
        format!(
            "{} samples from {} s to {} s, {} Hz; {}",
            answer.samples,
            reported(answer.start_s),
            reported(answer.start_s + answer.duration_s),
            reported(answer.rate_hz),
            answer.channels.join(", ")
        ),
    ];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    lines.push(String::new());
    lines.push(match &answer.drift {
        Some(drift) => drift_text(drift),
        None => "drift        not removed".to_owned(),
    });
    lines.extend(answer.low_pass_hz.map(|hz| format!("low-pass     {hz} Hz")));
    lines.push(String::new());
    lines.push(format!(
        "{:<12} {:>12} {:>12} {:>12}   {:>12} {:>12} {:>12}",
        "N", "mean", "least", "greatest", "mean", "least", "greatest"
    ));
    lines.push(format!("{:<12} {:<41}as used", "", "as measured"));
    for (name, of) in ROWS {
        lines.push(row(name, of(&answer.before), of(&answer.after)));
    }
    if let Some(turns) = &answer.revolutions {
        lines.push(String::new());
        lines.push(format!(
            "{} revolutions: largest mean {:.2} N, largest force {:.2} N",
            turns.count, turns.largest_mean_n, turns.largest_n
        ));
    }
    lines.join("\n")
}

/// A row of the table: its name and its values.
type Row = (&'static str, fn(&SummaryAnswer) -> RangeAnswer);

/// The rows of the table: components in the axes of the record, and the magnitude of the force.
const ROWS: [Row; 4] = [
    ("Fx", |summary| summary.fx_n),
    ("Fy", |summary| summary.fy_n),
    ("Fz", |summary| summary.fz_n),
    ("magnitude", |summary| summary.size_n),
];

/// Mean, least and greatest as measured, then as used, N.
fn row(name: &str, before: RangeAnswer, after: RangeAnswer) -> String {
    let three = |range: RangeAnswer| {
        format!(
            "{:>12.2} {:>12.2} {:>12.2}",
            range.mean, range.least, range.greatest
        )
    };
    format!("{name:<12} {}   {}", three(before), three(after))
}

/// The drift removed: force and rate, and the intervals from which it was determined.
fn drift_text(drift: &DriftAnswer) -> String {
    let three = |[x, y, z]: [f64; 3]| format!("({x:.3}, {y:.3}, {z:.3})");
    let stretch = |[from, to]: &[f64; 2]| format!("{} to {} s", reported(*from), reported(*to));
    let air: Vec<String> = drift.air_s.iter().map(stretch).collect();
    format!(
        "drift        {} N and {} N/s\nair cut      {}: {} samples, {}",
        three(drift.offset_n),
        three(drift.rate_n_per_s),
        air.join(", "),
        drift.samples,
        match drift.air_found {
            true => "detected as the quietest; use --air-s to change them",
            false => "as given",
        }
    )
}

/// Times and rates, to a microsecond.
fn reported(value: f64) -> f64 {
    decimals(value, 6)
}

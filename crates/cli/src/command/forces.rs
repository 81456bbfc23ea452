//! `armill forces`: what is in a record of a dynamometer, before and after drift and teeth are taken off.
//!
//! `--rate-hz`, `--columns` and `--channels` say how the file is read, `--air-s` or `--no-drift`, `--low-pass-hz` and
//! `--spindle-rpm` what is done to it. Stdout holds a [`ForcesAnswer`], in words or as JSON; `--out` takes tables and pictures.
//!
//! ```text
//! groove.txt: DynoWare, cycle 1 of 2                                 file, format
//! 30000 samples from 0 s to 2.9999 s, 10000 Hz; Fx, Fy, Fz           what was read
//! passed over: Ch4                                                   columns not used
//! drift        (ox, oy, oz) N and (rx, ry, rz) N/s                   at the first sample, and its rate; or "left in"
//! N            mean least greatest   mean least greatest             as measured | as used: Fx, Fy, Fz, size
//! ```
//!
//! Times and rates are told to a microsecond, forces to a hundredth of a newton.

use armill_core::load::ActsOn;
use armill_formats::measurement::format::ForceReadOptions;
use armill_study::StudyError;
use armill_study::forces::{
    Air, DriftAnswer, ForcesAnswer, RangeAnswer, Refusal, SummaryAnswer, Treatment, Unread, answer, output,
    read, treat,
};
use armill_study::number::decimals;

use crate::Outcome;
use crate::arguments::ForcesArguments;
use crate::terminal::{print, say};

/// Reads, treats, writes what was asked for and prints.
///
/// # Errors
/// A file that cannot be read, or its problems; a refusal of what is asked, under the name of its option; a
/// folder or stdout that takes no more.
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
    // Nothing here asks what the force acts on: numbers are told as they stand in the file.
    let measured = read((&shown, &arguments.file), ActsOn::Part, &requested, arguments.cycle);
    let measured = measured.map_err(|unread| match unread {
        Unread::File(problems) => problems,
        Unread::Value(refusal) => refused(refusal),
    })?;
    let treated = treat(measured.record.clone(), &treatment).map_err(refused)?;
    let answer = answer(&shown, &measured, &treatment, &treated);
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

/// A refusal of `armill_study`, told under the name of its option instead of that of its key.
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

/// Where nothing is cut: `--no-drift` keeps the drift, `--air-s` tells the stretches, without either they are
/// found.
fn air(arguments: &ForcesArguments) -> Result<Air, StudyError> {
    if arguments.no_drift {
        return Ok(Air::Kept);
    }
    if arguments.air_s.is_empty() {
        return Ok(Air::Found);
    }
    let stretch = |text: &String| {
        let numbers: Vec<f64> = text
            .split(',')
            .filter_map(|part| part.trim().parse().ok())
            .collect();
        match numbers[..] {
            [from, to] if text.split(',').count() == 2 => Ok([from, to]),
            _ => Err(StudyError::value(
                format!("--air-s: `{text}` is no stretch of time"),
                "its begin and its end in seconds, such as 0,0.5; give the option once a stretch",
            )),
        }
    };
    Ok(Air::Told(
        arguments.air_s.iter().map(stretch).collect::<Result<_, _>>()?,
    ))
}

/// The answer as a person reads it, see the head of this file.
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
        lines.push(format!("passed over: {}", answer.unused.join(", ")));
    }
    lines.push(String::new());
    lines.push(match &answer.drift {
        Some(drift) => drift_text(drift),
        None => "drift        left in".to_owned(),
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

/// A row of the table: its name and where it is.
type Row = (&'static str, fn(&SummaryAnswer) -> RangeAnswer);

/// The rows of the table: components in the record's axes, and the size of the force.
const ROWS: [Row; 4] = [
    ("Fx", |summary| summary.fx_n),
    ("Fy", |summary| summary.fy_n),
    ("Fz", |summary| summary.fz_n),
    ("size", |summary| summary.size_n),
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

/// What was taken off: force and rate, and the stretches that it was found in.
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
            true => "found as the quietest; tell it with --air-s if it is not so",
            false => "as told",
        }
    )
}

/// Times and rates, to a microsecond.
fn reported(value: f64) -> f64 {
    decimals(value, 6)
}

//! `armill forces`: what is in a record of a dynamometer, before and after drift and teeth are taken off.
//!
//! `--rate-hz`, `--columns` and `--channels` say how the file is read, `--air-s` or `--no-drift`, `--low-pass-hz` and
//! `--spindle-rpm` what is done to it. Stdout holds a [`ForcesAnswer`], in words or as JSON; `--out` takes tables and pictures.

use armill_core::load::ActsOn;
use armill_formats::measurement::format::Wanted;
use armill_study::StudyError;
use armill_study::forces::{
    Air, DriftAnswer, ForcesAnswer, RangeAnswer, Refusal, SummaryAnswer, Treatment, Unread, answer, output,
    read, treat,
};
use armill_study::number::decimals;

use crate::Outcome;
use crate::arguments::ForcesArguments;
use crate::terminal::{print, say};

pub(crate) fn run(arguments: &ForcesArguments) -> Result<Outcome, StudyError> {
    let shown = arguments.file.display().to_string();
    let wanted = Wanted {
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
    let measured = read((&shown, &arguments.file), ActsOn::Part, &wanted, arguments.cycle);
    let measured = measured.map_err(|unread| match unread {
        Unread::File(problems) => problems,
        Unread::Value(refusal) => refused(refusal),
    })?;
    let treated = treat(measured.record.clone(), &treatment).map_err(refused)?;
    let answer = answer(&shown, &measured, &treatment, &treated);
    if let Some(out) = &arguments.out {
        output::write(&answer, &treated, out)?;
        say(&format!("tables and pictures in {}", out.display()));
    }
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer)
    })?;
    Ok(Outcome::Fine)
}

/// A refusal under the name of its option.
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
            told(answer.start_s),
            told(answer.start_s + answer.duration_s),
            told(answer.rate_hz),
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

const ROWS: [Row; 4] = [
    ("Fx", |summary| summary.fx_n),
    ("Fy", |summary| summary.fy_n),
    ("Fz", |summary| summary.fz_n),
    ("size", |summary| summary.size_n),
];

fn row(name: &str, before: RangeAnswer, after: RangeAnswer) -> String {
    let three = |range: RangeAnswer| {
        format!(
            "{:>12.2} {:>12.2} {:>12.2}",
            range.mean, range.least, range.greatest
        )
    };
    format!("{name:<12} {}   {}", three(before), three(after))
}

fn drift_text(drift: &DriftAnswer) -> String {
    let three = |[x, y, z]: [f64; 3]| format!("({x:.3}, {y:.3}, {z:.3})");
    let stretch = |[from, to]: &[f64; 2]| format!("{} to {} s", told(*from), told(*to));
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
fn told(value: f64) -> f64 {
    decimals(value, 6)
}

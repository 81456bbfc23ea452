//! `armill motion`: how a controller moves an arm, from joint logs.
//!
//! ```text
//! log, robot, tip; moves
//! joint        largest speed and acceleration, lag
//! value        +- standard uncertainty
//! log          cycle time, feed, corners: logged and predicted
//! ```

use armill_core::units::from_mm;
use armill_formats::measurement::joint_log::LogReadOptions;
use armill_measure::motion::answer::{ComparedAnswer, CornerAnswer, JointAnswer, MoveAnswer, ValueAnswer};
use armill_measure::motion::{MotionAnswer, Question, answer, learn, read, robot_file};
use armill_study::{StudyError, robots};

use crate::arguments::MotionArguments;
use crate::arguments::numbers::{finite, three, within};
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Largest zone, mm.
const LARGEST_ZONE_MM: f64 = 1000.0;

/// Reads, learns, writes the requested file and prints the result.
///
/// # Errors
/// No such robot; invalid options; the problems of a log; a log without straight moves that stop; a file that cannot be written.
pub(crate) fn run(arguments: &MotionArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let question = question(arguments)?;
    let log = read(&arguments.log, &found.robot, &question)?;
    let others = arguments
        .compare
        .iter()
        .map(|path| read(path, &found.robot, &question))
        .collect::<Result<Vec<_>, _>>()?;
    let learned = learn(&found, log, &question)?;
    let answer = answer(&found.robot, &learned, &others, &question)?;
    if let Some(file) = &arguments.out {
        let [path, text] = robots::text_of(&arguments.robot, &found)?;
        let written = robot_file([&path, &text], &learned)?;
        let writer = arguments.writing.writer("motion").for_new_files();
        writer.write(file, written.as_bytes())?;
        say(&format!("robot with these values in {}", file.display()));
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

fn question(arguments: &MotionArguments) -> Result<Question, StudyError> {
    finite("--zone-mm", &arguments.zone_mm)?;
    let zones = arguments.zone_mm.iter();
    Ok(Question {
        units: LogReadOptions {
            time: arguments.time_unit.map(Into::into),
            angle: arguments.angle_unit.map(Into::into),
        },
        tip: match &arguments.tool_mm {
            Some(tool) => Some(from_mm(three("--tool-mm", tool)?)),
            None => None,
        },
        zones: zones
            .map(|zone| within("--zone-mm", *zone, [0.0, LARGEST_ZONE_MM]).map(from_mm))
            .collect::<Result<_, _>>()?,
    })
}

fn as_text(answer: &MotionAnswer) -> String {
    let mut lines = vec![format!(
        "{}: {}, {} instants, a step of {} ms",
        answer.robot, answer.file, answer.instants, answer.step_ms
    )];
    let [x, y, z] = answer.tool.tip_mm;
    lines.push(match (answer.tool.tip_u_mm, answer.tool.straightness_rms_mm) {
        (Some([ux, uy, uz]), Some(rms)) => format!(
            "tip ({x:.1}, {y:.1}, {z:.1}) mm in the flange frame, fitted (standard uncertainty ({ux:.1}, {uy:.1}, {uz:.1}) mm): moves are straight within {rms:.3} mm rms"
        ),
        (None, Some(rms)) => format!(
            "tip ({x:.1}, {y:.1}, {z:.1}) mm in the flange frame, fitted, not determined completely: moves are straight within {rms:.3} mm rms"
        ),
        _ => format!("tip ({x:.1}, {y:.1}, {z:.1}) mm in the flange frame, as given"),
    });
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    lines.push(String::new());
    lines.push(format!(
        "{:<12} {:>6} {:>9} {:>9} {:>11} {:>15}",
        "move", "line", "start", "time", "length", "largest speed"
    ));
    lines.extend(answer.moves.iter().map(move_text));
    lines.push(String::new());
    lines.push(format!(
        "{:<8} {:>14} {:>24}   largest reached, windows of {} and {} ms",
        "joint", "speed", "acceleration", answer.speed_window_ms, answer.acceleration_window_ms
    ));
    lines.extend(answer.joints.iter().map(joint_text));
    lines.push(String::new());
    lines.push(format!(
        "fitted to the speed of the tip ({:.1} % rms of the feed)",
        answer.feed_rms_percent
    ));
    for (name, value, unit) in [
        (
            "acceleration along the path",
            answer.path_acceleration_mm_per_s2,
            "mm/s^2",
        ),
        ("smoothing", answer.smoothing_ms, "ms"),
        ("lag", answer.lag_ms, "ms"),
        ("time to settle at a stop", answer.settling_ms, "ms"),
    ] {
        lines.push(format!("{name:<28} {}", value_text(value, unit)));
    }
    lines.push(format!(
        "{:<28} {:.2}",
        "correlation smoothing, lag", answer.correlation_of_smoothing_and_lag
    ));
    for compared in &answer.compared {
        lines.push(String::new());
        lines.extend(compared_text(compared));
    }
    lines.push(String::new());
    lines.extend(answer.assumed.iter().map(|assumed| format!("assumed: {assumed}")));
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn value_text(value: ValueAnswer, unit: &str) -> String {
    match value.u {
        Some(u) => format!("{:>9.2} {unit:<6} +- {u:.2}", value.value),
        None => format!("{:>9.2} {unit:<6} not determined", value.value),
    }
}

fn move_text(part: &MoveAnswer) -> String {
    let shape = match part.radius_mm {
        Some(radius) => format!("{} R{radius:.0}", part.shape),
        None => part.shape.to_owned(),
    };
    format!(
        "{shape:<12} {:>6} {:>7.3} s {:>7.3} s {:>8.1} mm {:>10.1} mm/s",
        part.line, part.start_s, part.time_s, part.length_mm, part.largest_speed_mm_per_s
    )
}

fn joint_text(joint: &JointAnswer) -> String {
    let noise = joint
        .acceleration_noise_deg_per_s2
        .map_or(String::new(), |noise| format!(" (noise {noise:.1})"));
    let lag = joint
        .delay_ms
        .zip(joint.lag_ms)
        .map_or(String::new(), |(delay, lag)| {
            format!(
                "   delay {}, lag {}",
                value_text(delay, "ms").trim(),
                value_text(lag, "ms").trim()
            )
        });
    let lead = joint.motor_lead_s2.map_or(String::new(), |lead| {
        let u = lead.u.map_or(String::new(), |u| format!(" +- {u:.2e}"));
        format!(
            "   motor ahead by {:.2e}{u} s^2 times its acceleration",
            lead.value
        )
    });
    format!(
        "{:<8} {:>8.1} deg/s {:>8.0} deg/s^2{noise:<12}{lag}{lead}",
        joint.name, joint.speed_deg_per_s, joint.acceleration_deg_per_s2
    )
}

fn compared_text(compared: &ComparedAnswer) -> Vec<String> {
    let mut lines = vec![format!(
        "{:<36} {:>10} {:>10} {:>12}",
        compared.file, "logged", "predicted", "difference"
    )];
    for stretch in &compared.stretches {
        let both = stretch.cycle_time_s.zip(stretch.predicted_cycle_time_s);
        if let Some((logged, predicted)) = both {
            lines.push(format!(
                "{:<36} {logged:>8.3} s {predicted:>8.3} s {:>10.2} %",
                format!("  time at {:.1} mm/s", stretch.feed_mm_per_s),
                stretch.cycle_time_error_percent.unwrap_or_default()
            ));
        }
        lines.push(format!(
            "{:<59} {:>10.2} %",
            "  feed, rms", stretch.feed_rms_percent
        ));
        lines.push(format!(
            "{:<36} {:>7.3} mm {:>7.3} mm {:>9.3} mm",
            "  largest distance from the lines",
            stretch.off_line_mm,
            stretch.predicted_off_line_mm,
            stretch.predicted_off_line_mm - stretch.off_line_mm
        ));
        lines.extend(stretch.corners.iter().map(corner_text));
    }
    lines
}

fn corner_text(corner: &CornerAnswer) -> String {
    let how = match (corner.zone_mm, corner.zone_is_fitted) {
        (None, _) => "stop".to_owned(),
        (Some(zone), false) => format!("zone {zone} mm"),
        (Some(zone), true) => format!(
            "zone {zone:.2} +- {:.2} mm, fitted",
            corner.zone_u_mm.unwrap_or_default()
        ),
    };
    format!(
        "{:<36} {:>7.3} mm {:>7.3} mm {:>9.3} mm",
        format!("  corner {:.1} deg, {how}", corner.turn_deg),
        corner.distance_mm,
        corner.predicted_distance_mm,
        corner.distance_error_mm
    )
}

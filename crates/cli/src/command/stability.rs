//! `armill stability`: stability of the cut of a study against chatter.
//!
//! ```text
//! path, modes
//! verdict
//! limits       at the programmed speed, by mode coupling, lowest in the range, at any speed
//! speed        limit                              preferred speeds
//! vibration    amplitude, error of the walls
//! ```

use std::f64::consts::TAU;

use armill_core::units::from_mm;
use armill_study::stability::{
    ArmPosture, GivenCut, GivenModes, Options, Question, StabilityAnswer, answer, evaluate, modes_of, picture,
};
use armill_study::{StudyError, studies};

use super::drawing;
use crate::arguments::StabilityArguments;
use crate::arguments::numbers::{above_zero, finite, within};
use crate::outcome::Outcome;
use crate::terminal::print;

/// Largest spindle speed (rpm), feed (mm/min) and depth (mm).
const LARGEST: [f64; 3] = [1e6, 1e6, 1e3];

/// Reads, evaluates, draws the requested picture and prints the result.
///
/// # Errors
/// Problems of the study or of the modal data; no cut; invalid options; a file that cannot be written.
pub(crate) fn run(arguments: &StabilityArguments) -> Result<Outcome, StudyError> {
    let options = options(arguments)?;
    let data = arguments.modes.as_deref().map(modes_of).transpose()?;
    if let Some(joints) = &arguments.joints_deg {
        finite("--joints-deg", joints)?;
    }
    let posture = arguments.joints_deg.clone().map(|joints_deg| ArmPosture {
        joints_deg,
        point: arguments.point,
    });
    let question = match &arguments.study {
        Some(study) => Question::of_study(
            &studies::find(study)?.read()?,
            arguments.path.as_deref(),
            (data, posture.as_ref()),
            &options,
        )?,
        None => {
            let cut = given_cut(arguments)?.resolve()?;
            Question::of_cut("the given cut", &cut, GivenModes::default().and(data), &options)?
        }
    };
    let answer = answer(&question, &evaluate(&question)?);
    if let Some(file) = &arguments.drawing {
        let writer = arguments.writing.writer("stability").for_new_files();
        drawing::write(&writer, file, &picture(&answer).to_svg())?;
    }
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    Ok(Outcome::Fine)
}

/// The cut of the options, without a study.
fn given_cut(arguments: &StabilityArguments) -> Result<GivenCut, StudyError> {
    let cut = &arguments.cut;
    let needed = |option: &str, value: Option<f64>| {
        let Some(value) = value else {
            let message = format!("{option} is needed without a study");
            return Err(StudyError::value(message, "give it, or a study with [cut]"));
        };
        finite(option, &[value])?;
        Ok(value)
    };
    for (option, value) in [
        ("--helix-deg", cut.helix_deg),
        ("--corner-radius-mm", cut.corner_radius_mm),
        ("--radial-mm", cut.radial_mm),
    ] {
        finite(option, value.as_slice())?;
    }
    Ok(GivenCut {
        material: cut.material.clone().unwrap_or_default(),
        side: cut.side.clone().unwrap_or_default(),
        cutter_diameter_mm: needed("--cutter-diameter-mm", cut.cutter_diameter_mm)?,
        teeth: cut.teeth.unwrap_or_default(),
        helix_deg: cut.helix_deg,
        corner_radius_mm: cut.corner_radius_mm,
        depth_mm: needed("--depth-mm", arguments.depth_mm)?,
        radial_mm: cut.radial_mm,
        spindle_rpm: needed("--spindle-rpm", arguments.spindle_rpm)?,
        feed_mm_per_min: needed("--feed-mm-per-min", arguments.feed_mm_per_min)?,
    })
}

fn options(arguments: &StabilityArguments) -> Result<Options, StudyError> {
    let positive = |flag: &str, value: Option<f64>, largest: f64| match value {
        Some(value) => Ok(Some(within(flag, above_zero(flag, value)?, [0.0, largest])?)),
        None => Ok::<_, StudyError>(None),
    };
    let speeds = match arguments.speeds_rpm.as_deref() {
        None => None,
        Some(&[low, high]) => {
            finite("--speeds-rpm", &[low, high])?;
            above_zero("--speeds-rpm", low)?;
            within("--speeds-rpm", high, [low, LARGEST[0]])?;
            if low == high {
                return Err(StudyError::value(
                    format!("--speeds-rpm: {low} to {high} is no range"),
                    "the lowest and the highest spindle speed: 6000,18000",
                ));
            }
            Some([low, high].map(|rpm| rpm * TAU / 60.0))
        }
        Some(values) => {
            return Err(StudyError::value(
                format!("--speeds-rpm: {} numbers", values.len()),
                "the lowest and the highest spindle speed: 6000,18000",
            ));
        }
    };
    Ok(Options {
        spindle: positive("--spindle-rpm", arguments.spindle_rpm, LARGEST[0])?.map(|rpm| rpm * TAU / 60.0),
        feed: positive("--feed-mm-per-min", arguments.feed_mm_per_min, LARGEST[1])?
            .map(|feed| from_mm(feed) / 60.0),
        depth: positive("--depth-mm", arguments.depth_mm, LARGEST[2])?.map(from_mm),
        speeds,
        deepest: positive("--deepest-mm", arguments.deepest_mm, LARGEST[2])?.map(from_mm),
    })
}

fn as_text(answer: &StabilityAnswer) -> String {
    let depth = |value: Option<f64>| match value {
        Some(mm) => format!("{mm:>9.3} mm"),
        None => format!("{:>9} mm", format!("> {:.1}", answer.deepest_mm)),
    };
    let mut lines = vec![
        format!(
            "{}: {:.0} rpm, {:.3} mm deep, {:.4} mm per tooth",
            answer.path, answer.spindle_rpm, answer.depth_mm, answer.feed_mm_per_tooth
        ),
        format!("modes: {}", answer.modes_from),
        answer.verdict.clone(),
        String::new(),
        format!("limit at this speed         {}", depth(answer.stable_depth_mm)),
        format!(
            "by mode coupling alone      {}",
            depth(answer.mode_coupling_depth_mm)
        ),
    ];
    if let Some(lower) = &answer.lower_limit {
        let of = match lower.as_str() {
            "regeneration" => "the limit at this speed",
            _ => "mode coupling alone",
        };
        lines.push(format!("lower of both               {of}"));
    }
    if let Some([low, high]) = ends(answer) {
        let range = format!("lowest, {low:.0} to {high:.0} rpm");
        lines.push(format!("{range:<28}{}", depth(answer.lowest_depth_mm)));
    }
    lines.push(format!(
        "lowest at any speed         {}",
        depth(answer.critical_depth_mm)
    ));
    if let (Some(u), Some(probability)) = (answer.depth_u_percent, answer.probability_stable) {
        lines.push(format!(
            "standard uncertainty        {u:>9.1} % of the limit; stable with a probability of {:.1} %",
            100.0 * probability
        ));
    }
    if let Some(rpm) = answer.conservative_below_rpm {
        lines.push(format!(
            "below {rpm:.0} rpm limits are conservative: process damping is not modelled"
        ));
    }
    if !answer.preferred_speeds.is_empty() {
        lines.push(String::new());
        lines.push(format!("{:>15} {:>12}", "preferred speed", "limit"));
        lines.extend(
            answer
                .preferred_speeds
                .iter()
                .map(|speed| format!("{:>11.0} rpm {}", speed.speed_rpm, depth(speed.depth_mm))),
        );
    }
    let [x, y, z] = answer.vibration.amplitude_um;
    lines.push(String::new());
    lines.push(format!(
        "vibration under the teeth: +- {x:.1} um along the feed, {y:.1} um across, {z:.1} um along the tool"
    ));
    lines.extend(answer.vibration.walls.iter().map(|wall| {
        format!(
            "wall on the {}: {:+.1} um at the tip, {:+.1} to {:+.1} um over the depth (positive: overcut)",
            wall.side, wall.at_tip_um, wall.least_um, wall.greatest_um
        )
    }));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

fn ends(answer: &StabilityAnswer) -> Option<[f64; 2]> {
    Some([answer.lobes.first()?.speed_rpm, answer.lobes.last()?.speed_rpm])
}

//! `armill pose-accuracy`: pose accuracy and repeatability.
//!
//! ```text
//! robot: file, visits, poses
//! errors        mean   rms   max                of all visits
//! AP, RP, vAP   mean, max                       of poses reached more than once
//! pose          cycles   AP   RP                the worst of them
//! base, point                                   their identified frames
//! ```

use armill_core::calibrate::ParameterSet;
use armill_measure::calibrate::read;
use armill_measure::pose_accuracy::{PoseAccuracyAnswer, answer};
use armill_study::{StudyError, robots};

use super::poses::{errors_head, errors_text, frames_text, question};
use crate::arguments::PoseAccuracyArguments;
use crate::outcome::Outcome;
use crate::terminal::{print, say};

/// Number of poses listed.
const MOST_LISTED: usize = 10;

/// Reads, fits base and point, and prints the result.
///
/// # Errors
/// No such robot; invalid options; the problems of the file; poses that determine too little.
pub(crate) fn run(arguments: &PoseAccuracyArguments) -> Result<Outcome, StudyError> {
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let (question, given) = question(&arguments.poses, ParameterSet::BaseAndTool)?;
    let shown = arguments.file.display().to_string();
    let measured = read(&shown, &arguments.file, &found.robot, &given, &question)?;
    let answer = answer(&found.robot, &shown, &measured, &question)?;
    print(&match arguments.json {
        true => serde_json::to_string_pretty(&answer)?,
        false => as_text(&answer),
    })?;
    if let Some(slip) = &answer.slip {
        say(&format!(
            "warning: the accuracy is not that of the robot: {}",
            slip.sentence()
        ));
    }
    Ok(Outcome::Fine)
}

fn as_text(answer: &PoseAccuracyAnswer) -> String {
    let mut lines = vec![format!(
        "{}: {}, {} visits of {} poses",
        answer.robot, answer.file, answer.visits, answer.poses
    )];
    if !answer.unused.is_empty() {
        lines.push(format!("unused columns: {}", answer.unused.join(", ")));
    }
    if answer.not_measured > 0 {
        lines.push(format!("rows without a measured point: {}", answer.not_measured));
    }
    lines.push(String::new());
    lines.push(errors_head("all visits"));
    lines.push(errors_text("measured - predicted", &answer.absolute));
    if let Some(all) = &answer.repeated {
        lines.push(String::new());
        lines.push(format!("{} poses reached more than once", all.poses));
        lines.push(format!(
            "AP   mean {:.3} mm, worst {:.3} mm",
            all.ap_mean_mm, all.ap_max_mm
        ));
        lines.push(format!(
            "RP   mean {:.3} mm, worst {:.3} mm",
            all.rp_mean_mm, all.rp_max_mm
        ));
        lines.extend(all.vap_max_mm.map(|vap| format!("vAP  worst {vap:.3} mm")));
        lines.push(String::new());
        lines.push(format!(
            "{:<16} {:>6} {:>8} {:>8}   worst AP first",
            "pose", "cycles", "AP mm", "RP mm"
        ));
        let mut worst: Vec<_> = answer.by_pose.iter().collect();
        worst.sort_by(|a, b| b.ap_mm.total_cmp(&a.ap_mm));
        lines.extend(worst.iter().take(MOST_LISTED).map(|pose| {
            format!(
                "{:<16} {:>6} {:>8.3} {:>8.3}",
                pose.name, pose.cycles, pose.ap_mm, pose.rp_mm
            )
        }));
        if worst.len() > MOST_LISTED {
            lines.push(format!("and {} more (--json)", worst.len() - MOST_LISTED));
        }
    }
    lines.push(String::new());
    lines.extend(frames_text(&answer.tracker_from_base, &answer.flange_from_point));
    lines.push(String::new());
    lines.extend(answer.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(answer.sources.iter().map(|source| format!("source: {source}")));
    lines.join("\n")
}

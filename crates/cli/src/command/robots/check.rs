//! `armill robots check`: compares a robot file with poses read from its pendant.
//!
//! Each `--pose` is a reading of the pendant in the angles of `--convention`, with the tool `--tool-mm` active,
//! relative to `--base`; `--within-mm` and `--within-deg` are the limits of agreement. The verdict is data: it goes to
//! stdout; the exit code is 1 if the file disagrees.

use armill_core::robot::convention::PoseDifference;
use armill_core::units::{from_deg, from_mm};
use armill_core::watch::Watch;
use armill_formats::convention::Convention;
use armill_formats::robot::pendant::reading;
use armill_study::input::quantities::pose_mm_deg;
use armill_study::pendant::{PendantAnswer, PendantQuestion, check};
use armill_study::{StudyError, robots};

use crate::arguments::RobotsCheckArguments;
use crate::arguments::numbers::{above_zero, three_or_six};
use crate::outcome::Outcome;
use crate::terminal::print;

/// Compares the file with the readings and prints the verdict.
///
/// # Errors
/// An unknown convention; an invalid reading; an invalid number; no such robot or frame.
pub(super) fn run(arguments: &RobotsCheckArguments) -> Result<Outcome, StudyError> {
    let convention = convention(&arguments.convention)?;
    let readings = arguments.pose.iter().map(|text| {
        reading(text, convention).map_err(|error| {
            let hint = format!(
                "such as --pose \"10,-80,95,20,30,40 = ...\" with {}",
                convention.numbers()
            );
            StudyError::value(format!("--pose \"{text}\": {error}"), hint)
        })
    });
    let within = PoseDifference {
        metres: from_mm(above_zero("--within-mm", arguments.within_mm)?),
        radians: from_deg(above_zero("--within-deg", arguments.within_deg)?),
    };
    let question = PendantQuestion {
        readings: readings.collect::<Result<_, _>>()?,
        flange_from_tool: pose_mm_deg(&three_or_six("--tool-mm", arguments.tool_mm.as_deref())?),
        base: arguments.base.clone(),
        within,
    };
    let found = robots::find(&arguments.robot, ".".as_ref())?;
    let answer = check(&found, &question, Watch::NONE)?;
    print(&if arguments.json {
        serde_json::to_string_pretty(&answer)?
    } else {
        as_text(&answer, arguments)
    })?;
    Ok(match answer.verdict {
        "agrees" => Outcome::Fine,
        _ => Outcome::Disagreement,
    })
}

/// The convention of this name.
fn convention(name: &str) -> Result<Convention, StudyError> {
    let found = Convention::ALL
        .into_iter()
        .find(|convention| convention.name() == name);
    found.ok_or_else(|| {
        let names = Convention::ALL.map(Convention::name).join(", ");
        StudyError::value(
            format!("--convention: `{name}` is not known"),
            format!("one of {names}"),
        )
    })
}

/// The distance of each reading from the file, the verdict, the explanations, and changes that these readings would not
/// show.
fn as_text(answer: &PendantAnswer, arguments: &RobotsCheckArguments) -> String {
    let mut lines = vec![format!("{}, positions in {}", answer.robot, answer.base)];
    for (index, reading) in answer.readings.iter().enumerate() {
        lines.push(format!(
            "  reading {}   {:.2} mm, {:.3} deg from the file",
            index + 1,
            reading.apart_mm,
            reading.apart_deg
        ));
    }
    lines.push(String::new());
    let bound = format!("{} mm and {} deg", arguments.within_mm, arguments.within_deg);
    lines.push(match answer.verdict {
        "agrees" => format!("The file and the pendant agree within {bound}."),
        "explained" => format!("They disagree. This explains every reading within {bound}:"),
        "undecided" => format!(
            "They disagree, and {} explanations are equally simple. Read another pose, with every joint away from 0 and 90 deg:",
            answer.explanations.len()
        ),
        _ => "They disagree, and no combination of signs, zeros, coupling, base, flange frame and unit that was searched explains it: compare the lengths of the links, the tool, and the type of the arm.".to_owned(),
    });
    for (index, explanation) in answer.explanations.iter().enumerate() {
        if answer.explanations.len() > 1 {
            lines.push(format!("  {}.", index + 1));
        }
        lines.extend(explanation.changes.iter().map(|change| format!("  {change}")));
    }
    if !answer.unseen.is_empty() {
        lines.push("These readings do not show whether".to_owned());
        lines.extend(answer.unseen.iter().map(|change| format!("  {change}")));
        lines.push("Read another pose to check this.".to_owned());
    }
    lines.join("\n")
}

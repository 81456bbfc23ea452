//! A path of a study as a robot program: its cuts, the ways between them, and what tool, spindle and coolant do.
//!
//! ```text
//! home -> joint move to the first rapid -> rapids of the program, straight -> the cut, in fewer points
//!      -> rapids to the next cut, or by joint moves above the part -> ... -> home
//! ```
//!
//! Targets are relative to the frame of the path: for a part placed elsewhere the frame is taught, and the program is
//! not changed; compensation is only valid where it was computed. The frame is given relative to that of the controller
//! (frame `controller` of the robot file, else `base_link`).
//!
//! `settings`: how the program is to be; `arm`: poses and joint positions, and whether a straight move can be
//! followed; `cut`: the points of a cut and their approximate positioning; `holes`: holes instead of a path, and `order`
//! their order; `way`: from one cut to the next, over the `rapids` of the path; `tooling`: tool, spindle and coolant; `maker`: whether the language is
//! that of the robot.

mod arm;
mod cut;
mod holes;
mod maker;
mod order;
mod rapids;
mod settings;
mod tooling;
mod way;

pub use holes::{HolesToWrite, hole_program};
pub use maker::own_language;
pub use settings::ProgramSettings;

use armill_core::kernel::Answers;
use armill_core::path::Track;
use armill_programs::{Draft, DraftStep, Written, write};

use self::arm::Arm;
use self::cut::Cuts;
use self::tooling::Tooling;
use self::way::{CutStart, Space, Ways};
use crate::analysis::path::answer::obstacles;
use crate::error::StudyError;
use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::joint_order::joint_positions;
use crate::joint_unit::JointUnit;
use crate::number::decimals;

/// A path with its postures, to be written as a program.
#[derive(Clone, Copy)]
pub struct PathToWrite<'a> {
    /// How its points are evaluated.
    pub setting: &'a Setting,
    /// Its points.
    pub track: &'a Track,
    /// Their postures.
    pub answers: &'a Answers,
    /// Top of the path without compensation, m ([`Track::top`]): rapids of the path are relative to it.
    pub top: f64,
    /// Speed of the spindle if the path does not specify it, rad/s, clockwise.
    pub spindle: Option<f64>,
}

/// The program along a path.
///
/// # Errors
/// An obstacle on the path (no posture, joint limits, a jump, the speed of a joint); no way to a cut; a path without
/// feed if none is given; data that the language cannot express.
pub fn program(
    study: &Study,
    path: PathToWrite<'_>,
    requested: &ProgramSettings,
) -> Result<Written, StudyError> {
    let PathToWrite {
        setting,
        track,
        answers,
        top,
        spindle,
    } = path;
    check(study, path)?;
    let standing = standing(study, answers)?;
    let arm = Arm {
        robot: &study.robot.robot,
        setting,
        base_from_path: track.placing.base_from_path,
        standing: standing.as_deref(),
    };
    let mut tooling = Tooling::new(&study.controller, spindle, &requested.name);
    let places = track.path.points.iter().map(|point| point.at);
    let ways = Ways::new(
        arm,
        &track.placing,
        Space::of(top, places),
        requested,
        &study.controller,
    );
    let cuts = Cuts {
        arm,
        track,
        answers,
        requested,
    };
    let stretches: Vec<_> = track.path.stretches().collect();
    let mut steps: Vec<DraftStep> = Vec::new();
    for (index, stretch) in stretches.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| stretches[before].end - 1);
        let change = tooling.at(&track.path, before, stretch.start);
        let start = CutStart {
            at: cuts.arm_at(stretch.start),
            feed: cuts.feed((stretch.start + 1).min(stretch.end - 1))?,
            line: track.path.points[stretch.start].line,
        };
        let from = before.map(|at| cuts.arm_at(at));
        steps.extend(ways.between(from.as_ref(), &start, track.path.rapids.get(index), change)?);
        cuts.steps(stretch.clone(), &mut tooling, &mut steps)?;
    }
    if let Some(last) = stretches.last() {
        let from = cuts.arm_at(last.end - 1);
        let end = tooling.at_end(&track.path);
        steps.extend(ways.home_from(
            &from,
            &track.path.last_rapids,
            end,
            track.path.points[last.end - 1].line,
        )?);
    }
    let notes = ways.notes().into_iter().chain(tooling.notes());
    written(study, arm, requested, steps, notes)
}

/// Where the positioner stands in all postures and at the home position of the program, rad (m), from its table back; none if it
/// moves, or if there is none.
fn standing(study: &Study, answers: &Answers) -> Result<Option<Vec<f64>>, StudyError> {
    let robot = &study.robot.robot;
    let count = robot.chain().ground().positioner_joints();
    let home = study.controller.home_deg.as_ref();
    let home = home.map(|home| joint_positions(robot, home)).transpose()?;
    let reached = (0..answers.points.len()).filter(|index| answers.points[*index].is_ok());
    let mut all = reached
        .map(|index| answers.joints_at(index))
        .chain(home.as_deref());
    let Some(first) = all.next().filter(|_| count > 0) else {
        return Ok(None);
    };
    let is_there = |joints: &[f64]| {
        let mut pairs = joints[..count].iter().zip(&first[..count]);
        pairs.all(|(a, b)| (a - b).abs() < STANDS)
    };
    Ok(all.all(is_there).then(|| first[..count].to_vec()))
}

/// A joint of a positioner that moves by less stands, rad (m).
const STANDS: f64 = 1e-9;

/// The program with these steps; `notes` are reported before those of the language.
fn written(
    study: &Study,
    arm: Arm<'_>,
    requested: &ProgramSettings,
    steps: Vec<DraftStep>,
    notes: impl Iterator<Item = String>,
) -> Result<Written, StudyError> {
    let draft = Draft {
        name: requested.name.clone(),
        remarks: remarks(study),
        base_from_frame: arm.reference_from_frame(),
        frame_on: arm.frame_on(),
        flange_from_tool: arm.mount_from_tool(),
        controller: settings::controller(&study.controller, requested),
        external_slides: arm.external_slides(),
        steps,
    };
    let mut written =
        write(requested.language, &draft).map_err(|error| StudyError::value(error.to_string(), HINT))?;
    let questions = maker::question(&study.robot, requested.language);
    let notes = questions.into_iter().chain(stands(arm)).chain(notes);
    written.notes.splice(0..0, notes);
    Ok(written)
}

/// Where a positioner that no statement of the program moves must stand.
fn stands(arm: Arm<'_>) -> Option<String> {
    let joints = arm.standing?.iter().enumerate().rev();
    let at = joints.map(|(joint, position)| {
        let unit = JointUnit::of(arm.robot, joint);
        let name = &arm.robot.joints()[joint].name;
        format!("{name} {} {}", decimals(position * unit.scale, 3), unit.name)
    });
    let at: Vec<String> = at.collect();
    Some(format!(
        "the program does not move the positioner, which must stand at {}",
        at.join(", ")
    ))
}

/// What to do where a language refuses a program.
const HINT: &str =
    "the name of the file is that of the program; see [controller] of the study for frame and tool";

/// Origin of the program, and what must be known before it is used.
fn remarks(study: &Study) -> Vec<String> {
    let mut remarks = vec![
        format!("armill {}: {}", env!("CARGO_PKG_VERSION"), study.title),
        format!("robot {}", study.robot.robot.name()),
    ];
    if study.compliance_is_assumed() {
        remarks.push(
            "CAUTION: computed with assumed joint compliances, not measured ones; do not use its corrections on a part"
                .to_owned(),
        );
    }
    remarks
}

/// The arm must be able to follow every cut at its feed without a stop.
fn check(study: &Study, path: PathToWrite<'_>) -> Result<(), StudyError> {
    let robot = &study.robot.robot;
    let all = obstacles::found(robot, &path.track.path, path.answers, 0.0);
    if all.is_empty() {
        return Ok(());
    }
    let messages: Vec<&str> = all.iter().map(|obstacle| obstacle.message.as_str()).collect();
    let slower = all.iter().all(|obstacle| obstacle.kind == "joint-speed");
    Err(StudyError::value(
        format!(
            "no program can be written, for the robot cannot follow the path: {}",
            messages.join("; ")
        ),
        match slower {
            true => "reduce the feed there, or change the posture or the placement of the part",
            false => "move the part, or let `posture.search` look for a posture",
        },
    ))
}

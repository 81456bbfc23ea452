//! Holes as a robot program: each from above, at the drilling feed, in pecks, and back.
//!
//! ```text
//! joint or straight move above the part -> clearance -> feed to the depth of a peck -> rapid to the clearance -> ... -> dwell -> clearance
//! ```
//!
//! Holes that cannot be drilled are left out, with a comment in the program and a note.

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::Answers;
use armill_core::nalgebra::{Point3, Translation3};
use armill_core::path::{Pace, Track};
use armill_core::units::to_mm;
use armill_programs::{DraftStep, Written};

use super::arm::{Arm, ArmAt};
use super::order::shortest;
use super::settings::ProgramSettings;
use super::tooling::Tooling;
use super::way::{CutStart, Space, Ways};
use super::{standing, written};
use crate::analysis::holes::HolesAnalysis;
use crate::analysis::holes::table::HoleOrder;
use crate::error::StudyError;
use crate::file::resolve::Study;

/// Holes with their postures, to be written as a program.
#[derive(Clone, Copy)]
pub struct HolesToWrite<'a> {
    /// Their analysis.
    pub holes: &'a HolesAnalysis,
    /// Their positions.
    pub track: &'a Track,
    /// Their postures; none where a hole is out of reach.
    pub answers: &'a Answers,
    /// Indices of holes whose every posture is rejected.
    pub refused: &'a [usize],
}

/// Height above the last depth at which the feed begins again after a peck, m.
const ABOVE_PECK: f64 = 0.5e-3;
/// Speed of a joint whose maximum is not known, rad/s, to compare joint travel.
const USUAL_SPEED: f64 = 2.0;

/// The program that drills these holes.
///
/// # Errors
/// No depth or feed is given; no hole can be drilled; the robot cannot retract in the posture of a hole; data that the
/// language cannot express.
pub fn hole_program(
    study: &Study,
    given: HolesToWrite<'_>,
    requested: &ProgramSettings,
) -> Result<Written, StudyError> {
    let HolesToWrite {
        holes,
        track,
        answers,
        refused,
    } = given;
    let drilling = &holes.drilling;
    let depth = drilling.depth.ok_or_else(|| {
        StudyError::value(
            "the depth of the holes is not given: no program can be written",
            "holes = { ..., depth_mm = 12 }, from the surface to the end of the hole",
        )
    })?;
    let standing = standing(study, answers)?;
    let arm = Arm {
        robot: &study.robot.robot,
        setting: &holes.path.setting,
        base_from_path: track.placing.base_from_path,
        standing: standing.as_deref(),
    };
    let hole = Hole {
        arm,
        stroke: depth + drilling.clearance,
        peck: drilling.peck,
        clearance: drilling.clearance,
        dwell: drilling.dwell,
        rapid: study.controller.rapid(),
    };
    let (mut drilled, mut lost) = (Vec::new(), Vec::new());
    for index in 0..track.len() {
        match answers.points[index]
            .as_ref()
            .ok()
            .filter(|found| found.within_limits() && !refused.contains(&index))
        {
            Some(found) => drilled.push(hole.at(
                index,
                ArmAt {
                    base_from_tool: track.stop(index).base_from_tool,
                    joints: answers.joints_at(index).to_vec(),
                    branch: found.name.branch(),
                },
                track.path.points[index].line,
            )?),
            None => lost.push(index + 1),
        }
    }
    if drilled.is_empty() {
        return Err(StudyError::value(
            "none of the holes can be drilled: no program can be written",
            "move the part; `armill run` states the reason of each hole",
        ));
    }
    let spindle = holes.path.drill.as_ref().and_then(|cut| cut.drill.spindle);
    let mut tooling = Tooling::new(&study.controller, spindle, &requested.name);
    let path_from_base = track.placing.base_from_path.inverse();
    let tip = |at: &ArmAt| path_from_base * Point3::from(at.base_from_tool.translation.vector);
    let places: Vec<Point3<f64>> = drilled.iter().map(|hole| tip(&hole.above)).collect();
    let heights = places.iter().map(|place| place.coords.dot(&track.placing.axis));
    let top = heights.fold(f64::NEG_INFINITY, f64::max);
    let ways = Ways::new(
        arm,
        &track.placing,
        Space::of(top, places.into_iter()),
        requested,
        &study.controller,
    );
    let mut steps = Vec::new();
    let mut before: Option<(usize, ArmAt)> = None;
    for at in ordered(&drilled, track, arm, drilling.order) {
        let one = &drilled[at];
        let feed = feed(track, one, holes, requested)?;
        let above = before.as_ref().map_or_else(
            || one.above.clone(),
            |(_, before)| arm.with_turns_near(&one.above, &before.joints),
        );
        let change = tooling.at(&track.path, before.as_ref().map(|(index, _)| *index), one.index);
        let start = CutStart {
            at: above.clone(),
            feed: hole.rapid,
            line: one.line,
        };
        let from = before.as_ref().map(|(_, from)| from);
        steps.extend(ways.between(from, &start, None, change)?);
        steps.push(DraftStep::Comment(format!("hole {}", one.index + 1)));
        steps.extend(hole.steps(&above, &one.end, feed)?);
        before = Some((one.index, above));
    }
    if let Some((_, from)) = &before {
        let end = tooling.at_end(&track.path);
        steps.extend(ways.home_from(from, &track.path.last_rapids, end, 0)?);
    }
    let mut notes: Vec<String> = ways.notes().into_iter().chain(tooling.notes()).collect();
    if !lost.is_empty() {
        let numbers: Vec<String> = lost.iter().map(usize::to_string).collect();
        let message = format!(
            "{} of {} holes cannot be drilled and are not in the program: {}",
            lost.len(),
            track.len(),
            numbers.join(", ")
        );
        steps.insert(0, DraftStep::Comment(message.clone()));
        notes.insert(0, message);
    }
    written(study, arm, requested, steps, notes.into_iter())
}

/// A hole that can be drilled.
struct DrilledHole {
    /// Its number, from 0.
    index: usize,
    /// The arm at the clearance above it.
    above: ArmAt,
    /// Its end.
    end: Isometry,
    line: u32,
}

/// How a hole is drilled.
struct Hole<'a> {
    arm: Arm<'a>,
    /// From the clearance to the end, m.
    stroke: f64,
    peck: Option<f64>,
    clearance: f64,
    dwell: f64,
    /// Speed of moves that do not drill, m/s.
    rapid: f64,
}

impl Hole<'_> {
    fn at(&self, index: usize, end: ArmAt, line: u32) -> Result<DrilledHole, StudyError> {
        let pose = end.base_from_tool * Translation3::new(0.0, 0.0, -self.stroke);
        let straight = self.arm.straight(&end, &pose).ok_or_else(|| {
            StudyError::value(
                format!(
                    "hole {}: the robot cannot retract by {:.1} mm in its posture",
                    index + 1,
                    to_mm(self.stroke)
                ),
                "a smaller clearance_mm, or another placement of the part",
            )
        })?;
        Ok(DrilledHole {
            index,
            above: straight.end,
            end: end.base_from_tool,
            line,
        })
    }

    /// From the clearance into the hole and back.
    fn steps(&self, above: &ArmAt, end: &Isometry, feed: f64) -> Result<Vec<DraftStep>, StudyError> {
        let mut steps = Vec::new();
        let mut at = above.clone();
        let mut go = |depth: f64, speed: f64| -> Result<(), StudyError> {
            let pose = end * Translation3::new(0.0, 0.0, depth - self.stroke);
            let straight = self.arm.straight(&at, &pose).ok_or_else(|| {
                StudyError::value(
                    "the robot cannot follow the axis of a hole",
                    "another placement of the part",
                )
            })?;
            let speed = speed.min(straight.fastest);
            at = straight.end;
            steps.push(DraftStep::Move(self.arm.target(&at, Some(speed), 0.0)));
            Ok(())
        };
        if let Some(peck) = self.peck {
            let mut reached = self.clearance + peck;
            while reached < self.stroke - ABOVE_PECK {
                go(reached, feed)?;
                go(0.0, self.rapid)?;
                go(reached - ABOVE_PECK, self.rapid)?;
                reached += peck;
            }
        }
        go(self.stroke, feed)?;
        let bottom = at.clone();
        if self.dwell > 0.0 {
            steps.push(DraftStep::Dwell(self.dwell));
        }
        let back = self.arm.straight(&bottom, &above.base_from_tool);
        let speed = back.map_or(feed, |straight| self.rapid.min(straight.fastest));
        steps.push(DraftStep::Move(self.arm.target(above, Some(speed), 0.0)));
        Ok(steps)
    }
}

/// The indices of the holes in the order in which they are drilled: within each operation of the program.
fn ordered(drilled: &[DrilledHole], track: &Track, arm: Arm<'_>, order: HoleOrder) -> Vec<usize> {
    if order == HoleOrder::Given {
        return (0..drilled.len()).collect();
    }
    let speeds: Vec<f64> = (arm.robot.joints().iter())
        .map(|joint| joint.max_speed.unwrap_or(USUAL_SPEED))
        .collect();
    let operation = |hole: &DrilledHole| {
        track
            .path
            .operations
            .iter()
            .filter(|(first, _)| *first <= hole.index)
            .count()
    };
    let mut all = Vec::with_capacity(drilled.len());
    for group in drilled.chunk_by(|a, b| operation(a) == operation(b)) {
        let start = all.last().map(|last: &usize| &drilled[*last].above.joints[..]);
        let positions: Vec<&[f64]> = group.iter().map(|hole| &hole.above.joints[..]).collect();
        let first = all.len();
        let found = shortest(&positions, start, &speeds);
        all.extend(found.into_iter().map(|index| first + index));
    }
    all
}

/// The drilling feed, m/s.
fn feed(
    track: &Track,
    hole: &DrilledHole,
    holes: &HolesAnalysis,
    requested: &ProgramSettings,
) -> Result<f64, StudyError> {
    let of_program = match track.path.points[hole.index].pace {
        Pace::Feed(speed) => Some(speed),
        Pace::Rapid | Pace::Unknown => None,
    };
    let of_drill = holes.path.drill.as_ref().and_then(|cut| cut.drill.feed);
    of_program.or(of_drill).or(requested.feed).ok_or_else(|| {
        StudyError::value(
            format!("hole {} has no feed", hole.index + 1),
            "give one: drill = { ..., feed_mm_per_min = 120 }, or --feed-mm-per-min 120",
        )
    })
}

impl Arm<'_> {
    /// The same posture with the turns of its joints next to other positions, within the joint limits.
    fn with_turns_near(&self, at: &ArmAt, near: &[f64]) -> ArmAt {
        let mut joints = at.joints.clone();
        for joint in 0..joints.len() {
            if self.robot.slides(joint) {
                continue;
            }
            let turned = joints[joint] + TAU * ((near[joint] - joints[joint]) / TAU).round();
            let mut moved = joints.clone();
            moved[joint] = turned;
            if self.is_within_limits(&moved) {
                joints = moved;
            }
        }
        ArmAt { joints, ..at.clone() }
    }
}

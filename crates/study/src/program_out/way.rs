//! The ways of a program that do not cut: from home to the first cut, from cut to cut, and home.
//!
//! The rapids of the path are followed as straight moves, at their heights. Where the path has none, or a rapid goes across
//! below the top of the path, the tool retracts along its axis above the part, and then up where the tool leans far. Where
//! the arm cannot follow in one posture, it goes by a joint move from the highest place after a cut to the highest before
//! the next, over the home position if there is one; so it does to change the tool at home. A
//! joint move must not pass through the space of the part below its top.

use std::cell::Cell;

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Translation3, Vector3};
use armill_core::path::{Placing, Rapids};
use armill_core::units::to_mm;
use armill_formats::controller::ControllerTable;
use armill_programs::DraftStep;

use super::arm::{Arm, ArmAt};
use super::rapids::RapidPoses;
use super::settings::ProgramSettings;
use super::tooling::Change;
use crate::error::StudyError;
use crate::joint_order::joint_positions;

/// Joint positions that differ by less are the same, rad (m).
const SAME_JOINTS: f64 = 1e-3;
/// Distance around the path, m, in which a joint move must stay above the part.
const AROUND: f64 = 0.02;
/// A move that leaves the tool axis by more goes across, m: more than a compensated end of a cut is moved.
const ACROSS: f64 = 2e-3;
/// Places that differ by less are one, m.
const SAME_PLACE: f64 = 1e-6;
/// A joint move may pass this far below the top of the part, m.
const BELOW: f64 = 1e-4;

/// Ways between the cuts of a path.
pub(super) struct Ways<'a> {
    arm: Arm<'a>,
    rapids: RapidPoses<'a>,
    /// Away from the part, in the frame of the path.
    up: Vector3<f64>,
    space: Space,
    retract: f64,
    rapid: f64,
    home: Option<Vec<f64>>,
    /// Rapids of the path that are not followed.
    left_out: Cell<usize>,
}

/// The space of the part, in the frame of the path, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Space {
    /// Largest height of a cut without compensation.
    top: f64,
    /// Lowest and highest coordinates of the cuts.
    corners: [Point3<f64>; 2],
}

impl Space {
    /// That of a path with this top through these places.
    pub fn of(top: f64, mut places: impl Iterator<Item = Point3<f64>>) -> Space {
        let first = places.next().unwrap_or_else(Point3::origin);
        Space {
            top,
            corners: places.fold([first, first], |[low, high], at| [low.inf(&at), high.sup(&at)]),
        }
    }
}

/// Where a cut starts.
pub(super) struct CutStart {
    /// The arm there.
    pub at: ArmAt,
    /// Feed of the cut, m/s: the tool goes down to it at this speed where the path has no rapids.
    pub feed: f64,
    /// Line of the path.
    pub line: u32,
}

/// Straight moves from a cut, or to one.
struct Leg {
    /// The arm at the far end.
    end: ArmAt,
    /// The moves in the order in which they are driven.
    steps: Vec<DraftStep>,
}

impl<'a> Ways<'a> {
    /// Ways between the cuts of a part in this space, of a path with this placing.
    pub fn new(
        arm: Arm<'a>,
        placing: &'a Placing,
        space: Space,
        requested: &ProgramSettings,
        controller: &ControllerTable,
    ) -> Ways<'a> {
        let up = placing.axis.into_inner();
        // The number of its values was checked with the study.
        let home = controller.home_deg.as_ref();
        let home = home.and_then(|home| joint_positions(arm.robot, home).ok());
        Ways {
            arm,
            rapids: RapidPoses { placing },
            up,
            space,
            retract: requested.retract,
            rapid: controller.rapid(),
            home,
            left_out: Cell::new(0),
        }
    }

    /// What must be known of these ways, one sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let left_out = self.left_out.get();
        if left_out > 0 {
            notes.push(format!(
                "{left_out} rapids of the path are not followed, because they go across below the top of the path or the arm \
                 cannot follow them in one posture: the tool retracts instead"
            ));
        }
        if self.home.is_none() {
            notes.push(
                "the program has no home position: it begins above the first cut and ends above the last; `home_deg` of \
                 [controller] gives one"
                    .to_owned(),
            );
        }
        notes
    }

    /// The way to the start of a cut: from the end `from` of the cut before, or from home.
    ///
    /// # Errors
    /// The tool cannot retract, or a joint move would pass through the space of the part.
    pub fn between(
        &self,
        from: Option<&ArmAt>,
        start: &CutStart,
        rapids: Option<&Rapids>,
        change: Change,
    ) -> Result<Vec<DraftStep>, StudyError> {
        let (to, line) = (&start.at, start.line);
        let moves = rapids.map_or(&[][..], |rapids| &rapids.moves);
        let has_rapids = !moves.is_empty();
        // The last rapid ends where the cut begins.
        let moves = &moves[..moves.len().saturating_sub(1)];
        let Some(from) = from else {
            let poses = self.rapids.before(to, moves);
            let poses = self.clear(None, poses, Some(to)).unwrap_or_default();
            let arriving = self.arriving(start, &poses)?;
            let mut steps = self.home_move();
            steps.extend(change.above);
            steps.extend(self.joint_move(self.home.as_deref(), &arriving.end, line)?);
            steps.extend(arriving.steps);
            return Ok(steps);
        };
        let mut steps = change.at_cut;
        let poses = self.rapids.between(from, to, moves);
        let clear = self.clear(Some(from), poses, Some(to)).filter(|_| has_rapids);
        // Without a home position the tool is changed at the highest place of the way.
        let goes_home = change.changes_tool && self.home.is_some();
        if !goes_home && let Some(way) = self.straight_through(from, start, clear.as_deref(), &change.above) {
            steps.extend(way);
            return Ok(steps);
        }
        let poses = clear.unwrap_or_default();
        let highest = self.highest(&poses);
        let leaving = self.leaving(from, &poses[..highest], line)?;
        let arriving = self.arriving(start, &poses[highest.saturating_sub(1)..])?;
        steps.extend(leaving.steps);
        let over_home = self.home.is_some() && (change.changes_tool || !is_same(&leaving.end, &arriving.end));
        let mut at = Some(leaving.end.joints);
        if over_home {
            self.check_joint_move(at.as_deref(), self.home.as_deref(), line)?;
            steps.extend(self.home_move());
            at = self.home.clone();
        }
        steps.extend(change.above);
        steps.extend(self.joint_move(at.as_deref(), &arriving.end, line)?);
        steps.extend(arriving.steps);
        Ok(steps)
    }

    /// The way home from the end `from` of the last cut.
    ///
    /// # Errors
    /// As [`Ways::between`].
    pub fn home_from(
        &self,
        from: &ArmAt,
        rapids: &Rapids,
        change: Change,
        line: u32,
    ) -> Result<Vec<DraftStep>, StudyError> {
        let poses = self.rapids.after(from, &rapids.moves);
        let poses = self.clear(Some(from), poses, None).unwrap_or_default();
        let highest = self.highest(&poses);
        let leaving = self.leaving(from, &poses[..highest], line)?;
        let mut steps = change.at_cut;
        steps.extend(leaving.steps);
        steps.extend(change.above);
        if self.home.is_some() {
            self.check_joint_move(Some(&leaving.end.joints), self.home.as_deref(), line)?;
        }
        steps.extend(self.home_move());
        Ok(steps)
    }

    fn home_move(&self) -> Vec<DraftStep> {
        let pose = |joints: &Vec<f64>| self.arm.at_joints(joints);
        let target = self
            .home
            .as_ref()
            .map(|home| self.arm.target(&pose(home), None, 0.0));
        target.map(DraftStep::Move).into_iter().collect()
    }

    fn joint_move(
        &self,
        from: Option<&[f64]>,
        to: &ArmAt,
        line: u32,
    ) -> Result<Option<DraftStep>, StudyError> {
        if from.is_some_and(|from| same_joints(from, &to.joints)) {
            return Ok(None);
        }
        self.check_joint_move(from, Some(&to.joints), line)?;
        Ok(Some(DraftStep::Move(self.arm.target(to, None, 0.0))))
    }

    /// A joint move must keep the demanded clearance, and not pass through the space of the part below its top.
    fn check_joint_move(
        &self,
        from: Option<&[f64]>,
        to: Option<&[f64]>,
        line: u32,
    ) -> Result<(), StudyError> {
        let Some((from, to)) = from.zip(to) else {
            return Ok(());
        };
        if let Some(conflict) = self.arm.conflict_on_move(from, to) {
            let message = format!("line {line}: on the joint move to or from the cut there {conflict}");
            let hint = "give a home position that is clear of both ([controller] home_deg), or a larger --retract-mm";
            return Err(StudyError::value(message, hint));
        }
        let [low, high] = self.space.corners;
        let is_near = |tip: &Point3<f64>| {
            let part = |axis: usize| (low[axis] - AROUND..=high[axis] + AROUND).contains(&tip[axis]);
            // Across the direction away from the part.
            let across = (0..3).filter(|axis| self.up[*axis].abs() < 0.7);
            across.into_iter().all(part)
        };
        let lowest = self
            .arm
            .tips(from, to)
            .filter(is_near)
            .map(|tip| tip.coords.dot(&self.up))
            .fold(f64::INFINITY, f64::min);
        if lowest >= self.space.top - BELOW {
            return Ok(());
        }
        Err(StudyError::value(
            format!(
                "line {line}: the joint move to or from the cut there would take the tip {:.1} mm below the top of the \
                 part",
                to_mm(self.space.top - lowest)
            ),
            "give a home position above the part ([controller] home_deg), or a larger --retract-mm",
        ))
    }

    /// The way from cut to cut by straight moves alone: through the poses of rapids, else above the part; with `above` at its
    /// highest place. `None` if the arm cannot follow it.
    fn straight_through(
        &self,
        from: &ArmAt,
        start: &CutStart,
        rapids: Option<&[Isometry]>,
        above: &[DraftStep],
    ) -> Option<Vec<DraftStep>> {
        let to = &start.at;
        let last_speed = if rapids.is_some() { self.rapid } else { start.feed };
        let lifted = [self.lifted(from), self.lifted(to)];
        let poses = match rapids {
            // A single rapid leads from cut to cut.
            Some([]) if !above.is_empty() => &lifted[..],
            Some(poses) => poses,
            None => &lifted[..],
        };
        let highest = self.highest(poses).saturating_sub(1);
        let (mut steps, mut at) = (Vec::new(), from.clone());
        for (index, pose) in poses.iter().chain([&to.base_from_tool]).enumerate() {
            let straight = self.arm.straight(&at, pose)?;
            let speed = if index == poses.len() {
                last_speed
            } else {
                self.rapid
            };
            let speed = speed.min(straight.fastest);
            at = straight.end;
            steps.push(DraftStep::Move(self.arm.target(&at, Some(speed), 0.0)));
            if index == highest {
                steps.extend(above.iter().cloned());
            }
        }
        is_same(&at, to).then_some(steps)
    }

    /// From the end of a cut through these poses, as far as the arm can follow; else along the tool axis.
    fn leaving(&self, from: &ArmAt, poses: &[Isometry], line: u32) -> Result<Leg, StudyError> {
        let (mut steps, mut at) = (Vec::new(), from.clone());
        for (index, pose) in poses.iter().enumerate() {
            let Some(straight) = self.arm.straight(&at, pose) else {
                self.left_out.set(self.left_out.get() + poses.len() - index);
                break;
            };
            let speed = self.rapid.min(straight.fastest);
            at = straight.end;
            steps.push(DraftStep::Move(self.arm.target(&at, Some(speed), 0.0)));
        }
        if self.is_above(&at) && !steps.is_empty() {
            return Ok(Leg { end: at, steps });
        }
        for (place, speed) in self.retracted(&at, line)? {
            steps.push(DraftStep::Move(self.arm.target(&place, Some(speed), 0.0)));
            at = place;
        }
        Ok(Leg { end: at, steps })
    }

    /// Through these poses to the start of a cut, from as far as the arm can follow; else along the tool axis.
    fn arriving(&self, start: &CutStart, poses: &[Isometry]) -> Result<Leg, StudyError> {
        let to = &start.at;
        // Backwards: the arm must end in the posture of the cut.
        let mut way = vec![(to.clone(), self.last_speed(start, poses))];
        let mut at = to.clone();
        for (index, pose) in poses.iter().rev().enumerate() {
            let Some(straight) = self.arm.straight(&at, pose) else {
                self.left_out.set(self.left_out.get() + poses.len() - index);
                break;
            };
            at = straight.end;
            if let Some(last) = way.last_mut() {
                last.1 = last.1.min(straight.fastest);
            }
            way.push((at.clone(), self.rapid));
        }
        if way.len() == 1 || !self.is_above(&at) {
            for (place, fastest) in self.retracted(&at, start.line)? {
                if let Some(last) = way.last_mut() {
                    last.1 = last.1.min(fastest);
                }
                way.push((place, self.rapid));
            }
        }
        let end = way.pop().map_or_else(|| to.clone(), |(end, _)| end);
        let moves = way.iter().rev();
        let steps = moves.map(|(at, speed)| DraftStep::Move(self.arm.target(at, Some(*speed), 0.0)));
        Ok(Leg {
            steps: steps.collect(),
            end,
        })
    }

    /// Speed of the last move to a cut: of a rapid of the path, or its feed where the path has none.
    fn last_speed(&self, start: &CutStart, poses: &[Isometry]) -> f64 {
        if poses.is_empty() { start.feed } else { self.rapid }
    }

    /// The places of the arm on its way above the part, along the tool axis from `at` and then up, each with the speed to
    /// it.
    fn retracted(&self, at: &ArmAt, line: u32) -> Result<Vec<(ArmAt, f64)>, StudyError> {
        let lifted = self.lifted(at);
        let straight = self.arm.straight(at, &lifted).ok_or_else(|| {
            let mm = to_mm((lifted.translation.vector - at.base_from_tool.translation.vector).norm());
            let message = match self.arm.setting.cell {
                Some(_) => format!("line {line}: the robot cannot retract by {mm:.1} mm here in its posture, or not with the demanded clearance"),
                None => format!("line {line}: the robot cannot retract by {mm:.1} mm here in its posture"),
            };
            StudyError::value(message, "a shorter --retract-mm")
        })?;
        let mut places = vec![(straight.end, self.rapid.min(straight.fastest))];
        let missing = self.space.top + self.retract - self.height(&lifted);
        if missing > BELOW {
            let up = self.arm.base_from_path.rotation * self.up * missing;
            let higher = Translation3::from(up) * lifted;
            let climbed = self.arm.straight(&places[0].0, &higher);
            places.extend(climbed.map(|straight| (straight.end, self.rapid.min(straight.fastest))));
        }
        Ok(places)
    }

    /// These poses, if the straight moves through them go across only at the top of the path or above. Those above the
    /// ends of a compensated cut are moved with it, so that the tool goes along its axis.
    fn clear(
        &self,
        from: Option<&ArmAt>,
        mut poses: Vec<Isometry>,
        to: Option<&ArmAt>,
    ) -> Option<Vec<Isometry>> {
        let above = |end: &ArmAt, pose: &Isometry| {
            let by = end.base_from_tool.inverse() * Point3::from(pose.translation.vector);
            let tip = end.base_from_tool * Point3::new(0.0, 0.0, by.z);
            (by.x.hypot(by.y) < ACROSS).then_some(tip)
        };
        let mut moved = 0;
        for pose in &mut poses {
            let Some(tip) = from.and_then(|from| above(from, pose)) else {
                break;
            };
            pose.translation.vector = tip.coords;
            moved += 1;
        }
        for pose in poses.iter_mut().skip(moved).rev() {
            let Some(tip) = to.and_then(|to| above(to, pose)) else {
                break;
            };
            pose.translation.vector = tip.coords;
        }
        // Both cuts are below the last pose, and their corrections differ: across there, not on the way down.
        if moved == poses.len()
            && let Some((mut over, to)) = poses.last().copied().zip(to)
            && self.height(&over) > self.height(&to.base_from_tool) + ACROSS
            && let Some(tip) = above(to, &over)
            && (tip.coords - over.translation.vector).norm() > SAME_PLACE
        {
            over.translation.vector = tip.coords;
            poses.push(over);
        }
        let pose = |at: Option<&ArmAt>| at.map(|at| at.base_from_tool);
        let all: Vec<Isometry> = pose(from)
            .into_iter()
            .chain(poses.iter().copied())
            .chain(pose(to))
            .collect();
        let is_clear = all.windows(2).all(|pair| {
            let by = pair[0].inverse() * Point3::from(pair[1].translation.vector);
            let across = by.x.hypot(by.y);
            across < ACROSS || self.height(&pair[0]).min(self.height(&pair[1])) >= self.space.top - BELOW
        });
        if !is_clear {
            self.left_out.set(self.left_out.get() + poses.len().max(1));
        }
        is_clear.then_some(poses)
    }

    /// Height of a pose, m.
    fn height(&self, pose: &Isometry) -> f64 {
        let tip = self.arm.base_from_path.inverse() * Point3::from(pose.translation.vector);
        tip.coords.dot(&self.up)
    }

    /// Whether the tip is at the top of the part or above.
    fn is_above(&self, at: &ArmAt) -> bool {
        self.height(&at.base_from_tool) >= self.space.top - BELOW
    }

    /// The pose above the part, along the tool axis.
    fn lifted(&self, at: &ArmAt) -> Isometry {
        let spindle = -(self.arm.base_from_path.inverse() * at.base_from_tool * Vector3::z());
        let rises = spindle.dot(&self.up);
        let needed = self.space.top + self.retract - self.height(&at.base_from_tool);
        // A tool that leans far would have to retract very far.
        let by = if rises > LEAST_RISE {
            (needed / rises).max(self.retract)
        } else {
            self.retract
        };
        at.base_from_tool * Translation3::new(0.0, 0.0, -by)
    }

    /// Number of poses up to the highest, the first of equals.
    fn highest(&self, poses: &[Isometry]) -> usize {
        let mut highest = (f64::NEG_INFINITY, 0);
        for (index, pose) in poses.iter().enumerate() {
            let height = self.height(pose);
            if height > highest.0 + BELOW {
                highest = (height, index + 1);
            }
        }
        highest.1
    }
}

/// Least rise of the tool axis per length along which the tool retracts to the top of the part.
const LEAST_RISE: f64 = 0.2;

fn same_joints(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < SAME_JOINTS)
}

fn is_same(a: &ArmAt, b: &ArmAt) -> bool {
    same_joints(&a.joints, &b.joints)
}

//! Every posture of a few tool poses under one load: what a search along a path chooses from.
//!
//! `d = sqrt((a . delta)^2 + (b . delta)^2)`, the largest over the load cases.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | deviation that counts | m |
//! | `a`, `b` | directions that it counts along, base ([`Push::along`]) | - |
//! | `delta` | elastic deviation of the tip and what gravity adds ([`crate::predict`]); [by itself](Columns::by_themselves) all that moves it | m |
//!
//! A column is made for the poses of one point of a path with the tool turned about its axis: all feel the same forces.
//! Ortho-parallel arms that yield at their drives alone go through lanes, a block of turns at once; any other arm takes
//! one pose after the other. Both tell the same to rounding (`tests`).

use nalgebra::Vector3;

use super::AT_LIMIT;
use super::lanes::{Backend, Batch, POINTS, flag};
use super::question::Question;
use crate::frame::Isometry;
use crate::predict::deviation_of;
use crate::robot::forward::{Frames, forward_into, joint_axis};
use crate::robot::inverse::{Finder, Found, Wanted};
use crate::robot::{Branch, Joint, PostureName, Robot, Singularity};
use crate::source::{Arm, Links, ArmState};
use crate::spatial::{Twist, Wrench};

/// Postures a pose has room for; arms without names of branches keep the first so many that are found.
pub const SLOTS: usize = 8;

/// What pushes, and what of the deviation counts.
#[derive(Clone, Copy, Debug)]
pub struct Push<'a> {
    /// Wrenches on the tool at the TCP, base; at least one.
    pub cases: &'a [Wrench],
    /// Directions that the deviation counts along, base; of length 1, or 0 where one is enough.
    pub along: [Vector3<f64>; 2],
}

/// Whether a posture may stand for a pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stand {
    /// Inside its limits, away from singularities.
    Holds,
    /// A joint is outside its limits.
    OutsideLimits,
    /// Joints 4 and 6 are nearer to one line than asked, or the arm near another singularity.
    Singular,
    /// The arm gives way without bound under the load.
    Unstable,
    /// The pose is out of reach in this posture.
    #[default]
    OutOfReach,
}

impl Stand {
    /// Every one, what holds first.
    pub const ALL: [Stand; 5] = [
        Stand::Holds,
        Stand::OutsideLimits,
        Stand::Singular,
        Stand::Unstable,
        Stand::OutOfReach,
    ];

    /// Its word in results.
    pub fn word(self) -> &'static str {
        match self {
            Stand::Holds => "holds",
            Stand::OutsideLimits => "outside_joint_limits",
            Stand::Singular => "singular",
            Stand::Unstable => "unstable",
            Stand::OutOfReach => "out_of_reach",
        }
    }
}

/// The postures of some poses: [`SLOTS`] a pose, pose after pose.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Whether each may stand.
    pub stands: Vec<Stand>,
    /// Deviation that counts, m; infinite where it does not stand.
    pub deviations: Vec<f64>,
    /// Joint positions, rad (m of a sliding joint), as many as the robot has; what stands there where nothing holds is of
    /// no meaning.
    pub joints: Vec<f64>,
}

impl Column {
    /// Joint positions of posture `slot`, counted through all poses, of an arm with so many joints.
    pub fn joints_of(&self, slot: usize, joint_count: usize) -> &[f64] {
        &self.joints[slot * joint_count..][..joint_count]
    }

    /// Lets posture `slot` stand at no pose.
    pub(crate) fn forbid(&mut self, slot: usize) {
        for at in (slot..self.stands.len()).step_by(SLOTS) {
            self.stands[at] = Stand::OutOfReach;
            self.deviations[at] = f64::INFINITY;
        }
    }

    fn clear(&mut self, poses: usize, joint_count: usize) {
        self.stands.clear();
        self.stands.resize(poses * SLOTS, Stand::OutOfReach);
        self.deviations.clear();
        self.deviations.resize(poses * SLOTS, f64::INFINITY);
        self.joints.resize(poses * SLOTS * joint_count, 0.0);
    }
}

/// Makes columns; one a thread.
pub struct Columns<'q> {
    keeping: Keeping<'q>,
    way: Way<'q>,
}

/// The arm, and how far it keeps from where it may not stand.
#[derive(Clone, Copy)]
struct Keeping<'q> {
    arm: Arm<'q>,
    home: Option<&'q [f64]>,
    /// Least bend of the wrist, rad.
    wrist: f64,
    /// Least distance of every joint that turns from its limits, and of the elbow from stretched, rad.
    margin: f64,
}

/// By lanes or one after the other.
enum Way<'q> {
    Lanes(Box<Batch<f64>>),
    General(Box<OneByOne<'q>>),
}

impl<'q> Columns<'q> {
    /// For this arm; a wrist bent by less than `wrist` (rad) from the line counts as singular, as does what a posture is
    /// flagged with.
    ///
    /// `home`: see [`Question::home`].
    pub fn new(arm: Arm<'q>, home: Option<&'q [f64]>, wrist: f64) -> Columns<'q> {
        let question = Question::unloaded(arm, home);
        let lanes = arm.robot.ortho_parallel().filter(|_| arm.model.is_drives_alone());
        match lanes {
            Some(form) => Columns {
                keeping: Keeping {
                    arm,
                    home,
                    wrist,
                    margin: 0.0,
                },
                way: Way::Lanes(Box::new(Batch::new(&question, form, Backend::fastest()))),
            },
            None => Columns::one_by_one(arm, home, [wrist, 0.0]),
        }
    }

    /// [`Columns::new`] for points that no path joins: backlash and geometry count as [`super::evaluate`] has them.
    pub fn by_themselves(arm: Arm<'q>, home: Option<&'q [f64]>, wrist: f64) -> Columns<'q> {
        if !arm.model.moves_unloaded() {
            return Columns::new(arm, home, wrist);
        }
        let mut columns = Columns::one_by_one(arm, home, [wrist, 0.0]);
        if let Way::General(one_by_one) = &mut columns.way {
            one_by_one.placement = Some(vec![0.0; arm.robot.joints().len()]);
        }
        columns
    }

    /// [`Columns::new`] for any arm, one pose after the other; every joint also stays `margin` (rad) away from its limits, and
    /// of an ortho-parallel arm the elbow so far from stretched and folded.
    pub(super) fn one_by_one(
        arm: Arm<'q>,
        home: Option<&'q [f64]>,
        [wrist, margin]: [f64; 2],
    ) -> Columns<'q> {
        Columns {
            keeping: Keeping {
                arm,
                home,
                wrist,
                margin,
            },
            way: Way::General(Box::new(OneByOne {
                finder: Finder::new(arm.robot),
                frames: Frames::for_robot(arm.robot),
                arm_state: ArmState::new(arm),
                tool_from_flange: arm.flange_from_tool.inverse(),
                rail: None,
                placement: None,
            })),
        }
    }

    /// Lets the first joint that slides stand at `at` (m) from here on; where the question says if that is `None`. Lanes have no
    /// rail.
    pub(super) fn stand_rail(&mut self, at: Option<f64>) {
        let Way::General(one_by_one) = &mut self.way else {
            return;
        };
        let robot = self.keeping.arm.robot;
        let rail = (0..robot.joints().len()).find(|joint| robot.slides(*joint));
        one_by_one.rail = at.zip(rail).map(|(at, rail)| {
            let middle = |joint: &Joint| joint.limits.map_or(0.0, |limits| limits.middle());
            let mut home = match self.keeping.home {
                Some(home) => home.to_vec(),
                None => robot.joints().iter().map(middle).collect(),
            };
            home[rail] = at;
            home
        });
    }

    /// Whether slots are branches, in the order of [`Branch::ALL`]; otherwise they are the postures that were found, of one
    /// pose in another order than of the next.
    pub fn slots_are_branches(&self) -> bool {
        self.keeping.arm.robot.inverse().has_branches()
    }

    /// Fills `out` with the postures of these poses under `push`.
    pub fn fill(&mut self, poses: &[Isometry], push: &Push<'_>, out: &mut Column) {
        let joint_count = self.keeping.arm.robot.joints().len();
        out.clear(poses.len(), joint_count);
        match &mut self.way {
            Way::Lanes(batch) => {
                batch.push(push.cases, &push.along);
                let least = self.keeping.wrist.sin().powi(2);
                for (block, poses) in poses.chunks(POINTS).enumerate() {
                    let first = block * POINTS;
                    batch.each_posture(poses, |four, of| {
                        for i in 0..poses.len() {
                            for flip in 0..2 {
                                let slot = (first + i) * SLOTS + 2 * four + flip;
                                out.stands[slot] = stand(of.flags[flip][i] as u32, of.bend2[i], least);
                                if out.stands[slot] == Stand::Holds {
                                    out.deviations[slot] = of.deviation[i];
                                }
                                for (joint, plane) in
                                    out.joints[slot * 6..][..6].iter_mut().zip(&of.joints[flip])
                                {
                                    *joint = plane[i];
                                }
                            }
                        }
                    });
                }
            }
            Way::General(one_by_one) => {
                for (i, pose) in poses.iter().enumerate() {
                    one_by_one.pose(&self.keeping, pose, push, (i, out));
                }
            }
        }
    }
}

/// What the flags of lanes say, where the squared sine of the wrist's bend must not be below `least`.
fn stand(flags: u32, bend2: f64, least: f64) -> Stand {
    let near = flag::WRIST_UNDECIDED | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;
    if flags & flag::UNREACHABLE != 0 {
        Stand::OutOfReach
    } else if flags & flag::OUTSIDE_LIMITS != 0 {
        Stand::OutsideLimits
    } else if flags & near != 0 || bend2 < least {
        Stand::Singular
    } else {
        Stand::Holds
    }
}

/// Room for one pose after the other.
struct OneByOne<'q> {
    finder: Finder<'q>,
    frames: Frames,
    arm_state: ArmState<'q>,
    tool_from_flange: Isometry,
    /// Joint positions at home, with the rail where it was told to stand; `None` where the question says.
    rail: Option<Vec<f64>>,
    /// Where links lie in their gaps, rad (m); `None` where only the load counts.
    placement: Option<Vec<f64>>,
}

impl OneByOne<'_> {
    fn pose(
        &mut self,
        keeping: &Keeping<'_>,
        pose: &Isometry,
        push: &Push<'_>,
        (index, out): (usize, &mut Column),
    ) {
        let arm = keeping.arm;
        let requested = Wanted {
            base_from_flange: pose * self.tool_from_flange,
            near: None,
            home: self.rail.as_deref().or(keeping.home),
        };
        // What was found at the pose before is no guide: columns may come in any order.
        self.finder.forget();
        let Ok(found) = self.finder.all(&requested) else {
            return;
        };
        let named = arm.robot.inverse().has_branches();
        for (order, one) in found.iter().enumerate() {
            let slot = match one.name {
                PostureName::Branch(branch) if named => Branch::ALL.iter().position(|other| *other == branch),
                _ => (order < SLOTS).then_some(order),
            };
            let Some(slot) = slot.map(|slot| index * SLOTS + slot) else {
                continue;
            };
            let joint_count = one.joints.len();
            out.joints[slot * joint_count..][..joint_count].copy_from_slice(&one.joints);
            let stand = if !keeping.inside_limits(&one.joints) {
                Stand::OutsideLimits
            } else {
                forward_into(arm.robot, &one.joints, &mut self.frames);
                let tcp = pose.translation.vector.into();
                self.arm_state.set_frames(&one.joints, &self.frames, &tcp);
                let wrist = keeping.wrist.max(keeping.margin);
                if is_singular(named, one, (self.arm_state.screws(), wrist))
                    || elbow_bend(arm.robot, &self.frames) < keeping.margin.sin()
                {
                    Stand::Singular
                } else {
                    Stand::Holds
                }
            };
            out.stands[slot] = stand;
            if stand != Stand::Holds {
                continue;
            }
            let mut most = 0.0_f64;
            for wrench in push.cases {
                let mut links = match &mut self.placement {
                    None => Links::Neglected,
                    Some(placement) => Links::Farthest(push.along, placement),
                };
                match deviation_of(&mut self.arm_state, wrench, &mut links) {
                    Ok(twist) => {
                        let [a, b] = push.along.map(|along| along.dot(&twist.linear));
                        most = most.max(a.hypot(b));
                    }
                    Err(_) => most = f64::INFINITY,
                }
            }
            out.deviations[slot] = most;
            if most.is_infinite() {
                out.stands[slot] = Stand::Unstable;
            }
        }
    }
}

/// Whether a posture is nearer to a singularity than asked: of an arm with named branches by the angle between axes 4 and
/// 6, of others by what it is flagged with.
fn is_singular(named: bool, found: &Found, (screws, wrist): (&[Twist], f64)) -> bool {
    match (found.singularity, screws) {
        (Some(Singularity::Elbow | Singularity::Shoulder), _) => true,
        (_, [_, _, _, fourth, _, sixth]) if named => {
            fourth.angular.cross(&sixth.angular).norm() < wrist.sin()
        }
        (singularity, _) => singularity.is_some(),
    }
}

impl Keeping<'_> {
    /// Whether every joint is inside its limits, and every one that turns so far inside as asked.
    fn inside_limits(&self, joints: &[f64]) -> bool {
        let robot = self.arm.robot;
        robot.joints().iter().enumerate().all(|(index, joint)| {
            let margin = if robot.slides(index) { 0.0 } else { self.margin };
            joint
                .limits
                .is_none_or(|limits| limits.margin(joints[index]) >= margin - AT_LIMIT)
        })
    }
}

/// Sine of the angle between upper arm and forearm of an ortho-parallel arm that stands so; 1 of others.
fn elbow_bend(robot: &Robot, frames: &Frames) -> f64 {
    let Some(form) = robot.ortho_parallel() else {
        return 1.0;
    };
    let axis = joint_axis(robot, frames, 1);
    let [shoulder, elbow] = [1, 2].map(|joint| frames.origin(joint));
    let wrist = frames.base_from_flange * form.flange_from_wrist;
    let across = |v: Vector3<f64>| v - axis * axis.dot(&v);
    let (upper, fore) = (across(elbow - shoulder), across(wrist - elbow));
    upper.cross(&fore).norm() / (upper.norm() * fore.norm())
}

#[cfg(test)]
mod tests;

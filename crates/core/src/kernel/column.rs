//! Every posture of a few tool poses under one load: what a search along a path chooses from.
//!
//! `d = sqrt((a . delta)^2 + (b . delta)^2)`, the largest over the load cases.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | selected component of the deviation | m |
//! | `a`, `b` | directions of this component, base ([`ColumnLoad::along`]) | - |
//! | `delta` | elastic deviation of the tip, with gravity ([`crate::predict`]); [at single points](Columns::at_single_points) with backlash and geometry | m |
//!
//! A column contains the poses of one point of a path with the tool turned about its axis: all have the same forces.
//! Arms with named branches go through lanes, a block of turns at once: ortho-parallel ones whose only springs are the
//! drives without any angle, the others by the whole model (`whole_columns`). Any other arm is computed one pose after
//! the other. All agree to rounding (`tests`).

mod whole_columns;

use nalgebra::Vector3;

use super::AT_LIMIT;
use super::lanes::{Backend, Batch, POINTS, flag};
use super::question::Question;
use crate::frame::Isometry;
use crate::predict::deviation_of;
use crate::robot::forward::{Frames, forward_into, joint_axis};
use crate::robot::inverse::{Finder, InverseSolution, InverseTarget};
use crate::robot::{Branch, Joint, PostureName, Robot, Singularity};
use crate::source::{Arm, ArmState, Links};
use crate::spatial::{Twist, Wrench};
use whole_columns::WholeColumns;

/// Number of postures stored for a pose. Of arms without branch names, the first postures found are stored.
pub const SLOTS: usize = 8;

/// The load, and the component of the deviation.
#[derive(Clone, Copy, Debug)]
pub struct ColumnLoad<'a> {
    /// Wrenches on the tool at the TCP, base; at least one.
    pub cases: &'a [Wrench],
    /// Directions of the component of the deviation, base; of length 1, or 0 where one is enough.
    pub along: [Vector3<f64>; 2],
}

/// Whether a posture can be used at a pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum PostureStatus {
    /// Inside its limits, away from singularities.
    Usable,
    /// A joint is outside its limits.
    OutsideLimits,
    /// The angle between axes 4 and 6 is below the limit, or the arm is near another singularity.
    Singular,
    /// The arm has no stable equilibrium under the load.
    Unstable,
    /// The pose is out of reach in this posture.
    #[default]
    OutOfReach,
}

impl PostureStatus {
    /// All, the usable one first.
    pub const ALL: [PostureStatus; 5] = [
        PostureStatus::Usable,
        PostureStatus::OutsideLimits,
        PostureStatus::Singular,
        PostureStatus::Unstable,
        PostureStatus::OutOfReach,
    ];

    /// Name in results.
    pub fn word(self) -> &'static str {
        match self {
            PostureStatus::Usable => "usable",
            PostureStatus::OutsideLimits => "outside_joint_limits",
            PostureStatus::Singular => "singular",
            PostureStatus::Unstable => "unstable",
            PostureStatus::OutOfReach => "out_of_reach",
        }
    }
}

/// The postures of some poses: [`SLOTS`] per pose, pose after pose.
#[derive(Clone, Debug, Default)]
pub struct Column {
    /// Whether each posture can be used.
    pub statuses: Vec<PostureStatus>,
    /// Selected component of the deviation, m; infinite where the posture cannot be used.
    pub deviations: Vec<f64>,
    /// Joint positions, rad (m of a prismatic joint), as many as the robot has. Not defined where no posture was found.
    pub joints: Vec<f64>,
}

impl Column {
    /// Joint positions of posture `slot`, with slots numbered through all poses, of an arm with this number of joints.
    pub fn joints_of(&self, slot: usize, joint_count: usize) -> &[f64] {
        &self.joints[slot * joint_count..][..joint_count]
    }

    /// The slots of pose `index`, of an arm with this number of joints.
    fn slots_of(&mut self, index: usize, joint_count: usize) -> Slots<'_> {
        let first = index * SLOTS;
        Slots {
            statuses: &mut self.statuses[first..][..SLOTS],
            deviations: &mut self.deviations[first..][..SLOTS],
            joints: &mut self.joints[first * joint_count..][..SLOTS * joint_count],
        }
    }

    /// Excludes posture `slot` at every pose.
    pub(crate) fn forbid(&mut self, slot: usize) {
        for at in (slot..self.statuses.len()).step_by(SLOTS) {
            self.statuses[at] = PostureStatus::OutOfReach;
            self.deviations[at] = f64::INFINITY;
        }
    }

    fn clear(&mut self, poses: usize, joint_count: usize) {
        self.statuses.clear();
        self.statuses.resize(poses * SLOTS, PostureStatus::OutOfReach);
        self.deviations.clear();
        self.deviations.resize(poses * SLOTS, f64::INFINITY);
        self.joints.resize(poses * SLOTS * joint_count, 0.0);
    }
}

/// The postures of one pose: parts of a [`Column`].
struct Slots<'a> {
    statuses: &'a mut [PostureStatus],
    deviations: &'a mut [f64],
    joints: &'a mut [f64],
}

impl Slots<'_> {
    fn clear(&mut self) {
        self.statuses.fill(PostureStatus::OutOfReach);
        self.deviations.fill(f64::INFINITY);
    }
}

/// Computes columns; one per thread.
pub struct Columns<'q> {
    margins: ArmMargins<'q>,
    method: ColumnMethod<'q>,
}

/// The arm, and the margins to limits and singularities.
#[derive(Clone, Copy)]
struct ArmMargins<'q> {
    arm: Arm<'q>,
    home: Option<&'q [f64]>,
    /// Smallest bend of the wrist, rad.
    wrist: f64,
    /// Smallest distance of every revolute joint from its limits, and of the elbow from stretched, rad.
    margin: f64,
}

/// By lanes or one after the other.
enum ColumnMethod<'q> {
    Lanes(Box<Batch<f64>>),
    Whole(Box<WholeColumns>, Box<OneByOne<'q>>),
    General(Box<OneByOne<'q>>),
}

impl<'q> Columns<'q> {
    /// For this arm. A wrist with a bend below `wrist` (rad) is singular, as is a posture that the inverse kinematics
    /// flags as singular.
    ///
    /// `home`: see [`Question::home`].
    pub fn new(arm: Arm<'q>, home: Option<&'q [f64]>, wrist: f64) -> Columns<'q> {
        let question = Question::unloaded(arm, home);
        let lanes = arm.robot.ortho_parallel().filter(|_| arm.model.is_drives_alone());
        match lanes {
            Some(form) => Columns {
                margins: ArmMargins {
                    arm,
                    home,
                    wrist,
                    margin: 0.0,
                },
                method: ColumnMethod::Lanes(Box::new(Batch::new(&question, form, Backend::fastest()))),
            },
            None => Columns::whole(arm, home, [wrist, 0.0]),
        }
    }

    /// [`Columns::new`] by the whole model, with the margins of [`Columns::one_by_one`].
    pub(super) fn whole(arm: Arm<'q>, home: Option<&'q [f64]>, margins: [f64; 2]) -> Columns<'q> {
        Columns::one_by_one(arm, home, margins).in_lanes(false)
    }

    /// In lanes, if these know the arm.
    fn in_lanes(self, unloaded: bool) -> Columns<'q> {
        let Columns { margins, method } = self;
        let method = match (method, WholeColumns::of(&margins, unloaded)) {
            (ColumnMethod::General(rest), Some(lanes)) => ColumnMethod::Whole(Box::new(lanes), rest),
            (method, _) => method,
        };
        Columns { margins, method }
    }

    /// [`Columns::new`] for points that are not on a path: backlash and geometry are included as in
    /// [`super::evaluate`].
    pub fn at_single_points(arm: Arm<'q>, home: Option<&'q [f64]>, wrist: f64) -> Columns<'q> {
        if !arm.model.has_unloaded_deviation() {
            return Columns::new(arm, home, wrist);
        }
        let mut columns = Columns::one_by_one(arm, home, [wrist, 0.0]);
        if let ColumnMethod::General(one_by_one) = &mut columns.method {
            one_by_one.link_offsets = Some(vec![0.0; arm.robot.joints().len()]);
        }
        columns.in_lanes(true)
    }

    /// [`Columns::new`] for any arm, one pose after the other. Every joint also keeps `margin` (rad) from its limits,
    /// and the elbow of an ortho-parallel arm the same margin from stretched and folded.
    pub(super) fn one_by_one(
        arm: Arm<'q>,
        home: Option<&'q [f64]>,
        [wrist, margin]: [f64; 2],
    ) -> Columns<'q> {
        Columns {
            margins: ArmMargins {
                arm,
                home,
                wrist,
                margin,
            },
            method: ColumnMethod::General(Box::new(OneByOne {
                finder: Finder::new(arm.robot),
                frames: Frames::for_robot(arm.robot),
                arm_state: ArmState::new(arm),
                tool_from_flange: arm.flange_from_tool.inverse(),
                rail: None,
                link_offsets: None,
            })),
        }
    }

    /// Fixes the first prismatic joint at `at` (m) from here on; `None`: where the question specifies it. Lanes have no
    /// rail.
    pub(super) fn set_rail(&mut self, at: Option<f64>) {
        let ColumnMethod::General(one_by_one) = &mut self.method else {
            return;
        };
        let robot = self.margins.arm.robot;
        let rail = (0..robot.joints().len()).find(|joint| robot.slides(*joint));
        one_by_one.rail = at.zip(rail).map(|(at, rail)| {
            let middle = |joint: &Joint| joint.limits.map_or(0.0, |limits| limits.middle());
            let mut home = match self.margins.home {
                Some(home) => home.to_vec(),
                None => robot.joints().iter().map(middle).collect(),
            };
            home[rail] = at;
            home
        });
    }

    /// Whether slots are branches, in the order of [`Branch::ALL`]; otherwise they are the postures found, in an order
    /// that differs from pose to pose.
    pub fn slots_are_branches(&self) -> bool {
        self.margins.arm.robot.inverse().has_branches()
    }

    /// Fills `out` with the postures of these poses under `push`.
    pub fn fill(&mut self, poses: &[Isometry], push: &ColumnLoad<'_>, out: &mut Column) {
        let joint_count = self.margins.arm.robot.joints().len();
        out.clear(poses.len(), joint_count);
        match &mut self.method {
            ColumnMethod::Lanes(batch) => {
                batch.push(push.cases, &push.along);
                let least = self.margins.wrist.sin().powi(2);
                for (block, poses) in poses.chunks(POINTS).enumerate() {
                    let first = block * POINTS;
                    batch.each_posture(poses, |four, of| {
                        for i in 0..poses.len() {
                            for flip in 0..2 {
                                let slot = (first + i) * SLOTS + 2 * four + flip;
                                out.statuses[slot] = status_of(of.flags[flip][i] as u32, of.bend2[i], least);
                                if out.statuses[slot] == PostureStatus::Usable {
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
            ColumnMethod::Whole(lanes, rest) => lanes.fill(&self.margins, poses, push, rest, out),
            ColumnMethod::General(one_by_one) => {
                for (i, pose) in poses.iter().enumerate() {
                    one_by_one.pose(&self.margins, pose, push, out.slots_of(i, joint_count));
                }
            }
        }
    }
}

/// Status from the flags of the lanes; the squared sine of the wrist's bend must be at least `least`.
fn status_of(flags: u32, bend2: f64, least: f64) -> PostureStatus {
    let near = flag::WRIST_UNDECIDED | flag::NEAR_ELBOW | flag::NEAR_SHOULDER;
    if flags & flag::UNREACHABLE != 0 {
        PostureStatus::OutOfReach
    } else if flags & flag::OUTSIDE_LIMITS != 0 {
        PostureStatus::OutsideLimits
    } else if flags & near != 0 || bend2 < least {
        PostureStatus::Singular
    } else {
        PostureStatus::Usable
    }
}

/// Buffers for one pose after the other.
struct OneByOne<'q> {
    finder: Finder<'q>,
    frames: Frames,
    arm_state: ArmState<'q>,
    tool_from_flange: Isometry,
    /// Joint positions at home, with the rail where it was fixed; `None` where the question specifies it.
    rail: Option<Vec<f64>>,
    /// Link offsets in the backlash, rad (m); `None` where only the load is included.
    link_offsets: Option<Vec<f64>>,
}

impl OneByOne<'_> {
    fn pose(&mut self, margins: &ArmMargins<'_>, pose: &Isometry, push: &ColumnLoad<'_>, out: Slots<'_>) {
        let arm = margins.arm;
        let requested = InverseTarget {
            base_from_flange: pose * self.tool_from_flange,
            near: None,
            home: self.rail.as_deref().or(margins.home),
        };
        // The result at the pose before is not a start value: columns may come in any order.
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
            // Of two postures with one name, which a calibrated arm may have near a singularity, the first is stored.
            let free = |slot: &usize| out.statuses[*slot] == PostureStatus::OutOfReach;
            let Some(slot) = slot.filter(free) else {
                continue;
            };
            let joint_count = one.joints.len();
            out.joints[slot * joint_count..][..joint_count].copy_from_slice(&one.joints);
            let status = if !margins.inside_limits(&one.joints) {
                PostureStatus::OutsideLimits
            } else {
                forward_into(arm.robot, &one.joints, &mut self.frames);
                let tcp = pose.translation.vector.into();
                self.arm_state.set_frames(&one.joints, &self.frames, &tcp);
                let wrist = margins.wrist.max(margins.margin);
                if is_singular(named, one, self.arm_state.screws(), wrist)
                    || elbow_bend(arm.robot, &self.frames) < margins.margin.sin()
                {
                    PostureStatus::Singular
                } else {
                    PostureStatus::Usable
                }
            };
            out.statuses[slot] = status;
            if status != PostureStatus::Usable {
                continue;
            }
            let mut most = 0.0_f64;
            for wrench in push.cases {
                let mut links = match &mut self.link_offsets {
                    None => Links::Neglected,
                    Some(link_offsets) => Links::Farthest(push.along, link_offsets),
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
                out.statuses[slot] = PostureStatus::Unstable;
            }
        }
    }
}

/// Whether a posture is nearer to a singularity than allowed: of an arm with branch names by the angle between axes 4
/// and 6, of others by its flag.
fn is_singular(named: bool, found: &InverseSolution, screws: &[Twist], wrist: f64) -> bool {
    match (found.singularity, screws) {
        (Some(Singularity::Elbow | Singularity::Shoulder), _) => true,
        (_, [_, _, _, fourth, _, sixth, ..]) if named => {
            fourth.angular.cross(&sixth.angular).norm() < wrist.sin()
        }
        (singularity, _) => singularity.is_some(),
    }
}

impl ArmMargins<'_> {
    /// Whether every joint is inside its limits, and every revolute joint by at least the margin.
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

/// Sine of the angle between upper arm and forearm of an ortho-parallel arm in this posture; 1 for others.
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

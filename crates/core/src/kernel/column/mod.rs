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
//!
//! `postures`: a column; `one_by_one` and `whole_columns` fill it.

mod one_by_one;
mod postures;
mod whole_columns;

pub use postures::{Column, ColumnLoad, PostureStatus, SLOTS};

use super::lanes::{Backend, Batch, POINTS, flag};
use super::question::Question;
use crate::clearance::ClearanceCheck;
use crate::frame::Isometry;
use crate::robot::Robot;
use crate::robot::forward::Frames;
use crate::robot::inverse::Finder;
use crate::source::{Arm, ArmState};
use one_by_one::{ArmMargins, OneByOne};
use whole_columns::{WholeColumns, WholeFill};

/// Computes columns; one per thread.
pub struct Columns<'q> {
    margins: ArmMargins<'q>,
    method: ColumnMethod<'q>,
    clearance: Option<ClearanceCheck<'q>>,
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
                clearance: None,
            },
            None => Columns::whole(arm, home, [wrist, 0.0]),
        }
    }

    /// [`Columns::new`] by the whole model, with the margins of [`Columns::one_by_one`].
    pub(super) fn whole(arm: Arm<'q>, home: Option<&'q [f64]>, margins: [f64; 2]) -> Columns<'q> {
        Columns::one_by_one(arm, home, margins).in_lanes(false)
    }

    /// Moves the part that is checked for.
    pub(crate) fn set_part(&mut self, base_from_part: &Isometry) {
        if let Some(clearance) = &mut self.clearance {
            clearance.set_part(base_from_part);
        }
    }

    /// In lanes, if these know the arm.
    fn in_lanes(self, unloaded: bool) -> Columns<'q> {
        let Columns {
            margins,
            method,
            clearance,
        } = self;
        let method = match (method, WholeColumns::of(&margins, unloaded)) {
            (ColumnMethod::General(rest), Some(lanes)) => ColumnMethod::Whole(Box::new(lanes), rest),
            (method, _) => method,
        };
        Columns {
            margins,
            method,
            clearance,
        }
    }

    /// Without the postures that do not pass this check.
    pub(crate) fn keeping_clear(self, clearance: Option<ClearanceCheck<'q>>) -> Columns<'q> {
        Columns { clearance, ..self }
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
                home: None,
                link_offsets: None,
            })),
            clearance: None,
        }
    }

    /// Fixes the first prismatic joint at `at` (m) from here on; `None`: where the question specifies it. The arms of the
    /// drives-only lanes have none.
    pub(crate) fn set_rail(&mut self, at: Option<f64>) {
        let robot = self.margins.arm.robot;
        let rail = (0..robot.joints().len()).find(|joint| robot.slides(*joint));
        self.set_home(at.zip(rail).map(|(at, rail)| {
            let mut home = robot.home(self.margins.home);
            home[rail] = at;
            home
        }));
    }

    /// Home positions, rad (m), one per joint, from here on; `None`: those of the question. The arms of the drives-only
    /// lanes have none that matter.
    pub(crate) fn set_home(&mut self, home: Option<Vec<f64>>) {
        let (ColumnMethod::General(rest) | ColumnMethod::Whole(_, rest)) = &mut self.method else {
            return;
        };
        rest.home = home;
        if let ColumnMethod::Whole(lanes, rest) = &mut self.method {
            lanes.set_home(rest.home.as_deref().or(self.margins.home));
        }
    }

    /// Joint positions at home, rad (m), as they were fixed.
    pub(crate) fn home(&self) -> Option<&[f64]> {
        match &self.method {
            ColumnMethod::General(rest) | ColumnMethod::Whole(_, rest) => {
                rest.home.as_deref().or(self.margins.home)
            }
            ColumnMethod::Lanes(_) => self.margins.home,
        }
    }

    /// Whether slots are branches, in the order of [`Branch::ALL`](crate::robot::Branch::ALL); otherwise they are the
    /// postures found, in an order that differs from pose to pose.
    pub fn slots_are_branches(&self) -> bool {
        self.margins.arm.robot.inverse().has_branches()
    }

    /// The joint positions where external axes stand unless they are moved, rad (m).
    pub(crate) fn home_of_question(&self) -> Option<&'q [f64]> {
        self.margins.home
    }

    /// The robot of the arm.
    pub(crate) fn robot(&self) -> &'q Robot {
        self.margins.arm.robot
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
            ColumnMethod::Whole(lanes, rest) => {
                let margins = &self.margins;
                lanes.fill(poses, push, WholeFill { margins, rest }, out);
            }
            ColumnMethod::General(one_by_one) => {
                for (i, pose) in poses.iter().enumerate() {
                    one_by_one.pose(&self.margins, pose, push, out.slots_of(i, joint_count));
                }
            }
        }
        if let Some(clearance) = &mut self.clearance {
            out.keep_clear(clearance, joint_count);
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

#[cfg(test)]
mod tests;

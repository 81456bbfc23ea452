//! Rows of the other inverse kinematics of armill: the same map, the same postures, other arms.
//!
//! | arm | inverse |
//! |---|---|
//! | MH12 with its axes 2 and 5 a micrometre aside | polished: from the closed form, then Newton's iteration |
//! | MH12 with axis 5 30 mm off axis 4 | searched; along the rows of a map from the point before |
//! | UR10 | closed form, three parallel axes |
//! | iiwa 14 | closed form, joint 3 fixed |
//!
//! One thread. Maps of 61 x 61 points under four forces, 7 x 7 where all postures are searched for; an unreachable
//! point is included.

use std::hint::black_box;

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, PosturesAt, Question, postures_at};
use armill_core::load::InputUncertainty;
use armill_core::map::{PlaneMap, plane_map};
use armill_core::nalgebra::{Point3, Unit};
use armill_core::robot::inverse::{Inverse, posture_at};
use armill_core::robot::{Amount, Axis, BranchPattern, Joint, JointCompliance, Limits, Motion, Robot};
use armill_core::source::StiffnessModel;
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_core::workpiece::{Grid, Plane};
use rayon::ThreadPool;

use crate::armill::Arm;
use crate::clock::Candidate;
use crate::work::IK8;
use crate::workload::{FORCES, NORMAL, TOOL};

/// How many poses are taken at once.
const POSES: usize = 4000;
/// The same where postures are searched for: that takes a tenth of a second.
const POSES_SEARCHED: usize = 10;
/// Pitch of a map, m.
pub const STEP: f64 = 0.005;
/// The same where all postures are searched for at every point, m.
const STEP_SEARCHED: f64 = 0.05;

/// An arm of another kind, and the middle of its map.
pub struct Other {
    who: &'static str,
    robot: Robot,
    plane: Plane,
    tool: Isometry,
    cases: Vec<Wrench>,
    poses: Vec<Isometry>,
}

/// All arms of the table above.
pub fn others() -> Vec<Other> {
    vec![
        Other::calibrated(),
        Other::open_wrist(),
        Other::ur10(),
        Other::iiwa(),
    ]
}

/// Their rows.
pub fn candidates<'a>(others: &'a [Other], one_thread: &'a ThreadPool) -> Vec<Candidate<'a>> {
    others
        .iter()
        .flat_map(|other| other.candidates(one_thread))
        .collect()
}

impl Other {
    /// The MH12 a micrometre off.
    pub fn calibrated() -> Other {
        let robot = moved(Arm::mh12().robot(), [1e-6, 1e-6]);
        Other::new("armill, MH12 a micrometre off", robot, [1.0, 0.8])
    }

    /// The MH12 with an open wrist.
    pub fn open_wrist() -> Other {
        let robot = moved(Arm::mh12().robot(), [0.0, 0.03]);
        Other::new("armill, MH12 with an open wrist", robot, [1.0, 0.8])
    }

    /// The UR10.
    pub fn ur10() -> Other {
        Other::new("armill, UR10", of_rows("ur10", &UR10), [0.7, 0.5])
    }

    /// The iiwa 14.
    pub fn iiwa() -> Other {
        Other::new("armill, iiwa 14", of_rows("iiwa14", &IIWA14), [0.45, 0.6])
    }

    /// The middle of its map is at x and z, m.
    fn new(who: &'static str, robot: Robot, [x, z]: [f64; 2]) -> Other {
        let compliance = vec![
            JointCompliance {
                value: 1e-6,
                standard_uncertainty: 0.0,
            };
            robot.joints().len()
        ];
        let tool = Isometry::translation(0.0, 0.0, TOOL);
        let robot = robot.with_compliance(compliance).expect("one a joint");
        // A step of the golden angle a joint: nothing repeats.
        let pose = |k: usize| {
            let q: Vec<f64> = (0..robot.joints().len())
                .map(|i| ((k + 1) as f64 * 2.399_963 * (i as f64 + 1.0)).sin())
                .collect();
            posture_at(&robot, &q, &tool).base_from_tool
        };
        Other {
            who,
            poses: (0..if searched(&robot) { POSES_SEARCHED } else { POSES })
                .map(pose)
                .collect(),
            robot,
            plane: Plane::tilted(Point3::new(x, 0.0, z), 0.0),
            tool,
            cases: FORCES.map(|force| Wrench::from_force(force.into())).to_vec(),
        }
    }

    /// Number of its poses.
    pub fn count(&self) -> usize {
        self.poses.len()
    }

    /// Every posture of its poses.
    pub fn postures(&self) -> Option<PosturesAt> {
        let tool_from_flange = self.tool.inverse();
        let flange = |i: usize| self.poses[i] * tool_from_flange;
        postures_at(&self.robot, self.poses.len(), flange, None, Watch::NONE).ok()
    }

    /// Its map on this grid.
    pub fn map(&self, choice: BranchChoice, grid: Grid) -> Option<PlaneMap> {
        let question = Question {
            arm: armill_core::source::Arm {
                robot: &self.robot,
                compliance: self.robot.compliance().unwrap_or_default(),
                model: StiffnessModel::DRIVES,
                flange_from_tool: &self.tool,
            },
            home: None,
            homes: None,
            cases: &self.cases,
            normal: Unit::new_unchecked(NORMAL.into()),
            choice,
            clearance: None,
            uncertainty: InputUncertainty::NONE,
        };
        plane_map(&question, self.plane, grid, Watch::NONE).ok()
    }

    fn candidates<'a>(&'a self, one_thread: &'a ThreadPool) -> Vec<Candidate<'a>> {
        let pitch = if searched(&self.robot) {
            STEP_SEARCHED
        } else {
            STEP
        };
        let choices = [
            (
                "map, one posture",
                BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP),
                STEP,
            ),
            ("map, best of all", BranchChoice::Best, pitch),
        ];
        let map = |(name, choice, pitch)| {
            let grid = grid(pitch);
            Candidate::new(self.who, name, grid.len(), move || {
                one_thread.install(|| black_box(self.map(choice, grid)));
            })
        };
        let all = move || {
            one_thread.install(|| black_box(self.postures()));
        };
        let mut rows: Vec<Candidate<'a>> = choices.into_iter().map(map).collect();
        rows.push(
            Candidate::new(self.who, IK8, self.poses.len(), all)
                .note("another arm, other poses, many at once; verified, limits"),
        );
        rows
    }
}

/// The grid of a map with this pitch, m.
pub fn grid(pitch: f64) -> Grid {
    Grid::within([0.15, 0.15], pitch)
}

/// Whether the postures of this arm are searched for.
fn searched(robot: &Robot) -> bool {
    matches!(robot.inverse(), Inverse::Searched)
}

/// The MH12 with axes 2 and 5 moved along x by so many metres.
fn moved(mh12: &Robot, [axis_2, axis_5]: [f64; 2]) -> Robot {
    let mut motions = Vec::new();
    for motion in mh12.chain().motions() {
        match motion.amount() {
            Amount::Joint(1) => motions.push(Motion::Along(Axis::Y, Amount::Constant(axis_2))),
            Amount::Joint(4) => motions.push(Motion::Along(Axis::Z, Amount::Constant(axis_5))),
            _ => {}
        }
        motions.push(*motion);
    }
    Robot::new("mh12-moved", motions, mh12.joints().to_vec())
        .expect("the chain of a real arm, moved a little")
}

/// Standard Denavit-Hartenberg rows d, a (m), alpha (quarter turns): the maker's support page.
const UR10: [[f64; 3]; 6] = [
    [0.1273, 0.0, 1.0],
    [0.0, -0.612, 0.0],
    [0.0, -0.5723, 0.0],
    [0.163_941, 0.0, 1.0],
    [0.1157, 0.0, -1.0],
    [0.0922, 0.0, 0.0],
];

/// KUKA LBR iiwa 14 R820, from its data sheet.
const IIWA14: [[f64; 3]; 7] = [
    [0.36, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.42, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.40, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.126, 0.0, 0.0],
];

fn of_rows(name: &str, rows: &[[f64; 3]]) -> Robot {
    let mut motions = Vec::new();
    for (index, [d, a, quarters]) in rows.iter().enumerate() {
        motions.extend([
            Motion::About(Axis::Z, Amount::Joint(index)),
            Motion::Along(Axis::Z, Amount::Constant(*d)),
            Motion::Along(Axis::X, Amount::Constant(*a)),
            Motion::About(Axis::X, Amount::Constant(quarters * std::f64::consts::FRAC_PI_2)),
        ]);
    }
    let turn = |i: usize| Joint {
        limits: Some(Limits {
            lower: -std::f64::consts::PI,
            upper: std::f64::consts::PI,
        }),
        ..Joint::plain(format!("A{}", i + 1))
    };
    Robot::new(name, motions, (0..rows.len()).map(turn).collect()).expect("the chain of a real arm")
}

//! Rows of what armill offers above its lanes kernel (`lanes.rs`): whole answers, single postures, maps.

use std::hint::black_box;

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question, evaluate, evaluate_at_joints, postures_at};
use armill_core::load::InputUncertainty;
use armill_core::map::{PlaneMap, plane_map};
use armill_core::nalgebra::{Matrix3, Point3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use armill_core::robot::inverse::{OrthoParallel, ToolAt, posture_at, postures};
use armill_core::robot::joint::{JointCompliance, Sign};
use armill_core::robot::{
    Amount, Attachment, Axis, Backlash, BacklashSide, Branch, BranchPattern, Joint, Limits, Mass, Motion,
    Robot, Spring,
};
use armill_core::source::elastic::predict;
use armill_core::source::stiffness_model::Gravity;
use armill_core::source::{ArmState, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;
use armill_core::workpiece::{Grid, Plane};
use rayon::ThreadPool;

use crate::clock::Candidate;
use crate::work::{C66, DEV, DEV_AT, IK8};
use crate::workload::{A1, A2, C1, C2, C3, C4, COMPLIANCE, FORCES, NORMAL, Pose, TOOL};

/// Repetitions of the work on one pose, to be long against the clock's step.
const REPEATED: usize = 20_000;
/// How many poses the one-posture-at-a-time functions take: they allocate, and are slow.
const FEW: usize = 20_000;

/// The arm of the workload as armill has it.
pub struct Arm {
    robot: Robot,
    tool: Isometry,
    cases: Vec<Wrench>,
    sprung: StiffnessModel,
    worn: StiffnessModel,
}

/// What is modelled in addition to the drives.
#[derive(Clone, Copy)]
pub enum Modelled {
    /// Nothing.
    Drives,
    /// Two bending springs at each joint, 18 with the drives, and gravity on four masses.
    Springs,
    /// The same, and backlash of every joint on the side of the torque.
    Backlash,
}

impl Arm {
    /// MH12 with tool, limits and compliances.
    pub fn mh12() -> Arm {
        let robot = Robot::new("yaskawa/mh12", motions(), joints()).expect("the chain of a real arm");
        let compliance = COMPLIANCE.map(|value| JointCompliance {
            value,
            standard_uncertainty: 0.2 * value,
        });
        Arm {
            robot: robot
                .with_compliance(compliance.to_vec())
                .expect("six finite compliances for six joints"),
            tool: Isometry::translation(0.0, 0.0, TOOL),
            cases: FORCES.map(|force| Wrench::from_force(force.into())).to_vec(),
            sprung: sprung(),
            worn: worn(),
        }
    }

    /// The question of the workload with more than the drives.
    pub fn question_with(&self, modelled: Modelled, choice: BranchChoice) -> Question<'_> {
        let mut question = self.question(choice);
        question.arm.model = match modelled {
            Modelled::Drives => StiffnessModel::DRIVES,
            Modelled::Springs => &self.sprung,
            Modelled::Backlash => &self.worn,
        };
        question
    }

    /// The question of the workload.
    pub fn question(&self, choice: BranchChoice) -> Question<'_> {
        Question {
            arm: armill_core::source::Arm {
                robot: &self.robot,
                compliance: self.compliance(),
                model: StiffnessModel::DRIVES,
                flange_from_tool: &self.tool,
            },
            uncertainty: InputUncertainty::NONE,
            home: None,
            homes: None,
            cases: &self.cases,
            normal: Unit::new_unchecked(NORMAL.into()),
            choice,
            clearance: None,
        }
    }

    /// Joint positions of every branch that reaches, and the compliance there; rad, SI row by row.
    pub fn postures(&self, pose: &Isometry) -> Vec<(Branch, [f64; 6], [f64; 36])> {
        let at = ToolAt {
            flange_from_tool: &self.tool,
            near: None,
            home: None,
        };
        let found = postures(&self.robot, pose, at).unwrap_or_default();
        let all = found.iter().filter_map(|posture| {
            let compliance = compliance_at_tool(&posture.screws, self.compliance());
            let mut flat = [0.0; 36];
            // nalgebra stores columns; the matrix is symmetric.
            flat.copy_from_slice(compliance.as_slice());
            Some((
                posture.name.branch()?,
                posture.joints.as_slice().try_into().ok()?,
                flat,
            ))
        });
        all.collect()
    }

    /// Number of postures of this pose, which the function for one pose finds.
    pub fn all_postures(&self, pose: &Isometry) -> usize {
        let at = ToolAt {
            flange_from_tool: &self.tool,
            near: None,
            home: None,
        };
        postures(&self.robot, pose, at).map_or(0, |found| found.len())
    }

    /// What `predict` says of one posture under one load.
    pub fn predict(&self, q: &[f64; 6]) -> Vector3<f64> {
        let posture = posture_at(&self.robot, q, &self.tool);
        predict(&posture, self.compliance(), &self.cases[0]).twist.linear
    }

    /// The robot itself.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Joint positions from chain positions.
    fn counted(&self, theta: &[f64; 6]) -> [f64; 6] {
        let mut q = [0.0; 6];
        for (i, theta) in theta.iter().enumerate() {
            q[i] = self.robot.joint_position(i, *theta, &q);
        }
        q
    }

    /// Its geometry, as the inverse and lanes have it.
    pub fn closed_form(&self) -> &OrthoParallel {
        self.robot.ortho_parallel().expect("MH12 has a closed form")
    }

    fn compliance(&self) -> &[JointCompliance] {
        self.robot.compliance().expect("set when the arm was made")
    }
}

/// Front elbow-up flip, the posture of the paper.
pub const ONE_POSTURE: BranchChoice = BranchChoice::Of(BranchPattern {
    wrist: Some(armill_core::robot::Wrist::Flip),
    ..BranchPattern::FRONT_ELBOW_UP
});

/// A pose as armill has it.
pub fn isometry(pose: &Pose) -> Isometry {
    let [a, b, c, x, d, e, f, y, g, h, i, z] = *pose;
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::new(a, b, c, d, e, f, g, h, i));
    Isometry::from_parts(
        Translation3::new(x, y, z),
        UnitQuaternion::from_rotation_matrix(&rotation),
    )
}

/// Every row of armill.
pub fn candidates<'a>(arm: &'a Arm, poses: &'a [Isometry], pools: &'a [ThreadPool; 2]) -> Vec<Candidate<'a>> {
    let mut all = kernel(arm, poses, pools);
    all.extend(general(arm, &poses[..FEW.min(poses.len())], &pools[0]));
    all.push(known_joints(arm, &pools[0]));
    all.extend(one_pose(arm));
    all.extend(maps(arm, &pools[0]));
    all.extend(whole_maps(arm, &pools[0]));
    all
}

/// The kernel on the poses of the workload, with one thread and with two.
fn kernel<'a>(arm: &'a Arm, poses: &'a [Isometry], pools: &'a [ThreadPool; 2]) -> Vec<Candidate<'a>> {
    const NOTE: &str = "joint angles, limits, singularities, shares and uncertainty as well; verified";
    let question = arm.question(ONE_POSTURE);
    let with = |pool: &'a ThreadPool| {
        let run = move || {
            pool.install(|| black_box(evaluate(&question, poses.len(), |i| poses[i], Watch::NONE)))
                .ok();
        };
        Candidate::new("armill evaluate", DEV, poses.len(), run)
            .threads(pool.current_num_threads())
            .note(NOTE)
    };
    pools.iter().map(with).collect()
}

/// The functions of the inverse, and those that take one posture at a time, on the poses of the workload.
fn general<'a>(arm: &'a Arm, poses: &'a [Isometry], one_thread: &'a ThreadPool) -> Vec<Candidate<'a>> {
    let at = ToolAt {
        flange_from_tool: &arm.tool,
        near: None,
        home: None,
    };
    let all_branches = move || {
        for pose in poses {
            black_box(postures(&arm.robot, pose, at)).ok();
        }
    };
    let compliance = move || {
        for pose in poses {
            let flange = pose * arm.tool.inverse();
            let solved = arm.closed_form().chain_positions(&flange, Branch::ALL[0], None);
            black_box(solved.map(|(theta, _)| {
                let q = arm.counted(&theta);
                let posture = posture_at(&arm.robot, &q, &arm.tool);
                compliance_at_tool(&posture.screws, arm.compliance())
            }))
            .ok();
        }
    };
    let many = move || {
        let tool_from_flange = arm.tool.inverse();
        let flange = |i: usize| poses[i] * tool_from_flange;
        one_thread
            .install(|| black_box(postures_at(&arm.robot, poses.len(), flange, None, Watch::NONE)))
            .ok();
    };
    vec![
        Candidate::new("armill postures_at", IK8, poses.len(), many)
            .note("many poses at once; verified by forward kinematics, limits"),
        Candidate::new("armill postures", IK8, poses.len(), all_branches)
            .note("one pose at a time; verified, with screws"),
        Candidate::new("armill compliance_at_tool", C66, poses.len(), compliance)
            .note("one pose at a time; solve, posture_at, compliance_at_tool"),
    ]
}

/// Any chain at known joint positions: the deviation under all forces.
fn known_joints<'a>(arm: &'a Arm, one_thread: &'a ThreadPool) -> Candidate<'a> {
    // A step of the golden angle a joint: nothing repeats.
    let joints: Vec<f64> = (0..6 * FEW)
        .map(|k| ((k / 6 + 1) as f64 * 2.399_963 * ((k % 6) as f64 + 1.0)).sin())
        .collect();
    let run = move || {
        let evaluation = armill_core::source::Arm {
            robot: &arm.robot,
            compliance: arm.compliance(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &arm.tool,
        };
        let width = 3 * arm.cases.len();
        let mut out = vec![0.0; FEW * width];
        let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| {
            for (wrench, out) in arm.cases.iter().zip(out.chunks_mut(3)) {
                out.copy_from_slice(arm_state.elastic(wrench)?.linear.as_slice());
            }
            Ok(())
        };
        one_thread
            .install(|| evaluate_at_joints(&evaluation, &joints, &mut out, write, Watch::NONE))
            .ok();
        black_box(&out);
    };
    Candidate::new("armill evaluate_at_joints", DEV_AT, FEW, run)
        .note("any chain, read motion by motion; other postures")
}

/// The parts of the general path, on one pose.
fn one_pose(arm: &Arm) -> Vec<Candidate<'_>> {
    const WHO: &str = "armill, one pose";
    let posture = posture_at(&arm.robot, &[0.2, 0.3, -0.4, 0.5, 0.6, 0.7], &arm.tool);
    let (posture, q) = (posture.clone(), posture.joints);
    let (screws, push) = (posture.screws.clone(), arm.cases[0]);
    let forward = move || {
        for _ in 0..REPEATED {
            black_box(posture_at(&arm.robot, black_box(&q), &arm.tool));
        }
    };
    let matrix = move || {
        for _ in 0..REPEATED {
            black_box(compliance_at_tool(black_box(&screws), arm.compliance()));
        }
    };
    let deviation = move || {
        for _ in 0..REPEATED {
            black_box(predict(black_box(&posture), arm.compliance(), &push));
        }
    };
    vec![
        Candidate::new(WHO, "forward and screws", REPEATED, forward),
        Candidate::new(WHO, "compliance 6x6 of a posture", REPEATED, matrix),
        Candidate::new(WHO, "predict: deviation, shares, covariance", REPEATED, deviation),
    ]
}

/// A map of 101 x 101 points.
pub fn map(arm: &Arm, modelled: Modelled, choice: BranchChoice) -> Option<PlaneMap> {
    let (plane, grid) = map_plane();
    let question = Question {
        normal: plane.normal(),
        ..arm.question_with(modelled, choice)
    };
    plane_map(&question, plane, grid, Watch::NONE).ok()
}

/// Points of [`map`].
pub const MAP_POINTS: usize = 101 * 101;

fn map_plane() -> (Plane, Grid) {
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
    (plane, Grid::within([0.4, 0.4], 0.008))
}

/// Maps of 101 x 101 points under four cases, on one thread; the rate counts points.
fn maps<'a>(arm: &'a Arm, one_thread: &'a ThreadPool) -> Vec<Candidate<'a>> {
    const WHO: &str = "armill, map 101 x 101, 4 cases";
    let choices = [
        ("one posture", ONE_POSTURE),
        (
            "front elbow-up, either wrist",
            BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP),
        ),
        ("best of all 8", BranchChoice::Best),
    ];
    let row = |(name, choice)| {
        Candidate::new(WHO, name, MAP_POINTS, move || {
            one_thread.install(|| black_box(map(arm, Modelled::Drives, choice)));
        })
    };
    choices.into_iter().map(row).collect()
}

/// Maps with more than the drives; the rate counts points.
fn whole_maps<'a>(arm: &'a Arm, one_thread: &'a ThreadPool) -> Vec<Candidate<'a>> {
    let models = [
        ("armill, MH12 with 18 springs and gravity", Modelled::Springs),
        ("armill, MH12 with springs, gravity, backlash", Modelled::Backlash),
    ];
    let choices = [
        ("map, one posture", ONE_POSTURE),
        ("map, best of all", BranchChoice::Best),
    ];
    let row = |who, modelled, name, choice| {
        Candidate::new(who, name, MAP_POINTS, move || {
            one_thread.install(|| black_box(map(arm, modelled, choice)));
        })
        .note("angles, limits, shares of every source, uncertainty; verified")
    };
    models
        .into_iter()
        .flat_map(|(who, modelled)| choices.map(|(name, choice)| row(who, modelled, name, choice)))
        .collect()
}

/// Two bending springs at each joint, and gravity.
fn sprung() -> StiffnessModel {
    let spring = |joint: usize, axis: Vector3<f64>| {
        let compliance = JointCompliance {
            value: 3e-7,
            standard_uncertainty: 3e-8,
        };
        Spring::about(Attachment::Joint(joint), axis, compliance)
    };
    let mass = |joint: usize, mass: f64, centre: [f64; 3]| Mass {
        attachment: Attachment::Joint(joint),
        mass,
        centre: centre.into(),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure.springs = (0..6)
        .flat_map(|joint| [spring(joint, Vector3::x()), spring(joint, Vector3::y())])
        .collect();
    model.structure.masses = vec![
        mass(0, 40.0, [0.05, 0.0, -0.1]),
        mass(1, 30.0, [0.0, 0.0, 0.3]),
        mass(2, 25.0, [0.1, 0.0, 0.1]),
        mass(5, 4.0, [0.0, 0.0, 0.1]),
    ];
    model.gravity = Some(Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.2; 6],
    });
    model
}

/// [`sprung`] with backlash.
fn worn() -> StiffnessModel {
    let mut model = sprung();
    let backlash = Backlash {
        gap: 1e-4,
        standard_uncertainty: 1e-5,
        side: BacklashSide::Torque,
    };
    model.structure.backlash = vec![Some(backlash); 6];
    model
}

/// The chain of the MH12 as ros-industrial/motoman has it, `workload`'s lengths in it.
fn motions() -> Vec<Motion> {
    use Amount::{Constant, Joint as Turned};
    use Axis::{X, Y, Z};
    use Motion::{About, Along};
    use std::f64::consts::{FRAC_PI_2, PI};
    vec![
        Along(Z, Constant(C1)),
        About(Z, Turned(0)),
        Along(X, Constant(A1)),
        About(Y, Turned(1)),
        Along(Z, Constant(C2)),
        About(Y, Turned(2)),
        Along(Z, Constant(-A2)),
        About(X, Turned(3)),
        Along(X, Constant(C3)),
        About(Y, Turned(4)),
        Along(X, Constant(C4)),
        About(X, Turned(5)),
        About(Y, Constant(-FRAC_PI_2)),
        About(X, Constant(PI)),
    ]
}

fn joints() -> Vec<Joint> {
    use Sign::{Negative, Positive};
    let joint = |(name, sign, limits_deg): (&str, Sign, [f64; 2])| {
        let [lower, upper] = limits_deg.map(f64::to_radians);
        Joint {
            sign,
            limits: Some(Limits { lower, upper }),
            ..Joint::plain(name)
        }
    };
    let all = [
        ("S", Positive, [-170.0, 170.0]),
        ("L", Positive, [-90.0, 155.0]),
        ("U", Negative, [-85.0, 150.0]),
        ("R", Negative, [-180.0, 180.0]),
        ("B", Negative, [-135.0, 135.0]),
        ("T", Negative, [-360.0, 360.0]),
    ];
    all.into_iter().map(joint).collect()
}

//! Staubli TX200 against a published compliance matrix. See README.md.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `k` | springs about joint axes, about bending axes | N m/rad |
//! | `C` | translational compliance at the TCP, upper left 3 x 3 | um/N |
//! | `E` | potential energy of links and spindle; gravity's torque on a drive is `-dE/dq` | J |
//!
//! Base and workpiece frame share z; the workpiece is turned by -90 deg about it.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix3, Point3, Vector3};

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Amount, Attachment, JointCompliance, Mass, Posture, Robot, Spring, Structure};
use armill_core::source::stiffness_model::FREE_FALL;
use armill_core::source::{Arm, ArmState, Gravity, StiffnessModel};

use crate::arms;
use crate::check::{Check, ErrorBound, worst_difference};

const PUBLISHED: &str = "rafisondi/sensitivity_milling_analysis";
const COMPUTED: &str = "independent computation";

/// Springs of the older identification, joints 4 to 6 rigid, N m/rad: those that the published matrix belongs
/// to.
pub const OLDER_SPRINGS: [f64; 6] = [
    1.15e6,
    3.76e6,
    1.29e6,
    f64::INFINITY,
    f64::INFINITY,
    f64::INFINITY,
];
/// Springs about the drive axes of Huynh et al., N m/rad, the newer set; the source warns not to mix the two.
const DRIVE_SPRINGS: [f64; 6] = [2.3e6, 8.6e6, 2.8e6, 3.0e6, 0.2e6, 0.9e6];

/// The published pose: TCP in base, m; its joints, deg.
const TCP: [f64; 3] = [-0.025, -1.6224, 0.4857];
const JOINTS_DEG: [f64; 6] = [-91.2017, 26.2433, 113.0264, -2.0609, -34.2838, 1.3920];
/// Translational compliance at the TCP in the workpiece frame, um/N.
pub const COMPLIANCE_IN_PART: Matrix3<f64> =
    Matrix3::new(0.795, 0.019, 0.801, 0.019, 2.289, -0.017, 0.801, -0.017, 1.204);

/// The second pose: joints, deg, and the TCP there in base, m, to 16 digits.
const SECOND_JOINTS_DEG: [f64; 6] = [-90.0, 30.0, 95.0, 0.0, 0.0, 0.0];
const SECOND_TCP: [f64; 3] = [0.0, -1.647_400_025_592_229_6, 0.480_698_121_343_784_3];
/// Bending springs about the x and y axes of the joint frames, N m/rad.
const BENDING_SPRINGS: [[f64; 2]; 6] = [
    [13.1e6, 17.0e6],
    [4.1e6, 19.9e6],
    [18.8e6, 2.9e6],
    [2.3e6, 3.1e6],
    [2.1e6, 0.9e6],
    [14.8e6, 8.3e6],
];
/// Translational compliance there in base with all 18, um/N.
const SECOND_COMPLIANCE_18: Matrix3<f64> = Matrix3::new(
    2.6215, -0.0681, -0.0643, -0.0681, 2.0235, -1.2713, -0.0643, -1.2713, 1.2680,
);
/// Translational compliance there in base, um/N.
const SECOND_COMPLIANCE: Matrix3<f64> =
    Matrix3::new(1.2908, 0.0, 0.0, 0.0, 1.7278, -1.0517, 0.0, -1.0517, 0.8876);

/// Posture and compliance matrices against the published ones.
pub fn checks() -> Vec<Check> {
    let robot = arms::tx200(OLDER_SPRINGS);
    let posture = posture(&robot);
    let found_deg: Vec<f64> = posture.joints.iter().map(|q| q.to_degrees()).collect();
    let joints = worst_difference(&found_deg, &JOINTS_DEG);
    let matrix = worst_difference(
        compliance_in_part(&robot, &posture).as_slice(),
        COMPLIANCE_IN_PART.as_slice(),
    );

    let robot = arms::tx200(DRIVE_SPRINGS);
    let second = posture_at(
        &robot,
        &SECOND_JOINTS_DEG.map(f64::to_radians),
        &flange_from_tool(),
    );
    let tcp = worst_difference(second.base_from_tool.translation.vector.as_slice(), &SECOND_TCP);
    let second_matrix = worst_difference(
        translational(&robot, &second).as_slice(),
        SECOND_COMPLIANCE.as_slice(),
    );
    let bending = worst_difference(with_bending(&robot).as_slice(), SECOND_COMPLIANCE_18.as_slice());
    vec![
        // Half of the last printed digit, here and below.
        Check::printed(
            "joints of the published TCP pose, among the postures of the closed form",
            COMPUTED,
            ErrorBound {
                worst: joints,
                tolerance: 5e-5,
                unit: "deg",
            },
            6,
        ),
        Check::printed(
            "translational compliance in the workpiece frame, 9 numbers",
            PUBLISHED,
            ErrorBound {
                worst: matrix,
                tolerance: 5e-4,
                unit: "um/N",
            },
            5,
        ),
        Check::computed(
            "TCP at (-90, 30, 95, 0, 0, 0) deg",
            PUBLISHED,
            ErrorBound {
                worst: tcp,
                tolerance: 1e-14,
                unit: "m",
            },
        ),
        Check::printed(
            "translational compliance there, six drive springs, 9 numbers",
            COMPUTED,
            ErrorBound {
                worst: second_matrix,
                tolerance: 5e-5,
                unit: "um/N",
            },
            6,
        ),
        Check::printed(
            "translational compliance there, all 18 springs, 9 numbers",
            COMPUTED,
            ErrorBound {
                worst: bending,
                tolerance: 5e-5,
                unit: "um/N",
            },
            6,
        ),
        Check::computed(
            "torques of gravity on the six drives, ten postures",
            "gradient of the potential energy",
            ErrorBound {
                worst: gravity_gap(&robot),
                // 10 kJ: h^2 of the third derivative, and rounding over h.
                tolerance: 1e-5,
                unit: "N m",
            },
        ),
    ]
}

/// The posture of the published TCP pose in the branch of the printed joints.
pub fn posture(robot: &Robot) -> Posture {
    // The tool looks down on the workpiece, turned by half a turn about its z.
    let orientation = workpiece() * from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(PI, 0.0, PI));
    let base_from_tool = Isometry::from_parts(TCP.into(), orientation.rotation);
    let tool = ToolAt {
        flange_from_tool: &flange_from_tool(),
        near: None,
        home: None,
    };
    let found = postures(robot, &base_from_tool, tool).expect("the pose is in reach");
    let away = |posture: &Posture| {
        let joints_deg: Vec<f64> = posture.joints.iter().map(|q| q.to_degrees()).collect();
        worst_difference(&joints_deg, &JOINTS_DEG)
    };
    found
        .into_iter()
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .expect("there is at least one posture")
}

/// Translational compliance at the TCP in the workpiece frame, um/N.
pub fn compliance_in_part(robot: &Robot, posture: &Posture) -> Matrix3<f64> {
    let base_from_part = workpiece().rotation.to_rotation_matrix().into_inner();
    base_from_part.transpose() * translational(robot, posture) * base_from_part
}

/// The workpiece frame in base: `Rz(-90 deg)`.
pub fn workpiece() -> Isometry {
    from_xyz_and_fixed_angles(Vector3::zeros(), Vector3::new(0.0, 0.0, -FRAC_PI_2))
}

/// The spindle on the flange: TCP in m, turned by 75 deg about y.
pub fn flange_from_tool() -> Isometry {
    from_xyz_and_fixed_angles(
        Vector3::new(0.277, 0.0, 0.326),
        Vector3::new(0.0, 1.308_996_9, 0.0),
    )
}

/// Translational compliance at the second pose in base with bending springs in addition to those of the drives, um/N:
/// 18 in all.
fn with_bending(robot: &Robot) -> Matrix3<f64> {
    let axes = [Vector3::x(), Vector3::y()];
    let of_joint = |(joint, k): (usize, &[f64; 2])| {
        let spring = |axis: usize| {
            let compliance = JointCompliance {
                value: 1.0 / k[axis],
                standard_uncertainty: 0.0,
            };
            Spring::about(Attachment::Joint(joint), axes[axis], compliance)
        };
        [spring(0), spring(1)]
    };
    let structure = Structure {
        springs: BENDING_SPRINGS.iter().enumerate().flat_map(of_joint).collect(),
        ..Structure::EMPTY
    };
    let model = StiffnessModel {
        structure,
        ..StiffnessModel::DRIVES.clone()
    };
    let tool = flange_from_tool();
    let mut arm_state = ArmState::new(evaluation(robot, &model, &tool));
    arm_state.set_joints(&SECOND_JOINTS_DEG.map(f64::to_radians));
    let compliance = arm_state.compliance().expect("the arm has no compensator");
    compliance.fixed_view::<3, 3>(0, 0) * 1e6
}

/// The arm as the sources of deviation see it.
fn evaluation<'a>(robot: &'a Robot, model: &'a StiffnessModel, tool: &'a Isometry) -> Arm<'a> {
    Arm {
        robot,
        compliance: robot.compliance().expect("the arm was made with springs"),
        model,
        flange_from_tool: tool,
    }
}

/// Masses (kg) and centres (m, frames of the joints) of links 1 to 6, and of the spindle on the flange.
const MASSES: [(f64, [f64; 3]); 7] = [
    (364.0, [0.15, -0.008, 0.209]),
    (256.1, [0.401, 0.007, 0.139]),
    (98.7, [0.039, 0.043, -0.219]),
    (40.8, [0.0, 0.004, 0.266]),
    (13.6, [0.0, -0.067, 0.0]),
    (0.6, [0.0, 0.0, 0.005]),
    (61.4, [-0.048, -0.001, 0.173]),
];

/// Largest difference between the torques of gravity and `-dE/dq`, N m, over ten postures all over the range,
/// by central differences with a step of 1e-5 rad.
fn gravity_gap(robot: &Robot) -> f64 {
    let mass = |(index, (mass, centre)): (usize, &(f64, [f64; 3]))| Mass {
        attachment: if index < 6 {
            Attachment::Joint(index)
        } else {
            Attachment::Flange
        },
        mass: *mass,
        centre: (*centre).into(),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    let structure = Structure {
        masses: MASSES.iter().enumerate().map(mass).collect(),
        ..Structure::EMPTY
    };
    let model = StiffnessModel {
        structure,
        gravity: Some(Gravity {
            acceleration: Vector3::new(0.0, 0.0, -FREE_FALL),
            reference: vec![0.0; 6],
        }),
        load_dependent: false,
        ..StiffnessModel::DRIVES.clone()
    };
    let tool = flange_from_tool();
    let mut arm_state = ArmState::new(evaluation(robot, &model, &tool));
    let mut gap = 0.0_f64;
    for posture in 0..10 {
        let q = [0, 1, 2, 3, 4, 5].map(|i| 0.3 * f64::from(posture) - 0.4 * f64::from(i) + 0.5);
        arm_state.set_joints(&q);
        for (joint, torque) in arm_state.gravity_torques().iter().enumerate() {
            let at = |by: f64| {
                let mut q = q;
                q[joint] += by;
                energy(robot, &q)
            };
            let step = 1e-5;
            gap = gap.max((torque + (at(step) - at(-step)) / (2.0 * step)).abs());
        }
    }
    gap
}

/// Potential energy of the masses, J: the chain as a product of motions, cut after each joint.
fn energy(robot: &Robot, q: &[f64; 6]) -> f64 {
    let mut base_from_here = Isometry::identity();
    let mut energy = 0.0;
    for motion in robot.chain().motions() {
        match motion.amount() {
            Amount::Constant(value) => base_from_here *= motion.displacement(value),
            Amount::Joint(joint) => {
                base_from_here *= motion.displacement(q[joint]);
                let (mass, centre) = MASSES[joint];
                energy += mass * FREE_FALL * (base_from_here * Point3::from(centre)).z;
            }
        }
    }
    let (mass, centre) = MASSES[6];
    energy + mass * FREE_FALL * (base_from_here * Point3::from(centre)).z
}

/// Translational compliance at the TCP in base, um/N.
fn translational(robot: &Robot, posture: &Posture) -> Matrix3<f64> {
    let joints = robot.compliance().expect("the arm was made with springs");
    compliance_at_tool(&posture.screws, joints).fixed_view::<3, 3>(0, 0) * 1e6
}

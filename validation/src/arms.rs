//! Arms of the cases, typed from their sources; those of the library come from there.
//!
//! A chain is a row of elementary motions from `base_link` to the flange, `Along` an axis in m or `About` one
//! in rad, each by a constant or by the position of a joint; signs and couplings lead from the controller's
//! positions to those of the chain. Each arm names the file and the commit that its numbers were typed from.

use std::f64::consts::{FRAC_PI_2, PI};

use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

use armill_core::robot::joint::{Coupling, Sign};
use armill_core::robot::{Amount, Axis, Joint, JointCompliance, Motion, Robot};

use Amount::{Constant, Joint as Var};
use Axis::{X, Y, Z};
use Motion::{About, Along};

/// A robot of the library, with the compliances that the library gives.
pub fn library(name: &str) -> Robot {
    let found = armill_study::library::robot(name).expect("the library has it");
    found.expect("every robot of the library reads").robot
}

/// Yaskawa MH12 of the library, whose compliances are those of the paper.
pub fn mh12() -> Robot {
    library("yaskawa/mh12")
}

/// KUKA KR 150 R3100-2, without compliances: `kr150r3100_2_macro.xacro` of ros-industrial/kuka_experimental
/// (e78bbd15).
///
/// Its first axis points down, and its flange is rotated so that z points out of it.
pub fn kr150() -> Robot {
    // Column, shoulder, upper arm, elbow and forearm, wrist, and the turn of the flange.
    let motions = vec![
        Along(Z, Constant(0.645)),
        About(Z, Var(0)),
        Along(X, Constant(0.330)),
        About(Y, Var(1)),
        Along(X, Constant(1.350)),
        About(Y, Var(2)),
        Along(X, Constant(1.420)),
        Along(Z, Constant(0.115)),
        About(X, Var(3)),
        About(Y, Var(4)),
        Along(X, Constant(0.215)),
        About(X, Var(5)),
        About(Y, Constant(FRAC_PI_2)),
    ];
    six_joints("kr150r3100_2", motions, [-1, 1, 1, -1, 1, -1])
}

/// Staubli TX2-90, whose second axis is 50 mm to the side: `tx2_90_macro.xacro` of
/// ros-industrial/staubli_experimental (256a71ac).
pub fn tx2_90() -> Robot {
    // Column, shoulder with the second axis to the side, upper arm, forearm, wrist.
    let motions = vec![
        Along(Z, Constant(0.478)),
        About(Z, Var(0)),
        Along(X, Constant(0.050)),
        Along(Y, Constant(0.050)),
        About(Y, Var(1)),
        Along(Z, Constant(0.425)),
        About(Y, Var(2)),
        Along(Z, Constant(0.425)),
        About(Z, Var(3)),
        About(Y, Var(4)),
        About(Z, Var(5)),
        Along(Z, Constant(0.100)),
    ];
    six_joints("tx2_90", motions, [1; 6])
}

/// FANUC R-2000iC with the published joint stiffness: modified DH rows of Liu et al. 2026, repository
/// longton2001-pixel/breakthrough-surge-suppression-in-high-speed-robotic-drilling (e5c2f795), MIT.
///
/// Controller to chain: m1 = r1, m2 = r2, m3 = -(r2 + r3), m4 = -r4, m5 = -r5, m6 = -r6.
pub fn r2000ic() -> Robot {
    // alpha rad, a m, zero of theta rad, d m.
    let rows = [
        (0.0, 0.0, 0.0, 0.670),
        (-FRAC_PI_2, 0.312, -FRAC_PI_2, 0.0),
        (0.0, 1.075, 0.0, 0.0),
        (-FRAC_PI_2, 0.225, 0.0, 1.280),
        (FRAC_PI_2, 0.0, 0.0, 0.0),
        (-FRAC_PI_2, 0.0, 0.0, 0.215),
    ];
    // Modified parameters: about and along the x of the joint before, then about and along the joint's own z.
    let motions = rows
        .into_iter()
        .enumerate()
        .flat_map(|(joint, (alpha, a, zero, d))| {
            [
                About(X, Constant(alpha)),
                Along(X, Constant(a)),
                About(Z, Constant(zero)),
                About(Z, Var(joint)),
                Along(Z, Constant(d)),
            ]
        });
    let mut joints = joints([1, 1, -1, -1, -1, -1]);
    joints[2].coupling = vec![Coupling {
        joint: 1,
        factor: 1.0,
    }];
    let stiffness_n_m_per_rad = [
        9.339_417_645_122_126e5,
        4.129_256_136_278_849e6,
        1.907_534_091_464_657e6,
        2.332_046_025_476_337_6e5,
        4.043_588_275_329_60e5,
        7.961_815_940_385_307e4,
    ];
    let robot = Robot::new("r2000ic", motions.collect(), joints).expect("its chain is typed here");
    with_stiffness(robot, stiffness_n_m_per_rad)
}

/// Staubli TX200 with springs about the joint axes of this stiffness (infinite where rigid): chain of
/// `robotsim/settings.py`, repository rafisondi/sensitivity_milling_analysis (bad01384), after Huynh et al. 2020.
pub fn tx200(stiffness_n_m_per_rad: [f64; 6]) -> Robot {
    // Origin of each joint in the frame of the one before: xyz m, rpy rad; every axis is the local z.
    let origins = [
        ([0.0, 0.0, 0.344], [0.0, 0.0, 0.0]),
        ([0.25, 0.235, 0.298], [-FRAC_PI_2, -FRAC_PI_2, 0.0]),
        ([0.95, 0.0, 0.044], [0.0, 0.0, FRAC_PI_2]),
        ([0.0, -0.179, -0.279], [FRAC_PI_2, 0.0, 0.0]),
        ([0.0, 0.0, 0.621], [-FRAC_PI_2, 0.0, 0.0]),
        ([0.0, -0.177, 0.0], [FRAC_PI_2, 0.0, 0.0]),
    ];
    let mut motions = Vec::new();
    for (joint, (xyz, rpy)) in origins.into_iter().enumerate() {
        motions.extend(origin(xyz, rpy));
        motions.push(About(Z, Var(joint)));
    }
    motions.extend(origin([0.0, 0.0, 0.017], [0.0; 3]));
    with_stiffness(six_joints("tx200", motions, [1; 6]), stiffness_n_m_per_rad)
}

/// An arm of our own: seven joints, a rail first, a telescope for the fourth, the fifth counted against the
/// chain and the sixth coupled to it. It has no compliances.
pub fn railed() -> Robot {
    let motions = vec![
        Along(Y, Var(0)),
        About(Z, Var(1)),
        Along(Z, Constant(0.5)),
        About(Y, Var(2)),
        About(X, Constant(0.3)),
        Along(X, Var(3)),
        About(Z, Var(4)),
        Along(X, Constant(0.2)),
        About(X, Var(5)),
        About(Y, Var(6)),
        Along(Z, Constant(0.15)),
    ];
    let mut joints: Vec<Joint> = ["rail", "A", "B", "telescope", "C", "D", "E"]
        .map(Joint::plain)
        .to_vec();
    joints[4].sign = Sign::Negative;
    joints[5].coupling = vec![Coupling {
        joint: 4,
        factor: -0.5,
    }];
    Robot::new("railed", motions, joints).expect("its chain is typed here")
}

/// The elementary motions of a URDF origin: R = Rz(yaw) Ry(pitch) Rx(roll).
fn origin([x, y, z]: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> [Motion; 6] {
    [
        Along(X, Constant(x)),
        Along(Y, Constant(y)),
        Along(Z, Constant(z)),
        About(Z, Constant(yaw)),
        About(Y, Constant(pitch)),
        About(X, Constant(roll)),
    ]
}

/// Six plain joints, each counted with the chain or against it (1, -1).
fn six_joints(name: &str, motions: Vec<Motion>, signs: [i8; 6]) -> Robot {
    Robot::new(name, motions, joints(signs)).expect("its chain is typed here")
}

/// Joints without names and limits of their own.
fn joints(signs: [i8; 6]) -> Vec<Joint> {
    let joint = |sign| Joint {
        sign: if sign > 0 { Sign::Positive } else { Sign::Negative },
        ..Joint::plain("joint")
    };
    signs.map(joint).to_vec()
}

/// The robot with a spring about each joint axis; an infinite stiffness is a compliance of zero.
fn with_stiffness(robot: Robot, stiffness_n_m_per_rad: [f64; 6]) -> Robot {
    let joints = stiffness_n_m_per_rad.map(|k| JointCompliance {
        value: 1.0 / k,
        standard_uncertainty: 0.0,
    });
    robot
        .with_compliance(joints.to_vec())
        .expect("stiffness is positive")
}

/// Three arms, and the same as seven lengths, offsets and signs of an ortho-parallel arm with spherical wrist.
pub fn with_opw_parameters() -> [(&'static str, Robot, Parameters); 3] {
    let mh12_parameters = Parameters {
        a1: 0.155,
        a2: -0.200,
        b: 0.0,
        c1: 0.450,
        c2: 0.614,
        c3: 0.640,
        c4: 0.100,
        offsets: [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, PI],
        sign_corrections: [1, 1, -1, -1, -1, -1],
        dof: 6,
    };
    // opw_parameters_kr150r3100_2.yaml of ros-industrial/kuka_experimental (e78bbd15).
    let kr150_parameters = Parameters {
        a1: 0.330,
        a2: -0.115,
        b: 0.0,
        c1: 0.645,
        c2: 1.350,
        c3: 1.420,
        c4: 0.215,
        offsets: [0.0, -FRAC_PI_2, 0.0, 0.0, 0.0, 0.0],
        sign_corrections: [-1, 1, 1, -1, 1, -1],
        dof: 6,
    };
    // opw_parameters_tx2_90.yaml of ros-industrial/staubli_experimental (256a71ac).
    let tx2_90_parameters = Parameters {
        a1: 0.050,
        a2: 0.0,
        b: 0.050,
        c1: 0.478,
        c2: 0.425,
        c3: 0.425,
        c4: 0.100,
        offsets: [0.0; 6],
        sign_corrections: [1; 6],
        dof: 6,
    };
    [
        ("Yaskawa MH12", mh12(), mh12_parameters),
        ("KUKA KR 150 R3100-2", kr150(), kr150_parameters),
        ("Staubli TX2-90", tx2_90(), tx2_90_parameters),
    ]
}

/// Standard Denavit-Hartenberg rows (theta at zero, d, a, alpha; deg and mm) as a robot without compliances.
fn by_rows(name: &str, rows: [[f64; 4]; 6]) -> Robot {
    let motions = rows.iter().enumerate().flat_map(|(joint, [theta, d, a, alpha])| {
        [
            About(Z, Constant(theta.to_radians())),
            About(Z, Var(joint)),
            Along(Z, Constant(d * 1e-3)),
            Along(X, Constant(a * 1e-3)),
            About(X, Constant(alpha.to_radians())),
        ]
    });
    Robot::new(name, motions.collect(), joints([1; 6])).expect("its chain is typed here")
}

/// Staubli TX90L: lengths of its data sheet.
pub fn tx90l() -> Robot {
    by_rows(
        "tx90l",
        [
            [0.0, 478.0, 50.0, -90.0],
            [-90.0, 0.0, 500.0, 0.0],
            [90.0, 50.0, 0.0, 90.0],
            [0.0, 550.0, 0.0, -90.0],
            [0.0, 0.0, 0.0, 90.0],
            [0.0, 100.0, 0.0, 0.0],
        ],
    )
}

/// KUKA LBR iiwa 7 R800: lengths of its data sheet; axes as those of the iiwa 14 of the library.
pub fn iiwa7() -> Robot {
    let motions = vec![
        Along(Z, Constant(0.340)),
        About(Z, Var(0)),
        About(Y, Var(1)),
        Along(Z, Constant(0.400)),
        About(Z, Var(2)),
        About(Y, Var(3)),
        Along(Z, Constant(0.400)),
        About(Z, Var(4)),
        About(Y, Var(5)),
        About(Z, Var(6)),
        Along(Z, Constant(0.126)),
    ];
    let joint = |negative| Joint {
        sign: if negative { Sign::Negative } else { Sign::Positive },
        ..Joint::plain("joint")
    };
    let joints = (0..7).map(|index| joint(index == 3)).collect();
    Robot::new("iiwa7", motions, joints).expect("its chain is typed here")
}

/// ABB IRB 120-3/0.6: lengths of its data sheet.
pub fn irb120() -> Robot {
    by_rows(
        "irb120",
        [
            [0.0, 290.0, 0.0, -90.0],
            [-90.0, 0.0, 270.0, 0.0],
            [0.0, 0.0, 70.0, -90.0],
            [0.0, 302.0, 0.0, 90.0],
            [0.0, 0.0, 0.0, -90.0],
            [180.0, 72.0, 0.0, 0.0],
        ],
    )
}

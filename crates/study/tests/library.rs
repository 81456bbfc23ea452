//! The robot library: which arms have a closed-form inverse, and do they reach what their makers say?

// A panic is how a test says that its claim is false.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::PI;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles, tool_orientation};
use armill_core::nalgebra::Vector3;
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{Robot, reach};
use armill_study::library;

fn robot(name: &str) -> Robot {
    library::robot(name).unwrap().unwrap().robot
}

/// Flange in base, mm, at these positions in degrees.
fn flange_mm(name: &str, joints_deg: &[f64]) -> Vector3<f64> {
    let q: Vec<f64> = joints_deg.iter().map(|deg| deg.to_radians()).collect();
    let posture = posture_at(&robot(name), &q, &Isometry::identity());
    posture.base_from_tool.translation.vector * 1e3
}

fn assert_near(found: Vector3<f64>, expected: [f64; 3], mm: f64) {
    let away = (found - Vector3::from(expected)).norm();
    assert!(away < mm, "{found:?} mm, not {expected:?} mm");
}

#[test]
fn every_arm_with_a_spherical_wrist_has_its_closed_form_inverse() {
    let without: Vec<&str> = library::ROBOTS
        .iter()
        .map(|entry| entry.name)
        .filter(|name| robot(name).inverse().word() != "closed_form")
        .collect();
    assert!(without.is_empty(), "{without:?}");
    assert!(library::ROBOTS.len() >= 28, "{}", library::ROBOTS.len());
}

#[test]
fn robots_reach_as_far_as_their_names_say() {
    // Type names and, for the MH12, the catalogue's 1440 mm; names are rounded to 10 mm, or to 100 mm (R700, R2700).
    for (name, mm, rounding) in [
        ("yaskawa/mh12", 1440.0, 10.0),
        ("kuka/kr120r2500pro", 2500.0, 10.0),
        ("kuka/kr150r3100-2", 3100.0, 10.0),
        ("kuka/kr210r2700extra", 2700.0, 10.0),
        ("kuka/kr6r700sixx", 700.0, 10.0),
        ("abb/irb6600-225-255", 2550.0, 10.0),
        ("abb/irb6640-185-280", 2800.0, 10.0),
    ] {
        let found = reach(&robot(name)).unwrap() * 1e3;
        assert!(
            (found - mm).abs() < rounding,
            "{name}: {found} mm, {mm} mm by its name"
        );
    }
}

#[test]
fn nominal_branch_is_inside_limits_before_the_robot() {
    for entry in library::ROBOTS {
        let robot = robot(entry.name);
        let (Some(_), Some(reach)) = (robot.ortho_parallel(), reach(&robot)) else {
            continue;
        };
        // A tool that points down, two thirds of the reach in front, a little above the floor.
        let tool = ToolAt {
            flange_from_tool: &Isometry::identity(),
            near: None,
            home: None,
        };
        let position = Vector3::new(0.65 * reach, 0.0, 0.4 * reach);
        let down = tool_orientation(-Vector3::z_axis(), 0.0);
        let found = postures(&robot, &Isometry::from_parts(position.into(), down), tool).unwrap();
        let nominal = robot.nominal_branch();
        let inside = found.iter().any(|posture| {
            let margin = robot.limit_margin(&posture.joints);
            posture
                .name
                .branch()
                .is_some_and(|branch| nominal.matches(branch))
                && margin.is_none_or(|(_, m)| m > 0.0)
        });
        assert!(
            inside,
            "{}: no posture {nominal} inside limits at {position:?} m",
            entry.name
        );
    }
}

#[test]
fn tx200_is_posed_as_in_its_source() {
    // Published: TCP of q = (-90, 30, 95, 0, 0, 0) deg, tool (0.277, 0, 0.326; 0, 1.3089969, 0) on the flange.
    let tool = from_xyz_and_fixed_angles(
        Vector3::new(0.277, 0.0, 0.326),
        Vector3::new(0.0, 1.308_996_9, 0.0),
    );
    let q = [-90.0_f64, 30.0, 95.0, 0.0, 0.0, 0.0].map(f64::to_radians);
    let tcp = posture_at(&robot("staubli/tx200"), &q, &tool)
        .base_from_tool
        .translation
        .vector;
    assert_near(
        tcp * 1e3,
        [0.0, -1_647.400_025_592_229_6, 480.698_121_343_784_3],
        1e-9,
    );
}

#[test]
fn fanuc_r2000ic_counts_joint_3_from_the_horizontal() {
    // J2 turns the upper arm; with J3 constant on the pendant the forearm keeps its direction.
    let forearm = |j2: f64| {
        let q = [0.0, j2, 20.0, 0.0, 0.0, 0.0];
        let elbow = [
            312.0 + 1075.0 * j2.to_radians().sin(),
            0.0,
            670.0 + 1075.0 * j2.to_radians().cos(),
        ];
        flange_mm("fanuc/r2000ic", &q) - Vector3::from(elbow)
    };
    assert!((forearm(0.0) - forearm(35.0)).norm() < 1e-9);
    assert!(
        (flange_mm("fanuc/r2000ic", &[0.0; 6])
            - Vector3::new(312.0 + 1280.0 + 215.0, 0.0, 670.0 + 1075.0 + 225.0))
        .norm()
            < 1e-9
    );
}

#[test]
fn ur_arms_follow_the_closed_form_of_their_dh_rows() {
    // x and z of the flange with J1 = 0, where the arm stays in planes y = const:
    // x = a2 c2 + a3 c23 + d5 s234 - d6 s5 c234, y = -d4 - d6 c5, z = d1 + a2 s2 + a3 s23 - d5 c234 - d6 s5 s234.
    for (name, [d1, a2, a3, d4, d5, d6]) in [
        (
            "universal-robots/ur10e",
            [180.7, -612.7, -571.55, 174.15, 119.85, 116.55],
        ),
        (
            "universal-robots/ur10",
            [127.3, -612.0, -572.3, 163.941, 115.7, 92.2],
        ),
    ] {
        let (q2, q3, q4, q5): (f64, f64, f64, f64) = (-50.0, 80.0, -35.0, 65.0);
        let (s2, c2) = q2.to_radians().sin_cos();
        let (s23, c23) = (q2 + q3).to_radians().sin_cos();
        let (s234, c234) = (q2 + q3 + q4).to_radians().sin_cos();
        let (s5, c5) = q5.to_radians().sin_cos();
        let expected = [
            a2 * c2 + a3 * c23 + d5 * s234 - d6 * s5 * c234,
            -d4 - d6 * c5,
            d1 + a2 * s2 + a3 * s23 - d5 * c234 - d6 * s5 * s234,
        ];
        assert_near(flange_mm(name, &[0.0, q2, q3, q4, q5, 17.0]), expected, 1e-9);
    }
}

#[test]
fn the_iiwa_is_upright_at_zero_and_leans_forward_by_its_second_joint() {
    let name = "kuka/lbr-iiwa-14-r820";
    assert_near(flange_mm(name, &[0.0; 7]), [0.0, 0.0, 1306.0], 1e-9);
    assert_near(
        flange_mm(name, &[0.0, 90.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        [946.0, 0.0, 360.0],
        1e-9,
    );
    // A4 turns against A2: it brings a level forearm back up.
    assert_near(
        flange_mm(name, &[0.0, 90.0, 0.0, 90.0, 0.0, 0.0, 0.0]),
        [420.0, 0.0, 360.0 + 526.0],
        1e-9,
    );
}

#[test]
fn only_arms_with_a_published_stiffness_have_a_compliance() {
    let known: Vec<&str> = library::ROBOTS
        .iter()
        .map(|entry| entry.name)
        .filter(|name| robot(name).compliance().is_some())
        .collect();
    assert_eq!(
        known,
        [
            "fanuc/r2000ic",
            "kuka/kr210r2700extra",
            "staubli/tx200",
            "yaskawa/mh12"
        ]
    );
}

/// Poses an arm; 100 000 where `ARMILL_ROUND_TRIPS` says so.
const ROUND_TRIPS: usize = 3000;
const PRIMES: [f64; 7] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0];

#[test]
fn every_arm_gives_back_the_joints_that_made_the_pose() {
    let count = std::env::var("ARMILL_ROUND_TRIPS").map_or(ROUND_TRIPS, |count| count.parse().unwrap());
    let tool = from_xyz_and_fixed_angles(Vector3::new(0.05, -0.02, 0.15), Vector3::new(0.3, -0.2, 0.1));
    for entry in library::ROBOTS {
        let robot = robot(entry.name);
        let (mut poses, mut returned) = (0, 0);
        for trip in 0..count {
            // A step of its own for each joint, the root of a prime: nothing repeats.
            let part = |i: usize| ((trip + 1) as f64 * PRIMES[i].sqrt()).fract();
            let within = |(i, joint): (usize, &armill_core::robot::Joint)| {
                // Joints without published limits turn once.
                let [lower, upper] = joint
                    .limits
                    .map_or([-PI, PI], |limits| [limits.lower, limits.upper]);
                lower + (upper - lower) * part(i)
            };
            let q: Vec<f64> = robot.joints().iter().enumerate().map(within).collect();
            let made = posture_at(&robot, &q, &tool);
            if made.singularity.is_some() {
                continue;
            }
            poses += 1;
            // A redundant joint keeps its position.
            let at = ToolAt {
                flange_from_tool: &tool,
                near: None,
                home: (q.len() > 6).then_some(&q[..]),
            };
            let found = postures(&robot, &made.base_from_tool, at).unwrap_or_default();
            let same = |a: &f64, b: &f64| (0.5 * (a - b)).sin().abs() < 5e-7;
            let is_back = |joints: &[f64]| joints.iter().zip(&q).all(|(a, b)| same(a, b));
            returned += usize::from(found.iter().any(|posture| is_back(&posture.joints)));
        }
        assert!(poses > count / 2, "{}: {poses} of {count} poses", entry.name);
        assert!(
            returned as f64 > 0.999 * poses as f64,
            "{}: {returned} of {poses}",
            entry.name
        );
    }
}

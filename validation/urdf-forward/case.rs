//! Robots read from URDF, compared with an evaluation of the tree independent of armill. See README.md.
//!
//! Two questions: does the reader of URDF put the flange where the text does, and are the robots of the library
//! those of the files? Poses are compared by the distance of their origins (m) and the angle between their axes
//! (rad).

mod tree;

use nalgebra::{Matrix3, Matrix4};

use armill_core::frame::Isometry;
use armill_core::robot::Robot;
use armill_core::robot::inverse::posture_at;
use armill_formats::robot::urdf;

use crate::arms;
use crate::check::{Check, ErrorBound, worst};
use crate::random::Random;

const REFERENCE: &str = "4 x 4 products along the URDF";
const SEED: u64 = 5;
/// Postures a file.
const POSTURES: usize = 1000;

/// The files of the case, written by us from the numbers that the page names.
const MH12: &str = include_str!("mh12.urdf");
const KR120: &str = include_str!("kr120r2500pro.urdf");
const OBLIQUE: &str = include_str!("oblique.urdf");

/// How far (m, rad) `robot` puts its flange from where the text does, at worst over random postures; infinite
/// where the two do not have as many joints.
fn apart(robot: &Robot, text: &str) -> [f64; 2] {
    let parsed = urdf_rs::read_from_string(text).expect("it is a URDF");
    let count = tree::moving_joints(&parsed);
    if count != robot.joints().len() {
        return [f64::INFINITY; 2];
    }
    // The same number of random values is used for each posture of any arm, so that arms share their numbers.
    let mut random = Random::seeded(SEED);
    let (metres, radians) = (0..POSTURES)
        .map(|_| {
            let positions = &random.joints::<8>()[..count];
            let expected = tree::root_from_tool0(&parsed, positions);
            let found = posture_at(robot, positions, &Isometry::identity())
                .base_from_tool
                .to_homogeneous();
            between(&found, &expected)
        })
        .unzip::<f64, f64, Vec<f64>, Vec<f64>>();
    [worst(metres), worst(radians)]
}

/// Distance (m) and angle (rad, small) between two frames; the angle to second order.
fn between(a: &Matrix4<f64>, b: &Matrix4<f64>) -> (f64, f64) {
    let rotation = |m: &Matrix4<f64>| -> Matrix3<f64> { m.fixed_view::<3, 3>(0, 0).into() };
    let turn = rotation(a) * rotation(b).transpose();
    // A rotation by a small angle differs from the identity by sqrt(2) times the angle.
    let angle = (turn - Matrix3::identity()).norm() / 2.0_f64.sqrt();
    ((a.column(3) - b.column(3)).norm(), angle)
}

/// The robot of this text as armill reads it.
fn read(name: &str, text: &str) -> Robot {
    match urdf::read(name, name, text) {
        Ok(described) => described.robot,
        Err(problems) => unreachable!("a URDF of this case is sound: {problems}"),
    }
}

/// Poses of the flange against those of the other reader of URDF.
pub fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for (title, text) in [
        ("Yaskawa MH12", MH12),
        ("KUKA KR 120 R2500 pro", KR120),
        (
            "oblique axes, rotated origins, a prismatic joint, a mimic branch",
            OBLIQUE,
        ),
    ] {
        let [metres, radians] = apart(&read(title, text), text);
        let what = format!("{title}: URDF as read, {POSTURES} random postures");
        checks.push(Check::computed(
            what,
            REFERENCE,
            ErrorBound {
                worst: metres,
                tolerance: 1e-12,
                unit: "m",
            },
        ));
        let what = "its flange orientation".to_owned();
        checks.push(Check::computed(
            what,
            REFERENCE,
            ErrorBound {
                worst: radians,
                tolerance: 1e-12,
                unit: "rad",
            },
        ));
    }
    // The library turns by a whole quarter where the source cuts it after the eleventh decimal.
    for (name, text, [m, rad]) in [
        ("yaskawa/mh12", MH12, [1e-12, 1e-12]),
        ("kuka/kr120r2500pro", KR120, [1e-9, 1e-6]),
    ] {
        let [metres, radians] = apart(&arms::library(name), text);
        let what = format!("library robot {name} compared with the URDF");
        checks.push(Check::computed(
            what,
            REFERENCE,
            ErrorBound {
                worst: metres,
                tolerance: m,
                unit: "m",
            },
        ));
        let what = "its flange orientation".to_owned();
        checks.push(Check::computed(
            what,
            REFERENCE,
            ErrorBound {
                worst: radians,
                tolerance: rad,
                unit: "rad",
            },
        ));
    }
    checks
}

#[cfg(test)]
mod tests;

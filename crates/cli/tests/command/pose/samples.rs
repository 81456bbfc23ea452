//! Robot files from elsewhere: every one answers.

use serde_json::Value;

use super::postures;
use crate::cell::{Cell, apart_deg, numbers};

/// Robots published by others, read from their folder.
#[test]
fn every_sample_urdf_answers_and_its_inverse_leads_back_to_the_joints() {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return;
    };
    let mut seen = 0;
    for maker in ["kuka", "abb", "staubli"] {
        let folder = std::path::Path::new(&samples).join("robots").join(maker);
        let entries =
            std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for file in entries
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "urdf"))
        {
            seen += 1;
            check_sample(file.to_str().unwrap());
        }
    }
    assert!(seen > 0, "no sample at all");
}

fn check_sample(file: &str) {
    let cell = Cell::new();
    let robot = cell.armill(&["robots", file, "--json"]).fine().json();
    // A quarter of the way from the lower to the upper limit: away from singularities and from symmetry.
    let quarter = |joint: &Value| {
        let limits = numbers(&joint["limits_deg"]);
        0.75 * limits[0] + 0.25 * limits[1]
    };
    let joints: Vec<f64> = robot["joints"].as_array().unwrap().iter().map(quarter).collect();
    let list = joints.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let posture = postures(&cell, &[file, "--joints-deg", &list]).remove(0);
    assert_eq!(posture["within_limits"], true, "{file}");
    if robot["inverse"] != "closed_form" {
        println!("{file}: {}", robot["inverse"]);
        return;
    }
    let (axis, spin) = axis_and_spin_deg(&numbers(&posture["tool"]["quaternion_wxyz"]));
    let comma = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let at = comma(&numbers(&posture["tool"]["xyz_mm"]));
    let flags = [
        file,
        "--at-mm",
        &at,
        "--axis",
        &comma(&axis),
        "--spin-deg",
        &spin.to_string(),
    ];
    let found = postures(&cell, &flags);
    let same = found.iter().map(|other| {
        let other = numbers(&other["joints_deg"]);
        joints
            .iter()
            .zip(other)
            .map(|(a, b)| apart_deg(*a, b))
            .fold(0.0, f64::max)
    });
    let nearest = same.fold(f64::INFINITY, f64::min);
    // The inverse checks itself to 1e-9 m and rad; the wrist is some 0.3 rad from singular: 1e-8 rad, 1e-6 deg.
    assert!(
        nearest < 1e-6,
        "{file}: nearest posture {nearest} deg away of {} postures",
        found.len()
    );
    println!("{file}: {} postures, nearest {nearest:.1e} deg away", found.len());
}

/// Tool axis and spin of an orientation: tool z, and the turn of tool y from where it is nearest to base y.
fn axis_and_spin_deg(q: &[f64]) -> ([f64; 3], f64) {
    let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
    let axis = [
        2.0 * (x * z + w * y),
        2.0 * (y * z - w * x),
        1.0 - 2.0 * (x * x + y * y),
    ];
    let second = [
        2.0 * (x * y - w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z + w * x),
    ];
    // Base y without its part along the axis, and the direction a quarter turn on; both as long.
    let nearest = [-axis[1] * axis[0], 1.0 - axis[1] * axis[1], -axis[1] * axis[2]];
    let beyond = [-axis[2], 0.0, axis[0]];
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    (
        axis,
        dot(&second, &beyond).atan2(dot(&second, &nearest)).to_degrees(),
    )
}

//! `armill pose` against printed numbers and against itself.
//!
//! `answers`: what it says of a pose; `consistent`: one answer follows from another; `samples`: real robot files.

mod answers;
mod consistent;
mod samples;

use serde_json::Value;

use crate::cell::{Cell, apart_deg, numbers};

/// Postures of `armill pose ... --json`.
fn postures(cell: &Cell, arguments: &[&str]) -> Vec<Value> {
    let answer = cell
        .armill(&[&["pose", "--json"], arguments].concat())
        .fine()
        .json();
    answer["postures"].as_array().unwrap().clone()
}

fn mh12(arguments: &[&str]) -> Vec<Value> {
    postures(&Cell::new(), &[&["yaskawa/mh12"], arguments].concat())
}

fn of_branch<'a>(postures: &'a [Value], branch: &str) -> &'a Value {
    postures
        .iter()
        .find(|posture| posture["branch"] == branch)
        .unwrap_or_else(|| panic!("no branch `{branch}`"))
}

/// Largest difference of two lists.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Joints that say the same posture, whole turns taken off; deg. Closed forms keep some 1e3 eps of a turn.
const SAME_JOINTS_DEG: f64 = 360.0 * 1e3 * f64::EPSILON;

#[track_caller]
fn assert_same_joints(a: &Value, b: &Value) {
    for (a, b) in numbers(&a["joints_deg"]).iter().zip(numbers(&b["joints_deg"])) {
        assert!(apart_deg(*a, b) < SAME_JOINTS_DEG, "{a} deg and {b} deg");
    }
}

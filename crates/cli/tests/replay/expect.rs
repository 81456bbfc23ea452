//! Short programs and what is expected of them.

use crate::event::{Action, JointMove, LinearMove};
use crate::pose::Pose;
use crate::replay::{Language, run};

/// The actions of a program in files.
#[track_caller]
pub fn actions(language: Language, files: &[(&str, &str)], main: &str) -> Vec<Action> {
    match run(language, files, main) {
        Ok(events) => events.into_iter().map(|event| event.action).collect(),
        Err(error) => panic!("{error}"),
    }
}

/// The error of a program in files.
#[track_caller]
pub fn refusal(language: Language, files: &[(&str, &str)], main: &str) -> String {
    match run(language, files, main) {
        Ok(events) => panic!("{events:?}"),
        Err(error) => error.to_string(),
    }
}

/// An output that changes.
pub fn output(name: &str, value: &str, moving: bool) -> Action {
    Action::Output {
        name: name.to_owned(),
        value: value.to_owned(),
        moving,
    }
}

pub fn linears(actions: &[Action]) -> Vec<&LinearMove> {
    actions.iter().filter_map(Action::linear).collect()
}

pub fn joints(actions: &[Action]) -> Vec<&JointMove> {
    let mut found = Vec::new();
    for action in actions {
        if let Action::Joint(joint) = action {
            found.push(joint);
        }
    }
    found
}

/// That two poses are one, within these tolerances.
#[track_caller]
pub fn same_within(found: &Pose, expected: &Pose, mm: f64, deg: f64) {
    assert!(
        found.distance_mm(expected) <= mm && found.angle_deg(expected) <= deg,
        "{found:?}\n{expected:?}"
    );
}

/// That two poses are one.
#[track_caller]
pub fn same(found: &Pose, expected: &Pose) {
    same_within(found, expected, 1e-6, 1e-6);
}

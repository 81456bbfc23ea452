//! Checks that all candidates compute the same: without it a ratio has no meaning.
//!
//! Relative differences against the yardstick: armill within 1e-9, peers within 1e-6. Angles are compared as
//! turns: a whole turn more is the same angle. Distances of parry are compared with those of armill.

use std::f64::consts::TAU;

use armill_core::kernel::evaluate;
use armill_core::kernel::lanes::Precision;
use armill_core::watch::Watch;

use crate::armill::{Arm, ONE_POSTURE, isometry};
use crate::workload::Pose;
use crate::{lanes, peers, yardstick};

/// How far armill may be from the yardstick.
const ARMILL: f64 = 1e-9;
/// How far it may be in single precision.
const SINGLE: f64 = 1e-3;
/// How far a peer may be from the yardstick.
const PEER: f64 = 1e-6;

/// How far a distance of parry may be from that of armill, m: where its iterations stop.
const PARRY: f64 = 1e-5;

/// Checks armill and every peer on `poses`; reports the difference of each.
///
/// # Errors
/// The candidate that differs by more than allowed, and by how much.
pub fn check(arm: &Arm, poses: &[Pose]) -> Result<Vec<String>, String> {
    let mut found = vec![
        ("armill lanes f64, dev", lanes_apart::<f64>(arm, poses), ARMILL),
        ("armill lanes f32, dev", lanes_apart::<f32>(arm, poses), SINGLE),
        ("armill evaluate, dev", deviations(arm, poses), ARMILL),
        ("armill postures, ik8 and C66", branches(arm, poses), ARMILL),
    ];
    found.extend(
        peers::differences(poses)
            .into_iter()
            .map(|(who, by)| (who, by, PEER)),
    );
    found.push(("parry3d-f64, distances in m", peers::parry::difference(), PARRY));
    let wrong = found.iter().find(|(_, by, allowed)| by.is_nan() || by > allowed);
    if let Some((who, by, allowed)) = wrong {
        return Err(format!("{who} differs by {by:.1e}, allowed {allowed:.0e}"));
    }
    let said = |(who, by, _): &(&str, f64, f64)| format!("{who}: differs by {by:.1e}");
    Ok(found.iter().map(said).collect())
}

/// Largest relative difference of two equally long lists, against the largest of the second.
pub fn relative(ours: &[f64], theirs: &[f64]) -> f64 {
    let scale = theirs.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let apart = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs());
    worst(apart) / scale
}

/// Largest difference of two lists of angles, rad, whole turns aside.
pub fn apart(ours: &[f64; 6], theirs: &[f64; 6]) -> f64 {
    let turns = ours.iter().zip(theirs).map(|(a, b)| (a - b) / TAU);
    worst(turns.map(|turns| (turns - turns.round()).abs() * TAU))
}

/// The largest, or NaN if one is NaN: NaN must not pass as small.
pub fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    let values = values.into_iter();
    values.fold(0.0, |worst: f64, value| {
        if worst.is_nan() || value <= worst {
            worst
        } else {
            value
        }
    })
}

fn lanes_apart<T: Precision>(arm: &Arm, poses: &[Pose]) -> f64 {
    let ours = lanes::envelopes::<T>(&arm.question(ONE_POSTURE), poses);
    let each = poses.iter().zip(ours);
    worst(each.map(|(pose, ours)| relative(&[ours], &[yardstick::dev(pose)])))
}

fn deviations(arm: &Arm, poses: &[Pose]) -> f64 {
    let question = arm.question(ONE_POSTURE);
    let answers = evaluate(&question, poses.len(), |i| isometry(&poses[i]), Watch::NONE);
    let Ok(answers) = answers else { return f64::NAN };
    let each = poses.iter().zip(&answers.points).map(|(pose, point)| {
        let ours = point.as_ref().map_or(f64::NAN, |evaluation| evaluation.in_plane);
        relative(&[ours], &[yardstick::dev(pose)])
    });
    worst(each)
}

fn branches(arm: &Arm, poses: &[Pose]) -> f64 {
    use armill_core::robot::Branch;
    worst(poses.iter().map(|pose| {
        let found = arm.postures(&isometry(pose));
        let theirs = yardstick::ik8(pose);
        let in_reach = theirs.iter().filter(|joints| joints[1].is_finite()).count();
        if in_reach != found.len() {
            return f64::NAN;
        }
        worst(found.iter().map(|(branch, joints, compliance)| {
            let index = Branch::ALL.iter().position(|other| other == branch).unwrap_or(0);
            let matrix = yardstick::c66_at(joints);
            worst([apart(joints, &theirs[index]), relative(compliance, &matrix)])
        }))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload::poses;

    #[test]
    fn all_agree_with_the_yardstick() {
        check(&Arm::mh12(), &poses(200)).unwrap();
    }

    #[test]
    fn yardstick_is_consistent_with_itself() {
        for pose in poses(200) {
            let (joints, all) = (yardstick::joints(&pose), yardstick::dev8(&pose));
            assert!(relative(&yardstick::c66_at(&joints), &yardstick::c66(&pose)) < 1e-12);
            assert!((yardstick::dev_at(&joints) - yardstick::dev(&pose)).abs() < 1e-15);
            // The flip leaves the compliance, and so the deviation, as it is.
            assert!((all[0] - all[1]).abs() < 1e-15 && (all[0] - yardstick::dev(&pose)).abs() < 1e-15);
        }
    }

    #[test]
    fn what_is_no_number_does_not_pass() {
        assert!(worst([1.0, f64::NAN, 0.5]).is_nan());
        assert!(relative(&[f64::NAN], &[1.0]).is_nan());
    }

    #[test]
    fn a_whole_turn_is_no_difference() {
        assert!(apart(&[TAU, 0.0, 0.0, 0.0, 0.0, -TAU], &[0.0; 6]) < 1e-15);
    }
}

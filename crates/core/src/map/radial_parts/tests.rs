use std::sync::Arc;

use nalgebra::{DMatrix, Point3};

use super::*;
use crate::arms;
use crate::kernel::BranchChoice;
use crate::load::InputUncertainty;
use crate::map::along_path;
use crate::path::{Placing, Shape, Spin};
use crate::robot::{Amount, Backlash, BacklashSide, JointCompliance, Motion, Robot};
use crate::source::StiffnessModel;
use crate::workpiece::Plane;

/// A circle of 0.1 m off the middle of a tilted plate, so that all joints move.
fn track() -> Track {
    let plane = Plane::tilted(Point3::new(0.9, 0.15, 0.5), 0.6);
    Track {
        path: Shape::Circle {
            centre: Point2::origin(),
            radius: 0.1,
        }
        .sampled(5e-3),
        placing: Placing {
            spin: Spin::Fixed(0.3),
            ..Placing::on_plane(&plane)
        },
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

fn push(forces: &[[f64; 3]]) -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: forces
            .iter()
            .map(|force| Wrench::from_force((*force).into()))
            .collect(),
    })
}

/// With an uncertainty of a tenth.
fn compliance(robot: &Robot) -> Vec<JointCompliance> {
    let uncertain = |c: &JointCompliance| JointCompliance {
        standard_uncertainty: 0.1 * c.value,
        ..*c
    };
    robot.compliance().unwrap().iter().map(uncertain).collect()
}

/// The outward deviation of the first case, its part without load, and the curves of its uncertain inputs.
fn reported(
    robot: &Robot,
    compliance: &[JointCompliance],
    model: &StiffnessModel,
    uncertainty: InputUncertainty,
    load: &PathLoad,
) -> (Vec<f64>, Option<WithoutLoad>, Vec<Vec<f64>>) {
    let tool = arms::bent_tool();
    let arm = Arm {
        robot,
        compliance,
        model,
        flange_from_tool: &tool,
    };
    let question = Question {
        choice: BranchChoice::Of(robot.nominal_branch()),
        uncertainty,
        ..Question::unloaded(arm, None)
    };
    let track = track();
    let along = along_path(&question, &track, load.clone(), Watch::NONE).unwrap();
    let centre = Point2::origin();
    let outward = radial_deviations(&track, &along.answers, centre)[0]
        .outward
        .clone();
    let without = radial_without_load(&question, &track, &along, centre, Watch::NONE).unwrap();
    let uncertainties = radial_uncertainties(&question, &track, &along, centre, load.case_count());
    (outward, without, uncertainties)
}

fn farthest_apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter()
        .zip(other)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

const FORCE: [f64; 3] = [40.0, 25.0, -60.0];

#[test]
fn without_backlash_and_geometry_the_effect_of_the_load_remains() {
    let robot = arms::mh12();
    let springs = compliance(&robot);
    let plain = reported(
        &robot,
        &springs,
        StiffnessModel::DRIVES,
        InputUncertainty::NONE,
        &push(&[FORCE]),
    );
    assert_eq!(plain.1, None);
    let mut motions = robot.chain().motions().to_vec();
    for motion in &mut motions {
        if let Motion::Along(_, Amount::Constant(length)) = motion {
            *length += 2e-4;
        }
    }
    let mut model = StiffnessModel::DRIVES.clone();
    model.actual = Some(Arc::new(
        Robot::new("actual", motions, robot.joints().to_vec()).unwrap(),
    ));
    let gap = Backlash {
        gap: 2e-4,
        standard_uncertainty: 0.0,
        side: BacklashSide::Motion,
    };
    model.structure.backlash = vec![Some(gap); 6];
    let (loaded, without, _) = reported(&robot, &springs, &model, InputUncertainty::NONE, &push(&[FORCE]));
    let without = without.unwrap().outward;
    let load: Vec<f64> = loaded.iter().zip(&without).map(|(all, own)| all - own).collect();
    assert!(farthest_apart(&load, &plain.0) < 1e-15);
    // They are not negligible: a good part of the effect of the load, and more.
    assert!(farthest_apart(&loaded, &plain.0) > 5e-5);
    // They do not depend on the load.
    let other = reported(
        &robot,
        &springs,
        &model,
        InputUncertainty::NONE,
        &push(&[[-9.0, 70.0, 5.0]]),
    );
    assert!(farthest_apart(&other.1.unwrap().outward, &without) < 1e-15);
}

#[test]
fn a_change_of_the_backlash_moves_the_unloaded_circle_as_its_curve_predicts() {
    let robot = arms::mh12();
    let springs = compliance(&robot);
    let play = |gap: f64, standard_uncertainty| Backlash {
        gap,
        standard_uncertainty,
        side: BacklashSide::Motion,
    };
    let of = |gaps: [Backlash; 2]| {
        let mut model = StiffnessModel::DRIVES.clone();
        model.structure.backlash = vec![Some(gaps[0]), None, Some(gaps[1])];
        let reported = reported(&robot, &springs, &model, InputUncertainty::NONE, &push(&[FORCE]));
        reported.1.unwrap()
    };
    let as_is = of([play(2e-4, 3e-5), play(4e-4, 0.0)]);
    // A backlash without uncertainty has no curve.
    assert_eq!(as_is.uncertainties.len(), 1);
    let off = of([play(2.3e-4, 0.0), play(4e-4, 0.0)]);
    let change: Vec<f64> = (off.outward.iter().zip(&as_is.outward))
        .map(|(off, is)| off - is)
        .collect();
    // Where the link crosses its backlash the effect is not proportional: a few points at the reversals.
    let apart = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-12;
    let crossing = (change.iter().zip(&as_is.uncertainties[0]))
        .filter(|pair| apart(*pair))
        .count();
    assert!(
        crossing <= 4 && change.len() > 100,
        "{crossing} of {}",
        change.len()
    );
    assert!(change.iter().any(|by| by.abs() > 5e-6));
}

#[test]
fn a_curve_is_the_change_by_one_standard_uncertainty_of_its_compliance() {
    let robot = arms::mh12();
    let springs = compliance(&robot);
    let load = push(&[FORCE]);
    let of = |springs: &[JointCompliance]| {
        reported(
            &robot,
            springs,
            StiffnessModel::DRIVES,
            InputUncertainty::NONE,
            &load,
        )
        .0
    };
    let as_is = of(&springs);
    let curves = reported(
        &robot,
        &springs,
        StiffnessModel::DRIVES,
        InputUncertainty::NONE,
        &load,
    )
    .2;
    assert_eq!(curves.len(), 6);
    for (joint, curve) in curves.iter().enumerate() {
        let mut off = springs.clone();
        off[joint].value += off[joint].standard_uncertainty;
        let change: Vec<f64> = of(&off).iter().zip(&as_is).map(|(off, is)| off - is).collect();
        // The deviation is linear in a compliance.
        assert!(farthest_apart(curve, &change) < 1e-15, "{joint}");
    }
}

#[test]
fn of_several_cases_the_mean_is_used_and_opposite_ones_cancel() {
    let robot = arms::mh12();
    let springs = compliance(&robot);
    let of = |forces: &[[f64; 3]]| {
        reported(
            &robot,
            &springs,
            StiffnessModel::DRIVES,
            InputUncertainty::NONE,
            &push(forces),
        )
        .2
    };
    let opposite = of(&[FORCE, FORCE.map(|f| -f)]);
    let one = of(&[FORCE]);
    for (curve, of_one) in opposite.iter().zip(&one) {
        let least = curve.iter().fold(0.0_f64, |most, by| most.max(by.abs()));
        let most = of_one.iter().fold(0.0_f64, |most, by| most.max(by.abs()));
        assert!(least < 1e-12 * most.max(1e-9), "{least} {most}");
    }
}

#[test]
fn correlated_compliances_move_the_circle_as_their_covariance_predicts() {
    let robot = arms::mh12();
    let springs = compliance(&robot);
    let load = push(&[FORCE]);
    let alone = reported(
        &robot,
        &springs,
        StiffnessModel::DRIVES,
        InputUncertainty::NONE,
        &load,
    )
    .2;
    // All six change together by their uncertainties: one input, the sum of the curves.
    let u: Vec<f64> = springs.iter().map(|c| c.standard_uncertainty).collect();
    let mut model = StiffnessModel::DRIVES.clone();
    model.structure.covariance = Some(DMatrix::from_fn(6, 6, |i, j| u[i] * u[j]));
    let together = reported(&robot, &springs, &model, InputUncertainty::NONE, &load).2;
    for k in 0..alone[0].len() {
        let sum: f64 = alone.iter().map(|curve| curve[k]).sum();
        let found = together
            .iter()
            .map(|curve| curve[k] * curve[k])
            .sum::<f64>()
            .sqrt();
        assert!((found - sum.abs()).abs() < 1e-9 * 1e-4, "{k}: {found} {sum}");
    }
}

#[test]
fn an_uncertain_load_and_a_model_error_scale_the_whole_curve() {
    let robot = arms::mh12();
    let exact: Vec<JointCompliance> = compliance(&robot)
        .iter()
        .map(|c| JointCompliance {
            standard_uncertainty: 0.0,
            ..*c
        })
        .collect();
    let uncertainty = InputUncertainty {
        relative: 0.05,
        ..InputUncertainty::NONE
    };
    let mut missing = StiffnessModel::DRIVES.clone();
    missing.structure.model_error = 0.05;
    for (model, uncertainty) in [
        (StiffnessModel::DRIVES, uncertainty),
        (&missing, InputUncertainty::NONE),
    ] {
        let (outward, _, curves) = reported(&robot, &exact, model, uncertainty, &push(&[FORCE]));
        assert_eq!(curves.len(), 1);
        let scaled: Vec<f64> = outward.iter().map(|by| 0.05 * by).collect();
        assert!(farthest_apart(&curves[0], &scaled) < 1e-16);
    }
}

//! The full model at many points: maps and known joints agree with `predict`.

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::kernel::{BranchChoice, Question, evaluate, evaluate_at_joints};
use armill_core::load::InputUncertainty;
use armill_core::nalgebra::{DMatrix, Unit, Vector3};
use armill_core::predict::predict;
use armill_core::robot::Structure;
use armill_core::source::{Arm, ArmState, Links, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

use crate::{arms, fanuc_masses, full_arm, springs, weighing};

#[test]
fn maps_and_known_joints_agree_with_predict_on_any_number_of_threads() {
    let (robot, tool) = (arms::mh12(), arms::bent_tool());
    let mut structure = Structure {
        springs: springs(),
        masses: fanuc_masses(),
        ..Structure::EMPTY
    };
    structure.covariance = Some(DMatrix::identity(12, 12) * 1e-14);
    let mut model = weighing(structure);
    model.load_dependent = true;
    let cases = [
        Wrench::from_force(Vector3::new(3.0, 20.0, 5.0)),
        Wrench {
            force: Vector3::new(-20.0, 4.0, 1.0),
            moment: Vector3::new(0.4, -1.5, 2.0),
        },
        Wrench::from_force(Vector3::new(3.0, -5.0, 1.0)),
    ];
    let arm = full_arm(&robot, &model, &tool);
    for choice in [
        BranchChoice::Best,
        BranchChoice::Of("front elbow-up".parse().unwrap()),
    ] {
        let question = Question {
            homes: None,
            arm: Arm {
                robot: &robot,
                compliance: robot.compliance().unwrap(),
                model: &model,
                flange_from_tool: &tool,
            },
            home: None,
            uncertainty: InputUncertainty::NONE,
            cases: &cases,
            normal: Unit::new_normalize(Vector3::new(-0.8, 0.3, 0.5)),
            choice,
            clearance: None,
        };
        let pose = |i: usize| {
            let at = Vector3::new(0.8, 0.01 * i as f64 - 0.5, 0.7);
            from_xyz_and_fixed_angles(at, Vector3::new(0.3, 1.2, -0.4))
        };
        let all = evaluate(&question, 100, pose, Watch::NONE).unwrap();
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = one.install(|| evaluate(&question, 100, pose, Watch::NONE).unwrap());
        assert_eq!(all.deviations, again.deviations);
        assert_eq!(all.shares, again.shares);
        assert!(all.evaluations().count() > 50);
        for (i, point) in all.evaluations() {
            let q = all.joints_at(i);
            for (deviation, wrench) in all.deviations_at(i).iter().zip(&cases) {
                let witness = arms::predicted(&arm, q, wrench).unwrap().twist.linear;
                assert!((deviation - witness).norm() < 1e-13, "{deviation} {witness}");
            }
            // Shares add up to first order of a load-dependent model: its turns are some 1e-3 rad.
            let sum: f64 = all.shares_at(i).iter().sum();
            assert_eq!(all.shares_at(i).len(), 9);
            assert!(
                (sum - point.in_plane).abs() < 2e-2 * point.in_plane + 1e-6,
                "{sum} {}",
                point.in_plane
            );
            assert!(point.in_plane_uncertainty.unwrap() > 0.0);
        }
        let arm = Arm {
            robot: &robot,
            compliance: robot.compliance().unwrap(),
            model: &model,
            flange_from_tool: &tool,
        };
        let mut known = vec![0.0; 9 * 100];
        let write = |arm_state: &mut ArmState<'_>, out: &mut [f64]| {
            for (wrench, out) in cases.iter().zip(out.chunks_mut(3)) {
                out.copy_from_slice(
                    predict(arm_state, wrench, &mut Links::Neglected)?
                        .twist
                        .linear
                        .as_slice(),
                );
            }
            Ok(())
        };
        evaluate_at_joints(&arm, &all.joints, &mut known, write, Watch::NONE).unwrap();
        for (i, _) in all.evaluations() {
            for (known, deviation) in known[9 * i..].chunks(3).zip(all.deviations_at(i)) {
                assert!((Vector3::from_column_slice(known) - deviation).norm() < 1e-13);
            }
        }
    }
}

#[test]
fn a_load_without_equilibrium_is_a_state_of_its_points() {
    let (robot, tool) = (arms::mh12(), Isometry::identity());
    let model = StiffnessModel {
        load_dependent: true,
        ..StiffnessModel::DRIVES.clone()
    };
    let cases = [Wrench::from_force(Vector3::new(0.0, 0.0, -1e6))];
    let question = Question {
        homes: None,
        arm: Arm {
            robot: &robot,
            compliance: robot.compliance().unwrap(),
            model: &model,
            flange_from_tool: &tool,
        },
        home: None,
        uncertainty: InputUncertainty::NONE,
        cases: &cases,
        normal: Vector3::z_axis(),
        choice: BranchChoice::Of("front elbow-up".parse().unwrap()),
        clearance: None,
    };
    let pose = |_| from_xyz_and_fixed_angles(Vector3::new(0.9, 0.1, 0.8), Vector3::new(0.0, 1.5, 0.0));
    let found = evaluate(&question, 1, pose, Watch::NONE).unwrap();
    assert_eq!(found.points[0].as_ref().unwrap_err().word(), "unstable");
    assert!(found.deviations.iter().all(|d| *d == Vector3::zeros()));
}

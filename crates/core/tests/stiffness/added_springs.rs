//! Springs in addition to the drives: compliances, shares and covariance against the simple model and its matrices.

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::Isometry;
use armill_core::nalgebra::{DMatrix, IsometryMatrix3, Matrix6, Point3, UnitQuaternion};
use armill_core::robot::inverse::posture_at;
use armill_core::robot::spring::springs_of;
use armill_core::robot::{Attachment, JointCompliance, Mass, Spring, Structure};
use armill_core::source::elastic::predict;
use armill_core::source::{Arm, ArmState, StiffnessModel};
use armill_core::spatial::adjoint;
use proptest::prelude::*;

use crate::{arm, arms, fanuc_masses, full_arm, springs, weighing, wrench};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn parts_that_do_nothing_leave_every_bit_of_the_simple_model(((which, unit), w) in (arm(), wrench())) {
        let robot = &arms::ALL[which];
        let (q, tool) = (arms::positions(robot, &unit), arms::bent_tool());
        let posture = posture_at(robot, &q, &tool);
        let simple = predict(&posture, robot.compliance().unwrap(), &w);
        let rigid = |mut s: Spring| { s.compliance = JointCompliance { value: 0.0, standard_uncertainty: 0.0 }; s };
        let weightless = Mass { attachment: Attachment::Flange, mass: 0.0, centre: Point3::new(0.1, 0.0, 0.0), inertia: None, relative_uncertainty: 0.0, };
        let structure = Structure {
            springs: springs().into_iter().map(rigid).collect(),
            masses: vec![weightless],
            ..Structure::EMPTY
        };
        for model in [StiffnessModel::DRIVES.clone(), weighing(structure)] {
            let full = arms::predicted(&full_arm(robot, &model, &tool), &q, &w).unwrap();
            prop_assert_eq!(full.twist.linear, simple.twist.linear);
            prop_assert_eq!(full.twist.angular, simple.twist.angular);
            for (a, b) in full.shares.iter().zip(&simple.shares) {
                prop_assert!((a.to_vector() - b.to_vector()).amax() <= 4.0 * f64::EPSILON * b.to_vector().amax());
            }
            let rounding = 10.0 * f64::EPSILON * simple.covariance.amax();
            prop_assert!((full.covariance - simple.covariance).amax() <= rounding);
        }
    }

    #[test]
    fn a_spring_of_six_by_six_numbers_is_the_adjoint_of_its_matrix(
        ((which, unit), raw) in (arm(), prop::collection::vec(-1.0..1.0_f64, 36)),
    ) {
        let robot = &arms::ALL[which];
        let (q, tool) = (arms::positions(robot, &unit), arms::bent_tool());
        let posture = posture_at(robot, &q, &tool);
        let tcp = Point3::from(posture.base_from_tool.translation.vector);
        let root = Matrix6::from_iterator(raw);
        let local = root * root.transpose() * 1e-8;
        let frames = armill_core::robot::forward::forward(robot, &q);
        let as_isometry = |f: &IsometryMatrix3<f64>| {
            Isometry::from_parts(f.translation, UnitQuaternion::from_rotation_matrix(&f.rotation))
        };
        let attachments = [
            (Attachment::Base, Isometry::identity()),
            (Attachment::Joint(2), as_isometry(&frames.base_from_joint[2])),
            (Attachment::Flange, as_isometry(&frames.base_from_flange)),
            (Attachment::Tool, posture.base_from_tool),
        ];
        for (attachment, base_from_attachment) in attachments {
            let structure = Structure { springs: springs_of(attachment, &local).unwrap(), ..Structure::EMPTY };
            let model = StiffnessModel { structure, ..StiffnessModel::DRIVES.clone() };
            let arm = full_arm(robot, &model, &tool);
            let mut arm_state = ArmState::new(arm);
            arm_state.set_joints(&q);
            let ad = adjoint(&base_from_attachment, &tcp);
            let drives = compliance_at_tool(&posture.screws, robot.compliance().unwrap());
            let expected = drives + ad * local * ad.transpose();
            let found = arm_state.compliance().unwrap();
            prop_assert!((found - expected).amax() < 1e-13 * expected.amax(), "{attachment:?}");
            // The list of screws and compliances is all that the plain functions need.
            let long = compliance_at_tool(arm_state.screws(), &arm.compliances());
            prop_assert!((long - expected).amax() < 1e-13 * expected.amax());
        }
    }

    #[test]
    fn shares_add_up_and_springs_count_for_their_joint(((which, unit), w) in (arm(), wrench())) {
        let robot = &arms::ALL[which];
        let (q, tool) = (arms::positions(robot, &unit), arms::bent_tool());
        let structure = Structure { springs: springs(), masses: fanuc_masses(), ..Structure::EMPTY };
        let model = weighing(structure);
        let full = arms::predicted(&full_arm(robot, &model, &tool), &q, &w).unwrap();
        prop_assert_eq!(full.shares.len(), 9);
        let sum: armill_core::spatial::Twist = full.shares.iter().copied().sum();
        let longest = full.shares.iter().map(|s| s.linear.norm()).fold(0.0, f64::max);
        prop_assert!((sum.linear - full.twist.linear).norm() < 1e-14 * longest);
        prop_assert_eq!(model.contributor_names(robot.joints())[6..].join(" "), "base flange tool");
    }

    #[test]
    fn known_covariance_goes_through_as_a_s_at(((which, unit), w, raw) in
        (arm(), wrench(), prop::collection::vec(-1.0..1.0_f64, 64)),
    ) {
        let robot = &arms::ALL[which];
        let (q, tool) = (arms::positions(robot, &unit), arms::bent_tool());
        let root = DMatrix::from_iterator(8, 8, raw);
        let s = &root * root.transpose() * 1e-14;
        let structure = Structure { springs: springs(), covariance: Some(s.clone()), ..Structure::EMPTY };
        let model = StiffnessModel { structure, ..StiffnessModel::DRIVES.clone() };
        let arm = full_arm(robot, &model, &tool);
        let found = arms::predicted(&arm, &q, &w).unwrap().covariance;
        // Witness: columns by changing one compliance at a time, the last four springs independent.
        let mut columns = DMatrix::zeros(3, 12);
        for k in 0..12 {
            let mut drives = robot.compliance().unwrap().to_vec();
            let mut more = model.clone();
            let step = 1e-6;
            if k < 6 { drives[k].value += step } else { more.structure.springs[k - 6].compliance.value += step }
            let changed = Arm { compliance: &drives, model: &more, ..arm };
            let by = arms::predicted(&changed, &q, &w).unwrap().twist.linear;
            let from = arms::predicted(&arm, &q, &w).unwrap().twist.linear;
            columns.set_column(k, &((by - from) / step));
        }
        let mut full = DMatrix::zeros(12, 12);
        full.view_mut((0, 0), (8, 8)).copy_from(&s);
        for k in 8..12 {
            full[(k, k)] = model.structure.springs[k - 6].compliance.standard_uncertainty.powi(2);
        }
        let witness = &columns * full * columns.transpose();
        prop_assert!((DMatrix::from_column_slice(3, 3, found.as_slice()) - &witness).amax() < 1e-8 * witness.amax());
    }
}

//! One arm in one posture: its parts, separately and together.

use super::*;
use crate::arms::{self, Stream};
use crate::frame::Isometry;
use crate::load::InputUncertainty;
use crate::robot::inverse::tool_on;
use crate::robot::{Compensator, JointCurve, Mass, Robot, Spring, Structure, TorqueCurve};
use crate::source::StiffnessModel;
use crate::source::stiffness_model::FREE_FALL;

fn spring(value: f64) -> JointCompliance {
    JointCompliance {
        value,
        standard_uncertainty: 0.1 * value,
    }
}

fn springs() -> Vec<Spring> {
    vec![
        Spring::about(Attachment::Joint(1), Vector3::x(), spring(2.4e-7)),
        Spring::about(Attachment::Base, Vector3::y(), spring(4e-8)),
        Spring::along(Attachment::Tool, Vector3::x(), spring(9e-7)),
        Spring::about(Attachment::Joint(4), Vector3::new(0.6, 0.0, 0.8), spring(1e-6)),
    ]
}

fn masses() -> Vec<Mass> {
    let mass = |attachment, mass, z| Mass {
        attachment,
        mass,
        centre: Point3::new(0.1, -0.05, z),
        inertia: None,
        relative_uncertainty: 0.0,
    };
    vec![
        mass(Attachment::Joint(0), 260.0, -0.1),
        mass(Attachment::Joint(1), 150.0, 0.2),
        mass(Attachment::Joint(3), 80.0, 0.0),
        mass(Attachment::Flange, 20.0, 0.1),
    ]
}

fn compensator() -> Compensator {
    Compensator {
        joint: 1,
        fixed_radius: 0.69,
        arm_radius: 0.185,
        angle: 0.17,
        free_length: 0.458,
        stiffness: 4e5,
    }
}

fn curve() -> JointCurve {
    let knee = TorqueCurve::new(vec![
        [-900.0, -1e-3],
        [-300.0, -6e-4],
        [300.0, 6e-4],
        [900.0, 1e-3],
    ]);
    JointCurve {
        rising: knee.unwrap(),
        falling: None,
    }
}

/// Springs, masses, a compensator on joint 2 and a torque curve on joint 3.
fn everything() -> StiffnessModel {
    StiffnessModel {
        structure: Structure {
            springs: springs(),
            masses: masses(),
            motors: Vec::new(),
            damping: None,
            compensator: Some(compensator()),
            curves: vec![None, None, Some(curve())],
            covariance: None,
            backlash: Vec::new(),
            repeatability: 0.0,
            model_error: 0.0,
            learnt: None,
            geometry: None,
        },
        gravity: Some(Gravity {
            acceleration: -Vector3::z() * FREE_FALL,
            reference: vec![0.1, -0.2, 0.3, 0.1, 0.4, 0.0],
        }),
        load_dependent: false,
        ..StiffnessModel::DRIVES.clone()
    }
}

/// The FANUC, with compliances and all parts.
fn robot() -> &'static Robot {
    &arms::ALL[3]
}

fn arm<'a>(model: &'a StiffnessModel, tool: &'a Isometry) -> Arm<'a> {
    Arm {
        robot: robot(),
        compliance: robot().compliance().unwrap(),
        model,
        flange_from_tool: tool,
    }
}

fn wrench(stream: &mut Stream) -> Wrench {
    Wrench {
        force: stream.vector(500.0),
        moment: stream.vector(100.0),
    }
}

/// The deviation by the load and by gravity.
fn by_load(arm_state: &mut ArmState<'_>, wrench: &Wrench) -> Twist {
    let elastic = arm_state.elastic(wrench).unwrap();
    elastic + arm_state.gravity().unwrap().unwrap_or(Twist::ZERO)
}

#[test]
fn sensitivities_match_differences_with_every_part_at_once() {
    let (tool, model) = (arms::bent_tool(), everything());
    let mut stream = Stream(61);
    for _ in 0..10 {
        let (q, w) = (stream.joints(robot()), wrench(&mut stream));
        let arm = arm(&model, &tool);
        let mut arm_state = ArmState::new(arm);
        arm_state.set_joints(&q);
        by_load(&mut arm_state, &w);
        for k in 0..10_usize {
            // A curve replaces the compliance of joint 3.
            if k == 2 {
                continue;
            }
            let changed = |factor: f64| {
                let mut drives = robot().compliance().unwrap().to_vec();
                let mut more = model.clone();
                match k.checked_sub(6) {
                    None => drives[k].value *= factor,
                    Some(spring) => more.structure.springs[spring].compliance.value *= factor,
                }
                let arm = Arm {
                    compliance: &drives,
                    model: &more,
                    ..arm
                };
                arms::predicted(&arm, &q, &w).unwrap().twist.linear
            };
            let step = 1e-4;
            let c = arm.compliances()[k].value;
            let witness = (changed(1.0 + step) - changed(1.0 - step)) / (2.0 * step * c);
            let found = arm_state.sensitivity(k);
            // Only the compensator is not linear: error by the square of the step, and rounding of some mm over the
            // step.
            let rounding = 1e-15 / (step * c);
            assert!(
                (found - witness).norm() < 1e-6 * found.norm() + rounding,
                "{k}: {found} {witness}"
            );
        }
    }
}

#[test]
fn shares_add_up_and_those_along_a_direction_are_their_projections() {
    let (tool, model) = (arms::bent_tool(), everything());
    let mut arm_state = ArmState::new(arm(&model, &tool));
    let mut stream = Stream(62);
    let contributors = model.contributors(6);
    for _ in 0..20 {
        arm_state.set_joints(&stream.joints(robot()));
        let whole = by_load(&mut arm_state, &wrench(&mut stream));
        let shares = arm_state.shares();
        let sum: Twist = shares.iter().copied().sum();
        // Some ten parts of some mm.
        assert!((sum.to_vector() - whole.to_vector()).norm() < 1e-16);
        let along = stream.vector(1.0).normalize();
        // Earlier values are overwritten.
        let mut given = vec![7.0; contributors.len()];
        arm_state.share_along(&along, &contributors, &mut given);
        for (share, given) in shares.iter().zip(&given) {
            assert!((share.linear.dot(&along) - given).abs() < 1e-17);
        }
        assert!((given.iter().sum::<f64>() - whole.linear.dot(&along)).abs() < 1e-16);
    }
}

#[test]
fn the_variance_along_a_direction_is_that_of_the_covariance() {
    let (tool, mut model) = (arms::bent_tool(), everything());
    let mut stream = Stream(63);
    for known in [false, true] {
        model.structure.model_error = if known { 0.3 } else { 0.0 };
        model.structure.covariance = known.then(|| {
            let root = nalgebra::DMatrix::from_fn(7, 7, |i, j| ((3 * i + 5 * j + i * j) % 7) as f64 - 2.5);
            &root * root.transpose() * 1e-15
        });
        let mut arm_state = ArmState::new(arm(&model, &tool));
        arm_state.set_joints(&stream.joints(robot()));
        arm_state.elastic(&wrench(&mut stream)).unwrap();
        let covariance = arm_state.covariance();
        assert!((covariance - covariance.transpose()).norm() < 1e-14 * covariance.norm());
        for _ in 0..20 {
            let along = stream.vector(1.0).normalize();
            let given = arm_state.variance_along(&along);
            assert!(given >= 0.0);
            assert!((along.dot(&(covariance * along)) - given).abs() < 1e-13 * covariance.norm());
        }
    }
}

#[test]
fn the_order_in_which_springs_are_listed_has_no_effect() {
    let (tool, model) = (arms::bent_tool(), everything());
    let mut listed_otherwise = model.clone();
    listed_otherwise.structure.springs.reverse();
    let mut stream = Stream(64);
    let (q, w) = (stream.joints(robot()), wrench(&mut stream));
    let given = [&model, &listed_otherwise].map(|model| arms::predicted(&arm(model, &tool), &q, &w).unwrap());
    assert!((given[0].twist - given[1].twist).to_vector().norm() < 1e-16);
    assert!((given[0].covariance - given[1].covariance).norm() < 1e-13 * given[0].covariance.norm());
    for (a, b) in given[0].shares.iter().zip(&given[1].shares) {
        assert!((*a - *b).to_vector().norm() < 1e-16);
    }
}

#[test]
fn the_tip_compliance_gives_the_deviation_of_any_force_where_it_is_affine() {
    let (tool, mut model) = (arms::bent_tool(), everything());
    model.structure.curves.clear();
    assert!(model.is_affine());
    let mut arm_state = ArmState::new(arm(&model, &tool));
    let mut stream = Stream(65);
    for _ in 0..20 {
        arm_state.set_joints(&stream.joints(robot()));
        let tip = arm_state.tip_compliance().unwrap();
        let block = arm_state
            .compliance()
            .unwrap()
            .fixed_view::<3, 3>(0, 0)
            .into_owned();
        assert!((tip.by_force - block).norm() < 1e-14 * block.norm());
        let force = stream.vector(800.0);
        let found = by_load(&mut arm_state, &Wrench::from_force(force));
        assert!((tip.under(force) - found.linear).norm() < 1e-16);
    }
}

#[test]
fn a_compensator_stiffer_than_its_joint_has_no_equilibrium_under_weight_or_load() {
    let (tool, mut model) = (arms::bent_tool(), everything());
    model.structure.compensator = Some(Compensator {
        stiffness: 1e12,
        angle: 0.0,
        ..compensator()
    });
    let mut arm_state = ArmState::new(arm(&model, &tool));
    let q = [0.1, 0.0, -0.3, 0.4, 0.5, -0.6];
    arm_state.set_joints(&q);
    // The joint would turn without any load: k - dM/dtheta is below zero.
    let slope = model.structure.compensator.unwrap().slope(robot().theta(1, &q));
    assert!(slope * robot().compliance().unwrap()[1].value > 1.0, "{slope}");
    assert_eq!(arm_state.gravity(), Err(Unstable::Buckles));
    assert_eq!(arm_state.elastic(&Wrench::ZERO), Err(Unstable::Buckles));
    assert_eq!(arm_state.compliance(), None);
    assert!(matches!(arm_state.tip_compliance(), Err(Unstable::Buckles)));
}

#[test]
fn without_gravity_no_gravity_is_reported() {
    let (tool, mut model) = (arms::bent_tool(), everything());
    model.gravity = None;
    let mut arm_state = ArmState::new(arm(&model, &tool));
    arm_state.set_joints(&[0.1; 6]);
    assert_eq!(arm_state.gravity(), Ok(None));
    assert!(
        arm_state.gravity_torques()[..1]
            .iter()
            .all(|torque| *torque == 0.0)
    );
}

#[test]
fn setting_a_posture_leaves_nothing_of_the_one_before() {
    let (tool, model) = (arms::bent_tool(), everything());
    let mut stream = Stream(66);
    let mut used = ArmState::new(arm(&model, &tool));
    for _ in 0..5 {
        let (q, w) = (stream.joints(robot()), wrench(&mut stream));
        used.set_joints(&q);
        let again = by_load(&mut used, &w);
        let fresh = arms::predicted(&arm(&model, &tool), &q, &w).unwrap();
        assert_eq!(again, fresh.twist);
        assert_eq!(used.shares(), fresh.shares);
        assert_eq!(used.covariance(), fresh.covariance);
        used.set_joints(&stream.joints(robot()));
    }
}

/// The variance by `uncertainty` along `along`, in one posture under one load.
fn variance_by_inputs(
    arm_state: &mut ArmState<'_>,
    uncertainty: &InputUncertainty,
    along: &Vector3<f64>,
) -> f64 {
    let q = [0.1, 0.5, -0.5, 0.4, 0.5, -0.6];
    let frames = crate::robot::forward::forward(robot(), &q);
    let tool = tool_on(&frames, arm_state.arm().flange_from_tool);
    let wrench = Wrench::from_force(Vector3::new(100.0, 50.0, -300.0));
    let posture = LoadedPosture {
        joints: &q,
        frames: &frames,
        tcp: tool.translation.vector.into(),
        tool_axis: tool.rotation * Vector3::z(),
        wrench: &wrench,
    };
    arm_state.set_frames(&q, &frames, &posture.tcp);
    let before = arm_state.elastic(&wrench).unwrap();
    let variance = arm_state
        .variance_of_inputs(uncertainty, &posture, along)
        .unwrap();
    // The posture is unchanged.
    assert_eq!(arm_state.elastic(&wrench).unwrap(), before);
    variance
}

fn uncertainty() -> InputUncertainty {
    InputUncertainty {
        relative: 0.05,
        forces: [Vector3::x() * 20.0, Vector3::zeros(), Vector3::new(0.0, 3.0, 4.0)],
        tool_length: 1e-4,
    }
}

#[test]
fn twice_the_uncertainty_is_four_times_the_variance() {
    let (tool, model) = (arms::bent_tool(), StiffnessModel::DRIVES);
    let mut arm_state = ArmState::new(arm(model, &tool));
    let along = Vector3::new(0.6, 0.0, -0.8);
    let one = uncertainty();
    let twice = InputUncertainty {
        relative: 2.0 * one.relative,
        forces: one.forces.map(|force| force * 2.0),
        tool_length: 2.0 * one.tool_length,
    };
    let (of_one, of_twice) = (
        variance_by_inputs(&mut arm_state, &one, &along),
        variance_by_inputs(&mut arm_state, &twice, &along),
    );
    // Linear in the load; a longer tool adds a square term, of a lever of some metres by 0.1 mm.
    assert!(
        of_one > 0.0 && (of_twice / of_one - 4.0).abs() < 1e-3,
        "{of_one} {of_twice}"
    );
    assert_eq!(
        variance_by_inputs(&mut arm_state, &InputUncertainty::NONE, &along),
        0.0
    );
}

#[test]
fn input_uncertainties_are_independent_and_each_gives_its_own_change() {
    let (tool, model) = (arms::bent_tool(), StiffnessModel::DRIVES);
    let mut arm_state = ArmState::new(arm(model, &tool));
    let along = Vector3::new(0.6, 0.0, -0.8);
    let all = uncertainty();
    let relative = InputUncertainty {
        forces: [Vector3::zeros(); 3],
        tool_length: 0.0,
        ..all
    };
    let forces = InputUncertainty {
        relative: 0.0,
        tool_length: 0.0,
        ..all
    };
    let length = InputUncertainty {
        relative: 0.0,
        forces: [Vector3::zeros(); 3],
        ..all
    };
    let [whole, of_relative, of_forces, of_length] = [all, relative, forces, length]
        .map(|uncertainty| variance_by_inputs(&mut arm_state, &uncertainty, &along));
    assert!((of_relative + of_forces + of_length - whole).abs() < 1e-14 * whole);
    // The load a twentieth larger: the displacement a twentieth larger.
    let wrench = Wrench::from_force(Vector3::new(100.0, 50.0, -300.0));
    let given = arm_state.elastic(&wrench).unwrap().linear.dot(&along);
    assert!((of_relative.sqrt() - 0.05 * given.abs()).abs() < 1e-12 * given.abs());
    // Forces: the compliance times each of them.
    let block = arm_state
        .compliance()
        .unwrap()
        .fixed_view::<3, 3>(0, 0)
        .into_owned();
    let expected: f64 = all
        .forces
        .iter()
        .map(|force| (block * force).dot(&along).powi(2))
        .sum();
    assert!((of_forces - expected).abs() < 1e-11 * expected);
}

use super::*;
use crate::arms;
use crate::load::InputUncertainty;
use crate::robot::{Backlash, Mass, SmallMotion, Spring, UncertainGeometry};
use crate::sampling::{Draws, Method};
use crate::source::UncertainInput;
use nalgebra::Point3;

/// An arm with every uncertain input of a robot file but a learnt residual.
fn model() -> StiffnessModel {
    let mut model = StiffnessModel::DRIVES.clone();
    let spring = |value, standard_uncertainty| JointCompliance {
        value,
        standard_uncertainty,
    };
    let structure = &mut model.structure;
    structure.springs = vec![
        Spring::about(Attachment::Joint(1), Vector3::x(), spring(4e-7, 1e-7)),
        Spring::about(Attachment::Tool, Vector3::y(), spring(2e-7, 0.0)),
    ];
    // Joints 1 and 3 are correlated, joint 2 is not.
    structure.covariance = Some(DMatrix::from_row_slice(
        3,
        3,
        &[4e-16, 0.0, 3e-16, 0.0, 1e-16, 0.0, 3e-16, 0.0, 9e-16],
    ));
    let backlash = |side| Backlash {
        gap: 1e-4,
        standard_uncertainty: 2e-5,
        side,
    };
    structure.backlash = vec![
        None,
        Some(backlash(BacklashSide::Motion)),
        Some(backlash(BacklashSide::Torque)),
    ];
    structure.masses = vec![Mass {
        attachment: Attachment::Joint(2),
        mass: 30.0,
        centre: Point3::new(0.1, 0.0, 0.2),
        inertia: None,
        relative_uncertainty: 0.2,
    }];
    let motions = [(0, 3), (1, 0), (4, 5)].map(|(after, component)| SmallMotion { after, component });
    let covariance = DMatrix::from_row_slice(3, 3, &[1e-8, 4e-9, 0.0, 4e-9, 2e-8, 0.0, 0.0, 0.0, 3e-8]);
    let geometry = UncertainGeometry::new(motions.to_vec(), &covariance).unwrap();
    structure.geometry = Some(Arc::new(geometry));
    (structure.model_error, structure.repeatability) = (0.05, 2e-5);
    model
}

fn on_arm<T>(model: &StiffnessModel, of: impl Fn(&Arm<'_>) -> T) -> T {
    let (robot, tool) = (&arms::ALL[0], arms::bent_tool());
    of(&Arm {
        robot,
        compliance: robot.compliance().unwrap(),
        model,
        flange_from_tool: &tool,
    })
}

#[test]
fn every_uncertain_input_is_named_with_its_contributors() {
    let space = on_arm(&model(), InputSpace::of);
    let count = |source| {
        space
            .inputs()
            .iter()
            .filter(|input| input.source == source)
            .count()
    };
    // Three joints of the covariance, three others, a spring.
    assert_eq!(count(InputSource::Compliance), 7);
    assert_eq!(count(InputSource::Backlash), 2);
    assert_eq!(count(InputSource::BacklashSide), 1);
    assert_eq!(count(InputSource::Mass), 1);
    assert_eq!(count(InputSource::Geometry), 3);
    assert_eq!(count(InputSource::ModelError), 1);
    assert_eq!(count(InputSource::Repeatability), 3);
    let at = |joints: &[usize]| -> Vec<Contributor> {
        let joints = joints.iter().map(|joint| Attachment::Joint(*joint));
        joints.map(Contributor::At).collect()
    };
    assert_eq!(space.inputs()[0].contributors, at(&[0, 2]));
    assert_eq!(space.inputs()[1].contributors, at(&[0, 2]));
    assert_eq!(space.inputs()[2].contributors, at(&[1]));
    let names = on_arm(&model(), |arm| space.names(arm.robot.joints()));
    let joints = on_arm(&model(), |arm| {
        arm.robot
            .joints()
            .iter()
            .map(|joint| joint.name.clone())
            .collect::<Vec<_>>()
    });
    let [a, b, c] = [&joints[0], &joints[1], &joints[2]];
    assert_eq!(names[0], format!("compliance {a}+{c} 1"));
    assert_eq!(names[1], format!("compliance {a}+{c} 2"));
    // The drive of the joint and the spring after it.
    assert_eq!(names[2], format!("compliance {b} 1"));
    assert!(names.contains(&format!("compliance {b} 2")) && names.contains(&format!("backlash side {b}")));
    assert!(
        names.contains(&"geometry 3".to_owned()) && names.contains(&"model error".to_owned()),
        "{names:?}"
    );
    assert!(
        on_arm(StiffnessModel::DRIVES, |arm| {
            let exact = arm.robot.compliance().unwrap().iter().map(|c| JointCompliance {
                standard_uncertainty: 0.0,
                ..*c
            });
            InputSpace::of(&Arm {
                compliance: &exact.collect::<Vec<_>>(),
                ..*arm
            })
        })
        .inputs()
        .is_empty()
    );
}

#[test]
fn one_standard_uncertainty_of_each_input_gives_the_covariances_of_the_file() {
    let model = model();
    on_arm(&model, |arm| {
        let space = InputSpace::of(arm);
        let nominal = space.sampled(arm, &vec![0.0; space.inputs().len()]);
        assert_eq!(
            nominal.compliances(),
            arm.compliances().iter().map(|c| c.value).collect::<Vec<_>>()
        );
        let mut covariance = DMatrix::<f64>::zeros(8, 8);
        let mut of_geometry = DMatrix::<f64>::zeros(3, 3);
        for k in 0..space.inputs().len() {
            let mut z = vec![0.0; space.inputs().len()];
            z[k] = 1.0;
            let sampled = space.sampled(arm, &z);
            let pairs = sampled.compliances().into_iter().zip(nominal.compliances());
            let by = nalgebra::DVector::from_iterator(8, pairs.map(|(with, without)| with - without));
            covariance += &by * by.transpose();
            let motions = sampled
                .model
                .structure
                .geometry
                .as_ref()
                .unwrap()
                .shift_of_motions();
            of_geometry += &motions * motions.transpose();
            assert_eq!(sampled.cut, 0);
        }
        let compliances = arm.compliances();
        let expected = DMatrix::from_fn(8, 8, |i, j| match (i, j) {
            (0..3, 0..3) => model.structure.covariance.as_ref().unwrap()[(i, j)],
            _ if i == j => compliances[i].standard_uncertainty.powi(2),
            _ => 0.0,
        });
        assert!(
            (&covariance - &expected).amax() < 1e-9 * expected.amax(),
            "{covariance} {expected}"
        );
        let known = model.structure.geometry.as_ref().unwrap().covariance();
        assert!(
            (&of_geometry - &known).amax() < 1e-12 * known.amax(),
            "{of_geometry}"
        );
    });
}

#[test]
fn inputs_are_as_many_as_those_of_the_law_of_propagation() {
    // Apart from the side of a backlash, model error and scatter, which are no changes of the arm.
    let mut model = model();
    model.gravity = Some(crate::source::Gravity {
        acceleration: Vector3::new(0.0, 0.0, -9.81),
        reference: vec![0.0; 6],
    });
    on_arm(&model, |arm| {
        let all = UncertainInput::all(arm, &InputUncertainty::NONE);
        assert_eq!(all.len() + 5, InputSpace::of(arm).inputs().len());
    });
}

#[test]
fn negative_values_are_cut_and_counted() {
    on_arm(&model(), |arm| {
        let space = InputSpace::of(arm);
        let draws = Draws {
            method: Method::Random,
            seed: 3,
            inputs: space.inputs().len(),
        };
        for z in draws.normal(0, 200).chunks(draws.inputs) {
            // A hundred standard uncertainties: about half of all values are negative.
            let far: Vec<f64> = z.iter().map(|z| 100.0 * z).collect();
            let sampled = space.sampled(arm, &far);
            let structure = &sampled.model.structure;
            let gaps = structure.backlash.iter().flatten().map(|backlash| backlash.gap);
            let masses = structure.masses.iter().map(|mass| mass.mass);
            let values: Vec<f64> = sampled
                .compliances()
                .into_iter()
                .chain(gaps)
                .chain(masses)
                .collect();
            assert!(values.iter().all(|value| *value >= 0.0));
            let zeros = values.iter().filter(|value| **value == 0.0).count();
            assert_eq!(sampled.cut, zeros);
        }
    });
}

#[test]
fn links_are_at_either_side_where_no_torque_decides() {
    on_arm(&model(), |arm| {
        let space = InputSpace::of(arm);
        let side = space
            .inputs()
            .iter()
            .position(|input| input.source == InputSource::BacklashSide)
            .unwrap();
        for sign in [-1.0, 1.0] {
            let mut z = vec![0.0; space.inputs().len()];
            z[side] = 0.3 * sign;
            assert_eq!(
                space.sampled(arm, &z).links(),
                [0.0, 5e-5 * sign, 0.0, 0.0, 0.0, 0.0]
            );
        }
        assert_eq!(SampledArm::nominal(arm).links(), [0.0; 6]);
    });
}

#[test]
fn blocks_are_connected_indices() {
    let pairs = [(0, 3), (3, 5), (1, 2)];
    let connected = |i: usize, j: usize| pairs.contains(&(i, j)) || pairs.contains(&(j, i));
    assert_eq!(blocks(6, connected), [vec![0, 3, 5], vec![1, 2], vec![4]]);
    assert!(blocks(0, |_, _| true).is_empty());
}

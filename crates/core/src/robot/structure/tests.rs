//! Invalid structures, each by the smallest change of a valid one.

use nalgebra::{Matrix3, Point3, Vector3};

use super::*;
use crate::arms;
use crate::robot::torque_curve::TorqueCurve;
use crate::robot::{BacklashSide, Damping, JointCompliance, Motor};

fn spring(value: f64) -> Spring {
    let compliance = JointCompliance {
        value,
        standard_uncertainty: 0.1 * value,
    };
    Spring::about(Attachment::Flange, Vector3::x(), compliance)
}

fn compensator() -> Compensator {
    Compensator {
        joint: 1,
        fixed_radius: 0.69,
        arm_radius: 0.185,
        angle: 0.17,
        free_length: 0.458,
        stiffness: 7e6,
    }
}

fn curve() -> Option<JointCurve> {
    let rising = TorqueCurve::new(vec![[0.0, 0.0], [100.0, 1e-4]]).unwrap();
    Some(JointCurve {
        rising,
        falling: None,
    })
}

fn mass(mass: f64) -> Mass {
    Mass {
        attachment: Attachment::Tool,
        mass,
        centre: Point3::new(0.0, 0.1, 0.2),
        inertia: Some(Matrix3::identity() * 0.1),
        relative_uncertainty: 0.0,
    }
}

/// All parts, each valid.
fn sound() -> Structure {
    Structure {
        springs: vec![spring(1e-7), spring(2e-7)],
        masses: vec![mass(3.0), mass(0.0)],
        motors: vec![motor(1e-3)],
        damping: Some(Damping::Ratio(0.03)),
        compensator: Some(compensator()),
        curves: vec![None, None, curve()],
        covariance: Some(DMatrix::identity(8, 8) * 1e-14),
        backlash: vec![None, backlash(2e-4)],
        repeatability: 2e-5,
        model_error: 0.1,
        learnt: None,
        geometry: None,
    }
}

fn motor(rotor_inertia: f64) -> Motor {
    Motor {
        joint: 1,
        rotor_inertia,
        ratio: -120.0,
    }
}

fn backlash(gap: f64) -> Option<Backlash> {
    Some(Backlash {
        gap,
        standard_uncertainty: 1e-5,
        side: BacklashSide::Motion,
    })
}

#[test]
fn a_model_error_is_a_fraction_of_at_most_ten() {
    for value in [-1e-9, 10.0_f64.next_up(), f64::NAN] {
        let given = refused(|s| s.model_error = value);
        assert_eq!(
            given,
            format!("a model error of {value} is not a fraction from 0 to 10")
        );
    }
}

#[test]
fn repeatability_is_a_length() {
    for refused_value in [-1e-9, 0.02, f64::NAN] {
        let given = refused(|s| s.repeatability = refused_value);
        assert!(given.ends_with("m is not a number from 0 to 0.01"), "{given}");
    }
}

#[test]
fn backlash_is_within_its_range() {
    assert_eq!(
        refused(|s| s.backlash[1] = backlash(-1e-9)),
        "backlash of joint number 2: -0.000000001 is not a number from 0 to 0.1 rad (m)"
    );
    assert!(refused(|s| s.backlash[1] = backlash(f64::NAN)).contains("NaN"));
    assert_eq!(
        refused(|s| s.backlash = vec![backlash(1e-4); 7]),
        "backlash names joint number 7, which does not exist or is prismatic"
    );
    let mut none = sound();
    none.backlash = vec![backlash(0.0), None, backlash(1e-4)];
    assert_eq!(
        none.joints_with_backlash()
            .map(|(joint, _)| joint)
            .collect::<Vec<_>>(),
        [2]
    );
}

/// Why an arm of six revolute joints refuses the valid structure after a change.
fn refused(change: impl FnOnce(&mut Structure)) -> String {
    let mut changed = sound();
    change(&mut changed);
    changed.check(arms::ALL[0].chain()).unwrap_err().to_string()
}

#[test]
fn a_valid_structure_is_accepted_and_so_is_an_empty_one() {
    assert_eq!(sound().check(arms::ALL[0].chain()), Ok(()));
    assert_eq!(Structure::default(), Structure::EMPTY);
    assert_eq!(Structure::EMPTY.check(arms::ALL[0].chain()), Ok(()));
}

#[test]
fn curves_are_found_by_joint_and_the_list_may_be_shorter() {
    let structure = sound();
    let has: Vec<bool> = (0..9).map(|joint| structure.curve(joint).is_some()).collect();
    assert_eq!(
        has,
        [false, false, true, false, false, false, false, false, false]
    );
}

#[test]
fn parts_are_attached_to_existing_joints() {
    let at = |joint| Attachment::Joint(joint);
    assert_eq!(
        refused(|s| s.springs[1].attachment = at(6)),
        "a spring names joint number 7, which does not exist or is prismatic"
    );
    assert_eq!(
        refused(|s| s.masses[0].attachment = at(9)),
        "a mass names joint number 10, which does not exist or is prismatic"
    );
    assert_eq!(
        refused(|s| s.curves = vec![None, None, None, None, None, None, curve()]),
        "a torque curve names joint number 7, which does not exist or is prismatic"
    );
    assert_eq!(
        refused(|s| s.compensator = Some(Compensator {
            joint: 6,
            ..compensator()
        })),
        "the compensator names joint number 7, which does not exist or is prismatic"
    );
    let mut last = sound();
    (last.springs[0].attachment, last.masses[0].attachment) = (at(5), at(5));
    assert_eq!(last.check(arms::ALL[0].chain()), Ok(()));
}

#[test]
fn a_rail_has_springs_and_masses_but_no_torque_curve_and_no_compensator() {
    let railed = arms::other::on_rail(&arms::ALL[0]);
    let on = |change: fn(&mut Structure)| {
        let mut structure = Structure::EMPTY;
        change(&mut structure);
        structure.check(railed.chain())
    };
    assert_eq!(
        on(|s| {
            s.springs = vec![Spring {
                attachment: Attachment::Joint(0),
                ..spring(1e-7)
            }];
            s.masses = vec![Mass {
                attachment: Attachment::Joint(0),
                ..mass(400.0)
            }];
        }),
        Ok(())
    );
    let no = |what| Err(StructureError::NoSuchJoint { what, joint: 0 });
    assert_eq!(on(|s| s.curves = vec![curve()]), no("a torque curve"));
    assert_eq!(
        on(|s| s.compensator = Some(Compensator {
            joint: 0,
            ..compensator()
        })),
        no("the compensator")
    );
}

#[test]
fn spring_compliances_range_from_zero_to_the_softest_in_a_finite_direction() {
    for value in [-1e-300, SOFTEST.next_up(), f64::NAN] {
        assert_eq!(
            refused(|s| s.springs[1].compliance.value = value),
            format!("spring number 2: compliance {value} is not a number from 0 to 1 rad/(N m) (m/N)")
        );
        assert!(
            refused(|s| s.springs[0].compliance.standard_uncertainty = value).starts_with("spring number 1")
        );
    }
    assert_eq!(
        refused(|s| s.springs[0].direction.linear.y = f64::INFINITY),
        "a spring contains a number that is not finite"
    );
    let mut ends = sound();
    (ends.springs[0].compliance.value, ends.springs[1].compliance.value) = (0.0, SOFTEST);
    assert_eq!(ends.check(arms::ALL[0].chain()), Ok(()));
}

#[test]
fn masses_range_from_zero_to_a_thousand_tonnes() {
    for value in [-1e-9, 1e6_f64.next_up(), f64::NAN] {
        assert_eq!(
            refused(|s| s.masses[1].mass = value),
            format!("mass number 2: {value} kg is not a number from 0 to 1e6")
        );
    }
    assert_eq!(
        refused(|s| s.masses[0].centre.z = f64::NAN),
        "a centre of mass contains a number that is not finite"
    );
}

#[test]
fn a_compensator_has_lengths_and_a_spring_that_never_shrinks_to_zero() {
    let message = "the compensator needs lengths above 0, and radii that differ by 1 mm or more";
    type Break = fn(&mut Compensator);
    let broken: [Break; 8] = [
        |c| c.fixed_radius = 0.0,
        |c| c.arm_radius = -0.1,
        |c| c.free_length = -1e-9,
        |c| c.stiffness = -1.0,
        |c| c.stiffness = f64::INFINITY,
        |c| c.angle = f64::NAN,
        |c| c.arm_radius = c.fixed_radius,
        |c| c.arm_radius = c.fixed_radius - 0.000_999,
    ];
    for change in broken {
        assert_eq!(refused(|s| s.compensator.iter_mut().for_each(change)), message);
    }
    let mut near = sound();
    near.compensator = Some(Compensator {
        arm_radius: 0.69 - 0.001_001,
        ..compensator()
    });
    assert_eq!(near.check(arms::ALL[0].chain()), Ok(()));
}

#[test]
fn a_covariance_is_symmetric_not_negative_and_of_compliances_that_exist() {
    let with = |change: fn(&mut DMatrix<f64>)| {
        refused(|s| {
            let mut covariance = DMatrix::identity(8, 8) * 1e-14;
            change(&mut covariance);
            s.covariance = Some(covariance);
        })
    };
    assert_eq!(with(|c| c[(1, 2)] = 1e-14), "the covariance is not symmetric");
    assert_eq!(
        with(|c| c[(3, 3)] = f64::NAN),
        "the covariance contains a number that is not finite"
    );
    let negative = "the covariance has a negative eigenvalue, or 8 rows for 8 compliances";
    assert_eq!(with(|c| c[(3, 3)] = -1e-15), negative);
    // Correlated by more than one.
    assert_eq!(with(|c| (c[(0, 1)], c[(1, 0)]) = (1.1e-14, 1.1e-14)), negative);
    assert!(with(|c| *c = DMatrix::identity(9, 9)).contains("9 rows for 8 compliances"));
    assert!(with(|c| *c = DMatrix::zeros(2, 3)).contains("2 rows for"));
    // Rounding of printed numbers is tolerated, and a covariance may cover fewer compliances than there are.
    let mut printed = sound();
    let mut covariance = DMatrix::identity(3, 3) * 1e-14;
    covariance[(0, 1)] = 5e-21;
    printed.covariance = Some(covariance);
    assert_eq!(printed.check(arms::ALL[0].chain()), Ok(()));
}

#[test]
fn an_inertia_is_symmetric_and_positive_about_every_axis() {
    let with = |change: fn(&mut Matrix3<f64>)| {
        refused(|s| {
            let mut inertia = Matrix3::identity();
            change(&mut inertia);
            s.masses[1].inertia = Some(inertia);
        })
    };
    let message = "mass number 2: its inertia is not finite, symmetric and positive about every axis";
    assert_eq!(with(|i| i[(0, 1)] = 0.1), message);
    assert_eq!(with(|i| i[(2, 2)] = -1e-3), message);
    assert_eq!(with(|i| (i[(0, 1)], i[(1, 0)]) = (1.1, 1.1)), message);
    assert_eq!(with(|i| i[(0, 0)] = f64::NAN), message);
    let mut thin = sound();
    thin.masses[0].inertia = Some(Matrix3::zeros());
    assert_eq!(thin.check(arms::ALL[0].chain()), Ok(()));
}

#[test]
fn motors_and_dampers_are_of_joints_and_within_their_range() {
    for value in [-1e-9, f64::NAN, 1e6] {
        assert!(
            refused(|s| s.motors[0] = motor(value)).starts_with("motor of joint number 2: "),
            "{value}"
        );
    }
    assert_eq!(
        refused(|s| s.motors[0].joint = 6),
        "a motor names joint number 7, which does not exist or is prismatic"
    );
    for value in [-1e-9, 1.0, f64::NAN] {
        let given = refused(|s| s.damping = Some(Damping::Ratio(value)));
        assert_eq!(
            given,
            format!("a damping ratio of {value} is not a number from 0 to below 1")
        );
    }
    let damped = |dampers: Vec<f64>| refused(|s| s.damping = Some(Damping::Joints(dampers)));
    assert!(damped(vec![0.0, -1.0]).starts_with("damping of joint number 2: -1 is not"));
    assert!(damped(vec![1.0; 7]).contains("joint number 7"));
}

#[test]
fn a_body_with_mass_or_inertia_and_a_rotor_have_inertia_and_nothing_else_has() {
    let nothing = Structure {
        springs: vec![spring(1e-7)],
        ..Structure::EMPTY
    };
    assert!(!nothing.has_inertia());
    let of_bodies = |masses: Vec<Mass>| Structure {
        masses,
        ..nothing.clone()
    };
    let point = |value: f64| Mass {
        inertia: None,
        ..mass(value)
    };
    assert!(!of_bodies(vec![point(0.0)]).has_inertia());
    assert!(of_bodies(vec![point(0.0), point(1e-3)]).has_inertia());
    assert!(of_bodies(vec![mass(0.0)]).has_inertia());
    let of_rotor = |inertia: f64| Structure {
        motors: vec![motor(inertia)],
        ..nothing.clone()
    };
    assert!(of_rotor(1e-3).has_inertia());
    assert!(!of_rotor(0.0).has_inertia());
}

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DMatrix, Point2, Point3, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::Isometry;
use crate::load::{InputUncertainty, LoadCases, LoadFrame, PathLoad};
use crate::path::{Placing, Shape, Spin};
use crate::robot::{BranchPattern, JointCompliance, Robot};
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;
use crate::workpiece::Plane;

const IN_PLANE: (Component, Objective) = (Component::InPlane, Objective::Worst);

/// An MH12 whose compliances have these relative standard uncertainties.
struct Cell {
    robot: Robot,
    compliance: Vec<JointCompliance>,
    model: StiffnessModel,
    tool: Isometry,
}

impl Cell {
    fn new(relative: f64) -> Cell {
        let robot = arms::mh12();
        let compliance = robot.compliance().unwrap().iter();
        Cell {
            compliance: compliance
                .map(|joint| JointCompliance {
                    value: joint.value,
                    standard_uncertainty: relative * joint.value,
                })
                .collect(),
            robot,
            model: StiffnessModel::DRIVES.clone(),
            tool: crate::frame::from_xyz_and_fixed_angles(
                Vector3::new(0.1, 0.0, 0.15),
                Vector3::new(0.0, FRAC_PI_2, 0.0),
            ),
        }
    }

    fn question(&self) -> Question<'_> {
        let arm = Arm {
            robot: &self.robot,
            compliance: &self.compliance,
            flange_from_tool: &self.tool,
            model: &self.model,
        };
        Question::unloaded(arm, None)
    }
}

/// A circle of 0.1 m on a horizontal plate, with this spin of the tool.
fn circle(spin: f64) -> Track {
    let shape = Shape::Circle {
        centre: Point2::origin(),
        radius: 0.1,
    };
    let plane = Plane::tilted(Point3::new(0.85, 0.0, 0.3), FRAC_PI_2);
    Track {
        path: shape.sampled(0.02),
        placing: Placing {
            spin: Spin::Fixed(spin),
            ..Placing::on_plane(&plane)
        },
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

fn load() -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: vec![Wrench::from_force(Vector3::new(-80.0, 30.0, 10.0))],
    })
}

const FRONT: [(usize, BranchChoice); 1] = [(0, BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP))];

fn of<'a>(
    question: &Question<'_>,
    tracks: [&'a Track; 2],
    load: &'a PathLoad,
    choices: &'a [(usize, BranchChoice)],
) -> Gain {
    let followed = tracks.map(|track| FollowedTrack {
        path: LoadedTrack { track, load },
        choices,
        home: None,
    });
    gain_along(question, followed, IN_PLANE, Watch::NONE).unwrap()
}

#[test]
fn a_difference_of_predictions_scatters_as_random_arms_do() {
    let cell = Cell::new(0.05);
    let (tracks, load) = ([circle(0.4), circle(1.9)], load());
    let found = of(&cell.question(), [&tracks[0], &tracks[1]], &load, &FRONT);
    let u = found.uncertainty.unwrap();
    let mut random = Stream(11);
    let mut sum = 0.0;
    let draws = 600;
    for _ in 0..draws {
        let drawn: Vec<JointCompliance> = cell
            .compliance
            .iter()
            .map(|joint| JointCompliance {
                value: joint.value + joint.standard_uncertainty * random.normal(),
                ..*joint
            })
            .collect();
        let question = cell.question();
        let drawn = Question {
            arm: Arm {
                compliance: &drawn,
                ..question.arm
            },
            ..question
        };
        let objective = |track: &Track| {
            let along = along_postures(&drawn, track, load.clone(), FRONT.to_vec(), Watch::NONE).unwrap();
            IN_PLANE.1.along(IN_PLANE.0, track, &along.answers)
        };
        let gain = objective(&tracks[0]) - objective(&tracks[1]);
        sum += (gain - found.by()).powi(2);
    }
    let scatter = (sum / f64::from(draws)).sqrt();
    // The standard deviation of a standard deviation from 600 draws is 3 %.
    assert!((u / scatter - 1.0).abs() < 0.12, "{u} {scatter}");
    // Less than that of two arms of their own: 5 % of each deviation in at most quadrature, never in sum.
    assert!(u < 0.05 * found.before.hypot(found.after), "{found:?}");
}

#[test]
fn the_same_path_gains_nothing_for_certain_and_half_the_load_gains_half() {
    let cell = Cell::new(0.2);
    let (track, load) = (circle(0.4), load());
    let question = cell.question();
    let same = of(&question, [&track, &track], &load, &FRONT);
    assert_eq!((same.by(), same.uncertainty), (0.0, Some(0.0)));
    let half = load.scaled(0.5);
    let followed = [&load, &half].map(|load| FollowedTrack {
        path: LoadedTrack { track: &track, load },
        choices: &FRONT,
        home: None,
    });
    let found = gain_along(&question, followed, IN_PLANE, Watch::NONE).unwrap();
    let single = gain(&question, |question, _| {
        let along = along_postures(question, &track, load.clone(), FRONT.to_vec(), Watch::NONE)?;
        Ok([IN_PLANE.1.along(IN_PLANE.0, &track, &along.answers), 0.0])
    });
    let u = single.unwrap().uncertainty.unwrap();
    assert!((found.by() - 0.5 * found.before).abs() < 1e-9 * found.before);
    assert!((found.uncertainty.unwrap() - 0.5 * u).abs() < 1e-6 * u);
}

#[test]
fn load_and_model_error_add_their_parts() {
    let mut cell = Cell::new(1e-9);
    let (tracks, load) = ([circle(0.4), circle(1.9)], load());
    let question = |cell: &Cell| {
        of(
            &Question {
                uncertainty: InputUncertainty {
                    relative: 0.1,
                    ..InputUncertainty::NONE
                },
                ..cell.question()
            },
            [&tracks[0], &tracks[1]],
            &load,
            &FRONT,
        )
    };
    let found = question(&cell);
    // Deviations are proportional to the load, and so is their difference.
    let u = found.uncertainty.unwrap();
    assert!((u / (0.1 * found.by().abs()) - 1.0).abs() < 1e-6, "{u}");
    cell.model.structure.model_error = 0.3;
    let with_error = question(&cell).uncertainty.unwrap();
    let expected = u.hypot(0.3 * found.before.hypot(found.after));
    assert!((with_error / expected - 1.0).abs() < 1e-9);
}

#[test]
fn a_correlated_pair_of_compliances_counts_once() {
    let mut cell = Cell::new(0.1);
    let (tracks, load) = ([circle(0.4), circle(1.9)], load());
    let apart = of(&cell.question(), [&tracks[0], &tracks[1]], &load, &FRONT);
    let u: Vec<f64> = cell
        .compliance
        .iter()
        .map(|joint| joint.standard_uncertainty)
        .collect();
    cell.model.structure.covariance = Some(DMatrix::from_fn(
        6,
        6,
        |i, k| if i == k { u[i] * u[i] } else { 0.0 },
    ));
    let by_covariance = of(&cell.question(), [&tracks[0], &tracks[1]], &load, &FRONT);
    let [a, b] = [apart, by_covariance].map(|gain| gain.uncertainty.unwrap());
    assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    // All compliances off by the same factor: the gain is off by this factor.
    cell.model.structure.covariance = Some(DMatrix::from_fn(6, 6, |i, k| u[i] * u[k]));
    let together = of(&cell.question(), [&tracks[0], &tracks[1]], &load, &FRONT);
    let expected = 0.1 * together.by().abs();
    assert!(
        (together.uncertainty.unwrap() / expected - 1.0).abs() < 1e-6,
        "{together:?}"
    );
}

#[test]
fn a_gain_counts_beyond_its_uncertainty_or_beyond_a_given_amount() {
    let least = LeastGain {
        coverage_factor: 2.0,
        amount: 3e-6,
        amount_if_unknown: 5e-6,
    };
    let gain = |by: f64, uncertainty| Gain {
        before: 100e-6,
        after: 100e-6 - by,
        uncertainty,
    };
    for (by, uncertainty, significant) in [
        (10e-6, Some(4e-6), true),
        (7e-6, Some(4e-6), false),
        (2e-6, Some(0.0), false),
        (4e-6, Some(0.0), true),
        (4e-6, None, false),
        (6e-6, None, true),
        (-1.0, Some(0.0), false),
    ] {
        assert_eq!(
            gain(by, uncertainty).is_significant(&least),
            significant,
            "{by} {uncertainty:?}"
        );
    }
}

#[test]
fn without_a_known_uncertainty_of_the_compliances_that_of_the_gain_is_not_known() {
    let cell = Cell::new(0.0);
    let (tracks, load) = ([circle(0.4), circle(1.9)], load());
    let question = Question {
        uncertainty: InputUncertainty {
            relative: 0.1,
            ..InputUncertainty::NONE
        },
        ..cell.question()
    };
    let found = of(&question, [&tracks[0], &tracks[1]], &load, &FRONT);
    assert_eq!(found.uncertainty, None);
    assert!(found.before > 0.0 && found.after > 0.0);
}

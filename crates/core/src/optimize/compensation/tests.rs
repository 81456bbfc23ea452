use nalgebra::{Point2, Point3};

use super::*;
use crate::arms;
use crate::frame::Isometry;
use crate::load::{CutHere, CutsAlong, Cutter, CuttingLaw, GreatestForce, LoadCases, Mechanistic};
use crate::path::{LoadedTrack, Placing, Shape, Track};
use crate::robot::{BranchPattern, JointCompliance, Robot};
use crate::source::{Arm, StiffnessModel};
use crate::workpiece::Plane;

/// A circle of 0.1 m on the paper's vertical plate.
fn track() -> Track {
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
    let circle = Shape::Circle {
        centre: Point2::origin(),
        radius: 0.1,
    };
    Track {
        path: circle.sampled(0.01),
        placing: Placing::on_plane(&plane),
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    }
}

fn feed_load(forces: &[[f64; 3]]) -> PathLoad {
    PathLoad::Cases(LoadCases {
        frame: LoadFrame::Feed,
        cases: forces
            .iter()
            .map(|force| Wrench::from_force((*force).into()))
            .collect(),
    })
}

const CHOICES: [(usize, BranchChoice); 1] = [(0, BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP))];

struct Cell {
    robot: Robot,
    tool: Isometry,
}

impl Cell {
    fn new() -> Cell {
        Cell {
            robot: arms::mh12(),
            tool: Isometry::translation(0.0, 0.0, 0.15),
        }
    }

    /// The question for an arm with compliances scaled by these factors.
    fn with<T>(&self, parts: [f64; 6], analysis: impl FnOnce(&Question<'_>) -> T) -> T {
        let known = self.robot.compliance().unwrap();
        let compliance: Vec<JointCompliance> = known
            .iter()
            .zip(parts)
            .map(|(c, part)| JointCompliance {
                value: c.value * part,
                ..*c
            })
            .collect();
        let arm = Arm {
            robot: &self.robot,
            compliance: &compliance,
            flange_from_tool: &self.tool,
            model: StiffnessModel::DRIVES,
        };
        analysis(&Question::unloaded(arm, None))
    }

    fn compensated(&self, load: &PathLoad) -> Compensated {
        self.with([1.0; 6], |question| {
            compensated(
                question,
                LoadedTrack {
                    track: &track(),
                    load,
                },
                &CHOICES,
                Compensation::USUAL,
                Watch::NONE,
            )
            .unwrap()
        })
    }

    /// Deviations along a path of an arm with compliances scaled by these factors, m, base.
    fn deviations(&self, parts: [f64; 6], track: &Track, load: &PathLoad) -> Vec<Vector3<f64>> {
        self.with(parts, |question| {
            along_postures(question, track, load.clone(), CHOICES.to_vec(), Watch::NONE)
                .unwrap()
                .answers
                .deviations
        })
    }
}

fn largest(vectors: &[Vector3<f64>]) -> f64 {
    vectors.iter().map(Vector3::norm).fold(0.0, f64::max)
}

fn rms(vectors: &[Vector3<f64>]) -> f64 {
    (vectors.iter().map(Vector3::norm_squared).sum::<f64>() / vectors.len() as f64).sqrt()
}

#[test]
fn the_residual_of_a_command_is_that_of_its_compensation_and_the_whole_deviation_without_one() {
    let load = feed_load(&[[-60.0, 40.0, 25.0], [-20.0, 40.0, 5.0]]);
    let cell = Cell::new();
    let found = cell.compensated(&load);
    let left = |commanded: &Track| {
        cell.with([1.0; 6], |question| {
            residual_of(
                question,
                LoadedTrack {
                    track: &track(),
                    load: &load,
                },
                commanded,
                &CHOICES,
                Watch::NONE,
            )
            .unwrap()
        })
    };
    assert_eq!(left(&found.track).1, found.residual);
    let (along, residual) = left(&track());
    assert_eq!(along.answers.deviations, residual);
    assert!(residual[0].norm() > 1e-5);
}

#[test]
fn the_compensated_tool_follows_the_nominal_path() {
    let cell = Cell::new();
    let load = feed_load(&[[-60.0, 40.0, 25.0]]);
    let before = largest(&cell.deviations([1.0; 6], &track(), &load));
    let found = cell.compensated(&load);
    assert!(before > 300e-6, "{before}");
    // Converged when no point moves by a tenth of a micrometre in an iteration; the rest is that times the contraction.
    assert!(
        found.last_move < 1e-7 && found.rounds <= 3,
        "{} {}",
        found.rounds,
        found.last_move
    );
    let contraction = found.contraction.unwrap();
    assert!(contraction < 1e-2, "{contraction}");
    assert!(
        largest(&found.residual) < 1e-7 * contraction.max(1e-2),
        "{:e}",
        largest(&found.residual)
    );
    assert_eq!((found.unmoved, found.track.len()), (0, track().len()));
    // The commanded path deviates onto the nominal one: predicted again by the arm model itself.
    let again = cell.deviations([1.0; 6], &found.track, &load);
    let plate = track().placing.base_from_path;
    for (i, deviation) in again.iter().enumerate() {
        let reached = plate * found.track.path.points[i].at + deviation;
        let drawn = plate * track().path.points[i].at;
        assert!((reached - drawn).norm() < 1e-8, "{i}");
    }
}

#[test]
fn an_arm_with_compliances_off_by_a_fifth_still_gains_a_factor_of_three() {
    let cell = Cell::new();
    let load = feed_load(&[[-60.0, 40.0, 25.0]]);
    let found = cell.compensated(&load);
    let moved: Vec<Vector3<f64>> = found
        .track
        .path
        .points
        .iter()
        .zip(&track().path.points)
        .map(|(commanded, drawn)| track().placing.base_from_path.rotation * (commanded.at - drawn.at))
        .collect();
    let mut least = f64::INFINITY;
    for signs in 0..64 {
        let parts = std::array::from_fn(|joint| if signs >> joint & 1 == 1 { 1.2 } else { 0.8 });
        let before = rms(&cell.deviations(parts, &track(), &load));
        let deviations = cell.deviations(parts, &found.track, &load);
        let left: Vec<_> = deviations.iter().zip(&moved).map(|(d, m)| d + m).collect();
        least = least.min(before / rms(&left));
    }
    assert!(least >= 3.0, "{least}");
}

#[test]
fn of_several_cases_the_mean_is_compensated_and_the_residual_is_reported() {
    let cell = Cell::new();
    let forces = [[-60.0, 40.0, 25.0], [-20.0, -40.0, 10.0]];
    let found = cell.compensated(&feed_load(&forces));
    let pairs = found.residual.chunks(2);
    assert_eq!(pairs.len(), track().len());
    // Half the difference to either side, and the largest by as much.
    for pair in pairs {
        assert!((pair[0] + pair[1]).norm() < 1e-8 && pair[0].norm() > 1e-6);
    }
}

#[test]
fn a_cut_is_compensated_under_its_nominal_force() {
    let cell = Cell::new();
    let force = Vector3::new(-60.0, 40.0, 25.0);
    let law = Mechanistic::new(Vector3::new(8e8, 2e8, 2e8), Vector3::zeros()).unwrap();
    let here = CutHere {
        mean: force,
        greatest: force * 2.0,
        ..CutHere::NOTHING
    };
    let cut = PathLoad::Cuts(CutsAlong {
        cutters: vec![Cutter::flat(0.01, 2).unwrap()],
        law: CuttingLaw::Mechanistic(law),
        greatest: GreatestForce::SecondCase,
        points: vec![here; track().len()],
    });
    let (of_cut, given) = (
        cell.compensated(&cut),
        cell.compensated(&feed_load(&[force.into()])),
    );
    assert_eq!(of_cut.track.path, given.track.path);
    assert_eq!(of_cut.residual.len(), track().len());
}

#[test]
fn unreachable_points_stay_and_are_reported() {
    let cell = Cell::new();
    let load = feed_load(&[[-60.0, 40.0, 25.0]]);
    let mut far = track();
    far.path.points[3].at += Vector3::new(5.0, 0.0, 0.0);
    let found = cell.with([1.0; 6], |question| {
        compensated(
            question,
            LoadedTrack {
                track: &far,
                load: &load,
            },
            &CHOICES,
            Compensation::USUAL,
            Watch::NONE,
        )
        .unwrap()
    });
    assert_eq!(found.unmoved, 1);
    assert_eq!(found.track.path.points[3], far.path.points[3]);
    assert_eq!(found.residual[3], Vector3::zeros());
}

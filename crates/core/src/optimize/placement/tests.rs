use std::f64::consts::PI;

use nalgebra::{Point2, Point3, Unit, UnitQuaternion, Vector2, Vector3};

use super::*;
use crate::arms::{self, Stream};
use crate::frame::{Isometry, from_xyz_and_fixed_angles};
use crate::kernel::BranchChoice;
use crate::load::LoadCases;
use crate::map::along_postures;
use crate::optimize::ToolTurn;
use crate::path::{LoadedTrack, Pace, Placing, Shape, Spin, Track};
use crate::robot::Robot;
use crate::source::{Arm, StiffnessModel};
use crate::spatial::Wrench;
use crate::workpiece::Plane;

mod in_a_cell;

struct Cell {
    robot: Robot,
    tool: Isometry,
}

impl Cell {
    fn new() -> Cell {
        Cell {
            robot: arms::mh12(),
            tool: from_xyz_and_fixed_angles(Vector3::new(0.05, 0.0, 0.15), Vector3::new(0.0, 0.4, 0.0)),
        }
    }

    fn question(&self) -> Question<'_> {
        let arm = Arm {
            robot: &self.robot,
            compliance: self.robot.compliance().unwrap(),
            flange_from_tool: &self.tool,
            model: StiffnessModel::DRIVES,
        };
        Question::unloaded(arm, None)
    }
}

fn load(frame: LoadFrame) -> PathLoad {
    let forces = [[-80.0, 30.0, 10.0], [20.0, 60.0, -25.0]];
    PathLoad::Cases(LoadCases {
        frame,
        cases: forces.map(|force| Wrench::from_force(force.into())).to_vec(),
    })
}

/// A rectangle on a plate; with `lean` the tool axis differs from point to point.
fn track(base_from_part: Isometry, spin: Spin, lean: f64) -> Track {
    let mut path = Shape::rectangle(Point2::origin(), Vector2::new(0.12, 0.08)).sampled(0.01);
    for (index, point) in path.points.iter_mut().enumerate() {
        point.pace = Pace::Feed(0.04);
        if lean > 0.0 {
            let turn = 0.3 * index as f64;
            let axis = Vector3::new(lean * turn.cos(), lean * turn.sin(), 1.0);
            point.axis = Some(Unit::new_normalize(axis));
        }
    }
    let plane = Plane { base_from_part };
    Track {
        path,
        placing: Placing {
            spin,
            keeps_axis: lean == 0.0,
            ..Placing::on_plane(&plane)
        },
        base_from_part,
        spins: None,
        homes: None,
    }
}

/// The same track with its part at another pose.
fn moved(track: &Track, base_from_part: Isometry) -> Track {
    let part_from_path = track.base_from_part.inverse() * track.placing.base_from_path;
    Track {
        placing: Placing {
            base_from_path: base_from_part * part_from_path,
            ..track.placing
        },
        base_from_part,
        ..track.clone()
    }
}

fn objective(objective: Objective) -> PlacementObjective {
    PlacementObjective {
        component: Component::InPlane,
        objective,
        branches: BranchPattern::default(),
        margin: 0.0,
        wrist: 0.05,
        rank_by: RankBy::Nominal,
        selection: PostureSelection::ForPath,
    }
}

fn drawn() -> Isometry {
    Plane::tilted(Point3::new(0.85, 0.1, 0.4), 1.2).base_from_part
}

/// A place some way from [`drawn`].
fn place(random: &mut Stream) -> Isometry {
    let step = from_xyz_and_fixed_angles(random.vector(0.15), random.vector(0.5));
    drawn() * step
}

/// The score of a placement agrees with the path answered at this placement, point by point: the same physics by the
/// path analysis.
#[test]
fn the_score_of_a_placement_agrees_with_the_answered_path() {
    let cell = Cell::new();
    let question = cell.question();
    let mut random = Stream(3);
    let mut reached = 0;
    for (frame, spin, lean) in [
        (LoadFrame::Base, Spin::Fixed(0.4), 0.0),
        (LoadFrame::Part, Spin::AlongFeed(0.2), 0.0),
        (LoadFrame::Feed, Spin::Fixed(-1.0), 0.0),
        (LoadFrame::Feed, Spin::AlongFeed(0.0), 0.2),
        (LoadFrame::Base, Spin::AlongFeed(0.0), 0.2),
    ] {
        let (track, load) = (track(drawn(), spin, lean), load(frame));
        let all: Vec<usize> = (0..track.len()).collect();
        for component in [Component::InPlane, Component::CrossTrack, Component::Axial] {
            let path = on_part(
                LoadedTrack {
                    track: &track,
                    load: &load,
                },
                component,
                &all,
            );
            let turn = ToolTurn::of(&track);
            for _ in 0..6 {
                let base_from_part = place(&mut random);
                let placement = turn.placement(base_from_part, 0.0);
                let there = moved(&track, base_from_part);
                let scores = [Objective::Worst, Objective::Mean, Objective::Above(1e-4)].map(|of| {
                    let objective = PlacementObjective {
                        component,
                        ..objective(of)
                    };
                    let placeable = Placeable {
                        question: &question,
                        path: &path,
                        objective,
                    };
                    placeable.scores(&[placement], None, Watch::NONE).unwrap()[0].unwrap()
                });
                let [worst, mean, above] = scores;
                if worst.unreachable > 0 {
                    continue;
                }
                reached += 1;
                let deviations = |branch: Branch| -> Vec<f64> {
                    let choice = vec![(0, BranchChoice::Of(branch.into()))];
                    let along = along_postures(&question, &there, load.clone(), choice, Watch::NONE).unwrap();
                    let cases = along.answers.case_count;
                    let size = |index: usize, deviation: &Vector3<f64>| {
                        let parts = there.parts(index, deviation);
                        match component {
                            Component::InPlane => parts.along.hypot(parts.cross),
                            Component::CrossTrack => parts.cross.abs(),
                            Component::Axial => parts.axial.abs(),
                        }
                    };
                    let of_point = |(index, cases): (usize, &[Vector3<f64>])| {
                        cases.iter().map(|one| size(index, one)).fold(0.0, f64::max)
                    };
                    along
                        .answers
                        .deviations
                        .chunks(cases)
                        .enumerate()
                        .map(of_point)
                        .collect()
                };
                let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9 * b + 1e-15, "{a} {b}");
                let of = deviations(worst.branch.unwrap());
                close(worst.cost, of.iter().copied().fold(0.0, f64::max));
                let count = of.len() as f64;
                let of = deviations(mean.branch.unwrap());
                close(mean.cost, of.iter().sum::<f64>() / count);
                let of = deviations(above.branch.unwrap());
                let over: f64 = of.iter().map(|d| (d - 1e-4).max(0.0) + 1e-3 * d).sum();
                close(above.cost, over / count);
            }
        }
    }
    assert!(reached > 40, "{reached}");
}

/// The tool in the evaluation is that of the path at the placement, whether its spin is relative to the part or to
/// base.
#[test]
fn the_tool_turn_agrees_with_the_path_at_the_placement() {
    let mut random = Stream(12);
    for spin in [Spin::Fixed(0.4), Spin::Given(-2.0), Spin::AlongFeed(1.0)] {
        let track = track(drawn(), spin, 0.0);
        let turn = ToolTurn::of(&track);
        for _ in 0..20 {
            let base_from_part = place(&mut random);
            let placement = turn.placement(base_from_part, 0.3);
            let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin);
            let there = moved(&track, base_from_part);
            for index in [0, track.len() / 2] {
                let expected = base_from_part
                    * (track.base_from_part.inverse() * track.stop(index).base_from_tool)
                    * about;
                let more = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.3);
                let actual = there.stop(index).base_from_tool * more;
                assert!(
                    (expected.to_homogeneous() - actual.to_homogeneous()).norm() < 1e-12,
                    "{spin:?}"
                );
            }
        }
    }
}

#[test]
fn a_bar_rejects_no_better_placement() {
    let cell = Cell::new();
    let question = cell.question();
    let mut random = Stream(7);
    let (track, load) = (track(drawn(), Spin::AlongFeed(0.0), 0.0), load(LoadFrame::Part));
    let all: Vec<usize> = (0..track.len()).collect();
    let path = on_part(
        LoadedTrack {
            track: &track,
            load: &load,
        },
        Component::InPlane,
        &all,
    );
    let places: Vec<PartPlacement> = (0..200)
        .map(|_| ToolTurn::WithPart.placement(place(&mut random), random.vector(PI).x))
        .collect();
    for of in [Objective::Worst, Objective::Mean] {
        let placeable = Placeable {
            question: &question,
            path: &path,
            objective: objective(of),
        };
        let scores = placeable.scores(&places, None, Watch::NONE).unwrap();
        let mut sorted: Vec<Score> = scores.iter().flatten().copied().collect();
        sorted.sort_by(|a, b| a.unreachable.cmp(&b.unreachable).then(a.cost.total_cmp(&b.cost)));
        assert!(sorted[0].unreachable == 0 && sorted[199].unreachable > 0);
        for bar in [sorted[20], sorted[60], sorted[199]] {
            let pruned = placeable.scores(&places, Some(&bar), Watch::NONE).unwrap();
            for (pruned, score) in pruned.iter().zip(&scores) {
                let score = score.unwrap();
                assert_eq!(
                    pruned.filter(|pruned| pruned.beats(&bar)),
                    Some(score).filter(|m| m.beats(&bar))
                );
            }
        }
    }
}

#[test]
fn a_placement_with_fewer_unreachable_points_is_better_at_any_cost() {
    let score = |unreachable, cost| Score {
        unreachable,
        cost,
        branch: None,
    };
    assert!(score(0, 1.0).beats(&score(1, 0.0)) && !score(1, 0.0).beats(&score(0, 1.0)));
    assert!(score(2, 0.5).beats(&score(2, 0.6)) && !score(2, 0.5).beats(&score(2, 0.5)));
    assert!(score(7, 1.0).beats(&Score::NONE));
}

#[test]
fn a_cancelled_watch_stops_the_evaluation() {
    let cell = Cell::new();
    let question = cell.question();
    let (track, load) = (track(drawn(), Spin::Fixed(0.0), 0.0), load(LoadFrame::Part));
    let path = on_part(
        LoadedTrack {
            track: &track,
            load: &load,
        },
        Component::InPlane,
        &[0, 5],
    );
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let placeable = Placeable {
        question: &question,
        path: &path,
        objective: objective(Objective::Worst),
    };
    let watch = Watch {
        cancel: &cancel,
        ..Watch::NONE
    };
    let placement = ToolTurn::WithPart.placement(drawn(), 0.0);
    assert_eq!(placeable.scores(&[placement], None, watch), Err(Cancelled));
}

/// The differences used for the uncertainty against the spread of the cost of 4000 arms with random compliances.
#[test]
fn the_uncertainty_of_a_cost_agrees_with_the_scatter_of_random_arms() {
    let cell = Cell::new();
    let mut joints = cell.robot.compliance().unwrap().to_vec();
    for (k, joint) in joints.iter_mut().enumerate() {
        joint.standard_uncertainty = joint.value * (0.02 + 0.01 * k as f64);
    }
    let mut question = cell.question();
    question.arm.compliance = &joints;
    question.uncertainty.relative = 0.03;
    let (track, load) = (track(drawn(), Spin::Fixed(0.0), 0.0), load(LoadFrame::Part));
    let path = on_part(
        LoadedTrack {
            track: &track,
            load: &load,
        },
        Component::InPlane,
        &[0, 7, 15, 30],
    );
    let placeable = |rank_by| Placeable {
        question: &question,
        path: &path,
        objective: PlacementObjective {
            rank_by,
            ..objective(Objective::Worst)
        },
    };
    let placement = ToolTurn::of(&track).placement(drawn(), 0.0);
    let given = placeable(RankBy::Nominal).evaluated(&placement);
    let branch = given.score.branch.unwrap();
    let mut random = Stream(99);
    // Twelve uniform numbers minus six are nearly normal; so the sum of twelve from -1 to 1, halved.
    let mut normal = || (0..4).map(|_| random.vector(0.5).sum()).sum::<f64>();
    let costs: Vec<f64> = (0..4000)
        .map(|_| {
            let mut other = joints.clone();
            for joint in &mut other {
                joint.value += joint.standard_uncertainty * normal();
            }
            let mut question = question;
            question.arm.compliance = &other;
            let one = Placeable {
                question: &question,
                path: &path,
                objective: PlacementObjective {
                    branches: branch.into(),
                    ..objective(Objective::Worst)
                },
            };
            one.evaluated(&placement).score.cost * (1.0 + 0.03 * normal())
        })
        .collect();
    let mean = costs.iter().sum::<f64>() / costs.len() as f64;
    let spread = (costs.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / costs.len() as f64).sqrt();
    // A standard deviation of 4000 has an uncertainty of 1.1 %; the largest of some points bends the propagation a
    // little.
    let u = given.uncertainty.unwrap();
    assert!((u - spread).abs() < 0.05 * spread, "{u} {spread}");
    let compared = |rank_by| {
        let all = placeable(rank_by)
            .scores(&[placement], None, Watch::NONE)
            .unwrap();
        all[0].unwrap().cost
    };
    let cost = given.score.cost;
    assert!((compared(RankBy::PlusTwoSigma) - (cost + 2.0 * u)).abs() < 1e-15);
    assert!((compared(RankBy::WithinTolerance(2.0 * cost)) + cost / u).abs() < 1e-9 * cost / u);
    assert_eq!(compared(RankBy::Nominal), cost);
    // Phi(-1) and Phi(1.96) of tables of the normal distribution.
    let above = |z: f64| given.probability_above(cost - z * u).unwrap();
    assert!((above(-1.0) - 0.158_655_3).abs() < 1e-7 && (above(1.96) - 0.975_002_1).abs() < 1e-7);
}

/// With one posture per point, a point deviates as the best of its postures does when it is a path of one point.
#[test]
fn points_with_separate_postures_use_the_best_of_each() {
    let cell = Cell::new();
    let question = cell.question();
    let (track, load) = (track(drawn(), Spin::AlongFeed(0.0), 0.2), load(LoadFrame::Feed));
    let spins = Steps {
        first: -1.0,
        step: 0.7,
        count: 4,
    };
    let mut random = Stream(31);
    for branches in [BranchPattern::default(), BranchPattern::FRONT_ELBOW_UP] {
        let objective = PlacementObjective {
            branches,
            ..objective(Objective::Mean)
        };
        let of = |indices: &[usize]| {
            on_part(
                LoadedTrack {
                    track: &track,
                    load: &load,
                },
                Component::InPlane,
                indices,
            )
        };
        let all: Vec<usize> = (0..track.len()).collect();
        let whole = of(&all);
        for _ in 0..4 {
            let placement = ToolTurn::of(&track).placement(place(&mut random), 0.1);
            let each = Placeable {
                question: &question,
                path: &whole,
                objective: PlacementObjective {
                    selection: PostureSelection::PerPoint(spins),
                    ..objective
                },
            };
            let score = each.scores(&[placement], None, Watch::NONE).unwrap()[0].unwrap();
            let (mut unreachable, mut sum) = (0, 0.0);
            for index in &all {
                let single = of(&[*index]);
                let one = Placeable {
                    question: &question,
                    path: &single,
                    objective,
                };
                let turned: Vec<PartPlacement> = (0..spins.count)
                    .map(|k| PartPlacement {
                        spin: placement.spin + spins.at(k),
                        ..placement
                    })
                    .collect();
                let scores = one.scores(&turned, None, Watch::NONE).unwrap();
                let best = scores
                    .into_iter()
                    .flatten()
                    .reduce(|a, b| if b.beats(&a) { b } else { a });
                let best = best.unwrap();
                unreachable += best.unreachable;
                sum += if best.unreachable == 0 { best.cost } else { 0.0 };
            }
            assert_eq!((score.unreachable, score.branch), (unreachable, None));
            let mean = sum / all.len() as f64;
            assert!(
                (score.cost - mean).abs() < 1e-12 * mean + 1e-18,
                "{} {mean}",
                score.cost
            );
        }
    }
}

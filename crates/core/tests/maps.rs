//! Maps against single predictions, and against themselves in another order.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

mod arms;

use armill_core::compliance::compliance_at_tool;
use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question, evaluate, evaluate_in_order};
use armill_core::load::{InputUncertainty, LoadCases, LoadFrame, PathLoad};
use armill_core::map::{
    BoxGrid, Counts, along_path, plane_map, probability_within, radial_deviations, volume_map,
};
use armill_core::nalgebra::{Point2, Point3, Vector2, Vector3};
use armill_core::path::{Placing, Shape, Track};
use armill_core::robot::inverse::{ToolAt, posture_at, postures};
use armill_core::robot::{JointCompliance, Robot, Unreachable};
use armill_core::source::elastic::predict;
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::{Cancelled, Watch};
use armill_core::workpiece::{Grid, Plane, Split};

fn cases() -> Vec<Wrench> {
    let force = |y: f64, z: f64| Wrench::from_force(Vector3::new(3.0, y, z));
    vec![
        force(-5.0, -5.0),
        force(-5.0, 5.0),
        force(5.0, -5.0),
        force(5.0, 5.0),
    ]
}

fn analysis<T>(
    robot: &Robot,
    plane: &Plane,
    choice: BranchChoice,
    then: impl FnOnce(&Question<'_>) -> T,
) -> T {
    let (tool, cases) = (Isometry::translation(0.0, 0.0, 0.1), cases());
    then(&Question {
        homes: None,
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model: StiffnessModel::DRIVES,
            flange_from_tool: &tool,
        },
        uncertainty: InputUncertainty::NONE,
        home: None,
        cases: &cases,
        normal: plane.normal(),
        choice,
        clearance: None,
    })
}

fn branch(words: &str) -> BranchChoice {
    BranchChoice::Of(words.parse().unwrap())
}

/// Draw number `draw` of six numbers from the standard normal distribution: Box and Muller's transform of Weyl
/// sequences, a prime's root for each.
fn normals(draw: usize) -> [f64; 6] {
    const PRIMES: [f64; 12] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0];
    let weyl = |prime: f64| ((draw + 1) as f64 * prime.sqrt()).fract();
    std::array::from_fn(|joint| {
        let (a, b) = (weyl(PRIMES[2 * joint]), weyl(PRIMES[2 * joint + 1]));
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    })
}

#[test]
fn probability_and_robust_region_agree_with_arms_of_random_compliances() {
    const DRAWS: usize = 2000;
    let [robot, ..] = arms::all();
    let plane = Plane::tilted(Point3::new(1.0, 0.1, 0.9), 0.5);
    let grid = Grid::within([0.3, 0.3], 0.1);
    let uncertain: Vec<JointCompliance> = robot.compliance().unwrap().to_vec();
    // One case, then four of which another may decide from draw to draw.
    for cases in [&cases()[..1], &cases()] {
        let map_of = |compliance: &[JointCompliance]| {
            let question = Question {
                homes: None,
                arm: Arm {
                    robot: &robot,
                    compliance,
                    model: StiffnessModel::DRIVES,
                    flange_from_tool: &Isometry::translation(0.0, 0.0, 0.1),
                },
                home: None,
                uncertainty: InputUncertainty::NONE,
                cases,
                normal: plane.normal(),
                choice: branch("front elbow-up"),
                clearance: None,
            };
            plane_map(&question, plane, grid, Watch::NONE).unwrap()
        };
        let map = map_of(&uncertain);
        let limit = map.answers.worst().unwrap().1.in_plane * 0.7;
        let mut within = vec![0usize; grid.len()];
        for normal in (0..DRAWS).map(normals) {
            let compliances = uncertain.iter().zip(normal).map(|(c, n)| JointCompliance {
                value: (c.value + n * c.standard_uncertainty).max(0.0),
                standard_uncertainty: 0.0,
            });
            for (index, evaluation) in map_of(&compliances.collect::<Vec<_>>()).answers.evaluations() {
                within[index] += usize::from(evaluation.in_plane <= limit);
            }
        }
        for (index, evaluation) in map.answers.evaluations() {
            let counted = within[index] as f64 / DRAWS as f64;
            let given = probability_within(evaluation, limit).unwrap();
            // Standard deviation of the count: at most 0.011. Other cases can only take away.
            let (least, most) = (given - if cases.len() == 1 { 0.03 } else { 0.15 }, given + 0.03);
            assert!(
                (least..most).contains(&counted),
                "point {index}: {counted} counted, {given} reported"
            );
        }
        let certainty = map.certainty(limit).unwrap();
        assert!(certainty.fraction_robust < certainty.expected_fraction);
        assert!(certainty.expected_fraction < certainty.fraction_possibly);
        assert!(certainty.robust.area < certainty.possibly.area);
    }
}

#[test]
fn uncertainty_of_load_and_tool_agrees_with_changed_loads_and_tools() {
    let [robot, ..] = arms::all();
    // Known, and far below those of load and tool: without any, the uncertainty is not known.
    let exact = |c: &JointCompliance| JointCompliance {
        standard_uncertainty: 1e-9 * c.value,
        ..*c
    };
    let compliance: Vec<JointCompliance> = robot.compliance().unwrap().iter().map(exact).collect();
    let plane = Plane::tilted(Point3::new(1.0, 0.1, 0.9), 0.5);
    let tool = Isometry::translation(0.0, 0.0, 0.1);
    let one = &cases()[..1];
    let (part, u) = (plane.base_from_part, [0.4, 0.3, 0.2]);
    let components = InputUncertainty::NONE
        .of_components(u, LoadFrame::Part, &part)
        .unwrap();
    let uncertainties = [
        InputUncertainty {
            relative: 0.1,
            ..InputUncertainty::NONE
        },
        components,
        InputUncertainty {
            tool_length: 1e-4,
            ..InputUncertainty::NONE
        },
        InputUncertainty {
            relative: 0.1,
            tool_length: 1e-4,
            ..components
        },
    ];
    let given: Vec<Vec<f64>> = uncertainties
        .iter()
        .map(|uncertainty| {
            let question = Question {
                homes: None,
                arm: Arm {
                    robot: &robot,
                    compliance: &compliance,
                    model: StiffnessModel::DRIVES,
                    flange_from_tool: &tool,
                },
                home: None,
                cases: one,
                uncertainty: *uncertainty,
                normal: plane.normal(),
                choice: branch("front elbow-up"),
                clearance: None,
            };
            let map = plane_map(&question, plane, Grid::within([0.3, 0.3], 0.1), Watch::NONE).unwrap();
            let answers = map.answers.evaluations().map(|(index, evaluation)| {
                let q = map.answers.joints_at(index).to_vec();
                let posture = posture_at(&robot, &q, &tool);
                let c = compliance_at_tool(&posture.screws, &compliance);
                let deviation = predict(&posture, &compliance, &one[0]).twist.linear;
                let across = deviation - plane.normal().into_inner() * deviation.dot(&plane.normal());
                let along = across.normalize();
                // A load ten percent larger; a force off along each axis of the part; a tool longer by 0.1 mm, in the
                // same joints.
                let by_size = 0.1 * across.norm();
                let by_force: f64 = (0..3)
                    .map(|k| {
                        let off = part * Vector3::ith(k, u[k]);
                        (c.fixed_view::<3, 3>(0, 0) * off).dot(&along).powi(2)
                    })
                    .sum();
                let longer = tool * Isometry::translation(0.0, 0.0, 1e-4);
                let elsewhere = predict(&posture_at(&robot, &q, &longer), &compliance, &one[0]);
                let by_length = (elsewhere.twist.linear - deviation).dot(&along);
                let expected = [
                    by_size,
                    by_force.sqrt(),
                    by_length.abs(),
                    by_size.hypot(by_force.sqrt()).hypot(by_length),
                ];
                (evaluation.in_plane_uncertainty.unwrap(), expected)
            });
            let which = uncertainties
                .iter()
                .position(|other| other == uncertainty)
                .unwrap();
            answers
                .map(|(u, expected)| {
                    // Differences of deviations of 1e-4 m.
                    assert!(
                        (u - expected[which]).abs() < 1e-15 + 1e-9 * u,
                        "{which}: {u} against {}",
                        expected[which]
                    );
                    u
                })
                .collect()
        })
        .collect();
    assert!(
        given
            .iter()
            .all(|of_one| of_one.len() > 20 && of_one.iter().all(|u| *u > 0.0))
    );
}

#[test]
fn every_point_of_a_map_agrees_with_predict_for_its_posture() {
    for robot in arms::all() {
        let plane = Plane::tilted(Point3::new(1.0, 0.1, 0.9), 0.5);
        let map = analysis(&robot, &plane, branch("front elbow-up"), |question| {
            plane_map(question, plane, Grid::within([0.4, 0.3], 0.05), Watch::NONE).unwrap()
        });
        let tool = Isometry::translation(0.0, 0.0, 0.1);
        for (index, evaluation) in map.answers.evaluations() {
            let posture = posture_at(&robot, map.answers.joints_at(index), &tool);
            let given: Vec<_> = cases()
                .iter()
                .map(|w| predict(&posture, robot.compliance().unwrap(), w))
                .collect();
            let splits: Vec<_> = given
                .iter()
                .map(|d| Split::of(&d.twist.linear, plane.normal()))
                .collect();
            let worst = splits.iter().map(|s| s.in_plane).fold(0.0, f64::max);
            assert!((evaluation.in_plane - worst).abs() < 1e-15, "{}", robot.name());
            assert!((splits[evaluation.worst_case].in_plane - worst).abs() < 1e-15);
            let full = splits.iter().map(|s| s.full).fold(0.0, f64::max);
            assert!((evaluation.full - full).abs() < 1e-15);
            let shares: f64 = map.answers.shares_at(index).iter().sum();
            assert!((shares - evaluation.in_plane).abs() < 1e-15);
            // Uncertainty along the deviation that decides.
            let deviation = given[evaluation.worst_case].twist.linear;
            let in_plane = deviation - plane.normal().into_inner() * deviation.dot(&plane.normal());
            let along = in_plane.normalize();
            let u = (along.transpose() * given[evaluation.worst_case].covariance * along)[0].sqrt();
            assert!((u - evaluation.in_plane_uncertainty.unwrap()).abs() < 1e-15);
        }
        assert!(map.answers.evaluations().count() > 50, "{}", robot.name());
    }
}

#[test]
fn best_is_the_least_of_all_branches_inside_limits() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(0.8, 0.0, 0.8), 0.4);
    let grid = Grid::within([0.4, 0.4], 0.1);
    let map = analysis(&robot, &plane, BranchChoice::Best, |q| {
        plane_map(q, plane, grid, Watch::NONE).unwrap()
    });
    let tool = Isometry::translation(0.0, 0.0, 0.1);
    for (index, point) in map.answers.points.iter().enumerate() {
        let pose = plane.base_from_tool(grid.point(index), 0.0);
        let tool_at = ToolAt::on(&tool);
        let found = postures(&robot, &pose, tool_at).unwrap_or_default();
        let inside = found
            .iter()
            .filter(|p| robot.limit_margin(&p.joints).unwrap().1 >= -1e-9);
        let envelope = |posture: &armill_core::robot::Posture| {
            let c = compliance_at_tool(&posture.screws, robot.compliance().unwrap());
            let of = |w: &Wrench| {
                Split::of(&(c * w.to_vector()).fixed_rows::<3>(0).into(), plane.normal()).in_plane
            };
            cases().iter().map(of).fold(0.0, f64::max)
        };
        let least = inside.map(envelope).min_by(f64::total_cmp);
        match (point, least) {
            (Ok(evaluation), Some(least)) => {
                assert!((evaluation.in_plane - least).abs() < 1e-15 && evaluation.within_limits());
            }
            (Err(_), None) => {}
            (point, least) => panic!("point {index}: {point:?} against {least:?}"),
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let robot = arms::tx2_90();
    let plane = Plane::tilted(Point3::new(0.6, 0.0, 0.5), 0.9);
    let map = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            analysis(&robot, &plane, BranchChoice::Best, |q| {
                plane_map(q, plane, Grid::within([0.5, 0.5], 0.02), Watch::NONE)
                    .unwrap()
                    .answers
            })
        })
    };
    let (one, three) = (map(1), map(3));
    assert_eq!(one.points, three.points);
    assert_eq!(one.deviations, three.deviations);
    assert_eq!(one.joints, three.joints);
}

#[test]
fn a_plane_out_of_reach_is_a_result_with_a_reason() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(5.0, 0.0, 0.8), 0.0);
    let map = analysis(&robot, &plane, BranchChoice::Best, |q| {
        plane_map(q, plane, Grid::within([0.1, 0.1], 0.1), Watch::NONE).unwrap()
    });
    assert!(
        map.answers
            .points
            .iter()
            .all(|p| matches!(p, Err(Unreachable::TooFar { by }) if *by > 3.0))
    );
    let counts = Counts::of(&map.answers, 50e-6);
    assert_eq!((counts.out_of_reach, counts.points()), (9, 9));
    assert_eq!(map.region(50e-6).area, 0.0);
}

#[test]
fn a_volume_and_a_plane_agree_where_they_share_points() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(0.8, 0.0, 0.8), 0.0);
    let (map, volume) = analysis(&robot, &plane, branch("front elbow-up"), |q| {
        let map = plane_map(q, plane, Grid::within([0.2, 0.2], 0.1), Watch::NONE).unwrap();
        let grid = BoxGrid::within(&Isometry::translation(0.8, 0.0, 0.8), [0.1, 0.2, 0.2], 0.1);
        (map, volume_map(q, plane, grid, Watch::NONE).unwrap())
    });
    // Slice x = 800 mm is the second of three; the plane's columns run against base y.
    for row in 0..5 {
        for column in 0..5 {
            let on_plane = map.answers.points[row * 5 + column].as_ref().unwrap().in_plane;
            let in_box = volume.answers.points[1 + 3 * ((4 - column) + 5 * row)]
                .as_ref()
                .unwrap()
                .in_plane;
            assert!((on_plane - in_box).abs() < 1e-15);
        }
    }
}

#[test]
fn in_order_and_at_once_agree_away_from_singularities() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.3);
    analysis(&robot, &plane, branch("front elbow-up"), |question| {
        let pose = |i: usize| plane.base_from_tool(Point2::new(0.01 * i as f64, 0.1), 0.0);
        let at_once = evaluate(question, 30, pose, Watch::NONE).unwrap();
        let in_order = evaluate_in_order(question, 30, pose, Watch::NONE).unwrap();
        assert_eq!(at_once.points, in_order.points);
    });
}

#[test]
fn a_circle_under_constant_load_shifts_and_goes_out_of_round() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
    let circle = Shape::Circle {
        centre: Point2::origin(),
        radius: 0.1,
    };
    let track = Track {
        path: circle.sampled(0.01),
        placing: Placing::on_plane(&plane),
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    };
    let load = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: cases(),
    });
    let path = analysis(&robot, &plane, branch("front elbow-up"), |q| {
        along_path(q, &track, load, Watch::NONE).unwrap()
    });
    let radial = radial_deviations(&track, &path.answers, Point2::origin());
    assert_eq!(radial.len(), 4);
    for (case, radial) in radial.iter().enumerate() {
        // Peak to valley about any centre is at least that about the best, and at most the radial range.
        let range = radial.outward.iter().copied().fold(f64::MIN, f64::max)
            - radial.outward.iter().copied().fold(f64::MAX, f64::min);
        assert!(radial.roundness.peak_to_valley < range, "case {case}");
        let mean = (0..track.len())
            .map(|i| plane.in_part(&path.answers.deviations_at(i)[case]).xy())
            .sum::<Vector2<f64>>()
            / track.len() as f64;
        // The centre follows the mean deviation, up to the second harmonic's share (half a micrometre here).
        assert!(
            (radial.centre_shift - mean).norm() < 0.3 * mean.norm(),
            "case {case}"
        );
    }
    // A load that is the same everywhere is answered with shares; turned with the feed it is not.
    assert_eq!(path.answers.share_count, 6);
}

#[test]
fn a_steady_load_gives_the_same_deviation_in_both_computations() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.3);
    let track = Track {
        path: Shape::rectangle(Point2::origin(), Vector2::new(0.2, 0.1)).sampled(0.01),
        placing: Placing::on_plane(&plane),
        base_from_part: plane.base_from_part,
        spins: None,
        homes: None,
    };
    let of_each = PathLoad::OfEach {
        cases: 4,
        frame: LoadFrame::Base,
        wrenches: (0..track.len()).flat_map(|_| cases()).collect(),
    };
    let steady = PathLoad::Cases(LoadCases {
        frame: LoadFrame::Base,
        cases: cases(),
    });
    let [steady, of_each] = [steady, of_each].map(|load| {
        analysis(&robot, &plane, branch("front elbow-up"), |q| {
            along_path(q, &track, load, Watch::NONE).unwrap().answers
        })
    });
    assert_eq!((steady.share_count, of_each.share_count), (6, 0));
    // Four cases at once against seven unit loads put together: some tens of roundings.
    for ((i, steady), (_, of_each)) in steady.evaluations().zip(of_each.evaluations()) {
        assert!(
            (steady.in_plane - of_each.in_plane).abs() < 1e-12 * steady.in_plane,
            "{i}"
        );
        assert_eq!(
            (steady.name, steady.worst_case),
            (of_each.name, of_each.worst_case)
        );
    }
    assert_eq!(steady.joints, of_each.joints);
}

#[test]
fn work_stops_when_it_is_cancelled() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let watch = Watch {
        finished: &|_| (),
        cancel: &cancel,
    };
    let outcome = analysis(&robot, &plane, BranchChoice::Best, |q| {
        plane_map(q, plane, Grid::within([0.1, 0.1], 0.01), watch).map(|_| ())
    });
    assert_eq!(outcome, Err(Cancelled));
}

#[test]
fn progress_counts_every_point_once() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0);
    let counted = std::sync::atomic::AtomicUsize::new(0);
    let cancel = std::sync::atomic::AtomicBool::new(false);
    let finished = |points: usize| {
        counted.fetch_add(points, std::sync::atomic::Ordering::Relaxed);
    };
    let watch = Watch {
        finished: &finished,
        cancel: &cancel,
    };
    let grid = Grid::within([0.2, 0.2], 0.01);
    analysis(&robot, &plane, BranchChoice::Best, |q| {
        plane_map(q, plane, grid, watch).map(|_| ())
    })
    .unwrap();
    assert_eq!(counted.into_inner(), grid.len());
}

#[test]
fn of_a_point_and_its_mirror_image_the_first_is_the_worst() {
    let (robot, plane) = (arms::mh12(), Plane::tilted(Point3::new(1.0, 0.0, 0.8), 0.0));
    let grid = Grid::within([0.2, 0.2], 0.1);
    analysis(&robot, &plane, branch("front elbow-up"), |question| {
        let map = plane_map(question, plane, grid, Watch::NONE).unwrap();
        let (worst, evaluation) = map.answers.worst().unwrap();
        let (row, column) = (worst / grid.columns, worst % grid.columns);
        let mirrored = row * grid.columns + grid.columns - 1 - column;
        let other = map.answers.points[mirrored].as_ref().unwrap().in_plane;
        assert!((evaluation.in_plane - other).abs() < 1e-12 * other && worst < mirrored);
    });
}

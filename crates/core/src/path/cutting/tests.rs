use super::*;
use crate::frame::Isometry;
use crate::load::{Hand, Mechanistic, Runout};
use crate::path::{Course, DepthOfCut, Move, Sampler, Sampling, Spin};
use nalgebra::{Point3, Unit};
use std::f64::consts::TAU;

/// The cut of `figures.md` section 4.3: 155.6207 N.
fn cutting() -> Cutting {
    let shear = Vector3::new(1930.4e6, 1159.6e6, 200.6e6);
    let law = Mechanistic::new(shear, Vector3::zeros()).unwrap();
    let cutter = Cutter::flat(16e-3, 4).unwrap();
    Cutting {
        cutter: cutter.with_helix(45_f64.to_radians(), Hand::Right).unwrap(),
        law: CuttingLaw::Mechanistic(law.with_relative_uncertainty(0.2).unwrap()),
        depth: 1e-3,
        immersion: Immersion::Up(5e-3),
        feed: Some(40e-3),
        spindle: Some(3333.0 * TAU / 60.0),
        greatest: GreatestForce::SecondCase,
    }
}

fn point(direction: [f64; 3], pace: Pace) -> PathPoint {
    PathPoint {
        normal: None,
        at: Point3::origin(),
        axis: None,
        spin: None,
        direction: Unit::new_normalize(direction.into()),
        along: 0.0,
        pace,
        line: 7,
    }
}

fn placing() -> Placing {
    Placing {
        base_from_path: Isometry::identity(),
        axis: Vector3::z_axis(),
        keeps_axis: false,
        spin: Spin::Fixed(0.0),
    }
}

fn path(points: &[PathPoint], operations: &[(usize, Operation)]) -> SampledPath {
    SampledPath {
        points: points.to_vec(),
        operations: operations.to_vec(),
        ..SampledPath::default()
    }
}

fn along(
    cutting: &Cutting,
    points: &[PathPoint],
    operations: &[(usize, Operation)],
    stock: Option<&mut Stock>,
) -> Result<CuttingForces, NoForces> {
    cutting.along(&path(points, operations), &placing(), stock, Watch::NONE)
}

fn forces(cutting: &Cutting, points: &[PathPoint], operations: &[(usize, Operation)]) -> Vec<Vector3<f64>> {
    let found = along(cutting, points, operations, None).unwrap();
    let of = |here: &CutHere| [here.mean, here.greatest];
    let cases = if found.cuts.greatest == GreatestForce::SecondCase {
        2
    } else {
        1
    };
    let all = found.cuts.points.iter();
    all.flat_map(|here| of(here).into_iter().take(cases)).collect()
}

#[test]
fn the_mean_force_is_the_published_one_wherever_the_feed_goes() {
    for direction in [[1.0, 0.0, 0.0], [-0.3, 0.8, 0.0]] {
        let both = forces(&cutting(), &[point(direction, Pace::Unknown)], &[]);
        assert!((both[0].norm() - 155.6207).abs() < 5e-5, "{}", both[0]);
        assert!(both[1].norm() > both[0].norm());
        let alone = Cutting {
            greatest: GreatestForce::LeftOut,
            ..cutting()
        };
        assert_eq!(forces(&alone, &[point(direction, Pace::Unknown)], &[]), both[..1]);
    }
}

#[test]
fn feed_spindle_and_depths_of_the_program_are_used_where_given() {
    let slow = Operation {
        spindle: Some(3333.0 * TAU / 60.0 / 2.0),
        depths: Some(DepthOfCut {
            axial: 2e-3,
            radial: 5e-3,
        }),
        ..Operation::default()
    };
    let points = [
        point([1.0, 0.0, 0.0], Pace::Feed(40e-3)),
        point([1.0, 0.0, 0.0], Pace::Feed(20e-3)),
    ];
    let found = forces(&cutting(), &points, &[(1, slow)]);
    // Half the feed at half the speed is the same chip; twice the depth is twice the force.
    assert!((found[2] - found[0] * 2.0).norm() < 1e-9);
}

#[test]
fn a_ramp_keeps_the_ratio_of_its_greatest_force_and_a_plunge_has_no_force() {
    let points = [
        point([1.0, 0.0, -0.2], Pace::Unknown),
        point([0.0, 0.0, -1.0], Pace::Unknown),
    ];
    let found = along(&cutting(), &points, &[], None).unwrap();
    assert_eq!(found.summary.without_force, 1);
    let level = along(&cutting(), &points[..1], &[], None).unwrap();
    assert!((level.summary.relative_uncertainty - 0.2).abs() < 0.1);
    let [ramp, plunge] = &found.cuts.points[..] else {
        panic!("two points")
    };
    let flat = forces(&cutting(), &[point([1.0, 0.0, 0.0], Pace::Unknown)], &[]);
    let (mean, peak) = (ramp.mean.norm(), ramp.greatest.norm());
    assert!((peak / mean - flat[1].norm() / flat[0].norm()).abs() < 1e-12);
    assert_eq!(*plunge, CutHere::NOTHING);
}

#[test]
fn values_that_are_not_given_are_reported_with_their_line() {
    let points = [point([1.0, 0.0, 0.0], Pace::Unknown)];
    let no_feed = Cutting {
        feed: None,
        ..cutting()
    };
    let error = along(&no_feed, &points, &[], None).unwrap_err();
    assert_eq!(error, NoForces::NoFeed { line: 7 });
    let no_spindle = Cutting {
        spindle: None,
        ..cutting()
    };
    let error = along(&no_spindle, &points, &[], None).unwrap_err();
    assert_eq!(error, NoForces::NoSpindle { line: 7 });
    let too_wide = Cutting {
        immersion: Immersion::Up(1.0),
        ..cutting()
    };
    let error = along(&too_wide, &points, &[], None).unwrap_err().to_string();
    assert!(
        error.starts_with("line 7: ") && error.contains("radial"),
        "{error}"
    );
}

/// A square pocket of 40 mm in a box: out from the middle, then round.
fn pocket() -> Vec<PathPoint> {
    let mut sampler = Sampler::new(Sampling {
        chord_error: 1e-5,
        step: 0.5e-3,
    });
    let mut points = Vec::new();
    let to = |x: f64, y: f64, pace| Move {
        end: Point3::new(x, y, -1e-3),
        axis: None,
        spin: None,
        course: Course::Line,
        pace,
        line: 1,
    };
    let feed = Pace::Feed(40e-3);
    for next in [
        to(-60e-3, 0.0, Pace::Rapid),
        to(20e-3, 0.0, feed),
        to(20e-3, 5e-3, feed),
        to(-60e-3, 5e-3, feed),
    ] {
        sampler.points(&next, |point| points.push(point));
    }
    points
}

#[test]
fn in_a_stock_the_cut_starts_in_air_then_is_a_slot_and_then_a_step_over() {
    let corners = [
        Point3::new(-40e-3, -40e-3, -10e-3),
        Point3::new(40e-3, 40e-3, 0.0),
    ];
    let mut stock = Stock::new(corners, 0.25e-3).unwrap();
    let points = pocket();
    let found = along(&cutting(), &points, &[], Some(&mut stock)).unwrap();
    let engagement = found.summary.stock_engagement.unwrap();
    assert!(
        engagement.in_air > 10 && engagement.slots > 50 && engagement.leaning == 0,
        "{engagement:?}"
    );
    assert!(
        (engagement.largest_depth - 1e-3).abs() < 1e-6 && (engagement.largest_width - 16e-3).abs() < 1e-9
    );
    assert_eq!(found.cuts.points[0], CutHere::NOTHING);
    let at = |x: f64, y: f64| {
        let near = |point: &PathPoint| (point.at.xy() - nalgebra::Point2::new(x, y)).norm() < 1e-6;
        found.cuts.points[points.iter().position(near).unwrap()]
    };
    let constant = |immersion| {
        let alone = Cutting {
            immersion,
            ..cutting()
        };
        forces(&alone, &[point([1.0, 0.0, 0.0], Pace::Unknown)], &[])
    };
    let slot = at(-10e-3, 0.0);
    // Heights are stored to 6e-8 of the box.
    assert!((slot.mean - constant(Immersion::Slot)[0]).norm() < 1e-6 * slot.mean.norm());
    // Its greatest force is that of a cut equal to a fiftieth of the diameter, a tenth of the depth here.
    let greatest = constant(Immersion::Slot)[1];
    assert!((slot.greatest - greatest).norm() < 0.05 * greatest.norm());
    // Back to -x the slot is on the left, 5 mm of material on the right: down-milling.
    let back = at(-10e-3, 5e-3);
    let down = constant(Immersion::Down(5e-3));
    // Edges of a strip are accurate to a quarter of a millimetre here: 5 % of its width.
    assert!(
        (back.mean - down[0]).norm() < 0.06 * down[0].norm(),
        "{} {}",
        back.mean,
        down[0]
    );
    let share = |mean: Vector3<f64>, greatest: Vector3<f64>| greatest.norm() / mean.norm();
    // Both strips differ by as little, and cuts equal to a fiftieth of the diameter share their greatest force.
    assert!((share(back.mean, back.greatest) / share(down[0], down[1]) - 1.0).abs() < 0.05);
}

#[test]
fn a_tilted_tool_has_the_constant_engagement() {
    let corners = [
        Point3::new(-40e-3, -40e-3, -10e-3),
        Point3::new(40e-3, 40e-3, 0.0),
    ];
    let mut stock = Stock::new(corners, 1e-3).unwrap();
    let leaning = PathPoint {
        axis: Some(Unit::new_normalize(Vector3::new(0.0, 0.3, 1.0))),
        ..point([1.0, 0.0, 0.0], Pace::Unknown)
    };
    let found = along(&cutting(), &[leaning], &[], Some(&mut stock)).unwrap();
    assert_eq!(found.summary.stock_engagement.unwrap().leaning, 1);
    assert_eq!(found.cuts, along(&cutting(), &[leaning], &[], None).unwrap().cuts);
}

#[test]
fn long_computations_can_be_cancelled() {
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let watch = Watch {
        cancel: &cancel,
        ..Watch::NONE
    };
    let stopped = cutting().along(&path(&pocket(), &[]), &placing(), None, watch);
    assert_eq!(stopped, Err(NoForces::Cancelled));
}

#[test]
fn the_tool_of_the_program_cuts_with_its_size() {
    let feed = Pace::Feed(40e-3);
    let points = [point([1.0, 0.0, 0.0], feed), point([1.0, 0.0, 0.0], feed)];
    let wide = Operation {
        diameter: Some(20e-3),
        ..Operation::default()
    };
    let found = along(&cutting(), &points, &[(1, wide)], None).unwrap();
    let of_20 = Cutting {
        cutter: cutting().cutter.of_size(20e-3, 0.0).unwrap(),
        ..cutting()
    };
    let alone = along(&of_20, &points, &[], None).unwrap();
    assert_eq!(found.cuts.points[1].mean, alone.cuts.points[1].mean);
    assert_ne!(found.cuts.points[0].mean, alone.cuts.points[0].mean);
    assert_eq!(found.cuts.cutters[found.cuts.points[1].cutter].diameter(), 20e-3);
    let none = Operation {
        diameter: Some(1e-9),
        line: 9,
        ..Operation::default()
    };
    let error = along(&cutting(), &points, &[(1, none)], None)
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("line 9: ") && error.contains("diameter"),
        "{error}"
    );
}

#[test]
fn a_shallow_ball_cuts_with_the_force_of_its_engaged_strip() {
    // At 0.2 mm depth a ball of 10 mm has a radius of 1.4 mm: a strip based on the full diameter would be next to it.
    let ball = Cutting {
        cutter: Cutter::ball(10e-3, 2).unwrap(),
        depth: 0.2e-3,
        ..cutting()
    };
    let at = |immersion| {
        let given = along(
            &Cutting { immersion, ..ball },
            &[point([1.0, 0.0, 0.0], Pace::Unknown)],
            &[],
            None,
        )
        .unwrap();
        assert_eq!(given.summary.without_force, 0);
        given.cuts.points[0].mean
    };
    let shallow = at(Immersion::Up(0.5e-3));
    assert!(shallow.norm() > 1.0, "{shallow}");
    // Wider is more, up to the width of its own groove.
    let sizes = [0.1e-3, 0.5e-3, 1.4e-3, 2.7e-3].map(|ae| at(Immersion::Down(ae)).norm());
    assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]), "{sizes:?}");
    assert_eq!(at(Immersion::Up(2.9e-3)), at(Immersion::Slot));
    // The engagement in a stock with this strip: a groove next to its own groove.
    let corners = [Point3::new(-0.04, -0.02, -0.01), Point3::new(0.04, 0.02, 0.0)];
    let mut stock = Stock::new(corners, 0.05e-3).unwrap();
    let grooves: Vec<PathPoint> = [
        (-0.03, 0.0),
        (0.03, 0.0),
        (-0.03, 0.5e-3),
        (0.0, 0.5e-3),
        (0.3e-3, 0.5e-3),
    ]
    .into_iter()
    .enumerate()
    .map(|(k, (x, y))| PathPoint {
        at: Point3::new(x, y, -0.2e-3),
        // Each groove starts a new cut.
        along: if k == 2 { 0.0 } else { k as f64 },
        ..point([1.0, 0.0, 0.0], Pace::Unknown)
    })
    .collect();
    let found = along(&ball, &grooves, &[], Some(&mut stock)).unwrap();
    let strip = found.cuts.points[4].cut.unwrap().engagement.edges();
    // The ridge between both begins half a radial depth from the axis, not at the rim less the radial depth: deeper in
    // the cut it is wider. Both go on beyond the rim on the left.
    assert_eq!(strip[1], 5e-3);
    assert!((strip[0] + 0.25e-3).abs() < 0.3e-3, "{strip:?}");
}

#[test]
fn a_tool_whose_edges_pass_next_to_the_material_has_no_force_and_is_reported() {
    let soft = Mechanistic::new(Vector3::zeros(), Vector3::zeros()).unwrap();
    let nothing = Cutting {
        law: CuttingLaw::Mechanistic(soft),
        ..cutting()
    };
    let found = along(&nothing, &[point([1.0, 0.0, 0.0], Pace::Unknown)], &[], None).unwrap();
    assert_eq!(
        (found.summary.without_force, found.summary.largest_mean),
        (1, 0.0)
    );
    assert_eq!(found.cuts.points[0].greatest, Vector3::zeros());
}

#[test]
fn the_engagement_in_a_stock_adds_up_to_the_removed_volume() {
    let corners = [
        Point3::new(-40e-3, -40e-3, -10e-3),
        Point3::new(40e-3, 40e-3, 0.0),
    ];
    let mut stock = Stock::new(corners, 0.5e-3).unwrap();
    let (full, points) = (stock.volume(), pocket());
    let engagement = along(&cutting(), &points, &[], Some(&mut stock))
        .unwrap()
        .summary
        .stock_engagement
        .unwrap();
    assert!((full - stock.volume() - engagement.removed).abs() < 1e-7 * full);
    // In a second pass there is nothing left.
    let again = along(&cutting(), &points, &[], Some(&mut stock)).unwrap();
    let engagement = again.summary.stock_engagement.unwrap();
    assert_eq!(engagement.removed, 0.0);
    // Short steps detect the wall ahead of a corner two pitches early, which is two points of this path.
    assert!(engagement.in_air + 2 >= points.len(), "{engagement:?}");
    let of_air = again.cuts.points.iter().filter(|here| **here == CutHere::NOTHING);
    assert_eq!(of_air.count(), engagement.in_air);
}

#[test]
fn the_greatest_force_is_reported_at_the_largest_mean_even_if_it_is_not_a_case() {
    let points = [
        point([1.0, 0.0, 0.0], Pace::Feed(20e-3)),
        point([1.0, 0.0, 0.0], Pace::Feed(40e-3)),
        point([1.0, 0.0, 0.0], Pace::Feed(30e-3)),
    ];
    let both = along(&cutting(), &points, &[], None).unwrap();
    let alone = Cutting {
        greatest: GreatestForce::LeftOut,
        ..cutting()
    };
    let mean = along(&alone, &points, &[], None).unwrap();
    assert_eq!(mean.summary.largest_mean, both.summary.largest_mean);
    assert!((mean.summary.greatest / both.summary.greatest - 1.0).abs() < 1e-12);
    assert_eq!(mean.summary.largest_mean, mean.cuts.points[1].mean.norm());
    assert!(
        mean.cuts
            .points
            .iter()
            .all(|here| here.greatest == Vector3::zeros())
    );
}

#[test]
fn a_tool_used_again_is_listed_once() {
    let feed = Pace::Feed(40e-3);
    let points = [point([1.0, 0.0, 0.0], feed); 4];
    let of = |diameter| Operation {
        diameter,
        ..Operation::default()
    };
    let operations = [
        (0, of(Some(20e-3))),
        (1, of(None)),
        (2, of(Some(20e-3))),
        (3, of(Some(-1.0))),
    ];
    let found = along(&cutting(), &points, &operations, None).unwrap();
    let used: Vec<usize> = found.cuts.points.iter().map(|here| here.cutter).collect();
    assert_eq!((found.cuts.cutters.len(), used), (2, vec![1, 0, 1, 0]));
}

#[test]
fn a_cut_after_another_has_the_force_that_it_has_alone() {
    let even = Cutting {
        greatest: GreatestForce::LeftOut,
        ..cutting()
    };
    let runout = Runout {
        offset: 20e-6,
        angle: 0.3,
    };
    let with_runout = Cutting {
        cutter: even.cutter.with_runout(runout).unwrap(),
        ..even
    };
    let [feed, slow] = [40e-3, 20e-3].map(Pace::Feed);
    let [level, ramp] = [[1.0, 0.0, 0.0], [0.8, 0.0, 0.6]];
    // A cut like the one before, one that differs in its feed, one in its direction, and the first again.
    let points = [
        (level, feed),
        (level, feed),
        (level, slow),
        (ramp, slow),
        (level, slow),
        (level, feed),
    ]
    .map(|(direction, pace)| point(direction, pace));
    for cutting in [even, with_runout] {
        let together = forces(&cutting, &points, &[]);
        let alone = points.map(|point| forces(&cutting, &[point], &[])[0]);
        assert_eq!(together, alone);
        assert_eq!(together[0], together[1]);
        assert!(together[1] != together[2] && together[2] != together[3]);
    }
}

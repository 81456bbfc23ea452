use super::*;
use crate::motion::limits::JointLimits;
use crate::path::{Course, Move, Pace, PathBuilder, Sampling, Step};

/// Slides along x, y, z with these limits, m/s and m/s^2.
fn slides(acceleration: f64) -> MotionModel {
    MotionModel {
        limits: MotionLimits {
            joints: vec![
                JointLimits {
                    speed: 1.0,
                    acceleration,
                };
                3
            ],
            acceleration: f64::INFINITY,
        },
        smoothing: 0.0,
        settling: 0.0,
        shortest_blending: 0.0,
        lags: vec![
            Lag {
                time: 0.0,
                feed_forward: 0.0,
            };
            3
        ],
        motor_leads: Vec::new(),
        passage: Passage::Stop,
        feed: None,
        rapid: 0.5,
    }
}

/// A path through these points, mm, at these speeds; 0 is a rapid, less than 0 a cut without a feed.
fn path(moves: &[([f64; 3], f64)]) -> SampledPath {
    let mut builder = PathBuilder::new(
        Sampling {
            chord_error: 1e-5,
            step: 1e-3,
        },
        1_000_000,
    );
    for (line, (end, speed)) in (1..).zip(moves) {
        builder.take(Step::Move(Move {
            end: Point3::from(*end) * 1e-3,
            axis: None,
            spin: None,
            course: Course::Line,
            pace: match *speed {
                0.0 => Pace::Rapid,
                speed if speed < 0.0 => Pace::Unknown,
                speed => Pace::Feed(speed),
            },
            line,
        }));
    }
    builder.finish().unwrap()
}

fn motion(path: &SampledPath, model: &MotionModel) -> Result<Motion, NoFeed> {
    let points: Vec<Point3<f64>> = path.points.iter().map(|point| point.at).collect();
    let positions: Vec<f64> = points.iter().flat_map(|at| [at.x, at.y, at.z]).collect();
    motion_along(
        &Postures {
            path,
            points: &points,
            positions: &positions,
            has_posture: &|_| true,
            jumps: &|_| false,
            tip: &|q| Point3::new(q[0], q[1], q[2]),
        },
        model,
    )
}

const L: [([f64; 3], f64); 3] = [
    ([0.0; 3], 0.0),
    ([200.0, 0.0, 0.0], 0.1),
    ([200.0, 200.0, 0.0], 0.1),
];

#[test]
fn cuts_with_stops_take_the_time_of_two_trapezoids() {
    let path = path(&L);
    let found = motion(&path, &slides(2.5)).unwrap();
    // The full speed is reached at a point.
    let each = 0.2 / 0.1 + 0.1 / 2.5;
    assert!(
        (found.duration() - 2.0 * each).abs() < 1e-9,
        "{}",
        found.duration()
    );
    assert!((found.programmed - 4.0).abs() < 1e-12);
    assert_eq!(found.limiting[200], Limiting::Stop);
    assert!((found.speeds[100] - 0.1).abs() < 1e-12 && found.speeds[200] < 1e-8);
    assert_eq!(found.limiting[100], Limiting::Feed);
    assert!((found.times[200] - each).abs() < 1e-6);
    assert!(found.times.is_sorted() && found.blending.iter().all(|error| error.norm() == 0.0));
    // Twice the smoothing longer.
    let smooth = MotionModel {
        smoothing: 0.03,
        ..slides(2.5)
    };
    let smooth = motion(&path, &smooth).unwrap();
    assert!((smooth.duration() - found.duration() - 0.06).abs() < 1e-12);
}

#[test]
fn a_zone_keeps_more_of_the_feed_than_a_stop_and_leaves_the_corner() {
    let path = path(&L);
    let at_corner = |zone: f64| {
        let model = MotionModel {
            passage: Passage::Zone(zone),
            ..slides(2.5)
        };
        let found = motion(&path, &model).unwrap();
        // The detail is that of the corner, and no joint is late.
        let duration = found.duration();
        let detail = found.largest.unwrap();
        assert_eq!((detail.index, detail.distance), (200, found.blending[200].norm()));
        assert_eq!(detail.commanded, detail.followed);
        let corner = Point3::new(0.2, 0.0, 0.0);
        let nearest = detail.commanded.iter().map(|at| (at - corner).norm());
        assert!((nearest.fold(1.0, f64::min) - detail.distance).abs() < 1e-12);
        (found.speeds[200], found.blending[200].norm(), duration)
    };
    // With a stop 4.08 s; without a corner 4.04 s.
    let (mut slower, mut longer) = (0.0, 4.075);
    for zone in [0.0005, 0.002, 0.01, 0.05] {
        let (speed, error, duration) = at_corner(zone);
        assert!(
            (error - 7.0 / 16.0 * zone * 45f64.to_radians().sin()).abs() < 1e-12,
            "{error}"
        );
        assert!(
            speed >= slower && duration < longer,
            "{zone}: {speed} {duration} {longer}"
        );
        (slower, longer) = (speed, duration);
        // In the middle of the curve each slide accelerates by 2.5 r (dw/dt)^2, at a speed of sqrt(2) r dw/dt.
        let fastest = (2.5_f64 / 2.5 * zone).sqrt() * 2f64.sqrt();
        assert!(
            speed < fastest.min(0.1) * 1.0001 && speed > 0.8 * fastest.min(0.1),
            "{zone}: {speed} {fastest}"
        );
    }
    assert!((slower - 0.1).abs() < 1e-9);
    // A zone by its error: that of a parabola, which leaves the corner most.
    let model = MotionModel {
        passage: Passage::Within {
            error: 2e-5,
            most: 0.01,
        },
        ..slides(2.5)
    };
    let error = motion(&path, &model).unwrap().blending[200].norm();
    assert!((error - 7.0 / 8.0 * 2e-5).abs() < 1e-9, "{error}");
    // The shortest blending time makes a small zone larger: half of it before the corner.
    let model = MotionModel {
        passage: Passage::Zone(1e-4),
        shortest_blending: 0.04,
        ..slides(2.5)
    };
    let error = motion(&path, &model).unwrap().blending[200].norm();
    assert!(
        (error - 7.0 / 16.0 * 0.002 * 45f64.to_radians().sin()).abs() < 1e-12,
        "{error}"
    );
}

#[test]
fn rapids_waits_and_unknown_feeds() {
    let mut path = path(&[
        ([0.0; 3], 0.0),
        ([100.0, 0.0, 0.0], 0.1),
        ([100.0, 0.0, 50.0], 0.0),
        ([300.0, 0.0, 50.0], 0.0),
        ([300.0, 0.0, 0.0], 0.0),
        ([300.0, 100.0, 0.0], -1.0),
    ]);
    assert_eq!(motion(&path, &slides(2.5)), Err(NoFeed { line: 6 }));
    let model = MotionModel {
        feed: Some(0.1),
        rapid: 5.0,
        ..slides(2.5)
    };
    let found = motion(&path, &model).unwrap();
    // 0.2 m of the slide: never at its full speed.
    assert!(
        (found.rapids - 2.0 * (0.2 / 2.5_f64).sqrt()).abs() < 1e-12,
        "{}",
        found.rapids
    );
    // The tip has 0.3 m to go.
    let slow = motion(
        &path,
        &MotionModel {
            rapid: 0.2,
            ..model.clone()
        },
    )
    .unwrap();
    assert!((slow.rapids - 1.5).abs() < 1e-12, "{}", slow.rapids);
    assert!((found.cutting - 2.0 * (1.0 + 0.04)).abs() < 1e-9);
    path.commands.push(crate::path::PlacedCommand {
        points: 50,
        rapids: 0,
        command: Command::Dwell(0.7),
    });
    let waiting = motion(&path, &model).unwrap();
    assert_eq!(waiting.waits, 0.7);
    assert!((waiting.duration() - found.duration() - 0.7 - 0.04).abs() < 1e-9);
    assert!(waiting.times[49] - waiting.times[48] > 0.7);
}

#[test]
fn a_circle_that_is_followed_late_is_smaller_by_half_the_square_of_the_angle_per_time_constant() {
    let (radius, feed, late) = (0.05, 0.2, 0.02);
    let mut circle = crate::path::Shape::Circle {
        centre: nalgebra::Point2::origin(),
        radius,
    }
    .sampled(0.5e-3);
    for point in &mut circle.points {
        point.pace = Pace::Feed(feed);
    }
    let mut model = slides(40.0);
    for lag in &mut model.lags {
        lag.time = late;
    }
    let found = motion(&circle, &model).unwrap();
    let middle = circle.points.len() / 2;
    let angle: f64 = feed / radius * late;
    let expected = radius * (1.0 - 1.0 / angle.hypot(1.0));
    let error = found.servo[middle];
    assert!(
        (error.norm() - expected).abs() < 2e-6,
        "{} {expected}",
        error.norm()
    );
    assert!((error.norm() - 0.5 * radius * angle * angle).abs() < 0.01 * expected);
    let inwards = (Point3::origin() - circle.points[middle].at).normalize();
    assert!((error.normalize() - inwards).norm() < 1e-2);
}

#[test]
fn a_tip_that_turns_back_late_stays_behind_by_its_speed_times_the_lag_and_ln_2() {
    let path = path(&[
        ([0.0; 3], 0.0),
        ([100.0, 0.0, 0.0], 0.03),
        ([0.0, 0.0, 0.0], 0.03),
    ]);
    let mut model = slides(500.0);
    model.passage = Passage::Zone(1e-6);
    for lag in &mut model.lags {
        lag.time = 0.015;
    }
    let found = motion(&path, &model).unwrap();
    let expected = 0.03 * 0.015 * 2f64.ln();
    assert!(
        (found.servo[100].norm() - expected).abs() < 0.02 * expected,
        "{} {expected}",
        found.servo[100]
    );
    assert!(found.servo[50].norm() < 1e-9);
}

#[test]
fn a_point_without_posture_divides_the_path_and_has_no_time() {
    let path = path(&L);
    let points: Vec<Point3<f64>> = path.points.iter().map(|point| point.at).collect();
    let positions: Vec<f64> = points.iter().flat_map(|at| [at.x, at.y, at.z]).collect();
    let found = motion_along(
        &Postures {
            path: &path,
            points: &points,
            positions: &positions,
            has_posture: &|index| index != 50,
            jumps: &|index| index == 300,
            tip: &|q| Point3::new(q[0], q[1], q[2]),
        },
        &slides(2.5),
    )
    .unwrap();
    assert!(found.times[50].is_nan() && found.speeds[50].is_nan());
    assert!([49, 51, 299, 300].iter().all(|index| found.speeds[*index] < 1e-8));
    assert!(found.times[51] >= found.times[49]);
}

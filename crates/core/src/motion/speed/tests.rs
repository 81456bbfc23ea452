use super::*;
use crate::motion::limits::JointLimits;

fn limits(joints: &[[f64; 2]], acceleration: f64) -> MotionLimits {
    let joints = joints.iter().map(|[speed, acceleration]| JointLimits {
        speed: *speed,
        acceleration: *acceleration,
    });
    MotionLimits {
        joints: joints.collect(),
        acceleration,
    }
}

/// A straight move of one joint, 1 rad/m.
fn straight(count: usize, length: f64) -> JointPath {
    let along: Vec<f64> = (0..count)
        .map(|i| length * i as f64 / (count - 1) as f64)
        .collect();
    JointPath::new(1, &along, along.clone(), |_| false)
}

#[test]
fn one_axis_has_the_trapezoid_by_hand() {
    let path = straight(1001, 1.0);
    for (speed, acceleration) in [(0.5, 2.0), (10.0, 2.0)] {
        let profile = fastest(
            &path,
            &limits(&[[speed, acceleration]], f64::INFINITY),
            &vec![9.0; 1000],
        );
        let by_hand = from_rest_to_rest(1.0, speed, acceleration);
        let time = profile.times[1000];
        // The acceleration changes at points of the path alone.
        assert!((time / by_hand - 1.0).abs() < 1e-5, "{time} {by_hand}");
        let middle = profile.speeds[500];
        assert!(
            (middle - f64::min(speed, 2.0_f64.sqrt())).abs() < 1e-9,
            "{middle}"
        );
    }
}

#[test]
fn a_feed_and_its_change_are_kept_with_the_path_acceleration() {
    let path = straight(2001, 1.0);
    let feeds: Vec<f64> = (0..2000).map(|i| if i < 1000 { 0.2 } else { 0.05 }).collect();
    let profile = fastest(&path, &limits(&[[9.0, 99.0]], 0.5), &feeds);
    // Acceleration, feed, deceleration to the second feed before the middle, feed, deceleration.
    let (v, w, a) = (0.2, 0.05, 0.5);
    let first = v / a + (0.5 - 0.5 * v * v / a - 0.5 * (v * v - w * w) / a) / v + (v - w) / a;
    let second = (0.5 - 0.5 * w * w / a) / w + w / a;
    let time = profile.times[2000];
    assert!((time / (first + second) - 1.0).abs() < 1e-9, "{time}");
    assert_eq!(profile.limiting[500], Limiting::Feed);
    assert_eq!(profile.limiting[10], Limiting::PathAcceleration);
}

/// A curved path of three joints, as a robot has them.
fn curved(count: usize) -> JointPath {
    let along: Vec<f64> = (0..count).map(|i| 2.0 * i as f64 / (count - 1) as f64).collect();
    let q = |s: f64| [(2.0 * s).sin(), 0.7 * (3.0 * s).cos(), 0.2 * s * s - 0.5 * s];
    let positions: Vec<f64> = along.iter().flat_map(|s| q(*s)).collect();
    JointPath::new(3, &positions, along, |_| false)
}

const CURVED: [[f64; 2]; 3] = [[1.5, 6.0], [2.0, 9.0], [1.0, 3.0]];

#[test]
fn all_limits_are_kept_and_something_limits_every_point() {
    let path = curved(4001);
    let limits = limits(&CURVED, 20.0);
    let profile = fastest(&path, &limits, &vec![1.2; 4000]);
    for index in 0..4000 {
        let (v, w) = (profile.speeds[index], profile.speeds[index + 1]);
        let (x, u) = (v * v, (w * w - v * v) / (2.0 * path.step(index)));
        let mut nearest = (1.2 / v).min(f64::INFINITY);
        for ((slope, curvature), limit) in path.after(index).zip(&limits.joints) {
            let (speed, acceleration) = ((slope * v).abs(), (slope * u + curvature * x).abs());
            assert!(speed <= limit.speed * (1.0 + 1e-9), "{index}: {speed}");
            assert!(
                acceleration <= limit.acceleration * (1.0 + 1e-6),
                "{index}: {acceleration}"
            );
            nearest = nearest
                .min(limit.speed / speed)
                .min(limit.acceleration / acceleration);
        }
        nearest = nearest.min(20.0 / u.abs());
        assert!(nearest < 1.02, "{index}: nothing limits it, {nearest}");
    }
}

#[test]
fn it_does_not_depend_on_the_number_of_points() {
    let limits = limits(&CURVED, 20.0);
    let time = |count: usize| {
        let profile = fastest(&curved(count), &limits, &vec![1.2; count - 1]);
        profile.times[count - 1]
    };
    let (coarse, fine) = (time(2001), time(32_001));
    assert!((coarse / fine - 1.0).abs() < 2e-3, "{coarse} {fine}");
}

#[test]
fn the_fastest_along_a_circle_of_two_axes_is_by_hand() {
    // Radius 0.1 m, greatest acceleration of each axis 1 m/s2: at constant speed sqrt(a r) at most; faster at no point.
    let count = 20_001;
    let along: Vec<f64> = (0..count).map(|i| i as f64 * 1e-4).collect();
    let positions: Vec<f64> = along
        .iter()
        .flat_map(|s| [0.1 * (s / 0.1).sin(), 0.1 * (s / 0.1).cos()])
        .collect();
    let path = JointPath::new(2, &positions, along, |_| false);
    let profile = fastest(
        &path,
        &limits(&[[9.0, 1.0], [9.0, 1.0]], f64::INFINITY),
        &vec![9.0; count - 1],
    );
    let all = &profile.speeds[2000..18_000];
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    // Where one axis turns back it has the whole acceleration v^2 / r; between them both have a share of it.
    assert!((least - 0.1_f64.sqrt()).abs() < 1e-3, "{least}");
    assert!(
        all.iter()
            .all(|v| *v < 0.1_f64.sqrt() * 2.0_f64.powf(0.25) + 1e-3)
    );
}

#[test]
fn stops_are_kept_also_next_to_each_other() {
    let along: Vec<f64> = (0..101).map(|i| 0.01 * f64::from(i)).collect();
    let path = JointPath::new(1, &along.clone(), along, |index| index == 50 || index == 51);
    let profile = fastest(&path, &limits(&[[9.0, 2.0]], f64::INFINITY), &[9.0; 100]);
    let by_hand = from_rest_to_rest(0.5, 9.0, 2.0)
        + from_rest_to_rest(0.01, 9.0, 2.0)
        + from_rest_to_rest(0.49, 9.0, 2.0);
    assert!((profile.times[100] / by_hand - 1.0).abs() < 1e-3);
    assert_eq!((profile.speeds[50], profile.limiting[50]), (0.0, Limiting::Stop));
}

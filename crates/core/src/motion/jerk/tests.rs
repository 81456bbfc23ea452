use super::*;
use crate::motion::limits::{JointLimits, MotionLimits};
use crate::motion::{JointPath, fastest};

/// 1 m with 0.5 m/s and 2 m/s2.
fn trapezoid() -> (SpeedProfile, Vec<f64>) {
    let along: Vec<f64> = (0..1001).map(|i| f64::from(i) * 1e-3).collect();
    let path = JointPath::new(1, &along, along.clone(), |_| false);
    let limits = MotionLimits {
        joints: vec![JointLimits {
            speed: 0.5,
            acceleration: 2.0,
        }],
        acceleration: f64::INFINITY,
    };
    (fastest(&path, &limits, &[9.0; 1000]), along)
}

#[test]
fn a_trapezoid_becomes_the_profile_of_seven_sections() {
    let (profile, along) = trapezoid();
    let window = 0.08;
    let timed = Timed::of(&profile, &along, window);
    let (v, a, t) = (0.5, 2.0, window);
    let jerk = a / t;
    assert!((timed.duration() - (1.0 / v + v / a + t)).abs() < 1e-5);
    // Speeds by hand in the sections of the acceleration.
    for time in [0.02, 0.05, 0.08] {
        assert!(
            (timed.at(time).speed - 0.5 * jerk * time * time).abs() < 1e-4,
            "{time}"
        );
    }
    for time in [0.1, 0.2, 0.25] {
        assert!(
            (timed.at(time).speed - (0.5 * a * t + a * (time - t))).abs() < 1e-4,
            "{time}"
        );
    }
    let rest = v / a + t - 0.3;
    assert!((timed.at(0.3).speed - (v - 0.5 * jerk * rest * rest)).abs() < 1e-4);
    assert!((timed.at(1.0).speed - v).abs() < 1e-9);
    assert!((timed.at(timed.duration()).along - 1.0).abs() < 1e-12);
}

#[test]
fn the_speed_is_the_derivative_of_the_position_with_and_without_a_window() {
    let (profile, along) = trapezoid();
    for window in [0.0, 0.05] {
        let timed = Timed::of(&profile, &along, window);
        for i in 1..100 {
            let time = timed.duration() * f64::from(i) / 100.0;
            let step = 1e-6;
            let by_difference = (timed.at(time + step).along - timed.at(time - step).along) / (2.0 * step);
            assert!((by_difference - timed.at(time).speed).abs() < 1e-5, "{time}");
        }
    }
}

#[test]
fn points_are_passed_at_the_times_at_which_the_motion_is_there() {
    let (profile, along) = trapezoid();
    for window in [0.0, 0.05] {
        let timed = Timed::of(&profile, &along, window);
        let times = timed.times_at(&along);
        assert!(times.is_sorted());
        for (time, at) in times.iter().zip(&along) {
            assert!((timed.at(*time).along - at).abs() < 1e-9, "{at}");
        }
    }
    let exact = Timed::of(&profile, &along, 0.0).times_at(&along);
    for (time, of_profile) in exact.iter().zip(&profile.times) {
        assert!((time - of_profile).abs() < 1e-6);
    }
}

//! The motion along a path: what the controller makes of it.

use std::path::Path;

use armill_core::watch::Watch;
use armill_study::analysis::AnalysisData;
use armill_study::file::resolve::read;
use armill_study::run::run;

use crate::{PLATE, answered, found, plate_with};

const SQUARE: &str = "[[analysis]]\nkind = \"path\"\nname = \"s\"\nrectangle = { size_mm = [120, 80] }\n";

#[test]
fn a_square_takes_longer_with_stops_than_with_zones_and_the_values_that_are_assumed_are_named() {
    let with = |keys: &str| {
        answered(&plate_with(&format!(
            "[motion]\nfeed_mm_per_min = 6000\n{keys}\n{SQUARE}"
        )))
    };
    let [stops, zones] =
        ["zone_mm = 0", "zone_mm = 5"].map(|keys| with(keys).paths[0].motion.clone().unwrap());
    // 400 mm at 100 mm/s.
    assert!((stops.programmed_time_s - 4.0).abs() < 1e-9, "{stops:?}");
    assert!(
        stops.cycle_time_s > zones.cycle_time_s && zones.cycle_time_s > 3.9,
        "{stops:?} {zones:?}"
    );
    assert_eq!(
        (stops.largest_blending_um, stops.rapid_time_s, stops.wait_time_s),
        (0.0, 0.0, 0.0)
    );
    // A zone of 5 mm at a right angle: 7/16 of its radius times the sine of half the angle.
    assert!(
        (zones.largest_blending_um - 5000.0 * 7.0 / 16.0 * 45f64.to_radians().sin()).abs() < 0.1,
        "{zones:?}"
    );
    assert!(zones.length_at_feed_percent > stops.length_at_feed_percent);
    // Rounded by 1.5 mm: more than any tolerance here.
    let warned = |keys: &str| {
        let warnings = with(keys).warnings;
        warnings
            .iter()
            .any(|warning| warning.contains("rounded corners alone move the tool by up to"))
    };
    assert!(warned("zone_mm = 5") && !warned("zone_mm = 0"));
    // 6 values, of which each result says so.
    assert_eq!(stops.assumed.len(), 6, "{:?}", stops.assumed);
    assert!(
        stops
            .places
            .iter()
            .any(|place| place.limited_by == "stop" && place.advice.contains("zone"))
    );
    let given = with(
        "zone_mm = 5\nlag_ms = [0]\nsmoothing_ms = 0\nsettling_ms = 0\nshortest_blending_ms = 0\npath_acceleration_mm_per_s2 = 3000\njoint_acceleration_deg_per_s2 = [500, 500, 500, 900, 900, 900]",
    );
    let given = given.paths[0].motion.clone().unwrap();
    assert_eq!((given.assumed.len(), given.largest_servo_um), (0, 0.0));
    assert_eq!(given.largest_servo_u_um, None);
    // Without the table there is no motion.
    assert_eq!(answered(&plate_with(SQUARE)).paths[0].motion, None);
}

#[test]
fn rounded_corners_and_late_joints_are_part_of_the_deviation_and_have_shares() {
    let keys = "feed_mm_per_min = 6000\nzone_mm = 3\nlag_ms = [20]\nlag_u_ms = [5]\n";
    let study = plate_with(&format!("[motion]\n{keys}{SQUARE}"));
    let without = plate_with(SQUARE);
    let (moved, plain) = (found(&study), found(&without));
    let [(analysis, moved), (_, plain)] = [&moved[0].found, &plain[0].found].map(|found| match found {
        AnalysisData::Path(analysis, path) => (analysis, path),
        _ => panic!("a path"),
    });
    let motion = moved.motion.as_ref().unwrap();
    for index in 0..analysis.track.len() {
        let total = motion.blending[index] + motion.servo[index];
        let cases =
            (moved.along.answers.deviations_at(index).iter()).zip(plain.along.answers.deviations_at(index));
        for (with, without) in cases {
            assert!((with - without - total).norm() < 1e-12, "{index}");
        }
    }
    let answer = answered(&study);
    let path = &answer.paths[0];
    let contributors = &path.setting.contributors;
    assert_eq!(contributors[contributors.len() - 2..], ["blending", "servo"]);
    let largest = answered(&without).paths[0].max_in_plane_um.unwrap();
    assert!(path.max_in_plane_um.unwrap() > largest + 500.0);
    let worst = &path.worst_points[0];
    let point = &worst.point;
    assert!((point.joint_share_um.iter().sum::<f64>() - point.in_plane_um).abs() < 1e-6);
    assert!((point.in_plane_um - path.max_in_plane_um.unwrap()).abs() < 1e-6);
    // The corner is rounded by 7/16 of 3 mm sin 45 deg, and that is most of it.
    assert!(worst.cause.starts_with("rounded corners"), "{}", worst.cause);
    // A lag known to a quarter.
    let servo = point.joint_share_um.last().unwrap();
    assert!(point.in_plane_u_um.unwrap() >= 0.25 * servo.abs());
    assert!(
        path.setting
            .inputs_without_uncertainty
            .contains(&"the rounding of corners".to_owned())
    );
}

#[test]
fn a_circle_that_is_followed_late_is_smaller_by_half_the_square_of_the_angle_per_time_constant() {
    let study = plate_with(
        "[motion]\nfeed_mm_per_min = 6000\nlag_ms = [20]\nlag_u_ms = [5]\njoint_acceleration_deg_per_s2 = [9e4, 9e4, 9e4, 9e4, 9e4, 9e4]\npath_acceleration_mm_per_s2 = 9e5\nsmoothing_ms = 0\n\
         [[analysis]]\nkind = \"path\"\nname = \"c\"\ncircle = { radius_mm = 50 }\nstep_mm = 1\n",
    );
    let found = found(&study);
    let AnalysisData::Path(analysis, path) = &found[0].found else {
        panic!("a path")
    };
    let motion = path.motion.as_ref().unwrap();
    let count = motion.servo.len();
    assert_eq!(count, analysis.track.len());
    let angle: f64 = 0.1 / 0.05 * 0.02;
    let expected = 0.05 * (1.0 - 1.0 / angle.hypot(1.0));
    for (index, error) in motion
        .servo
        .iter()
        .enumerate()
        .take(count * 9 / 10)
        .skip(count / 10)
    {
        // All joints are late alike, so the tip follows the circle as if it were a first-order lag itself, but for the curvature of what the joints do in that time: some radius over reach.
        assert!(
            (error.norm() - expected).abs() < 0.12 * expected,
            "{index}: {error} {expected}"
        );
    }
    let answer = answered(&study).paths[0].motion.clone().unwrap();
    assert!((answer.largest_servo_u_um.unwrap() - 0.25 * answer.largest_servo_um).abs() < 1e-9);
}

#[test]
fn a_cut_has_the_force_at_the_feed_that_is_reached() {
    let cut = "[cut]\nmaterial = \"aluminium-6082-t6\"\ncutter = { diameter_mm = 10, flutes = 3 }\naxial_depth_mm = 2\nradial_depth_mm = 4\nside = \"down\"\nfeed_mm_per_min = 6000\nspindle_rpm = 10000\n";
    let run = |motion: &str| {
        let study = plate_with(&format!("{cut}{motion}{SQUARE}"));
        let found = found(&study);
        let AnalysisData::Path(_, path) = &found[0].found else {
            panic!("a path")
        };
        let forces: Vec<f64> = path
            .process
            .as_ref()
            .unwrap()
            .points
            .iter()
            .map(|point| point.force)
            .collect();
        (path.motion.clone(), forces)
    };
    let (none, programmed) = run("");
    let (motion, reached) = run("[motion]\nzone_mm = 0\n");
    assert_eq!(none, None);
    let motion = motion.unwrap();
    let slow = (0..reached.len()).filter(|index| motion.speeds[*index] < 0.5 * motion.feeds[*index]);
    let slow: Vec<usize> = slow.collect();
    assert!(slow.len() >= 4, "{slow:?}");
    for index in 0..reached.len() {
        let part = motion.speeds[index] / motion.feeds[index];
        // The equilibrium of force and deflection is found from that of the point before.
        match part > 1.0 - 1e-9 {
            true => assert!(
                (reached[index] - programmed[index]).abs() < 1e-4 * programmed[index],
                "{index}: {} {}",
                reached[index],
                programmed[index]
            ),
            false => assert!(reached[index] < programmed[index], "{index}: {part}"),
        }
    }
}

#[test]
fn lists_of_another_length_and_paths_without_a_feed_are_refused() {
    let text = format!("{PLATE}[motion]\njoint_acceleration_deg_per_s2 = [100]\nlag_ms = [1, 2]\n");
    let problems = read("study.toml", Path::new("."), text.as_bytes())
        .unwrap_err()
        .to_string();
    assert!(
        problems.contains("`joint_acceleration_deg_per_s2` has 1 values, but the robot has 6 joints"),
        "{problems}"
    );
    assert!(problems.contains("`lag_ms` has 2 values"), "{problems}");
    let study = plate_with(&format!("[motion]\n{SQUARE}"));
    let problem = run(&study, Watch::NONE).unwrap_err().to_string();
    assert!(
        problem.contains("line 1: no feed is given for this cut"),
        "{problem}"
    );
}

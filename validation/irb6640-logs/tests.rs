use std::path::{Path, PathBuf};

use super::logs::predictions;

/// The folder of the logs; none if the samples are not available.
fn folder() -> Option<PathBuf> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    Some(Path::new(&samples).join("datasets/abb-irb6640-logs"))
}

#[test]
fn cycle_time_and_feed_of_the_other_logs_are_predicted_and_corners_as_far_as_the_page_says() {
    let Some(folder) = folder() else { return };
    for (from, kind, corner_mm) in [
        ("virtual", "virtual", 0.3),
        ("virtual", "real", 0.3),
        ("real", "real", 1.0),
    ] {
        let (given, stretches) = predictions(&folder, [from, kind]);
        println!(
            "{kind}: {:?} {:?} {:?}",
            given.path_acceleration_mm_per_s2, given.smoothing_ms, given.lag_ms
        );
        for (name, stretch) in &stretches {
            let corner = &stretch.corners[0];
            println!(
                "| {kind} {name} | {:.3} | {:.3} | {:.2} | {:.1} | {:.2} | {:.2} | {:.2} | {:.2} |",
                stretch.cycle_time_s.unwrap(),
                stretch.predicted_cycle_time_s.unwrap(),
                stretch.cycle_time_error_percent.unwrap(),
                stretch.feed_rms_percent,
                corner.distance_mm,
                corner.predicted_distance_mm,
                stretch.off_line_mm,
                stretch.predicted_off_line_mm,
            );
            assert!(
                stretch.cycle_time_error_percent.unwrap().abs() < 3.0,
                "{kind} {name}"
            );
            assert!(stretch.feed_rms_percent < 10.0, "{kind} {name}");
            // 0.3 mm is not met by what the ragged log of the real controller says by itself.
            assert!(
                corner.distance_error_mm.abs() < corner_mm,
                "{kind} {name}: {corner:?}"
            );
        }
    }
}

#[test]
fn the_tip_leaves_the_lines_where_it_accelerates_as_motors_that_are_ahead() {
    let Some(folder) = folder() else { return };
    let (given, stretches) = predictions(&folder, ["virtual", "virtual"]);
    let (name, fine) = &stretches[0];
    assert_eq!(name, "v500_fine");
    assert!(
        fine.off_line_mm > 2.0 && (fine.predicted_off_line_mm - fine.off_line_mm).abs() < 0.3,
        "{fine:?}"
    );
    // As drives of some 10, 10 and 20 Hz.
    for (joint, [least, most]) in given
        .joints
        .iter()
        .zip([[1e-4, 4e-4], [1e-4, 4e-4], [2e-5, 2e-4]])
    {
        let lead = joint.motor_lead_s2.unwrap();
        assert!(lead.value > least && lead.value < most, "{joint:?}");
        assert!(lead.u.unwrap() < 0.3 * lead.value, "{joint:?}");
    }
    assert!(
        given.joints[3..]
            .iter()
            .all(|joint| joint.motor_lead_s2.is_none())
    );
}

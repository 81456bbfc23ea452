use std::path::{Path, PathBuf};

use armill_measure::motion::read;

use super::*;

/// Lengths of an IRB 6600-225/2.55, whose forward kinematics make the logged moves straight.
const IRB: &str = r#"format = 1
name = "ABB IRB 6600-225/2.55"

[chain]
source = "ros"
motions = [
  { along = "z", length_mm = 780 },
  { about = "z", joint = "J1" },
  { along = "x", length_mm = 320 },
  { about = "y", joint = "J2" },
  { along = "z", length_mm = 1075 },
  { about = "y", joint = "J3" },
  { along = "z", length_mm = 200 },
  { about = "x", joint = "J4" },
  { along = "x", length_mm = 1142 },
  { about = "y", joint = "J5" },
  { along = "x", length_mm = 200 },
  { about = "x", joint = "J6" },
]
JOINTS
[sources.ros]
what = "lengths and joint speeds"
where = "abb_irb6600_support, irb6600_225_255_macro.xacro"
licence = "BSD"
"#;

/// Zones of the logs at each speed, mm.
const ZONES: [(&str, f64); 4] = [("fine", 0.0), ("z1", 1.0), ("z10", 10.0), ("z20", 20.0)];

fn irb() -> RobotDescription {
    let joints: String = [100, 90, 90, 150, 120, 190]
        .iter()
        .enumerate()
        .map(|(k, speed)| {
            format!(
                "[[joint]]\nname = \"J{}\"\nsign = 1\nmax_speed_deg_per_s = {speed}\nsource = \"ros\"\n",
                k + 1
            )
        })
        .collect();
    armill::read("irb.toml", "irb", &IRB.replace("JOINTS", &joints))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

/// The folder of the logs; none if the samples are not available.
fn folder() -> Option<PathBuf> {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return None;
    };
    Some(Path::new(&samples).join("datasets/abb-irb6640-logs"))
}

/// The predictions of the other logs of a kind, learnt from its log at 500 mm/s with stops: name and stretch.
fn predictions(
    folder: &Path,
    [learnt_from, kind]: [&str; 2],
) -> (MotionAnswer, Vec<(String, StretchAnswer)>) {
    let found = irb();
    let names: Vec<(String, f64)> = ["500", "50"]
        .iter()
        .flat_map(|speed| ZONES.map(|(zone, radius)| (format!("v{speed}_{zone}"), radius)))
        .collect();
    let question = Question {
        zones: names.iter().skip(1).map(|(_, radius)| radius * 1e-3).collect(),
        ..Question::default()
    };
    let log = |kind: &str, name: &str| {
        let path = folder.join(format!("{kind}_movel_30_car_{name}.csv"));
        read(&path, &found.robot, &question).unwrap_or_else(|error| panic!("{error}"))
    };
    let learned =
        learn(&found, log(learnt_from, &names[0].0), &question).unwrap_or_else(|error| panic!("{error}"));
    let others: Vec<NamedLog> = names.iter().skip(1).map(|(name, _)| log(kind, name)).collect();
    let given = answer(&found.robot, &learned, &others, &question).unwrap_or_else(|error| panic!("{error}"));
    let stretches = names.iter().zip(&given.compared).map(|((name, _), compared)| {
        assert_eq!(compared.stretches.len(), 1, "{kind} {name}");
        (name.clone(), compared.stretches[0].clone())
    });
    let stretches = stretches.collect();
    (given, stretches)
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

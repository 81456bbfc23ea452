use armill_core::units::from_deg;
use proptest::prelude::*;

use super::*;

fn read_as(text: &str, joints: usize, given: LogReadOptions) -> Result<JointLog, Problems> {
    read("log.csv", text.as_bytes(), joints, given)
}

fn log(text: &str, joints: usize) -> JointLog {
    read_as(text, joints, LogReadOptions::default()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn refused(text: &str, joints: usize) -> String {
    read_as(text, joints, LogReadOptions::default())
        .unwrap_err()
        .to_string()
}

#[test]
fn the_same_log_in_other_names_units_and_separators_is_the_same() {
    let first = log("time_s,J1_deg,J2_deg\n5,90,-180\n5.004,91,-181\n", 2);
    assert_eq!(first.times[0], 0.0);
    assert!((first.times[1] - 0.004).abs() < 1e-12);
    assert_eq!(first.positions[..2], [from_deg(90.0), from_deg(-180.0)]);
    for text in [
        "\u{feff}IPOC;AIPos.A1;AIPos.A2\r\n5000;90;-180\r\n5004;91,0;-181\r\n",
        "Time [us]\tA1 [deg]\tA2 [deg]\n5000000\t90\t-180\n5004000\t91\t-181\n",
        "timestamp fb_j1   fb_j2\n5  90 -180\n 5.004 91   -181\n",
        "t_ns,joint_1_deg,joint_2_deg,load\n5000000000,90,-180,x\n5004000000,91,-181,\n",
    ] {
        let other = log(text, 2);
        let apart = (other.positions.iter().zip(&first.positions)).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-12, "{text}");
        assert!((other.times[1] - first.times[1]).abs() < 1e-9, "{text}");
    }
}

#[test]
fn link_encoders_and_torques_are_read_next_to_the_motors() {
    let text = "time_s,motor_j1_deg,motor_j2_deg,link_j1_deg,link_j2_deg,torque_j1_nm,torque_j2_nm\n0,90,0,91,1,-5,3\n0.004,90,0,92,1,-6,3\n";
    let found = read_as(text, 2, LogReadOptions::default()).unwrap();
    assert_eq!(
        found.link.as_deref(),
        Some(&[91.0, 1.0, 92.0, 1.0].map(from_deg)[..])
    );
    assert_eq!(found.torque.as_deref(), Some(&[-5.0, 3.0, -6.0, 3.0][..]));
    assert!(found.commanded.is_none());
    let own = read("log.csv", text.as_bytes(), None, LogReadOptions::default()).unwrap();
    assert_eq!(own, found);
    let missing = text.replace("torque_j2_nm", "other");
    assert!(refused(&missing, 2).contains("torques of the joints 1, but the robot has 2 joints"));
}

#[test]
fn commanded_positions_and_moves_are_read_next_to_the_actual_ones() {
    let found = log(
        "timestamp target_q_0 actual_q_0 target_qd_0 cmd_num\n0.002 1 0.9 7 -1\n0.004 1.1 1 7 2\n",
        1,
    );
    assert_eq!(found.positions, [0.9, 1.0]);
    assert_eq!(found.commanded.as_deref(), Some(&[1.0, 1.1][..]));
    assert_eq!(found.moves.as_deref(), Some(&[-1, 2][..]));
    assert_eq!(found.unused, ["target_qd_0"]);
    assert!(
        found.notes[0].contains("no unit of time is given: s"),
        "{:?}",
        found.notes
    );
    let rsi = log("IPOC,ASPos.A1,AIPos.A1\n4,2,1\n8,3,2\n", 1);
    assert_eq!(rsi.positions, [from_deg(1.0), from_deg(2.0)]);
    let alone = log("time_s,target_q_0\n0,0.1\n0.008,0.2\n", 1);
    assert_eq!((alone.positions.len(), alone.commanded), (2, None));
}

#[test]
fn a_unit_is_concluded_only_where_one_is_possible() {
    let found = log("timestamp,J1\n0,-87\n0.004,-88\n", 1);
    assert!((found.positions[0] + 87f64.to_radians()).abs() < 1e-12);
    assert_eq!(found.notes.len(), 2, "{:?}", found.notes);
    let both = refused("timestamp,J1\n0,1\n0.5,2\n", 1);
    assert!(
        both.contains("no unit of time is given, and a step of 0.5 fits none"),
        "{both}"
    );
    assert!(both.contains("2 may be degrees or rad"), "{both}");
    let given = LogReadOptions {
        time: Some(TimeUnit::Second),
        angle: Some(AngleUnit::Radian),
    };
    let found = read_as("timestamp,J1\n0,1\n0.5,2\n", 1, given).unwrap();
    assert_eq!((found.times[1], found.positions[1]), (0.5, 2.0));
}

#[test]
fn repeated_times_are_left_out_and_gaps_are_named() {
    let mut text = "time_ms,J1_deg\n".to_owned();
    for time in [0, 4, 8, 8, 12, 16, 100, 104] {
        text.push_str(&format!("{time},{}\n", time as f64 * 0.1));
    }
    let found = log(&text, 1);
    assert_eq!(found.times.len(), 7);
    assert!(
        found.notes[0].contains("1 row repeats the time"),
        "{:?}",
        found.notes
    );
    assert!(
        found.notes[1].contains("1 gap") && found.notes[1].contains("84.0 ms before line 8"),
        "{:?}",
        found.notes
    );
}

#[test]
fn all_problems_are_reported_with_their_positions() {
    let found = refused(
        "time_s,J1_deg,J2_deg\n0,1,x\n0.1,NaN,2\n0.2,1\n0.3,1,2\n0.25,1,2\n0.4,1e30,2\n0.39,1,2\n0.1,x,2\n",
        2,
    );
    for said in [
        "log.csv:2:5: `x` is not a finite number",
        "log.csv:3:5: `NaN` is not a finite number",
        "log.csv:4:1: 2 cells, but the table has 3 columns",
        "log.csv:6:1: time goes back: 0.25 after 0.3",
        "log.csv:7:5: `1e30` is not a finite number",
        "log.csv:8:1: time goes back: 0.39 after 0.4",
        "log.csv:9:5: `x` is not a finite number",
        "log.csv:9:1: time goes back: 0.1 after 0.4",
    ] {
        assert!(found.contains(said), "{said}: {found}");
    }
    for (text, said) in [
        ("", "the file has no instants"),
        ("time_s,J1_deg\n", "a log of 0 instants"),
        ("J1_deg\n1\n", "no column gives the time"),
        ("time_s,x\n1,2\n", "no column is the position of a joint"),
        (
            "time_s,J1_deg,J2_deg\n0,1,2\n",
            "positions of the joints 1, 2, but the robot has 1 joints",
        ),
        (
            "time_s,J2_deg\n0,1\n",
            "positions of the joints 2, but the robot has 1 joints",
        ),
        (
            "time_s,J1_deg,j1_deg\n0,1,2\n",
            "1:15: `j1_deg` repeats an earlier column",
        ),
        (
            "time_s,J1_deg,cmd_j1_rad\n0,1,2\n",
            "has another unit than the joints before it",
        ),
        (
            "time_s,J1_rad,move\n0,1,1.5\n1,1,1\n",
            "`1.5` is not the number of a move",
        ),
        ("time_s,J1_rad\n0,1\n1,1e6\n", "exceeds 200 rad"),
        ("time_s,J1_rad\n0,1\n1e9,1\n", "exceeds 1000000 s"),
    ] {
        let given = refused(text, 1);
        assert!(
            given.contains(said) && given.contains("help: "),
            "{said}: {given}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read("log.csv", bytes.as_slice(), 1, LogReadOptions::default());
    }

    #[test]
    fn any_cells_are_read_or_refused(header in "[a-zA-Z0-9_\\. ,;\\[\\]]{0,40}", rows in "[-0-9e\\.,; \nNa]{0,120}") {
        for header in [header.as_str(), "t,j0,set_j0", "ipoc aipos.a1"] {
            let text = format!("{header}\n{rows}");
            if let Ok(found) = read_as(&text, 1, LogReadOptions::default()) {
                prop_assert!(found.times.is_sorted_by(|a, b| a < b));
                prop_assert!(found.positions.iter().all(|value| value.is_finite()));
                prop_assert_eq!(found.positions.len(), found.times.len());
            }
        }
    }
}

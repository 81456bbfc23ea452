//! Deviation along a program under a given load: as of a shape, with cause and line, feed and spin.

use std::f64::consts::TAU;

use crate::{CELL, LOAD, RING, analysis, reported};

#[test]
fn a_circle_as_program_deviates_as_the_circle_of_a_path() {
    // Both have 360 points: the path begins at y' and turns to z', the program at x_part = -y'.
    let step = TAU * 40.0 / 360.0;
    let shape = format!(
        "\n[[analysis]]\nkind = \"path\"\nname = \"shape\"\ncircle.radius_mm = 40\nstep_mm = {step}\n"
    );
    let feature = "feature = [{ name = \"ring\", kind = \"circle\", lines = [5, 5] }]";
    let program = analysis(&format!(
        "file = \"ring.ngc\"\nstep_mm = {step}\nchord_error_mm = 1\n{feature}"
    ));
    let study = format!("{CELL}{LOAD}{shape}{program}");
    let answer = reported(&study, &[("ring.ngc", RING)]).unwrap();
    let [shape, part] = &answer.paths[..] else {
        panic!("two paths")
    };
    assert_eq!((shape.points, part.points), (360, 361));
    let same = |a: Option<f64>, b: Option<f64>| (a.unwrap() - b.unwrap()).abs() < 1e-6;
    assert!(
        same(shape.max_in_plane_um, part.max_in_plane_um),
        "{:?} {:?}",
        shape.max_in_plane_um,
        part.max_in_plane_um
    );
    assert!(same(shape.max_full_um, part.max_full_um));
    // The last point of the program is on its first: the least-squares circle hardly changes.
    assert!((shape.roundness_um.unwrap() - part.roundness_um.unwrap()).abs() < 0.05);
    let program = part.program.as_ref().unwrap();
    let ring = &part.features[0];
    assert_eq!((ring.kind, ring.points, ring.case), ("circle", 361, 1));
    assert!((ring.radius_mm.unwrap() - 40.0).abs() < 1e-9);
    let shift = shape.circle_cases[0].centre_shift_um;
    let [x, y, z] = ring.shift_um.unwrap();
    // Part x is -y'.
    assert!(
        (x + shift[0]).abs() < 0.3 && (y - shift[1]).abs() < 0.3 && z.abs() < 1e-9,
        "{x} {y} {shift:?}"
    );
    assert!((part.length_mm - TAU * 40.0).abs() < 1e-6);
    assert!((program.cutting_time_s - TAU * 40.0 / 10.0).abs() < 1e-6);
}

#[test]
fn the_worst_point_carries_shares_uncertainty_line_and_cause() {
    let answer = reported(
        &format!("{CELL}{LOAD}{}", analysis("file = \"ring.ngc\"")),
        &[("ring.ngc", RING)],
    )
    .unwrap();
    let part = &answer.paths[0];
    let worst = part.worst.as_ref().unwrap();
    assert!((worst.in_plane_um - part.max_in_plane_um.unwrap()).abs() < 1e-9);
    let shares: f64 = worst.joint_share_um.iter().sum();
    assert!((shares - worst.in_plane_um).abs() < 1e-9 && worst.in_plane_u_um.unwrap() > 0.0);
    let point = &part.worst_points[0];
    assert_eq!(point.line, 5);
    assert!(point.cause.contains('%'), "{}", point.cause);
    assert!((point.along_um.hypot(point.cross_um) - worst.in_plane_um).abs() < 1e-6);
}

#[test]
fn a_load_in_the_feed_frame_turns_with_the_circle() {
    // A force against the feed alone: its deviation along the track is never forwards.
    let load = "load = { frame = \"feed\", cases_n = [[-20, 0, 0]] }\n";
    let answer = reported(
        &format!("{CELL}{load}{}", analysis("file = \"ring.ngc\"")),
        &[("ring.ngc", RING)],
    )
    .unwrap();
    let path = &answer.paths[0];
    for point in &path.worst_points {
        assert!(point.along_um < 0.0, "{point:?}");
    }
    assert!(path.cut.is_none());
    assert_eq!(
        (path.setting.load_frame, path.setting.cases_n[0]),
        ("feed", [-20.0, 0.0, 0.0])
    );
}

#[test]
fn a_given_spin_turns_the_last_joint_as_a_fixed_one_does() {
    let row = |x: i32, spin: &str| format!("{x},0,0,{spin}\n");
    let head = "x_mm,y_mm,z_mm,spin_deg\n";
    let given_spins = format!("{head}{}{}", row(0, "20"), row(40, "50"));
    let last = |extra: &str, table: &str| {
        let study = format!(
            "{CELL}{LOAD}{}",
            analysis(&format!("file = \"path.csv\"\n{extra}"))
        );
        reported(&study, &[("path.csv", table)]).map(|answer| answer.paths[0].joint_range_deg[5])
    };
    let given = last("spin = \"given\"\nspin_deg = 5", &given_spins).unwrap();
    let [from, to] = [25.0, 55.0].map(|deg| {
        let table = format!("{head}{}{}", row(0, ""), row(40, ""));
        last(&format!("spin_deg = {deg}"), &table).unwrap()
    });
    // At the ends of the line the posture is that of a constant spin.
    let range = [from[0].min(to[0]), from[1].max(to[1])];
    let among = |q: f64, of: [f64; 2]| of.iter().any(|end| (end - q).abs() < 1e-6);
    assert!(
        among(given[0], from) || among(given[0], to),
        "{given:?} {from:?} {to:?}"
    );
    assert!(
        among(given[1], from) || among(given[1], to),
        "{given:?} {from:?} {to:?}"
    );
    assert!(given[1] - given[0] > 20.0 && given[1] <= range[1] + 1e-6);
    let silent = format!("{head}{}{}{}", row(0, ""), row(10, ""), row(40, "50"));
    let error = last("spin = \"given\"", &silent).unwrap_err();
    for word in ["study.toml:", "path.csv: line 3 gives no spin", "spin_deg"] {
        assert!(error.contains(word), "no `{word}` in\n{error}");
    }
}

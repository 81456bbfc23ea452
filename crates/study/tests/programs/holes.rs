//! Holes: of lists, tables and programs; each separately, in any order; errors.

use armill_study::answer::{HoleAnswer, HolesAnswer};

use super::{CELL, LOAD, reported};

/// Drilling cycles: a plain one at two positions, a peck at a third, and a pocket, which is not a hole.
const DRILLING: &str = "G21 G90 G98\nS3000 M3 F120\nG0 X0 Y0 Z10\nG81 X0 Y0 Z-5 R2\nX40\nG83 X40 Y30 Z-9 R2 Q3\nG80\nG0 X-30 Y0\nG0 Z1\nG1 Z-1 F120\nG1 X-20\nG0 Z10\nM2\n";
const DRILL: &str = "drill = { material = \"aluminium-6082-t6\", diameter_mm = 6 }";
/// Thrust in the axes of each hole.
const THRUST: &str = "load = { frame = \"feed\", cases_n = [[0, 0, 60]] }\n";
const STEP: &str = "posture.search = { step_deg = 15 }\n";

fn study(holes: &str) -> String {
    format!("{CELL}[[analysis]]\nkind = \"holes\"\nname = \"panel\"\n{STEP}{holes}\n")
}

fn holes(text: &str, files: &[(&str, &str)]) -> HolesAnswer {
    let mut answer = reported(text, files).unwrap();
    answer.holes.remove(0)
}

fn by_number(of: &HolesAnswer) -> Vec<HoleAnswer> {
    let mut each = of.each.clone();
    each.sort_by_key(|hole| hole.hole);
    each
}

#[test]
fn a_program_drills_the_holes_that_it_should() {
    let text = study(&format!("program = {{ file = \"drill.ngc\", {DRILL} }}"));
    let found = holes(&text, &[("drill.ngc", DRILLING)]);
    let at: Vec<[f64; 3]> = by_number(&found).iter().map(|hole| hole.xyz_mm).collect();
    // x of the part is along -y of base: its origin is at (1000, 50, 500), its y along x.
    let expected = [
        [1000.0, 50.0, 495.0],
        [1000.0, 10.0, 495.0],
        [1030.0, 10.0, 491.0],
    ];
    assert_eq!(at.len(), 3);
    for (at, expected) in at.iter().zip(expected) {
        assert!(
            at.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
            "{at:?}"
        );
    }
    assert_eq!(found.file.as_deref(), Some("drill.ngc"));
    // The same drill as a path has the same thrust.
    let along = format!(
        "{CELL}[[analysis]]\nkind = \"path\"\nname = \"panel\"\nprogram = {{ file = \"drill.ngc\", {DRILL} }}\n"
    );
    let path = reported(&along, &[("drill.ngc", DRILLING)]).unwrap();
    let thrust = path.paths[0].cut.as_ref().unwrap().largest_mean_n;
    assert!((found.largest_thrust_n.unwrap() - thrust).abs() < 1e-9 * thrust);
    // The thrust is directed out of the part: the tool deflects away, every hole is too shallow.
    assert!(found.each.iter().all(|hole| hole.depth_um.unwrap() > 0.0));
}

#[test]
fn x_y_and_depth_are_the_deviation_and_the_worst_is_first() {
    let list = "holes = { at_mm = [[0, 0, 0], [60, 20, 0], [-50, 60, 0], [30, -40, 5]], normals = [[0, 0, 1], [0.2, 0, 1], [0, -0.3, 1], [0, 0, 1]] }";
    let found = holes(&study(&format!("{THRUST}{list}")), &[]);
    assert_eq!((found.holes, found.unreachable, found.turns), (4, 0, 24));
    for hole in &found.each {
        let across = hole.x_um.unwrap().hypot(hole.y_um.unwrap());
        // One case: the deviation across the hole is the whole envelope.
        assert!((across - hole.in_plane_um.unwrap()).abs() < 1e-9 * across);
        assert!(hole.limit_margin_deg.unwrap() > 0.0 && hole.wrist_bend_deg.unwrap() > 3.0);
        assert!(hole.in_plane_u_um.unwrap() > 0.0);
        assert!(
            hole.branch.as_deref() == Some("front elbow-up no-flip"),
            "{:?}",
            hole.branch
        );
    }
    let sizes: Vec<f64> = found.each.iter().map(|hole| hole.in_plane_um.unwrap()).collect();
    assert!(sizes.is_sorted_by(|a, b| a >= b), "{sizes:?}");
    assert_eq!(found.worst_holes[0].hole, found.each[0].hole);
    let worst = &found.worst_holes[0].point;
    let sum: f64 = worst.joint_share_um.iter().sum();
    assert!((sum - worst.in_plane_um).abs() < 1e-6);
    assert!((found.max_in_plane_um.unwrap() - sizes[0]).abs() < 1e-9);
}

#[test]
fn another_order_gives_the_same_holes() {
    let at = ["[0, 0, 0]", "[60, 20, 0]", "[-50, 60, 0]", "[30, -40, 5]"];
    let analysis = |order: [usize; 4]| {
        let list = order.map(|i| at[i]).join(", ");
        by_number(&holes(
            &study(&format!("{THRUST}holes = {{ at_mm = [{list}] }}")),
            &[],
        ))
    };
    let (first, other) = (analysis([0, 1, 2, 3]), analysis([2, 0, 3, 1]));
    for (place, of) in [2, 0, 3, 1].into_iter().enumerate() {
        let (a, b) = (&first[of], &other[place]);
        assert_eq!(a.joints_deg, b.joints_deg);
        assert_eq!((a.x_um, a.y_um, a.depth_um), (b.x_um, b.y_um, b.depth_um));
        assert_eq!((a.turn_deg, a.in_plane_u_um), (b.turn_deg, b.in_plane_u_um));
    }
}

#[test]
fn a_table_gives_the_holes_of_the_same_list() {
    let csv = "x_mm,y_mm,z_mm,i,j,k\n0,0,0,0,0,1\n60,20,0,0.6,0,0.8\n";
    let of_file = holes(
        &study(&format!("{THRUST}holes = {{ file = \"holes.csv\" }}")),
        &[("holes.csv", csv)],
    );
    let list = "holes = { at_mm = [[0, 0, 0], [60, 20, 0]], normals = [[0, 0, 1], [0.6, 0, 0.8]] }";
    let of_list = holes(&study(&format!("{THRUST}{list}")), &[]);
    for (a, b) in by_number(&of_file).iter().zip(by_number(&of_list)) {
        assert_eq!((a.xyz_mm, a.x_um, a.depth_um), (b.xyz_mm, b.x_um, b.depth_um));
    }
    assert_eq!(
        by_number(&of_file)
            .iter()
            .map(|hole| hole.line)
            .collect::<Vec<_>>(),
        [2, 3]
    );
}

#[test]
fn the_thrust_of_a_drill_of_a_list_is_that_of_its_feed() {
    let drilled = |feed: &str| {
        let drill = format!(
            "drill = {{ material = \"aluminium-6082-t6\", diameter_mm = 6, feed_mm_per_min = {feed}, spindle_rpm = 3000 }}"
        );
        holes(
            &study(&format!("holes = {{ at_mm = [[0, 0, 0]], {drill} }}")),
            &[],
        )
    };
    let (slow, fast) = (drilled("60"), drilled("240"));
    assert!(slow.largest_thrust_n.unwrap() < fast.largest_thrust_n.unwrap());
    assert!(slow.max_depth_um.unwrap() < fast.max_depth_um.unwrap());
    assert!(slow.material.is_some_and(|material| !material.is_empty()));
}

#[test]
fn a_hole_out_of_reach_is_reported_first_with_its_reason() {
    let answer = reported(
        &study(&format!("{THRUST}holes = {{ at_mm = [[0, 0, 0], [0, 900, 0]] }}")),
        &[],
    )
    .unwrap();
    let found = &answer.holes[0];
    assert_eq!((found.unreachable, found.each[0].hole), (1, 2));
    let lost = &found.each[0];
    assert!(lost.in_plane_um.is_none() && lost.joints_deg.is_empty());
    assert!(lost.reason.is_some() && lost.state != "within", "{lost:?}");
    assert_eq!(found.fraction_within, found.counts.within as f64 / 2.0);
    assert!(!answer.meets_tolerance());
    assert!(
        answer
            .warnings
            .iter()
            .any(|w| w.contains("panel: 1 of 2 holes cannot be drilled, hole 2 first")),
        "{:?}",
        answer.warnings
    );
    assert!(
        answer.answer.contains("hole 2 cannot be drilled"),
        "{}",
        answer.answer
    );
}

#[test]
fn the_spin_is_free_unless_the_study_gives_it() {
    let spindle = CELL.replace("[0, 0, 150, 0, 0, 0]", "[100, 0, 150, 0, 90, 0]");
    let analysis = |search: &str| {
        let text = format!(
            "{spindle}[[analysis]]\nkind = \"holes\"\nname = \"panel\"\n{search}{THRUST}holes.at_mm = [[0, 0, -200], [60, 20, -200]]\n"
        );
        holes(&text, &[])
    };
    let (free, evaluation) = (analysis(""), analysis("posture.search.turns_deg = [0, 0]\n"));
    assert_eq!((free.turns, evaluation.turns), (72, 1));
    assert!(
        evaluation
            .each
            .iter()
            .all(|hole| hole.turn_deg.is_none_or(|turn| turn == 0.0))
    );
    let largest = |of: &HolesAnswer| of.max_in_plane_um.unwrap();
    assert!(evaluation.unreachable > 0 || largest(&free) <= largest(&evaluation));
}

#[test]
fn errors_of_holes_are_reported_at_their_positions() {
    let refused = |text: &str, files: &[(&str, &str)], words: &[&str]| {
        let error = reported(text, files).unwrap_err();
        for word in words {
            assert!(error.contains(word), "no `{word}` in:\n{error}");
        }
    };
    let with = |holes: &str| study(&format!("{THRUST}{holes}"));
    refused(&with(""), &[], &["holes need exactly one list, file or program"]);
    refused(
        &with("holes = { at_mm = [[0, 0, 0]], file = \"a.csv\" }"),
        &[],
        &["exactly one list, file or program"],
    );
    refused(&with("holes = { at_mm = [] }"), &[], &["the list has no holes"]);
    refused(
        &with("holes = { at_mm = [[0, 0, 0], [1, 0, 0], [2, 0, 0]], normals = [[0, 0, 1], [0, 0, 1]] }"),
        &[],
        &["2 normals for 3 holes", "one for each hole, or one for all"],
    );
    refused(
        &with("holes = { at_mm = [[0, 0, 0]], normals = [[0, 0, 0]] }"),
        &[],
        &["study.toml:12:", "the normal has zero length"],
    );
    refused(
        &with("holes = { file = \"none.csv\" }"),
        &[],
        &["cannot read", "none.csv"],
    );
    refused(
        &with("holes = { file = \"drill.ngc\" }"),
        &[("drill.ngc", DRILLING)],
        &["is a program, not a table of holes", "program = { file = ... }"],
    );
    let mill = "G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F100\nG1 X20\nG0 Z10\nM2\n";
    refused(
        &with("program = { file = \"mill.ngc\" }"),
        &[("mill.ngc", mill)],
        &["drills no hole", "kind = \"path\""],
    );
    refused(
        &study(&format!(
            "program = {{ file = \"drill.ngc\", limits = true, {DRILL} }}"
        )),
        &[("drill.ngc", DRILLING)],
        &["`program.limits` is not valid for the holes of a program"],
    );
    refused(
        &study(&format!("{THRUST}holes = {{ at_mm = [[0, 0, 0]], {DRILL} }}")),
        &[],
        &["this set of holes has a load and a drill"],
    );
    refused(
        &study(&format!("holes = {{ at_mm = [[0, 0, 0]], {DRILL} }}")),
        &[],
        &["holes.drill with feed_mm_per_min and spindle_rpm"],
    );
    refused(
        &study("holes = { at_mm = [[0, 0, 0]], drill = { material = \"cheese\", diameter_mm = 6 } }"),
        &[],
        &["cheese"],
    );
    refused(
        &study("holes = { at_mm = [[0, 0, 0]] }"),
        &[],
        &["no force on the tool"],
    );
    let search = |keys: &str| with("holes = { at_mm = [[0, 0, 0]] }").replace("step_deg = 15", keys);
    refused(
        &search("objective = \"mean\""),
        &[],
        &["`objective` is not valid for holes"],
    );
    refused(
        &search("component = \"cross-track\""),
        &[],
        &["`cross-track` is not valid for holes"],
    );
    refused(
        &search("turns_deg = [90, -90]"),
        &[],
        &["turns range from 90 to -90 deg"],
    );
    refused(
        &with("holes = { at_mm = [[0, 0, 0]] }\nstep_mm = 3"),
        &[],
        &["`step_mm` is not valid for a set of holes"],
    );
    let map = format!("{CELL}{LOAD}[[analysis]]\nkind = \"map\"\nholes = {{ at_mm = [[0, 0, 0]] }}\n");
    refused(&map, &[], &["`holes` is not valid for a map", "kind = \"holes\""]);
    let stated = format!(
        "{}[[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = 5\nof = [\"panel\"]\n",
        with("holes = { at_mm = [[0, 0, 0]] }")
    );
    refused(&stated, &[], &["`panel` is a set of holes"]);
}

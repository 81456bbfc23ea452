//! Tool path programs in a study: the same numbers as shapes of the same form, features, forces from the cut, errors.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use armill_core::watch::Watch;
use armill_study::answer::{StudyAnswer, answer};
use armill_study::file::resolve::read;
use armill_study::run::run;

/// A horizontal plate in front of an MH12; asks follow.
const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
limit_um = 60
plane = { centre_mm = [1000, 50, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
posture = { branch = "front elbow-up no-flip" }
"#;
const LOAD: &str = "load = { cases_n = [[3, -5, 5], [3, 5, 5]] }\n";
const CUT: &str = r#"
[cut]
material = "aluminium-6082-t6"
cutter = { diameter_mm = 10, flutes = 2 }
axial_depth_mm = 1
radial_depth_mm = 3
side = "down"
feed_mm_per_min = 600
spindle_rpm = 9000
"#;
/// A full circle of radius 40 mm about the zero, and a rapid to its start.
const RING: &str = "G21 G90 G17\nS9000 M3\nG0 X40 Y0 Z10\nG0 Z0\nG3 X40 Y0 I-40 J0 F600\nG0 Z10\nM2\n";

fn told(study: &str, files: &[(&str, &str)]) -> Result<StudyAnswer, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let study = read("study.toml", folder.path(), study.as_bytes()).map_err(|error| error.to_string())?;
    let found = run(&study, Watch::NONE).unwrap();
    Ok(answer(&study, &found))
}

fn ask(program: &str) -> String {
    format!("\n[[ask]]\nkind = \"path\"\nname = \"part\"\n[ask.program]\n{program}\n")
}

#[test]
fn a_circle_as_program_deviates_as_the_circle_of_a_path() {
    // Both have 360 points: the path begins at y' and turns to z', the program at x_part = -y'.
    let step = TAU * 40.0 / 360.0;
    let shape =
        format!("\n[[ask]]\nkind = \"path\"\nname = \"shape\"\ncircle.radius_mm = 40\nstep_mm = {step}\n");
    let feature = "feature = [{ name = \"ring\", kind = \"circle\", lines = [5, 5] }]";
    let program = ask(&format!(
        "file = \"ring.ngc\"\nstep_mm = {step}\nchord_error_mm = 1\n{feature}"
    ));
    let study = format!("{CELL}{LOAD}{shape}{program}");
    let answer = told(&study, &[("ring.ngc", RING)]).unwrap();
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
    // The last point of the program stands on its first: the least-squares circle hardly notices.
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
    let answer = told(
        &format!("{CELL}{LOAD}{}", ask("file = \"ring.ngc\"")),
        &[("ring.ngc", RING)],
    )
    .unwrap();
    let part = &answer.paths[0];
    let worst = part.worst.as_ref().unwrap();
    assert!((worst.in_plane_um - part.max_in_plane_um.unwrap()).abs() < 1e-9);
    let shares: f64 = worst.joint_share_um.iter().sum();
    assert!((shares - worst.in_plane_um).abs() < 1e-9 && worst.in_plane_u_um > 0.0);
    let point = &part.worst_points[0];
    assert_eq!(point.line, 5);
    assert!(point.cause.contains('%'), "{}", point.cause);
    assert!((point.along_um.hypot(point.cross_um) - worst.in_plane_um).abs() < 1e-6);
}

#[test]
fn a_load_in_the_feed_frame_turns_with_the_circle() {
    // A force against the feed alone: its deviation along the track is never forwards.
    let load = "load = { frame = \"feed\", cases_n = [[-20, 0, 0]] }\n";
    let answer = told(
        &format!("{CELL}{load}{}", ask("file = \"ring.ngc\"")),
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
fn forces_come_from_the_cut_and_need_no_load() {
    let half = CUT.replace("axial_depth_mm = 1", "axial_depth_mm = 2");
    let [one, two] = [CUT, &half].map(|cut| {
        let answer = told(
            &format!("{CELL}{cut}{}", ask("file = \"ring.ngc\"")),
            &[("ring.ngc", RING)],
        )
        .unwrap();
        answer.paths[0].clone()
    });
    let forces = |path: &armill_study::answer::PathAnswer| {
        let cut = path.cut.as_ref().unwrap();
        [cut.largest_mean_n, cut.largest_peak_n]
    };
    let ([mean, peak], [twice, _]) = (forces(&one), forces(&two));
    // A mean force goes with the depth; so does what it moves.
    assert!((twice / mean - 2.0).abs() < 1e-12 && peak > mean);
    let greatest = CUT.replace("flutes = 2 }", "flutes = 2 }\npeak = true");
    let both = told(
        &format!("{CELL}{greatest}{}", ask("file = \"ring.ngc\"")),
        &[("ring.ngc", RING)],
    )
    .unwrap();
    assert!(both.paths[0].max_in_plane_um > one.max_in_plane_um);
    assert_eq!(both.paths[0].worst.as_ref().unwrap().deciding_case, 2);
    let ratio = two.max_cross_um.unwrap() / one.max_cross_um.unwrap();
    assert!(ratio > 1.5 && ratio < 2.5, "{ratio}");
    assert!(one.cut.as_ref().unwrap().material.contains("6082"));
    assert!(one.notes.iter().any(|note| note.contains("same engagement")));
    let worst = one.worst.as_ref().unwrap();
    assert!(worst.in_plane_u_um > 0.2 * worst.in_plane_um, "{worst:?}");
}

/// A slot out from the middle of a block, and a step-over back; the robot reaches all of it.
const STEP_OVER: &str =
    "G21 G90 G17\nS9000 M3\nG0 X-60 Y0 Z10\nG0 Z-1\nG1 X30 F600\nG1 Y3\nG1 X-60\nG0 Z10\nM2\n";
const STOCK: &str = "\nstock = { from_mm = [-40, -40, -20], to_mm = [40, 40, 0] }";

fn of_cut(cut: &str) -> armill_study::answer::PathAnswer {
    let study = format!("{CELL}{cut}{}", ask("file = \"step.ngc\""));
    told(&study, &[("step.ngc", STEP_OVER)]).unwrap().paths[0].clone()
}

#[test]
fn a_stock_tells_where_the_cutter_is_in_the_air_in_a_slot_and_beside_one() {
    let with_stock = format!("{CUT}{STOCK}");
    let program = of_cut(&with_stock);
    let stock = program.cut.as_ref().unwrap().stock.as_ref().unwrap();
    // 15 mm to the block, where the rim of the cutter meets it; 20 mm behind it, where nothing is ahead.
    assert!((34..=39).contains(&stock.points_in_air), "{stock:?}");
    assert!((60..=80).contains(&stock.points_in_slot), "{stock:?}");
    assert!((stock.largest_axial_depth_mm - 1.0).abs() < 1e-3 && stock.points_leaning == 0);
    // A strip of 13 mm, 75 mm long with its round ends, 1 mm deep; cells of a quarter of a millimetre.
    let swept = 13.0 * 70.0 + 25.0 * TAU / 4.0 + 5.0 * 3.0;
    assert!(
        (stock.removed_mm3 / swept - 1.0).abs() < 0.02,
        "{stock:?} {swept}"
    );
    let note = |program: &armill_study::answer::PathAnswer, words: &str| {
        program.notes.iter().any(|note| note.contains(words))
    };
    assert!(note(&program, "finds in the stock") && !note(&program, "same engagement"));
    // A slot pushes harder than the cut that the study told.
    let told = of_cut(CUT);
    let mean = |program: &armill_study::answer::PathAnswer| program.cut.as_ref().unwrap().largest_mean_n;
    assert!(
        mean(&program) > 1.2 * mean(&told),
        "{} {}",
        mean(&program),
        mean(&told)
    );
    assert!(told.cut.as_ref().unwrap().stock.is_none() && note(&told, "same engagement"));
}

#[test]
fn a_program_that_misses_its_stock_is_refused_and_not_praised() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("step.ngc"), STEP_OVER).unwrap();
    let far = STOCK
        .replace("[-40, -40, -20]", "[100, 100, -20]")
        .replace("[40, 40, 0]", "[200, 200, 0]");
    let text = format!("{CELL}{CUT}{far}{}", ask("file = \"step.ngc\""));
    let study = read("study.toml", folder.path(), text.as_bytes()).unwrap();
    let error = run(&study, Watch::NONE).unwrap_err().to_string();
    for words in [
        "step.ngc",
        "cuts nothing of its stock",
        "(-60.0, 0.0, -1.0)",
        "(200.0, 200.0, 0.0) mm",
    ] {
        assert!(error.contains(words), "no `{words}` in {error}");
    }
}

#[test]
fn what_keeps_the_tolerance_is_told_and_holds_when_it_is_cut() {
    let path = of_cut(CUT);
    let limits = path.limits.as_ref().unwrap();
    let depth = limits.axial_depth.as_ref().unwrap();
    assert_eq!((depth.unit, depth.verdict), ("mm", "up to"));
    let at_limit = of_cut(&CUT.replace("axial_depth_mm = 1", &format!("axial_depth_mm = {}", depth.value)));
    // The points asked are every third or so of the path: between them it may be a little worse.
    let largest = at_limit.max_in_plane_um.unwrap();
    assert!((largest / 60.0 - 1.0).abs() < 0.01, "{largest}");
    // The edges rub too hard at this depth, however thin the chip.
    let feed = limits.feed_per_tooth.as_ref().unwrap();
    assert_eq!((feed.value, feed.verdict), (0.0, "nothing"));
    let width = limits.radial_depth.as_ref().unwrap();
    assert!(width.value > 0.0 && limits.points > 50);
    let force = |limit: &Option<armill_study::answer::LimitAnswer>| limit.as_ref().unwrap().value;
    assert!(force(&limits.any_direction) <= force(&limits.cross).min(force(&limits.along)) * (1.0 + 1e-9));
    let without = ask("file = \"step.ngc\"\nlimits = false");
    let answer = told(&format!("{CELL}{CUT}{without}"), &[("step.ngc", STEP_OVER)]).unwrap();
    assert!(answer.paths[0].limits.is_none());
}

#[test]
fn force_and_tool_rest_and_it_is_told_where_that_matters() {
    let deep = of_cut(
        &CUT.replace("axial_depth_mm = 1", "axial_depth_mm = 0.2")
            .replace("radial_depth_mm = 3", "radial_depth_mm = 0.3"),
    );
    let rest = deep.cut.as_ref().unwrap().rest.as_ref().unwrap();
    assert_eq!((rest.points_unsettled, rest.first_unsettled_line), (0, None));
    let largest = deep.max_in_plane_um.unwrap();
    let ratio = rest.max_in_plane_if_drawn_um / largest;
    let noted = deep.notes.iter().any(|note| note.contains("strays so far"));
    assert_eq!(noted, (ratio - 1.0).abs() > 0.05, "{ratio}");
    assert!((ratio - 1.0).abs() > 1e-4, "{ratio}");
    // A right-hand helix draws the soft arm into a slot: a sixth more than the force as drawn would make.
    let slot = of_cut(&format!("{CUT}{STOCK}"));
    assert!(
        slot.notes.iter().any(|note| note.contains("strays so far")),
        "{:?}",
        slot.cut
    );
}

#[test]
fn a_drill_thrusts_where_it_goes_in_and_moves_the_tool_as_that_force_does() {
    let holes = "G21 G90 G17\nS1000 M3\nG0 X0 Y0 Z10\nG81 X10 Y0 Z-10 R2 F200\nX-10\nG80\nM2\n";
    let drill = "file = \"holes.ngc\"\nfeature = [{ name = \"first\", kind = \"hole\", lines = [4, 4] }]";
    let table = "\ndrill = { material = \"steel-low-alloy\", diameter_mm = 6 }";
    let drilled = told(
        &format!("{CELL}{}", ask(&format!("{drill}{table}"))),
        &[("holes.ngc", holes)],
    );
    let drilled = drilled.unwrap();
    let program = &drilled.paths[0];
    let thrust = program.cut.as_ref().unwrap().largest_mean_n;
    assert!(thrust > 100.0, "{thrust}");
    for words in ["chisel edge", "normal to a lip"] {
        assert!(program.notes.iter().any(|note| note.contains(words)), "{words}");
    }
    assert!(
        drilled
            .sources
            .iter()
            .any(|source| source.key.starts_with("material:"))
    );
    // The same thrust as a case along the tool, and the torque about it as a moment, move the holes as far.
    let force = format!("load = {{ frame = \"feed\", cases_n = [[0, 0, {thrust}]] }}\n");
    let pushed = told(&format!("{CELL}{force}{}", ask(drill)), &[("holes.ngc", holes)]).unwrap();
    let shift = |answer: &StudyAnswer| answer.paths[0].features[0].shift_um.unwrap();
    let ([x, y, _], [x_pushed, y_pushed, _]) = (shift(&drilled), shift(&pushed));
    let off = (x - x_pushed).hypot(y - y_pushed);
    // What the torque, some newton metres, adds.
    assert!(
        off > 0.0 && off < 0.3 * x_pushed.hypot(y_pushed),
        "{x} {y} {x_pushed} {y_pushed}"
    );
    for (wrong, words) in [
        (
            table.replace("steel-low-alloy", "cheese"),
            "no material is called `cheese`",
        ),
        (
            table.replace("diameter_mm = 6", "diameter_mm = 0"),
            "diameter of the drill",
        ),
        (
            format!("{table}\nmeasured = {{ file = \"x.csv\", acts_on = \"tool\", frame = \"feed\" }}"),
            "a drill and measured forces",
        ),
    ] {
        let study = format!("{CELL}{}", ask(&format!("{drill}{wrong}")));
        let error = told(&study, &[("holes.ngc", holes)]).unwrap_err();
        assert!(error.contains(words) && error.contains("study.toml:"), "{error}");
    }
}

#[test]
fn kienzle_says_what_it_assumes() {
    let cut = CUT
        .replace("[cut]", "[cut]\nlaw = \"kienzle\"")
        .replace("aluminium-6082-t6", "steel-low-alloy");
    let answer = told(
        &format!("{CELL}{cut}{}", ask("file = \"ring.ngc\"")),
        &[("ring.ngc", RING)],
    )
    .unwrap();
    let notes = &answer.paths[0].notes;
    assert!(
        notes
            .iter()
            .any(|note| note.contains("radial and axial force are assumed")),
        "{notes:?}"
    );
}

#[test]
fn a_given_spin_turns_the_last_joint_as_a_fixed_one_does() {
    let row = |x: i32, spin: &str| format!("{x},0,0,{spin}\n");
    let head = "x_mm,y_mm,z_mm,spin_deg\n";
    let told_ones = format!("{head}{}{}", row(0, "20"), row(40, "50"));
    let last = |extra: &str, table: &str| {
        let study = format!("{CELL}{LOAD}{}", ask(&format!("file = \"path.csv\"\n{extra}")));
        told(&study, &[("path.csv", table)]).map(|answer| answer.paths[0].joint_range_deg[5])
    };
    let given = last("spin = \"given\"\nspin_deg = 5", &told_ones).unwrap();
    let [from, to] = [25.0, 55.0].map(|deg| {
        let table = format!("{head}{}{}", row(0, ""), row(40, ""));
        last(&format!("spin_deg = {deg}"), &table).unwrap()
    });
    // At the ends of the line the arm stands as with that spin all along.
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
    for word in ["study.toml:", "path.csv: line 3 tells no spin", "spin_deg"] {
        assert!(error.contains(word), "no `{word}` in\n{error}");
    }
}

#[test]
fn the_sources_of_the_material_stand_among_those_of_the_answer() {
    let files = [("ring.ngc", RING)];
    let answer = told(&format!("{CELL}{CUT}{}", ask("file = \"ring.ngc\"")), &files).unwrap();
    let of_material = |answer: &StudyAnswer| {
        let keys = answer.sources.iter().map(|source| source.key.clone());
        keys.filter(|key| key.starts_with("material:"))
            .collect::<Vec<_>>()
    };
    assert_eq!(of_material(&answer), ["material:duan"]);
    let kienzle = CUT.replace("[cut]", "[cut]\nlaw = \"kienzle\"");
    let answer = told(&format!("{CELL}{kienzle}{}", ask("file = \"ring.ngc\"")), &files).unwrap();
    assert_eq!(of_material(&answer), ["material:iscar"]);
    assert!(
        answer.answer.contains("across its axis (line "),
        "{}",
        answer.answer
    );
}

#[test]
fn what_is_wrong_is_told_at_its_place() {
    let ring = ask("file = \"ring.ngc\"");
    let slow = CUT
        .replace("spindle_rpm = 9000", "")
        .replace("feed_mm_per_min = 600", "");
    let silent = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F100\nM2\n";
    for (study, program, words) in [
        (
            format!("{CELL}{LOAD}{}", ask("file = \"none.ngc\"")),
            RING,
            &["cannot read", "none.ngc", "study.toml:"][..],
        ),
        (
            format!("{CELL}{LOAD}{ring}"),
            "G21\nG0 X1\nM2\n",
            &["no cutting move"],
        ),
        (
            format!("{CELL}{LOAD}{ring}"),
            "G21\nG1 X1 F100\nG99.5 X2\nM2\n",
            &["ring.ngc:3:1", "G99.5"],
        ),
        (
            format!("{CELL}{LOAD}{}", ask("file = \"ring.ngc\"\nstep_mm = 1e-6")),
            RING,
            &["more than", "points"],
        ),
        (
            format!(
                "{CELL}{LOAD}{}",
                ask("file = \"ring.ngc\"\nfeature = [{ name = \"a\", kind = \"line\", lines = [5, 2] }]")
            ),
            RING,
            &["lines 5 to 2"],
        ),
        (
            format!(
                "{CELL}{LOAD}{}",
                ask("file = \"ring.ngc\"\nfeature = [{ name = \"a\", kind = \"line\", lines = [8, 9] }]")
            ),
            RING,
            &["`a`: no cut stands in lines 8 to 9", "lines 5 to 5"],
        ),
        (
            format!("{CELL}{LOAD}{}", ask("file = \".\"")),
            RING,
            &["is a folder"],
        ),
        (
            format!("{CELL}{LOAD}{ring}"),
            "G21\nG1 X1\0\n",
            &["ring.ngc", "not text"],
        ),
        (format!("{CELL}{ring}"), RING, &["no `load`"]),
        (
            format!("{CELL}{slow}{ring}"),
            silent,
            &["line 3", "spindle speed", "cut.spindle_rpm"],
        ),
        (
            format!("{CELL}{}{ring}", CUT.replace("6082-t6", "6082")),
            RING,
            &[
                "no material is called `aluminium-6082`",
                "did you mean `aluminium-6082-t6`?",
            ],
        ),
        (
            format!(
                "{CELL}{}{ring}",
                CUT.replace("diameter_mm = 10", "diameter_mm = 0")
            ),
            RING,
            &["diameter"],
        ),
        (
            format!(
                "{CELL}{CUT}{}{ring}",
                STOCK.replace("[40, 40, 0]", "[40, -40, 0]")
            ),
            RING,
            &["study.toml:", "along y", "must be greater"],
        ),
        (
            format!(
                "{CELL}{}{ring}",
                CUT.replace("axial_depth_mm = 1", "axial_depth_mm = 0")
            ),
            RING,
            &["axial depth of 0 mm"],
        ),
        (
            format!("{CELL}{}{ring}", CUT.replace("radial_depth_mm = 3", "")),
            RING,
            &["radial_depth_mm"],
        ),
        (
            format!(
                "{CELL}{}{ring}",
                CUT.replace("radial_depth_mm = 3", "radial_depth_mm = 30")
            ),
            RING,
            &[
                "radial depth of cut is 30 mm: must be above 0 and at most 10 mm",
                "line 5",
            ],
        ),
        (
            format!("{CELL}load = {{ frame = \"feed\", cases_n = [[1, 0, 0]] }}\n[[ask]]\nkind = \"map\"\n"),
            RING,
            &["no feed that a load could turn with"],
        ),
    ] {
        let error = told(&study, &[("ring.ngc", program)]).unwrap_err();
        let mut message = String::new();
        let _ = write!(message, "{error}");
        for word in words {
            assert!(message.contains(word), "no `{word}` in\n{message}");
        }
    }
}

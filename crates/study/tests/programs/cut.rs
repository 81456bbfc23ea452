//! Forces of the cut: depth, tool at rest, what keeps the tolerance, drills, materials and their sources.

use armill_study::answer::StudyAnswer;

use crate::{CELL, CUT, RING, STEP_OVER, STOCK, analysis, of_cut, reported};

#[test]
fn forces_are_computed_from_the_cut_without_a_load() {
    let half = CUT.replace("axial_depth_mm = 1", "axial_depth_mm = 2");
    let [one, two] = [CUT, &half].map(|cut| {
        let answer = reported(
            &format!("{CELL}{cut}{}", analysis("file = \"ring.ngc\"")),
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
    let both = reported(
        &format!("{CELL}{greatest}{}", analysis("file = \"ring.ngc\"")),
        &[("ring.ngc", RING)],
    )
    .unwrap();
    assert!(both.paths[0].max_in_plane_um > one.max_in_plane_um);
    assert_eq!(both.paths[0].worst.as_ref().unwrap().worst_case, 2);
    let ratio = two.max_cross_um.unwrap() / one.max_cross_um.unwrap();
    assert!(ratio > 1.5 && ratio < 2.5, "{ratio}");
    assert!(one.cut.as_ref().unwrap().material.contains("6082"));
    assert!(one.notes.iter().any(|note| note.contains("constant engagement")));
    let worst = one.worst.as_ref().unwrap();
    assert!(
        worst.in_plane_u_um.unwrap() > 0.2 * worst.in_plane_um,
        "{worst:?}"
    );
}

#[test]
fn the_permitted_cut_is_reported_and_meets_the_tolerance_when_it_is_cut() {
    let path = of_cut(CUT);
    let limits = path.limits.as_ref().unwrap();
    let depth = limits.axial_depth.as_ref().unwrap();
    assert_eq!((depth.unit, depth.verdict), ("mm", "up to"));
    let at_limit = of_cut(&CUT.replace("axial_depth_mm = 1", &format!("axial_depth_mm = {}", depth.value)));
    // The evaluated points are about every third of the path: between them it may be a little worse.
    let largest = at_limit.max_in_plane_um.unwrap();
    assert!((largest / 60.0 - 1.0).abs() < 0.01, "{largest}");
    // The edges rub too hard at this depth, however thin the chip.
    let feed = limits.feed_per_tooth.as_ref().unwrap();
    assert_eq!((feed.value, feed.verdict), (0.0, "nothing"));
    let width = limits.radial_depth.as_ref().unwrap();
    assert!(width.value > 0.0 && limits.points > 50);
    let force = |limit: &Option<armill_study::answer::LimitAnswer>| limit.as_ref().unwrap().value;
    assert!(force(&limits.any_direction) <= force(&limits.cross).min(force(&limits.along)) * (1.0 + 1e-9));
    let without = analysis("file = \"step.ngc\"\nlimits = false");
    let answer = reported(&format!("{CELL}{CUT}{without}"), &[("step.ngc", STEP_OVER)]).unwrap();
    assert!(answer.paths[0].limits.is_none());
}

#[test]
fn force_and_tool_rest_and_it_is_reported_where_that_matters() {
    let deep = of_cut(
        &CUT.replace("axial_depth_mm = 1", "axial_depth_mm = 0.2")
            .replace("radial_depth_mm = 3", "radial_depth_mm = 0.3"),
    );
    let rest = deep.cut.as_ref().unwrap().rest.as_ref().unwrap();
    assert_eq!((rest.points_unsettled, rest.first_unsettled_line), (0, None));
    let largest = deep.max_in_plane_um.unwrap();
    let ratio = rest.nominal_max_in_plane_um / largest;
    let noted = deep.notes.iter().any(|note| note.contains("deflects so far"));
    assert_eq!(noted, (ratio - 1.0).abs() > 0.05, "{ratio}");
    assert!((ratio - 1.0).abs() > 1e-4, "{ratio}");
    // A right-hand helix pulls the compliant robot into a slot: a sixth more than with the nominal force.
    let slot = of_cut(&format!("{CUT}{STOCK}"));
    assert!(
        slot.notes.iter().any(|note| note.contains("deflects so far")),
        "{:?}",
        slot.cut
    );
}

#[test]
fn a_drill_has_the_deviation_of_its_thrust_during_the_feed() {
    let holes = "G21 G90 G17\nS1000 M3\nG0 X0 Y0 Z10\nG81 X10 Y0 Z-10 R2 F200\nX-10\nG80\nM2\n";
    let drill = "file = \"holes.ngc\"\nfeature = [{ name = \"first\", kind = \"hole\", lines = [4, 4] }]";
    let table = "\ndrill = { material = \"steel-low-alloy\", diameter_mm = 6 }";
    let drilled = reported(
        &format!("{CELL}{}", analysis(&format!("{drill}{table}"))),
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
    let pushed = reported(
        &format!("{CELL}{force}{}", analysis(drill)),
        &[("holes.ngc", holes)],
    )
    .unwrap();
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
        let study = format!("{CELL}{}", analysis(&format!("{drill}{wrong}")));
        let error = reported(&study, &[("holes.ngc", holes)]).unwrap_err();
        assert!(error.contains(words) && error.contains("study.toml:"), "{error}");
    }
}

#[test]
fn kienzle_reports_its_assumptions() {
    let cut = CUT
        .replace("[cut]", "[cut]\nlaw = \"kienzle\"")
        .replace("aluminium-6082-t6", "steel-low-alloy");
    let answer = reported(
        &format!("{CELL}{cut}{}", analysis("file = \"ring.ngc\"")),
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
fn the_sources_of_the_material_are_among_those_of_the_result() {
    let files = [("ring.ngc", RING)];
    let answer = reported(&format!("{CELL}{CUT}{}", analysis("file = \"ring.ngc\"")), &files).unwrap();
    let of_material = |answer: &StudyAnswer| {
        let keys = answer.sources.iter().map(|source| source.key.clone());
        keys.filter(|key| key.starts_with("material:"))
            .collect::<Vec<_>>()
    };
    assert_eq!(of_material(&answer), ["material:duan"]);
    let kienzle = CUT.replace("[cut]", "[cut]\nlaw = \"kienzle\"");
    let answer = reported(
        &format!("{CELL}{kienzle}{}", analysis("file = \"ring.ngc\"")),
        &files,
    )
    .unwrap();
    assert_eq!(of_material(&answer), ["material:iscar"]);
    assert!(
        answer.answer.contains("across its axis (line "),
        "{}",
        answer.answer
    );
}

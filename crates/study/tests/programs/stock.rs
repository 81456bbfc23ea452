//! A stock: what the cutter meets of it, and a program that misses it.

use std::f64::consts::TAU;
use std::fs;

use armill_core::watch::Watch;
use armill_study::file::resolve::read;
use armill_study::run::run;

use crate::{CELL, CUT, STEP_OVER, STOCK, analysis, of_cut, reported};

#[test]
fn a_stock_determines_where_the_cutter_is_in_the_air_in_a_slot_and_next_to_one() {
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
    assert!(note(&program, "of the tool in the stock") && !note(&program, "constant engagement"));
    // A slot has larger forces than the cut given in the study.
    let given = of_cut(CUT);
    let mean = |program: &armill_study::answer::PathAnswer| program.cut.as_ref().unwrap().largest_mean_n;
    assert!(
        mean(&program) > 1.2 * mean(&given),
        "{} {}",
        mean(&program),
        mean(&given)
    );
    assert!(given.cut.as_ref().unwrap().stock.is_none() && note(&given, "constant engagement"));
}

#[test]
fn a_program_that_misses_its_stock_is_refused_and_not_praised() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("step.ngc"), STEP_OVER).unwrap();
    let far = STOCK
        .replace("[-40, -40, -20]", "[100, 100, -20]")
        .replace("[40, 40, 0]", "[200, 200, 0]");
    let text = format!("{CELL}{CUT}{far}{}", analysis("file = \"step.ngc\""));
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

/// The path of the step-over in the stock, with a holder of this diameter that begins at this distance from the tip, mm.
fn with_holder(diameter: f64, from_tip: f64, more: &str) -> armill_study::answer::PathAnswer {
    const TOOL: &str = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }\n";
    let cell = CELL.replace(TOOL, more);
    assert_ne!(cell, CELL);
    let body = format!(
        "\n[tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\n[[tool.body]]\nname = \"holder\"\ncylinder_mm = {{ from = [0, 0, 100], to = [0, 0, {}], diameter = {diameter} }}\n",
        150.0 - from_tip
    );
    let study = format!("{cell}{CUT}{STOCK}{body}{}", analysis("file = \"step.ngc\""));
    reported(&study, &[("step.ngc", STEP_OVER)]).unwrap().paths[0].clone()
}

#[test]
fn the_holder_keeps_the_clearance_from_the_stock_that_is_left() {
    let nearest = |path: &armill_study::answer::PathAnswer| path.nearest.clone().unwrap().join(" and ");
    // 1 mm deep: a holder 3 mm above the tip is 2 mm above the banks of the slot, which is narrower than the holder.
    let above = with_holder(20.0, 3.0, "");
    assert_eq!(
        (above.in_collision, &nearest(&above)[..]),
        (0, "holder and stock")
    );
    assert!(
        (above.least_clearance_mm.unwrap() - 2.0).abs() < 1e-4,
        "{above:?}"
    );
    // A demand of 2.5 mm is missed where the holder is within that of the stock: first 10 mm and 1.5 mm before the block.
    let demanding = with_holder(20.0, 3.0, "least_clearance_mm = 2.5\n");
    let first = demanding
        .obstacles
        .iter()
        .find(|found| found.kind == "collision")
        .unwrap();
    assert!(
        demanding.in_collision > 100 && (first.value.unwrap() - 0.5).abs() < 1e-4,
        "{first:?}"
    );
    assert!((demanding.least_clearance_mm.unwrap() - 2.0).abs() < 1e-4);
    // Half a millimetre above the tip it hits the banks.
    let low = with_holder(20.0, 0.5, "");
    assert!(
        low.in_collision > 100 && low.least_clearance_mm == Some(0.0),
        "{low:?}"
    );
    assert_eq!(low.unreachable, low.in_collision);
    // A shank in the slot, 10 mm wide: half a millimetre above its floor, 2 mm from its walls.
    let shank = with_holder(6.0, 0.5, "");
    assert!(
        shank.in_collision == 0 && (shank.least_clearance_mm.unwrap() - 0.5).abs() < 1e-4,
        "{shank:?}"
    );
}

/// Half in the edge of a block, 6 mm deep: a wall remains next to the cutter on one side, on the other there is air.
const EDGE: &str = "G21 G90 G17\nS9000 M3\nG0 X38 Y-60 Z10\nG0 Z-6\nG1 Y60 F600\nG0 Z10\nM2\n";

/// The path along the edge with these bodies of the tool, a spin from `spin_deg` on and this search; 1 mm is demanded.
fn along_the_edge(bodies: &str, spin_deg: f64, search: &str) -> armill_study::answer::PathAnswer {
    const POSTURE: &str = "posture = { branch = \"front elbow-up no-flip\" }\n";
    const TOOL: &str = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }\n";
    let cell = CELL
        .replace(TOOL, "least_clearance_mm = 1\n")
        .replace(POSTURE, "");
    let rest = format!(
        "[posture]\nbranch = \"front elbow-up no-flip\"\n{search}\n[tool]\nflange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0]\n{bodies}"
    );
    let program = format!("file = \"edge.ngc\"\nspin_deg = {spin_deg}");
    let study = format!("{cell}{CUT}{STOCK}\n{rest}{}", analysis(&program));
    reported(&study, &[("edge.ngc", EDGE)]).unwrap().paths[0].clone()
}

#[test]
fn a_search_finds_spins_at_which_the_arm_is_clear_of_the_stock_where_the_programmed_spin_is_not() {
    // A nozzle next to the cutter, 20 mm from its axis, which ends 3 mm above the tip: 3 mm below the top of the block.
    const NOZZLE: &str = "[[tool.body]]\nname = \"nozzle\"\ncylinder_mm = { from = [20, 0, 100], to = [20, 0, 147], diameter = 5 }\n";
    let [fixed, searched] = ["", "search = { step_deg = 15 }"].map(|search| {
        let spins = [0.0, 90.0, 180.0, 270.0];
        spins.map(|spin| along_the_edge(NOZZLE, spin, search))
    });
    // At one of the spins the nozzle is over the block all along, at the opposite one it is not.
    let lost = fixed.each_ref().map(|path| path.in_collision);
    let worst = (0..4).max_by_key(|spin| lost[*spin]).unwrap();
    assert!(lost[worst] > 50 && lost[(worst + 2) % 4] == 0, "{lost:?}");
    for (fixed, searched) in fixed.iter().zip(&searched) {
        assert_eq!((searched.in_collision, searched.unreachable), (0, 0));
        assert!(searched.least_clearance_mm.unwrap() >= 1.0);
        let search = searched.search.as_ref().unwrap();
        assert!(search.unreachable_stretches.is_empty() && search.breaks.is_empty());
        assert!(search.applied || fixed.in_collision == 0);
        // The cut is the same in every posture.
        let cut = |path: &armill_study::answer::PathAnswer| path.cut.clone().unwrap();
        let (before, after) = (cut(fixed), cut(searched));
        assert_eq!(before.largest_mean_n, after.largest_mean_n);
        assert_eq!(
            before.stock.unwrap().removed_mm3,
            after.stock.unwrap().removed_mm3
        );
    }
}

#[test]
fn where_every_spin_is_in_the_stock_the_body_and_what_is_missing_are_reported() {
    // A holder that is round about the axis, 20 mm wide, half a millimetre above the top of the block.
    const HOLDER: &str = "[[tool.body]]\nname = \"holder\"\ncylinder_mm = { from = [0, 0, 100], to = [0, 0, 143.5], diameter = 20 }\n";
    let path = along_the_edge(HOLDER, 0.0, "search = {}");
    let search = path.search.as_ref().unwrap();
    assert_eq!(search.unreachable_stretches[0].reason, "in_collision");
    assert_eq!(path.nearest.clone().unwrap().join(" and "), "holder and stock");
    let obstacle = |kind: &str| path.obstacles.iter().find(|found| found.kind == kind);
    let missing = obstacle("collision").unwrap().value.unwrap();
    // The first point without a posture is where the edge of the holder comes within a millimetre of the block.
    assert!(missing > 0.0 && missing <= 0.5 + 1e-4, "{missing}");
    assert!((path.least_clearance_mm.unwrap() - 0.5).abs() < 1e-4);
    assert!(path.in_collision > 80, "{}", path.in_collision);
}

//! A stock: what the cutter meets of it, and a program that misses it.

use std::f64::consts::TAU;
use std::fs;

use armill_core::watch::Watch;
use armill_study::file::resolve::read;
use armill_study::run::run;

use crate::{CELL, CUT, STEP_OVER, STOCK, analysis, of_cut};

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

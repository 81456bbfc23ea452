//! `armill materials`: the list, one material, a name that is not there.

use crate::cell::{Cell, number};

#[test]
fn every_material_has_a_line_with_its_laws_and_sets() {
    let said = Cell::new().armill(&["materials"]).fine();
    assert_eq!(said.out.lines().count(), 42);
    for line in said.out.lines() {
        assert!(line.chars().count() <= 140, "{line}");
        assert!(
            line.contains("mechanistic (") || line.contains("kienzle ("),
            "{line}"
        );
    }
    let of_7075 = said
        .out
        .lines()
        .find(|line| line.starts_with("aluminium-7075-t6"))
        .unwrap();
    assert!(
        of_7075.contains("Aluminium") && of_7075.contains("mechanistic (3 sets)"),
        "{of_7075}"
    );
    let rows = Cell::new().armill(&["materials", "--json"]).fine().json();
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 42);
    let of_6061 = rows
        .iter()
        .find(|row| row["name"] == "aluminium-6061-t6")
        .unwrap();
    assert_eq!(
        number(&of_6061["mechanistic_sets"]),
        0.0,
        "its set has no axial coefficients"
    );
}

#[test]
fn a_material_is_shown_with_every_set_and_what_is_used() {
    let cell = Cell::new();
    let said = cell.armill(&["materials", "aluminium-7075-t6"]).fine();
    for words in ["Ktc", "767.01", "951.365", "1319.41", "1013 ± 281.2", "Sources:"] {
        assert!(said.out.contains(words), "no `{words}` in:\n{}", said.out);
    }
    let shown = cell
        .armill(&["materials", "aluminium-7075-t6", "--json"])
        .fine()
        .json();
    let used = &shown["used"]["mechanistic"];
    // 767.01, 951.365 and 1319.41 N/mm2.
    assert_eq!(number(&used["sets"]), 3.0);
    assert!((number(&used["ktc_n_per_mm2"]) - 1012.595).abs() < 1e-9);
    assert!((number(&used["spread_ktc_n_per_mm2"]) - 281.24).abs() < 0.01);
    // A fourth set lacks its axial coefficients.
    assert_eq!(shown["mechanistic"].as_array().unwrap().len(), 4);
    let source = shown["mechanistic"][0]["source"].as_str().unwrap();
    let sources = shown["sources"].as_array().unwrap();
    assert!(sources.iter().any(|given| given["key"] == source));
}

#[test]
fn a_single_set_has_no_spread_and_an_incomplete_one_gives_no_force() {
    let cell = Cell::new();
    let single = cell.armill(&["materials", "aluminium-6082-t6"]).fine();
    assert!(single.out.contains("used: the only complete set") && !single.out.contains('±'));
    let shown = cell
        .armill(&["materials", "aluminium-6082-t6", "--json"])
        .fine()
        .json();
    assert!(shown["used"]["mechanistic"]["spread_ktc_n_per_mm2"].is_null());
    let part = cell.armill(&["materials", "aluminium-6061-t6"]).fine();
    assert!(part.out.contains("no set has all six"), "{}", part.out);
}

#[test]
fn a_name_that_is_not_there_is_refused_with_the_nearest_one() {
    let cell = Cell::new();
    cell.armill(&["materials", "aluminium-7057-t6"])
        .refused(&["`aluminium-7057-t6`", "did you mean `aluminium-7075-t6`?"]);
    cell.armill(&["materials", "cheese"])
        .refused(&["`cheese`", "`armill materials` lists all"]);
}

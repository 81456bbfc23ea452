//! Fields that are unknown, missing or of another kind of table.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::Document;
use super::{Analysis, Plane, assert_hint, assert_problems, read};

#[test]
fn all_problems_are_reported_at_once_in_the_order_of_the_text() {
    let text = "nam = 3\nversion = 2\n[plane]\nstep = 1\n[[analysis]]\nkind = 'mapp'\n[[analysis]]\nkind = 'map'\ntolerance_um = nan\n";
    let problems = read(text).unwrap_err();
    let messages: Vec<String> = problems.as_slice().iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "study.toml:1:1: unknown field `nam`",
            "study.toml:2:11: `version` is the number 2: must be 1",
            "study.toml:4:1: unknown field `plane.step`",
            "study.toml:6:8: `analysis[0].kind` is the string \"mapp\": must be one of \"map\", \"path\", \"again\"",
            "study.toml:9:16: `analysis[1].tolerance_um` is nan: must be a finite number",
        ]
    );
}

#[test]
fn an_unknown_field_is_reported_with_a_suggestion() {
    assert_hint("cooled", "coled", "did you mean `cooled`?");
    assert_hint(
        "step_mm = 5",
        "step = 5",
        "lengths carry their unit: write `step_mm`",
    );
    assert_hint(
        "step_mm = 5",
        "step_m = 0.005",
        "give the value in mm: write `step_mm`",
    );
    assert_hint(
        "cooled = true",
        "cooled = true\nbanana = 1",
        "the fields here are `cooled`, `distances_mm`, `name`",
    );
}

#[test]
fn an_unknown_field_is_shown_by_its_key() {
    assert_problems(
        "cooled = true",
        "cooled = true\n\"a b\".c = 1",
        &["17:1: unknown field `tool.\"a b\"`"],
    );
}

#[test]
fn a_missing_field_is_reported_at_the_header_of_its_table() {
    assert_problems(
        "step_mm = 5",
        "",
        &["9:1: missing field `plane.step_mm`: a number in mm"],
    );
    assert_hint("step_mm = 5", "", "`step_mm` is: Distance of neighbouring points");
    assert_problems("name = \"groove\"", "", &["1:1: missing field `name`: a string"]);
    assert_problems(
        "tolerance_um = 20",
        "",
        &["18:1: missing field `analysis[0].tolerance_um`: a number in um"],
    );
}

#[test]
fn the_fields_of_another_kind_are_refused() {
    assert_problems(
        "tolerance_um = 20",
        "tolerance_um = 20\nfeed_mm_per_min = 3.0",
        &["21:1: unknown field `analysis[0].feed_mm_per_min`"],
    );
    assert_problems(
        "kind = \"again\"\nstep_mm = 1.0",
        "kind = \"again\"\nstep_mm = 0",
        &["29:11: `analysis[2].step_mm` is 0 mm: must be above 0 mm"],
    );
}

#[test]
fn an_untagged_table_is_compared_with_the_table_among_its_alternatives() {
    assert_problems(
        "speed = 3",
        "speed = { step_mm = 1.0, tilt = 3 }",
        &["6:26: unknown field `speed.tilt`"],
    );
    assert_problems(
        "speed = 3",
        "speed = { step_mm = -1 }",
        &["6:21: `speed.step_mm` is -1 mm: must be above 0 mm"],
    );
}

#[test]
fn a_type_that_contains_itself_is_checked_all_the_way_down() {
    assert_problems(
        "step_mm = 5",
        "step_mm = 5\ninner = { step_mm = 1, inner = { step_mm = 'x' } }",
        &["11:44: `plane.inner.inner.step_mm`: expected a number in mm, found the string \"x\""],
    );
}

#[test]
fn the_fields_of_a_flattened_struct_and_enum_are_known() {
    #[derive(Debug, Deserialize, JsonSchema)]
    #[allow(dead_code, reason = "never built")]
    struct Flat {
        name: String,
        #[serde(flatten)]
        plane: Plane,
        #[serde(flatten)]
        analysis: Analysis,
    }
    let read = |text: &str| {
        Document::parse("a.toml", text)
            .unwrap()
            .read::<Flat>()
            .unwrap_err()
            .to_string()
    };
    let problems = read("name = 'x'\nstep_mm = -1\nkind = 'map'\ntolerance_um = 'y'\n");
    assert!(
        problems.contains("a.toml:2:11: `step_mm` is -1 mm: must be above 0 mm"),
        "{problems}"
    );
    assert!(
        problems.contains("a.toml:4:16: `tolerance_um`: expected a number in um"),
        "{problems}"
    );
}

//! Values of the wrong type, count, size or choice.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::Document;
use super::{Analysis, Axis, GOOD, Speed, assert_hint, assert_problems, read};

#[test]
fn reads_a_correct_file_and_accepts_integers_as_numbers() {
    let study = read(GOOD).unwrap();
    assert_eq!(study.plane.step_mm, 5.0);
    assert_eq!(study.plane.origin_mm, Some([0.0, 1.5, -20.0]));
    assert!(matches!(study.axis, Axis::ToolTip));
    assert!(
        matches!(&study.analysis[1], Analysis::Path { points_mm, .. } if points_mm[1] == [1.0, 2.0, 3.0])
    );
    assert!(matches!(&study.analysis[2], Analysis::Again(plane) if plane.step_mm == 1.0));
    assert!(matches!(study.speed, Some(Speed::Fixed(3.0))));
    assert_eq!(study.limits_um["EN AW-6082"], 100.0);
}

#[test]
fn a_wrong_type_is_reported_with_what_was_expected_and_found() {
    assert_problems(
        "step_mm = 5",
        "step_mm = '5'",
        &["10:11: `plane.step_mm`: expected a number in mm, found the string \"5\""],
    );
    assert_hint(
        "step_mm = 5",
        "step_mm = '5'",
        "write the number without quotes: `5`",
    );
    assert_problems(
        "cooled = true",
        "cooled = 1",
        &["16:10: `tool.cooled`: expected true or false, found the number 1"],
    );
    assert_problems(
        "name = \"groove\"",
        "name = 1979-05-27",
        &["2:8: `name`: expected a string, found the date 1979-05-27"],
    );
    assert_problems(
        "name = \"groove\"",
        "name = false",
        &["2:8: `name`: expected a string, found false"],
    );
    assert_problems(
        "name = \"groove\"",
        "name = [1]",
        &["2:8: `name`: expected a string, found an array of 1 entry"],
    );
    assert_problems(
        "origin_mm = [0, 1.5, -2e1]",
        "origin_mm = 3",
        &["11:13: `plane.origin_mm`: expected an array of 3 numbers in mm, found the number 3"],
    );
    assert_problems(
        "steel = 50",
        "steel = '50'",
        &["4:43: `limits_um.steel`: expected a number, found the string \"50\""],
    );
    assert_problems(
        "speed = 3",
        "speed = true",
        &["6:9: `speed`: expected a number or a table, found true"],
    );
    assert_problems(
        "speed = 3",
        "speed = 3\nthreads = 1.0",
        &["7:11: `threads`: expected a whole number, found the number 1.0"],
    );
    assert_problems(
        "points_mm = [[0, 0, 0], [1, 2, 3]]",
        "points_mm = [[0, 0, 'a']]",
        &["25:21: `analysis[1].points_mm[0][2]`: expected a number in mm, found the string \"a\""],
    );
}

#[test]
fn a_single_table_where_many_are_wanted_is_explained() {
    let text = "name = 'x'\nversion = 1\n[plane]\nstep_mm = 1\n[analysis]\nkind = 'map'\n";
    let problems = read(text).unwrap_err();
    assert_eq!(
        problems.as_slice()[0].message(),
        "`analysis`: expected an array of tables, found a table"
    );
    assert_eq!(
        problems.as_slice()[0].hint(),
        Some("tables that repeat are written `[[analysis]]`")
    );
}

#[test]
fn a_wrong_number_of_entries_is_reported() {
    assert_problems(
        "[0, 1.5, -2e1]",
        "[0, 1.5]",
        &["11:13: `plane.origin_mm` has 2 entries: expected an array of 3 numbers in mm"],
    );
    assert_problems(
        "[1.0, 2.0]",
        "[1.0]",
        &["15:16: `tool.distances_mm` has 1 entry: expected an array of at least 2 numbers in mm"],
    );
    assert_problems(
        "[1, 2, 3]]",
        "[1, 2, 3, 4]]",
        &["25:25: `analysis[1].points_mm[1]` has 4 entries: expected an array of 3 numbers in mm"],
    );
    assert_problems(
        "pair = [1.5, \"x\"]",
        "pair = ['x', 1.5]",
        &[
            "7:9: `pair[0]`: expected a number, found the string \"x\"",
            "7:14: `pair[1]`: expected a string, found the number 1.5",
        ],
    );
}

#[test]
fn a_number_out_of_range_is_reported_with_its_limit_and_unit() {
    assert_problems(
        "step_mm = 5",
        "step_mm = 0",
        &["10:11: `plane.step_mm` is 0 mm: must be above 0 mm"],
    );
    assert_problems(
        "step_mm = 5",
        "step_mm = 100.5",
        &["10:11: `plane.step_mm` is 100.5 mm: must be at most 100 mm"],
    );
    assert_problems(
        "step_mm = 5",
        "step_mm = 5\ntilt_deg = -181",
        &["11:12: `plane.tilt_deg` is -181 deg: must be at least -180 deg"],
    );
    assert_problems(
        "speed = 3",
        "speed = 3\nthreads = 256",
        &["7:11: `threads` is 256: must be at most 255"],
    );
    assert_problems(
        "speed = 3",
        "speed = 3\nthreads = -1",
        &["7:11: `threads` is -1: must be at least 0"],
    );
}

#[test]
fn a_number_that_is_not_finite_is_refused_anywhere() {
    assert_problems(
        "step_mm = 5",
        "step_mm = nan",
        &["10:11: `plane.step_mm` is nan: must be a finite number"],
    );
    assert_problems(
        "step_mm = 5",
        "step_mm = -inf",
        &["10:11: `plane.step_mm` is -inf: must be a finite number"],
    );
    assert_problems(
        "step_mm = 5",
        "step_mm = 1e999",
        &["10:11: `plane.step_mm` is 1e999: must be a finite number"],
    );
    assert_problems(
        "steel = 50",
        "steel = +inf",
        &["4:43: `limits_um.steel` is +inf: must be a finite number"],
    );
    assert_problems(
        "[[0, 0, 0]",
        "[[0, nan, 0]",
        &["25:18: `analysis[1].points_mm[0][1]` is nan: must be a finite number"],
    );
}

#[test]
fn a_text_that_is_none_of_the_choices_is_reported_with_the_closest() {
    assert_problems(
        "\"tool_tip\"",
        "\"tooltip\"",
        &["5:8: `axis` is the string \"tooltip\": must be one of \"flange\", \"tool_tip\""],
    );
    assert_hint("\"tool_tip\"", "\"tooltip\"", "did you mean \"tool_tip\"?");
    assert_problems(
        "kind = \"map\"",
        "",
        &["18:1: missing field `analysis[0].kind`: one of \"map\", \"path\", \"again\""],
    );
    assert_problems(
        "kind = \"map\"",
        "kind = 7",
        &["19:8: `analysis[0].kind` is the number 7: must be one of \"map\", \"path\", \"again\""],
    );
}

#[test]
fn a_text_of_the_wrong_length_is_reported() {
    assert_problems(
        "\"cutter\"",
        "\"\"",
        &["14:8: `tool.name` has 0 characters: must have between 1 and 8"],
    );
}

#[test]
fn values_that_only_serde_refuses_are_reported_with_their_place() {
    #[derive(Debug, Deserialize, JsonSchema)]
    #[allow(dead_code, reason = "never built")]
    struct Strict {
        #[serde(deserialize_with = "even")]
        count: u32,
    }
    fn even<'de, D: serde::Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
        let count = u32::deserialize(from)?;
        if count % 2 == 0 {
            Ok(count)
        } else {
            Err(serde::de::Error::custom(format!("count {count} is odd")))
        }
    }
    let document = Document::parse("a.toml", "\ncount = 3\n").unwrap();
    let problems = document.read::<Strict>().unwrap_err();
    assert_eq!(problems.as_slice()[0].to_string(), "a.toml:2:9: count 3 is odd");
}

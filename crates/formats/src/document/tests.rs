use proptest::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

use super::*;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code, reason = "the tests look at what is refused, not at what is read")]
struct Study {
    /// What the study is called.
    name: String,
    #[schemars(extend("const" = 1))]
    version: u32,
    plane: Plane,
    tool: Option<Tool>,
    #[serde(default)]
    ask: Vec<Ask>,
    #[serde(default)]
    limits_um: BTreeMap<String, f64>,
    #[serde(default)]
    axis: Axis,
    threads: Option<u8>,
    speed: Option<Speed>,
    pair: Option<(f64, String)>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code, reason = "as above")]
struct Plane {
    /// Distance of neighbouring points.
    /// More about it.
    #[schemars(range(max = 100.0), extend("exclusiveMinimum" = 0))]
    step_mm: f64,
    origin_mm: Option<[f64; 3]>,
    #[schemars(range(min = -180.0, max = 180.0))]
    tilt_deg: Option<f64>,
    inner: Option<Box<Plane>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code, reason = "as above")]
struct Tool {
    #[schemars(length(min = 1, max = 8))]
    name: String,
    #[schemars(length(min = 2))]
    distances_mm: Vec<f64>,
    cooled: bool,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[allow(dead_code, reason = "as above")]
enum Ask {
    /// A map of the plane.
    Map {
        limit_um: f64,
    },
    Path {
        feed_mm_per_min: f64,
        points_mm: Vec<[f64; 3]>,
    },
    Again(Plane),
}

#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Axis {
    #[default]
    Flange,
    /// Documented, so that the schema is not a plain list.
    ToolTip,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "as above")]
enum Speed {
    Fixed(f64),
    Range(Plane),
}

const GOOD: &str = r#"# a study
name = "groove"
version = 1
limits_um = { "EN AW-6082" = 1e2, steel = 50 }
axis = "tool_tip"
speed = 3
pair = [1.5, "x"]

[plane]
step_mm = 5
origin_mm = [0, 1.5, -2e1]

[tool]
name = "cutter"
distances_mm = [1.0, 2.0]
cooled = true

[[ask]]
kind = "map"
limit_um = 20

[[ask]]
kind = "path"
feed_mm_per_min = 300.0
points_mm = [[0, 0, 0], [1, 2, 3]]

[[ask]]
kind = "again"
step_mm = 1.0
"#;

fn read(text: &str) -> Result<Study, Problems> {
    Document::parse("study.toml", text)?.read()
}

/// The problems of [`GOOD`] with one piece of it replaced, as `line:column: message` and hint.
fn told(old: &str, new: &str) -> Vec<(String, Option<String>)> {
    assert!(GOOD.contains(old), "the test replaces nothing");
    let problems = read(&GOOD.replacen(old, new, 1)).unwrap_err();
    problems
        .into_iter()
        .map(|problem| {
            (
                format!("{}:{}: {}", problem.line, problem.column, problem.message),
                problem.hint,
            )
        })
        .collect()
}

#[track_caller]
fn assert_told(old: &str, new: &str, expected: &[&str]) {
    let messages: Vec<String> = told(old, new).into_iter().map(|(message, _)| message).collect();
    assert_eq!(messages, expected);
}

#[track_caller]
fn assert_hint(old: &str, new: &str, expected: &str) {
    let problems = told(old, new);
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!(problems[0].1.as_deref(), Some(expected));
}

#[test]
fn a_correct_file_is_read_and_whole_numbers_do_for_any_number() {
    let study = read(GOOD).unwrap();
    assert_eq!(study.plane.step_mm, 5.0);
    assert_eq!(study.plane.origin_mm, Some([0.0, 1.5, -20.0]));
    assert!(matches!(study.axis, Axis::ToolTip));
    assert!(matches!(&study.ask[1], Ask::Path { points_mm, .. } if points_mm[1] == [1.0, 2.0, 3.0]));
    assert!(matches!(&study.ask[2], Ask::Again(plane) if plane.step_mm == 1.0));
    assert!(matches!(study.speed, Some(Speed::Fixed(3.0))));
    assert_eq!(study.limits_um["EN AW-6082"], 100.0);
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_change_nothing() {
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    assert!(read(&windows).is_ok());
    let broken = windows.replace("step_mm = 5", "step_mm = 'five'");
    let problems = read(&broken).unwrap_err();
    assert_eq!(
        (problems.as_slice()[0].line(), problems.as_slice()[0].column()),
        (10, 11)
    );
    assert!(!problems.to_string().contains('\r'));
}

#[test]
fn all_problems_are_told_at_once_in_the_order_of_the_text() {
    let text = "nam = 3\nversion = 2\n[plane]\nstep = 1\n[[ask]]\nkind = 'mapp'\n[[ask]]\nkind = 'map'\nlimit_um = nan\n";
    let problems = read(text).unwrap_err();
    let messages: Vec<String> = problems.as_slice().iter().map(ToString::to_string).collect();
    assert_eq!(
        messages,
        [
            "study.toml:1:1: unknown field `nam`",
            "study.toml:2:11: `version` is the number 2: must be 1",
            "study.toml:4:1: unknown field `plane.step`",
            "study.toml:6:8: `ask[0].kind` is the string \"mapp\": must be one of \"map\", \"path\", \"again\"",
            "study.toml:9:12: `ask[1].limit_um` is nan: must be a finite number",
        ]
    );
}

#[test]
fn an_unknown_field_comes_with_the_one_that_was_meant() {
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
    assert_told(
        "cooled = true",
        "cooled = true\n\"a b\".c = 1",
        &["17:1: unknown field `tool.\"a b\"`"],
    );
}

#[test]
fn a_missing_field_is_told_at_the_header_of_its_table() {
    assert_told(
        "step_mm = 5",
        "",
        &["9:1: missing field `plane.step_mm`: a number in mm"],
    );
    assert_hint("step_mm = 5", "", "`step_mm` is: Distance of neighbouring points");
    assert_told("name = \"groove\"", "", &["1:1: missing field `name`: a string"]);
    assert_told(
        "limit_um = 20",
        "",
        &["18:1: missing field `ask[0].limit_um`: a number in um"],
    );
}

#[test]
fn a_wrong_type_is_told_with_what_was_expected_and_found() {
    assert_told(
        "step_mm = 5",
        "step_mm = '5'",
        &["10:11: `plane.step_mm`: expected a number in mm, found the string \"5\""],
    );
    assert_hint(
        "step_mm = 5",
        "step_mm = '5'",
        "write the number without quotes: `5`",
    );
    assert_told(
        "cooled = true",
        "cooled = 1",
        &["16:10: `tool.cooled`: expected true or false, found the number 1"],
    );
    assert_told(
        "name = \"groove\"",
        "name = 1979-05-27",
        &["2:8: `name`: expected a string, found the date 1979-05-27"],
    );
    assert_told(
        "name = \"groove\"",
        "name = false",
        &["2:8: `name`: expected a string, found false"],
    );
    assert_told(
        "name = \"groove\"",
        "name = [1]",
        &["2:8: `name`: expected a string, found an array of 1 entry"],
    );
    assert_told(
        "origin_mm = [0, 1.5, -2e1]",
        "origin_mm = 3",
        &["11:13: `plane.origin_mm`: expected an array of 3 numbers in mm, found the number 3"],
    );
    assert_told(
        "steel = 50",
        "steel = '50'",
        &["4:43: `limits_um.steel`: expected a number, found the string \"50\""],
    );
    assert_told(
        "speed = 3",
        "speed = true",
        &["6:9: `speed`: expected a number or a table, found true"],
    );
    assert_told(
        "speed = 3",
        "speed = 3\nthreads = 1.0",
        &["7:11: `threads`: expected a whole number, found the number 1.0"],
    );
    assert_told(
        "points_mm = [[0, 0, 0], [1, 2, 3]]",
        "points_mm = [[0, 0, 'a']]",
        &["25:21: `ask[1].points_mm[0][2]`: expected a number in mm, found the string \"a\""],
    );
}

#[test]
fn a_single_table_where_many_are_wanted_is_explained() {
    let text = "name = 'x'\nversion = 1\n[plane]\nstep_mm = 1\n[ask]\nkind = 'map'\n";
    let problems = read(text).unwrap_err();
    assert_eq!(
        problems.as_slice()[0].message(),
        "`ask`: expected an array of tables, found a table"
    );
    assert_eq!(
        problems.as_slice()[0].hint(),
        Some("tables that repeat are written `[[ask]]`")
    );
}

#[test]
fn a_wrong_number_of_entries_is_told() {
    assert_told(
        "[0, 1.5, -2e1]",
        "[0, 1.5]",
        &["11:13: `plane.origin_mm` has 2 entries: expected an array of 3 numbers in mm"],
    );
    assert_told(
        "[1.0, 2.0]",
        "[1.0]",
        &["15:16: `tool.distances_mm` has 1 entry: expected an array of at least 2 numbers in mm"],
    );
    assert_told(
        "[1, 2, 3]]",
        "[1, 2, 3, 4]]",
        &["25:25: `ask[1].points_mm[1]` has 4 entries: expected an array of 3 numbers in mm"],
    );
    assert_told(
        "pair = [1.5, \"x\"]",
        "pair = ['x', 1.5]",
        &[
            "7:9: `pair[0]`: expected a number, found the string \"x\"",
            "7:14: `pair[1]`: expected a string, found the number 1.5",
        ],
    );
}

#[test]
fn a_number_out_of_range_is_told_with_its_limit_and_unit() {
    assert_told(
        "step_mm = 5",
        "step_mm = 0",
        &["10:11: `plane.step_mm` is 0 mm: must be above 0 mm"],
    );
    assert_told(
        "step_mm = 5",
        "step_mm = 100.5",
        &["10:11: `plane.step_mm` is 100.5 mm: must be at most 100 mm"],
    );
    assert_told(
        "step_mm = 5",
        "step_mm = 5\ntilt_deg = -181",
        &["11:12: `plane.tilt_deg` is -181 deg: must be at least -180 deg"],
    );
    assert_told(
        "speed = 3",
        "speed = 3\nthreads = 256",
        &["7:11: `threads` is 256: must be at most 255"],
    );
    assert_told(
        "speed = 3",
        "speed = 3\nthreads = -1",
        &["7:11: `threads` is -1: must be at least 0"],
    );
}

#[test]
fn a_number_that_is_not_finite_is_refused_anywhere() {
    assert_told(
        "step_mm = 5",
        "step_mm = nan",
        &["10:11: `plane.step_mm` is nan: must be a finite number"],
    );
    assert_told(
        "step_mm = 5",
        "step_mm = -inf",
        &["10:11: `plane.step_mm` is -inf: must be a finite number"],
    );
    assert_told(
        "step_mm = 5",
        "step_mm = 1e999",
        &["10:11: `plane.step_mm` is 1e999: must be a finite number"],
    );
    assert_told(
        "steel = 50",
        "steel = +inf",
        &["4:43: `limits_um.steel` is +inf: must be a finite number"],
    );
    assert_told(
        "[[0, 0, 0]",
        "[[0, nan, 0]",
        &["25:18: `ask[1].points_mm[0][1]` is nan: must be a finite number"],
    );
}

#[test]
fn a_text_that_is_none_of_the_choices_is_told_with_the_closest() {
    assert_told(
        "\"tool_tip\"",
        "\"tooltip\"",
        &["5:8: `axis` is the string \"tooltip\": must be one of \"flange\", \"tool_tip\""],
    );
    assert_hint("\"tool_tip\"", "\"tooltip\"", "did you mean \"tool_tip\"?");
    assert_told(
        "kind = \"map\"",
        "",
        &["18:1: missing field `ask[0].kind`: one of \"map\", \"path\", \"again\""],
    );
    assert_told(
        "kind = \"map\"",
        "kind = 7",
        &["19:8: `ask[0].kind` is the number 7: must be one of \"map\", \"path\", \"again\""],
    );
}

#[test]
fn a_text_of_the_wrong_length_is_told() {
    assert_told(
        "\"cutter\"",
        "\"\"",
        &["14:8: `tool.name` has 0 characters: must have between 1 and 8"],
    );
}

#[test]
fn the_fields_of_another_kind_are_refused() {
    assert_told(
        "limit_um = 20",
        "limit_um = 20\nfeed_mm_per_min = 3.0",
        &["21:1: unknown field `ask[0].feed_mm_per_min`"],
    );
    assert_told(
        "kind = \"again\"\nstep_mm = 1.0",
        "kind = \"again\"\nstep_mm = 0",
        &["29:11: `ask[2].step_mm` is 0 mm: must be above 0 mm"],
    );
}

#[test]
fn an_untagged_table_is_compared_with_the_table_among_its_alternatives() {
    assert_told(
        "speed = 3",
        "speed = { step_mm = 1.0, tilt = 3 }",
        &["6:26: unknown field `speed.tilt`"],
    );
    assert_told(
        "speed = 3",
        "speed = { step_mm = -1 }",
        &["6:21: `speed.step_mm` is -1 mm: must be above 0 mm"],
    );
}

#[test]
fn a_type_that_contains_itself_is_checked_all_the_way_down() {
    assert_told(
        "step_mm = 5",
        "step_mm = 5\ninner = { step_mm = 1, inner = { step_mm = 'x' } }",
        &["11:44: `plane.inner.inner.step_mm`: expected a number in mm, found the string \"x\""],
    );
}

#[test]
fn what_only_serde_refuses_is_a_problem_with_its_place() {
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

#[test]
fn the_fields_of_a_flattened_struct_and_enum_are_known() {
    #[derive(Debug, Deserialize, JsonSchema)]
    #[allow(dead_code, reason = "never built")]
    struct Flat {
        name: String,
        #[serde(flatten)]
        plane: Plane,
        #[serde(flatten)]
        ask: Ask,
    }
    let read = |text: &str| {
        Document::parse("a.toml", text)
            .unwrap()
            .read::<Flat>()
            .unwrap_err()
            .to_string()
    };
    let problems = read("name = 'x'\nstep_mm = -1\nkind = 'map'\nlimit_um = 'y'\n");
    assert!(
        problems.contains("a.toml:2:11: `step_mm` is -1 mm: must be above 0 mm"),
        "{problems}"
    );
    assert!(
        problems.contains("a.toml:4:12: `limit_um`: expected a number in um"),
        "{problems}"
    );
}

#[test]
fn what_is_not_toml_is_told_line_by_line() {
    let problems = Document::parse("a.toml", "x = 3 mm\ny = \nz = 1\nz = 2\n").unwrap_err();
    let lines: Vec<usize> = problems.as_slice().iter().map(Problem::line).collect();
    assert_eq!(lines, [1, 2, 4]);
    assert!(
        problems.as_slice()[2].message().contains("duplicate key"),
        "{problems}"
    );
    assert!(
        problems.to_string().contains("help: keep one of the two"),
        "{problems}"
    );
}

#[test]
fn bytes_that_are_not_text_are_told_with_their_place() {
    let told = |bytes: &[u8]| Document::from_bytes("a.toml", bytes).unwrap_err();
    let problems = told(b"x = 1\ny = \"\xc3\xa4\xff\"\n");
    assert_eq!(
        problems.as_slice()[0].to_string(),
        "a.toml:2:7: the byte 0xff is not UTF-8 text"
    );
    let marked = told(b"\xef\xbb\xbfx = 1\ny = \"\xff\"\n");
    assert_eq!(
        (marked.as_slice()[0].line(), marked.as_slice()[0].column()),
        (2, 6)
    );
    assert!(
        told(b"\xff\xfex\0=\0")
            .to_string()
            .contains("this file is UTF-16")
    );
    assert!(Document::from_bytes("a.toml", b"x = '\xc3").is_err());
    assert!(
        Document::from_bytes("a.toml", GOOD.as_bytes())
            .unwrap()
            .read::<Study>()
            .is_ok()
    );
}

#[test]
fn a_problem_of_the_caller_stands_at_its_value_or_the_nearest_parent() {
    let document = Document::parse("study.toml", GOOD).unwrap();
    let place = |path: &str| {
        let problem = document.problem(path, "m", Some("h"));
        (problem.line(), problem.column(), GOOD[problem.span()].to_owned())
    };
    assert_eq!(place("plane.step_mm"), (10, 11, "5".to_owned()));
    assert_eq!(place("tool.distances_mm[1]"), (15, 22, "2.0".to_owned()));
    assert_eq!(place("ask[1].points_mm[1][2]"), (25, 32, "3".to_owned()));
    assert_eq!(place("limits_um.\"EN AW-6082\""), (4, 30, "1e2".to_owned()));
    assert_eq!(place("ask[1].speed"), (22, 1, "[[ask]]".to_owned()));
    assert_eq!(place("plane.inner.step_mm"), (9, 1, "[plane]".to_owned()));
    assert_eq!(place("nowhere.at.all"), (1, 1, String::new()));
    assert!(document.contains("ask[2].step_mm") && !document.contains("ask[3]"));
}

#[test]
fn problems_are_shown_as_rustc_shows_them() {
    let shown = read(&GOOD.replace("step_mm = 5", "step = 5"))
        .unwrap_err()
        .to_string();
    let expected = "\
error: study.toml:10:1: unknown field `plane.step`
  --> study.toml:10:1
   |
10 | step = 5
   | ^^^^
   |
   = help: lengths carry their unit: write `step_mm`";
    assert_eq!(shown, expected);
}

#[test]
fn the_place_shown_above_the_source_is_that_of_the_problem() {
    let text =
        "\u{feff}# ä\r\n\tname = \"äö\u{1f600}\"\r\nversion = {x = 'ä', \u{22}ü\u{22} = 1, z = nan}\r\n";
    let problems = read(text).unwrap_err();
    for problem in problems.as_slice() {
        let shown = Problems::from(problem.clone()).to_string();
        let arrow = format!("--> study.toml:{}:{}", problem.line(), problem.column());
        assert!(shown.contains(&arrow), "{shown}");
    }
    assert!(
        problems.as_slice().iter().any(|problem| problem.column() == 34),
        "{problems}"
    );
}

#[test]
fn colour_is_only_where_it_is_asked_for() {
    let problems = read("").unwrap_err();
    assert!(!problems.to_string().contains('\u{1b}'));
    assert!(problems.in_colour().contains('\u{1b}'));
}

#[test]
fn control_characters_of_a_file_do_not_reach_the_terminal() {
    let problems = read("\"\\u001b[31m\" = 1\nx = '\u{7f}'\n# \u{1b}\n").unwrap_err();
    assert!(!problems.to_string().contains('\u{1b}'));
    let problems = read("name = \"\\u001b[31m\"\nversion = \"\\u001b[31m\"").unwrap_err();
    assert!(!problems.to_string().contains('\u{1b}'), "{problems}");
}

#[test]
fn problems_are_json_with_all_they_know() {
    let problems = read(&GOOD.replace("step_mm = 5", "step = 5")).unwrap_err();
    let expected = serde_json::json!([{
        "file": "study.toml", "line": 10, "column": 1, "span": {"start": 140, "end": 144},
        "message": "unknown field `plane.step`", "hint": "lengths carry their unit: write `step_mm`",
    }]);
    assert_eq!(problems.to_json(), expected);
}

#[test]
fn a_thousand_problems_are_listed_and_a_hundred_shown() {
    let text: String = (0..5000).map(|index| format!("field_{index:05} = 1\n")).collect();
    let problems = read(&text).unwrap_err();
    assert_eq!(problems.as_slice().len(), 1000);
    assert!(
        problems
            .to_string()
            .ends_with("... and 900 more problems in this file")
    );
}

#[test]
fn nesting_that_would_exhaust_the_stack_is_refused() {
    let key = format!("{}a", "a.".repeat(78));
    let nested = format!(
        "[{key}]\n{key} = {}1{}",
        format!("{{{key} = ").repeat(79),
        "}".repeat(79)
    );
    for text in [
        nested.as_str(),
        &"a = [".repeat(10_000),
        &"[".repeat(1_000_000),
        &"a = {".repeat(100_000),
        &format!("x = {}1", "{a.a = ".repeat(40)),
    ] {
        let problems = Document::parse("a.toml", text).unwrap_err();
        assert!(
            problems.to_string().contains("nest deeper than 64 levels"),
            "{problems}"
        );
    }
    let deep = format!("a = {}{}", "[".repeat(60), "]".repeat(60));
    assert!(Document::parse("a.toml", &deep).is_ok());
    // A long file with a dot in every number is not deep.
    let wide: String = (0..10_000)
        .map(|index| format!("k{index} = [1.5, 2.5, {{ a.b = 3.5 }}]\n"))
        .collect();
    assert!(Document::parse("a.toml", &wide).is_ok());
}

#[test]
fn megabytes_of_garbage_are_refused_with_few_words() {
    for text in [
        "a = \n".repeat(400_000),
        "[a\n".repeat(400_000),
        "\"".repeat(2_000_001),
        "\u{1f600}".repeat(500_000),
        "\0".repeat(2_000_000),
    ] {
        let problems = Document::parse("a.toml", &text).unwrap_err();
        assert!(problems.as_slice().len() <= MOST_SYNTAX_PROBLEMS);
        assert!(problems.to_string().len() < 100_000);
    }
}

#[test]
fn the_schema_is_text_for_editors() {
    let schema = schema_json::<Study>();
    assert!(schema.ends_with("}\n") && schema.contains("\"step_mm\""));
    assert!(serde_json::from_str::<serde_json::Value>(&schema).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_of_a_file_makes_the_reader_panic(
        cuts in proptest::collection::vec((0..GOOD.len(), 0_usize..12, "[\\[\\]{}=.\"'#,\n\r\t a-c0-9_\u{e4}\u{1f600}\\\\+-]{0,6}"), 1..6),
    ) {
        let mut text = GOOD.to_owned();
        for (at, length, insert) in cuts {
            let from = text.floor_char_boundary(at);
            let to = text.ceil_char_boundary((from + length).min(text.len()));
            text.replace_range(from..to, &insert);
        }
        if let Err(problems) = read(&text) {
            prop_assert!(!problems.as_slice().is_empty());
            for problem in problems.as_slice() {
                let place = format!("study.toml:{}:{}", problem.line(), problem.column());
                let shown = Problems::from(problem.clone()).to_string();
                prop_assert!(shown.lines().next().is_some_and(|line| line.contains(&place)), "{}", shown);
                prop_assert!(problem.span().end <= text.len() + 1);
            }
            let _ = problems.in_colour();
        }
    }

    #[test]
    fn no_bytes_make_the_reader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        if let Err(problems) = Document::from_bytes("study.toml", &bytes).and_then(|document| document.read::<Study>()) {
            prop_assert!(!problems.to_string().is_empty());
        }
    }

    #[test]
    fn no_path_makes_the_search_panic(path in ".{0,30}") {
        let document = Document::parse("study.toml", GOOD).unwrap();
        prop_assert!(document.problem(&path, "m", None).line() >= 1);
    }
}

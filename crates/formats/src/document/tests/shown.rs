//! How problems are placed and shown.

use super::super::{Document, Problem, Problems, Source, schema_json};
use super::{GOOD, Study, read};

#[test]
fn a_problem_of_the_caller_is_at_its_value_or_the_nearest_parent() {
    let document = Document::parse("study.toml", GOOD).unwrap();
    let place = |path: &str| {
        let problem = document.problem(path, "m", Some("h"));
        (problem.line(), problem.column(), GOOD[problem.span()].to_owned())
    };
    assert_eq!(place("plane.step_mm"), (10, 11, "5".to_owned()));
    assert_eq!(place("tool.distances_mm[1]"), (15, 22, "2.0".to_owned()));
    assert_eq!(place("analysis[1].points_mm[1][2]"), (25, 32, "3".to_owned()));
    assert_eq!(place("limits_um.\"EN AW-6082\""), (4, 30, "1e2".to_owned()));
    assert_eq!(place("analysis[1].speed"), (22, 1, "[[analysis]]".to_owned()));
    assert_eq!(place("plane.inner.step_mm"), (9, 1, "[plane]".to_owned()));
    assert_eq!(place("nowhere.at.all"), (1, 1, String::new()));
    assert!(document.contains("analysis[2].step_mm") && !document.contains("analysis[3]"));
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
fn of_a_file_that_may_not_be_quoted_only_the_number_of_problems_and_the_first_place_are_reported() {
    let source = |name: &str| Source::new(name, "one\nsecret\n");
    let problems: Problems = [
        source("a.toml").problem(0..3, "about one", None),
        source("b.toml").problem(4..10, "`secret` is wrong", Some("not `secret`".to_owned())),
        source("b.toml").problem(0..3, "another", None),
        source("c.toml").problem(4..10, "`secret`", None),
        source("d.toml").problem(0..3, "about d", None),
    ]
    .into_iter()
    .collect();
    let given = problems.quoting_only(|file| file == "a.toml" || file == "d.toml");
    let lines: Vec<String> = given.as_slice().iter().map(ToString::to_string).collect();
    let expected = [
        "a.toml:1:1: about one",
        "b.toml:1:1: the file has 2 problems, the first one here",
        "c.toml:2:1: the file is not valid here",
        "d.toml:1:1: about d",
    ];
    assert_eq!(lines, expected);
    assert!(!given.to_string().contains("secret") && !given.to_json().to_string().contains("secret"));
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
fn colour_is_only_where_it_is_requested() {
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
fn of_many_problems_that_differ_in_numbers_the_first_is_shown_and_the_rest_is_counted() {
    let problem =
        |line: usize, message: &str| Problem::of_file("a.ngc", message, "do it").in_file(line, line);
    let same = (1..=100).map(|line| problem(line, "no rotary axes"));
    let angles = (201..=239).map(|line| problem(line, &format!("cut with A at -{line}.5 deg")));
    let names = (301..=304).map(|line| problem(line, &format!("unknown field `{line}`")));
    let few = (401..=403).map(|line| problem(line, "tool 7 is not known"));
    let problems: Problems = (same.chain([problem(101, "another")]).chain(angles))
        .chain(names)
        .chain(few)
        .collect();
    let shown = problems.to_string();
    let lines: Vec<&str> = shown.lines().filter(|line| line.starts_with("error: ")).collect();
    let of = |line: &str| line.split(':').nth(2).unwrap().parse::<usize>().unwrap();
    assert_eq!(
        lines.into_iter().map(of).collect::<Vec<_>>(),
        [1, 101, 201, 301, 302, 303, 304, 401, 402, 403],
        "{shown}"
    );
    let counted: Vec<&str> = shown.lines().filter(|line| line.starts_with("...")).collect();
    assert_eq!(
        counted,
        [
            "... and 99 more up to line 100: no rotary axes",
            "... and 38 more up to line 239: cut with A at ... deg",
        ]
    );
    assert!(shown.contains("cut with A at -201.5 deg"));
    assert_eq!(problems.as_slice().len(), 147);
}

#[test]
fn the_schema_is_text_for_editors() {
    let schema = schema_json::<Study>();
    assert!(schema.ends_with("}\n") && schema.contains("\"step_mm\""));
    assert!(serde_json::from_str::<serde_json::Value>(&schema).is_ok());
}

#[test]
fn characters_that_control_a_terminal_are_escaped_in_message_excerpt_and_hint_and_colours_stay() {
    let name = "a\u{9b}31m\u{202e}";
    let text = format!("{GOOD}\n\"{name}\" = 3 # \u{1b}[2J\u{7}\n")
        .replace('\u{1b}', "\u{85}")
        .replace('\u{7}', "");
    let problems = Document::parse(&format!("{name}.toml"), &text)
        .map(|document| Problems::from(document.problem("speed", format!("`{name}`\u{1b}[2J"), Some(name))))
        .unwrap();
    let plain = problems.to_string();
    assert!(
        !plain.contains(|c: char| (c.is_control() && c != '\n') || c == '\u{202e}'),
        "{plain:?}"
    );
    assert!(plain.contains("`a\\u009b31m\\u202e`\\u001b[2J"), "{plain}");
    assert!(plain.contains("= help: a\\u009b31m\\u202e"), "{plain}");
    let coloured = problems.in_colour();
    assert!(
        coloured.contains("\u{1b}[") && !coloured.contains("\u{1b}[2J"),
        "{coloured:?}"
    );
    // The caret is under the name as it is shown.
    let shown = read(&GOOD.replace("step_mm = 5", &format!("\"{name}\" = 5")))
        .unwrap_err()
        .to_string();
    let lines: Vec<&str> = shown.lines().collect();
    let marked = lines.iter().position(|line| line.contains("= 5")).unwrap();
    let width = |of: &str| lines[marked + 1].matches(of).count();
    assert_eq!(width("^"), "\"a\\u009b31m\\u202e\"".len(), "{shown}");
}

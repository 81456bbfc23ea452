//! The file that all tests read, right and with a piece replaced.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Document, Problems};

mod fields;
mod properties;
mod shown;
mod syntax;
mod values;

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
    analysis: Vec<Analysis>,
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
enum Analysis {
    /// A map of the plane.
    Map {
        tolerance_um: f64,
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

[[analysis]]
kind = "map"
tolerance_um = 20

[[analysis]]
kind = "path"
feed_mm_per_min = 300.0
points_mm = [[0, 0, 0], [1, 2, 3]]

[[analysis]]
kind = "again"
step_mm = 1.0
"#;

fn read(text: &str) -> Result<Study, Problems> {
    Document::parse("study.toml", text)?.read()
}

/// The problems of [`GOOD`] with one piece of it replaced, as `line:column: message` and hint.
fn reported(old: &str, new: &str) -> Vec<(String, Option<String>)> {
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
fn assert_problems(old: &str, new: &str, expected: &[&str]) {
    let messages: Vec<String> = reported(old, new)
        .into_iter()
        .map(|(message, _)| message)
        .collect();
    assert_eq!(messages, expected);
}

#[track_caller]
fn assert_hint(old: &str, new: &str, expected: &str) {
    let problems = reported(old, new);
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!(problems[0].1.as_deref(), Some(expected));
}

//! Which values does a text give? What a page fills fields with, and where each stands, so that a problem is shown at the
//! field that it is about.

use armill_formats::document::{Document, Problem};
use schemars::JsonSchema;
use serde::Serialize;

use super::Text;
use super::outline::outline;

/// The values of a text.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TablesAnswer {
    /// All tables and values as they stand, keys as in the schema of a study; `null` where the text is no TOML.
    #[schemars(with = "serde_json::Value")]
    pub values: serde_json::Value,
    /// Where each value stands.
    pub places: Vec<ValuePlace>,
    /// Everything that is wrong, as `armill check --json` tells it.
    pub problems: Vec<Problem>,
}

/// Where a value stands.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ValuePlace {
    /// Which: `place.x_mm`, `analysis[1].circle.radius_mm`; a list is one value, but for lists of tables.
    pub path: String,
    /// Its bytes in the text: the first, and the one behind the last.
    pub bytes: [usize; 2],
}

/// The values of this text.
pub fn tables(text: Text<'_>) -> TablesAnswer {
    let problems = outline(text).problems;
    let Ok(document) = Document::from_bytes(text.shown, text.bytes) else {
        return TablesAnswer {
            values: serde_json::Value::Null,
            places: Vec::new(),
            problems,
        };
    };
    let values = document.to_json();
    let mut paths = Vec::new();
    values_below(&values, "", &mut paths);
    let place = |path: String| {
        let bytes = document.place(&path)?;
        Some(ValuePlace {
            path,
            bytes: [bytes.start, bytes.end],
        })
    };
    TablesAnswer {
        places: paths.into_iter().filter_map(place).collect(),
        values,
        problems,
    }
}

/// The paths of all values below `value` that are no tables and no lists of tables.
fn values_below(value: &serde_json::Value, path: &str, found: &mut Vec<String>) {
    use serde_json::Value as Json;
    match value {
        Json::Object(fields) => {
            for (key, value) in fields {
                let below = match path {
                    "" => key.clone(),
                    path => format!("{path}.{key}"),
                };
                values_below(value, &below, found);
            }
        }
        Json::Array(entries) if entries.iter().any(Json::is_object) => {
            for (index, entry) in entries.iter().enumerate() {
                values_below(entry, &format!("{path}[{index}]"), found);
            }
        }
        _ => found.push(path.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::json;

    use super::*;

    fn of(text: &str) -> TablesAnswer {
        tables(Text {
            shown: "study.toml",
            folder: Path::new("."),
            bytes: text.as_bytes(),
        })
    }

    #[test]
    fn every_value_is_told_with_its_place() {
        let text = "tolerance_um = 50 # of it\n[place]\nx_mm = [900, 1100.5]\n[[analysis]]\nkind = \"path\"\ncircle.radius_mm = 60\n";
        let given = of(text);
        assert_eq!(given.values["place"]["x_mm"], json!([900, 1100.5]));
        let place = |path: &str| {
            let found = given.places.iter().find(|place| place.path == path).unwrap();
            &text[found.bytes[0]..found.bytes[1]]
        };
        assert_eq!(
            (
                place("tolerance_um"),
                place("place.x_mm"),
                place("analysis[0].circle.radius_mm")
            ),
            ("50", "[900, 1100.5]", "60")
        );
        // The study lacks its robot.
        assert!(
            given.problems
                .iter()
                .any(|problem| problem.message().contains("robot"))
        );
    }

    #[test]
    fn a_text_that_is_no_toml_has_problems_alone() {
        let given = of("tolerance_um = = 3");
        assert!(given.values.is_null() && given.places.is_empty());
        assert_eq!(given.problems.len(), 1);
    }
}

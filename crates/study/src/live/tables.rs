//! The values of a text, to fill the fields of a page, each with its position, so that a problem is shown at
//! its field.

use armill_formats::document::{Document, Problem};
use schemars::JsonSchema;
use serde::Serialize;

use crate::live::StudyText;
use crate::live::outline::outline;

/// The values of a text.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TablesAnswer {
    /// All tables and values as written, keys as in the schema of a study; `null` if the text is not valid TOML.
    #[schemars(with = "serde_json::Value")]
    pub values: serde_json::Value,
    /// The position of each value.
    pub places: Vec<ValueLocation>,
    /// All problems, as in `armill check --json`.
    pub problems: Vec<Problem>,
}

/// The position of a value in the text.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ValueLocation {
    /// Its key: `place.x_mm`, `analysis[1].circle.radius_mm`; a list is one value, except for lists of tables.
    pub path: String,
    /// Its range of bytes in the text, the end excluded.
    pub bytes: [usize; 2],
}

/// The values of this text.
pub fn tables(text: StudyText<'_>) -> TablesAnswer {
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
        Some(ValueLocation {
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

/// The paths of all values below `value` that are neither tables nor lists of tables.
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
        tables(StudyText {
            shown: "study.toml",
            folder: Path::new("."),
            bytes: text.as_bytes(),
        })
    }

    #[test]
    fn every_value_is_reported_with_its_position() {
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
            given
                .problems
                .iter()
                .any(|problem| problem.message().contains("robot"))
        );
    }

    #[test]
    fn an_invalid_text_has_problems_alone() {
        let given = of("tolerance_um = = 3");
        assert!(given.values.is_null() && given.places.is_empty());
        assert_eq!(given.problems.len(), 1);
    }
}

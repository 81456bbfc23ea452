//! A TOML text with some of its values changed: comments, order and blanks stay as the user wrote them.
//!
//! ```
//! use armill_formats::document::edit::{Change, changed};
//!
//! let text = "[plane] # the table of the mill\nstep_mm = 5 # coarse\n";
//! let change = Change { path: "plane.step_mm".to_owned(), value: 2.5.into() };
//! let finer = changed("study.toml", text, &[change])?;
//! assert_eq!(finer, "[plane] # the table of the mill\nstep_mm = 2.5 # coarse\n");
//! # Ok::<(), armill_formats::document::Problems>(())
//! ```

use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, Value};

use super::path::{Step, steps};
use super::{Document, Problem, Problems, entries};

/// One value that is to be another.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Which, as [`Document::problem`] takes it: `plane.centre_mm`, `analysis[1].plane.step_mm`.
    pub path: String,
    /// What it is to be; `null` takes it away. The entry behind the last of a list is a new one.
    pub value: serde_json::Value,
}

/// The text with these changes, one after the other. Missing tables and lists are created; empty lists and tables on
/// one line are removed afterwards.
///
/// Whether the result is valid is not checked here; reading it reports that.
///
/// # Errors
/// A text that is not TOML, or would no longer be; every change that cannot be made: a missing entry of a list, a key
/// inside a value that is not a table, a value that TOML cannot represent.
pub fn changed(name: &str, text: &str, changes: &[Change]) -> Result<String, Problems> {
    let checked = Document::parse(name, text)?;
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        Problems::from(vec![checked.problem("", error.message(), None)])
    })?;
    let mut refused: Vec<Problem> = Vec::new();
    for Change { path, value } in changes {
        let steps = steps(path);
        let made = match value {
            serde_json::Value::Null => {
                let others = entries::others(document.as_item(), &steps);
                let removed = remove(document.as_item_mut(), &steps);
                if let (Ok(()), Some(others)) = (&removed, others) {
                    entries::put_back(&mut document, &others);
                }
                removed
            }
            value => toml_value(value).and_then(|value| set(document.as_item_mut(), &steps, value)),
        };
        entries::settle(&mut document);
        if let Err(reason) = made {
            refused.push(checked.problem(path, format!("`{path}` cannot be changed: {reason}"), None));
        }
    }
    Problems::from(refused).into_result()?;
    let new = document.to_string();
    // A path that is deeper than the parser allows makes a text that cannot be read.
    Document::parse(name, &new)?;
    Ok(new)
}

/// The value of TOML that says the same.
fn toml_value(value: &serde_json::Value) -> Result<Value, String> {
    use serde_json::Value as Json;
    Ok(match value {
        Json::Null => return Err("TOML has no null inside a value".to_owned()),
        Json::Bool(flag) => Value::from(*flag),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Value::from(whole),
            None => {
                let real = number.as_f64().filter(|real| real.is_finite());
                Value::from(real.ok_or_else(|| format!("{number} cannot be represented in TOML"))?)
            }
        },
        Json::String(text) => Value::from(text.as_str()),
        Json::Array(entries) => {
            let entries: Result<Array, String> = entries.iter().map(toml_value).collect();
            Value::from(entries?)
        }
        Json::Object(fields) => {
            let field = |(key, value): (&String, &Json)| Ok((key.clone(), toml_value(value)?));
            let table: Result<InlineTable, String> = fields.iter().map(field).collect();
            Value::from(table?)
        }
    })
}

/// Sets the value at these steps below `here`.
fn set(here: &mut Item, steps: &[Step], value: Value) -> Result<(), String> {
    let Some((first, rest)) = steps.split_first() else {
        return replace(here, value);
    };
    let next = match first {
        Step::Entry(index) if rest.is_empty() && entries::count(here) == Some(*index) => {
            return entries::append(here, value);
        }
        Step::Entry(index) => here.get_mut(*index).ok_or(format!("there is no entry {index}"))?,
        Step::Key(key) => {
            // Below the root a table gets its header, inside of others it is on a line of theirs.
            let at_root = here.as_table().is_some_and(|table| table.position().is_none());
            let table = here
                .as_table_like_mut()
                .ok_or("it is inside a value that is not a table")?;
            table.entry(key).or_insert_with(|| match rest {
                [] => Item::Value(Value::from(false)),
                [Step::Entry(_)] if at_root && value.is_inline_table() => {
                    Item::ArrayOfTables(ArrayOfTables::new())
                }
                [Step::Entry(_)] => Item::Value(Value::Array(Array::new())),
                _ if at_root => Item::Table(Table::new()),
                _ => Item::Value(Value::InlineTable(InlineTable::new())),
            })
        }
    };
    set(next, rest, value)
}

/// Replaces this value by `value`; the text around it stays.
fn replace(here: &mut Item, mut value: Value) -> Result<(), String> {
    match here {
        Item::Value(old) => {
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        Item::None => *here = Item::Value(value),
        Item::Table(_) | Item::ArrayOfTables(_) => return Err("it is a table".to_owned()),
    }
    Ok(())
}

/// Removes the value at these steps, and a list or a table on a line that is then empty; a missing value is not an
/// error.
fn remove(here: &mut Item, steps: &[Step]) -> Result<(), String> {
    match steps {
        [] => Err("it is the whole file".to_owned()),
        [Step::Key(key)] => {
            let table = here
                .as_table_like_mut()
                .ok_or("it is inside a value that is not a table")?;
            table.remove(key);
            Ok(())
        }
        [Step::Entry(index)] => entries::take(here, *index),
        [first, rest @ ..] => {
            let next = match first {
                Step::Key(key) => here.get_mut(key.as_str()),
                Step::Entry(index) => here.get_mut(*index),
            };
            let Some(next) = next.filter(|next| !next.is_none()) else {
                return Ok(());
            };
            remove(next, rest)?;
            let emptied = next.as_inline_table().is_some_and(InlineTable::is_empty)
                || matches!(rest, [Step::Entry(_)]) && entries::count(next) == Some(0);
            match (first, here.as_table_like_mut()) {
                (Step::Key(key), Some(table)) if emptied => drop(table.remove(key)),
                _ => (),
            }
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::{Value as Json, json};

    use super::*;

    const STUDY: &str = "# my cell\ntolerance_um = 100 # of the drawing\n\n[plane]\n# measured on Monday\ncentre_mm = [1000, 0, 500] # mm\nstep_mm = 5\n\n[[analysis]]\nkind = \"map\"\n\n[[analysis]]\nkind = \"path\" # the rim\nplane = { tilt_deg = 90 }\n";

    fn with(path: &str, value: Json) -> Result<String, Problems> {
        let change = Change {
            path: path.to_owned(),
            value,
        };
        changed("study.toml", STUDY, &[change])
    }

    #[test]
    fn a_value_changes_and_nothing_else_does() {
        let moved = with("plane.centre_mm", json!([900, 0.5, 500])).unwrap();
        assert_eq!(moved, STUDY.replace("[1000, 0, 500]", "[900, 0.5, 500]"));
        let tighter = with("tolerance_um", json!(42.5)).unwrap();
        assert_eq!(tighter, STUDY.replace("100 #", "42.5 #"));
        let tilted = with("analysis[1].plane.tilt_deg", json!(45)).unwrap();
        assert_eq!(tilted, STUDY.replace("tilt_deg = 90", "tilt_deg = 45"));
        let entry = with("plane.centre_mm[2]", json!(600)).unwrap();
        assert_eq!(entry, STUDY.replace("0, 500]", "0, 600]"));
    }

    #[test]
    fn missing_values_are_created_at_their_place() {
        let finer = with("analysis[0].plane.step_mm", json!(2)).unwrap();
        assert!(
            finer.contains("kind = \"map\"\nplane = { step_mm = 2 }\n"),
            "{finer}"
        );
        let posture = with("posture.branch", json!("front")).unwrap();
        assert!(posture.contains("[posture]\nbranch = \"front\"\n"), "{posture}");
        let based = with("base", json!("controller")).unwrap();
        assert!(
            based.contains("of the drawing\nbase = \"controller\"\n"),
            "{based}"
        );
        for text in [finer, posture, based] {
            assert!(Document::parse("", &text).is_ok(), "{text}");
        }
    }

    #[test]
    fn null_removes_a_value_and_the_empty_table_around_it() {
        let upright = with("analysis[1].plane.tilt_deg", Json::Null).unwrap();
        assert_eq!(upright, STUDY.replace("plane = { tilt_deg = 90 }\n", ""));
        assert_eq!(with("analysis[0].load.cases_n", Json::Null).unwrap(), STUDY);
    }

    #[test]
    fn a_new_entry_is_added_after_the_last_and_takes_no_comment_of_others() {
        let new = with("analysis[2]", json!({"kind": "map", "name": ""})).unwrap();
        assert_eq!(
            new,
            format!("{STUDY}\n[[analysis]]\nkind = \"map\"\nname = \"\"\n")
        );
        let first = with("ballbar[0]", json!({"files": []})).unwrap();
        assert_eq!(first, format!("{STUDY}\n[[ballbar]]\nfiles = []\n"));
        // Comments below the last analysis stay with it; comments on the next table or the file stay there.
        let text = "[[analysis]]\nkind = \"map\"\n[analysis.plane] # its own\nstep_mm = 5\n# a remark on it\n\n# the place\n[place]\nx_mm = [1, 2]\n# the end\n";
        let more = to(text, "analysis[1]", json!({"kind": "path"}));
        assert_eq!(
            more,
            text.replace("\n# the place", "\n[[analysis]]\nkind = \"path\"\n\n# the place")
        );
        let text = "tolerance_um = 1\n# of the drawing";
        let one = to(text, "analysis[0]", json!({"kind": "map"}));
        assert_eq!(one, format!("{text}\n\n[[analysis]]\nkind = \"map\"\n"));
        let close = "[[analysis]]\nkind = \"map\"\n# the place\n[place]\n";
        let close = to(close, "analysis[1]", json!({"kind": "path"}));
        assert_eq!(
            close,
            "[[analysis]]\nkind = \"map\"\n\n[[analysis]]\nkind = \"path\"\n# the place\n[place]\n"
        );
    }

    #[test]
    fn an_entry_is_removed_with_its_comments_only() {
        let text = "tolerance_um = 1\n\n# ---- analyses ----\n\n# the first\n[[analysis]] # here\nkind = \"map\"\n[analysis.plane]\nstep_mm = 5\n\n# the rim\n[[analysis]]\nkind = \"path\" # round\n# a remark on the rim\n\n# where it may be\n[place]\nx_mm = [1, 2]\n";
        let without_first = to(text, "analysis[0]", Json::Null);
        assert_eq!(
            without_first,
            text.replace(
                "\n# the first\n[[analysis]] # here\nkind = \"map\"\n[analysis.plane]\nstep_mm = 5\n",
                ""
            )
        );
        let without_rim = to(text, "analysis[1]", Json::Null);
        assert!(without_rim.contains("step_mm = 5\n# a remark on the rim\n\n# where it may be\n[place]"));
        assert!(!without_rim.contains("round") && !without_rim.contains("# the rim"));
        let none = to(&without_rim, "analysis[0]", Json::Null);
        assert!(
            none.starts_with("tolerance_um = 1\n\n# ---- analyses ----\n") && !none.contains("analysis]"),
            "{none}"
        );
        // Nothing is there, so nothing goes.
        assert_eq!(to(text, "analysis[2]", Json::Null), text);
    }

    #[test]
    fn entries_of_lists_inside_of_tables_are_added_and_removed_with_their_lines() {
        let text = "[[analysis]]\nprogram = { file = \"a.ngc\", feature = [\n  { name = \"bore\" }, # the bore\n  # the rim, too\n  { name = \"rim\" } # last\n] }\n";
        let longer = to(text, "analysis[0].program.feature[2]", json!({"name": "slot"}));
        assert_eq!(
            longer,
            text.replace(
                "{ name = \"rim\" } # last\n]",
                "{ name = \"rim\" }, # last\n  { name = \"slot\" },\n]"
            )
        );
        let rim = to(text, "analysis[0].program.feature[0]", Json::Null);
        assert_eq!(rim, text.replace("\n  { name = \"bore\" }, # the bore", ""));
        let bore = to(text, "analysis[0].program.feature[1]", Json::Null);
        assert_eq!(
            bore,
            text.replace(
                "{ name = \"bore\" }, # the bore\n  # the rim, too\n  { name = \"rim\" } # last",
                "{ name = \"bore\" } # the bore"
            )
        );
        let none = to(&bore, "analysis[0].program.feature[0]", Json::Null);
        assert_eq!(none, "[[analysis]]\nprogram = { file = \"a.ngc\"}\n");
        let spring = to(
            "[tool] # steel\nlength_mm = 5\n",
            "tool.spring[0]",
            json!({"at": "tool"}),
        );
        assert_eq!(
            spring,
            "[tool] # steel\nlength_mm = 5\nspring = [{ at = \"tool\" }]\n"
        );
        let nested = "[tool]\n[[tool.spring]] # soft\nat = \"tool\"\n[plane]\n";
        let second = to(nested, "tool.spring[1]", json!({"at": "base"}));
        assert_eq!(
            second,
            nested.replace("[plane]", "\n[[tool.spring]]\nat = \"base\"\n[plane]")
        );
    }

    /// This text with one change, which is TOML still.
    fn to(text: &str, path: &str, value: Json) -> String {
        let change = Change {
            path: path.to_owned(),
            value,
        };
        let new = changed("study.toml", text, &[change]).unwrap();
        assert!(Document::parse("", &new).is_ok(), "{new}");
        new
    }

    #[test]
    fn a_path_deeper_than_tables_may_be_is_refused() {
        for path in ["a.".repeat(90) + "a", "analysis[0".to_owned() + &"[".repeat(90)] {
            assert!(with(&path, json!("x")).is_err(), "{path}");
        }
        assert!(with("a.b.c.d.e", json!("x")).is_ok());
    }

    #[test]
    fn refused_changes_are_reported_with_their_place() {
        let change = |path: &str, value: Json| Change {
            path: path.to_owned(),
            value,
        };
        let changes = [
            change("analysis[7].tolerance_um", json!(1)),
            change("plane", json!(1)),
            change("tolerance_um.deeper", json!(1)),
            change("tolerance_um[0]", json!(1)),
            change("analysis[2]", json!(1)),
            change("plane.step_mm", json!([null])),
            change("", Json::Null),
        ];
        let problems = changed("study.toml", STUDY, &changes).unwrap_err();
        assert_eq!(problems.as_slice().len(), changes.len());
        let lines: Vec<usize> = problems.as_slice().iter().map(Problem::line).collect();
        assert!(lines.contains(&2) && lines.contains(&7), "{lines:?}");
    }

    proptest! {
        #[test]
        fn no_change_panics_and_the_result_is_toml(
            path in "[a-z_.\\[\\]\"0-9]{0,12}|(plane|analysis\\[[0-3]\\])(\\.[a-z]{1,4}){0,3}(\\[[01]\\])?",
            number in proptest::num::f64::ANY,
        ) {
            for value in [json!(number), json!({"a": [number, "x"]}), Json::Null] {
                if let Ok(text) = with(&path, value) {
                    prop_assert!(Document::parse("", &text).is_ok(), "{path}: {text}");
                }
            }
        }
    }
}

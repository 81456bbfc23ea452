//! A study file changed as text: comments, order and numbers that are not changed stay as they are.
//!
//! An analysis is a table of `[[analysis]]` or of an array `analysis = [{ .. }]`; tables in it may be dotted keys,
//! inline tables or tables of their own.

use std::path::{Path, PathBuf};

use armill_study::error::StudyError;
use armill_study::studies::FoundStudy;
use serde_json::Value as Json;
use toml_edit::visit_mut::{VisitMut, visit_value_mut};
use toml_edit::{Array, DocumentMut, InlineTable, Item, TableLike, Value};

/// The study as a document.
pub(crate) struct StudyText {
    document: DocumentMut,
}

impl StudyText {
    /// Of a study that was read before.
    ///
    /// # Errors
    /// A file that is not TOML.
    pub fn of(found: &FoundStudy) -> Result<StudyText, StudyError> {
        let text = String::from_utf8_lossy(&found.bytes);
        let document = text
            .parse::<DocumentMut>()
            .map_err(|error| StudyError::value(format!("{}: {error}", found.shown), "see `armill check`"))?;
        Ok(StudyText { document })
    }

    /// The text as a study in place of `found`.
    pub fn in_place_of(&self, found: &FoundStudy) -> FoundStudy {
        FoundStudy {
            bytes: self.document.to_string().into_bytes(),
            ..found.clone()
        }
    }

    /// The text.
    pub fn text(&self) -> String {
        self.document.to_string()
    }

    /// Sets a value of analysis `index`, below the tables `keys`; `None` removes it. An analysis that is not there is
    /// not changed.
    pub fn set(&mut self, index: usize, keys: &[&str], value: Option<Value>) {
        let Some((last, tables)) = keys.split_last() else {
            return;
        };
        let Some(mut table) = self.analysis(index) else {
            return;
        };
        for key in tables {
            if value.is_none() && table.get(key).is_none() {
                return;
            }
            let inside = table.entry(key).or_insert(Item::Value(InlineTable::new().into()));
            let Some(inside) = inside.as_table_like_mut() else {
                return;
            };
            table = inside;
        }
        match value {
            Some(value) => {
                table.insert(last, Item::Value(value));
            }
            None => {
                table.remove(last);
            }
        }
    }

    /// A number of analysis `index`, below the tables `keys`.
    pub fn number(&mut self, index: usize, keys: &[&str]) -> Option<f64> {
        let (last, tables) = keys.split_last()?;
        let mut table = self.analysis(index)?;
        for key in tables {
            table = table.get_mut(key)?.as_table_like_mut()?;
        }
        let item = table.get(last)?;
        item.as_float()
            .or_else(|| item.as_integer().map(|whole| whole as f64))
    }

    /// Whether analysis `index` has a value below the tables `keys`.
    pub fn has(&mut self, index: usize, keys: &[&str]) -> bool {
        let Some(mut table) = self.analysis(index) else {
            return false;
        };
        let Some((last, tables)) = keys.split_last() else {
            return false;
        };
        for key in tables {
            match table.get_mut(key).and_then(Item::as_table_like_mut) {
                Some(inside) => table = inside,
                None => return false,
            }
        }
        table.contains_key(last)
    }

    /// Removes all analyses but one, and the statements, which may refer to them.
    pub fn keep_only(&mut self, index: usize) {
        self.document.remove("statement");
        match self.document.get_mut("analysis") {
            Some(Item::ArrayOfTables(all)) => {
                for other in (0..all.len()).rev().filter(|other| *other != index) {
                    all.remove(other);
                }
            }
            Some(Item::Value(Value::Array(all))) => {
                for other in (0..all.len()).rev().filter(|other| *other != index) {
                    all.remove(other);
                }
            }
            _ => (),
        }
    }

    /// Makes every text that names a file relative to `from` name it relative to the folder `to`.
    pub fn move_files(&mut self, from: &Path, to: &Path) {
        let mut moved = MovedFiles {
            from: from.to_owned(),
            to: to.to_owned(),
        };
        moved.visit_document_mut(&mut self.document);
    }

    fn analysis(&mut self, index: usize) -> Option<&mut dyn TableLike> {
        match self.document.get_mut("analysis")? {
            Item::ArrayOfTables(all) => all.get_mut(index).map(|table| table as &mut dyn TableLike),
            Item::Value(Value::Array(all)) => {
                let table = all.get_mut(index)?.as_inline_table_mut()?;
                Some(table as &mut dyn TableLike)
            }
            _ => None,
        }
    }
}

/// A number, a word or a list of them as TOML; none of `null`.
pub(crate) fn toml_of(value: &Json) -> Option<Value> {
    match value {
        Json::Number(number) => Some(number.as_f64()?.into()),
        Json::String(word) => Some(word.as_str().into()),
        Json::Array(all) => Some(all.iter().filter_map(toml_of).collect::<Array>().into()),
        Json::Null | Json::Bool(_) | Json::Object(_) => None,
    }
}

/// Changes relative names of files.
struct MovedFiles {
    from: PathBuf,
    to: PathBuf,
}

impl VisitMut for MovedFiles {
    fn visit_value_mut(&mut self, value: &mut Value) {
        if let Value::String(text) = value {
            let name = Path::new(text.value());
            let there = self.from.join(name);
            if name.is_relative() && there.is_file() {
                let renamed = relative(&there, &self.to);
                *value = Value::from(renamed.to_string_lossy().replace('\\', "/"));
            }
            return;
        }
        visit_value_mut(self, value);
    }
}

/// `file` relative to `folder`, if the folder is next to it; otherwise its absolute path.
fn relative(file: &Path, folder: &Path) -> PathBuf {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (file, folder) = (whole(file), whole(folder));
    let beside = folder.parent().and_then(|parent| file.strip_prefix(parent).ok());
    beside.map_or_else(|| file.clone(), |name| Path::new("..").join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# Mine.\nformat = 1\n[[analysis]]\nname = \"a\"\nprogram = { file = \"a.ngc\" } # the part\n[[analysis]]\nname = \"b\"\nplane.tilt_deg = 3\n";

    fn study(text: &str, folder: &Path) -> FoundStudy {
        FoundStudy {
            shown: "study.toml".to_owned(),
            folder: folder.to_owned(),
            bytes: text.as_bytes().to_vec(),
        }
    }

    #[test]
    fn values_are_set_in_tables_of_every_form() {
        let found = study(TEXT, Path::new("."));
        let mut text = StudyText::of(&found).unwrap();
        text.set(0, &["program", "spin_deg"], Some(5.0.into()));
        text.set(
            0,
            &["plane", "centre_mm"],
            toml_of(&serde_json::json!([1.0, 2.0, 3.0])),
        );
        text.set(1, &["plane", "tilt_deg"], None);
        text.set(
            1,
            &["plane", "rotation_deg"],
            toml_of(&serde_json::json!([0.0, 0.0, 0.0])),
        );
        assert_eq!(text.number(0, &["program", "spin_deg"]), Some(5.0));
        assert!(text.has(1, &["plane", "rotation_deg"]) && !text.has(1, &["plane", "tilt_deg"]));
        let written = text.text();
        assert!(
            written.starts_with("# Mine.\n") && written.contains("# the part"),
            "{written}"
        );
        assert!(
            written.contains("plane = { centre_mm = [1.0, 2.0, 3.0] }"),
            "{written}"
        );
        let inline = study(
            "analysis = [{ name = \"a\" }, { name = \"b\" }]\n",
            Path::new("."),
        );
        let mut text = StudyText::of(&inline).unwrap();
        text.set(1, &["spin_deg"], Some(2.0.into()));
        text.keep_only(1);
        let without_spaces = text.text().replace(' ', "");
        assert_eq!(without_spaces, "analysis=[{name=\"b\",spin_deg=2.0}]\n");
    }

    #[test]
    fn only_one_analysis_is_kept() {
        let mut text = StudyText::of(&study(TEXT, Path::new("."))).unwrap();
        text.keep_only(1);
        let written = text.text();
        assert!(
            written.contains("\"b\"") && !written.contains("\"a\""),
            "{written}"
        );
    }

    #[test]
    fn files_keep_their_place_from_another_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.ngc"), "").unwrap();
        let mut text = StudyText::of(&study(TEXT, folder.path())).unwrap();
        text.move_files(folder.path(), &folder.path().join("advised"));
        assert!(text.text().contains("file = \"../a.ngc\""), "{}", text.text());
        assert!(text.text().contains("name = \"b\""));
        let mut text = StudyText::of(&study(TEXT, folder.path())).unwrap();
        let elsewhere = tempfile::tempdir().unwrap();
        text.move_files(folder.path(), &elsewhere.path().join("advised"));
        let absolute = folder.path().join("a.ngc");
        assert!(
            text.text().contains(&*absolute.to_string_lossy()),
            "{}",
            text.text()
        );
    }
}

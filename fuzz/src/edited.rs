//! Requirements on a text that is changed by a program, and on the shapes that a URDF names.

use armill_core::nalgebra::Vector3;
use armill_formats::document::Document;
use armill_formats::document::edit::{Change, changed};
use armill_formats::robot::urdf::meshes as shapes;

use crate::verdicts::refused;

/// A value of a text that is changed: the path on the first line, the value as JSON on the second, the text after that.
/// A value that is not JSON is inserted as text. The result is TOML, has the value there, and is not changed by the
/// same change again; except that a new entry of a list can be removed again.
pub fn edit(bytes: &[u8]) {
    let input = String::from_utf8_lossy(bytes);
    let mut lines = input.splitn(3, '\n');
    let path = lines.next().unwrap_or_default().to_owned();
    let value = lines.next().unwrap_or_default();
    let value = serde_json::from_str(value).unwrap_or_else(|_| serde_json::Value::from(value));
    let text = lines.next().unwrap_or_default();
    let change = Change { path, value };
    match changed("study.toml", text, std::slice::from_ref(&change)) {
        Err(problems) => refused(&problems),
        Ok(new) => {
            let read = Document::parse("study.toml", &new);
            assert!(read.is_ok_and(|read| change.value.is_null() || read.contains(&change.path)));
            let before = Document::parse("study.toml", text);
            let had = before.is_ok_and(|before| before.contains(&change.path));
            match (had, change.value.is_null()) {
                // The entry behind it has its place now.
                (true, true) if change.path.ends_with(']') => return,
                // A new entry goes again.
                (false, false) if change.path.ends_with(']') => {
                    let path = change.path.clone();
                    let gone = changed(
                        "study.toml",
                        &new,
                        &[Change {
                            path,
                            value: serde_json::Value::Null,
                        }],
                    );
                    let gone = gone
                        .ok()
                        .and_then(|gone| Document::parse("study.toml", &gone).ok());
                    assert!(gone.is_some_and(|gone| !gone.contains(&change.path)));
                    return;
                }
                _ => (),
            }
            let again = changed("study.toml", &new, std::slice::from_ref(&change));
            assert_eq!(again.ok().as_deref(), Some(new.as_str()));
        }
    }
}

/// The meshes of a URDF.
pub fn meshes(bytes: &[u8]) {
    match shapes::meshes("arm.urdf", &String::from_utf8_lossy(bytes)) {
        Err(problems) => refused(&problems),
        Ok(found) => {
            for mesh in found {
                let at = mesh.base_from_mesh(|_| Some(0.1));
                assert!(
                    (at * Vector3::new(1.0, 2.0, 3.0))
                        .iter()
                        .all(|value| value.is_finite())
                );
                assert!(mesh.scale.iter().all(|factor| factor.is_finite()));
            }
        }
    }
}

//! A robot file with backlash that was measured in place of its own.

use armill_core::units::{to_deg, to_mm};
use toml_edit::{DocumentMut, Item, Table, value};

use super::identified::set_sources;
use crate::document::{Document, Problems};

/// Key of the source.
const KEY: &str = "backlash_measured";
/// Digits kept behind the point of deg and mm.
const PLACES: i32 = 9;

/// Backlash of joints that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredBacklash {
    /// The joints.
    pub joints: Vec<JointBacklash>,
    /// The measurements, for people.
    pub what: String,
    /// Where they are kept.
    pub place: String,
}

/// Backlash of one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointBacklash {
    /// Name of the joint.
    pub joint: String,
    /// Whether it turns.
    pub turns: bool,
    /// The whole backlash, rad or m.
    pub gap: f64,
    /// Its standard uncertainty.
    pub standard_uncertainty: f64,
}

/// The robot file `text` (at `path`) with the backlash of these joints; what decides on its side stays as it was.
///
/// The resulting file has been read once more, so that `read` accepts it.
///
/// # Errors
/// A text that is not TOML, or no robot file once the backlash is in it.
pub fn with_backlash(path: &str, text: &str, measured: &MeasuredBacklash) -> Result<String, Problems> {
    let checked = Document::parse(path, text)?;
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error: toml_edit::TomlError| Problems::from(checked.problem("", error.message(), None)))?;
    if let Some(joint) = document.get_mut("joint")
        && let Ok(mut joints) = std::mem::take(joint).into_array_of_tables()
    {
        for table in joints.iter_mut() {
            let name = table.get("name").and_then(Item::as_str).unwrap_or_default();
            if let Some(found) = measured.joints.iter().find(|found| found.joint == name) {
                set(table, found);
            }
        }
        *joint = Item::ArrayOfTables(joints);
    }
    set_sources(&mut document, KEY, [&measured.what, &measured.place])?;
    let text = document.to_string();
    super::read(&format!("{path} (backlash)"), "", &text)?;
    Ok(text)
}

fn set(table: &mut Table, found: &JointBacklash) {
    for key in ["backlash_deg", "backlash_u_deg", "backlash_mm", "backlash_u_mm"] {
        table.remove(key);
    }
    let scale = 10f64.powi(PLACES);
    let rounded = |number: f64| (number * scale).round() / scale;
    let [(gap_key, gap), (u_key, u)] = match found.turns {
        true => [
            ("backlash_deg", to_deg(found.gap)),
            ("backlash_u_deg", to_deg(found.standard_uncertainty)),
        ],
        false => [
            ("backlash_mm", to_mm(found.gap)),
            ("backlash_u_mm", to_mm(found.standard_uncertainty)),
        ],
    };
    table.insert(gap_key, value(rounded(gap)));
    table.insert(u_key, value(rounded(u)));
    table.insert("backlash_source", value(KEY));
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "format = 1\nname = \"lever\"\n\n[chain]\nsource = \"drawing\"\nmotions = [\n  { about = \"z\", joint = \"A\" },\n  \
        { along = \"x\", joint = \"B\" },\n]\n\n[[joint]]\nname = \"A\"\nsign = 1\nbacklash_deg = 0.5\nbacklash_side = \"torque\"\nbacklash_source = \"old\"\n\
        source = \"drawing\"\n\n[[joint]]\nname = \"B\"\nsign = 1\nsource = \"drawing\"\n\n[sources.drawing]\nwhat = \"lengths\"\nwhere = \"here\"\n\
        licence = \"ours\"\n\n[sources.old]\nwhat = \"backlash\"\nwhere = \"there\"\nlicence = \"ours\"\n";

    fn measured(joint: &str, turns: bool) -> MeasuredBacklash {
        MeasuredBacklash {
            joints: vec![JointBacklash {
                joint: joint.to_owned(),
                turns,
                gap: 2e-4,
                standard_uncertainty: 3e-5,
            }],
            what: "backlash of two measurements".to_owned(),
            place: "journal.toml".to_owned(),
        }
    }

    #[test]
    fn backlash_is_replaced_and_read_again() {
        for (joint, turns, index) in [("A", true, 0), ("B", false, 1)] {
            let text = with_backlash("lever.toml", FILE, &measured(joint, turns)).unwrap();
            let robot = super::super::read("lever.toml", "", &text).unwrap().robot;
            let (_, found) = robot
                .structure()
                .joints_with_backlash()
                .find(|(of, _)| *of == index)
                .unwrap();
            assert!((found.gap - 2e-4).abs() < 1e-10 && (found.standard_uncertainty - 3e-5).abs() < 1e-10);
            // The source that no number names any more is gone; the side stays.
            assert_eq!(text.contains("[sources.old]"), joint == "B");
            assert!(text.contains("backlash_side = \"torque\""));
        }
        assert!(with_backlash("lever.toml", "a = ", &measured("A", true)).is_err());
    }
}

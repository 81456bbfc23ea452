//! A robot file with the small motions that a calibration found in its chain.
//!
//! They are directly behind the joint that they follow, marked `calibrated`; all else is unchanged. The source of the
//! chain becomes one that names both: the source of the nominal lengths and the source of the small motions.

use armill_core::robot::{Amount, Axis, Motion};
use armill_core::units::{to_deg, to_mm};
use toml_edit::{Array, DocumentMut, InlineTable, Item, Value, value};

use super::geometry_covariance_table::GeometryCovarianceTable;
use super::identified::set_sources;
use crate::document::{Document, Problems};

/// What was calibrated of an arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// The name of a joint, and the motions that follow it.
    pub after: Vec<(String, Vec<Motion>)>,
    /// The poses they come from, for people.
    pub what: String,
    /// Where these poses are kept.
    pub place: String,
    /// How uncertain the chain with these motions is.
    pub covariance: Option<GeometryCovarianceTable>,
}

/// Key of the source, and mark of each motion.
pub(in crate::robot) const KEY: &str = "calibrated";
/// Digits kept behind the point of mm and deg: a millionth of what a tracker sees.
const PLACES: usize = 8;

/// The robot file `text` (at `path`) with these small motions in its chain.
///
/// The resulting file has been read once more, so that `read` accepts it.
///
/// # Errors
/// A text that is not TOML, or no robot file once the motions are in it.
pub fn with_geometry(path: &str, text: &str, geometry: &Geometry) -> Result<String, Problems> {
    let checked = Document::parse(path, text)?;
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error: toml_edit::TomlError| Problems::from(checked.problem("", error.message(), None)))?;
    let nominal = nominal_source(&document);
    if let Some(motions) = document
        .get_mut("chain")
        .and_then(|chain| chain.get_mut("motions"))
    {
        // `[[chain.motions]]` is the same as a list.
        match std::mem::take(motions).into_value() {
            Ok(Value::Array(list)) => *motions = value(with_motions(list, geometry)),
            Ok(other) => *motions = Item::Value(other),
            Err(item) => *motions = item,
        }
    }
    if let Some(source) = document
        .get_mut("chain")
        .and_then(|chain| chain.get_mut("source"))
    {
        *source = value(KEY);
    }
    let what = match nominal {
        Some(nominal) => format!("{nominal}; {}", geometry.what),
        None => geometry.what.clone(),
    };
    set_sources(&mut document, KEY, [&what, &geometry.place])?;
    // That of an earlier calibration is not true of this chain.
    document.remove("geometry_covariance");
    if let Some(covariance) = &geometry.covariance {
        document.insert("geometry_covariance", covariance.item());
    }
    let text = document.to_string();
    super::read(&format!("{path} (calibrated)"), "", &text)?;
    Ok(text)
}

/// What the file says of the source of its lengths.
fn nominal_source(document: &DocumentMut) -> Option<String> {
    let key = document.get("chain")?.get("source")?.as_str()?;
    let source = document.get("sources")?.get(key)?;
    let given = |field| source.get(field).and_then(Item::as_str);
    match key {
        // Calibrated again: the previous source names the nominal lengths too.
        KEY => given("what").map(str::to_owned),
        _ => Some(format!(
            "lengths and angles: {} ({})",
            given("what")?,
            given("where")?
        )),
    }
}

/// The list with the small motions behind their joints.
fn with_motions(list: Array, geometry: &Geometry) -> Array {
    let mut motions = Array::new();
    for motion in list {
        let joint = motion.as_inline_table().and_then(|table| table.get("joint"));
        let joint = joint.and_then(Value::as_str).map(str::to_owned);
        motions.push_formatted(motion);
        let here = geometry
            .after
            .iter()
            .filter(|(name, _)| Some(name) == joint.as_ref());
        for small in here.flat_map(|(_, motions)| motions) {
            let mut entry = Value::InlineTable(table(small));
            entry.decor_mut().set_prefix("\n  ");
            motions.push_formatted(entry);
        }
    }
    motions.set_trailing("\n");
    motions.set_trailing_comma(true);
    motions
}

fn table(motion: &Motion) -> InlineTable {
    let constant = |amount| match amount {
        Amount::Constant(by) => by,
        Amount::Joint(_) => 0.0,
    };
    let (word, axis, field, by): (_, Axis, _, f64) = match *motion {
        Motion::Along(axis, amount) => ("along", axis, "length_mm", to_mm(constant(amount))),
        Motion::About(axis, amount) => ("about", axis, "angle_deg", to_deg(constant(amount))),
    };
    let mut table = InlineTable::new();
    table.insert(word, axis.letter().to_string().into());
    // Written so that the same value is read back.
    let rounded: f64 = format!("{by:.PLACES$}").parse().unwrap_or(by);
    table.insert(field, (rounded + 0.0).into());
    table.insert("symbol", KEY.into());
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "format = 1\nname = \"lever\"\n\n[chain]\nsource = \"drawing\"\nmotions = [\n  { about = \"z\", joint = \"A\" },\n  \
        { along = \"x\", length_mm = 300 }, # arm\n  { about = \"y\", joint = \"B\" },\n]\n\n[[joint]]\nname = \"A\"\nsign = 1\nsource = \"wall\"\n\n\
        [[joint]]\nname = \"B\"\nsign = 1\nsource = \"wall\"\n\n[sources.drawing]\nwhat = \"lengths\"\nwhere = \"here\"\n\
        licence = \"ours\"\n\n[sources.wall]\nwhat = \"signs\"\nwhere = \"there\"\nlicence = \"ours\"\n";

    fn geometry() -> Geometry {
        let small = vec![
            Motion::Along(Axis::X, Amount::Constant(1.25e-4)),
            Motion::About(Axis::Y, Amount::Constant(-2e-3)),
        ];
        Geometry {
            after: vec![("A".to_owned(), small)],
            what: "20 poses".to_owned(),
            covariance: None,
            place: "poses.csv".to_owned(),
        }
    }

    #[test]
    fn small_motions_are_behind_their_joint_and_the_source_names_both() {
        let text = with_geometry("lever.toml", FILE, &geometry()).unwrap();
        assert!(text.contains("# arm"), "{text}");
        let read = super::super::read("lever.toml", "lever", &text).unwrap();
        let motions = read.robot.chain().motions();
        assert_eq!(motions.len(), 5);
        let Motion::About(Axis::Y, Amount::Constant(angle)) = motions[2] else {
            panic!("{motions:?}");
        };
        assert!((angle + 2e-3).abs() < 1e-10);
        assert!(
            matches!(motions[1], Motion::Along(Axis::X, Amount::Constant(by)) if (by - 1.25e-4).abs() < 1e-12)
        );
        assert!(!text.contains("[sources.drawing]"), "{text}");
        assert!(
            text.contains("lengths and angles: lengths (here); 20 poses"),
            "{text}"
        );
    }

    #[test]
    fn accepts_a_list_of_tables_and_a_second_calibration_keeps_the_first_source() {
        let tables = FILE.replace(
            "motions = [\n  { about = \"z\", joint = \"A\" },\n  { along = \"x\", length_mm = 300 }, # arm\n  { about = \"y\", joint = \"B\" },\n]\n",
            "[[chain.motions]]\nabout = \"z\"\njoint = \"A\"\n[[chain.motions]]\nabout = \"y\"\njoint = \"B\"\n",
        );
        assert_ne!(tables, FILE);
        let once = with_geometry("lever.toml", &tables, &geometry()).unwrap();
        let twice = with_geometry("lever.toml", &once, &geometry()).unwrap();
        let read = super::super::read("lever.toml", "lever", &twice).unwrap();
        assert_eq!(read.robot.chain().motions().len(), 6);
        assert!(
            twice.contains("lengths and angles: lengths (here); 20 poses; 20 poses"),
            "{twice}"
        );
    }

    #[test]
    fn refuses_files_that_are_not_robot_files() {
        for text in ["format = ", "format = 1\nname = \"x\"\n"] {
            assert!(with_geometry("lever.toml", text, &geometry()).is_err());
        }
    }
}

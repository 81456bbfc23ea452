//! Results of coordinate measuring machines in QIF 2.1 or 3: the circles that the machine fitted to its points.
//!
//! QIF contains fitted features, not measured points: `CircleFeatureActual` and `CylinderFeatureActual` give a centre
//! (or a point of the axis), a direction, a diameter, and a form error if it was requested. No circle can be fitted
//! again to these data. A QIF file is therefore read, but refused as a profile; the message lists its circles. Measured
//! points are stored in a `MeasurePointSets` of QIF 3. No public file with such a set is known, and it is not read.
//!
//! | element | use |
//! |---|---|
//! | `CircleFeatureActual`, `CylinderFeatureActual` | one circle |
//! | `FeatureItemId`, then `FeatureName` of the item with that id | its name |
//! | `Location`, or `Axis/AxisPoint` | its position |
//! | `Diameter` | its diameter |
//! | `Form` | its form error |
//! | `FileUnits/PrimaryUnits/LinearUnit/UnitConversion/Factor` | length of the file's unit in m |
//!
//! Source: QIF 2.1 and 3.0, Part 3, Features (ANSI/DMSC) as used in the samples of the standard.

use armill_core::units::{to_mm, to_um};
use std::collections::BTreeMap;
use std::io::Read;

use roxmltree::{Document, Node};

use crate::document::{Problem, Problems, Source};
use crate::xml::{self, children};

/// A circle that a machine fitted. m.
#[derive(Clone, Debug, PartialEq)]
struct ActualCircle {
    /// Name of the feature in the file.
    name: String,
    /// Its centre, or a point of its axis.
    centre: Option<[f64; 3]>,
    /// m
    diameter: Option<f64>,
    /// Form error, m.
    form: Option<f64>,
}

/// Maximum number of circles listed in a message.
const MOST_LISTED: usize = 20;

/// Why the file is not a profile: its problems, or the circles that it contains instead of points.
pub(super) fn refusal(path: &str, reader: impl Read) -> Problems {
    let found = match xml::text_of(path, reader).and_then(|text| circles(path, &text)) {
        Ok(found) => found,
        Err(wrong) => return wrong,
    };
    let message = match found.len() {
        0 => "this QIF file contains neither points nor circles".to_owned(),
        1 => format!(
            "this QIF file contains a circle, but not its points: {}",
            reported(&found)
        ),
        count => format!(
            "this QIF file contains {count} circles, but not their points: {}",
            reported(&found)
        ),
    };
    Problem::of_file(
        path,
        message,
        "roundness needs the measured points: export them as a table with `x_mm,y_mm,z_mm`",
    )
    .into()
}

/// The circles of a QIF text.
///
/// # Errors
/// Text that is not XML or not QIF; an invalid unit.
fn circles(path: &str, text: &str) -> Result<Vec<ActualCircle>, Problems> {
    let source = Source::new(path, text);
    let document = xml::parse(&source)?;
    let root = document.root_element();
    if root.tag_name().name() != "QIFDocument" {
        let message = format!("`{}` is not a QIF document", root.tag_name().name());
        let hint = "a profile is a table or rows of numbers".to_owned();
        return Err(source.problem(xml::tag(root), message, Some(hint)).into());
    }
    let factor = unit(&source, &document)?;
    let is_actual = |node: &Node<'_, '_>| {
        matches!(
            node.tag_name().name(),
            "CircleFeatureActual" | "CylinderFeatureActual"
        )
    };
    let names = names(&document);
    let circle = |node: Node<'_, '_>| {
        let length = |name| Some(numbers::<1>(children(node, name).next()?)?[0] * factor);
        let axis = || children(children(node, "Axis").next()?, "AxisPoint").next();
        let place = children(node, "Location").next().or_else(axis);
        let item = children(node, "FeatureItemId").next().and_then(|id| id.text());
        let name = item.and_then(|id| names.get(id.trim())).copied();
        ActualCircle {
            name: name.unwrap_or("without name").to_owned(),
            centre: place.and_then(numbers::<3>).map(|at| at.map(|x| x * factor)),
            diameter: length("Diameter"),
            form: length("Form"),
        }
    };
    Ok(document.descendants().filter(is_actual).map(circle).collect())
}

/// Length of the file's unit in m; 1 if it is not given, because QIF then uses SI units.
pub(in crate::measurement) fn unit(source: &Source, document: &Document<'_>) -> Result<f64, Problems> {
    let units = document
        .descendants()
        .find(|node| node.tag_name().name() == "LinearUnit");
    let factor = units
        .and_then(|units| children(units, "UnitConversion").next())
        .and_then(|conversion| children(conversion, "Factor").next());
    let Some(factor) = factor else { return Ok(1.0) };
    match numbers::<1>(factor) {
        Some([reported]) if reported > 0.0 => Ok(reported),
        _ => {
            let message = "the factor of the length unit is not a number above 0";
            let hint = "use 0.001 for mm".to_owned();
            Err(source.problem(factor.range(), message, Some(hint)).into())
        }
    }
}

/// Names of the feature items, by their ids.
pub(in crate::measurement) fn names<'a>(document: &'a Document<'_>) -> BTreeMap<&'a str, &'a str> {
    let items = document.descendants().filter_map(|node| {
        let name = children(node, "FeatureName").next()?.text()?;
        Some((node.attribute("id")?, name.trim()))
    });
    let mut names = BTreeMap::new();
    for (id, name) in items {
        names.entry(id).or_insert(name);
    }
    names
}

/// The `N` finite numbers in an element, if there are exactly `N`.
pub(in crate::measurement) fn numbers<const N: usize>(node: Node<'_, '_>) -> Option<[f64; N]> {
    let words: Option<Vec<f64>> = node
        .text()?
        .split_whitespace()
        .map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()))
        .collect();
    words?.try_into().ok()
}

/// The circles as text.
fn reported(circles: &[ActualCircle]) -> String {
    let one = |circle: &ActualCircle| {
        let mut words = vec![circle.name.clone()];
        words.extend(circle.diameter.map(|d| format!("diameter {:.4} mm", to_mm(d))));
        words.extend(circle.centre.map(|at| {
            let [x, y, z] = at.map(to_mm);
            format!("at ({x:.4}, {y:.4}, {z:.4}) mm")
        }));
        words.extend(circle.form.map(|form| format!("form {:.2} um", to_um(form))));
        words.join(" ")
    };
    let mut listed: Vec<String> = circles.iter().take(MOST_LISTED).map(one).collect();
    if circles.len() > MOST_LISTED {
        listed.push(format!("and {} more", circles.len() - MOST_LISTED));
    }
    listed.join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const RESULTS: &str = r#"<?xml version="1.0"?>
<QIFDocument xmlns="http://qifstandards.org/xsd/qif3">
  <FileUnits><PrimaryUnits><LinearUnit><UnitName>mm</UnitName><UnitConversion><Factor>0.001</Factor></UnitConversion>
  </LinearUnit></PrimaryUnits></FileUnits>
  <FeatureItems><CircleFeatureItem id="4"><FeatureName> BORE </FeatureName></CircleFeatureItem></FeatureItems>
  <FeatureActuals>
    <CircleFeatureActual id="5"><FeatureItemId>4</FeatureItemId><Location>1 2.5 -3</Location><Diameter>19.007</Diameter>
      <Form>0.012</Form></CircleFeatureActual>
    <CylinderFeatureActual id="6"><Axis><AxisPoint>0 0 1</AxisPoint></Axis><Diameter>x</Diameter></CylinderFeatureActual>
  </FeatureActuals>
</QIFDocument>"#;

    #[test]
    fn circles_are_read_in_metres_with_their_names() {
        let [bore, other] = circles("r.qif", RESULTS).unwrap().try_into().unwrap();
        assert_eq!(bore.name, "BORE");
        let centre = bore.centre.unwrap();
        assert!((centre[1] - 2.5e-3).abs() < 1e-18 && (centre[2] + 3e-3).abs() < 1e-18);
        assert!((bore.diameter.unwrap() - 19.007e-3).abs() < 1e-15);
        assert!((bore.form.unwrap() - 12e-6).abs() < 1e-18);
        assert_eq!(
            (other.name.as_str(), other.diameter, other.form),
            ("without name", None, None)
        );
        assert_eq!(other.centre, Some([0.0, 0.0, 1e-3]));
    }

    #[test]
    fn refuses_results_without_points_and_lists_their_circles() {
        let reported = refusal("r.qif", RESULTS.as_bytes()).to_string();
        assert!(reported.contains("2 circles, but not their points: BORE diameter 19.0070 mm at (1.0000, 2.5000, -3.0000) mm form 12.00 um"), "{reported}");
        assert!(reported.contains("export them as a table"));
        let reported = refusal("r.qif", "<QIFDocument/>".as_bytes()).to_string();
        assert!(reported.contains("neither points nor circles"));
    }

    #[test]
    fn refuses_files_that_are_not_qif() {
        for (text, part) in [
            ("<html></html>", "1:1: `html` is not a QIF document"),
            ("<QIFDocument>", "not XML"),
            (&RESULTS.replace(">0.001<", ">-1<"), "not a number above 0"),
        ] {
            let reported = refusal("r.qif", text.as_bytes()).to_string();
            assert!(reported.contains(part), "{reported}");
        }
    }
}

//! Results of a Renishaw QC20-W ball-bar, `.b5r`: XML with the results that Renishaw's software computed. Radii: `readings`.
//!
//! | element | attribute | meaning |
//! |---|---|---|
//! | `TEST_SPEC` | `NAME` | name of the test plan |
//! | `DATE_STARTED` | (text) | date |
//! | `MACHINE_TESTED` | `NAME` | the machine |
//! | `PLANE` | `TEST_PLANE` | `XY`, `YZ` or `ZX` |
//! | `FEATURE` | `NAME`, `DT`, (text) | a result: `AF_CIRCULARITY`, its unit, its value |
//!
//! Elements may be nested in any way. An unknown unit is reported under its own name. A feature without a number is
//! listed by its name.
//!
//! Names and units follow a public reader of such files, recalled from memory \[recalled\]; no file was available:
//! see `docs/theory/ballbar.md`.

use roxmltree::Node;

use crate::document::{Problems, Source};
use crate::xml::{children, parse, tag};

/// Results that Renishaw's software computed from a test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// Name of the test plan.
    pub test: Option<String>,
    /// Date.
    pub date: Option<String>,
    /// Machine.
    pub machine: Option<String>,
    /// Plane.
    pub plane: Option<String>,
    /// In the order of the file.
    pub features: Vec<Feature>,
    /// Names of the features whose text is not a number.
    pub without_number: Vec<String>,
}

/// One result.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// Name in the file: `AF_BACKLASH_A_POS`.
    pub name: String,
    /// Value in the file.
    pub value: f64,
    /// Name of the unit; the file's own name if the unit is unknown.
    pub unit: String,
}

/// Units by the value of the attribute `DT`.
const UNITS: [(&str, &str); 9] = [
    ("UT_LENGTH_UM", "um"),
    ("UT_LENGTH_MM", "mm"),
    ("UT_LENGTH_M", "m"),
    ("UT_FEEDRATE", "mm/min"),
    ("UT_SQUARENESS", "um/m"),
    ("UT_SERVO_MISMATCH", "ms"),
    ("UT_ANGLE", "deg"),
    ("UT_PERCENT", "%"),
    ("UT_SCALE_ERROR", "ppm"),
];

/// Reads the results in `text`. `path` is the file name shown in problems.
///
/// # Errors
/// Text that is not XML; a file without results; features without a name, and numbers beyond 1e12.
pub fn read(path: &str, text: &str) -> Result<Results, Problems> {
    let source = Source::new(path, text);
    let document = parse(&source)?;
    let mut results = Results::default();
    let mut problems = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        let text = || {
            node.text()
                .map(str::trim)
                .filter(|text| !text.is_empty())
                .map(str::to_owned)
        };
        let attribute = |name: &str| node.attribute(name).map(str::trim).map(str::to_owned);
        match node.tag_name().name() {
            "TEST_SPEC" => results.test = attribute("NAME").or_else(text),
            "DATE_STARTED" => results.date = text(),
            "MACHINE_TESTED" => results.machine = attribute("NAME").or_else(text),
            "PLANE" => results.plane = attribute("TEST_PLANE").or_else(text),
            "FEATURE" => match feature(&source, node) {
                Ok(Ok(feature)) => results.features.push(feature),
                Ok(Err(name)) => results.without_number.push(name),
                Err(wrong) => problems.extend(wrong),
            },
            _ => {}
        }
    }
    let has_readings = document.descendants().any(|node| node.has_tag_name("READINGS"));
    if results.features.is_empty() && problems.is_empty() && !has_readings {
        let root = document.root_element();
        let hint = "a result file of Renishaw Ballbar 20 (.b5r) is required; radii are read from CSV";
        let message = format!(
            "<{}> has no FEATURE and no READINGS: not a ball-bar result file",
            root.tag_name().name()
        );
        problems.push(source.problem(tag(root), message, Some(hint.to_owned())));
    }
    Problems::from(problems).into_result()?;
    Ok(results)
}

/// A feature, or only its name if it has no number.
fn feature(source: &Source, node: Node<'_, '_>) -> Result<Result<Feature, String>, Problems> {
    let Some(name) = node.attribute("NAME") else {
        let message = "<FEATURE> has no attribute `NAME`";
        return Err(source.problem(tag(node), message, None).into());
    };
    // The value is in the element or in one inside it.
    let inner = children(node, "VALUE").next().and_then(|value| value.text());
    let text = node.text().map(str::trim).filter(|text| !text.is_empty());
    let text = text.or(inner.map(str::trim)).unwrap_or_default();
    let value = text.parse().or_else(|_| text.replace(',', ".").parse::<f64>());
    let Ok(value) = value else {
        return Ok(Err(name.to_owned()));
    };
    if !value.is_finite() || value.abs() > 1e12 {
        let message = format!("{name} is {text}: not a valid ball-bar result");
        return Err(source.problem(tag(node), message, None).into());
    }
    let called = node.attribute("DT").unwrap_or_default().trim();
    let unit = UNITS
        .iter()
        .find(|(name, _)| *name == called)
        .map_or(called, |(_, unit)| unit);
    Ok(Ok(Feature {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
    }))
}

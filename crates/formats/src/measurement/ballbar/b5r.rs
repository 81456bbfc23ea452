//! Results of a Renishaw QC20-W ball-bar, `.b5r`: XML with what Renishaw's program made of a test, without radii.
//!
//! | element | attribute | meaning |
//! |---|---|---|
//! | `TEST_SPEC` | `NAME` | what was planned |
//! | `DATE_STARTED` | (text) | when |
//! | `MACHINE_TESTED` | `NAME` | the machine |
//! | `PLANE` | `TEST_PLANE` | `XY`, `YZ` or `ZX` |
//! | `FEATURE` | `NAME`, `DT`, (text) | a result: `AF_CIRCULARITY`, its unit, its value |
//!
//! Elements may nest in any way. A unit that is not known is kept as it is called; a feature without a number is
//! listed by its name.
//!
//! Names and units as they stand in a public reader of such files, and as remembered from it \[recalled\]; no file was at
//! hand: see `docs/theory/ballbar.md`.

use roxmltree::Node;

use crate::document::{Problems, Source};
use crate::xml::{children, parse, tag};

/// What Renishaw's program made of a test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// What was planned.
    pub test: Option<String>,
    /// When.
    pub date: Option<String>,
    /// On which machine.
    pub machine: Option<String>,
    /// In which plane.
    pub plane: Option<String>,
    /// In the order of the file.
    pub features: Vec<Feature>,
    /// Features whose text is no number, as they are called.
    pub without_number: Vec<String>,
}

/// One result.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// As the file calls it: `AF_BACKLASH_A_POS`.
    pub name: String,
    /// As the file has it.
    pub value: f64,
    /// The unit in words; as the file calls it where it is not known.
    pub unit: String,
}

/// Units by the name that the attribute `DT` has.
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

/// Reads the results in `text`; `path` is what problems show.
///
/// # Errors
/// What is no XML; a file without results; features without name, and numbers beyond 1e12.
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
    if results.features.is_empty() && problems.is_empty() {
        let root = document.root_element();
        let hint = "a result file of Renishaw's Ballbar 20 is wanted, .b5r; radii come as CSV";
        let message = format!(
            "<{}> holds no FEATURE: no results of a ball-bar",
            root.tag_name().name()
        );
        problems.push(source.problem(tag(root), message, Some(hint.to_owned())));
    }
    Problems::from(problems).into_result()?;
    Ok(results)
}

/// A feature, or the name of one without number.
fn feature(source: &Source, node: Node<'_, '_>) -> Result<Result<Feature, String>, Problems> {
    let Some(name) = node.attribute("NAME") else {
        let message = "<FEATURE> has no attribute `NAME`";
        return Err(source.problem(tag(node), message, None).into());
    };
    // The value stands in the element, or in one inside it.
    let inner = children(node, "VALUE").next().and_then(|value| value.text());
    let text = node.text().map(str::trim).filter(|text| !text.is_empty());
    let text = text.or(inner.map(str::trim)).unwrap_or_default();
    let value = text.parse().or_else(|_| text.replace(',', ".").parse::<f64>());
    let Ok(value) = value else {
        return Ok(Err(name.to_owned()));
    };
    if !value.is_finite() || value.abs() > 1e12 {
        let message = format!("{name} is {text}: no result of a ball-bar");
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

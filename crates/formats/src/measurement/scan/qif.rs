//! Measured points and features of QIF 2.1 and 3.0.
//!
//! | element | use |
//! |---|---|
//! | `PointFeatureActual`, `EdgePointFeatureActual`, ... with `Location`, `Normal` | a measured point |
//! | `FeatureItemId`, then `FeatureName` of the item with that id | its name |
//! | `FeatureNominalId` of that item, then `Location` and `Normal` of the nominal feature | nominal point, and normal if the measured one has none |
//! | `PlaneFeatureActual`, `CircleFeatureActual`, `CylinderFeatureActual` | a feature |
//! | `FileUnits/PrimaryUnits/LinearUnit/UnitConversion/Factor` | length of the file's unit in m |
//!
//! Sets of points of one feature (`MeasuredPointSet` of QIF 3) are not read: no public file with such a set is known.
//! Source: QIF 2.1 and 3.0, Part 3, Features (ANSI/DMSC), and the samples of the standard.

use std::collections::BTreeMap;

use armill_core::nalgebra::{Point3, Vector3};
use roxmltree::{Document, Node};

use super::measured::{
    EMPTY_HINT, MeasuredFeature, MeasuredFeatureKind, Scan, ScanFormat, ScanReadOptions, normal_of, point_of,
};
use crate::document::{MOST_PROBLEMS, Problem, Problems, Source};
use crate::measurement::profile::qif::{names, numbers, unit};
use crate::xml::{self, children};

/// Reads the points of a QIF file.
///
/// # Errors
/// Text that is not QIF, a location that is not three numbers, a unit that was given, neither points nor features.
pub(super) fn read(shown: &str, bytes: &[u8], given: &ScanReadOptions) -> Result<Scan, Problems> {
    let text = String::from_utf8_lossy(bytes);
    let source = Source::new(shown, &text);
    let document = xml::parse(&source)?;
    let root = document.root_element();
    if root.tag_name().name() != "QIFDocument" {
        let message = format!("`{}` is not a QIF document", root.tag_name().name());
        return Err(source
            .problem(xml::tag(root), message, Some(EMPTY_HINT.to_owned()))
            .into());
    }
    if let Some(unit) = given.unit {
        let message = format!("the unit {unit} was specified, but QIF files state their unit");
        return Err(Problem::of_file(shown, message, "leave out the unit").into());
    }
    let factor = unit(&source, &document)?;
    let index = Index::of(&document);
    let mut scan = Scan::empty(ScanFormat::Qif);
    let mut problems = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        let Some(kind) = node.tag_name().name().strip_suffix("FeatureActual") else {
            continue;
        };
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        match kind {
            "Plane" => scan
                .features
                .push(index.feature(node, MeasuredFeatureKind::Plane, factor)),
            "Circle" => scan
                .features
                .push(index.feature(node, MeasuredFeatureKind::Circle, factor)),
            "Cylinder" => scan
                .features
                .push(index.feature(node, MeasuredFeatureKind::Cylinder, factor)),
            _ if kind.ends_with("Point") => {
                if let Err((place, message)) = index.take(node, factor, &mut scan) {
                    let hint = "a location is three numbers".to_owned();
                    problems.push(source.problem(xml::tag(place), message, Some(hint)));
                }
            }
            _ => {}
        }
    }
    Problems::from(problems).into_result()?;
    if scan.points.is_empty() && scan.features.is_empty() {
        return Err(Problem::of_file(
            shown,
            "this QIF file has no measured points and no features",
            EMPTY_HINT,
        )
        .into());
    }
    Ok(scan.finished())
}

/// Elements by their ids.
struct Index<'a> {
    names: BTreeMap<&'a str, &'a str>,
    /// Nominal feature of an item.
    nominal_of_item: BTreeMap<&'a str, &'a str>,
    /// Elements of nominal features.
    nominal: BTreeMap<&'a str, Node<'a, 'a>>,
}

impl<'a> Index<'a> {
    fn of(document: &'a Document<'a>) -> Index<'a> {
        let mut index = Index {
            names: names(document),
            nominal_of_item: BTreeMap::new(),
            nominal: BTreeMap::new(),
        };
        for node in document.descendants().filter(Node::is_element) {
            let Some(id) = node.attribute("id") else { continue };
            let tag = node.tag_name().name();
            if tag.ends_with("FeatureNominal") {
                index.nominal.entry(id).or_insert(node);
            } else if tag.ends_with("FeatureItem")
                && let Some(nominal) = children(node, "FeatureNominalId")
                    .next()
                    .and_then(|node| node.text())
            {
                index.nominal_of_item.entry(id).or_insert(nominal.trim());
            }
        }
        index
    }

    /// The item of a measured feature.
    fn item(node: Node<'a, 'a>) -> Option<&'a str> {
        Some(children(node, "FeatureItemId").next()?.text()?.trim())
    }

    fn name(&self, node: Node<'a, 'a>) -> String {
        let name = Index::item(node).and_then(|id| self.names.get(id));
        name.copied().unwrap_or_default().to_owned()
    }

    /// Adds a measured point.
    fn take(&self, node: Node<'a, 'a>, factor: f64, scan: &mut Scan) -> Result<(), (Node<'a, 'a>, String)> {
        // A point that was not measured has no location.
        let Some(at) = children(node, "Location").next() else {
            return Ok(());
        };
        let of = |at: Node<'a, 'a>| {
            let found =
                numbers::<3>(at).ok_or_else(|| (at, "the location is not three numbers".to_owned()))?;
            point_of(found.map(|x| x * factor)).map_err(|message| (at, message))
        };
        let point = of(at)?;
        let nominal = Index::item(node)
            .and_then(|id| self.nominal.get(self.nominal_of_item.get(id)?))
            .copied();
        let place = nominal.and_then(|nominal| children(nominal, "Location").next());
        let place = place.map(of).transpose()?;
        let normal = |node: Node<'a, 'a>| normal_of(numbers::<3>(children(node, "Normal").next()?)?);
        scan.points.push(point);
        scan.normals.push(normal(node).or_else(|| normal(nominal?)));
        scan.nominal.push(place);
        scan.deviations.push(None);
        scan.names.push(self.name(node));
        Ok(())
    }

    fn feature(&self, node: Node<'a, 'a>, kind: MeasuredFeatureKind, factor: f64) -> MeasuredFeature {
        let axis = children(node, "Axis").next();
        let length = |name| Some(numbers::<1>(children(node, name).next()?)?[0] * factor);
        let at = children(node, "Location")
            .next()
            .or_else(|| children(axis?, "AxisPoint").next());
        let direction = children(node, "Normal")
            .next()
            .or_else(|| children(axis?, "Direction").next());
        MeasuredFeature {
            name: self.name(node),
            kind,
            at: at
                .and_then(numbers::<3>)
                .map(|at| Point3::from(at.map(|x| x * factor))),
            direction: direction
                .and_then(numbers::<3>)
                .and_then(|v| Vector3::from(v).try_normalize(0.0)),
            diameter: length("Diameter"),
            form: length("Form"),
        }
    }
}

//! Features of the surface that comes out: form, size and position of the faces that lines of the program make.
//!
//! | feature | faces | evaluated |
//! |---|---|---|
//! | circle, hole | those along the tool | cylinder: diameters, cylindricity, position of its axis |
//! | line | those along the tool | plane: flatness, offset, tilt |
//! | plane | those across the tool | plane: flatness, offset, tilt |
//!
//! A circular slot has two cylinders, an internal and an external one, and a straight one two walls, left and right of the feed: each is a feature. The nominal feature is fitted to the nominal points in the same way.

use armill_core::form::cylinder::{AxisSegment, cylinder_form, least_squares_cylinder};
use armill_core::form::plane::{departure, flatness, least_squares_plane};
use armill_core::form::{Cylinder, FormError};
use armill_core::machined::SurfaceDeviation;
use armill_core::nalgebra::{Point2, Point3, Unit, UnitVector3, Vector3};
use armill_core::robot::Robot;
use armill_core::roundness;
use armill_core::units::{to_deg, to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use super::roughness::{ALONG_TOOL, ToothMarks};
use super::run::MachinedPart;
use super::setting::{MachinedSetting, NominalPart};
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::feature::{FeatureName, FeatureTable};

/// A feature of the surface.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct SurfaceFeatureAnswer {
    /// Its name; of a slot's two cylinders with `internal` or `external`, of its two walls with `left` or `right`.
    pub name: String,
    /// `cylinder` or `plane`.
    pub kind: &'static str,
    /// Points of its surface.
    pub points: usize,
    /// Mean deviation, positive where material is left.
    pub mean_um: Option<f64>,
    /// Profile of its surface (ISO 1101): twice the largest deviation by size.
    pub profile_um: Option<f64>,
    /// Standard uncertainty of the largest deviation; none if it is not known.
    pub u_um: Option<f64>,
    /// Flatness (ISO 1101, minimum zone).
    pub flatness_um: Option<f64>,
    /// Distance of the mean plane from the nominal one, positive where material is left.
    pub offset_um: Option<f64>,
    /// Angle between both planes.
    pub tilt_deg: Option<f64>,
    /// Nominal diameter.
    pub nominal_diameter_mm: Option<f64>,
    /// Global least-squares size (ISO 14405-1 GG) less the nominal diameter.
    pub diameter_change_um: Option<f64>,
    /// Maximum inscribed size (GX).
    pub inscribed_diameter_mm: Option<f64>,
    /// Minimum circumscribed size (GN).
    pub circumscribed_diameter_mm: Option<f64>,
    /// Cylindricity (ISO 1101, minimum zone).
    pub cylindricity_um: Option<f64>,
    /// Position of the axis (ISO 1101): diameter of the zone about the nominal axis over the length of the feature.
    pub position_um: Option<f64>,
    /// Displacement of the axis in the middle of the feature, frame of the program.
    pub axis_shift_um: Option<[f64; 3]>,
    /// Largest theoretical height of the marks of the teeth along the feed, of faces along the tool; none without a cut.
    pub feed_marks_um: Option<f64>,
    /// Largest vibration of the tool across its axis under the teeth that made it, from its mean position: it adds at most twice this to the height of the roughness. None without `[vibration]`.
    pub vibration_um: Option<f64>,
    /// Why there is no result.
    pub missing: Option<String>,
}

/// A face is across the tool where its normal is this much along it (cosine).
const ACROSS_TOOL: f64 = 0.7;
/// A wall is along the feed where its normal is this much across it (cosine): to 1.8 deg, so that a rounded end has no part in it.
const STRAIGHT: f64 = 0.9995;
/// A side with a smaller part of the points is the end of the other one.
const OF_BOTH: f64 = 0.2;

/// Every requested feature of a path.
pub fn features(
    robot: &Robot,
    analysis: &PathAnalysis,
    part: &MachinedPart,
    marks: &ToothMarks<'_>,
) -> Vec<SurfaceFeatureAnswer> {
    let Some(machined) = analysis.machined_part.as_deref() else {
        return Vec::new();
    };
    let is_of_program = matches!(machined.nominal, NominalPart::Program);
    let of = |feature: &FeatureTable| {
        let points = points_of(machined, part, feature);
        let with_common = |mut answer: SurfaceFeatureAnswer, points: &[SurfaceDeviation]| {
            add_common(&mut answer, points, &part.uncertainty(robot, analysis));
            let roughness = marks.roughness(points);
            answer.feed_marks_um = roughness.feed_marks.map(to_um);
            answer.vibration_um = roughness.vibration.map(to_um);
            answer
        };
        match feature.kind {
            FeatureName::Circle | FeatureName::Hole => cylinders(feature, (&points, is_of_program))
                .into_iter()
                .map(|(answer, points)| with_common(answer, &points))
                .collect(),
            FeatureName::Line => walls(feature, part, &points)
                .into_iter()
                .map(|(name, points)| with_common(plane(&name, &points), &points))
                .collect(),
            FeatureName::Plane => vec![with_common(plane(&feature.name, &points), &points)],
        }
    };
    analysis.features.iter().flat_map(of).collect()
}

/// The points of the faces that a feature is evaluated on, each with the tool axis of its move.
pub(super) fn points_of(
    machined: &MachinedSetting,
    part: &MachinedPart,
    feature: &FeatureTable,
) -> Vec<SurfaceDeviation> {
    let track = &part.track;
    let of_feature = |point: &&SurfaceDeviation| {
        let made_by = match machined.nominal {
            NominalPart::Program => point.nominal_by,
            NominalPart::Mesh(_) => point.made_by,
        };
        let Some(of_path) = made_by
            .move_index()
            .and_then(|index| track.path.points.get(index))
        else {
            return false;
        };
        let [first, last] = feature.lines;
        let along = track.placing.path_spindle(of_path).dot(&point.normal).abs();
        point.is_same_face
            && (first..=last).contains(&of_path.line)
            && match feature.kind {
                FeatureName::Plane => along > ACROSS_TOOL,
                FeatureName::Circle | FeatureName::Hole | FeatureName::Line => along < ALONG_TOOL,
            }
    };
    part.surface.points.iter().filter(of_feature).copied().collect()
}

/// Mean, profile and uncertainty.
fn add_common(
    answer: &mut SurfaceFeatureAnswer,
    points: &[SurfaceDeviation],
    u: &impl Fn(&SurfaceDeviation) -> Option<f64>,
) {
    let area: f64 = points.iter().map(|point| point.area).sum();
    let sum: f64 = points.iter().map(|point| point.area * point.deviation).sum();
    let size = |point: &SurfaceDeviation| point.deviation.abs();
    let largest = points
        .iter()
        .max_by(|one, other| size(one).total_cmp(&size(other)));
    answer.points = points.len();
    answer.mean_um = (area > 0.0).then(|| to_um(sum / area));
    answer.profile_um = largest.map(|point| to_um(2.0 * size(point)));
    answer.u_um = largest.and_then(u).map(to_um);
}

/// The walls along a line: of a slot the left and the right one, seen along the feed.
pub(super) fn walls(
    feature: &FeatureTable,
    part: &MachinedPart,
    points: &[SurfaceDeviation],
) -> Vec<(String, Vec<SurfaceDeviation>)> {
    let track = &part.track;
    // The component of the normal to the left: the material of the left wall is on the left, so that its normal points to the right.
    let leftwards = |point: &SurfaceDeviation| {
        let index = point.nominal_by.move_index().or(point.made_by.move_index());
        let of_path = index.and_then(|index| track.path.points.get(index));
        of_path.map_or(0.0, |of_path| {
            let left = track.placing.path_spindle(of_path).cross(&of_path.direction);
            left.try_normalize(0.0)
                .map_or(0.0, |left| left.dot(&point.normal))
        })
    };
    // The rounded ends of a slot are not its walls.
    let straight = points.iter().filter(|point| leftwards(point).abs() > STRAIGHT);
    let (left, right): (Vec<&SurfaceDeviation>, Vec<&SurfaceDeviation>) =
        straight.partition(|point| leftwards(point) < 0.0);
    let all = left.len() + right.len();
    let sides = sides([("left", left), ("right", right)], all);
    if sides.is_empty() {
        return vec![(feature.name.clone(), Vec::new())];
    }
    let both = sides.len() > 1;
    let named = |(side, points): (&str, Vec<SurfaceDeviation>)| {
        let name = match both {
            true => format!("{}, {side}", feature.name),
            false => feature.name.clone(),
        };
        (name, points)
    };
    sides.into_iter().map(named).collect()
}

/// Those of two sides that have a good part of all points.
fn sides<'a>(
    sides: [(&'a str, Vec<&SurfaceDeviation>); 2],
    all: usize,
) -> Vec<(&'a str, Vec<SurfaceDeviation>)> {
    let least = OF_BOTH * all as f64;
    (sides.into_iter())
        .filter(|(_, points)| !points.is_empty() && points.len() as f64 >= least)
        .map(|(side, points)| (side, points.into_iter().copied().collect()))
        .collect()
}

/// A plane: nominal and as it came out.
fn plane(name: &str, points: &[SurfaceDeviation]) -> SurfaceFeatureAnswer {
    let answer = SurfaceFeatureAnswer {
        name: name.to_owned(),
        kind: "plane",
        ..SurfaceFeatureAnswer::default()
    };
    let evaluated = || -> Result<SurfaceFeatureAnswer, FormError> {
        let nominal: Vec<Point3<f64>> = points.iter().map(|point| point.position).collect();
        let made: Vec<Point3<f64>> = points.iter().map(|point| point.on_part).collect();
        let (nominal, form) = (least_squares_plane(&nominal)?, flatness(&made)?);
        let outwards: Vector3<f64> = points.iter().map(|point| point.normal.into_inner()).sum();
        let outwards = nominal.normal * nominal.normal.dot(&outwards).signum();
        let off = departure(
            &form.least_squares,
            &nominal.origin,
            &UnitVector3::new_normalize(outwards),
        );
        Ok(SurfaceFeatureAnswer {
            flatness_um: Some(to_um(form.minimum_zone)),
            offset_um: Some(to_um(off.offset)),
            tilt_deg: Some(to_deg(off.tilt.norm())),
            ..answer.clone()
        })
    };
    evaluated().unwrap_or_else(|error| SurfaceFeatureAnswer {
        missing: Some(error.to_string()),
        ..answer.clone()
    })
}

/// The cylinders of a circle or a hole, each with its points.
fn cylinders(
    feature: &FeatureTable,
    (points, is_of_program): (&[SurfaceDeviation], bool),
) -> Vec<(SurfaceFeatureAnswer, Vec<SurfaceDeviation>)> {
    let missing = |points: &[SurfaceDeviation], name: &str, error: &FormError| {
        let answer = SurfaceFeatureAnswer {
            name: name.to_owned(),
            kind: "cylinder",
            missing: Some(error.to_string()),
            ..SurfaceFeatureAnswer::default()
        };
        (answer, points.to_vec())
    };
    let Some((axis, centre)) = axis_and_centre(points) else {
        return vec![missing(points, &feature.name, &FormError::Undetermined)];
    };
    let is_internal = |point: &&SurfaceDeviation| (centre - point.position).dot(&point.normal) > 0.0;
    let (internal, external): (Vec<&SurfaceDeviation>, Vec<&SurfaceDeviation>) =
        points.iter().partition(is_internal);
    let sides = sides([("internal", internal), ("external", external)], points.len());
    let both = sides.len() > 1;
    let of_side = |(side, points): (&str, Vec<SurfaceDeviation>)| {
        let name = match both {
            true => format!("{}, {side}", feature.name),
            false => feature.name.clone(),
        };
        match cylinder(&name, axis, (&points, is_of_program)) {
            Ok(answer) => (answer, points),
            Err(error) => missing(&points, &name, &error),
        }
    };
    sides.into_iter().map(of_side).collect()
}

/// The direction across all normals of a cylinder, and the centre of its nominal points.
fn axis_and_centre(points: &[SurfaceDeviation]) -> Option<(UnitVector3<f64>, Point3<f64>)> {
    let mut spread = armill_core::nalgebra::Matrix3::zeros();
    for point in points {
        spread += point.normal.into_inner() * point.normal.transpose();
    }
    let eigen = spread.symmetric_eigen();
    let least = eigen.eigenvalues.imin();
    let axis = Unit::try_new(eigen.eigenvectors.column(least).into_owned(), 0.5)?;
    let [x, y] = armill_core::frame::both_across(&axis);
    let middle: Vector3<f64> = points
        .iter()
        .map(|point| point.position.coords)
        .sum::<Vector3<f64>>()
        / points.len().max(1) as f64;
    let seen = |point: &SurfaceDeviation| {
        let off = point.position.coords - middle;
        Point2::new(off.dot(&x), off.dot(&y))
    };
    let circle = roundness::least_squares(&points.iter().map(seen).collect::<Vec<_>>())?;
    Some((
        axis,
        Point3::from(middle + x * circle.centre.x + y * circle.centre.y),
    ))
}

fn cylinder(
    name: &str,
    axis: UnitVector3<f64>,
    (points, is_of_program): (&[SurfaceDeviation], bool),
) -> Result<SurfaceFeatureAnswer, FormError> {
    let nominal: Vec<Point3<f64>> = points.iter().map(|point| point.position).collect();
    let (_, centre) = axis_and_centre(points).ok_or(FormError::Undetermined)?;
    let start = Cylinder {
        at: centre,
        axis,
        radius: nominal
            .iter()
            .map(|point| (point - centre).cross(&axis).norm())
            .sum::<f64>()
            / nominal.len().max(1) as f64,
    };
    let mut nominal_cylinder = least_squares_cylinder(&nominal, &start)?;
    let mut made: Vec<Point3<f64>> = points.iter().map(|point| point.on_part).collect();
    if is_of_program {
        // The points of an arc are on it, and the chords between them inside: those are not of the part.
        let distances = nominal.iter().map(|point| nominal_cylinder.distance(point));
        nominal_cylinder.radius = distances.fold(0.0, f64::max);
        for (made, point) in made.iter_mut().zip(points) {
            let off = point.position - nominal_cylinder.at;
            let across = off - nominal_cylinder.axis.into_inner() * off.dot(&nominal_cylinder.axis);
            let outwards = across.try_normalize(0.0).unwrap_or_default();
            *made += outwards * (nominal_cylinder.radius - across.norm());
        }
    }
    let form = cylinder_form(&made, &nominal_cylinder)?;
    let heights = || {
        nominal
            .iter()
            .map(|point| (point - nominal_cylinder.at).dot(&nominal_cylinder.axis))
    };
    let end = |height: f64| nominal_cylinder.at + nominal_cylinder.axis.into_inner() * height;
    let segment = AxisSegment {
        from: end(heights().fold(f64::INFINITY, f64::min)),
        to: end(heights().fold(f64::NEG_INFINITY, f64::max)),
    };
    let made_by = form.least_squares;
    let middle = armill_core::nalgebra::center(&segment.from, &segment.to);
    let rise = made_by.axis.dot(&nominal_cylinder.axis);
    let along = (middle - made_by.at).dot(&nominal_cylinder.axis) / rise;
    let shift = made_by.at + made_by.axis.into_inner() * along - middle;
    let diameter = |cylinder: Cylinder| to_mm(2.0 * cylinder.radius);
    Ok(SurfaceFeatureAnswer {
        name: name.to_owned(),
        kind: "cylinder",
        nominal_diameter_mm: Some(diameter(nominal_cylinder)),
        diameter_change_um: Some(to_um(2.0 * (made_by.radius - nominal_cylinder.radius))),
        inscribed_diameter_mm: form.inscribed.map(diameter),
        circumscribed_diameter_mm: form.circumscribed.map(diameter),
        cylindricity_um: Some(to_um(form.cylindricity)),
        position_um: made_by.position(&segment).map(to_um),
        axis_shift_um: Some(shift.map(to_um).into()),
        ..SurfaceFeatureAnswer::default()
    })
}

//! Errors of features: the circle, line, plane or hole that a stretch of the path produces.
//!
//! Each is fitted to the actual positions of the tool. Lengths m, angles rad, path axes.
//!
//! | feature | reported | fitted |
//! |---|---|---|
//! | circle | radius, shift of its centre, roundness | least-squares circle in the plane of the nominal points |
//! | line | straightness across and along the tool, offset | least-squares line through each part of the deviation |
//! | plane | flatness, offset | least-squares plane through the normal parts |
//! | hole | shift of its axis | mean of the points |
//!
//! Straightness and flatness are peak to valley about the least-squares line or plane (LSLI, LSPL of ISO 12780 and
//! 12781, without filter), roundness about the least-squares circle (LSCI of ISO 12181).

use nalgebra::{Matrix3, Point3, Unit, Vector3};

use crate::frame::both_across;
use crate::roundness::{Plane, least_squares};

/// Kind of feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    /// A full circle, or a good part of one.
    Circle,
    /// A straight edge.
    Line,
    /// A flat face, from several passes.
    Plane,
    /// A drilled hole.
    Hole,
}

/// Errors of a feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FeatureErrors {
    /// A circle.
    Circle {
        /// Nominal radius, of the tool tip's path.
        radius: f64,
        /// Increase of the radius.
        radius_change: f64,
        /// Shift of its centre.
        centre_shift: Vector3<f64>,
        /// Peak to valley about the least-squares circle.
        roundness: f64,
    },
    /// A line.
    Line {
        /// Peak to valley to the left and right.
        straightness_across: f64,
        /// Peak to valley along the tool.
        straightness_normal: f64,
        /// Mean offset, without the component along the line.
        offset: Vector3<f64>,
    },
    /// A plane.
    Plane {
        /// Peak to valley.
        flatness: f64,
        /// Mean offset along the tool.
        offset: f64,
    },
    /// A hole.
    Hole {
        /// Shift of its axis, across the tool.
        shift: Vector3<f64>,
    },
}

/// A point of a stretch: nominal position of the tip, direction of the tool, and deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviatedPoint {
    /// Nominal position.
    pub at: Point3<f64>,
    /// From the tip towards the spindle.
    pub axis: Unit<Vector3<f64>>,
    /// Deviation.
    pub by: Vector3<f64>,
}

/// Errors of a feature of this kind through `points`; `None` where the points do not define such a feature: too few,
/// coincident, a circle on a line.
pub fn feature_errors(kind: FeatureKind, points: &[DeviatedPoint]) -> Option<FeatureErrors> {
    match kind {
        FeatureKind::Circle => circle(points),
        FeatureKind::Line => line(points),
        FeatureKind::Plane => plane(points),
        FeatureKind::Hole => hole(points),
    }
}

fn circle(points: &[DeviatedPoint]) -> Option<FeatureErrors> {
    let nominal: Vec<_> = points.iter().map(|p| p.at).collect();
    let plane = Plane::nearest(&nominal)?;
    let given: Vec<_> = nominal.iter().map(|at| plane.seen(at)).collect();
    let made: Vec<_> = points.iter().map(|p| plane.seen(&(p.at + p.by))).collect();
    let (given, made) = (least_squares(&given)?, least_squares(&made)?);
    Some(FeatureErrors::Circle {
        radius: given.radius,
        radius_change: made.radius - given.radius,
        centre_shift: plane.at(&made.centre) - plane.at(&given.centre),
        roundness: made.peak_to_valley,
    })
}

fn line(points: &[DeviatedPoint]) -> Option<FeatureErrors> {
    let middle = mean(points.iter().map(|p| p.at.coords))?;
    // Not from the first point to the last: a closed pass ends at its start.
    let along = greatest_direction(points.iter().map(|p| p.at.coords - middle))?;
    let normal = mean(points.iter().map(|p| p.axis.into_inner()))?;
    let normal = (normal - along * normal.dot(&along)).try_normalize(1e-9)?;
    let left = normal.cross(&along);
    let straightness = |direction: Vector3<f64>| {
        let part = |p: &DeviatedPoint| [(p.at.coords - middle).dot(&along), 0.0, p.by.dot(&direction)];
        peak_to_valley(points.iter().map(part))
    };
    let offset = mean(points.iter().map(|p| p.by - along * p.by.dot(&along)))?;
    Some(FeatureErrors::Line {
        straightness_across: straightness(left)?,
        straightness_normal: straightness(normal)?,
        offset,
    })
}

fn plane(points: &[DeviatedPoint]) -> Option<FeatureErrors> {
    if points.len() < 4 {
        return None;
    }
    let normal = mean(points.iter().map(|p| p.axis.into_inner()))?.try_normalize(1e-9)?;
    let [x, y] = both_across(&normal);
    let middle = mean(points.iter().map(|p| p.at.coords))?;
    let part = |p: &DeviatedPoint| {
        let from = p.at.coords - middle;
        [from.dot(&x), from.dot(&y), p.by.dot(&normal)]
    };
    Some(FeatureErrors::Plane {
        flatness: peak_to_valley(points.iter().map(part))?,
        offset: mean(points.iter().map(|p| p.by))?.dot(&normal),
    })
}

fn hole(points: &[DeviatedPoint]) -> Option<FeatureErrors> {
    let across = |p: &DeviatedPoint| p.by - p.axis.into_inner() * p.by.dot(&p.axis);
    Some(FeatureErrors::Hole {
        shift: mean(points.iter().map(across))?,
    })
}

fn mean(vectors: impl Iterator<Item = Vector3<f64>>) -> Option<Vector3<f64>> {
    let (sum, count) = vectors.fold((Vector3::zeros(), 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// The direction of the largest extent of these vectors, either way; `None` where all of them are shorter than a
/// nanometre.
fn greatest_direction(vectors: impl Iterator<Item = Vector3<f64>> + Clone) -> Option<Vector3<f64>> {
    let longest = vectors.clone().map(|v| v.norm()).fold(0.0, f64::max);
    let spread: Matrix3<f64> = vectors.map(|v| v * v.transpose()).sum();
    let eigen = spread.symmetric_eigen();
    (longest > 1e-9).then(|| eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned())
}

/// Peak to valley of the heights (third entries) about their least-squares plane over the first two; about a line,
/// where the second are all the same.
fn peak_to_valley(points: impl Iterator<Item = [f64; 3]> + Clone) -> Option<f64> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    let largest = points
        .clone()
        .flat_map(|[x, y, _]| [x.abs(), y.abs()])
        .fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let row = |[x, y, _]: [f64; 3]| Vector3::new(x / largest, y / largest, 1.0);
    for point in points.clone() {
        normal += row(point) * row(point).transpose();
        right += row(point) * point[2];
    }
    // The pseudo-inverse leaves out a direction without extent.
    let fitted = normal.pseudo_inverse(1e-9 * normal.trace()).ok()? * right;
    let rests = points.map(|point| point[2] - row(point).dot(&fitted));
    let (low, high) = rests.fold((f64::MAX, f64::MIN), |(low, high), r| (low.min(r), high.max(r)));
    (high >= low).then_some(high - low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn deviated(at: Vector3<f64>, by: Vector3<f64>) -> DeviatedPoint {
        DeviatedPoint {
            at: at.into(),
            axis: Vector3::z_axis(),
            by,
        }
    }

    /// A turn about an axis that is in no coordinate plane.
    fn tilt() -> nalgebra::Rotation3<f64> {
        nalgebra::Rotation3::new(Vector3::new(0.4, -0.9, 0.3))
    }

    fn tilted(points: &[DeviatedPoint]) -> Vec<DeviatedPoint> {
        let tilt = tilt();
        points
            .iter()
            .map(|p| DeviatedPoint {
                at: tilt * p.at,
                axis: tilt * p.axis,
                by: tilt * p.by,
            })
            .collect()
    }

    #[test]
    fn a_circle_that_grows_shifts_and_becomes_oval_is_reported() {
        let points: Vec<_> = (0..360)
            .map(|i| {
                let phi = TAU * f64::from(i) / 360.0;
                let out = Vector3::new(phi.cos(), phi.sin(), 0.0);
                let by = out * (12e-6 + 5e-6 * (2.0 * phi).cos()) + Vector3::new(30e-6, -7e-6, 90e-6);
                deviated(out * 0.1 + Vector3::new(0.3, 0.2, -0.1), by)
            })
            .collect();
        let Some(FeatureErrors::Circle {
            radius,
            radius_change,
            centre_shift,
            roundness,
        }) = feature_errors(FeatureKind::Circle, &tilted(&points))
        else {
            panic!("a circle")
        };
        assert!((radius - 0.1).abs() < 1e-12 && (radius_change - 12e-6).abs() < 1e-9);
        assert!((centre_shift - tilt() * Vector3::new(30e-6, -7e-6, 0.0)).norm() < 1e-9);
        assert!((roundness - 10e-6).abs() < 1e-9, "{roundness}");
    }

    #[test]
    fn a_line_that_bows_has_its_bow_as_straightness_whatever_its_slope() {
        // h = b (s/L)^2 on -L..L about its least-squares line, b/3: from -b/3 in the middle to 2b/3 at the ends.
        let bow = |s: f64| 30e-6 * s * s;
        let points: Vec<_> = (-1000..=1000)
            .map(|i| {
                let s = f64::from(i) / 1000.0;
                let by = Vector3::new(400e-6, 5e-6 + 20e-6 * s + bow(s), -8e-6 * s);
                deviated(Vector3::new(0.2 * s, 0.1, 0.0), by)
            })
            .collect();
        let Some(FeatureErrors::Line {
            straightness_across,
            straightness_normal,
            offset,
        }) = feature_errors(FeatureKind::Line, &tilted(&points))
        else {
            panic!("a line")
        };
        assert!(
            (straightness_across - 30e-6).abs() < 1e-11,
            "{straightness_across}"
        );
        assert!(straightness_normal < 1e-15);
        // The component along the line is not included: 5 um and a third of the bow to the left.
        assert!((offset.norm() - 15e-6).abs() < 2e-8, "{offset}");
    }

    #[test]
    fn a_line_passed_in_both_directions_is_the_same_line() {
        let bow = |s: f64| 30e-6 * s * s;
        let at = |i: i32| {
            // Out, and back to a nanometre from the start.
            let s = f64::from(if i <= 1000 { i - 500 } else { 1501 - i }) / 500.0;
            let by = Vector3::new(0.0, bow(s), 7e-6 * s * s);
            deviated(Vector3::new(0.2 * s, 0.1 + 1e-9 * f64::from(i > 1000), 0.0), by)
        };
        let both: Vec<_> = (0..=2001).map(at).collect();
        let (there_and_back, there) = (tilted(&both), tilted(&both[..=1000]));
        let [
            Some(FeatureErrors::Line {
                straightness_across: across,
                straightness_normal: normal,
                offset,
            }),
            Some(given),
        ] = [there_and_back, there].map(|points| feature_errors(FeatureKind::Line, &points))
        else {
            panic!("lines")
        };
        assert!(
            (across - 30e-6).abs() < 1e-10 && (normal - 7e-6).abs() < 1e-10,
            "{across} {normal}"
        );
        let FeatureErrors::Line { offset: one_way, .. } = given else {
            panic!("a line")
        };
        assert!((offset - one_way).norm() < 1e-7, "{offset} {one_way}");
    }

    #[test]
    fn a_part_of_a_circle_is_fitted_like_the_whole() {
        let arc = |degrees: i32| -> Vec<DeviatedPoint> {
            let at = |i: i32| {
                let phi = f64::from(i).to_radians();
                let out = Vector3::new(phi.cos(), phi.sin(), 0.0);
                deviated(out * 0.1, out * 12e-6 + Vector3::new(30e-6, -7e-6, 90e-6))
            };
            tilted(&(0..degrees).map(at).collect::<Vec<_>>())
        };
        for degrees in [360, 120, 60] {
            let Some(FeatureErrors::Circle {
                radius,
                radius_change,
                centre_shift,
                roundness,
            }) = feature_errors(FeatureKind::Circle, &arc(degrees))
            else {
                panic!("a circle")
            };
            // A shift across a short arc looks like growth: rounding of 1e-16 m, ten thousand times at 60 deg.
            assert!(
                (radius - 0.1).abs() < 1e-11 && (radius_change - 12e-6).abs() < 1e-11,
                "{degrees}"
            );
            assert!(
                (centre_shift - tilt() * Vector3::new(30e-6, -7e-6, 0.0)).norm() < 1e-11,
                "{degrees}"
            );
            assert!(roundness < 1e-13, "{degrees}: {roundness}");
        }
    }

    #[test]
    fn a_twist_of_a_plane_is_flatness_and_a_tilt_is_not_included() {
        let points: Vec<_> = (-10..=10)
            .flat_map(|i| (-10..=10).map(move |j| (f64::from(i) / 10.0, f64::from(j) / 10.0)))
            .map(|(x, y)| {
                let height = 4e-6 + 50e-6 * x - 20e-6 * y + 6e-6 * x * y;
                deviated(
                    Vector3::new(0.1 * x, 0.2 * y, 0.0),
                    Vector3::new(0.0, 1e-3, height),
                )
            })
            .collect();
        let Some(FeatureErrors::Plane { flatness, offset }) =
            feature_errors(FeatureKind::Plane, &tilted(&points))
        else {
            panic!("a plane")
        };
        assert!((flatness - 12e-6).abs() < 1e-12 && (offset - 4e-6).abs() < 1e-12);
    }

    #[test]
    fn a_hole_moves_across_the_tool_only() {
        let points: Vec<_> = (0..10)
            .map(|i| {
                deviated(
                    Vector3::new(0.0, 0.0, -1e-3 * f64::from(i)),
                    Vector3::new(3e-6, 4e-6, 80e-6),
                )
            })
            .collect();
        let Some(FeatureErrors::Hole { shift }) = feature_errors(FeatureKind::Hole, &points) else {
            panic!("a hole")
        };
        assert!((shift - Vector3::new(3e-6, 4e-6, 0.0)).norm() < 1e-18);
    }

    #[test]
    fn points_that_do_not_define_the_feature_give_none() {
        let still = vec![deviated(Vector3::zeros(), Vector3::x()); 5];
        let row: Vec<_> = (0..5)
            .map(|i| deviated(Vector3::x() * f64::from(i), Vector3::zeros()))
            .collect();
        for kind in [FeatureKind::Circle, FeatureKind::Line, FeatureKind::Plane] {
            assert_eq!(feature_errors(kind, &still), None);
        }
        assert_eq!(feature_errors(FeatureKind::Circle, &row), None);
        assert_eq!(feature_errors(FeatureKind::Hole, &[]), None);
        assert_eq!(feature_errors(FeatureKind::Line, &row[..1]), None);
    }
}

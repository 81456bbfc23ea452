//! Measured points of the real part: read, moved onto the nominal part, and compared with the prediction.
//!
//! Measured and predicted deviations are those of the same points after the same kind of alignment: what a best fit or datums hide is taken from both.

use std::path::Path;

use armill_core::form::align::{WeightedPoints, deviations};
use armill_core::form::datum::datum_motion;
use armill_core::form::{AlignmentOptions, DatumNormals, DatumTargets, FormError, NominalSurface, best_fit};
use armill_core::frame::Isometry;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::units::from_mm;
use armill_formats::measurement::profile::LengthUnit;
use armill_formats::measurement::scan::{self, ScanReadOptions};
use rayon::prelude::*;

use super::mesh::PartMesh;
use super::setting::{Align, DatumPoints, NominalPart, ScanSetting};
use super::table::{AlignName, DatumsTable, NominalName, ScanTable};
use crate::StudyError;
use crate::input::cell::tables::MeshUnitName;
use crate::input::problem_log::ProblemLog;

/// Points farther from the nominal part are left out where no distance is given, m.
const FARTHEST: f64 = 2e-3;
/// Wavelengths that separate bands where none are given, m.
const WAVELENGTHS: [f64; 2] = [20e-3, 2e-3];
/// Measured points within this distance of a datum point are averaged, m.
const DATUM_RADIUS: f64 = 1e-3;

/// A measured part compared with the prediction, at the points that are compared.
#[derive(Clone, Debug)]
pub struct ScanComparison {
    /// On the nominal surface, frame of the path, m.
    pub points: Vec<Point3<f64>>,
    /// Normals there.
    pub normals: Vec<Vector3<f64>>,
    /// Measured deviations after alignment, m.
    pub measured: Vec<f64>,
    /// Predicted deviations after the same alignment, m.
    pub predicted: Vec<f64>,
    /// Predicted deviations before alignment, m.
    pub unaligned: Vec<f64>,
    /// Where each point is on the triangles of the part: vertices and their weights.
    pub places: Vec<MeshPlace>,
    /// The motion of the measured points by the alignment.
    pub motion: Isometry,
    /// The motion of the predicted points by it.
    pub predicted_motion: Isometry,
    /// Points that are too far from the nominal part.
    pub too_far: usize,
    /// Points where nothing is predicted.
    pub not_predicted: usize,
}

/// A place on a triangle: its vertices, and their weights, which add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPlace {
    /// Of the mesh of the part.
    pub vertices: [u32; 3],
    /// Barycentric coordinates.
    pub weights: [f64; 3],
}

/// The measured points of the table; `None` if they have problems. `path_from_part`: from the frame of the mesh of `[part]`, if there is one.
///
/// # Errors
/// The problems of the file.
pub(super) fn resolve(
    log: &mut ProblemLog<'_>,
    table: &ScanTable,
    folder: &Path,
    (nominal, path_from_part): (&NominalPart, Option<Isometry>),
) -> Result<Option<ScanSetting>, StudyError> {
    const KEY: &str = "machined_part.scan";
    let frame = table.frame.unwrap_or(match nominal {
        NominalPart::Program => NominalName::Program,
        NominalPart::Mesh(_) => NominalName::Part,
    });
    let path_from_scan = match (frame, path_from_part) {
        (NominalName::Program, _) => Isometry::identity(),
        (NominalName::Part, Some(path_from_part)) => path_from_part,
        (NominalName::Part, None) => {
            let message = "`frame = \"part\"`, but the study has no [part] with a mesh";
            log.problem(KEY, message, "frame = \"program\"");
            return Ok(None);
        }
    };
    let align = match (table.align, &table.datums) {
        (Some(AlignName::Datums), None) => {
            let hint = "datums = { primary_mm = [[..], [..], [..]], secondary_mm = [[..], [..]], tertiary_mm = [..] }";
            log.problem(KEY, "`align = \"datums\"` needs `datums`", hint);
            return Ok(None);
        }
        (Some(AlignName::None | AlignName::BestFit), Some(_)) => {
            log.problem(
                KEY,
                "`datums` are used by `align = \"datums\"` alone",
                "remove one",
            );
            return Ok(None);
        }
        (Some(AlignName::None), None) => Align::None,
        (Some(AlignName::BestFit) | None, None) => Align::BestFit,
        (Some(AlignName::Datums) | None, Some(datums)) => {
            Align::Datums(datum_points(datums, &path_from_scan))
        }
    };
    let wavelengths = table.wavelengths_mm.map_or(WAVELENGTHS, |mm| mm.map(from_mm));
    if wavelengths[0] <= wavelengths[1] {
        let key = format!("{KEY}.wavelengths_mm");
        log.problem(&key, "the first wavelength must be above the second", "[20, 2]");
        return Ok(None);
    }
    let given = ScanReadOptions {
        unit: table.unit.map(|unit| match unit {
            MeshUnitName::Mm => LengthUnit::Millimetre,
            MeshUnitName::M => LengthUnit::Metre,
            MeshUnitName::Inch => LengthUnit::Inch,
        }),
    };
    let path = folder.join(&table.file);
    let read = scan::read_file(&path, &path.display().to_string(), &given)?;
    Ok(Some(ScanSetting {
        file: table.file.clone(),
        points: read.points.iter().map(|point| path_from_scan * point).collect(),
        align,
        options: AlignmentOptions {
            probe_radius: from_mm(table.probe_radius_mm.unwrap_or(0.0)),
            farthest: table.farthest_mm.map_or(FARTHEST, from_mm),
        },
        wavelengths,
        notes: read
            .notes
            .iter()
            .map(|note| format!("{}: {note}", table.file))
            .collect(),
    }))
}

fn datum_points(table: &DatumsTable, path_from_scan: &Isometry) -> DatumPoints {
    let point = |mm: &[f64; 3]| path_from_scan * Point3::from(mm.map(from_mm));
    DatumPoints {
        primary: table.primary_mm.iter().map(point).collect(),
        secondary: table.secondary_mm.iter().map(point).collect(),
        tertiary: point(&table.tertiary_mm),
        radius: table.radius_mm.map_or(DATUM_RADIUS, from_mm),
    }
}

/// The nominal surface: that of the mesh of `[part]`, or what the program leaves.
///
/// # Errors
/// A surface without area.
pub(super) fn nominal_surface(nominal: &NominalPart, mesh: &PartMesh) -> Result<NominalSurface, FormError> {
    let of_mesh = |triangle: &[u32; 3]| triangle.map(|vertex| mesh.vertices[vertex as usize]);
    let triangles = match nominal {
        NominalPart::Program => mesh.triangles.iter().map(of_mesh).collect(),
        NominalPart::Mesh(triangles) => triangles.iter().map(|triangle| triangle.0).collect(),
    };
    NominalSurface::new(triangles).ok_or(FormError::Undetermined)
}

/// Compares measured points with the prediction of `mesh`.
///
/// # Errors
/// Points that do not determine the alignment, or none near the nominal part.
pub(super) fn compared(
    scan: &ScanSetting,
    nominal: &NominalSurface,
    mesh: &PartMesh,
) -> Result<ScanComparison, FormError> {
    let predicted_surface = PredictedSurface::new(mesh).ok_or(FormError::Undetermined)?;
    let motion = motion(scan, &scan.points, nominal)?;
    let feet = deviations(&scan.points, nominal, &motion, &scan.options);
    let predicted_at = |foot: &Option<armill_core::form::NormalDeviation>| {
        foot.as_ref()
            .map(|foot| predicted_surface.at(&foot.at, &foot.normal))
    };
    let predicted: Vec<Option<Option<(f64, MeshPlace)>>> = feet.par_iter().map(predicted_at).collect();
    let mut found = ScanComparison {
        points: Vec::new(),
        normals: Vec::new(),
        measured: Vec::new(),
        predicted: Vec::new(),
        places: Vec::new(),
        motion,
        predicted_motion: Isometry::identity(),
        too_far: 0,
        not_predicted: 0,
        unaligned: Vec::new(),
    };
    for (foot, predicted) in feet.iter().zip(predicted) {
        match (foot, predicted.flatten()) {
            (None, _) => found.too_far += 1,
            (Some(_), None) => found.not_predicted += 1,
            (Some(foot), Some((predicted, place))) => {
                found.places.push(place);
                found.points.push(foot.at);
                found.normals.push(foot.normal);
                found.measured.push(foot.deviation);
                found.unaligned.push(predicted);
            }
        }
    }
    if found.points.is_empty() {
        return Err(FormError::TooFew { needed: 1, given: 0 });
    }
    let places = (&found.points[..], &found.normals[..]);
    let (predicted, predicted_motion) = aligned(scan, nominal, places, &found.unaligned)?;
    found.predicted = predicted;
    found.predicted_motion = predicted_motion;
    Ok(found)
}

impl ScanComparison {
    /// Mean of the values of the points (one each) about each vertex of the mesh; not a number where there are none.
    pub fn at_vertices(&self, count: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut sums = vec![[0.0; 2]; count];
        for (point, place) in self.places.iter().enumerate() {
            for (vertex, weight) in place.vertices.iter().zip(place.weights) {
                let sum = &mut sums[*vertex as usize];
                sum[0] += weight * value(point);
                sum[1] += weight;
            }
        }
        let mean = |[sum, weight]: [f64; 2]| if weight > 0.0 { sum / weight } else { f64::NAN };
        sums.into_iter().map(mean).collect()
    }
}

/// Deviations along the normals of points on the nominal surface after the alignment of the scan, as if the part were measured there: what the alignment takes from measured points is taken
/// from them; and the motion by it.
///
/// # Errors
/// Points that do not determine the alignment.
pub(super) fn aligned(
    scan: &ScanSetting,
    nominal: &NominalSurface,
    (points, normals): (&[Point3<f64>], &[Vector3<f64>]),
    deviations: &[f64],
) -> Result<(Vec<f64>, Isometry), FormError> {
    let places = || points.iter().zip(normals);
    let moved: Vec<Point3<f64>> = places()
        .zip(deviations)
        .map(|((at, normal), by)| at + normal * *by)
        .collect();
    let surface_points = ScanSetting {
        options: AlignmentOptions {
            probe_radius: 0.0,
            ..scan.options
        },
        ..scan.without_points()
    };
    let motion = motion(&surface_points, &moved, nominal)?;
    let along = places()
        .zip(&moved)
        .map(|((at, normal), point)| (motion * point - at).dot(normal));
    Ok((along.collect(), motion))
}

impl ScanSetting {
    fn without_points(&self) -> ScanSetting {
        ScanSetting {
            file: String::new(),
            points: Vec::new(),
            align: self.align.clone(),
            options: self.options,
            wavelengths: self.wavelengths,
            notes: Vec::new(),
        }
    }
}

/// The motion that aligns points with the nominal surface.
fn motion(
    scan: &ScanSetting,
    points: &[Point3<f64>],
    nominal: &NominalSurface,
) -> Result<Isometry, FormError> {
    let start = Isometry::identity();
    match &scan.align {
        Align::None => Ok(start),
        Align::BestFit => {
            let points = WeightedPoints {
                points,
                weights: None,
            };
            Ok(best_fit(points, nominal, &start, &scan.options)?.motion)
        }
        Align::Datums(datums) => {
            let target = |at: &Point3<f64>| datum_target(at, points, nominal, (datums.radius, &scan.options));
            let all = |points: &[Point3<f64>]| points.iter().map(target).collect::<Result<Vec<_>, _>>();
            let (primary, secondary) = (all(&datums.primary)?, all(&datums.secondary)?);
            let tertiary = target(&datums.tertiary)?;
            let measured = Places::of([&primary, &secondary], &tertiary, |target| target.measured);
            let wanted = Places::of([&primary, &secondary], &tertiary, |target| target.nominal);
            let normals = DatumNormals {
                primary: primary.iter().map(|target| target.normal).sum(),
                secondary: secondary.iter().map(|target| target.normal).sum(),
                tertiary: tertiary.normal,
            };
            datum_motion(&measured.targets(), &wanted.targets(), &normals)
        }
    }
}

/// Places of datum points.
struct Places {
    primary: Vec<Point3<f64>>,
    secondary: Vec<Point3<f64>>,
    tertiary: Point3<f64>,
}

impl Places {
    fn of(
        [primary, secondary]: [&[Target]; 2],
        tertiary: &Target,
        which: impl Fn(&Target) -> Point3<f64>,
    ) -> Places {
        Places {
            primary: primary.iter().map(&which).collect(),
            secondary: secondary.iter().map(&which).collect(),
            tertiary: which(tertiary),
        }
    }

    fn targets(&self) -> DatumTargets<'_> {
        DatumTargets {
            primary: &self.primary,
            secondary: &self.secondary,
            tertiary: self.tertiary,
        }
    }
}

/// A datum point: nominal, measured, and the normal there.
struct Target {
    nominal: Point3<f64>,
    measured: Point3<f64>,
    normal: Vector3<f64>,
}

/// The mean deviation of the points near a nominal datum point, along the normal there.
fn datum_target(
    at: &Point3<f64>,
    points: &[Point3<f64>],
    nominal: &NominalSurface,
    (radius, options): (f64, &AlignmentOptions),
) -> Result<Target, FormError> {
    let foot = nominal
        .foot(at, options.farthest)
        .ok_or(FormError::Undetermined)?
        .deviation;
    let near = points.iter().map(|point| point - foot.at);
    let along: Vec<f64> = near
        .filter(|off| (off - foot.normal * off.dot(&foot.normal)).norm() <= radius)
        .map(|off| off.dot(&foot.normal) - options.probe_radius)
        .filter(|deviation| deviation.abs() <= options.farthest)
        .collect();
    if along.is_empty() {
        return Err(FormError::TooFew { needed: 1, given: 0 });
    }
    let mean = along.iter().sum::<f64>() / along.len() as f64;
    Ok(Target {
        nominal: foot.at,
        measured: foot.at + foot.normal * mean,
        normal: foot.normal,
    })
}

/// The predicted deviation at places of the nominal surface.
struct PredictedSurface<'a> {
    surface: NominalSurface,
    /// The vertices of each triangle of the surface.
    corners: Vec<[u32; 3]>,
    mesh: &'a PartMesh,
}

/// Least cosine of the normals of a place and of the triangle near it.
const SAME_FACE: f64 = 0.7;
/// How far the mesh of the part may be from a nominal surface, in lengths of its shortest diagonal: its chords.
const NEAR: f64 = 0.002;

impl<'a> PredictedSurface<'a> {
    fn new(mesh: &'a PartMesh) -> Option<PredictedSurface<'a>> {
        let with_values = mesh.triangles.iter().filter(|triangle| {
            triangle
                .iter()
                .all(|vertex| mesh.deviations[*vertex as usize].is_finite())
        });
        let triangles: Vec<[u32; 3]> = with_values.copied().collect();
        let placed = triangles
            .iter()
            .map(|corners| corners.map(|vertex| mesh.vertices[vertex as usize]));
        let surface = NominalSurface::new(placed.collect())?;
        // The surface has its triangles in an order of its own.
        let mut by_corners = std::collections::HashMap::new();
        let key = |corners: [Point3<f64>; 3]| {
            corners.map(|corner| [corner.x, corner.y, corner.z].map(f64::to_bits))
        };
        for corners in &triangles {
            by_corners.insert(
                key(corners.map(|vertex| mesh.vertices[vertex as usize])),
                *corners,
            );
        }
        let corners = surface.mesh().triangles().iter();
        let corners: Option<Vec<[u32; 3]>> = corners
            .map(|triangle| by_corners.get(&key(triangle.0)).copied())
            .collect();
        Some(PredictedSurface {
            surface,
            corners: corners?,
            mesh,
        })
    }

    /// The deviation at a place with this normal, m; `None` where nothing is predicted.
    fn at(&self, at: &Point3<f64>, normal: &Vector3<f64>) -> Option<(f64, MeshPlace)> {
        let foot = self.surface.foot(at, NEAR)?;
        let triangle = &self.surface.mesh().triangles()[foot.triangle];
        let area = triangle.area_vector();
        if area.dot(normal) < SAME_FACE * area.norm() {
            return None;
        }
        let [a, b, c] = triangle.0;
        let foot_at = foot.deviation.at;
        let part = |u: Point3<f64>, v: Point3<f64>| {
            (u - foot_at).cross(&(v - foot_at)).dot(&area) / area.norm_squared()
        };
        let parts = [part(b, c), part(c, a), part(a, b)];
        let vertices = self.corners[foot.triangle];
        let sum: f64 = parts.iter().sum();
        let weights = parts.map(|part| part / sum);
        let values = vertices.map(|vertex| self.mesh.deviations[vertex as usize]);
        let value: f64 = weights
            .iter()
            .zip(values)
            .map(|(weight, value)| weight * value)
            .sum();
        (sum > 0.0).then_some((value, MeshPlace { vertices, weights }))
    }
}

//! Quantities of a study file, checked and converted to SI.
//!
//! Millimetres become metres, degrees radians. A function that finds a problem reports it at the key `path` of the
//! value and gives `None`.

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::load::{LoadCases, LoadFrame};
use armill_core::nalgebra::{Point3, UnitQuaternion, Vector3};
use armill_core::spatial::Wrench;
use armill_core::units::{from_deg, from_mm};
use armill_core::workpiece::{Grid, Plane};

use crate::input::memory::{GIB, LEAST_EXTRA_BYTES, MOST_BYTES};
use crate::input::problem_log::ProblemLog;
use crate::input::tables::{HalfSize, LoadFrameName, LoadTable, PlaneTable};

/// A length above 0, m.
pub fn positive(log: &mut ProblemLog<'_>, path: &str, value_mm: f64) -> Option<f64> {
    if value_mm > 0.0 {
        return Some(from_mm(value_mm));
    }
    log.problem(
        path,
        format!("`{path}` is {value_mm} mm: must be above 0 mm"),
        "a length above 0",
    );
    None
}

/// Least distance of points, mm: far below the accuracy of any machine.
const LEAST_STEP_MM: f64 = 1e-3;

/// A distance of points that is not too small to be counted, m.
pub fn step(log: &mut ProblemLog<'_>, path: &str, value_mm: f64) -> Option<f64> {
    at_least(log, path, value_mm, LEAST_STEP_MM)
}

/// A length of at least `least_mm`, m.
pub fn at_least(log: &mut ProblemLog<'_>, path: &str, value_mm: f64, least_mm: f64) -> Option<f64> {
    if value_mm >= least_mm {
        return Some(from_mm(value_mm));
    }
    // As short as possible: 1e-30 has 30 zeros otherwise.
    let value = match value_mm.abs() {
        0.0 | 1e-6.. => format!("{value_mm}"),
        _ => format!("{value_mm:e}"),
    };
    let message = format!("`{path}` is {value} mm: must be at least {least_mm} mm");
    log.problem(path, message, "a larger length");
    None
}

/// Largest half size, mm: 1 km.
const LARGEST_MM: f64 = 1e6;

/// Half sizes of 0 to 1 km, m.
pub fn sizes(log: &mut ProblemLog<'_>, path: &str, half_size_mm: &[f64]) -> Option<Vec<f64>> {
    let Some(wrong) = half_size_mm
        .iter()
        .find(|half| !(0.0..=LARGEST_MM).contains(*half))
    else {
        return Some(half_size_mm.iter().map(from_mm).collect());
    };
    let message = format!("`{path}` is {wrong} mm: must be from 0 to {LARGEST_MM} mm");
    log.problem(path, message, "0 (a single line of points) or more");
    None
}

/// The grid of a plane.
///
/// The points are at whole steps from its centre, within the half sizes; a problem if they do not fit into
/// memory.
pub fn grid(log: &mut ProblemLog<'_>, plane: &PlaneTable) -> Option<Grid> {
    let step = step(log, "plane.step_mm", plane.step_mm);
    let half_mm = match plane.half_size_mm {
        HalfSize::Square(half) => [half, half],
        HalfSize::Oblong(halves) => halves,
    };
    let half = sizes(log, "plane.half_size_mm", &half_mm);
    let (step, half) = (step?, half?);
    // Counted as numbers first: a grid too large for memory must not overflow an index.
    if half.iter().any(|h| h / step > 1e8) {
        // Bounded so that it can be shown; at least the extra bytes of a point.
        let points = half
            .iter()
            .map(|h| 2.0 * h / step + 1.0)
            .product::<f64>()
            .min(1e300);
        let (gib, most) = (points * LEAST_EXTRA_BYTES as f64 / GIB, MOST_BYTES / GIB);
        let message =
            format!("{points:.0e} points would take {gib:.0e} GiB of memory, more than {most:.0} GiB");
        log.problem("plane.step_mm", message, "a larger step, or a smaller plane");
        return None;
    }
    Some(Grid::within([half[0], half[1]], step))
}

/// The plane in base, and its tilt (rad) if it was given by one.
///
/// `base_from_reference` is the frame that the table counts from. Without tilt and rotation the plane is vertical and
/// faces the robot.
pub fn plane_at(
    log: &mut ProblemLog<'_>,
    table: &PlaneTable,
    base_from_reference: &Isometry,
) -> Option<(Plane, Option<f64>)> {
    let Some((reference_from_part, tilt)) = reference_from_part(table) else {
        log.problem(
            "plane.rotation_deg",
            "a plane has either `tilt_deg` or `rotation_deg`",
            "remove one",
        );
        return None;
    };
    Some((
        Plane {
            base_from_part: base_from_reference * reference_from_part,
        },
        tilt,
    ))
}

/// The plane in the frame that the table counts from, and its tilt, rad; `None` with tilt and rotation.
pub fn reference_from_part(table: &PlaneTable) -> Option<(Isometry, Option<f64>)> {
    let centre = Point3::from(from_mm(Vector3::from(table.centre_mm)));
    Some(match (table.tilt_deg, table.rotation_deg) {
        (Some(_), Some(_)) => return None,
        (None, Some(angles)) => {
            let rotation = Vector3::from(angles).map(from_deg);
            (from_xyz_and_fixed_angles(centre.coords, rotation), None)
        }
        (tilt, None) => {
            let tilt = from_deg(tilt.unwrap_or(0.0));
            (Plane::tilted(centre, tilt).base_from_part, Some(tilt))
        }
    })
}

/// The load cases in their own frame; those in the axes of base_link in the axes of base, which are the same unless a
/// positioner carries the part (`base_from_link`).
///
/// `None` if it has no case, or not one moment a case; moments that are left out are zero.
pub fn load_cases(
    log: &mut ProblemLog<'_>,
    table: &LoadTable,
    base_from_link: &Isometry,
) -> Option<LoadCases> {
    if table.cases_n.is_empty() {
        log.problem(
            "load.cases_n",
            "the load has no case",
            "cases_n = [[3, 5, 5]]: force on the tool, x, y, z",
        );
        return None;
    }
    let moments = table
        .moments_n_m
        .clone()
        .unwrap_or_else(|| vec![[0.0; 3]; table.cases_n.len()]);
    if moments.len() != table.cases_n.len() {
        let message = format!("{} moments for {} cases", moments.len(), table.cases_n.len());
        log.problem(
            "load.moments_n_m",
            message,
            "give one for each case, in the same order",
        );
        return None;
    }
    let frame = table.frame.map_or(LoadFrame::Base, LoadFrameName::frame);
    let turn = match frame {
        LoadFrame::Base => base_from_link.rotation,
        LoadFrame::Part | LoadFrame::Feed => UnitQuaternion::identity(),
    };
    let cases = table.cases_n.iter().zip(moments).map(|(f, m)| Wrench {
        force: turn * Vector3::from(*f),
        moment: turn * Vector3::from(m),
    });
    Some(LoadCases {
        frame,
        cases: cases.collect(),
    })
}

/// The pose of six numbers: x, y, z in mm, turns about fixed x, y, z in degrees.
pub fn pose_mm_deg(values: &[f64; 6]) -> Isometry {
    let [x, y, z, rx, ry, rz] = *values;
    let angles = Vector3::new(rx, ry, rz).map(from_deg);
    from_xyz_and_fixed_angles(from_mm(Vector3::new(x, y, z)), angles)
}

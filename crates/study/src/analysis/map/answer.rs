//! A map in the answer: the part of a plane within the tolerance, its uncertainty, and every point.
//!
//! In-plane coordinates are y' and z', mm from the centre of the plane: `y' = -x`, `z' = y` of the part frame. On a
//! plane that is given by its tilt, y' is along base y.

use armill_core::kernel::Evaluation;
use armill_core::map::{COVERAGE, Certainty, Counts, PlaneMap, Region, probability_within};
use armill_core::nalgebra::Point2;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_mm2, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::clearance::LeastClearance;
use crate::analysis::point::{PointAnswer, ReachedPoint, SettingAnswer};
use crate::analysis::vibration::VibrationAnswer;
use crate::input::setting::Setting;
use crate::number::without_rounding;

/// A map of one plane.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MapAnswer {
    /// Its name: of the analysis, with the label of the section.
    pub name: String,
    /// Requested posture: words of a branch, or `best`.
    pub branch: String,
    /// Points within the tolerance over all points. A named branch is evaluated whether its joints are inside their
    /// limits or not; `best` only uses postures inside.
    pub fraction_within: f64,
    /// The same, of points inside the joint limits only.
    pub fraction_within_and_inside_joint_limits: f64,
    /// Largest in-plane deviation of all reached points.
    pub max_in_plane_um: Option<f64>,
    /// Least in-plane deviation of all reached points.
    pub min_in_plane_um: Option<f64>,
    /// Largest deviation along the normal (depth) of all reached points, by size.
    pub max_normal_um: Option<f64>,
    /// Points by reason; their sum is the total.
    pub counts: CountsAnswer,
    /// Least distance of two bodies at any point, 0 where they touch; none without bodies.
    pub least_clearance_mm: Option<f64>,
    /// The two bodies.
    pub nearest: Option<[String; 2]>,
    /// Points with a posture outside joint limits.
    pub outside_joint_limits: usize,
    /// Points with a posture near a singularity.
    pub near_singularity: usize,
    /// The point with the largest in-plane deviation.
    pub worst: Option<PointAnswer>,
    /// The point with the least in-plane deviation.
    pub best: Option<PointAnswer>,
    /// The point with the largest deviation along the normal, by size.
    pub largest_along_normal: Option<PointAnswer>,
    /// The region within the tolerance, inside the joint limits.
    pub region: RegionAnswer,
    /// Uncertainty of the region: points outside joint limits are treated as out of tolerance. None where the
    /// uncertainty of the deviations is not known.
    pub certainty: Option<CertaintyAnswer>,
    /// Modes of the arm and stability of the cut; none without `[vibration]`.
    pub vibration: Option<VibrationAnswer>,
    /// The common setting of all points.
    pub setting: SettingAnswer,
    /// The points.
    pub grid: GridAnswer,
}

/// Points by reason; their sum is the total.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct CountsAnswer {
    /// In-plane deviation within the tolerance.
    pub within: usize,
    /// In-plane deviation above the tolerance.
    pub above_tolerance: usize,
    /// No posture reaches.
    pub out_of_reach: usize,
    /// Postures reach, but none inside the joint limits (`best` only).
    pub no_posture_inside_limits: usize,
    /// A search found no posture.
    pub not_found: usize,
    /// The inverse kinematics failed its own check.
    pub unverified: usize,
    /// A posture reaches the point, but the arm has no stable equilibrium under the load.
    pub unstable: usize,
    /// Postures reach the point, but none keeps the demanded clearance.
    pub in_collision: usize,
}

impl CountsAnswer {
    /// The counts of the core under the names of the answer.
    pub fn of(counts: &Counts) -> CountsAnswer {
        CountsAnswer {
            within: counts.within,
            above_tolerance: counts.above_tolerance,
            out_of_reach: counts.out_of_reach,
            no_posture_inside_limits: counts.no_posture_inside_limits,
            not_found: counts.not_found,
            unverified: counts.unverified,
            unstable: counts.unstable,
            in_collision: counts.in_collision,
        }
    }

    /// Points without a result.
    pub fn unreached(&self) -> usize {
        self.out_of_reach
            + self.no_posture_inside_limits
            + self.not_found
            + self.unverified
            + self.unstable
            + self.in_collision
    }

    /// All points.
    pub fn total(&self) -> usize {
        self.within + self.above_tolerance + self.unreached()
    }
}

/// The region within the tolerance. In-plane coordinates y', z' from the plane's centre.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RegionAnswer {
    /// Area, with the tolerance interpolated between points.
    pub area_mm2: f64,
    /// Its boundary: polylines, closed ones repeat their first point.
    pub boundary_mm: Vec<Vec<[f64; 2]>>,
    /// Largest axis-parallel rectangle inside: two opposite corners.
    pub rectangle_mm: Option<[[f64; 2]; 2]>,
    /// Centre of the largest circle inside.
    pub circle_centre_mm: Option<[f64; 2]>,
    /// Its radius.
    pub circle_radius_mm: Option<f64>,
}

/// Uncertainty of the region, from the standard uncertainties of the points.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CertaintyAnswer {
    /// Coverage factor of the bounds: multiple of the standard uncertainty.
    pub coverage_factor: f64,
    /// Points within the tolerance with the expanded uncertainty added, over all points.
    pub fraction_robustly_within: f64,
    /// Points within the tolerance with the expanded uncertainty subtracted, over all points.
    pub fraction_possibly_within: f64,
    /// Mean probability of all points to be within the tolerance.
    pub fraction_expected_within: f64,
    /// Area within the tolerance with the expanded uncertainty added.
    pub area_robust_mm2: f64,
    /// Its boundary.
    pub boundary_robust_mm: Vec<Vec<[f64; 2]>>,
    /// Area within the tolerance with the expanded uncertainty subtracted.
    pub area_possibly_mm2: f64,
    /// Its boundary.
    pub boundary_possibly_mm: Vec<Vec<[f64; 2]>>,
}

/// The points of a map, row by row along z', in each row along y'.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct GridAnswer {
    /// How many.
    pub points: usize,
    /// y' of the columns.
    pub y_mm: Vec<f64>,
    /// z' of the rows.
    pub z_mm: Vec<f64>,
    /// In-plane deviation; none without posture.
    pub in_plane_um: Vec<Option<f64>>,
    /// Its standard uncertainty; none where it is not known.
    pub in_plane_u_um: Vec<Option<f64>>,
    /// Probability that it is within the tolerance; none where the uncertainty is not known.
    pub probability_within: Vec<Option<f64>>,
    /// Deviation along the outward normal.
    pub normal_um: Vec<Option<f64>>,
    /// Length of the deviation.
    pub full_um: Vec<Option<f64>>,
    /// Points without a posture, outside joint limits or near a singularity, with the reason; points not named are
    /// fine.
    pub flags: Vec<PointFlag>,
}

/// A flag of some points.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PointFlag {
    /// One word.
    pub reason: String,
    /// Indices of the flagged points.
    pub points: Vec<usize>,
}

/// The result of one plane; `name` is that of the analysis, with the label of a section.
pub fn answer(
    robot: &Robot,
    name: &str,
    setting: &Setting,
    map: &PlaneMap,
    vibration: Option<VibrationAnswer>,
) -> MapAnswer {
    let counts = Counts::of(&map.answers, setting.tolerance);
    let point = |(index, evaluation)| {
        // The TCP is the point of the plane, at any orientation of the tool.
        let base_from_tool = map.plane.base_from_tool(map.grid.point(index), 0.0);
        let reached = ReachedPoint {
            answers: &map.answers,
            index,
            evaluation,
            tcp: base_from_tool.translation.vector.into(),
        };
        PointAnswer::of(robot, setting, &reached)
    };
    let (worst, best) = (map.answers.worst().map(point), map.answers.best().map(point));
    let largest_along_normal = map.answers.largest_along_normal().map(point);
    let clearance = LeastClearance::of(setting, &map.answers);
    MapAnswer {
        name: name.to_owned(),
        branch: setting.branch(),
        fraction_within: counts.fraction_within(),
        fraction_within_and_inside_joint_limits: counts.fraction_within_and_inside_joint_limits(),
        max_in_plane_um: worst.as_ref().map(|p| p.in_plane_um),
        min_in_plane_um: best.as_ref().map(|p| p.in_plane_um),
        max_normal_um: largest_along_normal.as_ref().map(|p| p.normal_um.abs()),
        counts: CountsAnswer::of(&counts),
        least_clearance_mm: clearance.as_ref().map(|least| least.distance_mm),
        nearest: clearance.map(|least| least.bodies),
        outside_joint_limits: counts.outside_joint_limits,
        near_singularity: counts.near_singularity,
        worst,
        best,
        largest_along_normal,
        region: region_answer(&map.region(setting.tolerance)),
        certainty: map.certainty(setting.tolerance).as_ref().map(certainty_answer),
        vibration,
        setting: SettingAnswer::of(robot, setting),
        grid: grid_answer(map, setting.tolerance),
    }
}

/// Area, boundary and shapes inside, in mm.
fn region_answer(region: &Region) -> RegionAnswer {
    RegionAnswer {
        area_mm2: to_mm2(region.area),
        boundary_mm: boundary(region),
        rectangle_mm: region.rectangle.map(|r| [in_plane(&r.lower), in_plane(&r.upper)]),
        circle_centre_mm: region.disc.map(|d| in_plane(&d.centre)),
        circle_radius_mm: region.disc.map(|d| without_rounding(to_mm(d.radius))),
    }
}

/// The region with [`COVERAGE`] standard uncertainties added to the deviations, and with as many subtracted.
fn certainty_answer(certainty: &Certainty) -> CertaintyAnswer {
    CertaintyAnswer {
        coverage_factor: COVERAGE,
        fraction_robustly_within: certainty.fraction_robust,
        fraction_possibly_within: certainty.fraction_possibly,
        fraction_expected_within: certainty.expected_fraction,
        area_robust_mm2: to_mm2(certainty.robust.area),
        boundary_robust_mm: boundary(&certainty.robust),
        area_possibly_mm2: to_mm2(certainty.possibly.area),
        boundary_possibly_mm: boundary(&certainty.possibly),
    }
}

/// The lines of a boundary, in mm.
fn boundary(region: &Region) -> Vec<Vec<[f64; 2]>> {
    let lines = region.boundary.iter();
    lines.map(|line| line.iter().map(in_plane).collect()).collect()
}

/// Part coordinates as y', z' in mm.
fn in_plane(at: &Point2<f64>) -> [f64; 2] {
    [without_rounding(to_mm(-at.x)), without_rounding(to_mm(at.y))]
}

/// Every point, row by row; deviations rounded to 1e-4 um, probabilities to as many decimals.
fn grid_answer(map: &PlaneMap, tolerance: f64) -> GridAnswer {
    let grid = &map.grid;
    let four_decimals = |value: f64| (value * 1e4).round() / 1e4;
    let of = |get: &dyn Fn(&Evaluation) -> Option<f64>| -> Vec<Option<f64>> {
        map.answers
            .points
            .iter()
            .map(|point| {
                let evaluation = point.as_ref().ok()?;
                get(evaluation).map(four_decimals)
            })
            .collect()
    };
    GridAnswer {
        points: grid.len(),
        y_mm: (0..grid.columns)
            .map(|i| without_rounding(to_mm(-grid.coordinate(i, grid.columns))))
            .collect(),
        z_mm: (0..grid.rows)
            .map(|i| without_rounding(to_mm(grid.coordinate(i, grid.rows))))
            .collect(),
        in_plane_um: of(&|evaluation| Some(to_um(evaluation.in_plane))),
        in_plane_u_um: of(&|evaluation| evaluation.in_plane_uncertainty.map(to_um)),
        probability_within: of(&|evaluation| probability_within(evaluation, tolerance)),
        normal_um: of(&|evaluation| Some(to_um(evaluation.normal))),
        full_um: of(&|evaluation| Some(to_um(evaluation.full))),
        flags: flags(map),
    }
}

/// Points that are not simply fine, by reason, in the order in which reasons first occur. A point may have two:
/// outside joint limits and near a singularity.
fn flags(map: &PlaneMap) -> Vec<PointFlag> {
    let mut flags: Vec<PointFlag> = Vec::new();
    let mut add = |reason: &str, index: usize| match flags.iter_mut().find(|r| r.reason == reason) {
        Some(remark) => remark.points.push(index),
        None => flags.push(PointFlag {
            reason: reason.to_owned(),
            points: vec![index],
        }),
    };
    for (index, point) in map.answers.points.iter().enumerate() {
        match point {
            Ok(evaluation) => {
                if !evaluation.within_limits() {
                    add("outside_joint_limits", index);
                }
                if evaluation.singularity.is_some() {
                    add("near_singularity", index);
                }
            }
            Err(miss) => add(miss.word(), index),
        }
    }
    flags
}

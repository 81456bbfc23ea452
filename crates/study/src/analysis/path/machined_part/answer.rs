//! The machined part in the answer: how far its surface is from the nominal one, where and why.
//!
//! Deviations are normal to the nominal surface: positive where material is left, negative where too much is removed. Coordinates are in the frame of the program. Means and fractions are by area.

use armill_core::machined::SurfaceDeviation;
use armill_core::nalgebra::Vector3;
use armill_core::removal::DexelDirections;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_um};
use schemars::JsonSchema;
use serde::Serialize;

use super::displacement::displacement_at;
use super::features::{SurfaceFeatureAnswer, features};
use super::roughness::ToothMarks;
use super::run::{MachinedPart, WorstPlace};
use super::scan_answer::ScanAnswer;
use super::setting::{MachinedSetting, NominalPart};
use super::thickness::{WallThicknessAnswer, thicknesses};
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::vibration::SeriesVibration;
use crate::analysis::words::motion_in_words;
use crate::number::without_rounding;

/// A part that comes out of a path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MachinedPartAnswer {
    /// What it is compared with: `program` or `part`.
    pub nominal: &'static str,
    /// Distance of the dexels.
    pub cell_mm: f64,
    /// Directions of the dexels: `all` or `z`.
    pub dexels: &'static str,
    /// Number of dexels.
    pub dexel_count: u64,
    /// Points of the nominal surface that are compared.
    pub points: usize,
    /// Their area.
    pub area_mm2: f64,
    /// Area where the deviation of the tool is not known: it is not included in any other value.
    pub unknown_area_mm2: f64,
    /// Nominal area that has no surface of the part within reach: material that is not cut, or a wall that is gone.
    pub missing_area_mm2: f64,
    /// Largest deviation outwards: material that is left.
    pub most_left_um: Option<f64>,
    /// Largest deviation inwards, negative: too much is removed.
    pub most_gouged_um: Option<f64>,
    /// Mean deviation.
    pub mean_um: Option<f64>,
    /// Root mean square deviation.
    pub rms_um: Option<f64>,
    /// Part of the area whose deviation is within the tolerance by size.
    pub fraction_within: Option<f64>,
    /// Profile of the surface (ISO 1101): twice the largest deviation by size.
    pub profile_um: Option<f64>,
    /// Volume that is removed from the stock.
    pub removed_mm3: f64,
    /// Material of the part outside of the nominal part.
    pub left_mm3: f64,
    /// Material of the nominal part that the part lacks.
    pub gouged_mm3: f64,
    /// Lines before which a rapid meets material.
    pub rapids_in_material: Vec<u32>,
    /// Lines at which shank or holder meets material.
    pub shank_in_material: Vec<u32>,
    /// The worst places, worst first, each from another part of the surface.
    pub worst_places: Vec<WorstPlaceAnswer>,
    /// The features of the path, on the surface that comes out.
    pub features: Vec<SurfaceFeatureAnswer>,
    /// Thickness of the walls that the study names.
    pub walls: Vec<WallThicknessAnswer>,
    /// Largest theoretical height of the marks of the teeth along the feed, of faces along the tool; none without a cut.
    pub feed_marks_um: Option<f64>,
    /// Largest vibration of the tool across its axis under its teeth, from its mean position: it adds at most twice this to the height of the roughness. None without `[vibration]`.
    pub vibration_um: Option<f64>,
    /// The measured part; none if the study names no scan.
    pub scan: Option<ScanAnswer>,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// A place of the surface with a large deviation, and why.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WorstPlaceAnswer {
    /// Place on the nominal surface, frame of the program.
    pub xyz_mm: [f64; 3],
    /// Nominal normal, out of the material.
    pub normal_axis: [f64; 3],
    /// Deviation along it.
    pub deviation_um: f64,
    /// Its standard uncertainty; none if it is not known.
    pub u_um: Option<f64>,
    /// Line of the program whose move makes the surface; none where the stock remains.
    pub line: Option<u32>,
    /// Number of the operation of that line, from 1; none in a program without operations.
    pub operation: Option<usize>,
    /// Why, in words.
    pub cause: String,
    /// Contribution of each contributor of the path's setting along the normal: they add up to the displacement of the tool.
    pub share_um: Vec<f64>,
}

/// Lines that are listed at most.
const MOST_LINES: usize = 20;
/// A displacement of the tool that explains less of the deviation is not its cause.
const EXPLAINED: f64 = 0.5;

impl MachinedPartAnswer {
    /// That of a path; none if the study does not ask for it.
    pub fn of(
        robot: &Robot,
        analysis: &PathAnalysis,
        found: &PathResult,
        vibration: Option<&SeriesVibration>,
    ) -> Option<MachinedPartAnswer> {
        let (machined, part) = (
            analysis.machined_part.as_deref()?,
            found.machined_part.as_deref()?,
        );
        let points = &part.surface.points;
        let marks = ToothMarks::of(part, found, vibration);
        let roughness = marks.roughness(points);
        let tolerance = analysis.setting.tolerance;
        let area: f64 = points.iter().map(|point| point.area).sum();
        let by_area = |of: &dyn Fn(&SurfaceDeviation) -> f64| {
            let sum: f64 = points.iter().map(|point| of(point) * point.area).sum();
            (area > 0.0).then(|| sum / area)
        };
        let deviations = || points.iter().map(|point| point.deviation);
        let largest = deviations().map(f64::abs).max_by(f64::total_cmp);
        let lines = |points: &[usize]| {
            let mut lines: Vec<u32> = points
                .iter()
                .map(|index| part.track.path.points[*index].line)
                .collect();
            lines.dedup();
            lines.truncate(MOST_LINES);
            lines
        };
        Some(MachinedPartAnswer {
            nominal: match machined.nominal {
                NominalPart::Program => "program",
                NominalPart::Mesh(_) => "part",
            },
            cell_mm: without_rounding(to_mm(machined.cell)),
            dexels: match machined.directions {
                DexelDirections::All => "all",
                DexelDirections::Z => "z",
            },
            dexel_count: machined.size.dexels as u64,
            points: points.len(),
            area_mm2: to_mm(to_mm(area)),
            unknown_area_mm2: to_mm(to_mm(part.unknown_area)),
            missing_area_mm2: to_mm(to_mm(part.surface.missing_area)),
            most_left_um: deviations()
                .max_by(f64::total_cmp)
                .map(|most| to_um(most.max(0.0))),
            most_gouged_um: deviations()
                .min_by(f64::total_cmp)
                .map(|most| to_um(most.min(0.0))),
            mean_um: by_area(&|point| point.deviation).map(to_um),
            rms_um: by_area(&|point| point.deviation.powi(2)).map(|square| to_um(square.sqrt())),
            fraction_within: by_area(&|point| f64::from(u8::from(point.deviation.abs() <= tolerance))),
            profile_um: largest.map(|largest| to_um(2.0 * largest)),
            removed_mm3: to_mm(to_mm(to_mm(part.removed))),
            left_mm3: to_mm(to_mm(to_mm(part.difference.left))),
            gouged_mm3: to_mm(to_mm(to_mm(part.difference.gouged))),
            rapids_in_material: lines(&part.contacts.rapids),
            shank_in_material: lines(&part.contacts.shank),
            worst_places: (part.worst.iter())
                .map(|worst| worst_place(robot, analysis, part, worst))
                .collect(),
            features: features(robot, analysis, part, &marks),
            walls: thicknesses(analysis, machined, part, &part.uncertainty(robot, analysis)),
            feed_marks_um: roughness.feed_marks.map(to_um),
            vibration_um: roughness.vibration.map(to_um),
            scan: ScanAnswer::of(robot, analysis, part),
            notes: notes(machined),
        })
    }
}

/// What was assumed of a part.
fn notes(machined: &MachinedSetting) -> Vec<String> {
    let mut notes = machined.notes.clone();
    if machined.directions == DexelDirections::Z {
        notes.push("dexels along z alone: the deviation of walls is not measured".to_owned());
    }
    notes
}

fn worst_place(
    robot: &Robot,
    analysis: &PathAnalysis,
    part: &MachinedPart,
    worst: &WorstPlace,
) -> WorstPlaceAnswer {
    let point = &worst.point;
    let index = point.made_by.move_index();
    let shares: Vec<f64> = worst.tool.as_ref().map_or_else(Vec::new, |(index, deviation)| {
        let along = |twist| displacement_at(&part.track, *index, &point.position, twist).dot(&point.normal);
        deviation.shares.iter().map(along).collect()
    });
    let operation = |index: usize| {
        let operations = &part.track.path.operations;
        let number = operations.partition_point(|(first, _)| *first <= index);
        (number > 0).then_some(number)
    };
    let vector = |vector: Vector3<f64>| vector.map(without_rounding).into();
    WorstPlaceAnswer {
        xyz_mm: vector(point.position.coords.map(to_mm)),
        normal_axis: vector(point.normal.into_inner()),
        deviation_um: to_um(point.deviation),
        u_um: part.uncertainty(robot, analysis)(point).map(to_um),
        line: index.map(|index| part.track.path.points[index].line),
        operation: index.and_then(operation),
        cause: cause(&analysis.setting.contributor_names(robot), point, &shares),
        share_um: shares.into_iter().map(to_um).collect(),
    }
}

/// Why the deviation is large: the contributor with the largest part of it, or what the tool does not reach.
fn cause(names: &[String], point: &SurfaceDeviation, shares: &[f64]) -> String {
    let displaced: f64 = shares.iter().sum();
    if point.made_by.move_index().is_none() {
        return "material that is not cut".to_owned();
    }
    if displaced / point.deviation < EXPLAINED {
        return "the tool as programmed leaves or removes it: its shape, the steps of the program, or an edge".to_owned();
    }
    let parts = names.iter().zip(shares);
    let Some((name, share)) =
        parts.max_by(|one, other| (one.1 / displaced).total_cmp(&(other.1 / displaced)))
    else {
        return String::new();
    };
    let name = motion_in_words(name).unwrap_or(name);
    format!("{name} {:.0} %", 100.0 * share / displaced)
}

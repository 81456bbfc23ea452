//! Contributions of joints, springs and motion to the deviation at the measured points of a part, after the alignment of the scan.
//!
//! ```text
//! c_j = n (t_j + r_j x (p - p_tip))                    of each contributor j, t_j and r_j its displacement and rotation of the tool
//! rest = predicted deviation - sum of c_j              shape of the tool, steps of the program, second order
//! alone = 1 - sum (m - c_j)^2 / sum m^2                without = 1 - sum (m - (p - c_j))^2 / sum m^2
//! ```
//!
//! `m` measured, `p` predicted deviation, both aligned. Every contribution is aligned in the same way, so that their sum is the aligned prediction.

use std::collections::BTreeMap;

use armill_core::form::{FormError, NominalSurface};
use armill_core::nalgebra::Point3;
use armill_core::path::Track;
use armill_core::source::Deviation;
use armill_core::units::to_um;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::displacement::displacement_at;
use super::mesh::PartMesh;
use super::scan::{MeshPlace, ScanComparison, aligned};
use super::setting::ScanSetting;

/// Deviations at points of a scan by one contributor, after alignment.
#[derive(Clone, Debug)]
pub struct ScanContribution {
    /// Its place among the contributors; none: what no contributor explains.
    pub contributor: Option<usize>,
    /// At the points of [`ScanContributions::points`], m.
    pub deviations: Vec<f64>,
}

/// All contributions.
#[derive(Clone, Debug, Default)]
pub struct ScanContributions {
    /// Points of the scan at which they are evaluated.
    pub points: Vec<usize>,
    /// One for each contributor, the rest last.
    pub contributions: Vec<ScanContribution>,
}

/// What a contributor explains of the measured deviations.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ScanContributionAnswer {
    /// The contributor, or `tool as programmed`.
    pub name: String,
    /// Largest deviation by it, with its sign.
    pub largest_um: f64,
    /// Root mean square.
    pub rms_um: f64,
    /// Share of the mean square of the measured deviations that it explains alone: below 0 if it is worse than nothing.
    // unit: dimensionless
    pub explained_alone: Option<f64>,
    /// Share that the prediction explains without it.
    // unit: dimensionless
    pub explained_without: Option<f64>,
}

/// Points at which contributions are evaluated.
const MOST_POINTS: usize = 20_000;
/// What no contributor explains.
const REST: &str = "tool as programmed";

/// The contributions at the points of `scan`; `at`: the deviation of the tool at a point of the path with its shares.
///
/// # Errors
/// Points that do not determine the alignment.
pub(super) fn contributions(
    (setting, nominal): (&ScanSetting, &NominalSurface),
    scan: &ScanComparison,
    (mesh, track): (&PartMesh, &Track),
    at: impl Fn(usize) -> Option<Deviation> + Sync,
) -> Result<ScanContributions, FormError> {
    let stride = scan.points.len().div_ceil(MOST_POINTS);
    let points: Vec<usize> = (0..scan.points.len()).step_by(stride).collect();
    let made_by: Vec<Option<usize>> = points
        .iter()
        .map(|point| move_at(mesh, &scan.places[*point]))
        .collect();
    let mut tools: BTreeMap<usize, Option<Deviation>> =
        made_by.iter().flatten().map(|index| (*index, None)).collect();
    tools
        .par_iter_mut()
        .for_each(|(index, deviation)| *deviation = at(*index));
    let deviations = || tools.values().flatten();
    let count = deviations().map(|of| of.shares.len()).max().unwrap_or(0);
    let along = |contributor: usize| -> Vec<f64> {
        let each = points.iter().zip(&made_by);
        each.map(|(point, made_by)| {
            let share = made_by
                .and_then(|index| Some((index, *tools.get(&index)?.as_ref()?.shares.get(contributor)?)));
            share.map_or(0.0, |(index, twist)| {
                displacement_at(track, index, &scan.points[*point], &twist).dot(&scan.normals[*point])
            })
        })
        .collect()
    };
    let all: Vec<Vec<f64>> = (0..count).map(along).collect();
    let rest = points.iter().enumerate().map(|(place, point)| {
        let sum: f64 = all.iter().map(|one| one[place]).sum();
        scan.unaligned[*point] - sum
    });
    let rest: Vec<f64> = rest.collect();
    let places: Vec<Point3<f64>> = points.iter().map(|point| scan.points[*point]).collect();
    let normals: Vec<_> = points.iter().map(|point| scan.normals[*point]).collect();
    let numbers = (0..count).map(Some).chain([None]);
    let contributions = all.iter().chain([&rest]).zip(numbers);
    let contributions = contributions.map(|(values, contributor)| {
        let (deviations, _) = aligned(setting, nominal, (&places, &normals), values)?;
        Ok(ScanContribution {
            contributor,
            deviations,
        })
    });
    Ok(ScanContributions {
        contributions: contributions.collect::<Result<_, FormError>>()?,
        points,
    })
}

/// The point of the path whose move made the surface at a place of the mesh: that of the nearest vertex.
pub(super) fn move_at(mesh: &PartMesh, place: &MeshPlace) -> Option<usize> {
    let nearest = (0..3).max_by(|one, other| place.weights[*one].total_cmp(&place.weights[*other]))?;
    Some(mesh.made_by[place.vertices[nearest] as usize]? as usize)
}

impl ScanContributions {
    /// In numbers; contributors without any effect are left out.
    pub(super) fn answer(&self, names: &[String], scan: &ScanComparison) -> Vec<ScanContributionAnswer> {
        let measured: Vec<f64> = self.points.iter().map(|point| scan.measured[*point]).collect();
        let predicted: Vec<f64> = self.points.iter().map(|point| scan.predicted[*point]).collect();
        let square = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>();
        let of_measured = square(&mut measured.iter().copied());
        let explained = |left: f64| (of_measured > 0.0).then(|| 1.0 - left / of_measured);
        let of = |contribution: &ScanContribution| {
            let by = &contribution.deviations;
            let alone = square(&mut measured.iter().zip(by).map(|(m, c)| m - c));
            let each = measured.iter().zip(&predicted).zip(by);
            let without = square(&mut each.map(|((m, p), c)| m - (p - c)));
            let largest = by
                .iter()
                .copied()
                .max_by(|one, other| one.abs().total_cmp(&other.abs()));
            let name = contribution
                .contributor
                .and_then(|contributor| names.get(contributor));
            ScanContributionAnswer {
                name: name.map_or_else(|| REST.to_owned(), Clone::clone),
                largest_um: to_um(largest.unwrap_or(0.0)),
                rms_um: to_um((square(&mut by.iter().copied()) / by.len().max(1) as f64).sqrt()),
                explained_alone: explained(alone),
                explained_without: explained(without),
            }
        };
        let with_effect =
            |contribution: &&ScanContribution| contribution.deviations.iter().any(|m| *m != 0.0);
        self.contributions.iter().filter(with_effect).map(of).collect()
    }
}

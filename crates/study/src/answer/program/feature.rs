//! What became of the features that a study marks in its program.

use armill_core::nalgebra::Vector3;
use armill_core::path::{Became, Strayed, became};
use serde::Serialize;

use super::super::point::tidy;
use super::Told;
use crate::file::program::FeatureTable;

/// What became of a feature under one load case.
#[derive(Clone, Debug, Serialize)]
pub struct FeatureResult {
    /// Its name.
    pub name: String,
    /// `circle`, `line`, `plane` or `hole`.
    pub kind: &'static str,
    /// The case, from 1.
    pub case: usize,
    /// Points that made it.
    pub points: usize,
    /// Circle: radius of the tool's path as programmed.
    pub radius_mm: Option<f64>,
    /// Circle: what it became larger by.
    pub radius_change_um: Option<f64>,
    /// How far its centre, axis or middle was moved; path axes. Of a line without the part along it, of a plane along the
    /// tool.
    pub shift_um: Option<[f64; 3]>,
    /// Circle: peak to valley about the least-squares circle.
    pub roundness_um: Option<f64>,
    /// Line: peak to valley across the tool.
    pub straightness_across_um: Option<f64>,
    /// Line: peak to valley along the tool.
    pub straightness_normal_um: Option<f64>,
    /// Plane: peak to valley.
    pub flatness_um: Option<f64>,
    /// Why there is no result.
    pub missing: Option<&'static str>,
}

impl Told<'_> {
    pub(super) fn features(&self) -> Vec<FeatureResult> {
        let cases = 0..self.found.answer.answers.case_count;
        let of = |feature: &FeatureTable| {
            let [first, last] = feature.lines;
            let points = &self.track().points;
            let within: Vec<usize> = (0..points.len())
                .filter(|i| (first..=last).contains(&points[*i].line))
                .collect();
            cases
                .clone()
                .map(|case| self.feature(feature, &within, case))
                .collect::<Vec<_>>()
        };
        self.ask.features.iter().flat_map(of).collect()
    }

    fn feature(&self, feature: &FeatureTable, points: &[usize], case: usize) -> FeatureResult {
        let kind = feature.kind.kind();
        let mut told = FeatureResult {
            name: feature.name.clone(),
            kind: feature.kind.word(),
            case: case + 1,
            points: points.len(),
            radius_mm: None,
            radius_change_um: None,
            shift_um: None,
            roundness_um: None,
            straightness_across_um: None,
            straightness_normal_um: None,
            flatness_um: None,
            missing: None,
        };
        let answers = &self.found.answer.answers;
        if points.iter().any(|i| answers.points[*i].is_err()) {
            told.missing = Some("not every point of it is reached");
            return told;
        }
        let path_from_base = self.track().placing.base_from_path.inverse();
        let strayed = |i: &usize| {
            let point = &self.track().points[*i];
            Strayed {
                at: point.at,
                axis: path_from_base.rotation * self.track().placing.spindle(point),
                by: path_from_base * answers.deviations_at(*i)[case],
            }
        };
        let strayed: Vec<Strayed> = points.iter().map(strayed).collect();
        let um = |v: Vector3<f64>| Some(v.map(|c| c * 1e6).into());
        match became(kind, &strayed) {
            Some(Became::Circle {
                radius,
                radius_change,
                centre_shift,
                roundness,
            }) => {
                told.radius_mm = Some(tidy(radius * 1e3));
                told.radius_change_um = Some(radius_change * 1e6);
                told.shift_um = um(centre_shift);
                told.roundness_um = Some(roundness * 1e6);
            }
            Some(Became::Line {
                straightness_across,
                straightness_normal,
                offset,
            }) => {
                told.straightness_across_um = Some(straightness_across * 1e6);
                told.straightness_normal_um = Some(straightness_normal * 1e6);
                told.shift_um = um(offset);
            }
            Some(Became::Plane { flatness, offset }) => {
                told.flatness_um = Some(flatness * 1e6);
                let normal = strayed.first().map_or_else(Vector3::z, |p| p.axis.into_inner());
                told.shift_um = um(normal * offset);
            }
            Some(Became::Hole { shift }) => told.shift_um = um(shift),
            None => told.missing = Some("its points make no such feature"),
        }
        told
    }
}

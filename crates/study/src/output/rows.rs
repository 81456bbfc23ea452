//! The points of an analysis in sequence, as every table and picture needs them.
//!
//! A map, a volume, a path and a set of holes are one series, sections one each. Positions are in the reference frame
//! of the study; the order of the points is that of the answers: planes row by row, boxes x first, then y, then z,
//! paths along the track.

use std::ops::Range;

use armill_core::kernel::{Answers, Evaluation};
use armill_core::map::PlaneMap;
use armill_core::nalgebra::Point3;
use armill_core::optimize::HolesFound;
use armill_core::path::Track;

use crate::file::holes::HolesAnalysis;
use crate::file::path::PathAnalysis;
use crate::file::resolve::Setting;
use crate::number::decimals;
use crate::run::{AnalysisData, PathResult, Section};

/// Significant decimals of a position, mm: the rest is rounding of frame changes.
pub(super) const MM_DECIMALS: u8 = 6;

/// One series of points that share a setting: a map, a section, a volume or a path.
pub(super) struct Rows<'a> {
    /// Label of the section; empty otherwise.
    pub label: String,
    /// What its points share.
    pub setting: &'a Setting,
    /// The answers.
    pub answers: &'a Answers,
    /// TCP of each point, mm, in the reference frame of the study.
    pub at_mm: Vec<[f64; 3]>,
    /// The path of the points and its result.
    pub path: Option<(&'a PathAnalysis, &'a PathResult)>,
    /// The holes of the points.
    pub holes: Option<(&'a HolesAnalysis, &'a HolesFound)>,
}

impl<'a> Rows<'a> {
    /// The answers at these points, m, base.
    fn new(
        label: &str,
        setting: &'a Setting,
        answers: &'a Answers,
        points: impl Iterator<Item = Point3<f64>>,
    ) -> Rows<'a> {
        let mm = |at: Point3<f64>| {
            setting
                .in_reference(&at)
                .coords
                .map(|c| decimals(c * 1e3, i32::from(MM_DECIMALS)))
                .into()
        };
        Rows {
            label: label.to_owned(),
            setting,
            answers,
            at_mm: points.map(mm).collect(),
            path: None,
            holes: None,
        }
    }

    /// State of a point relative to the tolerance.
    pub(super) fn state(&self, index: usize) -> &'static str {
        match &self.answers.points[index] {
            Ok(evaluation) if evaluation.in_plane <= self.setting.tolerance => "within",
            Ok(_) => "above_tolerance",
            Err(miss) => miss.word(),
        }
    }
}

/// A value of each point of several series, one series after the other.
pub(super) fn of_points<T>(series: &[Rows<'_>], value: impl Fn(&Rows<'_>, usize) -> T) -> Vec<T> {
    let mut values = Vec::with_capacity(series.iter().map(|rows| rows.at_mm.len()).sum());
    for rows in series {
        values.extend((0..rows.at_mm.len()).map(|index| value(rows, index)));
    }
    values
}

/// A number of each of these points that has a posture.
pub(super) fn of_reached<'r>(
    rows: &'r Rows<'_>,
    points: Range<usize>,
    value: impl Fn(&Rows<'_>, usize, &Evaluation) -> f64 + 'r,
) -> impl Iterator<Item = Option<f64>> + 'r {
    points.map(move |index| {
        let evaluation = rows.answers.points[index].as_ref().ok()?;
        Some(value(rows, index, evaluation)).filter(|value| value.is_finite())
    })
}

/// Position of the tip at the points of a track, m, base.
fn tips(track: &Track) -> impl Iterator<Item = Point3<f64>> + '_ {
    let base_from_path = track.placing.base_from_path;
    track
        .path
        .points
        .iter()
        .map(move |point| base_from_path * point.at)
}

/// Every series of points of a result.
pub(super) fn rows<'a>(found: &'a AnalysisData<'_>) -> Vec<Rows<'a>> {
    let map = |label: &str, setting: &'a Setting, map: &'a PlaneMap| {
        let points = (0..map.grid.len()).map(|index| map.plane.at(map.grid.point(index)));
        Rows::new(label, setting, &map.answers, points)
    };
    match found {
        AnalysisData::Map(sheet, found) => vec![map("", &sheet.setting, found)],
        AnalysisData::Sections(sections) => {
            let section = |section: &'a Section<'_>| map(section.label, &section.sheet.setting, &section.map);
            sections.iter().map(section).collect()
        }
        AnalysisData::Volume(setting, volume) => {
            let points = (0..volume.grid.len()).map(|index| volume.grid.point(index));
            vec![Rows::new("", setting, &volume.answers, points)]
        }
        AnalysisData::Path(analysis, found) => vec![Rows {
            path: Some((analysis, found)),
            ..Rows::new("", &analysis.setting, &found.along.answers, tips(&analysis.track))
        }],
        AnalysisData::Holes(analysis, found) => vec![Rows {
            holes: Some((analysis, found)),
            ..Rows::new(
                "",
                &analysis.path.setting,
                &found.answers,
                tips(&analysis.path.track),
            )
        }],
    }
}

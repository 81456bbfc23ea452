//! The points of an ask, one after the other, as every table and picture needs them.
//!
//! A map, a volume, a path and a set of holes are one series, sections one each. Positions are in the frame that the study counts from;
//! the order of the points is that of the answers: planes row by row, boxes x first, then y, then z, paths along the
//! track.

use std::ops::Range;

use armill_core::kernel::{Answers, Held};
use armill_core::map::PlaneMap;
use armill_core::nalgebra::Point3;
use armill_core::optimize::HolesFound;
use armill_core::path::Track;

use crate::file::holes::HolesAnalysis;
use crate::file::path::PathAnalysis;
use crate::file::resolve::Setting;
use crate::number::decimals;
use crate::run::{Found, PathFound, Section};

/// Decimals of a position, mm, that mean something: what changes of frame leave behind them is no length.
pub(super) const MM_DECIMALS: u8 = 6;

/// One series of points that share a setting: a map, a section, a volume or a path.
pub(super) struct Rows<'a> {
    /// Label of the section; empty otherwise.
    pub label: String,
    /// What its points share.
    pub setting: &'a Setting,
    /// What came out.
    pub answers: &'a Answers,
    /// TCP of each point, mm, in the frame that the study counts from.
    pub at_mm: Vec<[f64; 3]>,
    /// The path whose points they are, and what came out along it.
    pub path: Option<(&'a PathAnalysis, &'a PathFound)>,
    /// The holes that they are, likewise.
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
                .counted(&at)
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

    /// Points against the limit, by reason.
    pub(super) fn state(&self, index: usize) -> &'static str {
        match &self.answers.points[index] {
            Ok(evaluation) if evaluation.in_plane <= self.setting.limit => "within",
            Ok(_) => "above_tolerance",
            Err(miss) => miss.word(),
        }
    }
}

/// Something of each point of several series, one series after the other.
pub(super) fn of_points<T>(series: &[Rows<'_>], value: impl Fn(&Rows<'_>, usize) -> T) -> Vec<T> {
    let mut values = Vec::with_capacity(series.iter().map(|rows| rows.at_mm.len()).sum());
    for rows in series {
        values.extend((0..rows.at_mm.len()).map(|index| value(rows, index)));
    }
    values
}

/// A number of each of these points that has a posture.
pub(super) fn of_held<'r>(
    rows: &'r Rows<'_>,
    points: Range<usize>,
    value: impl Fn(&Rows<'_>, usize, &Held) -> f64 + 'r,
) -> impl Iterator<Item = Option<f64>> + 'r {
    points.map(move |index| {
        let evaluation = rows.answers.points[index].as_ref().ok()?;
        Some(value(rows, index, evaluation)).filter(|value| value.is_finite())
    })
}

/// Where the tip stands at the points of a track, m, base.
fn tips(track: &Track) -> impl Iterator<Item = Point3<f64>> + '_ {
    let base_from_path = track.placing.base_from_path;
    track
        .path
        .points
        .iter()
        .map(move |point| base_from_path * point.at)
}

/// Every series of points of what was found.
pub(super) fn rows<'a>(found: &'a Found<'_>) -> Vec<Rows<'a>> {
    let map = |label: &str, setting: &'a Setting, map: &'a PlaneMap| {
        let points = (0..map.grid.len()).map(|index| map.plane.at(map.grid.point(index)));
        Rows::new(label, setting, &map.answers, points)
    };
    match found {
        Found::Map(sheet, found) => vec![map("", &sheet.setting, found)],
        Found::Sections(sections) => {
            let section = |section: &'a Section<'_>| map(section.label, &section.sheet.setting, &section.map);
            sections.iter().map(section).collect()
        }
        Found::Volume(setting, volume) => {
            let points = (0..volume.grid.len()).map(|index| volume.grid.point(index));
            vec![Rows::new("", setting, &volume.answers, points)]
        }
        Found::Path(analysis, found) => vec![Rows {
            path: Some((analysis, found)),
            ..Rows::new("", &analysis.setting, &found.along.answers, tips(&analysis.track))
        }],
        Found::Holes(analysis, found) => vec![Rows {
            holes: Some((analysis, found)),
            ..Rows::new("", &analysis.path.setting, &found.answers, tips(&analysis.path.track))
        }],
    }
}

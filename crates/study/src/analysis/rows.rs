//! The points of an analysis in sequence, as every table and picture needs them.
//!
//! A map, a volume, a path and a set of holes are one series, sections one each. Positions are in the reference frame
//! of the study; the order of the points is that of the answers: planes row by row, boxes x first, then y, then z,
//! paths along the track.

use std::ops::Range;

use armill_core::kernel::{Answers, Evaluation, PostureStatus};
use armill_core::map::{PlaneMap, VolumeMap};
use armill_core::nalgebra::Point3;
use armill_core::optimize::HolesFound;
use armill_core::path::Track;
use armill_core::robot::Unreachable;
use armill_core::units::to_mm;

use crate::analysis::vibration::points::SeriesVibration;
use crate::input::setting::Setting;
use crate::number::decimals;

/// Significant decimals of a position, mm: the rest is rounding of frame changes.
pub const MM_DECIMALS: u8 = 6;

/// One series of points that share a setting: a map, a section, a volume or a path.
pub struct Rows<'a> {
    /// Label of the section; empty otherwise.
    pub label: String,
    /// What its points share.
    pub setting: &'a Setting,
    /// The answers.
    pub answers: &'a Answers,
    /// TCP of each point, mm, in the reference frame of the study.
    pub at_mm: Vec<[f64; 3]>,
    /// How they are arranged.
    pub layout: Layout,
    /// Their vibration, if the study asks for it.
    pub vibration: Option<&'a SeriesVibration>,
    /// Of each hole, whether its posture can be used; empty for other points.
    statuses: &'a [PostureStatus],
}

/// How the points of a series are arranged.
#[derive(Clone, Debug, PartialEq)]
pub enum Layout {
    /// A grid on a plane, row by row.
    Plane {
        /// Points in a row.
        columns: usize,
        /// Rows.
        rows: usize,
    },
    /// A grid in space: x first, then y, then z.
    Box {
        /// Its first point, mm, in the reference frame of the study.
        origin_mm: [f64; 3],
        /// Distance of its points.
        step_mm: f64,
        /// Points along x, y, z.
        counts: [usize; 3],
    },
    /// Lines through consecutive points, each a range of them.
    Lines(Vec<Range<usize>>),
    /// Points that nothing joins.
    Points,
}

impl<'a> Rows<'a> {
    /// The answers at these points, m, base.
    fn new(
        label: &str,
        setting: &'a Setting,
        answers: &'a Answers,
        layout: Layout,
        points: impl Iterator<Item = Point3<f64>>,
    ) -> Rows<'a> {
        let mm = |at: Point3<f64>| {
            setting
                .in_reference(&at)
                .coords
                .map(|c| decimals(to_mm(c), i32::from(MM_DECIMALS)))
                .into()
        };
        Rows {
            label: label.to_owned(),
            setting,
            answers,
            at_mm: points.map(mm).collect(),
            layout,
            vibration: None,
            statuses: &[],
        }
    }

    /// The same with the vibration of its points.
    pub fn with_vibration(self, vibration: Option<&'a SeriesVibration>) -> Rows<'a> {
        Rows { vibration, ..self }
    }

    /// The points of a plane.
    pub fn of_map(label: &str, setting: &'a Setting, map: &'a PlaneMap) -> Rows<'a> {
        let points = (0..map.grid.len()).map(|index| map.plane.at(map.grid.point(index)));
        let layout = Layout::Plane {
            columns: map.grid.columns,
            rows: map.grid.rows,
        };
        Rows::new(label, setting, &map.answers, layout, points)
    }

    /// The points of a box.
    pub fn of_volume(setting: &'a Setting, volume: &'a VolumeMap) -> Rows<'a> {
        let points = (0..volume.grid.len()).map(|index| volume.grid.point(index));
        let layout = Layout::Box {
            origin_mm: setting
                .in_reference(&volume.grid.corner())
                .coords
                .map(to_mm)
                .into(),
            step_mm: to_mm(volume.grid.step),
            counts: volume.grid.counts,
        };
        Rows::new("", setting, &volume.answers, layout, points)
    }

    /// The tips along a path, joined between rapids.
    pub fn of_path(setting: &'a Setting, track: &Track, answers: &'a Answers) -> Rows<'a> {
        let lines = Layout::Lines(track.path.stretches().collect());
        Rows::new("", setting, answers, lines, tips(track))
    }

    /// The tips at the ends of holes.
    pub fn of_holes(setting: &'a Setting, track: &Track, found: &'a HolesFound) -> Rows<'a> {
        Rows {
            statuses: &found.statuses,
            ..Rows::new("", setting, &found.answers, Layout::Points, tips(track))
        }
    }

    /// The points of each line; none of another layout.
    pub fn lines(&self) -> Vec<Vec<[f64; 3]>> {
        match &self.layout {
            Layout::Lines(lines) => lines
                .iter()
                .map(|line| self.at_mm[line.clone()].to_vec())
                .collect(),
            _ => Vec::new(),
        }
    }

    /// Its [`state`].
    pub fn state(&self, index: usize) -> &'static str {
        let point = &self.answers.points[index];
        state(point, self.statuses.get(index).copied(), self.setting.tolerance)
    }
}

/// State of a point relative to the `tolerance` (m), or why its posture of this `status` cannot be used, or why there is none.
pub fn state(
    point: &Result<Evaluation, Unreachable>,
    status: Option<PostureStatus>,
    tolerance: f64,
) -> &'static str {
    match (point, status) {
        (Err(miss), _) => miss.word(),
        (Ok(_), Some(status)) if status != PostureStatus::Usable => status.word(),
        (Ok(evaluation), _) if evaluation.in_plane <= tolerance => "within",
        (Ok(_), _) => "above_tolerance",
    }
}

/// A value of each point of several series, one series after the other.
pub fn of_points<T>(series: &[Rows<'_>], value: impl Fn(&Rows<'_>, usize) -> T) -> Vec<T> {
    let mut values = Vec::with_capacity(series.iter().map(|rows| rows.at_mm.len()).sum());
    for rows in series {
        values.extend((0..rows.at_mm.len()).map(|index| value(rows, index)));
    }
    values
}

/// A number of each of these points that has a posture; none where it is not known.
pub fn of_reached<'r, V: Into<Option<f64>>>(
    rows: &'r Rows<'_>,
    points: Range<usize>,
    value: impl Fn(&Rows<'_>, usize, &Evaluation) -> V + 'r,
) -> impl Iterator<Item = Option<f64>> + 'r {
    points.map(move |index| {
        let evaluation = rows.answers.points[index].as_ref().ok()?;
        value(rows, index, evaluation)
            .into()
            .filter(|value| value.is_finite())
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

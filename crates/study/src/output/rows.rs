//! The points of an ask, one after the other, as every table and picture needs them.

use std::ops::Range;

use armill_core::kernel::{Answers, Held};
use armill_core::map::PlaneMap;
use armill_core::nalgebra::Point3;

use crate::file::program::ProgramAsk;
use crate::file::resolve::{Ask, Setting, Subject};
use crate::run::Found;

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
    /// The program whose points they are.
    pub program: Option<&'a ProgramAsk>,
}

impl<'a> Rows<'a> {
    /// The answers at these points, m, base.
    fn new(
        label: &str,
        setting: &'a Setting,
        answers: &'a Answers,
        points: impl Iterator<Item = Point3<f64>>,
    ) -> Rows<'a> {
        let mm = |at: Point3<f64>| setting.counted(&at).coords.map(|c| rounded(c * 1e3)).into();
        Rows {
            label: label.to_owned(),
            setting,
            answers,
            at_mm: points.map(mm).collect(),
            program: None,
        }
    }

    /// Points against the limit, by reason.
    pub(super) fn state(&self, index: usize) -> &'static str {
        match &self.answers.points[index] {
            Ok(held) if held.in_plane <= self.setting.limit => "within",
            Ok(_) => "over_limit",
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
        let held = rows.answers.points[index].as_ref().ok()?;
        Some(value(rows, index, held)).filter(|value| value.is_finite())
    })
}

/// A length without the rounding of frame changes.
fn rounded(value: f64) -> f64 {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Every series of points of an ask.
pub(super) fn rows<'a>(ask: &'a Ask, found: &'a Found) -> Vec<Rows<'a>> {
    let map = |label: &str, setting: &'a Setting, map: &'a PlaneMap| {
        let points = (0..map.grid.len()).map(|index| map.plane.at(map.grid.point(index)));
        Rows::new(label, setting, &map.answers, points)
    };
    match (&ask.subject, found) {
        (Subject::Map(sheet), Found::Map(found)) => vec![map("", &sheet.setting, found)],
        (Subject::Sections(sections), Found::Sections(found)) => sections
            .iter()
            .zip(found)
            .map(|((label, sheet), found)| map(label, &sheet.setting, found))
            .collect(),
        (Subject::Volume(setting, _), Found::Volume(volume)) => {
            let points = (0..volume.grid.len()).map(|index| volume.grid.point(index));
            vec![Rows::new("", setting, &volume.answers, points)]
        }
        (Subject::Path(setting, ..), Found::Path(path)) => {
            let points = path.samples.iter().map(|sample| path.plane.at(sample.at));
            vec![Rows::new("", setting, &path.answers, points)]
        }
        (Subject::Program(program), Found::Program(found)) => {
            let track = &program.track;
            let points = track
                .points
                .iter()
                .map(|point| track.placing.base_from_path * point.at);
            vec![Rows {
                program: Some(program),
                ..Rows::new("", &program.setting, &found.answer.answers, points)
            }]
        }
        _ => Vec::new(),
    }
}

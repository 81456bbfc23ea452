//! The points of an ask, one after the other, as every table and picture needs them.

use armill_core::kernel::{Answers, Held};
use armill_core::nalgebra::Point3;
use armill_core::robot::Unreachable;

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
    /// TCP of each point, m, base.
    pub tcp: Vec<Point3<f64>>,
}

impl Rows<'_> {
    /// Points against the limit, by reason.
    pub(super) fn state(&self, index: usize) -> &'static str {
        match &self.answers.points[index] {
            Ok(held) if held.in_plane <= self.setting.limit => "within",
            Ok(_) => "over_limit",
            Err(Unreachable::OutsideLimits { .. }) => "no_posture_inside_limits",
            Err(miss) => miss.reason(),
        }
    }

    /// A value of each point that has a posture.
    pub(super) fn of_held(&self, value: impl Fn(usize, &Held) -> f64) -> Vec<Option<f64>> {
        let of = |(index, point): (usize, &Result<Held, Unreachable>)| {
            point
                .as_ref()
                .ok()
                .map(|held| value(index, held))
                .filter(|value| value.is_finite())
        };
        self.answers.points.iter().enumerate().map(of).collect()
    }
}

/// Every series of points of an ask.
pub(super) fn rows<'a>(ask: &'a Ask, found: &'a Found) -> Vec<Rows<'a>> {
    let map = |label: &str, setting: &'a Setting, map: &'a armill_core::map::PlaneMap| {
        let at = |index| {
            map.plane
                .base_from_tool(map.grid.point(index), 0.0)
                .translation
                .vector
                .into()
        };
        let tcp = (0..map.grid.len()).map(at).collect();
        Rows {
            label: label.to_owned(),
            setting,
            answers: &map.answers,
            tcp,
        }
    };
    match (&ask.subject, found) {
        (Subject::Map(sheet), Found::Map(found)) => vec![map("", &sheet.setting, found)],
        (Subject::Sections(sections), Found::Sections(found)) => sections
            .iter()
            .zip(found)
            .map(|((label, sheet), found)| map(label, &sheet.setting, found))
            .collect(),
        (Subject::Volume(setting, _), Found::Volume(volume)) => {
            let tcp = (0..volume.grid.len())
                .map(|index| volume.grid.point(index))
                .collect();
            vec![Rows {
                label: String::new(),
                setting,
                answers: &volume.answers,
                tcp,
            }]
        }
        (Subject::Path(setting, ..), Found::Path(path)) => {
            let at = |s: &armill_core::path::Sample| {
                path.plane.base_from_tool(s.at, 0.0).translation.vector.into()
            };
            let tcp = path.samples.iter().map(at).collect();
            vec![Rows {
                label: String::new(),
                setting,
                answers: &path.answers,
                tcp,
            }]
        }
        _ => Vec::new(),
    }
}

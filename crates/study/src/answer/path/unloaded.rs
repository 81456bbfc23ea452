//! What moves the tool along a path beside its load: backlash and geometry.

use armill_core::optimize::reversals;
use schemars::JsonSchema;
use serde::Serialize;

use crate::file::path::PathAnalysis;
use crate::file::resolve::Study;
use crate::run::PathFound;

/// What moves the tool beside its load; the deviations of the path have it too.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct UnloadedAnswer {
    /// Largest displacement across the tool, all cases.
    pub max_in_plane_um: f64,
    /// Largest length of it.
    pub max_full_um: f64,
    /// Every joint that has play.
    pub joints: Vec<PlayAnswer>,
    /// Whether the arm differs from the one that its controller reckons with.
    pub measured_arm: bool,
}

/// The play of one joint.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlayAnswer {
    /// Its name.
    pub name: String,
    /// The whole gap of a joint that turns.
    pub backlash_deg: Option<f64>,
    /// The whole gap of a joint that slides.
    pub backlash_mm: Option<f64>,
    /// Times that the joint turns back on the cuts of the path.
    pub reversals: usize,
}

impl UnloadedAnswer {
    /// What it was along this path; `None` where load and gravity alone move the tool.
    pub(super) fn of(study: &Study, analysis: &PathAnalysis, found: &PathFound) -> Option<UnloadedAnswer> {
        let unloaded = found.along.unloaded.as_ref()?;
        let robot = &study.robot.robot;
        let cases = found.along.answers.case_count;
        let in_plane = |(at, moved): (usize, &armill_core::nalgebra::Vector3<f64>)| {
            let parts = analysis.track.parts(at / cases, moved);
            parts.along.hypot(parts.cross)
        };
        let turned_back = reversals(&analysis.track.path, &found.along.answers);
        let model = &analysis.setting.model;
        let play = model.structure.gaps().map(|(joint, backlash)| {
            let slides = robot.slides(joint);
            PlayAnswer {
                name: robot.joints()[joint].name.clone(),
                backlash_deg: (!slides).then(|| backlash.gap.to_degrees()),
                backlash_mm: slides.then_some(backlash.gap * 1e3),
                reversals: turned_back[joint],
            }
        });
        Some(UnloadedAnswer {
            max_in_plane_um: unloaded
                .moved
                .iter()
                .enumerate()
                .map(in_plane)
                .fold(0.0, f64::max)
                * 1e6,
            max_full_um: unloaded
                .moved
                .iter()
                .map(armill_core::nalgebra::Vector3::norm)
                .fold(0.0, f64::max)
                * 1e6,
            joints: play.collect(),
            measured_arm: model.actual.is_some(),
        })
    }
}

//! The result of a compensation, in numbers and sentences.

use std::fmt::Write as _;

use armill_core::source::StiffnessModel;
use armill_study::file::resolve::Study;
use serde::Serialize;

use super::{Commanded, CompensatedPath, CompensatedSurface};

/// Result of the compensation of the paths of a study.
#[derive(Clone, Debug, Serialize)]
pub struct CompensationAnswer {
    /// Every path that was compensated.
    pub paths: Vec<CompensatedPath>,
    /// Whether the joint compliances are assumed, not measured: so are the corrections then.
    pub compliance_assumed: bool,
    /// Whether the robot file gives the backlash of its joints: the correction then includes it.
    pub backlash: bool,
    /// Whether the study names the calibrated robot: its geometry is then part of the correction.
    pub geometry: bool,
}

impl CompensationAnswer {
    /// That of all paths and sets of holes of the study that were compensated.
    pub fn of(study: &Study, commanded: &[Commanded<'_>]) -> CompensationAnswer {
        let any = |known: fn(&StiffnessModel) -> bool| commanded.iter().any(|one| known(&one.setting.model));
        CompensationAnswer {
            backlash: any(|model| model.structure.joints_with_backlash().next().is_some()),
            geometry: any(|model| model.actual.is_some()),
            paths: commanded.iter().map(|one| one.given.clone()).collect(),
            compliance_assumed: study.compliance_is_assumed(),
        }
    }

    /// A sentence for each path, what the prediction contains, and cautions.
    pub fn sentences(&self) -> Vec<String> {
        let mut lines: Vec<String> = self
        .paths
        .iter()
        .map(|path| match path.rounds {
            0 => format!(
                "{}: not compensated; largest deviation of the tool {:.1} µm ({:.1} µm rms)",
                path.name, path.before.max_um, path.before.rms_um
            ),
            _ => format!(
                "{}: largest deviation of the tool {:.1} µm ({:.1} µm rms), compensated {:.2} µm ({:.2} µm rms); points move by up to {:.1} µm",
                path.name, path.before.max_um, path.before.rms_um, path.after.max_um, path.after.rms_um, path.largest_correction_um
            ),
        })
        .collect();
        for path in &self.paths {
            let name = &path.name;
            lines.extend(path.surface.iter().map(|surface| {
                let CompensatedSurface { before, after } = surface;
                format!(
                    "{name}: surface of the part between {:+.1} and {:+.1} µm ({:.1} µm rms), compensated between {:+.1} and {:+.1} µm ({:.1} µm rms), cut again in the model",
                    before.most_gouged_um, before.most_left_um, before.rms_um, after.most_gouged_um, after.most_left_um, after.rms_um
                )
            }));
            let collisions = path.collisions.as_ref().map_or(0, |collisions| collisions.points);
            let out_of_reach = path.unreachable - collisions;
            if out_of_reach + path.outside_joint_limits > 0 {
                lines.push(format!(
                    "{name}: {out_of_reach} of {} points are out of reach and remain unchanged; {} are outside joint limits",
                    path.points, path.outside_joint_limits
                ));
            }
            lines.extend(path.collisions.iter().map(|collisions| {
                format!(
                    "{name}: {} of {} points remain unchanged, since no posture keeps the demanded clearance; at the worst {}",
                    collisions.points, path.points, collisions.in_words
                )
            }));
        }
        lines.extend(self.paths.iter().flat_map(in_place));
        let parts = [
            (self.backlash, "backlash"),
            (self.geometry, "the geometric errors of the robot"),
        ];
        let named = |counts: bool| {
            parts
                .iter()
                .filter(move |part| part.0 == counts)
                .map(|part| part.1)
        };
        let within = ["elastic deviation"].into_iter().chain(named(true));
        let mut known = format!("Predicted from {}", within.collect::<Vec<_>>().join(", "));
        let without: Vec<&str> = named(false).collect();
        if !without.is_empty() {
            let _ = write!(known, "; not known and not included: {}", without.join(", "));
        }
        lines.push(known + ".");
        if self.compliance_assumed {
            lines.push(
                "The joint compliances are assumed, not measured: do not send such a path to a robot."
                    .to_owned(),
            );
        }
        lines
    }
}

/// Result for a path from a robot program.
fn in_place(path: &CompensatedPath) -> Vec<String> {
    let written = path.in_place.iter().map(|given| {
        format!(
            "{}: {} written with {} changed targets; largest deviation of its moves {:.2} µm ({:.2} µm rms)",
            path.name,
            given.files.join(", "),
            given.moved_targets,
            given.after.max_um,
            given.after.rms_um
        )
    });
    let notes = path
        .in_place
        .iter()
        .flat_map(|given| &given.notes)
        .chain(&path.notes);
    written.chain(notes.map(|note| format!("note: {note}"))).collect()
}

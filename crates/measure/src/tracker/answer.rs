//! What the files of a tracker have together.

use armill_core::measure::reflectors::{Body, Misreading};
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_um};
use armill_study::number::decimals;
use serde::Serialize;

use super::together::Together;

/// What the files of a tracker have together.
#[derive(Clone, Debug, Serialize)]
pub struct TrackerAnswer {
    /// Name of the robot.
    pub robot: String,
    /// Number of poses.
    pub poses: usize,
    /// Whether orientations were measured.
    pub has_orientations: bool,
    /// The reflectors on the tool.
    pub tool: Option<BodyAnswer>,
    /// The reflectors on the base.
    pub base: Option<BodyAnswer>,
    /// Ignored columns.
    pub unused: Vec<String>,
    /// Notes on these numbers.
    pub notes: Vec<String>,
    /// Sources of the methods.
    pub sources: Vec<&'static str>,
}

/// Three reflectors on a body.
#[derive(Clone, Debug, Serialize)]
pub struct BodyAnswer {
    /// Distances 1-2, 1-3, 2-3.
    pub distances_mm: [f64; 3],
    /// Robust standard deviation of the distances.
    pub scatter_um: [f64; 3],
    /// Slow change of the distances.
    pub drift_um: [f64; 3],
    /// Number of the reflector that drifts on the body, if one does.
    pub drifting: Option<usize>,
    /// Largest displacement of the body in the frame of the tracker; of a base.
    pub moved_um: Option<f64>,
    /// Misreadings, replaced by where the body was at the reading before.
    pub misread: Vec<MisreadAnswer>,
    /// Rows with more than one wrong reflector: they have the pose of the row before.
    pub undetermined_rows: Vec<usize>,
}

/// A reading that does not belong to its reflector.
#[derive(Clone, Debug, Serialize)]
pub struct MisreadAnswer {
    /// Row, from 1.
    pub row: usize,
    /// Reflector: 1, 2, 3.
    pub reflector: usize,
    /// Distance from where the body has it.
    pub distance_mm: f64,
}

/// The numbers of what was read.
pub fn answer(robot: &Robot, together: &Together) -> TrackerAnswer {
    let base = together.base.as_ref().map(|base| {
        let first = base
            .poses
            .first()
            .map(|pose| pose.translation.vector)
            .unwrap_or_default();
        let moved = base
            .poses
            .iter()
            .map(|pose| (pose.translation.vector - first).norm());
        body(base, Some(moved.fold(0.0, f64::max)))
    });
    let mut notes = Vec::new();
    let bodies = [("tool", together.tool.as_ref()), ("base", together.base.as_ref())];
    for (name, found) in bodies {
        let Some(found) = found else { continue };
        for reflector in 0..3 {
            let rows: Vec<String> = (found.misread.iter())
                .filter(|one| one.reflector == reflector)
                .map(|one| (one.pose + 1).to_string())
                .collect();
            if !rows.is_empty() {
                notes.push(format!(
                    "{name}: reflector {} is misread in rows {}: its distances to both others are wrong there, and theirs is not; it is replaced",
                    reflector + 1,
                    rows.join(", ")
                ));
            }
        }
        if let Some(reflector) = found.drifting() {
            notes.push(format!(
                "{name}: reflector {} drifts on its body: its distances to both others change, and theirs does not; mount it again, or measure without it",
                reflector + 1
            ));
        }
    }
    TrackerAnswer {
        robot: robot.name().to_owned(),
        poses: together.poses.len(),
        has_orientations: together.poses.iter().all(|pose| pose.rotation.is_some()),
        tool: together.tool.as_ref().map(|tool| body(tool, None)),
        base,
        unused: together.unused.clone(),
        notes,
        sources: vec!["Kabsch 1976: Acta Cryst. A32; Rousseeuw and Croux 1993: J. Am. Stat. Assoc. 88"],
    }
}

fn body(found: &Body, moved: Option<f64>) -> BodyAnswer {
    let um = |length: f64| decimals(to_um(length), 1);
    let [a, b, c] = found.triangle;
    let misread = |one: &Misreading| MisreadAnswer {
        row: one.pose + 1,
        reflector: one.reflector + 1,
        distance_mm: decimals(to_mm(one.distance), 3),
    };
    BodyAnswer {
        distances_mm: [(a - b).norm(), (a - c).norm(), (b - c).norm()]
            .map(|length| decimals(to_mm(length), 3)),
        scatter_um: found.scatter.map(um),
        drift_um: found.drift.map(um),
        drifting: found.drifting().map(|reflector| reflector + 1),
        moved_um: moved.map(um),
        misread: found.misread.iter().map(misread).collect(),
        undetermined_rows: found.undetermined.iter().map(|row| row + 1).collect(),
    }
}

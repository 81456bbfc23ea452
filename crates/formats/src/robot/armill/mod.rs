//! armill's own robot file, format 1: TOML, the chain as ordered elementary motions, a source for every number.
//!
//! Lengths in mm, angles in degrees, compliances in rad/(N m); a prismatic joint uses mm and um/N instead. What
//! deflects and has mass in addition to the drives (springs, masses, compensator, torque curves, covariance) is read by
//! `structure`.
//!
//! In reading order: `file` (the tables as written), `checks` (what no schema can say, and SI), `geometry_covariance_table`, `geometry_covariance`, `structure`, `vibration`, `bodies`; `spelling`,
//! `write_bodies`, `write_masses`, `write` (a robot of another format as such a file), `identified` (such a file with compliances that were identified),
//! `calibrated` (with small motions that were), `backlash` (with backlash that was measured), `learned` (with values of `[motion]` from joint logs),
//! `learnt_table`, `learnt` (with the residual that was learnt, and its file of residuals).
//!
//! ```text
//! format = 1
//! name = "Maker Type"
//! [chain]       source, motions = [{ about = "z", joint = "S" }, { along = "z", length_mm = 450 }, ...]
//! [[joint]]     name, sign, zero_offset_deg, limits_deg, max_speed_deg_per_s, compliance_rad_per_n_m, ...
//! [[body]]      at, name, capsule_mm, accuracy_mm, source: the outline of a link; [clearance] apart
//! [[frame]] [[spring]] [[mass]] [[motor]] [damping] [compensator] [covariance] [geometry_covariance] [repeatability] [model_error] [learnt] [payload] [controller] [motion]    each may be left out
//! [sources.KEY] what, where, licence: every KEY that a `source` names, and no other
//! ```
//!
//! All keys with their meaning: `docs/guide/robot-file.md`.

mod backlash;
mod bodies;
mod calibrated;
mod checks;
mod file;
mod geometry_covariance;
mod geometry_covariance_table;
mod identified;
mod learned;
mod learnt;
mod learnt_table;
mod spelling;
mod structure;
mod vibration;
mod write;
mod write_bodies;
mod write_masses;

use armill_core::frame::{Isometry, from_xyz_and_fixed_angles};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Robot;
use armill_core::robot::model::NamedFrame;
use armill_core::units::{from_deg, from_mm};

use self::checks::Checks;
use self::file::{FrameEntry, JointEntry, RobotFile};
pub use self::write::write;
pub use self::write_bodies::body_tables;
pub use self::write_masses::mass_tables;
use super::description::{JointNote, OtherLimits, RobotDescription};
use crate::document::{Document, Problems};
use crate::sources;

pub use self::backlash::{JointBacklash, MeasuredBacklash, with_backlash};
pub(super) use self::calibrated::KEY as CALIBRATED;
pub use self::calibrated::{Geometry, with_geometry};
pub use self::geometry_covariance_table::GeometryCovarianceTable;
pub use self::identified::{Identified, IdentifiedSpring, with_given_springs, with_springs};
pub use self::learned::{LearnedMotion, with_motion};
pub(super) use self::learnt::with_residuals_of_its_file;
pub use self::learnt::{residuals_file, with_residual};
pub use self::learnt_table::LearntTable;

/// The robot of this file; `path` is what errors show, `id` the robot's name in results.
///
/// First what the schema refuses; then, of a file that it takes, all that only the whole can show; then what the core
/// refuses of the chain. Nothing is assumed, so `remarks` stay empty.
///
/// # Errors
/// Every problem of the file, each with its place.
pub fn read(path: &str, id: &str, text: &str) -> Result<RobotDescription, Problems> {
    let document = Document::parse(path, text)?;
    let file: RobotFile = document.read()?;
    let mut checks = Checks {
        document: &document,
        problems: sources::problems(&document, &file.sources),
    };
    let motions = checks.motions(&file);
    let joints = checks.joints(&file);
    let compliance = checks.compliance(&file);
    let structure = checks.structure(&file);
    let bodies = checks.bodies(&file);
    let nominal = checks.nominal(&file);
    let of_controller = file.controller.iter();
    let of_controller = of_controller.flat_map(|table| table.problems(&document, file.joint.len(), 0));
    checks.problems.extend(of_controller);
    checks.learnt(&file);
    let of_motion = file.motion.iter();
    checks
        .problems
        .extend(of_motion.flat_map(|table| table.problems(&document, file.joint.len())));
    Problems::from(std::mem::take(&mut checks.problems)).into_result()?;

    let refused = |error: armill_core::robot::RobotError| {
        Problems::from(vec![document.problem("chain.motions", error.to_string(), None)])
    };
    let external = file.joint.iter().take_while(|joint| joint.external).count();
    let mut robot = Robot::new(id, motions, joints)
        .map_err(refused)?
        .with_nominal_branch(nominal);
    if external > 0 {
        robot = robot.with_external_joints(external).map_err(|error| {
            Problems::from(vec![document.problem(
                "joint[0].external",
                error.to_string(),
                None,
            )])
        })?;
    }
    robot = robot.with_frames(file.frame.iter().map(named_frame).collect());
    if let Some(compliance) = compliance {
        robot = robot.with_compliance(compliance).map_err(refused)?;
    }
    robot = robot
        .with_structure(structure)
        .map_err(|error| Problems::from(vec![document.problem("spring", error.to_string(), None)]))?;
    Ok(RobotDescription {
        robot,
        title: file.name,
        note: file.note.map(|note| note.trim().to_owned()),
        description: file.description.map(|text| text.trim().to_owned()),
        remarks: Vec::new(),
        payload_kg: file.payload.map(|payload| payload.mass_kg),
        controller: file.controller,
        motion: file.motion,
        learnt: file.learnt,
        symbols: file
            .chain
            .motions
            .into_iter()
            .map(|motion| motion.symbol)
            .collect(),
        bodies: bodies.bodies,
        body_notes: bodies.notes,
        apart: bodies.apart,
        joint_notes: file.joint.into_iter().map(joint_note).collect(),
        sources: sources::listed(file.sources),
    })
}

/// A frame of the file, m and rad; its angles turn about the fixed axes x, y, z in that order.
fn named_frame(entry: &FrameEntry) -> NamedFrame {
    let rotation = Vector3::from(entry.rotation_deg).map(from_deg);
    let base_from_frame: Isometry =
        from_xyz_and_fixed_angles(from_mm(Vector3::from(entry.origin_mm)), rotation);
    NamedFrame {
        name: entry.name.clone(),
        base_from_frame,
    }
}

/// What a joint's table says apart from numbers; its uncertainty has the source of its compliance where it names none.
fn joint_note(entry: JointEntry) -> JointNote {
    JointNote {
        source: Some(entry.source),
        compliance_u_source: entry
            .compliance_u_source
            .or_else(|| entry.compliance_source.clone()),
        compliance_source: entry.compliance_source,
        other_limits: entry
            .other_limits
            .into_iter()
            .map(|entry| OtherLimits {
                limits_deg: entry.limits_deg,
                source: entry.source,
                note: entry.note,
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests;

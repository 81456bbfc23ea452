//! A turntable or positioner that carries the part: a second kinematic chain.
//!
//! Its table is a frame that coordinates can be relative to. Its deflection under the cut adds to that of the arm: the
//! part moves by `-w` where the tool moves by `w`, so each of its joints is a spring under the arm, at its own
//! axis in base.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `base_from_root` | position of the positioner, `base_from_root_mm_deg` | m, rad |
//! | `q` | its joint positions, `joints_deg`; constant within a study | rad (m) |
//! | `S_k`, `c_k` | screw of its joint k about the origin of base, its compliance | -, rad/(N m) |
//!
//! Its other springs, its masses and gravity are neglected: only the compliances of its joints are included.

use std::path::Path;

use armill_core::frame::Isometry;
use armill_core::nalgebra::Point3;
use armill_core::robot::forward::forward;
use armill_core::robot::inverse::tool_on;
use armill_core::robot::jacobian::screws_at;
use armill_core::robot::model::NamedFrame;
use armill_core::robot::{Attachment, Spring};
use armill_core::spatial::Twist;
use armill_core::units::{to_deg, to_mm};
use armill_formats::robot::RobotDescription;
use armill_formats::sources::Source;

use crate::error::StudyError;
use crate::file::format::PositionerTable;
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::pose_mm_deg;
use crate::joint_unit::joint_positions;
use crate::robots;

/// The name of its table as a reference frame.
pub const TABLE: &str = "table";

/// The robot with the table of this positioner as a frame, its joints as springs, and its sources; unchanged where
/// something is wrong.
///
/// # Errors
/// The problems of the positioner's file.
pub(super) fn with_positioner(
    log: &mut ProblemLog<'_>,
    table: &PositionerTable,
    folder: &Path,
    mut found: RobotDescription,
) -> Result<RobotDescription, StudyError> {
    let robot = &found.robot;
    let described = match robots::find(&table.robot, folder) {
        Ok(found) => found,
        Err(StudyError::Value { message, hint }) => {
            log.problem("positioner.robot", message, &hint);
            return Ok(found);
        }
        Err(problems) => return Err(problems),
    };
    let q = match joint_positions(&described, &table.joints_deg) {
        Ok(q) => q,
        Err(StudyError::Value { message, hint }) => {
            log.problem("positioner.joints_deg", message, &hint);
            return Ok(found);
        }
        Err(problems) => return Err(problems),
    };
    let positioner = &described.robot;
    if let Some((joint, outside)) = positioner.limit_margin(&q).filter(|(_, margin)| *margin < 0.0) {
        let name = &positioner.joints()[joint].name;
        let beyond = if positioner.slides(joint) {
            format!("{:.1} mm", to_mm(-outside))
        } else {
            format!("{:.1} deg", -to_deg(outside))
        };
        let message = format!("the positioner's joint {name} is {beyond} outside its range");
        log.problem(
            "positioner.joints_deg",
            message,
            "see `armill robots FILE` for its limits",
        );
    }
    if robot.frames().iter().any(|frame| frame.name == TABLE) {
        let message = format!("the robot has a frame `{TABLE}` already");
        log.problem("positioner", message, "rename the frame in the robot file");
    }

    let base_from_root = pose_mm_deg(&table.base_from_root_mm_deg);
    let frames = forward(positioner, &q);
    let base_from_table = base_from_root * tool_on(&frames, &Isometry::identity());
    let mut all = robot.frames().to_vec();
    all.push(NamedFrame {
        name: TABLE.to_owned(),
        base_from_frame: base_from_table,
    });
    let mut structure = robot.structure().clone();
    if let Some(compliances) = positioner.compliance() {
        // Screws about the origin of base, first in axes of the positioner's root.
        let origin: Point3<f64> = base_from_root.inverse_transform_point(&Point3::origin());
        let screws = screws_at(positioner, &frames, &origin);
        structure
            .springs
            .extend(screws.iter().zip(compliances).map(|(screw, compliance)| Spring {
                attachment: Attachment::Base,
                direction: Twist {
                    linear: base_from_root * screw.linear,
                    angular: base_from_root * screw.angular,
                },
                compliance: *compliance,
            }));
    }
    let refused = |error: armill_core::robot::RobotError| {
        StudyError::value(error.to_string(), "see the positioner's file and its position")
    };
    let with_positioner = robot.clone().with_frames(all).with_structure(structure);
    found.robot = with_positioner.map_err(refused)?;
    found
        .sources
        .extend(described.sources.into_iter().map(|source| Source {
            key: format!("positioner:{}", source.key),
            ..source
        }));
    Ok(found)
}

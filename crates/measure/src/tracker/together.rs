//! One measured pose for each row of the files.

use armill_core::calibrate::MeasuredPose;
use armill_core::frame::Isometry;
use armill_core::measure::reflectors::{Body, BodyError, referred_to};
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::Robot;
use armill_study::StudyError;

use super::files::{Files, body, joints, reflectors, same_rows, three_in_one};

/// What the files have together.
#[derive(Clone, Debug)]
pub struct Together {
    /// One pose for each row.
    pub poses: Vec<MeasuredPose>,
    /// The reflectors on the tool.
    pub tool: Option<Body>,
    /// The reflectors on the base.
    pub base: Option<Body>,
    /// Ignored columns.
    pub unused: Vec<String>,
}

/// Reads `files` of `robot`.
///
/// # Errors
/// Files that cannot be read, their problems, other numbers of rows, reflectors that are not on one body, joint positions that are missing.
pub fn together(robot: &Robot, files: &Files) -> Result<Together, StudyError> {
    let shown = |index: usize| files.measured[index].display().to_string();
    let mut found = Together {
        poses: Vec::new(),
        tool: None,
        base: None,
        unused: Vec::new(),
    };
    let mut own_joints = None;
    let three = match files.measured.as_slice() {
        [one] => three_in_one(one)?,
        [a, b, c] => Some(reflectors(&[a.clone(), b.clone(), c.clone()])?),
        others => {
            return Err(StudyError::value(
                format!("{} files of measured points are given", others.len()),
                "one file of a body, a point or three reflectors on the tool; or three files of one reflector each",
            ));
        }
    };
    let mut placed: Vec<(Vector3<f64>, Option<UnitQuaternion<f64>>)> = match three {
        Some(three) => {
            let tool = Body::of(&three).map_err(|error| not_a_body("the reflectors of the tool", error))?;
            let place = |pose: &Isometry| (pose.translation.vector, Some(pose.rotation));
            let placed = tool.poses.iter().map(place).collect();
            found.tool = Some(tool);
            if let ([one], None) = (files.measured.as_slice(), &files.joints) {
                own_joints = Some(joints(one, robot, files.joint_unit)?);
            }
            placed
        }
        None => {
            let bodies = body(&files.measured[0], robot)?;
            own_joints = bodies.joints;
            found.unused = bodies.unused;
            let rotations = bodies.rotations;
            let rotation = |row: usize| rotations.as_ref().map(|all| all[row]);
            let rows = bodies.positions.into_iter().enumerate();
            rows.map(|(row, position)| (position, rotation(row))).collect()
        }
    };
    if let Some(base) = &files.base {
        let three = reflectors(base)?;
        same_rows(
            [
                (shown(0).as_str(), placed.len()),
                (base[0].display().to_string().as_str(), three.len()),
            ]
            .into_iter(),
        )?;
        let base = Body::of(&three).map_err(|error| not_a_body("the reflectors of the base", error))?;
        placed = referred(&base, &placed);
        found.base = Some(base);
    }
    let joints = match (&files.joints, own_joints) {
        (Some(path), _) => {
            let rows = joints(path, robot, files.joint_unit)?;
            same_rows(
                [
                    (shown(0).as_str(), placed.len()),
                    (path.display().to_string().as_str(), rows.len()),
                ]
                .into_iter(),
            )?;
            rows
        }
        (None, Some(rows)) => rows,
        (None, None) => {
            return Err(StudyError::value(
                format!("{} has no joint positions", shown(0)),
                "--joints FILE: one row per pose, joint positions in the last columns",
            ));
        }
    };
    let pose = |((position, rotation), joints)| MeasuredPose {
        joints,
        position,
        rotation,
    };
    found.poses = placed.into_iter().zip(joints).map(pose).collect();
    Ok(found)
}

/// Measured positions and rotations, referred to the base at its first pose.
fn referred(
    base: &Body,
    placed: &[(Vector3<f64>, Option<UnitQuaternion<f64>>)],
) -> Vec<(Vector3<f64>, Option<UnitQuaternion<f64>>)> {
    let frame = |(position, rotation): &(Vector3<f64>, Option<UnitQuaternion<f64>>)| {
        Isometry::from_parts((*position).into(), rotation.unwrap_or_default())
    };
    let moved = referred_to(base, &placed.iter().map(frame).collect::<Vec<_>>());
    let back = |(pose, (_, rotation)): (Isometry, &(_, Option<UnitQuaternion<f64>>))| {
        (pose.translation.vector, rotation.map(|_| pose.rotation))
    };
    moved.into_iter().zip(placed).map(back).collect()
}

fn not_a_body(what: &str, error: BodyError) -> StudyError {
    StudyError::value(
        format!("{what}: {error}"),
        "all files in one order of rows, mm; the same reflector in the same file or columns",
    )
}

//! Calibration file of `ur_description` out, for arms like those of Universal Robots; [`crate::robot::ur`] reads it.
//!
//! Six poses, each of a joint in the link before, with the axis along z. The arm begins at the frame `controller`, if the robot file has one, otherwise at its base,
//! and ends at `wrist_3`, on the axis of joint 6 and with the orientation of the flange about it.
//!
//! | frame | origin | x axis |
//! |---|---|---|
//! | `shoulder` | on axis 1, at its normal to axis 2 | across axis 2 |
//! | `upper_arm` | on axis 2, at the same normal | as before |
//! | `forearm` | where axis 3 meets the xy plane of `upper_arm` | as before |
//! | `wrist_1` | on axis 4, at its normal to axis 5 | as before |
//! | `wrist_2` | on axis 5, at its normal to axis 6 | as before |
//! | `wrist_3` | on axis 6, nearest to the flange | that of the flange |
//!
//! With nominal lengths these are the poses of `ur_description`.

use std::fmt::Write;

use armill_core::frame::{Isometry, fixed_angles};
use armill_core::nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3, convert};
use armill_core::robot::forward::{forward, joint_axis};
use armill_core::units::{to_deg, to_mm};
use sha2::{Digest, Sha256};

use super::error::ExportError;
use super::options::Exported;
use super::spelling::{comment_line, line, number};
use crate::robot::RobotDescription;

/// Links of the file, in order.
pub(in crate::robot) const LINKS: [&str; 6] = [
    "shoulder",
    "upper_arm",
    "forearm",
    "wrist_1",
    "wrist_2",
    "wrist_3",
];
/// Keys of a pose: position m, turns about fixed axes rad.
pub(in crate::robot) const KEYS: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];

/// Angle (rad) and distance (m) by which axes may differ from parallel, across and meeting.
const ALIKE_RAD: f64 = 0.1;
const ALIKE_M: f64 = 0.02;
/// What is left behind joint 6 is reported beyond this, m (rad).
const NEGLIGIBLE: f64 = 1e-9;

/// A joint axis: a point and the positive direction.
#[derive(Clone, Copy)]
struct Line {
    point: Vector3<f64>,
    along: Vector3<f64>,
}

/// The text of a calibration file.
///
/// # Errors
/// An arm of another structure.
pub(super) fn write(found: &RobotDescription, about: &[String]) -> Result<Exported, ExportError> {
    let robot = &found.robot;
    let count = robot.joints().len();
    let refused = |why: String| Err(ExportError::NotUr(why));
    if count != 6 || (0..count).any(|joint| robot.slides(joint)) {
        return refused(format!("it has {count} joints, not six revolute ones"));
    }
    let controller = robot.frames().iter().find(|frame| frame.name == "controller");
    let base_from_start = controller.map_or_else(Isometry::identity, |frame| frame.base_from_frame);
    let start_from_base = base_from_start.inverse();
    let zero = forward(robot, &[0.0; 6]);
    let lines: [Line; 6] = std::array::from_fn(|joint| Line {
        point: (start_from_base * zero.origin(joint)).coords,
        along: start_from_base.rotation
            * (joint_axis(robot, &zero, joint) * robot.joints()[joint].sign.factor()),
    });
    if let Some(why) = unlike(&lines) {
        return refused(why);
    }
    let start_from_flange: Isometry = start_from_base * convert::<_, Isometry>(zero.base_from_flange);
    let frames = frames(&lines, &start_from_flange);
    let mut before = Isometry::identity();
    let mut poses = Vec::new();
    for frame in &frames {
        poses.push(before.inverse() * frame);
        before = *frame;
    }
    let rest = before.inverse() * start_from_flange;
    let mut warnings = Vec::new();
    let (away, turned) = (rest.translation.vector.norm(), rest.rotation.angle());
    if away > NEGLIGIBLE || turned > NEGLIGIBLE {
        let values = values(&rest).join(" ");
        warnings.push(format!(
            "the flange of the file is not that of the robot: it is {:.4} mm and {:.5} deg away, because the file ends on the axis of joint 6; \
             add x y z roll pitch yaw = {values} (m, rad) in front of the tool",
            to_mm(away),
            to_deg(turned)
        ));
    }
    let mut body = String::new();
    for (link, pose) in LINKS.iter().zip(&poses) {
        line(&mut body, &format!("  {link}:"));
        for (key, value) in KEYS.iter().zip(values(pose)) {
            line(&mut body, &format!("    {key}: {value}"));
        }
    }
    let mut text = String::new();
    for content in about.iter().chain(&warnings) {
        comment_line(&mut text, content);
    }
    line(
        &mut text,
        "# m and rad. The hash is that of these numbers, not of the controller: the driver will report that they differ.",
    );
    line(&mut text, "kinematics:");
    text.push_str(&body);
    line(&mut text, &format!("  hash: calib_armill_{}", hash(&body)));
    Ok(Exported {
        text,
        arguments: None,
        warnings,
    })
}

/// First digits of the checksum of a text.
fn hash(text: &str) -> String {
    let sum = Sha256::digest(text.as_bytes());
    sum.iter().take(8).fold(String::new(), |mut out, byte| {
        // Writing to a text cannot fail.
        let _ = write!(out, "{byte:02x}");
        out
    })
}

/// Position and turns of a pose.
fn values(pose: &Isometry) -> [String; 6] {
    let (at, turns) = (pose.translation.vector, fixed_angles(&pose.rotation));
    [at.x, at.y, at.z, turns.x, turns.y, turns.z].map(number)
}

/// What of an arm is not as in arms of Universal Robots.
fn unlike(lines: &[Line; 6]) -> Option<String> {
    for (a, b) in [(1, 2), (2, 3)] {
        let names = format!("axes {} and {}", a + 1, b + 1);
        if lines[a].along.cross(&lines[b].along).norm() > ALIKE_RAD {
            return Some(format!("{names} are not parallel"));
        }
        if lines[a].along.dot(&lines[b].along) < 0.0 {
            return Some(format!("{names} turn in opposite directions"));
        }
    }
    for (a, b) in [(0, 1), (3, 4), (4, 5)] {
        if lines[a].along.dot(&lines[b].along).abs() > ALIKE_RAD {
            return Some(format!("axes {} and {} are not perpendicular", a + 1, b + 1));
        }
        let normal = lines[a].along.cross(&lines[b].along).normalize();
        if normal.dot(&(lines[b].point - lines[a].point)).abs() > ALIKE_M {
            return Some(format!("axes {} and {} do not meet", a + 1, b + 1));
        }
    }
    None
}

/// The frames of the six links.
fn frames(lines: &[Line; 6], flange: &Isometry) -> [Isometry; 6] {
    let [l1, l2, l3, l4, l5, l6] = lines;
    // -y is along axis 2.
    let shoulder = frame(nearest(l1, l2), &l1.along, &l1.along.cross(&l2.along));
    let upper_arm = frame(nearest(l2, l1), &l2.along, &axis(&shoulder, 0));
    let to_plane = axis(&upper_arm, 2).dot(&(upper_arm.translation.vector - l3.point));
    let met = l3.point + l3.along * (to_plane / axis(&upper_arm, 2).dot(&l3.along));
    let forearm = frame(met, &l3.along, &axis(&upper_arm, 0));
    let wrist_1 = frame(nearest(l4, l5), &l4.along, &axis(&forearm, 0));
    let wrist_2 = frame(nearest(l5, l6), &l5.along, &axis(&wrist_1, 0));
    let at = l6.point + l6.along * l6.along.dot(&(flange.translation.vector - l6.point));
    let wrist_3 = frame(at, &l6.along, &axis(flange, 0));
    [shoulder, upper_arm, forearm, wrist_1, wrist_2, wrist_3]
}

/// An axis of a frame.
fn axis(frame: &Isometry, index: usize) -> Vector3<f64> {
    frame.rotation * Vector3::ith(index, 1.0)
}

/// The point of a line that is nearest to another one, which is not parallel to it.
fn nearest(line: &Line, other: &Line) -> Vector3<f64> {
    let apart = other.point - line.point;
    let cosine = line.along.dot(&other.along);
    let t = (apart.dot(&line.along) - apart.dot(&other.along) * cosine) / (1.0 - cosine * cosine);
    line.point + line.along * t
}

/// The frame with this z axis, and an x axis as near as possible to `x`.
fn frame(origin: Vector3<f64>, z: &Vector3<f64>, x: &Vector3<f64>) -> Isometry {
    let x = (x - z * x.dot(z)).normalize();
    let axes = Matrix3::from_columns(&[x, z.cross(&x), *z]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Isometry::from_parts(origin.into(), turn)
}

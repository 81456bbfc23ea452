//! Measured poses as a table: `q1_deg, ..., x_mm, y_mm, z_mm[, rx_deg, ry_deg, rz_deg]`, angles about fixed axes.

use std::fmt::Write;

use armill_core::calibrate::MeasuredPose;
use armill_core::frame::fixed_angles;
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm};

/// The poses of `robot` as CSV, with their names in the robot file.
pub fn table(robot: &Robot, poses: &[MeasuredPose]) -> String {
    let joint = |index: usize| {
        let unit = if robot.slides(index) { "mm" } else { "deg" };
        format!("q{}_{unit},", index + 1)
    };
    let turned = poses.iter().all(|pose| pose.rotation.is_some());
    let mut text: String = (0..robot.joints().len()).map(joint).collect();
    text.push_str("x_mm,y_mm,z_mm");
    text.push_str(if turned { ",rx_deg,ry_deg,rz_deg\n" } else { "\n" });
    for pose in poses {
        for (index, value) in pose.joints.iter().enumerate() {
            let shown = if robot.slides(index) {
                to_mm(*value)
            } else {
                to_deg(*value)
            };
            let _ = write!(text, "{shown:.8},");
        }
        let at = to_mm(pose.position);
        let _ = write!(text, "{:.6},{:.6},{:.6}", at.x, at.y, at.z);
        if let Some(rotation) = pose.rotation.filter(|_| turned) {
            let angles = fixed_angles(&rotation).map(|angle| to_deg(angle));
            let _ = write!(text, ",{:.8},{:.8},{:.8}", angles.x, angles.y, angles.z);
        }
        text.push('\n');
    }
    text
}

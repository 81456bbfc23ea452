//! What a drawing of an arm shows.

use super::view::View;

/// One joint of a posture, in the frame of the ground, at the position that it has in this posture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmJoint {
    /// Its name, written next to it: `S`; empty for none.
    pub name: String,
    /// A point on its axis, in mm; links are drawn from origin to origin.
    pub origin_mm: [f64; 3],
    /// Direction of its axis, of any length; one of no length counts as z.
    pub axis: [f64; 3],
}

/// The arm in one posture, in the frame of the ground on which it stands: z upward.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmPosture {
    /// The position of the foot, in mm. The foot is drawn about the axis of the first joint.
    pub base_mm: [f64; 3],
    /// The joints from base to flange.
    pub joints: Vec<ArmJoint>,
    /// Centre of the flange, in mm.
    pub flange_mm: [f64; 3],
    /// Tool centre point, in mm; where it is the flange, no tool is drawn.
    pub tool_mm: [f64; 3],
}

/// What an arm drawing shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmDrawing {
    /// First line, bold.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// The posture drawn in full.
    pub posture: ArmPosture,
    /// Further postures, drawn faintly behind it; one without joints, or with a point that is not finite, is
    /// left out.
    pub ghosts: Vec<ArmPosture>,
    /// Corners of a plate in mm, in order around it. Not checked: that they are in one plane.
    pub plate_mm: Option<[[f64; 3]; 4]>,
    /// Path of the tool in mm; points that are not finite are left out.
    pub path_mm: Vec<[f64; 3]>,
    /// A tool that stands in the cell: its mount and its tip, in mm; left out where one is not finite.
    pub standing_tool_mm: Option<[[f64; 3]; 2]>,
    /// From where the arm is seen; `to_svg_views` takes its own.
    pub view: View,
}

/// Whether every point of a posture is a number.
pub(super) fn is_finite(posture: &ArmPosture) -> bool {
    let points = posture.joints.iter().flat_map(|j| [j.origin_mm, j.axis]);
    points
        .chain([posture.base_mm, posture.flange_mm, posture.tool_mm])
        .flatten()
        .all(f64::is_finite)
}

//! What the pictures of every kind of analysis share: titles, axes, grids of points, bars of contributors.
//!
//! Planes are drawn as seen from the tool side: part x to the right, which is base y to the left on a tilted plane.

use armill_core::kernel::Evaluation;
use armill_core::map::PlaneMap;
use armill_core::robot::{Robot, Unreachable};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_report::{AxisLabels, Grid, PointState, ShareBar, ShareBars};

use crate::analysis::point::PointAnswer;
use crate::input::setting::Setting;
use crate::naming::FLANGE;

/// The quantity of the colours.
pub const QUANTITY: &str = "in-plane deviation (µm)";
/// The quantity of the colours where the depth is shown.
pub const NORMAL_QUANTITY: &str = "deviation along the normal, by size (µm)";

/// A picture with its file name (without extension) and caption.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without extension.
    pub name: String,
    /// What it shows, in a sentence.
    pub caption: String,
    /// The picture.
    pub svg: String,
}

/// The axes of a plane: base y if it is given by a tilt, else its own y'.
pub fn axes(setting: &Setting) -> AxisLabels {
    let along_base_y = setting.tilt.is_some();
    AxisLabels {
        horizontal: if along_base_y {
            "base y (mm)"
        } else {
            "along the plane, y′ (mm)"
        }
        .to_owned(),
        vertical: "along the plane, z′ (mm)".to_owned(),
    }
}

/// One line under the title: posture, load, tool, tilt.
pub fn subtitle(setting: &Setting) -> String {
    let tool = match to_mm(setting.flange_from_tool.translation.vector.norm()) {
        0.0 => "bare flange".to_owned(),
        length if setting.base_name == FLANGE => format!("TCP {length:.0} mm from the mount of the tool"),
        length => format!("TCP {length:.0} mm from the flange"),
    };
    let tilt = setting
        .tilt
        .map_or(String::new(), |tilt| format!(", tilt {:.0}°", to_deg(tilt)));
    let cases = setting.cases.len();
    let worst = match cases {
        // Forces of the cut are not cases of the study.
        0 => "the force of the cut".to_owned(),
        1 => "1 load case".to_owned(),
        _ => format!("worst of {cases} load cases"),
    };
    format!(
        "{}{tilt}, {tool}, {worst}, heights relative to {}",
        setting.branch(),
        setting.base_name
    )
}

/// Base y of the plane's centre where the horizontal axis is base y, otherwise 0; mm.
pub fn base_y(setting: &Setting) -> f64 {
    let centre = setting.in_reference(&setting.plane.base_from_part.translation.vector.into());
    if setting.tilt.is_some() {
        to_mm(centre.y)
    } else {
        0.0
    }
}

/// The bar of a point: shares of joints, whole deviation, its standard uncertainty.
pub fn share_bar(label: &str, point: &PointAnswer) -> ShareBar {
    ShareBar {
        label: label.to_owned(),
        shares_um: point.joint_share_um.clone(),
        total_um: Some(point.in_plane_um),
        total_uncertainty_um: point.in_plane_u_um,
    }
}

/// Bars of several points.
pub fn shares(robot: &Robot, title: &str, setting: &Setting, quantity: &str, bars: Vec<ShareBar>) -> String {
    let picture = ShareBars {
        title: title.to_owned(),
        subtitle: subtitle(setting),
        quantity: quantity.to_owned(),
        parts: setting.contributor_names(robot),
        bars,
    };
    picture.to_svg()
}

/// The points of a map with their in-plane deviation for a picture: row by row, mm.
pub fn grid(map: &PlaneMap, setting: &Setting) -> Grid {
    grid_of(map, setting, |evaluation| evaluation.in_plane)
}

/// The points of a map with another deviation (m) for a picture: row by row, mm.
pub fn grid_of(map: &PlaneMap, setting: &Setting, deviation: impl Fn(&Evaluation) -> f64) -> Grid {
    let y0 = base_y(setting);
    Grid {
        horizontal_mm: (0..map.grid.columns)
            .map(|i| y0 - to_mm(map.grid.coordinate(i, map.grid.columns)))
            .collect(),
        vertical_mm: (0..map.grid.rows)
            .map(|i| to_mm(map.grid.coordinate(i, map.grid.rows)))
            .collect(),
        points: (map.answers.points.iter())
            .map(|point| state(point, &deviation))
            .collect(),
    }
}

/// The state of a point: its deviation, marked if outside joint limits, or that it is not reached.
pub fn state(point: &Result<Evaluation, Unreachable>, deviation: impl Fn(&Evaluation) -> f64) -> PointState {
    match point {
        Ok(evaluation) if evaluation.within_limits() => PointState::Reached(to_um(deviation(evaluation))),
        Ok(evaluation) => PointState::OutsideJointLimits(to_um(deviation(evaluation))),
        Err(_) => PointState::Unreachable,
    }
}

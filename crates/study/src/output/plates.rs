//! Maps as pictures: the deviation over a plate, its permissible region, series of plates, slices of a box.
//!
//! Drawn as seen from the tool side: part x to the right, which is base y to the left on a tilted plane.

use armill_core::kernel::Evaluation;
use armill_core::map::{COVERAGE, PlaneMap, VolumeMap};
use armill_core::robot::Unreachable;
use armill_report::{
    AxisLabels, CircleMm, ColourScale, DeviationMap, Grid, MapSeries, Marker, MarkerKind, Overlay, Panel,
    PointState, RectangleMm, RegionMap,
};

use super::pictures::Picture;
use crate::answer::MapAnswer;
use crate::file::resolve::Setting;

/// Slices of a box that are drawn at most.
const SLICES: usize = 8;
/// Panels in a row at most.
const COLUMNS: usize = 4;
/// The quantity of the colours.
const QUANTITY: &str = "in-plane deviation (µm)";

/// The axes of a plane: base y if it is given by a tilt, else its own y'.
pub(super) fn axes(setting: &Setting) -> AxisLabels {
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
pub(super) fn subtitle(setting: &Setting) -> String {
    let tool = match setting.flange_from_tool.translation.vector.norm() * 1e3 {
        0.0 => "bare flange".to_owned(),
        length => format!("TCP {length:.0} mm from the flange"),
    };
    let tilt = setting
        .tilt
        .map_or(String::new(), |tilt| format!(", tilt {:.0}°", tilt.to_degrees()));
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

/// The points of a map for a picture: row by row, mm.
pub(super) fn grid(map: &PlaneMap, setting: &Setting) -> Grid {
    let y0 = base_y(setting);
    Grid {
        horizontal_mm: (0..map.grid.columns)
            .map(|i| y0 - map.grid.coordinate(i, map.grid.columns) * 1e3)
            .collect(),
        vertical_mm: (0..map.grid.rows)
            .map(|i| map.grid.coordinate(i, map.grid.rows) * 1e3)
            .collect(),
        points: map.answers.points.iter().map(state).collect(),
    }
}

/// Expanded uncertainty of each deviation; none if no point is uncertain.
fn spread_um(map: &PlaneMap) -> Vec<f64> {
    let points = map.answers.points.iter();
    let uncertainty = |point: &Result<Evaluation, Unreachable>| {
        point
            .as_ref()
            .map_or(0.0, |evaluation| evaluation.in_plane_uncertainty)
    };
    points.map(|point| COVERAGE * uncertainty(point) * 1e6).collect()
}

/// Base y of the plane's centre where the horizontal axis is base y, otherwise 0; mm.
pub(super) fn base_y(setting: &Setting) -> f64 {
    let centre = setting.in_reference(&setting.plane.base_from_part.translation.vector.into());
    if setting.tilt.is_some() {
        centre.y * 1e3
    } else {
        0.0
    }
}

/// The state of a point: its deviation, marked if outside joint limits, or that it is not reached.
fn state(point: &Result<Evaluation, Unreachable>) -> PointState {
    match point {
        Ok(evaluation) if evaluation.within_limits() => PointState::Reached(evaluation.in_plane * 1e6),
        Ok(evaluation) => PointState::OutsideJointLimits(evaluation.in_plane * 1e6),
        Err(_) => PointState::Unreachable,
    }
}

/// The map of a plane with its best and worst point, and the region within the tolerance with the largest shapes
/// inside.
pub(super) fn map_pictures(
    answer: &MapAnswer,
    setting: &Setting,
    map: &PlaneMap,
    overlays: Vec<Overlay>,
) -> [Picture; 2] {
    let y0 = base_y(setting);
    let at = |in_plane: [f64; 2]| [y0 + in_plane[0], in_plane[1]];
    let marker = |label: &str, kind, at_mm| Marker {
        at_mm,
        label: label.to_owned(),
        kind,
        name: String::new(),
    };
    let markers = [
        answer
            .best
            .as_ref()
            .map(|p| marker("least", MarkerKind::Best, at(p.in_plane_mm))),
        answer
            .worst
            .as_ref()
            .map(|p| marker("largest", MarkerKind::Point, at(p.in_plane_mm))),
    ];
    let tolerance_um = setting.tolerance * 1e6;
    let deviation = DeviationMap {
        title: answer.name.clone(),
        subtitle: subtitle(setting),
        grid: grid(map, setting),
        axes: axes(setting),
        quantity: QUANTITY.to_owned(),
        tolerance_um: Some(tolerance_um),
        scale: ColourScale::Viridis,
        overlays,
        markers: markers.into_iter().flatten().collect(),
        // A coarse grid is drawn; a fine one would hide the contours.
        show_grid_points: map.grid.len() <= 200,
    };
    let region = RegionMap {
        title: format!("{}: region within {tolerance_um:.0} µm", answer.name),
        subtitle: subtitle(setting),
        grid: grid(map, setting),
        spread_um: spread_um(map),
        axes: axes(setting),
        tolerance_um,
        show_iso_lines: true,
        rectangle: answer
            .region
            .rectangle_mm
            .filter(|[a, b]| a != b)
            .map(|[a, b]| RectangleMm {
                corner_mm: at(a),
                opposite_mm: at(b),
            }),
        circle: answer
            .region
            .circle_centre_mm
            .zip(answer.region.circle_radius_mm)
            .filter(|(_, radius)| *radius > 0.0)
            .map(|(centre, radius_mm)| CircleMm {
                centre_mm: at(centre),
                radius_mm,
            }),
    };
    let slug = crate::file_names::slug(&answer.name);
    [
        Picture {
            name: slug.clone(),
            caption: format!("{}: in-plane deviation, {}.", answer.name, subtitle(setting)),
            svg: deviation.to_svg(),
        },
        Picture {
            name: format!("{slug}-region"),
            caption: format!(
                "{}: {:.1} % of the points are within {tolerance_um:.0} µm{}.",
                answer.name,
                answer.fraction_within_and_inside_joint_limits * 100.0,
                if answer.outside_joint_limits > 0 {
                    " inside the joint limits; those outside are not in the region"
                } else {
                    ""
                }
            ),
            svg: region.to_svg(),
        },
    ]
}

/// A series of plates on one sheet, each above its permissible region.
pub(super) fn sheet(name: &str, panels: Vec<Panel>, setting: &Setting, axes: AxisLabels) -> Picture {
    let rows = panels.len().div_ceil(COLUMNS).max(1);
    let sheet = MapSeries {
        title: name.to_owned(),
        subtitle: subtitle_without_tilt(setting),
        columns: panels.len().div_ceil(rows),
        panels,
        axes,
        quantity: QUANTITY.to_owned(),
        tolerance_um: Some(setting.tolerance * 1e6),
        scale: ColourScale::Viridis,
        show_regions: true,
    };
    Picture {
        name: crate::file_names::slug(name),
        caption: format!(
            "{name}: in-plane deviation above, the region within {:.0} µm below.",
            setting.tolerance * 1e6
        ),
        svg: sheet.to_svg(),
    }
}

/// For a series, whose panels name their tilt.
fn subtitle_without_tilt(setting: &Setting) -> String {
    subtitle(&Setting {
        tilt: None,
        ..setting.clone()
    })
}

/// One panel of a series; `fraction` of its points is within the tolerance.
pub(super) fn section_panel(label: &str, map: &PlaneMap, setting: &Setting, fraction: f64) -> Panel {
    Panel {
        title: label.replace('-', "−"),
        note: format!("{:.0} % within", fraction * 100.0),
        grid: grid(map, setting),
    }
}

/// Slices of a box across base x, as seen from the robot.
///
/// At most [`SLICES`] of them, the first and the last among them; y grows to the left.
pub(super) fn slices(name: &str, volume: &VolumeMap, setting: &Setting) -> Picture {
    let [nx, ny, nz] = volume.grid.counts;
    let count = nx.min(SLICES);
    // Spread over the box, both ends among them.
    let chosen = (0..count).map(|k| if count == 1 { 0 } else { k * (nx - 1) / (count - 1) });
    let origin = setting.in_reference(&volume.grid.corner()) * 1e3;
    let step = volume.grid.step * 1e3;
    let panels = chosen.map(|i| {
        // Rows upwards, y from right to left: as seen from the robot.
        let points = (0..nz).flat_map(|k| (0..ny).rev().map(move |j| i + nx * (j + ny * k)));
        let points: Vec<PointState> = points.map(|index| state(&volume.answers.points[index])).collect();
        let within = points
            .iter()
            .filter(|p| p.value_um().is_some_and(|v| v <= setting.tolerance * 1e6))
            .count();
        Panel {
            title: format!("x = {:.0} mm", origin.x + i as f64 * step),
            note: format!(
                "{:.0} % within",
                within as f64 / points.len().max(1) as f64 * 100.0
            ),
            grid: Grid {
                horizontal_mm: (0..ny).rev().map(|j| origin.y + j as f64 * step).collect(),
                vertical_mm: (0..nz).map(|k| origin.z + k as f64 * step).collect(),
                points,
            },
        }
    });
    let frame = match setting.base_name.as_str() {
        crate::BASE_LINK => "base",
        name => name,
    };
    let axes = AxisLabels {
        horizontal: format!("{frame} y (mm)"),
        vertical: format!("{frame} z (mm)"),
    };
    let mut picture = sheet(name, panels.collect(), setting, axes);
    picture.caption = format!(
        "{name}: slices of the box across {frame} x; above the in-plane deviation, below the region within {:.0} µm.",
        setting.tolerance * 1e6
    );
    picture
}

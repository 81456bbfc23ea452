//! The picture of a box: slices of it.

use armill_core::map::VolumeMap;
use armill_core::units::{to_mm, to_um};
use armill_report::{AxisLabels, Grid, Panel, PointState};

use crate::analysis::panels::sheet;
use crate::analysis::picture::{Picture, state};
use crate::input::setting::Setting;

/// Slices of a box that are drawn at most.
const SLICES: usize = 8;

/// Slices of a box across base x, as seen from the robot.
///
/// At most eight of them, the first and the last among them; y grows to the left.
pub fn slices(name: &str, volume: &VolumeMap, setting: &Setting) -> Picture {
    let [nx, ny, nz] = volume.grid.counts;
    let count = nx.min(SLICES);
    // Spread over the box, both ends among them.
    let chosen = (0..count).map(|k| if count == 1 { 0 } else { k * (nx - 1) / (count - 1) });
    let origin = to_mm(setting.in_reference(&volume.grid.corner()));
    let step = to_mm(volume.grid.step);
    let panels = chosen.map(|i| {
        // Rows upwards, y from right to left: as seen from the robot.
        let points = (0..nz).flat_map(|k| (0..ny).rev().map(move |j| i + nx * (j + ny * k)));
        let points: Vec<PointState> = points
            .map(|index| state(&volume.answers.points[index], |evaluation| evaluation.in_plane))
            .collect();
        let within = points
            .iter()
            .filter(|p| p.value_um().is_some_and(|v| v <= to_um(setting.tolerance)))
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
        to_um(setting.tolerance)
    );
    picture
}

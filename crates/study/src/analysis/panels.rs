//! Several plates on one sheet, each above its permissible region.

use armill_core::units::to_um;
use armill_report::{AxisLabels, ColourScale, MapSeries, Panel};

use crate::analysis::picture::{Picture, QUANTITY, subtitle};
use crate::file_names::slug;
use crate::input::setting::Setting;

/// Panels in a row at most.
const COLUMNS: usize = 4;

/// A series of plates on one sheet, each above its permissible region.
pub fn sheet(name: &str, panels: Vec<Panel>, setting: &Setting, axes: AxisLabels) -> Picture {
    let rows = panels.len().div_ceil(COLUMNS).max(1);
    let sheet = MapSeries {
        title: name.to_owned(),
        subtitle: subtitle_without_tilt(setting),
        columns: panels.len().div_ceil(rows),
        panels,
        axes,
        quantity: QUANTITY.to_owned(),
        tolerance_um: Some(to_um(setting.tolerance)),
        scale: ColourScale::Viridis,
        show_regions: true,
    };
    Picture {
        name: slug(name),
        caption: format!(
            "{name}: in-plane deviation above, the region within {:.0} µm below.",
            to_um(setting.tolerance)
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

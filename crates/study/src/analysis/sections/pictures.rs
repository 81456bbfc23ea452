//! The picture of a series: a panel for each section.

use armill_core::map::PlaneMap;
use armill_report::Panel;

use crate::analysis::map::answer::MapAnswer;
use crate::analysis::panels::sheet;
use crate::analysis::picture::{Picture, axes, grid};
use crate::analysis::sections::Section;
use crate::input::setting::Setting;

/// One sheet with all sections; `given` are their answers. `None` without sections.
pub fn picture(name: &str, sections: &[Section<'_>], given: &[MapAnswer]) -> Option<Picture> {
    let panels = sections.iter().zip(given).map(|(section, given)| {
        panel(
            section.label,
            &section.map,
            &section.sheet.setting,
            given.fraction_within,
        )
    });
    let setting = &sections.first()?.sheet.setting;
    Some(sheet(name, panels.collect(), setting, axes(setting)))
}

/// One panel of a series; `fraction` of its points is within the tolerance.
fn panel(label: &str, map: &PlaneMap, setting: &Setting, fraction: f64) -> Panel {
    Panel {
        title: label.replace('-', "−"),
        note: format!("{:.0} % within", fraction * 100.0),
        grid: grid(map, setting),
    }
}

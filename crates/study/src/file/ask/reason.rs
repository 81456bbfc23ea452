//! Numbers of an ask that no cell has: mostly a wrong unit.

use super::Resolver;
use crate::file::format::HalfSize;
use crate::file::places::Places;

/// No length, angle, force or moment of a real cell is larger, in the units of the file; products of larger ones
/// leave the range of numbers.
const LARGEST: f64 = 1e9;

impl Resolver<'_> {
    /// Lengths, angles, forces and moments beyond all reason.
    pub(super) fn refuse_what_no_cell_has(&self, places: &mut Places<'_>) {
        let t = self.table;
        let plane = self.plane_table();
        let load = self.load();
        let tool = t.tool.as_ref().or(self.file.tool.as_ref());
        let half_size = match plane.half_size_mm {
            HalfSize::Square(half) => vec![half],
            HalfSize::Oblong(halves) => halves.to_vec(),
        };
        let in_box = t.in_box.as_ref();
        let numbers = [
            ("plane.centre_mm", "mm", plane.centre_mm.to_vec()),
            ("plane.tilt_deg", "deg", plane.tilt_deg.into_iter().collect()),
            (
                "plane.rotation_deg",
                "deg",
                plane.rotation_deg.iter().flatten().copied().collect(),
            ),
            ("plane.half_size_mm", "mm", half_size),
            ("plane.step_mm", "mm", vec![plane.step_mm]),
            (
                "load.cases_n",
                "N",
                load.iter()
                    .flat_map(|load| &load.cases_n)
                    .flatten()
                    .copied()
                    .collect(),
            ),
            (
                "load.moments_n_m",
                "N m",
                load.iter()
                    .filter_map(|load| load.moments_n_m.as_ref())
                    .flatten()
                    .flatten()
                    .copied()
                    .collect(),
            ),
            (
                "posture.home_deg",
                "deg or mm",
                self.posture()
                    .and_then(|posture| posture.home_deg.clone())
                    .unwrap_or_default(),
            ),
            (
                "tool.flange_from_tool_mm_deg",
                "mm or deg",
                tool.map_or_else(Vec::new, |tool| tool.flange_from_tool_mm_deg.to_vec()),
            ),
            ("distances_mm", "mm", t.distances_mm.clone().unwrap_or_default()),
            ("tilts_deg", "deg", t.tilts_deg.clone().unwrap_or_default()),
            (
                "box.centre_mm",
                "mm",
                in_box.and_then(|b| b.centre_mm).map_or_else(Vec::new, Vec::from),
            ),
            (
                "box.half_size_mm",
                "mm",
                in_box.map_or_else(Vec::new, |b| b.half_size_mm.to_vec()),
            ),
            (
                "box.step_mm",
                "mm",
                in_box.map_or_else(Vec::new, |b| vec![b.step_mm]),
            ),
            (
                "circle.centre_mm",
                "mm",
                t.circle.iter().filter_map(|c| c.centre_mm).flatten().collect(),
            ),
            (
                "circle.radius_mm",
                "mm",
                t.circle.iter().map(|c| c.radius_mm).collect(),
            ),
            (
                "line",
                "mm",
                t.line
                    .iter()
                    .flat_map(|l| [l.from_mm, l.to_mm])
                    .flatten()
                    .collect(),
            ),
            (
                "polyline_mm",
                "mm",
                t.polyline_mm.iter().flatten().flatten().copied().collect(),
            ),
            (
                "rectangle.centre_mm",
                "mm",
                t.rectangle.iter().filter_map(|r| r.centre_mm).flatten().collect(),
            ),
            (
                "rectangle.size_mm",
                "mm",
                t.rectangle.iter().flat_map(|r| r.size_mm).collect(),
            ),
            ("step_mm", "mm", t.step_mm.into_iter().collect()),
        ];
        for (path, unit, values) in numbers {
            if let Some(value) = values.iter().find(|value| value.abs() > LARGEST) {
                let message = format!("`{path}`: {value:e} {unit} is beyond {LARGEST:e} {unit}");
                places.problem(path, message, "is the unit right?");
            }
        }
    }
}

//! The points of a box.

use armill_core::map::BoxGrid;
use armill_core::nalgebra::{Translation3, Vector3};
use armill_core::units::from_mm;

use crate::analysis::resolve::Resolver;
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::{sizes, step};
use crate::input::setting::Setting;

impl Resolver<'_> {
    /// The points of a box along the axes of the frame in which its centre is specified.
    pub fn volume(&self, log: &mut ProblemLog<'_>, setting: Option<Setting>) -> Option<(Setting, BoxGrid)> {
        let Some(table) = &self.table.in_box else {
            let hint = "box = { half_size_mm = [400, 400, 400], step_mm = 20 }";
            log.problem_here("a volume needs its `box`", hint);
            return None;
        };
        let half_size = sizes(log, "box.half_size_mm", &table.half_size_mm);
        let step = step(log, "box.step_mm", table.step_mm);
        let (half_size, step, setting) = (half_size?, step?, setting?);
        let centre = table.centre_mm.unwrap_or_else(|| self.plane_table().centre_mm);
        // The sides of the box are parallel to the axes of the frame in which its centre is specified.
        let base_from_centre =
            setting.base_from_reference * Translation3::from(from_mm(Vector3::from(centre)));
        let points: f64 = half_size
            .iter()
            .map(|half| 2.0 * (half / step).floor() + 1.0)
            .product();
        self.enough_memory(log, "box.step_mm", points, &setting)?;
        let grid = BoxGrid::within(
            &base_from_centre,
            [half_size[0], half_size[1], half_size[2]],
            step,
        );
        Some((setting, grid))
    }
}

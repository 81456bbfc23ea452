//! The planes of a series.

use armill_core::workpiece::Grid;

use crate::analysis::path::load::LoadSource;
use crate::analysis::resolve::Resolver;
use crate::analysis::sheet::Sheet;
use crate::input::problem_log::ProblemLog;
use crate::input::tables::PlaneTable;

impl Resolver<'_> {
    /// The planes of a series, each with its label: the centre at each distance, or the plane at each tilt.
    pub fn sections(
        &self,
        log: &mut ProblemLog<'_>,
        push: Option<LoadSource<'_>>,
        grid: Option<Grid>,
    ) -> Option<Vec<(String, Sheet)>> {
        let given = |list: &Option<Vec<f64>>| list.as_ref().is_some_and(|list| !list.is_empty());
        if given(&self.table.distances_mm) == given(&self.table.tilts_deg) {
            let hint = "distances_mm = [600, 800, 1000] or tilts_deg = [-60, 0, 60]";
            log.problem_here("sections vary either `distances_mm` or `tilts_deg`", hint);
            return None;
        }
        let lists = [
            ("distances_mm", &self.table.distances_mm),
            ("tilts_deg", &self.table.tilts_deg),
        ];
        for (key, values) in lists {
            let values = values.as_deref().unwrap_or_default();
            for i in (1..values.len()).filter(|i| values[..*i].contains(&values[*i])) {
                let message = format!("{} is listed twice in `{key}`", values[i]);
                log.problem(
                    &format!("{key}[{i}]"),
                    message,
                    "list each section once: the values name the sections",
                );
            }
        }
        let (push, grid) = (push?, grid?);
        let mut sections = Vec::new();
        let mut add = |log: &mut ProblemLog<'_>, label: String, plane: PlaneTable| {
            // A load specified in the part frame turns with the plane of each section.
            let setting = self.setting(log, &plane, Some(push))?;
            sections.push((label, self.sheet(log, setting, grid)?));
            Some(())
        };
        for distance in self.table.distances_mm.iter().flatten() {
            let mut plane = self.plane_table();
            plane.centre_mm[0] = *distance;
            add(log, format!("x = {distance} mm"), plane)?;
        }
        for tilt in self.table.tilts_deg.iter().flatten() {
            let plane = PlaneTable {
                tilt_deg: Some(*tilt),
                rotation_deg: None,
                ..self.plane_table()
            };
            add(log, format!("tilt {tilt} deg"), plane)?;
        }
        Some(sections)
    }
}

//! Planes: a row a plane.

use armill_report::html::Table;

use super::cells::{COUNT, columns, percent, um};
use crate::answer::StudyAnswer;

/// Every map and section, with what fraction holds the limit and how sure that is.
pub(super) fn table(answer: &StudyAnswer) -> Table {
    Table {
        caption: "Fractions are of all points; named branches are judged whether their joints stand inside their limits or not. Surely and possibly: with twice the standard uncertainty added and taken away.".to_owned(),
        columns: columns(&[
            ("plane", ""),
            ("branch", ""),
            ("within the limit", "%"),
            ("… and inside joint limits", "%"),
            ("surely … possibly within", "%"),
            ("least", "µm"),
            ("largest", "µm"),
            ("force permitted there, any direction", "N"),
            ("out of reach", COUNT),
            ("points", COUNT),
        ]),
        rows: answer
            .maps
            .iter()
            .map(|map| {
                vec![
                    map.name.clone(),
                    map.branch.clone(),
                    percent(map.fraction_within),
                    percent(map.fraction_within_and_inside_joint_limits),
                    format!(
                        "{} … {}",
                        percent(map.certainty.fraction_robustly_within),
                        percent(map.certainty.fraction_possibly_within)
                    ),
                    um(map.min_in_plane_um),
                    um(map.max_in_plane_um),
                    um(map.worst.as_ref().and_then(|p| p.permissible_any_direction_n)),
                    (map.counts.out_of_reach + map.counts.no_posture_inside_limits).to_string(),
                    map.grid.points.to_string(),
                ]
            })
            .collect(),
    }
}

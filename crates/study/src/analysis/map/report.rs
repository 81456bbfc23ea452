//! Planes: a row a plane.

use armill_report::html::Table;

use crate::analysis::cells::{COUNT, columns, percent, um};
use crate::analysis::map::answer::MapAnswer;
use crate::uncertainty_words::NOT_KNOWN;

/// Every map and section, with the fraction within the tolerance and its uncertainty.
pub fn table(maps: &[MapAnswer]) -> Table {
    Table {
        caption: "Fractions are of all points; named branches are evaluated whether their joints are inside their limits or not. Least and largest are deviations in the plane, which the tolerance applies to; along the normal is the depth. Reliably and possibly: with the expanded uncertainty (k = 2) added and subtracted.".to_owned(),
        columns: columns(&[
            ("plane", ""),
            ("branch", ""),
            ("within the tolerance", "%"),
            ("… and inside joint limits", "%"),
            ("reliably … possibly within", "%"),
            ("least", "µm"),
            ("largest", "µm"),
            ("largest along the normal", "µm"),
            ("permitted force there, any direction", "N"),
            ("not reached", COUNT),
            ("points", COUNT),
        ]),
        rows: maps
            .iter()
            .map(|map| {
                vec![
                    map.name.clone(),
                    map.branch.clone(),
                    percent(map.fraction_within),
                    percent(map.fraction_within_and_inside_joint_limits),
                    map.certainty.as_ref().map_or_else(
                        || NOT_KNOWN.to_owned(),
                        |certainty| {
                            format!(
                                "{} … {}",
                                percent(certainty.fraction_robustly_within),
                                percent(certainty.fraction_possibly_within)
                            )
                        },
                    ),
                    um(map.min_in_plane_um),
                    um(map.max_in_plane_um),
                    um(map.max_normal_um),
                    um(map.worst.as_ref().and_then(|p| p.permissible_any_direction_n)),
                    map.counts.unreached().to_string(),
                    map.grid.points.to_string(),
                ]
            })
            .collect(),
    }
}

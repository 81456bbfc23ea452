//! Boxes: a row a box.

use armill_report::html::Table;

use crate::analysis::cells::{COUNT, columns, percent};
use crate::analysis::volume::answer::VolumeAnswer;

/// Every box, with the volume within the tolerance.
pub fn table(volumes: &[VolumeAnswer]) -> Table {
    Table {
        caption: "Each point within the tolerance represents one cell of the grid.".to_owned(),
        columns: columns(&[
            ("box", ""),
            ("branch", ""),
            ("within the tolerance", "%"),
            ("… and inside joint limits", "%"),
            ("volume within", "dm³"),
            ("not reached", COUNT),
            ("points", COUNT),
        ]),
        rows: volumes
            .iter()
            .map(|volume| {
                vec![
                    volume.name.clone(),
                    volume.branch.clone(),
                    percent(volume.fraction_within),
                    percent(volume.fraction_within_and_inside_joint_limits),
                    format!("{:.1}", volume.volume_within_mm3 / 1e6),
                    volume.counts.unreached().to_string(),
                    volume.point_counts.iter().product::<usize>().to_string(),
                ]
            })
            .collect(),
    }
}

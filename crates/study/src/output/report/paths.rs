//! Shapes on a plane that were followed: a row a path.

use armill_report::html::Table;

use super::cells::{COUNT, columns, um};
use crate::answer::PathResult;

pub(super) fn table(paths: &[&PathResult]) -> Table {
    Table {
        caption: "Roundness: largest of all load cases, peak to valley about the least-squares circle."
            .to_owned(),
        columns: columns(&[
            ("path", ""),
            ("branch", ""),
            ("least in plane", "µm"),
            ("largest in plane", "µm"),
            ("largest in space", "µm"),
            ("roundness", "µm"),
            ("outside joint limits", COUNT),
            ("points", COUNT),
        ]),
        rows: paths
            .iter()
            .map(|path| {
                vec![
                    path.name.clone(),
                    path.branch.clone(),
                    um(path.min_in_plane_um),
                    um(path.max_in_plane_um),
                    um(path.max_full_um),
                    um(path.roundness_um),
                    path.outside_joint_limits.to_string(),
                    path.points.to_string(),
                ]
            })
            .collect(),
    }
}

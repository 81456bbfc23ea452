//! The picture of a search for spins of the tool: path by spin, coloured by deviation, with the chosen spin.

use armill_core::kernel::PostureStatus;
use armill_core::optimize::{Component, PostureSearch};
use armill_core::units::{to_deg, to_mm, to_um};
use armill_report::{AxisLabels, Cell, CellMap};

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::picture::Picture;

/// Deviation over path and spin; `None` without a search.
pub fn picture(name: &str, subtitle: String, analysis: &PathAnalysis, found: &PathResult) -> Option<Picture> {
    let (searched, search) = (found.searched.as_ref()?, analysis.setting.search.as_ref()?);
    let lattice = &searched.posture.lattice;
    let points = &analysis.track.path.points;
    // Of two points at one position, behind and before a rapid, the first is drawn.
    let mut columns: Vec<usize> = (0..lattice.points.len()).collect();
    columns.dedup_by(|next, before| {
        points[lattice.points[*next]].along <= points[lattice.points[*before]].along
    });
    let turns = lattice.spins.len();
    let cell = |(deviation, status): (&f64, &PostureStatus)| match status {
        PostureStatus::Usable => Cell::Deviation(to_um(deviation)),
        PostureStatus::OutsideLimits => Cell::OutsideJointLimits,
        PostureStatus::Singular => Cell::Singular,
        PostureStatus::InCollision => Cell::InCollision,
        PostureStatus::Unstable | PostureStatus::OutOfReach => Cell::OutOfReach,
    };
    let cells = |column: &usize| {
        let at = column * turns..(column + 1) * turns;
        let both = lattice.deviations[at.clone()].iter().zip(&lattice.statuses[at]);
        both.map(cell).collect::<Vec<_>>()
    };
    let of_column = |column: &usize| lattice.points[*column];
    let usable = |index: usize| {
        searched
            .posture
            .unreachable
            .binary_search_by_key(&index, |(lost, _)| *lost)
            .is_err()
    };
    let drawing = CellMap {
        title: format!("{name}: spin of the tool along the path"),
        subtitle,
        quantity: quantity(search).to_owned(),
        across: columns
            .iter()
            .map(|c| to_mm(points[of_column(c)].along))
            .collect(),
        up: lattice.spins.iter().map(to_deg).collect(),
        cells: columns.iter().flat_map(cells).collect(),
        chosen: columns
            .iter()
            .map(of_column)
            .map(|index| {
                if usable(index) {
                    to_deg(searched.posture.spins[index])
                } else {
                    f64::NAN
                }
            })
            .collect(),
        tolerance_um: Some(to_um(analysis.setting.tolerance)),
        labels: AxisLabels {
            horizontal: "along the path (mm)".to_owned(),
            vertical: "spin of the tool (deg)".to_owned(),
        },
        chosen_word: "chosen spin".to_owned(),
        period: Some(360.0),
        marks: Vec::new(),
    };
    Some(Picture {
        name: format!("{}-turns", crate::file_names::slug(name)),
        caption: format!(
            "{name}: deviation at each point of the path for each spin of the tool about its axis, in the branch chosen there, and the chosen spin."
        ),
        svg: drawing.to_svg(),
    })
}

/// The quantity of the colours.
fn quantity(search: &PostureSearch) -> &'static str {
    match search.component {
        Component::InPlane => "deviation across the tool (µm)",
        Component::CrossTrack => "deviation across the track (µm)",
        Component::Axial => "deviation along the tool (µm)",
    }
}

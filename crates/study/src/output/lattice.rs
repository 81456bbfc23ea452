//! The picture of a search for turns of the tool: path by turn, coloured by deviation, with the turn that was chosen.

use armill_core::kernel::Stand;
use armill_core::optimize::{Component, PostureSearch};
use armill_report::{AxisLabels, Cell, CellMap};

use super::pictures::Picture;
use crate::file::path::PathAnalysis;
use crate::run::PathFound;

/// Deviation over path and turn; `None` where nothing was searched for.
pub(super) fn picture(name: &str, subtitle: String, analysis: &PathAnalysis, found: &PathFound) -> Option<Picture> {
    let (searched, search) = (found.searched.as_ref()?, analysis.setting.search.as_ref()?);
    let lattice = &searched.posture.lattice;
    let points = &analysis.track.path.points;
    // Of points at one place, behind and before a rapid, the first is drawn.
    let mut columns: Vec<usize> = (0..lattice.points.len()).collect();
    columns.dedup_by(|next, before| {
        points[lattice.points[*next]].along <= points[lattice.points[*before]].along
    });
    let turns = lattice.spins.len();
    let cell = |(deviation, stand): (&f64, &Stand)| match stand {
        Stand::Holds => Cell::Holds(deviation * 1e6),
        Stand::OutsideLimits => Cell::OutsideJointLimits,
        Stand::Singular => Cell::Singular,
        Stand::Unstable | Stand::OutOfReach => Cell::OutOfReach,
    };
    let cells = |column: &usize| {
        let at = column * turns..(column + 1) * turns;
        let both = lattice.deviations[at.clone()].iter().zip(&lattice.stands[at]);
        both.map(cell).collect::<Vec<_>>()
    };
    let of_column = |column: &usize| lattice.points[*column];
    let stands = |index: usize| {
        searched
            .posture
            .lost
            .binary_search_by_key(&index, |(lost, _)| *lost)
            .is_err()
    };
    let drawing = CellMap {
        title: format!("{name}: how the tool may be turned along the path"),
        subtitle,
        quantity: quantity(search).to_owned(),
        across: columns.iter().map(|c| points[of_column(c)].along * 1e3).collect(),
        up: lattice.spins.iter().map(|spin| spin.to_degrees()).collect(),
        cells: columns.iter().flat_map(cells).collect(),
        chosen: columns
            .iter()
            .map(of_column)
            .map(|index| {
                if stands(index) {
                    searched.posture.spins[index].to_degrees()
                } else {
                    f64::NAN
                }
            })
            .collect(),
        tolerance_um: Some(analysis.setting.limit * 1e6),
        labels: AxisLabels {
            horizontal: "along the path (mm)".to_owned(),
            vertical: "turn of the tool (deg)".to_owned(),
        },
        chosen_word: "turn chosen".to_owned(),
        period: Some(360.0),
        marks: Vec::new(),
    };
    Some(Picture {
        name: format!("{}-turns", super::slug(name)),
        caption: format!(
            "{name}: deviation at each point of the path for each turn of the tool about its axis, in the branch that was chosen there, and the turn that was chosen."
        ),
        svg: drawing.to_svg(),
    })
}

/// What the colours mean.
fn quantity(search: &PostureSearch) -> &'static str {
    match search.component {
        Component::InPlane => "deviation across the tool (µm)",
        Component::CrossTrack => "deviation across the track (µm)",
        Component::Axial => "deviation along the tool (µm)",
    }
}

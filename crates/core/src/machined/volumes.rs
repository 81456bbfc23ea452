//! Material that is left, and material that is removed too much: by the dexels along z.

use rayon::prelude::*;

use crate::removal::{DexelPart, MaterialSpan};

/// The difference of two parts, m^3.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MaterialDifference {
    /// Material of the part outside of the nominal part.
    pub left: f64,
    /// Material of the nominal part that the part lacks.
    pub gouged: f64,
}

/// The difference of a part from the nominal one on the same raster; zero without a grid.
pub fn material_difference(part: &DexelPart, nominal: &DexelPart) -> MaterialDifference {
    let (Some(grid), Some(wanted)) = (part.grids().last(), nominal.grids().last()) else {
        return MaterialDifference::default();
    };
    let [columns, rows] = wanted.cells();
    let row = |row: usize| {
        let mut lengths = [0.0; 2];
        for column in 0..columns {
            let [there, here] = [grid, wanted].map(|grid| grid.material([column, row]).collect::<Vec<_>>());
            let common = common_length(&there, &here);
            lengths[0] += length(&there) - common;
            lengths[1] += length(&here) - common;
        }
        lengths
    };
    let lengths: Vec<[f64; 2]> = (0..rows).into_par_iter().map(row).collect();
    let sum = |k: usize| lengths.iter().map(|row| row[k]).sum::<f64>() * wanted.cell_area();
    MaterialDifference {
        left: sum(0),
        gouged: sum(1),
    }
}

fn length(spans: &[MaterialSpan]) -> f64 {
    spans.iter().map(|span| span.ends[1] - span.ends[0]).sum()
}

/// Length that both have; each from low to high.
fn common_length(one: &[MaterialSpan], other: &[MaterialSpan]) -> f64 {
    let (mut i, mut j, mut common) = (0, 0, 0.0);
    while let (Some(a), Some(b)) = (one.get(i), other.get(j)) {
        common += (a.ends[1].min(b.ends[1]) - a.ends[0].max(b.ends[0])).max(0.0);
        if a.ends[1] < b.ends[1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    common
}

//! Which unknowns can these poses tell apart?
//!
//! Unknowns are taken in order, and one is kept if a part of its column of at least so much of its length stands across all
//! columns kept before it (Gram and Schmidt, twice): a thousandth of what the chain has, a millionth of base and point,
//! which nothing but rounding makes equal. What is left out does within the poses what others do together: it
//! stays at its nominal value, and the others take its part.

use nalgebra::{DMatrix, DVector};

use super::unknown::{Place, Unknown};

/// Least part of the effect of a motion inside the chain that no other has. Real poses of arms leave either much less (axes that are parallel
/// by design) or much more; nearly redundant ones would get large values of opposite signs.
const OWN: f64 = 1e-3;
/// Likewise of base and point. A body that hardly turns leaves them uncertain, which their uncertainties tell.
const OWN_OF_FRAMES: f64 = 1e-6;
/// Parts of a redundant unknown that are named, of its effect.
const NAMED: f64 = 0.05;

/// An unknown that was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundant {
    /// Its index among those asked for.
    pub unknown: usize,
    /// Those that do together what it does, the strongest first; empty where no pose shows it.
    pub same_as: Vec<usize>,
}

/// Those that are kept, and those that are not, from any matrix with the columns' lengths and angles.
pub(super) fn select(j: &DMatrix<f64>, unknowns: &[Unknown]) -> (Vec<usize>, Vec<Redundant>) {
    let lengths: Vec<f64> = j.column_iter().map(|column| column.norm()).collect();
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for (unknown, length) in lengths.iter().enumerate() {
        if *length <= largest * 1e-12 {
            left_out.push(Redundant {
                unknown,
                same_as: Vec::new(),
            });
            continue;
        }
        let mut own: DVector<f64> = j.column(unknown) / *length;
        for _ in 0..2 {
            for across in &basis {
                own -= across * across.dot(&own);
            }
        }
        let part = own.norm();
        let least = match unknowns[unknown].place {
            Place::After(_) => OWN,
            Place::Base | Place::Tool => OWN_OF_FRAMES,
        };
        if part >= least {
            basis.push(own / part);
            kept.push(unknown);
        } else {
            left_out.push(Redundant {
                unknown,
                same_as: same_as(j, &kept, unknown),
            });
        }
    }
    (kept, left_out)
}

/// Those of `kept` that do together what `unknown` does.
fn same_as(j: &DMatrix<f64>, kept: &[usize], unknown: usize) -> Vec<usize> {
    let right = j.column(unknown).into_owned();
    let Some((shares, _)) = super::triangle::solve(&j.select_columns(kept), &right, 0.0) else {
        return Vec::new();
    };
    let strength = |k: usize| shares[k].abs() * j.column(kept[k]).norm();
    let mut found: Vec<usize> = (0..kept.len())
        .filter(|k| strength(*k) > NAMED * right.norm())
        .collect();
    found.sort_by(|a, b| strength(*b).total_cmp(&strength(*a)));
    found.into_iter().map(|k| kept[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_later_of_equal_unknowns_is_left_out_and_named_with_what_it_equals() {
        let j = DMatrix::from_columns(&[
            DVector::from_vec(vec![1.0, 0.0, 0.0, 0.0]),
            DVector::from_vec(vec![0.0, 0.0, 0.0, 0.0]),
            DVector::from_vec(vec![0.0, 3.0, 0.0, 0.0]),
            DVector::from_vec(vec![1.0, 6.0, 1e-5, 0.0]),
            DVector::from_vec(vec![1.0, 1.0, 0.1, 0.0]),
        ]);
        let inside = Unknown {
            place: Place::After(0),
            component: 0,
        };
        let (kept, left_out) = select(&j, &[inside; 5]);
        assert_eq!(kept, [0, 2, 4]);
        let named: Vec<_> = left_out
            .into_iter()
            .map(|one| (one.unknown, one.same_as))
            .collect();
        assert_eq!(named, [(1, vec![]), (3, vec![2, 0])]);
        let frame = Unknown {
            place: Place::Base,
            component: 0,
        };
        assert_eq!(select(&j, &[frame; 5]).0, [0, 2, 3]);
    }
}

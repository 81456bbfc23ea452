//! Selection of the identifiable unknowns.
//!
//! Unknowns are taken in order, and one is kept if at least this part of its column's length is orthogonal to all
//! columns kept before it (Gram and Schmidt, twice): a thousandth for the chain, a millionth for base and point,
//! which are equal only by rounding. The effect of an unknown that is left out is a combination of others: it
//! stays at its nominal value, and the others include its effect.

use nalgebra::{DMatrix, DVector};

use super::unknown::{ParameterLocation, Unknown};

/// Least part of the effect of a motion inside the chain that no other has. Real arms have either much less (axes that
/// are parallel by design) or much more; nearly redundant unknowns would get large values of opposite signs.
const OWN: f64 = 1e-3;
/// The same for base and point. A body with little rotation leaves them uncertain, as their uncertainties show.
const OWN_OF_FRAMES: f64 = 1e-6;
/// Parts of a redundant unknown that are named, as a fraction of its effect.
const NAMED: f64 = 0.05;

/// An unknown that was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundant {
    /// Its index among the unknowns.
    pub unknown: usize,
    /// Unknowns whose combination has the same effect, the strongest first; empty where no pose shows it.
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
            ParameterLocation::After(_) => OWN,
            ParameterLocation::Base | ParameterLocation::Tool => OWN_OF_FRAMES,
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

/// The combination of `kept` with the effect of `unknown`.
fn same_as(j: &DMatrix<f64>, kept: &[usize], unknown: usize) -> Vec<usize> {
    let right = j.column(unknown).into_owned();
    let Some((shares, _)) = crate::least_squares::solve(&j.select_columns(kept), &right, 0.0) else {
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
            place: ParameterLocation::After(0),
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
            place: ParameterLocation::Base,
            component: 0,
        };
        assert_eq!(select(&j, &[frame; 5]).0, [0, 2, 3]);
    }
}

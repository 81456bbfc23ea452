//! The points of a path in planes, in the part's axes: made once for each precision, whatever the places.

use nalgebra::{Matrix3, Vector3};

use super::block::{BLOCK, Planes, planes};
use super::real::Float;
use crate::kernel::placed::{Pushes, Sighted, ToldIn};
use crate::spatial::Wrench;

/// The points of a path in planes, and what pushes there.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct Laid<T> {
    pub count: usize,
    pub at: Vec<Planes<T, 3>>,
    /// Empty where all are `still`.
    pub rotations: Vec<Planes<T, 9>>,
    pub still: Matrix3<f64>,
    /// Empty where all are those of `steady`.
    pub along: Vec<Planes<T, 6>>,
    pub steady: [Vector3<f64>; 2],
    pub told_in: ToldIn,
    pub cases: usize,
    /// Force and moment, case after case in each block; empty where all points share `cases_of_all`.
    pub wrenches: Vec<Planes<T, 6>>,
    pub cases_of_all: Vec<Wrench>,
    pub moments: bool,
    /// The largest force (N) and moment (N m) of all.
    pub strongest: [f64; 2],
}

impl<T: Float> Laid<T> {
    /// These points under what pushes there.
    pub fn new(points: &[Sighted], pushes: &Pushes) -> Laid<T> {
        let rotation = |point: &Sighted| *point.part_from_tool.rotation.to_rotation_matrix().matrix();
        let still = points.first().map_or_else(Matrix3::identity, rotation);
        let steady = points.first().map_or([Vector3::zeros(); 2], |point| point.along);
        let is_still = points.iter().all(|point| rotation(point) == still);
        let is_steady = points.iter().all(|point| point.along == steady);
        let of_all = pushes.wrenches.len() == pushes.cases;
        let strongest = |of: fn(&Wrench) -> Vector3<f64>| {
            let norms = pushes.wrenches.iter().map(|wrench| of(wrench).norm());
            norms.fold(0.0, f64::max)
        };
        let mut laid = Laid {
            count: points.len(),
            at: Vec::new(),
            rotations: Vec::new(),
            still,
            along: Vec::new(),
            steady,
            told_in: pushes.told_in,
            cases: pushes.cases,
            wrenches: Vec::new(),
            cases_of_all: if of_all {
                pushes.wrenches.clone()
            } else {
                Vec::new()
            },
            moments: pushes.wrenches.iter().any(|w| w.moment != Vector3::zeros()),
            strongest: [strongest(|w| w.force), strongest(|w| w.moment)],
        };
        for (block, points) in points.chunks(BLOCK).enumerate() {
            // The rest of a block repeats its last point.
            let last = points.len() - 1;
            let point = |i: usize| &points[i.min(last)];
            laid.at
                .push(filled(|i| point(i).part_from_tool.translation.vector.into()));
            if !is_still {
                // Columns of the transpose are rows of the rotation.
                let rows = |i: usize| rotation(point(i)).transpose();
                laid.rotations.push(filled(|i| {
                    let rows = rows(i);
                    std::array::from_fn(|k| rows[k])
                }));
            }
            if !is_steady {
                laid.along.push(filled(|i| six(point(i).along)));
            }
            for case in 0..if of_all { 0 } else { pushes.cases } {
                let wrench = |i: usize| pushes.wrenches[(block * BLOCK + i.min(last)) * pushes.cases + case];
                laid.wrenches
                    .push(filled(|i| six([wrench(i).force, wrench(i).moment])));
            }
        }
        laid
    }
}

pub(super) fn six([a, b]: [Vector3<f64>; 2]) -> [f64; 6] {
    [a.x, a.y, a.z, b.x, b.y, b.z]
}

pub(super) fn filled<T: Float, const N: usize>(of: impl Fn(usize) -> [f64; N]) -> Planes<T, N> {
    let mut all: Planes<T, N> = planes();
    for i in 0..BLOCK {
        for (plane, value) in all.iter_mut().zip(of(i)) {
            plane[i] = T::from_f64(value);
        }
    }
    all
}

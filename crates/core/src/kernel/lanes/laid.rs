//! The points of a path in planes, in the part's axes: made once, whatever the places.

use nalgebra::{Matrix3, Vector3};

use super::block::{BLOCK, Planes, planes};
use crate::kernel::placed::{Pushes, Sighted, ToldIn};
use crate::spatial::Wrench;

/// The points of a path in planes, and what pushes there.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct Laid {
    pub count: usize,
    pub at: Vec<Planes<f64, 3>>,
    /// Empty where all are `still`.
    pub rotations: Vec<Planes<f64, 9>>,
    pub still: Matrix3<f64>,
    /// Empty where all are those of `steady`.
    pub along: Vec<Planes<f64, 6>>,
    pub steady: [Vector3<f64>; 2],
    pub told_in: ToldIn,
    pub cases: usize,
    /// Force and moment, case after case in each block; empty where all points share `cases_of_all`.
    pub wrenches: Vec<Planes<f64, 6>>,
    pub cases_of_all: Vec<Wrench>,
    pub moments: bool,
}

impl Laid {
    /// These points under what pushes there.
    pub fn new(points: &[Sighted], pushes: &Pushes) -> Laid {
        let rotation = |point: &Sighted| *point.part_from_tool.rotation.to_rotation_matrix().matrix();
        let still = points.first().map_or_else(Matrix3::identity, rotation);
        let steady = points.first().map_or([Vector3::zeros(); 2], |point| point.along);
        let is_still = points.iter().all(|point| rotation(point) == still);
        let is_steady = points.iter().all(|point| point.along == steady);
        let of_all = pushes.wrenches.len() == pushes.cases;
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

pub(super) fn filled<const N: usize>(of: impl Fn(usize) -> [f64; N]) -> Planes<f64, N> {
    let mut all: Planes<f64, N> = planes();
    for i in 0..BLOCK {
        for (plane, value) in all.iter_mut().zip(of(i)) {
            plane[i] = value;
        }
    }
    all
}

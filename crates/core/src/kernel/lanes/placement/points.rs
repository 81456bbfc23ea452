//! The points of a path in planes, in the part's axes: computed once per precision, for all placements.

use nalgebra::{Matrix3, Vector3};

use crate::kernel::path_on_part::{PathWrenches, PlacedPoint, WrenchAxes};
use crate::numbers::{BLOCK, Float, Planes, planes};
use crate::spatial::Wrench;

/// The points of a path in planes, and their wrenches.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct PlacementPoints<T> {
    pub count: usize,
    pub at: Vec<Planes<T, 3>>,
    /// Empty where all are `still`.
    pub rotations: Vec<Planes<T, 9>>,
    pub still: Matrix3<f64>,
    /// Empty where all are those of `steady`.
    pub along: Vec<Planes<T, 6>>,
    pub steady: [Vector3<f64>; 2],
    pub wrench_axes: WrenchAxes,
    pub cases: usize,
    /// Force and moment, case after case in each block; empty where all points have `cases_of_all`.
    pub wrenches: Vec<Planes<T, 6>>,
    pub cases_of_all: Vec<Wrench>,
    pub moments: bool,
    /// The largest force (N) and moment (N m) of all.
    pub strongest: [f64; 2],
}

impl<T: Float> PlacementPoints<T> {
    /// These points with these wrenches.
    pub fn new(points: &[PlacedPoint], load: &PathWrenches) -> PlacementPoints<T> {
        let rotation = |point: &PlacedPoint| *point.part_from_tool.rotation.to_rotation_matrix().matrix();
        let still = points.first().map_or_else(Matrix3::identity, rotation);
        let steady = points.first().map_or([Vector3::zeros(); 2], |point| point.along);
        let is_still = points.iter().all(|point| rotation(point) == still);
        let is_steady = points.iter().all(|point| point.along == steady);
        let of_all = load.wrenches.len() == load.cases;
        let strongest = |of: fn(&Wrench) -> Vector3<f64>| {
            let norms = load.wrenches.iter().map(|wrench| of(wrench).norm());
            norms.fold(0.0, f64::max)
        };
        let mut out = PlacementPoints {
            count: points.len(),
            at: Vec::new(),
            rotations: Vec::new(),
            still,
            along: Vec::new(),
            steady,
            wrench_axes: load.wrench_axes,
            cases: load.cases,
            wrenches: Vec::new(),
            cases_of_all: if of_all { load.wrenches.clone() } else { Vec::new() },
            moments: load.wrenches.iter().any(|w| w.moment != Vector3::zeros()),
            strongest: [strongest(|w| w.force), strongest(|w| w.moment)],
        };
        for (block, points) in points.chunks(BLOCK).enumerate() {
            // The last block is filled with its last point.
            let last = points.len() - 1;
            let point = |i: usize| &points[i.min(last)];
            out.at
                .push(filled(|i| point(i).part_from_tool.translation.vector.into()));
            if !is_still {
                // Columns of the transpose are rows of the rotation.
                let rows = |i: usize| rotation(point(i)).transpose();
                out.rotations.push(filled(|i| {
                    let rows = rows(i);
                    std::array::from_fn(|k| rows[k])
                }));
            }
            if !is_steady {
                out.along.push(filled(|i| six(point(i).along)));
            }
            for case in 0..if of_all { 0 } else { load.cases } {
                let wrench = |i: usize| load.wrenches[(block * BLOCK + i.min(last)) * load.cases + case];
                out.wrenches
                    .push(filled(|i| six([wrench(i).force, wrench(i).moment])));
            }
        }
        out
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

//! Input and output of a batch: one array per number, indexed by point.

use std::ops::Range;

use nalgebra::Rotation3;

use crate::kernel::lanes::load::CASE;
use crate::numbers::{BLOCK, Plane, Precision};

/// Tool poses in base. m.
#[derive(Clone, Copy, Debug)]
pub enum Poses<'a, T> {
    /// One orientation, many places: a plane, a section, a box.
    Still {
        /// Orientation of the tool everywhere.
        base_from_tool: Rotation3<f64>,
        /// Base x, y, z of each TCP.
        at: [&'a [T]; 3],
    },
    /// Any poses.
    Free {
        /// Rotation matrix of each, its nine numbers row by row.
        rotations: [&'a [T]; 9],
        /// Base x, y, z of each TCP.
        at: [&'a [T]; 3],
    },
}

impl<T> Poses<'_, T> {
    /// How many.
    ///
    /// # Panics
    /// If the arrays differ in length.
    pub fn len(&self) -> usize {
        match self {
            Poses::Still { at, .. } => length(at),
            Poses::Free { rotations, at } => {
                assert_eq!(length(rotations), length(at), "as many rotations as places");
                length(at)
            }
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Whether all poses have one orientation.
pub(super) fn is_still<T>(poses: &Poses<'_, T>) -> bool {
    matches!(poses, Poses::Still { .. })
}

/// The one length of these arrays.
pub(super) fn length<T>(arrays: &[&[T]]) -> usize {
    let count = arrays[0].len();
    assert!(
        arrays.iter().all(|array| array.len() == count),
        "arrays of points differ in length"
    );
    count
}

/// Several numbers per point, one array each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrays<T> {
    values: Vec<T>,
    count: usize,
}

impl<T: Precision> Arrays<T> {
    /// Array number `index`, one value per point.
    pub fn array(&self, index: usize) -> &[T] {
        &self.values[index * self.count..][..self.count]
    }

    /// Allocates `arrays` of `count` values.
    pub(super) fn resize(&mut self, arrays: usize, count: usize) {
        self.count = count;
        self.values.resize(arrays * count, T::default());
    }

    /// Copies the first values of `planes` into the arrays from `index` on, at these points.
    pub(super) fn take(&mut self, index: usize, planes: &[Plane<T>], points: Range<usize>) {
        for (k, plane) in planes.iter().enumerate() {
            let start = (index + k) * self.count + points.start;
            self.values[start..start + points.len()].copy_from_slice(&plane[..points.len()]);
        }
    }
}

/// Largest in-plane deviation of each pose, and its flags.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Envelopes<T> {
    /// Whole blocks: the last one may not be full.
    in_plane: Vec<T>,
    state: Vec<T>,
    count: usize,
}

impl<T: Precision> Envelopes<T> {
    /// Largest in-plane deviation of all load cases at each point, m. Finite everywhere; means something where
    /// [`Envelopes::flags`] has no bit of [`flag::UNREACHABLE`](crate::kernel::lanes::flag::UNREACHABLE).
    pub fn in_plane(&self) -> &[T] {
        &self.in_plane[..self.count]
    }

    /// Bits of [`flag`](crate::kernel::lanes::flag) at point `index`.
    pub fn flags(&self, index: usize) -> u32 {
        self.state[index].to_f64() as u32 % CASE
    }

    /// The load case that gives the largest deviation at point `index`.
    pub fn worst_case(&self, index: usize) -> usize {
        (self.state[index].to_f64() / f64::from(CASE)) as usize
    }

    pub(super) fn resize(&mut self, count: usize) {
        self.count = count;
        let room = count.next_multiple_of(BLOCK);
        self.in_plane.resize(room, T::default());
        self.state.resize(room, T::default());
    }

    /// Output of the block from point `first` on: deviation and state.
    pub(super) fn block(&mut self, first: usize) -> Option<[&mut Plane<T>; 2]> {
        let in_plane = self.in_plane.get_mut(first..)?.first_chunk_mut()?;
        let state = self.state.get_mut(first..)?.first_chunk_mut()?;
        Some([in_plane, state])
    }
}

//! How displacement and force at one end of a segment follow from those at the other, in all six directions.
//!
//! ```text
//! [u_2; f_2] = [ Tuu Tuf; Tfu Tff ] [u_1; f_1]      u = (x, y, z, rotations about x, y, z)
//! plane x z: v = x, p = turn about y      plane y z: v = y, p = -turn about x      along and about z: rods
//! ```
//!
//! End 1 is that of smaller z. `u` is the twist of an end, `f` the wrench that the part of larger z exerts, relative to the centre of the section, axes
//! x, y, z. Bending in two planes, stretching and torsion are independent, as the section is circular; gyroscopic moments of the turning spindle
//! are neglected. A long beam is divided into equal pieces, as the transfer over many half waves has growing exponentials: pieces are
//! coupled one by one.

use nalgebra::{Complex, Matrix2, Matrix4, Matrix6};

use super::bending::Bending;
use super::rod::{stretching, torsion};
use super::segment::Segment;

/// Halvings of a segment at most.
const MOST_HALVINGS: u32 = 12;

/// Transfer over one piece of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    /// `Tuu`.
    pub uu: Matrix6<Complex<f64>>,
    /// `Tuf`, m/N, rad/(N m), ...
    pub uf: Matrix6<Complex<f64>>,
    /// `Tfu`, N/m, N m/rad, ...
    pub fu: Matrix6<Complex<f64>>,
    /// `Tff`.
    pub ff: Matrix6<Complex<f64>>,
}

impl Transfer {
    /// The transfer over one of the equal pieces of the segment at the angular frequency `w` (rad/s), without the joint, and the number of pieces;
    /// `None` if the segment is too long.
    pub fn of_piece(segment: &Segment, w: f64) -> Option<(Transfer, usize)> {
        let of = |halvings: u32| Bending::of(segment, segment.length / f64::from(1_u32 << halvings), w);
        let halvings = (0..=MOST_HALVINGS).find(|halvings| of(*halvings).is_short())?;
        let count = 1_u32 << halvings;
        let length = segment.length / f64::from(count);
        let plane = of(halvings).transfer();
        let rods = [stretching(segment, length, w), torsion(segment, length, w)];
        let part = |row: usize, column: usize| part_of(&plane, &rods, [row, column]);
        let transfer = Transfer {
            uu: part(0, 0),
            uf: part(0, 1),
            fu: part(1, 0),
            ff: part(1, 1),
        };
        Some((transfer, usize::try_from(count).ok()?))
    }
}

/// One of the four parts of the transfer: `[row, column]` is 0 for displacements, 1 for forces.
fn part_of(
    plane: &Matrix4<Complex<f64>>,
    rods: &[Matrix2<Complex<f64>>; 2],
    part: [usize; 2],
) -> Matrix6<Complex<f64>> {
    let [row, column] = part;
    let mut all = Matrix6::zeros();
    // Indices of deflection and rotation, and the sign of the rotation.
    for (v, p, side) in [(0, 4, 1.0), (1, 3, -1.0)] {
        let own = plane.fixed_view::<2, 2>(2 * row, 2 * column);
        all[(v, v)] = own[(0, 0)];
        all[(v, p)] = own[(0, 1)] * side;
        all[(p, v)] = own[(1, 0)] * side;
        all[(p, p)] = own[(1, 1)];
    }
    for (k, rod) in [2, 5].into_iter().zip(rods) {
        all[(k, k)] = rod[(row, column)];
    }
    all
}

//! A uniform beam along z: how displacement and force at one end follow from those at the other, in all six directions.
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
use super::joint::Joint;
use super::rod::{stretching, torsion};
use super::section::{Material, Section};

/// Halvings of a segment at most.
const MOST_HALVINGS: u32 = 12;

/// What bends a beam.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BeamTheory {
    /// With shear and rotary inertia.
    #[default]
    Timoshenko,
    /// Euler and Bernoulli: without them; slender beams only.
    Euler,
}

/// A uniform part of a holder or a cutter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// `L`, above 0, m.
    pub length: f64,
    /// Diameters.
    pub section: Section,
    /// Material.
    pub material: Material,
    /// What bends it.
    pub theory: BeamTheory,
    /// Connection to what is in front of it (smaller z); none: rigid.
    pub joint: Option<Joint>,
}

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

impl Segment {
    /// The transfer over one of the equal pieces of the segment at the angular frequency `w` (rad/s), without the joint, and the number of pieces;
    /// `None` if the segment is too long.
    pub fn pieces(&self, w: f64) -> Option<(Transfer, usize)> {
        let of = |halvings: u32| Bending::of(self, self.length / f64::from(1_u32 << halvings), w);
        let halvings = (0..=MOST_HALVINGS).find(|halvings| of(*halvings).is_short())?;
        let count = 1_u32 << halvings;
        let length = self.length / f64::from(count);
        let plane = of(halvings).transfer();
        let rods = [stretching(self, length, w), torsion(self, length, w)];
        let part = |row: usize, column: usize| of_part(&plane, &rods, [row, column]);
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
fn of_part(
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

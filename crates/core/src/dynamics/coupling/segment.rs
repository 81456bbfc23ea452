//! A uniform beam along z: dynamic stiffness of its two ends in all six directions.
//!
//! ```text
//! [f_1; f_2] = [ D11 D12; D12^T D22 ] [u_1; u_2]      u = (x, y, z, rotations about x, y, z)
//! plane x z: v = x, p = turn about y      plane y z: v = y, p = -turn about x      along and about z: rods
//! ```
//!
//! End 1 is that of smaller z. The twist `u` and the wrench `f` of an end are relative to its centre, axes x, y, z. Bending in two planes,
//! stretching and torsion are independent, as the section is circular; gyroscopic moments of the turning spindle are neglected.

use nalgebra::{Complex, Matrix6};

use super::bending::bending;
use super::joint::Joint;
use super::rod::{stretching, torsion};
use super::section::{Material, Section};

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

/// Dynamic stiffness of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentStiffness {
    /// `D11`.
    pub near: Matrix6<Complex<f64>>,
    /// `D12`.
    pub across: Matrix6<Complex<f64>>,
    /// `D22`.
    pub far: Matrix6<Complex<f64>>,
}

impl Segment {
    /// Dynamic stiffness at the angular frequency `w` (rad/s), without the joint; `None` if it is not finite.
    pub fn stiffness(&self, w: f64) -> Option<SegmentStiffness> {
        let bending = bending(self, w)?;
        let (along, about) = (stretching(self, w), torsion(self, w));
        let zero = Matrix6::zeros();
        let mut all = [zero; 3];
        let planes = [bending.near, bending.across, bending.far];
        let rods = [
            [along.own, about.own],
            [along.across, about.across],
            [along.own, about.own],
        ];
        for ((matrix, plane), rod) in all.iter_mut().zip(planes).zip(rods) {
            // Indices of deflection and rotation, and the sign of the rotation.
            for (v, p, side) in [(0, 4, 1.0), (1, 3, -1.0)] {
                matrix[(v, v)] = plane[(0, 0)];
                matrix[(v, p)] = plane[(0, 1)] * side;
                matrix[(p, v)] = plane[(1, 0)] * side;
                matrix[(p, p)] = plane[(1, 1)];
            }
            matrix[(2, 2)] = rod[0];
            matrix[(5, 5)] = rod[1];
        }
        let [near, across, far] = all;
        let is_finite = |m: &Matrix6<Complex<f64>>| m.iter().all(|z| z.re.is_finite() && z.im.is_finite());
        (is_finite(&near) && is_finite(&across) && is_finite(&far)).then_some(SegmentStiffness {
            near,
            across,
            far,
        })
    }
}

//! A uniform part of a holder or a cutter: a beam along z.

use super::joint::Joint;
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

//! A cut at any depth, as stability needs it: its milling, and the mean directional matrix per depth.

use nalgebra::Matrix3;

use crate::load::{Cut, CuttingError, CuttingLaw, Lean, Milling};

/// A cut whose depth is free: cutter, law, engagement and feed of a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOfAnyDepth {
    milling: Milling,
    is_proportional: bool,
}

impl CutOfAnyDepth {
    /// The cut of this milling; runout is neglected.
    pub fn new(milling: &Milling) -> CutOfAnyDepth {
        let cutter = milling.cutter();
        CutOfAnyDepth {
            milling: *milling,
            is_proportional: cutter.corner_radius() == 0.0 && milling.cut().lean.lean == Lean::NONE,
        }
    }

    /// The same with this law.
    ///
    /// # Errors
    /// As [`Milling::new`].
    pub fn with_law(&self, law: CuttingLaw) -> Result<CutOfAnyDepth, CuttingError> {
        let milling = Milling::new(*self.milling.cutter(), law, *self.milling.cut())?;
        Ok(CutOfAnyDepth { milling, ..*self })
    }

    /// As given.
    pub fn milling(&self) -> &Milling {
        &self.milling
    }

    /// Pitch of the teeth, rad.
    pub fn pitch(&self) -> f64 {
        self.milling.cutter().pitch()
    }

    /// Whether the directional matrix is proportional to the depth: of a flat end mill that does not lean.
    pub fn is_proportional(&self) -> bool {
        self.is_proportional
    }

    /// The cut at this depth (m).
    ///
    /// # Errors
    /// As [`Milling::new`].
    pub fn at_depth(&self, depth: f64) -> Result<Milling, CuttingError> {
        let cut = Cut {
            depth,
            ..*self.milling.cut()
        };
        Milling::new(*self.milling.cutter(), *self.milling.law(), cut)
    }

    /// Mean directional matrix over the depth at this depth (m), Pa.
    ///
    /// # Errors
    /// As [`Milling::new`].
    pub fn per_depth(&self, depth: f64) -> Result<Matrix3<f64>, CuttingError> {
        Ok(self.at_depth(depth)?.mean_directional() / depth)
    }
}

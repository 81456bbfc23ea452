//! Force-deflection equilibrium of tool and cut: the deflected tool cuts less or more, and the force changes with it.
//!
//! ```text
//! d = A F(s) + g,     s = (d_y, d_z)              depth = ap - d_z,     strip of material moved by -d_y
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | deviation of the tip, feed frame: along the feed, to its left, to the spindle; of a leaning tool in the axes of the surface | m |
//! | `s` | offset of the tool from its path by the deflection: to the left, away from the part | m |
//! | `A` | compliance of the tip, feed frame | m/N |
//! | `g` | deviation without the cut, for example by weight | m |
//! | `F` | mean force of the cut with the tool at this offset | N |
//! | `ap` | nominal axial depth of the path | m |
//!
//! A deviation along the feed has no effect: a tool that lags behind cuts the same chip. The surfaces before the tool
//! are the nominal ones; material left by the deflection of an earlier pass is neglected.
//!
//! `s` is solved by Broyden's method, starting from the equilibrium at the previous point: on a path one or two forces
//! per point are enough. The equilibrium is accurate to 1e-5 of the deviation. There is no stable equilibrium where an
//! offset into the part increases the force more than the compliance can balance: the solution `s` is then opposite to
//! the deflection by the nominal force, and no cut starts this way: [`Rest::PulledIn`].
//!
//! Source: quasi-static equilibrium of tool and cut; Broyden, A class of methods for solving nonlinear simultaneous
//! equations, Mathematics of Computation 19, 1965 \[recalled\]; `docs/theory/cutting.md`.

use nalgebra::{Matrix2, Matrix3, Rotation3, Vector2, Vector3};

use super::cut::Cut;
use super::cutter::Cutter;
use super::law::CuttingLaw;
use super::milling::Milling;

/// Compliance of the tip, in any axes: `d = A F + g`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipCompliance {
    /// `A`, m/N.
    pub by_force: Matrix3<f64>,
    /// `g`, m.
    pub unloaded: Vector3<f64>,
}

impl TipCompliance {
    /// The deviation under `force` (N), m.
    pub fn under(&self, force: Vector3<f64>) -> Vector3<f64> {
        self.by_force * force + self.unloaded
    }

    /// The same in other axes: `of_these` turns vectors of the current axes into the new ones.
    #[must_use]
    pub fn rotated(&self, of_these: &Rotation3<f64>) -> TipCompliance {
        TipCompliance {
            by_force: of_these.matrix() * self.by_force * of_these.matrix().transpose(),
            unloaded: of_these * self.unloaded,
        }
    }
}

/// Result of the search for the equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rest {
    /// Equilibrium at this mean force on the tool; N, feed frame.
    Settled(Vector3<f64>),
    /// No stable equilibrium: the cut pulls the tool into the part.
    PulledIn,
}

/// Finds the equilibrium of tool and cut, point after point.
#[derive(Clone, Debug)]
pub struct ForceEquilibrium {
    cutter: Cutter,
    law: CuttingLaw,
    /// Offset of the tool at the last equilibrium, m.
    offset: Vector2<f64>,
    /// Derivative of the residual by `s`.
    slope: Matrix2<f64>,
}

/// Permitted residual, relative to the deviation.
const CLOSE: f64 = 1e-5;
/// Residual that is always permitted, m: a hundredth of a nanometre.
const FLOOR: f64 = 1e-11;
/// Maximum number of forces computed per point.
const MOST_ROUNDS: usize = 40;
/// Longest step of the search, in depths of the cut: beyond it the force is not linear.
const LONGEST_STEP: f64 = 0.5;

impl Cut {
    /// The cut of a tool of this `radius` (m) with the offset `s` (m: to the left, away from the part); `None` if it
    /// cuts nothing.
    pub fn deflected(&self, s: Vector2<f64>, radius: f64) -> Option<Cut> {
        let depth = self.depth - s.y;
        let engagement = self.engagement.deflected(s.x, radius)?;
        (depth > 0.0).then_some(Cut {
            depth,
            engagement,
            ..*self
        })
    }
}

impl ForceEquilibrium {
    /// Before the first point.
    pub fn new(cutter: Cutter, law: CuttingLaw) -> ForceEquilibrium {
        ForceEquilibrium {
            cutter,
            law,
            offset: Vector2::zeros(),
            slope: Matrix2::identity(),
        }
    }

    /// Sets the tool for the points that follow.
    pub fn set_cutter(&mut self, cutter: Cutter) {
        self.cutter = cutter;
    }

    /// The equilibrium of `cut` and a tip of this compliance (feed frame); `nominal` is the force on the undeflected
    /// tool.
    pub fn rest(&mut self, cut: &Cut, nominal: Vector3<f64>, tip: &TipCompliance) -> Rest {
        let sides = cut.left_and_normal();
        let stiff = offset_under(tip, nominal, &sides);
        for restart in [false, true] {
            if restart {
                (self.offset, self.slope) = (Vector2::zeros(), Matrix2::identity());
            }
            if let Some(force) = self.search(cut, tip)
                && self.offset.dot(&stiff) >= 0.0
            {
                return Rest::Settled(force);
            }
        }
        (self.offset, self.slope) = (Vector2::zeros(), Matrix2::identity());
        Rest::PulledIn
    }

    /// The mean force (N, feed frame) of `cut` on the undeflected tool; `None` where there is no such cut.
    pub fn nominal_force(&self, cut: &Cut) -> Option<Vector3<f64>> {
        self.force(cut, Vector2::zeros())
    }

    /// The force at equilibrium, by steps from the last equilibrium.
    fn search(&mut self, cut: &Cut, tip: &TipCompliance) -> Option<Vector3<f64>> {
        let mut force = self.force(cut, self.offset)?;
        let sides = cut.left_and_normal();
        let mut residual = self.offset - offset_under(tip, force, &sides);
        for _ in 1..MOST_ROUNDS {
            if residual.norm() <= CLOSE * tip.under(force).norm() + FLOOR {
                return Some(force);
            }
            let step = -(self.slope.try_inverse()? * residual);
            let longest = LONGEST_STEP * cut.depth;
            let step = step * (longest / step.norm().max(longest));
            self.offset += step;
            force = self.force(cut, self.offset)?;
            let before = residual;
            residual = self.offset - offset_under(tip, force, &sides);
            let deviation_from_slope = residual - before - self.slope * step;
            self.slope += deviation_from_slope * step.transpose() / step.norm_squared();
        }
        None
    }

    /// The mean force on a tool with the offset `s`; `None` where there is no such cut.
    fn force(&self, cut: &Cut, s: Vector2<f64>) -> Option<Vector3<f64>> {
        match cut.deflected(s, self.cutter.radius()) {
            None => Some(Vector3::zeros()),
            Some(cut) => {
                let milling = Milling::new(self.cutter, self.law, cut).ok()?;
                Some(milling.mean_force())
            }
        }
    }
}

/// Offset of the tip under `force`, m: to the left, away from the part; these are the directions `sides` in the feed frame.
fn offset_under(tip: &TipCompliance, force: Vector3<f64>, sides: &[Vector3<f64>; 2]) -> Vector2<f64> {
    let deviation = tip.under(force);
    Vector2::new(deviation.dot(&sides[0]), deviation.dot(&sides[1]))
}

#[cfg(test)]
mod tests;

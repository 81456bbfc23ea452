//! Where a tool comes to rest that the cut pushes off its path: less is cut then, or more, and the force follows.
//!
//! ```text
//! d = A F(s) + g,     s = (d_y, d_z)              depth = ap - d_z,     strip of material moved by -d_y
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `d` | deviation of the tip, feed frame: along the feed, to its left, to the spindle | m |
//! | `s` | by how much the tool strays from its path: to the left, away from the part | m |
//! | `A` | how the tip yields to a force, feed frame | m/N |
//! | `g` | deviation without the cut, weight for one | m |
//! | `F` | mean force of the cut as it is with the tool there | N |
//! | `ap` | axial depth of the path as drawn | m |
//!
//! Along the feed nothing changes: a tool that lags behind cuts the same chip. The surfaces before the tool are those of
//! the drawing; what an earlier pass left by straying itself is not looked at.
//!
//! `s` is sought by Broyden's method, from where the tool rested a point before: on a path one or two forces a point are
//! enough. Where the tool rests is told to 1e-5 of the deviation. It does not rest where straying into the part
//! pushes it farther in than it strayed: `s` then lies opposite to where the force of the drawn path pushes, no cut
//! begins so: [`Rest::PulledIn`].
//!
//! Source: quasi-static equilibrium of tool and cut; Broyden, A class of methods for solving nonlinear simultaneous
//! equations, Mathematics of Computation 19, 1965 \[recalled\]; `docs/theory/cutting.md`.

use nalgebra::{Matrix2, Matrix3, Rotation3, Vector2, Vector3};

use super::cutter::Cutter;
use super::law::CuttingLaw;
use super::milling::{Cut, Milling};

/// How a tip yields, in any axes: `d = A F + g`.
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

    /// The same told in other axes: `of_these` turns vectors of these axes into those.
    #[must_use]
    pub fn rotated(&self, of_these: &Rotation3<f64>) -> TipCompliance {
        TipCompliance {
            by_force: of_these.matrix() * self.by_force * of_these.matrix().transpose(),
            unloaded: of_these * self.unloaded,
        }
    }
}

/// Whether tool and cut rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rest {
    /// They do, under this mean force on the tool; N, feed frame.
    Settled(Vector3<f64>),
    /// They do not: the cut draws the tool in.
    PulledIn,
}

/// Finds where tool and cut rest, point after point.
#[derive(Clone, Debug)]
pub struct ForceEquilibrium {
    cutter: Cutter,
    law: CuttingLaw,
    /// Where the tool rested last, m.
    offset: Vector2<f64>,
    /// How what is missing to rest changes with `s`.
    slope: Matrix2<f64>,
}

/// What is missing to rest, over the deviation.
const CLOSE: f64 = 1e-5;
/// What may always be missing, m: a hundredth of a nanometre.
const FLOOR: f64 = 1e-11;
/// Most forces at a point.
const MOST_ROUNDS: usize = 40;
/// Longest step of the search, in depths of the cut: beyond it the force is far from what its slope says.
const LONGEST_STEP: f64 = 0.5;

impl Cut {
    /// What is cut by a tool of this `radius` (m) that strays by `s` (m: to the left, away from the part); `None` if nothing is.
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

    /// The tool from here on.
    pub fn set_cutter(&mut self, cutter: Cutter) {
        self.cutter = cutter;
    }

    /// Where `cut` and a tip that yields so (feed frame) rest; `drawn` is the force of the path as drawn.
    pub fn rest(&mut self, cut: &Cut, nominal: Vector3<f64>, tip: &TipCompliance) -> Rest {
        let stiff = offset_under(tip, nominal);
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

    /// The mean force (N, feed frame) of `cut` on a tool that does not stray; `None` where there is no such cut.
    pub fn nominal_force(&self, cut: &Cut) -> Option<Vector3<f64>> {
        self.force(cut, Vector2::zeros())
    }

    /// The force at rest, by steps from where the tool rested last.
    fn search(&mut self, cut: &Cut, tip: &TipCompliance) -> Option<Vector3<f64>> {
        let mut force = self.force(cut, self.offset)?;
        let mut missing = self.offset - offset_under(tip, force);
        for _ in 1..MOST_ROUNDS {
            if missing.norm() <= CLOSE * tip.under(force).norm() + FLOOR {
                return Some(force);
            }
            let step = -(self.slope.try_inverse()? * missing);
            let longest = LONGEST_STEP * cut.depth;
            let step = step * (longest / step.norm().max(longest));
            self.offset += step;
            force = self.force(cut, self.offset)?;
            let before = missing;
            missing = self.offset - offset_under(tip, force);
            let unforeseen = missing - before - self.slope * step;
            self.slope += unforeseen * step.transpose() / step.norm_squared();
        }
        None
    }

    /// The mean force on a tool that strays by `s`; `None` where there is no such cut.
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

/// By how much a tip strays under `force`, m: to the left, away from the part.
fn offset_under(tip: &TipCompliance, force: Vector3<f64>) -> Vector2<f64> {
    let deviation = tip.under(force);
    Vector2::new(deviation.y, deviation.z)
}

#[cfg(test)]
mod tests;

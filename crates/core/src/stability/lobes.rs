//! Lobes: the boundary of stability over the spindle speed, from the zeroth-order solution.
//!
//! For a flat end mill the directional matrix is proportional to the depth, and one table of complex depths gives all speeds. For a
//! ball or bull nose end mill, and for a tool that leans, the matrix is evaluated at `DEPTHS` depths in geometric steps; at each of
//! them the zeroth-order solution gives the depth `b'` that would be the boundary if the matrix stayed in proportion:
//!
//! ```text
//! stable at the depth b:  b'(b) > b        boundary: b'(b) = b
//! ```
//!
//! The lowest boundary is taken. At one speed it is found by bisection; over many speeds by interpolation of `log b'/b` over `log b`,
//! which is exact where the matrix follows a power of the depth.

use rayon::prelude::*;

use super::cut_of_any_depth::CutOfAnyDepth;
use super::zeroth_order::{Boundary, ZerothOrder};
use crate::dynamics::Mode;
use crate::load::CuttingError;

/// One point of the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobe {
    /// rad/s
    pub spindle: f64,
    /// The boundary; `None` if it is deeper than the deepest sought.
    pub boundary: Option<Boundary>,
}

/// The boundary of stability of some modes in a cut.
#[derive(Clone, Debug)]
pub struct StabilityLobes {
    /// By depth of cut (m), ascending; a single one at any depth where the force is proportional to it.
    tables: Vec<(f64, ZerothOrder)>,
    cutting: CutOfAnyDepth,
    modes: Vec<Mode>,
}

/// Two neighbouring depths (m) between which the boundary is crossed, with the solutions there.
type Crossing = [(f64, Option<Boundary>); 2];

/// Depths at which the directional matrix of a cutter with a corner is evaluated.
const DEPTHS: usize = 64;
/// Least of them over the deepest.
const LEAST_DEPTH: f64 = 1e-3;
/// Depth in parts of that of a table up to which its boundaries are sought: what is deeper is stable there.
const AHEAD: f64 = 1.6;
/// Every how many of these depths is tried for many speeds: an unstable range within a factor of 1.5 of the depth, below a stable one, is not found.
const STRIDE: usize = 4;
/// Halvings that find the boundary at one speed: to a millionth of a step of the depths.
const HALVINGS: usize = 20;

impl StabilityLobes {
    /// Of these modes (shapes in the feed frame) in this cut; boundaries deeper than `deepest` (m, above zero) are not sought.
    ///
    /// # Errors
    /// As [`crate::load::Milling::new`] at the deepest cut.
    pub fn new(
        modes: &[Mode],
        cutting: &CutOfAnyDepth,
        deepest: f64,
    ) -> Result<StabilityLobes, CuttingError> {
        let depths: Vec<f64> = if cutting.is_proportional() {
            vec![deepest]
        } else {
            let exponent = |step: usize| 1.0 - step as f64 / (DEPTHS - 1) as f64;
            (0..DEPTHS)
                .map(|step| deepest * LEAST_DEPTH.powf(exponent(step)))
                .collect()
        };
        let tables = depths
            .into_par_iter()
            .map(|depth| Ok((depth, table(modes, cutting, depth)?)))
            .collect::<Result<Vec<(f64, ZerothOrder)>, CuttingError>>()?;
        Ok(StabilityLobes {
            tables,
            cutting: *cutting,
            modes: modes.to_vec(),
        })
    }

    /// The boundary at these spindle speeds (rad/s, above zero).
    pub fn at_speeds(&self, speeds: &[f64]) -> Vec<Lobe> {
        let at = |spindle: &f64| Lobe {
            spindle: *spindle,
            boundary: self.interpolated(*spindle),
        };
        speeds.par_iter().map(at).collect()
    }

    /// The lowest boundary over all speeds.
    pub fn critical(&self) -> Option<Boundary> {
        self.exact(self.crossed(ZerothOrder::critical), ZerothOrder::critical)
    }

    /// The boundary without the delayed term.
    pub fn mode_coupling(&self) -> Option<Boundary> {
        self.exact(
            self.crossed(ZerothOrder::mode_coupling),
            ZerothOrder::mode_coupling,
        )
    }

    /// The boundary at one speed (rad/s, above zero).
    pub fn at_speed(&self, spindle: f64) -> Option<Boundary> {
        self.exact(self.crossed_at(spindle, 1), |table| table.at_speed(spindle))
    }

    /// Share of each mode in the boundary at one speed; their sum is 1.
    pub fn shares(&self, boundary: &Boundary, spindle: f64) -> Vec<f64> {
        let table = table(&self.modes, &self.cutting, boundary.depth);
        table.map_or_else(|_| Vec::new(), |table| table.shares(boundary, spindle))
    }

    /// The first pair of depths between which the boundary is crossed, with what `find` gives at both; the first may be missing.
    fn crossed(&self, find: impl Fn(&ZerothOrder) -> Option<Boundary>) -> Option<Crossing> {
        let mut before = (0.0, None);
        for (depth, table) in &self.tables {
            let found = find(table);
            if found.is_some_and(|boundary| boundary.depth <= *depth) {
                return Some([before, (*depth, found)]);
            }
            before = (*depth, found);
        }
        None
    }

    /// The same at one speed: only whether a depth is exceeded is sought up to the boundary, first at every `stride`-th depth.
    fn crossed_at(&self, spindle: f64, stride: usize) -> Option<Crossing> {
        let last = self.tables.len() - 1;
        let exceeded = |index: &usize| {
            let (depth, table) = &self.tables[*index];
            table.is_exceeded(spindle, *depth)
        };
        let strides = (0..last).step_by(stride).chain([last]);
        let unstable = match last {
            0 => 0,
            _ => {
                let beyond = strides.clone().find(exceeded)?;
                let near = beyond.saturating_sub(stride - 1)..beyond;
                near.clone().find(exceeded).unwrap_or(beyond)
            }
        };
        let at = |index: usize| (self.tables[index].0, self.tables[index].1.at_speed(spindle));
        let found = at(unstable);
        if found.1.is_none_or(|boundary| boundary.depth > found.0) {
            // At the very boundary the quick decision and the solution may differ.
            return self.crossed(|table| table.at_speed(spindle));
        }
        Some([unstable.checked_sub(1).map_or((0.0, None), at), found])
    }

    fn interpolated(&self, spindle: f64) -> Option<Boundary> {
        let [(low, before), (high, found)] = self.crossed_at(spindle, STRIDE)?;
        let found = found?;
        if low == 0.0 {
            return Some(found);
        }
        let Some(before) = before else {
            // From far to near within one step of the depths.
            let depth = (low * high).sqrt();
            return Some(Boundary { depth, ..found });
        };
        let excess = [(before, low), (found, high)].map(|(boundary, depth)| (boundary.depth / depth).ln());
        let part = excess[0] / (excess[0] - excess[1]);
        let depth = low * (high / low).powf(part);
        Some(Boundary { depth, ..found })
    }

    fn exact(
        &self,
        crossing: Option<Crossing>,
        find: impl Fn(&ZerothOrder) -> Option<Boundary>,
    ) -> Option<Boundary> {
        let [(mut low, _), (mut high, found)] = crossing?;
        let mut found = found?;
        if self.cutting.is_proportional() || low == 0.0 {
            return Some(found);
        }
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            let here = table(&self.modes, &self.cutting, middle).ok()?;
            match find(&here).filter(|boundary| boundary.depth <= middle) {
                Some(boundary) => (high, found) = (middle, boundary),
                None => low = middle,
            }
        }
        Some(Boundary { depth: high, ..found })
    }
}

/// The solution in proportion to the matrix at this depth (m).
fn table(modes: &[Mode], cutting: &CutOfAnyDepth, depth: f64) -> Result<ZerothOrder, CuttingError> {
    let per_depth = cutting.per_depth(depth)?;
    let deepest = if cutting.is_proportional() {
        depth
    } else {
        AHEAD * depth
    };
    Ok(ZerothOrder::new(modes, &per_depth, cutting.pitch(), deepest))
}

#[cfg(test)]
mod tests;

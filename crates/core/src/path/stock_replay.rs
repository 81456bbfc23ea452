//! The stock as it is at each point of a path: cut again in the order of the path.
//!
//! A point has the stock after the step that leads to it. What tilted tools cut remains, as in the
//! [engagement](super::engagement): the stock is then larger than in reality.

use super::cutting::{Cutting, NoForces};
use super::engagement::is_upright;
use super::placing::Placing;
use super::remaining::RemainingStock;
use super::sampled::SampledPath;
use super::stock::Stock;
use crate::clearance::Bounds;
use crate::load::EndMillBody;

/// A stock, and the path that cuts it as programmed: with the axes of the program, whatever lean or spin a search finds.
#[derive(Clone, Debug)]
pub struct CutStock<'a> {
    stock: &'a Stock,
    path: &'a SampledPath,
    placing: &'a Placing,
    /// Each cutter, with the point that it is used from.
    cutters: Vec<(usize, EndMillBody)>,
}

impl<'a> CutStock<'a> {
    /// The uncut `stock` (frame of the path), and the path with the cutters of its operations.
    ///
    /// # Errors
    /// A tool of the program that is not possible.
    pub fn new(
        cutting: &Cutting,
        (path, placing): (&'a SampledPath, &'a Placing),
        stock: &'a Stock,
    ) -> Result<CutStock<'a>, NoForces> {
        Ok(CutStock {
            stock,
            path,
            placing,
            cutters: cutting.bodies_along(path)?,
        })
    }

    /// The same with the path at another place.
    pub fn placed<'b>(&self, placing: &'b Placing) -> CutStock<'b>
    where
        'a: 'b,
    {
        CutStock {
            placing,
            ..self.clone()
        }
    }

    /// Position of the path in the cell.
    pub fn placing(&self) -> &'a Placing {
        self.placing
    }

    /// The box of the uncut stock, frame of the path, m.
    pub fn extent(&self) -> Bounds {
        Bounds::of(self.stock.corners())
    }

    /// Number of cells of the height map.
    pub fn cell_count(&self) -> usize {
        self.stock.heights().len()
    }

    /// The stock before the first point of the path, to be cut step by step.
    pub fn replay(&self) -> StockReplay<'_> {
        StockReplay {
            of: self,
            remaining: RemainingStock::new(self.stock.clone()),
            cutter: 0,
            passed: 0,
        }
    }
}

/// A stock that is cut along a path, step by step.
#[derive(Clone, Debug)]
pub struct StockReplay<'a> {
    of: &'a CutStock<'a>,
    remaining: RemainingStock,
    /// Index of the cutter.
    cutter: usize,
    /// Number of points passed.
    passed: usize,
}

impl StockReplay<'_> {
    /// The stock after the step to the next point; `None` after the last one.
    pub fn next_point(&mut self) -> Option<&RemainingStock> {
        let CutStock {
            path,
            placing,
            cutters,
            ..
        } = self.of;
        let index = self.passed;
        let point = path.points.get(index)?;
        while cutters
            .get(self.cutter + 1)
            .is_some_and(|(first, _)| *first <= index)
        {
            self.cutter += 1;
        }
        if is_upright(&placing.path_spindle(point)) {
            let before = (!path.begins(index)).then(|| path.points[index - 1].at);
            let step = [before.unwrap_or(point.at), point.at];
            self.remaining.remove(step, &cutters[self.cutter].1);
        }
        self.passed += 1;
        Some(&self.remaining)
    }

    /// The stock after the step to point `index`; `None` if the path has no such point.
    ///
    /// # Panics
    /// If a point behind it has been passed.
    pub fn at_point(&mut self, index: usize) -> Option<&RemainingStock> {
        assert!(self.passed <= index + 1, "the stock is not cut backwards");
        while self.passed <= index {
            self.next_point()?;
        }
        Some(&self.remaining)
    }
}

#[cfg(test)]
mod tests;

//! The stock as it is at each point of a path: cut again in the order of the path.
//!
//! A point has the stock after the step that leads to it. What tilted tools cut remains, as in the
//! [engagement](super::engagement): the stock is then larger than in reality.

use std::iter::Peekable;

use super::cutting::{Cutting, NoForces};
use super::engagement::is_upright;
use super::placing::Placing;
use super::program::Operation;
use super::remaining::RemainingStock;
use super::sampled::SampledPath;
use super::stock::Stock;
use crate::load::EndMillBody;

/// A stock that is cut along a path, step by step.
pub struct StockReplay<'a> {
    cutting: &'a Cutting,
    path: &'a SampledPath,
    placing: &'a Placing,
    remaining: RemainingStock,
    operations: Peekable<std::slice::Iter<'a, (usize, Operation)>>,
    cutter: EndMillBody,
    /// Number of points passed.
    passed: usize,
}

impl<'a> StockReplay<'a> {
    /// The uncut stock, before the first point of the path.
    pub fn new(
        cutting: &'a Cutting,
        (path, placing): (&'a SampledPath, &'a Placing),
        stock: Stock,
    ) -> StockReplay<'a> {
        StockReplay {
            cutting,
            path,
            placing,
            remaining: RemainingStock::new(stock),
            operations: path.operations.iter().peekable(),
            cutter: *cutting.cutter.body(),
            passed: 0,
        }
    }

    /// The stock after the step to the next point; `None` after the last one.
    ///
    /// # Errors
    /// A tool of the program that is not possible.
    pub fn next_point(&mut self) -> Result<Option<&RemainingStock>, NoForces> {
        let index = self.passed;
        let Some(point) = self.path.points.get(index) else {
            return Ok(None);
        };
        while let Some((_, operation)) = self.operations.next_if(|(first, _)| *first <= index) {
            self.cutter = *self.cutting.cutter_of(operation)?.body();
        }
        if is_upright(&self.placing.path_spindle(point)) {
            let before = (!self.path.begins(index)).then(|| self.path.points[index - 1].at);
            let step = [before.unwrap_or(point.at), point.at];
            self.remaining.remove(step, &self.cutter);
        }
        self.passed += 1;
        Ok(Some(&self.remaining))
    }
}

#[cfg(test)]
mod tests;

//! What a cut pushes with along a path: the forces of [`Process`] at every point, told in the feed frame.
//!
//! The mean over a revolution; where it is asked for also the greatest. An arm whose modes lie at some
//! 10 Hz does not follow the teeth: the mean moves it, and what the greatest force would move it if it stood still is a
//! bound. Feed, spindle, depths and the size of the tool are those of the program, where it tells them.
//!
//! What the tool meets comes from the [`stock`](super::stock), as far as the tool stands upright in it; else the
//! engagement is the same everywhere. The greatest force is searched for once for each cut, on the level; on a ramp it is
//! taken to be as many times the mean as there. In a stock cuts differ from point to point, and those
//! that are alike to [`ALIKE`] of the diameter share one search. Plunges and steep dives have no force here: the bottom of
//! the cutter is not modelled.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::engagement::{EngagementKind, Pass};
use super::placing::Placing;
use super::program::{Operation, Pace};
use super::sampled::SampledPath;
use super::sampler::PathPoint;
use super::stock::{Stock, StockError};
use crate::load::{
    Advance, CutHere, CutsAlong, Cutter, CuttingError, CuttingLaw, EndMillBody, Engagement, Greatest,
    Immersion, Process,
};
use crate::watch::{Cancelled, Watch};

/// What cuts, and how, where the program does not tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutting {
    /// The tool.
    pub cutter: Cutter,
    /// Force of a chip.
    pub law: CuttingLaw,
    /// Axial depth, m.
    pub depth: f64,
    /// Radial depth and its side.
    pub immersion: Immersion,
    /// Feed, m/s.
    pub feed: Option<f64>,
    /// Speed of the spindle, rad/s; clockwise.
    pub spindle: Option<f64>,
    /// Whether the greatest force is a load case too.
    pub greatest: Greatest,
}

/// Forces along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct CuttingForces {
    /// The cut and its forces at every point.
    pub cuts: CutsAlong,
    /// What is worth telling of them.
    pub given: ForcesTold,
}

/// Forces along a path in a few numbers, of the cuts as drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForcesTold {
    /// Largest mean force along the path, N.
    pub largest_mean: f64,
    /// Greatest force of a revolution where the mean is largest, or anywhere, if it is a case; N.
    pub greatest: f64,
    /// Standard uncertainty of the largest mean force over its size, from the law.
    pub relative_uncertainty: f64,
    /// Points without a force though something is cut: plunges, dives too steep, withdrawals, edges that pass beside it.
    pub without_force: usize,
    /// What the stock said; `None` where the engagement is the same everywhere.
    pub met: Option<Met>,
}

/// What a tool met in a stock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Met {
    /// Points with nothing ahead.
    pub in_air: usize,
    /// Points with material over the whole width.
    pub slots: usize,
    /// Points at which the tool leans: they have the engagement that is the same everywhere.
    pub leaning: usize,
    /// Deepest and widest cut, m.
    pub largest_depth: f64,
    /// Likewise across the feed, m.
    pub largest_width: f64,
    /// Taken away in all, m^3.
    pub removed: f64,
}

/// Why there are no forces along a path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoForces {
    /// Nobody tells the feed.
    #[error("line {line} cuts with a feed that is not told")]
    NoFeed {
        /// Line of the program.
        line: u32,
    },
    /// Nobody tells the speed of the spindle.
    #[error("line {line} cuts with a spindle speed that is not told")]
    NoSpindle {
        /// Line of the program.
        line: u32,
    },
    /// The cut cannot be.
    #[error("line {line}: {error}")]
    Cut {
        /// Line of the program.
        line: u32,
        /// Why.
        error: CuttingError,
    },
    /// The stock cannot be cut so.
    #[error("line {line}: {error}")]
    Stock {
        /// Line of the program.
        line: u32,
        /// Why.
        error: StockError,
    },
    /// The watch says so.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for NoForces {
    fn from(Cancelled: Cancelled) -> NoForces {
        NoForces::Cancelled
    }
}

/// Cuts of a stock whose depth and edges differ by less than this part of the diameter have one greatest force over
/// their mean: the peak of a slice that thin differs by as much.
pub const ALIKE: f64 = 0.02;

/// Points between two looks at the watch.
const POINTS_A_LOOK: usize = 1024;

impl Cutting {
    /// The forces at the points of `path`. A `stock` is cut away on the way.
    ///
    /// # Errors
    /// [`NoForces`] at the first point where the cut is not known or cannot be, or if the watch says so.
    pub fn along(
        &self,
        path: &SampledPath,
        placing: &Placing,
        stock: Option<&mut Stock>,
        watch: Watch<'_>,
    ) -> Result<CuttingForces, NoForces> {
        let mut walk = Walk::new(self, placing, stock);
        let mut cuts = Vec::with_capacity(path.points.len());
        for (index, point, operation) in path.with_operations() {
            if index % POINTS_A_LOOK == 0 {
                if watch.is_cancelled() {
                    return Err(NoForces::Cancelled);
                }
                (watch.finished)(POINTS_A_LOOK.min(path.points.len() - index));
            }
            if let Some(operation) = operation {
                walk.hold(operation)?;
            }
            let before = (!path.begins(index)).then(|| &path.points[index - 1]);
            cuts.push(walk.cut_at(before, point)?);
        }
        let (cutters, given) = walk.ended();
        Ok(CuttingForces {
            cuts: CutsAlong {
                cutters,
                law: self.law,
                greatest: self.greatest,
                points: cuts,
            },
            given,
        })
    }

    /// The cutter, in the size that an operation tells.
    fn held_in(&self, operation: &Operation) -> Result<Cutter, NoForces> {
        let Some(diameter) = operation.diameter.filter(|diameter| *diameter > 0.0) else {
            return Ok(self.cutter);
        };
        // A ball stays a ball where no corner is told.
        let alike = self.cutter.corner_radius() / self.cutter.diameter() * diameter;
        let corner = operation.corner_radius.unwrap_or(alike).min(diameter / 2.0);
        let line = operation.line;
        let sized = self.cutter.of_size(diameter, corner);
        sized.map_err(|error| NoForces::Cut { line, error })
    }

    /// The process of an operation at a point.
    fn process(
        &self,
        cutter: Cutter,
        operation: Option<&Operation>,
        point: &PathPoint,
    ) -> Result<Process, NoForces> {
        let line = point.line;
        let depths = operation.and_then(|operation| operation.depths);
        let immersion = match (depths, self.immersion) {
            (None, immersion) => immersion,
            (Some(depths), Immersion::Up(_)) => Immersion::Up(depths.radial),
            (Some(depths), Immersion::Down(_)) => Immersion::Down(depths.radial),
            (Some(depths), Immersion::Centred(_) | Immersion::Slot) => Immersion::Centred(depths.radial),
        };
        let depth = depths.map_or(self.depth, |depths| depths.axial);
        let engagement = Engagement::at_depth(immersion, &cutter, depth);
        Ok(Process {
            cutter,
            law: self.law,
            depth,
            engagement: engagement.map_err(|error| NoForces::Cut { line, error })?,
            feed: feed_at(point, self.feed)?,
            spindle: spindle_of(operation, self.spindle, point)?,
        })
    }
}

/// The feed to a point, m/s: the program's, or this one where it tells none.
pub(super) fn feed_at(point: &PathPoint, else_this: Option<f64>) -> Result<f64, NoForces> {
    let line = point.line;
    match point.pace {
        Pace::Feed(feed) if feed > 0.0 => Ok(feed),
        _ => else_this.ok_or(NoForces::NoFeed { line }),
    }
}

/// The speed of the spindle at a point, rad/s, whichever way it turns: the operation's, or this one where it tells none.
pub(super) fn spindle_of(
    operation: Option<&Operation>,
    else_this: Option<f64>,
    point: &PathPoint,
) -> Result<f64, NoForces> {
    let line = point.line;
    let given = operation.and_then(|operation| operation.spindle).map(f64::abs);
    let turns = |speed: &f64| *speed > 0.0;
    let speed = given.filter(turns).or(else_this.filter(turns));
    speed.ok_or(NoForces::NoSpindle { line })
}

/// A tool on its way along a path.
struct Walk<'a> {
    cutting: &'a Cutting,
    placing: &'a Placing,
    stock: Option<InStock<'a>>,
    /// All that were held.
    cutters: Vec<Cutter>,
    /// Which of them is held.
    evaluation: usize,
    operation: Option<&'a Operation>,
    peaks: Peaks,
    /// What has the largest mean force.
    largest: Option<Process>,
    given: ForcesTold,
}

impl<'a> Walk<'a> {
    fn new(cutting: &'a Cutting, placing: &'a Placing, stock: Option<&'a mut Stock>) -> Walk<'a> {
        Walk {
            cutting,
            placing,
            stock: stock.map(|stock| InStock {
                stock,
                met: Met::default(),
            }),
            cutters: vec![cutting.cutter],
            evaluation: 0,
            operation: None,
            peaks: Peaks::default(),
            largest: None,
            given: ForcesTold::default(),
        }
    }

    /// The tool of `operation` is taken, if it is not held already.
    fn hold(&mut self, operation: &'a Operation) -> Result<(), NoForces> {
        if self.operation.is_some_and(|evaluation| std::ptr::eq(evaluation, operation)) {
            return Ok(());
        }
        self.operation = Some(operation);
        let cutter = self.cutting.held_in(operation)?;
        let known = self.cutters.iter().position(|known| *known == cutter);
        self.evaluation = known.unwrap_or(self.cutters.len());
        if known.is_none() {
            self.cutters.push(cutter);
        }
        Ok(())
    }

    /// The cut on the way to `point` from the point `before`; from nowhere behind a rapid.
    fn cut_at(&mut self, before: Option<&PathPoint>, point: &PathPoint) -> Result<CutHere, NoForces> {
        let cutter = self.cutters[self.evaluation];
        let mut process = self.cutting.process(cutter, self.operation, point)?;
        let mut alike = process;
        let line = point.line;
        if let Some(stock) = &mut self.stock {
            let pass = Pass {
                from: before.unwrap_or(point).at,
                to: point.at,
                direction: point.direction,
                axis: self.placing.path_spindle(point),
            };
            let meets = stock.meets(&pass, cutter.body());
            match meets.map_err(|error| NoForces::Stock { line, error })? {
                Meets::AsTold => {}
                Meets::Nothing => return Ok(CutHere::NOTHING),
                Meets::Strip(engagement, depth) => {
                    (process.engagement, process.depth) = (engagement, depth);
                    alike = process.rounded(ALIKE);
                }
            }
        }
        let forces = self.forces([&process, &alike], self.placing.advance(point));
        forces.map_err(|error| NoForces::Cut { line, error })
    }

    /// What `process` pushes with, noted for what is told; its greatest force goes with its mean as in the cut `alike`.
    fn forces(&mut self, [process, alike]: [&Process; 2], advance: Advance) -> Result<CutHere, CuttingError> {
        let milling = match process.milling(advance) {
            Ok(milling) => milling,
            Err(CuttingError::Plunge { .. } | CuttingError::Withdrawal) => {
                self.given.without_force += 1;
                return Ok(CutHere::NOTHING);
            }
            Err(error) => return Err(error),
        };
        let mean = milling.mean();
        let size = mean.force.norm();
        self.given.without_force += usize::from(size == 0.0);
        let mut greatest = Vector3::zeros();
        if self.cutting.greatest == Greatest::SecondCase {
            greatest = self.peaks.over_mean(alike)? * size;
            self.given.greatest = self.given.greatest.max(greatest.norm());
        }
        if size > self.given.largest_mean {
            (self.given.largest_mean, self.largest) = (size, Some(*process));
            self.given.relative_uncertainty = along(&mean.covariance, &mean.force) / size;
        }
        Ok(CutHere {
            cutter: self.evaluation,
            cut: Some(*milling.cut()),
            mean: mean.force,
            greatest,
        })
    }

    /// All tools that were held, and what is told.
    fn ended(mut self) -> (Vec<Cutter>, ForcesTold) {
        if let (Greatest::LeftOut, Some(process)) = (self.cutting.greatest, self.largest) {
            // A cut whose mean was found has a peak.
            let over_mean = self.peaks.over_mean(&process).unwrap_or_default();
            self.given.greatest = over_mean.norm() * self.given.largest_mean;
        }
        self.given.met = self.stock.map(|stock| stock.met);
        (self.cutters, self.given)
    }
}

/// What the tool meets at a point.
enum Meets {
    /// What the cut of the study says.
    AsTold,
    /// Nothing.
    Nothing,
    /// A strip this deep (m).
    Strip(Engagement, f64),
}

/// A stock on the way, and what was met in it.
struct InStock<'a> {
    stock: &'a mut Stock,
    met: Met,
}

impl InStock<'_> {
    /// What the tool meets on `pass`.
    fn meets(&mut self, pass: &Pass, cutter: &EndMillBody) -> Result<Meets, StockError> {
        let engagement = match self.stock.cut(pass, cutter) {
            Ok(engagement) => engagement,
            Err(StockError::Tilted { .. }) => {
                self.met.leaning += 1;
                return Ok(Meets::AsTold);
            }
            Err(error) => return Err(error),
        };
        self.met.removed += engagement.volume;
        // The force of a dive is not known, whatever it bites into.
        if engagement.kind == EngagementKind::Plunge {
            return Ok(Meets::AsTold);
        }
        let Some(strip) = engagement.strip else {
            self.met.in_air += 1;
            return Ok(Meets::Nothing);
        };
        self.met.slots += usize::from(engagement.kind == EngagementKind::Slot);
        self.met.largest_depth = self.met.largest_depth.max(engagement.depth);
        self.met.largest_width = self.met.largest_width.max(engagement.width);
        Ok(Meets::Strip(strip, engagement.depth))
    }
}

/// Greatest forces over the size of the mean one, on the level, of the cuts that were asked for.
#[derive(Default)]
struct Peaks(BTreeMap<[u64; 7], Vector3<f64>>);

impl Peaks {
    fn over_mean(&mut self, process: &Process) -> Result<Vector3<f64>, CuttingError> {
        let [right, left] = process.engagement.edges();
        let size = [process.cutter.diameter(), process.cutter.corner_radius()];
        let key = [
            size[0],
            size[1],
            process.depth,
            right,
            left,
            process.feed,
            process.spindle,
        ]
        .map(f64::to_bits);
        if let Some(known) = self.0.get(&key) {
            return Ok(*known);
        }
        let force = process.force(Advance::Level)?;
        let found = force.peak / force.mean.force.norm().max(f64::MIN_POSITIVE);
        self.0.insert(key, found);
        Ok(found)
    }
}

/// Standard uncertainty of a force along itself.
fn along(covariance: &Matrix3<f64>, force: &Vector3<f64>) -> f64 {
    let direction = force.normalize();
    direction.dot(&(covariance * direction)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests;

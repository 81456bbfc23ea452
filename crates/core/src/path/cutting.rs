//! Cutting forces along a path: the forces of [`Process`] at every point, in the feed frame.
//!
//! The mean over a revolution and, if requested, the greatest force. An arm with modes at some 10 Hz does not follow
//! the teeth: the mean force deflects it; the static deflection under the greatest force is an upper bound. Feed,
//! spindle, depths and the size of the tool are those of the program, where given.
//!
//! The engagement comes from the [`stock`](super::stock) where the tool is upright; otherwise it is constant. The
//! greatest force is searched for once per cut, on the level; on a ramp the same ratio to the mean is used. In a stock
//! the cuts differ from point to point; cuts that are equal to [`ALIKE`] of the diameter share one search. Plunges and
//! steep dives have no force: the bottom of the cutter is not modelled.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::engagement::EngagementKind;
use super::pass::Pass;
use super::placing::Placing;
use super::program::{Operation, Pace};
use super::sampled::SampledPath;
use super::sampler::PathPoint;
use super::stock::{Stock, StockError};
use crate::load::{
    Advance, CutHere, CutsAlong, Cutter, CuttingError, CuttingLaw, EndMillBody, Engagement, GreatestForce,
    Immersion, MeanForce, Milling, Process,
};
use crate::watch::{Cancelled, Watch};

/// Tool and cut, where they are not given in the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutting {
    /// The tool.
    pub cutter: Cutter,
    /// Cutting force law.
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
    pub greatest: GreatestForce,
}

/// Forces along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct CuttingForces {
    /// The cut and its forces at every point.
    pub cuts: CutsAlong,
    /// Summary of the forces.
    pub summary: ForceSummary,
}

/// Summary of the forces along a path, for the nominal cuts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceSummary {
    /// Largest mean force along the path, N.
    pub largest_mean: f64,
    /// Greatest force of a revolution where the mean is largest, or anywhere, if it is a case; N.
    pub greatest: f64,
    /// Standard uncertainty of the largest mean force over its size, from the law.
    pub relative_uncertainty: f64,
    /// Points without a force although the tool cuts: plunges, dives that are too steep, withdrawals, edges that pass
    /// next to the material.
    pub without_force: usize,
    /// Engagement in the stock; `None` where the engagement is constant.
    pub stock_engagement: Option<StockEngagement>,
}

impl ForceSummary {
    /// The summary where the tool leans: with the forces of these cuts.
    #[must_use]
    pub fn of_leaning(self, cuts: &CutsAlong) -> ForceSummary {
        let mut of_leaning = ForceSummary {
            largest_mean: 0.0,
            greatest: 0.0,
            ..self
        };
        let mut largest = None;
        for here in &cuts.points {
            of_leaning.greatest = of_leaning.greatest.max(here.greatest.norm());
            if here.mean.norm() > of_leaning.largest_mean {
                (of_leaning.largest_mean, largest) = (here.mean.norm(), Some(here));
            }
        }
        let milling =
            largest.and_then(|here| Milling::new(cuts.cutters[here.cutter], cuts.law, here.cut?).ok());
        if let Some(milling) = milling {
            let mean = milling.mean();
            of_leaning.relative_uncertainty = along(&mean.covariance, &mean.force) / of_leaning.largest_mean;
            if cuts.greatest == GreatestForce::LeftOut {
                of_leaning.greatest = milling.peak(PEAK_STEPS).norm();
            }
        }
        of_leaning
    }
}

/// Engagement of a tool in a stock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StockEngagement {
    /// Points without material ahead.
    pub in_air: usize,
    /// Points with material over the whole width.
    pub slots: usize,
    /// Points at which the tool is tilted: they have the constant engagement.
    pub leaning: usize,
    /// Largest depth, m.
    pub largest_depth: f64,
    /// Largest width across the feed, m.
    pub largest_width: f64,
    /// Total removed volume, m^3.
    pub removed: f64,
}

/// Why there are no forces along a path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoForces {
    /// No feed is given.
    #[error("line {line}: no feed is given for this cut")]
    NoFeed {
        /// Line of the program.
        line: u32,
    },
    /// No spindle speed is given.
    #[error("line {line}: no spindle speed is given for this cut")]
    NoSpindle {
        /// Line of the program.
        line: u32,
    },
    /// The cut is not possible.
    #[error("line {line}: {error}")]
    Cut {
        /// Line of the program.
        line: u32,
        /// Reason.
        error: CuttingError,
    },
    /// The stock cannot be cut in this way.
    #[error("line {line}: {error}")]
    Stock {
        /// Line of the program.
        line: u32,
        /// Reason.
        error: StockError,
    },
    /// Cancelled by the watch.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for NoForces {
    fn from(Cancelled: Cancelled) -> NoForces {
        NoForces::Cancelled
    }
}

/// Cuts of a stock whose depth and edges differ by less than this fraction of the diameter share one ratio of the
/// greatest force to the mean: the peak of a slice that thin differs by as much.
pub const ALIKE: f64 = 0.02;

/// Steps of a period at which the greatest force of a leaning tool is sought.
const PEAK_STEPS: u32 = 360;
/// Points between two checks of the watch.
const POINTS_A_LOOK: usize = 1024;

impl Cutting {
    /// The forces at the points of `path`. A `stock` is cut away on the way.
    ///
    /// # Errors
    /// [`NoForces`] at the first point where the cut is not known or not possible, or if the watch cancels.
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
                walk.use_tool(operation)?;
            }
            let before = (!path.begins(index)).then(|| &path.points[index - 1]);
            cuts.push(walk.cut_at(before, point)?);
        }
        let (cutters, summary) = walk.ended();
        Ok(CuttingForces {
            cuts: CutsAlong {
                cutters,
                law: self.law,
                greatest: self.greatest,
                points: cuts,
            },
            summary,
        })
    }

    /// The end mills of a path, each with the point that it is used from.
    ///
    /// # Errors
    /// A tool of the program that is not possible.
    pub fn bodies_along(&self, path: &SampledPath) -> Result<Vec<(usize, EndMillBody)>, NoForces> {
        let mut bodies = vec![(0, *self.cutter.body())];
        for (first, operation) in &path.operations {
            bodies.push((*first, *self.cutter_of(operation)?.body()));
        }
        Ok(bodies)
    }

    /// The cutter with the size given in an operation.
    fn cutter_of(&self, operation: &Operation) -> Result<Cutter, NoForces> {
        let Some(diameter) = operation.diameter.filter(|diameter| *diameter > 0.0) else {
            return Ok(self.cutter);
        };
        // A ball stays a ball if no corner radius is given.
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

/// The feed to a point, m/s: from the program, otherwise this one.
pub(super) fn feed_at(point: &PathPoint, else_this: Option<f64>) -> Result<f64, NoForces> {
    let line = point.line;
    match point.pace {
        Pace::Feed(feed) if feed > 0.0 => Ok(feed),
        _ => else_this.ok_or(NoForces::NoFeed { line }),
    }
}

/// The spindle speed at a point, rad/s, for either direction: from the operation, otherwise this one.
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
    /// All cutters used.
    cutters: Vec<Cutter>,
    /// Index of the current cutter.
    current: usize,
    operation: Option<&'a Operation>,
    peaks: Peaks,
    /// The last cut, and its mean force.
    last: Option<(Process, Advance, MeanForce)>,
    /// The process with the largest mean force.
    largest: Option<Process>,
    summary: ForceSummary,
}

impl<'a> Walk<'a> {
    fn new(cutting: &'a Cutting, placing: &'a Placing, stock: Option<&'a mut Stock>) -> Walk<'a> {
        Walk {
            cutting,
            placing,
            stock: stock.map(|stock| InStock {
                stock,
                engagement: StockEngagement::default(),
            }),
            cutters: vec![cutting.cutter],
            current: 0,
            operation: None,
            peaks: Peaks::default(),
            last: None,
            largest: None,
            summary: ForceSummary::default(),
        }
    }

    /// Selects the tool of `operation`, if it is not selected already.
    fn use_tool(&mut self, operation: &'a Operation) -> Result<(), NoForces> {
        if self
            .operation
            .is_some_and(|current| std::ptr::eq(current, operation))
        {
            return Ok(());
        }
        self.operation = Some(operation);
        let cutter = self.cutting.cutter_of(operation)?;
        let known = self.cutters.iter().position(|known| *known == cutter);
        self.current = known.unwrap_or(self.cutters.len());
        if known.is_none() {
            self.cutters.push(cutter);
        }
        Ok(())
    }

    /// The cut on the way to `point` from the point `before`; `None` after a rapid.
    fn cut_at(&mut self, before: Option<&PathPoint>, point: &PathPoint) -> Result<CutHere, NoForces> {
        let cutter = self.cutters[self.current];
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
                Meets::Constant => {}
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

    /// Forces of `process`, added to the summary; the ratio of its greatest force to the mean is that of the cut
    /// `alike`.
    fn forces(&mut self, [process, alike]: [&Process; 2], advance: Advance) -> Result<CutHere, CuttingError> {
        let milling = match process.milling(advance) {
            Ok(milling) => milling,
            Err(CuttingError::Plunge { .. } | CuttingError::Withdrawal) => {
                self.summary.without_force += 1;
                return Ok(CutHere::NOTHING);
            }
            Err(error) => return Err(error),
        };
        // Points of a cut that does not change have one mean.
        let mean = match self.last {
            Some((last, known, mean)) if (last, known) == (*process, advance) => mean,
            _ => milling.mean(),
        };
        self.last = Some((*process, advance, mean));
        let size = mean.force.norm();
        self.summary.without_force += usize::from(size == 0.0);
        let mut greatest = Vector3::zeros();
        if self.cutting.greatest == GreatestForce::SecondCase {
            greatest = self.peaks.over_mean(alike)? * size;
            self.summary.greatest = self.summary.greatest.max(greatest.norm());
        }
        if size > self.summary.largest_mean {
            (self.summary.largest_mean, self.largest) = (size, Some(*process));
            self.summary.relative_uncertainty = along(&mean.covariance, &mean.force) / size;
        }
        Ok(CutHere {
            cutter: self.current,
            cut: Some(*milling.cut()),
            mean: mean.force,
            greatest,
        })
    }

    /// All tools used, and the summary.
    fn ended(mut self) -> (Vec<Cutter>, ForceSummary) {
        if let (GreatestForce::LeftOut, Some(process)) = (self.cutting.greatest, self.largest) {
            // A cut with a mean force has a peak.
            let over_mean = self.peaks.over_mean(&process).unwrap_or_default();
            self.summary.greatest = over_mean.norm() * self.summary.largest_mean;
        }
        self.summary.stock_engagement = self.stock.map(|stock| stock.engagement);
        (self.cutters, self.summary)
    }
}

/// Engagement of the tool at a point.
enum Meets {
    /// The constant engagement of the study.
    Constant,
    /// No material.
    Nothing,
    /// A strip of this depth (m).
    Strip(Engagement, f64),
}

/// A stock during the cut, and the engagement in it.
struct InStock<'a> {
    stock: &'a mut Stock,
    engagement: StockEngagement,
}

impl InStock<'_> {
    /// Engagement of the tool on `pass`.
    fn meets(&mut self, pass: &Pass, cutter: &EndMillBody) -> Result<Meets, StockError> {
        let engagement = match self.stock.cut(pass, cutter) {
            Ok(engagement) => engagement,
            Err(StockError::Tilted { .. }) => {
                self.engagement.leaning += 1;
                return Ok(Meets::Constant);
            }
            Err(error) => return Err(error),
        };
        self.engagement.removed += engagement.volume;
        // The force of a dive is not known, whatever the engagement.
        if engagement.kind == EngagementKind::Plunge {
            return Ok(Meets::Constant);
        }
        let Some(strip) = engagement.strip else {
            self.engagement.in_air += 1;
            return Ok(Meets::Nothing);
        };
        self.engagement.slots += usize::from(engagement.kind == EngagementKind::Slot);
        self.engagement.largest_depth = self.engagement.largest_depth.max(engagement.depth);
        self.engagement.largest_width = self.engagement.largest_width.max(engagement.width);
        Ok(Meets::Strip(strip, engagement.depth))
    }
}

/// Ratios of the greatest to the mean force, on the level, of the cuts computed so far.
#[derive(Default)]
struct Peaks(BTreeMap<[u64; 8], Vector3<f64>>);

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
            process.engagement.pass_before().unwrap_or(0.0),
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

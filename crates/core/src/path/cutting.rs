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

use super::bite::{Bite, BiteKind};
use super::cutter_profile::CutterProfile;
use super::placing::Placing;
use super::program::{Operation, Pace};
use super::sampler::PathPoint;
use super::stock::{Stock, StockError};
use crate::load::{
    Advance, CutHere, CutsAlong, Cutter, CuttingError, CuttingLaw, Engagement, Immersion, Peak, Process,
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

/// What becomes of the greatest force of a revolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Greatest {
    /// The mean alone is a load case.
    LeftOut,
    /// It is the second load case.
    SecondCase,
}

/// Forces along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct CuttingForces {
    /// The cut and its forces at every point.
    pub cuts: CutsAlong,
    /// What is worth telling of them.
    pub told: ForcesTold,
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
    /// The forces at `points`; `operations` come with the index of their first point. A `stock` is cut away on the way.
    ///
    /// # Errors
    /// [`NoForces`] at the first point where the cut is not known or cannot be, or if the watch says so.
    pub fn along(
        &self,
        (points, operations): (&[PathPoint], &[(usize, Operation)]),
        placing: &Placing,
        stock: Option<&mut Stock>,
        watch: Watch<'_>,
    ) -> Result<CuttingForces, NoForces> {
        let mut cuts = Vec::with_capacity(points.len());
        let mut told = ForcesTold {
            met: stock.as_ref().map(|_| Met::default()),
            ..ForcesTold::default()
        };
        let mut largest: Option<Process> = None;
        let mut peaks = Peaks::default();
        let mut stock = stock.map(|stock| InStock::of(stock, &self.cutter)).transpose()?;
        let mut cutters = vec![self.cutter];
        let mut cutter = 0;
        let mut operation = operations.iter().peekable();
        let mut of_operation = None;
        for (index, point) in points.iter().enumerate() {
            if index % POINTS_A_LOOK == 0 {
                if watch.is_cancelled() {
                    return Err(NoForces::Cancelled);
                }
                (watch.finished)(POINTS_A_LOOK.min(points.len() - index));
            }
            while let Some((_, next)) = operation.next_if(|(first, _)| *first <= index) {
                of_operation = Some(next);
                let held = self.held_in(next)?;
                cutter = cutters
                    .iter()
                    .position(|known| *known == held)
                    .unwrap_or(cutters.len());
                if cutter == cutters.len() {
                    cutters.push(held);
                }
                if let Some(stock) = &mut stock {
                    stock.profile = profile_of(&held, next.line)?;
                }
            }
            let no_cut = |error| NoForces::Cut {
                line: point.line,
                error,
            };
            let mut process = self.process(cutters[cutter], of_operation, point)?;
            let mut is_of_stock = false;
            if let (Some(stock), Some(met)) = (&mut stock, &mut told.met) {
                let before = index.checked_sub(1).map(|before| &points[before]);
                match stock.meets(before, point, placing, met)? {
                    Meets::AsTold => {}
                    Meets::Nothing => {
                        cuts.push(CutHere::NOTHING);
                        continue;
                    }
                    Meets::Strip(engagement, depth) => {
                        (process.engagement, process.depth) = (engagement, depth);
                        is_of_stock = true;
                    }
                }
            }
            let milling = match process.milling(placing.advance(point)) {
                Ok(milling) => milling,
                Err(CuttingError::Plunge { .. } | CuttingError::Withdrawal) => {
                    told.without_force += 1;
                    cuts.push(CutHere::NOTHING);
                    continue;
                }
                Err(error) => return Err(no_cut(error)),
            };
            let mean = milling.mean();
            let size = mean.force.norm();
            told.without_force += usize::from(size == 0.0);
            let mut greatest = Vector3::zeros();
            if self.greatest == Greatest::SecondCase {
                let alike = if is_of_stock {
                    process.rounded(ALIKE)
                } else {
                    process
                };
                greatest = peaks.over_mean(&alike).map_err(no_cut)? * size;
                told.greatest = told.greatest.max(greatest.norm());
            }
            if size > told.largest_mean {
                (told.largest_mean, largest) = (size, Some(process));
                told.relative_uncertainty = along(&mean.covariance, &mean.force) / size;
            }
            cuts.push(CutHere {
                cutter,
                cut: Some(*milling.cut()),
                mean: mean.force,
                greatest,
            });
        }
        if let (Greatest::LeftOut, Some(process)) = (self.greatest, largest) {
            // A cut whose mean was found has a peak.
            let over_mean = peaks.over_mean(&process).unwrap_or_default();
            told.greatest = over_mean.norm() * told.largest_mean;
        }
        Ok(CuttingForces {
            cuts: CutsAlong {
                cutters,
                law: self.law,
                with_greatest: self.greatest == Greatest::SecondCase,
                points: cuts,
            },
            told,
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
    let told = operation.and_then(|operation| operation.spindle).map(f64::abs);
    let turns = |speed: &f64| *speed > 0.0;
    let speed = told.filter(turns).or(else_this.filter(turns));
    speed.ok_or(NoForces::NoSpindle { line })
}

fn profile_of(cutter: &Cutter, line: u32) -> Result<CutterProfile, NoForces> {
    CutterProfile::new(cutter.diameter(), cutter.corner_radius())
        .map_err(|error| NoForces::Stock { line, error })
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

/// A cutter on its way through a stock.
struct InStock<'a> {
    stock: &'a mut Stock,
    profile: CutterProfile,
}

impl<'a> InStock<'a> {
    fn of(stock: &'a mut Stock, cutter: &Cutter) -> Result<InStock<'a>, NoForces> {
        let profile = profile_of(cutter, 1)?;
        Ok(InStock { stock, profile })
    }

    /// What the tool meets on its way to `point` from the point `before`, where it cut before.
    fn meets(
        &mut self,
        before: Option<&PathPoint>,
        point: &PathPoint,
        placing: &Placing,
        met: &mut Met,
    ) -> Result<Meets, NoForces> {
        let goes_on = before.filter(|before| before.along < point.along);
        let upright = PathPoint {
            axis: Some(placing.path_spindle(point)),
            ..*point
        };
        let bite = match self
            .stock
            .cut(goes_on.unwrap_or(point).at, &upright, &self.profile)
        {
            Ok(bite) => bite,
            Err(StockError::Tilted { .. }) => {
                met.leaning += 1;
                return Ok(Meets::AsTold);
            }
            Err(error) => {
                let line = point.line;
                return Err(NoForces::Stock { line, error });
            }
        };
        met.removed += bite.volume;
        // The force of a dive is not known, whatever it bites into.
        if bite.kind == BiteKind::Plunge {
            return Ok(Meets::AsTold);
        }
        let Some(strip) = self.strip(&bite) else {
            met.in_air += 1;
            return Ok(Meets::Nothing);
        };
        met.slots += usize::from(bite.kind == BiteKind::Slot);
        met.largest_depth = met.largest_depth.max(bite.axial_depth);
        met.largest_width = met.largest_width.max(bite.radial_depth);
        Ok(Meets::Strip(strip, bite.axial_depth))
    }

    /// What it bites into; `None` in the air, or if that has no width. A strip that reaches the rim at its own height goes
    /// on beyond it.
    fn strip(&self, bite: &Bite) -> Option<Engagement> {
        if bite.kind == BiteKind::Air {
            return None;
        }
        let radius = self.profile.radius();
        let right = if bite.exit >= std::f64::consts::PI {
            -radius
        } else {
            bite.right
        };
        let left = if bite.entry <= 0.0 { radius } else { bite.left };
        Engagement::strip([right, left], 2.0 * radius).ok()
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
        let Peak { force: peak, .. } = force.peak;
        let found = peak / force.mean.norm().max(f64::MIN_POSITIVE);
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

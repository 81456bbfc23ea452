//! What may a program ask for? Force, depth, width and feed that keep the tolerance, at its points and on all of it.
//!
//! ```text
//! |P A f| = e                                  force: along a direction, and in the one that permits least
//! |P (A F(cut) + g)| = e                       depth, width or feed of the cut, the others as drawn
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `e` | permitted deviation across the tool | m |
//! | `A`, `g` | how the tip yields there, and its deviation without a cut ([`TipYield`]) | m/N, m |
//! | `P` | takes away what lies along the tool | - |
//! | `F` | force of the cut at rest ([`crate::load::straying`]) | N |
//!
//! The smallest value at which the deviation first exceeds `e` counts, found by a scan from thin to thick and halving
//! between: with a weight that pulls one way, or a wide cut that pushes back, deviation need not grow all the way.
//! Where the greatest force is a load case it counts too, as many times the mean as in the cut drawn.
//!
//! Asked at points spread over the path, and where the deviation is largest; a limit of the whole path is the least of
//! theirs. Under a model in which the load changes the arm there are no limits here.

use nalgebra::{Matrix2x3, Vector3};

use super::program::{ProgramAnswer, Track};
use crate::kernel::Question;
use crate::load::{Cut, CutHere, CutsAlong, Greatest, PathLoad, Rest, Straying, TipYield};
use crate::source::Standing;
use crate::spatial::Wrench;
use crate::watch::{Cancelled, Watch};

/// What a point permits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Permitted {
    /// This much.
    UpTo(f64),
    /// All that was asked for, up to this.
    AtLeast(f64),
    /// Nothing: the deviation is too large however little is asked for.
    Nothing,
}

/// What a point of a program permits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLimits {
    /// Which point.
    pub index: usize,
    /// Force along the feed, to its left, along the tool, and in the direction that permits least; N.
    pub forces: [f64; 4],
    /// What the cut may be; `None` where nothing is cut, or no cut is known.
    pub cut: Option<CutLimits>,
}

/// What the cut at a point may be, each with all else as drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutLimits {
    /// Axial depth, m.
    pub depth: Permitted,
    /// Radial depth, m; `None` of a slot, whose width is the tool's.
    pub width: Option<Permitted>,
    /// Feed per tooth, m.
    pub feed_per_tooth: Permitted,
}

/// Largest deviation of a path over depth and feed.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthByFeed {
    /// Axial depths, m.
    pub depths: Vec<f64>,
    /// Feeds per tooth, m.
    pub feeds_per_tooth: Vec<f64>,
    /// Largest in-plane deviation of the points that decide, m; one row a depth. Infinite where a tool is drawn in.
    pub deviations: Vec<f64>,
}

/// What a program permits.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramLimits {
    /// At each point asked, in their order along the path.
    pub points: Vec<PointLimits>,
    /// Depth by feed, all else as drawn; `None` without a cut.
    pub sheet: Option<DepthByFeed>,
}

/// Points asked at most, beside the worst.
const SPREAD: usize = 300;
/// Deepest cut that is looked at, in diameters: end mills have flutes of some three.
const MOST_DEPTH: f64 = 3.0;
/// Thickest feed per tooth that is looked at, in diameters: no end mill takes more.
const MOST_FEED: f64 = 0.05;
/// Depths, widths or feeds of a scan, each this many times the one before.
const SCAN: usize = 14;
const SCAN_RATIO: f64 = 1.7;
/// Times that the stretch found is halved: to a thousandth of itself.
const HALVINGS: usize = 10;
/// Depths and feeds of the sheet.
const SHEET: usize = 24;
/// Points that decide on the sheet: as many that permit the least depth, and as many that permit the least feed.
const DECIDING: usize = 6;
/// The sheet reaches to this many times what is drawn or permitted, whichever is more.
const BEYOND: f64 = 1.6;

/// What `found`, the answer along `track` to `question`, permits for `limit` (m); `None` where the load changes the arm.
///
/// # Errors
/// [`Cancelled`] if the watch says so.
pub fn program_limits(
    question: &Question<'_>,
    track: &Track,
    found: &ProgramAnswer,
    limit: f64,
    watch: Watch<'_>,
) -> Result<Option<ProgramLimits>, Cancelled> {
    if !question.arm.model.is_affine() {
        return Ok(None);
    }
    let cuts = match &found.load {
        PathLoad::Cuts(cuts) => Some(cuts),
        _ => None,
    };
    let mut tips = Tips {
        standing: Standing::new(question.arm),
        track,
        found,
    };
    let mut points = Vec::new();
    for index in asked(found, cuts) {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        let Some(tip) = tips.at(index) else { continue };
        let here = cuts.map(|cuts| Varied::of(cuts, index, tip, limit));
        points.push(PointLimits {
            index,
            forces: forces(&tip, limit),
            cut: here.flatten().map(|mut here| here.limits()),
        });
    }
    let sheet = match cuts {
        Some(cuts) => sheet(cuts, &mut tips, &points, limit, watch)?,
        None => None,
    };
    Ok(Some(ProgramLimits { points, sheet }))
}

impl ProgramLimits {
    /// The least that any point permits of what `part` takes from its cut; `None` without a cut.
    pub fn least(&self, part: impl Fn(&CutLimits) -> Option<Permitted>) -> Option<(&PointLimits, Permitted)> {
        let of = |point| {
            let point: &PointLimits = point;
            point
                .cut
                .as_ref()
                .and_then(&part)
                .map(|permitted| (point, permitted))
        };
        let all = self.points.iter().filter_map(of);
        all.min_by(|a, b| a.1.value().total_cmp(&b.1.value()))
    }
}

impl Permitted {
    /// As a number: what is permitted at least.
    pub fn value(self) -> f64 {
        match self {
            Permitted::UpTo(value) | Permitted::AtLeast(value) => value,
            Permitted::Nothing => 0.0,
        }
    }
}

/// Points spread over those that are reached and cut something, with the worst of all.
fn asked(found: &ProgramAnswer, cuts: Option<&CutsAlong>) -> Vec<usize> {
    let cuts_there = |i: usize| cuts.is_none_or(|cuts| cuts.points[i].cut.is_some());
    let open: Vec<usize> = found
        .answers
        .held()
        .map(|(i, _)| i)
        .filter(|i| cuts_there(*i))
        .collect();
    let stride = open.len().div_ceil(SPREAD).max(1);
    let mut asked: Vec<usize> = open.iter().step_by(stride).copied().collect();
    asked.extend(
        found
            .answers
            .worst()
            .map(|(worst, _)| worst)
            .filter(|i| cuts_there(*i)),
    );
    asked.sort_unstable();
    asked.dedup();
    asked
}

/// How the tip yields along a program.
struct Tips<'a> {
    standing: Standing<'a>,
    track: &'a Track,
    found: &'a ProgramAnswer,
}

impl Tips<'_> {
    /// Feed frame; `None` where the arm does not hold its own weight.
    fn at(&mut self, index: usize) -> Option<TipYield> {
        self.standing.stand(self.found.answers.joints_at(index));
        let mut under = |force| {
            let twist = self.standing.elastic(&Wrench::from_force(force));
            twist.map(|twist| twist.linear).ok()
        };
        let columns = [under(Vector3::x())?, under(Vector3::y())?, under(Vector3::z())?];
        let gravity = self.standing.gravity().ok()?;
        let tip = TipYield {
            by_force: nalgebra::Matrix3::from_columns(&columns),
            unloaded: gravity.map_or_else(Vector3::zeros, |gravity| gravity.linear),
        };
        Some(tip.seen_from(&self.track.base_from_feed(index).inverse()))
    }
}

/// Force (N) that a tip permits along the feed, to its left, along the tool, and in the direction that permits least.
fn forces(tip: &TipYield, limit: f64) -> [f64; 4] {
    let across: Matrix2x3<f64> = tip.by_force.fixed_rows::<2>(0).into_owned();
    let along = |axis: usize| limit / across.column(axis).norm();
    // The square of the largest singular value.
    let softest = (across * across.transpose()).symmetric_eigenvalues().max();
    [along(0), along(1), along(2), limit / softest.max(0.0).sqrt()]
}

/// The cut at a point, to be made deeper, wider or faster.
struct Varied {
    straying: Straying,
    cutter_radius: f64,
    /// Radius of the widest circle that is engaged, m.
    widest: f64,
    cut: Cut,
    here: CutHere,
    greatest: Greatest,
    tip: TipYield,
    limit: f64,
}

impl Varied {
    fn of(cuts: &CutsAlong, index: usize, tip: TipYield, limit: f64) -> Option<Varied> {
        let here = cuts.points[index];
        let (cutter, cut) = (cuts.cutters[here.cutter], here.cut?);
        Some(Varied {
            straying: Straying::new(cutter, cuts.law),
            cutter_radius: cutter.radius(),
            widest: cutter.at_height(cut.depth).radius,
            cut,
            here,
            greatest: cuts.greatest,
            tip,
            limit,
        })
    }

    fn limits(&mut self) -> CutLimits {
        let (cut, radius) = (self.cut, self.cutter_radius);
        let (diameter, widest) = (2.0 * radius, self.widest);
        let feed = cut.feed.hypot(cut.rise);
        CutLimits {
            depth: self.permitted(MOST_DEPTH * diameter, |depth| Some(Cut { depth, ..cut })),
            width: (cut.engagement.width() < diameter).then(|| {
                self.permitted(2.0 * widest, |width| {
                    let engagement = cut.engagement.of_width(width, [widest, radius])?;
                    Some(Cut { engagement, ..cut })
                })
            }),
            feed_per_tooth: self.permitted(MOST_FEED * diameter, |thick| Some(fed(&cut, thick / feed))),
        }
    }

    /// The value up to `most` at which the deviation first exceeds the limit.
    fn permitted(&mut self, most: f64, cut: impl Fn(f64) -> Option<Cut>) -> Permitted {
        let mut holds = |value: f64| {
            let cut = cut(value);
            cut.is_none_or(|cut| self.deviation(&cut) <= self.limit)
        };
        let (mut low, mut high) = (0.0, most * SCAN_RATIO.powi(1 - SCAN as i32));
        loop {
            if !holds(high) {
                break;
            }
            if high >= most {
                return Permitted::AtLeast(most);
            }
            (low, high) = (high, (high * SCAN_RATIO).min(most));
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if holds(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        if low > 0.0 {
            Permitted::UpTo(low)
        } else {
            Permitted::Nothing
        }
    }

    /// In-plane deviation under `cut` (m); infinite where the tool is drawn in or there is no such cut.
    fn deviation(&mut self, cut: &Cut) -> f64 {
        let Some(drawn) = self.straying.drawn(cut) else {
            return f64::INFINITY;
        };
        let rest = self.straying.rest(cut, drawn, &self.tip);
        let Rest::Settled(force) = rest else {
            return f64::INFINITY;
        };
        let [mean, greatest] = self.here.under(force);
        let in_plane = |force| self.tip.under(force).xy().norm();
        match self.greatest {
            Greatest::LeftOut => in_plane(mean),
            Greatest::SecondCase => in_plane(mean).max(in_plane(greatest)),
        }
    }
}

/// The same cut at `times` its feed.
fn fed(cut: &Cut, times: f64) -> Cut {
    Cut {
        feed: cut.feed * times,
        rise: cut.rise * times,
        ..*cut
    }
}

/// Deviation over depth and feed at the points that permit least.
fn sheet(
    cuts: &CutsAlong,
    tips: &mut Tips<'_>,
    points: &[PointLimits],
    limit: f64,
    watch: Watch<'_>,
) -> Result<Option<DepthByFeed>, Cancelled> {
    let by = |part: fn(&CutLimits) -> Permitted| {
        let mut found: Vec<(f64, usize)> = points
            .iter()
            .filter_map(|point| point.cut.map(|cut| (part(&cut).value(), point.index)))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(DECIDING);
        found
    };
    let (by_depth, by_feed) = (by(|cut| cut.depth), by(|cut| cut.feed_per_tooth));
    let (Some((least_depth, _)), Some((least_feed, _))) = (by_depth.first(), by_feed.first()) else {
        return Ok(None);
    };
    let mut indices: Vec<usize> = by_depth.iter().chain(&by_feed).map(|(_, index)| *index).collect();
    indices.sort_unstable();
    indices.dedup();
    let mut deciding = Vec::new();
    for index in indices {
        deciding.extend(tips.at(index).and_then(|tip| Varied::of(cuts, index, tip, limit)));
    }
    let drawn = |of: fn(&Cut) -> f64| deciding.iter().map(|here| of(&here.cut)).fold(0.0, f64::max);
    let diameter = 2.0 * deciding.iter().map(|here| here.cutter_radius).fold(0.0, f64::max);
    let reach = |drawn: f64, least: f64, most: f64| (BEYOND * drawn.max(least)).min(most);
    let steps = |most: f64| {
        (1..=SHEET)
            .map(|k| most * k as f64 / SHEET as f64)
            .collect::<Vec<f64>>()
    };
    let depths = steps(reach(drawn(|cut| cut.depth), *least_depth, MOST_DEPTH * diameter));
    let most_feed = reach(
        drawn(|cut| cut.feed.hypot(cut.rise)),
        *least_feed,
        MOST_FEED * diameter,
    );
    let feeds_per_tooth = steps(most_feed);
    let mut deviations = Vec::with_capacity(depths.len() * feeds_per_tooth.len());
    for depth in &depths {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        for feed in &feeds_per_tooth {
            let of = |here: &mut Varied| {
                let cut = Cut {
                    depth: *depth,
                    ..here.cut
                };
                let drawn = cut.feed.hypot(cut.rise);
                here.deviation(&fed(&cut, feed / drawn))
            };
            deviations.push(deciding.iter_mut().map(of).fold(0.0, f64::max));
        }
    }
    Ok(Some(DepthByFeed {
        depths,
        feeds_per_tooth,
        deviations,
    }))
}

//! Parts of the edge of an end mill, and the pieces in which a leaning one is integrated.
//!
//! ```text
//! upright   corner 0 < kappa < corner end            cylinder r < z < ap
//! leaning   corner |kappa - theta| < acos(1 - ap/r)  cylinder r < z < r + (ap - r + r sin(theta))/cos(theta)
//!           bottom ((R - r) sin(theta) + r (1 - cos(theta)) - ap)/sin(theta) < rho < R - r
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `kappa`, `z`, `rho` | axial immersion angle, height over the tip, distance from the axis | rad, m, m |
//! | `theta` | angle between the tool axis and the normal of the surface | rad |
//! | `ap` | depth along the normal | m |
//! | `R`, `r` | radius of the cutter and of its corner | m |
//!
//! These are the points whose lowest position in a turn is below the upper surface. The bottom of a leaning bull nose cuts where the
//! feed goes into the part along the tool axis, as with a lead away from the feed; its edges are taken as radial. That of an
//! upright one is neglected, as is one that the feed leans into by less than 1 mrad: it rubs.
//!
//! Over a part the arcs have kinks where other conditions bound them. They are found by bisection, and each piece is integrated
//! separately.

use super::arcs_of_point::EngagedArcs;
use super::cut::Cut;
use super::cutter::{Cutter, EdgePoint};
use super::engaged_arcs::LeaningCut;

/// A part of the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EdgePart {
    /// The corner, between these axial immersion angles (rad).
    Corner([f64; 2]),
    /// The cylinder, between these heights (m).
    Cylinder([f64; 2]),
    /// The bottom, between these distances from the axis (m).
    Bottom([f64; 2]),
}

/// Feed along the tool axis over that across it from which the bottom cuts.
const INTO_BOTTOM: f64 = 1e-3;
/// Intervals in which kinks are sought, and most kinks of an interval.
const SCAN: usize = 32;
const MOST_KINKS: usize = 4;
/// Halvings of an interval: to a rounding of the part.
const HALVINGS: usize = 44;

/// The parts of the edge that may cut.
pub(super) fn parts(
    cutter: &Cutter,
    cut: &Cut,
    leaning: Option<&LeaningCut>,
) -> impl Iterator<Item = EdgePart> + use<> {
    let (r, depth) = (cutter.corner_radius(), cut.depth);
    let (corner, cylinder, bottom) = match leaning {
        None => ([0.0, cutter.corner_end(depth)], [r, depth], [0.0; 2]),
        Some(leaning) => {
            let [cos, sin] = leaning.lean;
            let theta = sin.atan2(cos);
            let reach = (1.0 - depth / r).clamp(-1.0, 1.0).acos();
            let end = std::f64::consts::FRAC_PI_2.min(theta + reach);
            let highest = r + (depth - r + r * sin) / cos;
            let flat = cutter.radius() - r;
            let [across, along] = leaning.feed;
            let lowest = flat * sin + r * (1.0 - cos);
            let bottom = match along < -INTO_BOTTOM * across {
                true => [((lowest - depth) / sin).max(0.0), flat],
                false => [0.0; 2],
            };
            ([(theta - reach).max(0.0), end], [r, highest], bottom)
        }
    };
    let corner = (r > 0.0 && corner[1] > corner[0]).then_some(EdgePart::Corner(corner));
    let cylinder = (cylinder[1] > cylinder[0]).then_some(EdgePart::Cylinder(cylinder));
    let bottom = (bottom[1] > bottom[0]).then_some(EdgePart::Bottom(bottom));
    [corner, cylinder, bottom].into_iter().flatten()
}

impl EdgePart {
    fn ends(self) -> [f64; 2] {
        match self {
            EdgePart::Corner(ends) | EdgePart::Cylinder(ends) | EdgePart::Bottom(ends) => ends,
        }
    }

    /// The point of the edge at this angle (rad), height or distance (m).
    pub(super) fn point(self, cutter: &Cutter, along: f64) -> EdgePoint {
        match self {
            EdgePart::Corner(_) => cutter.in_corner(along),
            EdgePart::Cylinder(_) => cutter.at_height(along),
            EdgePart::Bottom(_) => EdgePoint {
                height: 0.0,
                radius: along,
                sin_kappa: 0.0,
                cos_kappa: 1.0,
            },
        }
    }

    /// Chip width per angle (m/rad), height or distance (1).
    pub(super) fn width(self, cutter: &Cutter) -> f64 {
        match self {
            EdgePart::Corner(_) => cutter.corner_radius(),
            EdgePart::Cylinder(_) | EdgePart::Bottom(_) => 1.0,
        }
    }

    /// The middles of this many even slices, with their chip width (m).
    pub(super) fn middles(self, cutter: &Cutter, slices: u32) -> impl Iterator<Item = (EdgePoint, f64)> {
        let [from, to] = self.ends();
        let width = self.width(cutter) * (to - from) / f64::from(slices);
        (0..slices).map(move |slice| {
            let part = (f64::from(slice) + 0.5) / f64::from(slices);
            (self.point(cutter, from + part * (to - from)), width)
        })
    }

    /// The pieces between kinks that cut; `arcs` gives the arcs at an angle, height or distance.
    pub(super) fn pieces(self, arcs: impl Fn(f64) -> EngagedArcs) -> Vec<[f64; 2]> {
        let [from, to] = self.ends();
        let kind = |along: f64| arcs(along).kind();
        let mut pieces = Vec::new();
        let (mut begin, mut here, mut at) = (from, kind(from), from);
        let mut end_piece = |begin: f64, end: f64| {
            if end > begin && !arcs(0.5 * (begin + end)).is_empty() {
                pieces.push([begin, end]);
            }
        };
        for step in 1..=SCAN {
            let next = if step == SCAN {
                to
            } else {
                from + (to - from) * step as f64 / SCAN as f64
            };
            let there = kind(next);
            for _ in 0..MOST_KINKS {
                if here == there {
                    break;
                }
                let (mut low, mut high) = (at, next);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    match kind(middle) == here {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                end_piece(begin, high);
                (begin, at, here) = (high, high, kind(high));
            }
            (at, here) = (next, there);
        }
        end_piece(begin, to);
        pieces
    }
}

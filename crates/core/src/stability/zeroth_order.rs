//! Stability of milling by the zeroth-order solution: boundary at one spindle speed, lowest boundary, mode coupling.
//!
//! With the complex depth `x` of a branch (`loop_gain`) the boundary is
//!
//! ```text
//! b (1 - e^(-i w T)) = x,   1 - e^(-i w T) = 2 sin(w T/2) e^(i (pi/2 - w T/2)),   z = x e^(i (w T/2 - pi/2))
//! Im z = 0,   b = Re z/(2 sin(w T/2)) > 0        at the speed that gives T
//! b = |x|^2/(2 Re x), Re x > 0                   at that frequency, whatever the speed
//! Im x = 0,   b = Re x > 0                       without the delayed term: mode coupling
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `b` | depth of cut at the boundary of stability | m |
//! | `w` | angular frequency of chatter | rad/s |
//! | `T` | period of the teeth: pitch over spindle speed | s |
//!
//! Mode coupling is the instability of `M x'' + C x' + (K - b A_0/b) x = 0`: the cutting force depends on the displacement itself, not on
//! that relative to the surface of the tooth before. At `w = 0` it is static divergence.
//!
//! At one speed all roots of `Im z` are found from the nodes of `branches`: `|x|/2` bounds the depth, so segments are tried in the
//! order of their bound, until it exceeds the best root found. Within a segment `x` is interpolated and `z` evaluated at steps of at most
//! half a radian of `w T/2`; each change of sign is refined on the exact curve.
//!
//! Range of validity: directional factors are replaced by their mean. It is accurate where several teeth cut or the immersion is large; in
//! cuts of low radial immersion it misses the lobes of period doubling ([`super::multi_frequency`], [`super::discretisation`]).
//!
//! Source: Altintas, Budak, CIRP Annals 44 (1995) 357; mode coupling: Pan, Zhang, Zhu, Zhang, Chatter analysis of robotic machining process,
//! J. Mater. Process. Technol. 173 (2006) 301 \[both recalled\].

use nalgebra::{Complex, Matrix3};

use super::branches::{Node, Segment, nearest, segments, trace};
use super::loop_gain::LoopGain;
use crate::dynamics::Mode;

/// The boundary of stability at some condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary {
    /// Depth of cut, m.
    pub depth: f64,
    /// Angular frequency of chatter, rad/s; 0 for static divergence.
    pub angular_frequency: f64,
    /// Index of the mode with the largest share.
    pub mode: usize,
}

/// Modes in a cut whose force is proportional to its depth.
#[derive(Clone, Debug)]
pub struct ZerothOrder {
    gain: LoopGain,
    nodes: Vec<Node>,
    segments: Vec<Segment>,
    pitch: f64,
    deepest: f64,
}

/// A point of the curve: angular frequency (rad/s), complex depth (m).
type OnCurve = (f64, Complex<f64>);

/// A root of the imaginary part on the interpolated curve.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    depth: f64,
    ends: [OnCurve; 2],
}

/// Largest turn of `w T/2` between two evaluations, rad.
const TURN: f64 = 0.5;
/// Candidates within this factor of the best are refined.
const NEAR_BEST: f64 = 1.3;
/// Most steps of a refinement, and the relative change of the frequency at which it ends.
const MOST_STEPS: usize = 40;
const CONVERGED: f64 = 1e-12;

impl ZerothOrder {
    /// Of these modes (shapes in the feed frame), the mean directional matrix per depth of cut (Pa) and the pitch of the teeth (rad).
    /// Boundaries deeper than `deepest` (m) are not sought.
    pub fn new(modes: &[Mode], per_depth: &Matrix3<f64>, pitch: f64, deepest: f64) -> ZerothOrder {
        let gain = LoopGain::new(modes, per_depth);
        // The depth is at least half the modulus of the complex depth.
        let nodes = trace(&gain, 2.0 * deepest);
        let segments = segments(&nodes, 2.0 * deepest);
        ZerothOrder {
            gain,
            nodes,
            segments,
            pitch,
            deepest,
        }
    }

    /// The boundary at this spindle speed (rad/s, above zero); `None` if it is deeper than the deepest sought.
    pub fn at_speed(&self, spindle: f64) -> Option<Boundary> {
        let half_period = 0.5 * self.pitch / spindle;
        self.least_root(delayed(half_period), half_period)
    }

    /// Whether there is a boundary up to `depth` (m) at this spindle speed, on the interpolated curve: quicker than [`ZerothOrder::at_speed`].
    pub fn is_exceeded(&self, spindle: f64, depth: f64) -> bool {
        let half_period = 0.5 * self.pitch / spindle;
        let within = self
            .segments
            .iter()
            .take_while(|segment| 0.5 * segment.least <= depth);
        let depth_at = delayed(half_period);
        let mut exceeded = false;
        for segment in within {
            self.roots_within(segment, half_period, &depth_at, |found| {
                exceeded |= found.depth > 0.0 && found.depth <= depth;
            });
            if exceeded {
                return true;
            }
        }
        false
    }

    /// The boundary without the delayed term.
    pub fn mode_coupling(&self) -> Option<Boundary> {
        let dynamic = self.least_root(|(_, x)| (x.im, x.re), 0.0);
        let first = self.nodes.first()?;
        let real = |x: &Complex<f64>| x.re > 0.0 && x.re < self.deepest && x.im.abs() <= 1e-12 * x.re;
        let still = first.depths.into_iter().filter(real).map(|x| Boundary {
            depth: x.re,
            angular_frequency: 0.0,
            mode: self.gain.largest_share(0.0, x),
        });
        still.chain(dynamic).min_by(|a, b| a.depth.total_cmp(&b.depth))
    }

    /// The lowest boundary over all spindle speeds.
    pub fn critical(&self) -> Option<Boundary> {
        let depth_of = |x: Complex<f64>| match x.re > 0.0 {
            true => x.norm_sqr() / (2.0 * x.re),
            false => f64::INFINITY,
        };
        let mut best: Option<(f64, f64, Complex<f64>)> = None;
        for segment in &self.segments {
            if best.is_some_and(|(depth, ..)| 0.5 * segment.least > depth) {
                break;
            }
            let [a, b] = self.ends(segment);
            let found = self.least_between([a, b], depth_of);
            if best.is_none_or(|(depth, ..)| found.0 < depth) {
                best = Some(found);
            }
        }
        let (depth, w, x) = best?;
        (depth <= self.deepest).then(|| self.boundary(depth, w, x))
    }

    /// Share of each mode at a boundary of this solution.
    pub fn shares(&self, boundary: &Boundary, spindle: f64) -> Vec<f64> {
        let turn = Complex::from_polar(1.0, -boundary.angular_frequency * self.pitch / spindle);
        let x = (Complex::new(1.0, 0.0) - turn) * boundary.depth;
        self.gain.shares(boundary.angular_frequency, x)
    }

    fn boundary(&self, depth: f64, w: f64, x: Complex<f64>) -> Boundary {
        Boundary {
            depth,
            angular_frequency: w,
            mode: self.gain.largest_share(w, x),
        }
    }

    fn ends(&self, segment: &Segment) -> [(f64, Complex<f64>); 2] {
        [0, 1].map(|end| {
            let node = &self.nodes[segment.node + end];
            (node.w, node.depths[segment.branch])
        })
    }

    /// The roots of the imaginary part that `depth_at` gives (with the depth) of points of the curve, within one segment of the interpolated
    /// curve; `half_period` (s) is how fast its rotation turns.
    fn roots_within(
        &self,
        segment: &Segment,
        half_period: f64,
        depth_at: &impl Fn(OnCurve) -> (f64, f64),
        mut visit: impl FnMut(Candidate),
    ) {
        let [a, b] = self.ends(segment);
        let pieces = ((b.0 - a.0) * half_period / TURN).ceil().max(1.0) as usize;
        let mut before = (a, depth_at(a));
        for piece in 1..=pieces {
            let part = piece as f64 / pieces as f64;
            let next = (a.0 + (b.0 - a.0) * part, a.1 + (b.1 - a.1) * part);
            let here = depth_at(next);
            if (here.0 > 0.0) != (before.1.0 > 0.0) {
                let share = before.1.0 / (before.1.0 - here.0);
                let between = |p: f64, q: f64| p + (q - p) * share;
                let root = (
                    between(before.0.0, next.0),
                    before.0.1 + (next.1 - before.0.1) * share,
                );
                visit(Candidate {
                    depth: depth_at(root).1,
                    ends: [before.0, next],
                });
            }
            before = (next, here);
        }
    }

    /// The least depth at a root of the imaginary part that `depth_at` gives, with the depth.
    fn least_root(&self, depth_at: impl Fn(OnCurve) -> (f64, f64), half_period: f64) -> Option<Boundary> {
        let mut candidates: Vec<Candidate> = Vec::new();
        let mut best = self.deepest;
        // Without a delay the depth is the modulus itself, with it at least half.
        for segment in &self.segments {
            if 0.5 * segment.least > NEAR_BEST * best {
                break;
            }
            self.roots_within(segment, half_period, &depth_at, |found| {
                if found.depth > 0.0 && found.depth < NEAR_BEST * best {
                    best = best.min(found.depth);
                    candidates.push(found);
                }
            });
        }
        candidates.retain(|candidate| candidate.depth <= NEAR_BEST * best);
        let refined = candidates
            .iter()
            .filter_map(|candidate| self.refined(candidate, &depth_at));
        let (depth, w, x) = refined.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (depth <= self.deepest).then(|| self.boundary(depth, w, x))
    }

    /// The root on the exact curve: regula falsi with the Illinois modification.
    fn refined(
        &self,
        candidate: &Candidate,
        depth_at: &impl Fn(OnCurve) -> (f64, f64),
    ) -> Option<(f64, f64, Complex<f64>)> {
        let on_curve = |(w, x): (f64, Complex<f64>)| {
            let x = nearest(&self.gain, w, x);
            ((w, x), depth_at((w, x)).0)
        };
        let [mut low, mut high] = candidate.ends.map(on_curve);
        if (low.1 > 0.0) == (high.1 > 0.0) {
            // The curve and its chord differ at the ends: the root is beyond this piece, and its neighbour has it.
            let middle = 0.5 * (low.0.0 + high.0.0);
            let x = nearest(&self.gain, middle, 0.5 * (low.0.1 + high.0.1));
            return Some((depth_at((middle, x)).1, middle, x)).filter(|found| found.0 > 0.0);
        }
        let mut weights = [low.1, high.1];
        let mut found = low;
        for _ in 0..MOST_STEPS {
            let part = weights[0] / (weights[0] - weights[1]);
            let w = low.0.0 + (high.0.0 - low.0.0) * part;
            let expected = low.0.1 + (high.0.1 - low.0.1) * part;
            let change = (w - found.0.0).abs();
            found = on_curve((w, expected));
            if found.1 == 0.0 || change <= CONVERGED * w {
                break;
            }
            if (found.1 > 0.0) == (low.1 > 0.0) {
                (low, weights) = (found, [found.1, 0.5 * weights[1]]);
            } else {
                (high, weights) = (found, [0.5 * weights[0], found.1]);
            }
        }
        let depth = depth_at(found.0).1;
        (depth > 0.0).then_some((depth, found.0.0, found.0.1))
    }

    /// The least of `depth_of` between two neighbouring nodes, by golden sections: depth, frequency, complex depth.
    fn least_between(
        &self,
        [a, b]: [(f64, Complex<f64>); 2],
        depth_of: impl Fn(Complex<f64>) -> f64,
    ) -> (f64, f64, Complex<f64>) {
        let at = |part: f64| {
            let w = a.0 + (b.0 - a.0) * part;
            let x = nearest(&self.gain, w, a.1 + (b.1 - a.1) * part);
            (depth_of(x), w, x)
        };
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (0.0, 1.0);
        let mut inner = [at(1.0 - golden), at(golden)];
        for _ in 0..MOST_STEPS {
            if inner[0].0 < inner[1].0 {
                high = low + golden * (high - low);
                inner = [at(high - golden * (high - low)), inner[0]];
            } else {
                low = high - golden * (high - low);
                inner = [inner[1], at(low + golden * (high - low))];
            }
        }
        let ends = [(depth_of(a.1), a.0, a.1), (depth_of(b.1), b.0, b.1)];
        ends.into_iter()
            .fold(inner[0], |best, next| if next.0 < best.0 { next } else { best })
    }
}

/// Imaginary part of `z`, and the depth, of points of the curve at half this period of the teeth (s).
fn delayed(half_period: f64) -> impl Fn(OnCurve) -> (f64, f64) {
    move |(w, x)| {
        let (sin, cos) = (w * half_period).sin_cos();
        // e^(i (w T/2 - pi/2)) and 2 sin(w T/2).
        let z = x * Complex::new(sin, -cos);
        (z.im, z.re / (2.0 * sin))
    }
}

#[cfg(test)]
mod tests;

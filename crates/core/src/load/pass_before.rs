//! The profile that the pass before left next to a leaning tool.
//!
//! The same tool, leaning in the same way, passed at the distance `ae` on the same level. Along the feed it left what its body
//! fills seen in that direction: to the height `z` over the surface it reaches as far as `Y(z)`. A point `p` of the edge is in the
//! material where it is beyond that:
//!
//! ```text
//! s . p > Y(n . p + P . n) - ae
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `s`, `n` | direction across the feed from the pass before, normal of the surface | - |
//! | `Y(z)` | how far the body reaches along `s` at the height `z` ([`super::lean`]) | m |
//! | `ae` | distance of the two passes, the stepover | m |
//! | `p`, `P` | as in [`super::engaged_arcs`] | m |
//!
//! On the corner, where the body is wider the higher, up to the normal `u = s` or across the tool axis; above it the
//! profile is straight. A ball has `Y = sqrt(z (2 R - z))`. A bull nose has the points of its body with the normals
//! `sin(delta) s - cos(delta) n`; between them `Y` is a cubic spline (Hermite's) over `sqrt(z)`, in which it begins straight. The angles
//! `delta` are even; more are even in `asinh(delta/theta)`, since at a small lean `theta` the flat bottom is passed within an
//! angle of that size.
//!
//! The immersion angles at which a point passes the profile have no closed form; they are bracketed by samples and found by
//! the rule of false position (Illinois).
//!
//! Source: plane geometry \[derived\].

use nalgebra::Vector3;

use super::arc::EngagedArc;
use super::arcs_of_point::EngagedArcs;
use super::cut::Cut;
use super::cutter::Cutter;
use super::end_mill_body::EndMillBody;

/// Number of this condition among those that end arcs.
const CONDITION: u8 = 4;
/// Nodes of the spline at even angles, and near the lowest point.
const EVEN: usize = 32;
const LOW: usize = 17;
/// Least lean for the angles of the latter, rad, and the first of them in leans.
const LEAST_LEAN: f64 = 1e-4;
const FIRST: f64 = 1e-3;
/// Samples of an arc are no farther apart than this, rad.
const STEP: f64 = 0.35;
/// Fewest and most intervals between samples of an arc.
const SAMPLES: [usize; 2] = [4, 18];
/// Steps of the false position, at most: some 7 are needed.
const MOST_ROUNDS: usize = 60;
/// Angle to which the ends of arcs are found, rad.
pub(super) const CLOSE: f64 = 1e-12;

/// The pass before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassBefore {
    /// Away from it, feed frame of the tool.
    side: Vector3<f64>,
    normal: Vector3<f64>,
    /// Height of `P` over the surface, m.
    height: f64,
    stepover: f64,
    profile: Profile,
}

/// How far a body reaches to the side over the height.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Profile {
    /// Of a ball, m.
    radius: f64,
    /// Of a bull nose: root of the height, reach, slope over that root.
    spline: Option<[[f64; 3]; LOW + EVEN]>,
    /// Where the corner ends: height and reach, m.
    end: [f64; 2],
    /// Slope above it.
    slope: f64,
}

impl Profile {
    /// Of this body along `side`, a unit vector across the normal; axes along the feed, to its left, along the normal.
    fn of(body: &EndMillBody, axis: &Vector3<f64>, side: &Vector3<f64>) -> Profile {
        // Above a normal across the axis is the cylinder.
        let slope = (side.dot(axis) / axis.z).max(0.0);
        let at = |delta: f64| {
            let (sin, cos) = delta.sin_cos();
            let point = body.point_with_normal(axis, &(side * sin - Vector3::z() * cos));
            let root = point.z.max(0.0).sqrt();
            [root, point.dot(side), 2.0 * root * cos / sin]
        };
        let last = 1.0_f64.atan2(slope);
        let [root, reach, _] = at(last);
        let spline = (body.flat_radius() > 0.0).then(|| {
            let lean = axis.xy().norm().max(LEAST_LEAN);
            let end = (last / lean).asinh();
            let mut nodes = std::array::from_fn(|index: usize| match index.checked_sub(LOW) {
                None => at(lean * (FIRST + (end - FIRST) * index as f64 / LOW as f64).sinh()),
                Some(even) => at(last * (even + 1) as f64 / EVEN as f64),
            });
            nodes.sort_by(|a, b| a[0].total_cmp(&b[0]));
            nodes
        });
        Profile {
            radius: body.radius(),
            spline,
            end: [root * root, reach],
            slope,
        }
    }

    fn reach(&self, height: f64) -> f64 {
        let [end, reach] = self.end;
        if height >= end {
            return reach + self.slope * (height - end);
        }
        // Rounding may take a point below the surface.
        let height = height.max(0.0);
        let root = height.sqrt();
        let Some(nodes) = &self.spline else {
            return root * (2.0 * self.radius - height).sqrt();
        };
        let after = nodes
            .partition_point(|node| node[0] <= root)
            .clamp(1, nodes.len() - 1);
        let [from, to] = [nodes[after - 1], nodes[after]];
        let length = to[0] - from[0];
        let t = (root - from[0]) / length;
        let [slope, slope_after] = [from[2], to[2]].map(|slope| slope * length);
        let rise = to[1] - from[1];
        let (bend, twist) = (
            3.0 * rise - 2.0 * slope - slope_after,
            slope + slope_after - 2.0 * rise,
        );
        from[1] + t * (slope + t * (bend + t * twist))
    }
}

impl PassBefore {
    /// Before this cut; `None` where the sides of the strip are walls.
    pub(super) fn of(cutter: &Cutter, cut: &Cut) -> Option<PassBefore> {
        let displaced = cut.engagement.pass_before()?;
        let [left, normal] = cut.left_and_normal();
        let to_left = -displaced.signum();
        let (body, axis) = (cutter.body(), cut.lean.lean.axis());
        Some(PassBefore {
            side: left * to_left,
            normal,
            height: body.height_over_surface(&axis),
            stepover: displaced.abs(),
            profile: Profile::of(body, &axis, &(Vector3::y() * to_left)),
        })
    }

    /// The parts of `arcs` on which a point at this radius and height over the centres of the corner (m) is beyond the
    /// profile; their new ends are found within `close`, rad.
    pub(super) fn beyond(&self, arcs: &EngagedArcs, [rho, zeta]: [f64; 2], close: f64) -> EngagedArcs {
        let [side, normal] = [self.side, self.normal].map(|along| along * rho);
        let offset = self.side.z * zeta + self.stepover;
        let height = self.normal.z * zeta + self.height;
        let by = |phi: f64| {
            let (sin, cos) = phi.sin_cos();
            let at = height + normal.x * sin + normal.y * cos;
            offset + side.x * sin + side.y * cos - self.profile.reach(at)
        };
        let mut beyond = EngagedArcs::none();
        for (arc, [first, last]) in arcs.with_ends() {
            let length = arc.exit - arc.entry;
            let count = ((length / STEP).ceil() as usize).clamp(SAMPLES[0], SAMPLES[1]);
            let sample = |index: usize| {
                let phi = arc.entry + length * (index as f64 / count as f64);
                [phi, by(phi)]
            };
            let (mut before, mut here) = (sample(0), sample(1));
            let mut entry = (before[1] > 0.0).then_some((arc.entry, first));
            let mut pass = |from: [f64; 2], to: [f64; 2]| match entry {
                None if to[1] > 0.0 => entry = Some((crossing(&by, [from, to], close), CONDITION)),
                Some((begin, begun)) if to[1] <= 0.0 => {
                    let exit = crossing(&by, [from, to], close);
                    beyond.push(EngagedArc { entry: begin, exit }, [begun, CONDITION]);
                    entry = None;
                }
                _ => {}
            };
            for index in 1..=count {
                let after = if index < count { sample(index + 1) } else { here };
                // Between three samples on one side there may be two crossings.
                let turn = turn([before, here, after]).map(|phi| [phi, by(phi)]);
                match turn.filter(|turn| (turn[1] > 0.0) != (here[1] > 0.0)) {
                    Some(turn) if turn[0] < here[0] => {
                        pass(before, turn);
                        pass(turn, here);
                        before = here;
                    }
                    Some(turn) => {
                        pass(before, here);
                        pass(here, turn);
                        before = turn;
                    }
                    None => {
                        pass(before, here);
                        before = here;
                    }
                }
                here = after;
            }
            if let Some((begin, begun)) = entry {
                let exit = arc.exit;
                beyond.push(EngagedArc { entry: begin, exit }, [begun, last]);
            }
        }
        beyond
    }
}

/// The vertex of the parabola through three even samples of one sign, if it may be beyond zero.
fn turn([before, here, after]: [[f64; 2]; 3]) -> Option<f64> {
    let [a, b, c] = [before[1], here[1], after[1]].map(|value| value * here[1].signum());
    let bend = a - 2.0 * b + c;
    let is_turn = a > b && c >= b && b > 0.0 && bend > 0.0 && after[0] > here[0];
    let vertex = || here[0] + 0.5 * (here[0] - before[0]) * (a - c) / bend;
    is_turn.then(vertex)
}

/// Where `by` is zero between two samples of different sign, within `close`.
fn crossing(by: &impl Fn(f64) -> f64, samples: [[f64; 2]; 2], close: f64) -> f64 {
    let [[mut a, mut at_a], [mut b, mut at_b]] = samples;
    for _ in 0..MOST_ROUNDS {
        if b - a <= close {
            break;
        }
        let next = (a * at_b - b * at_a) / (at_b - at_a);
        let next = if next > a && next < b { next } else { 0.5 * (a + b) };
        let value = by(next);
        if value == 0.0 {
            return next;
        }
        if (value > 0.0) == (at_b > 0.0) {
            (b, at_b) = (next, value);
            at_a *= 0.5;
        } else {
            (a, at_a) = (next, value);
            at_b *= 0.5;
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests;

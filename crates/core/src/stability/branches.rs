//! The complex depths as curves over the frequency, with nodes so dense that no crossing of the real axis is missed.
//!
//! Nodes are first placed at the modes, in geometric distances around each (from a quarter of `zeta omega`), and evenly over the
//! whole range, which ends at three times the highest mode. Then each interval is halved until every complex depth changes by
//! less than a part [`STEP`] of itself, which also bounds the turn of its angle. Branches are the assignment of the depths of one node to
//! those of the next with the least relative change.
//!
//! An interval bounds the depths on it from below: `least` is 0.8 of the smaller modulus at its ends, by the bound of the change.

use nalgebra::Complex;

use super::loop_gain::{BRANCHES, Depths, LoopGain};

/// Largest change of a complex depth from node to node, in parts of itself.
pub(super) const STEP: f64 = 0.35;
/// End of the range over the highest frequency.
const BEYOND_HIGHEST: f64 = 3.0;
/// Nodes spread over the whole range.
const EVEN: usize = 24;
/// First distance from a mode, in `zeta omega`, and the factor from one to the next.
const NEAREST: f64 = 0.25;
const GROWTH: f64 = 2.2;
/// Most halvings of an interval.
const MOST_HALVINGS: u32 = 14;
/// The assignments of three branches.
const ASSIGNMENTS: [[usize; BRANCHES]; 6] =
    [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];

/// A frequency with its complex depths, in the order of the branches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// rad/s
    pub(super) w: f64,
    pub(super) depths: Depths,
}

/// A branch between two neighbouring nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Index of the first node.
    pub(super) node: usize,
    pub(super) branch: usize,
    /// Lower bound of the modulus, m.
    pub(super) least: f64,
}

/// Nodes in ascending order of frequency; depths of more than `deepest` (modulus, m) are not refined.
pub(super) fn trace(gain: &LoopGain, deepest: f64) -> Vec<Node> {
    let grid = grid(gain);
    let mut nodes = Vec::with_capacity(8 * grid.len());
    let mut last = match grid.first() {
        Some(w) => Node {
            w: *w,
            depths: gain.depths(*w),
        },
        None => return nodes,
    };
    nodes.push(last);
    for w in &grid[1..] {
        let end = following(&last, *w, gain);
        halve(gain, [last, end], [deepest, f64::from(MOST_HALVINGS)], &mut nodes);
        // The assignment at the end may have changed on the way.
        last = nodes[nodes.len() - 1];
    }
    nodes
}

/// The segments of all branches with their bounds, the least first; none beyond `deepest`.
pub(super) fn segments(nodes: &[Node], deepest: f64) -> Vec<Segment> {
    let mut segments: Vec<Segment> = nodes
        .windows(2)
        .enumerate()
        .flat_map(|(node, pair)| {
            (0..BRANCHES).map(move |branch| {
                let [a, b] = [0, 1].map(|end: usize| pair[end].depths[branch].norm());
                Segment {
                    node,
                    branch,
                    least: 0.8 * a.min(b),
                }
            })
        })
        .filter(|segment| segment.least < deepest)
        .collect();
    segments.sort_by(|a, b| a.least.total_cmp(&b.least));
    segments
}

/// The complex depth at `w` that is nearest to `expected`.
pub(super) fn nearest(gain: &LoopGain, w: f64, expected: Complex<f64>) -> Complex<f64> {
    let [first, rest @ ..] = gain.depths(w);
    rest.into_iter().fold(first, |best, next| {
        if (next - expected).norm_sqr() < (best - expected).norm_sqr() {
            next
        } else {
            best
        }
    })
}

fn grid(gain: &LoopGain) -> Vec<f64> {
    let highest = gain.frequencies().map(|[omega, _]| omega).fold(0.0, f64::max);
    let end = BEYOND_HIGHEST * highest;
    let mut grid: Vec<f64> = (0..=EVEN).map(|k| end * k as f64 / EVEN as f64).collect();
    for [omega, zeta] in gain.frequencies() {
        grid.push(omega);
        let mut distance = NEAREST * zeta * omega;
        while distance > 0.0 && distance < 0.5 * omega {
            grid.extend([omega - distance, omega + distance]);
            distance *= GROWTH;
        }
    }
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    grid
}

fn following(before: &Node, w: f64, gain: &LoopGain) -> Node {
    let found = gain.depths(w);
    let change = |assignment: &[usize; BRANCHES]| -> f64 {
        let parts = assignment.iter().zip(before.depths);
        parts
            .map(|(index, x)| {
                let other = found[*index];
                (other - x).norm_sqr() / (other.norm_sqr() + x.norm_sqr())
            })
            .sum()
    };
    let mut best = (f64::INFINITY, ASSIGNMENTS[0]);
    for assignment in ASSIGNMENTS {
        let total = change(&assignment);
        if total < best.0 {
            best = (total, assignment);
        }
    }
    Node {
        w,
        depths: best.1.map(|index| found[index]),
    }
}

/// Adds the nodes after the first of `ends`, the second included; with the deepest depth (m) and the halvings left.
fn halve(gain: &LoopGain, [from, to]: [Node; 2], [deepest, left]: [f64; 2], nodes: &mut Vec<Node>) {
    let changes = (0..BRANCHES).any(|branch| {
        let [a, b] = [from, to].map(|node| node.depths[branch]);
        let least = a.norm_sqr().min(b.norm_sqr());
        least < deepest * deepest && (b - a).norm_sqr() > STEP * STEP * least
    });
    if !changes || left <= 0.0 {
        nodes.push(to);
        return;
    }
    let middle = following(&from, 0.5 * (from.w + to.w), gain);
    halve(gain, [from, middle], [deepest, left - 1.0], nodes);
    let middle = nodes[nodes.len() - 1];
    let end = following(&middle, to.w, gain);
    halve(gain, [middle, end], [deepest, left - 1.0], nodes);
}

#[cfg(test)]
mod tests;

//! Least-squares values at a few nodes whose interpolation approximates given values at many points.
//!
//! ```text
//! min_x  sum_i | c_i - sum_k w_ik x_k |^2        W^T W x = W^T c, by conjugate gradients with the diagonal before them
//! ```
//!
//! | symbol | meaning |
//! |---|---|
//! | `x_k` | value at node k |
//! | `c_i` | required value at point i |
//! | `w_ik` | share of node k at point i: on a straight move `1 - t` and `t`, on an arc the parabola through three nodes |
//!
//! The convergence depends on the condition of `W^T W`, which is about that of hat functions: some tens of iterations
//! for any number of nodes. Source: Hestenes, Stiefel 1952.

use nalgebra::Vector3;

/// The shares of the nodes at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shares {
    /// Index of a node and its share; `None`: no node.
    pub of: [Option<(usize, f64)>; 3],
}

impl Shares {
    /// Between two nodes, at the fraction `t`; a fixed node is `None`.
    pub fn straight(from: Option<usize>, to: Option<usize>, t: f64) -> Shares {
        Shares {
            of: [from.map(|node| (node, 1.0 - t)), to.map(|node| (node, t)), None],
        }
    }

    /// Between three nodes, the second at the fraction `p`.
    pub fn bent([from, via, to]: [Option<usize>; 3], p: f64, t: f64) -> Shares {
        let share = |node: Option<usize>, share: f64| node.map(|node| (node, share));
        Shares {
            of: [
                share(from, (t - p) * (t - 1.0) / p),
                share(via, t * (t - 1.0) / (p * (p - 1.0))),
                share(to, t * (t - p) / (1.0 - p)),
            ],
        }
    }

    fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        self.of.iter().flatten().copied()
    }
}

/// Maximum number of iterations.
const ROUNDS: usize = 200;
/// Relative residual of the normal equations at convergence.
const CONVERGED: f64 = 1e-10;

/// Values at the nodes, from `start` on, with the least-squares error at points with these shares. A node without any
/// share keeps its start value.
///
/// # Panics
/// If points and shares differ in number, or a share has an invalid node.
pub fn fitted(start: Vec<Vector3<f64>>, shares: &[Shares], requested: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    assert_eq!(shares.len(), requested.len(), "a value for each point");
    let count = start.len();
    let at = |x: &[Vector3<f64>], shares: &Shares| -> Vector3<f64> {
        shares.iter().map(|(node, share)| x[node] * share).sum()
    };
    let back = |of: &dyn Fn(usize) -> Vector3<f64>| {
        let mut sums = vec![Vector3::zeros(); count];
        for (index, shares) in shares.iter().enumerate() {
            let value = of(index);
            shares
                .iter()
                .for_each(|(node, share)| sums[node] += value * share);
        }
        sums
    };
    let mut diagonal = vec![0.0; count];
    for (node, share) in shares.iter().flat_map(Shares::iter) {
        diagonal[node] += share * share;
    }
    let scaled = |r: &[Vector3<f64>]| -> Vec<Vector3<f64>> {
        let one = |(r, d): (&Vector3<f64>, &f64)| if *d > 0.0 { r / *d } else { Vector3::zeros() };
        r.iter().zip(&diagonal).map(one).collect()
    };
    let dot =
        |a: &[Vector3<f64>], b: &[Vector3<f64>]| -> f64 { a.iter().zip(b).map(|(a, b)| a.dot(b)).sum() };
    let mut x = start;
    let size = back(&|index| requested[index]);
    let enough = CONVERGED * CONVERGED * dot(&size, &scaled(&size));
    let mut r = back(&|index| requested[index] - at(&x, &shares[index]));
    let mut z = scaled(&r);
    let mut p = z.clone();
    let mut rho = dot(&r, &z);
    for _ in 0..ROUNDS {
        if rho <= enough {
            break;
        }
        let q = back(&|index| at(&p, &shares[index]));
        let alpha = rho / dot(&p, &q);
        for node in 0..count {
            x[node] += p[node] * alpha;
            r[node] -= q[node] * alpha;
        }
        z = scaled(&r);
        let next = dot(&r, &z);
        let beta = next / rho;
        for node in 0..count {
            p[node] = z[node] + p[node] * beta;
        }
        rho = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight moves between `nodes`, each in this number of pieces.
    fn polyline(nodes: usize, pieces: usize) -> Vec<Shares> {
        let ends = (0..nodes - 1).flat_map(|k| {
            (1..=pieces).map(move |i| Shares::straight(Some(k), Some(k + 1), i as f64 / pieces as f64))
        });
        std::iter::once(Shares::straight(Some(0), Some(1), 0.0))
            .chain(ends)
            .collect()
    }

    fn value(shares: &Shares, x: &[Vector3<f64>]) -> Vector3<f64> {
        shares.iter().map(|(node, share)| x[node] * share).sum()
    }

    #[test]
    fn values_that_nodes_can_represent_are_reproduced() {
        let x: Vec<Vector3<f64>> = (0..40)
            .map(|k| Vector3::new((0.7 * f64::from(k)).sin(), f64::from(k % 3), -1.0))
            .collect();
        let mut shares = polyline(40, 25);
        let three = [Some(3), Some(17), Some(21)];
        shares.extend((0..9).map(|i| Shares::bent(three, 0.4, f64::from(i) / 8.0)));
        let requested: Vec<_> = shares.iter().map(|shares| value(shares, &x)).collect();
        let found = fitted(vec![Vector3::zeros(); 40], &shares, &requested);
        let apart = found
            .iter()
            .zip(&x)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        // The residual is below 1e-10; the condition of hat functions is below ten.
        assert!(apart < 1e-8, "{apart}");
    }

    #[test]
    fn a_jump_in_the_middle_is_shared_by_both_sides() {
        let shares = polyline(3, 100);
        let requested: Vec<_> = (0..201)
            .map(|i| Vector3::new(if i <= 100 { 1.0 } else { -1.0 }, 0.0, 0.0))
            .collect();
        let found = fitted(vec![Vector3::zeros(); 3], &shares, &requested);
        // By symmetry zero at the corner; on the free side the straight line nearest to a constant: 3/2 at its end.
        assert!(
            found[1].norm() < 0.02 && (found[0].x - 1.5).abs() < 0.02,
            "{found:?}"
        );
        let left = |x: &[Vector3<f64>]| -> f64 {
            let rest = shares.iter().zip(&requested);
            rest.map(|(shares, requested)| (value(shares, x) - requested).norm_squared())
                .sum()
        };
        // No neighbour is better.
        for node in 0..3 {
            for by in [-1e-3, 1e-3] {
                let mut other = found.clone();
                other[node].x += by;
                assert!(left(&other) > left(&found));
            }
        }
    }

    #[test]
    fn fixed_ends_stay_and_a_node_without_shares_keeps_its_start() {
        let shares: Vec<Shares> = (0..11)
            .map(|i| Shares::straight(None, Some(0), f64::from(i) / 10.0))
            .collect();
        let requested: Vec<_> = (0..11)
            .map(|i| Vector3::new(0.0, f64::from(i) / 10.0, 0.0))
            .collect();
        let start = vec![Vector3::zeros(), Vector3::new(7.0, 0.0, 0.0)];
        let found = fitted(start, &shares, &requested);
        assert!((found[0] - Vector3::y()).norm() < 1e-12);
        assert_eq!(found[1].x, 7.0);
        assert!(fitted(Vec::new(), &[], &[]).is_empty());
    }
}

//! Starts of a search: points spread evenly over the ranges of the joints, always the same.
//!
//! `x_k,j = frac(1/2 + k phi^-j)`, `phi` the root of `x^(d+1) = x + 1` for `d` joints: the sequence of least known
//! discrepancy that needs no table. Source: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences",
//! 2018; for d = 1 the golden ratio.

/// The sequence in a box.
#[derive(Clone, Debug)]
pub(super) struct Starts {
    /// Lower corner, size, and step of the sequence, of each joint.
    sides: Vec<[f64; 3]>,
}

impl Starts {
    /// In the box between the lower and the upper end of each of these ranges.
    pub fn within(ranges: &[[f64; 2]]) -> Starts {
        let phi = root(ranges.len());
        let mut step = 1.0;
        let side = |[lower, upper]: &[f64; 2]| {
            step /= phi;
            [*lower, upper - lower, step]
        };
        Starts {
            sides: ranges.iter().map(side).collect(),
        }
    }

    /// Point `k` of the sequence, into `point`.
    pub fn point(&self, k: usize, point: &mut [f64]) {
        for (x, [lower, size, step]) in point.iter_mut().zip(&self.sides) {
            let steps = 0.5 + k as f64 * step;
            *x = lower + (steps - steps as u32 as f64) * size;
        }
    }
}

/// The root of `x^(d+1) = x + 1`, by the contraction `x = (1 + x)^(1/(d+1))`.
fn root(dimensions: usize) -> f64 {
    let power = 1.0 / (dimensions as f64 + 1.0);
    (0..40).fold(1.5, |x: f64, _| (1.0 + x).powf(power))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_one_dimension_it_is_the_golden_ratio() {
        assert!((root(1) - 0.5 * (1.0 + 5f64.sqrt())).abs() < 1e-15);
    }

    #[test]
    fn every_octant_of_a_box_has_its_share() {
        let mut counts = [0; 8];
        let mut point = [0.0; 3];
        let starts = Starts::within(&[[-1.0, 1.0], [0.0, 4.0], [10.0, 12.0]]);
        for k in 1..=800 {
            starts.point(k, &mut point);
            let [x, y, z] = point;
            counts[usize::from(x > 0.0) + 2 * usize::from(y > 2.0) + 4 * usize::from(z > 11.0)] += 1;
        }
        // 100 each on average; pure chance has a standard deviation of 9, and mostly one of eight beyond 15.
        assert!(
            counts.iter().all(|count| (88..=112).contains(count)),
            "{counts:?}"
        );
    }
}

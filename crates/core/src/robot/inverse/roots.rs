//! All real roots of a polynomial up to degree four, double roots included.
//!
//! Between two neighbouring extrema there is one root or none, and it can be enclosed. Extrema are the roots of the
//! derivative, found in the same way. A double root is an extremum whose value is zero but for rounding: to find it as
//! an extremum keeps all its digits, while a crossing there would lose half of them.
//!
//! `p(t) = p0 + p1 t + ... + pn t^n`. Source: Rolle's theorem; Newton's iteration kept inside the enclosure by halving.

/// Maximum number of steps of an enclosure: halving alone ends at rounding after some 60.
const MOST_STEPS: usize = 100;

/// Real roots of the polynomial with the coefficients `p` (rising powers), in rising order; also extrema whose value is
/// below `touching` times the sum of the sizes of its terms, with the terms at one where they are smaller nearer to
/// zero.
///
/// Not checked: that the highest coefficient is far from zero; where it is zero there are none.
pub(super) fn real_roots(p: &[f64], touching: f64) -> Vec<f64> {
    let Some((highest, lower)) = p.split_last() else {
        return Vec::new();
    };
    // Cauchy's bound on all roots.
    let bound = 1.0
        + lower
            .iter()
            .fold(0.0, |most: f64, c| most.max((c / highest).abs()));
    if !bound.is_finite() || lower.is_empty() {
        return Vec::new();
    }
    if let [constant] = lower {
        return vec![-constant / highest];
    }
    if let [c, b, a] = *p {
        return quadratic_roots([c, b, a], touching);
    }
    let derivative: Vec<f64> = (1..p.len()).map(|power| power as f64 * p[power]).collect();
    let extrema = real_roots(&derivative, touching);
    let walls: Vec<f64> = [-bound].into_iter().chain(extrema).chain([bound]).collect();
    let crosses = |pair: &[f64]| (value(p, pair[0]) < 0.0) != (value(p, pair[1]) < 0.0);
    let crossed: Vec<bool> = walls.windows(2).map(crosses).collect();
    let mut roots = Vec::with_capacity(4);
    for (i, pair) in walls.windows(2).enumerate() {
        if crossed[i] {
            roots.push(crossing(p, &derivative, pair[0], pair[1]));
        } else if i + 1 < crossed.len() && !crossed[i + 1] && touches(p, pair[1], touching) {
            roots.push(pair[1]);
        }
    }
    roots
}

/// [`real_roots`] of degree two, without the difference of nearly equal numbers.
fn quadratic_roots([c, b, a]: [f64; 3], touching: f64) -> Vec<f64> {
    let quarter = 0.25 * b * b - a * c;
    if quarter > 0.0 {
        let sum = -(0.5 * b + quarter.sqrt().copysign(b));
        let (one, other) = (sum / a, c / sum);
        return vec![one.min(other), one.max(other)];
    }
    let extremum = -0.5 * b / a;
    if touches(&[c, b, a], extremum, touching) {
        vec![extremum]
    } else {
        Vec::new()
    }
}

/// The root between two points of different sign.
fn crossing(p: &[f64], derivative: &[f64], mut from: f64, mut to: f64) -> f64 {
    let starts_below = value(p, from) < 0.0;
    let mut t = 0.5 * (from + to);
    for _ in 0..MOST_STEPS {
        let p_t = value(p, t);
        if (p_t < 0.0) == starts_below {
            from = t;
        } else {
            to = t;
        }
        let newton = t - p_t / value(derivative, t);
        let next = if newton > from && newton < to {
            newton
        } else {
            0.5 * (from + to)
        };
        if (next - t).abs() <= f64::EPSILON * t.abs() {
            return next;
        }
        t = next;
    }
    t
}

fn value(p: &[f64], t: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

fn touches(p: &[f64], t: f64, touching: f64) -> bool {
    let size = p
        .iter()
        .rev()
        .fold(0.0, |sum, c| sum * t.abs().max(1.0) + c.abs());
    value(p, t).abs() <= touching * size
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial with these roots.
    fn of_roots(roots: &[f64]) -> Vec<f64> {
        let mut p = vec![0.7];
        for root in roots {
            let mut next = vec![0.0; p.len() + 1];
            for (power, c) in p.iter().enumerate() {
                next[power + 1] += c;
                next[power] -= c * root;
            }
            p = next;
        }
        p
    }

    #[test]
    fn four_crossings_are_found_in_order() {
        let roots = [-3.0, -0.2, 0.5, 4.0];
        let found = real_roots(&of_roots(&roots), 1e-9);
        assert_eq!(found.len(), 4, "{found:?}");
        // Rounding of the coefficients, relative to the slope at each root.
        assert!(found.iter().zip(roots).all(|(a, b)| (a - b).abs() < 1e-13));
    }

    #[test]
    fn double_roots_keep_their_digits() {
        for roots in [[-1.2, -1.2, 0.3, 0.3], [0.4, 0.4, 0.9, 2.0]] {
            let found = real_roots(&of_roots(&roots), 1e-9);
            for root in roots {
                let nearest = found.iter().fold(f64::INFINITY, |d, t| d.min((t - root).abs()));
                // As a crossing a double root is accurate to 1e-8 only; here rounding may still split it into two.
                assert!(nearest < 3e-8, "{root}: {found:?}");
            }
        }
    }

    #[test]
    fn a_polynomial_that_stays_away_from_zero_has_none() {
        assert!(real_roots(&[1.0, 0.0, 0.5, 0.0, 1.0], 1e-9).is_empty());
        let lifted: Vec<f64> = of_roots(&[1.0, 1.0, -2.0, -2.0]);
        let lifted: Vec<f64> = lifted
            .iter()
            .enumerate()
            .map(|(i, c)| if i == 0 { c + 1e-10 } else { *c })
            .collect();
        assert_eq!(real_roots(&lifted, 1e-9).len(), 2);
        assert_eq!(real_roots(&[1e-12, 0.0, 1.0, 0.0, 1.0], 1e-9).len(), 1);
    }

    #[test]
    fn an_empty_polynomial_has_no_roots() {
        assert!(real_roots(&[], 1e-9).is_empty());
        assert!(real_roots(&[1.0], 1e-9).is_empty());
        assert!(real_roots(&[1.0, 2.0, 0.0], 1e-9).is_empty());
        assert!(real_roots(&[f64::NAN, 2.0, 1.0], 1e-9).iter().all(|t| t.is_nan()));
    }
}

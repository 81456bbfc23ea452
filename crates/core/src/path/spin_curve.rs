//! A spin of the tool that changes along a path: linear between knots, constant before the first and after the last.
//!
//! ```text
//! s(x) = s_k + (s_k+1 - s_k) (x - x_k) / (x_k+1 - x_k)        x_k <= x <= x_k+1
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `x`, `x_k` | distance along the cuts: of a point, of knot k | m |
//! | `s`, `s_k` | spin there | rad |

use super::sampled::SampledPath;

/// A knot of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinKnot {
    /// Distance along the cuts, m.
    pub along: f64,
    /// Spin, rad.
    pub spin: f64,
}

/// A spin along a path. Not checked: that its knots are on the path.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinCurve {
    knots: Vec<SpinKnot>,
}

/// Why knots give no curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoSpinCurve {
    /// A constant spin needs no curve.
    #[error("{count} knots, at least 2 are needed")]
    TooFew {
        /// Number of knots.
        count: usize,
    },
    /// A knot is not behind the one before.
    #[error("knot {index} is not behind the one before")]
    NotAscending {
        /// Its index, from 0.
        index: usize,
    },
}

impl SpinCurve {
    /// The curve through these knots.
    ///
    /// # Errors
    /// Fewer than two knots; distances that do not ascend.
    pub fn new(knots: Vec<SpinKnot>) -> Result<SpinCurve, NoSpinCurve> {
        if knots.len() < 2 {
            return Err(NoSpinCurve::TooFew { count: knots.len() });
        }
        let ascends = |pair: &[SpinKnot]| pair[1].along > pair[0].along;
        match knots.windows(2).position(|pair| !ascends(pair)) {
            Some(before) => Err(NoSpinCurve::NotAscending { index: before + 1 }),
            None => Ok(SpinCurve { knots }),
        }
    }

    /// A curve with few knots, at most `apart` (rad) from these `spins` at the points of `path`; `None` for fewer than
    /// two distances. The points of two cuts at one distance count as the first of them.
    ///
    /// The knots are found by halving: the point farthest from the straight line becomes a knot (Ramer 1972, Douglas
    /// and Peucker 1973, with the distance along the spin).
    pub fn near(path: &SampledPath, spins: &[f64], apart: f64) -> Option<SpinCurve> {
        let mut all: Vec<SpinKnot> = Vec::with_capacity(spins.len());
        for (point, spin) in path.points.iter().zip(spins) {
            if all.last().is_none_or(|last| point.along > last.along) {
                all.push(SpinKnot {
                    along: point.along,
                    spin: *spin,
                });
            }
        }
        let last = all.len().checked_sub(1).filter(|last| *last > 0)?;
        let mut kept = vec![0, last];
        let mut open = vec![(0, last)];
        while let Some((from, to)) = open.pop() {
            let off =
                |index: usize| (all[index].spin - between(&all[from], &all[to], all[index].along)).abs();
            let farthest = (from + 1..to).max_by(|a, b| off(*a).total_cmp(&off(*b)));
            if let Some(index) = farthest.filter(|index| off(*index) > apart) {
                kept.push(index);
                open.extend([(from, index), (index, to)]);
            }
        }
        kept.sort_unstable();
        Some(SpinCurve {
            knots: kept.into_iter().map(|index| all[index]).collect(),
        })
    }

    /// Its knots.
    pub fn knots(&self) -> &[SpinKnot] {
        &self.knots
    }

    /// The spin (rad) at the distance `along` (m).
    pub fn at(&self, along: f64) -> f64 {
        let after = self.knots.partition_point(|knot| knot.along <= along);
        match after {
            0 => self.knots[0].spin,
            after if after == self.knots.len() => self.knots[after - 1].spin,
            after => between(&self.knots[after - 1], &self.knots[after], along),
        }
    }

    /// The spin at each point of `path`, rad.
    pub fn along(&self, path: &SampledPath) -> Vec<f64> {
        path.points.iter().map(|point| self.at(point.along)).collect()
    }
}

/// The spin (rad) at the distance `along` (m) on the straight line through two knots.
fn between(from: &SpinKnot, to: &SpinKnot, along: f64) -> f64 {
    from.spin + (to.spin - from.spin) * ((along - from.along) / (to.along - from.along))
}

#[cfg(test)]
mod tests {
    use nalgebra::Point2;

    use super::*;
    use crate::path::Shape;

    fn knots(values: &[[f64; 2]]) -> Vec<SpinKnot> {
        let knot = |[along, spin]: &[f64; 2]| SpinKnot {
            along: *along,
            spin: *spin,
        };
        values.iter().map(knot).collect()
    }

    #[test]
    fn a_curve_is_linear_between_its_knots_and_constant_outside() {
        let curve = SpinCurve::new(knots(&[[0.1, 1.0], [0.2, 3.0], [0.4, 2.0]])).unwrap();
        let expected = [
            (0.0, 1.0),
            (0.1, 1.0),
            (0.15, 2.0),
            (0.2, 3.0),
            (0.3, 2.5),
            (0.4, 2.0),
            (9.0, 2.0),
        ];
        for (along, spin) in expected {
            // Rounding of numbers of the size of one.
            assert!((curve.at(along) - spin).abs() < 1e-15, "{along}");
        }
    }

    #[test]
    fn one_knot_and_distances_that_do_not_ascend_are_refused() {
        assert_eq!(
            SpinCurve::new(knots(&[[0.0, 1.0]])),
            Err(NoSpinCurve::TooFew { count: 1 })
        );
        for wrong in [[0.1, 0.1], [0.1, 0.05], [0.1, f64::NAN]] {
            let refused = SpinCurve::new(knots(&[[0.0, 0.0], [wrong[0], 0.0], [wrong[1], 0.0]]));
            assert_eq!(refused, Err(NoSpinCurve::NotAscending { index: 2 }));
        }
    }

    #[test]
    fn a_curve_near_given_spins_has_few_knots_and_keeps_its_distance() {
        let path = Shape::Polyline(vec![Point2::origin(), Point2::new(1.0, 0.0)]).sampled(0.01);
        let spins: Vec<f64> = path
            .points
            .iter()
            .map(|point| (6.0 * point.along).sin())
            .collect();
        let curve = SpinCurve::near(&path, &spins, 0.02).unwrap();
        assert!(curve.knots().len() < 20, "{}", curve.knots().len());
        for (found, spin) in curve.along(&path).iter().zip(&spins) {
            assert!((found - spin).abs() <= 0.02 + 1e-12);
        }
        let ends = [curve.knots()[0].spin, curve.knots().last().unwrap().spin];
        assert_eq!(ends, [spins[0], *spins.last().unwrap()]);
        let straight = SpinCurve::near(&path, &vec![0.3; spins.len()], 0.02).unwrap();
        assert_eq!(straight.knots().len(), 2);
        assert_eq!(SpinCurve::near(&SampledPath::default(), &[], 0.02), None);
    }
}

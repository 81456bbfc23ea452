//! Deviations of points from their least-squares circle over the angle.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `theta` | angle of a point about the centre, counter-clockwise from x, -pi to pi | rad |
//! | `dR` | its distance from the centre less the radius, outward positive | m |
//! | RONp, RONv | highest peak, deepest valley below the circle: `max dR`, `-min dR` | m |
//! | RONq | root of the mean of `dR^2` over the points | m |

use std::f64::consts::TAU;

use nalgebra::{Point2, Vector2};

use super::least_squares::ReferenceCircle;
use super::outlier::{Ends, outlying};

/// A profile as deviations over the angle.
#[derive(Clone, Debug)]
pub struct Polar {
    /// About this centre, m.
    pub centre: Point2<f64>,
    /// From this radius, m.
    pub radius: f64,
    /// Of each point, -pi to pi, rad.
    pub angles: Vec<f64>,
    /// Of each point, outward, m.
    pub deviations: Vec<f64>,
    /// The points in their order round the circle.
    pub order: Vec<usize>,
    /// The largest angle between two neighbours.
    pub gap: Gap,
}

/// An angle without points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Its start, counter-clockwise, rad.
    pub from: f64,
    /// rad
    pub width: f64,
}

/// Points are not neighbours across a gap of this size, rad.
const ENDS: f64 = 20.0 * std::f64::consts::PI / 180.0;
impl Polar {
    pub(super) fn about(points: &[Point2<f64>], circle: &ReferenceCircle) -> Polar {
        let from = |p: &Point2<f64>| p - circle.centre;
        let angles: Vec<f64> = points.iter().map(|p| from(p).y.atan2(from(p).x)).collect();
        let deviations = points.iter().map(|p| from(p).norm() - circle.radius).collect();
        let order = in_order(&angles);
        Polar {
            centre: circle.centre,
            radius: circle.radius,
            gap: widest_gap_in(&angles, &order),
            angles,
            deviations,
            order,
        }
    }

    /// Deviations (m) that are given over the angle (rad), about an arbitrary centre and radius.
    pub fn of_deviations(angles: &[f64], deviations: &[f64]) -> Polar {
        let order = in_order(angles);
        Polar {
            centre: Point2::origin(),
            radius: 0.0,
            gap: widest_gap_in(angles, &order),
            angles: angles.to_vec(),
            deviations: deviations.to_vec(),
            order,
        }
    }

    /// RONp, m.
    pub fn highest_peak(&self) -> f64 {
        self.deviations.iter().copied().fold(f64::MIN, f64::max)
    }

    /// RONv, m.
    pub fn deepest_valley(&self) -> f64 {
        -self.deviations.iter().copied().fold(f64::MAX, f64::min)
    }

    /// RONq, m.
    pub fn root_mean_square(&self) -> f64 {
        let squares: f64 = self.deviations.iter().map(|d| d * d).sum();
        (squares / self.deviations.len() as f64).sqrt()
    }

    /// The points of a profile with these deviations at the same angles, m.
    pub fn with(&self, deviations: &[f64]) -> Vec<Point2<f64>> {
        let at = |(angle, by): (&f64, &f64)| {
            let (sin, cos) = angle.sin_cos();
            self.centre + Vector2::new(cos, sin) * (self.radius + by)
        };
        self.angles.iter().zip(deviations).map(at).collect()
    }

    /// Points that deviate from their neighbours ([`super::outlier`]), in the order of the points, each with its
    /// deviation (m, outward): dirt and scratches, or a true edge.
    pub fn outliers(&self) -> Vec<(usize, f64)> {
        // From the end of the widest gap on.
        let begin = self.order.iter().position(|i| self.angles[*i] > self.gap.from);
        let (last, first) = self.order.split_at(begin.unwrap_or(0));
        let order: Vec<usize> = first.iter().chain(last).copied().collect();
        let values: Vec<f64> = order.iter().map(|index| self.deviations[*index]).collect();
        let ends = if self.gap.width > ENDS {
            Ends::Open
        } else {
            Ends::Closed
        };
        let off = outlying(&values, ends);
        let given = order.into_iter().zip(off);
        let mut found: Vec<(usize, f64)> = given.filter_map(|(index, off)| Some((index, off?))).collect();
        found.sort_by_key(|(index, _)| *index);
        found
    }
}

/// The indices of `angles` in rising order.
fn in_order(angles: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by(|a, b| angles[*a].total_cmp(&angles[*b]));
    order
}

/// The widest angle without any of `angles` (-pi to pi); a whole turn where there are none.
pub(super) fn widest_gap(angles: &[f64]) -> Gap {
    widest_gap_in(angles, &in_order(angles))
}

fn widest_gap_in(angles: &[f64], order: &[usize]) -> Gap {
    let next = order.iter().skip(1).map(|i| angles[*i]);
    let round = order.first().map(|i| angles[*i] + TAU);
    let gaps = order.iter().zip(next.chain(round)).map(|(i, next)| Gap {
        from: angles[*i],
        width: next - angles[*i],
    });
    gaps.max_by(|a, b| a.width.total_cmp(&b.width)).unwrap_or(Gap {
        from: 0.0,
        width: TAU,
    })
}

#[cfg(test)]
mod tests {
    use super::super::Profile;
    use super::*;

    /// `count` even points of 50 mm with two waves of 5 um, noise of up to 0.2 um, plus `dirt`.
    fn profile(count: usize, dirt: impl Fn(usize) -> f64) -> Polar {
        let at = |i: usize| {
            let angle = TAU * i as f64 / count as f64;
            let noise = 0.2e-6 * (i as f64 * 12.9898).sin();
            let r = 0.05 + 5e-6 * (2.0 * angle).cos() + noise + dirt(i);
            Point2::new(0.2, 0.1) + Vector2::new(angle.cos(), angle.sin()) * r
        };
        Profile::new((0..count).map(at).collect()).unwrap().polar()
    }

    #[test]
    fn peak_and_valley_make_the_roundness_and_the_mean_square_is_that_of_a_wave() {
        let polar = profile(720, |_| 0.0);
        let (peak, valley) = (polar.highest_peak(), polar.deepest_valley());
        assert!((peak - 5e-6).abs() < 0.3e-6 && (valley - 5e-6).abs() < 0.3e-6);
        let bare: Vec<_> = (0..360)
            .map(|i| f64::from(i).to_radians())
            .map(|a| Point2::new(a.cos(), a.sin()) * (0.05 + 5e-6 * (3.0 * a).cos()))
            .collect();
        let bare = Profile::new(bare).unwrap();
        let polar = bare.polar();
        assert!((polar.root_mean_square() - 5e-6 / 2.0_f64.sqrt()).abs() < 1e-9);
        let given = polar.highest_peak() + polar.deepest_valley();
        assert!((given - bare.least_squares().peak_to_valley).abs() < 1e-15);
        for (point, again) in bare.points().iter().zip(polar.with(&polar.deviations)) {
            assert!((point - again).norm() < 1e-15);
        }
    }

    #[test]
    fn dirt_and_a_scratch_are_reported_and_waves_are_not() {
        let polar = profile(360, |i| match i {
            77 => 12e-6,
            200 | 201 => -8e-6,
            _ => 0.0,
        });
        let given = polar.outliers();
        assert_eq!(
            given.iter().map(|(index, _)| *index).collect::<Vec<_>>(),
            [77, 200, 201]
        );
        assert!(
            (given[0].1 - 12e-6).abs() < 1e-6 && (given[1].1 + 8e-6).abs() < 1e-6,
            "{given:?}"
        );
        assert!(profile(360, |_| 0.0).outliers().is_empty());
        assert!(profile(36, |_| 0.0).outliers().is_empty());
        // The ends of an arc are not on a step.
        let arc: Vec<_> = (0..200)
            .map(|i| (f64::from(i) / 2.0 + 30.0).to_radians())
            .map(|a| Point2::new(a.cos(), 1.001 * a.sin()) * 0.05)
            .collect();
        assert!(Profile::new(arc).unwrap().polar().outliers().is_empty());
        // Too few to estimate the scatter.
        assert!(
            profile(12, |i| if i == 3 { 1e-3 } else { 0.0 })
                .outliers()
                .is_empty()
        );
    }

    #[test]
    fn the_largest_gap_is_found_anywhere() {
        assert_eq!(widest_gap(&[]).width, TAU);
        assert_eq!(
            widest_gap(&[1.0]),
            Gap {
                from: 1.0,
                width: TAU
            }
        );
        let gap = widest_gap(&[3.0, -3.0, 0.5, 2.0]);
        assert_eq!((gap.from, gap.width), (-3.0, 3.5));
        let across = widest_gap(&[1.0, -1.0, 0.2]);
        assert!(across.from == 1.0 && (across.width - (TAU - 2.0)).abs() < 1e-15);
    }
}

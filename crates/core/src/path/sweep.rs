//! The lowest points of a cutter on a straight step, over each position.
//!
//! ```text
//! bottom(a, b) = min over t in [0, L] of  z0 + m t + z(rho(t)),    rho(t) = sqrt((a - t)^2 + b^2) <= R
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `z0`, `m` | path z of the tip at the lower end, rise per distance along the step seen from above | m, - |
//! | `L`, `t` | length of the step seen from above, distance along it from the lower end | m |
//! | `a`, `b` | position relative to the lower end, along the step and across it | m |
//! | `z(rho)`, `R`, `r` | bottom of the cutter ([`EndMillBody`]), its radius, its corner radius | m |
//!
//! A level step is lowest where it is nearest. A rising one is lowest where the bottom of the cutter is as steep along
//! the step as the step, or at the end before that position:
//!
//! ```text
//! flat    a - t = sqrt(R^2 - b^2)
//! ball    a - t = sqrt(R^2 - b^2) m/sqrt(1 + m^2)
//! bull    (rho^2 - b^2) out^2 = m^2 rho^2 (r^2 - out^2),    out = rho - (R - r),    a - t = sqrt(rho^2 - b^2)
//! ```
//!
//! The last is solved by Newton's method; its left side over its right side increases with `rho`, so there is one root.
//!
//! Source: plane geometry \[derived\].

use nalgebra::{Point3, Vector2};

use crate::load::EndMillBody;

/// A cutter on a straight step, seen from its lower end: the result does not depend on the direction of travel.
pub(super) struct Sweep {
    /// Lower end.
    foot: Point3<f64>,
    /// Upper end.
    head: Point3<f64>,
    /// Upwards, seen from above; any where the step goes straight down or up.
    along: Vector2<f64>,
    /// Seen from above, m.
    length: f64,
    /// Rise per distance seen from above, not negative.
    slope: f64,
    radius: f64,
    flat_radius: f64,
    corner_radius: f64,
}

/// Positions side by side along x.
pub(super) struct Row<'a> {
    /// The first position, m; heights are relative to its z.
    pub(super) first: Point3<f64>,
    /// Distance between positions, m.
    pub(super) side: f64,
    /// For each the lowest point of the cutter over it, m above z and not below it; infinite where it does not pass.
    pub(super) bottoms: &'a mut [f32],
}

/// Maximum number of iterations for a bull nose: it needs 3 to 6, and 40 bisections are 1e-12.
const MOST_ROUNDS: usize = 40;

/// Convergence limit as a fraction of the corner radius: the height is level there, so that its error is proportional
/// to the square of that.
const SETTLED: f64 = 1e-9;

impl Sweep {
    /// Steps shorter than `vertical` (m, seen from above) are treated as straight up or down.
    pub(super) fn of(from: Point3<f64>, to: Point3<f64>, cutter: &EndMillBody, arm_state: f64) -> Sweep {
        let (mut foot, mut head) = if from.z < to.z { (from, to) } else { (to, from) };
        let chord = (head - foot).xy();
        let mut length = chord.norm();
        let (mut along, mut slope) = (chord / length, (head.z - foot.z) / length);
        if length <= arm_state {
            foot = Point3::new(to.x, to.y, foot.z);
            (head, along, length, slope) = (foot, Vector2::x(), 0.0, 0.0);
        }
        Sweep {
            foot,
            head,
            along,
            length,
            slope,
            radius: cutter.radius(),
            flat_radius: cutter.flat_radius(),
            corner_radius: cutter.corner_radius(),
        }
    }

    /// Range of y that the cutter passes over.
    pub(super) fn reach_along_y(&self) -> [f64; 2] {
        let (one, other) = (self.foot.y, self.head.y);
        [one.min(other) - self.radius, one.max(other) + self.radius]
    }

    /// Range of x that the cutter passes over in the row at `y`; first above second where it does not.
    pub(super) fn reach_along_x(&self, y: f64) -> [f64; 2] {
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        let mut take = |x: f64| reach = [reach[0].min(x), reach[1].max(x)];
        for end in [self.foot, self.head] {
            // Not a number where the row is beyond: neither least nor greatest.
            let half = (self.radius * self.radius - (y - end.y) * (y - end.y)).sqrt();
            take(end.x - half);
            take(end.x + half);
        }
        let across = Vector2::new(-self.along.y, self.along.x) * self.radius;
        for side in [self.foot.xy() + across, self.foot.xy() - across] {
            let t = (y - side.y) / self.along.y;
            if (0.0..=self.length).contains(&t) {
                take(side.x + t * self.along.x);
            }
        }
        reach
    }

    /// Computes the lowest points over the positions of a row.
    pub(super) fn pass(&self, row: Row) {
        // The kind of cutter is tested before the row and not at each position: so the compiler can vectorise in pairs.
        let (flat, corner) = (self.flat_radius, self.corner_radius);
        let [radius_squared, corner_squared] = [self.radius, corner].map(|length| length * length);
        let half = |b_squared: f64| (radius_squared - b_squared).sqrt();
        let rounding = |out_squared: f64| corner - greatest(corner_squared - out_squared, 0.0).sqrt();
        let bull_nose = |rho_squared: f64| {
            let out = greatest(rho_squared.sqrt() - flat, 0.0);
            rounding(out * out)
        };
        let nearest = |a: f64, _: f64| a;
        let part = self.slope / (1.0 + self.slope * self.slope).sqrt();
        let is_level = self.slope == 0.0;
        if corner == 0.0 {
            match is_level {
                true => self.fill(row, nearest, |_| 0.0),
                false => self.fill(row, |a, b_squared| a - half(b_squared), |_| 0.0),
            }
        } else if flat == 0.0 {
            match is_level {
                true => self.fill(row, nearest, rounding),
                false => self.fill(row, |a, b_squared| a - part * half(b_squared), rounding),
            }
        } else {
            match is_level {
                true => self.fill(row, nearest, bull_nose),
                false => self.fill(
                    row,
                    |a, b_squared| self.lowest_of_bull_nose(a, b_squared),
                    bull_nose,
                ),
            }
        }
    }

    /// `lowest` computes from `a` and `b^2` where a step without ends is lowest, `height` from `rho^2` the height of
    /// the bottom of the cutter.
    #[inline]
    fn fill(&self, row: Row, lowest: impl Fn(f64, f64) -> f64, height: impl Fn(f64) -> f64) {
        let off = row.first.xy() - self.foot.xy();
        let (a_first, b_first) = (off.dot(&self.along), off.x * self.along.y - off.y * self.along.x);
        let (a_side, b_side) = (self.along.x * row.side, self.along.y * row.side);
        let (length, radius_squared) = (self.length, self.radius * self.radius);
        for (column, bottom) in (0_i32..).zip(row.bottoms) {
            let column = f64::from(column);
            let (a, b) = (a_first + a_side * column, b_first + b_side * column);
            let off = a - least(greatest(a, 0.0), length);
            let is_passed = off * off + b * b <= radius_squared;
            let t = least(greatest(lowest(a, b * b), 0.0), length);
            // The end itself is used: a floor cut twice is then the same to the last bit.
            let tip = if t == length {
                self.head.z
            } else {
                self.foot.z + self.slope * t
            };
            let passed = tip + height((a - t) * (a - t) + b * b) - row.first.z;
            *bottom = if is_passed {
                greatest(passed, 0.0) as f32
            } else {
                f32::INFINITY
            };
        }
    }

    /// Where a bull nose on a rising step is lowest, or any place beyond an end where that is beyond it.
    fn lowest_of_bull_nose(&self, a: f64, b_squared: f64) -> f64 {
        if a <= 0.0 || b_squared > self.radius * self.radius {
            return 0.0;
        }
        let (flat, corner) = (self.flat_radius, self.corner_radius);
        let (slope_squared, corner_squared) = (self.slope * self.slope, corner * corner);
        // Above zero where the bottom is steeper than the step; and its rate.
        let steeper = |rho: f64| {
            let out = rho - flat;
            let (ahead, left) = (rho * rho - b_squared, corner_squared - out * out);
            (
                ahead * out * out - slope_squared * rho * rho * left,
                2.0 * (out * (rho * out + ahead) - slope_squared * rho * (left - rho * out)),
            )
        };
        let from_end = (a - self.length).max(0.0);
        let mut low = (from_end * from_end + b_squared).sqrt().max(flat);
        if low >= self.radius || steeper(low).0 >= 0.0 {
            return a;
        }
        let mut high = (a * a + b_squared).sqrt().min(self.radius);
        if low >= high || steeper(high).0 <= 0.0 {
            return 0.0;
        }
        // Newton from the position of the root straight ahead, bisection where that leaves the interval.
        let mut rho = (flat + corner * self.slope / (1.0 + slope_squared).sqrt()).clamp(low, high);
        for _ in 0..MOST_ROUNDS {
            let (excess, rate) = steeper(rho);
            if excess < 0.0 {
                low = rho;
            } else {
                high = rho;
            }
            let next = rho - excess / rate;
            let inside = next >= low && next <= high;
            let next = if inside { next } else { 0.5 * (low + high) };
            let settled = (next - rho).abs() <= SETTLED * corner;
            rho = next;
            if settled {
                break;
            }
        }
        a - (rho * rho - b_squared).max(0.0).sqrt()
    }
}

/// The greater of two, the second where the first is not a number: one operation, where `f64::max` takes three.
fn greatest(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

/// The lesser of two, the second where the first is not a number.
fn least(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

#[cfg(test)]
mod tests;

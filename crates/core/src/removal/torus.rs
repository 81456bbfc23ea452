//! The slice of the rounded corner of a cutter by a plane, by search.
//!
//! The corner is the lower half of a disc of the radius `R` that is enlarged by `r`:
//!
//! ```text
//! rho(h) = R + sqrt(r^2 - (h - r)^2),    w^2(v) = rho^2(h(v)) - y^2(v),    h = h_0 + v sin,    y = y_0 + v cos
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R`, `r` | radius of the disc, radius of the corner | m |
//! | `u`, `v`, `w` | coordinates in the plane, and half the width of the slice ([`conic`](super::conic)) | m |
//! | `h`, `y` | height above the tip, distance across the tool axis and across `u` | m |
//!
//! `w` is concave where it is defined, and so is `rho - |y|`. The largest `a w + b v` is searched by Newton's method
//! within an interval that is halved where that leaves it; outside of the slice it follows `rho - |y|`. Any point found is a point
//! of the corner: a search that ends early removes too little and never too much. The interval ends below [`SETTLED`]; the error of the
//! value is proportional to the square of that where the maximum is smooth.
//!
//! The part of a line inside is found by Newton's method from outside on the distance from the disc less `r`. That is
//! convex, so each step ends before the surface.
//!
//! Source: \[derived\].

use super::conic::{Chord, Farthest, PlaneLine};

/// The slice of a corner by a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Torus {
    /// Radius of the disc, m.
    pub(super) disc: f64,
    /// Radius of the corner, and height of the disc above the tip, m.
    pub(super) corner: f64,
    /// At `v = 0`, m.
    pub(super) h: f64,
    /// At `v = 0`, m.
    pub(super) y: f64,
    /// Growth of `h` per `v`; not zero.
    pub(super) sin: f64,
    /// Growth of `y` per `v`.
    pub(super) cos: f64,
    /// Ends of `v`, m.
    pub(super) range: [f64; 2],
}

/// Width of the interval at which a search ends, as a fraction of the corner.
const SETTLED: f64 = 1e-9;
/// Most steps of a search: each halves the interval at least every other time.
const MOST_STEPS: usize = 80;

impl Torus {
    /// Where `a w + b v` is largest; `None` where the slice is empty. `a` is not negative.
    pub(super) fn farthest(&self, a: f64, b: f64) -> Option<Farthest> {
        if a == 0.0 && self.cos == 0.0 {
            return self.end_of(b);
        }
        let [mut low, mut high] = self.range;
        // Beyond the largest radius nothing is left.
        let widest = self.disc + self.corner;
        if self.cos != 0.0 {
            let ends = [(-widest - self.y) / self.cos, (widest - self.y) / self.cos];
            low = low.max(ends[0].min(ends[1]));
            high = high.min(ends[0].max(ends[1]));
        }
        let settled = SETTLED * self.corner;
        let mut best: Option<(f64, Farthest)> = None;
        let mut take = |v: f64, square: f64| {
            let w = square.sqrt();
            let value = a * w + b * v;
            if best.is_none_or(|(most, _)| value > most) {
                let inside = v > self.range[0] && v < self.range[1];
                best = Some((value, Farthest { w, v, inside }));
            }
        };
        if low > high {
            return None;
        }
        // A maximum at an end of the band is found there.
        for end in [low, high] {
            let square = self.square(end);
            if square >= 0.0 {
                take(end, square);
            }
        }
        let mut v = 0.5 * (low + high);
        for step in 0..MOST_STEPS {
            let up = self.h + v * self.sin - self.corner;
            let q = ((self.corner - up) * (self.corner + up))
                .max(f64::MIN_POSITIVE)
                .sqrt();
            let (rho, y) = (self.disc + q, self.y + v * self.cos);
            let rate = -up / q;
            let square = rho * rho - y * y;
            let mut next = f64::NAN;
            let rises = if square > 0.0 {
                take(v, square);
                let w = square.sqrt();
                let half = rho * rate * self.sin - y * self.cos;
                let first = a * half / w + b;
                let bend = rate * rate - rho * self.corner * self.corner / (q * q * q);
                let second =
                    a * ((bend * self.sin * self.sin - self.cos * self.cos) / w - half * half / (w * w * w));
                next = v - first / second;
                if first == 0.0 {
                    break;
                }
                first > 0.0
            } else {
                rate * self.sin - self.cos * y.signum() > 0.0
            };
            *(if rises { &mut low } else { &mut high }) = v;
            // Every third step halves, so that an interval closed from one side only closes.
            let leaves = !(next > low && next < high) || step % 3 == 2;
            let next = if leaves { 0.5 * (low + high) } else { next };
            if high - low <= settled || (!leaves && (next - v).abs() <= settled) {
                let square = self.square(next);
                if square >= 0.0 {
                    take(next, square);
                }
                break;
            }
            v = next;
        }
        best.map(|(_, farthest)| farthest)
    }

    /// The least `v` of the slice by a plane through the direction of the axis, where `b` is negative, or else the greatest.
    fn end_of(&self, b: f64) -> Option<Farthest> {
        let out = self.y.abs() - self.disc;
        let [low, high] = self.range;
        let mut v = if b < 0.0 { low } else { high };
        if out > self.corner {
            return None;
        }
        if b < 0.0 && out > 0.0 {
            let down = ((self.corner - out) * (self.corner + out)).sqrt();
            v = v.max((self.corner - down - self.h) / self.sin);
        }
        let square = self.square(v);
        let w = square.max(0.0).sqrt();
        let inside = v > low && v < high;
        (inside || square >= 0.0).then_some(Farthest { w, v, inside })
    }

    /// `w^2` at `v`, m^2.
    fn square(&self, v: f64) -> f64 {
        let up = self.h + v * self.sin - self.corner;
        let rho = self.disc + ((self.corner - up) * (self.corner + up)).max(0.0).sqrt();
        let y = self.y + v * self.cos;
        (rho - y) * (rho + y)
    }

    /// The part of a line within the slice.
    pub(super) fn meets(&self, line: &PlaneLine) -> Option<Chord> {
        let band = line.within(self.range)?;
        let ([u, v], [du, dv]) = (line.start, line.rate);
        if dv == 0.0 {
            let square = self.square(v);
            let half = square.max(0.0).sqrt();
            let ends = [(-half - u) / du, (half - u) / du];
            let outline = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            return if square >= 0.0 {
                Chord::of(outline, band)
            } else {
                None
            };
        }
        // The line in the frame of the tool.
        let up = self.h + v * self.sin - self.corner;
        let (rise, y, dy) = (dv * self.sin, self.y + v * self.cos, dv * self.cos);
        let distance = |s: f64| {
            let (u, y, up) = (u + s * du, y + s * dy, up + s * rise);
            let square = u * u + y * y;
            let rate = u * du + y * dy;
            if square <= self.disc * self.disc {
                return (up.abs() - self.corner, rise * up.signum());
            }
            let rho = square.sqrt();
            let out = rho - self.disc;
            let from_disc = (out * out + up * up).sqrt();
            (
                from_disc - self.corner,
                (out * rate / rho + up * rise) / from_disc,
            )
        };
        // From where the line is as high as the corner: outside of it, or on its surface.
        let ends = [(-self.corner - up) / rise, (self.corner - up) / rise];
        let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let mut part = [0.0; 2];
        for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
            let mut s = ends[k];
            for _ in 0..MOST_STEPS {
                let (out, rate) = distance(s);
                if out <= 1e-14 {
                    break;
                }
                if rate * sign >= 0.0 {
                    return None;
                }
                s -= out / rate;
                if (s - ends[1 - k]) * sign > 0.0 {
                    return None;
                }
            }
            part[k] = s;
        }
        Chord::of(part, band)
    }
}

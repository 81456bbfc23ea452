//! Height of the scallops between neighbouring passes of a tool with a rounded corner, on a flat surface.
//!
//! ```text
//! z(y) = min over t of  c_z(t) - sqrt(r^2 - (y - c_y(t))^2)        c(t) = (R - r) (u cos t + v sin t)
//! scallop = max over y of min(z(y), z(y - s)) - min z
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R`, `r` | radius of the tool and of its corner | m |
//! | `u`, `v` | unit vectors across the axis of the leaning tool; y across the feed, z along the normal of the surface | - |
//! | `z(y)` | profile that a pass leaves across the feed | m |
//! | `s` | stepover: distance of neighbouring passes | m |
//!
//! The corner is a torus: balls of radius `r` around a ring. Moved along the feed it leaves the lower envelope of their
//! profiles across the feed. Source: envelope of a swept torus; for an upright ball nose
//! `R - sqrt(R^2 - s^2 / 4)`. The feed marks along a pass are not included.

use std::f64::consts::{PI, TAU};

use nalgebra::{Unit, Vector3};

use super::lean::{Lean, RoundedEnd};

/// Samples of the ring, and halvings of intervals.
const SAMPLES: usize = 180;
const HALVINGS: usize = 60;

/// Height of the scallops between passes at this distance, m; `None` where the passes do not overlap.
pub fn scallop(end: RoundedEnd, lean: Lean, stepover: f64) -> Option<f64> {
    let profile = Profile::of(end, lean);
    let lowest = profile.lowest();
    // The profile falls to its lowest place and rises behind it; that of the next pass is the same, farther on.
    let [mut from, mut to] = [lowest, lowest + stepover];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        match profile.height(middle) < profile.height(middle - stepover) {
            true => from = middle,
            false => to = middle,
        }
    }
    // Where the passes overlap, both profiles are there.
    let both = [from, from - stepover].map(|y| profile.height(y));
    let is_covered = both.iter().all(|height| height.is_finite());
    is_covered.then(|| (both[0].min(both[1]) - profile.height(lowest)).max(0.0))
}

/// The profile of a pass across the feed: the ring of a corner in the plane across the feed.
struct Profile {
    /// y and z of the ring at angles 0 and a quarter turn, m.
    u: [f64; 2],
    v: [f64; 2],
    corner: f64,
}

impl Profile {
    fn of(end: RoundedEnd, lean: Lean) -> Profile {
        let upright = Vector3::z() * lean.tilt.cos() + Vector3::y() * lean.tilt.sin();
        let axis = Unit::new_normalize(upright * lean.lead.cos() + Vector3::x() * lean.lead.sin());
        let u = axis
            .cross(&Vector3::y())
            .try_normalize(1e-9)
            .unwrap_or_else(Vector3::x);
        let v = axis.cross(&u);
        let ring = end.radius - end.corner;
        Profile {
            u: [u.y * ring, u.z * ring],
            v: [v.y * ring, v.z * ring],
            corner: end.corner,
        }
    }

    /// Where the profile is lowest, m: the middle of what the lowest part of the ring leaves.
    fn lowest(&self) -> f64 {
        let [down, across] = [self.u, self.v].map(|[_, z]| z);
        // The ring is lowest where its height has its least value.
        match down.hypot(across) {
            0.0 => 0.0,
            _ => {
                let angle = across.atan2(down) + PI;
                self.at(angle)[0]
            }
        }
    }

    fn at(&self, angle: f64) -> [f64; 2] {
        let (sin, cos) = angle.sin_cos();
        [0, 1].map(|k| self.u[k] * cos + self.v[k] * sin)
    }

    /// Height of the profile at `y`, m; infinite outside the tool.
    fn height(&self, y: f64) -> f64 {
        let of = |angle: f64| {
            let [across, up] = self.at(angle);
            let under = self.corner.powi(2) - (y - across).powi(2);
            if under >= 0.0 {
                up - under.sqrt()
            } else {
                f64::INFINITY
            }
        };
        let step = TAU / SAMPLES as f64;
        let first = (0..SAMPLES)
            .map(|sample| sample as f64 * step)
            .min_by(|a, b| of(*a).total_cmp(&of(*b)))
            .unwrap_or(0.0);
        let [mut from, mut to] = [first - step, first + step];
        for _ in 0..HALVINGS {
            let [a, b] = [from + (to - from) / 3.0, to - (to - from) / 3.0];
            match of(a) < of(b) {
                true => to = b,
                false => from = a,
            }
        }
        of(0.5 * (from + to)).min(of(first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPRIGHT: Lean = Lean { lead: 0.0, tilt: 0.0 };

    fn end(radius: f64, corner: f64) -> RoundedEnd {
        RoundedEnd { radius, corner }
    }

    #[test]
    fn a_ball_leaves_the_same_scallop_in_every_lean() {
        // By hand: two circles of radius R whose centres are s apart.
        let (radius, stepover) = (0.006_f64, 0.0008_f64);
        let expected = radius - (radius.powi(2) - stepover.powi(2) / 4.0).sqrt();
        for (lead, tilt) in [(0.0, 0.0), (0.3, 0.0), (-0.2, 0.5), (0.7, -0.4)] {
            let found = scallop(end(radius, radius), Lean { lead, tilt }, stepover).unwrap();
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn an_upright_bull_nose_leaves_none_below_its_flat_and_its_corner_beyond() {
        let bull = end(0.0125, 0.005);
        assert!(scallop(bull, UPRIGHT, 0.014).unwrap() < 1e-9);
        // Beyond the flat of 15 mm the corners are 3 mm apart at their centres.
        let expected = 0.005 - (0.005_f64.powi(2) - 0.0015_f64.powi(2)).sqrt();
        let found = scallop(bull, UPRIGHT, 0.018).unwrap();
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        assert_eq!(scallop(bull, UPRIGHT, 0.026), None);
    }

    #[test]
    fn a_bull_nose_with_lead_has_the_curvature_of_the_leaning_ring() {
        // Across the feed the ring has the radius of curvature (R - r) / sin(lead), and the corner adds r.
        let (bull, lead, stepover) = (end(0.0125, 0.005), 0.2_f64, 0.001_f64);
        let radius = 0.0075 / lead.sin() + 0.005;
        let expected = stepover.powi(2) / (8.0 * radius);
        let found = scallop(bull, Lean { lead, tilt: 0.0 }, stepover).unwrap();
        assert!((found - expected).abs() < 2e-3 * expected, "{found} {expected}");
    }

    #[test]
    fn tilt_to_either_side_is_alike_and_leaves_higher_scallops() {
        let bull = end(0.0125, 0.005);
        let at = |tilt: f64| scallop(bull, Lean { lead: 0.1, tilt }, 0.002).unwrap();
        assert!((at(0.2) - at(-0.2)).abs() < 1e-12);
        assert!(at(0.2) > at(0.05) && at(0.05) > at(0.0));
    }

    /// The profiles by brute force: points of the torus, in slices across the feed.
    #[test]
    fn the_profile_is_the_lower_envelope_of_the_torus() {
        let (bull, lean) = (
            end(0.0125, 0.005),
            Lean {
                lead: 0.25,
                tilt: 0.15,
            },
        );
        let profile = Profile::of(bull, lean);
        for slice in -20..=20 {
            let y = f64::from(slice) * 5e-4;
            let lowest = (0..20_000)
                .map(|sample| {
                    let [across, up] = profile.at(f64::from(sample) * TAU / 20_000.0);
                    let under = 0.005_f64.powi(2) - (y - across).powi(2);
                    if under >= 0.0 {
                        up - under.sqrt()
                    } else {
                        f64::INFINITY
                    }
                })
                .fold(f64::INFINITY, f64::min);
            let found = profile.height(y);
            assert!((found - lowest).abs() < 1e-9, "{y}: {found} {lowest}");
        }
    }
}

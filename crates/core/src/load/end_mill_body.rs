//! The body that a turning end mill fills: height of its bottom above the tip.
//!
//! ```text
//! z(rho) = 0                                        rho <= R - r
//! z(rho) = r - sqrt(r^2 - (rho - (R - r))^2)        R - r < rho <= R
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R` | radius of the cutter | m |
//! | `r` | corner radius: 0 of a flat end mill, `R` of a ball, between them of a bull nose | m |
//! | `rho` | distance from the tool axis | m |
//! | `z` | height of the bottom above the tip | m |
//!
//! Above the corner the body is a cylinder without end: no length of flute, no shank, no holder, no taper.

use super::error::{CuttingError, checked};

/// A flat, ball or bull nose end mill as a body of revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndMillBody {
    radius: f64,
    corner_radius: f64,
}

/// Largest cutter, m: far above any that a robot carries.
const MOST_DIAMETER: f64 = 1.0;
/// Smallest cutter, m: far below any that is made.
const LEAST_DIAMETER: f64 = 1e-5;

impl EndMillBody {
    /// An end mill of this `diameter` with this `corner_radius` (m).
    ///
    /// # Errors
    /// Numbers that are not finite, a diameter out of range, a corner radius beyond half of it.
    pub fn new(diameter: f64, corner_radius: f64) -> Result<EndMillBody, CuttingError> {
        let made = [LEAST_DIAMETER, MOST_DIAMETER];
        let radius = checked("diameter of the cutter", diameter, made, "m")? / 2.0;
        let corner_radius = checked("corner radius", corner_radius, [0.0, radius], "m")?;
        Ok(EndMillBody {
            radius,
            corner_radius,
        })
    }

    /// m
    pub fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    /// Radius of the cylinder, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Radius of the corner, m.
    pub fn corner_radius(&self) -> f64 {
        self.corner_radius
    }

    /// Radius of the flat part of the bottom, m; none of a ball.
    pub fn flat_radius(&self) -> f64 {
        self.radius - self.corner_radius
    }

    /// Height of the bottom above the tip at the distance `rho` (m) from the axis; beyond the radius as at the radius.
    pub fn height(&self, rho: f64) -> f64 {
        let (r, out) = (self.corner_radius, rho - self.flat_radius());
        if out <= 0.0 {
            return 0.0;
        }
        let out = out.min(r);
        // r - sqrt(r^2 - out^2) without the difference of two nearly equal numbers.
        out * out / (r + (r * r - out * out).sqrt()).max(f64::MIN_POSITIVE)
    }

    /// Radius of the section at `height` (m) above the tip, not negative.
    pub fn radius_at(&self, height: f64) -> f64 {
        let r = self.corner_radius;
        let up = height.clamp(0.0, r);
        self.flat_radius() + (up * (2.0 * r - up)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_a_sphere_and_a_bull_nose_has_a_flat_bottom_and_a_quarter_of_a_torus() {
        let ball = EndMillBody::new(0.01, 0.005).unwrap();
        for rho in [0.0, 1e-6, 0.001, 0.003, 0.004999, 0.005] {
            // Pythagoras about the centre of the ball; a difference of squares of 25e-6 keeps 1e-16 / 5e-3 of a metre.
            let above = ball.height(rho) - 0.005;
            assert!((above.hypot(rho) - 0.005).abs() < 1e-15, "{rho}");
            // The root is steep near the tip: 1e-17 of a height there is 1e-10 of a radius.
            assert!((ball.radius_at(ball.height(rho)) - rho).abs() < 1e-9, "{rho}");
        }
        let bull = EndMillBody::new(0.01, 0.001).unwrap();
        assert_eq!((bull.height(0.0), bull.height(0.004)), (0.0, 0.0));
        assert!((bull.height(0.004 + 0.0006) - 0.0002).abs() < 1e-15);
        assert_eq!(bull.height(0.005), 0.001);
        let flat = EndMillBody::new(0.01, 0.0).unwrap();
        assert_eq!((flat.height(0.005), flat.radius_at(0.0)), (0.0, 0.005));
    }

    #[test]
    fn refuses_invalid_cutters() {
        for (diameter, corner_radius) in [
            (0.0, 0.0),
            (-0.01, 0.0),
            (f64::NAN, 0.0),
            (f64::INFINITY, 0.0),
            (0.01, -1e-9),
            (0.01, 0.0050001),
            (0.01, f64::NAN),
            (9e-6, 0.0),
            (1.1, 0.0),
        ] {
            let refused = EndMillBody::new(diameter, corner_radius);
            assert!(refused.is_err(), "{diameter} {corner_radius}");
        }
    }

    #[test]
    fn height_and_radius_undo_each_other_and_only_rise() {
        for (diameter, corner) in [
            (0.01, 0.005),
            (0.01, 0.001),
            (0.016, 0.0),
            (1e-5, 5e-6),
            (1.0, 0.5),
        ] {
            let body = EndMillBody::new(diameter, corner).unwrap();
            assert_eq!(body.diameter(), diameter);
            let mut before = 0.0;
            for k in 0..=50 {
                let rho = body.radius() * f64::from(k) / 50.0;
                let height = body.height(rho);
                assert!(height >= before && height <= corner, "{diameter} {rho}");
                if rho > body.flat_radius() * (1.0 + 1e-9) {
                    let off = body.radius_at(height) - rho;
                    // The root is steep near the tip.
                    assert!(off.abs() < 2e-7 * diameter, "{diameter} {rho}: {off}");
                }
                before = height;
            }
            assert_eq!(body.radius_at(10.0 * diameter), body.radius());
            assert_eq!(body.radius_at(-1.0), body.flat_radius());
        }
    }
}

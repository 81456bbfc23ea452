//! Lean of the tool from the normal of the surface, and the part of a leaning body below a height.
//!
//! ```text
//! a = cos(lead) (cos(tilt) n + sin(tilt) l) + sin(lead) f
//! h(u) = u . P + (R - r) |u x a| + r        of unit vectors u with u . a <= 0
//! y(d) = min over m of  h(l - m n) + m d    greatest distance to the left of the part of the body below the height d
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `f`, `l`, `n` | feed direction across the normal, to its left, outward normal of the surface | - |
//! | `a` | tool axis from the tip to the spindle | - |
//! | `P` | point of the tool axis at the height of the centres of the corner; over the origin, where the tool touches the surface | m |
//! | `R`, `r` | radius of the cutter and of its corner | m |
//! | `h(u)` | support function of the body: how far it reaches along `u` | m |
//!
//! The body is convex and has no upper end. Source: support functions and duality of a linear bound \[derived\].

use nalgebra::Vector3;

use super::end_mill_body::EndMillBody;

/// Lean of the tool from the programmed axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lean {
    /// Towards the feed, rad.
    pub lead: f64,
    /// To the left of the feed, rad.
    pub tilt: f64,
}

/// How a tool leans in a cut, and where its strip of material is then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LeanInCut {
    /// Lean from the normal of the surface.
    pub lean: Lean,
    /// By how much the right and the left edge of the strip are moved to the left, m: the radial depth is measured from
    /// the widest point of the leaning tool, as it is from that of the upright one.
    pub moved: [f64; 2],
}

/// Halvings of the interval of the multiplier.
const HALVINGS: usize = 100;

impl Lean {
    /// Upright.
    pub const NONE: Lean = Lean { lead: 0.0, tilt: 0.0 };

    /// The tool axis from the tip to the spindle, along the feed, to its left and along the normal.
    pub fn axis(&self) -> Vector3<f64> {
        let ((sin_lead, cos_lead), (sin_tilt, cos_tilt)) = (self.lead.sin_cos(), self.tilt.sin_cos());
        Vector3::new(sin_lead, cos_lead * sin_tilt, cos_lead * cos_tilt)
    }
}

impl EndMillBody {
    /// Height (m) of a point of the axis at the centres of the corner over the surface that the leaning body touches.
    pub(super) fn height_over_surface(&self, axis: &Vector3<f64>) -> f64 {
        self.corner_radius() + self.flat_radius() * axis.xy().norm()
    }

    /// Right and left end (m, to the left of the point of contact) of the part of the leaning body that is less than
    /// `depth` (m) over the surface that it touches.
    pub(super) fn extent(&self, lean: Lean, depth: f64) -> [f64; 2] {
        let axis = lean.axis();
        let right = self.reach(&axis, -Vector3::y(), depth);
        [-right, self.reach(&axis, Vector3::y(), depth)]
    }

    /// The point of the leaning body with the outward normal `u`, a unit vector that does not point up along its axis; relative to
    /// the point of contact, m.
    pub(super) fn point_with_normal(&self, axis: &Vector3<f64>, u: &Vector3<f64>) -> Vector3<f64> {
        let across = u - axis * u.dot(axis);
        let ring = across * (self.flat_radius() / across.norm().max(f64::MIN_POSITIVE));
        // Written so that low points keep their height.
        let height = self.corner_radius() * (1.0 + u.z) + self.flat_radius() * axis.xy().norm() + ring.z;
        Vector3::new(
            self.corner_radius() * u.x + ring.x,
            self.corner_radius() * u.y + ring.y,
            height,
        )
    }

    /// How far the part below `depth` reaches along `side`, m.
    fn reach(&self, axis: &Vector3<f64>, side: Vector3<f64>, depth: f64) -> f64 {
        let centre = Vector3::z() * self.height_over_surface(axis);
        let normal = Vector3::z();
        let bound = |m: f64| {
            let u = side - normal * m;
            u.dot(&centre)
                + self.flat_radius() * u.cross(axis).norm()
                + self.corner_radius() * u.norm()
                + m * depth
        };
        let rate = |m: f64| {
            let u = side - normal * m;
            let across = u - axis * u.dot(axis);
            let part = |of: &Vector3<f64>| of.dot(&normal) / of.norm().max(f64::MIN_POSITIVE);
            depth - centre.z - self.flat_radius() * part(&across) - self.corner_radius() * part(&u)
        };
        // Below this multiplier the direction points up along the body, which has no end there.
        let least = (side.dot(axis) / axis.z).max(0.0);
        let mut low = least;
        let mut high = least + 1.0;
        while rate(high) < 0.0 && high < 1e12 {
            high = least + 2.0 * (high - least);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match rate(middle) < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        bound(0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MM: f64 = 1e-3;

    #[test]
    fn the_part_of_an_upright_body_below_a_height_is_as_wide_as_its_section_there() {
        for (diameter, corner) in [(12.0, 6.0), (25.0, 5.0), (10.0, 0.0)] {
            let body = EndMillBody::new(diameter * MM, corner * MM).unwrap();
            for depth in [0.01, 0.3, 2.0, 4.99, 7.0] {
                let expected = body.radius_at(depth * MM);
                let [right, left] = body.extent(Lean::NONE, depth * MM);
                // Flat to first order about the best multiplier.
                assert!((left - expected).abs() < 1e-12 && (right + expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_ball_is_as_wide_in_every_lean_and_a_bull_nose_as_its_points_are() {
        let ball = EndMillBody::new(12.0 * MM, 6.0 * MM).unwrap();
        let bull = EndMillBody::new(25.0 * MM, 5.0 * MM).unwrap();
        for (lead, tilt) in [(0.3, 0.0), (-0.2, 0.4), (0.0, -0.5), (0.6, 0.6)] {
            let lean = Lean { lead, tilt };
            let [right, left] = ball.extent(lean, MM);
            let expected = ball.radius_at(MM);
            assert!((left - expected).abs() < 1e-12 && (right + expected).abs() < 1e-12);
            for depth in [0.5 * MM, 3.0 * MM, 9.0 * MM] {
                let [right, left] = bull.extent(lean, depth);
                let [least, most] = of_points(&bull, lean, depth);
                // The points are 0.1 deg and 10 um apart.
                assert!(most <= left + 1e-12 && left - most < 2e-5, "{left} {most}");
                assert!(least >= right - 1e-12 && least - right < 2e-5, "{right} {least}");
            }
        }
    }

    /// The same from points all over the body.
    fn of_points(body: &EndMillBody, lean: Lean, depth: f64) -> [f64; 2] {
        let axis = lean.axis();
        let x = axis.cross(&Vector3::y()).normalize();
        let y = axis.cross(&x);
        let centre = Vector3::z() * body.height_over_surface(&axis);
        let mut found = [f64::INFINITY, f64::NEG_INFINITY];
        for k in 0..4000 {
            let height = f64::from(k) * 1e-5;
            // The flat bottom is inside the hull of the corner and of its rim.
            for angle in (0..3600).map(|i| f64::from(i) * std::f64::consts::TAU / 3600.0) {
                let out = (x * angle.cos() + y * angle.sin()) * body.radius_at(height);
                let at = centre + out + axis * (height - body.corner_radius());
                if at.z <= depth {
                    found = [found[0].min(at.y), found[1].max(at.y)];
                }
            }
        }
        found
    }
}

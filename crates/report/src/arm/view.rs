//! From where the arm is seen, and the projection that follows: parallel, z up.
//!
//! The viewer is in direction `d = (cos e cos a, cos e sin a, sin e)`; picture axes are `r = (-sin a, cos a, 0)` to the right
//! and `u = d x r` up; the depth `p . d` grows towards the viewer.
//!
//! | view | azimuth a | elevation e | to the right | up |
//! |---|---|---|---|---|
//! | iso | -122 deg | 20 deg | x, less of -y | z, foreshortened |
//! | front | 0 | 0 | y | z |
//! | side | -90 deg | 0 | x | z |
//! | top | -90 deg | 90 deg | x | y |
//!
//! Parallel: lengths do not shrink with distance, and a length across the line of sight is true.

use armill_core::units::from_deg;

/// A point or direction in base components, mm where it is a point.
pub(crate) type Vec3 = [f64; 3];

/// From where the arm is seen. The base frame has x forward, y to the arm's left, z up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// From behind the arm's right shoulder, from above: the face of a plate in front of the arm is seen.
    #[default]
    Iso,
    /// From the front, looking along -x: y runs to the right.
    Front,
    /// From the arm's right side, looking along +y: x runs to the right.
    Side,
    /// From above: x runs to the right, y up.
    Top,
}

impl View {
    /// Name for a panel's title.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Iso => "isometric",
            Self::Front => "front (along −x)",
            Self::Side => "side (along +y)",
            Self::Top => "top (along −z)",
        }
    }

    /// The directions of right, up and towards the viewer that belong to the view.
    pub(crate) fn projection(self) -> Projection {
        let (azimuth_deg, elevation_deg): (f64, f64) = match self {
            Self::Iso => (-122.0, 20.0),
            Self::Front => (0.0, 0.0),
            Self::Side => (-90.0, 0.0),
            Self::Top => (-90.0, 90.0),
        };
        Projection::from(azimuth_deg, elevation_deg)
    }
}

impl Projection {
    /// Seen from this direction, deg.
    pub(crate) fn from(azimuth_deg: f64, elevation_deg: f64) -> Projection {
        let (sa, ca) = from_deg(azimuth_deg).sin_cos();
        let (se, ce) = from_deg(elevation_deg).sin_cos();
        let toward = [ce * ca, ce * sa, se];
        let right = [-sa, ca, 0.0];
        Projection {
            right,
            up: cross(toward, right),
            toward,
        }
    }
}

/// The three directions of a parallel projection in base components, each of length one, at right angles to
/// each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    pub(crate) right: Vec3,
    pub(crate) up: Vec3,
    pub(crate) toward: Vec3,
}

impl Projection {
    /// Picture coordinates of a point: right and up, in mm.
    pub(crate) fn flat(&self, p: Vec3) -> [f64; 2] {
        [dot(self.right, p), dot(self.up, p)]
    }

    /// How near to the viewer a point is, in mm, from the plane through the base origin.
    pub(crate) fn depth(&self, p: Vec3) -> f64 {
        dot(self.toward, p)
    }
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product, right-handed.
pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a + t b`.
pub(crate) fn along(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

/// The way from one point to another.
pub(crate) fn between(from: Vec3, to: Vec3) -> Vec3 {
    along(to, from, -1.0)
}

pub(crate) fn length(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`, or z where `a` has no length.
pub(crate) fn unit(a: Vec3) -> Vec3 {
    let n = length(a);
    if n > 1e-12 && n.is_finite() {
        a.map(|v| v / n)
    } else {
        [0.0, 0.0, 1.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_view_is_right_handed_and_unit() {
        for view in [View::Iso, View::Front, View::Side, View::Top] {
            let p = view.projection();
            let d = cross(p.right, p.up);
            assert!((0..3).all(|k| (d[k] - p.toward[k]).abs() < 1e-12), "{view:?}");
            assert!((length(p.up) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_side_view_shows_x_to_the_right_and_z_up() {
        let flat = View::Side.projection().flat([3.0, 5.0, 7.0]);
        assert!((flat[0] - 3.0).abs() < 1e-12 && (flat[1] - 7.0).abs() < 1e-12);
    }
}

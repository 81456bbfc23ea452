//! Whether forward kinematics agrees with a solution.

use nalgebra::{Matrix3, Vector3};

use super::super::forward::Frames;
use super::super::unreachable::Unreachable;
use crate::frame::Isometry;
use crate::numbers::{Real, Vector};

/// Greatest distance between the forward kinematics of a solution and the requested pose, m and rad.
///
/// The closed form is accurate to 1e-15 of the arm's length; a thousand times its worst is an inconsistent geometry.
pub(crate) const VERIFIED: f64 = 1e-9;

/// Verifies that these frames have the flange at the requested pose, within 1e-9 m and rad.
///
/// # Errors
/// [`Unreachable::Unverified`] with the distance missed.
pub fn verify(frames: &Frames, base_from_flange: &Isometry) -> Result<(), Unreachable> {
    let reached = Requested {
        axes: *frames.base_from_flange.rotation.matrix(),
        origin: frames.base_from_flange.translation.vector,
    };
    let requested = Requested::new(base_from_flange);
    Miss::<f64>::between(reached.in_lanes(), requested.in_lanes()).verify()
}

/// A flange pose as axes and origin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Requested {
    /// Axes as columns.
    pub axes: Matrix3<f64>,
    /// Origin, m.
    pub origin: Vector3<f64>,
}

impl Requested {
    pub fn new(base_from_flange: &Isometry) -> Requested {
        Requested {
            axes: base_from_flange.rotation.to_rotation_matrix().into_inner(),
            origin: base_from_flange.translation.vector,
        }
    }

    /// Its three axes and its origin, the same in every lane.
    #[inline(always)]
    pub fn in_lanes<R: Real>(&self) -> [Vector<R>; 4] {
        let [x, y, z] = [0, 1, 2].map(|axis| self.axes.column(axis).into_owned());
        [
            Vector::of(&x),
            Vector::of(&y),
            Vector::of(&z),
            Vector::of(&self.origin),
        ]
    }
}

/// How far a pose is from the requested one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Miss<R> {
    /// Square of the distance, m^2.
    pub away: R,
    /// Square of the sine of the angle between them.
    pub sine: R,
    /// Cosine of that angle.
    pub cosine: R,
}

impl<R: Real> Miss<R> {
    /// Between two poses, each its axes and its origin.
    #[inline(always)]
    pub fn between([x, y, z, at]: [Vector<R>; 4], [to_x, to_y, to_z, to]: [Vector<R>; 4]) -> Miss<R> {
        let (away, half) = (at - to, R::of(0.5));
        // Each pair of axes gives the sine of the angle between them: exact where the cosine has lost it.
        let sine = (x.cross(to_x) + y.cross(to_y) + z.cross(to_z)).scaled(half);
        let trace = x.dot(to_x) + y.dot(to_y) + z.dot(to_z);
        Miss {
            away: away.dot(away),
            sine: sine.dot(sine),
            cosine: half * (trace - R::of(1.0)),
        }
    }
}

impl Miss<f64> {
    /// Whether it is below the limits.
    pub fn verify(&self) -> Result<(), Unreachable> {
        let least = VERIFIED * VERIFIED;
        if self.away < least && self.sine < least && self.cosine > 0.0 {
            Ok(())
        } else {
            Err(Unreachable::Unverified { by: self.away.sqrt() })
        }
    }
}

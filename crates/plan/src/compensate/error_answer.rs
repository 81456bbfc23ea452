//! How far the tool is from the nominal path.

use armill_core::nalgebra::Vector3;
use armill_core::path::{Parts, Track};
use armill_core::units::to_um;
use serde::Serialize;

/// Distances of the tool from the nominal path, over all points and load cases.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorAnswer {
    /// Largest, in space.
    pub max_um: f64,
    /// Root of the mean square, in space.
    pub rms_um: f64,
    /// Largest across the tool.
    pub max_in_plane_um: f64,
    /// Largest magnitude across the track: the error of walls.
    pub max_cross_um: f64,
    /// Largest magnitude along the tool: the error of floors.
    pub max_axial_um: f64,
}

impl ErrorAnswer {
    /// Statistics of these distances from the path, m, base; this number per point.
    pub(super) fn of(track: &Track, errors: &[Vector3<f64>], cases: usize) -> ErrorAnswer {
        let parts = |at: usize| track.parts(at / cases, &errors[at]);
        let largest = |of: &dyn Fn(Parts) -> f64| {
            let sizes = (0..errors.len()).map(|at| of(parts(at)).abs());
            to_um(sizes.fold(0.0, f64::max))
        };
        let square: f64 = errors.iter().map(Vector3::norm_squared).sum();
        ErrorAnswer {
            max_um: to_um(errors.iter().map(Vector3::norm).fold(0.0, f64::max)),
            rms_um: to_um((square / errors.len().max(1) as f64).sqrt()),
            max_in_plane_um: largest(&|parts| parts.along.hypot(parts.cross)),
            max_cross_um: largest(&|parts| parts.cross),
            max_axial_um: largest(&|parts| parts.axial),
        }
    }
}

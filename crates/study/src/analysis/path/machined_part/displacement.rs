//! Displacement of a point of the tool.

use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::Track;
use armill_core::spatial::Twist;

/// Displacement of the material of the tool at a point of the surface (path axes) under this twist of the tool (base), m.
pub fn displacement_at(track: &Track, index: usize, point: &Point3<f64>, twist: &Twist) -> Vector3<f64> {
    let path_from_base = track.placing.base_from_path.rotation.inverse();
    let from_tip = point - track.path.points[index].at;
    path_from_base * twist.linear + (path_from_base * twist.angular).cross(&from_tip)
}

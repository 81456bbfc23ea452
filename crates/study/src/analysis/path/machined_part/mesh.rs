//! The nominal surface of a part as triangles, with the deviation at each vertex: for pictures, files and the live page.

use armill_core::nalgebra::{Point3, Vector3};
use armill_core::removal::{RemovalError, SurfacePoint};
use armill_core::robot::Robot;
use rayon::prelude::*;

use super::MachinedSetting;
use super::run::{MachinedPart, path_point};
use crate::analysis::path::PathAnalysis;

/// A surface with its deviation, frame of the path.
#[derive(Clone, Debug, Default)]
pub struct PartMesh {
    /// m
    pub vertices: Vec<Point3<f64>>,
    /// Out of the material.
    pub normals: Vec<Vector3<f64>>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Deviation at each vertex, m, positive where material is left; not a number where the surface is not made or the deviation not known.
    pub deviations: Vec<f64>,
    /// Standard uncertainty of each, m; not a number where it is not known.
    pub uncertainties: Vec<f64>,
}

/// Triangles at most: fluid in viewers.
pub(super) const MOST_TRIANGLES: usize = 500_000;

impl MachinedPart {
    /// The nominal surface with at most so many triangles.
    ///
    /// # Errors
    /// A part that is too large for a mesh.
    pub(super) fn triangles(
        &self,
        robot: &Robot,
        analysis: &PathAnalysis,
        machined: &MachinedSetting,
        most_triangles: usize,
    ) -> Result<PartMesh, RemovalError> {
        let comparison = self.comparison(machined);
        let stride = self.nominal.mesh_stride(most_triangles)?;
        let mesh = self
            .nominal
            .surface_mesh(stride, |point| comparison.nominal_normal(point))?;
        let is_known = |point: &SurfacePoint| {
            let at = |index: usize| self.deviations.get(index).is_none_or(Option::is_some);
            path_point(point.origin).is_none_or(|index| at(index) && at(index.saturating_sub(1)))
        };
        let deviation = |point: &SurfacePoint| {
            let known = Some(point).filter(|point| is_known(point));
            known
                .and_then(|point| comparison.deviation_at(point))
                .unwrap_or(f64::NAN)
        };
        let of_points: Vec<f64> = mesh.points.par_iter().map(deviation).collect();
        let values = |of_points: &[f64]| {
            let values = mesh.vertex_values(of_points).into_iter();
            values.map(|value| value.unwrap_or(f64::NAN)).collect()
        };
        let variance = self.variance(robot, analysis);
        let of_variance = |(point, deviation): (&SurfacePoint, &f64)| {
            let normal = Some(())
                .filter(|()| !deviation.is_nan())
                .and_then(|()| comparison.nominal_normal(point));
            let found = normal.and_then(|normal| variance(point.origin, &normal));
            found.map_or(f64::NAN, f64::sqrt)
        };
        let of_u: Vec<f64> = mesh.points.iter().zip(&of_points).map(of_variance).collect();
        Ok(PartMesh {
            deviations: values(&of_points),
            uncertainties: values(&of_u),
            vertices: mesh.vertices,
            normals: mesh.normals,
            triangles: mesh.triangles,
        })
    }
}

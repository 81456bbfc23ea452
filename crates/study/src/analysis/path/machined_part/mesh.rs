//! The nominal surface of a part as triangles, with the deviation at each vertex: for pictures, files and the live page.

use armill_core::machined::{PartComparison, PointDeviation, TipDeviation, is_known};
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::removal::{DexelPart, EndOrigin, RemovalError, SurfacePoint};
use armill_core::watch::{Cancelled, Watch};
use rayon::prelude::*;

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
    /// The point of the path whose move made the surface at each vertex, of the part where that is known, else of the nominal part; none of the stock and of a mesh.
    pub made_by: Vec<Option<u32>>,
}

/// Triangles at most: fluid in viewers.
pub(super) const MOST_TRIANGLES: usize = 500_000;

/// The surface of a nominal part, and what is known of its points.
pub(super) struct ComparedSurface<'a, V> {
    /// The nominal part.
    pub nominal: &'a DexelPart,
    /// The comparison of the part with it.
    pub comparison: PartComparison<'a>,
    /// The deviation of the tool at each point of the path.
    pub deviations: &'a [Option<TipDeviation>],
    /// Variance of the deviation along a normal of what a move makes, m^2.
    pub variance: V,
}

impl<V> ComparedSurface<'_, V>
where
    V: Fn(EndOrigin, &Vector3<f64>) -> Option<f64>,
{
    /// The surface with at most so many triangles.
    ///
    /// # Errors
    /// A part that is too large for a mesh; cancelled by the watch.
    pub(super) fn triangles(
        &self,
        most_triangles: usize,
        watch: Watch<'_>,
    ) -> Result<PartMesh, RemovalError> {
        let stride = self.nominal.mesh_stride(most_triangles)?;
        let comparison = &self.comparison;
        let normal = |point: &SurfacePoint| comparison.nominal_normal(point);
        let mesh = self.nominal.surface_mesh(stride, normal)?;
        let deviation = |point: &SurfacePoint| {
            if watch.is_cancelled() {
                return Err(Cancelled);
            }
            let found = comparison.deviation_at(point);
            Ok(found.filter(|found| is_known(self.deviations, found.made_by)))
        };
        let found: Result<Vec<Option<PointDeviation>>, Cancelled> =
            mesh.points.par_iter().map(deviation).collect();
        let found = found?;
        let of_points: Vec<f64> = (found.iter())
            .map(|found| found.map_or(f64::NAN, |found| found.deviation))
            .collect();
        let of_u = |(point, found): (&SurfacePoint, &Option<PointDeviation>)| {
            let made_by = found.as_ref()?.made_by;
            (self.variance)(made_by, &*normal(point)?).map(f64::sqrt)
        };
        let of_u: Vec<f64> = (mesh.points.iter().zip(&found))
            .map(|of| of_u(of).unwrap_or(f64::NAN))
            .collect();
        let made_by = |vertex: usize| {
            let points = || mesh.points_of(vertex).iter().map(|point| *point as usize);
            let of_part = points().find_map(|point| found[point]?.made_by.move_index());
            let of_nominal = || points().find_map(|point| mesh.points[point].origin.move_index());
            of_part.or_else(of_nominal).map(|index| index as u32)
        };
        let values = |of_points: &[f64]| {
            let values = mesh.vertex_values(of_points).into_iter();
            values.map(|value| value.unwrap_or(f64::NAN)).collect()
        };
        Ok(PartMesh {
            deviations: values(&of_points),
            uncertainties: values(&of_u),
            made_by: (0..mesh.vertices.len()).map(made_by).collect(),
            vertices: mesh.vertices,
            normals: mesh.normals,
            triangles: mesh.triangles,
        })
    }
}

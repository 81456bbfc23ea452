//! VTK poly data, in mm, as [`vtk`](crate::table::vtk) writes it: the normals are the vectors `normal`, columns the scalars of their names, with
//! NaN and a mask where there is no value. Colours are left out: ParaView colours by a column.

use super::surface_table::{SurfaceError, SurfaceTable};
use crate::table::vtk::{PointArray, PointValues, PolyData, write_poly_data};

/// The surface as a VTP file.
pub(super) fn write(surface: &SurfaceTable) -> Result<Vec<u8>, SurfaceError> {
    let of_column = |values: &[f64]| {
        let known = |value: &f64| (!value.is_nan()).then_some(*value);
        PointValues::Scalar(values.iter().map(known).collect())
    };
    let columns = surface.columns.iter().map(|column| PointArray {
        name: column.name.clone(),
        values: of_column(&column.values),
    });
    let normals = PointArray {
        name: "normal".to_owned(),
        values: PointValues::Vector(surface.normals.iter().copied().map(Some).collect()),
    };
    let arrays = columns.chain(std::iter::once(normals)).collect();
    let triangles = surface
        .triangles
        .iter()
        .map(|corners| corners.map(|corner| corner as usize));
    let data = PolyData::triangles(surface.vertices_mm.clone(), triangles.collect(), arrays)?;
    Ok(write_poly_data(&data))
}

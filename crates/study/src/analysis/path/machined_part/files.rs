//! The surface of the part as files: PLY, VTK and glTF with its deviation and colours.

use armill_core::units::{to_mm, to_um};
use armill_formats::surface::{SurfaceColumn, SurfaceFormat, SurfaceTable};
use armill_formats::table::csv;
use armill_report::{ColourScale, PartView};

use super::mesh::PartMesh;
use super::run::MachinedPart;
use super::scan::ScanComparison;
use crate::analysis::path::to_measure::{NominalPath, measured};
use crate::error::StudyError;

/// Endings of the files, after the name of the path.
pub const EXTENSIONS: [(&str, SurfaceFormat); 3] = [
    ("part.ply", SurfaceFormat::Ply),
    ("part.vtp", SurfaceFormat::Vtp),
    ("part.glb", SurfaceFormat::Glb),
];

/// That of the table of measured points, if there is a scan.
pub const SCAN_EXTENSION: &str = "scan-points.csv";

/// What has no value.
const NO_VALUE: [u8; 3] = [205, 205, 205];

/// The surface with its deviations, to be written in any format.
pub fn table(title: &str, mesh: &PartMesh, scan: Option<&ScanComparison>) -> SurfaceTable {
    let um = |values: &[f64]| values.iter().map(|m| to_um(*m)).collect::<Vec<f64>>();
    let deviations = um(&mesh.deviations);
    let most = PartView::colour_limit(&deviations).unwrap_or(1.0);
    let colour = |um: &f64| match um.is_finite() {
        true => ColourScale::BlueRed.rgb(0.5 + 0.5 * um / most),
        false => NO_VALUE,
    };
    let column = |name: &str, values: Vec<f64>| SurfaceColumn {
        name: name.to_owned(),
        unit: Some("um".to_owned()),
        values,
    };
    let colours = deviations.iter().map(colour).collect();
    let mut columns = vec![
        column("deviation_um", deviations),
        column("u_um", um(&mesh.uncertainties)),
    ];
    if let Some(scan) = scan {
        let at = |value: &dyn Fn(usize) -> f64| um(&scan.at_vertices(mesh.vertices.len(), value));
        columns.push(column("measured_um", at(&|point| scan.measured[point])));
        let difference = at(&|point| scan.measured[point] - scan.predicted[point]);
        columns.push(column("measured_less_predicted_um", difference));
    }
    SurfaceTable {
        title: title.to_owned(),
        vertices_mm: mesh
            .vertices
            .iter()
            .map(|at| at.coords.map(to_mm).into())
            .collect(),
        normals: mesh.normals.iter().map(|normal| (*normal).into()).collect(),
        triangles: mesh.triangles.clone(),
        colours: Some(colours),
        columns,
    }
}

/// Passes each file to `save`, its ending and bytes; `path`: with the nominal points.
///
/// # Errors
/// That of `save`; a surface that cannot be written, which would be a fault of armill.
pub fn files(
    title: &str,
    part: &MachinedPart,
    path: &NominalPath<'_>,
    save: impl Fn(&str, &[u8]) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    let scan = part.scan.as_ref().map(|scan| &scan.comparison);
    let table = table(title, &part.mesh, scan);
    EXTENSIONS.iter().try_for_each(|(extension, format)| {
        let bytes = format.write(&table);
        let bytes = bytes.map_err(|error| StudyError::value(format!("{title}: {error}"), "report this"))?;
        save(extension, &bytes)
    })?;
    match &part.scan {
        Some(scan) => save(SCAN_EXTENSION, &csv::write(&measured(title, path, &scan.tips)?)),
        None => Ok(()),
    }
}

//! Pictures of the part in the colours of its deviation: predicted, and where it was measured.

use armill_core::units::{to_mm, to_um};
use armill_report::{PartView, PlaceMark};

use super::answer::MachinedPartAnswer;
use super::mesh::PartMesh;
use super::scan::ScanComparison;
use crate::analysis::path::answer::PathAnswer;
use crate::analysis::path::run::PathResult;
use crate::analysis::picture::Picture;
use crate::file_names::slug;

/// The part with its worst places, and the measured part with the prediction there; none if the study does not ask for it.
pub fn pictures(given: &PathAnswer, found: &PathResult) -> Vec<Picture> {
    let (Some(part), Some(answer)) = (&found.machined_part, &given.machined_part) else {
        return Vec::new();
    };
    let mut pictures = vec![Picture {
        name: format!("{}-part", slug(&given.name)),
        caption: format!(
            "{}: the part in the colours of the deviation of its surface, normal to the nominal one. Coordinates of the program; numbers: the \
             worst places of the table.",
            given.name
        ),
        svg: predicted(&part.mesh, given, answer).to_svg(),
    }];
    if let Some(scan) = &part.scan {
        pictures.extend(measured(&part.mesh, given, answer, &scan.comparison));
    }
    pictures
}

/// The part without values.
fn view(mesh: &PartMesh, given: &PathAnswer) -> PartView {
    PartView {
        quantity: "deviation (µm): + material left, − gouged".to_owned(),
        tolerance_um: Some(given.setting.tolerance_um),
        vertices_mm: mesh
            .vertices
            .iter()
            .map(|at| at.coords.map(to_mm).into())
            .collect(),
        normals: mesh.normals.iter().map(|normal| (*normal).into()).collect(),
        triangles: mesh.triangles.clone(),
        ..PartView::default()
    }
}

fn predicted(mesh: &PartMesh, given: &PathAnswer, answer: &MachinedPartAnswer) -> PartView {
    let nominal = match answer.nominal {
        "part" => "relative to the mesh of the part",
        _ => "relative to the part as programmed",
    };
    let marks = answer.worst_places.iter().enumerate();
    PartView {
        title: format!("{}: deviation of the surface of the part", given.name),
        subtitle: format!("{nominal}; cells of {} mm", answer.cell_mm),
        values_um: mesh.deviations.iter().map(|m| to_um(*m)).collect(),
        marks: marks
            .map(|(place, worst)| PlaceMark {
                at_mm: worst.xyz_mm,
                label: (place + 1).to_string(),
            })
            .collect(),
        ..view(mesh, given)
    }
}

/// Measured, predicted and their difference in the same colours.
fn measured(
    mesh: &PartMesh,
    given: &PathAnswer,
    answer: &MachinedPartAnswer,
    scan: &ScanComparison,
) -> Vec<Picture> {
    let um = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let values = scan.at_vertices(mesh.vertices.len(), value);
        values.into_iter().map(to_um).collect()
    };
    let values = [
        ("measured", um(&|point| scan.measured[point])),
        ("predicted", um(&|point| scan.predicted[point])),
        (
            "difference",
            um(&|point| scan.measured[point] - scan.predicted[point]),
        ),
    ];
    let limits = values[..2]
        .iter()
        .filter_map(|(_, values)| PartView::colour_limit(values));
    let range_um = limits.reduce(f64::max);
    let (file, align) = answer
        .scan
        .as_ref()
        .map_or(("", "none"), |scan| (scan.file.as_str(), scan.align));
    let picture = |(what, values_um): (&str, Vec<f64>)| Picture {
        name: format!("{}-scan-{what}", slug(&given.name)),
        caption: format!(
            "{}: the part where it was measured: {}. Measured, predicted and difference have the same colours and the same alignment.",
            given.name,
            match what {
                "difference" => "measured less predicted deviation",
                "predicted" => "predicted deviation",
                _ => "measured deviation",
            }
        ),
        svg: PartView {
            title: format!("{}: {what}", given.name),
            subtitle: format!("{file}; alignment: {}", align.replace('_', " ")),
            values_um,
            range_um,
            ..view(mesh, given)
        }
        .to_svg(),
    };
    values.into_iter().map(picture).collect()
}

//! The picture of the part in the colours of its deviation.

use armill_core::units::{to_mm, to_um};
use armill_report::{PartView, PlaceMark};

use super::answer::MachinedPartAnswer;
use super::mesh::PartMesh;
use crate::analysis::path::answer::PathAnswer;
use crate::analysis::path::run::PathResult;
use crate::analysis::picture::Picture;

/// The part with its worst places; none if the study does not ask for it.
pub fn picture(given: &PathAnswer, found: &PathResult) -> Option<Picture> {
    let (part, answer) = (found.machined_part.as_deref()?, given.machined_part.as_ref()?);
    Some(Picture {
        name: format!("{}-part", crate::file_names::slug(&given.name)),
        caption: format!(
            "{}: the part in the colours of the deviation of its surface, normal to the nominal one. Coordinates of the program; numbers: the \
             worst places of the table.",
            given.name
        ),
        svg: view(&part.mesh, given, answer).to_svg(),
    })
}

fn view(mesh: &PartMesh, given: &PathAnswer, answer: &MachinedPartAnswer) -> PartView {
    let nominal = match answer.nominal {
        "part" => "relative to the mesh of the part",
        _ => "relative to the part as programmed",
    };
    let marks = answer.worst_places.iter().enumerate();
    PartView {
        title: format!("{}: deviation of the surface of the part", given.name),
        subtitle: format!("{nominal}; cells of {} mm", answer.cell_mm),
        quantity: "deviation (µm): + material left, − gouged".to_owned(),
        tolerance_um: Some(given.setting.tolerance_um),
        vertices_mm: mesh
            .vertices
            .iter()
            .map(|at| at.coords.map(to_mm).into())
            .collect(),
        normals: mesh.normals.iter().map(|normal| (*normal).into()).collect(),
        values_um: mesh.deviations.iter().map(|m| to_um(*m)).collect(),
        triangles: mesh.triangles.clone(),
        marks: marks
            .map(|(place, worst)| PlaceMark {
                at_mm: worst.xyz_mm,
                label: (place + 1).to_string(),
            })
            .collect(),
    }
}

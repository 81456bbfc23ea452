//! What a part is cut from.

use std::path::Path;

use armill_core::clearance::Shape;

use super::setting::PartStock;
use super::table::MachinedPartTable;
use crate::StudyError;
use crate::analysis::path::PathAnalysis;
use crate::input::cell::shape::shape_of;
use crate::input::problem_log::ProblemLog;

const KEY: &str = "machined_part.stock";
const HINT: &str = "stock = { box_mm = { from = [-50, -50, -20], to = [50, 50, 0] } }: two corners in the frame of the program";

/// The stock of `machined_part`, else that of the cut; `None` if it has problems.
///
/// # Errors
/// The problems of a mesh file.
pub(super) fn resolve(
    log: &mut ProblemLog<'_>,
    table: &MachinedPartTable,
    folder: &Path,
    analysis: &PathAnalysis,
) -> Result<Option<PartStock>, StudyError> {
    let Some(given) = &table.stock else {
        let of_cut = analysis.cut_in_stock();
        if of_cut.is_none() {
            log.problem(
                "machined_part",
                "a machined part needs its stock: neither `machined_part` nor the cut has one",
                HINT,
            );
        }
        return Ok(of_cut.map(|(_, stock)| PartStock::Box(stock.corners())));
    };
    let Some(found) = shape_of(log, KEY, given.shape(), folder)? else {
        return Ok(None);
    };
    Ok(match found.shape {
        Shape::Box(bounds) => Some(PartStock::Box([bounds.least, bounds.greatest])),
        Shape::Cylinder(axis, radius) => {
            let along = axis.to - axis.from;
            if along.xy().norm() > 1e-9 * along.norm() {
                let message = "a cylinder of stock has its axis along z of the program";
                log.problem(
                    KEY,
                    message,
                    "both ends with the same x and y; any other solid as a mesh",
                );
                return Ok(None);
            }
            let base = if along.z > 0.0 { axis.from } else { axis.to };
            Some(PartStock::Cylinder(base, radius, along.z.abs()))
        }
        Shape::Mesh(mesh) => Some(PartStock::Mesh(mesh.triangles().to_vec())),
        Shape::Capsule(_) => None,
    })
}

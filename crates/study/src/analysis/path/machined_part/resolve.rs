//! `machined_part`, checked and in SI.

use armill_core::clearance::{Shape, Triangle};
use armill_core::frame::Isometry;
use armill_core::machined::PathTool;
use armill_core::path::Track;
use armill_core::removal::{DexelDirections, DexelPart, PartSize, RemovalError};
use armill_core::units::{from_mm, to_mm};

use super::scan;
use super::setting::{MachinedSetting, NominalPart, WallSetting};
use super::stock;
use super::table::{DexelsName, MachinedPartTable, NominalName};
use super::tools;
use crate::StudyError;
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::feature::FeatureName;
use crate::analysis::resolve::Resolver;
use crate::input::memory::{GIB, MOST_BYTES};
use crate::input::problem_log::ProblemLog;
use crate::number::decimals;

/// Cells across the smallest cutter where no cell is given.
const CELLS_ACROSS: f64 = 40.0;
/// Most dexels of a part whose cell is not given: some seconds for a program of 10^5 moves.
const MOST_DEXELS: f64 = 3e6;
impl Resolver<'_> {
    /// The part that comes out of this path; `None` if it has problems.
    ///
    /// # Errors
    /// The problems of a mesh file.
    pub(crate) fn machined_part(
        &self,
        log: &mut ProblemLog<'_>,
        table: &MachinedPartTable,
        analysis: &PathAnalysis,
    ) -> Result<Option<MachinedSetting>, StudyError> {
        let stock = stock::resolve(log, table, self.folder, analysis)?;
        let nominal = self.nominal_part(log, table, analysis);
        let Some(stock) = stock else { return Ok(None) };
        let refused = |log: &mut ProblemLog<'_>, error: &RemovalError| {
            let hint =
                "cell_mm = 0.5; a box, a cylinder or a closed mesh of stock in the frame of the program";
            log.problem("machined_part", error.to_string(), hint);
        };
        let corners = match stock.solid().corners() {
            Ok(corners) => corners,
            Err(error) => {
                refused(log, &error);
                return Ok(None);
            }
        };
        let tools = tools::resolve(log, table.tool.as_ref(), analysis, corners);
        let (Some(nominal), Some(tools)) = (nominal, tools) else {
            return Ok(None);
        };
        let directions = match table.dexels {
            Some(DexelsName::Z) => DexelDirections::Z,
            Some(DexelsName::All) | None => DexelDirections::All,
        };
        let scan = match &table.scan {
            Some(table) => {
                let of_part = self.path_from_part_mesh(analysis);
                if self.bodies_have_problems && table.frame == Some(NominalName::Part) {
                    return Ok(None);
                }
                let Some(scan) = scan::resolve(log, table, self.folder, (&nominal, of_part))? else {
                    return Ok(None);
                };
                Some(scan)
            }
            None => None,
        };
        let walls = walls(log, table, analysis);
        let (cell, notes) = cell(table, &tools, |cell| DexelPart::size(corners, cell, directions));
        let size = match DexelPart::size(corners, cell, directions) {
            Ok(size) => size,
            Err(error) => {
                refused(log, &error);
                return Ok(None);
            }
        };
        let found = MachinedSetting {
            stock,
            cell,
            directions,
            size,
            nominal,
            tools,
            walls,
            scan,
            notes,
        };
        let bytes = found.bytes();
        if bytes > MOST_BYTES {
            let (gib, most) = (bytes / GIB, MOST_BYTES / GIB);
            let message = format!(
                "{:.2e} dexels would take {gib:.1} GiB of memory, more than {most:.0} GiB",
                size.dexels
            );
            log.problem("machined_part", message, "use a larger cell_mm");
            return Ok(None);
        }
        Ok(Some(found))
    }

    /// The nominal part; `None` if it has problems.
    fn nominal_part(
        &self,
        log: &mut ProblemLog<'_>,
        table: &MachinedPartTable,
        analysis: &PathAnalysis,
    ) -> Option<NominalPart> {
        if table.nominal != Some(NominalName::Part) {
            return Some(NominalPart::Program);
        }
        let part = self.bodies.and_then(|bodies| bodies.part.as_ref());
        let mesh = part.and_then(|part| match &part.shape {
            Shape::Mesh(mesh) => Some((mesh, part.frame_from_body)),
            _ => None,
        });
        let Some((mesh, part_from_body)) = mesh else {
            if self.bodies_have_problems {
                return None;
            }
            let hint = "[part] mesh = \"part.stl\": the finished part";
            log.problem(
                "machined_part.nominal",
                "the study has no [part] with a mesh",
                hint,
            );
            return None;
        };
        if !mesh.is_closed() {
            let message = "the mesh of [part] is open: it encloses no material";
            log.problem("machined_part.nominal", message, "close its holes");
            return None;
        }
        let path_from_body = path_from_part(analysis) * part_from_body;
        Some(NominalPart::Mesh(placed(mesh.triangles(), &path_from_body)))
    }

    /// From the frame of the mesh of `[part]`, if there is one.
    fn path_from_part_mesh(&self, analysis: &PathAnalysis) -> Option<Isometry> {
        let part = self.bodies?.part.as_ref()?;
        let is_mesh = matches!(part.shape, Shape::Mesh(_));
        is_mesh.then(|| path_from_part(analysis) * part.frame_from_body)
    }
}

/// The walls of the table, without those that have problems.
fn walls(log: &mut ProblemLog<'_>, table: &MachinedPartTable, analysis: &PathAnalysis) -> Vec<WallSetting> {
    let mut walls = Vec::new();
    for (index, wall) in table.walls.iter().enumerate() {
        let key = format!("machined_part.walls[{index}].between");
        let names = || {
            analysis
                .features
                .iter()
                .map(|feature| format!("`{}`", feature.name))
        };
        let unknown = wall.between.iter().find(|name| {
            !analysis.features.iter().any(|feature| {
                feature.name == **name && matches!(feature.kind, FeatureName::Line | FeatureName::Plane)
            })
        });
        if let Some(name) = unknown {
            let message = format!("`{name}` is not a line or plane of `program.feature`");
            let hint = match analysis.features.is_empty() {
                true => "program = { .., feature = [{ name = \"left side\", kind = \"line\", lines = [40, 42] }] }".to_owned(),
                false => format!("its features are {}", names().collect::<Vec<_>>().join(", ")),
            };
            log.problem(&key, message, &hint);
            continue;
        }
        if wall.between[0] == wall.between[1] {
            log.problem(
                &key,
                "both faces are the same feature",
                "two features, one for each face",
            );
            continue;
        }
        walls.push(WallSetting {
            name: wall.name.clone(),
            between: wall.between.clone(),
        });
    }
    walls
}

fn path_from_part(analysis: &PathAnalysis) -> Isometry {
    let Track {
        placing,
        base_from_part,
        ..
    } = &analysis.track;
    placing.base_from_path.inverse() * base_from_part
}

/// Triangles in another frame.
fn placed(triangles: &[Triangle], to_from: &Isometry) -> Vec<Triangle> {
    let moved = |triangle: &Triangle| Triangle(triangle.0.map(|corner| to_from * corner));
    triangles.iter().map(moved).collect()
}

/// The cell that is given, else one that fits the cutters; and a note where that had to be larger.
fn cell(
    table: &MachinedPartTable,
    tools: &[PathTool],
    size: impl Fn(f64) -> Result<PartSize, RemovalError>,
) -> (f64, Vec<String>) {
    if let Some(given) = table.cell_mm {
        return (from_mm(given), Vec::new());
    }
    let radii = tools.iter().map(|tool| tool.cutting.radius());
    let wanted = 2.0 * radii.fold(f64::INFINITY, f64::min) / CELLS_ACROSS;
    let dexels = size(wanted).map_or(0.0, |size| size.dexels);
    if dexels <= MOST_DEXELS {
        return (wanted, Vec::new());
    }
    let cell = from_mm(decimals(to_mm(wanted * (dexels / MOST_DEXELS).sqrt()), 3));
    let note = format!(
        "cells of {} mm in place of {} mm (a fortieth of the smallest cutter) keep the part below {MOST_DEXELS:.0e} dexels; \
         `cell_mm` replaces them",
        decimals(to_mm(cell), 3),
        decimals(to_mm(wanted), 3)
    );
    (cell, vec![note])
}

//! The tools that cut a part: those of the cut, of the drill, or of `machined_part.tool`.

use armill_core::load::{CuttingError, EndMillBody};
use armill_core::machined::PathTool;
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::Track;
use armill_core::removal::ToolSolid;
use armill_core::units::{from_deg, from_mm};

use super::table::PartToolTable;
use crate::analysis::path::PathAnalysis;
use crate::input::problem_log::ProblemLog;

const KEY: &str = "machined_part.tool";
const HINT: &str = "tool = { diameter_mm = 10, corner_radius_mm = 5 }, or a [cut] with its cutter";

/// A tool without flutes of its own height is so much longer than what is in the stock at the points of the path.
const LONGER: f64 = 1.2;

/// The tools of a path through a stock between these corners (m); `None` if they have problems.
pub(super) fn resolve(
    log: &mut ProblemLog<'_>,
    table: Option<&PartToolTable>,
    analysis: &PathAnalysis,
    corners: [Point3<f64>; 2],
) -> Option<Vec<PathTool>> {
    let bodies = bodies(log, table, analysis)?;
    let point = point_angle(table, analysis);
    let radius = bodies.iter().map(|(_, body)| body.radius()).fold(0.0, f64::max);
    let height = LONGER * height_in_stock(&analysis.track, corners, radius) + 4.0 * radius;
    let tools = bodies.into_iter().map(|(first, body)| {
        let (cutting, clear) = solids(table, &body, point, height)?;
        Ok(PathTool {
            first,
            cutting,
            clear,
        })
    });
    let tools: Result<Vec<PathTool>, CuttingError> = tools.collect();
    tools
        .map_err(|error| log.problem(KEY, error.to_string(), HINT))
        .ok()
}

/// Largest height above the tip at which a tool of this radius is in the stock, at the points of the path and at the ends of its rapids, m. A longer tool cuts the same part, but where its axis turns it takes
/// more pieces.
fn height_in_stock(track: &Track, corners: [Point3<f64>; 2], radius: f64) -> f64 {
    let (placing, path) = (&track.placing, &track.path);
    let points = path
        .points
        .iter()
        .map(|point| (point.at, placing.path_spindle(point)));
    let begins = (0..path.points.len()).filter(|index| path.begins(*index));
    let rapids = begins.zip(&path.rapids).flat_map(|(index, rapids)| {
        let axis = placing.path_spindle(&path.points[index]);
        let moves = rapids.moves.iter();
        moves.map(move |rapid| {
            (
                rapid.end,
                rapid.axis.filter(|_| !placing.keeps_axis).unwrap_or(axis),
            )
        })
    });
    let leaves_at = |(tip, axis): (Point3<f64>, Unit<Vector3<f64>>)| {
        let along = |k: usize| {
            let wall = match axis[k] > 0.0 {
                true => corners[1][k] + radius,
                false => corners[0][k] - radius,
            };
            let height = (wall - tip[k]) / axis[k];
            if axis[k] == 0.0 { f64::INFINITY } else { height }
        };
        along(0).min(along(1)).min(along(2))
    };
    points.chain(rapids).map(leaves_at).fold(0.0, f64::max)
}

/// The end mills, or the bodies of drills, each with its first point.
fn bodies(
    log: &mut ProblemLog<'_>,
    table: Option<&PartToolTable>,
    analysis: &PathAnalysis,
) -> Option<Vec<(usize, EndMillBody)>> {
    let path = &analysis.track.path;
    if let (Some(cut), None) = (&analysis.cut, table.and_then(|table| table.diameter_mm)) {
        let found = cut.cutting.bodies_along(path);
        let found = found.map_err(|error| log.problem(KEY, error.to_string(), HINT));
        return found.ok();
    }
    let of_drill = analysis.drill.as_ref().map(|drill| drill.drill.diameter);
    let given = table.and_then(|table| table.diameter_mm).map(from_mm);
    let Some(diameter) = given.or(of_drill) else {
        let message =
            "the shape of the tool is not known: the load of this path is not that of a cut or drill";
        log.problem("machined_part", message, HINT);
        return None;
    };
    let corner = table
        .and_then(|table| table.corner_radius_mm)
        .map_or(0.0, from_mm);
    let mut bodies = vec![(0, EndMillBody::new(diameter, corner))];
    for (first, operation) in &path.operations {
        let Some(diameter) = operation.diameter.filter(|diameter| *diameter > 0.0) else {
            continue;
        };
        let corner = operation.corner_radius.unwrap_or(corner).min(0.5 * diameter);
        bodies.push((*first, EndMillBody::new(diameter, corner)));
    }
    let mut all = Vec::new();
    for (first, body) in bodies {
        all.push((
            first,
            body.map_err(|error| log.problem(KEY, error.to_string(), HINT))
                .ok()?,
        ));
    }
    Some(all)
}

/// Full angle of the point of a drill, rad.
fn point_angle(table: Option<&PartToolTable>, analysis: &PathAnalysis) -> Option<f64> {
    let given = table.and_then(|table| table.point_deg).map(from_deg);
    given.or(analysis.drill.as_ref().map(|drill| drill.drill.point_angle))
}

/// What cuts, and the shank above it.
fn solids(
    table: Option<&PartToolTable>,
    body: &EndMillBody,
    point: Option<f64>,
    height: f64,
) -> Result<(ToolSolid, Vec<ToolSolid>), CuttingError> {
    let of = |key: fn(&PartToolTable) -> Option<f64>| table.and_then(key);
    let flutes = of(|table| table.flute_length_mm).map(from_mm);
    let length = flutes.unwrap_or(height);
    let cutting = match (point, of(|table| table.taper_deg)) {
        (Some(angle), _) => ToolSolid::drill(2.0 * body.radius(), angle, length)?,
        (None, Some(taper)) if taper > 0.0 => ToolSolid::tapered(body, from_deg(taper), length)?,
        _ => ToolSolid::end_mill(body, length)?,
    };
    let shank = of(|table| table.shank_diameter_mm).map(|mm| from_mm(mm) / 2.0);
    let radius = shank.unwrap_or_else(|| cutting.radius());
    let clear = match flutes {
        Some(flutes) if flutes < height => vec![ToolSolid::cone([flutes, height], [radius; 2])?],
        _ => Vec::new(),
    };
    Ok((cutting, clear))
}

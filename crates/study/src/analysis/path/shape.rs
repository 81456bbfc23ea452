//! A shape on the plane as points.
//!
//! Files give points as (y', z') in mm from the centre of the plane; the core uses part axes, `x = -y'`, `y = z'`, in
//! metres. Where `step_mm` is left out a circle has 360 points, any other shape the pitch of the plane.

use armill_core::nalgebra::{Point2, Vector2};
use armill_core::path::{SampledPath, Shape};
use armill_core::units::from_mm;

use crate::analysis::path::program_file::MOST_POINTS;
use crate::analysis::table::AnalysisTable;
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::{self, positive};

/// Default step of a circle: one degree.
const CIRCLE_SAMPLES: f64 = 360.0;

/// How many shapes an analysis has.
pub fn count(table: &AnalysisTable) -> usize {
    let given = [
        table.circle.is_some(),
        table.line.is_some(),
        table.polyline_mm.is_some(),
        table.rectangle.is_some(),
    ];
    given.into_iter().filter(|given| *given).count()
}

/// The shape of an analysis, which has one, cut into points; `None` if it has problems. `step_mm` is the pitch of
/// the plane.
pub fn resolve(
    log: &mut ProblemLog<'_>,
    table: &AnalysisTable,
    step_mm: f64,
) -> Option<(SampledPath, Shape)> {
    if let Some(circle) = &table.circle {
        positive(log, "circle.radius_mm", circle.radius_mm)?;
    }
    let shape = shape(table)?;
    let length = shape.length();
    if length <= 0.0 {
        let hint = "give it at least two different points";
        log.problem_here("the path has length 0 mm", hint);
        return None;
    }
    let (key, step) = match (table.step_mm, &shape) {
        (Some(step), _) => ("step_mm", quantities::step(log, "step_mm", step)?),
        (None, Shape::Circle { .. }) => ("step_mm", length / CIRCLE_SAMPLES),
        (None, Shape::Polyline(_)) => ("plane.step_mm", quantities::step(log, "plane.step_mm", step_mm)?),
    };
    let points = length / step;
    if points > MOST_POINTS as f64 {
        let message = format!("the path would have {points:.0} points, more than {MOST_POINTS}");
        log.problem(key, message, "use a larger step");
        return None;
    }
    Some((shape.sampled(step), shape))
}

/// The shape of the table in part axes; `None` if it has none.
fn shape(table: &AnalysisTable) -> Option<Shape> {
    // The study's y' runs against x of the part.
    let at = |[y, z]: [f64; 2]| Point2::new(from_mm(-y), from_mm(z));
    if let Some(circle) = &table.circle {
        return Some(Shape::Circle {
            centre: at(circle.centre_mm.unwrap_or_default()),
            radius: from_mm(circle.radius_mm),
        });
    }
    if let Some(line) = &table.line {
        return Some(Shape::Polyline(vec![at(line.from_mm), at(line.to_mm)]));
    }
    if let Some(points) = &table.polyline_mm {
        return Some(Shape::Polyline(points.iter().copied().map(at).collect()));
    }
    let rectangle = table.rectangle.as_ref()?;
    let size = from_mm(Vector2::from(rectangle.size_mm));
    Some(Shape::rectangle(
        at(rectangle.centre_mm.unwrap_or_default()),
        size,
    ))
}

//! Columns that only holes have: number and line, the spin that was found, the bend of the wrist, and the deviation in
//! the axes of the hole.

use armill_core::optimize::HolesFound;
use armill_core::robot::Robot;
use armill_core::robot::jacobian::wrist_bend;
use armill_core::units::{to_deg, to_um};

use crate::analysis::breakthrough;
use crate::analysis::holes::HolesAnalysis;
use crate::analysis::holes::answer::error;
use crate::analysis::numbers::Numbers;
use crate::analysis::quantity::{self, Quantity};

/// Number, line, turn and bend, and the deviation in the axes of each hole.
pub fn columns<'a>(robot: &'a Robot, analysis: &'a HolesAnalysis, found: &'a HolesFound) -> Vec<Numbers<'a>> {
    let points = &analysis.path.track.path.points;
    let part = |quantity: &'static Quantity, axis: usize| {
        Numbers::of(quantity, move |_, index, evaluation| {
            to_um(error(analysis, found, index, evaluation)[axis])
        })
    };
    let mut columns = vec![
        Numbers::given(&quantity::HOLE, |index| index as f64 + 1.0),
        Numbers::given(&quantity::LINE, |index| f64::from(points[index].line)),
        Numbers::of(&quantity::TURN, move |_, index, _| to_deg(found.spins[index])),
        Numbers::of(&quantity::WRIST_BEND, move |rows, index, _| {
            let bend = wrist_bend(robot, rows.answers.joints_at(index));
            bend.map_or(f64::NAN, to_deg)
        }),
        part(&quantity::HOLE_X, 0),
        part(&quantity::HOLE_Y, 1),
        part(&quantity::DEPTH, 2),
    ];
    columns.extend(breakthrough::columns(robot, analysis));
    columns
}

//! Columns that only holes have.
//!
//! | column | unit | meaning |
//! |---|---|---|
//! | `hole` | - | number in the order given, from 1 |
//! | `line` | - | line of the file, or number in the list |
//! | `turn_deg` | deg | spin of the tool that was found |
//! | `wrist_bend_deg` | deg | angle between axes 4 and 6 |
//! | `hole_x_um`, `hole_y_um` | um | deviation across the hole, along x of the part projected into its plane and to the left of it |
//! | `depth_um` | um | out of the part: too shallow |

use armill_core::optimize::HolesFound;
use armill_core::robot::jacobian::wrist_bend;

use super::Numbers;
use crate::answer::holes::error;
use crate::file::holes::HolesAnalysis;
use crate::file::resolve::Study;

/// Number, line, turn and bend, and the deviation in the axes of each hole.
pub(super) fn columns<'a>(
    study: &'a Study,
    analysis: &'a HolesAnalysis,
    found: &'a HolesFound,
) -> Vec<Numbers<'a>> {
    let points = &analysis.path.track.path.points;
    let part = |name: &str, description: &'static str, axis: usize| {
        Numbers::um(name.to_owned(), description, move |_, index, evaluation| {
            error(analysis, found, (index, evaluation))[axis] * 1e6
        })
    };
    vec![
        Numbers {
            unit: None,
            decimals: 0,
            ..Numbers::um(
                "hole".to_owned(),
                "number in the order given, from 1",
                |_, index, _| index as f64 + 1.0,
            )
        },
        Numbers {
            unit: None,
            decimals: 0,
            ..Numbers::um(
                "line".to_owned(),
                "line of the file, or number in the list",
                move |_, index, _| f64::from(points[index].line),
            )
        },
        Numbers::deg(
            "turn_deg".to_owned(),
            "spin of the tool about its axis that was found",
            move |_, index, _| found.spins[index].to_degrees(),
        ),
        Numbers::deg(
            "wrist_bend_deg".to_owned(),
            "angle between axes 4 and 6; empty for an arm without named branches",
            move |rows, index, _| {
                let bend = wrist_bend(&study.robot.robot, rows.answers.joints_at(index));
                bend.map_or(f64::NAN, f64::to_degrees)
            },
        ),
        part("hole_x_um", "deviation along x of the hole", 0),
        part("hole_y_um", "deviation along y of the hole", 1),
        part("depth_um", "deviation out of the part: too shallow", 2),
    ]
}

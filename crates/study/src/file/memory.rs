//! What the answers of a study take in memory: known, and refused where it is too much, before anything is allocated.
//!
//! `bytes = sum over asks of points (answers of a point + 256)`, at most 4 GiB for each plane, box or path, and for all
//! together. The answers of a point grow with joints, shares and load cases. Points are counted in floating point: a
//! grid that is too large may overflow an index.

use armill_core::kernel::Answers;
use armill_formats::robot::RobotDescription;

use super::places::Places;
use super::resolve::{Ask, Setting, Subject};

/// Bytes in a GiB.
pub(super) const GIB: f64 = 1024.0 * 1024.0 * 1024.0;
/// Most memory that the answers of a study may take: what a laptop can spare.
pub(super) const MOST_BYTES: f64 = 4.0 * GIB;
/// What tables and pictures take beside the answers, bytes a point.
pub(super) const BYTES_BESIDE: usize = 256;

/// What to do where one ask is too large.
const HINT: &str = "a larger step, or a smaller plane";

/// Whether `points` of this setting under so many load cases fit; a problem at `path` if not.
pub(super) fn check_points(
    places: &mut Places<'_>,
    path: &str,
    points: f64,
    (robot, setting, cases): (&RobotDescription, &Setting, usize),
) -> Option<()> {
    let bytes = points * bytes_per_point(robot, setting, cases);
    if bytes <= MOST_BYTES {
        return Some(());
    }
    let (gib, most) = (bytes / GIB, MOST_BYTES / GIB);
    let message = format!("{points:.0} points would take {gib:.1} GiB of memory, more than {most:.0} GiB");
    places.problem(path, message, HINT);
    None
}

/// A problem if all asks do not fit together: their answers are held at once.
pub(super) fn check_asks(places: &mut Places<'_>, robot: &RobotDescription, asks: &[Ask]) {
    let of = |setting: &Setting, points: f64| points * bytes_per_point(robot, setting, setting.cases.len());
    let of_ask = |ask: &Ask| match &ask.subject {
        Subject::Map(sheet) => of(&sheet.setting, sheet.grid.len() as f64),
        Subject::Sections(all) => all
            .iter()
            .map(|(_, sheet)| of(&sheet.setting, sheet.grid.len() as f64))
            .sum(),
        Subject::Volume(setting, grid) => of(setting, grid.len() as f64),
        Subject::Holes(holes) => {
            let (path, cases) = (&holes.path, holes.path.load.case_count());
            path.track.len() as f64 * bytes_per_point(robot, &path.setting, cases)
        }
        Subject::Path(path) => {
            let cases = path.load.case_count();
            path.track.len() as f64 * bytes_per_point(robot, &path.setting, cases)
        }
    };
    let bytes: f64 = asks.iter().map(of_ask).sum();
    if bytes > MOST_BYTES {
        let (gib, most) = (bytes / GIB, MOST_BYTES / GIB);
        let message = format!("all asks together would take {gib:.1} GiB of memory, more than {most:.0} GiB");
        places.problem("ask", message, "larger steps, smaller planes, or several studies");
    }
}

/// What one point takes: its answers in the core, and tables and pictures beside them.
fn bytes_per_point(robot: &RobotDescription, setting: &Setting, cases: usize) -> f64 {
    let joints = robot.robot.joints().len();
    let shares = setting.model.sharers(joints).len();
    (Answers::bytes_per_point(joints, shares, cases) + BYTES_BESIDE) as f64
}

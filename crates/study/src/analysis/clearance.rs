//! The clearance of the points of an analysis: the least one, and what is in the way.

use std::fmt;

use armill_core::clearance::Cell;
use armill_core::kernel::Answers;
use armill_core::robot::Unreachable;
use armill_core::units::to_mm;

use crate::input::cell::AnalysisCell;
use crate::input::setting::Setting;
use crate::number::without_rounding;

/// The least clearance of some points.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastClearance {
    /// Index of the point.
    pub index: usize,
    /// The least distance of two bodies there; 0 where they touch.
    pub distance_mm: f64,
    /// The two bodies.
    pub bodies: [String; 2],
}

/// The clearance at a point, mm: where no posture keeps the demanded one, that of the best posture. `None` without bodies, and
/// where the point is out of reach.
pub fn clearance_mm(setting: &Setting, answers: &Answers, index: usize) -> Option<f64> {
    at(setting.cell.as_ref()?, answers, index).map(|(distance, _)| distance)
}

/// The two bodies at a point between which the clearance is.
#[derive(Clone, Copy, Debug)]
pub struct NearestBodies<'a> {
    cell: &'a Cell,
    bodies: [usize; 2],
}

impl PartialEq for NearestBodies<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.bodies == other.bodies
    }
}

impl fmt::Display for NearestBodies<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, second] = self.bodies.map(|body| self.cell.name(body));
        write!(f, "{first} and {second}")
    }
}

/// The bodies of [`clearance_mm`].
pub fn nearest_bodies<'a>(
    setting: &'a Setting,
    answers: &Answers,
    index: usize,
) -> Option<NearestBodies<'a>> {
    let placed = setting.cell.as_ref()?;
    let (_, bodies) = at(placed, answers, index)?;
    Some(NearestBodies {
        cell: &placed.cell,
        bodies,
    })
}

/// Distance (mm) and bodies at a point.
fn at(placed: &AnalysisCell, answers: &Answers, index: usize) -> Option<(f64, [usize; 2])> {
    let (distance, bodies) = match answers.points[index] {
        Err(Unreachable::InCollision { missing, bodies }) => (placed.least - missing, bodies),
        Err(_) => return None,
        Ok(_) => {
            let found = answers.clearances.get(index).copied().flatten()?;
            (found.nearest.distance, found.bodies)
        }
    };
    Some((without_rounding(to_mm(distance)), bodies))
}

impl LeastClearance {
    /// The least of all points; `None` without bodies.
    pub fn of(setting: &Setting, answers: &Answers) -> Option<LeastClearance> {
        let placed = setting.cell.as_ref()?;
        let all = (0..answers.points.len()).filter_map(|index| Some((index, at(placed, answers, index)?)));
        let (index, (distance_mm, bodies)) = all.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0))?;
        Some(LeastClearance {
            index,
            distance_mm,
            bodies: bodies.map(|body| placed.cell.name(body).to_owned()),
        })
    }

    /// What is nearest, in words: `spindle and fence: 3.2 mm`.
    pub fn in_words(&self) -> String {
        let [first, second] = &self.bodies;
        match self.distance_mm > 0.0 {
            true => format!("{first} and {second} are {:.1} mm apart", self.distance_mm),
            false => format!("{first} and {second} touch"),
        }
    }
}

/// Points where no posture keeps the demanded clearance.
pub fn in_collision(answers: &Answers) -> usize {
    let is = |point: &&Result<_, Unreachable>| matches!(point, Err(Unreachable::InCollision { .. }));
    answers.points.iter().filter(is).count()
}

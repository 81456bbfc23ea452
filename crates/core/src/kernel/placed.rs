//! A path on a part, judged where the part lies: what a search for a placement asks ten thousand times.
//!
//! The points, the directions that count and the wrenches are told on the part once; a place ([`PartPlacement`]) then tells where the
//! part lies and how far the tool is turned. Each of the arm's postures is judged over all points ([`Judged`]).
//!
//! Ortho-parallel arms that yield at their drives alone go through lanes; any other arm takes one pose after the other. Both
//! tell the same to rounding (`tests`).

use nalgebra::{UnitQuaternion, Vector3};

use super::column::{Column, Columns, Push, SLOTS, Stand};
use super::lanes::{Laid, Placer, Precision, Tallied};
use super::question::Question;
use crate::frame::Isometry;
use crate::robot::{Branch, BranchPattern};
use crate::source::Arm;
use crate::spatial::Wrench;

/// A point of a path as it is on the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighted {
    /// The tool there, with its turn before any other.
    pub part_from_tool: Isometry,
    /// Directions that its deviation counts along, part axes; of length 1, or 0 where one is enough.
    pub along: [Vector3<f64>; 2],
}

/// The axes that wrenches are told in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToldIn {
    /// Those of the robot's base: they stay where they are wherever the part lies.
    Base,
    /// Those of the part: they lie as it does.
    Part,
}

/// Wrenches on the tool at the TCP.
#[derive(Clone, Debug, PartialEq)]
pub struct Pushes {
    /// Their axes.
    pub told_in: ToldIn,
    /// How many at each point.
    pub cases: usize,
    /// So many for all points, or so many for each, point after point.
    pub wrenches: Vec<Wrench>,
}

/// Where a part lies, and how far the tool is turned about its axis beside the turn it has there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartPlacement {
    /// The part in base.
    pub base_from_part: Isometry,
    /// Turn of the tool, rad.
    pub spin: f64,
    /// Where the rail under the arm stands, m: its first joint that slides; `None` where the question says. Of arms that
    /// lanes answer for, which have none, it is not looked at.
    pub rail: Option<f64>,
}

/// How far postures keep from where they may not stand, and what deviation is tolerated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keeping {
    /// Least distance of every joint that turns from its limits, of the elbow from stretched or folded, of the wrist from
    /// straight, rad.
    pub margin: f64,
    /// Least bend of the wrist, rad.
    pub wrist: f64,
    /// Deviations above it are summed, m.
    pub limit: f64,
}

/// What one posture makes of all points.
///
/// Where points are lost, lanes count the deviations of those that are only outside joint limits, and one pose after the
/// other does not: compare such places by the points lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged {
    /// Points where it does not stand.
    pub lost: usize,
    /// Largest deviation that counts where it stands, m.
    pub worst: f64,
    /// Sum of the deviations there, m.
    pub sum: f64,
    /// Sum of what is above the limit, m.
    pub above: f64,
}

/// A path on a part.
#[derive(Debug)]
pub struct PlacedPath {
    points: Vec<Sighted>,
    pushes: Pushes,
    laid: Laid<f64>,
    /// The same in single precision.
    single: Laid<f32>,
}

impl PlacedPath {
    /// These points under these wrenches.
    ///
    /// # Panics
    /// If the wrenches are neither those of all points nor those of each, or there is none.
    pub fn new(points: Vec<Sighted>, pushes: Pushes) -> PlacedPath {
        let given = pushes.wrenches.len();
        assert!(
            pushes.cases > 0 && (given == pushes.cases || given == pushes.cases * points.len()),
            "wrenches of all points or of each"
        );
        PlacedPath {
            laid: Laid::new(&points, &pushes),
            single: Laid::new(&points, &pushes),
            points,
            pushes,
        }
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Every number of points and wrenches, in order: what tells one path from another.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let of_point = |point: &Sighted| {
            let pose = point.part_from_tool;
            let (at, turn) = (pose.translation.vector, pose.rotation.coords);
            let [a, b] = point.along;
            [
                at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w, a.x, a.y, a.z, b.x, b.y, b.z,
            ]
        };
        let of_wrench = |w: &Wrench| {
            [
                w.force.x, w.force.y, w.force.z, w.moment.x, w.moment.y, w.moment.z,
            ]
        };
        let wrenches = self.pushes.wrenches.iter().flat_map(of_wrench);
        self.points.iter().flat_map(of_point).chain(wrenches)
    }

    /// Load cases a point.
    pub fn case_count(&self) -> usize {
        self.pushes.cases
    }

    /// The wrenches at point `index`, told axes.
    fn wrenches(&self, index: usize) -> &[Wrench] {
        let Pushes { cases, wrenches, .. } = &self.pushes;
        let first = if wrenches.len() == *cases {
            0
        } else {
            index * cases
        };
        &wrenches[first..][..*cases]
    }
}

/// Judges places; one a thread.
pub struct Judge<'q> {
    keeping: Keeping,
    way: Way<'q>,
}

/// By lanes or one after the other.
enum Way<'q> {
    Lanes(Box<Placer<f64>>),
    General(Box<Columns<'q>>),
}

impl<'q> Judge<'q> {
    /// For this arm. `home`: see [`Question::home`].
    pub fn new(arm: Arm<'q>, home: Option<&'q [f64]>, keeping: Keeping) -> Judge<'q> {
        let question = Question::unloaded(arm, home);
        let lanes = arm.robot.ortho_parallel().filter(|_| arm.model.is_drives_alone());
        Judge {
            keeping,
            way: match lanes {
                Some(form) => Way::Lanes(Box::new(Placer::new(&question, form, &keeping))),
                None => Judge::general(arm, home, keeping),
            },
        }
    }

    fn general(arm: Arm<'q>, home: Option<&'q [f64]>, keeping: Keeping) -> Way<'q> {
        Way::General(Box::new(Columns::one_by_one(
            arm,
            home,
            [keeping.wrist, keeping.margin],
        )))
    }

    /// Whether the eight that are judged are branches, in the order of [`Branch::ALL`]. Of other arms the first alone means
    /// something: the best posture at each point, whichever that is.
    pub fn tells_branches(&self) -> bool {
        match &self.way {
            Way::Lanes(_) => true,
            Way::General(columns) => columns.slots_are_branches(),
        }
    }

    /// What each posture makes of the points of `path` where the part lies so. Branches outside `open` are given up at once,
    /// those that `worth` says no to after some points; what is told of them is that of the points so far.
    pub fn judge(
        &mut self,
        path: &PlacedPath,
        placement: &PartPlacement,
        open: BranchPattern,
        worth: impl FnMut(&Judged) -> bool,
    ) -> [Option<Judged>; SLOTS] {
        let is_open = slots_of(open);
        match &mut self.way {
            Way::Lanes(placer) => by_lanes(placer, (&path.laid, placement), is_open, worth),
            Way::General(columns) => one_by_one((columns, self.keeping.limit), (path, placement), is_open, worth),
        }
    }
}

impl Judge<'_> {
    /// What the points of `path` come to where the part lies so and each is held for itself, in the best of these turns of the
    /// tool (rad, beside the place's) and of the branches that are open.
    pub fn judge_each(&mut self, path: &PlacedPath, placement: &PartPlacement, open: BranchPattern, spins: &[f64]) -> Judged {
        let is_open = slots_of(open);
        let mut least = Vec::with_capacity(path.len());
        match &mut self.way {
            Way::Lanes(placer) => placer.least_of_each(&path.laid, (placement, spins), is_open, &mut least),
            Way::General(columns) => {
                let named = columns.slots_are_branches();
                let mut column = Column::default();
                columns.stand_rail(placement.rail);
                for index in 0..path.len() {
                    path.fill_column(columns, (index, placement), spins, &mut column);
                    let allowed = |slot: usize| !named || is_open[slot % SLOTS];
                    let all = column.deviations.iter().enumerate();
                    let open = all
                        .filter(|(slot, _)| allowed(*slot))
                        .map(|(_, deviation)| *deviation);
                    least.push(open.fold(f64::INFINITY, f64::min));
                }
            }
        }
        let mut judged = Judged::default();
        for deviation in least {
            judged.take(deviation, self.keeping.limit);
        }
        judged
    }
}

impl PlacedPath {
    /// Fills `out` with the postures at point `index` of a part that lies so, the tool turned by each of `spins` (rad).
    fn fill_column(
        &self,
        columns: &mut Columns<'_>,
        (index, placement): (usize, &PartPlacement),
        spins: &[f64],
        out: &mut Column,
    ) {
        let axes = match self.pushes.told_in {
            ToldIn::Base => UnitQuaternion::identity(),
            ToldIn::Part => placement.base_from_part.rotation,
        };
        let turned = |given: &Wrench| Wrench {
            force: axes * given.force,
            moment: axes * given.moment,
        };
        let cases: Vec<Wrench> = self.wrenches(index).iter().map(turned).collect();
        let point = &self.points[index];
        let pose = |spin: &f64| {
            let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin + spin);
            placement.base_from_part * point.part_from_tool * about
        };
        let poses: Vec<Isometry> = spins.iter().map(pose).collect();
        let push = Push {
            cases: &cases,
            along: point.along.map(|along| placement.base_from_part * along),
        };
        columns.fill(&poses, &push, out);
    }
}

/// Proves in half the time that a place is not worth judging; one a thread.
///
/// In single precision: points count as held that nearly are, and deviations stray by [`Glance::strays`].
pub struct Glance(Box<Placer<f32>>);

impl Glance {
    /// For this arm; `None` where lanes do not answer for it.
    pub fn new(arm: Arm<'_>, keeping: Keeping) -> Option<Glance> {
        let form = arm
            .robot
            .ortho_parallel()
            .filter(|_| arm.model.is_drives_alone())?;
        let question = Question::unloaded(arm, None);
        Some(Glance(Box::new(Placer::generous(&question, form, &keeping))))
    }

    /// The deviations it tells along `path` are off by this at most, m.
    pub fn strays(&self, path: &PlacedPath) -> f64 {
        self.0.strays(&path.single)
    }

    /// Whether a branch that is open may be worth it: whatever its postures truly make of the points, no more of them are held
    /// and no deviation is more than [`Glance::strays`] below what `worth` is asked.
    pub fn may_be_worth(
        &mut self,
        path: &PlacedPath,
        placement: &PartPlacement,
        open: BranchPattern,
        worth: impl FnMut(&Judged) -> bool,
    ) -> bool {
        let judged = by_lanes(&mut self.0, (&path.single, placement), slots_of(open), worth);
        judged.iter().any(Option::is_some)
    }
}

/// Which of the eight are branches that are open.
fn slots_of(open: BranchPattern) -> [bool; SLOTS] {
    std::array::from_fn(|slot| open.matches(Branch::ALL[slot]))
}

/// [`Judge::judge`] by lanes.
fn by_lanes<T: Precision>(
    placer: &mut Placer<T>,
    (laid, placement): (&Laid<T>, &PartPlacement),
    open: [bool; SLOTS],
    mut worth: impl FnMut(&Judged) -> bool,
) -> [Option<Judged>; SLOTS] {
    let judged = |tallied: &Tallied, flip: usize| Judged {
        lost: tallied.lost[flip],
        worst: tallied.worst,
        sum: tallied.sum,
        above: tallied.above,
    };
    let mut given_up = [false; SLOTS];
    let tallied = placer.judge(laid, placement, |four, tallied| {
        let mut any = false;
        for flip in 0..2 {
            let slot = 2 * four + flip;
            let open = open[slot] && !given_up[slot] && worth(&judged(tallied, flip));
            given_up[slot] = !open;
            any |= open;
        }
        any
    });
    std::array::from_fn(|slot| (!given_up[slot]).then(|| judged(&tallied[slot / 2], slot % 2)))
}

/// Points after which it is asked whether to go on.
const SOME: usize = 20;

/// [`Judge::judge`] one pose after the other.
fn one_by_one(
    (columns, limit): (&mut Columns<'_>, f64),
    (path, placement): (&PlacedPath, &PartPlacement),
    mut open: [bool; SLOTS],
    mut worth: impl FnMut(&Judged) -> bool,
) -> [Option<Judged>; SLOTS] {
    let named = columns.slots_are_branches();
    if !named {
        // One for whatever posture is best at each point.
        open = std::array::from_fn(|slot| slot == 0);
    }
    columns.stand_rail(placement.rail);
    let mut judged = [Judged::default(); SLOTS];
    let mut column = Column::default();
    for index in 0..path.len() {
        path.fill_column(columns, (index, placement), &[0.0], &mut column);
        let best = || column.deviations.iter().copied().fold(f64::INFINITY, f64::min);
        for (slot, judged) in judged.iter_mut().enumerate().filter(|(slot, _)| open[*slot]) {
            let deviation = match named {
                true => column.deviations[slot],
                false => best(),
            };
            debug_assert!(!named || deviation.is_finite() == (column.stands[slot] == Stand::Holds));
            judged.take(deviation, limit);
        }
        if (index + 1) % SOME == 0 {
            for (open, judged) in open.iter_mut().zip(&judged) {
                *open = *open && worth(judged);
            }
            if open == [false; SLOTS] {
                break;
            }
        }
    }
    std::array::from_fn(|slot| open[slot].then_some(judged[slot]))
}

impl Judged {
    /// Adds a point with this deviation, infinite where no posture stands.
    fn take(&mut self, deviation: f64, limit: f64) {
        if !deviation.is_finite() {
            self.lost += 1;
            return;
        }
        self.worst = self.worst.max(deviation);
        self.sum += deviation;
        self.above += (deviation - limit).max(0.0);
    }
}

#[cfg(test)]
mod tests;

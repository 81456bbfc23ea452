//! A path as points: the sampled moves of a program, or a shape on a plane.
//!
//! Points of a cut are consecutive. A rapid between two cuts has no points; the start of the cut after it is a separate
//! point, at the same distance along the cuts as the last one before. m, s.

use std::ops::Range;

use nalgebra::Point3;

use super::passage::{MoveEnd, Passage};
use super::program::{Command, Move, Operation, Pace, Step};
use super::sampler::{PathPoint, Sampler, Sampling};

/// A path, cut into points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SampledPath {
    /// Points of its cuts.
    pub points: Vec<PathPoint>,
    /// Its operations, each with the index of its first point.
    pub operations: Vec<(usize, Operation)>,
    /// Its commands.
    pub commands: Vec<PlacedCommand>,
    /// The ends of its cutting moves, in order.
    pub ends: Vec<MoveEnd>,
    /// The rapids that lead to each stretch of cuts.
    pub rapids: Vec<Rapids>,
    /// The rapids after the last cut.
    pub last_rapids: Rapids,
    /// Moves, rapids included.
    pub moves: usize,
    /// Time of all cuts with a given feed, s.
    pub cutting_time: f64,
}

/// A command of a program and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedCommand {
    /// Number of points before it.
    pub points: usize,
    /// Number of rapids between the last point and the command.
    pub rapids: usize,
    /// The command.
    pub command: Command,
}

/// Consecutive rapids.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rapids {
    /// Their moves; a rapid from an unknown position included.
    pub moves: Vec<Move>,
    /// Their length from the first known position, m.
    pub length: f64,
    /// How many of the moves are before the first change of the tool among them; `None` where it is not changed.
    pub moves_before_tool_change: Option<usize>,
}

impl SampledPath {
    /// Length of all cuts, m.
    pub fn length(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.along)
    }

    /// Whether point `index` is the first after a rapid, or of all.
    pub fn begins(&self, index: usize) -> bool {
        begins(&self.points, index)
    }

    /// Stretches of consecutive points without a rapid between them.
    pub fn stretches(&self) -> impl Iterator<Item = Range<usize>> {
        let count = self.points.len();
        let starts: Vec<usize> = (0..count).filter(|i| self.begins(*i)).collect();
        let ends: Vec<usize> = starts.iter().skip(1).copied().chain([count]).collect();
        starts.into_iter().zip(ends).map(|(start, end)| start..end)
    }

    /// Every point with its index and its operation, if there is one.
    pub fn with_operations(&self) -> impl Iterator<Item = (usize, &PathPoint, Option<&Operation>)> {
        let mut next = self.operations.iter().peekable();
        let mut current = None;
        self.points.iter().enumerate().map(move |(index, point)| {
            while let Some((_, begun)) = next.next_if(|(first, _)| *first <= index) {
                current = Some(begun);
            }
            (index, point, current)
        })
    }

    /// The smallest and the largest coordinates of its points, m; the origin twice without points.
    pub fn corners(&self) -> [Point3<f64>; 2] {
        let first = self.points.first().map_or_else(Point3::origin, |point| point.at);
        let points = self.points.iter().map(|point| point.at);
        points.fold([first, first], |[low, high], at| [low.inf(&at), high.sup(&at)])
    }
}

/// Whether point `index` is the first after a rapid, or of all.
pub(super) fn begins(points: &[PathPoint], index: usize) -> bool {
    // The start of such a cut is a separate point: nothing was cut since the point before.
    index == 0 || points[index].along <= points[index - 1].along
}

/// A program has more points than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("more than {most} points")]
pub struct TooManyPoints {
    /// Maximum number of points.
    pub most: usize,
}

/// Samples a program step by step as its reader returns it.
#[derive(Clone, Debug)]
pub struct PathBuilder {
    sampler: Sampler,
    path: SampledPath,
    most: usize,
    too_many: bool,
    /// The rapids since the last cut.
    since: Rapids,
    position: Option<Point3<f64>>,
}

impl PathBuilder {
    /// Before the first step; at most `most` points are kept.
    pub fn new(sampling: Sampling, most: usize) -> PathBuilder {
        PathBuilder {
            sampler: Sampler::new(sampling),
            path: SampledPath::default(),
            most,
            too_many: false,
            since: Rapids::default(),
            position: None,
        }
    }

    /// Number of points so far.
    pub fn point_count(&self) -> usize {
        self.path.points.len()
    }

    /// Adds the next step of the program.
    pub fn take(&mut self, step: Step) {
        let next = match step {
            Step::Operation(operation) => {
                let last = self.path.operations.last().map(|(_, last)| last);
                if last.is_none_or(|last| last.has_other_tool(&operation)) {
                    let count = self.since.moves.len();
                    self.since.moves_before_tool_change.get_or_insert(count);
                }
                self.path.operations.push((self.path.points.len(), operation));
                return;
            }
            Step::Command(command) => {
                self.path.commands.push(PlacedCommand {
                    points: self.path.points.len(),
                    rapids: self.since.moves.len(),
                    command,
                });
                return;
            }
            Step::Move(next) => next,
        };
        let path = &mut self.path;
        path.moves += 1;
        if path.points.len().saturating_add(self.sampler.count(&next)) > self.most {
            self.too_many = true;
            return;
        }
        let (first, before) = (path.points.len(), path.length());
        self.sampler.points(&next, |point| path.points.push(point));
        if let Pace::Feed(speed) = next.pace
            && speed > 0.0
        {
            path.cutting_time += (path.length() - before) / speed;
        }
        if !next.pace.cuts() {
            self.since.length += self.position.map_or(0.0, |from| (next.end - from).norm());
            self.since.moves.push(next);
        } else if first < path.points.len() {
            path.ends.push(MoveEnd {
                point: path.points.len() - 1,
                passage: Passage::Unknown,
            });
            let since = std::mem::take(&mut self.since);
            if path.begins(first) {
                path.rapids.push(since);
            }
        }
        self.position = Some(next.end);
    }

    /// The path.
    ///
    /// # Errors
    /// [`TooManyPoints`].
    pub fn finish(mut self) -> Result<SampledPath, TooManyPoints> {
        if self.too_many {
            return Err(TooManyPoints { most: self.most });
        }
        self.path.last_rapids = self.since;
        Ok(self.path)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::super::program::{Course, Move};
    use super::*;

    /// Two cuts of 10 mm at 20 mm/s with a rapid of 30 mm up, over and down between them.
    fn steps() -> Vec<Step> {
        let to = |x: f64, z: f64, pace| {
            Step::Move(Move {
                end: Point3::new(x, 0.0, z),
                axis: None,
                spin: None,
                course: Course::Line,
                pace,
                line: 1,
            })
        };
        let feed = Pace::Feed(0.02);
        vec![
            Step::Operation(Operation::default()),
            to(0.0, 0.0, Pace::Rapid),
            to(0.01, 0.0, feed),
            to(0.01, 0.01, Pace::Rapid),
            to(0.02, 0.01, Pace::Rapid),
            to(0.02, 0.0, Pace::Rapid),
            Step::Operation(Operation {
                tool: Some(2),
                ..Operation::default()
            }),
            Step::Command(Command::Coolant(true)),
            to(0.03, 0.0, feed),
        ]
    }

    fn built(most: usize) -> Result<SampledPath, TooManyPoints> {
        let sampling = Sampling {
            chord_error: 1e-5,
            step: 1e-3,
        };
        let mut builder = PathBuilder::new(sampling, most);
        steps().into_iter().for_each(|step| builder.take(step));
        builder.finish()
    }

    #[test]
    fn a_rapid_ends_a_stretch_and_its_length_is_recorded() {
        let path = built(100).unwrap();
        let stretches: Vec<_> = path.stretches().collect();
        assert_eq!(stretches, [0..11, 11..22]);
        assert!((path.length() - 0.02).abs() < 1e-15 && (path.cutting_time - 1.0).abs() < 1e-12);
        assert_eq!((path.moves, path.rapids.len()), (6, 2));
        assert!(path.rapids[0].length == 0.0 && (path.rapids[1].length - 0.03).abs() < 1e-15);
        let ends: Vec<_> = path.rapids[1]
            .moves
            .iter()
            .map(|rapid| [rapid.end.x, rapid.end.z])
            .collect();
        assert_eq!(ends, [[0.01, 0.01], [0.02, 0.01], [0.02, 0.0]]);
        let before_change = path.rapids.iter().map(|rapids| rapids.moves_before_tool_change);
        assert_eq!(before_change.collect::<Vec<_>>(), [Some(0), Some(3)]);
        let coolant = PlacedCommand {
            points: 11,
            rapids: 3,
            command: Command::Coolant(true),
        };
        assert_eq!(path.commands, [coolant]);
        assert!(path.last_rapids.moves.is_empty());
        for (index, point, operation) in path.with_operations() {
            let begun = usize::from(index >= 11);
            assert_eq!(
                (point, operation),
                (&path.points[index], Some(&path.operations[begun].1))
            );
        }
        let [low, high] = path.corners();
        assert!((high - low - Vector3::new(0.03, 0.0, 0.0)).norm() < 1e-15);
    }

    #[test]
    fn rapids_are_divided_at_the_first_operation_with_another_tool() {
        let with = |places: &[(usize, u32)]| {
            let mut steps = steps();
            for (place, tool) in places {
                let operation = Operation {
                    tool: Some(*tool),
                    spindle: Some(100.0),
                    ..Operation::default()
                };
                steps.insert(*place, Step::Operation(operation));
            }
            let sampling = Sampling {
                chord_error: 1e-5,
                step: 1e-3,
            };
            let mut builder = PathBuilder::new(sampling, 1000);
            steps.into_iter().for_each(|step| builder.take(step));
            builder.finish().unwrap().rapids[1].moves_before_tool_change
        };
        // Operation 1 of `steps` has no tool number, its second one is tool 2 after the third rapid.
        assert_eq!(with(&[(4, 3)]), Some(1));
        assert_eq!(with(&[(5, 3), (4, 5)]), Some(1));
        // The tool is changed before the cut; the same tool again after one rapid is no change.
        assert_eq!(with(&[(2, 2), (5, 2)]), None);
    }

    #[test]
    fn more_points_than_allowed_are_refused_not_truncated() {
        assert!(built(22).is_ok());
        assert_eq!(built(21), Err(TooManyPoints { most: 21 }));
    }

    #[test]
    fn a_step_with_too_many_points_is_refused_before_any_is_computed() {
        let sampling = Sampling {
            chord_error: 1e-5,
            step: 1e-33,
        };
        let mut builder = PathBuilder::new(sampling, 1000);
        steps().into_iter().for_each(|step| builder.take(step));
        assert_eq!(builder.point_count(), 0);
        assert_eq!(builder.finish(), Err(TooManyPoints { most: 1000 }));
    }

    #[test]
    fn a_path_without_points_has_no_stretch_and_no_length() {
        let path = SampledPath::default();
        assert_eq!((path.stretches().count(), path.length()), (0, 0.0));
        assert_eq!(path.corners(), [Point3::origin(); 2]);
    }
}

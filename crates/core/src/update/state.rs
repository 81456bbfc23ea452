//! An arm with values of all its parameters, and the rows of each campaign there.
//!
//! ```text
//! y = B ( p(q; x) + sum_j (c_j tau_j + side_j gap_j / 2) s_j )        tau_j = s_j . w
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `y` | measured point, in the frame of the measurement; of a surface its coordinate along the normal; of a ball-bar its distance from the pivot, the origin of that frame | m |
//! | `B` | base of the robot in that frame, unknown | |
//! | `p(q; x)` | the point by the chain with the small motions `x`, base | m |
//! | `s_j`, `w` | screw of a joint at the point of the nominal chain; load | |
//! | `c_j`, `gap_j`, `side_j` | compliance of the drive, backlash, side of the link | |
//!
//! Columns: the parameters of the arm in their order, then base and point of each campaign of positions. Compliances and gaps change
//! by their logarithms.

use nalgebra::{DMatrix, DVector, Vector3};

use super::measurement::{Campaign, Known, Observed, Positions, rows_along};
use super::parameter::{Knowledge, Parameter};
use crate::calibrate::{Arm, ParameterLocation, Unknown};
use crate::frame::Isometry;
use crate::identify::LoadTest;
use crate::identify::effect::{Effects, State as Springs};
use crate::identify::unknown::drives;
use crate::robot::Robot;
use crate::robot::forward::forward;
use crate::robot::jacobian::screws_at;
use crate::spatial::Twist;

/// Displacement of the point by each joint at one pose, base axes.
#[derive(Clone, Debug)]
struct Loaded {
    /// Screw of each joint, per rad or m.
    screws: Vec<Twist>,
    /// Torque of the load on it, N m or N.
    torques: Vec<f64>,
    /// Side of its link: -1, 0 or 1.
    sides: Vec<f64>,
}

/// A campaign with what does not depend on the parameters.
enum Prepared<'a> {
    Positions(&'a Positions, Vec<Loaded>),
    LoadTests(&'a [LoadTest], Vec<Effects>),
}

/// What the rows of all campaigns need.
pub(super) struct Model<'a> {
    robot: &'a Robot,
    pub prior: &'a [Knowledge],
    campaigns: Vec<Prepared<'a>>,
    /// Unknown frames of each campaign of positions.
    frames: Vec<Vec<Unknown>>,
}

/// Values of all parameters and frames.
#[derive(Clone, Debug)]
pub(super) struct State<'a> {
    /// Of the parameters, in their order: as [`Knowledge::mean`].
    pub values: Vec<f64>,
    /// One for each campaign of positions, with its frames; all with the same small motions.
    pub arms: Vec<Arm<'a>>,
}

impl<'a> Model<'a> {
    pub fn new(robot: &'a Robot, prior: &'a [Knowledge], campaigns: &'a [Campaign]) -> Model<'a> {
        let springs = drives(robot);
        let prepared = campaigns.iter().map(|campaign| match campaign {
            Campaign::Positions(positions) => Prepared::Positions(positions, loaded(robot, positions)),
            Campaign::LoadTests(tests) => {
                let effects = tests.iter().map(|test| Effects::of(robot, &springs, test));
                Prepared::LoadTests(tests, effects.collect())
            }
        });
        let frames = campaigns.iter().filter_map(|campaign| match campaign {
            Campaign::Positions(positions) => Some(frames_of(positions)),
            Campaign::LoadTests(_) => None,
        });
        Model {
            robot,
            prior,
            campaigns: prepared.collect(),
            frames: frames.collect(),
        }
    }

    /// Number of columns.
    pub fn unknowns(&self) -> usize {
        self.prior.len() + self.frames.iter().map(Vec::len).sum::<usize>()
    }

    /// First column and unknowns of the frames of a campaign of positions.
    fn frame_columns(&self, index: usize) -> (usize, &[Unknown]) {
        let before: usize = self.frames[..index].iter().map(Vec::len).sum();
        (self.prior.len() + before, &self.frames[index])
    }

    /// Columns of the coordinates of approximate points and pivots, and how far each is from where it was said to be, m.
    pub fn points(&self, state: &State<'a>) -> Vec<(usize, f64)> {
        let positions = self.campaigns.iter().filter_map(|campaign| match campaign {
            Prepared::Positions(positions, _) => Some(positions),
            Prepared::LoadTests(..) => None,
        });
        let mut points = Vec::new();
        for (index, (positions, arm)) in positions.zip(&state.arms).enumerate() {
            let (first, frames) = self.frame_columns(index);
            let point = &arm.flange_from_point;
            let moved = point.translation.vector - positions.flange_from_point.translation.vector;
            let moved = point.rotation.inverse() * moved;
            let mut take = |place: ParameterLocation, moved: Vector3<f64>| {
                let coordinates = frames
                    .iter()
                    .enumerate()
                    .filter(|(_, unknown)| unknown.place == place && !unknown.turns());
                points.extend(coordinates.map(|(k, unknown)| (first + k, moved[unknown.axis().index()])));
            };
            take(ParameterLocation::Tool, moved);
            if let Observed::Distances(distances) = &positions.observed {
                take(ParameterLocation::Base, distances.moved(&arm.tracker_from_base));
            }
        }
        points
    }

    /// The arm with the means of the prior; each campaign of positions in the axes of the base, its point at `flange_from_point`.
    pub fn at(&self, flange_from_point: Isometry) -> State<'a> {
        let nominal = Arm::nominal(self.robot, Isometry::identity(), flange_from_point);
        self.with_means(vec![nominal; self.frames.len()])
    }

    /// The arm with the means of the prior, between the frames of these nominal arms, one for each campaign of positions.
    pub fn with_means(&self, nominal: Vec<Arm<'a>>) -> State<'a> {
        let nominal = State {
            values: vec![0.0; self.prior.len()],
            arms: nominal,
        };
        let mut by: Vec<f64> = self.prior.iter().map(|known| known.mean).collect();
        by.resize(self.unknowns(), 0.0);
        self.changed(&nominal, &by)
    }

    /// `state` after these steps.
    pub fn changed(&self, state: &State<'a>, by: &[f64]) -> State<'a> {
        let values = state
            .values
            .iter()
            .zip(by)
            .map(|(value, by)| value + by)
            .collect();
        let geometry: Vec<(Unknown, f64)> = self
            .prior
            .iter()
            .zip(by)
            .filter_map(|(known, by)| match known.parameter {
                Parameter::Geometry(unknown) => Some((unknown, *by)),
                Parameter::Drive(_) | Parameter::Backlash(_) => None,
            })
            .collect();
        let arm = |(index, arm): (usize, &Arm<'a>)| {
            let (first, frames) = self.frame_columns(index);
            let steps = geometry
                .iter()
                .copied()
                .chain(frames.iter().copied().zip(by[first..].iter().copied()));
            let (unknowns, by): (Vec<Unknown>, Vec<f64>) = steps.unzip();
            arm.changed(&unknowns, &by)
        };
        State {
            values,
            arms: state.arms.iter().enumerate().map(arm).collect(),
        }
    }

    /// Rows of a campaign over its standard uncertainties: one column per unknown, the residual (measured less predicted) last.
    pub fn rows(&self, state: &State<'a>, campaign: usize) -> DMatrix<f64> {
        match &self.campaigns[campaign] {
            Prepared::Positions(positions, loaded) => {
                let index = self.campaigns[..campaign]
                    .iter()
                    .filter(|other| matches!(other, Prepared::Positions(..)))
                    .count();
                self.position_rows(state, index, positions, loaded)
            }
            Prepared::LoadTests(tests, effects) => self.load_test_rows(state, tests, effects),
        }
    }

    fn position_rows(
        &self,
        state: &State<'a>,
        index: usize,
        positions: &Positions,
        loaded: &[Loaded],
    ) -> DMatrix<f64> {
        let arm = &state.arms[index];
        let (first, frames) = self.frame_columns(index);
        let chain: Vec<(usize, Unknown)> = (self.prior.iter().enumerate())
            .filter_map(|(column, known)| match known.parameter {
                Parameter::Geometry(unknown) => Some((column, unknown)),
                Parameter::Drive(_) | Parameter::Backlash(_) => None,
            })
            .collect();
        let unknowns: Vec<Unknown> = chain
            .iter()
            .map(|(_, unknown)| *unknown)
            .chain(frames.iter().copied())
            .collect();
        let columns: Vec<usize> = (chain.iter().map(|(column, _)| *column))
            .chain(first..first + frames.len())
            .collect();
        let turn = arm.tracker_from_base.rotation;
        let last = self.unknowns();
        let height = match positions
            .poses
            .first()
            .is_some_and(|pose| pose.rotation.is_some())
        {
            true => 6,
            false => 3,
        };
        let mut rows = DMatrix::zeros(height * positions.poses.len(), last + 1);
        for (k, (pose, loaded)) in positions.poses.iter().zip(loaded).enumerate() {
            let of_arm = arm.rows(&unknowns, pose, positions.turn_length);
            let mut here = rows.rows_mut(height * k, height);
            for (from, to) in columns.iter().enumerate() {
                here.column_mut(*to).copy_from(&of_arm.column(from));
            }
            here.column_mut(last).copy_from(&of_arm.column(unknowns.len()));
            let mut all = Vector3::zeros();
            for (column, (known, value)) in self.prior.iter().zip(&state.values).enumerate() {
                let Some(moved) = loaded.moved(known.parameter, value.exp()) else {
                    continue;
                };
                all += moved.linear;
                let mut put = |first: usize, by: Vector3<f64>| {
                    let by = turn * by;
                    for axis in 0..3 {
                        // By its logarithm the displacement changes by itself.
                        here[(first + axis, column)] = by[axis];
                        here[(first + axis, last)] -= by[axis];
                    }
                };
                put(0, moved.linear);
                if height == 6 {
                    put(3, moved.angular * positions.turn_length);
                }
            }
            // The base carries the displaced point.
            for (column, unknown) in (first..).zip(frames) {
                if unknown.place == ParameterLocation::Base && unknown.turns() {
                    let by = turn * unknown.axis().unit().cross(&all);
                    for axis in 0..3 {
                        here[(axis, column)] += by[axis];
                    }
                }
            }
        }
        match &positions.observed {
            Observed::Coordinates => rows / positions.standard_uncertainty,
            Observed::AlongNormals(normals) => rows_along(normals, &rows) / positions.standard_uncertainty,
            Observed::Distances(distances) => distances.rows(&rows) / positions.standard_uncertainty,
        }
    }

    fn load_test_rows(&self, state: &State<'a>, tests: &[LoadTest], effects: &[Effects]) -> DMatrix<f64> {
        let springs = drives(self.robot);
        let mut sizes = vec![0.0; springs.len()];
        for (known, value) in self.prior.iter().zip(&state.values) {
            if let Parameter::Drive(joint) = known.parameter {
                sizes[joint] = value.exp();
            }
        }
        let height = tests.iter().map(|test| test.readings.len()).sum();
        let last = self.unknowns();
        let mut rows = DMatrix::zeros(height, last + 1);
        let at = Springs::of_sizes(sizes);
        let mut row = 0;
        for (test, effects) in tests.iter().zip(effects) {
            let jacobian = effects.jacobian(&springs, &at);
            for (k, reading) in test.readings.iter().enumerate() {
                let u = reading.standard_uncertainty;
                let mut predicted = 0.0;
                for (column, known) in self.prior.iter().enumerate() {
                    if let Parameter::Drive(joint) = known.parameter {
                        let part = jacobian[(k, joint)] * at.sizes[joint];
                        predicted += part;
                        rows[(row, column)] = part / u;
                    }
                }
                rows[(row, last)] = (reading.value - predicted) / u;
                row += 1;
            }
        }
        rows
    }
}

impl Loaded {
    /// Displacement by a parameter of this value; none by the geometry.
    fn moved(&self, parameter: Parameter, value: f64) -> Option<Twist> {
        let (joint, by) = match parameter {
            Parameter::Geometry(_) => return None,
            Parameter::Drive(joint) => (joint, value * self.torques[joint]),
            Parameter::Backlash(joint) => (joint, 0.5 * value * self.sides[joint]),
        };
        Some(self.screws[joint] * by)
    }
}

fn loaded(robot: &Robot, positions: &Positions) -> Vec<Loaded> {
    let each = positions.poses.iter().zip(&positions.conditions);
    each.map(|(pose, condition)| {
        let frames = forward(robot, &pose.joints);
        let point =
            frames.base_from_flange * nalgebra::Point3::from(positions.flange_from_point.translation.vector);
        let screws = screws_at(robot, &frames, &point);
        Loaded {
            torques: screws.iter().map(|screw| screw.dot(&condition.wrench)).collect(),
            sides: condition.sides(robot),
            screws,
        }
    })
    .collect()
}

fn frames_of(positions: &Positions) -> Vec<Unknown> {
    let turned = positions
        .poses
        .first()
        .is_some_and(|pose| pose.rotation.is_some());
    let of = |place, count| (0..count).map(move |component| Unknown { place, component });
    let point = match (positions.point, turned) {
        (Known::Exactly, _) => 0,
        (Known::Approximately, false) => 3,
        (Known::Approximately, true) => 6,
    };
    // Distances do not depend on the axes of the frame at the pivot.
    let base = match positions.observed {
        Observed::Coordinates | Observed::AlongNormals(_) => 6,
        Observed::Distances(_) => 3,
    };
    of(ParameterLocation::Base, base)
        .chain(of(ParameterLocation::Tool, point))
        .collect()
}

/// The residual of some rows.
pub(super) fn residual(rows: &DMatrix<f64>) -> DVector<f64> {
    rows.column(rows.ncols() - 1).into_owned()
}

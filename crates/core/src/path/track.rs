//! A path in the cell: its points with the tool poses, and deviations in the feed frame.

use nalgebra::{Rotation3, Unit, UnitQuaternion, Vector3};

use super::lean::{Lean, RoundedEnd};
use super::placing::Placing;
use super::sampled::SampledPath;
use super::sampler::PathPoint;
use crate::frame::Isometry;
use crate::load::{LeaningForces, PathLoad};
use crate::spatial::Wrench;

/// A sampled path and its placing.
#[derive(Clone, Debug)]
pub struct Track {
    /// Its points.
    pub path: SampledPath,
    /// Placing in the cell.
    pub placing: Placing,
    /// The part, whose axes a load may be given in.
    pub base_from_part: Isometry,
    /// Additional turn of the tool about its axis, rad, point after point; `None` without.
    pub spins: Option<Vec<f64>>,
    /// Home positions of the robot, rad (m), one a joint, point after point, where an external axis moves along the path;
    /// `None`: the same at all points.
    pub homes: Option<Vec<f64>>,
}

/// A point of a track: tool pose, and normal for splitting deviations.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// The tool pose.
    pub base_from_tool: Isometry,
    /// Outward normal of the surface that is cut, base: the tool axis from the tip to the spindle, unless the tool leans.
    pub normal: Unit<Vector3<f64>>,
}

/// A point of a track with its load.
#[derive(Clone, Debug)]
pub struct LoadedStop {
    /// The tool pose and the normal.
    pub stop: Stop,
    /// Wrenches on the tool at the TCP, base, one a case.
    pub cases: Vec<Wrench>,
}

/// A deviation in the feed frame, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// Along the feed: late or early, hardly visible on the part.
    pub along: f64,
    /// To the left of the track: relevant for a wall.
    pub cross: f64,
    /// Along the tool, away from the part: relevant for a floor.
    pub axial: f64,
}

/// A track under its load.
#[derive(Clone, Copy, Debug)]
pub struct LoadedTrack<'a> {
    /// Points and poses.
    pub track: &'a Track,
    /// Not checked: that it [covers](PathLoad::covers) the points.
    pub load: &'a PathLoad,
}

impl Track {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.path.points.len()
    }

    /// Greatest height of its points along the axis of the path, m; the top of the part where cuts begin on it. Minus infinity
    /// without points.
    pub fn top(&self) -> f64 {
        let axis = &self.placing.axis;
        let heights = self.path.points.iter().map(|point| point.at.coords.dot(axis));
        heights.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.path.points.is_empty()
    }

    /// The closed track of a closed shape: its first point is repeated at its end, at `length` (m) along it.
    pub fn closed(&self, length: f64) -> Track {
        let mut closed = self.clone();
        let first = self.path.points.first();
        closed.path.points.extend(first.map(|first| PathPoint {
            along: length,
            ..*first
        }));
        if let Some(spins) = &mut closed.spins {
            spins.extend(spins.first().copied());
        }
        if let Some(homes) = &mut closed.homes {
            homes.extend_from_within(..homes.len() / self.len());
        }
        closed
    }

    /// The track with its part at `base_from_part` (base) and the tool turned by `spin` (rad) about its axis in
    /// addition. Relative to the part, the tool is otherwise as on this track.
    pub fn moved(&self, base_from_part: Isometry, spin: f64) -> Track {
        let moved = base_from_part * self.base_from_part.inverse();
        let mut track = Track {
            base_from_part,
            placing: Placing {
                base_from_path: moved * self.placing.base_from_path,
                ..self.placing
            },
            spins: None,
            homes: self.homes.clone(),
            path: self.path.clone(),
        };
        let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), spin);
        let more = |index: usize| {
            let required = moved.rotation * self.stop(index).base_from_tool.rotation * turned;
            let turn = track.stop(index).base_from_tool.rotation.inverse() * required;
            2.0 * turn.k.atan2(turn.w)
        };
        track.spins = Some((0..self.len()).map(more).collect());
        track
    }

    /// Every `stride`-th point, each in its stretch of cuts. Only the order of the points along a stretch is kept, not
    /// the distance between them.
    pub fn every(&self, stride: usize) -> Track {
        let stride = stride.max(1);
        let mut along = 0.0;
        let mut begins = false;
        let mut points = Vec::with_capacity(self.len().div_ceil(stride));
        for (index, point) in self.path.points.iter().enumerate() {
            begins |= self.path.begins(index);
            if index % stride == 0 {
                along += if begins { 0.0 } else { 1.0 };
                points.push(PathPoint { along, ..*point });
                begins = false;
            }
        }
        let spins = self.spins.as_ref();
        Track {
            path: SampledPath {
                points,
                operations: Vec::new(),
                ends: Vec::new(),
                ..self.path.clone()
            },
            spins: spins.map(|spins| spins.iter().copied().step_by(stride).collect()),
            homes: self.homes_at((0..self.len()).step_by(stride)),
            ..*self
        }
    }

    /// These points alone, in ascending order, each at its distance along the path.
    pub fn at_points(&self, indices: &[usize]) -> Track {
        let of = &self.path;
        let spins = self.spins.as_ref();
        Track {
            path: SampledPath {
                points: indices.iter().map(|index| of.points[*index]).collect(),
                moves: of.moves,
                cutting_time: of.cutting_time,
                ..SampledPath::default()
            },
            spins: spins.map(|spins| indices.iter().map(|index| spins[*index]).collect()),
            homes: self.homes_at(indices.iter().copied()),
            ..*self
        }
    }

    /// [`Track::homes`] at these points.
    pub fn homes_at(&self, indices: impl Iterator<Item = usize>) -> Option<Vec<f64>> {
        let homes = self.homes.as_ref()?;
        let width = homes.len().checked_div(self.len())?;
        Some(
            indices
                .flat_map(|index| &homes[index * width..][..width])
                .copied()
                .collect(),
        )
    }

    /// The track with the tool turned by `spin` (rad) about its axis at all points, in addition.
    pub fn spun(&self, spin: f64) -> Track {
        let had = |index: usize| self.spins.as_ref().map_or(0.0, |spins| spins[index]);
        Track {
            spins: Some((0..self.len()).map(|index| had(index) + spin).collect()),
            ..self.clone()
        }
    }

    /// The tool pose at point `index`, and the normal there.
    pub fn stop(&self, index: usize) -> Stop {
        let spin = self.spins.as_ref().map(|spins| spins[index]);
        stop_at(&self.placing, &self.path.points[index], spin)
    }

    /// The track with the tool leaning by `leans` from its axis, point after point, for a tool with this end.
    ///
    /// # Panics
    /// If there are fewer leans than points.
    pub fn leaning(&self, leans: &[Lean], end: RoundedEnd) -> Track {
        let mut track = self.clone();
        track.placing.keeps_axis = false;
        for (index, point) in track.path.points.iter_mut().enumerate() {
            *point = self.placing.leaned(point, leans[index], end);
        }
        track
    }

    /// The load on this track: that of a cut with the tool leaning as it does here.
    pub fn leaning_load(&self, load: PathLoad) -> PathLoad {
        let leans = || self.path.points.iter().map(|point| self.placing.lean(point));
        match load {
            PathLoad::Cuts(cuts) if leans().any(|lean| lean != Lean::NONE) => {
                PathLoad::Cuts(cuts.leaning(&leans().collect::<Vec<Lean>>()))
            }
            load => load,
        }
    }

    /// [`Track::loaded_stop`] of [`Track::leaning`] under [`PathLoad::leaning`].
    pub fn leaning_stop(
        &self,
        index: usize,
        (lean, end): (Lean, RoundedEnd),
        (load, forces): (&PathLoad, &LeaningForces),
    ) -> LoadedStop {
        let point = self.placing.leaned(&self.path.points[index], lean, end);
        let placing = Placing {
            keeps_axis: false,
            ..self.placing
        };
        let spin = self.spins.as_ref().map(|spins| spins[index]);
        let axes = placing.base_from_feed(&point);
        let mut cases = vec![Wrench::ZERO; load.case_count()];
        match load {
            PathLoad::Cuts(cuts) => {
                for (case, force) in cases.iter_mut().zip(forces.at(cuts, index, lean)) {
                    *case = Wrench::from_force(axes * force);
                }
            }
            given => given.in_base(index, &self.base_from_part, &axes, &mut cases),
        }
        LoadedStop {
            stop: stop_at(&placing, &point, spin),
            cases,
        }
    }

    /// A deviation (m, base) at point `index`, in the feed frame.
    pub fn parts(&self, index: usize, deviation: &Vector3<f64>) -> Parts {
        let seen = self.base_from_surface(index).inverse() * deviation;
        Parts {
            along: seen.x,
            cross: seen.y,
            axial: seen.z,
        }
    }

    /// Axes of the feed frame at point `index`, in base.
    pub fn base_from_feed(&self, index: usize) -> Rotation3<f64> {
        self.placing.base_from_feed(&self.path.points[index])
    }

    /// Axes of the surface that is cut at point `index`, in base: see [`Placing::base_from_surface`].
    pub fn base_from_surface(&self, index: usize) -> Rotation3<f64> {
        self.placing.base_from_surface(&self.path.points[index])
    }

    /// Fills in the wrenches of `load` at point `index`, base.
    pub fn wrenches(&self, load: &PathLoad, index: usize, out: &mut [Wrench]) {
        let axes = self.base_from_feed(index);
        load.in_base(index, &self.base_from_part, &axes, out);
    }

    /// The tool pose at point `index` with the wrenches of `load` there.
    pub fn loaded_stop(&self, index: usize, load: &PathLoad) -> LoadedStop {
        let mut cases = vec![Wrench::ZERO; load.case_count()];
        self.wrenches(load, index, &mut cases);
        LoadedStop {
            stop: self.stop(index),
            cases,
        }
    }

    /// The normal of the surface that is cut, base, if it is the same at all points.
    pub fn steady_normal(&self) -> Option<Unit<Vector3<f64>>> {
        let first = self.path.points.first()?;
        let given = |point: &PathPoint| point.normal.or(point.axis.filter(|_| !self.placing.keeps_axis));
        let steady = self.path.points.iter().all(|point| given(point) == given(first));
        steady.then(|| self.placing.normal(first))
    }
}

/// The tool pose at a point with this additional spin (rad), and the normal there.
fn stop_at(placing: &Placing, point: &PathPoint, spin: Option<f64>) -> Stop {
    let placed = placing.base_from_tool(point);
    let about_axis = |spin| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), spin);
    Stop {
        base_from_tool: spin.map_or(placed, |spin| placed * about_axis(spin)),
        normal: placing.normal(point),
    }
}

//! A path on a part, and the totals of a posture over its points.

use nalgebra::{UnitQuaternion, Vector3};

use crate::frame::Isometry;
use crate::kernel::column::{Column, ColumnLoad, Columns};
use crate::kernel::lanes::PlacementPoints;
use crate::kernel::path_on_part::{PartPlacement, PathWrenches, PlacedPoint, SpunPlacement, WrenchAxes};
use crate::spatial::Wrench;

/// Totals of one posture over all points.
///
/// Where points are unreachable, lanes include the deviations of points that are only outside joint limits; the general
/// computation does not. Compare such placements by their unreachable points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathTotals {
    /// Points where the posture cannot be used.
    pub unreachable: usize,
    /// Largest selected component of the deviation at the other points, m.
    pub worst: f64,
    /// Sum of the deviations at these points, m.
    pub sum: f64,
    /// Sum of the excess over the tolerance, m.
    pub above: f64,
}

/// A path on a part.
#[derive(Debug)]
pub struct PlacedPath {
    pub(super) points: Vec<PlacedPoint>,
    load: PathWrenches,
    pub(super) double: PlacementPoints<f64>,
    /// The same in single precision.
    pub(super) single: PlacementPoints<f32>,
}

impl PlacedPath {
    /// A path of these points under these wrenches.
    ///
    /// # Panics
    /// If the number of wrenches is neither that of the load cases nor that of the load cases at all points, or zero.
    pub fn new(points: Vec<PlacedPoint>, load: PathWrenches) -> PlacedPath {
        let given = load.wrenches.len();
        assert!(
            load.cases > 0 && (given == load.cases || given == load.cases * points.len()),
            "one wrench per load case, for all points or for each point"
        );
        PlacedPath {
            double: PlacementPoints::new(&points, &load),
            single: PlacementPoints::new(&points, &load),
            points,
            load,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Every number of points and wrenches, in order: identifies the path.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        let of_point = |point: &PlacedPoint| {
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
        let wrenches = self.load.wrenches.iter().flat_map(of_wrench);
        self.points.iter().flat_map(of_point).chain(wrenches)
    }

    /// Load cases per point.
    pub fn case_count(&self) -> usize {
        self.load.cases
    }

    /// The wrenches at point `index`, in their axes.
    fn wrenches(&self, index: usize) -> &[Wrench] {
        let PathWrenches { cases, wrenches, .. } = &self.load;
        let first = if wrenches.len() == *cases {
            0
        } else {
            index * cases
        };
        &wrenches[first..][..*cases]
    }
}

impl PlacedPath {
    /// The wrenches at point `index` at a placement, base.
    pub(super) fn wrenches_at(
        &self,
        index: usize,
        placement: &PartPlacement,
    ) -> impl ExactSizeIterator<Item = Wrench> {
        let axes = match self.load.wrench_axes {
            WrenchAxes::Base => UnitQuaternion::identity(),
            WrenchAxes::Part => placement.base_from_part.rotation,
        };
        self.wrenches(index).iter().map(move |given| Wrench {
            force: axes * given.force,
            moment: axes * given.moment,
        })
    }

    /// Fills `out` with the postures at point `index` at the placements `tried`.
    pub(super) fn fill_column(
        &self,
        columns: &mut Columns<'_>,
        index: usize,
        tried: SpunPlacement<'_>,
        out: &mut Column,
    ) {
        let SpunPlacement { placement, spins } = tried;
        let cases: Vec<Wrench> = self.wrenches_at(index, placement).collect();
        let point = &self.points[index];
        let pose = |spin: &f64| {
            let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), placement.spin + spin);
            placement.base_from_part * point.part_from_tool * about
        };
        let poses: Vec<Isometry> = spins.iter().map(pose).collect();
        let load = ColumnLoad {
            cases: &cases,
            along: point.along.map(|along| placement.base_from_part * along),
        };
        columns.fill(&poses, &load, out);
    }
}

impl PathTotals {
    /// Adds a point with this deviation, infinite where no posture can be used.
    pub(super) fn take(&mut self, deviation: f64, tolerance: f64) {
        if !deviation.is_finite() {
            self.unreachable += 1;
            return;
        }
        self.worst = self.worst.max(deviation);
        self.sum += deviation;
        self.above += (deviation - tolerance).max(0.0);
    }
}

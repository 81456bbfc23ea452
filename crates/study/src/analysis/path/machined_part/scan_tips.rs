//! Where the tip of the tool was, by the measured surface that it has left: for the journal of the arm.
//!
//! ```text
//! d = m - (p - n t)          m measured, p predicted deviation before alignment, t predicted displacement of the tip
//! ```
//!
//! What the model predicts of the surface beyond the displacement of the tip (rotation of the tool, its shape, steps of the program) is taken from the measured deviation. The mean of the points
//! that one move has left in one direction is one measurement.

use std::collections::BTreeMap;

use armill_core::nalgebra::Vector3;
use armill_core::path::Track;
use armill_core::source::Deviation;

use super::mesh::PartMesh;
use super::scan::ScanComparison;
use super::scan_contributions::move_at;
use crate::analysis::path::to_measure::MeasuredTip;

/// Tips at most: more say hardly more of an arm.
const MOST_TIPS: usize = 1000;

/// Points that one move has left in one direction.
#[derive(Default)]
struct Group {
    normals: Vector3<f64>,
    measured: f64,
    count: usize,
}

/// The tips by the points of a scan; `at`: the deviation of the tool at a point of the path.
pub(super) fn tips(
    scan: &ScanComparison,
    (mesh, track): (&PartMesh, &Track),
    at: impl Fn(usize) -> Option<Deviation>,
) -> Vec<MeasuredTip> {
    let mut groups: BTreeMap<(usize, usize, bool), Group> = BTreeMap::new();
    for (point, place) in scan.places.iter().enumerate() {
        let Some(index) = move_at(mesh, place) else {
            continue;
        };
        let normal = scan.normals[point];
        let axis = normal.iamax();
        let group = groups.entry((index, axis, normal[axis] > 0.0)).or_default();
        group.normals += normal;
        group.measured += scan.measured[point] - scan.unaligned[point];
        group.count += 1;
    }
    let stride = groups.len().div_ceil(MOST_TIPS).max(1);
    let tip = |((index, ..), group): (&(usize, usize, bool), &Group)| {
        let deviation = at(*index)?;
        let path_from_base = track.placing.base_from_path.rotation.inverse();
        let normal = group.normals.try_normalize(0.0)?;
        let displaced = (path_from_base * deviation.twist.linear).dot(&normal);
        let along = group.measured / group.count as f64 + displaced;
        Some(MeasuredTip {
            index: *index,
            position: track.path.points[*index].at + normal * along,
            normal,
        })
    };
    groups.iter().step_by(stride).filter_map(tip).collect()
}

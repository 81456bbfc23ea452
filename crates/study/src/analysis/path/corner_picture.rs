//! The picture of a path next to the point where the motion moves the tool most: programmed, commanded and followed.

use armill_core::nalgebra::{Point3, Vector3};
use armill_core::units::{to_mm, to_um};
use armill_report::{AxisLabels, NamedLine, PathDetail};

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::picture::Picture;
use crate::analysis::words::micrometres;
use crate::file_names::slug;

/// Less than this, m, is not drawn.
const SEEN: f64 = 1e-7;

/// The picture; `None` without a motion, or if it moves the tool nowhere.
pub fn picture(name: &str, analysis: &PathAnalysis, found: &PathResult) -> Option<Picture> {
    let motion = found.motion.as_ref()?;
    let detail = motion.largest.as_ref().filter(|detail| detail.distance > SEEN)?;
    let (track, index) = (&analysis.track, detail.index);
    let at = track.stop(index).base_from_tool.translation.vector;
    let moved = motion.blending[index] + motion.servo[index];
    // Seen so that the feed and the displacement are in the picture.
    let forwards = track.base_from_surface(index) * Vector3::x();
    let aside = (moved - forwards * forwards.dot(&moved)).try_normalize(0.0);
    let aside = aside.unwrap_or_else(|| track.base_from_surface(index) * Vector3::y());
    let seen = |point: &Point3<f64>| [forwards, aside].map(|axis| to_mm((point.coords - at).dot(&axis)));
    let is_near = |k: &usize| (point(analysis, *k).coords - at).norm() <= 2.0 * detail.reach;
    let first = (0..index).rev().find(|k| !is_near(k)).unwrap_or(0);
    let last = (index..track.len())
        .find(|k| !is_near(k))
        .unwrap_or(track.len() - 1);
    let line = |name: &str, points: &[Point3<f64>]| NamedLine {
        name: name.to_owned(),
        points_mm: points.iter().map(seen).collect(),
    };
    let programmed: Vec<Point3<f64>> = (first..=last).map(|k| point(analysis, k)).collect();
    let near = detail.followed.iter().chain(&detail.commanded).map(seen);
    let near = near.filter(|[x, y]| x.hypot(*y) <= to_mm(0.5 * detail.reach));
    let (centre_mm, half_size_mm) = window(near.chain([[0.0, 0.0]]));
    let of_line = track.path.points[index].line;
    let picture = PathDetail {
        title: format!("{name}: line {of_line}"),
        subtitle: format!(
            "where the motion moves the tool most: rounded corner {} µm, joints that follow late {} µm",
            micrometres(to_um(motion.blending[index].norm())),
            micrometres(to_um(motion.servo[index].norm()))
        ),
        axes: AxisLabels {
            horizontal: "along the feed (mm)".to_owned(),
            vertical: "in the direction of the displacement (mm)".to_owned(),
        },
        centre_mm,
        half_size_mm,
        lines: vec![
            line("programmed", &programmed),
            line("commanded", &detail.commanded),
            line("followed", &detail.followed),
        ],
    };
    Some(Picture {
        name: format!("{}-corner", slug(name)),
        caption: format!(
            "{name}: programmed, commanded and followed path where the motion moves the tool most (line {of_line})."
        ),
        svg: picture.to_svg(),
    })
}

/// The centre and half of the size of a square around these points, with some white, mm.
fn window(points: impl Iterator<Item = [f64; 2]> + Clone) -> ([f64; 2], f64) {
    let [x, y] = [0, 1].map(|axis| {
        let values = points.clone().map(|at| at[axis]);
        let [low, high] = [f64::min, f64::max].map(|of| values.clone().reduce(of).unwrap_or(0.0));
        (0.5 * (low + high), high - low)
    });
    ([x.0, y.0], 0.6 * x.1.max(y.1))
}

/// A point of the path, m, base.
fn point(analysis: &PathAnalysis, index: usize) -> Point3<f64> {
    analysis
        .track
        .stop(index)
        .base_from_tool
        .translation
        .vector
        .into()
}

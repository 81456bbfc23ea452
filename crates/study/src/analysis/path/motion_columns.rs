//! Columns and pictures of the motion along a path.

use armill_core::motion::Motion;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_um};
use armill_report::{PathPlot, Series};

use crate::analysis::motion_quantity;
use crate::analysis::numbers::Numbers;
use crate::analysis::path::PathAnalysis;
use crate::analysis::path::point_groups::PointGroups;
use crate::analysis::path::run::PathResult;
use crate::analysis::picture::Picture;
use crate::analysis::quantity::Quantity;
use crate::file_names::slug;

/// Time, speed, and the distances of commanded and followed path; none if the motion was not requested.
pub fn columns(found: &PathResult) -> Vec<Numbers<'_>> {
    let Some(motion) = &found.motion else {
        return Vec::new();
    };
    let value = |quantity: &'static Quantity, of: fn(&Motion, usize) -> f64| {
        Numbers::of(quantity, move |_, index, _| of(motion, index))
    };
    vec![
        value(&motion_quantity::TIME, |motion, index| motion.times[index]),
        value(&motion_quantity::SPEED, |motion, index| {
            to_mm(motion.speeds[index])
        }),
        value(&motion_quantity::FEED_REACHED, |motion, index| {
            motion.speeds[index] / motion.feeds[index]
        }),
        value(&motion_quantity::BLENDING, |motion, index| {
            to_um(motion.blending[index].norm())
        }),
        value(&motion_quantity::SERVO, |motion, index| {
            to_um(motion.servo[index].norm())
        }),
    ]
}

/// Speed along the path, and the joint speeds relative to their limits; none if the motion was not requested.
pub fn pictures(
    robot: &Robot,
    name: &str,
    subtitle: &str,
    analysis: &PathAnalysis,
    found: &PathResult,
) -> Vec<Picture> {
    let Some((motion, setting)) = found.motion.as_ref().zip(analysis.setting.motion.as_ref()) else {
        return Vec::new();
    };
    let points = &analysis.track.path.points;
    let groups = PointGroups::of(points.len());
    let position = groups.positions_mm(points);
    let series = |name: &str, of: &dyn Fn(usize) -> f64| Series {
        name: name.to_owned(),
        position: position.clone(),
        deviation_um: groups.largest(of),
    };
    let speed = PathPlot {
        title: format!("{name}: speed"),
        subtitle: subtitle.to_owned(),
        position_label: "along the path (mm)".to_owned(),
        quantity: "speed (mm/s)".to_owned(),
        series: vec![
            series("programmed", &|index| to_mm(motion.feeds[index])),
            series("reached", &|index| to_mm(motion.speeds[index])),
        ],
        envelope: None,
        tolerance_um: None,
    };
    let joints = robot.joints().iter().enumerate();
    let of_joints = joints.filter_map(|(joint, of)| {
        let limit = setting.model.limits.joints[joint].speed;
        limit.is_finite().then(|| {
            series(&of.name, &|index| {
                100.0 * joint_speed(found, motion, index, joint).abs() / limit
            })
        })
    });
    let joint_speeds = PathPlot {
        title: format!("{name}: joint speeds"),
        quantity: "speed of the joint over its greatest (%)".to_owned(),
        series: of_joints.collect(),
        ..speed.clone()
    };
    let picture = |what: &str, caption: &str, plot: &PathPlot| Picture {
        name: format!("{}-{what}", slug(name)),
        caption: format!("{name}: {caption}"),
        svg: plot.to_svg(),
    };
    let mut pictures = vec![picture(
        "speed",
        "programmed feed, and the speed that the controller reaches.",
        &speed,
    )];
    if !joint_speeds.series.is_empty() {
        pictures.push(picture(
            "joint-speeds",
            "speeds of the joints relative to their greatest.",
            &joint_speeds,
        ));
    }
    pictures
}

/// Mean speed of a joint on the way to a point, rad/s (m/s); not a number where it is not known.
fn joint_speed(found: &PathResult, motion: &Motion, index: usize, joint: usize) -> f64 {
    let answers = &found.along.answers;
    let Some(before) = index.checked_sub(1) else {
        return f64::NAN;
    };
    let time = motion.times[index] - motion.times[before];
    let reached = answers.points[index].is_ok() && answers.points[before].is_ok();
    match reached && time > 0.0 {
        true => (answers.joints_at(index)[joint] - answers.joints_at(before)[joint]) / time,
        false => f64::NAN,
    }
}

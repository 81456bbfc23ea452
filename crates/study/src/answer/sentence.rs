//! The answer in one sentence, with its main numbers.
//!
//! ```text
//! NAME, branch BRANCH: 63.2 % of the plane is within 60 µm; the in-plane deviation ranges from 21 to 84 µm (u = 9 µm)
//! and is largest at (900, -200, 800) mm; largest contribution: joint A2 (41 %).
//! ```
//!
//! `u` is the standard uncertainty. If no point is reached, the sentence states that instead.

use super::holes::HolesAnswer;
use super::map::MapAnswer;
use super::path::PathAnswer;
use super::point::PointAnswer;
use super::volume::VolumeAnswer;
use crate::file::resolve::{Study, Subject};

/// The sentence of the first analysis.
pub(super) fn answer(
    study: &Study,
    (maps, paths): (&[MapAnswer], &[PathAnswer]),
    (volumes, holes): (&[VolumeAnswer], &[HolesAnswer]),
) -> String {
    let first = study
        .analyses
        .first()
        .and_then(|analysis| match analysis.subject {
            Subject::Map(_) | Subject::Sections(_) => maps.first().map(|map| of_map(study, map)),
            Subject::Volume(..) => volumes.first().map(|volume| of_volume(study, volume)),
            Subject::Path(_) => paths.first().map(|path| of_path(study, path)),
            Subject::Holes(_) => holes.first().map(|holes| of_holes(study, holes)),
        });
    let sentence = first.unwrap_or_else(|| "The study has no analysis.".to_owned());
    if study.compliance_is_assumed() {
        sentence + " The joint compliances are assumed, not measured."
    } else {
        sentence
    }
}

/// Fraction of a box, and where in it the deviation is largest.
fn of_volume(study: &Study, volume: &VolumeAnswer) -> String {
    let Some(worst) = &volume.worst else {
        return format!(
            "The robot reaches no point of the box ({}, branch {}).",
            volume.name, volume.branch
        );
    };
    format!(
        "{}, branch {}: {:.1} % of the box is within {} µm; the in-plane deviation is at most {} µm (u = {} µm), at ({:.0}, {:.0}, {:.0}) mm; largest contribution: {}.",
        volume.name,
        volume.branch,
        volume.fraction_within * 100.0,
        micrometres(volume.setting.tolerance_um),
        micrometres(worst.in_plane_um),
        micrometres(worst.in_plane_u_um),
        worst.xyz_mm[0],
        worst.xyz_mm[1],
        worst.xyz_mm[2],
        largest_contributor(study, worst, &volume.setting.contributors),
    )
}

/// Fraction of a plane, least and largest deviation, and how many points are outside joint limits.
fn of_map(study: &Study, map: &MapAnswer) -> String {
    let (Some(worst), Some(best)) = (&map.worst, &map.best) else {
        return format!(
            "The robot reaches no point of the plane ({}, branch {}).",
            map.name, map.branch
        );
    };
    let evaluation = match map.fraction_within {
        0.0 => format!(
            "no point on the plane is within {} µm",
            micrometres(map.setting.tolerance_um)
        ),
        1.0 => format!(
            "the whole plane is within {} µm",
            micrometres(map.setting.tolerance_um)
        ),
        fraction => format!(
            "{:.1} % of the plane is within {} µm",
            fraction * 100.0,
            micrometres(map.setting.tolerance_um)
        ),
    };
    let limits = match map.outside_joint_limits {
        0 => String::new(),
        n => format!(
            " ({:.1} % inside joint limits: {n} of {} points are outside)",
            map.fraction_within_and_inside_joint_limits * 100.0,
            map.grid.points
        ),
    };
    format!(
        "{}, branch {}: {evaluation}{limits}; the in-plane deviation ranges from {} to {} µm (u = {} µm) and is largest at ({:.0}, {:.0}, {:.0}) mm; largest contribution: {}.",
        map.name,
        map.branch,
        micrometres(best.in_plane_um),
        micrometres(worst.in_plane_um),
        micrometres(worst.in_plane_u_um),
        worst.xyz_mm[0],
        worst.xyz_mm[1],
        worst.xyz_mm[2],
        largest_contributor(study, worst, &map.setting.contributors),
    )
}

/// Largest deviation along a path with its line, roundness of a circle, and the fraction within the tolerance.
fn of_path(study: &Study, path: &PathAnswer) -> String {
    let Some(worst) = &path.worst else {
        return format!(
            "The robot reaches no point of the path ({}, branch {}).",
            path.name, path.branch
        );
    };
    let (where_to, circle, line) = match &path.program {
        None => ("in the plane", "the circle", String::new()),
        Some(_) => {
            let line = path.worst_points.first().map(|worst| worst.line);
            let line = line.map_or(String::new(), |line| format!(" (line {line})"));
            ("across its axis", "a circle", line)
        }
    };
    let roundness = path.roundness_um.map_or(String::new(), |r| {
        format!("; the roundness deviation of {circle} is {} µm", micrometres(r))
    });
    format!(
        "{}, branch {}: the tool deviates by up to {} µm (u = {} µm) {where_to}{line}{roundness}; largest contribution: {}; {:.1} % of the path is within {} µm.",
        path.name,
        path.followed_branch.as_ref().unwrap_or(&path.branch),
        micrometres(worst.in_plane_um),
        micrometres(worst.in_plane_u_um),
        largest_contributor(study, worst, &path.setting.contributors),
        path.fraction_within * 100.0,
        micrometres(path.setting.tolerance_um),
    )
}

/// How many holes are within the tolerance, the largest deviation with its hole, and what is out of reach.
fn of_holes(study: &Study, holes: &HolesAnswer) -> String {
    let Some(worst) = holes.worst_holes.first() else {
        return format!(
            "The robot reaches none of the {} holes ({}, branch {}).",
            holes.holes, holes.name, holes.branch
        );
    };
    let lost = match holes.unreachable + holes.refused {
        0 => String::new(),
        n => format!("; {n} cannot be drilled"),
    };
    let good = (holes.fraction_within * holes.holes as f64).round();
    format!(
        "{}: {} of {} holes are within {} µm, each in its best posture; hole {} deviates by {} µm (u = {} µm) from its position; largest contribution: {}; holes are up to {} µm too deep or too shallow{lost}.",
        holes.name,
        good,
        holes.holes,
        micrometres(holes.setting.tolerance_um),
        worst.hole,
        micrometres(worst.point.in_plane_um),
        micrometres(worst.point.in_plane_u_um),
        largest_contributor(study, &worst.point, &holes.setting.contributors),
        micrometres(holes.max_depth_um.unwrap_or(0.0)),
    )
}

/// The largest contributor and its share.
pub fn largest_contributor(study: &Study, point: &PointAnswer, contributors: &[String]) -> String {
    point
        .mostly_by(contributors)
        .map_or_else(String::new, |(name, part)| {
            let is_joint = study.robot.robot.joints().iter().any(|joint| joint.name == name);
            let name = format!("{} {name}", if is_joint { "joint" } else { "the" });
            match part {
                Some(part) => format!("{name} ({:.0} %)", part * 100.0),
                None => name,
            }
        })
}

/// A deviation with its significant digits.
pub fn micrometres(um: f64) -> String {
    if um == um.round() && um < 1e6 {
        format!("{um:.0}")
    } else if um.abs() < 10.0 {
        format!("{um:.2}")
    } else {
        format!("{um:.1}")
    }
}

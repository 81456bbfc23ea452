//! The answer in one sentence, with the numbers that carry it.
//!
//! ```text
//! NAME, branch BRANCH: 63.2 % of the plane holds 60 µm; the in-plane deviation goes from 21 µm to 84 ± 9 µm
//! at (900, -200, 800) mm, mostly by joint A2 (41 %).
//! ```
//!
//! After ± stands the standard uncertainty. Where nothing is reached the sentence says that instead.

use super::holes::HolesAnswer;
use super::map::MapAnswer;
use super::path::PathAnswer;
use super::point::PointAnswer;
use super::volume::VolumeAnswer;
use crate::file::resolve::{Study, Subject};

/// The answer to the first thing that was asked.
pub(super) fn answer(
    study: &Study,
    (maps, paths): (&[MapAnswer], &[PathAnswer]),
    (volumes, holes): (&[VolumeAnswer], &[HolesAnswer]),
) -> String {
    let first = study.analyses.first().and_then(|analysis| match analysis.subject {
        Subject::Map(_) | Subject::Sections(_) => maps.first().map(|map| of_map(study, map)),
        Subject::Volume(..) => volumes.first().map(|volume| of_volume(study, volume)),
        Subject::Path(_) => paths.first().map(|path| of_path(study, path)),
        Subject::Holes(_) => holes.first().map(|holes| of_holes(study, holes)),
    });
    let sentence = first.unwrap_or_else(|| "Nothing was asked.".to_owned());
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
        "{}, branch {}: {:.1} % of the box holds {} µm; the in-plane deviation goes up to {} ± {} µm at ({:.0}, {:.0}, {:.0}) mm, mostly by {}.",
        volume.name,
        volume.branch,
        volume.fraction_within * 100.0,
        micrometres(volume.setting.tolerance_um),
        micrometres(worst.in_plane_um),
        micrometres(worst.in_plane_u_um),
        worst.xyz_mm[0],
        worst.xyz_mm[1],
        worst.xyz_mm[2],
        culprit(study, worst, &volume.setting.contributors),
    )
}

/// Fraction of a plane, least and largest deviation, and how many points stand outside joint limits.
fn of_map(study: &Study, map: &MapAnswer) -> String {
    let (Some(worst), Some(best)) = (&map.worst, &map.best) else {
        return format!(
            "The robot reaches no point of the plane ({}, branch {}).",
            map.name, map.branch
        );
    };
    let evaluation = match map.fraction_within {
        0.0 => format!(
            "no point of the plane holds {} µm",
            micrometres(map.setting.tolerance_um)
        ),
        1.0 => format!("the whole plane holds {} µm", micrometres(map.setting.tolerance_um)),
        fraction => format!(
            "{:.1} % of the plane holds {} µm",
            fraction * 100.0,
            micrometres(map.setting.tolerance_um)
        ),
    };
    let limits = match map.outside_joint_limits {
        0 => String::new(),
        n => format!(
            " ({:.1} % inside joint limits: {n} of {} points stand outside)",
            map.fraction_within_and_inside_joint_limits * 100.0,
            map.grid.points
        ),
    };
    format!(
        "{}, branch {}: {evaluation}{limits}; the in-plane deviation goes from {} µm to {} ± {} µm at ({:.0}, {:.0}, {:.0}) mm, mostly by {}.",
        map.name,
        map.branch,
        micrometres(best.in_plane_um),
        micrometres(worst.in_plane_um),
        micrometres(worst.in_plane_u_um),
        worst.xyz_mm[0],
        worst.xyz_mm[1],
        worst.xyz_mm[2],
        culprit(study, worst, &map.setting.contributors),
    )
}

/// Largest deviation along a path with its line, roundness of a circle, and the fraction that holds.
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
        format!(" and makes {circle} {} µm out of round", micrometres(r))
    });
    format!(
        "{}, branch {}: the tool deviates up to {} ± {} µm {where_to}{line}{roundness}, mostly by {}; {:.1} % of the path holds {} µm.",
        path.name,
        path.followed_branch.as_ref().unwrap_or(&path.branch),
        micrometres(worst.in_plane_um),
        micrometres(worst.in_plane_u_um),
        culprit(study, worst, &path.setting.contributors),
        path.fraction_within * 100.0,
        micrometres(path.setting.tolerance_um),
    )
}

/// How many holes hold, the largest deviation with its hole, and what is out of reach.
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
        "{}: {} of {} holes hold {} µm, each in its best posture; hole {} comes out {} ± {} µm beside its place, mostly by {}; holes are up to {} µm too deep or too shallow{lost}.",
        holes.name,
        good,
        holes.holes,
        micrometres(holes.setting.tolerance_um),
        worst.hole,
        micrometres(worst.point.in_plane_um),
        micrometres(worst.point.in_plane_u_um),
        culprit(study, &worst.point, &holes.setting.contributors),
        micrometres(holes.max_depth_um.unwrap_or(0.0)),
    )
}

/// What has the largest share, and how large.
pub(crate) fn culprit(study: &Study, point: &PointAnswer, contributors: &[String]) -> String {
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

/// A deviation with the digits that mean something.
pub(crate) fn micrometres(um: f64) -> String {
    if um == um.round() && um < 1e6 {
        format!("{um:.0}")
    } else if um.abs() < 10.0 {
        format!("{um:.2}")
    } else {
        format!("{um:.1}")
    }
}

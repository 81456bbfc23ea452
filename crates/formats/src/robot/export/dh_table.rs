//! Denavit-Hartenberg table out, as [`crate::robot::dh`] reads it: CSV in mm and degrees, with the convention.
//!
//! | convention | one row is |
//! |---|---|
//! | `standard` | `Rz(theta) Tz(d) Tx(a) Rx(alpha)` |
//! | `modified` (Craig) | `Rx(alpha) Tx(a) Rz(theta) Tz(d)` |
//! | `hayati` | `Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)` |
//!
//! The z axis of a joint is in its positive direction, so that every sign is 1. A row of type `fixed` is in front of the first joint or behind the last
//! one where the base or the flange is not on its axis.

use armill_core::frame::Isometry;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::units::{to_deg, to_mm};

use super::bodies::{JointKind, Linkage};
use super::convention::DhConvention;
use super::dh_rows::{AlongX, AlongZ, Screws, screws};
use super::error::ExportError;
use super::options::{ExportOptions, Exported};
use super::spelling::{comment_line, line, on_one_line};
use crate::robot::RobotDescription;

/// A normal of two axes farther than this is reported, m.
const FAR: f64 = 10.0;

/// The text of a table.
///
/// # Errors
/// Axes without a usable common normal.
pub(super) fn write(
    found: &RobotDescription,
    (linkage, options): (&Linkage, &ExportOptions),
    about: &[String],
) -> Result<Exported, ExportError> {
    let convention = options.convention;
    let (frames, flange) = frames(linkage);
    let name = |axis: usize| match axis.checked_sub(1) {
        None => "base".to_owned(),
        Some(joint) => found
            .robot
            .joints()
            .get(joint)
            .map_or("flange".to_owned(), |joint| joint.name.clone()),
    };
    let screws = screws(&frames, &flange, convention == DhConvention::Hayati).map_err(|far| {
        ExportError::FarNormal {
            first: name(far.axis),
            second: name(far.axis + 1),
            angle_deg: to_deg(far.angle),
            distance: far.distance.abs(),
        }
    })?;
    let mut warnings = Vec::new();
    for (axis, z) in screws.z.iter().enumerate().filter(|(_, z)| z.d.abs() > FAR) {
        warnings.push(format!(
            "parameters change much for a small change of the axes: the common normal of {} and {} is {:.0} m away, \
             because they are nearly parallel; the convention hayati has none",
            name(axis),
            name(axis + 1),
            z.d.abs()
        ));
    }
    let mut text = String::new();
    for content in about.iter().chain(&[
        "Lengths in mm, angles in degrees; a revolute joint adds its position to theta, a prismatic one to d.".to_owned(),
        format!("One row is {}.", convention.product()),
    ]) {
        comment_line(&mut text, content);
    }
    line(&mut text, &format!("name = {}", on_one_line(&found.title)));
    line(&mut text, &format!("convention = {}", convention.name()));
    rows(&mut text, (linkage, convention), &screws);
    Ok(Exported {
        text,
        arguments: None,
        warnings,
    })
}

/// Frames of the joints in base, z along the positive axis, at zero; and the flange.
fn frames(linkage: &Linkage) -> (Vec<Isometry>, Isometry) {
    let mut here = Isometry::identity();
    let mut frames = Vec::new();
    for body in &linkage.bodies {
        here *= body.parent_from_body;
        let mut drives = body.joints.iter();
        if let Some(drive) = drives.find(|joint| matches!(joint.kind, JointKind::Drive(_))) {
            let turn = UnitQuaternion::rotation_between(&Vector3::z(), &drive.axis)
                .unwrap_or_else(|| UnitQuaternion::new(Vector3::x() * std::f64::consts::PI));
            frames.push(here * turn);
        }
    }
    (frames, here)
}

/// Header and rows.
fn rows(text: &mut String, (linkage, convention): (&Linkage, DhConvention), screws: &Screws) {
    let beta = if convention == DhConvention::Hayati {
        ", beta_deg"
    } else {
        ""
    };
    line(
        text,
        &format!("joint, type, theta_deg, d_mm, a_mm, alpha_deg{beta}, sign, lower_deg, upper_deg"),
    );
    let drives: Vec<_> = linkage
        .bodies
        .iter()
        .flat_map(|body| &body.joints)
        .filter_map(|joint| match &joint.kind {
            JointKind::Drive(drive) => Some((joint, drive)),
            JointKind::Follower { .. } | JointKind::Spring { .. } => None,
        })
        .collect();
    let count = drives.len();
    let none = AlongX::default();
    for row in 0..count + 2 {
        let z = screws.z.get(row).copied().unwrap_or_default();
        let behind = screws.x.get(row).copied().unwrap_or(none);
        let before = row.checked_sub(1).and_then(|row| screws.x.get(row)).copied();
        let x = match convention {
            DhConvention::Modified => before.unwrap_or(none),
            DhConvention::Standard | DhConvention::Hayati => behind,
        };
        let joint = row.checked_sub(1).and_then(|index| drives.get(index));
        if joint.is_none() && z == AlongZ::default() && x == none {
            continue;
        }
        let (name, kind) = match joint {
            None if row == 0 => ("base", "fixed"),
            None => ("flange", "fixed"),
            Some((joint, _)) => (
                joint.name.as_str(),
                if joint.slides { "prismatic" } else { "revolute" },
            ),
        };
        let mut cells = vec![
            cell_of(name),
            kind.to_owned(),
            degrees(z.theta),
            millimetres(z.d),
            millimetres(x.a),
            degrees(x.alpha),
        ];
        if convention == DhConvention::Hayati {
            cells.push(degrees(x.beta));
        }
        cells.push("1".to_owned());
        let limits = joint
            .filter(|(joint, _)| !joint.slides)
            .and_then(|(_, drive)| drive.limits);
        match limits {
            Some(limits) => cells.extend([limits.lower, limits.upper].map(degrees)),
            None => cells.extend([String::new(), String::new()]),
        }
        line(text, cells.join(", ").trim_end());
    }
}

/// A length in m as mm, within 1e-15 m.
fn millimetres(m: f64) -> String {
    decimal(format!("{:.12}", to_mm(m)))
}

/// An angle in rad as degrees, within 1e-15 rad.
fn degrees(rad: f64) -> String {
    decimal(format!("{:.13}", to_deg(rad)))
}

/// Without zeros at its end.
fn decimal(text: String) -> String {
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" | "" => "0".to_owned(),
        text => text.to_owned(),
    }
}

/// A name without what separates cells.
fn cell_of(name: &str) -> String {
    let separates = |c: char| matches!(c, ',' | ';' | '#' | '"') || c.is_control();
    name.chars().map(|c| if separates(c) { '_' } else { c }).collect()
}

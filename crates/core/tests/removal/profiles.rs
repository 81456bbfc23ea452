//! The profile that each kind of tool leaves, against its formula.

use armill_core::load::EndMillBody;
use armill_core::nalgebra::Vector3;
use armill_core::removal::{DexelDirections, DexelPart, ToolSolid};

use super::{MM, at, block, cut, end_mill, moves, top};

/// A groove along x in the middle of a block, whose lowest point is at z = 5 mm.
fn groove(tool: &ToolSolid) -> DexelPart {
    let part = block([10.0, 30.0, 20.0], 0.1, DexelDirections::All);
    cut(
        part,
        &moves(&[at(-30.0, 15.0, 5.0), at(40.0, 15.0, 5.0)], Vector3::z_axis()),
        tool,
    )
    .0
}

/// Heights of the floor of the groove at distances from its middle (half a cell off), mm, against a formula.
fn compare(part: &DexelPart, formula: impl Fn(f64) -> f64) {
    for n in 0..70 {
        let off = 0.05 + 0.1 * f64::from(n);
        let expected = 5.0 + formula(off);
        let found = top(part, 5.0, 15.0 + off).unwrap();
        // Single precision of 20 mm, and what is left out below it: 4 nm in all, more where walls are steep.
        assert!(
            (found - expected.min(20.0)).abs() < 1e-4,
            "{off}: {found} {expected}"
        );
    }
}

#[test]
fn a_bull_nose_leaves_a_flat_floor_and_rounded_edges() {
    let (radius, corner) = (6.0, 2.5);
    let part = groove(&end_mill(2.0 * radius, corner, 40.0));
    compare(&part, |off| {
        let out = (off - (radius - corner)).max(0.0);
        if off > radius {
            20.0
        } else {
            corner - (corner * corner - out * out).sqrt()
        }
    });
}

#[test]
fn a_tapered_ball_leaves_an_arc_and_its_tangents() {
    let (radius, angle) = (2.0_f64, 15_f64.to_radians());
    let body = EndMillBody::new(2.0 * radius * MM, radius * MM).unwrap();
    let part = groove(&ToolSolid::tapered(&body, angle, 40.0 * MM).unwrap());
    // A tangent cone: its surface is at the distance radius from the centre of the ball along its normal.
    compare(&part, |off| {
        if off < radius * angle.cos() {
            radius - (radius * radius - off * off).sqrt()
        } else {
            radius - radius / angle.sin() + off / angle.tan()
        }
    });
}

#[test]
fn a_tapered_cutter_leaves_straight_flanks() {
    let angle = 30_f64.to_radians();
    let body = EndMillBody::new(4.0 * MM, 0.0).unwrap();
    let part = groove(&ToolSolid::tapered(&body, angle, 40.0 * MM).unwrap());
    compare(&part, |off| ((off - 2.0) / angle.tan()).max(0.0));
}

#[test]
fn a_tapered_bull_nose_leaves_floor_arc_and_flank() {
    let (radius, corner, angle) = (4.0, 1.5, 20_f64.to_radians());
    let body = EndMillBody::new(2.0 * radius * MM, corner * MM).unwrap();
    let part = groove(&ToolSolid::tapered(&body, angle, 40.0 * MM).unwrap());
    compare(&part, |off| {
        let out = off - (radius - corner);
        if out < 0.0 {
            0.0
        } else if out < corner * angle.cos() {
            corner - (corner * corner - out * out).sqrt()
        } else {
            corner - corner * angle.sin() + (out - corner * angle.cos()) / angle.tan()
        }
    });
}

#[test]
fn normals_of_a_groove_are_those_of_its_profile() {
    let (radius, corner) = (6.0, 2.5);
    let tool = end_mill(2.0 * radius, corner, 40.0);
    let part = groove(&tool);
    let path = moves(&[at(-30.0, 15.0, 5.0), at(40.0, 15.0, 5.0)], Vector3::z_axis());
    let mut seen = 0;
    for point in part.surface() {
        if !matches!(point.origin, armill_core::removal::EndOrigin::Move(_)) {
            continue;
        }
        let off = point.position.y / MM - 15.0;
        let out = off.abs() - (radius - corner);
        let normal = path[0].surface_normal(&tool, 1e-5, &point.position).unwrap();
        // Out of the material: towards the middle of the groove and up.
        let expected = if out <= 0.0 {
            Vector3::z()
        } else {
            let y = (out / corner).min(1.0);
            Vector3::new(0.0, -y * off.signum(), (1.0 - y * y).sqrt())
        };
        // Where the profile is a wall, single precision across it is a slope of sqrt(2 * 2 nm / 2.5 mm).
        assert!(
            (normal.into_inner() - expected).norm() < 2e-3,
            "{point:?} {normal:?}"
        );
        seen += 1;
    }
    assert!(seen > 10_000);
}

#[test]
fn an_oblique_move_of_a_ball_leaves_a_cylinder_about_its_path() {
    // Down by 10 in 40 mm: the distance of each point of the groove from the line of centres is the radius.
    let part = block([40.0, 30.0, 20.0], 0.2, DexelDirections::All);
    let (from, to) = (at(-20.0, 15.0, 20.0), at(60.0, 15.0, 0.0));
    let tool = end_mill(8.0, 4.0, 60.0);
    let (part, _) = cut(part, &moves(&[from, to], Vector3::z_axis()), &tool);
    let centre = from + Vector3::z() * 4.0 * MM;
    let direction = (to - from).normalize();
    let mut seen = 0;
    for point in part.surface() {
        let off = point.position - centre;
        let along = off.dot(&direction);
        let from_line = off - direction * along;
        // Below the line of centres the ball cuts, above it the cylinder of the cutter.
        if matches!(point.origin, armill_core::removal::EndOrigin::Move(_)) && from_line.z < -1e-6 {
            assert!((from_line.norm() / MM - 4.0).abs() < 1e-5, "{:?}", point.position);
            seen += 1;
        }
    }
    assert!(seen > 5_000, "{seen}");
}

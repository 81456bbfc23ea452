//! G2 and G3.

use std::f64::consts::{PI, TAU};

use armill_core::nalgebra::{Point3, Rotation3, Vector3};

use super::program::{arc_of, path};

#[test]
fn arcs_by_radius_and_by_centre_are_the_same() {
    let centre = path("G21 F60\nG0 X10 Y0\nG3 X0 Y10 I-10 J0\nG2 X10 Y0 I0 J-10\nG90.1 G3 X0 Y10 I0 J0\n");
    let radius = path("G21 F60\nG0 X10 Y0\nG3 X0 Y10 R10\nG2 X10 Y0 R10\nG3 X0 Y10 R10\n");
    for (one, other) in centre.moves.iter().zip(&radius.moves).skip(1) {
        let (one, other) = (arc_of(one), arc_of(other));
        // Centres by root: a few roundings of 10 mm.
        assert!((one.centre - other.centre).norm() < 1e-16 * 10.0);
        assert!((one.sweep - PI / 2.0).abs() < 1e-15 && (other.sweep - PI / 2.0).abs() < 1e-14);
        assert_eq!(one.axis, other.axis);
    }
}

#[test]
fn arcs_turn_by_the_right_hand_about_the_axis_of_their_plane() {
    for (plane, axis, program) in [
        ("G17", Vector3::z(), "G0 X10 Y0\nG3 X0 Y10 I-10"),
        ("G18", Vector3::y(), "G0 Z10 X0\nG3 Z0 X10 K-10"),
        ("G19", Vector3::x(), "G0 Y10 Z0\nG3 Y0 Z10 J-10"),
    ] {
        let path = path(&format!("G21 F60 {plane}\n{program}\n"));
        let [.., from, next] = path.moves.as_slice() else {
            panic!("two moves")
        };
        let arc = arc_of(next);
        assert_eq!(arc.axis.into_inner(), axis, "{plane}");
        let turned = Rotation3::from_axis_angle(&arc.axis, arc.sweep) * (from.end - arc.centre);
        assert!(
            (arc.centre + turned - next.end).norm() < 1e-16,
            "{plane}: a rounding of 10 mm"
        );
    }
}

#[test]
fn turns_and_rise_make_a_helix() {
    let path = path("G21 F60 G0 X10 Y0 Z0\nG2 I-10 Z-6 P3\n");
    let arc = arc_of(&path.moves[1]);
    assert_eq!(arc.sweep, 3.0 * TAU);
    assert_eq!(arc.axis.into_inner(), -Vector3::z());
    assert_eq!(path.moves[1].end, Point3::new(10e-3, 0.0, -6e-3));
}

//! CIRCLE: how far an arc turns.

use std::f64::consts::{PI, TAU};

use armill_core::nalgebra::{Rotation3, Vector3};

use super::{arc, problems, read_all};

#[test]
fn full_turns_small_arcs_and_large_arcs_follow_the_right_hand() {
    let at = |degrees: f64| {
        let angle = degrees.to_radians();
        format!("GOTO/{:.6},{:.6},0", 10.0 * angle.cos(), 10.0 * angle.sin())
    };
    for (k, from, to, expected) in [
        (1.0, 0.0, 0.0, 360.0),
        (1.0, 0.0, 30.0, 30.0),
        (-1.0, 0.0, 30.0, 330.0),
        (1.0, 200.0, 100.0, 260.0),
        (-1.0, 200.0, 200.0, 360.0),
    ] {
        let text = format!("UNIT/MM\n{}\nCIRCLE/0,0,0,0,0,{k}\n{}\n", at(from), at(to));
        let (_, _, moves) = read_all(&text);
        // Six decimals on a radius of 10 mm.
        assert!(
            (arc(&moves[1]).sweep.to_degrees() - expected).abs() < 1e-5,
            "{text}"
        );
    }
}

#[test]
fn an_arc_whose_ends_differ_in_radius_alone_is_a_full_turn() {
    // Found by fuzzing: the angle between the ends was 0.
    let text = "UNIT/MM\nGOTO/109.75,59.5,-7.\nCIRCLE/59.5,59.5,-7.,0,0,1.\nGOTO/109.76,59.5,-7.\n";
    let (_, _, moves) = read_all(text);
    assert_eq!(arc(&moves[1]).sweep, TAU);
}

#[test]
fn the_sweep_turns_the_start_into_the_end_about_any_axis() {
    for seed in 0..50 {
        let part = |k: f64| (f64::from(seed) * k).sin();
        let turn = Rotation3::from_euler_angles(3.0 * part(1.1), 3.0 * part(2.3), 3.0 * part(3.7));
        let centre = Vector3::new(50.0 * part(0.7), 50.0 * part(0.9), 50.0 * part(1.3));
        let (radius, sweep) = (20.0 + 10.0 * part(5.1), PI + 3.0 * part(4.1));
        let on = |angle: f64| centre + turn * Vector3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
        let (a, b, n) = (on(0.3), on(0.3 + sweep), turn * Vector3::z());
        let three = |v: Vector3<f64>| format!("{:.9},{:.9},{:.9}", v.x, v.y, v.z);
        let text = format!(
            "UNIT/MM\nGOTO/{}\nCIRCLE/{},{}\nGOTO/{}\n",
            three(a),
            three(centre),
            three(n),
            three(b)
        );
        let (_, _, moves) = read_all(&text);
        // Nine decimals of millimetres on at least 10 mm.
        assert!((arc(&moves[1]).sweep - sweep).abs() < 1e-8, "{text}");
    }
}

#[test]
fn a_helix_has_the_turns_that_are_written() {
    let helix = |times: &str, end: &str| {
        format!(
            "UNITS/MM\nGOTO/5.0,0.0,0.0\nCIRCLE/0.0,0.0,0.0,0.0,0.0,1.0,5.0,0.01,0.01,4.0,0.0,TIMES,{times}\nGOTO/{end}\n"
        )
    };
    let (_, _, moves) = read_all(&helix("3", "5.0,0.0,-3.0"));
    assert!((arc(&moves[1]).sweep - 3.0 * TAU).abs() < 1e-12);
    let (_, _, moves) = read_all(&helix("2.25", "0.0,5.0,-3.0"));
    assert!((arc(&moves[1]).sweep - 2.25 * TAU).abs() < 1e-12);
    let given = problems(&helix("2", "0.0,5.0,-3.0"));
    assert!(
        given.contains("a helix of 2 turns that ends 90.000 deg from"),
        "{given}"
    );
    assert!(problems(&helix("1e9", "5.0,0.0,-3.0")).contains("is not between 0 and 10000"));
}

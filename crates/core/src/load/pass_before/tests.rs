use super::*;
use crate::load::Lean;

const MM: f64 = 1e-3;

#[test]
fn the_profile_is_the_farthest_point_of_the_body_below_a_height() {
    let ball = EndMillBody::new(12.0 * MM, 6.0 * MM).unwrap();
    let bull = EndMillBody::new(25.0 * MM, 5.0 * MM).unwrap();
    let leans = [
        (0.0, 0.0),
        (1e-7, 0.0),
        (1e-3, -1e-3),
        (0.02, 0.0),
        (0.3, 0.0),
        (-0.2, 0.4),
        (0.1, -0.5),
        (0.6, 0.6),
    ];
    for (lead, tilt) in leans {
        let lean = Lean { lead, tilt };
        for body in [&ball, &bull] {
            let profiles = [-1.0, 1.0].map(|side| Profile::of(body, &lean.axis(), &(Vector3::y() * side)));
            for height in [0.02, 0.1, 0.5, 1.0, 2.3, 4.0, 7.0].map(|height| height * MM) {
                let [right, left] = body.extent(lean, height);
                let found = profiles.map(|profile| profile.reach(height));
                // The spline of a bull nose of 25 mm: less than a micrometre where the flat bottom passes.
                let tolerance = if body.flat_radius() > 0.0 { 1e-6 } else { 1e-11 };
                assert!(
                    (found[0] + right).abs() < tolerance && (found[1] - left).abs() < tolerance,
                    "{lean:?} {height}: {found:?} {right} {left}"
                );
            }
        }
    }
}

#[test]
fn arcs_are_cut_where_a_point_passes_the_profile_even_twice_between_samples() {
    let parabola = |phi: f64| (phi - 0.62) * (phi - 0.62) - 1e-4;
    let samples = [0.4, 0.6, 0.8].map(|phi| [phi, parabola(phi)]);
    let turn = turn(samples).unwrap();
    assert!((turn - 0.62).abs() < 1e-12);
    let between = |from: f64, to: f64| crossing(&parabola, [from, to].map(|phi| [phi, parabola(phi)]), CLOSE);
    assert!((between(0.4, turn) - 0.61).abs() < 1e-12 && (between(turn, 0.8) - 0.63).abs() < 1e-12);
    // No turn: rising samples, and samples on both sides.
    assert_eq!(super::turn([[0.0, 1.0], [1.0, 2.0], [2.0, 3.0]]), None);
    assert_eq!(super::turn([[0.0, 1.0], [1.0, -2.0], [2.0, 3.0]]), None);
}

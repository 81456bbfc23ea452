use std::f64::consts::TAU;

use nalgebra::UnitQuaternion;

use super::*;

/// A line of 1 m along x, a point every 10 mm.
fn line() -> Vec<Vector3<f64>> {
    (0..=100)
        .map(|k| Vector3::new(f64::from(k) * 0.01, 0.0, 0.0))
        .collect()
}

/// A run along x from before the line to after it, sampled every `step`, with this offset.
fn run(step: f64, offset: impl Fn(f64) -> [f64; 2]) -> Vec<Vector3<f64>> {
    let count = (1.1 / step) as usize;
    (0..=count)
        .map(|k| {
            let x = -0.05 + k as f64 * step;
            let [y, z] = offset(x);
            Vector3::new(x, y, z)
        })
        .collect()
}

#[test]
fn runs_with_an_offset_from_a_line_deviate_by_the_offset() {
    // Sampled each with its own step: 3, 7 and 11 mm. Offsets 1, 2 and 6 um in y: mean 3, distances 2, 1, 3.
    let runs = [(3e-3, 1e-6), (7e-3, 2e-6), (11e-3, 6e-6)].map(|(step, y)| run(step, |_| [y, 0.0]));
    let found = path_accuracy(&line(), &runs).unwrap();
    assert_eq!((found.points.len(), found.not_passed, found.cycles), (101, 0, 3));
    for point in &found.points {
        assert!((point.offset - Vector3::new(0.0, 3e-6, 0.0)).norm() < 1e-15);
        // Mean 2, deviations 0, -1, 1: S = 1.
        assert!((point.repeatability.unwrap() - 5e-6).abs() < 1e-15);
    }
    assert!((found.accuracy().unwrap().1 - 3e-6).abs() < 1e-15);
}

#[test]
fn the_largest_is_found_where_it_is() {
    // A bump of 20 um at 0.4 m, on one of two runs: the barycentre has half of it.
    let bump = |x: f64| [if (x - 0.4).abs() < 0.02 { 20e-6 } else { 0.0 }, 0.0];
    let found = path_accuracy(&line(), &[run(1e-3, bump), run(1e-3, |_| [0.0, 0.0])]).unwrap();
    let (at, most) = found.accuracy().unwrap();
    assert!((most - 10e-6).abs() < 1e-12);
    assert!((found.points[at].commanded.x - 0.4).abs() < 0.02);
    // Both 10 um from the barycentre: no scatter of the distances.
    assert!((found.repeatability().unwrap().1 - 10e-6).abs() < 1e-12);
    let one = path_accuracy(&line(), &[run(1e-3, bump)]).unwrap();
    assert!(one.repeatability().is_none() && (one.accuracy().unwrap().1 - 20e-6).abs() < 1e-12);
}

#[test]
fn the_sampling_of_a_run_along_the_path_has_no_effect() {
    // An offset along the path is not an error: in the plane across the path the run is on it.
    let dense = run(0.5e-3, |x| [1e-5 * x, 2e-5 * x]);
    let sparse = run(20e-3, |x| [1e-5 * x, 2e-5 * x]);
    let [a, b] = [dense, sparse].map(|run| path_accuracy(&line(), &[run]).unwrap());
    for (a, b) in a.points.iter().zip(&b.points) {
        assert!((a.offset - b.offset).norm() < 1e-15);
    }
}

/// Two turns of a helix of radius 0.1 m, 0.05 m a turn, and the same with another radius and lifted.
fn helix(count: usize, [wider, higher]: [f64; 2], from: f64) -> Vec<Vector3<f64>> {
    (0..=count)
        .map(|k| {
            let a = from + (2.0 * TAU - 2.0 * from) * k as f64 / count as f64;
            Vector3::new(
                (0.1 + wider) * a.cos(),
                (0.1 + wider) * a.sin(),
                0.05 * a / TAU + higher,
            )
        })
        .collect()
}

#[test]
fn a_helix_that_is_wider_is_off_by_that_on_every_turn() {
    let commanded = helix(720, [0.0, 0.0], 0.0);
    // Runs begin a little before and end a little after.
    let runs = [helix(5000, [30e-6, 0.0], -0.1), helix(7001, [50e-6, 0.0], -0.1)];
    let found = path_accuracy(&commanded, &runs).unwrap();
    assert_eq!(found.not_passed, 0);
    for point in &found.points {
        // Chords of 5000 points of two turns are 0.08 um inside the curve. The tangent of an end is that of its piece,
        // off by half a degree: 0.4 um of 40.
        let off = if point.index % 720 == 0 { 0.5e-6 } else { 0.2e-6 };
        let outward = Vector3::new(point.commanded.x, point.commanded.y, 0.0).normalize();
        assert!((point.offset - outward * 40e-6).norm() < off, "{}", point.index);
        assert!((point.repeatability.unwrap() - 10e-6).abs() < 0.2e-6);
    }
}

#[test]
fn rotation_and_shift_have_no_effect() {
    let turn = UnitQuaternion::from_euler_angles(0.3, -1.1, 2.0);
    let moved = |all: Vec<Vector3<f64>>| -> Vec<Vector3<f64>> {
        all.into_iter()
            .map(|x| turn * x + Vector3::new(2.0, -1.0, 0.4))
            .collect()
    };
    let runs = || {
        [
            helix(5000, [30e-6, 5e-6], -0.1),
            helix(4001, [50e-6, -9e-6], -0.1),
        ]
    };
    let here = path_accuracy(&helix(300, [0.0; 2], 0.0), &runs()).unwrap();
    let there = path_accuracy(&moved(helix(300, [0.0; 2], 0.0)), &runs().map(moved)).unwrap();
    for (a, b) in here.points.iter().zip(&there.points) {
        assert!((turn * a.offset - b.offset).norm() < 1e-12);
    }
}

#[test]
fn a_second_lap_is_not_mistaken_for_the_first() {
    // Two laps of a circle; the second lap of the run is 100 um wider.
    let lap = |count: usize, wider: f64, from: f64, to: f64| -> Vec<Vector3<f64>> {
        (0..=count)
            .map(|k| {
                let a = from + (to - from) * k as f64 / count as f64;
                let r = 0.1 + if a > TAU { wider } else { 0.0 };
                Vector3::new(r * a.cos(), r * a.sin(), 0.0)
            })
            .collect()
    };
    let commanded = lap(720, 0.0, 0.0, 2.0 * TAU);
    let found = path_accuracy(&commanded, &[lap(9000, 1e-4, -0.05, 2.0 * TAU + 0.05)]).unwrap();
    for point in &found.points {
        let wider = if point.index > 362 { 1e-4 } else { 0.0 };
        let is_seam = (358..=364).contains(&point.index);
        assert!(
            is_seam || (point.offset.norm() - wider).abs() < 1e-7,
            "{}: {}",
            point.index,
            point.offset.norm()
        );
    }
}

#[test]
fn ends_that_a_run_does_not_pass_are_not_reported_and_errors_name_their_reason() {
    let short: Vec<Vector3<f64>> = run(1e-3, |_| [1e-6, 0.0])
        .into_iter()
        .filter(|x| x.x > 0.105 && x.x < 0.895)
        .collect();
    let found = path_accuracy(&line(), &[short, run(1e-3, |_| [1e-6, 0.0])]).unwrap();
    assert_eq!((found.points[0].index, found.not_passed), (11, 22));
    let none: Vec<Vec<Vector3<f64>>> = Vec::new();
    assert_eq!(path_accuracy(&line(), &none), Err(PathRefusal::NoRun));
    assert_eq!(path_accuracy(&line()[..1], &none), Err(PathRefusal::Short(1)));
    let point = vec![vec![Vector3::zeros()]];
    let refused = path_accuracy(&line(), &point).unwrap_err();
    assert_eq!(refused, PathRefusal::ShortRun { run: 0, points: 1 });
    let away: Vec<Vector3<f64>> = run(1e-3, |_| [0.0, 0.0])
        .iter()
        .map(|x| x + Vector3::x() * 9.0)
        .collect();
    assert_eq!(path_accuracy(&line(), &[away]), Err(PathRefusal::Elsewhere));
}

/// Noise of at most `size`, hashed.
fn noise(k: usize, size: f64) -> Vector3<f64> {
    let part = |n: u64| {
        let hashed = (3 * k as u64 + n + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let hashed = (hashed ^ (hashed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((hashed ^ (hashed >> 32)) >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    Vector3::new(part(0), part(1), part(2)) * size
}

#[test]
fn a_densely_sampled_run_with_noise_along_the_path_is_followed() {
    // Steps of 10 um with noise of 15 um, along the path too.
    let noisy: Vec<Vector3<f64>> = run(10e-6, |_| [50e-6, 0.0])
        .iter()
        .enumerate()
        .map(|(k, x)| x + noise(k, 15e-6))
        .collect();
    let found = path_accuracy(&line(), &[noisy]).unwrap();
    assert_eq!(found.not_passed, 0);
    for point in &found.points {
        assert!((point.offset.y - 50e-6).abs() < 16e-6 && point.offset.z.abs() < 16e-6);
    }
}

#[test]
fn a_point_given_twice_keeps_the_index_of_the_others() {
    let mut twice = line();
    twice.insert(40, twice[40]);
    let found = path_accuracy(&twice, &[run(1e-3, |_| [1e-6, 0.0])]).unwrap();
    let indices: Vec<usize> = found.points.iter().map(|point| point.index).collect();
    assert_eq!(indices, (0..=101).filter(|k| *k != 41).collect::<Vec<_>>());
}

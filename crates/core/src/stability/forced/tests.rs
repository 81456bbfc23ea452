use nalgebra::Vector3;

use super::*;
use crate::load::{Cutter, Hand, Immersion};
use crate::stability::examples::{benchmark, benchmark_mode, cutting, mode, rpm};

/// Displacement at the angle `at` after the transient has decayed, by Runge-Kutta in time under the force of the rigid cut.
fn simulated(modes: &[Mode], milling: &Milling, spindle: f64, at: f64) -> Vector3<f64> {
    let period = milling.cutter().pitch() / spindle;
    let steps = 4000;
    let h = period / f64::from(steps);
    let mut x: Vec<[f64; 2]> = vec![[0.0; 2]; modes.len()];
    let slowest = modes
        .iter()
        .map(|m| m.angular_frequency * m.damping_ratio)
        .fold(f64::MAX, f64::min);
    let periods = (16.0 / (slowest * period)).ceil() as usize;
    let last = ((at / milling.cutter().pitch()).rem_euclid(1.0) * f64::from(steps)).round() as usize;
    let forces: Vec<Vector3<f64>> = (0..=2 * steps)
        .map(|half| milling.force_at(spindle * 0.5 * h * f64::from(half)))
        .collect();
    for step in 0..periods * steps as usize + last {
        let here = 2 * (step % steps as usize);
        let slope = |x: &[[f64; 2]], load: Vector3<f64>| -> Vec<[f64; 2]> {
            let of_mode = |(mode, x): (&Mode, &[f64; 2])| {
                let (w, zeta) = (mode.angular_frequency, mode.damping_ratio);
                [
                    x[1],
                    mode.shape.fixed_rows::<3>(0).dot(&load) - 2.0 * zeta * w * x[1] - w * w * x[0],
                ]
            };
            modes.iter().zip(x).map(of_mode).collect()
        };
        let plus = |k: &[[f64; 2]], part: f64| -> Vec<[f64; 2]> {
            x.iter()
                .zip(k)
                .map(|(x, k)| [x[0] + part * k[0], x[1] + part * k[1]])
                .collect()
        };
        let k1 = slope(&x, forces[here]);
        let k2 = slope(&plus(&k1, 0.5 * h), forces[here + 1]);
        let k3 = slope(&plus(&k2, 0.5 * h), forces[here + 1]);
        let k4 = slope(&plus(&k3, h), forces[here + 2]);
        for (index, x) in x.iter_mut().enumerate() {
            for part in 0..2 {
                x[part] += h / 6.0
                    * (k1[index][part] + 2.0 * k2[index][part] + 2.0 * k3[index][part] + k4[index][part]);
            }
        }
    }
    modes
        .iter()
        .zip(&x)
        .map(|(mode, x)| mode.shape.fixed_rows::<3>(0) * x[0])
        .sum()
}

#[test]
fn the_error_of_a_wall_is_that_of_a_simulation_in_time() {
    let modes = [
        mode([700.0, 0.03], Vector3::new(0.4, 4.0, 0.0)),
        mode([950.0, 0.04], Vector3::new(3.0, -0.5, 0.0)),
    ];
    for (immersion, side, angle) in [
        (Immersion::Up(0.002), WallSide::Left, 0.0),
        (Immersion::Down(0.002), WallSide::Right, PI),
    ] {
        let cut = cutting(Cutter::flat(0.02, 2).unwrap(), immersion, [600e6, 200e6, 0.0]);
        let milling = cut.at_depth(1e-3).unwrap();
        let spindle = rpm(9700.0);
        let forced = Forced::new(&modes, &milling, spindle).unwrap();
        let there = simulated(&modes, &milling, spindle, angle);
        let sign = if side == WallSide::Left { 1.0 } else { -1.0 };
        let error = forced.surface_error(side).at_tip;
        // 512 values of a force that begins or ends with a jump in one of them.
        let size = forced.amplitude().y;
        assert!(
            (error - sign * there.y).abs() < 0.01 * size,
            "{immersion:?}: {error} {} of {size}",
            there.y
        );
    }
}

#[test]
fn far_below_its_frequency_a_mode_follows_the_force_and_the_mean_is_static() {
    let stiff = mode([50_000.0, 0.05], Vector3::new(0.0, 1.0, 0.0));
    let cut = cutting(
        Cutter::flat(0.02, 2).unwrap(),
        Immersion::Slot,
        [600e6, 200e6, 0.0],
    );
    let milling = cut.at_depth(1e-3).unwrap();
    let forced = Forced::new(&[stiff], &milling, rpm(600.0)).unwrap();
    let compliance = 1.0 / stiff.angular_frequency.powi(2);
    for angle in [0.3, 1.0, 2.0] {
        let still = milling.force_at(angle).y * compliance;
        assert!(
            (forced.at_angle(angle).y - still).abs() < 1e-3 * still.abs(),
            "{angle}"
        );
    }
    let mean = milling.mean_force().y * compliance;
    assert!((forced.mean().y / mean - 1.0).abs() < 1e-4);
}

#[test]
fn a_resonance_of_the_teeth_is_the_largest_and_a_helix_spreads_the_error_over_the_height() {
    let cut = benchmark(Immersion::Down(0.001)).at_depth(1e-3).unwrap();
    let sizes = [12_000.0, 13_830.0, 16_000.0].map(|speed| {
        Forced::new(&[benchmark_mode()], &cut, rpm(speed))
            .unwrap()
            .amplitude()
            .x
    });
    // 922 Hz is twice the tooth passing frequency of 13 830 rpm.
    assert!(
        sizes[1] > 3.0 * sizes[0] && sizes[1] > 3.0 * sizes[2],
        "{sizes:?}"
    );
    let cutter = Cutter::flat(0.02, 2)
        .unwrap()
        .with_helix(0.6, Hand::Right)
        .unwrap();
    let wound = cutting(cutter, Immersion::Down(0.001), [600e6, 200e6, 0.0])
        .at_depth(0.01)
        .unwrap();
    let across = mode([700.0, 0.03], Vector3::y());
    let error = Forced::new(&[across], &wound, rpm(9700.0))
        .unwrap()
        .surface_error(WallSide::Right);
    assert!(error.least < error.greatest && error.least <= error.at_tip && error.at_tip <= error.greatest);
}

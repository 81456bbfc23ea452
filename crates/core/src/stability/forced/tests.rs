use nalgebra::Vector3;

use super::*;
use crate::load::{Cut, Cutter, CuttingLaw, Engagement, Hand, Immersion, LeanInCut, Mechanistic};
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

#[test]
fn one_mode_under_straight_teeth_follows_the_sum_of_its_harmonics() {
    // Slot, two straight teeth, shear force alone. The tooth at the angle p is at (R sin p, R cos p) and moves along (cos p, -sin p): the
    // force on the tool is K_t b f sin p against that and K_r b f sin p towards the axis, across the feed
    // b f (K_t sin^2 p - K_r sin p cos p) = b f/2 (K_t - K_t cos 2p - K_r sin 2p). One of the two teeth is in the cut at any time.
    let (shear, radial, depth, feed) = (700e6, 210e6, 2e-3, 1e-4);
    let law = CuttingLaw::Mechanistic(
        Mechanistic::new(Vector3::new(shear, radial, 0.0), Vector3::zeros()).unwrap(),
    );
    let cutter = Cutter::flat(10e-3, 2).unwrap();
    let cut = Cut {
        depth,
        engagement: Engagement::of(Immersion::Slot, cutter.diameter()).unwrap(),
        feed,
        rise: 0.0,
        lean: LeanInCut::default(),
    };
    let milling = Milling::new(cutter, law, cut).unwrap();
    let (frequency, damping, mass, speed) = (70.0, 0.04, 30.0, TAU * 9.0);
    let omega = TAU * frequency;
    let mode = Mode {
        angular_frequency: omega,
        damping_ratio: damping,
        shape: nalgebra::Vector6::new(0.0, 1.0 / f64::sqrt(mass), 0.0, 0.0, 0.0, 0.0),
    };
    let size = depth * feed / 2.0 * f64::hypot(shear, radial);
    let passing = 2.0 * speed;
    let gain = 1.0 / (mass * f64::hypot(omega * omega - passing * passing, 2.0 * damping * omega * passing));
    let forced = Forced::new(&[mode], &milling, speed).unwrap();
    let found = [forced.largest_in_plane(), forced.amplitude().y];
    // 512 angles: at most half a step from the extreme.
    for found in found {
        assert!(
            (found / (size * gain) - 1.0).abs() < 3e-5,
            "{found} {}",
            size * gain
        );
    }
    let mean = forced.mean().y * mass * omega * omega;
    assert!((mean / (depth * feed / 2.0 * shear) - 1.0).abs() < 1e-9, "{mean}");
    // Walls: made where tooth 0 is at 0 and at 180 deg, both the same place in a period of half a turn; without the mean they are opposite.
    let still = forced.clone().without_mean();
    assert_eq!(still.mean(), Vector3::zeros());
    let walls = [WallSide::Left, WallSide::Right].map(|side| still.surface_error(side));
    assert!((walls[0].at_tip + walls[1].at_tip).abs() < 1e-12 * size * gain + 1e-18);
    let lag = f64::atan2(2.0 * damping * omega * passing, omega * omega - passing * passing);
    let expected = -depth * feed / 2.0 * gain * (shear * f64::cos(lag) - radial * f64::sin(lag));
    assert!(
        (walls[0].at_tip / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        walls[0].at_tip
    );
    assert_eq!(walls[0].largest(), expected.signum() * walls[0].at_tip.abs());
    assert_eq!(
        WallSide::of(&milling).collect::<Vec<_>>(),
        [WallSide::Left, WallSide::Right]
    );
}

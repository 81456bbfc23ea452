use nalgebra::Vector3;

use super::*;
use crate::load::{Cutter, Hand, Immersion};
use crate::stability::examples::{arm_and_cutter, benchmark, benchmark_mode, cutting, mode, rpm};
use crate::stability::{ZerothOrder, multi_frequency};

/// Growth over the last periods of the delayed equations, integrated in time by the classical Runge-Kutta method.
///
/// Straight teeth alone; nothing is shared with the solution under test: the angle of each tooth is followed, its factor computed at that
/// angle, and the delayed displacement taken from a record.
fn growth(modes: &[Mode], cut: &CutOfAnyDepth, spindle: f64, depth: f64) -> f64 {
    let cutter = *cut.milling().cutter();
    let shear = cut.milling().law().by_thickness(1e-4);
    let arc = cut.milling().cut().engagement.arc_at(cutter.radius()).unwrap();
    let period = cutter.pitch() / spindle;
    let fastest = modes
        .iter()
        .map(|mode| mode.angular_frequency)
        .fold(0.0, f64::max);
    let steps = ((fastest * period / 0.05).ceil() as usize).max(600);
    let h = period / steps as f64;
    let force = |t: f64, change: Vector3<f64>| {
        let mut sum = Vector3::zeros();
        for tooth in 0..cutter.flutes() {
            let phi = (spindle * t - f64::from(tooth) * cutter.pitch()).rem_euclid(TAU);
            if phi < arc.entry || phi > arc.exit {
                continue;
            }
            let (sin, cos) = phi.sin_cos();
            let chip = change.x * sin + change.y * cos;
            let [ft, fr, fa] = [shear.x, shear.y, shear.z].map(|k| k * chip * depth);
            sum += Vector3::new(-ft * cos - fr * sin, ft * sin - fr * cos, -fa);
        }
        sum
    };
    let tip = |x: &[[f64; 2]]| -> Vector3<f64> {
        let parts = modes.iter().zip(x);
        parts.map(|(mode, x)| mode.shape.fixed_rows::<3>(0) * x[0]).sum()
    };
    // Record of the tip at whole and half steps of the period before.
    let mut before = vec![Vector3::zeros(); 2 * steps + 1];
    let mut x: Vec<[f64; 2]> = modes
        .iter()
        .map(|mode| [1e-6, 1e-7 * mode.angular_frequency])
        .collect();
    let mut sizes = Vec::new();
    let slowest = modes
        .iter()
        .map(|mode| mode.angular_frequency * mode.damping_ratio)
        .fold(f64::MAX, f64::min);
    let periods = ((8.0 / (slowest * period)) as usize).clamp(400, 1500);
    for _ in 0..periods {
        let mut record = Vec::with_capacity(2 * steps + 1);
        let mut largest: f64 = 0.0;
        for step in 0..steps {
            let t = step as f64 * h;
            let slope = |x: &[[f64; 2]], t: f64, delayed: Vector3<f64>| -> Vec<[f64; 2]> {
                let load = force(t, tip(x) - delayed);
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
            let k1 = slope(&x, t, before[2 * step]);
            let k2 = slope(&plus(&k1, 0.5 * h), t + 0.5 * h, before[2 * step + 1]);
            let k3 = slope(&plus(&k2, 0.5 * h), t + 0.5 * h, before[2 * step + 1]);
            let k4 = slope(&plus(&k3, h), t + h, before[2 * step + 2]);
            let start = tip(&x);
            let start_rate: Vector3<f64> = modes
                .iter()
                .zip(&x)
                .map(|(mode, x)| mode.shape.fixed_rows::<3>(0) * x[1])
                .sum();
            for (index, x) in x.iter_mut().enumerate() {
                for part in 0..2 {
                    x[part] += h / 6.0
                        * (k1[index][part] + 2.0 * k2[index][part] + 2.0 * k3[index][part] + k4[index][part]);
                }
            }
            let end = tip(&x);
            let end_rate: Vector3<f64> = modes
                .iter()
                .zip(&x)
                .map(|(mode, x)| mode.shape.fixed_rows::<3>(0) * x[1])
                .sum();
            // Hermite's cubic at the middle of the step.
            record.extend([start, (start + end) * 0.5 + (start_rate - end_rate) * (h / 8.0)]);
            largest = largest.max(end.norm());
        }
        record.push(tip(&x));
        before = record;
        sizes.push(largest);
        if !(1e-200..1e200).contains(&largest) {
            break;
        }
    }
    // Over the last third, so that what decays fast is gone.
    let (from, to) = (sizes.len() * 2 / 3, sizes.len() - 1);
    ((sizes[to] / sizes[from]).ln() / (to - from) as f64).exp()
}

#[test]
fn cuts_on_both_sides_of_the_boundary_grow_and_decay_in_a_simulation_in_time() {
    for (immersion, speed) in [
        (Immersion::Up(0.001), 18_000.0),
        (Immersion::Down(0.001), 12_000.0),
        (Immersion::Down(0.01), 9_300.0),
    ] {
        let cut = benchmark(immersion);
        let modes = [benchmark_mode()];
        let spindle = rpm(speed);
        let (found, kind) = boundary(&modes, &cut, spindle, 0.02).unwrap().unwrap();
        let [below, above] = [0.97, 1.03].map(|part| growth(&modes, &cut, spindle, part * found.depth));
        assert!(
            below < 1.0 && above > 1.0,
            "{immersion:?} {speed} {kind:?}: {below} {above} at {found:?}"
        );
    }
}

#[test]
fn the_multiplier_is_the_growth_of_a_simulation_in_time() {
    let flat = Cutter::flat(0.016, 3).unwrap();
    let two = vec![
        mode([310.0, 0.03], Vector3::new(1.0, 0.3, 0.0)),
        mode([420.0, 0.02], Vector3::new(-0.2, 1.1, 0.1)),
    ];
    for (modes, immersion, depth) in [
        (vec![benchmark_mode()], Immersion::Up(0.002), 2.5e-3),
        (two.clone(), Immersion::Slot, 3e-3),
        (two, Immersion::Down(0.003), 8e-3),
    ] {
        let cut = cutting(flat, immersion, [700e6, 250e6, 100e6]);
        let spindle = rpm(7000.0);
        let milling = cut.at_depth(depth).unwrap();
        let found = floquet(&modes, &milling, spindle, PeriodSteps::ByFastestMode);
        let grown = growth(&modes, &cut, spindle, depth);
        // The largest displacement of a period wobbles by the angle of the multiplier: about 2 in all periods that are compared.
        assert!(
            (found.multiplier.norm() / grown - 1.0).abs() < 5e-3,
            "{immersion:?}: {found:?} {grown}"
        );
    }
}

#[test]
fn the_boundary_converges_with_the_square_of_the_step() {
    let cut = benchmark(Immersion::Up(0.001)).at_depth(2e-3).unwrap();
    let at = |steps: usize| {
        floquet(
            &[benchmark_mode()],
            &cut,
            rpm(18_000.0),
            PeriodSteps::Given(steps),
        )
        .multiplier
        .norm()
    };
    let fine = at(1280);
    let errors = [40, 80, 160].map(|steps| (at(steps) - fine).abs());
    for pair in errors.windows(2) {
        // Four, if the entry of the tooth were at an end of a step.
        assert!(pair[0] / pair[1] > 2.0, "{errors:?}");
    }
    assert!(errors[1] < 1e-3, "{errors:?}");
}

#[test]
fn without_cut_the_multiplier_is_the_decay_of_the_least_damped_mode() {
    let modes = arm_and_cutter();
    let cut = cutting(
        Cutter::flat(0.016, 4).unwrap(),
        Immersion::Down(0.004),
        [700e6, 250e6, 100e6],
    );
    let spindle = rpm(6000.0);
    let milling = cut.at_depth(1e-9).unwrap();
    let found = floquet(&modes, &milling, spindle, PeriodSteps::ByFastestMode);
    let period = cut.pitch() / spindle;
    let decay = |mode: &Mode| (-mode.damping_ratio * mode.angular_frequency * period).exp();
    let slowest = modes.iter().map(decay).fold(0.0, f64::max);
    assert!(
        (found.multiplier.norm() - slowest).abs() < 1e-7,
        "{} {slowest}",
        found.multiplier.norm()
    );
}

#[test]
fn with_many_teeth_the_zeroth_order_solution_is_reached() {
    // A slot with eight teeth: the directional factors are constant but for the second and higher harmonics of the teeth.
    let modes = [
        mode([310.0, 0.03], Vector3::new(1.0, 0.3, 0.0)),
        mode([420.0, 0.02], Vector3::new(-0.2, 1.1, 0.0)),
    ];
    let cut = cutting(
        Cutter::flat(0.016, 8).unwrap(),
        Immersion::Slot,
        [700e6, 250e6, 100e6],
    );
    for speed in [1500.0, 2600.0, 4000.0] {
        let mean = ZerothOrder::new(&modes, &cut.per_depth(1e-3).unwrap(), cut.pitch(), 0.1);
        let zeroth = mean.at_speed(rpm(speed)).unwrap();
        let (exact, _) = boundary(&modes, &cut, rpm(speed), 0.05).unwrap().unwrap();
        assert!(
            (zeroth.depth / exact.depth - 1.0).abs() < 0.01,
            "{speed}: {zeroth:?} {exact:?}"
        );
        assert!((zeroth.angular_frequency / exact.angular_frequency - 1.0).abs() < 0.01);
    }
}

#[test]
fn harmonics_and_steps_in_time_agree_in_a_cut_of_low_immersion() {
    let cut = benchmark(Immersion::Up(0.001));
    for (speed, kind) in [
        (18_000.0, None),
        (12_000.0, Some(Instability::Flip)),
        (21_000.0, Some(Instability::Flip)),
    ] {
        let modes = [benchmark_mode()];
        let (exact, found) = boundary(&modes, &cut, rpm(speed), 0.03).unwrap().unwrap();
        assert!(kind.is_none_or(|kind| kind == found), "{speed}: {found:?}");
        let milling = cut.at_depth(1e-3).unwrap();
        let harmonics = |order: usize| multi_frequency::boundary(&modes, &milling, rpm(speed), order, 0.03);
        let error =
            |order: usize| harmonics(order).map_or(1.0, |(depth, _)| (depth / exact.depth - 1.0).abs());
        // Harmonics of a pulse of the width of a seventh of the period fall slowly.
        assert!(error(6) < 0.03, "{speed}: {:?} {exact:?} {found:?}", harmonics(6));
        assert!(
            error(0) > 0.2 || error(6) <= error(0) + 1e-3,
            "{speed}: {:?}",
            harmonics(0)
        );
    }
}

#[test]
fn a_helix_with_the_lead_of_the_pitch_removes_period_doubling() {
    // Where the depth is the axial pitch of the teeth the directional factors are constant: Insperger, Munoa, Zatarain, Peigne 2006.
    let helix = 0.6_f64;
    let cutter = Cutter::flat(0.02, 2)
        .unwrap()
        .with_helix(helix, Hand::Right)
        .unwrap();
    let cut = cutting(cutter, Immersion::Up(0.001), [600e6, 200e6, 0.0]);
    let axial_pitch = std::f64::consts::PI * 0.02 / 2.0 / helix.tan();
    let milling = cut.at_depth(axial_pitch).unwrap();
    let steps = milling.directional_over_pitch(64);
    let mean = milling.mean_directional();
    for step in steps {
        assert!((step - mean).norm() < 0.03 * mean.norm(), "{step} {mean}");
    }
    // There the boundary of the mean is exact.
    let soft = [mode([922.0, 0.011], Vector3::x() * 0.8)];
    let per_depth = cut.per_depth(1e-3).unwrap();
    let spindle = rpm(37_000.0);
    let zeroth = ZerothOrder::new(&soft, &per_depth, cut.pitch(), 1.0).at_speed(spindle);
    let is_stable = zeroth.is_none_or(|boundary| boundary.depth > axial_pitch);
    assert_eq!(
        floquet(&soft, &milling, spindle, PeriodSteps::ByFastestMode).is_stable(),
        is_stable
    );
}

use super::*;
use crate::load::{Cutter, Hand, Immersion};
use crate::stability::examples::{arm_and_cutter, benchmark, benchmark_mode, cutting, rpm};

#[test]
fn speeds_together_and_one_by_one_give_the_same_boundary() {
    let modes = arm_and_cutter();
    let flat = Cutter::flat(0.016, 4)
        .unwrap()
        .with_helix(0.5, Hand::Right)
        .unwrap();
    let ball = Cutter::ball(0.012, 2).unwrap();
    for (cutter, bound) in [(flat, 1e-12), (ball, 0.03)] {
        let cut = cutting(cutter, Immersion::Down(0.002), [700e6, 250e6, 100e6]);
        let lobes = StabilityLobes::new(&modes, &cut, 0.02).unwrap();
        let speeds: Vec<f64> = (0..60).map(|k| rpm(2000.0 + 300.0 * f64::from(k))).collect();
        for lobe in lobes.at_speeds(&speeds) {
            let exact = lobes.at_speed(lobe.spindle);
            match (lobe.boundary, exact) {
                (Some(fast), Some(exact)) => {
                    // The ball is interpolated between 64 depths, whose step is 11 %; every fourth is tried first.
                    assert!(
                        (fast.depth / exact.depth - 1.0).abs() < bound,
                        "{fast:?} {exact:?}"
                    );
                }
                (fast, exact) => assert_eq!(fast, exact),
            }
            assert!(
                lobe.boundary
                    .is_none_or(|b| b.depth >= lobes.critical().unwrap().depth * (1.0 - bound))
            );
        }
    }
}

#[test]
fn at_the_boundary_of_a_ball_the_loop_gain_of_that_depth_is_critical() {
    let modes = arm_and_cutter();
    let cut = cutting(
        Cutter::ball(0.012, 2).unwrap(),
        Immersion::Slot,
        [700e6, 250e6, 100e6],
    );
    let lobes = StabilityLobes::new(&modes, &cut, 0.02).unwrap();
    let spindle = rpm(7300.0);
    let found = lobes.at_speed(spindle).unwrap();
    let there = ZerothOrder::new(&modes, &cut.per_depth(found.depth).unwrap(), cut.pitch(), 1.0);
    assert!((there.at_speed(spindle).unwrap().depth / found.depth - 1.0).abs() < 1e-4);
    let shares: f64 = lobes.shares(&found, spindle).iter().sum();
    assert!((shares - 1.0).abs() < 1e-3, "{shares}");
}

#[test]
fn a_bull_nose_with_a_tiny_corner_has_the_boundary_of_a_flat_end_mill() {
    let flat = benchmark(Immersion::Slot);
    let nose = cutting(
        Cutter::bull_nose(0.02, 1e-7, 2).unwrap(),
        Immersion::Slot,
        [600e6, 200e6, 0.0],
    );
    let at = |cut: &CutOfAnyDepth| {
        StabilityLobes::new(&[benchmark_mode()], cut, 0.05)
            .unwrap()
            .at_speed(rpm(9000.0))
            .unwrap()
            .depth
    };
    assert!(
        (at(&nose) / at(&flat) - 1.0).abs() < 1e-3,
        "{} {}",
        at(&nose),
        at(&flat)
    );
}

#[test]
fn a_boundary_below_the_first_depth_of_a_ball_is_reported() {
    let soft: Vec<Mode> = arm_and_cutter()
        .into_iter()
        .map(|mode| Mode {
            shape: mode.shape * 60.0,
            ..mode
        })
        .collect();
    let cut = cutting(
        Cutter::ball(0.012, 2).unwrap(),
        Immersion::Slot,
        [700e6, 250e6, 100e6],
    );
    let found = StabilityLobes::new(&soft, &cut, 0.02)
        .unwrap()
        .at_speed(rpm(7300.0));
    assert!(
        found.is_some_and(|boundary| boundary.depth < 0.02 * 2e-3),
        "{found:?}"
    );
}

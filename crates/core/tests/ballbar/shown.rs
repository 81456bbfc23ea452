//! The quantities of circular tests: by hand, and what may not change them.

use std::f64::consts::TAU;

use armill_core::measure::ballbar::centre::seen_from;
use armill_core::measure::ballbar::{
    CircularTest, Direction, Run, hysteresis, least_squares_centre, mean_bidirectional, quantities,
};
use proptest::prelude::*;

use crate::machine::{Machine, RADIUS, Random};

/// A turn of `r(a)`, m.
fn circle(direction: Direction, radius: impl Fn(f64) -> f64) -> Run {
    let angle: Vec<f64> = (0..720).map(|k| TAU * f64::from(k) / 720.0).collect();
    let deviation = angle.iter().map(|a| radius(*a) - RADIUS).collect();
    Run::new(direction, angle, deviation).unwrap()
}

fn test(runs: Vec<Run>) -> CircularTest {
    CircularTest::new(RADIUS, runs).unwrap()
}

/// G and F of all runs.
fn shown(test: &CircularTest) -> (f64, [f64; 2]) {
    let all: Vec<&Run> = test.runs().iter().collect();
    let shown = quantities(test, &all).unwrap();
    (
        shown.circular.unwrap(),
        shown.radial.map(|extreme| extreme.deviation),
    )
}

#[test]
fn the_circular_deviation_of_an_ellipse_is_the_difference_of_its_half_axes() {
    let (p, q) = (0.100_03_f64, 0.099_99_f64);
    let ellipse = circle(Direction::Clockwise, |a| (a.cos() / p).hypot(a.sin() / q).recip());
    let (g, [least, greatest]) = shown(&test(vec![ellipse]));
    assert!((g - 40e-6).abs() < 1e-12, "{g}");
    assert!((least + 10e-6).abs() < 1e-12 && (greatest - 30e-6).abs() < 1e-12);
}

#[test]
fn a_circle_off_the_centre_is_round_and_its_radial_deviation_is_the_offset() {
    let e = 50e-6;
    // r^2 - 2 r e cos a + e^2 = R^2
    let eccentric = |a: f64| e * a.cos() + (RADIUS.powi(2) - (e * a.sin()).powi(2)).sqrt();
    let eccentric = test(vec![circle(Direction::Anticlockwise, eccentric)]);
    let (g, [least, greatest]) = shown(&eccentric);
    assert!(g < 1e-12, "{g}");
    assert!((least + e).abs() < 1e-12 && (greatest - e).abs() < 1e-12);
    let centre = least_squares_centre(&eccentric).unwrap();
    let (g, [least, greatest]) = shown(&seen_from(&eccentric, centre.offset).unwrap());
    assert!(g < 1e-12 && least.abs() < 1e-12 && greatest.abs() < 1e-12);
}

#[test]
fn directions_of_different_radius_differ_by_h_and_their_mean_is_d() {
    let cw = circle(Direction::Clockwise, |_| RADIUS + 30e-6);
    let ccw = circle(Direction::Anticlockwise, |a| {
        RADIUS - 10e-6 + 5e-6 * (4.0 * a).cos()
    });
    let both = test(vec![cw.clone(), ccw]);
    assert!((mean_bidirectional(&both).unwrap() - 10e-6).abs() < 1e-9);
    assert!((hysteresis(&both).unwrap() - 45e-6).abs() < 1e-12);
    let (g, _) = shown(&both);
    assert!((g - 45e-6).abs() < 1e-9, "both ways together: {g}");
    let one = test(vec![cw]);
    assert_eq!((mean_bidirectional(&one), hysteresis(&one)), (None, None));
}

#[test]
fn part_of_a_turn_has_no_mean_bidirectional_deviation() {
    let arc = |direction| {
        let angle: Vec<f64> = (0..220).map(|deg| f64::from(deg).to_radians()).collect();
        Run::new(direction, angle, vec![4e-6; 220]).unwrap()
    };
    let arcs = test(Direction::BOTH.map(arc).to_vec());
    assert_eq!(mean_bidirectional(&arcs), None);
    let all: Vec<&Run> = arcs.runs().iter().collect();
    let shown = quantities(&arcs, &all).unwrap();
    assert!((shown.arc.to_degrees() - 219.0).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn where_a_run_begins_changes_nothing(seed in 0_u64..1000, start in 0_usize..720) {
        let machine = Machine { scale: [2e-4, -1e-4], gap: [9e-6, 4e-6], noise: 1e-6, ..Machine::default() };
        let run = machine.run(Direction::Anticlockwise, (0.0, 720), &mut Random(seed));
        let turn = |list: &[f64]| [&list[start..], &list[..start]].concat();
        let later = Run::new(Direction::Anticlockwise, turn(run.angle()), turn(run.deviation())).unwrap();
        let [one, other] = [run, later].map(|run| shown(&test(vec![run])));
        prop_assert!((one.0 - other.0).abs() < 1e-12 && one.1 == other.1);
    }

    #[test]
    fn the_order_of_runs_changes_nothing(seed in 0_u64..1000) {
        let machine = Machine { scale: [2e-4, -1e-4], gap: [9e-6, 4e-6], noise: 1e-6, offset: [3e-5, 0.0], ..Machine::default() };
        let there = machine.test([2, 2], 360, seed);
        let back = test(there.runs().iter().rev().cloned().collect());
        let [one, other] = [&there, &back].map(|test| (shown(test), least_squares_centre(test).unwrap()));
        prop_assert!((one.0.0 - other.0.0).abs() < 1e-12 && one.0.1 == other.0.1);
        prop_assert!((one.1.offset - other.1.offset).norm() < 1e-12);
        prop_assert!((hysteresis(&there).unwrap() - hysteresis(&back).unwrap()).abs() < 1e-15);
    }

    #[test]
    fn a_circle_turned_in_its_plane_is_as_round(seed in 0_u64..1000, turn in 0.0_f64..TAU) {
        let machine = Machine { scale: [2e-4, -1e-4], squareness: 1e-4, noise: 1e-6, ..Machine::default() };
        let run = machine.run(Direction::Clockwise, (0.0, 720), &mut Random(seed));
        let turned = run.angle().iter().map(|a| a + turn).collect();
        let turned = Run::new(Direction::Clockwise, turned, run.deviation().to_vec()).unwrap();
        let [one, other] = [run, turned].map(|run| shown(&test(vec![run])));
        prop_assert!((one.0 - other.0).abs() < 1e-10 && one.1 == other.1);
    }

    #[test]
    fn a_circle_twice_as_large_has_all_of_it_twice(seed in 0_u64..1000) {
        let machine = Machine { scale: [2e-4, -1e-4], gap: [9e-6, 4e-6], noise: 1e-6, ..Machine::default() };
        let small = machine.test([1, 1], 360, seed);
        let twice = |run: &Run| {
            let deviation = run.deviation().iter().map(|dr| 2.0 * dr).collect();
            Run::new(run.direction(), run.angle().to_vec(), deviation).unwrap()
        };
        let large = CircularTest::new(2.0 * RADIUS, small.runs().iter().map(twice).collect()).unwrap();
        let [one, other] = [&small, &large].map(shown);
        prop_assert!((2.0 * one.0 - other.0).abs() < 1e-10);
        prop_assert!((2.0 * hysteresis(&small).unwrap() - hysteresis(&large).unwrap()).abs() < 1e-15);
        let [small, large] = [&small, &large].map(|test| mean_bidirectional(test).unwrap());
        prop_assert!((2.0 * small - large).abs() < 1e-12);
    }
}

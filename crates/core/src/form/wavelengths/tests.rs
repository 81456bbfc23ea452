use std::f64::consts::TAU;

use super::*;
use crate::arms::Stream;

/// A patch of 0.2 x 0.1 m in steps of 1 mm.
fn patch() -> Vec<Point3<f64>> {
    let point = |k: i32| Point3::new(f64::from(k % 201) * 1e-3, f64::from(k / 201) * 1e-3, 0.0);
    (0..201 * 101).map(point).collect()
}

fn along(points: &[Point3<f64>], f: impl Fn(f64) -> f64) -> Vec<f64> {
    points.iter().map(|p| f(p.x)).collect()
}

/// ISO 16610-21: half of a sine at the cut-off passes; of one twice as long 2^(-1/4) = 0.841, half as long 2^(-4) = 0.0625.
#[test]
fn the_filter_passes_what_the_standard_says() {
    let points = patch();
    let inside = |p: &Point3<f64>| p.x > 0.07 && p.x < 0.13 && p.y > 0.03 && p.y < 0.07;
    for (part, passed) in [(1.0, 0.5), (2.0, 0.840_896), (0.5, 0.0625)] {
        let cut_off = 0.02;
        let wave = |x: f64| (TAU * x / (part * cut_off)).sin();
        let fields: Vec<[f64; 2]> = points.iter().map(|p| [wave(p.x), 1.0]).collect();
        let low = low_pass(&points, &fields, cut_off);
        for (point, found) in points.iter().zip(&low).filter(|pair| inside(pair.0)) {
            // Means of cells of 1.4 mm and the cut kernel: up to a percent.
            assert!(
                (found[0] - passed * wave(point.x)).abs() < 0.012,
                "{part}: {point} {found:?}"
            );
            assert!((found[1] - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn a_prediction_of_the_long_waves_explains_them_and_not_the_short_ones() {
    let points = patch();
    let long = |x: f64| 10e-6 * (TAU * x / 0.2).sin();
    let short = |x: f64| 4e-6 * (TAU * x / 0.004).sin();
    let (measured, predicted) = (along(&points, |x| long(x) + short(x)), along(&points, long));
    let pairs = DeviationPairs {
        points: &points,
        measured: &measured,
        predicted: &predicted,
    };
    let found = agreement_by_wavelength(&pairs, [0.05, 0.01]).unwrap();
    // 50 of 58 um^2; the patch has whole waves and one point more.
    let share = 50.0 / 58.0;
    assert!(
        (found.overall.explained.unwrap() - share).abs() < 2e-3,
        "{found:?}"
    );
    assert!((found.overall.correlation.unwrap() - f64::sqrt(share)).abs() < 2e-3);
    assert!((found.overall.slope.unwrap() - 1.0).abs() < 2e-3);
    assert!(found.long.explained.unwrap() > 0.999, "{found:?}");
    assert!(found.short.explained.unwrap() < 0.05, "{found:?}");
    assert!(found.slope_uncertainty.unwrap() < 0.02);
}

#[test]
fn half_of_the_size_leaves_a_quarter_and_the_negative_is_worse_than_nothing() {
    let points = patch();
    let measured = along(&points, |x| 10e-6 * (TAU * x / 0.1).sin());
    for (factor, explained) in [(1.0, 1.0), (0.5, 0.75), (0.0, 0.0), (-1.0, -3.0)] {
        let predicted: Vec<f64> = measured.iter().map(|m| factor * m).collect();
        let pairs = DeviationPairs {
            points: &points,
            measured: &measured,
            predicted: &predicted,
        };
        let found = agreement_by_wavelength(&pairs, [0.05, 0.01]).unwrap().overall;
        assert!(
            (found.explained.unwrap() - explained).abs() < 1e-9,
            "{factor}: {found:?}"
        );
        match factor == 0.0 {
            true => assert_eq!((found.slope, found.correlation), (None, None)),
            false => assert!((found.slope.unwrap() * factor - 1.0).abs() < 1e-9, "{found:?}"),
        }
    }
}

/// 200 repetitions of noise that is equal over blocks of 2 x 2 cm: the jackknife gives its scatter within a fifth on average, formulas for
/// independent points a twentieth of it.
#[test]
fn the_uncertainty_of_the_slope_is_that_of_correlated_errors() {
    let points: Vec<Point3<f64>> = patch().into_iter().step_by(7).collect();
    let mut stream = Stream(5);
    let (mut squares, mut given) = (0.0, 0.0);
    for _ in 0..200 {
        let blocks: Vec<[f64; 2]> = (0..100).map(|_| [stream.normal(), stream.normal()]).collect();
        let of = |p: &Point3<f64>, k: usize| blocks[(p.x / 0.02) as usize + 11 * (p.y / 0.02) as usize][k];
        let fields: Vec<[f64; 2]> = points
            .iter()
            .map(|p| [1e-6 * (of(p, 0) + of(p, 1)), 1e-6 * of(p, 0)])
            .collect();
        let all = Moments::of(&fields);
        let uncertainty = jackknife(&all, &super::blocks(&points, &fields, 0.02), |agreement| {
            agreement.slope
        });
        squares += (all.agreement().slope.unwrap() - 1.0).powi(2) / 200.0;
        given += uncertainty.unwrap().powi(2) / 200.0;
    }
    let ratio = (given / squares).sqrt();
    assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
}

#[test]
fn input_without_meaning_is_refused() {
    let points = patch();
    let (short, all) = (vec![0.0; 9], vec![0.0; points.len()]);
    let of = |measured: &[f64], cut_offs: [f64; 2]| {
        agreement_by_wavelength(
            &DeviationPairs {
                points: &points,
                measured,
                predicted: &all,
            },
            cut_offs,
        )
    };
    assert_eq!(
        of(&short, [0.05, 0.01]),
        Err(FormError::Lengths {
            needed: 20_301,
            given: 9
        })
    );
    assert_eq!(of(&all, [0.01, 0.05]), Err(FormError::Length { value: 0.05 }));
    assert_eq!(of(&all, [0.05, 0.0]), Err(FormError::Length { value: 0.0 }));
    let flat = of(&all, [0.05, 0.01]).unwrap();
    assert_eq!((flat.overall.explained, flat.overall.variance), (None, 0.0));
}

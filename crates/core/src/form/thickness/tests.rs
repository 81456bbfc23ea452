use nalgebra::Rotation3;

use super::*;

fn side(height: impl Fn(f64, f64) -> f64, shift: f64) -> Vec<Point3<f64>> {
    let point = |k: i32| {
        let (x, y) = (f64::from(k % 21) * 0.005 + shift, f64::from(k / 21) * 0.005);
        Point3::new(x, y, height(x, y))
    };
    (0..21 * 11).map(point).collect()
}

#[test]
fn a_wedge_has_the_sizes_of_its_ends_at_any_orientation() {
    // 3 mm at x = 0, 0.05 mm more at x = 0.1 m; points of both sides are not opposite.
    let (lower, upper) = (side(|_, _| 0.0, 0.0), side(|x, _| 3e-3 + 5e-4 * x, 0.0021));
    for turn in [[0.0, 0.0, 0.0], [0.4, 1.0, -0.3]] {
        let turn = Rotation3::new(turn.into());
        let [lower, upper] = [&lower, &upper].map(|side| side.iter().map(|p| turn * p).collect::<Vec<_>>());
        let found = thickness(&lower, &upper, 0.006).unwrap();
        // The mean normal is tilted by half of 5e-4 rad: second order.
        assert!((found.least - 3e-3).abs() < 2e-9, "{found:?}");
        assert!((found.largest - 3.05e-3).abs() < 2e-9, "{found:?}");
        assert!((found.mean - 3.025e-3).abs() < 2e-9 && found.unpaired == 0);
    }
}

#[test]
fn points_without_an_opposite_one_are_counted() {
    let (lower, upper) = (side(|_, _| 0.0, 0.0), side(|_, _| 3e-3, 0.03));
    let found = thickness(&lower, &upper, 0.004).unwrap();
    assert_eq!(found.unpaired, 6 * 11);
    assert!((found.least - 3e-3).abs() < 1e-15 && (found.largest - 3e-3).abs() < 1e-15);
}

#[test]
fn sides_that_are_no_wall_are_refused() {
    let lower = side(|_, _| 0.0, 0.0);
    assert_eq!(
        thickness(&lower, &lower[..2], 0.01),
        Err(FormError::TooFew { needed: 3, given: 2 })
    );
    assert_eq!(
        thickness(&lower, &side(|_, _| 3e-3, 0.0), 0.0),
        Err(FormError::Length { value: 0.0 })
    );
    assert_eq!(
        thickness(&lower, &side(|_, _| 3e-3, 1.0), 0.01),
        Err(FormError::TooFew { needed: 1, given: 0 })
    );
    let upright: Vec<Point3<f64>> = lower.iter().map(|p| Point3::new(0.2, p.y, p.x)).collect();
    assert_eq!(thickness(&lower, &upright, 0.01), Err(FormError::Undetermined));
}

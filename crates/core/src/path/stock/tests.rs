use super::*;
use crate::path::{EngagementKind, Pass, PassEngagement};
use nalgebra::{Unit, Vector3};
use std::f64::consts::PI;

const MM: f64 = 1e-3;

fn stock_mm(low: [f64; 3], high: [f64; 3], pitch: f64) -> Stock {
    Stock::new([Point3::from(low) * MM, Point3::from(high) * MM], pitch * MM).unwrap()
}

fn cutter_mm(diameter: f64, corner: f64) -> EndMillBody {
    EndMillBody::new(diameter * MM, corner * MM).unwrap()
}

/// Path z (m) of the top of the material over `at`; `None` outside the box.
fn top_at(stock: &Stock, at: Point2<f64>) -> Option<f64> {
    stock
        .cell_at(at)
        .map(|(_, height)| stock.low.z + f64::from(height))
}

fn pass(from: Point3<f64>, to: Point3<f64>) -> Pass {
    Pass {
        from,
        to,
        direction: Unit::try_new(to - from, 0.0).unwrap_or(Vector3::x_axis()),
        axis: Vector3::z_axis(),
    }
}

/// One step between two positions in mm.
fn step(stock: &mut Stock, from: [f64; 3], to: [f64; 3], cutter: &EndMillBody) -> PassEngagement {
    let (from, to) = (Point3::from(from) * MM, Point3::from(to) * MM);
    stock.cut(&pass(from, to), cutter).unwrap()
}

/// Half a pitch along the walls that are cut: the largest error of a volume.
fn wall_error(wall: f64, depth: f64, stock: &Stock) -> f64 {
    wall * depth * stock.pitch() / 2.0
}

#[test]
fn a_step_inside_takes_a_rectangle_and_two_half_discs() {
    for corner in [[13.07, 12.11], [31.4, 26.9], [30.0, 12.11], [13.07, 25.0]] {
        let mut stock = stock_mm([0.0, 0.0, -20.0], [45.0, 40.0, 0.0], 0.25);
        let full = stock.volume();
        let from = [13.07, 12.11, -4.0];
        let engagement = step(
            &mut stock,
            from,
            [corner[0], corner[1], -4.0],
            &cutter_mm(10.0, 0.0),
        );
        let length = (corner[0] - from[0]).hypot(corner[1] - from[1]) * MM;
        let (radius, depth) = (5.0 * MM, 4.0 * MM);
        let swept = depth * (2.0 * radius * length + PI * radius * radius);
        let wall = 2.0 * length + 2.0 * PI * radius;
        assert!(
            (engagement.volume - swept).abs() < wall_error(wall, depth, &stock),
            "{corner:?}"
        );
        // Some 3e4 cells, each rounded in single precision to 6e-8 of 20 mm.
        assert!((full - stock.volume() - engagement.volume).abs() < 1e-7 * full);
    }
}

#[test]
fn the_volume_of_a_ball_that_goes_in_is_that_of_a_half_ball_and_a_cylinder() {
    let mut stock = stock_mm([0.0, 0.0, -20.0], [20.0, 20.0, 0.0], 0.1);
    let engagement = step(
        &mut stock,
        [10.03, 9.96, 5.0],
        [10.03, 9.96, -8.0],
        &cutter_mm(10.0, 5.0),
    );
    let radius = 5.0 * MM;
    let body = 2.0 / 3.0 * PI * radius.powi(3) + PI * radius * radius * 3.0 * MM;
    assert!((engagement.volume - body).abs() < wall_error(2.0 * PI * radius, 8.0 * MM, &stock));
    assert_eq!(engagement.kind, EngagementKind::Plunge);
    assert!((engagement.depth - 8.0 * MM).abs() < 0.001 * MM, "{engagement:?}");
}

#[test]
fn the_order_of_passes_changes_neither_heights_nor_the_sum_of_volumes() {
    let passes = [
        ([-5.0, 8.0, -2.0], [35.0, 8.0, -2.0], cutter_mm(10.0, 0.0)),
        ([12.0, -5.0, -4.0], [20.0, 35.0, -1.0], cutter_mm(8.0, 4.0)),
        ([25.0, 25.0, 0.5], [3.0, 3.0, -5.0], cutter_mm(12.0, 2.0)),
    ];
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let ends = orders.map(|order| {
        let mut stock = stock_mm([0.0, 0.0, -10.0], [30.0, 30.0, 0.0], 0.2);
        let volumes = order.map(|k| step(&mut stock, passes[k].0, passes[k].1, &passes[k].2).volume);
        (stock.heights, volumes.iter().sum::<f64>())
    });
    for (heights, volume) in &ends[1..] {
        assert_eq!(heights, &ends[0].0);
        assert!((volume / ends[0].1 - 1.0).abs() < 1e-7, "{volume}");
    }
}

#[test]
fn parallel_passes_of_a_ball_leave_scallops() {
    let (radius, apart) = (5.0, 2.0);
    let mut stock = stock_mm([0.0, 0.0, -10.0], [30.0, 30.0, 0.0], 0.1);
    for pass in 0..8 {
        let y = 8.0 + apart * f64::from(pass);
        step(
            &mut stock,
            [-6.0, y, -3.0],
            [36.0, y, -3.0],
            &cutter_mm(10.0, 5.0),
        );
    }
    let heights: Vec<f64> = (0..400)
        .map(|k| 9.0 + 0.03 * f64::from(k))
        .filter_map(|y| top_at(&stock, Point2::new(15.0, y) * MM))
        .collect();
    let highest = heights.iter().fold(f64::MIN, |most, &z| most.max(z));
    let lowest = heights.iter().fold(f64::MAX, |least, &z| least.min(z));
    // h = R - sqrt(R^2 - (s/2)^2); a cell centre is at most half a pitch off the ridge, where it falls by s/(2 R).
    let scallop = radius - (radius * radius - apart * apart / 4.0).sqrt();
    let off = 0.05 * (apart / 2.0) / (radius - scallop);
    let above = (highest / MM + 3.0) - scallop;
    assert!(above < 1e-6 && above > -off, "{above}");
    assert!((lowest / MM + 3.0).abs() < 0.05 * 0.05 / (2.0 * radius) + 1e-6);
}

#[test]
fn volumes_converge_with_the_pitch() {
    let worst = |pitch: f64| {
        let errors = (0..12).map(|k| {
            let mut stock = stock_mm([0.0; 3], [24.0, 24.0, 1.0], pitch);
            let at = 12.0 + 0.073 * f64::from(k);
            let cutter = cutter_mm(10.0, 0.0);
            let engagement = step(&mut stock, [at, 12.03, 2.0], [at, 12.03, 0.0], &cutter);
            (engagement.volume / (PI * 25.0 * MM.powi(3)) - 1.0).abs()
        });
        errors.fold(0.0, f64::max)
    };
    let errors = [1.0, 0.5, 0.25, 0.125].map(worst);
    for (k, error) in errors.iter().enumerate() {
        // First order at least: rim times half a pitch over the disc is pitch/R.
        assert!(*error < 0.5_f64.powi(k as i32) / 5.0, "{errors:?}");
    }
    assert!(errors[3] < errors[0] / 8.0, "{errors:?}");
}

#[test]
fn a_cutter_larger_than_the_box_removes_all_above_its_tip_and_no_more() {
    let mut stock = stock_mm([0.0; 3], [10.0, 7.0, 5.0], 0.3);
    let cutter = cutter_mm(80.0, 0.0);
    let face = step(&mut stock, [-50.0, 3.0, 3.0], [60.0, 3.0, 3.0], &cutter);
    assert!((face.volume / MM.powi(3) - 140.0).abs() < 1e-4, "{face:?}");
    let through = step(&mut stock, [-50.0, 3.0, -9.0], [60.0, 3.0, -9.0], &cutter);
    assert!((through.volume / MM.powi(3) - 210.0).abs() < 1e-4, "{through:?}");
    assert_eq!(stock.volume(), 0.0);
    assert_eq!(top_at(&stock, Point2::new(5.0, 5.0) * MM), Some(0.0));
    assert_eq!(top_at(&stock, Point2::new(5.0, 7.1) * MM), None);
    assert_eq!(
        step(&mut stock, [-50.0, 3.0, -9.0], [60.0, 3.0, -9.0], &cutter).volume,
        0.0
    );
}

#[test]
fn invalid_boxes_are_refused() {
    let boxed =
        |low: [f64; 3], high: [f64; 3], pitch: f64| Stock::new([low.into(), high.into()], pitch).unwrap_err();
    let one = [1.0; 3];
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(
            boxed([0.0, bad, 0.0], one, 0.1),
            StockError::NotFinite("a corner of the stock")
        );
        assert_eq!(
            boxed([0.0; 3], [1.0, 1.0, bad], 0.1),
            StockError::NotFinite("a corner of the stock")
        );
        assert_eq!(
            boxed([0.0; 3], one, bad),
            StockError::NotFinite("the pitch of the stock")
        );
    }
    for pitch in [0.0, -0.1, 1e-300] {
        assert!(
            matches!(boxed([0.0; 3], one, pitch), StockError::Pitch { .. }),
            "{pitch}"
        );
    }
    for (high, axis) in [
        ([0.0, 1.0, 1.0], 'x'),
        ([1.0, -1.0, 1.0], 'y'),
        ([1.0, 1.0, 0.0], 'z'),
    ] {
        let refused = boxed([0.0; 3], high, 0.1);
        assert!(
            matches!(refused, StockError::Box { axis: given, .. } if given == axis),
            "{refused}"
        );
    }
    assert!(matches!(
        boxed([0.0; 3], one, 5e-5),
        StockError::TooManyCells { .. }
    ));
    assert!(matches!(boxed([-1e300; 3], one, 0.1), StockError::TooFar { .. }));
}

#[test]
fn invalid_points_and_tilted_tools_are_refused_and_cut_nothing() {
    let mut stock = stock_mm([0.0; 3], [10.0, 10.0, 5.0], 0.5);
    let (full, cutter) = (stock.volume(), cutter_mm(4.0, 0.0));
    let (from, to) = (Point3::new(0.0, 5.0, 2.0) * MM, Point3::new(5.0, 5.0, 2.0) * MM);
    let good = pass(from, to);
    let nowhere = Point3::new(f64::NAN, 0.0, 0.0);
    let mut refused = |wrong: Pass| stock.cut(&wrong, &cutter).unwrap_err();
    let no_number = StockError::NotFinite("a point of the path");
    for (wrong, error) in [
        (
            Pass {
                from: nowhere,
                ..good
            },
            no_number,
        ),
        (Pass { to: nowhere, ..good }, no_number),
        (
            Pass {
                direction: Unit::new_unchecked(Vector3::new(f64::NAN, 0.0, 0.0)),
                ..good
            },
            StockError::NotFinite("a direction of the path"),
        ),
    ] {
        assert_eq!(refused(wrong), error);
    }
    let far = Point3::new(1e300, 0.0, 0.0);
    assert!(matches!(
        refused(Pass { from: far, ..good }),
        StockError::TooFar { .. }
    ));
    for lean in [0.5_f64, 90.0, 180.0] {
        let (sin, cos) = lean.to_radians().sin_cos();
        let axis = Unit::new_unchecked(Vector3::new(0.0, sin, cos));
        let StockError::Tilted { angle_deg } = refused(Pass { axis, ..good }) else {
            panic!("{lean}");
        };
        assert!((angle_deg - lean).abs() < 1e-9);
    }
    assert_eq!(stock.volume(), full);
    assert!(stock.cut(&good, &cutter).unwrap().volume > 0.0);
}

#[test]
fn positions_and_cutters_at_the_limits_cut_without_error() {
    let mut stock = stock_mm([0.0; 3], [10.0, 10.0, 5.0], 0.5);
    let places = [-FARTHEST, -1.0, 0.0, 0.005, FARTHEST];
    for (diameter, corner) in [(1e-5, 0.0), (1e-5, 5e-6), (1.0, 0.0), (1.0, 0.5)] {
        let cutter = EndMillBody::new(diameter, corner).unwrap();
        for x in places {
            for z in places {
                let (from, to) = (Point3::new(-x, x, z), Point3::new(x, z, -z));
                let engagement = stock.cut(&pass(from, to), &cutter).unwrap();
                let given = [engagement.depth, engagement.width, engagement.volume];
                assert!(
                    given.iter().all(|value| value.is_finite() && *value >= 0.0),
                    "{engagement:?}"
                );
            }
        }
    }
}

#[test]
fn the_removed_volumes_equal_the_loss_of_the_stock_on_any_path_of_any_cutter() {
    for (diameter, corner) in [(10.0, 0.0), (8.0, 4.0), (12.0, 2.0)] {
        let cutter = cutter_mm(diameter, corner);
        let mut stock = stock_mm([0.0, 0.0, -12.0], [40.0, 30.0, 0.0], 0.3);
        let full = stock.volume();
        let mut before = [-8.0, 15.0, 1.0];
        let (mut sum, mut left) = (0.0, full);
        for k in 0..60 {
            let turn = 0.7 * f64::from(k);
            let at = [
                20.0 + 17.0 * turn.cos(),
                15.0 + 12.0 * (1.3 * turn).sin(),
                -3.0 + 4.0 * (0.37 * turn).cos(),
            ];
            let engagement = step(&mut stock, before, at, &cutter);
            let lost = left - stock.volume();
            // 13 000 cells, each rounded in single precision to 6e-8 of 12 mm.
            assert!(
                (engagement.volume - lost).abs() < 1e-7 * full,
                "{k}: {} {lost}",
                engagement.volume
            );
            // It removes no more than the cutter sweeps: its widest section along its path, and itself.
            let length = (Point3::from(at) - Point3::from(before)).norm() * MM;
            let swept = 2.0 * cutter.radius() * 13.0 * MM * length + PI * cutter.radius().powi(2) * 13.0 * MM;
            assert!(engagement.volume <= swept && engagement.depth <= 12.0 * MM * (1.0 + 1e-6));
            (sum, left, before) = (sum + engagement.volume, stock.volume(), at);
        }
        assert!(
            (full - stock.volume() - sum).abs() < 1e-6 * full && sum > 0.1 * full,
            "{sum}"
        );
    }
}

#[test]
fn a_path_in_many_steps_removes_the_same_as_one_step() {
    let cutter = cutter_mm(10.0, 5.0);
    let cut_in = |pieces: u32| {
        let mut stock = stock_mm([0.0, 0.0, -10.0], [40.0, 30.0, 0.0], 0.25);
        let (from, to) = (Point3::new(-6.0, 7.0, -1.0), Point3::new(43.0, 21.0, -4.0));
        let at = |k: u32| {
            (from + (to - from) * (f64::from(k) / f64::from(pieces)))
                .coords
                .into()
        };
        let volume: f64 = (0..pieces)
            .map(|k| step(&mut stock, at(k), at(k + 1), &cutter).volume)
            .sum();
        (stock.heights, volume)
    };
    let (whole, volume) = cut_in(1);
    for pieces in [2, 7, 40] {
        let (heights, sum) = cut_in(pieces);
        let off = whole.iter().zip(&heights).map(|(one, other)| (one - other).abs());
        // Single precision of 10 mm, twice.
        assert!(off.fold(0.0, f32::max) < 2e-9, "{pieces}");
        assert!((sum / volume - 1.0).abs() < 1e-6, "{pieces}: {sum} {volume}");
    }
}

#[test]
fn the_highest_material_about_a_position_is_that_of_its_cells() {
    let mut stock = stock_mm([0.0, 0.0, -10.0], [20.0, 20.0, 0.0], 0.5);
    step(
        &mut stock,
        [-6.0, 10.0, -4.0],
        [26.0, 10.0, -4.0],
        &cutter_mm(10.0, 0.0),
    );
    let at = |y: f64| Point2::new(10.0, y) * MM;
    // Inside the groove the floor, near its wall the top, outside the box its bottom.
    for (y, out, z) in [
        (10.0, 3.0, -4.0),
        (10.0, 6.0, 0.0),
        (14.0, 2.0, 0.0),
        (-9.0, 3.0, -10.0),
    ] {
        let found = stock.highest_about(at(y), out * MM);
        assert!((found - z * MM).abs() < 1e-8, "{y} {out}: {found}");
    }
}

#[test]
fn every_refusal_states_what_cannot_be_cut() {
    let given = [
        (
            StockError::Box {
                axis: 'y',
                low: 0.5,
                high: 0.25,
            },
            "the stock reaches from 0.5 to 0.25 m along y: the second must be greater",
        ),
        (
            StockError::Tilted { angle_deg: 12.345 },
            "the tool is tilted by 12.35 deg from the z axis of the path: a stock supports only upright tools",
        ),
        (
            StockError::NotFinite("a direction of the path"),
            "a direction of the path is not a finite number",
        ),
        (
            StockError::TooManyCells {
                cells: 4e8,
                most: 1e8,
            },
            "the stock has 4.000e8 cells: the maximum is 1e8; use a coarser pitch",
        ),
    ];
    for (error, text) in given {
        assert_eq!(error.to_string(), text);
    }
}

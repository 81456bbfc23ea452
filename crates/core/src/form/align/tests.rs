use super::super::surface::tests::boxed;
use super::*;
use crate::arms::Stream;

const SIZE: [f64; 3] = [0.3, 0.2, 0.1];

/// Points on the faces of the box, off the edges, each moved along its normal by what `off` gives.
fn on_box(count: usize, stream: &mut Stream, off: impl Fn(&mut Stream) -> f64) -> Vec<Point3<f64>> {
    let point = |k: usize| {
        let axis = k % 3;
        let upper = (k / 3) % 2 == 1;
        let mut point = Point3::from(Vector3::from_fn(|axis, _| SIZE[axis] * stream.between(0.1, 0.9)));
        let off = off(stream);
        point[axis] = if upper { SIZE[axis] + off } else { -off };
        point
    };
    (0..count).map(point).collect()
}

fn small() -> Isometry {
    Isometry::new(Vector3::new(2e-3, -1e-3, 1.5e-3), Vector3::new(4e-3, -6e-3, 5e-3))
}

fn all(points: &[Point3<f64>]) -> WeightedPoints<'_> {
    WeightedPoints {
        points,
        weights: None,
    }
}

#[test]
fn a_known_motion_of_exact_points_is_found() {
    let surface = NominalSurface::new(boxed(SIZE, 6)).unwrap();
    // 500 points are used at once, 45 000 a part of them first.
    for count in [500, 45_000] {
        let points = on_box(count, &mut Stream(1), |_| 0.0);
        let moved: Vec<Point3<f64>> = points.iter().map(|p| small() * p).collect();
        let found = best_fit(
            all(&moved),
            &surface,
            &Isometry::identity(),
            &AlignmentOptions::default(),
        )
        .unwrap();
        let left = found.motion * small();
        assert!(
            left.translation.vector.norm() < 1e-12 && left.rotation.angle() < 1e-11,
            "{found:?}"
        );
        assert!(found.rms_after < 1e-12 && found.rms_before > 1e-4, "{found:?}");
        assert_eq!((found.used, found.left_out, found.free.len()), (count, 0, 0));
    }
}

/// What is removed is the change of the deviations, to first order: 5 mrad over 0.2 m squared is 5 um.
#[test]
fn what_alignment_removes_is_reported() {
    let surface = NominalSurface::new(boxed(SIZE, 3)).unwrap();
    let motion = Isometry::new(Vector3::new(2e-5, -1e-5, 1e-5), Vector3::new(1e-4, -2e-4, 1e-4));
    let moved: Vec<Point3<f64>> = on_box(600, &mut Stream(4), |_| 0.0)
        .iter()
        .map(|p| motion * p)
        .collect();
    let options = AlignmentOptions::default();
    let found = best_fit(all(&moved), &surface, &Isometry::identity(), &options).unwrap();
    let before = deviations(&moved, &surface, &Isometry::identity(), &options);
    for deviation in before.into_iter().flatten() {
        let removed = found.removed(&deviation.at, &deviation.normal);
        assert!(
            (removed - deviation.deviation).abs() < 2e-8,
            "{removed} {deviation:?}"
        );
    }
}

#[test]
fn probe_radius_limit_and_weights_are_used() {
    let surface = NominalSurface::new(boxed(SIZE, 3)).unwrap();
    let options = AlignmentOptions {
        probe_radius: 1e-3,
        farthest: 0.01,
    };
    let mut points: Vec<Point3<f64>> = on_box(600, &mut Stream(2), |_| 1e-3);
    points.push(Point3::new(1.0, 0.0, 0.0));
    let found = best_fit(all(&points), &surface, &Isometry::identity(), &options).unwrap();
    assert!(
        found.motion.translation.vector.norm() < 1e-12 && found.rms_after < 1e-12,
        "{found:?}"
    );
    assert_eq!((found.used, found.left_out), (600, 1));
    // The upper face along z is 10 um high in half of its points: twice the weight for them moves the part up by 2/3, not 1/2.
    let mut stream = Stream(8);
    let flat: Vec<Point3<f64>> = (0..4000)
        .map(|k| {
            let high = if k % 2 == 0 { 10e-6 } else { 0.0 };
            Point3::new(
                SIZE[0] * stream.between(0.1, 0.9),
                SIZE[1] * stream.between(0.1, 0.9),
                SIZE[2] + high,
            )
        })
        .collect();
    let weights: Vec<f64> = (0..4000).map(|k| if k % 2 == 0 { 2.0 } else { 1.0 }).collect();
    let weighted = WeightedPoints {
        points: &flat,
        weights: Some(&weights),
    };
    let found = best_fit(
        weighted,
        &surface,
        &Isometry::identity(),
        &AlignmentOptions::default(),
    )
    .unwrap();
    assert!((found.translation.z + 20e-6 / 3.0).abs() < 0.3e-6, "{found:?}");
    // A plane slides and turns along itself.
    assert_eq!(found.free.len(), 3);
    assert!(
        found.translation.xy().norm() < 1e-7 && found.rotation.z.abs() < 1e-12,
        "{found:?}"
    );
}

/// 300 repetitions: the scatter is known to 1/sqrt(600) = 4 %, at most three times that in six values.
#[test]
fn the_covariance_is_the_scatter_of_repetitions() {
    let surface = NominalSurface::new(boxed(SIZE, 1)).unwrap();
    let mut stream = Stream(11);
    let mut squares = Vector6::zeros();
    let mut mean = Vector6::zeros();
    for _ in 0..300 {
        let points = on_box(240, &mut stream, |stream| 5e-6 * stream.normal());
        let found = best_fit(
            all(&points),
            &surface,
            &Isometry::identity(),
            &AlignmentOptions::default(),
        )
        .unwrap();
        let by: Vec<f64> = found
            .translation
            .iter()
            .chain(found.rotation.iter())
            .copied()
            .collect();
        squares += Vector6::from_vec(by).map(|x| x * x) / 300.0;
        mean += found.covariance.diagonal() / 300.0;
    }
    for k in 0..6 {
        let ratio = (squares[k] / mean[k]).sqrt();
        assert!((ratio - 1.0).abs() < 0.13, "{k}: {ratio}");
    }
}

#[test]
fn input_that_cannot_be_aligned_is_refused() {
    let surface = NominalSurface::new(boxed(SIZE, 1)).unwrap();
    let (start, options) = (Isometry::identity(), AlignmentOptions::default());
    let points = on_box(60, &mut Stream(1), |_| 0.0);
    let few = best_fit(all(&points[..5]), &surface, &start, &options);
    assert_eq!(few.unwrap_err(), FormError::TooFew { needed: 6, given: 5 });
    let near = AlignmentOptions {
        farthest: 1e-3,
        ..options
    };
    let away = Isometry::translation(1.0, 0.0, 0.0);
    assert_eq!(
        best_fit(all(&points), &surface, &away, &near).unwrap_err(),
        FormError::TooFew { needed: 6, given: 0 }
    );
    let mut weights = vec![1.0; 60];
    weights[7] = 0.0;
    let weighted = WeightedPoints {
        points: &points,
        weights: Some(&weights),
    };
    assert_eq!(
        best_fit(weighted, &surface, &start, &options).unwrap_err(),
        FormError::NotFinite { index: 7 }
    );
    let short = WeightedPoints {
        points: &points,
        weights: Some(&weights[..9]),
    };
    assert_eq!(
        best_fit(short, &surface, &start, &options).unwrap_err(),
        FormError::Lengths { needed: 60, given: 9 }
    );
    let same = [points[0]; 9];
    assert_eq!(
        best_fit(all(&same), &surface, &start, &options).unwrap_err(),
        FormError::Undetermined
    );
}

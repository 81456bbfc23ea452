use super::*;
use crate::arms::Stream;

/// A box with its corner at the origin, in squares of two triangles.
pub(in crate::form) fn boxed(size: [f64; 3], parts: usize) -> Vec<[Point3<f64>; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for (side, at) in [(false, 0.0), (true, size[axis])] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |i: usize, j: usize| {
                let mut corner = Point3::origin();
                corner[axis] = at;
                corner[u] = size[u] * i as f64 / parts as f64;
                corner[v] = size[v] * j as f64 / parts as f64;
                corner
            };
            for i in 0..parts {
                for j in 0..parts {
                    let [a, b, c, d] = [
                        corner(i, j),
                        corner(i + 1, j),
                        corner(i + 1, j + 1),
                        corner(i, j + 1),
                    ];
                    for [a, b, c] in [[a, b, c], [a, c, d]] {
                        triangles.push(if side { [a, b, c] } else { [a, c, b] });
                    }
                }
            }
        }
    }
    triangles
}

/// Signed distance of a box in closed form.
fn of_box(point: &Point3<f64>, size: [f64; 3]) -> f64 {
    let over = Vector3::from_fn(|k, _| (point[k] - 0.5 * size[k]).abs() - 0.5 * size[k]);
    over.map(|x| x.max(0.0)).norm() + over.max().min(0.0)
}

#[test]
fn deviations_are_the_signed_distance_of_a_box_everywhere() {
    let size = [0.3, 0.2, 0.1];
    let surface = NominalSurface::new(boxed(size, 4)).unwrap();
    let mut stream = Stream(3);
    let mut guess = usize::MAX;
    for _ in 0..3000 {
        let point = Point3::from(stream.vector(0.4));
        let foot = surface.foot(&point, f64::INFINITY).unwrap();
        let expected = of_box(&point, size);
        assert!(
            (foot.deviation.deviation - expected).abs() < 1e-15,
            "{point}: {foot:?} {expected}"
        );
        let back = foot.deviation.at + foot.deviation.normal * foot.deviation.deviation;
        assert!((back - point).norm() < 1e-15);
        let near = surface.foot_near(&point, f64::INFINITY, guess).unwrap();
        assert!((near.deviation.deviation - expected).abs() < 1e-15);
        guess = near.triangle;
    }
    assert_eq!(surface.foot(&Point3::new(1.0, 0.1, 0.05), 0.69), None);
    assert_eq!(surface.foot_near(&Point3::new(1.0, 0.1, 0.05), 0.69, 0), None);
}

#[test]
fn a_point_on_the_surface_has_the_normal_of_its_face_edge_or_vertex() {
    let surface = NominalSurface::new(boxed([1.0, 1.0, 1.0], 2)).unwrap();
    for (point, normal) in [
        ([1.0, 0.3, 0.2], [1.0, 0.0, 0.0]),
        ([1.0, 1.0, 0.2], [1.0, 1.0, 0.0]),
        ([0.0, 0.0, 0.0], [-1.0, -1.0, -1.0]),
    ] {
        let foot = surface.foot(&point.into(), 1.0).unwrap();
        let expected = Vector3::from(normal).normalize();
        assert!((foot.deviation.normal - expected).norm() < 1e-9, "{foot:?}");
        assert_eq!(foot.deviation.deviation, 0.0);
    }
    assert!(NominalSurface::new(Vec::new()).is_none());
}

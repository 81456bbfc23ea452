//! The directions in which a displacement of the tool shows on the surface.
//!
//! ```text
//! T_i = sum of A n n'   over the points of the surface that the moves to and from point i make;   P_i projects on the eigenvectors of T_i with
//!                       lambda > 0.02 lambda_max
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `A`, `n` | area and normal of a point of the surface | m^2, - |
//! | `P_i` | projector: a displacement `d` of the tool at point `i` shows as `P_i d` | - |
//!
//! A flat end mill at a wall makes wall and floor: only a displacement along the feed does not show. Where the moves make no surface that is left, all
//! directions count, so that a path that is compensated by `P_i` remains smooth.
//!
//! Source: \[derived\].

use nalgebra::Matrix3;

use super::surface::SurfaceDeviation;
use crate::removal::EndOrigin;

/// Directions with a smaller part of the surface do not count.
const LEAST: f64 = 0.02;

/// The projector of each of `count` points of a path, frame of the path; the surface is that of the nominal part.
pub fn surface_directions(count: usize, surface: &[SurfaceDeviation]) -> Vec<Matrix3<f64>> {
    let mut sums = vec![Matrix3::zeros(); count];
    for point in surface {
        let EndOrigin::Move(number) = point.nominal_by else {
            continue;
        };
        let of_point = point.normal.into_inner() * point.normal.transpose() * point.area;
        let number = number as usize;
        for index in number.saturating_sub(1)..=number {
            if let Some(sum) = sums.get_mut(index) {
                *sum += of_point;
            }
        }
    }
    sums.iter().map(projector).collect()
}

fn projector(sum: &Matrix3<f64>) -> Matrix3<f64> {
    let eigen = sum.symmetric_eigen();
    let most = eigen.eigenvalues.max();
    if most <= 0.0 {
        return Matrix3::identity();
    }
    let vectors = eigen.eigenvectors.column_iter().zip(eigen.eigenvalues.iter());
    let counted = vectors.filter(|(_, value)| **value > LEAST * most);
    counted.fold(Matrix3::zeros(), |sum, (vector, _)| {
        sum + vector * vector.transpose()
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Unit, Vector3};

    use super::*;

    fn point(number: u32, normal: [f64; 3], area: f64) -> SurfaceDeviation {
        SurfaceDeviation {
            position: Point3::origin(),
            normal: Unit::new_normalize(Vector3::from(normal)),
            deviation: 0.0,
            on_part: Point3::origin(),
            is_same_face: true,
            direction: 2,
            area,
            made_by: EndOrigin::Move(number),
            nominal_by: EndOrigin::Move(number),
        }
    }

    #[test]
    fn wall_and_floor_leave_the_feed_and_no_surface_leaves_nothing() {
        let surface = [
            point(1, [0.0, 0.0, 1.0], 1.0),
            point(1, [0.0, -1.0, 0.0], 0.2),
            point(3, [1.0, 0.0, 1.0], 1.0),
        ];
        let found = surface_directions(5, &surface);
        let wall_and_floor = Matrix3::from_diagonal(&Vector3::new(0.0, 1.0, 1.0));
        assert!((found[0] - wall_and_floor).norm() < 1e-12 && (found[1] - wall_and_floor).norm() < 1e-12);
        let slope = Vector3::new(0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
        assert!((found[3] - slope * slope.transpose()).norm() < 1e-12);
        assert_eq!(found[4], Matrix3::identity());
    }
}

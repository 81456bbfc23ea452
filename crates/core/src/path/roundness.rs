//! What a closed path has become: the circle nearest to its points, and how far they lie off it.

use nalgebra::{Point2, Vector2};

/// The least-squares circle of a closed path, and how far its points lie off it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roundness {
    /// Centre, m.
    pub centre: Point2<f64>,
    /// m
    pub radius: f64,
    /// Peak to valley of the radial distances from the least-squares circle (RONt, LSCI), m.
    pub peak_to_valley: f64,
}

/// Roundness of `points` (m) about their least-squares circle (LSCI); `None` below three points or where they
/// lie on a line.
pub fn roundness(points: &[Point2<f64>]) -> Option<Roundness> {
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mut centre = points.iter().fold(Vector2::zeros(), |sum, p| sum + p.coords) / n;
    let mut radius = points.iter().map(|p| (p.coords - centre).norm()).sum::<f64>() / n;
    // Gauss-Newton on radial distances; quadratic convergence from the centroid of a closed path.
    for _ in 0..50 {
        let mut normal = nalgebra::Matrix3::zeros();
        let mut right = nalgebra::Vector3::zeros();
        for p in points {
            let away = p.coords - centre;
            let distance = away.norm();
            let row = nalgebra::Vector3::new(away.x / distance, away.y / distance, 1.0);
            normal += row * row.transpose();
            right += row * (distance - radius);
        }
        let step = normal
            .lu()
            .solve(&right)
            .filter(|s| s.iter().all(|v| v.is_finite()))?;
        centre += step.xy();
        radius += step.z;
        if step.norm() <= 1e-15 * radius.abs() {
            break;
        }
    }
    let distances = points.iter().map(|p| (p.coords - centre).norm());
    let (low, high) = distances.fold((f64::MAX, f64::MIN), |(low, high), d| (low.min(d), high.max(d)));
    (radius.is_finite() && radius > 0.0).then_some(Roundness {
        centre: centre.into(),
        radius,
        peak_to_valley: high - low,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roundness_of_an_ellipse_like_shift_is_twice_its_amplitude() {
        // r = R + a cos 2 phi has its least-squares circle at R, and peak to valley 2 a.
        let points: Vec<_> = (0..360)
            .map(|i| {
                let phi = f64::from(i).to_radians();
                let r = 0.1 + 20e-6 * (2.0 * phi).cos();
                Point2::new(0.3 + r * phi.cos(), -0.1 + r * phi.sin())
            })
            .collect();
        let round = roundness(&points).unwrap();
        assert!((round.centre - Point2::new(0.3, -0.1)).norm() < 1e-12);
        assert!((round.peak_to_valley - 40e-6).abs() < 1e-9, "{round:?}");
    }

    #[test]
    fn roundness_needs_three_points_off_a_line() {
        let line: Vec<_> = (0..5).map(|i| Point2::new(f64::from(i), 0.0)).collect();
        assert!(roundness(&line[..2]).is_none());
        let fitted = roundness(&line);
        assert!(fitted.is_none_or(|r| r.radius.is_finite()), "{fitted:?}");
    }
}

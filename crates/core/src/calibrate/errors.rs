//! Errors of predicted poses relative to measured ones.

use nalgebra::Vector3;

/// Lengths of many differences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Mean length.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// Greatest.
    pub largest: f64,
}

/// Errors of poses.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseErrors {
    /// Measured less predicted position of each pose, m, axes of the tracker.
    pub position: Vec<Vector3<f64>>,
    /// The same for the rotation, rad, of those with measured rotation.
    pub turn: Vec<Vector3<f64>>,
}

impl Spread {
    /// Of these lengths; `None` of none.
    pub fn of(lengths: impl Iterator<Item = f64>) -> Option<Spread> {
        let (mut count, mut sum, mut squares, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for length in lengths {
            count += 1.0;
            sum += length;
            squares += length * length;
            largest = largest.max(length);
        }
        (count > 0.0).then(|| Spread {
            mean: sum / count,
            rms: (squares / count).sqrt(),
            largest,
        })
    }
}

impl PoseErrors {
    /// Lengths of the errors of position, m; `None` without poses.
    pub fn of_position(&self) -> Option<Spread> {
        Spread::of(self.position.iter().map(Vector3::norm))
    }

    /// Angles of the rotation errors, rad; `None` where no rotation was measured.
    pub fn of_turn(&self) -> Option<Spread> {
        Spread::of(self.turn.iter().map(Vector3::norm))
    }

    /// Root mean square of each axis of position, m.
    pub fn rms_by_axis(&self) -> Vector3<f64> {
        let count = self.position.len().max(1) as f64;
        let squares: Vector3<f64> = self.position.iter().map(|error| error.component_mul(error)).sum();
        (squares / count).map(f64::sqrt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_rms_and_largest_are_of_lengths_and_axes_separately() {
        let errors = PoseErrors {
            position: vec![Vector3::new(3.0, 4.0, 0.0), Vector3::new(0.0, 0.0, -1.0)],
            turn: vec![],
        };
        let spread = errors.of_position().unwrap();
        assert_eq!((spread.mean, spread.largest), (3.0, 5.0));
        assert!((spread.rms - 13f64.sqrt()).abs() < 1e-15);
        assert_eq!(errors.of_turn(), None);
        let expected = Vector3::new(4.5f64.sqrt(), 8f64.sqrt(), 0.5f64.sqrt());
        assert!((errors.rms_by_axis() - expected).norm() < 1e-15);
    }
}

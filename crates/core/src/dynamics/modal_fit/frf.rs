//! A measured frequency response function, as receptance.

use nalgebra::Complex;

/// A point and an axis in which it is moved or measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dof {
    /// Number of the point.
    pub point: i64,
    /// Axis of the measurement: 0, 1, 2 for x, y, z.
    pub axis: usize,
}

impl std::fmt::Display for Dof {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let axis = ["X", "Y", "Z"].get(self.axis).copied().unwrap_or("?");
        write!(f, "{}{axis}", self.point)
    }
}

/// A frequency response function: displacement of one degree of freedom by a force on another.
#[derive(Clone, Debug, PartialEq)]
pub struct Frf {
    /// Where the displacement is measured.
    pub response: Dof,
    /// Where the force acts.
    pub reference: Dof,
    /// Angular frequencies, above 0, rising, rad/s.
    pub angular_frequencies: Vec<f64>,
    /// Receptance at each, m/N.
    pub receptance: Vec<Complex<f64>>,
    /// Inverse standard deviation of the real and the imaginary part at each, up to one common factor; above 0.
    pub weights: Vec<f64>,
}

impl Frf {
    /// The part of it within a band of angular frequencies, rad/s, both ends included.
    pub fn within(&self, band: [f64; 2]) -> Frf {
        let kept: Vec<usize> = (0..self.angular_frequencies.len())
            .filter(|k| (band[0]..=band[1]).contains(&self.angular_frequencies[*k]))
            .collect();
        Frf {
            response: self.response,
            reference: self.reference,
            angular_frequencies: kept.iter().map(|k| self.angular_frequencies[*k]).collect(),
            receptance: kept.iter().map(|k| self.receptance[*k]).collect(),
            weights: kept.iter().map(|k| self.weights[*k]).collect(),
        }
    }

    /// Whether force and displacement are at the same point along the same axis.
    pub fn is_drive_point(&self) -> bool {
        self.response == self.reference
    }

    /// Sum of the squares of the weighted receptance.
    pub(super) fn energy(&self) -> f64 {
        let pairs = self.receptance.iter().zip(&self.weights);
        pairs.map(|(h, w)| h.norm_sqr() * w * w).sum()
    }
}

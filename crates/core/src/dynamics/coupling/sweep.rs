//! Receptance at the tip over a range of frequencies.

use nalgebra::{Complex, Matrix6};

use super::segment::Segment;
use super::tip::{Base, Body, NotFinite, tip_receptance};

/// Angular frequencies at equal ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Lowest, above 0, rad/s.
    pub low: f64,
    /// Highest, above the lowest, rad/s.
    pub high: f64,
    /// How many, at least 2.
    pub count: usize,
}

impl Frequencies {
    /// All of them, rising, rad/s.
    pub fn all(&self) -> Vec<f64> {
        let last = self.count.max(2) - 1;
        let ratio = self.high / self.low;
        let mut all: Vec<f64> = (0..=last)
            .map(|k| self.low * ratio.powf(k as f64 / last as f64))
            .collect();
        all[last] = self.high;
        all
    }
}

/// Receptance at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swept {
    /// Angular frequency, rad/s.
    pub w: f64,
    /// Where the first segment begins, without the segments; zero of a rigid machine.
    pub base: Matrix6<Complex<f64>>,
    /// At the tip.
    pub tip: Matrix6<Complex<f64>>,
}

/// Receptance of a machine (`machine` at an angular frequency), with a rigid body, and of the tip of the segments on it.
///
/// # Errors
/// An undamped resonance at exactly one of the frequencies.
pub fn sweep(
    machine: impl Fn(f64) -> Matrix6<Complex<f64>>,
    body: Option<&Body>,
    segments: &[Segment],
    frequencies: &[f64],
) -> Result<Vec<Swept>, NotFinite> {
    let at = |w: &f64| {
        let machine = machine(*w);
        let base = body.map_or(Ok(machine), |body| body.added_to(&machine, *w))?;
        let tip = tip_receptance(&Base::Receptance(&base), segments, *w)?;
        Ok(Swept { w: *w, base, tip })
    };
    frequencies.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequencies_have_equal_ratios_and_both_ends() {
        let all = Frequencies {
            low: 10.0,
            high: 1000.0,
            count: 3,
        }
        .all();
        assert_eq!([all[0], all[2]], [10.0, 1000.0]);
        assert!((all[1] - 100.0).abs() < 1e-12);
    }
}

//! Errors of one model on one set of measurements.

use nalgebra::Vector3;

use armill_core::learn::HeldOut;
use armill_core::units::to_mm;

/// Half width of a 95 % interval of a normal distribution, standard deviations.
pub const NORMAL_95: f64 = 1.959_964;

/// The uncertainty that the model stated for its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stated {
    /// None.
    Nothing,
    /// Fraction of the errors within the 95 % intervals of the model.
    Coverage(f64),
}

/// Errors of one model on one set of measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What was predicted, and from what.
    pub quantity: String,
    /// The model.
    pub model: String,
    /// Unit of the errors.
    pub unit: &'static str,
    /// Sizes of the errors, one per measurement.
    pub errors: Vec<f64>,
    /// Stated uncertainty.
    pub stated: Stated,
}

/// Mean, root mean square, 95 % and largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
    /// 95 % of the errors are within: the value of this rank.
    pub p95: f64,
    /// Largest.
    pub largest: f64,
}

impl Comparison {
    /// Statistics of the errors.
    pub fn sizes(&self) -> Sizes {
        let mut sorted: Vec<f64> = self.errors.iter().map(|error| error.abs()).collect();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len().max(1) as f64;
        let rank = (0.95 * count).ceil() as usize;
        Sizes {
            mean: sorted.iter().sum::<f64>() / count,
            rms: (sorted.iter().map(|size| size * size).sum::<f64>() / count).sqrt(),
            p95: sorted.get(rank.saturating_sub(1)).copied().unwrap_or(f64::NAN),
            largest: sorted.last().copied().unwrap_or(f64::NAN),
        }
    }

    /// Positions by the nominal, the calibrated and the learnt model, mm.
    pub fn of_models(quantity: &str, errors: &HeldOut) -> Vec<Comparison> {
        let of = |model: &str, errors: &[Vector3<f64>], stated| Comparison {
            quantity: quantity.to_owned(),
            model: model.to_owned(),
            unit: "mm",
            errors: errors.iter().map(|error| to_mm(error.norm())).collect(),
            stated,
        };
        vec![
            of("nominal", &errors.nominal, Stated::Nothing),
            of("calibrated", &errors.calibrated, Stated::Nothing),
            of(
                "calibrated and learnt",
                &errors.learnt,
                Stated::Coverage(errors.coverage),
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_the_signless_errors() {
        let comparison = Comparison {
            quantity: String::new(),
            model: String::new(),
            unit: "mm",
            errors: (1..=20)
                .map(|k| if k % 2 == 0 { f64::from(k) } else { -f64::from(k) })
                .collect(),
            stated: Stated::Nothing,
        };
        let sizes = comparison.sizes();
        assert_eq!((sizes.mean, sizes.p95, sizes.largest), (10.5, 19.0, 20.0));
        // The sum of the first n squares is n (n + 1) (2 n + 1) / 6.
        assert!((sizes.rms - (20.0 * 21.0 * 41.0 / 6.0 / 20.0_f64).sqrt()).abs() < 1e-12);
    }
}

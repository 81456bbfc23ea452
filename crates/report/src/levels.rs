//! The levels of a filled map: 6 to 12 bands between nice numbers, shared by all panels of a sheet.
//!
//! Edges are multiples of the nice step `s >= (high - low) / 11`, from `floor(low / s) s` to `ceil(high / s) s`, um.
//!
//! ```text
//! values   13 ... 214      step 20 (the smallest nice step not below 201 / 11)
//! edges    0  20  40  ...  200  220         11 bands, 10 inner edges with iso-lines
//! ```
//!
//! All values equal: one band of one nice step about them.

use crate::axis::{extent, multiples, nice_step, tick_label};
use crate::colour::ColourScale;

/// Bands between equally spaced nice values in um.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Levels {
    /// Edges of the bands, rising; one more than there are bands, at least two.
    pub(crate) edge_um: Vec<f64>,
    /// Distance of the edges.
    pub(crate) step_um: f64,
}

/// Target number of bands: the nice step gives between half of this and this, plus one.
const BANDS: f64 = 11.0;

impl Levels {
    /// Bands that cover all finite values; one band if they are all equal, to a billionth of their size. `None`
    /// where no value is finite.
    pub(crate) fn covering(values_um: impl IntoIterator<Item = f64>) -> Option<Self> {
        let (low, high) = extent(values_um)?;
        let size = low.abs().max(high.abs());
        if high - low <= 1e-9 * size {
            let step_um = nice_step(size.max(1.0), 10.0);
            return Some(Self {
                edge_um: vec![low - step_um / 2.0, low + step_um / 2.0],
                step_um,
            });
        }
        let step_um = nice_step(high - low, BANDS);
        // The value at the very edge belongs inside: a hair of slack keeps round data from getting an empty band.
        let first = (low / step_um + 1e-9).floor() * step_um;
        let last = ((high / step_um - 1e-9).ceil() * step_um).max(first + step_um);
        let edge_um = multiples(first, last, step_um);
        if edge_um.len() < 2 {
            return Some(Self {
                edge_um: vec![low, high],
                step_um: high - low,
            });
        }
        Some(Self { edge_um, step_um })
    }

    /// How many there are.
    pub(crate) fn bands(&self) -> usize {
        self.edge_um.len().saturating_sub(1)
    }

    /// The edges between bands: where iso-lines run.
    pub(crate) fn inner_um(&self) -> &[f64] {
        self.edge_um.get(1..self.bands()).unwrap_or(&[])
    }

    /// Colour of a band, counted from 0: the lowest has the first of the scale, the highest the last.
    pub(crate) fn colour(&self, band: usize, scale: ColourScale) -> String {
        let last = self.bands().saturating_sub(1).max(1) as f64;
        scale.at(band as f64 / last)
    }

    /// A value (um) with the decimals that the step needs.
    pub(crate) fn label(&self, value_um: f64) -> String {
        tick_label(value_um, self.step_um)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_six_to_twelve_bands_that_cover_the_values() {
        for (low, high) in [
            (0.0, 1.0),
            (13.0, 214.0),
            (-40.0, 71.0),
            (1e-3, 2e-3),
            (99.0, 100.0),
        ] {
            let l = Levels::covering([low, high]).expect("finite values");
            assert!((5..=13).contains(&l.bands()), "{low} {high}: {}", l.bands());
            assert!(l.edge_um[0] <= low + 1e-9 && l.edge_um[l.bands()] >= high - 1e-9);
        }
    }

    #[test]
    fn equal_values_make_one_band() {
        assert_eq!(Levels::covering([12.0, 12.0]).map(|l| l.bands()), Some(1));
        assert_eq!(Levels::covering([f64::NAN]), None);
    }
}

//! Colours: one scale for fields, one colour-blind-safe set for cases, and the greys of axes.
//!
//! Fields use viridis (perceptually even, readable in grey), those with signs blue and red (ColorBrewer); cases use the set of Okabe and Ito (2008).
//!
//! | what | how it is distinguished |
//! |---|---|
//! | a value in a field | lightness of the scale: low is dark, high is light |
//! | load cases, joints, series | ten colours by number, then from the first again |
//! | the tolerance | red; so are the softest direction, the path on a drawn arm and its x direction |
//! | within, undecided, over | green, sand, grey of similar lightness, the tolerance between them |
//!
//! Sources: the gradients of the crate `colorous`; Okabe and Ito, Color Universal Design (2008); Paul Tol's
//! muted set (2021).

/// Text and axes.
pub(crate) const INK: &str = "#1b1b1b";
/// Secondary text.
pub(crate) const MUTED: &str = "#5a5a5a";
/// What was meant, behind what came of it: nominal paths, places that no tool reaches.
pub(crate) const NOMINAL: &str = "#9a9a9a";
/// Lines that help to read a drawing of a few lines.
pub(crate) const FAINT: &str = "#c9c9c9";
/// The ground of a drawing that has nothing to show.
pub(crate) const EMPTY: &str = "#f6f6f6";
/// Edges of the fields in a legend.
pub(crate) const KEY_EDGE: &str = "#8a8a8a";
/// Grid lines inside charts.
pub(crate) const GRID: &str = "#e3e3e3";
/// What the eye shall find first.
pub(crate) const SIGNAL: &str = "#c8102e";
/// The tolerance, on every picture.
pub(crate) const TOLERANCE: &str = SIGNAL;
/// Permissible region.
pub(crate) const WITHIN: &str = "#b7dcc9";
/// The tolerance is within the uncertainty of the value.
pub(crate) const UNDECIDED: &str = "#f2e3b3";
/// Over the tolerance.
pub(crate) const OVER: &str = "#d9d9d9";

/// Share of white mixed into the field colours, so that dark labels stay readable on them.
const SOFTENING: f64 = 0.12;

/// Seven joints, base, flange and tool; the last two are of Paul Tol's muted set (2021).
const CATEGORIES: [&str; 10] = [
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#5a5a5a", "#b5a900", "#882255",
    "#332288",
];

/// Which colour scale a field is drawn in. The first two rise steadily in lightness, so that they read in grey.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourScale {
    /// Dark violet over green to yellow.
    #[default]
    Viridis,
    /// Dark blue over grey to yellow; readable with all common types of colour blindness. The pictures of a study do
    /// not use it.
    Cividis,
    /// Blue over light grey to red, for values with signs on a range that is symmetric about zero.
    BlueRed,
}

impl ColourScale {
    /// Red, green and blue at `t` from 0 (low) to 1 (high); beyond these the nearer end, and the low end for what is not
    /// finite.
    pub fn rgb(self, t: f64) -> [u8; 3] {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Cividis => colorous::CIVIDIS,
            Self::BlueRed => colorous::RED_BLUE,
        };
        let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
        let t = if self == Self::BlueRed { 1.0 - t } else { t };
        let c = gradient.eval_continuous(t);
        [c.r, c.g, c.b]
    }

    /// The colour at `t` as text, softened.
    pub(crate) fn at(self, t: f64) -> String {
        mix(self.rgb(t), [255, 255, 255], SOFTENING)
    }
}

/// Colour of the `index`-th case, joint or series, counted from 0; after ten they begin again.
pub(crate) const fn category(index: usize) -> &'static str {
    CATEGORIES[index % CATEGORIES.len()]
}

/// `#rrggbb` between `a` and `b`, at `share` of the way to `b`, each channel separately.
pub(crate) fn mix(a: [u8; 3], b: [u8; 3], share: f64) -> String {
    let channel = |k: usize| (f64::from(a[k]) * (1.0 - share) + f64::from(b[k]) * share).round();
    format!(
        "#{:02x}{:02x}{:02x}",
        channel(0) as u8,
        channel(1) as u8,
        channel(2) as u8
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_grow_lighter() {
        for scale in [ColourScale::Viridis, ColourScale::Cividis] {
            let lightness = |t: f64| {
                let c = scale.at(t);
                (0..3)
                    .map(|k| u32::from_str_radix(&c[1 + 2 * k..3 + 2 * k], 16).unwrap_or(0))
                    .sum::<u32>()
            };
            assert!(lightness(0.0) < lightness(0.5) && lightness(0.5) < lightness(1.0));
        }
    }

    #[test]
    fn a_position_that_is_no_number_has_a_colour() {
        assert_eq!(ColourScale::Viridis.at(f64::NAN), ColourScale::Viridis.at(0.0));
    }
}

//! The tolerance on a picture: its line, what is written on it, and its entry in a legend.
//!
//! One colour and one wording on all pictures, so that the eye finds the tolerance without the legend. A tolerance is a
//! permissible deviation in um; one that is not finite is not drawn.

use crate::axis::{extent, plain};
use crate::colour::TOLERANCE;
use crate::font::SMALL_PX;
use crate::legend::Entry;
use crate::svg::{Style, Text};

/// The line of the tolerance, on drawings and in their legends.
pub(crate) fn style() -> Style {
    Style::line(TOLERANCE, 2.4)
}

/// The ground of the line where it runs over bands of colour: a wider, nearly opaque line of white.
pub(crate) fn ground_style() -> Style {
    Style::line("#fff", 4.6).opacity(0.9)
}

/// How a text on the tolerance is set: small, bold, in the colour of the line.
pub(crate) fn text() -> Text {
    Text::new(SMALL_PX).bold().colour(TOLERANCE)
}

/// `tolerance 50 µm`.
pub(crate) fn label(tolerance_um: f64) -> String {
    format!("tolerance {} µm", plain(tolerance_um))
}

/// The legend's entry: the line, its label, and a remark that follows the label unchanged, its blank or
/// colon included.
pub(crate) fn entry(tolerance_um: f64, remark: &str) -> Entry {
    Entry::line(style(), format!("{}{remark}", label(tolerance_um)))
}

/// The entry of a tolerance over these values, with a remark where no line shows it; none for a tolerance that is not a
/// number. A value that is not a number is a point without a usable result.
pub(crate) fn entry_over(tolerance_um: Option<f64>, values_um: impl Iterator<Item = f64>) -> Option<Entry> {
    let tolerance = tolerance_um.filter(|tolerance| tolerance.is_finite())?;
    let mut all_have_a_result = true;
    let finite = values_um.filter(|value| {
        all_have_a_result &= value.is_finite();
        value.is_finite()
    });
    let remark = match extent(finite) {
        Some((_, high)) if tolerance > high && !all_have_a_result => " (met at every usable point)",
        Some((low, _)) if tolerance <= low => " (exceeded everywhere)",
        Some((_, high)) if tolerance > high => " (met everywhere)",
        _ => "",
    };
    Some(entry(tolerance, remark))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tolerance_outside_the_values_has_a_remark_and_an_infinite_one_no_entry() {
        let given =
            |tolerance| entry_over(tolerance, [10.0, f64::NAN, 20.0].into_iter()).map(|entry| entry.label);
        assert_eq!(
            given(Some(10.0)).as_deref(),
            Some("tolerance 10 µm (exceeded everywhere)")
        );
        assert_eq!(given(Some(15.0)).as_deref(), Some("tolerance 15 µm"));
        assert_eq!(
            given(Some(20.5)).as_deref(),
            Some("tolerance 20.5 µm (met at every usable point)")
        );
        let reached = entry_over(Some(20.5), [10.0, 20.0].into_iter()).map(|entry| entry.label);
        assert_eq!(reached.as_deref(), Some("tolerance 20.5 µm (met everywhere)"));
        assert_eq!(given(Some(f64::INFINITY)), None);
        assert_eq!(given(None), None);
    }
}

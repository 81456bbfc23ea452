//! How wide a text is when set in DejaVu Sans, so that labels can keep out of each other's way.
//!
//! The widths are the advance widths of the two embedded fonts (`fonts/`), in thousandths of the font size; kerning is
//! left out.
//!
//! A picture is laid out before it is rendered: whether two labels meet, where a line of the title breaks and
//! how wide the numbers of an axis are has to be known without a font engine.

use crate::advances::RUNS;

/// A run of characters that follow each other in Unicode, with their advance widths in thousandths of the font size.
pub(crate) struct Run {
    /// Code of the first character.
    pub(crate) first: u32,
    /// Widths in the regular font, one for each character of the run.
    pub(crate) regular: &'static [u16],
    /// Widths in the bold font, as many as regular ones.
    pub(crate) bold: &'static [u16],
}

/// Weight of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weight {
    /// As nearly every text.
    Regular,
    /// As titles, names and the tolerance.
    Bold,
}

/// Width of a character that the embedded font lacks: that of a capital letter.
const UNKNOWN_ADVANCE: u16 = 700;

/// Width of `text` in pixels at `size_px`.
pub(crate) fn text_width_px(text: &str, size_px: f64, weight: Weight) -> f64 {
    let thousandths: f64 = text.chars().map(|c| f64::from(advance(c, weight))).sum();
    thousandths * size_px / 1000.0
}

/// `text` cut at white space into lines no wider than `width_px`; a single word that is wider stays whole. No
/// line for an empty text; the words of a line are joined by one blank.
pub(crate) fn wrap(text: &str, size_px: f64, weight: Weight, width_px: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width_px(&format!("{line} {word}"), size_px, weight) <= width_px => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The width of one character in thousandths of the font size.
fn advance(c: char, weight: Weight) -> u16 {
    let code = u32::from(c);
    let after = RUNS.partition_point(|run| run.first <= code);
    let found = after.checked_sub(1).and_then(|i| {
        let run = &RUNS[i];
        let widths = match weight {
            Weight::Regular => run.regular,
            Weight::Bold => run.bold,
        };
        usize::try_from(code - run.first).ok().and_then(|k| widths.get(k))
    });
    found.copied().unwrap_or(UNKNOWN_ADVANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_in_order_of_code_points() {
        assert!(RUNS.windows(2).all(|w| w[0].first < w[1].first));
        assert!(RUNS.iter().all(|r| r.regular.len() == r.bold.len()));
    }

    #[test]
    fn bold_is_wider_than_regular() {
        assert!(
            text_width_px("deviation", 12.0, Weight::Bold)
                > text_width_px("deviation", 12.0, Weight::Regular)
        );
    }

    #[test]
    fn micro_and_minus_are_in_the_table() {
        for c in [
            'µ', 'μ', '−', '°', '±', '≤', '≥', '×', '→', '²', '‰', '–', 'α', 'δ',
        ] {
            assert_ne!(advance(c, Weight::Regular), UNKNOWN_ADVANCE, "{c}");
        }
    }

    #[test]
    fn wrapped_lines_keep_within_the_width() {
        let lines = wrap("one two three four five six seven", 12.0, Weight::Regular, 80.0);
        assert!(lines.len() > 1);
        assert!(
            lines
                .iter()
                .all(|l| text_width_px(l, 12.0, Weight::Regular) <= 80.0)
        );
    }
}

//! The two embedded fonts (`fonts/`), the sizes of texts, and how wide a text is in DejaVu Sans.
//!
//! A picture is laid out before it is rendered: whether two labels meet, where a line of the title breaks and
//! how wide the numbers of an axis are has to be known without a renderer. Widths are the advance widths of the fonts in
//! whole thousandths of the font size; kerning is left out.

use std::sync::LazyLock;

use read_fonts::tables::{cmap::Cmap, hmtx::Hmtx};
use read_fonts::types::GlyphId;
use read_fonts::{FontRef, ReadError, TableProvider};

/// The subsets of `DejaVu Sans` with the characters that pictures use; their licence is next to them.
pub(crate) const REGULAR: &[u8] = include_bytes!("../fonts/DejaVuSans.subset.ttf");
pub(crate) const BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold.subset.ttf");

/// Font sizes: title, everything else, ticks and labels inside the drawing.
pub(crate) const TITLE_PX: f64 = 15.0;
pub(crate) const BODY_PX: f64 = 12.0;
pub(crate) const SMALL_PX: f64 = 11.0;

/// Weight of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weight {
    /// As nearly every text.
    Regular,
    /// As titles, names and the tolerance.
    Bold,
}

/// Width of a character that the embedded font lacks: that of a capital letter.
const UNKNOWN_ADVANCE: f64 = 700.0;

/// The widths of both fonts, regular and bold, read once.
static ADVANCES: LazyLock<[Option<Advances>; 2]> =
    LazyLock::new(|| [REGULAR, BOLD].map(|font| Advances::read(font).ok()));

/// Width of `text` in pixels at `size_px`.
pub(crate) fn text_width_px(text: &str, size_px: f64, weight: Weight) -> f64 {
    let thousandths: f64 = text.chars().map(|c| advance(c, weight)).sum();
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
fn advance(c: char, weight: Weight) -> f64 {
    let [regular, bold] = &*ADVANCES;
    let advances = match weight {
        Weight::Regular => regular,
        Weight::Bold => bold,
    };
    let known = advances.as_ref().and_then(|advances| advances.of(c));
    known.unwrap_or(UNKNOWN_ADVANCE)
}

/// The tables of a font that its widths are read from.
struct Advances {
    glyphs: Cmap<'static>,
    widths: Hmtx<'static>,
    units_per_em: f64,
}

impl Advances {
    fn read(font: &'static [u8]) -> Result<Self, ReadError> {
        let font = FontRef::new(font)?;
        Ok(Self {
            glyphs: font.cmap()?,
            widths: font.hmtx()?,
            units_per_em: f64::from(font.head()?.units_per_em()),
        })
    }

    /// Thousandths of the font size; `None` where the font lacks the character.
    fn of(&self, c: char) -> Option<f64> {
        let glyph = self
            .glyphs
            .map_codepoint(c)
            .filter(|glyph| *glyph != GlyphId::NOTDEF)?;
        let units = self.widths.advance(glyph)?;
        Some((f64::from(units) * 1000.0 / self.units_per_em).round())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_fonts() {
        let pinned = [
            (' ', 318.0, 348.0),
            ('0', 636.0, 696.0),
            ('M', 863.0, 995.0),
            ('i', 278.0, 343.0),
            ('ß', 630.0, 719.0),
            ('µ', 636.0, 736.0),
            ('°', 500.0, 500.0),
            ('≤', 838.0, 838.0),
            ('⊥', 871.0, 914.0),
            ('■', 945.0, 945.0),
            ('日', UNKNOWN_ADVANCE, UNKNOWN_ADVANCE),
        ];
        for (c, regular, bold) in pinned {
            assert_eq!(advance(c, Weight::Regular), regular, "{c}");
            assert_eq!(advance(c, Weight::Bold), bold, "{c}");
        }
        assert!((text_width_px("0i0", 20.0, Weight::Regular) - 31.0).abs() < 1e-12);
    }

    #[test]
    fn characters_of_pictures_are_in_both_fonts() {
        for c in [
            'µ', 'μ', '−', '°', '±', '≤', '≥', '×', '→', '²', '‰', '–', 'α', 'δ',
        ] {
            for advances in &*ADVANCES {
                assert!(
                    advances.as_ref().is_some_and(|advances| advances.of(c).is_some()),
                    "{c}"
                );
            }
        }
    }

    #[test]
    fn bold_is_wider_than_regular() {
        assert!(
            text_width_px("deviation", 12.0, Weight::Bold)
                > text_width_px("deviation", 12.0, Weight::Regular)
        );
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

//! The legend below a drawing: signs with what they mean, in rows.
//!
//! ```text
//! [key] label    [key] label    [key] label      a key is 24 px wide, a row 20 px high
//! [key] label
//! ```
//!
//! Entries keep their order; one that does not fit into a row begins the next.

use crate::colour::KEY_EDGE;
use crate::font::{SMALL_PX, Weight, text_width_px};
use crate::svg::{Point, Rect, Style, Svg, Text};

const ROW_PX: f64 = 20.0;
/// Width of a sign, the gap to its label, and the gap to the next entry.
const KEY_PX: f64 = 24.0;
const LABEL_GAP_PX: f64 = 6.0;
const ENTRY_GAP_PX: f64 = 18.0;
/// Height of a field in a legend.
const FIELD_PX: f64 = 13.0;

/// The sign in front of a legend entry, drawn in the style of the object on the picture.
pub(crate) enum Key {
    /// A filled field, as areas and bands have.
    Field(Style),
    /// Lines drawn over each other, the first at the bottom: a line with the white ground under it.
    Line(Vec<Style>),
    /// A line of several pieces, one after the other: one thing in several colours. Not checked: that there is
    /// a piece.
    Pieces(Vec<Style>),
    /// An upright stroke.
    Stroke(Style),
    /// Two strokes across each other.
    Cross(Style),
    /// A filled dot.
    Dot(Style),
    /// A diamond.
    Diamond(Style),
}

impl Key {
    /// A field of the drawing in small, with a thin edge.
    pub(crate) fn field(fill: &str) -> Self {
        Self::Field(Style::fill(fill).outlined(KEY_EDGE, 0.8))
    }

    fn draw(&self, svg: &mut Svg, [x, middle]: Point) {
        let centre = [x + KEY_PX / 2.0, middle];
        match self {
            Self::Field(style) => {
                let field = Rect {
                    x,
                    y: middle - FIELD_PX / 2.0,
                    w: KEY_PX,
                    h: FIELD_PX,
                };
                svg.rect(field, style);
            }
            Self::Line(styles) => {
                for style in styles {
                    svg.line([x + 2.0, middle], [x + KEY_PX - 2.0, middle], style);
                }
            }
            Self::Pieces(styles) => {
                let piece = (KEY_PX - 4.0) / styles.len() as f64;
                for (k, style) in styles.iter().enumerate() {
                    let from = x + 2.0 + piece * k as f64;
                    svg.line([from, middle], [from + piece, middle], style);
                }
            }
            Self::Stroke(style) => {
                let [x, y] = centre;
                svg.line([x, y - 7.0], [x, y + 7.0], style);
            }
            Self::Cross(style) => draw_cross(svg, centre, 5.0, style),
            Self::Dot(style) => svg.circle(centre, 3.5, style),
            Self::Diamond(style) => svg.polygon(&diamond(centre, 5.0), style),
        }
    }
}

/// One entry of a legend.
pub(crate) struct Entry {
    pub(crate) key: Key,
    pub(crate) label: String,
}

impl Entry {
    pub(crate) fn new(key: Key, label: impl Into<String>) -> Self {
        Self {
            key,
            label: label.into(),
        }
    }

    /// A single line.
    pub(crate) fn line(style: Style, label: impl Into<String>) -> Self {
        Self::new(Key::Line(vec![style]), label)
    }

    fn width_px(&self) -> f64 {
        KEY_PX + LABEL_GAP_PX + text_width_px(&self.label, SMALL_PX, Weight::Regular) + ENTRY_GAP_PX
    }
}

/// Writes the entries in rows no wider than `width_px`, from `at` (top left); the answer is the y below them.
pub(crate) fn draw_legend(svg: &mut Svg, entries: &[Entry], at: Point, width_px: f64) -> f64 {
    if entries.is_empty() {
        return at[1];
    }
    let [mut x, mut y] = at;
    for entry in entries {
        if x > at[0] && x + entry.width_px() - ENTRY_GAP_PX > at[0] + width_px {
            x = at[0];
            y += ROW_PX;
        }
        let middle = y + ROW_PX / 2.0;
        entry.key.draw(svg, [x, middle]);
        svg.text(
            [x + KEY_PX + LABEL_GAP_PX, middle + 4.0],
            &entry.label,
            &Text::new(SMALL_PX),
        );
        x += entry.width_px();
    }
    y + ROW_PX
}

/// Two strokes across each other at a point.
pub(crate) fn draw_cross(svg: &mut Svg, [x, y]: Point, half_px: f64, style: &Style) {
    for side in [half_px, -half_px] {
        svg.line([x - half_px, y - side], [x + half_px, y + side], style);
    }
}

/// The four corners of a diamond.
pub(crate) fn diamond([x, y]: Point, half_px: f64) -> [Point; 4] {
    [
        [x, y - half_px],
        [x + half_px, y],
        [x, y + half_px],
        [x - half_px, y],
    ]
}

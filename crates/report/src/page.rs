//! What every picture has around its drawing: title block, legend, and the picture that says why there is nothing to draw.

use crate::colour::{EMPTY, INK, KEY_EDGE, MUTED};
use crate::font::{Weight, text_width_px, wrap};
use crate::svg::{Anchor, Point, Rect, Style, Svg, Text};

/// Blank border of every picture.
pub(crate) const BORDER_PX: f64 = 18.0;
/// Font sizes: title, everything else, ticks and labels inside the drawing.
pub(crate) const TITLE_PX: f64 = 15.0;
pub(crate) const BODY_PX: f64 = 12.0;
pub(crate) const SMALL_PX: f64 = 11.0;

const LEGEND_ROW_PX: f64 = 20.0;
const KEY_PX: f64 = 24.0;

/// Writes title and subtitle at the top left; the answer is the y below them.
pub(crate) fn title_block(svg: &mut Svg, title: &str, subtitle: &str, width_px: f64) -> f64 {
    let room = width_px - 2.0 * BORDER_PX;
    let mut y = BORDER_PX;
    for line in wrap(title, TITLE_PX, Weight::Bold, room) {
        y += TITLE_PX;
        svg.text([BORDER_PX, y], &line, &Text::new(TITLE_PX).bold());
        y += 5.0;
    }
    for line in wrap(subtitle, BODY_PX, Weight::Regular, room) {
        y += BODY_PX;
        svg.text([BORDER_PX, y], &line, &Text::new(BODY_PX).colour(MUTED));
        y += 4.0;
    }
    y + 8.0
}

/// The sign in front of a legend entry.
pub(crate) enum Key {
    /// A filled field.
    Field(Style),
    /// Lines drawn over each other.
    Line(Vec<Style>),
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

    fn width_px(&self) -> f64 {
        KEY_PX + 6.0 + text_width_px(&self.label, SMALL_PX, Weight::Regular) + 18.0
    }
}

/// Writes the entries in rows no wider than `width_px`, from `at` (top left); the answer is the y below them.
pub(crate) fn legend(svg: &mut Svg, entries: &[Entry], at: Point, width_px: f64) -> f64 {
    if entries.is_empty() {
        return at[1];
    }
    let (mut x, mut y) = (at[0], at[1]);
    for entry in entries {
        if x > at[0] && x + entry.width_px() - 18.0 > at[0] + width_px {
            x = at[0];
            y += LEGEND_ROW_PX;
        }
        let middle = y + LEGEND_ROW_PX / 2.0;
        let centre = [x + KEY_PX / 2.0, middle];
        match &entry.key {
            Key::Field(style) => svg.rect(
                Rect {
                    x,
                    y: middle - 6.5,
                    w: KEY_PX,
                    h: 13.0,
                },
                style,
            ),
            Key::Line(styles) => {
                for style in styles {
                    svg.line([x + 2.0, middle], [x + KEY_PX - 2.0, middle], style);
                }
            }
            Key::Dot(style) => svg.circle(centre, 3.5, style),
            Key::Diamond(style) => svg.polygon(&diamond(centre, 5.0), style),
        }
        svg.text(
            [x + KEY_PX + 6.0, middle + 4.0],
            &entry.label,
            &Text::new(SMALL_PX),
        );
        x += entry.width_px();
    }
    y + LEGEND_ROW_PX
}

/// The four corners of a diamond.
pub(crate) fn diamond(centre: Point, half_px: f64) -> [Point; 4] {
    let [x, y] = centre;
    [
        [x, y - half_px],
        [x + half_px, y],
        [x, y + half_px],
        [x - half_px, y],
    ]
}

/// A picture that says why there is nothing to draw.
pub(crate) fn notice(title: &str, subtitle: &str, reason: &str) -> String {
    let width = 520.0;
    let mut svg = Svg::new();
    let top = title_block(&mut svg, title, subtitle, width);
    let lines = wrap(reason, BODY_PX, Weight::Regular, width - 2.0 * BORDER_PX - 40.0);
    let height = 60.0 + 18.0 * lines.len() as f64;
    let card = Rect {
        x: BORDER_PX,
        y: top,
        w: width - 2.0 * BORDER_PX,
        h: height,
    };
    svg.rounded(card, 4.0, &Style::fill(EMPTY).outlined("#c4c4c4", 1.0));
    for (k, line) in lines.iter().enumerate() {
        let y = top + 38.0 + 18.0 * k as f64;
        svg.text(
            [card.centre()[0], y],
            line,
            &Text::new(BODY_PX).middle().colour(INK),
        );
    }
    svg.finish(width, top + height + BORDER_PX, title)
}

/// The rectangle that a text takes up, for keeping labels apart.
pub(crate) fn text_box(at: Point, content: &str, size_px: f64, anchor: Anchor) -> Rect {
    let w = text_width_px(content, size_px, Weight::Regular);
    let x = match anchor {
        Anchor::Start => at[0],
        Anchor::Middle => at[0] - w / 2.0,
        Anchor::End => at[0] - w,
    };
    Rect {
        x,
        y: at[1] - 0.8 * size_px,
        w,
        h: size_px,
    }
}

/// Whether two rectangles share a point.
pub(crate) fn overlap(a: &Rect, b: &Rect) -> bool {
    a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom()
}

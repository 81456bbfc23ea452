//! What every picture has around its drawing: title block, border and legend; and the picture that says why there is
//! nothing to draw.
//!
//! All lengths are pixels of the picture, y downwards.
//!
//! ```text
//! border 18 px
//!   Title, bold 15 px, as many lines as it needs
//!   Subtitle, 12 px, grey
//!   ─ top_px ─
//!   drawing (its own business)
//!   legend
//! border 18 px
//! ```

use crate::colour::{EMPTY, INK, MUTED};
use crate::font::{BODY_PX, TITLE_PX, Weight, text_width_px, wrap};
use crate::legend::{Entry, draw_legend};
use crate::svg::{Anchor, Point, Rect, Style, Svg, Text};

/// Blank border of every picture.
pub(crate) const BORDER_PX: f64 = 18.0;
/// A map is at least this wide, for its title and legend.
pub(crate) const LEAST_WIDTH_PX: f64 = 430.0;

/// Under each line of title and subtitle, and under both.
const TITLE_GAP_PX: f64 = 5.0;
const SUBTITLE_GAP_PX: f64 = 4.0;
const UNDER_TITLE_PX: f64 = 8.0;

/// The picture that says why: its width, the border of its card, the height of a line, and the room above and below.
const NOTICE_PX: f64 = 520.0;
const NOTICE_INSET_PX: f64 = 20.0;
const NOTICE_LINE_PX: f64 = 18.0;
const NOTICE_ROOM_PX: f64 = 60.0;
const NOTICE_FIRST_LINE_PX: f64 = 38.0;

/// First and second line of a picture; each is broken at blanks where it is wider than the page.
#[derive(Clone, Copy)]
pub(crate) struct Heading<'a> {
    /// What is shown; it also describes the picture to screen readers.
    pub(crate) title: &'a str,
    /// Under which conditions; empty for none.
    pub(crate) subtitle: &'a str,
}

/// A picture that has its title block and waits for its drawing, which begins at `top_px`.
pub(crate) struct Page<'a> {
    pub(crate) svg: Svg,
    /// Where the title block ends and the drawing may begin, from the upper edge.
    pub(crate) top_px: f64,
    width_px: f64,
    title: &'a str,
}

impl<'a> Heading<'a> {
    /// The two lines as they are to be read.
    pub(crate) fn new(title: &'a str, subtitle: &'a str) -> Self {
        Self { title, subtitle }
    }

    /// A picture of this width with title and subtitle at its top left.
    pub(crate) fn page(self, width_px: f64) -> Page<'a> {
        let mut svg = Svg::new();
        let room = width_px - 2.0 * BORDER_PX;
        let mut y = BORDER_PX;
        for line in wrap(self.title, TITLE_PX, Weight::Bold, room) {
            y += TITLE_PX;
            svg.text([BORDER_PX, y], &line, &Text::new(TITLE_PX).bold());
            y += TITLE_GAP_PX;
        }
        for line in wrap(self.subtitle, BODY_PX, Weight::Regular, room) {
            y += BODY_PX;
            svg.text([BORDER_PX, y], &line, &Text::new(BODY_PX).colour(MUTED));
            y += SUBTITLE_GAP_PX;
        }
        Page {
            svg,
            top_px: y + UNDER_TITLE_PX,
            width_px,
            title: self.title,
        }
    }

    /// A picture that says why there is nothing to draw: the title block and a card with the reason, as a
    /// complete document.
    pub(crate) fn notice(self, reason: &str) -> String {
        let mut page = self.page(NOTICE_PX);
        let width = NOTICE_PX - 2.0 * BORDER_PX;
        let lines = wrap(reason, BODY_PX, Weight::Regular, width - 2.0 * NOTICE_INSET_PX);
        let card = Rect {
            x: BORDER_PX,
            y: page.top_px,
            w: width,
            h: NOTICE_ROOM_PX + NOTICE_LINE_PX * lines.len() as f64,
        };
        page.svg
            .rounded(card, 4.0, &Style::fill(EMPTY).outlined("#c4c4c4", 1.0));
        for (k, line) in lines.iter().enumerate() {
            let y = card.y + NOTICE_FIRST_LINE_PX + NOTICE_LINE_PX * k as f64;
            let text = Text::new(BODY_PX).middle().colour(INK);
            page.svg.text([card.centre()[0], y], line, &text);
        }
        page.finish(card.bottom())
    }
}

impl Page<'_> {
    /// The complete document, with a legend whose top left corner is at `at` and which runs to the right border.
    pub(crate) fn finish_with_legend(mut self, entries: &[Entry], at: Point) -> String {
        let width = self.width_px - at[0] - BORDER_PX;
        let bottom = draw_legend(&mut self.svg, entries, at, width);
        self.finish(bottom)
    }

    /// The complete document; what is drawn ends at `bottom_px`.
    pub(crate) fn finish(self, bottom_px: f64) -> String {
        self.svg.finish(self.width_px, bottom_px + BORDER_PX, self.title)
    }
}

/// The rectangle that a text of regular weight takes up, for keeping labels apart: from 0.8 of the font size
/// above its baseline at `at` to 0.2 below.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_box_is_placed_by_its_anchor_and_keeps_its_size() {
        let boxes = [Anchor::Start, Anchor::Middle, Anchor::End]
            .map(|anchor| text_box([100.0, 50.0], "deviation", 10.0, anchor));
        let w = text_width_px("deviation", 10.0, Weight::Regular);
        assert!(
            boxes
                .iter()
                .all(|b| (b.w - w).abs() < 1e-9 && (b.h - 10.0).abs() < 1e-9)
        );
        assert!((boxes[0].x - 100.0).abs() < 1e-9);
        assert!((boxes[1].centre()[0] - 100.0).abs() < 1e-9);
        assert!((boxes[2].right() - 100.0).abs() < 1e-9);
        // Letters are on the baseline, their tails below it.
        assert!(boxes.iter().all(|b| b.y < 50.0 && b.bottom() > 50.0));
    }

    #[test]
    fn a_longer_title_pushes_the_drawing_down_and_a_longer_reason_makes_the_notice_higher() {
        let top = |title: &str| Heading::new(title, "").page(200.0).top_px;
        assert!(top(&"word ".repeat(30)) > top("word"));
        let height = |reason: &str| {
            let svg = Heading::new("t", "").notice(reason);
            let text = svg.split("height=\"").nth(1).and_then(|s| s.split('"').next());
            text.and_then(|t| t.parse::<f64>().ok()).expect("our own SVG")
        };
        assert!(height(&"word ".repeat(60)) > height("word"));
    }
}

//! An arrow: a shaft with a filled head.
//!
//! ```text
//! from ────────────────▶ to       head 8 px long and 5.8 px wide, at most 0.6 of a short arrow
//! ```

use crate::svg::{Point, Style, Svg};

/// Length of a head, px, and the largest part of a short arrow that is head.
const HEAD_PX: f64 = 8.0;
const MOST_HEAD: f64 = 0.6;
/// Half the width of a head as a part of its length.
const HALF_WIDTH: f64 = 0.36;
/// Arrows shorter than this are not drawn.
const SHORTEST_PX: f64 = 0.3;

/// Draws an arrow between two points of the picture; the head of a short one shrinks with it. An arrow shorter
/// than 0.3 px, or one with an end that is not finite, is left out.
pub(crate) fn draw_arrow(svg: &mut Svg, [from, to]: [Point; 2], colour: &str) {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    if length < SHORTEST_PX || !length.is_finite() {
        return;
    }
    let (cos, sin) = ((to[0] - from[0]) / length, (to[1] - from[1]) / length);
    let head = HEAD_PX.min(length * MOST_HEAD);
    let half = head * HALF_WIDTH;
    let neck = [to[0] - head * cos, to[1] - head * sin];
    // The shaft ends inside the head, which hides its round end.
    svg.line(
        from,
        [to[0] - 0.8 * head * cos, to[1] - 0.8 * head * sin],
        &Style::line(colour, 1.5),
    );
    let wings = [
        [neck[0] - half * sin, neck[1] + half * cos],
        [neck[0] + half * sin, neck[1] - half * cos],
    ];
    svg.polygon(&[to, wings[0], wings[1]], &Style::fill(colour));
}

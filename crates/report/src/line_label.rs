//! Labels on lines: rotated along the line, where it is straight, clear of each other, of other lines and of masked
//! zones.
//!
//! | step | rule |
//! |---|---|
//! | trial places | every 6 px along the line |
//! | excluded | outside the drawing, on a masked zone, on another label, where the line bends too much |
//! | cost | `bow + 0.8 crossed + 2.5 off_middle + 1.5 steep`, see `Wish::cost` |
//! | chosen | the cheapest, if below 14; longer lines get another label, 190 px away |
//!
//! A bold label (the tolerance) is used once and on a white plate; other lines have up to four.

use crate::font::{Weight, text_width_px};
use crate::line::Stations;
use crate::page::text_box;
use crate::svg::{Anchor, Point, Rect, Style, Svg, Text};
use armill_core::units::{from_deg, to_deg};

/// Distance of trial places along a line.
const TRIAL_STEP_PX: f64 = 6.0;
/// Length of line per label.
const LINE_PER_LABEL_PX: f64 = 560.0;
/// Least distance of two labels of the same line.
const SAME_LINE_PX: f64 = 190.0;

/// Trial places of a line at most.
const MOST_TRIALS: f64 = 400.0;
/// Shortest line that is labelled, and shortest chord under a label, in half widths of the label.
const SHORTEST: f64 = 2.6;
const STRAIGHTEST: f64 = 1.7;
/// What a place costs: each point of another line under the label, half the line away from its middle, a vertical
/// label.
const PER_CROSSED: f64 = 0.8;
const OFF_MIDDLE: f64 = 2.5;
const STEEP: f64 = 1.5;
/// A label that costs more is left out.
const MOST_COST: f64 = 14.0;
/// A label turned further clockwise is turned over.
const STEEPEST_DEG: f64 = 78.0;

/// A line to be labelled.
pub(crate) struct Labelled {
    /// The line, px.
    pub(crate) points: Vec<Point>,
    /// What is written on it.
    pub(crate) text: String,
    /// How it is set; anchor and turn are decided here.
    pub(crate) look: Text,
}

/// Where labels may be.
pub(crate) struct LabelRoom<'a> {
    /// The drawing; labels stay 4 px inside it.
    pub(crate) area: Rect,
    /// Whether a point may be covered.
    pub(crate) free: &'a dyn Fn(Point) -> bool,
    /// Points of other things drawn there, better not covered.
    pub(crate) obstacles: &'a [Point],
}

/// Points all over a text whose baseline is centred at `at`, in three rows, as obstacles for labels.
pub(crate) fn points_under(at: Point, content: &str, size_px: f64) -> Vec<Point> {
    let area = text_box(at, content, size_px * 1.1, Anchor::Middle);
    let rows = [area.y, area.centre()[1], area.bottom()];
    let columns = (area.w / 1.5).ceil().clamp(1.0, 1000.0) as usize;
    let row = |y: f64| (0..=columns).map(move |k| [area.x + area.w * k as f64 / columns as f64, y]);
    rows.into_iter().flat_map(row).collect()
}

/// Writes as many labels as find room; lines earlier in the list choose first. A line too short or too crooked
/// has none.
pub(crate) fn write_labels(svg: &mut Svg, lines: &[Labelled], room: &LabelRoom<'_>) {
    let mut taken: Vec<(Point, f64)> = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let half = [
            text_width_px(&line.text, line.look.size_px, line.look.weight) / 2.0 + 3.0,
            line.look.size_px * 0.62,
        ];
        let others: Vec<Point> = lines
            .iter()
            .enumerate()
            .filter(|(k, _)| *k != index)
            .flat_map(|(_, l)| l.points.iter().copied())
            .chain(room.obstacles.iter().copied())
            .collect();
        let wish = Wish {
            line: Stations::along(&line.points),
            half,
            room,
            others: &others,
        };
        let most = if line.look.weight == Weight::Bold {
            1
        } else {
            (wish.line.length / LINE_PER_LABEL_PX).ceil() as usize
        };
        let mut own: Vec<(Point, f64)> = Vec::new();
        for _ in 0..most.min(4) {
            let blocked: Vec<(Point, f64)> = taken.iter().chain(&own).copied().collect();
            let Some((at, turn_deg)) = wish.best_place(&blocked) else {
                break;
            };
            own.push((at, SAME_LINE_PX));
            let (sin, cos) = from_deg(turn_deg).sin_cos();
            let count = (half[0] / half[1]).ceil().max(1.0) as usize;
            for k in 0..=2 * count {
                let d = half[0] * (k as f64 / count as f64 - 1.0);
                taken.push(([at[0] + d * cos, at[1] + d * sin], half[1] * 1.5));
            }
            // A thick line shows between the letters: a plate under the text hides it.
            if line.look.weight == Weight::Bold {
                let plate = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(u, v)| {
                    let (u, v) = (u * half[0], v * half[1]);
                    [at[0] + u * cos - v * sin, at[1] + u * sin + v * cos]
                });
                svg.polygon(&plate, &Style::fill("#fff").opacity(0.9));
            }
            // The text is on its baseline: a third of the size below the middle.
            let down = line.look.size_px * 0.36;
            svg.text(
                [at[0] - down * sin, at[1] + down * cos],
                &line.text,
                &line.look.clone().middle().turned(turn_deg),
            );
        }
    }
}

/// A label to be placed on its line.
struct Wish<'a> {
    line: Stations<'a>,
    /// Half the width and half the height of the label.
    half: [f64; 2],
    room: &'a LabelRoom<'a>,
    /// Points of other lines and things, better not covered.
    others: &'a [Point],
}

/// Where a label may be: its middle, and the direction along the line.
#[derive(Clone, Copy)]
struct LabelPosition {
    at: Point,
    /// Direction of the reading before it is turned over where steep.
    cos: f64,
    sin: f64,
}

impl LabelPosition {
    /// `u` half widths along the label and `v` half heights down from its middle.
    fn corner(&self, [u, v]: [f64; 2], half: [f64; 2]) -> Point {
        [
            self.at[0] + u * half[0] * self.cos - v * half[1] * self.sin,
            self.at[1] + u * half[0] * self.sin + v * half[1] * self.cos,
        ]
    }

    /// The turn of the text: steep lines read upwards, like the vertical axis.
    fn turn_deg(&self) -> f64 {
        let turn = to_deg(self.sin.atan2(self.cos));
        if turn > STEEPEST_DEG {
            turn - 180.0
        } else if turn <= STEEPEST_DEG - 180.0 {
            turn + 180.0
        } else {
            turn
        }
    }
}

impl Wish<'_> {
    /// The middle and the turn (deg) of the cheapest place that is free of `taken` discs; `None` where there is none,
    /// or none with an acceptable cost.
    fn best_place(&self, taken: &[(Point, f64)]) -> Option<(Point, f64)> {
        let [half, _] = self.half;
        if self.line.points.len() < 2 || self.line.length < SHORTEST * half {
            return None;
        }
        let trials = ((self.line.length - 2.0 * half) / TRIAL_STEP_PX)
            .floor()
            .clamp(0.0, MOST_TRIALS) as usize;
        let mut best: Option<(f64, LabelPosition)> = None;
        for k in 0..=trials {
            let s = half + k as f64 * TRIAL_STEP_PX;
            let Some(place) = self.place_at(s) else { continue };
            if !self.is_free(&place, taken) {
                continue;
            }
            let cost = self.cost(s, &place);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, place));
            }
        }
        best.filter(|(cost, _)| *cost < MOST_COST)
            .map(|(_, place)| (place.at, place.turn_deg()))
    }

    /// The place about the point `s` px along the line; `None` where the line is too crooked.
    fn place_at(&self, s: f64) -> Option<LabelPosition> {
        let [half, _] = self.half;
        let (a, b) = (self.line.at(s - half), self.line.at(s + half));
        let chord = (b[0] - a[0]).hypot(b[1] - a[1]);
        let middle = self.line.at(s);
        (chord >= STRAIGHTEST * half).then(|| LabelPosition {
            at: [0, 1].map(|k| (middle[k] + (a[k] + b[k]) / 2.0) / 2.0),
            cos: (b[0] - a[0]) / chord,
            sin: (b[1] - a[1]) / chord,
        })
    }

    /// Whether the label is inside the drawing, where labels are allowed, and clear of other labels.
    fn is_free(&self, place: &LabelPosition, taken: &[(Point, f64)]) -> bool {
        const OUTLINE: [[f64; 2]; 6] = [
            [-1.0, -1.0],
            [1.0, -1.0],
            [1.0, 1.0],
            [-1.0, 1.0],
            [0.0, -1.0],
            [0.0, 1.0],
        ];
        let inner = self.room.area.shrunk(4.0);
        let is_free = |uv: &[f64; 2]| {
            let p = place.corner(*uv, self.half);
            inner.contains(p) && (self.room.free)(p)
        };
        let hits = |u: f64| {
            let p = place.corner([u, 0.0], self.half);
            taken
                .iter()
                .any(|(c, r)| (p[0] - c[0]).hypot(p[1] - c[1]) < self.half[1] + r)
        };
        OUTLINE.iter().all(is_free) && ![-1.0, -0.5, 0.0, 0.5, 1.0].into_iter().any(hits)
    }

    /// Straight first, then clear of other lines, then near the middle of the line, then near the horizontal:
    /// `bow + 0.8 crossed + 2.5 |s / length - 1/2| + 1.5 |sin|`, `bow` the largest distance of the line from its chord,
    /// px.
    fn cost(&self, s: f64, place: &LabelPosition) -> f64 {
        let [half, high] = self.half;
        let a = self.line.at(s - half);
        let bow = (1..6)
            .map(|m| {
                let p = self.line.at(s - half + 2.0 * half * f64::from(m) / 6.0);
                ((p[0] - a[0]) * place.sin - (p[1] - a[1]) * place.cos).abs()
            })
            .fold(0.0, f64::max);
        let is_under = |p: &&Point| {
            let (dx, dy) = (p[0] - place.at[0], p[1] - place.at[1]);
            (dx * place.cos + dy * place.sin).abs() < half && (dy * place.cos - dx * place.sin).abs() < high
        };
        let crossed = self.others.iter().filter(is_under).count();
        let off_middle = (s / self.line.length - 0.5).abs();
        bow + PER_CROSSED * crossed as f64 + OFF_MIDDLE * off_middle + STEEP * place.sin.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(lines: &[Labelled], free: impl Fn(Point) -> bool) -> usize {
        let mut svg = Svg::new();
        let area = Rect {
            x: 0.0,
            y: 0.0,
            w: 400.0,
            h: 400.0,
        };
        write_labels(
            &mut svg,
            lines,
            &LabelRoom {
                area,
                free: &free,
                obstacles: &[],
            },
        );
        svg.finish(400.0, 400.0, "").matches("<text").count()
    }

    fn line(y: f64) -> Labelled {
        Labelled {
            points: vec![[10.0, y], [390.0, y]],
            text: "50".to_owned(),
            look: Text::new(10.0),
        }
    }

    #[test]
    fn a_long_line_gets_a_label_and_a_short_one_none() {
        assert_eq!(written(&[line(200.0)], |_| true), 1);
        let short = Labelled {
            points: vec![[100.0, 100.0], [110.0, 100.0]],
            ..line(0.0)
        };
        assert_eq!(written(&[short], |_| true), 0);
    }

    #[test]
    fn labels_are_only_where_it_is_free() {
        assert_eq!(written(&[line(200.0)], |_| false), 0);
        assert_eq!(written(&[line(2.0)], |_| true), 0, "outside the area");
    }

    #[test]
    fn labels_of_lines_on_top_of_each_other_keep_apart() {
        assert!(written(&[line(200.0), line(200.5)], |_| true) <= 2);
    }
}

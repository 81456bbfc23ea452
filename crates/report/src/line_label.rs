//! Labels on lines: rotated along the line, where it is straight, clear of each other, of other lines and of masked zones.

use crate::font::{Weight, text_width_px};
use crate::line::Stations;
use crate::page::text_box;
use crate::svg::{Anchor, Point, Rect, Style, Svg, Text};

/// Distance of trial places along a line.
const TRIAL_STEP_PX: f64 = 6.0;
/// Length of line that each label stands for.
const LINE_PER_LABEL_PX: f64 = 560.0;
/// Least distance of two labels of the same line.
const SAME_LINE_PX: f64 = 190.0;

/// A line that wants a label.
pub(crate) struct Labelled {
    pub(crate) points: Vec<Point>,
    pub(crate) text: String,
    pub(crate) look: Text,
}

/// Where labels may stand.
pub(crate) struct Room<'a> {
    pub(crate) area: Rect,
    /// Whether a point may be covered.
    pub(crate) free: &'a dyn Fn(Point) -> bool,
    /// Points of other things drawn there, better not covered.
    pub(crate) obstacles: &'a [Point],
}

/// Points all over a centred text, as obstacles for labels.
pub(crate) fn points_under(at: Point, content: &str, size_px: f64) -> Vec<Point> {
    let area = text_box(at, content, size_px * 1.1, Anchor::Middle);
    let rows = [area.y, area.centre()[1], area.bottom()];
    let columns = (area.w / 1.5).ceil().clamp(1.0, 1000.0) as usize;
    let row = |y: f64| (0..=columns).map(move |k| [area.x + area.w * k as f64 / columns as f64, y]);
    rows.into_iter().flat_map(row).collect()
}

/// Writes as many labels as find room; lines earlier in the list choose first.
pub(crate) fn write_labels(svg: &mut Svg, lines: &[Labelled], room: &Room<'_>) {
    let mut taken: Vec<(Point, f64)> = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let stations = Stations::along(&line.points);
        let half = [
            text_width_px(&line.text, line.look.size_px, line.look.weight) / 2.0 + 3.0,
            line.look.size_px * 0.62,
        ];
        let most = if line.look.weight == Weight::Bold {
            1
        } else {
            (stations.length / LINE_PER_LABEL_PX).ceil() as usize
        };
        let others: Vec<Point> = lines
            .iter()
            .enumerate()
            .filter(|(k, _)| *k != index)
            .flat_map(|(_, l)| l.points.iter().copied())
            .chain(room.obstacles.iter().copied())
            .collect();
        let mut own: Vec<(Point, f64)> = Vec::new();
        for _ in 0..most.min(4) {
            let blocked: Vec<(Point, f64)> = taken.iter().chain(&own).copied().collect();
            let Some((at, turn_deg)) = best_place(&stations, half, room, &blocked, &others) else {
                break;
            };
            own.push((at, SAME_LINE_PX));
            let (sin, cos) = turn_deg.to_radians().sin_cos();
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
            // The text stands on its baseline: a third of the size below the middle.
            let down = line.look.size_px * 0.36;
            svg.text(
                [at[0] - down * sin, at[1] + down * cos],
                &line.text,
                &line.look.clone().middle().turned(turn_deg),
            );
        }
    }
}

fn best_place(
    line: &Stations<'_>,
    half: [f64; 2],
    room: &Room<'_>,
    taken: &[(Point, f64)],
    others: &[Point],
) -> Option<(Point, f64)> {
    if line.points.len() < 2 || line.length < 2.6 * half[0] {
        return None;
    }
    let inner = room.area.shrunk(4.0);
    let trials = ((line.length - 2.0 * half[0]) / TRIAL_STEP_PX)
        .floor()
        .clamp(0.0, 400.0) as usize;
    let mut best: Option<(f64, Point, f64)> = None;
    for k in 0..=trials {
        let s = half[0] + k as f64 * TRIAL_STEP_PX;
        let (a, b) = (line.at(s - half[0]), line.at(s + half[0]));
        let chord = (b[0] - a[0]).hypot(b[1] - a[1]);
        if chord < 1.7 * half[0] {
            continue;
        }
        let (cos, sin) = ((b[0] - a[0]) / chord, (b[1] - a[1]) / chord);
        let bow = (1..6)
            .map(|m| {
                let p = line.at(s - half[0] + 2.0 * half[0] * f64::from(m) / 6.0);
                ((p[0] - a[0]) * sin - (p[1] - a[1]) * cos).abs()
            })
            .fold(0.0, f64::max);
        let middle = line.at(s);
        let at = [
            (middle[0] + (a[0] + b[0]) / 2.0) / 2.0,
            (middle[1] + (a[1] + b[1]) / 2.0) / 2.0,
        ];
        let corner = |u: f64, v: f64| {
            [
                at[0] + u * half[0] * cos - v * half[1] * sin,
                at[1] + u * half[0] * sin + v * half[1] * cos,
            ]
        };
        let outline = [
            (-1.0, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
            (0.0, -1.0),
            (0.0, 1.0),
        ];
        if !outline
            .iter()
            .all(|(u, v)| inner.contains(corner(*u, *v)) && (room.free)(corner(*u, *v)))
        {
            continue;
        }
        let hits = [-1.0, -0.5, 0.0, 0.5, 1.0].iter().any(|u| {
            let p = corner(*u, 0.0);
            taken
                .iter()
                .any(|(c, r)| (p[0] - c[0]).hypot(p[1] - c[1]) < half[1] + r)
        });
        if hits {
            continue;
        }
        let crossed = others
            .iter()
            .filter(|p| {
                let (dx, dy) = (p[0] - at[0], p[1] - at[1]);
                (dx * cos + dy * sin).abs() < half[0] && (dy * cos - dx * sin).abs() < half[1]
            })
            .count();
        // Straight first, then clear of other lines, then near the middle, then near the horizontal.
        let off_middle = (s / line.length - 0.5).abs();
        let cost = bow + 0.8 * crossed as f64 + 2.5 * off_middle + 1.5 * sin.abs();
        if best.is_none_or(|(c, _, _)| cost < c) {
            let mut turn = sin.atan2(cos).to_degrees();
            // Steep lines read upwards, like the vertical axis.
            if turn > 78.0 {
                turn -= 180.0;
            } else if turn <= -102.0 {
                turn += 180.0;
            }
            best = Some((cost, at, turn));
        }
    }
    best.filter(|(cost, _, _)| *cost < 14.0)
        .map(|(_, at, turn)| (at, turn))
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
            &Room {
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
    fn no_label_stands_where_it_is_not_free() {
        assert_eq!(written(&[line(200.0)], |_| false), 0);
        assert_eq!(written(&[line(2.0)], |_| true), 0, "outside the area");
    }

    #[test]
    fn labels_of_lines_on_top_of_each_other_keep_apart() {
        assert!(written(&[line(200.0), line(200.5)], |_| true) <= 2);
    }
}

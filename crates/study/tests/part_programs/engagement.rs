//! Engagement at points of a path: the height map of a stock, the dexels along z, and material that points find in front of the tool.
//!
//! | comparison | tolerance |
//! |---|---|
//! | volume of each step, height map and dexels along z in the same cells | rounding of the heights; of one step in a thousand a cell, which the tool grazes by less than the resolution of the dexels: the next step cuts it |
//! | width and depth of the strip ahead, height map and points | what the points find within the last two cells of the step, where the height map looks; at each edge 3/4 of a cell, and one more at the side of the cutter; of a ball the discs of the height map, and depths only where the material is as high as the stock. A strip narrower than a cell may be missed |
//!
//! A tool that is tilted by a constant angle is compared in the frame in which it is upright.

use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::{EngagementKind, Pass, PassEngagement, Stock};
use armill_core::removal::DexelDirections;
use rayon::prelude::*;

use crate::moving_tool::MovingTool;
use crate::points::Numbers;
use crate::program::{BLOCK, CARVING, PLATE, Program, Read, SUPPORT};
use crate::{MM, MM3};

/// Least height of material that points find in front of a flat tool, m.
const LEAST: f64 = 1e-5;
/// Points are so far out of the tool, m.
const OUT: f64 = 1e-6;
/// Heights are found to this, m.
const HEIGHT: f64 = 1e-6;
/// Places at which the strip ahead is compared.
const PLACES: usize = 60;

/// The engagement at each point, by the height map; what is left of it, m^3.
fn by_height_map(read: &Read) -> (Vec<PassEngagement>, f64) {
    let path = &read.track.path;
    let mut stock = Stock::new(read.program.corners(), read.program.cell_mm * MM).unwrap();
    let mut body = 0;
    let all = (0..path.points.len()).map(|index| {
        while read
            .bodies
            .get(body + 1)
            .is_some_and(|(first, _)| *first <= index)
        {
            body += 1;
        }
        let point = &path.points[index];
        let from = if path.begins(index) { index } else { index - 1 };
        let pass = Pass {
            from: path.points[from].at,
            to: point.at,
            direction: point.direction,
            axis: Vector3::z_axis(),
        };
        stock.cut(&pass, &read.bodies[body].1).unwrap()
    });
    let all = all.collect();
    (all, stock.volume())
}

/// The volume of each step by dexels along z, with that of the rapids before it; what is left, m^3.
fn by_dexels(read: &Read) -> (Vec<f64>, f64) {
    let cut = read.cut(DexelDirections::Z);
    let mut volumes = vec![0.0; read.track.path.points.len()];
    for (of, removal) in cut
        .stages
        .iter()
        .flat_map(|stage| &stage.moves)
        .zip(&cut.removals)
    {
        volumes[of.index as usize] += removal.volume;
    }
    (volumes, cut.part.volume())
}

/// Rounding of the heights of a step in a stock, m^3: two heights of both, each to 6e-8 of the height of the stock, in all cells that the tool can reach.
fn rounding(read: &Read, index: usize, radius: f64) -> f64 {
    let path = &read.track.path;
    let step = match path.begins(index) {
        true => 0.0,
        false => (path.points[index].at - path.points[index - 1].at).norm(),
    };
    let [low, high] = read.program.corners();
    let across = 2.0 * (radius + read.program.cell_mm * MM);
    4.0 * 6e-8 * (high.z - low.z) * across * (across + step)
}

/// Volumes of all steps, and the strip ahead at some places.
fn compare(program: Program) {
    let Some(read) = program.read(2.0 * MM) else {
        return;
    };
    let (heights, left) = by_height_map(&read);
    let (volumes, left_of_dexels) = by_dexels(&read);
    let radius = read
        .bodies
        .iter()
        .map(|(_, body)| body.radius())
        .fold(0.0, f64::max);
    let (mut greatest, mut grazed) = (0.0_f64, 0);
    for (index, (one, other)) in heights.iter().zip(&volumes).enumerate() {
        let off = (one.volume - other).abs();
        if off < rounding(&read, index, radius) {
            greatest = greatest.max(off);
            continue;
        }
        let cell = (program.cell_mm * MM).powi(2) * (program.corners()[1].z - program.corners()[0].z);
        assert!(off < cell, "{index}: {one:?} {other}");
        grazed += 1;
    }
    assert!(1000 * grazed < heights.len(), "{grazed}");
    let removed: f64 = volumes.iter().sum();
    // Each of both volumes is a sum of rounded heights.
    assert!(
        (left - left_of_dexels).abs() < 1e-7 * (left + removed),
        "{left} {left_of_dexels}"
    );
    let places = places(&read, &heights);
    let of_places: Vec<Vec<Strip>> = places.par_iter().map(|place| strips(&read, place)).collect();
    let (mut off, mut depths) = ([[0.0_f64; 2]; 2], 0);
    for (place, strips) in places.iter().zip(&of_places) {
        let found = &heights[place.index];
        let beyond = |value: f64, of: fn(&Strip) -> f64| {
            let range = strips.iter().map(of);
            let [low, high] = range.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(value), high.max(value)]
            });
            (low - value).max(value - high).max(0.0)
        };
        let width = [
            beyond(found.width, |strip| strip.width),
            2.0 * 1.75 * program.cell_mm * MM,
        ];
        let of_discs = strips
            .iter()
            .map(|strip| of_discs(&read.moves[place.number], strip.inner));
        let depth = [
            beyond(found.depth, |strip| strip.depth),
            2.0 * HEIGHT + of_discs.fold(0.0, f64::max),
        ];
        // A strip narrower than a cell may be missed.
        let cell = program.cell_mm * MM;
        let is_seen = strips
            .iter()
            .all(|strip| strip.width == 0.0 || strip.width > cell);
        // A ball is next to the slopes of other passes: there the height depends on the place within a cell.
        let is_level = strips.iter().all(|strip| strip.is_at_top) || !read.moves[place.number].has_ball();
        let compared = [width, depth]
            .into_iter()
            .take(if is_seen && is_level { 2 } else { 1 });
        depths += usize::from(is_seen && is_level);
        for (kind, [by, tolerance]) in compared.enumerate() {
            off[kind] = [off[kind][0].max(by), off[kind][1].max(tolerance)];
            assert!(
                by < tolerance,
                "{kind} {}: {found:?} {strips:?} {by} {tolerance}",
                place.index
            );
        }
    }
    let [[width, of_width], [depth, of_depth]] = off.map(|off| off.map(|off| off / MM));
    println!(
        "{}: {} steps, volumes within {:.1e} mm^3 but of {grazed}; widths of {} places within {width:.2} mm (tolerance {of_width:.2}), depths of {depths} within {depth:.4} mm (tolerance at most {of_depth:.4})",
        program.file,
        heights.len(),
        greatest / MM3,
        places.len()
    );
    assert!(3 * depths > places.len(), "{depths}");
}

/// Difference of the depths of a strip by discs of the height map, six of them, and by circles of points, m.
fn of_discs(moving: &MovingTool, inner: f64) -> f64 {
    let body = moving.body();
    let height = |rho: f64| {
        let out = (rho - (body.radius - body.corner)).clamp(0.0, body.corner);
        body.corner - ((body.corner - out) * (body.corner + out)).sqrt()
    };
    let part = body.corner / 6.0;
    height(inner + 0.5 * part) - height(inner - body.corner / CIRCLES as f64 - 0.5 * part)
}

#[test]
fn a_ball_nose_in_a_carving_has_the_engagement_that_points_find() {
    compare(CARVING);
}

#[test]
fn flat_end_mills_in_a_plate_have_the_engagement_that_points_find() {
    compare(PLATE);
}

#[test]
fn flat_end_mills_in_a_block_have_the_engagement_that_points_find() {
    // The moves before the block is turned.
    compare(Program {
        moves: [0, 4000],
        cell_mm: 0.23,
        ..BLOCK
    });
}

#[test]
fn a_tilted_tool_has_the_engagement_that_points_find_where_the_stock_is_tilted_with_it() {
    compare(Program {
        turned_deg: 10.0,
        stock_mm: [[0.0, 0.0, -20.0], [45.0, 40.0, -1.0]],
        ..SUPPORT
    });
}

/// The end of a move.
struct Place {
    /// Its point of the path.
    index: usize,
    /// Its move.
    number: usize,
}

/// Random ends of moves whose last step is longer than the two cells in which the height map looks ahead.
fn places(read: &Read, heights: &[PassEngagement]) -> Vec<Place> {
    let path = &read.track.path;
    let cuts = (0..read.moves.len())
        .filter(|&number| !read.moves[number].is_rapid && read.moves[number].has_length());
    let ends: Vec<Place> = path
        .ends
        .iter()
        .zip(cuts)
        .map(|(end, number)| Place {
            index: end.point,
            number,
        })
        .filter(|Place { index, .. }| {
            let step = path.points[*index].at - path.points[index - 1].at;
            let level = step.xy().norm();
            level > 2.0 * read.program.cell_mm * MM && heights[*index].kind != EngagementKind::Plunge
        })
        .collect();
    let mut numbers = Numbers(5);
    let one = |_| {
        let place = &ends[numbers.below(ends.len())];
        Place { ..*place }
    };
    (0..PLACES).map(one).collect()
}

/// Material in front of the tool.
#[derive(Clone, Copy, Debug, Default)]
struct Strip {
    width: f64,
    depth: f64,
    /// Radius of the tool at the lowest engaged circle of the deepest line.
    inner: f64,
    /// Whether the highest material there is the top of the stock.
    is_at_top: bool,
}

/// Positions along the last two cells.
const POSITIONS: usize = 5;
/// Lines across the feed.
const LINES: usize = 80;
/// Circles of the bottom of a tool.
const CIRCLES: usize = 12;

/// The strip that points find in front of the tool where it is at positions along the last two cells before the end of a move.
fn strips(read: &Read, place: &Place) -> Vec<Strip> {
    let moving = &read.moves[place.number];
    let (end, _) = moving.pose(1.0);
    let cell = read.program.cell_mm * MM;
    let out = moving.body().radius + 3.0 * cell;
    let near: Vec<&MovingTool> = read.moves[..place.number]
        .iter()
        .filter(|of| {
            of.boxes(f64::INFINITY)
                .any(|(_, [low, high])| (0..2).all(|k| low[k] < end[k] + out && high[k] > end[k] - out))
        })
        .collect();
    let back = |position: usize| 1.0 - 2.0 * cell / moving.way() * position as f64 / (POSITIONS - 1) as f64;
    (0..POSITIONS)
        .map(|position| {
            let ahead = Ahead {
                corners: read.program.corners(),
                near: &near,
                moving,
                part: back(position),
            };
            ahead.strip()
        })
        .collect()
}

/// A tool and the moves before it.
struct Ahead<'a> {
    corners: [Point3<f64>; 2],
    near: &'a [&'a MovingTool],
    moving: &'a MovingTool,
    part: f64,
}

impl Ahead<'_> {
    fn is_material(&self, point: &Point3<f64>) -> bool {
        let [low, high] = self.corners;
        (0..3).all(|k| low[k] < point[k] && point[k] < high[k])
            && !self.near.iter().any(|of| of.reaches(point, [0.0, 1.0]))
            && !self.moving.reaches(point, [0.0, self.part])
    }

    /// The highest material above a point, if it is in material.
    fn top(&self, point: &Point3<f64>) -> Option<f64> {
        if !self.is_material(point) {
            return None;
        }
        let [mut low, mut high] = [point.z, self.corners[1].z];
        let at = |z: f64| Point3::new(point.x, point.y, z - HEIGHT);
        if self.is_material(&at(high)) {
            return Some(high);
        }
        while high - low > HEIGHT {
            let middle = 0.5 * (low + high);
            match self.is_material(&at(middle)) {
                true => low = middle,
                false => high = middle,
            }
        }
        Some(low)
    }

    /// The run of lines with the longest arc.
    fn strip(&self) -> Strip {
        let (tip, _) = self.moving.pose(self.part);
        let feed = (self.moving.pose(1.0).0 - tip).xy();
        let feed = match feed.norm() > 0.0 {
            true => feed.normalize(),
            false => (tip - self.moving.pose(1.0 - 1e-4).0).xy().normalize(),
        };
        let body = self.moving.body();
        let flat = body.radius - body.corner;
        let mut lines = Vec::new();
        for line in 0..LINES {
            let y = body.radius * ((line as f64 + 0.5) / LINES as f64 * 2.0 - 1.0);
            // Top, lowest bottom of the tool, largest and smallest radius.
            let mut found: Option<[f64; 4]> = None;
            let circles = if body.corner > 0.0 { CIRCLES } else { 1 };
            for circle in 1..=circles {
                let rho = flat + body.corner * circle as f64 / circles as f64;
                let rho = if body.corner > 0.0 { rho } else { body.radius };
                if rho <= y.abs() {
                    continue;
                }
                let x = (rho * rho - y * y).sqrt();
                let out = rho - flat;
                let begins = if body.corner > 0.0 {
                    body.corner - ((body.corner - out) * (body.corner + out)).max(0.0).sqrt()
                } else {
                    0.0
                };
                let off = (feed * x + Vector3::new(-feed.y, feed.x, 0.0).xy() * y) * (1.0 + OUT / rho);
                let lift = if body.corner > 0.0 { 0.0 } else { LEAST };
                // Below the stock there is air up to its bottom.
                let z = (tip.z + begins + lift).max(self.corners[0].z + LEAST);
                let point = Point3::new(tip.x + off.x, tip.y + off.y, z);
                if let Some(top) = self.top(&point) {
                    let begins = tip.z + begins;
                    let lowest = found.map_or(begins, |[_, begins, ..]| begins);
                    let highest = found.map_or(top, |[highest, ..]| highest.max(top));
                    let inner = found.map_or(rho, |[.., inner]| inner);
                    found = Some([highest, lowest, rho, inner]);
                }
            }
            lines.push(found);
        }
        let mut longest = (0.0, Strip::default());
        let mut first = 0;
        for run in lines.chunk_by(|one, next| one.is_some() == next.is_some()) {
            let (begin, end) = (first, first + run.len());
            first = end;
            let rho = run.iter().flatten().fold(0.0, |rho: f64, line| rho.max(line[2]));
            if rho == 0.0 {
                continue;
            }
            let edge =
                |line: usize| (body.radius * (2.0 * line as f64 / LINES as f64 - 1.0)).clamp(-rho, rho);
            let (right, left) = (edge(begin), edge(end));
            let arc = rho * ((right / rho).acos() - (left / rho).acos());
            if arc > longest.0 {
                let depths = run
                    .iter()
                    .flatten()
                    .map(|[top, begins, _, inner]| (top - begins.max(self.corners[0].z), *inner, *top));
                let (depth, inner, top) =
                    depths.fold(
                        (0.0, rho, 0.0),
                        |most, line| {
                            if line.0 > most.0 { line } else { most }
                        },
                    );
                let strip = Strip {
                    width: left - right,
                    depth,
                    inner,
                    is_at_top: top > self.corners[1].z - HEIGHT,
                };
                longest = (arc, strip);
            }
        }
        longest.1
    }
}

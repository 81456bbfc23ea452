//! Volumes of parts and of their moves, and single points.
//!
//! | comparison | tolerance |
//! |---|---|
//! | a point of a dexel | the resolution of its ends; with arcs the chord, with turning axes their tolerance |
//! | volume of the dexels along z, points on them | 4 standard errors: no error of cells |
//! | volume of the part, points in voxels | 3 standard errors, and the error of the cells |
//! | volume of some moves | 4 standard errors of the points that they reach first |
//!
//! In a cell that a wall crosses, the length of the dexel differs from the mean by half the difference to its neighbour at most: the error of the cells.

use std::fmt::{Display, Formatter};

use armill_core::nalgebra::Point3;
use armill_core::removal::{DexelDirections, DexelGrid, DexelPart};

use crate::points::{Numbers, first_removals, in_voxels, least_distance, on_dexels};
use crate::program::{BLOCK, CARVING, CHORD, CutPart, IMPELLER, PLATE, Program, Read, SUPPORT};
use crate::{MM, MM3};

/// Voxels, with two points in each.
const VOXELS: f64 = 4e5;
/// Points on the dexels of a direction.
const POINTS: usize = 150_000;
/// Groups of moves.
const GROUPS: usize = 24;

/// What a program removes, mm^3.
struct Volumes {
    /// By the dexels along x, y and z.
    dexels: [f64; 3],
    cell_error: f64,
    points: f64,
    standard_error: f64,
}

impl Display for Volumes {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let [x, y, z] = self.dexels;
        write!(
            f,
            "{x:.0}, {y:.0} and {z:.0} mm^3 by dexels along x, y and z (cells: {:.0}), {:.0} +- {:.0} mm^3 by points",
            self.cell_error, self.points, self.standard_error
        )
    }
}

fn is_material(part: &DexelPart, k: usize, point: &Point3<f64>) -> bool {
    let grid = &part.grids()[k];
    let cell = grid.cell_at(point).unwrap();
    grid.material(cell)
        .any(|span| span.ends[0] < point[k] && point[k] < span.ends[1])
}

/// Half the differences of neighbouring lengths, times the area of a cell.
fn cell_error(grid: &DexelGrid) -> f64 {
    let [columns, rows] = grid.cells();
    let length = |cell| -> f64 {
        let spans = grid.material(cell);
        spans.map(|span| span.ends[1] - span.ends[0]).sum()
    };
    let lengths: Vec<f64> = (0..columns * rows)
        .map(|cell| length([cell % columns, cell / columns]))
        .collect();
    let differences = (0..columns * rows).map(|cell| {
        let to = |has: bool, next: usize| {
            if has {
                (lengths[cell] - lengths[next]).abs()
            } else {
                0.0
            }
        };
        to((cell + 1) % columns > 0, cell + 1) + to(cell + columns < lengths.len(), cell + columns)
    });
    0.5 * differences.sum::<f64>() * grid.cell_area()
}

/// Points in voxels: the volume that is removed and its standard error, from both points of each voxel.
fn in_space(read: &Read, stock: f64) -> [f64; 2] {
    let points = in_voxels(read.program.corners(), VOXELS, &mut Numbers(1));
    let found = first_removals(&read.moves, &points);
    let (mut removed, mut different) = (0.0, 0.0);
    for pair in found.chunks(2) {
        removed += pair.iter().flatten().count() as f64;
        different += f64::from(u8::from(pair[0].is_some() != pair[1].is_some()));
    }
    let point = stock / points.len() as f64;
    [removed * point, different.sqrt() * point]
}

/// Every point of a dexel is in material exactly if no move reaches it, or it is this near to the surface, m.
fn points_agree(read: &Read, cut: &CutPart, k: usize, resolution: f64) -> Vec<Option<u32>> {
    let points = on_dexels(&cut.part, k, POINTS, &mut Numbers(7 + k as u64));
    let found = first_removals(&read.moves, &points);
    for (point, removed) in points.iter().zip(&found) {
        if is_material(&cut.part, k, point) == removed.is_some() {
            let off = least_distance(&read.moves, point, 2.0 * resolution);
            let file = read.program.file;
            assert!(
                off.abs() < resolution,
                "{file}: {point:?} along {k} is {off} m off the tool"
            );
        }
    }
    found
}

/// Lines of the program at which groups of cuts with about the same number of moves end.
fn group_ends(read: &Read) -> Vec<u32> {
    let lines: Vec<u32> = read.moves.iter().map(|of| of.line).collect();
    (1..=GROUPS)
        .map(|group| lines[group * lines.len() / GROUPS - 1])
        .collect()
}

/// The volumes of groups of moves, mm^3: by dexels, by points on them, and the standard error.
fn groups(read: &Read, cut: &CutPart, found: &[Option<u32>]) -> Vec<[f64; 3]> {
    let ends = group_ends(read);
    let group = |line: u32| ends.partition_point(|end| *end < line);
    let mut dexels = vec![0.0; GROUPS];
    let of_stages = cut.stages.iter().flat_map(|stage| &stage.moves);
    for (of, removal) in of_stages.zip(&cut.removals) {
        dexels[group(read.track.path.points[of.index as usize].line)] += removal.volume / MM3;
    }
    let mut counts = vec![0.0; GROUPS];
    for number in found.iter().flatten() {
        counts[group(read.moves[*number as usize].line)] += 1.0;
    }
    let (stock, all) = (cut.stock_volume / MM3, found.len() as f64);
    let of_group = |(dexels, count): (f64, f64)| {
        // A group of which no point is found may have the volume of some.
        let share: f64 = count / all;
        let variance = (share * (1.0 - share)).max(1.0 / all) / all;
        [dexels, stock * share, stock * variance.sqrt()]
    };
    dexels.into_iter().zip(counts).map(of_group).collect()
}

/// Compares all.
fn compare(program: Program, resolution: f64) {
    let Some(read) = program.read(2.0 * MM) else {
        return;
    };
    let cut = read.cut(DexelDirections::All);
    let stock = cut.stock_volume / MM3;
    let dexels: Vec<f64> = cut
        .part
        .grids()
        .iter()
        .map(|grid| stock - grid.volume() / MM3)
        .collect();
    let [points, standard_error] = in_space(&read, stock);
    let volumes = Volumes {
        dexels: [dexels[0], dexels[1], dexels[2]],
        cell_error: cell_error(&cut.part.grids()[2]) / MM3,
        points,
        standard_error,
    };
    println!("{}: {volumes} of a stock of {stock:.0} mm^3", program.file);
    let off = (volumes.dexels[2] - points).abs();
    assert!(
        off < 3.0 * volumes.standard_error + volumes.cell_error,
        "{volumes}"
    );
    let sum: f64 = cut.removals.iter().map(|removal| removal.volume / MM3).sum();
    // Lengths are rounded by 6e-8 of the longest dexel, at every cut.
    assert!((sum - dexels[2]).abs() < 1e-6 * stock, "{sum} {volumes}");

    let found = [0, 1, 2].map(|k| points_agree(&read, &cut, k, resolution));
    let groups = groups(&read, &cut, &found[2]);
    for (number, [dexels, points, standard_error]) in groups.iter().enumerate() {
        let off = (dexels - points).abs();
        assert!(off < 4.0 * standard_error, "{number}: {:?}", groups[number]);
    }
    let removed: f64 = groups.iter().map(|[_, points, _]| points).sum();
    let share = removed / stock;
    let standard_error = stock * (share * (1.0 - share) / POINTS as f64).sqrt();
    assert!(
        (removed - dexels[2]).abs() < 4.0 * standard_error,
        "{removed} {volumes}"
    );
}

/// Resolution of ends in a box of this length, m: a unit in the last place of single precision.
fn of_ends(length: f64) -> f64 {
    1.2e-7 * length
}

#[test]
fn a_carving_with_a_ball_nose_is_that_of_its_points() {
    compare(CARVING, of_ends(0.1));
}

#[test]
fn a_plate_with_holes_slots_and_outlines_by_five_tools_is_that_of_its_points() {
    compare(PLATE, CHORD + of_ends(0.35));
}

#[test]
fn a_block_that_is_cut_from_two_sides_is_that_of_its_points() {
    compare(BLOCK, CHORD + of_ends(0.15));
}

#[test]
fn a_support_that_is_cut_with_a_tilted_tool_is_that_of_its_points() {
    compare(SUPPORT, of_ends(0.045));
}

#[test]
fn an_impeller_in_five_axes_is_that_of_its_points_within_the_tolerance_of_turning_axes() {
    compare(IMPELLER, 0.02 * IMPELLER.cell_mm * MM + of_ends(0.08));
}

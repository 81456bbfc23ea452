//! Volumes of parts and of their moves.

use armill_core::removal::DexelDirections;

use crate::MM;
use crate::points::{Numbers, first_removals, in_voxels};
use crate::program::{BLOCK, CARVING, IMPELLER, PLATE, Program, SUPPORT};

#[test]
fn explore() {
    for program in [CARVING, PLATE, BLOCK, SUPPORT, IMPELLER] {
        let Some(read) = program.read(2.0 * MM) else { return };
        let began = std::time::Instant::now();
        let cut = read.cut(DexelDirections::All);
        let dexel_time = began.elapsed();
        let rapid: f64 = cut
            .stages
            .iter()
            .flat_map(|stage| &stage.moves)
            .zip(&cut.removals)
            .filter(|(of, _)| of.is_rapid)
            .map(|(_, removal)| removal.volume)
            .sum();
        let sum: f64 = cut.removals.iter().map(|removal| removal.volume).sum();
        let volumes: Vec<f64> = cut.part.grids().iter().map(|grid| (cut.stock_volume - grid.volume()) * 1e9).collect();
        let began = std::time::Instant::now();
        let mut numbers = Numbers(1);
        let points = in_voxels(program.corners(), 5e4, &mut numbers);
        let found = first_removals(&read.moves, &points);
        let time = began.elapsed();
        let (mut removed, mut variance) = (0.0, 0.0);
        for pair in found.chunks(2) {
            let [a, b] = [0, 1].map(|k| f64::from(u8::from(pair[k].is_some())));
            removed += 0.5 * (a + b);
            variance += 0.25 * (a - b) * (a - b);
        }
        let voxel = cut.stock_volume * 1e9 / (found.len() / 2) as f64;
        let by_rapids = found.iter().flatten().filter(|&&number| read.moves[number as usize].is_rapid).count() as f64 * 0.5 * voxel;
        println!(
            "{}: points {} moves {} dexels {dexel_time:?} points {time:?}: dexels {volumes:?} sum {} rapid {} | points {} +- {} rapid {by_rapids} of {}",
            program.file,
            read.track.path.points.len(),
            read.moves.len(),
            sum * 1e9,
            rapid * 1e9,
            removed * voxel,
            variance.sqrt() * voxel,
            cut.stock_volume * 1e9
        );
    }
    let _ = Program::part_of;
}

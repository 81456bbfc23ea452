//! Threads, cancellation, progress, and what is refused.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::removal::{
    DexelDirections, DexelPart, MoveRemoval, RemovalError, RotatingTool, StockSolid, SurfacePoint, ToolMove,
};
use armill_core::watch::{Cancelled, Watch};
use rayon::ThreadPoolBuilder;

use super::{MM, at, block, cut, end_mill, moves};

/// A zigzag with a tool whose axis turns.
fn zigzag() -> Vec<ToolMove> {
    let mut points: Vec<Point3<f64>> = Vec::new();
    for row in 0..20 {
        for step in 0..40 {
            let x = if row % 2 == 0 { step } else { 39 - step };
            points.push(at(
                f64::from(x),
                2.0 * f64::from(row),
                14.0 + (0.3 * f64::from(x)).sin(),
            ));
        }
    }
    let mut path = moves(&points, Vector3::z_axis());
    for (n, motion) in path.iter_mut().enumerate() {
        let axis = |n: usize| Unit::new_normalize(Vector3::new(0.2 * (0.05 * n as f64).sin(), 0.1, 1.0));
        motion.axes = [axis(n), axis(n + 1)];
    }
    path
}

#[test]
fn any_number_of_threads_gives_the_same_part() {
    let path = zigzag();
    let run = |threads: usize| -> (Vec<SurfacePoint>, Vec<MoveRemoval>) {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let part = block([40.0, 40.0, 20.0], 0.5, DexelDirections::All);
            let (part, removals) = cut(part, &path, &end_mill(6.0, 1.0, 20.0));
            (part.surface().collect(), removals)
        })
    };
    let (points, removals) = run(1);
    assert!(points.len() > 20_000);
    for threads in [2, 4] {
        let (others, other_removals) = run(threads);
        assert_eq!(points, others);
        assert_eq!(removals, other_removals);
    }
}

#[test]
fn progress_counts_all_moves_and_a_cancelled_cut_has_no_result() {
    let path = zigzag();
    let tool = end_mill(6.0, 1.0, 20.0);
    let tool = RotatingTool {
        cutting: &tool,
        clear: &[],
    };
    let (count, cancel) = (AtomicUsize::new(0), AtomicBool::new(false));
    let finished = |moves: usize| {
        count.fetch_add(moves, Ordering::Relaxed);
    };
    let watch = Watch {
        finished: &finished,
        cancel: &cancel,
    };
    let part = block([40.0, 40.0, 20.0], 0.5, DexelDirections::All);
    part.clone().cut(&path, &tool, 1e-5, watch).unwrap();
    assert_eq!(count.load(Ordering::Relaxed), path.len());
    // Cancelled by the first report.
    let stop = |_| cancel.store(true, Ordering::Relaxed);
    let watch = Watch {
        finished: &stop,
        cancel: &cancel,
    };
    let refused = part.cut(&path, &tool, 1e-5, watch).unwrap_err();
    assert_eq!(refused, RemovalError::Cancelled(Cancelled));
}

#[test]
fn no_moves_and_moves_in_air_change_nothing() {
    let part = block([10.0, 10.0, 10.0], 0.5, DexelDirections::All);
    let before: Vec<SurfacePoint> = part.surface().collect();
    let (part, removals) = cut(part, &[], &end_mill(6.0, 0.0, 20.0));
    assert!(removals.is_empty());
    let above = moves(&[at(-10.0, 5.0, 10.1), at(20.0, 5.0, 10.1)], Vector3::z_axis());
    let (part, removals) = cut(part, &above, &end_mill(6.0, 0.0, 20.0));
    assert_eq!(removals, [MoveRemoval::default()]);
    assert_eq!(part.surface().collect::<Vec<_>>(), before);
    // Heights of 10 mm in single precision.
    assert!((part.volume() / 1e-6 - 1.0).abs() < 1e-7);
}

#[test]
fn the_size_of_a_part_is_known_before_and_a_huge_one_is_refused_with_it() {
    let corners = [Point3::origin(), at(200.0, 200.0, 50.0)];
    let size = DexelPart::size(corners, 0.2 * MM, DexelDirections::All).unwrap();
    assert_eq!(
        (size.cells, size.dexels, size.bytes),
        ([1000.0, 1000.0, 250.0], 1.5e6, 24e6)
    );
    let part = DexelPart::new(&StockSolid::Box(corners), 0.2 * MM, DexelDirections::All).unwrap();
    assert_eq!(part.bytes() as f64, size.bytes);
    let z_only = DexelPart::size(corners, 0.2 * MM, DexelDirections::Z).unwrap();
    assert_eq!(z_only.bytes, 16e6);
    let refused = DexelPart::new(&StockSolid::Box(corners), 0.005 * MM, DexelDirections::All).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the part has 2.400e9 dexels, 38.4 GB: the maximum is 2.0e8; use a larger cell"
    );
}

#[test]
fn invalid_numbers_are_refused() {
    let corners = [Point3::origin(), at(20.0, 20.0, 5.0)];
    let refused = |corners: [Point3<f64>; 2], cell: f64| {
        let stock = StockSolid::Box(corners);
        DexelPart::new(&stock, cell, DexelDirections::All)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(refused(corners, f64::NAN), "the cell is not a finite number");
    assert_eq!(
        refused(corners, 0.0),
        "the cell is 0 mm: must be between 0.001 mm and 1000000 mm"
    );
    assert!(refused([corners[1], corners[0]], 1e-3).starts_with("the length of the stock along x is -20 mm"));
    assert!(refused([corners[0], at(f64::INFINITY, 1.0, 1.0)], 1e-3).contains("not a finite number"));
    let tool = end_mill(6.0, 0.0, 20.0);
    let tool = RotatingTool {
        cutting: &tool,
        clear: &[],
    };
    let good = moves(
        &[at(0.0, 0.0, 1.0), at(1.0, 0.0, 1.0), at(2.0, 0.0, 1.0)],
        Vector3::z_axis(),
    );
    let of = |change: &dyn Fn(&mut ToolMove), tolerance: f64| {
        let mut path = good.clone();
        change(&mut path[1]);
        let part = block([20.0, 20.0, 5.0], 1.0, DexelDirections::All);
        part.cut(&path, &tool, tolerance, Watch::NONE)
            .unwrap_err()
            .to_string()
    };
    let far = of(&|motion| motion.ends[1].x = f64::NAN, 1e-5);
    assert_eq!(
        far,
        "move 1 of the list: a coordinate of the tip is not a finite number within 1 km of zero"
    );
    let opposite = of(&|motion| motion.axes[1] = -motion.axes[0], 1e-5);
    assert!(opposite.contains("turns by more than 179 deg"), "{opposite}");
    let turned = Unit::new_normalize(Vector3::new(1.0, 0.0, 0.1));
    let fine = of(&|motion| motion.axes[1] = turned, 1e-9);
    assert!(fine.contains("more than 100000 pieces"), "{fine}");
    let index = of(&|motion| motion.index = 1 << 31, 1e-5);
    assert!(index.contains("2147483648"));
    let axis = of(
        &|motion| motion.axes[0] = Unit::new_unchecked(Vector3::zeros()),
        1e-5,
    );
    assert!(axis.contains("not a unit vector"));
    assert!(of(&|_| (), 0.0).contains("the tolerance of a turning axis is 0 mm"));
}

use super::*;
use crate::load::{Cutter, Immersion};
use crate::stability::ZerothOrder;
use crate::stability::examples::{benchmark, benchmark_mode, cutting, rpm};

#[test]
fn without_harmonics_it_is_the_zeroth_order_solution() {
    let cut = benchmark(Immersion::Down(0.01));
    let milling = cut.at_depth(1e-3).unwrap();
    let mean = ZerothOrder::new(
        &[benchmark_mode()],
        &cut.per_depth(1e-3).unwrap(),
        cut.pitch(),
        0.05,
    );
    for speed in [31_000.0, 42_000.0, 70_000.0] {
        let zeroth = mean.at_speed(rpm(speed)).unwrap();
        // Above twice the frequency of chatter the range up to half the tooth passing frequency contains it.
        let half = PI * rpm(speed) / cut.pitch();
        let found = boundary(&[benchmark_mode()], &milling, rpm(speed), 0, 0.05);
        if zeroth.angular_frequency < half {
            let (depth, w) = found.unwrap();
            assert!(
                (depth / zeroth.depth - 1.0).abs() < 0.01,
                "{speed}: {depth} {zeroth:?}"
            );
            assert!((w / zeroth.angular_frequency - 1.0).abs() < 0.01);
        }
    }
}

#[test]
fn more_harmonics_converge() {
    let cut = cutting(
        Cutter::flat(0.02, 3).unwrap(),
        Immersion::Down(0.004),
        [600e6, 200e6, 0.0],
    );
    let milling = cut.at_depth(1e-3).unwrap();
    let depth = |order: usize| {
        boundary(&[benchmark_mode()], &milling, rpm(9000.0), order, 0.05)
            .unwrap()
            .0
    };
    let depths = [2, 4, 6].map(depth);
    assert!((depths[2] / depths[1] - 1.0).abs() < 0.02, "{depths:?}");
}

#[test]
fn a_rigid_tool_has_no_boundary() {
    let milling = benchmark(Immersion::Slot).at_depth(1e-3).unwrap();
    assert_eq!(boundary(&[], &milling, rpm(9000.0), 2, 0.05), None);
}

use nalgebra::Matrix3;

use super::*;
use crate::stability::examples::arm_and_cutter;

#[test]
fn between_nodes_every_complex_depth_is_on_its_chord_within_the_step() {
    let per_depth = Matrix3::new(-2e8, -5e8, 0.0, 3e8, -2e8, 0.0, 1e8, 1e8, 0.0);
    let gain = LoopGain::new(&arm_and_cutter(), &per_depth);
    let deepest = 0.2;
    let nodes = trace(&gain, deepest);
    assert!(nodes.len() < 1500, "{}", nodes.len());
    for pair in nodes.windows(2) {
        assert!(pair[0].w < pair[1].w);
        for piece in 1..8 {
            let part = f64::from(piece) / 8.0;
            let w = pair[0].w + part * (pair[1].w - pair[0].w);
            let exact = gain.depths(w);
            for branch in 0..BRANCHES {
                let [a, b] = [0, 1].map(|end: usize| pair[end].depths[branch]);
                if a.norm().min(b.norm()) > deepest {
                    continue;
                }
                let chord = a + (b - a) * part;
                let distance = exact
                    .iter()
                    .map(|x| (x - chord).norm())
                    .fold(f64::INFINITY, f64::min);
                // A curve that turns by less than the step between nodes leaves its chord by less than half of it.
                assert!(
                    distance < 0.5 * STEP * chord.norm(),
                    "{w} {branch}: {distance} of {}",
                    chord.norm()
                );
            }
        }
    }
}

#[test]
fn segments_are_in_the_order_of_their_bound() {
    let per_depth = Matrix3::new(-2e8, -5e8, 0.0, 3e8, -2e8, 0.0, 1e8, 1e8, 0.0);
    let gain = LoopGain::new(&arm_and_cutter(), &per_depth);
    let nodes = trace(&gain, 0.1);
    let segments = segments(&nodes, 0.1);
    assert!(segments.windows(2).all(|pair| pair[0].least <= pair[1].least));
    assert!(segments.iter().all(|segment| segment.least < 0.1));
}

//! A whole experiment on an arm whose errors are known: what is found covers the truth as often as it says.
//!
//! The arm is longer and bent here and there, its joints yield and have play. A tracker looks at poses, weights pull at it, a
//! ball-bar goes round three circles that tell its joints apart, it mills a ring under forces that a dynamometer sees, and a
//! measuring machine probes the ring. Geometry, compliances, gaps and forces are found by the same functions that users call,
//! each step with what the steps before found, and the ring is predicted from all of them.
//!
//! `cell`: the arm, its ring and its circles; `found`: one experiment, from noise to estimates.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[path = "../arms/mod.rs"]
mod arms;
mod cell;
mod found;

use std::collections::BTreeMap;

use cell::Truth;
use found::{Estimate, experiment};
use rayon::prelude::*;

const SEEDS: u64 = 100;

/// How often an estimate was within 1.96 standard uncertainties of the truth.
#[derive(Clone, Copy, Default)]
struct Covered {
    inside: u32,
    all: u32,
}

impl Covered {
    fn take(&mut self, estimate: &Estimate) {
        self.inside += u32::from((estimate.found - estimate.truth).abs() < 1.96 * estimate.u);
        self.all += 1;
    }

    fn share(self) -> f64 {
        f64::from(self.inside) / f64::from(self.all)
    }
}

#[test]
fn stated_intervals_of_a_whole_experiment_cover_the_truth() {
    let experiments: Vec<_> = (0..SEEDS)
        .into_par_iter()
        .map(|seed| experiment(&Truth::of(seed), seed))
        .collect();
    let (mut pooled, mut each) = (Covered::default(), BTreeMap::<String, Covered>::new());
    for estimate in experiments.iter().flat_map(|found| &found.estimates) {
        assert!(estimate.u > 0.0, "{estimate:?}");
        pooled.take(estimate);
        each.entry(estimate.name.clone()).or_default().take(estimate);
    }
    // All are found in every experiment: six compliances, six gaps, three forces, the geometry.
    assert!(each.len() > 30, "{}", each.len());
    for (name, covered) in &each {
        println!("{name}: {:.2}", covered.share());
    }
    println!("pooled: {:.4} of {}", pooled.share(), pooled.all);
    for (name, covered) in &each {
        assert_eq!(u64::from(covered.all), SEEDS, "{name}");
        // Of 100 draws at 95 %, fewer than 85 are inside once in ten thousand.
        assert!(covered.share() >= 0.85, "{name}: {}", covered.share());
    }
    assert!((0.90..=0.99).contains(&pooled.share()), "{}", pooled.share());
    // The ring is what was predicted, but for the noise of the probe and what estimates are off; believed geometry and the
    // compliances of the data sheet explain less.
    for found in &experiments {
        let [ring, explained, untaught] = [found.ring_rms, found.explained, found.explained_untaught];
        println!(
            "ring {:.1} um: {explained:.4}, untaught {untaught:.4}",
            ring * 1e6
        );
        assert!(ring > 1e-5, "a ring worth predicting: {ring}");
        assert!(
            explained > 0.98 && 1.0 - untaught > 3.0 * (1.0 - explained),
            "{explained} {untaught}"
        );
    }
}

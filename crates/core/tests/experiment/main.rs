//! A whole experiment on an arm with known errors: the stated intervals cover the truth at the stated rate.
//!
//! The arm has geometric errors, joint compliance and backlash. A tracker measures poses, weights load the tool, a
//! ball-bar follows three circles that make all joints identifiable, it mills a ring under forces measured by a
//! dynamometer, and a measuring machine probes the ring. Geometry, compliances, backlash and forces are estimated by
//! the public functions, each step with the results of the steps before, and the ring is predicted from all of them.
//!
//! `cell`: the arm, its ring and its circles; `found`: one experiment, from noise to estimates.

// A panic is how a test fails; in helper functions too.
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

/// Number of estimates within 1.96 standard uncertainties of the truth.
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
    // All are found in every experiment: six compliances, six values of backlash, three forces, the geometry.
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
    // The ring matches its prediction except for the noise of the probe and the errors of the estimates; nominal
    // geometry and the compliances of the data sheet explain less.
    for found in &experiments {
        let [ring, explained, untaught] = [found.ring_rms, found.explained, found.explained_untaught];
        println!(
            "ring {:.1} um: {explained:.4}, untaught {untaught:.4}",
            ring * 1e6
        );
        assert!(ring > 1e-5, "the ring has too small an error: {ring}");
        assert!(
            explained > 0.98 && 1.0 - untaught > 3.0 * (1.0 - explained),
            "{explained} {untaught}"
        );
    }
}

use super::*;
use crate::load::{CuttingLaw, Immersion, Mechanistic};
use crate::stability::examples::{benchmark, benchmark_mode, rpm};
use crate::stability::named_mode::ModeUncertainty;

fn named(uncertainty: ModeUncertainty) -> NamedMode {
    NamedMode {
        name: "cutter".to_owned(),
        mode: benchmark_mode(),
        uncertainty,
    }
}

#[test]
fn the_boundary_is_proportional_to_stiffness_and_inverse_to_all_coefficients() {
    let cut = benchmark(Immersion::Down(0.01));
    let stiffness = ModeUncertainty {
        stiffness: 0.1,
        ..ModeUncertainty::default()
    };
    let found = BoundaryUncertainty::at_speed(&[named(stiffness)], &cut, rpm(9000.0), 0.1)
        .unwrap()
        .unwrap();
    // Half of ln(1.1/0.9).
    assert!(
        (found.of_log_depth - 0.5 * (1.1_f64 / 0.9).ln()).abs() < 1e-9,
        "{found:?}"
    );
    assert_eq!(found.shares, [1.0, 0.0]);
    // Both coefficients completely correlated: a factor on the force.
    let CuttingLaw::Mechanistic(law) = *cut.milling().law() else {
        unreachable!()
    };
    let deviation = law.coefficients() * 0.05;
    let law: Mechanistic = law.with_covariance(deviation * deviation.transpose()).unwrap();
    let correlated = cut.with_law(CuttingLaw::Mechanistic(law)).unwrap();
    let exact = ModeUncertainty::default();
    let found = BoundaryUncertainty::at_speed(&[named(exact)], &correlated, rpm(9000.0), 0.1)
        .unwrap()
        .unwrap();
    assert!(
        (found.of_log_depth - 0.5 * (1.05_f64 / 0.95).ln()).abs() < 1e-9,
        "{found:?}"
    );
    assert_eq!(found.shares, [0.0, 1.0]);
}

#[test]
fn probability_is_a_half_at_the_boundary_and_84_percent_a_standard_uncertainty_below() {
    let cut = benchmark(Immersion::Down(0.01));
    let all = ModeUncertainty {
        frequency: 0.01,
        damping: 0.2,
        stiffness: 0.1,
    };
    let found = BoundaryUncertainty::at_speed(&[named(all)], &cut, rpm(9000.0), 0.1)
        .unwrap()
        .unwrap();
    let depth = found.boundary.depth;
    assert!((found.probability_stable(depth) - 0.5).abs() < 1e-12);
    // Standard normal distribution at 1: 0.841344746.
    let below = depth * (-found.of_log_depth).exp();
    assert!((found.probability_stable(below) - 0.841_344_746).abs() < 1e-9);
    // Two standard uncertainties above: 0.022750132.
    let above = depth * (2.0 * found.of_log_depth).exp();
    assert!((found.probability_stable(above) - 0.022_750_132).abs() < 1e-9);
}

#[test]
fn exact_parameters_give_certainty() {
    let cut = benchmark(Immersion::Down(0.01));
    let exact = named(ModeUncertainty::default());
    let found = BoundaryUncertainty::at_speed(&[exact], &cut, rpm(9000.0), 0.1)
        .unwrap()
        .unwrap();
    let depth = found.boundary.depth;
    assert_eq!(
        [
            found.probability_stable(0.99 * depth),
            found.probability_stable(1.01 * depth)
        ],
        [1.0, 0.0]
    );
    assert_eq!(
        BoundaryUncertainty::at_speed(&[], &cut, rpm(9000.0), 0.1).unwrap(),
        None
    );
}

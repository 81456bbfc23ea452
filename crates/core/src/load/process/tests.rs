use super::*;
use crate::load::{Hand, Immersion, Mechanistic};
use std::f64::consts::TAU;

const MM: f64 = 1e-3;

fn process() -> Process {
    let shear = Vector3::new(1930.4e6, 1159.6e6, 200.6e6);
    let law = Mechanistic::new(shear, Vector3::zeros()).unwrap();
    Process {
        cutter: Cutter::flat(16.0 * MM, 4)
            .unwrap()
            .with_helix(45_f64.to_radians(), Hand::Right)
            .unwrap(),
        law: CuttingLaw::Mechanistic(law.with_relative_uncertainty(0.3).unwrap()),
        depth: MM,
        engagement: Engagement::of(Immersion::Up(5.0 * MM), 16.0 * MM).unwrap(),
        feed: 40.0 * MM,
        spindle: 3333.0 * TAU / 60.0,
    }
}

fn mean(process: Process, advance: Advance) -> Result<MeanForce, CuttingError> {
    Ok(process.milling(advance)?.mean())
}

fn unit(x: f64, y: f64, z: f64) -> Unit<Vector3<f64>> {
    Unit::new_normalize(Vector3::new(x, y, z))
}

#[test]
fn the_published_cut_has_its_published_mean() {
    let force = process().force(Advance::Level).unwrap();
    // Printed to four decimals.
    assert!((force.mean.force.norm() - 155.6207).abs() < 5e-5);
    assert!(force.peak.norm() > force.mean.force.norm());
    assert_eq!(mean(process(), Advance::Level), Ok(force.mean));
    assert!(
        force.mean.covariance.symmetric_eigenvalues().min() > 0.0,
        "three coefficients, three directions"
    );
}

#[test]
fn a_feed_across_the_tool_is_level_and_any_other_ascends_or_descends() {
    let spindle = unit(0.2, -0.1, 0.9);
    let across = Unit::new_normalize(spindle.cross(&Vector3::x()));
    assert_eq!(Advance::of(&across, &spindle), Advance::Level);
    let rise = -0.4_f64;
    let down = across.into_inner() * rise.cos() + spindle.into_inner() * rise.sin();
    let Advance::Ramp(found) = Advance::of(&Unit::new_normalize(down), &spindle) else {
        panic!("a ramp")
    };
    assert!((found - rise).abs() < 1e-15);
}

#[test]
fn a_feed_along_the_axis_is_a_plunge_or_a_withdrawal_and_is_refused() {
    let spindle = unit(0.1, 0.2, 1.0);
    assert_eq!(Advance::of(&-spindle, &spindle), Advance::Plunge);
    assert_eq!(Advance::of(&spindle, &spindle), Advance::Withdrawal);
    let error = mean(process(), Advance::Plunge).unwrap_err().to_string();
    assert!(
        error.contains("descends 90.0 deg") && error.contains("30 deg"),
        "{error}"
    );
    assert_eq!(
        mean(process(), Advance::Withdrawal),
        Err(CuttingError::Withdrawal)
    );
}

#[test]
fn ramps_up_to_30_deg_use_the_level_part_of_the_feed() {
    let level = mean(process(), Advance::Level).unwrap().force;
    let ramp = mean(process(), Advance::Ramp(-20_f64.to_radians()))
        .unwrap()
        .force;
    // No edge terms: the force is proportional to the chip.
    assert!((ramp - level * 20_f64.to_radians().cos()).norm() < 1e-11);
    assert!(mean(process(), Advance::Ramp(-31_f64.to_radians())).is_err());
    assert!(mean(process(), Advance::Ramp(f64::NAN)).is_err());
    assert!(mean(process(), Advance::Ramp(60_f64.to_radians())).is_ok());
}

#[test]
fn refuses_an_invalid_process() {
    for wrong in [
        Process {
            spindle: 0.0,
            ..process()
        },
        Process {
            depth: -1.0,
            ..process()
        },
        Process {
            feed: f64::NAN,
            ..process()
        },
    ] {
        assert!(mean(wrong, Advance::Level).is_err(), "{wrong:?}");
    }
}

#[test]
fn rounded_cuts_move_by_at_most_half_a_step_and_are_equal_then() {
    let part = 0.02;
    let step = part * 16.0 * MM;
    for k in 0..60 {
        let (depth, width) = (
            MM * (0.31 + 0.17 * f64::from(k)),
            MM * (0.5 + 0.23 * f64::from(k)),
        );
        let engagement = Engagement::of(Immersion::Up(width), 16.0 * MM).unwrap();
        let exact = Process {
            depth,
            engagement,
            ..process()
        };
        let rounded = exact.rounded(part);
        assert!((rounded.depth - depth).abs() <= 0.5 * step + 1e-15, "{depth}");
        let moved = rounded.engagement.edges().into_iter().zip(engagement.edges());
        assert!(
            moved
                .clone()
                .all(|(one, other)| (one - other).abs() <= 0.5 * step + 1e-15)
        );
        assert_eq!(rounded.engagement.edges()[1], 8.0 * MM, "a wall stays at the rim");
        assert_eq!(rounded.rounded(part), rounded);
    }
    // Less than a step deep is one deep, and a strip that would vanish stays as it is.
    let thin = Process {
        depth: 1e-6,
        engagement: Engagement::strip([1.01 * MM, 1.02 * MM], 16.0 * MM).unwrap(),
        ..process()
    };
    let rounded = thin.rounded(part);
    assert_eq!((rounded.depth, rounded.engagement), (step, thin.engagement));
}

#[test]
fn more_speed_or_more_teeth_thin_the_chip() {
    let size = |process: Process| mean(process, Advance::Level).unwrap().force.norm();
    let here = size(process());
    let faster = Process {
        spindle: 2.0 * process().spindle,
        ..process()
    };
    // No edge terms: the force is proportional to the feed per tooth; teeth share the same feed.
    assert!((size(faster) / here - 0.5).abs() < 1e-12);
    let toothed = Process {
        cutter: Cutter::flat(16.0 * MM, 8).unwrap(),
        ..process()
    };
    assert!((size(toothed) / here - 1.0).abs() < 1e-12);
}

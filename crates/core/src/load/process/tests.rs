use super::*;
use crate::load::{Hand, Mechanistic};
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
        immersion: Immersion::Up(5.0 * MM),
        feed: 40.0 * MM,
        spindle: 3333.0 * TAU / 60.0,
    }
}

fn unit(x: f64, y: f64, z: f64) -> Unit<Vector3<f64>> {
    Unit::new_normalize(Vector3::new(x, y, z))
}

#[test]
fn the_published_cut_has_its_published_mean() {
    let force = process().force(Advance::Level).unwrap();
    // Printed to four decimals.
    assert!((force.mean.norm() - 155.6207).abs() < 5e-5);
    assert!(force.peak.force.norm() > force.mean.norm());
    assert_eq!(
        process().mean(Advance::Level).unwrap().covariance,
        force.covariance
    );
    assert!(
        force.covariance.symmetric_eigenvalues().min() > 0.0,
        "three coefficients, three directions"
    );
}

#[test]
fn feed_along_x_with_the_tool_pointing_down_is_the_feed_frame_itself() {
    let frame = FeedFrame::in_base(unit(1.0, 0.0, 0.0), unit(0.0, 0.0, -1.0));
    assert_eq!(frame.advance, Advance::Level);
    assert!(frame.base_from_feed.angle() < 1e-15);
}

#[test]
fn the_frame_is_right_handed_with_z_to_the_spindle_and_x_along_the_feed() {
    let (feed, axis) = (unit(0.3, -0.8, 0.1), unit(-0.2, 0.1, -0.9));
    let frame = FeedFrame::in_base(feed, axis);
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|v| frame.base_from_feed * v);
    assert!((z + axis.into_inner()).norm() < 1e-15);
    assert!(x.dot(&feed) > 0.9 && y.dot(&feed).abs() < 1e-15);
    assert!((x.cross(&y) - z).norm() < 1e-15);
    let Advance::Ramp(rise) = frame.advance else {
        panic!("{:?}", frame.advance)
    };
    // The feed is the level part and the rise.
    assert!((x * rise.cos() + z * rise.sin() - feed.into_inner()).norm() < 1e-15);
}

#[test]
fn a_turned_cell_turns_the_force_and_its_covariance() {
    let force = process().force(Advance::Level).unwrap();
    let turn = UnitQuaternion::from_euler_angles(0.3, -1.1, 2.0);
    let level = FeedFrame::in_base(unit(1.0, 0.0, 0.0), unit(0.0, 0.0, -1.0));
    let turned = FeedFrame::in_base(turn * unit(1.0, 0.0, 0.0), turn * unit(0.0, 0.0, -1.0));
    let (here, there) = (level.wrench(force.mean), turned.wrench(force.mean));
    assert!((turn * here.force - there.force).norm() < 1e-12);
    let (a, b) = (
        level.covariance(force.covariance),
        turned.covariance(force.covariance),
    );
    let direction = Vector3::new(0.2, 0.5, -0.7);
    let along = |c: &Matrix3<f64>, d: &Vector3<f64>| d.dot(&(c * d));
    assert!((along(&a, &direction) - along(&b, &(turn * direction))).abs() < 1e-9);
}

#[test]
fn straight_along_the_axis_is_a_plunge_or_a_withdrawal_and_neither_mills() {
    let axis = unit(0.1, 0.2, -1.0);
    let down = FeedFrame::in_base(axis, axis);
    assert_eq!(down.advance, Advance::Plunge);
    assert_eq!(FeedFrame::in_base(-axis, axis).advance, Advance::Withdrawal);
    assert!((down.base_from_feed * Vector3::z() + axis.into_inner()).norm() < 1e-15);
    let error = process().mean(down.advance).unwrap_err().to_string();
    assert!(
        error.contains("dives 90.0 deg") && error.contains("30 deg"),
        "{error}"
    );
    assert_eq!(process().mean(Advance::Withdrawal), Err(CuttingError::Withdrawal));
}

#[test]
fn ramps_up_to_30_deg_feel_the_level_part_of_the_feed() {
    let level = process().mean(Advance::Level).unwrap().force;
    let ramp = process().mean(Advance::Ramp(-20_f64.to_radians())).unwrap().force;
    // No edge terms: the force goes with the chip.
    assert!((ramp - level * 20_f64.to_radians().cos()).norm() < 1e-11);
    assert!(process().mean(Advance::Ramp(-31_f64.to_radians())).is_err());
    assert!(process().mean(Advance::Ramp(f64::NAN)).is_err());
    assert!(process().mean(Advance::Ramp(60_f64.to_radians())).is_ok());
}

#[test]
fn a_process_that_cannot_be_is_refused() {
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
        Process {
            immersion: Immersion::Down(0.02),
            ..process()
        },
    ] {
        assert!(wrong.mean(Advance::Level).is_err(), "{wrong:?}");
    }
}

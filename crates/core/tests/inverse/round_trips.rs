//! Random joint positions to a pose and back, for each kind of inverse.

use armill_core::robot::inverse::Inverse;

use crate::arms::{self, other};
use crate::round_trips;

#[test]
fn closed_forms_return_the_original_joint_positions() {
    for robot in [
        arms::mh12(),
        arms::kr120(),
        other::kr210_l150(),
        other::ur10(),
        other::ur10e(),
        other::on_rail(&arms::mh12()),
        other::on_rail(&other::ur10e()),
    ] {
        assert_eq!(robot.inverse().word(), "closed_form", "{}", robot.name());
        let trips = round_trips(&robot, 10_000);
        assert_eq!(trips.returned, trips.poses, "{}", robot.name());
    }
}

#[test]
fn calibrated_arms_return_the_original_joint_positions() {
    for ideal in [arms::mh12(), other::ur10e()] {
        let robot = other::calibrated(&ideal, 5e-4);
        assert!(matches!(robot.inverse(), Inverse::Polished(_)));
        let trips = round_trips(&robot, 10_000);
        assert_eq!(trips.reached, trips.poses);
        // Near the singularities of the ideal arm two branches may end in one posture.
        assert!(trips.returned as f64 > 0.999 * trips.poses as f64, "{trips:?}");
    }
}

#[test]
#[ignore = "some minutes: 100 000 poses per arm"]
fn a_hundred_thousand_poses_of_every_arm() {
    for robot in [
        arms::mh12(),
        arms::kr120(),
        other::kr210_l150(),
        other::ur10(),
        other::ur10e(),
        other::on_rail(&arms::mh12()),
        other::calibrated(&arms::mh12(), 5e-4),
        other::calibrated(&other::ur10e(), 5e-4),
        other::free("made-up/puma-like", &other::PUMA_LIKE),
        other::free("made-up/skewed", &other::SKEWED),
        other::free("made-up/tilted-wrist", &other::TILTED_WRIST),
        other::free("made-up/spherical-shoulder", &other::SPHERICAL_SHOULDER),
        other::iiwa14(),
        other::oblique(),
    ] {
        let trips = round_trips(&robot, 100_000);
        assert!(trips.reached as f64 > 0.999 * trips.poses as f64, "{trips:?}");
        assert!(trips.returned as f64 > 0.999 * trips.poses as f64, "{trips:?}");
    }
}

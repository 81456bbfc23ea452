//! Inverse kind of each arm, and its description.

use super::*;
use crate::arms::{self, other};
use crate::robot::Robot;

/// An arm, the word and the sentence for its inverse, whether its branches have names and whether its flips are alike.
fn table() -> Vec<(Robot, &'static str, &'static str, [bool; 2])> {
    let named = "closed form, up to 8 postures (ortho-parallel arm with spherical wrist)";
    vec![
        (arms::mh12(), "closed_form", named, [true, true]),
        (arms::hung(), "closed_form", named, [true, true]),
        (
            other::ur10e(),
            "closed_form",
            "closed form, up to 8 postures (arm with three parallel axes)",
            [true, false],
        ),
        (
            other::calibrated(&arms::mh12(), 5e-4),
            "polished",
            "numeric from a closed form, up to 8 postures (nearly an ortho-parallel arm with spherical wrist)",
            [true, false],
        ),
        (
            other::calibrated(&other::ur10e(), 5e-4),
            "polished",
            "numeric from a closed form, up to 8 postures (nearly an arm with three parallel axes)",
            [true, false],
        ),
        (
            other::free("skewed", &other::SKEWED),
            "closed_form",
            "closed form, up to 8 postures without names (spherical wrist)",
            [false, false],
        ),
        (
            other::calibrated(&other::free("skewed", &other::SKEWED), 5e-4),
            "polished",
            "numeric from a closed form, up to 8 postures without names (nearly a spherical wrist)",
            [false, false],
        ),
        (
            other::iiwa14(),
            "closed_form",
            "closed form, up to 8 postures without names (spherical wrist); joint 3 is fixed",
            [false, false],
        ),
        (
            other::oblique(),
            "searched",
            "numeric from many starts: the postures that are found",
            [false, false],
        ),
        (
            other::on_rail(&arms::kr120()),
            "closed_form",
            "closed form, up to 8 postures (ortho-parallel arm with spherical wrist); the first joint is fixed",
            [true, true],
        ),
        (
            other::on_rail(&other::on_rail(&other::ur10e())),
            "closed_form",
            "closed form, up to 8 postures (arm with three parallel axes); the first 2 joints are fixed",
            [true, false],
        ),
    ]
}

#[test]
fn every_arm_has_the_inverse_of_its_kind() {
    for (robot, word, sentence, [has_branches, flips_are_alike]) in table() {
        let inverse = robot.inverse();
        assert_eq!(
            (inverse.word(), inverse.to_string().as_str()),
            (word, sentence),
            "{}",
            robot.name()
        );
        assert_eq!(inverse.has_branches(), has_branches, "{}", robot.name());
        assert_eq!(inverse.flips_are_alike(), flips_are_alike, "{}", robot.name());
    }
}

#[test]
fn only_an_exact_arm_without_rail_is_ortho_parallel() {
    for (robot, ..) in table() {
        // On a rail, calibrated or of another kind, points are solved one by one.
        let plain = matches!(robot.name(), "yaskawa/mh12" | "made-up/hung");
        assert_eq!(robot.ortho_parallel().is_some(), plain, "{}", robot.name());
    }
}

#[test]
fn a_rail_consists_of_the_first_prismatic_joints_that_are_redundant() {
    let railed = other::on_rail(&arms::mh12());
    let Inverse::OnRail(rail) = railed.inverse() else {
        panic!("{}", railed.inverse());
    };
    assert_eq!((rail.joints, rail.chain.links().len()), (1, 6));
    assert!(!matches!(rail.inverse, Inverse::OnRail(_)));
    // With six joints none is redundant: the first is prismatic, and takes part in the search.
    let mut motions = railed.chain().motions().to_vec();
    let last = motions
        .iter()
        .rposition(|motion| matches!(motion, Motion::About(_, Amount::Joint(_))))
        .unwrap();
    motions.truncate(last);
    let six = Robot::new("six", motions, railed.joints()[..6].to_vec()).unwrap();
    assert!(matches!(six.inverse(), Inverse::Searched));
}

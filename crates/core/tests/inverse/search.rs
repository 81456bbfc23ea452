//! Arms without a closed form: what a search finds, and follows along a path.

use armill_core::frame::Isometry;
use armill_core::robot::inverse::{Finder, Inverse, InverseTarget, posture_at};

use crate::arms::other;
use crate::{apart, round_trips};

#[test]
fn searched_arms_reach_every_pose() {
    // A search of 16 postures takes milliseconds: fewer poses here, 100 000 in the ignored test.
    let robot = other::oblique();
    assert!(matches!(robot.inverse(), Inverse::Searched));
    let trips = round_trips(&robot, 1000);
    assert!(trips.reached as f64 > 0.999 * trips.poses as f64, "{trips:?}");
}

#[test]
fn a_search_that_follows_keeps_the_postures_that_continue() {
    let (robot, tool) = (other::oblique(), Isometry::identity());
    let q = [0.3, 0.5, -0.4, 0.7, 1.1, 0.4];
    let start = posture_at(&robot, &q, &tool).base_from_tool;
    let (mut finder, mut fewer) = (Finder::new(&robot), 0);
    let mut before = usize::MAX;
    for k in 0..200 {
        let expected = InverseTarget {
            base_from_flange: Isometry::translation(0.0, 0.002 * f64::from(k), 0.0) * start,
            near: None,
            home: None,
        };
        let followed: Vec<Vec<f64>> = finder
            .all(&expected)
            .unwrap()
            .iter()
            .map(|p| p.joints.clone())
            .collect();
        assert!(
            followed.len() <= before || before == 0,
            "no new posture appears on the path"
        );
        fewer += usize::from(followed.len() < before);
        before = followed.len();
        let mut fresh = Finder::new(&robot);
        let fresh = fresh.all(&expected).unwrap();
        for joints in &followed {
            assert!(
                fresh
                    .iter()
                    .any(|found| apart(&robot, &found.joints, joints) < 1e-6),
                "at {k}"
            );
        }
    }
    assert!(fewer >= 2, "a pair of postures ends on the path");
}

//! Counts of points, fractions and areas within the tolerance.

use armill_study::answer::MapAnswer;

use crate::{answered, map, plate_with};

/// All points that the counts of a map speak of.
fn points(map: &MapAnswer) -> usize {
    let c = map.counts;
    let missed = c.out_of_reach + c.no_posture_inside_limits + c.not_found;
    c.within + c.above_tolerance + missed + c.unverified + c.unstable
}

#[test]
fn counts_add_up_and_the_fraction_is_those_within_over_all() {
    // Near, far and half-way: all within, none reached, and some of each.
    let answer = answered(&plate_with(
        "[[analysis]]\nkind = \"sections\"\nname = \"s\"\ndistances_mm = [500, 900, 1300, 1500, 9000]\n\
         [[analysis]]\nkind = \"sections\"\nname = \"b\"\ndistances_mm = [500, 900, 1300, 1500, 9000]\nposture.branch = \"best\"\n",
    ));
    assert_eq!(answer.maps.len(), 10);
    for map in &answer.maps {
        assert_eq!((points(map), map.grid.points), (81, 81), "{}", map.name);
        assert_eq!(
            map.fraction_within,
            map.counts.within as f64 / 81.0,
            "{}",
            map.name
        );
        let reached = map.grid.in_plane_um.iter().flatten().count();
        assert_eq!(
            reached,
            map.counts.within + map.counts.above_tolerance,
            "{}",
            map.name
        );
        assert!(
            map.fraction_within_and_inside_joint_limits <= map.fraction_within,
            "{}",
            map.name
        );
        let certainty = map.certainty.as_ref().unwrap();
        assert!(
            certainty.fraction_robustly_within <= map.fraction_within,
            "{}",
            map.name
        );
        assert!(
            map.fraction_within <= certainty.fraction_possibly_within,
            "{}",
            map.name
        );
        let expected: f64 = map.grid.probability_within.iter().flatten().sum();
        assert!(
            (certainty.fraction_expected_within * 81.0 - expected).abs() < 1e-2,
            "{}",
            map.name
        );
        let named: usize = map.grid.flags.iter().map(|remark| remark.points.len()).sum();
        assert_eq!(
            named,
            81 - reached + map.outside_joint_limits + map.near_singularity,
            "{}",
            map.name
        );
    }
    assert_eq!(map(&answer, "s: x = 9000 mm").counts.out_of_reach, 81);
}

#[test]
fn a_larger_tolerance_is_met_at_least_as_often() {
    let fractions = [10, 40, 60, 80, 200, 1000].map(|limit| {
        let analysis = format!("[[analysis]]\nkind = \"map\"\nname = \"m\"\ntolerance_um = {limit}\n");
        let answer = answered(&plate_with(&analysis));
        (answer.maps[0].fraction_within, answer.maps[0].region.area_mm2)
    });
    for pair in fractions.windows(2) {
        // Areas are sums of some hundred triangles of 1e3 mm^2.
        assert!(
            pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1 + 1e-6,
            "{fractions:?}"
        );
    }
    assert_eq!(fractions[0], (0.0, 0.0));
    assert_eq!(fractions[5].0, 1.0);
    assert!(
        (fractions[5].1 - 400.0 * 400.0).abs() < 1e-6,
        "{} mm^2",
        fractions[5].1
    );
}

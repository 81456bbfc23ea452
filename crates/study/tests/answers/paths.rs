//! Shapes on the plane: where they begin, their roundness, in which branch they are followed.

use armill_study::analysis::AnalysisData;

use crate::{answered, found, plate_with};

#[test]
fn a_circle_starts_at_plus_y_and_turns_towards_z() {
    let study = plate_with(
        "[[analysis]]\nkind = \"path\"\nname = \"c\"\ncircle = { centre_mm = [50, 100], radius_mm = 40 }\n",
    );
    let found = found(&study);
    let AnalysisData::Path(analysis, _) = &found[0].found else {
        panic!("a path")
    };
    let points = &analysis.track.path.points;
    let in_plane = |i: usize| [-points[i].at.x * 1e3, points[i].at.y * 1e3];
    let quarter = points.len() / 4;
    assert_eq!(points.len() % 4, 0);
    for (index, expected) in [(0, [90.0, 100.0]), (quarter, [50.0, 140.0])] {
        let [y, z] = in_plane(index);
        assert!(
            (y - expected[0]).abs() < 1e-9 && (z - expected[1]).abs() < 1e-9,
            "({y}, {z}) mm"
        );
    }
}

#[test]
fn a_rigid_robot_does_not_deviate_and_cuts_round_circles() {
    let rigid = "compliance = { rad_per_n_m = [0, 0, 0, 0, 0, 0], source = \"rigid\" }\n";
    let answer = answered(&plate_with(&format!(
        "{rigid}[[analysis]]\nkind = \"map\"\ntolerance_um = 0\n[[analysis]]\nkind = \"path\"\ncircle.radius_mm = 100\n"
    )));
    assert_eq!(
        (answer.maps[0].max_in_plane_um, answer.maps[0].fraction_within),
        (Some(0.0), 1.0)
    );
    assert_eq!(answer.paths[0].max_in_plane_um, Some(0.0));
    // A radius of 0.1 m in doubles, fitted: 1e-16 m a point, some ten of them.
    assert!(
        answer.paths[0].roundness_um.unwrap() < 1e-8,
        "{:?}",
        answer.paths[0].roundness_um
    );
}

#[test]
fn roundness_is_at_most_the_spread_of_the_radial_deviation() {
    let answer = answered(&plate_with(
        "[[analysis]]\nkind = \"path\"\ncircle.radius_mm = 100\n",
    ));
    let path = &answer.paths[0];
    assert_eq!((path.circle_cases.len(), path.unreachable), (4, 0));
    for case in &path.circle_cases {
        let spread = case.max_radial_um - case.min_radial_um;
        // The least-squares centre is not that of least spread: its fit may cost as much again at most.
        assert!(
            case.roundness_um > 0.0 && case.roundness_um <= 2.0 * spread,
            "{case:?}"
        );
    }
    let largest = path
        .circle_cases
        .iter()
        .map(|case| case.roundness_um)
        .fold(0.0, f64::max);
    assert_eq!(path.roundness_um, Some(largest));
}

#[test]
fn a_path_is_followed_in_one_branch_which_the_answer_names() {
    let analysis =
        "[[analysis]]\nkind = \"path\"\nname = \"c\"\ncircle.radius_mm = 100\nposture.branch = \"best\"\n";
    let answer = answered(&plate_with(analysis));
    let path = &answer.paths[0];
    let followed = path.followed_branch.as_ref().unwrap();
    assert_eq!((path.branch.as_str(), followed.split(' ').count()), ("best", 3));
    assert!(
        path.worst_points
            .iter()
            .all(|worst| worst.point.branch == *followed)
    );
    // A circle has parts along its track and across it; the largest in the plane is at least either.
    let largest = path.max_in_plane_um.unwrap();
    assert!(path.max_along_um.unwrap() <= largest && path.max_cross_um.unwrap() <= largest);
    assert!(path.max_axial_um.unwrap() <= path.max_full_um.unwrap());
}

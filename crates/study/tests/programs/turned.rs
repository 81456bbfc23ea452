//! Turns of the tool and branches that are searched for along a program.

use crate::{CELL, LOAD, RING, analysis, reported};

/// A tool across the flange, so that turning it moves the wrist; the search bounded by the words of the posture.
fn cell(posture: &str) -> String {
    CELL.replace("[0, 0, 150, 0, 0, 0]", "[120, 0, 150, 0, 90, 0]")
        .replace("[1000, 50, 500]", "[850, 50, 300]")
        .replace(
            "posture = { branch = \"front elbow-up no-flip\" }",
            &format!("posture = {{ {posture} }}"),
        )
}

fn searched(posture: &str) -> armill_study::answer::PathAnswer {
    let study = format!("{}{LOAD}{}", cell(posture), analysis("file = \"ring.ngc\""));
    reported(&study, &[("ring.ngc", RING)]).unwrap().paths[0].clone()
}

#[test]
fn a_search_improves_the_worst_point_and_reports_before_and_after() {
    let plain = searched("branch = \"front elbow-up\"");
    assert!(plain.search.is_none());
    let found = searched("branch = \"front elbow-up\", search = { step_deg = 10 }");
    let search = found.search.unwrap();
    assert_eq!(
        (search.component, search.objective, search.turns),
        ("in-plane", "worst", 36)
    );
    assert_eq!(search.without.max_in_plane_um, plain.max_in_plane_um);
    assert_eq!(search.with.max_in_plane_um, found.max_in_plane_um);
    let (before, after) = (plain.max_in_plane_um.unwrap(), found.max_in_plane_um.unwrap());
    assert!(after < 0.9 * before, "{before} um, then {after} um");
    assert!(
        search.unreachable_stretches.is_empty()
            && search.breaks.is_empty()
            && search.with.outside_joint_limits == 0
    );
    assert!(found.followed_branch.unwrap().starts_with("front elbow-up"));
    // Free in its branch the arm does no worse; a turn bounded to where it is changes the branch alone.
    let free = searched("search = { step_deg = 10 }");
    assert!(free.max_in_plane_um.unwrap() <= after * 1.02);
    let still = searched("search = { turns_deg = [0, 0] }").search.unwrap();
    assert_eq!((still.turns, still.turn_range_deg), (1, [0.0, 0.0]));
}

#[test]
fn a_mean_below_that_of_the_worst_and_a_worst_below_that_of_the_mean() {
    let of = |objective: &str| {
        searched(&format!(
            "search = {{ step_deg = 10, objective = \"{objective}\" }}"
        ))
    };
    let (worst, mean) = (of("worst"), of("mean"));
    let [a, b] = [&worst, &mean].map(|path| path.search.as_ref().unwrap().with.clone());
    // Turns without steps change a deviation by some percent.
    assert!(a.max_in_plane_um.unwrap() <= b.max_in_plane_um.unwrap() * 1.03);
    assert!(b.mean_in_plane_um.unwrap() <= a.mean_in_plane_um.unwrap() * 1.03);
}

#[test]
fn an_unreachable_path_is_reported_with_position_and_reason() {
    let far = RING.replace("X40", "X900").replace("I-40", "I-900");
    let study = format!(
        "{}{LOAD}{}",
        cell("search = { step_deg = 30 }"),
        analysis("file = \"ring.ngc\"\nstep_mm = 50")
    );
    let answer = reported(&study, &[("ring.ngc", &far)]).unwrap();
    let search = answer.paths[0].search.as_ref().unwrap();
    assert!(
        !search.unreachable_stretches.is_empty()
            && search
                .unreachable_stretches
                .iter()
                .all(|stretch| stretch.first_line == 5)
    );
    let given = answer
        .warnings
        .iter()
        .any(|warning| warning.contains("no spin of the tool and branch is usable"));
    assert!(given, "{:?}", answer.warnings);
}

#[test]
fn a_search_that_cannot_be_is_refused_at_its_place() {
    let refused = |search: &str| {
        let study = format!(
            "{}{LOAD}{}",
            cell(&format!("search = {{ {search} }}")),
            analysis("file = \"ring.ngc\"")
        );
        reported(&study, &[("ring.ngc", RING)]).unwrap_err()
    };
    assert!(refused("turns_deg = [90, -90]").contains("turns range from 90 to -90 deg"));
    assert!(refused("turns_deg = [-300, 300]").contains("at most 360 deg apart"));
    assert!(refused("step_deg = 0").contains("`posture.search.step_deg` is 0 deg"));
    assert!(refused("objective = \"best\"").contains("objective"));
    // A map has no path along which the tool could turn.
    let map = format!("{CELL}{LOAD}\n[[analysis]]\nkind = \"map\"\nposture.search = {{}}\n");
    assert!(
        reported(&map, &[])
            .unwrap_err()
            .contains("`posture.search` is not valid for a map")
    );
}

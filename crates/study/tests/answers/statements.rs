//! Content of a result apart from numbers of points: statements, assumptions, sources, warnings, its sentence.

use crate::{PLATE, answered, plate_with, study};

#[test]
fn a_statement_is_consistent_where_the_largest_deviation_is_within_its_bound() {
    let most = answered(&plate_with("")).maps[0].max_in_plane_um.unwrap();
    for (bound, consistent) in [(most * (1.0 - 1e-9), false), (most * (1.0 + 1e-9), true)] {
        let statement = format!(
            "[[analysis]]\nkind = \"map\"\nname = \"m\"\n[[analysis]]\nkind = \"map\"\nname = \"far\"\nplane.centre_mm = [9000, 0, 800]\n\
             [[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = {bound}\nof = [\"m\", \"far\"]\n"
        );
        let answer = answered(&plate_with(&statement));
        let readings = &answer.statements[0].readings;
        assert_eq!(
            (readings.len(), readings[0].consistent),
            (2, consistent),
            "{readings:?}"
        );
        assert_eq!(readings[0].in_plane_um.unwrap()[1], most);
        assert!(
            readings[1].in_plane_um.is_none() && !readings[1].consistent,
            "what is not reached confirms nothing"
        );
    }
}

#[test]
fn assumed_compliances_and_their_source_are_reported() {
    let own = "compliance = { rad_per_n_m = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6], source = \"a guess of mine\", assumed = true }\n";
    let kuka = PLATE
        .replace("yaskawa/mh12", "kuka/kr120r2500pro")
        .replace("[900,", "[1500,");
    let answer = answered(&study(&format!("{kuka}{own}")));
    assert!(
        answer.warnings.iter().any(|warning| warning.contains("assumed")),
        "{:?}",
        answer.warnings
    );
    assert!(
        answer
            .sources
            .iter()
            .any(|source| source.place == "a guess of mine")
    );
    assert!(
        answer
            .robot
            .joints
            .iter()
            .all(|joint| joint.compliance_source == "a guess of mine")
    );
}

#[test]
fn a_box_alone_is_reported_in_the_sentence_and_what_is_out_of_reach_in_warnings() {
    let of_box = "[[analysis]]\nkind = \"volume\"\nname = \"v\"\nbox = { half_size_mm = [50, 50, 50], step_mm = 50 }\n";
    let answer = answered(&plate_with(of_box));
    assert!(
        answer.answer.starts_with("v, branch ") && answer.answer.contains("% of the box"),
        "{}",
        answer.answer
    );
    let far = "plane = { centre_mm = [9000, 0, 800] }\n";
    let path = "[[analysis]]\nkind = \"path\"\nname = \"c\"\ncircle.radius_mm = 100\n";
    let answer = answered(&plate_with(&format!("{of_box}{far}{path}{far}")));
    for words in [
        "v: no point of the box has a posture",
        "c: 360 of 360 points are out of reach",
    ] {
        assert!(
            answer.warnings.iter().any(|warning| warning.contains(words)),
            "{words}: {:?}",
            answer.warnings
        );
    }
    assert!(
        answer.answer.contains("reaches no point of the box"),
        "{}",
        answer.answer
    );
}

#[test]
fn sources_of_loads_and_of_the_tool_holder_are_in_the_result() {
    let tool = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0], mass = [{ at = \"tool\", mass_kg = 5, centre_mm = [0, 0, -50], source = \"weighed\" }] }\n";
    let analysis =
        "[[analysis]]\nkind = \"map\"\nload = { cases_n = [[1, 2, 3]], source = \"a dynamometer\" }\n";
    let answer = answered(&plate_with(&format!("{tool}{analysis}")));
    let place = |key: &str| {
        answer
            .sources
            .iter()
            .find(|source| source.key == key)
            .map(|source| source.place.clone())
    };
    assert_eq!(place("load").as_deref(), Some("a dynamometer"));
    assert_eq!(place("tool").as_deref(), Some("weighed"));
    assert_eq!(
        answer.maps[0].setting.load_source.as_deref(),
        Some("a dynamometer")
    );
}

#[test]
fn chips_thicker_than_a_fifth_of_the_radius_are_reported() {
    // 1 mm at 900 revolutions a minute.
    let at = |rpm: u32| {
        let cut = format!(
            "[cut]\nmaterial = \"aluminium-7075-t6\"\naxial_depth_mm = 1\nside = \"slot\"\nspindle_rpm = {rpm}\nfeed_mm_per_min = 1800\n\
             cutter = {{ diameter_mm = 10, flutes = 2 }}\n[[analysis]]\nkind = \"path\"\nname = \"c\"\ncircle.radius_mm = 100\nstep_mm = 10\n"
        );
        answered(&plate_with(&cut))
    };
    let thin = at(910);
    assert_eq!(thin.paths[0].cut.as_ref().unwrap().points_with_thick_chips, 0);
    assert!(!thin.warnings.iter().any(|warning| warning.contains("thicker")));
    let thick = at(890);
    let cut = thick.paths[0].cut.as_ref().unwrap();
    assert_eq!(cut.points_with_thick_chips, thick.paths[0].points);
    let expected = "c: chips are thicker than a fifth of the radius of the cutter at 63 points, the first in line 1 (up to 1011.2 µm): check the units";
    assert!(
        thick.warnings.iter().any(|warning| warning.starts_with(expected)),
        "{:?}",
        thick.warnings
    );
}

//! The same points computed in two ways: as map, section, volume or path; in two branches, axes or frames.

use armill_study::analysis::AnalysisData;
use armill_study::answer::answer;

use crate::{SAME, answered, found, map, plate_with};

#[test]
fn a_section_is_the_map_of_its_plane() {
    let answer = answered(&plate_with(
        "[[analysis]]\nkind = \"sections\"\nname = \"s\"\ntilts_deg = [0, 45, 90]\n\
         [[analysis]]\nkind = \"sections\"\nname = \"d\"\ndistances_mm = [800, 900]\n\
         [[analysis]]\nkind = \"map\"\nname = \"tilted\"\nplane.tilt_deg = 45\n\
         [[analysis]]\nkind = \"map\"\nname = \"nearer\"\nplane.centre_mm = [800, 0, 800]\n",
    ));
    assert_eq!(answer.maps.len(), 3 + 2 + 2);
    assert_eq!(
        map(&answer, "s: tilt 45 deg").grid.in_plane_um,
        map(&answer, "tilted").grid.in_plane_um
    );
    assert_eq!(
        map(&answer, "d: x = 800 mm").grid.in_plane_um,
        map(&answer, "nearer").grid.in_plane_um
    );
    assert_eq!(
        map(&answer, "s: tilt 0 deg").grid.in_plane_um,
        map(&answer, "d: x = 900 mm").grid.in_plane_um
    );
}

#[test]
fn a_load_given_in_the_part_turns_with_the_plane_of_each_section() {
    let load = "load = { frame = \"part\", cases_n = [[3, 5, 7]], u_n = [1, 0.5, 0] }\n";
    let answer = answered(&plate_with(&format!(
        "[[analysis]]\nkind = \"sections\"\nname = \"s\"\ntilts_deg = [0, 60]\n{load}\
         [[analysis]]\nkind = \"map\"\nname = \"tilted\"\nplane.tilt_deg = 60\n{load}"
    )));
    let (section, tilted) = (map(&answer, "s: tilt 60 deg"), map(&answer, "tilted"));
    assert_eq!(section.setting.cases_n, tilted.setting.cases_n);
    assert_ne!(
        section.setting.cases_n,
        map(&answer, "s: tilt 0 deg").setting.cases_n
    );
    assert_eq!(section.grid.in_plane_um, tilted.grid.in_plane_um);
}

#[test]
fn a_volume_agrees_with_the_map_of_a_plane_through_it() {
    let study = plate_with(
        "[[analysis]]\nkind = \"map\"\nname = \"m\"\n\
         [[analysis]]\nkind = \"volume\"\nname = \"v\"\nbox = { half_size_mm = [50, 200, 200], step_mm = 50 }\n",
    );
    let found = found(&study);
    let (AnalysisData::Map(_, map), AnalysisData::Volume(_, volume)) = (&found[0].found, &found[1].found)
    else {
        panic!("a map and a volume")
    };
    assert_eq!(volume.grid.counts, [3, 9, 9]);
    for index in 0..map.grid.len() {
        let tcp = map
            .plane
            .base_from_tool(map.grid.point(index), 0.0)
            .translation
            .vector;
        let same = (0..volume.grid.len()).find(|i| (volume.grid.point(*i).coords - tcp).norm() < 1e-9);
        let (in_map, in_volume) = (
            map.answers.points[index].unwrap(),
            volume.answers.points[same.unwrap()].unwrap(),
        );
        assert_eq!(
            (in_map.name, in_map.worst_case),
            (in_volume.name, in_volume.worst_case)
        );
        assert!((in_map.in_plane - in_volume.in_plane).abs() < SAME, "{tcp}");
        assert!(
            (in_map.normal - in_volume.normal).abs() < SAME && (in_map.full - in_volume.full).abs() < SAME
        );
    }
    let given = answer(&study, &found);
    let counts = given.volumes[0].counts;
    assert_eq!(counts.within + counts.above_tolerance, 3 * 81);
    // Each point represents a cell of (50 mm)^3; products of such sizes are exact to 1e-9 mm^3 or better.
    assert!((given.volumes[0].volume_within_mm3 - counts.within as f64 * 125_000.0).abs() < 1e-3);
}

#[test]
fn a_path_agrees_with_the_map_where_they_meet() {
    let study = plate_with(
        "[[analysis]]\nkind = \"map\"\nname = \"m\"\n\
         [[analysis]]\nkind = \"path\"\nname = \"row\"\nline = { from_mm = [-200, 50], to_mm = [200, 50] }\nstep_mm = 50\n",
    );
    let found = found(&study);
    let (AnalysisData::Map(_, map), AnalysisData::Path(analysis, path)) = (&found[0].found, &found[1].found)
    else {
        panic!("a map and a path")
    };
    let points = &analysis.track.path.points;
    assert_eq!(points.len(), 9);
    for (sample, on_path) in points.iter().zip(&path.along.answers.points) {
        let same = (0..map.grid.len())
            .find(|i| (map.grid.point(*i) - sample.at.xy()).norm() < 1e-9)
            .unwrap();
        let (a, b) = (map.answers.points[same].unwrap(), on_path.unwrap());
        assert!((a.in_plane - b.in_plane).abs() < SAME, "{}", sample.at);
    }
}

#[test]
fn the_best_posture_is_inside_limits_and_never_worse_than_a_named_one_that_is() {
    let analysis = |branch: &str| {
        format!("[[analysis]]\nkind = \"map\"\nname = \"{branch}\"\nposture.branch = \"{branch}\"\n")
    };
    let study = plate_with(
        &["best", "front elbow-up", "front elbow-down"]
            .map(analysis)
            .concat(),
    );
    let found = found(&study);
    let maps: Vec<_> = found
        .iter()
        .map(|found| {
            if let AnalysisData::Map(_, map) = &found.found {
                map
            } else {
                panic!("a map")
            }
        })
        .collect();
    for index in 0..maps[0].grid.len() {
        let Ok(best) = &maps[0].answers.points[index] else {
            panic!("point {index} has no posture inside limits")
        };
        assert!(best.within_limits());
        for named in &maps[1..] {
            if let Ok(evaluation) = named.answers.points[index]
                .as_ref()
                .map(|evaluation| *evaluation)
                .map_err(|_| ())
            {
                assert!(
                    !evaluation.within_limits() || best.in_plane <= evaluation.in_plane + SAME,
                    "point {index}"
                );
            }
        }
    }
}

#[test]
fn a_load_in_part_axes_is_the_same_load_in_base_axes() {
    // A horizontal plate: x_part = -y, y_part = x, z_part = up.
    let analysis = |name: &str, load: &str| {
        format!("[[analysis]]\nkind = \"map\"\nname = \"{name}\"\nplane.tilt_deg = 90\nload = {load}\n")
    };
    let answer = answered(&plate_with(&format!(
        "{}{}",
        analysis(
            "part",
            "{ frame = \"part\", cases_n = [[3, 5, 7]], moments_n_m = [[0, 1, 2]] }"
        ),
        analysis("base", "{ cases_n = [[5, -3, 7]], moments_n_m = [[1, 0, 2]] }")
    )));
    assert_eq!(answer.maps[0].setting.cases_n, [[5.0, -3.0, 7.0]]);
    for (a, b) in answer.maps[0]
        .grid
        .full_um
        .iter()
        .zip(&answer.maps[1].grid.full_um)
    {
        // Reported to 1e-4 um.
        assert!((a.unwrap() - b.unwrap()).abs() < 1.1e-4, "{a:?} um and {b:?} um");
    }
}

#[test]
fn heights_of_the_controller_frame_count_450_mm_higher() {
    let analyses = "[[analysis]]\nkind = \"map\"\nname = \"floor\"\n\
                [[analysis]]\nkind = \"map\"\nname = \"controller\"\nbase = \"controller\"\nplane.centre_mm = [900, 0, 350]\n";
    let answer = answered(&plate_with(analyses));
    for (a, b) in answer.maps[0]
        .grid
        .in_plane_um
        .iter()
        .flatten()
        .zip(answer.maps[1].grid.in_plane_um.iter().flatten())
    {
        // Reported to 1e-4 um.
        assert!((a - b).abs() < 1.1e-4, "{a} um and {b} um");
    }
    assert_eq!(answer.maps[1].setting.centre_mm, [900.0, 0.0, 350.0]);
}

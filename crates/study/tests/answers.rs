//! Small studies through the library: answers against each other, against counting, and against what must hold.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use armill_core::watch::Watch;
use armill_study::answer::{MapAnswer, StudyAnswer, answer};
use armill_study::file::resolve::{Study, read};
use armill_study::output::{Wanted, write};
use armill_study::run::{Done, Found, point_count, run};
use armill_study::{ErrorKind, StudyError, library};

/// 9 x 9 points in front of an MH12; tables can be appended.
const PLATE: &str = r#"format = 1
title = "Plate"
robot = "yaskawa/mh12"
limit_um = 60
plane = { centre_mm = [900, 0, 800], tilt_deg = 0, half_size_mm = 200, step_mm = 50 }
load = { cases_n = [[3, -5, -5], [3, -5, 5], [3, 5, -5], [3, 5, 5]] }
"#;

/// Two ways of computing the same point: 1e-15 of a metre in the pose, times some 1e2 um/m of slope; in m.
const SAME: f64 = 1e-15;

fn study(text: &str) -> Study {
    read("study.toml", Path::new("."), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn plate_with(asks: &str) -> Study {
    study(&format!("{PLATE}{asks}"))
}

fn found(study: &Study) -> Vec<Done<'_>> {
    run(study, Watch::NONE).unwrap_or_else(|error| panic!("{error}"))
}

fn answered(study: &Study) -> StudyAnswer {
    answer(study, &found(study))
}

fn map<'a>(answer: &'a StudyAnswer, name: &str) -> &'a MapAnswer {
    answer
        .maps
        .iter()
        .find(|map| map.name == name)
        .unwrap_or_else(|| panic!("no map `{name}`"))
}

fn points(map: &MapAnswer) -> usize {
    let c = map.counts;
    let missed = c.out_of_reach + c.no_posture_inside_limits + c.not_found;
    c.within + c.over_limit + missed + c.unverified + c.unstable
}

#[test]
fn counts_add_up_and_the_fraction_is_those_within_over_all() {
    // Near, far and half-way: all within, none reached, and some of each.
    let answer = answered(&plate_with(
        "[[ask]]\nkind = \"sections\"\nname = \"s\"\ndistances_mm = [500, 900, 1300, 1500, 9000]\n\
         [[ask]]\nkind = \"sections\"\nname = \"b\"\ndistances_mm = [500, 900, 1300, 1500, 9000]\nposture.branch = \"best\"\n",
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
        assert_eq!(reached, map.counts.within + map.counts.over_limit, "{}", map.name);
        assert!(
            map.fraction_within_and_inside_joint_limits <= map.fraction_within,
            "{}",
            map.name
        );
        let certainty = &map.certainty;
        assert!(
            certainty.fraction_surely_within <= map.fraction_within,
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
        let named: usize = map.grid.remarks.iter().map(|remark| remark.points.len()).sum();
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
fn doubt_about_load_and_tool_widens_the_uncertainty_and_nothing_else() {
    let sure = answered(&plate_with(""));
    for (table, key) in [
        (
            "tool = { flange_from_tool_mm_deg = [0, 0, 0, 0, 0, 0], length_u_mm = 2 }\n",
            "length",
        ),
        ("load.u_percent = 10\n", "percent"),
        ("load.u_n = [1, 1, 1]\n", "components"),
    ] {
        let text = match table.strip_prefix("load.") {
            Some(more) => PLATE.replace("5, 5]] }", &format!("5, 5]], {} }}", more.trim())),
            None => format!("{PLATE}{table}"),
        };
        let doubtful = answered(&study(&text));
        let (a, b) = (&sure.maps[0].grid, &doubtful.maps[0].grid);
        assert_eq!(
            doubtful.maps[0].fraction_within, sure.maps[0].fraction_within,
            "{key}"
        );
        for (sure, doubtful) in a.in_plane_u_um.iter().zip(&b.in_plane_u_um) {
            assert!(doubtful > sure, "{key}: {doubtful:?} against {sure:?}");
        }
        for (sure, doubtful) in a.in_plane_um.iter().zip(&b.in_plane_um) {
            // Rounded to 0.1 nm.
            assert!((sure.unwrap() - doubtful.unwrap()).abs() < 2e-4, "{key}");
        }
    }
}

#[test]
fn a_larger_tolerance_holds_at_least_as_much() {
    let fractions = [10, 40, 60, 80, 200, 1000].map(|limit| {
        let ask = format!("[[ask]]\nkind = \"map\"\nname = \"m\"\nlimit_um = {limit}\n");
        let answer = answered(&plate_with(&ask));
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

#[test]
fn a_section_is_the_map_of_its_plane() {
    let answer = answered(&plate_with(
        "[[ask]]\nkind = \"sections\"\nname = \"s\"\ntilts_deg = [0, 45, 90]\n\
         [[ask]]\nkind = \"sections\"\nname = \"d\"\ndistances_mm = [800, 900]\n\
         [[ask]]\nkind = \"map\"\nname = \"tilted\"\nplane.tilt_deg = 45\n\
         [[ask]]\nkind = \"map\"\nname = \"nearer\"\nplane.centre_mm = [800, 0, 800]\n",
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
fn a_volume_agrees_with_the_map_of_a_plane_through_it() {
    let study = plate_with(
        "[[ask]]\nkind = \"map\"\nname = \"m\"\n\
         [[ask]]\nkind = \"volume\"\nname = \"v\"\nbox = { half_size_mm = [50, 200, 200], step_mm = 50 }\n",
    );
    let found = found(&study);
    let (Found::Map(_, map), Found::Volume(_, volume)) = (&found[0].found, &found[1].found) else {
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
            (in_map.name, in_map.deciding_case),
            (in_volume.name, in_volume.deciding_case)
        );
        assert!((in_map.in_plane - in_volume.in_plane).abs() < SAME, "{tcp}");
        assert!(
            (in_map.normal - in_volume.normal).abs() < SAME && (in_map.full - in_volume.full).abs() < SAME
        );
    }
    let told = answer(&study, &found);
    let counts = told.volumes[0].counts;
    assert_eq!(counts.within + counts.over_limit, 3 * 81);
    // Each point stands for a cell of (50 mm)^3; products of such sizes are exact to 1e-9 mm^3 or better.
    assert!((told.volumes[0].volume_within_mm3 - counts.within as f64 * 125_000.0).abs() < 1e-3);
}

#[test]
fn a_path_agrees_with_the_map_where_they_meet() {
    let study = plate_with(
        "[[ask]]\nkind = \"map\"\nname = \"m\"\n\
         [[ask]]\nkind = \"path\"\nname = \"row\"\nline = { from_mm = [-200, 50], to_mm = [200, 50] }\nstep_mm = 50\n",
    );
    let found = found(&study);
    let (Found::Map(_, map), Found::Path(ask, path)) = (&found[0].found, &found[1].found) else {
        panic!("a map and a path")
    };
    let points = &ask.track.path.points;
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
fn a_circle_starts_at_plus_y_and_turns_towards_z() {
    let study = plate_with(
        "[[ask]]\nkind = \"path\"\nname = \"c\"\ncircle = { centre_mm = [50, 100], radius_mm = 40 }\n",
    );
    let found = found(&study);
    let Found::Path(ask, _) = &found[0].found else {
        panic!("a path")
    };
    let points = &ask.track.path.points;
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
fn a_rigid_arm_deviates_by_nothing_and_cuts_round_circles() {
    let rigid = "compliance = { rad_per_n_m = [0, 0, 0, 0, 0, 0], source = \"rigid\" }\n";
    let answer = answered(&plate_with(&format!(
        "{rigid}[[ask]]\nkind = \"map\"\nlimit_um = 0\n[[ask]]\nkind = \"path\"\ncircle.radius_mm = 100\n"
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
    let answer = answered(&plate_with("[[ask]]\nkind = \"path\"\ncircle.radius_mm = 100\n"));
    let path = &answer.paths[0];
    assert_eq!((path.circle_cases.len(), path.unreached), (4, 0));
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
fn twice_the_compliance_or_twice_the_force_deviates_twice() {
    let own = |factor: f64| {
        let values = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5].map(|c| format!("{:e}", c * factor));
        format!(
            "compliance = {{ rad_per_n_m = [{}], source = \"scaled\" }}\n",
            values.join(", ")
        )
    };
    let once = answered(&plate_with(&own(1.0)));
    let softer = answered(&plate_with(&own(2.0)));
    let forces = "[[ask]]\nkind = \"map\"\nname = \"map\"\nload.cases_n = [[6, -10, -10], [6, -10, 10], [6, 10, -10], [6, 10, 10]]\n";
    let pushed = answered(&plate_with(&format!("{}{forces}", own(1.0))));
    for other in [&softer, &pushed] {
        for (a, b) in once.maps[0]
            .grid
            .in_plane_um
            .iter()
            .flatten()
            .zip(other.maps[0].grid.in_plane_um.iter().flatten())
        {
            // Both told to 1e-4 um.
            assert!((2.0 * a - b).abs() < 2.0 * 1e-4, "{a} um and {b} um");
        }
    }
}

#[test]
fn shares_of_the_joints_add_up_to_the_worst_deviation() {
    let answer = answered(&plate_with(
        "[[ask]]\nkind = \"map\"\n[[ask]]\nkind = \"path\"\ncircle.radius_mm = 100\n",
    ));
    for worst in [
        answer.maps[0].worst.as_ref().unwrap(),
        answer.paths[0].worst.as_ref().unwrap(),
    ] {
        let sum: f64 = worst.joint_share_um.iter().sum();
        // Six numbers of 1e2 um.
        assert!(
            (sum - worst.in_plane_um).abs() < 1e-10,
            "{sum} um of {} um",
            worst.in_plane_um
        );
    }
}

#[test]
fn the_best_posture_is_inside_limits_and_never_worse_than_a_named_one_that_is() {
    let ask = |branch: &str| {
        format!("[[ask]]\nkind = \"map\"\nname = \"{branch}\"\nposture.branch = \"{branch}\"\n")
    };
    let study = plate_with(&["best", "front elbow-up", "front elbow-down"].map(ask).concat());
    let found = found(&study);
    let maps: Vec<_> = found
        .iter()
        .map(|found| {
            if let Found::Map(_, map) = &found.found {
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
            if let Ok(held) = named.answers.points[index]
                .as_ref()
                .map(|held| *held)
                .map_err(|_| ())
            {
                assert!(
                    !held.within_limits() || best.in_plane <= held.in_plane + SAME,
                    "point {index}"
                );
            }
        }
    }
}

#[test]
fn a_load_in_part_axes_is_the_same_load_in_base_axes() {
    // A horizontal plate: x_part = -y, y_part = x, z_part = up.
    let ask = |name: &str, load: &str| {
        format!("[[ask]]\nkind = \"map\"\nname = \"{name}\"\nplane.tilt_deg = 90\nload = {load}\n")
    };
    let answer = answered(&plate_with(&format!(
        "{}{}",
        ask(
            "part",
            "{ frame = \"part\", cases_n = [[3, 5, 7]], moments_n_m = [[0, 1, 2]] }"
        ),
        ask("base", "{ cases_n = [[5, -3, 7]], moments_n_m = [[1, 0, 2]] }")
    )));
    assert_eq!(answer.maps[0].setting.cases_n, [[5.0, -3.0, 7.0]]);
    for (a, b) in answer.maps[0]
        .grid
        .full_um
        .iter()
        .zip(&answer.maps[1].grid.full_um)
    {
        // Told to 1e-4 um.
        assert!((a.unwrap() - b.unwrap()).abs() < 1.1e-4, "{a:?} um and {b:?} um");
    }
}

#[test]
fn heights_of_the_controller_frame_count_450_mm_higher() {
    let asks = "[[ask]]\nkind = \"map\"\nname = \"floor\"\n\
                [[ask]]\nkind = \"map\"\nname = \"controller\"\nbase = \"controller\"\nplane.centre_mm = [900, 0, 350]\n";
    let answer = answered(&plate_with(asks));
    for (a, b) in answer.maps[0]
        .grid
        .in_plane_um
        .iter()
        .flatten()
        .zip(answer.maps[1].grid.in_plane_um.iter().flatten())
    {
        // Told to 1e-4 um.
        assert!((a - b).abs() < 1.1e-4, "{a} um and {b} um");
    }
    assert_eq!(answer.maps[1].setting.centre_mm, [900.0, 0.0, 350.0]);
}

#[test]
fn a_statement_is_consistent_where_the_largest_deviation_is_within_its_bound() {
    let most = answered(&plate_with("")).maps[0].max_in_plane_um.unwrap();
    for (bound, consistent) in [(most * (1.0 - 1e-9), false), (most * (1.0 + 1e-9), true)] {
        let statement = format!(
            "[[ask]]\nkind = \"map\"\nname = \"m\"\n[[ask]]\nkind = \"map\"\nname = \"far\"\nplane.centre_mm = [9000, 0, 800]\n\
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
fn a_study_without_asks_maps_its_plane() {
    let answer = answered(&plate_with(""));
    assert_eq!((answer.maps.len(), answer.maps[0].name.as_str()), (1, "map"));
    let statement = "[[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = 5\nof = [\"map\"]\n";
    assert_eq!(answered(&plate_with(statement)).statements[0].readings.len(), 1);
}

#[test]
fn assumed_compliances_and_their_source_are_told() {
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
fn points_are_counted_before_they_are_asked() {
    let study = plate_with(
        "[[ask]]\nkind = \"map\"\n[[ask]]\nkind = \"sections\"\ntilts_deg = [0, 30]\n\
         [[ask]]\nkind = \"volume\"\nbox = { half_size_mm = [50, 50, 50], step_mm = 50 }\n",
    );
    assert_eq!(point_count(&study), 81 + 2 * 81 + 27);
    let told = std::sync::atomic::AtomicUsize::new(0);
    let finished = |points: usize| {
        told.fetch_add(points, std::sync::atomic::Ordering::Relaxed);
    };
    run(
        &study,
        Watch {
            finished: &finished,
            cancel: &AtomicBool::new(false),
        },
    )
    .unwrap();
    assert_eq!(
        told.into_inner(),
        point_count(&study),
        "progress does not end at its end"
    );
}

#[test]
fn a_cancelled_study_says_so_and_has_no_answer() {
    let watch = Watch {
        finished: &|_| (),
        cancel: &AtomicBool::new(true),
    };
    let error = run(&plate_with(""), watch).unwrap_err();
    assert!(matches!(error, StudyError::Cancelled(_)), "{error}");
    assert_eq!(error.kind(), ErrorKind::Cancelled);
}

#[test]
fn the_same_study_gives_the_same_files() {
    let study = plate_with(
        "[[ask]]\nkind = \"map\"\n[[ask]]\nkind = \"path\"\ncircle.radius_mm = 100\nstep_mm = 30\n",
    );
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    for folder in &folders {
        let found = found(&study);
        write(
            &study,
            &found,
            &answer(&study, &found),
            (folder.path(), Wanted::TABLES),
            &|_| (),
        )
        .unwrap();
    }
    let mut names: Vec<_> = std::fs::read_dir(folders[0].path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    // Three tables an ask, the answer, the list of files.
    assert_eq!(names.len(), 2 * 3 + 2, "{names:?}");
    for name in names {
        let [a, b] = [0, 1].map(|i: usize| std::fs::read(folders[i].path().join(&name)).unwrap());
        assert!(a == b, "{}", name.display());
    }
}

#[test]
fn every_example_study_reads() {
    for example in library::STUDIES {
        let read = read(example.path, Path::new(example.name), example.text.as_bytes());
        assert!(read.is_ok(), "{}", read.unwrap_err());
    }
}

#[test]
fn an_ask_that_names_a_branch_keeps_the_home_of_the_study() {
    let home = "posture = { branch = \"front elbow-up\", home_deg = [1, 2, 3, 4, 5, 6] }\n";
    let study = plate_with(&format!(
        "{home}[[ask]]\nkind = \"map\"\nposture.branch = \"front elbow-down\"\n"
    ));
    let setting = study.settings().next().unwrap();
    assert_eq!(setting.branch(), "front elbow-down");
    let home: Vec<f64> = setting.home.clone().unwrap();
    assert!((home[5].to_degrees() - 6.0).abs() < 1e-12);
}

#[test]
fn a_path_is_followed_in_one_branch_which_the_answer_names() {
    let ask = "[[ask]]\nkind = \"path\"\nname = \"c\"\ncircle.radius_mm = 100\nposture.branch = \"best\"\n";
    let answer = answered(&plate_with(ask));
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

#[test]
fn a_box_alone_is_told_in_the_sentence_and_what_is_out_of_reach_in_warnings() {
    let of_box =
        "[[ask]]\nkind = \"volume\"\nname = \"v\"\nbox = { half_size_mm = [50, 50, 50], step_mm = 50 }\n";
    let answer = answered(&plate_with(of_box));
    assert!(
        answer.answer.starts_with("v, branch ") && answer.answer.contains("% of the box"),
        "{}",
        answer.answer
    );
    let far = "plane = { centre_mm = [9000, 0, 800] }\n";
    let path = "[[ask]]\nkind = \"path\"\nname = \"c\"\ncircle.radius_mm = 100\n";
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
fn sources_of_loads_and_of_what_the_tool_holds_stand_in_the_answer() {
    let tool = "tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0], mass = [{ at = \"tool\", mass_kg = 5, centre_mm = [0, 0, -50], source = \"weighed\" }] }\n";
    let ask = "[[ask]]\nkind = \"map\"\nload = { cases_n = [[1, 2, 3]], source = \"a dynamometer\" }\n";
    let answer = answered(&plate_with(&format!("{tool}{ask}")));
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

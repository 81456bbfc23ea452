//! The results for a study that is being edited are those of the complete run.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;

use armill_core::watch::Watch;
use armill_formats::file::Writer;
use armill_study::answer::answer;
use armill_study::file_names;
use armill_study::live::{
    ChangedValue, Follow, PoseRequest, PoseTarget, PostureQuestion, StudyText, ViewQuestion, answer_json,
    changed, outline, pictures, postures, scene, spin_map, spin_search, table_csv, values, view,
};
use armill_study::output::{self, OutputOptions, StudyResults};
use armill_study::run::run;
use armill_study::studies::{self, FoundStudy};
use serde_json::{Value, json};

fn example(name: &str) -> FoundStudy {
    studies::find(Path::new(name)).unwrap()
}

fn text(found: &FoundStudy) -> StudyText<'_> {
    StudyText {
        shown: &found.shown,
        folder: &found.folder,
        bytes: &found.bytes,
    }
}

#[test]
fn answer_table_and_pictures_are_the_files_of_a_run() {
    let found = example("mh12-groove");
    let study = found.read().unwrap();
    let done = run(&study, Watch::NONE).unwrap();
    let whole = answer(&study, &done);
    let folder = tempfile::tempdir().unwrap();
    let out = Writer::new("run", false).folder(folder.path()).unwrap();
    let results = StudyResults {
        study: &study,
        done: &done,
        answer: &whole,
    };
    output::write(results, &out, OutputOptions::USUAL, &|_| ()).unwrap();
    let file = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();

    let given = answer_json(text(&found), None, Watch::NONE).unwrap();
    let given = given.trim_end().strip_suffix('}').unwrap();
    assert!(file("result.json").starts_with(&format!("{given},\"files\":{{")));
    let drawn = pictures(text(&found), None, Watch::NONE).unwrap().pictures;
    assert!(!drawn.is_empty());
    for picture in &drawn {
        assert_eq!(picture.svg, file(&format!("{}.svg", picture.name)));
    }
    let map = study.analyses.iter().find(|analysis| {
        folder
            .path()
            .join(format!("{}.csv", file_names::slug(&analysis.name)))
            .is_file()
    });
    let name = &map.unwrap().name;
    let csv = table_csv(text(&found), Some(name), Watch::NONE).unwrap();
    assert_eq!(
        String::from_utf8(csv).unwrap(),
        file(&format!("{}.csv", file_names::slug(name)))
    );
}

#[test]
fn one_analysis_alone_gives_the_same_result_as_among_the_others() {
    let found = example("mh12-groove");
    let whole: Value = serde_json::from_str(&answer_json(text(&found), None, Watch::NONE).unwrap()).unwrap();
    for kind in ["maps", "paths", "volumes", "holes"] {
        for of_analysis in whole[kind].as_array().unwrap() {
            let name = of_analysis["name"].as_str().unwrap();
            // A section is not an analysis.
            let analysis = name
                .split(": x = ")
                .next()
                .and_then(|name| name.split(": tilt").next())
                .unwrap();
            let alone = answer_json(text(&found), Some(analysis), Watch::NONE).unwrap();
            let alone: Value = serde_json::from_str(&alone).unwrap();
            assert!(alone[kind].as_array().unwrap().contains(of_analysis), "{name}");
        }
    }
    let error = answer_json(text(&found), Some("nothing"), Watch::NONE).unwrap_err();
    assert!(
        error.to_string().contains("no analysis is called `nothing`"),
        "{error}"
    );
}

const BROKEN: &str = "format = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = 100\nload = { cases_n = [[3, 5, 5]] }\nplane = { centre_mm = [1000, 0, 800], half_size_mm = 100, step_mm = 50 }\n[[analysis]]\nkind = \"map\"\nname = \"good\"\n[[analysis]]\nkind = \"map\"\nname = \"bad\"\nplane = { step_mm = -1 }\n";

fn of(bytes: &str) -> StudyText<'_> {
    StudyText {
        shown: "study.toml",
        folder: Path::new("."),
        bytes: bytes.as_bytes(),
    }
}

#[test]
fn an_invalid_analysis_is_reported_and_leaves_the_others_alone() {
    let given = outline(of(BROKEN));
    let names: Vec<&str> = given
        .analyses
        .iter()
        .map(|analysis| analysis.name.as_str())
        .collect();
    assert_eq!(names, ["good", "bad"]);
    assert_eq!(given.analyses[1].keys, ["kind", "name", "plane.step_mm"]);
    assert_eq!((given.problems.len(), given.problems[0].line()), (1, 12));
    assert!(answer_json(of(BROKEN), Some("good"), Watch::NONE).is_ok());
    assert!(answer_json(of(BROKEN), Some("bad"), Watch::NONE).is_err());
    assert!(answer_json(of(BROKEN), None, Watch::NONE).is_err());

    let no_toml = outline(of("robot = = 3\n"));
    assert_eq!((no_toml.problems[0].line(), no_toml.analyses.len()), (1, 0));
}

#[test]
fn a_change_in_an_analysis_corrects_it_and_comments_stay() {
    let commented = BROKEN.replace("tolerance_um = 100", "tolerance_um = 100 # of the drawing");
    let change = ChangedValue {
        key: "plane.step_mm".to_owned(),
        value: json!(25),
        whole: false,
    };
    let given = changed(of(&commented), Some("bad"), &[change]).unwrap();
    assert_eq!(given.text, commented.replace("step_mm = -1", "step_mm = 25"));
    assert!(given.problems.is_empty());
}

#[test]
fn analyses_and_lists_in_them_are_added_and_removed_with_comments_kept() {
    let text = "format = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = 100\nload = { cases_n = [[3, 5, 5]] }\nplane = { centre_mm = [1000, 0, 800], half_size_mm = 100, step_mm = 50 }\n\n# the analyses\n\n# the plate\n[[analysis]]\nkind = \"map\" # all of it\n# a remark\n";
    let with = |text: &str, key: &str, value: Value| {
        let change = ChangedValue {
            key: key.to_owned(),
            value,
            whole: true,
        };
        changed(of(text), None, &[change]).unwrap()
    };
    let more = with(text, "analysis[1]", json!({"kind": "path"}));
    assert_eq!(more.text, format!("{text}\n[[analysis]]\nkind = \"path\"\n"));
    // Missing fields of a path are reported at their positions.
    assert_eq!(
        (more.analyses.len(), more.problems[0].line()),
        (2, 14),
        "{:?}",
        more.problems
    );
    let round = with(&more.text, "analysis[1].circle.radius_mm", json!(50));
    assert!(round.problems.is_empty(), "{:?}", round.problems);
    assert!(answer_json(of(&round.text), Some(&round.analyses[1].name), Watch::NONE).is_ok());
    let spring = with(
        &round.text,
        "analysis[1].tool.spring[0]",
        json!({"at": "tool", "source": ""}),
    );
    assert!(
        spring.text.ends_with(
            "circle = { radius_mm = 50 }\ntool = { spring = [{ at = \"tool\", source = \"\" }] }\n"
        )
    );
    assert!(!spring.problems.is_empty());
    let back = with(&spring.text, "analysis[1].tool.spring[0]", Value::Null);
    assert_eq!(back.text, round.text);
    assert_eq!(with(&back.text, "analysis[1]", Value::Null).text, text);
    // The first is removed with its comments; a study without analyses means a map.
    let none = with(text, "analysis[0]", Value::Null);
    assert!(none.text.contains("# the analyses") && !none.text.contains("# the plate"));
    assert!(none.problems.is_empty() && none.analyses.len() == 1);
}

#[test]
fn the_values_of_an_analysis_are_its_own_or_those_of_the_study() {
    let study = BROKEN.replace("step_mm = -1", "tilt_deg = 30");
    let given = values(of(&study), Some("bad")).unwrap();
    assert_eq!(
        (given.tilt_deg, given.step_mm, given.tolerance_um),
        (Some(30.0), 50.0, 100.0)
    );
    assert_eq!(
        (given.kind, given.branch.as_str(), given.branches.len()),
        ("map", "nominal", 8)
    );
    let [a, _, c, _] = given.plane_corners_mm;
    let middle: Vec<f64> = (0..3).map(|k| 0.5 * (a[k] + c[k])).collect();
    for (k, centre) in [1000.0, 0.0, 800.0].into_iter().enumerate() {
        assert!((middle[k] - centre).abs() < 1e-9);
    }
}

#[test]
fn a_posture_in_the_plane_has_the_deviation_of_the_map() {
    let found = example("mh12-groove");
    let map = found.read().unwrap().analyses.iter().find_map(|analysis| {
        matches!(analysis.subject, armill_study::analysis::Subject::Map(_)).then(|| analysis.name.clone())
    });
    let map = map.unwrap();
    let whole: Value =
        serde_json::from_str(&answer_json(text(&found), Some(&map), Watch::NONE).unwrap()).unwrap();
    let worst = &whole["maps"][0]["worst"];
    let at = PoseTarget {
        y_mm: worst["in_plane_mm"][0].as_f64(),
        z_mm: worst["in_plane_mm"][1].as_f64(),
        ..PoseTarget::default()
    };
    let case = worst["worst_case"].as_u64().unwrap() as usize;
    let question = PostureQuestion {
        analysis: Some(&map),
        at,
        case,
    };
    let given = postures(text(&found), &question, Watch::NONE).unwrap();
    let evaluation = given
        .answer
        .postures
        .iter()
        .position(|posture| posture.branch == worst["branch"])
        .unwrap();
    let here = given.in_plane[evaluation][case - 1].as_ref().unwrap();
    assert!((here.in_plane_um - worst["in_plane_um"].as_f64().unwrap()).abs() < 1e-6);
    // So do its uncertainty, its shares and what may act.
    let number = |key: &str| worst[key].as_f64().unwrap();
    assert!((here.in_plane_u_um.unwrap() - number("in_plane_u_um")).abs() < 1e-6);
    let shares = &here.share_um;
    for (k, share) in shares.iter().enumerate() {
        assert!((share - worst["joint_share_um"][k].as_f64().unwrap()).abs() < 1e-6);
    }
    assert!((shares.iter().sum::<f64>() - here.in_plane_um).abs() < 1e-6);
    for (given, key) in [
        (here.permissible_along_load_n, "permissible_along_load_n"),
        (here.permissible_any_direction_n, "permissible_any_direction_n"),
    ] {
        assert!((given.unwrap() / number(key) - 1.0).abs() < 1e-9, "{key}");
    }
    // The drawing ends where the tool is.
    let tcp = given.drawings[evaluation].tool_mm;
    assert_eq!(given.drawings[evaluation].links_mm.last(), Some(&tcp));
    for (drawn, limits) in given.drawings[evaluation].joints.iter().zip(&given.limits) {
        assert_eq!(drawn.name, limits.name);
    }
}

const CIRCLE: &str = "format = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = 100\nload = { cases_n = [[3, 5, 5], [-40, 0, 20]] }\ntool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }\nplane = { centre_mm = [1000, 50, 800], tilt_deg = 20, half_size_mm = [100, 60], step_mm = 20 }\n[[analysis]]\nkind = \"path\"\nname = \"rim\"\ncircle = { radius_mm = 50 }\n[[analysis]]\nkind = \"volume\"\nname = \"box\"\nbox = { half_size_mm = [100, 50, 50], step_mm = 50 }\n[[analysis]]\nkind = \"sections\"\nname = \"far\"\ndistances_mm = [900, 1000]\n";

#[test]
fn points_of_a_path_are_on_its_plate_and_deviate_as_in_its_table() {
    let given = scene(of(CIRCLE), Some("rim"), Watch::NONE).unwrap();
    let points = given.points.unwrap();
    assert_eq!(points.xyz_mm.len(), 360);
    let dot = |a: [f64; 3], b: [f64; 3]| -> f64 { (0..3).map(|k| a[k] * b[k]).sum() };
    let plate = &given.plate;
    for (index, at) in points.xyz_mm.iter().enumerate() {
        let from_centre = std::array::from_fn(|k| at[k] - plate.centre_mm[k]);
        assert!(dot(from_centre, plate.normal_axis).abs() < 1e-5);
        assert!((dot(from_centre, from_centre).sqrt() - 50.0).abs() < 1e-5);
        let by = points.deviation_um[index].unwrap();
        let normal = dot(by, plate.normal_axis);
        let across = (dot(by, by) - normal * normal).sqrt();
        let given = points.columns["in_plane_um"][index].as_f64().unwrap();
        assert!((across - given).abs() < 0.01, "{index}: {across} {given}");
    }
    assert!(points.columns["branch"][0].is_string());
    // The posture at a point of the path is the one of its table.
    let question = PostureQuestion {
        analysis: Some("rim"),
        at: PoseTarget {
            point: Some(7),
            ..PoseTarget::default()
        },
        case: 1,
    };
    let there = postures(of(CIRCLE), &question, Watch::NONE).unwrap();
    for (k, mm) in points.xyz_mm[7].iter().enumerate() {
        assert!((there.drawings[0].tool_mm[k] - mm).abs() < 1e-5);
    }
    let evaluation = there
        .answer
        .postures
        .iter()
        .position(|posture| points.columns["branch"][7] == posture.branch);
    let most = there.in_plane[evaluation.unwrap()]
        .iter()
        .flatten()
        .map(|case| case.in_plane_um)
        .fold(0.0, f64::max);
    assert!((most - points.columns["in_plane_um"][7].as_f64().unwrap()).abs() < 2e-3);
}

/// A study whose path is cut.
const POCKET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/r2000ic-pocket");

/// This analysis, with the arm in this pose.
fn arm_at<'a>(analysis: &'a str, pose: &'a PoseRequest) -> ViewQuestion<'a> {
    ViewQuestion {
        analysis: Some(analysis),
        arm: Some(pose),
        ..ViewQuestion::default()
    }
}

/// The in-plane deviation, its uncertainty and its contributions at the worst point of this analysis, and those of
/// the same posture computed alone.
fn worst_and_pose(text: StudyText<'_>, analysis: &str, part: &str) -> [(f64, f64, Vec<f64>); 2] {
    let pose = PoseRequest {
        follow: Follow::Worst,
        at: None,
        section: 0,
        case: None,
    };
    let given = view(text, &arm_at(analysis, &pose), Watch::NONE).unwrap();
    let answer = serde_json::to_value(&given.answer).unwrap();
    let point = answer.pointer(part).unwrap();
    let arm = given.arm.unwrap();
    let branches = arm.pose.answer.postures.iter().map(|posture| &posture.branch);
    let evaluation = branches
        .zip(&arm.pose.in_plane)
        .find(|(branch, _)| json!(branch) == point["branch"]);
    let here = evaluation.unwrap().1[arm.case - 1].clone().unwrap();
    let length = here.deviation_um.iter().map(|um| um * um).sum::<f64>().sqrt();
    assert!((length - here.full_um).abs() < 1e-6 * length);
    // One posture has one deviation, in every part of the result.
    for (posture, cases) in arm.pose.answer.postures.iter().zip(&arm.pose.in_plane) {
        let (Some(total), Some(case)) = (posture.deviation_um, &cases[arm.case - 1]) else {
            panic!("a deviation of {}", posture.branch)
        };
        for (a, b) in total.iter().zip(case.deviation_um) {
            assert!(
                (a - b).abs() < 1e-9 * length,
                "{analysis}, {}: {total:?}",
                posture.branch
            );
        }
    }
    // A point to compute alone.
    let question = PostureQuestion {
        analysis: Some(analysis),
        at: arm.at,
        case: arm.case,
    };
    let alone = postures(text, &question, Watch::NONE).unwrap();
    assert_eq!(
        serde_json::to_value(&alone).unwrap(),
        serde_json::to_value(&arm.pose).unwrap(),
        "{analysis}"
    );
    let number = |key: &str| point[key].as_f64().unwrap();
    let shares = point["joint_share_um"].as_array().unwrap();
    let shares = shares.iter().map(|share| share.as_f64().unwrap()).collect();
    [
        (number("in_plane_um"), number("in_plane_u_um"), shares),
        (here.in_plane_um, here.in_plane_u_um.unwrap(), here.share_um),
    ]
}

#[test]
fn the_posture_at_the_worst_point_has_the_deviation_of_the_result_for_cuts_searches_and_holes() {
    let pocket = studies::find(Path::new(POCKET)).unwrap();
    // Turns of a tool in line with the flange would change little.
    let bent = CIRCLE.replace("[0, 0, 150, 0, 0, 0]", "[60, 0, 150, 0, 30, 0]");
    let searched = "posture = { search = { turns_deg = [-60, 60], step_deg = 20 } }\n";
    let holes = format!(
        "{bent}[[analysis]]\nkind = \"holes\"\nname = \"rivets\"\nholes = {{ at_mm = [[0, 0, 0], [40, 20, 0]] }}\n{searched}"
    );
    let turned = bent.replace("name = \"rim\"\n", &format!("name = \"rim\"\n{searched}"));
    let mut found = Vec::new();
    for (text, analysis, part) in [
        (text(&pocket), "pocket", "/paths/0/worst"),
        (of(&bent), "rim", "/paths/0/worst"),
        (of(&turned), "rim", "/paths/0/worst"),
        (of(&bent), "far", "/maps/0/worst"),
        (of(&bent), "box", "/volumes/0/worst"),
        (of(&holes), "rivets", "/holes/0/worst_holes/0/point"),
    ] {
        let [answer, pose] = worst_and_pose(text, analysis, part);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * a.abs().max(1.0);
        assert!(close(answer.0, pose.0), "{analysis}: {} {}", answer.0, pose.0);
        assert!(close(answer.1, pose.1), "{analysis}: {} {}", answer.1, pose.1);
        assert!(
            answer.2.iter().zip(&pose.2).all(|(a, b)| close(*a, *b)),
            "{analysis}"
        );
        found.push(answer.0);
    }
    assert!(found[1] > found[2] + 1.0, "the search finds turns: {found:?}");
}

#[test]
fn deviations_without_load_are_included_in_the_posture_of_the_result() {
    let folder = tempfile::tempdir().unwrap();
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/yaskawa/mh12.toml");
    let robot = std::fs::read_to_string(robot).unwrap().replace(
        "compliance_u_source = \"assumed\"\n",
        "compliance_u_source = \"assumed\"\nbacklash_deg = 0.01\nbacklash_source = \"paper\"\n",
    );
    std::fs::write(folder.path().join("loose.toml"), robot).unwrap();
    let loose = CIRCLE.replace("yaskawa/mh12", "loose.toml");
    let text = StudyText {
        folder: folder.path(),
        ..of(&loose)
    };
    for (analysis, part) in [
        ("rim", "/paths/0/worst"),
        ("far", "/maps/0/worst"),
        ("box", "/volumes/0/worst"),
    ] {
        let [answer, pose] = worst_and_pose(text, analysis, part);
        assert!(
            (answer.0 - pose.0).abs() < 1e-3,
            "{analysis}: {} {}",
            answer.0,
            pose.0
        );
        assert!(
            (answer.1 - pose.1).abs() < 1e-3,
            "{analysis}: {} {}",
            answer.1,
            pose.1
        );
        let [without, _] = worst_and_pose(of(CIRCLE), analysis, part);
        assert!(
            answer.0 > without.0 + 1.0,
            "{analysis}: {} {}",
            answer.0,
            without.0
        );
    }
}

#[test]
fn the_arm_of_a_view_has_the_posture_of_the_result() {
    let holes = "[[analysis]]\nkind = \"holes\"\nname = \"rivets\"\nholes = { at_mm = [[0, 0, 0], [40, 20, 0]] }\nposture = { search = { turns_deg = [0, 0] } }\n";
    let study = format!("{CIRCLE}{holes}");
    let shown = |analysis: &str, follow: Follow, section: usize| {
        let pose = PoseRequest {
            follow,
            at: None,
            section,
            case: None,
        };
        view(of(&study), &arm_at(analysis, &pose), Watch::NONE).unwrap()
    };
    for (analysis, follow, section, part) in [
        ("far", Follow::Worst, 1, "/maps/1/worst"),
        ("far", Follow::Best, 0, "/maps/0/best"),
        ("rim", Follow::Worst, 0, "/paths/0/worst"),
        ("box", Follow::Best, 0, "/volumes/0/best"),
        ("rivets", Follow::Worst, 0, "/holes/0/worst_holes/0/point"),
    ] {
        let given = shown(analysis, follow, section);
        let answer = serde_json::to_value(&given.answer).unwrap();
        let point = answer.pointer(part).unwrap();
        let arm = given.arm.unwrap();
        assert_eq!(json!(arm.case), point["worst_case"], "{analysis}");
        // Whose posture is that, and does it deviate as the answer says there?
        let near = arm.pose.answer.postures.iter().zip(&arm.pose.in_plane);
        let most = |cases: &[Option<armill_study::live::CaseAnswer>]| {
            let given = cases.iter().flatten().map(|case| case.in_plane_um);
            given.fold(0.0, f64::max)
        };
        let off = near
            .filter(|(posture, _)| json!(posture.branch) == point["branch"])
            .map(|(_, cases)| (most(cases) - point["in_plane_um"].as_f64().unwrap()).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(off < 2e-3, "{analysis}: {off}");
        // A point to compute alone.
        let question = PostureQuestion {
            analysis: Some(analysis),
            at: arm.at,
            case: arm.case,
        };
        let alone = postures(of(&study), &question, Watch::NONE).unwrap();
        assert_eq!(
            serde_json::to_value(&alone).unwrap(),
            serde_json::to_value(&arm.pose).unwrap()
        );
    }
    // A path has no best point, and none of its points has this number.
    assert!(shown("rim", Follow::Best, 0).arm.is_none());
    let gone = PoseRequest {
        follow: Follow::Place,
        at: Some(PoseTarget {
            point: Some(360),
            ..PoseTarget::default()
        }),
        section: 0,
        case: None,
    };
    let given = view(of(CIRCLE), &arm_at("rim", &gone), Watch::NONE).unwrap();
    assert!(given.arm.is_none() && given.extremes[0].worst.is_some());
}

#[test]
fn boxes_and_sections_have_theirs() {
    let given = scene(of(CIRCLE), Some("box"), Watch::NONE).unwrap();
    let counts = given.in_box.unwrap().counts;
    assert_eq!(
        counts.iter().product::<usize>(),
        given.points.unwrap().xyz_mm.len()
    );
    let given = scene(of(CIRCLE), Some("far"), Watch::NONE).unwrap();
    assert_eq!(given.sections.len(), 2);
    assert!((given.sections[0].plate.centre_mm[0] - 900.0).abs() < 1e-9 && given.points.is_none());
}

/// The deviation (um) at a place on the grid of a map, linear along its sides.
fn on_a_side(grid: &armill_study::answer::GridAnswer, [y, z]: [f64; 2]) -> f64 {
    let columns = grid.y_mm.len();
    let value = |column: usize, row: usize| grid.in_plane_um[row * columns + column].unwrap();
    let step = (grid.y_mm[1] - grid.y_mm[0]).abs();
    // The grid points of its side: one, or two a step apart.
    let near = |axis: &[f64], at: f64| {
        let mut near: Vec<usize> = (0..axis.len()).collect();
        near.sort_by(|a, b| (axis[*a] - at).abs().total_cmp(&(axis[*b] - at).abs()));
        ((axis[near[0]] - at).abs() / step, [near[0], near[1]])
    };
    let ((along, columns), (up, rows)) = (near(&grid.y_mm, y), near(&grid.z_mm, z));
    assert!(along.min(up) < 1e-4, "{y} {z} is on no side");
    let mix = |a: f64, b: f64, part: f64| a + (b - a) * part;
    match along < up {
        true => mix(value(columns[0], rows[0]), value(columns[0], rows[1]), up),
        false => mix(value(columns[0], rows[0]), value(columns[1], rows[0]), along),
    }
}

#[test]
fn the_lines_of_a_view_are_where_the_deviation_equals_their_level() {
    let text = CIRCLE.replace("step_mm = 20", "step_mm = 5");
    let asked = ViewQuestion {
        analysis: Some("far"),
        lines: true,
        ..ViewQuestion::default()
    };
    let free = view(of(&text), &asked, Watch::NONE).unwrap();
    let levels = free.levels_um.unwrap();
    assert_eq!(free.lines.len(), 2);
    let spans = free.answer.maps.iter();
    let [mut least, mut largest] = [f64::INFINITY, 0.0_f64];
    for map in spans {
        least = least.min(map.min_in_plane_um.unwrap());
        largest = largest.max(map.max_in_plane_um.unwrap());
    }
    assert!(levels[0] <= least && largest <= levels[levels.len() - 1] && levels.len() > 5);
    // On the scale, but without lines of its own: that of the tolerance is another one.
    let tolerance = levels[levels.len() / 2];
    let text = text.replace("tolerance_um = 100", &format!("tolerance_um = {tolerance}"));
    let fixed = ViewQuestion {
        levels_um: Some(&levels),
        ..asked
    };
    let given = view(of(&text), &fixed, Watch::NONE).unwrap();
    assert_eq!(given.levels_um.as_ref(), Some(&levels));
    let mut drawn = 0;
    for (map, lines) in given.answer.maps.iter().zip(&given.lines) {
        let of_levels = lines.levels.iter().map(|level| (level.level_um, &level.lines_mm));
        for (um, lines) in of_levels.chain([(tolerance, &lines.tolerance_mm)]) {
            for at in lines.iter().flatten() {
                assert!((on_a_side(&map.grid, *at) - um).abs() < 0.02, "{um} {at:?}");
                assert_eq!(at.map(|mm| (mm * 1e3).round() / 1e3), *at, "short numbers");
            }
            drawn += lines.len();
        }
        let mut of_levels = lines.levels.iter();
        assert!(
            of_levels.all(|level| (level.level_um - tolerance).abs() > 1e-6 && !level.lines_mm.is_empty())
        );
    }
    assert!(drawn > 5, "{drawn}");
    // Lines that are not requested: those of the tolerance alone.
    let without = ViewQuestion {
        lines: false,
        ..fixed
    };
    let without = view(of(&text), &without, Watch::NONE).unwrap();
    for (few, all) in without.lines.iter().zip(&given.lines) {
        assert!(few.levels.is_empty());
        assert_eq!(few.tolerance_mm, all.tolerance_mm);
    }
    // Points have colours without lines.
    for analysis in ["rim", "box"] {
        let of_points = ViewQuestion {
            analysis: Some(analysis),
            ..asked
        };
        let given = view(of(CIRCLE), &of_points, Watch::NONE).unwrap();
        assert!(given.levels_um.is_some_and(|levels| levels.len() > 2) && given.lines.is_empty());
    }
    let refused = ViewQuestion {
        levels_um: Some(&[3.0, 2.0]),
        ..asked
    };
    assert!(view(of(CIRCLE), &refused, Watch::NONE).is_err());
}

#[test]
fn refuses_invalid_points_with_a_message() {
    let refused = |at: PoseTarget, analysis: &str| {
        let question = PostureQuestion {
            analysis: Some(analysis),
            at,
            case: 1,
        };
        postures(of(CIRCLE), &question, Watch::NONE)
            .unwrap_err()
            .to_string()
    };
    let far = PoseTarget {
        xyz_mm: Some([1e10, 0.0, 0.0]),
        ..PoseTarget::default()
    };
    assert!(refused(far, "rim").contains("is larger than"));
    let beyond = PoseTarget {
        point: Some(360),
        ..PoseTarget::default()
    };
    assert!(refused(beyond, "rim").contains("point 360 does not exist"));
    let half = PoseTarget {
        y_mm: Some(0.0),
        ..PoseTarget::default()
    };
    assert!(refused(half, "rim").contains("y_mm with z_mm"));
    let section = PoseTarget {
        y_mm: Some(0.0),
        z_mm: Some(0.0),
        section: Some(2),
        ..PoseTarget::default()
    };
    assert!(refused(section, "far").contains("no section 2"));
    let none = PoseTarget {
        joints_deg: Some(vec![0.0; 5]),
        ..PoseTarget::default()
    };
    assert!(refused(none, "rim").contains("5 joint positions"));
}

/// A path that a spindle across the flange follows, so that a spin moves the wrist.
const SPUN_CIRCLE: &str = "format = 1\nrobot = \"yaskawa/mh12\"\ntolerance_um = 100\nload = { cases_n = [[30, 50, 50]], frame = \"feed\" }\nplane = { centre_mm = [700, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }\ntool.flange_from_tool_mm_deg = [100, 0, 150, 0, 90, 0]\n[[analysis]]\nkind = \"path\"\nname = \"c\"\ncircle.radius_mm = 200\n";

#[test]
fn a_row_of_the_spin_map_is_the_answer_with_that_spin() {
    let map = spin_map(of(SPUN_CIRCLE), None, Watch::NONE).unwrap();
    assert_eq!((map.points.len(), map.spins_deg.len()), (360, 73));
    assert_eq!((map.spins_deg[0], map.spins_deg[72]), (-180.0, 180.0));
    let names: Vec<&str> = map.joint_names.iter().map(String::as_str).collect();
    assert_eq!(names, ["S", "L", "U", "R", "B", "T"]);
    // A curve and a constant spin do not change the rows: they are spins of the tool.
    let other = format!("{SPUN_CIRCLE}spin_deg = 20\nspin_curve_mm_deg = [[0, 10], [600, 40]]\n");
    let curved = spin_map(of(&other), None, Watch::NONE).unwrap();
    let settings = values(of(&other), None).unwrap();
    assert_eq!(settings.spin_deg, Some(20.0));
    assert_eq!(settings.spin_curve_mm_deg, Some(vec![[0.0, 10.0], [600.0, 40.0]]));
    let (mut reached, mut blocked) = (0, 0);
    for row in (0..73).step_by(6) {
        let text = format!("{SPUN_CIRCLE}spin_deg = {}\n", map.spins_deg[row]);
        let scene = scene(of(&text), None, Watch::NONE).unwrap().points.unwrap();
        let plain = scene.columns["in_plane_um"].as_array().unwrap();
        for (column, index) in map.points.iter().enumerate() {
            let of_map = map.in_plane_um[row][column];
            // Both have three decimals.
            match (of_map, plain[*index].as_f64()) {
                (Some(a), Some(b)) => assert!((a - b).abs() < 1.1e-3, "{row} {column}: {a} {b}"),
                (a, b) => assert_eq!(a, b),
            }
            let again = curved.in_plane_um[row][column];
            assert!(again.unwrap_or(0.0) - of_map.unwrap_or(0.0) < 1.1e-3);
            let outside = scene.outside_joint_limits.contains(index);
            assert_eq!(map.state[row][column] & 1 == 1, outside, "{row} {column}");
            assert_eq!(map.state[row][column] & 4 == 4, of_map.is_none());
            reached += usize::from(of_map.is_some());
            blocked += usize::from(outside);
        }
    }
    assert!(reached > 0 && blocked > 0, "{reached} {blocked}");
    // Beyond four tolerances the colour is the same.
    let levels = map.levels_um.unwrap();
    assert_eq!((levels[0], *levels.last().unwrap()), (0.0, 400.0));
    assert!(map.state.iter().flatten().any(|state| state & 8 != 0));
}

#[test]
fn the_spins_of_a_search_are_a_curve_for_the_study_with_the_same_deviation() {
    let found = spin_search(of(SPUN_CIRCLE), None, Watch::NONE).unwrap();
    assert_eq!((found.unusable, found.breaks.len()), (0, 0));
    let branch = found.branch.unwrap();
    let curve = serde_json::to_string(&found.curve_mm_deg).unwrap();
    let text = format!("{SPUN_CIRCLE}spin_curve_mm_deg = {curve}\nposture.branch = \"{branch}\"\n");
    let worst = |text: &str| {
        let answer = view(of(text), &ViewQuestion::default(), Watch::NONE)
            .unwrap()
            .answer;
        answer.paths[0].max_in_plane_um.unwrap()
    };
    let searched = found.max_in_plane_um.unwrap();
    assert!(searched < worst(SPUN_CIRCLE), "{searched}");
    // The curve is within a degree of the spins found.
    assert!(
        (worst(&text) / searched - 1.0).abs() < 0.03,
        "{} {searched}",
        worst(&text)
    );
    let error = spin_map(of(BROKEN), Some("good"), Watch::NONE).unwrap_err();
    assert!(error.to_string().contains("`good` is no path"), "{error}");
}

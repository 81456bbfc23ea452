//! Floor, pedestal and obstacles that ride on a rail: clearances by hand and those of the same cell at rest, and problems of their keys.

use super::freedoms::on_rail;
use super::*;
use armill_formats::file::Writer;
use armill_study::analysis::clearance::clearance_mm;
use armill_study::output::{OutputOptions, StudyResults, write};

/// Tool down on a plane 300 mm above the base: the tip of the cutter is on it. The links of this URDF have no shapes.
const TOOL: &str = r#"format = 1
tolerance_um = 1000
tool = { flange_from_tool_mm_deg = [0, 0, 280, 0, 0, 0], body = [
  { name = "spindle", cylinder_mm = { from = [0, 0, 0], to = [0, 0, 200], diameter = 120 } },
  { cuts = true, cylinder_mm = { from = [0, 0, 200], to = [0, 0, 280], diameter = 10 } },
] }
load = { cases_n = [[3, 5, 5]] }
plane = { centre_mm = [900, 0, 300], tilt_deg = 90, half_size_mm = 150, step_mm = 50 }
"#;
const URDF: &str =
    "robot = \"../../validation/urdf-forward/mh12.urdf\"\ncompliance = { class = \"light\" }\n";
const LIBRARY: &str = "robot = \"yaskawa/mh12\"\n";

/// Clearance of every point of the map, mm, and what is nearest.
type Clearances = (Vec<Option<f64>>, Option<[String; 2]>);

fn points(folder: &Path, text: &str) -> Clearances {
    let study = read("study.toml", folder, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    let all = run(&study, Watch::NONE).unwrap();
    let rows = all[0].found.rows();
    let count = rows[0].at_mm.len();
    let all_points = (0..count).map(|index| clearance_mm(rows[0].setting, rows[0].answers, index));
    (all_points.collect(), answer(&study, &all).maps[0].nearest.clone())
}

fn problems(folder: &Path, text: &str) -> String {
    match read("study.toml", folder, text.as_bytes()) {
        Ok(_) => panic!("no problem in {text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn the_floor_is_as_far_as_the_tip_is_above_it() {
    for height_mm in [-400.0, 0.0] {
        let text = format!("{URDF}{TOOL}[floor]\nheight_mm = {height_mm}\n");
        let (all, nearest) = points(Path::new("."), &text);
        assert_eq!(all.len(), 49);
        for clearance in all {
            assert!(
                (clearance.unwrap() - (300.0 - height_mm)).abs() < 1e-3,
                "{clearance:?}"
            );
        }
        assert_eq!(nearest, Some(["cutter", "floor"].map(str::to_owned)));
    }
}

#[test]
fn a_floor_above_the_base_is_refused() {
    let message = problems(Path::new("."), &format!("{URDF}{TOOL}[floor]\nheight_mm = 100\n"));
    for word in [
        "study.toml:",
        "the floor at 100 mm is above the base of the robot, which is at 0 mm",
        "z of the floor in the reference frame",
    ] {
        assert!(message.contains(word), "no `{word}` in {message}");
    }
}

#[test]
fn a_tip_below_the_floor_collides() {
    let text = format!("{URDF}{TOOL}[floor]\nheight_mm = -10\n").replace("0, 300]", "0, -50]");
    let (all, _) = points(Path::new("."), &text);
    assert!(all.iter().all(|clearance| *clearance == Some(0.0)), "{all:?}");
}

#[test]
fn the_floor_does_not_disturb_the_base_of_a_library_robot() {
    let far = format!("{LIBRARY}{TOOL}[floor]\nheight_mm = -3000\n");
    let near = far.replace("-3000", "0");
    let [far, near] = [far, near].map(|text| points(Path::new("."), &text));
    let least = |all: &[Option<f64>]| all.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    assert!((least(&near.0) - least(&far.0).min(300.0)).abs() < 1e-3);
}

/// The same cell with the robot at rest, and on a rail that is 1000 mm away from its zero.
fn on_rail_and_at_rest(bodies: &str) -> [Clearances; 2] {
    let at_rest = format!("{LIBRARY}{TOOL}{}", bodies.replace("on = \"rail\"\n", ""));
    let text = TOOL.replace("[900, 0, 300]", "[900, 1000, 300]");
    let moved =
        format!("robot = \"arm.toml\"\n{text}posture = {{ home_deg = [1000, 0, 0, 0, 0, 0, 0] }}\n{bodies}");
    let folder = on_rail();
    [points(Path::new("."), &at_rest), points(folder.path(), &moved)]
}

#[test]
fn what_rides_on_the_rail_is_as_far_as_the_same_at_rest() {
    let wall = "[[obstacle]]\nname = \"wall\"\non = \"rail\"\nbox_mm = { from = [1050, -300, 200], to = [1100, 300, 2000] }\n";
    let pedestal = "[pedestal]\nbox_mm = { from = [500, -300, -600], to = [740, 300, 250] }\n";
    for bodies in [wall.to_owned(), pedestal.to_owned(), format!("{wall}{pedestal}")] {
        let [at_rest, moved] = on_rail_and_at_rest(&bodies);
        assert_eq!(at_rest.1, moved.1);
        for (a, b) in at_rest.0.iter().zip(&moved.0) {
            assert!((a.unwrap() - b.unwrap()).abs() < 1e-5, "{a:?} {b:?}");
        }
        let name = if bodies.contains("wall") {
            "wall"
        } else {
            "pedestal"
        };
        assert_eq!(at_rest.1.unwrap()[1], name);
    }
    // Without `on` it stands where the arm is not.
    let [_, apart] = on_rail_and_at_rest(&wall.replace("on = \"rail\"\n", ""));
    assert!(apart.1.is_none_or(|names| names[1] != "wall"));
}

#[test]
fn a_number_names_the_joint_as_well() {
    let text = |on: &str| {
        format!(
            "robot = \"arm.toml\"\n{TOOL}[[obstacle]]\nname = \"wall\"\non = \"{on}\"\n\
             box_mm = {{ from = [1050, -300, 200], to = [1100, 300, 2000] }}\n"
        )
    };
    let folder = on_rail();
    let [named, numbered] = ["rail", "1"].map(|on| points(folder.path(), &text(on)));
    assert_eq!(named, numbered);
}

#[test]
fn wrong_joints_and_names_are_reported_at_their_place() {
    let folder = on_rail();
    let on = |robot: &str, keys: &str| {
        format!(
            "robot = \"{robot}\"\n{TOOL}[[obstacle]]\n{keys}\nbox_mm = {{ from = [2000, 0, 0], to = [2001, 1, 1] }}\n"
        )
    };
    let floor = "[floor]\nheight_mm = -100\n";
    for (text, expected) in [
        (
            on("arm.toml", "name = \"a\"\non = \"track\""),
            vec![
                "has no joint `track`",
                "its joints in front of the arm: rail",
                "study.toml:",
            ],
        ),
        (
            on("arm.toml", "name = \"a\"\non = \"S\""),
            vec!["is a joint of the arm itself", "[[tool.body]]"],
        ),
        (
            on("yaskawa/mh12", "name = \"a\"\non = \"1\""),
            vec![
                "joint `1` of robot `yaskawa/mh12` is a joint of the arm itself",
                "this robot has none",
            ],
        ),
        (
            format!("{}{floor}", on("arm.toml", "name = \"floor\"")),
            vec!["an obstacle is called `floor`, as the table [floor]"],
        ),
        (format!("{LIBRARY}{TOOL}[floor]\n"), vec!["height_mm"]),
        (
            format!("{LIBRARY}{TOOL}[pedestal]\n"),
            vec!["`pedestal` has no shape"],
        ),
        (
            format!(
                "{LIBRARY}{TOOL}[pedestal]\nbox_mm = {{ from = [-3000, -3000, -500], to = [3000, 3000, 3000] }}\n"
            ),
            vec![
                "`pedestal` touches",
                "in every posture of the robot",
                "is its position right?",
            ],
        ),
    ] {
        let message = problems(folder.path(), &text);
        for word in expected {
            assert!(message.contains(word), "no `{word}` in {message}");
        }
    }
}

/// A closed tetrahedron in STL with this edge.
fn tetrahedron_stl(edge: f64) -> String {
    let corners = [
        [0.0, 0.0, 0.0],
        [edge, 0.0, 0.0],
        [0.0, edge, 0.0],
        [0.0, 0.0, edge],
    ];
    let mut text = "solid part\n".to_owned();
    for triangle in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in triangle {
            let [x, y, z] = corners[corner];
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid part\n"
}

#[test]
fn a_mesh_in_the_wrong_unit_is_questioned() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("small.stl"), tetrahedron_stl(0.3)).unwrap();
    std::fs::write(folder.path().join("large.stl"), tetrahedron_stl(300_000.0)).unwrap();
    std::fs::write(folder.path().join("part.stl"), tetrahedron_stl(300.0)).unwrap();
    let with = |keys: &str| format!("{LIBRARY}{TOOL}[part]\n{keys}\n");
    for (keys, expected) in [
        ("mesh = \"small.stl\"", "the unit of `small.stl` is not known"),
        (
            "mesh = \"small.stl\"\nmesh_unit = \"mm\"",
            "the longest side of `small.stl` is 0.3 mm: sizes from 1 mm to 100000 mm are expected",
        ),
        (
            "mesh = \"large.stl\"",
            "the longest side of `large.stl` is 300000 mm",
        ),
        (
            "mesh = \"part.stl\"\nmesh_unit = \"m\"",
            "the longest side of `part.stl` is 300000 mm",
        ),
    ] {
        let message = problems(folder.path(), &with(keys));
        for word in [expected, "mesh_unit", "study.toml:"] {
            assert!(message.contains(word), "no `{word}` in {message}");
        }
    }
    // The part of 300 mm is fine, without a stock.
    let (all, _) = points(folder.path(), &with("mesh = \"part.stl\""));
    assert!(all.iter().flatten().any(|clearance| *clearance > 0.0));
}

#[test]
fn a_demanded_clearance_that_no_body_can_keep_is_a_problem() {
    let bare = TOOL.replace("280, 0, 0, 0], body = [", "280, 0, 0, 0] }\n#");
    let bare: String = bare
        .lines()
        .filter(|line| !line.starts_with("  {") && !line.starts_with("] }"))
        .map(|line| format!("{line}\n"))
        .collect();
    let message = problems(Path::new("."), &format!("least_clearance_mm = 10\n{URDF}{bare}"));
    for word in [
        "`least_clearance_mm = 10`, but neither the tool nor a link",
        "[[tool.body]]",
        "study.toml:1:",
    ] {
        assert!(message.contains(word), "no `{word}` in {message}");
    }
    // The links of a library robot keep it from each other.
    points(
        Path::new("."),
        &format!("least_clearance_mm = 10\n{LIBRARY}{bare}"),
    );
}

#[test]
fn the_picture_and_the_report_name_the_nearest_bodies() {
    let study = study(&format!("{LIBRARY}{TOOL}[floor]\nheight_mm = -100\n"));
    let all = run(&study, Watch::NONE).unwrap();
    let answer = answer(&study, &all);
    let results = StudyResults {
        study: &study,
        done: &all,
        answer: &answer,
    };
    let pictures = armill_study::output::pictures(results);
    let picture = pictures
        .iter()
        .find(|picture| picture.name == "map-clearance")
        .unwrap();
    let least_mm = answer.maps[0].least_clearance_mm.unwrap();
    let [first, second] = answer.maps[0].nearest.clone().unwrap();
    let label = format!("{least_mm:.1} mm");
    assert!(picture.svg.contains(&label) && picture.svg.contains("nearest points"));
    assert!(
        picture
            .caption
            .contains(&format!("{label} between {first} and {second}")),
        "{}",
        picture.caption
    );
    let folder = tempfile::tempdir().unwrap();
    let out = Writer::new("run", false).folder(folder.path()).unwrap();
    write(results, &out, OutputOptions::USUAL, &|_| ()).unwrap();
    let report = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    let sentence = format!("map: the least clearance is {label}, between {first} and {second}");
    assert!(report.contains(&sentence) && report.contains("Not checked: links next to each other"));
}

/// A ball of triangles in binary STL, mm: `rows` bands from pole to pole, each of `rows` pairs of triangles.
fn ball_stl(radius: f64, rows: u32) -> Vec<u8> {
    let at = |band: u32, turn: u32| {
        let (sin, cos) = (std::f64::consts::PI * f64::from(band) / f64::from(rows)).sin_cos();
        let (along_y, along_x) = (std::f64::consts::TAU * f64::from(turn % rows) / f64::from(rows)).sin_cos();
        [sin * along_x, sin * along_y, cos].map(|part| (radius * part) as f32)
    };
    let mut bytes = vec![0; 80];
    bytes.extend_from_slice(&(2 * rows * rows).to_le_bytes());
    for band in 0..rows {
        for turn in 0..rows {
            let [a, b, c, d] = [
                (band, turn),
                (band + 1, turn),
                (band + 1, turn + 1),
                (band, turn + 1),
            ]
            .map(|(i, j)| at(i, j));
            for triangle in [[a, b, c], [a, c, d]] {
                bytes.extend_from_slice(&[0; 12]);
                for coordinate in triangle.into_iter().flatten() {
                    bytes.extend_from_slice(&coordinate.to_le_bytes());
                }
                bytes.extend_from_slice(&[0; 2]);
            }
        }
    }
    bytes
}

#[test]
fn a_mesh_of_a_million_triangles_is_as_far_as_its_ball() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ball.stl"), ball_stl(150.0, 708)).unwrap();
    let robot = std::fs::canonicalize("../../validation/urdf-forward/mh12.urdf").unwrap();
    let text = format!(
        "robot = {robot:?}\ncompliance = {{ class = \"light\" }}\n{TOOL}[[obstacle]]\nname = \"ball\"\nmesh = \"ball.stl\"\n\
         base_from_obstacle_mm_deg = [1400, 0, 480, 0, 0, 0]\n"
    )
    .replace("half_size_mm = 150", "half_size_mm = 1");
    let (all, nearest) = points(folder.path(), &text);
    assert_eq!(nearest, Some(["spindle", "ball"].map(str::to_owned)));
    // From the axis of the spindle at x = 899 to 901 mm: 60 mm of its radius, 150 mm of the ball, whose facets are 1.5 um inside.
    for clearance in all {
        let clearance = clearance.unwrap();
        assert!((clearance - 290.0).abs() < 1.01, "{clearance}");
    }
}

//! The cell: clearances by hand, postures that keep them, problems of bodies.

use armill_formats::table::ColumnData;
use armill_study::analysis::columns;

use super::*;

/// Tool down above a plate: a spindle of 120 mm diameter whose end is 80 mm above the tip, and a wall that begins at x = 1050 mm. The links of
/// this URDF have no shapes.
const CELL: &str = r#"format = 1
robot = "../../validation/urdf-forward/mh12.urdf"
compliance = { class = "light" }
tolerance_um = 1000
tool = { flange_from_tool_mm_deg = [0, 0, 280, 0, 0, 0], body = [
  { name = "spindle", cylinder_mm = { from = [0, 0, 0], to = [0, 0, 200], diameter = 120 } },
  { cuts = true, cylinder_mm = { from = [0, 0, 200], to = [0, 0, 280], diameter = 10 } },
] }
plane = { centre_mm = [900, 0, 300], tilt_deg = 90, half_size_mm = 150, step_mm = 25 }
load = { cases_n = [[3, 5, 5]] }
[part]
box_mm = { from = [-300, -300, -100], to = [300, 300, 0] }
[[obstacle]]
name = "wall"
box_mm = { from = [1050, -1000, 0], to = [1100, 1000, 2000] }
"#;

/// Clearance of the spindle by hand, mm: to the wall and to the top of the part.
fn by_hand(x_mm: f64) -> f64 {
    (1050.0 - 60.0 - x_mm).clamp(0.0, 80.0)
}

/// The result of this study, which has no problem.
fn done(text: &str) -> StudyAnswer {
    let study = study(text);
    answer(&study, &run(&study, Watch::NONE).unwrap())
}

/// Clearance, state and x of every point of the first analysis, mm.
fn points(text: &str) -> Vec<(Option<f64>, &'static str, f64)> {
    let study = study(text);
    let all = run(&study, Watch::NONE).unwrap();
    let rows = all[0].found.rows();
    let one = |index: usize| {
        let clearance =
            armill_study::analysis::clearance::clearance_mm(rows[0].setting, rows[0].answers, index);
        (clearance, rows[0].state(index), rows[0].at_mm[index][0])
    };
    (0..rows[0].at_mm.len()).map(one).collect()
}

#[test]
fn the_table_names_the_nearest_bodies_of_every_point() {
    let study = study(CELL);
    let all = run(&study, Watch::NONE).unwrap();
    let rows = all[0].found.rows();
    let table = columns::table(&study.robot.robot, "map", &all[0].found, &rows).unwrap();
    let column = table.columns().iter().find(|column| column.name == "nearest");
    let ColumnData::Category { codes, labels } = &column.unwrap().data else {
        panic!("words")
    };
    assert_eq!(codes.len(), 169);
    for (at, code) in rows[0].at_mm.iter().zip(codes) {
        let to_wall = 1050.0 - 60.0 - at[0];
        // Where both are as far either may be named.
        if (to_wall - 80.0).abs() > 1e-6 {
            let expected = if to_wall < 80.0 {
                "spindle and wall"
            } else {
                "spindle and part"
            };
            assert_eq!(labels[*code as usize], expected, "{at:?}");
        }
    }
}

#[test]
fn the_clearance_of_every_point_of_a_map_is_that_by_hand() {
    for least_mm in [0.0, 10.0, 60.0] {
        let text = format!("least_clearance_mm = {least_mm}\n{CELL}");
        let all = points(&text);
        let collisions = all.iter().filter(|(_, state, _)| *state == "in_collision");
        let expected = all
            .iter()
            .filter(|(.., x)| by_hand(*x) < least_mm || by_hand(*x) == 0.0);
        assert_eq!(collisions.count(), expected.count());
        for (clearance, _, x) in &all {
            assert!(
                (clearance.unwrap() - by_hand(*x)).abs() < 1e-3,
                "{x}: {clearance:?}"
            );
        }
        let map = &done(&text).maps[0];
        assert_eq!(map.nearest, Some(["spindle", "wall"].map(str::to_owned)));
        assert_eq!(map.least_clearance_mm, Some(0.0));
        let counts = &map.counts;
        assert_eq!(counts.total(), 169);
        assert_eq!(counts.in_collision + counts.within + counts.above_tolerance, 169);
    }
}

#[test]
fn links_of_the_library_are_in_the_way_as_well() {
    // A post next to the forearm, far from the tool.
    let post = "[[obstacle]]\nname = \"post\"\ncylinder_mm = { from = [400, 330, 0], to = [400, 330, 1500], diameter = 50 }\n";
    let text = format!("{CELL}{post}").replace("../../validation/urdf-forward/mh12.urdf", "yaskawa/mh12");
    let text = text.replace("centre_mm = [900, 0, 300]", "centre_mm = [800, 250, 300]");
    let found = done(&text);
    let map = &found.maps[0];
    let [first, second] = map.nearest.clone().unwrap();
    assert!(first.starts_with("link") && second == "post", "{first} {second}");
    let coarse = |warning: &&String| warning.contains("not checked against the wrist of Yaskawa MH12");
    assert_eq!(
        found.warnings.iter().filter(coarse).count(),
        1,
        "{:?}",
        found.warnings
    );
}

#[test]
fn a_study_without_bodies_has_no_clearance() {
    let text = PLATE.replace("tolerance_um", "# tolerance_um");
    let map = &done(&format!("tolerance_um = 60\n{text}")).maps[0];
    assert_eq!((map.least_clearance_mm, map.counts.in_collision), (None, 0));
}

/// A spindle with a motor at its side, which a turn of the tool brings away from the wall.
fn with_motor(search: &str) -> String {
    let motor = r#"  { name = "motor", box_mm = { from = [60, -60, 0], to = [220, 60, 150] } },"#;
    let text = CELL.replace("body = [", &format!("body = [\n{motor}"));
    format!(
        "least_clearance_mm = 15\n{text}\n[[analysis]]\nkind = \"path\"\nname = \"edge\"\n{search}\
         line = {{ from_mm = [-60, -100], to_mm = [-60, 100] }}\nstep_mm = 10\n"
    )
}

#[test]
fn a_search_turns_the_tool_away_from_what_is_in_the_way() {
    // y' = -x of the part: the line is at x = 960 mm. With the motor at the wall nearly no point is possible; other spins are.
    let searched = "posture = { search = { step_deg = 15 } }\n";
    let [fixed, turned] = ["spin_deg = 180\n", searched].map(|keys| done(&with_motor(keys)));
    let [fixed, turned] = [&fixed.paths[0], &turned.paths[0]];
    assert!(fixed.in_collision > 15 && turned.in_collision < 5);
    for (clearance, state, _) in points(&with_motor(searched)) {
        assert!(
            state == "in_collision" || clearance.unwrap() >= 15.0 - 1e-6,
            "{clearance:?}"
        );
    }
}

/// The problems of this text.
fn problems(text: &str) -> String {
    match read("study.toml", Path::new("."), text.as_bytes()) {
        Ok(_) => panic!("no problem in {text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_wrong_body_is_reported_at_its_place() {
    let wall = "box_mm = { from = [1050, -1000, 0], to = [1100, 1000, 2000] }";
    for (new, expected) in [
        ("", "`obstacle[0]` has no shape"),
        (
            "mesh = \"a.stl\"\nbox_mm = { from = [0, 0, 0], to = [1, 1, 1] }",
            "has 2 shapes: box_mm, mesh",
        ),
        ("mesh = \"none.stl\"", "cannot read `./none.stl`"),
        ("box_mm = { from = [0, 0, 0], to = [0, 1, 1] }", "has no volume"),
        (
            "cylinder_mm = { from = [1, 2, 3], to = [1, 2, 3], diameter = 4 }",
            "ends of the cylinder are both at",
        ),
        ("box_mm = { from = [0, 0, 0] }", "to"),
        (
            "mesh_unit = \"m\"\nbox_mm = { from = [2000, 0, 0], to = [2001, 1, 1] }",
            "`mesh_unit` without a mesh",
        ),
        (
            "box_mm = { from = [-5000, -5000, -1000], to = [5000, 5000, 5000] }",
            "in every posture of the robot",
        ),
    ] {
        let message = problems(&CELL.replace(wall, new));
        assert!(message.contains(expected), "{new}: {message}");
        assert!(message.contains("study.toml:"), "{message}");
    }
    let twice = format!("{CELL}[[obstacle]]\nname = \"wall\"\n{wall}\n");
    assert!(problems(&twice).contains("two obstacles are called `wall`"));
}

/// A cube of triangles in STL, from the origin to this edge.
fn cube_stl(edge: f64, faces: usize) -> String {
    let corner = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { edge } else { 0.0 });
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut text = "solid cube\n".to_owned();
    for [a, b, c, d] in &quads[..faces] {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for bits in triangle {
                let [x, y, z] = corner(*bits);
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid cube\n"
}

#[test]
fn meshes_are_as_far_as_boxes_and_their_unit_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("cube.stl", &cube_stl(400.0, 6));
    write("metres.stl", &cube_stl(0.4, 6));
    write("open.stl", &cube_stl(400.0, 5));
    let wall = "box_mm = { from = [1050, -1000, 0], to = [1100, 1000, 2000] }";
    let with = |keys: &str| {
        let place = "base_from_obstacle_mm_deg = [1050, -200, 200, 0, 0, 0]";
        let text = CELL
            .replace(wall, &format!("{keys}\n{place}"))
            .replace("../../validation/urdf-forward/mh12.urdf", "yaskawa/mh12");
        let found = read("study.toml", folder.path(), text.as_bytes());
        found.map(|study| {
            let all = run(&study, Watch::NONE).unwrap();
            answer(&study, &all)
        })
    };
    let boxed = with("box_mm = { from = [0, 0, 0], to = [400, 400, 400] }").unwrap();
    for keys in ["mesh = \"cube.stl\"", "mesh = \"metres.stl\"\nmesh_unit = \"m\""] {
        let meshed = with(keys).unwrap();
        assert_eq!(
            meshed.maps[0].counts.in_collision,
            boxed.maps[0].counts.in_collision
        );
        assert!(meshed.maps[0].counts.in_collision > 0);
    }
    let unknown = with("mesh = \"metres.stl\"").unwrap_err().to_string();
    assert!(
        unknown.contains("the unit of `metres.stl` is not known") && unknown.contains("mesh_unit"),
        "{unknown}"
    );
    let open = with("mesh = \"open.stl\"").unwrap();
    assert!(
        open.warnings
            .iter()
            .any(|warning| warning.contains("open.stl is an open mesh")),
        "{:?}",
        open.warnings
    );
}

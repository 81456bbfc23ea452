//! Bodies of a robot: capsules around the meshes of a URDF, and the picture of the bodies.

use crate::cell::Cell;

/// A lever whose link is a tetrahedron of 400 mm.
const LEVER_URDF: &str = r#"<?xml version="1.0"?>
<robot name="lever"><link name="base"/>
  <link name="arm"><collision><geometry><mesh filename="arm.stl" scale="0.001 0.001 0.001"/></geometry></collision></link>
  <joint name="A" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 0.3" rpy="0 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="0" velocity="1"/></joint>
</robot>
"#;

/// A cell with the lever and its mesh.
fn lever() -> Cell {
    let cell = Cell::new();
    let corners = ["0 0 0", "400 0 0", "0 400 0", "0 0 400"];
    let mut mesh = "solid arm\n".to_owned();
    for triangle in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        mesh += "facet normal 0 0 0\nouter loop\n";
        for corner in triangle {
            mesh += &format!("vertex {}\n", corners[corner]);
        }
        mesh += "endloop\nendfacet\n";
    }
    cell.file("arm.stl", mesh + "endsolid arm\n");
    cell.file("arm.urdf", LEVER_URDF);
    cell
}

#[test]
fn tables_that_are_appended_to_an_imported_robot_are_its_bodies() {
    let cell = lever();
    let imported = cell.armill(&["robots", "import", "arm.urdf"]).fine().out;
    let said = cell
        .armill(&[
            "robots",
            "bodies",
            "arm.urdf",
            "--capsules",
            "1",
            "--out",
            "bodies.toml",
        ])
        .fine();
    assert!(
        said.err.contains("1 capsules, no farther than") && said.err.contains("created bodies.toml"),
        "{}",
        said.err
    );
    let bodies = std::fs::read_to_string(cell.at("bodies.toml")).unwrap();
    cell.file("arm.toml", imported + &bodies);
    let given = cell.armill(&["robots", "arm.toml", "--json"]).fine().json();
    let printed = cell
        .armill(&["robots", "bodies", "arm.urdf", "--capsules", "1", "--json"])
        .fine()
        .json();
    assert_eq!(given["bodies"], printed["bodies"]);
    assert_eq!(given["bodies"][0]["shape"], "capsule");
    assert_eq!(printed["text"].as_str().map(str::trim), Some(bodies.trim()));
    // A file that is there is not replaced.
    cell.file("bodies.toml", "mine");
    cell.armill(&["robots", "bodies", "arm.urdf", "--out", "bodies.toml"])
        .refused(&["bodies.toml"]);
}

#[test]
fn wrong_numbers_of_capsules_and_robots_without_meshes_are_refused() {
    let cell = lever();
    cell.armill(&["robots", "bodies", "arm.urdf", "--capsules", "0"])
        .refused(&["--capsules", "a number from 1 to 10"]);
    cell.armill(&["robots", "bodies", "yaskawa/mh12"]).refused(&[
        "The shapes of the links of Yaskawa MH12 are not known",
        "collision meshes",
    ]);
}

#[test]
fn the_bodies_of_a_robot_are_drawn() {
    let cell = lever();
    for robot in ["arm.urdf", "yaskawa/mh12"] {
        cell.armill(&["robots", robot, "--drawing", "bodies.svg", "--bodies", "--force"])
            .fine();
        let svg = std::fs::read_to_string(cell.at("bodies.svg")).unwrap();
        assert!(svg.contains("bodies of its links; all joints at zero"), "{robot}");
    }
}

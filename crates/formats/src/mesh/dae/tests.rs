use super::super::report::MeshReport;
use super::*;

/// Two cubes: one scaled and mirrored within a turned node, one of a library of nodes.
const CUBE: &str = include_str!("../../../tests/seeds/cubes.dae");

fn report(text: &str) -> MeshReport {
    read("a.dae", text.as_bytes()).unwrap().report()
}

fn refused(text: &str) -> String {
    read("a.dae", text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn nested_nodes_place_every_kind_of_polygon_and_the_unit_is_given() {
    let mesh = read("a.dae", CUBE.as_bytes()).unwrap();
    let found = mesh.report();
    assert_eq!(mesh.unit.map(MeshUnit::metres), Some(0.0254));
    assert_eq!((found.triangles, mesh.notes.len()), (24, 0));
    // By hand: the first cube has x 0..6, y 1..7, z -6..0 before the quarter turn to x -7..-1, y 0..6, and the shift.
    for (value, expected) in [(found.min, [3.0, 0.0, -6.0]), (found.max, [10.0, 6.0, 102.0])] {
        assert!(
            (0..3).all(|axis| (value[axis] - expected[axis]).abs() < 1e-14),
            "{found:?}"
        );
    }
    assert!((found.volume - (8.0 + 216.0)).abs() < 1e-12, "{found:?}");
    assert!(found.is_closed && found.is_oriented, "{found:?}");
}

#[test]
fn a_fan_has_its_first_corner_in_all_triangles() {
    let fan = CUBE
        .replace("<polygons count=\"1\">", "<trifans count=\"1\">")
        .replace("</polygons>", "</trifans>");
    assert_eq!(report(&fan), report(CUBE));
}

#[test]
fn a_file_without_a_scene_has_its_geometries_where_they_are() {
    let start = CUBE.find(" <library_nodes>").unwrap();
    let mesh = read("a.dae", (CUBE[..start].to_owned() + "</COLLADA>").as_bytes()).unwrap();
    assert_eq!(mesh.bounds(), [[0.0; 3], [2.0; 3]]);
    assert!(mesh.notes[0].contains("no visual scene"), "{:?}", mesh.notes);
    // The scene need not be named.
    let unnamed = CUBE.replace("<scene><instance_visual_scene url=\"#scene\"/></scene>", "");
    assert_eq!(report(&unnamed), report(CUBE));
}

#[test]
fn up_axis_and_left_out_skins_are_noted_and_the_unit_is_a_metre_if_left_out() {
    let text = CUBE
        .replace("<up_axis>Z_UP</up_axis>", "")
        .replace("<unit name=\"inch\" meter=\"0.0254\"/>", "");
    let text = text.replace(
        "<instance_node url",
        "<instance_controller url=\"#skin\"/><instance_node url",
    );
    let mesh = read("a.dae", text.as_bytes()).unwrap();
    assert_eq!(mesh.bounds(), read("a.dae", CUBE.as_bytes()).unwrap().bounds());
    assert_eq!(mesh.unit, Some(MeshUnit::METRE));
    assert_eq!(mesh.notes.len(), 2, "{:?}", mesh.notes);
    assert!(mesh.notes[1].contains("up_axis is Y_UP: it is not applied"));
}

#[test]
fn what_is_wrong_is_reported_at_its_place() {
    for (from, to, expected) in [
        (
            "2 0 2  0 2 2",
            "2 0 2  0 nan 2",
            "a.dae:7:22: NaN is not a finite number",
        ),
        (
            "0 4 6 2</p>",
            "0 4 8 2</p>",
            "a.dae:14:80: no point has the index 8: the source has 8",
        ),
        ("0 4 6 2</p>", "0 4 -6 2</p>", "a.dae:14:87: `-6` is not an index"),
        (
            "0 4 6 2</p>",
            "0 4</p>",
            "a polygon with 2 corners: at least 3 required",
        ),
        (
            "<vcount>4 4",
            "<vcount>4 3",
            "the numbers in <vcount> add up to 7 corners, but <p> has 8",
        ),
        (
            "<vcount>4 4",
            "<vcount>4 18446744073709551615",
            "corners, but <p> has 8",
        ),
        (
            "0 1 5 0 5 4 2",
            "0 1 5 0 5 4",
            "11 corners are not a multiple of 3",
        ),
        ("0 7 0 6</p>", "0 7 0</p>", "15 indices are not 2 for each corner"),
        (
            "count=\"8\"",
            "count=\"9\"",
            "the array has 8 points, fewer than its accessor announces",
        ),
        (
            "stride=\"3\"",
            "stride=\"2\"",
            "an accessor of points has a stride of at least 3",
        ),
        (
            "offset=\"1\"",
            "offset=\"99\"",
            "the offset of an input is a number below 64",
        ),
        (
            "source=\"#points\"",
            "source=\"#dots\"",
            "the source `#dots` with a float_array is missing",
        ),
        (
            "<vertices id=\"vertices\"",
            "<vertices id=\"other\"",
            "`#vertices` has no input with the semantic POSITION",
        ),
        (
            "url=\"#cube\"/></node>\n   <i",
            "url=\"#cone\"/></node>\n   <i",
            "nothing of this file has the id `cone`",
        ),
        (
            "url=\"#scene\"",
            "url=\"#stage\"",
            "nothing of this file has the id `stage`",
        ),
        (
            "url=\"#scene\"",
            "url=\"other.dae\"",
            "does not refer to an element of this file",
        ),
        (
            "<translate>10 0 0",
            "<translate>10 0",
            "<translate> with 2 numbers: 3 required",
        ),
        (
            "<rotate>0 0 2 90</rotate>",
            "<skew>1</skew>",
            "<skew> is not read",
        ),
        ("meter=\"0.0254\"", "meter=\"0\"", "a unit of 0 m is not accepted"),
        (
            "<translate>0 0 100",
            "<translate>0 0 1e9",
            "exceeds the largest coordinate",
        ),
        ("<COLLADA", "<!DOCTYPE a [<!ENTITY b \"c\">]><COLLADA", "not XML"),
    ] {
        assert!(CUBE.contains(from), "{from}");
        let given = refused(&CUBE.replacen(from, to, 1));
        assert!(given.contains(expected), "{expected}\n{given}");
    }
    assert!(refused("<robot/>").contains("<robot> is not a COLLADA file"));
}

#[test]
fn nodes_in_nodes_end_at_a_limit() {
    let loops = CUBE.replace(
        "</translate><instance_geometry",
        "</translate><instance_node url=\"#shared\"/><instance_geometry",
    );
    let given = refused(&loops);
    assert!(
        given.contains("placed in one another over more than 64 levels"),
        "{given}"
    );
    let mut nodes = String::new();
    for id in 1..12 {
        let inner = format!("<instance_node url=\"#n{}\"/>", id - 1).repeat(10);
        nodes += &format!("<node id=\"n{id}\">{inner}</node>");
    }
    let many = CUBE.replace(
        "</library_nodes>",
        &format!("{nodes}<node id=\"n0\"/></library_nodes>"),
    );
    let given = refused(&many.replace("url=\"#shared\"", "url=\"#n11\""));
    assert!(
        given.contains("more than 100000 placements of objects"),
        "{given}"
    );
}

#[test]
fn a_long_node_that_is_placed_often_ends_at_a_limit() {
    let long = CUBE.replace(
        "<translate>0 0 100",
        &format!("<translate>{}0 0 100", " ".repeat(300_000)),
    );
    let often = long.replace(
        "<instance_node url=\"#shared\"/>",
        &"<instance_node url=\"#shared\"/>".repeat(1000),
    );
    let given = refused(&often);
    assert!(
        given.contains("the placed nodes have more than 268435456 bytes"),
        "{given}"
    );
}

#[test]
fn a_rotation_turns_about_its_axis_whatever_its_length() {
    // 120 degrees about the diagonal: x to y to z to x.
    let text = CUBE.replace(
        "<translate>10 0 0</translate><rotate>0 0 2 90</rotate>",
        "<rotate>5 5 5 120</rotate>",
    );
    let found = report(&text.replace("<instance_node url=\"#shared\"/>", ""));
    // x 0..6, y 1..7, z -6..0 are y, z and x then.
    for (value, expected) in [(found.min, [-6.0, 0.0, 1.0]), (found.max, [0.0, 6.0, 7.0])] {
        assert!(
            (0..3).all(|axis| (value[axis] - expected[axis]).abs() < 1e-14),
            "{found:?}"
        );
    }
}

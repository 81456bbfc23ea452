use super::super::report::MeshReport;
use super::*;

const CUBE: &str = include_str!("../../../tests/seeds/cube.obj");

fn report(text: &str) -> MeshReport {
    read("a.obj", text.as_bytes()).unwrap().report()
}

fn refused(text: &str) -> String {
    read("a.obj", text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn a_cube_with_every_kind_of_index_is_closed_and_has_its_volume() {
    for text in [
        CUBE.to_owned(),
        CUBE.replace('\n', "\r\n"),
        CUBE.replace('\n', "\r"),
    ] {
        let found = report(&text);
        assert_eq!((found.triangles, found.max), (12, [2.0; 3]));
        assert!(found.is_closed && found.is_oriented, "{found:?}");
        assert!((found.volume - 8.0).abs() < 1e-14);
    }
}

#[test]
fn a_face_may_precede_its_vertices_and_unused_vertices_do_not_matter() {
    let found = report("v 99 99 99\nf 2 3 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
    assert_eq!((found.triangles, found.max), (1, [1.0, 1.0, 0.0]));
}

#[test]
fn a_face_that_is_not_convex_has_the_area_of_the_polygon() {
    let found = report("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nf 2 3 4 1\n");
    assert!((found.area - 4.0).abs() < 1e-14, "{found:?}");
}

#[test]
fn indices_without_a_vertex_are_reported_at_their_place() {
    let given = refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\nf 0 1 2\nf 1 -4 2\nf 1 2 3\nf 1 x 3\nf 1 2\n");
    for expected in [
        "a.obj:4:7: no vertex has the index of `4`: the file has 3 vertices, 3 before this line",
        "a.obj:5:3: no vertex has the index of `0`",
        "a.obj:6:5: no vertex has the index of `-4`",
        "a.obj:8:5: `x` does not begin with the index of a vertex",
        "a.obj:9:1: a face with 2 corners: at least 3 required",
    ] {
        assert!(given.contains(expected), "{expected}\n{given}");
    }
}

#[test]
fn vertices_that_are_wrong_are_reported_and_keep_their_index() {
    let given = refused("v 0 0 0\nv 1 nan 0\nv 0 1\nv 1e10 0 0\nf 1 2 3\n");
    assert!(given.contains("a.obj:2:5: NaN is not a finite number"), "{given}");
    assert!(given.contains("a.obj:3:1: 2 coordinates: 3 required"), "{given}");
    assert!(
        given.contains("a.obj:4:3: 1e10 exceeds the largest coordinate"),
        "{given}"
    );
    assert_eq!(given.matches("error:").count(), 3, "{given}");
}

#[test]
fn crossing_faces_and_free_forms_are_refused() {
    let given = refused("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\nsurf 0 1 0 1 1 2 3 4\n");
    assert!(
        given.contains("a.obj:5:1: the sides of this polygon cross each other"),
        "{given}"
    );
    assert!(
        given.contains("a.obj:6:1: a free-form curve or surface has no triangles"),
        "{given}"
    );
    assert!(refused("v 0 0 0\n").contains("the mesh has no triangles"));
}

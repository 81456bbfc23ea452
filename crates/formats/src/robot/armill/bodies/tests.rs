use armill_core::clearance::{Role, Shape};
use armill_core::robot::Attachment;

use super::super::read;

const ARM: &str = r#"format = 1
name = "lever"
[chain]
source = "drawing"
motions = [{ about = "z", joint = "A" }, { along = "x", length_mm = 500 }, { about = "z", joint = "B" }]
[[joint]]
name = "A"
sign = 1
source = "drawing"
[[joint]]
name = "B"
sign = 1
source = "drawing"
[[body]]
at = "base"
box_mm = { from = [-100, -100, -50], to = [100, 100, 0] }
source = "drawing"
[[body]]
at = "A"
name = "rod"
capsule_mm = { from = [0, 0, 20], to = [500, 0, 20], diameter = 80 }
accuracy_mm = 15
source = "drawing"
[[body]]
at = "B"
cylinder_mm = { from = [0, 0, 0], to = [0, 0, 90], diameter = 60 }
source = "drawing"
[[body]]
at = "B"
capsule_mm = { from = [0, 0, 90], to = [0, 0, 90], diameter = 60 }
source = "drawing"
[clearance]
apart = [["link B 2", "base"]]
source = "drawing"
[sources.drawing]
what = "a lever"
where = "this test"
licence = "none"
"#;

fn problems(from: &str, to: &str) -> String {
    assert!(ARM.contains(from), "the sample has no `{from}`");
    let text = ARM.replacen(from, to, 1);
    read("lever.toml", "lever", &text).unwrap_err().to_string()
}

#[test]
fn bodies_arrive_in_metres_with_names_and_attachments() {
    let read = read("lever.toml", "lever", ARM).unwrap();
    let names: Vec<&str> = read.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["base", "rod", "link B", "link B 2"]);
    assert!(read.bodies.iter().all(|body| body.role == Role::Link));
    assert_eq!(read.bodies[0].attachment, Attachment::Base);
    assert_eq!(read.bodies[1].attachment, Attachment::Joint(0));
    let Shape::Capsule(rod) = &read.bodies[1].shape else {
        panic!("a capsule");
    };
    assert_eq!((rod.axis.to.x, rod.axis.to.z, rod.radius), (0.5, 0.02, 0.04));
    assert!(
        matches!(&read.bodies[2].shape, Shape::Cylinder(axis, radius) if axis.to.z == 0.09 && *radius == 0.03)
    );
    assert_eq!(read.apart, [[0, 3]]);
    assert_eq!(read.body_notes[1].accuracy_mm, Some(15.0));
    assert_eq!(read.body_notes[0].accuracy_mm, None);
    assert_eq!(read.body_notes[0].source, "drawing");
}

#[test]
fn a_body_needs_a_part_of_the_robot() {
    let wrong = problems("at = \"A\"", "at = \"C\"");
    assert!(
        wrong.contains("lever.toml:19:6: `C` is not a part of the robot"),
        "{wrong}"
    );
    assert!(wrong.contains("`base`, `flange`, or a joint: A, B"), "{wrong}");
    assert!(problems("at = \"A\"", "at = \"tool\"").contains("`tool` is not a part of the robot"));
}

#[test]
fn a_body_has_exactly_one_shape() {
    let one = "capsule_mm = { from = [0, 0, 20], to = [500, 0, 20], diameter = 80 }";
    assert!(problems(one, "").contains("a body has exactly one shape"));
    let two = format!("{one}\nbox_mm = {{ from = [0, 0, 0], to = [1, 1, 1] }}");
    assert!(problems(one, &two).contains("a body has exactly one shape"));
}

#[test]
fn shapes_without_volume_are_reported_at_their_key() {
    let flat = problems("to = [100, 100, 0]", "to = [100, 100, -50]");
    assert!(
        flat.contains("lever.toml:16:") && flat.contains("has no volume"),
        "{flat}"
    );
    let disc = problems("to = [0, 0, 90], diameter", "to = [0, 0, 0], diameter");
    assert!(disc.contains("the ends of the cylinder are both at"), "{disc}");
    let thin = problems("diameter = 80", "diameter = 0");
    assert!(thin.contains("0.001"), "{thin}");
}

#[test]
fn names_differ_and_pairs_name_bodies() {
    let same = problems("name = \"rod\"", "name = \"base\"");
    assert!(same.contains("another body is called `base`"), "{same}");
    let unknown = problems("[\"link B 2\", \"base\"]", "[\"link C\", \"foot\"]");
    assert!(
        unknown.contains("`link C` is not a body") && unknown.contains("`foot` is not a body"),
        "{unknown}"
    );
    assert!(
        unknown.contains("one of: base, rod, link B, link B 2"),
        "{unknown}"
    );
    let itself = problems("[\"link B 2\", \"base\"]", "[\"base\", \"base\"]");
    assert!(itself.contains("a body is not apart from itself"), "{itself}");
    let twice = problems(
        "[\"link B 2\", \"base\"]",
        "[\"rod\", \"base\"], [\"base\", \"rod\"]",
    );
    assert!(twice.contains("the pair is given twice"), "{twice}");
}

#[test]
fn every_body_and_the_pairs_need_a_source_and_all_problems_are_reported_together() {
    let named = "accuracy_mm = 15\nsource = \"drawing\"";
    assert!(problems(named, "accuracy_mm = 15").contains("source"));
    assert!(
        problems(named, "accuracy_mm = 15\nsource = \"none\"")
            .contains("source `none` is not among the sources")
    );
    let text = ARM.replacen("at = \"A\"", "at = \"C\"", 1).replacen(
        "[\"link B 2\", \"base\"]",
        "[\"x\", \"base\"]",
        1,
    );
    let both = read("lever.toml", "lever", &text).unwrap_err();
    assert_eq!(both.as_slice().len(), 2, "{both}");
}

#[test]
fn a_file_without_bodies_has_none() {
    let start = ARM.find("[[body]]").unwrap();
    let end = ARM.find("[sources").unwrap();
    let text = ARM[..start].to_owned() + &ARM[end..];
    let bare = read("lever.toml", "lever", &text).unwrap();
    assert!(bare.bodies.is_empty() && bare.apart.is_empty() && bare.body_notes.is_empty());
    let pair = text.replace(
        "[sources",
        "[clearance]\napart = [[\"base\", \"rod\"]]\nsource = \"drawing\"\n[sources",
    );
    let wrong = read("lever.toml", "lever", &pair).unwrap_err().to_string();
    assert!(wrong.contains("the file has no [[body]]"), "{wrong}");
}

#[test]
fn bodies_that_are_written_come_back() {
    let given = read("lever.toml", "lever", ARM).unwrap();
    let text = super::super::write(&given);
    let again = read("written.toml", "lever", &text).unwrap();
    assert_eq!(
        format!("{:?}", again.bodies),
        format!("{:?}", given.bodies),
        "{text}"
    );
    assert_eq!(again.body_notes, given.body_notes);
    assert_eq!(again.apart, given.apart);
}

#[test]
fn bodies_survive_an_identification_and_a_calibration() {
    use super::super::{Geometry, Identified, IdentifiedSpring, with_geometry, with_springs};
    use crate::robot::spring_tables::SpringKind;
    use armill_core::robot::{Amount, Axis, Motion};

    let given = read("lever.toml", "lever", ARM).unwrap();
    let springs = ["A", "B"].map(|at| IdentifiedSpring {
        at: at.to_owned(),
        kind: SpringKind::Drive,
        compliance: 2e-6,
        standard_uncertainty: 1e-7,
    });
    let identified = Identified {
        springs: springs.to_vec(),
        covariance: Vec::new(),
        model_error: None,
        what: "tests".to_owned(),
        place: "tests.csv".to_owned(),
    };
    let geometry = Geometry {
        after: vec![(
            "A".to_owned(),
            vec![Motion::Along(Axis::Y, Amount::Constant(1e-4))],
        )],
        what: "poses".to_owned(),
        place: "poses.csv".to_owned(),
        covariance: None,
    };
    let with_springs = with_springs("lever.toml", ARM, &identified).unwrap();
    let with_both = with_geometry("lever.toml", &with_springs, &geometry).unwrap();
    let again = read("lever.toml", "lever", &with_both).unwrap();
    assert_eq!(
        format!("{:?}", again.bodies),
        format!("{:?}", given.bodies),
        "{with_both}"
    );
    assert_eq!((again.body_notes, again.apart), (given.body_notes, given.apart));
}

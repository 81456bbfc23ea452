//! Masses of the links of a robot, estimated from the mass of the arm.

use crate::cell::Cell;

/// A lever of two links, each a cube: 0.008 m^3 at the base, 0.001 m^3 behind its joint.
const LEVER: &str = r#"format = 1
name = "lever"
[chain]
source = "own"
motions = [{ about = "z", joint = "A" }, { along = "x", length_mm = 500 }]
[[joint]]
name = "A"
sign = 1
source = "own"
[[body]]
at = "base"
box_mm = { from = [-100, -100, -200], to = [100, 100, 0] }
source = "own"
[[body]]
at = "A"
box_mm = { from = [200, -50, 0], to = [300, 50, 100] }
source = "own"
[sources.own]
what = "made up"
where = "here"
licence = "none"
"#;

#[test]
fn tables_that_are_appended_to_a_robot_file_are_its_masses() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    let arguments = ["robots", "masses", "lever.toml", "--total-kg", "90"];
    let said = cell
        .armill(&[&arguments[..], &["--out", "masses.toml"]].concat())
        .fine();
    assert!(
        said.err.contains("lever: masses of 2 links") && said.err.contains("created masses.toml"),
        "{}",
        said.err
    );
    let tables = std::fs::read_to_string(cell.at("masses.toml")).unwrap();
    cell.file("heavy.toml", format!("{LEVER}{tables}"));
    let given = cell.armill(&["robots", "heavy.toml", "--json"]).fine().json();
    let masses = &given["structure"]["masses"];
    // 90 kg over 0.009 m^3; a cube has m a^2 / 6 about its centre.
    for (index, [mass, centre, inertia]) in [[80.0, 0.0, 80.0 * 0.04 / 6.0], [10.0, 250.0, 10.0 * 0.01 / 6.0]]
        .into_iter()
        .enumerate()
    {
        let mass_of = &masses[index];
        assert_eq!(mass_of["mass_kg"], mass);
        assert_eq!(mass_of["mass_u_percent"], 45.0);
        assert_eq!(mass_of["centre_mm"][0], centre);
        let found = mass_of["inertia_kg_m2"][2][2].as_f64().unwrap();
        // Three digits.
        assert!((found / inertia - 1.0).abs() < 5e-3, "{found} {inertia}");
    }
    let printed = cell.armill(&[&arguments[..], &["--json"]].concat()).fine().json();
    assert_eq!(printed["masses"], *masses);
    assert_eq!(printed["text"].as_str().map(str::trim), Some(tables.trim()));
}

#[test]
fn an_arm_without_bodies_or_lighter_than_its_links_is_refused_and_nothing_is_written() {
    let cell = Cell::new();
    let bare = LEVER.split("[[body]]").next().unwrap().to_owned()
        + LEVER.split_at(LEVER.find("[sources").unwrap()).1;
    cell.file("bare.toml", bare);
    let mass = "[[mass]]\nat = \"A\"\nmass_kg = 20\ncentre_mm = [0, 0, 0]\nsource = \"own\"\n";
    cell.file(
        "known.toml",
        LEVER.replace(
            "[[body]]\nat = \"base\"",
            &format!("{mass}[[body]]\nat = \"base\""),
        ),
    );
    for (file, total, words) in [
        ("bare.toml", "90", "no link without a given mass has a body"),
        ("known.toml", "20", "already have 20 kg"),
        ("known.toml", "-1", "--total-kg"),
    ] {
        let total = format!("--total-kg={total}");
        cell.armill(&["robots", "masses", file, &total, "--out", "masses.toml"])
            .refused(&[words]);
        assert!(!cell.at("masses.toml").exists());
    }
}

//! The pictures of README and guide are those that armill draws; `KEEP_PICTURES=1` keeps new ones, after a look at them.

use crate::cell::Cell;
use crate::documents::repository;

/// A study with this one of its analyses.
fn alone(study: &str, name: &str) -> String {
    let mut tables = study.split("[[analysis]]");
    let head = tables.next().unwrap();
    let asked = format!("name = \"{name}\"\n");
    let analysis = tables.find(|table| table.contains(&asked)).unwrap();
    format!("{head}[[analysis]]{analysis}")
}

/// Compares a picture of the documentation with this one of the results of a study.
fn check(picture: &str, study: &str, result: &str) {
    let cell = Cell::with_study(study);
    cell.armill(&["run", "study.toml", "--out", "out"]).fine();
    let drawn = std::fs::read(cell.at("out").join(result)).unwrap();
    let kept = repository().join("docs/pictures").join(picture);
    if std::env::var_os("KEEP_PICTURES").is_some() {
        std::fs::write(&kept, &drawn).unwrap();
    }
    let same = std::fs::read(&kept).unwrap() == drawn;
    assert!(
        same,
        "{picture} is not what armill draws: KEEP_PICTURES=1 keeps the new one"
    );
}

#[test]
fn the_map_of_the_readme_is_that_of_the_example() {
    let study = std::fs::read_to_string(repository().join("studies/mh12-groove/study.toml")).unwrap();
    let study = alone(&study, "Fig. 6, best branch");
    check("fig-6-best-branch.png", &study, "fig-6-best-branch.png");
}

#[test]
fn the_bodies_of_the_guide_are_those_of_its_study() {
    let study = std::fs::read_to_string(repository().join("docs/pictures/clearance.toml")).unwrap();
    check("clearance.png", &study, "map-clearance.png");
}

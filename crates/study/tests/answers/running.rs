//! Reading and running a study: its analyses, progress, cancelling, files.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use armill_core::watch::Watch;
use armill_formats::file::Writer;
use armill_study::answer::answer;
use armill_study::file::resolve::read;
use armill_study::output::{OutputOptions, StudyResults, write};
use armill_study::run::{point_count, run};
use armill_study::{ErrorKind, StudyError, library};

use crate::{answered, found, plate_with};

#[test]
fn a_study_without_analyses_maps_its_plane() {
    let answer = answered(&plate_with(""));
    assert_eq!((answer.maps.len(), answer.maps[0].name.as_str()), (1, "map"));
    let statement = "[[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = 5\nof = [\"map\"]\n";
    assert_eq!(answered(&plate_with(statement)).statements[0].readings.len(), 1);
}

#[test]
fn every_example_study_reads() {
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    for example in library::example_studies() {
        let folder = studies.join(example.name);
        let read = read(example.path, &folder, example.text.as_bytes());
        assert!(read.is_ok(), "{}", read.unwrap_err());
    }
}

#[test]
fn an_analysis_that_names_a_branch_keeps_the_home_of_the_study() {
    let home = "posture = { branch = \"front elbow-up\", home_deg = [1, 2, 3, 4, 5, 6] }\n";
    let study = plate_with(&format!(
        "{home}[[analysis]]\nkind = \"map\"\nposture.branch = \"front elbow-down\"\n"
    ));
    let setting = study.settings().next().unwrap();
    assert_eq!(setting.branch(), "front elbow-down");
    let home: Vec<f64> = setting.home.clone().unwrap();
    assert!((home[5].to_degrees() - 6.0).abs() < 1e-12);
}

#[test]
fn points_are_counted_before_they_are_computed() {
    let study = plate_with(
        "[[analysis]]\nkind = \"map\"\n[[analysis]]\nkind = \"sections\"\ntilts_deg = [0, 30]\n\
         [[analysis]]\nkind = \"volume\"\nbox = { half_size_mm = [50, 50, 50], step_mm = 50 }\n",
    );
    assert_eq!(point_count(&study), 81 + 2 * 81 + 27);
    let given = std::sync::atomic::AtomicUsize::new(0);
    let finished = |points: usize| {
        given.fetch_add(points, std::sync::atomic::Ordering::Relaxed);
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
        given.into_inner(),
        point_count(&study),
        "progress does not end at its end"
    );
}

#[test]
fn a_cancelled_study_reports_it_and_has_no_result() {
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
        "[[analysis]]\nkind = \"map\"\n[[analysis]]\nkind = \"path\"\ncircle.radius_mm = 100\nstep_mm = 30\n",
    );
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    for folder in &folders {
        let found = found(&study);
        let out = Writer::new("run", false).folder(folder.path()).unwrap();
        let results = StudyResults {
            study: &study,
            done: &found,
            answer: &answer(&study, &found),
        };
        write(results, &out, OutputOptions::TABLES, &|_| ()).unwrap();
    }
    let mut names: Vec<_> = std::fs::read_dir(folders[0].path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    // Three tables per analysis, the result, the list of files.
    assert_eq!(names.len(), 2 * 3 + 2, "{names:?}");
    for name in names {
        let [a, b] = [0, 1].map(|i: usize| std::fs::read(folders[i].path().join(&name)).unwrap());
        assert!(a == b, "{}", name.display());
    }
}

//! Checks that every `console` block of README and guide shows the actual output.
//!
//! A page gets one folder, empty but for the URDFs of `validation/urdf-forward`. A line `$ ...` is a command of
//! `armill` (a shell runs it, so `>` and `&&` work);
//! the lines after it are its output, stdout and stderr in either order; `...` matches any lines.

use std::path::{Path, PathBuf};
use std::process::Command;

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Commands of a page with the output shown for each.
fn commands(page: &str) -> Vec<(String, Vec<String>)> {
    let mut commands: Vec<(String, Vec<String>)> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        match line {
            "```console" => inside = true,
            "```" => inside = false,
            _ if !inside => {}
            _ => match line.strip_prefix("$ ") {
                Some(command) => commands.push((command.to_owned(), Vec::new())),
                None => commands.last_mut().unwrap().1.push(line.to_owned()),
            },
        }
    }
    commands
}

/// Whether `shown` matches `real`, where `...` matches any lines.
fn fits(shown: &[String], real: &[&str]) -> bool {
    match shown.split_first() {
        None => real.is_empty(),
        Some((first, rest)) if first == "..." => (0..=real.len()).any(|skipped| fits(rest, &real[skipped..])),
        Some((first, rest)) => real
            .split_first()
            .is_some_and(|(line, more)| line == first && fits(rest, more)),
    }
}

fn run_page(path: &str) {
    let text = std::fs::read_to_string(repository().join(path)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let urdfs = "validation/urdf-forward";
    std::fs::create_dir_all(folder.path().join(urdfs)).unwrap();
    for name in ["mh12.urdf", "kr120r2500pro.urdf"] {
        let file = Path::new(urdfs).join(name);
        std::fs::copy(repository().join(&file), folder.path().join(&file)).unwrap();
    }
    let program = Path::new(assert_cmd::cargo::cargo_bin!("armill"))
        .parent()
        .unwrap()
        .to_owned();
    let search = std::env::join_paths(
        std::iter::once(program).chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    );
    for (command, shown) in commands(&text) {
        let ran = Command::new("sh")
            .args(["-c", &command])
            .current_dir(folder.path())
            .env("PATH", search.as_ref().unwrap())
            .output()
            .unwrap();
        let (out, err) = (
            String::from_utf8(ran.stdout).unwrap(),
            String::from_utf8(ran.stderr).unwrap(),
        );
        let one = |a: &str, b: &str| format!("{a}{b}").lines().map(str::to_owned).collect::<Vec<_>>();
        let orders = [one(&out, &err), one(&err, &out)];
        let fitting = orders
            .iter()
            .any(|lines| fits(&shown, &lines.iter().map(String::as_str).collect::<Vec<_>>()));
        assert!(
            fitting,
            "{path}: `{command}` shows\n{}\nbut gives\n{out}{err}",
            shown.join("\n")
        );
    }
}

#[test]
fn readme_runs() {
    run_page("README.md");
}

/// One test per page of the guide, so that pages run in parallel and a failure names its page.
macro_rules! guide {
    ($($name:ident: $page:literal),* $(,)?) => {
        $(#[test]
        fn $name() {
            run_page(concat!("docs/guide/", $page, ".md"));
        })*

        #[test]
        fn every_page_of_the_guide_is_run() {
            let folder = std::fs::read_dir(repository().join("docs/guide")).unwrap();
            let mut pages: Vec<String> = folder
                .map(|page| page.unwrap().file_name().into_string().unwrap())
                .collect();
            let mut run: Vec<String> = [$($page),*].map(|page| format!("{page}.md")).to_vec();
            pages.sort();
            run.sort();
            assert_eq!(pages, run, "add the new page to `guide!`");
        }
    };
}

guide! {
    guide_install: "install",
    guide_site: "site",
    guide_predict: "predict",
    guide_programs: "programs",
    guide_your_robot: "your-robot",
    guide_measure_stiffness: "measure-stiffness",
    guide_export: "export",
    guide_urdf: "urdf",
    guide_integrations: "integrations",
    guide_learn: "learn",
    guide_journal: "journal",
    guide_study_file: "study-file",
    guide_robot_file: "robot-file",
    guide_results: "results",
    guide_quantities: "quantities",
    guide_tool_path: "tool-path",
    guide_tool_path_words: "tool-path-words",
    guide_placement: "placement",
    guide_compare: "compare",
    guide_holes: "holes",
    guide_machined_part: "machined-part",
    guide_material_file: "material-file",
    guide_measured_forces: "measured-forces",
    guide_roundness: "roundness",
    guide_ballbar: "ballbar",
    guide_calibrate: "calibrate",
    guide_budget: "budget",
    guide_live_page: "live-page",
    guide_python: "python",
    guide_cam_to_robot: "cam-to-robot",
    guide_many_machines: "many-machines",
    guide_plotting: "plotting",
    guide_ballbar_day: "ballbar-day",
    guide_common_mistakes: "common-mistakes",
    guide_how_far_to_trust_it: "how-far-to-trust-it",
    guide_cell: "cell",
    guide_meshes: "meshes",
    guide_scans: "scans",
    guide_receptance: "receptance",
    guide_stability: "stability",
    guide_readme: "README",
}

#[test]
fn dots_match_any_lines_and_nothing_else_does() {
    let shown = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(fits(&shown("a\n...\nd"), &["a", "b", "c", "d"]));
    assert!(fits(&shown("a\n..."), &["a"]));
    assert!(!fits(&shown("a\nb"), &["a"]));
    assert!(!fits(&shown("a\n...\ne"), &["a", "b", "d"]));
}

//! `armill new`, `robots`, `check --schema` and the help: what a user meets first.

use crate::cell::{Cell, LEVER, MH12_URDF, SMALL, number, numbers, what_is_half};

#[test]
fn a_new_study_is_commented_and_runs_for_every_robot_of_the_library() {
    let cell = Cell::new();
    let robots = cell.armill(&["robots", "--json"]).fine().json();
    assert!(robots.as_array().unwrap().len() >= 25);
    for (index, robot) in robots.as_array().unwrap().iter().enumerate() {
        let (name, folder) = (robot["name"].as_str().unwrap(), format!("cell {index}"));
        cell.armill(&["new", &folder, "--robot", name]).fine();
        let text = std::fs::read_to_string(cell.at(&folder).join("study.toml")).unwrap();
        assert!(
            text.lines().filter(|line| line.contains('#')).count() > 10,
            "{text}"
        );
        assert!(text.contains(&format!("robot = \"{name}\"")), "{text}");
        if name == "kuka/lbr-iiwa-14-r820" {
            // Seven joints: no class fits, and none is assumed.
            cell.armill(&["check", &folder]).refused(&["rad_per_n_m", "7"]);
            let known = text.replace(
                "rad_per_n_m = []",
                "rad_per_n_m = [1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5]",
            );
            cell.file(
                &format!("{folder}/study.toml"),
                known.replace("source = \"\"", "source = \"made up here\""),
            );
        }
        cell.armill(&["check", &folder]).fine();
        cell.armill(&["run", &folder, "--no-pictures"]).fine();
        let result = cell.result(&format!("{folder}/out"));
        let counts = &result["maps"][0]["counts"];
        assert_eq!(
            number(&counts["out_of_reach"]),
            0.0,
            "the example plate of {name} is out of reach"
        );
    }
}

#[test]
fn a_new_study_of_a_robot_without_compliance_reports_the_assumption() {
    let cell = Cell::new();
    cell.armill(&["new", "cell", "--robot", "kuka/kr120r2500pro"])
        .fine();
    cell.armill(&["run", "cell", "--no-pictures"]).fine();
    let warnings = cell.result("cell/out")["warnings"].to_string();
    assert!(warnings.contains("assumed, not measured"), "{warnings}");
}

#[test]
fn a_new_study_of_a_robot_file_finds_it_from_its_own_folder() {
    let cell = Cell::new();
    cell.file("arms/by hand.urdf", MH12_URDF);
    cell.armill(&["new", "cells/first", "--robot", "arms/by hand.urdf"])
        .fine();
    let text = std::fs::read_to_string(cell.at("cells/first/study.toml")).unwrap();
    assert!(
        cfg!(not(target_os = "linux")) || text.contains("robot = \"../../arms/by hand.urdf\""),
        "{text}"
    );
    cell.armill(&["run", "cells/first", "--no-pictures"]).fine();
}

#[test]
fn a_new_study_of_a_robot_that_no_study_can_use_is_refused() {
    let cell = Cell::new();
    cell.file("lever.toml", LEVER);
    cell.armill(&["new", "cell", "--robot", "lever.toml"])
        .refused(&["has 2 joints"]);
    cell.armill(&["new", "cell", "--robot", "mh12"])
        .refused(&["did you mean `yaskawa/mh12`?"]);
    assert!(
        !cell.at("cell").exists(),
        "a folder was made for a study that was refused"
    );
}

#[test]
fn a_new_study_leaves_the_files_of_an_existing_folder_alone() {
    let cell = Cell::new();
    cell.file("cell/notes.txt", "mine");
    cell.armill(&["new", "cell"]).fine();
    assert_eq!(cell.files("cell")["notes.txt"], b"mine");
    let before = cell.file("cell/study.toml", "mine too");
    cell.armill(&["new", "cell"])
        .refused(&["cell/study.toml", "--force"]);
    assert_eq!(std::fs::read(before).unwrap(), b"mine too");
    cell.armill(&["new", "cell/notes.txt"])
        .refused(&["notes.txt", "is a file"]);
}

#[test]
fn the_files_created_are_reported_as_json_on_request() {
    let said = Cell::new().armill(&["new", "größe 1", "--json"]).fine();
    assert_eq!(said.json()["study"], "größe 1/study.toml");
    assert!(said.err.contains("armill run"), "{}", said.err);
}

#[test]
fn the_library_is_listed_with_the_data_of_each_robot() {
    let said = Cell::new().armill(&["robots"]).fine();
    assert!(
        said.out
            .lines()
            .any(|line| line.starts_with("yaskawa/mh12") && line.ends_with("compliance known")),
        "{}",
        said.out
    );
    assert!(
        said.out
            .lines()
            .any(|line| line.starts_with("kuka/") && line.ends_with("not known")),
        "{}",
        said.out
    );
}

#[test]
fn the_list_of_robots_stays_within_a_line_each() {
    let said = Cell::new().armill(&["robots"]).fine();
    let widths: Vec<usize> = said.out.lines().map(|line| line.chars().count()).collect();
    assert!(
        widths.len() >= 25 && widths.iter().all(|width| *width <= 120),
        "{}",
        said.out
    );
    let of_ur = said
        .out
        .lines()
        .find(|line| line.contains("Universal Robots UR10e"));
    assert!(
        of_ur.is_some_and(|line| line.contains("inverse closed form")),
        "{}",
        said.out
    );
    assert!(
        said.out.contains("120 kg  2501 mm  inverse closed form"),
        "{}",
        said.out
    );
}

#[test]
fn a_robot_is_shown_with_joints_limits_frames_and_sources() {
    let said = Cell::new().armill(&["robots", "yaskawa/mh12"]).fine();
    for words in [
        "along z 450 mm (H)",
        "-170 to 170 deg",
        "Frame controller: at (0, 0, 450) mm",
        "Sources:",
        "Apache-2.0",
    ] {
        assert!(said.out.contains(words), "no `{words}` in:\n{}", said.out);
    }
    let robot = Cell::new()
        .armill(&["robots", "yaskawa/mh12", "--json"])
        .fine()
        .json();
    let names: Vec<&str> = robot["joints"]
        .as_array()
        .unwrap()
        .iter()
        .map(|joint| joint["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["S", "L", "U", "R", "B", "T"]);
    assert_eq!(numbers(&robot["joints"][1]["limits_deg"]), [-90.0, 155.0]);
    assert_eq!(robot["inverse"], "closed_form");
}

#[test]
fn a_urdf_is_shown_as_the_chain_it_is() {
    let cell = Cell::new();
    cell.file("arm.urdf", MH12_URDF);
    let library = cell.armill(&["robots", "yaskawa/mh12", "--json"]).fine().json();
    let by_hand = cell.armill(&["robots", "arm.urdf", "--json"]).fine().json();
    assert_eq!(by_hand["inverse"], "closed_form");
    for (a, b) in library["joints"]
        .as_array()
        .unwrap()
        .iter()
        .zip(by_hand["joints"].as_array().unwrap())
    {
        assert_eq!((&a["name"], &a["sign"]), (&b["name"], &b["sign"]));
        for (a, b) in numbers(&a["limits_deg"]).iter().zip(numbers(&b["limits_deg"])) {
            // Reported to 1e-9 deg.
            assert!((a - b).abs() < 2e-9, "{a} deg and {b} deg");
        }
    }
}

#[test]
fn a_robot_is_drawn_to_the_requested_file() {
    let cell = Cell::new();
    for file in ["arm.svg", "arm.png", "Großer Arm.PNG"] {
        cell.armill(&["robots", "kuka/kr120r2500pro", "--drawing", file])
            .fine();
        let bytes = std::fs::read(cell.at(file)).unwrap();
        assert_eq!(what_is_half(&file.to_lowercase(), &bytes), None);
    }
    cell.armill(&["robots", "yaskawa/mh12", "--drawing", "gone/arm.svg"])
        .refused(&["gone"]);
    for file in ["arm.pdf", "arm"] {
        cell.armill(&["robots", "yaskawa/mh12", "--drawing", file])
            .refused(&["--drawing", file, ".svg or .png"]);
        assert!(!cell.at(file).exists());
    }
}

#[test]
fn a_valid_study_is_reported_with_its_number_of_points() {
    let said = Cell::with_study(SMALL).armill(&["check", "study.toml"]).fine();
    assert_eq!(said.err, "study.toml: fine; 1 analysis, 25 points\n");
    let json = Cell::with_study(SMALL)
        .armill(&["check", ".", "--json"])
        .fine()
        .json();
    assert_eq!(json, serde_json::json!({ "problems": [], "warnings": [] }));
}

#[test]
fn check_warns_of_values_that_are_probably_slips_as_run_does() {
    // Both analyses have the plane of the study: one warning.
    let more = "[[analysis]]\nkind = \"map\"\nname = \"a\"\n\n[[analysis]]\nkind = \"map\"\nname = \"b\"\n";
    let slipped = SMALL.replacen("tilt_deg = 0", "tilt_deg = 1.5708", 1);
    assert_ne!(slipped, SMALL);
    let cell = Cell::with_study(&format!("{slipped}{more}"));
    let warning = "The plane is tilted by only 1.5708 deg: 1.5708 is 90 deg in rad; if that was meant, write \
                   `plane.tilt_deg` in deg.";
    let checked = cell.armill(&["check", "study.toml"]).fine();
    assert_eq!(
        checked.err,
        format!("warning: {warning}\nstudy.toml: 1 warning; 2 analyses, 50 points\n")
    );
    let json = cell.armill(&["check", "study.toml", "--json"]).fine().json();
    assert_eq!(json, serde_json::json!({ "problems": [], "warnings": [warning] }));
    let run = cell.armill(&["run", "study.toml", "--no-pictures"]).fine();
    assert_eq!(run.err.matches(warning).count(), 1, "{}", run.err);
}

#[test]
fn examples_are_checked_from_an_empty_folder() {
    for example in ["mh12-groove", "kr120-groove", "studies/mh12-groove"] {
        Cell::new().armill(&["check", example]).fine();
    }
}

#[test]
fn the_schema_names_every_field_of_the_study() {
    let schema = Cell::new().armill(&["check", "--schema"]).fine().json();
    for field in [
        "format",
        "robot",
        "base",
        "tool",
        "plane",
        "load",
        "tolerance_um",
        "posture",
        "analysis",
        "compliance",
        "statement",
    ] {
        assert!(schema["properties"][field].is_object(), "no {field}");
    }
}

#[test]
fn every_command_has_help_with_its_own_examples() {
    for command in ["run", "check", "new", "robots", "pose", "completions"] {
        let said = Cell::new().armill(&[command, "--help"]).fine();
        assert!(
            said.out.contains("Examples:") && said.out.contains(&format!("armill {command}")),
            "{}",
            said.out
        );
        assert!(
            said.out.contains("--json") || command == "completions",
            "{command} has no --json"
        );
    }
    let whole = Cell::new().armill(&["--help"]).fine();
    assert!(whole.out.contains("Examples:"), "{}", whole.out);
    assert!(
        Cell::new()
            .armill(&["--version"])
            .fine()
            .out
            .starts_with("armill 0.")
    );
}

#[test]
fn examples_of_the_help_work() {
    let cell = Cell::new();
    let help = cell.armill(&["pose", "--help"]).fine().out;
    cell.file("arm.urdf", MH12_URDF);
    cell.file("cell/study.toml", SMALL);
    let examples: Vec<&str> = help
        .lines()
        .filter(|line| line.starts_with("  armill pose "))
        .collect();
    assert!(examples.len() >= 3, "{help}");
    for example in examples {
        cell.armill(&example.split_whitespace().skip(1).collect::<Vec<_>>())
            .fine();
    }
}

#[test]
fn an_example_is_copied_with_all_of_its_files_and_runs() {
    let cell = Cell::new();
    let said = cell
        .armill(&["new", "pocket", "--example", "r2000ic-pocket", "--json"])
        .fine();
    assert_eq!(said.json()["study"], "pocket/study.toml");
    assert_eq!(said.json()["files"][0], "pocket/pocket.ngc");
    let run = cell.armill(&["run", "pocket", "--no-pictures"]).fine();
    assert!(
        run.out.starts_with("pocket, branch front elbow-up"),
        "{}",
        run.out
    );
    // What is there stays, and nothing is half made.
    std::fs::remove_file(cell.at("pocket/study.toml")).unwrap();
    cell.armill(&["new", "pocket", "--example", "r2000ic-pocket"])
        .refused(&["pocket/pocket.ngc", "--force"]);
    assert!(!cell.at("pocket/study.toml").exists());
}

#[test]
fn an_example_of_several_files_is_made_before_it_is_run() {
    let cell = Cell::new();
    cell.armill(&["run", "studies/mh12-ballbar"])
        .refused(&["armill new mh12-ballbar --example mh12-ballbar"]);
    cell.armill(&["new", "day", "--example", "mh12-balbar"])
        .refused(&[
            "no example is called `mh12-balbar`",
            "mh12-groove, ",
            "mh12-ballbar",
        ]);
    cell.armill(&["new", "mh12-ballbar", "--example", "mh12-ballbar"])
        .fine();
    // The backlash with which its measurements were simulated.
    let given = cell.armill(&["backlash", "mh12-ballbar", "--json"]).fine().json();
    let made = [0.009, 0.006, 0.012, 0.015, 0.010];
    for (joint, gap) in given["joints"].as_array().unwrap().iter().zip(made) {
        let (found, u) = (number(&joint["backlash_deg"]), number(&joint["backlash_u_deg"]));
        assert!((found - gap).abs() < 4.0 * u && u < 2e-4, "{joint}");
    }
}

#[test]
fn the_robot_of_the_measured_example_is_identified_from_its_tests() {
    let cell = Cell::new();
    cell.armill(&["new", "arm", "--example", "r2000ic-measured"])
        .fine();
    cell.armill(&[
        "identify",
        "arm/tests.csv",
        "--robot",
        "fanuc/r2000ic",
        "--tool-mm",
        "6.9,245.3,319.3",
        "--points",
        "separate",
        "--out",
        "again.toml",
    ])
    .fine();
    let compliances = |name: &str| -> Vec<f64> {
        let text = std::fs::read_to_string(cell.at(name)).unwrap();
        let values = text.lines().filter_map(|line| line.strip_prefix("compliance_"));
        let values = values.filter_map(|line| line.split_once("rad_per_n_m = "));
        values.map(|(_, value)| value.parse().unwrap()).collect()
    };
    let (shipped, again) = (
        compliances("arm/r2000ic-measured.toml"),
        compliances("again.toml"),
    );
    // Six drives and thirteen springs, each with its standard uncertainty.
    assert_eq!(shipped.len(), 38);
    assert_eq!(again.len(), 38);
    for (here, there) in shipped.iter().zip(&again) {
        // Seven digits are written; the rest is for other processors.
        assert!((here / there - 1.0).abs() < 1e-4, "{here} {there}");
    }
    // The prediction and the published stiffness for comparison.
    let run = cell.armill(&["run", "arm", "--no-pictures"]).fine();
    assert!(
        run.out.contains("ring, branch front elbow-up no-flip")
            && run.out.contains("largest contribution: joint J1"),
        "{}",
        run.out
    );
    let compared = cell
        .armill(&["compare", "arm", "--robot", "fanuc/r2000ic", "--out", "both"])
        .fine();
    assert!(compared.out.contains("13 further springs"), "{}", compared.out);
}

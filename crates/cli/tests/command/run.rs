//! `armill run`: what it writes, what it says, and that neither depends on where or how it runs.

use crate::cell::{Cell, EVERY_KIND, SMALL, number, numbers, what_is_half};
use serde_json::Value;

const TABLES_ONLY: [&str; 3] = ["run", "study.toml", "--no-pictures"];

const EVERY_CSV: [&str; 4] = ["run", "study.toml", "--no-pictures", "--csv"];

fn every_kind() -> String {
    format!("{SMALL}{EVERY_KIND}")
}

fn count(counts: &Value) -> f64 {
    counts.as_object().unwrap().values().map(number).sum()
}

#[test]
fn counts_add_up_to_the_points_and_the_fraction_is_those_within() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&TABLES_ONLY).fine();
    let result = cell.result("out");
    let maps = result["maps"].as_array().unwrap();
    assert_eq!(maps.len(), 3);
    for map in maps {
        assert_eq!(count(&map["counts"]), 25.0, "{}", map["counts"]);
        assert_eq!(
            number(&map["fraction_within"]),
            number(&map["counts"]["within"]) / 25.0
        );
        let deviations = numbers(&map["grid"]["in_plane_um"]);
        let within = deviations.iter().filter(|um| **um <= 130.0).count();
        assert_eq!(number(&map["counts"]["within"]), within as f64);
        // The grid is reported to 1e-4 um.
        let largest = deviations.iter().copied().fold(0.0, f64::max);
        assert!((number(&map["max_in_plane_um"]) - largest).abs() <= 0.5e-4 + 1e-9);
    }
    let volume = &result["volumes"][0];
    assert_eq!(count(&volume["counts"]), 27.0);
    assert_eq!(
        number(&volume["fraction_within"]),
        number(&volume["counts"]["within"]) / 27.0
    );
    let path = &result["paths"][0];
    assert_eq!(
        (path["name"].as_str(), number(&path["points"])),
        (Some("groove"), 36.0)
    );
    assert!(number(&path["max_in_plane_um"]) > 0.0 && number(&path["roundness_um"]) > 0.0);
}

#[test]
fn maps_and_paths_carry_name_and_branch() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&TABLES_ONLY).fine();
    let result = cell.result("out");
    let names: Vec<&str> = result["maps"]
        .as_array()
        .unwrap()
        .iter()
        .map(|map| map["name"].as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        ["plate", "distances: x = 900 mm", "distances: x = 1000 mm"]
    );
    for answer in [&result["maps"][0], &result["paths"][0], &result["volumes"][0]] {
        assert_eq!(answer["branch"], "front elbow-up");
    }
}

#[test]
fn folder_and_file_name_the_same_study_and_out_is_next_to_it() {
    let cell = Cell::new();
    cell.file("by folder/study.toml", SMALL);
    cell.file("by file/study.toml", SMALL);
    cell.armill(&["run", "by folder", "--no-pictures"]).fine();
    cell.armill(&["run", "by file/study.toml", "--no-pictures"])
        .fine();
    assert_eq!(cell.files("by folder/out"), cell.files("by file/out"));
    assert!(cell.at("by folder/out/result.json").is_file());
}

#[test]
fn every_file_is_the_same_on_one_thread_and_on_three_and_in_an_old_folder() {
    let cell = Cell::with_study(&every_kind());
    for (out, threads) in [("one", "1"), ("three", "3")] {
        cell.armill(&["run", "study.toml", "--out", out, "--threads", threads])
            .fine();
    }
    let one = cell.files("one");
    assert!(one.len() > 20, "{:?}", one.keys());
    for (name, bytes) in cell.files("three") {
        assert!(one[&name] == bytes, "{name} differs");
    }
    cell.armill(&["run", "study.toml", "--out", "three"]).fine();
    assert!(
        cell.files("three") == one,
        "a run over an old folder differs from the first"
    );
}

#[test]
fn every_file_is_whole() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&["run", "study.toml"]).fine();
    let files = cell.files("out");
    for name in [
        "result.json",
        "report.html",
        "plate.svg",
        "plate.png",
        "plate.csv",
        "plate.parquet",
        "plate.vtp",
        "space.vti",
    ] {
        assert!(files.contains_key(name), "no {name} among {:?}", files.keys());
    }
    let half: Vec<String> = files
        .iter()
        .filter_map(|(name, bytes)| what_is_half(name, bytes))
        .collect();
    assert!(half.is_empty(), "{half:?}");
}

#[test]
fn without_pictures_there_are_tables_and_the_answer_only() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&TABLES_ONLY).fine();
    let files = cell.files("out");
    let mut extensions: Vec<&str> = files
        .keys()
        .map(|name| name.rsplit('.').next().unwrap())
        .collect();
    extensions.sort_unstable();
    extensions.dedup();
    assert_eq!(extensions, ["csv", "json", "parquet", "vti", "vtp"]);
    // Parquet and VTK of four analyses, CSV of the map and the path, the result.
    assert_eq!(files.len(), 4 * 2 + 2 + 1);
}

#[test]
fn series_and_volumes_have_a_csv_on_request() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&TABLES_ONLY).fine();
    let files = || {
        let (mut files, answer) = (cell.files("out"), cell.answer("out"));
        files.remove("result.json");
        (files, answer)
    };
    let usual = files();
    assert!(!usual.0.contains_key("space.csv") && !usual.0.contains_key("distances.csv"));
    cell.armill(&EVERY_CSV).fine();
    let mut every = files();
    assert!(every.0.remove("space.csv").is_some() && every.0.remove("distances.csv").is_some());
    assert!(every == usual, "the flag changes other files");
}

#[test]
fn stale_files_of_a_run_are_removed_and_those_of_others_kept() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&["run", "study.toml"]).fine();
    cell.file("out/notes.txt", "mine");
    cell.file("out/groove.txt", "mine");
    cell.file("out/.armill-a1B2c3.part", "half a file of a killed run");
    cell.file("study.toml", SMALL);
    cell.armill(&TABLES_ONLY).fine();
    let names: Vec<String> = cell.files("out").into_keys().collect();
    let expected = [
        "groove.txt",
        "map.csv",
        "map.parquet",
        "map.vtp",
        "notes.txt",
        "result.json",
    ];
    assert_eq!(names, expected);
    assert!(!cell.at("out/.armill-a1B2c3.part").exists());
}

#[test]
fn a_table_has_one_row_a_point() {
    let cell = Cell::with_study(&every_kind());
    cell.armill(&EVERY_CSV).fine();
    for (name, points) in [
        ("plate.csv", 25),
        ("distances.csv", 50),
        ("space.csv", 27),
        ("groove.csv", 36),
    ] {
        let text = String::from_utf8(cell.files("out").remove(name).unwrap()).unwrap();
        let rows = text.lines().filter(|line| !line.starts_with('#')).count() - 1;
        assert_eq!(rows, points, "{name}");
    }
}

#[test]
fn json_on_stdout_is_the_answer_in_the_folder_and_talk_is_on_stderr() {
    let cell = Cell::with_study(SMALL);
    let said = cell
        .armill(&["run", "study.toml", "--no-pictures", "--json"])
        .fine();
    assert_eq!(said.json(), cell.answer("out"));
    // The same bytes, and behind them which files belong to the answer.
    let written = String::from_utf8(cell.files("out")["result.json"].clone()).unwrap();
    let answer = said.out.trim_end().strip_suffix('}').unwrap();
    assert!(
        written.starts_with(&format!("{answer},\"files\":{{")),
        "{written}"
    );
    assert!(said.err.contains("results in"), "{}", said.err);
}

#[test]
fn the_answer_in_words_is_one_line_with_its_numbers() {
    let said = Cell::with_study(SMALL).armill(&TABLES_ONLY).fine();
    assert_eq!(said.out.lines().count(), 1, "{}", said.out);
    assert!(
        said.out.contains("within 130 µm") && said.out.contains("largest contribution: joint U"),
        "{}",
        said.out
    );
}

#[test]
fn a_plane_out_of_reach_is_a_result_with_its_counts() {
    let cell = Cell::with_study(&SMALL.replace("[1000, 0, 800]", "[9000, 0, 800]"));
    let said = cell.armill(&["run", "study.toml"]).fine();
    assert!(said.out.contains("reaches no point"), "{}", said.out);
    let map = &cell.result("out")["maps"][0];
    assert_eq!(number(&map["counts"]["out_of_reach"]), 25.0);
    assert_eq!(
        (number(&map["fraction_within"]), &map["max_in_plane_um"]),
        (0.0, &Value::Null)
    );
    assert!(
        cell.result("out")["warnings"]
            .to_string()
            .contains("coordinates are in mm")
    );
}

#[test]
fn a_plane_half_in_reach_counts_both_halves() {
    let cell = Cell::with_study(
        &SMALL
            .replace("[1000, 0, 800]", "[1400, 0, 800]")
            .replace("= 100", "= 400"),
    );
    cell.armill(&["run", "study.toml"]).fine();
    let map = &cell.result("out")["maps"][0];
    assert_eq!(count(&map["counts"]), 17.0 * 17.0);
    assert!(
        number(&map["counts"]["out_of_reach"]) > 0.0 && number(&map["max_in_plane_um"]) > 0.0,
        "{}",
        map["counts"]
    );
    let reached = map["grid"]["in_plane_um"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|um| !um.is_null())
        .count();
    let given = number(&map["counts"]["within"]) + number(&map["counts"]["above_tolerance"]);
    assert_eq!(reached as f64, given);
}

#[test]
fn strict_exits_with_1_if_the_tolerance_is_not_met() {
    let exit = |study: &str| {
        Cell::with_study(study)
            .armill(&["run", "study.toml", "--no-pictures", "--strict"])
            .code
    };
    let wide = SMALL.replace("tolerance_um = 130", "tolerance_um = 1000");
    assert_eq!((exit(SMALL), exit(&wide)), (1, 0));
    let far = wide.replace("[1000, 0, 800]", "[9000, 0, 800]");
    assert_eq!(exit(&far), 1, "an unreachable point does not meet the tolerance");
    assert_eq!(
        Cell::with_study(SMALL).armill(&TABLES_ONLY).code,
        0,
        "without --strict a result is a result"
    );
}

#[test]
fn strict_looks_at_volumes_too() {
    let volume = "[[analysis]]\nkind = \"volume\"\nbox = { half_size_mm = [50, 50, 50], step_mm = 50 }\n";
    let exit = |limit: &str| {
        let study = format!("{}{volume}", SMALL.replace("tolerance_um = 130", limit));
        Cell::with_study(&study)
            .armill(&["run", "study.toml", "--no-pictures", "--strict"])
            .code
    };
    assert_eq!((exit("tolerance_um = 10"), exit("tolerance_um = 1000")), (1, 0));
}

#[test]
fn heights_of_the_controller_frame_give_the_map_450_mm_higher() {
    let cell = Cell::new();
    cell.file("floor/study.toml", SMALL);
    let lower = SMALL
        .replace("[1000, 0, 800]", "[1000, 0, 350]")
        .replace("base = \"base_link\"", "base = \"controller\"");
    cell.file("controller/study.toml", lower);
    let run = |folder: &str| {
        cell.armill(&["run", folder, "--no-pictures"]).fine();
        cell.result(&format!("{folder}/out"))["maps"][0].clone()
    };
    let (floor, controller) = (run("floor"), run("controller"));
    for (a, b) in numbers(&floor["grid"]["in_plane_um"])
        .iter()
        .zip(numbers(&controller["grid"]["in_plane_um"]))
    {
        // Reported to 1e-4 um.
        assert!((a - b).abs() <= 1e-4 + 1e-9, "{a} um and {b} um");
    }
    assert_eq!(numbers(&controller["setting"]["centre_mm"]), [1000.0, 0.0, 350.0]);
}

#[test]
fn a_path_with_blanks_and_letters_of_other_scripts_is_accepted() {
    let cell = Cell::new();
    cell.file("meine Größen/Zelle 1/Studie ü.toml", SMALL);
    let said = cell
        .armill(&[
            "run",
            "meine Größen/Zelle 1/Studie ü.toml",
            "--out",
            "Ergebnis für 見",
        ])
        .fine();
    assert!(said.err.contains("Ergebnis für 見"), "{}", said.err);
    assert!(cell.at("Ergebnis für 見/report.html").is_file());
}

#[test]
fn analyses_named_in_any_script_have_their_own_files() {
    let analyses = ["карта", "плита", "größe", "grüße", "面"]
        .map(|name| format!("[[analysis]]\nkind = \"map\"\nname = \"{name}\"\n"));
    let cell = Cell::with_study(&format!("{SMALL}{}", analyses.concat()));
    cell.armill(&TABLES_ONLY).fine();
    let files = cell.files("out");
    for name in ["карта.csv", "плита.csv", "größe.csv", "grüße.csv", "面.csv"] {
        assert!(files.contains_key(name), "no {name} among {:?}", files.keys());
    }
}

#[test]
fn names_and_titles_may_contain_anything() {
    let study = SMALL.replace("title = \"Small\"", r#"title = "</script> a\u0001 & 'b' \" <c>""#);
    let analysis = "[[analysis]]\nkind = \"map\"\nname = \"x<y & z \\u0007 ]]>\"\n";
    let cell = Cell::with_study(&format!("{study}{analysis}"));
    cell.armill(&["run", "study.toml"]).fine();
    let files = cell.files("out");
    let half: Vec<String> = files
        .iter()
        .filter_map(|(name, bytes)| what_is_half(name, bytes))
        .collect();
    assert!(half.is_empty(), "{half:?}");
    let report = String::from_utf8(files["report.html"].clone()).unwrap();
    assert!(
        !report.contains("</script> a") && !report.contains("<c>"),
        "the title is not escaped in the report"
    );
}

#[test]
fn planes_of_one_point_and_of_one_line_are_drawn_and_reported() {
    let analyses = "[[analysis]]\nkind = \"map\"\nname = \"point\"\nplane.half_size_mm = 0\n\
                [[analysis]]\nkind = \"map\"\nname = \"line\"\nplane.half_size_mm = [100, 0]\n\
                [[analysis]]\nkind = \"volume\"\nname = \"cell\"\nbox = { half_size_mm = [0, 0, 0], step_mm = 50 }\n\
                [[analysis]]\nkind = \"path\"\nname = \"dash\"\nline = { from_mm = [0, 0], to_mm = [1e-6, 0] }\n\
                [[analysis]]\nkind = \"map\"\nname = \"idle\"\ntolerance_um = 0\nload.cases_n = [[0, 0, 0]]\n";
    let cell = Cell::with_study(&format!("{SMALL}{analyses}"));
    cell.armill(&["run", "study.toml"]).fine();
    let result = cell.result("out");
    let points: Vec<f64> = result["maps"]
        .as_array()
        .unwrap()
        .iter()
        .map(|map| number(&map["grid"]["points"]))
        .collect();
    assert_eq!(points, [1.0, 5.0, 25.0]);
    assert_eq!(
        number(&result["maps"][2]["fraction_within"]),
        1.0,
        "no force, no deviation"
    );
    let files = cell.files("out");
    for (name, bytes) in files.iter().filter(|(name, _)| name.ends_with(".svg")) {
        let text = String::from_utf8_lossy(bytes);
        assert!(
            !text.contains("NaN") && !text.contains("\"inf"),
            "{name} has an invalid number"
        );
    }
}

#[test]
fn a_statement_is_read_against_maps_sections_and_paths() {
    let statement = "[[statement]]\ntext = \"within 0.2 mm\"\nsource = \"a paper\"\nat_most_um = 200\n\
                     of = [\"plate\", \"distances: x = 900 mm\", \"groove\"]\n";
    let cell = Cell::with_study(&format!("{}{statement}", every_kind()));
    let said = cell.armill(&TABLES_ONLY).fine();
    let readings = cell.result("out")["statements"][0]["readings"].clone();
    let names: Vec<&str> = readings
        .as_array()
        .unwrap()
        .iter()
        .map(|reading| reading["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["plate", "distances: x = 900 mm", "groove"]);
    for reading in readings.as_array().unwrap() {
        assert_eq!(
            reading["consistent"],
            numbers(&reading["in_plane_um"])[1] <= 200.0
        );
    }
    assert!(
        said.out.contains("consistent") && said.out.contains("does not mean confirmed"),
        "{}",
        said.out
    );
}

#[test]
fn an_older_answer_does_not_outlive_the_tables_it_belonged_to() {
    let cell = Cell::with_study(SMALL);
    cell.armill(&TABLES_ONLY).fine();
    // A folder in place of a table stops the second run after its work, while it writes.
    std::fs::remove_file(cell.at("out/map.vtp")).unwrap();
    std::fs::create_dir(cell.at("out/map.vtp")).unwrap();
    cell.file(
        "study.toml",
        SMALL.replace("tolerance_um = 130", "tolerance_um = 10"),
    );
    cell.armill(&TABLES_ONLY).refused(&["map.vtp"]);
    assert!(
        !cell.at("out/result.json").exists(),
        "the first result is together with tables of the second"
    );
}

#[test]
fn an_example_runs_from_an_empty_folder() {
    let cell = Cell::new();
    cell.armill(&["run", "mh12-groove", "--no-pictures", "--out", "groove"])
        .fine();
    let result = cell.result("groove");
    assert!(result["maps"].as_array().unwrap().len() > 20 && result["paths"].as_array().unwrap().len() >= 5);
    assert_eq!(result["robot"]["name"], "yaskawa/mh12");
}

#[test]
fn limits_of_another_source_are_a_warning_only_where_a_result_depends_on_them() {
    let warnings = |centre: &str, branch: &str| {
        let text = SMALL
            .replace("[1000, 0, 800]", centre)
            .replace("half_size_mm = 100", "half_size_mm = 400");
        let cell = Cell::with_study(&format!("{text}\n[posture]\nbranch = \"{branch}\"\n"));
        cell.armill(&["run", ".", "--no-pictures"]).fine();
        cell.result("out")["warnings"].clone()
    };
    // Neither the limits of joint U nor the frame of the controller matter.
    assert_eq!(warnings("[1000, 0, 800]", "nominal"), serde_json::json!([]));
    // U is at up to 200.7 deg; the robot file permits 150 deg, the other source 175 deg.
    let beyond = warnings("[800, 0, 1000]", "front elbow-down").to_string();
    let said = "Joint U may not reach all points: it is at 125.3 to 200.7 deg, and another source";
    assert!(
        beyond.contains(said) && beyond.contains("gives the limits -175 to 175 deg"),
        "{beyond}"
    );
    assert_eq!(beyond.matches("another source").count(), 1, "{beyond}");
    // All postures are within both limits, but points without one are lost at those of the robot file.
    let lost = warnings("[450, 0, 1000]", "best").to_string();
    let said = "Points outside the limits of joint U may be within reach: another source";
    assert!(lost.contains(said), "{lost}");
    assert_eq!(lost.matches("another source").count(), 1, "{lost}");
}

#[test]
fn the_description_of_a_robot_is_shown_with_it_and_is_no_warning_and_its_note_is_one() {
    let file = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../robots/yaskawa/mh12.toml"
    ));
    let file = file
        .unwrap()
        .replace("\ndescription = \"", "\nnote = \"Worn.\"\ndescription = \"");
    let cell = Cell::with_study(&SMALL.replace("yaskawa/mh12", "own.toml"));
    cell.file("own.toml", file);
    cell.armill(&["run", ".", "--no-pictures"]).fine();
    assert_eq!(cell.result("out")["warnings"], serde_json::json!(["Worn."]));
    let shown = cell.armill(&["robots", "own.toml"]).fine().out;
    assert!(
        shown.contains("Worn.\nThe robot frame of the Yaskawa controller"),
        "{shown}"
    );
    let json = cell.armill(&["robots", "own.toml", "--json"]).fine().json();
    assert_eq!(json["note"], "Worn.");
    let description = json["description"].as_str().unwrap();
    assert!(description.starts_with("The robot frame"), "{description}");
}

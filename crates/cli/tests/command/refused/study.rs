//! Study files that cannot be.

use std::time::{Duration, Instant};

use super::{check, check_text};
use crate::cell::{Cell, EVERY_KIND, LEVER, SMALL};

#[test]
fn an_unknown_field_is_named_with_its_place() {
    check("tolerance_um", "colour = 3\ntolerance_um").refused(&["study.toml:4:1", "unknown field `colour`"]);
}

#[test]
fn an_unknown_robot_is_reported_with_the_problems_of_the_fields() {
    let text = SMALL.replace("tolerance_um", "colour = 3\ntolerance_um");
    let named = text
        .find("robot = ")
        .map(|at| &text[at..])
        .and_then(|rest| rest.lines().next());
    let text = text.replace(named.unwrap(), "robot = \"yaskawa/mh13\"");
    check_text(text).refused(&["unknown field `colour`", "yaskawa/mh13", "did you mean"]);
}

#[test]
fn a_slip_in_a_field_is_reported_with_the_field_meant() {
    check("half_size_mm", "halfsize_mm").refused(&["study.toml:9:1", "half_size_mm"]);
}

/// The keys and values of a study that CHANGELOG.md lists as renamed, in the table that has the new name.
#[test]
fn every_renamed_key_and_value_is_refused_with_its_present_name() {
    let cut = "material = \"aluminium-7075\"\ndiameter_mm = 8\nteeth = 4\naxial_depth_mm = 1\n";
    let measured = "file = \"f.csv\"\nacts_on = \"tool\"\nframe = \"base\"\n";
    let renamed_keys = [
        ("", "limit_um", "60", "tolerance_um"),
        ("", "actual_robot", "\"measured.toml\"", "calibrated_robot"),
        ("", "ask", "[{ kind = \"map\" }]", "analysis"),
        ("measured", "ask", "\"a\"", "analysis"),
        ("[ballbar]", "ask", "\"a\"", "analysis"),
        ("place", "ask", "\"a\"", "analysis"),
        ("posture.search", "counts", "\"in-plane\"", "component"),
        ("posture.search", "goal", "\"worst\"", "objective"),
        ("place", "counts", "\"in-plane\"", "component"),
        ("place", "goal", "\"worst\"", "objective"),
        ("place", "sure", "\"likely\"", "rank_by"),
        ("tool", "u_length_mm", "0.1", "length_u_mm"),
        ("cut", "greatest", "true", "peak"),
        ("cut", "feed_mm_min", "600", "feed_mm_per_min"),
        ("[analysis]", "program.measured.value", "\"extremes\"", "peak"),
        (
            "[analysis]",
            "program.measured.feed_mm_min",
            "600",
            "feed_mm_per_min",
        ),
        (
            "[analysis]",
            "program.measured.rapid_mm_min",
            "600",
            "rapid_mm_per_min",
        ),
    ];
    for (table, old, value, new) in renamed_keys {
        let line = format!("{old} = {value}\n");
        let text = match table {
            "" => format!("{line}{SMALL}"),
            "cut" => format!("{SMALL}[cut]\n{cut}{line}"),
            table => format!("{SMALL}[{table}]\n{line}"),
        };
        let key = old.rsplit('.').next().unwrap();
        check_text(text).refused(&[
            "unknown field `",
            &format!("{key}`"),
            &format!("`{key}` was renamed: write `{new}`"),
        ]);
    }
    let renamed_values = [
        ("[posture.search]\nobjective = \"above-limit\"", "above-tolerance"),
        ("[place]\nobjective = \"above-limit\"", "above-tolerance"),
        ("[place]\nrank_by = \"within-limit\"", "within-tolerance"),
        ("[[analysis]]\nkind = \"program\"", "path"),
        (
            &format!(
                "[[analysis]]\nkind = \"path\"\n[analysis.program.measured]\n{measured}synchronise = \"start\""
            ),
            "threshold",
        ),
    ];
    for (lines, new) in renamed_values {
        check_text(format!("{SMALL}{lines}\n"))
            .refused(&["must be one of", &format!("did you mean \"{new}\"?")]);
    }
}

#[test]
fn a_missing_unit_suffix_is_named() {
    check("step_mm", "step").refused(&[
        "study.toml:10:1",
        "`plane.step`",
        "lengths carry their unit: write `step_mm`",
    ]);
    check("tolerance_um", "tolerance").refused(&["study.toml:4:1", "tolerance_um"]);
    check("cases_n", "cases").refused(&["study.toml:13:1", "cases_n"]);
}

#[test]
fn an_invalid_number_is_reported_with_its_line() {
    for none in ["nan", "-nan", "inf", "-inf", "1e400"] {
        check("step_mm = 50", &format!("step_mm = {none}")).refused(&[
            "study.toml:10:11",
            "`plane.step_mm`",
            "finite",
        ]);
        check("[1000, 0, 800]", &format!("[{none}, 0, 800]")).refused(&["study.toml:7:14", "finite"]);
    }
}

#[test]
fn an_implausible_number_is_reported_with_its_limit_and_unit() {
    check("[[3, 5, 5]", "[[1e308, 1e308, 5]").refused(&["study.toml:13:13", "1e308 N", "at most 1000000 N"]);
    let tool = |pose: &str| check_text(format!("{SMALL}[tool]\nflange_from_tool_mm_deg = {pose}\n"));
    tool("[0, 0, 1e9, 0, 0, 0]").refused(&["1e9 mm", "must be at most"]);
    tool("[0, 0, 1, 0, 0, 1e9]").refused(&["1e9 deg", "must be at most"]);
    tool("\"x\"").refused(&["6 numbers in mm and deg"]);
    check("[1000, 0, 800]", "[1e305, 0, 800]").refused(&["study.toml:7:14", "1e305 mm", "at most 1000000"]);
}

#[test]
fn lengths_that_must_be_above_0_are_refused_otherwise() {
    check("step_mm = 50", "step_mm = 0").refused(&[
        "study.toml:10:11",
        "`plane.step_mm` is 0 mm",
        "at least 0.001 mm",
    ]);
    check("step_mm = 50", "step_mm = -5").refused(&["`plane.step_mm` is -5 mm"]);
    check("half_size_mm = 100", "half_size_mm = -1").refused(&[
        "study.toml:9:16",
        "`plane.half_size_mm` is -1 mm",
        "must be",
    ]);
    check("tolerance_um = 130", "tolerance_um = -1").refused(&[
        "study.toml:4:16",
        "`tolerance_um` is -1 um",
        "at least 0 um",
    ]);
    check("tilt_deg = 0", "tilt_deg = 200").refused(&["study.toml:8:12", "200 deg", "at most 180"]);
}

#[test]
fn a_negative_compliance_is_reported_with_its_place_and_unit() {
    let own = "\n[compliance]\nrad_per_n_m = [1e-6, 1e-6, -2e-6, 1e-6, 1e-6, 1e-6]\nsource = \"a guess\"\n";
    check_text(format!("{SMALL}{own}")).refused(&["study.toml:16:28", "-2e-6", "at least 0"]);
}

#[test]
fn a_wrong_number_of_compliances_is_reported_with_the_right_one() {
    let own = "\n[compliance]\nrad_per_n_m = [1e-6, 1e-6]\nsource = \"a guess\"\n";
    check_text(format!("{SMALL}{own}")).refused(&["study.toml:16", "2 values for the 6 joints"]);
}

#[test]
fn an_empty_load_is_reported() {
    check("[[3, 5, 5], [3, -5, 5]]", "[]").refused(&[
        "study.toml:13:11",
        "the load has no case",
        "cases_n = [[3, 5, 5]]",
    ]);
}

#[test]
fn moments_are_one_a_case() {
    check("cases_n", "moments_n_m = [[0, 0, 1]]\ncases_n")
        .refused(&["study.toml:13", "1 moments for 2 cases"]);
}

#[test]
fn an_unknown_robot_is_reported_with_the_one_meant() {
    check("yaskawa/mh12", "yaskawa/mh21").refused(&[
        "study.toml:3:9",
        "`yaskawa/mh21`",
        "did you mean `yaskawa/mh12`?",
    ]);
    Cell::new()
        .armill(&["robots", "mh12"])
        .refused(&["did you mean `yaskawa/mh12`?"]);
}

#[test]
fn a_robot_without_compliance_is_refused_with_what_to_add() {
    let words = [
        "study.toml:3:9",
        "no joint compliance is known",
        "[compliance]",
        "armill identify",
        "rad_per_n_m",
        "class = \"...\"",
    ];
    check("yaskawa/mh12", "kuka/kr120r2500pro").refused(&words);
}

#[test]
fn a_robot_of_too_few_joints_is_reported_in_a_study() {
    let cell = Cell::with_study(&SMALL.replace("yaskawa/mh12", "lever.toml"));
    cell.file("lever.toml", LEVER);
    cell.armill(&["run", "."])
        .refused(&["study.toml:3:9", "`lever.toml` has 2 joints"]);
}

#[test]
fn a_missing_robot_file_is_reported_with_the_path_that_was_tried() {
    let cell = Cell::new();
    cell.file("deep/study.toml", SMALL.replace("yaskawa/mh12", "arm.urdf"));
    cell.armill(&["check", "deep"])
        .refused(&["deep/study.toml:3:9", "deep/arm.urdf", "folder of the study"]);
}

#[test]
fn problems_of_a_robot_file_are_reported_at_the_robot_file() {
    let cell = Cell::with_study(&SMALL.replace("yaskawa/mh12", "lever.toml"));
    cell.file("lever.toml", LEVER.replace("[-100, 120]", "[120, -100]"));
    cell.armill(&["check", "."]).refused(&[
        "lever.toml:14:",
        "lower limit 120 deg is not below upper limit -100 deg",
    ]);
}

#[test]
fn an_unknown_frame_or_branch_is_reported_with_the_valid_ones() {
    check("base_link", "flor").refused(&["study.toml:2:8", "no frame `flor`", "base_link, controller"]);
    let posture = format!("{SMALL}\n[posture]\nbranch = \"sideways\"\n");
    check_text(posture).refused(&[
        "study.toml:16:10",
        "`sideways`",
        "elbow-up",
        "`nominal` or `best`",
    ]);
}

#[test]
fn a_grid_of_a_billion_points_is_refused_at_once_with_its_memory() {
    for (step, words) in [
        (
            "0.0063",
            [
                "points under 2 load cases would take",
                "GiB of memory, more than 4 GiB",
            ],
        ),
        (
            "1e-8",
            ["`plane.step_mm` is 1e-8 mm", "must be at least 0.001 mm"],
        ),
        (
            "1e-300",
            ["`plane.step_mm` is 1e-300 mm", "must be at least 0.001 mm"],
        ),
    ] {
        let start = Instant::now();
        check("step_mm = 50", &format!("step_mm = {step}"))
            .refused(&words)
            .refused(&["study.toml:10:11"]);
        // Two starts of a program; a billion points take ten minutes and more.
        assert!(
            start.elapsed() < Duration::from_secs(300),
            "{:?}",
            start.elapsed()
        );
    }
}

#[test]
fn boxes_paths_and_sections_are_measured_before_they_are_made() {
    let analysis = |analysis: &str, words: &[&str]| {
        check_text(format!("{SMALL}[[analysis]]\n{analysis}\n")).refused(words)
    };
    let memory = ["points under 2 load cases would take", "GiB", "study.toml:"];
    analysis(
        "kind = \"volume\"\nbox = { half_size_mm = [500, 500, 500], step_mm = 1 }",
        &memory,
    );
    let count = ["points, more than 8000000", "study.toml:"];
    analysis("kind = \"path\"\ncircle.radius_mm = 1e4\nstep_mm = 0.001", &count);
    analysis(
        "kind = \"path\"\nline = { from_mm = [0, 0], to_mm = [1e4, 0] }\nstep_mm = 0.001",
        &count,
    );
    let least = ["step_mm` is 1e-30 mm: must be at least 0.001 mm", "study.toml:"];
    analysis("kind = \"path\"\ncircle.radius_mm = 100\nstep_mm = 1e-30", &least);
    analysis(
        "kind = \"volume\"\nbox = { half_size_mm = [1, 1, 1], step_mm = 1e-30 }",
        &least,
    );
    analysis("kind = \"map\"\nplane.step_mm = 1e-30", &least);
    analysis(
        "kind = \"path\"\nprogram = { file = \"a.ngc\", step_mm = 1e-30 }",
        &least,
    );
    let chord = ["chord_error_mm` is 1e-30 mm: must be at least 0.000001 mm"];
    analysis(
        "kind = \"path\"\nprogram = { file = \"a.ngc\", chord_error_mm = 1e-30 }",
        &chord,
    );
}

#[test]
fn analyses_that_fit_individually_but_not_together_are_refused() {
    // 2.4 million points a section, some 2.1 GiB; three of them are in memory at once.
    let sections =
        "[[analysis]]\nkind = \"sections\"\ndistances_mm = [900, 1000, 1100]\nplane.step_mm = 0.13\n";
    check_text(format!("{SMALL}{sections}")).refused(&["all analyses together", "GiB", "more than 4 GiB"]);
}

#[test]
fn load_cases_are_part_of_the_memory_that_is_bounded() {
    let cases = |count: usize| SMALL.replace("[3, 5, 5], [3, -5, 5]", &vec!["[3, 5, 5]"; count].join(", "));
    // 441 points take 172 bytes a case and more.
    let fits = cases(2000).replace("step_mm = 50", "step_mm = 10");
    Cell::with_study(&fits).armill(&["check", "study.toml"]).fine();
    let too_many = cases(100_000).replace("step_mm = 50", "step_mm = 10");
    check_text(too_many).refused(&[
        "441 points under 100000 load cases would take",
        "GiB of memory, more than 4 GiB",
    ]);
}

#[cfg(target_os = "linux")]
#[test]
fn the_memory_of_a_study_is_at_most_the_estimate() {
    let study = |step: f64| {
        let cases = ["[3, 5, 5]"; 8].join(", ");
        let small = SMALL.replace("[3, 5, 5], [3, -5, 5]", &cases);
        format!(
            "{small}[[analysis]]\nkind = \"volume\"\nbox = {{ half_size_mm = [100, 100, 100], step_mm = {step} }}\n"
        )
    };
    // Too many points: the message has the memory of one of them.
    let refused = check_text(study(0.5)).err;
    let number = |before: &str| -> f64 {
        let (text, _) = refused.split_once(before).unwrap();
        text.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let bytes_per_point = number(" GiB of memory") * f64::from(1 << 30) / number(" points under 8");
    let points = f64::from(61_u32.pow(3));
    let cell = Cell::with_study(&study(3.33));
    // One thread, one arena: the program itself uses some 100 MB of addresses.
    let fits_in = |bytes: f64| {
        let kib = (bytes / 1024.0) as u64;
        let run = format!(
            "ulimit -v {kib}; exec '{}' run study.toml --no-pictures",
            crate::cell::ARMILL
        );
        let mut command = std::process::Command::new("sh");
        command
            .args(["-c", &run])
            .env("RAYON_NUM_THREADS", "1")
            .env("MALLOC_ARENA_MAX", "1")
            .current_dir(cell.path());
        command.output().unwrap().status.success()
    };
    let estimated = bytes_per_point * points;
    assert!(
        fits_in(200e6 + estimated),
        "{bytes_per_point} bytes a point are too few"
    );
    assert!(
        !fits_in(60e6 + 0.4 * estimated),
        "{bytes_per_point} bytes a point are far too many"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_grid_too_large_is_refused_without_allocating_it() {
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.0063"));
    // The shell bounds the address space, KiB: a hundredth of what the points would take.
    let script = format!(
        "ulimit -v 1000000; exec '{}' check study.toml",
        crate::cell::ARMILL
    );
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(cell.path())
        .output()
        .unwrap();
    assert_eq!(
        output.status.code(),
        Some(2),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(String::from_utf8_lossy(&output.stderr).contains("GiB of memory"));
}

#[test]
fn every_problem_of_a_file_is_reported_at_once() {
    let broken = SMALL
        .replace("yaskawa/mh12", "yaskawa/mh21")
        .replace("step_mm = 50", "step_mm = 0")
        .replace("half_size_mm = 100", "half_size_mm = -1")
        .replace("[[3, 5, 5], [3, -5, 5]]", "[]");
    let analyses = "[posture]\nbranch = \"sideways\"\n[[analysis]]\nkind = \"volume\"\n[[analysis]]\nkind = \"path\"\n\
                [[analysis]]\nkind = \"sections\"\n[[analysis]]\nkind = \"map\"\ncircle.radius_mm = 3\n";
    check_text(format!("{broken}{analyses}")).refused(&[
        "did you mean `yaskawa/mh12`?",
        "`plane.step_mm` is 0 mm",
        "-1 mm",
        "the load has no case",
        "`sideways`",
        "a volume needs its `box`",
        "a path has exactly one shape",
        "sections vary either",
        "`circle` is not valid for a map",
    ]);
    let fields = SMALL
        .replace("step_mm", "step")
        .replace("tolerance_um", "tolerance")
        .replace("[1000, 0, 800]", "[1000, \"0\"]");
    check_text(fields).refused(&["write `step_mm`", "write `tolerance_um`", "study.toml:7:"]);
}

#[test]
fn a_value_used_by_several_analyses_is_reported_once() {
    let said = check_text(format!(
        "{}{EVERY_KIND}",
        SMALL.replace("[[3, 5, 5], [3, -5, 5]]", "[]")
    ));
    assert_eq!(said.err.matches("error:").count(), 1, "{}", said.err);
}

#[test]
fn problems_as_json_have_file_line_and_hint() {
    let cell = Cell::with_study(
        &SMALL
            .replace("step_mm", "step")
            .replace("tolerance_um", "tolerance"),
    );
    for command in ["check", "run"] {
        let said = cell.armill(&[command, "study.toml", "--json"]).refused(&[]);
        let problems = said.json()["problems"].clone();
        // Two unknown fields, and the two that are missing for them.
        assert!(problems.as_array().unwrap().len() >= 2, "{problems}");
        for problem in problems.as_array().unwrap() {
            assert_eq!(problem["file"], "study.toml");
            assert!(
                problem["line"].as_u64().is_some() && problem["message"].as_str().is_some(),
                "{problem}"
            );
        }
    }
    let said = Cell::new().armill(&["run", "nowhere", "--json"]).refused(&[]);
    let problem = said.json()["problems"][0].clone();
    assert!(
        !problem["message"].as_str().unwrap().contains("help:"),
        "{problem}"
    );
    assert!(
        problem["hint"].as_str().unwrap().contains("armill new"),
        "{problem}"
    );
}

#[test]
fn windows_line_ends_and_a_byte_order_mark_are_accepted() {
    for text in [
        SMALL.replace('\n', "\r\n"),
        format!("\u{feff}{SMALL}"),
        format!("\u{feff}{}", SMALL.replace('\n', "\r\n")),
    ] {
        Cell::with_study(&text).armill(&["check", "study.toml"]).fine();
    }
    // Lines are counted in the same way.
    check_text(SMALL.replace("step_mm", "step").replace('\n', "\r\n")).refused(&["study.toml:10:1"]);
    check_text(format!("\u{feff}{}", SMALL.replace("format = 1", "formt = 1")))
        .refused(&["study.toml:1:1", "`format`"]);
}

#[test]
fn bytes_that_are_not_text_are_reported_with_their_position() {
    check_text([SMALL.as_bytes(), b"# \xff\n"].concat()).refused(&["study.toml:14:3", "0xff", "UTF-8"]);
    let cell = Cell::new();
    cell.file("arm.toml", [LEVER.as_bytes(), b"# \xff\n"].concat());
    cell.armill(&["robots", "arm.toml"])
        .refused(&["arm.toml:", "0xff", "UTF-8"]);
}

#[test]
fn a_file_that_is_not_toml_is_reported_with_its_line() {
    for text in [
        "",
        "format = 1",
        "format = ",
        "[[[",
        "\0",
        "{\"format\": 1}",
        "format = 2\n",
    ] {
        check_text(text).refused(&["study.toml:"]);
    }
    check("format = 1", "format = 2").refused(&["study.toml:1:10", "`format` is 2", "at most 1"]);
    check_text("a".repeat(1 << 20)).refused(&["study.toml:1:"]);
    check_text(format!("x = {}", "[".repeat(100_000))).refused(&["study.toml:1:"]);
}

#[test]
fn a_missing_study_is_reported_with_a_hint() {
    let cell = Cell::new();
    std::fs::create_dir(cell.at("empty")).unwrap();
    cell.armill(&["run", "nowhere"])
        .refused(&["no study at nowhere", "armill new DIR", "mh12-groove"]);
    cell.armill(&["run", "empty"])
        .refused(&["no study at empty/study.toml"]);
    cell.armill(&["check", "empty"])
        .refused(&["no study at empty/study.toml"]);
    std::fs::create_dir(cell.at("empty/study.toml")).unwrap();
    cell.armill(&["run", "empty"]).refused(&["empty/study.toml"]);
}

#[test]
fn two_analyses_never_write_the_same_files() {
    let named = |names: &[&str]| {
        let analyses: String = names
            .iter()
            .map(|name| format!("[[analysis]]\nkind = \"map\"\n{name}\n"))
            .collect();
        check_text(format!("{SMALL}{analyses}"))
    };
    named(&["name = \"plate\"", "name = \"Plate!\""])
        .refused(&["`plate` and `Plate!` would write the same files"]);
    named(&["", "name = \"map 1\""]).refused(&["`map 1` and `map 1` would write the same files"]);
    named(&["name = \"...\""]).refused(&["`...` has no letter and no digit"]);
    named(&["name = \"\""]).refused(&["no letter and no digit"]);
    named(&[&format!("name = \"{}\"", "n".repeat(300))]).refused(&["300 bytes", "160"]);
}

#[test]
fn a_statement_without_an_analysis_is_reported() {
    let of = |name: &str| {
        let statement = "[[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = 70\n";
        check_text(format!("{SMALL}{EVERY_KIND}{statement}of = [\"{name}\"]\n"))
    };
    of("plat").refused(&["no analysis is called `plat`"]);
    of("distances").refused(&["`distances` is a series of sections", "`distances: x = 900 mm`"]);
    of("space").refused(&["`space` is a volume"]);
}

#[test]
fn a_thermal_growth_out_of_range_is_refused_with_its_unit() {
    let with = |table: &str| check_text(format!("{SMALL}[thermal]\n{table}\n"));
    with("difference_k = 500").refused(&["`thermal.difference_k` is 500 K", "at most 100 K"]);
    with("u_k = 1").refused(&["missing field `thermal.difference_k`"]);
    with("difference_k = 5\nexpansion_per_k = 12")
        .refused(&["`thermal.expansion_per_k` is 12 1/K", "0.0001 1/K"]);
    with("difference_k = 5\nu = 1").refused(&["unknown field `thermal.u`", "write `u_k`"]);
}

//! What is refused, with what words: file, line, value, limit, unit; and that it is always exit code 2.

mod cell;

use std::time::{Duration, Instant};

use cell::{Cell, EVERY_KIND, LEVER, MH12_URDF, SMALL, Said};

/// What `armill check` says to [`SMALL`] with one thing changed; `run` must refuse it alike and write nothing.
fn check(from: &str, to: &str) -> Said {
    assert!(SMALL.contains(from), "the sample has no `{from}`");
    check_text(SMALL.replacen(from, to, 1))
}

fn check_text(text: impl AsRef<[u8]>) -> Said {
    let cell = Cell::new();
    cell.file("study.toml", text);
    let run = cell.armill(&["run", "study.toml"]).refused(&[]);
    let checked = cell.armill(&["check", "study.toml"]);
    assert_eq!(checked.err, run.err, "check and run do not say the same");
    assert!(
        !cell.at("out").exists(),
        "a folder was made for a study that cannot run"
    );
    assert_eq!(checked.out, "", "problems are talk, not a result");
    checked
}

/// What `armill pose` says to [`LEVER`] with one thing changed.
fn lever(from: &str, to: &str) -> Said {
    assert!(LEVER.contains(from), "the sample has no `{from}`");
    let cell = Cell::new();
    cell.file("lever.toml", LEVER.replacen(from, to, 1));
    cell.armill(&["pose", "lever.toml", "--joints-deg", "0,0"])
}

fn pose(arguments: &[&str]) -> Said {
    Cell::new().armill(&[&["pose", "yaskawa/mh12"], arguments].concat())
}

// ---- Study files

#[test]
fn an_unknown_field_is_named_with_its_place() {
    check("limit_um", "colour = 3\nlimit_um").refused(&["study.toml:4:1", "unknown field `colour`"]);
}

#[test]
fn a_slip_in_a_field_is_told_with_the_field_meant() {
    check("half_size_mm", "halfsize_mm").refused(&["study.toml:9:1", "half_size_mm"]);
}

#[test]
fn a_missing_unit_suffix_is_named() {
    check("step_mm", "step").refused(&[
        "study.toml:10:1",
        "`plane.step`",
        "lengths carry their unit: write `step_mm`",
    ]);
    check("limit_um", "limit").refused(&["study.toml:4:1", "limit_um"]);
    check("cases_n", "cases").refused(&["study.toml:13:1", "cases_n"]);
}

#[test]
fn a_number_that_is_none_is_told_with_its_line() {
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
fn a_number_beyond_all_reason_is_told_with_its_limit_and_unit() {
    check("[[3, 5, 5]", "[[1e308, 1e308, 5]").refused(&[
        "study.toml:13:13",
        "1e308 N",
        "at most 1000000000 N",
    ]);
    check("[1000, 0, 800]", "[1e305, 0, 800]").refused(&["study.toml:7:14", "1e305 mm", "at most 1000000"]);
}

#[test]
fn lengths_that_must_be_above_0_say_so() {
    check("step_mm = 50", "step_mm = 0").refused(&[
        "study.toml:10:11",
        "`plane.step_mm` is 0 mm",
        "above 0 mm",
    ]);
    check("step_mm = 50", "step_mm = -5").refused(&["`plane.step_mm` is -5 mm"]);
    check("half_size_mm = 100", "half_size_mm = -1").refused(&[
        "study.toml:9:16",
        "`plane.half_size_mm` is -1 mm",
        "must be",
    ]);
    check("limit_um = 130", "limit_um = -1").refused(&[
        "study.toml:4:12",
        "`limit_um` is -1 um",
        "at least 0 um",
    ]);
    check("tilt_deg = 0", "tilt_deg = 200").refused(&["study.toml:8:12", "200 deg", "at most 180"]);
}

#[test]
fn a_negative_compliance_is_told_with_its_place_and_unit() {
    let own = "\n[compliance]\nrad_per_n_m = [1e-6, 1e-6, -2e-6, 1e-6, 1e-6, 1e-6]\nsource = \"a guess\"\n";
    check_text(format!("{SMALL}{own}")).refused(&["study.toml:16:28", "-2e-6", "at least 0"]);
}

#[test]
fn a_wrong_number_of_compliances_is_told_with_the_right_one() {
    let own = "\n[compliance]\nrad_per_n_m = [1e-6, 1e-6]\nsource = \"a guess\"\n";
    check_text(format!("{SMALL}{own}")).refused(&["study.toml:16", "2 values for the 6 joints"]);
}

#[test]
fn an_empty_load_is_told() {
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
fn an_unknown_robot_is_told_with_the_one_meant() {
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
fn a_robot_without_compliance_is_told_what_to_add() {
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
fn a_robot_of_too_few_joints_is_told_in_a_study() {
    let cell = Cell::with_study(&SMALL.replace("yaskawa/mh12", "lever.toml"));
    cell.file("lever.toml", LEVER);
    cell.armill(&["run", "."])
        .refused(&["study.toml:3:9", "`lever.toml` has 2 joints"]);
}

#[test]
fn a_missing_robot_file_is_told_with_the_path_that_was_tried() {
    let cell = Cell::new();
    cell.file("deep/study.toml", SMALL.replace("yaskawa/mh12", "arm.urdf"));
    cell.armill(&["check", "deep"])
        .refused(&["deep/study.toml:3:9", "deep/arm.urdf", "folder of the study"]);
}

#[test]
fn problems_of_a_robot_file_are_told_at_the_robot_file() {
    let cell = Cell::with_study(&SMALL.replace("yaskawa/mh12", "lever.toml"));
    cell.file("lever.toml", LEVER.replace("[-100, 120]", "[120, -100]"));
    cell.armill(&["check", "."]).refused(&[
        "lever.toml:14:",
        "lower limit 120 deg is not below upper limit -100 deg",
    ]);
}

#[test]
fn a_frame_or_branch_that_is_none_is_told_with_those_that_are() {
    check("limit_um", "base = \"flor\"\nlimit_um").refused(&[
        "study.toml:4:8",
        "no frame `flor`",
        "base_link, controller",
    ]);
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
        ("0.0063", ["points would take", "GiB of memory, more than 4 GiB"]),
        ("1e-8", ["points would take", "GiB of memory, more than 4 GiB"]),
        ("1e-300", ["points would take", "GiB of memory, more than 4 GiB"]),
    ] {
        let start = Instant::now();
        check("step_mm = 50", &format!("step_mm = {step}"))
            .refused(&words)
            .refused(&["study.toml:10:11"]);
        // Two starts of a program; a billion points take minutes.
        assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    }
}

#[test]
fn boxes_paths_and_sections_are_measured_before_they_are_made() {
    let ask = |ask: &str, words: &[&str]| check_text(format!("{SMALL}[[ask]]\n{ask}\n")).refused(words);
    let memory = ["points would take", "GiB", "study.toml:"];
    ask(
        "kind = \"volume\"\nbox = { half_size_mm = [500, 500, 500], step_mm = 1 }",
        &memory,
    );
    let count = ["points, more than 8000000", "study.toml:"];
    ask("kind = \"path\"\ncircle.radius_mm = 100\nstep_mm = 1e-7", &count);
    ask(
        "kind = \"path\"\nline = { from_mm = [0, 0], to_mm = [100, 0] }\nstep_mm = 1e-300",
        &count,
    );
}

#[test]
fn asks_that_fit_one_by_one_but_not_together_are_refused() {
    // 7 million points a section, some 2.9 GiB; three of them are held at once.
    let sections = "[[ask]]\nkind = \"sections\"\ndistances_mm = [900, 1000, 1100]\nplane.step_mm = 0.0756\n";
    check_text(format!("{SMALL}{sections}")).refused(&["all asks together", "GiB", "more than 4 GiB"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_grid_too_large_is_refused_without_allocating_it() {
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.0063"));
    // The shell bounds the address space, KiB: a hundredth of what the points would take.
    let script = format!("ulimit -v 1000000; exec '{}' check study.toml", cell::ARMILL);
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
fn every_problem_of_a_file_is_told_at_once() {
    let broken = SMALL
        .replace("yaskawa/mh12", "yaskawa/mh21")
        .replace("step_mm = 50", "step_mm = 0")
        .replace("half_size_mm = 100", "half_size_mm = -1")
        .replace("[[3, 5, 5], [3, -5, 5]]", "[]");
    let asks = "[posture]\nbranch = \"sideways\"\n[[ask]]\nkind = \"volume\"\n[[ask]]\nkind = \"path\"\n\
                [[ask]]\nkind = \"sections\"\n[[ask]]\nkind = \"map\"\ncircle.radius_mm = 3\n";
    check_text(format!("{broken}{asks}")).refused(&[
        "did you mean `yaskawa/mh12`?",
        "`plane.step_mm` is 0 mm",
        "-1 mm",
        "the load has no case",
        "`sideways`",
        "a volume needs its `box`",
        "a path has exactly one shape",
        "sections vary either",
        "`circle` means nothing to a map",
    ]);
    let fields = SMALL
        .replace("step_mm", "step")
        .replace("limit_um", "limit")
        .replace("[1000, 0, 800]", "[1000, \"0\"]");
    check_text(fields).refused(&["write `step_mm`", "write `limit_um`", "study.toml:7:"]);
}

#[test]
fn a_value_that_several_asks_take_is_wrong_once() {
    let said = check_text(format!(
        "{}{EVERY_KIND}",
        SMALL.replace("[[3, 5, 5], [3, -5, 5]]", "[]")
    ));
    assert_eq!(said.err.matches("error:").count(), 1, "{}", said.err);
}

#[test]
fn problems_as_json_have_file_line_and_hint() {
    let cell = Cell::with_study(&SMALL.replace("step_mm", "step").replace("limit_um", "limit"));
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
fn windows_line_ends_and_a_byte_order_mark_are_taken() {
    for text in [
        SMALL.replace('\n', "\r\n"),
        format!("\u{feff}{SMALL}"),
        format!("\u{feff}{}", SMALL.replace('\n', "\r\n")),
    ] {
        Cell::with_study(&text).armill(&["check", "study.toml"]).fine();
    }
    // Lines are counted alike.
    check_text(SMALL.replace("step_mm", "step").replace('\n', "\r\n")).refused(&["study.toml:10:1"]);
    check_text(format!("\u{feff}{}", SMALL.replace("format = 1", "formt = 1")))
        .refused(&["study.toml:1:1", "`format`"]);
}

#[test]
fn bytes_that_are_no_text_are_told_with_their_place() {
    check_text([SMALL.as_bytes(), b"# \xff\n"].concat()).refused(&["study.toml:14:3", "0xff", "UTF-8"]);
    let cell = Cell::new();
    cell.file("arm.toml", [LEVER.as_bytes(), b"# \xff\n"].concat());
    cell.armill(&["robots", "arm.toml"])
        .refused(&["arm.toml:", "0xff", "UTF-8"]);
}

#[test]
fn what_is_no_toml_is_told_with_its_line() {
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
fn a_missing_study_is_told_with_what_to_do() {
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
fn two_asks_never_write_the_same_files() {
    let named = |names: &[&str]| {
        let asks: String = names
            .iter()
            .map(|name| format!("[[ask]]\nkind = \"map\"\n{name}\n"))
            .collect();
        check_text(format!("{SMALL}{asks}"))
    };
    named(&["name = \"plate\"", "name = \"Plate!\""])
        .refused(&["`plate` and `Plate!` would write the same files"]);
    named(&["", "name = \"map 1\""]).refused(&["`map 1` and `map 1` would write the same files"]);
    named(&["name = \"...\""]).refused(&["`...` has no letter and no digit"]);
    named(&["name = \"\""]).refused(&["no letter and no digit"]);
    named(&[&format!("name = \"{}\"", "n".repeat(300))]).refused(&["300 bytes", "160"]);
}

#[test]
fn a_statement_of_nothing_that_was_asked_is_told() {
    let of = |name: &str| {
        let statement = "[[statement]]\ntext = \"t\"\nsource = \"s\"\nat_most_um = 70\n";
        check_text(format!("{SMALL}{EVERY_KIND}{statement}of = [\"{name}\"]\n"))
    };
    of("plat").refused(&["no ask is called `plat`"]);
    of("distances").refused(&["`distances` is a series of sections", "`distances: x = 900 mm`"]);
    of("space").refused(&["`space` is a volume"]);
}

// ---- Where results go

#[test]
fn a_folder_that_cannot_be_written_is_told_before_any_work() {
    let cell = Cell::with_study(&SMALL.replace("step_mm = 50", "step_mm = 0.2"));
    cell.file("in the way", "a file");
    let start = Instant::now();
    cell.armill(&["run", "study.toml", "--out", "in the way"])
        .refused(&["`in the way`", "is a file"]);
    cell.armill(&["run", "study.toml", "--out", "in the way/deeper"])
        .refused(&["`in the way`", "is a file"]);
    #[cfg(target_os = "linux")]
    for folder in ["/proc/armill", "/proc"] {
        cell.armill(&["run", "study.toml", "--out", folder])
            .refused(&["cannot write", folder]);
    }
    // A million points take several seconds in a debug build; four starts of a program do not.
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    assert_eq!(std::fs::read(cell.at("in the way")).unwrap(), b"a file");
}

// ---- Robot files

#[test]
fn reversed_limits_of_a_joint_are_told_with_both() {
    let words = [
        "lever.toml:14:14",
        "joint A: lower limit 120 deg is not below upper limit -100 deg",
        "[lower, upper]",
    ];
    lever("[-100, 120]", "[120, -100]").refused(&words);
}

#[test]
fn a_negative_compliance_of_a_joint_is_told() {
    lever("= 2e-6", "= -2e-6").refused(&["lever.toml:16:", "compliance_rad_per_n_m", "-2e-6", "at least 0"]);
}

#[test]
fn a_chain_with_no_joint_is_told() {
    let start = LEVER.find("[[joint]]").unwrap();
    let end = LEVER.find("[sources").unwrap();
    let text = format!("{}{}", &LEVER[..start], &LEVER[end..])
        .replace("name = \"lever\"", "name = \"lever\"\njoint = []")
        .replace("  { about = \"z\", joint = \"A\" },\n", "")
        .replace("  { along = \"x\", joint = \"B\" },\n", "");
    let cell = Cell::new();
    cell.file("rod.toml", text);
    cell.armill(&["robots", "rod.toml"])
        .refused(&["rod.toml:", "the chain has no joint", "[[joint]]"]);
    let fixed = MH12_URDF.replace("type=\"revolute\"", "type=\"fixed\"");
    cell.file("rod.urdf", fixed);
    cell.armill(&["robots", "rod.urdf"]).refused(&["rod.urdf:"]);
}

#[test]
fn a_length_beyond_all_reason_is_refused_in_a_robot_file() {
    lever("= 500", "= 1e305").refused(&["lever.toml:8:30", "1e305 mm", "at most 1000000 mm"]);
}

#[test]
fn a_broken_urdf_is_told_with_its_file() {
    let cell = Cell::new();
    let half = &MH12_URDF[..MH12_URDF.len() / 2];
    let loop_of_joints = MH12_URDF.replace("<child link=\"tool0\"/>", "<child link=\"l2\"/>");
    for (text, word) in [
        ("", "the file is empty"),
        ("<robot", "not XML"),
        (half, "not XML"),
        ("<sdf/>", "not a URDF: its root is <sdf>"),
        (&MH12_URDF.replace("0.450", "0,450"), "arm.urdf:"),
        (&MH12_URDF.replace("0.450", "nan"), "`nan` in xyz"),
        (&MH12_URDF.replace("0.450", "1e305"), "lengths of a URDF are in m"),
        (
            &MH12_URDF.replace("<parent link=\"l2\"/>", "<parent link=\"gone\"/>"),
            "`gone`",
        ),
        (
            &MH12_URDF.replace("xyz=\"0 -1 0\"", "xyz=\"0 0 0\""),
            "axis of length zero",
        ),
        (&MH12_URDF.replacen("revolute", "floating", 1), "`floating`"),
        (&loop_of_joints, "arm.urdf:"),
    ] {
        cell.file("arm.urdf", text);
        cell.armill(&["pose", "arm.urdf", "--joints-deg", "0,0,0,0,0,0"])
            .refused(&["arm.urdf:", word]);
    }
}

#[test]
fn what_is_neither_library_name_nor_robot_file_is_told() {
    Cell::new()
        .armill(&["pose", "lathe", "--joints-deg", "0"])
        .refused(&["`lathe`", "`armill robots`"]);
    Cell::new()
        .armill(&["pose", "gone.urdf", "--joints-deg", "0"])
        .refused(&["cannot read robot file gone.urdf"]);
    let cell = Cell::new();
    std::fs::create_dir(cell.at("folder.toml")).unwrap();
    cell.armill(&["robots", "folder.toml"]).refused(&["folder.toml"]);
}

// ---- Flags

#[test]
fn a_wrong_number_of_joints_is_told_with_their_names() {
    pose(&["--joints-deg", "1,2,3"]).refused(&["3 joint positions for the 6 joints", "S, L, U, R, B, T"]);
    pose(&["--joints-deg", "1,2,3,4,5,6,7"]).refused(&["7 joint positions for the 6 joints"]);
}

#[test]
fn a_wrong_count_of_numbers_in_a_flag_is_told() {
    pose(&["--at-mm", "1,2"]).refused(&["--at-mm: 2 numbers", "three"]);
    pose(&["--at-mm", "1,2,3,4"]).refused(&["--at-mm: 4 numbers"]);
    pose(&["--at-mm", "900,0,800", "--axis", "1,0"]).refused(&["--axis: 2 numbers"]);
    pose(&["--at-mm", "900,0,800", "--tool-mm", "1,2"]).refused(&["--tool-mm: 2 numbers", "three or six"]);
    pose(&["--at-mm", "900,0,800", "--wrench-n", "1,2,3,4"])
        .refused(&["--wrench-n: 4 numbers", "three or six"]);
    pose(&["--at-mm", "900,0,800", "--compliance-rad-per-n-m", "1e-6,1e-6"])
        .refused(&["2 compliances for 6 joints"]);
}

#[test]
fn numbers_that_are_none_are_refused_in_every_flag() {
    for none in ["nan", "inf", "-inf"] {
        let three = format!("{none},0,0");
        let six = format!("{none},0,0,0,0,0");
        pose(&["--joints-deg", &six]).refused(&["--joints-deg", "is not a"]);
        pose(&["--at-mm", &three]).refused(&["--at-mm", "is not a"]);
        for (flag, value) in [
            ("--axis", &*three),
            ("--tool-mm", &*three),
            ("--wrench-n", &*three),
            ("--tilt-deg", none),
            ("--spin-deg", none),
            ("--compliance-rad-per-n-m", &*six),
        ] {
            pose(&["--at-mm", "900,0,800", flag, value]).refused(&[flag, "is not a"]);
        }
    }
}

#[test]
fn numbers_beyond_all_reason_are_refused_in_every_flag() {
    pose(&["--at-mm", "1e300,0,0"]).refused(&["--at-mm", "1e9"]);
    pose(&["--joints-deg", "1e300,0,0,0,0,0"]).refused(&["--joints-deg", "1e9"]);
    pose(&["--at-mm", "900,0,800", "--wrench-n", "0,0,-1e308"]).refused(&["--wrench-n", "1e9"]);
}

#[test]
fn what_is_no_number_is_refused() {
    pose(&["--joints-deg", "1,2,three,4,5,6"]).refused(&["three", "--joints-deg"]);
    pose(&["--joints-deg", ""]).refused(&["--joints-deg"]);
    pose(&["--at-mm", "1,,3"]).refused(&["--at-mm"]);
}

#[test]
fn a_negative_compliance_in_a_flag_is_told() {
    let flags = [
        "--at-mm",
        "900,0,800",
        "--compliance-rad-per-n-m",
        "-1e-6,1e-6,1e-6,1e-6,1e-6,1e-6",
    ];
    pose(&flags).refused(&["--compliance-rad-per-n-m", "joint S", "rad/(N m)"]);
}

#[test]
fn flags_that_contradict_each_other_are_refused() {
    pose(&[]).refused(&["--at-mm"]);
    pose(&["--joints-deg", "0,0,0,0,0,0", "--at-mm", "1,2,3"]).refused(&["cannot be used with"]);
    pose(&["--at-mm", "1,2,3", "--tilt-deg", "3", "--axis", "0,0,-1"]).refused(&["cannot be used with"]);
    pose(&["--joints-deg", "0,0,0,0,0,0", "--spin-deg", "3"]).refused(&["cannot be used with"]);
    pose(&["--joints-deg", "0,0,0,0,0,0", "--tilt-deg", "3"]).refused(&["cannot be used with"]);
}

#[test]
fn an_axis_of_no_length_and_an_unknown_frame_are_told() {
    pose(&["--at-mm", "900,0,800", "--axis", "0,0,0"]).refused(&["--axis", "points nowhere"]);
    pose(&["--at-mm", "900,0,800", "--base", "flor"]).refused(&["no frame `flor`", "base_link, controller"]);
}

#[test]
fn commands_and_flags_that_do_not_exist_are_refused() {
    for arguments in [
        &["fly"][..],
        &["run"],
        &["run", "a", "--colour"],
        &["run", "a", "--threads", "0"],
        &["pose"],
        &[],
    ] {
        let said = Cell::new().armill(arguments);
        assert_eq!(
            (said.code, said.out.as_str()),
            (2, ""),
            "{arguments:?}: {}",
            said.err
        );
        assert!(
            said.err.contains("--help") || said.err.contains("Usage"),
            "{}",
            said.err
        );
    }
}

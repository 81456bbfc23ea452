use std::f64::consts::TAU;
use std::fmt::Write;

use armill_core::measure::ballbar::Direction;

use super::*;

/// Rows of a turn, every 5 degrees, with deviations of `12.5 + k` um.
fn rows(separator: char, direction: &str, run: &str) -> String {
    let mut text = String::new();
    for k in 0..72 {
        let deviation = 12.5 + f64::from(k);
        let number = |number: f64| match separator {
            ';' => number.to_string().replace('.', ","),
            _ => number.to_string(),
        };
        let _ = writeln!(
            text,
            "{}{separator}{}{separator}{direction}{separator}{run}",
            number(5.0 * f64::from(k)),
            number(deviation)
        );
    }
    text
}

const NAMES: &str = "angle_deg,radius_dev_um,direction,run\n";

fn read_as(text: &str, given: &BallbarReadOptions) -> Result<BallbarRuns, String> {
    match read("bar.csv", text.as_bytes(), given) {
        Ok(BallbarFile::Runs(recorded)) => Ok(recorded),
        Ok(BallbarFile::Results(..)) => panic!("expected radii"),
        Err(problems) => Err(problems.to_string()),
    }
}

fn recorded(text: &str) -> BallbarRuns {
    read_as(text, &BallbarReadOptions::default()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn problems(text: &str) -> String {
    read_as(text, &BallbarReadOptions::default()).unwrap_err()
}

#[test]
fn runs_are_separated_by_direction_and_name_in_any_row_order() {
    let [one, two, back] = [("CW", "1"), ("cw", "2"), ("CCW", "1")].map(|(way, run)| rows(',', way, run));
    let halves = |text: &str| text.split_at(text.len() / 2).0.rfind('\n').unwrap() + 1;
    let (early, late) = one.split_at(halves(&one));
    let found = recorded(&format!("{NAMES}{early}{back}{two}{late}"));
    assert_eq!(found.names, ["1", "1", "2"]);
    let counts: Vec<_> = found
        .runs
        .iter()
        .map(|run| (run.direction().name(), run.angle().len()))
        .collect();
    assert_eq!(counts, [("CW", 72), ("CCW", 72), ("CW", 72)]);
    assert!((found.runs[0].angle()[18] - TAU / 4.0).abs() < 1e-12);
    assert!((found.runs[2].deviation()[3] - 15.5e-6).abs() < 1e-15);
}

#[test]
fn the_same_runs_in_other_units_and_separators_are_the_same() {
    let first = recorded(&format!("# radius_mm: 100\n{NAMES}{}", rows(',', "CCW", "1")));
    assert_eq!(first.radius, Some(0.1));
    let semicolons = format!(
        "\u{feff}# Radius_mm: 100,0;;;\r\n# a note: by hand\r\nangle_deg;radius_dev_um;Direction;run;temp_c\r\n{}",
        rows(';', "anticlockwise", "1").replace('\n', ";20,5\r\n")
    );
    let found = recorded(&semicolons);
    assert_eq!(
        (&found.runs, &found.unused),
        (&first.runs, &vec!["temp_c".to_owned()])
    );
    let mut radii =
        "# nominal_radius_mm = 100\n# direction: CCW\n# run: 1\nangle_rad\tradius_mm\n".to_owned();
    for k in 0..72 {
        let _ = writeln!(
            radii,
            "{}\t{}",
            TAU / 72.0 * f64::from(k),
            100.0125 + f64::from(k) * 1e-3
        );
    }
    let found = recorded(&radii);
    let apart = found.runs[0].samples().zip(first.runs[0].samples());
    for ((a, r), (b, s)) in apart {
        assert!((a - b).abs() < 1e-12 && (r - s).abs() < 1e-12);
    }
}

#[test]
fn remarks_and_changes_of_direction_separate_unnamed_runs() {
    let plain = |way: &str| rows(',', way, "").replace(",\n", "\n");
    let names = "angle_deg,radius_dev_um,direction\n";
    let found = recorded(&format!("{names}{}{}{}", plain("CW"), plain("CCW"), plain("CW")));
    assert_eq!(found.runs.len(), 3);
    let bare: String = (0..72).fold(String::new(), |text, k| text + &format!("{},1\n", 5 * k));
    let parted = format!(
        "# feed_mm_per_min: 1000\n# plane: ZX\nangle_deg,radius_dev_um\n# direction: CW\n{bare}# direction: CW\n{bare}# direction: CCW\n{bare}"
    );
    let found = recorded(&parted);
    assert_eq!(found.runs.len(), 3);
    assert_eq!(
        (found.plane.as_deref(), found.feed),
        (Some("ZX"), Some(1.0 / 60.0))
    );
    let twice = recorded(&format!("# direction: CW\nangle_deg,radius_dev_um\n{bare}{bare}"));
    assert!(twice.notes[0].contains("turns 2.0 times"), "{:?}", twice.notes);
}

#[test]
fn sample_numbers_become_angles_in_the_direction_of_the_run() {
    let bare: String = (1..=36).fold(String::new(), |text, k| text + &format!("{k},2\n"));
    let given = BallbarReadOptions {
        direction: Some(Direction::Clockwise),
        start: Some(1.0),
        radius: None,
    };
    let found = read_as(&format!("index,radius_dev_um\n{bare}"), &given).unwrap();
    let angle = found.runs[0].angle();
    assert!((angle[0] - 1.0).abs() < 1e-12 && (angle[1] - 1.0 + TAU / 36.0).abs() < 1e-12);
    let unknown = problems(&format!("# direction: CW\nindex,radius_dev_um\n{bare}"));
    assert!(
        unknown.contains("the angle of the first sample is not given") && unknown.contains("--start-deg")
    );
}

#[test]
fn each_run_of_numbered_samples_begins_at_the_start_above_it() {
    let bare: String = (0..36).fold(String::new(), |text, k| text + &format!("{k},2\n"));
    let parted = format!(
        "index,radius_dev_um\n# direction: CW\n# start_deg: 0\n{bare}# direction: CCW\n# start_deg: 180\n{bare}\
         # start_deg: 90\n{bare}"
    );
    let found = recorded(&parted);
    let starts: Vec<f64> = found
        .runs
        .iter()
        .map(|run| run.angle()[0].to_degrees().round())
        .collect();
    assert_eq!(starts, [0.0, 180.0, 90.0]);
    assert!((found.runs[0].angle()[1] + TAU / 36.0).abs() < 1e-12);
    // Given as an option, it applies to all runs.
    let options = BallbarReadOptions {
        start: Some(0.0),
        direction: Some(Direction::Clockwise),
        radius: None,
    };
    let given = read_as(&format!("# start_deg: 90\nindex,radius_dev_um\n{bare}"), &options).unwrap_err();
    assert!(given.contains("another start was given before"), "{given}");
    assert!(read_as(&format!("# start_deg: 0\nindex,radius_dev_um\n{bare}"), &options).is_ok());
}

#[test]
fn refuses_samples_that_are_not_numbered_consecutively() {
    let head = "# start_deg: 0\n# direction: CW\nindex,radius_dev_um\n";
    let tens: String = (0..36).fold(String::new(), |text, k| text + &format!("{},2\n", 10 * k));
    let given = problems(&format!("{head}{tens}"));
    assert!(
        given.contains("bar.csv:5:1: sample 10 follows sample 0"),
        "{given}"
    );
    assert_eq!(given.matches("follows sample").count(), 1, "once a run");
    let halves: String = (0..36).fold(String::new(), |text, k| text + &format!("{k}.5,2\n"));
    assert!(problems(&format!("{head}{halves}")).contains("sample 0.5 is not a whole number"));
    let named = "# start_deg: 0\n# direction: CW\nindex,radius_dev_um,run\n0,1,a\n# start_deg: 5\n1,1,a\n";
    assert!(problems(named).contains("bar.csv:6:1: a second `start_deg` of the same run"));
}

#[test]
fn a_run_for_each_row_is_reported_once() {
    let rows: String = (0..100_000).fold(String::new(), |text, k| text + &format!("{},1,CW,{k}\n", k % 360));
    let given = problems(&format!("{NAMES}{rows}"));
    assert!(given.contains("bar.csv:102:1: more than 100 runs"), "{given}");
    assert_eq!(given.matches("error:").count(), 1, "{given}");
}

#[test]
fn a_radius_that_no_test_has_is_reported_at_its_cell() {
    let text = format!("# radius_mm: 100\n{NAMES}{}7,51000,CW,1\n", rows(',', "CW", "1"));
    let given = problems(&text);
    assert!(
        given.contains("bar.csv:75:3: the radius is off by 51 mm, more than half the nominal 100 mm"),
        "{given}"
    );
}

#[test]
fn all_problems_are_reported_together_with_their_positions() {
    let text = format!("{NAMES}{}5,x,CW,1\n6,7,left,1\n7,8,CW\n", rows(',', "CW", "1"));
    let given = problems(&text);
    for part in [
        "bar.csv:74:3: `x` is not a number",
        "bar.csv:75:5: `left` is not a direction",
        "bar.csv:76:1: 3 cells, but the table has 4 columns",
        "separate cells with `;`",
    ] {
        assert!(given.contains(part), "no `{part}` in\n{given}");
    }
}

#[test]
fn problems_are_reported_with_a_hint() {
    let bare: String = (0..72).fold(String::new(), |text, k| text + &format!("{},1\n", 5 * k));
    let small: String = (0..63).fold(String::new(), |text, k| {
        text + &format!("{},1\n", f64::from(k) / 10.0)
    });
    for (text, part) in [
        (String::new(), "the file has no radii"),
        ("a,b\n1,2\n".to_owned(), "no column gives the angle"),
        (
            "angle,radius_dev_um\n1,2\n".to_owned(),
            "angles carry their unit: write `angle_deg`",
        ),
        (
            "angle_deg,radius_dev\n1,2\n".to_owned(),
            "lengths carry their unit: write `radius_dev_um`",
        ),
        (
            "angle_deg,radius_dev_um,radius_mm\n1,2,3\n".to_owned(),
            "`radius_mm` repeats an earlier column",
        ),
        (
            format!("angle_deg,radius_dev_um\n{bare}"),
            "the direction of this run is not given",
        ),
        (
            format!("# direction: CW\nangle_deg,radius_mm\n{bare}"),
            "the nominal radius is not given",
        ),
        (
            format!("# direction: CW\nangle_deg,radius_dev_um\n{small}"),
            "if the angles are radians",
        ),
        (
            "# direction: up\nangle_deg,radius_dev_um\n".to_owned(),
            "`up` is not a direction",
        ),
        (
            "# radius_mm: -3\nangle_deg,radius_dev_um\n".to_owned(),
            "is not a number above 0",
        ),
        (
            "# start_deg: here\nindex,radius_dev_um\n".to_owned(),
            "write it as `# start_deg: 0`",
        ),
        (
            "# feed_mm_per_min: 0\nangle_deg,radius_dev_um\n".to_owned(),
            "write it as `# feed_mm_per_min: 1000`",
        ),
        (
            "# radius_mm: 100\n# radius_mm: 150\nangle_deg,radius_dev_um\n".to_owned(),
            "another nominal radius",
        ),
        (
            "# direction: CW\nangle_deg,radius_dev_um\n1,2\n2,3\n".to_owned(),
            "a run of 2 samples is shorter than the 24",
        ),
        (
            "# direction: CW\nangle_deg,radius_dev_um\n".to_owned(),
            "no radii below the header",
        ),
        (
            format!("# direction: CW\nangle_deg,radius_dev_um\n{bare}0,nan\n"),
            "`nan` is not a number",
        ),
    ] {
        let given = problems(&text);
        assert!(given.contains(part), "no `{part}` in\n{given}");
        assert!(given.contains("help: "), "{given}");
    }
    let options = BallbarReadOptions {
        radius: Some(0.15),
        direction: Some(Direction::Clockwise),
        start: None,
    };
    let given = read_as(
        &format!("# radius_mm: 100\nangle_deg,radius_dev_um\n{bare}"),
        &options,
    )
    .unwrap_err();
    assert!(
        given.contains("another nominal radius was given before"),
        "{given}"
    );
}

#[test]
fn warns_of_deviations_in_the_wrong_unit() {
    let small: String = (0..72).fold(String::new(), |text, k| text + &format!("{},0.0{k}\n", 5 * k));
    let found = recorded(&format!("# direction: CW\nangle_deg,radius_dev_um\n{small}"));
    assert!(found.notes[0].contains("check the unit in the column name"));
}

const RESULTS: &str = "<?xml version='1.0'?><BALLBAR><TEST_SPEC NAME='XY 100mm'/><OPERATOR>me</OPERATOR>\
    <MACHINE_TESTED NAME='MH12'><SERIAL_NUMBER>H12</SERIAL_NUMBER></MACHINE_TESTED><PLANE TEST_PLANE='XY'/>\
    <FEATURE NAME='AF_CIRCULARITY' DT='UT_LENGTH_UM'>96.4</FEATURE>\
    <FEATURE NAME='AF_SQUARENESS' DT='UT_SQUARENESS'>-120,5</FEATURE>\
    <FEATURE NAME='AF_NEW' DT='UT_NEW'>1</FEATURE><FEATURE NAME='AF_NOTE'>none</FEATURE></BALLBAR>";

#[test]
fn results_of_a_ball_bar_are_read_with_their_units() {
    let Ok(BallbarFile::Results(found, None)) =
        read("a.b5r", RESULTS.as_bytes(), &BallbarReadOptions::default())
    else {
        panic!("expected results");
    };
    assert_eq!(found.machine.as_deref(), Some("MH12"));
    assert_eq!(found.plane.as_deref(), Some("XY"));
    let given: Vec<_> = found
        .features
        .iter()
        .map(|of| (of.name.as_str(), of.value, of.unit.as_str()))
        .collect();
    assert_eq!(
        given,
        [
            ("AF_CIRCULARITY", 96.4, "um"),
            ("AF_SQUARENESS", -120.5, "um/m"),
            ("AF_NEW", 1.0, "UT_NEW")
        ]
    );
    assert_eq!(found.without_number, ["AF_NOTE"]);
}

#[test]
fn refuses_xml_that_is_not_a_result_file_at_its_position() {
    for (text, part) in [
        ("<a><b></a>", "not XML"),
        ("<robot/>", "<robot> has no FEATURE and no READINGS"),
        ("<r><FEATURE DT='x'>1</FEATURE></r>", "has no attribute `NAME`"),
        ("<r><FEATURE NAME='x'>1e300</FEATURE></r>", "x is 1e300"),
    ] {
        let given = read("a.b5r", text.as_bytes(), &BallbarReadOptions::default())
            .unwrap_err()
            .to_string();
        assert!(given.contains(part), "no `{part}` in\n{given}");
    }
}

/// A file with a run in each direction, of 100 mm with a deviation of 0.01 mm at its first sample.
fn with_readings(change: impl Fn(String) -> String) -> String {
    let radii: String = (0..72)
        .map(|k| format!("{} ", if k == 0 { "100,010" } else { "100.0" }))
        .collect();
    let run = |way: &str| {
        format!("<RUN><RUN_DIRECTION>{way}</RUN_DIRECTION><READINGS>\n{radii}\n</READINGS></RUN>")
    };
    change(format!(
        "<BALLBAR><PLANE TEST_PLANE='XY'/>{}{}</BALLBAR>",
        run("CCW"),
        run("CW")
    ))
}

#[test]
fn radii_of_a_result_file_are_runs_with_the_angles_of_the_options() {
    let options = BallbarReadOptions {
        radius: Some(0.1),
        start: Some(0.5),
        direction: None,
    };
    let text = with_readings(|text| text);
    let Ok(BallbarFile::Results(_, Some(runs))) = read("a.b5r", text.as_bytes(), &options) else {
        panic!("expected runs");
    };
    assert!(runs.plane.as_deref() == Some("XY") && runs.runs.len() == 2 && runs.notes[0].contains("assumed"));
    let step = TAU / 72.0;
    for (run, sign) in runs.runs.iter().zip([1.0, -1.0]) {
        assert!((run.deviation()[0] - 1e-5).abs() < 1e-15 && run.deviation()[1].abs() < 1e-15);
        assert!((run.angle()[1] - 0.5 - sign * step).abs() < 1e-15);
    }
    for (change, options, part) in [
        (("CCW", "CCW"), BallbarReadOptions::default(), "--radius-mm"),
        (
            ("CCW", "CCW"),
            BallbarReadOptions {
                start: None,
                ..options.clone()
            },
            "--start-deg",
        ),
        (("CCW", "UP"), options.clone(), "--direction"),
        (("100,010", "much"), options.clone(), "`much` is not a number"),
        (("100,010", "0.01"), options.clone(), "within 5 mm"),
        (("100.0", ""), options, "a run of 1 samples"),
    ] {
        let text = with_readings(|text| text.replace(change.0, change.1));
        let given = read("a.b5r", text.as_bytes(), &options).unwrap_err().to_string();
        assert!(
            given.contains(part) && given.contains("a.b5r:1:"),
            "no `{part}` in\n{given}"
        );
    }
}

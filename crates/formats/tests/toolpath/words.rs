//! The guide's page of words, tried: what it calls followed or passed over is read, what it calls refused is refused where
//! at its line, and no known code is missing.

use std::path::Path;

use armill_core::path::Step;
use armill_formats::document::Problems;
use armill_formats::toolpath::gcode::{self, GcodeReadOptions, Rotaries, ToolTable};
use armill_formats::toolpath::{LengthUnit, Summary, apt, csv};

/// A row of a table: its words, and which of them are ends of a range with the one before.
struct Row {
    words: Vec<String>,
    ranges: Vec<(String, String)>,
}

/// The rows below these headings; a section without them ends at the next heading.
fn rows(section: &str, part: Option<&str>) -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/tool-path-words.md");
    let page = std::fs::read_to_string(path).expect("the page is there");
    let mut here = (String::new(), None);
    let mut rows = Vec::new();
    for line in page.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            here = (heading.to_owned(), None);
        } else if let Some(heading) = line.strip_prefix("### ") {
            here.1 = Some(heading.to_owned());
        } else if line.starts_with("| `") && here.0 == section && here.1.as_deref() == part {
            let cell = line.split('|').nth(1).unwrap_or_default();
            let pieces: Vec<&str> = cell.split('`').collect();
            let words: Vec<String> = pieces
                .iter()
                .skip(1)
                .step_by(2)
                .map(|w| (*w).to_owned())
                .collect();
            let between = pieces.iter().skip(2).step_by(2);
            let pairs = words.iter().zip(words.iter().skip(1)).zip(between);
            let ranges = pairs.filter(|(_, between)| between.trim() == "to");
            let ranges = ranges.map(|((a, b), _)| (a.clone(), b.clone())).collect();
            rows.push(Row { words, ranges });
        }
    }
    assert!(!rows.is_empty(), "no rows under {section}, {part:?}");
    rows
}

fn gcode(program: &str) -> Result<Summary, Problems> {
    let expected = GcodeReadOptions {
        rotaries: Some(Rotaries::table_ac()),
        tools: Some(ToolTable::read("tools", "T1 P1 D2 Z50\n", LengthUnit::Millimetre).expect("a table")),
        ..GcodeReadOptions::default()
    };
    gcode::read("p.ngc", program.as_bytes(), &expected, &mut |_| ())
}

const BEFORE_GCODE: &str = "G21 G90 G17 G94 F100 S1000\nT1 M6 M3\nG0 X0 Y0 Z5\n";

#[test]
fn followed_words_of_gcode_are_read() {
    for part in ["Followed", "Passed over"] {
        for row in rows("G-code", Some(part)) {
            let program = format!("{BEFORE_GCODE}{}\n", row.words.join("\n"));
            if let Err(problems) = gcode(&program) {
                panic!("{problems}\n{program}");
            }
        }
    }
}

#[test]
fn refused_words_of_gcode_are_refused_at_their_lines() {
    for word in rows("G-code", Some("Refused"))
        .into_iter()
        .flat_map(|row| row.words)
    {
        let given = match gcode(&format!("{BEFORE_GCODE}{word}\nG0 X1\n")) {
            Err(problems) => problems.as_slice()[0].to_string(),
            Ok(_) => panic!("read: {word}"),
        };
        assert!(given.contains("p.ngc:4:"), "{word}: {given}");
    }
}

/// Codes of G in tenths, of M as they are.
fn codes(letter: char) -> Vec<u32> {
    let code_of = |word: &str| -> Vec<u32> {
        let words = word
            .split_whitespace()
            .filter_map(|word| word.strip_prefix(letter));
        let tenths = |number: &str| number.parse::<f64>().ok().map(|n| (n * 10.0).round() as u32);
        words.filter_map(tenths).collect()
    };
    let mut codes = Vec::new();
    for part in ["Followed", "Passed over", "Refused"] {
        for row in rows("G-code", Some(part)) {
            codes.extend(row.words.iter().flat_map(|word| code_of(word)));
            for (from, to) in &row.ranges {
                if let ([from], [to]) = (&code_of(from)[..], &code_of(to)[..]) {
                    codes.extend(*from..=*to);
                }
            }
        }
    }
    codes
}

#[test]
fn every_known_code_is_on_the_page() {
    for letter in ['G', 'M'] {
        let given = codes(letter);
        let step = if letter == 'G' { 1 } else { 10 };
        for tenths in (0..1010).step_by(step) {
            let code = match tenths % 10 {
                0 => format!("{letter}{}", tenths / 10),
                tenth => format!("{letter}{}.{tenth}", tenths / 10),
            };
            let known = match gcode(&format!("{code}\n")) {
                Ok(_) => true,
                Err(problems) => !problems.to_string().contains("unknown code"),
            };
            assert!(!known || given.contains(&tenths), "{code} is not on the page");
        }
    }
}

fn apt(program: &str) -> Result<(Summary, Vec<Step>), Problems> {
    let mut steps = Vec::new();
    let expected = apt::AptReadOptions {
        dialect: Some(apt::Dialect::SolidWorks),
        ..apt::AptReadOptions::default()
    };
    let summary = apt::read("p.cls", program.as_bytes(), &expected, &mut |step| {
        steps.push(step);
    })?;
    Ok((summary, steps))
}

const BEFORE_APT: &str = "UNITS/MM\nSPINDL/3000.,RPM,CLW\nFEDRAT/100.,MMPM\nGOTO/0.,0.,10.,0.,0.,1.\n";

#[test]
fn followed_words_of_apt_are_read_and_none_is_unknown() {
    for row in rows("APT-CL, CLDATA, CLSF", Some("Followed")) {
        let program = row.words.join("\n");
        // The first MSYS of a file precedes its points.
        let before = match program.contains("MSYS") {
            true => "UNITS/MM\nFEDRAT/100.,MMPM\n",
            false => BEFORE_APT,
        };
        match apt(&format!("{before}{program}\n")) {
            Ok((summary, _)) => {
                let unknown = summary.notes.iter().find(|note| note.contains("not known"));
                assert_eq!(unknown, None, "{program}");
            }
            Err(problems) => panic!("{problems}\n{program}"),
        }
    }
}

#[test]
fn ignored_words_of_apt_are_counted() {
    for word in rows("APT-CL, CLDATA, CLSF", Some("Passed over"))
        .into_iter()
        .flat_map(|row| row.words)
    {
        let (summary, steps) = apt(&format!("{BEFORE_APT}{word}\n")).unwrap_or_else(|p| panic!("{p}"));
        let passed_over = summary
            .notes
            .iter()
            .filter(|note| note.contains("was ignored once"));
        assert_eq!(passed_over.count(), 1, "{word}: {:?}", summary.notes);
        assert_eq!(steps.len(), 2, "{word} moves something");
    }
}

#[test]
fn refused_words_of_apt_are_refused_at_their_lines() {
    for word in rows("APT-CL, CLDATA, CLSF", Some("Refused"))
        .into_iter()
        .flat_map(|row| row.words)
    {
        match apt(&format!("{BEFORE_APT}{word}\n")) {
            Err(problems) => assert!(problems.to_string().contains("p.cls:5:"), "{word}: {problems}"),
            Ok(_) => panic!("read: {word}"),
        }
    }
}

/// A column without the unit in its name.
fn plain(column: &str) -> &str {
    let units = [
        "_mm_per_min",
        "_in_per_min",
        "_mm_per_s",
        "_m_per_s",
        "_mm",
        "_m",
        "_in",
        "_deg",
        "_rad",
    ];
    units
        .iter()
        .find_map(|unit| column.strip_suffix(unit))
        .unwrap_or(column)
}

#[test]
fn columns_of_a_path_are_read_and_none_is_missing() {
    let mut given = Vec::new();
    for row in rows("CSV", None) {
        let mut columns: Vec<&str> = ["x_mm", "y_mm", "z_mm"].into();
        columns.extend(
            row.words
                .iter()
                .map(String::as_str)
                .filter(|c| !c.ends_with("_mm") || c.contains("depth")),
        );
        let cells = vec!["1"; columns.len()].join(",");
        let cells = match row.words[0].as_str() {
            "i" => "1,1,1,0,0,1".to_owned(),
            _ => cells,
        };
        let table = format!("{}\n{cells}\n", columns.join(","));
        if let Err(problems) = csv::read("p.csv", table.as_bytes(), &mut |_| ()) {
            panic!("{problems}");
        }
        given.extend(row.words);
    }
    let unknown = csv::read("p.csv", "x_mm,qqqqqqqq\n".as_bytes(), &mut |_| ()).expect_err("no column");
    let unknown = unknown.to_string();
    let (_, known) = unknown.split_once("known columns: ").expect("a list of names");
    for name in known.lines().next().unwrap_or_default().split(", ") {
        let listed = given.iter().any(|column| plain(column) == plain(name.trim()));
        assert!(listed, "`{name}` is not on the page");
    }
}

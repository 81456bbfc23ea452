//! Every way in which a program can be wrong, and what is said of words without meaning.

use super::dialects::{NX, SOLIDWORKS};
use super::{problems, read_all, steps};
use crate::document::MOST_PROBLEMS;
use crate::toolpath::apt::{AptReadOptions, words};

#[test]
fn problems_are_reported_with_line_column_and_hint() {
    for (text, part) in [
        ("GOTO/1.,2.,x3", "2:12: `x3` is not a number"),
        ("GOTO/1.,,3.", "2:9: a number is missing here"),
        ("GOTO/1.,2.", "2:6: a GOTO has 2 numbers"),
        ("GOTO/1.,2.,1e300", "is not a number from -1e9 to 1e9"),
        ("GOTO/1.,2.,nan", "`nan` is not a number from"),
        ("GOTO/1.,2.,3.,0,0,0", "has a length of 0.0000, not 1"),
        ("CIRCLE/0,0,0,0,0,1.\nGOTO/1.,0,0", "an arc without a start"),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.\nGOTO/0,1.2,0",
            "begins 1.0000 mm from its centre and ends 1.2000 mm",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.",
            "3:1: no GOTO ends this CIRCLE",
        ),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.\nCIRCLE/0,0,0,0,0,1.\nGOTO/1.,0,0",
            "3:1: no GOTO ends this CIRCLE",
        ),
        ("CIRCLE/0,0,0,0,0", "a CIRCLE has 5 parameters"),
        ("CIRCLE/0,0,0,0,0,2.", "has a length of 2.0000"),
        (
            "GOTO/1.,0,0\nCIRCLE/0,0,0,0,0,1.,3.\nGOTO/0,1.,0",
            "and 3.0000 mm is written",
        ),
        ("FEDRAT/100.", "a FEDRAT without unit"),
        ("FEDRAT/MMPM", "a FEDRAT without number"),
        ("FEDRAT/100.,SFM", "`SFM` is not a feed mode"),
        ("FEDRAT/0,MMPM", "a feed of 0 MMPM is not above 0"),
        ("SPINDL/-5,RPM", "-5 RPM is not between 0 and"),
        ("LOAD/TOOL,x", "`x` is not a number of a tool"),
        ("CUTTER/", "the diameter of the tool is missing"),
        ("CUTTER/2.,8.", "a tool of diameter 2 with a corner radius of 8"),
        ("UNIT/FT", "`FT` is not a unit of length"),
        (
            "TRNTYP/LOCAL",
            "TRNTYP/LOCAL: the system of the points is not known",
        ),
        ("TRNTYP/WORLD\nCSYS/1,2,3", "a CSYS has 3 numbers"),
        (
            "TRNTYP/WORLD\nCSYS/2.,0,0,0,0,1.,0,0,0,0,1.,0",
            "not perpendicular and of length 1",
        ),
        (
            "CSYS/1.,0,0,5.,0,1.,0,0,0,0,1.,0",
            "points are in it or in the world",
        ),
        ("MSYS/0,0,0,1.,0,0,1.,0,0", "not perpendicular"),
        ("MSYS/0,0", "without origin"),
        ("MSYS/0,0,0,1.", "an MSYS has 4 numbers"),
        ("GOTO/0,0,0\nMSYS/0,0,0,1.,0,0,0,1.,0", "points came before it"),
        (
            "TRNTYP/WORLD\nTOOL PATH/A",
            "a word of Siemens NX, but those before are of SolidWorks CAM",
        ),
        (
            "NURBS/3",
            "2:1: `NURBS` moves the tool or its points and is not supported",
        ),
        ("P1 = POINT/0,0,0", "the source of an APT program"),
        ("GOTO/0,0,0\nFINI\nGOTO/1.,0,0", "4:1: `GOTO` after FINI"),
        (
            "GOTO/0,0,0\nGOTO/1.,$",
            "3:1: this statement is continued by `$`, but the file ends",
        ),
    ] {
        let given = problems(&format!("UNIT/MM\n{text}\n"));
        assert!(given.contains(part), "{text}: {given}");
        assert!(given.contains("help: "), "{text}: {given}");
    }
    assert!(problems("").contains("the file has no GOTO"));
    let endless = format!("UNIT/MM\nGOTO/{}", "0,$\n".repeat(1000));
    assert!(problems(&endless).contains("has more than 200 lines"));
}

#[test]
fn a_problem_of_a_continued_statement_is_on_its_own_line() {
    let given = problems("UNIT/MM\nGOTO/1.,$\n  2.,$ y\n  no\n");
    assert!(given.contains("part.apt:4:3: `no` is not a number"), "{given}");
}

#[test]
fn all_problems_are_reported_together_up_to_the_maximum() {
    let given = steps(
        &format!("UNIT/MM\n{}", "GOTO/x,0,0\n".repeat(1000)),
        &AptReadOptions::default(),
    )
    .unwrap_err();
    assert_eq!(given.as_slice().len(), MOST_PROBLEMS);
}

#[test]
fn unknown_words_are_counted_with_their_first_line() {
    let (summary, _, _) = read_all("UNIT/MM\nFOO/1\nGOTO/0,0,0\nfoo\nCOOLNT/ON\nSPINDL/100,CLW,LOW\n");
    assert_eq!(
        summary.notes,
        [
            "the word `FOO` is not known (twice, first in line 2)",
            "the word `LOW` of SPINDL is not known (once, first in line 6)",
        ]
    );
    let many: String = (0..5000).map(|k| format!("W{k}/\n")).collect();
    let (summary, _, _) = read_all(&format!("UNIT/MM\nGOTO/0,0,0\n{many}"));
    assert_eq!(summary.notes.len(), 1001);
    assert!(
        summary
            .notes
            .contains(&"other words (4000 times, first in line 1003)".to_owned())
    );
}

#[test]
fn no_text_causes_a_panic() {
    for text in [SOLIDWORKS, NX] {
        for cut in 0..text.len() {
            let _ = steps(&text[..cut], &AptReadOptions::default());
            for with in ["$", "/", ",", "\u{e4}", "-", "\n"] {
                let _ = steps(
                    &format!("{}{with}{}", &text[..cut], &text[cut + 1..]),
                    &AptReadOptions::default(),
                );
            }
        }
    }
    for text in [
        "/",
        "//",
        ",",
        "$",
        "$$",
        "=",
        "GOTO",
        "GOTO/,",
        "CIRCLE/TIMES",
        "PARTNO",
        "  INSERT",
        "\u{1a}",
    ] {
        let _ = steps(text, &AptReadOptions::default());
    }
}

#[test]
fn ignored_and_refused_words_are_listed_in_the_guide() {
    let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/tool-path-words.md");
    let page = std::fs::read_to_string(page).unwrap();
    for word in words::IGNORED.iter().chain(words::REFUSED) {
        let given = [" ", "/", "`"]
            .iter()
            .any(|end| page.contains(&format!("`{word}{end}")));
        assert!(given, "{word}");
    }
}

//! Drafts that cannot be written, in each language; texts and statements of a cell that must not begin a move.

use std::path::Path;

use armill_programs::{Draft, DraftError, DraftStep, Language, RobotProgram, write};

use crate::drafts::{HOSTILE, every_step, long, point, read_back, stored};

const LANGUAGES: [Language; 6] = [
    Language::Krl,
    Language::Rapid,
    Language::Inform,
    Language::Tp,
    Language::UrScript,
    Language::Val3,
];

/// The error of this change of a draft, in each language.
fn refused(change: impl Fn(&mut Draft)) -> [(Language, DraftError); 6] {
    LANGUAGES.map(|language| {
        let mut draft = every_step("");
        change(&mut draft);
        (language, write(language, &draft).expect_err("it is refused"))
    })
}

#[test]
fn a_first_linear_move_is_refused() {
    for (_, given) in refused(|draft| point(draft, 1).speed = Some(0.1)) {
        assert_eq!(
            given.to_string(),
            "the first move of a program must be a joint move, whose posture is unique"
        );
    }
    for (_, given) in refused(|draft| draft.steps.retain(|step| !matches!(step, DraftStep::Move(_)))) {
        assert_eq!(given.to_string(), "the program has no moves");
    }
}

#[test]
fn a_dwell_that_is_negative_not_finite_or_too_long_is_refused() {
    for value in [-1.0, f64::NAN, f64::INFINITY, 1e5] {
        for (_, given) in refused(|draft| draft.steps.push(DraftStep::Dwell(value))) {
            let given = given.to_string();
            assert!(
                given.starts_with(&format!("a dwell of {value} s is not between 0 and ")),
                "{given}"
            );
        }
    }
    let dwell = |language: Language, seconds: f64| {
        let mut draft = long(2);
        draft.steps.push(DraftStep::Dwell(seconds));
        write(language, &draft)
    };
    // The ranges of counters of a hundredth of a second.
    for (language, most) in [
        (Language::Tp, 327.67),
        (Language::Inform, 655.35),
        (Language::Krl, 3600.0),
    ] {
        assert!(
            dwell(language, most).is_ok() && dwell(language, most + 0.01).is_err(),
            "{language:?}"
        );
    }
    // A short rest is not written as none where times have two decimals.
    for (language, statement) in [
        (Language::Tp, "WAIT 0.01(sec)"),
        (Language::Inform, "TIMER T=0.01"),
    ] {
        let text = String::from_utf8(dwell(language, 0.001).unwrap().files.remove(0).1).unwrap();
        assert!(text.contains(statement), "{text}");
    }
}

#[test]
fn external_axes_are_refused_where_they_cannot_be_written() {
    for language in [Language::Inform, Language::UrScript, Language::Val3] {
        let mut draft = long(2);
        draft.external_slides = vec![true];
        for step in 0..2 {
            point(&mut draft, step).external = vec![0.5];
        }
        let given = write(language, &draft).unwrap_err().to_string();
        assert!(
            given.starts_with("1 external axes, but ")
                && given.ends_with(" programs are written with at most 0"),
            "{given}"
        );
    }
    // A point without the position of an external axis.
    for (_, given) in refused(|draft| draft.external_slides = vec![true]) {
        assert!(matches!(given, DraftError::External { .. }), "{given}");
    }
}

#[test]
fn settings_of_the_cell_outside_their_ranges_are_refused() {
    for value in [0.0, -0.5, 1.01, f64::NAN] {
        for (_, given) in refused(|draft| draft.controller.joint_speed = value) {
            assert_eq!(
                given.to_string(),
                format!("the joint speed relative to the maximum is {value}: it must be between 0.01 and 1")
            );
        }
        for (_, given) in refused(|draft| draft.controller.joint_acceleration = Some(value)) {
            assert!(
                given.to_string().starts_with("the joint acceleration relative"),
                "{given}"
            );
        }
    }
    for value in [0.0, -1.0, 1e4, f64::NAN] {
        for (_, given) in refused(|draft| draft.controller.acceleration = Some(value)) {
            assert!(
                given.to_string().starts_with("the acceleration in m/s^2 is "),
                "{given}"
            );
        }
    }
    for name in ["", "two words", "a;Stop", "a\nStop", "1st", "\u{e4}"] {
        for (_, given) in refused(|draft| draft.controller.frame_name = Some(name.to_owned())) {
            assert!(matches!(given, DraftError::Name { .. }), "{given}");
        }
        for (_, given) in refused(|draft| draft.controller.tool_name = Some(name.to_owned())) {
            assert!(matches!(given, DraftError::Name { .. }), "{given}");
        }
    }
}

#[test]
fn a_statement_of_the_cell_is_one_line() {
    for line in [
        "a\nb",
        "a\r\nb",
        "a\tb",
        "a\0",
        "a\u{85}b",
        "a\u{2028}b",
        "\u{e4}",
    ] {
        let places: [&dyn Fn(&mut Draft); 3] = [
            &|draft| draft.controller.header.push(line.to_owned()),
            &|draft| draft.steps.push(DraftStep::Statement(line.to_owned())),
            &|draft| draft.controller.footer.push(line.to_owned()),
        ];
        for change in places {
            for (_, given) in refused(change) {
                let given = given.to_string();
                assert!(
                    given.starts_with(&format!("the statement {line:?} cannot be written in "))
                        && given.ends_with(": it must be one line of ASCII characters"),
                    "{given}"
                );
            }
        }
    }
    // A semicolon ends a statement of TP; the one at its end is not needed.
    let with = |line: &str| write(Language::Tp, &every_step(line));
    let given = with("DO[1]=ON ; DO[2]=ON").unwrap_err().to_string();
    assert!(
        given.contains("`;` ends a statement: write the rest as another statement"),
        "{given}"
    );
    for line in ["DO[1]=ON", "  DO[1]=ON ;", "DO[1]=ON;"] {
        let text = String::from_utf8(with(line).unwrap().files.remove(0).1).unwrap();
        assert!(text.contains(":  DO[1]=ON ;\r\n"), "{text}");
    }
}

/// Motion, joints or position, and line of each move.
fn moves(program: &RobotProgram) -> Vec<String> {
    let all = program.moves.iter();
    all.map(|of| {
        format!(
            "{:?} {:?} {:?} {:?}",
            of.motion,
            of.speed,
            of.frame,
            of.target.pose()
        )
    })
    .collect()
}

#[test]
fn texts_for_people_do_not_begin_statements() {
    for language in LANGUAGES {
        let plain = read_back(&write(language, &every_step("")).unwrap());
        for text in HOSTILE {
            let mut draft = every_step("");
            draft.remarks = vec![(*text).to_owned()];
            for step in &mut draft.steps {
                if let DraftStep::Comment(said) | DraftStep::Stop(said) = step {
                    *said = (*text).to_owned();
                }
            }
            let written = write(language, &draft).unwrap();
            let program = read_back(&written);
            assert_eq!(moves(&program), moves(&plain), "{language:?} {text:?}");
            assert_eq!(
                program.notes.len(),
                plain.notes.len(),
                "{language:?} {:?}",
                program.notes
            );
            only_line_ends(&written.files);
        }
    }
}

#[test]
fn written_texts_have_no_marks_that_end_them_or_begin_escapes() {
    for (language, file, statement, [opens, closes]) in [
        (Language::Rapid, 0, "TPWrite \"", ["\"", "\";"]),
        (Language::Inform, 0, "MSG \"", ["\"", "\""]),
        (Language::Tp, 0, "MESSAGE[", ["[", "] ;"]),
        (
            Language::UrScript,
            0,
            "popup(\"",
            ["\"", "\", \"armill\", False, False, blocking=True)"],
        ),
        (Language::Val3, 2, "putln(\"", ["\"", "\")"]),
    ] {
        for text in HOSTILE {
            let mut draft = every_step("");
            draft.steps[8] = DraftStep::Stop((*text).to_owned());
            let bytes = write(language, &draft).unwrap().files.remove(file).1;
            let written = String::from_utf8(bytes).unwrap();
            let mut messages = written.lines().filter(|line| line.contains(statement)).peekable();
            assert!(messages.peek().is_some(), "{language:?} {text:?}\n{written}");
            for line in messages {
                let said = line
                    .split_once(opens)
                    .and_then(|(_, rest)| rest.strip_suffix(closes));
                let said = said.unwrap_or_else(|| panic!("{language:?} {line}"));
                let marks = if language == Language::Tp { "[];" } else { "\"\\" };
                let is_plain = |c: char| c.is_ascii() && !c.is_ascii_control() && !marks.contains(c);
                assert!(said.chars().all(is_plain), "{language:?} {line}");
            }
        }
    }
}

#[test]
fn every_line_of_a_listing_is_one_statement() {
    for text in HOSTILE.iter().chain(&["a;b", ";", "! ; ;"]) {
        let mut draft = every_step("");
        draft.remarks = vec![(*text).to_owned()];
        draft.steps[0] = DraftStep::Comment((*text).to_owned());
        draft.steps[8] = DraftStep::Stop((*text).to_owned());
        let written = String::from_utf8(write(Language::Tp, &draft).unwrap().files.remove(0).1).unwrap();
        let (_, rest) = written.split_once("/MN\r\n").unwrap();
        let (body, _) = rest.split_once("/POS\r\n").unwrap();
        for line in body.lines() {
            assert!(
                line.ends_with(" ;") && line.matches(';').count() == 1,
                "{text:?} {line}"
            );
        }
    }
}

/// That the files have no control characters but line ends and tabs, and no other line separators.
fn only_line_ends(files: &[(String, Vec<u8>)]) {
    for (name, bytes) in files {
        assert!(Path::new(name).components().count() == 1, "{name}");
        let text = String::from_utf8_lossy(bytes);
        let wrong = text
            .chars()
            .find(|c| (c.is_control() && !"\r\n\t".contains(*c)) || matches!(c, '\u{2028}' | '\u{2029}'));
        assert_eq!(wrong, None, "{name}");
    }
}

#[test]
fn a_blank_separates_brackets_that_would_end_the_code() {
    let written = write(Language::Val3, &every_step("bEnd=nList[nIndex[0]]>3")).unwrap();
    assert_eq!(read_back(&written).moves.len(), 5);
    let text = String::from_utf8(written.files[2].1.clone()).unwrap();
    assert!(text.contains("  bEnd=nList[nIndex[0]] >3\r\n"), "{text}");
    assert_eq!(text.matches("]]>").count(), 1, "{text}");
}

#[test]
fn stored_data_are_refused_where_a_project_contains_them() {
    let given = write(Language::Val3, &stored(long(2), "fTable", "tSpindle")).unwrap_err();
    assert_eq!(
        given.to_string(),
        "Staubli VAL3: a project contains its own frame and tool: data = \"program\""
    );
}

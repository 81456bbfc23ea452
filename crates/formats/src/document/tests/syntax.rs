//! What is not TOML, not text, or too deep.

use super::super::{Document, MOST_SYNTAX_PROBLEMS, Problem};
use super::{GOOD, Study, read};

#[test]
fn a_byte_order_mark_and_windows_line_ends_change_nothing() {
    let windows = format!("\u{feff}{}", GOOD.replace('\n', "\r\n"));
    assert!(read(&windows).is_ok());
    let broken = windows.replace("step_mm = 5", "step_mm = 'five'");
    let problems = read(&broken).unwrap_err();
    assert_eq!(
        (problems.as_slice()[0].line(), problems.as_slice()[0].column()),
        (10, 11)
    );
    assert!(!problems.to_string().contains('\r'));
}

#[test]
fn invalid_toml_is_reported_line_by_line() {
    let problems = Document::parse("a.toml", "x = 3 mm\ny = \nz = 1\nz = 2\n").unwrap_err();
    let lines: Vec<usize> = problems.as_slice().iter().map(Problem::line).collect();
    assert_eq!(lines, [1, 2, 4]);
    assert!(
        problems.as_slice()[2].message().contains("duplicate key"),
        "{problems}"
    );
    assert!(
        problems.to_string().contains("help: keep one of the two"),
        "{problems}"
    );
}

#[test]
fn bytes_that_are_not_text_are_reported_with_their_place() {
    let given = |bytes: &[u8]| Document::from_bytes("a.toml", bytes).unwrap_err();
    let problems = given(b"x = 1\ny = \"\xc3\xa4\xff\"\n");
    assert_eq!(
        problems.as_slice()[0].to_string(),
        "a.toml:2:7: the byte 0xff is not UTF-8 text"
    );
    let marked = given(b"\xef\xbb\xbfx = 1\ny = \"\xff\"\n");
    assert_eq!(
        (marked.as_slice()[0].line(), marked.as_slice()[0].column()),
        (2, 6)
    );
    assert!(
        given(b"\xff\xfex\0=\0")
            .to_string()
            .contains("this file is UTF-16")
    );
    assert!(Document::from_bytes("a.toml", b"x = '\xc3").is_err());
    assert!(
        Document::from_bytes("a.toml", GOOD.as_bytes())
            .unwrap()
            .read::<Study>()
            .is_ok()
    );
}

#[test]
fn nesting_that_would_exhaust_the_stack_is_refused() {
    let key = format!("{}a", "a.".repeat(78));
    let nested = format!(
        "[{key}]\n{key} = {}1{}",
        format!("{{{key} = ").repeat(79),
        "}".repeat(79)
    );
    for text in [
        nested.as_str(),
        &"a = [".repeat(10_000),
        &"[".repeat(1_000_000),
        &"a = {".repeat(100_000),
        &format!("x = {}1", "{a.a = ".repeat(40)),
    ] {
        let problems = Document::parse("a.toml", text).unwrap_err();
        assert!(
            problems.to_string().contains("nest deeper than 64 levels"),
            "{problems}"
        );
    }
    let deep = format!("a = {}{}", "[".repeat(60), "]".repeat(60));
    assert!(Document::parse("a.toml", &deep).is_ok());
    // A long file with a dot in every number is not deep.
    let wide: String = (0..10_000)
        .map(|index| format!("k{index} = [1.5, 2.5, {{ a.b = 3.5 }}]\n"))
        .collect();
    assert!(Document::parse("a.toml", &wide).is_ok());
}

#[test]
fn megabytes_of_invalid_input_are_refused_with_a_short_message() {
    for text in [
        "a = \n".repeat(400_000),
        "[a\n".repeat(400_000),
        "\"".repeat(2_000_001),
        "\u{1f600}".repeat(500_000),
        "\0".repeat(2_000_000),
    ] {
        let problems = Document::parse("a.toml", &text).unwrap_err();
        assert!(problems.as_slice().len() <= MOST_SYNTAX_PROBLEMS);
        assert!(problems.to_string().len() < 100_000);
    }
}

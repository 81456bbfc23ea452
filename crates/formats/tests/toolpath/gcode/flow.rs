//! O-words and subroutines.

use armill_formats::toolpath::gcode::GcodeReadOptions;
use armill_formats::toolpath::gcode::interpreter::MOST_REPEATED_LINES;

use super::program::{calls, ends, first_problem, read};

/// The messages of a program.
fn say(program: &str) -> Vec<String> {
    let mut said = calls(program);
    said.retain(|call| call.starts_with("MESSAGE"));
    said
}

#[test]
fn loops_branches_and_subroutines_are_followed() {
    let number = |value: &str| format!("MESSAGE(\"{value}.000000\")");
    for (program, expected) in [
        (
            "#1=0\no1 while [#1 lt 5]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 elseif [#1 eq 4]\no1 break\no2 else\n(debug,#1)\no2 endif\no1 endwhile\n",
            &["1", "3"][..],
        ),
        (
            "#1=9\no1 do\n(debug,#1)\n#1=[#1-1]\no1 while [#1 gt 7]\n",
            &["9", "8"],
        ),
        (
            "#<n>=0\no1 repeat [3]\no2 repeat [2]\n#<n>=[#<n>+1]\no2 endrepeat\no1 endrepeat\n(debug,#<n>)\n",
            &["6"],
        ),
        (
            "o<twice> sub\no<twice> endsub [#1*2]\no<twice> call [21]\n(debug,#<_value>)\n",
            &["42"],
        ),
        (
            "o1 sub\no2 if [#1 gt 1]\no1 return [1]\no2 endif\n(debug,#1)\no1 endsub\no1 call [1]\no1 call [2]\n",
            &["1"],
        ),
        ("M98 P7 L2\nM2\nO7\n(debug,7)\nM99\n", &[]),
    ] {
        let expected: Vec<String> = expected.iter().map(|value| number(value)).collect();
        let said = say(program);
        if program.starts_with("M98") {
            assert_eq!(said, ["MESSAGE(\"7\")", "MESSAGE(\"7\")"]);
        } else {
            assert_eq!(said, expected, "{program}");
        }
    }
}

#[test]
fn numbered_subroutines_after_the_end_are_found_in_any_order_and_the_next_of_two_is_used() {
    let behind = "O9\n(debug,1)\nM99\nO8\n(debug,2)\nM99\nO9\n(debug,3)\nM99\n";
    assert_eq!(
        say(&format!("M98 P8\nM98 P9\nG4 P0\nM98 P8\nM2\n{behind}")),
        ["2", "1", "2"].map(|value| format!("MESSAGE(\"{value}\")"))
    );
    // Without M99 a subroutine goes on to the end of the file.
    assert_eq!(
        say("M98 P8\nM2\nO8\n(debug,1)\nO9\n(debug,2)\n"),
        ["1", "2"].map(|value| format!("MESSAGE(\"{value}\")"))
    );
}

#[test]
fn subroutines_come_from_other_files() {
    let lookup =
        |name: &str| (name == "far").then(|| "o<far> sub\nG0 X#1\nG1 Y1\no<far> endsub\n".to_owned());
    let expected = GcodeReadOptions {
        subroutines: Some(&lookup),
        ..GcodeReadOptions::default()
    };
    let (path, _) = read("G21 F60\no<far> call [3]\n", &expected).unwrap();
    assert_eq!(ends(&path), [[3.0, 0.0, 0.0], [3.0, 1.0, 0.0]]);
    assert_eq!(
        first_problem("G21\no<far> call [3]\n", &expected),
        "far:3:1: G1 with a feed of zero",
        "problems are reported in their own file"
    );
}

#[test]
fn programs_that_never_end_are_stopped() {
    let endless = GcodeReadOptions {
        most_repeated_lines: Some(1000),
        ..GcodeReadOptions::default()
    };
    assert_eq!(
        first_problem("o1 while [1]\n(round)\no1 endwhile\n", &endless)
            .split(": ")
            .nth(1),
        Some("more than 1000 executed lines of loops and subroutines")
    );
    assert_eq!(
        MOST_REPEATED_LINES, 20_000_000,
        "the default limit takes about ten seconds"
    );
}

#[test]
fn an_endless_loop_ends_and_sooner_after_a_line_that_was_refused() {
    let given = |program: &str, most_repeated_lines| {
        let expected = GcodeReadOptions {
            most_repeated_lines,
            ..GcodeReadOptions::default()
        };
        read(program, &expected).unwrap_err().to_string()
    };
    let endless = given("o1 while [1]\nG1 X1 F100\no1 endwhile\nM2\n", Some(1000));
    assert!(endless.contains("1000"), "{endless}");
    // Its end was refused: nothing counts down.
    let broken = given(
        "#<n>=3\no1 while [#<n> GT 0]\n#<n>=[<->1]\no1 endwhile\nM2\n",
        None,
    );
    assert!(
        broken.contains("3:") && broken.matches("error:").count() == 2,
        "{broken}"
    );
}

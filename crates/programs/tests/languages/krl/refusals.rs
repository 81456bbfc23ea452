//! All ways in which a KUKA program can be wrong.

use super::{src, wrong};
use crate::problems;

#[test]
fn every_problem_is_reported_with_its_position_and_a_hint() {
    for (lines, part) in [
        (
            "LIN {X 1.2.3,Y 2,Z 3,A 0,B 0,C 0}",
            "2:8: `1.2.3` is not a number",
        ),
        ("LIN {X -,Y 2,Z 3,A 0,B 0,C 0}", "`-,` is not a number"),
        ("LIN {X 1 Y 2}", "2:10: `,` or `}` is missing here"),
        ("LIN {X 1,Y 2", "2:13: `,` or `}` is missing here"),
        ("LIN {X 1,,Y 2}", "a component is missing here"),
        ("LIN {X", "a value and `}` are missing here"),
        ("LIN {X 2e9,Y 2,Z 3,A 0,B 0,C 0}", "a component exceeds 1e9"),
        (
            "LIN {X A,Y 2,Z 3,A 0,B 0,C 0}",
            "X of this target is given neither",
        ),
        ("LIN {E1 5}", "neither a pose"),
        ("LIN", "a target is missing here"),
        ("LIN 5", "a target is missing here"),
        ("LIN P7", "2:5: `P7` is not defined: no given file declares it"),
        (
            "P7=OTHER\nLIN P7",
            "`P7` is computed while the program runs, in line 2",
        ),
        (
            "P7={X 1,Y 2,Z 3,A 0,B 0,C 0}\nP7.X=5\nLIN P7",
            "`P7` is computed while the program runs, in line 3",
        ),
        ("LIN NEXT(3)", "`NEXT` is computed while the program runs"),
        ("LIN P[I]", "`P[?]` is not defined"),
        ("LIN {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}", "`LIN` goes to axes"),
        ("CIRC {X 1,Y 2,Z 3,A 0,B 0,C 0}", "a circle needs a via point"),
        (
            "CIRC {X 1,Y 2,Z 3,A 0,B 0,C 0},{X 1,Y 2,Z 4,A 0,B 0,C 0},CA 360",
            "the circle continues after its end point",
        ),
        (
            "CIRC {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0},{X 1,Y 2,Z 4,A 0,B 0,C 0}",
            "a circle needs poses",
        ),
        (
            "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0} {X 1}",
            "the words after the target are not understood",
        ),
        ("SPL_REL {X 1}", "`SPL_REL` is an unsupported move"),
        (
            "FDAT_ACT={TOOL_NO 1,BASE_NO 1,IPO_FRAME #TCP}\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}",
            "the tool is stationary here",
        ),
        (
            "$IPO_MODE=#TCP\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}",
            "the tool is stationary here",
        ),
        ("WAIT SEC 1", "the program contains no moves"),
    ] {
        wrong(lines, part);
    }
    let broken = [
        ("a.src", "DEF A()\nLIN XP1\nEND\n"),
        ("a.dat", "DEFDAT A\nDECL E6POS XP1={X 1..2,Y 2}\nENDDAT\n"),
    ];
    let all = problems(&broken);
    assert_eq!(all[0], "2:19: `1..2` is not a number");
}

#[test]
fn at_most_two_hundred_problems_are_reported() {
    let lines: String = (0..500).map(|index| format!("LIN P{index}\n")).collect();
    assert_eq!(problems(&[("a.src", &src(&lines))]).len(), 200);
}

//! How the ends of moves are passed, in the words of each language.

use armill_core::path::Passage;

/// The passages of the moves of these files.
fn passages(files: &[(&str, &str)]) -> Vec<Passage> {
    let program = crate::program(files).unwrap_or_else(|problems| panic!("{problems}"));
    program.moves.iter().map(|of| of.passage).collect()
}

#[test]
fn zones_of_rapid_by_name_by_data_and_in_line() {
    const AT: &str = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let zones = ["fine", "z0", "z10", "zOwn", "zStop", "z10\\Z:=2.5", "zElsewhere"];
    let moves: Vec<String> = zones
        .iter()
        .map(|zone| format!("MoveL {AT},v100,{zone},tool0;\n"))
        .collect();
    let text = format!(
        "MODULE m\nCONST zonedata zOwn:=[FALSE,0.7,1,1,0.1,1,0.1];\nCONST zonedata zStop:=[TRUE,5,5,5,1,5,1];\nPROC a()\n{}ENDPROC\nENDMODULE\n",
        moves.concat()
    );
    let mm = |mm: f64| Passage::Zone(mm * 1e-3);
    let expected = [
        Passage::Stop,
        mm(0.3),
        mm(10.0),
        mm(0.7),
        Passage::Stop,
        mm(2.5),
        Passage::Unknown,
    ];
    assert_eq!(passages(&[("a.mod", &text)]), expected);
}

#[test]
fn approximate_positioning_of_krl() {
    let text = "DEF A()\n$APO.CDIS=3\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN {X 2} C_DIS\nLIN {X 3} C_VEL\n$APO.CDIS=0.5\nLIN {X 4} C_DIS\nEND\n";
    let expected = [
        Passage::Stop,
        Passage::Zone(3e-3),
        Passage::Unknown,
        Passage::Zone(5e-4),
    ];
    assert_eq!(passages(&[("a.src", text)]), expected);
    // A distance that the program does not give.
    let text = "DEF A()\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0} C_DIS\nEND\n";
    assert_eq!(passages(&[("a.src", text)]), [Passage::Unknown]);
}

#[test]
fn blend_radii_of_urscript_by_name_and_by_place() {
    let at = "p[0.1, 0.2, 0.3, 0, 0, 0]";
    let text = format!(
        "def a():\n  movel({at}, a=1, v=0.1)\n  movel({at}, a=1, v=0.1, r=0.005)\n  movel({at}, 1, 0.1, 0, 0.002)\n  movel({at}, r=0)\nend\n"
    );
    let expected = [
        Passage::Stop,
        Passage::Zone(5e-3),
        Passage::Zone(2e-3),
        Passage::Stop,
    ];
    assert_eq!(passages(&[("a.script", &text)]), expected);
}

#[test]
fn fine_of_tp_stops_and_cnt_is_not_known() {
    let place =
        "P[1]{\nGP1:\nUF : 0, UT : 1,\nX = 1 mm, Y = 2 mm, Z = 3 mm, W = 0 deg, P = 0 deg, R = 0 deg\n};\n";
    let text =
        format!("/PROG A\n/MN\n1:L P[1] 10mm/sec FINE ;\n2:L P[1] 10mm/sec CNT50 ;\n/POS\n{place}/END\n");
    assert_eq!(passages(&[("a.ls", &text)]), [Passage::Stop, Passage::Unknown]);
}

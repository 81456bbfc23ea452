//! The text of written KUKA programs, and drafts that cannot be written.

use armill_programs::{Draft, Language, write};

use crate::drafts::{every_step, long, point, stored, text_of};

/// The start of every program up to its name.
const START: &str = ";FOLD INI\r\n;FOLD BASISTECH INI\r\n\
    GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )\r\nINTERRUPT ON 3\r\nBAS (#INITMOV,0 )\r\n\
    ;ENDFOLD (BASISTECH INI)\r\n;ENDFOLD (INI)\r\n$ADVANCE=3\r\n";
const AXES: &str = "A1 -46.18419,A2 -6.77518,A3 -20.54925,A4 71.38674,A5 49.58727,A6 -302.54752";

#[test]
fn a_program_has_the_expected_text() {
    let written = write(Language::Krl, &long(3)).unwrap();
    let (name, bytes) = &written.files[0];
    assert_eq!((written.files.len(), name.as_str()), (1, "PLATE.src"));
    // Points are 0.1 mm apart: the blend of 0.5 mm becomes 0.045 mm; the last point is an exact stop.
    let expected = format!(
        "&ACCESS RVP\r\n&REL 1\r\nDEF PLATE()\r\n; made by armill\r\n; LIN {{X 0}}\r\n{START}\
        BAS(#BASE,1)\r\nBAS(#TOOL,2)\r\n\
        ; base 1 and tool 2 as this program was made with them\r\n\
        $BASE={{FRAME: X 1.0000,Y 2.0000,Z 3.0000,A 0.000000,B 0.000000,C 0.000000}}\r\n\
        $TOOL={{FRAME: X 0.0000,Y 0.0000,Z 100.0000,A 0.000000,B 0.000000,C 0.000000}}\r\n\
        BAS(#VEL_PTP,10)\r\nPTP {{AXIS: {AXES}}}\r\n\
        $VEL.CP=0.050000\r\n$APO.CDIS=0.045\r\n\
        LIN {{X 0.100,Y 0.000,Z 0.000,A 0.0000,B 90.0000,C 0.0000}} C_DIS\r\n\
        LIN {{X 0.200,Y 0.000,Z 0.000,A 0.0000,B 90.0000,C 0.0000}}\r\nEND\r\n"
    );
    assert_eq!(std::str::from_utf8(bytes).unwrap(), expected);
}

#[test]
fn every_kind_of_step_has_its_statement() {
    let mut draft = every_step("$OUT[3]=TRUE");
    draft.controller.joint_speed = 0.256;
    draft.controller.joint_acceleration = Some(0.5);
    draft.controller.acceleration = Some(1.25);
    draft.controller.header = vec!["$OUT[1]=TRUE".to_owned()];
    draft.controller.footer = vec!["$OUT[1]=FALSE".to_owned()];
    let text = text_of(&write(Language::Krl, &draft).unwrap(), 0);
    let at = |x: u32| format!("LIN {{X {x}.000,Y 0.000,Z 0.000,A 0.0000,B 90.0000,C 0.0000}}");
    let [one, two, three] = [10, 20, 30].map(at);
    let expected = format!(
        "\r\nBAS(#VEL_PTP,26)\r\nBAS(#ACC_PTP,50)\r\n$ACC.CP=1.250000\r\n$OUT[1]=TRUE\r\n; approach\r\n\
        PTP {{AXIS: {AXES}}}\r\n$VEL.CP=0.050000\r\n$APO.CDIS=0.500\r\n{one} C_DIS\r\n\
        ; corner\r\n; of the part\r\n{two}\r\nWAIT SEC 1.500\r\n$OUT[3]=TRUE\r\n{three}\r\n\
        ; STOP: change the tool\r\nHALT\r\nPTP {{AXIS: {AXES}}}\r\n$OUT[1]=FALSE\r\nEND\r\n"
    );
    assert!(text.ends_with(&expected), "{text}\n{expected}");
}

#[test]
fn external_axes_follow_those_of_the_arm_in_mm_or_deg() {
    let mut draft = long(2);
    draft.external_slides = vec![true, false];
    for step in 0..2 {
        point(&mut draft, step).external = vec![1.25, std::f64::consts::FRAC_PI_2];
    }
    let written = write(Language::Krl, &draft).unwrap();
    let text = text_of(&written, 0);
    for part in [
        "PTP {E6AXIS: A1 -46.18419,",
        ",A6 -302.54752,E1 1250.00000,E2 90.00000}\r\n",
        ",C 0.0000,E1 1250.00000,E2 90.00000}\r\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    assert!(written.notes.iter().any(|note| note.contains("external axes")));
    draft.external_slides = vec![true; 7];
    for step in 0..2 {
        point(&mut draft, step).external = vec![0.0; 7];
    }
    let given = write(Language::Krl, &draft).unwrap_err().to_string();
    assert_eq!(
        given,
        "7 external axes, but KUKA KRL programs are written with at most 6"
    );
}

#[test]
fn stored_frames_and_tools_are_only_selected() {
    let written = write(Language::Krl, &stored(long(2), "Table", "Spindle")).unwrap();
    let text = text_of(&written, 0);
    assert!(
        text.contains("BAS(#BASE,1)\r\nBAS(#TOOL,2)\r\nBAS(#VEL_PTP,10)\r\n"),
        "{text}"
    );
    assert!(!text.contains("$BASE=") && !text.contains("$TOOL="), "{text}");
    let note = &written.notes[0];
    assert!(
        note.starts_with("BASE_DATA[1] must be {FRAME: X 1.0000,")
            && note.contains("TOOL_DATA[2] {FRAME: X 0.0000,"),
        "{note}"
    );
}

#[test]
fn refuses_drafts_outside_the_ranges_of_controllers() {
    let refused = |change: &dyn Fn(&mut Draft), part: &str| {
        let mut draft = long(2);
        change(&mut draft);
        let given = write(Language::Krl, &draft).unwrap_err().to_string();
        assert!(given.contains(part), "{given}");
    };
    refused(
        &|draft| draft.name = "5TH".to_owned(),
        "`5TH` is not a valid name in KUKA KRL",
    );
    refused(&|draft| draft.name = "A".repeat(25), "at most 24");
    refused(
        &|draft| draft.controller.tool_number = 129,
        "tool 129 is outside 0 to 128 of KUKA KRL",
    );
    refused(&|draft| draft.steps.clear(), "has no moves");
    refused(
        &|draft| point(draft, 0).joints.push(0.0),
        "7 joints, but KUKA KRL programs are written for arms with 6 joints",
    );
    refused(
        &|draft| point(draft, 1).speed = Some(0.0),
        "point 2: the speed is 0",
    );
    refused(&|draft| point(draft, 1).blend = -1.0, "point 2: the blend is -1");
    let mut draft = long(5001);
    draft.name = "A".repeat(20);
    let given = write(Language::Krl, &draft).unwrap_err().to_string();
    assert!(
        given.contains("at most 19 because it is written in parts"),
        "{given}"
    );
}

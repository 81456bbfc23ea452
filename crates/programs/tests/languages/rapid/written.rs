//! The text of written RAPID modules, and drafts that cannot be written.

use armill_programs::{Draft, DraftError, Frame, Language, write};

use crate::drafts::{every_step, long, point, read_back, spaced, stored, text_of};

const NONE: &str = "[1.00000000,0.00000000,0.00000000,0.00000000]";
const ABSENT: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";
const JOINTS: &str = "[-46.18419,-6.77518,-20.54925,71.38674,49.58727,-302.54752]";
const KEPT: &str = "tool_2\\WObj:=wobj_1;\r\n";

/// A straight move to this x, mm.
fn linear(x: &str, zone: &str) -> String {
    format!(
        "    MoveL [[{x},0.000,0.000],[0.70710678,0.00000000,0.70710678,0.00000000],[-1,0,-4,0],{ABSENT}],v50,{zone},{KEPT}"
    )
}

fn joint(zone: &str) -> String {
    format!("    MoveAbsJ [{JOINTS},{ABSENT}]\\NoEOffs,v200,{zone},{KEPT}")
}

fn written(draft: &Draft) -> String {
    text_of(&write(Language::Rapid, draft).unwrap(), 0)
}

#[test]
fn a_program_has_the_expected_text() {
    let written = write(Language::Rapid, &long(3)).unwrap();
    let (name, bytes) = &written.files[0];
    assert_eq!((written.files.len(), name.as_str()), (1, "PLATE.mod"));
    // Points are 0.1 mm apart: the zones are at most 0.045 mm.
    let zone = "zone_20um";
    let [joint, one, two] = [joint(zone), linear("0.100", zone), linear("0.200", "fine")];
    let expected = format!(
        "MODULE MOD_PLATE\r\n  ! made by armill\r\n  ! LIN {{X 0}}\r\n  \
         LOCAL PERS tooldata tool_2:=[TRUE,[[0.000,0.000,100.000],{NONE}],[1,[0,0,1],[1,0,0,0],0,0,0]];\r\n  \
         LOCAL PERS wobjdata wobj_1:=[FALSE,TRUE,\"\",[[1.000,2.000,3.000],{NONE}],[[0,0,0],[1,0,0,0]]];\r\n  \
         LOCAL PERS zonedata {zone}:=[FALSE,0.02,0.02,0.02,0.002,0.02,0.002];\r\n  \
         PROC PLATE()\r\n    ConfJ\\On;\r\n    ConfL\\Off;\r\n    SingArea\\Wrist;\r\n\
         {joint}{one}{two}  ENDPROC\r\nENDMODULE\r\n"
    );
    assert_eq!(std::str::from_utf8(bytes).unwrap(), expected);
}

#[test]
fn every_kind_of_step_has_its_statement() {
    let mut draft = every_step("SetDO do_1,1;");
    draft.controller.joint_speed = 0.1;
    draft.controller.acceleration = Some(1.25);
    draft.controller.header = vec!["AccSet 50,50;".to_owned()];
    draft.controller.footer = vec!["SetDO do_1,0;".to_owned()];
    let text = written(&draft);
    let zone = "zone_500um";
    let moves = [
        joint(zone),
        linear("10.000", zone),
        linear("20.000", "fine"),
        linear("30.000", "fine"),
        joint("fine"),
    ];
    let [first, one, two, three, last] = &moves;
    let expected = format!(
        "    SingArea\\Wrist;\r\n    PathAccLim TRUE\\AccMax:=1.250,TRUE\\DecelMax:=1.250;\r\n    AccSet 50,50;\r\n    \
         ! approach\r\n{first}{one}    ! corner\r\n    ! of the part\r\n{two}    WaitTime\\InPos,1.500;\r\n    \
         SetDO do_1,1;\r\n{three}    TPWrite \"change the tool\";\r\n    Stop;\r\n{last}    SetDO do_1,0;\r\n  \
         ENDPROC\r\nENDMODULE\r\n"
    );
    assert!(text.ends_with(&expected), "{text}\n{expected}");
}

#[test]
fn a_cut_has_no_exact_stops_and_no_zone_beyond_the_blend() {
    // 0.45 of 10 um is less than the smallest zone.
    for (apart_mm, zone) in [(0.01, "zone_10um"), (0.1, "zone_20um"), (10.0, "zone_500um")] {
        let text = written(&spaced(20, apart_mm));
        assert_eq!(text.matches(",fine,").count(), 1, "{text}");
        assert_eq!(text.matches(&format!(",{zone},")).count(), 19, "{text}");
    }
}

#[test]
fn external_axes_are_written_in_mm_or_deg() {
    let mut draft = long(2);
    draft.external_slides = vec![true, false];
    for step in 0..2 {
        point(&mut draft, step).external = vec![1.25, std::f64::consts::FRAC_PI_2];
    }
    let text = written(&draft);
    let external = "[1250.00000,90.00000,9E9,9E9,9E9,9E9]";
    assert!(
        text.contains(&format!("MoveAbsJ [{JOINTS},{external}]\\NoEOffs,")),
        "{text}"
    );
    assert!(text.contains(&format!(",[-1,0,-4,0],{external}],v50,")), "{text}");
}

#[test]
fn names_of_the_cell_are_declared_or_only_selected() {
    let kept = "tSpindle\\WObj:=wTable;\r\n";
    let draft = stored(long(2), "wTable", "tSpindle");
    let written = write(Language::Rapid, &draft).unwrap();
    let text = text_of(&written, 0);
    assert_eq!(text.matches(kept).count(), 2, "{text}");
    assert!(!text.contains("tooldata") && !text.contains("wobjdata"), "{text}");
    let note = &written.notes[0];
    let values =
        format!("tSpindle must be [[0.000,0.000,100.000],{NONE}] and wTable [[1.000,2.000,3.000],{NONE}]");
    assert!(note.starts_with(&values), "{note}");
    // The values of names that no module declares are not known.
    let program = read_back(&written);
    assert!(
        program
            .moves
            .iter()
            .all(|of| (of.frame, of.tool) == (Frame::Unknown, Frame::Unknown))
    );
    assert_eq!(program.notes.len(), 2, "{:?}", program.notes);

    let mut draft = draft;
    draft.controller.data = armill_programs::FrameData::Program;
    let text = self::written(&draft);
    assert_eq!(text.matches(kept).count(), 2, "{text}");
    for declared in ["tooldata tSpindle:=", "wobjdata wTable:="] {
        assert!(text.contains(declared), "{text}");
    }
}

#[test]
fn refuses_names_that_the_language_has() {
    let name = |change: &dyn Fn(&mut Draft)| {
        let mut draft = long(1);
        change(&mut draft);
        write(Language::Rapid, &draft).unwrap_err().to_string()
    };
    let given = name(&|draft| draft.name = "Proc".to_owned());
    assert!(given.contains("not a reserved word"), "{given}");
    let given = name(&|draft| draft.controller.tool_name = Some("tool0".to_owned()));
    assert!(
        given.contains("`tool0` is not a valid name in ABB RAPID"),
        "{given}"
    );
    let given = name(&|draft| {
        draft.controller.tool_name = Some("Same".to_owned());
        draft.controller.frame_name = Some("same".to_owned());
    });
    assert_eq!(given, "ABB RAPID: tool and frame need different names");
    // Stored on the controller, they are selected.
    write(Language::Rapid, &stored(long(1), "wobj0", "tool0")).unwrap();
}

#[test]
fn refuses_accelerations_below_those_of_the_controller() {
    let mut draft = long(1);
    draft.controller.acceleration = Some(0.05);
    let given = write(Language::Rapid, &draft).unwrap_err();
    assert!(matches!(given, DraftError::Setting { .. }));
    assert_eq!(
        given.to_string(),
        "the acceleration in m/s^2 is 0.05: it must be between 0.1 and 1000"
    );
}

//! The text of written URScript programs, and drafts that cannot be written.

use armill_programs::{Draft, Frame, FrameData, Language, write};

use crate::drafts::{every_step, long, read_back, stored, text_of};

const MOVEJ: &str = "  movej([-0.806066, -0.118249, -0.358652, 1.245934, 0.865461, -5.280450], ";

/// A straight move to this x, m, and what follows its speed.
fn linear(frame: &str, x: &str, blend: &str) -> String {
    format!(
        "  movel(pose_trans({frame}, p[{x}, 0.000000, 0.000000, 0.000000, 1.570796, 0.000000]), a=1.200000, \
         v=0.050000{blend})\n"
    )
}

#[test]
fn a_program_has_the_expected_text() {
    let written = write(Language::UrScript, &long(4)).unwrap();
    let (name, bytes) = &written.files[0];
    assert_eq!((written.files.len(), name.as_str()), (1, "PLATE.script"));
    // Points are 0.1 mm apart: the blend of 0.5 mm becomes 0.045 mm; the last point is an exact stop.
    let blend = ", r=0.000045";
    let [one, two, three] = [("0.000100", blend), ("0.000200", blend), ("0.000300", "")]
        .map(|(x, blend)| linear("armill_frame", x, blend));
    let expected = format!(
        "def PLATE():\n  # made by armill\n  # LIN {{X 0}}\n  # frame 1 and tool 2 for which this program was made\n  \
         armill_frame = p[0.001000, 0.002000, 0.003000, 0.000000, 0.000000, 0.000000]\n  \
         set_tcp(p[0.000000, 0.000000, 0.100000, 0.000000, 0.000000, 0.000000])\n\
         {MOVEJ}a=1.400000, v=0.209000, r=0.000045)\n{one}{two}{three}end\nPLATE()\n"
    );
    assert_eq!(std::str::from_utf8(bytes).unwrap(), expected);
}

#[test]
fn every_kind_of_step_has_its_statement() {
    let mut draft = every_step("set_standard_digital_out(1, True)");
    draft.controller.joint_speed = 0.5;
    draft.controller.joint_acceleration = Some(0.2);
    draft.controller.header = vec!["set_payload(1.5)".to_owned()];
    draft.controller.footer = vec!["textmsg(\"done\")".to_owned()];
    let text = text_of(&write(Language::UrScript, &draft).unwrap(), 0);
    let blend = ", r=0.000500";
    let [one, two, three] = [("0.010000", blend), ("0.020000", ""), ("0.030000", "")]
        .map(|(x, blend)| linear("armill_frame", x, blend));
    let joint = format!("{MOVEJ}a=2.800000, v=1.045000");
    let expected = format!(
        "  set_payload(1.5)\n  # approach\n{joint}{blend})\n{one}  # corner\n  # of the part\n{two}  sleep(1.500)\n  \
         set_standard_digital_out(1, True)\n{three}  \
         popup(\"change the tool\", \"armill\", False, False, blocking=True)\n{joint})\n  textmsg(\"done\")\nend\nPLATE()\n"
    );
    assert!(text.ends_with(&expected), "{text}\n{expected}");
    draft.controller.acceleration = Some(0.75);
    let text = text_of(&write(Language::UrScript, &draft).unwrap(), 0);
    assert_eq!(text.matches(", a=0.750000, v=0.050000").count(), 3, "{text}");
}

#[test]
fn stored_frames_are_features_of_the_installation() {
    let written = write(Language::UrScript, &stored(long(2), "Table", "Spindle")).unwrap();
    let text = text_of(&written, 0);
    assert!(text.contains(&linear("Table", "0.000100", "")), "{text}");
    assert!(
        !text.contains("set_tcp") && !text.contains("armill_frame"),
        "{text}"
    );
    let note = &written.notes[0];
    assert!(
        note.starts_with("the TCP of the installation must be p[0.000000,")
            && note.contains("the feature p[0.001000,"),
        "{note}"
    );
    let program = read_back(&written);
    assert_eq!(
        (program.moves[1].frame, program.moves[1].tool),
        (Frame::Unknown, Frame::Unknown)
    );
    assert_eq!(program.notes.len(), 1, "{:?}", program.notes);
}

#[test]
fn stored_frames_without_a_name_are_refused() {
    let mut draft = long(2);
    draft.controller.data = FrameData::Controller;
    let given = write(Language::UrScript, &draft).unwrap_err().to_string();
    assert!(
        given.contains("URScript: frames have no numbers") && given.contains("frame_name"),
        "{given}"
    );
}

#[test]
fn refuses_reserved_words_as_names() {
    let draft = Draft {
        name: "While".to_owned(),
        ..long(1)
    };
    let given = write(Language::UrScript, &draft).unwrap_err().to_string();
    assert!(given.contains("not a reserved word"), "{given}");
}

//! INFORM jobs by hand: headers of positions, external axes, levels, calls, refusals.

use crate::event::{Action, Blend, JointTarget, Posture, Speed};
use crate::expect::{actions, joints, linears, output, refusal, same};
use crate::pose::Pose;
use crate::replay::Language::Inform;

/// A job with these positions and instructions; its number of positions C, and of EC.
fn job(counts: (usize, usize), positions: &str, instructions: &str) -> String {
    let (c, ec) = counts;
    format!(
        "/JOB\n//NAME P\n//POS\n///NPOS {c},0,{ec},0,0,0\n{positions}\n//INST\n///DATE 2024/01/01 00:00\n\
         ///ATTR SC,RW,RJ\n////FRAME USER 2\n///GROUP1 RB1\nNOP\n{instructions}\nEND\n"
    )
}

const USER: &str = "///USER 2\n///TOOL 3\n///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,0,0,0,0\n\
    C00000=1.000,2.000,3.000,180.0000,0.0000,90.0000\n///RCONF 1,0,0,1,0,0,0,0\nC00001=4,5,6,0,0,0";

#[test]
fn headers_are_valid_for_the_positions_after_them() {
    let text = job(
        (2, 0),
        USER,
        "MOVJ C00000 VJ=10.00 PL=0\nMOVJ C00001 VJ=0.5\nMOVL C00001 V=30.5 PL=1\nMOVL C00000 V=2",
    );
    let all = actions(Inform, &[("p.jbi", &text)], "P");
    let [one, two] = joints(&all)[..] else {
        panic!("{all:?}")
    };
    let JointTarget::Pose { pose, posture } = &one.to else {
        panic!("{one:?}")
    };
    same(pose, &Pose::kuka([1.0, 2.0, 3.0, 90.0, 0.0, 180.0]));
    assert_eq!(*posture, Posture::Flags(vec![1, 0, 0, 0, 0, 0, 0, 0]));
    assert!(matches!(&two.to, JointTarget::Pose { posture: Posture::Flags(flags), .. } if flags[3] == 1));
    assert_eq!(
        (one.base.name.as_str(), one.base.pose, one.tool.name.as_str()),
        ("2", None, "3")
    );
    assert_eq!((one.speed, one.blend), (Speed::Percent(10.0), Blend::Exact));
    assert_eq!(two.blend, Blend::Unspecified);
    let [line, last] = linears(&all)[..] else {
        panic!("{all:?}")
    };
    assert_eq!((line.speed, line.blend), (Speed::MmPerS(30.5), Blend::Level(1)));
    assert_eq!(last.blend, Blend::Unspecified);
}

#[test]
fn pulses_and_external_axes_are_kept_as_they_are() {
    let positions = "///TOOL 0\n///POSTYPE PULSE\n///PULSE\nC00000=100,-200,300,0,0,5\nEC00000=1234,-5";
    let text = job(
        (1, 1),
        positions,
        "MOVJ C00000 EC00000 VJ=5\nMOVJ C00000 VJ=5 +MOVJ EC00000 VJ=5",
    );
    let all = actions(Inform, &[("p.jbi", &text)], "P");
    for joint in joints(&all) {
        assert_eq!(
            joint.to,
            JointTarget::Pulses(vec![100.0, -200.0, 300.0, 0.0, 0.0, 5.0])
        );
        assert_eq!(joint.external, [Some(1234.0), Some(-5.0)]);
    }
    assert_eq!(joints(&all).len(), 2);
}

#[test]
fn instructions_are_events_in_their_order() {
    let text = job(
        (2, 0),
        USER,
        "'load tool 3\nDOUT OT#(12) ON\nTIMER T=2.50\nSET B001 5\nMSG \"load tool 3\"\nPAUSE\nCALL JOB:SUB-1\n\
         CALL JOB:OTHER\nMOVL C00000 V=5 PL=2\nDOUT OT#(12) OFF\nWAIT IN#(3)=ON",
    );
    let sub = job((0, 0), "", "TIMER T=1").replace("//NAME P", "//NAME SUB-1");
    let all = actions(Inform, &[("p.jbi", text.as_str()), ("s.jbi", &sub)], "P");
    assert_eq!(
        all[0],
        Action::Comment {
            text: "load tool 3".to_owned()
        }
    );
    assert_eq!(all[1], output("OT#(12)", "TRUE", false));
    assert_eq!(all[2], Action::Dwell { s: 2.5 });
    assert_eq!(
        all[4],
        Action::Stop {
            message: Some("load tool 3".to_owned())
        }
    );
    assert_eq!(all[5], Action::Dwell { s: 1.0 });
    assert!(matches!(&all[6], Action::Call { name, .. } if name == "OTHER"));
    assert_eq!(all[8], output("OT#(12)", "FALSE", true));
    assert!(matches!(&all[9], Action::Wait { condition } if condition == "IN#(3)=ON"));
}

#[test]
fn what_is_not_known_is_refused_with_its_place() {
    let refused = |text: &str, message: &str| {
        let found = refusal(Inform, &[("p.jbi", text)], "P");
        assert!(found.contains(message), "{found}");
    };
    refused(
        &job((2, 0), USER, "JUMP *A"),
        "p.jbi:19: unknown instruction `JUMP`",
    );
    refused(
        &job((2, 0), USER, "MOVL C00009 V=1"),
        "p.jbi:19: position C00009 is not in the job",
    );
    refused(
        &job((2, 0), USER, "MOVL C00000 V=1 PL=9"),
        "PL=9 is not a position level",
    );
    refused(&job((3, 0), USER, ""), "///NPOS says 3 positions C, found 2");
    refused(
        &job((2, 0), &USER.replace("///TOOL 3\n", ""), ""),
        "p.jbi:9: no ///TOOL above the position",
    );
    refused(
        &job((2, 0), &USER.replace("180.0000", "x"), ""),
        "p.jbi:10: `x` is not a number",
    );
    refused(
        &job((2, 0), USER, "").replace(",RJ", ""),
        "Cartesian positions need ///ATTR with RJ",
    );
    refused(
        &job((2, 0), &USER.replace("POSTYPE USER", "POSTYPE MTOOL"), ""),
        "///POSTYPE MTOOL is not interpreted",
    );
    refused(
        &job((2, 0), &USER.replace("///RECTAN\n", ""), ""),
        "does not fit the position C00000",
    );
    refused(
        &job((2, 0), USER, "").replace("\nEND\n", "\n"),
        "the job has no END",
    );
}

//! KRL programs by hand: what stays between moves, frames, approximation, calls, data lists, refusals.

use crate::event::{Action, Blend, JointTarget, Posture, Speed};
use crate::expect::{actions, joints, linears, output, refusal, same};
use crate::pose::Pose;
use crate::replay::Language::Krl;

/// Actions of these lines in a program.
#[track_caller]
fn lines(text: &str) -> Vec<Action> {
    actions(Krl, &[("p.src", &format!("DEF p()\n{text}\nEND\n"))], "p")
}

#[track_caller]
fn refused(text: &str, message: &str) {
    let found = refusal(Krl, &[("p.src", &format!("DEF p()\n{text}\nEND\n"))], "p");
    assert!(found.contains(message), "{found}");
}

const START: &str = "$BASE={X 100,Y 0,Z 0,A 90,B 0,C 0}\n$TOOL=$NULLFRAME\n";

#[test]
fn omitted_components_keep_their_values() {
    let all = lines(&format!(
        "{START}LIN {{X 1,Y 2,Z 3,A 10,B 20,C 30}}\nLIN {{Z 5}}\nLIN {{X 7,A -10}}"
    ));
    same(
        &linears(&all)[1].to,
        &Pose::kuka([1.0, 2.0, 5.0, 10.0, 20.0, 30.0]),
    );
    same(
        &linears(&all)[2].to,
        &Pose::kuka([7.0, 2.0, 5.0, -10.0, 20.0, 30.0]),
    );
}

#[test]
fn omitted_components_are_converted_where_base_or_tool_changes() {
    let all = lines(&format!(
        "{START}LIN {{X 1,Y 2,Z 3,A 0,B 0,C 0}}\n$BASE={{X 100,Y 0,Z 0,A 0,B 0,C 0}}\nLIN {{Z 5}}\n\
         $TOOL={{X 0,Y 0,Z 50,A 0,B 0,C 0}}\nLIN {{X 0}}"
    ));
    // The base turned by 90 deg: x of it is y of the new one.
    same(
        &linears(&all)[1].to,
        &Pose::kuka([-2.0, 1.0, 5.0, 90.0, 0.0, 0.0]),
    );
    // The tool is longer by 50 mm, and the flange has stayed.
    same(
        &linears(&all)[2].to,
        &Pose::kuka([0.0, 1.0, 55.0, 90.0, 0.0, 0.0]),
    );
}

#[test]
fn omitted_components_need_a_position_that_is_known() {
    refused(&format!("{START}LIN {{X 1}}"), "p.src:4: Y, Z, A, B, C not given");
    refused(
        &format!(
            "{START}LIN {{X 1,Y 2,Z 3,A 0,B 0,C 0}}\nPTP {{A1 0,A2 0,A3 0,A4 0,A5 0,A6 0}}\nLIN {{X 1}}"
        ),
        "p.src:6: Y, Z, A, B, C not given",
    );
    refused(
        "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nBAS(#BASE,3)\nLIN {X 2}",
        "p.src:4: Y, Z, A, B, C not given",
    );
    refused("PTP {A1 0}", "p.src:2: an axis is not given");
}

#[test]
fn axes_with_external_axes_stay_too() {
    let all = lines(
        "BAS(#VEL_PTP,20)\nPTP {E6AXIS: A1 1,A2 -2,A3 3,A4 -4,A5 5,A6 -6,E1 250,E2 30}\nPTP {A2 7,E1 260}",
    );
    let found = joints(&all);
    assert_eq!(
        found[1].to,
        JointTarget::Axes(vec![1.0, 7.0, 3.0, -4.0, 5.0, -6.0])
    );
    assert_eq!(found[1].external, [Some(260.0), Some(30.0)]);
    assert_eq!(found[1].speed, Speed::Percent(20.0));
    assert_eq!(found[1].blend, Blend::Exact);
}

#[test]
fn status_and_turn_are_those_of_the_target() {
    let all = lines(&format!(
        "{START}PTP {{POS: X 1,Y 2,Z 3,A 0,B 0,C 180,S 2,T 'B100011'}}\nPTP {{X 2,T 3}}"
    ));
    let of = |status, turn| Posture::StatusTurn { status, turn };
    let found: Vec<_> = joints(&all).into_iter().map(|joint| joint.to.clone()).collect();
    let [
        JointTarget::Pose { posture: one, .. },
        JointTarget::Pose { posture: two, .. },
    ] = &found[..]
    else {
        panic!("{found:?}")
    };
    assert_eq!((one, two), (&of(Some(2), Some(35)), &of(None, Some(3))));
}

#[test]
fn approximation_is_by_the_distance_that_is_set() {
    let all = lines(&format!(
        "{START}$VEL.CP=0.25\n$APO.CDIS=1.5\n$APO.CPTP=30\nLIN {{X 1,Y 2,Z 3,A 0,B 0,C 0}} C_DIS\nLIN {{X 2}}\n\
         LIN {{X 3}} C_DIS\n$APO.CDIS=0\nLIN {{X 4}} C_DIS\nPTP {{X 5}} C_PTP"
    ));
    let blends: Vec<Blend> = linears(&all).iter().map(|linear| linear.blend).collect();
    assert_eq!(
        blends,
        [
            Blend::DistanceMm(1.5),
            Blend::Exact,
            Blend::DistanceMm(1.5),
            Blend::Exact
        ]
    );
    assert_eq!(joints(&all)[0].blend, Blend::Percent(30.0));
    assert_eq!(linears(&all)[0].speed, Speed::MmPerS(250.0));
    // After INITMOV the values are those of the controller.
    let unknown = lines(&format!(
        "$APO.CDIS=1\nBAS(#INITMOV,0)\n{START}LIN {{X 1,Y 2,Z 3,A 0,B 0,C 0}} C_DIS"
    ));
    assert_eq!(linears(&unknown)[0].blend, Blend::Unspecified);
    assert_eq!(linears(&unknown)[0].speed, Speed::Unspecified);
}

#[test]
fn a_wait_or_an_output_ends_the_move_before_it_exactly() {
    for (statement, exact) in [
        ("WAIT SEC 0.5", true),
        ("$OUT[3]=TRUE", true),
        ("HALT", true),
        ("CONTINUE\n$OUT[3]=TRUE", false),
        ("$VEL.CP=0.1", false),
    ] {
        let all = lines(&format!(
            "{START}$APO.CDIS=1\nLIN {{X 1,Y 2,Z 3,A 0,B 0,C 0}} C_DIS\n{statement}\nLIN {{X 2}}"
        ));
        assert_eq!(linears(&all)[0].blend == Blend::Exact, exact, "{statement}");
    }
}

#[test]
fn frames_are_numbered_and_composed() {
    let files = [
        (
            "p.src",
            "DEF p()\nBAS(#BASE,2)\nBAS(#TOOL,4)\nLIN {X 1,Y 0,Z 0,A 0,B 0,C 0}\n\
             $BASE=BASE_DATA[2]:{X 10,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 2,Y 0,Z 0,A 0,B 0,C 0}\nEND\n",
        ),
        (
            "p.dat",
            "DEFDAT p PUBLIC\nDECL INT used=1\nBASE_DATA[2]={FRAME: X 100,Y 0,Z 0,A 90,B 0,C 0}\nENDDAT\n",
        ),
    ];
    let all = actions(Krl, &files, "p");
    let [first, second] = linears(&all)[..] else {
        panic!("{all:?}")
    };
    assert_eq!(
        (
            first.base.name.as_str(),
            first.tool.name.as_str(),
            first.tool.pose
        ),
        ("2", "4", None)
    );
    same(
        &first.base.pose.unwrap(),
        &Pose::kuka([100.0, 0.0, 0.0, 90.0, 0.0, 0.0]),
    );
    same(
        &second.base.pose.unwrap(),
        &Pose::kuka([100.0, 10.0, 0.0, 90.0, 0.0, 0.0]),
    );
}

#[test]
fn inline_forms_take_their_points_from_the_data_list() {
    let source = "DEF p()\n;FOLD LIN P1 Vel=2 m/s CPDAT1 Tool[1] Base[0];%{PE}\n$BWDSTART=FALSE\nLDAT_ACT=LCPDAT1\n\
        FDAT_ACT=FP1\nBAS(#CP_PARAMS,0.5)\nLIN XP1 C_DIS\n;ENDFOLD\nXP1.Z=XP1.Z+10\nLIN XP1\nEND\n";
    let data = "DEFDAT p\nDECL E6POS XP1={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 10,E1 5}\n\
        DECL FDAT FP1={TOOL_NO 1,BASE_NO 0,IPO_FRAME #BASE,POINT2[] \" \"}\n\
        DECL LDAT LCPDAT1={VEL 2.0,ACC 100,APO_DIST 100}\nENDDAT\n";
    let all = actions(Krl, &[("p.src", source), ("p.dat", data)], "p");
    let [first, second] = linears(&all)[..] else {
        panic!("{all:?}")
    };
    assert_eq!(
        (first.speed, first.blend),
        (Speed::MmPerS(500.0), Blend::Unspecified)
    );
    assert_eq!(
        (first.base.pose, first.tool.name.as_str()),
        (Some(Pose::IDENTITY), "1")
    );
    assert_eq!(first.external, [Some(5.0)]);
    same(&second.to, &Pose::kuka([1.0, 2.0, 13.0, 0.0, 0.0, 0.0]));
}

#[test]
fn routines_in_the_files_run_and_others_are_calls() {
    let main = "DEF p()\nsub()\nTOOL_CHANGE(3, {X 1})\nMsgNotify(\"load tool 3, then start\")\nHALT\nEND\n\
        DEF sub()\nWAIT SEC 1+1/2\nRETURN\nHALT\nEND\n";
    let all = actions(Krl, &[("p.src", main)], "p");
    assert_eq!(all[0], Action::Dwell { s: 1.5 });
    assert!(
        matches!(&all[1], Action::Call { name, arguments } if name == "TOOL_CHANGE" && arguments.len() == 2)
    );
    assert!(matches!(&all[2], Action::Call { name, .. } if name == "MsgNotify"));
    let message = Some("load tool 3, then start".to_owned());
    assert_eq!(all[3..], [Action::Stop { message }]);
    assert!(refusal(Krl, &[("p.src", "DEF p()\np()\nEND\n")], "p").contains("p.src:2: more than 32 calls"));
}

#[test]
fn outputs_have_the_name_of_their_signal_and_arcs_their_middle() {
    let data = "DEFDAT p\nSIGNAL spindle $OUT[7]\nENDDAT\n";
    let source = "DEF p()\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\nspindle=TRUE ; on\n$ANOUT[1]=0.5\n\
        LIN {X 1,Y 2,Z 3,A 0,B 0,C 0}\nCIRC {X 2,Y 3},{X 3,Y 2}\nLIN_REL {Z -4}\nEND\n";
    let all = actions(Krl, &[("p.src", source), ("p.dat", data)], "p");
    assert_eq!(all[..1], [output("$OUT[7]", "TRUE", false)]);
    assert_eq!(
        all[1],
        Action::Comment {
            text: "on".to_owned()
        }
    );
    assert_eq!(all[2], output("$ANOUT[1]", "0.5", false));
    let Action::Circular { via, end } = &all[4] else {
        panic!("{all:?}")
    };
    same(via, &Pose::kuka([2.0, 3.0, 3.0, 0.0, 0.0, 0.0]));
    same(&end.to, &Pose::kuka([3.0, 2.0, 3.0, 0.0, 0.0, 0.0]));
    same(&linears(&all)[1].to, &Pose::kuka([3.0, 2.0, -1.0, 0.0, 0.0, 0.0]));
}

#[test]
fn what_is_not_known_is_refused_with_its_place() {
    refused("WAIT SEC 1\nSPLINE", "p.src:3: unknown statement `SPLINE`");
    refused("IF $IN[1] THEN", "p.src:2: unknown statement `IF`");
    refused("$SECRET=1", "p.src:2: unknown system variable `$SECRET`");
    refused("BAS(#SECRET)", "p.src:2: unknown BAS(#SECRET)");
    refused("PTP XP9", "p.src:2: `XP9` is not defined in these files");
    refused("LIN {X 1,Q 2}", "p.src:2: ");
    refused(
        "LIN {X 1,Y 2,Z 3,A 0,B 0,C 0} C_FOO",
        "the end of the statement expected, found `C_FOO`",
    );
    refused(
        "PTP {A1 0,A2 0,A3 0,A4 0,A5 0,A6 0",
        "p.src:2: `}` expected, found the end",
    );
    refused("$IPO_MODE=#TCP", "only $IPO_MODE=#BASE is interpreted");
    assert!(refusal(Krl, &[("p.src", "DEF p()\n")], "p").contains("DEF P has no END"));
    assert!(refusal(Krl, &[("p.src", "DEF p()\nEND\n")], "q").contains("no DEF q"));
}

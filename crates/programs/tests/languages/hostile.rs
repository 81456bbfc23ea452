//! Programs with one wrong character, and programs that could take long to read.

use armill_core::frame::Isometry;
use armill_programs::{Motion, Moved, ProgramText, RobotProgram, Target, inform, krl, rapid, tp, urscript};

use proptest::prelude::*;

use crate::rewriting::all_moved;

type Read = fn(Vec<ProgramText>) -> Result<RobotProgram, armill_formats::document::Problems>;

/// A program with all that its language has, on few lines.
const PROGRAMS: &[(Read, &str, &str)] = &[
    (
        inform::read,
        "a.jbi",
        "/JOB\n//POS\n///USER 2\n///TOOL 1\n///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,1\nC1=1,2.5,-3,10,20.25,30\nC2=4,5,6,0,0,0,7\n///POSTYPE \
         PULSE\nC3=1,2,3,4,5,6\nEC1=7\n//INST\n///ATTR SC,RW,RJ\nNOP\n'\u{e4} C9\nMOVJ C3 VJ=5.0\nMOVL C1 V=10.5 PL=1 //x\nMOVC C1 V=5\nMOVC C2 V=5\nMOVC C1 V=5 \
         FPT\nMOVS P001 V=I000 +MOVJ EC1\nCALL JOB:B\nEND\n",
    ),
    (
        tp::read,
        "a.ls",
        "/PROG A\n/MN\n 1:!\u{e4} ;\n 2:UFRAME_NUM=2 ;\n 3:PR[9,1]=(-1.5) ;\n 4:UTOOL[1]=PR[9] ;\n 5:J P[1:a b] 20% FINE ;\n 6:L P[2] 100mm/sec CNT5 Offset,PR[1] ;\n 7:C P[2]\n \
         :  P[3] 5cm/min FINE ;\n 8:L PR[R[1]] R[2]mm/sec FINE ;\n/POS\nP[1]{\nGP1:\nUF : 2, UT : 1,\nJ1= 1 deg,J2=2 deg\nGP2:\nJ1= 5 mm\n};\nP[2]{\nUF : F, UT : 1, CONFIG : \
         'F U T, 0, 0, -1',\nX = 1.5 mm, Y = -.5 mm, Z = 3 mm,\nW = 4 deg, P = 5 deg, R = 6 deg\n};\nP[3]{\nUF : F, UT : 1,\nX=1 mm,Y=2 mm,Z=3 mm,W=4 deg,P=5 deg,R=6 deg};\n/END\n",
    ),
    (
        krl::read,
        "a.src",
        "DEF A()\nDECL FDAT FP1={TOOL_NO 2,BASE_NO 5,IPO_FRAME #BASE}\n$BASE={FRAME: X 1,Y 2.5,Z 3,A 4,B 5,C 6}:$NULLFRAME\n\
         P[1]={E6POS: X 1,Y 2,Z 3,A 0,B 0,C 0,S 'B10',T 35}\nPTP P[1] C_PTP\nLIN {X 20.125 ,B -.5E1}\nLIN_REL {Z 10} #TOOL C_DIS\n\
         SLIN P[1]:{X 1,Y 2,Z 3,A 4,B 5,C 6} WITH $VEL=SVEL_CP(0.4, ,L), $BASE=SBASE(FP1.BASE_NO)\n\
         BAS(#BASE,4)\nPTP P[1]\nCIRC {X 1},{Y 2} ; \"\u{e4}\nPTP {A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\nEND\n",
    ),
    (
        rapid::read,
        "a.mod",
        "%%%\nVERSION:1\n%%%\nMODULE M\nCONST robtarget p{2}:=[[[1,2,3],[1,0,0,0],[0,1,-1,1],[9E9,9E9,9E9,9E9,9E9,5]],q];\n\
         LOCAL PERS tooldata t:=[TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nVAR robtarget q:=[[4,5,6],[1,0,0,0],[0,0,0,0],[9E9]];\n\
         PROC a(num x)\nMoveAbsJ [[1,2,3,4,5,6],[9E9,9E9,9E9,9E9,9E9,9E9]]\\NoEOffs,v5,fine,t;\nIF x=1 THEN\nq.trans.z:=7;ENDIF\n\
         FOR i FROM 1 TO 2 DO MoveL q,v100\\V:=5,z1,t,\\WObj:=wobj0; ENDFOR ! \u{e4}\n\
         MoveC p{1},Offs(RelTool(p{1},1,2,3\\Rx:=90),0,0,-5.5),[5,1,1,1],z1,t;\nl1: MoveJ p{2},vmax,z1,tool0;\nIF x=1 MoveL p{1},v1,z0,t;\nENDPROC\nENDMODULE\n",
    ),
    (
        urscript::read,
        "a.script",
        "def a(x):\n  f = p[1, 2, 3, 0.1, -.2, d2r(30)]\n  q = [0, 1, (2 + 3) * 4, 5, 6, f[1]]\n  while True:\n  movej([0, 1, 2, 3, 4, 5], a=1)\n\
         movel(pose_trans(f, p[1e-1,2,3 ,0,0,0]), 1.2, 0.25, 0, r=0.01) # \u{e4}\n  movec(f, pose_inv(f))\n\
         movej(get_inverse_kin(f, qnear=q))\n  set_tcp(f)\n  textmsg(\"a)\", 'b')\nend\n",
    ),
];

/// That what is read is made of numbers, and reads again when written with the poses that it has.
fn check(read: Read, text: &str) {
    let Ok(program) = read(vec![ProgramText::new("a", text.as_bytes())]) else {
        return;
    };
    for of in &program.moves {
        if let Target::Pose { pose, spelled, .. } = &of.target {
            assert!(
                pose.to_homogeneous().iter().all(|value| value.is_finite()),
                "{text}"
            );
            let spelled_in = program.texts[spelled.text].text();
            assert!(spelled_in.get(spelled.bytes.clone()).is_some(), "{text}");
        }
        if let Target::Joints(joints) = &of.target {
            assert!(joints.iter().all(|value| value.is_finite()), "{text}");
        }
    }
    // Two moves to one target with missing components go to different places: only that is reported.
    if let Ok(files) = program.with_poses(&all_moved(&program, |pose| *pose)) {
        let texts = files.iter().map(|(name, bytes)| ProgramText::new(name, bytes));
        let again = read(texts.collect()).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        assert_eq!(program.moves.len(), again.moves.len(), "{text}");
        for (of, again) in program.moves.iter().zip(&again.moves) {
            if let (Some(one), Some(other)) = (of.target.pose(), again.target.pose()) {
                let far = one.translation.vector.amax() * 1e-12;
                let apart = (one.translation.vector - other.translation.vector).amax();
                let matrix = |pose: &Isometry| *pose.rotation.to_rotation_matrix().matrix();
                let turned = (matrix(one) - matrix(other)).amax();
                // Half of three decimals of a mm; of three decimals of a degree, three times.
                assert!(apart < 0.51e-6 + far && turned < 3e-5, "{apart} {turned}\n{text}");
            }
        }
    }
}

#[test]
fn every_language_reads_its_own_program_here() {
    for (read, name, text) in PROGRAMS {
        let program =
            read(vec![ProgramText::new(name, text.as_bytes())]).unwrap_or_else(|given| panic!("{given}"));
        assert!(program.moves.len() >= 4, "{name}");
        let arcs = |of: &Moved| matches!(program.moves[of.index].motion, Motion::Circular { .. });
        assert!(all_moved(&program, |pose| *pose).iter().any(arcs), "{name}");
    }
}

#[test]
fn no_wrong_character_makes_any_language_panic() {
    for (read, _, text) in PROGRAMS {
        for (at, c) in text.char_indices() {
            check(*read, &text[..at]);
            for with in [
                "", "{", "}", "[", "(", ")", "]", ",", ":", "=", "\"", "\n", "-", "9", "x", "\\", ";",
                "\u{fc}",
            ] {
                check(
                    *read,
                    &format!("{}{with}{}", &text[..at], &text[at + c.len_utf8()..]),
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 3000, ..ProptestConfig::default() })]

    /// Pieces of the programs, cut anywhere, put together in any order, with marks in between.
    #[test]
    fn no_pieces_put_together_make_any_language_panic(
        pieces in prop::collection::vec((any::<usize>(), any::<usize>(), 0..60usize, "[-{}()\\[\\],:=.;#+*/\\n 0-9eE]{0,3}"), 1..12),
        begin in any::<bool>(),
    ) {
        for (read, _, text) in PROGRAMS {
            let mut all = if begin { (*text).to_owned() } else { String::new() };
            for (from, to, length, marks) in &pieces {
                let characters: Vec<char> = text.chars().collect();
                let from = from % characters.len();
                let piece: String = characters.iter().skip(from).take(*length).collect();
                let at = all.char_indices().nth(to % (all.chars().count() + 1)).map_or(all.len(), |(at, _)| at);
                all.insert_str(at, &format!("{piece}{marks}"));
            }
            check(*read, &all);
        }
    }
}

#[test]
fn deep_nesting_and_long_repetition_are_read_quickly() {
    let many = 50_000;
    for (read, ..) in PROGRAMS {
        for piece in [
            "{",
            "(",
            "[",
            "p[",
            "-",
            "movel(",
            "LIN {",
            "LIN P:",
            "A=",
            "A=B\n",
            "[(",
            "pose_trans(",
            "WITH ",
            ",",
            "f(x)\n",
            "\"",
            "MoveL [[",
            "\\",
            ":=",
            "p.x",
            "IF ",
            "MoveL Offs(",
            "Offs(p,1",
            "1+",
        ] {
            check(*read, &piece.repeat(many));
            check(*read, &format!("MODULE a\nDEF A()\nmovel({}", piece.repeat(many)));
            check(*read, &format!("LIN {}", piece.repeat(many)));
            check(*read, &format!("CONST robtarget p:={}", piece.repeat(many)));
        }
    }
}

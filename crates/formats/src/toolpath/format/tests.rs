use super::*;
use crate::language::Language;

fn of(name: &str, text: &str) -> Result<Format, String> {
    Format::of(Path::new(name), text).map_err(|problems| problems.to_string())
}

#[test]
fn the_format_is_recognised_from_the_content_with_any_name() {
    for name in ["part.txt", "part", "part.nc", "part.csv"] {
        for (text, format) in [
            ("PARTNO/1\r\nUNIT/MM\r\n", Format::Apt),
            ("$$ written by me\nTOOL PATH/A,TOOL,B\n", Format::Apt),
            ("INSERT/x\ngoto / 1,2,3\n", Format::Apt),
            ("\u{feff}# path\nx_mm;y_mm;z_mm;op\n1;2;3;a\n", Format::Csv),
            ("\"X [mm]\",\"Y [mm]\",\"Z [mm]\"\n", Format::Csv),
            ("x,y,z\n1,2,3\n", Format::Csv),
            ("%\nO1234 (PART)\n", Format::Gcode),
            ("(a program)\n; more\nN10 G21\nG1 X1\n", Format::Gcode),
            ("g0x1y2", Format::Gcode),
            ("/N5 G0 Z1\n", Format::Gcode),
            ("#1=5\nG1 X#1\n", Format::Gcode),
        ] {
            assert_eq!(of(name, text), Ok(format), "{name}: {text}");
        }
    }
}

#[test]
fn the_format_is_recognised_from_the_name_if_the_content_is_unclear() {
    assert_eq!(of("a.NGC", "(nothing yet)\n"), Ok(Format::Gcode));
    assert_eq!(of("a.cls", "$$ nothing yet\n"), Ok(Format::Apt));
    assert_eq!(of("a.csv", "1,2,3\n"), Ok(Format::Csv));
    let given = of("a.pdf", "hello\n").unwrap_err();
    assert!(
        given.contains("neither content nor file name") && given.contains("G-code, cutter locations"),
        "{given}"
    );
}

#[test]
fn programs_of_robots_are_known_by_their_lines() {
    for (text, language) in [
        ("&ACCESS RVP\nDEF part()\n", Language::Krl),
        ("; part\nLIN {X 1,Y 2}\n", Language::Krl),
        ("%%%\n VERSION:1\n%%%\nMODULE m\n", Language::Rapid),
        ("  MoveL p1,v100,fine,tool0;\n", Language::Rapid),
        ("/PROG  PART\n/ATTR\n", Language::Tp),
        ("/JOB\n//NAME PART\n", Language::Inform),
        ("def part():\n  movel(p[1,2,3,0,0,0])\n", Language::UrScript),
        (
            "<?xml version=\"1.0\"?>\n<Programs xmlns=\"x\">\n",
            Language::Val3,
        ),
    ] {
        assert_eq!(of("part.txt", text), Ok(Format::Robot(language)), "{text}");
        let given = read(
            "part.txt",
            text.as_bytes(),
            &ToolpathReadOptions::default(),
            &mut |_| (),
        )
        .unwrap_err();
        assert!(given.to_string().contains(language.title()), "{given}");
    }
    assert_eq!(of("a.src", "hello\n"), Ok(Format::Robot(Language::Krl)));
    let val3 = "nTraj=movel(pPoint[0],tTool[0],mNomSpeed)\n";
    assert_eq!(of("start.pgx", val3), Ok(Format::Robot(Language::Val3)));
    let comau = of("a.pdl", "PROGRAM a\nMOVE LINEAR TO p1\n").unwrap_err();
    assert!(
        comau.contains("Comau PDL2") && comau.contains("not supported"),
        "{comau}"
    );
}

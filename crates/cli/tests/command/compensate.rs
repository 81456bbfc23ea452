//! `armill compensate`: before and after, and a path that armill reads again.

use crate::cell::{Cell, number};

const CELL: &str = r#"format = 1
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [1000, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool = { flange_from_tool_mm_deg = [0, 0, 150, 0, 0, 0] }
[load]
frame = "feed"
cases_n = [[-60, 40, 25]]
"#;
const RING: &str = "G21 G90 G17\nG0 X40 Y0 Z10\nG0 Z0\nG3 X40 Y0 I-40 J0 F600\nG1 X0 Y20\nG0 Z10\nM2\n";

/// A cell with this program in it.
pub fn cell(program: &str, rest: &str) -> Cell {
    let cell = Cell::new();
    cell.file("ring.ngc", RING);
    cell.file(
        "study.toml",
        format!("{CELL}[[analysis]]\nkind = \"path\"\nname = \"ring\"\nprogram = {{ {program} }}\n{rest}"),
    );
    cell
}

#[test]
fn the_commanded_path_read_again_deviates_onto_the_nominal_one() {
    let cell = cell("file = \"ring.ngc\", limits = false", "");
    let said = cell.armill(&["compensate", "study.toml"]).fine();
    assert!(
        said.out.starts_with("ring: largest deviation of the tool "),
        "{}",
        said.out
    );
    let given = cell.armill(&["compensate", "study.toml", "--json"]).fine().json();
    let path = &given["paths"][0];
    let (before, after) = (
        number(&path["before"]["max_um"]),
        number(&path["after"]["max_um"]),
    );
    assert!(before > 100.0 && after < 0.01, "{before} um, then {after} um");
    assert!(number(&path["largest_correction_um"]) > 0.99 * before);
    // Both paths run: each deviates from what it commands, so the difference of the tables is what was taken off.
    cell.armill(&["run", "study.toml", "--no-pictures", "--out", "drawn"])
        .fine();
    let again = std::fs::read_to_string(cell.at("study.toml")).unwrap().replace(
        "ring.ngc\"",
        "compensated/ring.commanded.csv\", spin = \"given\", step_mm = 50",
    );
    cell.file("again.toml", &again);
    cell.armill(&["run", "again.toml", "--no-pictures", "--out", "again"])
        .fine();
    let (drawn, commanded) = (rows(&cell, "drawn"), rows(&cell, "again"));
    // The table has every point: with long steps its program is sampled at them.
    assert_eq!(drawn.len(), commanded.len());
    for (drawn, commanded) in drawn.iter().zip(&commanded).step_by(7) {
        let full = number_of(commanded, "full_um");
        let apart: f64 = ["x_mm", "y_mm", "z_mm"]
            .iter()
            .map(|axis| (number_of(drawn, axis) - number_of(commanded, axis)).powi(2))
            .sum::<f64>()
            .sqrt();
        // Forces turn with the feed, which a table has by its chords: 1 mm on an arc of 40 mm turns by 0.025 rad.
        assert!(
            (apart * 1e3 - full).abs() < 0.03 * full,
            "{} um and {full} um",
            apart * 1e3
        );
    }
}

type Row = std::collections::BTreeMap<String, String>;

/// The table of the path.
fn rows(cell: &Cell, folder: &str) -> Vec<Row> {
    let text = std::fs::read_to_string(cell.at(&format!("{folder}/ring.csv"))).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .map(|line| {
            names
                .iter()
                .map(|name| (*name).to_owned())
                .zip(line.split(',').map(str::to_owned))
                .collect()
        })
        .collect()
}

fn number_of(row: &Row, name: &str) -> f64 {
    row[name].parse().unwrap()
}

/// Changes `study.toml` of the cell: its spindle is across the flange, so that the spin of the tool matters, and the
/// posture changes however little is gained.
fn any_gain(cell: &Cell) {
    let study = std::fs::read_to_string(cell.at("study.toml")).unwrap();
    let bent = study.replace("[0, 0, 150, 0, 0, 0]", "[120, 0, 150, 0, 90, 0]");
    assert_ne!(bent, study);
    cell.file(
        "study.toml",
        format!("improvement = {{ coverage_factor = 0 }}\n{bent}"),
    );
}

#[test]
fn turns_that_are_searched_for_are_part_of_the_path() {
    let search = "posture = { search = { step_deg = 10 } }\n";
    let cell = cell("file = \"ring.ngc\", limits = false", search);
    any_gain(&cell);
    cell.armill(&["compensate", "study.toml", "--out", "c"]).fine();
    let table = std::fs::read_to_string(cell.at("c/ring.commanded.csv")).unwrap();
    let spins: Vec<f64> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(6).unwrap().parse().unwrap())
        .collect();
    assert!(spins.iter().all(|spin| spin.abs() > 1.0), "{spins:?}");
    assert!(cell.at("c/ring-compensated.svg").exists());
}

#[test]
fn a_robot_program_follows_the_commanded_path_and_retracts_between_cuts() {
    use armill_programs::{Frame, Motion, ProgramText, Speed, Target, read};
    let cell = cell("file = \"ring.ngc\", limits = false", "");
    // Two cuts with a rapid between them.
    cell.file(
        "ring.ngc",
        format!(
            "{}G0 Z10\nG0 X-40 Y0\nG0 Z0\nG1 X-10 F300\nG0 Z10\nM2\n",
            RING.trim_end_matches("G0 Z10\nM2\n")
        ),
    );
    for ending in ["src", "mod", "jbi", "ls", "script"] {
        let file = format!("prog/ring.{ending}");
        cell.armill(&["compensate", "study.toml", "--program", &file, "--within-um", "5"])
            .fine();
        let name = std::fs::read_dir(cell.at("prog"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .find(|path| {
                path.extension()
                    .is_some_and(|other| other.eq_ignore_ascii_case(ending))
            })
            .unwrap();
        let text = ProgramText::new(&name.display().to_string(), &std::fs::read(&name).unwrap());
        let program = read(vec![text]).unwrap();
        // The zero is 500 mm above the floor, and the controller is relative to 450 mm.
        if let Frame::Given(frame) = program.moves[program.moves.len() - 1].frame {
            let z = frame.translation.vector.z;
            assert!((z - 0.05).abs() < 1e-9 || z.abs() < 1e-12, "{ending}: {z}");
        }
        let linear: Vec<_> = program
            .moves
            .iter()
            .filter(|next| next.motion == Motion::Linear)
            .collect();
        assert_eq!(
            program.moves.len() - linear.len(),
            1,
            "{ending}: the first rapid is reached by joints, the others are followed"
        );
        // Up at the end: the last rapid, 10 mm; the compensated end is lower by its correction.
        let at = |target: &Target| target.pose().unwrap().translation.vector;
        let last = [linear[linear.len() - 2], linear[linear.len() - 1]].map(|next| at(&next.target));
        let up = (last[1] - last[0]).norm();
        assert!((up - 0.01).abs() < 2e-3, "{ending}: {up}");
        // 600 and 300 mm/min: 10 and 5 mm/s.
        let speeds: Vec<f64> = linear
            .iter()
            .filter_map(|next| match next.speed {
                Speed::Tip(speed) => Some((speed * 1e4).round() / 1e4),
                _ => None,
            })
            .collect();
        assert!(
            speeds.contains(&0.01)
                && speeds.contains(&0.005)
                && speeds.contains(&0.1)
                && speeds.len() == linear.len(),
            "{ending} {speeds:?}"
        );
        // A circle of 40 mm in chords of 5 um sagitta, and few points more.
        assert!(
            linear.len() > 60 && linear.len() < 400,
            "{ending}: {}",
            linear.len()
        );
    }
    cell.armill(&["compensate", "study.toml", "--program", "ring.txt"])
        .refused(&["is not that of a robot language"]);
    cell.armill(&["compensate", "study.toml", "--program", "1ring.src"])
        .refused(&["`1ring` is not a valid name in KUKA KRL"]);
}

/// A cut in the language of KUKA; the controller of the arm counts from 450 mm above the floor.
const KRL: &str = "&ACCESS RVP\r\nDEF part ( ) ; \u{fc}ber\r\n$BASE={X 1000,Y 0,Z 50,A 0,B 0,C 0}\r\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\r\n\
    PTP {X -40,Y -40,Z 0,A 0,B 180,C 0,S 2,T 35}\r\n$VEL.CP=0.01\r\nLIN {X 40,Y -40,Z 0,A 0,B 180,C 0} C_DIS ; side\r\n\
    CIRC {X 60,Y 0,Z 0,A 0,B 180,C 0},{X 40,Y 40,Z 0,A 0,B 180,C 0}\r\nLIN {X -40,Y 40,Z 0,A 0,B 180,C 0}\r\n\
    LIN {X -40,Y -40,Z 0,A 0,B 180,C 0}\r\nPTP {X -40,Y -40,Z 60,A 0,B 180,C 0,S 2,T 35}\r\nEND\r\n";

#[test]
fn a_robot_program_is_rewritten_with_changed_targets_only() {
    use armill_programs::{ProgramText, read};
    let cell = cell("file = \"part.src\", limits = false", "");
    cell.file("part.src", KRL);
    // A force that stays as it is: only what the posture changes is left between the targets.
    let study = std::fs::read_to_string(cell.at("study.toml")).unwrap();
    cell.file("study.toml", study.replace("frame = \"feed\"\n", ""));
    let given = cell
        .armill(&["compensate", "study.toml", "--json", "--out", "c"])
        .fine()
        .json();
    let path = &given["paths"][0];
    let of = |key: &str| number(&path[key]["max_um"]);
    let placed = number(&path["in_place"]["after"]["max_um"]);
    assert!(of("before") > 500.0 && of("after") < 0.01, "{path}");
    // 80 mm of way change the compliance by some percent.
    assert!(placed < 0.03 * of("before"), "{placed} um");
    assert_eq!(path["in_place"]["moved_targets"], 6);
    let written = std::fs::read_to_string(cell.at("c/part.src")).unwrap();
    let places = |text: &str| {
        let program = read(vec![ProgramText::new("part.src", text.as_bytes())]).unwrap();
        let poses = program
            .moves
            .iter()
            .map(|of| of.target.pose().unwrap().translation.vector);
        poses.collect::<Vec<_>>()
    };
    let (before, after) = (places(KRL), places(&written));
    let moved: Vec<f64> = before
        .iter()
        .zip(&after)
        .map(|(a, b)| (a - b).norm() * 1e6)
        .collect();
    // The position above the part cuts nothing and is unchanged; all others move by about the deflection of the robot.
    assert_eq!(moved[5], 0.0);
    assert!(
        moved[..5].iter().all(|by| (by / of("before") - 1.0).abs() < 0.2),
        "{moved:?}"
    );
    // Without the numbers of places it is the same text, byte for byte.
    let rest = |text: &str| -> String {
        let mut out = String::new();
        let mut rest = text;
        while let Some(at) = rest.find(['X', 'Y', 'Z']) {
            let (head, tail) = rest.split_at(at + 1);
            out.push_str(head);
            rest = tail.trim_start_matches(|c: char| " -.0123456789".contains(c));
        }
        out + rest
    };
    assert_eq!(rest(KRL), rest(&written));
    assert_ne!(KRL, written);
    // The written program, run as it is, deviates onto the nominal path, as was reported.
    cell.file(
        "again.toml",
        study
            .replace("frame = \"feed\"\n", "")
            .replace("part.src", "c/part.src"),
    );
    cell.armill(&["run", "study.toml", "--no-pictures", "--out", "drawn"])
        .fine();
    cell.armill(&["run", "again.toml", "--no-pictures", "--out", "again"])
        .fine();
    let table = |folder: &str| {
        let text = std::fs::read_to_string(cell.at(&format!("{folder}/ring.csv"))).unwrap();
        let names: Vec<String> = text
            .lines()
            .next()
            .unwrap()
            .split(',')
            .map(str::to_owned)
            .collect();
        let at = |row: &str, name: &str| -> f64 {
            let cells: Vec<&str> = row.split(',').collect();
            cells[names.iter().position(|known| known == name).unwrap()]
                .parse()
                .unwrap()
        };
        let place = |row: &str| {
            ["x", "y", "z"].map(|axis| {
                at(row, &format!("{axis}_mm")) * 1e3 + at(row, &format!("deviation_{axis}_case_1_um"))
            })
        };
        let first = text.lines().nth(1).unwrap();
        (
            place(first),
            ["x_mm", "y_mm", "z_mm"].map(|name| at(first, name) * 1e3),
        )
    };
    let ((written, _), (_, nominal)) = (table("again"), table("drawn"));
    let apart: f64 = written
        .iter()
        .zip(nominal)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt();
    assert!(apart <= placed + 1.0, "{apart} um, {placed} um reported");
    // Over itself it is not written.
    cell.armill(&["compensate", "study.toml", "--out", "."])
        .refused(&["part.src", "this command reads that file"]);
}

#[test]
fn reports_why_a_program_is_not_rewritten() {
    let cell = cell("file = \"part.src\", limits = false", "");
    cell.file(
        "part.src",
        KRL.replace("LIN {X -40,Y 40,Z 0,A 0,B 180,C 0}", "LIN_REL {X -80}"),
    );
    let said = cell.armill(&["compensate", "study.toml"]).fine();
    // A step from a target that moves is written as a place of its own.
    assert!(said.out.contains("part.src written with"), "{}", said.out);
    let study = std::fs::read_to_string(cell.at("study.toml")).unwrap();
    let program = "file = \"part.src\", limits = false";
    let spun = study.replace(program, &format!("{program}, spin = \"along-feed\""));
    assert_ne!(spun, study);
    cell.file("study.toml", spun);
    let said = cell.armill(&["compensate", "study.toml", "--out", "s"]).fine();
    assert!(
        said.out
            .contains("the program itself is not written again: the study turns the tool"),
        "{}",
        said.out
    );
    assert!(!cell.at("s/part.src").exists());
    cell.armill(&["compensate", "part.src"]).refused(&[
        "part.src is a program of a robot (KUKA KRL), not a study",
        "program = { file = \"part.src\" }",
    ]);
}

const CIRCLE: &str = "[[analysis]]\nkind = \"path\"\nname = \"round\"\ncircle.radius_mm = 40\nstep_mm = 2\n";

/// Places of the straight moves of a KRL program, mm.
fn places(cell: &Cell, program: &str) -> Vec<[f64; 3]> {
    let text = std::fs::read_to_string(cell.at(program)).unwrap();
    let place = |line: &str| {
        let mut numbers = line.strip_prefix("LIN {X ")?.split([' ', ',']);
        let mut next = || numbers.find_map(|word| word.parse().ok());
        Some([next()?, next()?, next()?])
    };
    text.lines().filter_map(place).collect()
}

#[test]
fn the_program_of_a_circle_ends_where_it_begins() {
    let cell = Cell::with_study(&format!("{CELL}{CIRCLE}"));
    let all = [
        "compensate",
        "study.toml",
        "--program",
        "round.src",
        "--feed-mm-per-min",
        "600",
    ];
    cell.armill(&all).fine();
    let places = places(&cell, "round.src");
    // Down to the first point at the beginning, up from the last at the end.
    let [first, .., last, up] = places[..] else {
        panic!("{places:?}")
    };
    assert_eq!(first, last);
    // 50 mm above its end, and at least as much above the nominal circle, which is at 0.
    assert!((up[2] - last[2].max(0.0) - 50.0).abs() < 2e-3, "{places:?}");
    let table = std::fs::read_to_string(cell.at("compensated/round.commanded.csv")).unwrap();
    cell.armill(&[&all[..], &["--retract-mm", "5000"]].concat())
        .refused(&["the robot cannot retract by 5000", "a shorter --retract-mm"]);
    let rows: Vec<&str> = table.lines().filter(|line| line.starts_with('-')).collect();
    let of = |row: &str| row.split(',').take(3).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(of(rows[0]), of(rows[rows.len() - 1]));
}

#[test]
fn a_nominal_path_is_not_compensated() {
    let cell = Cell::with_study(&format!("{CELL}{CIRCLE}"));
    let all = [
        "compensate",
        "study.toml",
        "--nominal",
        "--program",
        "round.src",
        "--feed-mm-per-min",
        "600",
    ];
    let said = cell.armill(&all).fine();
    assert!(
        said.out
            .starts_with("round: not compensated; largest deviation of the tool "),
        "{}",
        said.out
    );
    let places = places(&cell, "round.src");
    for [x, y, z] in &places[..places.len() - 1] {
        assert!((x.hypot(*y) - 40.0).abs() < 1e-3 && *z == 0.0, "{x} {y} {z}");
    }
    assert!(!cell.at("compensated/round-compensated.svg").exists());
    let given = cell.armill(&[&all[..], &["--json"]].concat()).fine().json();
    let path = &given["paths"][0];
    assert_eq!(
        (&path["rounds"], &path["largest_correction_um"]),
        (&0.into(), &0.0.into())
    );
    assert_eq!(path["before"], path["after"]);
    assert!(number(&path["before"]["max_um"]) > 50.0);
}

#[test]
fn reports_what_cannot_be_compensated() {
    let cell = cell("file = \"ring.ngc\"", "");
    cell.armill(&["compensate", "study.toml", "--analysis", "rim"])
        .refused(&["no path or holes called `rim`"]);
    cell.file("map.toml", CELL.replace("frame = \"feed\"", ""));
    cell.armill(&["compensate", "map.toml"]).refused(&["has no path"]);
}

//! The programs that `armill compensate` writes, run by the interpreters and compared with its table of points: of an
//! example study and of robot programs in six languages, and of tool paths of other software in two each.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::checks::{
    ANGLE_DEG, Cut, CutPoint, Matches, POSITION_MM, blends_apart, clear, feeds, follows, no_stop_in_cut,
    spindle_on, within_limits,
};
use crate::event::{Action, Event, JointTarget, LinearMove, Reference};
use crate::expect::same_within;
use crate::pose::Pose;
use crate::replay::{Language, run, run_folder};
use crate::source::ReplayError;

/// Frame of the example study.
const FRAME: [f64; 6] = [1700.0, 200.0, 900.0, -90.0, 0.0, 0.0];
const TOOL: [f64; 6] = [0.0, 90.0, 260.0, 0.0, 0.0, 0.0];
/// A spindle at 45 deg to the flange, for tools that lean in all directions.
const LEANING_TOOL: [f64; 6] = [0.0, 45.0, 260.0, 0.0, 45.0, 0.0];

/// Language, file of the program, and statements of the cell that switch the spindle on and off.
type Program = (Language, &'static str, [&'static str; 2]);

const PROGRAMS: [Program; 6] = [
    (Language::Krl, "krl/pocket.src", ["$OUT[5]=TRUE", "$OUT[5]=FALSE"]),
    (
        Language::Rapid,
        "rapid/pocket.mod",
        ["SetDO do_spindle,1;", "SetDO do_spindle,0;"],
    ),
    (
        Language::Inform,
        "inform/pocket.jbi",
        ["DOUT OT#(5) ON", "DOUT OT#(5) OFF"],
    ),
    (Language::Tp, "tp/pocket.ls", ["DO[5]=ON", "DO[5]=OFF"]),
    (
        Language::UrScript,
        "urscript/pocket.script",
        ["set_digital_out(5,True)", "set_digital_out(5,False)"],
    ),
    (
        Language::Val3,
        "val3/pocket.pjx",
        // Outputs are in the data of a project: a routine of the cell switches them.
        ["call spindleOn()", "call spindleOff()"],
    ),
];

/// Home position of the robot, deg: the tool points down above the part.
const HOME: [f64; 6] = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A study with one path, and where its part and tool are.
struct Case {
    /// Text of the study.
    study: String,
    /// Folder that the study refers to.
    folder: PathBuf,
    /// For messages.
    name: String,
    /// Name of the path.
    path: &'static str,
    /// X, Y, Z in mm and A, B, C in deg of the plane of the study, which is the user frame of its programs.
    frame: [f64; 6],
    /// The same of the tool in the flange.
    tool: [f64; 6],
    /// Height above which the tool moves freely, mm.
    clearance_mm: f64,
    /// Changes of the tool, at each of which the program stops.
    tool_changes: usize,
    /// Whether the speed of the spindle is given, so that the program starts it.
    spindle: bool,
}

impl Case {
    fn example() -> Case {
        let folder = repository().join("studies/r2000ic-pocket");
        Case {
            study: std::fs::read_to_string(folder.join("study.toml")).unwrap(),
            folder,
            name: "r2000ic-pocket".to_owned(),
            path: "pocket",
            frame: FRAME,
            tool: TOOL,
            clearance_mm: 1.9,
            tool_changes: 0,
            spindle: true,
        }
    }

    /// The study in `folder`, with its cell.
    fn put(&self, folder: &Path, [on, off]: [&str; 2]) -> PathBuf {
        let at = folder.join("study");
        std::fs::create_dir(&at).unwrap();
        for file in std::fs::read_dir(&self.folder).unwrap() {
            let file = file.unwrap();
            std::fs::copy(file.path(), at.join(file.file_name())).unwrap();
        }
        let cell =
            format!("\n[controller]\nhome_deg = {HOME:?}\nspindle_on = [{on:?}]\nspindle_off = [{off:?}]\n");
        std::fs::write(at.join("study.toml"), format!("{}{cell}", self.study)).unwrap();
        at
    }

    /// What the program has to cut.
    fn cut(&self, folder: &Path, language: Language) -> Cut {
        Cut {
            points: commanded(&folder.join(format!("out/{}.commanded.csv", self.path))),
            // Universal Robots has no user frames: its targets are in the base of the robot.
            frame: (language == Language::UrScript).then(|| Pose::kuka(self.frame)),
            clearance_mm: self.clearance_mm,
            // 5 um between path and program, and what its numbers round.
            chord_mm: 0.007,
        }
    }
}

/// Writes the program of a study in this language; the folder that it is in.
fn write(study: &Path, folder: &Path, program: &str) -> PathBuf {
    let out = Command::new(env!("CARGO_BIN_EXE_armill"))
        .current_dir(folder)
        .arg("compensate")
        .arg(study)
        .args(["--out", "out", "--feed-mm-per-min", "1000", "--program", program])
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    folder.join(program).parent().unwrap().to_owned()
}

/// Rows of the table of commanded points.
fn commanded(table: &Path) -> Vec<CutPoint> {
    let text = std::fs::read_to_string(table).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let [x, y, z, i, j, k, feed, rapid] =
        ["x_mm", "y_mm", "z_mm", "i", "j", "k", "feed_mm_per_min", "rapid"].map(column);
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |column: usize| cells[column].parse::<f64>().unwrap();
            CutPoint {
                position_mm: [x, y, z].map(number),
                axis: [i, j, k].map(number),
                feed_mm_per_s: cells[feed].parse().ok().map(|feed: f64| feed / 60.0),
                rapid: cells[rapid] == "1",
            }
        })
        .collect()
}

/// Limits of the axes, deg, from the file of the robot.
fn limits() -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string(repository().join("robots/fanuc/r2000ic.toml")).unwrap();
    text.lines()
        .filter_map(|line| {
            line.strip_prefix("limits_deg = [")?
                .strip_suffix(']')?
                .split_once(',')
        })
        .map(|(from, to)| (from.trim().parse().unwrap(), to.trim().parse().unwrap()))
        .collect()
}

/// That a frame is the one of the study, where the program gives it.
#[track_caller]
fn same_reference(found: &Reference, expected: [f64; 6]) {
    if let Some(pose) = found.pose {
        let expected = Pose::kuka(expected);
        assert!(
            pose.distance_mm(&expected) < 1e-3 && pose.angle_deg(&expected) < 1e-3,
            "{found:?}"
        );
    }
}

/// What a language rounds of a feed, mm/s.
fn feed_rounding(language: Language) -> f64 {
    match language {
        // Whole mm/sec or cm/min.
        Language::Tp => 0.51,
        // One decimal.
        Language::Inform => 0.051,
        _ => 1e-3,
    }
}

/// All checks of one program; its events, and the frame of the part where targets are not given in it.
fn check(case: &Case, language: Language, program: &str, spindle: [&str; 2]) -> (Vec<Event>, Option<Pose>) {
    let folder = tempfile::tempdir().unwrap();
    let study = case.put(folder.path(), spindle);
    let at = write(&study, folder.path(), program);
    let fail = |error: ReplayError| -> ! { panic!("{}, {language:?}: {error}", case.name) };
    let events: Vec<Event> = run_folder(language, &at, "pocket").unwrap_or_else(|error| fail(error));
    let cut = case.cut(folder.path(), language);
    let matches: Matches = follows(&events, &cut).unwrap_or_else(|error| fail(error));
    clear(&events, &cut, &matches).unwrap_or_else(|error| fail(error));
    let limits = limits();
    assert_eq!(limits.len(), 6);
    within_limits(&events, &limits).unwrap_or_else(|error| fail(error));
    feeds(&events, &cut, &matches, feed_rounding(language)).unwrap_or_else(|error| fail(error));
    if language == Language::UrScript {
        blends_apart(&events).unwrap_or_else(|error| fail(error));
    }
    no_stop_in_cut(&events, &cut, &matches).unwrap_or_else(|error| fail(error));
    let is_on = |action: &Action| match action {
        Action::Output { value, moving, .. } => value == "TRUE" && !moving,
        Action::Call { name, .. } => name.eq_ignore_ascii_case("spindleOn"),
        _ => false,
    };
    if case.spindle {
        spindle_on(&events, &matches, is_on).unwrap_or_else(|error| fail(error));
    }
    let stops = events
        .iter()
        .filter(|event| matches!(event.action, Action::Stop { .. }));
    assert_eq!(stops.count(), case.tool_changes, "{}, {language:?}", case.name);
    for event in &events {
        if let Action::Linear(linear) = &event.action {
            if cut.frame.is_none() {
                same_reference(&linear.base, case.frame);
            }
            same_reference(&linear.tool, case.tool);
        }
    }
    (events, cut.frame)
}

/// Poses of the lines, in the frame of the part.
fn line_poses((events, frame): &(Vec<Event>, Option<Pose>)) -> Vec<Pose> {
    let in_part = |linear: &LinearMove| match frame {
        Some(frame) => frame.inverse().then(&linear.base.pose.unwrap()).then(&linear.to),
        None => linear.to,
    };
    events
        .iter()
        .filter_map(|event| event.action.linear())
        .map(in_part)
        .collect()
}

/// Axes of the joint moves that give them, deg.
fn axes((events, _): &(Vec<Event>, Option<Pose>)) -> Vec<Vec<f64>> {
    let mut all = Vec::new();
    for event in events {
        if let Action::Joint(joint) = &event.action
            && let JointTarget::Axes(axes) = &joint.to
        {
            all.push(axes.clone());
        }
    }
    all
}

/// The programs of a study in these languages; the poses of their lines are the same. How many lines they have.
fn check_all(case: &Case, programs: &[Program]) -> usize {
    let all: Vec<_> = programs
        .iter()
        .map(|(language, program, spindle)| check(case, *language, program, *spindle))
        .collect();
    let expected = line_poses(&all[0]);
    for (events, (language, ..)) in all.iter().zip(programs) {
        let found = line_poses(events);
        assert_eq!(found.len(), expected.len(), "{language:?}");
        for (one, other) in found.iter().zip(&expected) {
            // The spin about the axis of the tool too; one language rounds three angles to 0.001 deg.
            same_within(one, other, POSITION_MM, 2.0 * ANGLE_DEG);
        }
        // Yaskawa has no axes: pulses differ from robot to robot.
        if ![*language, programs[0].0].contains(&Language::Inform) {
            for (one, other) in axes(events).iter().flatten().zip(axes(&all[0]).iter().flatten()) {
                assert!((one - other).abs() < ANGLE_DEG, "{language:?}: {one} {other}");
            }
            assert_eq!(axes(events).len(), axes(&all[0]).len(), "{language:?}");
        }
    }
    expected.len()
}

#[test]
fn the_programs_of_all_languages_follow_the_table_and_each_other() {
    // Enough lines for a circle of 40 mm in chords of 5 um.
    assert!(check_all(&Case::example(), &PROGRAMS) > 1000);
}

/// A tool path or a robot program of other software.
struct ToolPath {
    /// Below the folder of the samples.
    file: &'static str,
    /// The tool in the flange, as the study gives it.
    tool: [f64; 6],
    /// X, Y, Z in mm and A, B, C in deg of the tool, and of the frame of the path.
    poses: [[f64; 6]; 2],
    /// Height above which the tool moves freely, mm.
    clearance_mm: f64,
    /// Further keys of the program.
    keys: &'static str,
    /// Tables of the analysis after it.
    tables: &'static str,
    /// The programs written have more lines than this.
    lines: usize,
    /// Whether it gives the speed of the spindle.
    spindle: bool,
}

/// The plane of the studies.
const PLANE: [f64; 6] = [1500.0, 0.0, 700.0, -90.0, 0.0, 0.0];
/// Heights are not checked.
const ANY_HEIGHT: f64 = -1e4;

impl ToolPath {
    /// A path with one direction of the tool, from above; its own rapids go across at 2.5 mm and above.
    const fn of(file: &'static str) -> ToolPath {
        ToolPath {
            file,
            tool: TOOL,
            poses: [TOOL, PLANE],
            clearance_mm: 2.4,
            keys: "",
            tables: "",
            // The shortest drills three holes in steps.
            lines: 50,
            spindle: true,
        }
    }

    /// A path whose tool leans.
    const fn leaning(file: &'static str) -> ToolPath {
        ToolPath {
            tool: LEANING_TOOL,
            poses: [LEANING_TOOL, PLANE],
            ..ToolPath::of(file)
        }
    }

    /// A robot program with eight lines, in its own frame.
    const fn of_robot(file: &'static str, tool: [f64; 6], poses: [[f64; 6]; 2]) -> ToolPath {
        ToolPath {
            tool,
            poses,
            clearance_mm: ANY_HEIGHT,
            lines: 8,
            spindle: false,
            ..ToolPath::of(file)
        }
    }
}

const TOOL_PATHS: [ToolPath; 14] = [
    // Cuts from the side, with retracts below the top.
    ToolPath {
        clearance_mm: ANY_HEIGHT,
        ..ToolPath::of("toolpaths/apt/parts-2021/Teste-Metrologia.apt")
    },
    ToolPath::of("toolpaths/apt/parts-2021/basemach.apt"),
    ToolPath::of("toolpaths/apt/parts-2022/SupPetriLED.apt"),
    ToolPath::of("toolpaths/apt/parts-2023/Teflon-gasket.apt"),
    ToolPath::of("toolpaths/apt/parts-2024/Suporte-parede-side-drill.apt"),
    ToolPath::of("toolpaths/apt/parts-2024/manufacture3-top.apt"),
    ToolPath::of("toolpaths/apt/parts-2025/RotateThick.apt"),
    ToolPath::of("toolpaths/apt/parts-2025/SlewMachine.apt"),
    ToolPath::of("toolpaths/apt/parts-2025/Telemecanique-Tilt-Support1.apt"),
    // Two tools, changed three times; from above and from the side (3+2 axes), with retracts below the top.
    ToolPath {
        clearance_mm: ANY_HEIGHT,
        ..ToolPath::of("toolpaths/apt/parts-tools/boss.apt")
    },
    ToolPath::of("toolpaths/gcode/linuxcnc/nc_files/3D_Chips.ngc"),
    ToolPath::of("toolpaths/gcode/linuxcnc/nc_files/arcspiral.ngc"),
    ToolPath::of("toolpaths/gcode/linuxcnc/nc_files/cds.ngc"),
    // An impeller in five axes: the tool leans by up to 73 deg, to all sides.
    ToolPath {
        clearance_mm: 30.0,
        keys: ", rotaries = \"table-ac\"",
        tables: "[analysis.posture.search]\n",
        ..ToolPath::leaning(
            "toolpaths/gcode/linuxcnc/configs/sim/axis/vismach/5axis/table-rotary-tilting/demos/impeller-7bl-xyzac.ngc",
        )
    },
];

/// The tool of the robot programs as their notes give it for a study, and as KUKA does.
const POINTER: [[f64; 6]; 2] = [
    [62.5, -108.253, 100.0, 6.87, 90.0, -53.13],
    [62.5, -108.253, 100.0, -80.537678, 90.0, -20.537678],
];
/// The frame that two of them have.
const TABLE: [f64; 6] = [807.767, -963.7, 41.479, 0.0, 0.0, 0.0];

/// One list of poses as programs of four makers; that of ABB is another path, out of reach of this robot, and that of Staubli
/// has no data.
const ROBOT_PROGRAMS: [ToolPath; 4] = [
    ToolPath::of_robot(
        "programs/same-poses-six-languages/KUKA_KRC4.src",
        POINTER[0],
        [POINTER[1], TABLE],
    ),
    ToolPath::of_robot(
        "programs/same-poses-six-languages/Fanuc_R30iA.LS",
        POINTER[0],
        [POINTER[1], TABLE],
    ),
    ToolPath::of_robot(
        "programs/same-poses-six-languages/Universal_Robots_SCRIPT.script",
        [62.5, -108.253, 100.0, -150.0, 90.0, 150.0],
        [[62.5, -108.253, 100.0, 158.198591, 90.0, -141.801409], [0.0; 6]],
    ),
    ToolPath::of_robot(
        "programs/same-poses-six-languages/Motoman.JBI",
        [0.0; 6],
        [[0.0; 6]; 2],
    ),
];

/// Changes between tools of different numbers in the cutter locations or the G-code of these files.
fn tool_changes(text: &str) -> usize {
    let number = |line: &str| {
        let line = line.trim();
        let digits = line.strip_prefix("LOAD/TOOL,").or_else(|| {
            line.strip_prefix('T')
                .filter(|rest| rest.to_uppercase().contains("M6"))
        })?;
        let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        digits[..end].parse::<u32>().ok()
    };
    let tools: Vec<u32> = text.lines().filter_map(number).collect();
    tools.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// The programs of these paths, each in the languages of its index.
fn check_paths(paths: &[ToolPath], programs: impl Fn(usize) -> Vec<Program>) {
    let Some(samples) = std::env::var_os("ARMILL_SAMPLES") else {
        println!("skipped: ARMILL_SAMPLES is not set");
        return;
    };
    for (index, path) in paths.iter().enumerate() {
        let file = Path::new(&samples).join(path.file);
        let study = format!(
            "format = 1\nrobot = \"fanuc/r2000ic\"\ntolerance_um = 100\n\
             tool = {{ flange_from_tool_mm_deg = {:?} }}\n\
             plane = {{ centre_mm = [1500, 0, 700], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }}\n\
             [load]\nframe = \"feed\"\ncases_n = [[-60, 40, 25]]\n\
             [[analysis]]\nkind = \"path\"\nname = \"pocket\"\n\
             program = {{ file = {:?}, limits = false{} }}\n{}",
            path.tool,
            file.display().to_string(),
            path.keys,
            path.tables
        );
        let empty = tempfile::tempdir().unwrap();
        let case = Case {
            study,
            folder: empty.path().to_owned(),
            tool_changes: tool_changes(&std::fs::read_to_string(&file).unwrap()),
            name: file.display().to_string(),
            path: "pocket",
            tool: path.poses[0],
            frame: path.poses[1],
            clearance_mm: path.clearance_mm,
            spindle: path.spindle,
        };
        assert!(
            check_all(&case, &programs(index)) > path.lines,
            "{}",
            file.display()
        );
    }
}

#[test]
fn programs_of_real_tool_paths_follow_their_tables() {
    // Two languages each, so that every language has four files or five, each with other partners.
    check_paths(&TOOL_PATHS, |index| {
        vec![PROGRAMS[index % 6], PROGRAMS[(index + 1 + index / 6) % 6]]
    });
}

#[test]
fn robot_programs_are_written_in_all_languages_and_follow_their_tables() {
    check_paths(&ROBOT_PROGRAMS, |_| PROGRAMS.to_vec());
}

#[test]
fn a_written_program_with_one_changed_number_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let study = Case::example().put(folder.path(), PROGRAMS[0].2);
    let at = write(&study, folder.path(), "pocket.src").join("pocket.src");
    let text = std::fs::read_to_string(&at).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let cuts: Vec<usize> = (0..lines.len())
        .filter(|index| lines[*index].starts_with("LIN"))
        .collect();
    let changed = cuts[cuts.len() / 2];
    lines[changed] = lines[changed]
        .replacen("{X ", "{X 1", 1)
        .replacen("{X 1-", "{X -1", 1);
    let events = run(Language::Krl, &[("pocket.src", lines.join("\n"))], "pocket").unwrap();
    let cut = Case::example().cut(folder.path(), Language::Krl);
    let found = follows(&events, &cut).unwrap_err();
    assert_eq!(found.place.line, changed + 1, "{found}");
}

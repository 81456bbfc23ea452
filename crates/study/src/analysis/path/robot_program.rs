//! A robot program as a path: its files, its frames in the cell, its moves as points.
//!
//! | language | files |
//! |---|---|
//! | KUKA KRL | the `.src`, and the `.dat` of the same name in its folder |
//! | Staubli VAL3 | every `.pjx`, `.pgx` and `.dtx` of the folder, or of the folder of the file |
//! | others | the file |
//!
//! The frame of the path is that of the program, in the base of the robot: the plane of the study does not move it,
//! unless `part_from_path_mm_deg` specifies its actual placement.

use std::ops::Range;
use std::path::{Path, PathBuf};

use armill_core::kernel::BranchChoice;
use armill_core::path::{Pace, PathBuilder, SampledPath, Sampling, Step, TooManyPoints};
use armill_core::robot::{BranchPattern, Robot};
use armill_formats::input;
use armill_programs::{
    Cell, FollowError, Followed, FollowedMove, Language, ProgramText, RobotProgram, follow, read_as,
};

use crate::StudyError;
use crate::analysis::path::program_file::{FILE_HINT, MOST_POINTS, ProgramFile};
use crate::analysis::path::program_table::ProgramTable;
use crate::input::problem_log::ProblemLog;
use crate::input::quantities::pose_mm_deg;
use crate::input::setting::Setting;
use crate::naming::base_from_controller;

/// A robot program that a path follows.
#[derive(Clone, Debug)]
pub struct RobotPath {
    /// As in its files.
    pub program: RobotProgram,
    /// As moves of the path.
    pub followed: Followed,
    /// The points of each of those moves, in order.
    pub spans: Vec<Span>,
    /// What it does not specify of the cell.
    pub cell: Cell,
}

/// The points of a move.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Span {
    /// Points added to the path; none for a rapid, and for a move that ends at the present position.
    pub points: Range<usize>,
    /// Number of pieces of the move.
    pub pieces: usize,
    /// The point at which it ends, if a cut passes it.
    pub end: Option<usize>,
}

/// The robot that follows a program, and the tool and the plane that it has there.
#[derive(Clone, Copy)]
pub struct RobotInCell<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Tool and plane.
    pub setting: &'a Setting,
}

impl<'a> RobotInCell<'a> {
    /// Both, if both are known.
    pub fn of(robot: Option<&'a Robot>, setting: Option<&'a Setting>) -> Option<RobotInCell<'a>> {
        let (robot, setting) = robot.zip(setting)?;
        Some(RobotInCell { robot, setting })
    }

    /// What the study specifies of the cell.
    fn cell(&self, table: &ProgramTable) -> Cell {
        let given = |pose: &Option<[f64; 6]>| pose.as_ref().map(pose_mm_deg);
        Cell {
            flange_from_tool: self.setting.flange_from_tool,
            base_from_controller: base_from_controller(self.robot, None),
            controller_from_frame: given(&table.frame_mm_deg),
            base_from_path: given(&table.part_from_path_mm_deg)
                .map(|part_from_path| self.setting.plane.base_from_part * part_from_path),
        }
    }
}

/// Size limit of a robot program, all its files together, bytes.
const MOST_BYTES: u64 = 256 * 1024 * 1024;

/// The program as points; `None` if it has problems, reported at their keys, or no cell to follow it in.
///
/// # Errors
/// The problems of its files.
pub fn read(
    log: &mut ProblemLog<'_>,
    table: &ProgramTable,
    language: Language,
    file: &ProgramFile<'_>,
    robot: Option<RobotInCell<'_>>,
) -> Result<Option<(SampledPath, RobotPath)>, StudyError> {
    let others = [
        ("unit", table.unit.is_some()),
        ("dialect", table.dialect.is_some()),
        ("rotaries", table.rotaries.is_some()),
        ("tool_table", table.tool_table.is_some()),
    ];
    for (key, _) in others.iter().filter(|(_, given)| *given) {
        let message = format!("`{key}` is not valid for a robot program ({})", language.title());
        log.problem(&format!("program.{key}"), message, "leave it out");
    }
    if robot.is_some_and(|found| found.robot.chain().ground().part_is_in_hand()) {
        let message = "robot programs are not read for a part in the hand of the robot, with a tool that stands in the cell";
        let hint = "give the path by a CSV, a CL file or G-code, relative to the part";
        log.problem("program.file", message, hint);
    }
    if table.frame_mm_deg.is_some() && table.part_from_path_mm_deg.is_some() {
        let message = "`frame_mm_deg` and `part_from_path_mm_deg` both specify the placement of the program";
        log.problem("program.frame_mm_deg", message, "keep one of the two");
    }
    let Some(texts) = texts(log, &file.path, language) else {
        return Ok(None);
    };
    let program = read_as(language, texts)?;
    let clean = log.problems.is_empty();
    let Some(robot) = robot.filter(|_| clean) else {
        return Ok(None);
    };
    let cell = robot.cell(table);
    let Some(mut followed) = followed(log, &program, &table.file, robot.robot, &cell) else {
        return Ok(None);
    };
    if let Some(fastest) = table.cuts_up_to_mm_per_min {
        let fastest = fastest / 60e3;
        let is_faster = |pace| matches!(pace, Pace::Feed(speed) if speed > fastest * (1.0 + 1e-9));
        for of in followed.moves.iter_mut().filter(|of| is_faster(of.next.pace)) {
            of.next.pace = Pace::Rapid;
        }
    }
    let (mut path, spans) = match sampled(&followed.moves, file.sampling) {
        Ok(found) => found,
        Err(error) => {
            file.too_many(log, error);
            return Ok(None);
        }
    };
    take_passages(&mut path, &spans, &program, &followed);
    let robot_path = RobotPath {
        program,
        followed,
        spans,
        cell,
    };
    Ok(Some((path, robot_path)))
}

/// The texts of the program at `path`, the main one first; `None` if a file cannot be read, reported at its key.
fn texts(log: &mut ProblemLog<'_>, path: &Path, language: Language) -> Option<Vec<ProgramText>> {
    let folder = if path.is_dir() {
        path
    } else {
        // The parent of a bare file name is empty.
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        parent.unwrap_or(Path::new("."))
    };
    let same_folder = || -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut found: Vec<PathBuf> = entries
            .map(|entry| entry.path())
            .filter(|path| path.is_file())
            .collect();
        found.sort();
        found
    };
    let files = match language {
        Language::Krl => {
            let of = |expected: &str| {
                let same =
                    |other: &&PathBuf| other.file_stem() == path.file_stem() && ending(other) == expected;
                same_folder().iter().find(same).cloned()
            };
            // A `.dat` means the program of the same name.
            let main = if ending(path) == "dat" { of("src") } else { None };
            let main = main.unwrap_or_else(|| path.to_owned());
            let data = of("dat").filter(|data| *data != main);
            [Some(main), data].into_iter().flatten().collect()
        }
        Language::Val3 => {
            let mut files: Vec<PathBuf> = same_folder()
                .into_iter()
                .filter(|file| language.endings().contains(&ending(file).as_str()))
                .collect();
            // The file that the study names comes first: the main program, or the project.
            files.sort_by_key(|file| (file != path, ending(file) != "pjx"));
            files
        }
        _ => vec![path.to_owned()],
    };
    let size = |file: &PathBuf| std::fs::metadata(file).map_or(0, |data| data.len());
    let bytes: u64 = files.iter().map(size).sum();
    if bytes > MOST_BYTES {
        let mib = 1024 * 1024;
        let message = format!(
            "{}: {} MiB, more than {} MiB",
            path.display(),
            bytes / mib,
            MOST_BYTES / mib
        );
        log.problem("program.file", message, "split the program");
        return None;
    }
    let mut texts = Vec::with_capacity(files.len());
    for file in &files {
        match input::read(file) {
            Ok(bytes) => texts.push(ProgramText::new(&file.display().to_string(), &bytes)),
            Err(error) => {
                let message = format!("cannot read {}: {error}", file.display());
                log.problem("program.file", message, FILE_HINT);
                return None;
            }
        }
    }
    Some(texts)
}

/// The extension of a file name, lower case.
fn ending(path: &Path) -> String {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.unwrap_or_default().to_lowercase()
}

/// The program in this cell; `None` if it has problems, reported at their keys.
fn followed(
    log: &mut ProblemLog<'_>,
    program: &RobotProgram,
    file: &str,
    robot: &Robot,
    cell: &Cell,
) -> Option<Followed> {
    let reported = follow(program, robot, cell).map_err(|errors| {
        for error in errors {
            let (key, hint) = advice(&error);
            log.problem(key, format!("{file}: {error}"), &hint);
        }
    });
    reported.ok()
}

/// Where in a study an error can be corrected, and how.
fn advice(error: &FollowError) -> (&'static str, String) {
    match error {
        FollowError::Numbered { .. } | FollowError::UnknownFrame { .. } => (
            "program.frame_mm_deg",
            "frame_mm_deg = [x, y, z, rx, ry, rz] specifies it as in the controller: mm, and deg about the fixed axes x, y, z; or \
             part_from_path_mm_deg puts it on the plane"
                .to_owned(),
        ),
        FollowError::FrameGivenTwice { .. } => (
            "program.frame_mm_deg",
            "leave `frame_mm_deg` out; part_from_path_mm_deg specifies another placement".to_owned(),
        ),
        FollowError::Several { .. } => (
            "program.file",
            "a study can specify one frame: split the program by its frames, or define them in the program".to_owned(),
        ),
        FollowError::Tip { tool_mm_deg, .. } => (
            "tool.flange_from_tool_mm_deg",
            format!("the program's tool is {tool_mm_deg}; z of the study's must point from the spindle to the tip"),
        ),
        FollowError::Joints { .. } => ("robot", "check that the program is for this robot".to_owned()),
    }
}

/// The moves of `followed` as points, and which points each became.
///
/// # Errors
/// More points than fit into memory.
pub fn sampled(
    moves: &[FollowedMove],
    sampling: Sampling,
) -> Result<(SampledPath, Vec<Span>), TooManyPoints> {
    let mut builder = PathBuilder::new(sampling, MOST_POINTS);
    let mut added = Vec::with_capacity(moves.len());
    for of in moves {
        let before = builder.point_count();
        builder.take(Step::Move(of.next));
        added.push(before..builder.point_count());
    }
    let path = builder.finish()?;
    let spans = (0..moves.len()).map(|index| {
        let points = added[index].clone();
        let own_start = !points.is_empty() && path.begins(points.start);
        Span {
            pieces: points.len() - usize::from(own_start),
            end: end_of(moves, &added, index, &path),
            points,
        }
    });
    let spans = spans.collect();
    Ok((path, spans))
}

/// Marks how the program passes the ends of its moves.
fn take_passages(path: &mut SampledPath, spans: &[Span], program: &RobotProgram, followed: &Followed) {
    for (of, span) in followed
        .moves
        .iter()
        .zip(spans)
        .filter(|(_, span)| !span.points.is_empty())
    {
        let end = path
            .ends
            .binary_search_by_key(&(span.points.end - 1), |end| end.point);
        if let Ok(end) = end {
            path.ends[end].passage = program.moves[of.index].passage;
        }
    }
}

/// The point of the path at which move `index` ends: its own last one, or the start of the cut that follows it.
fn end_of(moves: &[FollowedMove], added: &[Range<usize>], index: usize, path: &SampledPath) -> Option<usize> {
    if !added[index].is_empty() {
        return Some(added[index].end - 1);
    }
    let here = |point: &usize| path.points[*point].at == moves[index].next.end;
    let next = added[index..].iter().find(|points| !points.is_empty());
    let begin = next.map(|points| match path.begins(points.start) {
        true => points.start,
        false => points.start - 1,
    });
    // A move to where a cut has ended.
    let before = added[..index].iter().rev().find(|points| !points.is_empty());
    let end = before
        .map(|points| points.end - 1)
        .filter(|_| moves[index].next.pace.cuts());
    begin.filter(here).or(end.filter(here))
}

/// Uses the posture that the program specifies, if the study requests none.
///
/// Returns the note that states this.
pub fn take_posture(setting: &mut Setting, followed: &Followed, robot: &Robot) -> Option<String> {
    let nominal = robot.nominal_branch();
    let BranchChoice::Of(requested) = setting.choice else {
        return None;
    };
    // Words of the study leave something said in what is open.
    if setting.open != BranchPattern::default() || requested != nominal || !robot.inverse().has_branches() {
        return None;
    }
    let (reported, line) = followed.posture?;
    let pattern = reported.or(nominal);
    setting.choice = BranchChoice::Of(pattern);
    Some(format!(
        "line {line}: the posture {pattern} is used as specified in the program; set `posture.branch` to use another one"
    ))
}

//! A program read, and what its tests compare.

use armill_core::path::{Arc, Command, Course, Move, Operation, Step};
use armill_formats::document::Problems;
use armill_formats::toolpath::Summary;
use armill_formats::toolpath::gcode::{self, GcodeReadOptions, interpret};

/// The steps of a program, kept.
#[derive(Debug, Default)]
pub struct Program {
    pub operations: Vec<Operation>,
    pub moves: Vec<Move>,
    /// Of each operation the index of its first move.
    pub starts: Vec<usize>,
    /// Each with the number of moves before it.
    pub commands: Vec<(usize, Command)>,
}

pub fn read(program: &str, expected: &GcodeReadOptions<'_>) -> Result<(Program, Summary), Problems> {
    let mut path = Program::default();
    let summary = gcode::read("p.ngc", program.as_bytes(), expected, &mut |step| match step {
        Step::Operation(operation) => {
            path.operations.push(operation);
            path.starts.push(path.moves.len());
        }
        Step::Command(command) => path.commands.push((path.moves.len(), command)),
        Step::Move(next) => path.moves.push(next),
    })?;
    Ok((path, summary))
}

pub fn path(program: &str) -> Program {
    read(program, &GcodeReadOptions::default())
        .unwrap_or_else(|problems| panic!("{problems}"))
        .0
}

pub fn first_problem(program: &str, expected: &GcodeReadOptions<'_>) -> String {
    match read(program, expected) {
        Err(problems) => problems.as_slice()[0].to_string(),
        Ok(_) => panic!("accepted: {program}"),
    }
}

pub fn calls(program: &str) -> Vec<String> {
    let mut calls = Vec::new();
    let found = interpret(
        &mut program.as_bytes(),
        &GcodeReadOptions::default(),
        &mut |call, _| {
            calls.push(call.to_string());
            Ok(())
        },
    );
    assert!(found.faults.is_empty(), "{:?}", found.faults);
    calls
}

pub fn moves_of(program: &str) -> Vec<String> {
    let mut calls = calls(program);
    calls.retain(|call| call.starts_with("STRAIGHT") || call.starts_with("ARC"));
    calls
}

pub fn arc_of(next: &Move) -> Arc {
    match next.course {
        Course::Arc(arc) => arc,
        Course::Line => panic!("line {} is not an arc", next.line),
    }
}

/// Ends of moves, mm, rounded to 1 nm: sums and turns of numbers below 1 m are exact to 1e-16 m.
pub fn ends(path: &Program) -> Vec<[f64; 3]> {
    let nearest = |value: f64| (value * 1e9).round() / 1e6 + 0.0;
    path.moves
        .iter()
        .map(|next| [nearest(next.end.x), nearest(next.end.y), nearest(next.end.z)])
        .collect()
}

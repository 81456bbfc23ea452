//! Programs of our own in both dialects, and every way in which they can be wrong.

mod arcs;
mod cycles;
mod dialects;
mod feeds;
mod refusals;

use armill_core::nalgebra::Point3;
use armill_core::path::{Arc, Course, Move, Operation, Step};

use super::*;

fn steps(text: &str, expected: &AptReadOptions) -> Result<(Summary, Vec<Step>), Problems> {
    let mut steps = Vec::new();
    let summary = read("part.apt", text.as_bytes(), expected, &mut |step| {
        steps.push(step);
    })?;
    Ok((summary, steps))
}

fn read_all(text: &str) -> (Summary, Vec<Operation>, Vec<Move>) {
    let (summary, steps) =
        steps(text, &AptReadOptions::default()).unwrap_or_else(|problems| panic!("{problems}"));
    let (mut operations, mut moves) = (Vec::new(), Vec::new());
    for step in steps {
        match step {
            Step::Operation(operation) => operations.push(operation),
            Step::Command(_) => {}
            Step::Move(next) => moves.push(next),
        }
    }
    (summary, operations, moves)
}

fn problems(text: &str) -> String {
    steps(text, &AptReadOptions::default()).unwrap_err().to_string()
}

fn near(a: Point3<f64>, mm: [f64; 3]) {
    let b = Point3::new(mm[0], mm[1], mm[2]) * 1e-3;
    // Rounding of lengths of less than a metre.
    assert!((a - b).norm() < 1e-12, "{a} is not {b}");
}

fn arc(next: &Move) -> Arc {
    match next.course {
        Course::Arc(arc) => arc,
        Course::Line => panic!("{next:?} is not an arc"),
    }
}

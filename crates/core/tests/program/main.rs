//! Deviation along a tool path program against the plain model, one point at a time.
//!
//! `plain_model`: every point against it; `path_answers`: one branch, parts, wrenches of each point; `cuts`: cutting
//! forces and process limits.

// A panic is how a test says that its claim is false; helper functions too.
#![allow(clippy::unwrap_used)]

#[path = "../arms/mod.rs"]
mod arms;
mod cuts;
mod path_answers;
mod plain_model;

use std::f64::consts::TAU;

use armill_core::frame::Isometry;
use armill_core::kernel::{BranchChoice, Question};
use armill_core::load::{InputUncertainty, LoadCases, LoadFrame, PathLoad};
use armill_core::map::{AlongPath, along_path};
use armill_core::nalgebra::{Point3, Unit, Vector3};
use armill_core::path::{Arc, Course, Move, Pace, PathBuilder, Placing, Sampling, Spin, Step, Track};
use armill_core::robot::Robot;
use armill_core::source::{Arm, StiffnessModel};
use armill_core::spatial::Wrench;
use armill_core::watch::Watch;

/// A rapid, a plunge, a full circle, and a line up to a tool that leans.
fn moves() -> Vec<Move> {
    let to = |x: f64, y: f64, z: f64, pace| Move {
        end: Point3::new(x, y, z),
        axis: None,
        spin: None,
        course: Course::Line,
        pace,
        line: 1,
    };
    let feed = Pace::Feed(0.02);
    let round = Arc {
        centre: Point3::new(0.0, 0.0, 0.0),
        axis: -Vector3::z_axis(),
        sweep: TAU,
    };
    vec![
        to(0.05, 0.0, 0.02, Pace::Rapid),
        to(0.05, 0.0, -0.001, feed),
        Move {
            course: Course::Arc(round),
            ..to(0.05, 0.0, -0.001, feed)
        },
        Move {
            axis: Some(Unit::new_normalize(Vector3::new(0.3, -0.2, 1.0))),
            ..to(-0.05, 0.03, 0.004, feed)
        },
    ]
}

/// The moves on a part that leans, the tool turned with the feed.
fn track() -> Track {
    let sampling = Sampling {
        chord_error: 1e-5,
        step: 2e-3,
    };
    let mut builder = PathBuilder::new(sampling, 100_000);
    for next in moves() {
        builder.take(Step::Move(next));
    }
    let base_from_part = Isometry::new(Vector3::new(0.9, 0.1, 0.6), Vector3::new(0.1, -0.4, 0.3));
    Track {
        path: builder.finish().unwrap(),
        placing: Placing {
            base_from_path: base_from_part,
            axis: Vector3::z_axis(),
            keeps_axis: false,
            spin: Spin::AlongFeed(0.3),
        },
        base_from_part,
        spins: None,
        homes: None,
    }
}

/// Two cases, the first with a moment, in this frame.
fn cases(frame: LoadFrame) -> PathLoad {
    let wrench = |f: [f64; 3], m: [f64; 3]| Wrench {
        force: f.into(),
        moment: m.into(),
    };
    PathLoad::Cases(LoadCases {
        frame,
        cases: vec![
            wrench([-150.0, 36.0, 14.0], [0.1, -0.3, 2.0]),
            wrench([39.0, 150.0, 14.0], [0.0; 3]),
        ],
    })
}

/// The question along a path: cases and normal come with the path.
fn question<'a>(
    robot: &'a Robot,
    model: &'a StiffnessModel,
    tool: &'a Isometry,
    choice: BranchChoice,
) -> Question<'a> {
    Question {
        homes: None,
        arm: Arm {
            robot,
            compliance: robot.compliance().unwrap(),
            model,
            flange_from_tool: tool,
        },
        home: None,
        cases: &[],
        uncertainty: InputUncertainty::NONE,
        normal: Vector3::z_axis(),
        choice,
        clearance: None,
    }
}

/// The track under this load.
fn followed(robot: &Robot, model: &StiffnessModel, choice: BranchChoice, load: PathLoad) -> AlongPath {
    let tool = arms::bent_tool();
    let question = question(robot, model, &tool, choice);
    along_path(&question, &track(), load, Watch::NONE).unwrap()
}

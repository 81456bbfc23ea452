//! `clearances STUDY < JOINTS > DISTANCES`: the clearance in the cell of a study at many joint positions, for `compare.py`.
//!
//! | stream | lines |
//! |---|---|
//! | JOINTS | joint positions in deg, separated by commas, in the signs and zeros of the robot file |
//! | DISTANCES | first the pairs of bodies that are not checked since they are in contact in every posture, `body:body` separated by commas |
//! | | then, for each line of JOINTS, the least distance in mm and the two bodies, separated by commas |
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program that prints its results"
)]

use std::env;
use std::io;
use std::path::Path;
use std::process::ExitCode;

use armill_core::clearance::CellState;
use armill_core::units::{from_deg, to_mm};
use armill_study::pose::first_setting;
use armill_study::studies;

fn main() -> ExitCode {
    match clearances() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

fn clearances() -> Result<(), Box<dyn std::error::Error>> {
    let path = env::args()
        .nth(1)
        .ok_or("usage: clearances STUDY < JOINTS > DISTANCES")?;
    let study = studies::find(Path::new(&path))?.read()?;
    let setting = first_setting(&study)?;
    let cell = setting.cell.as_ref().ok_or("the study has no bodies")?;
    let name = |index: usize| cell.cell.name(index);
    let in_contact = cell.cell.always_in_contact().iter();
    let pairs: Vec<String> = in_contact.map(|pair| pair.map(name).join(":")).collect();
    println!("{}", pairs.join(","));
    let mut state = CellState::new(cell.placed(), &study.robot.robot, &setting.flange_from_tool);
    for line in io::stdin().lines() {
        let positions: Result<Vec<f64>, _> = line?.split(',').map(str::parse).collect();
        let joints: Vec<f64> = positions?.into_iter().map(from_deg).collect();
        if joints.len() != study.robot.robot.joints().len() {
            return Err(format!("{} joint positions in a line", joints.len()).into());
        }
        state.set_joints(&joints);
        let found = state
            .clearance(f64::INFINITY)
            .ok_or("no pair of bodies is checked")?;
        let [first, second] = found.bodies.map(name);
        println!("{:.9},{first},{second}", to_mm(found.nearest.distance));
    }
    Ok(())
}

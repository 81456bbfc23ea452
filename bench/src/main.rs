//! `armill-bench FOLDER [--quick] [--paths | --peers] [--rows=TEXT]`: writes the workload into FOLDER for peers in other
//! languages, checks that all candidates agree, times them in turn, and prints a row for each; called by `cargo xtask
//! bench`. With `--rows=TEXT` only rows whose program and work contain TEXT: to profile one.
//!
//! | | rows | built |
//! |---|---|---|
//! | | armill | as users get it |
//! | `--paths` | armill: tool path programs and placements | the same |
//! | `--peers` | the yardstick and the peers in Rust | for this processor (`target-cpu=native`): they choose no instructions while they run |

// Rows go to stdout, what is going on to stderr.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use armill_bench::armill::{Arm, ONE_POSTURE, candidates as of_armill, isometry};
use armill_bench::cells::PlacedCells;
use armill_bench::clock::{Candidate, rates, row};
use armill_bench::lanes::{self, Places};
use armill_bench::paths::{self, Paths};
use armill_bench::placements;
use armill_bench::work::{C66, C66_AT, DEV, DEV_AT, DEV8, IK8};
use armill_bench::workload::{COUNT, Pose, poses};
use armill_bench::{agreement, files, kinds, peers, removal, yardstick};
use armill_bench::{cells, clearance};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Rounds after the one that warms up.
const ROUNDS: usize = 15;
const QUICK_ROUNDS: usize = 3;
/// How many poses are checked for agreement.
const CHECKED: usize = 500;
/// Poses whose results share a block of memory: results stay in cache, so that work is timed and not the RAM.
const BLOCK: usize = 256;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let requested = |name: &str| arguments.iter().skip(1).any(|argument| argument == name);
    let rows = arguments
        .iter()
        .skip(1)
        .find_map(|argument| argument.strip_prefix("--rows="));
    let known = |argument: &String| {
        ["--quick", "--paths", "--peers"].contains(&argument.as_str()) || argument.starts_with("--rows=")
    };
    let (Some(folder), true) = (arguments.first(), arguments.iter().skip(1).all(known)) else {
        eprintln!("usage: armill-bench FOLDER [--quick] [--paths | --peers] [--rows=TEXT]");
        return ExitCode::from(2);
    };
    let rounds = if requested("--quick") {
        QUICK_ROUNDS
    } else {
        ROUNDS
    };
    let part = match (requested("--peers"), requested("--paths")) {
        (true, _) => Part::Peers,
        (_, true) => Part::Paths,
        _ => Part::Armill,
    };
    match run(Path::new(folder), rounds, part, rows.unwrap_or_default()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

/// Whose rows.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Armill,
    Paths,
    Peers,
}

fn run(folder: &Path, rounds: usize, part: Part, rows: &str) -> Result<(), String> {
    let (arm, poses) = (Arm::mh12(), poses(COUNT));
    fs::create_dir_all(folder)
        .and_then(|()| files::write(folder, &poses))
        .map_err(|problem| format!("cannot write into {}: {problem}", folder.display()))?;
    for line in agreement::check(&arm, &poses[..CHECKED])? {
        eprintln!("{line}");
    }
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build();
    let pools = [
        pool(1).map_err(|problem| problem.to_string())?,
        pool(2).map_err(|problem| problem.to_string())?,
    ];
    let angles: Vec<[f64; 6]> = poses.iter().map(yardstick::joints).collect();
    let isometries: Vec<_> = poses.iter().map(isometry).collect();
    let (double, single) = (Places::of(&poses), Places::of(&poses));

    let (others, zigzag) = (kinds::others(), Paths::zigzag());
    let cuts = removal::Cuts::zigzag();
    let (steady, leaning) = (placements::Places::steady(), placements::Places::leaning());
    let in_cells = PlacedCells::all(&arm);
    let (cells, postures) = (clearance::cells(arm.robot()), clearance::postures(arm.robot()));
    let mut all = Vec::new();
    let question = arm.question(ONE_POSTURE);
    if part == Part::Armill {
        all.extend(lanes::candidates(&question, &double, &single, &pools[1]));
        all.extend(of_armill(&arm, &isometries, &pools));
        all.extend(kinds::candidates(&others, &pools[0]));
        all.extend(clearance::candidates(arm.robot(), &cells, &postures));
    }
    if part == Part::Peers {
        all.extend(of_yardstick(&poses, &angles, &pools[1]));
        all.extend(peers::candidates(&poses));
    } else {
        all.extend(paths::candidates(&arm, &zigzag));
        all.extend(removal::candidates(&cuts, &pools[1]));
        all.extend(placements::candidates(&arm, [&steady, &leaning], &pools[0]));
        all.extend(cells::candidates(&arm, &in_cells, &pools[0]));
    }
    all.retain(|candidate| format!("{} {}", candidate.who, candidate.work).contains(rows));
    let rates = rates(&mut all, rounds);
    for (candidate, rate) in all.iter().zip(&rates) {
        println!("{}", row(candidate, rate));
    }
    Ok(())
}

/// Rows of the yardstick.
fn of_yardstick<'a>(
    poses: &'a [Pose],
    angles: &'a [[f64; 6]],
    two_threads: &'a ThreadPool,
) -> Vec<Candidate<'a>> {
    const WHO: &str = "plain Rust with trigonometry";
    let in_parallel = move || {
        two_threads.install(|| {
            poses
                .par_chunks(BLOCK)
                .for_each(|block| in_blocks(block, yardstick::dev));
        });
    };
    vec![
        Candidate::new(WHO, DEV, poses.len(), || in_blocks(poses, yardstick::dev)),
        Candidate::new(WHO, DEV8, poses.len(), || in_blocks(poses, yardstick::dev8)),
        Candidate::new(WHO, C66, poses.len(), || in_blocks(poses, yardstick::c66)),
        Candidate::new(WHO, IK8, poses.len(), || in_blocks(poses, yardstick::ik8)),
        Candidate::new(WHO, DEV_AT, poses.len(), || in_blocks(angles, yardstick::dev_at)),
        Candidate::new(WHO, C66_AT, poses.len(), || in_blocks(angles, yardstick::c66_at)),
        Candidate::new(WHO, DEV, poses.len(), in_parallel).threads(two_threads.current_num_threads()),
    ]
}

/// Does `work` on every one of `all`; the results of a block overwrite those of the block before.
fn in_blocks<T, R: Copy>(all: &[T], work: impl Fn(&T) -> R) {
    let mut results = Vec::with_capacity(BLOCK);
    for block in all.chunks(BLOCK) {
        results.clear();
        results.extend(block.iter().map(&work));
        black_box(&results);
    }
}

//! Instructions that a pose costs, counted by Callgrind: the same on a busy machine as on an idle one.
//!
//! `cargo xtask bench --instructions` runs this and compares with `bench/instructions.tsv`. Valgrind knows AVX2 and
//! FMA but not AVX-512. To count another function: one `#[bench]` here; the name ends in the number of poses, of
//! placements in points x cases. The arms, maps and paths are those of the rows with the same names in
//! `docs/performance.md`.
// What the macros of gungraun write is not ours to document or to qualify.
#![allow(missing_docs, unused_qualifications)]

use std::hint::black_box;

use armill_bench::armill::{Arm, Modelled, ONE_POSTURE, isometry, map};
use armill_bench::kinds::{Other, STEP, grid};
use armill_bench::lanes::Places;
use armill_bench::placements::Places as PathPlaces;
use armill_bench::workload::poses;
use armill_core::frame::Isometry;
use armill_core::kernel::lanes::{Arrays, Backend, Batch, Envelopes};
use armill_core::kernel::{BranchChoice, evaluate};
use armill_core::nalgebra::Vector3;
use armill_core::robot::{Branch, BranchPattern};
use armill_core::watch::Watch;
use gungraun::Callgrind;
use gungraun::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Not counted: building the arm, choosing the poses, starting the pool.
fn evaluate_setup(count: usize) -> (Arm, Vec<Isometry>, ThreadPool) {
    let poses = poses(count).iter().map(isometry).collect();
    (Arm::mh12(), poses, pool())
}

#[library_benchmark(setup = evaluate_setup)]
#[bench::poses_2048(2048)]
fn kernel_evaluate((arm, poses, pool): (Arm, Vec<Isometry>, ThreadPool)) -> usize {
    let question = arm.question(ONE_POSTURE);
    let answers = pool.install(|| evaluate(&question, poses.len(), |i| poses[i], Watch::NONE));
    black_box(answers).map_or(0, |answers| answers.points.len())
}

/// Not counted: preparing the question.
fn lanes_setup(count: usize) -> (Batch<f64>, Places<f64>) {
    // Valgrind has no AVX-512, so the fastest back end that it reports is AVX2.
    let arm = Arm::mh12();
    let batch = Batch::new(&arm.question(ONE_POSTURE), arm.closed_form(), Backend::fastest());
    (batch, Places::of(&poses(count)))
}

#[library_benchmark(setup = lanes_setup)]
#[bench::poses_1920(1920)]
fn lanes_dev((mut batch, places): (Batch<f64>, Places<f64>)) -> f64 {
    let mut out = Envelopes::default();
    batch.envelopes(&places.all(), Branch::ALL[0], &mut out);
    black_box(out).in_plane()[0]
}

#[library_benchmark(setup = lanes_setup)]
#[bench::poses_1920(1920)]
fn lanes_c66((mut batch, places): (Batch<f64>, Places<f64>)) -> f64 {
    let mut out = Arrays::default();
    batch.compliances(&places.all(), Branch::ALL[0], &mut out);
    black_box(out).array(0)[0]
}

#[library_benchmark(setup = lanes_setup)]
#[bench::poses_1920(1920)]
fn lanes_ik8((mut batch, places): (Batch<f64>, Places<f64>)) -> f64 {
    let mut out = Arrays::default();
    batch.joints(&places.all(), &mut out);
    black_box(out).array(0)[0]
}

#[library_benchmark(setup = Arm::mh12)]
#[bench::poses_100()]
fn posture_and_predict(arm: Arm) -> Vector3<f64> {
    let mut sum = Vector3::zeros();
    for _ in 0..100 {
        sum += arm.predict(black_box(&[0.2, 0.3, -0.4, 0.5, 0.6, 0.7]));
    }
    sum
}

/// A pool of the calling thread: nothing waits, and what waits is not counted.
fn pool() -> ThreadPool {
    let pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build().expect("a pool of the calling thread")
}

fn arm_and_pool() -> (Arm, ThreadPool) {
    (Arm::mh12(), pool())
}

#[library_benchmark(setup = arm_and_pool)]
#[bench::poses_10201()]
fn map_of_one_posture((arm, pool): (Arm, ThreadPool)) -> bool {
    pool.install(|| black_box(map(&arm, Modelled::Drives, ONE_POSTURE)).is_some())
}

#[library_benchmark(setup = arm_and_pool)]
#[bench::poses_10201()]
fn map_of_the_best((arm, pool): (Arm, ThreadPool)) -> bool {
    pool.install(|| black_box(map(&arm, Modelled::Drives, BranchChoice::Best)).is_some())
}

#[library_benchmark(setup = arm_and_pool)]
#[bench::poses_10201()]
fn springs_map_of_one_posture((arm, pool): (Arm, ThreadPool)) -> bool {
    pool.install(|| black_box(map(&arm, Modelled::Springs, ONE_POSTURE)).is_some())
}

#[library_benchmark(setup = arm_and_pool)]
#[bench::poses_10201()]
fn backlash_map_of_one_posture((arm, pool): (Arm, ThreadPool)) -> bool {
    pool.install(|| black_box(map(&arm, Modelled::Backlash, ONE_POSTURE)).is_some())
}

fn calibrated_and_pool() -> (Other, ThreadPool) {
    (Other::calibrated(), pool())
}

#[library_benchmark(setup = calibrated_and_pool)]
#[bench::poses_3721()]
fn calibrated_map_of_one_posture((arm, pool): (Other, ThreadPool)) -> bool {
    let front = BranchChoice::Of(BranchPattern::FRONT_ELBOW_UP);
    pool.install(|| black_box(arm.map(front, grid(STEP))).is_some())
}

#[library_benchmark(setup = calibrated_and_pool)]
#[bench::poses_3721()]
fn calibrated_map_of_the_best((arm, pool): (Other, ThreadPool)) -> bool {
    pool.install(|| black_box(arm.map(BranchChoice::Best, grid(STEP))).is_some())
}

fn ur10_and_pool() -> (Other, ThreadPool) {
    (Other::ur10(), pool())
}

fn iiwa_and_pool() -> (Other, ThreadPool) {
    (Other::iiwa(), pool())
}

fn open_wrist_and_pool() -> (Other, ThreadPool) {
    (Other::open_wrist(), pool())
}

#[library_benchmark(setup = ur10_and_pool)]
#[bench::poses_4000()]
fn ur10_postures((arm, pool): (Other, ThreadPool)) -> bool {
    pool.install(|| black_box(arm.postures()).is_some())
}

#[library_benchmark(setup = iiwa_and_pool)]
#[bench::poses_4000()]
fn iiwa_postures((arm, pool): (Other, ThreadPool)) -> bool {
    pool.install(|| black_box(arm.postures()).is_some())
}

#[library_benchmark(setup = open_wrist_and_pool)]
#[bench::poses_10()]
fn open_wrist_postures((arm, pool): (Other, ThreadPool)) -> bool {
    pool.install(|| black_box(arm.postures()).is_some())
}

fn one_pose_setup() -> (Arm, Vec<Isometry>) {
    (Arm::mh12(), poses(100).iter().map(isometry).collect())
}

#[library_benchmark(setup = one_pose_setup)]
#[bench::poses_100()]
fn postures_of_one_pose((arm, poses): (Arm, Vec<Isometry>)) -> usize {
    let all = poses.iter().map(|pose| black_box(arm.all_postures(pose)));
    all.sum()
}

fn placement_setup() -> (Arm, PathPlaces, ThreadPool) {
    (Arm::mh12(), PathPlaces::steady(), pool())
}

#[library_benchmark(setup = placement_setup)]
#[bench::poses_80000()]
fn placement((arm, places, pool): (Arm, PathPlaces, ThreadPool)) -> usize {
    pool.install(|| black_box(places.evaluate(&arm, Modelled::Drives, 1)).unreachable)
}

#[library_benchmark(setup = placement_setup)]
#[bench::poses_80000()]
fn placement_with_springs((arm, places, pool): (Arm, PathPlaces, ThreadPool)) -> usize {
    pool.install(|| black_box(places.evaluate(&arm, Modelled::Springs, 1)).unreachable)
}

library_benchmark_group!(
    name = per_pose,
    benchmarks = [
        lanes_dev,
        lanes_c66,
        lanes_ik8,
        kernel_evaluate,
        posture_and_predict,
        map_of_one_posture,
        map_of_the_best,
        springs_map_of_one_posture,
        backlash_map_of_one_posture,
        calibrated_map_of_one_posture,
        calibrated_map_of_the_best,
        ur10_postures,
        iiwa_postures,
        open_wrist_postures,
        postures_of_one_pose,
        placement,
        placement_with_springs
    ]
);
main!(
    // Instruction by instruction, so that quotients and roots can be counted; with loads and stores.
    config =
        LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--dump-instr=yes", "--cache-sim=yes"])),
    library_benchmark_groups = per_pose
);

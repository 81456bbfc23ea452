//! Instructions that a pose costs, counted by Callgrind: the same on a busy machine as on an idle one.
//!
//! `cargo xtask bench --instructions` runs this and compares with `bench/instructions.tsv`. Valgrind knows AVX2 and
//! FMA but not AVX-512. To count another function: one `#[bench]` here; the name ends in the number of poses.
// What the macros of gungraun write is not ours to document or to qualify.
#![allow(missing_docs, unused_qualifications)]

use std::hint::black_box;

use armill_bench::armill::{Arm, ONE_POSTURE, isometry};
use armill_bench::lanes::Places;
use armill_bench::workload::poses;
use armill_core::frame::Isometry;
use armill_core::kernel::evaluate;
use armill_core::kernel::lanes::{Arrays, Backend, Batch, Envelopes};
use armill_core::nalgebra::Vector3;
use armill_core::robot::Branch;
use armill_core::watch::Watch;
use gungraun::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Not counted: building the arm, choosing the poses, starting the pool.
fn evaluate_setup(count: usize) -> (Arm, Vec<Isometry>, ThreadPool) {
    let poses = poses(count).iter().map(isometry).collect();
    // The benchmark's own thread works: nothing waits, and what waits is not counted.
    let pool = ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build();
    (Arm::mh12(), poses, pool.expect("a pool of the calling thread"))
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

library_benchmark_group!(
    name = per_pose,
    benchmarks = [
        lanes_dev,
        lanes_c66,
        lanes_ik8,
        kernel_evaluate,
        posture_and_predict
    ]
);
main!(library_benchmark_groups = per_pose);

//! Rows of the lanes kernel: the same work on every back end of this machine, in double and single precision.
//!
//! Poses are given as arrays, as in applications with many of them; results of a few blocks overwrite those before, so
//! that work is timed and not the RAM.

use std::hint::black_box;

use armill_core::kernel::Question;
use armill_core::kernel::lanes::{Arrays, Backend, Batch, Envelopes, Poses, Precision};
use armill_core::nalgebra::{Matrix3, Rotation3};
use armill_core::robot::Branch;
use rayon::ThreadPool;
use rayon::prelude::*;

use crate::clock::Candidate;
use crate::work::{C66, DEV, DEV8, IK8};
use crate::workload::Pose;

/// How often the poses are gone through in a round: ten milliseconds would measure how long a processor takes to change
/// its clock for wide vectors.
const REPEATED: usize = 40;
/// Poses whose results share memory: whole blocks of the kernel.
const TOGETHER: usize = 240;
const BRANCH: Branch = Branch::ALL[0];
const NOTE: &str = "verified, limits of both flips, singularity and reach flagged, worst case";

/// The workload as arrays.
pub struct Places<T> {
    base_from_tool: Rotation3<f64>,
    at: [Vec<T>; 3],
}

impl<T: Precision> Places<T> {
    /// The places of `poses`, which all have the orientation of the first.
    pub fn of(poses: &[Pose]) -> Places<T> {
        let [a, b, c, _, d, e, f, _, g, h, i, _] = poses[0];
        let all = |k: usize| poses.iter().map(|pose| T::from_f64(pose[k])).collect();
        Places {
            base_from_tool: Rotation3::from_matrix_unchecked(Matrix3::new(a, b, c, d, e, f, g, h, i)),
            at: [all(3), all(7), all(11)],
        }
    }

    fn len(&self) -> usize {
        self.at[0].len()
    }

    /// All at once.
    pub fn all(&self) -> Poses<'_, T> {
        self.from(0, self.len())
    }

    /// Blocks at a time, all poses again and again.
    fn chunks(&self) -> impl Iterator<Item = Poses<'_, T>> {
        (0..REPEATED)
            .flat_map(|_| (0..self.len()).step_by(TOGETHER))
            .map(|first| self.from(first, TOGETHER))
    }

    fn from(&self, first: usize, count: usize) -> Poses<'_, T> {
        let last = self.len().min(first + count);
        Poses::Still {
            base_from_tool: self.base_from_tool,
            at: self.at.each_ref().map(|array| &array[first..last]),
        }
    }
}

/// All rows in double and single precision.
pub fn candidates<'a>(
    question: &Question<'a>,
    places: &'a Places<f64>,
    single: &'a Places<f32>,
    two_threads: &'a ThreadPool,
) -> Vec<Candidate<'a>> {
    let fastest = Backend::fastest();
    let mut all = works("armill lanes f64", question, places, fastest);
    all.push(on_threads(question, places, fastest, two_threads));
    for backend in Backend::available() {
        let who = match backend.to_string().as_str() {
            "scalar" => "armill lanes f64 scalar",
            "SSE2" => "armill lanes f64 SSE2",
            "AVX2" => "armill lanes f64 AVX2",
            _ => continue,
        };
        all.extend(works(who, question, places, backend));
    }
    all.extend(works("armill lanes f32", question, single, fastest));
    all
}

fn works<'a, T: Precision>(
    who: &'static str,
    question: &Question<'a>,
    places: &'a Places<T>,
    backend: Backend,
) -> Vec<Candidate<'a>> {
    let made = || batch::<T>(question, backend);
    let (mut of_one, mut of_all, mut matrices, mut angles) = (made(), made(), made(), made());
    let dev = move || {
        let mut out = Envelopes::default();
        for poses in places.chunks() {
            of_one.envelopes(&poses, BRANCH, &mut out);
            black_box(&out);
        }
    };
    let dev8 = move || {
        let mut out: [Envelopes<T>; 4] = Default::default();
        for poses in places.chunks() {
            of_all.envelopes_of_all(&poses, &mut out);
            black_box(&out);
        }
    };
    let c66 = move || {
        let mut out = Arrays::default();
        for poses in places.chunks() {
            matrices.compliances(&poses, BRANCH, &mut out);
            black_box(&out);
        }
    };
    let ik8 = move || {
        let mut out = Arrays::default();
        for poses in places.chunks() {
            angles.joints(&poses, &mut out);
            black_box(&out);
        }
    };
    vec![
        Candidate::new(who, DEV, REPEATED * places.len(), dev).note(NOTE),
        Candidate::new(who, DEV8, REPEATED * places.len(), dev8).note(NOTE),
        Candidate::new(who, C66, REPEATED * places.len(), c66).note(NOTE),
        Candidate::new(who, IK8, REPEATED * places.len(), ik8).note(NOTE),
    ]
}

fn on_threads<'a>(
    question: &Question<'a>,
    places: &'a Places<f64>,
    backend: Backend,
    pool: &'a ThreadPool,
) -> Candidate<'a> {
    /// Enough for a hand-over between threads to cost nothing.
    const SHARE: usize = 20_000;
    /// A processor that slept while the other candidates worked takes milliseconds to wake.
    const LONG: usize = 4 * REPEATED;
    let threads = pool.current_num_threads();
    let batch = batch::<f64>(question, backend);
    let run = move || {
        pool.install(|| {
            let starts = (0..LONG * places.len()).into_par_iter().step_by(SHARE);
            starts.for_each_init(
                || (batch.clone(), Envelopes::default()),
                |(batch, out), first| {
                    let first = first % places.len();
                    for part in (first..places.len().min(first + SHARE)).step_by(TOGETHER) {
                        batch.envelopes(&places.from(part, TOGETHER), BRANCH, out);
                        black_box(&*out);
                    }
                },
            );
        });
    };
    Candidate::new("armill lanes f64", DEV, LONG * places.len(), run)
        .threads(threads)
        .note(NOTE)
}

/// Lanes for the arm of `question`.
fn batch<T: Precision>(question: &Question<'_>, backend: Backend) -> Batch<T> {
    let arm = question
        .arm
        .robot
        .ortho_parallel()
        .expect("MH12 has a closed form");
    Batch::new(question, arm, backend)
}

/// Envelopes of `poses`, for the check of agreement.
pub fn envelopes<T: Precision>(question: &Question<'_>, poses: &[Pose]) -> Vec<f64> {
    let places = Places::<T>::of(poses);
    let mut out = Envelopes::default();
    batch::<T>(question, Backend::fastest()).envelopes(&places.all(), BRANCH, &mut out);
    out.in_plane().iter().map(|value| value.to_f64()).collect()
}

//! Which instructions do the work: chosen at run time, one source for all.

use std::fmt;

use super::real::{Alone, Float, Fused, Plain, Real};

/// A set of instructions that this machine has.
///
/// All back ends that fuse a product and a sum (AVX2, AVX-512, NEON) give the same bits; so do the others among
/// themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Backend(Instructions);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Instructions {
    Scalar,
    /// What the target has at least: SSE2 on x86-64.
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "aarch64")]
    Neon,
}

impl Instructions {
    /// Those that the target may have, slowest first.
    const ALL: &[Instructions] = &[
        Instructions::Scalar,
        Instructions::Baseline,
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx2,
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx512,
        #[cfg(target_arch = "aarch64")]
        Instructions::Neon,
    ];

    /// Whether this machine has them.
    #[inline]
    fn are_here(self) -> bool {
        match self {
            Instructions::Scalar | Instructions::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("fma")
            }
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon => true,
        }
    }
}

/// A loop over one block, compiled once for each back end.
pub(crate) trait Work<T: Float> {
    /// Does it. Must be `#[inline(always)]`, and so must all that it calls, for the back end's instructions to
    /// be used; a closure does not inherit them.
    fn run<R: Real<Float = T>>(self);
}

/// The two ways to store and compute a number, each with its plain and its fused form.
pub trait Precision: Float {
    /// Rounds product and sum one after the other.
    type Plain: Real<Float = Self>;
    /// The same, one lane at a time.
    type Alone: Real<Float = Self>;
    /// Rounds product and sum once.
    type Fused: Real<Float = Self>;
}

impl Precision for f64 {
    type Plain = Plain<f64>;
    type Alone = Alone<f64>;
    type Fused = Fused<f64>;
}

impl Precision for f32 {
    type Plain = Plain<f32>;
    type Alone = Alone<f32>;
    type Fused = Fused<f32>;
}

impl Backend {
    /// One number after the other; every machine has it.
    pub const SCALAR: Backend = Backend(Instructions::Scalar);

    /// All that this machine has, slowest first.
    pub fn available() -> Vec<Backend> {
        Instructions::ALL
            .iter()
            .filter(|instructions| instructions.are_here())
            .map(|instructions| Backend(*instructions))
            .collect()
    }

    /// The fastest that this machine has.
    #[inline]
    pub fn fastest() -> Backend {
        let mut fastest_first = Instructions::ALL.iter().rev();
        let found = fastest_first.find(|instructions| instructions.are_here());
        found.map_or(Backend::SCALAR, |instructions| Backend(*instructions))
    }

    /// Whether it rounds a product and a sum once: all that do give the same bits.
    pub fn fuses(self) -> bool {
        !matches!(self.0, Instructions::Scalar | Instructions::Baseline)
    }

    /// Runs `work` with these instructions.
    #[allow(unsafe_code)]
    pub(crate) fn run<T: Precision>(self, work: impl Work<T>) {
        match self.0 {
            Instructions::Scalar => work.run::<T::Alone>(),
            Instructions::Baseline => work.run::<T::Plain>(),
            // SAFETY: only `available` and `fastest` make this value, after finding AVX2 and FMA on this machine.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => unsafe { on_avx2(work) },
            // SAFETY: the same, after finding AVX-512 F, DQ, VL and FMA.
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => unsafe { on_avx512(work) },
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon => work.run::<T::Fused>(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn on_avx2<T: Precision>(work: impl Work<T>) {
    work.run::<T::Fused>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,fma")]
fn on_avx512<T: Precision>(work: impl Work<T>) {
    work.run::<T::Fused>();
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            Instructions::Scalar => "scalar",
            #[cfg(target_arch = "x86_64")]
            Instructions::Baseline => "SSE2",
            #[cfg(not(target_arch = "x86_64"))]
            Instructions::Baseline => "baseline",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => "AVX-512",
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon => "NEON",
        })
    }
}

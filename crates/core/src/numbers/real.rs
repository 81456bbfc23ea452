//! The number that lanes are made of.
//!
//! Kernels are written once, as branch-free arithmetic on [`Real`]; the compiler turns their loops over a
//! block into vector code of the back end that they are compiled for. A `Real` is a plain float; its type says how
//! a product and a sum are rounded, so that the bits depend on that alone and not on the width of a vector:
//!
//! | type | `a b + c` | back ends |
//! |---|---|---|
//! | [`Plain`] | rounded twice | SSE2, or whatever the target has at least |
//! | [`Alone`] | rounded twice, never vectorised | scalar |
//! | [`Fused`] | rounded once | AVX2, AVX-512, NEON |
//! | `f64` | rounded twice | none: a number by itself |
//!
//! A comparison gives a `bool`; [`Real::either`] takes one of two values by it without a branch.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a block stores: `f64` or `f32`.
pub trait Float: Copy + Debug + Default + PartialOrd + Send + Sync + 'static {
    /// 1.5 times 2 to the mantissa's bits: adding and taking it away rounds to a whole number.
    const ROUNDER: f64;
    /// A squared length (m^2, or sine squared) below this is zero.
    const NOTHING: f64;
    /// The least length that anything is divided by.
    const LEAST: f64;
    /// Largest relative error of lengths and directions of a verified posture.
    const VERIFIED: f64;
    /// Share of a turn by which half a turn is missed and still is half a turn.
    const HALF_TURN_SLACK: f64;
    /// Tolerance (rad) at a limit.
    const AT_LIMIT: f64;

    /// The nearest value.
    fn from_f64(value: f64) -> Self;
    /// The same value.
    fn to_f64(self) -> f64;
    /// Without what is behind the point.
    fn to_i32(self) -> i32;
}

impl Float for f64 {
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    const NOTHING: f64 = 1e-18;
    const LEAST: f64 = 1e-300;
    const VERIFIED: f64 = 1e-9;
    const HALF_TURN_SLACK: f64 = 1e-12;
    const AT_LIMIT: f64 = 1e-9;

    fn from_f64(value: f64) -> f64 {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn to_i32(self) -> i32 {
        self as i32
    }
}

impl Float for f32 {
    const ROUNDER: f64 = 12_582_912.0;
    const NOTHING: f64 = 1e-10;
    const LEAST: f64 = 1e-30;
    const VERIFIED: f64 = 1e-3;
    const HALF_TURN_SLACK: f64 = 1e-6;
    const AT_LIMIT: f64 = 1e-5;

    fn from_f64(value: f64) -> f32 {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn to_i32(self) -> i32 {
        self as i32
    }
}

/// A number of one lane.
pub trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// What blocks store.
    type Float: Float;

    /// A stored number.
    fn load(stored: Self::Float) -> Self;
    /// The number to store.
    fn store(self) -> Self::Float;
    /// `self a + b`.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// Its size.
    fn abs(self) -> Self;
    /// Marks the start of every loop over a block; keeps the scalar back end from being vectorised.
    fn step() {}

    /// A constant.
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::load(Self::Float::from_f64(value))
    }
    /// `yes` or `no`, without a branch.
    #[inline(always)]
    fn either(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }
    /// The greater; `other` where this is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::either(self > other, self, other)
    }
    /// The lesser; `other` where this is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::either(self < other, self, other)
    }
    /// 1 where `self >= 0`, otherwise -1.
    #[inline(always)]
    fn sign(self) -> Self {
        Self::either(self >= Self::of(0.0), Self::of(1.0), Self::of(-1.0))
    }
    /// The nearest whole number; of two the even one. Right below 2^51 (2^22 in `f32`).
    #[inline(always)]
    fn round(self) -> Self {
        let rounder = Self::of(<Self::Float as Float>::ROUNDER);
        (self + rounder) - rounder
    }
}

/// Six numbers in every lane.
#[inline(always)]
pub(crate) fn lanes_of<R: Real>(values: &[f64; 6]) -> [R; 6] {
    let [a, b, c, d, e, f] = *values;
    [R::of(a), R::of(b), R::of(c), R::of(d), R::of(e), R::of(f)]
}

macro_rules! operator {
    ($type:ident, $trait:ident, $function:ident, $operator:tt) => {
        impl<T: $trait<Output = T>> $trait for $type<T> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                $type(self.0 $operator other.0)
            }
        }
    };
}

macro_rules! arithmetic {
    ($(#[$meta:meta])* $type:ident) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        #[repr(transparent)]
        pub struct $type<T>(T);
        operator!($type, Add, add, +);
        operator!($type, Sub, sub, -);
        operator!($type, Mul, mul, *);
        operator!($type, Div, div, /);
        impl<T: Neg<Output = T>> Neg for $type<T> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                $type(-self.0)
            }
        }
    };
}

arithmetic!(
    /// Product and sum rounded one after the other.
    Plain
);
arithmetic!(
    /// Like [`Plain`], one lane at a time.
    Alone
);
arithmetic!(
    /// Product and sum rounded once.
    Fused
);

macro_rules! real {
    ($type:ident, $float:ty, |$x:ident, $a:ident, $b:ident| $mul_add:expr, $step:expr) => {
        impl Real for $type<$float> {
            type Float = $float;
            #[inline(always)]
            fn load(stored: $float) -> Self {
                $type(stored)
            }
            #[inline(always)]
            fn store(self) -> $float {
                self.0
            }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                let ($x, $a, $b) = (self.0, a.0, b.0);
                $type($mul_add)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $type(self.0.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $type(self.0.abs())
            }
            #[inline(always)]
            fn step() {
                $step
            }
        }
    };
}

/// A number by itself, for formulas that lanes share with code for one posture.
impl Real for f64 {
    type Float = f64;
    #[inline(always)]
    fn load(stored: f64) -> f64 {
        stored
    }
    #[inline(always)]
    fn store(self) -> f64 {
        self
    }
    #[inline(always)]
    fn mul_add(self, a: f64, b: f64) -> f64 {
        self * a + b
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
}

real!(Plain, f64, |x, a, b| x * a + b, ());
real!(Plain, f32, |x, a, b| x * a + b, ());
real!(Alone, f64, |x, a, b| x * a + b, std::hint::black_box(()));
real!(Alone, f32, |x, a, b| x * a + b, std::hint::black_box(()));
real!(Fused, f64, |x, a, b| x.mul_add(a, b), ());
real!(Fused, f32, |x, a, b| x.mul_add(a, b), ());

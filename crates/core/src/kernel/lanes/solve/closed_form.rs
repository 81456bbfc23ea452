//! One posture of one lane without any angle: the closed form of `robot::inverse::ortho_parallel` with cosines, sines
//! and points.
//!
//! ```text
//! phi1:  (c1, s1) = (r px + b py, r py - b px) / h^2       h^2 = px^2 + py^2, r = +-sqrt(h^2 - b^2)
//! psi:   (cp, sp) = (v k1 + u k2, u k1 - v k2) / d^2       u = r - a1, v = pz, d^2 = u^2 + v^2
//! chi:   (cc, sc) = (v - l2 cp, u - l2 sp) / l3
//! z4 = Rz(phi1) Ry(chi) z4_upright        n = z4 x z6 = sin(bend) z5
//! ```
//!
//! One division serves both quotients. Source: as there.

use crate::kernel::lanes::geometry::{Aims, Arm, Prepared, aim};
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put};
use crate::robot::inverse::two_links::NEAR_SINGULAR;

/// A posture. Finite for every aim; valid only where the flags allow it.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Solved<R> {
    pub c1: R,
    pub s1: R,
    /// Upper arm and forearm from the vertical.
    pub cp: R,
    pub sp: R,
    pub cc: R,
    pub sc: R,
    pub z4: Vector<R>,
    pub n: Vector<R>,
    /// Square of the sine of the wrist's bend.
    pub n2: R,
    /// One over that.
    pub per_n2: R,
}

/// Planes of a [`Solved`].
pub(super) const SOLVED: usize = 14;

/// The postures of a block.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct Postures<T> {
    /// 1 for front, -1 for back; 1 for elbow up, -1 for elbow down: chosen by the caller.
    pub signs: Planes<T, 2>,
    r: Plane<T>,
    /// Flags that the shoulder alone decides.
    reached: Plane<T>,
    across: Plane<T>,
    solved: Planes<T, SOLVED>,
    /// Bits of [`flag`], as a number.
    pub flags: Plane<T>,
}

impl<T: Float> Postures<T> {
    /// Cosine and sine of phi1, psi and chi.
    pub fn turns(&self) -> [&Plane<T>; 6] {
        let [c1, s1, cp, sp, cc, sc, ..] = &self.solved;
        [c1, s1, cp, sp, cc, sc]
    }

    /// Squared sine of the wrist's bend.
    pub fn bend2(&self) -> &Plane<T> {
        &self.solved[12]
    }

    /// Allocates a block.
    pub fn new() -> Postures<T> {
        Postures {
            signs: planes(),
            r: [T::default(); BLOCK],
            reached: [T::default(); BLOCK],
            across: [T::default(); BLOCK],
            solved: planes(),
            flags: [T::default(); BLOCK],
        }
    }
}

impl<R: Real> Solved<R> {
    /// Arm and forearm in this posture; the wrist's bend is a right angle, its axis must follow.
    #[inline(always)]
    pub fn turned(links: &Links<R>, [c1, s1]: [R; 2], [cp, sp]: [R; 2], [cc, sc]: [R; 2]) -> Self {
        let z4 = turned(links.forearm[0], cc, sc, c1, s1);
        Solved {
            c1,
            s1,
            cp,
            sp,
            cc,
            sc,
            z4,
            n: z4,
            n2: R::of(1.0),
            per_n2: R::of(1.0),
        }
    }

    /// The posture of point `i`.
    #[inline(always)]
    pub fn load(postures: &Postures<R::Float>, i: usize) -> Self {
        let at = |k: usize| R::load(postures.solved[k][i]);
        Solved {
            c1: at(0),
            s1: at(1),
            cp: at(2),
            sp: at(3),
            cc: at(4),
            sc: at(5),
            z4: Vector::new(at(6), at(7), at(8)),
            n: Vector::new(at(9), at(10), at(11)),
            n2: at(12),
            per_n2: at(13),
        }
    }
}

/// Flags of a lane, as bits.
pub mod flag {
    /// The wrist centre is beyond the stretched arm.
    pub const TOO_FAR: u32 = 1;
    /// The wrist centre is inside the folded arm.
    pub const TOO_NEAR: u32 = 2;
    /// The wrist centre is inside the lateral offset about axis 1.
    pub const INSIDE_LATERAL_OFFSET: u32 = 4;
    /// Out of reach, or the solution fails its own check: links of wrong length.
    pub const UNVERIFIED: u32 = 8;
    /// Axes 4 and 6 in line: joints 4 and 6 are not unique, and joint 5's part is not to be trusted.
    pub const WRIST_UNDECIDED: u32 = 16;
    /// Within 1 deg of the wrist singularity.
    pub const NEAR_WRIST: u32 = 32;
    /// Within 1 deg of the stretched or folded arm.
    pub const NEAR_ELBOW: u32 = 64;
    /// Wrist centre near axis 1.
    pub const NEAR_SHOULDER: u32 = 128;
    /// A joint leaves its range.
    pub const OUTSIDE_LIMITS: u32 = 256;
    /// The same posture with the wrist flipped exceeds the range of a joint.
    pub const OUTSIDE_LIMITS_FLIPPED: u32 = 512;

    /// No posture at all.
    pub const UNREACHABLE: u32 = TOO_FAR | TOO_NEAR | INSIDE_LATERAL_OFFSET | UNVERIFIED;
}

/// Numbers of the arm in every lane.
#[derive(Clone, Copy)]
pub(in crate::kernel::lanes) struct Links<R> {
    a1: R,
    b: R,
    b2: R,
    l2: R,
    l3: R,
    per_l3: R,
    reach2: R,
    fold2: R,
    l2_less_l3: R,
    half_per_l2: R,
    near_elbow: R,
    near_shoulder: R,
    forearm: [Vector<R>; 3],
}

impl<R: Real> Links<R> {
    #[inline(always)]
    pub fn new(arm: &Arm) -> Self {
        Links {
            a1: R::of(arm.a1),
            b: R::of(arm.b),
            b2: R::of(arm.b * arm.b),
            l2: R::of(arm.l2),
            l3: R::of(arm.l3),
            per_l3: R::of(1.0 / arm.l3),
            reach2: R::of((arm.l2 + arm.l3) * (arm.l2 + arm.l3)),
            fold2: R::of((arm.l2 - arm.l3) * (arm.l2 - arm.l3)),
            l2_less_l3: R::of(arm.l2 * arm.l2 - arm.l3 * arm.l3),
            half_per_l2: R::of(0.5 / arm.l2),
            near_elbow: R::of(arm.near_elbow * arm.l3),
            near_shoulder: R::of(arm.near_shoulder * (arm.l2 + arm.l3)),
            forearm: [
                Vector::of(&arm.forearm[0]),
                Vector::of(&arm.forearm[1]),
                Vector::of(&arm.forearm[2]),
            ],
        }
    }

    /// The wrist centre.
    #[inline(always)]
    pub fn wrist_centre(&self, solved: &Solved<R>) -> Vector<R> {
        let out = self.l3.mul_add(solved.sc, self.l2.mul_add(solved.sp, self.a1));
        let up = self.l3.mul_add(solved.cc, self.l2 * solved.cp);
        let (c1, s1) = (solved.c1, solved.s1);
        Vector::new(c1.mul_add(out, -(s1 * self.b)), s1.mul_add(out, c1 * self.b), up)
    }

    /// Axis 5 with joint 4 at zero, and `z4 x` that axis.
    #[inline(always)]
    pub fn wrist_axes(&self, solved: &Solved<R>) -> [Vector<R>; 2] {
        let Solved { cc, sc, c1, s1, .. } = *solved;
        [
            turned(self.forearm[1], cc, sc, c1, s1),
            turned(self.forearm[2], cc, sc, c1, s1),
        ]
    }

    /// Where the axis-2-to-TCP and elbow-to-TCP levers start: shoulder and elbow as (outwards, up) in the arm's plane.
    #[inline(always)]
    pub fn elbow(&self, solved: &Solved<R>) -> [R; 2] {
        [self.l2.mul_add(solved.sp, self.a1), self.l2 * solved.cp]
    }

    /// Distance of axis 2 from axis 1.
    #[inline(always)]
    pub fn a1(&self) -> R {
        self.a1
    }
}

/// A vector of the upright forearm, turned by chi about y and by phi1 about z.
#[inline(always)]
pub(super) fn turned<R: Real>(v: Vector<R>, cc: R, sc: R, c1: R, s1: R) -> Vector<R> {
    let x = cc.mul_add(v.x, sc * v.z);
    let z = cc.mul_add(v.z, -(sc * v.x));
    Vector::new(c1.mul_add(x, -(s1 * v.y)), s1.mul_add(x, c1 * v.y), z)
}

/// Finds how far before or behind axis 1 the wrist is: the same for either elbow.
pub(in crate::kernel::lanes) struct Reach<'a, T, const STILL: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a mut Postures<T>,
}

impl<T: Float, const STILL: bool> Work<T> for Reach<'_, T, STILL> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        for i in 0..BLOCK {
            R::step();
            links.reach::<STILL>(self.aims, self.postures, i);
        }
    }
}

/// Solves every posture of a block, given by its signs, after [`Reach`].
pub(in crate::kernel::lanes) struct Solve<'a, T, const STILL: bool> {
    pub prepared: &'a Prepared,
    pub aims: &'a Aims<T>,
    pub postures: &'a mut Postures<T>,
}

impl<T: Float, const STILL: bool> Work<T> for Solve<'_, T, STILL> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let links = Links::<R>::new(&self.prepared.arm);
        // Loops of one root or quotient each: they are slow, and a processor that looks a hundred instructions
        // ahead then works on those of several points at once.
        for i in 0..BLOCK {
            R::step();
            links.bend::<STILL>(self.aims, self.postures, i);
        }
        for i in 0..BLOCK {
            R::step();
            links.turn::<STILL>(self.aims, self.postures, i);
        }
        for i in 0..BLOCK {
            R::step();
            links.wrist::<STILL>(self.aims, self.postures, i);
        }
    }
}

impl<R: Real> Links<R> {
    /// Signed distance `r` of the wrist centre from axis 1 in the arm's plane.
    #[inline(always)]
    fn reach<const STILL: bool>(&self, aims: &Aims<R::Float>, postures: &mut Postures<R::Float>, i: usize) {
        let zero = R::of(0.0);
        let p = wrist_of::<R, STILL>(aims, i);
        let r2 = p.x.mul_add(p.x, p.y.mul_add(p.y, -self.b2));
        let r = R::load(postures.signs[0][i]) * r2.max(zero).sqrt();
        postures.r[i] = r.store();
        let flags = flagged(zero, r2 < zero, flag::INSIDE_LATERAL_OFFSET);
        let flags = flagged(flags, r.abs() < self.near_shoulder, flag::NEAR_SHOULDER);
        postures.reached[i] = flags.store();
    }

    /// Length of the forearm times the sine of the elbow's bend.
    #[inline(always)]
    fn bend<const STILL: bool>(&self, aims: &Aims<R::Float>, postures: &mut Postures<R::Float>, i: usize) {
        let zero = R::of(0.0);
        let (u, v) = (R::load(postures.r[i]) - self.a1, wrist_of::<R, STILL>(aims, i).z);
        let d2 = u.mul_add(u, v * v);
        let (stretched, folded) = (self.reach2 - d2, d2 - self.fold2);
        // Bending the forearm forwards lifts the elbow if the wrist is before the shoulder.
        let side = R::load(postures.signs[1][i]) * u.sign();
        let across = side * ((stretched * folded).max(zero).sqrt() * self.half_per_l2);
        postures.across[i] = across.store();
        let flags = flagged(R::load(postures.reached[i]), stretched < zero, flag::TOO_FAR);
        let flags = flagged(flags, folded < zero, flag::TOO_NEAR);
        let flags = flagged(flags, across.abs() < self.near_elbow, flag::NEAR_ELBOW);
        postures.flags[i] = flags.store();
    }

    /// Turns of the arm; verifies that links have their lengths.
    #[inline(always)]
    fn turn<const STILL: bool>(&self, aims: &Aims<R::Float>, postures: &mut Postures<R::Float>, i: usize) {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let nothing = R::of(<R::Float as Float>::NOTHING);
        let (r, across) = (R::load(postures.r[i]), R::load(postures.across[i]));
        let p = wrist_of::<R, STILL>(aims, i);
        let (u, v) = (r - self.a1, p.z);
        let h2 = p.x.mul_add(p.x, p.y * p.y);
        let d2 = u.mul_add(u, v * v);
        let (on_axis, on_shoulder) = (h2 < nothing, d2 < nothing);
        let (h2, d2) = (h2.max(nothing), d2.max(nothing));
        let quotient = one / (h2 * d2);
        let (per_h2, per_d2) = (d2 * quotient, h2 * quotient);

        let c1 = R::either(on_axis, one, r.mul_add(p.x, self.b * p.y) * per_h2);
        let s1 = R::either(on_axis, zero, r.mul_add(p.y, -(self.b * p.x)) * per_h2);
        let k1 = (d2 + self.l2_less_l3) * self.half_per_l2;
        let cp = R::either(on_shoulder, one, v.mul_add(k1, u * across) * per_d2);
        let sp = R::either(on_shoulder, zero, u.mul_add(k1, -(v * across)) * per_d2);
        let cc = (-self.l2).mul_add(cp, v) * self.per_l3;
        let sc = (-self.l2).mul_add(sp, u) * self.per_l3;
        let [at_c1, at_s1, at_cp, at_sp, at_cc, at_sc, ..] = &mut postures.solved;
        at_c1[i] = c1.store();
        at_s1[i] = s1.store();
        at_cp[i] = cp.store();
        at_sp[i] = sp.store();
        at_cc[i] = cc.store();
        at_sc[i] = sc.store();

        let off = |c: R, s: R| c.mul_add(c, s.mul_add(s, -one));
        let (arm, upper, fore) = (off(c1, s1), off(cp, sp), off(cc, sc));
        let error = arm.mul_add(arm, upper.mul_add(upper, fore * fore));
        let unverified = error > R::of(<R::Float as Float>::VERIFIED * <R::Float as Float>::VERIFIED);
        postures.flags[i] = flagged(R::load(postures.flags[i]), unverified, flag::UNVERIFIED).store();
    }

    /// Axis 4, and the wrist's bend.
    #[inline(always)]
    fn wrist<const STILL: bool>(&self, aims: &Aims<R::Float>, postures: &mut Postures<R::Float>, i: usize) {
        let Solved { c1, s1, cc, sc, .. } = Solved::<R>::load(postures, i);
        let z4 = turned(self.forearm[0], cc, sc, c1, s1);
        let n = z4.cross(aim::<R, STILL>(aims, i).out);
        let n2 = n.dot(n);
        put(&mut postures.solved[6..9], i, z4);
        put(&mut postures.solved[9..12], i, n);
        postures.solved[12][i] = n2.store();
        let nothing = R::of(<R::Float as Float>::NOTHING);
        postures.solved[13][i] = (R::of(1.0) / n2.max(nothing)).store();
        let near = R::of(NEAR_SINGULAR * NEAR_SINGULAR);
        let flags = flagged(R::load(postures.flags[i]), n2 < nothing, flag::WRIST_UNDECIDED);
        postures.flags[i] = flagged(flags, n2 < near, flag::NEAR_WRIST).store();
    }
}

/// The required wrist centre.
#[inline(always)]
fn wrist_of<R: Real, const STILL: bool>(aims: &Aims<R::Float>, i: usize) -> Vector<R> {
    let aim = aim::<R, STILL>(aims, i);
    aim.tcp - aim.lever
}

/// `flags` with `bit` where the condition is true.
#[inline(always)]
pub(super) fn flagged<R: Real>(flags: R, condition: bool, bit: u32) -> R {
    R::either(condition, flags + R::of(f64::from(bit)), flags)
}

//! One posture of one lane without any angle: the closed form of `robot::inverse::ortho_parallel`, told in
//! cosines, sines and points.
//!
//! ```text
//! phi1:  (c1, s1) = (r px + b py, r py - b px) / h^2       h^2 = px^2 + py^2, r = +-sqrt(h^2 - b^2)
//! psi:   (cp, sp) = (v k1 + u k2, u k1 - v k2) / d^2       u = r - a1, v = pz, d^2 = u^2 + v^2
//! chi:   (cc, sc) = (v - l2 cp, u - l2 sp) / l3
//! z4 = Rz(phi1) Ry(chi) z4_upright        n = z4 x z6 = sin(bend) z5
//! ```
//!
//! One division serves both quotients. Source: as there.

use super::arm::Arm;
use super::real::{Float, Real};
use super::vector::Vector;

/// Where the tool shall be, in the arm's axes.
#[derive(Clone, Copy)]
pub(super) struct Aim<R> {
    /// The tool centre point.
    pub tcp: Vector<R>,
    /// From the wrist centre to the TCP.
    pub lever: Vector<R>,
    /// Axis 6.
    pub out: Vector<R>,
    /// Axis 5 with joint 6 at zero.
    pub second: Vector<R>,
}

/// Signs that choose a posture: 1 for front and for elbow up, -1 for back and for elbow down.
#[derive(Clone, Copy)]
pub(super) struct Signs<R> {
    pub shoulder: R,
    pub elbow: R,
}

/// A posture. Finite whatever the aim; trust it where [`Solved::flags`] allows.
#[derive(Clone, Copy)]
pub(super) struct Solved<R> {
    pub c1: R,
    pub s1: R,
    /// Signed distance of the wrist centre from axis 1 in the arm's plane.
    pub r: R,
    /// Upper arm and forearm from the vertical.
    pub cp: R,
    pub sp: R,
    pub cc: R,
    pub sc: R,
    /// Length of the forearm times the sine of the elbow's bend.
    pub across: R,
    pub z4: Vector<R>,
    pub n: Vector<R>,
    /// Square of the sine of the wrist's bend.
    pub n2: R,
    /// `h^2 - b^2`, stretched minus asked, asked minus folded (m^2): negative where out of reach.
    pub room: [R; 3],
}

impl<R: Real> Solved<R> {
    /// Arm and forearm turned so; the wrist's bend is not known yet and counts as a right angle.
    #[inline(always)]
    pub fn turned(links: &Links<R>, [c1, s1]: [R; 2], [cp, sp]: [R; 2], [cc, sc]: [R; 2]) -> Self {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let z4 = turned(links.forearm[0], cc, sc, c1, s1);
        Solved {
            c1,
            s1,
            r: zero,
            cp,
            sp,
            cc,
            sc,
            across: zero,
            z4,
            n: z4,
            n2: one,
            room: [one; 3],
        }
    }
}

/// What may be said of a lane, as bits.
pub mod flag {
    /// The wrist centre is beyond the stretched arm.
    pub const TOO_FAR: u32 = 1;
    /// The wrist centre is inside the folded arm.
    pub const TOO_NEAR: u32 = 2;
    /// The wrist centre is inside the lateral offset about axis 1.
    pub const INSIDE_LATERAL_OFFSET: u32 = 4;
    /// The solution fails its own check: links of wrong length.
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
    /// The same posture with the wrist flipped leaves the range of a joint.
    pub const OUTSIDE_LIMITS_FLIPPED: u32 = 512;

    /// No posture at all.
    pub const UNREACHABLE: u32 = TOO_FAR | TOO_NEAR | INSIDE_LATERAL_OFFSET | UNVERIFIED;
}

/// Numbers of the arm in every lane.
#[derive(Clone, Copy)]
pub(super) struct Links<R> {
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

/// A posture nearer than this (sine of 1 deg) to a singularity is flagged.
const NEAR_SINGULAR: f64 = crate::robot::inverse::ortho_parallel::NEAR_SINGULAR;

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
            near_elbow: R::of(NEAR_SINGULAR * arm.l3),
            near_shoulder: R::of(NEAR_SINGULAR * (arm.l2 + arm.l3)),
            forearm: [
                Vector::of(&arm.forearm[0]),
                Vector::of(&arm.forearm[1]),
                Vector::of(&arm.forearm[2]),
            ],
        }
    }

    /// The posture with these signs.
    #[inline(always)]
    pub fn solve(&self, aim: &Aim<R>, signs: Signs<R>) -> Solved<R> {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let nothing = R::of(<R::Float as Float>::NOTHING);
        let p = aim.tcp - aim.lever;
        let h2 = p.x.mul_add(p.x, p.y * p.y);
        let r2 = h2 - self.b2;
        let r = signs.shoulder * r2.max(zero).sqrt();
        let (u, v) = (r - self.a1, p.z);
        let d2 = u.mul_add(u, v * v);
        let (h2_safe, d2_safe) = (h2.max(nothing), d2.max(nothing));
        let quotient = one / (h2_safe * d2_safe);
        let (per_h2, per_d2) = (d2_safe * quotient, h2_safe * quotient);

        let on_axis = h2 < nothing;
        let c1 = r.mul_add(p.x, self.b * p.y) * per_h2;
        let s1 = r.mul_add(p.y, -(self.b * p.x)) * per_h2;
        let (c1, s1) = (R::either(on_axis, one, c1), R::either(on_axis, zero, s1));

        // Bending the forearm forwards lifts the elbow if the wrist is before the shoulder.
        let (stretched, folded) = (self.reach2 - d2, d2 - self.fold2);
        let across = signs.elbow * u.sign() * ((stretched * folded).max(zero).sqrt() * self.half_per_l2);
        let k1 = (d2 + self.l2_less_l3) * self.half_per_l2;
        let on_shoulder = d2 < nothing;
        let cp = R::either(on_shoulder, one, v.mul_add(k1, u * across) * per_d2);
        let sp = R::either(on_shoulder, zero, u.mul_add(k1, -(v * across)) * per_d2);
        let cc = (-self.l2).mul_add(cp, v) * self.per_l3;
        let sc = (-self.l2).mul_add(sp, u) * self.per_l3;

        let z4 = turned(self.forearm[0], cc, sc, c1, s1);
        let n = z4.cross(aim.out);
        Solved {
            c1,
            s1,
            r,
            cp,
            sp,
            cc,
            sc,
            across,
            z4,
            n,
            n2: n.dot(n),
            room: [r2, stretched, folded],
        }
    }

    /// The wrist centre.
    #[inline(always)]
    pub fn wrist(&self, solved: &Solved<R>) -> Vector<R> {
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

    /// Bits of [`flag`] but the joint limits', as a number.
    #[inline(always)]
    pub fn flags(&self, solved: &Solved<R>) -> R {
        let zero = R::of(0.0);
        let bit = |condition, bit: u32| R::either(condition, R::of(f64::from(bit)), zero);
        let off = |c: R, s: R| (c.mul_add(c, s * s) - R::of(1.0)).abs();
        let [lateral, stretched, folded] = solved.room;
        let strays = off(solved.c1, solved.s1)
            .max(off(solved.cp, solved.sp))
            .max(off(solved.cc, solved.sc));
        // Out of reach nothing holds together: there is nothing to verify.
        let least = lateral.min(stretched).min(folded);
        let strays = R::either(least < zero, zero, strays);
        let reach = bit(stretched < zero, flag::TOO_FAR)
            + bit(folded < zero, flag::TOO_NEAR)
            + bit(lateral < zero, flag::INSIDE_LATERAL_OFFSET)
            + bit(strays > R::of(<R::Float as Float>::VERIFIED), flag::UNVERIFIED);
        let near = bit(
            solved.n2 < R::of(<R::Float as Float>::NOTHING),
            flag::WRIST_UNDECIDED,
        ) + bit(solved.n2 < R::of(NEAR_SINGULAR * NEAR_SINGULAR), flag::NEAR_WRIST)
            + bit(solved.across.abs() < self.near_elbow, flag::NEAR_ELBOW)
            + bit(solved.r.abs() < self.near_shoulder, flag::NEAR_SHOULDER);
        reach + near
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

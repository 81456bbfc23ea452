//! Closed form of arms with three parallel axes: the formulas of `robot::inverse::three_parallel`, a block of poses at
//! a time.

use nalgebra::{Matrix3, Vector3};

use super::found::state;
use crate::kernel::lanes::whole::FramePlanes;
use crate::numbers::{BLOCK, Backend, Float, Plane, Planes, Real, Vector, Work, atan2, planes, put, vector};
use crate::robot::inverse::ThreeParallel;
use crate::robot::inverse::two_links::{NEAR_SINGULAR, NEARLY_STRAIGHT, WRIST_SINGULAR};
use crate::robot::{Branch, Elbow, Shoulder, Wrist};

/// An arm and the poses of a block, in the arm's axes.
#[derive(Clone, Debug)]
pub(super) struct ThreeParallelBlock {
    arm: ThreeParallel,
    /// Wrist centre (m), axis 6 and axis 5 on the flange.
    aims: Planes<f64, 9>,
    /// Cosines and sines, or lengths in their ratio, of the six angles.
    turns: Planes<f64, 12>,
}

impl ThreeParallelBlock {
    pub fn new(arm: &ThreeParallel) -> ThreeParallelBlock {
        ThreeParallelBlock {
            arm: arm.clone(),
            aims: planes(),
            turns: planes(),
        }
    }

    /// Sets the flange poses, in base.
    pub fn aim_at(&mut self, targets: &FramePlanes<f64>, backend: Backend) {
        backend.run(FindAims {
            arm: &self.arm,
            targets,
            aims: &mut self.aims,
        });
    }

    /// Chain positions of one branch, whether it reaches each pose, and the singularity that it is near.
    pub fn solve(
        &mut self,
        branch: Branch,
        backend: Backend,
        theta: &mut [Plane<f64>],
        [state, singularity]: [&mut Plane<f64>; 2],
    ) {
        let ThreeParallelBlock { arm, aims, turns } = self;
        backend.run(FindTurns {
            arm,
            branch,
            aims,
            turns,
            state,
            singularity,
        });
        backend.run(FindAngles { arm, turns, theta });
    }
}

/// Fills wrist centre, axis 6 and axis 5 in the arm's axes.
struct FindAims<'a, T> {
    arm: &'a ThreeParallel,
    targets: &'a FramePlanes<T>,
    aims: &'a mut Planes<T, 9>,
}

impl<T: Float> Work<T> for FindAims<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let arm = self.arm;
        let turn: Matrix3<f64> = arm.arm_from_base.rotation.to_rotation_matrix().into_inner();
        let row = |k: usize| Vector::<R>::of(&Vector3::new(turn[(k, 0)], turn[(k, 1)], turn[(k, 2)]));
        let rows = [row(0), row(1), row(2)];
        let origin = Vector::<R>::of(&arm.arm_from_base.translation.vector);
        let wrist = Vector::<R>::of(&arm.flange_from_wrist.coords);
        let axis_6 = Vector::<R>::of(&arm.flange_from_axis_6);
        let axis_5 = Vector::<R>::of(&arm.flange_from_axis_5);
        for i in 0..BLOCK {
            R::step();
            let x = vector::<R>(&self.targets.axes[0], i);
            let y = vector::<R>(&self.targets.axes[1], i);
            let z = vector::<R>(&self.targets.axes[2], i);
            let at = vector::<R>(&self.targets.origin, i);
            let p = x.mul_add(wrist.x, y.mul_add(wrist.y, z.mul_add(wrist.z, at)));
            let out = x.mul_add(axis_6.x, y.mul_add(axis_6.y, z.scaled(axis_6.z)));
            let second = x.mul_add(axis_5.x, y.mul_add(axis_5.y, z.scaled(axis_5.z)));
            put(&mut self.aims[0..3], i, seen(&rows, p) + origin);
            put(&mut self.aims[3..6], i, seen(&rows, out));
            put(&mut self.aims[6..9], i, seen(&rows, second));
        }
    }
}

#[inline(always)]
fn seen<R: Real>(rows: &[Vector<R>; 3], v: Vector<R>) -> Vector<R> {
    Vector::new(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v))
}

/// Fills the six angles of a branch as lengths along x and y: phi1, psi, chi, turn of joints 2 to 4, bend, phi6. The
/// sines that show a singularity are among them.
struct FindTurns<'a, T> {
    arm: &'a ThreeParallel,
    branch: Branch,
    aims: &'a Planes<T, 9>,
    turns: &'a mut Planes<T, 12>,
    state: &'a mut Plane<T>,
    singularity: &'a mut Plane<T>,
}

impl<T: Float> Work<T> for FindTurns<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindTurns {
            arm,
            branch,
            aims,
            turns,
            state,
            singularity,
        } = self;
        let sign = |positive: bool| R::of(if positive { 1.0 } else { -1.0 });
        let shoulder = sign(branch.shoulder == Shoulder::Front);
        let elbow = sign(branch.elbow == Elbow::Up);
        let flip = sign(branch.wrist == Wrist::NoFlip);
        let (zero, one, half) = (R::of(0.0), R::of(1.0), R::of(0.5));
        let nothing = R::of(<T as Float>::NOTHING);
        let (a1, b, l2, l3) = (
            R::of(arm.a1),
            R::of(arm.b),
            R::of(arm.links.l2),
            R::of(arm.links.l3),
        );
        let (reach, fold) = (l2 + l3, (l2 - l3).abs());
        let slack = R::of(arm.links.slack);
        let least = R::of(if arm.links.slack > 0.0 {
            NEARLY_STRAIGHT * arm.links.l2 * arm.links.l3
        } else {
            0.0
        });
        let sense = R::of(arm.sense[3]);
        let (hand_x, hand_z) = (R::of(arm.hand.x), R::of(arm.hand.z));
        let (axis_x, axis_z) = (R::of(arm.axis_5.x), R::of(arm.axis_5.z));
        let singular = R::of(WRIST_SINGULAR);
        let near_wrist = R::of(NEAR_SINGULAR);
        let near_elbow = R::of(NEAR_SINGULAR * arm.links.l3);
        let near_shoulder = R::of(NEAR_SINGULAR * (arm.links.l2 + arm.links.l3));
        let (reached, unreached) = (R::of(state::REACHED), R::of(state::UNREACHED));
        let undecided = R::of(state::UNDECIDED);
        for i in 0..BLOCK {
            R::step();
            let p = vector::<R>(&aims[0..3], i);
            let (out, second) = (vector::<R>(&aims[3..6], i), vector::<R>(&aims[6..9], i));
            let h2 = p.x.mul_add(p.x, p.y * p.y);
            let r2 = (-b).mul_add(b, h2);
            let r = shoulder * r2.max(zero).sqrt();
            let (c1, s1) = (r.mul_add(p.x, b * p.y), r.mul_add(p.y, -(b * p.x)));
            let length = c1.mul_add(c1, s1 * s1);
            let on_axis = length < nothing * nothing;
            let per_length = one / length.max(nothing * nothing).sqrt();
            let c1 = R::either(on_axis, one, c1 * per_length);
            let s1 = R::either(on_axis, zero, s1 * per_length);
            turns[0][i] = c1.store();
            turns[1][i] = s1.store();
            let inside = b.abs() - h2.sqrt();
            let lateral = (r2 < zero) & (inside >= slack);

            let out = Vector::new(
                c1.mul_add(out.x, s1 * out.y),
                c1.mul_add(out.y, -(s1 * out.x)),
                out.z,
            );
            let second = Vector::new(
                c1.mul_add(second.x, s1 * second.y),
                c1.mul_add(second.y, -(s1 * second.x)),
                second.z,
            );
            let bent = out.x.mul_add(out.x, out.z * out.z).sqrt();
            let straight = bent < singular;
            turns[8][i] = (out.y * sense).store();
            turns[9][i] = (flip * bent).store();
            let per_bent = sense * flip / bent.max(singular);
            let (x5, z5) = (out.z * per_bent, -(out.x * per_bent));
            // Turn of joints 2 to 4 together, from axis 5; y x axis 5 at zero is (z, 0, -x).
            let (ct, st) = (
                axis_x.mul_add(x5, axis_z * z5),
                x5.mul_add(axis_z, -(z5 * axis_x)),
            );
            turns[6][i] = ct.store();
            turns[7][i] = st.store();
            let hand = [
                ct.mul_add(hand_x, st * hand_z),
                ct.mul_add(hand_z, -(st * hand_x)),
            ];
            let (u, v) = (r - hand[0] - a1, p.z - hand[1]);
            let d2 = u.mul_add(u, v * v);
            let d = d2.sqrt();
            let (stretched, folded) = (reach.mul_add(reach, -d2), d2 - fold * fold);
            let far = (stretched < zero) & (d - reach >= slack);
            let near = (folded < zero) & (fold - d >= slack);
            let product = stretched.max(least) * folded.max(least);
            let across = half * product.max(zero).sqrt() / l2;
            let along = half * (d2 - l2 * l2 - l3 * l3) / l2;
            let (k1, k2) = (l2 + along, elbow * u.sign() * across);
            let (cp, sp) = (v.mul_add(k1, u * k2), u.mul_add(k1, -(v * k2)));
            let length = cp.mul_add(cp, sp * sp);
            let on_shoulder = length < nothing * nothing;
            let per_length = one / length.max(nothing * nothing).sqrt();
            let cp = R::either(on_shoulder, one, cp * per_length);
            let sp = R::either(on_shoulder, zero, sp * per_length);
            turns[2][i] = cp.store();
            turns[3][i] = sp.store();
            let (cc, sc) = ((-l2).mul_add(cp, v), (-l2).mul_add(sp, u));
            turns[4][i] = cc.store();
            turns[5][i] = sc.store();

            let axis_5 = Vector::new(x5, zero, z5);
            turns[10][i] = axis_5.dot(second).store();
            turns[11][i] = out.dot(axis_5.cross(second)).store();
            // With axis 6 parallel to axes 2 to 4 joint 6 is free, and the reach depends on it.
            let found = R::either(lateral | far | near, unreached, reached);
            state[i] = R::either(straight, undecided, found).store();
            // The forearm has the length l3.
            let bend = sc.mul_add(cp, -(cc * sp)).abs();
            let close = R::either(r.abs() < near_shoulder, R::of(3.0), zero);
            let close = R::either(bend < near_elbow, R::of(2.0), close);
            singularity[i] = R::either(bent < near_wrist, one, close).store();
        }
    }
}

/// Fills the chain positions.
struct FindAngles<'a, T> {
    arm: &'a ThreeParallel,
    turns: &'a Planes<T, 12>,
    theta: &'a mut [Plane<T>],
}

impl<T: Float> Work<T> for FindAngles<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindAngles { arm, turns, theta } = self;
        let mut k = 0;
        while k < 6 {
            let (cos, sin, theta) = (&turns[2 * k], &turns[2 * k + 1], &mut theta[k]);
            for i in 0..BLOCK {
                R::step();
                theta[i] = atan2(R::load(sin[i]), R::load(cos[i])).store();
            }
            k += 1;
        }
        let (upper, fore) = (R::of(arm.upper_arm_at_zero), R::of(arm.forearm_at_zero));
        let bend = R::of(arm.bend_at_zero);
        let sense = |k: usize| R::of(arm.sense[k]);
        let senses = [sense(0), sense(1), sense(2), sense(3), sense(4), sense(5)];
        for i in 0..BLOCK {
            R::step();
            let phi2 = R::load(theta[1][i]) - upper;
            let forearm = R::load(theta[2][i]) - fore;
            theta[0][i] = (senses[0] * R::load(theta[0][i])).store();
            theta[1][i] = (senses[1] * phi2).store();
            theta[2][i] = (senses[2] * (forearm - phi2)).store();
            theta[3][i] = (senses[3] * (R::load(theta[3][i]) - forearm)).store();
            theta[4][i] = (senses[4] * (R::load(theta[4][i]) - bend)).store();
            theta[5][i] = (senses[5] * R::load(theta[5][i])).store();
        }
    }
}

//! Angles of torque curves in lanes: piecewise linear, without branches (`curves`).

use nalgebra::Vector3;

use crate::numbers::{BLOCK, Plane, Planes, Real};
use crate::robot::{JointCurve, TorqueCurve};

/// Most knots of a curve that lanes know: each costs a few operations for each load case.
const MOST_KNOTS: usize = 32;

/// Knots that one loop over the points adds; those that a curve lacks have no effect.
const KNOTS: usize = 2;

/// The curves of a joint.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct CurveConstants {
    /// Index of the drive of the joint.
    pub part: usize,
    rising: Angles,
    falling: Option<Angles>,
    /// Displacement by gravity at tool setting, m, base.
    pub reference: Vector3<f64>,
}

/// Angle over torque.
#[derive(Clone, Debug)]
struct Angles {
    /// rad, and rad/(N m) below the first knot.
    start: f64,
    slope: f64,
    /// Torque, N m, and by how much the slope grows there.
    knots: Vec<[[f64; 2]; KNOTS]>,
}

impl CurveConstants {
    /// For the drive `part`, which gravity displaces by `reference` (m, base) at tool setting; none if a curve has too
    /// many knots.
    pub fn of(curve: &JointCurve, part: usize, reference: Vector3<f64>) -> Option<CurveConstants> {
        Some(CurveConstants {
            part,
            rising: Angles::of(&curve.rising)?,
            falling: match &curve.falling {
                Some(falling) => Some(Angles::of(falling)?),
                None => None,
            },
            reference,
        })
    }
}

impl Angles {
    fn of(curve: &TorqueCurve) -> Option<Angles> {
        let pairs = curve.points();
        let slope = |[a, b]: [[f64; 2]; 2]| (b[1] - a[1]) / (b[0] - a[0]);
        let first = slope([pairs[0], pairs[1]]);
        let grows = |three: &[[f64; 2]]| {
            [
                three[1][0],
                slope([three[1], three[2]]) - slope([three[0], three[1]]),
            ]
        };
        let knots: Vec<[f64; 2]> = pairs.windows(3).map(grows).collect();
        let below = |[torque, by]: &[f64; 2]| by * (-torque).max(0.0);
        let some = |knots: &[[f64; 2]]| std::array::from_fn(|k| knots.get(k).copied().unwrap_or_default());
        (knots.len() <= MOST_KNOTS).then(|| Angles {
            start: -knots.iter().map(below).sum::<f64>(),
            slope: first,
            knots: knots.chunks(KNOTS).map(some).collect(),
        })
    }

    /// Fills the angles under these torques.
    #[inline(always)]
    fn fill<R: Real>(&self, torques: &Plane<R::Float>, angles: &mut Plane<R::Float>) {
        let (start, slope, zero) = (R::of(self.start), R::of(self.slope), R::of(0.0));
        for i in 0..BLOCK {
            R::step();
            angles[i] = slope.mul_add(R::load(torques[i]), start).store();
        }
        let mut n = 0;
        while n < self.knots.len() {
            let [[a, by_a], [b, by_b]] = self.knots[n];
            let (a, by_a, b, by_b) = (R::of(a), R::of(by_a), R::of(b), R::of(by_b));
            for i in 0..BLOCK {
                R::step();
                let torque = R::load(torques[i]);
                let angle = by_a.mul_add((torque - a).max(zero), R::load(angles[i]));
                angles[i] = by_b.mul_add((torque - b).max(zero), angle).store();
            }
            n += 1;
        }
    }
}

/// Fills the angles of the rising and the falling curve under these torques.
#[inline(always)]
pub(super) fn find_angles<R: Real>(
    curve: &CurveConstants,
    torques: &Plane<R::Float>,
    angles: &mut Planes<R::Float, 2>,
) {
    let [rising, falling] = angles;
    curve.rising.fill::<R>(torques, rising);
    match &curve.falling {
        Some(angles) => angles.fill::<R>(torques, falling),
        None => falling.clone_from(rising),
    }
}

/// Fills the rotations (rad) when the torques `change` are added to `before` (N m), under which the angles are `from`.
#[inline(always)]
pub(super) fn find_turns<R: Real>(
    curve: &CurveConstants,
    [before, change]: [&Plane<R::Float>; 2],
    from: &Planes<R::Float, 2>,
    turns: &mut Plane<R::Float>,
) {
    let zero = R::of(0.0);
    let mut torques = [R::Float::default(); BLOCK];
    for i in 0..BLOCK {
        R::step();
        torques[i] = (R::load(before[i]) + R::load(change[i])).store();
    }
    curve.rising.fill::<R>(&torques, turns);
    for i in 0..BLOCK {
        R::step();
        turns[i] = (R::load(turns[i]) - R::load(from[0][i])).store();
    }
    if let Some(falling) = &curve.falling {
        let mut angles = [R::Float::default(); BLOCK];
        falling.fill::<R>(&torques, &mut angles);
        for i in 0..BLOCK {
            R::step();
            let turn = R::load(angles[i]) - R::load(from[1][i]);
            turns[i] = R::either(R::load(change[i]) < zero, turn, R::load(turns[i])).store();
        }
    }
}

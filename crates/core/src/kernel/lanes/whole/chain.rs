//! Forward kinematics of any chain for a block of joint positions.

use nalgebra::{Matrix3, Vector3};

use crate::frame::Isometry;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put, sin_cos, vector};
use crate::robot::{Chain, Motion, Robot};

/// A frame in base at each point: its three axes, then its origin (m).
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(in crate::kernel::lanes) struct FramePlanes<T> {
    pub axes: [Planes<T, 3>; 3],
    pub origin: Planes<T, 3>,
}

impl<T: Float> FramePlanes<T> {
    /// Frames that are not yet known.
    pub fn unknown() -> FramePlanes<T> {
        FramePlanes {
            axes: [planes(), planes(), planes()],
            origin: planes(),
        }
    }
}

/// A chain with the conventions of its joints.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct ChainConstants {
    links: Vec<LinkConstants>,
    last: Displacement,
}

#[derive(Clone, Debug)]
struct LinkConstants {
    before: Displacement,
    /// Index of its axis, and whether it slides along it.
    axis: usize,
    slides: bool,
    sign: f64,
    zero: f64,
    /// Other joints whose positions are added, times their factor.
    coupling: Vec<(usize, f64)>,
}

/// A constant displacement; without rotation where the axes stay parallel.
#[derive(Clone, Debug)]
pub(in crate::kernel::lanes) struct Displacement {
    pub translation: Vector3<f64>,
    pub rotation: Option<Matrix3<f64>>,
}

impl Displacement {
    /// None.
    pub const NONE: Displacement = Displacement {
        translation: Vector3::new(0.0, 0.0, 0.0),
        rotation: None,
    };

    pub fn of(displacement: &Isometry) -> Displacement {
        let turns = displacement.rotation.imag() != Vector3::zeros();
        Displacement {
            translation: displacement.translation.vector,
            rotation: turns.then(|| displacement.rotation.to_rotation_matrix().into_inner()),
        }
    }
}

impl ChainConstants {
    pub fn of(robot: &Robot) -> ChainConstants {
        let mut constants = ChainConstants::without_conventions(robot.chain());
        for (link, joint) in constants.links.iter_mut().zip(robot.joints()) {
            link.sign = joint.sign.factor();
            link.zero = joint.zero_offset;
            link.coupling = joint.coupling.iter().map(|c| (c.joint, c.factor)).collect();
        }
        constants
    }

    /// For chain positions instead of joint positions.
    pub fn without_conventions(chain: &Chain) -> ChainConstants {
        let displacement = |(translation, rotation)| Displacement {
            translation,
            rotation,
        };
        let links = chain.links().iter().map(|link| {
            let (axis, slides) = match link.motion {
                Motion::Along(axis, _) => (axis.index(), true),
                Motion::About(axis, _) => (axis.index(), false),
            };
            LinkConstants {
                before: displacement(link.before.parts()),
                axis,
                slides,
                sign: 1.0,
                zero: 0.0,
                coupling: Vec::new(),
            }
        });
        ChainConstants {
            links: links.collect(),
            last: displacement(chain.last_joint_from_flange().parts()),
        }
    }

    /// Axis of joint `index` in its own frame: 0, 1, 2 for x, y, z; and whether it slides along it.
    pub fn axis(&self, index: usize) -> (usize, bool) {
        (self.links[index].axis, self.links[index].slides)
    }

    /// Position of joint `index` in its chain, rad (m).
    #[inline(always)]
    pub fn theta<R: Real>(&self, joints: &[Plane<R::Float>], index: usize) -> Plane<R::Float> {
        theta::<R>(&self.links[index], joints, index)
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.links.len()
    }
}

/// Fills the frames by [`crate::robot::Attachment::rank`] from joint positions (rad, m): base, every joint after its
/// motion, flange, and tool if there is room for it.
pub(in crate::kernel::lanes) struct FindFrames<'a, T> {
    pub chain: &'a ChainConstants,
    pub flange_from_tool: &'a Displacement,
    pub joints: &'a [Plane<T>],
    pub frames: &'a mut [FramePlanes<T>],
}

impl<T: Float> Work<T> for FindFrames<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        place_base::<R>(&mut self.frames[0]);
        let mut rank = 1;
        while rank < self.frames.len() {
            let (before, after) = self.frames.split_at_mut(rank);
            let tool = self.flange_from_tool;
            follow::<R, false>(
                (self.chain, tool),
                self.joints,
                rank,
                &before[rank - 1],
                &mut after[0],
            );
            rank += 1;
        }
    }
}

/// Fills the frame of the tool alone, with one more as memory.
pub(in crate::kernel::lanes) struct FindTool<'a, T> {
    pub chain: &'a ChainConstants,
    pub flange_from_tool: &'a Displacement,
    pub joints: &'a [Plane<T>],
    pub tool: &'a mut FramePlanes<T>,
    pub before: &'a mut FramePlanes<T>,
}

impl<T: Float> Work<T> for FindTool<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let last = self.chain.links.len() + 2;
        let chain = (self.chain, self.flange_from_tool);
        follow_to::<R, false>(chain, self.joints, last, [self.tool, self.before]);
    }
}

/// Fills the frame of the flange alone, to verify it, with one more as memory: two frames stay in the nearest cache,
/// those of all joints do not.
pub(in crate::kernel::lanes) struct FindFlange<'a, T> {
    pub chain: &'a ChainConstants,
    pub joints: &'a [Plane<T>],
    pub flange: &'a mut FramePlanes<T>,
    pub before: &'a mut FramePlanes<T>,
}

impl<T: Float> Work<T> for FindFlange<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let last = self.chain.links.len() + 1;
        let chain = (self.chain, &Displacement::NONE);
        follow_to::<R, true>(chain, self.joints, last, [self.flange, self.before]);
    }
}

/// Fills the first frame with that of rank `last`; the second is memory. `EXCHANGES`: see [`follow`].
#[inline(always)]
fn follow_to<R: Real, const EXCHANGES: bool>(
    chain: (&ChainConstants, &Displacement),
    joints: &[Plane<R::Float>],
    last: usize,
    [found, memory]: [&mut FramePlanes<R::Float>; 2],
) {
    // Such that the last one of the two in turn is the one to be found.
    let (mut before, mut after) = match last % 2 {
        0 => (found, memory),
        _ => (memory, found),
    };
    place_base::<R>(before);
    let mut rank = 1;
    while rank <= last {
        follow::<R, EXCHANGES>(chain, joints, rank, before, after);
        std::mem::swap(&mut before, &mut after);
        rank += 1;
    }
}

#[inline(always)]
fn place_base<R: Real>(base: &mut FramePlanes<R::Float>) {
    let (one, zero) = (R::of(1.0), R::of(0.0));
    for i in 0..BLOCK {
        R::step();
        put(&mut base.axes[0], i, Vector::new(one, zero, zero));
        put(&mut base.axes[1], i, Vector::new(zero, one, zero));
        put(&mut base.axes[2], i, Vector::new(zero, zero, one));
        put(&mut base.origin, i, Vector::new(zero, zero, zero));
    }
}

/// The frame of this rank after that before it. With `EXCHANGES` a rotation by quarter turns exchanges axes: it neglects
/// the rounding of its cosines, 6e-17, which a verification may.
#[inline(always)]
fn follow<R: Real, const EXCHANGES: bool>(
    (chain, flange_from_tool): (&ChainConstants, &Displacement),
    joints: &[Plane<R::Float>],
    rank: usize,
    before: &FramePlanes<R::Float>,
    after: &mut FramePlanes<R::Float>,
) {
    let Some(link) = chain.links.get(rank - 1) else {
        let by = if rank == chain.links.len() + 1 {
            &chain.last
        } else {
            flange_from_tool
        };
        translate::<R>(before, &by.translation, &mut after.origin);
        rotate::<R, EXCHANGES>(&before.axes, by.rotation.as_ref(), &mut after.axes);
        return;
    };
    translate::<R>(before, &link.before.translation, &mut after.origin);
    let theta = theta::<R>(link, joints, rank - 1);
    let rotation = link.before.rotation.as_ref();
    let (from, to) = (&before.axes, &mut after.axes);
    if !link.slides {
        match link.axis {
            0 => turn::<R, EXCHANGES, 0, 1, 2>(from, rotation, &theta, to),
            1 => turn::<R, EXCHANGES, 1, 2, 0>(from, rotation, &theta, to),
            _ => turn::<R, EXCHANGES, 2, 0, 1>(from, rotation, &theta, to),
        }
        return;
    }
    rotate::<R, EXCHANGES>(from, rotation, to);
    let axis = &after.axes[link.axis];
    for i in 0..BLOCK {
        R::step();
        let origin = vector::<R>(&after.origin, i);
        let moved = vector::<R>(axis, i).mul_add(R::load(theta[i]), origin);
        put(&mut after.origin, i, moved);
    }
}

/// The origin after a constant translation; most are along one axis.
#[inline(always)]
fn translate<R: Real>(before: &FramePlanes<R::Float>, by: &Vector3<f64>, origin: &mut Planes<R::Float, 3>) {
    let mut is_first = true;
    let mut k = 0;
    while k < 3 {
        let (axis, length) = (&before.axes[k], R::of(by[k]));
        if by[k] != 0.0 && is_first {
            for i in 0..BLOCK {
                R::step();
                let from = vector::<R>(&before.origin, i);
                put(origin, i, vector::<R>(axis, i).mul_add(length, from));
            }
            is_first = false;
        } else if by[k] != 0.0 {
            for i in 0..BLOCK {
                R::step();
                let so_far = vector::<R>(origin, i);
                put(origin, i, vector::<R>(axis, i).mul_add(length, so_far));
            }
        }
        k += 1;
    }
    if is_first {
        origin.clone_from(&before.origin);
    }
}

/// Entries of a rotation below this are rounding: cosines of quarter turns.
const ROUNDING: f64 = 1e-15;

/// For each column of a rotation by quarter turns the row that is not zero, and its sign.
type Exchange = [(usize, f64); 3];

const UNEXCHANGED: Exchange = [(0, 1.0), (1, 1.0), (2, 1.0)];

/// None for rotations that are not by quarter turns.
fn exchanged(rotation: &Matrix3<f64>) -> Option<Exchange> {
    let mut rows = UNEXCHANGED;
    for (k, row) in rows.iter_mut().enumerate() {
        let column = rotation.column(k);
        let largest = column.iamax();
        if (0..3).any(|other| other != largest && column[other].abs() >= ROUNDING) {
            return None;
        }
        *row = (largest, column[largest].signum());
    }
    Some(rows)
}

/// The axes after a constant rotation, if any.
#[inline(always)]
fn rotate<R: Real, const EXCHANGES: bool>(
    from: &[Planes<R::Float, 3>; 3],
    rotation: Option<&Matrix3<f64>>,
    to: &mut [Planes<R::Float, 3>; 3],
) {
    let Some(rotation) = rotation else {
        to.clone_from(from);
        return;
    };
    if EXCHANGES && let Some(rows) = exchanged(rotation) {
        let mut k = 0;
        while k < 3 {
            let ((row, sign), to) = (rows[k], &mut to[k]);
            let (axis, sign) = (&from[row], R::of(sign));
            for i in 0..BLOCK {
                R::step();
                put(to, i, vector::<R>(axis, i).scaled(sign));
            }
            k += 1;
        }
        return;
    }
    let columns = columns::<R>(rotation);
    for i in 0..BLOCK {
        R::step();
        let axes = axes::<R>(from, i);
        let mut k = 0;
        while k < 3 {
            put(&mut to[k], i, combined(&axes, &columns[k]));
            k += 1;
        }
    }
}

/// The axes after a constant rotation, if any, and a turn about axis `K` by `theta`, rad; `A` and `B` are the two after
/// it in turn.
#[inline(always)]
fn turn<R: Real, const EXCHANGES: bool, const K: usize, const A: usize, const B: usize>(
    from: &[Planes<R::Float, 3>; 3],
    rotation: Option<&Matrix3<f64>>,
    theta: &Plane<R::Float>,
    to: &mut [Planes<R::Float, 3>; 3],
) {
    let Some(rotation) = rotation else {
        return turn_exchanged::<R, K, A, B>(from, UNEXCHANGED, theta, to);
    };
    if EXCHANGES && let Some(rows) = exchanged(rotation) {
        return turn_exchanged::<R, K, A, B>(from, rows, theta, to);
    }
    let columns = columns::<R>(rotation);
    for i in 0..BLOCK {
        R::step();
        let (sin, cos) = sin_cos(R::load(theta[i]));
        let axes = axes::<R>(from, i);
        let first = combined(&axes, &columns[A]);
        let second = combined(&axes, &columns[B]);
        put(&mut to[A], i, second.mul_add(sin, first.scaled(cos)));
        put(&mut to[B], i, first.mul_add(-sin, second.scaled(cos)));
        put(&mut to[K], i, combined(&axes, &columns[K]));
    }
}

/// The same where the rotation exchanges axes.
#[inline(always)]
fn turn_exchanged<R: Real, const K: usize, const A: usize, const B: usize>(
    from: &[Planes<R::Float, 3>; 3],
    rows: Exchange,
    theta: &Plane<R::Float>,
    to: &mut [Planes<R::Float, 3>; 3],
) {
    let (along, first, second) = (&from[rows[K].0], &from[rows[A].0], &from[rows[B].0]);
    let sign = |row: usize| R::of(rows[row].1);
    let (sign_k, sign_a, sign_b) = (sign(K), sign(A), sign(B));
    for i in 0..BLOCK {
        R::step();
        let (sin, cos) = sin_cos(R::load(theta[i]));
        let (first, second) = (vector::<R>(first, i), vector::<R>(second, i));
        put(
            &mut to[A],
            i,
            second.mul_add(sin * sign_b, first.scaled(cos * sign_a)),
        );
        put(
            &mut to[B],
            i,
            first.mul_add(-sin * sign_a, second.scaled(cos * sign_b)),
        );
        put(&mut to[K], i, vector::<R>(along, i).scaled(sign_k));
    }
}

#[inline(always)]
fn columns<R: Real>(rotation: &Matrix3<f64>) -> [Vector<R>; 3] {
    std::array::from_fn(|k| Vector::of(&rotation.column(k).into_owned()))
}

#[inline(always)]
fn axes<R: Real>(from: &[Planes<R::Float, 3>; 3], i: usize) -> [Vector<R>; 3] {
    [vector(&from[0], i), vector(&from[1], i), vector(&from[2], i)]
}

/// The sum of the axes, each times its component.
#[inline(always)]
fn combined<R: Real>([x, y, z]: &[Vector<R>; 3], by: &Vector<R>) -> Vector<R> {
    x.mul_add(by.x, y.mul_add(by.y, z.scaled(by.z)))
}

#[inline(always)]
fn theta<R: Real>(link: &LinkConstants, joints: &[Plane<R::Float>], index: usize) -> Plane<R::Float> {
    let mut theta = joints[index];
    for (other, factor) in &link.coupling {
        let factor = R::of(*factor);
        for i in 0..BLOCK {
            R::step();
            theta[i] = R::load(joints[*other][i])
                .mul_add(factor, R::load(theta[i]))
                .store();
        }
    }
    let (sign, zero) = (R::of(link.sign), R::of(link.zero));
    for i in 0..BLOCK {
        R::step();
        theta[i] = R::load(theta[i]).mul_add(sign, zero).store();
    }
    theta
}

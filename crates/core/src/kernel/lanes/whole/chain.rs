//! Forward kinematics of any chain for a block of joint positions.

use nalgebra::{Matrix3, Vector3};

use crate::frame::Isometry;
use crate::kernel::lanes::numbers::{
    BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put, sin_cos, vector,
};
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
        let FindFrames {
            chain,
            flange_from_tool,
            joints,
            frames,
        } = self;
        let (one, zero) = (R::of(1.0), R::of(0.0));
        let base = &mut frames[0];
        for i in 0..BLOCK {
            R::step();
            put(&mut base.axes[0], i, Vector::new(one, zero, zero));
            put(&mut base.axes[1], i, Vector::new(zero, one, zero));
            put(&mut base.axes[2], i, Vector::new(zero, zero, one));
            put(&mut base.origin, i, Vector::new(zero, zero, zero));
        }
        let count = chain.links.len();
        let mut rank = 1;
        while rank < frames.len() {
            let (before, after) = frames.split_at_mut(rank);
            let (before, frame) = (&before[rank - 1], &mut after[0]);
            if rank <= count {
                let link = &chain.links[rank - 1];
                displace::<R>(before, &link.before, frame);
                turn::<R>(frame, link, joints, rank - 1);
            } else if rank == count + 1 {
                displace::<R>(before, &chain.last, frame);
            } else {
                displace::<R>(before, flange_from_tool, frame);
            }
            rank += 1;
        }
    }
}

/// Writes the frame that a constant displacement leads to.
#[inline(always)]
fn displace<R: Real>(before: &FramePlanes<R::Float>, by: &Displacement, after: &mut FramePlanes<R::Float>) {
    let t = Vector::<R>::of(&by.translation);
    let Some(rotation) = &by.rotation else {
        for i in 0..BLOCK {
            R::step();
            let x = vector::<R>(&before.axes[0], i);
            let y = vector::<R>(&before.axes[1], i);
            let z = vector::<R>(&before.axes[2], i);
            let origin = vector::<R>(&before.origin, i);
            let origin = x.mul_add(t.x, y.mul_add(t.y, z.mul_add(t.z, origin)));
            put(&mut after.axes[0], i, x);
            put(&mut after.axes[1], i, y);
            put(&mut after.axes[2], i, z);
            put(&mut after.origin, i, origin);
        }
        return;
    };
    let columns = [
        Vector::<R>::of(&rotation.column(0).into_owned()),
        Vector::<R>::of(&rotation.column(1).into_owned()),
        Vector::<R>::of(&rotation.column(2).into_owned()),
    ];
    for i in 0..BLOCK {
        R::step();
        let x = vector::<R>(&before.axes[0], i);
        let y = vector::<R>(&before.axes[1], i);
        let z = vector::<R>(&before.axes[2], i);
        let origin = vector::<R>(&before.origin, i);
        let origin = x.mul_add(t.x, y.mul_add(t.y, z.mul_add(t.z, origin)));
        put(&mut after.axes[0], i, turned(&columns[0], x, y, z));
        put(&mut after.axes[1], i, turned(&columns[1], x, y, z));
        put(&mut after.axes[2], i, turned(&columns[2], x, y, z));
        put(&mut after.origin, i, origin);
    }
}

#[inline(always)]
fn turned<R: Real>(column: &Vector<R>, x: Vector<R>, y: Vector<R>, z: Vector<R>) -> Vector<R> {
    x.mul_add(column.x, y.mul_add(column.y, z.scaled(column.z)))
}

/// Applies the motion of joint `index`.
#[inline(always)]
fn turn<R: Real>(
    frame: &mut FramePlanes<R::Float>,
    link: &LinkConstants,
    joints: &[Plane<R::Float>],
    index: usize,
) {
    let theta = theta::<R>(link, joints, index);
    // With constant planes the compiler knows that they do not overlap.
    match (link.slides, link.axis) {
        (true, 0) => slide::<R, 0>(frame, &theta),
        (true, 1) => slide::<R, 1>(frame, &theta),
        (true, _) => slide::<R, 2>(frame, &theta),
        (false, axis) => {
            let (mut sines, mut cosines) = (theta, theta);
            for i in 0..BLOCK {
                R::step();
                let (sin, cos) = sin_cos(R::load(theta[i]));
                (sines[i], cosines[i]) = (sin.store(), cos.store());
            }
            match axis {
                0 => rotate::<R, 1, 2>(frame, &sines, &cosines),
                1 => rotate::<R, 2, 0>(frame, &sines, &cosines),
                _ => rotate::<R, 0, 1>(frame, &sines, &cosines),
            }
        }
    }
}

/// Moves the frame along its axis `A`.
#[inline(always)]
fn slide<R: Real, const A: usize>(frame: &mut FramePlanes<R::Float>, by: &Plane<R::Float>) {
    for i in 0..BLOCK {
        R::step();
        let (axis, origin) = (vector::<R>(&frame.axes[A], i), vector::<R>(&frame.origin, i));
        put(&mut frame.origin, i, axis.mul_add(R::load(by[i]), origin));
    }
}

/// Turns axis `A` towards axis `B`.
#[inline(always)]
fn rotate<R: Real, const A: usize, const B: usize>(
    frame: &mut FramePlanes<R::Float>,
    sines: &Plane<R::Float>,
    cosines: &Plane<R::Float>,
) {
    for i in 0..BLOCK {
        R::step();
        let (sin, cos) = (R::load(sines[i]), R::load(cosines[i]));
        let (first, second) = (vector::<R>(&frame.axes[A], i), vector::<R>(&frame.axes[B], i));
        put(&mut frame.axes[A], i, second.mul_add(sin, first.scaled(cos)));
        put(&mut frame.axes[B], i, first.mul_add(-sin, second.scaled(cos)));
    }
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

//! Forward kinematics of any chain for a block of joint positions.

use nalgebra::{Matrix3, Vector3};

use crate::frame::Isometry;
use crate::numbers::{BLOCK, Float, Plane, Planes, Real, Vector, Work, planes, put, sin_cos, vector};
use crate::robot::{Motion, Robot};

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
        let displacement = |(translation, rotation)| Displacement {
            translation,
            rotation,
        };
        let chain = robot.chain();
        let links = chain.links().iter().zip(robot.joints()).map(|(link, joint)| {
            let (axis, slides) = match link.motion {
                Motion::Along(axis, _) => (axis.index(), true),
                Motion::About(axis, _) => (axis.index(), false),
            };
            LinkConstants {
                before: displacement(link.before.parts()),
                axis,
                slides,
                sign: joint.sign.factor(),
                zero: joint.zero_offset,
                coupling: joint.coupling.iter().map(|c| (c.joint, c.factor)).collect(),
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

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.links.len()
    }
}

/// Fills the frames by [`crate::robot::Attachment::rank`] from joint positions (rad, m): base, every joint after its
/// motion, flange, tool.
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
        while rank < count + 3 {
            let (before, after) = frames.split_at_mut(rank);
            let frame = &mut after[0];
            frame.clone_from(&before[rank - 1]);
            if rank <= count {
                let link = &chain.links[rank - 1];
                advance::<R>(frame, &link.before);
                turn::<R>(frame, link, joints, rank - 1);
            } else if rank == count + 1 {
                advance::<R>(frame, &chain.last);
            } else {
                advance::<R>(frame, flange_from_tool);
            }
            rank += 1;
        }
    }
}

/// Applies a constant displacement.
#[inline(always)]
pub(in crate::kernel::lanes) fn advance<R: Real>(frame: &mut FramePlanes<R::Float>, by: &Displacement) {
    let t = Vector::<R>::of(&by.translation);
    for i in 0..BLOCK {
        R::step();
        let x = vector::<R>(&frame.axes[0], i);
        let y = vector::<R>(&frame.axes[1], i);
        let z = vector::<R>(&frame.axes[2], i);
        let origin = vector::<R>(&frame.origin, i);
        put(
            &mut frame.origin,
            i,
            x.mul_add(t.x, y.mul_add(t.y, z.mul_add(t.z, origin))),
        );
    }
    let Some(rotation) = &by.rotation else { return };
    let columns = [
        Vector::<R>::of(&rotation.column(0).into_owned()),
        Vector::<R>::of(&rotation.column(1).into_owned()),
        Vector::<R>::of(&rotation.column(2).into_owned()),
    ];
    for i in 0..BLOCK {
        R::step();
        let x = vector::<R>(&frame.axes[0], i);
        let y = vector::<R>(&frame.axes[1], i);
        let z = vector::<R>(&frame.axes[2], i);
        let mut k = 0;
        while k < 3 {
            let column = columns[k];
            put(
                &mut frame.axes[k],
                i,
                x.mul_add(column.x, y.mul_add(column.y, z.scaled(column.z))),
            );
            k += 1;
        }
    }
}

/// Applies the motion of joint `index`.
#[inline(always)]
fn turn<R: Real>(
    frame: &mut FramePlanes<R::Float>,
    link: &LinkConstants,
    joints: &[Plane<R::Float>],
    index: usize,
) {
    let mut theta = [<R::Float as Default>::default(); BLOCK];
    let (sign, zero) = (R::of(link.sign), R::of(link.zero));
    for i in 0..BLOCK {
        R::step();
        theta[i] = R::load(joints[index][i]).store();
    }
    for (other, factor) in &link.coupling {
        let factor = R::of(*factor);
        for i in 0..BLOCK {
            R::step();
            theta[i] = R::load(joints[*other][i])
                .mul_add(factor, R::load(theta[i]))
                .store();
        }
    }
    let (a, b) = ((link.axis + 1) % 3, (link.axis + 2) % 3);
    for i in 0..BLOCK {
        R::step();
        let theta = R::load(theta[i]).mul_add(sign, zero);
        if link.slides {
            let axis = vector::<R>(&frame.axes[link.axis], i);
            let origin = vector::<R>(&frame.origin, i);
            put(&mut frame.origin, i, axis.mul_add(theta, origin));
        } else {
            let (sin, cos) = sin_cos(theta);
            let first = vector::<R>(&frame.axes[a], i);
            let second = vector::<R>(&frame.axes[b], i);
            put(&mut frame.axes[a], i, second.mul_add(sin, first.scaled(cos)));
            put(&mut frame.axes[b], i, first.mul_add(-sin, second.scaled(cos)));
        }
    }
}

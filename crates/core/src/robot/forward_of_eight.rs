//! Forward kinematics of eight postures at once, one lane each.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Vector3};

use super::chain::Chain;
use super::frame_in_lanes::{FrameInLanes, advance, base, displace};
use super::jacobian::screw_at;
use super::joint::Joint;
use super::model::Robot;
use crate::numbers::{Eight, Lanes, Real};
use crate::spatial::Twist;

/// The axis of a joint of each posture, in base: its unit direction, then a point on it (m).
type AxisOfEight = [[Eight; 3]; 2];

/// Most joints of an arm whose postures are eight at most: one of seven is fixed.
pub(super) const MOST_JOINTS: usize = 7;

/// Joint positions (rad, m) of eight postures of an arm, perhaps on a rail.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointsOfEight<'a> {
    /// Those of the rail, the same for all.
    pub rail: &'a [f64],
    /// Those of the arm; the first of them where the others are not known yet.
    pub arm: &'a [Eight],
}

impl JointsOfEight<'_> {
    /// Positions of joint `index`.
    #[inline(always)]
    pub fn at(&self, index: usize) -> Eight {
        match index.checked_sub(self.rail.len()) {
            Some(index) => self.arm[index],
            None => Lanes([self.rail[index]; 8]),
        }
    }

    /// What earlier joints add to the position of `joint`.
    #[inline(always)]
    pub fn coupled<R: Real<Float = f64>>(&self, joint: &Joint) -> Eight {
        let mut sum = Eight::default();
        for coupling in &joint.coupling {
            sum.add::<R>(coupling.factor, &self.at(coupling.joint));
        }
        sum
    }
}

/// Forward kinematics of eight postures: the axes of their joints, and their flanges.
#[derive(Clone, Debug)]
pub(super) struct ForwardOfEight {
    rail: Vec<AxisOfEight>,
    /// Those of an arm with fewer joints come first.
    arm: [AxisOfEight; MOST_JOINTS],
    flange: FrameInLanes<8>,
}

impl ForwardOfEight {
    /// Working memory for an arm on this many joints of a rail.
    pub fn with_rail(joints: usize) -> ForwardOfEight {
        ForwardOfEight {
            rail: vec![AxisOfEight::default(); joints],
            arm: [AxisOfEight::default(); MOST_JOINTS],
            flange: FrameInLanes::<8>::default(),
        }
    }

    /// The flanges: three axes and the origin.
    pub fn flange(&self) -> &[[Eight; 3]; 4] {
        &self.flange
    }

    /// The axes of the first `joints` joints of the arm.
    pub fn axes_of_arm(&self, joints: usize) -> &[[[Eight; 3]; 2]] {
        &self.arm[..joints]
    }

    /// The flange of posture `lane`, in base.
    pub fn flange_of(&self, lane: usize) -> IsometryMatrix3<f64> {
        let [x, y, z, origin] = &self.flange;
        let axes = Matrix3::from_columns(&[of(x, lane), of(y, lane), of(z, lane)]);
        IsometryMatrix3::from_parts(of(origin, lane).into(), Rotation3::from_matrix_unchecked(axes))
    }

    /// Screw of every joint of posture `lane` at `tcp` (m, base), per unit of chain position.
    pub fn screws(&self, chain: &Chain, lane: usize, tcp: &Point3<f64>) -> Vec<Twist> {
        let mut screws = vec![Twist::ZERO; chain.links().len()];
        let axes = self.rail.iter().chain(&self.arm);
        for ((screw, link), [z, origin]) in screws.iter_mut().zip(chain.links()).zip(axes) {
            *screw = screw_at(&link.motion, of(z, lane), &of(origin, lane).into(), tcp);
        }
        screws
    }

    /// The axes and flanges of `robot` at these joint positions.
    #[inline(always)]
    pub fn find<R: Real<Float = f64>>(&mut self, robot: &Robot, joints: JointsOfEight<'_>) {
        let chain = robot.chain();
        // Apart from what is stored: so short a loop is vectorised only where its results cannot overlap what it reads.
        let mut frame = base();
        let axes = self.rail.iter_mut().chain(&mut self.arm);
        for (index, (link, found)) in chain.links().iter().zip(axes).enumerate() {
            let theta = theta_of::<R>(robot, index, joints);
            advance::<R, _>(&link.before, &mut frame);
            let axis = displace::<R, _>(&link.motion, &theta, &mut frame);
            *found = [frame[axis.index()], frame[3]];
        }
        advance::<R, _>(chain.last_joint_from_flange(), &mut frame);
        self.flange = frame;
    }
}

/// The vector of posture `lane`.
fn of([x, y, z]: &[Eight; 3], lane: usize) -> Vector3<f64> {
    Vector3::new(x.0[lane], y.0[lane], z.0[lane])
}

/// [`Robot::theta`] of eight postures.
#[inline(always)]
fn theta_of<R: Real<Float = f64>>(robot: &Robot, index: usize, joints: JointsOfEight<'_>) -> Eight {
    let joint = &robot.joints()[index];
    let (q, coupled) = (joints.at(index), joints.coupled::<R>(joint));
    let (sign, zero) = (R::of(joint.sign.factor()), R::of(joint.zero_offset));
    let mut theta = Eight::default();
    for i in 0..8 {
        R::step();
        theta.set(i, sign.mul_add(q.at::<R>(i) + coupled.at(i), zero));
    }
    theta
}

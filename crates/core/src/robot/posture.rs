//! Postures: the joint configurations of one tool pose, and their names.

use std::fmt;

use super::branch::Branch;
use crate::frame::Isometry;
use crate::spatial::Twist;

/// One posture of the arm at a tool pose.
#[derive(Clone, Debug)]
pub struct Posture {
    /// Its name.
    pub name: PostureName,
    /// Joint positions `q`, rad (m), controller coordinates.
    pub joints: Vec<f64>,
    /// The tool, in base.
    pub base_from_tool: Isometry,
    /// Screw of every joint at the TCP, base basis, per unit of chain position.
    pub screws: Vec<Twist>,
    /// The singularity that it is near, if any.
    pub singularity: Option<Singularity>,
}

/// The name that distinguishes a posture from the others of its pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PostureName {
    /// One of eight branches.
    Branch(Branch),
    /// For a chain without named branches: the side of the middle of its range, for each joint.
    Sides(Sides),
}

impl PostureName {
    /// The branch, if it is one.
    pub fn branch(self) -> Option<Branch> {
        match self {
            PostureName::Branch(branch) => Some(branch),
            PostureName::Sides(_) => None,
        }
    }
}

impl fmt::Display for PostureName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PostureName::Branch(branch) => branch.fmt(f),
            PostureName::Sides(sides) => sides.fmt(f),
        }
    }
}

/// For each joint, base to flange, whether it is at or above (`+`) or below (`-`) the middle of its range.
///
/// It depends only on the joint positions. Two postures of one pose nearly always differ in it, but need not.
/// Joints beyond the thirty-second are ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sides {
    joints: u8,
    above: u32,
}

impl Sides {
    /// The sides of these joint positions (rad, m) from the middles of the ranges.
    pub fn of(joints: &[f64], middles: &[f64]) -> Sides {
        let bits = joints.iter().zip(middles).take(32);
        Sides {
            joints: bits.len() as u8,
            above: bits
                .enumerate()
                .map(|(i, (q, middle))| u32::from(q >= middle) << i)
                .sum(),
        }
    }
}

impl fmt::Display for Sides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = |i: u8| if self.above >> i & 1 == 1 { '+' } else { '-' };
        f.write_str(&(0..self.joints).map(sign).collect::<String>())
    }
}

/// A singularity: one or two joints lose their effect. The posture is valid, its neighbours are far away in
/// joint space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// Wrist centre near the first axis.
    Shoulder,
    /// Arm stretched or folded.
    Elbow,
    /// Axes 4 and 6 in line; parallel, of an arm with three parallel axes.
    Wrist,
    /// Some joints are nearly dependent: for a chain without named singularities.
    Dependent,
}

impl Singularity {
    /// One word for tables.
    pub fn word(self) -> &'static str {
        match self {
            Singularity::Shoulder => "shoulder",
            Singularity::Elbow => "elbow",
            Singularity::Wrist => "wrist",
            Singularity::Dependent => "dependent",
        }
    }
}

impl fmt::Display for Singularity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Singularity::Shoulder => "shoulder: wrist centre near the first axis",
            Singularity::Elbow => "elbow: arm stretched or folded",
            Singularity::Wrist => "wrist: axes 4 and 6 nearly in line",
            Singularity::Dependent => "dependent: some joints have nearly the same effect",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_state_for_each_joint_whether_it_is_above_the_middle() {
        let middles = [0.5, 0.0, -1.0, 2.0];
        assert_eq!(Sides::of(&[0.5, -0.1, 3.0, 1.9], &middles).to_string(), "+-+-");
        assert_eq!(Sides::of(&[], &[]).to_string(), "");
        assert_eq!(Sides::default(), Sides::of(&[], &[]));
    }

    #[test]
    fn sides_of_joints_beyond_the_thirty_second_are_ignored() {
        let (mut joints, middles) = (vec![1.0; 40], vec![0.0; 40]);
        let all = Sides::of(&joints, &middles);
        assert_eq!(all.to_string(), "+".repeat(32));
        joints[32] = -1.0;
        assert_eq!(Sides::of(&joints, &middles), all);
        joints[31] = -1.0;
        assert_eq!(Sides::of(&joints, &middles).to_string(), "+".repeat(31) + "-");
    }

    #[test]
    fn different_sides_have_different_names() {
        let names: Vec<Sides> = (0..64)
            .map(|bits: u32| {
                let joints: Vec<f64> = (0..6).map(|i| f64::from(bits >> i & 1)).collect();
                Sides::of(&joints, &[0.5; 6])
            })
            .collect();
        for (i, a) in names.iter().enumerate() {
            for b in &names[..i] {
                assert!(a != b && a.to_string() != b.to_string());
            }
        }
    }

    #[test]
    fn a_posture_is_named_by_its_branch_or_by_its_sides() {
        let sides = Sides::of(&[1.0, -1.0], &[0.0, 0.0]);
        assert_eq!(PostureName::Sides(sides).to_string(), "+-");
        assert_eq!(PostureName::Sides(sides).branch(), None);
        for branch in Branch::ALL {
            assert_eq!(PostureName::Branch(branch).to_string(), branch.to_string());
            assert_eq!(PostureName::Branch(branch).branch(), Some(branch));
        }
    }

    #[test]
    fn the_sentence_of_every_singularity_begins_with_its_word() {
        let all = [
            Singularity::Shoulder,
            Singularity::Elbow,
            Singularity::Wrist,
            Singularity::Dependent,
        ];
        for (i, singularity) in all.iter().enumerate() {
            assert!(
                singularity
                    .to_string()
                    .starts_with(&format!("{}: ", singularity.word()))
            );
            assert!(all[..i].iter().all(|other| other.word() != singularity.word()));
        }
    }
}

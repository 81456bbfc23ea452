//! The yardstick: a straightforward implementation for this arm in plain Rust, with sines, cosines and arctangents; no
//! allocation, one pose at a time, no verification.
//!
//! Inverse by the OPW formulas, forward by sines and cosines of the joint angles, then the sums over joints:
//!
//! ```text
//! v_i = z_i x (TCP - o_i)      delta = sum c_i v_i (v_i . F)      C = sum c_i [v_i; z_i] [v_i; z_i]^T
//! ```
//!
//! Angles `theta` are in the OPW convention, rad; `joints` as shown by the controller. Branches are ordered
//! front up, front down, back up, back down, each followed by its flip; angles of a branch out of reach are NaN.
//!
//! Source: Brandstoetter, Angerer, Hofbaur 2014.

use std::f64::consts::PI;

use crate::workload::{A1, A2, C1, C2, C3, C4, COMPLIANCE, FORCES, NORMAL, OFFSETS, Pose, SIGNS, TOOL};

type Vector = [f64; 3];

/// Joint axis and its velocity of the TCP, one a joint.
type Screw = (Vector, Vector);

/// Largest in-plane deviation (m) of the four forces, front elbow-up.
pub fn dev(pose: &Pose) -> f64 {
    largest_in_plane(&screws(&front_up(pose)))
}

/// The same for every branch; NaN out of reach.
pub fn dev8(pose: &Pose) -> [f64; 8] {
    thetas(pose).map(|theta| largest_in_plane(&screws(&theta)))
}

/// Compliance at the TCP, displacement before rotation, front elbow-up.
pub fn c66(pose: &Pose) -> [f64; 36] {
    compliance(&screws(&front_up(pose)))
}

/// Joint positions of every branch, rad; NaN out of reach.
pub fn ik8(pose: &Pose) -> [[f64; 6]; 8] {
    thetas(pose).map(|theta| joints_of(&theta))
}

/// Joint positions of front elbow-up no-flip, rad.
pub fn joints(pose: &Pose) -> [f64; 6] {
    joints_of(&front_up(pose))
}

/// [`dev`] of joint positions.
pub fn dev_at(joints: &[f64; 6]) -> f64 {
    largest_in_plane(&screws(&theta_of(joints)))
}

/// [`c66`] of joint positions.
pub fn c66_at(joints: &[f64; 6]) -> [f64; 36] {
    compliance(&screws(&theta_of(joints)))
}

fn joints_of(theta: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|i| (theta[i] + OFFSETS[i]) * SIGNS[i])
}

fn theta_of(joints: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|i| joints[i] * SIGNS[i] - OFFSETS[i])
}

/// Wrist centre of a pose.
fn wrist_centre(pose: &Pose) -> Vector {
    let back = TOOL + C4;
    [
        pose[3] - back * pose[2],
        pose[7] - back * pose[6],
        pose[11] - back * pose[10],
    ]
}

/// Angles of the branch front elbow-up no-flip alone.
fn front_up(pose: &Pose) -> [f64; 6] {
    let [x, y, z] = wrist_centre(pose);
    let arm = two_link((x * x + y * y).sqrt() - A1, z - C1);
    wrist(pose, [y.atan2(x), arm[0].0, arm[0].1])
}

/// Angles of all branches.
fn thetas(pose: &Pose) -> [[f64; 6]; 8] {
    let [x, y, z] = wrist_centre(pose);
    let (r, turn) = ((x * x + y * y).sqrt(), y.atan2(x));
    let front = two_link(r - A1, z - C1);
    // Behind the first axis the arm is its own mirror image: which of the two is up, changes.
    let back = two_link(-r - A1, z - C1);
    let behind = if turn > 0.0 { turn - PI } else { turn + PI };
    let arms = [
        [turn, front[0].0, front[0].1],
        [turn, front[1].0, front[1].1],
        [behind, back[1].0, back[1].1],
        [behind, back[0].0, back[0].1],
    ];
    let mut all = [[0.0; 6]; 8];
    for (arm, pair) in arms.into_iter().zip(all.chunks_exact_mut(2)) {
        pair[0] = wrist(pose, arm);
        let [t1, t2, t3, t4, t5, t6] = pair[0];
        pair[1] = [t1, t2, t3, t4 + PI, -t5, t6 - PI];
    }
    all
}

/// Angles 2 and 3 that bring the wrist centre to (`u`, `v`) from axis 2; first the one bent forwards.
fn two_link(u: f64, v: f64) -> [(f64, f64); 2] {
    let forearm_squared = A2 * A2 + C3 * C3;
    let forearm = forearm_squared.sqrt();
    let squared = u * u + v * v;
    let at_shoulder = ((squared + C2 * C2 - forearm_squared) / (2.0 * squared.sqrt() * C2)).acos();
    let at_elbow = ((squared - C2 * C2 - forearm_squared) / (2.0 * C2 * forearm)).acos();
    let (lift, crank) = (u.atan2(v), A2.atan2(C3));
    [
        (lift - at_shoulder, at_elbow - crank),
        (lift + at_shoulder, -at_elbow - crank),
    ]
}

/// Angles 4 to 6 after the first three, no-flip.
fn wrist(pose: &Pose, [t1, t2, t3]: [f64; 3]) -> [f64; 6] {
    let [e11, e12, e13, _, e21, e22, e23, _, e31, e32, e33, _] = *pose;
    let ((s1, c1), (s23, c23)) = (t1.sin_cos(), (t2 + t3).sin_cos());
    let along = e13 * s23 * c1 + e23 * s23 * s1 + e33 * c23;
    let t4 = (e23 * c1 - e13 * s1).atan2(e13 * c23 * c1 + e23 * c23 * s1 - e33 * s23);
    let t5 = (1.0 - along * along).sqrt().atan2(along);
    let t6 =
        (e12 * s23 * c1 + e22 * s23 * s1 + e32 * c23).atan2(-e11 * s23 * c1 - e21 * s23 * s1 - e31 * c23);
    [t1, t2, t3, t4, t5, t6]
}

/// Forward: positions of the joint axes relative to the TCP.
fn screws(theta: &[f64; 6]) -> [Screw; 6] {
    let [(s1, c1), (s2, c2)] = [theta[0], theta[1]].map(f64::sin_cos);
    let (s23, c23) = (theta[1] + theta[2]).sin_cos();
    let [(s4, c4), (s5, c5)] = [theta[3], theta[4]].map(f64::sin_cos);
    // The forearm's own axes: across in the arm's plane, along axis 3, along the forearm.
    let across = [c23 * c1, c23 * s1, -s23];
    let side = [-s1, c1, 0.0];
    let along = [s23 * c1, s23 * s1, c23];
    let z5: Vector = std::array::from_fn(|i| c4 * side[i] - s4 * across[i]);
    let z6: Vector = std::array::from_fn(|i| s5 * (c4 * across[i] + s4 * side[i]) + c5 * along[i]);

    let shoulder = [A1 * c1, A1 * s1, C1];
    let elbow = add(shoulder, [C2 * s2 * c1, C2 * s2 * s1, C2 * c2]);
    let centre: Vector = std::array::from_fn(|i| elbow[i] + A2 * across[i] + C3 * along[i]);
    let tcp: Vector = std::array::from_fn(|i| centre[i] + (C4 + TOOL) * z6[i]);
    [
        screw([0.0, 0.0, 1.0], [0.0, 0.0, C1], tcp),
        screw(side, shoulder, tcp),
        screw(side, elbow, tcp),
        screw(along, centre, tcp),
        screw(z5, centre, tcp),
        screw(z6, centre, tcp),
    ]
}

fn screw(axis: Vector, on_axis: Vector, tcp: Vector) -> Screw {
    (axis, cross(axis, sub(tcp, on_axis)))
}

fn largest_in_plane(screws: &[Screw; 6]) -> f64 {
    let mut largest = 0.0;
    for force in FORCES {
        let mut delta = [0.0; 3];
        for ((_, v), c) in screws.iter().zip(COMPLIANCE) {
            let turn = c * dot(*v, force);
            delta = std::array::from_fn(|i| delta[i] + turn * v[i]);
        }
        let out = dot(delta, NORMAL);
        let in_plane: Vector = std::array::from_fn(|i| delta[i] - out * NORMAL[i]);
        let length = dot(in_plane, in_plane).sqrt();
        // Not `max`, which would turn the NaN of a branch out of reach into a number.
        largest = if length <= largest { largest } else { length };
    }
    largest
}

fn compliance(screws: &[Screw; 6]) -> [f64; 36] {
    let mut sum = [0.0; 36];
    for ((z, v), c) in screws.iter().zip(COMPLIANCE) {
        let s = [v[0], v[1], v[2], z[0], z[1], z[2]];
        for row in 0..6 {
            for column in row..6 {
                sum[6 * row + column] += c * s[row] * s[column];
            }
        }
    }
    for row in 1..6 {
        for column in 0..row {
            sum[6 * row + column] = sum[6 * column + row];
        }
    }
    sum
}

fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

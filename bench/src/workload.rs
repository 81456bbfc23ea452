//! The arm, the poses and the loads that every candidate works on.
//!
//! Yaskawa MH12 with a tool of 150 mm, the tool axis horizontal (+x) and the TCP on the plane x = 1 m, as in
//! milling a vertical plate. Poses whose wrist centre is out of reach are left out, joint limits are neglected. Lengths
//! m, angles rad.
//!
//! | symbol | meaning |
//! |---|---|
//! | `a1`, `c1` | axis 2 before axis 1; above the floor |
//! | `l2` | upper arm, axis 2 to axis 3 |
//! | `a2`, `c3` | wrist centre seen from axis 3: across (negative: to the back) and along the forearm |
//! | `c4` | flange beyond the wrist centre |
//!
//! Source: ros-industrial/motoman, `opw_parameters_mh12.yaml`; compliances of Shneor & Chapsky 2021, section 3.4.

/// Axis 2 before axis 1, m.
pub const A1: f64 = 0.155;
/// Wrist centre behind the forearm's line, m; negative as in the OPW convention.
pub const A2: f64 = -0.200;
/// Axis 2 above the floor, m.
pub const C1: f64 = 0.450;
/// Axis 2 to axis 3, m.
pub const C2: f64 = 0.614;
/// Axis 3 to the wrist centre, along the forearm, m.
pub const C3: f64 = 0.640;
/// Wrist centre to flange, m.
pub const C4: f64 = 0.100;
/// Flange to TCP, along the flange's z, m.
pub const TOOL: f64 = 0.150;
/// Zero of each joint in the OPW convention, rad.
pub const OFFSETS: [f64; 6] = {
    use std::f64::consts::{FRAC_PI_2, PI};
    [0.0, 0.0, -FRAC_PI_2, 0.0, 0.0, PI]
};
/// Sense of each joint in the OPW convention.
pub const SIGNS: [f64; 6] = [1.0, 1.0, -1.0, -1.0, -1.0, -1.0];
/// Compliance of each joint, rad/(N m).
pub const COMPLIANCE: [f64; 6] = [2.1e-6, 2.5e-6, 4.0e-5, 6.0e-5, 6.0e-5, 8.0e-5];
/// Outward normal of the plane: towards the robot.
pub const NORMAL: [f64; 3] = [-1.0, 0.0, 0.0];
/// Forces on the tool at the TCP, base, N.
pub const FORCES: [[f64; 3]; 4] = [
    [3.0, -5.0, -5.0],
    [3.0, -5.0, 5.0],
    [3.0, 5.0, -5.0],
    [3.0, 5.0, 5.0],
];
/// How many poses.
pub const COUNT: usize = 200_000;

/// `base_from_tool`, 3 x 4, row by row.
pub type Pose = [f64; 12];

/// x of the plane, m.
const PLANE: f64 = 1.0;
/// Where y and z of the TCP are drawn from, m.
const Y: [f64; 2] = [-0.7, 0.7];
const Z: [f64; 2] = [0.2, 1.5];
const SEED: u64 = 20_260_101;

/// `count` poses within reach of the front elbow-up branch; always the same ones.
pub fn poses(count: usize) -> Vec<Pose> {
    let mut random = SplitMix { state: SEED };
    let mut within = |[low, high]: [f64; 2]| low + (high - low) * random.unit();
    let mut poses = Vec::with_capacity(count);
    while poses.len() < count {
        let (y, z) = (within(Y), within(Z));
        if reached(y, z) {
            poses.push([
                0.0, 0.0, 1.0, PLANE, //
                0.0, 1.0, 0.0, y, //
                -1.0, 0.0, 0.0, z,
            ]);
        }
    }
    poses
}

/// Whether the front of the arm reaches the wrist centre of the TCP (`PLANE`, `y`, `z`).
fn reached(y: f64, z: f64) -> bool {
    let r = (PLANE - TOOL - C4).hypot(y);
    let (distance, forearm) = ((r - A1).hypot(z - C1), A2.hypot(C3));
    // A micrometre short of the ends: there the elbow is singular and rounding decides.
    distance < C2 + forearm - 1e-6 && distance > (C2 - forearm).abs() + 1e-6
}

/// `SplitMix64`: seeded, tiny, good enough to scatter points. Source: Steele, Lea, Flood 2014.
struct SplitMix {
    state: u64,
}

impl SplitMix {
    /// Uniform in [0, 1).
    fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        // 53 bits: the mantissa of a double.
        (z >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_the_same_every_time_and_spread_over_the_plane() {
        let (few, more) = (poses(100), poses(1000));
        assert_eq!(few, more[..100]);
        let mean = more.iter().map(|pose| pose[7]).sum::<f64>() / 1000.0;
        // Four standard errors of a uniform draw of width 1.4 m.
        assert!(mean.abs() < 4.0 * 1.4 / 12_f64.sqrt() / 1000_f64.sqrt());
    }
}

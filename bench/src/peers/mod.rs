//! Other crates at the same work. Each file: the arm as the peer writes it, its rows, how far it is off.
//!
//! `k` and `rs_opw`: postures in Rust; `ik_geo`: the same by subproblems, built where cmake is; `parry`: distances.

#[cfg(feature = "ik-geo")]
pub mod ik_geo;
pub mod k;
pub mod parry;
pub mod rs_opw;

use crate::agreement::apart;
use crate::clock::Candidate;
use crate::workload::Pose;
use crate::yardstick;

/// Rows of every peer.
pub fn candidates(poses: &[Pose]) -> Vec<Candidate<'_>> {
    let mut all = rs_opw::candidates(poses);
    #[cfg(feature = "ik-geo")]
    all.extend(ik_geo::candidates(poses));
    all.extend(k::candidates(poses));
    all.extend(parry::candidates());
    all
}

/// How far every peer is off the yardstick.
pub fn differences(poses: &[Pose]) -> Vec<(&'static str, f64)> {
    vec![
        ("rs-opw-kinematics", rs_opw::difference(poses)),
        #[cfg(feature = "ik-geo")]
        ("ik-geo", ik_geo::difference(poses)),
        ("k", k::difference(poses)),
    ]
}

/// How far a peer's postures of a pose are off the yardstick's, rad: every posture in reach must be among them.
fn postures_apart(found: &[[f64; 6]], pose: &Pose) -> f64 {
    let theirs = yardstick::ik8(pose);
    let in_reach = theirs.iter().filter(|joints| joints[1].is_finite());
    let nearest = |joints: &[f64; 6]| {
        let each = found.iter().map(|other| apart(other, joints));
        each.fold(f64::INFINITY, f64::min)
    };
    in_reach.map(nearest).fold(0.0, f64::max)
}

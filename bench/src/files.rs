//! What the peers in other languages read: the poses, and what the yardstick found there.
//!
//! Little-endian f64 without header, pose after pose: `poses.f64` (12 a pose, `base_from_tool`, 3 x 4 row by
//! row), `angles.f64` (6 a pose, rad, branch front elbow-up no-flip), `dev.f64` (1 a pose, m), `c66.f64` (36 a
//! pose, of the first thousand poses).

use std::path::Path;
use std::{fs, io};

use crate::workload::Pose;
use crate::yardstick;

/// How many poses have their 6 x 6 compliance written: enough to check a peer.
const CHECKED: usize = 1000;

/// Writes all files into `folder`, which must exist.
///
/// # Errors
/// A file that cannot be written.
pub fn write(folder: &Path, poses: &[Pose]) -> io::Result<()> {
    let angles: Vec<[f64; 6]> = poses.iter().map(yardstick::joints).collect();
    let deviations: Vec<f64> = poses.iter().map(yardstick::dev).collect();
    let compliances: Vec<[f64; 36]> = poses.iter().take(CHECKED).map(yardstick::c66).collect();
    fs::write(folder.join("poses.f64"), bytes(poses.iter().flatten()))?;
    fs::write(folder.join("angles.f64"), bytes(angles.iter().flatten()))?;
    fs::write(folder.join("dev.f64"), bytes(deviations.iter()))?;
    fs::write(folder.join("c66.f64"), bytes(compliances.iter().flatten()))
}

fn bytes<'a>(values: impl Iterator<Item = &'a f64>) -> Vec<u8> {
    values.flat_map(|value| value.to_le_bytes()).collect()
}

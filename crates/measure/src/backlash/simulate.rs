//! Ball-bar records simulated from the robot file: backlash, calibrated geometry, gravity, and noise if requested.
//!
//! ```text
//! SLUG.csv     # radius_mm: 100
//!              angle_deg,radius_dev_um,direction,run        CW 1, CCW 1, CW 2 ...
//! ```

use std::fmt::Write;
use std::path::{Path, PathBuf};

use armill_core::measure::ballbar::Direction;
use armill_core::measure::ballbar::joints::Followed;
use armill_core::units::{from_deg, to_mm, to_um};
use armill_core::watch::Watch;
use armill_formats::file::{Writer, create_folder};
use armill_study::error::StudyError;
use armill_study::file::resolve::Study;
use armill_study::file_names::slug;
use armill_study::number::decimals;
use serde::Serialize;

use super::circles::{CircleAnalysis, circles, followed};
use super::noise::Noise;

/// Options of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulationOptions {
    /// Names of the circles; all if none is named.
    pub analyses: Vec<String>,
    /// Runs in each direction.
    pub runs: usize,
    /// Standard deviation of a sample, m.
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// A simulated file.
#[derive(Clone, Debug, Serialize)]
pub struct SimulatedFile {
    /// Name of the circle.
    pub analysis: String,
    /// Its file.
    pub file: String,
    /// Greatest magnitude of the deviation of the radius.
    pub largest_um: f64,
}

/// Samples of a run: every half degree, offset by a quarter, so that no sample is exactly on a reversal.
const SAMPLES: u32 = 720;

/// The points that the progress of [`simulate`] ends at.
///
/// # Errors
/// See [`circles`].
pub fn point_count(study: &Study, analyses: &[String]) -> Result<usize, StudyError> {
    let circles = circles(study, analyses)?;
    Ok(circles.iter().map(|circle| circle.path.track.len()).sum())
}

/// Writes a file for each circle into the folder `out`.
///
/// # Errors
/// See [`circles`]; a circle that the robot cannot follow; a folder that cannot be written.
pub fn simulate(
    study: &Study,
    requested: &SimulationOptions,
    out: &Path,
    writer: &Writer,
    watch: Watch<'_>,
) -> Result<Vec<SimulatedFile>, StudyError> {
    let mut noise = Noise::seeded(requested.seed);
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    let mut given = Vec::new();
    // Nothing is written before all circles are known to be followed.
    for circle in circles(study, &requested.analyses)? {
        let along = followed(study, &circle, watch)?;
        let (text, largest) = table(&circle, &along, requested, &mut noise);
        let path = out.join(format!("{}.csv", slug(circle.name)));
        if files.iter().any(|(other, _)| *other == path) {
            return Err(StudyError::value(
                format!("two circles would be written to {}", path.display()),
                "give them names that differ in letters or digits",
            ));
        }
        given.push(SimulatedFile {
            analysis: circle.name.to_owned(),
            file: path.display().to_string(),
            largest_um: largest,
        });
        files.push((path, text));
    }
    create_folder(out)?;
    let bytes: Vec<(PathBuf, &[u8])> = (files.iter())
        .map(|(path, text)| (path.clone(), text.as_bytes()))
        .collect();
    writer.write_all(&bytes)?;
    Ok(given)
}

/// The file of one circle, and the greatest deviation in it, um.
fn table(
    circle: &CircleAnalysis<'_>,
    along: &Followed,
    requested: &SimulationOptions,
    noise: &mut Noise,
) -> (String, f64) {
    let mut gaps = vec![0.0; along.joint_count()];
    for (joint, gap) in circle.path.setting.model.structure.joints_with_backlash() {
        gaps[joint] = gap.gap;
    }
    let degrees: Vec<f64> = (0..SAMPLES)
        .map(|k| (f64::from(k) + 0.5) * 360.0 / f64::from(SAMPLES))
        .collect();
    let angles: Vec<f64> = degrees.iter().map(from_deg).collect();
    let mut text = format!(
        "# simulated by armill: backlash of {} joints, noise {} um, seed {}\n# radius_mm: {}\nangle_deg,radius_dev_um,direction,run\n",
        gaps.iter().filter(|gap| **gap > 0.0).count(),
        decimals(to_um(requested.noise), 6),
        requested.seed,
        decimals(to_mm(circle.circle.radius), 9)
    );
    let mut largest: f64 = 0.0;
    for run in 1..=requested.runs {
        for direction in Direction::BOTH {
            let shown = along.deviation(&gaps, direction, &angles);
            let mut rows: Vec<(f64, f64)> = degrees.iter().copied().zip(shown).collect();
            if direction == Direction::Clockwise {
                rows.reverse();
            }
            for (deg, dr) in rows {
                let um = to_um(dr + requested.noise * noise.normal());
                largest = largest.max(um.abs());
                let _ = writeln!(text, "{deg},{um:.4},{},{run}", direction.name());
            }
        }
    }
    (text, largest)
}

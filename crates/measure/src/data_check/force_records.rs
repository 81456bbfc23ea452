//! Data check of force records: units, channels that are copies or dead, one gross outlier.
//!
//! A record alone has no prediction to compare with: signs and order of its axes are not seen here.

use armill_core::load::Record;
use armill_core::nalgebra::Vector3;

/// Greatest force of a machining record, N: less is kN called N, more is mN.
const MACHINING: [f64; 2] = [0.5, 5e4];
/// A single sample this many times larger than all others is no force.
const OUTLIER: f64 = 5.0;
/// Samples round a peak that belong to it.
const PEAK: usize = 3;

/// What is implausible in `record`, each a sentence that begins with the consequence.
pub fn warnings(record: &Record) -> Vec<String> {
    let forces = record.force();
    let sizes: Vec<f64> = forces.iter().map(Vector3::norm).collect();
    let Some((peak, largest)) = sizes
        .iter()
        .copied()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))
    else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    if largest == 0.0 {
        warnings.push("All forces are 0 N: is the amplifier on, and are these the force columns?".to_owned());
        return warnings;
    }
    if largest < MACHINING[0] {
        warnings.push(format!(
            "Forces are at most {largest:.3} N, deviations from them far too small: are they in kN? (columns fx_kn, ...)"
        ));
    } else if largest > MACHINING[1] {
        warnings.push(format!(
            "Forces are up to {largest:.0} N, deviations from them far too large: are they in mN, or not scaled from the voltage?"
        ));
    }
    let axes = ["fx", "fy", "fz"];
    let is_alike = |a: usize, b: usize, sign: f64| forces.iter().all(|force| force[a] == sign * force[b]);
    let moves = |axis: usize| forces.iter().any(|force| force[axis] != forces[0][axis]);
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        if moves(a) && (is_alike(a, b, 1.0) || is_alike(a, b, -1.0)) {
            warnings.push(format!(
                "The direction of the force is wrong: {} and {} hold the same numbers; was a column read twice?",
                axes[a], axes[b]
            ));
        }
    }
    if let [dead] = (0..3).filter(|axis| !moves(*axis)).collect::<Vec<_>>()[..] {
        warnings.push(format!(
            "The force along one axis is missing: {} is {:.3} N in every sample; is its channel connected?",
            axes[dead], forces[0][dead]
        ));
    }
    let others = sizes
        .iter()
        .enumerate()
        .filter(|(index, _)| index.abs_diff(peak) > PEAK)
        .map(|(_, size)| *size)
        .fold(0.0, f64::max);
    if others > 0.0 && largest > OUTLIER * others {
        warnings.push(format!(
            "The greatest force is that of one sample at {:.6} s, {largest:.1} N, where all others are at most {others:.1} N: an outlier?",
            record.time()[peak]
        ));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use armill_core::load::ActsOn;

    use super::*;

    fn record(of: impl Fn(usize) -> [f64; 3]) -> Record {
        let time = (0..100).map(|k| k as f64 * 1e-3).collect();
        Record::new(time, (0..100).map(|k| of(k).into()).collect(), None, ActsOn::Tool).unwrap()
    }

    fn wave(k: usize) -> [f64; 3] {
        let phase = k as f64 * 0.7;
        [
            100.0 * phase.sin(),
            60.0 * phase.cos(),
            20.0 + 5.0 * (2.0 * phase).sin(),
        ]
    }

    #[test]
    fn a_plausible_record_has_no_warning() {
        assert_eq!(warnings(&record(wave)), [""; 0]);
    }

    #[test]
    fn slips_of_units_channels_and_samples_are_named() {
        let only = |of: &dyn Fn(usize) -> [f64; 3]| {
            let all = warnings(&record(of));
            assert_eq!(all.len(), 1, "{all:?}");
            all[0].clone()
        };
        assert!(only(&|k| wave(k).map(|f| f * 1e-3)).contains("are they in kN?"));
        assert!(only(&|k| wave(k).map(|f| f * 1e3)).contains("are they in mN"));
        assert!(only(&|k| [wave(k)[0], wave(k)[0], wave(k)[2]]).contains("fx and fy hold the same numbers"));
        assert!(only(&|k| [wave(k)[0], -wave(k)[0], wave(k)[2]]).contains("fx and fy hold the same numbers"));
        assert!(only(&|k| [wave(k)[0], 0.0, wave(k)[2]]).contains("fy is 0.000 N in every sample"));
        assert!(
            only(&|k| if k == 50 { [9e3, 0.0, 0.0] } else { wave(k) }).contains("one sample at 0.050000 s")
        );
        assert!(only(&|_| [0.0; 3]).contains("All forces are 0 N"));
    }
}

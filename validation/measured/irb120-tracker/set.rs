//! ABB IRB 120: 700 poses with three reflectors on the tool and three on the base. See README.md.

use armill_measure::tracker::{Files, JointUnit, Together, together};

use crate::arms;
use crate::measured::poses::{on_others, question, stretches_held_out};
use crate::measured::{Comparison, Samples};

/// Poses from which the arm is found; the others are kept back.
const FOUND_FROM: usize = 400;

/// Poses held out, and 300 others.
pub fn comparisons(samples: &Samples) -> Vec<Comparison> {
    let robot = arms::irb120();
    let all = read(samples).poses;
    let (first, others) = all.split_at(FOUND_FROM);
    let mut rows = stretches_held_out(&robot, "400 poses", first, 5);
    rows.extend(on_others(
        &robot,
        &question(),
        ("400 poses", first),
        &[("300 others", others)],
    ));
    rows
}

fn read(samples: &Samples) -> Together {
    let file = |name: &str| samples.path(&format!("abb-irb120-tracker/measured_{name}.txt"));
    let files = Files {
        measured: ["SMR_1", "SMR_2", "SMR_3"].map(file).to_vec(),
        base: Some(["base_1", "base_2", "base_3"].map(file)),
        joints: Some(file("joints")),
        joint_unit: JointUnit::Degree,
    };
    together(&arms::irb120(), &files).unwrap_or_else(|error| panic!("{error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::poses::testing::{assert_near, least_squares};

    #[test]
    fn calibration_is_the_least_squares_of_another_program() {
        let Some(samples) = Samples::from_environment() else {
            println!("skipped: ARMILL_SAMPLES is not set");
            return;
        };
        // As of the TX90L; rigid fits, and rows replaced, by the other program too.
        let expected = [[0.852_010, 0.256_645], [0.546_272, 0.102_419]];
        assert_near(
            least_squares(&arms::irb120(), &read(&samples).poses),
            expected,
            2e-3,
        );
    }

    #[test]
    fn misread_reflectors_of_the_base_are_those_that_are_far_from_their_place() {
        let Some(samples) = Samples::from_environment() else {
            println!("skipped: ARMILL_SAMPLES is not set");
            return;
        };
        let base = read(&samples).base.unwrap();
        let of = |reflector: usize| -> Vec<usize> {
            let found = base.misread.iter().filter(|one| one.reflector == reflector);
            found.map(|one| one.pose).collect()
        };
        // Rows, from 0, that a look at the files by another program found more than 0.5 mm from the median.
        assert!(of(0).is_empty());
        assert_eq!(of(1), [251]);
        assert_eq!(of(2), [21, 50, 115, 133, 134, 135, 143, 178, 257, 336, 388, 399]);
        assert!(base.undetermined.is_empty() && base.drifting().is_none());
    }
}

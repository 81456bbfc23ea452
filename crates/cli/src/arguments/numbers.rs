//! Checks of options with numbers, with uniform messages: `--at-mm: 2 numbers`, `--axis: nan is not a finite number`.
//!
//! | function | accepts | refuses |
//! |---|---|---|
//! | `finite` | any numbers | not finite; beyond 1e9 |
//! | `above_zero` | one | also 0 and less |
//! | `within` | one, from least to most | all others |
//! | `three` | three, as a vector | also another count |
//! | `three_or_six` | a position, or a position and angles | also another count |
//!
//! All keep the unit of their option; the caller converts it to SI.

use std::fmt::Display;

use armill_core::nalgebra::Vector3;
use armill_study::StudyError;

/// No length (mm), angle (deg) or force (N) of a real cell is larger; a larger one has a wrong unit.
const LARGEST: f64 = 1e9;

/// `Ok` if all numbers are plausible.
///
/// # Errors
/// The first number that is not finite, or beyond [`LARGEST`], with the name of its option.
pub(crate) fn finite(flag: &str, values: &[f64]) -> Result<(), StudyError> {
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(StudyError::value(
            format!("{flag}: {value} is not a finite number"),
            "a plain number",
        ));
    }
    match values.iter().find(|value| value.abs() > LARGEST) {
        Some(value) => Err(StudyError::value(
            format!("{flag}: {value:e} is beyond {LARGEST:e}"),
            "is the unit right?",
        )),
        None => Ok(()),
    }
}

/// `value`, if it is greater than 0.
///
/// # Errors
/// As [`finite`]; 0 or less.
pub(crate) fn above_zero(flag: &str, value: f64) -> Result<f64, StudyError> {
    finite(flag, &[value])?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(StudyError::value(
        format!("{flag}: {value} is not above 0"),
        "such as 1",
    ))
}

/// `value`, if it is from `least` to `most`.
///
/// # Errors
/// Another number, with the name of its option.
pub(crate) fn within<T: PartialOrd + Display>(
    flag: &str,
    value: T,
    [least, most]: [T; 2],
) -> Result<T, StudyError> {
    match least <= value && value <= most {
        true => Ok(value),
        false => Err(StudyError::value(
            format!("{flag}: {value} is outside {least} to {most}"),
            "see --help",
        )),
    }
}

/// Three numbers.
///
/// # Errors
/// As [`finite`]; another count.
pub(crate) fn three(flag: &str, values: &[f64]) -> Result<Vector3<f64>, StudyError> {
    finite(flag, values)?;
    match values {
        [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
        _ => Err(StudyError::value(
            format!("{flag}: {} numbers", values.len()),
            "three numbers are required, such as 1000,0,800",
        )),
    }
}

/// Three or six numbers; the last three are 0 if not given, all six if the option is not given.
///
/// # Errors
/// As [`finite`]; another count.
pub(crate) fn three_or_six(flag: &str, values: Option<&[f64]>) -> Result<[f64; 6], StudyError> {
    let values = values.unwrap_or(&[0.0; 3]);
    finite(flag, values)?;
    match values {
        [x, y, z] => Ok([*x, *y, *z, 0.0, 0.0, 0.0]),
        [x, y, z, rx, ry, rz] => Ok([*x, *y, *z, *rx, *ry, *rz]),
        _ => Err(StudyError::value(
            format!("{flag}: {} numbers", values.len()),
            "three or six numbers are required",
        )),
    }
}

//! A reading of a pendant: joint positions, and the pose that it shows with them.

use armill_core::frame::Isometry;

use crate::convention::{Convention, PoseError};

/// Why a reading is none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PendantError {
    /// No `=` between joints and pose.
    #[error("`{0}` has no `=` between joint positions and pose")]
    NoPose(String),
    /// A word that is not a number.
    #[error("`{0}` is not a finite number")]
    NotANumber(String),
    /// Numbers that are not a valid pose.
    #[error(transparent)]
    Pose(#[from] PoseError),
}

/// Joint positions (as written) and pose of a reading such as `0,-90,90,0,0,0 = 1200,0,900,0,90,0`.
///
/// # Errors
/// See [`PendantError`].
pub fn reading(text: &str, convention: Convention) -> Result<(Vec<f64>, Isometry), PendantError> {
    let (joints, pose) = text
        .split_once('=')
        .ok_or_else(|| PendantError::NoPose(text.to_owned()))?;
    Ok((numbers(joints)?, convention.pose(&numbers(pose)?)?))
}

/// Numbers between commas; any blanks around them.
fn numbers(text: &str) -> Result<Vec<f64>, PendantError> {
    let number = |word: &str| {
        let value: Option<f64> = word.trim().parse().ok().filter(|value: &f64| value.is_finite());
        value.ok_or_else(|| PendantError::NotANumber(word.trim().to_owned()))
    };
    text.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_invalid_reading_is_reported_with_its_words() {
        let given = |text: &str| reading(text, Convention::Kuka).unwrap_err().to_string();
        assert!(given("0,0,0").contains("no `=`"));
        assert!(given("0,zero=1,2,3,4,5,6").contains("`zero`"));
        assert!(given("0,0=1,2,3,4,5,inf").contains("`inf`"));
        // The square of this overflows, and so the angle of a rotation vector did.
        let large = reading("0=1,2,3,1e200,0,0", Convention::Ur).unwrap_err();
        assert_eq!(large, PendantError::Pose(PoseError::TooLarge(1e200)));
        assert!(given("0,0=1,2,3").contains("3 numbers of the pose, where kuka has 6"));
    }
}

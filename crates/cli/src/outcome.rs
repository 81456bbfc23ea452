//! How a command ends that did its work.

/// Outcome of a command that did its work; an error that stopped it is a `StudyError`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Success.
    Fine,
    /// `--strict` was given and the tolerance is not met everywhere.
    ToleranceNotMet,
    /// The robot file disagrees with its pendant.
    Disagreement,
}

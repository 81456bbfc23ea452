//! The source of an input number, in words.

use crate::answer::StudyAnswer;

/// Source of the values given by the user.
pub(super) const THE_STUDY: &str = "the study";

/// The description and the publication of a source, by its key; the key itself if it is not listed.
pub(super) fn place(answer: &StudyAnswer, key: &str) -> String {
    let found = answer.sources.iter().find(|source| source.key == key);
    found.map_or_else(
        || key.to_owned(),
        |source| format!("{} ({})", source.what, source.place),
    )
}

//! The part of a path as it was followed.

use std::borrow::Cow;

use armill_core::path::Track;

use crate::analysis::path::PathAnalysis;
use crate::analysis::path::run::PathResult;
use crate::analysis::runner::Runner;
use crate::error::StudyError;

impl Runner<'_> {
    /// Cuts the part of a path as it was followed, if the study asks for it: it takes longer than the path.
    ///
    /// # Errors
    /// As [`Runner::machined_part`].
    pub fn cut_part(&self, analysis: &PathAnalysis, found: &mut PathResult) -> Result<(), StudyError> {
        let track = &track_of(analysis, found);
        let part = self.machined_part(analysis, track, (track, &found.along), found.motion.as_ref())?;
        found.machined_part = part.map(Box::new);
        Ok(())
    }
}

/// The track of a path as it was followed: with the spins of its search, if these are applied.
pub(super) fn track_of<'a>(analysis: &'a PathAnalysis, found: &PathResult) -> Cow<'a, Track> {
    let applied = found.searched.as_ref().filter(|searched| searched.applied);
    let turned = applied.map(|searched| searched.posture.turned(&analysis.track));
    turned.map_or(Cow::Borrowed(&analysis.track), Cow::Owned)
}

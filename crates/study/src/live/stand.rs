//! Where the arm stands in what is shown: at the worst or best point of an answer, or at a place that the user chose.

use armill_core::watch::Watch;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Text;
use super::posture::{Place, PosturesAnswer, postures_of};
use crate::answer::{PointAnswer, StudyAnswer};
use crate::error::{ErrorKind, StudyError};
use crate::file::resolve::{Parsed, Study};
use crate::run::{Done, Found};

/// Where the arm is to stand.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stand {
    /// At which point.
    pub follow: Follow,
    /// The place, where that is followed.
    pub at: Option<Place>,
    /// Of sections the one whose worst or best point is meant, from 0.
    #[serde(default)]
    pub section: usize,
    /// Load case, from 1; if left out the one that decides at the worst or best point, at a place the first.
    pub case: Option<usize>,
}

/// What the arm follows while values change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Follow {
    /// Where the deviation is largest.
    Worst,
    /// Where it is least.
    Best,
    /// The place that is told.
    Place,
}

/// The places of the worst and the best point; none where no point is reached, no best along a path and of holes.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct ExtremesAnswer {
    /// Where the deviation is largest.
    pub worst: Option<Place>,
    /// Where it is least.
    pub best: Option<Place>,
}

/// The arm where it was to stand.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StandsAnswer {
    /// The place.
    pub at: Place,
    /// The load case, from 1.
    pub case: usize,
    /// Every posture there, as `/api/pose` answers.
    pub pose: PosturesAnswer,
}

/// The extremes of this ask: of sections those of each, else of one.
pub(super) fn extremes_of(answer: &StudyAnswer, done: &[Done<'_>]) -> Vec<ExtremesAnswer> {
    let several = answer.maps.len() > 1;
    let on_map = |section: usize| {
        let [worst, best] = extreme_points(answer, section).map(|point| {
            point.map(|point| Place {
                y_mm: Some(point.in_plane_mm[0]),
                z_mm: Some(point.in_plane_mm[1]),
                section: several.then_some(section),
                ..Place::default()
            })
        });
        ExtremesAnswer { worst, best }
    };
    let of_points = |[worst, best]: [Option<usize>; 2]| {
        let [worst, best] = [worst, best].map(|index| {
            index.map(|index| Place {
                point: Some(index),
                ..Place::default()
            })
        });
        vec![ExtremesAnswer { worst, best }]
    };
    match done.first().map(|done| &done.found) {
        Some(Found::Map(..) | Found::Sections(_)) => (0..answer.maps.len()).map(on_map).collect(),
        Some(Found::Volume(_, volume)) => {
            let answers = &volume.answers;
            of_points([answers.worst(), answers.best()].map(|found| found.map(|(index, _)| index)))
        }
        Some(Found::Path(_, path)) => of_points([path.worst.first().map(|worst| worst.index), None]),
        Some(Found::Holes(..)) => {
            let holes = answer.holes.first();
            let worst = holes.and_then(|holes| holes.worst_holes.first());
            of_points([worst.map(|worst| worst.hole - 1), None])
        }
        None => Vec::new(),
    }
}

/// The worst and the best point of what is shown.
fn extreme_points(answer: &StudyAnswer, section: usize) -> [Option<&PointAnswer>; 2] {
    if let Some(map) = answer.maps.get(section).or(answer.maps.first()) {
        return [map.worst.as_ref(), map.best.as_ref()];
    }
    if let Some(path) = answer.paths.first() {
        return [path.worst.as_ref(), None];
    }
    if let Some(volume) = answer.volumes.first() {
        return [volume.worst.as_ref(), volume.best.as_ref()];
    }
    let holes = answer.holes.first().and_then(|holes| holes.worst_holes.first());
    [holes.map(|worst| &worst.point), None]
}

/// The arm where it is to stand in this ask, the only one of the study, that was done; none where there is no such place, or no longer.
///
/// # Errors
/// Cancelled by the watch; a fault.
pub(super) fn stands_of(
    (text, parsed, study): (Text<'_>, &Parsed, &Study),
    (answer, extremes, done): (&StudyAnswer, &[ExtremesAnswer], &[Done<'_>]),
    stand: &Stand,
    watch: Watch<'_>,
) -> Result<Option<StandsAnswer>, StudyError> {
    let places = extremes.get(stand.section).or(extremes.first());
    let [worst, best] = extreme_points(answer, stand.section);
    let (at, point) = match stand.follow {
        Follow::Worst => (places.and_then(|places| places.worst.clone()), worst),
        Follow::Best => (places.and_then(|places| places.best.clone()), best),
        Follow::Place => (stand.at.clone(), None),
    };
    let Some(at) = at else {
        return Ok(None);
    };
    let case = stand.case.or(point.map(|point| point.deciding_case)).unwrap_or(1);
    match postures_of((text, parsed, study), (&at, case), done.first(), watch) {
        Ok(pose) => Ok(Some(StandsAnswer { at, case, pose })),
        // A place of before, on a path that is shorter now: who asks for it alone is told why.
        Err(error) if error.kind() == ErrorKind::InvalidInput => Ok(None),
        Err(error) => Err(error),
    }
}

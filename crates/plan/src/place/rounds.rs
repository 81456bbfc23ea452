//! The rounds of a search: valleys of every site, the floor of the best, the same for each margin, and the grids.

use armill_core::kernel::{PlacedPath, Question};
use armill_core::optimize::{Placeable, PlacementObjective, RankBy, Score};
use armill_core::robot::Robot;
use armill_core::units::{from_deg, to_deg, to_um};
use armill_core::watch::Watch;
use armill_study::error::StudyError;
use armill_study::input::setting::Setting;

use super::certificate::{CertificateAnswer, GridAnswer};
use super::followed::FollowedPath;
use super::freedom::Freedom;
use super::journal::{Fingerprint, Journal};
use super::search::{Effort, Searched, Spot};

/// Margins of the search, deg.
pub(super) const MARGINS_DEG: [f64; 8] = [0.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0];
/// A better place that a grid shows is taken as a start so often.
const MOST_TRIES: usize = 3;

/// One fixture, or the one place that may move.
pub(super) struct Site<'a> {
    pub name: Option<&'a str>,
    pub freedom: Freedom,
}

/// The best place of one search.
#[derive(Clone)]
pub(super) struct Best {
    pub site: usize,
    pub spot: Spot,
}

/// A search over all sites.
pub(super) struct SiteSearch<'a> {
    pub objective: PlacementObjective,
    pub effort: Effort,
    /// Its rounds are kept under this name.
    pub name: &'a str,
    /// One more place to start from.
    pub also: Option<&'a Best>,
}

/// The result of all searches of one path.
pub(super) struct FoundPlacements {
    pub best: Best,
    pub certificate: CertificateAnswer,
    /// The best placement for each margin, rad.
    pub front: Vec<(f64, Best)>,
}

/// Data common to all searches of one path.
pub(super) struct Prepared<'a> {
    pub robot: &'a Robot,
    pub setting: &'a Setting,
    pub seed: u64,
    pub question: &'a Question<'a>,
    /// Some points of the path, and all.
    pub paths: [&'a PlacedPath; 2],
    pub followed: &'a FollowedPath<'a>,
    pub sites: &'a [Site<'a>],
    pub effort: Effort,
    pub watch: Watch<'a>,
    pub given: &'a dyn Fn(&str),
}

impl Prepared<'_> {
    pub fn searched<'s>(
        &'s self,
        freedom: &'s Freedom,
        objective: PlacementObjective,
        effort: Effort,
    ) -> Searched<'s> {
        let of = |path| Placeable {
            question: self.question,
            path,
            objective,
        };
        Searched {
            some: of(self.paths[0]),
            all: of(self.paths[1]),
            followed: self.followed,
            freedom,
            effort,
            seed: self.seed,
        }
    }

    /// The best place of all sites.
    pub fn best(&self, search: &SiteSearch<'_>, journal: &mut Journal<'_>) -> Result<Best, StudyError> {
        let SiteSearch {
            objective,
            effort,
            name,
            also,
        } = *search;
        let mut best: Option<Best> = None;
        for (site, of) in self.sites.iter().enumerate() {
            let searched = self.searched(&of.freedom, objective, effort);
            let also = also
                .filter(|also| also.site == site)
                .map(|also| also.spot.at.clone());
            let mut spots = Vec::new();
            let mut starts: Option<Vec<Spot>> = None;
            for round in 0..effort.rounds {
                let at = journal.round(&format!("{name}site {site} valley {round}"), || {
                    if starts.is_none() {
                        starts = Some(searched.starts(self.watch)?);
                    }
                    let spread = starts.as_deref().unwrap_or_default();
                    let start = match (&also, round) {
                        (Some(also), 0) => also,
                        // Fewer valleys than rounds: the best again, in other random steps.
                        _ => match spread.get(round).or(spread.first()) {
                            Some(start) => &start.at,
                            None => return Ok(Vec::new()),
                        },
                    };
                    Ok(searched.valley(start, round, self.watch)?.at)
                })?;
                spots.push(searched.evaluated(at)?);
                self.report(&spots, objective.rank_by);
            }
            if let Some(also) = also {
                spots.push(searched.evaluated(also)?);
            }
            let Some(valley) = the_best(spots) else { continue };
            let floor = journal.round(&format!("{name}site {site} floor"), || {
                Ok(searched.floor(&valley.at, self.watch)?.at)
            })?;
            let spot = searched.evaluated(floor)?;
            if best
                .as_ref()
                .is_none_or(|best| spot.score.beats(&best.spot.score))
            {
                best = Some(Best { site, spot });
            }
        }
        best.ok_or_else(|| {
            StudyError::value(
                "there is no placement to evaluate",
                "free a degree, or give fixtures",
            )
        })
    }

    fn report(&self, spots: &[Spot], rank_by: RankBy) {
        let score = the_best(spots.to_vec()).map_or(Score::NONE, |spot| spot.score);
        (self.given)(&match score.unreachable {
            0 if matches!(rank_by, RankBy::WithinTolerance(_)) => {
                format!("best so far {:.2} sigma from the tolerance", score.cost)
            }
            0 => format!("best so far {:.2} µm", to_um(score.cost)),
            lost => format!("best so far: no posture at {lost} points"),
        });
    }

    /// The best placement and its grids; a better one of the grids is the start of another local search.
    pub fn certified(
        &self,
        mut best: Best,
        objective: PlacementObjective,
        journal: &mut Journal<'_>,
    ) -> Result<(Best, CertificateAnswer), StudyError> {
        let mut tried = 0;
        loop {
            let (certificate, better) = self.certificate(&best, objective)?;
            let Some(better) = better else {
                return Ok((best, certificate));
            };
            best = better;
            if tried == MOST_TRIES {
                return Ok((best, certificate));
            }
            let searched = self.searched(&self.sites[best.site].freedom, objective, self.effort);
            let floor = journal.round(&format!("better {tried}"), || {
                Ok(searched.floor(&best.spot.at, self.watch)?.at)
            })?;
            let spot = searched.evaluated(floor)?;
            if spot.score.beats(&best.spot.score) {
                best.spot = spot;
            }
            tried += 1;
        }
    }

    /// The grids of all fixtures for `best`, and their best placement if that is better.
    fn certificate(
        &self,
        best: &Best,
        objective: PlacementObjective,
    ) -> Result<(CertificateAnswer, Option<Best>), StudyError> {
        let here = self.searched(&self.sites[best.site].freedom, objective, self.effort);
        let (near, better) = here.near_grid(&best.spot, self.watch)?;
        let mut all = vec![(best.site, better)];
        let mut wide: Option<GridAnswer> = None;
        for (site, of) in self.sites.iter().enumerate() {
            let searched = self.searched(&of.freedom, objective, self.effort);
            let (given, better) = searched.wide_grid(&best.spot.score, self.watch)?;
            wide = Some(match wide {
                Some(so_far) => so_far.and(given),
                None => given,
            });
            all.push((site, better));
        }
        let better = all
            .into_iter()
            .filter_map(|(site, spot)| Some(Best { site, spot: spot? }))
            .reduce(|a, b| if b.spot.score.beats(&a.spot.score) { b } else { a });
        let wide = wide.unwrap_or_else(|| near.clone());
        Ok((CertificateAnswer { near, wide }, better))
    }

    /// The best placement for each margin, from the least on; it ends where not all points can be reached.
    pub fn front(
        &self,
        objective: PlacementObjective,
        best: &Best,
        journal: &mut Journal<'_>,
    ) -> Result<Vec<(f64, Best)>, StudyError> {
        let mut front: Vec<(f64, Best)> = Vec::new();
        if best.spot.score.unreachable > 0 {
            return Ok(front);
        }
        front.push((objective.margin, best.clone()));
        for margin in MARGINS_DEG.map(from_deg) {
            if margin <= objective.margin {
                continue;
            }
            let objective = PlacementObjective { margin, ..objective };
            let search = SiteSearch {
                objective,
                effort: self.effort.cheaper(),
                name: &format!("margin {:.0} ", to_deg(margin)),
                also: front.last().map(|(_, best)| best),
            };
            let found = self.best(&search, journal)?;
            if found.spot.score.unreachable > 0 {
                break;
            }
            front.push((margin, found));
        }
        // What keeps a wide margin keeps a narrow one too.
        for index in (1..front.len()).rev() {
            if front[index].1.spot.score.beats(&front[index - 1].1.spot.score) {
                front[index - 1].1 = front[index].1.clone();
            }
        }
        Ok(front)
    }

    /// Fingerprint of all input of the search.
    pub fn fingerprint(&self, objective: &PlacementObjective) -> u64 {
        let mut print = Fingerprint::new();
        let (robot, setting) = (self.robot, self.setting);
        let freedoms: Vec<&Freedom> = self.sites.iter().map(|site| &site.freedom).collect();
        print.take(format!("{robot:?}{setting:?}{objective:?}{freedoms:?}{:?}", self.effort).as_bytes());
        print.take(&self.seed.to_le_bytes());
        for number in self.paths[1].numbers() {
            print.take(&number.to_bits().to_le_bytes());
        }
        print.value()
    }
}

/// The best of these; of equal ones the first.
fn the_best(spots: Vec<Spot>) -> Option<Spot> {
    spots
        .into_iter()
        .reduce(|best, spot| if spot.score.beats(&best.score) { spot } else { best })
}

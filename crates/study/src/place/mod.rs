//! Where should the part lie, so that the path deviates least?
//!
//! ```text
//! what is free -> places spread over it -> valleys -> floor on all points -> certificate -> the study at that place
//! ```
//!
//! `freedom`: what may move; `search`: from places spread over it to the best; `certificate`: whether grids of places hold a
//! better one; [`journal`]: what is kept so that a search goes on where it was stopped; `answer`: the values of the result;
//! `pictures`. Theory: `docs/theory/placement.md`.
//!
//! Where fixtures are told each is searched by itself, and the best is taken. Against a margin to limits and singularities
//! the search is done again for each of some margins, with the place before as one more start.

pub mod answer;
mod certificate;
mod freedom;
pub mod journal;
mod pictures;
mod search;

pub use answer::{FreeAnswer, MarginAnswer, OutcomeAnswer, PlacementAnswer};
pub use certificate::{CertificateAnswer, GridAnswer};
pub use freedom::PlaceAnswer;
pub use journal::Journal;

use armill_core::frame::from_xyz_and_fixed_angles;
use armill_core::kernel::{BranchChoice, PlacedPath, Question};
use armill_core::nalgebra::{Point3, UnitQuaternion, Vector3};
use armill_core::optimize::{
    Holding, Merit, Placeable, PlacementGoal, PostureSearch, Sure, ToolTurn, on_part,
};
use armill_core::path::Spin;
use armill_core::robot::BranchPattern;
use armill_core::watch::Watch;
use armill_core::workpiece::Plane;

use crate::answer::path::search::{counts_word, goal_word};
use crate::error::StudyError;
use crate::file::format::{AskKind, PlaneChange, PostureTable, StudyFile};
use crate::file::path::PathAsk;
use crate::file::placement::{ANY, FixtureTable, PlaceTable, SureName};
use crate::file::posture_search::{CountsName, GoalName};
use crate::file::resolve::{Setting, Study, Subject};
use crate::number::decimals;
use crate::output::Picture;
use crate::run::runner;
use crate::studies::FoundStudy;
use answer::sure_word;
use freedom::Freedom;
use journal::Fingerprint;
use search::{Effort, Searched, Spot};

/// Where the part may go where nobody says: so far to all sides, mm.
const USUAL_MM: f64 = 300.0;
/// Least bend of the wrist where nobody says, deg.
const USUAL_WRIST_DEG: f64 = 3.0;
/// Margins that are tried, deg.
const MARGINS_DEG: [f64; 8] = [0.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0];
/// A better place that a grid shows is taken as a start so often.
const MOST_TRIES: usize = 3;

/// A search that is ready to begin.
pub struct Placing<'a> {
    study: &'a Study,
    /// Which of its asks.
    index: usize,
    name: &'a str,
    ask: &'a PathAsk,
    /// Turns and branches that each point may take for itself, where it is a set of holes.
    holes: Option<&'a PostureSearch>,
    table: PlaceTable,
    seed: u64,
}

/// What a search has found.
pub struct Found {
    /// In numbers.
    pub answer: PlacementAnswer,
    /// Front and sections.
    pub pictures: Vec<Picture>,
    /// Which ask was placed.
    ask: usize,
    /// The tool on the part at each point, where it turns with it though the study does not say so.
    with_part: Option<Vec<UnitQuaternion<f64>>>,
}

impl Found {
    /// Whether the path is better there than as drawn.
    pub fn is_better(&self) -> bool {
        let (there, drawn) = (&self.answer.found, &self.answer.as_drawn);
        (there.lost_points, there.cost_um) < (drawn.lost_points, drawn.cost_um)
    }

    /// The study with its path, alone, laid there and its tool turned as it was judged.
    ///
    /// # Errors
    /// Every problem of the file, which may have changed since it was read.
    pub fn study(&self, found: &FoundStudy) -> Result<Study, StudyError> {
        let mut study = found.read_changed(|file| self.lay(file))?;
        study.asks.retain(|ask| ask.name == self.answer.ask);
        study.statements.clear();
        for ask in &mut study.asks {
            let path = match &mut ask.subject {
                Subject::Path(path) => path,
                Subject::Holes(holes) => &mut holes.path,
                _ => continue,
            };
            if let Some(part_from_tools) = &self.with_part {
                let track = &path.track;
                let spins = part_from_tools.iter().enumerate().map(|(index, on_part)| {
                    let judged = track.base_from_part.rotation * on_part;
                    let turn = track.stop(index).base_from_tool.rotation.inverse() * judged;
                    2.0 * turn.k.atan2(turn.w)
                });
                path.track.spins = Some(spins.collect());
            }
        }
        Ok(study)
    }

    /// Lets the study file lay its path there.
    fn lay(&self, file: &mut StudyFile) {
        let place = &self.answer.place;
        let Some(ask) = file.ask.get_mut(self.ask) else {
            return;
        };
        ask.plane = Some(PlaneChange {
            centre_mm: Some(place.centre_mm),
            tilt_deg: place.tilt_deg,
            rotation_deg: place.rotation_deg,
            ..ask.plane.take().unwrap_or_default()
        });
        let whole = file.posture.as_ref();
        let own = ask.posture.as_ref();
        ask.posture = Some(PostureTable {
            branch: self.answer.found.branch.clone().or_else(|| {
                let own = own.and_then(|posture| posture.branch.clone());
                own.or_else(|| whole.and_then(|posture| posture.branch.clone()))
            }),
            home_deg: own.and_then(|posture| posture.home_deg.clone()),
            search: own.and_then(|posture| posture.search.clone()),
        });
        let more = |spin: Option<f64>| {
            let sum = spin.unwrap_or(0.0) + place.spin_deg;
            Some(sum - 360.0 * (sum / 360.0).round())
        };
        match &mut ask.program {
            _ if ask.kind == AskKind::Holes => (),
            Some(program) => program.spin_deg = more(program.spin_deg),
            None => ask.spin_deg = more(ask.spin_deg),
        }
    }
}

/// One fixture, or the one place that may move.
struct Site<'a> {
    name: Option<&'a str>,
    freedom: Freedom,
}

/// The best place of one search.
#[derive(Clone)]
struct Best {
    site: usize,
    spot: Spot,
}

impl<'a> Placing<'a> {
    /// Of the path that `wanted` names, or the study's own table, or that is the only one; what `wanted` leaves open is as
    /// the study says, else as usual.
    ///
    /// # Errors
    /// No such path, or several; bounds that leave nothing; words that name no branch.
    pub fn new(study: &'a Study, wanted: PlaceTable, seed: u64) -> Result<Placing<'a>, StudyError> {
        let mut table = wanted.or(study.place.clone().unwrap_or_default());
        let (index, chosen) = chosen(study, table.ask.as_deref())?;
        let (name, (ask, holes)) = (chosen.0, chosen.1);
        let stays = ask
            .source
            .robot()
            .is_some_and(|robot| robot.cell.base_from_path.is_none());
        if stays {
            let message =
                format!("`{name}` follows a program of a robot, which lies where its frame is told");
            let hint = "program.part_from_path_mm_deg = [0, 0, 0, 0, 0, 0] lays its frame on the plane, which can be moved";
            return Err(StudyError::value(message, hint));
        }
        if holes.is_some() && table.spin_deg.is_some() {
            let message =
                "`spin_deg` turns the tool alike at all points, and holes are each held in their best turn";
            return Err(StudyError::value(
                message,
                "posture.search.turns_deg bounds the turns of holes",
            ));
        }
        let faults = table.faults();
        if let Some((_, _, hint)) = faults.first() {
            let messages: Vec<&str> = faults.iter().map(|(_, message, _)| message.as_str()).collect();
            return Err(StudyError::value(messages.join("; "), *hint));
        }
        if !table.is_free() {
            let at = ask.setting.counted(&ask.setting.plane.at(Point3::origin().xy()));
            let about = |at: f64| Some([at * 1e3 - USUAL_MM, at * 1e3 + USUAL_MM]);
            (table.x_mm, table.y_mm, table.z_mm) = (about(at.x), about(at.y), about(at.z));
        }
        Ok(Placing {
            study,
            index,
            name,
            ask,
            holes,
            table,
            seed,
        })
    }

    /// What is placed.
    pub fn name(&self) -> &str {
        self.name
    }

    /// Whether that is a set of holes.
    pub fn is_of_holes(&self) -> bool {
        self.holes.is_some()
    }

    /// Places that the search looks at, about: what its progress ends at.
    pub fn place_count(&self) -> usize {
        let effort = self.effort();
        let margins = MARGINS_DEG.len() - 1;
        let sites = self.table.fixture.len().max(1);
        sites * (effort.most() + margins * effort.cheaper().most() + effort.grid)
    }

    fn effort(&self) -> Effort {
        let robot = &self.study.robot.robot;
        let effort = match robot.ortho_parallel().is_some() && self.ask.setting.model.is_drives_alone() {
            true => Effort::lanes(self.ask.track.len()),
            false => Effort::ONE_BY_ONE,
        };
        effort.shared_by(self.holes.map_or(1, |search| search.spins.count))
    }

    /// Searches; `told` hears of the best so far, `watch` of every place.
    ///
    /// # Errors
    /// A robot without compliance; a path that misses its stock; cancelled by the watch; a journal that cannot be written.
    pub fn search(
        &self,
        journal: &mut Journal,
        watch: Watch<'_>,
        told: &dyn Fn(&str),
    ) -> Result<Found, StudyError> {
        let quiet = Watch {
            finished: &|_| (),
            ..watch
        };
        let runner = runner(self.study, quiet)?;
        let (load, _) = runner.pushed(self.ask)?;
        let goal = self.goal()?;
        let track = &self.ask.track;
        let effort = self.effort();
        let all: Vec<usize> = (0..track.len()).collect();
        let stride = track.len().div_ceil(effort.points).max(1);
        let some: Vec<usize> = all.iter().copied().step_by(stride).collect();
        let on_part = |indices: &[usize]| on_part((track, &load), goal.counts, indices);
        let question = runner.question(&self.ask.setting);
        let (all, some) = (on_part(&all), on_part(&some));
        let turn = ToolTurn::of(track);
        let sites = self.sites(turn);
        let prepared = Prepared {
            of: self,
            question: &question,
            paths: [&some, &all],
            sites: &sites,
            effort,
            watch,
            told,
        };
        journal.take_up(prepared.fingerprint(&goal));
        let drawn = Freedom::new(&self.ask.setting, turn, &PlaceTable::default());
        let mut best = prepared.best((goal, effort), "", None, journal)?;
        let mut front = prepared.front(goal, &best, journal)?;
        if let Some((_, first)) = front.first() {
            best = first.clone();
        }
        let (best, certificate) = prepared.certified(best, goal, journal)?;
        if let Some((_, first)) = front.first_mut() {
            *first = best.clone();
        }
        let as_asked = PlacementGoal {
            branches: match self.ask.setting.choice {
                BranchChoice::Of(pattern) => pattern,
                BranchChoice::Best => BranchPattern::default(),
            },
            ..goal
        };
        let limit = self.ask.setting.limit;
        let outcome = |freedom: &Freedom, goal: PlacementGoal, at: &[f64]| {
            let appraised = prepared
                .searched(freedom, goal, effort)
                .all
                .appraised(&freedom.lie(at));
            OutcomeAnswer::of(&appraised, limit)
        };
        let freedom = &sites[best.site].freedom;
        let answer = PlacementAnswer {
            format: 1,
            ask: self.name.to_owned(),
            counts: counts_word(goal.counts),
            goal: goal_word(goal.goal),
            margin_deg: decimals(goal.margin.to_degrees(), 4),
            sure: sure_word(goal.sure),
            as_drawn: outcome(&drawn, as_asked, &[]),
            found: outcome(freedom, goal, &best.spot.at),
            fixture: sites[best.site].name.map(str::to_owned),
            place: freedom.answer(&best.spot.at),
            free: freedom.told(&best.spot.at),
            certificate,
            by_margin: front
                .iter()
                .map(|(margin, best)| MarginAnswer {
                    margin_deg: decimals(margin.to_degrees(), 4),
                    cost_um: outcome(&sites[best.site].freedom, goal, &best.spot.at).cost_um,
                    fixture: sites[best.site].name.map(str::to_owned),
                    place: sites[best.site].freedom.answer(&best.spot.at),
                })
                .collect(),
            seed: self.seed,
            points: track.len(),
            rounds_taken_up: journal.taken(),
            tool_turns_with_part: turn == ToolTurn::WithPart
                && !matches!(track.placing.spin, Spin::AlongFeed(_)),
        };
        let searched = prepared.searched(freedom, goal, effort);
        let mut pictures = searched.sections(&best.spot, &answer, watch)?;
        pictures.extend(pictures::front(&answer, self.ask.setting.limit));
        let turns_with_part = answer.tool_turns_with_part;
        let spin = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), freedom.lie(&best.spot.at).spin);
        let on_part = |index: usize| {
            (track.base_from_part.inverse() * track.stop(index).base_from_tool).rotation * spin
        };
        Ok(Found {
            with_part: turns_with_part.then(|| (0..track.len()).map(on_part).collect()),
            ask: self.index,
            answer,
            pictures,
        })
    }

    fn goal(&self) -> Result<PlacementGoal, StudyError> {
        let table = &self.table;
        let setting = &self.ask.setting;
        let branches = match table.branch.as_deref() {
            None => setting.open,
            Some(ANY) => BranchPattern::default(),
            Some(words) => words.parse().map_err(|error| {
                let message = format!("place.branch: {error}");
                StudyError::value(message, "words of a branch, or `any`")
            })?,
        };
        Ok(PlacementGoal {
            counts: table.counts.unwrap_or(CountsName::InPlane).counts(),
            goal: table.goal.unwrap_or(GoalName::Worst).goal(setting.limit),
            branches,
            margin: table.margin_deg.unwrap_or(0.0).to_radians(),
            holding: match self.holes {
                Some(search) => Holding::EachForItself(search.spins),
                None => Holding::InOneBranch,
            },
            sure: table.sure.unwrap_or(SureName::Nominal).sure(setting.limit),
            wrist: table.least_wrist_deg.unwrap_or(USUAL_WRIST_DEG).to_radians(),
        })
    }

    fn sites(&self, turn: ToolTurn) -> Vec<Site<'_>> {
        let setting = &self.ask.setting;
        if self.table.fixture.is_empty() {
            return vec![Site {
                name: None,
                freedom: Freedom::new(setting, turn, &self.table),
            }];
        }
        let at = |fixture: &'_ FixtureTable| {
            let (plane, tilt) = plane_of(fixture, setting);
            let there = Setting {
                plane,
                tilt,
                ..setting.clone()
            };
            Freedom::new(&there, turn, &self.table)
        };
        let sites = self.table.fixture.iter().map(|fixture| Site {
            name: Some(&fixture.name),
            freedom: at(fixture),
        });
        sites.collect()
    }
}

/// A path, or a set of holes with what each may be turned by.
type Placed<'a> = (&'a PathAsk, Option<&'a PostureSearch>);

/// The ask that is placed: which one, its name, and what it is about.
fn chosen<'a>(study: &'a Study, wanted: Option<&str>) -> Result<(usize, (&'a str, Placed<'a>)), StudyError> {
    let all: Vec<(usize, (&str, Placed<'_>))> = study
        .asks
        .iter()
        .enumerate()
        .filter_map(|(index, ask)| {
            let about: Placed<'_> = match &ask.subject {
                Subject::Path(path) => (path, None),
                Subject::Holes(holes) => (&holes.path, Some(&holes.search)),
                _ => return None,
            };
            Some((index, (ask.name.as_str(), about)))
        })
        .collect();
    let names = || {
        let names = all.iter().map(|(_, (name, _))| format!("`{name}`"));
        names.collect::<Vec<_>>().join(", ")
    };
    match (wanted, &all[..]) {
        (None, []) => Err(StudyError::value(
            "the study asks for no path that could be placed",
            "[[ask]] kind = \"path\" with a program or a shape, or kind = \"holes\"",
        )),
        (None, [one]) => Ok(*one),
        (None, _) => {
            let message = format!("the study has several paths: {}", names());
            Err(StudyError::value(message, "name one: --ask NAME, or `place.ask`"))
        }
        (Some(wanted), _) => all
            .iter()
            .find(|(_, (name, _))| *name == wanted)
            .copied()
            .ok_or_else(|| {
                let message = format!("the study has no path called `{wanted}`");
                StudyError::value(message, format!("its paths: {}", names()))
            }),
    }
}

/// The plane in this fixture, base, and its tilt where it is told by one.
fn plane_of(fixture: &FixtureTable, setting: &Setting) -> (Plane, Option<f64>) {
    let centre = Vector3::from(fixture.centre_mm) * 1e-3;
    let counted_from_part = match fixture.rotation_deg {
        Some(angles) => from_xyz_and_fixed_angles(centre, Vector3::from(angles).map(f64::to_radians)),
        None => {
            let tilt = fixture.tilt_deg.unwrap_or(0.0).to_radians();
            Plane::tilted(centre.into(), tilt).base_from_part
        }
    };
    let plane = Plane {
        base_from_part: setting.base_from_counted * counted_from_part,
    };
    let tilt = fixture
        .rotation_deg
        .is_none()
        .then(|| fixture.tilt_deg.unwrap_or(0.0).to_radians());
    (plane, tilt)
}

/// All that searches of one path share.
struct Prepared<'a> {
    of: &'a Placing<'a>,
    question: &'a Question<'a>,
    /// Some points of the path, and all.
    paths: [&'a PlacedPath; 2],
    sites: &'a [Site<'a>],
    effort: Effort,
    watch: Watch<'a>,
    told: &'a dyn Fn(&str),
}

impl Prepared<'_> {
    fn searched<'s>(&'s self, freedom: &'s Freedom, goal: PlacementGoal, effort: Effort) -> Searched<'s> {
        let of = |path| Placeable {
            question: self.question,
            path,
            goal,
        };
        Searched {
            some: of(self.paths[0]),
            all: of(self.paths[1]),
            freedom,
            effort,
            seed: self.of.seed,
        }
    }

    /// The best place of all sites; `also` is one more place to start from. Rounds are kept under `name`.
    fn best(
        &self,
        (goal, effort): (PlacementGoal, Effort),
        name: &str,
        also: Option<&Best>,
        journal: &mut Journal,
    ) -> Result<Best, StudyError> {
        let mut best: Option<Best> = None;
        for (site, of) in self.sites.iter().enumerate() {
            let searched = self.searched(&of.freedom, goal, effort);
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
                spots.push(searched.judged(at)?);
                self.tell(&spots, goal.sure);
            }
            if let Some(also) = also {
                spots.push(searched.judged(also)?);
            }
            let Some(valley) = the_best(spots) else { continue };
            let floor = journal.round(&format!("{name}site {site} floor"), || {
                Ok(searched.floor(&valley.at, self.watch)?.at)
            })?;
            let spot = searched.judged(floor)?;
            if best
                .as_ref()
                .is_none_or(|best| spot.merit.beats(&best.spot.merit))
            {
                best = Some(Best { site, spot });
            }
        }
        best.ok_or_else(|| {
            StudyError::value("there is no place to look at", "free a degree, or name fixtures")
        })
    }

    fn tell(&self, spots: &[Spot], sure: Sure) {
        let merit = the_best(spots.to_vec()).map_or(Merit::NONE, |spot| spot.merit);
        (self.told)(&match merit.lost {
            0 if matches!(sure, Sure::WithinLimit(_)) => {
                format!("best so far {:.2} sigma from the limit", merit.cost)
            }
            0 => format!("best so far {:.2} µm", merit.cost * 1e6),
            lost => format!("best so far loses {lost} points"),
        });
    }

    /// The best place and what grids say of it; a better one that they show is gone down from.
    fn certified(
        &self,
        mut best: Best,
        goal: PlacementGoal,
        journal: &mut Journal,
    ) -> Result<(Best, CertificateAnswer), StudyError> {
        let mut tried = 0;
        loop {
            let (certificate, better) = self.certificate(&best, goal)?;
            let Some(better) = better else {
                return Ok((best, certificate));
            };
            best = better;
            if tried == MOST_TRIES {
                return Ok((best, certificate));
            }
            let searched = self.searched(&self.sites[best.site].freedom, goal, self.effort);
            let floor = journal.round(&format!("better {tried}"), || {
                Ok(searched.floor(&best.spot.at, self.watch)?.at)
            })?;
            let spot = searched.judged(floor)?;
            if spot.merit.beats(&best.spot.merit) {
                best.spot = spot;
            }
            tried += 1;
        }
    }

    /// What the grids of all sites say of `best`, and the best place among them where one is better.
    fn certificate(
        &self,
        best: &Best,
        goal: PlacementGoal,
    ) -> Result<(CertificateAnswer, Option<Best>), StudyError> {
        let here = self.searched(&self.sites[best.site].freedom, goal, self.effort);
        let (near, better) = here.near_grid(&best.spot, self.watch)?;
        let mut all = vec![(best.site, better)];
        let mut wide: Option<GridAnswer> = None;
        for (site, of) in self.sites.iter().enumerate() {
            let searched = self.searched(&of.freedom, goal, self.effort);
            let (told, better) = searched.wide_grid(&best.spot.merit, self.watch)?;
            wide = Some(match wide {
                Some(so_far) => so_far.and(told),
                None => told,
            });
            all.push((site, better));
        }
        let better = all
            .into_iter()
            .filter_map(|(site, spot)| Some(Best { site, spot: spot? }))
            .reduce(|a, b| if b.spot.merit.beats(&a.spot.merit) { b } else { a });
        let wide = wide.unwrap_or_else(|| near.clone());
        Ok((CertificateAnswer { near, wide }, better))
    }

    /// The best place for each margin, from the least on; where none holds the path the front ends.
    fn front(
        &self,
        goal: PlacementGoal,
        best: &Best,
        journal: &mut Journal,
    ) -> Result<Vec<(f64, Best)>, StudyError> {
        let mut front: Vec<(f64, Best)> = Vec::new();
        if best.spot.merit.lost > 0 {
            return Ok(front);
        }
        front.push((goal.margin, best.clone()));
        for margin in MARGINS_DEG.map(f64::to_radians) {
            if margin <= goal.margin {
                continue;
            }
            let goal = PlacementGoal { margin, ..goal };
            let effort = self.effort.cheaper();
            let name = format!("margin {:.0} ", margin.to_degrees());
            let also = front.last().map(|(_, best)| best);
            let found = self.best((goal, effort), &name, also, journal)?;
            if found.spot.merit.lost > 0 {
                break;
            }
            front.push((margin, found));
        }
        // What keeps a wide margin keeps a narrow one too.
        for index in (1..front.len()).rev() {
            if front[index].1.spot.merit.beats(&front[index - 1].1.spot.merit) {
                front[index - 1].1 = front[index].1.clone();
            }
        }
        Ok(front)
    }

    /// Of all that goes into the search.
    fn fingerprint(&self, goal: &PlacementGoal) -> u64 {
        let mut print = Fingerprint::new();
        let of = self.of;
        let (robot, setting) = (&of.study.robot.robot, &of.ask.setting);
        let freedoms: Vec<&Freedom> = self.sites.iter().map(|site| &site.freedom).collect();
        print.take(format!("{robot:?}{setting:?}{goal:?}{freedoms:?}{:?}", self.effort).as_bytes());
        print.take(&of.seed.to_le_bytes());
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
        .reduce(|best, spot| if spot.merit.beats(&best.merit) { spot } else { best })
}

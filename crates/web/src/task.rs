//! The kinds of jobs, each equal to a command.
//!
//! | kind | as the command | results in |
//! |---|---|---|
//! | `run` | `armill run` | `out` |
//! | `posture` | `armill posture` | `posture` |
//! | `place` | `armill place`; continues where it was stopped | `place` |
//! | `identify` | `armill identify` | `identify` |

use std::path::{Path, PathBuf};

use armill_core::nalgebra::Vector3;
use armill_formats::file::{ResultFolder, Writer};
use armill_formats::input::{self, Inputs};
use armill_formats::measurement::load_tests;
use armill_measure::identify::robot_file::robot_file;
use armill_measure::identify::{self, PointsModel, PriorModel, Question, Units};
use armill_plan::place::{Journal, PlacementSearch};
use armill_study::answer::answer;
use armill_study::file::placement::PlaceTable;
use armill_study::file::resolve::Parsed;
use armill_study::input::posture_search::SearchTable;
use armill_study::live::StudyText;
use armill_study::output::{self, OutputOptions};
use armill_study::run::{point_count, run};
use armill_study::studies::FoundStudy;
use armill_study::{Study, StudyError, robots};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::files::inside;
use crate::job::Job;

/// The task of a job.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Task {
    /// Every analysis of the study.
    Run {
        /// The text of the study.
        text: String,
        /// Options of the run.
        #[serde(default)]
        options: RunOptions,
    },
    /// The best spin of the tool and branch along its paths.
    Posture {
        /// The text of the study.
        text: String,
        /// The options of the search; those of the study if left out.
        options: Option<SearchTable>,
    },
    /// The best place of the part.
    Place {
        /// The text of the study.
        text: String,
        /// Options of the placement.
        #[serde(default)]
        options: Box<PlaceOptions>,
    },
    /// Identification of compliances from load tests.
    Identify {
        /// The text of the study, whose robot was loaded.
        text: String,
        /// Options of the identification.
        options: IdentifyOptions,
    },
}

/// Options of a run.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunOptions {
    /// Only this analysis.
    pub analysis: Option<String>,
    /// Tables only: no pictures, no report.
    #[serde(default)]
    pub no_pictures: bool,
}

/// Options of a placement.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaceOptions {
    /// As `[place]` of a study, whose values are used for what is left out.
    #[serde(default)]
    pub place: PlaceTable,
    /// Seed of the search; 1 if left out.
    pub seed: Option<u32>,
}

/// Options of an identification.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct IdentifyOptions {
    /// The table of tests, a file of the folder.
    pub tests: String,
    /// Groups of unknowns with `+` between; `drives+bending+base` if left out.
    pub unknowns: Option<String>,
    /// Model of the two points: `known`, `common` or `separate`; `known` if left out.
    #[serde(default)]
    pub points: PointsName,
    /// Standard uncertainty of points that are not known.
    pub point_u_mm: Option<f64>,
    /// Default point of force and displacement, flange frame.
    pub tool_mm: Option<[f64; 3]>,
}

/// Model of the two points.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PointsName {
    /// Both, as given.
    #[default]
    Known,
    /// Both have the same offset.
    Common,
    /// Each has its own offset.
    Separate,
}

/// Standard uncertainty of points that are not known, mm, as the command has it.
const USUAL_POINT_U_MM: f64 = 200.0;
/// Groups of unknowns, as the command has them.
const USUAL_UNKNOWNS: &str = "drives+bending+base";

/// The result of a job: its answer as JSON, and its files.
pub(crate) type Outcome = (String, Vec<PathBuf>);

impl Task {
    /// Its name.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Task::Run { .. } => "run",
            Task::Posture { .. } => "posture",
            Task::Place { .. } => "place",
            Task::Identify { .. } => "identify",
        }
    }

    /// The text of its study.
    pub(crate) fn text(&self) -> &str {
        match self {
            Task::Run { text, .. }
            | Task::Posture { text, .. }
            | Task::Place { text, .. }
            | Task::Identify { text, .. } => text,
        }
    }
}

/// The folder `name` of `root` for what this task writes.
///
/// # Errors
/// A folder where nothing can be written, where another run writes, or that leads out of `root`.
fn folder(task: &Task, root: &Path, name: &str) -> Result<ResultFolder, StudyError> {
    Ok(Writer::new(task.kind(), false).folder_in(root, name)?)
}

impl Job {
    /// Runs the task; results go into folders of `root`.
    ///
    /// # Errors
    /// As the command of that name.
    pub(crate) fn outcome(&self, shown: &str, root: &Path) -> Result<Outcome, StudyError> {
        Inputs::default().during(|| self.done(shown, root))
    }

    fn done(&self, shown: &str, root: &Path) -> Result<Outcome, StudyError> {
        let found = |text: &str| FoundStudy {
            shown: shown.to_owned(),
            folder: root.to_owned(),
            bytes: text.as_bytes().to_vec(),
        };
        match self.task() {
            Task::Run { text, options } => {
                let found = found(text);
                let text = StudyText {
                    shown,
                    folder: root,
                    bytes: &found.bytes,
                };
                let requested = if options.no_pictures {
                    OutputOptions::TABLES
                } else {
                    OutputOptions::USUAL
                };
                let study = text.study(options.analysis.as_deref())?;
                self.results(&study, &folder(self.task(), root, "out")?, requested)
            }
            Task::Posture { text, options } => {
                let mut study = found(text).read()?;
                study.search_postures(options.as_ref())?;
                self.results(
                    &study,
                    &folder(self.task(), root, "posture")?,
                    OutputOptions::USUAL,
                )
            }
            Task::Place { text, options } => {
                self.place(&found(text), options, &folder(self.task(), root, "place")?)
            }
            Task::Identify { text, options } => self.identify(&found(text), options, root),
        }
    }

    /// Runs a study and writes its results.
    fn results(
        &self,
        study: &Study,
        out: &ResultFolder,
        requested: OutputOptions<'_>,
    ) -> Result<Outcome, StudyError> {
        output::allow(study, (out, requested))?;
        let done = self.counted(point_count(study), |watch| run(study, watch))?;
        let answer = answer(study, &done);
        let files = output::write(study, &done, &answer, (out, requested), &|name| self.report(name))?;
        Ok((output::json(&answer)?, files))
    }

    /// Searches a place, and runs the path there.
    fn place(
        &self,
        found: &FoundStudy,
        options: &PlaceOptions,
        out: &ResultFolder,
    ) -> Result<Outcome, StudyError> {
        let study = found.read()?;
        let placing = PlacementSearch::new(
            &study,
            options.place.clone(),
            u64::from(options.seed.unwrap_or(1)),
        )?;
        let mut journal = Journal::kept_in(out);
        let placed = self.counted(placing.place_count(), |watch| {
            placing.search(&mut journal, watch, &|best| self.report(best))
        })?;
        let json = serde_json::to_string_pretty(&placed.answer)? + "\n";
        out.write("placement.json", json.as_bytes())?;
        output::write_pictures(&placed.pictures, out)?;
        let opening = placed.opening();
        let requested = OutputOptions {
            opening: Some(&opening),
            ..OutputOptions::USUAL
        };
        let (_, mut files) = self.results(&placed.study(found)?, out, requested)?;
        let pictures = placed
            .pictures
            .iter()
            .map(|picture| format!("{}.svg", picture.name));
        let names = std::iter::once("placement.json".to_owned()).chain(pictures);
        files.extend(names.map(|name| out.path().join(name)));
        self.report(&placed.answer.sentences().join(" "));
        Ok((json, files))
    }

    /// Identifies springs, and writes the robot file with them.
    fn identify(
        &self,
        found: &FoundStudy,
        options: &IdentifyOptions,
        root: &Path,
    ) -> Result<Outcome, StudyError> {
        let out = folder(self.task(), root, "identify")?;
        let name = Parsed::of(&found.shown, &found.bytes)?.file.robot;
        let robot = robots::find(&name, root)?;
        let point_u_mm = options.point_u_mm.unwrap_or(USUAL_POINT_U_MM);
        let tool_mm = Vector3::from(options.tool_mm.unwrap_or_default());
        if !(point_u_mm > 0.0 && point_u_mm < 1e6 && tool_mm.amax() < 1e6) {
            return Err(StudyError::value(
                "point_u_mm or tool_mm is outside 0 to 1e6 mm",
                "lengths in mm",
            ));
        }
        let question = Question {
            unknowns: options
                .unknowns
                .clone()
                .unwrap_or_else(|| USUAL_UNKNOWNS.to_owned()),
            points: match options.points {
                PointsName::Known => PointsModel::Known,
                PointsName::Common => PointsModel::Common,
                PointsName::Separate => PointsModel::Separate,
            },
            point_u: point_u_mm * 1e-3,
            prior: PriorModel::Typical,
            tool_point: tool_mm * 1e-3,
            units: Units::Checked,
        };
        let file = inside(root, &options.tests).map_err(|_| {
            StudyError::value(
                format!("the file `{}` does not exist", options.tests),
                "upload it first",
            )
        })?;
        let bytes = input::read(&file).map_err(|error| {
            StudyError::value(
                format!("cannot read {}: {error}", options.tests),
                "a table of load tests, CSV",
            )
        })?;
        let tests = load_tests::read(
            &options.tests,
            bytes.as_slice(),
            &robot.robot,
            question.tool_point,
        )?;
        let answer = identify::answer(&robot.robot, &tests, &question)?;
        let named = if root.join(&name).is_file() {
            root.join(&name).display().to_string()
        } else {
            name
        };
        let [path, text] = robots::text_of(&named, &robot)?;
        let written = robot_file(&robot.robot, [&path, &text], &answer, &options.tests)?;
        out.write("robot.toml", written.as_bytes())?;
        out.finish()?;
        Ok((
            serde_json::to_string_pretty(&answer)?,
            vec![out.path().join("robot.toml")],
        ))
    }
}

//! Executes a job: does what its task says, on the threads of the current pool.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use armill_core::nalgebra::Vector3;
use armill_core::units::from_mm;
use armill_formats::file::{ResultFolder, Writer};
use armill_formats::input::{self, Inputs};
use armill_formats::measurement::load_tests;
use armill_measure::identify::robot_file::robot_file;
use armill_measure::identify::{self, PointsModel, PriorModel, Question, Units};
use armill_plan::place::{Journal, PlacementSearch};
use armill_study::answer::answer;
use armill_study::file::resolve::Parsed;
use armill_study::live::StudyText;
use armill_study::output::{self, OutputOptions, StudyResults};
use armill_study::run::{point_count, run};
use armill_study::studies::FoundStudy;
use armill_study::{Study, StudyError, robots};

use crate::folder::inside;
use crate::job::Job;
use crate::task::{IdentifyOptions, PlaceOptions, PointsName, Task};

/// Standard uncertainty of points that are not known, mm, as the command has it.
const USUAL_POINT_U_MM: f64 = 200.0;
/// Groups of unknowns, as the command has them.
const USUAL_UNKNOWNS: &str = "drives+bending+base";

/// The result of a job: its answer as JSON, and its files.
type Outcome = (String, Vec<PathBuf>);

/// Executes a job, unless it was cancelled while it waited; results go into folders of `root`.
pub(crate) fn execute(job: &Job, shown: &str, root: &Path) {
    if !job.begin() {
        return;
    }
    let work = || Inputs::default().during(|| job.done(shown, root));
    let outcome = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
        Err(StudyError::value(
            "internal error of armill: the computation ended early",
            "",
        ))
    });
    job.end(outcome.map(|(answer, files)| {
        let below = |file: &PathBuf| Some(file.strip_prefix(root).ok()?.display().to_string());
        (answer, files.iter().filter_map(below).collect())
    }));
}

/// The folder `name` of `root` for what this task writes.
///
/// # Errors
/// A folder where nothing can be written, where another run writes, or that leads out of `root`.
fn folder(task: &Task, root: &Path, name: &str) -> Result<ResultFolder, StudyError> {
    Ok(Writer::new(task.kind(), false).folder_in(root, name)?)
}

impl Job {
    /// Does the task; results go into folders of `root`.
    ///
    /// # Errors
    /// As the command of that name.
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
        output::allow(study, out, requested)?;
        let done = self.counted(point_count(study), |watch| run(study, watch))?;
        let answer = answer(study, &done);
        let results = StudyResults {
            study,
            done: &done,
            answer: &answer,
        };
        let files = output::write(results, out, requested, &|name| self.report(name))?;
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
            point_u: from_mm(point_u_mm),
            prior: PriorModel::Typical,
            tool_point: from_mm(tool_mm),
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

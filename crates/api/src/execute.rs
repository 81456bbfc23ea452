//! Executes a job: does what its task says, on the threads of the current pool.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use armill_core::nalgebra::Vector3;
use armill_core::optimize::Compensation;
use armill_core::units::from_mm;
use armill_formats::file::{ResultFolder, Writer};
use armill_formats::input::{self, Inputs};
use armill_formats::language::Language;
use armill_formats::measurement::load_tests;
use armill_measure::identify::robot_file::robot_file;
use armill_measure::identify::{self, PointsModel, PriorModel, Question, Units};
use armill_plan::Measure;
use armill_plan::advise::{advise, progress_count, search_of_postures};
use armill_plan::compensate::in_place::allow_programs;
use armill_plan::compensate::{self, Commanded, CompensationAnswer};
use armill_plan::place::{Journal, PlacementSearch};
use armill_study::answer::{PathAnswer, StudyAnswer, answer};
use armill_study::file::resolve::Parsed;
use armill_study::file_names::slug;
use armill_study::live::{ChangedValue, StudyText};
use armill_study::output::{self, Opening, OutputOptions, StudyResults};
use armill_study::program_out::{ProgramSettings, own_language};
use armill_study::run::{point_count, run};
use armill_study::studies::FoundStudy;
use armill_study::{Study, StudyError, robots};

use crate::folder::inside;
use crate::job::{Done, Job};
use crate::task::{CompensateOptions, IdentifyOptions, PlaceOptions, PointsName, Task};

/// Standard uncertainty of points that are not known, mm, as the command has it.
const USUAL_POINT_U_MM: f64 = 200.0;
/// Groups of unknowns, as the command has them.
const USUAL_UNKNOWNS: &str = "drives+bending+base";

/// The result of a job.
type Outcome = Done<PathBuf>;

/// Executes a job, unless it was cancelled while it waited; results go into folders of `root`.
pub fn execute(job: &Job, shown: &str, root: &Path) {
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
    let below = |file: &PathBuf| Some(file.strip_prefix(root).ok()?.display().to_string());
    job.end(outcome.map(|done| Done {
        answer: done.answer,
        measures: done.measures,
        files: done.files.iter().filter_map(below).collect(),
    }));
}

/// The folder `name` of `root` for what this task writes.
///
/// # Errors
/// A folder where nothing can be written, where another run writes, or that leads out of `root`.
fn folder(task: &Task, root: &Path, name: &str) -> Result<ResultFolder, StudyError> {
    Ok(Writer::new(task.kind(), false).folder_in(root, name)?)
}

/// Writes these files into a folder of results, and returns their paths.
///
/// # Errors
/// A file that cannot be written, or that is not of an earlier run.
fn written<B: AsRef<[u8]>>(folder: &ResultFolder, files: &[(String, B)]) -> Result<Vec<PathBuf>, StudyError> {
    folder.allow(files.iter().map(|(name, _)| name.as_str()))?;
    for (name, bytes) in files {
        folder.write(name, bytes.as_ref())?;
    }
    folder.finish()?;
    Ok(files.iter().map(|(name, _)| folder.path().join(name)).collect())
}

/// The program that is requested.
///
/// # Errors
/// No language of that extension; a robot whose language is not known; an implausible feed.
fn program_settings(study: &Study, options: &CompensateOptions) -> Result<ProgramSettings, StudyError> {
    let language = match &options.extension {
        Some(extension) => Language::of_ending(extension).ok_or_else(|| {
            let message = format!("`{extension}` is not the extension of a robot language");
            StudyError::value(message, "src, mod, jbi, ls, script or pjx")
        })?,
        None => own_language(&study.robot).ok_or_else(|| {
            let message = format!(
                "the language of the controllers of {} is not known",
                study.robot.title
            );
            StudyError::value(message, "select one: src, mod, jbi, ls, script or pjx")
        })?,
    };
    let feed = options.feed_mm_per_min;
    if feed.is_some_and(|feed| !(1.0..=1e6).contains(&feed)) {
        return Err(StudyError::value(
            "feed_mm_per_min is outside 1 to 1e6 mm/min",
            "the speed of the tool in the cut",
        ));
    }
    let name = options.analysis.as_deref().unwrap_or("path");
    Ok(ProgramSettings {
        feed: feed.map(|feed| from_mm(feed) / 60.0),
        ..ProgramSettings::usual(language, &slug(name))
    })
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
                let out = folder(self.task(), root, "out")?;
                Ok(self.results(&study, &out, requested)?.1)
            }
            Task::Posture { text, options } => {
                let mut study = found(text).read()?;
                let searches = study.paths(None).any(|(_, path)| path.setting.search.is_some());
                study.search_postures(options.as_ref())?;
                let out = folder(self.task(), root, "posture")?;
                let (answer, done) = self.results(&study, &out, OutputOptions::USUAL)?;
                let applied = |path: &PathAnswer| path.search.as_ref().is_some_and(|search| search.applied);
                let first = answer.paths.iter().find(|path| applied(path));
                let measure = first.filter(|_| !searches).map(|path| Measure {
                    measure: "spin",
                    sentence: format!("Search spin and branch along {} on every run", path.name),
                    analysis: Some(path.name.clone()),
                    changes: vec![search_of_postures()],
                });
                Ok(Done {
                    measures: measure.into_iter().collect(),
                    ..done
                })
            }
            Task::Place { text, options } => {
                self.place(&found(text), options, &folder(self.task(), root, "place")?)
            }
            Task::Advise { text, options } => self.advise(&found(text), options, root),
            Task::Compensate { text, options } => self.compensate(&found(text), options, root),
            Task::Identify { text, options } => self.identify(&found(text), options, root),
        }
    }

    /// Runs a study and writes its results.
    fn results(
        &self,
        study: &Study,
        out: &ResultFolder,
        requested: OutputOptions<'_>,
    ) -> Result<(StudyAnswer, Outcome), StudyError> {
        output::allow(study, out, requested)?;
        let done = self.counted(point_count(study), |watch| run(study, watch))?;
        let answer = answer(study, &done);
        let results = StudyResults {
            study,
            done: &done,
            answer: &answer,
        };
        let files = output::write(results, out, requested, &|name| self.report(name))?;
        let done = Done {
            answer: output::json(&answer)?,
            measures: Vec::new(),
            files,
        };
        Ok((answer, done))
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
        let mut files = self.results(&placed.study(found)?, out, requested)?.1.files;
        let pictures = placed
            .pictures
            .iter()
            .map(|picture| format!("{}.svg", picture.name));
        let names = std::iter::once("placement.json".to_owned()).chain(pictures);
        files.extend(names.map(|name| out.path().join(name)));
        let sentence = placed.answer.sentences().join(" ");
        self.report(&sentence);
        let placement = Measure {
            measure: "placement",
            sentence,
            analysis: Some(placed.answer.analysis.clone()),
            changes: placed.changes(found)?,
        };
        Ok(Done {
            answer: json,
            measures: Some(placement)
                .filter(|_| placed.answer.is_improvement)
                .into_iter()
                .collect(),
            files,
        })
    }

    /// Searches measures for a path, and writes the path with them, the study as advised and the path to command.
    fn advise(&self, found: &FoundStudy, options: &PlaceOptions, root: &Path) -> Result<Outcome, StudyError> {
        let out = folder(self.task(), root, "advice")?;
        let study = found.read()?;
        let seed = u64::from(options.seed.unwrap_or(1));
        let placing = PlacementSearch::new(&study, options.place.clone(), seed)?.brief_if_long();
        let mut journal = Journal::kept_in(&out);
        let advice = self.counted(progress_count(&placing), |watch| {
            advise(found, &placing, &mut journal, watch, &|step| self.report(step))
        })?;
        let json = serde_json::to_string_pretty(&advice.answer)? + "\n";
        out.write("advice.json", json.as_bytes())?;
        output::write_pictures(&advice.pictures, &out)?;
        let opening = Opening {
            heading: "Recommended measures",
            sentences: advice.answer.advice.clone(),
            pictures: advice.pictures.clone(),
        };
        let requested = OutputOptions {
            opening: Some(&opening),
            ..OutputOptions::USUAL
        };
        let mut files = self.results(&advice.study, &out, requested)?.1.files;
        files.push(out.path().join("advice.json"));
        let advised = folder(self.task(), root, "advised")?;
        files.extend(written(&advised, &advice.files.files(advised.path())?)?);
        Ok(Done {
            answer: json,
            measures: advice.measures,
            files,
        })
    }

    /// Writes the paths to command, and a robot program along one of them.
    fn compensate(
        &self,
        found: &FoundStudy,
        options: &CompensateOptions,
        root: &Path,
    ) -> Result<Outcome, StudyError> {
        let out = folder(self.task(), root, "compensated")?;
        let study = found.read()?;
        let name = options.analysis.as_deref();
        allow_programs(&study, name, &out)?;
        let compensation = match options.nominal {
            true => Compensation::NONE,
            false => Compensation::USUAL,
        };
        let commanded = self.counted(compensate::point_count(&study, name), |watch| {
            compensate::compensate(&study, name, compensation, watch)
        })?;
        let mut files = written(
            &out,
            &commanded.iter().flat_map(Commanded::files).collect::<Vec<_>>(),
        )?;
        let mut notes = Vec::new();
        if options.program {
            let program = Commanded::only_program(&commanded, &study, &program_settings(&study, options)?)?;
            let programs = folder(self.task(), root, "programs")?;
            files.extend(written(&programs, &program.files)?);
            notes = program.notes;
        }
        let answer = CompensationAnswer::of(&study, &commanded);
        let mut json = serde_json::to_value(&answer)?;
        json["sentences"] = answer.sentences().into();
        json["program_notes"] = notes.into();
        Ok(Done {
            answer: json.to_string(),
            measures: Vec::new(),
            files,
        })
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
        let file = out.path().join("robot.toml");
        let shown = file.strip_prefix(root).unwrap_or(&file).display().to_string();
        let with_springs = Measure {
            measure: "robot",
            sentence: format!("Use the identified compliances: {shown}"),
            analysis: None,
            changes: vec![ChangedValue {
                key: "robot".to_owned(),
                value: shown.into(),
                whole: true,
            }],
        };
        Ok(Done {
            answer: serde_json::to_string_pretty(&answer)?,
            measures: vec![with_springs],
            files: vec![file],
        })
    }
}

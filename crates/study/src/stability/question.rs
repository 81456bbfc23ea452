//! What is evaluated: the cut of a path of a study at a spindle speed, and modes at the tip.

use armill_core::load::{CuttingError, Milling};
use armill_core::stability::NamedMode;
use armill_core::units::from_mm;
use armill_formats::modal::ModalData;

use super::arm_modes::{ArmPosture, arm_modes};
use crate::analysis::path::Cut;
use crate::input::vibration::{CutAtPoint, deepest_sought};
use crate::{Study, StudyError};

/// Options in place of values of the study; SI.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Spindle speed, rad/s.
    pub spindle: Option<f64>,
    /// Feed, m/s.
    pub feed: Option<f64>,
    /// Axial depth of cut, m.
    pub depth: Option<f64>,
    /// Range of spindle speeds of the lobes, rad/s; half to twice the programmed speed if left out.
    pub speeds: Option<[f64; 2]>,
    /// Deepest limit sought, m; twice the diameter of the cutter if left out, and at least three times the depth.
    pub deepest: Option<f64>,
}

/// A cut and the modes at its tool; SI.
#[derive(Clone, Debug)]
pub struct Question {
    /// Name of the path.
    pub path: String,
    /// The cut at the programmed depth and feed.
    pub milling: Milling,
    /// Spindle speed, rad/s.
    pub spindle: f64,
    /// Range of the lobes, rad/s.
    pub speeds: [f64; 2],
    /// Deepest limit sought, m.
    pub deepest: f64,
    /// The modes, in the feed frame.
    pub modes: Vec<NamedMode>,
    /// What they are and where they come from.
    pub modes_from: String,
    /// Notes for the user on the cut and the modes.
    pub remarks: Vec<String>,
}

/// Lowest and highest speed of the lobes over the programmed one.
const SPEEDS: [f64; 2] = [0.5, 2.0];

/// Modes at the tip, and where they come from.
#[derive(Clone, Debug, Default)]
pub struct GivenModes {
    modes: Vec<NamedMode>,
    from: Vec<String>,
    remarks: Vec<String>,
}

impl GivenModes {
    /// With those of this file, if there is one.
    #[must_use]
    pub fn and(mut self, data: Option<ModalData>) -> GivenModes {
        if let Some(data) = data {
            self.from.push(format!("{} ({})", data.name, data.source));
            self.modes.extend(data.modes);
            self.remarks.extend(data.note);
        }
        self
    }
}

impl Question {
    /// The cut of the path called `name`, or of the first path that has one, with these modes and those of the arm in a posture.
    ///
    /// # Errors
    /// Neither modes nor posture; what [`arm_modes`] refuses; no such path; a path without a cut; a spindle speed or feed that neither the study nor an option gives; values outside what can be cut.
    pub fn of_study(
        study: &Study,
        name: Option<&str>,
        (data, posture): (Option<ModalData>, Option<&ArmPosture>),
        options: &Options,
    ) -> Result<Question, StudyError> {
        let mut found = study
            .paths(name)
            .filter_map(|(name, path)| path.cut.as_ref().map(|cut| (name, path, cut)));
        let Some((path, analysis, cut)) = found.next() else {
            return Err(match name {
                Some(name) => StudyError::value(
                    format!("the study has no path `{name}` with a cut"),
                    "give the name of a path analysis, and [cut] with cutter, material and depths",
                ),
                None => StudyError::value(
                    "no path of the study has a cut",
                    "give [cut] with cutter, material and depths, and a path that it applies to",
                ),
            });
        };
        let mut given = GivenModes::default();
        if let Some(posture) = posture {
            given.modes.extend(arm_modes(study, analysis, posture)?);
            given
                .from
                .push(format!("{} in the given posture", study.robot.robot.name()));
        }
        Question::of_cut(path, cut, given.and(data), options)
    }

    /// The cut at a point of the analysis `name`, with these modes (feed frame), which are from `modes_from`.
    pub fn at_point(name: &str, cut: &CutAtPoint, modes: Vec<NamedMode>, modes_from: String) -> Question {
        Question {
            path: name.to_owned(),
            milling: cut.milling,
            spindle: cut.spindle,
            speeds: SPEEDS.map(|part| part * cut.spindle),
            deepest: cut.deepest_sought(),
            modes,
            modes_from,
            remarks: Vec::new(),
        }
    }

    /// A cut called `name`, with these modes.
    ///
    /// # Errors
    /// No modes; a spindle speed or feed that neither the cut nor an option gives; values outside what can be cut.
    pub fn of_cut(
        name: &str,
        cut: &Cut,
        given: GivenModes,
        options: &Options,
    ) -> Result<Question, StudyError> {
        let missing = |what: &str, option: &str, key: &str| {
            StudyError::value(
                format!("the {what} of the cut of `{name}` is not known"),
                format!("give {option}, or `{key}` in [cut]"),
            )
        };
        let spindle = options
            .spindle
            .or(cut.cutting.spindle)
            .ok_or_else(|| missing("spindle speed", "--spindle-rpm", "spindle_rpm"))?;
        let feed = options
            .feed
            .or(cut.cutting.feed)
            .ok_or_else(|| missing("feed", "--feed-mm-per-min", "feed_mm_per_min"))?;
        if given.modes.is_empty() {
            return Err(StudyError::value(
                "no modes are given",
                "give --modes FILE with modal data of the tool, or --joints-deg for those of an arm with masses",
            ));
        }
        let milling = cut.milling([spindle, feed], options.depth).map_err(of_cut)?;
        Ok(Question {
            path: name.to_owned(),
            spindle,
            speeds: options.speeds.unwrap_or(SPEEDS.map(|part| part * spindle)),
            deepest: options.deepest.unwrap_or_else(|| deepest_sought(&milling)),
            milling,
            modes: given.modes,
            modes_from: given.from.join(", "),
            remarks: cut.remarks.iter().cloned().chain(given.remarks).collect(),
        })
    }
}

/// The error of a cut, as one of the study.
pub(super) fn of_cut(error: CuttingError) -> StudyError {
    StudyError::value(
        error.to_string(),
        "check depth, feed and spindle speed of the cut",
    )
}

/// Least feed per tooth for which a law of a power of the chip is differentiated, m.
pub(super) fn is_thin(milling: &Milling) -> bool {
    milling.cut().feed < from_mm(THIN_MM)
}

/// Chip thickness below which edges plough rather than cut, mm.
const THIN_MM: f64 = 0.005;

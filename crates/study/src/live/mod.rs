//! What does a page that shows a study while it is being written ask for, beside whole runs?
//!
//! The text is the page's, not that of the disk; the files that it names are looked for in the folder of the study. An ask
//! is answered alone: problems of others are not looked for, and nothing of them is computed.
//!
//! | file | question |
//! |---|---|
//! | `outline` | what is in this text, and what is wrong with it? |
//! | `values` | which settings does an ask resolve to? |
//! | `view` | all that is shown of an ask once a value has changed |
//! | `tables` | which values does the text give, for fields to be filled with? |
//! | `answered` | what does `armill run` say of it: answer, table, pictures? |
//! | `posture` | how does the arm stand at one place of it, and what does a load do there? |
//! | `along` | how does the answer hold the tool at a point of a path, or at a hole, and what pushes there? |
//! | `stand` | where are its worst and best points, and how does the arm stand there? |
//! | `scene` | what of it can be drawn in space? |
//! | `meshes` | how does the robot look, where its file names shapes? |
//! | `file_kind` | what does a file seem to be? |
//!
//! ```
//! use std::path::Path;
//! use armill_core::watch::Watch;
//! use armill_study::live::{Text, answer_json};
//!
//! let text = armill_study::studies::find(Path::new("mh12-groove"))?;
//! let text = Text { shown: "study.toml", folder: &text.folder, bytes: &text.bytes };
//! let json = answer_json(text, None, Watch::NONE)?;
//! assert!(json.starts_with("{\"format\":1"));
//! # Ok::<(), armill_study::StudyError>(())
//! ```

mod along;
mod answered;
mod file_kind;
mod meshes;
mod outline;
mod posture;
mod scene;
mod stand;
mod tables;
mod values;
mod view;

pub use answered::{
    PictureAnswer, PicturesAnswer, answer_json, measured_csv, picture_svg, pictures, table_csv,
};
pub use file_kind::{FileKind, kind_of};
pub use meshes::{DrawnMesh, mesh_bytes};
pub use outline::{ChangedAnswer, ChangedValue, OutlineAnswer, OutlinedAnalysis, changed, outline};
pub use posture::{
    CaseAnswer, ChainPosition, DrawnJoint, DrawnPosture, JointLimits, Place, PostureQuestion, PosturesAnswer,
    postures,
};
pub use scene::{BoxInScene, PlateInScene, PointsInScene, SceneAnswer, SectionInScene, scene};
pub use stand::{ExtremesAnswer, Follow, Stand, StandsAnswer};
pub use tables::{TablesAnswer, ValuePlace, tables};
pub use values::{ValuesAnswer, values};
pub use view::{ViewAnswer, view};

use std::path::Path;

use crate::error::StudyError;
use crate::file::resolve::{Parsed, Setting, Study, Subject};

/// The text of a study.
#[derive(Clone, Copy, Debug)]
pub struct Text<'a> {
    /// What errors call it.
    pub shown: &'a str,
    /// Where the files that it names are looked for.
    pub folder: &'a Path,
    /// The text itself.
    pub bytes: &'a [u8],
}

impl Text<'_> {
    /// The study with this ask alone; with all where none is named.
    ///
    /// # Errors
    /// Every problem of the text that concerns it; no ask of that name.
    pub fn study(&self, analysis: Option<&str>) -> Result<Study, StudyError> {
        Parsed::of(self.shown, self.bytes)?.resolve(self.folder, analysis)
    }

    /// The text with its fields, and the study with this ask alone, or with the first.
    fn one_ask(&self, analysis: Option<&str>) -> Result<(Parsed, String, Study), StudyError> {
        let parsed = Parsed::of(self.shown, self.bytes)?;
        // A study without asks means one map.
        let first = || parsed.ask_names().first().cloned().unwrap_or_default();
        let name = analysis.map_or_else(first, str::to_owned);
        let study = parsed.resolve(self.folder, Some(&name))?;
        Ok((parsed, name, study))
    }
}

/// What the points of the only ask of this study share; of sections those of the one with this number, from 0.
fn setting(study: &Study, section: usize) -> Result<&Setting, StudyError> {
    let found = study.analyses.first().and_then(|analysis| match &analysis.subject {
        Subject::Map(sheet) => Some(&sheet.setting),
        Subject::Sections(sections) => sections.get(section).map(|(_, sheet)| &sheet.setting),
        Subject::Volume(setting, _) => Some(setting),
        Subject::Path(path) => Some(&path.setting),
        Subject::Holes(holes) => Some(&holes.path.setting),
    });
    found.ok_or_else(|| StudyError::value(format!("there is no section {section}"), "sections count from 0"))
}

//! Queries of a page that shows a study while it is edited, in addition to complete runs.
//!
//! The text is that of the page, not that of the file; files that it names are searched in the folder of the study. An
//! analysis is evaluated alone: the others are neither checked nor computed.
//!
//! | file | question |
//! |---|---|
//! | `outline` | the contents and the problems of a text |
//! | `values` | the settings that an analysis resolves to |
//! | `process` | the cut or drill of an analysis, and what the program gives in its place |
//! | `view` | everything shown of an analysis after a value has changed |
//! | `tables` | the values of the text, to fill fields with |
//! | `answered` | the results of `armill run`: answer, table, pictures |
//! | `posture` | the postures of the arm at one target, and the deviation under each load case |
//! | `along` | the pose and the load at a point of a path, or at a hole |
//! | `bodies`, `body_mesh` | the bodies of the cell as they are drawn, and their meshes |
//! | `arm` | the worst and best points, and the arm there |
//! | `reachable` | the nearest placement that the robot reaches |
//! | `scene` | what can be drawn in space |
//! | `path_columns` | the points of a path as columns of numbers |
//! | `path_cache` | the last evaluated path, for its columns and poses |
//! | `part_surface` | the surface of a machined part as columns of numbers |
//! | `part_cache` | the machined part of the last path, finished or in process |
//! | `layer` | the values of another quantity that colours show |
//! | `scale` | the levels of the colour scale |
//! | `lines` | the lines of equal deviation of a map |
//! | `lobes` | the stability of the cut at one target, with its lobes |
//! | `spin_map` | a path over its length and the spin of the tool, and the spins that a search finds |
//! | `meshes` | the meshes of the robot, if its file names them |
//! | `file_kind` | the probable kind of a file |
//!
//! ```
//! use std::path::Path;
//! use armill_core::watch::Watch;
//! use armill_study::live::{StudyText, answer_json};
//!
//! let text = armill_study::studies::find(Path::new("mh12-groove"))?;
//! let text = StudyText { shown: "study.toml", folder: &text.folder, bytes: &text.bytes };
//! let json = answer_json(text, None, Watch::NONE)?;
//! assert!(json.starts_with("{\"format\":1"));
//! # Ok::<(), armill_study::StudyError>(())
//! ```

mod along;
mod answered;
mod arm;
mod bodies;
mod body_mesh;
mod file_kind;
mod layer;
mod lines;
mod lobes;
mod meshes;
mod outline;
mod part_cache;
mod part_surface;
mod path_cache;
mod path_columns;
mod posture;
mod process;
mod reachable;
mod scale;
mod scene;
mod spin_map;
mod tables;
mod values;
mod view;

pub use answered::{
    PictureAnswer, PicturesAnswer, answer_json, measured_csv, picture_svg, pictures, table_csv,
};
pub use arm::{ExtremesAnswer, Follow, PoseAtTarget, PoseRequest};
pub use bodies::{BodyInScene, BodyPose, BodyRole, CellInScene, DrawnCell, ShapeInScene, StillBodyInScene};
pub use body_mesh::body_mesh;
pub use file_kind::{FileKind, kind_of};
pub use layer::{LayerAnswer, LayerKey, LayerLine, LayerRequest};
pub use lines::{LevelAnswer, LinesAnswer};
pub use lobes::{LobesAnswer, LobesQuestion};
pub use meshes::{DrawnMesh, mesh_bytes};
pub use outline::{ChangedAnswer, ChangedValue, OutlineAnswer, OutlinedAnalysis, changed, outline};
pub use part_cache::{PartCache, PartSurfaceQuestion};
pub use part_surface::{PartSurfaceHeader, SurfaceColumnInView};
pub use path_cache::PathCache;
pub use path_columns::{OperationInView, PathColumnInView, PathInView};
pub use posture::{
    CaseAnswer, ChainPosition, DrawnJoint, DrawnPosture, JointLimits, PoseTarget, PostureQuestion,
    PosturesAnswer, postures,
};
pub use process::{GivenElsewhere, ProcessValues, process_values};
pub use reachable::{ReachableAnswer, reachable};
pub use scene::{BoxInScene, PlateInScene, PointsInScene, SceneAnswer, SectionInScene, scene};
pub use spin_map::{SpinMapAnswer, SpinSearchAnswer, spin_map, spin_search};
pub use tables::{TablesAnswer, ValueLocation, tables};
pub use values::{ValuesAnswer, values};
pub use view::{ViewAnswer, ViewQuestion, view};

use std::path::Path;

use crate::analysis::table::AnalysisTable;
use crate::error::StudyError;
use crate::file::resolve::{Parsed, Study};
use crate::input::setting::Setting;

/// The text of a study.
#[derive(Clone, Copy, Debug)]
pub struct StudyText<'a> {
    /// Its name in messages.
    pub shown: &'a str,
    /// Folder in which the files that it names are searched.
    pub folder: &'a Path,
    /// The text itself.
    pub bytes: &'a [u8],
}

impl<'a> StudyText<'a> {
    /// The study with this analysis alone; with all if none is named.
    ///
    /// # Errors
    /// Every problem of the text that concerns the analysis; no analysis of that name.
    pub fn study(&self, analysis: Option<&str>) -> Result<Study, StudyError> {
        Parsed::in_folder(self.shown, self.folder, self.bytes)?.resolve(self.folder, analysis)
    }

    /// This analysis of the text, or the first.
    fn one_analysis(self, analysis: Option<&str>) -> Result<EditedAnalysis<'a>, StudyError> {
        let parsed = Parsed::in_folder(self.shown, self.folder, self.bytes)?;
        // A study without analyses means one map.
        let first = || parsed.analysis_names().first().cloned().unwrap_or_default();
        let name = analysis.map_or_else(first, str::to_owned);
        let table = parsed.analysis_tables()[parsed.index_of(&name)?].clone();
        Ok(EditedAnalysis {
            folder: self.folder,
            study: parsed.resolve(self.folder, Some(&name))?,
            parsed,
            name,
            table,
        })
    }
}

/// One analysis of a text that is being edited, read and checked.
struct EditedAnalysis<'a> {
    /// Folder in which the files that the text names are searched.
    folder: &'a Path,
    /// The text with its fields.
    parsed: Parsed,
    /// The name of the analysis.
    name: String,
    /// The analysis as written.
    table: AnalysisTable,
    /// The study with this analysis alone.
    study: Study,
}

impl EditedAnalysis<'_> {
    /// The same with another folder.
    fn in_folder(self, folder: &Path) -> EditedAnalysis<'_> {
        EditedAnalysis {
            folder,
            parsed: self.parsed,
            name: self.name,
            table: self.table,
            study: self.study,
        }
    }

    /// What its points share; of sections those of the one with this number, from 0.
    fn setting(&self, section: usize) -> Result<&Setting, StudyError> {
        let found = self
            .study
            .analyses
            .first()
            .and_then(|analysis| analysis.subject.setting(section));
        found.ok_or_else(|| {
            StudyError::value(format!("there is no section {section}"), "sections count from 0")
        })
    }
}

//! Every picture of a study.
//!
//! | analysis | pictures |
//! |---|---|
//! | map | the deviation over the plane, `region`, `normal` (depth); at the worst point `shares` (and at the best), `ellipse`, `arm` |
//! | sections | one sheet with a panel a section |
//! | volume | one sheet with slices of the box |
//! | path, holes | those of `path` and `holes` |
//! | any with bodies in its cell | `clearance`: the bodies in the posture of least clearance |
//!
//! Analyses are drawn on all threads, their pictures are in the order of the analyses.

use armill_core::path::Shape;
use armill_core::units::to_mm;
use armill_report::Overlay;
use rayon::prelude::*;

use crate::analysis::picture::{Picture, base_y};
use crate::analysis::{self, AnalysisData, AnalysisResult, Subject};
use crate::answer::{HolesAnswer, MapAnswer, PathAnswer};
use crate::file::resolve::Study;
use crate::input::setting::Setting;
use crate::output::cell_view::least_clearance;
use crate::output::options::StudyResults;

/// The pictures of every analysis, in order.
pub(super) fn draw(results: StudyResults<'_>) -> Vec<Picture> {
    let StudyResults { study, done, answer } = results;
    // Maps and paths of the answer are in the order of the analyses.
    let (mut maps, mut paths) = (answer.maps.as_slice(), answer.paths.iter());
    let mut holes = answer.holes.iter();
    let given = done.iter().map(|done| {
        let count = match &done.found {
            AnalysisData::Map(..) => 1,
            AnalysisData::Sections(sections) => sections.len(),
            AnalysisData::Volume(..) | AnalysisData::Path(..) | AnalysisData::Holes(..) => 0,
        };
        let (of_analysis, others) = maps.split_at(count.min(maps.len()));
        maps = others;
        let path = matches!(done.found, AnalysisData::Path(..))
            .then(|| paths.next())
            .flatten();
        let of_holes = matches!(done.found, AnalysisData::Holes(..))
            .then(|| holes.next())
            .flatten();
        (done, of_analysis, path, of_holes)
    });
    let given: Vec<_> = given.collect();
    let mut pictures: Vec<Picture> = given
        .into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|(done, maps, path, holes)| {
            let clearance = least_clearance(done.name, &study.robot.robot, &done.rows());
            pictures_of(study, done, maps, path, holes)
                .into_iter()
                .chain(clearance)
        })
        .collect();
    if let Some(Ok((combined, given))) = crate::budget::of_results(study, done) {
        pictures.extend(crate::output::budget::pictures(&given, &combined));
    }
    pictures
}

/// The pictures of one analysis; `maps`, `path` and `holes` are its parts of the answer.
fn pictures_of(
    study: &Study,
    done: &AnalysisResult<'_>,
    maps: &[MapAnswer],
    path: Option<&PathAnswer>,
    holes: Option<&HolesAnswer>,
) -> Vec<Picture> {
    let robot = &study.robot.robot;
    match &done.found {
        AnalysisData::Map(plate, found) => {
            let Some(given) = maps.first() else {
                return Vec::new();
            };
            analysis::map::pictures::pictures(robot, plate, given, found, overlays(study, &plate.setting))
        }
        AnalysisData::Sections(all) => analysis::sections::pictures::picture(done.name, all, maps)
            .into_iter()
            .collect(),
        AnalysisData::Volume(setting, found) => {
            vec![analysis::volume::pictures::slices(done.name, found, setting)]
        }
        AnalysisData::Path(analysis, found) => path.map_or_else(Vec::new, |given| {
            analysis::path::pictures::pictures(robot, analysis, given, found)
        }),
        AnalysisData::Holes(analysis, found) => holes.map_or_else(Vec::new, |given| {
            analysis::holes::pictures::pictures(robot, analysis, given, found)
        }),
    }
}

/// Paths of the study on the same plane as a map, to be drawn on it.
fn overlays(study: &Study, setting: &Setting) -> Vec<Overlay> {
    let mut overlays: Vec<Overlay> = Vec::new();
    for analysis in &study.analyses {
        let Subject::Path(path) = &analysis.subject else {
            continue;
        };
        let Some(shape) = path.shape() else { continue };
        let of_path = &path.setting;
        // The same plane relative to the same frame.
        let apart =
            of_path.plane.base_from_part.to_homogeneous() - setting.plane.base_from_part.to_homogeneous();
        if apart.norm() > 1e-9 || of_path.base_name != setting.base_name {
            continue;
        }
        let y0 = base_y(setting);
        let points = path.track.path.points.iter().map(|point| point.at);
        let mut points_mm: Vec<[f64; 2]> = points.map(|at| [y0 - to_mm(at.x), to_mm(at.y)]).collect();
        // Of a circle the first point is not sampled again at its end.
        if matches!(shape, Shape::Circle { .. }) {
            points_mm.extend(points_mm.first().copied());
        }
        if overlays.iter().all(|other| other.points_mm != points_mm) {
            overlays.push(Overlay {
                label: "path".to_owned(),
                points_mm,
            });
        }
    }
    overlays
}

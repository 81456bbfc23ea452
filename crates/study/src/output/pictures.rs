//! Every picture of a study.
//!
//! | analysis | pictures |
//! |---|---|
//! | map | the deviation over the plane, `region`; at the worst point `shares` (and at the best), `ellipse`, `arm` |
//! | sections | one sheet with a panel a section |
//! | volume | one sheet with slices of the box |
//! | path, holes | those of `path` and `holes` |
//!
//! Analyses are drawn on all threads, their pictures are in the order of the analyses.

use armill_core::kernel::Answers;
use armill_core::map::PlaneMap;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::Shape;
use armill_report::{ArmDrawing, Growth, Overlay, ShareBar, ShareBars, StiffnessEllipse, View};

use rayon::prelude::*;

use super::arm::arm_posture;
use super::plates::{axes, base_y, map_pictures, section_panel, sheet, slices, subtitle};
use crate::answer::{HolesAnswer, MapAnswer, PathAnswer, PointAnswer, StudyAnswer};
use crate::file::resolve::{Setting, Study, Subject};
use crate::run::{AnalysisData, AnalysisResult};

/// A picture with its file name (without extension) and caption.
#[derive(Clone, Debug)]
pub struct Picture {
    /// File name without extension.
    pub name: String,
    /// What it shows, in a sentence.
    pub caption: String,
    /// The picture.
    pub svg: String,
}

/// The pictures of every analysis, in order.
pub(super) fn draw(study: &Study, done: &[AnalysisResult<'_>], answer: &StudyAnswer) -> Vec<Picture> {
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
        (done, of_analysis, (path, of_holes))
    });
    let given: Vec<_> = given.collect();
    let mut pictures: Vec<Picture> = given
        .into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|(done, maps, others)| pictures_of(study, done, maps, others))
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
    (path, holes): (Option<&PathAnswer>, Option<&HolesAnswer>),
) -> Vec<Picture> {
    match &done.found {
        AnalysisData::Map(plate, map) => {
            let Some(given) = maps.first() else {
                return Vec::new();
            };
            let mut pictures: Vec<Picture> =
                map_pictures(given, &plate.setting, map, overlays(study, &plate.setting))
                    .into_iter()
                    .collect();
            pictures.extend(worst_point(study, &plate.setting, given, map));
            pictures
        }
        AnalysisData::Sections(sections) => {
            let panels = sections.iter().zip(maps).map(|(section, given)| {
                section_panel(
                    section.label,
                    &section.map,
                    &section.sheet.setting,
                    given.fraction_within,
                )
            });
            let panels: Vec<_> = panels.collect();
            let first = sections.first().map(|section| &section.sheet.setting);
            let drawn = first.map(|setting| sheet(done.name, panels, setting, axes(setting)));
            drawn.into_iter().collect()
        }
        AnalysisData::Volume(setting, volume) => vec![slices(done.name, volume, setting)],
        AnalysisData::Path(analysis, found) => path.map_or_else(Vec::new, |given| {
            super::path::pictures(study, analysis, given, found)
        }),
        AnalysisData::Holes(analysis, found) => holes.map_or_else(Vec::new, |given| {
            super::holes::pictures(study, analysis, (given, found))
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
        let mut points_mm: Vec<[f64; 2]> = points.map(|at| [y0 - at.x * 1e3, at.y * 1e3]).collect();
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

/// The causes at the worst point of a map: shares of the joints there and at the best point, the compliance in the
/// plane, and the arm.
fn worst_point(study: &Study, setting: &Setting, given: &MapAnswer, map: &PlaneMap) -> Vec<Picture> {
    let Some((worst, best)) = given.worst.as_ref().zip(given.best.as_ref()) else {
        return Vec::new();
    };
    let Some((index, _)) = map.answers.worst() else {
        return Vec::new();
    };
    let bars = [("largest", worst), ("least", best)].map(|(which, point)| {
        let [x, y, z] = point.xyz_mm;
        share_bar(&format!("{which} ({x:.0}, {y:.0}, {z:.0}) mm"), point)
    });
    let slug = crate::file_names::slug(&given.name);
    vec![
        Picture {
            name: format!("{slug}-shares"),
            caption: format!(
                "{}: share of each joint where the deviation is largest and least.",
                given.name
            ),
            svg: shares(
                study,
                &format!("{}: contributions of the joints", given.name),
                (setting, "share of in-plane deviation (µm)"),
                bars.to_vec(),
            ),
        },
        ellipse(study, setting, &slug, &map.answers, index),
        Picture {
            name: format!("{slug}-arm"),
            caption: format!("{}: the arm where the deviation is largest.", given.name),
            svg: arm(
                study,
                setting,
                (&given.name, map.answers.joints_at(index)),
                plate_corners(map),
            ),
        },
    ]
}

/// The bar of a point: shares of joints, whole deviation, its standard uncertainty.
pub(super) fn share_bar(label: &str, point: &PointAnswer) -> ShareBar {
    ShareBar {
        label: label.to_owned(),
        shares_um: point.joint_share_um.clone(),
        total_um: Some(point.in_plane_um),
        total_uncertainty_um: Some(point.in_plane_u_um),
    }
}

/// Bars of several points.
pub(super) fn shares(
    study: &Study,
    title: &str,
    (setting, quantity): (&Setting, &str),
    bars: Vec<ShareBar>,
) -> String {
    let picture = ShareBars {
        title: title.to_owned(),
        subtitle: subtitle(setting),
        quantity: quantity.to_owned(),
        parts: setting.model.contributor_names(study.robot.robot.joints()),
        bars,
    };
    picture.to_svg()
}

/// In-plane displacement of the tool by an in-plane force of 1 N: the compliance of the unloaded arm at this point, on
/// base y (or y') and z'.
fn ellipse(study: &Study, setting: &Setting, slug: &str, answers: &Answers, index: usize) -> Picture {
    let robot = &study.robot.robot;
    let compliance = setting.compliance_at(robot, answers.joints_at(index));
    let translational = compliance.fixed_view::<3, 3>(0, 0).into_owned();
    let across = setting.plane.base_from_part * -Vector3::x();
    let up = setting.plane.base_from_part * Vector3::y();
    let between = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(&(translational * b)) * 1e6;
    let picture = StiffnessEllipse {
        title: "compliance in the plane where the deviation is largest".to_owned(),
        subtitle: subtitle(setting),
        axes: axes(setting),
        growth: Growth::Left,
        compliance_um_per_n: [
            [between(&across, &across), between(&across, &up)],
            [between(&up, &across), between(&up, &up)],
        ],
    };
    Picture {
        name: format!("{slug}-ellipse"),
        caption: "In-plane displacement of the tool by an in-plane force of 1 N, by direction.".to_owned(),
        svg: picture.to_svg(),
    }
}

/// The corners of the grid of a map, mm, base, in order round it.
fn plate_corners(map: &PlaneMap) -> [[f64; 3]; 4] {
    let half = |count: usize| 0.5 * (count as f64 - 1.0) * map.grid.step;
    let (x, y) = (half(map.grid.columns), half(map.grid.rows));
    let corner = |sx: f64, sy: f64| -> [f64; 3] {
        let at = map.plane.base_from_part * Point3::new(sx * x, sy * y, 0.0);
        (at.coords * 1e3).into()
    };
    [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ]
}

/// The arm at these joint positions (rad, m), with the plate, from two sides.
fn arm(study: &Study, setting: &Setting, (title, joints): (&str, &[f64]), plate_mm: [[f64; 3]; 4]) -> String {
    let drawing = ArmDrawing {
        title: title.to_owned(),
        subtitle: subtitle(setting),
        posture: arm_posture(&study.robot.robot, joints, &setting.flange_from_tool),
        plate_mm: Some(plate_mm),
        ..ArmDrawing::default()
    };
    drawing.to_svg_views(&[View::Iso, View::Side])
}

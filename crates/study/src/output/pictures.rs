//! Every picture of a study.

use armill_core::kernel::Answers;
use armill_core::map::{PathAnswer, PlaneMap};
use armill_core::nalgebra::{Point3, Vector3};
use armill_report::{
    ArmDrawing, Arrow, ArrowCase, Growth, Overlay, PathPlot, PolarPlot, RadialSeries, Series, ShareBar,
    ShareBars, StiffnessEllipse, VectorField, View,
};

use rayon::prelude::*;

use super::arm::arm_posture;
use super::plates::{axes, base_y, map_pictures, section_panel, sheet, slices, subtitle};
use crate::answer::{MapAnswer, PathResult, PointAnswer, StudyAnswer};
use crate::file::resolve::{Ask, Setting, Study, Subject};
use crate::run::Found;

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

/// Arrows that are drawn along a path at most.
const ARROWS: usize = 72;
/// Postures that are drawn faintly along a path.
pub(super) const GHOSTS: usize = 5;

/// The pictures of every ask, in order.
pub(super) fn draw(study: &Study, found: &[Found], answer: &StudyAnswer) -> Vec<Picture> {
    // What was told of each ask: maps and paths stand in the answer in the order of the asks.
    let (mut maps, mut paths) = (answer.maps.as_slice(), answer.paths.iter());
    let asks = study.asks.iter().zip(found).map(|(ask, found)| {
        let count = match found {
            Found::Map(_) => 1,
            Found::Sections(found) => found.len(),
            Found::Volume(_) | Found::Path(_) | Found::Program(_) => 0,
        };
        let (of_ask, others) = maps.split_at(count.min(maps.len()));
        maps = others;
        let is_path = matches!(found, Found::Path(_) | Found::Program(_));
        let path = is_path.then(|| paths.next()).flatten();
        (ask, found, of_ask, path)
    });
    let asks: Vec<_> = asks.collect();
    asks.into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|(ask, found, maps, path)| pictures_of(study, (ask, found), maps, path))
        .collect()
}

fn pictures_of(
    study: &Study,
    (ask, found): (&Ask, &Found),
    maps: &[MapAnswer],
    path_result: Option<&PathResult>,
) -> Vec<Picture> {
    match (&ask.subject, found) {
        (Subject::Map(plate), Found::Map(map)) => {
            let Some(told) = maps.first() else {
                return Vec::new();
            };
            let mut pictures: Vec<Picture> =
                map_pictures(told, &plate.setting, map, overlays(study, &plate.setting))
                    .into_iter()
                    .collect();
            pictures.extend(worst_point(study, &plate.setting, told, map));
            pictures
        }
        (Subject::Sections(sections), Found::Sections(found)) => {
            let panels = sections.iter().zip(found).zip(maps);
            let panels = panels.map(|(((label, plate), map), told)| {
                section_panel(label, map, &plate.setting, told.fraction_within)
            });
            let panels: Vec<_> = panels.collect();
            let drawn = sections
                .first()
                .map(|(_, first)| sheet(&ask.name, panels, &first.setting, axes(&first.setting)));
            drawn.into_iter().collect()
        }
        (Subject::Volume(setting, _), Found::Volume(volume)) => vec![slices(&ask.name, volume, setting)],
        (Subject::Path(setting, ..), Found::Path(path)) => match path_result {
            Some(told) => path_pictures(study, setting, told, path),
            None => Vec::new(),
        },
        (Subject::Program(of), Found::Program(found)) => {
            let told = path_result.and_then(|told| Some((told, told.program.as_ref()?)));
            told.map_or_else(Vec::new, |told| super::program::pictures(study, of, told, found))
        }
        _ => Vec::new(),
    }
}

/// Paths of the study that lie on the same plane as a map, to be drawn on it.
fn overlays(study: &Study, setting: &Setting) -> Vec<Overlay> {
    let mut overlays: Vec<Overlay> = Vec::new();
    for ask in &study.asks {
        let Subject::Path(of_path, shape, step) = &ask.subject else {
            continue;
        };
        let apart =
            of_path.plane.base_from_part.to_homogeneous() - setting.plane.base_from_part.to_homogeneous();
        if apart.norm() > 1e-9 || of_path.base_name != setting.base_name {
            continue;
        }
        let y0 = base_y(setting);
        let mut points_mm: Vec<[f64; 2]> = shape
            .sampled(*step)
            .iter()
            .map(|s| [y0 - s.at.x * 1e3, s.at.y * 1e3])
            .collect();
        points_mm.extend(points_mm.first().copied());
        if overlays.iter().all(|other| other.points_mm != points_mm) {
            overlays.push(Overlay {
                label: "path".to_owned(),
                points_mm,
            });
        }
    }
    overlays
}

/// Why the worst point of a map is bad: shares of the joints there and at the best point, the compliance in the
/// plane, and the arm.
fn worst_point(study: &Study, setting: &Setting, told: &MapAnswer, map: &PlaneMap) -> Vec<Picture> {
    let Some((worst, best)) = told.worst.as_ref().zip(told.best.as_ref()) else {
        return Vec::new();
    };
    let Some((index, _)) = map.answers.worst() else {
        return Vec::new();
    };
    let bars = [("largest", worst), ("least", best)].map(|(which, point)| {
        let [x, y, z] = point.xyz_mm;
        share_bar(&format!("{which} ({x:.0}, {y:.0}, {z:.0}) mm"), point)
    });
    let slug = super::slug(&told.name);
    vec![
        Picture {
            name: format!("{slug}-shares"),
            caption: format!(
                "{}: share of each joint where the deviation is largest and least.",
                told.name
            ),
            svg: shares(
                study,
                &format!("{}: which joint is to blame", told.name),
                (setting, "share of in-plane deviation (µm)"),
                bars.to_vec(),
            ),
        },
        ellipse(study, setting, &slug, &map.answers, index),
        Picture {
            name: format!("{slug}-arm"),
            caption: format!("{}: the arm where the deviation is largest.", told.name),
            svg: arm(
                study,
                setting,
                (&told.name, map.answers.joints_at(index)),
                plate_corners(map),
            ),
        },
    ]
}

pub(super) fn share_bar(label: &str, point: &PointAnswer) -> ShareBar {
    ShareBar {
        label: label.to_owned(),
        shares_um: point.joint_share_um.clone(),
        total_um: Some(point.in_plane_um),
        total_uncertainty_um: Some(point.in_plane_u_um),
    }
}

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
        parts: setting.model.sharer_names(study.robot.robot.joints()),
        bars,
        ..ShareBars::default()
    };
    picture.to_svg()
}

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
        caption: "How far a force of 1 N in the plane moves the tool in the plane, by direction.".to_owned(),
        svg: picture.to_svg(),
    }
}

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

fn path_pictures(study: &Study, setting: &Setting, told: &PathResult, path: &PathAnswer) -> Vec<Picture> {
    let slug = super::slug(&told.name);
    let mut pictures = vec![
        Picture {
            name: format!("{slug}-vectors"),
            caption: format!(
                "{}: in-plane deviation along the path under every load case.",
                told.name
            ),
            svg: vectors(setting, told, path),
        },
        Picture {
            name: format!("{slug}-along"),
            caption: format!("{}: in-plane deviation along the path.", told.name),
            svg: along(setting, told, path),
        },
    ];
    if !path.radial.is_empty() {
        pictures.push(Picture {
            name: format!("{slug}-polar"),
            caption: format!("{}: radial deviation of the circle, magnified.", told.name),
            svg: polar(setting, told, path),
        });
    }
    pictures.extend(path_arm(study, setting, told, path));
    pictures
}

fn case_name(setting: &Setting, case: usize) -> String {
    let f = setting.cases[case].force;
    format!("F = ({:.0}, {:.0}, {:.0}) N", f.x, f.y, f.z)
}

fn vectors(setting: &Setting, told: &PathResult, path: &PathAnswer) -> String {
    let y0 = base_y(setting);
    let at = |i: usize| [y0 - path.samples[i].at.x * 1e3, path.samples[i].at.y * 1e3];
    let every = path.samples.len().div_ceil(ARROWS).max(1);
    let reached = |i: &usize| path.answers.points[*i].is_ok();
    let arrows = |case: usize| {
        let arrow = |i: usize| {
            let deviation = path.deviation_in_part(i, case) * 1e6;
            Arrow {
                at_mm: at(i),
                deviation_um: [-deviation.x, deviation.y],
            }
        };
        (0..path.samples.len())
            .step_by(every)
            .filter(reached)
            .map(arrow)
            .collect()
    };
    let mut path_mm: Vec<[f64; 2]> = (0..path.samples.len()).map(at).collect();
    if !path.radial.is_empty() {
        path_mm.extend(path_mm.first().copied());
    }
    let picture = VectorField {
        title: told.name.clone(),
        subtitle: subtitle(setting),
        axes: axes(setting),
        growth: Growth::Left,
        path_mm,
        cases: (0..setting.cases.len())
            .map(|case| ArrowCase {
                name: case_name(setting, case),
                arrows: arrows(case),
            })
            .collect(),
    };
    picture.to_svg()
}

fn along(setting: &Setting, told: &PathResult, path: &PathAnswer) -> String {
    let position: Vec<f64> = path.samples.iter().map(|sample| sample.along * 1e3).collect();
    let series = |name: String, value: &dyn Fn(usize) -> f64| Series {
        name,
        position: position.clone(),
        deviation_um: (0..position.len())
            .map(|i| {
                if path.answers.points[i].is_ok() {
                    value(i)
                } else {
                    f64::NAN
                }
            })
            .collect(),
    };
    let picture = PathPlot {
        title: told.name.clone(),
        subtitle: subtitle(setting),
        position_label: "along the path (mm)".to_owned(),
        quantity: "in-plane deviation (µm)".to_owned(),
        series: (0..setting.cases.len())
            .map(|case| {
                series(case_name(setting, case), &|i| {
                    path.deviation_in_part(i, case).xy().norm() * 1e6
                })
            })
            .collect(),
        envelope: Some(series("largest of all cases".to_owned(), &|i| {
            path.answers.points[i]
                .as_ref()
                .map_or(f64::NAN, |held| held.in_plane * 1e6)
        })),
        limit_um: Some(setting.limit * 1e6),
    };
    picture.to_svg()
}

fn polar(setting: &Setting, told: &PathResult, path: &PathAnswer) -> String {
    let count = path.samples.len();
    let angle_deg: Vec<f64> = (0..=count).map(|i| 360.0 * i as f64 / count as f64).collect();
    let series = |(case, radial): (usize, &armill_core::map::RadialDeviation)| RadialSeries {
        name: case_name(setting, case),
        angle_deg: angle_deg.clone(),
        radial_um: radial
            .outward
            .iter()
            .chain(radial.outward.first())
            .map(|value| value * 1e6)
            .collect(),
    };
    let picture = PolarPlot {
        title: told.name.clone(),
        subtitle: subtitle(setting),
        horizontal: "base y".to_owned(),
        vertical: "z′".to_owned(),
        growth: Growth::Left,
        series: path.radial.iter().enumerate().map(series).collect(),
    };
    picture.to_svg()
}

/// The arm at the worst point of the path, faintly along it.
fn path_arm(study: &Study, setting: &Setting, told: &PathResult, path: &PathAnswer) -> Option<Picture> {
    let (worst, _) = path.answers.worst()?;
    let robot = &study.robot.robot;
    let stand = |i: usize| arm_posture(robot, path.answers.joints_at(i), &setting.flange_from_tool);
    let ghosts = (0..GHOSTS)
        .map(|k| k * path.samples.len() / GHOSTS)
        .filter(|i| path.answers.points[*i].is_ok());
    let reach = path
        .samples
        .iter()
        .map(|s| s.at.coords.amax())
        .fold(0.0, f64::max)
        * 1.3;
    let corner = |sx: f64, sy: f64| -> [f64; 3] {
        let at = path.plane.base_from_part * Point3::new(sx * reach, sy * reach, 0.0);
        (at.coords * 1e3).into()
    };
    let on_path = |sample: &armill_core::path::Sample| -> [f64; 3] {
        (path.plane.base_from_tool(sample.at, 0.0).translation.vector * 1e3).into()
    };
    let mut path_mm: Vec<[f64; 3]> = path.samples.iter().map(on_path).collect();
    if !path.radial.is_empty() {
        path_mm.extend(path_mm.first().copied());
    }
    let drawing = ArmDrawing {
        title: told.name.clone(),
        subtitle: subtitle(setting),
        posture: stand(worst),
        ghosts: ghosts.map(stand).collect(),
        plate_mm: Some([
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ]),
        path_mm,
        view: View::Iso,
    };
    Some(Picture {
        name: format!("{}-arm", super::slug(&told.name)),
        caption: format!(
            "{}: the arm along the path, in full where the deviation is largest.",
            told.name
        ),
        svg: drawing.to_svg_views(&[View::Iso, View::Side]),
    })
}

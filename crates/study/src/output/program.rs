//! Pictures of a tool path program: the path coloured by its deviation, the deviation along it, who is to blame, the arm.

use std::fmt::Write;

use armill_core::map::Parts;
use armill_core::nalgebra::Point3;
use armill_report::{ArmDrawing, AxisLabels, Marker, MarkerKind, PathPlot, Series, Stretch, TrackMap, View};

use super::arm::arm_posture;
use super::pictures::{GHOSTS, Picture, shares};
use super::plates::subtitle;
use crate::answer::{PathResult, ProgramResult, WorstPoint};
use crate::file::format::LoadFrameName;
use crate::file::measured::MeasuredForces;
use crate::file::program::ProgramAsk;
use crate::file::resolve::{Setting, Study};
use crate::run::ProgramFound;

/// Points that a chart shows at most: of a longer path each stands for the largest deviations of those around it.
const MOST_POINTS: usize = 1200;
/// Points that the arm's picture has of the path at most.
const MOST_IN_SPACE: usize = 8_000;
/// Marks nearer to each other than this part of the width would hide each other's numbers.
const APART: f64 = 0.025;

/// The pictures of a program.
pub(super) fn pictures(
    study: &Study,
    ask: &ProgramAsk,
    (told, program): (&PathResult, &ProgramResult),
    found: &ProgramFound,
) -> Vec<Picture> {
    let slug = super::slug(&told.name);
    let picture = |what: &str, caption: String, svg: String| Picture {
        name: format!("{slug}-{what}"),
        caption: format!("{}: {caption}", told.name),
        svg,
    };
    let drawing = Drawing {
        study,
        ask,
        told,
        found,
    };
    let mut pictures = vec![
        picture(
            "track",
            "the path seen along the z axis of the program, coloured by the deviation across the tool."
                .to_owned(),
            drawing.track(&program.worst_points),
        ),
        picture(
            "along",
            "the deviation along the cuts.".to_owned(),
            drawing.along(),
        ),
    ];
    if !program.worst_points.is_empty() {
        let bars = program.worst_points.iter().enumerate().map(|(i, worst)| {
            let label = format!("{}: line {}", i + 1, worst.line);
            super::pictures::share_bar(&label, &worst.point)
        });
        pictures.push(picture(
            "shares",
            "share of each joint at the worst points.".to_owned(),
            shares(
                study,
                &format!("{}: which joint is to blame", told.name),
                (&drawing.setting(), "share of deviation across the tool (µm)"),
                bars.collect(),
            ),
        ));
    }
    pictures.extend(super::limits::picture(&told.name, drawing.subtitle(), ask, found));
    pictures.extend(ask.measured.as_deref().map(|measured| {
        picture(
            "forces",
            "the measured force on the tool, before and after drift and teeth were taken off.".to_owned(),
            forces(&told.name, measured),
        )
    }));
    let arm = drawing.arm();
    pictures.extend(arm.map(|svg| {
        picture(
            "arm",
            "the arm along the path, in full where the deviation is largest.".to_owned(),
            svg,
        )
    }));
    pictures
}

/// The record with begin and end of the program.
fn forces(name: &str, measured: &MeasuredForces) -> String {
    let axes = match measured.table.frame {
        LoadFrameName::Base => "base",
        LoadFrameName::Part => "part",
        LoadFrameName::Feed => "feed",
    };
    let mut subtitle = format!("{}; force on the tool, {axes} axes", measured.table.file);
    if let Some(hz) = measured.table.low_pass_hz {
        let _ = write!(subtitle, "; low-pass {hz} Hz");
    }
    if let Some(rpm) = measured.table.spindle_rpm {
        let _ = write!(subtitle, "; means of turns at {rpm} rpm");
    }
    let mut plot =
        crate::forces::output::plot((format!("{name}: measured force"), subtitle), &measured.treated);
    let [from, to] = measured.program;
    plot.marks_s = vec![
        (from, "first cut begins".to_owned()),
        (to, "last cut ends".to_owned()),
    ];
    plot.to_svg()
}

struct Drawing<'a> {
    study: &'a Study,
    ask: &'a ProgramAsk,
    told: &'a PathResult,
    found: &'a ProgramFound,
}

impl Drawing<'_> {
    /// The setting with the branch that was followed.
    fn setting(&self) -> Setting {
        Setting {
            choice: self.found.answer.choice,
            ..self.ask.setting.clone()
        }
    }

    /// What a reader must know beside the title.
    fn subtitle(&self) -> String {
        subtitle(&self.setting())
    }

    fn in_plane_um(&self, index: usize) -> f64 {
        let point = &self.found.answer.answers.points[index];
        point.as_ref().map_or(f64::NAN, |held| held.in_plane * 1e6)
    }

    fn track(&self, worst: &[WorstPoint]) -> String {
        let points = &self.ask.track.points;
        let at = |i: usize| [points[i].at.x * 1e3, points[i].at.y * 1e3];
        let stretch = |range: std::ops::Range<usize>| Stretch {
            points_mm: range.clone().map(at).collect(),
            deviation_um: range.map(|i| self.in_plane_um(i)).collect(),
        };
        let stretches = self.ask.stretches().map(stretch).collect();
        let place = |line: u32, along_mm: f64| {
            let same =
                |i: &usize| points[*i].line == line && (points[*i].along * 1e3 - along_mm).abs() < 1e-6;
            (0..points.len()).find(same)
        };
        let [low, high] = self.ask.track.corners();
        let apart_mm = APART * (high.x - low.x).max(high.y - low.y) * 1e3;
        let mut markers: Vec<Marker> = Vec::new();
        for (i, worst) in worst.iter().enumerate() {
            let Some(at_mm) = place(worst.line, worst.along_mm).map(at) else {
                continue;
            };
            // Points above each other have one mark.
            let near = |other: &&mut Marker| {
                let [x, y] = other.at_mm;
                (x - at_mm[0]).hypot(y - at_mm[1]) < apart_mm
            };
            match markers.iter_mut().find(near) {
                Some(other) => other.name += &format!(", {}", i + 1),
                None => markers.push(Marker {
                    at_mm,
                    label: "worst points".to_owned(),
                    kind: MarkerKind::Point,
                    name: (i + 1).to_string(),
                }),
            }
        }
        let picture = TrackMap {
            title: self.told.name.clone(),
            subtitle: self.subtitle(),
            axes: AxisLabels {
                horizontal: "program x (mm)".to_owned(),
                vertical: "program y (mm)".to_owned(),
            },
            quantity: "deviation across the tool (µm)".to_owned(),
            limit_um: Some(self.ask.setting.limit * 1e6),
            stretches,
            markers,
            ..TrackMap::default()
        };
        picture.to_svg()
    }

    /// Of a path too long for a chart the largest sizes of each handful of points.
    fn along(&self) -> String {
        let points = &self.ask.track.points;
        let handful = points.len().div_ceil(MOST_POINTS).max(1);
        let largest = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let sizes = |first: usize| first..(first + handful).min(points.len());
            (0..points.len())
                .step_by(handful)
                .map(|first| match handful {
                    1 => of(first),
                    _ => sizes(first).map(|i| of(i).abs()).fold(f64::NAN, f64::max),
                })
                .collect()
        };
        let position: Vec<f64> = points.iter().step_by(handful).map(|p| p.along * 1e3).collect();
        let part = |name: &str, of: fn(Parts) -> f64| Series {
            name: name.to_owned(),
            position: position.clone(),
            deviation_um: largest(&|i| match &self.found.answer.answers.points[i] {
                Ok(held) => {
                    let deviation = self.found.answer.answers.deviations_at(i)[held.deciding_case];
                    of(self.ask.track.parts(i, &deviation)) * 1e6
                }
                Err(_) => f64::NAN,
            }),
        };
        let quantity = match handful {
            1 => "deviation (µm)",
            _ => "size of the deviation (µm)",
        };
        let across = match handful {
            1 => "across it, to the left",
            _ => "across it",
        };
        let picture = PathPlot {
            title: self.told.name.clone(),
            subtitle: self.subtitle(),
            position_label: "along the cuts (mm)".to_owned(),
            quantity: quantity.to_owned(),
            series: vec![
                part("along the track", |parts| parts.along),
                part(across, |parts| parts.cross),
                part("along the tool", |parts| parts.normal),
            ],
            envelope: Some(Series {
                name: "largest across the tool".to_owned(),
                deviation_um: largest(&|i| self.in_plane_um(i)),
                position,
            }),
            limit_um: Some(self.ask.setting.limit * 1e6),
        };
        picture.to_svg()
    }

    fn arm(&self) -> Option<String> {
        let (answers, track) = (&self.found.answer.answers, &self.ask.track);
        let (worst, _) = answers.worst()?;
        let robot = &self.study.robot.robot;
        let flange_from_tool = &self.ask.setting.flange_from_tool;
        let stand = |i: usize| arm_posture(robot, answers.joints_at(i), flange_from_tool);
        let ghosts = (0..GHOSTS)
            .map(|k| k * track.points.len() / GHOSTS)
            .filter(|i| answers.points[*i].is_ok());
        let stride = track.points.len().div_ceil(MOST_IN_SPACE).max(1);
        let base =
            |at: &Point3<f64>| -> [f64; 3] { ((track.placing.base_from_path * at).coords * 1e3).into() };
        let drawing = ArmDrawing {
            title: self.told.name.clone(),
            subtitle: self.subtitle(),
            posture: stand(worst),
            ghosts: ghosts.map(stand).collect(),
            plate_mm: Some(self.floor().map(|corner| base(&corner))),
            path_mm: track.points.iter().step_by(stride).map(|p| base(&p.at)).collect(),
            view: View::Iso,
        };
        Some(drawing.to_svg_views(&[View::Iso, View::Side]))
    }

    /// Corners of the rectangle below the path, path axes.
    fn floor(&self) -> [Point3<f64>; 4] {
        let [low, high] = self.ask.track.corners();
        let corner = |x: f64, y: f64| Point3::new(x, y, low.z);
        [
            corner(low.x, low.y),
            corner(high.x, low.y),
            corner(high.x, high.y),
            corner(low.x, high.y),
        ]
    }
}

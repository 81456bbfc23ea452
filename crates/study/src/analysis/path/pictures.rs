//! Pictures of a path: where it deviates, by how much along it, the contributions of the joints, the circle, the arm.
//!
//! | file name ends in | shows | of |
//! |---|---|---|
//! | `vectors` | arrows of the deviation under each case | a shape under constant loads |
//! | `track` | the path from above, coloured; `track-2` and so on: from each further side of a part that is milled from several | every other path |
//! | `along` | deviation over distance | every path |
//! | `part`; `scan-measured`, `scan-predicted`, `scan-difference` | the part in the colours of the deviation of its surface; where it was measured | a machined part |
//! | `polar` | the resulting circle, magnified | a circle |
//! | `shares` | shares of the joints at the worst points | a path that is reached |
//! | `turns` | deviation over path and spin of the tool, with the chosen spin | a search |
//! | `process` | largest deviation over depth and feed per tooth | a cut |
//! | `speed`, `joint-speeds` | feed and speed, speeds of the joints relative to their greatest | a motion |
//! | `corner` | programmed, commanded and followed path where the motion moves the tool most | a motion |
//! | `forces` | the record before and after treatment | measured forces |
//! | `arm` | the arm at the worst point, faintly elsewhere | a path that is reached |

use std::fmt::Write;

use armill_core::map::RadialDeviation;
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::path::Parts;
use armill_core::robot::Robot;
use armill_core::units::{to_mm, to_um};
use armill_report::{
    ArmDrawing, Arrow, ArrowCase, AxisLabels, Growth, Marker, MarkerKind, PathPlot, PolarPlot, RadialSeries,
    Series, Stretch, TrackMap, VectorField, View,
};

use crate::analysis::arm::{FromGround, arm_on_ground, standing_tool};
use crate::analysis::path::answer::PathAnswer;
use crate::analysis::path::machined_part;
use crate::analysis::path::point_groups::PointGroups;
use crate::analysis::path::run::PathResult;
use crate::analysis::path::track_views::TrackView;
use crate::analysis::path::{MeasuredForces, PathAnalysis};
use crate::analysis::picture::{Picture, axes, base_y, share_bar, shares, subtitle};
use crate::input::setting::Setting;
use crate::measured::force_picture::plot;

/// Points of the path in the picture of the arm at most.
const MOST_IN_SPACE: usize = 8_000;
/// Marks nearer to each other than this part of the width would hide each other's numbers.
const APART: f64 = 0.025;
/// Arrows that are drawn along a path at most.
const ARROWS: usize = 72;
/// Postures that are drawn faintly along a path.
const GHOSTS: usize = 5;
/// Size of the plate of the arm relative to the path.
const PLATE: f64 = 1.3;

/// The pictures of a path.
pub fn pictures(
    robot: &Robot,
    analysis: &PathAnalysis,
    given: &PathAnswer,
    found: &PathResult,
) -> Vec<Picture> {
    let drawing = Drawing {
        robot,
        analysis,
        given,
        found,
    };
    let mut pictures = drawing.where_it_deviates();
    pictures.push(drawing.along());
    pictures.extend(machined_part::pictures::pictures(given, found));
    pictures.extend(drawing.polar());
    pictures.extend(drawing.contributions());
    pictures.extend(super::motion_columns::pictures(
        robot,
        &given.name,
        &drawing.subtitle(),
        analysis,
        found,
    ));
    pictures.extend(super::corner_picture::picture(&given.name, analysis, found));
    pictures.extend(super::process_limits::picture(
        &given.name,
        drawing.subtitle(),
        analysis,
        found,
    ));
    pictures.extend(super::turns::picture(
        &given.name,
        drawing.subtitle(),
        analysis,
        found,
    ));
    pictures.extend(
        analysis
            .measured
            .as_deref()
            .map(|measured| drawing.forces(measured)),
    );
    pictures.extend(drawing.arm());
    pictures
}

/// The data of the pictures of a path.
struct Drawing<'a> {
    robot: &'a Robot,
    analysis: &'a PathAnalysis,
    given: &'a PathAnswer,
    found: &'a PathResult,
}

/// The direction of the tool of a view, path axes.
fn direction(view: &TrackView) -> String {
    let along = view
        .along
        .map_or_else(Vector3::z, armill_core::nalgebra::Unit::into_inner);
    format!(
        "({:.2}, {:.2}, {:.2})",
        along.x + 0.0,
        along.y + 0.0,
        along.z + 0.0
    )
}

impl Drawing<'_> {
    /// A picture of this path: `what` ends its file name, `caption` follows the name of the path.
    fn picture(&self, what: &str, caption: &str, svg: String) -> Picture {
        Picture {
            name: format!("{}-{what}", crate::file_names::slug(&self.given.name)),
            caption: format!("{}: {caption}", self.given.name),
            svg,
        }
    }

    /// The setting with the branch that was followed.
    fn setting(&self) -> Setting {
        Setting {
            choice: self.found.along.choice_at(0),
            ..self.analysis.setting.clone()
        }
    }

    /// The subtitle.
    fn subtitle(&self) -> String {
        subtitle(&self.setting())
    }

    /// NaN where the point is not reached: the drawing leaves a gap there.
    fn in_plane_um(&self, index: usize) -> f64 {
        let point = &self.found.along.answers.points[index];
        point
            .as_ref()
            .map_or(f64::NAN, |evaluation| to_um(evaluation.in_plane))
    }

    /// The name of a load case: its force, if it is constant.
    fn case_name(&self, case: usize) -> String {
        let force = self
            .analysis
            .setting
            .cases
            .get(case)
            .filter(|_| self.analysis.load.is_steady());
        force.map_or_else(
            || format!("case {}", case + 1),
            |wrench| {
                let f = wrench.force;
                format!("F = ({:.0}, {:.0}, {:.0}) N", f.x, f.y, f.z)
            },
        )
    }

    /// Arrows on a shape under constant loads, else the path coloured by its deviation, from each side.
    fn where_it_deviates(&self) -> Vec<Picture> {
        if self.analysis.shape().is_some() && self.analysis.load.is_steady() {
            let caption = "in-plane deviation along the path under every load case.";
            return vec![self.picture("vectors", caption, self.vectors())];
        }
        let views = TrackView::all(&self.analysis.track);
        let picture = |(index, view): (usize, &TrackView)| {
            let what = match index {
                0 => "track".to_owned(),
                _ => format!("track-{}", index + 1),
            };
            let caption = match view.along {
                None => {
                    "the path seen along its z axis, coloured by the deviation across the tool.".to_owned()
                }
                Some(_) => format!(
                    "cuts with the tool along {}, coloured by the deviation across it.",
                    direction(view)
                ),
            };
            self.picture(&what, &caption, self.track(view))
        };
        views.iter().enumerate().map(picture).collect()
    }

    fn track(&self, view: &TrackView) -> String {
        let points = &self.analysis.track.path.points;
        let at = |i: usize| view.at_mm(&points[i].at);
        let stretch = |range: &std::ops::Range<usize>| Stretch {
            points_mm: range.clone().map(at).collect(),
            deviation_um: range.clone().map(|i| self.in_plane_um(i)).collect(),
        };
        let stretches = view.stretches.iter().map(stretch).collect();
        let apart_mm = APART * view.size_mm(|i| points[i].at);
        let mut markers: Vec<Marker> = Vec::new();
        for (i, worst) in self.found.worst.iter().enumerate() {
            if !view.shows(worst.index) {
                continue;
            }
            let at_mm = at(worst.index);
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
        let [horizontal, vertical] = view.labels.map(|label| format!("{label} (mm)"));
        let picture = TrackMap {
            title: match view.along {
                None => self.given.name.clone(),
                Some(_) => format!("{}, tool along {}", self.given.name, direction(view)),
            },
            subtitle: self.subtitle(),
            axes: AxisLabels { horizontal, vertical },
            quantity: "deviation across the tool (µm)".to_owned(),
            tolerance_um: Some(to_um(self.analysis.setting.tolerance)),
            stretches,
            markers,
            ..TrackMap::default()
        };
        picture.to_svg()
    }

    /// The shape on its plane with arrows at some of its points, drawn as seen from the tool side: y' to the left.
    fn vectors(&self) -> String {
        let (track, answers) = (&self.analysis.track, &self.found.along.answers);
        let points = &track.path.points;
        let y0 = base_y(&self.analysis.setting);
        let at = |i: usize| [y0 - to_mm(points[i].at.x), to_mm(points[i].at.y)];
        let every = points.len().div_ceil(ARROWS).max(1);
        let reached = |i: &usize| answers.points[*i].is_ok();
        let arrows = |case: usize| {
            let arrow = |i: usize| {
                let deviation: Vector3<f64> = to_um(
                    self.analysis
                        .setting
                        .plane
                        .in_part(&answers.deviations_at(i)[case]),
                );
                Arrow {
                    at_mm: at(i),
                    deviation_um: [-deviation.x, deviation.y],
                }
            };
            (0..points.len())
                .step_by(every)
                .filter(reached)
                .map(arrow)
                .collect()
        };
        let mut path_mm: Vec<[f64; 2]> = (0..points.len()).map(at).collect();
        if !self.found.radial.is_empty() {
            path_mm.extend(path_mm.first().copied());
        }
        let picture = VectorField {
            title: self.given.name.clone(),
            subtitle: self.subtitle(),
            axes: axes(&self.analysis.setting),
            growth: Growth::Left,
            path_mm,
            cases: (0..answers.case_count)
                .map(|case| ArrowCase {
                    name: self.case_name(case),
                    arrows: arrows(case),
                })
                .collect(),
        };
        picture.to_svg()
    }

    /// The deviation along the path: of one load case its components, of several each in the plane. Of a path too long
    /// for a chart the largest absolute values of each group of points.
    fn along(&self) -> Picture {
        let (track, answers) = (&self.analysis.track, &self.found.along.answers);
        let points = &track.path.points;
        let handfuls = PointGroups::of(points.len());
        let position = handfuls.positions_mm(points);
        let series = |name: String, of: &dyn Fn(usize) -> f64| Series {
            name,
            position: position.clone(),
            deviation_um: handfuls.largest(|i| {
                if answers.points[i].is_ok() {
                    of(i)
                } else {
                    f64::NAN
                }
            }),
        };
        let part = |name: &str, of: fn(Parts) -> f64| {
            series(name.to_owned(), &|i| {
                to_um(of(track.parts(i, &answers.deviations_at(i)[0])))
            })
        };
        let (across, quantity) = match handfuls.are_points() {
            true => ("across it, to the left", "deviation (µm)"),
            false => ("across it", "size of the deviation (µm)"),
        };
        let in_plane = |case: usize| {
            let of = move |i: usize| {
                let parts = track.parts(i, &answers.deviations_at(i)[case]);
                to_um(parts.along.hypot(parts.cross))
            };
            series(self.case_name(case), &of)
        };
        let one_case = answers.case_count == 1;
        let (all, quantity, envelope) = if one_case {
            let parts = vec![
                part("along the track", |parts| parts.along),
                part(across, |parts| parts.cross),
                part("along the tool", |parts| parts.axial),
            ];
            (parts, quantity, "largest across the tool")
        } else {
            let cases = (0..answers.case_count).map(in_plane).collect();
            (cases, "deviation across the tool (µm)", "largest of all cases")
        };
        let picture = PathPlot {
            title: self.given.name.clone(),
            subtitle: self.subtitle(),
            position_label: "along the path (mm)".to_owned(),
            quantity: quantity.to_owned(),
            series: all,
            envelope: Some(series(envelope.to_owned(), &|i| self.in_plane_um(i))),
            tolerance_um: Some(to_um(self.analysis.setting.tolerance)),
        };
        self.picture("along", "the deviation along the path.", picture.to_svg())
    }

    /// The resulting circle, magnified.
    fn polar(&self) -> Option<Picture> {
        let count = self.analysis.track.len();
        let angle_deg: Vec<f64> = (0..=count).map(|i| 360.0 * i as f64 / count as f64).collect();
        let series = |(case, radial): (usize, &RadialDeviation)| RadialSeries {
            name: self.case_name(case),
            angle_deg: angle_deg.clone(),
            radial_um: radial
                .outward
                .iter()
                .chain(radial.outward.first())
                .map(to_um)
                .collect(),
        };
        let picture = PolarPlot {
            title: self.given.name.clone(),
            subtitle: self.subtitle(),
            horizontal: "base y".to_owned(),
            vertical: "z′".to_owned(),
            growth: Growth::Left,
            zero: "nominal circle".to_owned(),
            series: self.found.radial.iter().enumerate().map(series).collect(),
            references: Vec::new(),
        };
        let caption = "radial deviation of the circle, magnified.";
        (!self.found.radial.is_empty()).then(|| self.picture("polar", caption, picture.to_svg()))
    }

    /// The contributions of the joints at the worst points.
    fn contributions(&self) -> Option<Picture> {
        let worst = &self.given.worst_points;
        let bars = worst.iter().enumerate().map(|(i, worst)| {
            let label = format!("{}: line {}", i + 1, worst.line);
            share_bar(&label, &worst.point)
        });
        let title = format!("{}: contributions of the joints", self.given.name);
        let quantity = "share of deviation across the tool (µm)";
        let svg = shares(self.robot, &title, &self.setting(), quantity, bars.collect());
        (!worst.is_empty()).then(|| self.picture("shares", "share of each joint at the worst points.", svg))
    }

    /// The record with start and end of the program.
    fn forces(&self, measured: &MeasuredForces) -> Picture {
        let axes = measured.table.frame.word();
        let mut subtitle = format!("{}; force on the tool, {axes} axes", measured.table.file);
        if let Some(hz) = measured.table.low_pass_hz {
            let _ = write!(subtitle, "; low-pass {hz} Hz");
        }
        if let Some(rpm) = measured.table.spindle_rpm {
            let _ = write!(subtitle, "; mean of each revolution at {rpm} rpm");
        }
        let title = format!("{}: measured force", self.given.name);
        let mut plot = plot(title, subtitle, &measured.treated);
        let [from, to] = measured.program;
        plot.marks_s = vec![
            (from, "first cut starts".to_owned()),
            (to, "last cut ends".to_owned()),
        ];
        let caption = "the measured force on the tool, before and after removal of drift and tooth passing.";
        self.picture("forces", caption, plot.to_svg())
    }

    /// The arm at the worst point of the path, faintly along it.
    fn arm(&self) -> Option<Picture> {
        let (answers, track) = (&self.found.along.answers, &self.analysis.track);
        let (worst, _) = answers.worst()?;
        let robot = &self.robot;
        let flange_from_tool = &self.analysis.setting.flange_from_tool;
        let draw = |i: usize| arm_on_ground(robot, answers.joints_at(i), flange_from_tool);
        let ghosts = (0..GHOSTS)
            .map(|k| k * track.len() / GHOSTS)
            .filter(|i| answers.points[*i].is_ok());
        let stride = track.len().div_ceil(MOST_IN_SPACE).max(1);
        let seen = FromGround::at(robot, answers.joints_at(worst));
        let shown = |at: &Point3<f64>| -> [f64; 3] {
            seen.point_mm(to_mm((track.placing.base_from_path * at).coords).into())
        };
        let mut path_mm: Vec<[f64; 3]> = track
            .path
            .points
            .iter()
            .step_by(stride)
            .map(|p| shown(&p.at))
            .collect();
        if !self.found.radial.is_empty() {
            path_mm.extend(path_mm.first().copied());
        }
        let drawing = ArmDrawing {
            title: self.given.name.clone(),
            subtitle: self.subtitle(),
            posture: draw(worst),
            ghosts: ghosts.map(draw).collect(),
            plate_mm: Some(self.plate().map(|corner| shown(&corner))),
            path_mm,
            standing_tool_mm: standing_tool(robot, flange_from_tool),
            view: View::Iso,
        };
        let caption = "the arm along the path, solid where the deviation is largest.";
        Some(self.picture("arm", caption, drawing.to_svg_views(&[View::Iso, View::Side])))
    }

    /// Corners of the plate, path axes: about the centre of the plane of a shape, below a program.
    fn plate(&self) -> [Point3<f64>; 4] {
        let [low, high] = self.analysis.track.path.corners();
        let [low, high] = match self.analysis.shape() {
            Some(_) => {
                let reach = PLATE * low.coords.amax().max(high.coords.amax());
                [Point3::new(-reach, -reach, 0.0), Point3::new(reach, reach, 0.0)]
            }
            None => [low, Point3::new(high.x, high.y, low.z)],
        };
        let corner = |x: f64, y: f64| Point3::new(x, y, low.z);
        [
            corner(low.x, low.y),
            corner(high.x, low.y),
            corner(high.x, high.y),
            corner(low.x, high.y),
        ]
    }
}

//! Pictures of a map: the deviation in the plane and along its normal, the region within the tolerance, and the causes
//! at the worst point.

use armill_core::kernel::{Answers, Evaluation};
use armill_core::map::{COVERAGE, PlaneMap};
use armill_core::nalgebra::{Point3, Vector3};
use armill_core::robot::{Robot, Unreachable};
use armill_core::units::{to_mm, to_um};
use armill_report::{
    ArmDrawing, AxisLabels, CircleMm, ColourScale, DeviationMap, Growth, Marker, MarkerKind, Overlay,
    RectangleMm, RegionMap, StiffnessEllipse, View,
};

use crate::analysis::Sheet;
use crate::analysis::arm::{FromGround, arm_on_ground, standing_tool};
use crate::analysis::map::answer::MapAnswer;
use crate::analysis::picture::{
    NORMAL_QUANTITY, Picture, QUANTITY, axes, base_y, grid, grid_of, share_bar, shares, subtitle,
};
use crate::file_names::slug;
use crate::input::setting::Setting;

/// The pictures of a map; `overlays` are paths on its plane.
pub fn pictures(
    robot: &Robot,
    sheet: &Sheet,
    given: &MapAnswer,
    map: &PlaneMap,
    overlays: Vec<Overlay>,
) -> Vec<Picture> {
    let mut pictures: Vec<Picture> = plane(given, &sheet.setting, map, overlays).into();
    pictures.extend(worst_point(robot, &sheet.setting, given, map));
    pictures
}

/// Expanded uncertainty of each deviation; 0 where it is not known: the region has no uncertain border then.
fn spread_um(map: &PlaneMap) -> Vec<f64> {
    let points = map.answers.points.iter();
    let uncertainty = |point: &Result<Evaluation, Unreachable>| {
        point
            .as_ref()
            .ok()
            .and_then(|evaluation| evaluation.in_plane_uncertainty)
            .unwrap_or(0.0)
    };
    points.map(|point| to_um(COVERAGE * uncertainty(point))).collect()
}

/// The map of a plane with its best and worst point, the region within the tolerance with the largest shapes inside,
/// and the map of the deviation along the normal.
fn plane(answer: &MapAnswer, setting: &Setting, map: &PlaneMap, overlays: Vec<Overlay>) -> [Picture; 3] {
    let y0 = base_y(setting);
    let at = |in_plane: [f64; 2]| [y0 + in_plane[0], in_plane[1]];
    let marker = |label: &str, kind, at_mm| Marker {
        at_mm,
        label: label.to_owned(),
        kind,
        name: String::new(),
    };
    let markers = [
        answer
            .best
            .as_ref()
            .map(|p| marker("least", MarkerKind::Best, at(p.in_plane_mm))),
        answer
            .worst
            .as_ref()
            .map(|p| marker("largest", MarkerKind::Point, at(p.in_plane_mm))),
    ];
    let tolerance_um = to_um(setting.tolerance);
    let deviation = DeviationMap {
        title: answer.name.clone(),
        subtitle: subtitle(setting),
        grid: grid(map, setting),
        axes: axes(setting),
        quantity: QUANTITY.to_owned(),
        tolerance_um: Some(tolerance_um),
        scale: ColourScale::Viridis,
        overlays,
        markers: markers.into_iter().flatten().collect(),
        // A coarse grid is drawn; a fine one would hide the contours.
        show_grid_points: map.grid.len() <= 200,
    };
    let region = RegionMap {
        title: format!("{}: region within {tolerance_um:.0} µm", answer.name),
        subtitle: subtitle(setting),
        grid: grid(map, setting),
        spread_um: spread_um(map),
        axes: axes(setting),
        tolerance_um,
        show_iso_lines: true,
        rectangle: answer
            .region
            .rectangle_mm
            .filter(|[a, b]| a != b)
            .map(|[a, b]| RectangleMm {
                corner_mm: at(a),
                opposite_mm: at(b),
            }),
        circle: answer
            .region
            .circle_centre_mm
            .zip(answer.region.circle_radius_mm)
            .filter(|(_, radius)| *radius > 0.0)
            .map(|(centre, radius_mm)| CircleMm {
                centre_mm: at(centre),
                radius_mm,
            }),
    };
    let deepest = answer.largest_along_normal.as_ref();
    let deepest = deepest.map(|p| marker("largest", MarkerKind::Point, at(p.in_plane_mm)));
    let normal = DeviationMap {
        title: format!("{}: along the normal", answer.name),
        grid: grid_of(map, setting, |evaluation| evaluation.normal.abs()),
        quantity: NORMAL_QUANTITY.to_owned(),
        // The tolerance applies to the deviation in the plane.
        tolerance_um: None,
        markers: deepest.into_iter().collect(),
        ..deviation.clone()
    };
    let slug = slug(&answer.name);
    [
        Picture {
            name: slug.clone(),
            caption: format!("{}: in-plane deviation, {}.", answer.name, subtitle(setting)),
            svg: deviation.to_svg(),
        },
        Picture {
            name: format!("{slug}-region"),
            caption: format!(
                "{}: {:.1} % of the points are within {tolerance_um:.0} µm{}.",
                answer.name,
                answer.fraction_within_and_inside_joint_limits * 100.0,
                if answer.outside_joint_limits > 0 {
                    " inside the joint limits; those outside are not in the region"
                } else {
                    ""
                }
            ),
            svg: region.to_svg(),
        },
        Picture {
            name: format!("{slug}-normal"),
            caption: format!(
                "{}: deviation along the normal (depth), by size; the tolerance does not apply to it.",
                answer.name
            ),
            svg: normal.to_svg(),
        },
    ]
}

/// The causes at the worst point of a map: shares of the joints there and at the best point, the compliance in the
/// plane, and the arm.
fn worst_point(robot: &Robot, setting: &Setting, given: &MapAnswer, map: &PlaneMap) -> Vec<Picture> {
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
    let slug = slug(&given.name);
    vec![
        Picture {
            name: format!("{slug}-shares"),
            caption: format!(
                "{}: share of each joint where the deviation is largest and least.",
                given.name
            ),
            svg: shares(
                robot,
                &format!("{}: contributions of the joints", given.name),
                setting,
                "share of in-plane deviation (µm)",
                bars.to_vec(),
            ),
        },
        ellipse(robot, setting, &slug, &map.answers, index),
        Picture {
            name: format!("{slug}-arm"),
            caption: format!("{}: the arm where the deviation is largest.", given.name),
            svg: arm(
                robot,
                setting,
                &given.name,
                map.answers.joints_at(index),
                plate_corners(map),
            ),
        },
    ]
}

/// The axes of [`axes`] for displacements under 1 N.
fn compliance_axes(setting: &Setting) -> AxisLabels {
    let AxisLabels { horizontal, vertical } = axes(setting);
    let of_displacement = |label: String| format!("displacement along {}", label.replace("(mm)", "(µm/N)"));
    AxisLabels {
        horizontal: of_displacement(horizontal.replace("along the plane, ", "")),
        vertical: of_displacement(vertical.replace("along the plane, ", "")),
    }
}

/// In-plane displacement of the tool by an in-plane force of 1 N: the compliance of the unloaded arm at this point, on
/// base y (or y') and z'.
fn ellipse(robot: &Robot, setting: &Setting, slug: &str, answers: &Answers, index: usize) -> Picture {
    let compliance = setting.compliance_at(robot, answers.joints_at(index));
    let translational = compliance.fixed_view::<3, 3>(0, 0).into_owned();
    let across = setting.plane.base_from_part * -Vector3::x();
    let up = setting.plane.base_from_part * Vector3::y();
    let between = |a: &Vector3<f64>, b: &Vector3<f64>| to_um(a.dot(&(translational * b)));
    let picture = StiffnessEllipse {
        title: "compliance in the plane where the deviation is largest".to_owned(),
        subtitle: subtitle(setting),
        axes: compliance_axes(setting),
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
        to_mm(at.coords).into()
    };
    [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ]
}

/// The arm at these joint positions (rad, m), with the plate (base), from two sides.
fn arm(robot: &Robot, setting: &Setting, title: &str, joints: &[f64], plate_mm: [[f64; 3]; 4]) -> String {
    let seen = FromGround::at(robot, joints);
    let drawing = ArmDrawing {
        title: title.to_owned(),
        subtitle: subtitle(setting),
        posture: arm_on_ground(robot, joints, &setting.flange_from_tool),
        plate_mm: Some(plate_mm.map(|corner| seen.point_mm(corner))),
        standing_tool_mm: standing_tool(robot, &setting.flange_from_tool),
        ..ArmDrawing::default()
    };
    drawing.to_svg_views(&[View::Iso, View::Side])
}

//! Pictures of holes: the deviation of each, and the contributions of the joints at the worst.
//!
//! | file name ends in | shows | of |
//! |---|---|---|
//! | `holes` | the holes from above, coloured, with arrows | every set |
//! | `shares` | shares of the joints at the worst holes | a set with one that is reached |

use armill_core::kernel::BranchChoice;
use armill_core::optimize::HolesFound;
use armill_core::path::PathPoint;
use armill_core::robot::{BranchPattern, Robot};
use armill_core::units::{to_mm, to_um};
use armill_report::{AxisLabels, ColourScale, HoleMap, HoleMark};

use crate::analysis::holes::HolesAnalysis;
use crate::analysis::holes::answer::{HolesAnswer, is_refused};
use crate::analysis::picture::{Picture, share_bar, shares, subtitle};
use crate::input::setting::Setting;

/// Holes that are numbered in the picture.
const NUMBERED: usize = 3;

/// The pictures of a set of holes.
pub fn pictures(
    robot: &Robot,
    analysis: &HolesAnalysis,
    given: &HolesAnswer,
    found: &HolesFound,
) -> Vec<Picture> {
    let named = |what: &str, caption: &str, svg: String| Picture {
        name: format!("{}-{what}", crate::file_names::slug(&given.name)),
        caption: format!("{}: {caption}", given.name),
        svg,
    };
    let caption = "the holes seen along z of their frame, coloured by the deviation across each; the worst are numbered.";
    let mut pictures = vec![named("holes", caption, map(analysis, given, found))];
    let bars = given.worst_holes.iter().map(|worst| {
        let [x, y, z] = worst.point.xyz_mm;
        share_bar(
            &format!("hole {} ({x:.0}, {y:.0}, {z:.0})", worst.hole),
            &worst.point,
        )
    });
    let title = format!("{}: contributions of the joints", given.name);
    let quantity = "share of deviation across the hole (µm)";
    let setting = open_setting(analysis);
    let svg = shares(robot, &title, &setting, quantity, bars.collect());
    if !given.worst_holes.is_empty() {
        pictures.push(named("shares", "share of each joint at the worst holes.", svg));
    }
    pictures
}

/// The setting with the permitted branches.
fn open_setting(analysis: &HolesAnalysis) -> Setting {
    let choice = match analysis.search.branches == BranchPattern::default() {
        true => BranchChoice::Best,
        false => BranchChoice::Of(analysis.search.branches),
    };
    Setting {
        choice,
        ..analysis.path.setting.clone()
    }
}

/// The holes along x and y of their frame.
fn map(analysis: &HolesAnalysis, given: &HolesAnswer, found: &HolesFound) -> String {
    let track = &analysis.path.track;
    let path_from_base = track.placing.base_from_path.rotation.inverse();
    let worst = |index: usize| {
        let mut numbered = given.worst_holes.iter().take(NUMBERED);
        numbered.any(|worst| worst.hole == index + 1)
    };
    let mark = |(index, point): (usize, &PathPoint)| {
        let evaluation = found.answers.points[index].as_ref().ok();
        let moved = evaluation.map(|evaluation| {
            to_um(path_from_base * found.answers.deviations_at(index)[evaluation.worst_case])
        });
        HoleMark {
            at_mm: [to_mm(point.at.x), to_mm(point.at.y)],
            error_um: moved.map_or([f64::NAN; 2], |moved| [moved.x, moved.y]),
            is_rejected: is_refused(found, index),
            deviation_um: evaluation.map(|evaluation| to_um(evaluation.in_plane)),
            name: match worst(index) {
                true => (index + 1).to_string(),
                false => String::new(),
            },
        }
    };
    let picture = HoleMap {
        title: given.name.clone(),
        subtitle: subtitle(&open_setting(analysis)),
        axes: AxisLabels {
            horizontal: "x of the holes' frame (mm)".to_owned(),
            vertical: "y of the holes' frame (mm)".to_owned(),
        },
        quantity: "deviation across the hole (µm)".to_owned(),
        tolerance_um: Some(to_um(analysis.path.setting.tolerance)),
        scale: ColourScale::Viridis,
        holes: track.path.points.iter().enumerate().map(mark).collect(),
    };
    picture.to_svg()
}

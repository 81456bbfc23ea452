//! Tables and pictures of the backlash of joints.
//!
//! ```text
//! result.json     the result
//! reversals.csv   analysis, joint, at_deg, step_um, crossed_cw_deg, crossed_ccw_deg
//! NAME.svg        the runs of a circle, the fit with backlash, and rays at reversals; .png too
//! ```

use armill_core::measure::ballbar::joints::Followed;
use armill_core::measure::ballbar::profile::{STATIONS, station};
use armill_core::measure::ballbar::{Direction, Profile, Run, least_squares_centre};
use armill_core::units::{to_deg, to_um};
use armill_formats::file::ResultFolder;
use armill_formats::table::{Column, ColumnData, Table, csv};
use armill_report::{BallbarPlot, BallbarTrace, Growth, RayMark, Sense};
use armill_study::StudyError;
use armill_study::file::circles::MeasuredCircle;
use armill_study::file_names::slug;
use armill_study::output::{Picture, RESULT, picture_files, replace, save_pictures};

use super::answer::{BacklashAnswer, CircleAnswer, ReversalAnswer};
use super::circles::{BacklashEstimate, FollowedCircle};

/// The table.
const TABLE: &str = "reversals.csv";

/// Writes the result, its table and pictures into the folder `out`.
///
/// # Errors
/// The folder or a file cannot be written.
pub fn write(
    given: &BacklashAnswer,
    found: &BacklashEstimate<'_>,
    out: &ResultFolder,
) -> Result<(), StudyError> {
    let pictures: Vec<Picture> = (found.circles.iter().zip(&given.circles))
        .map(|(of, circle)| picture(of, circle, &found.gaps.fitted))
        .collect();
    let names = (pictures.iter().flat_map(picture_files)).chain([TABLE.to_owned(), RESULT.to_owned()]);
    replace(out, &names.collect::<Vec<_>>(), given, &|_| (), |files| {
        files.save(TABLE, &csv::write(&table(given)?))?;
        save_pictures(&pictures, files)
    })?;
    Ok(())
}

/// Every reversal of every circle.
fn table(given: &BacklashAnswer) -> Result<Table, StudyError> {
    let rows: Vec<(&CircleAnswer, &ReversalAnswer)> = (given.circles.iter())
        .flat_map(|circle| circle.reversals.iter().map(move |reversal| (circle, reversal)))
        .collect();
    let text =
        |name: &str, description: &str, of: &dyn Fn(&(&CircleAnswer, &ReversalAnswer)) -> String| Column {
            name: name.to_owned(),
            unit: None,
            description: description.to_owned(),
            decimals: None,
            data: ColumnData::Text(rows.iter().map(of).collect()),
        };
    let number = |name: &str, description: &str, of: &dyn Fn(&ReversalAnswer) -> Option<f64>| Column {
        name: name.to_owned(),
        unit: name.rsplit('_').next().map(str::to_owned),
        description: description.to_owned(),
        decimals: Some(4),
        data: ColumnData::OptionalFloat(rows.iter().map(|(_, reversal)| of(reversal)).collect()),
    };
    let columns = vec![
        text("analysis", "the circle", &|(circle, _)| circle.analysis.clone()),
        text("joint", "the joint that reverses", &|(_, at)| at.joint.clone()),
        number("at_deg", "where, from +y' towards z'", &|at| Some(at.at_deg)),
        number("step_um", "step of the radius outwards", &|at| at.step_um),
        number(
            "crossed_cw_deg",
            "angle at which the backlash is crossed clockwise",
            &|at| at.crossed_cw_deg,
        ),
        number(
            "crossed_ccw_deg",
            "angle at which the backlash is crossed anticlockwise",
            &|at| at.crossed_ccw_deg,
        ),
    ];
    Ok(Table::new("reversals", columns)?)
}

/// The runs of one circle about their centre, the fitted smooth part and steps, and the reversals of joints; `gaps` is
/// the fitted backlash of each joint.
fn picture(of: &FollowedCircle<'_>, circle: &CircleAnswer, gaps: &[f64]) -> Picture {
    let (measured, followed) = (of.measured, &of.followed);
    let offset = least_squares_centre(&measured.test).map(|centre| centre.offset);
    let about = |a: f64| offset.map_or(0.0, |e| e.x * a.cos() + e.y * a.sin());
    let mut traces: Vec<BallbarTrace> = (measured.test.runs().iter().zip(&measured.runs))
        .map(|(run, name)| {
            let radii = Profile::of(run);
            trace(name.clone(), run.direction(), |a| {
                radii.at(a).map_or(f64::NAN, |dr| dr - about(a))
            })
        })
        .collect();
    // The part common to both directions is measured; their difference is that of the backlash.
    let common = Common::of(measured, followed, gaps);
    for direction in Direction::BOTH {
        if !measured.test.of(direction).any(|_| true) {
            continue;
        }
        let angles: Vec<f64> = (0..=STATIONS).map(|k| station(k % STATIONS)).collect();
        let effect = backlash_effect(followed, gaps, direction, &angles);
        traces.push(BallbarTrace {
            name: format!("{} with fitted backlash", direction.name()),
            sense: sense(direction),
            angle_deg: (0..=STATIONS).map(|k| to_deg(station(k))).collect(),
            radial_um: angles
                .iter()
                .zip(effect)
                .enumerate()
                .map(|(k, (a, dr))| to_um(common.0[k % STATIONS] + dr - about(*a)))
                .collect(),
            start_deg: None,
        });
    }
    let picture = BallbarPlot {
        title: format!("Reversals of the joints: {}", circle.analysis),
        subtitle: format!(
            "radius {} mm",
            armill_study::number::decimals(circle.radius_mm, 3)
        ),
        horizontal: "y'".to_owned(),
        vertical: "z'".to_owned(),
        growth: Growth::Left,
        traces,
        marks: (circle.reversals.iter())
            .map(|reversal| RayMark {
                angle_deg: reversal.at_deg,
                name: reversal.joint.clone(),
            })
            .collect(),
    };
    Picture {
        name: slug(&circle.analysis),
        caption: format!(
            "{}: the runs, magnified; the part common to both directions with the fitted backlash; rays at reversals of joints.",
            circle.analysis
        ),
        svg: picture.to_svg(),
    }
}

fn sense(direction: Direction) -> Sense {
    match direction {
        Direction::Clockwise => Sense::Clockwise,
        Direction::Anticlockwise => Sense::Anticlockwise,
    }
}

fn trace(name: String, direction: Direction, radius: impl Fn(f64) -> f64) -> BallbarTrace {
    BallbarTrace {
        name,
        sense: sense(direction),
        angle_deg: (0..=STATIONS).map(|k| to_deg(station(k))).collect(),
        radial_um: (0..=STATIONS)
            .map(|k| to_um(radius(station(k % STATIONS))))
            .collect(),
        start_deg: None,
    }
}

/// Effect of the backlash of all joints on the radius, m.
fn backlash_effect(followed: &Followed, gaps: &[f64], direction: Direction, angles: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; angles.len()];
    for (joint, gap) in gaps.iter().enumerate() {
        let effect = followed.effect(joint, *gap, direction, angles);
        sum.iter_mut().zip(effect).for_each(|(sum, one)| *sum += one);
    }
    sum
}

/// The part common to all runs without the effect of backlash, at every station, m.
struct Common(Vec<f64>);

impl Common {
    fn of(measured: &MeasuredCircle, followed: &Followed, gaps: &[f64]) -> Common {
        let angles: Vec<f64> = (0..STATIONS).map(station).collect();
        let mut sum = vec![0.0; STATIONS];
        let runs: Vec<&Run> = measured.test.runs().iter().collect();
        for run in &runs {
            let profile = Profile::of(run);
            let effect = backlash_effect(followed, gaps, run.direction(), &angles);
            for (k, sum) in sum.iter_mut().enumerate() {
                let left = profile.at(angles[k]).map_or(f64::NAN, |dr| dr - effect[k]);
                *sum += left / runs.len() as f64;
            }
        }
        Common(sum)
    }
}

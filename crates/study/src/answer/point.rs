//! One point of an answer, and the setting that all points of an ask share.
//!
//! | part of the deviation | meaning |
//! |---|---|
//! | in-plane | across the normal of the plane: largest length of all load cases, what the limit is held against |
//! | normal | along the outward normal, with its sign, of the case where it is largest by size |
//! | full | largest length of all cases |
//!
//! Along a path the normal is the axis of the tool.

use armill_core::compliance::{by_force, permissible_force, permissible_force_in_worst_direction};
use armill_core::kernel::{Answers, Held};
use armill_core::load::LoadFrame;
use armill_core::nalgebra::{Point3, Unit};
use armill_core::workpiece::Plane;
use schemars::JsonSchema;
use serde::Serialize;

use crate::file::resolve::{Setting, Study};
use crate::model_words::parts;
use crate::number::without_rounding;

/// What all points of an ask share. Positions count from the frame `base`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SettingAnswer {
    /// Frame that positions count from.
    pub base: String,
    /// Centre of the plane.
    pub centre_mm: [f64; 3],
    /// Tilt of the plane from the vertical; none where the plane was given by a frame.
    pub tilt_deg: Option<f64>,
    /// Outward normal of the plane, in base axes.
    pub normal_axis: [f64; 3],
    /// Distance of the TCP from the flange.
    pub tool_length_mm: f64,
    /// Axes that forces and moments are told in: `base_link`, or `feed` where they turn with it.
    pub load_frame: &'static str,
    /// Forces on the tool, one a case; none where they come with the path.
    pub cases_n: Vec<[f64; 3]>,
    /// Moments on the tool at the TCP, one a case.
    pub moments_n_m: Vec<[f64; 3]>,
    /// Where the load comes from, in the user's words.
    pub load_source: Option<String>,
    /// Standard uncertainty of the size of the load.
    pub load_u_percent: f64,
    /// Standard uncertainties of the force along three directions: vectors so long, base axes.
    pub load_u_n: [[f64; 3]; 3],
    /// Standard uncertainty of the place of the TCP along the tool axis.
    pub tool_length_u_mm: f64,
    /// Standard deviation of where the tool comes to rest from time to time, along any axis; zero where it is not known.
    pub scatter_um: f64,
    /// Standard uncertainty of what the model predicts, beside that of its compliances; zero where it is not known.
    pub model_error_percent: f64,
    /// The tolerance.
    pub tolerance_um: f64,
    /// Parts of the stiffness model that were on.
    pub model: Vec<String>,
    /// Whom shares are told for: the joints, then base, flange and tool where springs sit.
    pub contributors: Vec<String>,
}

impl SettingAnswer {
    /// The setting told in the frame that the study counts from; a load that turns with the feed in axes of the feed.
    pub(super) fn of(study: &Study, setting: &Setting) -> SettingAnswer {
        let robot = &study.robot.robot;
        let turns = setting.load.frame == LoadFrame::Feed;
        let cases = if turns {
            &setting.load.cases
        } else {
            &setting.cases
        };
        let centre = setting.counted(&setting.plane.base_from_part.translation.vector.into());
        SettingAnswer {
            base: setting.base_name.clone(),
            centre_mm: clean(centre.coords.map(|c| c * 1e3).into()),
            tilt_deg: setting.tilt.map(f64::to_degrees).map(without_rounding),
            normal_axis: clean(setting.plane.normal().into_inner().into()),
            tool_length_mm: without_rounding(setting.flange_from_tool.translation.vector.norm() * 1e3),
            load_frame: if turns { "feed" } else { crate::BASE_LINK },
            cases_n: cases.iter().map(|w| clean(w.force.into())).collect(),
            moments_n_m: cases.iter().map(|w| clean(w.moment.into())).collect(),
            load_source: setting.load_source.clone(),
            load_u_percent: without_rounding(setting.uncertainty.relative * 100.0),
            load_u_n: setting.uncertainty.forces.map(|u| clean(u.into())),
            tool_length_u_mm: without_rounding(setting.uncertainty.tool_length * 1e3),
            scatter_um: setting.model.structure.repeatability * 1e6,
            model_error_percent: without_rounding(setting.model.structure.model_error * 100.0),
            tolerance_um: without_rounding(setting.limit * 1e6),
            model: parts(robot, &setting.model),
            contributors: setting.model.contributor_names(robot.joints()),
        }
    }
}

/// What moves the tool where its arm is not the one that its controller reckons with.
pub(crate) const GEOMETRY: &str = "geometry";

/// A point where the arm holds the tool.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PointAnswer {
    /// TCP in the frame that positions count from.
    pub xyz_mm: [f64; 3],
    /// In-plane coordinates y', z' from the plane's centre.
    pub in_plane_mm: [f64; 2],
    /// Name of the posture: words of a branch, or the sides on which its joints stand.
    pub branch: String,
    /// Joint positions.
    pub joints_deg: Vec<f64>,
    /// Whether every joint stands inside its limits.
    pub within_limits: bool,
    /// Near which singularity, if any.
    pub singularity: Option<String>,
    /// Load case that decides, from 1.
    pub deciding_case: usize,
    /// Largest in-plane deviation of all cases.
    pub in_plane_um: f64,
    /// Its standard uncertainty, from compliances, load, tool length, repeatability and model error.
    pub in_plane_u_um: f64,
    /// Deviation along the outward normal, of the case where it is largest.
    pub normal_um: f64,
    /// Largest length of the deviation of all cases.
    pub full_um: f64,
    /// Share of each of `contributors` in the in-plane deviation; they add up to it (load-dependent: nearly; the
    /// geometry of an `calibrated_robot` is in none).
    pub joint_share_um: Vec<f64>,
    /// Force that keeps the limit in the direction of the deciding case; none where that case has no force or
    /// moves nothing in the plane.
    pub permissible_along_load_n: Option<f64>,
    /// Force that keeps the limit whatever its direction.
    pub permissible_any_direction_n: Option<f64>,
}

impl PointAnswer {
    /// Who of `contributors` has the largest share, by size, or `geometry`, which makes what is in nobody's; and the part of the
    /// in-plane deviation that it makes, where there is any. A share may work against the others.
    pub(crate) fn mostly_by<'a>(&self, contributors: &'a [String]) -> Option<(&'a str, Option<f64>)> {
        let shares = contributors
            .iter()
            .map(String::as_str)
            .zip(self.joint_share_um.iter().copied());
        let (name, share) = shares.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let in_nobodys = self.in_plane_um - self.joint_share_um.iter().sum::<f64>();
        let (name, share) = if in_nobodys.abs() > share.abs() {
            (GEOMETRY, in_nobodys)
        } else {
            (name, share)
        };
        Some((name, (self.in_plane_um > 0.0).then(|| share / self.in_plane_um)))
    }

    /// y', z' of a point of base from the centre of `plane`.
    pub(super) fn in_plane_mm(plane: &Plane, at: &Point3<f64>) -> [f64; 2] {
        let in_part = plane.base_from_part.inverse_transform_point(at);
        [
            without_rounding(-in_part.x * 1e3),
            without_rounding(in_part.y * 1e3),
        ]
    }

    /// The point `at`: index among `answers`, what was held there, TCP (m, base). Permitted forces follow from the
    /// compliance of the unloaded arm there.
    pub(super) fn of(
        study: &Study,
        setting: &Setting,
        answers: &Answers,
        at: (usize, &Held, Point3<f64>),
    ) -> PointAnswer {
        let (index, evaluation, tcp) = at;
        let robot = &study.robot.robot;
        let position = |(i, q): (usize, &f64)| if robot.slides(i) { q * 1e3 } else { q.to_degrees() };
        let compliance = by_force(&setting.compliance_at(robot, answers.joints_at(index)));
        let normal = setting.plane.normal();
        // A case that is a moment alone has no direction.
        let along = Unit::try_new(setting.cases[evaluation.deciding_case].force, 1e-12)
            .map(|f| permissible_force(&compliance, normal, f, setting.limit));
        let any = permissible_force_in_worst_direction(&compliance, normal, setting.limit).0;
        PointAnswer {
            xyz_mm: clean(setting.counted(&tcp).coords.map(|c| c * 1e3).into()),
            in_plane_mm: PointAnswer::in_plane_mm(&setting.plane, &tcp),
            branch: evaluation.name.to_string(),
            joints_deg: answers
                .joints_at(index)
                .iter()
                .enumerate()
                .map(position)
                .collect(),
            within_limits: evaluation.within_limits(),
            singularity: evaluation.singularity.map(|s| s.to_string()),
            deciding_case: evaluation.deciding_case + 1,
            in_plane_um: evaluation.in_plane * 1e6,
            in_plane_u_um: evaluation.in_plane_uncertainty * 1e6,
            normal_um: evaluation.normal * 1e6,
            full_um: evaluation.full * 1e6,
            joint_share_um: answers.shares_at(index).iter().map(|share| share * 1e6).collect(),
            permissible_along_load_n: along.filter(|n| n.is_finite()),
            permissible_any_direction_n: Some(any).filter(|n| n.is_finite()),
        }
    }
}

/// Three numbers as they were meant, without what changes of frame leave behind.
fn clean(values: [f64; 3]) -> [f64; 3] {
    values.map(without_rounding)
}

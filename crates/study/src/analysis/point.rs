//! One point of an answer, and the setting that all points of an analysis share.
//!
//! | part of the deviation | meaning |
//! |---|---|
//! | in-plane | across the normal of the plane: largest length of all load cases, compared with the tolerance |
//! | normal | along the outward normal, with its sign, of the case where it is largest by size |
//! | full | largest length of all cases |
//!
//! Along a path the normal is the axis of the tool.

use armill_core::compliance::{by_force, permissible_force, permissible_force_in_worst_direction};
use armill_core::kernel::{Answers, Evaluation};
use armill_core::load::LoadFrame;
use armill_core::nalgebra::{Point3, Unit};
use armill_core::robot::Robot;
use armill_core::units::{to_deg, to_mm, to_um};
use armill_core::workpiece::Plane;
use schemars::JsonSchema;
use serde::Serialize;

use crate::input::setting::Setting;
use crate::joint_order::{in_joint_order, shown_positions};
use crate::model_words::parts;
use crate::naming::usual_reference;
use crate::number::without_rounding;

/// The common setting of all points of an analysis. Positions are relative to the frame `base`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SettingAnswer {
    /// Reference frame of positions.
    pub base: String,
    /// Centre of the plane.
    pub centre_mm: [f64; 3],
    /// Tilt of the plane from the vertical; none if the plane was given by a rotation.
    pub tilt_deg: Option<f64>,
    /// Outward normal of the plane, in base axes.
    pub normal_axis: [f64; 3],
    /// Distance of the TCP from the flange.
    pub tool_length_mm: f64,
    /// Axes of forces and moments: `base_link`, or `feed` if they turn with it.
    pub load_frame: &'static str,
    /// Forces on the tool, one a case; none if they come with the path.
    pub cases_n: Vec<[f64; 3]>,
    /// Moments on the tool at the TCP, one a case.
    pub moments_n_m: Vec<[f64; 3]>,
    /// Source of the load, in the user's words.
    pub load_source: Option<String>,
    /// Standard uncertainty of the size of the load.
    pub load_u_percent: f64,
    /// Standard uncertainties of the force along three directions: vectors of that length, base axes.
    pub load_u_n: [[f64; 3]; 3],
    /// Standard uncertainty of the position of the TCP along the tool axis.
    pub tool_length_u_mm: f64,
    /// Standard deviation of the repeated position of the tool, along any axis; none if it is not known.
    pub scatter_um: Option<f64>,
    /// Standard uncertainty of the model, in addition to that of its compliances; none if it is not known.
    pub model_error_percent: Option<f64>,
    /// Inputs that have an effect, but no uncertainty.
    pub inputs_without_uncertainty: Vec<String>,
    /// The tolerance.
    pub tolerance_um: f64,
    /// Active parts of the stiffness model.
    pub model: Vec<String>,
    /// The contributors of `share_um`: the joints; base, flange and tool if springs are attached there;
    /// geometry with a calibrated robot; thermal growth; learnt residual; blending and servo of a motion.
    pub contributors: Vec<String>,
}

impl SettingAnswer {
    /// The setting in the reference frame of the study; a load that turns with the feed in axes of the feed.
    pub fn of(robot: &Robot, setting: &Setting) -> SettingAnswer {
        let given = |value: f64| (value > 0.0).then_some(value);
        let turns = setting.load.frame == LoadFrame::Feed;
        let cases = if turns {
            &setting.load.cases
        } else {
            &setting.cases
        };
        let centre = setting.in_reference(&setting.plane.base_from_part.translation.vector.into());
        SettingAnswer {
            base: setting.base_name.clone(),
            centre_mm: clean(centre.coords.map(to_mm).into()),
            tilt_deg: setting.tilt.map(to_deg).map(without_rounding),
            normal_axis: clean(setting.plane.normal().into_inner().into()),
            tool_length_mm: without_rounding(to_mm(setting.flange_from_tool.translation.vector.norm())),
            load_frame: if turns { "feed" } else { usual_reference(robot) },
            cases_n: cases.iter().map(|w| clean(w.force.into())).collect(),
            moments_n_m: cases.iter().map(|w| clean(w.moment.into())).collect(),
            load_source: setting.load_source.clone(),
            load_u_percent: without_rounding(setting.uncertainty.relative * 100.0),
            load_u_n: setting.uncertainty.forces.map(|u| clean(u.into())),
            tool_length_u_mm: without_rounding(to_mm(setting.uncertainty.tool_length)),
            scatter_um: given(setting.model.structure.repeatability).map(to_um),
            model_error_percent: given(setting.model.structure.model_error)
                .map(|part| without_rounding(part * 100.0)),
            inputs_without_uncertainty: setting.inputs_without_uncertainty(robot),
            tolerance_um: without_rounding(to_um(setting.tolerance)),
            model: parts(robot, &setting.model),
            contributors: setting.contributor_names(robot),
        }
    }
}

/// A reached point of an analysis.
pub struct ReachedPoint<'a> {
    /// The points of the analysis.
    pub answers: &'a Answers,
    /// Its index among them.
    pub index: usize,
    /// Its evaluation.
    pub evaluation: &'a Evaluation,
    /// The TCP, m, base.
    pub tcp: Point3<f64>,
}

/// A reached point.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PointAnswer {
    /// TCP in the reference frame.
    pub xyz_mm: [f64; 3],
    /// In-plane coordinates y', z' from the plane's centre.
    pub in_plane_mm: [f64; 2],
    /// Name of the posture: words of a branch, or the side of the middle of each joint.
    pub branch: String,
    /// Joint positions.
    pub joints_deg: Vec<f64>,
    /// Whether every joint is inside its limits.
    pub within_limits: bool,
    /// Near which singularity, if any.
    pub singularity: Option<String>,
    /// Worst load case, from 1.
    pub worst_case: usize,
    /// Largest in-plane deviation of all cases.
    pub in_plane_um: f64,
    /// Its standard uncertainty, from compliances, load, tool length, repeatability and model error; none where it is
    /// not known, a lower bound where `inputs_without_uncertainty` of the setting names any.
    pub in_plane_u_um: Option<f64>,
    /// Deviation along the outward normal, of the case where it is largest.
    pub normal_um: f64,
    /// Largest length of the deviation of all cases.
    pub full_um: f64,
    /// Share of each of `contributors` in the in-plane deviation; their sum is the deviation (nearly, with a
    /// load-dependent model).
    pub joint_share_um: Vec<f64>,
    /// Force that meets the tolerance in the direction of the worst case; none if that case has no force or
    /// no in-plane deviation.
    pub permissible_along_load_n: Option<f64>,
    /// Force that meets the tolerance in any direction.
    pub permissible_any_direction_n: Option<f64>,
}

impl PointAnswer {
    /// Which of `contributors` has the largest share, by size, and its part of the in-plane deviation, if there is any. A
    /// share may be opposite to the others.
    pub fn mostly_by<'a>(&self, contributors: &'a [String]) -> Option<(&'a str, Option<f64>)> {
        let shares = contributors
            .iter()
            .map(String::as_str)
            .zip(self.joint_share_um.iter().copied());
        let (name, share) = shares.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some((name, (self.in_plane_um > 0.0).then(|| share / self.in_plane_um)))
    }

    /// y', z' of a point of base from the centre of `plane`.
    pub fn in_plane_mm(plane: &Plane, at: &Point3<f64>) -> [f64; 2] {
        let in_part = plane.base_from_part.inverse_transform_point(at);
        [
            without_rounding(to_mm(-in_part.x)),
            without_rounding(to_mm(in_part.y)),
        ]
    }

    /// The point under this setting. Permitted forces follow from the compliance of the unloaded arm there.
    pub fn of(robot: &Robot, setting: &Setting, point: &ReachedPoint<'_>) -> PointAnswer {
        let ReachedPoint {
            answers,
            index,
            evaluation,
            tcp,
        } = *point;
        let compliance = by_force(&setting.compliance_at(robot, answers.joints_at(index)));
        let normal = setting.plane.normal();
        // A case that is a moment alone has no direction.
        let along = Unit::try_new(setting.cases[evaluation.worst_case].force, 1e-12)
            .map(|f| permissible_force(&compliance, normal, f, setting.tolerance));
        let any = permissible_force_in_worst_direction(&compliance, normal, setting.tolerance).0;
        PointAnswer {
            xyz_mm: clean(setting.in_reference(&tcp).coords.map(to_mm).into()),
            in_plane_mm: PointAnswer::in_plane_mm(&setting.plane, &tcp),
            branch: evaluation.name.to_string(),
            joints_deg: shown_positions(robot, answers.joints_at(index)),
            within_limits: evaluation.within_limits(),
            singularity: evaluation.singularity.map(|s| s.to_string()),
            worst_case: evaluation.worst_case + 1,
            in_plane_um: to_um(evaluation.in_plane),
            in_plane_u_um: evaluation.in_plane_uncertainty.map(to_um),
            normal_um: to_um(evaluation.normal),
            full_um: to_um(evaluation.full),
            joint_share_um: in_joint_order(robot, answers.shares_at(index))
                .iter()
                .map(to_um)
                .collect(),
            permissible_along_load_n: along.filter(|n| n.is_finite()),
            permissible_any_direction_n: Some(any).filter(|n| n.is_finite()),
        }
    }
}

/// Three numbers without the rounding of frame changes.
fn clean(values: [f64; 3]) -> [f64; 3] {
    values.map(without_rounding)
}

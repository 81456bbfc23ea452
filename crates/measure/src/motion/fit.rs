//! The acceleration along the path, the window, the lag, the time to settle at stops and the leads of the motors with which the model has the speeds of a log and leaves its lines as it does, by least squares over all
//! stretches that stop at their corners.
//!
//! Speeds come first, without leads; then leads alone, for the offsets from the lines; then all together, each kind of residual over its own root mean square before: a lead times the
//! acceleration is what the offsets show, so that either changes the other.

use armill_core::motion::MotionModel;

use super::leads::{Leads, WRIST, off_lines, rms_of_vectors};
use super::least_squares::{Fitted, Parameter, least_squares};
use super::observed::Observed;
use super::simulate::{Arm, Predicted, predicted, with};

/// Where the search begins: window, lag and time to settle, s.
const START: [f64; 3] = [0.03, 0.01, 0.01];
/// Least acceleration, m/s^2.
const LEAST: f64 = 0.05;
/// Step of the derivatives by a lead, s^2.
const LEAD_STEP: f64 = 1e-5;
/// Parameters of all stretches together.
const COMMON: usize = 4;

/// Values with their standard uncertainties.
#[derive(Clone, Debug)]
pub(super) struct LearntModel {
    /// Acceleration along the path, m/s^2, window, lag and time to settle, s.
    pub values: [f64; 4],
    /// Their standard uncertainties; infinite where the log does not determine them.
    pub u: [f64; 4],
    /// Correlation of window and lag.
    pub window_and_lag: f64,
    /// Feed of each stretch, m/s.
    pub feeds: Vec<f64>,
    /// Time at which the motion of each stretch starts, s.
    pub starts: Vec<f64>,
    /// Root mean square of the difference of the speeds, m/s.
    pub rms: f64,
    /// Leads of the motors; none where they explain nothing.
    pub leads: Option<Leads>,
}

/// The values for these stretches; the limits of the joints are those of `model`.
pub(super) fn fit(arm: Arm<'_>, stretches: &[&Observed], model: &MotionModel) -> LearntModel {
    let without = MotionModel {
        motor_leads: Vec::new(),
        ..model.clone()
    };
    let fitting = |model| Fitting {
        arm,
        stretches,
        model,
    };
    let own = fitting(&without);
    let by_speed = own.by_speed();
    let first = own.leads(&by_speed);
    match Some(first).filter(Leads::explain) {
        Some(first) => own.together(&by_speed, &first),
        // Those of the robot file.
        None if !model.motor_leads.is_empty() => fitting(model).by_speed(),
        None => by_speed,
    }
}

/// What is fitted.
struct Fitting<'a> {
    arm: Arm<'a>,
    stretches: &'a [&'a Observed],
    model: &'a MotionModel,
}

impl Fitting<'_> {
    /// Acceleration, times, feeds and starts for the speeds alone.
    fn by_speed(&self) -> LearntModel {
        let reached = self.stretches.iter().map(|stretch| stretch.acceleration);
        let start = [reached.fold(LEAST, f64::max), START[0], START[1], START[2]];
        let first = with(self.model, start);
        let own: Vec<[f64; 2]> = (self.stretches.iter())
            .map(|stretch| {
                let stops = vec![None; stretch.corners.len()];
                let begun = predicted(self.arm, stretch, &first, stretch.feed, &stops);
                [stretch.feed, begun.start(stretch)]
            })
            .collect();
        let parameters = parameters(start, &[], &own);
        let found = least_squares(&parameters, |p| self.speeds(p, COMMON, &self.model.motor_leads));
        let speeds = self.speeds(&found.values, COMMON, &self.model.motor_leads);
        learnt(&found, COMMON, &speeds)
    }

    /// The leads alone, for the offsets from the lines, with the speeds that were fitted.
    fn leads(&self, fitted: &LearntModel) -> Leads {
        let joints = self.arm.robot.joints().len();
        let free = joints.saturating_sub(WRIST).max(1);
        let own = fitted.feeds.iter().zip(&fitted.starts);
        let common: Vec<f64> = fitted
            .values
            .into_iter()
            .chain(own.flat_map(|(feed, start)| [*feed, *start]))
            .collect();
        let offsets = |leads: &[f64]| self.offsets(&common, COMMON, leads);
        let parameter = Parameter {
            start: 0.0,
            step: LEAD_STEP,
            least: f64::NEG_INFINITY,
        };
        let before = rms_of_vectors(&offsets(&vec![0.0; free]));
        let found = least_squares(&vec![parameter; free], offsets);
        let left = rms_of_vectors(&offsets(&found.values));
        Leads::none(joints, before).with(&found.values, &found.u, left)
    }

    /// All together.
    fn together(&self, by_speed: &LearntModel, first: &Leads) -> LearntModel {
        let free = first.free();
        let common = COMMON + free;
        let own: Vec<[f64; 2]> = by_speed
            .feeds
            .iter()
            .zip(&by_speed.starts)
            .map(|(feed, start)| [*feed, *start])
            .collect();
        let parameters = parameters(by_speed.values, &first.values[..free], &own);
        let [of_speed, of_offset] = [1.0 / by_speed.rms, 1.0 / first.off_line[1]];
        let found = least_squares(&parameters, |p| {
            let leads = &p[COMMON..common];
            let mut all: Vec<f64> = self
                .speeds(p, common, leads)
                .iter()
                .map(|r| r * of_speed)
                .collect();
            all.extend(self.offsets(p, common, leads).iter().map(|r| r * of_offset));
            all
        });
        let leads = &found.values[COMMON..common];
        let left = rms_of_vectors(&self.offsets(&found.values, common, leads));
        let speeds = self.speeds(&found.values, common, leads);
        let mut learnt = learnt(&found, common, &speeds);
        learnt.leads = Some(first.with(leads, &found.u[COMMON..common], left));
        learnt
    }

    /// Predicted less logged speeds, m/s, with these parameters, of which the first `common` are those of all stretches.
    fn speeds(&self, p: &[f64], common: usize, leads: &[f64]) -> Vec<f64> {
        self.each(p, common, leads, |found, stretch, start| {
            found.residuals(stretch, start)
        })
    }

    /// Predicted less logged offsets from the lines, m, three coordinates each.
    fn offsets(&self, p: &[f64], common: usize, leads: &[f64]) -> Vec<f64> {
        self.each(p, common, leads, off_lines)
    }

    fn each(
        &self,
        p: &[f64],
        common: usize,
        leads: &[f64],
        residuals: impl Fn(&Predicted, &Observed, f64) -> Vec<f64>,
    ) -> Vec<f64> {
        let mut model = with(self.model, std::array::from_fn(|k| p[k]));
        model.motor_leads = leads.to_vec();
        let all = self.stretches.iter().enumerate().flat_map(|(k, stretch)| {
            let (feed, start) = (p[common + 2 * k], p[common + 2 * k + 1]);
            let stops = vec![None; stretch.corners.len()];
            residuals(
                &predicted(self.arm, stretch, &model, feed, &stops),
                stretch,
                start,
            )
        });
        all.collect()
    }
}

/// What was fitted; the first `common` parameters are those of all stretches. `speeds`: predicted less logged, m/s.
fn learnt(found: &Fitted, common: usize, speeds: &[f64]) -> LearntModel {
    let squares: f64 = speeds.iter().map(|r| r * r).sum();
    let own = |which: usize| {
        let all = found.values[common + which..].iter();
        all.step_by(2).copied().collect()
    };
    LearntModel {
        values: std::array::from_fn(|k| found.values[k]),
        u: std::array::from_fn(|k| found.u[k]),
        window_and_lag: found.correlation[(1, 2)],
        feeds: own(0),
        starts: own(1),
        rms: (squares / speeds.len().max(1) as f64).sqrt(),
        leads: None,
    }
}

/// Parameters that begin there: acceleration, window, lag and time to settle, leads, and feed and start of each stretch.
fn parameters(
    [acceleration, window, lag, settling]: [f64; 4],
    leads: &[f64],
    own: &[[f64; 2]],
) -> Vec<Parameter> {
    let parameter = |start: f64, step: f64, least: f64| Parameter { start, step, least };
    let common = [
        parameter(acceleration, 1e-3 * acceleration, LEAST),
        parameter(window, 5e-4, 0.0),
        parameter(lag, 2e-4, 0.0),
        parameter(settling, 5e-4, 0.0),
    ];
    let leads = leads
        .iter()
        .map(|lead| parameter(*lead, LEAD_STEP, f64::NEG_INFINITY));
    let own = own.iter().flat_map(|[feed, start]| {
        [
            parameter(*feed, 1e-3 * feed, 0.1 * feed),
            parameter(*start, 1e-3, f64::NEG_INFINITY),
        ]
    });
    common.into_iter().chain(leads).chain(own).collect()
}

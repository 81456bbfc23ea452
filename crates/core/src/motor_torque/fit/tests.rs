use super::*;
use crate::arms::{CorrelatedNoise, log_times};
use crate::motor_torque::load::of_own_position;

const COULOMB: f64 = 1.5;
const VISCOUS: f64 = 4.0;
const INERTIA: f64 = 0.8;
const COSINE: f64 = -12.0;
const SINE: f64 = 3.0;

/// A simulated log: motion and its derivatives in closed form, torque with correlated noise of first order.
struct Simulated {
    times: Vec<f64>,
    motor: Vec<f64>,
    torque: Vec<f64>,
    loads: Vec<LoadTerm>,
}

impl Simulated {
    fn of(constant: f64, amplitude: f64, seed: u64) -> Simulated {
        let mut noise = CorrelatedNoise::new(seed);
        let motion = |t: f64| {
            let [a, b] = [amplitude, amplitude / 4.0];
            let [w, v] = [0.9, 3.1];
            [
                0.3 + a * (w * t).sin() + b * (v * t).sin(),
                a * w * (w * t).cos() + b * v * (v * t).cos(),
                -a * w * w * (w * t).sin() - b * v * v * (v * t).sin(),
            ]
        };
        let times = log_times(5000);
        let torque = times.iter().map(|t| {
            let [q, v, a] = motion(*t);
            COULOMB * v.signum()
                + VISCOUS * v
                + INERTIA * a
                + COSINE * q.cos()
                + SINE * q.sin()
                + constant
                + noise.next(0.1)
        });
        let motor: Vec<f64> = times.iter().map(|t| motion(*t)[0]).collect();
        Simulated {
            torque: torque.collect(),
            loads: of_own_position(&motor),
            motor,
            times,
        }
    }

    fn signals(&self) -> MotorSignals<'_> {
        MotorSignals {
            times: &self.times,
            motor: &self.motor,
            torque: &self.torque,
            loads: &self.loads,
        }
    }
}

/// Of 100 logs, as many values are within one and two stated uncertainties as of a normal distribution (68 % and 95 %), less three standard
/// deviations of the counts (14 and 6.5); none is beyond five.
#[test]
fn simulated_values_are_found_within_their_uncertainty() {
    let mut within = [[0; 2]; 6];
    for seed in 0..100 {
        let found = fit(&Simulated::of(0.7, 1.5, seed).signals()).unwrap();
        let pairs = [
            (found.coulomb.unwrap(), COULOMB),
            (found.viscous.unwrap(), VISCOUS),
            (found.inertia.unwrap(), INERTIA),
            (found.loads[0].estimate, COSINE),
            (found.loads[1].estimate, SINE),
            (found.constant.unwrap(), 0.7),
        ];
        for (index, (estimate, given)) in pairs.into_iter().enumerate() {
            let apart = (estimate.value - given).abs() / estimate.u;
            assert!(
                apart < 5.0,
                "value {index}, seed {seed}: {estimate:?} for {given}"
            );
            within[index][0] += usize::from(apart < 1.0);
            within[index][1] += usize::from(apart < 2.0);
        }
        assert!(found.left_out.is_empty() && found.inseparable.is_empty());
        assert!(found.loads.iter().all(|load| load.unit == LoadUnit::Torque));
    }
    assert!(
        within.iter().all(|[one, two]| *one >= 54 && *two >= 88),
        "{within:?}"
    );
}

/// Within 0.1 rad the cosine is a constant to 0.5 %.
#[test]
fn a_constant_part_that_is_like_the_load_is_left_out_and_named() {
    let found = fit(&Simulated::of(0.0, 0.1, 1).signals()).unwrap();
    assert!(found.constant.is_none());
    assert_eq!(found.left_out, ["constant part"]);
    assert!((found.coulomb.unwrap().value - COULOMB).abs() < 5.0 * found.coulomb.unwrap().u);
}

#[test]
fn another_log_is_predicted_to_its_noise() {
    let found = fit(&Simulated::of(0.7, 1.5, 1).signals()).unwrap();
    let other = Simulated::of(0.9, 1.5, 2);
    let [before, after, own] = found.prediction_rms(&other.signals()).unwrap();
    // Noise of first order: 0.1/sqrt(1 - 0.81); the constant part differs by 0.2.
    let noise = 0.1 / 0.19_f64.sqrt();
    assert!((own / noise - 1.0).abs() < 0.1, "{own}");
    assert!((after / noise.hypot(0.2) - 1.0).abs() < 0.15, "{after}");
    assert!(before > 5.0, "{before}");
    let bare = MotorSignals {
        loads: &[],
        ..other.signals()
    };
    assert!(found.prediction_rms(&bare).is_none());
}

#[test]
fn what_a_log_does_not_contain_is_not_determined() {
    let mut simulated = Simulated::of(0.7, 1.5, 3);
    let short = MotorSignals {
        times: &simulated.times[..40],
        ..simulated.signals()
    };
    assert!(fit(&short).is_none());
    // At a constant speed there is no inertia, and friction is one value.
    simulated.motor = simulated.times.iter().map(|t| 0.3 * t).collect();
    simulated.loads = of_own_position(&simulated.motor);
    simulated.torque = simulated
        .motor
        .iter()
        .enumerate()
        .map(|(k, q)| 2.0 + COSINE * q.cos() + SINE * q.sin() + 0.01 * f64::from((k * 7919 % 13) as u32))
        .collect();
    let found = fit(&simulated.signals()).unwrap();
    assert!(found.viscous.is_none() && found.constant.is_none());
    assert!((found.loads[0].estimate.value - COSINE).abs() < 0.1, "{found:?}");
    simulated.motor.fill(0.2);
    assert!(fit(&simulated.signals()).is_none());
}

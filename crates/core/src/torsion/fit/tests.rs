use super::*;
use crate::arms::{CorrelatedNoise, Stream, log_times};

/// A simulated log: motion in closed form, so that the delayed signal is exact.
struct Simulated {
    times: Vec<f64>,
    motor: Vec<f64>,
    link: Vec<f64>,
    torque: Vec<f64>,
}

const COMPLIANCE: f64 = 2e-5;
const STEP: f64 = -4e-5;
const OFFSET: f64 = 1e-3;

impl Simulated {
    fn of(delay: f64, torque_noise: f64, seed: u64) -> Simulated {
        let (mut noise, mut slow) = (Stream(seed), CorrelatedNoise::new(seed + 1_000_000));
        let motor = |t: f64| 0.4 * (1.3 * t).sin() + 0.1 * (4.1 * t).sin();
        let speed = |t: f64| 0.52 * (1.3 * t).cos() + 0.41 * (4.1 * t).cos();
        let torque = |t: f64| 8.0 * (2.1 * t).cos() + 5.0 * (0.7 * t).sin() + 3.0 * (5.3 * t).sin();
        let times = log_times(2500);
        let true_link = |t: f64| motor(t) + OFFSET - COMPLIANCE * torque(t) + STEP * speed(t).signum();
        let link = times.iter().map(|t| true_link(t - delay) + slow.next(3e-6));
        Simulated {
            link: link.collect(),
            motor: times.iter().map(|t| motor(*t)).collect(),
            torque: times
                .iter()
                .map(|t| torque(*t) + torque_noise * noise.normal())
                .collect(),
            times,
        }
    }

    fn signals(&self) -> Signals<'_> {
        Signals {
            times: &self.times,
            motor: &self.motor,
            link: &self.link,
            torque: &self.torque,
        }
    }
}

/// Of 120 logs, as many values are within one and two stated uncertainties as of a normal distribution (68 % and 95 %), less three standard
/// deviations of the counts (12.8 % and 6 %); none is beyond five.
#[test]
fn simulated_values_are_found_within_their_uncertainty() {
    let mut within = [[0; 2]; 3];
    for (delay, seed) in [0.0, 0.003, -0.0047]
        .into_iter()
        .flat_map(|delay| (0..40).map(move |seed| (delay, seed)))
    {
        let simulated = Simulated::of(delay, 1.0, seed);
        let found = fit(&simulated.signals(), None).unwrap();
        let pairs = [
            (found.delay.unwrap(), delay),
            (found.compliance.unwrap(), COMPLIANCE),
            (found.reversal.unwrap(), STEP),
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
        assert!(found.compliance.unwrap().is_found() && found.reversal.unwrap().is_found());
    }
    assert!(
        within.iter().all(|[one, two]| *one >= 66 && *two >= 107),
        "{within:?}"
    );
}

#[test]
fn noise_alone_has_no_compliance_and_no_step() {
    let mut found = 0;
    for seed in 0..40 {
        let mut simulated = Simulated::of(0.0, 1.0, seed);
        let mut noise = Stream(seed + 1000);
        simulated.link = simulated
            .motor
            .iter()
            .map(|motor| motor + 1e-5 * noise.normal())
            .collect();
        let torsion = fit(&simulated.signals(), Some((100.0, 2))).unwrap();
        let all = [
            torsion.delay,
            torsion.compliance,
            torsion.reversal,
            Some(torsion.offset),
        ];
        found += all.into_iter().flatten().filter(Estimate::is_found).count();
        found += torsion
            .harmonics
            .iter()
            .filter(|harmonic| harmonic.amplitude.value > 4.0 * harmonic.amplitude.u)
            .count();
    }
    // 240 values, of which 0.3 % are beyond three standard uncertainties.
    assert!(found <= 3, "{found}");
}

#[test]
fn a_transmission_error_of_the_motor_shaft_is_found() {
    let mut simulated = Simulated::of(0.0, 0.0, 7);
    for (link, motor) in simulated.link.iter_mut().zip(&simulated.motor) {
        *link += 5e-5 * (2.0 * 100.0 * motor + 0.3).sin();
    }
    let found = fit(&simulated.signals(), Some((100.0, 2))).unwrap();
    let [first, second] = [found.harmonics[0].amplitude, found.harmonics[1].amplitude];
    assert!(
        (second.value - 5e-5).abs() < 3.0 * second.u && second.is_found(),
        "{second:?}"
    );
    assert!(first.value < 4.0 * first.u, "{first:?}");
}

#[test]
fn what_a_log_does_not_contain_is_not_determined() {
    let mut simulated = Simulated::of(0.003, 0.0, 3);
    simulated.torque.fill(4.0);
    let found = fit(&simulated.signals(), None).unwrap();
    assert!(found.compliance.is_none() && found.delay.is_some());
    simulated.motor.fill(0.2);
    let found = fit(&simulated.signals(), None).unwrap();
    assert!(found.delay.is_none() && found.reversal.is_none());
    let short = Signals {
        times: &simulated.times[..40],
        ..simulated.signals()
    };
    assert!(fit(&short, None).is_none());
    // A torque that is proportional to the direction.
    let mut alike = Simulated::of(0.0, 0.0, 3);
    let speed = |t: f64| 0.52 * (1.3 * t).cos() + 0.41 * (4.1 * t).cos();
    alike.torque = alike
        .times
        .iter()
        .map(|t| 5.0 * (40.0 * speed(*t)).tanh())
        .collect();
    let found = fit(&alike.signals(), None).unwrap();
    assert!(
        found
            .inseparable
            .iter()
            .any(|pair| pair.0 == "compliance" && pair.1 == "step at reversal"),
        "{:?}",
        found.inseparable
    );
}

#[test]
fn another_log_is_predicted_to_its_noise() {
    let found = fit(&Simulated::of(0.003, 0.0, 1).signals(), None).unwrap();
    let other = Simulated::of(0.003, 0.0, 2);
    let [whole, about_mean] = found.prediction_rms(&other.signals()).unwrap();
    // Noise of first order: 3e-6/sqrt(1 - 0.81).
    assert!(
        whole < 1.5 * 6.9e-6 && about_mean <= whole,
        "{whole} {about_mean}"
    );
    assert!(other.signals().difference_rms() > 5e-5);
}

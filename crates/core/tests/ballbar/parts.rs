//! Errors of a simulated machine are recovered from its circular test.

use std::f64::consts::TAU;

use armill_core::measure::ballbar::parts::{
    Axis, Part, Parts, PartsOptions, Reversal, Step, Term, Wave, of_axes, parts, periods, strongest_period,
};
use armill_core::measure::ballbar::{CircularTest, Direction, Run};

use crate::machine::{Machine, RADIUS, Random};

fn requested(most_lobes: usize, period: Option<f64>) -> PartsOptions {
    PartsOptions {
        reversals: of_axes(["X", "Y"]),
        most_lobes,
        period,
    }
}

fn part(parts: &Parts, term: Term) -> &Part {
    parts.of(term).unwrap_or_else(|| panic!("no {term:?}"))
}

/// Every error at once.
const ALL: Machine = Machine {
    scale: [120e-6, -40e-6],
    squareness: 150e-6,
    gap: [18e-6, 7e-6],
    late: [60e-6, 20e-6],
    offset: [35e-6, -22e-6],
    cyclic: [[1.5e-6, 0.01], [0.8e-6, 0.01]],
    lobes: 3e-6,
    noise: 0.0,
    drift: 0.0,
};

/// True values of the machine errors, m.
fn truth(machine: &Machine) -> Vec<(Term, f64)> {
    let [a, b] = machine.scale;
    let mut all = vec![
        (Term::Radius, RADIUS * (a + b) / 2.0),
        (Term::Offset(Axis::A), machine.offset[0]),
        (Term::Offset(Axis::B), machine.offset[1]),
        (Term::ScaleMismatch, RADIUS * (a - b) / 2.0),
        (Term::Squareness, RADIUS * machine.squareness / 2.0),
        (Term::DirectionRadius, 0.0),
        (
            Term::ServoMismatch,
            0.1 * (machine.late[0] - machine.late[1]) / 2.0,
        ),
        (Term::Lobes(3, Wave::Cosine), machine.lobes),
        (Term::Lobes(3, Wave::Sine), 0.0),
    ];
    for end in 0..4 {
        all.push((Term::Reversal(end), machine.gap[end / 2]));
    }
    all
}

#[test]
fn every_error_of_a_machine_is_recovered_without_noise() {
    let found = parts(&ALL.test([1, 1], 1440, 1), &requested(3, Some(0.01))).unwrap();
    // What is left are products of the errors: 150e-6 of 18e-6, squares over the radius.
    for (term, value) in truth(&ALL) {
        let given = part(&found, term).value;
        assert!((given - value).abs() < 0.06e-6, "{term:?}: {given} for {value}");
    }
    for (axis, height) in [(Axis::A, 1.5e-6), (Axis::B, 0.8e-6)] {
        let given = part(&found, Term::Cyclic(axis, Wave::Sine)).value;
        assert!((given - height).abs() < 0.03e-6, "{axis:?}: {given}");
        assert!(part(&found, Term::Cyclic(axis, Wave::Cosine)).value.abs() < 0.03e-6);
    }
    assert!(found.together.is_empty() && found.rms_after < 0.05e-6 && found.rms_before > 5e-6);
}

#[test]
fn intervals_contain_the_true_value_in_95_percent() {
    for (runs, drift, [least, most]) in [
        ([1, 1], 0.0, [0.90, 0.99]),
        ([2, 2], 0.0, [0.90, 0.99]),
        ([2, 2], 1e-6, [0.90, 1.0]),
        ([4, 4], 1e-6, [0.90, 1.0]),
    ] {
        let machine = Machine {
            noise: 0.7e-6,
            drift,
            cyclic: [[0.0, 0.01]; 2],
            ..ALL
        };
        // Products of the errors are in the truth too: it is what the machine shows without noise.
        let still = Machine {
            noise: 0.0,
            drift: 0.0,
            ..machine
        };
        let truth = parts(&still.test([1, 1], 360, 0), &requested(3, None)).unwrap();
        let (mut contained, mut all) = (0, 0);
        for seed in 0..60 {
            let found = parts(&machine.test(runs, 360, seed), &requested(3, None)).unwrap();
            for Part { term, value, .. } in &truth.parts {
                let Part { value: given, u, .. } = part(&found, *term);
                contained += usize::from((given - value).abs() <= 2.0 * u);
                all += 1;
            }
        }
        let share = contained as f64 / all as f64;
        assert!((least..=most).contains(&share), "{runs:?} {drift}: {share}");
    }
}

#[test]
fn drift_between_runs_increases_the_uncertainty_of_what_drifts() {
    let steady = Machine { noise: 0.5e-6, ..ALL };
    let drifting = Machine {
        drift: 5e-6,
        ..steady
    };
    let u = |machine: Machine| {
        let found = parts(&machine.test([3, 3], 360, 5), &requested(3, Some(0.01))).unwrap();
        part(&found, Term::Radius).u
    };
    // 5 um over the root of six runs.
    let drifts = u(drifting);
    assert!(
        drifts > 10.0 * u(steady) && (1e-6..6e-6).contains(&drifts),
        "{drifts}"
    );
}

#[test]
fn a_single_direction_reports_what_is_not_identifiable() {
    let found = parts(&ALL.test([1, 0], 720, 2), &requested(3, Some(0.01))).unwrap();
    let sets = [
        [Term::Radius, Term::DirectionRadius],
        [Term::Squareness, Term::ServoMismatch],
    ];
    for set in sets {
        assert!(found.together.contains(&set.to_vec()), "{:?}", found.together);
        assert!(found.of(set[0]).is_some() && found.of(set[1]).is_none());
    }
    // Clockwise, the servo mismatch of +2 um is 2 um of squareness: the reported value is the sum.
    let sum = RADIUS * 150e-6 / 2.0 + 0.1 * 40e-6 / 2.0;
    assert!((part(&found, Term::Squareness).value - sum).abs() < 0.06e-6);
    // A step is a step, whichever way.
    assert!((part(&found, Term::Reversal(0)).value - 18e-6).abs() < 0.1e-6);
}

#[test]
fn an_arc_reports_what_it_can_with_larger_uncertainty() {
    let machine = Machine {
        noise: 0.5e-6,
        cyclic: [[0.0, 0.01]; 2],
        lobes: 0.0,
        ..ALL
    };
    let whole = machine.test([1, 1], 720, 3);
    let arc = |run: &Run| {
        let outside = |a: f64| a.rem_euclid(TAU) > 220_f64.to_radians();
        let places: Vec<usize> = (0..720).filter(|k| outside(run.angle()[*k])).collect();
        run.without(&places).unwrap()
    };
    let arcs = CircularTest::new(RADIUS, whole.runs().iter().map(arc).collect()).unwrap();
    let [whole, arcs] = [whole, arcs].map(|test| parts(&test, &requested(2, None)));
    let (whole, arcs) = (whole.unwrap(), arcs.unwrap());
    for term in [Term::Radius, Term::ScaleMismatch] {
        assert!(part(&arcs, term).u > 2.0 * part(&whole, term).u, "{term:?}");
    }
    // No sample is near 270 degrees, and none before 0.
    assert_eq!(arcs.together, [vec![Term::Reversal(0)], vec![Term::Reversal(3)]]);
    assert!(arcs.of(Term::Reversal(3)).is_none() && whole.together.is_empty());
}

#[test]
fn scales_of_an_arc_scatter_by_their_uncertainty() {
    let machine = Machine {
        noise: 1e-6,
        cyclic: [[0.0, 0.01]; 2],
        lobes: 0.0,
        ..ALL
    };
    let mut given = [0.0; 2];
    let mut scales = Vec::new();
    for seed in 0..80 {
        let whole = machine.test([1, 1], 360, seed);
        let arc = |run: &Run| {
            let outside = |a: f64| a.rem_euclid(TAU) > 220_f64.to_radians();
            let places: Vec<usize> = (0..360).filter(|k| outside(run.angle()[*k])).collect();
            run.without(&places).unwrap()
        };
        let arcs = CircularTest::new(RADIUS, whole.runs().iter().map(arc).collect()).unwrap();
        let found = parts(&arcs, &requested(2, None)).unwrap();
        let [mean, half] = [Term::Radius, Term::ScaleMismatch].map(|term| part(&found, term));
        let both = mean.u.powi(2) + half.u.powi(2);
        let covariance = 2.0 * found.scale_covariance;
        given[0] += (both + covariance) / 80.0;
        given[1] += (both - covariance) / 80.0;
        scales.push([mean.value + half.value, mean.value - half.value]);
    }
    for axis in 0..2 {
        let mean = scales.iter().map(|scale| scale[axis]).sum::<f64>() / 80.0;
        let squares: f64 = scales.iter().map(|scale| (scale[axis] - mean).powi(2)).sum();
        // The root of 80 draws scatters by a twelfth; residuals of 440 samples by a thirtieth, and what hangs together.
        let ratio = (given[axis] / (squares / 79.0)).sqrt();
        assert!((0.7..1.4).contains(&ratio), "{axis}: {ratio}");
    }
    // The axis of which both ends were seen is the surer one by far.
    assert!(given[1] > 4.0 * given[0], "{given:?}");
}

#[test]
fn a_step_at_the_end_of_an_arc_is_not_reported() {
    let machine = Machine {
        noise: 0.3e-6,
        cyclic: [[0.0, 0.01]; 2],
        ..ALL
    };
    // From 0 to 220 degrees with a sample just on either: that at 0 has none before it.
    let test = |way: f64| {
        let direction = if way > 0.0 {
            Direction::Anticlockwise
        } else {
            Direction::Clockwise
        };
        let angle: Vec<f64> = (0..=220).map(|deg| f64::from(deg).to_radians()).collect();
        let deviation = angle
            .iter()
            .map(|a| 5e-6 * (2.0 * a).cos() + way * 1e-6 * (a - 1.0).signum());
        Run::new(direction, angle.clone(), deviation.collect()).unwrap()
    };
    let runs = vec![test(-1.0), test(1.0)];
    let found = parts(&CircularTest::new(RADIUS, runs).unwrap(), &requested(2, None)).unwrap();
    assert!(found.of(Term::Reversal(0)).is_none() && found.of(Term::Reversal(1)).is_some());
    assert!(
        found.together.contains(&vec![Term::Reversal(0)]),
        "{:?}",
        found.together
    );
    let whole = parts(&machine.test([1, 1], 360, 3), &requested(2, None)).unwrap();
    assert!(whole.of(Term::Reversal(0)).is_some());
}

#[test]
fn a_sum_is_not_reported_as_one_of_its_parts() {
    let one_way = parts(&ALL.test([1, 0], 720, 2), &requested(3, Some(0.01))).unwrap();
    for term in [Term::Radius, Term::Squareness] {
        assert!(
            one_way.of(term).is_some() && one_way.alone(term).is_none(),
            "{term:?}"
        );
    }
    assert!(one_way.alone(Term::ScaleMismatch).is_some());
}

#[test]
fn a_period_of_no_length_has_no_parts() {
    let test = ALL.test([1, 1], 720, 2);
    assert_eq!(parts(&test, &requested(3, Some(1e-320))), None);
    let [least, most] = periods(&test);
    // Four samples of half a degree.
    assert!((least / (4.0 * RADIUS * TAU / 720.0) - 1.0).abs() < 1e-9 && most == RADIUS);
}

#[test]
fn the_period_of_a_cyclic_error_is_found_and_noise_has_none() {
    for (period, noise) in [(0.01, 0.3e-6), (0.0123, 0.7e-6), (0.025, 0.3e-6)] {
        let machine = Machine {
            cyclic: [[1.5e-6, period], [0.0, period]],
            noise,
            ..ALL
        };
        let found = strongest_period(&machine.test([2, 2], 1440, 4), &requested(3, None)).unwrap();
        assert!((found / period - 1.0).abs() < 0.01, "{period}: {found}");
    }
    for seed in 0..5 {
        let machine = Machine {
            cyclic: [[0.0, 0.01]; 2],
            noise: 0.7e-6,
            ..ALL
        };
        assert_eq!(
            strongest_period(&machine.test([1, 1], 720, seed), &requested(3, None)),
            None,
            "{seed}"
        );
    }
}

/// Like the joint of a robot: one gap that shows at 40 and 250 degrees, outwards and inwards by different parts.
#[test]
fn a_backlash_at_given_angles_is_recovered() {
    let steps = vec![
        Step {
            angle: 40_f64.to_radians(),
            outwards: [1.0, 1.0],
        },
        Step {
            angle: 250_f64.to_radians(),
            outwards: [-0.4, -0.4],
        },
    ];
    let reversal = Reversal {
        name: "L".to_owned(),
        steps: steps.clone(),
    };
    let mut random = Random(9);
    let mut run = |direction: Direction| {
        let angle: Vec<f64> = (0..1440).map(|k| TAU * (f64::from(k) + 0.5) / 1440.0).collect();
        let deviation = angle.iter().map(|a| {
            let left: f64 = steps.iter().map(|step| step.at(*a, direction)).sum();
            25e-6 * left + 10e-6 * (2.0 * a).cos() + 0.5e-6 * random.normal()
        });
        let deviation = deviation.collect();
        Run::new(direction, angle, deviation).unwrap()
    };
    let test = CircularTest::new(RADIUS, Direction::BOTH.map(&mut run).to_vec()).unwrap();
    let mut reversals = of_axes(["X", "Y"]);
    reversals.push(reversal);
    let requested = PartsOptions {
        reversals,
        most_lobes: 2,
        period: None,
    };
    let found = parts(&test, &requested).unwrap();
    let Part { value, u, .. } = *part(&found, Term::Reversal(4));
    assert!((value - 25e-6).abs() < 3.0 * u && u < 0.3e-6, "{value} {u}");
    assert!(part(&found, Term::Reversal(0)).value.abs() < 1e-6);
}

#[test]
fn a_reversal_given_twice_is_reported_as_one() {
    let mut requested = requested(2, None);
    requested.reversals.push(requested.reversals[1].clone());
    let found = parts(&ALL.test([1, 1], 720, 6), &requested).unwrap();
    assert_eq!(found.together, [vec![Term::Reversal(1), Term::Reversal(4)]]);
    let few = Run::new(
        Direction::Clockwise,
        (0..24).map(f64::from).collect(),
        vec![0.0; 24],
    )
    .unwrap();
    requested.most_lobes = 20;
    assert_eq!(
        parts(&CircularTest::new(RADIUS, vec![few]).unwrap(), &requested),
        None
    );
}

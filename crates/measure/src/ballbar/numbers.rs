//! The answer from the analysis of a circular test: its result as numbers with their units.

use armill_core::measure::ballbar::parts::{Axis, Part, Parts, Term, Wave};
use armill_core::measure::ballbar::{Difference, Direction, Quantities, Run};
use armill_core::units::{to_deg, to_mm, to_um};

use super::analyse::{BallbarAnalysis, Question};
use super::answer::{
    BallbarAnswer, CentringAnswer, DifferenceAnswer, DirectionAnswer, LobeAnswer, OutlierAnswer, PartAnswer,
    PartsAnswer, RunAnswer, ShownAnswer,
};
use super::results::results;
use super::warnings::warnings;

/// The result `found` as numbers with their units.
pub fn answer(question: &Question, found: &BallbarAnalysis<'_>) -> BallbarAnswer {
    let measured = found.measured;
    let axes = measured.axes();
    let parts = found.parts.as_ref().map(|parts| of_parts(parts, found));
    let names: Vec<&str> = measured
        .origins
        .iter()
        .map(|origin| origin.name.as_str())
        .collect();
    let difference = |of: [String; 2], difference: &Difference| {
        difference.span().map(|span| DifferenceAnswer {
            of,
            max_um: to_um(span.largest),
            max_at_deg: to_deg(span.angle),
            rms_um: to_um(span.rms),
        })
    };
    let both = found.test.is_bidirectional();
    let circular_um = found.all.circular.ok().filter(|_| both).map(to_um);
    let squareness_urad = parts.as_ref().and_then(|parts| parts.squareness_urad);
    let mut given = BallbarAnswer {
        files: measured.files.clone(),
        radius_mm: to_mm(measured.test.radius()),
        feed_mm_per_min: measured.feed.map(|feed| feed * 60e3),
        plane: measured.plane.clone(),
        centring: CentringAnswer {
            centre: if found.is_centred {
                "least-squares"
            } else {
                "setup"
            },
            offset_um: found
                .centre
                .map(|centre| [to_um(centre.offset.x), to_um(centre.offset.y)]),
            radius_mm: found.centre.map(|centre| to_mm(centre.radius)),
        },
        runs: (0..names.len()).map(|index| of_run(found, index)).collect(),
        directions: Direction::BOTH
            .iter()
            .filter_map(|direction| {
                Some(DirectionAnswer {
                    direction: direction.name(),
                    runs: found.test.of(*direction).count(),
                    shown: ShownAnswer::of(&found.directions[direction.index()]?),
                })
            })
            .collect(),
        circular_bidirectional_um: circular_um,
        mean_bidirectional_um: found.mean_bidirectional.map(to_um),
        hysteresis_um: found.hysteresis.map(to_um),
        repeatability: (found.repeats.iter())
            .filter_map(|([one, other], of)| {
                difference([names[*one].to_owned(), names[*other].to_owned()], of)
            })
            .collect(),
        between_directions: difference(["CW", "CCW"].map(str::to_owned), &found.between),
        lobes: found
            .lobes
            .iter()
            .flat_map(|lobes| &lobes.harmonics)
            .map(LobeAnswer::of)
            .collect(),
        outliers: outliers(&names, found),
        outliers_left_out: question.without_outliers,
        results: results(found, &axes, circular_um, squareness_urad),
        axes,
        parts,
        taught: None,
        before: None,
        unused: measured.unused.clone(),
        warnings: Vec::new(),
    };
    given.warnings = warnings(question, found, &given);
    given
}

impl ShownAnswer {
    fn of(shown: &Quantities) -> ShownAnswer {
        let [least, greatest] = shown.radial;
        ShownAnswer {
            circular_um: shown.circular.ok().map(to_um),
            radial_max_um: to_um(greatest.deviation),
            radial_max_at_deg: to_deg(greatest.angle),
            radial_min_um: to_um(least.deviation),
            radial_min_at_deg: to_deg(least.angle),
        }
    }
}

impl LobeAnswer {
    fn of(lobe: &armill_core::roundness::Harmonic) -> LobeAnswer {
        let waves = lobe.waves as f64;
        LobeAnswer {
            waves: lobe.waves,
            amplitude_um: to_um(lobe.amplitude),
            crest_deg: (to_deg(lobe.phase) / waves).rem_euclid(360.0 / waves),
        }
    }
}

fn of_run(found: &BallbarAnalysis<'_>, index: usize) -> RunAnswer {
    let measured = found.measured;
    let (origin, shown) = (&measured.origins[index], &found.runs[index]);
    let run: &Run = &measured.test.runs()[index];
    let profile = armill_core::measure::ballbar::Profile::of(&found.test.runs()[index]);
    RunAnswer {
        name: origin.name.clone(),
        label: origin.label.clone(),
        file: origin.file.clone(),
        direction: run.direction().name(),
        samples: run.angle().len(),
        start_deg: to_deg(run.angle()[0]).rem_euclid(360.0),
        arc_deg: to_deg(shown.arc),
        gaps_deg: profile.gaps().iter().map(|gap| gap.map(to_deg)).collect(),
        shown: ShownAnswer::of(shown),
    }
}

/// What a term is called.
fn name_of(term: Term, axes: &[String; 2], found: &BallbarAnalysis<'_>) -> String {
    let axis = |axis: Axis| match axis {
        Axis::A => &axes[0],
        Axis::B => &axes[1],
    };
    let wave = |wave: Wave| match wave {
        Wave::Cosine => "cosine",
        Wave::Sine => "sine",
    };
    match term {
        Term::Radius => "radius".to_owned(),
        Term::Offset(of) => format!("offset along {}", axis(of)),
        Term::ScaleMismatch => "scale mismatch".to_owned(),
        Term::Squareness => "squareness".to_owned(),
        Term::DirectionRadius => "radius CCW minus CW".to_owned(),
        Term::ServoMismatch => "servo mismatch".to_owned(),
        Term::Reversal(index) => format!("step {}", found.requested.reversals[index].name),
        Term::Lobes(count, of) => format!("{count} lobes, {}", wave(of)),
        Term::Cyclic(along, of) => format!("cyclic along {}, {}", axis(along), wave(of)),
    }
}

/// Kind of the part of a term.
fn kind_of(term: Term) -> &'static str {
    match term {
        Term::Radius => "radius",
        Term::Offset(_) => "offset",
        Term::ScaleMismatch => "scale mismatch",
        Term::Squareness => "squareness",
        Term::DirectionRadius => "direction radius",
        Term::ServoMismatch => "servo mismatch",
        Term::Reversal(_) => "reversal",
        Term::Lobes(..) => "lobes",
        Term::Cyclic(..) => "cyclic",
    }
}

fn of_parts(parts: &Parts, found: &BallbarAnalysis<'_>) -> PartsAnswer {
    let measured = found.measured;
    let axes = measured.axes();
    let radius = measured.test.radius();
    let name = |term: Term| name_of(term, &axes, found);
    // A sum of several errors is none of them.
    let of = |term: Term| parts.alone(term);
    // alpha = (radius + mismatch)/R, beta = (radius - mismatch)/R.
    let scale = of(Term::Radius).zip(of(Term::ScaleMismatch));
    let per_m = 1e6 / radius;
    let both = |(mean, half): (&Part, &Part)| {
        [1.0, -1.0].map(|side| {
            let variance = mean.u.powi(2) + half.u.powi(2) + 2.0 * side * parts.scale_covariance;
            variance.max(0.0).sqrt() * per_m
        })
    };
    let servo = of(Term::ServoMismatch).zip(measured.feed);
    PartsAnswer {
        radial: (parts.parts.iter())
            .map(|part| PartAnswer {
                what: name(part.term),
                kind: kind_of(part.term),
                value_um: to_um(part.value),
                u_um: to_um(part.u),
            })
            .collect(),
        scale_um_per_m: scale.map(|(mean, half)| {
            [
                (mean.value + half.value) * per_m,
                (mean.value - half.value) * per_m,
            ]
        }),
        scale_u_um_per_m: scale.map(both),
        squareness_urad: of(Term::Squareness).map(|part| 2.0 * part.value * per_m),
        squareness_u_urad: of(Term::Squareness).map(|part| 2.0 * part.u * per_m),
        servo_mismatch_s: servo.map(|(part, feed)| 2.0 * part.value / feed),
        servo_mismatch_u_s: servo.map(|(part, feed)| 2.0 * part.u / feed),
        cyclic_period_mm: found.requested.period.map(to_mm),
        not_identifiable: (parts.together.iter())
            .map(|set| set.iter().map(|term| name(*term)).collect())
            .collect(),
        rms_before_um: to_um(parts.rms_before),
        rms_after_um: to_um(parts.rms_after),
    }
}

fn outliers(names: &[&str], found: &BallbarAnalysis<'_>) -> Vec<OutlierAnswer> {
    let of_run = names.iter().zip(&found.outliers);
    of_run
        .flat_map(|(name, outliers)| {
            outliers.iter().map(|outlier| OutlierAnswer {
                run: (*name).to_owned(),
                angle_deg: to_deg(outlier.angle),
                off_um: to_um(outlier.off),
                at_reversal: outlier.at_reversal,
            })
        })
        .collect()
}

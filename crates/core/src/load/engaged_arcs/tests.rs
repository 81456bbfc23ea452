use std::f64::consts::PI;

use nalgebra::Matrix3;

use super::*;
use crate::load::{
    CuttingLaw, Engagement, Estimate, Hand, Immersion, Kienzle, KienzleValues, Lean, LeanInCut, Mechanistic,
    Milling,
};

const MM: f64 = 1e-3;
const SEED: u64 = 20;

/// Numbers from 0 to 1 by a linear congruential generator.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn linear() -> CuttingLaw {
    let law = Mechanistic::new(Vector3::new(631e6, 99e6, 273e6), Vector3::new(13e3, 10e3, 2.8e3));
    CuttingLaw::Mechanistic(law.unwrap())
}

fn power() -> CuttingLaw {
    let exact = |value| Estimate {
        value,
        standard_uncertainty: 0.0,
    };
    CuttingLaw::Kienzle(
        Kienzle::new(KienzleValues {
            specific_force: exact(800e6),
            exponent: exact(0.25),
            radial_ratio: exact(0.4),
            axial_ratio: exact(0.1),
        })
        .unwrap(),
    )
}

fn ball() -> Cutter {
    let ball = Cutter::ball(12.0 * MM, 2).unwrap();
    ball.with_helix(0.5, Hand::Right).unwrap()
}

fn bull() -> Cutter {
    Cutter::bull_nose(25.0 * MM, 5.0 * MM, 3).unwrap()
}

/// A cut of this depth (m), upright.
fn cut(cutter: &Cutter, immersion: Immersion, depth: f64) -> Cut {
    Cut {
        depth,
        engagement: Engagement::at_depth(immersion, cutter, depth).unwrap(),
        feed: 0.1 * MM,
        rise: 0.0,
        lean: LeanInCut::default(),
    }
}

/// The same cut with walls at the edges of its strip.
fn between_walls(cut: Cut, cutter: &Cutter) -> Cut {
    let [right, left] = cut.engagement.edges();
    let narrower = cutter.radius() - cutter.at_height(cut.depth).radius;
    let edges = match cut.engagement.pass_before() {
        None => [right, left],
        Some(displaced) if displaced < 0.0 => [right - narrower, left],
        Some(_) => [right, left + narrower],
    };
    let engagement = Engagement::strip(edges, cutter.diameter()).unwrap();
    Cut { engagement, ..cut }
}

/// The same upright cut computed as that of a tool that leans by nothing.
fn as_leaning(upright: Milling) -> Milling {
    Milling {
        leaning: Some(LeaningCut::of(&upright.cutter, &upright.cut)),
        ..upright
    }
}

#[test]
fn without_lean_the_mean_force_is_that_of_the_upright_tool() {
    for cutter in [ball(), bull()] {
        for depth in [0.2, 1.3, 4.0, 8.0].map(|depth| depth * MM) {
            let half = cutter.at_height(depth).radius;
            let thin = 0.3 * half;
            for immersion in [
                Immersion::Slot,
                Immersion::Up(half),
                Immersion::Down(half),
                Immersion::Up(thin),
                Immersion::Down(thin),
                Immersion::Centred(half),
            ] {
                // Rounding of the bisected kinks, the spline of a profile; of a power law 16 nodes over a corner where the chip begins at nothing.
                for (law, tolerance) in [(linear(), 1e-8), (power(), 1e-7)] {
                    // On a rising feed the nodes of the upright tool pass over the kink where its chip ends at a side.
                    for (rise, tolerance) in [(0.0, tolerance), (0.02 * MM, 1e-3)] {
                        let next_to_pass = Cut {
                            rise,
                            ..cut(&cutter, immersion, depth)
                        };
                        for cut in [next_to_pass, between_walls(next_to_pass, &cutter)] {
                            let upright = Milling::new(cutter, law, cut).unwrap();
                            let [expected, found] = [upright, as_leaning(upright)].map(|of| of.mean_force());
                            let apart = (found - expected).norm();
                            // A thin cut that rises out of the part has little force or none.
                            let within = apart <= tolerance * expected.norm().max(1.0);
                            assert!(within, "{cut:?}: {apart:e}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn without_lean_the_force_at_an_angle_and_the_torque_are_those_of_the_upright_tool() {
    for cutter in [ball(), bull()] {
        for immersion in [
            Immersion::Slot,
            Immersion::Up(3.0 * MM),
            Immersion::Down(3.0 * MM),
        ] {
            let upright = Milling::new(cutter, linear(), cut(&cutter, immersion, 2.0 * MM)).unwrap();
            let leaning = as_leaning(upright);
            for angle in [0.0, 0.7, 1.9, 3.3] {
                let [expected, found] = [upright, leaning].map(|of| of.force_at(angle));
                assert!(
                    (found - expected).norm() < 1e-9 * expected.norm().max(1.0),
                    "{angle}"
                );
            }
            // The spline of a profile leaves 1e-10 m, and 1e-8 of an angle at a side.
            let [expected, found] = [upright, leaning].map(|of| of.mean_torque());
            assert!((found / expected - 1.0).abs() < 1e-7);
            let [expected, found] = [upright, leaning].map(|of| of.largest_chip());
            assert!((found / expected - 1.0).abs() < 1e-7);
        }
    }
}

/// A law whose tangential force is the area of the chip: the torque is then the volume that a radian removes.
fn volume() -> CuttingLaw {
    CuttingLaw::Mechanistic(Mechanistic::new(Vector3::x(), Vector3::zeros()).unwrap())
}

#[test]
fn the_teeth_remove_the_section_of_the_material_times_the_feed_in_every_lean() {
    let mut random = numbers(SEED);
    let mut between = |from: f64, to: f64| from + (to - from) * random();
    for case in 0..40 {
        let cutter = if case % 2 == 0 { ball() } else { bull() };
        let lean = Lean {
            lead: between(-0.6, 0.6),
            tilt: between(-0.6, 0.6),
        };
        // Below this depth the section of the body, seen along the feed, only becomes wider.
        let depth = between(0.05, 0.3) * cutter.corner_radius();
        let upright = match case % 3 {
            0 => cut(&cutter, Immersion::Slot, depth),
            1 => cut(
                &cutter,
                Immersion::Up(0.4 * cutter.at_height(depth).radius),
                depth,
            ),
            _ => cut(
                &cutter,
                Immersion::Down(0.7 * cutter.at_height(depth).radius),
                depth,
            ),
        };
        let upright = match case < 20 {
            true => upright,
            false => between_walls(upright, &cutter),
        };
        let leaning = upright.leaning(lean, cutter.body());
        let milling = Milling::new(cutter, volume(), leaning).unwrap();
        let per_feed = milling.mean_torque() * TAU / f64::from(cutter.flutes()) / upright.feed;
        let expected = section(&cutter, &leaning);
        // Sums over 256 slices, which begin and end like a root: 256^-1.5 of some parts.
        assert!(
            (per_feed / expected - 1.0).abs() < 3e-3,
            "seed {SEED} case {case}: {lean:?} {depth} {per_feed} {expected}"
        );
    }
}

/// Section across the feed of the material that a pass removes, m^2: widths at heights, by Simpson's rule in the root of the height.
fn section(cutter: &Cutter, cut: &Cut) -> f64 {
    let [right, left] = cut.engagement.edges();
    let [right, left] = [
        if right <= -cutter.radius() {
            -1.0
        } else {
            right + cut.lean.moved[0]
        },
        if left >= cutter.radius() {
            1.0
        } else {
            left + cut.lean.moved[1]
        },
    ];
    let width = |root: f64| {
        let [from, to] = cutter.body().extent(cut.lean.lean, root * root);
        let between = match cut.engagement.pass_before() {
            None => to.min(left) - from.max(right),
            Some(displaced) if displaced < 0.0 => to - from.max(to + displaced),
            Some(displaced) => to.min(from + displaced) - from,
        };
        between.max(0.0) * 2.0 * root
    };
    let pieces = 2000;
    let step = cut.depth.sqrt() / f64::from(pieces);
    let sum: f64 = (1..=pieces)
        .map(|k| {
            let at = f64::from(k) * step;
            (width(at - step) + 4.0 * width(at - 0.5 * step) + width(at)) / 6.0
        })
        .sum();
    sum * step
}

#[test]
fn the_mean_force_is_the_sum_over_points_of_the_body_in_the_axes_of_the_surface() {
    let mut random = numbers(SEED);
    let mut between = |from: f64, to: f64| from + (to - from) * random();
    for case in 0..24 {
        let cutter = if case % 2 == 0 { ball() } else { bull() };
        let lean = Lean {
            lead: between(-0.7, 0.7),
            tilt: between(-0.7, 0.7),
        };
        let depth = between(0.1, 1.6) * cutter.corner_radius();
        let radius = cutter.at_height(depth).radius;
        let immersion = [
            Immersion::Slot,
            Immersion::Up(0.5 * radius),
            Immersion::Down(0.3 * radius),
            Immersion::Centred(0.8 * radius),
        ][case % 4];
        let upright = Cut {
            rise: between(-0.03, 0.03) * MM,
            ..cut(&cutter, immersion, depth)
        };
        let upright = match case < 12 {
            true => upright,
            false => between_walls(upright, &cutter),
        };
        let leaning = upright.leaning(lean, cutter.body());
        let milling = Milling::new(cutter, linear(), leaning).unwrap();
        let found = axes_of(&leaning) * milling.mean_force();
        let expected = summed(&cutter, &leaning);
        let apart = (found - expected).norm() / expected.norm();
        // Squares of 1/1000 of the body and of a third of a degree at the borders of the engagement.
        assert!(
            apart < 4e-3,
            "seed {SEED} case {case}: {leaning:?} {found} {expected} {apart}"
        );
    }
}

fn axes_of(cut: &Cut) -> Matrix3<f64> {
    let axis = cut.lean.lean.axis();
    let feed = Vector3::new(cut.feed, 0.0, cut.rise);
    let x = (feed - axis * feed.dot(&axis)).normalize();
    Matrix3::from_columns(&[x, axis.cross(&x), axis])
}

/// The mean force from points all over the body; feed, left, normal. Vectors only: no angle of the engagement.
fn summed(cutter: &Cutter, cut: &Cut) -> Vector3<f64> {
    let axis = cut.lean.lean.axis();
    let feed = Vector3::new(cut.feed, 0.0, cut.rise);
    let (r, radius) = (cutter.corner_radius(), cutter.radius());
    let flat = radius - r;
    let sine = axis.xy().norm();
    let centre = Vector3::z() * (r + flat * sine);
    let across = axis.cross(&Vector3::y()).normalize();
    let other = axis.cross(&across);
    let [right, left] = cut.engagement.edges();
    let pass_before = cut.engagement.pass_before();
    // How far the body reaches to both sides, in even steps of the root of the height.
    let steps = 4000.0;
    let reach: Vec<[f64; 2]> = (0..=4000)
        .map(|k| (f64::from(k).max(0.1) / steps).powi(2) * cut.depth)
        .map(|height| cutter.body().extent(cut.lean.lean, height))
        .collect();
    let in_strip = |at: &Vector3<f64>| {
        let Some(displaced) = pass_before else {
            return (right <= -radius || at.y > right + cut.lean.moved[0])
                && (left >= radius || at.y < left + cut.lean.moved[1]);
        };
        let [right, left] = reach[((at.z / cut.depth).max(0.0).sqrt() * steps).round() as usize];
        match displaced < 0.0 {
            true => at.y > left + displaced,
            false => at.y < right + displaced,
        }
    };
    let (turns, slices) = (1080, 1000);
    let mut sum = Vector3::zeros();
    let mut add = |at: Vector3<f64>, normal: Vector3<f64>, out: Vector3<f64>, width: f64| {
        let h = feed.dot(&normal);
        if at.z >= cut.depth || h <= 0.0 || !in_strip(&at) {
            return;
        }
        let CuttingLaw::Mechanistic(law) = linear() else {
            unreachable!()
        };
        let force = law.force(h);
        // The tooth turns clockwise, seen against the axis; the axial force is down the profile.
        let motion = out.cross(&axis);
        let to_tip = out * normal.dot(&axis) - axis * normal.dot(&out);
        sum += (-motion * force.x - normal * force.y + to_tip * force.z) * width;
    };
    for turn in 0..turns {
        let (sin, cos) = (TAU * (f64::from(turn) + 0.5) / f64::from(turns)).sin_cos();
        let out = across * cos + other * sin;
        for slice in 0..slices {
            let part = (f64::from(slice) + 0.5) / f64::from(slices);
            let (sin_kappa, cos_kappa) = (0.5 * PI * part).sin_cos();
            let normal = out * sin_kappa - axis * cos_kappa;
            add(
                centre + out * flat + normal * r,
                normal,
                out,
                0.5 * PI * r / f64::from(slices),
            );
            let length = 60.0 * MM;
            add(
                centre + out * radius + axis * (length * part),
                out,
                out,
                length / f64::from(slices),
            );
            // Where the feed has no part into it the bottom has no chip.
            let at = centre + out * (flat * part) - axis * r;
            add(at, -axis, out, flat / f64::from(slices));
        }
    }
    sum * (f64::from(cutter.flutes()) / f64::from(turns))
}

#[test]
fn the_force_over_a_revolution_has_the_mean_force_for_mean() {
    let lean = Lean {
        lead: 0.25,
        tilt: -0.3,
    };
    for cutter in [ball(), bull()] {
        let leaning = cut(&cutter, Immersion::Up(4.0 * MM), MM).leaning(lean, cutter.body());
        let milling = Milling::new(cutter, linear(), leaning).unwrap();
        let forces = milling.revolution(720);
        let mean = forces.iter().sum::<Vector3<f64>>() / 720.0;
        // Slices of the corner enter one after the other.
        assert!((mean - milling.mean_force()).norm() < 2e-3 * mean.norm());
        let peak = milling.peak(720 / cutter.flutes()).norm();
        let largest = forces.iter().map(Vector3::norm).fold(0.0, f64::max);
        assert!((peak / largest - 1.0).abs() < 1e-9, "{peak} {largest}");
    }
}

#[test]
fn a_lead_takes_the_tip_of_a_ball_out_of_the_cut() {
    let ball = ball();
    let least_speed = |lead: f64| {
        let cut = cut(&ball, Immersion::Slot, 0.5 * MM).leaning(Lean { lead, tilt: 0.0 }, ball.body());
        let milling = Milling::new(ball, linear(), cut).unwrap();
        let cuts = milling
            .slices()
            .filter(|(point, _)| !milling.arcs_at(point).is_empty());
        cuts.map(|(point, _)| point.radius).fold(f64::INFINITY, f64::min)
    };
    assert!(least_speed(0.0) < 0.02 * MM);
    // In front of the contact points with a chip are at an angle to the axis of at least the lead.
    assert!((least_speed(0.3) / (6.0 * MM * 0.3_f64.sin()) - 1.0).abs() < 0.02);
}

#[test]
fn a_small_lean_changes_the_force_little() {
    for cutter in [ball(), bull()] {
        for immersion in [
            Immersion::Slot,
            Immersion::Up(2.0 * MM),
            Immersion::Down(2.0 * MM),
        ] {
            let upright = cut(&cutter, immersion, MM);
            let force = |lean| {
                let cut = upright.leaning(lean, cutter.body());
                Milling::new(cutter, linear(), cut).unwrap().mean_force()
            };
            let expected = force(Lean::NONE);
            for (lead, tilt) in [(1e-7, 0.0), (-1e-7, 0.0), (0.0, 1e-7), (0.0, -1e-7)] {
                let apart = (force(Lean { lead, tilt }) - expected).norm() / expected.norm();
                // The border of the engagement moves like the root of the lean where the bottom is flat.
                assert!(apart < 1e-3, "{immersion:?} {lead} {tilt}: {apart}");
            }
        }
    }
}

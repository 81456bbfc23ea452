use super::*;
use crate::load::{Cutter, CuttingLaw, Engagement, Immersion, LeanInCut, Mechanistic, Milling};
use nalgebra::{Matrix3, Vector3};

const MM: f64 = 1e-3;
const DIAMETER: f64 = 10.0 * MM;

/// A law without edge forces: the force is proportional to the section of the chip.
fn law() -> CuttingLaw {
    let shear = Vector3::new(800e6, 80e6, 100e6);
    CuttingLaw::Mechanistic(Mechanistic::new(shear, Vector3::zeros()).unwrap())
}

fn cut(immersion: Immersion) -> Cut {
    Cut {
        depth: 1.5 * MM,
        engagement: Engagement::of(immersion, DIAMETER).unwrap(),
        feed: 0.08 * MM,
        rise: 0.0,
        lean: LeanInCut::default(),
    }
}

fn mean(cutter: Cutter, cut: Cut) -> Vector3<f64> {
    Milling::new(cutter, law(), cut).unwrap().mean_force()
}

/// A tip with compliance `a` (m/N) only along the feed: the deflection does not change the cut.
fn along_feed(a: f64) -> TipCompliance {
    TipCompliance {
        by_force: Matrix3::from_diagonal(&Vector3::new(a, 0.0, 0.0)),
        unloaded: Vector3::zeros(),
    }
}

/// This tolerance without vibration.
fn still(tolerance: f64) -> PointDemand {
    PointDemand {
        tolerance,
        vibrating: None,
    }
}

fn varied(cutter: Cutter, cut: Cut, tip: TipCompliance, limit: f64) -> Varied {
    let mean = mean(cutter, cut);
    let cuts = CutsAlong {
        cutters: vec![Cutter::flat(1.0 * MM, 1).unwrap(), cutter],
        law: law(),
        greatest: GreatestForce::LeftOut,
        points: vec![
            CutHere::NOTHING,
            CutHere {
                cutter: 1,
                cut: Some(cut),
                mean,
                greatest: mean * 3.0,
            },
        ],
    };
    assert!(
        Varied::of(&cuts, 0, tip, still(limit)).is_none(),
        "in air nothing is permitted"
    );
    Varied::of(&cuts, 1, tip, still(limit)).unwrap()
}

fn flat() -> Cutter {
    Cutter::flat(DIAMETER, 2).unwrap()
}

fn up_to(permitted: Permitted) -> f64 {
    let Permitted::UpTo(value) = permitted else {
        panic!("{permitted:?}")
    };
    value
}

/// The interval of the scan is 0.7 of its start, and is halved ten times.
const RESOLUTION: f64 = 0.7 / 1024.0;

fn just_below(found: f64, exact: f64) -> bool {
    found <= exact * (1.0 + 1e-9) && found >= exact * (1.0 - RESOLUTION - 1e-9)
}

#[test]
fn depth_and_feed_are_proportional_to_the_tolerance_where_the_force_is_proportional_to_them() {
    let (a, drawn) = (2e-7, cut(Immersion::Up(3.0 * MM)));
    let force = mean(flat(), drawn).x.abs();
    for limit in [3e-6, 10e-6, 47e-6] {
        let found = varied(flat(), drawn, along_feed(a), limit).limits();
        let times = limit / (a * force);
        assert!(
            just_below(up_to(found.depth), drawn.depth * times),
            "{limit}: {found:?}"
        );
        let feed = drawn.feed * times;
        let capped = 0.05 * DIAMETER;
        if feed < capped {
            assert!(
                just_below(up_to(found.feed_per_tooth), feed),
                "{limit}: {found:?}"
            );
        } else {
            assert_eq!(found.feed_per_tooth, Permitted::AtLeast(capped));
        }
    }
}

#[test]
fn on_a_ramp_the_feed_is_reported_along_the_path_and_keeps_its_slope() {
    let (a, level) = (2e-7, cut(Immersion::Up(3.0 * MM)));
    let ramp = Cut {
        feed: level.feed * 0.8,
        rise: -level.feed * 0.6,
        ..level
    };
    let force = mean(flat(), ramp).x.abs();
    let limit = 0.6 * a * force;
    let found = varied(flat(), ramp, along_feed(a), limit).limits();
    assert!(
        just_below(up_to(found.feed_per_tooth), 0.6 * level.feed),
        "{found:?}"
    );
}

#[test]
fn a_stiff_tip_permits_all_examined_values_and_a_tip_with_too_much_sag_permits_none() {
    let drawn = cut(Immersion::Up(3.0 * MM));
    let stiff = varied(flat(), drawn, along_feed(1e-12), 10e-6).limits();
    assert_eq!(stiff.depth, Permitted::AtLeast(3.0 * DIAMETER));
    assert_eq!(stiff.width, Some(Permitted::AtLeast(DIAMETER)));
    assert_eq!(stiff.feed_per_tooth, Permitted::AtLeast(0.05 * DIAMETER));
    assert_eq!(stiff.depth.value(), 3.0 * DIAMETER);
    let hangs = TipCompliance {
        unloaded: Vector3::new(12e-6, 0.0, -3e-6),
        ..along_feed(2e-7)
    };
    let nothing = varied(flat(), drawn, hangs, 10e-6).limits();
    for permitted in [nothing.depth, nothing.width.unwrap(), nothing.feed_per_tooth] {
        assert_eq!((permitted, permitted.value()), (Permitted::Nothing, 0.0));
    }
}

#[test]
fn weight_along_the_tool_is_not_included_and_weight_against_the_force_increases_the_limit() {
    let (a, limit, drawn) = (2e-7, 10e-6, cut(Immersion::Up(3.0 * MM)));
    let per_depth = a * mean(flat(), drawn).x.abs() / drawn.depth;
    let hanging = |unloaded: Vector3<f64>| TipCompliance {
        unloaded,
        ..along_feed(a)
    };
    let depth = |unloaded| up_to(varied(flat(), drawn, hanging(unloaded), limit).limits().depth);
    // A tip that sags away from the part by less than the depth cuts that much less: none of the tolerance is used.
    let lifted = depth(Vector3::new(0.0, 0.0, 4e-6));
    assert!(just_below(lifted - 4e-6, limit / per_depth), "{lifted}");
    // The cut pushes back (-x): from 6 um ahead through zero to 10 um behind.
    let ahead = depth(Vector3::new(6e-6, 0.0, 0.0));
    assert!(just_below(ahead, (limit + 6e-6) / per_depth), "{ahead}");
    let behind = depth(Vector3::new(-6e-6, 0.0, 0.0));
    assert!(just_below(behind, (limit - 6e-6) / per_depth), "{behind}");
}

#[test]
fn where_deviation_rises_and_falls_the_first_width_is_used() {
    // Fx of up-milling is greatest about a half of the diameter and much less in a slot where radial forces are small.
    let (a, drawn) = (2e-7, cut(Immersion::Up(2.0 * MM)));
    let deviation = |width: f64| {
        let engagement = Engagement::of(Immersion::Up(width), DIAMETER).unwrap();
        a * mean(flat(), Cut { engagement, ..drawn }).x.abs()
    };
    let widths: Vec<f64> = (1..=100).map(|k| DIAMETER * f64::from(k) / 100.0).collect();
    let peak = widths.iter().map(|width| deviation(*width)).fold(0.0, f64::max);
    let limit = 0.9 * peak;
    assert!(
        deviation(DIAMETER) < 0.5 * limit,
        "a slot would be within the tolerance"
    );
    let found = up_to(
        varied(flat(), drawn, along_feed(a), limit)
            .limits()
            .width
            .unwrap(),
    );
    assert!(deviation(found) <= limit && deviation(found * (1.0 + 2.0 * RESOLUTION)) > limit);
    let first_over = widths.iter().find(|width| deviation(**width) > limit).unwrap();
    assert!(
        found < *first_over && found > first_over - 0.011 * DIAMETER,
        "{found} {first_over}"
    );
    let all = varied(flat(), drawn, along_feed(a), 1.01 * peak).limits().width;
    assert_eq!(all, Some(Permitted::AtLeast(DIAMETER)));
}

#[test]
fn a_slot_has_no_permitted_width() {
    let found = varied(flat(), cut(Immersion::Slot), along_feed(2e-7), 10e-6).limits();
    assert_eq!(found.width, None);
}

#[test]
fn the_greatest_force_reduces_the_limit_by_its_ratio_to_the_mean() {
    let drawn = cut(Immersion::Down(3.0 * MM));
    let mut requested = varied(flat(), drawn, along_feed(2e-7), 10e-6);
    let mean_alone = requested.limits();
    requested.greatest = GreatestForce::SecondCase;
    let both = requested.limits();
    // Three times the mean, in its direction.
    assert!((up_to(mean_alone.depth) / up_to(both.depth) / 3.0 - 1.0).abs() < 2.0 * RESOLUTION);
}

#[test]
fn a_wider_or_deeper_cut_of_a_shallow_ball_begins_at_the_engaged_circle() {
    let ball = Cutter::ball(DIAMETER, 2).unwrap();
    let depth = 0.2 * MM;
    let engagement = Engagement::at_depth(Immersion::Up(0.5 * MM), &ball, depth).unwrap();
    let drawn = Cut {
        depth,
        engagement,
        ..cut(Immersion::Slot)
    };
    let a = 2e-7;
    let limit = 1.2 * a * mean(ball, drawn).x.abs();
    let found = varied(ball, drawn, along_feed(a), limit).limits();
    let width = up_to(found.width.unwrap());
    let wider = Engagement::at_depth(Immersion::Up(width), &ball, depth).unwrap();
    let there = a * mean(
        ball,
        Cut {
            engagement: wider,
            ..drawn
        },
    )
    .x
    .abs();
    assert!(
        width > 0.5 * MM && (there / limit - 1.0).abs() < 2.0 * RESOLUTION,
        "{width}: {there}"
    );
    assert!(up_to(found.depth) > depth);
}

#[test]
fn a_tool_that_is_pulled_in_deviates_without_bound() {
    let cutter = flat().with_helix(0.6, crate::load::Hand::Right).unwrap();
    let drawn = cut(Immersion::Slot);
    let force = mean(cutter, drawn);
    let soft = TipCompliance {
        by_force: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 2.0 * drawn.depth / -force.z)),
        unloaded: Vector3::zeros(),
    };
    let mut requested = varied(cutter, drawn, soft, 10e-6);
    assert_eq!(requested.deviation(&drawn), f64::INFINITY);
    // No feed, no such cut; the same if too deep.
    let none = Cut { depth: 1e9, ..drawn };
    assert_eq!(requested.deviation(&none), f64::INFINITY);
    assert_eq!(fed(&drawn, 2.0).feed, 2.0 * drawn.feed);
}

/// A mode at 40 Hz across the feed with this stiffness (N/m) and a damping of 3 %.
fn across_the_feed(stiffness: f64) -> Vibrating {
    let omega = std::f64::consts::TAU * 40.0;
    let shape = omega / f64::sqrt(stiffness);
    Vibrating {
        modes: vec![crate::dynamics::Mode {
            angular_frequency: omega,
            damping_ratio: 0.03,
            shape: nalgebra::Vector6::new(0.0, shape, 0.0, 0.0, 0.0, 0.0),
        }],
        spindle: std::f64::consts::TAU * 11.0,
    }
}

fn vibrating(cut: Cut, tip: TipCompliance, tolerance: f64, vibrating: Vibrating) -> Varied {
    let mut varied = varied(flat(), cut, tip, tolerance);
    let milling = Milling::new(flat(), law(), cut).unwrap();
    varied.vibration_by_force = vibrating.amplitude(&milling).unwrap() / milling.mean_force().norm();
    varied.demand.vibrating = Some(vibrating);
    varied
}

#[test]
fn an_unstable_cut_is_not_permitted_however_large_the_tolerance_is() {
    let (drawn, weak) = (cut(Immersion::Up(3.0 * MM)), across_the_feed(2e6));
    let milling = Milling::new(flat(), law(), drawn).unwrap();
    let lobes = crate::stability::StabilityLobes::new(
        &weak.modes,
        &crate::stability::CutOfAnyDepth::new(&milling),
        30.0 * MM,
    );
    let limit = lobes.unwrap().at_speed(weak.spindle).unwrap().depth;
    assert!(limit > 0.2 * MM && limit < 20.0 * MM, "{limit}");
    let mut found = vibrating(drawn, along_feed(1e-9), 1.0, weak);
    let depth = up_to(found.limits().depth);
    assert!(just_below(depth, limit), "{depth} {limit}");
    // A law without edge forces is as stable at any feed.
    let deep = Cut {
        depth: 1.01 * limit,
        ..drawn
    };
    let mut found = vibrating(deep, along_feed(1e-9), 1.0, across_the_feed(2e6));
    assert_eq!(found.limits().feed_per_tooth, Permitted::Nothing);
}

#[test]
fn the_vibration_uses_up_a_part_of_the_tolerance() {
    // Stiff: stable at every depth examined, and the force is proportional to the depth.
    let (a, tolerance, drawn) = (2e-7, 40e-6, cut(Immersion::Up(3.0 * MM)));
    let stiff = across_the_feed(1e9);
    let milling = Milling::new(flat(), law(), drawn).unwrap();
    let by_depth = (a * milling.mean_force().x.abs() + stiff.amplitude(&milling).unwrap()) / drawn.depth;
    let mut found = vibrating(drawn, along_feed(a), tolerance, stiff);
    let depth = up_to(found.limits().depth);
    assert!(just_below(depth, tolerance / by_depth), "{depth}");
}

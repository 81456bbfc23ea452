use super::*;
use crate::load::kienzle::Estimate;
use crate::load::{Engagement, Hand, Immersion, Kienzle, KienzleValues, LeanInCut, Runout};
use std::f64::consts::{FRAC_PI_2, PI};

const MM: f64 = 1e-3;
const K: [f64; 6] = [1930.4e6, 1159.6e6, 200.6e6, 24e3, 43e3, 3e3];

fn law(k: [f64; 6]) -> CuttingLaw {
    let shear = Vector3::new(k[0], k[1], k[2]);
    CuttingLaw::Mechanistic(Mechanistic::new(shear, Vector3::new(k[3], k[4], k[5])).unwrap())
}

fn flat(hand: Hand) -> Cutter {
    let flat = Cutter::flat(16.0 * MM, 4).unwrap();
    flat.with_helix(45_f64.to_radians(), hand).unwrap()
}

fn cut(immersion: Immersion, depth: f64) -> Cut {
    Cut {
        depth,
        engagement: Engagement::of(immersion, 16.0 * MM).unwrap(),
        feed: 0.18 * MM,
        rise: 0.0,
        lean: LeanInCut::default(),
    }
}

fn milling(cutter: Cutter, cut: Cut) -> Milling {
    Milling::new(cutter, law(K), cut).unwrap()
}

/// Force of one edge of the flat end mill at the height `z`, by vectors: position and direction of the tooth.
fn edge_force(k: [f64; 6], phi: f64, c: f64, hand: Hand) -> Vector3<f64> {
    let outward = Vector3::new(phi.sin(), phi.cos(), 0.0);
    // The spindle turns about -z.
    let way = (-Vector3::z()).cross(&outward);
    let h = (Vector3::x() * c).dot(&outward);
    let axial = match hand {
        Hand::Right => -Vector3::z(),
        Hand::Left => Vector3::z(),
    };
    -way * (k[0] * h + k[3]) - outward * (k[1] * h + k[4]) + axial * (k[2] * h + k[5])
}

/// The force at a spindle angle by Simpson's rule along z, between the heights at which an edge enters and leaves.
fn along_z(hand: Hand, cut: &Cut, angle: f64) -> Vector3<f64> {
    let arc = cut.engagement.arc_at(8.0 * MM).unwrap();
    let per_height = hand.sign() / (8.0 * MM);
    let mut sum = Vector3::zeros();
    for tooth in 0..4 {
        let tip = angle - f64::from(tooth) * FRAC_PI_2;
        for turn in -3..=3 {
            let at = |phi: f64| (tip + f64::from(turn) * TAU - phi) / per_height;
            let (a, b) = (at(arc.entry), at(arc.exit));
            let (low, high) = (a.min(b).max(0.0), a.max(b).min(cut.depth));
            if high <= low {
                continue;
            }
            let pieces = 2000;
            let step = (high - low) / f64::from(pieces);
            for i in 0..=pieces {
                let weight = match i {
                    0 => 1.0,
                    _ if i == pieces => 1.0,
                    _ if i % 2 == 1 => 4.0,
                    _ => 2.0,
                };
                let z = low + f64::from(i) * step;
                sum += edge_force(K, tip - z * per_height, cut.feed, hand) * (weight * step / 3.0);
            }
        }
    }
    sum
}

#[test]
fn closed_force_matches_an_integral_along_z() {
    for hand in [Hand::Right, Hand::Left] {
        for (immersion, depth) in [
            (Immersion::Up(5.0 * MM), MM),
            (Immersion::Down(2.0 * MM), 12.0 * MM),
            (Immersion::Slot, 60.0 * MM),
        ] {
            let cut = cut(immersion, depth);
            let milling = milling(flat(hand), cut);
            for step in 0..37 {
                let angle = f64::from(step) * 0.171;
                let (closed, numeric) = (milling.force_at(angle), along_z(hand, &cut, angle));
                // Simpson's error falls with the fourth power of 2000 pieces; forces of up to some 1e4 N.
                assert!((closed - numeric).norm() < 1e-9, "{hand:?} {immersion:?} {angle}");
            }
        }
    }
}

#[test]
fn a_slowly_winding_edge_is_a_straight_one() {
    let cut = cut(Immersion::Slot, MM);
    let straight = milling(Cutter::flat(16.0 * MM, 4).unwrap(), cut);
    let nearly = Cutter::flat(16.0 * MM, 4)
        .unwrap()
        .with_helix(1e-6, Hand::Right)
        .unwrap();
    let nearly = milling(nearly, cut);
    // A lag of 1e-7 rad turns a force of some 1e3 N by 1e-4 N.
    for angle in [0.1, 0.7, 1.3] {
        assert!((straight.force_at(angle) - nearly.force_at(angle)).norm() < 1e-3);
    }
}

#[test]
fn slices_come_near_the_closed_force() {
    let cut = cut(Immersion::Up(5.0 * MM), 4.0 * MM);
    let true_tool = milling(flat(Hand::Right), cut);
    let nearly_true = flat(Hand::Right).with_runout(Runout {
        offset: 1e-15,
        angle: 0.0,
    });
    let summed = milling(nearly_true.unwrap(), cut);
    let peak = true_tool.peak(360).norm();
    for step in 0..90 {
        let angle = f64::from(step) * TAU / 90.0;
        let error = (true_tool.force_at(angle) - summed.force_at(angle)).norm();
        // An edge that enters or leaves does so half a slice early or late.
        assert!(error < peak / f64::from(SLICES), "{angle}: {error} N of {peak} N");
    }
}

#[test]
fn a_straight_tooth_ahead_in_a_slot_is_pushed_back_and_to_the_left() {
    let tool = Cutter::flat(16.0 * MM, 1).unwrap();
    let milling = milling(tool, cut(Immersion::Slot, 2.0 * MM));
    let force = milling.force_at(FRAC_PI_2);
    let (h, depth) = (0.18 * MM, 2.0 * MM);
    let expected = Vector3::new(-(K[1] * h + K[4]), K[0] * h + K[3], -(K[2] * h + K[5])) * depth;
    // Forces of 1e3 N, a few roundings.
    assert!((force - expected).norm() < 1e-11, "{force}");
    // That is its greatest chip, and so its greatest force; behind the tool it cuts nothing.
    assert!((milling.peak(360) - expected).norm() < 1e-11);
    assert_eq!(milling.force_at(3.0 * FRAC_PI_2), Vector3::zeros());
}

#[test]
fn the_hand_of_the_helix_changes_only_the_axial_force_where_the_edge_is_straight() {
    let cut = cut(Immersion::Up(5.0 * MM), MM);
    let with = |hand| {
        let tool = Cutter::flat(16.0 * MM, 4).unwrap().with_helix(0.0, hand).unwrap();
        milling(tool, cut).force_at(0.5)
    };
    let (right, left) = (with(Hand::Right), with(Hand::Left));
    assert!(right.z < 0.0, "a right-hand helix is pulled towards the part");
    assert_eq!((right.x, right.y, right.z), (left.x, left.y, -left.z));
}

#[test]
fn forces_repeat_each_pitch_and_with_runout_each_turn() {
    let cut = cut(Immersion::Up(5.0 * MM), 2.0 * MM);
    let plain = milling(flat(Hand::Right), cut);
    assert_eq!(plain.period(), FRAC_PI_2);
    assert!((plain.force_at(0.3) - plain.force_at(0.3 + FRAC_PI_2)).norm() < 1e-10);
    let off = flat(Hand::Right)
        .with_runout(Runout {
            offset: 30e-6,
            angle: 0.2,
        })
        .unwrap();
    let off = milling(off, cut);
    assert_eq!(off.period(), TAU);
    assert!((off.force_at(0.3) - off.force_at(0.3 + FRAC_PI_2)).norm() > 1.0);
    assert!((off.force_at(0.3) - off.force_at(0.3 + TAU)).norm() < 1e-9);
}

/// Chip thickness of a tooth at a point of its edge and an immersion angle, m.
fn chip_of_tooth(milling: &Milling, tooth: u32, point: &EdgePoint, phi: f64) -> f64 {
    TeethAt::new(&milling.cutter, point).chip(tooth, milling.chip(point).at(phi))
}

#[test]
fn a_tooth_that_cuts_nothing_leaves_its_chip_to_the_next() {
    // Two teeth, one with 0.2 mm more radial runout than the other at a feed of 0.18 mm.
    let tool = Cutter::flat(16.0 * MM, 2).unwrap().with_runout(Runout {
        offset: 0.1 * MM,
        angle: 0.0,
    });
    let milling = milling(tool.unwrap(), cut(Immersion::Slot, MM));
    let point = milling.cutter.at_height(0.5 * MM);
    let chips = [0, 1].map(|tooth| chip_of_tooth(&milling, tooth, &point, FRAC_PI_2) / MM);
    assert!((chips[0] - 0.36).abs() < 1e-12, "{chips:?}");
    assert!(chips[1] < 0.0, "{chips:?}");
}

#[test]
fn teeth_share_what_a_turn_cuts_whatever_the_runout() {
    for (offset, flutes) in [(2e-6, 3), (40e-6, 4), (300e-6, 5), (2e-3, 7)] {
        let tool = Cutter::flat(16.0 * MM, flutes)
            .unwrap()
            .with_runout(Runout { offset, angle: 0.7 });
        let milling = milling(tool.unwrap(), cut(Immersion::Slot, MM));
        let point = milling.cutter.at_height(0.0);
        for phi in [0.01, 0.4, 1.2, 3.0] {
            let chips = (0..flutes).map(|tooth| chip_of_tooth(&milling, tooth, &point, phi).max(0.0));
            let whole = f64::from(flutes) * 0.18 * MM * phi.sin();
            // Sums of lengths of up to 2 mm.
            assert!(
                (chips.sum::<f64>() - whole).abs() < 1e-17,
                "{offset} {flutes} {phi}"
            );
        }
    }
}

#[test]
fn the_peak_is_longer_than_every_force_and_than_their_mean() {
    let milling = milling(flat(Hand::Right), cut(Immersion::Up(5.0 * MM), 2.0 * MM));
    let peak = milling.peak(90);
    let forces = milling.revolution(360);
    assert_eq!(forces.len(), 360);
    for force in &forces {
        // The same angles, from sums with other rounding.
        assert!(force.norm() <= peak.norm() + 1e-9);
    }
    assert!(peak.norm() > milling.mean().force.norm());
    assert!(peak.x < 0.0, "up-milling pushes back");
}

#[test]
fn a_chip_by_kienzle_has_the_force_of_its_power_law() {
    let kienzle = KienzleValues {
        specific_force: Estimate {
            value: 800e6,
            standard_uncertainty: 0.0,
        },
        exponent: Estimate {
            value: 0.25,
            standard_uncertainty: 0.0,
        },
        radial_ratio: Estimate {
            value: 0.5,
            standard_uncertainty: 0.0,
        },
        axial_ratio: Estimate {
            value: 0.1,
            standard_uncertainty: 0.0,
        },
    };
    let law = CuttingLaw::Kienzle(Kienzle::new(kienzle).unwrap());
    let tool = Cutter::flat(16.0 * MM, 1).unwrap();
    let milling = Milling::new(tool, law, cut(Immersion::Slot, 2.0 * MM)).unwrap();
    let cutting = 800.0 * 2.0 * 0.18_f64.powf(0.75);
    let force = milling.force_at(FRAC_PI_2);
    // 256 slices, each rounded.
    assert!(
        (force - Vector3::new(-0.5, 1.0, -0.1) * cutting).norm() < 1e-9,
        "{force}"
    );
    // Ten degrees of rake take a tenth.
    let keen = Milling::new(tool.with_rake(10_f64.to_radians()).unwrap(), law, milling.cut).unwrap();
    assert!((keen.force_at(FRAC_PI_2) - force * 0.9).norm() < 1e-9);
}

#[test]
fn edges_of_a_ball_push_up_at_the_tip_and_sideways_at_the_equator() {
    let ball = Cutter::ball(16.0 * MM, 2).unwrap();
    let radial = Milling::new(
        ball,
        law([0.0, 1e9, 0.0, 0.0, 0.0, 0.0]),
        cut(Immersion::Slot, MM),
    )
    .unwrap();
    let low = radial.force_at(FRAC_PI_2);
    // To 1 mm of 8 the normal leans 0 to 29 deg from the axis.
    assert!(low.z > -low.x && low.x < 0.0, "{low}");
}

#[test]
fn refuses_invalid_cuts() {
    let good = cut(Immersion::Slot, MM);
    for wrong in [
        Cut { depth: 0.0, ..good },
        Cut { depth: 2.0, ..good },
        Cut { feed: -1e-6, ..good },
        Cut {
            feed: f64::NAN,
            ..good
        },
        Cut {
            rise: f64::INFINITY,
            lean: LeanInCut::default(),
            ..good
        },
    ] {
        assert!(
            Milling::new(flat(Hand::Right), law(K), wrong).is_err(),
            "{wrong:?}"
        );
    }
    assert_eq!(milling(flat(Hand::Right), good).revolution(0).len(), 1);
    assert!((PI - good.engagement.arc_at(8.0 * MM).unwrap().exit).abs() < 1e-15);
}

#[test]
fn forces_at_several_angles_are_those_at_each() {
    let runout = Runout {
        offset: 20e-6,
        angle: 0.3,
    };
    let bull = Cutter::bull_nose(16.0 * MM, 3.0 * MM, 3).unwrap();
    for cutter in [
        flat(Hand::Right),
        bull,
        flat(Hand::Left).with_runout(runout).unwrap(),
        bull.with_runout(runout).unwrap(),
    ] {
        let milling = milling(cutter, cut(Immersion::Down(4.0 * MM), 4.0 * MM));
        let angles = [0.0, 0.1, 0.7, 1.0, 1.9, 4.0];
        let each = angles.map(|angle| milling.force_at(angle));
        assert_eq!(milling.forces_at(angles.into_iter()), each);
        assert!(each.iter().any(|force| force.norm() > 1.0), "{each:?}");
    }
}

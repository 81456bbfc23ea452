use super::*;
use crate::load::{
    Cut, Cutter, Engagement, Estimate, Hand, Immersion, Kienzle, KienzleValues, Lean, LeanInCut, Mechanistic,
    Runout,
};
use std::f64::consts::PI;

const MM: f64 = 1e-3;
/// Shear coefficients of the published mean force, N/mm2 in Pa; no edge terms.
const PUBLISHED: [f64; 6] = [1930.4e6, 1159.6e6, 200.6e6, 0.0, 0.0, 0.0];
const WITH_EDGE: [f64; 6] = [631e6, 99e6, 273e6, 13e3, 10e3, 2.8e3];

fn mechanistic(k: [f64; 6]) -> CuttingLaw {
    let shear = Vector3::new(k[0], k[1], k[2]);
    CuttingLaw::Mechanistic(Mechanistic::new(shear, Vector3::new(k[3], k[4], k[5])).unwrap())
}

fn kienzle(kc1: f64, mc: f64, u: [f64; 4]) -> CuttingLaw {
    let estimate = |value, standard_uncertainty| Estimate {
        value,
        standard_uncertainty,
    };
    let values = KienzleValues {
        specific_force: estimate(kc1, u[0]),
        exponent: estimate(mc, u[1]),
        radial_ratio: estimate(0.4, u[2]),
        axial_ratio: estimate(0.1, u[3]),
    };
    CuttingLaw::Kienzle(Kienzle::new(values).unwrap())
}

fn cut(immersion: Immersion) -> Cut {
    Cut {
        depth: MM,
        engagement: Engagement::of(immersion, 16.0 * MM).unwrap(),
        // 40 mm/s, 3333 rpm, 4 teeth.
        feed: 40.0 * MM * 60.0 / (3333.0 * 4.0),
        rise: 0.0,
        lean: LeanInCut::default(),
    }
}

fn flat() -> Cutter {
    let flat = Cutter::flat(16.0 * MM, 4).unwrap();
    flat.with_helix(45_f64.to_radians(), Hand::Right).unwrap()
}

fn mean(cutter: Cutter, law: CuttingLaw, cut: Cut) -> Vector3<f64> {
    Milling::new(cutter, law, cut).unwrap().mean().force
}

/// The averaged equations of a flat end mill as they are printed: indefinite integrals, `Fz = +Fa`.
fn printed(k: [f64; 6], c: f64, [entry, exit]: [f64; 2]) -> Vector3<f64> {
    let [ktc, krc, kac, kte, kre, kae] = k;
    let at = |p: f64| {
        let ((sin, cos), (sin2, cos2)) = (p.sin_cos(), (2.0 * p).sin_cos());
        Vector3::new(
            c / (8.0 * PI) * (ktc * cos2 - krc * (2.0 * p - sin2)) + (-kte * sin + kre * cos) / TAU,
            c / (8.0 * PI) * (ktc * (2.0 * p - sin2) + krc * cos2) - (kte * cos + kre * sin) / TAU,
            (-kac * c * cos + kae * p) / TAU,
        )
    };
    at(exit) - at(entry)
}

/// The mean force by vectors, midpoint by midpoint: positions and normals of a body of revolution, no formula of ours.
///
/// `strip` is where the part begins and ends to the left of the axis, m; `n` midpoints each way; right-hand helix.
fn by_vectors(cutter: &Cutter, cut: &Cut, strip: [f64; 2], n: u32) -> Vector3<f64> {
    let law = mechanistic(WITH_EDGE);
    let (radius, r) = (cutter.radius(), cutter.corner_radius());
    let feed = Vector3::new(cut.feed, 0.0, cut.rise);
    let corner = if cut.depth < r {
        (1.0 - cut.depth / r).acos()
    } else {
        PI / 2.0
    } * r;
    let length = corner + (cut.depth - r).max(0.0);
    let mut sum = Vector3::zeros();
    for i in 0..n {
        let s = (f64::from(i) + 0.5) * length / f64::from(n);
        let (out, down) = if s < corner { (s / r).sin_cos() } else { (1.0, 0.0) };
        let rho = radius - r + r * out;
        // Where the circle of this radius crosses the sides of the strip, if it does.
        let [exit, entry] = strip.map(|y| (rho * rho - y * y).max(0.0).sqrt().atan2(y));
        let step = (exit - entry) / f64::from(n);
        for j in 0..n {
            let phi = entry + (f64::from(j) + 0.5) * step;
            let ray = Vector3::new(phi.sin(), phi.cos(), 0.0);
            let normal = ray * out - Vector3::z() * down;
            let way = (-Vector3::z()).cross(&ray);
            let h = feed.dot(&normal);
            if h < 0.0 {
                continue;
            }
            let f = law.force(h);
            // Along the profile, down and in.
            let to_tip = normal.cross(&way);
            sum += (-way * f.x - normal * f.y + to_tip * f.z) * step;
        }
    }
    sum * (length / f64::from(n)) * f64::from(cutter.flutes()) / TAU
}

#[test]
fn published_mean_forces_of_up_and_down_milling() {
    // Averaged equations print Fz = +Fa: of a right-hand helix that force draws the tool to the part, to -z.
    let up = mean(flat(), mechanistic(PUBLISHED), cut(Immersion::Up(5.0 * MM)));
    let down = mean(flat(), mechanistic(PUBLISHED), cut(Immersion::Down(5.0 * MM)));
    // Half of the last digit printed.
    assert!(
        (up - Vector3::new(-150.7929, 35.6771, -14.3684)).amax() < 5e-5,
        "{up}"
    );
    assert!(
        (down - Vector3::new(39.3263, 149.8826, -14.3684)).amax() < 5e-5,
        "{down}"
    );
    assert!((up.norm() - 155.6207).abs() < 5e-5 && (down.norm() - 155.6207).abs() < 5e-5);
}

#[test]
fn the_mean_of_a_flat_end_mill_is_the_printed_one() {
    let exit = |ae: f64| (1.0 - ae / 8.0).acos();
    for (immersion, arc) in [
        (Immersion::Up(3.0 * MM), [0.0, exit(3.0)]),
        (Immersion::Up(15.0 * MM), [0.0, exit(15.0)]),
        (Immersion::Down(1.0 * MM), [PI - exit(1.0), PI]),
        (Immersion::Slot, [0.0, PI]),
        (Immersion::Centred(8.0 * MM), [PI / 3.0, 2.0 * PI / 3.0]),
    ] {
        let cut = cut(immersion);
        let printed = printed(WITH_EDGE, cut.feed, arc) * (4.0 * cut.depth);
        let found = mean(flat(), mechanistic(WITH_EDGE), cut);
        let expected = Vector3::new(printed.x, printed.y, -printed.z);
        // Forces of 100 N, a few tens of roundings.
        assert!(
            (found - expected).amax() < 1e-11,
            "{immersion:?}: {found} {expected}"
        );
    }
}

#[test]
fn the_mean_is_the_mean_of_a_revolution() {
    for immersion in [
        Immersion::Up(5.0 * MM),
        Immersion::Slot,
        Immersion::Centred(3.0 * MM),
    ] {
        let milling = Milling::new(flat(), mechanistic(WITH_EDGE), cut(immersion)).unwrap();
        let forces = milling.revolution(20_000);
        let sum: Vector3<f64> = forces.iter().sum();
        let error = (sum / 20_000.0 - milling.mean().force).norm();
        // Forces bend where an edge enters or leaves: the error of even steps is some step squared, (2 pi/20000)^2.
        assert!(
            error < 1e-6 * milling.mean().force.norm(),
            "{immersion:?}: {error} N"
        );
    }
}

#[test]
fn known_integrals_of_a_slot() {
    let cut = cut(Immersion::Slot);
    let [ktc, krc, kac, kte, kre, kae] = WITH_EDGE;
    let (c, whole) = (cut.feed, 4.0 * cut.depth);
    let expected = Vector3::new(
        -krc * c / 4.0 - kre / PI,
        ktc * c / 4.0 + kte / PI,
        -kac * c / PI - kae / 2.0,
    ) * whole;
    assert!((mean(flat(), mechanistic(WITH_EDGE), cut) - expected).norm() < 1e-11);
}

#[test]
fn force_is_proportional_to_depth_teeth_and_coefficients() {
    let one = cut(Immersion::Up(5.0 * MM));
    let force = mean(flat(), mechanistic(WITH_EDGE), one);
    let deep = Cut {
        depth: 3.0 * one.depth,
        ..one
    };
    assert!((mean(flat(), mechanistic(WITH_EDGE), deep) - force * 3.0).norm() < 1e-11);
    let hard = WITH_EDGE.map(|k| 2.5 * k);
    assert!((mean(flat(), mechanistic(hard), one) - force * 2.5).norm() < 1e-11);
    let two = Cutter::flat(16.0 * MM, 2).unwrap();
    assert!((mean(two, mechanistic(WITH_EDGE), one) * 2.0 - force).norm() < 1e-11);
}

#[test]
fn no_feed_leaves_the_force_of_the_edges() {
    let still = Cut {
        feed: 0.0,
        ..cut(Immersion::Up(5.0 * MM))
    };
    let [_, _, _, kte, kre, kae] = WITH_EDGE;
    let edges_alone = mean(
        flat(),
        mechanistic([0.0, 0.0, 0.0, kte, kre, kae]),
        cut(Immersion::Up(5.0 * MM)),
    );
    let found = mean(flat(), mechanistic(WITH_EDGE), still);
    assert!(found.norm() > 1.0 && (found - edges_alone).norm() < 1e-12);
}

#[test]
fn up_and_down_milling_mirror_each_other() {
    // phi and 180 deg - phi: the same chip, the cosine turned. So tangential force mirrors x, radial force mirrors y.
    let [ktc, krc, kac, kte, kre, kae] = WITH_EDGE;
    let of = |k, immersion| mean(flat(), mechanistic(k), cut(immersion));
    let tangential = [ktc, 0.0, kac, kte, 0.0, kae];
    let (up, down) = (
        of(tangential, Immersion::Up(5.0 * MM)),
        of(tangential, Immersion::Down(5.0 * MM)),
    );
    assert!((Vector3::new(-up.x, up.y, up.z) - down).norm() < 1e-11);
    let radial = [0.0, krc, kac, 0.0, kre, kae];
    let (up, down) = (
        of(radial, Immersion::Up(5.0 * MM)),
        of(radial, Immersion::Down(5.0 * MM)),
    );
    assert!((Vector3::new(up.x, -up.y, up.z) - down).norm() < 1e-11);
}

#[test]
fn ball_and_bull_nose_match_vectors_summed_in_steps() {
    let ball = Cutter::ball(16.0 * MM, 4).unwrap();
    let nose = Cutter::bull_nose(16.0 * MM, 3.0 * MM, 4).unwrap();
    for (cutter, depth) in [(ball, 2.0), (ball, 11.0), (nose, 1.5), (nose, 5.0)] {
        for (immersion, strip) in [
            (Immersion::Slot, [-8.0, 8.0]),
            (Immersion::Up(5.0 * MM), [3.0, 8.0]),
            (Immersion::Up(12.0 * MM), [-4.0, 8.0]),
            (Immersion::Down(5.0 * MM), [-8.0, -3.0]),
            (Immersion::Centred(6.0 * MM), [-3.0, 3.0]),
        ] {
            let cut = Cut {
                depth: depth * MM,
                ..cut(immersion)
            };
            let found = mean(cutter, mechanistic(WITH_EDGE), cut);
            let summed = by_vectors(&cutter, &cut, strip.map(|y| y * MM), 1000);
            let error = (found - summed).norm();
            // Midpoints err by 1000^-2, and by 1000^-1.5 where the strip begins along the profile like a root.
            assert!(error < 1e-4 * found.norm(), "{immersion:?} {depth}: {error} N");
        }
    }
}

#[test]
fn ramps_of_a_ball_match_vectors_summed_in_steps_and_a_flat_end_mill_has_the_level_feed() {
    let ball = Cutter::ball(16.0 * MM, 4).unwrap();
    for rise in [-0.03 * MM, 0.03 * MM, 0.1 * MM] {
        let cut = Cut {
            depth: 3.0 * MM,
            rise,
            ..cut(Immersion::Slot)
        };
        let law = mechanistic(WITH_EDGE);
        let found = mean(ball, law, cut);
        let summed = by_vectors(&ball, &cut, [-8.0 * MM, 8.0 * MM], 1500);
        // Rising, cells on the line where the edge lifts off count whole or not at all.
        assert!(
            (found - summed).norm() < 3e-4 * found.norm(),
            "{rise}: {found} {summed}"
        );
        assert_eq!(
            mean(flat(), law, cut),
            mean(flat(), law, Cut { rise: 0.0, ..cut })
        );
    }
    // Diving makes thicker chips at the tip, rising thinner ones.
    let at = |rise: f64| {
        let cut = Cut {
            rise,
            ..cut(Immersion::Slot)
        };
        mean(ball, mechanistic(PUBLISHED), cut).z
    };
    assert!(at(-0.03 * MM) > at(0.0) && at(0.0) > at(0.03 * MM));
}

#[test]
fn a_corner_radius_of_zero_is_a_flat_end_mill() {
    let sharp = Cutter::bull_nose(16.0 * MM, 1e-9, 4).unwrap();
    let cut = cut(Immersion::Up(5.0 * MM));
    let law = mechanistic(WITH_EDGE);
    let difference = (mean(sharp, law, cut) - mean(flat(), law, cut)).norm();
    // A corner of 1 nm on a depth of 1 mm.
    assert!(difference < 1e-5 * mean(flat(), law, cut).norm());
}

fn off_centre(offset: f64) -> Cutter {
    flat().with_runout(Runout { offset, angle: 0.3 }).unwrap()
}

#[test]
fn runout_does_not_change_the_mean_while_every_tooth_cuts() {
    // From 60 to 120 deg the chip is at least 0.156 mm; teeth 90 deg apart differ by 1.41 times 20 um.
    let cut = cut(Immersion::Centred(8.0 * MM));
    let law = mechanistic(WITH_EDGE);
    let (round, off) = (mean(flat(), law, cut), mean(off_centre(20e-6), law, cut));
    // Sums over 256 slices, each rounded.
    let error = (round - off).norm() / round.norm();
    assert!(error < 1e-13, "{error}");
}

#[test]
fn a_tooth_that_cuts_nothing_loses_its_edge_force_but_not_its_chip() {
    let cut = cut(Immersion::Centred(8.0 * MM));
    let shear = mechanistic(PUBLISHED);
    // The slightest edge force has every tooth looked at.
    let nearly_shear = mechanistic([1930.4e6, 1159.6e6, 200.6e6, 1e-6, 0.0, 0.0]);
    let off = off_centre(400e-6);
    let (round, shared) = (mean(flat(), shear, cut), mean(off, nearly_shear, cut));
    let error = (round - shared).norm() / round.norm();
    // The edge force is 1e-9 N of 300 N.
    assert!(error < 1e-11, "{error}");
    assert_eq!(mean(off, shear, cut), round);

    let edges = mechanistic([0.0, 0.0, 0.0, 13e3, 10e3, 2.8e3]);
    let (all, some) = (mean(flat(), edges, cut), mean(off, edges, cut));
    assert!(some.norm() < 0.8 * all.norm(), "{some} of {all}");
}

#[test]
fn runout_reduces_the_force_of_kienzles_law() {
    // The same metal in fewer, thicker chips: a lower specific force.
    let cut = cut(Immersion::Centred(8.0 * MM));
    let law = kienzle(800e6, 0.25, [0.0; 4]);
    let (round, off) = (mean(flat(), law, cut), mean(off_centre(400e-6), law, cut));
    assert!(off.norm() < 0.95 * round.norm(), "{off} {round}");
}

#[test]
fn kienzle_without_exponent_is_a_linear_law() {
    let linear = mechanistic([800e6, 320e6, 80e6, 0.0, 0.0, 0.0]);
    let ball = Cutter::ball(16.0 * MM, 4).unwrap();
    for cutter in [flat(), ball] {
        for immersion in [Immersion::Up(5.0 * MM), Immersion::Slot] {
            let cut = cut(immersion);
            let (power, straight) = (
                mean(cutter, kienzle(800e6, 0.0, [0.0; 4]), cut),
                mean(cutter, linear, cut),
            );
            assert!(
                (power - straight).norm() < 1e-11 * straight.norm().max(1.0),
                "{immersion:?}"
            );
        }
    }
}

#[test]
fn kienzles_mean_matches_an_independent_substitution() {
    // Up-milling: phi = t^4 makes phi^0.75 a cube; then Simpson's rule.
    let cut = cut(Immersion::Up(5.0 * MM));
    let exit = (3.0_f64 / 8.0).acos();
    let end = exit.powf(0.25);
    let pieces = 2000;
    let step = end / f64::from(pieces);
    let mut sum = Vector3::zeros();
    for i in 0..=pieces {
        let weight = match i {
            0 => 1.0,
            _ if i == pieces => 1.0,
            _ if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let t = f64::from(i) * step;
        let phi = t.powi(4);
        let h_mm = cut.feed / MM * phi.sin();
        let cutting = 800.0 * h_mm.powf(0.75);
        let force = Vector3::new(-phi.cos() - 0.4 * phi.sin(), phi.sin() - 0.4 * phi.cos(), -0.1) * cutting;
        sum += force * (weight * step / 3.0 * 4.0 * t.powi(3));
    }
    // 4 teeth, 1 mm deep.
    let expected = sum * 4.0 / TAU;
    let found = mean(flat(), kienzle(800e6, 0.25, [0.0; 4]), cut);
    // Sixteen nodes on a power that begins like t^2.5: some 16^-7, a few times.
    let error = (found - expected).norm() / expected.norm();
    assert!(error < 1e-7, "{error}");
}

#[test]
fn the_catalogues_mean_chip_comes_near_the_integral() {
    let cut = cut(Immersion::Up(5.0 * MM));
    let arc = cut.engagement.arc_at(8.0 * MM).unwrap();
    let hm = cut.feed * (arc.entry.cos() - arc.exit.cos()) / (arc.exit - arc.entry);
    let CuttingLaw::Kienzle(law) = kienzle(800e6, 0.25, [0.0; 4]) else {
        unreachable!()
    };
    let specific = Mechanistic::new(law.force(hm) / hm, Vector3::zeros()).unwrap();
    let by_mean = mean(flat(), CuttingLaw::Mechanistic(specific), cut);
    let exact = mean(flat(), CuttingLaw::Kienzle(law), cut);
    let error = (by_mean - exact).norm() / exact.norm();
    // A power of 0.75 on chips of zero to twice the mean: some percent, and not nothing.
    assert!(error < 0.06 && error > 0.001, "{error}");
}

#[test]
fn uncertainty_of_one_coefficient_is_its_part_of_the_force() {
    let mut covariance = nalgebra::Matrix6::zeros();
    covariance[(0, 0)] = (0.1 * PUBLISHED[0]).powi(2);
    let shear = Vector3::new(PUBLISHED[0], PUBLISHED[1], PUBLISHED[2]);
    let law = Mechanistic::new(shear, Vector3::zeros()).unwrap();
    let law = CuttingLaw::Mechanistic(law.with_covariance(covariance).unwrap());
    let cut = cut(Immersion::Up(5.0 * MM));
    let found = Milling::new(flat(), law, cut).unwrap().mean().covariance;
    let [ktc, ..] = PUBLISHED;
    let part = mean(flat(), mechanistic([ktc, 0.0, 0.0, 0.0, 0.0, 0.0]), cut) * 0.1;
    assert!((found - part * part.transpose()).norm() < 1e-11);
}

#[test]
fn uncertainty_of_kc1_is_a_fraction_of_the_force_and_of_mc_a_difference() {
    let cut = cut(Immersion::Up(5.0 * MM));
    let of = |kc1, mc, u| Milling::new(flat(), kienzle(kc1, mc, u), cut).unwrap().mean();
    let tenth = of(800e6, 0.25, [80e6, 0.0, 0.0, 0.0]);
    let expected = tenth.force * tenth.force.transpose() * 0.01;
    assert!((tenth.covariance - expected).norm() < 1e-10 * expected.norm());

    let by_exponent = of(800e6, 0.25, [0.0, 0.02, 0.0, 0.0]).covariance;
    let step = 1e-5;
    let change = of(800e6, 0.25 + step, [0.0; 4]).force - of(800e6, 0.25 - step, [0.0; 4]).force;
    let change = change * (0.02 / (2.0 * step));
    let expected = change * change.transpose();
    // Central differences of a smooth law.
    assert!((by_exponent - expected).norm() < 1e-7 * expected.norm());
}

#[test]
fn a_covariance_is_the_same_for_each_tooth_separately() {
    let law = Mechanistic::new(Vector3::new(631e6, 99e6, 273e6), Vector3::new(13e3, 10e3, 2.8e3)).unwrap();
    let law = CuttingLaw::Mechanistic(law.with_relative_uncertainty(0.2).unwrap());
    let cut = cut(Immersion::Centred(8.0 * MM));
    let of = |cutter| Milling::new(cutter, law, cut).unwrap().mean().covariance;
    let (round, off) = (of(flat()), of(off_centre(20e-6)));
    assert!((round - off).norm() < 1e-12 * round.norm());
}

#[test]
fn the_mean_with_runout_is_that_of_all_angles_of_a_revolution() {
    let tools = [
        flat(),
        Cutter::bull_nose(16.0 * MM, 3.0 * MM, 3).unwrap(),
        Cutter::ball(16.0 * MM, 2).unwrap(),
    ];
    let laws = [mechanistic(WITH_EDGE), kienzle(800e6, 0.25, [0.0; 4])];
    let leaning = Lean {
        lead: 12_f64.to_radians(),
        tilt: 5_f64.to_radians(),
    };
    for (tool, offset) in tools
        .into_iter()
        .flat_map(|tool| [20e-6, 150e-6].map(|offset| (tool, offset)))
    {
        for (law, lean) in laws
            .into_iter()
            .flat_map(|law| [Lean::NONE, leaning].map(|lean| (law, lean)))
        {
            let cutter = tool.with_helix(0.5, Hand::Right).unwrap();
            let cutter = cutter.with_runout(Runout { offset, angle: 0.3 }).unwrap();
            let cut = Cut {
                rise: 0.01 * MM,
                ..cut(Immersion::Up(5.0 * MM))
            };
            let milling = Milling::new(cutter, law, cut.leaning(lean, cutter.body())).unwrap();
            let forces = milling.revolution(10_000);
            let mean = forces.iter().sum::<Vector3<f64>>() / 1e4;
            let error = (mean - milling.mean().force).norm() / mean.norm();
            // A step in which a slice begins or ends to cut counts whole or not at all: half a step of an arc of some 1500.
            assert!(error < 3e-4, "{cutter:?} {law:?} {lean:?}: {error}");
        }
    }
}

#[test]
fn the_force_alone_is_the_force_of_the_mean() {
    let tools = [Cutter::flat(16.0 * MM, 4), Cutter::ball(16.0 * MM, 4)].map(Result::unwrap);
    let laws = [mechanistic(WITH_EDGE), kienzle(800e6, 0.25, [0.0; 4])];
    for (tool, law) in tools.into_iter().flat_map(|tool| laws.map(|law| (tool, law))) {
        let milling = Milling::new(tool, law, cut(Immersion::Up(5.0 * MM))).unwrap();
        assert_eq!(milling.mean_force(), milling.mean().force);
    }
}

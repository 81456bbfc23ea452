use super::*;
use crate::load::{Engagement, Hand, Immersion, LeanInCut, Mechanistic};

/// To the left and along the normal, where the tool is upright.
const UPRIGHT: [Vector3<f64>; 2] = [Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];

fn law() -> CuttingLaw {
    let shear = Vector3::new(796e6, 168e6, 222e6);
    let edge = Vector3::new(27e3, 30e3, 5e3);
    CuttingLaw::Mechanistic(Mechanistic::new(shear, edge).unwrap())
}

fn cut(cutter: &Cutter, immersion: Immersion) -> Cut {
    Cut {
        depth: 2e-3,
        engagement: Engagement::of(immersion, cutter.diameter()).unwrap(),
        feed: 0.1e-3,
        rise: 0.0,
        lean: LeanInCut::default(),
    }
}

fn nominal_force(cutter: Cutter, cut: Cut) -> Vector3<f64> {
    Milling::new(cutter, law(), cut).unwrap().mean().force
}

fn settled(rest: Rest) -> Vector3<f64> {
    let Rest::Settled(force) = rest else {
        panic!("pulled in")
    };
    force
}

/// A tip with the compliance `um_n` along each axis, and a little across them.
fn tip(um_n: f64) -> TipCompliance {
    let a = Matrix3::new(1.0, 0.2, -0.1, 0.2, 0.8, 0.15, -0.1, 0.15, 1.3);
    TipCompliance {
        by_force: a * (um_n * 1e-6),
        unloaded: Vector3::new(3e-6, -5e-6, -8e-6),
    }
}

/// The offset by relaxation from zero, in steps so small that they cannot diverge.
fn relaxed(cutter: Cutter, cut: &Cut, tip: &TipCompliance) -> Vector2<f64> {
    let mut s = Vector2::zeros();
    for _ in 0..200_000 {
        let force = cut
            .deflected(s, cutter.radius())
            .map_or_else(Vector3::zeros, |cut| nominal_force(cutter, cut));
        s += (offset_under(tip, force, &UPRIGHT) - s) * 0.02;
    }
    s
}

#[test]
fn at_equilibrium_deviation_and_force_are_consistent() {
    for cutter in [Cutter::flat(10e-3, 2), Cutter::ball(10e-3, 2)].map(Result::unwrap) {
        for immersion in [
            Immersion::Up(3e-3),
            Immersion::Down(3e-3),
            Immersion::Slot,
            Immersion::Centred(4e-3),
        ] {
            let cut = cut(&cutter, immersion);
            let force = nominal_force(cutter, cut);
            for um_n in [0.01, 0.3, 1.0, 3.0] {
                let tip = tip(um_n);
                let mut equilibrium = ForceEquilibrium::new(cutter, law());
                let s = offset_under(&tip, settled(equilibrium.rest(&cut, force, &tip)), &UPRIGHT);
                let met = cut
                    .deflected(s, cutter.radius())
                    .map(|cut| nominal_force(cutter, cut));
                let again = offset_under(&tip, met.unwrap(), &UPRIGHT);
                let size = (tip.by_force * force).norm();
                assert!(
                    (again - s).norm() < 1e-4 * size,
                    "{immersion:?} {um_n}: {s} {again}"
                );
            }
        }
    }
}

#[test]
fn relaxation_finds_the_same_equilibrium() {
    let cutter = Cutter::flat(10e-3, 2).unwrap();
    for immersion in [Immersion::Up(3e-3), Immersion::Slot] {
        let cut = cut(&cutter, immersion);
        let tip = tip(1.0);
        let rest = ForceEquilibrium::new(cutter, law()).rest(&cut, nominal_force(cutter, cut), &tip);
        let relaxed = relaxed(cutter, &cut, &tip);
        let found = offset_under(&tip, settled(rest), &UPRIGHT);
        assert!(
            (found - relaxed).norm() < 1e-4 * relaxed.norm(),
            "{found} {relaxed}"
        );
    }
}

#[test]
fn a_tip_compliant_along_the_tool_axis_only_has_a_closed_form_equilibrium() {
    // A flat end mill: the force is proportional to the depth, so d = a F0 (1 - d/ap), d = a F0/(1 + a F0/ap). A
    // left-hand helix lifts the tool out.
    let cutter = Cutter::flat(10e-3, 2).unwrap();
    let cutter = cutter.with_helix(0.6, Hand::Left).unwrap();
    let cut = cut(&cutter, Immersion::Slot);
    let force = nominal_force(cutter, cut);
    for a in [1e-8, 1e-6, 1e-5, 1e-4] {
        let tip = TipCompliance {
            by_force: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, a)),
            unloaded: Vector3::zeros(),
        };
        let rest = ForceEquilibrium::new(cutter, law()).rest(&cut, force, &tip);
        let stiff = a * force.z;
        let expected = stiff / (1.0 + stiff / cut.depth);
        assert!(
            ((a * settled(rest).z) - expected).abs() < 2e-5 * expected.abs(),
            "{a}"
        );
    }
}

#[test]
fn a_stiff_tip_has_the_nominal_force() {
    let cutter = Cutter::flat(10e-3, 2).unwrap();
    let cut = cut(&cutter, Immersion::Down(3e-3));
    let force = nominal_force(cutter, cut);
    let tip = TipCompliance {
        by_force: Matrix3::identity() * 1e-15,
        unloaded: Vector3::zeros(),
    };
    let rest = ForceEquilibrium::new(cutter, law()).rest(&cut, force, &tip);
    assert!((settled(rest) - force).norm() < 1e-6 * force.norm());
}

#[test]
fn a_tool_that_is_pulled_in_without_end_has_no_equilibrium() {
    // A right-hand helix pulls the tool towards the part: with enough compliance every depth pulls it deeper still.
    let cutter = Cutter::flat(10e-3, 2).unwrap();
    let cutter = cutter.with_helix(0.6, Hand::Right).unwrap();
    let cut = cut(&cutter, Immersion::Slot);
    let force = nominal_force(cutter, cut);
    assert!(force.z < 0.0);
    let soft = |over: f64| TipCompliance {
        by_force: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, over * cut.depth / -force.z)),
        unloaded: Vector3::zeros(),
    };
    let rest = ForceEquilibrium::new(cutter, law()).rest(&cut, force, &soft(2.0));
    assert_eq!(rest, Rest::PulledIn);
    // At half of that it cuts twice the nominal depth, and stays there.
    let rest = ForceEquilibrium::new(cutter, law()).rest(&cut, force, &soft(0.5));
    assert!((settled(rest).z / force.z - 2.0).abs() < 1e-4);
}

#[test]
fn weight_that_lifts_the_tool_out_of_the_cut_leaves_no_force() {
    let cutter = Cutter::flat(10e-3, 2).unwrap();
    let cut = cut(&cutter, Immersion::Slot);
    let tip = TipCompliance {
        by_force: Matrix3::identity() * 1e-9,
        unloaded: Vector3::new(0.0, 0.0, 3e-3),
    };
    let rest = ForceEquilibrium::new(cutter, law()).rest(&cut, nominal_force(cutter, cut), &tip);
    assert_eq!(rest, Rest::Settled(Vector3::zeros()));
}

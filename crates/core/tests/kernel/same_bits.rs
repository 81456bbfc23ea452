//! Lanes against themselves: other back ends, other numbers of points, poses given in another way.

use std::fmt::Debug;

use armill_core::frame::Isometry;
use armill_core::kernel::lanes::{Arrays, Backend, Envelopes, Poses, Precision};
use armill_core::kernel::{BranchChoice, Question};
use armill_core::nalgebra::Point3;
use armill_core::robot::Branch;
use armill_core::workpiece::Plane;

use crate::{Soa, analysis, arms, batch, cases, poses_of, some};

/// All results of a batch for these poses, as numbers.
fn everything<T: Precision>(
    question: &Question<'_>,
    soa: &Soa<T>,
    count: usize,
    backend: Backend,
) -> Vec<f64> {
    let cut = Soa(std::array::from_fn(|k| soa.0[k][..count].to_vec()));
    let mut batch = batch::<T>(question, backend);
    let mut all = Vec::new();
    let mut envelopes: [Envelopes<T>; 4] = Default::default();
    batch.envelopes_of_all(&cut.poses(), &mut envelopes);
    for one in &envelopes {
        all.extend(one.in_plane().iter().map(|x| x.to_f64()));
        all.extend((0..count).map(|i| f64::from(one.flags(i))));
        all.extend((0..count).map(|i| one.worst_case(i) as f64));
    }
    let mut out = Arrays::default();
    batch.compliances(&cut.poses(), Branch::ALL[2], &mut out);
    all.extend((0..22).flat_map(|k| out.array(k).iter().map(|x| x.to_f64())));
    batch.joints(&cut.poses(), &mut out);
    all.extend((0..56).flat_map(|k| out.array(k).iter().map(|x| x.to_f64())));
    let joints: Vec<Vec<T>> = (0..6).map(|k| out.array(k).to_vec()).collect();
    let joints: [&[T]; 6] = std::array::from_fn(|k| &joints[k][..]);
    batch.forward(&joints, &mut out);
    all.extend((0..48).flat_map(|k| out.array(k).iter().map(|x| x.to_f64())));
    all
}

/// Numbers as they are stored, so that 0 and -0 differ.
fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// All results of the lanes, on every back end of this machine: two sets of bits, with and without fused products.
fn same_bits_wherever_product_and_sum_are_fused<T: Precision + Debug>() {
    for robot in arms::all() {
        let soa = poses_of::<T>(&some(&robot, 1_000));
        analysis(&robot, &cases(5), BranchChoice::Best, |question| {
            for fuses in [false, true] {
                let mut same = Backend::available()
                    .into_iter()
                    .filter(|backend| backend.fuses() == fuses)
                    .map(|backend| (backend, bits(&everything(question, &soa, 1_000, backend))));
                if let Some((first, expected)) = same.next() {
                    for (other, found) in same {
                        assert!(
                            found == expected,
                            "{}: {other} differs from {first}",
                            robot.name()
                        );
                    }
                }
            }
        });
    }
}

#[test]
fn same_bits_on_every_back_end_that_fuses_and_on_every_one_that_does_not() {
    same_bits_wherever_product_and_sum_are_fused::<f64>();
    same_bits_wherever_product_and_sum_are_fused::<f32>();
}

#[test]
fn any_number_of_points_gives_the_bits_of_each_alone() {
    let robot = arms::tx2_90();
    let soa = poses_of::<f64>(&some(&robot, 400));
    analysis(&robot, &cases(3), BranchChoice::Best, |question| {
        let mut batch = batch::<f64>(question, Backend::fastest());
        let mut whole = Envelopes::default();
        batch.envelopes(&soa.poses(), Branch::ALL[0], &mut whole);
        for count in [0, 1, 2, 79, 80, 81, 160, 161, 399] {
            let cut = Soa(std::array::from_fn(|k| soa.0[k][..count].to_vec()));
            let mut part = Envelopes::default();
            batch.envelopes(&cut.poses(), Branch::ALL[0], &mut part);
            assert_eq!(bits(part.in_plane()), bits(&whole.in_plane()[..count]));
        }
    });
}

#[test]
fn still_poses_give_what_free_poses_give() {
    let robot = arms::mh12();
    let plane = Plane::tilted(Point3::new(0.9, 0.1, 0.7), 0.3);
    let poses: Vec<Isometry> = (0..200)
        .map(|i| plane.base_from_tool([0.002 * f64::from(i) - 0.2, 0.1].into(), 0.4))
        .collect();
    let soa = Soa::<f64>::of(poses.iter());
    analysis(&robot, &cases(2), BranchChoice::Best, |question| {
        let still = Poses::Still {
            base_from_tool: poses[0].rotation.to_rotation_matrix(),
            at: std::array::from_fn(|k| &soa.0[9 + k][..]),
        };
        let mut batch = batch::<f64>(question, Backend::fastest());
        let mut out: [Envelopes<f64>; 2] = Default::default();
        batch.envelopes(&soa.poses(), Branch::ALL[0], &mut out[0]);
        batch.envelopes(&still, Branch::ALL[0], &mut out[1]);
        for (a, b) in out[0].in_plane().iter().zip(out[1].in_plane()) {
            assert!((a - b).abs() < 1e-13 * a, "{a} {b}");
        }
    });
}

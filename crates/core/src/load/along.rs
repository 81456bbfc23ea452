//! The load along a path: it may turn with the feed, change from point to point, and depend on the deviation of the
//! tool.
//!
//! `w = (R f, R m)`. For a cut at equilibrium: `f_greatest = f_greatest,nominal |f| / |f_nominal|`.
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `w` | wrench on the tool at the TCP, base axes | N, N m |
//! | `f`, `m` | force and moment, in the axes of the input | N, N m |
//! | `R` | rotation from these axes to base ([`LoadFrame`]) | - |

use nalgebra::{Rotation3, Vector3};

use super::cases::{LoadCases, LoadFrame, turned};
use super::cut::Cut;
use super::cutter::Cutter;
use super::law::CuttingLaw;
use crate::frame::Isometry;
use crate::spatial::Wrench;

/// The load on the tool at the points of a path.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one for a whole path")]
pub enum PathLoad {
    /// The same cases at every point, given in their frame.
    Cases(LoadCases),
    /// Each point has its own wrenches: the same number for every point, stored point after point.
    OfEach {
        /// Wrenches per point.
        cases: usize,
        /// Axes of their components.
        frame: LoadFrame,
        /// The wrenches.
        wrenches: Vec<Wrench>,
    },
    /// Cutting forces of a tool along the path.
    Cuts(CutsAlong),
}

/// The cut along a path and its forces.
#[derive(Clone, Debug, PartialEq)]
pub struct CutsAlong {
    /// The tools.
    pub cutters: Vec<Cutter>,
    /// Cutting force law.
    pub law: CuttingLaw,
    /// Use of the greatest force.
    pub greatest: GreatestForce,
    /// The cut at each point.
    pub points: Vec<CutHere>,
}

/// Use of the greatest force of a revolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GreatestForce {
    /// Only the mean force is a load case.
    LeftOut,
    /// The greatest force is the second load case.
    SecondCase,
}

/// The cut at one point of the nominal path. Its forces (feed frame) are the nominal ones until the force-deflection
/// equilibrium is solved ([`super::force_equilibrium`]), then those at equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutHere {
    /// Index of the tool.
    pub cutter: usize,
    /// The cut; `None` in the air and where the force is not known.
    pub cut: Option<Cut>,
    /// Mean force over a revolution, N.
    pub mean: Vector3<f64>,
    /// Greatest force of a revolution, N; zero where it is not requested.
    pub greatest: Vector3<f64>,
}

impl CutHere {
    /// Nothing is cut.
    pub const NOTHING: CutHere = CutHere {
        cutter: 0,
        cut: None,
        mean: Vector3::new(0.0, 0.0, 0.0),
        greatest: Vector3::new(0.0, 0.0, 0.0),
    };

    /// Its forces where the mean force has become `mean` (N). The greatest force scales with it; where the nominal path
    /// has no force, it equals the mean.
    pub fn under(&self, mean: Vector3<f64>) -> [Vector3<f64>; 2] {
        let nominal = self.mean.norm();
        if nominal == 0.0 {
            return [mean, mean];
        }
        [mean, self.greatest * (mean.norm() / nominal)]
    }
}

impl PathLoad {
    /// Load cases per point.
    pub fn case_count(&self) -> usize {
        match self {
            PathLoad::Cases(load) => load.cases.len(),
            PathLoad::OfEach { cases, .. } => *cases,
            PathLoad::Cuts(cuts) => match cuts.greatest {
                GreatestForce::LeftOut => 1,
                GreatestForce::SecondCase => 2,
            },
        }
    }

    /// Whether the load is the same at every point, whatever the direction of the path.
    pub fn is_steady(&self) -> bool {
        matches!(self, PathLoad::Cases(load) if load.frame != LoadFrame::Feed)
    }

    /// The load along a path whose first point is added as its last.
    pub fn closed(&self) -> PathLoad {
        let mut closed = self.clone();
        match &mut closed {
            PathLoad::Cases(_) => {}
            PathLoad::OfEach { cases, wrenches, .. } => wrenches.extend_from_within(..*cases),
            PathLoad::Cuts(cuts) => cuts.points.extend_from_within(..1),
        }
        closed
    }

    /// The load at these points alone.
    ///
    /// # Panics
    /// If it does not [cover](PathLoad::covers) one of them.
    pub fn at_points(&self, indices: &[usize]) -> PathLoad {
        match self {
            PathLoad::Cases(load) => PathLoad::Cases(load.clone()),
            PathLoad::OfEach {
                cases,
                frame,
                wrenches,
            } => PathLoad::OfEach {
                cases: *cases,
                frame: *frame,
                wrenches: indices
                    .iter()
                    .flat_map(|index| &wrenches[index * cases..][..*cases])
                    .copied()
                    .collect(),
            },
            PathLoad::Cuts(cuts) => PathLoad::Cuts(CutsAlong {
                cutters: cuts.cutters.clone(),
                points: indices.iter().map(|index| cuts.points[*index]).collect(),
                ..*cuts
            }),
        }
    }

    /// The load with all forces and moments multiplied by `factor`; of a cut with those of its law.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> PathLoad {
        let mut scaled = self.clone();
        match &mut scaled {
            PathLoad::Cases(LoadCases { cases: wrenches, .. }) | PathLoad::OfEach { wrenches, .. } => {
                for wrench in wrenches {
                    *wrench = *wrench * factor;
                }
            }
            PathLoad::Cuts(cuts) => {
                cuts.law = cuts.law.scaled(factor);
                for here in &mut cuts.points {
                    here.mean *= factor;
                    here.greatest *= factor;
                }
            }
        }
        scaled
    }

    /// The load with this force (N, base) added to every case, for a part placed at `base_from_part`; unchanged where
    /// the load turns with the feed.
    #[must_use]
    pub fn with_force(&self, force: Vector3<f64>, base_from_part: &Isometry) -> PathLoad {
        let mut changed = self.clone();
        let (wrenches, frame) = match &mut changed {
            PathLoad::Cases(load) => (&mut load.cases, load.frame),
            PathLoad::OfEach { frame, wrenches, .. } => (wrenches, *frame),
            PathLoad::Cuts(_) => return changed,
        };
        if let Some(axes) = frame.axes(base_from_part, None) {
            let by = axes.inverse() * force;
            wrenches.iter_mut().for_each(|wrench| wrench.force += by);
        }
        changed
    }

    /// Whether the load is given at each of this many points, and every cut refers to one of its tools.
    pub fn covers(&self, points: usize) -> bool {
        match self {
            PathLoad::Cases(_) => true,
            PathLoad::OfEach { cases, wrenches, .. } => points
                .checked_mul(*cases)
                .is_some_and(|all| wrenches.len() >= all),
            PathLoad::Cuts(cuts) => {
                let known = |here: &CutHere| here.cutter < cuts.cutters.len();
                cuts.points.len() >= points && !cuts.cutters.is_empty() && cuts.points.iter().all(known)
            }
        }
    }

    /// Writes the wrenches at point `index` in base axes; for cuts, the current forces of the point.
    ///
    /// # Panics
    /// If it [covers](PathLoad::covers) fewer points.
    pub fn in_base(
        &self,
        index: usize,
        base_from_part: &Isometry,
        base_from_feed: &Rotation3<f64>,
        out: &mut [Wrench],
    ) {
        let of_cut;
        let (given, frame) = match self {
            PathLoad::Cases(load) => (&load.cases[..], load.frame),
            PathLoad::OfEach {
                cases,
                frame,
                wrenches,
            } => (&wrenches[index * cases..][..*cases], *frame),
            PathLoad::Cuts(cuts) => {
                let here = &cuts.points[index];
                of_cut = [here.mean, here.greatest].map(Wrench::from_force);
                (&of_cut[..], LoadFrame::Feed)
            }
        };
        let axes = frame.axes(base_from_part, Some(base_from_feed));
        let axes = axes.unwrap_or(*base_from_feed);
        for (out, given) in out.iter_mut().zip(given) {
            *out = turned(given, &axes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::from_xyz_and_fixed_angles;
    use crate::load::{Engagement, LeanInCut, Mechanistic};

    fn wrench(k: f64) -> Wrench {
        Wrench {
            force: Vector3::new(k, -2.0, 0.5),
            moment: Vector3::new(0.1, k, 3.0),
        }
    }

    fn cuts(points: Vec<CutHere>) -> PathLoad {
        let law = Mechanistic::new(Vector3::new(8e8, 2e8, 2e8), Vector3::zeros()).unwrap();
        PathLoad::Cuts(CutsAlong {
            cutters: vec![Cutter::flat(0.01, 2).unwrap()],
            law: CuttingLaw::Mechanistic(law),
            greatest: GreatestForce::SecondCase,
            points,
        })
    }

    fn in_base(load: &PathLoad, index: usize, part: &Isometry, feed: &Rotation3<f64>) -> Vec<Wrench> {
        let mut out = vec![Wrench::from_force(Vector3::zeros()); load.case_count()];
        load.in_base(index, part, feed, &mut out);
        out
    }

    #[test]
    fn a_scaled_load_and_an_added_force_are_those_in_base() {
        let part = from_xyz_and_fixed_angles(Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.3, -0.8, 2.0));
        let feed = Rotation3::new(Vector3::new(-0.4, 1.1, 0.2));
        let by = Vector3::new(5.0, -1.0, 2.0);
        let of_cut = CutHere {
            mean: Vector3::new(10.0, 20.0, 30.0),
            greatest: Vector3::new(40.0, 0.0, 0.0),
            ..CutHere::NOTHING
        };
        let given = |frame| {
            PathLoad::Cases(LoadCases {
                frame,
                cases: vec![wrench(3.0)],
            })
        };
        let each = PathLoad::OfEach {
            cases: 1,
            frame: LoadFrame::Part,
            wrenches: vec![wrench(1.0)],
        };
        let turning = [given(LoadFrame::Feed), cuts(vec![of_cut])];
        let steady = [given(LoadFrame::Base), given(LoadFrame::Part), each];
        for load in turning.iter().chain(&steady) {
            let (as_is, scaled) = (
                in_base(load, 0, &part, &feed),
                in_base(&load.scaled(1.5), 0, &part, &feed),
            );
            for (as_is, scaled) in as_is.iter().zip(&scaled) {
                assert!((as_is.force * 1.5 - scaled.force).norm() < 1e-12);
                assert!((as_is.moment * 1.5 - scaled.moment).norm() < 1e-12);
            }
        }
        for load in &steady {
            let (as_is, pushed) = (
                in_base(load, 0, &part, &feed),
                in_base(&load.with_force(by, &part), 0, &part, &feed),
            );
            assert!((pushed[0].force - as_is[0].force - by).norm() < 1e-12);
        }
        for load in &turning {
            assert_eq!(load.with_force(by, &part), *load);
        }
        let PathLoad::Cuts(CutsAlong { law, .. }) = turning[1].scaled(1.5) else {
            unreachable!()
        };
        assert!((law.force(1e-4) - Vector3::new(8e4, 2e4, 2e4) * 1.5).norm() < 1e-6);
    }

    #[test]
    fn each_point_has_its_own_wrenches_rotated_by_the_axes_of_the_input() {
        let part = from_xyz_and_fixed_angles(Vector3::new(1.0, 2.0, 3.0), Vector3::new(0.3, -0.8, 2.0));
        let feed = Rotation3::new(Vector3::new(-0.4, 1.1, 0.2));
        let wrenches: Vec<Wrench> = (0..6).map(|k| wrench(f64::from(k))).collect();
        for (frame, axes) in [
            (LoadFrame::Base, Rotation3::identity()),
            (LoadFrame::Part, part.rotation.to_rotation_matrix()),
            (LoadFrame::Feed, feed),
        ] {
            let each = PathLoad::OfEach {
                cases: 2,
                frame,
                wrenches: wrenches.clone(),
            };
            let found = in_base(&each, 2, &part, &feed);
            assert_eq!(found[1].force, axes * wrench(5.0).force, "{frame:?}");
            // The position of the part has no effect: a wrench at the TCP is a free pair of vectors.
            assert_eq!(found[0].moment, axes * wrench(4.0).moment, "{frame:?}");
            let same = PathLoad::Cases(LoadCases {
                frame,
                cases: vec![wrench(4.0), wrench(5.0)],
            });
            assert_eq!(in_base(&same, 77, &part, &feed), found, "{frame:?}");
        }
    }

    #[test]
    fn forces_of_a_cut_turn_with_the_feed_whatever_the_part() {
        let here = CutHere {
            mean: Vector3::new(-100.0, 30.0, -9.0),
            greatest: Vector3::new(-180.0, 60.0, -20.0),
            ..CutHere::NOTHING
        };
        let feed = Rotation3::new(Vector3::new(-0.4, 1.1, 0.2));
        let load = cuts(vec![CutHere::NOTHING, here]);
        for part in [
            Isometry::identity(),
            from_xyz_and_fixed_angles(Vector3::x(), Vector3::y()),
        ] {
            let found = in_base(&load, 1, &part, &feed);
            assert_eq!(
                [found[0].force, found[1].force],
                [feed * here.mean, feed * here.greatest]
            );
            assert_eq!(found[0].moment, Vector3::zeros());
        }
    }

    #[test]
    fn the_greatest_force_scales_with_the_mean_and_equals_it_where_the_nominal_force_is_zero() {
        let here = CutHere {
            mean: Vector3::new(3.0, 4.0, 0.0),
            greatest: Vector3::new(0.0, 12.0, 5.0),
            ..CutHere::NOTHING
        };
        let mean = Vector3::new(0.0, 0.0, 10.0);
        assert_eq!(here.under(mean), [mean, here.greatest * 2.0]);
        // The nominal path passes next to the part, the deflected tool does not.
        let cut_in_air = CutHere {
            cut: Some(Cut {
                depth: 1e-3,
                engagement: Engagement::strip([4.9e-3, 5e-3], 0.01).unwrap(),
                feed: 1e-4,
                rise: 0.0,
                lean: LeanInCut::default(),
            }),
            ..CutHere::NOTHING
        };
        for met in [Vector3::zeros(), Vector3::new(-800.0, 90.0, 1.0)] {
            assert_eq!(cut_in_air.under(met), [met, met]);
        }
    }

    #[test]
    fn a_load_covers_the_points_for_which_it_is_given() {
        let each_of = |points: usize| PathLoad::OfEach {
            cases: 2,
            frame: LoadFrame::Base,
            wrenches: vec![wrench(0.0); 2 * points],
        };
        let each = each_of(3);
        assert!(each.covers(0) && each.covers(3) && !each.covers(4) && !each.covers(usize::MAX));
        let cut = cuts(vec![CutHere::NOTHING; 3]);
        assert!(cut.covers(3) && !cut.covers(4));
        let other_tool = CutHere {
            cutter: 1,
            ..CutHere::NOTHING
        };
        assert!(!cuts(vec![other_tool]).covers(1));
        // Points alone keep their wrenches.
        let mut numbered = each_of(4);
        if let PathLoad::OfEach { wrenches, .. } = &mut numbered {
            (0..8).for_each(|k| wrenches[k] = wrench(k as f64));
        }
        let some = numbered.at_points(&[1, 3]);
        assert!(some.covers(2) && !some.covers(3) && cut.at_points(&[0, 2]).covers(2));
        let identity = (Isometry::identity(), Rotation3::identity());
        for (index, of) in [1, 3].into_iter().enumerate() {
            let found = in_base(&some, index, &identity.0, &identity.1);
            assert_eq!(found, in_base(&numbered, of, &identity.0, &identity.1));
        }
        // Closed by their first point they cover one more.
        let [each, cut] = [each_of(3), cut].map(|load| load.closed());
        assert!(each.covers(4) && !each.covers(5) && cut.covers(4) && !cut.covers(5));
        let same = PathLoad::Cases(LoadCases {
            frame: LoadFrame::Feed,
            cases: vec![wrench(1.0)],
        });
        assert!(same.covers(usize::MAX));
    }
}

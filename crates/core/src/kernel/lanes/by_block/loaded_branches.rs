//! Every named branch of a block of poses, each pose under loads of its own: the whole model, for searches.
//!
//! `d = sqrt((a . delta)^2 + (b . delta)^2)`, the largest over the load cases, as in `kernel::column`.

use nalgebra::Vector3;

use crate::frame::Isometry;
use crate::kernel::answer::AT_LIMIT;
use crate::kernel::lanes::branches::{BranchPlanes, BranchSolver, find_missed, state};
use crate::kernel::lanes::whole::{FramePlanes, ResponsePlanes, TakeRoot, WholeModel, under};
use crate::kernel::question::Question;
use crate::numbers::{BLOCK, Backend, Float, Plane, Planes, Real, Vector, Work, planes, vector};
use crate::robot::inverse::OrthoParallel;
use crate::robot::{Branch, Robot};
use crate::spatial::Wrench;

/// Whether a branch can be used at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::kernel) enum BranchStatus {
    Usable,
    OutOfReach,
    OutsideLimits,
    Singular,
    /// Lanes cannot decide.
    Undecided,
}

/// Margins of postures to limits and singularities, rad.
#[derive(Clone, Copy, Debug)]
pub(in crate::kernel) struct BranchMargins {
    /// Smallest bend of the wrist.
    pub wrist: f64,
    /// Smallest distance of every joint from its limits, and of the elbow of an ortho-parallel arm from stretched and
    /// folded.
    pub limits: f64,
}

/// Loads and directions at each point of a block, base axes.
#[derive(Clone, Debug)]
pub(in crate::kernel) struct PointLoads {
    /// Force and moment of each load case, at the TCP.
    cases: Vec<Planes<f64, 6>>,
    /// The two directions of the selected component of the deviation.
    along: Planes<f64, 6>,
}

impl PointLoads {
    /// Memory for a block.
    pub fn new() -> PointLoads {
        PointLoads {
            cases: Vec::new(),
            along: planes(),
        }
    }

    /// Sets the load cases and directions of point `i`; every point of a block has as many cases.
    pub fn set(&mut self, i: usize, cases: impl ExactSizeIterator<Item = Wrench>, along: &[Vector3<f64>; 2]) {
        self.cases.resize_with(cases.len(), planes);
        for (planes, wrench) in self.cases.iter_mut().zip(cases) {
            let values = wrench.force.iter().chain(wrench.moment.iter());
            for (plane, value) in planes.iter_mut().zip(values) {
                plane[i] = *value;
            }
        }
        let values = along.iter().flat_map(|direction| direction.iter());
        for (plane, value) in self.along.iter_mut().zip(values) {
            plane[i] = *value;
        }
    }

    fn have_moments(&self) -> bool {
        self.cases
            .iter()
            .any(|case| case[3..].iter().flatten().any(|value| *value != 0.0))
    }
}

/// Solves a block of poses under loads; one per thread.
pub(in crate::kernel) struct LoadedBranches {
    backend: Backend,
    tool_from_flange: Isometry,
    branches: BranchSolver,
    model: WholeModel,
    margins: BranchMargins,
    /// Of an ortho-parallel arm that has to keep away from stretched and folded.
    elbow: Option<OrthoParallel>,
    moments: bool,
    missed: Plane<f64>,
    /// Sine of the angle between axes 4 and 6, and of the elbow's bend.
    sines: Planes<f64, 2>,
    found: BranchPlanes,
    deviation: Plane<f64>,
}

impl LoadedBranches {
    /// For this arm, with backlash and geometry only if `unloaded`; none if its branches have no names, or its model a
    /// part that lanes do not know.
    pub fn of(question: &Question<'_>, margins: BranchMargins, unloaded: bool) -> Option<LoadedBranches> {
        let backend = Backend::fastest();
        let robot: &Robot = question.arm.robot;
        let model = if unloaded {
            WholeModel::of(&question.arm, backend)?
        } else {
            WholeModel::by_load(&question.arm, backend)?
        };
        // The side of a backlash depends on the load case.
        if model.has_backlash() {
            return None;
        }
        Some(LoadedBranches {
            backend,
            tool_from_flange: question.arm.flange_from_tool.inverse(),
            branches: BranchSolver::of(question, backend)?,
            model,
            margins,
            elbow: robot.ortho_parallel().filter(|_| margins.limits > 0.0).cloned(),
            moments: false,
            missed: [0.0; BLOCK],
            sines: planes(),
            found: BranchPlanes::of(robot.joints().len()),
            deviation: [0.0; BLOCK],
        })
    }

    /// Moves the rail, if there is one: see [`BranchSolver::set_home`].
    pub fn set_home(&mut self, home: Option<&[f64]>) {
        self.branches.set_home(home);
    }

    /// Sets the tool poses, at most a block.
    pub fn aim_at(&mut self, poses: &[Isometry], loads: &PointLoads) {
        self.branches.aim_at(poses, &self.tool_from_flange);
        self.moments = loads.have_moments();
    }

    /// Solves one branch at every pose; read it with [`LoadedBranches::status`] and its neighbours.
    pub fn solve(&mut self, branch: Branch, loads: &PointLoads) {
        let LoadedBranches {
            backend,
            branches,
            model,
            elbow,
            missed,
            sines,
            found,
            deviation,
            ..
        } = self;
        found.clone_from(branches.solve(branch));
        if found.state.iter().all(|state| *state == state::UNREACHED) {
            return;
        }
        model.set_joints(&found.joints);
        if self.moments {
            model.respond::<true, false>();
        } else {
            model.respond::<false, false>();
        }
        backend.run(find_missed(branches.targets(), model.flange(), missed));
        let first = branches.first();
        let axis = |joint: usize| model.axis(first + joint);
        backend.run(FindSines {
            frames: &model.frames()[first..],
            axes: [axis(1), axis(3), axis(5)],
            elbow: elbow.as_ref(),
            sines,
        });
        if self.moments {
            find_largest::<true>(*backend, model, loads, deviation);
        } else {
            find_largest::<false>(*backend, model, loads, deviation);
        }
    }

    /// Whether the solved branch can be used at point `i`.
    pub fn status(&self, i: usize) -> BranchStatus {
        let BranchMargins { wrist, limits } = self.margins;
        let found = &self.found;
        let [wrist_sine, elbow_sine] = &self.sines;
        let flagged = found.singularity[i] >= 2.0;
        if found.state[i] == state::UNREACHED {
            BranchStatus::OutOfReach
        } else if found.state[i] == state::UNDECIDED || self.missed[i] != 0.0 || !self.model.is_stable(i) {
            BranchStatus::Undecided
        } else if found.margin[i] < limits - AT_LIMIT || !self.branches.rail_is_inside() {
            BranchStatus::OutsideLimits
        } else if flagged || wrist_sine[i] < wrist.max(limits).sin() || elbow_sine[i] < limits.sin() {
            BranchStatus::Singular
        } else {
            BranchStatus::Usable
        }
    }

    /// Selected component of the deviation at point `i` in the solved branch, m.
    pub fn deviation(&self, i: usize) -> f64 {
        self.deviation[i]
    }

    /// Joint positions of the solved branch at point `i`, rad.
    pub fn joints(&self, i: usize) -> impl Iterator<Item = f64> {
        self.found.joints.iter().map(move |plane| plane[i])
    }
}

/// Fills the sine of the angle between axes 4 and 6, and of that between upper arm and forearm; 1 without elbow.
struct FindSines<'a, T> {
    /// Those of the arm, from what carries it to the tool.
    frames: &'a [FramePlanes<T>],
    /// Axes of joints 2, 4 and 6 in their own frames.
    axes: [usize; 3],
    elbow: Option<&'a OrthoParallel>,
    sines: &'a mut Planes<T, 2>,
}

impl<T: Float> Work<T> for FindSines<'_, T> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let FindSines {
            frames,
            axes,
            elbow,
            sines,
        } = self;
        let (fourth, sixth) = (&frames[4].axes[axes[1]], &frames[6].axes[axes[2]]);
        let one = R::of(1.0);
        for i in 0..BLOCK {
            R::step();
            let across = vector::<R>(fourth, i).cross(vector::<R>(sixth, i));
            sines[0][i] = across.dot(across).sqrt().store();
            sines[1][i] = one.store();
        }
        let Some(elbow) = elbow else { return };
        let at = Vector::<R>::of(&elbow.flange_from_wrist.coords);
        let flange = &frames[frames.len() - 2];
        let second = &frames[2].axes[axes[0]];
        for i in 0..BLOCK {
            R::step();
            let x = vector::<R>(&flange.axes[0], i);
            let y = vector::<R>(&flange.axes[1], i);
            let z = vector::<R>(&flange.axes[2], i);
            let origin = vector::<R>(&flange.origin, i);
            let wrist = x.mul_add(at.x, y.mul_add(at.y, z.mul_add(at.z, origin)));
            let axis = vector::<R>(second, i);
            let (shoulder, elbow) = (
                vector::<R>(&frames[2].origin, i),
                vector::<R>(&frames[3].origin, i),
            );
            // Lengths across axis 2 are those of the cross products with it.
            let (upper, fore) = (axis.cross(elbow - shoulder), axis.cross(wrist - elbow));
            let across = upper.cross(fore);
            let lengths = upper.dot(upper) * fore.dot(fore);
            sines[1][i] = (across.dot(across) / lengths).sqrt().store();
        }
    }
}

/// Fills the largest selected component of the deviation over the load cases, m.
fn find_largest<const MOMENTS: bool>(
    backend: Backend,
    model: &mut WholeModel,
    loads: &PointLoads,
    deviation: &mut Plane<f64>,
) {
    deviation.fill(0.0);
    for wrench in &loads.cases {
        model.load::<MOMENTS>(wrench);
        let (response, rest) = model.response();
        backend.run(TakeLarger::<f64, MOMENTS> {
            response,
            rest,
            wrench,
            along: &loads.along,
            square: deviation,
        });
    }
    backend.run(TakeRoot { of: deviation });
}

/// Takes the square of the selected component under one load case where it is larger than that so far, m^2.
struct TakeLarger<'a, T, const MOMENTS: bool> {
    response: &'a ResponsePlanes<T>,
    rest: &'a Planes<T, 3>,
    wrench: &'a Planes<T, 6>,
    along: &'a Planes<T, 6>,
    square: &'a mut Plane<T>,
}

impl<T: Float, const MOMENTS: bool> Work<T> for TakeLarger<'_, T, MOMENTS> {
    #[inline(always)]
    fn run<R: Real<Float = T>>(self) {
        let TakeLarger {
            response,
            rest,
            wrench,
            along,
            square,
        } = self;
        for i in 0..BLOCK {
            R::step();
            let (force, moment) = (vector::<R>(&wrench[0..3], i), vector::<R>(&wrench[3..6], i));
            let delta = under::<R, MOMENTS>(response, rest, force, moment, i);
            let a = delta.dot(vector::<R>(&along[0..3], i));
            let b = delta.dot(vector::<R>(&along[3..6], i));
            let size = a.mul_add(a, b * b);
            square[i] = size.max(R::load(square[i])).store();
        }
    }
}

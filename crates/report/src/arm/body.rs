//! From a posture to solids: rounded links, cylinders for joints, a foot, a flange and a tool.
//!
//! Sizes follow from the length of the arm, not from a data sheet: this is a schematic. A joint that turns about its
//! own link is drawn as a collar on that link, since its origin may be anywhere along the axis.
//!
//! ```text
//!   joint (cylinder about its axis)
//!    ◯════link═══▯═══link═══◯          ▯ collar: a joint that turns about its own link
//!    ║                      ║
//!    ▯                      ▮ flange, tool, tip
//!  ▟███▙ foot
//! ```
//!
//! | size | as a share |
//! |---|---|
//! | radius of the links, falling from foot to flange | 0.046 to 0.022 of the arm's length |
//! | radius of a joint, of a collar | 1.25, 1.22 of the link's |
//! | half length of a joint, of a collar | 1.3, 0.42 of the link's radius |
//! | a link shorter than this is not drawn | 0.02 of the arm's length |
//!
//! The arm's length is the way from the base over all joint origins to the flange. All points are in the base
//! frame, mm.

use super::drawing::{ArmJoint, ArmPosture};
use super::view::{Vec3, along, between, dot, length, unit};

/// What a solid belongs to; decides its colour and when it is painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Foot,
    Link,
    Joint,
    Collar,
    Flange,
    Tool,
}

/// A solid of the arm.
#[derive(Clone, Debug)]
pub(crate) enum Solid {
    /// A link with round ends, which joints hide: two spheres and the body between them.
    Capsule {
        ends: [Vec3; 2],
        radii: [f64; 2],
        part: Part,
    },
    /// A cylinder about `axis`, a vector of length one; its ends are `half_length` to both sides of `centre`.
    Cylinder {
        centre: Vec3,
        axis: Vec3,
        radius: f64,
        half_length: f64,
        part: Part,
    },
}

/// Where a joint is drawn, for its label, which keeps `radius` away.
#[derive(Clone, Debug)]
pub(crate) struct JointSpot {
    pub(crate) name: String,
    pub(crate) at: Vec3,
    pub(crate) radius: f64,
}

/// The solids of one posture, in no order of depth, and a spot for each joint from the base on.
pub(crate) struct Body {
    pub(crate) solids: Vec<Solid>,
    pub(crate) joints: Vec<JointSpot>,
}

/// What is too short to be drawn, as a share of the arm's length.
const NEAR: f64 = 0.02;
/// Half the height of the foot as a share of the arm's length.
const FOOT: f64 = 0.022;
/// Half the length of a collar as a share of its link's radius.
const COLLAR: f64 = 0.42;
/// Where a collar is on the link above its joint, as a part of that link's first straight piece.
const COLLAR_ABOVE: f64 = 0.45;
/// Radius of the first and of the last link, schematic like all sizes here, as shares of the arm's length.
const THICK: f64 = 0.046;
const THIN: f64 = 0.022;

impl Body {
    /// Of a posture that has a joint; all numbers are finite.
    pub(crate) fn of(posture: &ArmPosture) -> Self {
        let skeleton = Skeleton::of(posture);
        let mut solids = vec![foot(posture, skeleton.size_mm)];
        solids.extend(skeleton.column());
        let mut joints = Vec::new();
        let mut collars = Vec::new();
        for (k, joint) in posture.joints.iter().enumerate() {
            let (solid, spot, collar) = skeleton.joint(k, joint);
            solids.push(solid);
            joints.push(spot);
            collars.extend(collar);
        }
        solids.extend(skeleton.links(&collars));
        solids.extend(skeleton.tool());
        Self { solids, joints }
    }

    /// With a tool that stands in the cell, from its mount to its tip, as thick as one of this posture.
    pub(crate) fn and_tool(mut self, posture: &ArmPosture, ends: [Vec3; 2]) -> Self {
        self.solids.extend(Skeleton::of(posture).tool_between(ends));
        self
    }
}

/// The lines of an arm, and how thick it is along them.
struct Skeleton<'a> {
    posture: &'a ArmPosture,
    /// Length of the arm, at least 1 mm, and what is too short to be drawn.
    size_mm: f64,
    near_mm: f64,
    /// The line of each link: straight, or with a corner where the next joint is off the axis.
    routes: Vec<Vec<Vec3>>,
    /// From the foot to the first joint.
    from_base: Vec3,
}

impl<'a> Skeleton<'a> {
    /// Of a posture that has a joint.
    fn of(posture: &'a ArmPosture) -> Self {
        let size_mm = arm_length(posture).max(1.0);
        let near_mm = NEAR * size_mm;
        let joints = &posture.joints;
        let after = joints
            .iter()
            .skip(1)
            .map(|j| j.origin_mm)
            .chain([posture.flange_mm]);
        let routes = joints
            .iter()
            .zip(after)
            .map(|(joint, next)| route(joint.origin_mm, unit(joint.axis), next, near_mm))
            .collect();
        let first = joints.first().map_or(posture.flange_mm, |j| j.origin_mm);
        Self {
            posture,
            size_mm,
            near_mm,
            routes,
            from_base: between(posture.base_mm, first),
        }
    }

    /// Radius of the arm after `k` links, which need not be whole.
    fn radius_mm(&self, k: f64) -> f64 {
        self.size_mm * (THICK + (THIN - THICK) * k / self.last())
    }

    /// How many links there are.
    fn last(&self) -> f64 {
        self.posture.joints.len().max(1) as f64
    }

    /// Whether the first joint is above the foot.
    fn is_on_foot(&self) -> bool {
        length(self.from_base) <= self.near_mm
    }

    /// The solid that carries a first joint that is off the foot; `None` where it is on the foot.
    fn column(&self) -> Option<Solid> {
        let axis = unit(self.from_base);
        let half_length = length(self.from_base) / 2.0;
        (!self.is_on_foot()).then(|| Solid::Cylinder {
            centre: along(self.posture.base_mm, axis, half_length),
            axis,
            radius: 1.1 * self.radius_mm(0.0),
            half_length,
            part: Part::Link,
        })
    }

    /// A joint: a cylinder about its axis, or a collar on the link that it turns.
    fn joint(&self, k: usize, joint: &ArmJoint) -> (Solid, JointSpot, Option<Collar>) {
        let axis = unit(joint.axis);
        let r = self.radius_mm(k as f64);
        let collar = collar_of(&self.routes, k, axis, COLLAR * r);
        let (centre, radius, half_length, part) = match &collar {
            Some(collar) => (collar.at, 1.22 * r, COLLAR * r, Part::Collar),
            None => (joint.origin_mm, 1.25 * r, 1.3 * r, Part::Joint),
        };
        let solid = Solid::Cylinder {
            centre,
            axis,
            radius,
            half_length,
            part,
        };
        let spot = JointSpot {
            name: joint.name.clone(),
            at: centre,
            radius: radius.max(half_length),
        };
        (solid, spot, collar)
    }

    /// The straight parts of all links, from the top of the foot on.
    fn links(&self, collars: &[Collar]) -> Vec<Solid> {
        let mut solids = Vec::new();
        for (k, line) in self.routes.iter().enumerate() {
            for (m, w) in line.windows(2).enumerate() {
                let share = |m: usize| k as f64 + m as f64 / (line.len() - 1) as f64;
                let radii = [self.radius_mm(share(m)), self.radius_mm(share(m + 1))];
                let start = if k == 0 && m == 0 && self.is_on_foot() {
                    along(w[0], unit(between(w[0], w[1])), 2.0 * FOOT * self.size_mm)
                } else {
                    w[0]
                };
                let here: Vec<&Collar> = collars.iter().filter(|c| c.link == [k, m]).collect();
                solids.extend(link([start, w[1]], radii, &here));
            }
        }
        solids
    }

    /// Flange, tool and its tip, from the flange to the tool centre point; nothing where they are one.
    fn tool(&self) -> Vec<Solid> {
        self.tool_between([self.posture.flange_mm, self.posture.tool_mm])
    }

    /// A tool between its mount and its tip.
    fn tool_between(&self, [mount, tip]: [Vec3; 2]) -> Vec<Solid> {
        let reach = between(mount, tip);
        let total = length(reach);
        if total <= self.near_mm * 0.1 {
            return Vec::new();
        }
        let axis = unit(reach);
        let r = self.radius_mm(self.last());
        let cylinder = |[from, to]: [f64; 2], radius: f64, part: Part| Solid::Cylinder {
            centre: along(mount, axis, (from + to) / 2.0),
            axis,
            radius,
            half_length: (to - from) / 2.0,
            part,
        };
        let (flange, tip) = ((0.3 * r).min(total * 0.2), total * 0.72);
        vec![
            cylinder([0.0, flange], 1.1 * r, Part::Flange),
            cylinder([flange, tip], 0.72 * r, Part::Tool),
            cylinder([tip, total], 0.24 * r, Part::Tool),
        ]
    }
}

/// The place of a joint that turns about its link: the link is cut open there.
struct Collar {
    /// Which link, and which straight part of it.
    link: [usize; 2],
    at: Vec3,
    half_length: f64,
}

/// The collar of joint `k`, if its axis is along the link before it or after it, within 25 degrees; the
/// better fit of the two. It is half-way along the link before, or at 0.45 of the link after.
fn collar_of(routes: &[Vec<Vec3>], k: usize, axis: Vec3, half_length: f64) -> Option<Collar> {
    let before = (0..k)
        .rev()
        .find(|r| routes[*r].len() > 1)
        .map(|r| [r, routes[r].len() - 2]);
    let after = (k..routes.len()).find(|r| routes[*r].len() > 1).map(|r| [r, 0]);
    let ends = |[r, m]: [usize; 2]| [routes[r][m], routes[r][m + 1]];
    let fit = |link: Option<[usize; 2]>| {
        link.map_or(0.0, |l| dot(unit(between(ends(l)[0], ends(l)[1])), axis).abs())
    };
    let (link, share) = if fit(before) >= fit(after) - 1e-6 {
        (before?, 0.5)
    } else {
        (after?, COLLAR_ABOVE)
    };
    // Within 25 degrees of the link.
    (fit(Some(link)) > 0.9).then(|| {
        let [from, to] = ends(link);
        Collar {
            link,
            at: along(from, between(from, to), share),
            half_length,
        }
    })
}

/// A straight part of a link: a capsule with round ends, which joints hide; where collars are on it,
/// cylinders with flat ends between them.
fn link(ends: [Vec3; 2], radii: [f64; 2], collars: &[&Collar]) -> Vec<Solid> {
    if collars.is_empty() {
        return vec![Solid::Capsule {
            ends,
            radii,
            part: Part::Link,
        }];
    }
    let axis = unit(between(ends[0], ends[1]));
    let total = length(between(ends[0], ends[1]));
    let mut gaps: Vec<[f64; 2]> = collars
        .iter()
        .map(|c| {
            let middle = dot(between(ends[0], c.at), axis);
            [middle - c.half_length, middle + c.half_length]
        })
        .collect();
    gaps.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let starts = std::iter::once(0.0).chain(gaps.iter().map(|g| g[1]));
    let stops = gaps.iter().map(|g| g[0]).chain([total]);
    let pieces = starts
        .zip(stops)
        .filter(|(from, to)| to > from)
        .map(|(from, to)| Solid::Cylinder {
            centre: along(ends[0], axis, (from + to) / 2.0),
            axis,
            radius: (radii[0] + radii[1]) / 2.0,
            half_length: (to - from) / 2.0,
            part: Part::Link,
        });
    pieces.collect()
}

/// The way from base over all joints to the flange.
pub(crate) fn arm_length(posture: &ArmPosture) -> f64 {
    let mut total = 0.0;
    let mut at = posture.base_mm;
    for next in posture
        .joints
        .iter()
        .map(|j| j.origin_mm)
        .chain([posture.flange_mm])
    {
        total += length(between(at, next));
        at = next;
    }
    total
}

/// A flat disc on the floor, about the axis of the first joint.
fn foot(posture: &ArmPosture, size: f64) -> Solid {
    let half_length = FOOT * size;
    let axis = posture.joints.first().map_or([0.0, 0.0, 1.0], |j| unit(j.axis));
    Solid::Cylinder {
        centre: along(posture.base_mm, axis, half_length),
        axis,
        radius: 0.085 * size,
        half_length,
        part: Part::Foot,
    }
}

/// The line of a link from one joint to the next: along the joint's axis to the foot of the perpendicular and
/// from there across, or straight where one of the two is too short; a single point where both joints are at
/// one place.
fn route(from: Vec3, axis: Vec3, to: Vec3, near: f64) -> Vec<Vec3> {
    let way = between(from, to);
    if length(way) <= near {
        return vec![from];
    }
    let foot = along(from, axis, dot(axis, way));
    if length(between(from, foot)) > near && length(between(foot, to)) > near {
        vec![from, foot, to]
    } else {
        vec![from, to]
    }
}

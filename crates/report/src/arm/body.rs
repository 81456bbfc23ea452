//! From a posture to solids: rounded links, cylinders for joints, a foot, a flange and a tool.
//!
//! Sizes follow from the length of the arm, not from a data sheet: this is a schematic. A joint that turns about its own link is drawn
//! as a collar on that link, since its origin may stand anywhere along the axis.

use super::ArmPosture;
use super::view::{Vec3, along, between, dot, length, unit};

/// What a solid belongs to; decides its colour.
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
    /// A link with round ends.
    Capsule {
        ends: [Vec3; 2],
        radii: [f64; 2],
        part: Part,
    },
    /// A cylinder about `axis`.
    Cylinder {
        centre: Vec3,
        axis: Vec3,
        radius: f64,
        half_length: f64,
        part: Part,
    },
}

/// Where a joint is drawn, for its label.
#[derive(Clone, Debug)]
pub(crate) struct JointSpot {
    pub(crate) name: String,
    pub(crate) at: Vec3,
    pub(crate) radius: f64,
}

/// The solids of one posture.
pub(crate) struct Body {
    pub(crate) solids: Vec<Solid>,
    pub(crate) joints: Vec<JointSpot>,
}

/// Half the height of the foot as a share of the arm's length.
const FOOT: f64 = 0.022;
/// Half the length of a collar as a share of its link's radius.
const COLLAR: f64 = 0.42;
/// Where a collar stands on the link above its joint.
const COLLAR_ABOVE: f64 = 0.45;
/// Radius of the first and of the last link as shares of the arm's length.
const THICK: f64 = 0.046;
const THIN: f64 = 0.022;

impl Body {
    pub(crate) fn of(posture: &ArmPosture) -> Self {
        let size = arm_length(posture).max(1.0);
        let nodes: Vec<Vec3> = posture
            .joints
            .iter()
            .map(|j| j.origin_mm)
            .chain([posture.flange_mm])
            .collect();
        let near = 0.02 * size;
        let last = (nodes.len() - 1).max(1) as f64;
        let radius = |k: f64| size * (THICK + (THIN - THICK) * k / last);
        let mut solids = vec![foot(posture, size)];
        let mut joints = Vec::new();
        // The line of each link: straight, or round the corner where the next joint stands off the axis.
        let routes: Vec<Vec<Vec3>> = (0..nodes.len() - 1)
            .map(|k| route(nodes[k], unit(posture.joints[k].axis), nodes[k + 1], near))
            .collect();
        let from_base = between(posture.base_mm, nodes[0]);
        if length(from_base) > near {
            let axis = unit(from_base);
            let half_length = length(from_base) / 2.0;
            let centre = along(posture.base_mm, axis, half_length);
            solids.push(Solid::Cylinder {
                centre,
                axis,
                radius: 1.1 * radius(0.0),
                half_length,
                part: Part::Link,
            });
        }
        let mut collars = Vec::new();
        for (k, joint) in posture.joints.iter().enumerate() {
            let axis = unit(joint.axis);
            let r = radius(k as f64);
            let collar = collar_of(&routes, k, axis, COLLAR * r);
            let (centre, drawn_radius, half_length, part) = match &collar {
                Some(collar) => (collar.at, 1.22 * r, COLLAR * r, Part::Collar),
                None => (joint.origin_mm, 1.25 * r, 1.3 * r, Part::Joint),
            };
            solids.push(Solid::Cylinder {
                centre,
                axis,
                radius: drawn_radius,
                half_length,
                part,
            });
            joints.push(JointSpot {
                name: joint.name.clone(),
                at: centre,
                radius: drawn_radius.max(half_length),
            });
            collars.extend(collar);
        }
        for (k, line) in routes.iter().enumerate() {
            for (m, w) in line.windows(2).enumerate() {
                let share = |m: usize| k as f64 + m as f64 / (line.len() - 1) as f64;
                let radii = [radius(share(m)), radius(share(m + 1))];
                let on_foot = k == 0 && m == 0 && length(from_base) <= near;
                let start = if on_foot {
                    along(w[0], unit(between(w[0], w[1])), 2.0 * FOOT * size)
                } else {
                    w[0]
                };
                let here: Vec<&Collar> = collars.iter().filter(|c| c.link == [k, m]).collect();
                solids.extend(link([start, w[1]], radii, &here));
            }
        }
        let reach = between(posture.flange_mm, posture.tool_mm);
        if length(reach) > near * 0.1 {
            let axis = unit(reach);
            let r = radius(last);
            let cylinder = |from: f64, to: f64, radius: f64, part: Part| Solid::Cylinder {
                centre: along(posture.flange_mm, axis, (from + to) / 2.0),
                axis,
                radius,
                half_length: (to - from) / 2.0,
                part,
            };
            let total = length(reach);
            solids.push(cylinder(0.0, (0.3 * r).min(total * 0.2), 1.1 * r, Part::Flange));
            solids.push(cylinder(
                (0.3 * r).min(total * 0.2),
                total * 0.72,
                0.72 * r,
                Part::Tool,
            ));
            solids.push(cylinder(total * 0.72, total, 0.24 * r, Part::Tool));
        }
        Self { solids, joints }
    }
}

/// The place of a joint that turns about its link.
struct Collar {
    /// Which link, and which straight part of it.
    link: [usize; 2],
    at: Vec3,
    half_length: f64,
}

/// The collar of joint `k`, if its axis lies along the link before it or after it; the better fit of the two.
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

/// A straight part of a link: round ends where joints hide them, flat where it meets a collar.
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

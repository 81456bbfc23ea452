//! Denavit-Hartenberg parameters of any chain of joint axes.
//!
//! The pose of the flange is a product of screws along z and x:
//!
//! ```text
//! Z_0 X_0  Z_1(q_1) X_1  ...  Z_n(q_n) X_n  Z_(n+1)        Z = Rz(theta) Tz(d)    X = Tx(a) Rx(alpha) [Ry(beta)]
//! ```
//!
//! `Z_i` is along the axis of joint i, the common normal of two axes is the x axis between them. Row i of the standard convention is `Z_i X_i`, of the
//! modified one `X_(i-1) Z_i`; base and flange are rows without joint, merged into their neighbours where the axes are the same.
//!
//! Axes that are parallel within [`PARALLEL`] have the normal through the origin before. Nearly parallel axes have a normal that is far away: `d` grows as
//! the inverse of their angle. Hayati's convention has none: the frame is where the next axis meets the xy plane, and `beta` turns it about y.
//!
//! Source: Denavit & Hartenberg 1955; Hayati & Mirmirani 1985, "Improving the absolute positioning accuracy of robot manipulators".

use std::f64::consts::{PI, TAU};

use armill_core::frame::Isometry;
use armill_core::nalgebra::{UnitQuaternion, Vector3};
use armill_core::robot::chain::LONGEST;

/// Axes within this angle (rad) are taken as parallel: at 10 m the error is 1e-10 m.
pub(super) const PARALLEL: f64 = 1e-11;
/// Axes within this angle (rad) get a `beta` in Hayati's convention.
pub(super) const NEARLY_PARALLEL: f64 = 0.05;

/// `Rz(theta) Tz(d)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct AlongZ {
    /// rad
    pub theta: f64,
    /// m
    pub d: f64,
}

/// `Tx(a) Rx(alpha) Ry(beta)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct AlongX {
    /// m
    pub a: f64,
    /// rad
    pub alpha: f64,
    /// rad; 0 but for nearly parallel axes in Hayati's convention.
    pub beta: f64,
}

/// The screws of a chain: one along z for the base, each joint and the flange, and one along x between two of them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Screws {
    /// Base, joints, flange.
    pub z: Vec<AlongZ>,
    /// Behind base, joints.
    pub x: Vec<AlongX>,
}

/// Axes between which there is no usable normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Far {
    /// Index of the axis behind it: 0 for the first joint, their number for the flange.
    pub axis: usize,
    /// Angle between the axes, rad.
    pub angle: f64,
    /// Where the normal is on the axis before, m.
    pub distance: f64,
}

impl AlongZ {
    fn displacement(self) -> Isometry {
        let turn = UnitQuaternion::new(Vector3::z() * self.theta);
        Isometry::from_parts(Vector3::new(0.0, 0.0, self.d).into(), turn)
    }

    /// Both one after the other.
    fn joined(self, other: AlongZ) -> AlongZ {
        AlongZ {
            theta: within_half_turn(self.theta + other.theta),
            d: self.d + other.d,
        }
    }
}

impl AlongX {
    fn displacement(self) -> Isometry {
        let turn =
            UnitQuaternion::new(Vector3::x() * self.alpha) * UnitQuaternion::new(Vector3::y() * self.beta);
        Isometry::from_parts(Vector3::new(self.a, 0.0, 0.0).into(), turn)
    }
}

/// An angle from -pi to pi.
fn within_half_turn(angle: f64) -> f64 {
    let turned = angle - TAU * (angle / TAU).round();
    // Half a turn is positive.
    if turned <= -PI { turned + TAU } else { turned }
}

/// The screws from the base through these joint frames (z along the axis of the joint, at zero) to the flange; `hayati`: with `beta` for nearly parallel axes.
///
/// # Errors
/// The first normal that is more than [`LONGEST`] away.
pub(super) fn screws(joints: &[Isometry], base_from_flange: &Isometry, hayati: bool) -> Result<Screws, Far> {
    let mut here = Isometry::identity();
    let mut found = Screws {
        z: Vec::new(),
        x: Vec::new(),
    };
    for (axis, next) in joints.iter().chain([base_from_flange]).enumerate() {
        let point = here
            .inverse_transform_point(&next.translation.vector.into())
            .coords;
        let direction = here.rotation.inverse() * (next.rotation * Vector3::z());
        let far = |distance| Far {
            axis,
            angle: direction.xy().norm().atan2(direction.z.abs()),
            distance,
        };
        let (z, x) = to_line(&point, &direction, hayati);
        if !(z.d.abs() <= LONGEST && x.a.abs() <= LONGEST) {
            return Err(far(z.d));
        }
        found.z.push(z);
        found.x.push(x);
        here = here * z.displacement() * x.displacement();
    }
    let rest = here.inverse() * base_from_flange;
    let turn = rest.rotation;
    found.z.push(AlongZ {
        theta: within_half_turn(2.0 * turn.k.atan2(turn.w)),
        d: rest.translation.vector.z,
    });
    // The base is on the axis of the first joint, and the flange on that of the last one, of most arms.
    if found.x.first() == Some(&AlongX::default()) && !joints.is_empty() {
        found.x.remove(0);
        let base = found.z.remove(0);
        if let Some(first) = found.z.first_mut() {
            *first = base.joined(*first);
        }
        found.x.insert(0, AlongX::default());
        found.z.insert(0, AlongZ::default());
    }
    if found.x.last() == Some(&AlongX::default()) {
        let flange = found.z.pop().unwrap_or_default();
        if let Some(last) = found.z.last_mut() {
            *last = last.joined(flange);
        }
        found.z.push(AlongZ::default());
    }
    Ok(found)
}

/// From the frame here to one whose z axis is the line through `point` along `direction` (unit vector).
fn to_line(point: &Vector3<f64>, direction: &Vector3<f64>, hayati: bool) -> (AlongZ, AlongX) {
    let sine = direction.xy().norm();
    if sine < PARALLEL {
        // The normal through the origin here.
        let a = point.xy().norm();
        let (a, theta) = match a < PARALLEL {
            true => (0.0, 0.0),
            false => (a, point.y.atan2(point.x)),
        };
        let alpha = if direction.z < 0.0 { PI } else { 0.0 };
        return (AlongZ { theta, d: 0.0 }, AlongX { a, alpha, beta: 0.0 });
    }
    if hayati && sine < NEARLY_PARALLEL {
        let met = point - direction * (point.z / direction.z);
        let a = met.xy().norm();
        let (a, theta) = match a < PARALLEL {
            true => (0.0, 0.0),
            false => (a, met.y.atan2(met.x)),
        };
        let turned = UnitQuaternion::new(Vector3::z() * -theta) * direction;
        let x = AlongX {
            a,
            alpha: (-turned.y).atan2(turned.z),
            beta: turned.x.atan2(turned.y.hypot(turned.z)),
        };
        return (AlongZ { theta, d: 0.0 }, x);
    }
    // x along the common normal, z x direction, of the sign that makes a positive, or theta small where the axes meet.
    let normal = Vector3::new(-direction.y, direction.x, 0.0) / sine;
    let a = normal.dot(point);
    let turned = match a.abs() > PARALLEL {
        true => a < 0.0,
        false => normal.x < -1e-9 || (normal.x <= 1e-9 && normal.y < 0.0),
    };
    let x = if turned { -normal } else { normal };
    // All from the same x: its rounding, large for small angles, then cancels.
    let y = Vector3::new(-x.y, x.x, 0.0);
    let across = direction.cross(&x);
    let d = point.dot(&across) / across.z;
    let a = x.dot(point);
    let alpha = (-direction.dot(&y)).atan2(direction.z);
    let theta = x.y.atan2(x.x);
    (AlongZ { theta, d }, AlongX { a, alpha, beta: 0.0 })
}

#[cfg(test)]
mod tests;

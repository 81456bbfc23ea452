//! Receptance at the tip: machine, joints and segments coupled one after the other.
//!
//! ```text
//! [u_2; f_2] = [ Tuu Tuf; Tfu Tff ] [u_1; f_1],   u_1 = (R + C) f_1
//! G = (Tuu (R + C) + Tuf)(Tfu (R + C) + Tff)^-1        free end: G = Tuu Tfu^-1
//! G = H_22 - H_21 (H_11 + R + C)^-1 H_12        the same, as receptance coupling is usually written
//! body: R' = (1 - w^2 R M)^-1 R
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R`, `C` | receptance of the machine where the segment begins; compliance of the joint | m/N, ... |
//! | `T` | transfer over a piece of the segment ([`super::transfer`]) | -, m/N, N/m, ... |
//! | `H` | free-free receptance of the segment: 1 is the end at the machine | m/N, ... |
//! | `G` | receptance where the piece ends: `R` of the next one | m/N, ... |
//! | `M` | mass matrix of a rigid body about the reference point | kg, kg m, kg m^2 |
//!
//! The first form needs no free-free receptance, which is infinite at rest, and permits `R = 0` (a rigid machine). Source: Schmitz & Smith, Machining
//! dynamics, chapter on receptance coupling; Bishop & Johnson, The mechanics of vibration (both recalled).

use nalgebra::{Complex, Matrix3, Matrix6, Vector3};
use thiserror::Error;

use super::segment::Segment;
use super::transfer::Transfer;

/// To what the first segment is attached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base<'m> {
    /// A rigid machine.
    Rigid,
    /// Nothing.
    Free,
    /// A machine of this receptance where the first segment begins, axes of the segments.
    Receptance(&'m Matrix6<Complex<f64>>),
}

/// A rigid body, such as the body of a spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Its centre relative to the reference point, m.
    pub centre: Vector3<f64>,
    /// Inertia about its centre, kg m^2.
    pub inertia: Matrix3<f64>,
}

/// There is no receptance: an undamped resonance at this frequency, or numbers beyond those of a computer.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the receptance at {0} rad/s is not finite")]
pub struct NotFinite(pub f64);

/// Receptance at the end of the last segment at the angular frequency `w` (rad/s): 6x6, axes of the segments.
///
/// # Errors
/// An undamped resonance at exactly this frequency; free segments at rest.
pub fn tip_receptance(
    base: &Base<'_>,
    segments: &[Segment],
    w: f64,
) -> Result<Matrix6<Complex<f64>>, NotFinite> {
    let mut receptance = match base {
        Base::Rigid => Some(Matrix6::zeros()),
        Base::Free => None,
        Base::Receptance(own) => Some(**own),
    };
    for segment in segments {
        let next = coupled(receptance.as_ref(), segment, w).ok_or(NotFinite(w))?;
        receptance = Some(next);
    }
    receptance.ok_or(NotFinite(w))
}

/// Receptance where the segment ends; `None` in place of the machine is a free end.
fn coupled(
    machine: Option<&Matrix6<Complex<f64>>>,
    segment: &Segment,
    w: f64,
) -> Option<Matrix6<Complex<f64>>> {
    let (piece, count) = Transfer::of_piece(segment, w)?;
    let joint = segment
        .joint
        .map_or_else(Matrix6::zeros, |joint| joint.compliance(w));
    let mut attached = machine.map(|machine| machine + joint);
    for _ in 0..count {
        let next = match attached {
            None => piece.uu * piece.fu.try_inverse()?,
            Some(own) => (piece.uu * own + piece.uf) * (piece.fu * own + piece.ff).try_inverse()?,
        };
        let is_finite = next.iter().all(|z| z.re.is_finite() && z.im.is_finite());
        attached = Some(is_finite.then_some(next)?);
    }
    attached
}

impl Body {
    /// `M` about the reference point.
    pub fn mass_matrix(&self) -> Matrix6<f64> {
        let d = self.centre;
        let moment = d.cross_matrix() * self.mass;
        let inertia = self.inertia + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * self.mass;
        let mut all = Matrix6::zeros();
        for k in 0..3 {
            all[(k, k)] = self.mass;
        }
        all.fixed_view_mut::<3, 3>(0, 3).copy_from(&-moment);
        all.fixed_view_mut::<3, 3>(3, 0).copy_from(&moment);
        all.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
        all
    }

    /// The receptance of a machine that carries this body too; the reference point is that of the receptance.
    ///
    /// # Errors
    /// An undamped resonance at exactly this frequency.
    pub fn added_to(
        &self,
        machine: &Matrix6<Complex<f64>>,
        w: f64,
    ) -> Result<Matrix6<Complex<f64>>, NotFinite> {
        let inertia = self.mass_matrix().map(|part| Complex::new(-w * w * part, 0.0));
        let inverse = (Matrix6::identity() + machine * inertia).try_inverse();
        inverse.map(|inverse| inverse * machine).ok_or(NotFinite(w))
    }
}

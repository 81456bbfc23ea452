//! What an FRF is of, and its receptance.
//!
//! ```text
//! H = X/F = (iw)^-p Y/F        p: 0 displacement, 1 velocity, 2 acceleration
//! g = w^p                      without coherence
//! g = 1 / ( |H| sqrt((1 - C)/C) )
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `H`, `Y/F` | receptance, what was measured | m/N; m/N, m/(s N), m/(s^2 N) |
//! | `w` | angular frequency | rad/s |
//! | `C` | coherence | - |
//! | `g` | weight: inverse standard deviation up to a factor | - |
//!
//! Without coherence the noise of what was measured is taken as equal at all frequencies. Source: Bendat & Piersol on the random error of an FRF
//! (recalled).

use armill_core::dynamics::modal_fit::Frf;
use armill_core::nalgebra::Complex;

use super::measured::SignedDof;

/// Range of a coherence that is used: 1 would be an infinite weight.
const COHERENCE: [f64; 2] = [1e-4, 0.9999];

/// Quantity that a force causes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Displacement: receptance.
    Displacement,
    /// Velocity: mobility.
    Velocity,
    /// Acceleration: accelerance.
    Acceleration,
}

impl Quantity {
    /// Number of derivatives of the displacement by time.
    fn derivatives(self) -> i32 {
        match self {
            Quantity::Displacement => 0,
            Quantity::Velocity => 1,
            Quantity::Acceleration => 2,
        }
    }
}

/// An FRF as measured, SI.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    pub quantity: Quantity,
    pub response: SignedDof,
    pub reference: SignedDof,
    /// Frequencies, rising, rad/s.
    pub angular_frequencies: Vec<f64>,
    /// Per force.
    pub values: Vec<Complex<f64>>,
    /// Coherence at each, or none.
    pub coherence: Option<Vec<f64>>,
}

impl Samples {
    /// As receptance, and the coherence at each of its frequencies, none if it is not known; the frequency 0 is left out.
    pub fn receptance(&self) -> (Frf, Vec<f64>) {
        let derivatives = self.quantity.derivatives();
        let sign = self.response.sign * self.reference.sign;
        let mut frf = Frf {
            response: self.response.dof,
            reference: self.reference.dof,
            angular_frequencies: Vec::new(),
            receptance: Vec::new(),
            weights: Vec::new(),
        };
        let mut coherences = Vec::new();
        for (index, (w, value)) in self.angular_frequencies.iter().zip(&self.values).enumerate() {
            if *w <= 0.0 {
                continue;
            }
            let receptance = value * sign * Complex::new(0.0, *w).powi(-derivatives);
            let weight = match &self.coherence {
                None => w.powi(derivatives),
                Some(coherence) => {
                    let own = coherence[index].clamp(COHERENCE[0], COHERENCE[1]);
                    1.0 / (receptance.norm() * ((1.0 - own) / own).sqrt())
                }
            };
            // A value of zero has no random error that the coherence gives.
            if weight.is_finite() && weight > 0.0 && receptance.re.is_finite() && receptance.im.is_finite() {
                frf.angular_frequencies.push(*w);
                frf.receptance.push(receptance);
                frf.weights.push(weight);
                coherences.extend(self.coherence.as_ref().map(|coherence| coherence[index]));
            }
        }
        (frf, coherences)
    }
}

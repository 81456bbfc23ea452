//! End mills: flat, ball and bull nose; the edge from the tip upwards.
//!
//! The edges wind round a cylinder of radius `R` that ends in a corner of radius `r`: none of a flat end mill, `R` of
//! a ball. At the height `z` above the tip
//!
//! ```text
//! cos kappa = 1 - z/r,   R(z) = R - r + r sin kappa     in the corner, z < r
//! kappa = 90 deg,        R(z) = R                       above it
//! psi(z) = z tan(beta) / R                              lag behind the tip, one lead for all of the edge
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `R`, `r` | radius of the cylinder and of its corner | m |
//! | `kappa` | axial immersion angle: from the tool axis to the normal of the body | rad |
//! | `beta` | helix angle on the cylinder | rad |
//! | `psi` | angle by which a point of the edge trails the tip | rad |
//! | `rho`, `lambda` | runout: offset of the tool axis from the spindle axis, and its direction | m, rad |
//!
//! The spindle turns clockwise, seen from the spindle. Flutes are evenly spaced. Not modelled: edges on the bottom of
//! a flat or bull nose end mill, tapers, uneven pitch.
//!
//! Source: the usual geometry of mechanistic models; `docs/theory/cutting.md`.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::end_mill_body::EndMillBody;
use super::error::{CuttingError, checked};

/// Helix direction of the flutes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Hand {
    /// Upper points trail the tip, chips are lifted, the tool is pulled towards the part. The common end mill.
    #[default]
    Right,
    /// Upper points lead, chips are pressed down, the tool is pushed towards the spindle.
    Left,
}

impl Hand {
    /// 1 for a right-hand helix, -1 for a left-hand one.
    pub fn sign(self) -> f64 {
        match self {
            Hand::Right => 1.0,
            Hand::Left => -1.0,
        }
    }
}

/// Runout: the offset of the tool axis from the spindle axis.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Runout {
    /// Distance of the two axes, m.
    pub offset: f64,
    /// From tooth 0 at the tip to the direction of the offset, against the turn of the spindle, rad.
    pub angle: f64,
}

/// An end mill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutter {
    body: EndMillBody,
    flutes: u32,
    helix: f64,
    hand: Hand,
    runout: Runout,
    rake: f64,
}

/// A point of an edge, as needed for its forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePoint {
    /// Above the tip, m.
    pub height: f64,
    /// From the tool axis, m.
    pub radius: f64,
    /// Sine of the axial immersion angle: the part of the normal across the tool axis.
    pub sin_kappa: f64,
    /// Its cosine: the part along the tool axis.
    pub cos_kappa: f64,
}

/// Most teeth: it bounds the sums over them.
const MOST_FLUTES: u32 = 100;
/// Steepest helix, rad: beyond 80 deg an edge is nearly a ring.
const MOST_HELIX: f64 = 80.0 * std::f64::consts::PI / 180.0;
/// Greatest rake either way, rad: 45 deg is more than inserts and end mills have.
const MOST_RAKE: f64 = std::f64::consts::FRAC_PI_4;

impl Cutter {
    /// An end mill with a sharp corner; straight flutes, no runout, no rake. m.
    ///
    /// # Errors
    /// Diameter or number of flutes out of range.
    pub fn flat(diameter: f64, flutes: u32) -> Result<Cutter, CuttingError> {
        Cutter::bull_nose(diameter, 0.0, flutes)
    }

    /// An end mill that ends in half a ball; straight flutes, no runout, no rake. m.
    ///
    /// # Errors
    /// As [`Cutter::flat`].
    pub fn ball(diameter: f64, flutes: u32) -> Result<Cutter, CuttingError> {
        Cutter::bull_nose(diameter, diameter / 2.0, flutes)
    }

    /// An end mill with a rounded corner; straight flutes, no runout, no rake. m.
    ///
    /// # Errors
    /// As [`Cutter::flat`]; a corner radius beyond half the diameter.
    pub fn bull_nose(diameter: f64, corner_radius: f64, flutes: u32) -> Result<Cutter, CuttingError> {
        let body = EndMillBody::new(diameter, corner_radius)?;
        checked(
            "number of flutes",
            f64::from(flutes),
            [1.0, f64::from(MOST_FLUTES)],
            "",
        )?;
        Ok(Cutter {
            body,
            flutes,
            helix: 0.0,
            hand: Hand::Right,
            runout: Runout::default(),
            rake: 0.0,
        })
    }

    /// The same tool with another `diameter` and `corner_radius` (m).
    ///
    /// # Errors
    /// As [`Cutter::bull_nose`].
    pub fn of_size(&self, diameter: f64, corner_radius: f64) -> Result<Cutter, CuttingError> {
        let body = EndMillBody::new(diameter, corner_radius)?;
        Ok(Cutter { body, ..*self })
    }

    /// The same with flutes that wind by `helix` (rad, not negative).
    ///
    /// # Errors
    /// A helix beyond 80 deg.
    pub fn with_helix(mut self, helix: f64, hand: Hand) -> Result<Cutter, CuttingError> {
        self.helix = checked("helix angle", helix, [0.0, MOST_HELIX], "rad")?;
        self.hand = hand;
        Ok(self)
    }

    /// The same, clamped with this offset from the spindle axis.
    ///
    /// # Errors
    /// An offset that is negative or beyond half the diameter; numbers that are not finite.
    pub fn with_runout(mut self, runout: Runout) -> Result<Cutter, CuttingError> {
        checked("runout", runout.offset, [0.0, self.radius()], "m")?;
        checked("angle of the runout", runout.angle, [-TAU, TAU], "rad")?;
        self.runout = runout;
        Ok(self)
    }

    /// The same with this rake angle (rad); used by Kienzle's law only.
    ///
    /// # Errors
    /// A rake beyond 45 deg either way.
    pub fn with_rake(mut self, rake: f64) -> Result<Cutter, CuttingError> {
        self.rake = checked("rake", rake, [-MOST_RAKE, MOST_RAKE], "rad")?;
        Ok(self)
    }

    /// The body that it fills as it turns.
    pub fn body(&self) -> &EndMillBody {
        &self.body
    }

    /// m
    pub fn diameter(&self) -> f64 {
        self.body.diameter()
    }

    /// Radius of the cylinder, m.
    pub fn radius(&self) -> f64 {
        self.body.radius()
    }

    /// m; zero of a flat end mill, half the diameter of a ball.
    pub fn corner_radius(&self) -> f64 {
        self.body.corner_radius()
    }

    /// Number of teeth.
    pub fn flutes(&self) -> u32 {
        self.flutes
    }

    /// From one tooth to the next, rad.
    pub fn pitch(&self) -> f64 {
        TAU / f64::from(self.flutes)
    }

    /// rad
    pub fn helix(&self) -> f64 {
        self.helix
    }

    /// Helix direction of the flutes.
    pub fn hand(&self) -> Hand {
        self.hand
    }

    /// Runout of the clamped cutter.
    pub fn runout(&self) -> Runout {
        self.runout
    }

    /// rad
    pub fn rake(&self) -> f64 {
        self.rake
    }

    /// How far the edge at `height` (m) trails its tip, rad; negative for a left-hand helix.
    pub fn lag(&self, height: f64) -> f64 {
        self.hand.sign() * height * self.helix.tan() / self.radius()
    }

    /// The point of the edge at `height` (m) above the tip.
    pub fn at_height(&self, height: f64) -> EdgePoint {
        let z = height.max(0.0);
        let r = self.corner_radius();
        if z < r {
            self.in_corner((1.0 - z / r).acos())
        } else {
            EdgePoint {
                height: z,
                radius: self.radius(),
                sin_kappa: 1.0,
                cos_kappa: 0.0,
            }
        }
    }

    /// The point of the corner at the axial immersion angle `kappa` (rad), 0 at its lowest.
    pub fn in_corner(&self, kappa: f64) -> EdgePoint {
        let kappa = kappa.clamp(0.0, FRAC_PI_2);
        let (sin_kappa, cos_kappa) = kappa.sin_cos();
        let r = self.corner_radius();
        EdgePoint {
            // 1 - cos, in a form that keeps its digits near the tip.
            height: 2.0 * r * (kappa / 2.0).sin().powi(2),
            radius: self.radius() - r + r * sin_kappa,
            sin_kappa,
            cos_kappa,
        }
    }

    /// Axial immersion angle where a cut of this `depth` (m) ends inside the corner; 90 deg beyond it.
    pub fn corner_end(&self, depth: f64) -> f64 {
        if depth >= self.corner_radius() {
            FRAC_PI_2
        } else {
            (1.0 - depth / self.corner_radius()).acos()
        }
    }

    /// Radial runout of tooth `tooth` at `height`: its radius less that of a true-running tool, m.
    pub fn radial_runout(&self, tooth: u32, height: f64) -> f64 {
        let trails = f64::from(tooth) * self.pitch() + self.lag(height);
        self.runout.offset * (self.runout.angle - trails).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MM: f64 = 1e-3;

    #[test]
    fn a_ball_is_a_circle_and_a_cylinder_above_it() {
        let ball = Cutter::ball(10.0 * MM, 2).unwrap();
        for z in [0.0, 0.5 * MM, 2.0 * MM, 4.9 * MM] {
            let point = ball.at_height(z);
            let from_centre = (point.radius.powi(2) + (5.0 * MM - z).powi(2)).sqrt();
            // A few roundings of lengths of 5 mm.
            assert!((from_centre - 5.0 * MM).abs() < 1e-16, "{z}");
            assert!((point.height - z).abs() < 1e-17);
            // The normal of a ball points from its centre.
            assert!((point.sin_kappa - point.radius / (5.0 * MM)).abs() < 1e-15);
        }
        let above = ball.at_height(7.0 * MM);
        assert_eq!(
            (above.radius, above.sin_kappa, above.cos_kappa),
            (5.0 * MM, 1.0, 0.0)
        );
    }

    #[test]
    fn a_bull_nose_begins_at_the_edge_of_its_flat_bottom() {
        let nose = Cutter::bull_nose(16.0 * MM, 2.0 * MM, 4).unwrap();
        assert!((nose.at_height(0.0).radius - 6.0 * MM).abs() < 1e-18);
        assert_eq!(nose.at_height(2.0 * MM).radius, 8.0 * MM);
        assert_eq!(nose.corner_end(5.0 * MM), FRAC_PI_2);
        assert!((nose.corner_end(MM) - 60_f64.to_radians()).abs() < 1e-15);
    }

    #[test]
    fn a_flat_end_mill_is_all_cylinder() {
        let flat = Cutter::flat(16.0 * MM, 4).unwrap();
        assert_eq!(flat.at_height(0.0).sin_kappa, 1.0);
        assert_eq!(flat.corner_end(MM), FRAC_PI_2);
    }

    #[test]
    fn upper_points_of_a_right_hand_helix_trail_and_of_a_left_hand_one_lead() {
        let flat = Cutter::flat(16.0 * MM, 4).unwrap();
        let right = flat.with_helix(45_f64.to_radians(), Hand::Right).unwrap();
        // At 45 deg the lag is height over radius.
        assert!((right.lag(2.0 * MM) - 0.25).abs() < 1e-15);
        let left = flat.with_helix(45_f64.to_radians(), Hand::Left).unwrap();
        assert_eq!(left.lag(2.0 * MM), -right.lag(2.0 * MM));
    }

    #[test]
    fn the_runout_of_all_teeth_adds_up_to_zero() {
        let runout = Runout {
            offset: 20e-6,
            angle: 0.4,
        };
        let cutter = Cutter::flat(16.0 * MM, 3).unwrap().with_runout(runout).unwrap();
        let sum: f64 = (0..3).map(|tooth| cutter.radial_runout(tooth, 0.0)).sum();
        assert!(sum.abs() < 1e-19);
        assert!((cutter.radial_runout(0, 0.0) - 20e-6 * 0.4_f64.cos()).abs() < 1e-20);
    }

    #[test]
    fn refuses_an_invalid_cutter() {
        assert!(Cutter::flat(0.0, 2).is_err());
        assert!(Cutter::flat(f64::NAN, 2).is_err());
        assert!(Cutter::flat(0.01, 0).is_err());
        assert!(Cutter::bull_nose(0.01, 0.0051, 2).is_err());
        let flat = Cutter::flat(0.01, 2).unwrap();
        assert!(flat.with_helix(FRAC_PI_2, Hand::Right).is_err());
        assert!(flat.with_rake(1.0).is_err());
        let far = Runout {
            offset: 0.02,
            angle: 0.0,
        };
        let error = flat.with_runout(far).unwrap_err().to_string();
        assert_eq!(error, "runout is 20 mm: must be between 0 mm and 5 mm");
    }

    #[test]
    fn the_edge_is_on_the_body_and_its_normal_is_that_of_the_body() {
        for cutter in [
            Cutter::flat(16.0 * MM, 4),
            Cutter::ball(10.0 * MM, 2),
            Cutter::bull_nose(12.0 * MM, 2.5 * MM, 3),
        ]
        .map(Result::unwrap)
        {
            let body = cutter.body();
            assert_eq!(
                [body.diameter(), body.radius()],
                [cutter.diameter(), cutter.radius()]
            );
            for k in 0..=40 {
                let height = 0.2 * MM * f64::from(k);
                let point = cutter.at_height(height);
                // The root at the tip doubles the digits that are lost.
                assert!((point.radius - body.radius_at(height)).abs() < 1e-9, "{height}");
                let below = height > 0.1 * MM && height < cutter.corner_radius();
                if below {
                    // The profile climbs by tan(kappa) as it goes out.
                    let step = 1e-8;
                    let out = cutter.at_height(height + step).radius - cutter.at_height(height - step).radius;
                    let slope = point.sin_kappa / point.cos_kappa;
                    assert!((2.0 * step / out / slope - 1.0).abs() < 1e-4, "{height}");
                }
            }
        }
    }

    #[test]
    fn a_depth_ends_in_the_corner_where_the_edge_has_that_height() {
        let nose = Cutter::bull_nose(16.0 * MM, 2.0 * MM, 4).unwrap();
        for depth in [0.001, 0.3, 1.0, 1.999].map(|depth| depth * MM) {
            let end = nose.in_corner(nose.corner_end(depth));
            assert!((end.height - depth).abs() < 1e-15, "{depth}");
        }
        assert_eq!(nose.in_corner(-1.0), nose.in_corner(0.0));
        assert_eq!(nose.at_height(-MM), nose.at_height(0.0));
        assert!((nose.in_corner(FRAC_PI_2).height - 2.0 * MM).abs() < 1e-17);
    }

    #[test]
    fn the_same_tool_in_another_size_keeps_its_edges() {
        let runout = Runout {
            offset: 20e-6,
            angle: 0.4,
        };
        let cutter = Cutter::ball(10.0 * MM, 3).unwrap();
        let cutter = cutter
            .with_helix(0.5, Hand::Left)
            .unwrap()
            .with_rake(0.1)
            .unwrap();
        let cutter = cutter.with_runout(runout).unwrap();
        let sized = cutter.of_size(6.0 * MM, 1.0 * MM).unwrap();
        assert_eq!((sized.diameter(), sized.corner_radius()), (6.0 * MM, 1.0 * MM));
        assert_eq!(
            (sized.flutes(), sized.helix(), sized.hand()),
            (3, 0.5, Hand::Left)
        );
        assert_eq!((sized.runout(), sized.rake()), (runout, 0.1));
        assert_eq!(sized.of_size(10.0 * MM, 5.0 * MM).unwrap(), cutter);
        assert!(cutter.of_size(6.0 * MM, 3.1 * MM).is_err() && cutter.of_size(0.0, 0.0).is_err());
        assert!((cutter.pitch() - TAU / 3.0).abs() < 1e-15);
    }
}

//! Convex solids of revolution: the cutting part of a tool, and the pieces of its shank and holder.
//!
//! ```text
//! |x| <= r(h),   h_0 <= h <= h_1        r concave: the solid is convex
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `h` | height above the tip, along the tool axis towards the spindle | m |
//! | `x` | position across the tool axis | m |
//! | `r(h)` | radius of the solid | m |
//! | `D`, `rho` | corner: a disc of the radius `rho`, enlarged by the corner radius | m |
//!
//! `r(h)` consists of bands: straight flanks (cylinders and cones) and corners (a quarter of a torus, or of a sphere where
//! `rho = 0`), one above the other.
//!
//! Not modelled: undercutting tools (T-slot, lollipop, dovetail), teeth and helix: a turning tool fills its solid.
//!
//! Source: plane geometry \[derived\].

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Unit, Vector3};

use crate::load::error::checked;
use crate::load::{CuttingError, EndMillBody};

/// A convex solid of revolution about the tool axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolSolid {
    /// From the tip upwards, each begins where the one before ends.
    bands: Vec<Band>,
}

/// The solid between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band {
    /// Heights above the tip, m.
    pub(super) heights: [f64; 2],
    pub(super) side: Side,
}

/// The side of a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// A cylinder or cone.
    Flank {
        /// Radius at the height 0, where the line through it has it; m, may be negative.
        radius_at_zero: f64,
        /// Growth of the radius per height.
        slope: f64,
    },
    /// The lower half of a torus, or of a sphere.
    Corner {
        /// Distance of the centre of the corner from the axis, m.
        centre_radius: f64,
        /// Its height above the tip, m.
        centre_height: f64,
        /// Radius of the corner, m.
        radius: f64,
    },
}

/// Longest tool, m: far above any that a robot carries.
const MOST_LENGTH: f64 = 10.0;
/// Shortest cutting part, m.
const LEAST_LENGTH: f64 = 1e-6;
/// Steepest flank of a tapered tool from its axis, rad.
const MOST_TAPER: f64 = 80.0 * std::f64::consts::PI / 180.0;
/// Sharpest and bluntest point of a drill, rad; the bluntest is flat.
const POINT_ANGLES: [f64; 2] = [std::f64::consts::FRAC_PI_6, std::f64::consts::PI];
/// Largest radius of a shank or holder, m.
const MOST_RADIUS: f64 = 2.0;

impl Band {
    /// A cone between two heights with these radii, m.
    fn flank(heights: [f64; 2], radii: [f64; 2]) -> Band {
        let slope = (radii[1] - radii[0]) / (heights[1] - heights[0]);
        Band {
            heights,
            side: Side::Flank {
                radius_at_zero: radii[0] - slope * heights[0],
                slope,
            },
        }
    }

    /// Radius at a height of the band, m.
    pub(super) fn radius_at(&self, height: f64) -> f64 {
        match self.side {
            Side::Flank {
                radius_at_zero,
                slope,
            } => radius_at_zero + slope * height,
            Side::Corner {
                centre_radius,
                centre_height,
                radius,
            } => {
                let down = centre_height - height;
                centre_radius + ((radius - down) * (radius + down)).max(0.0).sqrt()
            }
        }
    }
}

impl ToolSolid {
    /// The cutting part of a flat, ball or bull nose end mill that is `length` (m) long.
    ///
    /// # Errors
    /// A length that is not greater than the corner, or beyond any tool.
    pub fn end_mill(body: &EndMillBody, length: f64) -> Result<ToolSolid, CuttingError> {
        ToolSolid::tapered(body, 0.0, length)
    }

    /// The same with a flank that widens by `half_angle` (rad, from the axis). `body` is the end without taper: the flank
    /// begins where it touches the corner, of a flat end mill at its edge.
    ///
    /// # Errors
    /// A taper or length out of range.
    pub fn tapered(body: &EndMillBody, half_angle: f64, length: f64) -> Result<ToolSolid, CuttingError> {
        let taper = checked("half angle of the taper", half_angle, [0.0, MOST_TAPER], "rad")?;
        let (corner, (sin, cos)) = (body.corner_radius(), taper.sin_cos());
        // The normal of the flank is that of the corner where they touch.
        let begins = corner * (1.0 - sin);
        let length = checked(
            "length of the cutting part",
            length,
            [begins + LEAST_LENGTH, MOST_LENGTH],
            "m",
        )?;
        let radius = body.flat_radius() + corner * cos;
        let mut bands = Vec::new();
        if corner > 0.0 {
            bands.push(Band {
                heights: [0.0, begins],
                side: Side::Corner {
                    centre_radius: body.flat_radius(),
                    centre_height: corner,
                    radius: corner,
                },
            });
        }
        let end = radius + (length - begins) * taper.tan();
        bands.push(Band::flank([begins, length], [radius, end]));
        Ok(ToolSolid { bands })
    }

    /// A twist drill: a cone with the full `point_angle` (rad), and a cylinder; `length` from tip to the end of the flutes, m.
    ///
    /// # Errors
    /// A diameter, point angle or length out of range.
    pub fn drill(diameter: f64, point_angle: f64, length: f64) -> Result<ToolSolid, CuttingError> {
        let body = EndMillBody::new(diameter, 0.0)?;
        let angle = checked("point angle", point_angle, POINT_ANGLES, "rad")?;
        let point = body.radius() * (FRAC_PI_2 - 0.5 * angle).tan();
        let least = point + LEAST_LENGTH;
        let length = checked("length of the drill", length, [least, MOST_LENGTH], "m")?;
        let mut bands = Vec::new();
        if point > 1e-9 * body.radius() {
            bands.push(Band::flank([0.0, point], [0.0, body.radius()]));
        }
        let begins = bands.last().map_or(0.0, |band: &Band| band.heights[1]);
        bands.push(Band::flank([begins, length], [body.radius(); 2]));
        Ok(ToolSolid { bands })
    }

    /// A piece of a shank or holder: a cone or cylinder between two heights above the tip, with these radii; m.
    ///
    /// # Errors
    /// Heights that do not increase, radii below 0, numbers beyond any tool.
    pub fn cone(heights: [f64; 2], radii: [f64; 2]) -> Result<ToolSolid, CuttingError> {
        let begins = checked("height of the body", heights[0], [0.0, MOST_LENGTH], "m")?;
        let range = [begins + LEAST_LENGTH, MOST_LENGTH + LEAST_LENGTH];
        let ends = checked("upper end of the body", heights[1], range, "m")?;
        for radius in radii {
            checked("radius of the body", radius, [0.0, MOST_RADIUS], "m")?;
        }
        Ok(ToolSolid {
            bands: vec![Band::flank([begins, ends], radii)],
        })
    }

    pub(super) fn bands(&self) -> &[Band] {
        &self.bands
    }

    /// Heights of its lower and upper end above the tip, m.
    pub fn heights(&self) -> [f64; 2] {
        let [first, last] = [self.bands.first(), self.bands.last()];
        [
            first.map_or(0.0, |band| band.heights[0]),
            last.map_or(0.0, |band| band.heights[1]),
        ]
    }

    /// Its largest radius, m.
    pub fn radius(&self) -> f64 {
        let ends = self
            .bands
            .iter()
            .flat_map(|band| band.heights.map(|height| band.radius_at(height)));
        ends.fold(0.0, f64::max)
    }

    /// Radius at a height above the tip, m; `None` above and below.
    pub fn radius_at(&self, height: f64) -> Option<f64> {
        let band = self.bands.iter().find(|band| {
            let [low, high] = band.heights;
            (low..=high).contains(&height)
        })?;
        Some(band.radius_at(height).max(0.0))
    }

    /// Largest distance of its points from the point of the axis at this height, m.
    pub(super) fn reach_from(&self, height: f64) -> f64 {
        let [low, high] = self.heights();
        (high - height)
            .abs()
            .max((height - low).abs())
            .hypot(self.radius())
    }

    /// Least and greatest coordinate along `direction` relative to the tip, of the tool with this axis, m; a corner may
    /// be exceeded.
    pub(super) fn extent(&self, axis: &Unit<Vector3<f64>>, direction: &Vector3<f64>) -> [f64; 2] {
        let along = axis.dot(direction);
        let across = axis.cross(direction).norm();
        let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
        for band in &self.bands {
            for height in band.heights {
                let (middle, half) = (height * along, band.radius_at(height).max(0.0) * across);
                extent = [extent[0].min(middle - half), extent[1].max(middle + half)];
            }
            if let Side::Corner {
                centre_radius,
                centre_height,
                radius,
            } = band.side
            {
                let (middle, half) = (centre_height * along, centre_radius * across + radius);
                extent = [extent[0].min(middle - half), extent[1].max(middle + half)];
            }
        }
        extent
    }
}

#[cfg(test)]
mod tests;

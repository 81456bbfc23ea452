//! The cut of a study: cutter, material and depths, from which forces along a program come.
//!
//! | of the table | in the core |
//! |---|---|
//! | `law`, `material` | mechanistic: mean of the whole sets of the material; Kienzle: of its values, with ratios |
//! | `side`, `radial_depth_mm` | on which side of the feed the part is, and the radial depth of cut |
//! | `feed_mm_per_min`, `spindle_rpm` | m/s and rad/s, if the program does not specify them |
//! | `u_percent` | standard uncertainty of all coefficients together, in place of the scatter of the sets |
//! | `stock` | a box; the engagement is then what the tool meets there |

use std::f64::consts::TAU;

use armill_core::load::{
    Cutter, CuttingError, CuttingLaw, Engagement, Estimate, Hand, Immersion, Kienzle, KienzleValues,
    LeanInCut, Mechanistic, Milling, Runout, SetStatistics,
};
use armill_core::nalgebra::Point3;
use armill_core::path::{Cutting, GreatestForce, Stock, StockError};
use armill_core::units::{from_deg, from_mm, from_um};
use armill_formats::material::Material;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::input::problem_log::ProblemLog;
use crate::library;

/// The cutter and its depths of cut.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutTable {
    /// Name of a material of the library.
    pub material: String,
    /// Cutting force law; mechanistic if left out, if the material has the coefficients.
    pub law: Option<LawName>,
    /// The cutter.
    pub cutter: CutterTable,
    /// Axial depth of cut.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub axial_depth_mm: f64,
    /// Radial depth of cut, across the tool and the feed; the whole diameter for a slot.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub radial_depth_mm: Option<f64>,
    /// On which side of the feed the part is.
    pub side: SideName,
    /// Feed, if the program does not specify it.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub feed_mm_per_min: Option<f64>,
    /// Spindle speed, if the program does not specify it; clockwise.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub spindle_rpm: Option<f64>,
    /// Whether the greatest force of a revolution is a second load case in addition to the mean.
    #[serde(default)]
    pub peak: bool,
    /// Kienzle: radial over cutting force, and its standard uncertainty.
    pub radial_ratio: Option<[f64; 2]>,
    /// Kienzle: axial over cutting force, positive for a right-hand helix, and its standard uncertainty.
    pub axial_ratio: Option<[f64; 2]>,
    /// Standard uncertainty of the coefficients, in place of the scatter of the material's sets.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub u_percent: Option<f64>,
    /// The stock, a box: the depths of cut are then those of the tool in the stock.
    pub stock: Option<StockTable>,
}

/// A box of stock, in the frame of the program.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StockTable {
    /// One corner: x, y, z.
    #[schemars(inner(range(min = -1e5, max = 1e5)))]
    pub from_mm: [f64; 3],
    /// The other, greater in each.
    #[schemars(inner(range(min = -1e5, max = 1e5)))]
    pub to_mm: [f64; 3],
    /// Side of a cell of its height map; a fortieth of the cutter if left out.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub cell_mm: Option<f64>,
}

/// A cutting force law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LawName {
    /// Shear and edge coefficients.
    Mechanistic,
    /// Specific force and exponent, with ratios for the other components.
    Kienzle,
}

/// Position of the part, seen along the feed; the spindle turns clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SideName {
    /// On the left: the chip thickness starts at zero (up-milling).
    Up,
    /// On the right: the chip thickness ends at zero (down-milling).
    Down,
    /// A strip in the middle of the cutter.
    Centred,
    /// On both: the whole width.
    Slot,
}

impl SideName {
    /// As the study has it.
    pub fn word(self) -> &'static str {
        match self {
            SideName::Up => "up",
            SideName::Down => "down",
            SideName::Centred => "centred",
            SideName::Slot => "slot",
        }
    }
}

/// An end mill.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutterTable {
    /// Its diameter.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub diameter_mm: f64,
    /// Radius of its corner: 0 or left out is flat, half the diameter a ball.
    #[schemars(range(min = 0.0, max = 1e3))]
    pub corner_radius_mm: Option<f64>,
    /// Number of flutes.
    #[schemars(range(min = 1, max = 100))]
    pub flutes: u32,
    /// Helix; 30 if left out. Negative is left-hand.
    #[schemars(range(min = -80.0, max = 80.0))]
    pub helix_deg: Option<f64>,
    /// Rake, for Kienzle.
    #[schemars(range(min = -45.0, max = 45.0))]
    pub rake_deg: Option<f64>,
    /// Offset of its axis from that of the spindle (runout).
    #[schemars(range(min = 0.0, max = 1e4))]
    pub runout_um: Option<f64>,
}

/// Default helix angle of an end mill, deg.
const HELIX_DEG: f64 = 30.0;
/// Default ratios of radial and axial to cutting force, each with its standard uncertainty: wide, since
/// they follow edge, rake and helix.
const RADIAL_RATIO: [f64; 2] = [0.3, 0.1];
/// The same of the axial force.
const AXIAL_RATIO: [f64; 2] = [0.2, 0.1];
/// Standard uncertainty of coefficients known from one set alone: half the scatter among sets of one alloy, whose
/// Ktc differ by a factor of 2.2.
const RELATIVE_U_OF_ONE_SET: f64 = 0.3;

/// A resolved cut, with the sources of its numbers.
#[derive(Clone, Debug)]
pub struct Cut {
    /// The cut for the core.
    pub cutting: Cutting,
    /// The material.
    pub material: Material,
    /// Notes for the user on it.
    pub remarks: Vec<String>,
    /// The uncut stock, if the study specifies it.
    pub stock: Option<Stock>,
}

impl Cut {
    /// The milling at this spindle speed (rad/s) and feed (m/s), with this depth (m) in place of its own.
    ///
    /// # Errors
    /// Values outside what can be cut.
    pub fn milling(&self, [spindle, feed]: [f64; 2], depth: Option<f64>) -> Result<Milling, CuttingError> {
        let cutting = &self.cutting;
        let depth = depth.unwrap_or(cutting.depth);
        let per_tooth = feed * TAU / (spindle * f64::from(cutting.cutter.flutes()));
        let cut = armill_core::load::Cut {
            depth,
            engagement: Engagement::at_depth(cutting.immersion, &cutting.cutter, depth)?,
            feed: per_tooth,
            rise: 0.0,
            lean: LeanInCut::default(),
        };
        Milling::new(cutting.cutter, cutting.law, cut)
    }
}

/// The cut of this table; `None` if it has problems.
pub fn resolve(log: &mut ProblemLog<'_>, table: &CutTable) -> Option<Cut> {
    let material = material(log, "cut.material", &table.material);
    let cutter = cutter(&table.cutter)
        .map_err(|error| {
            log.problem(
                "cut.cutter",
                error.to_string(),
                "the data of an end mill as in its catalogue",
            );
        })
        .ok();
    let immersion = immersion(log, table);
    let stock = stock(log, table);
    let (material, cutter, immersion) = (material?, cutter?, immersion?);
    if table.axial_depth_mm <= 0.0 {
        let message = format!("an axial depth of {} mm cuts nothing", table.axial_depth_mm);
        log.problem(
            "cut.axial_depth_mm",
            message,
            "give the depth of the cutter in the part along its axis",
        );
        return None;
    }
    let mut remarks = Vec::new();
    let law = law(log, table, &material, &mut remarks)?;
    Some(Cut {
        cutting: Cutting {
            cutter,
            law,
            depth: from_mm(table.axial_depth_mm),
            immersion,
            feed: table
                .feed_mm_per_min
                .filter(|feed| *feed > 0.0)
                .map(|feed| from_mm(feed) / 60.0),
            spindle: table
                .spindle_rpm
                .filter(|speed| *speed > 0.0)
                .map(|speed| speed * TAU / 60.0),
            greatest: if table.peak {
                GreatestForce::SecondCase
            } else {
                GreatestForce::LeftOut
            },
        },
        material,
        remarks,
        stock: stock?,
    })
}

/// Default number of cells across a cutter: edges of the engagement are then correct to about 1.3 % of
/// the diameter.
const CELLS_ACROSS: f64 = 40.0;

/// The stock, `Some(None)` if none is given.
fn stock(log: &mut ProblemLog<'_>, table: &CutTable) -> Option<Option<Stock>> {
    let Some(reported) = &table.stock else {
        return Some(None);
    };
    let corners = [reported.from_mm, reported.to_mm].map(|mm| Point3::from(mm.map(from_mm)));
    let cell_mm = reported
        .cell_mm
        .unwrap_or(table.cutter.diameter_mm / CELLS_ACROSS);
    let refused = |error: StockError| {
        let hint = "from_mm = [-50, -50, -20], to_mm = [50, 50, 0]: two corners in the frame of the program";
        log.problem("cut.stock", error.to_string(), hint);
    };
    Stock::new(corners, from_mm(cell_mm))
        .map_err(refused)
        .ok()
        .map(Some)
}

/// The library material called `name`; a problem at `key`, with the name most like it, where there is none.
pub fn material(log: &mut ProblemLog<'_>, key: &str, name: &str) -> Option<Material> {
    // Those of the library are read by its tests.
    match library::material(name) {
        Some(Ok(material)) => Some(material),
        Some(Err(_)) | None => {
            let message = format!("no material is called `{name}`");
            log.problem(key, message, &library::hint_of_material(name));
            None
        }
    }
}

/// The end mill of the table: flat without a corner radius, else with rounded corners.
fn cutter(table: &CutterTable) -> Result<Cutter, CuttingError> {
    let diameter = from_mm(table.diameter_mm);
    let corner = from_mm(table.corner_radius_mm.unwrap_or(0.0));
    let cutter = if corner == 0.0 {
        Cutter::flat(diameter, table.flutes)?
    } else {
        Cutter::bull_nose(diameter, corner, table.flutes)?
    };
    let helix = table.helix_deg.unwrap_or(HELIX_DEG);
    let hand = if helix < 0.0 { Hand::Left } else { Hand::Right };
    let runout = Runout {
        offset: from_um(table.runout_um.unwrap_or(0.0)),
        ..Runout::default()
    };
    cutter
        .with_helix(from_deg(helix.abs()), hand)?
        .with_rake(from_deg(table.rake_deg.unwrap_or(0.0)))?
        .with_runout(runout)
}

/// The position of the cutter in the part; only a slot needs no radial depth.
fn immersion(log: &mut ProblemLog<'_>, table: &CutTable) -> Option<Immersion> {
    if table.side == SideName::Slot {
        return Some(Immersion::Slot);
    }
    let Some(depth) = table.radial_depth_mm else {
        let hint = "radial_depth_mm = 2; only a slot has none";
        log.problem("cut", "a cut on one side needs its `radial_depth_mm`", hint);
        return None;
    };
    let depth = from_mm(depth);
    Some(match table.side {
        SideName::Up => Immersion::Up(depth),
        SideName::Down => Immersion::Down(depth),
        SideName::Centred | SideName::Slot => Immersion::Centred(depth),
    })
}

/// The requested law, else the mechanistic one if the material has a complete set. Assumptions are added to `remarks`.
fn law(
    log: &mut ProblemLog<'_>,
    table: &CutTable,
    material: &Material,
    remarks: &mut Vec<String>,
) -> Option<CuttingLaw> {
    let given = table.u_percent.map(|percent| percent / 100.0);
    let requested = match (table.law, material.mechanistic()) {
        (Some(LawName::Mechanistic) | None, Some(together)) => {
            if together.covariance.is_none() && given.is_none() {
                remarks.push(one_set_remark(&material.name));
            }
            mechanistic(&together, given).map(CuttingLaw::Mechanistic)
        }
        (Some(LawName::Mechanistic), None) => {
            let message = format!(
                "{} has no complete set of mechanistic coefficients",
                material.name
            );
            log.problem("cut.law", message, "law = \"kienzle\"");
            return None;
        }
        (Some(LawName::Kienzle) | None, _) => {
            let Some(together) = material.kienzle() else {
                let message = format!("{} has no specific cutting force", material.name);
                log.problem("cut.law", message, "use another material");
                return None;
            };
            if table.radial_ratio.is_none() || table.axial_ratio.is_none() {
                remarks.push(format!(
                    "Kienzle gives the cutting force alone: radial and axial force are assumed as {} +- {} and {} +- {} of it unless the study specifies them.",
                    RADIAL_RATIO[0], RADIAL_RATIO[1], AXIAL_RATIO[0], AXIAL_RATIO[1]
                ));
            }
            if together.covariance.is_none() && given.is_none() {
                remarks.push(one_set_remark(&material.name));
            }
            let ratios = [
                table.radial_ratio.unwrap_or(RADIAL_RATIO),
                table.axial_ratio.unwrap_or(AXIAL_RATIO),
            ];
            kienzle(&together, given, ratios).map(CuttingLaw::Kienzle)
        }
    };
    requested
        .map_err(|error| log.problem("cut.material", error.to_string(), "check the number"))
        .ok()
}

/// Mechanistic law of a material; `relative` in place of the scatter of its sets.
fn mechanistic(together: &SetStatistics<6>, relative: Option<f64>) -> Result<Mechanistic, CuttingError> {
    let (shear, edge) = (together.mean.fixed_rows::<3>(0), together.mean.fixed_rows::<3>(3));
    let law = Mechanistic::new(shear.into(), edge.into())?;
    match (relative, together.covariance) {
        (None, Some(covariance)) => law.with_covariance(covariance),
        (relative, _) => law.with_relative_uncertainty(relative.unwrap_or(RELATIVE_U_OF_ONE_SET)),
    }
}

/// Kienzle's law of a material; `relative` in place of the scatter of its sets, and the ratios of radial and axial to
/// cutting force, each with its standard uncertainty.
pub fn kienzle(
    together: &SetStatistics<2>,
    relative: Option<f64>,
    ratios: [[f64; 2]; 2],
) -> Result<Kienzle, CuttingError> {
    let [kc1, mc]: [f64; 2] = together.mean.into();
    let [u_kc1, u_mc] = match together.covariance {
        Some(covariance) => [covariance[(0, 0)].sqrt(), covariance[(1, 1)].sqrt()],
        None => [RELATIVE_U_OF_ONE_SET * kc1, 0.0],
    };
    let specific_force = Estimate {
        value: kc1,
        standard_uncertainty: relative.map_or(u_kc1, |fraction| fraction * kc1),
    };
    let exponent = Estimate {
        value: mc,
        standard_uncertainty: u_mc,
    };
    let [radial_ratio, axial_ratio] = ratios.map(|[value, standard_uncertainty]| Estimate {
        value,
        standard_uncertainty,
    });
    Kienzle::new(KienzleValues {
        specific_force,
        exponent,
        radial_ratio,
        axial_ratio,
    })
}

/// States what replaces the scatter for a material with a single set.
pub fn one_set_remark(material: &str) -> String {
    format!(
        "{material}: only one set of coefficients is known; {:.0} % is assumed as its standard uncertainty.",
        RELATIVE_U_OF_ONE_SET * 100.0
    )
}

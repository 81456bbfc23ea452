//! The systems that points are counted in: CSYS and TRNTYP of SolidWorks, MSYS of NX.
//!
//! `path_from_here = world_from_path^-1 world_from_here`: the path is in the first MSYS, and later ones are brought
//! into it. Points of SolidWorks are in the world, or refused.
//!
//! | word | numbers | meaning |
//! |---|---|---|
//! | `CSYS` | twelve, row by row: three of a turn, one of the origin | checked; points are where TRNTYP says |
//! | `TRNTYP` | a word | `WORLD`, or refused |
//! | `MSYS` | nine: origin, x axis, y axis | where the points that follow are counted |

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::Dialect;
use super::modal::Interpreter;
use super::statement::Statement;

/// Axes of a system are perpendicular and of length 1 within this: four decimals.
const AXES_SLACK: f64 = 1e-3;

impl Interpreter<'_> {
    /// TRNTYP: whether points are in the world.
    ///
    /// A word of SolidWorks alone.
    pub fn trntyp(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::SolidWorks);
        self.world_told = statement.word_at(0) == "WORLD";
        if !self.world_told {
            let message = format!("TRNTYP/{}: in which system are the points?", statement.word_at(0));
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "let the CAM system write world coordinates: `TRNTYP/WORLD`",
            );
        }
    }

    /// The local system: twelve numbers, row by row, each row ending in a coordinate of its origin.
    ///
    /// Nothing is moved by it: a system other than the world is a problem unless the points were said to be in the
    /// world.
    pub fn csys(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::SolidWorks);
        let Some(numbers) = self.numbers(statement) else {
            return;
        };
        let [a, b, c, x, d, e, f, y, g, h, i, z] = numbers[..] else {
            let message = format!("{} numbers of a CSYS", numbers.len());
            self.tell(
                statement,
                statement.parameters_span(),
                message,
                "twelve are wanted: three rows of four",
            );
            return;
        };
        let axes = Matrix3::new(a, b, c, d, e, f, g, h, i);
        if rotation(axes).is_none() {
            self.tell(
                statement,
                statement.parameters_span(),
                SKEW,
                "the first three numbers of each row make a turn",
            );
        } else if !self.world_told && (axes != Matrix3::identity() || [x, y, z] != [0.0; 3]) {
            let message = "a CSYS, but nothing before it says whether points are in it or in the world";
            self.tell(
                statement,
                statement.word_span(),
                message,
                "`TRNTYP/WORLD` before it says that they are in the world",
            );
        }
    }

    /// The system of the points: its origin, x axis and y axis.
    ///
    /// Kept until the next point, since the unit may come behind it. What was told of the tool axis is forgotten.
    pub fn msys(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        let Some(numbers) = self.numbers(statement) else {
            return;
        };
        let [x, y, z, ref axes @ ..] = numbers[..] else {
            return self.tell(
                statement,
                statement.parameters_span(),
                "an MSYS without origin",
                MSYS_HINT,
            );
        };
        let [a, b, c, d, e, f] = *axes else {
            let message = format!("{} numbers of an MSYS", numbers.len());
            return self.tell(statement, statement.parameters_span(), message, MSYS_HINT);
        };
        let (first, second) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        let Some(turn) = rotation(Matrix3::from_columns(&[first, second, first.cross(&second)])) else {
            return self.tell(statement, statement.parameters_span(), SKEW, MSYS_HINT);
        };
        if self.world_from_path.is_none() && self.points > 0 {
            let message = "the first MSYS, but points came before it";
            self.tell(
                statement,
                statement.word_span(),
                message,
                "every path says its MSYS before its points",
            );
        }
        self.system = Some((Vector3::new(x, y, z), turn));
        self.axis = None;
    }

    /// Takes the last MSYS as the system of what follows; its unit may have been told behind it.
    ///
    /// The first one is the frame of the path: there `path_from_here` is the identity.
    pub fn settle_system(&mut self, statement: &Statement) {
        let Some((origin, turn)) = self.system.take() else {
            return;
        };
        let origin = origin * self.metres(statement);
        let world_from_here = Isometry::from_parts(Translation3::from(origin), turn);
        let world_from_path = *self.world_from_path.get_or_insert(world_from_here);
        self.path_from_here = world_from_path.inverse() * world_from_here;
    }
}

/// What is wrong with axes that make no turn.
const SKEW: &str = "these axes are not perpendicular and of length 1";
/// How an MSYS is written.
const MSYS_HINT: &str = "nine numbers: origin, x axis, y axis";

/// The turn of three axes; `None` if they are not perpendicular, of length 1 and right-handed.
fn rotation(axes: Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let off = (axes.transpose() * axes - Matrix3::identity()).abs().max();
    (off <= AXES_SLACK && axes.determinant() > 0.0).then(|| {
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        // Axes are rounded, a turn is not.
        UnitQuaternion::new_normalize(turn.into_inner())
    })
}

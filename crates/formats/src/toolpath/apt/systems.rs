//! The systems that points are counted in: CSYS and TRNTYP of SolidWorks, MSYS of NX.
//!
//! `path_from_here = world_from_path^-1 world_from_here`: the path is in the first MSYS, and later ones are brought
//! into it. Points of SolidWorks are in the world, or refused.
//!
//! | word | numbers | meaning |
//! |---|---|---|
//! | `CSYS` | twelve, row by row: three of a rotation, one of the origin | checked; points are in the system of TRNTYP |
//! | `TRNTYP` | a word | `WORLD`, or refused |
//! | `MSYS` | nine: origin, x axis, y axis | system of the points after it |

use armill_core::frame::Isometry;
use armill_core::nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::modal::Interpreter;
use super::options::Dialect;
use super::statement::Statement;

/// Axes of a system are perpendicular and of length 1 within this: four decimals.
const AXES_SLACK: f64 = 1e-3;

impl Interpreter<'_> {
    /// TRNTYP: whether points are in the world.
    ///
    /// A word of SolidWorks alone.
    pub fn trntyp(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::SolidWorks);
        self.in_world = statement.word_at(0) == "WORLD";
        if !self.in_world {
            let message = format!(
                "TRNTYP/{}: the system of the points is not known",
                statement.word_at(0)
            );
            self.report(
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
            let message = format!("a CSYS has {} numbers", numbers.len());
            self.report(
                statement,
                statement.parameters_span(),
                message,
                "write twelve numbers: three rows of four",
            );
            return;
        };
        let axes = Matrix3::new(a, b, c, d, e, f, g, h, i);
        if rotation(axes).is_none() {
            self.report(
                statement,
                statement.parameters_span(),
                SKEW,
                "the first three numbers of each row must form a rotation",
            );
        } else if !self.in_world && (axes != Matrix3::identity() || [x, y, z] != [0.0; 3]) {
            let message = "a CSYS, but it is not known whether points are in it or in the world";
            self.report(
                statement,
                statement.word_span(),
                message,
                "add `TRNTYP/WORLD` before it if they are in the world",
            );
        }
    }

    /// The system of the points: its origin, x axis and y axis.
    ///
    /// Stored until the next point, because the unit may come later. The previous tool axis is forgotten.
    pub fn msys(&mut self, statement: &Statement) {
        self.evidence(statement, Dialect::Nx);
        let Some(numbers) = self.numbers(statement) else {
            return;
        };
        let [x, y, z, ref axes @ ..] = numbers[..] else {
            return self.report(
                statement,
                statement.parameters_span(),
                "an MSYS without origin",
                MSYS_HINT,
            );
        };
        let [a, b, c, d, e, f] = *axes else {
            let message = format!("an MSYS has {} numbers", numbers.len());
            return self.report(statement, statement.parameters_span(), message, MSYS_HINT);
        };
        let (first, second) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        let Some(turn) = rotation(Matrix3::from_columns(&[first, second, first.cross(&second)])) else {
            return self.report(statement, statement.parameters_span(), SKEW, MSYS_HINT);
        };
        if self.world_from_path.is_none() && self.points > 0 {
            let message = "the first MSYS, but points came before it";
            self.report(
                statement,
                statement.word_span(),
                message,
                "write the MSYS of a path before its points",
            );
        }
        self.system = Some((Vector3::new(x, y, z), turn));
        self.axis = None;
    }

    /// Applies the last MSYS to the following points; its unit may have come after it.
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
const MSYS_HINT: &str = "write nine numbers: origin, x axis, y axis";

/// The turn of three axes; `None` if they are not perpendicular, of length 1 and right-handed.
fn rotation(axes: Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let off = (axes.transpose() * axes - Matrix3::identity()).abs().max();
    (off <= AXES_SLACK && axes.determinant() > 0.0).then(|| {
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        // Axes are rounded, a turn is not.
        UnitQuaternion::new_normalize(turn.into_inner())
    })
}

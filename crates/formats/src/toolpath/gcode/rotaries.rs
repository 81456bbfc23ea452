//! How rotary axes turn the tool in the frame of the part.
//!
//! `t = (T1 T2 ...)^-1 (H1 H2 ...) z`: each `T` turns a table, each `H` a head by the right hand about its machine
//! axis, the first the one next to the frame of the machine.
//!
//! | symbol | meaning |
//! |---|---|
//! | `t` | tool axis in the frame of the part, from the tip to the spindle |
//! | `T` | turn of a table; the part turns with it |
//! | `H` | turn of a head; the tool turns with it |
//! | `z` | tool axis at zero: along Z |
//!
//! A table that tilts about X and carries a turntable, A and C: `t = (sin C sin A, cos C sin A, cos A)`. A table
//! about Y that carries a turntable, B and C: `t = (-cos C sin B, sin C sin B, cos B)`.
//!
//! Source: rigid body kinematics; sense of turning: ISO 841, the table turns against the tool. Witness: in LinuxCNC's
//! five-axis samples approach moves run along this axis.

use armill_core::nalgebra::{Rotation3, Unit, Vector3};
use armill_core::units::from_deg;

/// An axis of rotation, about X, Y or Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotary {
    /// About X.
    A,
    /// About Y.
    B,
    /// About Z.
    C,
}

impl Rotary {
    /// Its place among A, B, C.
    fn index(self) -> usize {
        match self {
            Rotary::A => 0,
            Rotary::B => 1,
            Rotary::C => 2,
        }
    }

    /// Its turn, by the right hand about its axis of the machine.
    fn turn(self, degrees: [f64; 3]) -> Rotation3<f64> {
        let axis = match self {
            Rotary::A => Vector3::x_axis(),
            Rotary::B => Vector3::y_axis(),
            Rotary::C => Vector3::z_axis(),
        };
        Rotation3::from_axis_angle(&axis, from_deg(degrees[self.index()]))
    }
}

/// The rotary axes of a machine, each list from the frame of the machine outwards.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rotaries {
    /// That turn the part.
    pub table: Vec<Rotary>,
    /// That turn the tool.
    pub head: Vec<Rotary>,
}

impl Rotaries {
    /// A tilting table A that carries a turntable C: `xyzac`.
    pub fn table_ac() -> Rotaries {
        Rotaries {
            table: vec![Rotary::A, Rotary::C],
            head: Vec::new(),
        }
    }

    /// A tilting table B that carries a turntable C: `xyzbc`.
    pub fn table_bc() -> Rotaries {
        Rotaries {
            table: vec![Rotary::B, Rotary::C],
            head: Vec::new(),
        }
    }

    /// A fork C that carries a tilting head A.
    pub fn head_ca() -> Rotaries {
        Rotaries {
            table: Vec::new(),
            head: vec![Rotary::C, Rotary::A],
        }
    }

    /// A fork C that carries a tilting head B.
    pub fn head_cb() -> Rotaries {
        Rotaries {
            table: Vec::new(),
            head: vec![Rotary::C, Rotary::B],
        }
    }

    /// Whether the machine has this axis.
    pub fn has(&self, rotary: Rotary) -> bool {
        self.table.contains(&rotary) || self.head.contains(&rotary)
    }

    /// The tool axis in the frame of the part at these A, B, C in degrees.
    ///
    /// In the order A, B, C; those that the machine does not have are not looked at.
    pub fn tool_axis(&self, degrees: [f64; 3]) -> Unit<Vector3<f64>> {
        let product = |rotaries: &[Rotary]| {
            rotaries
                .iter()
                .fold(Rotation3::identity(), |turn, rotary| turn * rotary.turn(degrees))
        };
        let axis = product(&self.table).inverse() * (product(&self.head) * Vector3::z());
        Unit::new_normalize(axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few roundings of numbers about 1.
    const EXACT: f64 = 1e-15;

    #[test]
    fn tables_turn_the_tool_as_their_closed_forms_say() {
        for (a, b, c) in [
            (20.0_f64, -50.0_f64, 130.0_f64),
            (-72.0, 5.0, -36.0),
            (0.0, 0.0, 45.0),
        ] {
            let [ra, rb, rc] = [a, b, c].map(f64::to_radians);
            let ac = Vector3::new(rc.sin() * ra.sin(), rc.cos() * ra.sin(), ra.cos());
            let bc = Vector3::new(-rc.cos() * rb.sin(), rc.sin() * rb.sin(), rb.cos());
            assert!((Rotaries::table_ac().tool_axis([a, b, c]).into_inner() - ac).norm() < EXACT);
            assert!((Rotaries::table_bc().tool_axis([a, b, c]).into_inner() - bc).norm() < EXACT);
        }
    }

    #[test]
    fn heads_turn_the_tool_by_the_right_hand() {
        let axis = Rotaries::head_cb().tool_axis([0.0, 90.0, 90.0]).into_inner();
        assert!(
            (axis - Vector3::y()).norm() < EXACT,
            "B lays it along X, C turns that to Y"
        );
        let axis = Rotaries::head_ca().tool_axis([90.0, 0.0, 0.0]).into_inner();
        assert!((axis + Vector3::y()).norm() < EXACT, "A lays it against Y");
    }
}

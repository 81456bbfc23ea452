//! Poses, and the six ways in which controllers write an orientation.
//!
//! A pose is `p -> R p + t`: the frame that it places, seen from its reference frame; t in mm, R by rows.

/// Position and rotation of a frame relative to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub position_mm: [f64; 3],
    /// Rows; column j is the j-th axis of the placed frame.
    pub rotation: [[f64; 3]; 3],
}

type Rotation = [[f64; 3]; 3];

const UNIT: Rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// How far a written quaternion may be from length 1: eight decimals are printed by most, three by some.
const QUATERNION_LENGTH: f64 = 2e-3;

impl Pose {
    pub const IDENTITY: Pose = Pose {
        position_mm: [0.0; 3],
        rotation: UNIT,
    };

    /// KUKA: A about z, B about the new y, C about the newest x, deg.
    ///
    /// Source: KUKA System Software 8.3, Operating and Programming Instructions, coordinate systems [recalled].
    pub fn kuka([x, y, z, a, b, c]: [f64; 6]) -> Pose {
        Pose {
            position_mm: [x, y, z],
            rotation: times(&times(&about_z(a), &about_y(b)), &about_x(c)),
        }
    }

    /// X, Y, Z, A, B, C of KUKA. At B = +-90 deg, A is 0.
    pub fn kuka_numbers(&self) -> [f64; 6] {
        let [x, y, z] = self.position_mm;
        let r = &self.rotation;
        let horizontal = r[0][0].hypot(r[1][0]);
        let b = (-r[2][0]).atan2(horizontal);
        let (a, c) = if horizontal > 1e-9 {
            (r[1][0].atan2(r[0][0]), r[2][1].atan2(r[2][2]))
        } else {
            // sin B = +-1: only the sum of the two rotations is defined.
            (0.0, (-r[1][2]).atan2(r[1][1]))
        };
        [x, y, z, a.to_degrees(), b.to_degrees(), c.to_degrees()]
    }

    /// ABB: quaternion q1 (scalar), q2, q3, q4; `None` if its length is not 1.
    ///
    /// Source: RAPID reference manual, data type `orient` [recalled].
    pub fn abb(position_mm: [f64; 3], [q1, q2, q3, q4]: [f64; 4]) -> Option<Pose> {
        let length = (q1 * q1 + q2 * q2 + q3 * q3 + q4 * q4).sqrt();
        if (length - 1.0).abs() > QUATERNION_LENGTH {
            return None;
        }
        let [w, x, y, z] = [q1, q2, q3, q4].map(|part| part / length);
        Some(Pose {
            position_mm,
            rotation: [
                [
                    1.0 - 2.0 * (y * y + z * z),
                    2.0 * (x * y - w * z),
                    2.0 * (x * z + w * y),
                ],
                [
                    2.0 * (x * y + w * z),
                    1.0 - 2.0 * (x * x + z * z),
                    2.0 * (y * z - w * x),
                ],
                [
                    2.0 * (x * z - w * y),
                    2.0 * (y * z + w * x),
                    1.0 - 2.0 * (x * x + y * y),
                ],
            ],
        })
    }

    /// Yaskawa (Rx, Ry, Rz) and FANUC (W, P, R): about the fixed x, then the fixed y, then the fixed z, deg.
    ///
    /// Source: DX100 instructions (Rx, Ry, Rz of a frame); FANUC HandlingTool operator's manual B-83284EN (W, P, R)
    /// [recalled].
    pub fn fixed_xyz([x, y, z, rx, ry, rz]: [f64; 6]) -> Pose {
        Pose {
            position_mm: [x, y, z],
            rotation: times(&times(&about_z(rz), &about_y(ry)), &about_x(rx)),
        }
    }

    /// Universal Robots: rotation vector, rad; here the position in mm.
    ///
    /// Source: URScript manual, module motion: the last three coordinates are an axis-angle vector.
    pub fn rotation_vector(position_mm: [f64; 3], [rx, ry, rz]: [f64; 3]) -> Pose {
        let angle = (rx * rx + ry * ry + rz * rz).sqrt();
        if angle < 1e-15 {
            return Pose {
                position_mm,
                rotation: UNIT,
            };
        }
        let [x, y, z] = [rx, ry, rz].map(|part| part / angle);
        let (sin, cos) = angle.sin_cos();
        let rest = 1.0 - cos;
        Pose {
            position_mm,
            rotation: [
                [cos + x * x * rest, x * y * rest - z * sin, x * z * rest + y * sin],
                [y * x * rest + z * sin, cos + y * y * rest, y * z * rest - x * sin],
                [z * x * rest - y * sin, z * y * rest + x * sin, cos + z * z * rest],
            ],
        }
    }

    /// Staubli: Rx about x, Ry about the new y, Rz about the newest z, deg.
    ///
    /// Source: VAL3 reference manual 5.3, type `trsf` [recalled].
    pub fn staubli([x, y, z, rx, ry, rz]: [f64; 6]) -> Pose {
        Pose {
            position_mm: [x, y, z],
            rotation: times(&times(&about_x(rx), &about_y(ry)), &about_z(rz)),
        }
    }

    /// `next`, given relative to this pose, relative to the reference of this pose.
    pub fn then(&self, next: &Pose) -> Pose {
        Pose {
            position_mm: self.point(next.position_mm),
            rotation: times(&self.rotation, &next.rotation),
        }
    }

    pub fn inverse(&self) -> Pose {
        let back = transposed(&self.rotation);
        Pose {
            position_mm: apply(&back, self.position_mm).map(|part| -part),
            rotation: back,
        }
    }

    /// A point given relative to this pose.
    pub fn point(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = apply(&self.rotation, point);
        std::array::from_fn(|axis| turned[axis] + self.position_mm[axis])
    }

    /// The z axis: that of the tool points from the flange along the tool.
    pub fn z_axis(&self) -> [f64; 3] {
        self.rotation.map(|row| row[2])
    }

    pub fn distance_mm(&self, other: &Pose) -> f64 {
        distance(self.position_mm, other.position_mm)
    }

    /// Angle of the rotation between two poses, deg.
    pub fn angle_deg(&self, other: &Pose) -> f64 {
        let between = times(&transposed(&self.rotation), &other.rotation);
        // From the antisymmetric part where it is small: the arc cosine has no digits there.
        let [x, y, z] = [
            between[2][1] - between[1][2],
            between[0][2] - between[2][0],
            between[1][0] - between[0][1],
        ];
        let sin = 0.5 * (x * x + y * y + z * z).sqrt();
        let cos = 0.5 * (between[0][0] + between[1][1] + between[2][2] - 1.0);
        sin.atan2(cos).to_degrees()
    }
}

pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

fn apply(rotation: &Rotation, [x, y, z]: [f64; 3]) -> [f64; 3] {
    rotation.map(|row| row[0] * x + row[1] * y + row[2] * z)
}

fn transposed(rotation: &Rotation) -> Rotation {
    std::array::from_fn(|row| std::array::from_fn(|column| rotation[column][row]))
}

fn times(left: &Rotation, right: &Rotation) -> Rotation {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| (0..3).map(|by| left[row][by] * right[by][column]).sum())
    })
}

fn about_x(deg: f64) -> Rotation {
    let (sin, cos) = sine_and_cosine(deg);
    [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]]
}

fn about_y(deg: f64) -> Rotation {
    let (sin, cos) = sine_and_cosine(deg);
    [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]]
}

fn about_z(deg: f64) -> Rotation {
    let (sin, cos) = sine_and_cosine(deg);
    [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]
}

fn sine_and_cosine(deg: f64) -> (f64, f64) {
    deg.to_radians().sin_cos()
}

#[cfg(test)]
mod tests {
    use super::Pose;

    fn same(one: &Pose, other: &Pose) {
        assert!(
            one.distance_mm(other) < 1e-9 && one.angle_deg(other) < 1e-6,
            "{one:?}\n{other:?}"
        );
    }

    #[test]
    fn the_conventions_agree_about_one_axis() {
        let quarter = Pose::kuka([1.0, 2.0, 3.0, 90.0, 0.0, 0.0]);
        let half = 0.5f64.sqrt();
        same(
            &quarter,
            &Pose::abb([1.0, 2.0, 3.0], [half, 0.0, 0.0, half]).unwrap(),
        );
        same(&quarter, &Pose::fixed_xyz([1.0, 2.0, 3.0, 0.0, 0.0, 90.0]));
        same(&quarter, &Pose::staubli([1.0, 2.0, 3.0, 0.0, 0.0, 90.0]));
        let pi_half = std::f64::consts::FRAC_PI_2;
        same(
            &quarter,
            &Pose::rotation_vector([1.0, 2.0, 3.0], [0.0, 0.0, pi_half]),
        );
        // x becomes y.
        let [x, y, z] = quarter.point([10.0, 0.0, 0.0]);
        assert!((x - 1.0).abs() < 1e-12 && (y - 12.0).abs() < 1e-12 && z == 3.0);
    }

    #[test]
    fn fixed_axes_in_reverse_are_moving_axes_and_staubli_turns_in_the_other_order() {
        same(
            &Pose::kuka([0.0, 0.0, 0.0, 30.0, 20.0, 10.0]),
            &Pose::fixed_xyz([0.0, 0.0, 0.0, 10.0, 20.0, 30.0]),
        );
        let staubli = Pose::staubli([0.0, 0.0, 0.0, 10.0, 20.0, 30.0]);
        same(
            &staubli,
            &Pose::staubli([0.0, 0.0, 0.0, 10.0, 0.0, 0.0])
                .then(&Pose::staubli([0.0, 0.0, 0.0, 0.0, 20.0, 0.0]))
                .then(&Pose::staubli([0.0, 0.0, 0.0, 0.0, 0.0, 30.0])),
        );
        assert!(staubli.angle_deg(&Pose::fixed_xyz([0.0, 0.0, 0.0, 10.0, 20.0, 30.0])) > 1.0);
    }

    #[test]
    fn numbers_of_kuka_are_those_of_the_pose_at_every_b() {
        for b in [-90.0, -45.0, 0.0, 60.0, 90.0] {
            let pose = Pose::kuka([1.0, -2.0, 3.0, 100.0, b, -30.0]);
            same(&pose, &Pose::kuka(pose.kuka_numbers()));
            same(&Pose::IDENTITY, &pose.then(&pose.inverse()));
        }
    }

    #[test]
    fn a_quaternion_that_is_no_rotation_is_refused() {
        assert_eq!(Pose::abb([0.0; 3], [0.9, 0.0, 0.0, 0.0]), None);
    }
}

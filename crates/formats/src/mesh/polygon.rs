//! Triangles of a polygon with any number of corners, convex or not.
//!
//! The polygon is projected along the largest component of its normal (Newell: the sum of the cross products of
//! successive corners). A convex one becomes a fan from its first corner; of any other, ears are clipped: corners whose
//! triangle with both neighbours contains no further corner. Every edge of the polygon remains an edge of a triangle,
//! also where corners are on one line (their triangle has no area), so that a closed mesh remains closed.
//!
//! Source: G. H. Meisters, Polygons have ears, American Mathematical Monthly 82 (1975).

/// Twice an area below this part of the square of the size is zero, to rounding.
const NO_AREA: f64 = 1e-14;
/// A polygon that is not convex may have this many corners: the time grows with their square.
const MOST_CORNERS: usize = 1000;
/// Comparisons of a corner with an ear in one file: some seconds.
const MOST_COMPARISONS: u64 = 300_000_000;

/// Why a polygon has no triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PolygonFault {
    /// Its sides cross each other.
    Crossing,
    /// It is not convex and has more than [`MOST_CORNERS`].
    TooManyCorners,
    /// Its file has too many such polygons.
    TooMuchWork,
}

impl PolygonFault {
    /// What is wrong.
    pub fn message(self) -> String {
        match self {
            PolygonFault::Crossing => "the sides of this polygon cross each other".to_owned(),
            PolygonFault::TooManyCorners => {
                format!("a polygon that is not convex has more than {MOST_CORNERS} corners")
            }
            PolygonFault::TooMuchWork => "too many large polygons that are not convex".to_owned(),
        }
    }
}

/// The triangles of the polygon with these corners (at least three), as indices of corners: two fewer than corners.
///
/// `comparisons`: counts the work for all polygons of a file.
///
/// # Errors
/// Sides that cross, too many corners or too much work.
pub(super) fn triangles_of(
    corners: &[[f64; 3]],
    comparisons: &mut u64,
) -> Result<Vec<[usize; 3]>, PolygonFault> {
    let fan = || (1..corners.len().saturating_sub(1)).map(|at| [0, at, at + 1]);
    let Some(flat) = projected(corners) else {
        // All corners on one line are triangles without area; anything else without an area crosses itself.
        let straight = fan().all(|[a, b, c]| is_straight(corners[a], corners[b], corners[c]));
        return if straight {
            Ok(fan().collect())
        } else {
            Err(PolygonFault::Crossing)
        };
    };
    let count = flat.points.len();
    let turn = |a: usize, b: usize, c: usize| flat.doubled_area(a, b, c) >= -flat.zero;
    let convex = fan().all(|[a, b, c]| turn(a, b, c))
        && (0..count).all(|at| turn(at, (at + 1) % count, (at + 2) % count));
    if convex {
        return Ok(fan().collect());
    }
    if count > MOST_CORNERS {
        return Err(PolygonFault::TooManyCorners);
    }
    flat.clipped(comparisons)
}

/// Whether three points are on one line, to rounding.
pub(super) fn is_straight(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    let [u, v] = [minus(b, a), minus(c, a)];
    let square = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    square(cross(u, v)).sqrt() <= 8.0 * f64::EPSILON * (square(u) * square(v)).sqrt()
}

/// `a - b`.
pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The cross product.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A polygon in a plane, counter-clockwise.
struct Flat {
    points: Vec<[f64; 2]>,
    /// Twice an area that is zero to rounding.
    zero: f64,
}

/// The projection of a polygon along the largest component of its normal; `None` if it has no area.
fn projected(corners: &[[f64; 3]]) -> Option<Flat> {
    let first = *corners.first()?;
    let mut normal = [0.0; 3];
    let mut size: f64 = 0.0;
    for pair in corners.windows(2) {
        let [a, b] = [minus(pair[0], first), minus(pair[1], first)];
        let part = cross(a, b);
        for axis in 0..3 {
            normal[axis] += part[axis];
            size = size.max(b[axis].abs());
        }
    }
    let largest = (0..3).max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))?;
    let zero = NO_AREA * size * size;
    if normal[largest].abs() <= zero * corners.len() as f64 {
        return None;
    }
    // The two other axes, in the order that makes the projection counter-clockwise.
    let mut axes = [(largest + 1) % 3, (largest + 2) % 3];
    if normal[largest] < 0.0 {
        axes.reverse();
    }
    let points = corners
        .iter()
        .map(|corner| axes.map(|axis| corner[axis] - first[axis]))
        .collect();
    Some(Flat { points, zero })
}

impl Flat {
    /// Twice the area of a triangle of three corners, positive if they turn counter-clockwise.
    fn doubled_area(&self, a: usize, b: usize, c: usize) -> f64 {
        let [a, b, c] = [a, b, c].map(|at| self.points[at]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// The triangles, ear by ear.
    fn clipped(&self, comparisons: &mut u64) -> Result<Vec<[usize; 3]>, PolygonFault> {
        let mut ring: Vec<usize> = (0..self.points.len()).collect();
        let mut triangles = Vec::with_capacity(ring.len());
        let mut from = 0;
        while ring.len() > 3 {
            let around = |at: usize| {
                let count = ring.len();
                [ring[(at + count - 1) % count], ring[at], ring[(at + 1) % count]]
            };
            let mut chosen = None;
            for offset in 0..ring.len() {
                let at = (from + offset) % ring.len();
                *comparisons += ring.len() as u64;
                if *comparisons > MOST_COMPARISONS {
                    return Err(PolygonFault::TooMuchWork);
                }
                if self.is_ear(around(at), &ring) {
                    chosen = Some(at);
                    break;
                }
            }
            // Without an ear only a corner on the line of its neighbours may go.
            let straight = |at: &usize| {
                let [a, b, c] = around(*at);
                self.doubled_area(a, b, c).abs() <= self.zero
            };
            let at = chosen
                .or_else(|| (0..ring.len()).find(straight))
                .ok_or(PolygonFault::Crossing)?;
            triangles.push(around(at));
            ring.remove(at);
            // The next ear is looked for at the other side, so that triangles do not all meet in one corner.
            from = at % ring.len();
        }
        let [a, b, c] = [ring[0], ring[1], ring[2]];
        if self.doubled_area(a, b, c) < -self.zero {
            return Err(PolygonFault::Crossing);
        }
        triangles.push([a, b, c]);
        Ok(triangles)
    }

    /// Whether a corner turns to the left, and its triangle with both neighbours contains no other corner.
    fn is_ear(&self, [a, b, c]: [usize; 3], ring: &[usize]) -> bool {
        if self.doubled_area(a, b, c) <= self.zero {
            return false;
        }
        let ear = [a, b, c].map(|at| self.points[at]);
        !ring.iter().any(|&other| {
            // Corners at the same place as one of the ear are where two sides touch.
            !ear.contains(&self.points[other])
                && self.doubled_area(a, b, other) >= -self.zero
                && self.doubled_area(b, c, other) >= -self.zero
                && self.doubled_area(c, a, other) >= -self.zero
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area of each triangle along z; their sum must be that of the polygon (shoelace).
    fn areas(corners: &[[f64; 3]]) -> Result<Vec<f64>, PolygonFault> {
        let triangles = triangles_of(corners, &mut 0)?;
        assert_eq!(triangles.len(), corners.len() - 2);
        let area = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|at| corners[at]);
            cross(minus(b, a), minus(c, a))[2] / 2.0
        };
        Ok(triangles.iter().map(area).collect())
    }

    fn flat(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
        points.iter().map(|[x, y]| [*x, *y, 0.0]).collect()
    }

    const ARROW: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];

    #[test]
    fn a_convex_polygon_is_a_fan() {
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(triangles_of(&square, &mut 0), Ok(vec![[0, 1, 2], [0, 2, 3]]));
    }

    #[test]
    fn the_area_of_a_polygon_that_is_not_convex_is_that_of_its_triangles() {
        // From every corner, in both directions: the shoelace area of the arrow is 4.
        for start in 0..4 {
            let mut turned = ARROW;
            turned.rotate_left(start);
            let found = areas(&flat(&turned)).unwrap();
            assert!(found.iter().all(|area| *area > 0.0), "{found:?}");
            assert!((found.iter().sum::<f64>() - 4.0).abs() < 1e-15);
            turned.reverse();
            let found = areas(&flat(&turned)).unwrap();
            assert!((found.iter().sum::<f64>() + 4.0).abs() < 1e-15);
        }
        // A comb of 20 teeth, 1 wide and 9 high, on a base of height 1.
        let mut comb = vec![[0.0, 0.0], [40.0, 0.0]];
        for tooth in (0..20).rev() {
            let x = 2.0 * f64::from(tooth);
            comb.extend([
                [x + 2.0, 1.0],
                [x + 1.0, 1.0],
                [x + 1.0, 10.0],
                [x, 10.0],
                [x, 1.0],
            ]);
        }
        comb.pop();
        comb.push([0.0, 5.0]);
        let found = areas(&flat(&comb)).unwrap();
        assert!(found.iter().all(|area| *area >= 0.0), "{found:?}");
        assert!((found.iter().sum::<f64>() - (40.0 + 20.0 * 9.0)).abs() < 1e-12);
    }

    #[test]
    fn corners_on_a_side_remain_corners_of_triangles() {
        let notched = [
            [0.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [1.0, 1.0],
            [0.0, 4.0],
            [0.0, 2.0],
        ];
        let triangles = triangles_of(&flat(&notched), &mut 0).unwrap();
        for side in 0..6 {
            let next = (side + 1) % 6;
            let with_side = triangles
                .iter()
                .filter(|triangle| (0..3).any(|at| triangle[at] == side && triangle[(at + 1) % 3] == next));
            assert_eq!(with_side.count(), 1, "side {side} of {triangles:?}");
        }
    }

    #[test]
    fn a_polygon_with_a_bridge_to_its_hole_is_complete() {
        let keyhole = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ];
        let found = areas(&flat(&keyhole)).unwrap();
        assert!((found.iter().sum::<f64>() - 8.0).abs() < 1e-14, "{found:?}");
        assert!(found.iter().all(|area| *area >= 0.0), "{found:?}");
    }

    #[test]
    fn crossing_sides_are_refused() {
        let bow = flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(triangles_of(&bow, &mut 0), Err(PolygonFault::Crossing));
        let star = [0.0_f64, 144.0, 288.0, 72.0, 216.0].map(|deg| {
            let (sin, cos) = deg.to_radians().sin_cos();
            [cos, sin, 0.0]
        });
        assert_eq!(triangles_of(&star, &mut 0), Err(PolygonFault::Crossing));
    }

    #[test]
    fn corners_on_one_line_have_triangles_without_area() {
        let line = flat(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]);
        assert_eq!(areas(&line).unwrap(), [0.0, 0.0]);
    }

    #[test]
    fn a_vertical_polygon_is_projected_along_another_axis() {
        let upright: Vec<[f64; 3]> = ARROW.iter().map(|[x, y]| [5.0, *x, *y]).collect();
        let triangles = triangles_of(&upright, &mut 0).unwrap();
        let area = triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|at| upright[at]);
            cross(minus(b, a), minus(c, a))[0] / 2.0
        });
        assert!((area.sum::<f64>() - 4.0).abs() < 1e-15);
    }

    #[test]
    fn too_many_corners_and_too_much_work_are_refused() {
        let mut saw: Vec<[f64; 2]> = (0..1200).map(|x| [f64::from(x), f64::from(x % 2)]).collect();
        saw.push([600.0, 1e4]);
        assert_eq!(
            triangles_of(&flat(&saw), &mut 0),
            Err(PolygonFault::TooManyCorners)
        );
        let mut comparisons = MOST_COMPARISONS;
        assert_eq!(
            triangles_of(&flat(&ARROW), &mut comparisons),
            Err(PolygonFault::TooMuchWork)
        );
    }
}

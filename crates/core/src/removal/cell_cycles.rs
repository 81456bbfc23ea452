//! The pieces of surface in a cell of the lattice: cycles through its crossed edges.
//!
//! Each crossed edge is on two faces of the cell. A face with two crossed edges joins them; one with four (two corners in material, diagonally) joins those around
//! each of the corners in material. Each cycle gets one vertex, so that material which meets along an edge stays two solids.
//!
//! If both pairs of a face are of one cycle in both of its cells, the edge between their two vertices would belong to four triangles: then the face joins the edges around
//! the corners without material instead. A cell with such a face has no other with four crossed edges (tested for all 256 cells), so that
//! the order of these decisions does not matter.
//!
//! | number | meaning |
//! |---|---|
//! | corner | bits 0, 1, 2: at the upper side in x, y, z |
//! | edge | 4 axis + first + 2 second: at the upper side of the two directions across the axis, in order |
//! | face | 2 axis, + 1 at the upper side |
//!
//! Source: Nielson 2004, *Dual marching cubes*, IEEE Visualization; Wenger 2013, *Isosurfaces*, CRC Press (the faces that join otherwise)
//! \[recalled\]; the rule by cycles is derived.

use super::swept::across;

/// The cycles of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cycles {
    /// For each edge its cycle; of an edge that is not crossed [`NOT_CROSSED`].
    pub(super) of_edge: [u8; 12],
    /// Number of cycles.
    pub(super) count: u8,
    /// The face whose two pairs are of one cycle.
    pub(super) doubled_face: Option<u8>,
}

/// No cycle.
pub(super) const NOT_CROSSED: u8 = u8::MAX;

/// The edge between two corners next to each other.
fn edge_between(one: usize, other: usize) -> usize {
    let axis = (one ^ other).trailing_zeros() as usize;
    let [i, j] = across(axis);
    4 * axis + (one >> i & 1) + 2 * (one >> j & 1)
}

/// The corners of a face, once round.
fn corners_of(face: usize) -> [usize; 4] {
    let axis = face / 2;
    let [i, j] = across(axis);
    let first = (face % 2) << axis;
    [first, first | 1 << i, first | 1 << i | 1 << j, first | 1 << j]
}

impl Cycles {
    /// Of the cell whose corners in material are the bits of `mask`; the face `otherwise` joins the edges around corners without
    /// material.
    pub(super) fn new(mask: u8, otherwise: Option<u8>) -> Cycles {
        let is_inside = |corner: usize| mask >> corner & 1 == 1;
        // The least edge that each edge is joined with.
        let mut least: [usize; 12] = std::array::from_fn(|edge| edge);
        let mut is_crossed = [false; 12];
        let mut four_crossed = [false; 6];
        for (face, is_four) in four_crossed.iter_mut().enumerate() {
            let corners = corners_of(face);
            // Between each corner and the next one.
            let edges = [0, 1, 2, 3].map(|n| edge_between(corners[n], corners[(n + 1) % 4]));
            let crossed = [0, 1, 2, 3].map(|n| is_inside(corners[n]) != is_inside(corners[(n + 1) % 4]));
            for n in 0..4 {
                is_crossed[edges[n]] |= crossed[n];
            }
            let mut join = |one: usize, other: usize| {
                let (low, high) = (least[one].min(least[other]), least[one].max(least[other]));
                for edge in &mut least {
                    if *edge == high {
                        *edge = low;
                    }
                }
            };
            *is_four = crossed == [true; 4];
            if *is_four {
                let around_inside = otherwise != Some(face as u8);
                for n in (0..4).filter(|n| is_inside(corners[*n]) == around_inside) {
                    join(edges[(n + 3) % 4], edges[n]);
                }
            } else {
                let mut crossed = (0..4).filter(|n| crossed[*n]).map(|n| edges[n]);
                if let (Some(one), Some(other)) = (crossed.next(), crossed.next()) {
                    join(one, other);
                }
            }
        }
        let mut of_edge = [NOT_CROSSED; 12];
        let mut count = 0;
        for edge in (0..12).filter(|edge| is_crossed[*edge]) {
            of_edge[edge] = if least[edge] == edge {
                count += 1;
                count - 1
            } else {
                of_edge[least[edge]]
            };
        }
        let is_doubled = |face: &usize| {
            let corners = corners_of(*face);
            let of = |n: usize| of_edge[edge_between(corners[n], corners[(n + 1) % 4])];
            four_crossed[*face] && (1..4).all(|n| of(n) == of(0))
        };
        Cycles {
            of_edge,
            count,
            doubled_face: (0..6).find(is_doubled).map(|face| face as u8),
        }
    }

    /// Of all cells, by their corners in material.
    pub(super) fn of_all() -> Vec<Cycles> {
        (0..=u8::MAX).map(|mask| Cycles::new(mask, None)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn four_crossed_faces(mask: u8) -> usize {
        let is_four = |face: &usize| {
            let inside = corners_of(*face).map(|corner| mask >> corner & 1 == 1);
            inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1]
        };
        (0..6).filter(is_four).count()
    }

    #[test]
    fn edges_have_their_two_corners() {
        for edge in 0..12 {
            let (axis, [i, j]) = (edge / 4, across(edge / 4));
            let low = (edge & 1) << i | (edge >> 1 & 1) << j;
            assert_eq!(edge_between(low, low | 1 << axis), edge);
        }
    }

    #[test]
    fn simple_cells_have_the_cycles_of_their_corners() {
        assert_eq!(Cycles::new(0, None).count, 0);
        assert_eq!(Cycles::new(0xff, None).count, 0);
        for corner in 0..8 {
            let cycles = Cycles::new(1 << corner, None);
            assert_eq!(cycles.count, 1);
            assert_eq!(cycles.of_edge.iter().filter(|cycle| **cycle == 0).count(), 3);
        }
        // Two corners diagonally on a face and in space: two cycles. Four that are no two of them neighbours: four.
        assert_eq!(Cycles::new(1 | 1 << 3, None).count, 2);
        assert_eq!(Cycles::new(1 | 1 << 7, None).count, 2);
        assert_eq!(Cycles::new(1 | 1 << 3 | 1 << 5 | 1 << 6, None).count, 4);
        // The same without material: one surface around each corner in material.
        assert_eq!(Cycles::new(!(1 | 1 << 7), None).count, 2);
    }

    #[test]
    fn a_face_with_one_cycle_twice_is_the_only_one_with_four_crossed_edges_and_can_be_joined_otherwise() {
        let mut doubled = 0;
        for mask in 0..=u8::MAX {
            let Some(face) = Cycles::new(mask, None).doubled_face else {
                continue;
            };
            doubled += 1;
            assert_eq!(four_crossed_faces(mask), 1, "{mask}");
            let other = Cycles::new(mask, Some(face));
            assert_eq!(other.doubled_face, None, "{mask}");
            assert_eq!(other.count, 2, "{mask}");
        }
        // Six corners in material and two diagonally on a face without: 12; five, with one of its neighbours off the face as well: 24 (counted by
        // a script that shares no code).
        assert_eq!(doubled, 36);
    }

    #[test]
    fn each_crossed_edge_has_a_cycle_of_at_least_three() {
        for (mask, cycles) in Cycles::of_all().iter().enumerate() {
            for edge in 0..12 {
                let (axis, [i, j]) = (edge / 4, across(edge / 4));
                let low = (edge & 1) << i | (edge >> 1 & 1) << j;
                let differ = (mask >> low & 1) != (mask >> (low | 1 << axis) & 1);
                assert_eq!(cycles.of_edge[edge] != NOT_CROSSED, differ, "{mask} {edge}");
            }
            for cycle in 0..cycles.count {
                assert!(cycles.of_edge.iter().filter(|of| **of == cycle).count() >= 3);
            }
        }
    }
}

//! Dexels: straight lines with the material along them, in square tiles.
//!
//! A dexel is the interval from its lowest to its highest material, less the gaps between. Most dexels have no gap: the
//! interval is stored in place, gaps in a list of the tile. Coordinates along the dexel are relative to the box of the part,
//! in single precision: 6e-8 relative, 12 nm in 200 mm.
//!
//! Each end of material has an origin: the move that made it, or the face of the stock. Where a later move meets a surface
//! exactly, the first origin stays.

use std::cmp::Ordering;

/// The origin of an end: a move, or a face of the stock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EndOrigin {
    /// The move with this index.
    Move(u32),
    /// A face of the stock; of a mesh the number of the triangle.
    Stock(u32),
}

/// Least index that a move cannot have: one bit marks the stock.
pub(super) const STOCK: u32 = 1 << 31;

impl EndOrigin {
    /// The index of the move; `None` of the stock.
    pub fn move_index(self) -> Option<usize> {
        match self {
            EndOrigin::Move(index) => Some(index as usize),
            EndOrigin::Stock(_) => None,
        }
    }

    pub(super) fn of_code(code: u32) -> EndOrigin {
        if code >= STOCK {
            EndOrigin::Stock(code - STOCK)
        } else {
            EndOrigin::Move(code)
        }
    }
}

/// Material along a dexel: coordinates and codes of the origins of both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    /// m
    pub(super) low: f32,
    /// m
    pub(super) high: f32,
    pub(super) low_origin: u32,
    pub(super) high_origin: u32,
}

/// No material.
const EMPTY: Span = Span {
    low: f32::INFINITY,
    high: f32::NEG_INFINITY,
    low_origin: STOCK,
    high_origin: STOCK,
};

/// A gap without material, and the next one of the same dexel, upwards.
#[derive(Clone, Copy, Debug)]
struct Gap {
    /// Its ends with the origins of the surfaces there.
    span: Span,
    next: u32,
}

/// No gap.
const NONE: u32 = u32::MAX;

/// Sides of a tile, in dexels.
pub(super) const TILE: usize = 32;

/// A square of dexels.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    /// Its first cell.
    pub(super) first: [usize; 2],
    /// Cells along both directions.
    pub(super) size: [usize; 2],
    /// From the lowest to the highest material.
    spans: Vec<Span>,
    /// The first gap of each dexel; empty while no dexel has one.
    first_gaps: Vec<u32>,
    gaps: Vec<Gap>,
    /// The first of the gaps that are not used.
    unused: u32,
}

impl Tile {
    /// Without material.
    pub(super) fn new(first: [usize; 2], size: [usize; 2]) -> Tile {
        Tile {
            first,
            size,
            spans: vec![EMPTY; size[0] * size[1]],
            first_gaps: Vec::new(),
            gaps: Vec::new(),
            unused: NONE,
        }
    }

    /// The number of the dexel in a cell, both relative to the tile.
    pub(super) fn number(&self, cell: [usize; 2]) -> usize {
        cell[1] * self.size[0] + cell[0]
    }

    /// From the lowest to the highest material of a dexel.
    pub(super) fn hull(&self, dexel: usize) -> &Span {
        &self.spans[dexel]
    }

    /// Sets the material of an empty dexel: spans from low to high, without contact.
    pub(super) fn fill(&mut self, dexel: usize, material: &[Span]) {
        let (Some(first), Some(last)) = (material.first(), material.last()) else {
            return;
        };
        self.spans[dexel] = Span {
            high: last.high,
            high_origin: last.high_origin,
            ..*first
        };
        for (below, above) in material.iter().zip(material.iter().skip(1)).rev() {
            let span = Span {
                low: below.high,
                high: above.low,
                low_origin: below.high_origin,
                high_origin: above.low_origin,
            };
            let next = self.first_gap(dexel);
            let gap = self.gap(span, next);
            self.set_first_gap(dexel, gap);
        }
    }

    /// The material of a dexel, from low to high.
    pub(super) fn material(&self, dexel: usize) -> impl Iterator<Item = Span> {
        let hull = self.spans[dexel];
        let mut rest = (hull.low < hull.high).then_some((hull.low, hull.low_origin));
        let mut gap = self.first_gap(dexel);
        std::iter::from_fn(move || {
            let (low, low_origin) = rest?;
            let span = match self.gaps.get(gap as usize) {
                Some(found) => {
                    gap = found.next;
                    rest = Some((found.span.high, found.span.high_origin));
                    (found.span.low, found.span.low_origin)
                }
                None => {
                    rest = None;
                    (hull.high, hull.high_origin)
                }
            };
            Some(Span {
                low,
                low_origin,
                high: span.0,
                high_origin: span.1,
            })
        })
    }

    /// Length of the material of a dexel between two coordinates, m.
    pub(super) fn length_within(&self, dexel: usize, [low, high]: [f32; 2]) -> f64 {
        self.material(dexel)
            .map(|span| f64::from(span.high.min(high)) - f64::from(span.low.max(low)))
            .filter(|length| *length > 0.0)
            .sum()
    }

    /// Whether there is no material between two coordinates.
    #[inline]
    pub(super) fn is_clear(&self, dexel: usize, [low, high]: [f32; 2]) -> bool {
        let hull = &self.spans[dexel];
        if hull.high <= low || hull.low >= high {
            return true;
        }
        if self.first_gaps.is_empty() {
            return false;
        }
        let mut gap = self.first_gaps[dexel];
        while let Some(found) = self.gaps.get(gap as usize) {
            if found.span.low > low {
                return false;
            }
            if found.span.high >= high {
                return true;
            }
            gap = found.next;
        }
        false
    }

    /// Removes the material between two coordinates; gives the length removed, m.
    pub(super) fn remove(&mut self, dexel: usize, [low, high]: [f32; 2], origin: u32) -> f64 {
        if low.partial_cmp(&high) != Some(Ordering::Less) || self.is_clear(dexel, [low, high]) {
            return 0.0;
        }
        let removed = self.length_within(dexel, [low, high]);
        let hull = self.spans[dexel];
        match (low <= hull.low, high >= hull.high) {
            (true, true) => {
                self.spans[dexel] = EMPTY;
                self.cut_list(dexel, NONE, NONE);
            }
            (true, false) => self.raise(dexel, high, origin),
            (false, true) => self.lower(dexel, low, origin),
            (false, false) => self.open(dexel, [low, high], origin),
        }
        removed
    }

    /// Removes all below `high`, which is within the dexel.
    fn raise(&mut self, dexel: usize, high: f32, origin: u32) {
        let (mut low, mut low_origin) = (high, origin);
        let mut gap = self.first_gap(dexel);
        while let Some(&Gap { span, next }) = self.gaps.get(gap as usize) {
            if span.low > low {
                break;
            }
            if span.high >= low {
                (low, low_origin) = (span.high, span.high_origin);
            }
            self.release(gap);
            gap = next;
        }
        self.set_first_gap(dexel, gap);
        let hull = &mut self.spans[dexel];
        (hull.low, hull.low_origin) = (low, low_origin);
    }

    /// Removes all above `low`, which is within the dexel.
    fn lower(&mut self, dexel: usize, low: f32, origin: u32) {
        let (mut before, mut gap) = (NONE, self.first_gap(dexel));
        let (mut high, mut high_origin) = (low, origin);
        while let Some(&Gap { span, next }) = self.gaps.get(gap as usize) {
            if span.high >= low {
                if span.low <= low {
                    (high, high_origin) = (span.low, span.low_origin);
                }
                break;
            }
            (before, gap) = (gap, next);
        }
        self.cut_list(dexel, before, NONE);
        let hull = &mut self.spans[dexel];
        (hull.high, hull.high_origin) = (high, high_origin);
    }

    /// Opens a gap within the dexel.
    fn open(&mut self, dexel: usize, [low, high]: [f32; 2], origin: u32) {
        let mut opened = Span {
            low,
            high,
            low_origin: origin,
            high_origin: origin,
        };
        let (mut before, mut gap) = (NONE, self.first_gap(dexel));
        while let Some(&Gap { span, next }) = self.gaps.get(gap as usize) {
            if span.high >= low {
                break;
            }
            (before, gap) = (gap, next);
        }
        // Gaps that it meets become part of it.
        while let Some(&Gap { span, next }) = self.gaps.get(gap as usize) {
            if span.low > opened.high {
                break;
            }
            if span.low <= opened.low {
                (opened.low, opened.low_origin) = (span.low, span.low_origin);
            }
            if span.high >= opened.high {
                (opened.high, opened.high_origin) = (span.high, span.high_origin);
            }
            self.release(gap);
            gap = next;
        }
        let new = self.gap(opened, gap);
        self.link(dexel, before, new);
    }

    fn first_gap(&self, dexel: usize) -> u32 {
        self.first_gaps.get(dexel).copied().unwrap_or(NONE)
    }

    fn set_first_gap(&mut self, dexel: usize, gap: u32) {
        if self.first_gaps.is_empty() {
            if gap == NONE {
                return;
            }
            self.first_gaps = vec![NONE; self.spans.len()];
        }
        self.first_gaps[dexel] = gap;
    }

    /// Makes `gap` the one behind `before`, or the first one.
    fn link(&mut self, dexel: usize, before: u32, gap: u32) {
        match self.gaps.get_mut(before as usize) {
            Some(before) => before.next = gap,
            None => self.set_first_gap(dexel, gap),
        }
    }

    /// Ends the list of a dexel behind `before`, with `rest` behind it.
    fn cut_list(&mut self, dexel: usize, before: u32, rest: u32) {
        let mut gap = match self.gaps.get(before as usize) {
            Some(before) => before.next,
            None => self.first_gap(dexel),
        };
        self.link(dexel, before, rest);
        while let Some(&Gap { next, .. }) = self.gaps.get(gap as usize) {
            self.release(gap);
            gap = next;
        }
    }

    fn gap(&mut self, span: Span, next: u32) -> u32 {
        let gap = self.unused;
        match self.gaps.get_mut(gap as usize) {
            Some(place) => {
                self.unused = place.next;
                *place = Gap { span, next };
                gap
            }
            None => {
                self.gaps.push(Gap { span, next });
                (self.gaps.len() - 1) as u32
            }
        }
    }

    fn release(&mut self, gap: u32) {
        self.gaps[gap as usize].next = self.unused;
        self.unused = gap;
    }

    /// Memory in use, bytes.
    pub(super) fn bytes(&self) -> usize {
        self.spans.capacity() * size_of::<Span>()
            + self.first_gaps.capacity() * size_of::<u32>()
            + self.gaps.capacity() * size_of::<Gap>()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn full() -> Tile {
        let mut tile = Tile::new([0, 0], [1, 1]);
        let span = Span {
            low: 0.0,
            high: 100.0,
            low_origin: STOCK,
            high_origin: STOCK + 1,
        };
        tile.fill(0, &[span]);
        tile
    }

    proptest! {
        #[test]
        fn removal_equals_that_of_a_list_of_cells(cuts in prop::collection::vec((0_usize..110, 0_usize..60), 0..40)) {
            // Whole coordinates: the material is a list of unit cells, each end the origin of the cut that made it.
            let mut tile = full();
            let mut cells = [true; 100];
            for (n, &(low, length)) in cuts.iter().enumerate() {
                let high = (low + length).min(120);
                let before = cells.iter().filter(|cell| **cell).count();
                for cell in cells.iter_mut().take(high).skip(low) {
                    *cell = false;
                }
                let removed = before - cells.iter().filter(|cell| **cell).count();
                let found = tile.remove(0, [low as f32, high as f32], n as u32);
                prop_assert_eq!(found, removed as f64);
                let spans: Vec<Span> = tile.material(0).collect();
                prop_assert!(spans.iter().all(|span| span.low < span.high));
                prop_assert!(spans.windows(2).all(|pair| pair[0].high < pair[1].low));
                for (at, cell) in cells.iter().enumerate() {
                    let middle = at as f32 + 0.5;
                    let inside = spans.iter().any(|span| span.low < middle && middle < span.high);
                    prop_assert_eq!(inside, *cell, "{}", at);
                }
                // The origin of an end is a cut that ends there, the first of them.
                for span in &spans {
                    for (place, code, begins) in [(span.low, span.low_origin, false), (span.high, span.high_origin, true)] {
                        let EndOrigin::Move(cut) = EndOrigin::of_code(code) else {
                            prop_assert!(place == 0.0 || place == 100.0);
                            continue;
                        };
                        let (low, length) = cuts[cut as usize];
                        let end = if begins { low } else { (low + length).min(120) };
                        prop_assert_eq!(end as f32, place);
                    }
                }
            }
        }
    }

    #[test]
    fn a_surface_that_is_cut_twice_keeps_its_first_origin() {
        let mut tile = full();
        tile.remove(0, [40.0, 120.0], 1);
        tile.remove(0, [40.0, 130.0], 2);
        assert_eq!(EndOrigin::of_code(tile.hull(0).high_origin), EndOrigin::Move(1));
        tile.remove(0, [10.0, 20.0], 3);
        tile.remove(0, [10.0, 25.0], 4);
        let origins: Vec<[u32; 2]> = tile
            .material(0)
            .map(|span| [span.low_origin, span.high_origin])
            .collect();
        assert_eq!(origins, [[STOCK, 3], [4, 1]]);
        assert_eq!(tile.remove(0, [-1.0, 200.0], 5), 10.0 + 15.0);
        assert_eq!(tile.material(0).count(), 0);
        assert_eq!(tile.remove(0, [-1.0, 200.0], 6), 0.0);
    }

    #[test]
    fn gaps_that_are_gone_are_used_again() {
        let mut tile = full();
        for round in 0..50 {
            for n in 0..10_u32 {
                let low = 5.0 + 9.0 * n as f32;
                tile.remove(0, [low, low + 1.0 + 0.1 * round as f32], n);
            }
        }
        assert!(tile.gaps.len() <= 10);
        let bytes = tile.bytes();
        assert!(bytes < 1000, "{bytes}");
    }
}

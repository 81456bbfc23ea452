//! Level lines of a fine lattice, as closed areas and as open lines, in the units of its axes.
//!
//! The crate `contour` places a sample at the centre of its cell and closes areas half a cell outside the lattice:
//! taking half a step off and cutting at the lattice's edge puts every sample where it belongs.
//!
//! | space | horizontal | vertical |
//! |---|---|---|
//! | index | 0 to `nx - 1` | 0 to `ny - 1`, from the first row |
//! | values | as the axes give them, rising or falling, steps of any size | the same |
//!
//! The level lines are found in index space (marching squares with straight pieces between crossings) and
//! carried into values cell by cell.

/// A horizontal and a vertical value.
type Pair = [f64; 2];

/// One closed line around an area, or around a hole in it; its last point is its first.
pub(crate) type Ring = Vec<Pair>;

/// A lattice of samples. Not checked: that each axis rises or falls steadily.
#[derive(Clone, Copy)]
pub(crate) struct Lattice<'a> {
    /// Values of the columns.
    pub(crate) horizontal: &'a [f64],
    /// Values of the rows.
    pub(crate) vertical: &'a [f64],
    /// Row by row, each from the first column to the last.
    pub(crate) samples: &'a [f64],
}

impl Lattice<'_> {
    /// For each level, the rings of the area where the samples are at least that level (even-odd rule). Where
    /// the area reaches the edge of the lattice, its ring runs along the edge. No ring for a lattice below 2 x
    /// 2, with a wrong number of samples or with one that is not finite.
    pub(crate) fn areas_from(&self, levels: &[f64]) -> Vec<Vec<Ring>> {
        let index_rings = self.index_rings(levels);
        let on_lattice = |ring: Vec<Pair>| ring.into_iter().map(|p| self.at(p)).collect();
        index_rings
            .into_iter()
            .map(|rings| rings.into_iter().map(on_lattice).collect())
            .collect()
    }

    /// For each level, the lines along which the samples equal it; the edge of the lattice is not part of them.
    /// A line that closes in itself ends at its first point.
    pub(crate) fn lines_at(&self, levels: &[f64]) -> Vec<Vec<Vec<Pair>>> {
        let index_rings = self.index_rings(levels);
        index_rings
            .into_iter()
            .map(|rings| {
                let lines = rings.iter().flat_map(|ring| self.inner_lines(ring));
                lines
                    .map(|line| line.into_iter().map(|p| self.at(p)).collect())
                    .collect()
            })
            .collect()
    }

    /// For each level the rings in index space: half a cell taken off and cut at the lattice's edge.
    fn index_rings(&self, levels: &[f64]) -> Vec<Vec<Vec<Pair>>> {
        let (nx, ny) = (self.horizontal.len(), self.vertical.len());
        if nx < 2 || ny < 2 || self.samples.len() != nx * ny || self.samples.iter().any(|s| !s.is_finite()) {
            return vec![Vec::new(); levels.len()];
        }
        let builder = contour::ContourBuilder::new(nx, ny, true);
        let edge = [(nx - 1) as f64, (ny - 1) as f64];
        let mut all = vec![Vec::new(); levels.len()];
        let Ok(contours) = builder.contours(self.samples, levels) else {
            return all;
        };
        for (rings, contour) in all.iter_mut().zip(contours) {
            for polygon in contour.geometry() {
                for line in std::iter::once(polygon.exterior()).chain(polygon.interiors()) {
                    let ring: Vec<Pair> = line
                        .coords()
                        .map(|c| [(c.x - 0.5).clamp(0.0, edge[0]), (c.y - 0.5).clamp(0.0, edge[1])])
                        .collect();
                    rings.push(ring);
                }
            }
        }
        all
    }

    /// The parts of a ring that do not run along the edge.
    fn inner_lines(&self, ring: &[Pair]) -> Vec<Vec<Pair>> {
        let edge = [
            (self.horizontal.len() - 1) as f64,
            (self.vertical.len() - 1) as f64,
        ];
        let along_edge =
            |a: Pair, b: Pair| a == b || (0..2).any(|k| a[k] == b[k] && (a[k] == 0.0 || a[k] == edge[k]));
        let mut lines: Vec<Vec<Pair>> = Vec::new();
        let mut open = false;
        for w in ring.windows(2) {
            if along_edge(w[0], w[1]) {
                open = open && w[0] == w[1];
                continue;
            }
            match lines.last_mut() {
                Some(line) if open => line.push(w[1]),
                _ => lines.push(vec![w[0], w[1]]),
            }
            open = true;
        }
        // A ring cut by the edge starts anywhere: its last part runs on into its first.
        if lines.len() > 1
            && lines.last().and_then(|l| l.last()) == lines.first().and_then(|l| l.first())
            && let Some(mut tail) = lines.pop()
        {
            tail.extend_from_slice(&lines[0][1..]);
            lines[0] = tail;
        }
        lines
    }

    /// From index space to values.
    fn at(&self, index: Pair) -> Pair {
        [
            between(self.horizontal, index[0]),
            between(self.vertical, index[1]),
        ]
    }
}

/// The value at an index that need not be whole, straight between the two neighbours.
fn between(values: &[f64], index: f64) -> f64 {
    let k = (index.floor() as usize).min(values.len().saturating_sub(2));
    let t = index - k as f64;
    values[k] + (values[k + 1] - values[k]) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: [f64; 3] = [0.0, 10.0, 30.0];
    const Y: [f64; 2] = [0.0, 5.0];

    fn lattice(samples: &[f64]) -> Lattice<'_> {
        Lattice {
            horizontal: &X,
            vertical: &Y,
            samples,
        }
    }

    #[test]
    fn a_line_passes_where_the_samples_equal_the_level() {
        // 0, 1, 3 at 0, 10, 30 mm: level 2 is half-way between 10 and 30 mm.
        let lines = lattice(&[0.0, 1.0, 3.0, 0.0, 1.0, 3.0]).lines_at(&[2.0]);
        assert_eq!(lines[0].len(), 1);
        assert!(lines[0][0].iter().all(|p| (p[0] - 20.0).abs() < 1e-9));
        let ys: Vec<f64> = lines[0][0].iter().map(|p| p[1]).collect();
        assert!(
            ys.contains(&0.0) && ys.contains(&5.0),
            "from edge to edge: {ys:?}"
        );
    }

    #[test]
    fn an_area_reaches_the_edge_and_not_beyond() {
        let areas = lattice(&[1.0; 6]).areas_from(&[0.5]);
        let xs = crate::axis::extent(areas[0].iter().flatten().map(|p| p[0]));
        assert_eq!(xs, Some((0.0, 30.0)));
        assert!(lattice(&[1.0; 6]).lines_at(&[0.5])[0].is_empty());
    }

    #[test]
    fn invalid_samples_give_nothing() {
        assert!(lattice(&[f64::NAN; 6]).areas_from(&[0.5])[0].is_empty());
        assert!(lattice(&[1.0]).lines_at(&[0.5])[0].is_empty());
    }
}

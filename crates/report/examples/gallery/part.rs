//! A part with a pocket.

use armill_report::{PartView, PlaceMark};

/// The pictures of this file.
pub fn pictures() -> Vec<(&'static str, String)> {
    vec![("part_view", pocket().to_svg())]
}

/// A plate of 100 x 60 mm with a round dish: a grid of heights, with deviations that grow to one side.
fn pocket() -> PartView {
    const SIDES: [usize; 2] = [101, 61];
    let height = |x: f64, y: f64| {
        let off = ((x - 50.0) / 35.0).powi(2) + ((y - 30.0) / 22.0).powi(2);
        -12.0 * (1.0 - off).max(0.0).sqrt()
    };
    let mut view = PartView {
        title: "Dish in a plate".into(),
        subtitle: "made-up deviations; the rim is not made by the program".into(),
        quantity: "deviation (µm): + material left, − gouged".into(),
        tolerance_um: Some(60.0),
        marks: vec![PlaceMark {
            at_mm: [78.0, 30.0, height(78.0, 30.0)],
            label: "1".into(),
        }],
        ..PartView::default()
    };
    for j in 0..SIDES[1] {
        for i in 0..SIDES[0] {
            let (x, y) = (i as f64, j as f64);
            let slope = |dx: f64, dy: f64| (height(x + dx, y + dy) - height(x - dx, y - dy)) / 1.0;
            let normal = [-slope(0.5, 0.0), -slope(0.0, 0.5), 1.0];
            let length = normal.iter().map(|part| part * part).sum::<f64>().sqrt();
            view.vertices_mm.push([x, y, height(x, y)]);
            view.normals.push(normal.map(|part| part / length));
            let is_made = height(x, y) < 0.0;
            view.values_um.push(if is_made {
                1.6 * (x - 50.0) + 0.6 * (y - 30.0)
            } else {
                f64::NAN
            });
        }
    }
    let vertex = |i: usize, j: usize| (j * SIDES[0] + i) as u32;
    for j in 0..SIDES[1] - 1 {
        for i in 0..SIDES[0] - 1 {
            let corners = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            view.triangles.push([corners[0], corners[1], corners[2]]);
            view.triangles.push([corners[0], corners[2], corners[3]]);
        }
    }
    view
}

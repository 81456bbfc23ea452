//! A coloured surface as pixels: parallel projection, hidden surfaces removed by depth, shaded by its normals.
//!
//! ```text
//! colour = c(value) (a + (1 - a) max(0, n . l))          a: light from everywhere
//! ```
//!
//! Values are interpolated across each triangle and then coloured by bands, so that the edges of bands are sharp. Where a vertex has no value, the triangle is grey. Both
//! sides of a triangle are shaded alike.

use crate::arm::Projection;

/// Pixels on white.
pub(crate) struct Shaded {
    /// Width and height.
    pub(crate) size: [usize; 2],
    /// Red, green, blue; row by row from the top.
    pub(crate) rgb: Vec<u8>,
    /// How near to the viewer each pixel is, mm; minus infinity on the ground.
    nearest_mm: Vec<f64>,
}

/// Part of the light that comes from everywhere.
const AMBIENT: f64 = 0.45;
/// Direction of the light in the axes of the picture: right, up, towards the viewer.
const LIGHT: [f64; 3] = [-0.35, 0.5, 0.79];
/// What has no value.
const NO_VALUE: [u8; 3] = [205, 205, 205];

/// A corner of a triangle on the picture.
#[derive(Clone, Copy)]
pub(crate) struct Corner {
    /// Pixels from the upper left corner.
    pub(crate) at: [f64; 2],
    /// Towards the viewer, mm.
    pub(crate) depth_mm: f64,
    /// Unit normal in the axes of the picture.
    pub(crate) normal: [f64; 3],
    /// Value; not a number where there is none.
    pub(crate) value: f64,
}

impl Corner {
    /// A vertex seen by `projection`, with pixels for its picture coordinates (mm).
    pub(crate) fn new(
        projection: &Projection,
        (position, normal): ([f64; 3], [f64; 3]),
        value: f64,
        pixels: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Corner {
        let [x, y] = projection.flat(normal);
        Corner {
            at: pixels(projection.flat(position)),
            depth_mm: projection.depth(position),
            normal: [x, y, projection.depth(normal)],
            value,
        }
    }
}

impl Shaded {
    pub(crate) fn new(size: [usize; 2]) -> Shaded {
        let pixels = size[0] * size[1];
        Shaded {
            size,
            rgb: vec![255; 3 * pixels],
            nearest_mm: vec![f64::NEG_INFINITY; pixels],
        }
    }

    /// Whether a point (pixels, mm towards the viewer) is in front of all that is drawn, to within `slack` (mm).
    pub(crate) fn is_visible(&self, [x, y]: [f64; 2], depth_mm: f64, slack_mm: f64) -> bool {
        let inside = x >= 0.0 && y >= 0.0 && x < self.size[0] as f64 && y < self.size[1] as f64;
        inside && depth_mm >= self.nearest_mm[y as usize * self.size[0] + x as usize] - slack_mm
    }

    /// Draws a triangle.
    pub(crate) fn triangle(&mut self, corners: [Corner; 3], colour: &impl Fn(f64) -> [u8; 3]) {
        let [a, b, c] = corners.map(|corner| corner.at);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let range = |k: usize| {
            let low = a[k].min(b[k]).min(c[k]) - 0.5;
            let high = a[k].max(b[k]).max(c[k]) - 0.5;
            let most = self.size[k] as f64;
            low.ceil().clamp(0.0, most) as usize..(high.floor() + 1.0).clamp(0.0, most) as usize
        };
        let (columns, rows) = (range(0), range(1));
        for row in rows {
            for column in columns.clone() {
                let p = [column as f64 + 0.5, row as f64 + 0.5];
                let part = |u: [f64; 2], v: [f64; 2]| {
                    ((u[0] - p[0]) * (v[1] - p[1]) - (v[0] - p[0]) * (u[1] - p[1])) / area
                };
                let parts = [part(b, c), part(c, a), part(a, b)];
                // A hair of slack: no gap between neighbours.
                if parts.iter().any(|part| *part < -1e-9) {
                    continue;
                }
                let mix = |of: &dyn Fn(&Corner) -> f64| -> f64 {
                    corners
                        .iter()
                        .zip(parts)
                        .map(|(corner, part)| of(corner) * part)
                        .sum()
                };
                let depth_mm = mix(&|corner| corner.depth_mm);
                let pixel = row * self.size[0] + column;
                if depth_mm <= self.nearest_mm[pixel] {
                    continue;
                }
                self.nearest_mm[pixel] = depth_mm;
                let normal = [0, 1, 2].map(|k| mix(&|corner| corner.normal[k]));
                let value = mix(&|corner| corner.value);
                let base = if value.is_finite() {
                    colour(value)
                } else {
                    NO_VALUE
                };
                let light = lightness(normal);
                for (out, channel) in self.rgb[3 * pixel..3 * pixel + 3].iter_mut().zip(base) {
                    *out = (f64::from(channel) * light).round().clamp(0.0, 255.0) as u8;
                }
            }
        }
    }

    /// The pixels as PNG.
    ///
    /// # Errors
    /// Those of the encoder.
    pub(crate) fn to_png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size[0] as u32, self.size[1] as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&self.rgb)?;
        Ok(bytes)
    }
}

fn lightness(normal: [f64; 3]) -> f64 {
    let length = |v: [f64; 3]| v.iter().map(|part| part * part).sum::<f64>().sqrt();
    let dot: f64 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
    let size = length(normal) * length(LIGHT);
    let cosine = if size > 0.0 { dot / size } else { 0.0 };
    AMBIENT + (1.0 - AMBIENT) * cosine.max(0.0)
}

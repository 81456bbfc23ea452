//! A small writer of SVG: shapes, text and hatches; every text is escaped, every number is finite and short.
//!
//! Everything is in pixels with y downwards; angles are in degrees, clockwise.
//!
//! Identifiers (clips, gradients, hatches) carry a prefix made from the picture's own content, so that several pictures
//! can be in one HTML page.
//!
//! | written | rule |
//! |---|---|
//! | numbers | two decimals at most, no trailing zeros, cut at a million; not finite: 0 |
//! | text | the five characters of XML escaped, control characters left out |
//! | identifiers | `p`, eight hexadecimal digits of the content's fingerprint, `-`, a running number |
//!
//! Not checked: colours and dash patterns, which come from this crate and are written unchanged.
//! Source: Scalable Vector Graphics 1.1 (W3C).

use std::fmt::Write;

use crate::font::Weight;

/// A point in pixels, y downwards.
pub(crate) type Point = [f64; 2];

/// Fonts of every text in every picture.
const FONT_FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// Placeholder of the picture's prefix until the picture is complete.
const PREFIX: char = '\u{1}';

/// A rectangle in pixels with sides along the picture; `y` is its upper edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) w: f64,
    pub(crate) h: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.w
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.h
    }

    pub(crate) fn centre(&self) -> Point {
        [self.x + self.w / 2.0, self.y + self.h / 2.0]
    }

    pub(crate) fn contains(&self, p: Point) -> bool {
        p[0] >= self.x && p[0] <= self.right() && p[1] >= self.y && p[1] <= self.bottom()
    }

    /// Whether the two share more than an edge.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        self.x < other.right() && other.x < self.right() && self.y < other.bottom() && other.y < self.bottom()
    }

    /// The rectangle with `by` pixels taken off each side, its sides never less than nothing; a negative `by`
    /// widens it.
    pub(crate) fn shrunk(&self, by: f64) -> Self {
        Self {
            x: self.x + by,
            y: self.y + by,
            w: (self.w - 2.0 * by).max(0.0),
            h: (self.h - 2.0 * by).max(0.0),
        }
    }
}

/// How a shape is filled and outlined: begun by `fill` or `line`, then changed by the methods that take it by
/// value.
#[derive(Clone, Debug)]
pub(crate) struct Style {
    fill: String,
    stroke: Option<(String, f64)>,
    opacity: f64,
    dash: Option<&'static str>,
}

impl Style {
    /// Filled, without an edge; `colour` is any value of a `fill`.
    pub(crate) fn fill(colour: impl Into<String>) -> Self {
        Self {
            fill: colour.into(),
            stroke: None,
            opacity: 1.0,
            dash: None,
        }
    }

    /// A line with round ends and corners, nothing filled.
    pub(crate) fn line(colour: impl Into<String>, width_px: f64) -> Self {
        Self {
            fill: "none".to_owned(),
            stroke: Some((colour.into(), width_px)),
            opacity: 1.0,
            dash: None,
        }
    }

    /// With an edge, half of it inside.
    pub(crate) fn outlined(mut self, colour: impl Into<String>, width_px: f64) -> Self {
        self.stroke = Some((colour.into(), width_px));
        self
    }

    /// From 0 (not seen) to 1.
    pub(crate) fn opacity(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }

    /// Lengths of dashes and gaps in turn: `6 4`.
    pub(crate) fn dashed(mut self, pattern: &'static str) -> Self {
        self.dash = Some(pattern);
        self
    }

    fn attributes(&self) -> String {
        let mut out = format!(" fill=\"{}\"", self.fill);
        if let Some((colour, width)) = &self.stroke {
            let _ = write!(
                out,
                " stroke=\"{colour}\" stroke-width=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"",
                num(*width)
            );
        }
        if let Some(dash) = self.dash {
            let _ = write!(out, " stroke-dasharray=\"{dash}\"");
        }
        if self.opacity < 1.0 {
            let _ = write!(out, " opacity=\"{}\"", num(self.opacity));
        }
        out
    }
}

/// Which point of a text's baseline is at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text is set.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub(crate) size_px: f64,
    pub(crate) anchor: Anchor,
    pub(crate) weight: Weight,
    pub(crate) colour: String,
    /// Clockwise about the position; 0 reads to the right.
    pub(crate) turn_deg: f64,
    /// Width of the white edge, both sides together; 0 for none.
    pub(crate) halo_px: f64,
}

impl Text {
    /// In ink, from its position to the right.
    pub(crate) fn new(size_px: f64) -> Self {
        Self {
            size_px,
            anchor: Anchor::Start,
            weight: Weight::Regular,
            colour: crate::colour::INK.to_owned(),
            turn_deg: 0.0,
            halo_px: 0.0,
        }
    }

    /// Centred on its position.
    pub(crate) fn middle(mut self) -> Self {
        self.anchor = Anchor::Middle;
        self
    }

    /// Up to its position.
    pub(crate) fn end(mut self) -> Self {
        self.anchor = Anchor::End;
        self
    }

    pub(crate) fn bold(mut self) -> Self {
        self.weight = Weight::Bold;
        self
    }

    pub(crate) fn colour(mut self, colour: impl Into<String>) -> Self {
        self.colour = colour.into();
        self
    }

    /// About its position; -90 reads upwards.
    pub(crate) fn turned(mut self, deg: f64) -> Self {
        self.turn_deg = deg;
        self
    }

    /// With a white edge that separates it from the drawing below; its width includes both sides.
    pub(crate) fn halo(mut self, width_px: f64) -> Self {
        self.halo_px = width_px;
        self
    }
}

/// A picture being written: what is drawn later is on top.
pub(crate) struct Svg {
    defs: String,
    body: String,
    next_id: usize,
}

impl Svg {
    pub(crate) fn new() -> Self {
        Self {
            defs: String::new(),
            body: String::new(),
            next_id: 0,
        }
    }

    /// A side that is less than nothing is nothing.
    pub(crate) fn rect(&mut self, r: Rect, style: &Style) {
        self.rounded(r, 0.0, style);
    }

    pub(crate) fn rounded(&mut self, r: Rect, radius_px: f64, style: &Style) {
        let round = if radius_px > 0.0 {
            format!(" rx=\"{}\"", num(radius_px))
        } else {
            String::new()
        };
        let _ = writeln!(
            self.body,
            "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{round}{}/>",
            num(r.x),
            num(r.y),
            num(r.w.max(0.0)),
            num(r.h.max(0.0)),
            style.attributes()
        );
    }

    /// A radius that is less than nothing is nothing.
    pub(crate) fn circle(&mut self, c: Point, radius_px: f64, style: &Style) {
        let _ = writeln!(
            self.body,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>",
            num(c[0]),
            num(c[1]),
            num(radius_px.max(0.0)),
            style.attributes()
        );
    }

    /// An image with these attributes.
    pub(crate) fn image(&mut self, attributes: &str) {
        let _ = writeln!(self.body, "<image {attributes}/>");
    }

    pub(crate) fn line(&mut self, a: Point, b: Point, style: &Style) {
        let _ = writeln!(
            self.body,
            "<path d=\"M{} {}L{} {}\"{}/>",
            num(a[0]),
            num(a[1]),
            num(b[0]),
            num(b[1]),
            style.attributes()
        );
    }

    /// An open line; points that are not finite are left out.
    pub(crate) fn polyline(&mut self, points: &[Point], style: &Style) {
        self.path(&trace(points, Ends::Open), style);
    }

    /// A closed line; points that are not finite are left out.
    pub(crate) fn polygon(&mut self, points: &[Point], style: &Style) {
        self.path(&trace(points, Ends::Closed), style);
    }

    /// Path data unchanged; overlapping rings cut holes (even-odd rule).
    pub(crate) fn path(&mut self, data: &str, style: &Style) {
        if !data.is_empty() {
            let _ = writeln!(
                self.body,
                "<path d=\"{data}\" fill-rule=\"evenodd\"{}/>",
                style.attributes()
            );
        }
    }

    /// `content` with the anchor of its baseline at `at`; its halo, if any, is a copy of the text under it.
    pub(crate) fn text(&mut self, at: Point, content: &str, text: &Text) {
        let mut attributes = format!(
            " x=\"{}\" y=\"{}\" font-size=\"{}\"",
            num(at[0]),
            num(at[1]),
            num(text.size_px)
        );
        match text.anchor {
            Anchor::Start => {}
            Anchor::Middle => attributes.push_str(" text-anchor=\"middle\""),
            Anchor::End => attributes.push_str(" text-anchor=\"end\""),
        }
        if text.weight == Weight::Bold {
            attributes.push_str(" font-weight=\"bold\"");
        }
        if text.turn_deg != 0.0 {
            let _ = write!(
                attributes,
                " transform=\"rotate({} {} {})\"",
                num(text.turn_deg),
                num(at[0]),
                num(at[1])
            );
        }
        let content = escape(content);
        if text.halo_px > 0.0 {
            let _ = writeln!(
                self.body,
                "<text{attributes} fill=\"#fff\" stroke=\"#fff\" stroke-width=\"{}\" stroke-linejoin=\"round\" opacity=\"0.85\">{content}</text>",
                num(text.halo_px)
            );
        }
        let _ = writeln!(
            self.body,
            "<text{attributes} fill=\"{}\">{content}</text>",
            text.colour
        );
    }

    /// Everything `draw` writes, cut to `area`.
    pub(crate) fn clipped(&mut self, area: Rect, draw: impl FnOnce(&mut Self)) {
        let id = self.new_id();
        let _ = writeln!(
            self.defs,
            "<clipPath id=\"{id}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>",
            num(area.x),
            num(area.y),
            num(area.w),
            num(area.h)
        );
        let _ = writeln!(self.body, "<g clip-path=\"url(#{id})\">");
        draw(self);
        self.body.push_str("</g>\n");
    }

    /// Everything `draw` writes, as one translucent layer of class `class`.
    pub(crate) fn layer(&mut self, class: &str, opacity: f64, draw: impl FnOnce(&mut Self)) {
        let _ = writeln!(
            self.body,
            "<g class=\"{}\" opacity=\"{}\">",
            escape(class),
            num(opacity)
        );
        draw(self);
        self.body.push_str("</g>\n");
    }

    /// A fill of parallel lines; the answer is the value of a `fill`, good for this picture alone.
    pub(crate) fn hatch(&mut self, hatch: &Hatch) -> String {
        let id = self.new_id();
        let pitch = num(hatch.pitch_px);
        let _ = writeln!(
            self.defs,
            "<pattern id=\"{id}\" width=\"{pitch}\" height=\"{pitch}\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate({})\">{}<path d=\"M0 0V{pitch}\" stroke=\"{}\" stroke-width=\"{}\"/></pattern>",
            num(hatch.turn_deg),
            hatch.ground.map_or_else(String::new, |c| format!(
                "<rect width=\"{pitch}\" height=\"{pitch}\" fill=\"{c}\"/>"
            )),
            hatch.colour,
            num(hatch.width_px * 2.0)
        );
        format!("url(#{id})")
    }

    /// A fill that changes from `from` to `to` over the given stops (offset from 0 to 1, colour); the answer is
    /// the value of a `fill`. Before the first and beyond the last stop the colour stays.
    pub(crate) fn gradient(&mut self, from: Point, to: Point, stops: &[(f64, String)]) -> String {
        let id = self.new_id();
        let _ = write!(
            self.defs,
            "<linearGradient id=\"{id}\" gradientUnits=\"userSpaceOnUse\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\">",
            num(from[0]),
            num(from[1]),
            num(to[0]),
            num(to[1])
        );
        for (offset, colour) in stops {
            let _ = write!(
                self.defs,
                "<stop offset=\"{}\" stop-color=\"{colour}\"/>",
                num(*offset)
            );
        }
        self.defs.push_str("</linearGradient>\n");
        format!("url(#{id})")
    }

    /// The complete document on white, of this size (rounded up), described by `title`. The same shapes give the same bytes.
    pub(crate) fn finish(self, width_px: f64, height_px: f64, title: &str) -> String {
        let (w, h) = (num(width_px.ceil()), num(height_px.ceil()));
        let prefix = format!("p{:08x}-", fingerprint(&[&self.defs, &self.body]));
        let document = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" font-family=\"{FONT_FAMILY}\" role=\"img\">\n<title>{}</title>\n<defs>\n{}</defs>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n{}</svg>\n",
            escape(title),
            self.defs,
            self.body
        );
        document.replace(PREFIX, &prefix)
    }

    fn new_id(&mut self) -> String {
        self.next_id += 1;
        format!("{PREFIX}{}", self.next_id)
    }
}

/// A fill of parallel lines.
pub(crate) struct Hatch {
    /// How far the lines are turned, clockwise; 0 draws upright lines.
    pub(crate) turn_deg: f64,
    pub(crate) pitch_px: f64,
    pub(crate) width_px: f64,
    pub(crate) colour: &'static str,
    /// Of the ground between them; where there is none, the drawing below is visible.
    pub(crate) ground: Option<&'static str>,
}

/// Whether a traced line returns to its first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    Open,
    Closed,
}

/// Path data through `points`; points that are not finite are left out, and the line runs on past them. Empty
/// without points.
pub(crate) fn trace(points: &[Point], ends: Ends) -> String {
    let mut data = String::new();
    for p in points.iter().filter(|p| p[0].is_finite() && p[1].is_finite()) {
        let command = if data.is_empty() { 'M' } else { 'L' };
        let _ = write!(data, "{command}{} {}", num(p[0]), num(p[1]));
    }
    if ends == Ends::Closed && !data.is_empty() {
        data.push('Z');
    }
    data
}

/// A number in SVG: two decimals at most, never `NaN`, never `-0`.
pub(crate) fn num(value: f64) -> String {
    // Pictures are a few thousand pixels wide: anything beyond is out of sight.
    const FAR: f64 = 1e6;
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{:.2}", value.clamp(-FAR, FAR));
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" {
        "0".to_owned()
    } else {
        short.to_owned()
    }
}

/// `text` with the five characters of XML replaced and characters that XML forbids left out; tabs and line ends
/// become blanks. Safe as content and as a value in quotes, in SVG and in HTML.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            c if c.is_control() || c == '\u{FFFE}' || c == '\u{FFFF}' => {}
            c => out.push(c),
        }
    }
    out
}

/// FNV-1a of 32 bits over the texts: the same content gives the same prefix on every machine.
fn fingerprint(texts: &[&str]) -> u32 {
    let mut hash = 0x811c_9dc5_u32;
    for byte in texts.iter().flat_map(|t| t.bytes()) {
        hash = (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    }
    hash
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_finite() {
        assert_eq!(num(1.0), "1");
        assert_eq!(num(-0.001), "0");
        assert_eq!(num(2.346), "2.35");
        assert_eq!(num(f64::NAN), "0");
        assert_eq!(num(f64::INFINITY), "0");
    }

    #[test]
    fn the_five_characters_are_escaped() {
        assert_eq!(escape("<&\">'"), "&lt;&amp;&quot;&gt;&#39;");
        assert_eq!(escape("a\u{1}b\u{0}c"), "abc");
    }

    #[test]
    fn points_that_are_not_finite_are_left_out() {
        assert_eq!(
            trace(&[[0.0, 0.0], [f64::NAN, 1.0], [2.0, 2.0]], Ends::Open),
            "M0 0L2 2"
        );
        assert_eq!(trace(&[], Ends::Closed), "");
    }
}

//! The colours of pictures.

/// Ink of the boundary and the interfaces.
pub(super) const BOUNDARY: &str = "#14213d";
/// Ink of the edges of the mesh.
pub(super) const EDGE: &str = "#33466b";
/// Ink of the ellipses.
pub(super) const ELLIPSE: &str = "#d1442b";
/// The domain where its triangles are not shown.
pub(super) const DOMAIN: &str = "#eef2f5";

/// Lines between cells, and between pale ones.
pub(super) const CELL_BORDER: &str = "#ffffff";
pub(super) const PALE_BORDER: &str = "#c9ced8";
/// Dots at seeds.
pub(super) const SEED: &str = "#1b2540";
/// Fill and ink of orphans.
pub(super) const ORPHAN: [&str; 2] = ["#d8293c", "#5c0d1a"];
/// Geodesic edges.
pub(super) const GEODESIC: &str = "#1b2540";
/// A surface without any other colour.
pub(super) const SURFACE: &str = "#c9d3e2";
/// Where a value is not known.
pub(super) const UNKNOWN: &str = "#d8d8d8";
/// Lines of equal barycentric coordinates.
pub(super) const GRID: &str = "#4a5b85";
/// Fill and ink of canvas faces that witness Voronoi edges, and Voronoi vertices.
pub(super) const EDGE_WITNESS: [&str; 2] = ["#aab0ba", "#8b929e"];
pub(super) const VERTEX_WITNESS: [&str; 2] = ["#d8293c", "#a3182b"];

/// Fill and ink of what is counted of straight edges, and of geodesic ones.
pub(super) const STRAIGHT: [&str; 2] = ["#a9bfdf", "#4a6ba3"];
pub(super) const CURVED: [&str; 2] = ["#d1442b", "#d1442b"];
/// The range that is wanted, behind a histogram, and what marks it.
pub(super) const WANTED: [&str; 2] = ["#f1f5ea", "#7d9160"];
/// Lines across a histogram, its axes, and words.
pub(super) const RULE: &str = "#dfe3ea";
pub(super) const AXIS: &str = "#6b7486";
pub(super) const TEXT: &str = "#14213d";

/// How strong the colours of cells are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tint {
    /// Cells alone.
    Full,
    /// Under lines.
    Soft,
    /// Under filled triangles or orphans.
    Pale,
}

/// Lightness, chroma and hue (OKLCH) of cells: from deep blue over green to sand and rose, light and dark in turns.
const CELLS: [[f64; 3]; 7] = [
    [0.69, 0.085, 258.0],
    [0.80, 0.065, 222.0],
    [0.72, 0.075, 182.0],
    [0.84, 0.070, 140.0],
    [0.89, 0.075, 92.0],
    [0.79, 0.090, 55.0],
    [0.73, 0.085, 15.0],
];

/// Number of hues of cells, and of shades of each: variations that the eye notices only beside another.
pub(super) const HUES: usize = CELLS.len();
pub(super) const SHADES: usize = 3;

/// The fill of a cell by its hue, its shade, and how much stands over it; hues and shades go round.
pub(super) fn cell(hue: usize, shade: usize, tint: Tint) -> String {
    let [lightness, chroma, hue] = CELLS[hue % HUES];
    let lightness = lightness + 0.022 * ((shade % SHADES) as f64 - 1.0);
    // From the colour itself towards white, with less of its contrast.
    let [middle, contrast, strength] = match tint {
        Tint::Full => [0.79, 1.0, 1.0],
        Tint::Soft => [0.86, 0.65, 0.72],
        Tint::Pale => [0.94, 0.2, 0.3],
    };
    oklch(middle + contrast * (lightness - 0.79), strength * chroma, hue)
}

/// How like two hues are: large for near ones.
pub(super) fn likeness(a: usize, b: usize) -> f64 {
    let [x, y] = [a, b].map(|i| {
        let [lightness, chroma, hue] = CELLS[i];
        let angle = hue.to_radians();
        [lightness, chroma * angle.cos(), chroma * angle.sin()]
    });
    let square: f64 = x.iter().zip(y).map(|(u, v)| (u - v) * (u - v)).sum();
    0.005 / (0.005 + square)
}

/// A soft fill: `level` from 0 (palest) to 1 (strongest), a hue of its own for each region (0 for the first).
pub(super) fn fill(region: usize, level: f64) -> String {
    // The golden angle keeps any number of hues apart; within a region the hue drifts, as in the best ramps.
    let hue = 215.0 + 137.508 * region as f64 + 45.0 * level;
    oklch(0.98 - 0.28 * level, 0.012 + 0.098 * level, hue)
}

/// A fill for how much protection there is: 1 (much) is almost white, 0 a warm red.
pub(super) fn protection_fill(level: f64) -> String {
    let bad = (1.0 - level).clamp(0.0, 1.0);
    oklch(0.985 - 0.335 * bad, 0.006 + 0.154 * bad, 85.0 - 55.0 * bad)
}

/// Hues (OKLCH) of causes, in their order, that differ for the colour-blind, too: magenta, blue, orange, green.
const CAUSES: [f64; 4] = [0.0, 255.0, 55.0, 150.0];

/// The ink of an edge that is too short, or too long, for the so-manieth cause.
pub(super) fn cause(number: usize, is_short: bool) -> String {
    let [lightness, chroma] = if is_short { [0.40, 0.13] } else { [0.70, 0.16] };
    oklch(lightness, chroma, CAUSES[number % CAUSES.len()])
}

/// The factor by which conditions are missed from which on fills are as strong as can be.
const FAR: f64 = 1e4;
/// Levels of colour per power of ten.
const PER_DECADE: f64 = 3.0;

/// A fill for the factor by which a condition is missed, on a logarithmic scale: green from 1 down, from sand to a dark
/// red up from there; grey where it is none.
pub(super) fn factor_fill(factor: f64) -> String {
    if factor.is_nan() {
        return UNKNOWN.into();
    }
    let level = ((factor.clamp(1.0 / FAR, FAR).log10() * PER_DECADE).ceil() / PER_DECADE) / FAR.log10();
    if level <= 0.0 {
        return oklch(0.86 + 0.06 * level, 0.10 - 0.03 * level, 150.0);
    }
    oklch(0.93 - 0.48 * level, 0.07 + 0.10 * level, 85.0 - 60.0 * level)
}

/// An opaque colour from the OKLCH space (Ottosson 2020: lightness, chroma, hue in degrees), clipped to sRGB.
fn oklch(lightness: f64, chroma: f64, hue: f64) -> String {
    let (a, b) = (chroma * hue.to_radians().cos(), chroma * hue.to_radians().sin());
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548 * b).powi(3);
    let [r, g, b] = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701 * s,
    ]
    .map(encode);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// An intensity of light, clipped to one byte of sRGB.
pub(super) fn encode(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

/// The intensities of red, green and blue light in a colour written as `#rrggbb`; none where it is not.
pub(super) fn decode(colour: &str) -> [f64; 3] {
    [1, 3, 5].map(|at| {
        let byte = colour.get(at..at + 2).and_then(|digits| u8::from_str_radix(digits, 16).ok());
        let encoded = f64::from(byte.unwrap_or(0)) / 255.0;
        if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_of_cells_are_told_apart() {
        for a in 0..HUES {
            for b in 0..a {
                let [fill, other] = [a, b].map(|hue| cell(hue, 1, Tint::Soft));
                assert!(fill != other && likeness(a, b) < likeness(a, a));
            }
        }
    }

    #[test]
    fn factors_part_green_from_warm_at_one() {
        let fills = [0.01, 0.99, 1.01, 30.0, 1e9, f64::INFINITY, f64::NAN].map(factor_fill);
        assert!(fills[1] != fills[2] && fills[2] != fills[3] && fills[3] != fills[4] && fills[4] == fills[5]);
        assert!(fills[0] != fills[1] && fills[6] == UNKNOWN);
    }

    #[test]
    fn light_is_decoded_and_encoded() {
        for byte in 0..=255_u8 {
            assert_eq!(decode(&format!("#00{byte:02x}ff")).map(encode), [0, byte, 255]);
        }
    }

    #[test]
    fn oklch_knows_white_black_and_red() {
        assert_eq!(oklch(1.0, 0.0, 0.0), "#ffffff");
        assert_eq!(oklch(0.0, 0.0, 0.0), "#000000");
        assert_eq!(oklch(0.627_955, 0.257_683, 29.234), "#ff0000");
    }
}

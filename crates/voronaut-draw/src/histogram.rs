//! Histograms of edge lengths and angles, drawn (RR-9103, figure 20).

use super::colours::{AXIS, CURVED, RULE, STRAIGHT, TEXT, WANTED};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use std::fmt::Write;
use voronaut::quality::{Both, Histogram, Histograms};

/// Pixels: of the drawing, of what lies within the axes of a panel, and where that begins.
const SIZE: [f64; 2] = [1200.0, 480.0];
const PANEL: [f64; 2] = [490.0, 270.0];
const LEFT: [f64; 2] = [80.0, 680.0];
const TOP: f64 = 125.0;
/// An axis of shares has no more steps than this.
const STEPS: f64 = 5.0;

/// Draws histograms as the text of an SVG file: lengths on the left, angles on the right, filled bars for straight edges and
/// an outline over them for geodesic ones, shares of all in per cent upwards. The range of unit lengths is shaded; triangles
/// at the upper rim point at means.
pub fn histograms_svg(found: &Histograms) -> String {
    let [width, height] = SIZE;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"13\" fill=\"{TEXT}\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    lengths(found).draw(&mut text);
    angles(found).draw(&mut text);
    let (missing, border) = (found.geodesics_not_found, found.geodesics_on_border);
    if missing + border > 0 {
        let note = format!(
            "Counted as straight among the geodesic edges: {missing} of which no geodesic was found, {border} on the border \
             whose geodesic would leave the domain."
        );
        words(&mut text, [LEFT[0], SIZE[1] - 12.0], "font-size=\"12\"", &note);
    }
    text.push_str("</svg>\n");
    text
}

/// One histogram with its axes.
struct Panel<'a> {
    left: f64,
    title: &'static str,
    axis: String,
    histogram: &'a Histogram,
    /// What the horizontal axis ends with; it begins with 0.
    end: f64,
    ticks: Vec<(f64, String)>,
    /// Values that are wanted, with their names; of several the range between the first and the last is.
    marks: Vec<(f64, &'static str)>,
    /// What the legend says of either.
    legend: [String; 2],
}

fn lengths(found: &Histograms) -> Panel<'_> {
    let histogram = &found.edge_length;
    let last = histogram.bounds.last().copied().unwrap_or(2.0);
    let width = bin_width(histogram);
    let mut ticks: Vec<(f64, String)> = (0..8).map(|i| 0.25 * f64::from(i)).map(|x| (x, x.to_string())).collect();
    // The last bin has all that is longer.
    ticks.push((last + 0.5 * width, format!("\u{2265} {last}")));
    let says = |mean: f64, std: f64, unit: f64| {
        format!("mean {mean:.3}, standard deviation {std:.3}, {:.1} % unit", 100.0 * unit)
    };
    let (mean, std, unit) = (histogram.mean, histogram.std, found.unit_fraction);
    Panel {
        left: LEFT[0],
        title: "Metric edge lengths",
        axis: format!("metric length of {} edges", total(histogram)),
        histogram,
        end: last + width,
        ticks,
        marks: vec![(FRAC_1_SQRT_2, "1/\u{221a}2"), (1.0, "1"), (SQRT_2, "\u{221a}2")],
        legend: [says(mean.straight, std.straight, unit.straight), says(mean.geodesic, std.geodesic, unit.geodesic)],
    }
}

fn angles(found: &Histograms) -> Panel<'_> {
    let histogram = &found.angle;
    let says = |mean: f64, std: f64| format!("mean {mean:.1}\u{b0}, standard deviation {std:.1}\u{b0}");
    let (mean, std) = (histogram.mean, histogram.std);
    Panel {
        left: LEFT[1],
        title: "Angles in the metric",
        axis: format!("degrees, of {} angles", total(histogram)),
        histogram,
        end: 180.0,
        ticks: (0..=6).map(|i| (f64::from(30 * i), (30 * i).to_string())).collect(),
        marks: vec![(60.0, "60\u{b0}")],
        legend: [says(mean.straight, std.straight), says(mean.geodesic, std.geodesic)],
    }
}

/// Width of the bins; 1 of a histogram that has less than two.
fn bin_width(histogram: &Histogram) -> f64 {
    histogram.bounds.get(1).copied().unwrap_or(1.0)
}

/// How many values were counted.
fn total(histogram: &Histogram) -> usize {
    histogram.counts.straight.iter().sum()
}

impl Panel<'_> {
    fn draw(&self, text: &mut String) {
        let [straight, geodesic] =
            [&self.histogram.counts.straight, &self.histogram.counts.geodesic].map(|c| shares(c));
        let greatest = straight.iter().chain(&geodesic).copied().fold(1.0, f64::max);
        let step = round_step(greatest / STEPS);
        let top = (greatest / step).ceil() * step;
        self.background(text, top, step);
        let _ = writeln!(text, "<path d=\"{}\" fill=\"{}\"/>", self.outline(&straight, top), STRAIGHT[0]);
        let [fill, ink] = CURVED;
        let outline = self.outline(&geodesic, top);
        let style = format!("fill=\"{fill}\" fill-opacity=\"0.08\" stroke=\"{ink}\" stroke-width=\"1.8\"");
        let _ = writeln!(text, "<path d=\"{outline}\" {style} stroke-linejoin=\"round\"/>");
        self.marks(text);
        self.axes(text);
        self.legend(text);
    }

    fn x(&self, value: f64) -> f64 {
        self.left + PANEL[0] * value / self.end
    }

    /// Shading, and lines at round shares with their names.
    fn background(&self, text: &mut String, top: f64, step: f64) {
        let ([right, bottom], left) = ([self.left + PANEL[0], TOP + PANEL[1]], self.left);
        if let [first, .., last] = self.marks[..] {
            let [from, to] = [first, last].map(|(value, _)| self.x(value));
            let (width, height) = (to - from, PANEL[1]);
            let place = format!("x=\"{from:.1}\" y=\"{TOP}\" width=\"{width:.1}\" height=\"{height}\"");
            let _ = writeln!(text, "<rect {place} fill=\"{}\"/>", WANTED[0]);
        }
        for i in 0..=(top / step).round() as u32 {
            let share = f64::from(i) * step;
            let y = bottom - PANEL[1] * share / top;
            line(text, [left, y], [right, y], &format!("stroke=\"{RULE}\""));
            words(text, [left - 8.0, y + 4.5], "text-anchor=\"end\"", &format!("{share}"));
        }
        let middle = [left - 48.0, 0.5 * (TOP + bottom)];
        let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 {} {})\"", middle[0], middle[1]);
        words(text, middle, &turned, "share (%)");
    }

    /// The steps of a histogram, as the data of a closed path.
    fn outline(&self, shares: &[f64], top: f64) -> String {
        let bottom = TOP + PANEL[1];
        let mut path = format!("M{:.1} {bottom:.1}", self.x(0.0));
        let bounds = &self.histogram.bounds;
        for (i, share) in shares.iter().enumerate() {
            let end = bounds.get(i + 1).copied().unwrap_or(self.end);
            let _ = write!(path, "V{:.1}H{:.1}", bottom - PANEL[1] * share / top, self.x(end));
        }
        let _ = write!(path, "V{bottom:.1}Z");
        path
    }

    /// What is wanted, by name at the upper rim, and the means as triangles there.
    fn marks(&self, text: &mut String) {
        let ink = WANTED[1];
        for &(value, name) in &self.marks {
            let x = self.x(value);
            let style = format!("stroke=\"{ink}\" stroke-dasharray=\"4 4\"");
            line(text, [x, TOP], [x, TOP + PANEL[1]], &style);
            words(text, [x, TOP - 14.0], &format!("text-anchor=\"middle\" fill=\"{ink}\""), name);
        }
        let Both { straight, geodesic } = self.histogram.mean;
        for (mean, ink) in [(straight, STRAIGHT[1]), (geodesic, CURVED[1])] {
            if (0.0..=self.end).contains(&mean) {
                let x = self.x(mean);
                let _ = writeln!(text, "<path d=\"M{x:.1} {TOP}l-5-9h10z\" fill=\"{ink}\" fill-opacity=\"0.85\"/>");
            }
        }
    }

    /// The horizontal axis with its ticks and what it is of.
    fn axes(&self, text: &mut String) {
        let bottom = TOP + PANEL[1];
        let style = format!("stroke=\"{AXIS}\"");
        line(text, [self.left, bottom], [self.left + PANEL[0], bottom], &style);
        for (value, name) in &self.ticks {
            let x = self.x(*value);
            line(text, [x, bottom], [x, bottom + 5.0], &style);
            words(text, [x, bottom + 20.0], "text-anchor=\"middle\"", name);
        }
        words(text, [self.left + 0.5 * PANEL[0], bottom + 44.0], "text-anchor=\"middle\"", &self.axis);
    }

    fn legend(&self, text: &mut String) {
        words(text, [self.left, 30.0], "font-size=\"18\" font-weight=\"bold\"", self.title);
        let rows = [("straight", STRAIGHT, "1"), ("geodesic", CURVED, "0.08")];
        for (row, ((name, [fill, ink], opacity), says)) in rows.into_iter().zip(&self.legend).enumerate() {
            let y = 56.0 + 22.0 * row as f64;
            let place = format!("x=\"{}\" y=\"{}\" width=\"20\" height=\"12\"", self.left + 1.0, y - 11.0);
            let style = format!("fill=\"{fill}\" fill-opacity=\"{opacity}\" stroke=\"{ink}\" stroke-width=\"1.5\"");
            let _ = writeln!(text, "<rect {place} {style}/>");
            words(text, [self.left + 30.0, y], "", &format!("{name}: {says}"));
        }
    }
}

/// Counts as shares of all, in per cent.
fn shares(counts: &[usize]) -> Vec<f64> {
    let all = counts.iter().sum::<usize>().max(1) as f64;
    counts.iter().map(|&count| 100.0 * count as f64 / all).collect()
}

/// The least of 1, 2, 5, 10, 20, 50 ... that is not less.
fn round_step(least: f64) -> f64 {
    let decade = 10.0_f64.powf(least.log10().floor()).max(1.0);
    [1.0, 2.0, 5.0].into_iter().map(|digit| digit * decade).find(|step| *step >= least).unwrap_or(10.0 * decade)
}

fn line(text: &mut String, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], style: &str) {
    let _ = writeln!(text, "<path d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\" {style}/>");
}

/// Words at a place, which is the left end of their baseline unless `style` says otherwise.
fn words(text: &mut String, [x, y]: [f64; 2], style: &str, what: &str) {
    let _ = writeln!(text, "<text x=\"{x:.1}\" y=\"{y:.1}\" {style}>{what}</text>");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::grid;
    use voronaut::geometry::{Point, Tensor};
    use voronaut::mesh::Mesh;
    use voronaut::quality::histograms;

    #[test]
    fn steps_are_round() {
        for (least, step) in [(0.2, 1.0), (1.0, 1.0), (1.1, 2.0), (2.1, 5.0), (7.0, 10.0), (20.0, 20.0), (30.0, 50.0)] {
            assert!((round_step(least) - step).abs() < 1e-12, "{least}: {}", round_step(least));
        }
    }

    #[test]
    fn a_grid_has_its_means_and_both_outlines() {
        let found = histograms(&grid(4, 4), &|_: Point| Tensor::IDENTITY).unwrap();
        let text = histograms_svg(&found);
        assert!(text.ends_with("</svg>\n") && text.matches("straight: mean").count() == 2);
        assert!(
            text.contains("mean 60.0\u{b0}") && text.contains("metric length of 56 edges") && !text.contains("NaN")
        );
        assert!(!text.contains("Counted as straight"));
        let bent = histograms_svg(&Histograms { geodesics_not_found: 3, ..found });
        assert!(bent.contains("straight among the geodesic edges: 3 of which"));
    }

    #[test]
    fn nothing_is_drawn_as_axes() {
        let nothing = histograms(&Mesh::default(), &|_: Point| Tensor::IDENTITY).unwrap();
        for found in [nothing, Histograms::default()] {
            let text = histograms_svg(&found);
            assert!(text.ends_with("</svg>\n") && !text.contains("\"NaN") && !text.contains("inf"), "{text}");
        }
    }

    #[cfg(feature = "png")]
    #[test]
    fn it_is_well_formed() {
        let found = histograms(&grid(4, 4), &|_: Point| Tensor::IDENTITY).unwrap();
        assert!(super::super::render_png(&histograms_svg(&found)).is_ok());
    }
}

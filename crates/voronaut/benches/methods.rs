//! Methods of computing distances, on every kind of canvas, against closed forms:
//! `cargo bench -p voronaut --bench methods -- --vertices 10201`. Prints Markdown tables, one for each metric.
//!
//! Timings are read by people, never asserted; errors are, in `tests/geodesics`.

#[path = "../src/tests/geodesics/cases.rs"]
mod cases;

use cases::{Case, half_plane, turning};
use std::time::Instant;
use voronaut::Result;
use voronaut::canvas::{Canvas, Kind};
use voronaut::diagram::Distances;
use voronaut::geodesic::Method;

/// The measure in the tables' heads.
const ANISOTROPIES: [f64; 3] = [2.0, 10.0, 40.0];
/// How steep the turning metric is.
const HEIGHT: f64 = 0.5;
/// As many as a grid of 101 x 101 has.
const VERTICES: usize = 10_201;
/// The fastest of so many runs counts.
const RUNS: u32 = 3;

const HEAD: [&str; 7] =
    ["canvas", "method", "max error, %", "mean error, %", "reached, %", "updates a vertex", "microseconds a vertex"];

fn main() {
    let vertices = vertices();
    println!("{vertices} vertices; in each cell the figures at anisotropies 2, 10 and 40.");
    for case in [|anisotropy| turning(anisotropy, HEIGHT), half_plane] {
        let cases = ANISOTROPIES.map(case);
        println!("\n*{}*\n", cases[0].name);
        print_table(&cases, vertices);
    }
}

/// The number after `--vertices`; other arguments are cargo's.
fn vertices() -> usize {
    let mut arguments = std::env::args().skip_while(|argument| argument != "--vertices").skip(1);
    arguments.next().map_or(VERTICES, |number| number.parse().expect("a number after --vertices"))
}

fn print_table(cases: &[Case; 3], vertices: usize) {
    let mut rows = vec![HEAD.map(String::from)];
    let mut refusals: Vec<String> = Vec::new();
    for kind in Kind::ALL {
        let canvases = cases.each_ref().map(|case| Canvas::new(kind, case.domain().planar(), &case.metric, vertices));
        for method in Method::ALL {
            let figures = [0, 1, 2].map(|k| match &canvases[k] {
                Ok(canvas) => figures(&cases[k], canvas, method).map_err(|error| error.to_string()),
                Err(error) => Err(error.to_string()),
            });
            refusals.extend(figures.iter().filter_map(|f| f.as_ref().err()).map(|why| format!("{kind}: {why}")));
            let cell = |figures: &std::result::Result<[String; 5], String>, column: usize| match figures {
                Ok(cells) => cells[column].clone(),
                Err(_) if column == 0 => "refused".to_string(),
                Err(_) => "-".to_string(),
            };
            let cells = [0, 1, 2, 3, 4].map(|column| figures.each_ref().map(|f| cell(f, column)).join(", "));
            let [max, mean, reached, updates, time] = cells;
            rows.push([kind.to_string(), method.to_string(), max, mean, reached, updates, time]);
        }
    }
    print!("{}", markdown(&rows));
    refusals.sort_unstable();
    refusals.dedup();
    for why in refusals {
        println!("\nRefused: {why}");
    }
}

/// The cells of a run: greatest and mean relative error where [`Case::errors`] measures, the share of all vertices that have a
/// distance, updates, and the time from the canvas to the distances. That includes what a method makes for itself: a graph
/// with its tensors, a grid, the factors of a matrix.
fn figures(case: &Case, canvas: &Canvas, method: Method) -> Result<[String; 5]> {
    let n = canvas.vertex_count() as f64;
    let start = Instant::now();
    let found = Distances::new(canvas, &case.metric, &[case.from], method)?;
    let mut seconds = start.elapsed().as_secs_f64();
    // Slow ones need no second look.
    for _ in (1..RUNS).take_while(|_| start.elapsed().as_secs_f64() < 1.0) {
        let start = Instant::now();
        Distances::new(canvas, &case.metric, &[case.from], method)?;
        seconds = start.elapsed().as_secs_f64().min(seconds);
    }
    let [max, mean] = case.errors(canvas, &found).map(|error| 100.0 * error);
    let reached = found.values().iter().filter(|d| d.is_finite()).count() as f64 / n;
    let updates = found.counters().map_or("-".into(), |c| format!("{:.1}", c.crossings as f64 / n));
    // Down, so that 100 means all.
    let reached = (1000.0 * reached).floor() / 10.0;
    Ok([digits(max), digits(mean), format!("{reached}"), updates, format!("{:.1}", 1e6 * seconds / n)])
}

/// With as many places as two digits take, but two at most.
fn digits(x: f64) -> String {
    let places = if x >= 10.0 {
        0
    } else if x >= 1.0 {
        1
    } else {
        2
    };
    format!("{x:.places$}")
}

/// Rows as a table in Markdown, with columns of even width; the first row is its head.
fn markdown<const N: usize>(rows: &[[String; N]]) -> String {
    let widths: Vec<usize> = (0..N).map(|i| rows.iter().map(|row| row[i].len()).max().unwrap_or(0)).collect();
    let line = |row: &[String; N]| {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("| {cell:width$} "));
        cells.collect::<String>() + "|\n"
    };
    let rules: Vec<String> = widths.iter().map(|width| "-".repeat(width + 2)).collect();
    let rule = format!("|{}|\n", rules.join("|"));
    let mut lines = rows.iter().map(line);
    lines.next().unwrap_or_default() + &rule + &lines.collect::<String>()
}

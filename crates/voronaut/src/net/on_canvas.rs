//! Circles by distances on a canvas, where geodesics are not resolved: around singular points of the metric, where shortest
//! paths all lead through a small region and polynomials do not follow them.

use super::Ball;
use crate::canvas::Canvas;
use crate::diagram::{Diagram, NerveTriangle};
use crate::error::Result;
use crate::geometry::Point;
use crate::metric::MetricField;

/// The circles of triangles by the diagram of seeds, of which each has its number, on a canvas around them: `None` of
/// those whose three cells do not meet there. Powers are those of all seeds on the canvas, and err, as distances on it do, by
/// some thousandths of the squared radius.
///
/// # Errors
/// A seed is outside the canvas's domain.
pub fn measure_on_canvas(
    canvas: &Canvas,
    field: &dyn MetricField,
    seeds: &[(u32, Point)],
    triangles: &[[u32; 3]],
) -> Result<Vec<Option<Ball<3>>>> {
    let places: Vec<Point> = seeds.iter().map(|seed| seed.1).collect();
    let diagram = Diagram::new(canvas, field, &places)?;
    let nerve = diagram.sharp_nerve();
    let colour = |i: u32| seeds.iter().position(|seed| seed.0 == i).map(|colour| colour as u32);
    let find = |&corners: &[u32; 3]| {
        let [Some(a), Some(b), Some(c)] = corners.map(colour) else { return None };
        let turns = [[a, b, c], [b, c, a], [c, a, b]];
        let simplex = nerve.triangles.iter().find(|t| turns.contains(&t.colours))?;
        ball(&diagram, simplex, corners, |colour| seeds[colour as usize].0)
    };
    Ok(triangles.iter().map(find).collect())
}

fn ball(
    diagram: &Diagram,
    simplex: &NerveTriangle,
    corners: [u32; 3],
    number: impl Fn(u32) -> u32,
) -> Option<Ball<3>> {
    let square = simplex.square?;
    let [a, b, c] = diagram.corners_of(&[simplex.witness])[0];
    let centre = a + ((b - a) + (c - a)) * (1.0 / 3.0);
    let power = simplex.fourth.map_or(f64::INFINITY, |(_, gap)| gap * square);
    let nearest = simplex.fourth.map(|(colour, _)| number(colour));
    Some(Ball { corners, centre, radius: square.sqrt(), power, nearest, is_interior: true })
}

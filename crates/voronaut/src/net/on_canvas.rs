//! Circles by distances on a canvas, where geodesics are not resolved: around singular points of the metric, where shortest
//! paths all lead through a small region and polynomials do not follow them.

use super::{Ball, SeedsOnSurface};
use crate::canvas::Canvas;
use crate::diagram::{Diagram, NerveTriangle, SurfaceDiagram};
use crate::error::Result;
use crate::geometry::Point;
use crate::metric::MetricField;

/// The circles of the triangles whose cells meet in the diagram of seeds, of which each has its number, on a canvas around
/// them. Powers are those of all seeds on the canvas, and err, as distances on it do, by some thousandths of the squared radius.
///
/// # Errors
/// A seed is outside the canvas's domain.
pub(crate) fn circles_on_canvas(
    canvas: &Canvas,
    field: &dyn MetricField,
    seeds: &[(u32, Point)],
) -> Result<Vec<Ball<3>>> {
    let places: Vec<Point> = seeds.iter().map(|seed| seed.1).collect();
    let diagram = Diagram::new(canvas, field, &places)?;
    let nerve = diagram.sharp_nerve();
    Ok(nerve.triangles.iter().filter_map(|t| ball(&diagram, t, |colour| seeds[colour as usize].0)).collect())
}

impl<'a> SeedsOnSurface<'a> {
    /// The seeds of a diagram, of which none was removed.
    pub(crate) fn of(diagram: &SurfaceDiagram<'a>) -> Self {
        let draped = diagram.canvas().draped();
        let places = (0..diagram.colours() as u32).filter_map(|i| Some(*draped.place(diagram.seed(i)?))).collect();
        Self::new(draped.manifold(), draped.metric(), places)
    }
}

fn ball(diagram: &Diagram, simplex: &NerveTriangle, number: impl Fn(u32) -> u32) -> Option<Ball<3>> {
    let square = simplex.square?;
    let centre = Point::centroid(diagram.corners_of(&[simplex.witness])[0]);
    let power = simplex.fourth.map_or(f64::INFINITY, |(_, gap)| gap * square);
    let nearest = simplex.fourth.map(|(colour, _)| number(colour));
    let corners = simplex.colours.map(&number);
    Some(Ball { corners, centre, radius: square.sqrt(), power, nearest, is_interior: true })
}

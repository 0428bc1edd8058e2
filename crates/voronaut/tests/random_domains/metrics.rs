//! Random metrics of the kinds that break meshers, in the frame in which the domain was drawn.

use super::domains::Placement;
use super::random::Random;
use voronaut::geometry::{Point, Tensor, Vector};
use voronaut::manifold::domain::Domain;
use voronaut::metric::{Boundary, BoundarySizes, MetricField};

/// Sizes along and across an axis, and the axis' angle, in the frame of the drawing.
struct Cell {
    sizes: [f64; 2],
    angle: f64,
}

/// The metric of a case, with its name.
pub(crate) fn draw(random: &mut Random, domain: &Domain, placement: Placement) -> (&'static str, Box<dyn MetricField>) {
    let aspect = if random.chance(0.2) { 1.0 } else { random.size(1.0, 1000.0) };
    let (angle, centre) = (random.turn(), random.point(1.0));
    let rate = random.size(0.05, 20.0);
    let axis = Vector::new(angle.cos(), angle.sin());
    let along = move |p: Point| axis.dot(p - centre);
    let cell = move |angle: f64, h: f64, aspect: f64| Cell { sizes: [h, h / aspect], angle };
    match random.whole(0, 7) {
        0 => ("uniform", in_frame(placement, move |_| cell(angle, 1.0, aspect))),
        1 => ("graded", in_frame(placement, move |p| cell(angle, 1.0 + rate * (p - centre).norm(), aspect))),
        2 => ("rotating", in_frame(placement, move |p| cell(angle + rate * along(p), 1.0, aspect))),
        3 => ("kinked", in_frame(placement, move |p| cell(angle, 1.0, 1.0 + aspect * along(p).abs().min(1.0)))),
        4 => {
            let jump = move |p| if along(p) < 0.0 { cell(angle, 1.0, aspect) } else { cell(0.0, 1.0, 1.0) };
            ("jump", in_frame(placement, jump))
        }
        5 => {
            let around = move |p: Point| {
                let d = p - centre;
                cell(d.y.atan2(d.x), 1.0 + d.norm(), aspect)
            };
            ("around a point", in_frame(placement, around))
        }
        6 => {
            let layer = move |p| 1.0 / (aspect / (1.0 + (rate * along(p) * 20.0).powi(2))).max(1.0);
            ("layer", in_frame(placement, move |p| Cell { sizes: [layer(p), 1.0], angle }))
        }
        _ => ("boundary", Box::new(boundary(random, domain, placement.scale, aspect))),
    }
}

fn boundary(random: &mut Random, domain: &Domain, scale: f64, aspect: f64) -> Boundary {
    let sizes = BoundarySizes {
        h0: scale * random.size(1e-4, 0.1),
        growth: random.within(1.0, 2.0),
        aspect,
        h_max: if random.chance(0.5) { f64::INFINITY } else { scale },
    };
    Boundary::new(&domain.boundary(), sizes).expect("sizes make sense")
}

fn in_frame(placement: Placement, cell: impl Fn(Point) -> Cell + Sync + 'static) -> Box<dyn MetricField> {
    Box::new(move |p: Point| {
        let Cell { sizes, angle } = cell(placement.undo(p));
        let angle = angle + placement.angle;
        let [along, across] = sizes.map(|h| (h * placement.scale).powi(-2));
        let (s, c) = angle.sin_cos();
        Tensor::new(c * c * along + s * s * across, c * s * (along - across), s * s * along + c * c * across)
    })
}

//! The exact Riemannian Delaunay triangulation of given seeds, none moved and none added, and how sure each edge is:
//! `cargo run --release --example seeds`.

use voronaut::canvas::{Canvas, size_for};
use voronaut::diagram::Diagram;
use voronaut::dual::Road;
use voronaut::geometry::Point;
use voronaut::manifold::domain::Domain;
use voronaut::metric::Swirl;
use voronaut::progress::Silent;
use voronaut::recipe;

fn main() -> voronaut::Result<()> {
    let square = Domain::shape("rect:-2,-2,2,2")?;
    // The additive sequence of the plastic number.
    let part = |i: f64, step: f64| 4.0 * (i * step).fract() - 2.0;
    let seeds: Vec<Point> =
        (1..=200).map(f64::from).map(|i| Point::new(part(i, 0.754_877_67), part(i, 0.569_840_29))).collect();

    let metric = Swirl::default();
    let canvas = Canvas::intrinsic(square.planar(), &metric, size_for(seeds.len(), 60))?;
    let diagram = Diagram::new(&canvas, &metric, &seeds)?;
    let dual = recipe::dual(&diagram, Road::Both, &Silent);
    let (triangles, account) = (dual.triangles.len(), &dual.account);
    println!("{triangles} triangles, {} uncertain edges, least margin {:.3}", account.uncertain, account.min_margin);
    for [a, b, c] in dual.triangles.iter().take(5) {
        println!("{a} {b} {c}");
    }
    Ok(())
}

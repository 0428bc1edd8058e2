//! Orphans and inverted triangles of three Voronoi diagrams of the same seeds on the same canvas, as a table in Markdown:
//!
//! ```sh
//! cargo run --release --example orphans -- table swirl 500 1000 2000 4000
//! cargo run --release --example orphans -- picture swirl 1000 orphans.png
//! ```
//!
//! Metrics: `swirl` on [-2, 2]^2, any other specification on [-1, 1]^2. Seeds are *relaxed*, the vertices of `voronaut mesh
//! -n N` with its defaults, or *random*: N different vertices of the canvas, drawn evenly by splitmix64 from 1. The canvas
//! is even in the metric, so that these are random points of the metric's density. Canvases have 60 vertices per seed.
//!
//! Triangles are those of the nerve as canvas faces of three colours have it, nothing mended: *inverted* ones come out
//! clockwise or flat with straight edges (SRDT). *Open* ones have geodesic edges (RDT) that bound no region on their left. The
//! Riemannian dual is there once more as `voronaut dual` has it, *settled* by in-circle tests.

use std::collections::BTreeSet;
use std::error::Error;
use std::path::Path;
use voronaut::canvas::{Canvas, VERTICES_PER_SEED, size_for};
use voronaut::diagram::{Diagram, Kind};
use voronaut::dual::Road;
use voronaut::geodesic::Method;
use voronaut::geometry::{Aabb, Orientation, Point, orientation};
use voronaut::manifold::domain::Domain;
use voronaut::mesh::Mesh;
use voronaut::metric::{MetricField, MetricSpec};
use voronaut::net::Random;
use voronaut::progress::Silent;
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, GradedAt, MeshOptions, MetricOptions};
use voronaut::triangulation::VertexId;
use voronaut_draw::{Layers, Picture};

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["table", metric, ref counts @ ..] if !counts.is_empty() => table(&Scene::new(metric)?, counts),
        ["picture", metric, count, file] => picture(&Scene::new(metric)?, count.parse()?, Path::new(file)),
        _ => Err("table METRIC N..., or picture METRIC N FILE".into()),
    }
}

/// Where it is about.
struct Scene {
    name: String,
    is_swirl: bool,
    domain: Domain,
    field: Box<dyn MetricField>,
}

impl Scene {
    fn new(metric: &str) -> Outcome<Self> {
        let is_swirl = metric.starts_with("swirl");
        let shape = if is_swirl { "rect:-2,-2,2,2" } else { "rect:-1,-1,1,1" };
        let domain = Domain::shape(shape)?;
        let spec = MetricSpec::parse(metric)?;
        let field = recipe::metric(&spec, domain.planar(), &MetricOptions::default(), GradedAt::Scale(1.0))?.field;
        Ok(Self { name: metric.into(), is_swirl, domain, field })
    }

    fn field(&self) -> &dyn MetricField {
        self.field.as_ref()
    }

    fn canvas(&self, seeds: usize) -> Outcome<Canvas> {
        Ok(Canvas::intrinsic(self.domain.planar(), self.field(), size_for(seeds, VERTICES_PER_SEED))?)
    }

    fn relaxed(&self, count: usize) -> Outcome<Vec<Point>> {
        let options = MeshOptions { vertices: Some(count), ..MeshOptions::default() };
        let mesh = recipe::mesh(&self.domain, self.field(), &options, &Silent)?.mesh;
        Ok((0..mesh.points.len() as u32).map(|v| mesh.point(v)).collect())
    }
}

fn random(canvas: &Canvas, count: usize) -> Vec<Point> {
    let (mut random, mut chosen) = (Random::new(1), BTreeSet::new());
    while chosen.len() < count.min(canvas.vertex_count()) {
        chosen.insert((random.number() * canvas.vertex_count() as f64) as u32);
    }
    chosen.into_iter().map(|v| canvas.position(VertexId(v))).collect()
}

fn table(scene: &Scene, counts: &[&str]) -> Outcome<()> {
    println!("| metric | seeds | diagram | orphans | their vertices | triangles | inverted | open |");
    println!("|---|---|---|---|---|---|---|---|");
    for count in counts {
        let count = count.parse()?;
        let canvas = scene.canvas(count)?;
        for (name, seeds) in [("relaxed", scene.relaxed(count)?), ("random", random(&canvas, count))] {
            for kind in [Kind::LabelleShewchuk, Kind::DuWang, Kind::Riemannian] {
                let begin = format!("| {} | {} {name} | {kind}", scene.name, seeds.len());
                rows(&begin, &Diagram::of_kind(kind, &canvas, scene.field(), &seeds, Method::March)?);
            }
        }
    }
    Ok(())
}

fn rows(begin: &str, diagram: &Diagram) {
    let orphans = diagram.orphan_components();
    let orphans = format!("{} | {}", orphans.len(), orphans.concat().len());
    let row = |what: &str, triangles: &[[u32; 3]], open: &str| {
        let inverted = triangles.iter().filter(|&&t| is_inverted(diagram, t)).count();
        println!("{begin}{what} | {orphans} | {} | {inverted} | {open} |", triangles.len());
    };
    let nerve: Vec<[u32; 3]> = diagram.nerve().triangles.iter().map(|t| t.colours).collect();
    if diagram.kind() != Kind::Riemannian {
        return row("", &nerve, "");
    }
    let settled = recipe::dual(diagram, Road::default(), &Silent).triangles;
    for (what, triangles) in [("", nerve), (", settled", settled)] {
        row(what, &triangles, &Realisation::new(diagram, &triangles).open().to_string());
    }
}

fn is_inverted(diagram: &Diagram, triangle: [u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|i| diagram.seed(i).unwrap_or_default());
    orientation(a, b, c) != Orientation::Left
}

/// Labelle-Shewchuk, Du-Wang and Riemannian cells of relaxed seeds in the middle of the domain, side by side, orphans in red.
fn picture(scene: &Scene, count: usize, file: &Path) -> Outcome<()> {
    const PIXELS: u32 = 350;
    const GAP: u32 = 10;
    let (canvas, seeds) = (scene.canvas(count)?, scene.relaxed(count)?);
    let half = if scene.is_swirl { 1.0 } else { 0.5 };
    let window = Some(Aabb { min: Point::new(-half, -half), max: Point::new(half, half) });
    let mut parts = String::new();
    for (place, kind) in [Kind::LabelleShewchuk, Kind::DuWang, Kind::Riemannian].into_iter().enumerate() {
        let cells = Diagram::of_kind(kind, &canvas, scene.field(), &seeds, Method::March)?.to_cells();
        let what = Picture { mesh: false, width: PIXELS, window, ..Picture::default() };
        // No witnesses are drawn, but all three are as pale as if some were.
        let layers = Layers { cells: Some(cells), witnesses: Some([Vec::new(), Vec::new()]), ..Layers::default() };
        let part = voronaut_draw::svg_with(&Mesh::default(), None, &what, &layers)?;
        parts += &part.replacen("<svg ", &format!("<svg x=\"{}\" ", place as u32 * (PIXELS + GAP)), 1);
    }
    let size = format!("width=\"{}\" height=\"{PIXELS}\"", 3 * PIXELS + 2 * GAP);
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" {size}>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{parts}</svg>\n"
    );
    Ok(voronaut_io::write(file, &voronaut_draw::picture_bytes(&svg, file)?)?)
}

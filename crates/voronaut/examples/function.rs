//! Adapts a mesh to a function, so that linear interpolation errs least, and compares with an even mesh:
//! `cargo run --release --example function`.

use voronaut::manifold::domain::Domain;
use voronaut::metric::{Expression, Norm, Snapshot, Uniform, Variables};
use voronaut::progress::Silent;
use voronaut::quality::interpolation_error;
use voronaut::recipe::{GradedAt, MeshOptions, MetricOptions, PlanarMetric, mesh_for, metric_of_function};

fn main() -> voronaut::Result<()> {
    let square = Domain::shape("rect:0,0,1,1")?;
    let front = "tanh(40*(y - 0.5 - 0.25*sin(2*pi*x)))";
    let function: Snapshot = Expression::parse(front, Variables::Plane)?.into();
    let (norm, vertices) = (Norm::default(), Some(2000));
    let options = MeshOptions { vertices, ..MeshOptions::default() };

    let optimal =
        metric_of_function(&function, square.planar(), &MetricOptions::default(), GradedAt::of(vertices, None))?;
    for (name, metric) in [("even", PlanarMetric::plain(Uniform::default())), ("adapted", optimal)] {
        let mesh = mesh_for(&square, metric.field.as_ref(), metric.aim(norm), &options, &Silent)?.mesh;
        let error = interpolation_error(&mesh, &function, norm)?;
        println!("{name}: {} vertices, L2 error {:.2e}", mesh.points.len(), error.norm);
        voronaut_io::write_mesh(&mesh, format!("{name}.vtu").as_ref())?;
    }
    Ok(())
}

//! The whole job: bytes as domain, metric and options, in the plane and on surfaces. What comes out is a valid mesh or an error that helps.
#![no_main]

use libfuzzer_sys::arbitrary::{Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use voronaut::Error;
use voronaut::manifold::domain::{Domain, Polygon, Polygons, Ring, from_polygons};
use voronaut::dual::Road;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::{Bounds, MetricSpec};
use voronaut::progress::Silent;
use voronaut::quality::{Meetings, validity, validity_on};
use voronaut::recipe::{self, GradedAt, MeshOptions, MetricOptions, Seeding};
use voronaut::manifold::Manifold;
use voronaut::manifold::surface::{FeatureOptions, metric};

/// What users write as a metric; the letters are replaced by numbers.
const PLANAR: [&str; 8] = [
    "uniform:A,B,0.3", "swirl", "swirl:field=printed", "shock:phi=A,lambda=B", "hessian:tanh(A*(x+B*y))",
    "hessian:x^2-A*y^2", "formula:1+A*x^2; 0; 1+B*y^2", "boundary:h0=B,growth=1.5",
];
const ON_SURFACES: [&str; 3] = ["uniform", "curvature", "uniform:A"];

fuzz_target!(|input: &[u8]| {
    let bytes = &mut Unstructured::new(input);
    let _ = if bytes.ratio(3, 4).unwrap_or(true) { plane(bytes) } else { surface(bytes) };
});

fn plane(bytes: &mut Unstructured) -> Result<()> {
    let Some(domain) = accepted(from_polygons(&polygons(bytes)?).and_then(|pslg| Domain::new(&pslg))) else { return Ok(()) };
    let options = options(bytes)?;
    let text = numbered(bytes.choose(&PLANAR)?, bytes)?;
    let gradation = if bytes.ratio(1, 8)? { Some(f64::from(bytes.int_in_range(105..=300)?) / 100.0) } else { None };
    let metric = MetricOptions { gradation, bounds: bounds(bytes)?, ..MetricOptions::default() };
    let at = GradedAt::of(options.vertices, None);
    let field = MetricSpec::parse(&text).and_then(|spec| recipe::metric(&spec, domain.planar(), &metric, at));
    let Some(field) = accepted(field) else { return Ok(()) };
    let meshed = match recipe::mesh_for(&domain, field.field.as_ref(), field.aim(metric.norm), &options, &Silent) {
        Err(error @ Error::Mesh { .. }) => panic!("{error}: {text}, {options:?}"),
        made => made,
    };
    let Some(made) = accepted(meshed) else { return Ok(()) };
    let checked = validity(&made.mesh);
    assert!(checked.valid, "{:?}: {text}, {options:?}", checked.first_fault);
    Ok(())
}

fn surface(bytes: &mut Unstructured) -> Result<()> {
    let mesh = grid(bytes)?;
    let Some(whole) = accepted(Manifold::of(&mesh)) else { return Ok(()) };
    let ar = if bytes.arbitrary()? { Some(f64::from(bytes.int_in_range(5..=120)?)) } else { None };
    let Some(input) = accepted(whole.cut(&FeatureOptions { ar })) else { return Ok(()) };
    let options = options(bytes)?;
    let text = numbered(bytes.choose(&ON_SURFACES)?, bytes)?;
    let bounds = bounds(bytes)?;
    let field = metric::Spec::parse(&text).and_then(|spec| metric::field(&spec, &input, bounds));
    let Some(field) = accepted(field) else { return Ok(()) };
    let Some(made) = accepted(recipe::mesh_surface(&input, field.as_ref(), None, &options, &Silent)) else { return Ok(()) };
    let checked = validity_on(&made.mesh, &Meetings::of(mesh));
    assert!(checked.valid, "{:?}: {text}, {options:?}", checked.first_fault);
    Ok(())
}

/// What was made, or nothing after an error that says what, where and what to do.
fn accepted<T>(made: voronaut::Result<T>) -> Option<T> {
    made.map_err(|error| assert!(!error.help().is_empty() && error.to_string().len() > 10, "{error}")).ok()
}

/// Rings with corners on a grid of 256 by 256, or moved off it by little.
fn polygons(bytes: &mut Unstructured) -> Result<Polygons> {
    let scale = 10_f64.powi(bytes.int_in_range(-9..=9)?);
    let mut rings = Vec::new();
    for _ in 0..bytes.int_in_range(1..=3)? {
        let mut points = Vec::new();
        for _ in 0..bytes.int_in_range(3..=12)? {
            let [x, y]: [i8; 2] = bytes.arbitrary()?;
            let moved = if bytes.ratio(1, 4)? { 1e-14 * f64::from(bytes.arbitrary::<i8>()?) } else { 0.0 };
            points.push(Point::new(scale * (f64::from(x) / 64.0 + moved), scale * (f64::from(y) / 64.0 - moved)));
        }
        rings.push(Ring { points, label: 1 });
    }
    Ok(Polygons { polygons: vec![Polygon { feature: 1, number: 1, region: 1, rings }] })
}

/// A grid of up to 6 by 6 cells over the plane with heights, of which cells may be missing.
fn grid(bytes: &mut Unstructured) -> Result<Mesh> {
    let n: u32 = bytes.int_in_range(1..=6)?;
    let high = f64::from(bytes.arbitrary::<u8>()?) / 4096.0;
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..=n {
            let z = high * f64::from(bytes.arbitrary::<i8>()?);
            mesh.points.push([f64::from(i) / f64::from(n), f64::from(j) / f64::from(n), z]);
            mesh.point_labels.push(0);
        }
    }
    for i in 0..n {
        for j in 0..n {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| i * (n + 1) + j);
            if !bytes.ratio(1, 8)? {
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
                mesh.triangle_labels.extend([1, 1]);
            }
        }
    }
    Ok(mesh)
}

/// Options that leave the work small.
fn options(bytes: &mut Unstructured) -> Result<MeshOptions> {
    Ok(MeshOptions {
        vertices: Some(bytes.int_in_range(1..=100)?),
        hausd: if bytes.ratio(1, 8)? { Some(0.001 * f64::from(bytes.arbitrary::<u8>()?)) } else { None },
        lloyd: bytes.int_in_range(0..=12)?,
        seeding: *bytes.choose(&[Seeding::Sizing, Seeding::Sizing, Seeding::Farthest])?,
        dual: *bytes.choose(&[Road::Both, Road::Both, Road::Geodesic, Road::Canvas])?,
        canvas_size: 20,
        ..MeshOptions::default()
    })
}

fn bounds(bytes: &mut Unstructured) -> Result<Bounds> {
    let a_max = if bytes.ratio(1, 8)? { Some(1.0 + f64::from(bytes.arbitrary::<u8>()?)) } else { None };
    Ok(Bounds { a_max, ..Bounds::default() })
}

/// The text with numbers of three digits in place of its letters A and B.
fn numbered(text: &str, bytes: &mut Unstructured) -> Result<String> {
    let mut number = || Ok(format!("{}e{}", bytes.int_in_range(1..=99)?, bytes.int_in_range(-3..=1)?));
    Ok(text.replace('A', &number()?).replace('B', &number()?))
}

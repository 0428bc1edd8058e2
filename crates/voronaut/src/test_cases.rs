//! What tests of many modules share: domains, and how many cases property tests try.

use crate::geometry::Point;
use crate::manifold::domain::{Domain, Polygon, Polygons, Ring, from_polygons};
use crate::mesh::Mesh;
use proptest::test_runner::Config;

/// The domain within the first ring and outside the others.
pub(crate) fn plate(rings: &[&[[f64; 2]]]) -> Domain {
    let ring =
        |points: &&[[f64; 2]]| Ring { points: points.iter().map(|&[x, y]| Point::new(x, y)).collect(), label: 1 };
    let polygon = Polygon { feature: 1, number: 1, region: 1, rings: rings.iter().map(ring).collect() };
    Domain::new(&from_polygons(&Polygons { polygons: vec![polygon] }).unwrap()).unwrap()
}

/// The six sides of a cube with n by n squares each, whose vertices inside are moved along their side.
pub(crate) fn cube(n: u32, wobble: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let step = 1.0 / f64::from(n);
    for side in 0..6_usize {
        let (axis, sign) = (side % 3, side / 3);
        let first = mesh.points.len() as u32;
        for k in 0..(n + 1) * (n + 1) {
            let (i, j) = (k % (n + 1), k / (n + 1));
            let is_inside = !(i.is_multiple_of(n) || j.is_multiple_of(n));
            let off = f64::from(u8::from(is_inside)) * wobble * step * (f64::from(i * 7 + j * 13) * 1.7).sin();
            let mut p = [sign as f64; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (f64::from(i) * step + off, f64::from(j) * step - off);
            mesh.points.push(p);
        }
        for k in 0..n * n {
            let a = first + k % n + k / n * (n + 1);
            let cell = [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]];
            mesh.triangles.extend(if sign == 1 { cell } else { cell.map(|[a, b, c]| [a, c, b]) });
        }
    }
    mesh
}

/// What comes out on so many threads.
pub(crate) fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

/// What a property test runs with that needs so many cases; where the environment names a number, as in `PROPTEST_CASES=10000`,
/// that one counts. (`Config::with_cases` knows nothing of it.)
pub(crate) fn cases(count: u32) -> Config {
    let named = Config::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { named.cases } else { count };
    // Cases that assumptions rule out are more where there are more cases.
    Config { cases, max_global_rejects: named.max_global_rejects.max(cases), ..named }
}

//! What tests of many modules share: domains, and how many cases property tests try.

use crate::domain::{Domain, Polygon, Polygons, Ring, from_polygons};
use crate::geometry::Point;
use proptest::test_runner::Config;

/// The domain within the first ring and outside the others.
pub(crate) fn plate(rings: &[&[[f64; 2]]]) -> Domain {
    let ring =
        |points: &&[[f64; 2]]| Ring { points: points.iter().map(|&[x, y]| Point::new(x, y)).collect(), label: 1 };
    let polygon = Polygon { feature: 1, number: 1, region: 1, rings: rings.iter().map(ring).collect() };
    Domain::new(&from_polygons(&Polygons { polygons: vec![polygon] }).unwrap()).unwrap()
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

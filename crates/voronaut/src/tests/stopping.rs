//! Work that is told to stop ends in that error, whenever it is told.

use crate::error::{Error, Result};
use crate::manifold::Manifold;
use crate::manifold::domain::Domain;
use crate::manifold::surface::metric::{Spec, field};
use crate::metric::{Bounds, Expression, MetricField, Norm, Snapshot, Swirl, Uniform, Variables};
use crate::progress::Progress;
use crate::recipe::{self, Aim, Effort, MeshOptions, Seeding};
use std::sync::atomic::{AtomicU64, Ordering};

/// Says stop when it has been asked so often.
struct Patience {
    asked: AtomicU64,
    most: u64,
}

impl Patience {
    fn of(most: u64) -> Self {
        Self { asked: AtomicU64::new(0), most }
    }
}

impl Progress for Patience {
    fn stage(&self, _: &'static str, _: u64) {}

    fn done(&self, _: u64) {}

    fn is_stopped(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.most
    }
}

/// The first time, in the middle, and the last time.
fn stops(least: u64, job: impl Fn(&dyn Progress) -> Result<()>) {
    let endless = Patience::of(u64::MAX);
    job(&endless).unwrap();
    let asked = endless.asked.into_inner();
    assert!(asked >= least, "asked {asked} times");
    for most in [0, asked / 2, asked - 1] {
        let found = job(&Patience::of(most));
        assert!(matches!(found, Err(Error::Stopped)), "{most} of {asked}: {found:?}");
    }
}

#[test]
fn planar_meshes() {
    let domain = Domain::shape("rect:-1,-1,1,1").unwrap();
    let metrics: [&dyn MetricField; 2] = [&Swirl::default(), &Uniform::default()];
    for (metric, seeding, least) in [(metrics[0], Seeding::Sizing, 20), (metrics[1], Seeding::Protected, 22)] {
        let options = MeshOptions { vertices: Some(300), seeding, canvas_size: 3, ..MeshOptions::default() };
        stops(least, |progress| recipe::mesh(&domain, metric, &options, progress).map(drop));
    }
}

#[test]
fn polished_meshes() {
    let domain = Domain::shape("rect:0,0,1,1").unwrap();
    let options = MeshOptions { vertices: Some(200), polish: 5, effort: Effort::Best, ..MeshOptions::default() };
    let function: Snapshot = Expression::parse("sin(3*x)*cos(5*y)", Variables::Plane).unwrap().into();
    let aim = || Some(Aim { function: &function, norm: Norm::default(), known_to: 0.0 });
    stops(45, |progress| recipe::mesh_for(&domain, &Uniform::default(), aim(), &options, progress).map(drop));
}

#[test]
fn surface_meshes() {
    let manifold = Manifold::shape("torus:2,0.7", None).unwrap();
    let metric = field(&Spec::parse("curvature").unwrap(), &manifold, Bounds::default()).unwrap();
    let options = MeshOptions { vertices: Some(200), fit: true, ..MeshOptions::default() };
    stops(20, |progress| recipe::mesh_surface(&manifold, metric.as_ref(), None, &options, progress).map(drop));
}

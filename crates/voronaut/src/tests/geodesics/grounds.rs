//! What the suite runs on: the plane or a surface with a metric and some places, canvases of it, and what is found on these.

use crate::Result;
use crate::canvas::{Canvas, Draped, Kind};
use crate::diagram::{Distances, SurfaceDistances};
use crate::geodesic::Method;
use crate::geometry::{Point, Point3, Tensor3, Vector3};
use crate::manifold::Manifold;
use crate::manifold::domain::Domain;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::metric::MetricField;
use crate::tests::wavy::Wavy;
use crate::triangulation::VertexId;
use std::sync::Arc;

/// A domain or a surface, with a metric.
#[derive(Clone)]
enum Land {
    Plane(Arc<Domain>, Arc<dyn MetricField + Send + Sync>),
    Surface(Arc<Manifold>, Arc<dyn SurfaceMetric + Send + Sync>),
}

/// See the module; the first [`FROM`] places are sources, others are where paths start. In the plane z is 0.
#[derive(Clone)]
pub(crate) struct Ground {
    pub(crate) name: &'static str,
    pub(crate) places: Vec<Point3>,
    land: Land,
}

/// Sources among the places.
pub(crate) const FROM: usize = 5;

/// Points well apart in the square around the origin: five, and four others.
pub(crate) fn points(half: f64) -> Vec<Point> {
    let corners = [(-0.62, -0.55), (0.7, -0.31), (0.13, 0.66), (-0.71, 0.4), (0.05, -0.04)];
    let others = corners[..4].iter().map(|&(x, y)| Point::new(0.95 * half * y, -0.95 * half * x));
    corners.iter().map(|&(x, y)| Point::new(half * x, half * y)).chain(others).collect()
}

fn in_space(p: Point) -> Point3 {
    Point3::new(p.x, p.y, 0.0)
}

/// A square around the origin.
pub(crate) fn square(half: f64, field: impl MetricField + Send + 'static) -> Ground {
    let domain = Domain::shape(&format!("rect:{},{},{half},{half}", -half, -half)).unwrap();
    planar(domain, field, &points(half))
}

/// A planar domain with places in it.
pub(crate) fn planar(domain: Domain, field: impl MetricField + Send + 'static, places: &[Point]) -> Ground {
    let places = places.iter().map(|&p| in_space(p)).collect();
    Ground { name: "plane", places, land: Land::Plane(Arc::new(domain), Arc::new(field)) }
}

fn on_surface(name: &'static str, manifold: Manifold, metric: Tensor3, places: Vec<Point3>) -> Ground {
    let metric = move |_: Point3| metric;
    Ground { name, places, land: Land::Surface(Arc::new(manifold), Arc::new(metric)) }
}

/// Points of the unit sphere, some nearly opposite to each other.
fn on_sphere() -> impl Iterator<Item = Point3> {
    points(1.0).into_iter().map(|p| {
        let (angle, z) = (4.2 * p.x, 1.3 * p.y);
        let r = (1.0 - z * z).sqrt();
        Point3::new(r * angle.cos(), r * angle.sin(), z)
    })
}

/// The unit sphere with its own metric.
pub(crate) fn sphere() -> Ground {
    on_surface("sphere", Manifold::shape("sphere:1", Some(0.3)).unwrap(), Tensor3::IDENTITY, on_sphere().collect())
}

/// The point of the unit sphere that a point of the [`stretched_sphere`] is mapped to.
pub(crate) fn relaxed(p: Point3) -> Point3 {
    Point3::new(p.x / 4.0 + 0.2 * p.y, p.y, p.z)
}

/// An ellipsoid that a linear map takes to the unit sphere, with the metric that makes distances those of the images.
pub(crate) fn stretched_sphere() -> Ground {
    let manifold = Manifold::shape("implicit:(x/4+0.2*y)^2+y^2+z^2-1;-5,-1.1,-1.1,5,1.1,1.1", Some(0.4)).unwrap();
    let metric = Tensor3 { xx: 1.0 / 16.0, xy: 0.05, yy: 1.04, ..Tensor3::IDENTITY };
    let stretched = |p: Point3| Point3::new(4.0 * (p.x - 0.2 * p.y), p.y, p.z);
    on_surface("stretched sphere", manifold, metric, on_sphere().map(stretched).collect())
}

/// The sheet of the cases.
pub(crate) fn wavy() -> Wavy {
    Wavy::new(41)
}

/// A wavy sheet of triangles that unrolls, with a metric by which it is so many times as long as it is.
pub(crate) fn sheet(name: &'static str, times: f64) -> Ground {
    let wavy = wavy();
    let on_sheet = |p: &Point| wavy.rolled(Point::new(0.5 * wavy.length() * (1.0 + p.x), p.y));
    let along = times * times;
    let metric = Tensor3 { xx: along, zz: along, ..Tensor3::IDENTITY };
    on_surface(name, wavy.manifold(15), metric, points(1.0).iter().map(on_sheet).collect())
}

/// All surfaces.
pub(crate) fn surfaces() -> [Ground; 4] {
    [sphere(), stretched_sphere(), sheet("sheet", 1.0), sheet("stretched sheet", 4.0)]
}

/// A metric times a factor.
struct Times<M>(M, f64);

impl SurfaceMetric for Times<Arc<dyn SurfaceMetric + Send + Sync>> {
    fn at(&self, place: &crate::manifold::Place) -> Tensor3 {
        self.0.at(place) * self.1
    }
}

impl MetricField for Times<Arc<dyn MetricField + Send + Sync>> {
    fn at(&self, p: Point) -> crate::geometry::Tensor {
        self.0.at(p) * self.1
    }
}

impl Ground {
    /// Methods that there are on it.
    pub(crate) fn methods(&self) -> impl Iterator<Item = Method> + use<> {
        let is_plane = matches!(self.land, Land::Plane(..));
        Method::ALL.into_iter().filter(move |&method| is_plane || method != Method::Lbr)
    }

    /// The same with a factor on its metric tensor.
    pub(crate) fn times(&self, factor: f64) -> Self {
        let land = match self.land.clone() {
            Land::Plane(domain, field) => Land::Plane(domain, Arc::new(Times(field, factor))),
            Land::Surface(manifold, metric) => Land::Surface(manifold, Arc::new(Times(metric, factor))),
        };
        Self { land, ..self.clone() }
    }

    /// A canvas with so many vertices, on a surface the places among them.
    pub(crate) fn board(&self, kind: Kind, vertices: usize) -> Board<'_> {
        match &self.land {
            Land::Plane(domain, field) => {
                let canvas = Canvas::new(kind, domain.planar(), field.as_ref(), vertices).unwrap();
                let places = self.places.iter().map(|p| Point::new(p.x, p.y)).collect();
                Board::Plane(canvas, field.as_ref(), places)
            }
            Land::Surface(manifold, metric) => {
                let places: Vec<_> = self.places.iter().map(|&p| manifold.closest(p).unwrap()).collect();
                let (canvas, at) = Canvas::on_surface(kind, manifold, metric.as_ref(), vertices, &places).unwrap();
                Board::Surface(canvas, at)
            }
        }
    }
}

/// A canvas, and where on it the places are.
pub(crate) enum Board<'a> {
    Plane(Canvas, &'a dyn MetricField, Vec<Point>),
    Surface(Canvas<Draped<'a>>, Vec<VertexId>),
}

impl Board<'_> {
    pub(crate) fn vertex_count(&self) -> usize {
        match self {
            Self::Plane(canvas, ..) => canvas.vertex_count(),
            Self::Surface(canvas, _) => canvas.vertex_count(),
        }
    }

    /// Where a vertex is.
    pub(crate) fn position(&self, v: VertexId) -> Point3 {
        match self {
            Self::Plane(canvas, ..) => in_space(canvas.position(v)),
            Self::Surface(canvas, _) => canvas.draped().position(v),
        }
    }

    /// Where a place is.
    pub(crate) fn place(&self, i: usize) -> Point3 {
        match self {
            Self::Plane(.., places) => in_space(places[i]),
            Self::Surface(_, at) => self.position(at[i]),
        }
    }

    /// Distances from some of the places, by their numbers.
    pub(crate) fn distances(&self, from: &[usize], method: Method) -> Result<Found<'_>> {
        Ok(match self {
            Self::Plane(canvas, field, places) => {
                let from: Vec<Point> = from.iter().map(|&i| places[i]).collect();
                Found::Plane(Distances::new(canvas, *field, &from, method)?, places)
            }
            Self::Surface(canvas, places) => {
                let from: Vec<VertexId> = from.iter().map(|&i| places[i]).collect();
                Found::Surface(SurfaceDistances::on_surface(canvas, &from, method)?, places)
            }
        })
    }

    /// The distances between the first places, each row by one run.
    pub(crate) fn table(&self, method: Method) -> Vec<Vec<f64>> {
        let row = |i: usize| {
            let found = self.distances(&[i], method).unwrap();
            (0..FROM).map(|j| found.at(j)).collect()
        };
        (0..FROM).map(row).collect()
    }
}

/// Distances on a canvas.
pub(crate) enum Found<'a> {
    Plane(Distances<'a>, &'a [Point]),
    Surface(SurfaceDistances<'a>, &'a [VertexId]),
}

impl Found<'_> {
    pub(crate) fn values(&self) -> &[f64] {
        match self {
            Self::Plane(found, _) => found.values(),
            Self::Surface(found, ..) => found.values(),
        }
    }

    /// The distance of a place.
    pub(crate) fn at(&self, i: usize) -> f64 {
        match self {
            Self::Plane(found, places) => found.at(places[i]).unwrap(),
            Self::Surface(found, places) => found.values()[places[i].index()],
        }
    }

    pub(crate) fn parent(&self, v: VertexId) -> Option<VertexId> {
        match self {
            Self::Plane(found, _) => found.parent(v),
            Self::Surface(found, ..) => found.parent(v),
        }
    }

    /// The path from a place, and its length.
    pub(crate) fn path(&self, i: usize) -> Result<(Vec<Point3>, f64)> {
        match self {
            Self::Plane(found, places) => {
                let path = found.path(places[i])?;
                Ok((path.points.into_iter().map(in_space).collect(), path.length))
            }
            Self::Surface(found, places) => {
                let way = found.path(places[i])?;
                Ok((way.points, way.length))
            }
        }
    }
}

/// The length of the great circle between two points of the unit sphere.
pub(crate) fn great_circle(p: Point3, q: Point3) -> f64 {
    let [p, q] = [p, q].map(|p| p - Point3::default());
    let across: Vector3 = p.cross(q);
    across.norm().atan2(p.dot(q))
}

//! The isotropic canvas (RR-9103, section 6.2): Euclidean Delaunay refinement by a sizing field.

use super::CanvasCounters;
use super::buckets::Buckets;
use super::star::centre;
use super::steiner::{Placed, Steiner};
use crate::error::Result;
use crate::geometry::{Point, Tensor};
use crate::metric::{MetricField, check_tensor};
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge, Lawson, VertexId};

/// The size at a point is a sixth of the metric's unit in its finest direction: the authors' choice.
const SHARE: f64 = 1.0 / 6.0;

/// The size (Euclidean) that the metric asks of an isotropic canvas at a point: 1 / (6 sqrt(largest eigenvalue)).
pub(crate) fn isotropic_size(tensor: Tensor) -> f64 {
    SHARE / tensor.eigen().large.sqrt()
}

/// When refinement ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Until {
    /// With so many vertices,
    pub(super) vertices: usize,
    /// or when no circumradius exceeds so many sizes.
    pub(super) sizes: f64,
}

/// Inserts the circumcentre of the face whose circumradius is largest beside its size, again and again.
///
/// Every free vertex comes at the centre of an empty circle larger than `sizes` sizes, and fixed edges are halved only
/// where such a circle meets them, so that it ends in any domain.
///
/// # Errors
/// The metric is not positive definite where a size is asked for.
pub(super) fn refine(
    planar: Planar,
    field: &dyn MetricField,
    until: Until,
    counters: &mut CanvasCounters,
) -> Result<Planar> {
    let mut refiner =
        Refiner { steiner: Steiner::euclidean(planar), field, sizes: until.sizes, queue: Buckets::default() };
    refiner.steiner.flip_all();
    for f in refiner.steiner.planar.topology.faces().collect::<Vec<_>>() {
        refiner.examine(f)?;
    }
    while refiner.steiner.planar.topology.vertex_count() < until.vertices {
        let Some((f, corners)) = refiner.queue.pop() else { break };
        let topology = &refiner.steiner.planar.topology;
        if topology.is_face(f) && topology.corners(f) == corners {
            counters.splits += u64::from(refiner.cut(f, corners)?);
        }
    }
    Ok(refiner.steiner.planar)
}

struct Refiner<'a> {
    steiner: Steiner<'a>,
    field: &'a dyn MetricField,
    sizes: f64,
    queue: Buckets<(FaceId, [VertexId; 3])>,
}

impl Refiner<'_> {
    /// Queues a face if it is too large.
    fn examine(&mut self, f: FaceId) -> Result<()> {
        let planar = &self.steiner.planar;
        let Some(ratio) = sizes(self.field, planar.triangle(f))? else { return Ok(()) };
        if ratio > self.sizes {
            self.queue.push(ratio, (f, planar.topology.corners(f)));
        }
        Ok(())
    }

    /// Puts a vertex at the centre of a face's circle, or on the fixed edge in its way; says whether there is a new vertex.
    fn cut(&mut self, f: FaceId, corners: [VertexId; 3]) -> Result<bool> {
        let triangle = self.steiner.planar.triangle(f);
        let Some((centre, radius)) = circle(triangle) else { return Ok(false) };
        let placed = self.steiner.place(f, centre, radius)?;
        for changed in self.steiner.take_changed() {
            self.examine(changed)?;
        }
        let topology = &self.steiner.planar.topology;
        if matches!(placed, Placed::Halved(_)) && topology.is_face(f) && topology.corners(f) == corners {
            self.examine(f)?;
        }
        Ok(placed != Placed::Refused)
    }
}

/// A triangle's circumradius in units of the size at its circumcentre; at its centroid where the metric is not defined
/// there, which may be far outside the domain. `None` for one that is flat but for rounding.
///
/// # Errors
/// The metric is not positive definite at the centroid either.
pub(super) fn sizes(field: &dyn MetricField, triangle: [Point; 3]) -> Result<Option<f64>> {
    let Some((centre, radius)) = circle(triangle) else { return Ok(None) };
    let centroid = Point::centroid(triangle);
    // Circumcentres farther away than the longest edge say nothing of the triangle.
    let is_near = centre.distance(centroid) <= Point::longest_side(triangle);
    let mut tensor = if is_near { field.at(centre) } else { field.at(centroid) };
    if is_near && !tensor.is_positive_definite() {
        tensor = field.at(centroid);
    }
    check_tensor(tensor, centroid)?;
    Ok(Some(radius / isotropic_size(tensor)))
}

/// Centre and radius of a triangle's Euclidean circle; `None` where it is flat but for rounding.
fn circle(triangle: [Point; 3]) -> Option<(Point, f64)> {
    centre(triangle).map(|(centre, square)| (centre, square.sqrt()))
}

/// Halves edges, given by their ends, and flips by the Euclidean test; an edge that is gone is passed over.
pub(super) fn halve(mut planar: Planar, edges: &[[VertexId; 2]], counters: &mut CanvasCounters) -> Planar {
    let mut lawson = Lawson::default();
    for &[a, b] in edges {
        let Some(h) = planar.topology.edge_between(a, b) else { continue };
        let [p, q] = planar.ends(h);
        if let Some(v) = planar.insert_on_edge(h, p.midpoint(q)) {
            lawson.queue(planar.topology.star(v).map(HalfEdge::next));
            planar.legalise(&mut lawson);
            counters.splits += 1;
        }
    }
    planar
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Canvas, Kind};
    use crate::geometry::Vector;
    use crate::manifold::domain::Domain;
    use crate::metric::{Shock, Uniform};

    /// Angles of a triangle at most and at least (degrees), Euclidean.
    fn least_angle([a, b, c]: [Point; 3]) -> f64 {
        let at = |p: Point, q: Point, r: Point| (q - p).cross(r - p).atan2((q - p).dot(r - p)).to_degrees();
        at(a, b, c).min(at(b, c, a)).min(at(c, a, b))
    }

    fn worst(canvas: &Canvas, field: &dyn MetricField) -> (f64, f64) {
        let planar = canvas.embedded();
        let triangles: Vec<_> = planar.topology.faces().map(|f| planar.triangle(f)).collect();
        let ratios = triangles.iter().map(|&t| sizes(field, t).unwrap().unwrap());
        (ratios.fold(0.0, f64::max), triangles.iter().map(|&t| least_angle(t)).fold(180.0, f64::min))
    }

    #[test]
    fn circles_are_no_larger_than_their_size_and_angles_not_small() {
        let shock = Shock { phi: 1.0, lambda: 0.6 };
        let turned = Uniform(Tensor::from_axis(Vector::new(0.6, 0.8), 40.0, 1.0));
        for (spec, field) in
            [("rect:-1,-1,1,1", &shock as &dyn MetricField), ("rect:0,0,3,1", &turned), ("disk:0,0,1", &shock)]
        {
            let domain = Domain::shape(spec).unwrap();
            let canvas = Canvas::isotropic_sized(domain.planar(), field, 0.5).unwrap();
            let (ratio, angle) = worst(&canvas, field);
            assert!(ratio <= 0.5, "{spec}: {ratio}");
            // The corners of the disk's polygon are nearer to each other than the size.
            assert!(angle > 20.0 || spec.starts_with("disk"), "{spec}: {angle}");
            canvas.topology().check().unwrap();
            assert!(canvas.embedded().is_embedded() && canvas.kind() == Kind::Isotropic);
            assert!((canvas.embedded().area() / domain.area() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn it_is_delaunay_with_as_many_vertices_as_asked_for() {
        let domain = Domain::shape("rect:-1,-1,1,1").unwrap();
        let canvas = Canvas::new(Kind::Isotropic, domain.planar(), &Shock { phi: 1.0, lambda: 0.6 }, 3000).unwrap();
        assert_eq!(canvas.vertex_count(), 3000);
        let mut planar = canvas.embedded().clone();
        let mut lawson = Lawson::default();
        lawson.queue(planar.topology.edges());
        planar.legalise(&mut lawson);
        let corners = |p: &Planar| p.topology.faces().map(|f| p.topology.corners(f)).collect::<Vec<_>>();
        assert_eq!(corners(&planar), corners(canvas.embedded()));
        let (ratio, angle) = worst(&canvas, &Shock { phi: 1.0, lambda: 0.6 });
        assert!(ratio < 2.0 && angle > 20.0, "{ratio} {angle}");
    }

    #[test]
    fn scaling_domain_and_metric_together_changes_nothing() {
        let make = |scale: f64| {
            let domain = Domain::shape(&format!("rect:0,0,{},{scale}", 2.0 * scale)).unwrap();
            let field = move |p: Point| {
                let x = p.x / scale;
                Tensor::new(1.0 + 8.0 * x * x, 0.5, 1.0) * (1.0 / (scale * scale))
            };
            Canvas::new(Kind::Isotropic, domain.planar(), &field, 800).unwrap()
        };
        let (one, large) = (make(1.0), make(64.0));
        let scaled: Vec<Point> = one.embedded().positions.iter().map(|p| Point::new(64.0 * p.x, 64.0 * p.y)).collect();
        assert_eq!(scaled, large.embedded().positions);
    }

    #[test]
    fn small_angles_of_the_domain_are_survived() {
        // A needle of a third of a degree, and a notch as thin.
        let outline = [[0.0, 0.0], [3.0, 0.009], [3.0, 1.0], [1.5, 0.02], [0.0, 1.0]];
        let domain = crate::test_cases::plate(&[&outline]);
        let field = Uniform(Tensor::isotropic(1.0));
        let canvas = Canvas::isotropic_sized(domain.planar(), &field, 0.5).unwrap();
        assert!(canvas.vertex_count() < 3000, "{}", canvas.vertex_count());
        canvas.topology().check().unwrap();
        assert!(canvas.embedded().is_embedded());
    }

    #[test]
    fn refining_an_isotropic_canvas_keeps_its_vertices_and_kind() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let field = Uniform(Tensor::new(9.0, 0.0, 1.0));
        let canvas = Canvas::new(Kind::Isotropic, domain.planar(), &field, 200).unwrap();
        let refined = canvas.refined(&field, &[VertexId(7)]).unwrap();
        assert!(refined.kind() == Kind::Isotropic && refined.vertex_count() > 201);
        assert_eq!(refined.embedded().positions[..200], canvas.embedded().positions[..]);
    }
}

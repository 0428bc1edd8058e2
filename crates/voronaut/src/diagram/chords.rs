//! Which diagram; distances straight through the plane, or on a surface through space, in a metric that is frozen: the diagrams
//! of Du and Wang and of Labelle and Shewchuk.

use super::{Frozen, Ground, Seed};
use crate::error::named;
use crate::geodesic::{Label, MarchCounters, Propagation};
use crate::geometry::{Bounds, BoxTree};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// By what distance a place is given to its nearest seed; its names are those users type (`--voronoi`).
///
/// The last two measure along the straight segment, with one tensor for all of it: what they call near may be far on the
/// way, and in a domain with holes or bays they see through walls, on a surface from one side to the other. Their cells may fall into parts of which only one holds
/// the seed (`Diagram::orphans`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// `riemannian`: by the geodesic distance, along the canvas.
    #[default]
    Riemannian,
    /// `du-wang`: |x - p| in the metric at the place x (Du and Wang 2005).
    DuWang,
    /// `labelle-shewchuk`: |x - p| in the metric at the seed p (Labelle and Shewchuk 2003).
    LabelleShewchuk,
}

named!(Kind, "Voronoi diagram", [Riemannian = "riemannian", DuWang = "du-wang", LabelleShewchuk = "labelle-shewchuk"]);

/// Which tensor a chord is measured with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Chords {
    /// That at the seed (Labelle and Shewchuk).
    InMetricOfSeed,
    /// That at the place whose distance it is (Du and Wang).
    InMetricOfPlace,
}

impl Chords {
    /// The distance of a place from a seed.
    pub(super) fn length(self, seed: &Frozen, place: &Frozen) -> f64 {
        match self {
            Chords::InMetricOfSeed => seed.length(place.at - seed.at),
            Chords::InMetricOfPlace => place.length(place.at - seed.at),
        }
    }

    /// Every canvas vertex with its nearest seed, of equally near ones the first: exact but for the rounding of lengths.
    pub(super) fn propagate<'a, G: Ground<'a>>(self, ground: G, seeds: &[Option<Seed<G::Place>>]) -> Propagation {
        let frozen = |seed: &Seed<G::Place>| ground.frozen(seed.at);
        let sites = (0..).zip(seeds).filter_map(|(colour, seed)| Some((colour, frozen(seed.as_ref()?))));
        let nearest = Nearest::new(self, sites);
        let label = |v: u32| {
            let found = nearest.find(&ground.frozen(ground.place(VertexId(v))));
            found.map_or(Label::FAR, |(distance, colour)| Label::of_source(distance, colour))
        };
        let vertices = (0..ground.topology().vertex_slots() as u32).into_par_iter();
        Propagation::of(vertices.with_min_len(1024).map(label).collect(), MarchCounters::default())
    }
}

/// The nearest of many seeds, each with its colour, where each, or the place that asks, has its own tensor.
///
/// A way v has v' M v >= (v.x / r)^2, where r is how far the unit ball of M reaches along x, and likewise by y and z: what a box is
/// away by a coordinate bounds the length of every way to it from below. Boxes have these reaches of their seeds as three
/// more coordinates.
struct Nearest {
    chords: Chords,
    seeds: BoxTree<(u32, Frozen), 6>,
}

/// Bounds stay clear of rounding by this share.
const ROUNDING: f64 = 1e-12;

impl Nearest {
    fn new(chords: Chords, seeds: impl Iterator<Item = (u32, Frozen)>) -> Self {
        let boxed = |(colour, seed): (u32, Frozen)| {
            let ([x, y, z], [rx, ry, rz]) = (seed.at.to_array(), seed.reach());
            ([[x, y, z, rx, ry, rz]; 2], (colour, seed))
        };
        Self { chords, seeds: BoxTree::new(seeds.map(boxed)) }
    }

    /// The least distance of a place from a seed, and that seed's colour, of equal distances the smallest. `None` without seeds.
    fn find(&self, place: &Frozen) -> Option<(f64, u32)> {
        let reach = (self.chords == Chords::InMetricOfPlace).then(|| place.reach());
        let at = place.at.to_array();
        // What the square of no way to a seed of a box is below.
        let floor = |[low, high]: &Bounds<6>| {
            let along = |k: usize| {
                let away = (low[k] - at[k]).max(at[k] - high[k]).max(0.0);
                away / reach.map_or(high[3 + k], |reach| reach[k])
            };
            (1.0 - ROUNDING) * along(0).max(along(1)).max(along(2)).powi(2)
        };
        let mut best: Option<(f64, u32)> = None;
        self.seeds.search_by(f64::INFINITY, floor, |_, &(colour, ref seed)| {
            let found = (self.chords.length(seed, place), colour);
            if best.is_none_or(|best| found.0 < best.0 || (found.0 <= best.0 && found.1 < best.1)) {
                best = Some(found);
            }
            // What is as near may have a smaller colour.
            best.map_or(f64::INFINITY, |(least, _)| (least * least).next_up())
        });
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Canvas;
    use crate::diagram::SurfaceDiagram;
    use crate::diagram::test_diagrams::{plate_with_hole, seeds_of};
    use crate::diagram::{Diagram, Kind};
    use crate::geodesic::Method;
    use crate::geometry::{Point, Point3, TangentPlane, Tensor, Tensor3, Vector3};
    use crate::manifold::Manifold;
    use crate::manifold::domain::Domain;
    use crate::metric::{MetricField, Swirl};

    const RIVALS: [(Kind, Chords); 2] =
        [(Kind::DuWang, Chords::InMetricOfPlace), (Kind::LabelleShewchuk, Chords::InMetricOfSeed)];

    fn frozen(field: &dyn MetricField, p: Point) -> Frozen {
        Frozen { at: Point3::new(p.x, p.y, 0.0), plane: TangentPlane::FLAT, tensor: field.at(p) }
    }

    fn vertices(canvas: &Canvas) -> impl Iterator<Item = VertexId> + use<> {
        (0..canvas.vertex_count() as u32).map(VertexId)
    }

    #[test]
    fn colours_are_those_of_all_pairs_compared_even_through_walls() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 4000).unwrap();
        let seeds = seeds_of(&domain, 60);
        for (kind, chords) in RIVALS {
            let diagram = Diagram::of_kind(kind, &canvas, &swirl, &seeds, Method::March).unwrap();
            for v in vertices(&canvas) {
                let to = |i: usize| chords.length(&frozen(&swirl, seeds[i]), &frozen(&swirl, canvas.position(v)));
                let best = (0..seeds.len()).min_by(|&i, &j| to(i).total_cmp(&to(j))).unwrap();
                assert_eq!((diagram.colour(v), diagram.distance(v)), (Some(best as u32), to(best)), "{kind} {v:?}");
            }
        }
    }

    #[test]
    fn the_two_freeze_the_metric_at_different_ends() {
        // Twice as long for each unit of x beyond 0: only the metric of the place sees that.
        let stretched = |p: Point| Tensor::new((1.0 + p.x.max(0.0)).powi(2), 0.0, 1.0);
        let [seed, place] = [Point::new(0.0, 0.0), Point::new(2.0, 0.0)];
        let length = |chords: Chords| chords.length(&frozen(&stretched, seed), &frozen(&stretched, place));
        assert_eq!((length(Chords::InMetricOfSeed), length(Chords::InMetricOfPlace)), (2.0, 6.0));
    }

    #[test]
    fn all_kinds_agree_in_a_uniform_metric() {
        let domain = Domain::shape("rect:-2,-2,2,2").unwrap();
        let uniform = |_: Point| Tensor::new(9.0, 2.0, 1.0);
        let canvas = Canvas::intrinsic(domain.planar(), &uniform, 6000).unwrap();
        let seeds = seeds_of(&plate_with_hole(), 50);
        let made = |kind| Diagram::of_kind(kind, &canvas, &uniform, &seeds, Method::March).unwrap();
        let [ours, du_wang, labelle] = Kind::ALL.map(made);
        let topology = canvas.topology();
        let longest = topology.edges().map(|h| topology.length(h)).fold(0.0, f64::max);
        let mut differing = 0;
        for v in vertices(&canvas) {
            assert_eq!(du_wang.label(v), labelle.label(v));
            let to = |diagram: &Diagram| {
                let seed = seeds[diagram.colour(v).unwrap() as usize];
                uniform(seed).length(canvas.position(v) - seed)
            };
            // Fronts meet within a canvas edge of where distances are equal.
            assert!(to(&ours) - to(&labelle) < 0.1 * longest, "{v:?}: {} {}", to(&ours), to(&labelle));
            differing += usize::from(ours.colour(v) != labelle.colour(v));
        }
        assert!(100 * differing < canvas.vertex_count(), "{differing}");
        assert!([ours, du_wang, labelle].iter().all(|diagram| diagram.orphans().is_empty()));
    }

    #[test]
    fn on_a_surface_colours_are_those_of_all_pairs_compared() {
        let manifold = Manifold::shape("sphere:1", None).unwrap();
        let metric = |p: Point3| Tensor3::from_disk([9.0 + 8.0 * p.y, 1.0, 2.0, 0.0, p.x, 3.0]);
        let places: Vec<_> = manifold.topology().vertices().step_by(9).map(|v| manifold.place_of(v).unwrap()).collect();
        let (canvas, at) =
            Canvas::on_surface(crate::canvas::Kind::Intrinsic, &manifold, &metric, 3000, &places).unwrap();
        let frozen = |v: VertexId| (&canvas).frozen(v);
        for (kind, chords) in RIVALS {
            let diagram = SurfaceDiagram::of_kind_on_surface(kind, &canvas, &at, Method::March).unwrap();
            for v in diagram.vertices() {
                let to = |i: usize| chords.length(&frozen(at[i]), &frozen(v));
                let best = (0..at.len()).min_by(|&i, &j| to(i).total_cmp(&to(j))).unwrap();
                assert_eq!((diagram.colour(v), diagram.distance(v)), (Some(best as u32), to(best)), "{kind} {v:?}");
            }
        }
    }

    /// Not what the metric says of the normal, but how long the way is: a chord of the sphere in the direction of its arc.
    #[test]
    fn ways_through_space_are_as_long_as_they_are() {
        let plane = TangentPlane::new(Vector3::new(0.0, 0.6, 0.8));
        let seed = Frozen { at: Point3::default(), plane, tensor: Tensor::new(4.0, 0.0, 9.0) };
        let along = |x: f64, y: f64, up: f64| plane.lift(crate::geometry::Vector::new(x, y)) + plane.normal * up;
        for (way, length) in
            [((3.0, 0.0, 4.0), 10.0), ((0.0, 3.0, 4.0), 15.0), ((0.0, 0.0, 2.0), 6.0), ((0.0, 0.0, 0.0), 0.0)]
        {
            assert!((seed.length(along(way.0, way.1, way.2)) - length).abs() < 1e-12, "{way:?}");
        }
    }

    #[test]
    fn changed_as_if_made_anew() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 3000).unwrap();
        let mut seeds = seeds_of(&domain, 30);
        for (kind, _) in RIVALS {
            let mut diagram = Diagram::of_kind(kind, &canvas, &swirl, &seeds[..29], Method::March).unwrap();
            diagram.insert(seeds[29]).unwrap();
            diagram.move_to(3, Point::new(-1.0, -1.5)).unwrap();
            assert!(diagram.remove(7));
            seeds[3] = Point::new(-1.0, -1.5);
            let kept: Vec<usize> = (0..30).filter(|&i| i != 7).collect();
            let left: Vec<Point> = kept.iter().map(|&i| seeds[i]).collect();
            let anew = Diagram::of_kind(kind, &canvas, &swirl, &left, Method::March).unwrap();
            for v in vertices(&canvas) {
                let colour = anew.colour(v).map(|colour| kept[colour as usize] as u32);
                assert_eq!((diagram.colour(v), diagram.distance(v)), (colour, anew.distance(v)));
            }
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 6000).unwrap();
        let seeds = seeds_of(&domain, 200);
        for (kind, _) in RIVALS {
            let colours = |threads| {
                crate::test_cases::on_threads(threads, || {
                    let diagram = Diagram::of_kind(kind, &canvas, &swirl, &seeds, Method::March).unwrap();
                    vertices(&canvas).map(|v| *diagram.label(v)).collect::<Vec<_>>()
                })
            };
            assert_eq!(colours(1), colours(3));
        }
    }

    #[test]
    fn metrics_that_are_none_at_a_seed_are_refused() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let seed = Point::new(0.3, 0.4);
        let pierced = |p: Point| if p == seed { Tensor::new(1.0, 2.0, 1.0) } else { Tensor::IDENTITY };
        let canvas = Canvas::intrinsic(domain.planar(), &pierced, 100).unwrap();
        for (kind, _) in RIVALS {
            let refused = Diagram::of_kind(kind, &canvas, &pierced, &[seed], Method::March).err().unwrap();
            assert!(refused.to_string().contains("not positive definite"), "{refused}");
        }
    }
}

//! Which diagram; distances straight through the plane, in a metric that is frozen: the diagrams of Du and Wang and of Labelle
//! and Shewchuk.

use super::ground::Straight;
use super::{Flat, Seed};
use crate::error::named;
use crate::geodesic::{Label, MarchCounters, Propagation};
use crate::geometry::{Bounds, BoxTree, Point, Tensor};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// By what distance a place is given to its nearest seed; its names are those users type (`--voronoi`).
///
/// The last two measure along the straight segment, with one tensor for all of it: what they call near may be far on the
/// way, and in a domain with holes or bays they see through walls. Their cells may fall into parts of which only one holds
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
    fn measured(self, field: &dyn MetricField, seed: Point, place: Point) -> f64 {
        let frozen_at = match self {
            Chords::InMetricOfSeed => seed,
            Chords::InMetricOfPlace => place,
        };
        field.at(frozen_at).length(place - seed)
    }
}

impl<'a> Straight<'a, Flat<'a>> for Chords {
    fn length(&self, ground: Flat, seed: Point, place: Point) -> f64 {
        self.measured(ground.field, seed, place)
    }

    /// Every canvas vertex with its nearest seed, of equally near ones the first: exact but for the rounding of lengths.
    fn propagate(&self, Flat { canvas, field }: Flat, seeds: &[Option<Seed<Point>>]) -> Propagation {
        let sites = (0..).zip(seeds).filter_map(|(colour, seed)| {
            let at = seed.as_ref()?.at;
            Some(Site { at, colour, tensor: field.at(at) })
        });
        let nearest = Nearest::new(sites);
        let label = |v: u32| {
            let place = canvas.position(VertexId(v));
            let frozen = (*self == Chords::InMetricOfPlace).then(|| field.at(place));
            nearest.find(place, frozen).map_or(Label::FAR, |(distance, colour)| Label::of_source(distance, colour))
        };
        let labels = (0..canvas.vertex_count() as u32).into_par_iter().with_min_len(1024).map(label).collect();
        Propagation::of(labels, MarchCounters::default())
    }
}

/// A point with its tensor.
#[derive(Clone, Copy, Debug)]
struct Site {
    at: Point,
    colour: u32,
    tensor: Tensor,
}

/// The nearest of many sites where each, or the place that asks, has its own tensor.
///
/// A chord v has v' M v >= (v.x / r)^2, where r is how far the unit ball of M reaches along x, and likewise by y: what a box is
/// away by either coordinate bounds the length of every chord to it from below. Boxes have these reaches of their sites as two
/// more coordinates.
struct Nearest(BoxTree<Site, 4>);

/// Bounds stay clear of rounding by this share.
const ROUNDING: f64 = 1e-12;

impl Nearest {
    fn new(sites: impl Iterator<Item = Site>) -> Self {
        let boxed = |site: Site| {
            let [x, y] = reach(site.tensor);
            ([[site.at.x, site.at.y, x, y]; 2], site)
        };
        Self(BoxTree::new(sites.map(boxed)))
    }

    /// The least length of a chord to a site and that site's colour, of equal lengths the smallest colour; in the given
    /// metric or, if none is, in each site's own. `None` without sites.
    fn find(&self, place: Point, frozen: Option<Tensor>) -> Option<(f64, u32)> {
        let reach = frozen.map(reach);
        let place_at = [place.x, place.y];
        // What the square of no chord to a site of a box is below.
        let floor = |[low, high]: &Bounds<4>| {
            let along = |k: usize| {
                let away = (low[k] - place_at[k]).max(place_at[k] - high[k]).max(0.0);
                away / reach.map_or(high[2 + k], |reach| reach[k])
            };
            (1.0 - ROUNDING) * along(0).max(along(1)).powi(2)
        };
        let mut best: Option<(f64, u32)> = None;
        self.0.search_by(f64::INFINITY, floor, |_, site| {
            let found = (frozen.unwrap_or(site.tensor).length(place - site.at), site.colour);
            if best.is_none_or(|best| found.0 < best.0 || (found.0 <= best.0 && found.1 < best.1)) {
                best = Some(found);
            }
            // What is as near may have a smaller colour.
            best.map_or(f64::INFINITY, |(least, _)| (least * least).next_up())
        });
        best
    }
}

/// How far the unit ball of a metric reaches along x, and along y.
fn reach(tensor: Tensor) -> [f64; 2] {
    [tensor.yy, tensor.xx].map(|across| (across / tensor.determinant()).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Canvas;
    use crate::diagram::test_diagrams::{plate_with_hole, seeds_of};
    use crate::diagram::{Diagram, Kind};
    use crate::domain::Domain;
    use crate::geodesic::Method;
    use crate::geometry::Tensor;
    use crate::metric::Swirl;

    const RIVALS: [(Kind, Chords); 2] =
        [(Kind::DuWang, Chords::InMetricOfPlace), (Kind::LabelleShewchuk, Chords::InMetricOfSeed)];

    fn vertices(canvas: &Canvas) -> impl Iterator<Item = VertexId> + use<> {
        (0..canvas.vertex_count() as u32).map(VertexId)
    }

    #[test]
    fn colours_are_those_of_all_pairs_compared_even_through_walls() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(&domain, &swirl, 4000).unwrap();
        let seeds = seeds_of(&domain, 60);
        for (kind, chords) in RIVALS {
            let diagram = Diagram::of_kind(kind, &canvas, &swirl, &seeds, Method::March).unwrap();
            for v in vertices(&canvas) {
                let to = |i: usize| chords.measured(&swirl, seeds[i], canvas.position(v));
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
        let length = |chords: Chords| chords.measured(&stretched, seed, place);
        assert_eq!((length(Chords::InMetricOfSeed), length(Chords::InMetricOfPlace)), (2.0, 6.0));
    }

    #[test]
    fn all_kinds_agree_in_a_uniform_metric() {
        let domain = Domain::shape("rect:-2,-2,2,2").unwrap();
        let uniform = |_: Point| Tensor::new(9.0, 2.0, 1.0);
        let canvas = Canvas::intrinsic(&domain, &uniform, 6000).unwrap();
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
    fn changed_as_if_made_anew() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(&domain, &swirl, 3000).unwrap();
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
        let canvas = Canvas::intrinsic(&domain, &swirl, 6000).unwrap();
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
        let canvas = Canvas::intrinsic(&domain, &pierced, 100).unwrap();
        for (kind, _) in RIVALS {
            let refused = Diagram::of_kind(kind, &canvas, &pierced, &[seed], Method::March).err().unwrap();
            assert!(refused.to_string().contains("not positive definite"), "{refused}");
        }
    }
}

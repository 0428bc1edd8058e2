//! Shortest paths: from a point to its seed, and between neighbouring seeds.

use super::Diagram;
use super::descend::Descent;
use super::overlap::Overlap;
use crate::canvas::Border;
use crate::error::{Error, Result};
use crate::geodesic::{Obstacles, Polyline, straighten};
use crate::geometry::Point;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// Diagrams with the distances of every cell and its surroundings, from which any number of paths are traced.
pub struct Paths<'d, 'a> {
    diagram: &'d Diagram<'a>,
    overlap: &'d Overlap,
    border: Border<'a>,
}

impl<'a> Diagram<'a> {
    /// What all paths need: distances computed anew around every cell.
    pub fn paths(&self) -> Paths<'_, 'a> {
        Paths { diagram: self, overlap: self.overlap(), border: Border::of(self.ground.canvas) }
    }
}

impl Paths<'_, '_> {
    /// The way from a point of the domain to its nearest seed, by descent on the canvas: a polyline within the domain that
    /// begins at the point and ends at the seed, as good as the canvas is fine. [`Paths::geodesic`] has it straight.
    ///
    /// # Errors
    /// [`Error::Domain`] of a point outside the domain, or one that no seed reaches.
    pub fn path(&self, from: Point) -> Result<Vec<Point>> {
        let nearest = self.nearest(from).ok_or_else(|| {
            let help = "take a point of the domain, of a part of it that holds a seed";
            Error::domain("no seed reaches the point", from.to_string(), help)
        })?;
        self.descend(from, nearest)
    }

    /// The geodesic from a point to its nearest seed: its path, straightened.
    ///
    /// # Errors
    /// As for [`Paths::path`].
    pub fn geodesic(&self, from: Point) -> Result<Polyline> {
        Ok(straighten(self.diagram.ground.field, &self.path(from)?, &self.border))
    }

    /// The geodesics between pairs of seeds whose cells touch, such as the edges of the nerve or of a dual, in parallel.
    ///
    /// Each is made of the two paths down from a canvas vertex that has the least sum of distances to both, straightened;
    /// of the straight segment between the seeds where no vertex knows of both. `None` where that leaves the domain, too,
    /// or one of them is no seed.
    pub fn geodesics(&self, pairs: &[[u32; 2]]) -> Vec<Option<Polyline>> {
        let passes = self.diagram.passes();
        let join = |&[a, b]: &[u32; 2]| {
            let pass = passes.between(a, b);
            let ends = [self.diagram.seed(a)?, self.diagram.seed(b)?];
            let joined = pass.and_then(|(_, v)| {
                let at = self.diagram.ground.canvas.position(v);
                let mut path = self.descend(at, a).ok()?;
                path.reverse();
                path.extend(self.descend(at, b).ok()?.into_iter().skip(1));
                Some(path)
            });
            let straight = || (!self.border.bars(ends[0], ends[1])).then(|| ends.to_vec());
            Some(straighten(self.diagram.ground.field, &joined.or_else(straight)?, &self.border))
        };
        pairs.par_iter().map(join).collect()
    }

    fn descend(&self, from: Point, colour: u32) -> Result<Vec<Point>> {
        let distance = |v: VertexId| self.overlap.distance(v, colour).unwrap_or(f64::INFINITY);
        let seed = self.diagram.seeds.get(colour as usize).and_then(Option::as_ref);
        let seeds: Vec<_> = seed.iter().map(|s| (s.at, s.starts.as_slice())).collect();
        let parent = |v: VertexId| self.diagram.parent(v).filter(|_| self.diagram.colour(v) == Some(colour));
        Descent { ground: self.diagram.ground, distance: &distance, parent: &parent }.polyline(from, &seeds)
    }

    /// The seed with the least interpolated distance at a point.
    fn nearest(&self, from: Point) -> Option<u32> {
        let weights = self.diagram.ground.canvas.weights(from)?;
        let at = |colour: u32| {
            let known = |v: VertexId| self.overlap.distance(v, colour).unwrap_or(f64::INFINITY);
            weights.iter().map(|&(v, weight)| weight * known(v)).sum::<f64>()
        };
        let colours = weights.iter().flat_map(|w| self.overlap.at(w.0)).map(|e| e.0);
        let all = colours.map(|colour| (at(colour), colour)).filter(|x| x.0.is_finite());
        all.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|best| best.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Canvas;
    use crate::diagram::test_diagrams::{plate_with_hole, seeds_of};
    use crate::geometry::Tensor;
    use crate::manifold::domain::Domain;
    use crate::metric::Swirl;

    #[test]
    fn paths_end_at_their_seed_and_distances_decrease() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 4000).unwrap();
        let diagram = Diagram::new(&canvas, &swirl, &seeds_of(&domain, 12)).unwrap();
        let paths = diagram.paths();
        for from in seeds_of(&domain, 300) {
            let path = paths.path(from).unwrap();
            let colour = paths.nearest(from).unwrap();
            assert_eq!((path[0], path[path.len() - 1]), (from, diagram.seed(colour).unwrap()));
            let at = |p: Point| {
                let weights = canvas.weights(p).unwrap();
                weights.iter().map(|&(v, w)| w * paths.overlap.distance(v, colour).unwrap()).sum::<f64>()
            };
            // Not the last two: interpolation is poor around the seed.
            let distances: Vec<f64> = path[..path.len().saturating_sub(2)].iter().map(|&p| at(p)).collect();
            assert!(distances.is_sorted_by(|a, b| *b <= a + 1e-9), "{from}: {distances:?}");
            assert!(path.windows(2).all(|w| !paths.border.bars(w[0], w[1])), "{from}");
            let straight = paths.geodesic(from).unwrap();
            assert!(straight.length <= Polyline::length_of(&swirl, &path) * (1.0 + 1e-12));
            assert!(straight.points.windows(2).all(|w| !paths.border.bars(w[0], w[1])), "{from}");
        }
        assert!(paths.path(Point::new(0.0, 0.0)).is_err(), "in the hole");
    }

    #[test]
    fn geodesics_bend_around_the_hole() {
        let domain = plate_with_hole();
        let tensor = Tensor::new(2.0, 0.3, 1.0);
        let field = move |_: Point| tensor;
        let canvas = Canvas::intrinsic(domain.planar(), &field, 4000).unwrap();
        let seeds = [Point::new(-1.0, 0.1), Point::new(1.0, -0.05)];
        let diagram = Diagram::new(&canvas, &field, &seeds).unwrap();
        let over = |corners: [Point; 2]| {
            let way = [seeds[0], corners[0], corners[1], seeds[1]];
            way.windows(2).map(|w| tensor.length(w[1] - w[0])).sum::<f64>()
        };
        let exact = [0.5, -0.5].map(|y| over([Point::new(-0.5, y), Point::new(0.5, y)]));
        let found = diagram.paths().geodesics(&[[1, 0]]);
        let found = found[0].as_ref().unwrap();
        let least = exact[0].min(exact[1]);
        assert!(found.length < 1.001 * least && found.length > least * (1.0 - 1e-9), "{} {exact:?}", found.length);
    }

    #[test]
    fn geodesics_of_the_half_plane_have_their_length() {
        let domain = Domain::shape("rect:-2,0.5,2,3").unwrap();
        let field = |p: Point| Tensor::isotropic(p.y);
        let canvas = Canvas::intrinsic(domain.planar(), &field, 6000).unwrap();
        let seeds: Vec<Point> =
            (0..14_u32).map(|i| Point::new(f64::from(i % 4) - 1.6, 1.2 + 0.45 * f64::from(i / 4))).collect();
        let diagram = Diagram::new(&canvas, &field, &seeds).unwrap();
        let edges: Vec<[u32; 2]> = diagram.nerve().edges.iter().map(|e| e.colours).collect();
        assert!(edges.len() > 20);
        for (pair, found) in edges.iter().zip(diagram.paths().geodesics(&edges)) {
            let [p, q] = pair.map(|c| seeds[c as usize]);
            let (exact, found) = ((1.0 + (q - p).dot(q - p) / (2.0 * p.y * q.y)).acosh(), found.unwrap());
            assert!((found.length / exact - 1.0).abs() < 1e-3, "{p} {q}: {} {exact}", found.length);
        }
    }

    #[test]
    fn geodesic_edges_meet_at_seeds_only() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 12_000).unwrap();
        let seeds = seeds_of(&domain, 60);
        let diagram = Diagram::new(&canvas, &swirl, &seeds).unwrap();
        let edges: Vec<[u32; 2]> = diagram.sharp_nerve().edges.iter().map(|e| e.colours).collect();
        let found = diagram.paths().geodesics(&edges);
        let near_seed = |p: Point| seeds.iter().any(|&s| s.distance(p) < 0.02);
        let mut crossings = Vec::new();
        for i in 0..edges.len() {
            for j in 0..i {
                let [one, other] = [i, j].map(|k| &found[k].as_ref().unwrap().points);
                for u in one.windows(2) {
                    for v in other.windows(2) {
                        let side = |a: Point, b: Point, p: Point| (b - a).cross(p - a) > 0.0;
                        let is_crossing = side(u[0], u[1], v[0]) != side(u[0], u[1], v[1])
                            && side(v[0], v[1], u[0]) != side(v[0], v[1], u[1]);
                        if is_crossing && !near_seed(u[0]) && !near_seed(v[0]) {
                            crossings.push((edges[i], edges[j], u[0]));
                        }
                    }
                }
            }
        }
        assert!(crossings.is_empty(), "{} of {} edges: {crossings:?}", crossings.len(), edges.len());
    }
}

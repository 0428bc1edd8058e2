//! Distances from heat: let it flow for a short time, follow its gradient at unit speed.

use super::label::Sources;
use super::update::layout;
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::sparse::{Cholesky, Elimination, Symmetric};
use crate::triangulation::{FaceId, Triangulation, VertexId};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Heat flows for the square of so many mean edges.
const EDGES: f64 = 1.0;
/// Heat below this share of the greatest is lost to underflow: the time is then made longer.
const LEAST_HEAT: f64 = 1e-280;
/// How often the time is made four times as long, at most.
const LENGTHENINGS: u32 = 8;
/// Faces are taken to be no flatter than this share of their base.
const FLATTEST: f64 = 1e-6;

/// The heat method (Crane 2013) on a triangulation, by its metric lengths alone: with M = F' F the isotropic method on faces
/// stretched by F. The matrices are factored once and serve for any sources.
///
/// It gives a smoothed distance to the nearest of all sources, of whatever colour, and no parents: it does not drive
/// diagrams. Borders are insulated. On a canvas that is not intrinsic Delaunay cotangents are negative and heat may be too.
pub(crate) struct Heat<'a> {
    canvas: &'a Triangulation,
    /// Metric area that belongs to each vertex.
    mass: Vec<f64>,
    stiffness: Symmetric,
    time: f64,
    elimination: Elimination,
    flow: Cholesky,
    poisson: Cholesky,
    /// The connected part that each vertex belongs to, by its first vertex.
    part: Vec<usize>,
}

impl<'a> Heat<'a> {
    /// Factors the matrices of a canvas.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where one is not positive definite by rounding.
    pub(crate) fn on(canvas: &'a Triangulation) -> Result<Self> {
        let n = canvas.vertex_slots();
        let (mass, stiffness) = matrices(canvas);
        let edges = canvas.edges().count().max(1) as f64;
        let mean = canvas.edges().map(|h| canvas.length(h)).sum::<f64>() / edges;
        let time = (EDGES * mean).powi(2);
        let part = canvas.vertex_parts();
        // One vertex of each part is held: sources and sinks of its flow balance, so that nothing flows there.
        let grounds: Vec<f64> = (0..n).map(|v| if part[v] == v { 1.0 } else { 0.0 }).collect();
        let elimination = Elimination::of(&stiffness);
        let (flow, poisson) = crate::parallel::join(
            || factor(&flow(&mass, &stiffness, time), &elimination),
            || factor(&stiffness.clone().plus_diagonal(&grounds), &elimination),
        );
        Ok(Self { canvas, mass, stiffness, time, elimination, flow: flow?, poisson: poisson?, part })
    }

    /// The distance of each vertex from the nearest source; infinite in parts without one.
    ///
    /// # Errors
    /// As for [`Heat::on`], where the time had to be made longer.
    pub(crate) fn distances(&self, sources: &Sources) -> Result<Vec<f64>> {
        let heat = self.heat(sources)?;
        let mut balance = vec![0.0; self.mass.len()];
        for f in self.canvas.faces() {
            let face = Face::of(self.canvas, f);
            let Some(direction) = face.downhill(&heat) else { continue };
            for (&v, slope) in face.corners.iter().zip(face.slopes) {
                balance[v] += face.area * direction.dot(slope);
            }
        }
        let mut distances = self.poisson.solve(&balance);
        self.shift(sources, &mut distances);
        Ok(distances)
    }

    /// Heat from a narrow bell around every source, after a short time. A source that gives its distance to a single vertex has
    /// all the heat of a bell, pi t, there: by the area of that vertex sources would be of unequal strength.
    fn heat(&self, sources: &Sources) -> Result<Vec<f64>> {
        let nearest: Vec<(usize, f64)> = starts(sources).collect();
        let mut time = self.time;
        let mut longer: Option<Cholesky> = None;
        let lone = lone(sources);
        for _ in 0..LENGTHENINGS {
            let mut start = vec![0.0; self.mass.len()];
            for &(v, distance) in &nearest {
                let area = if lone.contains(&v) { PI * time } else { self.mass[v] };
                start[v] = area * (-distance * distance / time).exponential();
            }
            let heat = longer.as_ref().unwrap_or(&self.flow).solve(&start);
            let most = heat.iter().copied().fold(0.0, f64::max);
            let is_warm =
                |v: usize| heat[v] > LEAST_HEAT * most || !nearest.iter().any(|&(u, _)| self.part[u] == self.part[v]);
            if (0..heat.len()).all(is_warm) {
                return Ok(heat);
            }
            time *= 4.0;
            longer = Some(factor(&flow(&self.mass, &self.stiffness, time), &self.elimination)?);
        }
        Err(Error::unsupported(
            "heat on a canvas so long that it vanishes on the way",
            "use another method, such as march",
        ))
    }

    /// Distances are known but for a constant in each part: that which fits the vertices around sources best. These keep
    /// the distances that they were given.
    fn shift(&self, sources: &Sources, distances: &mut [f64]) {
        let mut sums = vec![(0.0, 0.0); distances.len()];
        for (v, distance) in starts(sources) {
            let sum = &mut sums[self.part[v]];
            *sum = (sum.0 + distance - distances[v], sum.1 + 1.0);
        }
        for (v, distance) in distances.iter_mut().enumerate() {
            let (sum, count) = sums[self.part[v]];
            *distance = if count > 0.0 { (*distance + sum / count).max(0.0) } else { f64::INFINITY };
        }
        for (v, distance) in starts(sources) {
            distances[v] = distance;
        }
    }
}

/// The vertices that are the only ones of their source.
fn lone(sources: &Sources) -> BTreeSet<usize> {
    let mut of_colour: BTreeMap<u32, Option<usize>> = BTreeMap::new();
    for v in sources.vertices() {
        for &(_, colour) in sources.at(v) {
            of_colour.entry(colour).and_modify(|only| *only = None).or_insert(Some(v.index()));
        }
    }
    of_colour.into_values().flatten().collect()
}

fn starts(sources: &Sources) -> impl Iterator<Item = (usize, f64)> + '_ {
    sources.vertices().map(|v| (v.index(), sources.nearest(v).distance))
}

/// The area of each vertex, and the integrals of products of gradients of hat functions.
fn matrices(canvas: &Triangulation) -> (Vec<f64>, Symmetric) {
    let (mut mass, mut stiffness) = (vec![0.0; canvas.vertex_slots()], Vec::new());
    for f in canvas.faces() {
        let face = Face::of(canvas, f);
        for i in 0..3 {
            mass[face.corners[i]] += face.area / 3.0;
            for j in 0..3 {
                let value = face.area * face.slopes[i].dot(face.slopes[j]);
                stiffness.push((face.corners[i] as u32, face.corners[j] as u32, value));
            }
        }
    }
    let stiffness = Symmetric::from_triplets(mass.len(), &stiffness);
    (mass, stiffness)
}

fn flow(mass: &[f64], stiffness: &Symmetric, time: f64) -> Symmetric {
    let capacity: Vec<f64> = mass.iter().map(|mass| mass / time).collect();
    stiffness.clone().plus_diagonal(&capacity)
}

fn factor(matrix: &Symmetric, elimination: &Elimination) -> Result<Cholesky> {
    Cholesky::of(matrix, elimination).ok_or_else(|| {
        Error::unsupported(
            "heat on this canvas, whose matrix is not positive definite by rounding",
            "use another method, such as march, or limit the metric (`a_max`)",
        )
    })
}

/// A face laid out flat.
struct Face {
    corners: [usize; 3],
    area: f64,
    /// The gradients of the functions that are one at a corner and zero at the others.
    slopes: [Vector; 3],
}

impl Face {
    fn of(canvas: &Triangulation, f: FaceId) -> Self {
        let [base, to_end, to_start] = f.half_edges().map(|h| canvas.length(h));
        let (x, height) = layout(base, to_start, to_end);
        let y = height.max(FLATTEST * base);
        let area = 0.5 * base * y;
        // Across the side opposite to each corner, divided by twice the area.
        let sides = [Vector::new(x - base, y), Vector::new(-x, -y), Vector::new(base, 0.0)];
        let slopes = sides.map(|side| side.perpendicular() * (0.5 / area));
        Self { corners: canvas.corners(f).map(VertexId::index), area, slopes }
    }

    /// The unit vector against the gradient of a function.
    fn downhill(&self, values: &[f64]) -> Option<Vector> {
        let values = self.corners.map(|v| values[v]);
        // Heat far away is too small a number to be squared.
        let most = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let gradient = self.slopes.iter().zip(values).fold(Vector::default(), |sum, (&s, v)| sum + s * (v / most));
        let length = gradient.norm();
        (length > 0.0 && length.is_finite()).then(|| -gradient * (1.0 / length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Canvas, Kind};
    use crate::geometry::{Point3, Tensor3};
    use crate::manifold::Manifold;
    use crate::manifold::surface::metric::Constant;

    #[test]
    fn sources_are_equally_strong_whatever_area_their_vertices_have() {
        let (manifold, metric) = (Manifold::shape("sphere:1", Some(0.2)).unwrap(), Constant(Tensor3::IDENTITY));
        // The second one is a hundred times smaller than others: around it there are three more.
        let poles = [(0.0, 1.0), (0.0, -1.0), (2e-3, -1.0), (-1e-3, -1.0), (-2e-3, -1.0)];
        let place = |(i, (x, z)): (usize, (f64, f64))| {
            let y = if i == 3 { 2e-3 } else { 0.0 };
            manifold.closest(Point3::new(x, y, z)).unwrap()
        };
        let places: Vec<_> = poles.into_iter().enumerate().map(place).collect();
        let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, &manifold, &metric, 6000, &places).unwrap();
        let mut sources = Sources::new(canvas.vertex_count());
        sources.add(at[0], 0.0, 0);
        sources.add(at[1], 0.0, 1);
        let found = Heat::on(canvas.topology()).unwrap().distances(&sources).unwrap();
        // As far from one as from the other.
        let near = |z: f64| {
            let of_band = (0..canvas.vertex_count() as u32).map(VertexId).filter(|&v| {
                let at = canvas.draped().position(v).z;
                at * z > 0.0 && (at.abs() - 0.7).abs() < 0.05
            });
            let values: Vec<f64> = of_band.map(|v| found[v.index()]).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        assert!((near(1.0) / near(-1.0) - 1.0).abs() < 0.02, "{} {}", near(1.0), near(-1.0));
    }
}

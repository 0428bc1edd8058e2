//! A surface in parts: cut along edges of its own triangles, which are made finer where parts would have few.

use super::bisect::{areas_of, counts, join_around, owners};
use super::region::{CUT, refuse_label, submesh};
use super::stitch::{Kept, position_of};
use super::{COARSE, Divisible, Make, Part, Partition, in_parts, number_of_parts, with_count};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Point3, Tensor3};
use crate::lists::{Rows, distinct, in_order};
use crate::manifold::surface::Mark;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::mesh::{Mesh, Network};
use crate::metric::{Expression, Norm};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::quality::{Meetings, Validity, validity_on};
use crate::recipe::on_surface::SurfacePlan;
use crate::recipe::stopwatch::Stopwatch;
use crate::recipe::surface_pass::{Setting, demand};
use crate::recipe::{MeshOptions, Meshed, mesh_surface};
use crate::sampling::{MetricArc, pieces};
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// Cuts have so many edges at least, and closed ones: else two parts could have two edges between the same two vertices.
const LEAST: usize = 2;
const LEAST_OF_LOOP: usize = 3;
/// A place of a cut this near (as a share of the edge) to a vertex of the surface's triangles is there.
const AT_VERTEX: f64 = 1e-3;

/// A surface, cut along its features, with its metric.
#[derive(Clone, Copy)]
struct OnSurface<'a> {
    manifold: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
}

/// The mesh of a part of a surface, which is given whole and cut along its features.
///
/// # Errors
/// As of [`mesh_surface`].
pub fn mesh_surface_part(
    part: &Part,
    whole: &Manifold,
    metric: &dyn SurfaceMetric,
    aim: Option<(&Expression, Norm)>,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Mesh> {
    let own = whole.part(&part.domain)?;
    let metric = OfWhole::new(&own, whole, metric);
    let options = MeshOptions { hausd: None, ..with_count(options, part.vertices) };
    Ok(mesh_surface(&own, &metric, aim, &options, progress)?.mesh)
}

/// [`mesh_in_parts`](super::mesh_in_parts) of a surface that was cut along its features ([`Manifold::cut`]), whose parts are made by [`mesh_surface_part`]. Cuts are
/// along edges of its triangles. The number of vertices is met as nearly as parts meet theirs.
///
/// # Errors
/// As of [`mesh_in_parts`](super::mesh_in_parts); [`Error::Unsupported`] of vertices off the surface (`fit`) and of distances to it (`hausd`), too.
pub fn mesh_surface_in_parts(
    manifold: &Manifold,
    metric: &dyn SurfaceMetric,
    parts: Option<usize>,
    options: &MeshOptions,
    make: Make,
    progress: &dyn Progress,
) -> Result<Meshed> {
    in_parts(&OnSurface { manifold, metric }, parts, options, make, progress)
}

/// The metric of a surface as one of a part of it.
struct OfWhole<'a> {
    whole: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
    /// Of the whole, what is closest to the middle of each triangle of the part.
    near: Vec<Place>,
}

impl<'a> OfWhole<'a> {
    fn new(part: &Manifold, whole: &'a Manifold, metric: &'a dyn SurfaceMetric) -> Self {
        whole.prepare();
        let faces: Vec<FaceId> = part.topology().faces().collect();
        let near = |&f: &FaceId| {
            let middle = part.place(f, [1.0 / 3.0; 3]);
            whole.closest_facing(middle.position, middle.normal).unwrap_or(middle)
        };
        Self { whole, metric, near: faces.par_iter().with_min_len(64).map(near).collect() }
    }
}

impl SurfaceMetric for OfWhole<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        let near = &self.near[place.face.index()];
        self.metric.at(&self.whole.lift(near, place.position).unwrap_or(*near))
    }
}

impl Divisible for OnSurface<'_> {
    fn partition(&self, parts: Option<usize>, options: &MeshOptions, progress: &dyn Progress) -> Result<Partition> {
        if options.hausd.is_some() || options.fit {
            let help = "leave out `hausd` and `fit`, or `parts`: they are for the mesh as a whole";
            return Err(Error::unsupported("distances to the surface of a mesh in parts", help));
        }
        // The limit is that of each part.
        let options = MeshOptions { memory_limit: u64::MAX, ..options.clone() };
        let (meetings, watch) = (Meetings::of(self.manifold.whole_mesh()), Stopwatch::new(progress));
        let setting = Setting::new(self.manifold, self.metric, None, &options, &meetings, &watch)?;
        let SurfacePlan { count: vertices, scale, complexity } = setting.plan(None)?;
        let parts = number_of_parts(vertices, parts)?;
        let mut base = Base::new(*self)?;
        base.refine(COARSE * parts);
        let areas = base.divide(parts)?;
        let stations = base.cut(scale);
        let kept = base.kept();
        let parts = base.parts(&stations, &areas, scale, vertices);
        Ok(Partition { parts, scale, complexity, vertices, kept, notes: Vec::new() })
    }

    /// Edges of features are required of the parts where the surface requires them, and are creases where it has them.
    fn note_kept(&self, kept: &mut Kept, joined: &Mesh) {
        let at = |&e: &u32| in_order(joined.edges[e as usize].map(|v| position_of(joined.points[v as usize])));
        kept.edges.extend(joined.required_edges.iter().map(at));
        kept.ridges.extend(joined.ridges.iter().map(at));
    }

    /// Its features stay as they are.
    fn job(&self, mut region: Mesh) -> Result<Mesh> {
        region.require(0..region.edges.len() as u32);
        Ok(region)
    }

    fn check(&self, mesh: &Mesh) -> Result<Validity> {
        let found = validity_on(mesh, &Meetings::of(self.manifold.whole_mesh()));
        demand(self.manifold, mesh, &found)?;
        Ok(found)
    }

    /// By the mean of the lengths in the metrics at both ends.
    fn logarithms(&self, mesh: &Mesh, edges: &[[u32; 2]]) -> Vec<f64> {
        self.manifold.prepare();
        let mut normal = vec![crate::geometry::Vector3::default(); mesh.points.len()];
        for &t in &mesh.triangles {
            let [a, b, c] = mesh.positions_of(t);
            for v in t {
                normal[v as usize] = normal[v as usize] + (b - a).cross(c - a);
            }
        }
        let tensor = |v: u32| {
            let place = self.manifold.closest_facing(mesh.position(v), normal[v as usize])?;
            Some(self.metric.at(&place))
        };
        let vertices = (0..mesh.points.len() as u32).into_par_iter().with_min_len(64);
        let tensors: Vec<Option<Tensor3>> = vertices.map(tensor).collect();
        let length = |&[a, b]: &[u32; 2]| {
            let chord = mesh.position(b) - mesh.position(a);
            Some(0.5 * (tensors[a as usize]?.length(chord) + tensors[b as usize]?.length(chord)))
        };
        edges.iter().filter_map(length).map(|length| length.max(f64::MIN_POSITIVE).logarithm()).collect()
    }
}

/// The triangles of a surface before it was cut along its features, finer than they were.
struct Base<'a> {
    on: OnSurface<'a>,
    /// Regions are numbers of `sides`; fixed edges are features.
    topology: Triangulation,
    positions: Vec<Point3>,
    /// Labels, features and what is required.
    whole: Mesh,
    marks: Vec<Mark>,
    /// What triangles are part of: the surface's own triangle, and the part.
    sides: Vec<Side>,
}

#[derive(Clone, Copy)]
struct Side {
    home: FaceId,
    owner: u32,
}

impl<'a> Base<'a> {
    fn new(on: OnSurface<'a>) -> Result<Self> {
        let whole = with_features(on.manifold);
        whole.edge_labels.iter().try_for_each(|&label| refuse_label(label))?;
        let surface = Manifold::of(&whole)?;
        let mut topology = surface.topology().clone();
        let faces: Vec<FaceId> = topology.faces().collect();
        for &f in &faces {
            topology.set_region(f, f.0.cast_signed());
        }
        let homes: Vec<FaceId> = on.manifold.topology().faces().collect();
        let marks = (0..whole.edges.len() as u32)
            .map(|i| surface.surface().mark(crate::triangulation::Constraint(i)))
            .collect();
        let sides = homes.into_iter().map(|home| Side { home, owner: 0 }).collect();
        Ok(Self { on, topology, positions: surface.positions().to_vec(), whole, marks, sides })
    }

    fn side(&self, f: FaceId) -> &Side {
        &self.sides[self.topology.region(f) as usize]
    }

    fn position(&self, v: VertexId) -> Point3 {
        self.positions[v.index()]
    }

    /// What the surface says of an edge, of a feature.
    fn mark(&self, h: HalfEdge) -> Option<Mark> {
        Some(self.marks[self.topology.constraint(h)?.0 as usize])
    }

    /// The metric at a point of a triangle.
    fn tensor(&self, f: FaceId, p: Point3) -> Tensor3 {
        self.on.metric.at(&self.on.manifold.closest_on(self.side(f).home, p))
    }

    /// The longest edges are halved, so many in all; those that are required stay whole.
    fn refine(&mut self, mut halvings: usize) {
        let entry = |base: &Self, h: HalfEdge| {
            let [a, b] = base.topology.ends(h).map(|v| base.position(v));
            (base.tensor(h.face(), a.lerp(b, 0.5)).length(b - a).to_bits(), in_order(base.topology.ends(h)))
        };
        let edges: Vec<HalfEdge> = self.topology.edges().collect();
        let mut queue: BinaryHeap<(u64, [VertexId; 2])> =
            edges.par_iter().with_min_len(256).map(|&h| entry(self, h)).collect::<Vec<_>>().into();
        while halvings > 0
            && let Some((_, [a, b])) = queue.pop()
        {
            let Some(h) = self.topology.edge_between(a, b) else { continue };
            if self.mark(h).is_some_and(|mark| mark.is_required) {
                continue;
            }
            let middle = self.position(a).lerp(self.position(b), 0.5);
            let on = |h: HalfEdge| {
                let place = self.on.manifold.closest_on(self.side(h.face()).home, middle);
                if self.on.manifold.equation().is_none() {
                    Some(middle)
                } else {
                    Some(self.on.manifold.lift(&place, middle)?.position)
                }
            };
            let Some(p) = on(h).filter(|&p| p != self.position(a) && p != self.position(b)) else { continue };
            let (v, _) = self.split(h, p);
            halvings -= 1;
            queue.extend(self.topology.spokes(v).map(|h| entry(self, h)));
        }
    }

    /// Puts a vertex on an edge; what is left of the edge behind it.
    fn split(&mut self, h: HalfEdge, p: Point3) -> (VertexId, HalfEdge) {
        let v = self.topology.add_vertex();
        self.positions.resize(v.index() + 1, p);
        (v, self.topology.split_edge(h, v))
    }

    fn triangles(&self) -> Vec<[u32; 3]> {
        self.topology.faces().map(|f| self.topology.corners(f).map(|v| v.0)).collect()
    }

    /// Gives each triangle to a part; the metric area of each part.
    fn divide(&mut self, parts: usize) -> Result<Vec<f64>> {
        let faces: Vec<FaceId> = self.topology.faces().collect();
        let corners = |f: &FaceId| self.topology.corners(*f).map(|v| self.position(v));
        let centres: Vec<Point3> = faces.iter().map(|f| Point3::weighted(corners(f), [1.0 / 3.0; 3])).collect();
        let area = |(f, &centre): (&FaceId, &Point3)| {
            let [a, b, c] = corners(f);
            0.5 * self.tensor(*f, centre).area(b - a, c - a)
        };
        let areas: Vec<f64> = faces.par_iter().zip(&centres).with_min_len(64).map(area).collect();
        if let Some(i) = areas.iter().position(|area| !area.is_finite()) {
            let help = "give a metric whose eigenvalues are positive on the whole surface";
            return Err(Error::metric("its area is not finite", centres[i].to_string(), help));
        }
        let triangles = self.triangles();
        let mut owner = owners(&triangles, &centres, &areas, parts);
        self.leave_creases(&faces, &mut owner);
        let found = areas_of(&owner, &areas, parts);
        if !join_around(&triangles, &mut owner) || found.contains(&0.0) {
            let what = format!("a surface of {} triangles in {parts} parts", triangles.len());
            return Err(Error::limit(what, "ask for fewer parts"));
        }
        self.sides = faces.iter().zip(&owner).map(|(&f, &owner)| Side { home: self.side(f).home, owner }).collect();
        (0..).zip(&faces).for_each(|(i, &f)| self.topology.set_region(f, i));
        Ok(areas_of(&owner, &areas, parts))
    }

    /// Cuts along features go beside them, where they can.
    fn leave_creases(&self, faces: &[FaceId], owner: &mut [u32]) {
        let row: BTreeMap<FaceId, usize> = faces.iter().copied().zip(0..).collect();
        for h in self.topology.edges().filter(|&h| self.topology.is_fixed(h)) {
            let Some(twin) = self.topology.twin(h) else { continue };
            let [left, right] = [h, twin].map(|side| row[&side.face()]);
            let least = owner[left].min(owner[right]);
            (owner[left], owner[right]) = (least, least);
        }
    }

    /// Samples the cuts between parts at unit length, and makes their stations vertices, which it returns.
    fn cut(&mut self, scale: f64) -> BTreeSet<VertexId> {
        let is_cut = |&h: &HalfEdge| {
            let other = self.topology.twin(h).map(|twin| self.side(twin.face()).owner);
            other.is_some_and(|other| other != self.side(h.face()).owner)
        };
        let cuts: Vec<HalfEdge> = self.topology.edges().filter(is_cut).collect();
        let ends: Vec<[VertexId; 2]> = cuts.iter().map(|&h| self.topology.ends(h)).collect();
        let network = Network::new(self.positions.len(), ends.iter().map(|ends| ends.map(|v| v.0)));
        let stops = self.stops(&network, &cuts);
        let mut stations: BTreeSet<VertexId> = BTreeSet::new();
        for (start, chain) in network.chains(|v| stops.contains(&VertexId(v))) {
            let mut vertices = vec![VertexId(start)];
            for &edge in &chain {
                let [a, b] = ends[edge as usize];
                vertices.push(if a == vertices[vertices.len() - 1] { b } else { a });
            }
            stations.extend(self.sampled(&vertices, scale));
        }
        stations
    }

    /// Where chains of cuts end: where they fork, at features that they cross, and where what they run along changes.
    fn stops(&self, network: &Network, cuts: &[HalfEdge]) -> BTreeSet<VertexId> {
        let marks: Vec<Option<Mark>> = cuts.iter().map(|&h| self.mark(h)).collect();
        let is_stop = |&v: &u32| {
            let along = network.at(v);
            let marked = self.topology.spokes(VertexId(v)).filter(|&h| self.topology.is_fixed(h)).count();
            let of_cuts = along.iter().filter(|&&edge| marks[edge as usize].is_some()).count();
            let is_required = || along.iter().any(|&edge| marks[edge as usize].is_some_and(|mark| mark.is_required));
            let changes = || along.windows(2).any(|pair| marks[pair[0] as usize] != marks[pair[1] as usize]);
            along.len() != 2 || marked != of_cuts || changes() || is_required()
        };
        network.vertices().filter(is_stop).map(VertexId).collect()
    }

    /// Makes the stations of a chain vertices: its ends, and inner ones at even metric length, by the longer of both sides.
    fn sampled(&mut self, chain: &[VertexId], scale: f64) -> Vec<VertexId> {
        let is_closed = chain[0] == chain[chain.len() - 1];
        let edge = |i: usize| self.topology.edge_between(chain[i], chain[i + 1]);
        let is_required =
            (0..chain.len() - 1).any(|i| edge(i).and_then(|h| self.mark(h)).is_some_and(|m| m.is_required));
        if is_required {
            return chain.to_vec();
        }
        let arc = MetricArc::new(chain.len() - 1, |s, t| {
            let i = (0.5 * (s + t)) as usize;
            let [a, b] = [chain[i], chain[i + 1]].map(|v| self.position(v));
            let speed = |x: f64| {
                let sides = edge(i).into_iter().flat_map(|h| self.topology.sides(h));
                let at = |side: HalfEdge| self.tensor(side.face(), a.lerp(b, x - i as f64)).length(b - a);
                sides.map(at).fold(0.0, f64::max)
            };
            (speed(s) + 4.0 * speed(0.5 * (s + t)) + speed(t)) / 6.0 * (t - s)
        });
        let n = pieces(arc.length() * scale.sqrt()).max(if is_closed { LEAST_OF_LOOP } else { LEAST });
        let mut at_edges: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let mut stations = vec![chain[0], chain[chain.len() - 1]];
        for station in (1..n).map(|k| arc.parameter(k as f64 / n as f64)) {
            let nearest = station.round();
            if (station - nearest).abs() < AT_VERTEX {
                stations.push(chain[nearest as usize]);
            } else {
                at_edges.entry(station as usize).or_default().push(station.fract());
            }
        }
        for (i, shares) in at_edges {
            let [a, b] = [chain[i], chain[i + 1]];
            let (p, q) = (self.position(a), self.position(b));
            let Some(mut h) = self.topology.find(a, b).or_else(|| self.topology.find(b, a)) else { continue };
            let is_forward = self.topology.origin(h) == a;
            let ordered: Vec<f64> = if is_forward { shares } else { shares.into_iter().rev().collect() };
            for share in ordered {
                let (v, behind) = self.split(h, p.lerp(q, share));
                stations.push(v);
                h = behind;
            }
        }
        stations
    }

    /// Corners and required vertices of the whole.
    fn kept(&self) -> Kept {
        let places = |list: &[VertexId]| list.iter().map(|&v| position_of(self.position(v).to_array())).collect();
        let required: Vec<VertexId> = self.whole.required_points.iter().map(|&v| VertexId(v)).collect();
        Kept { corners: places(&self.on.manifold.features().corners), points: places(&required), ..Kept::default() }
    }

    /// The jobs of the parts.
    fn parts(&self, stations: &BTreeSet<VertexId>, areas: &[f64], scale: f64, vertices: usize) -> Vec<Part> {
        let mesh = self.mesh(stations);
        let owners: Vec<u32> = self.topology.faces().map(|f| self.side(f).owner).collect();
        let rows = Rows::new(areas.len(), (0..).zip(&owners).map(|(t, &owner)| (owner, t)));
        let cuts = self.topology.edges().filter(|&h| {
            self.topology.twin(h).is_some_and(|twin| self.side(twin.face()).owner != self.side(h.face()).owner)
        });
        let cuts: Vec<[u32; 2]> = cuts.map(|h| self.topology.ends(h).map(|v| v.0)).collect();
        let domains: Vec<Mesh> = (0..areas.len()).map(|part| submesh(&mesh, rows.row(part), &cuts).0).collect();
        // How many stations each has: as many vertices are fixed, and half of them stand for no triangles inside.
        let on_cut = |domain: &Mesh| {
            let ends = domain.edges.iter().zip(&domain.edge_labels).filter(|(_, label)| **label == CUT);
            let ends = distinct(ends.flat_map(|(ends, _)| *ends));
            domain.corners.iter().filter(|v| ends.binary_search(v).is_ok()).count() as f64
        };
        let fixed: Vec<f64> = domains.iter().map(on_cut).collect();
        let inside: Vec<f64> = areas
            .iter()
            .zip(&fixed)
            .map(|(area, fixed)| (2.0 / 3.0_f64.sqrt() * area * scale - 0.5 * fixed).max(1.0))
            .collect();
        let all = vertices as f64 + fixed.iter().sum::<f64>() - stations.len() as f64;
        let counts = counts(&fixed, &inside, all);
        domains.into_iter().zip(counts).map(|(domain, vertices)| Part { domain, vertices, metric: None }).collect()
    }

    /// As a mesh with features; stations are corners.
    fn mesh(&self, stations: &BTreeSet<VertexId>) -> Mesh {
        let homes = self.on.manifold.topology();
        let fixed: Vec<(HalfEdge, Mark)> = self.topology.edges().filter_map(|h| Some((h, self.mark(h)?))).collect();
        let marked = |is: fn(&Mark) -> bool| (0..).zip(&fixed).filter(|(_, (_, m))| is(m)).map(|(i, _)| i).collect();
        let mut point_labels = self.whole.point_labels.clone();
        point_labels.resize(self.positions.len(), 0);
        Mesh {
            points: self.positions.iter().map(|p| p.to_array()).collect(),
            point_labels,
            triangles: self.triangles(),
            triangle_labels: self.topology.faces().map(|f| homes.region(self.side(f).home)).collect(),
            edges: fixed.iter().map(|&(h, _)| self.topology.ends(h).map(|v| v.0)).collect(),
            edge_labels: fixed.iter().map(|(_, mark)| mark.label).collect(),
            ridges: marked(|mark| mark.is_ridge),
            required_edges: marked(|mark| mark.is_required),
            corners: distinct(self.whole.corners.iter().copied().chain(stations.iter().map(|v| v.0))),
            required_points: self.whole.required_points.clone(),
            required_triangles: self.whole.required_triangles.clone(),
            ..Mesh::default()
        }
    }
}

/// The triangles of a surface before it was cut, with its features as listed edges and what has to be kept as corners.
fn with_features(manifold: &Manifold) -> Mesh {
    let mut mesh = manifold.whole_mesh();
    let features = manifold.features();
    for curve in &features.curves {
        for edge in &curve.edges {
            let i = mesh.edges.len() as u32;
            mesh.edges.push([edge.from.0, edge.to.0]);
            mesh.edge_labels.push(curve.mark.label);
            mesh.ridges.extend(curve.mark.is_ridge.then_some(i));
            mesh.required_edges.extend(curve.mark.is_required.then_some(i));
        }
    }
    mesh.corners = features.stops.iter().map(|v| v.0).collect();
    mesh.required_points = manifold.required_points().iter().map(|v| manifold.seams().original(*v).0).collect();
    mesh.required_points = distinct(mesh.required_points);
    let rows: BTreeMap<FaceId, u32> = manifold.topology().faces().zip(0..).collect();
    mesh.required_triangles = manifold.required_triangles().iter().filter_map(|f| rows.get(f).copied()).collect();
    mesh
}

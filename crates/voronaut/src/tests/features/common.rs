//! Whether the mesh of a part has the part's features: by what the generator of parts knows of them, and by nothing of the
//! library but its validity and its closest points.

use crate::geometry::Point3;
use crate::manifold::surface::{Nearest, Surface};
use crate::mesh::Mesh;
use crate::quality::validity;
use crate::tests::parts::Part;
use crate::tests::parts::chains::{Chain, Features, beside, sides};
use std::collections::{BTreeMap, BTreeSet};

/// Vertices are on chains to this share of the diagonal.
const ON_CHAIN: f64 = 1e-9;
/// Points this much nearer to the surface than to a feature tell the label of the face they are on.
const CLEAR: f64 = 3.0;
/// Points inside triangles from which distances are taken, per side.
const SAMPLES: usize = 6;

/// Positions along a chain; of a closed one the first again at the end.
fn positions(chain: &Chain, mesh: &Mesh) -> Vec<Point3> {
    let again = chain.vertices.first().filter(|_| chain.is_closed);
    chain.vertices.iter().chain(again).map(|&v| mesh.position(v)).collect()
}

/// Everything that is wrong with a mesh of a part; distances, which are taken where nothing else is wrong, may be as large as
/// `hausdorff`.
pub(crate) fn faults(part: &Part, mesh: &Mesh, hausdorff: f64) -> Vec<String> {
    let mut found = invalid(part, mesh);
    if !found.is_empty() {
        return found;
    }
    let truth = Truth::new(part);
    found.extend(truth.lost_corners(mesh));
    let features = truth.features_of(mesh);
    found.extend(truth.wrong_chains(mesh, &features));
    found.extend(truth.wrong_lists(mesh, &features));
    if part.is_labelled() {
        found.extend(truth.wrong_labels(mesh));
    }
    if found.is_empty() {
        let [there, back] = truth.distances(mesh);
        let asked = format!("where {hausdorff:.3e} was asked for");
        let far = (there.max(back) > hausdorff)
            .then(|| format!("distance: {there:.3e} to the part and {back:.3e} from it, {asked}"));
        found.extend(far);
    }
    found
}

/// Not a mesh, or one of another topology.
fn invalid(part: &Part, mesh: &Mesh) -> Vec<String> {
    let (found, asked) = (validity(mesh), validity(&part.mesh));
    let mut faults: Vec<String> = found.first_fault.iter().map(|fault| format!("validity: {fault}")).collect();
    if [found.euler, found.boundary_loops.cast_signed()] != [asked.euler, asked.boundary_loops.cast_signed()] {
        let numbers = [found.euler, asked.euler];
        faults.push(format!(
            "topology: Euler numbers {numbers:?}, borders {}, {}",
            found.boundary_loops, asked.boundary_loops
        ));
    }
    if found.unused_vertices > 0 {
        faults.push(format!("validity: {} vertices of no triangle", found.unused_vertices));
    }
    if signed_volume(mesh) * signed_volume(&part.mesh) < 0.0 && asked.boundary_loops == 0 {
        faults.push("orientation: inside out".into());
    }
    faults
}

fn signed_volume(mesh: &Mesh) -> f64 {
    let tetrahedron = |&t: &[u32; 3]| {
        let [a, b, c] = mesh.positions_of(t).map(|p| p - Point3::default());
        a.dot(b.cross(c)) / 6.0
    };
    mesh.triangles.iter().map(tetrahedron).sum()
}

/// A chain of the part as a polyline.
struct Curve<'a> {
    chain: &'a Chain,
    points: Vec<Point3>,
    /// How far along it each point is.
    along: Vec<f64>,
}

impl Curve<'_> {
    fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// Distance of a point, and how far along the closest point is.
    fn foot(&self, p: Point3) -> (f64, f64) {
        let mut best = (f64::INFINITY, 0.0);
        for (ends, along) in self.points.windows(2).zip(&self.along) {
            let side = ends[1] - ends[0];
            let t = ((p - ends[0]).dot(side) / side.dot(side)).clamp(0.0, 1.0);
            let distance = p.distance(ends[0] + side * t);
            if distance < best.0 {
                best = (distance, along + t * side.norm());
            }
        }
        best
    }
}

/// What is known of a part.
struct Truth<'a> {
    part: &'a Part,
    curves: Vec<Curve<'a>>,
    surface: Surface,
    nearest: Nearest,
    diagonal: f64,
}

impl<'a> Truth<'a> {
    fn new(part: &'a Part) -> Self {
        let curve = |chain: &'a Chain| {
            let points = positions(chain, &part.mesh);
            let mut along = vec![0.0];
            for pair in points.windows(2) {
                along.push(along[along.len() - 1] + pair[0].distance(pair[1]));
            }
            Curve { chain, points, along }
        };
        let surface = Surface::new(&part.mesh).expect("a part is a surface");
        let (nearest, diagonal) = (Nearest::new(&surface), surface.bounds().diagonal());
        Self { part, curves: part.features.chains.iter().map(curve).collect(), surface, nearest, diagonal }
    }

    fn corner_positions(&self) -> impl Iterator<Item = Point3> + '_ {
        self.part.features.corners.iter().map(|&v| self.part.mesh.position(v))
    }

    /// Corners of the part that are no vertices, to the last bit.
    fn lost_corners(&self, mesh: &Mesh) -> Vec<String> {
        let vertices: BTreeSet<[u64; 3]> = mesh.points.iter().map(|p| bits((*p).into())).collect();
        let lost = self.corner_positions().filter(|&p| !vertices.contains(&bits(p)));
        lost.map(|p| format!("corner: no vertex at {p}")).collect()
    }

    /// Features of a mesh, cut at the part's corners: edges between labels and of the border; where the part has one label,
    /// edges that the mesh lists.
    fn features_of(&self, mesh: &Mesh) -> Features {
        let corners: BTreeSet<[u64; 3]> = self.corner_positions().map(bits).collect();
        let is_corner = |v: &u32| corners.contains(&bits(mesh.position(*v)));
        let corners = (0..mesh.points.len() as u32).filter(is_corner).collect();
        let beside = beside(mesh);
        let listed: BTreeSet<[u32; 2]> = mesh.edges.iter().copied().map(sorted).collect();
        let is_labelled = self.part.is_labelled();
        let mut edges = BTreeMap::new();
        for (edge, triangles) in beside {
            let sides = sides(mesh, &triangles);
            if if is_labelled { sides[0] != sides[1] } else { listed.contains(&edge) || sides[0].is_none() } {
                edges.insert(edge, sides);
            }
        }
        Features::of_edges(&edges, &corners)
    }

    /// Chains of the mesh that are none of the part, and chains of the part that are not in the mesh once.
    fn wrong_chains(&self, mesh: &Mesh, features: &Features) -> Vec<String> {
        let mut seen = vec![0; self.curves.len()];
        let mut faults = Vec::new();
        for chain in &features.chains {
            let mut misses = Vec::new();
            let fit = self.curves.iter().position(|curve| match self.miss(mesh, chain, curve) {
                None => true,
                Some(miss) => {
                    misses.push(miss);
                    false
                }
            });
            if let Some(i) = fit {
                seen[i] += 1;
                faults.extend(self.wrong_edge_label(mesh, chain, &self.curves[i]));
            } else {
                let at = mesh.position(chain.vertices[0]);
                let nearest = misses.iter().max_by_key(|miss| miss.0).map_or("", |miss| miss.1.as_str());
                let count = chain.vertices.len();
                faults.push(format!("chain of {count} vertices from {at} between {:?}: {nearest}", chain.sides));
            }
        }
        for (curve, count) in self.curves.iter().zip(seen).filter(|(_, count)| *count != 1) {
            let (at, sides) = (curve.points[0], curve.chain.sides);
            faults.push(format!("the part's chain from {at} between {sides:?} is there {count} times"));
        }
        faults
    }

    /// An edge of a chain without the label that the part gives to that chain, if it gives one.
    fn wrong_edge_label(&self, mesh: &Mesh, chain: &Chain, curve: &Curve) -> Option<String> {
        let first = sorted(curve.chain.edges()[0]);
        let asked = labels(&self.part.mesh).get(&first).copied()?;
        let found = labels(mesh);
        let wrong =
            chain.edges().into_iter().find(|&edge| found.get(&sorted(edge)).is_some_and(|&label| label != asked))?;
        let [a, b] = wrong.map(|v| mesh.position(v));
        Some(format!("list: the edge {a} - {b} has another label than {asked}"))
    }

    /// Why a chain is not the one of a curve, with how many tests it passed before that; `None` where it is.
    fn miss(&self, mesh: &Mesh, chain: &Chain, curve: &Curve) -> Option<(u32, String)> {
        if self.part.is_labelled() && chain.sides != curve.chain.sides {
            return Some((0, "no chain of the part is between these labels".into()));
        }
        if chain.is_closed != curve.chain.is_closed {
            return Some((1, "it is open where the part's is closed, or the other way round".into()));
        }
        let points = positions(chain, mesh);
        let feet: Vec<(f64, f64)> = points.iter().map(|&p| curve.foot(p)).collect();
        let farthest = feet.iter().map(|foot| foot.0).fold(0.0, f64::max);
        if farthest > ON_CHAIN * self.diagonal {
            return Some((2, format!("a vertex is {farthest:.3e} off the part's chain")));
        }
        let mut along: Vec<f64> = feet.iter().map(|foot| foot.1).collect();
        let in_order = if chain.is_closed {
            goes_round(&along, curve.length())
        } else {
            let ends = [points[0], points[points.len() - 1]].map(bits);
            let asked = [curve.points[0], curve.points[curve.points.len() - 1]].map(bits);
            if ends[0] != asked[0] {
                along.reverse();
            }
            let is_loop = asked[0] == asked[1];
            (ends == asked || ends == [asked[1], asked[0]])
                && (is_loop || along.windows(2).all(|pair| pair[0] < pair[1]))
        };
        (!in_order).then(|| (3, "its vertices do not follow the part's chain from end to end".into()))
    }

    /// Edges and corners that the mesh lists: all features, and nothing else.
    fn wrong_lists(&self, mesh: &Mesh, features: &Features) -> Vec<String> {
        let listed: BTreeSet<[u32; 2]> = mesh.edges.iter().copied().map(sorted).collect();
        let there: BTreeSet<[u32; 2]> = features.chains.iter().flat_map(Chain::edges).map(sorted).collect();
        let mut faults = Vec::new();
        for (edges, what) in [(&there - &listed, "is not listed"), (&listed - &there, "is listed and no feature")] {
            if let Some(edge) = edges.first() {
                let [a, b] = edge.map(|v| mesh.position(v));
                faults.push(format!("list: {} edges, the first {a} - {b}, {what}", edges.len()));
            }
        }
        let corners: BTreeSet<[u64; 3]> = mesh.corners.iter().map(|&v| bits(mesh.position(v))).collect();
        let lost = self.corner_positions().filter(|&p| !corners.contains(&bits(p)));
        faults.extend(lost.map(|p| format!("list: no corner at {p}")));
        faults
    }

    /// Triangles whose centroid is on a face of another label, away from features.
    fn wrong_labels(&self, mesh: &Mesh) -> Vec<String> {
        let mut faults = Vec::new();
        for (t, &label) in mesh.triangles.iter().zip(&mesh.triangle_labels) {
            let middle = Point3::weighted(mesh.positions_of(*t), [1.0 / 3.0; 3]);
            let found = self.nearest.closest(&self.surface, middle).expect("a finite point");
            let asked = self.surface.topology().region(found.place.face);
            if asked != label {
                let to_chain = self.curves.iter().map(|curve| curve.foot(middle).0).fold(f64::INFINITY, f64::min);
                if to_chain > CLEAR * found.distance + 1e-6 * self.diagonal {
                    faults.push(format!("label: {label} of the triangle about {middle}, on a face of {asked}"));
                }
            }
        }
        faults
    }

    /// The greatest distances from points of the mesh to the part, and back.
    fn distances(&self, mesh: &Mesh) -> [f64; 2] {
        let back = Nearest::of(mesh.triangles.iter().map(|&t| mesh.positions_of(t)));
        [farthest(mesh, &self.nearest), farthest(&self.part.mesh, &back)]
    }
}

/// From an even set of points of each triangle.
fn farthest(mesh: &Mesh, to: &Nearest) -> f64 {
    let mut most = 0.0_f64;
    for &t in &mesh.triangles {
        for i in 0..=SAMPLES {
            for j in 0..=SAMPLES - i {
                let [s, r] = [i, j].map(|k| k as f64 / SAMPLES as f64);
                let p = Point3::weighted(mesh.positions_of(t), [1.0 - s - r, s, r]);
                most = most.max(to.distance(p).expect("a finite point"));
            }
        }
    }
    most
}

/// Whether places along a closed curve, the first again at the end, go round it once, one way or the other.
fn goes_round(along: &[f64], length: f64) -> bool {
    let turn = |steps: &mut dyn Iterator<Item = f64>| steps.map(|step| step.rem_euclid(length)).sum::<f64>() / length;
    let forward = turn(&mut along.windows(2).map(|pair| pair[1] - pair[0]));
    let backward = turn(&mut along.windows(2).map(|pair| pair[0] - pair[1]));
    along.len() > 3 && [forward, backward].iter().any(|turns| (turns - 1.0).abs() < 0.5)
}

/// Labels of listed edges.
fn labels(mesh: &Mesh) -> BTreeMap<[u32; 2], i32> {
    mesh.edges.iter().copied().map(sorted).zip(mesh.edge_labels.iter().copied()).collect()
}

fn bits(p: Point3) -> [u64; 3] {
    // Zeros have two signs.
    p.to_array().map(|x| (x + 0.0).to_bits())
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

//! A planar mesh that is to be made anew: its domain, and what of it is to be there again.

use super::{Domain, Pslg, from_mesh};
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::lists::{distinct, in_order, marked};
use crate::manifold::surface::FeatureOptions;
use crate::mesh::{EdgeSide, Edges, Mesh};
use std::collections::{HashMap, HashSet};

/// What of a planar mesh is kept, besides boundary, interfaces, labels and what is required.
#[derive(Clone, Copy, Debug, Default)]
pub struct Keep {
    /// Which turns of curves are corners.
    pub features: FeatureOptions,
    /// The vertices and edges of all curves.
    pub curves: bool,
    /// Listed edges inside a region that are not required.
    pub inner_edges: bool,
    /// Whether sizes at required edges are as elsewhere, and not those of the edges if these are shorter.
    pub plain_sizes: bool,
}

/// A planar domain, and the mesh that it comes from if it has triangles.
#[derive(Debug)]
pub struct RemeshInput {
    /// The domain; turns are required points of it.
    pub domain: Domain,
    /// What was kept.
    pub keep: Keep,
    /// The mesh that values at vertices belong to: what was given, or a triangulation of its vertices.
    pub(crate) given: Mesh,
    /// Edges of the list that are of no use, and were left out: they are no edges of triangles, or lie inside a region.
    pub left_out: usize,
    corners: HashSet<Position>,
    required: HashSet<Position>,
    required_edges: HashSet<[Position; 2]>,
    /// The mean length of the required edges, and of those that are kept, at each of their ends.
    pub(crate) required_lengths: HashMap<Position, f64>,
}

/// A position to the last bit.
pub(crate) type Position = [u64; 2];

impl RemeshInput {
    /// From a mesh.
    ///
    /// # Errors
    /// As of [`from_mesh`] and [`Domain::new`]; [`Error::Unsupported`] of required triangles.
    pub fn of_mesh(mesh: Mesh, keep: Keep) -> Result<Self> {
        mesh.check_numbers()?;
        mesh.demand_straight()?;
        if !mesh.required_triangles.is_empty() {
            let what = format!("{} RequiredTriangles of a planar mesh", mesh.required_triangles.len());
            let help = "require their edges (RequiredEdges), or leave them out of the mesh and put them back";
            return Err(Error::unsupported(what, help));
        }
        let (mesh, left_out) = without_useless_edges(mesh, keep.inner_edges);
        let own = |points: &[u32]| points.iter().map(|&v| position(mesh.points[v as usize])).collect();
        let required_edges = mesh
            .required_edges
            .iter()
            .map(|&e| in_order(mesh.edges[e as usize].map(|v| position(mesh.points[v as usize]))));
        let input = Self::of_graph(from_mesh(&mesh)?, keep)?;
        let corners: HashSet<Position> = own(&mesh.corners);
        Ok(Self {
            left_out,
            corners: &input.corners | &corners,
            required: own(&mesh.required_points),
            required_edges: required_edges.collect(),
            given: mesh,
            ..input
        })
    }

    /// From a graph that no mesh belongs to.
    ///
    /// # Errors
    /// As of [`Domain::new`].
    pub fn of_graph(mut pslg: Pslg, keep: Keep) -> Result<Self> {
        let at = |pslg: &Pslg, v: u32| position_of(pslg.points[v as usize]);
        let required: HashSet<Position> = pslg.required_points.iter().map(|&v| at(&pslg, v)).collect();
        let is_required = pslg.segments.iter().filter(|segment| segment.required);
        let required_edges = is_required.map(|segment| in_order(segment.ends.map(|v| at(&pslg, v)))).collect();
        let turns = pslg.corners(keep.features.ar);
        let corners = turns.iter().map(|&v| at(&pslg, v)).collect();
        pslg.required_points = distinct(pslg.required_points.into_iter().chain(turns));
        pslg.segments.iter_mut().for_each(|segment| segment.required |= keep.curves);
        let required_lengths = if keep.plain_sizes { HashMap::new() } else { required_lengths(&pslg) };
        let domain = Domain::new(&pslg)?;
        Ok(Self {
            domain,
            keep,
            given: Mesh::default(),
            left_out: 0,
            corners,
            required,
            required_edges,
            required_lengths,
        })
    }

    /// Tells of a mesh of the domain what was asked for by the user, and not only while it was made: corners, required vertices and
    /// edges.
    pub fn mark(&self, mesh: &mut Mesh) {
        let at = |v: u32| position(mesh.points[v as usize]);
        mesh.corners.retain(|&v| self.corners.contains(&at(v)));
        mesh.required_points.retain(|&v| self.required.contains(&at(v)));
        mesh.required_edges.retain(|&e| self.required_edges.contains(&in_order(mesh.edges[e as usize].map(at))));
    }
}

fn position([x, y, _]: [f64; 3]) -> Position {
    position_of(Point::new(x, y))
}

pub(crate) fn position_of(p: Point) -> Position {
    [p.x.to_bits(), p.y.to_bits()]
}

fn required_lengths(pslg: &Pslg) -> HashMap<Position, f64> {
    let mut sums: HashMap<Position, (f64, f64)> = HashMap::new();
    for segment in pslg.segments.iter().filter(|segment| segment.required) {
        let ends = segment.ends.map(|v| pslg.points[v as usize]);
        for p in ends {
            let (sum, count) = sums.entry(position_of(p)).or_default();
            (*sum, *count) = (*sum + ends[0].distance(ends[1]), *count + 1.0);
        }
    }
    sums.into_iter().map(|(p, (sum, count))| (p, sum / count)).collect()
}

/// The mesh without edges that are no triangle's, and without those inside a region that are not required unless they are to be kept;
/// and how many these were. As mmg2d has it.
fn without_useless_edges(mut mesh: Mesh, inner: bool) -> (Mesh, usize) {
    if mesh.triangles.is_empty() {
        return (mesh, 0);
    }
    let edges = Edges::of(&mesh.triangles);
    let label = |side: &EdgeSide| mesh.triangle_labels.get(side.triangle()).copied().unwrap_or(0);
    let is_required = marked(mesh.edges.len(), mesh.required_edges.iter().copied());
    let is_kept = |e: usize| match &*edges.at(mesh.edges[e]) {
        [s, t] => label(s) != label(t) || inner || is_required[e],
        sides => !sides.is_empty(),
    };
    let kept: Vec<usize> = (0..mesh.edges.len()).filter(|&e| is_kept(e)).collect();
    let left_out = mesh.edges.len() - kept.len();
    mesh.required_edges = (0..).zip(&kept).filter(|&(_, &e)| is_required[e]).map(|(new, _)| new).collect();
    mesh.ridges.clear();
    mesh.edge_labels = kept.iter().map(|&e| mesh.edge_labels.get(e).copied().unwrap_or(0)).collect();
    mesh.edges = kept.iter().map(|&e| mesh.edges[e]).collect();
    (mesh, left_out)
}

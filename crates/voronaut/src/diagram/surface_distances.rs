//! Distances on a surface.

use super::Distances;
use super::unfold::{OnEdge, Unfolding};
use crate::canvas::{Canvas, Draped, Way};
use crate::error::{Error, Result};
use crate::geodesic::Method;
use crate::geometry::Point3;
use crate::mesh::Mesh;
use crate::triangulation::VertexId;

/// The distance of every vertex of a surface's canvas from the nearest of given vertices.
pub type SurfaceDistances<'a> = Distances<'a, &'a Canvas<Draped<'a>>>;

impl<'a> SurfaceDistances<'a> {
    /// Distances by a method from vertices of a surface's canvas, which was made with them.
    ///
    /// # Errors
    /// [`Error::Domain`] of what is no canvas vertex; [`Error::Unsupported`] of [`Method::Lbr`];
    /// [`Error::Unsupported`] where rounding leaves heat no factor.
    pub fn on_surface(canvas: &'a Canvas<Draped<'a>>, from: &[VertexId], method: Method) -> Result<Self> {
        Self::by_method(canvas, from, method)
    }

    /// The way from a canvas vertex to the nearest of the given ones: with [`Method::March`] the geodesic
    /// ([`Draped::geodesic`]); else down the method's own distances, by their gradient in each face and by parents where that
    /// does not lead on, as good as these distances are.
    ///
    /// # Errors
    /// [`Error::Domain`] where the distances lead to none of the given vertices.
    pub fn path(&self, to: VertexId) -> Result<Way> {
        let draped = self.ground.draped();
        let way = if self.method() == Method::March {
            let back = std::iter::successors(Some(to), |&v| self.parent(v)).last();
            back.filter(|last| self.from.contains(last)).and_then(|last| draped.geodesic(to, last))
        } else {
            let parent = |v: VertexId| self.parent(v);
            let (topology, distances) = (draped.topology(), self.values());
            let down = Unfolding { topology, sources: &self.from, distances, parent: &parent };
            down.trace(to).and_then(|on| draped.way_along(on))
        };
        way.ok_or_else(|| {
            let help = "take a point of the surface that is reached, or a finer canvas";
            Error::domain("no way from there", draped.position(to).to_string(), help)
        })
    }

    /// The distance of a point of an edge, interpolated as in flat space.
    fn on_edge(&self, ([a, b], t): OnEdge) -> f64 {
        let [at_a, at_b] = [a, b].map(|v| self.values()[v.index()]);
        let length = self.ground.draped().length_between(a, b);
        ((1.0 - t) * at_a * at_a + t * at_b * at_b - t * (1.0 - t) * length * length).max(0.0).sqrt()
    }

    /// The canvas as a mesh with the distances of its points, and with a path as labelled edges between points of its own,
    /// behind the others, if there is one. Points are labelled 0, those of the path 1; triangles as those of the surface.
    pub fn to_mesh(&self, path: Option<&Way>) -> (Mesh, Vec<f64>) {
        let draped = self.ground.draped();
        let vertices = (0..self.values().len() as u32).map(VertexId);
        let points: Vec<[f64; 3]> = vertices.map(|v| draped.position(v).to_array()).collect();
        let along: Vec<[f64; 3]> = path.iter().flat_map(|path| &path.points).map(|p| p.to_array()).collect();
        let labels = draped.input().surface.topology();
        let mesh = self.mesh_with(&points, &along, |f| labels.region(draped.home(f)));
        let of_path = path.iter().flat_map(|path| &path.on).map(|&on| self.on_edge(on));
        (mesh, self.values().iter().copied().chain(of_path).collect())
    }

    /// The lines of equal distance at these distances: pieces within the triangles of the canvas, two points each.
    pub fn isolines(&self, levels: &[f64]) -> Vec<[Point3; 2]> {
        let draped = self.ground.draped();
        let at = |([a, b], t): OnEdge| draped.position(a).lerp(draped.position(b), t);
        self.pieces(levels).map(|piece| piece.map(at)).collect()
    }
}

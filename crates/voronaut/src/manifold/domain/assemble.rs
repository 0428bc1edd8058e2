//! From a triangulation of a domain to the mesh that leaves the program.

use super::Domain;
use crate::mesh::Mesh;
use crate::planar::Planar;
use crate::triangulation::VertexId;

impl Domain {
    /// A triangulation of the domain as a mesh: vertices in the order of their ids, pinched vertices joined again, the
    /// domain's labels on triangles, edges and corners. `corner` tells which point of the graph a vertex is.
    pub(crate) fn mesh_of(&self, planar: &Planar, corner: impl Fn(VertexId) -> Option<u32>) -> Mesh {
        let (mut mesh, number) = self.numbered_points(planar, corner);
        for f in planar.topology.faces() {
            mesh.triangles.push(planar.topology.corners(f).map(|v| number[v.index()]));
            mesh.triangle_labels.push(planar.topology.region(f));
        }
        self.add_edges(planar, &number, &mut mesh);
        mesh
    }

    /// The number in `Domain::mesh_of` of each vertex by id; `u32::MAX` of those that are none.
    pub(crate) fn numbering(&self, planar: &Planar, corner: impl Fn(VertexId) -> Option<u32>) -> Vec<u32> {
        self.numbered_points(planar, corner).1
    }

    fn numbered_points(&self, planar: &Planar, corner: impl Fn(VertexId) -> Option<u32>) -> (Mesh, Vec<u32>) {
        let pslg = self.pslg();
        let mut mesh = Mesh::default();
        let mut number = vec![u32::MAX; planar.topology.vertex_slots()];
        let mut of_corner = vec![u32::MAX; pslg.points.len()];
        for v in planar.topology.vertices() {
            let corner = corner(v).map(|point| point as usize);
            if let Some(point) = corner.filter(|&point| of_corner[point] != u32::MAX) {
                number[v.index()] = of_corner[point];
                continue;
            }
            let new = mesh.points.len() as u32;
            number[v.index()] = new;
            let p = planar.position(v);
            mesh.points.push([p.x, p.y, 0.0]);
            mesh.point_labels.push(corner.map_or(0, |point| pslg.point_labels[point]));
            if let Some(point) = corner {
                of_corner[point] = new;
                mesh.corners.push(new);
            }
        }
        let required = pslg.required_points.iter().map(|&v| of_corner[v as usize]).filter(|&v| v != u32::MAX);
        mesh.required_points.extend(required);
        (mesh, number)
    }

    fn add_edges(&self, planar: &Planar, number: &[u32], mesh: &mut Mesh) {
        let (pslg, topology) = (self.pslg(), &planar.topology);
        for h in topology.edges() {
            let Some(constraint) = topology.constraint(h) else { continue };
            let segment = pslg.segments[constraint.0 as usize];
            let [a, b] = segment.ends.map(|v| pslg.points[v as usize]);
            let [p, q] = planar.ends(h);
            let mut ends: [VertexId; 2] = [topology.origin(h), topology.target(h)];
            if (q - p).dot(b - a) < 0.0 {
                ends.reverse();
            }
            if segment.required {
                mesh.required_edges.push(mesh.edges.len() as u32);
            }
            mesh.edges.push(ends.map(|v| number[v.index()]));
            mesh.edge_labels.push(segment.label);
        }
    }
}

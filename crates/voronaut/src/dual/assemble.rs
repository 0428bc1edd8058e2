//! From the dual to the mesh that leaves the program.

use super::{Dual, Kind};
use crate::domain::Domain;
use crate::mesh::Mesh;
use crate::triangulation::VertexId;

impl Dual<'_> {
    /// The mesh: vertices in the order of their ids, pinched vertices joined again, the domain's labels on triangles,
    /// edges and corners.
    pub fn to_mesh(&self, domain: &Domain) -> Mesh {
        let (mut mesh, number) = self.numbered_points(domain);
        let topology = self.topology();
        for f in topology.faces() {
            mesh.triangles.push(topology.corners(f).map(|v| number[v.index()]));
            mesh.triangle_labels.push(topology.region(f));
        }
        self.add_edges(domain, &number, &mut mesh);
        mesh
    }

    /// The number in [`Dual::to_mesh`] of each vertex by id; `u32::MAX` of those that are none.
    pub fn numbering(&self, domain: &Domain) -> Vec<u32> {
        self.numbered_points(domain).1
    }

    fn numbered_points(&self, domain: &Domain) -> (Mesh, Vec<u32>) {
        let pslg = domain.pslg();
        let mut mesh = Mesh::default();
        let mut number = vec![u32::MAX; self.topology().vertex_slots()];
        let mut of_corner = vec![u32::MAX; pslg.points.len()];
        for v in self.topology().vertices() {
            let corner = if let Kind::Corner(point) = self.kind(v) { Some(point as usize) } else { None };
            if let Some(point) = corner.filter(|&point| of_corner[point] != u32::MAX) {
                number[v.index()] = of_corner[point];
                continue;
            }
            let new = mesh.points.len() as u32;
            number[v.index()] = new;
            let p = self.position(v);
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

    fn add_edges(&self, domain: &Domain, number: &[u32], mesh: &mut Mesh) {
        let pslg = domain.pslg();
        for h in self.topology().edges() {
            let Some(constraint) = self.topology().constraint(h) else { continue };
            let segment = pslg.segments[constraint.0 as usize];
            let [a, b] = segment.ends.map(|v| pslg.points[v as usize]);
            let [p, q] = self.planar().ends(h);
            let mut ends: [VertexId; 2] = [self.topology().origin(h), self.topology().target(h)];
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

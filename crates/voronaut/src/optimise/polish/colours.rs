//! Vertices in groups without edges between them: those of a group can move at once.

use super::Freedom;
use crate::triangulation::{Triangulation, VertexId};

/// The vertices that can move, by colour: greedily, in the order of their ids.
pub(super) fn colours(topology: &Triangulation, freedoms: &[Freedom]) -> Vec<Vec<VertexId>> {
    const NONE: u16 = u16::MAX;
    let mut colour = vec![NONE; topology.vertex_slots()];
    let mut groups: Vec<Vec<VertexId>> = Vec::new();
    let mut is_taken: Vec<bool> = Vec::new();
    for v in topology.vertices().filter(|v| freedoms[v.index()] != Freedom::None) {
        is_taken.clear();
        is_taken.resize(groups.len() + 1, false);
        for u in topology.star(v).flat_map(|h| [topology.target(h), topology.apex(h)]) {
            if let Some(taken) = is_taken.get_mut(usize::from(colour[u.index()])) {
                *taken = true;
            }
        }
        let free = is_taken.iter().position(|taken| !taken).unwrap_or(groups.len());
        if free == groups.len() {
            groups.push(Vec::new());
        }
        colour[v.index()] = free as u16;
        groups[free].push(v);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::planar::delaunay;

    #[test]
    fn no_edge_is_inside_a_group_and_no_vertex_is_forgotten() {
        let at = |i: u32| Point::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract());
        let points: Vec<Point> = (0..500).map(at).collect();
        let planar = delaunay(&points).unwrap();
        let mut freedoms = vec![Freedom::All; planar.topology.vertex_slots()];
        freedoms[7] = Freedom::None;
        let groups = colours(&planar.topology, &freedoms);
        let mut group = vec![usize::MAX; planar.topology.vertex_slots()];
        for (i, all) in groups.iter().enumerate() {
            for v in all {
                group[v.index()] = i;
            }
        }
        let ends = |h| [planar.topology.origin(h), planar.topology.target(h)].map(|v| group[v.index()]);
        assert!(planar.topology.edges().map(ends).all(|[a, b]| a != b));
        let has_none = |v: &VertexId| group[v.index()] == usize::MAX;
        assert_eq!(planar.topology.vertices().filter(has_none).collect::<Vec<_>>(), [VertexId(7)]);
        assert!(groups.len() <= 12, "{}", groups.len());
    }
}

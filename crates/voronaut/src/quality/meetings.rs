//! Where a surface meets itself, and where its meshes may therefore do so.

use super::faults::{Position, duplicates};
use super::self_intersections::{Pair, pairs};
use crate::geometry::{Aabb3, Bounds, BoxTree, Point3, widened};
use crate::mesh::Mesh;
use std::sync::OnceLock;

/// The places where a surface meets itself: pairs of its triangles that have more in common than a vertex or an edge of
/// both, and vertices at one position. They are looked for when they are first asked about.
#[derive(Debug)]
pub struct Meetings {
    surface: Mesh,
    found: OnceLock<BoxTree<Met, 3>>,
}

/// Where two triangles meet: the least coordinates of the box of either cut with that of the other, and whether they are neighbours.
#[derive(Debug)]
struct Met {
    least: Point3,
    are_neighbours: bool,
}

/// Places where a mesh meets itself and may, for the surface that it is a mesh of does so there.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Excused {
    /// Pairs of triangles, and of vertices at one position.
    pub count: usize,
    /// The first of them.
    pub first: Option<Position>,
}

impl Pair {
    /// Whether the surface that the mesh is of meets itself there, too.
    pub(super) fn is_excused(&self, mesh: &Mesh, surface: &Meetings) -> bool {
        let reach = self.triangles.map(|t| Point3::longest_side(mesh.positions_of(mesh.triangles[t])));
        surface.excuse(self.at, reach[0].max(reach[1]), self.are_neighbours(mesh))
    }
}

impl Meetings {
    /// Of a surface, whose triangles have area.
    pub fn of(surface: Mesh) -> Self {
        Self { surface, found: OnceLock::new() }
    }

    /// How many there are.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.all().count()
    }

    /// Where one of them is.
    pub(crate) fn first(&self) -> Option<Point3> {
        self.all().next().map(|met| met.least)
    }

    /// Whether the surface meets itself within `reach` of a place: a mesh with edges of that length, whose chords leave the
    /// surface, may then do so there. Neighbours (triangles with a common vertex) may only where neighbours of the surface do: else
    /// any fold beside a place where sheets cross would pass for one of the surface.
    pub(super) fn excuse(&self, at: Point3, reach: f64, are_neighbours: bool) -> bool {
        let mut met = self.found().meeting(widened([at.to_array(); 2], reach));
        met.any(|met| !are_neighbours || met.are_neighbours)
    }

    fn all(&self) -> impl Iterator<Item = &Met> {
        self.found().meeting([[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]])
    }

    fn found(&self) -> &BoxTree<Met, 3> {
        self.found.get_or_init(|| {
            let mesh = &self.surface;
            let crossing = pairs(mesh).into_iter().map(|pair| meeting(mesh, &pair));
            let touching = duplicates(mesh).into_iter().map(|[v, _]| {
                let at = mesh.points[v as usize];
                ([at; 2], Met { least: at.into(), are_neighbours: false })
            });
            BoxTree::new(crossing.chain(touching))
        })
    }
}

fn meeting(mesh: &Mesh, pair: &Pair) -> (Bounds<3>, Met) {
    let boxes = pair.triangles.map(|t| Aabb3::of(mesh.positions_of(mesh.triangles[t])).expect("three corners").into());
    let [[low, high], [other_low, other_high]]: [Bounds<3>; 2] = boxes;
    let both = [0, 1, 2].map(|k| [low[k].max(other_low[k]), high[k].min(other_high[k])]);
    let both = [both.map(|ends| ends[0]), both.map(|ends| ends[1])];
    (both, Met { least: both[0].into(), are_neighbours: pair.are_neighbours(mesh) })
}

impl Excused {
    /// What to tell the user; nothing where there are none.
    pub fn note(&self) -> Option<String> {
        let place = self.first?;
        let [x, y, z] = <[f64; 3]>::try_from(place.coordinates()).ok()?;
        let times = if self.count == 1 { "in 1 place".into() } else { format!("in {} places", self.count) };
        Some(format!("the mesh meets itself {times}, where the surface does: the first at ({x:.6}, {y:.6}, {z:.6})"))
    }

    pub(super) fn add(&mut self, at: Point3) {
        self.count += 1;
        self.first.get_or_insert(at.into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::{examined_on, validity, validity_on};

    /// Two squares of n by n cells that cross along the line x = 0.5, z = 0.
    fn crossing(n: u32) -> Mesh {
        let mut mesh = Mesh::default();
        for sheet in 0..2_u32 {
            let first = mesh.points.len() as u32;
            for i in 0..(n + 1) * (n + 1) {
                let [x, y] = [i % (n + 1), i / (n + 1)].map(|k| f64::from(k) / f64::from(n));
                mesh.points.push(if sheet == 0 { [x, y, 0.0] } else { [0.51, y, x - 0.49] });
            }
            for i in 0..n * n {
                let a = first + i % n + (n + 1) * (i / n);
                mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
            }
        }
        mesh.point_labels = vec![0; mesh.points.len()];
        mesh.triangle_labels = vec![0; mesh.triangles.len()];
        mesh
    }

    #[test]
    fn a_mesh_may_meet_itself_where_its_surface_does() {
        let (surface, mesh) = (Meetings::of(crossing(4)), crossing(7));
        assert!(surface.count() > 0 && !validity(&mesh).valid);
        let (found, faulty) = examined_on(&mesh, &surface);
        assert!(found.valid && found.overlaps == 0 && found.meetings.count > 0, "{found:?}");
        let first = found.meetings.first.unwrap();
        let at = first.coordinates();
        assert!((at[0] - 0.51).abs() < 0.2 && at[2].abs() < 0.2, "{at:?}");
        assert!(faulty.is_empty());
    }

    #[test]
    fn elsewhere_it_may_not() {
        let mut mesh = crossing(7);
        // A vertex of the flat sheet far from the line is pulled over its neighbours.
        mesh.points[9] = [0.5 / 7.0, 2.9 / 7.0, 0.0];
        let (found, faulty) = examined_on(&mesh, &Meetings::of(crossing(4)));
        assert!(!found.valid && found.overlaps > 0 && found.meetings.count > 0, "{found:?}");
        assert!(!faulty.is_empty() && faulty.iter().all(|&t| t < 2 * 7 * 7), "{faulty:?}");
        let of_flat = validity_on(&crossing(7), &Meetings::of(Mesh { triangles: vec![[0, 1, 6]], ..crossing(4) }));
        assert!(!of_flat.valid, "a surface that does not meet itself excuses nothing");
    }

    #[test]
    fn folds_of_neighbours_are_not_excused_by_sheets_that_cross() {
        let mut mesh = crossing(7);
        // Beside the line: the vertex in the middle of the flat sheet is pulled over its neighbours.
        mesh.points[28] = [4.0 / 7.0, 5.9 / 7.0, 0.0];
        assert!(!validity_on(&mesh, &Meetings::of(crossing(4))).valid);
    }

    #[test]
    fn vertices_may_coincide_where_those_of_the_surface_do() {
        let tetrahedra = |size: f64| Mesh {
            points: vec![
                [0.0; 3],
                [size, 0.0, 0.0],
                [0.0, size, 0.0],
                [0.0, 0.0, size],
                [0.0; 3],
                [-size, 0.0, 0.0],
                [0.0, -size, 0.0],
                [0.0, 0.0, -size],
            ],
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [4, 5, 6], [4, 7, 5], [5, 7, 6], [4, 6, 7]],
            point_labels: vec![0; 8],
            triangle_labels: vec![0; 8],
            ..Mesh::default()
        };
        let surface = Meetings::of(tetrahedra(1.0));
        assert_eq!(validity(&tetrahedra(0.9)).duplicate_vertices, 1);
        let found = validity_on(&tetrahedra(0.9), &surface);
        assert!(found.valid && found.duplicate_vertices == 0 && found.meetings.count > 0, "{found:?}");
    }
}

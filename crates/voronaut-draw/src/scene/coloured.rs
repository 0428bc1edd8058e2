//! Scenes of coloured canvases: cells that are cut out of triangles.

use super::super::shades::distinct;
use super::super::{colours, palette};
use super::borders::Borders;
use super::{Fill, Scene, SceneTriangle, Stroke, existing};
use voronaut::geometry::{Point3, Vector3};
use voronaut::triangulation::VertexId;

/// A corner of a piece of a triangle.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: Point3,
    normal: Vector3,
}

impl Scene {
    /// The cells of a canvas whose vertices have colours (none: not reached, plain), smooth, with lines between the cells.
    /// Triangles of several colours are cut: edges between two colours near their middles, so that the lines are as
    /// straight as the colours allow. Triangles with vertices that do not exist are left out. What belongs to some vertices, the
    /// orphans, is red.
    pub fn of_canvas(
        positions: &[Point3],
        triangles: &[[u32; 3]],
        colours: &[Option<u32>],
        orphans: &[VertexId],
    ) -> Self {
        let mut is_orphan = vec![false; positions.len()];
        for v in orphans {
            if let Some(is_one) = is_orphan.get_mut(v.index()) {
                *is_one = true;
            }
        }
        let triangles = existing(triangles, positions.len().min(colours.len()));
        let borders = Borders::new(positions, &triangles, colours);
        let normals = normals(positions, &triangles);
        let fills = Fills::new(colours, &borders);
        let mut scene = Self::default();
        for &triangle in &triangles {
            let corners = triangle.map(|v| Corner { at: positions[v as usize], normal: normals[v as usize] });
            for (piece, owner) in pieces(triangle, corners, &borders) {
                let (corners, normals) = (piece.map(|c| c.at), Some(piece.map(|c| c.normal)));
                let own = fills.of(colours[owner as usize]);
                let fill = if is_orphan[owner as usize] { Fill::Orphan } else { own };
                scene.triangles.push(SceneTriangle { corners, normals, fill });
            }
        }
        scene.with(borders.lines(), Stroke::Cell)
    }
}

/// A triangle in pieces of one colour, each with a vertex that has it: as a whole, cut from side to side, or in three, two
/// pieces each.
fn pieces(triangle: [u32; 3], corners: [Corner; 3], borders: &Borders) -> Vec<([Corner; 3], u32)> {
    let cuts = [0, 1, 2].map(|i| {
        let t = borders.share([triangle[i], triangle[(i + 1) % 3]])?;
        Some(corners[i].towards(corners[(i + 1) % 3], t))
    });
    if let [Some(p), Some(q), Some(r)] = cuts {
        let centre = p.towards(q, 0.5).towards(r, 1.0 / 3.0);
        let of = |i: usize| {
            let (own, before, after) = (corners[i], cuts[(i + 2) % 3], cuts[i]);
            let [before, after] = [before, after].map(|cut| cut.unwrap_or(centre));
            [([own, after, centre], triangle[i]), ([own, centre, before], triangle[i])]
        };
        return [of(0), of(1), of(2)].concat();
    }
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        if let (Some(after), Some(before)) = (cuts[i], cuts[k]) {
            let rest = [[after, corners[j], corners[k]], [after, corners[k], before]];
            return vec![([corners[i], after, before], triangle[i]), (rest[0], triangle[j]), (rest[1], triangle[j])];
        }
    }
    vec![(corners, triangle[0])]
}

impl Corner {
    fn towards(self, other: Self, t: f64) -> Self {
        let normal = self.normal + (other.normal - self.normal) * t;
        Self { at: self.at.lerp(other.at, t), normal }
    }
}

/// Fills of cells, so that neighbours differ.
struct Fills {
    /// The colours that there are, in order, and their hues.
    used: Vec<u32>,
    hues: Vec<usize>,
}

impl Fills {
    fn new(colours: &[Option<u32>], borders: &Borders) -> Self {
        let used = distinct(colours.iter().copied().flatten());
        let number = |colour: Option<u32>| Some(used.binary_search(&colour?).ok()? as u32);
        let pair = |[a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|v| number(colours[v as usize]));
            Some([a?.min(b?), a?.max(b?)])
        };
        let neighbours = distinct(borders.edges().iter().filter_map(|&ends| pair(ends)));
        let hues = palette::colour(used.len(), &neighbours, colours::HUES, colours::likeness);
        Self { used, hues }
    }

    fn of(&self, colour: Option<u32>) -> Fill {
        let cell = colour.and_then(|colour| self.used.binary_search(&colour).ok());
        // Shades go round as those of cells of the plane.
        cell.map_or(Fill::Plain, |cell| Fill::Cell { hue: self.hues[cell], shade: (1.854_102 * cell as f64) as usize })
    }
}

/// At each vertex the mean of its triangles' normals, weighted by their angles there (Thurmer and Wuthrich 1998); not of
/// unit length.
pub(super) fn normals(positions: &[Point3], triangles: &[[u32; 3]]) -> Vec<Vector3> {
    let mut sums = vec![Vector3::default(); positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let Some(normal) = (b - a).cross(c - a).unit() else { continue };
        for (v, [u, w]) in triangle.iter().zip([[b - a, c - a], [c - b, a - b], [a - c, b - c]]) {
            let angle = u.cross(w).norm().atan2(u.dot(w));
            sums[*v as usize] = sums[*v as usize] + normal * angle;
        }
    }
    sums.into_iter().map(|sum| sum.unit().unwrap_or_default()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(triangle: &SceneTriangle) -> f64 {
        let [a, b, c] = triangle.corners;
        0.5 * (b - a).cross(c - a).z
    }

    fn scene(colours: [Option<u32>; 4]) -> Scene {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
        Scene::of_canvas(&points, &[[0, 1, 2], [0, 2, 3], [0, 2, 9]], &colours, &[])
    }

    #[test]
    fn orphans_are_red() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
        let scene =
            Scene::of_canvas(&points, &[[0, 1, 2], [0, 2, 3]], &[Some(0), Some(0), Some(0), Some(1)], &[VertexId(3)]);
        let red: f64 = scene.triangles.iter().filter(|t| t.fill == Fill::Orphan).map(area).sum();
        assert!((red - 0.125).abs() < 1e-12, "{red}");
    }

    #[test]
    fn pieces_cover_their_triangles() {
        for (colours, count) in [
            ([Some(7); 4], 2),
            ([Some(7), Some(7), Some(2), Some(2)], 6),
            ([Some(0), None, Some(2), Some(2)], 9),
            ([Some(0), Some(1), Some(2), Some(u32::MAX)], 12),
        ] {
            let scene = scene(colours);
            assert_eq!(scene.triangles.len(), count, "{colours:?}");
            assert!(scene.triangles.iter().all(|t| area(t) > 0.0), "{colours:?}");
            assert!((scene.triangles.iter().map(area).sum::<f64>() - 1.0).abs() < 1e-12, "{colours:?}");
        }
    }

    #[test]
    fn neighbours_differ_and_nothing_is_plain() {
        let scene = scene([Some(5), Some(5), Some(9), None]);
        let fill = |at: [f64; 2]| {
            let has = |t: &&SceneTriangle| t.corners.iter().any(|&p| p == Point3::new(at[0], at[1], 0.0));
            scene.triangles.iter().find(has).unwrap().fill
        };
        assert_eq!(fill([0.0, 0.0]), fill([1.0, 0.0]));
        assert_ne!(fill([0.0, 0.0]), fill([1.0, 1.0]));
        assert_eq!(fill([0.0, 1.0]), Fill::Plain);
    }
}

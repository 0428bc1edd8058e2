//! A polygon in space, seen flat.

use voronaut::geometry::{Point, Point3, Vector3};

/// A polygon seen from the side that it turns left on, near the origin and about as large as one.
pub(super) struct Seen {
    /// Its corners in the coordinate plane that it is most parallel to, as exact as the file has them.
    pub(super) flat: Vec<Point>,
    corners: Vec<Vector3>,
    normal: Option<Vector3>,
}

impl Seen {
    pub(super) fn new(points: &[[f64; 3]], polygon: &[u32]) -> Self {
        let position = |&v: &u32| Point3::from(points[v as usize]);
        let origin = polygon.first().map_or(Point3::default(), position);
        let mut corners: Vec<Vector3> = polygon.iter().map(|v| position(v) - origin).collect();
        let size = corners.iter().map(|c| c.x.abs().max(c.y.abs()).max(c.z.abs())).fold(f64::MIN_POSITIVE, f64::max);
        for corner in &mut corners {
            *corner = *corner * (1.0 / size);
        }
        // Newell's normal: of the polygon's shadows on the coordinate planes it is the areas.
        let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
        let area = pairs.fold(Vector3::new(0.0, 0.0, 0.0), |sum, (&a, &b)| sum + a.cross(b));
        let flat = polygon.iter().map(|v| flattened(points[*v as usize], area)).collect();
        Self { flat, corners, normal: area.unit() }
    }

    /// How good the triangle of three corners is: 1 if it is equilateral and upright, 0 without area, below that turned round.
    pub(super) fn shape(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.corners[i as usize]);
        let (sides, area) = ([b - a, c - b, a - c], (b - a).cross(c - a));
        let squares: f64 = sides.iter().map(|side| side.dot(*side)).sum();
        let area = self.normal.map_or_else(|| area.norm(), |normal| area.dot(normal));
        if squares > 0.0 { 2.0 * 3.0_f64.sqrt() * area / squares } else { 0.0 }
    }
}

/// A point without the coordinate along which the area is largest; to the left stays to the left.
fn flattened([x, y, z]: [f64; 3], area: Vector3) -> Point {
    let [along_x, along_y, along_z] = [area.x.abs(), area.y.abs(), area.z.abs()];
    let (u, v, sign) = if along_x > along_y && along_x > along_z {
        (y, z, area.x)
    } else if along_y > along_z {
        (z, x, area.y)
    } else {
        (x, y, area.z)
    };
    if sign < 0.0 { Point::new(v, u) } else { Point::new(u, v) }
}

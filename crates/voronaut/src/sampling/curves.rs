//! Simplifying curves within a distance: which of the input's vertices the mesh keeps.

use crate::domain::{Chain, Domain, Pslg};
use crate::geodesic::chord;
use crate::geometry::{Aabb, BoxTree, Orientation, Point, orientation};
use crate::metric::MetricField;

/// The domain with fewer vertices along its curves: about one per unit of metric length, more where an edge would
/// stray farther than `tolerance` (Euclidean) from the vertices that it skips. Ends of curves stay, loops keep at
/// least three vertices, and where simplified curves would meet, they are kept finer, if need be as they were.
pub(crate) fn simplify(domain: &Domain, field: &dyn MetricField, tolerance: f64) -> Domain {
    let pslg = domain.pslg();
    let chains = pslg.chains();
    let neighbours = Neighbours::new(pslg);
    let mut allowed = tolerance;
    for _ in 0..6 {
        let thinned: Vec<Chain> = chains.iter().map(|chain| thin(pslg, chain, field, allowed, &neighbours)).collect();
        if let Ok(simplified) = Domain::new(&pslg.with_chains(&thinned)) {
            return simplified;
        }
        allowed *= 0.25;
    }
    domain.clone()
}

fn thin(pslg: &Pslg, chain: &Chain, field: &dyn MetricField, tolerance: f64, neighbours: &Neighbours) -> Chain {
    let points: Vec<Point> = chain.vertices.iter().map(|&v| pslg.points[v as usize]).collect();
    let mut kept = unit_steps(&points, field);
    kept.sort_unstable();
    kept.dedup();
    let is_loop = chain.vertices[0] == chain.vertices[chain.vertices.len() - 1];
    if is_loop && kept.len() < 4 {
        let n = points.len() - 1;
        kept = vec![0, n / 3, 2 * n / 3, n];
        kept.dedup();
    }
    let mut result = vec![kept[0]];
    for pair in kept.windows(2) {
        keep_within((&points, &chain.vertices), (pair[0], pair[1]), tolerance, neighbours, &mut result);
    }
    Chain { vertices: result.into_iter().map(|i| chain.vertices[i]).collect(), kind: chain.kind }
}

/// All vertices of the domain, to see which of them a chord would leave on its other side.
struct Neighbours(BoxTree<(Point, u32), 2>);

impl Neighbours {
    fn new(pslg: &Pslg) -> Self {
        Self(BoxTree::new((0..).zip(&pslg.points).map(|(i, &p)| ([[p.x, p.y]; 2], (p, i)))))
    }

    /// Whether a vertex that is not part of the run lies between the run and its chord (de Berg, van Kreveld and
    /// Schirra 1998): the chord would change on which side of the curve that vertex is.
    fn any_between(&self, run: &[Point], vertices: &[u32]) -> bool {
        let Some(bounds) = Aabb::of(run.iter().copied()).filter(|_| run.len() > 2) else { return false };
        self.0.meeting(bounds.into()).any(|(p, i)| !vertices.contains(i) && is_inside(run, *p))
    }
}

/// Even-odd test of a point against a closed polygon.
fn is_inside(polygon: &[Point], p: Point) -> bool {
    let mut inside = false;
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
        inside ^= low.y <= p.y && p.y < high.y && orientation(low, high, p) == Orientation::Left;
    }
    inside
}

/// Indices of the points nearest to equal steps of about unit metric length along a polyline, ends included.
fn unit_steps(points: &[Point], field: &dyn MetricField) -> Vec<usize> {
    let mut behind = vec![0.0];
    for pair in points.windows(2) {
        behind.push(behind[behind.len() - 1] + chord(field, pair[0], pair[1]));
    }
    let total = behind[behind.len() - 1];
    let steps = (total.round() as usize).clamp(1, points.len());
    let nearest = |k: usize| {
        let target = total * k as f64 / steps as f64;
        let after = behind.partition_point(|&l| l < target).min(points.len() - 1);
        let before = after.saturating_sub(1);
        if target - behind[before] < behind[after] - target { before } else { after }
    };
    let mut kept: Vec<usize> = (1..steps).map(nearest).collect();
    kept.extend([0, points.len() - 1]);
    kept
}

/// Adds to `result` what must be kept after point `from` up to `to`, so that no chord strays farther than the
/// tolerance (Douglas and Peucker 1973) or leaves another vertex on its wrong side.
fn keep_within(
    (points, vertices): (&[Point], &[u32]),
    (from, to): (usize, usize),
    tolerance: f64,
    neighbours: &Neighbours,
    result: &mut Vec<usize>,
) {
    let mut pending = vec![(from, to)];
    while let Some((i, j)) = pending.pop() {
        let farthest = (i + 1..j)
            .map(|k| (distance_to_segment(points[k], points[i], points[j]), k))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match farthest {
            Some((distance, k)) if distance > tolerance || neighbours.any_between(&points[i..=j], &vertices[i..=j]) => {
                pending.extend([(k, j), (i, k)]);
            }
            _ => result.push(j),
        }
    }
}

pub(super) fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.dot(d)).clamp(0.0, 1.0);
    if t.is_nan() { p.distance(a) } else { p.distance(a.lerp(b, t)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Tensor;

    #[test]
    fn a_circle_is_cut_at_unit_length_or_finer_where_the_tolerance_asks() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        let size = |h: f64| move |_: Point| Tensor::isotropic(h);
        let sides = |h: f64, tolerance: f64| simplify(&domain, &size(h), tolerance).boundary().len();
        assert_eq!(sides(0.1, 1.0), 63);
        assert!(sides(10.0, 1e-2) >= 22 && sides(10.0, 1e-2) < 60, "{}", sides(10.0, 1e-2));
        assert!(sides(10.0, 10.0) >= 3);
    }

    #[test]
    fn corners_of_a_square_stay_within_a_small_tolerance() {
        let square = Domain::shape("rect:0,0,1,1").unwrap();
        assert_eq!(simplify(&square, &|_: Point| Tensor::isotropic(100.0), 0.01).boundary().len(), 4);
    }
}

//! Fewer points for the same line.

/// The polyline without points that are not needed to stay within a tolerance of it (Ramer 1972; Douglas and Peucker
/// 1973). Kept are both ends, or the corners of a closed line; a line between two corners comes out the same in both
/// directions.
pub(super) fn simplify(points: &[[i64; 2]], corners: &[u32], is_closed: bool, tolerance: f64) -> Vec<[i64; 2]> {
    let n = points.len();
    if n < 3 {
        return points.to_vec();
    }
    if !is_closed {
        let mut kept = Vec::new();
        keep(points, tolerance, &mut kept);
        kept.push(points[n - 1]);
        return kept;
    }
    let stops = stops(points, corners);
    let mut kept = Vec::new();
    for (i, &from) in stops.iter().enumerate() {
        let to = stops[(i + 1) % stops.len()];
        let steps = if to > from { to - from } else { to + n - from };
        let line: Vec<[i64; 2]> = (0..=steps).map(|k| points[(from + k) % n]).collect();
        keep(&line, tolerance, &mut kept);
    }
    kept
}

/// The corners; where there are fewer than two, points far apart from each other.
fn stops(points: &[[i64; 2]], corners: &[u32]) -> Vec<usize> {
    let mut stops: Vec<usize> = corners.iter().map(|&c| c as usize).collect();
    let first = stops.first().copied().unwrap_or(0);
    if stops.len() < 2 {
        let far = (0..points.len()).min_by_key(|&i| -square(points[i], points[first])).unwrap_or(0);
        stops = vec![first.min(far), first.max(far)];
        stops.dedup();
    }
    stops
}

fn square(p: [i64; 2], q: [i64; 2]) -> i128 {
    let [dx, dy] = [p[0] - q[0], p[1] - q[1]].map(i128::from);
    dx * dx + dy * dy
}

/// Appends what is kept of a line, without its last point.
fn keep(line: &[[i64; 2]], tolerance: f64, kept: &mut Vec<[i64; 2]>) {
    // Ranges still to be looked at, the first of them last; no recursion, for lines can have any number of points.
    let mut ranges = vec![(0, line.len() - 1)];
    while let Some((a, b)) = ranges.pop() {
        let far = (a + 1..b).map(|i| (i, distance(line[i], line[a], line[b])));
        let farthest = far.max_by(|x, y| x.1.total_cmp(&y.1).then(line[x.0].cmp(&line[y.0])));
        match farthest {
            Some((i, distance)) if distance > tolerance => ranges.extend([(i, b), (a, i)]),
            _ => kept.push(line[a]),
        }
    }
}

/// The distance of a point from a segment, to the last bit the same from b to a.
fn distance(p: [i64; 2], a: [i64; 2], b: [i64; 2]) -> f64 {
    let (a, b) = (a.min(b), a.max(b));
    let [ux, uy] = [b[0] - a[0], b[1] - a[1]].map(|x| x as f64);
    let [vx, vy] = [p[0] - a[0], p[1] - a[1]].map(|x| x as f64);
    let length2 = ux * ux + uy * uy;
    let t = if length2 > 0.0 { ((ux * vx + uy * vy) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (vx - t * ux).hypot(vy - t * uy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_near_and_the_same_backwards() {
        let wave: Vec<[i64; 2]> = (0..=200).map(|i| [10 * i, (300.0 * (0.05 * i as f64).sin()) as i64]).collect();
        let short = simplify(&wave, &[], false, 6.0);
        assert!(short.len() < 40 && short.len() > 8, "{}", short.len());
        for &p in &wave {
            assert!(short.windows(2).any(|w| distance(p, w[0], w[1]) <= 6.0));
        }
        let reversed: Vec<_> = wave.iter().rev().copied().collect();
        let mut back = simplify(&reversed, &[], false, 6.0);
        back.reverse();
        assert_eq!(short, back);
    }

    #[test]
    fn closed_lines_keep_their_corners() {
        let square = [[0, 0], [5, 0], [10, 0], [10, 5], [10, 10], [5, 10], [0, 10], [0, 5]];
        assert_eq!(simplify(&square, &[], true, 0.5), [[0, 0], [10, 0], [10, 10], [0, 10]]);
        assert_eq!(simplify(&square, &[1, 3], true, 0.5), [[5, 0], [10, 0], [10, 5], [10, 10], [0, 10], [0, 0]]);
        assert_eq!(simplify(&[[3, 3]; 4], &[], true, 0.5), [[3, 3]]);
    }
}

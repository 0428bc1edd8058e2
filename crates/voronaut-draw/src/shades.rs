//! How the triangles of pictures are filled: by their size, their protection, or values.

use super::colours;
use std::collections::BTreeMap;
use voronaut::mesh::Mesh;
use voronaut::net::{Ball, Net};

/// How many levels of colour there are per region, and above the protection that was asked for.
const LEVELS: f64 = 11.0;
/// Steps of colour of values.
pub(super) const BANDS: f64 = 40.0;
/// A protection, as a share of epsilon, beyond which triangles are as pale as can be.
const MUCH: f64 = 1.0;

/// How each triangle of a net is filled: blue below the protection asked for, from warm to pale the more there is above it; grey where
/// the circumcentre is outside the domain or no circle was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Protection {
    shares: BTreeMap<[u32; 3], f64>,
    asked: f64,
}

impl Protection {
    /// Of a net, of which a protection was asked for, as a share of epsilon.
    pub fn new(net: &Net, asked: f64) -> Self {
        let share = |ball: &Ball<3>| (sorted(ball.corners), ball.protection() / net.epsilon);
        Self { shares: net.interior().map(share).collect(), asked }
    }

    /// The fill of a triangle.
    pub(super) fn fill(&self, triangle: [u32; 3]) -> String {
        match self.shares.get(&sorted(triangle)) {
            None => colours::UNKNOWN.into(),
            Some(&share) if share < self.asked => "#2040c0".into(),
            Some(&share) => {
                let above = ((share - self.asked) / (MUCH - self.asked).max(0.1)).clamp(0.0, 1.0);
                colours::protection_fill((above * LEVELS).round() / LEVELS)
            }
        }
    }
}

fn sorted(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}

/// The triangles whose vertices exist and are finite, and their labels.
pub(super) fn drawable(mesh: &Mesh) -> (Vec<[u32; 3]>, Vec<i32>) {
    let exists = |&v: &u32| mesh.points.get(v as usize).is_some_and(|p| p.iter().all(|x| x.is_finite()));
    let labels = mesh.triangle_labels.iter().copied().chain(std::iter::repeat(0));
    mesh.triangles.iter().copied().zip(labels).filter(|(triangle, _)| triangle.iter().all(exists)).unzip()
}

/// The number of each triangle's region, and how small it is, from 0 (the largest) to 1, by the logarithm of its area. All but the
/// outermost hundredths of the sizes are told apart, and at least a factor of four.
pub(super) fn sizes(areas: impl Iterator<Item = f64>, labels: &[i32]) -> Vec<(usize, f64)> {
    let regions = distinct(labels.iter().copied());
    let sizes: Vec<f64> = areas.map(f64::ln).collect();
    let finite = in_order(sizes.iter().copied().filter(|size| size.is_finite()));
    let at = |share: f64| finite.get((share * finite.len() as f64) as usize).copied().unwrap_or(0.0);
    let (low, high) = (at(0.01), at(0.99));
    let missing = (4.0_f64.ln() - (high - low)).max(0.0);
    let [low, high] = [low - 0.5 * missing, high + 0.5 * missing];
    let share = |size: f64| ((high - size) / (high - low)).clamp(0.0, 1.0);
    labels.iter().zip(sizes).map(|(label, size)| (regions.binary_search(label).unwrap_or(0), share(size))).collect()
}

/// What there is among these, each once, in order.
pub(super) fn distinct<T: Ord>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut list: Vec<T> = items.collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// Numbers from the least to the greatest.
pub(super) fn in_order(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_unstable_by(f64::total_cmp);
    numbers
}

/// The fill of each triangle by what [`sizes`] says of it.
pub(super) fn size_fills(areas: impl Iterator<Item = f64>, labels: &[i32]) -> Vec<String> {
    let level = |share: f64| (share * LEVELS).round() / LEVELS;
    sizes(areas, labels).into_iter().map(|(region, share)| colours::fill(region, level(share))).collect()
}

/// The fill of each triangle by the mean of the values at its corners: the less, the stronger; grey where that is not finite.
pub(super) fn value_fills(triangles: &[[u32; 3]], values: &[f64]) -> Vec<String> {
    let mean = |t: &[u32; 3]| t.iter().map(|&v| values.get(v as usize).copied().unwrap_or(f64::NAN)).sum::<f64>() / 3.0;
    let most = triangles.iter().map(mean).filter(|value| value.is_finite()).fold(0.0, f64::max);
    let level = |value: f64| ((1.0 - value / most) * BANDS).round() / BANDS;
    let of = |value: f64| if value.is_finite() { colours::fill(0, level(value)) } else { colours::UNKNOWN.into() };
    triangles.iter().map(|t| of(mean(t))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use voronaut::geometry::Point;

    #[test]
    fn what_is_asked_for_parts_blue_from_warm() {
        let ball = |power: f64, first: u32| Ball {
            corners: [first, 8, 9],
            centre: Point::default(),
            radius: 1.0,
            power,
            nearest: None,
            is_interior: true,
        };
        let net = Net { triangles: vec![ball(0.01, 1), ball(0.05, 2), ball(-1.0, 3)], epsilon: 1.0, ..Net::default() };
        let protection = Protection::new(&net, 0.2);
        let fills = [1, 2, 3, 4].map(|first| protection.fill([9, first, 8]));
        assert_eq!(fills[0], fills[2]);
        assert!(fills[1] != fills[0] && fills[3] != fills[0] && fills[1] != fills[3]);
    }
}

//! The power protection of a net's triangles, to be drawn.

use super::colours;
use std::collections::BTreeMap;
use voronaut::net::{Ball, Net};

/// A protection, as a share of epsilon, beyond which triangles are as pale as can be.
const MUCH: f64 = 1.0;
/// Levels of colour.
const LEVELS: f64 = 11.0;

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
            None => "#d8d8d8".into(),
            Some(&share) if share < self.asked => "#2040c0".into(),
            Some(&share) => {
                let above = ((share - self.asked) / (MUCH - self.asked).max(0.1)).clamp(0.0, 1.0);
                colours::quality_fill((above * LEVELS).round() / LEVELS)
            }
        }
    }
}

fn sorted(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
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

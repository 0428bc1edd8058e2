//! The interior by the protection criterion (RR-9103, section 13): seeds near circumcentres, where they leave no simplex
//! without power protection.

use super::interior::{Fill, encroached_edge, insert_spaced, is_crowded, refine_with};
use crate::dual::{Dual, Moving};
use crate::error::Result;
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::net::{Estimate, Random};
use crate::planar::Location;
use crate::progress::Progress;
use crate::triangulation::{FaceId, VertexId};

/// Places tried in a picking region, the circumcentre first: as many as in the authors' program.
const TRIES: usize = 60;
/// Circles with a larger radius (metric units) are not what the seeds are going to have: no place is picked for them.
const COARSE: f64 = 1.1;
/// Share of the seeds that is kept for simplices that lack protection.
const RESERVE: f64 = 0.01;

/// What is asked of places for seeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Picking {
    /// The power protection that simplices shall have, as a share of the circumradius of the worst of them.
    pub protection: f64,
    /// The radius of the picking region, as a share of the circumradius.
    pub radius: f64,
}

/// [`refine`](super::refine) with places picked. Most seeds go by size, where the circumradius is largest; then come seeds
/// for simplices that lack protection, largest first, as far as valid places for them exist; the rest goes by size again.
/// It ends where [`refine`](super::refine) does. Deterministic.
pub(crate) fn refine_protected(dual: &mut Dual, fill: Fill, picking: Picking, progress: &dyn Progress) -> Result<()> {
    let mut picker = Picker { picking, random: Random::new(fill.count() as u64) };
    let by_size = (fill.count() as f64 * (1.0 - RESERVE)) as usize;
    let first = match fill {
        Fill::Exactly(_) => Fill::Exactly(by_size),
        Fill::AtMost(_) => Fill::AtMost(by_size),
    };
    let refine = |dual: &mut Dual, picker: &mut Picker, fill| {
        refine_with(dual, fill, progress, &mut |dual, place, circle| picker.insert(dual, place, circle))
    };
    refine(dual, &mut picker, first)?;
    picker.protect(dual, fill.count());
    refine(dual, &mut picker, fill)
}

struct Picker {
    picking: Picking,
    random: Random,
}

impl Picker {
    /// A seed in a valid place of the picking region; where there is none yet, at the circumcentre.
    fn insert(&mut self, dual: &mut Dual, place: Location, (centre, radius): (Point, f64)) -> bool {
        if radius > COARSE {
            return insert_spaced(dual, place, centre);
        }
        // Where the circumcentre is too near to a seed, tries would only stir up faces, for ever.
        let Location::Face(face) = place else { return insert_spaced(dual, place, centre) };
        if is_crowded(dual, face, centre) {
            return false;
        }
        let near = dual.topology().corners(face)[0];
        // The tries may leave other faces there.
        self.pick_valid(dual, place, (centre, radius)).is_some()
            || dual.seen_from(near, centre, true).is_some_and(|p| insert_spaced(dual, p, centre))
    }

    /// Seeds for the simplices that lack protection, as far as there are valid places.
    fn protect(&mut self, dual: &mut Dual, count: usize) {
        let estimate = Estimate::of(dual);
        let squares = dual.topology().faces().filter_map(|f| estimate.circle(f)).map(|(_, square)| square);
        let asked = squares.fold(0.0, f64::max).min(COARSE * COARSE) * self.picking.protection.powi(2);
        let circle = |f: FaceId| {
            let (centre, square) = estimate.circle(f)?;
            Some((centre, square.sqrt(), dual.topology().corners(f)[0]))
        };
        let short = estimate.short_faces(asked).into_iter();
        let mut places: Vec<(Point, f64, VertexId)> = short.filter_map(circle).collect();
        places.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.2.cmp(&b.2)));
        for (centre, radius, near) in places {
            if dual.vertex_count() >= count {
                return;
            }
            if let Some(place) = dual.seen_from(near, centre, true) {
                self.pick_valid(dual, place, (centre, radius));
            }
        }
    }

    /// A seed in the picking region around a circumcentre that leaves no simplex around unprotected on its account.
    fn pick_valid(&mut self, dual: &mut Dual, place: Location, (centre, radius): (Point, f64)) -> Option<VertexId> {
        let Location::Face(face) = place else { return None };
        // Faces come and go with the tries, their corners stay.
        let near = dual.topology().corners(face)[0];
        let asked = (self.picking.protection * radius).powi(2);
        let tensor = dual.field().at(centre);
        let mut p = centre;
        for _ in 0..TRIES {
            if let Some(v) = insert_valid(dual, near, p, asked) {
                return Some(v);
            }
            p = centre + self.random.in_ball(tensor, self.picking.radius * radius);
        }
        None
    }
}

/// Inserts a seed, and takes it out again unless it is valid.
fn insert_valid(dual: &mut Dual, near: VertexId, p: Point, asked: f64) -> Option<VertexId> {
    let Location::Face(face) = dual.seen_from(near, p, true)? else { return None };
    if encroached_edge(dual, face, p).is_some() || is_crowded(dual, face, p) {
        return None;
    }
    let v = dual.insert_in_face(face, p)?;
    let estimate = Estimate::of(dual);
    let is_valid = estimate.shortfall_of(v, &estimate.around(v), asked) <= 0.0;
    // A seed that cannot be taken out stays.
    (is_valid || !dual.remove(v)).then_some(v)
}

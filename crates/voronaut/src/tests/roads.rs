//! The two roads to the dual of given seeds, lengths of geodesics and the nerve on a canvas, held against each other.

use crate::canvas::{Canvas, size_for};
use crate::diagram::Diagram;
use crate::dual::Road;
use crate::geometry::Point;
use crate::manifold::domain::Domain;
use crate::metric::{MetricField, Shock, Swirl};
use crate::progress::Silent;
use crate::recipe::{self, SeedDual};
use std::collections::{BTreeMap, BTreeSet};

/// A number in 0..1 from two, the same on every machine.
fn hashed(i: u64, salt: u64) -> f64 {
    let mut z = i.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ salt.wrapping_mul(0xd134_2543_de82_ef95);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Random points of the square [-half, half]^2.
fn scattered(count: u64, half: f64, salt: u64) -> Vec<Point> {
    let at = |i| half * (2.0 * hashed(i, salt) - 1.0);
    (0..count).map(|i| Point::new(at(2 * i), at(2 * i + 1))).collect()
}

fn square(half: f64) -> Domain {
    Domain::shape(&format!("rect:{},{},{half},{half}", -half, -half)).unwrap()
}

/// Triangles without their turn, each as often as it is there.
fn counted(triangles: impl IntoIterator<Item = [u32; 3]>) -> BTreeMap<[u32; 3], usize> {
    let mut counts = BTreeMap::new();
    for mut t in triangles {
        t.sort_unstable();
        *counts.entry(t).or_insert(0) += 1;
    }
    counts
}

/// Triangles of the one that the other has not.
fn missing(of: &BTreeMap<[u32; 3], usize>, from: &BTreeMap<[u32; 3], usize>) -> Vec<[u32; 3]> {
    of.iter().filter(|&(t, count)| from.get(t) != Some(count)).map(|(t, _)| *t).collect()
}

fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)])
}

fn both(domain: &Domain, field: &dyn MetricField, seeds: &[Point]) -> SeedDual {
    let canvas = Canvas::intrinsic(domain.planar(), field, size_for(seeds.len(), 60)).unwrap();
    recipe::dual(&Diagram::new(&canvas, field, seeds).unwrap(), Road::Both, &Silent)
}

/// The dual of few seeds, cells many units wide, is the nerve on a canvas twice as fine, but where it says that it is not
/// sure.
fn few(domain: &Domain, field: &dyn MetricField, fine: &Canvas, seeds: &[Point]) {
    let found = both(domain, field, seeds);
    let nerve = Diagram::new(fine, field, seeds).unwrap().sharp_nerve();
    let fine = counted(nerve.triangles.iter().map(|t| t.colours));
    let ours = counted(found.triangles.iter().copied());
    let [lost, new] = [missing(&fine, &ours), missing(&ours, &fine)];
    let edges: BTreeSet<[u32; 2]> = found.triangles.iter().flat_map(|&t| sides(t)).collect();
    println!(
        "{} seeds: {} triangles, {} uncertain; lost {lost:?}, new {new:?}",
        seeds.len(),
        ours.len(),
        found.account.uncertain
    );
    assert!(lost.is_empty() && new.is_empty(), "lost {lost:?}, new {new:?}");
    assert!(found.account.uncertain * 50 <= edges.len(), "{:?}", found.account.uncertain_edges);
}

#[test]
fn few_seeds_of_the_swirl_have_the_nerve_of_a_finer_canvas() {
    let (domain, field) = (square(2.0), Swirl::default());
    let fine = Canvas::intrinsic(domain.planar(), &field, 250_000).unwrap();
    for count in [12, 30] {
        few(&domain, &field, &fine, &scattered(count, 1.9, 1));
    }
}

#[test]
fn few_seeds_of_the_shock_have_the_nerve_of_a_finer_canvas() {
    let (domain, field) = (square(1.0), Shock::default());
    let fine = Canvas::intrinsic(domain.planar(), &field, 250_000).unwrap();
    for count in [12, 30] {
        few(&domain, &field, &fine, &scattered(count, 0.95, 1));
    }
}

/// Seeds of which none is nearer to another than this, with the tensor between them.
fn darts(field: &dyn MetricField, half: f64, spacing: f64, tries: u64) -> Vec<Point> {
    let mut seeds: Vec<Point> = Vec::new();
    for p in scattered(tries, half, 3) {
        if seeds.iter().all(|&q| field.at(p.midpoint(q)).length(q - p) > spacing) {
            seeds.push(p);
        }
    }
    seeds
}

/// Many seeds: nerve and lengths differ on half a per cent of the triangles at most, and every edge that lengths have and
/// the nerve has not is listed with its margin.
fn many(name: &str, domain: &Domain, field: &dyn MetricField, seeds: &[Point]) {
    assert!(seeds.len() >= 1500, "{name}: {} seeds", seeds.len());
    let canvas = Canvas::intrinsic(domain.planar(), field, size_for(seeds.len(), 60)).unwrap();
    let diagram = Diagram::new(&canvas, field, seeds).unwrap();
    assert_eq!(diagram.orphans().len(), 0);
    let nerve = counted(diagram.sharp_nerve().triangles.iter().map(|t| t.colours));
    let of_nerve: BTreeSet<[u32; 2]> = nerve.keys().flat_map(|&t| sides(t)).collect();
    for road in [Road::Geodesic, Road::Both] {
        let found = recipe::dual(&diagram, road, &Silent);
        let lengths = counted(found.triangles.iter().copied());
        let differ = missing(&lengths, &nerve).len();
        let listed: BTreeSet<[u32; 2]> = found
            .account
            .disagreements
            .iter()
            .map(|d| {
                assert!(d.margin.is_finite() && d.error >= 0.0, "{d:?}");
                [d.edge[0].min(d.edge[1]), d.edge[0].max(d.edge[1])]
            })
            .collect();
        let edges: BTreeSet<[u32; 2]> = lengths.keys().flat_map(|&t| sides(t)).collect();
        let unlisted: Vec<_> = edges.difference(&of_nerve).filter(|edge| !listed.contains(*edge)).collect();
        println!(
            "{name}, {road:?}: {} seeds, {differ} of {} triangles differ, {} edges listed, {} uncertain",
            seeds.len(),
            lengths.len(),
            listed.len(),
            found.account.uncertain
        );
        assert!(
            differ * 200 <= lengths.len() && missing(&nerve, &lengths).len() * 200 <= nerve.len(),
            "{name}: {differ}"
        );
        assert!(unlisted.is_empty(), "{name}: {unlisted:?}");
    }
}

#[test]
fn nerve_and_lengths_agree_on_the_swirl() {
    let field = Swirl::default();
    many("swirl", &square(2.0), &field, &darts(&field, 2.0, 0.032, 40_000));
}

#[test]
fn nerve_and_lengths_agree_on_the_shock() {
    let field = Shock { phi: 1.0, lambda: 0.6 };
    many("shock", &square(1.0), &field, &darts(&field, 1.0, 0.07, 40_000));
}

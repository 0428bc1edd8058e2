//! One set of seeds on canvases of each kind (RR-9103, Figure 7).

use super::common::square;
use super::{WAVES, lattice, sorted, truth};
use crate::canvas::{Canvas, Kind};
use crate::diagram::{Diagram, RESOLVE_ROUNDS, resolve};
use std::collections::BTreeSet;

#[test]
fn protected_seeds_have_the_same_nerve_on_every_canvas() {
    let (domain, metric) = (square(2.0), WAVES.metric);
    let seeds = lattice(2.0, 0.1, 0.3, &WAVES.inverse);
    let (truth, is_inside) = truth(&WAVES, &seeds, 2.0);
    assert!(truth.len() > 200, "{}", truth.len());
    for (kind, per_seed) in [(Kind::Intrinsic, 30), (Kind::Isotropic, 300), (Kind::StarSet, 30)] {
        let canvas = Canvas::new(kind, domain.planar(), &metric, per_seed * seeds.len()).unwrap();
        let before = canvas.vertex_count();
        let resolved = resolve(canvas, &metric, &seeds, RESOLVE_ROUNDS).unwrap();
        let diagram = Diagram::new(&resolved.canvas, &metric, &seeds).unwrap();
        let witnessed = diagram.witnesses_of_triangles();
        let raw: BTreeSet<[u32; 3]> = witnessed.iter().map(|witness| sorted(witness.0)).collect();
        println!("{kind}: {before} vertices, then {}, {} triangles", resolved.canvas.vertex_count(), raw.len());
        assert!(raw.len() == witnessed.len() && resolved.canvas.vertex_count() < before + before / 3);
        assert_eq!(truth.difference(&raw).count(), 0, "{kind}");
        assert_eq!(raw.iter().filter(|&&t| is_inside(t) && !truth.contains(&t)).count(), 0, "{kind}");
    }
}

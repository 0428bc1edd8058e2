//! Errors on surfaces against closed forms, on canvases of 4,000 and 16,000 vertices of every kind.

use super::cases::relative_errors;
use super::grounds::{Board, Ground, great_circle, relaxed, sheet, sphere, stretched_sphere, wavy};
use crate::canvas::Kind;
use crate::geodesic::Method;
use crate::geometry::{Point, Point3};
use crate::triangulation::VertexId;

/// The exact distance between two points.
type Exact = Box<dyn Fn(Point3, Point3) -> f64>;

/// Surfaces with the exact distances.
fn cases() -> [(Ground, Exact); 4] {
    let unrolled = |times: f64| -> Exact {
        let wavy = wavy();
        let flat = move |p: Point3| {
            let flat = wavy.unrolled(p);
            Point::new(times * flat.x, flat.y)
        };
        Box::new(move |p, q| flat(p).distance(flat(q)))
    };
    [
        (sphere(), Box::new(great_circle)),
        (stretched_sphere(), Box::new(|p, q| great_circle(relaxed(p), relaxed(q)))),
        (sheet("sheet", 1.0), unrolled(1.0)),
        (sheet("stretched sheet", 4.0), unrolled(4.0)),
    ]
}

/// The greatest mean error on canvases of 16,000 vertices. Measured: 0.16 %, 1.5 %, 4.6 %, 0.72 % and 10.5 % at most. The third
/// and the last are of star sets on the stretched sheet, where bisection makes a lattice: its stars have no diagonals in one
/// direction, and ways along edges are up to 41 % too long; elsewhere it is 2.1 % and 8.8 %, on the stretched sphere.
fn most(method: Method) -> f64 {
    match method {
        Method::March => 2e-3,
        Method::Heat => 0.02,
        Method::Konukoglu => 0.06,
        Method::Stvd { .. } => 0.01,
        Method::Dijkstra => 0.12,
        Method::Lbr => 0.0,
    }
}

/// Marching is exact on flat faces, but where a front bends around a vertex, and of first order elsewhere.
fn is_as_good_as_marching(name: &str, [coarse, fine]: [f64; 2]) -> bool {
    if name.ends_with("sheet") { fine < 1e-5 } else { fine < 0.7 * coarse }
}

#[test]
fn methods_are_as_accurate_on_surfaces_as_in_the_plane() {
    let mut faults = Vec::new();
    for (ground, exact) in cases() {
        for kind in Kind::ALL {
            let boards = [4000, 16_000].map(|n| ground.board(kind, n));
            for method in ground.methods() {
                let errors = boards.each_ref().map(|board| {
                    let found = board.distances(&[0], method).unwrap();
                    let from = board.place(0);
                    let vertices = (0..board.vertex_count() as u32).map(VertexId);
                    let known: Vec<(f64, f64)> =
                        vertices.zip(found.values()).map(|(v, &d)| (d, exact(from, board.position(v)))).collect();
                    assert!(known.iter().all(|pair| pair.0.is_finite()), "{method}");
                    relative_errors(&known)
                });
                let vertices = boards.each_ref().map(Board::vertex_count);
                println!("{}, {kind} {vertices:?}, {method}: {errors:.6?}", ground.name);
                let is_good =
                    method != Method::March || is_as_good_as_marching(ground.name, [errors[0][1], errors[1][1]]);
                if errors[1][1] > most(method) || !is_good {
                    faults.push(format!("{}, {kind}, {method}: {errors:?}", ground.name));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

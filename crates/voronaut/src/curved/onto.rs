//! Triangles of order 2 and 3 with their nodes on a surface f = 0.

use super::bezier::{exponents, seen_from_above};
use super::elements::HALVINGS;
use super::jacobian::bound;
use super::slide::Sliding;
use crate::geometry::Point3;
use crate::lists::distinct;
use crate::manifold::Manifold;
use crate::mesh::{Curved, Edges, Mesh};
use crate::parallel::prelude::*;

/// Nodes come back halfway to the straight triangle where it would fold, at most so many times, and all the way then.
const BARRED: i32 = 5;

/// The triangles of a straight mesh of an equation's surface with nodes on that, near equal steps along edges and the middles of triangles, from where
/// they slide ([`Sliding`]). Nodes of an edge on the border keep the coordinates that its ends have in common. Where a triangle would fold, seen along its
/// normal, or the surface is not found, nodes stay nearer to the straight one; returns how many do, and where the first is. The distance to the surface is
/// of order `order + 1` in the length of edges, and `order + 2` where it bends along them.
pub(crate) fn onto_surface(mesh: &mut Mesh, manifold: &Manifold, order: usize) -> Option<(usize, Point3)> {
    let (straight, pins, triangles) = straight_nodes(mesh, order);
    let mut landed: Vec<Option<Point3>> =
        (0..straight.len()).into_par_iter().map(|n| manifold.onto(straight[n], pins[n])).collect();
    Sliding { mesh, manifold, order, triangles: &triangles, pins: &pins }.slide(&mut landed);
    let mut halved: Vec<i32> = landed.iter().map(|p| if p.is_some() { 0 } else { BARRED }).collect();
    let place = |n: usize, halved: i32| match landed[n] {
        Some(p) if halved < BARRED => straight[n].lerp(p, 0.5_f64.powi(halved)),
        _ => straight[n],
    };
    let nodes = (0..straight.len()).map(|n| place(n, halved[n]).to_array()).collect();
    mesh.curved = Some(Curved { order, nodes, triangles });
    loop {
        let folds = |t: &usize| {
            let (points, order) = seen_from_above(mesh, *t);
            !bound(&points[..exponents(order).len()], order, HALVINGS).is_valid()
        };
        let folded: Vec<usize> = (0..mesh.triangles.len()).into_par_iter().filter(folds).collect();
        let curved = mesh.curved.as_mut().expect("made above");
        let mut moved = distinct(folded.iter().flat_map(|&t| curved.triangle(t)).map(|&n| n as usize));
        moved.retain(|&n| halved[n] < BARRED);
        if moved.is_empty() {
            break;
        }
        for n in moved {
            halved[n] += 1;
            curved.nodes[n] = place(n, halved[n]).to_array();
        }
    }
    let first = halved.iter().position(|&times| times > 0)?;
    Some((halved.iter().filter(|&&times| times > 0).count(), straight[first]))
}

/// The nodes of straight triangles, which of their coordinates stay, and the numbers of those of each triangle.
fn straight_nodes(mesh: &Mesh, order: usize) -> (Vec<Point3>, Vec<[bool; 3]>, Vec<u32>) {
    let (mut nodes, mut pins) = (Vec::new(), Vec::new());
    let inner = order - 1;
    let per_triangle = exponents(order).len() - 3;
    let mut triangles = vec![0; mesh.triangles.len() * per_triangle];
    for sides in Edges::of(&mesh.triangles).iter() {
        let [a, b] = sides[0].ends.map(|v| Point3::from(mesh.points[v as usize]));
        let way = b - a;
        let stays = [way.x, way.y, way.z].map(|x| sides.len() == 1 && x == 0.0);
        let first = nodes.len() as u32;
        for i in 1..order {
            nodes.push(a.lerp(b, i as f64 / order as f64));
            pins.push(stays);
        }
        for edge in &sides {
            let (triangle, s) = (edge.triangle(), edge.half_edge as usize % 3);
            for i in 0..inner {
                let number = first + if edge.forward { i } else { inner - 1 - i } as u32;
                triangles[triangle * per_triangle + s * inner + i] = number;
            }
        }
    }
    if order == 3 {
        for (t, &corners) in mesh.triangles.iter().enumerate() {
            triangles[t * per_triangle + per_triangle - 1] = nodes.len() as u32;
            nodes.push(Point3::weighted(mesh.positions_of(corners), [1.0 / 3.0; 3]));
            pins.push([false; 3]);
        }
    }
    (nodes, pins, triangles)
}

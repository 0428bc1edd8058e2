//! Vertices from sides that are glued: one for every fan of triangles.

use super::glue::Twins;
use super::mended::Damage;
use super::work::Work;
use crate::error::{Error, Result};
use crate::geometry::Point3;
use crate::lists::{Classes, in_order};
use crate::mesh::edges::{NONE, edges_of, fans, vertices_of_several};

/// Triangles with their final vertices.
pub(super) struct Sewn {
    pub(super) triangles: Vec<[u32; 3]>,
    /// The triangle of the mesh that each is a part of, or beside which it fills a hole.
    pub(super) sources: Vec<u32>,
    /// The corners as the mesh numbers them; [`NONE`] of what is new.
    pub(super) numbers: Vec<[u32; 3]>,
    /// The positions of vertices behind those of the mesh, and which vertex of the mesh each is a copy of, or near.
    pub(super) added: Vec<(Point3, u32)>,
}

/// Gives every fan of triangles a vertex of its own: the first number in it that no other fan has taken, or a new one.
///
/// # Errors
/// [`Error::Domain`] of a vertex that is several fans by its number, unless damage is to be repaired.
pub(super) fn sew(work: &mut Work, twins: &Twins) -> Result<Sewn> {
    let place = |side: u32| work.places.of(work.ends(side)[0]);
    let fans = fans(twins, |side, twin| place(side) == place(twin));
    demand_fans(work, &fans)?;
    let corners = work.triangles.as_flattened();
    let mut least = vec![NONE; corners.len()];
    for (i, &number) in corners.iter().enumerate() {
        let fan = fans.of(i as u32) as usize;
        least[fan] = least[fan].min(number);
    }
    let mut owner = vec![NONE; work.mesh.points.len()];
    let mut added = Vec::new();
    let mut vertex_of = vec![NONE; corners.len()];
    for i in 0..corners.len() {
        let fan = fans.of(i as u32) as usize;
        if vertex_of[fan] == NONE {
            let number = least[fan];
            vertex_of[fan] = if owner[number as usize] == NONE {
                owner[number as usize] = fan as u32;
                number
            } else {
                added.push((work.position(number), number));
                (work.mesh.points.len() + added.len() - 1) as u32
            };
        }
        vertex_of[i] = vertex_of[fan];
    }
    let triangles = vertex_of.as_chunks::<3>().0.to_vec();
    let mut sewn = Sewn { triangles, sources: work.sources.clone(), numbers: work.triangles.clone(), added };
    separate(work, &mut sewn, twins);
    Ok(sewn)
}

fn demand_fans(work: &mut Work, fans: &Classes) -> Result<()> {
    for number in vertices_of_several(fans, work.triangles.as_flattened()) {
        let place = work.vertex(number);
        if !work.options.repair {
            let help = "split the vertex, one for each group of neighbouring triangles, or run again with `repair`";
            return Err(Error::domain("triangles that meet in a point only", place, help));
        }
        work.mended.add(Damage::Point, place);
    }
    Ok(())
}

/// Where two fans pass the same edge twice, its vertices are the same and yet these are two edges: all but the first get a
/// vertex in the middle.
fn separate(work: &Work, sewn: &mut Sewn, twins: &Twins) {
    let ends = |side: u32| in_order(edges_of(sewn.triangles[side as usize / 3])[side as usize % 3]);
    let firsts = (0..twins.len() as u32).filter(|&side| twins[side as usize] == NONE || side < twins[side as usize]);
    let mut keyed: Vec<([u32; 2], u32)> = firsts.map(|side| (ends(side), side)).collect();
    keyed.sort_unstable();
    let doubled: Vec<u32> =
        keyed.chunk_by(|a, b| a.0 == b.0).flat_map(|same| &same[1..]).map(|&(_, side)| side).collect();
    let mut middles = std::collections::BTreeMap::<usize, [u32; 3]>::new();
    for side in doubled {
        let [v, w] = work.ends(side);
        let middle = (work.mesh.points.len() + sewn.added.len()) as u32;
        sewn.added.push((work.position(v).lerp(work.position(w), 0.5), v));
        for side in [side, twins[side as usize]].into_iter().filter(|&side| side != NONE) {
            middles.entry(side as usize / 3).or_insert([NONE; 3])[side as usize % 3] = middle;
        }
    }
    for (t, middles) in middles {
        cut(sewn, t, middles);
    }
}

/// Cuts a triangle at vertices in the middles of sides 0-1, 1-2, 2-0, where there are any.
fn cut(sewn: &mut Sewn, t: usize, middles: [u32; 3]) {
    let (corners, numbers) = (sewn.triangles[t], sewn.numbers[t]);
    let around = [0, 1, 2].map(|k| [(corners[k], numbers[k]), (middles[k], NONE)]);
    let mut polygon: Vec<(u32, u32)> = around.concat().into_iter().filter(|v| v.0 != NONE).collect();
    // A middle between two neighbours that are not on its line is never cut off, so no part is flat.
    let mut parts = Vec::new();
    while polygon.len() > 3 {
        let n = polygon.len();
        let is_middle = |i: usize| polygon[i % n].1 == NONE && middles.contains(&polygon[i % n].0);
        let ear = (0..n).find(|&i| !is_middle(i) && (is_middle(i + 1) || is_middle(i + n - 1))).unwrap_or(0);
        parts.push([polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n]]);
        polygon.remove(ear);
    }
    parts.push([polygon[0], polygon[1], polygon[2]]);
    let source = sewn.sources[t];
    for (i, part) in parts.into_iter().enumerate() {
        let (triangle, numbers) = (part.map(|v| v.0), part.map(|v| v.1));
        if i == 0 {
            (sewn.triangles[t], sewn.numbers[t]) = (triangle, numbers);
        } else {
            sewn.triangles.push(triangle);
            sewn.numbers.push(numbers);
            sewn.sources.push(source);
        }
    }
}

//! Better triangles on a surface f = 0: edges are split and collapsed towards a length that the curvature asks for, flipped
//! and evened out, as in isotropic remeshing (Botsch and Kobbelt 2004) with graded sizes (Dunyach et al. 2013). Here a change
//! is made only if it makes the worst triangle around it no worse, folded ones being worse than all others.

use super::implicit::unpinned;
use super::level::{Level, Vertex, quality};
use super::{Implicit, Surface};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3, Vector3};
use crate::lists::ranked;
use crate::metric::Neighbours;
use crate::metric::nodal::Gradation;
use crate::parallel::prelude::*;
use crate::triangulation::{Flipping, HalfEdge, Lawson, Limit, Triangulation, VertexId};

/// Edges times the larger principal curvature should be about this.
const BEND: f64 = 0.4;
/// Edges are not made shorter than this part of what is asked for, whatever the curvature.
const FINEST: f64 = 1.0 / 32.0;
/// Edges shorter than this part of what is asked for are not split because normals differ: at a crease they always do.
const CREASE: f64 = 0.5;
/// Sizes grow by no more than this part of the distance.
const GRADATION: f64 = 0.3;
/// Edges are split that are longer than this, in sizes,
const LONG: f64 = 4.0 / 3.0;
/// and collapsed that are shorter than this.
const SHORT: f64 = 0.8;
/// Until the end vertices are so near to the surface, in the edge length asked for: shapes and normals are what they will
/// be, with fewer steps.
const LOOSE: f64 = 1e-5;
/// Splitting, collapsing, flipping and smoothing are repeated so often.
const ROUNDS: usize = 4;
/// Passes over all edges within a round, at most.
const PASSES: usize = 8;
/// Flips of the edge in one slot, in one pass.
const FLIPS_PER_SLOT: u8 = 8;
/// A change may leave triangles so good, whatever was there before.
const GOOD: f64 = 0.6;
/// A collapse may leave triangles so good, for smoothing comes after it.
const FAIR: f64 = 0.35;
/// A split may leave triangles so good.
const SLIM: f64 = 0.1;
/// Triangles worse than this lose an edge, whatever their size.
const POOR: f64 = 0.3;
/// More vertices than this are refused.
const MOST_VERTICES: usize = 10_000_000;

/// The surface with triangles that are not folded, no needles, and as fine as its curvature asks for; vertices are on f = 0
/// but for `tolerance`, and those of the border in the sides of the box. Its topology stays.
///
/// That is so of smooth surfaces that are not thinner than their triangles were. Of others it is tried; where triangles
/// without area are all that comes of it, the surface is returned as it was.
///
/// # Errors
/// [`Error::Limit`] of more than 1e7 vertices.
pub(super) fn remesh(surface: &Surface, f: &dyn Implicit, bounds: Aabb3, edge: f64, tolerance: f64) -> Result<Surface> {
    let mut level = Level::new(surface, f, bounds, LOOSE * edge);
    for round in 0..ROUNDS {
        grade(&mut level, edge)?;
        split(&mut level, edge, round == 0)?;
        collapse(&mut level);
        flip(&mut level);
        smooth(&mut level);
        flip(&mut level);
    }
    level.settle(tolerance);
    level.to_surface().or_else(|_| Ok(surface.clone()))
}

/// Sizes by curvature, and then such that they grow slowly.
fn grade(level: &mut Level, edge: f64) -> Result<()> {
    let size = |vertex: &Vertex| (BEND / vertex.curvature).clamp(FINEST * edge, edge);
    let mut sizes: Vec<f64> = level.vertices.iter().map(size).collect();
    let t = &level.topology;
    let around = Neighbours::of_triangles(sizes.len(), t.faces().map(|f| t.corners(f).map(|v| v.0)), []);
    let position = |v: u32| level.vertices[v as usize].position;
    let length = |v, w| position(v).distance(position(w));
    Gradation::of_sizes(around, length, GRADATION.exponential())?.apply_to_sizes(&mut sizes)?;
    level.vertices.iter_mut().zip(sizes).for_each(|(vertex, size)| vertex.size = size);
    Ok(())
}

/// The length of the edge between two vertices, in their mean size.
fn ratio(a: &Vertex, b: &Vertex) -> f64 {
    a.position.distance(b.position) / f64::midpoint(a.size, b.size)
}

/// Whether the surface turns by more along an edge than `BEND` allows.
fn turns(a: &Vertex, b: &Vertex) -> bool {
    a.normal.dot(b.normal) < (LONG * BEND).cosine()
}

/// Splits edges that are too long, or along which the surface turns too much, the longest first. With `freely` that may
/// make triangles worse for the moment: where a thin rim appears, it takes several vertices until they fit.
fn split(level: &mut Level, edge: f64, freely: bool) -> Result<()> {
    let is_long = |level: &Level, h: HalfEdge| {
        let [a, b] = level.ends(h);
        ratio(a, b) > LONG || turns(a, b) && level.length(h) > CREASE * edge
    };
    for _ in 0..PASSES {
        let long = level.topology.edges().filter(|&h| is_long(level, h)).map(|h| (-level.length(h), h));
        let (edges, before) = (ranked(long), level.topology.vertex_count());
        for (_, h) in edges {
            if is_long(level, h) {
                split_edge(level, h, freely);
            }
        }
        let after = level.topology.vertex_count();
        if after > MOST_VERTICES {
            let what = format!("more than {MOST_VERTICES} vertices for the implicit surface, which bends sharply");
            return Err(Error::limit(what, "ask for longer edges, or choose a smaller box"));
        }
        if after == before {
            break;
        }
    }
    Ok(())
}

fn split_edge(level: &mut Level, h: HalfEdge, freely: bool) {
    let Some(vertex) = level.middle(h).or_else(|| level.middle_beside(h)) else { return };
    let t = &level.topology;
    let ends = [t.origin(h), t.target(h)];
    let sides = || [Some(h), t.twin(h)].into_iter().flatten();
    let before = worst(sides().map(|side| level.quality(side, |_| None)));
    let halves = sides().flat_map(|side| ends.map(|end| (side, end)));
    let after = worst(halves.map(|(side, end)| level.quality(side, |v| (v == end).then_some(&vertex))));
    if freely || after >= before.min(SLIM) {
        let v = level.topology.add_vertex();
        level.topology.split_edge(h, v);
        level.vertices.resize(level.topology.vertex_slots(), vertex);
        level.vertices[v.index()] = vertex;
    }
}

/// Collapses edges that are too short, and the shortest edge of poor triangles.
fn collapse(level: &mut Level) {
    let is_short = |level: &Level, h: HalfEdge| {
        let length = level.length(h);
        let poor = |side: HalfEdge| {
            level.quality(side, |_| None) < POOR
                && [side.next(), side.prev()].into_iter().all(|other| level.length(other) >= length)
        };
        let [a, b] = level.ends(h);
        ratio(a, b) < SHORT || poor(h) || level.topology.twin(h).is_some_and(poor)
    };
    let short = level.topology.edges().filter(|&h| is_short(level, h)).map(|h| (level.length(h), h));
    for (_, h) in ranked(short) {
        if level.topology.is_face(h.face()) && is_short(level, h) {
            collapse_edge(level, h);
        }
    }
}

/// Collapses an edge unless that makes triangles worse or edges too long.
fn collapse_edge(level: &mut Level, h: HalfEdge) {
    let t = &level.topology;
    if !t.can_collapse(h) {
        return;
    }
    let Some(merged) = merged(level, h) else { return };
    let (a, b) = (t.origin(h), t.target(h));
    let fan: Vec<HalfEdge> = t.star(a).chain(t.star(b)).collect();
    let lost = [Some(h), t.twin(h)].map(|side| side.map(HalfEdge::face));
    let before = worst(fan.iter().map(|&e| level.quality(e, |_| None)));
    let kept = fan.into_iter().filter(|e| !lost.contains(&Some(e.face())));
    let moved = |v: VertexId| (v == a || v == b).then_some(&merged);
    let fits = |e: HalfEdge| {
        [t.target(e), t.apex(e)].iter().all(|v| {
            let other = &level.vertices[v.index()];
            ratio(&merged, other) <= LONG && !turns(&merged, other)
        })
    };
    let good_enough = before.min(FAIR);
    if kept.into_iter().all(|e| level.quality(e, moved) >= good_enough && (before < POOR || fits(e))) {
        level.topology.collapse(h);
        level.vertices[b.index()] = merged;
    }
}

fn worst(qualities: impl Iterator<Item = f64>) -> f64 {
    qualities.fold(f64::INFINITY, f64::min)
}

/// What becomes of an edge's ends when it collapses: its middle, or the end that may not move from the border or from an
/// edge of the box; `None` where neither may.
fn merged(level: &Level, h: HalfEdge) -> Option<Vertex> {
    let [a, b] = level.ends(h);
    let t = &level.topology;
    let [a_border, b_border] = [t.origin(h), t.target(h)].map(|v| t.is_border_vertex(v));
    let holds = |a: &Vertex, b: &Vertex| (0..3).all(|i| a.pins[i] || !b.pins[i]);
    match (a_border, b_border) {
        (true, false) => Some(*a),
        (false, true) => Some(*b),
        _ if a.pins == b.pins => level.middle(h),
        _ if holds(a, b) => Some(*a),
        _ => holds(b, a).then_some(*b),
    }
}

/// Flips edges where that makes the worse of their two triangles better.
fn flip(level: &mut Level) {
    let mut lawson = Lawson::default();
    lawson.queue(level.topology.edges());
    lawson.pass(level, Limit::OfSlot(FLIPS_PER_SLOT));
}

impl Flipping for Level<'_> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        /// Differences less than this are rounding.
        const GAIN: f64 = 1e-9;
        let Some([a, b, c, d]) = self.topology.quad(h) else { return false };
        let at = |v: VertexId| &self.vertices[v.index()];
        let before = worst([[a, b, c], [b, a, d]].into_iter().map(|face| quality(face.map(at))));
        let after = worst([[d, c, a], [c, d, b]].into_iter().map(|face| quality(face.map(at))));
        after > before + GAIN && self.topology.can_flip(h)
    }
}

/// Moves vertices towards the middle of their neighbours, on the surface, unless that makes triangles worse.
fn smooth(level: &mut Level) {
    let vertices: Vec<VertexId> = level.topology.vertices().collect();
    let moved: Vec<_> = vertices.par_iter().map(|&v| evened(level, v)).collect();
    for (v, moved) in vertices.into_iter().zip(moved) {
        let Some(vertex) = moved else { continue };
        let star = || level.topology.star(v);
        let before = worst(star().map(|h| level.quality(h, |_| None))).min(GOOD);
        if star().all(|h| level.quality(h, |w| (w == v).then_some(&vertex)) >= before) {
            level.vertices[v.index()] = vertex;
        }
    }
}

/// Where a vertex would be in the middle of its neighbours; on the border, of its neighbours along that.
fn evened(level: &Level, v: VertexId) -> Option<Vertex> {
    let (t, vertex) = (&level.topology, &level.vertices[v.index()]);
    let mut around: Vec<VertexId> = t.star(v).map(|h| t.target(h)).collect();
    if t.is_border_vertex(v) {
        let last = t.star(v).last().map(|h| t.apex(h))?;
        around = vec![around[0], last];
        let along = |w: &VertexId| (0..3).all(|i| level.vertices[w.index()].pins[i] || !vertex.pins[i]);
        if vertex.pins.iter().filter(|&&pin| pin).count() != 1 || !around.iter().all(along) {
            return None;
        }
    }
    let offsets = around.iter().map(|w| level.vertices[w.index()].position - vertex.position);
    let sum = offsets.fold(Vector3::default(), |sum, offset| sum + offset);
    let step = sum * (1.0 / around.len() as f64);
    let across = unpinned(vertex.normal, vertex.pins).unit()?;
    let tangent = step - across * step.dot(across);
    let target: Point3 = vertex.position + tangent;
    let landed = level.land(target, vertex.pins, tangent.norm().max(f64::MIN_POSITIVE))?;
    Some(Vertex { size: vertex.size, ..landed })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::{curvatures, mesh_implicit};
    use crate::metric::{Expression, Variables};
    use crate::test_cases::cases;
    use proptest::prelude::*;

    /// A surface of known topology: f in the turned coordinates u, v, w (in units of `scale`).
    #[derive(Clone, Debug)]
    struct Case {
        equation: String,
        euler: isize,
        borders: usize,
    }

    fn closed(equation: String, euler: isize) -> Case {
        Case { equation, euler, borders: 0 }
    }

    fn surfaces() -> impl Strategy<Value = Case> {
        let size = || 0.25..1.0_f64;
        let ball = |x: f64| format!("exp(-4*((u-{x})^2+v^2+w^2))");
        prop_oneof![
            (size(), size(), size()).prop_map(|(a, b, c)| closed(format!("(u/{a})^2+(v/{b})^2+(w/{c})^2-1"), 2)),
            // Nothing is promised of what is thinner than the diagonals of the grid's cubes, here 3^(1/2) 3 / 20 / 0.9 at most: an
            // edge from one side of a tube to the other is where slivers come from.
            (0.145..0.4_f64).prop_map(|r| closed(format!("(sqrt(u^2+v^2)-0.7)^2+w^2-{r}^2"), 0)),
            (0.05..0.4_f64).prop_map(move |x| closed(format!("0.6-{}-{}", ball(x), ball(-x)), 2)),
            (0.75..0.8_f64).prop_map(move |x| closed(format!("0.6-{}-{}", ball(x), ball(-x)), 4)),
            (2.0..6.0_f64).prop_map(|p| closed(format!("sqrt(u^2+0.01)^{p}+sqrt(v^2+0.01)^{p}+w^2-0.8"), 2)),
            (0.2..0.5_f64, 0.0..0.5_f64).prop_map(|(r, k)| Case {
                equation: format!("u^2+v^2-{k}*w^2-{r}^2"),
                euler: 0,
                borders: 2
            }),
            (0.0..0.2_f64, 0.5..4.0_f64).prop_map(|(a, k)| Case {
                equation: format!("w-{a}*sin({k}*u+v)"),
                euler: 1,
                borders: 1
            }),
        ]
    }

    /// The equation with u, v, w turned by two angles, and scaled.
    fn turned(equation: &str, [a, b]: [f64; 2], scale: f64) -> Expression {
        let (c, s) = (a.cos() / scale, a.sin() / scale);
        let u = format!("({c:e}*x+{s:e}*y)");
        let v = format!("({:e}*({:e}*x+{c:e}*y)+{:e}*z)", b.cos(), -s, b.sin() / scale);
        let w = format!("({:e}*({s:e}*x+{:e}*y)+{:e}*z)", b.sin(), -c, b.cos() / scale);
        let text = equation.replace('u', &u).replace('v', &v).replace('w', &w);
        Expression::parse(&text, Variables::Space).unwrap()
    }

    /// The largest angles in degrees between a triangle and the surface at its corners, and between neighbours.
    fn folds(surface: &Surface, f: &dyn Implicit) -> [f64; 2] {
        let t = surface.topology();
        let angle = |a: Vector3, b: Vector3| a.dot(b).clamp(-1.0, 1.0).acos().to_degrees();
        let corners = t.faces().flat_map(|face| surface.triangle(face).map(|p| (surface.normal(face), p)));
        let fold = corners.map(|(normal, p)| angle(normal, f.jet(p).gradient.unit().unwrap())).fold(0.0, f64::max);
        let pairs = t.edges().filter_map(|h| Some([h, t.twin(h)?].map(|side| surface.normal(side.face()))));
        [fold, pairs.map(|[a, b]| angle(a, b)).fold(0.0, f64::max)]
    }

    /// The smallest angle in degrees, and the part of angles below 10 degrees.
    fn angles(surface: &Surface) -> [f64; 2] {
        let corners = surface.topology().faces().flat_map(crate::triangulation::FaceId::half_edges);
        let angles: Vec<f64> = corners.map(|h| surface.angle(h).to_degrees()).collect();
        let narrow = angles.iter().filter(|angle| **angle < 10.0).count();
        [angles.iter().copied().fold(f64::INFINITY, f64::min), narrow as f64 / angles.len() as f64]
    }

    fn cube(half: f64) -> Aabb3 {
        Aabb3 { min: Point3::new(-half, -half, -half), max: Point3::new(half, half, half) }
    }

    /// Lengths of edges are between parts of what the curvature asks for, there and where it is largest. (Edges from one edge
    /// of the box to another may be shorter: there the surface cuts a corner off, which may be small.)
    fn check_lengths(surface: &Surface, f: &dyn Implicit, bounds: Aabb3, edge: f64) {
        let t = surface.topology();
        let asked = |p: Point3| (BEND / curvatures(&f.jet(p)).unwrap().values[0].abs()).clamp(FINEST * edge, edge);
        let finest = surface.positions().iter().map(|&p| asked(p)).fold(edge, f64::min);
        let sides = bounds.min.to_array().into_iter().zip(bounds.max.to_array());
        let on_edge = |p: Point3| {
            p.to_array().into_iter().zip(sides.clone()).filter(|(x, (a, b))| (x - a) * (x - b) >= 0.0).count() >= 2
        };
        for h in t.edges() {
            let [p, q] = [t.origin(h), t.target(h)].map(|v| surface.position(v));
            let length = p.distance(q);
            assert!(
                on_edge(p) && on_edge(q) || length > 0.3 * finest,
                "{length} where {finest} was the finest, {p} - {q}"
            );
            assert!(length < 2.0 * asked(p).max(asked(q)), "{length} where {} was asked for, {p} - {q}", asked(p));
        }
    }

    proptest! {
        #![proptest_config(cases(48))]
        #[test]
        fn smooth_surfaces_come_out_well(
            case in surfaces(), angles_of in [0.0..0.4_f64, 0.0..0.4_f64], exponent in -3..=3_i32, steps in 20.0..32.0_f64,
        ) {
            let scale = 10.0_f64.powi(exponent);
            // A closed surface may be turned at will; one that leaves the box leaves it by the same sides.
            let turn = if case.borders == 0 { angles_of.map(|angle| 8.0 * angle) } else { angles_of };
            let f = turned(&case.equation, turn, scale);
            let (bounds, edge) = (cube(1.5 * scale), 3.0 * scale / steps);
            let surface = mesh_implicit(&f, bounds, Some(edge)).unwrap();
            let [fold, bend] = folds(&surface, &f);
            prop_assert!(fold < 60.0 && bend < 90.0, "{} {}", fold, bend);
            let [least, narrow] = angles(&surface);
            prop_assert!(least > 2.0 && narrow < 0.01, "{} {}", least, narrow);
            check_lengths(&surface, &f, bounds, edge);
            prop_assert_eq!((surface.euler_characteristic(), surface.border_loops().len()), (case.euler, case.borders));
            for &p in surface.positions() {
                let jet = f.jet(p);
                prop_assert!(jet.value.abs() <= 2e-12 * bounds.diagonal() * jet.gradient.norm());
            }
            let on_side = |p: Point3| p.to_array().iter().any(|x| (x.abs() / scale - 1.5).abs() < 1e-12);
            let t = surface.topology();
            prop_assert!(t.vertices().all(|v| !t.is_border_vertex(v) || on_side(surface.position(v))));
        }
    }

    /// The last of 19 steps of 0.3 / 19 from -0.15 was beyond 0.15 but for rounding: nothing on that side could move.
    #[test]
    fn rounded_grids_do_not_leave_the_box() {
        let equation = "u^2+v^2-0.4949703542370771*w^2-0.2913594517463995^2";
        let scale = 10.0_f64.powi(-1);
        let f = turned(equation, [0.0, 0.157_078_889_634_424_12], scale);
        let (bounds, edge) = (cube(1.5 * scale), 3.0 * scale / 20.617_434_139_085_58);
        check_lengths(&mesh_implicit(&f, bounds, Some(edge)).unwrap(), &f, bounds, edge);
    }

    /// The surface grazes an edge of the box between two of its points, whose middle is on no point of that edge.
    #[test]
    fn an_edge_of_the_box_may_be_grazed() {
        let f = turned("u^2+v^2-0.32212513616518923*w^2-0.33935675597575576^2", [0.365_670_932, 0.265_015_84], 1.0);
        let (bounds, edge) = (cube(1.5), 3.0 / 21.671_119_210_812_048);
        check_lengths(&mesh_implicit(&f, bounds, Some(edge)).unwrap(), &f, bounds, edge);
    }

    /// An edge of its border is short: the surface passes near to the corner (-1.5, 1.5, -1.5).
    #[test]
    fn a_corner_of_the_box_may_be_cut_off() {
        let f = turned("u^2+v^2-0.44962*w^2-0.37428^2", [0.37009, 0.39656], 1.0);
        let (bounds, edge) = (cube(1.5), 3.0 / 25.42836);
        let surface = mesh_implicit(&f, bounds, Some(edge)).unwrap();
        check_lengths(&surface, &f, bounds, edge);
        let corner = Point3::new(-1.5, 1.5, -1.5);
        assert!(surface.positions().iter().filter(|p| p.distance(corner) < 0.15 * edge).count() == 2);
    }

    #[test]
    fn the_chair_has_no_folds() {
        let surface = crate::manifold::surface::chair(None).unwrap();
        let f = Expression::parse(crate::manifold::surface::shapes::CHAIR, Variables::Space).unwrap();
        let ([fold, bend], [least, _]) = (folds(&surface, &f), angles(&surface));
        assert!(fold < 30.0 && bend < 45.0 && least > 15.0, "{fold} {bend} {least}");
        assert!(surface.topology().vertex_count() < 20_000);
        check_lengths(&surface, &f, cube(6.0), 0.9 * 12.0 / 64.0);
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let mesh = |threads: usize| {
            crate::test_cases::on_threads(threads, || crate::manifold::surface::chair(Some(0.4)).unwrap().to_mesh())
        };
        assert_eq!(mesh(1), mesh(3));
    }

    /// Creases, cusps, a cone, sheets that nearly cross or are not resolved: a surface all the same. (Sheets that cross in a line are
    /// refused: `sheets`.)
    #[test]
    fn what_is_not_smooth_is_a_surface_all_the_same() {
        for equation in [
            "max(max(abs(x),abs(y)),abs(z))-0.5",
            "abs(x+y)+abs(z)-0.5",
            "x*y-0.00001",
            "x*y*z-0.00001",
            "x^3-y^2",
            "x^2*y-z^2-0.00001",
            "x^2+y^2-z^2",
            "z-0.5*sin(1/(x^2+0.02))",
            "x-1",
        ] {
            let f = Expression::parse(equation, Variables::Space).unwrap();
            let bounds = Aabb3 { max: Point3::new(1.0, 1.1, 1.2), ..cube(1.0) };
            let surface = mesh_implicit(&f, bounds, Some(0.08)).unwrap_or_else(|error| panic!("{equation}: {error}"));
            surface.topology().check().unwrap();
            let box_holds = |p: &Point3| p.to_array().iter().all(|x| x.abs() <= 1.2 + 1e-12);
            assert!(surface.positions().iter().all(box_holds), "{equation}");
        }
    }
}

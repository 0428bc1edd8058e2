//! Errors against closed forms on canvases of 1,000, 4,000 and 16,000 vertices.

use super::cases::{Case, half_plane, turning};
use crate::canvas::Canvas;
use crate::diagram::Distances;
use crate::geodesic::{Dijkstra, Geodesic, Graph, Konukoglu, Method, Sources, Stvd};
use crate::geometry::{Point, Tensor, Vector};
use crate::triangulation::VertexId;

/// The same metric everywhere.
fn uniform() -> Case {
    let tensor = Tensor::from_axis(Vector::new(0.8, 0.6), 100.0, 1.0);
    let from = Point::new(0.1, -0.2);
    let exact = move |p: Point| Some(tensor.length(p - from));
    let domain = "rect:-1,-1,1,1".to_string();
    Case { name: "uniform, turned", domain, metric: Box::new(move |_| tensor), from, exact: Box::new(exact) }
}

/// Measured in a box only: well away from the border, which some methods do not come near.
fn within(case: Case, low: Point, high: Point) -> Case {
    let exact = case.exact;
    let is_inside = move |p: Point| p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y;
    Case { exact: Box::new(move |p| exact(p).filter(|_| is_inside(p))), ..case }
}

/// Greatest and mean relative error of the vertices that are reached: all, but for a few by [`Method::Lbr`] where stencils
/// leave the domain.
fn errors(case: &Case, canvas: &Canvas, method: Method) -> [f64; 2] {
    let found = Distances::new(canvas, &case.metric, &[case.from], method).unwrap();
    let reached = found.values().iter().filter(|d| d.is_finite()).count();
    let least = if method == Method::Lbr { 0.9 } else { 1.0 };
    assert!(reached as f64 >= least * found.values().len() as f64, "{method}: {reached} reached");
    case.errors(canvas, &found)
}

/// The least order of convergence to be seen, and the greatest mean error on the finest canvas.
fn expected(method: Method) -> (f64, f64) {
    match method {
        Method::March => (0.9, 1e-3),
        Method::Konukoglu => (0.25, 0.06),
        // Errors by chords that the metric turns along fall, until that of the window is left: see the test on grids.
        Method::Stvd { .. } => (0.5, 0.02),
        // Edges have a few directions.
        Method::Dijkstra => (-0.5, 0.06),
        // First order, from afar: stencils are ten nodes wide, and the metric turns within them.
        Method::Lbr => (0.6, 0.18),
        Method::Heat => (1.0, 0.006),
    }
}

#[test]
fn methods_converge_as_theory_says() {
    let mut faults = Vec::new();
    let wave = within(turning(10.0, 0.25), Point::new(-0.7, -0.45), Point::new(0.7, 0.45));
    let half_plane = within(half_plane(10.0), Point::new(-12.0, 0.7), Point::new(12.0, 2.2));
    for case in [uniform(), wave, half_plane] {
        let canvases =
            [1000, 4000, 16_000].map(|n| Canvas::intrinsic(case.domain().planar(), &case.metric, n).unwrap());
        for method in Method::ALL {
            let found = canvases.each_ref().map(|canvas| errors(&case, canvas, method));
            let order = (found[0][1] / found[2][1]).log2() / 2.0;
            println!("{}, {method}: {found:.5?}, order {order:.2}", case.name);
            let (least, most) = expected(method);
            let is_exact = found[2][1] < 1e-12;
            let has_none = method == Method::Dijkstra && order > 0.2;
            if !is_exact && (order < least || found[2][1] > most || has_none) {
                faults.push(format!("{}, {method}: {found:?}", case.name));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// What is asked of the default method, and of heat, on the metrics of the benchmark `methods`.
#[test]
fn marching_and_heat_are_accurate_at_any_anisotropy() {
    let mut faults = Vec::new();
    for case in [2.0, 40.0].into_iter().flat_map(|anisotropy| [turning(anisotropy, 0.5), half_plane(anisotropy)]) {
        let canvases = [5000, 20_000].map(|n| Canvas::intrinsic(case.domain().planar(), &case.metric, n).unwrap());
        let [march, heat] =
            [Method::March, Method::Heat].map(|method| canvases.each_ref().map(|canvas| errors(&case, canvas, method)));
        println!("{}: march {march:.5?}, heat {heat:.5?}", case.name);
        if march.iter().any(|errors| errors[0] > 0.01) || march[1][1] > march[0][1] || heat[0][1] > 0.05 {
            faults.push(format!("{}: march {march:?}, heat {heat:?}", case.name));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Three times as long in one direction as across it, the same everywhere.
const TURNED: Tensor = Tensor::new(1.0, 0.9, 1.9);

/// The square from -1 to 1 as a grid of n x n vertices with one diagonal in each of its cells.
fn grid(n: u32) -> Graph {
    let at = |i: u32| -1.0 + 2.0 * f64::from(i) / f64::from(n - 1);
    let positions: Vec<Point> = (0..n * n).map(|v| Point::new(at(v % n), at(v / n))).collect();
    let tensors = vec![TURNED; positions.len()];
    let around = |v: u32| {
        let (right, up) = (v % n + 1 < n, v / n + 1 < n);
        [(right, v + 1), (up, v + n), (right && up, v + n + 1)]
            .into_iter()
            .filter(|o| o.0)
            .map(move |o| [v, o.1].map(VertexId))
    };
    Graph::new(positions, tensors, (0..n * n).flat_map(around))
}

/// A window has no more edges than a way, however many it may have.
#[test]
fn a_window_may_be_larger_than_memory() {
    let graph = grid(5);
    let mut sources = Sources::new(graph.vertex_count());
    sources.add(VertexId(0), 0.0, 0);
    let [all, most] = [usize::MAX, 25].map(|window| Stvd::on(graph.clone(), window).propagate(&sources));
    assert!(graph.vertices().all(|v| all.label(v).distance.total_cmp(&most.label(v).distance).is_eq()));
}

#[test]
fn a_fixed_window_does_not_converge() {
    let mut found = [[0.0; 3]; 3];
    for (k, n) in [61, 121, 241].into_iter().enumerate() {
        let graph = grid(n);
        let middle = VertexId(n * n / 2);
        let mut sources = Sources::new(graph.vertex_count());
        // Exact around the source, as diagrams have it, at the same distance on all grids.
        let exact = |v: VertexId| TURNED.length(graph.sight().line(middle, middle, v));
        graph.vertices().filter(|&v| exact(v) < 0.15).for_each(|v| sources.add(v, exact(v), 0));
        let inside = |v: &VertexId| {
            let p = graph.sight().line(middle, middle, *v);
            p.x.abs() < 0.9 && p.y.abs() < 0.9 && exact(*v) > 0.3
        };
        let solvers: [Box<dyn Geodesic>; 3] = [
            Box::new(Stvd::on(graph.clone(), 8)),
            Box::new(Konukoglu(graph.clone())),
            Box::new(Dijkstra(graph.clone())),
        ];
        for (solver, found) in solvers.iter().zip(&mut found) {
            let labels = solver.propagate(&sources);
            let errors = graph.vertices().filter(inside).map(|v| (labels.label(v).distance / exact(v) - 1.0).abs());
            let (sum, count) = errors.fold((0.0, 0), |(sum, count), error| (sum + error, count + 1));
            found[k] = sum / f64::from(count);
        }
    }
    println!("mean errors of stvd, konukoglu, dijkstra: {found:.5?}");
    let order = found.map(|errors| (errors[0] / errors[2]).log2() / 2.0);
    assert!(order[0] < 0.1 && order[1] > 0.9 && order[2] < 0.1, "{order:?}");
    assert!(found[0][2] < 0.03 && found[1][2] < 0.01 && found[2][2] < 0.3, "{found:?}");
}

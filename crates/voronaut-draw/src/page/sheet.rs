//! A mesh and what is known of it, packed for a page.

use super::bytes::{Planes, Store};
use super::order::{Guess, Order};
use crate::curves::Curves;
use serde_json::{Value, json};
use voronaut::geometry::Point3;
use voronaut::mesh::{Edges, Mesh};
use voronaut::quality::{Cause, Unmet};
use voronaut::{Error, Result};

/// Bits of a coordinate along the longest side of a mesh.
const BITS: u32 = 26;
/// Vertices and triangles of larger meshes are numbered anew: their own numbers would take more room than the mesh.
const MOST_NUMBERED: usize = 250_000;

/// A mesh, and what a page shows of it.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// What it is called.
    pub name: String,
    /// The mesh.
    pub mesh: Mesh,
    /// Named values at its vertices.
    pub vertices: Vec<(String, Vec<f64>)>,
    /// Named values on its triangles.
    pub triangles: Vec<(String, Vec<f64>)>,
    /// What it is in a metric. Without it the page shows Euclidean figures.
    pub unmet: Option<Unmet>,
    /// The metric at the vertices: m11 m12 m22 m13 m23 m33; empty if there is none.
    pub tensors: Vec<[f64; 6]>,
    /// A canvas with the numbers of cells, from 0, as labels of its vertices (-1 for none), and the distances there.
    pub canvas: Option<(Mesh, Vec<f64>)>,
    /// Curves on the mesh, such as geodesic edges; those of a curved mesh are drawn without.
    pub curves: Vec<Vec<Point3>>,
}

/// Where the coordinates of a mesh begin, and how long their steps are.
struct Steps {
    low: [f64; 3],
    size: f64,
    /// How many coordinates there are.
    axes: usize,
}

impl Sheet {
    /// How many triangles there are to show.
    pub(super) fn count(&self) -> usize {
        self.mesh.triangles.len() + self.canvas.as_ref().map_or(0, |(canvas, _)| canvas.triangles.len())
    }

    /// Adds all to a page's numbers; describes where they are.
    pub(super) fn packed(&self, store: &mut Store) -> Result<Value> {
        self.mesh.check_numbers()?;
        let (order, steps, mut told) = geometry(&self.mesh, store)?;
        told["name"] = json!(self.name);
        if self.mesh.triangles.len() <= MOST_NUMBERED {
            told["vertex_numbers"] = integers(store, order.vertices.iter().map(|v| v.cast_signed()));
            told["triangle_numbers"] = integers(store, order.triangles.iter().map(|t| t.cast_signed()));
        }
        told["point_labels"] = labels(store, &self.mesh.point_labels, &order.vertices);
        told["triangle_labels"] = labels(store, &self.mesh.triangle_labels, &order.triangles);
        told["edges"] = self.listed_edges(store, &order);
        told["fields"] = self.fields(store, &order);
        let tensor = |k: usize| order.vertices.iter().map(move |&v| self.tensors[v as usize][k]);
        let entries = if self.mesh.is_planar() { 3 } else { 6 };
        let known = if self.tensors.len() == self.mesh.points.len() { entries } else { 0 };
        told["tensors"] = (0..known).map(|k| store.planes(&Planes::of_reals(tensor(k)))).collect();
        if let Some((canvas, distances)) = &self.canvas {
            let (order, _, mut told_canvas) = geometry(canvas, store)?;
            told_canvas["cells"] = integers(store, order.vertices.iter().map(|&v| canvas.point_labels[v as usize]));
            let distances = order.vertices.iter().map(|&v| distances[v as usize]);
            told_canvas["distances"] = store.planes(&Planes::of_reals(distances));
            told["canvas"] = told_canvas;
        }
        let edges = Curves::of(&self.mesh).polylines(&self.mesh);
        told["curves"] = steps.curves(store, &[self.curves.as_slice(), &edges].concat());
        Ok(told)
    }

    /// The labelled edges, by new numbers.
    fn listed_edges(&self, store: &mut Store, order: &Order) -> Value {
        let new = |ends: &[u32; 2]| ends.map(|v| order.numbers[v as usize].cast_signed());
        let listed = self.mesh.edges.iter().enumerate();
        let label = |i: usize| self.mesh.edge_labels.get(i).copied().unwrap_or(0);
        let mut all: Vec<([i32; 2], i32)> = listed.map(|(i, ends)| (new(ends), label(i))).collect();
        all.sort_unstable();
        json!({
            "from": integers(store, all.iter().map(|(ends, _)| ends[0])),
            "over": integers(store, all.iter().map(|(ends, _)| ends[1] - ends[0])),
            "labels": integers(store, all.iter().map(|(_, label)| *label)),
        })
    }

    /// All values: those that are given, and what the mesh is in its metric.
    fn fields(&self, store: &mut Store, order: &Order) -> Value {
        let mut all = Vec::new();
        let mut add = |name: &str, on: &str, values: Planes| {
            let mut told = store.planes(&values);
            told["name"] = json!(name);
            told["on"] = json!(on);
            all.push(told);
        };
        for (places, fields, on) in
            [(&order.vertices, &self.vertices, "vertex"), (&order.triangles, &self.triangles, "triangle")]
        {
            for (name, values) in fields.iter().filter(|(_, values)| values.len() == places.len()) {
                add(name, on, Planes::of_reals(places.iter().map(|&i| values[i as usize])));
            }
        }
        if let Some(unmet) = &self.unmet {
            let (lengths, causes) = self.of_edges(unmet, order);
            add("length", "edge", Planes::of_reals(lengths));
            add("cause", "cause", Planes::of_integers(causes));
        }
        all.into()
    }

    /// Lengths of all edges, and why they are not of unit length (0 where they are), in the order in which the page finds the edges.
    fn of_edges(&self, unmet: &Unmet, order: &Order) -> (Vec<f64>, Vec<i32>) {
        let edges = Edges::of(&order.corners);
        let mut found: Vec<(u32, [u32; 2])> = edges.iter().map(|sides| (sides[0].half_edge, sides[0].ends)).collect();
        found.sort_unstable();
        let old: Vec<[u32; 2]> = Edges::of(&self.mesh.triangles).ends().collect();
        let by_ends: Vec<[u32; 2]> = unmet.edges.iter().map(|edge| edge.edge).collect();
        let figures = |&(_, ends): &(u32, [u32; 2])| {
            let [a, b] = ends.map(|v| order.vertices[v as usize]);
            let ends = [a.min(b), a.max(b)];
            let length = old.binary_search(&ends).map_or(f64::NAN, |i| unmet.lengths[i]);
            let cause = by_ends.binary_search(&ends).map(|i| unmet.edges[i].cause);
            let number = |cause: Cause| (1..).zip(Cause::ALL).find(|&(_, other)| other == cause).map_or(0, |(i, _)| i);
            (length, cause.map_or(0, number))
        };
        found.iter().map(figures).unzip()
    }
}

/// The triangles and positions of a mesh.
fn geometry(mesh: &Mesh, store: &mut Store) -> Result<(Order, Steps, Value)> {
    if mesh.triangles.is_empty() {
        return Err(Error::unsupported("a page of a mesh that has no triangles", "give it a mesh of triangles"));
    }
    let steps = Steps::of(mesh)?;
    let order = Order::of(mesh);
    let start = store.len();
    let told_steps = store.bytes(&order.steps);
    let named = store.planes(&order.named);
    let axes: Vec<Value> = (0..steps.axes).map(|axis| steps.coordinates(mesh, &order, axis, store)).collect();
    let told = json!({
        "planar": steps.axes == 2, "vertices": mesh.points.len(), "triangles": mesh.triangles.len(),
        "low": steps.low, "step": steps.size, "bits": BITS,
        "steps": told_steps, "named": named, "axes": axes, "geometry_bytes": store.len() - start,
    });
    Ok((order, steps, told))
}

fn integers(store: &mut Store, all: impl Iterator<Item = i32>) -> Value {
    store.planes(&Planes::of_integers(all))
}

/// Labels, unless there are none or all are 0.
fn labels(store: &mut Store, labels: &[i32], places: &[u32]) -> Value {
    if labels.len() != places.len() || labels.iter().all(|&label| label == 0) {
        return Value::Null;
    }
    integers(store, places.iter().map(|&i| labels[i as usize]))
}

impl Steps {
    fn of(mesh: &Mesh) -> Result<Self> {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for p in &mesh.points {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(p[axis]);
                bounds[1][axis] = bounds[1][axis].max(p[axis]);
            }
        }
        let [low, high] = bounds;
        let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        if !longest.is_finite() || !mesh.points.as_flattened().iter().all(|x| x.is_finite()) {
            let what = "a page of a mesh with coordinates that are not finite, or too far apart";
            return Err(Error::unsupported(what, "correct the coordinates"));
        }
        let size = longest / f64::from((1_u32 << BITS) - 1);
        Ok(Self { low, size: if size > 0.0 { size } else { 1.0 }, axes: if mesh.is_planar() { 2 } else { 3 } })
    }

    /// Where a coordinate is, in steps.
    fn place(&self, x: f64, axis: usize) -> i32 {
        ((x - self.low[axis]) / self.size).round() as i32
    }

    /// How far the vertices are from where they are foretold to be.
    fn coordinates(&self, mesh: &Mesh, order: &Order, axis: usize, store: &mut Store) -> Value {
        let at = |v: u32| self.place(mesh.points[v as usize][axis], axis);
        let mut planes = Planes::default();
        let mut last = 0;
        for (&v, &guess) in order.vertices.iter().zip(&order.guesses) {
            let guess = match guess {
                Guess::Last => last,
                Guess::Across([a, b, behind]) => at(a) + at(b) - at(behind),
            };
            last = at(v);
            planes.push_signed(last - guess);
        }
        store.planes(&planes)
    }

    /// Curves in the steps of the mesh.
    fn curves(&self, store: &mut Store, curves: &[Vec<Point3>]) -> Value {
        let counts = integers(store, curves.iter().map(|curve| (curve.len() as u32).cast_signed()));
        let points = || curves.iter().flatten().map(|p| p.to_array());
        let axes: Vec<Value> =
            (0..self.axes).map(|axis| integers(store, points().map(|p| self.place(p[axis], axis)))).collect();
        json!({ "counts": counts, "axes": axes })
    }
}

//! What is said of the steps of a loop.

use super::LoopArgs;
use crate::summary;
use serde_json::{Value, json};
use std::time::Instant;
use voronaut::mesh::Mesh;
use voronaut::recipe::Step;
use voronaut::transfer::{Carried, Extent, Kind};

/// Says each step in a line of stdout, unless told to be quiet, and keeps all figures for the report.
pub(super) struct Told<'a> {
    args: &'a LoopArgs,
    steps: Vec<Value>,
    start: Instant,
    last: Instant,
}

impl<'a> Told<'a> {
    pub(super) fn new(args: &'a LoopArgs, start: Instant) -> Self {
        Self { args, steps: Vec::new(), start, last: start }
    }

    pub(super) fn add(&mut self, step: &Step) {
        let seconds = self.last.elapsed().as_secs_f64();
        self.last = Instant::now();
        let mesh = &step.meshed.mesh;
        let area = area(mesh);
        let drift = step.transfer.as_ref().map(|(carried, _)| drift(carried, area));
        let error = step.meshed.polished.as_ref().and_then(|polished| polished.error.last().copied());
        if !self.args.run.quiet {
            let time = step.time.map_or(String::new(), |time| format!("t {time:.4}, "));
            let error = error.map_or(String::new(), |error| format!(", error {error:.3e}"));
            let drift = drift.map_or(String::new(), |drift| format!(", masses kept to {drift:.1e}"));
            let (count, border) = (mesh.points.len(), step.boundary_vertices);
            summary::out(&format!(
                "step {:>3}: {time}{count} vertices, {border} on the boundary{error}{drift}, {seconds:.2} s\n",
                step.number
            ));
            step.meshed.notes.iter().for_each(|note| eprintln!("note: step {}: {note}", step.number));
        }
        self.steps.push(json!({
            "step": step.number, "time": step.time, "vertices": mesh.points.len(), "triangles": mesh.triangles.len(),
            "boundary_vertices": step.boundary_vertices, "valid": true, "metric_scale": step.meshed.metric_scale,
            "polished_error": error, "mass_drift": drift,
            "fields": step.transfer.as_ref().map(|(carried, _)| carried.iter().map(field).collect::<Vec<Value>>()),
            "cover": step.transfer.as_ref().map(|(_, cover)| cover), "notes": step.meshed.notes, "seconds": seconds,
        }));
    }

    pub(super) fn report(&self) -> Value {
        let args = self.args;
        let options = args.options();
        let (metric, transfer) = (&options.metric, &options.transfer);
        json!({
            "steps": self.steps, "seconds": { "total": self.start.elapsed().as_secs_f64() },
            "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
            "options": {
                "domain": args.domain, "metric": args.metric, "solver": args.solver, "iterations": args.iterations,
                "out": args.out, "every": args.every, "time": args.time.0, "field": args.field,
                "norm": metric.norm.to_string(), "recovery": metric.recovery, "h_min": metric.bounds.h_min,
                "h_max": metric.bounds.h_max, "a_max": metric.bounds.a_max, "smooth_metric": metric.smooth_metric,
                "gradation": metric.gradation, "conservative": transfer.conservative, "overshoot": args.transfer.overshoot,
                "linear_tensors": transfer.linear_tensors, "mesh": options.mesh, "threads": args.run.threads,
            },
        })
    }
}

fn field(carried: &Carried) -> Value {
    json!({ "components": carried.field.components(), "before": carried.before, "after": carried.after })
}

fn area(mesh: &Mesh) -> f64 {
    let twice = |&triangle: &[u32; 3]| {
        let [a, b, c] = mesh.corners_of(triangle);
        (b - a).cross(c - a)
    };
    0.5 * mesh.triangles.iter().map(twice).sum::<f64>()
}

/// The greatest change of a mass, as a share of what the field would weigh with its greatest magnitude everywhere.
fn drift(carried: &[Carried], area: f64) -> f64 {
    let of = |(before, after): (&Extent, &Extent)| {
        let scale = before.max.abs().max(before.min.abs()) * area;
        if scale > 0.0 { (after.mass - before.mass).abs() / scale } else { 0.0 }
    };
    let densities = carried.iter().filter(|carried| carried.field.kind != Kind::Metric);
    densities.flat_map(|carried| carried.before.iter().zip(&carried.after)).map(of).fold(0.0, f64::max)
}

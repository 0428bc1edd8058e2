//! What is said of fields that were carried over.

use super::InterpolateArgs;
use crate::summary;
use serde_json::{Value, json};
use voronaut::mesh::Mesh;
use voronaut::transfer::{Carried, Cover, Extent, Kind, Place};
use voronaut_io::Seconds;

/// What there is to say.
pub(super) struct Told<'a> {
    pub(super) args: &'a InterpolateArgs,
    /// 2 or 3 of the file, which tells a vector from a tensor.
    pub(super) dimension: usize,
    pub(super) carried: &'a [Carried],
    pub(super) cover: &'a Cover,
}

impl Told<'_> {
    /// The report. Of metrics there is no `mass`: they are no densities.
    pub(super) fn report(&self, meshes: [&Mesh; 2], seconds: &Seconds) -> Value {
        let args = self.args;
        let [old, new] = meshes.map(|mesh| json!({ "vertices": mesh.points.len(), "triangles": mesh.triangles.len() }));
        json!({
            "old": old, "new": new, "method": self.method(), "cover": self.cover,
            "fields": self.carried.iter().map(|carried| self.field(carried)).collect::<Vec<Value>>(),
            "seconds": seconds, "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
            "options": {
                "old": args.old, "new": args.new, "field": args.field, "out": args.out, "conservative": args.conservative,
                "overshoot": args.overshoot, "linear_tensors": args.linear_tensors, "report": args.run.report,
                "threads": args.run.threads,
            },
        })
    }

    /// Says on stdout what became of every field, and on stderr what is odd, unless told to be quiet.
    pub(super) fn print(&self) {
        if self.args.run.quiet {
            return;
        }
        let mut lines = Vec::new();
        for (carried, number) in self.carried.iter().zip(1..) {
            let name = format!("{number}: {} at {}", self.kind(carried), place(carried));
            let names = std::iter::once(name).chain(std::iter::repeat(String::new()));
            let all = carried.before.iter().zip(&carried.after).map(|(before, after)| line(carried, before, after));
            lines.extend(names.zip(all));
        }
        summary::say(&format!("{} ({})", self.args.out.display(), self.method()), 24, lines);
        if self.cover.outside > 0 {
            let (count, farthest) = (self.cover.outside, self.cover.farthest);
            eprintln!(
                "note: {count} vertices are outside the old mesh, by up to {farthest:.3e}: they have the nearest value"
            );
        }
        let moved = self.cover.areas.map_or(0.0, |shares| shares.uncovered.max(shares.left));
        if moved > 0.0 {
            eprintln!("note: a share of {moved:.1e} of the area is in one mesh only; masses are kept all the same");
        }
    }

    fn method(&self) -> &'static str {
        match (self.args.conservative, self.args.overshoot) {
            (false, _) => "interpolation",
            (true, false) => "conservative",
            (true, true) => "conservative, overshooting",
        }
    }

    fn field(&self, carried: &Carried) -> Value {
        let extents = |all: &[Extent]| {
            let mut all = json!(all);
            for extent in all.as_array_mut().into_iter().flatten().filter_map(Value::as_object_mut) {
                if carried.field.kind == Kind::Metric {
                    extent.remove("mass");
                }
            }
            all
        };
        json!({
            "at": place(carried), "kind": self.kind(carried), "components": carried.field.components(),
            "before": extents(&carried.before), "after": extents(&carried.after),
        })
    }

    fn kind(&self, carried: &Carried) -> &'static str {
        match carried.field.kind {
            Kind::Metric => "metric",
            Kind::Linear(1) => "scalar",
            Kind::Linear(components) if components == self.dimension => "vector",
            Kind::Linear(_) => "tensor",
        }
    }
}

fn place(carried: &Carried) -> &'static str {
    match carried.field.place {
        Place::Vertices => "vertices",
        Place::Triangles => "triangles",
    }
}

fn line(carried: &Carried, before: &Extent, after: &Extent) -> String {
    let range = |extent: &Extent| format!("{:.6} to {:.6}", extent.min, extent.max);
    let ranges = format!("{} -> {}", range(before), range(after));
    match carried.field.kind {
        Kind::Metric => ranges,
        Kind::Linear(_) => format!("{ranges}   mass {:.12e} -> {:.12e}", before.mass, after.mass),
    }
}

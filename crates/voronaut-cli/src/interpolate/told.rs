//! What is said of fields that were carried over.

use super::InterpolateArgs;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write as _;
use voronaut::mesh::Mesh;
use voronaut::transfer::{Carried, Cover, Extent, Kind, Place};
use voronaut_io::Seconds;

/// The report. Of metrics there is no `mass`: they are no densities.
pub(super) fn report(
    args: &InterpolateArgs,
    meshes: [&Mesh; 2],
    dimension: usize,
    carried: &[Carried],
    cover: &Cover,
    [read, carry, write]: [f64; 3],
) -> Value {
    let [old, new] = meshes.map(|mesh| json!({ "vertices": mesh.points.len(), "triangles": mesh.triangles.len() }));
    let stages = vec![("read", read), ("carry", carry), ("write", write)];
    json!({
        "old": old, "new": new, "method": method(args), "cover": cover,
        "fields": carried.iter().map(|carried| field(carried, dimension)).collect::<Vec<Value>>(),
        "seconds": Seconds { stages, total: read + carry + write },
        "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "old": args.old, "new": args.new, "field": args.field, "out": args.out, "conservative": args.conservative,
            "overshoot": args.overshoot, "linear_tensors": args.linear_tensors, "report": args.report,
            "threads": args.run.threads,
        },
    })
}

/// Says on stdout what became of every field, and on stderr what is odd, unless told to be quiet.
pub(super) fn print(args: &InterpolateArgs, dimension: usize, carried: &[Carried], cover: &Cover) {
    if args.run.quiet {
        return;
    }
    let mut text = format!("{} ({})\n", args.out.display(), method(args));
    for (carried, number) in carried.iter().zip(1..) {
        let name = format!("{number}: {} at {}", kind(carried, dimension), place(carried));
        for (component, (before, after)) in carried.before.iter().zip(&carried.after).enumerate() {
            let name = if component == 0 { name.as_str() } else { "" };
            let _ = writeln!(text, "  {name:<24} {}", line(carried, before, after));
        }
    }
    // Whoever closed the other end of a pipe has seen enough.
    let _ = std::io::stdout().write_all(text.as_bytes());
    if cover.outside > 0 {
        let (count, farthest) = (cover.outside, cover.farthest);
        eprintln!(
            "note: {count} vertices are outside the old mesh, by up to {farthest:.3e}: they have the nearest value"
        );
    }
    let moved = cover.areas.map_or(0.0, |shares| shares.uncovered.max(shares.left));
    if moved > 0.0 {
        eprintln!("note: a share of {moved:.1e} of the area is in one mesh only; masses are kept all the same");
    }
}

fn method(args: &InterpolateArgs) -> &'static str {
    match (args.conservative, args.overshoot) {
        (false, _) => "interpolation",
        (true, false) => "conservative",
        (true, true) => "conservative, overshooting",
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

fn field(carried: &Carried, dimension: usize) -> Value {
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
        "at": place(carried), "kind": kind(carried, dimension), "components": carried.field.components(),
        "before": extents(&carried.before), "after": extents(&carried.after),
    })
}

fn place(carried: &Carried) -> &'static str {
    match carried.field.place {
        Place::Vertices => "vertices",
        Place::Triangles => "triangles",
    }
}

/// Dimension 2 or 3 of the file tells a vector from a tensor.
fn kind(carried: &Carried, dimension: usize) -> &'static str {
    match carried.field.kind {
        Kind::Metric => "metric",
        Kind::Linear(1) => "scalar",
        Kind::Linear(components) if components == dimension => "vector",
        Kind::Linear(_) => "tensor",
    }
}

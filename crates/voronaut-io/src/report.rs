//! The machine-readable account of a run (`--report`).

use serde::{Serialize, Serializer};
use serde_json::Value;
use std::collections::BTreeMap;
use voronaut::canvas::CanvasFigures;
use voronaut::certificate::Certificate;
use voronaut::figures::{Diagram, Dual, NetFigures, Protection, StarSet};
use voronaut::manifold::surface::metric::CurvatureFigures;
use voronaut::mesh::{Mesh, Periodic};
use voronaut::optimise::{Polished, Relaxed};
use voronaut::quality::{
    Angles, EdgeLengths, Fidelity, Histograms, InterpolationError, MetricQuality, Quality, SurfaceFidelity,
    UnmetFigures, Validity, Worst,
};

/// Everything `--report` says. What was not measured is null, and so is what is not finite; the order of keys is fixed.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Validity, its fields beside these.
    #[serde(flatten)]
    pub validity: Validity,
    /// Of curved triangles their `order`, and how many `nodes` they have beside the vertices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curved: Option<BTreeMap<&'static str, usize>>,
    /// Metric lengths of all edges, along their curves.
    pub metric_edge_length: Option<EdgeLengths>,
    /// Metric lengths of the edges that touch no boundary vertex.
    pub interior_edge_length: Option<EdgeLengths>,
    /// Shape of the triangles in the metric.
    pub quality: Option<Quality>,
    /// Angles of the triangles in the metric, degrees.
    pub angle: Option<Angles>,
    /// Where the metric is honoured least.
    pub worst: Option<Worst>,
    /// The edges that are not of unit length, by cause.
    pub unmet: Option<UnmetFigures>,
    /// How edge lengths and angles are distributed, with straight and with geodesic edges; only where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub histograms: Option<Histograms>,
    /// What bounds made of the curvatures of a mesh, where the metric rests on them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature: Option<CurvatureFigures>,
    /// Euclidean distance to the domain's boundary, or to the surface.
    pub fidelity: Option<Strayed>,
    /// Curves of the boundary that correspond, with how many vertices; only where there are some.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub periodic: Vec<Periodic>,
    /// The canvas, where one was used.
    pub canvas: Option<CanvasFigures>,
    /// The diagram, where one was made.
    pub diagram: Option<Diagram>,
    /// Counters of the dual.
    pub dual: Option<Dual>,
    /// How the seeds were relaxed.
    pub relaxation: Option<Relaxed>,
    /// The error of linear interpolation of the function that the mesh is for, or that was asked about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interpolation: Option<InterpolationError>,
    /// How the error of interpolation was lowered.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polished: Option<Polished>,
    /// The vertices as a net, where it was measured.
    pub net: Option<NetFigures>,
    /// How protection of the seeds went, where it was asked for.
    pub protection: Option<Protection>,
    /// What the report's theorems guarantee, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// The star set that became the mesh, where it was made so.
    pub star_set: Option<StarSet>,
    /// The factor on the metric tensor for which the mesh is a unit mesh.
    pub metric_scale: Option<f64>,
    /// The share of unit edges at the factor that the number of vertices asks for, where one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed_form: Option<ClosedForm>,
    /// What could not be met, and what was mended of the input, in words.
    pub notes: Vec<String>,
    /// Wall time.
    pub seconds: Seconds,
    /// The most memory the process has held at once.
    pub peak_memory_bytes: Option<u64>,
    /// The version of voronaut.
    pub version: &'static str,
    /// All options, as used.
    pub options: Value,
}

/// A mesh in the metric whose complexity is that of a unit mesh of the number of vertices that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ClosedForm {
    /// The factor on the metric tensor: N sqrt(3) / 2 over the complexity.
    pub metric_scale: f64,
    /// The share of the edges whose length in that metric is in [1/sqrt 2, sqrt 2].
    pub unit_fraction: f64,
}

/// How far a mesh strays from its domain.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Strayed {
    /// From the boundary of a planar domain.
    Boundary(Fidelity),
    /// From a surface.
    Surface(Box<SurfaceFidelity>),
}

/// Wall time per stage in order, then `total`. A stage that ran more than once is one entry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seconds {
    /// Name and time of each stage.
    pub stages: Vec<(&'static str, f64)>,
    /// Of the whole run.
    pub total: f64,
}

impl Report {
    /// A report of a mesh with this crate's version and the process's peak memory; all else is empty.
    pub fn new(mesh: &Mesh, validity: Validity) -> Self {
        let (vertices, triangles) = (mesh.points.len(), mesh.triangles.len());
        let (peak_memory_bytes, version) = (peak_memory_bytes(), env!("CARGO_PKG_VERSION"));
        let periodic = mesh.periodic.clone();
        Self { vertices, triangles, validity, periodic, peak_memory_bytes, version, ..Self::default() }
    }

    /// Adds figures in a metric.
    pub fn add_quality(&mut self, figures: &MetricQuality) {
        self.metric_edge_length = Some(figures.metric_edge_length);
        self.interior_edge_length = figures.interior_edge_length;
        self.quality = Some(figures.quality);
        self.angle = Some(figures.angle);
        self.worst = Some(figures.worst);
    }

    /// The report as JSON text that ends in a newline.
    pub fn to_json(&self) -> String {
        // Neither keys that are no strings nor failing serializers occur, so this does not fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// The most memory this process has held at once, in bytes; `None` where the system does not say (not Linux).
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

impl Serialize for Seconds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut stages: Vec<(&str, f64)> = Vec::new();
        for &(name, time) in &self.stages {
            match stages.iter_mut().find(|stage| stage.0 == name) {
                Some(stage) => stage.1 += time,
                None => stages.push((name, time)),
            }
        }
        serializer.collect_map(stages.into_iter().chain([("total", self.total)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_what_the_contract_lists_and_is_json_whatever_happened() {
        let mut report = Report::new(&Mesh::default(), Validity { area: f64::NAN, ..Validity::default() });
        report.metric_scale = Some(f64::INFINITY);
        report.seconds = Seconds { stages: vec![("sampling", 1.0), ("lloyd", 2.0), ("sampling", 0.5)], total: 4.0 };
        report.dual = Some(Dual { min_margin: f64::NAN, ..Dual::default() });
        let value: Value = serde_json::from_str(&report.to_json()).unwrap();
        for key in "vertices triangles valid inverted non_manifold_edges duplicate_vertices euler area \
                    metric_edge_length interior_edge_length quality angle unmet canvas diagram dual relaxation metric_scale notes \
                    seconds peak_memory_bytes version options"
            .split_whitespace()
        {
            assert!(value.get(key).is_some(), "{key}");
        }
        assert!(value["area"].is_null() && value["metric_scale"].is_null() && value["dual"]["min_margin"].is_null());
        assert_eq!(value["seconds"]["sampling"], 1.5);
        assert!(report.to_json().find("\"lloyd\"") < report.to_json().find("\"total\""));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn memory_is_measured() {
        assert!(peak_memory_bytes().unwrap() > 100_000);
    }
}

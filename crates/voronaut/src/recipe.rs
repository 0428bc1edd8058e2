//! The main job as one function: from a domain and a metric to a valid unit mesh.

use crate::mesh::Mesh;

/// What the mesher may be told; every parameter has one name (flag, TOML key, Python keyword) and one default.
#[derive(Clone, Debug, serde::Serialize)]
pub struct MeshOptions {
    /// Vertices the mesh should have; the metric is scaled by one factor to meet it.
    pub vertices: Option<usize>,
    /// Target of the integral of sqrt(det M); the metric is scaled to meet it.
    pub complexity: Option<f64>,
    /// How far (Euclidean) mesh edges may stray from the boundary; `None`: the domain's own tolerance.
    pub hausd: Option<f64>,
    /// Steps of Riemannian Lloyd relaxation.
    pub lloyd: usize,
    /// Limit on the memory the work is estimated to need, in bytes.
    pub memory_limit: u64,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self { vertices: None, complexity: None, hausd: None, lloyd: 40, memory_limit: 16 << 30 }
    }
}

/// What the mesher counted: deterministic, the same on every machine and for any number of threads.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct MeshCounters {
    /// In-circle tests settled by each level of the filter: frozen tensor, chord length, path energy.
    pub geodesic_tests: [u64; 3],
    /// Tests whose margin stayed within the error bound of the last level.
    pub uncertain: u64,
    /// The smallest margin among the final mesh's edges (sine of the sum of opposite angles).
    pub min_margin: f64,
    /// Flips that the metric wants and the plane forbids, in the final mesh.
    pub blocked_flips: u64,
}

/// The result of meshing.
#[derive(Clone, Debug)]
pub struct Meshed {
    /// A valid mesh.
    pub mesh: Mesh,
    /// The factor on the metric tensor for which the mesh is a unit mesh (1 where the metric was used as it is).
    pub metric_scale: f64,
    /// Work counters.
    pub counters: MeshCounters,
    /// Wall time per stage, in order.
    pub seconds: Vec<(&'static str, f64)>,
    /// What could not be met, in words for the user; empty when all was.
    pub notes: Vec<String>,
}

/// Told about progress during long work; the library never prints.
pub trait Progress: Sync {
    /// A stage began, with so many units of work.
    fn stage(&self, name: &'static str, total: u64);
    /// So many units of the current stage are done.
    fn done(&self, units: u64);
}

/// Progress that nobody watches.
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _name: &'static str, _total: u64) {}
    fn done(&self, _units: u64) {}
}

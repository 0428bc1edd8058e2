//! What the mesher may be told.

use crate::canvas;
use crate::dual::Road;
use crate::error::named;
use crate::geodesic::Method;
use crate::optimise::FitOptions;

/// What the mesher may be told; every parameter has one name (flag, TOML key, Python keyword) and one default.
#[derive(Clone, Debug, serde::Serialize)]
pub struct MeshOptions {
    /// Vertices the mesh should have; the metric is scaled by one factor to meet it.
    pub vertices: Option<usize>,
    /// Target of the integral of sqrt(det M); the metric is scaled to meet it.
    pub complexity: Option<f64>,
    /// How far (Euclidean) mesh edges may stray from the boundary; `None`: the domain's own tolerance. Of a surface: how far
    /// mesh and surface may be from each other; where that asks for more vertices, and no number is given, there are more.
    pub hausd: Option<f64>,
    /// The order of triangles, 1 for straight ones; those of order 2 and 3 are curved to follow the metric in the plane, and an equation's surface.
    pub order: usize,
    /// Of curved triangles: what boundaries and interfaces are between the vertices that the domain has there.
    pub boundary: Boundary,
    /// In the plane: pairs of labels of boundary curves that a rotation and a translation map onto each other. The mesh's edges on the two
    /// correspond ([`Mesh::periodic`](crate::mesh::Mesh::periodic)).
    pub periodic: Vec<[i32; 2]>,
    /// Of a surface: whether vertices are moved off it, to where mesh and surface are closest in the sense of least squares.
    pub fit: bool,
    /// How stiffly these vertices are held where they were; see `FitOptions`.
    pub stiffness: f64,
    /// What makes the mesh. The options below are for [`Mesher::Voronoi`], but for the memory limit.
    pub mesher: Mesher,
    /// How much work is spent on what is left to gain.
    pub effort: Effort,
    /// Steps of Riemannian Lloyd relaxation, at most: it ends where it gains too little ([`Effort`]).
    pub lloyd: usize,
    /// The centroids that it moves seeds to.
    pub centroid: Centroid,
    /// Sweeps of polishing, at most, where the mesh is for a function ([`Aim`](super::Aim)); see `polish`.
    pub polish: usize,
    /// Which road decides on the topology. On a surface it is by lengths unless it is [`Road::Canvas`].
    pub dual: Road,
    /// How distances on the canvas are computed where a diagram settles edges; seeding marches.
    pub geodesic: Method,
    /// How the interior is seeded.
    pub seeding: Seeding,
    /// With [`Seeding::Protected`], the power protection asked of every interior simplex, as a share of epsilon, the
    /// greatest circumradius; sqrt(3) at most. On a surface it is asked of triangles, not of edges at borders.
    pub protection: f64,
    /// In the plane, with [`Seeding::Protected`], the radius of the ball around a circumcentre in which a seed is picked, as a share of
    /// the circumradius.
    pub picking_radius: f64,
    /// Whether the net of the mesh's vertices is measured ([`Meshed::net`](super::Meshed::net), or
    /// [`Meshed::surface_net`](super::Meshed::surface_net)); with [`Seeding::Protected`] it always is.
    pub net: bool,
    /// Which canvas, where one is used: for seeding and relaxing, and to settle edges.
    pub canvas: canvas::Kind,
    /// Canvas vertices per seed, where a canvas is used.
    pub canvas_size: u32,
    /// Limit on the memory the work is estimated to need, in bytes.
    pub memory_limit: u64,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            vertices: None,
            complexity: None,
            hausd: None,
            order: 1,
            boundary: Boundary::default(),
            periodic: Vec::new(),
            fit: false,
            stiffness: FitOptions::default().stiffness,
            mesher: Mesher::default(),
            effort: Effort::default(),
            lloyd: 40,
            centroid: Centroid::default(),
            polish: 20,
            dual: Road::default(),
            geodesic: Method::default(),
            seeding: Seeding::default(),
            protection: 0.2,
            picking_radius: 0.3,
            net: false,
            canvas: canvas::Kind::default(),
            canvas_size: canvas::VERTICES_PER_SEED,
            memory_limit: 16 << 30,
        }
    }
}

impl MeshOptions {
    /// The road that is taken: diagrams cost more than the rest of a mesh that is to be there fast.
    pub(super) fn road(&self) -> Road {
        if self.effort == Effort::Fast && self.dual == Road::Both { Road::Geodesic } else { self.dual }
    }
}

/// How much work is spent on what is left to gain; its names are those users type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// `fast`: relaxation ends early, with one exchange of seeds for three, and no diagram is asked unless `dual` says so.
    Fast,
    /// `normal`: relaxation ends when steps gain next to nothing.
    #[default]
    Normal,
    /// `best`: relaxation ends when nothing is left to gain.
    Best,
}

named!(Effort, "effort", [Fast = "fast", Normal = "normal", Best = "best"]);

impl Effort {
    /// The share of the energy that a step of relaxation has to gain. With `normal` meshes are as good as with 1e-4 and Lloyd's step as first guess. With 2e-3 they take
    /// up to a third less time, and mean quality is lower by 0.001 to 0.003.
    pub(super) fn gain(self) -> f64 {
        match self {
            Effort::Fast => 4e-3,
            Effort::Normal => 7e-4,
            Effort::Best => 1e-6,
        }
    }

    /// Relaxation goes in so many parts, and seeds are exchanged between them. Two for four: a quarter less time, mean quality lower by
    /// 0.001 to 0.007 (meshes of 3,000 to 100,000 vertices); of seeds from a coarser mesh, which are even, by 0.001.
    pub(super) fn parts(self, are_even: bool) -> usize {
        match self {
            Effort::Best => 4,
            Effort::Normal if !are_even => 4,
            _ => 2,
        }
    }

    /// What is spent on relaxing what will be polished, which moves seeds and flips edges by the error itself.
    pub(super) fn before_polishing(self) -> Self {
        if self == Effort::Normal { Effort::Fast } else { self }
    }

    /// Whether work goes on that may gain nothing.
    pub(super) fn is_thorough(self) -> bool {
        self == Effort::Best
    }

    /// The share of the error that a sweep of polishing has to gain. With `normal` and 7e-4 errors are lower by 0.2 %, and polishing takes up to a third more time.
    pub(super) fn gain_of_polishing(self) -> f64 {
        match self {
            Effort::Fast => 1e-2,
            Effort::Normal => 2e-3,
            Effort::Best => 5e-4,
        }
    }
}

/// How the interior is seeded, once the boundary is sampled at unit length; its names are those users type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seeding {
    /// `sizing`: at the circumcentre of the face whose metric circumradius is largest. On a surface its own triangles are split and contracted.
    #[default]
    Sizing,
    /// `farthest`: at the canvas vertex that is farthest, in geodesic distance, from all seeds so far. Needs a canvas.
    Farthest,
    /// `protected`: as `sizing`, with seeds put where they leave every simplex power-protected; then moved until that is so. On a surface
    /// seeds at borders and on features stay.
    Protected,
}

named!(Seeding, "seeding", [Sizing = "sizing", Farthest = "farthest", Protected = "protected"]);

/// The centroids that relaxation moves seeds to; its names are those users type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Centroid {
    /// `tangent`: of cells in the tangent planes at the seeds.
    #[default]
    Tangent,
    /// `canvas`: of the diagram's cells, through the logarithm map. Slower; for few seeds in wild metrics.
    Canvas,
    /// `weighted`: the report's equation 9 on the diagram's cells, to compare.
    Weighted,
}

named!(Centroid, "centroid", [Tangent = "tangent", Canvas = "canvas", Weighted = "weighted"]);

/// What makes the mesh; its names are those users type (`--mesher`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mesher {
    /// `voronoi`: the dual of a Riemannian Voronoi diagram, always embedded.
    #[default]
    Voronoi,
    /// `starset`: Delaunay stars, each in its vertex's own metric, refined until they agree. The metric's scale is met,
    /// not the number of vertices; where the metric turns fast it takes many more.
    StarSet,
}

named!(Mesher, "mesher", [Voronoi = "voronoi", StarSet = "starset"]);

/// What the boundaries and interfaces of curved triangles are; its names are those users type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Boundary {
    /// `auto`: the circle of a disk, and straight between the vertices of other domains.
    #[default]
    Auto,
    /// `polyline`: straight between the domain's vertices.
    Polyline,
    /// `spline`: smooth curves through the domain's vertices, with corners where they turn by more than 45 degrees, and straight segments where one is three
    /// times as long as its neighbours.
    Spline,
}

named!(Boundary, "boundary", [Auto = "auto", Polyline = "polyline", Spline = "spline"]);

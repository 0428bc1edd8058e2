//! The mesh adapted to a solution, again and again: solve, recover, mesh, carry over.

use super::{GradedAt, MeshOptions, Meshed, MetricOptions};
use crate::error::{Error, Result};
use crate::mesh::{Mesh, SolutionValues, Solutions};
use crate::metric::Expression;
use crate::progress::Progress;
use crate::transfer::{Carried, Cover, TransferOptions, carry};
use std::collections::BTreeSet;

/// How a mesh is adapted; every parameter has one name (flag, TOML key, Python keyword).
#[derive(Clone, Debug)]
pub struct LoopOptions {
    /// How often; at least once.
    pub iterations: usize,
    /// Which of a solver's solutions on vertices the mesh is for, from 1: a scalar, or a tensor, which then is the metric.
    pub field: usize,
    /// What is done to the metric.
    pub metric: MetricOptions,
    /// How each mesh is made; it needs a number of vertices or a complexity.
    pub mesh: MeshOptions,
    /// How solutions are carried to the next mesh.
    pub transfer: TransferOptions,
}

impl LoopOptions {
    /// In which multiple of the metric edges are to have length one.
    pub(super) fn graded_at(&self) -> GradedAt {
        GradedAt::of(self.mesh.vertices, self.mesh.complexity)
    }
}

/// A user's solver: from the number of the step, a mesh and solutions there to start from (`None` at first) to solutions there.
pub(crate) type Solver<'a> = dyn FnMut(usize, &Mesh, Option<&Solutions>) -> Result<Solutions> + 'a;

/// What meshes are adapted on: a planar domain, or a surface that was cut open along the features that are to be kept.
pub trait Adaptive {
    /// Coordinates of a point: 2 or 3.
    fn dimension(&self) -> u8;

    /// The mesh for a function at one time, and its values at the vertices.
    ///
    /// # Errors
    /// Those of its metric and of meshing.
    fn mesh_at_time(
        &self,
        function: &Expression,
        time: f64,
        options: &LoopOptions,
        progress: &dyn Progress,
    ) -> Result<(Meshed, Vec<f64>)>;

    /// The mesh for a solution on another mesh; without one an even mesh.
    ///
    /// # Errors
    /// Those of its metric and of meshing.
    fn mesh_for_solution(
        &self,
        solution: Option<(&Mesh, &SolutionValues)>,
        options: &LoopOptions,
        progress: &dyn Progress,
    ) -> Result<Meshed>;
}

/// What the meshes are for.
pub enum Source<'a> {
    /// A function of x, y and t, on a surface of x, y, z and t, known exactly; t goes evenly from the first time, for the first mesh, to the last.
    Formula(Expression, [f64; 2]),
    /// What a solver finds on each mesh, starting from an even one.
    Solver(&'a mut Solver<'a>),
}

/// A step of the loop.
pub struct Step {
    /// Its number, from 1; 0 is the even mesh that a solver starts from.
    pub number: usize,
    /// The time, where there is one.
    pub time: Option<f64>,
    /// The mesh, with what is said of it.
    pub meshed: Meshed,
    /// Solutions on it: of a formula its values, and then what has been carried along since the first step; else what the solver
    /// found on the mesh before, carried here.
    pub solutions: Solutions,
    /// What became of each carried solution, and how the meshes cover each other; none on the first mesh.
    pub transfer: Option<(Vec<Carried>, Cover)>,
    /// Vertices on labelled edges: those of boundary, interfaces and features.
    pub boundary_vertices: usize,
}

/// Adapts the mesh of a domain or a surface so many times, and calls `each` with every step.
///
/// Every mesh is made from the domain itself, whose corners, labels and features it keeps; vertices in the middle of straight runs
/// of one label are placed anew each time, so that their number follows the metric and does not grow with the steps.
///
/// # Errors
/// Those of the solver, of `each`, of meshing ([`super::mesh_for`], [`super::mesh_surface`]), recovery and transfer ([`carry`]), with the number of the step.
pub fn adapt(
    on: &dyn Adaptive,
    source: Source,
    options: &LoopOptions,
    progress: &dyn Progress,
    each: &mut dyn FnMut(&Step) -> Result<()>,
) -> Result<()> {
    let work = Work { on, options, progress };
    match source {
        Source::Formula(function, times) => work.follow(&function, times, each),
        Source::Solver(solver) => work.solve(solver, each),
    }
}

struct Work<'a> {
    on: &'a dyn Adaptive,
    options: &'a LoopOptions,
    progress: &'a dyn Progress,
}

impl Work<'_> {
    fn follow(
        &self,
        function: &Expression,
        [first, last]: [f64; 2],
        each: &mut dyn FnMut(&Step) -> Result<()>,
    ) -> Result<()> {
        let mut before: Option<(Mesh, SolutionValues)> = None;
        let steps = self.options.iterations;
        for number in 1..=steps {
            let share = (number - 1) as f64 / (steps.max(2) - 1) as f64;
            let time = first + share * (last - first);
            let (meshed, values) = self.on.mesh_at_time(function, time, self.options, self.progress)?;
            let carry = |(mesh, values)| self.carry(&mesh, &meshed.mesh, &self.solutions(vec![values]));
            let carried = before.take().map(carry).transpose()?;
            let values = SolutionValues::Scalar(values);
            let (along, transfer) = match carried {
                Some((mut solutions, transfer)) => (solutions.vertices.swap_remove(0), Some(transfer)),
                None => (values.clone(), None),
            };
            before = Some((meshed.mesh.clone(), along.clone()));
            let solutions = self.solutions(vec![values, along]);
            each(&Step::new(number, Some(time), meshed, solutions, transfer))?;
        }
        Ok(())
    }

    fn solve(&self, solver: &mut Solver, each: &mut dyn FnMut(&Step) -> Result<()>) -> Result<()> {
        let mut step = Step::new(0, None, self.mesh(None)?, self.solutions(Vec::new()), None);
        each(&step)?;
        for number in 1..=self.options.iterations {
            let mesh = &step.meshed.mesh;
            let found = solver(number, mesh, Some(&step.solutions).filter(|_| number > 1))?;
            let values = self.chosen(&found)?;
            let meshed = self.mesh(Some((mesh, values)))?;
            let (solutions, transfer) = self.carry(mesh, &meshed.mesh, &found)?;
            step = Step::new(number, None, meshed, solutions, Some(transfer));
            each(&step)?;
        }
        Ok(())
    }

    fn mesh(&self, solution: Option<(&Mesh, &SolutionValues)>) -> Result<Meshed> {
        self.on.mesh_for_solution(solution, self.options, self.progress)
    }

    fn solutions(&self, vertices: Vec<SolutionValues>) -> Solutions {
        Solutions { dimension: self.on.dimension(), vertices, triangles: Vec::new() }
    }

    fn carry(&self, old: &Mesh, new: &Mesh, solutions: &Solutions) -> Result<(Solutions, (Vec<Carried>, Cover))> {
        let (solutions, carried, cover) = carry(old, new, solutions, self.options.transfer)?;
        Ok((solutions, (carried, cover)))
    }

    fn chosen<'s>(&self, found: &'s Solutions) -> Result<&'s SolutionValues> {
        let number = self.options.field;
        found.vertices.get(number.wrapping_sub(1)).ok_or_else(|| {
            let what = format!(
                "there is no solution number {number} on the vertices: the solver wrote {}",
                found.vertices.len()
            );
            Error::parse("the solver's file", what, "choose another `field`, or write it in SolAtVertices")
        })
    }
}

impl Step {
    fn new(
        number: usize,
        time: Option<f64>,
        meshed: Meshed,
        solutions: Solutions,
        transfer: Option<(Vec<Carried>, Cover)>,
    ) -> Self {
        let ends: BTreeSet<u32> = meshed.mesh.edges.as_flattened().iter().copied().collect();
        Self { number, time, meshed, solutions, transfer, boundary_vertices: ends.len() }
    }
}

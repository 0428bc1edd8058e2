//! How the interior is seeded.

use super::Job;
use super::options::{Centroid, Seeding};
use crate::canvas::{self, Canvas};
use crate::diagram::Diagram;
use crate::domain::Domain;
use crate::dual::Dual;
use crate::error::Result;
use crate::figures;
use crate::geometry::Point;
use crate::sampling::{demand_memory, refine_farthest};

impl Job<'_> {
    /// The canvas of the domain, if seeding or relaxing needs one: it does not depend on the metric's factor, so one serves all
    /// rounds of seeding.
    ///
    /// # Errors
    /// The memory limit, or the metric at a canvas vertex.
    pub(super) fn canvas(&mut self, domain: &Domain, seeds: usize) -> Result<Option<Canvas>> {
        if self.options.seeding != Seeding::Farthest && self.options.centroid == Centroid::Tangent {
            return Ok(None);
        }
        let size = canvas::size_for(seeds, self.options.canvas_size);
        demand_memory(seeds as f64, size as f64, self.options.memory_limit)?;
        self.progress.begin("canvas", 1)?;
        let canvas = self.timed("canvas", |job| Canvas::new(job.options.canvas, domain, job.field, size))?;
        self.canvas = Some(canvas.figures());
        Ok(Some(canvas))
    }

    /// Fills the interior of a dual whose segments are sampled.
    ///
    /// # Errors
    /// None that a dual of the canvas's domain could cause.
    pub(super) fn seed_farthest(&mut self, canvas: &Canvas, dual: &mut Dual, count: usize) -> Result<()> {
        let seeds: Vec<Point> = dual.topology().vertices().map(|v| dual.position(v)).collect();
        let mut diagram = Diagram::roughly_of_vertices(canvas, self.field, &seeds)?;
        refine_farthest(dual, &mut diagram, self.fill(count), self.progress)?;
        self.diagram = Some(figures::Diagram::of(&diagram));
        Ok(())
    }
}

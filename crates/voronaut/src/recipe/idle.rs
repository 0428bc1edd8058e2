//! Options that have no say where they are given: front ends refuse those that were set, and report none of them as used.

use super::{MeshOptions, Mesher, MetricOptions, Seeding};
use crate::dual::Road;
use crate::error::{Error, Result};
use crate::metric::Bounds;

/// What a metric is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// Sizes and directions.
    #[default]
    Sizes,
    /// The second derivatives of a function.
    Function,
    /// Those recovered from its values at the vertices of a mesh.
    Values,
}

/// What options are given for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Task {
    /// A surface is meshed, not a planar domain.
    pub on_surface: bool,
    /// What the metric is made of.
    pub origin: Origin,
    /// The metric is limited, smoothed or graded ([`MetricOptions::is_limiting`]).
    pub is_limited: bool,
    /// A diagram is drawn, on a canvas.
    pub is_drawn: bool,
}

/// An option that has no say in a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Idle {
    /// Its name.
    pub option: &'static str,
    /// Whether it is other than its default.
    pub is_set: bool,
    /// Where it has no say: "on a surface", "without `fit`".
    pub place: &'static str,
}

impl Idle {
    /// Refuses an option that is set.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the option is set.
    pub fn demand_unset(&self) -> Result<()> {
        let Self { option, is_set, place } = self;
        if !is_set {
            return Ok(());
        }
        let help = format!("leave out `{option}`: it has no say there");
        Err(Error::unsupported(format!("`{option}` {place}"), help))
    }
}

/// An option, whether it is set, and what it needs: whether each holds, and what to say where it does not.
type Row<'a> = (&'static str, bool, &'a [(bool, &'static str)]);

fn idle(rows: &[Row]) -> Vec<Idle> {
    let idle = |&(option, is_set, needs): &Row| {
        let &(_, place) = needs.iter().find(|(holds, _)| !holds)?;
        Some(Idle { option, is_set, place })
    };
    rows.iter().filter_map(idle).collect()
}

impl MeshOptions {
    /// The options that have no say in a task, in the order of their declaration.
    pub fn idle(&self, task: Task) -> Vec<Idle> {
        let usual = Self::default();
        let plane = (!task.on_surface, "on a surface");
        let surface = (task.on_surface, "in the plane");
        let voronoi = (self.mesher == Mesher::Voronoi, "with `mesher=starset`");
        let protected = (self.seeding == Seeding::Protected, "without `seeding=protected`");
        let farthest = self.seeding == Seeding::Farthest;
        let asks_diagram = self.dual == Road::Canvas || self.dual == Road::Both && !task.on_surface;
        let diagram = (asks_diagram || farthest && task.on_surface, "where no diagram settles edges");
        let has_canvas = asks_diagram || farthest || self.centroid != usual.centroid || task.is_drawn;
        let canvas = (has_canvas, "where no canvas is made");
        let differs = |one: f64, other: f64| one.to_bits() != other.to_bits();
        idle(&[
            ("order", self.order != usual.order, &[(!plane.0 || voronoi.0, voronoi.1)]),
            ("boundary", self.boundary != usual.boundary, &[plane, (self.order > 1, "with straight triangles")]),
            ("periodic", !self.periodic.is_empty(), &[plane, voronoi]),
            ("fit", self.fit, &[surface]),
            ("stiffness", differs(self.stiffness, usual.stiffness), &[surface, (self.fit, "without `fit`")]),
            ("mesher", self.mesher != usual.mesher, &[(plane.0 || voronoi.0, plane.1)]),
            ("centroid", self.centroid != usual.centroid, &[voronoi, (self.lloyd > 0, "without relaxation")]),
            (
                "polish",
                self.polish != usual.polish,
                &[
                    voronoi,
                    (task.origin != Origin::Sizes, "with a metric that is not a function's"),
                    (plane.0 || task.origin == Origin::Function, "on a surface, of a function known at vertices only"),
                    (!task.is_limited, "with a metric that is limited, smoothed or graded"),
                ],
            ),
            ("dual", self.dual != usual.dual, &[voronoi]),
            ("geodesic", self.geodesic != usual.geodesic, &[voronoi, diagram]),
            ("seeding", self.seeding != usual.seeding, &[voronoi]),
            ("protection", differs(self.protection, usual.protection), &[protected]),
            (
                "picking_radius",
                differs(self.picking_radius, usual.picking_radius),
                &[plane, protected, (self.lloyd == 0, "where seeds are relaxed")],
            ),
            ("net", self.net, &[voronoi]),
            ("canvas", self.canvas != usual.canvas, &[voronoi, canvas]),
            ("canvas_size", self.canvas_size != usual.canvas_size, &[voronoi, canvas]),
        ])
    }
}

impl MetricOptions {
    /// The options that have no say in a task, in the order of their declaration.
    pub fn idle(&self, task: Task) -> Vec<Idle> {
        let usual = Self::default();
        let plane = (!task.on_surface, "on a surface");
        let of_function = (task.origin != Origin::Sizes, "with a metric that is not a function's");
        let recovered = (task.origin == Origin::Values, "without values of a function to recover from");
        idle(&[
            ("norm", self.norm != usual.norm, &[of_function]),
            ("recovery", self.recovery != usual.recovery, &[plane, recovered]),
        ])
    }

    /// Whether more than limits that a metric has by itself are asked of it.
    pub fn is_limiting(&self) -> bool {
        self.bounds != Bounds::default() || self.smooth_metric > 0 || self.gradation.is_some()
    }
}

//! Metrics at vertices from solutions and other metrics, in one documented order.

use super::complexity::{complexity, demand_target, scaled_to};
use super::gradation::Gradation;
use super::restrict::{Limits, restrict};
use super::solve::{Root, root};
use super::weighted::weighted;
use super::{Vertices, average, intersect};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::metric::Norm;

/// From Hessians and metrics to the metric of the next mesh. The order:
///
/// 1. *Absolute values* of Hessians, and their *L^p weights*, optimal in that norm (Loseille and Alauzet 2011); metrics come as they are.
/// 2. *One scale*: with a target and several sources, each is given the target complexity. Sources in different units would
///    otherwise not be comparable, and the finer one would be the only one.
/// 3. *Combine*: [`intersect`] or [`average`].
/// 4. *Restrict* sizes, then anisotropy (`super::restrict`), after the scale, for limits are in the user's units.
/// 5. *Gradation* ([`super::grade`]), after the limits, for they make metrics jump; it keeps them. At a crease of a surface sides then become one.
/// 6. *The factor last*: 4 and 5 change the complexity, so the factor of step 2 is solved for, such that the complexity of
///    what comes out is the target. Where limits forbid that, the error says what they allow.
///
/// Without a target nothing is scaled.
#[derive(Clone, Debug, Default)]
pub struct Pipeline {
    /// The norm whose error Hessians are to make least.
    pub norm: Norm,
    /// The integral of sqrt(det M) that comes out, to a relative error of a millionth.
    pub target_complexity: Option<f64>,
    /// What several sources become.
    pub combination: Combination,
    /// Least and greatest sizes, greatest anisotropy.
    pub limits: Limits,
    /// How fast sizes may grow; `None` for no gradation.
    pub gradation_factor: Option<f64>,
}

/// Where a metric comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// Second derivatives, which may be indefinite.
    Hessian(Vec<Tensor>),
    /// A metric.
    Metric(Vec<Tensor>),
}

/// How several metrics become one.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Combination {
    /// As fine as each of them.
    #[default]
    Intersect,
    /// The log-Euclidean mean with these weights.
    Average(Vec<f64>),
}

/// What a [`Pipeline`] made.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The metric, one tensor per vertex.
    pub tensors: Vec<Tensor>,
    /// Its complexity.
    pub complexity: f64,
    /// What the combined metric was multiplied by, in all.
    pub factor: f64,
    /// How many vertices were changed, and by what.
    pub touched: Touched,
}

/// Vertices at which a limit or the gradation is in force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Touched {
    /// A size was smaller.
    pub h_min: usize,
    /// A size was larger.
    pub h_max: usize,
    /// The anisotropy was greater, with sizes in range.
    pub a_max: usize,
    /// Sizes grew too fast.
    pub gradation: usize,
}

/// How well a target is met, as a share of it.
#[cfg(test)]
const MET: f64 = 1e-6;
/// What the search for the factor aims at.
const AIM: f64 = 1e-9;
/// What it aims at where there is a gradation: then the rest, of twice that at most, is a factor on what was graded.
const LIFT: f64 = 5e-4;
/// The complexity of a unit mesh of many vertices, for each of them: the area of two equilateral triangles, sqrt(3) / 2.
pub const COMPLEXITY_PER_VERTEX: f64 = 0.866_025_403_784_438_6;

impl Pipeline {
    /// The metric that comes out at the vertices of a mesh.
    ///
    /// # Errors
    /// As of [`Sampled::new`](crate::metric::Sampled::new), `super::weighted`, [`intersect`], [`average`], `super::restrict` and
    /// [`super::grade`]; [`Error::Parse`] of a target that is no complexity; [`Error::Limit`] of one that limits forbid.
    pub fn run(&self, mesh: &Mesh, sources: &[Source]) -> Result<Outcome> {
        self.run_on(mesh, sources)
    }

    /// The same of vertices of any mesh.
    ///
    /// # Errors
    /// As of [`Pipeline::run`].
    pub(crate) fn run_on(&self, mesh: &impl Vertices, sources: &[Source]) -> Result<Outcome> {
        self.target_complexity.map_or(Ok(()), demand_target)?;
        self.limits.check(mesh.count())?;
        let combined = self.combine(mesh, sources)?;
        let gradation = self.gradation_factor.map(|factor| mesh.gradation(factor)).transpose()?;
        let stage = Stage { mesh, combined: &combined, limits: &self.limits, gradation };
        let Some(target) = self.target_complexity else { return stage.outcome(1.0, stage.at(1.0)?) };
        // Gradation is dear, and its result may be lifted.
        let (aim, goal) = match stage.gradation {
            Some(_) => (LIFT, target * (-LIFT).exponential()),
            None => (AIM, target),
        };
        match root(aim, |x| Ok((complexity(mesh, &stage.at(x.exponential())?) / goal).logarithm()))? {
            Root::At(x) | Root::Jump(x) => stage.lifted(x.exponential(), target),
            Root::Below(excess) => Err(out_of_reach(target, "at most", goal * excess.exponential())),
            Root::Above(excess) => Err(out_of_reach(target, "at least", goal * excess.exponential())),
        }
    }

    /// Steps 1 to 3.
    fn combine(&self, mesh: &impl Vertices, sources: &[Source]) -> Result<Vec<Tensor>> {
        let metric = |source: &Source| {
            let tensors = match source {
                Source::Hessian(hessians) => weighted(hessians, self.norm)?,
                Source::Metric(tensors) => tensors.clone(),
            };
            mesh.check(&tensors)?;
            self.target_complexity.map_or(Ok(tensors.clone()), |target| scaled_to(mesh, &tensors, target))
        };
        let metrics = sources.iter().map(metric).collect::<Result<Vec<_>>>()?;
        let metrics: Vec<&[Tensor]> = metrics.iter().map(Vec::as_slice).collect();
        match &self.combination {
            Combination::Intersect => intersect(&metrics),
            Combination::Average(weights) => average(&metrics, weights),
        }
    }
}

fn out_of_reach(target: f64, bound: &str, reached: f64) -> Error {
    let what = format!("a complexity of {target}: within the limits it is {bound} {reached:.6e}");
    Error::limit(what, "widen h_min and h_max, or ask for a complexity in reach")
}

/// Steps 4 and 5, for any factor.
struct Stage<'a, V> {
    mesh: &'a V,
    combined: &'a [Tensor],
    limits: &'a Limits,
    gradation: Option<Gradation<'a>>,
}

impl<V: Vertices> Stage<'_, V> {
    fn at(&self, factor: f64) -> Result<Vec<Tensor>> {
        let scaled: Vec<Tensor> = self.combined.iter().map(|&tensor| tensor * factor).collect();
        let mut tensors = restrict(&scaled, self.limits)?;
        if let Some(gradation) = &self.gradation {
            gradation.apply(&mut tensors, self.limits)?;
        }
        Ok(self.mesh.join(tensors))
    }

    fn outcome(&self, factor: f64, tensors: Vec<Tensor>) -> Result<Outcome> {
        let touched = self.touched(factor, &tensors)?;
        Ok(Outcome { complexity: complexity(self.mesh, &tensors), tensors, factor, touched })
    }

    /// What is missing is a factor on the result: above 1, so that the law of the gradation stays, but where limits are in the way.
    /// Without it the target could not be met: the levels by which gradation goes about a metric jump with the factor of what it is
    /// given, and with them, by a little, the complexity.
    fn lifted(&self, factor: f64, target: f64) -> Result<Outcome> {
        let graded = self.at(factor)?;
        let times = |x: f64| restrict(&graded.iter().map(|&m| m * x.exponential()).collect::<Vec<_>>(), self.limits);
        match root(AIM, |x| Ok((complexity(self.mesh, &times(x)?) / target).logarithm()))? {
            Root::At(x) | Root::Jump(x) => {
                let lifted = self.outcome(factor * x.exponential(), times(x)?)?;
                Ok(Outcome { touched: self.touched(factor, &graded)?, ..lifted })
            }
            Root::Below(excess) | Root::Above(excess) => {
                Err(out_of_reach(target, "about", target * excess.exponential()))
            }
        }
    }

    fn touched(&self, factor: f64, tensors: &[Tensor]) -> Result<Touched> {
        let mut touched = Touched::default();
        let scaled: Vec<Tensor> = self.combined.iter().map(|&tensor| tensor * factor).collect();
        for ((v, &m), clamped) in scaled.iter().enumerate().zip(restrict(&scaled, self.limits)?) {
            let (e, bounds) = (m.eigen(), self.limits.at(v));
            let [shorter, longer] = [e.large, e.small].map(|value| 1.0 / value.sqrt());
            let sizes = crate::metric::Bounds { a_max: None, ..bounds }.clamp(m);
            touched.h_min += usize::from(bounds.h_min.is_some_and(|h| shorter < h));
            touched.h_max += usize::from(bounds.h_max.is_some_and(|h| longer > h));
            touched.a_max += usize::from(sizes != clamped);
            touched.gradation += usize::from(self.gradation.is_some() && tensors[v] != clamped);
        }
        Ok(touched)
    }
}

#[cfg(test)]
mod tests;

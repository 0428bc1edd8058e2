//! Metrics that change slowly: the one law, in the plane and on surfaces.

use super::restrict::Limits;
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Tensor, Vector};
use crate::mesh::Mesh;
use crate::metric::neighbours::Neighbours;
use crate::metric::validate::check_at_vertices;
use crate::parallel::prelude::*;
use std::collections::BTreeMap;

/// The metric with sizes that grow slowly: along no edge (p, q) does that at q ask for less than what the one at p has grown to.
/// What it has grown to is that of mixed space (Alauzet 2010): the size h along each of its axes has become h times
///
/// > (1 + ln(b) |pq| / h)^t (1 + ln(b) l)^(1 - t),
///
/// |pq| the Euclidean and l the metric length of the edge at p, b the `gradation_factor`, t `GRADATION_EXPONENT`. With t = 1
/// all sizes grow by ln(b) per Euclidean length, and a metric is soon as isotropic as its least size; with t = 0 all grow by
/// one factor, and it is as anisotropic as before. Neighbouring edges of a unit mesh then differ by about the factor b.
///
/// In rounds each metric is intersected with all at once of what neighbours have grown to (`Tensor::intersection_with_all`), until
/// none asks for more, by a millionth, than what is there. A round is asked for by the densest that are left, by levels of density
/// and not one by one, for the result would depend on which of two comes first. So it is nowhere coarser than what was given, obeys
/// the law along every edge (to a millionth), and graded again is the same to the bit; it does not depend, but for rounding, on units
/// or on how vertices are numbered. A uniform metric stays.
///
/// # Errors
/// As of [`Sampled::new`](crate::metric::Sampled::new); [`Error::Parse`] unless the factor is finite and at least 1 (then all that
/// hangs together has one metric); [`Error::Limit`] where it does not settle.
pub fn grade(mesh: &Mesh, tensors: &[Tensor], gradation_factor: f64) -> Result<Vec<Tensor>> {
    check_at_vertices(mesh, tensors)?;
    let mut graded = tensors.to_vec();
    Gradation::on(mesh, gradation_factor)?.apply(&mut graded, &Limits::default())?;
    Ok(graded)
}

/// The exponent t of [`grade`]'s mixed space.
pub(crate) const GRADATION_EXPONENT: f64 = 0.125;
/// What neighbours ask for and is more than what is there by a smaller share is not asked for.
const SETTLED: f64 = 1e-6;
/// The same between tangent planes: around a vertex where a surface is curved directions come back turned, and what is asked for with
/// them is a little more each time. A hundredth of a size is no gain to anybody.
const SETTLED_BETWEEN_PLANES: f64 = 0.02;
/// Rounds after which something is wrong, beside those that it takes to get across the mesh.
const PATIENCE: usize = 200;
/// A round looks at so many vertices one after the other before threads share them.
const TOGETHER: usize = 256;

/// The law ([`grade`]), and where it holds.
pub(crate) struct Gradation<'a> {
    around: Neighbours,
    /// The way from a vertex to a neighbour, in the coordinates of the latter,
    offset: Box<dyn Fn(u32, u32) -> Vector + Sync + 'a>,
    /// and the x axis of the former in these, where coordinates differ.
    turn: Option<Box<dyn Fn(u32, u32) -> Vector + Sync + 'a>>,
    growth: f64,
    /// What is more than what is there by a smaller share is not asked for.
    settled: f64,
}

impl<'a> Gradation<'a> {
    /// On a planar mesh.
    ///
    /// # Errors
    /// [`Error::Parse`] unless the factor is finite and at least 1.
    pub(super) fn on(mesh: &'a Mesh, gradation_factor: f64) -> Result<Self> {
        Self::new(Neighbours::of(mesh), move |v, w| mesh.point(w) - mesh.point(v), gradation_factor)
    }

    /// Of sizes that are the same in all directions, wherever vertices are: only lengths count.
    ///
    /// # Errors
    /// As of [`Gradation::on`].
    pub(crate) fn of_sizes(
        around: Neighbours,
        length: impl Fn(u32, u32) -> f64 + Sync + 'a,
        gradation_factor: f64,
    ) -> Result<Self> {
        Self::new(around, move |v, w| Vector::new(length(v, w), 0.0), gradation_factor)
    }

    /// On a surface: the way from a vertex to a neighbour in the coordinates of the latter's tangent plane, and the x axis of the
    /// former's plane, taken to that by the smallest rotation.
    ///
    /// # Errors
    /// As of [`Gradation::on`].
    pub(crate) fn between_planes(
        around: Neighbours,
        offset: impl Fn(u32, u32) -> Vector + Sync + 'a,
        turn: impl Fn(u32, u32) -> Vector + Sync + 'a,
        gradation_factor: f64,
    ) -> Result<Self> {
        let law = Self::new(around, offset, gradation_factor)?;
        Ok(Self { turn: Some(Box::new(turn)), settled: SETTLED_BETWEEN_PLANES, ..law })
    }

    fn new(around: Neighbours, offset: impl Fn(u32, u32) -> Vector + Sync + 'a, gradation_factor: f64) -> Result<Self> {
        if !(gradation_factor >= 1.0 && gradation_factor.is_finite()) {
            let what = format!("gradation_factor = {gradation_factor} is not at least 1");
            let help = "1.3 lets edges grow by a third from one to the next; leave it out for no gradation";
            return Err(Error::parse("metric gradation", what, help));
        }
        Ok(Self {
            around,
            offset: Box::new(offset),
            turn: None,
            growth: gradation_factor.logarithm(),
            settled: SETTLED,
        })
    }

    /// [`Gradation::apply`] to sizes.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn apply_to_sizes(&self, sizes: &mut [f64]) -> Result<()> {
        let mut tensors: Vec<Tensor> = sizes.iter().map(|&h| Tensor::isotropic(h)).collect();
        self.apply(&mut tensors, &Limits::default())?;
        sizes.iter_mut().zip(tensors).for_each(|(h, tensor)| *h = 1.0 / tensor.xx.sqrt());
        Ok(())
    }

    /// Grades tensors that are within limits, and leaves them there: limits come first, where both cannot be had.
    ///
    /// # Errors
    /// [`Error::Limit`] where it does not settle.
    pub(crate) fn apply(&self, tensors: &mut [Tensor], limits: &Limits) -> Result<()> {
        let mut sources: Vec<Source> = tensors.par_iter().map(|&m| Source::new(m)).collect();
        let mut waiting = Waiting::all(tensors);
        let mut is_asking = vec![false; tensors.len()];
        let mut left = tensors.len() * (PATIENCE + 2 * self.around.hops());
        while let Some(asking) = waiting.next() {
            for &v in &asking {
                is_asking[v as usize] = true;
            }
            let beside = self.around.of_all(&asking);
            left = left.checked_sub(beside.len()).ok_or_else(|| unsettled(self.growth))?;
            let next = |&w: &u32| Some((w, self.finer(w, &sources, &is_asking, limits)?));
            let finer: Vec<(u32, Source)> = beside.par_iter().with_min_len(TOGETHER).filter_map(next).collect();
            for &v in &asking {
                is_asking[v as usize] = false;
            }
            for (w, source) in finer {
                waiting.add(w, source.tensor);
                sources[w as usize] = source;
            }
        }
        tensors.iter_mut().zip(sources).for_each(|(tensor, source)| *tensor = source.tensor);
        Ok(())
    }

    /// What a vertex becomes beside neighbours that have changed; `None` where that is what it was.
    fn finer(&self, w: u32, sources: &[Source], is_asking: &[bool], limits: &Limits) -> Option<Source> {
        let own = sources[w as usize].tensor;
        let most = own * (1.0 + self.settled);
        let mut asked = Vec::new();
        for &v in self.around.at(w as usize).iter().filter(|&&v| is_asking[v as usize]) {
            let turned = self.turn.as_ref().map(|turn| sources[v as usize].turned(turn(v, w)));
            let from = turned.as_ref().unwrap_or(&sources[v as usize]);
            // What is not finer here to begin with is not so when it has grown.
            if !is_above(own, from.tensor) {
                let grown = from.grown((self.offset)(v, w), self.growth);
                asked.extend((!is_above(most, grown)).then_some(grown));
            }
        }
        if asked.is_empty() {
            return None;
        }
        let finer = limits.at(w as usize).clamp(own.intersection_with_all(&asked));
        // Without limits it is: limits may take back what neighbours ask for.
        let is_finer = finer.determinant() > own.determinant() * (1.0 + 0.5 * self.settled);
        is_finer.then(|| Source::new(finer))
    }
}

fn unsettled(growth: f64) -> Error {
    let what = format!("gradation by the factor {} does not settle: {PATIENCE} rounds and more", growth.exponential());
    Error::limit(what, "choose a larger factor, or limit the anisotropy")
}

/// Whether one tensor is nowhere smaller than another.
fn is_above(tensor: Tensor, other: Tensor) -> bool {
    let rest = tensor + other * -1.0;
    rest.xx >= 0.0 && rest.yy >= 0.0 && rest.determinant() >= 0.0
}

/// A tensor that others are measured against.
struct Source {
    tensor: Tensor,
    axis: Vector,
    eigenvalues: [f64; 2],
}

impl Source {
    fn new(tensor: Tensor) -> Self {
        let e = tensor.eigen();
        Self { tensor, axis: e.axis, eigenvalues: [e.large, e.small] }
    }

    /// The same in coordinates in which the x axis is another.
    fn turned(&self, x: Vector) -> Self {
        let axis = Vector::new(x.x * self.axis.x - x.y * self.axis.y, x.y * self.axis.x + x.x * self.axis.y);
        let [large, small] = self.eigenvalues;
        Self { tensor: Tensor::from_axis(axis, large, small), axis, ..*self }
    }

    /// What it allows at an offset. With t an eighth powers are roots, which are faster than logarithms.
    fn grown(&self, offset: Vector, growth: f64) -> Tensor {
        const { assert!(GRADATION_EXPONENT == 0.125) };
        let all = 1.0 + growth * self.tensor.length(offset);
        let distance = growth * offset.norm();
        let [large, small] = self.eigenvalues.map(|value| {
            let own = 1.0 + distance * value.sqrt();
            // own^(-2 t) all^(-2 (1 - t))
            value * (all / own).sqrt().sqrt() / (all * all)
        });
        Tensor::from_axis(self.axis, large, small)
    }
}

/// The step from a level to the next, in the logarithm of the determinant: sizes that grow by 3 %. It is no number that metrics are
/// made with (digits of the golden ratio), so that their determinants do not lie just between two levels.
const STEP: f64 = 0.121_803_398_874_989_5;

/// Vertices in levels below the greatest determinant there was at first. Within a level they have no order: of determinants that
/// differ by rounding neither is the greater.
pub(super) struct Waiting {
    densest: f64,
    levels: BTreeMap<u32, Vec<u32>>,
    still_waits: Vec<bool>,
}

impl Waiting {
    /// All vertices.
    pub(super) fn all(tensors: &[Tensor]) -> Self {
        let densest = tensors.iter().map(|m| m.determinant()).fold(0.0, f64::max).logarithm();
        let mut all = Self { densest, levels: BTreeMap::new(), still_waits: vec![false; tensors.len()] };
        tensors.iter().enumerate().for_each(|(v, &tensor)| all.add(v as u32, tensor));
        all
    }

    /// A vertex with its metric of now, which is no coarser than it was.
    pub(super) fn add(&mut self, v: u32, tensor: Tensor) {
        let level = ((self.densest - tensor.determinant().logarithm()) / STEP) as u32;
        self.levels.entry(level).or_default().push(v);
        self.still_waits[v as usize] = true;
    }

    /// All of the densest level where any wait; they wait no longer. `None` where none wait.
    pub(super) fn next(&mut self) -> Option<Vec<u32>> {
        while let Some((_, mut all)) = self.levels.pop_first() {
            // Those that were taken from a denser level since.
            all.retain(|&v| std::mem::take(&mut self.still_waits[v as usize]));
            if !all.is_empty() {
                return Some(all);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_meshes::{grid, tensors_at};
    use super::*;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    /// The smallest of (v' M v) / (v' N v) over all v.
    fn least_ratio(m: Tensor, n: Tensor) -> f64 {
        let [a, b, c] = n.cholesky();
        let (p, q) = (Vector::new(1.0 / a, 0.0), Vector::new(-b / (a * c), 1.0 / c));
        Tensor::new(m.dot(p, p), m.dot(p, q), m.dot(q, q)).eigen().small
    }

    fn metrics(count: usize) -> impl Strategy<Value = Vec<Tensor>> {
        let one = (-2.0..3.0, 0.0..1.5, 0.0..std::f64::consts::PI).prop_map(|(size, ratio, angle): (f64, f64, f64)| {
            let axis = Vector::new(angle.cos(), angle.sin());
            Tensor::from_axis(axis, 10_f64.powf(size + ratio), 10_f64.powf(size - ratio))
        });
        proptest::collection::vec(one, count)
    }

    fn difference(m: Tensor, expected: Tensor) -> f64 {
        let d = m + expected * -1.0;
        (d.xx.abs() + d.xy.abs() + d.yy.abs()) / (expected.xx + expected.yy)
    }

    /// What a tensor allows at an offset, written as the law is.
    fn allowed(m: Tensor, offset: Vector, factor: f64) -> Tensor {
        let (t, beta) = (GRADATION_EXPONENT, factor.ln());
        m.map_eigenvalues(|value| {
            let h = 1.0 / value.sqrt();
            let grown = (1.0 + beta * offset.norm() / h).powf(t) * (1.0 + beta * m.length(offset)).powf(1.0 - t);
            1.0 / (h * grown).powi(2)
        })
    }

    proptest! {
        #![proptest_config(cases(64))]
        #[test]
        fn the_law_holds_along_every_edge(given in metrics(64), factor in 1.01..3.0_f64) {
            let mesh = grid(7, 0.4);
            let graded = grade(&mesh, &given, factor).unwrap();
            for (v, m) in graded.iter().enumerate() {
                prop_assert!(least_ratio(*m, given[v]) > 1.0 - 1e-6, "coarser than given at {v}");
            }
            for &[a, b, c] in &mesh.triangles {
                for [p, q] in [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]] {
                    let grown = allowed(graded[p as usize], mesh.point(q) - mesh.point(p), factor);
                    let ratio = least_ratio(graded[q as usize], grown);
                    prop_assert!(ratio > 1.0 - 1e-5, "{p} {q}: {ratio}");
                }
            }
        }

        #[test]
        fn graded_again_it_is_the_same_to_the_bit(given in metrics(64), factor in 1.0..3.0_f64) {
            let mesh = grid(7, 0.4);
            let graded = grade(&mesh, &given, factor).unwrap();
            prop_assert_eq!(grade(&mesh, &graded, factor).unwrap(), graded);
        }

        #[test]
        fn units_do_not_matter(given in metrics(64), power in -9.0..9.0_f64) {
            let mesh = grid(7, 0.4);
            let unit = 10_f64.powf(power);
            let points = mesh.points.iter().map(|p| p.map(|x| unit * x)).collect();
            let (small, scaled) = (Mesh { points, ..mesh.clone() }, given.iter().map(|&m| m * (1.0 / (unit * unit))));
            let found = grade(&small, &scaled.collect::<Vec<_>>(), 1.3).unwrap();
            for (m, expected) in found.into_iter().zip(grade(&mesh, &given, 1.3).unwrap()) {
                prop_assert!(difference(m * (unit * unit), expected) < 1e-8);
            }
        }

        #[test]
        fn numbers_of_vertices_do_not_matter(given in metrics(64), turn in 1_usize..64, step in (0_usize..32).prop_map(|k| 2 * k + 1)) {
            // Odd steps take all of 64 places once.
            let number = |v: usize| (step * v + turn) % 64;
            let mesh = grid(7, 0.4);
            let (mut renumbered, mut there) = (mesh.clone(), given.clone());
            for v in 0..64 {
                renumbered.points[number(v)] = mesh.points[v];
                there[number(v)] = given[v];
            }
            renumbered.triangles = mesh.triangles.iter().map(|t| t.map(|v| number(v as usize) as u32)).collect();
            let found = grade(&renumbered, &there, 1.3).unwrap();
            for (v, expected) in grade(&mesh, &given, 1.3).unwrap().into_iter().enumerate() {
                prop_assert!(difference(found[number(v)], expected) < 1e-8, "{v}");
            }
        }

        #[test]
        fn sizes_of_isotropic_metrics_are_the_largest_that_obey(sizes in proptest::collection::vec(-6.0..2.0_f64, 64)) {
            let (mesh, factor) = (grid(7, 0.4), 1.3_f64);
            let given: Vec<f64> = sizes.iter().map(|s| s.exp()).collect();
            let tensors: Vec<Tensor> = given.iter().map(|&h| Tensor::isotropic(h)).collect();
            // Of isotropic metrics both spaces are one: h grows by ln(factor) per length, along the shortest way over edges.
            let mut most = given.clone();
            for _ in 0..64 {
                for &[a, b, c] in &mesh.triangles {
                    for [p, q] in [[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]].map(|e| e.map(|v| v as usize)) {
                        let length = mesh.point(p as u32).distance(mesh.point(q as u32));
                        most[q] = most[q].min(most[p] + factor.ln() * length);
                    }
                }
            }
            for (m, h) in grade(&mesh, &tensors, factor).unwrap().into_iter().zip(most) {
                prop_assert!((m.xx.powf(-0.5) / h - 1.0).abs() < 1e-5 && (m.anisotropy() - 1.0).abs() < 1e-5, "{m:?} {h}");
            }
        }
    }

    #[test]
    fn uniform_metrics_stay() {
        let mesh = grid(7, 0.4);
        let given = vec![Tensor::new(500.0, -30.0, 3.0); 64];
        assert_eq!(grade(&mesh, &given, 1.05).unwrap(), given);
    }

    /// Two of three metrics ask for the same, mirrored: one after the other they would leave the third one turned to a side.
    #[test]
    fn what_is_symmetric_stays_so() {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.8, 0.0]];
        let mesh = Mesh { points, triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let strip = |x: f64| Tensor::from_axis(Vector::new(x, 0.8), 9.0, 1.0);
        let graded = grade(&mesh, &[strip(0.6), strip(-0.6), Tensor::new(9.0, 0.0, 1.0)], 1.1).unwrap();
        let mirrored = |m: Tensor| Tensor { xy: -m.xy, ..m };
        assert!(difference(mirrored(graded[0]), graded[1]) < 1e-14, "{graded:?}");
        assert!(difference(mirrored(graded[2]), graded[2]) < 1e-14, "{graded:?}");
        // And they do ask for more than there was.
        assert!(graded[0].determinant() > 20.0 && graded[2].determinant() > 20.0, "{graded:?}");
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let mesh = grid(40, 0.4);
        let given = tensors_at(&mesh, |p| {
            let angle = 40.0 * (p.x + p.y * p.y);
            Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 1e4 / (0.01 + p.x), 1e2)
        });
        let graded = |threads: usize| crate::test_cases::on_threads(threads, || grade(&mesh, &given, 1.2).unwrap());
        assert_eq!(graded(1), graded(3));
    }

    #[test]
    fn with_the_factor_one_there_is_one_metric() {
        let mesh = grid(3, 0.2);
        let given = tensors_at(&mesh, |p| Tensor::isotropic(0.1 + p.x));
        let graded = grade(&mesh, &given, 1.0).unwrap();
        assert!(graded.iter().all(|m| (m.xx / 100.0 - 1.0).abs() < 1e-4), "{graded:?}");
    }

    #[test]
    fn senseless_factors_are_named() {
        let mesh = grid(1, 0.0);
        for factor in [0.9, -1.0, f64::NAN, f64::INFINITY] {
            let error = grade(&mesh, &[Tensor::IDENTITY; 4], factor).unwrap_err();
            assert!(error.to_string().contains("metric gradation: gradation_factor"), "{error}");
        }
    }

    #[test]
    fn the_densest_come_first_and_those_alike_together() {
        let sized = |h: f64| Tensor::isotropic(h);
        // 1 and 3 differ by rounding, 0 and 2 do not.
        let mut waiting = Waiting::all(&[sized(1.0), sized(0.1), sized(2.0), sized(0.1 * (1.0 - 1e-15)), sized(1e-3)]);
        assert_eq!(waiting.next().unwrap(), [4]);
        assert_eq!(waiting.next().unwrap(), [1, 3]);
        // What becomes denser is taken once, before what was denser until then.
        waiting.add(2, sized(0.01));
        waiting.add(3, sized(0.02));
        let rest: Vec<_> = std::iter::from_fn(|| waiting.next()).collect();
        assert_eq!(rest, [[2], [3], [0]]);
    }

    #[test]
    fn any_determinant_has_a_level() {
        let sizes = [1e-150, 1e-70, 1.0, 1e70, 1e150];
        let mut waiting = Waiting::all(&sizes.map(Tensor::isotropic));
        let all: Vec<u32> = std::iter::from_fn(|| waiting.next()).flatten().collect();
        assert_eq!(all.len(), sizes.len());
    }
}

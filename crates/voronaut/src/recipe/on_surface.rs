//! The steps of a mesh on a surface.

use super::stopwatch::Stopwatch;
use super::surface_pass::{Checked, Pass, Reseed, Setting, demand};
use super::{MeshOptions, Meshed, Seeding};
use crate::dual::Moving;
use crate::error::{Error, Result};
use crate::manifold::Manifold;
use crate::manifold::surface::Component;
use crate::manifold::surface::metric::{SurfaceMetric, area_of_surface};
use crate::mesh::Mesh;
use crate::metric::{Expression, Norm};
use crate::optimise::{FitOptions, Patience, Polished, fit, polish_on_surface, polishing_norm};
use crate::quality::{self, Meetings, SurfaceFidelity, Validity, interpolation_error_on};
use crate::sampling::{MeasuredCurves, demand_memory};

/// Vertices of the triangles on which the surface is measured first: twice as many as are asked for, within this range; the most where no number is.
const MEASURING: [usize; 2] = [5_000, 20_000];
/// Where the number of vertices misses what was asked for by a greater share, a note says why.
const COUNT_TOLERANCE: f64 = 0.01;
/// Where a mesh is none, it is made anew, so often at most; more and more of the surface's own triangles are kept,
const ADAPTATIONS: usize = 8;
/// with so many steps of relaxation at most after the first time,
const FEWER_STEPS: usize = 8;
/// and the last times without.
const UNRELAXED: usize = 3;
/// Polishing may take the area of a mesh this much farther from the surface's, but for rounding: it knows the function's error alone, and
/// leaves large triangles where the function is even. On the unit sphere the area of 300 vertices for a front fell from 11.9 to 10.2.
const NEARLY: f64 = 1.25;
const ROUNDING: f64 = 1e-9;
/// Passes of farthest points, where these are asked for.
const FARTHEST_PASSES: usize = 5;

/// What a mesh is planned to be.
pub(super) struct SurfacePlan {
    /// The number of vertices.
    pub(super) count: usize,
    /// The factor on the metric for which edges then are of unit length.
    pub(super) scale: f64,
    /// The metric's complexity.
    pub(super) complexity: f64,
}

/// The area of a mesh.
fn area(mesh: &Mesh) -> f64 {
    let double = |&t: &[u32; 3]| {
        let [a, b, c] = mesh.positions_of(t);
        (b - a).cross(c - a).norm()
    };
    0.5 * mesh.triangles.iter().map(double).sum::<f64>()
}

/// The triangles of an equation are ours: where they meet, that is no property of what the user gave.
fn demand_apart(manifold: &Manifold, meetings: &Meetings) -> Result<()> {
    match manifold.equation().and_then(|_| meetings.first()) {
        None => Ok(()),
        Some(place) => {
            let help = "give an equation whose sheets stay apart, or shorter edges for its triangles";
            Err(Error::domain("triangles of f = 0 meet: sheets are too close there", place.to_string(), help))
        }
    }
}

impl<'a> Setting<'a> {
    /// What a surface is meshed with.
    ///
    /// # Errors
    /// [`Error::Domain`] where triangles of an equation's surface meet.
    pub(super) fn new(
        manifold: &'a Manifold,
        metric: &'a dyn SurfaceMetric,
        aim: Option<(&'a Expression, Norm)>,
        options: &'a MeshOptions,
        meetings: &'a Meetings,
        watch: &'a Stopwatch<'a>,
    ) -> Result<Self> {
        demand_apart(manifold, meetings)?;
        let curves = MeasuredCurves::new(manifold, metric);
        Ok(Self { manifold, metric, aim, options, progress: watch.progress, curves, meetings, watch })
    }

    /// That the work for so many vertices fits into memory.
    fn demand_memory(&self, count: usize) -> Result<()> {
        let canvas = if self.needs_canvas() { self.canvas_size(count) } else { 0 };
        demand_memory(count as f64, canvas as f64, self.options.memory_limit)
    }

    /// A mesh with so many vertices, and how far it is from the surface, if that is asked for. Where what comes out is no mesh,
    /// or folded, it is made again with more of the surface there.
    pub(super) fn meshed(&self, count: usize, scale: f64) -> Result<(Meshed, Option<SurfaceFidelity>)> {
        let mut reseed = Reseed::default();
        let mut notes = Vec::new();
        let (mut pass, mut checked) = loop {
            let Some(mut pass) = self.passed(count, scale, &mut reseed)? else { continue };
            let mut checked = self.checked(&pass)?;
            if checked.faulty.is_empty() && self.steps(&reseed).is_some() && self.settle_edges(&mut pass)? {
                checked = self.checked(&pass)?;
            }
            if checked.faulty.is_empty() && self.steps(&reseed).is_none() {
                checked = self.without_needles(&mut pass, checked)?;
            }
            if checked.faulty.is_empty() || reseed.is_last {
                break (pass, checked);
            }
            reseed = pass.reseed(&checked.faulty, reseed);
            reseed.is_last = reseed.rounds + 1 >= self.farthest_passes() + ADAPTATIONS;
        };
        let is_sound = checked.faulty.is_empty();
        let polished = match self.aim.filter(|_| is_sound && self.polishes()) {
            Some((function, norm)) => Some(self.polished(&mut pass, &mut checked, function, norm, &mut notes)?),
            None => None,
        };
        let protected = if is_sound { self.protect(&mut pass, &mut checked, &mut notes)? } else { None };
        let Checked { mesh, validity, .. } = checked;
        demand(self.manifold, &mesh, &validity)?;
        let (surface_net, protection) = match protected {
            Some((net, protection)) => (Some(net), Some(protection)),
            None => (self.options.net.then(|| self.net(&pass)), None),
        };
        let farthest = self.farthest_passes();
        if farthest > 0 && reseed.rounds >= farthest {
            notes.push("farthest points made no mesh: seeds are of the surface's own triangles".into());
        }
        notes.extend(reseed.note());
        notes.extend(pass.notes());
        notes.extend(self.count_note(&pass, mesh.points.len()));
        let (mesh, validity) = self.watch.time("fit", || self.fitted(mesh, validity, &mut notes))?;
        let fidelity = self.watch.time("check", || self.fidelity(&mesh))?;
        let meshed = Meshed {
            mesh,
            validity,
            metric_scale: pass.dual.factor(),
            dual: pass.settled.dual,
            relaxation: pass.relaxed,
            polished,
            canvas: pass.settled.canvas,
            diagram: pass.settled.diagram,
            surface_net,
            protection,
            notes,
            ..Meshed::default()
        };
        Ok((meshed, fidelity))
    }

    /// A pass by what there was before: where farthest points are asked for, of these, as long as that may make a mesh. Nothing where
    /// they find no triangulation, for the surface's own may.
    fn passed(&self, count: usize, scale: f64, reseed: &mut Reseed) -> Result<Option<Pass<'a>>> {
        let farthest = self.farthest_passes();
        let is_farthest = reseed.rounds < farthest;
        match self.pass(count, scale, reseed, is_farthest, self.steps(reseed)) {
            Err(Error::Domain { .. }) if is_farthest => {
                reseed.rounds = farthest;
                Ok(None)
            }
            other => other.map(Some),
        }
    }

    /// Steps of relaxation, in the last passes not even none.
    fn steps(&self, reseed: &Reseed) -> Option<usize> {
        let lloyd = self.options.lloyd;
        match reseed.rounds.saturating_sub(self.farthest_passes()) {
            0 => Some(lloyd),
            rounds if rounds + UNRELAXED < ADAPTATIONS => Some(lloyd.min(FEWER_STEPS)),
            _ => None,
        }
    }

    /// The mesh of a pass, and what is found of it.
    pub(super) fn checked(&self, pass: &Pass) -> Result<Checked> {
        self.watch.time("check", || {
            self.progress.begin("checking", 1)?;
            Ok(pass.checked(self.meetings))
        })
    }

    /// The mesh of a pass that was not relaxed, its needles mended where that is still a mesh.
    fn without_needles(&self, pass: &mut Pass, checked: Checked) -> Result<Checked> {
        let before = pass.dual.save();
        if !pass.mend_needles() {
            return Ok(checked);
        }
        let mended = self.checked(pass)?;
        if mended.faulty.is_empty() {
            return Ok(mended);
        }
        pass.dual.take_back(&before);
        Ok(checked)
    }

    /// Whether a mesh for a function is polished, which would undo protection.
    fn polishes(&self) -> bool {
        self.options.polish > 0 && self.options.seeding != Seeding::Protected
    }

    /// Polishes a mesh for a function; where what comes out is no mesh, or no better one by the surface itself, it stays as it was.
    fn polished(
        &self,
        pass: &mut Pass,
        checked: &mut Checked,
        function: &Expression,
        norm: Norm,
        notes: &mut Vec<String>,
    ) -> Result<Polished> {
        let sweeps = self.options.polish;
        let patience = Patience { steps: sweeps, gain: self.options.effort.gain_of_polishing() };
        let before = pass.dual.save();
        let polished = self.watch.time("polish", || {
            self.progress.begin("polishing", sweeps as u64)?;
            polish_on_surface(&mut pass.dual, function, norm, patience, self.progress)
        })?;
        let (better, mesh) = (self.checked(pass)?, &checked.mesh);
        let stray = |mesh: &Mesh| (self.manifold.area() - area(mesh)).abs();
        let is_as_near = stray(&better.mesh) <= NEARLY * stray(mesh) + ROUNDING * self.manifold.area();
        // Polishing takes the surface to be smooth between vertices.
        let error = |mesh: &Mesh| Ok(interpolation_error_on(mesh, self.manifold, function, polishing_norm(norm))?.norm);
        let why = if !better.faulty.is_empty() {
            format!("{} triangles would meet or fold over", better.faulty.len())
        } else if !is_as_near {
            "where the function is even, triangles would be too large for the surface".into()
        } else if error(&better.mesh)? > error(mesh)? {
            "between vertices the surface is too uneven to say how the function goes there".into()
        } else {
            *checked = better;
            return Ok(polished);
        };
        pass.dual.take_back(&before);
        notes.push(format!("not polished: {why}"));
        Ok(Polished { error: polished.error.into_iter().take(1).collect(), ..Polished::default() })
    }

    fn farthest_passes(&self) -> usize {
        if self.options.seeding == Seeding::Farthest { FARTHEST_PASSES } else { 0 }
    }

    /// What to say where the mesh has not the number of vertices asked for.
    fn count_note(&self, pass: &Pass, found: usize) -> Option<String> {
        let asked = self.options.vertices?;
        if (found as f64 - asked as f64).abs() <= COUNT_TOLERANCE * asked as f64 {
            return None;
        }
        let on_features = pass.vertices_on_features();
        let why = if on_features > asked {
            format!(
                "{on_features} are on features, which are kept: ask for more, raise the angle from which edges are creases, or \
                 leave creases out"
            )
        } else if found > asked {
            "fewer do not make a mesh of this surface, or not without folds: ask for more, or for less anisotropy"
                .into()
        } else {
            "there is no room for more: ask for fewer".into()
        };
        Some(format!("{found} vertices where {asked} were asked for: {why}"))
    }

    /// The mesh with its vertices at least-squares positions, if that is asked for; as it was where that would not be valid.
    fn fitted(&self, mesh: Mesh, validity: Validity, notes: &mut Vec<String>) -> Result<(Mesh, Validity)> {
        if !self.options.fit {
            return Ok((mesh, validity));
        }
        self.progress.begin("fitting", 1)?;
        let options = FitOptions { stiffness: self.options.stiffness, ..FitOptions::default() };
        let manifold = self.manifold;
        let fine = manifold.equation().map(|_| self.fine_surface(mesh.points.len())).transpose()?;
        let fitted = fit(&mesh, fine.as_ref().unwrap_or(manifold), &options)?.mesh;
        let found = quality::validity_on(&fitted, self.meetings);
        if found.valid {
            return Ok((fitted, found));
        }
        notes.push("vertices are on the surface: least-squares positions would not make a valid mesh".into());
        Ok((mesh, validity))
    }

    pub(super) fn fidelity(&self, mesh: &Mesh) -> Result<Option<SurfaceFidelity>> {
        if self.options.hausd.is_none() && !self.options.fit {
            return Ok(None);
        }
        quality::surface_fidelity(mesh, self.manifold).map(Some)
    }

    /// The number of vertices, the factor on the metric for which edges then are of unit length, if it is not known, and the metric's complexity.
    ///
    /// A triangulation with V vertices has 2 (V - chi) - B faces, B of its edges on the border; each has the area sqrt(3) / 4.
    pub(super) fn plan(&self, known: Option<f64>) -> Result<SurfacePlan> {
        self.progress.begin("planning", 1)?;
        let [least, most] = MEASURING;
        let measuring = self.options.vertices.map_or(most, |count| count.saturating_mul(2).clamp(least, most));
        let area = area_of_surface(self.manifold, self.metric, measuring)?;
        // Of the surface as it was before it was cut: vertices on its cuts count once.
        let chi = self.manifold.whole().euler as f64;
        let extra = self.curves.extra();
        let vertices = |factor: f64| 2.0 / 3.0_f64.sqrt() * area * factor + extra * factor.sqrt() + chi;
        let (count, factor) = match (self.options.vertices, known.or(self.options.complexity.map(|all| all / area))) {
            (Some(count), _) => {
                // The square root of the factor by the quadratic formula.
                let (a, b, c) = (2.0 / 3.0_f64.sqrt() * area, extra, chi - count as f64);
                let root = ((b * b - 4.0 * a * c.min(0.0)).sqrt() - b) / (2.0 * a);
                (count, root * root)
            }
            (None, factor) => {
                let factor = factor.unwrap_or(1.0);
                (vertices(factor).round() as usize, factor)
            }
        };
        // Patches with a border have their vertices there.
        let is_closed = |component: &Component| component.borders == 0;
        let least = 4 * self.manifold.components().into_iter().filter(is_closed).count();
        self.demand_memory(count)?;
        let scale = if factor > 0.0 { factor } else { 1.0 };
        Ok(SurfacePlan { count: count.max(least), scale, complexity: area })
    }
}

#[cfg(test)]
mod tests {
    use super::super::mesh_surface;
    use super::super::{GradedAt, MetricOptions, SurfaceSource, metric_on_surface};
    use super::*;
    use crate::manifold::surface::metric::Spec;
    use crate::progress::Silent;

    /// A front on triangles with creases: polishing lowers the error that is measured elsewhere, keeps the
    /// number of vertices and their surface, and never raises its own.
    #[test]
    fn polishing_lowers_the_error_on_surfaces() {
        let cube = Manifold::of(&crate::test_cases::cube(9, 0.0)).unwrap();
        for (manifold, text) in [(cube, "tanh(6*(x + y*z - 0.5))")] {
            let spec = Spec::parse(&format!("hessian:{text}")).unwrap();
            let Spec::Hessian(function) = &spec else { panic!("of a function") };
            let (count, norm) = (500, Norm::default());
            let at = GradedAt::of(Some(count), None);
            let metric =
                metric_on_surface(SurfaceSource::Named(&spec), &manifold, &MetricOptions::default(), at).unwrap();
            let made = |polish: usize| {
                let options = MeshOptions { vertices: Some(count), polish, lloyd: 10, ..MeshOptions::default() };
                mesh_surface(&manifold, metric.as_ref(), Some((function, norm)), &options, &Silent).unwrap()
            };
            let (plain, polished) = (made(0), made(10));
            let error = |made: &Meshed| interpolation_error_on(&made.mesh, &manifold, function, norm).unwrap().norm;
            let figures = polished.polished.as_ref().unwrap();
            assert!(plain.polished.is_none() && polished.mesh.points.len() == plain.mesh.points.len());
            assert!(figures.moves > 0 && figures.error.windows(2).all(|two| two[1] <= two[0]), "{figures:?}");
            let [first, last] = [figures.error[0], figures.error[figures.error.len() - 1]];
            let [before, after] = [error(&plain), error(&polished)];
            assert!(after < 0.95 * before, "{text}: {before} {after}");
            // Where it is seen to second order from a triangle, and by seven values, it is what walks to the surface find.
            assert!((first / before - 1.0).abs() < 0.05 && (last / after - 1.0).abs() < 0.05, "{first} {last}");
            assert!(quality::validity_on(&polished.mesh, &Meetings::of(manifold.whole_mesh())).valid);
            for &p in &polished.mesh.points {
                let place = manifold.closest(p.into()).unwrap();
                assert!(place.position.distance(p.into()) < 1e-9, "{p:?}");
            }
        }
    }

    /// On bumps as large as triangles what polishing takes for the surface between vertices is not there.
    #[test]
    fn polishing_does_not_raise_the_error_on_uneven_surfaces() {
        let mut bumpy = crate::metric::nodal::test_meshes::grid(40, 0.0);
        for p in &mut bumpy.points {
            p[2] = 0.02 * (25.0 * p[0]).sin() * (25.0 * p[1]).sin();
        }
        let manifold = Manifold::of(&bumpy).unwrap();
        let spec = Spec::parse("hessian:tanh(10*(x + 0.1*sin(5*y) - 0.5 + z))").unwrap();
        let Spec::Hessian(function) = &spec else { panic!("of a function") };
        let at = GradedAt::of(Some(300), None);
        let metric = metric_on_surface(SurfaceSource::Named(&spec), &manifold, &MetricOptions::default(), at).unwrap();
        let made = |polish: usize| {
            let options = MeshOptions { vertices: Some(300), polish, lloyd: 10, ..MeshOptions::default() };
            mesh_surface(&manifold, metric.as_ref(), Some((function, Norm::default())), &options, &Silent).unwrap()
        };
        let (plain, polished) = (made(0), made(10));
        let error =
            |made: &Meshed| interpolation_error_on(&made.mesh, &manifold, function, Norm::default()).unwrap().norm;
        assert!(error(&polished) <= error(&plain));
        assert!(polished.notes.iter().any(|note| note.contains("too uneven")), "{:?}", polished.notes);
    }

    /// Away from a front the error asks for no small triangles, and the sphere does.
    #[test]
    fn polishing_does_not_leave_the_surface() {
        let sphere = Manifold::shape("sphere:1", Some(0.1)).unwrap();
        let spec = Spec::parse("hessian:tanh(8*(x - 0.3 + 0.2*y))").unwrap();
        let Spec::Hessian(function) = &spec else { panic!("of a function") };
        let at = GradedAt::of(Some(500), None);
        let metric = metric_on_surface(SurfaceSource::Named(&spec), &sphere, &MetricOptions::default(), at).unwrap();
        let options = MeshOptions { vertices: Some(500), polish: 10, lloyd: 10, ..MeshOptions::default() };
        let aim = Some((function, Norm::default()));
        let made = mesh_surface(&sphere, metric.as_ref(), aim, &options, &Silent).unwrap();
        assert!(made.notes.iter().any(|note| note.starts_with("not polished: ")), "{:?}", made.notes);
        assert!(area(&made.mesh) > 0.97 * 4.0 * std::f64::consts::PI, "{}", area(&made.mesh));
    }
}

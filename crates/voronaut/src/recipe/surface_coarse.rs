//! Seeds on a surface from those of coarser meshes, which are relaxed and whose edges are then halved, as [`coarse`](super::coarse) does in the
//! plane.

use super::coarse::{PATIENCE, PAYS, factor};
use super::options::{Centroid, Seeding};
use super::surface_pass::{Parts, Reseed, Setting, Started};
use crate::dual::{Moving, SurfaceDual};
use crate::error::Result;
use crate::manifold::Place;
use crate::optimise::{Cells, Patience};
use crate::progress::Within;
use crate::sampling::{Adapted, FeatureSeeds, Halving, Holding, Wanted, adapted, contracted, halved};
use crate::triangulation::VertexId;

/// The coarsest mesh has at least so many vertices. With 400 meshes of 2,000 took 0.98 of the time at the median of five surfaces.
const COARSEST: usize = 1000;
/// Steps of relaxation after which so great a share of the coarsest mesh's edges is to be of unit length. It is 0.97 to 0.98 where the metric is even (a cube, a
/// patch, an alligator, bob, spot). Without that mean quality was lower by 0.003 to 0.01, and unit edges were fewer by 0.3 to 3 % (meshes of 6,000 from some with
/// 0.88 to 0.956: cheburashka, fandisk, a rocker arm, the bunny), in 0.9 to 1.3 of the time.
const STEPS: usize = 4;
const RESOLVED: f64 = 0.96;

/// Seeds on features, and meshes of ever fewer of them.
struct Levels {
    features: FeatureSeeds,
    /// Their places, and the seed that each belongs to.
    given: Vec<Place>,
    owners: Vec<u32>,
    /// The finest mesh first.
    meshes: Vec<Level>,
}

/// What a mesh is to have.
struct Level {
    /// Which of the seeds on features.
    on_features: Vec<bool>,
    /// How many places on them, and seeds inside patches.
    count: usize,
}

/// A mesh in the making, and how many of its seeds stay.
struct Coarse<'a> {
    dual: SurfaceDual<'a>,
    staying: usize,
}

impl<'a> Setting<'a> {
    /// Seeds of the coarsest mesh that resolves the metric, relaxed, and those in the middles of its edges, and so on; where there is none, seeds
    /// of the surface's own triangles. Of a surface with more vertices than are wanted these are made first: to get rid of the others takes longest.
    pub(super) fn started_from_coarser(&self, count: usize, scale: f64, reseed: &mut Reseed) -> Result<Started> {
        let is_plain = self.options.seeding == Seeding::Sizing && self.options.centroid == Centroid::Tangent;
        let is_large = self.manifold.positions().len() > count;
        let mut direct = None;
        if is_large || !is_plain {
            direct = Some(self.started_from_surface(count, scale, reseed)?);
        }
        if is_plain {
            let levels = Levels::new(self.featured(count, scale, reseed));
            if let Some((level, coarse)) = self.coarsest(&levels, scale, direct.as_ref())?
                && let Some(adapted) = self.refined(&levels, level, coarse)?
            {
                let Levels { features, owners, .. } = levels;
                return Ok(Started { features, owners, adapted, is_even: true, canvas: None });
            }
        }
        direct.map_or_else(|| self.started_from_surface(count, scale, reseed), Ok)
    }

    /// The coarsest mesh that resolves the metric, as a few steps of relaxation tell, and its level.
    fn coarsest(&self, levels: &Levels, scale: f64, direct: Option<&Started>) -> Result<Option<(usize, Coarse<'a>)>> {
        for (level, mesh) in levels.meshes.iter().enumerate().skip(1).rev() {
            let factor = factor(scale, level);
            let adapted = match direct {
                Some(direct) => Some(levels.contracted(self, mesh, factor, &direct.adapted)),
                None => levels.adapted(self, mesh, factor),
            };
            let Some(adapted) = adapted.filter(|adapted| adapted.stuck.is_empty()) else { continue };
            let (staying, dual) = (adapted.staying, self.unfolded(adapted, factor)?);
            let dual = self.relaxed_on_the_way(
                dual,
                staying,
                Parts { most: 1, ..Parts::EVEN },
                Patience { steps: STEPS, ..PATIENCE },
            )?;
            if dual.unit_share() >= RESOLVED {
                return Ok(Some((level, Coarse { dual, staying })));
            }
        }
        Ok(None)
    }

    fn relaxed_on_the_way(
        &self,
        dual: SurfaceDual<'a>,
        staying: usize,
        parts: Parts,
        patience: Patience,
    ) -> Result<SurfaceDual<'a>> {
        Ok(self.relaxed_in_parts(dual, staying, &Cells::Tangent, parts, patience, &Within(self.progress))?.0)
    }

    /// Relaxes a mesh and halves its edges, down to the finest level; nothing where that fails.
    fn refined(&self, levels: &Levels, level: usize, coarse: Coarse<'a>) -> Result<Option<Adapted>> {
        let Coarse { mut dual, mut staying } = coarse;
        for finer in (0..level).rev() {
            let [coarser, mesh] = [finer + 1, finer].map(|level| &levels.meshes[level]);
            let relaxed = self.relaxed_on_the_way(dual, staying, Parts::EVEN, PATIENCE)?;
            let (given, factor) = (levels.given_to(mesh), 4.0 * relaxed.factor());
            let halving = Halving {
                places: relaxed.places(),
                topology: relaxed.topology(),
                given: &given,
                are_there: &levels.are_in(mesh, coarser),
                factor,
                count: mesh.count,
            };
            let adapted = halved(self.manifold, self.metric, &halving);
            if !adapted.stuck.is_empty() || adapted.staying != given.len() {
                return Ok(None);
            }
            if finer == 0 {
                return Ok(Some(adapted));
            }
            staying = adapted.staying;
            dual = self.unfolded(adapted, factor)?;
        }
        Ok(None)
    }
}

impl Levels {
    fn new((features, given, owners, total): (FeatureSeeds, Vec<Place>, Vec<u32>, usize)) -> Self {
        let all = Level { on_features: vec![true; features.seeds.len()], count: total };
        let mut levels = Self { features, given, owners, meshes: vec![all] };
        while let Some(coarser) = levels.coarser(&levels.meshes[levels.meshes.len() - 1]) {
            levels.meshes.push(coarser);
        }
        levels
    }

    /// A mesh whose halved edges give another one, if it has few enough vertices, and not too few: inside patches there are three times as many
    /// edges as vertices, but for twice those on the border.
    fn coarser(&self, finer: &Level) -> Option<Level> {
        let on_features = self.features.every_other(&finer.on_features);
        let mut coarser = Level { on_features, count: 0 };
        let [here, there] = [&coarser, finer].map(|level| self.given_to(level).len());
        coarser.count = (finer.count + 3 * here).saturating_sub(there) / 4;
        let pays = coarser.count >= COARSEST && coarser.count as f64 <= PAYS * finer.count as f64;
        pays.then_some(coarser)
    }

    /// The places on features that are a mesh's.
    fn given_to(&self, mesh: &Level) -> Vec<Place> {
        let there = self.given.iter().zip(&self.owners).filter(|(_, owner)| mesh.on_features[**owner as usize]);
        there.map(|(place, _)| *place).collect()
    }

    /// Of a mesh's places on features, which are a coarser one's.
    fn are_in(&self, mesh: &Level, coarser: &Level) -> Vec<bool> {
        let there = self.owners.iter().map(|&owner| owner as usize).filter(|&owner| mesh.on_features[owner]);
        there.map(|owner| coarser.on_features[owner]).collect()
    }

    /// The surface's own triangles, adapted to a mesh.
    fn adapted(&self, setting: &Setting, mesh: &Level, factor: f64) -> Option<Adapted> {
        let (given, held) = (self.given_to(mesh), Holding::Near(&[]));
        adapted(setting.manifold, setting.metric, &Wanted { given: &given, factor, count: mesh.count, held })
    }

    /// The finest triangulation contracted to a coarser one.
    fn contracted(&self, setting: &Setting, mesh: &Level, factor: f64, finest: &Adapted) -> Adapted {
        let kept = (0..).zip(self.are_in(&self.meshes[0], mesh)).filter(|(_, is_kept)| *is_kept);
        let kept: Vec<VertexId> = kept.map(|(i, _)| VertexId(i)).collect();
        let triangles = (finest.topology.clone(), finest.places.clone());
        contracted(setting.manifold, setting.metric, factor, triangles, &kept, kept.len(), mesh.count)
    }
}

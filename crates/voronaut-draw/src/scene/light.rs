//! Light on triangles: from samples to pixels.

use super::super::colours;
use super::Scene;
use super::depth::{DepthMap, Facet, NONE, SAMPLES};
use super::view::Camera;
use rayon::prelude::*;
use voronaut::geometry::Vector3;

/// Where the light comes from: the left, above, the front.
const LIGHT: Vector3 = Vector3::new(-0.48, 0.62, 0.62);
/// Light from everywhere, from the lamp, and from the sky above.
const AMBIENT: f64 = 0.38;
const LAMP: f64 = 0.64;
const SKY: f64 = 0.12;
/// How far the lamp's light reaches around a body, as a cosine.
const WRAP: f64 = 0.25;
/// The strength of highlights and how small they are.
const GLOSS: f64 = 0.05;
const SHARPNESS: i32 = 24;
/// How much darker surfaces are that are seen from the side.
const RIM: f64 = 0.35;
/// What is left of red, green and blue on the back of a triangle.
const BACK: [f64; 3] = [0.62, 0.54, 0.50];

/// What light needs to know of a triangle.
struct Lit {
    facet: Facet,
    facing: f64,
    normals: [Vector3; 3],
    colour: [f64; 3],
}

/// The triangles of a scene, ready for the light.
pub(super) struct Bodies {
    /// Which of them is nearest where.
    pub(super) map: DepthMap,
    lit: Vec<Lit>,
}

impl Bodies {
    /// Takes the triangles of a scene that are finite.
    pub(super) fn new(scene: &Scene, camera: &Camera) -> Self {
        let mut map = DepthMap::new(camera.frame.size());
        let mut lit = Vec::with_capacity(scene.triangles.len());
        for triangle in &scene.triangles {
            let [Some(a), Some(b), Some(c)] = triangle.corners.map(|p| camera.place(p)) else { continue };
            let facet = Facet::new([a, b, c]);
            map.enter(lit.len() as u32, &facet);
            let [x, y, z] = facet.normal();
            let flat = Vector3::new(x, y, z).unit().unwrap_or(Vector3::new(0.0, 0.0, 1.0));
            // Normals are turned to the side that is seen.
            let seen = |n: Vector3| if n.dot(flat) < 0.0 { -n } else { n };
            let normals = triangle
                .normals
                .map_or([flat; 3], |normals| normals.map(|n| seen(camera.turn(n).unit().unwrap_or(flat))));
            lit.push(Lit { facet, facing: flat.z, normals, colour: colours::decode(&triangle.fill.colour()) });
        }
        Self { map, lit }
    }

    /// The triangle with a number of the map.
    pub(super) fn facet(&self, id: u32) -> &Facet {
        &self.lit[id as usize].facet
    }

    /// The cosine between the triangle's normal and the direction to the eye.
    pub(super) fn facing(&self, id: u32) -> f64 {
        self.lit[id as usize].facing
    }

    /// Red, green and blue of each pixel, row by row; white where nothing is. What is seen of more than the other is
    /// taken for the front, so that surfaces turned inside out look like others.
    pub(super) fn pixels(&self) -> Vec<[u8; 3]> {
        let map = &self.map;
        let seen = || map.nearest.par_iter().filter(|&&id| id != NONE);
        let fronts = seen().filter(|&&id| self.facet(id).is_front()).count();
        let front = 2 * fronts >= seen().count();
        let columns = map.width / SAMPLES;
        let at = |pixel: usize| self.pixel([pixel % columns, pixel / columns], front);
        (0..columns * (map.height / SAMPLES)).into_par_iter().map(at).collect()
    }

    fn pixel(&self, [column, row]: [usize; 2], front: bool) -> [u8; 3] {
        let mut sum = [0.0; 3];
        for sample in 0..SAMPLES * SAMPLES {
            let [x, y] = [column * SAMPLES + sample % SAMPLES, row * SAMPLES + sample / SAMPLES];
            let light = match self.map.nearest[y * self.map.width + x] {
                NONE => [1.0; 3],
                id => self.lit[id as usize].at(x as f64 + 0.5, y as f64 + 0.5, front),
            };
            sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
        }
        sum.map(|sum| colours::encode(sum / (SAMPLES * SAMPLES) as f64))
    }
}

impl Lit {
    /// The light that comes from a point of the picture, given in samples.
    fn at(&self, x: f64, y: f64, front: bool) -> [f64; 3] {
        let weights = self.facet.weights(x, y);
        let sum = weights.iter().zip(self.normals).fold(Vector3::default(), |sum, (w, n)| sum + n * w.clamp(0.0, 1.0));
        let n = sum.unit().unwrap_or(self.normals[0]);
        let [light, gloss] = light(n);
        let is_front = self.facet.is_front() == front;
        let side = if is_front { [1.0; 3] } else { BACK };
        [0, 1, 2].map(|i| (self.colour[i] * side[i] * light + gloss).min(1.0))
    }
}

/// How much light a surface with this unit normal takes from its colour, and what it mirrors besides.
fn light(n: Vector3) -> [f64; 2] {
    let lamp = LIGHT.unit().unwrap_or(LIGHT);
    let half = (lamp + Vector3::new(0.0, 0.0, 1.0)).unit().unwrap_or(lamp);
    let diffuse = ((n.dot(lamp) + WRAP) / (1.0 + WRAP)).max(0.0);
    let rim = 1.0 - RIM * (1.0 - n.z.clamp(0.0, 1.0)).powi(3);
    [(AMBIENT + LAMP * diffuse + SKY * (0.5 + 0.5 * n.y)) * rim, GLOSS * n.dot(half).max(0.0).powi(SHARPNESS)]
}

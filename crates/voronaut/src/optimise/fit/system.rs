//! The least-squares problem of one step, and its solution by conjugate gradients.

use super::samples::Pair;
use crate::geometry::{Tensor3, Vector3};
use crate::triangulation::{Triangulation, VertexId};

/// Normal equations of a Gauss-Newton step: with the weights of every pair held, moves of vertices that close the gaps
/// best. Kept by triangles, each with the blocks of its pairs of corners.
pub(super) struct System<'a> {
    topology: &'a Triangulation,
    /// Blocks of corners 00, 11, 22, 01, 12, 20.
    blocks: Vec<[Tensor3; 6]>,
    right: Vec<Vector3>,
    diagonal: Vec<Tensor3>,
    free: &'a [bool],
}

/// What keeps vertices from sliding: of each how far it is from where it began, and the unit normal there.
pub(super) struct Anchors {
    pub(super) lines: Vec<(Vector3, Vector3)>,
    /// Stiffness of the springs, as a share of a vertex's own.
    pub(super) stiffness: f64,
}

/// Conjugate gradients end where the residual is this part of the first one, ...
const RESIDUAL: f64 = 1e-8;
/// ... or after so many steps; what has been found by then lowers the energy, too.
const MOST_STEPS: usize = 300;

impl<'a> System<'a> {
    /// The system of these pairs; vertices that are not free do not move.
    pub(super) fn new(topology: &'a Triangulation, free: &'a [bool], pairs: impl Iterator<Item = Pair>) -> Self {
        let mut blocks = vec![[Tensor3::default(); 6]; topology.face_slots()];
        let mut right = vec![Vector3::default(); free.len()];
        let mut diagonal = vec![Tensor3::default(); free.len()];
        for pair in pairs {
            let square = Tensor3::square(pair.direction) * pair.weight;
            let of_face = &mut blocks[pair.face.index()];
            for (i, v) in topology.corners(pair.face).into_iter().enumerate() {
                let (w, next) = (pair.weights[i], pair.weights[(i + 1) % 3]);
                of_face[i] = of_face[i] + square * (w * w);
                of_face[3 + i] = of_face[3 + i] + square * (w * next);
                right[v.index()] = right[v.index()] + pair.direction * (pair.weight * pair.gap * w);
                diagonal[v.index()] = diagonal[v.index()] + square * (w * w);
            }
        }
        Self { topology, blocks, right, diagonal, free }
    }

    /// Moves of all vertices that solve the system with `damping` times the mean of its diagonal at every vertex added to it
    /// (Levenberg 1944, Marquardt 1963): along flat parts, where gaps say nothing, vertices stay. And with springs, so many times as
    /// stiff, that pull every vertex back to the line through its anchor.
    pub(super) fn solve(&self, damping: f64, anchors: &Anchors) -> Vec<Vector3> {
        let mean = |d: &Tensor3| (d.xx + d.yy + d.zz) / 3.0;
        let springs = self.diagonal.iter().zip(&anchors.lines).map(|(d, &(_, along))| {
            (Tensor3::IDENTITY + Tensor3::square(along) * -1.0) * (anchors.stiffness * mean(d))
        });
        let springs: Vec<Tensor3> = springs.collect();
        let added: Vec<Tensor3> = self
            .diagonal
            .iter()
            .zip(&springs)
            .map(|(d, &spring)| Tensor3::IDENTITY * (damping * mean(d)) + spring)
            .collect();
        let inverse: Vec<Tensor3> = self.diagonal.iter().zip(&added).map(|(&d, &a)| inverted(d + a)).collect();
        let pulls = springs.iter().zip(&anchors.lines).map(|(spring, &(away, _))| spring.apply(away));
        let right: Vec<Vector3> = self.right.iter().zip(pulls).map(|(&r, pull)| r - pull).collect();
        let free = |v: &[Vector3]| -> Vec<Vector3> {
            v.iter().zip(self.free).map(|(&v, &free)| if free { v } else { Vector3::default() }).collect()
        };
        let mut x = vec![Vector3::default(); self.free.len()];
        let mut rest = free(&right);
        let mut conditioned = precondition(&inverse, &rest);
        let mut along = conditioned.clone();
        let mut rho = dot(&rest, &conditioned);
        let enough = rho * RESIDUAL * RESIDUAL;
        for _ in 0..MOST_STEPS {
            let image = free(&self.apply(&added, &along));
            let curvature = dot(&along, &image);
            if rho <= enough || curvature <= 0.0 {
                break;
            }
            let length = rho / curvature;
            add(&mut x, &along, length);
            add(&mut rest, &image, -length);
            conditioned = precondition(&inverse, &rest);
            let next = dot(&rest, &conditioned);
            for (a, &c) in along.iter_mut().zip(&conditioned) {
                *a = c + *a * (next / rho);
            }
            rho = next;
        }
        x
    }

    fn apply(&self, added: &[Tensor3], x: &[Vector3]) -> Vec<Vector3> {
        let mut image: Vec<Vector3> = x.iter().zip(added).map(|(&x, a)| a.apply(x)).collect();
        for f in self.topology.faces() {
            let corners = self.topology.corners(f).map(VertexId::index);
            let blocks = &self.blocks[f.index()];
            for (i, &v) in corners.iter().enumerate() {
                let (next, previous) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
                let around = blocks[3 + i].apply(x[next]) + blocks[3 + (i + 2) % 3].apply(x[previous]);
                image[v] = image[v] + blocks[i].apply(x[v]) + around;
            }
        }
        image
    }
}

/// The inverse of a block; zero where there is nothing.
fn inverted(block: Tensor3) -> Tensor3 {
    let eigen = block.eigen();
    if eigen.values[2] <= 0.0 {
        return Tensor3::default();
    }
    Tensor3::from_axes(eigen.axes, eigen.values.map(|value| 1.0 / value))
}

fn precondition(inverse: &[Tensor3], v: &[Vector3]) -> Vec<Vector3> {
    inverse.iter().zip(v).map(|(m, &v)| m.apply(v)).collect()
}

fn dot(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, &b)| a.dot(b)).sum()
}

fn add(x: &mut [Vector3], v: &[Vector3], factor: f64) {
    for (x, &v) in x.iter_mut().zip(v) {
        *x = *x + v * factor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::torus;
    use crate::triangulation::FaceId;

    /// Some pairs with every weight, direction and gap, by a sequence without pattern.
    fn pairs(faces: usize) -> Vec<Pair> {
        let noise = |k: usize| (k as f64 * 12.9898).sin() * 43_758.545_3 % 1.0;
        let pair = |k: usize| {
            let [s, t] = [1, 2].map(|i| 0.5 * noise(7 * k + i).abs());
            let direction = Vector3::new(noise(7 * k + 3), noise(7 * k + 4), noise(7 * k + 5)).unit().unwrap();
            let face = FaceId((k % faces) as u32);
            Pair { face, weights: [1.0 - s - t, s, t], direction, gap: noise(7 * k + 6), weight: 1.0 }
        };
        (0..20 * faces).map(pair).collect()
    }

    #[test]
    fn moves_are_where_the_energy_is_least() {
        let surface = torus(2.0, 0.7, 1.2).unwrap();
        let t = surface.topology();
        let mut free = vec![true; t.vertex_slots()];
        free[3] = false;
        let damping = 0.1;
        let system = System::new(t, &free, pairs(t.face_count()).into_iter());
        let anchors =
            Anchors { lines: vec![(Vector3::default(), Vector3::new(0.0, 0.0, 1.0)); free.len()], stiffness: 0.0 };
        let moves = system.solve(damping, &anchors);
        assert_eq!(moves[3], Vector3::default());
        let energy = |moves: &[Vector3]| {
            let mut sum = 0.0;
            for pair in pairs(t.face_count()) {
                let corners = t.corners(pair.face);
                let by = (0..3).map(|i| pair.direction.dot(moves[corners[i].index()]) * pair.weights[i]).sum::<f64>();
                sum += pair.weight * (pair.gap - by).powi(2);
                for i in 0..3 {
                    let m = moves[corners[i].index()];
                    sum += damping / 3.0 * pair.weight * pair.weights[i].powi(2) * m.dot(m);
                }
            }
            sum
        };
        let least = energy(&moves);
        assert!(least < 0.99 * energy(&vec![Vector3::default(); moves.len()]));
        for v in (0..moves.len()).filter(|&v| free[v]) {
            for step in [Vector3::new(1e-3, 0.0, 0.0), Vector3::new(0.0, -1e-3, 0.0), Vector3::new(0.0, 0.0, 1e-3)] {
                let [mut there, mut back] = [moves.clone(), moves.clone()];
                (there[v], back[v]) = (moves[v] + step, moves[v] - step);
                let slope = (energy(&there) - energy(&back)) / 2e-3;
                assert!(slope.abs() < 1e-5, "{slope}");
            }
        }
    }
}

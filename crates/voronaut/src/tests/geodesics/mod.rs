//! What every method of computing distances must do on every canvas, of the plane and of surfaces, and how accurate each is
//! against closed forms.

mod cases;
mod grounds;
mod ladder;
mod surfaces;

use crate::canvas::{Canvas, Draped, Kind};
use crate::diagram::{self, Diagram, Distances, SurfaceDiagram, SurfaceDistances};
use crate::geodesic::Method;
use crate::geometry::{Point, Point3, Tensor, Tensor3};
use crate::manifold::Manifold;
use crate::manifold::domain::Domain;
use crate::manifold::surface::metric::Constant;
use crate::metric::Swirl;
use crate::test_cases::plate;
use crate::triangulation::VertexId;
use grounds::{FROM, Ground, great_circle, planar, points, relaxed, sphere, square, stretched_sphere};

/// By how much distances by a method may err, as a share, on the canvases of these tests.
fn tolerance(method: Method) -> f64 {
    match method {
        Method::March => 0.03,
        Method::Stvd { .. } => 0.15,
        Method::Konukoglu => 0.1,
        Method::Dijkstra | Method::Heat => 0.2,
        // Where a metric turns within its stencils.
        Method::Lbr => 0.35,
    }
}

/// Every kind of canvas of every ground.
fn grounds(plane: Ground) -> impl Iterator<Item = (Ground, Kind)> {
    let all = [plane].into_iter().chain(grounds::surfaces());
    all.flat_map(|ground| Kind::ALL.map(|kind| (ground.clone(), kind)))
}

#[test]
fn distances_are_symmetric_and_obey_the_triangle_inequality() {
    // Mild, so that every method is in its range: anisotropy up to 2.6.
    let turning = |p: Point| {
        let slope = (1.5 * p.x).cos();
        Tensor::new(1.0 + slope * slope, slope, 1.0)
    };
    for (ground, kind) in grounds(square(2.0, turning)) {
        let board = ground.board(kind, 3000);
        for method in ground.methods() {
            let (d, tolerance) = (board.table(method), 0.5 * tolerance(method));
            let method = format!("{method} on {kind} of {}", ground.name);
            for (i, j) in (0..FROM).flat_map(|i| (0..FROM).map(move |j| (i, j))).filter(|(i, j)| i != j) {
                assert!((d[i][j] / d[j][i] - 1.0).abs() < tolerance, "{method}: {} and {}", d[i][j], d[j][i]);
                for k in 0..FROM {
                    assert!(d[i][j] < (d[i][k] + d[k][j]) * (1.0 + tolerance), "{method}: {i} {k} {j}");
                }
            }
            assert!((0..FROM).all(|i| d[i][i] == 0.0), "{method}: {d:?}");
        }
    }
}

#[test]
fn scaling_the_metric_scales_distances() {
    // Powers of two, so that nothing is rounded otherwise.
    let factors = [1.0, 2.0_f64.powi(30), 2.0_f64.powi(-30)];
    for (ground, kind) in grounds(square(2.0, Swirl::default())) {
        let grounds = factors.map(|factor| ground.times(factor));
        let boards = grounds.each_ref().map(|ground| ground.board(kind, 700));
        for method in ground.methods() {
            let method_on = format!("{method} on {kind} of {}", ground.name);
            let [unit, large, small] = [0, 1, 2].map(|k| {
                let found = boards[k].distances(&[0, 1], method).unwrap();
                found.values().iter().map(|d| d / factors[k].sqrt()).collect::<Vec<f64>>()
            });
            assert!(unit.len() == large.len() && unit.len() == small.len());
            for ((a, b), c) in unit.iter().zip(&large).zip(&small) {
                assert!(*a >= 0.0 && a.is_finite(), "{method_on}: {a}");
                assert!((a - b).abs() <= 1e-9 * a && (a - c).abs() <= 1e-9 * a, "{method_on}: {a} {b} {c}");
            }
        }
    }
}

/// A ground, its image in another one with distances of its own, and the exact distances of places of the latter.
type Mapped = (Ground, Ground, fn(Point3, Point3) -> f64);

/// (x, y) to (4 x + y, y): a square, and its image as a domain of its own.
fn mapped_square() -> Mapped {
    let image = |p: Point| Point::new(4.0 * p.x + p.y, p.y);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| image(Point::new(x, y)));
    let mapped = plate(&[&corners.map(|p| [p.x, p.y])]);
    let images: Vec<Point> = points(1.0).into_iter().map(image).collect();
    let there = planar(mapped, |_: Point| Tensor::IDENTITY, &images);
    (square(1.0, |_: Point| Tensor::new(16.0, 4.0, 2.0)), there, Point3::distance)
}

#[test]
fn distances_are_those_of_the_affine_image() {
    for (here, there, exact) in [mapped_square(), (stretched_sphere(), sphere(), great_circle)] {
        let (one, other) = (here.board(Kind::Intrinsic, 4000), there.board(Kind::Intrinsic, 4000));
        for method in here.methods() {
            let tables = [one.table(method), other.table(method)];
            for (i, j) in (0..FROM).flat_map(|i| (0..i).map(move |j| (i, j))) {
                let (a, b, exact) = (tables[0][i][j], tables[1][i][j], exact(there.places[i], there.places[j]));
                assert!((a / b - 1.0).abs() < tolerance(method), "{method} on {}: {a} {b}", here.name);
                assert!((a / exact - 1.0).abs() < tolerance(method), "{method} on {}: {a} {exact}", here.name);
            }
        }
    }
    let [p, q] = [0, 1].map(|k: usize| relaxed(stretched_sphere().places[k]).distance(sphere().places[k]));
    assert!(p < 1e-12 && q < 1e-12);
}

#[test]
fn distances_grow_from_parents_and_paths_lead_back() {
    for (ground, kind) in grounds(square(2.0, Swirl::default())) {
        // As fine everywhere as the metric's finest direction takes more.
        let vertices = if kind == Kind::Isotropic { 30_000 } else { 5000 };
        let board = ground.board(kind, vertices);
        for method in ground.methods() {
            let method_on = format!("{method} on {kind} of {}", ground.name);
            let found = board.distances(&[0, 1, 2, 3, 4], method).unwrap();
            for v in (0..board.vertex_count() as u32).map(VertexId) {
                if let Some(parent) = found.parent(v) {
                    assert!(found.values()[parent.index()] < found.values()[v.index()], "{method_on}: {v:?}");
                }
            }
            for to in FROM..ground.places.len() {
                let Ok((path, length)) = found.path(to) else {
                    // Without parents a way down ends in any hollow of the distances.
                    assert!(!method.drives_diagrams() && kind == Kind::Isotropic, "{method_on}: no way from {to}");
                    continue;
                };
                let (first, last) = (path[0], path[path.len() - 1]);
                let is_source = (0..FROM).any(|i| board.place(i) == last);
                assert!(first == board.place(to) && is_source, "{method_on}: {first} {last}");
                let distance = found.at(to);
                // No path is shorter than the distance, but for the method's error.
                assert!(length > distance * (1.0 - tolerance(method)), "{method_on}: {length} {distance}");
                assert!(length < distance * (1.0 + 4.0 * tolerance(method)), "{method_on}: {length} {distance}");
            }
        }
    }
}

/// Changes a diagram of thirty seeds step by step; what comes out is the same made anew.
fn changed_as_made_anew<'a, G: diagram::Ground<'a>>(
    make: impl Fn(&[G::Place]) -> Diagram<'a, G>,
    seed: impl Fn(u32) -> G::Place,
    name: &str,
) {
    let mut seeds: Vec<G::Place> = (1..=30).map(&seed).collect();
    let mut diagram = make(&seeds);
    for i in 0..12 {
        seeds.push(seed(100 + i));
        assert_eq!(diagram.insert(seeds[seeds.len() - 1]).unwrap() as usize, seeds.len() - 1);
        seeds[i as usize] = seed(200 + i);
        diagram.move_to(i, seeds[i as usize]).unwrap();
    }
    diagram.insert(seed(500)).unwrap();
    assert!(diagram.remove(seeds.len() as u32));
    let anew = make(&seeds);
    for v in (0..diagram.vertex_count() as u32).map(VertexId) {
        assert_eq!(diagram.label(v), anew.label(v), "{name}: {v:?}");
    }
    assert!(diagram.cell_sizes()[..seeds.len()].iter().all(|&size| size > 0), "{name}");
}

#[test]
fn diagrams_by_every_method_change_as_if_made_anew() {
    let (square, swirl) = (Domain::shape("rect:-2,-2,2,2").unwrap(), Swirl::default());
    let (sphere, uniform) = (Manifold::shape("sphere:1", None).unwrap(), Constant(Tensor3::IDENTITY));
    let seed = |i: u32| Point::new((1.7 * f64::from(i)).sin() * 1.9, (2.3 * f64::from(i)).cos() * 1.9);
    for kind in Kind::ALL {
        let flat = Canvas::new(kind, square.planar(), &swirl, 700).unwrap();
        let (round, _) = Canvas::on_surface(kind, &sphere, &uniform, 700, &[]).unwrap();
        let vertex = |i: u32| VertexId(7919 * i % round.vertex_count() as u32);
        for method in Method::ALL.into_iter().filter(|method| method.drives_diagrams()) {
            let name = format!("{method} on {kind}");
            changed_as_made_anew(
                |seeds| Diagram::of_kind(diagram::Kind::Riemannian, &flat, &swirl, seeds, method).unwrap(),
                seed,
                &name,
            );
            changed_as_made_anew(|seeds| SurfaceDiagram::on_surface(&round, seeds, method).unwrap(), vertex, &name);
        }
    }
    let canvas = Canvas::intrinsic(square.planar(), &swirl, 1500).unwrap();
    let (round, _) = Canvas::on_surface(Kind::Intrinsic, &sphere, &uniform, 1500, &[]).unwrap();
    for method in [Method::Lbr, Method::Heat] {
        let of_plane = Diagram::of_kind(diagram::Kind::Riemannian, &canvas, &swirl, &[seed(1)], method).err().unwrap();
        let of_surface = SurfaceDiagram::on_surface(&round, &[VertexId(1)], method).err().unwrap();
        for error in [of_plane, of_surface] {
            assert_eq!(error.to_string(), format!("not supported: a diagram by {method}, which gives distances alone"));
            assert_eq!(error.help(), "use one of march, stvd, dijkstra, konukoglu");
        }
    }
}

#[test]
fn points_outside_the_domain_are_refused() {
    let (domain, swirl) = (Domain::shape("rect:-1,-1,1,1").unwrap(), Swirl::default());
    let canvas = Canvas::intrinsic(domain.planar(), &swirl, 300).unwrap();
    for method in Method::ALL {
        let error = Distances::new(&canvas, &swirl, &[Point::new(3.0, 0.0)], method).err().unwrap();
        assert!(error.to_string().contains("outside the domain at seed 1 (3, 0)"), "{error}");
        let found = Distances::new(&canvas, &swirl, &[Point::new(0.3, 0.1)], method).unwrap();
        assert!(found.at(Point::new(3.0, 0.0)).is_none() && found.path(Point::new(3.0, 0.0)).is_err());
    }
    let (sphere, uniform) = (Manifold::shape("sphere:1", None).unwrap(), Constant(Tensor3::IDENTITY));
    let (round, _): (Canvas<Draped>, _) = Canvas::on_surface(Kind::Intrinsic, &sphere, &uniform, 1500, &[]).unwrap();
    let nowhere = VertexId(round.vertex_count() as u32);
    for method in Method::ALL {
        let error = SurfaceDistances::on_surface(&round, &[nowhere], method).err().unwrap();
        assert!(error.to_string().contains("a seed that is no canvas vertex"), "{error}");
        let found = SurfaceDistances::on_surface(&round, &[VertexId(0)], method);
        assert_eq!(found.is_err(), method == Method::Lbr);
        if let Err(error) = found {
            assert!(error.to_string().starts_with("not supported: distances by lbr on a surface"), "{error}");
            assert_eq!(error.help(), "use one of march, stvd, dijkstra, konukoglu, heat");
        }
    }
    assert_eq!("stvd:window=8".parse::<Method>().unwrap().to_string(), "stvd");
}

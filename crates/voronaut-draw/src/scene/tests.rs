//! Pictures of scenes as wholes.

use super::*;
use crate::render_png;
use resvg::tiny_skia::Pixmap;
use voronaut::Result;
use voronaut::manifold::Manifold;
use voronaut::mesh::Mesh;

/// Seen along z, x to the right, with so few pixels that it is quick.
const FRONT: View = View { from: Vector3::new(0.0, 0.0, 1.0), up: Vector3::new(0.0, 1.0, 0.0), pixels: 400 };

fn sphere() -> Manifold {
    Manifold::shape("sphere:1", Some(0.2)).unwrap()
}

fn line(points: &[[f64; 3]]) -> Vec<Point3> {
    points.iter().copied().map(Point3::from).collect()
}

/// A surface, plain and smooth.
fn plain(surface: &Manifold) -> Scene {
    let topology = surface.topology();
    let triangles: Vec<[u32; 3]> = topology.faces().map(|f| topology.corners(f).map(|v| v.0)).collect();
    Scene::of_canvas(surface.positions(), &triangles, &vec![None; surface.positions().len()], &[])
}

/// A sphere with some lines.
fn sphere_and(lines: &[&[[f64; 3]]]) -> Result<String> {
    draw_surface(&plain(&sphere()).with(lines.iter().map(|points| line(points)), Stroke::Edge), &FRONT)
}

/// The text behind the image, whose letters might be anything.
fn vectors(svg: &str) -> &str {
    svg.split_once("<g").unwrap().1
}

/// The data of all paths, each line with its moves, in hundredths of a pixel.
fn paths(svg: &str) -> Vec<Vec<[i64; 2]>> {
    let data = vectors(svg).split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let lines = data.flat_map(|data| data.split('m').skip(1));
    let numbers =
        |line: &str| line.replace('-', " -").split_whitespace().map(|x| x.parse().unwrap()).collect::<Vec<i64>>();
    lines.map(|line| numbers(line).chunks(2).map(|pair| [pair[0], pair[1]]).collect()).collect()
}

/// Length of a line with two points, in pixels.
fn length(path: &[[i64; 2]]) -> f64 {
    assert_eq!(path.len(), 2, "{path:?}");
    (path[1][0] as f64).hypot(path[1][1] as f64) / 100.0
}

fn pixels(svg: &str) -> Pixmap {
    Pixmap::decode_png(&render_png(svg).unwrap()).unwrap()
}

fn colour(pixels: &Pixmap, x: u32, y: u32) -> [i32; 3] {
    let pixel = pixels.pixel(x, y).unwrap();
    [pixel.red(), pixel.green(), pixel.blue()].map(i32::from)
}

#[test]
fn a_line_behind_leaves_no_trace_and_one_in_front_is_whole() {
    assert!(paths(&sphere_and(&[]).unwrap()).is_empty());
    for x in [0.05, 0.5, 0.8] {
        let behind = sphere_and(&[&[[-x, -0.5, -2.0], [x, 0.5, -0.95]]]).unwrap();
        assert!(paths(&behind).is_empty(), "{behind}");
        let before = paths(&sphere_and(&[&[[-x, 0.0, 2.0], [x, 0.0, 1.0]]]).unwrap());
        // The diameter has 400 pixels without the margins of 8.
        assert!(before.len() == 1 && (length(&before[0]) - 384.0 * x).abs() < 0.01 * 384.0 * x, "{before:?}");
    }
}

#[test]
fn a_line_through_a_body_is_cut_where_it_enters() {
    let found = paths(&sphere_and(&[&[[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]]]).unwrap());
    // A quarter of the line on each side.
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found.iter().all(|part| (length(part) - 96.0).abs() < 1.5), "{found:?}");
}

#[test]
fn half_of_the_edges_of_a_body_are_seen() {
    let surface = sphere();
    let topology = surface.topology();
    let points = surface.positions().iter().map(|p| p.to_array()).collect();
    let triangles = topology.faces().map(|f| topology.corners(f).map(|v| v.0)).collect();
    let mesh = Mesh { points, triangles, ..Mesh::default() };
    let seen = paths(&draw_surface(&Scene::of_mesh(&mesh, None), &FRONT).unwrap()).len();
    let share = seen as f64 / topology.edges().count() as f64;
    // All in front, those of the outline, and nothing else.
    assert!((0.5..0.57).contains(&share), "{share}");
}

#[test]
fn dots_are_seen_or_not() {
    let dots = |z: f64| {
        let scene = plain(&sphere()).with([line(&[[0.1, 0.2, z]])], Stroke::Seed);
        vectors(&draw_surface(&scene, &FRONT).unwrap()).matches("h0").count()
    };
    assert_eq!([dots(1.0), dots(0.5), dots(-1.0)], [1, 0, 0]);
}

#[test]
fn pictures_are_the_same_at_every_run_and_can_be_rendered() {
    let svg = sphere_and(&[&[[-0.5, 0.0, 2.0], [0.5, 0.0, 1.0]]]).unwrap();
    assert_eq!(svg, sphere_and(&[&[[-0.5, 0.0, 2.0], [0.5, 0.0, 1.0]]]).unwrap());
    let pixels = pixels(&svg);
    assert_eq!(colour(&pixels, 3, 3), [255; 3]);
    let [above, below, ink] = [[120, 120], [280, 280], [200, 200]].map(|[x, y]| colour(&pixels, x, y));
    assert!(above[1] > below[1] + 30 && below[1] > ink[1] && above[1] < 250, "{above:?} {below:?} {ink:?}");
}

#[test]
fn nothing_and_nonsense_are_drawn_as_nothing() {
    for pixels in [0, 1, 100] {
        assert!(draw_surface(&Scene::default(), &View { pixels, ..FRONT }).unwrap().ends_with("</svg>\n"));
    }
    let scene = plain(&sphere());
    let mut more = scene.clone();
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let corners = [[0.0, 0.0, 2.0], [1.0, bad, 2.0], [0.0, 1.0, 2.0]].map(Point3::from);
        more.triangles.push(SceneTriangle { corners, normals: None, fill: Fill::Level { region: 0, share: bad } });
        more = more.with([corners.to_vec(), Vec::new()], Stroke::Edge);
    }
    assert_eq!(draw_surface(&more, &FRONT).unwrap(), draw_surface(&scene, &FRONT).unwrap());
    // Normals and fills that are none do not hurt.
    let normals = Some([Vector3::new(f64::NAN, 0.0, 0.0), Vector3::default(), Vector3::new(1e300, 0.0, 1e300)]);
    more.triangles.iter_mut().for_each(|t| (t.normals, t.fill) = (normals, Fill::Level { region: 0, share: f64::NAN }));
    assert!(!vectors(&draw_surface(&more, &FRONT).unwrap()).contains("NaN"));
    let mesh = Mesh { points: vec![[f64::NAN; 3]; 2], triangles: vec![[0, 1, 0], [0, 1, 7]], ..Mesh::default() };
    assert!(paths(&draw_surface(&Scene::of_mesh(&mesh, None), &FRONT).unwrap()).is_empty());
    let canvas = Scene::of_canvas(
        &[Point3::new(f64::NAN, 0.0, 0.0); 3],
        &[[0, 1, 2], [0, 0, 1]],
        &[Some(1), None, Some(7)],
        &[],
    );
    assert!(paths(&draw_surface(&canvas, &FRONT).unwrap()).is_empty());
}

#[test]
fn scale_does_not_matter() {
    let draw = |scale: f64| {
        let mut scene = plain(&sphere()).with([line(&[[-2.0, 0.0, 0.0], [2.0, 0.5, 0.0]])], Stroke::Geodesic);
        let grow = |p: &mut Point3| *p = Point3::default() + (*p - Point3::default()) * scale;
        scene.triangles.iter_mut().flat_map(|t| &mut t.corners).for_each(grow);
        scene.lines.iter_mut().flat_map(|l| &mut l.points).for_each(grow);
        draw_surface(&scene, &FRONT).unwrap()
    };
    assert_eq!(draw(1.0), draw(2.0_f64.powi(-60)));
    assert_eq!(draw(1.0), draw(2.0_f64.powi(60)));
}

#[test]
fn backs_are_told_from_fronts_and_bodies_may_be_inside_out() {
    let sheet = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| SceneTriangle {
        corners: [a, b, c].map(Point3::from),
        normals: None,
        fill: Fill::Plain,
    };
    // A large front and a small back, in the same plane.
    let front = sheet([0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    let back = sheet([2.0, 2.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]);
    let drawn = pixels(&draw_surface(&Scene { triangles: vec![front, back], ..Scene::default() }, &FRONT).unwrap());
    let [front, back] = [colour(&drawn, 60, 340), colour(&drawn, 360, 40)];
    assert!(front[2] > back[2] + 30, "{front:?} {back:?}");

    let scene = plain(&sphere());
    let mut turned = scene.clone();
    turned.triangles.iter_mut().for_each(|t| {
        t.corners.swap(1, 2);
        t.normals = t.normals.map(|[a, b, c]| [-a, -c, -b]);
    });
    let [one, other] = [scene, turned].map(|scene| pixels(&draw_surface(&scene, &FRONT).unwrap()));
    assert!(one.data().iter().zip(other.data()).all(|(a, b)| a.abs_diff(*b) <= 1));
}

//! Lines in which sheets of f = 0 meet: no mesh of one surface has them.

use super::Implicit;
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Eigen3, Point3, Vector3};
use crate::parallel::prelude::*;

/// Steps of the search for a point without gradient, which doubles its digits in each.
const STEPS: usize = 12;

/// How far from the points that are known such a point is looked for, in steps of the grid: where sheets meet at a small angle the grid
/// does not see them before they are apart.
const REACH: f64 = 8.0;

/// What counts as zero: of |grad f| and of |f|, in what the second derivatives make of them over a step of the grid. Sheets that
/// pass each other are farther apart than that, or no arithmetic tells.
const ZERO: f64 = 1e-9;

/// Second derivatives across the line, the smaller in parts of the larger; sheets that touch along a line have none.
const FLAT: f64 = 1e-6;

/// Refuses a surface whose sheets cross in a line: there f and its gradient are zero, and the second derivatives have both signs
/// across it and vanish along it. `points` are on the surface, a `step` of the grid or less apart. Scale-free. Points in which sheets
/// meet, a cone's apex among them, pass; so do lines in which sheets touch.
///
/// # Errors
/// [`Error::Domain`] with the first point found of such a line.
pub(super) fn demand_one_sheet(f: &dyn Implicit, points: &[Point3], step: f64, bounds: Aabb3) -> Result<()> {
    let Some(p) = points.par_iter().find_map_first(|&p| on_line(f, p, step, bounds)) else { return Ok(()) };
    let help = "give one sheet at a time: the equation of each factor by itself, or a box without that line; of two shapes f and g, \
                max(f, g) is what they share and min(f, g) both together";
    Err(Error::domain("sheets of f = 0 meet in a line: grad f = 0", p.to_string(), help))
}

/// A point near to `p` of a line in which sheets cross.
fn on_line(f: &dyn Implicit, p: Point3, step: f64, bounds: Aabb3) -> Option<Point3> {
    let (q, along) = crossing(f, p, step)?;
    // Points without gradient may be alone. Then the next one over is the same, or none.
    let is_line = [0.5, -0.5].iter().any(|part| {
        let next = crossing(f, q + along * (part * step), step);
        next.is_some_and(|(next, _)| next.distance(q) > 0.25 * step)
    });
    (is_line && bounds.contains(q)).then_some(q)
}

/// The nearest point with f = 0 and without gradient where the second derivatives have both signs, by Newton's method on the
/// gradient across the axis along which it changes least, and that axis. `None` where it is not reached.
fn crossing(f: &dyn Implicit, p: Point3, step: f64) -> Option<(Point3, Vector3)> {
    let mut q = p;
    for _ in 0..STEPS {
        let jet = f.jet(q);
        if !(jet.value.is_finite() && jet.gradient.norm().is_finite() && jet.hessian.is_finite()) {
            return None;
        }
        let Eigen3 { axes, values } = jet.hessian.eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| values[j].abs().total_cmp(&values[i].abs()));
        let [most, less, least] = order.map(|i| values[i]);
        if less.abs() <= FLAT * most.abs() {
            return None;
        }
        let bend = less.abs() * step;
        if jet.gradient.norm() <= ZERO * bend {
            let is_crossing = most * less < 0.0 && least.abs() <= ZERO.sqrt() * less.abs();
            return (is_crossing && jet.value.abs() <= ZERO * bend * step).then_some((q, axes[order[2]]));
        }
        let way = |i: usize| axes[i] * (-jet.gradient.dot(axes[i]) / values[i]);
        q = q + (way(order[0]) + way(order[1]));
        if q.distance(p) > REACH * step {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Aabb3, Point3};
    use crate::manifold::surface::mesh_implicit;
    use crate::metric::{Expression, Variables};

    fn is_refused(text: &str, half: f64) -> bool {
        let f = Expression::parse(text, Variables::Space).unwrap();
        let corner = |s: f64| Point3::new(s * half, s * half, s * half);
        let made = mesh_implicit(&f, Aabb3 { min: corner(-1.0), max: corner(1.0) }, Some(half / 8.0));
        made.is_err_and(|error| error.to_string().contains("sheets of f = 0 meet in a line: grad f = 0 at ("))
    }

    #[test]
    fn sheets_that_cross_are_refused_at_any_scale_and_place() {
        for text in [
            "x*y",
            "x*y*z",
            "x^2-y^2",
            "(x^2+y^2+z^2-0.5)*z",
            "(x-0.013)*(x+0.3*y-0.017)",
            "(x^2+y^2+z^2-0.3)*((x-0.4)^2+y^2+z^2-0.3)",
            "(x^2+y^2-0.2)*(x^2+z^2-0.3)",
            "x^2-y^2*(z+3)",
        ] {
            assert!(is_refused(text, 1.0), "{text}");
            assert!(is_refused(&format!("1e9*({text})"), 1.0) && is_refused(&format!("1e-9*({text})"), 1.0), "{text}");
        }
        assert!(is_refused("x*y", 1e-6) && is_refused("x*y", 1e6));
    }

    #[test]
    fn single_sheets_and_single_points_pass() {
        for text in [
            "x^2+y^2+z^2-0.5",
            "x^2+y^2-z^2",
            "x^2+y^2-z^2-1e-3",
            "x^2-y^2-1e-3",
            "x^2-y^2+z^3",
            "x^3",
            "x^2*y+y^3+y",
            "abs(x+y)+abs(z)-0.5",
            "max(x,y)",
            "min(x^2+y^2+z^2-0.3,(x-0.4)^2+y^2+z^2-0.3)",
            "(x^2+y^2+z^2-0.2)*(x^2+y^2+z^2-0.6)",
            "sin(3*x)+sin(3*y)+sin(3*z)",
        ] {
            assert!(!is_refused(text, 1.0), "{text}");
        }
    }
}

//! A metric smoothed: averaged over the neighbours on a background mesh, again and again.

use super::neighbours::Neighbours;
use super::{MetricField, Sampled};
use crate::error::{Error, Result};
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use std::ops::{Add, Mul};

/// Sweeps at most. On a background of 40,000 vertices so many smooth over a quarter of the domain's width: what is left of a
/// field then is about its mean.
pub const MOST_SWEEPS: u32 = 10_000;
/// How much of its own value a vertex keeps in a sweep; without any, values could alternate.
const KEPT: f64 = 0.5;

/// The field sampled at the vertices of a background mesh and smoothed by so many sweeps (Laplacian smoothing): each
/// replaces the logarithm of every tensor by the mean of itself and the mean over its neighbours.
///
/// K sweeps smooth like a Gaussian whose standard deviation is half the square root of K edges of the background, along each
/// axis; what changes over less is lost. No sweep only samples. The mean is log-Euclidean (Arsigny 2006): means stay between
/// the least and the greatest size of what they average, and are not more anisotropic; of tensors whose axes differ they are
/// less so. A factor on the field is a factor on the result, and a field that is the same everywhere stays.
///
/// # Errors
/// [`Error::Limit`] for more than [`MOST_SWEEPS`]; as for [`Sampled::new`] where the background is not what it should be or
/// the field is no metric at one of its vertices.
pub(crate) fn smoothed(field: &dyn MetricField, background: &Mesh, sweeps: u32) -> Result<Sampled> {
    demand(sweeps)?;
    let vertices = 0..background.points.len() as u32;
    let tensors: Vec<Tensor> = vertices.into_par_iter().map(|v| field.at(background.point(v))).collect();
    let sampled = Sampled::new(background, &tensors)?;
    let around = Neighbours::of(background);
    let logs = tensors.iter().map(|tensor| tensor.log()).collect();
    Ok(sampled.with_logarithms(swept(&around, logs, sweeps)?))
}

fn demand(sweeps: u32) -> Result<()> {
    if sweeps <= MOST_SWEEPS {
        return Ok(());
    }
    let what = format!("{sweeps} sweeps of smoothing; the limit is {MOST_SWEEPS}");
    let help = "smooth less: K sweeps reach over half the square root of K edges of the background";
    Err(Error::limit(what, help))
}

/// Logarithms of tensors after so many sweeps.
///
/// # Errors
/// [`Error::Limit`] for more than [`MOST_SWEEPS`].
pub(crate) fn swept<T>(around: &Neighbours, mut logs: Vec<T>, sweeps: u32) -> Result<Vec<T>>
where
    T: Copy + Default + Send + Sync + Add<Output = T> + Mul<f64, Output = T>,
{
    demand(sweeps)?;
    for _ in 0..sweeps {
        logs = (0..logs.len()).into_par_iter().map(|v| smooth(around, &logs, v)).collect();
    }
    Ok(logs)
}

/// A value after one sweep.
fn smooth<T>(around: &Neighbours, values: &[T], v: usize) -> T
where
    T: Copy + Default + Add<Output = T> + Mul<f64, Output = T>,
{
    let list = around.at(v);
    if list.is_empty() {
        return values[v];
    }
    let sum = list.iter().fold(T::default(), |sum, &n| sum + values[n as usize]);
    values[v] * KEPT + sum * ((1.0 - KEPT) / list.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Vector};
    use crate::metric::Scaled;

    /// n by n unit squares, each cut in two.
    fn grid(n: u32) -> Mesh {
        let position = |k: u32| [f64::from(k % (n + 1)), f64::from(k / (n + 1)), 0.0];
        let cell = |k: u32| {
            let a = k % n + k / n * (n + 1);
            [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
        };
        Mesh {
            points: (0..(n + 1) * (n + 1)).map(position).collect(),
            triangles: (0..n * n).flat_map(cell).collect(),
            ..Mesh::default()
        }
    }

    fn turning(p: Point) -> Tensor {
        let angle = 0.3 * p.x + 0.2 * p.y;
        Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 100.0 * (1.1 + (0.4 * p.y).sin()), 1.0)
    }

    fn difference(a: Tensor, b: Tensor) -> f64 {
        ((a.xx - b.xx).abs() + (a.xy - b.xy).abs() + (a.yy - b.yy).abs()) / (b.xx + b.yy)
    }

    fn points() -> impl Iterator<Item = Point> {
        (0..200).map(|i| Point::new(20.0 * (f64::from(i) * 0.618).fract(), 20.0 * (f64::from(i) * 0.414).fract()))
    }

    #[test]
    fn a_uniform_metric_stays() {
        let m = Tensor::new(5.0, -2.0, 3.0);
        let found = smoothed(&|_: Point| m, &grid(20), 300).unwrap();
        assert!(points().all(|p| difference(found.at(p), m) < 1e-12));
    }

    #[test]
    fn a_factor_on_the_field_is_one_on_the_result() {
        let factor = 37.3;
        let plain = smoothed(&turning, &grid(20), 9).unwrap();
        let scaled = smoothed(&Scaled { field: &turning, factor }, &grid(20), 9).unwrap();
        assert!(points().all(|p| difference(scaled.at(p), plain.at(p) * factor) < 1e-12));
    }

    #[test]
    fn waves_fade_as_under_a_gaussian() {
        // Sizes exp(cos(k x)): one sweep multiplies the wave by 1/2 + (cos k + cos k + 1) / 6 away from the border.
        let k = 0.5_f64;
        let wave = |p: Point| Tensor::IDENTITY * (2.0 * (k * p.x).cos()).exp();
        let found = smoothed(&wave, &grid(60), 20).unwrap();
        let kept = (0.5 + (4.0 * k.cos() + 2.0) / 12.0).powi(20);
        let amplitude = 0.5 * found.at(Point::new(30.0, 30.0)).xx.ln() / (k * 30.0).cos();
        assert!((amplitude - kept).abs() < 1e-6, "{amplitude} {kept}");
        // The edges of this grid: two thirds along x have length one (the diagonals, too, step by one), a third none.
        let gaussian = (-0.5 * k * k * 20.0 * 0.5 * (2.0 / 3.0)).exp();
        assert!((kept / gaussian - 1.0).abs() < 0.03, "{kept} {gaussian}");
    }

    #[test]
    fn anisotropy_fades_where_axes_turn_and_sizes_stay_between() {
        let found = smoothed(&turning, &grid(20), 50).unwrap();
        let mean = |field: &dyn MetricField| points().map(|p| field.at(p).anisotropy().ln()).sum::<f64>() / 200.0;
        assert!(mean(&found) < 0.9 * mean(&turning));
        let is_between = |m: Tensor| m.eigen().small >= 0.999 && m.eigen().large <= 210.1;
        assert!(points().all(|p| is_between(found.at(p))));
    }

    #[test]
    fn no_sweep_samples_and_threads_change_no_bit() {
        let mesh = grid(20);
        let tensors: Vec<Tensor> = (0..mesh.points.len() as u32).map(|v| turning(mesh.point(v))).collect();
        let (none, sampled) = (smoothed(&turning, &mesh, 0).unwrap(), Sampled::new(&mesh, &tensors).unwrap());
        assert!(points().all(|p| none.at(p) == sampled.at(p)));
        let with = |threads| crate::test_cases::on_threads(threads, || smoothed(&turning, &mesh, 7).unwrap());
        let (one, three) = (with(1), with(3));
        assert!(points().all(|p| one.at(p) == three.at(p)));
    }

    #[test]
    fn too_many_sweeps_and_bad_fields_are_named() {
        let error = smoothed(&turning, &grid(2), 1_000_000).unwrap_err();
        assert_eq!(error.to_string(), "limit exceeded: 1000000 sweeps of smoothing; the limit is 10000");
        assert!(error.help().contains("smooth less"));
        let bad = |p: Point| Tensor::new(1.5 - p.x, 0.0, 1.0);
        let error = smoothed(&bad, &grid(2), 3).unwrap_err();
        assert!(error.to_string().contains("not positive definite at vertex 3 (2, 0)"), "{error}");
    }
}

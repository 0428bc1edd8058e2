//! One metric of several on the same mesh.

use crate::error::{Error, Result};
use crate::geometry::Tensor;

/// The intersection of metrics at each vertex: nowhere coarser than any of them, and the coarsest such
/// (`Tensor::intersection_with_all`), in whatever order they come.
///
/// # Errors
/// [`Error::Metric`] of no metrics, or of different numbers of tensors.
pub fn intersect(metrics: &[&[Tensor]]) -> Result<Vec<Tensor>> {
    let first = demand_alike(metrics)?;
    let at =
        |v: usize| first[v].intersection_with_all(&metrics[1..].iter().map(|metric| metric[v]).collect::<Vec<_>>());
    Ok((0..first.len()).map(at).collect())
}

/// The log-Euclidean mean of metrics at each vertex (Arsigny 2006), with one weight each; only the weights' ratios matter. Sizes
/// are geometric means, where those of entries of tensors would be near the finest.
///
/// # Errors
/// As [`intersect`]; [`Error::Parse`] unless there is a weight for each, none negative, not all zero.
pub fn average(metrics: &[&[Tensor]], weights: &[f64]) -> Result<Vec<Tensor>> {
    let first = demand_alike(metrics)?;
    let total: f64 = weights.iter().sum();
    if weights.len() != metrics.len() {
        let what = format!("{} weights for {} metrics", weights.len(), metrics.len());
        return Err(Error::parse("weights", what, "give one weight for each metric"));
    }
    if !(weights.iter().all(|&w| w >= 0.0) && total > 0.0 && total.is_finite()) {
        let what = format!("{weights:?} are no weights");
        return Err(Error::parse("weights", what, "weights are finite, none negative, and not all zero"));
    }
    let at = |v: usize| Tensor::log_mean(metrics.iter().zip(weights).map(|(metric, w)| (metric[v], w / total)));
    Ok((0..first.len()).map(at).collect())
}

fn demand_alike<'a>(metrics: &[&'a [Tensor]]) -> Result<&'a [Tensor]> {
    let help = "give metrics on one mesh, one tensor for each vertex";
    let Some(first) = metrics.first() else {
        return Err(Error::metric("no metrics to combine", "the list of metrics", help));
    };
    match metrics.iter().find(|metric| metric.len() != first.len()) {
        Some(other) => {
            let what = format!("metrics of {} and {} tensors do not combine", first.len(), other.len());
            Err(Error::metric(what, "the list of metrics", help))
        }
        None => Ok(first),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    const WIDE: [Tensor; 1] = [Tensor::new(1.0, 0.0, 16.0)];
    const TALL: [Tensor; 1] = [Tensor::new(4.0, 0.0, 1.0)];

    fn close(a: Tensor, b: Tensor) -> bool {
        let d = a + b * -1.0;
        d.xx.abs() + d.xy.abs() + d.yy.abs() < 1e-13 * (b.xx + b.yy)
    }

    #[test]
    fn finer_directions_count_and_sizes_are_averaged() {
        assert!(close(intersect(&[&WIDE, &TALL]).unwrap()[0], Tensor::new(4.0, 0.0, 16.0)));
        assert!(close(average(&[&WIDE, &TALL], &[1.0, 1.0]).unwrap()[0], Tensor::new(2.0, 0.0, 4.0)));
        // A quarter of the logarithms of the first: 4^(3/4), 16^(1/4).
        let found = average(&[&WIDE, &TALL], &[0.5, 1.5]).unwrap()[0];
        assert!(close(found, Tensor::new(8_f64.sqrt(), 0.0, 2.0)));
    }

    /// Three strips, each turned by 60 degrees: by pairs, one after the other, what comes out is turned towards the last.
    #[test]
    fn of_three_none_comes_first() {
        let strip = |i: f64| {
            let angle = i * std::f64::consts::FRAC_PI_3;
            [Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 9.0, 1.0)]
        };
        let [a, b, c] = [0.0, 1.0, 2.0].map(strip);
        for order in [[&a[..], &b, &c], [&b, &a, &c], [&c, &b, &a]] {
            assert!(close(intersect(&order).unwrap()[0], Tensor::new(9.0, 0.0, 9.0)));
        }
    }

    #[test]
    fn of_one_metric_it_is_that_one() {
        assert_eq!(intersect(&[&WIDE]).unwrap(), WIDE);
        assert!(close(average(&[&TALL], &[7.0]).unwrap()[0], TALL[0]));
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let says = |result: Result<Vec<Tensor>>, words: &str| {
            let error = result.unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        };
        says(intersect(&[]), "no metrics to combine");
        says(intersect(&[&WIDE, &[TALL[0], TALL[0]]]), "metrics of 1 and 2 tensors");
        says(average(&[&WIDE, &TALL], &[1.0]), "1 weights for 2 metrics");
        says(average(&[&WIDE, &TALL], &[0.0, 0.0]), "are no weights");
        says(average(&[&WIDE, &TALL], &[2.0, -1.0]), "are no weights");
        says(average(&[&WIDE, &TALL], &[f64::NAN, 1.0]), "are no weights");
    }
}

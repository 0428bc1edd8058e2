//! The root of a function that grows: how a factor is found that gives a complexity.

use crate::error::Result;

/// How the search for a root ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Root {
    /// The function is as near to zero here as was asked.
    At(f64),
    /// It jumps over zero here; below zero at this argument.
    Jump(f64),
    /// It is below zero everywhere, and no more than this.
    Below(f64),
    /// It is above zero everywhere, and no less than this.
    Above(f64),
}

/// Finds x with |f(x)| <= tolerance of a function that does not fall and has slopes of at most about 1, from zero: steps that
/// double until the sign changes, then false position with the Illinois rule. A function that stays the same to the bit over a
/// doubled step is taken to have reached its limit.
pub(super) fn root(tolerance: f64, mut f: impl FnMut(f64) -> Result<f64>) -> Result<Root> {
    let (mut x, mut value) = (0.0, f(0.0)?);
    if value.abs() <= tolerance {
        return Ok(Root::At(x));
    }
    let direction = -value.signum();
    let mut step = (FIRST_STEP * value.abs()).max(tolerance);
    let (mut old, mut same) = ((x, value), 0);
    while value * direction < 0.0 {
        old = (x, value);
        x += direction * step;
        step *= 2.0;
        value = f(x)?;
        #[expect(clippy::float_cmp, reason = "a function that has reached its limit does not change")]
        let stays = value == old.1;
        same = if stays { same + 1 } else { 0 };
        if same == PATIENCE || x.abs() > FARTHEST {
            return Ok(if direction > 0.0 { Root::Below(value) } else { Root::Above(value) });
        }
    }
    if value.abs() <= tolerance {
        return Ok(Root::At(x));
    }
    let ends = if direction > 0.0 { [old, (x, value)] } else { [(x, value), old] };
    between(ends, tolerance, f)
}

/// Steps that end short of the root are dearer than those that end beyond it.
const FIRST_STEP: f64 = 1.2;
/// Doubled steps without a change.
const PATIENCE: u32 = 3;
/// Beyond this, exp overflows.
const FARTHEST: f64 = 600.0;
/// Steps at most.
const STEPS: u32 = 100;
/// Steps after which intervals are halved, whatever the values: they say nothing of a jump.
const PROMPT: u32 = 20;

/// Between an argument with a negative and one with a positive value.
fn between(ends: [(f64, f64); 2], tolerance: f64, mut f: impl FnMut(f64) -> Result<f64>) -> Result<Root> {
    let [(mut low, mut below), (mut high, mut above)] = ends;
    let mut last = 0.0;
    for i in 1..=STEPS {
        if high - low <= JUMP * tolerance {
            break;
        }
        let x = if i > PROMPT { 0.5 * (low + high) } else { low + (high - low) * (below / (below - above)) };
        let value = f(x)?;
        if value.abs() <= tolerance {
            return Ok(Root::At(x));
        }
        // The end that stays a second time counts for half.
        let stays = if last * value > 0.0 { 0.5 } else { 1.0 };
        if value < 0.0 {
            (low, below, above) = (x, value, above * stays);
        } else {
            (high, above, below) = (x, value, below * stays);
        }
        last = value;
    }
    Ok(Root::Jump(low))
}

/// A function with slopes of about 1 that is off by the tolerance at both ends of so small a share of it jumps.
const JUMP: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    fn found(f: impl Fn(f64) -> f64) -> (Root, u32) {
        let mut count = 0;
        let root = root(1e-9, |x| {
            count += 1;
            Ok(f(x))
        });
        (root.unwrap(), count)
    }

    #[test]
    fn roots_near_and_far() {
        for truth in [0.0, 1e-6, -0.3, 7.0, -40.0, 300.0] {
            let bent = |x: f64| (x - truth) * if x < truth { 1.0 } else { 0.2 };
            let (root, count) = found(bent);
            let Root::At(x) = root else { panic!("{root:?}") };
            assert!(bent(x).abs() <= 1e-9 && count < 40, "{truth}: {x} after {count}");
        }
    }

    #[test]
    fn limits_and_jumps_are_told() {
        assert_eq!(found(|x| x.min(3.0) - 5.0).0, Root::Below(-2.0));
        assert_eq!(found(|x| x.max(-3.0) + 5.0).0, Root::Above(2.0));
        let Root::Jump(x) = found(|x| x - 2.0 + if x > 1.0 { 1.5 } else { 0.0 }).0 else { panic!() };
        assert!(x <= 1.0 && x > 1.0 - 1e-9);
    }
}

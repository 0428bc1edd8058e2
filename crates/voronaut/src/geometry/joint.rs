//! The intersection of any number of metrics at once: it knows no order.
//!
//! The tensor s I + ((p, q), (q, -p)) is seen as the disk of centre (p, q) and radius s. One tensor is above another, its v' M v
//! nowhere smaller, exactly where its disk contains the other's; and its determinant is s^2 - p^2 - q^2.

use super::{Tensor, Vector};

impl Tensor {
    /// The intersection of a metric with any number of other tensors: of all tensors M with v' M v at least as large as that of
    /// each of them for every v, the one with the smallest determinant. There is one such tensor, so that neither the order of the
    /// tensors nor which of them is `self` matters but for rounding; it changes continuously with them, and goes along with every
    /// linear change of coordinates.
    ///
    /// Of two metrics that are not below others it is [`Tensor::intersection`] bit for bit; so is what is above all others.
    /// Folding that over three or more is another thing: what is above two of them is not what is left when one is done first.
    /// `self` is positive definite; the others need not be: where they say nothing, `self` counts.
    #[must_use]
    pub(crate) fn intersection_with_all(self, others: &[Tensor]) -> Tensor {
        let all: Vec<Tensor> = std::iter::once(self).chain(others.iter().copied()).collect();
        let disks = seen_from(self, &all);
        let outer: Vec<Tensor> = (0..all.len()).filter(|&i| !is_within_another(&disks, i)).map(|i| all[i]).collect();
        match outer[..] {
            [one] => one,
            [a, b] if a.is_positive_definite() => a.intersection(b),
            [a, b] => b.intersection(a),
            // Seen from `self` disks may be so large that rounding drowns it; seen from what is above all, none is.
            _ => joint(joint(self, &outer), &outer),
        }
    }
}

/// The intersection, found in coordinates in which `frame` is the identity.
fn joint(frame: Tensor, all: &[Tensor]) -> Tensor {
    around(&seen_from(frame, all)).tensor().along(frame.frames()[0])
}

/// Tensors as disks in the coordinates F v, F' F = frame, in which `frame` is the identity.
fn seen_from(frame: Tensor, all: &[Tensor]) -> Vec<Disk> {
    let [_, inverse] = frame.frames();
    all.iter().map(|m| Disk::of(m.along(inverse))).collect()
}

/// A disk may leave out so much of another, as a share of its radius, before that counts.
const ROUNDING: f64 = 1e-14;

/// A symmetric tensor as a disk.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Disk {
    centre: Vector,
    radius: f64,
}

impl Disk {
    fn of(m: Tensor) -> Self {
        Self { centre: Vector::new(0.5 * (m.xx - m.yy), m.xy), radius: 0.5 * (m.xx + m.yy) }
    }

    fn tensor(self) -> Tensor {
        Tensor::new(self.radius + self.centre.x, self.centre.y, self.radius - self.centre.x)
    }

    fn determinant(self) -> f64 {
        let distance = self.centre.norm();
        (self.radius - distance) * (self.radius + distance)
    }

    /// How far another one reaches beyond its border; negative where it stays inside.
    fn leaves_out(self, other: Disk) -> f64 {
        (other.centre - self.centre).norm() + other.radius - self.radius
    }

    /// The least one of the same centre that contains these.
    fn lifted(self, over: impl Iterator<Item = Disk>) -> Self {
        let needed = over.map(|other| (other.centre - self.centre).norm() + other.radius);
        Self { radius: needed.fold(f64::NEG_INFINITY, f64::max), ..self }
    }

    /// The disk that touches this one from outside in a direction, larger by so much.
    fn swollen(self, direction: Vector, by: f64) -> Self {
        Self { centre: self.centre + direction * by, radius: self.radius + by }
    }
}

/// Of equal disks the first is within none.
fn is_within_another(disks: &[Disk], i: usize) -> bool {
    let contains = |j: usize| disks[j].leaves_out(disks[i]) <= 0.0;
    (0..disks.len()).any(|j| j != i && contains(j) && (j < i || disks[i].leaves_out(disks[j]) > 0.0))
}

/// The disk of least determinant around all. At most three decide: from the largest disk on, what is left out most joins them, and
/// those of them that still decide stay. Every answer contains all disks, whatever rounding did before.
fn around(disks: &[Disk]) -> Disk {
    let largest = |a: &&Disk, b: &&Disk| a.determinant().total_cmp(&b.determinant());
    let mut best = disks.iter().max_by(largest).copied().unwrap_or(disks[0]);
    let mut deciding = vec![best];
    // Determinants grow from one to the next, so that this ends of itself; rounding might make it go around in circles.
    for _ in 0..4 * disks.len() {
        let left_out = |disk: &Disk| best.leaves_out(*disk);
        let Some(far) = disks.iter().copied().max_by(|a, b| left_out(a).total_cmp(&left_out(b))) else { break };
        if left_out(&far) <= ROUNDING * best.radius {
            break;
        }
        let (next, decide) = joined(&deciding, far);
        if best.lifted([far].into_iter()).determinant() <= next.determinant() {
            // What was left out is rounding, and lifting below is all it takes.
            break;
        }
        (best, deciding) = (next, decide);
    }
    best.lifted(disks.iter().copied())
}

/// The disk of least determinant around one disk, which touches it, and up to three others; and the disks that decide.
fn joined(others: &[Disk], new: Disk) -> (Disk, Vec<Disk>) {
    let mut best = (new, vec![new], f64::INFINITY);
    let mut offer = |candidate: Disk, deciding: &[Disk]| {
        let candidate = candidate.lifted(others.iter().copied().chain([new]));
        let determinant = candidate.determinant();
        if determinant < best.2 {
            best = (candidate, deciding.to_vec(), determinant);
        }
    };
    offer(new, &[new]);
    for (i, &a) in others.iter().enumerate() {
        offer(around_two([new, a]), &[new, a]);
        for &b in &others[i + 1..] {
            for disk in around_three([new, a, b]) {
                offer(disk, &[new, a, b]);
            }
        }
    }
    (best.0, best.1)
}

/// A disk seen from another: how far its centre is, by how much it is larger, and the difference of the squares of these, which
/// is positive where neither contains the other. A disk around both that touches the first in the direction n is larger than it
/// by (that difference) / (2 (offset . n - larger)), for it touches the second too.
#[derive(Clone, Copy)]
struct Seen {
    offset: Vector,
    larger: f64,
    power: f64,
}

impl Seen {
    fn from(first: Disk, other: Disk) -> Self {
        let (offset, larger) = (other.centre - first.centre, other.radius - first.radius);
        let distance = offset.norm();
        Self { offset, larger, power: (distance - larger) * (distance + larger) }
    }

    fn reach(self, direction: Vector) -> f64 {
        self.offset.dot(direction) - self.larger
    }

    /// By how much the disk is larger that touches the first in this direction, and this one.
    fn swelling(self, direction: Vector) -> f64 {
        0.5 * self.power / self.reach(direction)
    }
}

/// The disks from the largest to the smallest: what touches the largest is little larger than that where the others are almost
/// within it, so that little comes of rounding.
fn largest_first<const N: usize>(mut disks: [Disk; N]) -> [Disk; N] {
    disks.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    disks
}

/// The disk of least determinant around two, neither within the other. Of those that touch the first in the direction n it has
/// the determinant d + power r, d that of the first and r = (radius - centre . n) / (offset . n - larger); so r is the least number
/// for which (centre + r offset) . n = radius + r larger has a solution n of length one.
fn around_two(disks: [Disk; 2]) -> Disk {
    let [first, second] = largest_first(disks);
    let seen = Seen::from(first, second);
    let half = first.radius * seen.larger - first.centre.dot(seen.offset);
    let determinant = first.determinant().max(0.0);
    let root = half.mul_add(half, seen.power * determinant).max(0.0).sqrt();
    // The two forms of the larger root of power r^2 - 2 half r - determinant: neither takes near numbers from each other.
    let r = if half > 0.0 { (half + root) / seen.power } else { determinant / (root - half) };
    let n = first.centre + seen.offset * r;
    let direction = n * (1.0 / n.norm());
    first.swollen(direction, seen.swelling(direction))
}

/// The disks that three disks touch from inside: both lead to an equation that is linear in the direction from the first.
fn around_three(disks: [Disk; 3]) -> [Disk; 2] {
    let [first, second, third] = largest_first(disks);
    let [a, b] = [second, third].map(|other| Seen::from(first, other));
    let g = a.offset * b.power - b.offset * a.power;
    let along = b.power * a.larger - a.power * b.larger;
    let length = g.norm();
    let (cosine, sine) = (along / length, ((length - along) * (length + along)).max(0.0).sqrt() / length);
    let unit = g * (1.0 / length);
    [sine, -sine].map(|sine| {
        let direction = unit * cosine + unit.perpendicular() * sine;
        // The one whose denominator is not near zero.
        let clearer = if a.reach(direction).abs() > b.reach(direction).abs() { a } else { b };
        first.swollen(direction, clearer.swelling(direction))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    /// Two to eight tensors, of eigenvalues up to a thousand apart from those of others.
    fn metrics() -> impl Strategy<Value = Vec<Tensor>> {
        let one =
            (-1.5..1.5, -1.5..1.5, 0.0..std::f64::consts::PI).prop_map(|(large, small, angle): (f64, f64, f64)| {
                Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 10_f64.powf(large), 10_f64.powf(small))
            });
        proptest::collection::vec(one, 2..9)
    }

    fn of_all(all: &[Tensor]) -> Tensor {
        all[0].intersection_with_all(&all[1..])
    }

    /// F' M F.
    fn changed(m: Tensor, [f, g]: [Vector; 2]) -> Tensor {
        Tensor::new(m.dot(f, f), m.dot(f, g), m.dot(g, g))
    }

    /// The smallest of (v' M v) / (v' N v) over all v.
    fn least_ratio(m: Tensor, n: Tensor) -> f64 {
        let [a, b, c] = n.cholesky();
        changed(m, [Vector::new(1.0 / a, 0.0), Vector::new(-b / (a * c), 1.0 / c)]).eigen().small
    }

    /// By what share one of them is somewhere larger than the other.
    fn apart(m: Tensor, n: Tensor) -> f64 {
        1.0 - least_ratio(m, n).min(least_ratio(n, m))
    }

    /// The least determinant that a search finds among tensors that are above all: a bound from above.
    fn least_determinant(all: &[Tensor]) -> f64 {
        let at = |x: Vector| Disk { centre: x, radius: 0.0 }.lifted(all.iter().map(|&m| Disk::of(m))).determinant();
        let reach = all.iter().map(|m| m.xx + m.yy).fold(0.0, f64::max);
        let (mut best, mut step) = (Vector::default(), reach);
        while step > 1e-9 * reach {
            let around = (0..24)
                .map(|i| best + Vector::new((f64::from(i) * 0.2618).cos(), (f64::from(i) * 0.2618).sin()) * step);
            match around.min_by(|a, b| at(*a).total_cmp(&at(*b))).filter(|x| at(*x) < at(best)) {
                Some(x) => best = x,
                None => step *= 0.8,
            }
        }
        at(best)
    }

    proptest! {
        #![proptest_config(cases(256))]
        #[test]
        fn it_is_above_all(all in metrics()) {
            let m = of_all(&all);
            prop_assert!(all.iter().all(|&n| least_ratio(m, n) > 1.0 - 1e-11), "{m:?}");
        }

        #[test]
        fn no_search_finds_a_lower_determinant(all in metrics()) {
            let (found, least) = (of_all(&all).determinant(), least_determinant(&all));
            prop_assert!(found < least * (1.0 + 1e-9), "{found} {least}");
        }

        #[test]
        fn neither_order_nor_repetition_matters(all in metrics(), turn in 0_usize..8) {
            let mut others = all.clone();
            others.rotate_left(turn % all.len());
            others.swap(0, turn / 2 % all.len());
            others.push(all[turn % all.len()]);
            prop_assert!(apart(of_all(&all), of_all(&others)) < 1e-9);
            let again = of_all(&all).intersection_with_all(&all);
            prop_assert!(apart(of_all(&all), again) < 1e-9);
        }

        #[test]
        fn it_goes_along_with_changes_of_coordinates(all in metrics(), x in -2.0..2.0, y in 0.5..2.0, power in -9..9_i32) {
            let unit = 10_f64.powi(power);
            let basis = [Vector::new(1.0, x) * unit, Vector::new(-0.5 * x, y) * unit];
            let seen: Vec<Tensor> = all.iter().map(|&m| changed(m, basis)).collect();
            prop_assert!(apart(changed(of_all(&all), basis), of_all(&seen)) < 1e-9);
        }

        #[test]
        fn of_two_it_is_the_intersection_to_the_bit(all in metrics()) {
            let (a, b) = (all[0], all[1]);
            prop_assert_eq!(a.intersection_with_all(&[b]), a.intersection(b));
            let below = [a * 0.25, b * 0.5, a * 0.5];
            let both = a.intersection_with_all(&[below[0], b, below[1], below[2]]);
            prop_assert_eq!(both, a.intersection(b));
        }

        #[test]
        fn what_is_above_all_comes_back_to_the_bit(all in metrics()) {
            let sum = all.iter().fold(Tensor::default(), |sum, &m| sum + m);
            prop_assert_eq!(sum.intersection_with_all(&all), sum);
            prop_assert_eq!(all[0].intersection_with_all(&[all[1], sum, all[1]]), sum);
        }

        /// A little more or less of each changes the answer by little more than that.
        #[test]
        fn it_changes_continuously(all in metrics(), power in -9..-2_i32, seed in 0.0..100.0_f64) {
            let share = 10_f64.powi(power);
            let factor = |i: usize| 1.0 + share * (seed + 12.9898 * i as f64).sin();
            let near: Vec<Tensor> = all.iter().enumerate().map(|(i, &m)| m * factor(i)).collect();
            let gap = apart(of_all(&all), of_all(&near));
            prop_assert!(gap < 1e3 * share, "{gap} for {share}");
        }
    }

    /// Three strips, each turned by 60 degrees: what is above all three is round, and no two of them have that.
    #[test]
    fn three_can_decide() {
        let strips = [0.0, 1.0, 2.0].map(|i: f64| {
            let angle = i * std::f64::consts::FRAC_PI_3;
            Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 9.0, 1.0)
        });
        assert!(apart(of_all(&strips), Tensor::IDENTITY * 9.0) < 1e-14);
        // Folded pairwise it is turned towards the last, and has the larger determinant.
        let folded = strips[0].intersection(strips[1]).intersection(strips[2]);
        assert!(folded.determinant() > 1.01 * 81.0, "{folded:?}");
    }

    /// What is above both but for rounding comes back but for rounding, whichever of its borders the others touch.
    #[test]
    fn what_is_above_all_but_for_rounding_stays() {
        let a = Tensor::new(4.423_757_466_347_492, 3.763_395_793_429_007_4, 3.273_834_080_057_199);
        let b = Tensor::new(13.207_671_018_643_483, 10.144_881_017_853_209, 7.848_624_399_985_023);
        let both = a.intersection(b);
        assert!(apart(both.intersection_with_all(&[a, b]), both) < 1e-12);
        assert!(apart(a.intersection_with_all(&[both, b]), both) < 1e-12);
        // And what is above both but for a little more than that.
        for share in [1e-13, 1e-11, 1e-9, 1e-7] {
            let less = both * (1.0 - share);
            assert!(apart(less.intersection_with_all(&[a, b]), both) < 2.0 * share + 1e-12);
        }
    }

    #[test]
    fn what_says_nothing_in_a_direction_changes_nothing_there() {
        let strip = |x: f64, y: f64| Tensor::from_axis(Vector::new(x, y), 8.0, 0.0);
        let m = Tensor::IDENTITY.intersection_with_all(&[strip(1.0, 0.0), strip(0.0, 1.0), Tensor::default()]);
        assert!(apart(m, Tensor::IDENTITY * 8.0) < 1e-14, "{m:?}");
        let m = Tensor::IDENTITY.intersection_with_all(&[strip(0.6, 0.8), strip(0.6, 0.8) * 0.5, Tensor::default()]);
        assert!(apart(m, Tensor::from_axis(Vector::new(0.6, 0.8), 8.0, 1.0)) < 1e-14, "{m:?}");
    }
}

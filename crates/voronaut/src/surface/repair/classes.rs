//! Disjoint sets of numbers, the least member of each standing for it.

/// Disjoint sets of the numbers below a bound (union-find with path halving): nearly linear in all.
#[derive(Clone, Debug)]
pub(super) struct Classes {
    parent: Vec<u32>,
}

impl Classes {
    /// Every number alone.
    pub(super) fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The least number of the set.
    pub(super) fn of(&self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            i = self.parent[i as usize];
        }
        i
    }

    /// Makes one set of two; whether they were two.
    pub(super) fn join(&mut self, i: u32, j: u32) -> bool {
        let (i, j) = (self.shorten(i), self.shorten(j));
        self.parent[i.max(j) as usize] = i.min(j);
        i != j
    }

    /// Lets every number know its set at once: [`Classes::of`] takes one step then.
    pub(super) fn flatten(&mut self) {
        for i in 0..self.parent.len() {
            // The parent is smaller, and so flat already.
            self.parent[i] = self.parent[self.parent[i] as usize];
        }
    }

    fn shorten(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            let up = self.parent[self.parent[i as usize] as usize];
            self.parent[i as usize] = up;
            i = up;
        }
        i
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_stands_for_its_set() {
        let mut classes = Classes::new(7);
        assert!(classes.join(6, 4) && classes.join(4, 2) && !classes.join(6, 2));
        assert!(classes.join(1, 3) && classes.join(3, 6));
        classes.flatten();
        assert_eq!([0, 1, 2, 3, 4, 5, 6].map(|i| classes.of(i)), [0, 1, 1, 1, 1, 5, 1]);
    }
}

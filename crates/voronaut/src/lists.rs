//! Lists: in order, without repetitions, in rows.

/// What there is among these, each once, in order.
pub(crate) fn distinct<T: Ord>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut list: Vec<T> = items.into_iter().collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// Things by their numbers, the least first; of equal ones in order.
pub(crate) fn ranked<T: Ord>(items: impl IntoIterator<Item = (f64, T)>) -> Vec<(f64, T)> {
    let mut list: Vec<(f64, T)> = items.into_iter().collect();
    list.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    list
}

/// Two things, the smaller first.
pub(crate) fn in_order<T: Ord>([a, b]: [T; 2]) -> [T; 2] {
    if b < a { [b, a] } else { [a, b] }
}

/// Items in numbered rows, one row after the other in one list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows<T> {
    /// Where each row begins, and where the last one ends.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy + Default> Rows<T> {
    /// So many rows of items with the numbers of their rows; those of a row stay in their order.
    pub(crate) fn new(rows: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut starts = vec![0_u32; rows + 1];
        for (row, _) in items.clone() {
            starts[row as usize + 1] += 1;
        }
        for row in 0..rows {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let mut list = vec![T::default(); starts[rows] as usize];
        for (row, item) in items {
            let at = &mut next[row as usize];
            list[*at as usize] = item;
            *at += 1;
        }
        Self { starts, items: list }
    }

    /// How many rows there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The items of a row.
    pub(crate) fn row(&self, row: usize) -> &[T] {
        &self.items[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_in_their_rows_in_order_and_once() {
        let rows = Rows::new(4, [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd')].into_iter());
        assert_eq!([0, 1, 2, 3].map(|row| rows.row(row).to_vec()), [vec!['b'], vec![], vec!['a', 'c'], vec!['d']]);
        assert_eq!(distinct([3, 1, 3, 2, 1]), [1, 2, 3]);
    }
}

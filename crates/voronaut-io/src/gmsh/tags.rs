//! Tags: the numbers by which a file calls its nodes and elements, in any order and with gaps.

/// Which entry each tag belongs to.
#[derive(Default)]
pub(super) struct Tags {
    count: usize,
    /// The first tag, if they follow each other.
    first: u64,
    /// If they do not, each with its entry, sorted.
    sorted: Vec<(u64, u32)>,
}

impl Tags {
    /// The tags of all entries, in their order.
    ///
    /// # Errors
    /// A tag that occurs twice, and its first two entries.
    pub(super) fn new(tags: &[u64]) -> Result<Self, (u64, [u32; 2])> {
        let (count, first) = (tags.len(), tags.first().copied().unwrap_or(1));
        if (0..).zip(tags).all(|(entry, tag)| tag.checked_sub(first) == Some(entry)) {
            return Ok(Self { count, first, sorted: Vec::new() });
        }
        let mut sorted: Vec<(u64, u32)> = tags.iter().copied().zip(0..).collect();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err((pair[0].0, [pair[0].1, pair[1].1])),
            None => Ok(Self { count, first, sorted }),
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// The entry of a tag, from 0.
    pub(super) fn find(&self, tag: u64) -> Option<u32> {
        if self.sorted.is_empty() {
            let entry = tag.checked_sub(self.first)?;
            return (entry < self.count as u64).then_some(entry as u32);
        }
        let found = self.sorted.binary_search_by_key(&tag, |&(tag, _)| tag).ok()?;
        Some(self.sorted[found].1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_in_any_order() {
        for tags in [vec![], vec![7], vec![3, 4, 5], vec![u64::MAX], vec![9, 2, 4], vec![u64::MAX, 0, 1]] {
            let found = Tags::new(&tags).unwrap();
            assert_eq!(found.len(), tags.len());
            for tag in 0..12 {
                let expected = tags.iter().position(|&t| t == tag).map(|entry| entry as u32);
                assert_eq!(found.find(tag), expected, "{tag} of {tags:?}");
            }
            assert_eq!(found.find(u64::MAX).is_some(), tags.contains(&u64::MAX));
        }
        assert_eq!(Tags::new(&[4, 9, 1, 9]).err(), Some((9, [1, 3])));
    }
}

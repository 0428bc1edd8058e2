//! What is said of one thing, or of many.

/// The number and what is said of so many: of `[one|many]` in the words the first is for one.
pub(crate) fn counted(count: usize, words: &str) -> String {
    let mut parts = words.split(['[', '|', ']']);
    let mut told = format!("{count} {}", parts.next().unwrap_or_default());
    while let (Some(one), Some(many), Some(rest)) = (parts.next(), parts.next(), parts.next()) {
        told.push_str(if count == 1 { one } else { many });
        told.push_str(rest);
    }
    told
}

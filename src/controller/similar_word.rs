//! Suggestion for a mistyped word.

/// The word in `known` that is most similar to `word`; `None` if no known word is similar enough. Upper and lower case
/// do not matter.
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // A longer word is not a typing mistake, and the comparison would be slow.
    if word.len() > 64 {
        return None;
    }
    let word = word.to_lowercase();
    let scored = known.into_iter().map(|other| (similarity(&word, &other.to_lowercase()), other));
    scored.filter(|(score, _)| *score > 0.75).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, other)| other)
}

/// Similarity of two words. If a single typing mistake explains the difference, the result is 1 higher, because the
/// similarity of short words is otherwise low.
fn similarity(word: &str, other: &str) -> f64 {
    let slip = if word.len() > 2 && strsim::osa_distance(word, other) == 1 { 1.0 } else { 0.0 };
    strsim::jaro_winkler(word, other) + slip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_similar_words_only() {
        assert_eq!(nearest("jpm", ["JMP", "OUT"]), Some("JMP"));
        assert_eq!(nearest("xyz", ["JMP", "OUT"]), None);
        assert_eq!(nearest(&"J".repeat(65), ["JMP"]), None);
    }
}

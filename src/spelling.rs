//! What a misspelt word was to be.

/// Keys and words less alike than this are no slip of the finger.
pub(crate) const LIKE_A_KEY: f64 = 0.6;

/// The candidate most like `word`, when one is more like it than `least` (0 nothing in common, 1 the
/// same).
pub(crate) fn nearest<'a>(
    word: &str,
    least: f64,
    candidates: impl Iterator<Item = &'a str>,
) -> Option<&'a str> {
    candidates
        .map(|candidate| (likeness(word, candidate), candidate))
        .filter(|(likeness, _)| *likeness > least)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// What is wrong with a word in a list that is none of a `kind`'s, to stand after it. (`all` and `none` alone
/// are no list.)
pub(crate) fn advice<'a>(
    word: &str,
    kind: &str,
    words: impl Iterator<Item = &'a str> + Clone,
) -> String {
    match word.to_ascii_lowercase().as_str() {
        "none" | "all" => return format!("stands alone; name no other {kind} beside it"),
        "" => return format!("is no {kind}; write `none` for none, and one word between commas"),
        _ => {}
    }
    match nearest(word, LIKE_A_KEY, words.clone()) {
        Some(near) => format!("is no {kind}; did you mean `{near}`?"),
        None => format!("is none of {}", words.collect::<Vec<_>>().join(", ")),
    }
}

/// How alike two words are: 0 nothing in common, 1 the same.
pub(crate) fn likeness(a: &str, b: &str) -> f64 {
    strsim::normalized_damerau_levenshtein(a, b)
}

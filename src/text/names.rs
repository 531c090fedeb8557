//! Names in messages: those that are almost right, and how to show those that may be anything.

/// Characters of a text from a file that a message shows.
const SHOWN: usize = 32;

/// The first characters of a text from a file, without line breaks or control characters, for a message of one line.
pub(crate) fn excerpt(text: &str) -> String {
    beginning(text, SHOWN)
}

/// The first `shown` characters, likewise.
pub(crate) fn beginning(text: &str, shown: usize) -> String {
    let mut escaped = text.chars().flat_map(char::escape_debug);
    let mut shown: String = escaped.by_ref().take(shown).collect();
    if escaped.next().is_some() {
        shown.push_str("...");
    }
    shown
}

/// The known name nearest to `name`, and how many slips (a letter added, left out, changed, or two exchanged) lie between
/// them; upper and lower case count as alike. `None` when nothing is known.
pub(crate) fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<(&'k str, usize)> {
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|known| (known, strsim::damerau_levenshtein(&name, &known.to_lowercase())))
        .min_by_key(|&(_, slips)| slips)
}

/// The known name that was meant by `name`: the nearest, when it differs in at most a third of the letters, or in one.
pub(crate) fn meant<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let letters = name.chars().count();
    nearest(name, known)
        .filter(|&(_, slips)| slips <= (letters / 3).max(1) && slips < letters)
        .map(|(known, _)| known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_excerpt_is_short_and_one_line() {
        assert_eq!(excerpt("a\nb\u{1b}"), "a\\nb\\u{1b}");
        assert_eq!(excerpt(&"x".repeat(SHOWN)), "x".repeat(SHOWN), "no longer than that: all of it");
        assert_eq!(excerpt(&"x".repeat(SHOWN + 1)), format!("{}...", "x".repeat(SHOWN)));
        assert_eq!(
            excerpt(&"\t".repeat(SHOWN)),
            format!("{}...", "\\t".repeat(SHOWN / 2)),
            "also when escaped"
        );
        assert_eq!(beginning(&"x".repeat(1000), 160).len(), 160 + "...".len());
    }

    #[test]
    fn the_name_with_the_fewest_slips_wins() {
        let known = ["tension", "load", "height"];
        assert_eq!(nearest("tnesion", known), Some(("tension", 1)));
        assert_eq!(nearest("LOAD", known), Some(("load", 0)));
        assert_eq!(nearest("weight", known), Some(("height", 1)));
        assert_eq!(nearest("x", []), None);
    }

    #[test]
    fn a_name_that_is_far_from_all_means_none() {
        let known = ["tension", "load", "height"];
        assert_eq!(["tnesion", "loads", "hieght"].map(|name| meant(name, known)), known.map(Some));
        assert_eq!(["obstacle", "radius", "q", ""].map(|name| meant(name, known)), [None; 4]);
    }
}

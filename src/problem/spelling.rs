//! Names that are almost right.

/// The known name nearest to `name`, and how many slips (a letter added, left out, changed, or two exchanged) lie between
/// them; upper and lower case count as alike. `None` when nothing is known.
pub(crate) fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<(&'k str, usize)> {
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|known| (known, strsim::damerau_levenshtein(&name, &known.to_lowercase())))
        .min_by_key(|&(_, slips)| slips)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_with_the_fewest_slips_wins() {
        let known = ["tension", "load", "height"];
        assert_eq!(nearest("tnesion", known), Some(("tension", 1)));
        assert_eq!(nearest("LOAD", known), Some(("load", 0)));
        assert_eq!(nearest("weight", known), Some(("height", 1)));
        assert_eq!(nearest("x", []), None);
    }
}

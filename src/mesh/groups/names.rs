//! Many short names.

/// Names in the order in which they were given, all in one text: a mesh file may name a hundred thousand parts in a megabyte.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names {
    text: String,
    /// Where in the text each name ends.
    ends: Vec<u32>,
}

impl Names {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The names.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        (0..self.len()).map(|k| self.get(k))
    }

    /// Whether one is called like this.
    pub fn contains(&self, name: &str) -> bool {
        self.iter().any(|known| known == name)
    }

    /// The name in place `k`.
    pub(in crate::mesh) fn get(&self, k: usize) -> &str {
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        &self.text[start as usize..self.ends[k] as usize]
    }

    /// Adds a name behind the others.
    pub(in crate::mesh) fn push(&mut self, name: &str) {
        self.text.push_str(name);
        self.ends.push(u32::try_from(self.text.len()).expect("names of less than 4 GiB"));
    }

    /// Room for so many names with so many bytes together, and no more.
    pub(in crate::mesh) fn with_capacity(names: usize, bytes: usize) -> Self {
        Self { text: String::with_capacity(bytes), ends: Vec::with_capacity(names) }
    }
}

impl<S: AsRef<str>> FromIterator<S> for Names {
    fn from_iter<I: IntoIterator<Item = S>>(given: I) -> Self {
        let mut names = Self::default();
        given.into_iter().for_each(|name| names.push(name.as_ref()));
        names
    }
}

impl<const N: usize> PartialEq<[&str; N]> for &Names {
    fn eq(&self, other: &[&str; N]) -> bool {
        self.iter().eq(other.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_back_as_they_were_given() {
        let names = Names::from_iter(["rubber", "", "Stahl \u{fc}ber", "steel"]);
        assert_eq!(&names, ["rubber", "", "Stahl \u{fc}ber", "steel"]);
        assert_ne!(&names, ["rubber", "", "steel", "Stahl \u{fc}ber"]);
        assert!(!names.is_empty() && Names::default().is_empty());
        assert_eq!((names.len(), names.get(1), names.get(3)), (4, "", "steel"));
        assert!(names.contains("") && names.contains("steel") && !names.contains("rubberStahl"));
    }
}

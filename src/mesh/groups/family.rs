//! Names, and what carries them.

use super::names::Names;

/// Names, and the triangles or edges that carry them.
///
/// Whatever carries the same names is one *part*. A member is filed under its part, not under each of its names: a million
/// triangles that are in a thousand groups together take a million entries and a thousand numbers. A member of several
/// parts carries the names of all of them.
#[derive(Debug, Clone, Default)]
pub(in crate::mesh) struct Family<M> {
    /// All different, in the order in which they were given.
    names: Names,
    /// The numbers of the names of part `p`, from where those of part `p - 1` end, to `ends[p]`.
    carried: Vec<u32>,
    ends: Vec<u32>,
    /// The members of each part, each once, in increasing order.
    members: Vec<(M, u32)>,
}

impl<M: Copy + Ord> Family<M> {
    /// The names, for each part the numbers of those that it carries, and members with their parts, in any order.
    pub(in crate::mesh) fn new(
        names: Names,
        parts: impl IntoIterator<Item = impl IntoIterator<Item = u32>>,
        mut members: Vec<(M, u32)>,
    ) -> Self {
        members.sort_unstable();
        members.dedup();
        let (mut carried, mut ends) = (Vec::new(), Vec::new());
        for part in parts {
            carried.extend(part);
            ends.push(carried.len() as u32);
        }
        Self { names, carried, ends, members }
    }

    pub(super) fn names(&self) -> &Names {
        &self.names
    }

    /// The numbers of the names that a part carries.
    fn carried_by(&self, part: u32) -> &[u32] {
        let part = part as usize;
        let start = if part == 0 { 0 } else { self.ends[part - 1] };
        &self.carried[start as usize..self.ends[part] as usize]
    }

    /// The members that carry `name`, each once, in increasing order; `None` when there is no such name.
    pub(super) fn members<'f>(&'f self, name: &str) -> Option<impl Iterator<Item = M> + use<'f, M>> {
        let number = self.names.iter().position(|known| known == name)? as u32;
        let carries: Vec<bool> =
            (0..self.ends.len() as u32).map(|part| self.carried_by(part).contains(&number)).collect();
        let of_one_member = self.members.chunk_by(|a, b| a.0 == b.0);
        let carrying =
            of_one_member.filter(move |filed| filed.iter().any(|(_, part)| carries[*part as usize]));
        Some(carrying.map(|filed| filed[0].0))
    }

    /// The names that `member` carries, in the order in which they were given.
    pub(super) fn names_of(&self, member: M) -> Vec<&str> {
        let start = self.members.partition_point(|(other, _)| *other < member);
        let filed = self.members[start..].iter().take_while(|(other, _)| *other == member);
        let mut numbers: Vec<u32> = filed.flat_map(|(_, part)| self.carried_by(*part)).copied().collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers.into_iter().map(|number| self.names.get(number as usize)).collect()
    }

    /// The same with a further name, carried by `members` as by a part of their own.
    pub(super) fn with(mut self, name: String, members: impl IntoIterator<Item = M>) -> Self {
        let part = self.ends.len() as u32;
        self.carried.push(self.names.len() as u32);
        self.ends.push(self.carried.len() as u32);
        self.names.push(&name);
        self.members.extend(members.into_iter().map(|member| (member, part)));
        // Most often two sorted runs, which a stable sort merges.
        self.members.sort();
        self
    }

    /// Children carry the names of their parents, which are asked for in increasing order. Linear time where the children
    /// are in that order too.
    pub(super) fn inherited<C: IntoIterator<Item = M>>(&self, mut children: impl FnMut(M) -> C) -> Self {
        let mut members = Vec::new();
        for filed in self.members.chunk_by(|a, b| a.0 == b.0) {
            for child in children(filed[0].0) {
                members.extend(filed.iter().map(|&(_, part)| (child, part)));
            }
        }
        if !members.is_sorted() {
            members.sort_unstable();
        }
        let Self { names, carried, ends, .. } = self;
        Self { names: names.clone(), carried: carried.clone(), ends: ends.clone(), members }
    }
}

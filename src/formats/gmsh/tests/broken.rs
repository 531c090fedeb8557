//! Valid files cut short and changed at random.

use super::super::{GmshNote, GmshTriangulation, parse};
use super::{VALID, read};
use crate::numeric::Random;

/// Where the last triangle is complete: the front of the line `$EndElements`.
fn end_of_elements(bytes: &[u8]) -> usize {
    let closing = b"\n$EndElements";
    // The first: Gmsh repeats the mesh before each view.
    bytes.windows(closing.len()).position(|window| window == closing).expect("the section is closed")
}

/// The mesh alone: behind it a file may end after any view.
fn without_views(mut mesh: GmshTriangulation) -> GmshTriangulation {
    mesh.notes.retain(|note| !matches!(note, GmshNote::ValuesLeftOut { .. }));
    GmshTriangulation { views: Vec::new(), ..mesh }
}

#[test]
fn a_file_cut_anywhere_is_refused_or_read_in_full() {
    for file in VALID {
        let mesh = read(file.bytes);
        let closed = end_of_elements(file.bytes) + "\n$EndElements".len();
        for cut in 0..file.bytes.len() {
            match parse(&file.bytes[..cut]) {
                Ok(found) => {
                    let is_whole = without_views(found) == without_views(mesh.clone());
                    assert!(cut >= closed && is_whole, "{} cut at {cut}", file.name);
                }
                Err(error) => assert!(cut != closed, "{} cut at {cut}: {error}", file.name),
            }
        }
    }
}

/// Changes some bytes: to any byte, to one that means something in a file, or by moving a passage.
fn mutate(random: &mut Random, bytes: &mut Vec<u8>) {
    const TELLING: &[u8] = b"0123456789-.eE \n\r\t$nafi\0\x01\x7f\x80\xff";
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes[at] = random.below(256) as u8,
            1 => bytes[at] = TELLING[random.below(TELLING.len())],
            2 => bytes.insert(at, TELLING[random.below(TELLING.len())]),
            3 => drop(bytes.drain(at..(at + 1 + random.below(12)).min(bytes.len() - 1).max(at))),
            _ => {
                let length = random.below(40).min(bytes.len() - at);
                let to = random.below(bytes.len() - length + 1);
                bytes.copy_within(at..at + length, to);
            }
        }
    }
}

#[test]
fn a_file_changed_at_random_is_refused_or_read_without_contradiction() {
    const CHANGES: usize = 1500;
    let mut random = Random::new(1);
    let (mut accepted, mut rejected) = (0, 0);
    for file in VALID {
        for _ in 0..CHANGES {
            let mut bytes = file.bytes.to_vec();
            mutate(&mut random, &mut bytes);
            match parse(&bytes) {
                Ok(mesh) => {
                    accepted += 1;
                    assert_eq!(mesh.points.len(), mesh.node_tags.len());
                    assert_eq!(mesh.triangles.len(), mesh.element_tags.len());
                    assert!(mesh.points.iter().flatten().all(|x| x.is_finite()));
                    assert!(mesh.triangles.iter().flatten().all(|&k| k < mesh.points.len()));
                }
                Err(error) => {
                    rejected += 1;
                    assert!(!error.to_string().contains(char::is_control), "{error:?}");
                }
            }
        }
    }
    // Most changes do harm, some fall on a coordinate or on a skipped section.
    assert!(accepted > CHANGES && rejected > CHANGES, "{accepted} accepted, {rejected} rejected");
}

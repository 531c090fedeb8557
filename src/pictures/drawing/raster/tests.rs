use std::cell::Cell;

use super::*;

thread_local! {
    static VISITED: Cell<usize> = const { Cell::new(0) };
}

pub(super) fn visited() {
    VISITED.set(VISITED.get() + 1);
}

/// The pixels that `draw` paints, and how many it looks at.
fn pixels(draw: impl FnOnce(&mut dyn FnMut(usize, usize))) -> (Vec<[usize; 2]>, usize) {
    VISITED.set(0);
    let mut painted = Vec::new();
    draw(&mut |column, row| painted.push([column, row]));
    painted.sort_unstable();
    (painted, VISITED.get())
}

const SIZE: [usize; 2] = [200, 160];

fn all() -> impl Iterator<Item = [usize; 2]> {
    (0..SIZE[0]).flat_map(|column| (0..SIZE[1]).map(move |row| [column, row]))
}

/// Corners in a fixed but irregular order, some outside of the grid.
fn samples(count: usize) -> impl Iterator<Item = [[f64; 2]; 3]> {
    let coordinate = |seed: usize| (seed * seed * 7919 % 2503) as f64 / 2503.0 * 260.0 - 30.0;
    (0..count).map(move |k| [0, 1, 2].map(|c| [coordinate(6 * k + 2 * c), coordinate(6 * k + 2 * c + 1)]))
}

#[test]
fn a_triangle_has_the_pixels_whose_centres_lie_in_it() {
    for corners in samples(40) {
        let gradients = barycentric_gradients(corners).expect("an area");
        let inside = |[column, row]: &[usize; 2]| {
            (0..3).all(|k| {
                let from = corners[(k + 1) % 3];
                let [x, y] = [*column as f64 + 0.5 - from[0], *row as f64 + 0.5 - from[1]];
                gradients[k][0] * x + gradients[k][1] * y >= ON_EDGE
            })
        };
        let (painted, _) = pixels(|paint| triangle(corners, SIZE, |column, row, _| paint(column, row)));
        let expected: Vec<[usize; 2]> = all().filter(inside).collect();
        assert_eq!(painted, expected, "{corners:?}");
    }
}

#[test]
fn a_line_has_the_pixels_near_it() {
    for ([from, to, _], radius) in samples(40).zip([0.3, 1.0, 4.5].into_iter().cycle()) {
        for to in [to, [to[0], from[1]], [from[0], to[1]], from] {
            let vector = [to[0] - from[0], to[1] - from[1]];
            let square = vector[0] * vector[0] + vector[1] * vector[1];
            let near = |[column, row]: &[usize; 2]| {
                let offset = [*column as f64 + 0.5 - from[0], *row as f64 + 0.5 - from[1]];
                let projected = offset[0] * vector[0] + offset[1] * vector[1];
                let place = if square > 0.0 { (projected / square).clamp(0.0, 1.0) } else { 0.0 };
                let [dx, dy] = [0, 1].map(|k| offset[k] - place * vector[k]);
                dx * dx + dy * dy <= radius * radius
            };
            let (painted, _) =
                pixels(|paint| line([from, to], radius, SIZE, |column, row, _| paint(column, row)));
            let expected: Vec<[usize; 2]> = all().filter(near).collect();
            assert_eq!(painted, expected, "{from:?} {to:?} {radius}");
        }
    }
}

/// The bounding box of a thin slanted shape has a thousand times its pixels.
#[test]
fn no_more_pixels_are_looked_at_than_a_few_for_each_that_is_painted() {
    let size = [3000, 3000];
    let slanted = [[10.0, 10.0], [2900.0, 2700.0], [2900.0, 2701.0]];
    for shift in [0.0, 0.1, 50.0] {
        let corners = slanted.map(|[x, y]| [x, y + shift]);
        let (painted, visited) = pixels(|paint| triangle(corners, size, |column, row, _| paint(column, row)));
        assert!(painted.len() > 1000 && visited <= painted.len() + 3000, "{visited}, {}", painted.len());
        let (painted, visited) =
            pixels(|paint| line([corners[0], corners[1]], 1.5, size, |column, row, _| paint(column, row)));
        assert!(visited <= 4 * painted.len(), "{visited}, {}", painted.len());
    }
    // Upright and flat strips narrower than a pixel: one line, at most, and its pixels.
    for corners in [[[7.4, 0.0], [7.6, 0.0], [7.6, 3000.0]], [[0.0, 7.6], [0.0, 7.7], [3000.0, 7.7]]] {
        let (painted, visited) = pixels(|paint| triangle(corners, size, |column, row, _| paint(column, row)));
        assert!(visited <= painted.len() + 2, "{visited}, {}", painted.len());
    }
}

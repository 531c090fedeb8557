//! Many triangles on one grid, on all cores: each band of rows is painted by itself.

use super::{extent, pixel_range, triangle};
use crate::parallel::prelude::*;

/// Rows of a band: few enough for a cache, and enough for all cores.
const BAND: usize = 64;

/// Consecutive rows of a grid.
pub(crate) struct Band<'g, T> {
    /// The first row.
    top: usize,
    width: usize,
    pixels: &'g mut [T],
}

/// Calls `paint(band, t)` for each band of a grid, `width` pixels wide, and each of the triangles that may have a pixel in it, in
/// their order: what is painted is the same as on the grid as a whole.
pub(crate) fn in_bands<T: Send>(
    grid: &mut [T],
    width: usize,
    triangles: impl Iterator<Item = [[f64; 2]; 3]>,
    paint: impl Fn(&mut Band<T>, usize) + Sync,
) {
    let height = grid.len() / width;
    let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
    for (corners, t) in triangles.zip(0u32..) {
        let rows = pixel_range(extent(corners.map(|[_, y]| y)), height);
        (rows.start / BAND..rows.end.div_ceil(BAND)).for_each(|band| bands[band].push(t));
    }
    grid.par_chunks_mut(width * BAND).zip(bands).enumerate().for_each(|(band, (pixels, triangles))| {
        let mut band = Band { top: BAND * band, width, pixels };
        triangles.into_iter().for_each(|t| paint(&mut band, t as usize));
    });
}

impl<T> Band<'_, T> {
    /// Calls `paint(pixel, barycentric coordinates)` for each pixel of the band whose centre lies in the triangle, given on the
    /// whole grid.
    pub(crate) fn triangle(&mut self, corners: [[f64; 2]; 3], mut paint: impl FnMut(&mut T, [f64; 3])) {
        let (width, top) = (self.width, self.top as f64);
        let size = [width, self.pixels.len() / width];
        triangle(corners.map(|[x, y]| [x, y - top]), size, |column, row, weights| {
            paint(&mut self.pixels[row * width + column], weights);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole and broken coordinates, triangles over one and over several bands, some beyond the edges.
    fn sample() -> Vec<[[f64; 2]; 3]> {
        let size = [90.0, 2.0 * BAND as f64 + 30.0];
        let at = |k: usize| {
            let [x, y] = size.map(|length| (k * k * 7919 % 2503) as f64 / 2400.0 * length - 3.0);
            if k.is_multiple_of(2) { [x.round(), y.round()] } else { [x, (y * 1.7) % size[1]] }
        };
        (0..60usize)
            .map(|t| {
                if t.is_multiple_of(3) {
                    [at(t), at(t + 1), at(t + 2)]
                } else {
                    [at(t), at(t).map(|x| x + 9.0), at(t + 1)]
                }
            })
            .collect()
    }

    #[test]
    fn bands_are_painted_like_the_whole_in_the_order_of_the_triangles() {
        let (width, height, triangles) = (90, 2 * BAND + 30, sample());
        let mut whole = vec![Vec::new(); width * height];
        for (t, &corners) in triangles.iter().enumerate() {
            triangle(corners, [width, height], |column, row, _| whole[row * width + column].push(t));
        }
        let mut grid = vec![Vec::new(); width * height];
        in_bands(&mut grid, width, triangles.iter().copied(), |band, t| {
            band.triangle(triangles[t], |pixel: &mut Vec<usize>, _| pixel.push(t));
        });
        assert!(grid == whole);
        let layers = whole.iter().map(Vec::len).max();
        assert!(layers > Some(2), "the order matters: {layers:?}");
    }
}

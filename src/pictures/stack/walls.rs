//! Obstacles in the section: hatched bodies.

use crate::pictures::drawing::canvas::Canvas;
use crate::pictures::drawing::color::WALL;
use crate::pictures::drawing::frame::Frame;

/// From one line of the hatching to the next, in pixels along the section.
const HATCHING: f64 = 16.0;
/// Columns are wider by this part of a pixel: no paper shines through between them.
const OVERLAP: f64 = 0.2;

/// Draws a body from its surface to the edge `end` of the frame. The surface is given by its height on the canvas at the middles of
/// equal steps along the frame.
pub(super) fn draw(canvas: &mut Canvas, frame: &Frame, surface: &[Option<f64>], end: f64) {
    let [body, hatching, _] = WALL;
    let step = frame.width / surface.len() as f64;
    let left = |k: usize| frame.left + k as f64 * step;
    let inside = |y: f64| y.clamp(frame.top, frame.bottom());
    for (k, y) in surface.iter().enumerate() {
        let Some(y) = y.map(inside).filter(|y| *y != end) else { continue };
        canvas.fill([[left(k), y.min(end)], [left(k + 1) + OVERLAP, y.max(end)]], body);
    }
    // Lines that rise to the right, each as many steps long as the frame is high.
    let holds = |k: usize, at: f64| {
        surface[k].map(inside).is_some_and(|y| (y.min(end)..=y.max(end)).contains(&at) && y != end)
    };
    let steps = (frame.height / step) as usize;
    let apart = (HATCHING / step) as usize;
    for start in (0..surface.len() + steps).step_by(apart.max(1)) {
        let columns = start.saturating_sub(steps)..=start.min(surface.len() - 1);
        let height = |k: usize| frame.bottom() - (steps + k - start) as f64 * step;
        let columns = columns.filter(|&k| steps + k >= start);
        let inside: Vec<usize> = columns.filter(|&k| holds(k, height(k))).collect();
        for run in inside.chunk_by(|a, b| a + 1 == *b) {
            let ends = [run[0], run[run.len() - 1]].map(|k| [left(k) + step / 2.0, height(k)]);
            canvas.line(ends, 1.0, hatching);
        }
    }
}

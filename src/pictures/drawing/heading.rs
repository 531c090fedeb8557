//! The heading of a picture.

use super::canvas::{Anchor, Canvas};
use super::color::INK;

/// The title in large letters, or smaller on two lines, ended by an ellipsis if it is longer still.
pub(crate) fn heading(canvas: &mut Canvas, title: &str) {
    const LARGE: f64 = 42.0;
    const SMALLER: f64 = 32.0;
    const MARGIN: f64 = 40.0;
    let room = canvas.size()[0] - 2.0 * MARGIN;
    let title: String = title.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if canvas.width(&title, LARGE) <= room {
        return canvas.text(&title, [MARGIN, 52.0], LARGE, INK, Anchor::Left);
    }
    let letters: Vec<char> = title.chars().collect();
    let whole = canvas.fitting(&letters, SMALLER, room);
    let split = letters[..whole].iter().rposition(|&c| c == ' ').map_or(whole, |space| space + 1);
    let (first, rest) = letters.split_at(split);
    canvas.text(&first.iter().collect::<String>(), [MARGIN, 36.0], SMALLER, INK, Anchor::Left);
    let mut second: String = rest.iter().collect();
    if canvas.width(&second, SMALLER) > room {
        let kept = canvas.fitting(rest, SMALLER, room).saturating_sub(2);
        second = rest[..kept].iter().collect::<String>() + "…";
    }
    canvas.text(&second, [MARGIN, 76.0], SMALLER, INK, Anchor::Left);
}

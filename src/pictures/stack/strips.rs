//! Lambda along the section, a plot for each gap with contact.

use super::scene::{Gap, Scene};
use super::section::Section;
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::{CONTACT_BAND, INK};
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};
use crate::pictures::plan::Bars;

/// About how many ticks lambda has, and up to which place: a higher one has its label beside that of zero of the plot above.
const TICKS: usize = 3;
const HIGHEST_TICK: f64 = 0.85;

/// Draws the plots into their frames, with the axis along the cut below the last one.
pub(super) fn draw(canvas: &mut Canvas, scene: &Scene, section: &Section, frames: &[Frame]) {
    for (gap, &frame) in scene.touching().zip(frames) {
        strip(canvas, scene, section, gap, frame);
    }
    let Some(last) = frames.last() else { return };
    if scene.touching().next().is_none() {
        last.outline(canvas);
        let reason =
            if scene.gaps.is_empty() { "no gap: one membrane without obstacles" } else { "no contact" };
        say(canvas, last, reason);
    }
    let along = &scene.domain.plane[section.cut.along];
    last.bottom_axis(canvas, along);
    let under = [last.left + last.width / 2.0, last.bottom() + 58.0];
    let name = ["x", "y"][section.cut.along];
    canvas.text(&format!("{name}{}", along.suffix()), under, NORMAL, INK, Anchor::Middle);
}

fn strip(canvas: &mut Canvas, scene: &Scene, section: &Section, gap: &Gap, frame: Frame) {
    let contacts = section.contacts(gap);
    for &[start, end] in &contacts {
        canvas.fill([frame.at([start, 1.0]), frame.at([end, 0.0])], CONTACT_BAND);
    }
    let bars = Bars::new(frame, &gap.action);
    let mut ticks = bars.axis.ticks(TICKS);
    ticks.retain(|tick| tick.place <= HIGHEST_TICK);
    bars.draw(canvas, &section.forces(gap), &ticks);
    frame.outline(canvas);
    if gap.action.pressed {
        frame.left_ticks(canvas, &ticks);
    }
    if contacts.is_empty() {
        say(canvas, &frame, "no contact along A–A");
    } else if !gap.action.pressed {
        say(canvas, &frame, "λ = 0");
    }
    let [x, y] = [frame.left - 95.0, frame.top + frame.height / 2.0];
    let symbol = format!("{} {}", gap.symbol(), bars.axis.power());
    canvas.text(symbol.trim_end(), [x, y - 0.55 * NORMAL], NORMAL, INK, Anchor::Right);
    canvas.text(&scene.sides(gap), [x, y + 0.55 * NORMAL], SMALL, INK, Anchor::Right);
}

/// A remark in the middle of a plot.
fn say(canvas: &mut Canvas, frame: &Frame, remark: &str) {
    canvas.text(remark, frame.at([0.5, 0.5]), NORMAL, INK, Anchor::Middle);
}

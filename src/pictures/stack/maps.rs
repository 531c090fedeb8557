//! The maps of the gaps, from above.

use super::layout::Layout;
use super::scene::{Gap, Scene};
use crate::pictures::drawing::axis::{Tick, scientific};
use crate::pictures::drawing::canvas::{Anchor, Canvas};
use crate::pictures::drawing::color::INK;
use crate::pictures::drawing::frame::{Frame, NORMAL, SMALL};
use crate::pictures::plan::{Action, Cells, Cut, color_bar};

/// From a map to its colour bar, and the width of that.
const BAR: [f64; 2] = [58.0, 24.0];
/// The least height of a colour bar.
const LOWEST_BAR: f64 = 150.0;

/// Draws all maps.
pub(super) fn draw(canvas: &mut Canvas, scene: &Scene, maps: &[Cells], cut: &Cut, layout: &Layout) {
    let (shown, gaps) = (scene.shown.len(), scene.gaps.len());
    let what = if gaps == 0 {
        "From above".to_owned()
    } else {
        "From above: contact and λ on the dual cells Dₐ, a scale for each gap".to_owned()
    };
    let left_out = match gaps - shown {
        0 => String::new(),
        _ => format!("; the {shown} of {gaps} gaps with the greatest force"),
    };
    let at = [layout.section.left, layout.maps_top + 24.0];
    canvas.text(&(what + &left_out), at, NORMAL, INK, Anchor::Left);
    for (map, cells) in maps.iter().enumerate() {
        let gap = scene.gap_of_map(map);
        cells.draw(canvas, &scene.domain, gap.map(|gap| &gap.action));
        axes(canvas, scene, &cells.frame, map % layout.columns == 0);
        let [x, y] = cells.cut(canvas, cut);
        let (at, anchor) =
            if cut.along == 0 { ([x + 8.0, y], Anchor::Left) } else { ([x, y - 20.0], Anchor::Middle) };
        canvas.text("A–A", at, SMALL, INK, anchor);
        if let Some(gap) = gap {
            heading(canvas, scene, gap, &cells.frame);
            if gap.action.pressed {
                bar(canvas, &gap.action, &cells.frame);
            }
        }
    }
}

/// The gap, its force and its contact.
fn heading(canvas: &mut Canvas, scene: &Scene, gap: &Gap, map: &Frame) {
    let action = &gap.action;
    let force = if gap.total_force > 0.0 {
        format!(", force {}", scientific(gap.total_force))
    } else {
        String::new()
    };
    let contact = match (action.touching, action.pressed) {
        (false, _) => "no contact".to_owned(),
        (true, false) => format!("contact area {}, λ = 0", action.percentage()),
        (true, true) => format!("contact area {}", action.percentage()),
    };
    let name = format!("{}: {}{force}", gap.symbol(), scene.sides(gap));
    canvas.text(&name, [map.left, map.top - 84.0], NORMAL, INK, Anchor::Left);
    canvas.text(&contact, [map.left, map.top - 52.0], SMALL, INK, Anchor::Left);
}

/// Axes; the numbers at y in the first column only.
fn axes(canvas: &mut Canvas, scene: &Scene, map: &Frame, first: bool) {
    let [x, y] = &scene.domain.plane;
    map.outline(canvas);
    map.bottom_axis(canvas, x);
    let below = [map.left + map.width / 2.0, map.bottom() + 56.0];
    canvas.text(&format!("x{}", x.suffix()), below, NORMAL, INK, Anchor::Middle);
    let ticks = y.ticks((map.height / 70.0).clamp(1.0, 6.0) as usize);
    if first {
        map.left_ticks(canvas, &ticks);
        let above = [map.left - 14.0, map.top - 28.0];
        canvas.text(&format!("y{}", y.suffix()), above, NORMAL, INK, Anchor::Right);
    } else {
        let bare: Vec<Tick> = ticks.into_iter().map(|tick| Tick { label: String::new(), ..tick }).collect();
        map.left_ticks(canvas, &bare);
    }
}

/// The colours of lambda with their values, right of the map.
fn bar(canvas: &mut Canvas, action: &Action, map: &Frame) {
    let [apart, width] = BAR;
    let height = map.height.max(LOWEST_BAR);
    let bar = Frame { left: map.right() + apart, top: map.top + (map.height - height) / 2.0, width, height };
    color_bar(canvas, bar, &action.axis, action.greatest, (height / 60.0) as usize);
    let above = [bar.left + width / 2.0, bar.top - 24.0];
    canvas.text(&action.axis.power(), above, SMALL, INK, Anchor::Middle);
}

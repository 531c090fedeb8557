//! Where the parts of the picture lie.

use super::picture::WIDTH;
use super::scene::Scene;
use crate::pictures::drawing::frame::Frame;
use crate::pictures::plan::MOST_ELONGATED;

/// The section; names of the layers stand right of it.
const SECTION: Frame = Frame { left: 240.0, top: 170.0, width: 1330.0, height: 480.0 };
/// The height of a plot of lambda, and the room between two.
const STRIP: [f64; 2] = [88.0, 12.0];
/// Room for ticks and the name of the axis under the last plot.
const UNDER_STRIPS: f64 = 90.0;

/// Room for ticks left of the first column of maps.
const LEFT: f64 = 100.0;
/// Room right of each map for the colour bar and its ticks.
const BESIDE_MAP: f64 = 184.0;
/// Room above each map for its heading, and below it for the axis.
const ABOVE_MAP: f64 = 106.0;
const BELOW_MAP: f64 = 84.0;
/// The least distance from one column to the next, for the headings.
const COLUMN: f64 = 410.0;
/// The height of one map at most, and that of its row at least, for the colour bar.
const HIGHEST_MAP: f64 = 380.0;
const ROW: f64 = 150.0;
/// The height of a column of maps with all that is around them at most.
const HIGHEST_COLUMN: f64 = 1100.0;
/// Maps may be narrower by this factor for fewer rows.
const FEWER_ROWS: f64 = 0.8;
/// Room for the line of text over all maps, and between the columns and the edge.
const OVER_MAPS: f64 = 50.0;
const EDGE: f64 = 10.0;

pub(super) struct Layout {
    pub(super) size: [usize; 2],
    pub(super) section: Frame,
    /// A plot of lambda for each gap with contact; one where there is none, to say so.
    pub(super) strips: Vec<Frame>,
    /// A map for each gap shown; one of the domain where there is no gap.
    pub(super) maps: Vec<Frame>,
    pub(super) columns: usize,
    /// The upper end of the part with the maps.
    pub(super) maps_top: f64,
}

impl Layout {
    pub(super) fn new(scene: &Scene) -> Layout {
        let [height, between] = STRIP;
        let strip = |k: usize| Frame {
            top: SECTION.bottom() + between + k as f64 * (height + between),
            height,
            ..SECTION
        };
        let strips: Vec<Frame> = (0..scene.touching().count().max(1)).map(strip).collect();
        let maps_top = strips.last().map_or(SECTION.bottom(), Frame::bottom) + UNDER_STRIPS;
        let count = scene.shown.len().max(1);
        let (columns, [width, height]) = grid(count, scene.domain.aspect(MOST_ELONGATED));
        let pitch = COLUMN.max(width + BESIDE_MAP);
        let left = (WIDTH as f64 - LEFT - columns as f64 * pitch) / 2.0 + LEFT;
        let block = ABOVE_MAP + height.max(ROW) + BELOW_MAP;
        let map = |k: usize| {
            let [row, column] = [k / columns, k % columns].map(|k| k as f64);
            let top = maps_top + OVER_MAPS + row * block + ABOVE_MAP;
            Frame { left: left + column * pitch, top: top + (height.max(ROW) - height) / 2.0, width, height }
        };
        let rows = count.div_ceil(columns) as f64;
        let bottom = maps_top + OVER_MAPS + rows * block;
        Layout {
            size: [WIDTH, bottom.ceil() as usize],
            section: SECTION,
            strips,
            maps: (0..count).map(map).collect(),
            columns,
            maps_top,
        }
    }
}

/// How many columns make the largest maps, and the size of a map.
fn grid(count: usize, aspect: f64) -> (usize, [f64; 2]) {
    let room = WIDTH as f64 - LEFT - EDGE;
    let most = ((room / COLUMN) as usize).min(count);
    let width = |columns: usize| {
        let rows = count.div_ceil(columns) as f64;
        let height = HIGHEST_COLUMN / rows - ABOVE_MAP - BELOW_MAP;
        // More rows than fit are no choice.
        let height = if height < ROW { 0.0 } else { height.min(HIGHEST_MAP) };
        (room / columns as f64 - BESIDE_MAP).min(height * aspect)
    };
    let better = |best: usize, columns: usize| {
        let fewer_rows = count.div_ceil(columns) < count.div_ceil(best);
        let least = if fewer_rows { FEWER_ROWS * width(best) } else { width(best) };
        if width(columns) > least { columns } else { best }
    };
    let columns = (1..=most).fold(1, better);
    (columns, [width(columns), width(columns) / aspect])
}

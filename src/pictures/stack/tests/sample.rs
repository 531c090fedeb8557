//! Stacks to be drawn.

use crate::pictures::drawing::color::Rgb;
use crate::pictures::drawing::encode::Format;
use crate::pictures::drawing::frame::Frame;
use crate::pictures::drawing::samples::Image;
use crate::pictures::plan::Cells;
use crate::pictures::stack::layout::Layout;
use crate::pictures::stack::scene::Scene;
use crate::pictures::stack::section::cut;
use crate::pictures::stack::{GapPicture, StackPicture, render};

/// A mesh with a stack on it.
#[derive(Clone)]
pub(super) struct Stack {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) ceiling: Option<Vec<f64>>,
    pub(super) membranes: Vec<Vec<f64>>,
    pub(super) floor: Option<Vec<f64>>,
    pub(super) gaps: Vec<Gap>,
}

#[derive(Clone)]
pub(super) struct Gap {
    pub(super) number: usize,
    pub(super) lambda: Vec<f64>,
    pub(super) contact: Vec<bool>,
    pub(super) total_force: f64,
}

impl Gap {
    fn picture(&self) -> GapPicture<'_> {
        let Gap { number, lambda, contact, total_force } = self;
        GapPicture { number: *number, lambda, contact, total_force: *total_force }
    }
}

impl Stack {
    /// `cells` by `cells` squares, halved, on `[0, width] x [0, 1]`; layers from an arched lowest one upwards by the gaps, which
    /// are given from the top. Lambda is `k + 1` where gap `k` is zero.
    pub(super) fn new(
        cells: usize,
        width: f64,
        [ceiling, floor]: [bool; 2],
        gaps: &[&dyn Fn(f64, f64) -> f64],
    ) -> Stack {
        let step = 1.0 / cells as f64;
        let vertex = |i: usize, j: usize| j * (cells + 1) + i;
        let grid = |count: usize| (0..count * count).map(move |k| (k % count, k / count));
        let points: Vec<[f64; 2]> =
            grid(cells + 1).map(|(i, j)| [i as f64 * step * width, j as f64 * step]).collect();
        let halves = |(i, j): (usize, usize)| {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        let first = if ceiling { 0 } else { 1 };
        let mut layers =
            vec![points.iter().map(|[x, y]| x * (width - x) * y * (1.0 - y)).collect::<Vec<f64>>()];
        let mut drawn = Vec::new();
        for (k, gap) in gaps.iter().enumerate().rev() {
            let heights: Vec<f64> = points.iter().map(|&[x, y]| gap(x, y).max(0.0)).collect();
            layers.insert(0, heights.iter().zip(&layers[0]).map(|(gap, below)| gap + below).collect());
            let number = first + k;
            let lambda = heights.iter().map(|&gap| if gap == 0.0 { (number + 1) as f64 } else { 0.0 });
            let contact = heights.iter().map(|&gap| gap == 0.0).collect();
            drawn.insert(0, Gap { number, lambda: lambda.collect(), contact, total_force: 1.0 });
        }
        Stack {
            triangles: grid(cells).flat_map(halves).collect(),
            points,
            ceiling: ceiling.then(|| layers.remove(0)),
            floor: if floor { layers.pop() } else { None },
            membranes: layers,
            gaps: drawn,
        }
    }

    /// Three membranes over a floor: contact in a disk between the first two, on the left between the last and the floor.
    pub(super) fn three() -> Stack {
        Stack::new(32, 1.0, [false, true], &[&disk, &open, &|x, _| x - 0.3])
    }

    /// The same without any contact.
    pub(super) fn apart() -> Stack {
        Stack::new(32, 1.0, [false, true], &[&open, &open, &open])
    }

    pub(super) fn scaled(&self, length: f64, height: f64, force: f64) -> Stack {
        let scale = |values: &Vec<f64>, factor: f64| values.iter().map(|value| value * factor).collect();
        let gap = |gap: &Gap| Gap { lambda: scale(&gap.lambda, force), ..gap.clone() };
        Stack {
            points: self.points.iter().map(|point| point.map(|x| x * length)).collect(),
            ceiling: self.ceiling.as_ref().map(|ceiling| scale(ceiling, height)),
            membranes: self.membranes.iter().map(|membrane| scale(membrane, height)).collect(),
            floor: self.floor.as_ref().map(|floor| scale(floor, height)),
            gaps: self.gaps.iter().map(gap).collect(),
            ..self.clone()
        }
    }

    pub(super) fn picture(&self) -> StackPicture<'_> {
        StackPicture {
            title: "",
            points: &self.points,
            triangles: &self.triangles,
            ancestry: &[],
            membranes: self.membranes.iter().map(Vec::as_slice).collect(),
            obstacles: [self.ceiling.as_deref(), self.floor.as_deref()],
            gaps: self.gaps.iter().map(Gap::picture).collect(),
        }
    }

    pub(super) fn scene(&self) -> Scene<'_> {
        Scene::new(&self.picture()).expect("valid data")
    }

    pub(super) fn layout(&self) -> Layout {
        Layout::new(&self.scene())
    }

    pub(super) fn render(&self) -> Vec<u8> {
        render(&self.picture()).expect("valid data").encode(Format::Png).expect("an image")
    }

    pub(super) fn image(&self) -> Image {
        Image::decode(&self.render())
    }

    /// The place of the cut across it.
    pub(super) fn cut(&self) -> f64 {
        let scene = self.scene();
        let maps: Vec<Cells> =
            self.layout().maps.iter().enumerate().map(|(map, &frame)| scene.cells(map, frame)).collect();
        cut(&scene, &maps).place
    }
}

pub(super) fn disk(x: f64, y: f64) -> f64 {
    (x - 0.5).hypot(y - 0.5) - 0.3
}

pub(super) fn open(x: f64, y: f64) -> f64 {
    0.1 + 0.05 * x * y
}

/// The pixels of a colour in a frame.
pub(super) fn count_in(image: &Image, frame: &Frame, wanted: Rgb) -> usize {
    let columns = frame.left as usize..frame.right() as usize;
    let rows = frame.top as usize..frame.bottom() as usize;
    rows.flat_map(|row| columns.clone().map(move |column| [column as f64, row as f64]))
        .filter(|&at| image.at(at) == wanted)
        .count()
}

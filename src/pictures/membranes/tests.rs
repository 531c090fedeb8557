use super::*;
use crate::mesh::{Pattern, rectangle};
use crate::pictures::drawing::axis::{Axis, times};
use crate::pictures::drawing::canvas::{Anchor, Canvas, FINE};
use crate::pictures::drawing::color::{self, INK};
use crate::pictures::drawing::encode::Format;
use crate::pictures::drawing::samples::Image;

/// Rounding of a handful of operations on numbers of order one.
const ROUNDING: f64 = 1e-12;

/// A mesh with a solution.
#[derive(Clone)]
struct Solution {
    points: Vec<[f64; 2]>,
    triangles: Vec<[usize; 3]>,
    upper: Vec<f64>,
    lower: Vec<f64>,
    lambda: Vec<f64>,
    contact: Vec<bool>,
}

impl Solution {
    /// `cells` by `cells` squares, halved, on `[0, width] x [0, 1]`, without those whose centre is not kept;
    /// lambda is 2 where the gap is zero.
    fn new(
        cells: usize,
        width: f64,
        keep: impl Fn(f64, f64) -> bool,
        gap: impl Fn(f64, f64) -> f64,
    ) -> Solution {
        let step = 1.0 / cells as f64;
        let vertex = |i: usize, j: usize| j * (cells + 1) + i;
        let grid = |count: usize| (0..count * count).map(move |k| (k % count, k / count));
        let points: Vec<[f64; 2]> =
            grid(cells + 1).map(|(i, j)| [i as f64 * step * width, j as f64 * step]).collect();
        let triangles = grid(cells)
            .filter(|&(i, j)| keep((i as f64 + 0.5) * step * width, (j as f64 + 0.5) * step))
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let gaps: Vec<f64> = points.iter().map(|&[x, y]| gap(x, y).max(0.0)).collect();
        let lower: Vec<f64> = points.iter().map(|&[x, y]| x * (width - x) * y * (1.0 - y)).collect();
        Solution {
            upper: gaps.iter().zip(&lower).map(|(gap, u2)| gap + u2).collect(),
            lambda: gaps.iter().map(|&gap| if gap == 0.0 { 2.0 } else { 0.0 }).collect(),
            contact: gaps.iter().map(|&gap| gap == 0.0).collect(),
            points,
            triangles,
            lower,
        }
    }

    /// Contact in a disk of radius 0.3 round the centre of the unit square.
    fn disk() -> Solution {
        Solution::new(32, 1.0, |_, _| true, |x, y| (x - 0.5).hypot(y - 0.5) - 0.3)
    }

    fn apart() -> Solution {
        Solution::new(32, 1.0, |_, _| true, |x, y| 0.1 + x * y)
    }

    fn scaled(&self, length: f64, height: f64, force: f64) -> Solution {
        let scale = |values: &[f64], factor: f64| values.iter().map(|value| value * factor).collect();
        Solution {
            points: self.points.iter().map(|point| point.map(|x| x * length)).collect(),
            upper: scale(&self.upper, height),
            lower: scale(&self.lower, height),
            lambda: scale(&self.lambda, force),
            ..self.clone()
        }
    }

    fn picture<'a>(&'a self, title: &'a str) -> Picture<'a> {
        Picture {
            title,
            points: &self.points,
            triangles: &self.triangles,
            ancestry: &[],
            upper: &self.upper,
            lower: &self.lower,
            lambda: &self.lambda,
            contact: &self.contact,
        }
    }

    fn render(&self) -> Vec<u8> {
        render(&self.picture("")).expect("valid data").encode(Format::Png).expect("an image")
    }

    fn image(&self) -> Image {
        Image::decode(&self.render())
    }
}

fn cut_of(solution: &Solution) -> [f64; 2] {
    let picture = solution.picture("");
    let scene = Scene::new(&picture).expect("valid data");
    cut(&scene, &Map::new(&scene, MAP)).point(0.5)
}

#[test]
fn the_picture_has_its_size_and_the_same_bytes_for_the_same_data() {
    let solution = Solution::disk();
    let bytes = solution.render();
    let image = Image::decode(&bytes);
    assert_eq!([image.width, image.height], SIZE);
    assert_eq!(bytes, solution.render());
    assert_ne!(bytes, Solution::apart().render());
}

#[test]
fn contact_and_only_contact_is_painted_as_contact() {
    let touching = Solution::disk().image();
    let section_of_contact = 0.5 * MEMBRANES.width * MEMBRANES.height;
    assert!(touching.count(color::CONTACT_BAND) as f64 > section_of_contact);
    assert!(touching.count(color::force(1.0)) > 10_000);
    let apart = Solution::apart().image();
    assert_eq!(apart.count(color::CONTACT_BAND), 0);
    assert_eq!(apart.count(color::CONTACT), 0);
    assert_eq!(apart.count(color::force(1.0)), 0);
}

#[test]
fn the_map_shows_lambda_of_the_dual_cell() {
    let mut solution = Solution::disk();
    let vertex = solution.points.iter().position(|&point| point == [0.5, 0.625]).expect("a vertex there");
    let square = Frame { top: MAP.top + (MAP.height - MAP.width) / 2.0, height: MAP.width, ..MAP };
    let at = square.at([0.5, 0.625]);
    assert_eq!(solution.image().at(at), color::force(1.0));
    solution.lambda[vertex] = 1.0;
    assert_eq!(solution.image().at(at), color::force(0.5));
}

#[test]
fn the_map_has_no_holes_but_those_of_the_domain() {
    let rows = |solution: &Solution| {
        let picture = solution.picture("");
        Map::new(&Scene::new(&picture).expect("valid data"), MAP).profile(1, |_| true)
    };
    let full = MAP.width as usize * FINE;
    assert!(rows(&Solution::new(37, 1.0, |_, _| true, |_, _| 0.0)).iter().all(|&count| count == full));
    let holed = Solution::new(37, 1.0, |x, y| (x - 0.5).hypot(y - 0.5) > 0.2, |_, _| 0.0);
    assert!(rows(&holed).iter().any(|&count| count < full));
}

#[test]
fn a_contact_region_smaller_than_a_pixel_is_on_the_map() {
    let cells = 400;
    let small = Frame { width: 50.0, height: 50.0, ..MAP };
    let mut solution = Solution::new(cells, 1.0, |_, _| true, |_, _| 0.1);
    solution.contact[(cells + 1) * 281 + 67] = true;
    let picture = solution.picture("");
    let scene = Scene::new(&picture).expect("valid data");
    let map = Map::new(&scene, small);
    let shown = |wanted: &dyn Fn(usize) -> bool| map.profile(1, wanted).iter().sum::<usize>();
    assert_eq!(shown(&|vertex| scene.action.in_contact(vertex)), 1);
    assert_eq!(shown(&|vertex| vertex == (cells + 1) * 281 + 68), 0);
}

/// Of more triangles than can be seen, those of a coarser mesh are drawn.
#[test]
fn a_picture_of_a_coarser_mesh_looks_the_same_and_shows_what_that_does_not_know() {
    let cells = 1024;
    let gap = |x: f64, y: f64| (x - 0.5).hypot(y - 0.5) - 0.3;
    let mesh = rectangle([0.0; 2], [1.0; 2], [cells; 2], Pattern::Right).expect("a mesh");
    let mut solution =
        Solution { triangles: mesh.triangles().to_vec(), ..Solution::new(cells, 1.0, |_, _| true, gap) };
    // A vertex of the fine mesh only.
    let speck = (cells + 1) * 101 + 67;
    assert_eq!(mesh.points()[speck], solution.points[speck]);
    solution.contact[speck] = true;
    let fine = solution.picture("");
    let coarse = Picture { ancestry: mesh.ancestry(), ..fine };
    let [of_fine, of_coarse] = [&fine, &coarse].map(|picture| Scene::new(picture).expect("valid data"));
    assert!(of_coarse.domain.drawn().len() == of_fine.domain.drawn().len() / 4);
    assert!(of_coarse.domain.drawn().iter().flatten().all(|&v| v != speck));
    let map = Map::new(&of_coarse, MAP);
    assert!(map.profile(1, |vertex| vertex == speck).iter().sum::<usize>() > 0);
    // All figures are those of the fine mesh.
    assert_eq!(of_fine.action.share, of_coarse.action.share);
    assert_eq!(cut(&of_fine, &Map::new(&of_fine, MAP)).place, cut(&of_coarse, &map).place);

    let image =
        |picture| Image::decode(&render(picture).expect("valid data").encode(Format::Png).expect("an image"));
    let [fine, coarse] = [&fine, &coarse].map(image);
    let pairs = || fine.pixels.iter().zip(&coarse.pixels);
    let far = |(p, q): &(&color::Rgb, &color::Rgb)| (0..3).any(|k| p[k].abs_diff(q[k]) > 64);
    let (differing, far) = (pairs().filter(|(p, q)| p != q).count(), pairs().filter(far).count());
    assert!(differing > 0 && far < fine.pixels.len() / 1000, "{differing}, {far} of {}", fine.pixels.len());
}

#[test]
fn the_cut_goes_through_the_contact_region_along_the_longer_side() {
    let off_centre = Solution::new(64, 2.0, |_, _| true, |x, y| (x - 0.5).hypot(y - 0.25) - 0.2);
    assert!((cut_of(&off_centre)[1] - 0.25).abs() < 0.02);
    let ring = Solution::new(64, 1.0, |_, _| true, |x, y| ((x - 0.5).hypot(y - 0.5) - 0.3).abs() - 0.05);
    assert!((cut_of(&ring)[1] - 0.5).abs() < 0.02);
    // Of two regions, the larger.
    let gap = |x: f64, y: f64| ((x - 1.0).hypot(y - 0.2) - 0.15).min((x - 1.0).hypot(y - 0.8) - 0.1);
    assert!((cut_of(&Solution::new(64, 2.0, |_, _| true, gap))[1] - 0.2).abs() < 0.02);
    // Without contact, the middle of the domain.
    assert!((cut_of(&Solution::apart())[1] - 0.5).abs() < 0.02);
}

#[test]
fn the_cut_goes_through_the_greatest_force_and_stays_in_its_dual_cell() {
    let cells = 200;
    let mut solution = Solution::new(cells, 2.0, |_, _| true, |x, y| (x - 1.0).hypot(y - 0.5) - 0.3);
    let peak = (cells + 1) * 133 + 110;
    assert!(solution.contact[peak] && cut_of(&solution)[1] == 0.5, "a plateau has no peak");
    solution.lambda[peak] = 2.5;
    let y = solution.points[peak][1];
    let place = cut_of(&solution)[1];
    assert!((place - y).abs() < 1.0 / (3 * cells) as f64, "{place} for {y}");
    let picture = solution.picture("");
    let scene = Scene::new(&picture).expect("valid data");
    let section = Section::new(&scene, cut(&scene, &Map::new(&scene, MAP)), 4000);
    let greatest = |section: &Section| section.forces().iter().map(|force| force.1).fold(0.0, f64::max);
    assert_eq!(greatest(&section), 2.5);
    let beside = Cut { along: 0, place: y + 1.0 / cells as f64, reach: 0.0 };
    assert_eq!(greatest(&Section::new(&scene, beside, 4000)), 2.0);
}

#[test]
fn the_share_of_the_contact_is_that_of_its_dual_cells() {
    let share = |solution: &Solution| Scene::new(&solution.picture("")).expect("valid data").action.share;
    let disk = std::f64::consts::PI * 0.3 * 0.3;
    assert!((share(&Solution::disk()) - disk).abs() < 0.02);
    assert!((share(&Solution::new(8, 1.0, |_, _| true, |_, _| 0.0)) - 1.0).abs() < ROUNDING);
    let mut one = Solution::apart();
    one.contact[33 * 16 + 16] = true;
    assert!((share(&one) - 1.0 / 1024.0).abs() < ROUNDING);
    assert_eq!(share(&Solution::apart()), 0.0);
}

#[test]
fn factors_have_two_digits() {
    let texts = [1.0, 2.54, 40.4, 123.0, 0.0456, 1.0e7, 2.5e-7].map(times);
    assert_eq!(texts, ["×1", "×2.5", "×40", "×120", "×0.046", "×1.0·10⁷", "×2.5·10⁻⁷"]);
}

#[test]
fn the_section_interpolates_and_is_empty_in_a_hole() {
    let mut solution = Solution::new(10, 1.0, |x, y| (x - 0.5).hypot(y - 0.5) > 0.12, |_, _| 1.0);
    solution.upper = solution.points.iter().map(|&[x, y]| 1.0 + 2.0 * x + y).collect();
    let picture = solution.picture("");
    let scene = Scene::new(&picture).expect("valid data");
    let section = Section::new(&scene, Cut { along: 0, place: 0.52, reach: 1.0 }, 100);
    for (step, sample) in section.samples.iter().enumerate() {
        let x = section.along(step);
        assert_eq!(sample.is_none(), (0.4..0.6).contains(&x), "at x = {x}");
        let Some(sample) = sample else { continue };
        assert!((sample.heights[0] - (1.0 + 2.0 * x + 0.52)).abs() < ROUNDING);
        assert!((sample.heights[0] - (1.0 + 2.0 * x + 0.5)).abs() > ROUNDING);
    }
}

#[test]
fn the_scale_of_the_data_changes_labels_only() {
    let solution = Solution::disk();
    let marks = |image: &Image| [color::CONTACT_BAND, color::force(1.0), color::FREE].map(|c| image.count(c));
    // Labels of another length may cover or uncover a few pixels of these colours.
    let same = |a: [usize; 3], b: [usize; 3]| a.iter().zip(b).all(|(&a, b)| a.abs_diff(b) * 100 < a);
    let expected = marks(&solution.image());
    for factors in [[1e-9, 1e-12, 1e9], [1e300, 1e300, 1e300], [1e-290, 1e-290, 1e-290]] {
        let [length, height, force] = factors;
        let found = marks(&solution.scaled(length, height, force).image());
        assert!(same(expected, found), "{factors:?}: {expected:?} and {found:?}");
    }
    assert!(!same(expected, marks(&Solution::apart().image())));
}

#[test]
fn limiting_data_can_be_drawn() {
    let flat = Solution::disk().scaled(1.0, 0.0, 0.0);
    let full = Solution::new(8, 1.0, |_, _| true, |_, _| 0.0);
    let strip = Solution::new(16, 500.0, |_, _| true, |x, _| x - 200.0);
    let parts =
        Solution::new(30, 3.0, |x, _| !(1.0..2.0).contains(&x), |x, y| (x - 0.5).hypot(y - 0.5) - 0.3);
    let point = Solution { points: vec![[1.0, 1.0]; 81], ..full.clone() };
    for solution in [&flat, &full, &strip, &parts] {
        assert!(solution.image().count(color::CONTACT_BAND) > 1000);
    }
    assert_eq!(point.image().count(color::CONTACT_BAND), 0);
}

#[test]
fn five_vertices_are_enough() {
    let solution = Solution {
        points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]],
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        upper: vec![1.0, 1.0, 1.0, 1.0, 0.5],
        lower: vec![0.0, 0.0, 0.0, 0.0, 0.5],
        lambda: vec![0.0, 0.0, 0.0, 0.0, 2.0],
        contact: vec![false, false, false, false, true],
    };
    assert!(solution.image().count(color::force(1.0)) > 10_000);
    let apart = Solution { contact: vec![false; 5], ..solution };
    assert_eq!(apart.image().count(color::force(1.0)), 0);
}

#[test]
fn unused_vertices_change_nothing() {
    let solution = Solution::disk();
    let mut more = solution.clone();
    more.points.push([f64::NAN, 1e300]);
    [&mut more.upper, &mut more.lower, &mut more.lambda]
        .into_iter()
        .for_each(|values| values.push(f64::INFINITY));
    more.contact.push(true);
    assert_eq!(more.render(), solution.render());
    let count = more.points.len();
    more.triangles.push([count - 1, 0, 1]);
    let picture = more.picture("");
    assert!(matches!(render(&picture), Err(PictureError::Value { vertex, .. }) if vertex == count - 1));
}

#[test]
fn wrong_data_is_an_error_in_one_line() {
    let good = Solution::disk();
    let short = Solution { lambda: vec![0.0; 3], ..good.clone() };
    let mesh = rectangle([0.0; 2], [1.0; 2], [4; 2], Pattern::Right).expect("a mesh");
    let other = Picture { ancestry: mesh.ancestry(), ..good.picture("") };
    let message = render(&other).expect_err("the ancestry of another mesh").to_string();
    assert!(message.contains("ancestry has 25 values for 1089 vertices"), "{message}");
    let beyond = Solution { triangles: vec![[0, 1, 99_999]], ..good.clone() };
    let empty = Solution { triangles: Vec::new(), ..good.clone() };
    let infinite = Solution { upper: vec![f64::INFINITY; good.upper.len()], ..good.clone() };
    let too_large = Solution { lower: vec![-1e307; good.lower.len()], ..good.clone() };
    let cases = [
        (short, "lambda has 3 values for 1089 vertices"),
        (beyond, "triangle 0 has vertex 99999"),
        (empty, "no triangles"),
        (infinite, "u1 = inf at vertex 0"),
        (too_large, "u2 = -1"),
    ];
    for (solution, expected) in cases {
        let message = render(&solution.picture("")).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}");
        assert_eq!(message.lines().count(), 1);
    }
    assert!(render(&good.picture("")).is_ok());
}

#[test]
fn any_title_stays_on_the_picture() {
    let margin_is_clean = |canvas: Canvas| {
        let image = Image::of(canvas);
        (0..image.height).all(|y| {
            (image.width - 38..image.width).all(|x| image.pixels[y * image.width + x] == color::PAPER)
        })
    };
    let strange = "Ünïcödé <b>µ</b> & \n\t\u{0} 膜の接触 мембраны غشاء 🦀 ".repeat(8);
    let unbroken = "W".repeat(200);
    for title in ["", "two plates", &strange, &unbroken] {
        let mut canvas = Canvas::new(SIZE);
        heading(&mut canvas, title);
        assert!(margin_is_clean(canvas), "{title}");
    }
    let mut canvas = Canvas::new(SIZE);
    canvas.text(&unbroken, [40.0, 52.0], 42.0, INK, Anchor::Left);
    assert!(!margin_is_clean(canvas));
}

#[test]
fn ticks_are_round_and_carry_the_exponent_apart() {
    let labels = |axis: Axis, count| axis.ticks(count).into_iter().map(|tick| tick.label).collect::<Vec<_>>();
    assert_eq!(labels(Axis::new(0.0, 1.0), 5), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    assert_eq!(labels(Axis::new(-2.0, 2.0), 4), ["−2", "−1", "0", "1", "2"]);
    assert_eq!(labels(Axis::new(-2.5e-9, 3e-9), 3), ["−2", "0", "2"]);
    assert_eq!(Axis::new(-2.5e-9, 3e-9).power(), "×10⁻⁹");
    assert_eq!(Axis::new(0.0, 4e301).power(), "×10³⁰¹");
    assert_eq!(Axis::new(0.0, 1.0).power(), "");
    assert_eq!(Axis::new(0.0, 1.0).round(0.4999, 1.0).label, "0.5");
    assert_ne!(Axis::new(0.0, 1.0).round(0.488, 1.0).label, "0.5");
}

#[test]
fn an_axis_without_extent_can_be_drawn() {
    assert_eq!(Axis::new(3.0, 3.0).place(3.0), 0.5);
    assert_eq!(Axis::new(0.0, 0.0).place(0.0), 0.0);
    assert_eq!(Axis::over([5e-324].into_iter(), true).place(0.0), 0.0);
    assert!(Axis::over(std::iter::empty(), false).ticks(4).len() > 2);
    assert!((Axis::new(1.0, 3.0).place(1.5) - 0.25).abs() < ROUNDING);
}

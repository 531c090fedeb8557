use super::coordinates::{Axes, Coordinates};
use super::curve::Curve;
use super::labels::spread;
use super::marker::{MARKER, color};
use super::panel::{Panel, SIZE};
use super::slopes::{Fan, fraction};
use super::times::groups;
use super::*;
use crate::pictures::drawing::canvas::Canvas;
use crate::pictures::drawing::color::{self as colors, CURVES, INK};
use crate::pictures::drawing::encode::Format;
use crate::pictures::drawing::frame::Frame;
use crate::pictures::drawing::samples::Image;

/// Rounding of a handful of operations on numbers of order one to a thousand.
const ROUNDING: f64 = 1e-9;

const H: [f64; 5] = [0.2, 0.1, 0.05, 0.025, 0.0125];

fn power(factor: f64, slope: f64) -> [f64; 5] {
    H.map(|h| factor * h.powf(slope))
}

fn render(h: &[f64], series: &[&[f64]], slopes: &[f64]) -> Vec<u8> {
    let series: Vec<Series> = series.iter().map(|values| Series { name: "error", values }).collect();
    let picture = RatesPicture { title: "", abscissa: "h", h, series: &series, slopes };
    render_rates(&picture).unwrap().encode(Format::Png).unwrap()
}

fn image(h: &[f64], series: &[&[f64]], slopes: &[f64]) -> Image {
    Image::decode(&render(h, series, slopes))
}

fn series<'a>(values: &[&'a [f64]]) -> Vec<Series<'a>> {
    values.iter().map(|values| Series { name: "error", values }).collect()
}

/// The curves of a picture, and its plot left of `right`.
fn plot(values: &[&[f64]], slopes: &[f64], right: f64) -> (Vec<Curve>, Coordinates, Option<Fan>) {
    let (curves, _) = errors::curves(&H, &series(values));
    let panel = Panel {
        title: "",
        names: Vec::new(),
        other_names: &[],
        slopes: Vec::new(),
        curves: &curves,
        others: &[],
        axes: Axes::over(&curves),
        axis_names: ["h", "error"],
        slope_name: "last slope",
        compared: slopes,
        note: None,
    };
    let [width, height] = SIZE.map(|length| length as f64);
    let (coordinates, fan) = panel.place(Frame { left: 0.0, top: 0.0, width, height }, right);
    (curves, coordinates, fan)
}

#[test]
fn the_picture_has_its_size_and_the_same_bytes_for_the_same_data() {
    let [first, second] = [power(1.0, 1.0), power(1.0, 2.0)];
    let bytes = render(&H, &[&first, &second], &[1.0, 2.0]);
    let picture = Image::decode(&bytes);
    assert_eq!([picture.width, picture.height], SIZE);
    assert_eq!(bytes, render(&H, &[&first, &second], &[1.0, 2.0]));
    assert_ne!(bytes, render(&H, &[&first, &first], &[1.0, 2.0]));
    assert_ne!(bytes, render(&H, &[&first, &second], &[1.0]));
}

#[test]
fn markers_lie_at_the_logarithms_of_the_values() {
    let values = power(3.0, 1.5);
    let labels = labels::Labels::new(
        &Canvas::new(SIZE),
        [&["error".to_owned()], &[]],
        "last slope",
        &["1.50".to_owned()],
        [0.0, SIZE[0] as f64],
    );
    let (_, plot, _) = plot(&[&values], &[], labels.left());
    let picture = image(&H, &[&values], &[]);
    for (h, value) in H.iter().zip(values) {
        let at = |value: f64| plot.at([h.log10(), value.log10()]);
        assert_eq!(picture.at(at(value)), CURVES[0]);
        assert_ne!(picture.at(at(1.5 * value)), CURVES[0]);
    }
}

#[test]
fn the_last_slope_is_that_of_the_last_two_levels_that_can_be_drawn() {
    let slope = |values: &[f64]| Curve::new(&H, values).last_slope();
    let bent = [1.0, 0.5, 0.25, 0.125, 0.125 * 2f64.powf(-1.5)];
    assert!((slope(&bent).unwrap() - 1.5).abs() < ROUNDING);
    assert!((slope(&bent).unwrap() - 1.0).abs() > ROUNDING, "and not of the first ones");
    assert!((slope(&[1.0, 0.5, 0.25, f64::NAN, 0.1]).unwrap() - 1.0).abs() < ROUNDING);
    assert_eq!(slope(&[1.0, 0.0, 0.25, f64::INFINITY, 0.1]), None, "no two neighbours");
    assert_eq!(Curve::new(&[0.1, 0.1], &[1.0, 2.0]).last_slope(), None, "the same mesh twice");
    let vertices = H.map(|h| h.powi(-2));
    assert!((Curve::new(&vertices, &power(1.0, 1.0)).last_slope().unwrap() + 0.5).abs() < ROUNDING);
}

#[test]
fn what_has_no_logarithm_is_left_out() {
    let holes = [1.0, 0.0, -1.0, f64::NAN, f64::INFINITY];
    assert_eq!(Curve::new(&H, &holes).points().count(), 1);
    assert_eq!(Curve::new(&[0.0, -1.0, f64::NAN, 0.1], &[1.0; 4]).points().count(), 1);
    assert_eq!(Curve::new(&H, &[5e-324; 5]).points().count(), 5);
    let [some, only] = [image(&H, &[&holes], &[]), image(&H, &[&[1.0, 0.5, 0.3, 0.2, 0.1]], &[])];
    assert!(some.count(CURVES[0]) > 500, "one marker in the plot, one in the label");
    assert!(only.count(CURVES[0]) > 2 * some.count(CURVES[0]));
}

#[test]
fn limiting_data_can_be_drawn() {
    let rounding = [1.0, 1.0 + 1e-16, 1.0 - 1e-16, 1.0, 1.0];
    let cases: [(&[f64], &[&[f64]]); 7] = [
        (&[], &[]),
        (&H, &[]),
        (&[], &[&[], &[]]),
        (&[0.1], &[&[0.5], &[0.25]]),
        (&H, &[&rounding]),
        (&H, &[&[f64::NAN; 5], &[0.0; 5]]),
        (&[1e300, 1.0, 1e-300], &[&[1e300, 1.0, 1e-300], &[5e-324, 1.0, f64::MAX]]),
    ];
    for (h, series) in cases {
        for slopes in [&[][..], &[1.0, 0.5, f64::NAN, 1e9, -1e300, 0.0, f64::INFINITY]] {
            let picture = image(h, series, slopes);
            assert!(picture.count(colors::INK) > 200, "frame and labels are there for {h:?}");
        }
    }
    let nothing = image(&[], &[], &[]);
    assert_eq!(nothing.count(CURVES[0]), 0);
    assert!(image(&[0.1], &[&[0.5]], &[]).count(CURVES[0]) > 500);
}

#[test]
fn many_series_of_long_names_stay_on_the_picture() {
    let values = power(1.0, 1.0);
    let name = "error in a norm of a very long name, \n".repeat(20);
    let series = vec![Series { name: &name, values: &values }; 60];
    let picture = RatesPicture { title: &name, abscissa: "h", h: &H, series: &series, slopes: &[1.0] };
    let picture = Image::decode(&render_rates(&picture).unwrap().encode(Format::Png).unwrap());
    let [margin, plot] = [1770..1800, 900..930].map(|columns| {
        let rows = 100..picture.height;
        let inked = rows.flat_map(|y| columns.clone().map(move |x| [x as f64, y as f64]));
        inked.filter(|&at| picture.at(at) != colors::PAPER).count()
    });
    assert_eq!(margin, 0);
    assert!(plot > 0);
}

#[test]
fn slopes_lie_below_the_curves_and_inside_of_the_plot() {
    let [flat, steep] = [power(1.0, 0.1), power(0.3, 2.0)];
    for slopes in [&[0.5, 1.0, 2.0][..], &[3.0], &[-1.0, -0.5]] {
        let (curves, plot, fan) = plot(&[&flat, &steep], slopes, 1300.0);
        let Fan { slopes, apex, run, .. } = fan.as_ref().unwrap();
        let far = apex[0] + run;
        let below = |height: f64| {
            let span = [apex[0].min(far), apex[0].max(far)];
            curves.iter().all(|curve| height < curve.lowest_between(span))
        };
        for slope in slopes {
            let end = [far, apex[1] + slope * run];
            assert!(below(end[1]), "{slope}");
            let [x, y] = plot.at(end);
            assert!(plot.frame.left < x && x < plot.frame.right(), "{slope}");
            assert!(plot.frame.top < y && y < plot.frame.bottom(), "{slope}");
        }
        assert!(!below(plot.axes.y.at(1.0)), "there are curves above the rays");
    }
}

#[test]
fn slopes_are_drawn_where_there_is_something_to_compare_them_with() {
    let values = power(1.0, 1.0);
    assert!(plot(&[&values], &[1.0], 1300.0).2.is_some());
    assert!(plot(&[&values], &[], 1300.0).2.is_none());
    assert!(plot(&[&values], &[f64::NAN, f64::INFINITY], 1300.0).2.is_none());
    let alone = [1.0, f64::NAN, 0.5, f64::NAN, 0.25];
    assert!(plot(&[&alone], &[1.0], 1300.0).2.is_none());
}

#[test]
fn slopes_are_named_as_fractions() {
    let cases = [
        (1.0, "1"),
        (-0.5, "−1/2"),
        (2.0 / 3.0, "2/3"),
        (0.75, "3/4"),
        (1.5, "3/2"),
        (0.0, "0"),
        (0.92, "0.92"),
    ];
    for (slope, expected) in cases {
        assert_eq!(fraction(slope), expected);
    }
    assert_ne!(fraction(0.67), "2/3");
}

#[test]
fn labels_give_way_as_little_as_they_can() {
    let near = |found: &[f64], expected: &[f64]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < ROUNDING)
    };
    assert!(near(&spread(&[50.0, 10.0], 10.0, [0.0, 100.0]), &[50.0, 10.0]));
    assert!(near(&spread(&[50.0, 50.0, 50.0], 10.0, [0.0, 100.0]), &[40.0, 50.0, 60.0]));
    assert!(near(&spread(&[52.0, 50.0, 90.0], 10.0, [0.0, 100.0]), &[56.0, 46.0, 90.0]));
    assert!(near(&spread(&[-5.0, 0.0, 200.0], 10.0, [0.0, 100.0]), &[0.0, 10.0, 100.0]));
    assert!(near(&spread(&[3.0; 5], 50.0, [0.0, 100.0]), &[0.0, 25.0, 50.0, 75.0, 100.0]));
    assert!(near(&spread(&[7.0], 50.0, [0.0, 100.0]), &[7.0]));
    assert!(spread(&[], 50.0, [0.0, 100.0]).is_empty());
    assert!(!near(&spread(&[50.0, 50.0], 10.0, [0.0, 100.0]), &[50.0, 60.0]));
}

#[test]
fn markers_differ_in_shape_and_curves_in_shape_or_colour() {
    let shape = |index: usize| {
        let mut canvas = Canvas::new([40, 40]);
        marker::draw(&mut canvas, index, [20.0, 20.0], MARKER, INK);
        Image::of(canvas).pixels
    };
    let shapes: Vec<Vec<colors::Rgb>> = (0..marker::KINDS).map(shape).collect();
    let pairs = |count: usize| (0..count).flat_map(move |a| (0..a).map(move |b| (a, b)));
    assert!(pairs(marker::KINDS).all(|(a, b)| shapes[a] != shapes[b]));
    let looks = |index: usize| (index % marker::KINDS, color(index));
    let distinct = marker::KINDS * CURVES.len();
    assert!(pairs(distinct).all(|(a, b)| looks(a) != looks(b)));
    assert_eq!(looks(distinct), looks(0), "then they begin again");
}

#[test]
fn a_wrong_length_is_an_error_in_one_line() {
    let draw = |values: &[f64]| {
        let series = [Series { name: "two\nlines", values }];
        render_rates(&RatesPicture { title: "", abscissa: "h", h: &H, series: &series, slopes: &[] }).err()
    };
    let message = draw(&[1.0; 3]).expect("too short").to_string();
    assert!(message.contains("has 3 values for 5 levels"), "{message}");
    assert_eq!(message.lines().count(), 1);
    assert!(draw(&[1.0; 5]).is_none());
}

#[test]
fn a_curve_of_times_goes_over_gaps_in_the_order_of_its_vertices() {
    let curve = Curve::through(&[[1e4, 4.0], [1e2, 1.0], [1e3, f64::NAN], [0.0, 1.0]]);
    let segments: Vec<[[f64; 2]; 2]> = curve.segments().collect();
    assert_eq!(segments, [[[2.0, 0.0], [4.0, 4f64.log10()]]]);
    assert_eq!(Curve::new(&[1e2, 1e3, 1e4], &[1.0, f64::NAN, 4.0]).segments().count(), 0, "levels have gaps");
}

#[test]
fn times_are_drawn_with_their_fitted_slopes() {
    let (steep, flat) = ([[1e2, 0.1], [1e3, 3.0], [1e4, 100.0]], [[1e2, 0.1], [1e3, 1.0], [1e4, 10.0]]);
    let draw = |points| {
        let curves = [Times { name: "solver", group: "", points }];
        render_times(&TimesPicture { title: "", curves: &curves, slopes: &[1.0, 1.5] })
            .encode(Format::Png)
            .unwrap()
    };
    let picture = Image::decode(&draw(&steep));
    assert_eq!([picture.width, picture.height], SIZE);
    assert!(picture.count(CURVES[0]) > 1000);
    assert!(draw(&steep) != draw(&flat) && draw(&steep) == draw(&steep));
    assert_eq!(
        Image::decode(&draw(&[])).count(CURVES[0]),
        Image::decode(&draw(&[[1.0, 0.0]])).count(CURVES[0])
    );
}

#[test]
fn rounding_lies_on_the_lower_edge_and_leaves_the_others_their_room() {
    let (errors, rounding) = (power(1.0, 1.0), [3e-16, 1e-15, 2e-15, 1e-14, 5e-14]);
    let (curves, plot, _) = plot(&[&errors, &rounding], &[], 1300.0);
    assert_eq!(curves.iter().map(|curve| curve.points().count()).collect::<Vec<_>>(), [5, 0]);
    assert!(curves[1].ends_at_rounding() && !curves[0].ends_at_rounding());
    assert!(plot.axes.y.length() < 2.0, "{}", plot.axes.y.length());
    let picture = image(&H, &[&errors, &rounding], &[]);
    let marker = [plot.at([H[2].log10(), 0.0])[0], plot.frame.bottom()];
    // The labels of both pictures are of one width or another: the marker is looked for along the edge.
    let edge = |picture: &Image| {
        (0..picture.width).filter(|&x| picture.at([x as f64, marker[1] - 3.0]) == CURVES[1]).count()
    };
    assert!(edge(&picture) > 5 * MARKER as usize);
    assert_eq!(edge(&image(&H, &[&errors, &errors], &[])), 0);
    // All errors of one size are none of rounding, however small.
    assert_eq!(errors::curves(&H, &series(&[&rounding])).0[0].points().count(), 5);
}

#[test]
fn many_curves_are_drawn_group_by_group() {
    let points = [[1e2, 0.1], [1e3, 1.0]];
    let times = |group| Times { name: "solver", group, points: &points };
    let many: Vec<Times> = ["a", "b", "a"].into_iter().chain(["c"; 11]).map(times).collect();
    let groups = groups(&many);
    let sizes: Vec<(&str, usize)> = groups.iter().map(|g| (g.name.as_str(), g.times.len())).collect();
    assert_eq!(sizes, [("a", 2), ("b", 1), ("c, 1 of 3", 4), ("c, 2 of 3", 4), ("c, 3 of 3", 3)]);
    let height = |curves: &[Times]| {
        let picture = TimesPicture { title: "", curves, slopes: &[1.0] };
        Image::decode(&render_times(&picture).encode(Format::Png).unwrap()).height
    };
    assert_eq!(height(&many[..7]), SIZE[1]);
    assert!(height(&many) > 2 * height(&many[..7]) - 200);
}

mod sample;

use super::scene::Kind;
use super::*;
use crate::action::certify_stack;
use crate::discretization::StackDiscretization;
use crate::mesh::{Pattern, rectangle};
use crate::pictures::drawing::color::{CONTACT, CONTACT_BAND, FREE, LAYERS, WALL, force};
use crate::pictures::drawing::frame::Frame;
use crate::pictures::drawing::samples::Image;
use crate::problem::{ContactProblem, Membrane};
use crate::solver::{ActiveSet, ContactSolver, SolverOptions};
use sample::{Gap, Stack, count_in, disk, open};

#[test]
fn the_picture_has_its_size_and_the_same_bytes_for_the_same_data() {
    let stack = Stack::three();
    let bytes = stack.render();
    let image = Image::decode(&bytes);
    assert_eq!([image.width, image.height], stack.layout().size);
    assert_eq!(image.width, WIDTH);
    assert_eq!(bytes, stack.render());
    assert_ne!(bytes, Stack::apart().render());
}

#[test]
fn every_layer_is_in_the_section_and_no_other() {
    let gaps: [&dyn Fn(f64, f64) -> f64; 7] = [&open; 7];
    for count in [1, 2, 6] {
        for obstacles in [[false, false], [false, true], [true, false], [true, true]] {
            let walls = obstacles.iter().filter(|&&there| there).count();
            let stack = Stack::new(8, 1.0, obstacles, &gaps[..count + walls - 1]);
            let (image, section) = (stack.image(), stack.layout().section);
            for (membrane, &color) in LAYERS.iter().enumerate() {
                let pixels = count_in(&image, &section, color);
                assert_eq!(pixels > 1500, membrane < count, "{count} {obstacles:?} u{membrane}: {pixels}");
            }
            let half = section.height / 2.0;
            let halves = [
                Frame { height: half, ..section },
                Frame { top: section.top + half, height: half, ..section },
            ];
            let is_there = halves.map(|half| count_in(&image, &half, WALL[0]) > 2000);
            assert_eq!(is_there, obstacles, "{count}");
        }
    }
}

#[test]
fn contact_and_only_contact_is_painted_as_contact() {
    let touching = Stack::three();
    let (image, layout) = (touching.image(), touching.layout());
    // The first gap and the last touch: a plot for each, seams in the section, lambda on their maps.
    assert_eq!(layout.strips.len(), 2);
    for strip in &layout.strips {
        assert!(count_in(&image, strip, CONTACT_BAND) > 5_000);
    }
    assert!(count_in(&image, &layout.section, CONTACT) > 300);
    let painted = |map: usize| count_in(&image, &layout.maps[map], force(1.0)) > 10_000;
    assert_eq!([0, 1, 2].map(painted), [true, false, true]);
    assert!(count_in(&image, &layout.maps[1], FREE) > 10_000);
    let apart = Stack::apart();
    let image = apart.image();
    assert_eq!([CONTACT_BAND, CONTACT, force(1.0)].map(|color| image.count(color)), [0; 3]);
    assert_eq!(apart.layout().strips.len(), 1);
}

#[test]
fn layers_that_only_come_close_have_no_seam() {
    let mut stack = Stack::new(32, 1.0, [false, false], &[&disk]);
    let section = stack.layout().section;
    assert!(count_in(&stack.image(), &section, CONTACT) > 300);
    stack.gaps[0].contact.fill(false);
    assert_eq!(count_in(&stack.image(), &section, CONTACT), 0);
}

#[test]
fn maps_and_bars_show_lambda_of_the_dual_cell() {
    let mut stack = Stack::three();
    let vertex = stack.points.iter().position(|&point| point == [0.5, 0.625]).expect("a vertex there");
    let at = stack.layout().maps[0].at([0.5, 0.625]);
    assert_eq!(stack.image().at(at), force(1.0));
    stack.gaps[0].lambda[vertex] /= 2.0;
    assert_eq!(stack.image().at(at), force(0.5));
}

#[test]
fn the_cut_goes_through_the_contact_of_the_most_gaps() {
    let lower = |x: f64, y: f64| (x - 1.0).hypot(y - 0.3) - 0.2;
    let upper = |x: f64, y: f64| (x - 0.5).hypot(y - 0.6) - 0.2;
    let of = |gaps: &[&dyn Fn(f64, f64) -> f64]| Stack::new(64, 2.0, [false, false], gaps).cut();
    let close = |a: f64, b: f64| (a - b).abs() < 0.02;
    assert!(close(of(&[&lower]), 0.3));
    assert!(close(of(&[&upper]), 0.6));
    // Both are met between 0.4 and 0.5.
    assert!(close(of(&[&lower, &upper]), 0.45));
    assert!(close(of(&[&lower, &upper, &lower]), 0.45));
    // One contact is met by more of the gaps than the other.
    let far = |x: f64, y: f64| (x - 0.5).hypot(y - 0.9) - 0.1;
    assert!(close(of(&[&lower, &far, &lower]), 0.3));
    // Without contact, the middle of the domain.
    assert!(close(of(&[&open]), 0.5));
    assert!(close(Stack::new(16, 1.0, [false, false], &[]).cut(), 0.5));
}

#[test]
fn the_cut_goes_through_a_contact_smaller_than_a_pixel() {
    let cells = 600;
    let mut stack = Stack::new(cells, 1.0, [false, false], &[&open]);
    let vertex = (cells + 1) * 421 + 67;
    stack.gaps[0].contact[vertex] = true;
    let off = (stack.cut() - stack.points[vertex][1]).abs();
    assert!(off < 1.0 / (3 * cells) as f64, "{off}");
    stack.gaps[0].contact[vertex] = false;
    assert!((stack.cut() - stack.points[vertex][1]).abs() > 0.1);
}

#[test]
fn of_more_gaps_than_fit_those_with_the_greatest_force_are_shown() {
    let gaps: [&dyn Fn(f64, f64) -> f64; 9] = [&disk; 9];
    let mut stack = Stack::new(8, 1.0, [false, true], &gaps);
    assert_eq!(stack.scene().shown.len(), 7);
    for (gap, force) in stack.gaps.iter_mut().zip([9.0, 1.0, 8.0, 7.0, 2.0, 6.0, 5.0, 4.0, 3.0]) {
        gap.total_force = force;
    }
    assert_eq!(stack.scene().shown, [0, 2, 3, 5, 6, 7, 8]);
    assert_eq!(stack.layout().strips.len(), 7);
    stack.gaps.truncate(7);
    assert_eq!(stack.scene().shown, [0, 1, 2, 3, 4, 5, 6]);
}

#[test]
fn maps_lie_beside_each_other_on_the_picture() {
    for count in 1..=7 {
        for width in [0.01, 0.5, 1.0, 2.0, 100.0] {
            let gaps: [&dyn Fn(f64, f64) -> f64; 7] = [&open; 7];
            let layout = Stack::new(4, width, [false, false], &gaps[..count]).layout();
            let room = |map: &Frame| {
                let Frame { left, top, width, height } = map;
                [left - 20.0, top - 100.0, left + width + 150.0, top + height + 80.0]
            };
            let rooms: Vec<[f64; 4]> = layout.maps.iter().map(room).collect();
            for (k, [left, top, right, bottom]) in rooms.iter().enumerate() {
                assert!(*left > 60.0 && *right < layout.size[0] as f64 && *bottom <= layout.size[1] as f64);
                assert!(*top > layout.maps_top);
                let apart = |other: &[f64; 4]| right < &other[0] || bottom < &other[1];
                assert!(rooms[k + 1..].iter().all(apart), "{count} maps, width {width}: {rooms:?}");
            }
            assert!(layout.size[1] < 2700, "{count} maps, width {width}: {:?}", layout.size);
        }
    }
}

#[test]
fn an_obstacle_that_is_far_off_leaves_the_section_to_the_membranes() {
    let mut stack = Stack::new(16, 1.0, [false, true], &[&open, &open]);
    let section = stack.layout().section;
    let walls = |stack: &Stack| count_in(&stack.image(), &section, WALL[0]);
    assert!(walls(&stack) > 2000);
    let rows_of_first = |stack: &Stack| {
        let image = stack.image();
        let row = |y: usize| {
            count_in(&image, &Frame { top: section.top + y as f64, height: 1.0, ..section }, LAYERS[0]) > 0
        };
        (0..section.height as usize).filter(|&y| row(y)).count()
    };
    let rows = rows_of_first(&stack);
    stack.floor = Some(vec![-1e4; stack.points.len()]);
    assert_eq!(walls(&stack), 0);
    assert!(rows_of_first(&stack) > rows);
}

#[test]
fn the_scale_of_the_data_changes_labels_only() {
    let stack = Stack::three();
    let marks =
        |image: &Image| [CONTACT_BAND, force(1.0), FREE, LAYERS[2], WALL[0]].map(|color| image.count(color));
    // Labels of another length may cover or uncover a few pixels of these colours.
    let same = |a: [usize; 5], b: [usize; 5]| a.iter().zip(b).all(|(&a, b)| a.abs_diff(b) * 50 < a);
    let expected = marks(&stack.image());
    for factors in [[1e-9, 1e-12, 1e9], [1e300, 1e300, 1e300], [1e-290, 1e-290, 1e-290]] {
        let [length, height, force] = factors;
        let found = marks(&stack.scaled(length, height, force).image());
        assert!(same(expected, found), "{factors:?}: {expected:?} and {found:?}");
    }
    assert!(!same(expected, marks(&Stack::apart().image())));
}

#[test]
fn limiting_data_can_be_drawn() {
    let zero: &dyn Fn(f64, f64) -> f64 = &|_, _| 0.0;
    let flat = Stack::three().scaled(1.0, 0.0, 0.0);
    let closed = Stack::new(8, 1.0, [true, true], &[zero; 7]);
    let many = Stack::new(4, 1.0, [true, true], &[zero; 60]);
    let strip = Stack::new(16, 500.0, [false, true], &[&open, &|x, _| x - 200.0]);
    let column = Stack::new(16, 0.002, [true, false], &[&|_, y| y - 0.5, &open]);
    for (name, stack) in
        [("flat", &flat), ("closed", &closed), ("many", &many), ("strip", &strip), ("column", &column)]
    {
        assert!(stack.image().count(CONTACT_BAND) > 1000, "{name}");
    }
    let alone = Stack::new(8, 1.0, [false, false], &[]);
    let level = alone.scaled(1.0, 0.0, 0.0);
    let point = Stack { points: vec![[1.0, 1.0]; 81], ..closed.clone() };
    for stack in [&alone, &level, &point] {
        assert_eq!(stack.image().count(CONTACT_BAND), 0);
    }
}

#[test]
fn contact_away_from_the_cut_or_without_a_force_is_drawn() {
    // Two gaps touch along y = 0.3, the third one elsewhere.
    let line = |_: f64, y: f64| (y - 0.3).abs() - 0.1;
    let mut stack = Stack::new(32, 1.0, [false, false], &[&line, &line, &|_, y| 0.8 - y]);
    let layout = stack.layout();
    let painted = |stack: &Stack| {
        let image = stack.image();
        [0, 2].map(|gap| {
            [
                count_in(&image, &layout.strips[gap], CONTACT_BAND),
                count_in(&image, &layout.maps[gap], force(1.0)),
            ]
        })
    };
    let [[here, _], [elsewhere, map]] = painted(&stack);
    assert!(here > 10_000 && elsewhere == 0 && map > 1000);
    stack.gaps[0].lambda.fill(0.0);
    let [[_, none], [_, map]] = painted(&stack);
    assert!(none == 0 && map > 1000);
}

#[test]
fn unused_vertices_change_nothing() {
    let stack = Stack::three();
    let mut more = stack.clone();
    more.points.push([f64::NAN, 1e300]);
    let layers = more
        .membranes
        .iter_mut()
        .chain(more.floor.as_mut())
        .chain(more.gaps.iter_mut().map(|gap| &mut gap.lambda));
    layers.for_each(|values| values.push(f64::INFINITY));
    more.gaps.iter_mut().for_each(|gap| gap.contact.push(true));
    assert_eq!(more.render(), stack.render());
    let count = more.points.len();
    more.triangles.push([count - 1, 0, 1]);
    assert!(
        matches!(render(&more.picture()), Err(PictureError::Value { vertex, .. }) if vertex == count - 1)
    );
}

#[test]
fn wrong_data_is_an_error_in_one_line() {
    let good = Stack::three();
    let gap = |change: &dyn Fn(&mut Gap)| {
        let mut stack = good.clone();
        change(&mut stack.gaps[1]);
        stack
    };
    let mut infinite = good.clone();
    infinite.membranes[2].fill(f64::INFINITY);
    let cases = [
        (Stack { triangles: Vec::new(), ..good.clone() }, "no triangles"),
        (Stack { triangles: vec![[0, 1, 99_999]], ..good.clone() }, "triangle 0 has vertex 99999"),
        (Stack { membranes: Vec::new(), ..good.clone() }, "no membranes"),
        (infinite, "u3 = inf at vertex 0"),
        (Stack { floor: Some(vec![0.0; 2]), ..good.clone() }, "floor has 2 values for 1089 vertices"),
        (gap(&|gap| gap.lambda = vec![0.0; 3]), "lambda2 has 3 values"),
        (gap(&|gap| gap.contact = vec![true; 3]), "contact2 has 3 values"),
        (gap(&|gap| gap.number = 0), "gap 0 does not lie between two layers"),
        (gap(&|gap| gap.number = 4), "gap 4 does not lie between two layers"),
        (Stack { floor: None, ..good.clone() }, "gap 3 does not lie between two layers"),
    ];
    for (stack, expected) in cases {
        let message = render(&stack.picture()).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}");
        assert_eq!(message.lines().count(), 1);
    }
    assert!(render(&good.picture()).is_ok());
}

#[test]
fn a_solution_is_drawn_with_all_its_layers() {
    let stack = ContactProblem::stack()
        .membrane(Membrane::new(1.0).load(-20.0).height(0.1))
        .membrane(Membrane::new(2.0).load(5.0))
        .ceiling(0.2)
        .floor(-0.1);
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [12, 12], Pattern::Crossed).unwrap();
    let d = StackDiscretization::new(&stack.build().unwrap(), mesh).unwrap();
    let candidate = ActiveSet.solve_stack(&d, &SolverOptions::default()).unwrap();
    let solution = certify_stack(&d, candidate, 1e-9).unwrap();
    let picture = StackPicture::of("", &d, &solution);
    let scene = Scene::new(&picture).unwrap();
    let names: Vec<&str> = scene.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["ceiling", "u₁", "u₂", "floor"]);
    assert_eq!([scene.layers[0].kind, scene.layers[3].kind], [Kind::Ceiling, Kind::Floor]);
    let sides: Vec<String> = scene.gaps.iter().map(|gap| scene.sides(gap)).collect();
    assert_eq!(sides, ["ceiling–u₁", "u₁–u₂", "u₂–floor"]);
    let touching: Vec<usize> = scene.touching().map(|gap| gap.number).collect();
    let of_solution: Vec<usize> =
        solution.gaps().iter().filter(|gap| gap.contact_vertices() > 0).map(|gap| gap.number).collect();
    assert_eq!(touching, of_solution);
    assert!(touching.contains(&1) && !touching.contains(&0));
    assert!(render(&picture).is_ok());
}

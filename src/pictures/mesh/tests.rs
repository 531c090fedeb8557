use super::*;
use crate::mesh::{DualMesh, Mesh, Pattern, SubTriangulation, rectangle, samples};
use crate::pictures::drawing::color::force;
use crate::pictures::drawing::encode::Format;
use crate::pictures::drawing::samples::Image;

/// Rounding of a handful of operations on pixels.
const ROUNDING: f64 = 1e-9;

fn dual(mesh: &Mesh) -> DualMesh {
    DualMesh::new(mesh, &SubTriangulation::new(mesh).unwrap())
}

fn render(mesh: &Mesh, contact: Option<&[bool]>) -> Vec<u8> {
    let dual = dual(mesh);
    render_mesh(&MeshPicture { title: "", mesh, dual: &dual, contact }).unwrap().encode(Format::Png).unwrap()
}

fn image(mesh: &Mesh, contact: Option<&[bool]>) -> Image {
    Image::decode(&render(mesh, contact))
}

/// Where a point of a mesh lies on a picture of the whole.
fn on_picture(mesh: &Mesh, point: [f64; 2], image: &Image) -> [f64; 2] {
    let window = Window::whole(mesh, WHOLE);
    let [x, y] = window.at(point);
    let left = LEFT + (image.width - LEFT - RIGHT - window.size()[0]) / 2;
    [left as f64 + x, TOP as f64 + y]
}

#[test]
fn the_picture_is_as_large_as_the_domain_needs_and_the_same_for_the_same_data() {
    let square = samples::square(8);
    let bytes = render(&square, None);
    assert_eq!(bytes, render(&square, None));
    assert_ne!(bytes, render(&samples::irregular(8), None));
    let picture = Image::decode(&bytes);
    assert_eq!([picture.width, picture.height], [LEFT + 1300 + RIGHT, TOP + 1300 + BOTTOM]);
    let flat = image(&rectangle([0.0, 0.0], [10.0, 1.0], [40, 4], Pattern::Right).unwrap(), None);
    assert_eq!(flat.width, LEFT + 1500 + RIGHT);
    assert!(flat.height < 500);
}

#[test]
fn the_lines_of_both_meshes_lie_where_the_meshes_are() {
    let mesh = samples::irregular(6);
    let dual = dual(&mesh);
    let picture = image(&mesh, None);
    let color_at = |p: [f64; 2]| picture.at(on_picture(&mesh, p, &picture));
    let middle = |p: [f64; 2], q: [f64; 2]| [0, 1].map(|axis| (p[axis] + q[axis]) / 2.0);
    for (k, &a) in dual.vertices().iter().enumerate() {
        let corners: Vec<[f64; 2]> = dual.cell(k).iter().map(|&corner| dual.points()[corner]).collect();
        for (&p, &q) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            assert_eq!(color_at(middle(p, q)), DUAL);
            assert_ne!(color_at(middle(mesh.points()[a], middle(p, q))), DUAL);
        }
        assert_eq!(color_at(mesh.points()[a]), INK, "the vertex of the cell has a dot");
    }
    // Points of triangles nearer to a corner than to the barycentre, off all lines.
    let [low, outside] = [0.005, 0.012].map(|x| on_picture(&mesh, [x, x + 0.06], &picture));
    assert_eq!([picture.at(low), picture.at(outside)], [[255; 3]; 2], "no cell reaches the boundary");
}

/// Refined nine times in the lower left corner.
fn graded() -> Mesh {
    let mut bisection = crate::mesh::Bisection::new(samples::square(8));
    for _ in 0..9 {
        let near = |t: &usize| bisection.mesh().corners(*t).iter().all(|&[x, y]| x.max(y) <= 0.25);
        let marked: Vec<usize> = (0..bisection.mesh().triangles().len()).filter(near).collect();
        bisection.refine(&marked).unwrap();
    }
    Mesh::clone(bisection.mesh())
}

#[test]
fn all_of_a_triangulation_is_shown_and_darker_where_it_is_finer() {
    let mesh = graded();
    let dual = dual(&mesh);
    let triangulation = |contact| {
        let picture = MeshPicture { title: "", mesh: &mesh, dual: &dual, contact };
        Image::decode(&render_triangulation(&picture).unwrap().encode(Format::Png).unwrap())
    };
    let picture = triangulation(None);
    let window = Window::whole(&mesh, OVERVIEW);
    let side = ENLARGED as usize;
    assert_eq!(picture.width, LEFT + window.size()[0] + BETWEEN + side + RIGHT_WITH_AXIS);
    let top = TOP + (side - window.size()[1]) / 2;
    let color_at = |p: [f64; 2]| {
        let [x, y] = window.at(p);
        picture.at([LEFT as f64 + x, top as f64 + y])
    };
    assert_eq!([color_at([0.1, 0.1]), color_at([0.9, 0.82])], [force(1.0), force(0.0)]);
    // Without a contact the part where the mesh is finest is enlarged.
    let finest = Sizes::of(&mesh).finest.map(|a| mesh.points()[a]);
    assert!(finest.iter().all(|&[x, y]| x.max(y) < 0.26), "{finest:?}");
    // The rim is drawn where the contact ends, and only if there is one.
    assert_eq!(picture.count(RIM), 0);
    let left: Vec<bool> = mesh.points().iter().map(|&[x, _]| x < 0.6).collect();
    let all = vec![true; left.len()];
    let [legend, rim] = [&all, &left].map(|contact| triangulation(Some(contact)).count(RIM));
    assert!(rim > legend + window.size()[1] / 2, "{rim} {legend}");
}

#[test]
fn cells_in_contact_and_no_others_are_tinted() {
    let mesh = samples::square(10);
    let touching = |p: &[f64; 2]| (p[0] - 0.5).hypot(p[1] - 0.5) < 0.25;
    let contact: Vec<bool> = mesh.points().iter().map(touching).collect();
    let tinted = image(&mesh, Some(&contact)).count(DUAL_CONTACT);
    assert!(tinted > 100_000);
    // The sample in the legend stays.
    let none = image(&mesh, Some(&vec![false; contact.len()])).count(DUAL_CONTACT);
    assert!(none > 0 && none < 2_000);
    let unknown = image(&mesh, None);
    assert_eq!(unknown.count(DUAL_CONTACT), 0);
    assert!(unknown.count(DUAL_CELL) > 100_000);
}

#[test]
fn a_fine_mesh_has_an_enlarged_part_at_the_rim_of_the_contact() {
    let mesh = samples::square(90);
    assert!(Window::whole(&mesh, WHOLE).spacing < LEGIBLE);
    let picture = image(&mesh, None);
    let width = LEFT + OVERVIEW[0] as usize + BETWEEN + ENLARGED as usize + RIGHT_WITH_AXIS;
    assert_eq!([picture.width, picture.height], [width, TOP + ENLARGED as usize + BOTTOM]);
    assert!(Window::whole(&samples::square(50), WHOLE).spacing >= LEGIBLE);

    let dual = dual(&mesh);
    let contact: Vec<bool> = mesh.points().iter().map(|p| p[0] < 0.2).collect();
    let rim = contact_rim(&MeshPicture { title: "", mesh: &mesh, dual: &dual, contact: Some(&contact) });
    let step = 1.0 / 90.0;
    assert!(!rim.is_empty() && rim.iter().all(|p| p[0] < 0.2 && p[0] + 1.5 * step > 0.2));
    let window = Window::enlarged(&mesh, VERTICES, ENLARGED, &rim);
    let [[low, _], [high, _]] = window.corners();
    assert!(low < 0.2 && 0.2 < high && high < 0.5);
    let middle = Window::enlarged(&mesh, VERTICES, ENLARGED, &[]).corners();
    assert!(middle[0][0] > 0.2 && ((middle[0][0] + middle[1][0]) / 2.0 - 0.5).abs() < ROUNDING);
}

#[test]
fn an_enlarged_part_has_about_the_vertices_that_were_asked_for() {
    let mesh = samples::irregular(40);
    let window = Window::enlarged(&mesh, 300, 600.0, &[]);
    let [low, high] = window.corners();
    let inside = |p: &&[f64; 2]| (0..2).all(|axis| low[axis] < p[axis] && p[axis] < high[axis]);
    let count = mesh.points().iter().filter(inside).count();
    assert_eq!(count, window.vertices);
    assert!((300..400).contains(&count), "{count}");
    assert_eq!(window.size(), [600, 600]);
    // Of fewer than there are, the whole mesh; of a strip, no more than can be told apart.
    assert_eq!(Window::enlarged(&samples::square(10), 300, 600.0, &[]).vertices, 11 * 11);
    let strip = rectangle([0.0, 0.0], [1e4, 1.0], [4000, 1], Pattern::Right).unwrap();
    assert!(Window::enlarged(&strip, 300, 600.0, &[]).vertices < 50);
}

#[test]
fn a_window_is_to_scale_and_knows_what_it_shows() {
    let mesh = rectangle([2.0, -1.0], [4.0, 0.0], [4, 4], Pattern::Right).unwrap();
    let window = Window::whole(&mesh, [1028.0, 5000.0]);
    let [[x0, y0], [x1, y1]] = [[2.0, 0.0], [4.0, -1.0]].map(|corner| window.at(corner));
    assert!((x1 - x0 - 1000.0).abs() < ROUNDING && (y1 - y0 - 500.0).abs() < ROUNDING);
    let extent = |points: &[[f64; 2]]| window.extent(points.iter().copied());
    let [width, height] = extent(&[[2.0, -1.0], [3.5, 0.0]]).unwrap();
    assert!((width - 750.0).abs() < ROUNDING && (height - 500.0).abs() < ROUNDING);
    assert_eq!(extent(&[[5.0, 0.0], [6.0, -1.0]]), None);
    assert_eq!(extent(&[[3.0, 1.0], [3.0, 2.0]]), None);
    assert!(extent(&[[-9.0, -0.5], [9.0, -0.5]]).is_some(), "what passes through is shown");
}

#[test]
fn limiting_meshes_can_be_drawn() {
    let strip = rectangle([0.0, 0.0], [1e4, 1.0], [4000, 1], Pattern::Crossed).unwrap();
    let small = rectangle([0.0, 0.0], [1e-30, 1e-30], [6, 6], Pattern::Right).unwrap();
    let large = rectangle([0.0, 0.0], [1e30, 1e30], [6, 6], Pattern::Right).unwrap();
    for mesh in [&strip, &small, &large] {
        assert!(image(mesh, None).count(DUAL) > 3_000);
    }
    // Without a vertex in the interior there is no dual cell: only the legend has its colour.
    assert!(image(&samples::square(1), None).count(DUAL) < 300);
}

#[test]
fn data_of_another_mesh_is_an_error_in_one_line() {
    let (mesh, other) = (samples::square(4), samples::square(6));
    let [dual, larger] = [dual(&mesh), dual(&other)];
    let short = [false; 3];
    let picture = MeshPicture { title: "", mesh: &mesh, dual: &dual, contact: None };
    let cases = [
        (MeshPicture { dual: &larger, ..picture }, "cell around vertex 25, but the mesh has 25 vertices"),
        (MeshPicture { contact: Some(&short), ..picture }, "contact has 3 values for 25 vertices"),
    ];
    for (picture, expected) in cases {
        let message = render_mesh(&picture).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}");
        assert_eq!(message.lines().count(), 1);
    }
    assert!(render_mesh(&picture).is_ok());
}

#[test]
fn numbers_are_grouped_by_three() {
    for (number, expected) in
        [(0, "0"), (999, "999"), (1000, "1\u{2009}000"), (1002001, "1\u{2009}002\u{2009}001")]
    {
        assert_eq!(grouped(number), expected);
    }
}

use super::*;
use crate::pictures::drawing::canvas::{Anchor, Bitmap, FINE};
use crate::pictures::drawing::color::{CURVES, INK};

/// One of each shape.
fn sample() -> Drawing {
    let mut canvas = Canvas::new([60, 40]);
    canvas.line([[5.0, 5.0], [25.0, 5.0]], 2.0, INK);
    canvas.line([[25.0, 5.0], [25.0, 15.0]], 2.0, INK);
    canvas.line([[40.0, 5.0], [45.0, 5.0]], 2.0, INK);
    canvas.fill([[5.0, 20.0], [15.0, 30.0]], CURVES[0]);
    canvas.triangle([[20.0, 20.0], [30.0, 20.0], [20.0, 30.0]], CURVES[1]);
    canvas.triangle([[30.0, 20.0], [40.0, 20.0], [30.0, 30.0]], CURVES[1]);
    canvas.text("λ<&", [45.0, 30.0], 12.0, INK, Anchor::Left);
    canvas.bitmap([50, 1], Bitmap { size: [FINE; 2], pixels: vec![[9, 9, 9, 128]; FINE * FINE] });
    let mut window = Canvas::new([10, 10]);
    window.line([[-50.0, 5.0], [50.0, 5.0]], 2.0, CURVES[2]);
    canvas.paste(window, [45, 8]);
    Drawing::new(canvas)
}

fn text(drawing: &Drawing) -> String {
    String::from_utf8(drawing.encode(Format::Svg).unwrap()).unwrap()
}

#[test]
fn lines_of_one_pen_are_one_path_and_neighbours_one_polyline() {
    let svg = text(&sample());
    assert!(svg.contains("d=\"M5 5L25 5L25 15M40 5L45 5\""), "{svg}");
    assert!(svg.contains("d=\"M20 20L30 20L20 30ZM30 20L40 20L30 30Z\""), "{svg}");
    assert_eq!(svg.matches("stroke=\"#1e1e1e\"").count(), 2, "in the window as well");
}

#[test]
fn an_svg_is_well_formed_and_holds_every_shape() {
    let svg = text(&sample());
    for (tag, count) in [("<svg", 1), ("</svg>", 1), ("<g ", 1), ("</g>", 1), ("<image", 1), ("<path", 8)] {
        assert_eq!(svg.matches(tag).count(), count, "{tag} in {svg}");
    }
    assert!(svg.contains("<clipPath id=\"w45-8\"><path d=\"M0 0H10V10H0Z\"/></clipPath>"));
    assert!(svg.contains("<g transform=\"translate(45 8)\" clip-path=\"url(#w45-8)\">"));
    assert!(svg.contains("width=\"1\" height=\"1\" xlink:href=\"data:image/png;base64,iVBORw0KGgo"));
    // Letters are outlines: nothing of a text can break the file, and no font is asked for.
    assert!(!svg.contains("<text") && !svg.contains("λ") && !svg.contains("NaN"));
}

#[test]
fn a_pdf_has_one_page_with_a_bitmap_and_its_cover() {
    let bytes = sample().encode(Format::Pdf).unwrap();
    let pdf = String::from_utf8_lossy(&bytes);
    assert!(pdf.starts_with("%PDF-") && pdf.trim_end().ends_with("%%EOF"));
    assert!(pdf.contains("/MediaBox [0 0 15 10]"), "a quarter of a point a pixel");
    assert_eq!(pdf.matches("/Type /Page\n").count() + pdf.matches("/Type/Page\n").count(), 1, "{pdf}");
    assert_eq!(pdf.matches("/SMask").count(), 1);
}

#[test]
fn every_format_has_the_same_bytes_for_the_same_data() {
    for format in [Format::Png, Format::Svg, Format::Pdf] {
        assert_eq!(sample().encode(format).unwrap(), sample().encode(format).unwrap());
        let mut other = Canvas::new([60, 40]);
        other.dot([5.0, 5.0], 2.0, INK);
        assert_ne!(sample().encode(format).unwrap(), Drawing::new(other).encode(format).unwrap());
    }
}

#[test]
fn lines_stay_in_their_window() {
    let image = crate::pictures::drawing::samples::Image::decode(&sample().encode(Format::Png).unwrap());
    assert_eq!(image.at([50.0, 12.0]), CURVES[2]);
    assert_eq!(image.at([40.0, 12.0]), crate::pictures::drawing::color::PAPER);
}

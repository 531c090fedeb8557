//! The checked data of a picture: layers and gaps.

use super::picture::{GapPicture, StackPicture};
use crate::pictures::drawing::axis::subscript;
use crate::pictures::drawing::color::{LAYERS, Rgb, WALL};
use crate::pictures::drawing::frame::Frame;
use crate::pictures::plan::{Action, Cells, Domain, PictureError};

/// The most gaps that have a map: all of six membranes between obstacles.
const MAPS: usize = 7;

/// What all parts of the picture draw from.
pub(super) struct Scene<'a> {
    pub(super) domain: Domain<'a>,
    /// Those that there are, from the top.
    pub(super) layers: Vec<Layer<'a>>,
    /// From the top.
    pub(super) gaps: Vec<Gap<'a>>,
    /// The gaps that have a map, as indices into `gaps`: where there are too many, those with the greatest total force.
    pub(super) shown: Vec<usize>,
}

/// A membrane or an obstacle.
pub(super) struct Layer<'a> {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) color: Rgb,
    heights: &'a [f64],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Ceiling,
    Membrane,
    Floor,
}

/// A gap between two layers.
pub(super) struct Gap<'a> {
    pub(super) number: usize,
    /// The layer above as an index into the layers; the next one is that below.
    pub(super) upper: usize,
    pub(super) action: Action<'a>,
    pub(super) total_force: f64,
}

impl<'a> Scene<'a> {
    /// Checks the picture's data.
    pub(super) fn new(picture: &StackPicture<'a>) -> Result<Scene<'a>, PictureError> {
        let domain = Domain::new(picture.points, picture.triangles, picture.ancestry)?;
        if picture.membranes.is_empty() {
            return Err(PictureError::NoMembranes);
        }
        for (i, heights) in picture.membranes.iter().enumerate() {
            domain.check_values(&format!("u{}", i + 1), heights)?;
        }
        for (name, obstacle) in ["the ceiling", "the floor"].into_iter().zip(picture.obstacles) {
            obstacle.map_or(Ok(()), |heights| domain.check_values(name, heights))?;
        }
        let gaps = picture.gaps.iter().map(|gap| checked(picture, &domain, gap));
        let gaps = gaps.collect::<Result<Vec<_>, _>>()?;
        let mut shown: Vec<usize> = (0..gaps.len()).collect();
        shown.sort_by(|&a, &b| gaps[b].total_force.total_cmp(&gaps[a].total_force));
        shown.truncate(MAPS);
        shown.sort_unstable();
        Ok(Scene { domain, layers: layers(picture), gaps, shown })
    }

    /// How many membranes there are.
    pub(super) fn membranes(&self) -> usize {
        self.layers.iter().filter(|layer| layer.kind == Kind::Membrane).count()
    }

    /// The gap of a map.
    pub(super) fn gap_of_map(&self, map: usize) -> Option<&Gap<'a>> {
        self.shown.get(map).map(|&gap| &self.gaps[gap])
    }

    /// The gaps that have a map and contact.
    pub(super) fn touching(&self) -> impl Iterator<Item = &Gap<'a>> {
        self.shown.iter().map(|&gap| &self.gaps[gap]).filter(|gap| gap.action.touching)
    }

    /// The dual cells of a map.
    pub(super) fn cells(&self, map: usize, room: Frame) -> Cells {
        let gap = self.gap_of_map(map);
        Cells::new(&self.domain, room, |vertex| gap.is_some_and(|gap| gap.action.in_contact(vertex)))
    }

    /// The layers of a gap by name.
    pub(super) fn sides(&self, gap: &Gap) -> String {
        format!("{}–{}", self.layers[gap.upper].name, self.layers[gap.upper + 1].name)
    }
}

impl Layer<'_> {
    pub(super) fn height(&self, vertex: usize) -> f64 {
        self.heights[vertex]
    }
}

impl Gap<'_> {
    /// `λ` with the number of the gap.
    pub(super) fn symbol(&self) -> String {
        format!("λ{}", subscript(self.number))
    }
}

fn layers<'a>(picture: &StackPicture<'a>) -> Vec<Layer<'a>> {
    let [_, _, surface] = WALL;
    let [ceiling, floor] = picture.obstacles;
    let wall = |name: &str, kind, heights| Layer { name: name.to_owned(), kind, color: surface, heights };
    let membrane = |(i, &heights): (usize, &&'a [f64])| Layer {
        name: format!("u{}", subscript(i + 1)),
        kind: Kind::Membrane,
        color: LAYERS[i % LAYERS.len()],
        heights,
    };
    let ceiling = ceiling.map(|heights| wall("ceiling", Kind::Ceiling, heights));
    let floor = floor.map(|heights| wall("floor", Kind::Floor, heights));
    ceiling.into_iter().chain(picture.membranes.iter().enumerate().map(membrane)).chain(floor).collect()
}

fn checked<'a>(
    picture: &StackPicture<'a>,
    domain: &Domain,
    gap: &GapPicture<'a>,
) -> Result<Gap<'a>, PictureError> {
    let (number, membranes) = (gap.number, picture.membranes.len());
    let [ceiling, floor] = picture.obstacles.map(|obstacle| obstacle.is_some());
    if number > membranes || number == 0 && !ceiling || number == membranes && !floor {
        return Err(PictureError::Gap { number, membranes });
    }
    domain.check_values(&format!("lambda{number}"), gap.lambda)?;
    domain.check_length(&format!("contact{number}"), gap.contact.len())?;
    Ok(Gap {
        number,
        // Without a ceiling the first of the layers is membrane 1.
        upper: if ceiling { number } else { number - 1 },
        action: Action::new(domain, gap.lambda, gap.contact),
        total_force: gap.total_force,
    })
}

//! The pictures of a run: in the formats that were asked for, in the time that there is.

use super::clock::{self, Clock};
use super::files::{FORMATS, Picture};
use crate::cli::args::PictureArguments;
use crate::cli::failure::Failure;
use crate::pictures::{Drawing, Format};

/// How pictures are written, if at all.
pub(crate) struct Pictures {
    /// Each of them once.
    formats: Vec<Format>,
    clock: Clock,
}

impl Pictures {
    pub(crate) fn new(arguments: &PictureArguments, clock: Clock) -> Self {
        let wanted = |format: &Format| !arguments.no_picture && arguments.picture_format.contains(format);
        Self { formats: FORMATS.into_iter().filter(wanted).collect(), clock }
    }

    /// The files of a picture.
    pub(crate) fn files(&self, picture: Picture) -> Vec<&'static str> {
        let files = FORMATS.into_iter().zip(picture);
        files.filter(|(format, _)| self.formats.contains(format)).map(|(_, file)| file).collect()
    }

    /// Begins to draw a picture, beside what the run does until it is [written](Begun::write).
    pub(crate) fn begin(
        &self,
        picture: Picture,
        draw: impl FnOnce() -> Result<Drawing, String> + Send + 'static,
    ) -> Begun {
        let (formats, files) = (self.formats.clone(), self.files(picture));
        let encoded = move || {
            let drawing = draw()?;
            let encode = |format| drawing.encode(format).map_err(|error| error.to_string());
            formats.into_iter().map(encode).collect()
        };
        let encoded = (!files.is_empty()).then(|| self.clock.begin(encoded));
        Begun { files, encoded }
    }

    /// Draws a picture and [writes](Begun::write) it.
    pub(crate) fn write(
        &self,
        picture: Picture,
        draw: impl FnOnce() -> Result<Drawing, String> + Send + 'static,
        write: impl FnMut(&'static str, &[u8]) -> Result<(), Failure>,
    ) -> Result<Vec<&'static str>, Failure> {
        self.begin(picture, draw).write(write)
    }
}

/// A picture that is being drawn.
pub(crate) struct Begun {
    files: Vec<&'static str>,
    encoded: Option<clock::Begun<Result<Vec<Vec<u8>>, String>>>,
}

impl Begun {
    /// Hands the bytes of each file of the picture to `write` if they are ready in time; else the names of the files are returned.
    pub(crate) fn write(
        self,
        mut write: impl FnMut(&'static str, &[u8]) -> Result<(), Failure>,
    ) -> Result<Vec<&'static str>, Failure> {
        let Self { files, encoded } = self;
        let Some(encoded) = encoded.and_then(clock::Begun::in_time) else { return Ok(files) };
        let encoded = encoded.map_err(|error| Failure::Input(format!("{}: {error}", files[0])))?;
        files.iter().zip(&encoded).try_for_each(|(file, bytes)| write(file, bytes))?;
        Ok(Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::run::files::MESH;

    fn files(no_picture: bool, formats: &[Format]) -> Vec<&'static str> {
        let arguments = PictureArguments { no_picture, picture_format: formats.to_vec() };
        Pictures::new(&arguments, Clock::new(None)).files(MESH)
    }

    #[test]
    fn each_format_is_written_once() {
        assert_eq!(files(false, &[Format::Pdf, Format::Svg, Format::Pdf]), ["mesh.svg", "mesh.pdf"]);
        assert_eq!(files(false, &[Format::Png]), ["mesh.png"]);
        assert_eq!(files(true, &[Format::Png]), [""; 0]);
    }

    #[test]
    fn without_pictures_nothing_is_drawn() {
        let written = |no_picture| {
            let arguments = PictureArguments { no_picture, picture_format: vec![Format::Png] };
            let pictures = Pictures::new(&arguments, Clock::new(None));
            pictures.write(MESH, || Err("it was drawn".into()), |_, _| Ok(()))
        };
        assert_eq!(written(true), Ok(Vec::new()));
        assert_eq!(written(false), Err(Failure::Input("mesh.png: it was drawn".into())));
    }
}

//! Which pictures a command writes, and in which formats.

use clap::{Args, ValueEnum};

use super::Failure;
#[cfg(feature = "pictures")]
use crate::output::WriteSeek;
#[cfg(feature = "pictures")]
use crate::pictures::{Drawing, Format};

#[derive(Debug, Clone, Default, Args)]
pub(super) struct PictureArguments {
    /// Write no pictures
    #[arg(long, conflicts_with = "picture_format")]
    pub(super) no_picture: bool,
    /// Formats of the pictures: png, svg, pdf [default: png]
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',', hide_possible_values = true)]
    pub(super) picture_format: Vec<PictureFormat>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum PictureFormat {
    Png,
    Svg,
    Pdf,
}

impl PictureFormat {
    fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }

    #[cfg(feature = "pictures")]
    fn format(self) -> Format {
        match self {
            Self::Png => Format::Png,
            Self::Svg => Format::Svg,
            Self::Pdf => Format::Pdf,
        }
    }
}

/// The formats of every picture of a run; none if there are to be no pictures.
#[derive(Debug, Clone)]
pub(super) struct Pictures(Vec<PictureFormat>);

impl Pictures {
    /// What was asked for; refuses what this build cannot draw.
    pub(super) fn new(arguments: &PictureArguments) -> Result<Self, Failure> {
        let mut formats = Vec::new();
        for &format in &arguments.picture_format {
            if !formats.contains(&format) {
                formats.push(format);
            }
        }
        if !cfg!(feature = "pictures") && !formats.is_empty() {
            let remedy = "leave out --picture-format, or build with the feature `pictures`";
            return Err(Failure::Input(format!("this build draws no pictures: {remedy}")));
        }
        let silent = arguments.no_picture || !cfg!(feature = "pictures");
        if formats.is_empty() && !silent {
            formats.push(PictureFormat::Png);
        }
        Ok(Self(formats))
    }

    /// The files of the picture that is called `stem`.
    pub(super) fn files(&self, stem: &str) -> Vec<String> {
        self.0.iter().map(|format| file(stem, *format)).collect()
    }

    /// Draws a picture, if there are to be any, and hands each of its files to `write`.
    #[cfg(feature = "pictures")]
    pub(super) fn write(
        &self,
        stem: &str,
        draw: impl FnOnce() -> Result<Drawing, String>,
        mut write: impl FnMut(&str, &Bytes) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        if self.0.is_empty() {
            return Ok(());
        }
        let failed = |error: String| Failure::Input(format!("{stem}: {error}"));
        let drawing = draw().map_err(failed)?;
        self.0.iter().try_for_each(|&format| {
            let bytes = drawing.encode(format.format()).map_err(|error| failed(error.to_string()))?;
            write(&file(stem, format), &|out: &mut (dyn WriteSeek + '_)| out.write_all(&bytes))
        })
    }
}

/// What writes the bytes of a picture.
#[cfg(feature = "pictures")]
type Bytes<'a> = dyn Fn(&mut (dyn WriteSeek + '_)) -> std::io::Result<()> + 'a;

/// The files that any run may have left of a picture.
pub(super) fn all_files(stem: &str) -> impl Iterator<Item = String> + '_ {
    PictureFormat::value_variants().iter().map(move |&format| file(stem, format))
}

fn file(stem: &str, format: PictureFormat) -> String {
    format!("{stem}.{}", format.extension())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(no_picture: bool, formats: &[PictureFormat]) -> Result<Vec<String>, Failure> {
        let arguments = PictureArguments { no_picture, picture_format: formats.to_vec() };
        Pictures::new(&arguments).map(|pictures| pictures.files("membranes"))
    }

    #[test]
    #[cfg(feature = "pictures")]
    fn each_format_is_written_once_and_png_if_none_is_named() {
        use PictureFormat::{Pdf, Png, Svg};
        assert_eq!(files(false, &[]), Ok(vec!["membranes.png".into()]));
        assert_eq!(files(true, &[]), Ok(Vec::new()));
        assert_eq!(files(false, &[Pdf, Svg, Pdf]), Ok(vec!["membranes.pdf".into(), "membranes.svg".into()]));
        assert_eq!(all_files("mesh").count(), [Png, Svg, Pdf].len());
    }

    #[test]
    #[cfg(not(feature = "pictures"))]
    fn a_build_without_pictures_says_so_if_one_is_asked_for() {
        assert_eq!(files(false, &[]), Ok(Vec::new()));
        let message = files(false, &[PictureFormat::Png]).unwrap_err().to_string();
        assert!(message.contains("draws no pictures: leave out --picture-format"), "{message}");
    }
}

//! Pictures of voronaut's meshes, as SVG and PNG.

mod cells;
mod colours;
mod ellipses;
mod frame;
mod histogram;
mod letters;
mod palette;
#[cfg(feature = "png")]
mod png;
mod scene;
mod shades;
mod simplify;
mod strokes;
mod svg;
#[cfg(test)]
mod test_meshes;
mod unmet;

pub use cells::Layers;
pub use histogram::histograms_svg;
#[cfg(feature = "png")]
pub(crate) use png::{data_url, render_png};
pub use scene::{Scene, Stroke, View, draw_surface};
pub use shades::Protection;
pub use svg::{Picture, svg_with};

use std::path::Path;
use voronaut::{Error, Result};

/// Formats of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Vector.
    Svg,
    /// Pixels.
    Png,
}

impl PictureFormat {
    /// The format a file name asks for by its ending, in upper or lower case.
    ///
    /// # Errors
    /// [`Error::Unsupported`], with the endings that work.
    pub fn from_path(path: &Path) -> Result<Self> {
        let png = cfg!(feature = "png");
        match ending(path).as_str() {
            "svg" => Ok(PictureFormat::Svg),
            "png" if png => Ok(PictureFormat::Png),
            _ => {
                let what = format!("{} does not end like a picture", path.display());
                let help = if png { "end the name of the picture in .svg or .png" } else { "end it in .svg" };
                Err(Error::Unsupported { what, help: help.into() })
            }
        }
    }
}

/// The bytes of a picture made by [`svg_with`] or [`draw_surface`] in the format that a file name ends in.
///
/// # Errors
/// [`Error::Unsupported`] for other endings, [`Error::Limit`] for too many pixels.
pub fn picture_bytes(svg: &str, path: &Path) -> Result<Vec<u8>> {
    match PictureFormat::from_path(path)? {
        PictureFormat::Svg => Ok(svg.as_bytes().to_vec()),
        #[cfg(feature = "png")]
        PictureFormat::Png => render_png(svg),
        #[cfg(not(feature = "png"))]
        PictureFormat::Png => unreachable!("from_path knows no png without the feature"),
    }
}

/// Refuses images of pixels: the library was built without PNG.
#[cfg(not(feature = "png"))]
pub(crate) fn data_url(_: &[[u8; 3]], _: u32) -> Result<String> {
    let what = "a picture of a surface, for this build knows no PNG".into();
    Err(Error::Unsupported { what, help: "build with the feature png".into() })
}

fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_name_formats() {
        let format = |name: &str| PictureFormat::from_path(Path::new(name));
        assert_eq!(format("a.SVG").unwrap(), PictureFormat::Svg);
        assert!(format("a.gif").unwrap_err().help().contains(".svg"));
    }
}

//! Pictures of voronaut's meshes, as SVG and PNG, and pages to look at them.

mod cells;
mod colours;
mod curves;
mod ellipses;
mod frame;
mod histogram;
mod letters;
mod page;
mod palette;
#[cfg(feature = "png")]
mod png;
mod scene;
mod shades;
mod simplify;
mod strokes;
mod svg;
mod text;
#[cfg(test)]
mod test_meshes;
mod unmet;

pub use cells::Layers;
pub use histogram::histograms_svg;
pub use page::{Sheet, page};
#[cfg(feature = "png")]
pub(crate) use png::{data_url, render_png};
pub use scene::{Scene, Stroke, View, draw_surface};
pub use shades::Protection;
pub use svg::{Picture, svg_with};

use std::path::Path;
use voronaut::{Error, Result};

/// Refuses names that do not end like a picture, in upper or lower case; says whether it is one of pixels.
///
/// # Errors
/// [`Error::Unsupported`], with the endings that work.
pub fn is_png(path: &Path) -> Result<bool> {
    let has_png = cfg!(feature = "png");
    match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
        Some("svg") => Ok(false),
        Some("png") if has_png => Ok(true),
        _ => {
            let what = format!("{} does not end like a picture", path.display());
            let help = if has_png { "end the name of the picture in .svg or .png" } else { "end it in .svg" };
            Err(Error::unsupported(what, help))
        }
    }
}

/// The bytes of a picture made by [`svg_with`] or [`draw_surface`] in the format that a file name ends in.
///
/// # Errors
/// [`Error::Unsupported`] for other endings, [`Error::Limit`] for too many pixels.
pub fn picture_bytes(svg: &str, path: &Path) -> Result<Vec<u8>> {
    if is_png(path)? {
        #[cfg(feature = "png")]
        return render_png(svg);
    }
    Ok(svg.as_bytes().to_vec())
}

/// Refuses images of pixels: the library was built without PNG.
#[cfg(not(feature = "png"))]
pub(crate) fn data_url(_: &[[u8; 3]], _: u32) -> Result<String> {
    let what = "a picture of a surface, for this build knows no PNG";
    Err(Error::unsupported(what, "build with the feature png"))
}

/// The README's examples are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_name_formats() {
        let is_png = |name: &str| is_png(Path::new(name));
        assert!(!is_png("a.SVG").unwrap() && is_png("a.Png").is_ok_and(|png| png) == cfg!(feature = "png"));
        assert!(is_png("a.gif").unwrap_err().help().contains(".svg"));
    }
}

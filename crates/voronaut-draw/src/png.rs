//! SVG to PNG, and PNGs within an SVG.

use super::text::base64;
use resvg::tiny_skia::{IntSize, Pixmap, PixmapPaint, Transform};
use resvg::usvg::{ImageHrefResolver, Options, Tree};
use std::sync::{Arc, Mutex, PoisonError};
use voronaut::{Error, Result};

/// The most pixels a picture may have: 400 MB of memory.
const LIMIT: f64 = 1e8;

/// Renders an SVG, at the size it asks for, to the bytes of a PNG file. Of images only those are known that are PNGs
/// within the SVG; they are drawn pixel by pixel, from the upper left corner, under everything else, as pictures of
/// surfaces have them.
///
/// # Errors
/// [`Error::Parse`] where the text is no SVG, [`Error::Limit`] for more than 10^8 pixels.
pub(crate) fn render_png(svg: &str) -> Result<Vec<u8>> {
    let fault = |what: String| Error::parse("picture", what, "write the picture as .svg");
    let images = Arc::default();
    let options = Options { image_href_resolver: resolver(&images), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| fault(error.to_string()))?;
    let (width, height) = (tree.size().width().ceil(), tree.size().height().ceil());
    let too_large = || {
        let what = format!("a picture of {width} x {height} pixels; the limit is {LIMIT:e} pixels");
        Error::limit(what, "make the picture narrower, or write it as .svg")
    };
    if f64::from(width) * f64::from(height) > LIMIT {
        return Err(too_large());
    }
    let mut pixels = Pixmap::new(width as u32, height as u32).ok_or_else(too_large)?;
    let images = images.lock().unwrap_or_else(PoisonError::into_inner);
    for image in images.iter() {
        let image = Pixmap::decode_png(image).map_err(|error| fault(error.to_string()))?;
        pixels.draw_pixmap(0, 0, image.as_ref(), &PixmapPaint::default(), Transform::default(), None);
    }
    resvg::render(&tree, Transform::default(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| fault(error.to_string()))
}

/// Opaque pixels, row by row, as the address of a PNG that holds them.
///
/// # Errors
/// [`Error::Limit`] where there are none.
pub(super) fn data_url(pixels: &[[u8; 3]], width: u32) -> Result<String> {
    let height = (pixels.len() as u32).checked_div(width).unwrap_or(0);
    let fault = || Error::limit(format!("an image of {width} x {height} pixels"), "give the picture another width");
    let bytes = pixels.iter().flat_map(|&[r, g, b]| [r, g, b, u8::MAX]).collect();
    let size = IntSize::from_wh(width, height).ok_or_else(fault)?;
    let png = Pixmap::from_vec(bytes, size).and_then(|pixmap| pixmap.encode_png().ok()).ok_or_else(fault)?;
    Ok(format!("data:image/png;base64,{}", base64(&png)))
}

/// Keeps the images of an SVG, and opens no files. resvg draws images only with a feature that brings decoders of formats
/// which are not needed here.
fn resolver(images: &Arc<Mutex<Vec<Arc<Vec<u8>>>>>) -> ImageHrefResolver<'static> {
    let images = Arc::clone(images);
    ImageHrefResolver {
        resolve_data: Box::new(move |_, data, _| {
            images.lock().unwrap_or_else(PoisonError::into_inner).push(data);
            None
        }),
        resolve_string: Box::new(|_, _| None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn renders_small_and_refuses_huge_and_nonsense() {
        let svg = |side: &str| format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="{side}" height="{side}"/>"#);
        assert!(render_png(&svg("8")).unwrap().starts_with(b"\x89PNG"));
        assert!(matches!(render_png(&svg("100000")), Err(Error::Limit { .. })));
        assert!(matches!(render_png("no picture"), Err(Error::Parse { .. })));
    }
}

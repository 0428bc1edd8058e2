//! SVG to PNG.

use crate::error::{Error, Result};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// The most pixels a picture may have: 400 MB of memory.
const LIMIT: f64 = 1e8;

/// Renders an SVG, at the size it asks for, to the bytes of a PNG file.
///
/// # Errors
/// [`Error::Parse`] where the text is no SVG, [`Error::Limit`] for more than 10^8 pixels.
pub fn render_png(svg: &str) -> Result<Vec<u8>> {
    let fault = |what: String| Error::parse("picture", what, "write the picture as .svg");
    let tree = Tree::from_str(svg, &Options::default()).map_err(|error| fault(error.to_string()))?;
    let (width, height) = (tree.size().width().ceil(), tree.size().height().ceil());
    let too_large = || Error::Limit {
        what: format!("a picture of {width} x {height} pixels; the limit is {LIMIT:e} pixels"),
        help: "make the picture narrower, or write it as .svg".into(),
    };
    if f64::from(width) * f64::from(height) > LIMIT {
        return Err(too_large());
    }
    let mut pixels = Pixmap::new(width as u32, height as u32).ok_or_else(too_large)?;
    resvg::render(&tree, Transform::default(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| fault(error.to_string()))
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

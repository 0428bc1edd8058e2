//! Images of pixels within an SVG.

#[cfg(not(feature = "png"))]
use voronaut::Error;
use voronaut::Result;

/// Opaque pixels, row by row, as the address of a PNG that holds them.
///
/// # Errors
/// [`Error::Unsupported`](voronaut::Error::Unsupported) if the library was built without PNG.
#[cfg(feature = "png")]
pub(super) fn data_url(pixels: &[[u8; 3]], width: u32) -> Result<String> {
    let height = (pixels.len() as u32).checked_div(width).unwrap_or(0);
    let png = super::png::encode(pixels, [width, height])?;
    Ok(format!("data:image/png;base64,{}", base64(&png)))
}

/// Refuses: the library was built without PNG.
#[cfg(not(feature = "png"))]
pub(super) fn data_url(_: &[[u8; 3]], _: u32) -> Result<String> {
    let what = "a picture of a surface, for this build knows no PNG".into();
    Err(Error::Unsupported { what, help: "build with the feature png".into() })
}

/// Bytes as text: three bytes as four characters (RFC 4648).
#[cfg(feature = "png")]
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let three = [0, 1, 2].map(|i| u32::from(group.get(i).copied().unwrap_or(0)));
        let number = three[0] << 16 | three[1] << 8 | three[2];
        for digit in 0..4 {
            let value = number >> (18 - 6 * digit) & 63;
            text.push(if digit <= group.len() { char::from(DIGITS[value as usize]) } else { '=' });
        }
    }
    text
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_its_definition() {
        let texts = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| base64(text.as_bytes()));
        assert_eq!(texts, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }
}

//! A page to look at meshes with: one HTML file that needs no other, no server and no network.
//!
//! | module | what it is |
//! |---|---|
//! | `order` | triangles in an order in which a small number tells each |
//! | `bytes` | numbers as bytes that deflate well |
//! | `sheet` | a mesh and what is known of it, packed |
//!
//! The program that shows them is TypeScript, in `viewer/` beside `src/`; `viewer/build` makes `viewer.html` of it, the page without
//! meshes, which is kept in the repository so that users need no node.

mod bytes;
mod order;
mod sheet;

pub use sheet::Sheet;

use super::text::base64;
use bytes::Store;
use serde_json::json;
use voronaut::{Error, Result};

/// The page without meshes.
const TEMPLATE: &str = include_str!("viewer.html");
/// Where the description and the numbers go in it.
const PLACES: [&str; 3] = ["{{title}}", "{{description}}", "{{numbers}}"];

/// The most triangles that all meshes of a page may have: browsers keep some hundred bytes for each.
const MOST_TRIANGLES: usize = 5_000_000;

/// The page that shows meshes: one after the other, or side by side.
///
/// # Errors
/// [`Error::Limit`] of more than five million triangles, [`Error::Mesh`] of a mesh that names vertices it does not have,
/// [`Error::Unsupported`] of no mesh, or of one without triangles.
pub fn page(title: &str, sheets: &[Sheet]) -> Result<String> {
    let triangles: usize = sheets.iter().map(Sheet::count).sum();
    if triangles > MOST_TRIANGLES {
        let what = format!("a page of {triangles} triangles; the limit is {MOST_TRIANGLES}");
        return Err(Error::limit(what, "show fewer or coarser meshes"));
    }
    if sheets.is_empty() {
        return Err(Error::unsupported("a page without a mesh", "give it a mesh"));
    }
    let mut store = Store::default();
    let meshes = sheets.iter().map(|sheet| sheet.packed(&mut store)).collect::<Result<Vec<_>>>()?;
    let description =
        json!({ "title": title, "by": concat!("voronaut ", env!("CARGO_PKG_VERSION")), "meshes": meshes });
    // No tag may end within the script that holds the description.
    let description = description.to_string().replace('<', "\\u003c");
    let numbers = base64(store.as_bytes());
    let escaped = title.replace('&', "&amp;").replace('<', "&lt;");
    Ok(filled([&escaped, &description, &numbers]))
}

/// The template with these texts in its places, which come in this order.
fn filled(texts: [&str; 3]) -> String {
    let length = TEMPLATE.len() + texts.iter().map(|text| text.len()).sum::<usize>();
    let (mut page, mut rest) = (String::with_capacity(length), TEMPLATE);
    for (place, text) in PLACES.into_iter().zip(texts) {
        let (before, after) = rest.split_once(place).unwrap_or((rest, ""));
        page.push_str(before);
        page.push_str(text);
        rest = after;
    }
    page.push_str(rest);
    page
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{grid, mesh};

    fn sheet(mesh: voronaut::mesh::Mesh) -> Sheet {
        Sheet { mesh, ..Sheet::default() }
    }

    #[test]
    fn the_template_has_its_places_and_asks_for_nothing() {
        let at = PLACES.map(|place| TEMPLATE.find(place).expect("a place"));
        assert!(at.is_sorted() && PLACES.iter().all(|place| TEMPLATE.matches(place).count() == 1));
        assert!(TEMPLATE.len() < 300_000, "{} bytes", TEMPLATE.len());
        for word in ["src=\"", "href=\"http", "@import", "fetch("] {
            assert!(!TEMPLATE.contains(word), "{word}");
        }
    }

    #[test]
    fn titles_and_names_end_no_tag() {
        let page = page("a</script>", &[Sheet { name: "</script>".into(), ..sheet(grid(2, 2)) }]).unwrap();
        assert_eq!(page.matches("</script>").count(), TEMPLATE.matches("</script>").count());
    }

    #[test]
    fn what_cannot_be_shown_is_refused() {
        let fault = |sheets: &[Sheet]| page("", sheets).unwrap_err().to_string();
        assert!(fault(&[]).contains("without a mesh"));
        assert!(fault(&[sheet(mesh(&[[0.0, 0.0]], &[]))]).contains("no triangles"));
        assert!(fault(&[sheet(mesh(&[[0.0, 0.0]], &[[0, 1, 2]]))]).contains("does not exist"));
        assert!(fault(&[sheet(mesh(&[[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]], &[[0, 1, 2]]))]).contains("finite"));
    }

    /// A million triangles are promised at six megabytes; these are as irregular as triangles of one size may be.
    #[test]
    fn geometry_takes_less_than_four_bytes_a_triangle() {
        let mut wild = grid(150, 150);
        let mut state = 1_u64;
        for p in &mut wild.points {
            for x in &mut p[..2] {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *x += 0.4 * ((state >> 40) as f64 / f64::from(1 << 24) - 0.5);
            }
        }
        let mut store = Store::default();
        let told = sheet(wild).packed(&mut store).unwrap();
        let bytes = told["geometry_bytes"].as_u64().unwrap();
        assert!(bytes < 4 * 45_000, "{bytes} bytes");
    }
}

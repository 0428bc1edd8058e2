//! `GeoJSON` (RFC 7946): polygons, their coordinates taken as planar.

use super::codec::Shortest;
use ::geojson::{Feature, GeoJson, Geometry, GeometryValue, Position};
use std::io::{self, Write};
use voronaut::geometry::Point;
use voronaut::manifold::domain::{Polygon, Polygons, Ring};
use voronaut::{Error, Result};

/// Reads all polygons of a `FeatureCollection`, `Feature` or geometry; features without geometry are passed over.
///
/// A region's label is the first integer (of 32 bits) among the feature's properties `region`, `ref`, `label` and `id`;
/// without one it is the number of the feature, from 1. The boundary's label is the property `boundary`, for all rings;
/// a list of integers labels the rings of each polygon in turn; without it outer rings have 1, and the holes 2, 3, ... as they
/// follow each other in the file. Third coordinates are passed over. `place` names the text in messages.
///
/// # Errors
///
/// [`Error::Parse`] of what is no `GeoJSON`, holds other geometries than polygons, or none. [`Error::Domain`] with
/// feature, polygon, ring, position and coordinates of a ring that is not closed or has fewer than four positions, or
/// of a position without two finite coordinates.
pub fn read(text: &str, place: &str) -> Result<Polygons> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let json = text.parse::<GeoJson>().map_err(|error| malformed(&error, text, place))?;
    let mut reader = Reader { place, polygons: Vec::new(), holes: 0 };
    for (index, feature) in features(json).iter().enumerate() {
        reader.read_feature(feature, index + 1)?;
    }
    if reader.polygons.is_empty() {
        let help = "give a file with a Polygon or a MultiPolygon";
        return Err(Error::parse(end_of(text, place), "the file holds no polygon", help));
    }
    Ok(Polygons { polygons: reader.polygons })
}

/// Writes a `FeatureCollection` that [`read`] turns into the same polygons, if they are numbered in turn: a feature for each, with the
/// properties `region` and `boundary`, the labels of its rings.
///
/// # Errors
/// What `out` says.
pub fn write(polygons: &Polygons, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"{\"type\": \"FeatureCollection\", \"features\": [")?;
    for (i, polygon) in polygons.polygons.iter().enumerate() {
        let labels: Vec<String> = polygon.rings.iter().map(|ring| ring.label.to_string()).collect();
        let rings: Vec<String> = polygon.rings.iter().map(written).collect();
        write!(
            out,
            "{}\n{{\"type\": \"Feature\", \"properties\": {{\"region\": {}, \"boundary\": [{}]}},\n \
             \"geometry\": {{\"type\": \"Polygon\", \"coordinates\": [{}]}}}}",
            if i == 0 { "" } else { "," },
            polygon.region,
            labels.join(", "),
            rings.join(",")
        )?;
    }
    out.write_all(b"\n]}\n")
}

/// A ring as it is written, on a line of its own.
fn written(ring: &Ring) -> String {
    let closed = ring.points.iter().chain(ring.points.first());
    let positions: Vec<String> = closed.map(|p| format!("[{}, {}]", Shortest(p.x), Shortest(p.y))).collect();
    format!("\n  [{}]", positions.join(", "))
}

struct Reader<'a> {
    place: &'a str,
    polygons: Vec<Polygon>,
    /// Holes so far that no property labels.
    holes: i32,
}

/// What the rings of a feature have in common.
struct Labels {
    feature: usize,
    polygons: usize,
    region: i32,
    /// One for all rings, or one for each.
    boundary: Vec<i32>,
}

impl Reader<'_> {
    fn read_feature(&mut self, feature: &Feature, number: usize) -> Result<()> {
        let Some(geometry) = &feature.geometry else { return Ok(()) };
        let region = ["region", "ref", "label", "id"].iter().find_map(|key| integer(feature, key));
        let region = region.unwrap_or_else(|| i32::try_from(number).unwrap_or(i32::MAX));
        let mut labels = Labels { feature: number, polygons: 0, region, boundary: boundary(feature) };
        self.read_geometry(geometry, &mut labels)
    }

    fn read_geometry(&mut self, geometry: &Geometry, labels: &mut Labels) -> Result<()> {
        match &geometry.value {
            GeometryValue::Polygon { coordinates } => self.read_polygon(coordinates, labels),
            GeometryValue::MultiPolygon { coordinates } => {
                coordinates.iter().try_for_each(|polygon| self.read_polygon(polygon, labels))
            }
            GeometryValue::GeometryCollection { geometries } => {
                geometries.iter().try_for_each(|geometry| self.read_geometry(geometry, labels))
            }
            other => {
                let place = format!("{}, feature {}", self.place, labels.feature);
                let what = format!("a {} where a Polygon or MultiPolygon is expected", other.type_name());
                Err(Error::parse(place, what, "remove it, or turn closed lines into polygons"))
            }
        }
    }

    fn read_polygon(&mut self, rings: &[Vec<Position>], labels: &mut Labels) -> Result<()> {
        labels.polygons += 1;
        let place = format!("{}, feature {}, polygon {}", self.place, labels.feature, labels.polygons);
        if rings.is_empty() {
            return Err(Error::domain("a polygon without rings", place, "give it an outer ring, or remove it"));
        }
        let mut read = Vec::with_capacity(rings.len());
        for (index, ring) in rings.iter().enumerate() {
            let points = read_ring(ring, &format!("{place}, ring {}", index + 1))?;
            let own = labels.boundary.get(index).or(labels.boundary.first().filter(|_| labels.boundary.len() == 1));
            let label = own.copied().unwrap_or_else(|| self.ring_label(index));
            read.push(Ring { points, label });
        }
        let (feature, number, region) = (labels.feature, labels.polygons, labels.region);
        self.polygons.push(Polygon { feature, number, region, rings: read });
        Ok(())
    }

    fn ring_label(&mut self, index: usize) -> i32 {
        if index == 0 {
            return 1;
        }
        self.holes = self.holes.saturating_add(1);
        self.holes.saturating_add(1)
    }
}

fn features(json: GeoJson) -> Vec<Feature> {
    match json {
        GeoJson::FeatureCollection(collection) => collection.features,
        GeoJson::Feature(feature) => vec![feature],
        GeoJson::Geometry(geometry) => vec![geometry.into()],
    }
}

/// The labels of the rings, as far as a feature says them.
fn boundary(feature: &Feature) -> Vec<i32> {
    match feature.property("boundary").and_then(serde_json::Value::as_array) {
        Some(list) => list.iter().map_while(label).collect(),
        None => integer(feature, "boundary").into_iter().collect(),
    }
}

/// A property that is an integer of 32 bits, written as `3` or `3.0`.
fn integer(feature: &Feature, key: &str) -> Option<i32> {
    label(feature.property(key)?)
}

fn label(value: &serde_json::Value) -> Option<i32> {
    let value = value.as_f64()?;
    let is_integer = value.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&value);
    is_integer.then_some(value as i32)
}

/// The positions of a ring without the closing one.
fn read_ring(ring: &[Position], place: &str) -> Result<Vec<Point>> {
    if ring.len() < 4 {
        let what = format!("a ring of {} positions", ring.len());
        let first = ring.first().map_or(String::new(), |p| format!(", position 1 {:?}", p.as_slice()));
        let help = "a ring has at least four positions, the last equal to the first; fix it, or remove it";
        return Err(Error::domain(what, format!("{place}{first}"), help));
    }
    let mut points = Vec::with_capacity(ring.len());
    for (index, position) in ring.iter().enumerate() {
        points.push(read_position(position, || format!("{place}, position {}", index + 1))?);
    }
    let last = points.len() - 1;
    if points[0] != points[last] {
        let what = format!("a ring is not closed: its last position differs from its first {}", points[0]);
        let place = format!("{place}, position {} {}", last + 1, points[last]);
        return Err(Error::domain(what, place, "append the first position to the ring once more"));
    }
    points.truncate(last);
    Ok(points)
}

fn read_position(position: &Position, place: impl Fn() -> String) -> Result<Point> {
    let &[x, y, ..] = position.as_slice() else {
        let what = format!("a position has {} coordinates, not 2", position.len());
        let place = format!("{} {:?}", place(), position.as_slice());
        return Err(Error::domain(what, place, "give each position as [x, y]"));
    };
    let point = Point::new(x, y);
    if point.is_finite() {
        return Ok(point);
    }
    Err(Error::domain("a coordinate is not finite", format!("{} {point}", place()), "remove or correct the position"))
}

/// The last line, where what is missing would be.
fn end_of(text: &str, place: &str) -> String {
    format!("{place}:{}", text.lines().count().max(1))
}

fn malformed(error: &::geojson::Error, text: &str, place: &str) -> Error {
    let place = match error {
        ::geojson::Error::MalformedGeoJson(json) if json.line() > 0 => format!("{place}:{}", json.line()),
        _ => end_of(text, place),
    };
    let help = "give GeoJSON (RFC 7946) with finite numbers; polygons are lists of rings of [x, y]";
    Error::parse(place, error.to_string(), help)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "[[0,0],[4,0],[4,4],[0,4],[0,0]]";
    const HOLE: &str = "[[1,1,9],[1,2,9],[2,2,9],[1,1,9]]";

    fn polygon(rings: &str) -> String {
        format!(r#"{{"type":"Polygon","coordinates":[{rings}]}}"#)
    }

    fn feature(properties: &str, geometry: &str) -> String {
        format!(r#"{{"type":"Feature","properties":{properties},"geometry":{geometry}}}"#)
    }

    fn collection(features: &[String]) -> String {
        format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","))
    }

    fn labels(text: &str) -> Vec<(i32, Vec<i32>)> {
        let polygons = read(text, "a.geojson").unwrap().polygons;
        polygons.iter().map(|p| (p.region, p.rings.iter().map(|r| r.label).collect())).collect()
    }

    #[test]
    fn a_geometry_with_a_hole() {
        let read = read(&polygon(&format!("{SQUARE},{HOLE}")), "a.geojson").unwrap();
        let [polygon] = &read.polygons[..] else { panic!("{read:?}") };
        assert_eq!(polygon.rings[0].points.len(), 4);
        assert_eq!(polygon.rings[1].points, [Point::new(1.0, 1.0), Point::new(1.0, 2.0), Point::new(2.0, 2.0)]);
        assert_eq!((polygon.region, polygon.rings[0].label, polygon.rings[1].label), (1, 1, 2));
    }

    #[test]
    fn labels_come_from_properties_or_count() {
        let plain = polygon(&format!("{SQUARE},{HOLE}"));
        let multi = format!(r#"{{"type":"MultiPolygon","coordinates":[[{SQUARE}],[{SQUARE},{HOLE}]]}}"#);
        let nested = format!(r#"{{"type":"GeometryCollection","geometries":[{plain}]}}"#);
        let text = collection(&[
            feature(r#"{"ref":"x","label":7,"id":8}"#, &plain),
            feature("null", "null"),
            feature(r#"{"region":2.5,"boundary":-3}"#, &multi),
            feature(r#"{"region":5.0,"ref":1}"#, &nested),
        ]);
        let expected = [(7, vec![1, 2]), (3, vec![-3]), (3, vec![-3, -3]), (5, vec![1, 3])];
        assert_eq!(labels(&text), expected);
        assert_eq!(labels(&feature("{}", &plain)), [(1, vec![1, 2])]);
    }

    #[test]
    fn errors_name_feature_ring_and_position() {
        for (rings, expected) in [
            (
                "[[0,0],[1,0],[1,1],[0,1]]".into(),
                "not closed: its last position differs from its first (0, 0) at a.geojson, feature 1, polygon 1, ring 1, position 4 (0, 1)",
            ),
            (
                format!("{SQUARE},[[1,1],[2,2],[1,1]]"),
                "a ring of 3 positions at a.geojson, feature 1, polygon 1, ring 2, position 1 [1.0, 1.0]",
            ),
            (format!("{SQUARE},[]"), "a ring of 0 positions at a.geojson, feature 1, polygon 1, ring 2"),
            (String::new(), "a polygon without rings at a.geojson, feature 1, polygon 1"),
            (
                "[[0,0],[1],[1,0],[0,1],[0,0]]".into(),
                "a position has 1 coordinates, not 2 at a.geojson, feature 1, polygon 1, ring 1, position 2 [1.0]",
            ),
        ] {
            let error = read(&feature("{}", &polygon(&rings)), "a.geojson").unwrap_err();
            assert!(matches!(error, Error::Domain { .. }) && error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn other_texts_are_refused() {
        let point = feature("{}", r#"{"type":"Point","coordinates":[0,0]}"#);
        for (text, expected) in [
            (collection(&[feature("{}", &polygon(SQUARE)), point]), "a.geojson, feature 2: a Point where a Polygon"),
            (collection(&[]), "a.geojson:1: the file holds no polygon"),
            ("{\n\"type\": 3}".into(), "a.geojson:2: "),
            ("[1, 2".into(), "a.geojson:1: "),
            (polygon("[[0,0],[1,1e999],[1,1],[0,0]]"), "number out of range"),
            (polygon("[[0,0],[1,NaN],[1,1],[0,0]]"), "a.geojson:1: "),
        ] {
            let error = read(&text, "a.geojson").unwrap_err();
            assert!(matches!(error, Error::Parse { .. }) && error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}

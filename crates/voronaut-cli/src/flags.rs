//! Parameters by the names that users type. The libraries call them by their own, in backquotes: `canvas_size`, `mesher=voronoi`.

/// Those that the libraries speak of.
pub(crate) const PARAMETERS: [&str; 31] = [
    "a_max",
    "background",
    "boundary",
    "canvas",
    "canvas_size",
    "centroid",
    "certify",
    "dual",
    "field",
    "fit",
    "geodesic",
    "gradation",
    "h_max",
    "h_min",
    "hausd",
    "linear_tensors",
    "memory_limit",
    "mesher",
    "net",
    "norm",
    "order",
    "periodic",
    "picking_radius",
    "polish",
    "protection",
    "recovery",
    "repair",
    "seeding",
    "smooth_metric",
    "tensor_order",
    "vertices",
];

/// The text with each of these as its flag: `--canvas-size`, `--mesher voronoi`. Other words in backquotes stay as they are.
pub fn flagged(text: &str) -> String {
    let mut out = String::new();
    for (i, part) in text.split('`').enumerate() {
        let (name, value) = part.split_once('=').map_or((part, None), |(name, value)| (name, Some(value)));
        let flag = name.replace('_', "-");
        match value {
            _ if i % 2 == 0 => out.push_str(part),
            _ if !PARAMETERS.contains(&name) => out.extend(["`", part, "`"]),
            Some(value) => out.extend(["--", &flag, " ", value]),
            None => out.extend(["--", &flag]),
        }
    }
    out
}

/// The text with flags as keywords: `--canvas-size` becomes `canvas_size`.
pub fn as_keywords(text: &str) -> String {
    let mut parts = text.split("--");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_lowercase() && c != '-').unwrap_or(part.len());
        out.extend([&part[..end].replace('-', "_"), &part[end..]]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_are_keywords() {
        assert_eq!(as_keywords("raise --memory-limit, or ask (--h-min <H>)"), "raise memory_limit, or ask (h_min <H>)");
    }

    #[test]
    fn parameters_are_flags_and_other_words_stay() {
        let text = "raise `canvas_size`, or use `mesher=voronoi`; `x` is no value of `canvas_sizes`";
        assert_eq!(flagged(text), "raise --canvas-size, or use --mesher voronoi; `x` is no value of `canvas_sizes`");
    }
}

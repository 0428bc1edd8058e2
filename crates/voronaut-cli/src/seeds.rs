//! Seeds given in a file: faults are named by their line.

use std::collections::HashMap;
use std::path::Path;
use voronaut::canvas::Canvas;
use voronaut::domain::read_text;
use voronaut::formats::points;
use voronaut::geometry::Point;
use voronaut::{Error, Result};

/// The seeds of a file, in order.
pub(crate) struct SeedFile {
    pub(crate) seeds: Vec<Point>,
    /// The line of each, from 1.
    lines: Vec<usize>,
    name: String,
}

impl SeedFile {
    /// Reads one seed or more, no two at the same place.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let (text, name) = (read_text(path)?, path.display().to_string());
        let (seeds, lines) = (points::read(&text, &name)?, points::lines(&text));
        if seeds.is_empty() {
            return Err(Error::parse(
                name,
                "there is no seed in it",
                "write two numbers, x y, on a line for each seed",
            ));
        }
        let file = Self { seeds, lines, name };
        file.demand_distinct()?;
        Ok(file)
    }

    fn demand_distinct(&self) -> Result<()> {
        let mut first: HashMap<[u64; 2], usize> = HashMap::new();
        for (i, p) in self.seeds.iter().enumerate() {
            // Adding zero makes one zero of both.
            let earlier = *first.entry([p.x + 0.0, p.y + 0.0].map(f64::to_bits)).or_insert(i);
            if earlier != i {
                let what = format!("the seed {p} is that of line {}", self.lines[earlier]);
                return Err(Error::parse(
                    self.place(i),
                    what,
                    "remove one of the two: each seed has a cell of its own",
                ));
            }
        }
        Ok(())
    }

    /// Refuses seeds outside the domain of a canvas.
    pub(crate) fn demand_inside(&self, canvas: &Canvas) -> Result<()> {
        let Some(i) = canvas.locate_all(&self.seeds).iter().position(Option::is_none) else { return Ok(()) };
        let what = format!("the seed {} is outside the domain", self.seeds[i]);
        Err(Error::parse(self.place(i), what, "remove it, or move it into the domain"))
    }

    fn place(&self, i: usize) -> String {
        format!("{}:{}", self.name, self.lines[i])
    }
}

//! Seeds given in a file: faults are named by their line.

use std::collections::HashMap;
use std::path::Path;
use voronaut::canvas::Canvas;
use voronaut::geometry::{Point, Point3};
use voronaut::surface::{Input, Place};
use voronaut::{Error, Result};
use voronaut_io::{points, read_text};

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
        let file = Self { seeds, lines, name };
        file.demand_some("two numbers, x y,")?;
        file.demand_distinct(file.seeds.iter().map(|p| [p.x, p.y]))?;
        Ok(file)
    }

    /// Reads one seed in space or more, no two at the same place; the file has no seeds of the plane then.
    pub(crate) fn read_in_space(path: &Path) -> Result<(Self, Vec<Point3>)> {
        let (text, name) = (read_text(path)?, path.display().to_string());
        let (seeds, lines) = (points::read_in_space(&text, &name)?, points::lines(&text));
        let file = Self { seeds: Vec::new(), lines, name };
        file.demand_some("three numbers, x y z,")?;
        file.demand_distinct(seeds.iter().map(|p| p.to_array()))?;
        Ok((file, seeds))
    }

    /// The places of seeds on a surface.
    pub(crate) fn on_surface(&self, input: &Input, seeds: &[Point3]) -> Result<Vec<Place>> {
        let place = |(i, &p): (usize, &Point3)| {
            input.closest(p).map_err(|error| {
                let what = format!("the seed {p} is off the surface");
                Error::parse(self.place(i), what, error.help())
            })
        };
        seeds.iter().enumerate().map(place).collect()
    }

    fn demand_some(&self, numbers: &str) -> Result<()> {
        if !self.lines.is_empty() {
            return Ok(());
        }
        let help = format!("write {numbers} on a line for each seed");
        Err(Error::parse(self.name.clone(), "there is no seed in it", help))
    }

    fn demand_distinct<const N: usize>(&self, seeds: impl Iterator<Item = [f64; N]>) -> Result<()> {
        let mut first: HashMap<[u64; N], usize> = HashMap::new();
        for (i, p) in seeds.enumerate() {
            // Adding zero makes one zero of both.
            let earlier = *first.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(i);
            if earlier != i {
                let shown: Vec<String> = p.iter().map(f64::to_string).collect();
                let what = format!("the seed ({}) is that of line {}", shown.join(", "), self.lines[earlier]);
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

//! Seeds given in a file: faults are named by their line.

use std::collections::HashMap;
use std::path::Path;
use voronaut::canvas::Canvas;
use voronaut::geometry::{Point, Point3};
use voronaut::surface::{Input, Place};
use voronaut::{Error, Result};
use voronaut_io::{points, read_text};

/// The seeds of a file, in order: points of the plane or of space.
pub(crate) struct SeedFile<P> {
    pub(crate) seeds: Vec<P>,
    /// The line of each, from 1.
    lines: Vec<usize>,
    name: String,
}

impl SeedFile<Point> {
    /// Reads one seed or more, no two at the same place.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        Self::checked(path, points::read, "two numbers, x y,", |p| [p.x, p.y])
    }

    /// Refuses seeds outside the domain of a canvas.
    pub(crate) fn demand_inside(&self, canvas: &Canvas) -> Result<()> {
        let Some(i) = canvas.locate_all(&self.seeds).iter().position(Option::is_none) else { return Ok(()) };
        let what = format!("the seed {} is outside the domain", self.seeds[i]);
        Err(Error::parse(self.place(i), what, "remove it, or move it into the domain"))
    }
}

impl SeedFile<Point3> {
    /// Reads one seed in space or more, no two at the same place.
    pub(crate) fn read_in_space(path: &Path) -> Result<Self> {
        Self::checked(path, points::read_in_space, "three numbers, x y z,", |p| p.to_array())
    }

    /// The places of the seeds on a surface.
    pub(crate) fn on_surface(&self, input: &Input) -> Result<Vec<Place>> {
        let place = |(i, &p): (usize, &Point3)| {
            input.closest(p).map_err(|error| {
                let what = format!("the seed {p} is off the surface");
                Error::parse(self.place(i), what, error.help())
            })
        };
        self.seeds.iter().enumerate().map(place).collect()
    }
}

impl<P> SeedFile<P> {
    fn checked<const N: usize>(
        path: &Path,
        read: impl Fn(&str, &str) -> Result<Vec<P>>,
        numbers: &str,
        coordinates: impl Fn(&P) -> [f64; N],
    ) -> Result<Self> {
        let (text, name) = (read_text(path)?, path.display().to_string());
        let file = Self { seeds: read(&text, &name)?, lines: points::lines(&text), name };
        if file.seeds.is_empty() {
            let help = format!("write {numbers} on a line for each seed");
            return Err(Error::parse(file.name, "there is no seed in it", help));
        }
        let mut first: HashMap<[u64; N], usize> = HashMap::new();
        for (i, p) in file.seeds.iter().map(coordinates).enumerate() {
            // Adding zero makes one zero of both.
            let earlier = *first.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(i);
            if earlier != i {
                let what = format!(
                    "the seed ({}) is that of line {}",
                    p.map(|x| x.to_string()).join(", "),
                    file.lines[earlier]
                );
                return Err(Error::parse(
                    file.place(i),
                    what,
                    "remove one of the two: each seed has a cell of its own",
                ));
            }
        }
        Ok(file)
    }

    fn place(&self, i: usize) -> String {
        format!("{}:{}", self.name, self.lines[i])
    }
}

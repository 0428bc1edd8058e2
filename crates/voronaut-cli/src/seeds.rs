//! Seeds given in a file: faults are named by their line.

use std::collections::HashMap;
use voronaut::canvas::Canvas;
use voronaut::geometry::{Point, Point3};
use voronaut::manifold::{Manifold, Place};
use voronaut::{Error, Result};

/// Seeds as they are given, and where each is, for messages: its line in a file, or its row in an array.
pub(crate) struct SeedRows<const N: usize> {
    /// The file's or the argument's.
    pub(crate) name: String,
    /// `:` of lines, `, row ` of rows.
    pub(crate) before_number: &'static str,
    pub(crate) rows: Vec<(usize, [f64; N])>,
}

/// The seeds of a file, in order: points of the plane or of space.
pub(crate) struct SeedFile<P> {
    pub(crate) seeds: Vec<P>,
    /// The line of each, from 1.
    lines: Vec<usize>,
    /// What stands before it.
    name: String,
}

impl SeedFile<Point> {
    /// One seed or more, no two at the same place.
    pub(crate) fn of_points(rows: SeedRows<2>) -> Result<Self> {
        Self::checked(rows, "two numbers, x y,", |[x, y]| Point::new(x, y))
    }

    /// Refuses seeds outside the domain of a canvas.
    pub(crate) fn demand_inside(&self, canvas: &Canvas) -> Result<()> {
        let Some(i) = canvas.first_outside(&self.seeds) else { return Ok(()) };
        let what = format!("the seed {} is outside the domain", self.seeds[i]);
        Err(Error::parse(self.place(i), what, "remove it, or move it into the domain"))
    }
}

impl SeedFile<Point3> {
    /// One seed in space or more, no two at the same place.
    pub(crate) fn of_places(rows: SeedRows<3>) -> Result<Self> {
        Self::checked(rows, "three numbers, x y z,", |p: [f64; 3]| p.into())
    }

    /// The places of the seeds on a surface.
    pub(crate) fn on_surface(&self, input: &Manifold) -> Result<Vec<Place>> {
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
    fn checked<const N: usize>(given: SeedRows<N>, numbers: &str, point: impl Fn([f64; N]) -> P) -> Result<Self> {
        let SeedRows { name, before_number, rows } = given;
        if rows.is_empty() {
            let help = format!("write {numbers} for each seed, on a line of its own");
            return Err(Error::parse(name, "there is no seed in it", help));
        }
        let mut first: HashMap<[u64; N], usize> = HashMap::new();
        for &(line, p) in &rows {
            // Adding zero makes one zero of both.
            let earlier = *first.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(line);
            if earlier != line {
                let what = format!(
                    "the seed ({}) is that of {} {earlier}",
                    p.map(|x| x.to_string()).join(", "),
                    if before_number == ":" { "line" } else { "row" }
                );
                let help = "remove one of the two: each seed has a cell of its own";
                return Err(Error::parse(format!("{name}{before_number}{line}"), what, help));
            }
        }
        let (lines, seeds) = rows.into_iter().map(|(line, p)| (line, point(p))).unzip();
        Ok(Self { seeds, lines, name: name + before_number })
    }

    fn place(&self, i: usize) -> String {
        format!("{}{}", self.name, self.lines[i])
    }
}

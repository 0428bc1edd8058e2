//! Where questions are answered.

use crate::answer::{Answer, Fault};
use crate::files;
use crate::request::Request;
use crate::watch::{Watch, Window};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::RepairOptions;
use voronaut::mesh::Mesh;
use voronaut::{Error, Result};
use voronaut_cli::{Held, Job, Made};
use voronaut_io::{Fields, Format, Given};

/// What is kept between questions: files, and the last mesh.
#[derive(Default)]
pub struct Desk {
    files: HashMap<String, Vec<u8>>,
    mesh: Option<Mesh>,
}

impl Desk {
    /// Answers a question: the length of a JSON text in four bytes, the text, and the bytes of a file. The answer is of the same form.
    pub fn asked(&mut self, question: &[u8], window: &dyn Window) -> Vec<u8> {
        let answer = self.answered(question, window);
        answer.unwrap_or_else(|fault| Answer::of_fault(&fault)).packed()
    }

    fn answered(&mut self, question: &[u8], window: &dyn Window) -> std::result::Result<Answer, Fault> {
        let wrong = |what: String| Error::parse("question", what, "this is a fault of the page");
        let (length, rest) = question.split_first_chunk().ok_or_else(|| wrong("no length".into()))?;
        let length = u32::from_le_bytes(*length) as usize;
        let (text, bytes) = rest.split_at_checked(length).ok_or_else(|| wrong("cut off".into()))?;
        match serde_json::from_slice(text).map_err(|error| wrong(error.to_string()))? {
            Request::Hold { name } => {
                files::hold(&mut Held::default(), &name, bytes)?;
                self.files.insert(name, bytes.to_vec());
                Ok(Answer::new(json!({})))
            }
            Request::Look { domain } => Ok(self.look(&domain)?),
            Request::Perform { command, options, seeds } => self.perform(&command, &options, seeds, window),
            Request::Write { name } => Ok(self.written(&name)?),
        }
    }

    /// What is held of the files that words name.
    fn held<'w>(&self, words: impl IntoIterator<Item = &'w String>) -> Result<Held> {
        let mut held = Held { keeps_pages: true, ..Held::default() };
        for word in words {
            if let Some(bytes) = self.files.get(word) {
                files::hold(&mut held, word, bytes)?;
            }
        }
        Ok(held)
    }

    fn look(&self, domain: &String) -> Result<Answer> {
        let held = self.held([domain])?;
        Ok(match held.given(domain, RepairOptions::default())?.0 {
            Given::Plane(domain) => outline(&domain),
            Given::Surface(input) => triangles(&input),
        })
    }

    fn perform(
        &mut self,
        command: &str,
        options: &[(String, Vec<String>)],
        seeds: Vec<Vec<f64>>,
        window: &dyn Window,
    ) -> std::result::Result<Answer, Fault> {
        let job = Job::new(command, options).map_err(Fault::Usage)?;
        let mut held = self.held(options.iter().flat_map(|(_, values)| values))?;
        held.seeds.insert("seeds".into(), seeds);
        let Made { mesh, canvas, page, report, warnings, .. } = job.perform(held, &Watch::new(window))?;
        let report: Value = report.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        let path = canvas.filter(|_| command == "distance").map(|(canvas, _)| path_on(&canvas, &report));
        let mut answer = Answer::new(json!({ "report": report, "warnings": warnings }));
        if let Some(page) = page {
            answer = answer.with("page", page.as_bytes());
        }
        if let Some(path) = path {
            answer = answer.with_points("path", &path);
        }
        if let Some(mesh) = mesh {
            answer = answer
                .with_points("points", &mesh.points)
                .with_numbers("triangles", mesh.triangles.as_flattened().iter().copied());
            self.mesh = Some(mesh).filter(|_| command == "mesh").or(self.mesh.take());
        }
        Ok(answer)
    }

    fn written(&self, name: &str) -> Result<Answer> {
        let format = Format::from_path(Path::new(name))?;
        let Some(mesh) = &self.mesh else {
            return Err(Error::parse(name, "there is no mesh yet", "make one"));
        };
        let mut bytes = Vec::new();
        format.write(mesh, &Fields::default(), &mut bytes).map_err(|error| Error::io(name, error))?;
        Ok(Answer::new(json!({})).with("file", &bytes))
    }
}

/// The curves of a planar domain.
fn outline(domain: &Domain) -> Answer {
    let pslg = domain.pslg();
    let points: Vec<[f64; 3]> = pslg.points.iter().map(|p| [p.x, p.y, 0.0]).collect();
    let ends = pslg.segments.iter().flat_map(|segment| segment.ends);
    Answer::new(json!({ "planar": true })).with_points("points", &points).with_numbers("segments", ends)
}

fn triangles(surface: &Manifold) -> Answer {
    let mesh = surface.whole_mesh();
    let numbers = mesh.triangles.as_flattened().iter().copied();
    Answer::new(json!({ "planar": false })).with_points("points", &mesh.points).with_numbers("triangles", numbers)
}

/// The ends of all segments of a path, whose points come behind those of a canvas.
fn path_on(canvas: &Mesh, report: &Value) -> Vec<[f64; 3]> {
    let first = report["canvas"]["vertices"].as_u64().unwrap_or(u64::MAX);
    let of_path = canvas.edges.iter().filter(|ends| ends.iter().all(|&v| u64::from(v) >= first));
    of_path.flat_map(|ends| ends.map(|v| canvas.points[v as usize])).collect()
}

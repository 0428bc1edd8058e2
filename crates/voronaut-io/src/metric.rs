//! Metrics as users write them: named, or values in a file, in whichever order a program writes the entries of a tensor.

use super::files::ending;
use super::files::read_solution;
use super::{Format, read};
use std::path::{Path, PathBuf};
use voronaut::geometry::{Aabb, Tensor, Tensor3};
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::metric::{Spec, SurfaceMetric};
use voronaut::mesh::{Mesh, Solution, SolutionValues, TensorOrder};
use voronaut::metric::MetricSpec;
use voronaut::recipe::{self, GradedAt, MetricOptions, Origin, PlanarMetric, SurfaceSource};
use voronaut::{Error, Result};

/// Where the metric of a planar domain comes from.
#[derive(Clone, Debug)]
pub enum MetricSource {
    /// A name with parameters, or a formula.
    Named(MetricSpec),
    /// `FILE.sol`, `FILE.solb`: tensors or sizes at the vertices of a mesh.
    File(PathBuf),
    /// `hessian:FILE.sol`: the optimal metric of a solution, one number per vertex of a mesh.
    Hessian(PathBuf),
}

impl MetricSource {
    /// Reads a METRIC text; parameters are checked, files are not opened.
    ///
    /// # Errors
    /// As of [`MetricSpec::parse`].
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        match text.strip_prefix("hessian:") {
            Some(file) if is_solution(file) => Ok(Self::Hessian(file.into())),
            None if is_solution(text) => Ok(Self::File(text.into())),
            _ => Ok(Self::Named(MetricSpec::parse(text)?)),
        }
    }
}

/// What the metric that a text names is made of, in the plane or on a surface; of a text that names none, whatever.
pub fn metric_origin(text: &str) -> Origin {
    match text.trim().strip_prefix("hessian:") {
        None => Origin::Sizes,
        Some(file) if is_solution(file) => Origin::Values,
        Some(_) => Origin::Function,
    }
}

/// What the values of a metric's file are read by.
#[derive(Clone, Copy, Debug, Default)]
pub struct MetricFiles<'a> {
    /// The file that the domain comes from, whose mesh has the values unless there is a background.
    pub own: Option<&'a Path>,
    /// The mesh that the values belong to.
    pub background: Option<&'a Path>,
    /// The order of the entries of tensors.
    pub order: TensorOrder,
}

impl MetricFiles<'_> {
    /// The metric of a domain; `at` is the multiple in which edges are to have length one, for gradation.
    ///
    /// # Errors
    /// As of [`recipe::metric`]; a file is missing or not what it should be; a background mesh does not cover the domain, or has no
    /// values.
    pub fn metric(
        &self,
        source: &MetricSource,
        domain: &Domain,
        options: &MetricOptions,
        at: GradedAt,
    ) -> Result<PlanarMetric> {
        match (source, self.background) {
            (MetricSource::Named(spec), None) => {
                demand_default(self.order)?;
                recipe::metric(spec, domain.planar(), options, at)
            }
            (MetricSource::Named(_), Some(mesh)) => {
                let what = "only a .sol metric is given on a background mesh";
                Err(Error::parse(format!("background {}", mesh.display()), what, "leave the background out"))
            }
            (MetricSource::File(path), _) => {
                let (values, mesh) = self.read(path, domain)?;
                recipe::metric_of_values(&mesh, &values, &path.display().to_string(), domain.planar(), options, at)
            }
            (MetricSource::Hessian(path), _) => {
                let (values, mesh) = self.read(path, domain)?;
                if !matches!(values, SolutionValues::Scalar(_)) {
                    let help = "give one number (type 1) per vertex";
                    return Err(Error::parse(path.display().to_string(), "the values are no scalars", help));
                }
                recipe::metric_of_solution(&mesh, &values, domain.planar(), options, at)
            }
        }
    }

    fn read(&self, path: &Path, domain: &Domain) -> Result<(SolutionValues, Mesh)> {
        let values = read_metric(path, self.order)?.values;
        let is_mesh = |p: &&Path| Format::of_ending(p).is_some_and(Format::may_be_planar);
        let Some(file) = self.background.or(self.own).filter(is_mesh) else {
            let help = "name the mesh that the values belong to: `background=FILE.mesh`";
            return Err(Error::parse(path.display().to_string(), "a .sol file needs a .mesh it belongs to", help));
        };
        let mesh = read(file)?.mesh;
        demand_cover(&mesh, file, domain)?;
        Ok((values, mesh))
    }
}

/// The metric on a surface that a text names ([`Spec::parse`], `FILE.sol` with a value per vertex of the surface's file, or
/// `hessian:FILE.sol` with a number); `at` is the multiple in which edges are to have length one.
///
/// # Errors
/// As of [`Spec::parse`] and [`recipe::metric_on_surface`]; a file is missing or not what it should be.
pub fn surface_metric(
    text: &str,
    input: &Manifold,
    options: &MetricOptions,
    order: TensorOrder,
    at: GradedAt,
) -> Result<Box<dyn SurfaceMetric>> {
    let text = text.trim();
    let made = |source| recipe::metric_on_surface(source, input, options, at);
    if is_solution(text) {
        return made(SurfaceSource::Values(&read_metric(Path::new(text), order)?));
    }
    demand_default(order)?;
    match text.strip_prefix("hessian:") {
        Some(file) if is_solution(file) => match &read_solution(Path::new(file))?.values {
            SolutionValues::Scalar(values) => made(SurfaceSource::Function(values)),
            _ => Err(Error::parse(file, "the values are no scalars", "give one number (type 1) per vertex")),
        },
        _ => made(SurfaceSource::Named(&Spec::parse(text)?)),
    }
}

/// Refuses an order of entries where no file has any.
fn demand_default(order: TensorOrder) -> Result<()> {
    if order == TensorOrder::default() {
        return Ok(());
    }
    Err(Error::unsupported("`tensor_order` with a metric that is not of a file", "leave out `tensor_order`"))
}

/// Reads the sizes or tensors of a `.sol` or `.solb` file, whose tensors are in the order given, as a solution in the order on disk.
///
/// # Errors
/// As of [`open`](super::open) and [`sol::read`](super::sol::read). [`Error::Metric`] of tensors that are not positive definite, where all are in another order: the file is
/// then surely in that. Other tensors that are no metric are left to who samples them.
pub fn read_metric(path: &Path, order: TensorOrder) -> Result<Solution> {
    let Solution { dimension, values } = read_solution(path)?;
    let values = values.from_order(order);
    demand_order(&values, order, &path.display().to_string())?;
    Ok(Solution { dimension, values })
}

fn is_solution(text: &str) -> bool {
    matches!(ending(Path::new(text)).as_deref(), Some("sol" | "solb"))
}

/// How far a domain may reach beyond its background mesh, as a share of the mesh's extent: curves are meshed by chords.
const OVERHANG: f64 = 0.05;

/// Beyond its mesh a sampled field goes on with the nearest value: right for a sliver along a curved boundary, a
/// mistake anywhere else.
fn demand_cover(background: &Mesh, file: &Path, domain: &Domain) -> Result<()> {
    let Some(cover) = Aabb::of((0..background.points.len() as u32).map(|v| background.point(v))) else { return Ok(()) };
    let (bounds, allowed) = (domain.bounds(), cover.extent() * OVERHANG);
    let (lower, upper) = (cover.min - bounds.min, bounds.max - cover.max);
    if lower.x.max(upper.x) <= allowed.x && lower.y.max(upper.y) <= allowed.y {
        return Ok(());
    }
    let what = format!("the domain ({} to {}) reaches beyond the background mesh", bounds.min, bounds.max);
    let place = format!("{} ({} to {})", file.display(), cover.min, cover.max);
    Err(Error::metric(what, place, "give the mesh on which the values were computed, in the coordinates of the domain"))
}

/// Looks for another order if tensors, read in the order given, are no metric.
fn demand_order(values: &SolutionValues, order: TensorOrder, place: &str) -> Result<()> {
    let Some(bad) = first_indefinite(values) else { return Ok(()) };
    let raw = values.clone().to_order(order);
    let mut others = TensorOrder::ALL.into_iter().filter(|&other| other != order);
    let Some(fitting) = others.find(|&other| first_indefinite(&raw.clone().from_order(other)).is_none()) else {
        return Ok(());
    };
    let entries = |order: TensorOrder| order.entries(matches!(values, SolutionValues::Tensor3(_)));
    let (read, meant) = (entries(order), entries(fitting));
    let what = format!("the tensor is not positive definite in the order {read}, and all are in the order {meant}");
    let help = format!("the file seems to be in that order: say so (`tensor_order={fitting}`), or write it as {read}");
    Err(Error::metric(what, format!("{place}, entry {}", bad + 1), help))
}

fn first_indefinite(values: &SolutionValues) -> Option<usize> {
    match values {
        SolutionValues::Tensor(entries) => {
            entries.iter().position(|&[xx, xy, yy]| !Tensor::new(xx, xy, yy).is_positive_definite())
        }
        SolutionValues::Tensor3(entries) => {
            entries.iter().position(|&entry| !Tensor3::from_disk(entry).is_positive_definite())
        }
        SolutionValues::Scalar(_) | SolutionValues::Vector { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::io::Write;
    use voronaut::geometry::TangentPlane;
    use voronaut::triangulation::VertexId;

    fn tensors() -> impl Strategy<Value = Vec<Tensor3>> {
        let factor = prop::array::uniform9(-1.0..1.0_f64);
        // G' G + 1/10: definite, of any direction.
        let tensor = factor.prop_map(|g| {
            let dot = |i: usize, j: usize| (0..3).map(|k| g[3 * k + i] * g[3 * k + j]).sum::<f64>();
            let [xx, xy, yy, xz, yz, zz] = [dot(0, 0), dot(0, 1), dot(1, 1), dot(0, 2), dot(1, 2), dot(2, 2)];
            Tensor3::from_disk([xx + 0.1, xy, yy + 0.1, xz, yz, zz + 0.1])
        });
        prop::collection::vec(tensor, 40)
    }

    proptest! {
        /// Forty tensors of any directions are never definite in a wrong order as well.
        #[test]
        fn a_wrong_order_is_found_out(tensors in tensors()) {
            let disk = SolutionValues::Tensor3(tensors.iter().map(|t| t.to_disk()).collect());
            for order in TensorOrder::ALL {
                let written = disk.clone().to_order(order);
                prop_assert_eq!(&written.clone().from_order(order), &disk);
                for read in TensorOrder::ALL {
                    let found = demand_order(&written.clone().from_order(read), read, "a.sol");
                    prop_assert_eq!(found.is_ok(), read == order, "{} as {}", order, read);
                }
            }
        }
    }

    #[test]
    fn files_are_known_by_their_ending() {
        for text in ["metric.sol", "a dir/swirl.SOL", "C:\\data\\m.sol", "../uniform.sol", "a.solb"] {
            let source = MetricSource::parse(text).unwrap();
            assert!(matches!(source, MetricSource::File(path) if path == Path::new(text)), "{text}");
        }
        let hessian = MetricSource::parse("hessian:u.sol").unwrap();
        assert!(matches!(hessian, MetricSource::Hessian(path) if path == Path::new("u.sol")));
        assert!(matches!(MetricSource::parse("hessian:x*y").unwrap(), MetricSource::Named(_)));
    }

    #[test]
    fn values_at_the_vertices_of_a_surface_are_its_metric() {
        let input = Manifold::shape("sphere:2", Some(0.5)).unwrap();
        let mut file = tempfile::Builder::new().suffix(".sol").tempfile().unwrap();
        let count = input.positions().len();
        let rows = "4 0 4 0 0 4\n".repeat(count);
        write!(file, "MeshVersionFormatted 2 Dimension 3 SolAtVertices {count} 1 3\n{rows}").unwrap();
        let path = file.path().to_str().unwrap();
        let field =
            surface_metric(path, &input, &MetricOptions::default(), TensorOrder::Disk, GradedAt::Scale(1.0)).unwrap();
        let place = input.place_of(VertexId(7)).unwrap();
        let m = TangentPlane::new(place.normal).restrict(field.at(&place));
        assert!((m.xx - 4.0).abs() + m.xy.abs() + (m.yy - 4.0).abs() < 1e-12, "{m:?}");
    }

    #[test]
    fn what_is_wrong_is_named_be_it_the_file_or_an_option() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let [mesh, sizes, vectors] = ["a.mesh", "sizes.sol", "vectors.sol"].map(|name| folder.path().join(name));
        let square =
            "MeshVersionFormatted 2 Dimension 2 Vertices 4 0 0 0 1 0 0 1 1 0 0 1 0 Triangles 2 1 2 3 1 1 3 4 1 End";
        std::fs::write(&mesh, square).unwrap();
        let head = "MeshVersionFormatted 2 Dimension 2 SolAtVertices 4 1";
        std::fs::write(&sizes, format!("{head} 1 1 1 1 1 End")).unwrap();
        std::fs::write(&vectors, format!("{head} 2 1 1 1 1 1 1 1 1 End")).unwrap();
        let files = MetricFiles { own: Some(&mesh), ..MetricFiles::default() };
        let told = |values: &Path, gradation| {
            let options = MetricOptions { gradation: Some(gradation), ..MetricOptions::default() };
            let made = files.metric(&MetricSource::File(values.into()), &domain, &options, GradedAt::Scale(1.0));
            made.map(|_| ()).unwrap_err().to_string()
        };
        assert!(told(&sizes, 0.5).starts_with("metric gradation: "), "{}", told(&sizes, 0.5));
        let place = vectors.display().to_string();
        assert!(told(&vectors, 1.3).starts_with(&place), "{}", told(&vectors, 1.3));
    }

    #[test]
    fn messages_name_entry_and_order() {
        let diagonal = SolutionValues::Tensor(vec![[1.0, 0.5, 0.6], [4.0, 9.0, 0.5]]);
        let error = demand_order(&diagonal, TensorOrder::Disk, "a.sol").unwrap_err();
        assert_eq!(
            error.to_string(),
            "invalid metric: the tensor is not positive definite in the order m11 m12 m22, and all are in the order \
             m11 m22 m12 at a.sol, entry 2"
        );
        assert!(error.help().contains("`tensor_order=diagonal`"), "{}", error.help());
        let never = SolutionValues::Tensor(vec![[1.0, -2.0, 1.0]]);
        assert!(demand_order(&never, TensorOrder::Disk, "a.sol").is_ok(), "left to who samples it");
    }
}

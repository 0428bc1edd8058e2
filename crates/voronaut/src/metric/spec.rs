//! The metric as a user writes it on the command line or in a recipe.

use super::{BoundarySizes, Expression, Formula, Shock, Swirl, SwirlField, Uniform, Variables};
use crate::error::{Error, Result};
use crate::geometry::Tensor;

/// What a METRIC text says. Parameters left out have the defaults of the field's own type.
#[derive(Clone, Debug)]
pub enum MetricSpec {
    /// `uniform` or `uniform:m11,m12,m22`.
    Uniform(Uniform),
    /// `swirl` or `swirl:nu=3,field=authors|printed`.
    Swirl(Swirl),
    /// `shock` or `shock:phi=10,lambda=0.6`.
    Shock(Shock),
    /// `formula:m11; m12; m22`.
    Formula(Formula),
    /// `boundary:h0=H,growth=1.2,aspect=1,h_max=inf`; only `h0` is required.
    Boundary(BoundarySizes),
    /// `hessian:EXPR`: of the second derivatives of a function of x and y.
    Hessian(Expression),
}

impl MetricSpec {
    /// Reads a METRIC text; parameters are checked.
    ///
    /// # Errors
    /// [`Error::Parse`] that names the part at fault; [`Error::Metric`] of a uniform tensor that is no metric;
    /// [`Error::Unsupported`] of `curvature`.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        let (name, parameters) = name_and_rest(text);
        match name {
            "uniform" => uniform(parameters),
            "swirl" => swirl(&Parameters::read("swirl", parameters, &["nu", "field"])?),
            "shock" => shock(&Parameters::read("shock", parameters, &["phi", "lambda"])?),
            "formula" => Ok(Self::Formula(Formula::planar(parameters.unwrap_or_default())?)),
            "boundary" => boundary(&Parameters::read("boundary", parameters, &["h0", "growth", "aspect", "h_max"])?),
            "curvature" => {
                Err(Error::unsupported("metric curvature", "it is for surfaces; in the plane use another metric"))
            }
            "hessian" => hessian(parameters.unwrap_or_default()),
            _ => Err(Error::parse("metric", format!("`{text}` is not a metric"), METRICS)),
        }
    }
}

/// What [`MetricSpec::parse`] understands, for help.
const METRICS: &str = "metrics: uniform, uniform:m11,m12,m22, swirl:nu=3,field=authors, shock:phi=10,lambda=0.6, \
                       'formula:m11; m12; m22', boundary:h0=0.01,growth=1.2,aspect=1,h_max=inf, FILE.sol, \
                       'hessian:EXPR', hessian:FILE.sol";

/// The name in front of a colon, and what is behind it.
pub(crate) fn name_and_rest(text: &str) -> (&str, Option<&str>) {
    text.split_once(':').map_or((text, None), |(name, rest)| (name, Some(rest)))
}

fn uniform(parameters: Option<&str>) -> Result<MetricSpec> {
    let Some(parameters) = parameters else {
        return Ok(MetricSpec::Uniform(Uniform::default()));
    };
    let entries: Vec<&str> = parameters.split(',').collect();
    let [m11, m12, m22] = entries[..] else {
        let what = format!("three entries were expected, not {}", entries.len());
        return Err(Error::parse("metric uniform", what, "write uniform:m11,m12,m22, or uniform for the identity"));
    };
    let entry = |key, value| number("metric uniform", key, value);
    let field = Uniform(Tensor::new(entry("m11", m11)?, entry("m12", m12)?, entry("m22", m22)?));
    field.check()?;
    Ok(MetricSpec::Uniform(field))
}

fn swirl(parameters: &Parameters) -> Result<MetricSpec> {
    let mut swirl = Swirl::default();
    parameters.set("nu", &mut swirl.nu)?;
    match parameters.get("field") {
        None => {}
        Some("authors") => swirl.field = SwirlField::Authors,
        Some("printed") => swirl.field = SwirlField::Printed,
        Some(other) => {
            let help = "write field=authors (the authors' code) or field=printed (the report)";
            return Err(Error::parse("metric swirl", format!("unknown field `{other}`"), help));
        }
    }
    swirl.check()?;
    Ok(MetricSpec::Swirl(swirl))
}

fn shock(parameters: &Parameters) -> Result<MetricSpec> {
    let mut shock = Shock::default();
    parameters.set("phi", &mut shock.phi)?;
    parameters.set("lambda", &mut shock.lambda)?;
    shock.check()?;
    Ok(MetricSpec::Shock(shock))
}

fn boundary(parameters: &Parameters) -> Result<MetricSpec> {
    let mut h0 = f64::NAN;
    parameters.set("h0", &mut h0)?;
    if parameters.get("h0").is_none() {
        let help = "give the size at the boundary, as in boundary:h0=0.01";
        return Err(Error::parse("metric boundary", "h0 is missing", help));
    }
    let mut sizes = BoundarySizes::from_h0(h0);
    parameters.set("growth", &mut sizes.growth)?;
    parameters.set("aspect", &mut sizes.aspect)?;
    parameters.set("h_max", &mut sizes.h_max)?;
    sizes.check()?;
    Ok(MetricSpec::Boundary(sizes))
}

fn hessian(text: &str) -> Result<MetricSpec> {
    Ok(MetricSpec::Hessian(Expression::named(text, Variables::Plane, "metric hessian")?))
}

fn number(place: &str, key: &str, value: &str) -> Result<f64> {
    let value = value.trim();
    value
        .parse()
        .map_err(|_| Error::parse(place, format!("{key} = `{value}` is not a number"), "write it as 0.5 or 2e-3"))
}

/// `key=value,key=value`, each key known and given once.
pub(crate) struct Parameters<'a> {
    place: String,
    pairs: Vec<(&'a str, &'a str)>,
}

impl<'a> Parameters<'a> {
    /// Reads the parameters of a metric.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is not key=value, of other keys, and of keys given twice.
    pub(crate) fn read(metric: &str, text: Option<&'a str>, keys: &[&str]) -> Result<Self> {
        let place = format!("metric {metric}");
        let mut pairs: Vec<(&str, &str)> = Vec::new();
        let help = format!("write {metric}:key=value,key=value with keys among {}", keys.join(", "));
        let error = |what: String| Err(Error::parse(&place, what, &help));
        for part in text.into_iter().flat_map(|text| text.split(',')) {
            let Some((key, value)) = part.split_once('=') else {
                return error(format!("`{}` is not key=value", part.trim()));
            };
            let (key, value) = (key.trim(), value.trim());
            if !keys.contains(&key) {
                return error(format!("unknown key `{key}`"));
            }
            if pairs.iter().any(|(known, _)| *known == key) {
                return error(format!("{key} is given twice"));
            }
            pairs.push((key, value));
        }
        Ok(Self { place, pairs })
    }

    /// The value of a key, if it is given.
    pub(crate) fn get(&self, key: &str) -> Option<&'a str> {
        self.pairs.iter().find(|(known, _)| *known == key).map(|(_, value)| *value)
    }

    /// Replaces a default by the number given, if one is.
    pub(crate) fn set(&self, key: &str, target: &mut f64) -> Result<()> {
        if let Some(value) = self.get(key) {
            *target = number(&self.place, key, value)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::metric::MetricField;

    fn parse(text: &str) -> MetricSpec {
        MetricSpec::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn uniform_metrics() {
        assert!(matches!(parse("uniform"), MetricSpec::Uniform(Uniform(Tensor::IDENTITY))));
        let MetricSpec::Uniform(Uniform(m)) = parse("uniform:4, -1,1e2") else { panic!() };
        assert_eq!(m, Tensor::new(4.0, -1.0, 100.0));
    }

    #[test]
    fn analytic_metrics_and_their_defaults() {
        let swirl = |text| match parse(text) {
            MetricSpec::Swirl(swirl) => swirl,
            other => panic!("{other:?}"),
        };
        assert_eq!(swirl("swirl"), Swirl { nu: 3.0, field: SwirlField::Authors });
        assert_eq!(swirl("swirl:field=printed, nu=-1"), Swirl { nu: -1.0, field: SwirlField::Printed });
        let shock = |text| match parse(text) {
            MetricSpec::Shock(shock) => shock,
            other => panic!("{other:?}"),
        };
        assert_eq!(shock("shock"), Shock { phi: 10.0, lambda: 0.6 });
        assert_eq!(shock(" shock:phi=1 "), Shock { phi: 1.0, lambda: 0.6 });
    }

    #[test]
    fn boundaries_and_their_defaults() {
        let sizes = |text| match parse(text) {
            MetricSpec::Boundary(sizes) => sizes,
            other => panic!("{other:?}"),
        };
        let default = BoundarySizes { h0: 0.5, growth: 1.2, aspect: 1.0, h_max: f64::INFINITY };
        assert_eq!(sizes("boundary:h0=0.5"), default);
        let all = BoundarySizes { h0: 1.0, growth: 1.5, aspect: 4.0, h_max: 30.0 };
        assert_eq!(sizes("boundary:h0=1,growth=1.5,aspect=4,h_max=30"), all);
        assert_eq!(sizes("boundary:h0=0.5,h_max=inf"), default);
    }

    #[test]
    fn formulas_keep_their_punctuation() {
        let MetricSpec::Formula(field) = parse("formula:max(1,x); 0; if(y<0,1,2)") else { panic!() };
        assert_eq!(field.at(Point::new(3.0, -1.0)), Tensor::new(3.0, 0.0, 1.0));
    }

    #[test]
    fn hessians_are_of_functions() {
        assert!(matches!(parse("hessian:tanh(40*(y-0.5))"), MetricSpec::Hessian(_)));
        let error = MetricSpec::parse("hessian:x + z").unwrap_err().to_string();
        assert!(error.starts_with("metric hessian, column 5: z is not a variable"), "{error}");
    }

    #[test]
    fn what_a_later_version_does_says_so() {
        for text in ["curvature", "curvature:norm=2", "formula:1;0;1;0;0;1"] {
            let error = MetricSpec::parse(text).unwrap_err();
            assert!(matches!(error, Error::Unsupported { .. }), "{text}: {error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn mistakes_are_named() {
        for (text, message, help) in [
            ("", "metric: `` is not a metric", "metrics: uniform"),
            ("swril", "metric: `swril` is not a metric", "FILE.sol"),
            ("metric.txt", "metric: `metric.txt` is not a metric", "boundary:h0="),
            ("uniform:1,2", "metric uniform: three entries were expected, not 2", "uniform:m11,m12,m22"),
            ("uniform:1,x,1", "metric uniform: m12 = `x` is not a number", "2e-3"),
            ("uniform:1,2,1", "invalid metric: the tensor m11 = 1, m12 = 2, m22 = 1 is not positive definite", "m12^2"),
            ("swirl:", "metric swirl: `` is not key=value", "keys among nu, field"),
            ("swirl:mu=3", "metric swirl: unknown key `mu`", "keys among nu, field"),
            ("swirl:nu=3,nu=4", "metric swirl: nu is given twice", "swirl:key=value"),
            ("swirl:nu", "metric swirl: `nu` is not key=value", "nu, field"),
            ("swirl:nu=", "metric swirl: nu = `` is not a number", "0.5"),
            ("swirl:nu=inf", "metric swirl: nu = inf", "nu must be finite"),
            ("swirl:field=theirs", "metric swirl: unknown field `theirs`", "field=printed"),
            ("shock:phi=-1", "metric shock: phi = -1", "at least 0"),
            ("shock:lambda=0", "metric shock: lambda = 0", "positive"),
            ("boundary", "metric boundary: h0 is missing", "boundary:h0=0.01"),
            ("boundary:growth=1.3", "metric boundary: h0 is missing", "boundary:h0=0.01"),
            ("boundary:h0=abc", "metric boundary: h0 = `abc` is not a number", "2e-3"),
            ("boundary:h0=1,growth=0.5", "metric boundary: growth = 0.5", "at least 1"),
            ("formula:1;0", "formula, column 4: three entries were expected, not 2", "m11; m12; m22"),
            ("formula", "formula, column 1: three entries were expected, not 1", "m11; m12; m22"),
        ] {
            let error = MetricSpec::parse(text).unwrap_err();
            assert!(error.to_string().starts_with(message), "{text}: {error}");
            assert!(error.help().contains(help), "{text}: {}", error.help());
        }
    }
}

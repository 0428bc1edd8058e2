//! From mmg's spellings to ours: `-hausd 0.1` is `--hausd 0.1`.

use std::ffi::OsString;
use voronaut::{Error, Result};

/// Options with names of several letters that mmg writes with one dash.
const WORDS: [&str; 24] = [
    "in", "out", "sol", "met", "ar", "nr", "hausd", "hmin", "hmax", "hsiz", "hgrad", "hgradreq", "nosizreq", "nosurf",
    "noinsert", "noswap", "nomove", "optim", "nreg", "xreg", "rmc", "opnbdy", "nofem", "keep-ref",
];

/// Ways of working that there are not here.
const MISSING: [&str; 7] = ["-ls", "-lssurf", "-lag", "-nsd", "-f", "-val", "-default"];

/// The command line with words of `remesh` as clap knows them; those of other subcommands stay as they are.
///
/// # Errors
/// [`Error::Unsupported`] of ways of working that there are not here.
pub(crate) fn translated(words: impl IntoIterator<Item = OsString>) -> Result<Vec<OsString>> {
    let words: Vec<OsString> = words.into_iter().collect();
    if words.get(1).is_none_or(|word| word != "remesh") {
        return Ok(words);
    }
    if let Some(word) = MISSING.into_iter().find(|missing| words.iter().any(|word| word == missing)) {
        let help =
            "leave it out: meshes are adapted as a whole, by one metric, without level sets or files of parameters";
        return Err(Error::unsupported(format!("remesh {word}"), help));
    }
    // To clap these were -h, which asks for help, and more.
    let is_help = |word: &&OsString| {
        let text = word.to_string_lossy();
        text.starts_with("-h") && text.len() > 2 && !WORDS.contains(&&text[1..])
    };
    if let Some(word) = words.iter().find(is_help) {
        let what = format!("{} is no option", word.display());
        return Err(Error::parse("remesh", what, "voronaut remesh --help lists the options: -hmin H, not -hmin=H"));
    }
    let mut result = words[..2].to_vec();
    let mut rest = words[2..].iter().peekable();
    while let Some(word) = rest.next() {
        let is_number = |word: &&&OsString| word.to_str().is_some_and(|text| text.parse::<f64>().is_ok());
        match word.to_str() {
            // mmg's level of verbosity is a number behind -v, or nothing.
            Some("-v") if rest.peek().is_some_and(|next| is_number(&next)) => result.push("--verbosity".into()),
            Some("-xreg" | "-rmc") if rest.peek().is_some_and(|next| is_number(&next)) => {
                result.push(format!("-{}", word.display()).into());
                result.extend(rest.next().cloned());
            }
            // Without its number: what follows is a file.
            Some("-xreg" | "-rmc") => result.push(format!("-{}=0", word.display()).into()),
            Some(text) => result.push(spelt(text).into()),
            None => result.push(word.clone()),
        }
    }
    Ok(result)
}

fn spelt(word: &str) -> String {
    match word.strip_prefix('-') {
        Some("3dMedit") => "--3dMedit".into(),
        Some(name) if WORDS.contains(&name) => format!("--{name}"),
        _ => word.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split_whitespace().map(Into::into).collect()
    }

    #[test]
    fn names_of_several_letters_get_a_second_dash() {
        for (given, expected) in [
            ("v remesh a.mesh -hausd 0.1 -hmax 1", "v remesh a.mesh --hausd 0.1 --hmax 1"),
            ("v remesh -in a -out b -A -nr", "v remesh --in a --out b -A --nr"),
            ("v remesh a.mesh -o b.mesh --hausd 1", "v remesh a.mesh -o b.mesh --hausd 1"),
            ("v remesh -v 5 a.mesh", "v remesh --verbosity 5 a.mesh"),
            ("v remesh -v -1 a.mesh", "v remesh --verbosity -1 a.mesh"),
            ("v remesh -v a.mesh", "v remesh -v a.mesh"),
            ("v remesh a.mesh -hgrad -1", "v remesh a.mesh --hgrad -1"),
            ("v remesh -xreg a.mesh -rmc 1e-3", "v remesh --xreg=0 a.mesh --rmc 1e-3"),
            ("v mesh a.mesh -hausd 0.1", "v mesh a.mesh -hausd 0.1"),
            ("v", "v"),
        ] {
            assert_eq!(translated(words(given)).unwrap(), words(expected), "{given}");
        }
    }

    #[test]
    fn what_there_is_not_is_named() {
        for text in ["v remesh a.mesh -hmx 1", "v remesh -hmax=1 a.mesh", "v remesh -hello"] {
            let error = translated(words(text)).unwrap_err();
            assert!(error.to_string().ends_with("is no option") && !error.help().is_empty(), "{error}");
        }
        for text in ["v remesh a.mesh -ls 0.5", "v remesh -f a.mmgs a.mesh", "v remesh -nsd 2 a.mesh"] {
            let error = translated(words(text)).unwrap_err();
            assert!(error.to_string().starts_with("not supported: remesh -") && !error.help().is_empty(), "{error}");
        }
        assert!(translated(words("v mesh -f a")).is_ok());
    }
}

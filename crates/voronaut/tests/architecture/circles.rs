//! Files of a crate that use each other in a circle.
//!
//! A file uses those whose items its paths name. What a folder's `mod.rs` hands on (`pub use`) is of the file that defines it; what it
//! has of its own is for the files of its folder, as a struct's fields are for its methods, and no use of theirs counts.

use super::reading::Source;
use std::collections::{BTreeMap, BTreeSet};

/// Every set of files that use each other in a circle, each sorted.
pub(super) fn circles(sources: &[Source]) -> Vec<Vec<String>> {
    let house = House::new(sources);
    let uses: BTreeMap<&str, BTreeSet<String>> =
        sources.iter().map(|source| (source.name.as_str(), house.used_by(source))).collect();
    let reaches = |from: &str| {
        let (mut seen, mut stack) = (BTreeSet::new(), vec![from.to_owned()]);
        while let Some(file) = stack.pop() {
            for next in uses.get(file.as_str()).into_iter().flatten() {
                if seen.insert(next.clone()) {
                    stack.push(next.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&str, BTreeSet<String>> = uses.keys().map(|&file| (file, reaches(file))).collect();
    let circle = |&file: &&str| {
        let mutual = reached[file].iter().filter(|other| reached[other.as_str()].contains(file));
        mutual.cloned().collect::<Vec<_>>()
    };
    let found: BTreeSet<Vec<String>> = uses.keys().map(circle).filter(|circle| circle.len() > 1).collect();
    found.into_iter().collect()
}

/// Which file a path leads to.
struct House {
    /// By the path of the module, without `crate`.
    files: BTreeMap<Vec<String>, String>,
    /// What a module hands on: by module and name, the full path.
    handed_on: BTreeMap<(Vec<String>, String), Vec<String>>,
}

impl House {
    fn new(sources: &[Source]) -> Self {
        let files = sources.iter().map(|source| (module(&source.name), source.name.clone())).collect();
        let mut house = Self { files, handed_on: BTreeMap::new() };
        for source in sources {
            let own = module(&source.name);
            for (path, is_public) in paths(&source.code) {
                let Some(name) = path.last().cloned().filter(|_| is_public) else { continue };
                if let Some(full) = house.full(&own, &path) {
                    house.handed_on.insert((own.clone(), name), full);
                }
            }
        }
        house
    }

    fn used_by(&self, source: &Source) -> BTreeSet<String> {
        let own = module(&source.name);
        let used = paths(&source.code).into_iter().filter(|(_, is_public)| !is_public);
        let files = used.filter_map(|(path, _)| self.full(&own, &path)).filter_map(|full| self.file(&full));
        let around = |file: &String| own.starts_with(&module(file)) && own.len() > module(file).len();
        files.filter(|file| *file != source.name && !around(file)).collect()
    }

    /// A path from the root of the crate, followed to where its last name is defined.
    fn full(&self, own: &[String], path: &[String]) -> Option<Vec<String>> {
        let mut full: Vec<String> = own.to_vec();
        let mut rest = path.iter();
        match path.first()?.as_str() {
            "crate" => {
                full.clear();
                rest.next();
            }
            "self" => drop(rest.next()),
            "super" => {
                for _ in path.iter().take_while(|name| *name == "super") {
                    full.pop();
                    rest.next();
                }
            }
            first if self.files.contains_key(&[own, &[first.to_owned()]].concat()) => {}
            _ => return None,
        }
        full.extend(rest.cloned());
        // What is handed on may be handed on again.
        for _ in 0..8 {
            let next = (1..=full.len()).find_map(|n| {
                // What a module and an item are named alike is the module where a path goes on.
                let is_module = n < full.len() && self.files.contains_key(&full[..n]);
                let to = self.handed_on.get(&(full[..n - 1].to_vec(), full[n - 1].clone())).filter(|_| !is_module)?;
                Some([to, &full[n..]].concat())
            });
            let Some(next) = next.filter(|next| *next != full) else { break };
            full = next;
        }
        Some(full)
    }

    /// The file of the longest part of a path that is a module.
    fn file(&self, full: &[String]) -> Option<String> {
        (0..=full.len()).rev().find_map(|n| self.files.get(&full[..n])).cloned()
    }
}

/// The module that a file is.
fn module(name: &str) -> Vec<String> {
    let plain = name.trim_end_matches(".rs");
    let parts = plain.split('/').filter(|part| !["mod", "lib", "main"].contains(part));
    parts.map(String::from).collect()
}

/// The paths that code names, groups taken apart, and whether they are handed on.
fn paths(code: &str) -> Vec<(Vec<String>, bool)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("use ") {
        let line = code[..at].rfind('\n').map_or(0, |end| end + 1);
        let before = code[line..at].trim();
        if before.is_empty() || before.starts_with("pub") {
            let text = &code[at + 4..][..code[at + 4..].find(';').unwrap_or(0)];
            let apart = apart(text).into_iter().map(|path| (path, before.starts_with("pub")));
            found.extend(apart);
        }
    }
    for opening in ["crate::", "super::"] {
        for (at, _) in code.match_indices(opening) {
            let line = code[..at].rfind('\n').map_or(0, |end| end + 1);
            if !code[line..at].contains("use ") && !code[..at].ends_with("super::") {
                let text: String =
                    code[at..].chars().take_while(|c| c.is_alphanumeric() || "_:".contains(*c)).collect();
                found.push((text.split("::").filter(|part| !part.is_empty()).map(String::from).collect(), false));
            }
        }
    }
    found
}

/// The paths of a `use`, its groups taken apart.
fn apart(text: &str) -> Vec<Vec<String>> {
    let text = text.trim();
    let Some((head, group)) = text.split_once('{') else {
        let plain = text.split(" as ").next().unwrap_or_default();
        return vec![plain.split("::").map(|part| part.trim().to_owned()).filter(|part| part != "*").collect()];
    };
    let head: Vec<String> = head.split("::").map(str::trim).filter(|part| !part.is_empty()).map(String::from).collect();
    let (mut depth, mut entry, mut all) = (0, String::new(), Vec::new());
    for c in group[..group.rfind('}').unwrap_or(group.len())].chars().chain([',']) {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            if !entry.trim().is_empty() {
                all.extend(apart(&entry).into_iter().map(|rest| [head.clone(), rest].concat()));
            }
            entry.clear();
        } else {
            entry.push(c);
        }
    }
    all
}

#[test]
fn circles_are_found() {
    let source = |name: &str, code: &str| Source { name: name.into(), text: String::new(), code: code.into() };
    let mut house = vec![
        source("lib.rs", "mod a;\npub mod b;\npub use a::A;\n"),
        source("a.rs", "use crate::b::{self, c::{C, D}};\n"),
        source("b/mod.rs", "mod c;\npub use c::C;\n"),
        source("b/c.rs", "fn f() {}\n"),
    ];
    assert_eq!(circles(&house), Vec::<Vec<String>>::new());
    house[3].code = "fn f() { crate::A::new() }\n".into();
    assert_eq!(circles(&house), [["a.rs", "b/c.rs"]]);
    house[3].code = "use super::X;\n".into();
    house[2].code = "mod c;\npub use c::C;\nuse self::c::f;\n".into();
    assert_eq!(circles(&house), Vec::<Vec<String>>::new(), "a folder and its files");
}

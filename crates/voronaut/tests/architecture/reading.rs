//! Sources read as text. Comments, string literals and tests are taken out first; braces are then matched crudely, which is enough for
//! code that rustfmt has seen.

use std::fs;
use std::path::{Path, PathBuf};

/// A file of a crate.
pub(super) struct Source {
    /// Below `src`, with slashes: `metric/tree.rs`.
    pub(super) name: String,
    /// As it is.
    pub(super) text: String,
    /// Without comments, string contents and tests.
    pub(super) code: String,
}

impl Source {
    /// The top-level module: `metric`.
    pub(super) fn module(&self) -> &str {
        self.name.split(['/', '.']).next().unwrap_or_default()
    }
}

/// All files of all crates, without those that are only there for tests.
pub(super) fn everywhere() -> Vec<Source> {
    let crates = ["voronaut", "voronaut-io", "voronaut-draw", "voronaut-cli", "voronaut-wasm"];
    let named = |name: &str| {
        let named =
            sources(name).into_iter().map(|source| Source { name: format!("{name}/{}", source.name), ..source });
        named.collect::<Vec<_>>()
    };
    crates.into_iter().flat_map(named).collect()
}

/// All files of a crate, without those that are only there for tests; names are below its `src`.
pub(super) fn sources(name: &str) -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src");
    let mut paths = Vec::new();
    collect(&root, &mut paths);
    paths.sort();
    assert!(paths.len() > 5, "the sources are where they were");
    let mut test_files = Vec::new();
    let mut all = Vec::new();
    for path in paths {
        let name = path.strip_prefix(&root).expect("below the root").to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(&path).expect("a readable source");
        let (code, test_modules) = without_tests(&without_comments(&text));
        // Modules of `a/mod.rs` are in `a/`, those of `a/b.rs` in `a/b/`, those of the crate at the top.
        let plain = name.trim_end_matches(".rs");
        let folder =
            ["mod", "lib"].iter().find_map(|root| plain.strip_suffix(root)).map_or(format!("{plain}/"), String::from);
        test_files.extend(test_modules.iter().map(|module| format!("{folder}{module}")));
        all.push(Source { name, text, code });
    }
    let is_of = |name: &str, module: &String| {
        name.strip_prefix(module.as_str()).is_some_and(|rest| rest == ".rs" || rest.starts_with('/'))
    };
    all.retain(|source: &Source| !test_files.iter().any(|module| is_of(&source.name, module)));
    all
}

fn collect(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(&path, paths);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            paths.push(path);
        }
    }
}

/// The modules that lib.rs declares, in its order.
pub(super) fn modules(all: &[Source]) -> Vec<String> {
    let lib = all.iter().find(|source| source.name == "lib.rs").expect("lib.rs");
    let declared = lib.code.lines().filter_map(|line| line.trim().trim_start_matches("pub ").strip_prefix("mod "));
    declared.map(|rest| rest.trim_end_matches(';').to_string()).collect()
}

/// The modules in paths `crate::module` and `crate::{module, module::item}`; what lib.rs re-exports is from `error`.
pub(super) fn used_modules(code: &str) -> Vec<String> {
    let mut used = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        match rest.strip_prefix('{') {
            Some(group) => used.extend(top_level_names(group)),
            None => used.push(identifier(rest)),
        }
    }
    used.into_iter().map(|name| if name.starts_with(char::is_uppercase) { "error".into() } else { name }).collect()
}

/// The first identifier of each entry of a `use` group that starts here.
fn top_level_names(group: &str) -> Vec<String> {
    let (mut depth, mut entry, mut names) = (1, String::new(), Vec::new());
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 || (depth == 1 && c == ',') {
            names.push(identifier(entry.trim_start()));
            entry.clear();
        } else {
            entry.push(c);
        }
        if depth == 0 {
            break;
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

pub(super) fn identifier(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// Whether the code has the path, not as the end of a longer identifier.
pub(super) fn contains_path(code: &str, path: &str) -> bool {
    code.match_indices(path).any(|(at, _)| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
}

/// As [`contains_path`], and not as a lifetime either.
pub(super) fn contains_word(code: &str, word: &str) -> bool {
    code.match_indices(word).any(|(at, _)| !code[..at].ends_with(|c: char| c.is_alphanumeric() || "_'".contains(c)))
}

/// Length and name of every function with a body.
pub(super) fn functions(source: &Source) -> Vec<(usize, String)> {
    let code = &source.code;
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ").filter(|(at, _)| !code[..*at].ends_with(|c: char| c.is_alphanumeric())) {
        let name = identifier(&code[at + 3..]);
        let Some(start) = code[at..].find(['{', ';']).map(|offset| at + offset) else { continue };
        if name.is_empty() || code[start..].starts_with(';') {
            continue;
        }
        let end = start + matching_brace(&code[start..]);
        found.push((code[at..end].lines().count(), format!("{}: {name}", source.name)));
    }
    found
}

/// How far it is to just behind the brace that closes the one the code starts with.
fn matching_brace(code: &str) -> usize {
    let mut depth = 0;
    for (at, c) in code.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    code.len()
}

/// The code without what stands behind `#[cfg(test)]`, and the names of the modules of whole files among that.
pub(super) fn without_tests(code: &str) -> (String, Vec<String>) {
    const MARK: &str = "#[cfg(test)]";
    let (mut kept, mut files, mut rest) = (String::new(), Vec::new(), code);
    while let Some(at) = rest.find(MARK) {
        kept.push_str(&rest[..at]);
        let item = &rest[at + MARK.len()..];
        let start = item.find(['{', ';']).unwrap_or(item.len());
        // `use a::{b, c};` has a brace of its own before its semicolon.
        let end = if item.trim_start().starts_with("use ") || item.trim_start().starts_with("pub(crate) use ") {
            item.find(';').map_or(item.len(), |end| end + 1)
        } else if item[start..].starts_with('{') {
            start + matching_brace(&item[start..])
        } else {
            files.extend(item[..start].trim().rsplit(' ').next().map(String::from));
            (start + 1).min(item.len())
        };
        rest = &item[end..];
    }
    (kept + rest, files)
}

/// The code without comments and without what stands between quotes; lines stay where they are.
pub(super) fn without_comments(text: &str) -> String {
    let (mut out, mut rest) = (String::new(), text);
    while let Some(c) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(raw) = rest.strip_prefix("r#\"") {
            raw.find("\"#").map_or(rest.len(), |end| end + 5)
        } else if c == '"' {
            quoted(rest)
        } else if c == '\'' {
            character(rest)
        } else {
            0
        };
        if skipped == 0 {
            out.push(c);
            rest = &rest[c.len_utf8()..];
        } else {
            out.extend(rest[..skipped].chars().filter(|c| *c == '\n'));
            rest = &rest[skipped..];
        }
    }
    out
}

/// Length of the string literal that the text starts with.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        if c == '"' && !escaped {
            return at + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    text.len()
}

/// Length of the character literal that the text starts with; zero of a lifetime.
fn character(text: &str) -> usize {
    let inner = &text[1..];
    if let Some(escape) = inner.strip_prefix('\\') {
        return escape.char_indices().skip(1).find(|(_, c)| *c == '\'').map_or(0, |(at, _)| at + 3);
    }
    let Some(c) = inner.chars().next() else { return 0 };
    if inner[c.len_utf8()..].starts_with('\'') { c.len_utf8() + 2 } else { 0 }
}

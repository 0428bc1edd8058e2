//! Invariants of ARCHITECTURE.md that can be held by reading the sources. Comments, string literals and tests are
//! taken out first; braces are then matched crudely, which is enough for code that rustfmt has seen.

use std::fs;
use std::path::{Path, PathBuf};

/// No function is longer, in lines from its signature to its closing brace.
const LONGEST_FUNCTION: usize = 80;
/// Nine functions in ten are no longer than this.
const LONG_FUNCTION: usize = 25;
/// No file is longer, tests included.
const LONGEST_FILE: usize = 500;

/// A file of the library.
struct Source {
    /// Below `src`, with slashes: `metric/tree.rs`.
    name: String,
    /// As it is.
    text: String,
    /// Without comments, string contents and tests.
    code: String,
}

impl Source {
    /// The top-level module: `metric`.
    fn module(&self) -> &str {
        self.name.split(['/', '.']).next().unwrap_or_default()
    }

    fn is_in(&self, places: &[&str]) -> bool {
        places.iter().any(|place| self.name.starts_with(place))
    }
}

#[test]
fn modules_use_only_those_above_them() {
    let all = sources();
    let order = modules(&all);
    let rank = |module: &str| order.iter().position(|name| name == module);
    for source in all.iter().filter(|source| source.module() != "lib") {
        let own = rank(source.module()).unwrap_or_else(|| panic!("{} is not declared in lib.rs", source.name));
        for used in used_modules(&source.code) {
            let used_rank = rank(&used).unwrap_or_else(|| panic!("{}: crate::{used} is no module", source.name));
            assert!(used_rank <= own, "{} uses {used}, which stands below {} in lib.rs", source.name, source.module());
        }
    }
}

#[test]
fn triangulation_is_blind_to_positions() {
    for source in sources().iter().filter(|source| source.module() == "triangulation") {
        for word in ["geometry", "Point", "Vector", "f64, f64", "position"] {
            assert!(!source.code.contains(word), "{} mentions {word}", source.name);
        }
    }
}

/// Edges that wait for a test after a flip are there only.
#[test]
fn lawson_s_flips_are_one_module() {
    for source in sources().iter().filter(|source| source.name != "triangulation/lawson.rs") {
        let flips = source.code.contains("topology.flip(");
        assert!(!(flips && source.code.contains(".pop()")), "{} has a loop of flips of its own", source.name);
    }
}

#[test]
fn levels_of_in_circle_tests_are_climbed_in_one_module() {
    let all = sources();
    let mut found = all.iter().filter(|source| source.code.contains("InCircle for"));
    assert!(found.clone().count() >= 3, "the mesh in the making, seeds in a field and on a surface");
    for source in all.iter().filter(|source| source.code.contains("in_circle::")) {
        assert!(!source.code.contains("for level in"), "{} climbs levels by itself", source.name);
    }
    assert!(found.all(|source| !source.code.contains("HashMap")), "what is known is kept in one place");
}

#[test]
fn the_library_never_prints() {
    for source in &sources() {
        for word in ["print!", "println!", "dbg!", "stdout()", "stderr()"] {
            assert!(!source.code.contains(word), "{} has {word}", source.name);
        }
    }
}

#[test]
fn files_are_opened_where_data_comes_in_and_goes_out() {
    for source in sources().iter().filter(|source| !source.is_in(&["formats/files.rs", "output/"])) {
        for word in ["std::fs", "fs::", "File::"] {
            assert!(!contains_path(&source.code, word), "{} has {word}", source.name);
        }
    }
}

#[test]
fn only_output_writes_files() {
    for source in sources().iter().filter(|source| !source.is_in(&["output/"])) {
        for word in ["fs::write", "File::create", "OpenOptions", "tempfile"] {
            assert!(!source.code.contains(word), "{} has {word}", source.name);
        }
    }
}

#[test]
fn nothing_global_decides() {
    for source in &sources() {
        for word in ["static ", "thread_local!", "env::var", "SystemTime", "current_num_threads"] {
            assert!(!contains_word(&source.code, word), "{} has {word}", source.name);
        }
    }
}

#[test]
fn functions_fit_a_screen() {
    let all = sources();
    let mut lengths: Vec<(usize, String)> = all.iter().flat_map(functions).collect();
    lengths.sort();
    let (longest, name) = &lengths[lengths.len() - 1];
    assert!(*longest <= LONGEST_FUNCTION, "{name} has {longest} lines");
    let long = lengths[lengths.len() * 9 / 10].0;
    assert!(long <= LONG_FUNCTION, "one function in ten has more than {long} lines");
}

#[test]
fn files_are_one_idea_each() {
    for source in &sources() {
        let lines = source.text.lines().count();
        assert!(lines <= LONGEST_FILE, "{} has {lines} lines", source.name);
        assert!(source.text.starts_with("//!"), "{} does not begin by saying what it is", source.name);
    }
}

#[test]
fn every_cited_work_is_in_the_bibliography() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |name: &str| fs::read_to_string(root.join(name)).expect("a readable document");
    let bibliography = read("references.bib");
    let entries: Vec<&str> = bibliography.split("\n@").collect();
    let documents = [
        "DESIGN.md",
        "ARCHITECTURE.md",
        "README.md",
        "docs/coming-from.md",
        "docs/guarantees.md",
        "docs/guide.md",
        "docs/measurements.md",
    ]
    .map(|name| (name.to_string(), read(name)));
    let texts = sources().into_iter().map(|source| (source.name, source.text)).chain(documents);
    let mut cited = 0;
    for (file, text) in texts {
        for (author, year) in citations(&text) {
            let is_it = |entry: &&str| entry.contains(&author) && entry.contains(&format!("year = {{{year}}}"));
            assert!(entries.iter().any(is_it), "{file}: no entry for {author} {year}");
            cited += 1;
        }
    }
    assert!(cited > 5, "citations are written as they were");
}

/// Name and year of what is cited as `Name 1999`, `Name and Other 1999` or `Name et al. 1999`.
fn citations(text: &str) -> Vec<(String, String)> {
    let bare = |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric()).to_string();
    let words: Vec<String> = text
        .split_whitespace()
        .filter(|word| !word.starts_with("//"))
        .map(bare)
        .filter(|w| w != "et" && w != "al")
        .collect();
    let is_year = |word: &str| word.len() == 4 && (word.starts_with("19") || word.starts_with("20"));
    let cited = words.windows(2).filter(|pair| {
        is_year(&pair[1]) && pair[1].chars().all(|c| c.is_ascii_digit()) && pair[0].starts_with(char::is_uppercase)
    });
    // Bibliographies write accents as commands: the part of a name before the first of them is enough.
    let plain = |name: &str| name.chars().take_while(char::is_ascii).collect::<String>();
    cited.map(|pair| (plain(&pair[0]), pair[1].clone())).collect()
}

/// All files of the library, without those that are only there for tests.
fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    collect(&root, &mut paths);
    paths.sort();
    assert!(paths.len() > 50, "the sources are where they were");
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
        test_files.extend(test_modules.iter().map(|module| format!("{folder}{module}.rs")));
        all.push(Source { name, text, code });
    }
    all.retain(|source| !test_files.contains(&source.name));
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
fn modules(all: &[Source]) -> Vec<String> {
    let lib = all.iter().find(|source| source.name == "lib.rs").expect("lib.rs");
    let declared = lib.code.lines().filter_map(|line| line.trim().strip_prefix("pub mod "));
    declared.map(|rest| rest.trim_end_matches(';').to_string()).collect()
}

/// The modules in paths `crate::module` and `crate::{module, module::item}`; what lib.rs re-exports is from `error`.
fn used_modules(code: &str) -> Vec<String> {
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

fn identifier(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// Whether the code has the path, not as the end of a longer identifier.
fn contains_path(code: &str, path: &str) -> bool {
    code.match_indices(path).any(|(at, _)| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
}

/// As [`contains_path`], and not as a lifetime either.
fn contains_word(code: &str, word: &str) -> bool {
    code.match_indices(word).any(|(at, _)| !code[..at].ends_with(|c: char| c.is_alphanumeric() || "_'".contains(c)))
}

/// Length and name of every function with a body.
fn functions(source: &Source) -> Vec<(usize, String)> {
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
fn without_tests(code: &str) -> (String, Vec<String>) {
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
fn without_comments(text: &str) -> String {
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

#[test]
fn the_reader_of_sources_reads() {
    let text = "/// fn doc() {}\nfn a() { b(\"}{ // \\\" \"); c('}'); d('\\''); } // crate::x\n#[cfg(test)]\nmod t { use \
                crate::y; }\n#[cfg(test)]\nmod whole;\nfn e<'a>() {\n}\n";
    let (code, files) = without_tests(&without_comments(text));
    assert_eq!(files, ["whole"]);
    let source = Source { name: "s.rs".into(), text: text.into(), code };
    assert_eq!(functions(&source), [(1, "s.rs: a".to_string()), (2, "s.rs: e".to_string())]);
    assert!(used_modules(&source.code).is_empty());
    assert_eq!(
        used_modules("use crate::{mesh::{Mesh, X}, Error, metric}; crate::dual::f()"),
        ["mesh", "error", "metric", "dual"]
    );
}

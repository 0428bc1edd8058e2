//! Invariants of ARCHITECTURE.md that can be held by reading the sources of all crates.

mod circles;
mod reading;

use reading::{
    Source, contains_path, contains_word, everywhere, functions, modules, sources, used_modules, without_comments,
    without_tests,
};
use std::fs;
use std::path::Path;

/// No function is longer, in lines from its signature to its closing brace.
const LONGEST_FUNCTION: usize = 80;
/// Nine functions in ten are no longer than this.
const LONG_FUNCTION: usize = 25;
/// No file is longer, tests included.
const LONGEST_FILE: usize = 500;
/// Functions, types, traits and constants of the three libraries that others may use.
const MOST_PUBLIC: usize = 600;

#[test]
fn modules_use_only_those_above_them() {
    let all = sources("voronaut");
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
    for source in sources("voronaut").iter().filter(|source| source.module() == "triangulation") {
        for word in ["geometry", "Point", "Vector", "f64, f64", "position"] {
            assert!(!source.code.contains(word), "{} mentions {word}", source.name);
        }
    }
}

/// Realisations of what meshes live on; all others take manifolds, or what is of a triangulation alone.
const REALISATIONS: [&str; 3] = ["Domain", "Surface", "Implicit"];

/// Files outside `manifold` that know one.
const KNOW_A_REALISATION: [(&str, &str); 3] = [
    ("recipe/parts/plane.rs", "cuts a domain into domains"),
    ("recipe/plane.rs", "the front door of the plane, through which users bring them"),
    ("sampling/plan.rs", "a domain measured by a metric"),
];

#[test]
fn few_files_know_what_meshes_live_on() {
    let names_one = |source: &Source| {
        let starts = source.code.match_indices("manifold::").map(|(at, name)| at + name.len());
        let mut used = starts.filter_map(|at| source.code[at..].split([';', '(']).next());
        used.any(|names| names.split(|c: char| !c.is_alphanumeric()).any(|word| REALISATIONS.contains(&word)))
    };
    let is_own = |source: &&Source| ["manifold", "test_cases"].contains(&source.module());
    let mut all = sources("voronaut");
    all.extend(sources("voronaut-draw"));
    let found: Vec<&str> =
        all.iter().filter(|source| !is_own(source) && names_one(source)).map(|source| source.name.as_str()).collect();
    assert_eq!(
        found,
        KNOW_A_REALISATION.map(|(name, _)| name),
        "a file more needs a reason, one less is to be taken off the list"
    );
}

/// Edges that wait for a test after a flip are there only.
#[test]
fn lawson_s_flips_are_one_module() {
    for source in sources("voronaut").iter().filter(|source| source.name != "triangulation/lawson.rs") {
        let flips = source.code.contains("topology.flip(");
        assert!(!(flips && source.code.contains(".pop()")), "{} has a loop of flips of its own", source.name);
    }
}

#[test]
fn levels_of_in_circle_tests_are_climbed_in_one_module() {
    let all = sources("voronaut");
    let mut found = all.iter().filter(|source| source.code.contains("InCircle for"));
    assert!(found.clone().count() >= 3, "the mesh in the making, seeds in a field and on a surface");
    for source in all.iter().filter(|source| source.code.contains("in_circle::")) {
        assert!(!source.code.contains("for level in"), "{} climbs levels by itself", source.name);
    }
    assert!(found.all(|source| !source.code.contains("HashMap")), "what is known is kept in one place");
}

/// In the plane, on surfaces and on those that an equation makes.
#[test]
fn gradation_is_one_law() {
    let (all, law) = (sources("voronaut"), "metric/nodal/gradation.rs");
    let holders = |word: &str| -> Vec<String> {
        all.iter().filter(|source| source.code.contains(word)).map(|source| source.name.clone()).collect()
    };
    for word in ["GRADATION_EXPONENT:", "fn grown(", "gradation_factor.logarithm()"] {
        assert_eq!(holders(word), [law], "{word}");
    }
    assert_eq!(holders("hgrad.logarithm()"), [""; 0]);
    assert_eq!(holders("Gradation::on("), [law, "metric/nodal/vertices.rs"]);
    assert_eq!(holders("Gradation::of_sizes("), ["manifold/surface/metric/gradation.rs", "manifold/surface/remesh.rs"]);
}

/// Text or bytes: formats say what numbers mean, the codec how they are read.
#[test]
fn numbers_are_made_of_bytes_in_one_module_of_io() {
    let all = sources("voronaut-io");
    for source in all.iter().filter(|source| source.module() != "codec") {
        for word in ["from_le_bytes", "from_be_bytes", "from_ne_bytes"] {
            assert!(!contains_word(&source.code, word), "{} has {word}", source.name);
        }
    }
}

/// So that the mathematics can do without threads.
#[test]
fn threads_are_one_module() {
    for source in sources("voronaut").iter().filter(|source| source.module() != "parallel") {
        for word in ["rayon", "std::thread"] {
            assert!(!contains_path(&source.code, word), "{} has {word}", source.name);
        }
    }
}

#[test]
fn libraries_never_print() {
    for source in libraries() {
        for word in ["print!", "println!", "dbg!", "stdout()", "stderr()"] {
            assert!(!source.code.contains(word), "{} has {word}", source.name);
        }
    }
}

/// The mathematics are blind to files, and so are pictures; formats are bytes and structs.
#[test]
fn files_are_opened_by_three_modules_of_io() {
    let opening = ["voronaut-io/files.rs", "voronaut-io/whole.rs", "voronaut-io/report.rs"];
    for source in libraries().iter().filter(|source| !opening.contains(&source.name.as_str())) {
        for word in ["std::fs", "fs::", "File::", "OpenOptions", "tempfile"] {
            assert!(!contains_path(&source.code, word), "{} has {word}", source.name);
        }
    }
}

/// Parameters have the library's names in what it says; the program shows its flags for them.
#[test]
fn no_library_names_a_flag() {
    for source in libraries() {
        let words = source.text.lines().filter(|line| !line.trim_start().starts_with("//"));
        let named = |line: &&str| {
            line.match_indices("--")
                .any(|(at, _)| line[at + 2..].starts_with(|c: char| c.is_ascii_lowercase()) && line[..at].contains('"'))
        };
        assert_eq!(words.clone().find(named), None, "in {}", source.name);
    }
}

#[test]
fn nothing_global_decides() {
    // Temporary files are those of the process: who ends it removes them.
    let is_exempt = |name: &str| name == "voronaut-io/whole.rs";
    for source in libraries().into_iter().filter(|source| !is_exempt(&source.name)) {
        for word in ["static ", "thread_local!", "env::var", "SystemTime", "current_num_threads"] {
            assert!(!contains_word(&source.code, word), "{} has {word}", source.name);
        }
    }
}

/// Times are those of who watches ([`voronaut::progress::Progress::seconds`]).
#[test]
fn libraries_read_no_clock() {
    for source in libraries() {
        assert!(!contains_word(&source.code, "Instant"), "{} reads a clock", source.name);
    }
}

/// A module that is public hands nothing on by another name.
#[test]
fn public_names_are_exported_once() {
    for source in libraries() {
        let lines = || source.code.lines().map(str::trim);
        let public: Vec<&str> =
            lines().filter_map(|line| line.strip_prefix("pub mod ")).map(|rest| rest.trim_end_matches(';')).collect();
        let handed_on = lines().filter_map(|line| line.strip_prefix("pub use ")?.split("::").next());
        for module in handed_on {
            assert!(!public.contains(&module), "{}: names of {module} are public twice", source.name);
        }
    }
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    for name in ["voronaut", "voronaut-io", "voronaut-draw", "voronaut-cli", "voronaut-wasm", "voronaut-python"] {
        assert_eq!(circles::circles(&sources(name)), Vec::<Vec<String>>::new(), "of {name}");
    }
}

/// What users need; everything else is the libraries' own.
#[test]
fn little_is_public() {
    let kinds = ["fn", "const", "struct", "enum", "trait", "type"];
    let is_public = |line: &&str| {
        line.trim_start()
            .strip_prefix("pub ")
            .is_some_and(|rest| kinds.iter().any(|&kind| rest.split(' ').next() == Some(kind)))
    };
    let public: usize = libraries().iter().map(|source| source.code.lines().filter(is_public).count()).sum();
    assert!(public > 300 && public <= MOST_PUBLIC, "{public} public items");
}

#[test]
fn functions_fit_a_screen() {
    let all = everywhere();
    let mut lengths: Vec<(usize, String)> = all.iter().flat_map(functions).collect();
    lengths.sort();
    let (longest, name) = &lengths[lengths.len() - 1];
    assert!(*longest <= LONGEST_FUNCTION, "{name} has {longest} lines");
    let long = lengths[lengths.len() * 9 / 10].0;
    assert!(long <= LONG_FUNCTION, "one function in ten has more than {long} lines");
}

#[test]
fn files_are_one_idea_each() {
    for source in &everywhere() {
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
    let texts = everywhere().into_iter().map(|source| (source.name, source.text)).chain(documents);
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

/// The crates that others build upon.
fn libraries() -> Vec<Source> {
    let is_program =
        |source: &Source| ["voronaut-cli/", "voronaut-wasm/"].iter().any(|name| source.name.starts_with(name));
    everywhere().into_iter().filter(|source| !is_program(source)).collect()
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

//! Holds the house that `src/lib.rs` describes: ranks of folders, order inside `control`, no circle of files, short files,
//! and what its code may not say.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder imports only from folders of strictly lower rank, and from itself.
const RANKS: [(&str, u32); 13] = [
    ("control", 0),
    ("gcode", 1),
    ("sim", 1),
    ("link", 1),
    ("laws", 1),
    ("config", 2),
    ("run", 2),
    ("study", 3),
    ("report", 4),
    ("fmi", 4),
    ("cli", 5),
    ("guide", 5),
    ("capi", 5),
];
const LONGEST_FILE: usize = 400;

fn source_root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// A source file with the path of the module that it is.
struct Source {
    name: String,
    module: Vec<String>,
    text: String,
    code: String,
}

fn sources() -> Vec<Source> {
    let root = source_root();
    let (mut folders, mut found) = (vec![root.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("src is readable") {
            let path = entry.expect("src is readable").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).expect("source is UTF-8");
                let inside = path.strip_prefix(&root).expect("found under src").with_extension("");
                let mut module: Vec<_> = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
                module.pop_if(|last| matches!(last.as_str(), "mod" | "lib" | "main"));
                let name = path.strip_prefix(&root).expect("found under src").display().to_string();
                let code = without_tests(&without_comments(&text)).to_owned();
                found.push(Source { name, module, text, code });
            }
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(found.len() > 20, "only {} files found under src", found.len());
    found
}

/// Blanks comments, and the insides of strings and characters. Line breaks stay, so that line numbers do.
fn without_comments(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if next == '"' {
            string_end(rest)
        } else if rest.starts_with("r\"") || rest.starts_with("r#") {
            raw_string_end(rest).unwrap_or(0)
        } else if next == '\'' {
            character_end(rest).unwrap_or(0)
        } else {
            0
        };
        if skipped == 0 {
            code.push(next);
            rest = &rest[next.len_utf8()..];
        } else {
            code.push(' ');
            code.extend(rest[..skipped].chars().filter(|c| *c == '\n'));
            rest = &rest[skipped..];
        }
    }
    code
}

fn string_end(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

fn raw_string_end(text: &str) -> Option<usize> {
    let hashes = text[1..].chars().take_while(|c| *c == '#').count();
    text[1 + hashes..].starts_with('"').then_some(())?;
    let closing = format!("\"{}", "#".repeat(hashes));
    let body = 2 + hashes;
    text[body..].find(&closing).map(|end| body + end + closing.len())
}

/// `'x'`, `'\n'`, `'\u{1F600}'`; a lifetime has no closing quote in reach.
fn character_end(text: &str) -> Option<usize> {
    let mut chars = text.char_indices().skip(1);
    match chars.next()?.1 {
        '\\' => text[3..].find('\'').map(|end| end + 4),
        _ => chars.next().filter(|(_, c)| *c == '\'').map(|(at, _)| at + 1),
    }
}

/// Unit tests stand last in their file, in a module of this name.
fn without_tests(code: &str) -> &str {
    &code[..code.find("#[cfg(test)]\nmod tests {").unwrap_or(code.len())]
}

/// Every path from the crate's root that code names, `super` resolved and braces spread out.
fn paths(source: &Source) -> BTreeSet<Vec<String>> {
    let tokens = tokens(&source.code);
    let mut found = BTreeSet::new();
    let mut at = 0;
    while at < tokens.len() {
        // Nor is a path what `pub(super)` or `pub(in crate::a)` names.
        let fresh = !matches!(tokens[..at], [.., "::"] | [.., "pub", "("] | [.., "pub", "(", "in"]);
        let mut base = match tokens[at] {
            "crate" if fresh => Vec::new(),
            "super" if fresh => parent(&source.module),
            _ => {
                at += 1;
                continue;
            }
        };
        at += 1;
        while tokens.get(at) == Some(&"::") && tokens.get(at + 1) == Some(&"super") {
            base = parent(&base);
            at += 2;
        }
        at = spread(&tokens, at, base, &mut found);
    }
    found
}

fn parent(module: &[String]) -> Vec<String> {
    module[..module.len().saturating_sub(1)].to_vec()
}

/// Reads `::a::{b, c::d}` from `at` on; returns where it ends.
fn spread(tokens: &[&str], mut at: usize, mut path: Vec<String>, found: &mut BTreeSet<Vec<String>>) -> usize {
    while tokens.get(at) == Some(&"::") {
        at += 1;
        match tokens.get(at) {
            Some(&"{") => {
                at += 1;
                while !matches!(tokens.get(at), None | Some(&"}")) {
                    let mut inner = path.clone();
                    match tokens[at] {
                        "," => at += 1,
                        "as" => at += 2,
                        name => {
                            inner.extend(is_module(name).then(|| name.to_owned()));
                            at = spread(tokens, at + 1, inner, found);
                        }
                    }
                }
                return at + 1;
            }
            Some(name) if is_name(name) => {
                path.push((*name).to_owned());
                at += 1;
            }
            _ => break,
        }
    }
    found.insert(path);
    at
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn is_module(token: &str) -> bool {
    is_name(token) && token != "self"
}

/// Names, `::`, and single other characters.
fn tokens(code: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = if first.is_alphanumeric() || first == '_' {
            rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        tokens.push(&rest[..length]);
        rest = rest[length..].trim_start();
    }
    tokens
}

fn rank(folder: &str) -> Option<u32> {
    RANKS.iter().find(|(name, _)| *name == folder).map(|(_, rank)| *rank)
}

fn report(faults: &[String]) {
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn folders_import_only_from_lower_ranks() {
    let mut faults = Vec::new();
    for source in sources() {
        let Some(folder) = source.module.first() else { continue };
        let Some(own) = rank(folder) else {
            faults.push(format!("{}: folder `{folder}` has no rank; give it one here and in src/lib.rs", source.name));
            continue;
        };
        for path in paths(&source) {
            let Some(other) = path.first().filter(|other| *other != folder) else { continue };
            let lower = rank(other).is_some_and(|other| other < own);
            // The C library embeds what a kernel does, nothing more; the second one has the simulated machine, too.
            let embeds: &[&str] = match source.module.get(1).map(String::as_str) {
                Some("sim") => &["control", "sim", "config"],
                _ => &["control"],
            };
            if !lower || (folder == "capi" && !embeds.contains(&other.as_str())) {
                faults.push(format!(
                    "{}: `{folder}` (rank {own}) may not use `crate::{}`",
                    source.name,
                    path.join("::")
                ));
            }
        }
    }
    report(&faults);
}

#[test]
fn control_is_in_the_order_its_documentation_tells() {
    let control = fs::read_to_string(source_root().join("control/mod.rs")).expect("control/mod.rs is there");
    let numbered = control.lines().filter_map(|line| line.strip_prefix("//! ")).filter(|line| {
        let number = line.chars().take_while(char::is_ascii_digit).count();
        number > 0 && line[number..].starts_with(". ")
    });
    let mut order = Vec::new();
    for line in numbered {
        let names = line.split(": ").next().unwrap_or(line);
        order.extend(names.split("[`").skip(1).filter_map(|name| name.split('`').next()));
    }
    let declared: BTreeSet<_> =
        control.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert_eq!(
        order.iter().copied().collect::<BTreeSet<_>>(),
        declared,
        "the list in control/mod.rs names every module once"
    );
    assert_eq!(order.len(), declared.len());

    let place = |name: &str| order.iter().position(|other| *other == name);
    let mut faults = Vec::new();
    for source in sources().iter().filter(|source| source.module.first().is_some_and(|first| first == "control")) {
        let Some(own) = source.module.get(1) else { continue };
        for path in paths(source) {
            let (Some(root), Some(other)) = (path.first(), path.get(1)) else { continue };
            if root == "control" && other != own && place(other) >= place(own) {
                faults.push(format!("{}: `{own}` comes before `{other}` and may not use it", source.name));
            }
        }
    }
    report(&faults);
}

#[test]
fn files_are_short() {
    let long = sources().into_iter().map(|source| (source.text.lines().count(), source.name));
    let faults: Vec<_> = long
        .filter(|(lines, _)| *lines > LONGEST_FILE)
        .map(|(lines, name)| format!("{name}: {lines} lines, more than {LONGEST_FILE}"))
        .collect();
    report(&faults);
}

/// For each file those that it imports from. A path belongs to the file of its longest beginning that is a module; a
/// module's own file imports from the children that it names.
fn imports(sources: &[Source]) -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let modules: BTreeSet<&[String]> = sources.iter().map(|source| source.module.as_slice()).collect();
    let file_of = |path: Vec<String>| {
        (1..=path.len()).rev().map(|length| path[..length].to_vec()).find(|beginning| modules.contains(&beginning[..]))
    };
    let mut imports = BTreeMap::new();
    for source in sources {
        let tokens = tokens(&source.code);
        let children = tokens.windows(2).filter(|pair| pair[0] == "use" || pair[1] == "::").filter_map(|pair| {
            let child = [&source.module[..], &[pair[usize::from(pair[0] == "use")].to_owned()]].concat();
            modules.contains(child.as_slice()).then_some(child)
        });
        let named = paths(source).into_iter().filter_map(file_of);
        let mut all: BTreeSet<_> = children.chain(named).collect();
        all.remove(&source.module);
        imports.insert(source.module.clone(), all);
    }
    imports
}

/// Files that import each other in a circle: those left when every file without an import among the rest is taken away,
/// and then every file that none of the rest imports.
fn circle(mut imports: BTreeMap<Vec<String>, BTreeSet<Vec<String>>>) -> Vec<String> {
    loop {
        let before = imports.len();
        let left: BTreeSet<_> = imports.keys().cloned().collect();
        imports.retain(|_, of| of.iter().any(|other| left.contains(other)));
        let imported: BTreeSet<_> = imports.values().flatten().cloned().collect();
        imports.retain(|file, _| imported.contains(file));
        if imports.len() == before {
            break;
        }
    }
    let left: BTreeSet<_> = imports.keys().cloned().collect();
    let row = |(file, of): (&Vec<String>, &BTreeSet<Vec<String>>)| {
        let of: Vec<_> = of.intersection(&left).map(|other| other.join("::")).collect();
        format!("{} imports {}", file.join("::"), of.join(", "))
    };
    imports.iter().map(row).collect()
}

#[test]
fn files_do_not_import_each_other_in_a_circle() {
    report(&circle(imports(&sources())));
}

#[test]
fn a_circle_is_found_file_by_file() {
    let source = |module: &str, code: &str| Source {
        name: module.to_owned(),
        module: module.split("::").map(str::to_owned).collect(),
        text: String::new(),
        code: code.to_owned(),
    };
    let round = [
        source("a", "mod b; mod c; pub use b::B;"),
        source("a::b", "use crate::a::c::C; struct B;"),
        source("a::c", "use super::B;"),
        source("a::d", "use crate::a::b::B;"),
    ];
    assert_eq!(circle(imports(&round)), ["a imports a::b", "a::b imports a::c", "a::c imports a"]);
    let straight = [
        source("a", "mod b; mod c; pub use b::B; pub use c::C;"),
        source("a::b", "use crate::a::c::C; struct B;"),
        source("a::c", "struct C;"),
    ];
    assert_eq!(circle(imports(&straight)), [""; 0]);
}

#[test]
fn only_the_edges_to_c_are_unsafe() {
    let faults: Vec<_> = sources()
        .iter()
        .filter(|source| source.module.first().is_none_or(|first| first != "capi" && first != "fmi"))
        .filter(|source| tokens(&source.code).contains(&"unsafe"))
        .map(|source| format!("{}: `unsafe` outside src/capi and src/fmi", source.name))
        .collect();
    report(&faults);
}

/// Text alone; the link check in `.ci/no_std` is what proves it of the compiled core.
#[test]
fn control_says_nothing_that_allocates_or_panics() {
    const FORBIDDEN: [(&str, &str); 11] = [
        ("std::", "the core has no std"),
        ("alloc::", "the core has no heap"),
        (".unwrap()", "panics"),
        (".expect(", "panics"),
        ("panic!", "panics"),
        ("unreachable!", "panics"),
        ("todo!", "panics"),
        ("unimplemented!", "panics"),
        ("assert!", "panics"),
        ("assert_eq!", "panics"),
        ("assert_ne!", "panics"),
    ];
    let mut faults = Vec::new();
    for source in sources().iter().filter(|source| source.module.first().is_some_and(|first| first == "control")) {
        for (number, line) in source.code.lines().enumerate() {
            let mut fault =
                |what: &str, why: &str| faults.push(format!("{}:{}: `{what}`: {why}", source.name, number + 1));
            for (word, why) in FORBIDDEN {
                if line.contains(word) {
                    fault(word, why);
                }
            }
            // The index of a constant item is checked when it is compiled.
            let item = line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(super) ");
            let constant = item.starts_with("const ");
            let indexes = line.as_bytes().windows(2).any(|pair| {
                pair[1] == b'[' && (pair[0].is_ascii_alphanumeric() || matches!(pair[0], b'_' | b')' | b']'))
            });
            if indexes && !constant {
                fault(line.trim(), "an index panics when out of range; use `get`, a pattern or an iterator");
            }
        }
    }
    report(&faults);
}

#[test]
fn the_scan_reads_paths_as_the_compiler_does() {
    let text = r#"
        // use crate::sim::Comment;
        use crate::control::{self, math::{poly::State, sqrt as root}, units};
        const TEXT: &str = "crate::cli::string \" still";
        pub(in crate::study) const SEEN: u8 = 0;
        fn f<'a>(x: &'a str) -> char { crate::run::go(x); super::super::gcode::lex('"'); '\'' }

#[cfg(test)]
mod tests { use crate::report::Never; }
    "#;
    let module = ["config", "file", "read"].map(str::to_owned).to_vec();
    let code = without_tests(&without_comments(text)).to_owned();
    let source = Source { name: String::new(), module, text: String::new(), code };
    let mut found: Vec<_> = paths(&source).iter().map(|path| path.join("::")).collect();
    found.retain(|path| !path.is_empty());
    assert_eq!(
        found,
        [
            "config::gcode::lex",
            "control",
            "control::math::poly::State",
            "control::math::sqrt",
            "control::units",
            "run::go",
        ]
    );
}

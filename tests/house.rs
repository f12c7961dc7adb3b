//! The rooms of the house and the order of what stands in them: who may depend on whom, by what
//! cargo and the sources say.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use quote::ToTokens;
use serde_json::Value;
use syn::visit_mut::{self, VisitMut};
use syn::{Attribute, Generics, ImplItemFn, ItemFn, ItemImpl, ItemMod, Signature};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A package of the workspace: what it depends on, by the kind of dependency, and its features.
struct Package {
    needs: BTreeMap<String, BTreeSet<String>>,
    features: BTreeSet<String>,
}

impl Package {
    fn needs(&self, kinds: &[&str]) -> BTreeSet<&str> {
        kinds.iter().flat_map(|kind| self.needs.get(*kind)).flatten().map(String::as_str).collect()
    }
}

/// All packages of the workspace by name, as `cargo metadata` has them.
fn packages() -> BTreeMap<String, Package> {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let arguments = ["metadata", "--no-deps", "--offline", "--format-version", "1"];
    let run = Command::new(cargo).args(arguments).current_dir(root()).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let metadata: Value = serde_json::from_slice(&run.stdout).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let package = |package: &Value| {
        let mut needs: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
        for need in package["dependencies"].as_array().unwrap() {
            let kind = need["kind"].as_str().unwrap_or("normal").to_owned();
            needs.entry(kind).or_default().insert(text(&need["name"]));
        }
        let features = package["features"].as_object().unwrap().keys().cloned().collect();
        (text(&package["name"]), Package { needs, features })
    };
    metadata["packages"].as_array().unwrap().iter().map(package).collect()
}

#[test]
fn rooms_know_only_what_they_may() {
    let packages = packages();
    let ours = |name: &str, kinds: &[&str]| -> BTreeSet<&str> {
        let needs = packages[name].needs(kinds);
        needs.into_iter().filter(|need| packages.contains_key(*need)).collect()
    };
    let all = ["normal", "build", "dev"];
    assert_eq!(ours("tltl-compiler", &all), [].into(), "the compiler knows nobody");
    assert_eq!(ours("tltl-macros", &all), ["tltl-compiler"].into());
    assert_eq!(ours("tltl", &["normal", "build"]), ["tltl-macros"].into());
    assert_eq!(ours("tltl", &["dev"]), ["tltl"].into(), "its tests turn its features on");
    assert_eq!(ours("tltlc", &all), ["tltl", "tltl-compiler"].into());
    let last = ["tltl-control", "tltl-examples", "tltl-fuzz", "tltl-kitchen", "tltl-tests"];
    for (name, package) in &packages {
        let is_last = last.contains(&name.as_str());
        assert!(is_last || !package.needs(&all).contains("tltlc"), "{name} depends on the tools");
        assert!(!package.features.contains("cli"), "{name}");
    }
}

/// Every user of the macros builds these: each one more costs all of them.
#[test]
fn what_users_build_is_counted() {
    let packages = packages();
    let normal = |name: &str| packages[name].needs(&["normal", "build"]);
    let compiler = ["proc-macro2", "quote", "unicode-ident"];
    assert_eq!(normal("tltl-compiler"), compiler.into());
    assert_eq!(normal("tltl-macros"), ["proc-macro2", "quote", "tltl-compiler"].into());
    assert_eq!(normal("tltl"), ["basin", "burn", "libm", "rand", "serde", "tltl-macros"].into());
}

/// The wheel is a workspace of its own, which inherits nothing: it repeats what the crates agree on.
#[test]
fn the_wheel_agrees_with_the_crates() {
    let read = |path: &str| std::fs::read_to_string(root().join(path)).unwrap();
    let (wheel, ours) = (read("python/Cargo.toml"), read("Cargo.toml"));
    let line = |text: &str, start: &str| {
        let found = text.lines().find(|line| line.starts_with(start));
        found.unwrap_or_else(|| panic!("no line starts with `{start}`")).to_owned()
    };
    let agreed =
        ["version =", "edition =", "rust-version =", "license =", "unsafe_code =", "all ="];
    for start in agreed.into_iter().chain(["missing_docs =", "unreachable_pub ="]) {
        assert_eq!(line(&wheel, start), line(&ours, start));
    }
    assert!(read("python/src/lib.rs").contains("#![forbid(unsafe_code)]"));
}

/// The modules of each crate, from those that know none of the others to those that know most.
const ORDER: [(&str, &str); 4] = [
    (
        "compiler",
        "intern source error arena reserved token ast unit proposition bdd dfa grammar parse spec predicate linear \
         arithmetic resolve check translate minimize factor judge compile hoa tables emit",
    ),
    ("macros", "tokens expand"),
    (
        "runtime",
        "shared range checksum file interner automaton formula robustness monitor task factored \
         private product model env mismatch reward episode augmented certificate estimate falsify settings \
         policy q experience solve shield learn compose controller network deep checkpoint prelude",
    ),
    (
        "tools",
        "semantics tables format evaluate online lint product task trace diff emit explain report names lsp cli",
    ),
];

/// The rooms of the runtime that only programs that learn call.
const LEARNING: &str = "augmented certificate checkpoint compose controller env estimate experience \
     factored falsify file learn model network policy product q reward shield solve task";

/// The functions that rustc makes code of where they are defined, whether or not anybody calls them.
#[derive(Default)]
struct MadeHere(Vec<String>);

impl MadeHere {
    fn add(&mut self, attributes: &[Attribute], signature: &Signature) {
        let is_generic = has_types(&signature.generics)
            || signature.inputs.to_token_stream().to_string().contains("impl ");
        if !is_generic && !attributes.iter().any(|attribute| attribute.path().is_ident("inline")) {
            self.0.push(signature.ident.to_string());
        }
    }
}

fn has_types(generics: &Generics) -> bool {
    generics.type_params().next().is_some() || generics.const_params().next().is_some()
}

impl VisitMut for MadeHere {
    fn visit_item_mod_mut(&mut self, module: &mut ItemMod) {
        if module.ident != "tests" {
            visit_mut::visit_item_mod_mut(self, module);
        }
    }

    fn visit_item_impl_mut(&mut self, block: &mut ItemImpl) {
        if !has_types(&block.generics) {
            visit_mut::visit_item_impl_mut(self, block);
        }
    }

    fn visit_item_fn_mut(&mut self, function: &mut ItemFn) {
        self.add(&function.attrs, &function.sig);
    }

    fn visit_impl_item_fn_mut(&mut self, function: &mut ImplItemFn) {
        self.add(&function.attrs, &function.sig);
    }
}

/// What learns is made where it is called: most code of the runtime, which a crate that only
/// monitors would pay for in each cold build.
#[test]
fn who_does_not_learn_does_not_pay_for_it() {
    let learning: BTreeSet<&str> = LEARNING.split_whitespace().collect();
    let mut unmarked = Vec::new();
    for (module, path) in sources(&root().join("runtime/src")) {
        if learning.contains(module.as_str()) {
            let mut file = syn::parse_file(&std::fs::read_to_string(&path).unwrap()).unwrap();
            let mut made = MadeHere::default();
            made.visit_file_mut(&mut file);
            unmarked.extend(made.0.into_iter().map(|name| format!("{}: {name}", path.display())));
        }
    }
    assert!(unmarked.is_empty(), "mark them `#[inline]`: {unmarked:#?}");
}

/// The source files under `folder` with the module of the crate that each belongs to.
fn sources(folder: &Path) -> Vec<(String, PathBuf)> {
    let mut files = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let first = path.strip_prefix(folder).unwrap().components().next().unwrap();
            let module = first.as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned();
            files.push((module, path));
        }
    }
    files.retain(|(module, _)| module != "lib" && module != "main");
    files
}

/// The modules of the crate that a text names, its tests apart: `crate::name`.
fn named<'a>(text: &'a str) -> BTreeSet<&'a str> {
    let code = text.split("\n#[cfg(test)]").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let paths = lines.flat_map(|line| line.split("crate::").skip(1));
    let word = |path: &'a str| path.split(|c: char| !c.is_alphanumeric() && c != '_').next();
    paths.filter_map(word).collect()
}

#[test]
fn no_module_knows_a_later_one() {
    for (room, order) in ORDER {
        let order: Vec<&str> = order.split(' ').collect();
        let place = |module: &str| {
            let place = order.iter().position(|known| *known == module);
            place.unwrap_or_else(|| panic!("{room}: where does `{module}` stand?"))
        };
        let mut found = BTreeSet::new();
        for (module, path) in sources(&root().join(room).join("src")) {
            let text = std::fs::read_to_string(&path).unwrap();
            for other in named(&text) {
                let path = path.display();
                assert!(!other.is_empty(), "{path}: name one module after `crate::`");
                assert!(place(other) <= place(&module), "{path}: `{module}` knows `{other}`");
            }
            found.insert(module);
        }
        assert!(order.iter().all(|module| found.contains(*module)), "{room}: {found:?}");
    }
}

/// What a registry shows of a package: all that is published says what it is, in the registry's own
/// categories, and brings its licences.
#[test]
fn packages_say_what_they_are() {
    let published = ["compiler", "macros", "runtime", "tools"];
    let ours = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let agreed = |key: &str| ours.lines().any(|line| line.starts_with(&format!("{key} = ")));
    assert!(agreed("repository") && agreed("license") && agreed("rust-version"));
    let keywords = ours.lines().find(|line| line.starts_with("keywords")).unwrap();
    assert!(keywords.matches('"').count() / 2 <= 5, "a registry takes five keywords");
    // <https://crates.io/category_slugs>
    let known = "algorithms command-line-utilities compilers development-tools embedded no-std \
                 parser-implementations science::robotics";
    for room in published {
        let folder = root().join(room);
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        for key in ["version", "edition", "rust-version", "license", "repository", "keywords"] {
            assert!(manifest.contains(&format!("\n{key}.workspace = true\n")), "{room}: {key}");
        }
        assert!(manifest.contains("\ndescription = \""), "{room}");
        assert!(manifest.contains("[package.metadata.docs.rs]\nall-features = true"), "{room}");
        let value = |key: &str| {
            let line = manifest.lines().find_map(|line| line.strip_prefix(key)).unwrap();
            line.trim_start_matches([' ', '=']).to_owned()
        };
        let categories = value("categories");
        let categories: Vec<_> = categories.split('"').skip(1).step_by(2).collect();
        assert!((1..=5).contains(&categories.len()), "{room}");
        assert!(categories.iter().all(|one| known.split(' ').any(|known| known == *one)), "{room}");
        let readme = value("readme");
        for file in [readme.trim_matches('"'), "LICENSE-MIT", "LICENSE-APACHE"] {
            assert!(folder.join(file).is_file(), "{room}: {file}");
        }
    }
    for room in ["examples", "examples/kitchen", "fuzz", "tests", "python"] {
        let manifest = std::fs::read_to_string(root().join(room).join("Cargo.toml")).unwrap();
        assert!(manifest.contains("\npublish = false\n"), "{room}");
    }
}

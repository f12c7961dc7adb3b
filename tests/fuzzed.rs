//! What fuzzing has found or found worth keeping: every committed input through its target.

use std::collections::BTreeSet;
use std::path::Path;

use tltl_fuzz::targets::ALL;

#[test]
fn corpora_hold() {
    let corpora = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus");
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries =
            std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{folder:?}: {error}"));
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    assert_eq!(names(&corpora), ALL.map(|(name, _)| name.to_owned()).into());
    for (name, target) in ALL {
        let corpus = corpora.join(name);
        let inputs = names(&corpus);
        assert!(!inputs.is_empty(), "{name}");
        for input in inputs {
            // The last one that is shown is the one that fails.
            eprintln!("{name}/{input}");
            target(&std::fs::read(corpus.join(input)).unwrap());
        }
    }
}

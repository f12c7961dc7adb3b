//! Pages of any formula: nothing of it becomes an element of the page, or leaves its data.

use std::collections::BTreeSet;

use serde_json::Value;
use tltl_compiler::parse;
use tltl_compiler::source::{Source, is_hidden};

use super::tool;

/// The elements that a page is made of.
const ELEMENTS: &str = "html head meta title style body header h1 p main section figure div svg g path circle \
                        text figcaption aside details summary ol ul li b dl dt dd code noscript script";

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // A text that is the name of a file is not meant here.
    if parse::formula(&Source::new("formula", text)).is_err() || text.starts_with('-') {
        return;
    }
    let limits = "--budget=states=100,nodes=10000,edges=1000,products=100";
    let (_, [page, _]) = tool(&["explain", text, "--format=html", limits], b"");
    if page.is_empty() {
        return;
    }
    let data = "<script type=\"application/json\" id=\"data\">";
    let (shown, rest) = page.split_once(data).expect("it has data");
    let (data, script) = rest.split_once("</script>").expect("they end");
    let data: Value = serde_json::from_str(data).expect("they are JSON");
    assert!(data["trajectories"].is_array() && script.matches("<script").count() == 1, "{text:?}");
    let (head, body) = shown.split_once("</style>").expect("it has a style");
    let title = head.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>"));
    assert!(title.is_some_and(|(title, _)| !title.contains('<')), "{text:?}");
    let known: BTreeSet<&str> = ELEMENTS.split_whitespace().collect();
    for tag in body.split('<').skip(1).map(|rest| rest.trim_start_matches('/')) {
        let name = tag.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default();
        assert!(known.contains(name), "{text:?}: <{name}");
    }
    assert!(!page.contains(|c| c != '\n' && is_hidden(c)), "{text:?}");
}

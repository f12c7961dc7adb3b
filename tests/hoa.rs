//! Automata in HOA: what is written is read back, and nothing else is taken for a task.

mod rules;

use proptest::prelude::*;
use serde_json::Value;
use tltl_compiler::compile;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::error::{Kind, Style};
use tltl_compiler::hoa::read;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::emit;

fn source(text: &str) -> Source {
    Source::new("automaton.hoa", text)
}

fn parse(text: &str) -> Dfa {
    let source = source(text);
    read(&source).unwrap_or_else(|error| panic!("{}", error.render(&source, Style::Plain))).dfa
}

fn automaton(formula: &str) -> Dfa {
    let source = Source::new("formula", formula);
    let compiled = compile::formula(&source, Budget::default()).unwrap();
    compiled.automata[0].propositional.clone()
}

/// Equal automata have equal texts, down to the order of the states.
fn written(dfa: &Dfa) -> String {
    emit::hoa::automaton("", dfa).unwrap().to_string()
}

/// A complete automaton with labels left implicit.
fn implicit(propositions: usize, table: &[Vec<usize>], accepting: &[usize]) -> String {
    let names: Vec<_> = (0..propositions).map(|i| format!("\"p{i}\"")).collect();
    let mut text = format!(
        "HOA: v1\nStates: {}\nStart: 0\nAP: {propositions} {}\nAcceptance: 1 Inf(0)\n--BODY--\n",
        table.len(),
        names.join(" ")
    );
    for (q, row) in table.iter().enumerate() {
        let mark = if accepting.contains(&q) { " {0}" } else { "" };
        let row: Vec<_> = row.iter().map(usize::to_string).collect();
        text += &format!("State: {q}{mark}\n{}\n", row.join(" "));
    }
    text + "--END--\n"
}

#[test]
fn formulas_survive_the_round_trip() {
    for formula in [
        "true",
        "false",
        "a",
        "F a",
        "F a && F b",
        "!c U a",
        "a T b T c",
        "X true",
        "X a || X !a",
        "F(a && X X b)",
        "(!h U a) && (!h U (b && F c))",
        "a || !a",
    ] {
        let dfa = automaton(formula);
        assert_eq!(written(&parse(&written(&dfa))), written(&dfa), "{formula}");
    }
}

#[test]
fn the_corpus_survives_as_tables() {
    let rows = include_str!("data/corpus.jsonl").lines();
    let mut checked = 0;
    for row in rows.map(|line| serde_json::from_str::<Value>(line).unwrap()) {
        let Some(table) = row["transitions"].as_array() else { continue };
        let numbers = |value: &Value| -> Vec<usize> {
            value.as_array().unwrap().iter().map(|n| n.as_u64().unwrap() as usize).collect()
        };
        let table: Vec<_> = table.iter().map(numbers).collect();
        let propositions = row["aps"].as_array().unwrap().len();
        let dfa = parse(&implicit(propositions, &table, &numbers(&row["accepting"])));
        assert_eq!(dfa.len(), row["states"].as_u64().unwrap() as usize, "{}", row["formula"]);
        assert_eq!(dfa.size().edges as u64, row["edges"].as_u64().unwrap(), "{}", row["formula"]);
        assert_eq!(written(&parse(&written(&dfa))), written(&dfa), "{}", row["formula"]);
        checked += 1;
    }
    assert!(checked > 100, "{checked} rows");
}

/// Tables of random automata: state 0 is initial, the last accepts and is absorbing.
fn tables() -> impl Strategy<Value = (usize, Vec<Vec<usize>>)> {
    (0..4_usize, 2..8_usize).prop_flat_map(|(propositions, states)| {
        let row = prop::collection::vec(0..states, 1 << propositions);
        let rows = prop::collection::vec(row, states - 1);
        rows.prop_map(move |mut rows| {
            rows.push(vec![states - 1; 1 << propositions]);
            (propositions, rows)
        })
    })
}

proptest! {
    #[test]
    fn random_automata_survive((propositions, table) in tables(), letters in prop::collection::vec(0..8_u32, 1..12)) {
        let accepting = table.len() - 1;
        let dfa = parse(&implicit(propositions, &table, &[accepting]));
        let again = parse(&written(&dfa));
        prop_assert_eq!(written(&again), written(&dfa));
        prop_assert_eq!(written(&minimize(&dfa)), written(&dfa));
        let (mut slow, mut fast) = (0, 0);
        for letter in letters {
            slow = table[slow][letter as usize & ((1 << propositions) - 1)];
            fast = dfa.next(fast, |p| letter >> p & 1 == 1);
            prop_assert_eq!(slow == accepting, dfa.accepting == Some(fast));
        }
    }

    /// An automaton on infinite words: a word `u v v v …` is accepted iff the run comes to the
    /// accepting state.
    #[test]
    fn decided_acceptance_is_that_of_infinite_words(
        (propositions, table) in tables(),
        (bits, inside) in (any::<u64>(), any::<bool>()),
        words in prop::collection::vec(prop::collection::vec(0..8_u32, 1..4), 20),
    ) {
        // Few marks outside the last state, and all or none there: else hardly one is terminal.
        let last = table.len() - 1;
        let marked = |q: usize, letter: usize| match q == last {
            true => inside,
            false => (bits >> ((q * 8 + letter) % 64) & 1 == 1) != inside && bits % 3 == 0,
        };
        let mut states = String::new();
        for (q, row) in table.iter().enumerate() {
            states += &format!("State: {q} ");
            for (letter, to) in row.iter().enumerate() {
                let bit = |p: usize| if letter >> p & 1 == 1 { format!("{p}") } else { format!("!{p}") };
                let label: Vec<_> = std::iter::once("t".to_owned()).chain((0..propositions).map(bit)).collect();
                let mark = if marked(q, letter) { " {0}" } else { "" };
                states += &format!("[{}] {to}{mark} ", label.join("&"));
            }
        }
        let names: String = (0..propositions).map(|i| format!(" \"p{i}\"")).collect();
        let acceptance = if inside { "Inf(0)" } else { "Fin(0)" };
        let text = format!(
            "HOA: v1 Start: 0 AP: {propositions}{names} Acceptance: 1 {acceptance} properties: terminal \
             --BODY-- {states} --END--"
        );
        let source = source(&text);
        let Ok(automaton) = read(&source) else { return Ok(()) };
        for word in words.chunks(2) {
            let letters = word[0].iter().chain(word[1].iter().cycle());
            let (mut slow, mut fast, mut seen) = (0, 0, Vec::new());
            // After as many turns as there are states, every turn is one of the cycle.
            let turns = word[0].len() + table.len() * word[1].len();
            for (t, letter) in letters.take(turns + table.len() * word[1].len()).enumerate() {
                let letter = *letter as usize & ((1 << propositions) - 1);
                if t >= turns {
                    seen.push(marked(slow, letter));
                }
                slow = table[slow][letter];
                fast = automaton.dfa.next(fast, |p| letter >> p & 1 == 1);
            }
            let accepted = seen.contains(&true) == inside;
            prop_assert_eq!(automaton.dfa.accepting == Some(fast), accepted, "{} {:?}", text, word);
        }
    }

    #[test]
    fn broken_texts_are_errors_and_never_worse(cut in 0..400_usize, at in 0..400_usize, with in "[0-9a-z@!&|()\\[\\]{}\"\\-:* \n]{0,3}") {
        let mut text = written(&automaton("(!d U a) && F b"));
        text.truncate(text.len().min(cut.max(40)));
        let at = at.min(text.len());
        text.insert_str(at, &with);
        let source = source(&text);
        if let Err(error) = read(&source) {
            prop_assert!(!error.render(&source, Style::Plain).is_empty());
        }
    }
}

const HEADER: &str = "HOA: v1\nStart: 0\nAP: 2 \"a\" \"b\"\n";

fn body(acceptance: &str, states: &str) -> String {
    format!("{HEADER}Acceptance: {acceptance}\n--BODY--\n{states}\n--END--\n")
}

#[test]
fn the_same_task_in_many_spellings() {
    let expected =
        written(&parse(&body("1 Inf(0)", "State: 0 [!0|!1] 0 [0&1] 1 State: 1 {0} [t] 1")));
    assert_eq!(expected, written(&automaton("F(a && b)")));
    for text in [
        // co-Büchi, negated sets, other set numbers
        body("1 Fin(0)", "State: 0 {0} [!0|!1] 0 [0&1] 1 State: 1 [t] 1"),
        body("1 Fin(!0)", "State: 0 [!0|!1] 0 [0&1] 1 State: 1 {0} [t] 1"),
        body("3 Inf(2)", "State: 0 {1} [!0|!1] 0 [0&1] 1 State: 1 {0 2} [t] 1"),
        // aliases, state labels, implicit labels, names, comments
        HEADER.to_owned() + "Alias: @x 0&1 Alias: @y !@x acc-name: Buchi Acceptance: 1 Inf(0)\
            --BODY-- State: 0 \"start\" [@y] 0 [@x] 1 /* goal /* nested */ */ State: [t] 1 {0} 1 --END--",
        body("1 Inf(0)", "State: 0 0 0 0 1 State: 1 {0} 1 1 1 1"),
        // marks on edges, where both readings agree
        body("1 Inf(0)", "State: 0 [!(0&1)] 0 [0&1] 1 {0} State: 1 [t] 1 {0}"),
        body("1 Fin(0)", "State: 0 [!(0&1)] 0 {0} [0&1] 1 State: 1 [t] 1"),
        // numbers with gaps, edges to the same state that overlap, states that do not matter
        "HOA: v1 Start: 7 AP: 2 \"a\" \"b\" Acceptance: 1 Inf(0) --BODY-- State: 900000000 {0} [t] \
         900000000 State: 7 [!0] 7 [!1] 7 [0&1] 900000000 State: 3 [t] 7 --END--".to_owned(),
    ] {
        assert_eq!(written(&parse(&text)), expected, "{text}");
    }
    let incomplete = body("1 Inf(0)", "State: 0 [!0&!1] 0 [1] 1 State: 1 {0} [t] 1");
    assert_eq!(written(&parse(&incomplete)), written(&automaton("!a U b")));
}

#[test]
fn acceptance_that_is_decided_is_read_wherever_its_marks_stand() {
    let promised = |text: String| text.replace("AP:", "properties: deterministic terminal AP:");
    let new = |text: String| text.replace("HOA: v1", "HOA: v1.1 some.tool: 0 [1] \"x\"");
    for (formula, text) in [
        ("b U a", body("1 Inf(0)", "State: 0 [!0&1] 0 [0] 1 State: 1 [t] 1 {0}")),
        ("b U a", body("1 Fin(0)", "State: 0 [!0&1] 0 {0} [0] 1 {0} State: 1 [t] 1")),
        ("F a", body("1 Inf(0)", "State: 0 [!0] 0 [0] 1 State: 1 [t] 2 State: 2 [t] 1 {0}")),
        (
            "F a && true || F b && false",
            body("1 Inf(0)", "State: 0 [!0] 0 [0] 1 {0} State: 1 [t] 1 {0}"),
        ),
        ("a && X b", body("0 t", "State: 0 [0] 1 State: 1 [1] 2 State: 2 [t] 2")),
        (
            "a && X b",
            promised(body("1 Inf(0)", "State: 0 {0} [0] 1 State: 1 [1] 2 State: 2 {0} [t] 2")),
        ),
        ("F a", promised(new(body("1 Inf(0)", "State: 0 [!0] 0 [0] 1 State: 1 {0} [t] 1")))),
        (
            "F a",
            new(body("1 Inf(0)", "State: 0 [!0] 0 [0] 1 State: 1 {0} [t] 1"))
                .replace("AP:", "properties: !terminal !weak AP:"),
        ),
    ] {
        let names = ["a", "b"].map(|name| format!("({name} || !{name})")).join(" && ");
        let expected = automaton(&format!("({names}) && ({formula})"));
        assert_eq!(written(&parse(&text)), written(&expected), "{text}");
    }
}

#[test]
fn what_no_formula_is_gets_refused() {
    let refused = [
        ("nondeterministic", body("1 Inf(0)", "State: 0 [0] 0 [0|1] 1 State: 1 {0} [t] 1")),
        ("alternating", body("1 Inf(0)", "State: 0 [0] 0&1 State: 1 {0} [t] 1")),
        ("generalized", body("2 Inf(0)&Inf(1)", "State: 0 {0 1} [t] 0")),
        ("left", body("1 Inf(0)", "State: 0 [t] 1 State: 1 {0} [0] 1 [!0] 0")),
        ("left_for_nowhere", body("1 Inf(0)", "State: 0 [t] 1 State: 1 {0} [0] 1")),
        ("edge_marks", body("1 Inf(0)", "State: 0 [!0] 0 [0] 0 {0}")),
        ("left_for_good", body("1 Inf(0)", "State: 0 [0] 1 State: 1 {0} [t] 2 State: 2 [t] 2")),
        ("no_good_end", body("0 t", "State: 0 [0] 0")),
        ("several_starts", body("1 Inf(0)", "State: 0 [t] 0").replace("AP:", "Start: 1 AP:")),
        ("unknown_header", body("1 Inf(0)", "State: 0 [t] 0").replace("AP:", "Fancy: 1 AP:")),
    ];
    check("refused", &refused, Kind::Automaton);
}

#[test]
fn what_is_no_hoa_is_a_syntax_error() {
    let broken = [
        ("empty", String::new()),
        ("version", "HOA: v2".to_owned()),
        ("no_acceptance", format!("{HEADER}--BODY-- --END--")),
        ("abort", format!("{HEADER}Acceptance: 1 Inf(0) --BODY-- State: 0 --ABORT--")),
        ("undescribed", body("1 Inf(0)", "State: 0 [t] 5")),
        ("twice", body("1 Inf(0)", "State: 0 [t] 0 State: 0 [t] 0")),
        ("proposition", body("1 Inf(0)", "State: 0 [2] 0")),
        ("alias", body("1 Inf(0)", "State: 0 [@x] 0")),
        ("bracket", body("1 Inf(0)", "State: 0 [(0] 0")),
        ("row", body("1 Inf(0)", "State: 0 0 0 0")),
        ("string", "HOA: v1 name: \"x".to_owned()),
        ("second", body("1 Inf(0)", "State: 0 [t] 0") + "HOA: v1"),
    ];
    check("broken", &broken, Kind::Syntax);
}

fn check(group: &str, texts: &[(&str, String)], kind: Kind) {
    let mut reports = String::new();
    for (name, text) in texts {
        let source = source(text);
        let error = read(&source).expect_err(name);
        assert_eq!(error.kind(), kind, "{name}: {error}");
        reports += &format!("# {name}\n{}\n", error.render(&source, Style::Plain));
    }
    insta::assert_snapshot!(group, reports);
}

#[test]
fn deep_and_huge_texts_do_not_crash() {
    let deep = |open: &str, close: &str, count: usize| {
        let label = open.repeat(count) + "0" + &close.repeat(count);
        body("1 Inf(0)", &format!("State: 0 [{label}] 1 State: 1 {{0}} [t] 1"))
    };
    assert_eq!(parse(&deep("(", ")", 100_000)).len(), 3);
    assert_eq!(parse(&deep("!", "", 100_000)).len(), 3);
    assert_eq!(parse(&deep("0&", "", 100_000)).len(), 3);
    assert!(read(&source(&deep("(", "", 100_000))).is_err());
    assert!(read(&source(&format!("HOA: v1 {}", "/*".repeat(100_000)))).is_err());
    let wide = |count: usize| {
        let names: String = (0..count).map(|i| format!(" \"p{i}\"")).collect();
        let label: Vec<_> = (0..count).map(|i| i.to_string()).collect();
        format!(
            "HOA: v1 Start: 0 AP: {count}{names} Acceptance: 1 Inf(0) --BODY-- \
             State: 0 [{}] 1 State: 1 {{0}} [t] 1 --END--",
            label.join("&")
        )
    };
    assert_eq!(parse(&wide(512)).len(), 3);
    assert_eq!(
        written(&parse(&written(&parse(&wide(512))))).len(),
        written(&parse(&wide(512))).len()
    );
    assert!(read(&source(&wide(513))).is_err());
}

/// What is written keeps the rules of the format, and is the automaton.
fn keeps_the_rules(title: &str, dfa: &Dfa) -> Result<(), String> {
    let strict = rules::read(&emit::hoa::automaton(title, dfa).unwrap().to_string())?;
    let names: Vec<_> = strict.propositions.iter().map(String::as_str).collect();
    assert_eq!(dfa.propositions, names);
    assert_eq!((strict.start, strict.accepting.len()), (0, dfa.len()));
    for q in dfa.states() {
        assert_eq!(strict.accepting[q as usize], dfa.accepting == Some(q), "{title}, state {q}");
        for letter in 0..1_u32 << dfa.propositions.len() {
            let to = dfa.next(q, |p| letter >> p & 1 == 1);
            assert_eq!(strict.next(q as usize, letter), to as usize, "{title}, {q}, {letter:b}");
        }
    }
    Ok(())
}

#[test]
fn what_is_written_keeps_the_rules() {
    let rows = include_str!("data/corpus.jsonl").lines();
    let mut checked = 0;
    for row in rows.map(|line| serde_json::from_str::<Value>(line).unwrap()) {
        let formula = row["formula"].as_str().unwrap();
        let dfa = automaton(formula);
        if dfa.propositions.len() <= 10 && dfa.len() <= 200 {
            keeps_the_rules(formula, &dfa).unwrap_or_else(|rule| panic!("{formula}: {rule}"));
            checked += 1;
        }
    }
    assert!(checked > 200, "{checked} automata");
    let source = Source::new("formula", "x < 3 U (x > 5 && !(y == 2) && 1 < z)");
    let compiled = compile::formula(&source, Budget::default()).unwrap();
    let mut dfa = compiled.automata[0].dfa.clone();
    keeps_the_rules("what arithmetic left", &dfa).unwrap();
    dfa.propositions[0].name = "two \"lines\"\n and \\ [0] --END--".to_owned();
    keeps_the_rules("a \"title\" with\nall \\ of it", &dfa).unwrap();
}

#[test]
fn the_rules_are_strict() {
    let text = emit::hoa::automaton("t", &automaton("!c U a")).unwrap().to_string();
    rules::read(&text).unwrap();
    for (from, to) in [
        ("HOA: v1", "HOA: v2"),
        ("States: 3", "States: 4"),
        ("States: 3", "States: 2"),
        ("Start: 0", "Start: 3"),
        ("Start: 0\n", ""),
        ("AP: 2", "AP: 3"),
        ("AP: 2 \"c\"", "AP: 2 \"a\""),
        ("\"c\"", "\"c"),
        ("Acceptance: 1 Inf(0)\n", ""),
        ("Inf(0)", "Fin(0)"),
        ("acc-name: Buchi", "acc-name: co-Buchi"),
        ("acc-name: Buchi", "acc-name: Buchi\nacc-name: Buchi"),
        ("deterministic", "deterministic unambiguous"),
        ("--BODY--", "BODY"),
        ("--END--\n", ""),
        ("--END--\n", "--END--\nState: 3\n"),
        ("State: 1 {0}", "State: 1 {1}"),
        ("State: 1 {0}", "State: 0 {0}"),
        ("State: 0\n", "State: 0 {0}\n"),
        ("[1] 1", "[1] 3"),
        ("[1] 1", "[2] 1"),
        ("[1] 1", "[!1] 1"),
        ("[1] 1", "[0&1] 1"),
        ("[1] 1", "1"),
        ("[1] 1", "[01] 1"),
        ("[1] 1", "[1 1"),
    ] {
        assert!(text.contains(from), "{from} is not in {text}");
        assert!(rules::read(&text.replacen(from, to, 1)).is_err(), "{from} as {to}");
    }
}

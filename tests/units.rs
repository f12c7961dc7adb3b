//! Units: one normal form, whatever was written; the same in files and in tokens; nothing that a
//! program can see but documentation.

use proptest::prelude::*;
use tltl::include_tltl;
use tltl_compiler::check;
use tltl_compiler::compile;
use tltl_compiler::error::Style;
use tltl_compiler::predicate::{Module, State};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltl_compiler::unit::{MOST_NAMES, MOST_POWER, Unit};
use tltlc::emit::rust;

include_tltl!("data/units.tltl");
include_tltl!("data/units.tltl", state = Cart, mod = own);

/// A state of one's own, whose units the file says.
struct Cart {
    x: f64,
    speed: f32,
    turns: [f64; 2],
    load: f64,
}

const CARTS: [(f64, f32, [f64; 2], bool); 3] =
    [(0.0, 1.5, [0.0, 2.0], true), (0.0, 2.5, [0.0, 2.0], false), (1.5, 1.0, [0.0, 2.0], false)];

#[test]
fn units_change_nothing_that_runs() {
    for (x, speed, turns, expected) in CARTS {
        let declared = units::Cart { x, speed, turns, load: 0.5 };
        let mine = Cart { x, speed, turns, load: 0.5 };
        assert_eq!(units::halt(2.0).satisfied(&[declared]), Ok(expected));
        assert_eq!(own::halt(2.0).satisfied(&[mine]), Ok(expected));
    }
    let without = |text: &str| {
        let units = [" in m/s", " in rad/deg", " in deg", " in s", " in m"];
        units.iter().fold(text.to_owned(), |text, unit| text.replace(unit, ""))
    };
    let text = include_str!("data/units.tltl");
    let code = |text: &str| {
        let source = Source::new("units.tltl", text);
        let compiled = compile::file(&source, Budget::default()).unwrap();
        let undocumented = |line: &&str| !line.trim_start().starts_with("///");
        let file = rust::file(&compiled);
        (file.lines().filter(undocumented).collect::<Vec<_>>().join("\n"), file)
    };
    let ((measured, documented), (plain, _)) = (code(text), code(&without(text)));
    assert_eq!(measured, plain);
    for docs in ["/// How fast.\n    ///\n    /// It is in m/s.\n", "/// `d` is in m.\n"] {
        assert!(documented.contains(docs), "{documented}");
    }
}

/// The units of the fields of a state.
fn fields(module: &Module) -> Vec<Unit> {
    let State::Declared(state) = &module.state else { panic!("no state") };
    state.fields.iter().map(|field| field.unit.clone().unwrap()).collect()
}

fn read(units: &[String]) -> Module {
    let field = |(i, unit): (usize, &String)| format!("x{i}: f64 in {unit},");
    let fields: String = units.iter().enumerate().map(field).collect();
    let source = Source::new("task.tltl", format!("state S {{ {fields} }}"));
    check::file(&source).unwrap_or_else(|errors| panic!("{}", errors.render(&source, Style::Plain)))
}

type Powers = Vec<(usize, i32)>;

/// Names with powers, none of them beyond the bounds, in two orders, and a way to write them.
fn powers() -> impl Strategy<Value = (Powers, Powers, u64)> {
    let one = (0..NAMES.len(), -9..=9_i32);
    let powers = prop::collection::vec(one, 0..10);
    powers.prop_flat_map(|powers| (Just(powers.clone()), Just(powers).prop_shuffle(), any::<u64>()))
}

const NAMES: [&str; 7] = ["m", "s", "kg", "F", "in_", "task", "Ω"];

/// A product of powers, each after `*` or `/` as the bits of `choices` say.
fn written(powers: &[(usize, i32)], choices: u64) -> String {
    let mut text = String::from("1");
    for (at, &(name, power)) in powers.iter().enumerate() {
        let (divides, blank) = (choices >> at & 1 == 1, choices >> (at + 16) & 1 == 1);
        let (symbol, power) = if divides { ('/', -power) } else { ('*', power) };
        let blank = if blank { " " } else { "" };
        let name = NAMES[name];
        text += &match power {
            1 => format!("{blank}{symbol}{blank}{name}"),
            _ => format!("{blank}{symbol}{name}{blank}^{blank}{power}"),
        };
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_order_of_factors_does_not_matter((first, second, choices) in powers()) {
        let module = read(&[written(&first, choices), written(&second, !choices)]);
        let known = fields(&module);
        prop_assert_eq!(&known[0], &known[1]);
        let text = module.units.text(&known[0]);
        let again = read(std::slice::from_ref(&text));
        prop_assert_eq!(again.units.text(&fields(&again)[0]), text);
    }

    #[test]
    fn units_are_a_group((first, second, choices) in powers()) {
        let (a, b) = first.split_at(first.len() / 2);
        let module = read(&[written(a, choices), written(b, choices), written(&second, choices)]);
        let [a, b, whole] = &fields(&module)[..] else { panic!() };
        let product = a.times(b).unwrap();
        prop_assert_eq!(&product, whole);
        prop_assert_eq!(&product, &b.times(a).unwrap());
        prop_assert_eq!(&product.over(b).unwrap(), a);
        prop_assert!(a.over(a).unwrap().is_plain());
        if let Some(square) = a.power(2) {
            prop_assert_eq!(&square, &a.times(a).unwrap());
            prop_assert_eq!(&square.root().unwrap(), a);
        }
    }

    #[test]
    fn no_unit_is_too_strange(unit in "[ms1-9_^*/ .()-]{0,12}") {
        for text in [
            format!("state S {{ x: f64 in {unit}, y: f64 in m }}\ntask t = F (x < y * y)"),
            format!("const c in {unit} = 1\ntask t = F true"),
        ] {
            let source = Source::new("task.tltl", text);
            let told = [check::file(&source), check::fragment(&source)];
            for errors in told.into_iter().filter_map(Result::err) {
                prop_assert!(!errors.render(&source, Style::Plain).is_empty());
            }
        }
    }
}

#[test]
fn units_are_bounded() {
    let mistakes = |text: String| {
        let source = Source::new("task.tltl", text);
        let errors = check::file(&source).unwrap_err();
        errors.iter().map(|error| error.message().to_owned()).collect::<Vec<_>>()
    };
    let many: Vec<_> = (0..=MOST_NAMES).map(|i| format!("u{i}")).collect();
    let state = |unit: &str| format!("state S {{ x: f64 in {unit} }}");
    assert_eq!(mistakes(state(&many.join("*"))), ["this unit is too large"]);
    assert_eq!(mistakes(state(&format!("m^{}", MOST_POWER + 1))), ["this power is too large"]);
    assert_eq!(mistakes(state(&format!("m^{}", "9".repeat(99_999)))), ["this power is too large"]);
    assert_eq!(mistakes(state(&format!("m{}", "*m".repeat(99_999)))), ["this unit is too large"]);
    let cancelled = state(&format!("m{}{}", "*m".repeat(9_999), "/m".repeat(9_999)));
    check::file(&Source::new("task.tltl", cancelled)).unwrap();
    // A product of ever more names, and powers of powers.
    let fields: String = (0..2_000).map(|i| format!("x{i}: f64 in u{i}, ")).collect();
    let product: Vec<_> = (0..2_000).map(|i| format!("x{i}")).collect();
    let product = product.join(" * ");
    let told = mistakes(format!("state S {{ {fields} }} predicate p = {product} < 1"));
    assert_eq!(told.len(), 1, "{told:?}");
    let power = "pow(".repeat(2_000) + "x" + &", 7)".repeat(2_000);
    let told = mistakes(format!("{} predicate p = {power} < 1", state("m")));
    assert_eq!(told.len(), 1, "{told:?}");
}

//! Sources whose names are chosen to be mistaken for something else, and what to run them on.

use std::collections::BTreeMap;

use tltlc::task::Value;

use crate::random::{Choices, Seeded};

/// Words of generated code, of Rust and its prelude, of the runtime and of this language. Some are
/// one word in Rust, and sources that give both to one scope are refused.
const WORDS: &str = "\
    s state __s __state s_ __tltl_s ___tltl_s __tltl_ i f index i_ c0 c1 c2 c3 c4 c5 c6 t0 t1 \
    t2 t3 t4 t5 t6 t7 t8 t9 t10 t11 t12 t13 t14 t15 t16 t17 t18 t19 t20 p0 P0 __P0 __S __R \
    __Predicates __TLTL_FORMULA __TLTL_AUTOMATON __TLTL_PARTS FORMULA AUTOMATON PARTS ALL \
    from_index None Some Ok Err self self_ Self super crate crate_ _ __ in type match r#fn \
    async dyn gen union auto default macro_rules raw main core std tltl f64 bool usize u8 str \
    Option Result Clone Copy Debug PartialEq Sized From Task Shared Formula Automaton \
    Factored Predicate Predicates Tables Transitions Table Part NotANumber Op Is And Not \
    Eventually True trusted from_static robustness holds with_scratch private number truth \
    less automaton factored primitive option drop assert DENSE straight rows signal Typed typed \
    Formula Until Now Within e x1e5 été Ω 數 a b";

/// Words that a variable and a constant of Rust can be.
const VARIABLES: &str = "\
    s state __s __state i f index c0 c1 c2 c3 c4 t0 t1 t2 t3 t4 t5 t6 t7 t8 t9 t10 t11 t12 \
    t13 t14 t15 t16 p0 P0 __S __R __P0 __Predicates FORMULA AUTOMATON PARTS ALL r#in r#type \
    r#match union core tltl f64 robustness holds number private self_ Task Shared Op Is été \
    drop r#async default";

/// What a place, a parameter or a constant is.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Number,
    Whole,
    Truth,
    Value,
    Optional,
}

/// A task and its arguments, each by the name of its parameter, for the tool and as Rust.
pub(crate) struct Call {
    pub(crate) task: String,
    pub(crate) arguments: Vec<(String, Value, String)>,
}

/// A source, and what to run it on.
pub(crate) struct Case {
    /// The task file.
    pub(crate) file: String,
    /// The state as a struct of Rust, constants, and the items over that struct; none if the source
    /// is about what only a file has.
    pub(crate) rust: Option<Rust>,
    pub(crate) calls: Vec<Call>,
    /// The states of a trajectory: what each place holds, by its name.
    pub(crate) states: Vec<BTreeMap<String, f64>>,
    names: Names,
}

/// A source within a program.
pub(crate) struct Rust {
    pub(crate) state: String,
    pub(crate) constants: String,
    pub(crate) items: String,
    /// A formula with its header, and the task of the file that is the same.
    pub(crate) formula: String,
    pub(crate) variables: String,
}

/// The names of the declarations, which all sources have alike.
struct Names {
    state: &'static str,
    fields: [&'static str; 6],
    /// Of the enumeration; a source for a program has none.
    kinds: Option<(&'static str, [&'static str; 5], [&'static str; 3])>,
    record: (&'static str, [&'static str; 2]),
}

/// How a name of the source is written in Rust.
pub(crate) fn rust(name: &str) -> String {
    match name {
        "self" | "Self" | "super" | "crate" | "_" => format!("{name}_"),
        "in" | "type" | "match" | "async" | "dyn" | "gen" => format!("r#{name}"),
        _ => name.to_owned(),
    }
}

/// Writes one source.
struct Writer {
    choices: Seeded,
    words: Vec<&'static str>,
    places: Vec<(String, Kind)>,
    constants: Vec<(&'static str, f64)>,
    parameters: Vec<(&'static str, Kind)>,
    predicates: Vec<(&'static str, Vec<(&'static str, Kind)>)>,
    enumeration: Option<(&'static str, [&'static str; 5])>,
}

impl Case {
    /// The source of a seed: for a file, or for a program too.
    pub(crate) fn new(seed: u64, in_program: bool) -> Self {
        let words: Vec<_> = if in_program { VARIABLES } else { WORDS }.split(' ').collect();
        let mut writer = Writer {
            choices: Seeded(seed),
            words: words.clone(),
            places: Vec::new(),
            constants: Vec::new(),
            parameters: Vec::new(),
            predicates: Vec::new(),
            enumeration: None,
        };
        let names = writer.names(&words, in_program);
        writer.constants = [1.5, -2.0].map(|value| (writer.word(), value)).to_vec();
        let predicates: Vec<_> = (0..3).map(|_| writer.predicate()).collect();
        let tasks: Vec<_> = (0..2).map(|at| writer.task(at == 1)).collect();
        let (variable, formula) = (writer.word(), writer.bare());
        let items = predicates.iter().chain(tasks.iter().map(|(text, _)| text));
        let items: String = items.map(|item| format!("{item};\n")).collect();
        let states = (0..3).map(|_| writer.state()).collect();
        let constants = writer.constants.iter();
        let declared: String =
            constants.clone().map(|(name, value)| format!("const {name} = {value}\n")).collect();
        let task = format!("task {variable} = {formula};\n");
        let file = format!("{}{declared}{items}{task}", names.declared()).replace('§', "");
        let mut calls: Vec<_> = tasks.into_iter().map(|(_, call)| call).collect();
        let program = in_program.then(|| Rust {
            state: names.structs(),
            constants: constants
                .clone()
                .map(|(name, value)| {
                    format!(
                        "#[allow(dead_code)]\nconst {name}: ::core::primitive::f64 = {value:?};\n"
                    )
                })
                .collect(),
            items: format!("state {variable}: super::w::{};\n{items}", names.state)
                .replace('§', &format!("{variable}.")),
            formula: format!("|{variable}: &super::w::{}| {formula}", names.state)
                .replace('§', &format!("{variable}.")),
            variables: constants
                .map(|(name, value)| format!("let {name} = {value:?};\nlet _ = {name};\n"))
                .collect(),
        });
        calls.push(Call { task: variable.to_owned(), arguments: Vec::new() });
        Self { file, rust: program, calls, states, names }
    }

    /// The states as values of the struct in the module `within`.
    pub(crate) fn values(&self, within: &str) -> String {
        let values = self.states.iter().map(|state| self.names.value(within, state));
        format!("[{}]", values.collect::<Vec<_>>().join(", "))
    }
}

impl Names {
    /// The types and the state as the language has them.
    fn declared(&self) -> String {
        let [x, y, n, on, list, part] = self.fields;
        let (record, [z, w]) = self.record;
        let Some((kind, variants, [m, o, table])) = self.kinds else {
            return format!(
                "struct {record} {{ {z}: f64 }}\nstate {} {{ {x}: f64, {y}: f64, {n}: u8, \
                 {on}: bool, {list}: [f64; 3], {part}: {record} }}\n",
                self.state
            );
        };
        format!(
            "/// No comment: \u{202e}\u{2066}\u{1b}[31m \r */\nenum {kind} {{ {} }}\nstruct {record} {{ {z}: f64, {w}: {kind}? }}\nstate {} {{ \
             {x}: f64, {y}: f64, {n}: u8, {on}: bool, {list}: [f64; 3], {part}: {record}, \
             {m}: {kind}, {o}: {kind}?, {table}: [f64; {kind}] }}\n",
            variants.join(", "),
            self.state
        )
    }

    /// The types and the state as Rust has them.
    fn structs(&self) -> String {
        let [x, y, n, on, list, part] = self.fields;
        let (record, [z, _]) = self.record;
        format!(
            "#[derive(::core::clone::Clone, ::core::marker::Copy)]\npub struct {record} {{ pub {z}: \
             ::core::primitive::f64 }}\npub struct {} {{ pub {x}: ::core::primitive::f64, pub {y}: \
             ::core::primitive::f64, pub {n}: ::core::primitive::u8, pub {on}: \
             ::core::primitive::bool, pub {list}: [::core::primitive::f64; 3], pub {part}: {record} }}",
            self.state
        )
    }

    /// A state as a value.
    fn value(&self, within: &str, state: &BTreeMap<String, f64>) -> String {
        let [x, y, n, on, list, part] = self.fields;
        let (record, [z, w]) = self.record;
        let of = |name: &str| state[name];
        let kind = |name: &str| {
            self.kinds.map(|(kind, variants, _)| {
                let at = of(name);
                let value = variants.get(at as usize).filter(|_| at >= 0.0);
                value.map(|value| format!("{within}::{}::{}", rust(kind), rust(value)))
            })
        };
        let optional = |name: &str| match kind(name).flatten() {
            Some(value) => format!("Some({value})"),
            None => "None".to_owned(),
        };
        let mut extra = String::new();
        let mut inner = String::new();
        if let Some((_, variants, [m, o, table])) = self.kinds {
            let table_values =
                variants.map(|value| format!("{:?}", of(&format!("{table}[{value}]"))));
            extra = format!(
                ", {}: {}, {}: {}, {}: [{}]",
                rust(m),
                kind(m).flatten().unwrap(),
                rust(o),
                optional(o),
                rust(table),
                table_values.join(", ")
            );
            inner = format!(", {}: {}", rust(w), optional(&format!("{part}.{w}")));
        }
        let items = [0, 1, 2].map(|i| format!("{:?}", of(&format!("{list}[{i}]"))));
        format!(
            "{within}::{} {{ {}: {:?}, {}: {:?}, {}: {}, {}: {}, {}: [{}], {}: {within}::{} {{ \
             {}: {:?}{inner} }}{extra} }}",
            rust(self.state),
            rust(x),
            of(x),
            rust(y),
            of(y),
            rust(n),
            of(n),
            rust(on),
            of(on) > 0.0,
            rust(list),
            items.join(", "),
            rust(part),
            rust(record),
            rust(z),
            of(&format!("{part}.{z}")),
        )
    }
}

impl Writer {
    fn below(&mut self, count: usize) -> usize {
        self.choices.choose(count as u32) as usize
    }

    /// A word that is the only one of its scope.
    fn word(&mut self) -> &'static str {
        let at = self.below(self.words.len());
        self.words.swap_remove(at)
    }

    /// A word for a type: a type that is called like one of the language's own cannot be named.
    fn type_word(&mut self) -> &'static str {
        loop {
            let word = self.word();
            if !["f64", "bool", "u8"].contains(&word) {
                return word;
            }
        }
    }

    /// Words of a scope of their own.
    fn own<const N: usize>(&mut self, words: &[&'static str]) -> [&'static str; N] {
        let mut words = words.to_vec();
        std::array::from_fn(|_| {
            let at = self.below(words.len());
            words.swap_remove(at)
        })
    }

    /// The names of types and fields, and the places that they make.
    fn names(&mut self, words: &[&'static str], in_program: bool) -> Names {
        let fields = std::array::from_fn(|_| self.word());
        let record = (self.type_word(), self.own(words));
        let [x, y, n, on, list, part] = fields;
        let [z, w]: [&str; 2] = record.1;
        let mut places = vec![
            (x.to_owned(), Kind::Number),
            (y.to_owned(), Kind::Number),
            (n.to_owned(), Kind::Whole),
            (on.to_owned(), Kind::Truth),
            (format!("{part}.{z}"), Kind::Number),
        ];
        places.extend([0, 1, 2].map(|i| (format!("{list}[{i}]"), Kind::Number)));
        let kinds = (!in_program).then(|| {
            let (kind, variants, fields) =
                (self.type_word(), self.own(words), [(); 3].map(|()| self.word()));
            let [m, o, table] = fields;
            places.extend([(m.to_owned(), Kind::Value), (o.to_owned(), Kind::Optional)]);
            places.push((format!("{part}.{w}"), Kind::Optional));
            places
                .extend(variants.map(|value| (format!("{table}[{kind}::{value}]"), Kind::Number)));
            self.enumeration = Some((kind, variants));
            (kind, variants, fields)
        });
        self.places = places;
        Names { state: self.word(), fields, kinds, record }
    }

    /// What a state holds.
    fn state(&mut self) -> BTreeMap<String, f64> {
        let places = self.places.clone();
        let held = places.into_iter().map(|(name, kind)| {
            let value = match kind {
                Kind::Number => [-2.0, -1.0, -0.5, 0.0, 0.25, 1.0, 1.5, 2.0, 7.0][self.below(9)],
                Kind::Whole => self.below(4) as f64,
                Kind::Truth => self.below(2) as f64,
                Kind::Value => self.below(5) as f64,
                Kind::Optional => self.below(6) as f64 - 1.0,
            };
            // The tool does not say of which enumeration the index of a table is.
            let of = self.enumeration.map_or("", |(of, _)| of);
            (name.replace(&format!("[{of}::"), "["), value)
        });
        held.collect()
    }

    /// Parameters, which are in scope from now on, as they are declared. The tool puts the arguments
    /// of a task in their place, and what then depends on no state is a constant to it: so every
    /// comparison reads a place, and a task takes no truth value.
    fn declare_parameters(&mut self, of_task: bool) -> String {
        let truth = if of_task { Kind::Number } else { Kind::Truth };
        let kinds = match self.enumeration {
            Some(_) => [Kind::Number, Kind::Whole, truth, Kind::Value, Kind::Optional],
            None => [Kind::Number, Kind::Whole, truth, Kind::Number, Kind::Number],
        };
        let count = self.below(6);
        self.parameters = (0..count).map(|_| (self.word(), kinds[self.below(5)])).collect();
        let declared = self.parameters.iter().map(|(name, kind)| {
            let of = self.enumeration.map_or("", |(name, _)| name);
            match kind {
                Kind::Number => format!("{name}: f64"),
                Kind::Whole => format!("{name}: u8"),
                Kind::Truth => format!("{name}: bool"),
                Kind::Value => format!("{name}: {of}"),
                Kind::Optional => format!("{name}: {of}?"),
            }
        });
        let declared = declared.collect::<Vec<_>>().join(", ");
        if declared.is_empty() { declared } else { format!("({declared})") }
    }

    fn predicate(&mut self) -> String {
        let (name, parameters) = (self.word(), self.declare_parameters(false));
        let mut condition = self.condition(2);
        for (known, takes) in self.predicates.clone() {
            // Used twice, it is a local of the code.
            let used = self.applied(known, &takes);
            condition = format!("({used} || {condition}) && ({used} || {})", self.condition(0));
        }
        self.predicates.push((name, std::mem::take(&mut self.parameters)));
        format!("predicate {name}{parameters} = {condition}")
    }

    fn task(&mut self, factored: bool) -> (String, Call) {
        let (name, declared) = (self.word(), self.declare_parameters(true));
        let formula = self.formula();
        let parameters = std::mem::take(&mut self.parameters);
        let arguments = parameters.into_iter().map(|(name, kind)| {
            let (value, code) = self.argument(kind);
            (name.to_owned(), value, code)
        });
        let call = Call { task: name.to_owned(), arguments: arguments.collect() };
        let attribute = if factored { "#[factored]\n" } else { "" };
        (format!("{attribute}task {name}{declared} = {formula}"), call)
    }

    /// A value for a parameter, for the tool and as Rust; `§` is the module.
    fn argument(&mut self, kind: Kind) -> (Value, String) {
        let at = self.below(5);
        let named = |(of, variants): (&str, [&str; 5])| {
            let value = variants[at];
            (format!("{of}::{value}"), format!("§::{}::{}", rust(of), rust(value)))
        };
        match (kind, self.enumeration.map(named)) {
            (Kind::Number, _) => {
                let number = [-1.0, 0.5, 1.0, 2.0, 3.5][at];
                (Value::Number(number), format!("{number:?}"))
            }
            (Kind::Value, Some((text, code))) => (Value::Text(text), code),
            (Kind::Optional, _) if at == 0 => (Value::Text("none".to_owned()), "None".to_owned()),
            (Kind::Optional, Some((text, code))) => (Value::Text(text), format!("Some({code})")),
            _ => (Value::Number(at as f64), at.to_string()),
        }
    }

    /// A formula over all predicates.
    fn formula(&mut self) -> String {
        let mut parts = Vec::new();
        for (name, takes) in self.predicates.clone() {
            let applied = self.applied(name, &takes);
            let condition = self.condition(1);
            parts.push(match self.below(3) {
                0 => format!("F {applied}"),
                1 => format!("(({condition}) U {applied})"),
                _ => format!("X (({applied}) || {condition})"),
            });
        }
        parts.join(" && ")
    }

    /// A formula over the state alone.
    fn bare(&mut self) -> String {
        let [a, b, c] = [1, 0, 0].map(|depth| self.condition(depth));
        format!("F ({a}) && (({b}) U ({c}))")
    }

    /// A predicate with arguments from what is in scope.
    fn applied(&mut self, name: &str, takes: &[(&str, Kind)]) -> String {
        let arguments = takes.iter().map(|(_, kind)| match kind {
            Kind::Number => self.number(0),
            Kind::Truth => self.named(&[Kind::Truth], false).unwrap_or_default(),
            kind => match self.named(&[*kind], true) {
                Some(name) if self.below(2) == 0 => name,
                _ => self.constant(*kind),
            },
        });
        let arguments = arguments.collect::<Vec<_>>().join(", ");
        if arguments.is_empty() { name.to_owned() } else { format!("{name}({arguments})") }
    }

    fn constant(&mut self, kind: Kind) -> String {
        let (of, variants) = self.enumeration.unwrap_or_default();
        match kind {
            Kind::Optional if self.below(3) == 0 => "none".to_owned(),
            Kind::Value | Kind::Optional => format!("{of}::{}", variants[self.below(5)]),
            _ => self.below(4).to_string(),
        }
    }

    /// A parameter of one of these kinds, or a place.
    fn named(&mut self, kinds: &[Kind], parameter: bool) -> Option<String> {
        let parameters = self.parameters.iter().filter(|(_, kind)| kinds.contains(kind));
        let mut names: Vec<_> = parameters.map(|(name, _)| (*name).to_owned()).collect();
        if !parameter {
            let places = self.places.iter().filter(|(_, kind)| kinds.contains(kind));
            names.extend(places.map(|(name, _)| format!("§{name}")));
        }
        (!names.is_empty()).then(|| names.swap_remove(self.below(names.len())))
    }

    fn place(&mut self, kind: Kind) -> String {
        let places: Vec<_> = self.places.iter().filter(|(_, known)| *known == kind).collect();
        let names: Vec<_> = places.into_iter().map(|(name, _)| name.clone()).collect();
        format!("§{}", names[self.below(names.len())])
    }

    fn number(&mut self, depth: u32) -> String {
        if depth == 0 {
            let constant = self.below(2);
            return match self.below(4) {
                0 => self.constants[constant].0.to_owned(),
                1 => [".5", "1", "2", "3e0"][self.below(4)].to_owned(),
                _ => self.named(&[Kind::Number, Kind::Whole], false).unwrap_or_default(),
            };
        }
        let (a, b) = (self.number(depth - 1), self.number(depth - 1));
        match self.below(6) {
            0 => format!("({a} - {b})"),
            1 => format!("2 * {a}"),
            2 => format!("min({a}, {b})"),
            // So deep that it is cut by a local.
            3 => format!("{}{a}{}", "(1 + ".repeat(14), ")".repeat(14)),
            4 => format!("abs({a})"),
            _ => format!("({a} + {b})"),
        }
    }

    fn condition(&mut self, depth: u32) -> String {
        if depth > 0 {
            let (a, b) = (self.condition(depth - 1), self.condition(depth - 1));
            return match self.below(4) {
                0 => format!("!({a})"),
                1 => format!("({a} && {b})"),
                _ => format!("({a} || {b})"),
            };
        }
        let kinds = if self.enumeration.is_some() { 6 } else { 4 };
        match self.below(kinds) {
            0 => self.named(&[Kind::Truth], false).unwrap_or_default(),
            4 => {
                let place = self.place(Kind::Value);
                let parameter = self.named(&[Kind::Value], true);
                let other = parameter.unwrap_or_else(|| self.constant(Kind::Value));
                format!("{place} == {other}")
            }
            5 => {
                let place = self.place(Kind::Optional);
                let parameter = self.named(&[Kind::Optional], true);
                let other = parameter.unwrap_or_else(|| self.constant(Kind::Optional));
                format!("{place} != {other}")
            }
            other => {
                let (a, b, place) = (self.number(1), self.number(0), self.place(Kind::Number));
                format!("{a} + {place} {} {b}", ["<", ">=", "!="][other - 1])
            }
        }
    }
}

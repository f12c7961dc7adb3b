//! Emitted tables as the runtime's automata, without a compiler: the Rust text is read as data.

use std::collections::HashMap;

use syn::{Expr, ExprLit, Lit, Member};
use tltl::Automaton;
use tltl::automaton::{Cube, Edge, Guard, Node, Transitions};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::emit::tables;

/// A constant expression.
enum Value {
    Number(i64),
    Text(String),
    List(Vec<Value>),
    /// A variant or a struct, by the last part of its path, with its fields.
    Made(String, HashMap<String, Value>),
}

/// The automaton that the code for `dfa` makes.
pub(crate) fn leaked(dfa: &Dfa) -> &'static Automaton {
    let code: Expr = syn::parse2(tables::automaton(dfa, "tltl")).unwrap();
    let value = read(&code);
    let optional = |name: &str| match value.field(name) {
        Value::Made(some, fields) if some == "Some" => Some(fields["0"].number() as u32),
        _ => None,
    };
    leak(Automaton {
        propositions: list(value.field("propositions"), |name| &*name.text().to_owned().leak()),
        states: value.field("states").number() as u32,
        accepting: optional("accepting"),
        trap: optional("trap"),
        transitions: transitions(value.field("transitions")),
        edges: list(value.field("edges"), |edge| Edge {
            from: edge.field("from").number() as u32,
            to: edge.field("to").number() as u32,
            guard: guard(edge.field("guard")),
        }),
        progress: list(value.field("progress"), guard),
        distance: numbers(value.field("distance")),
    })
}

fn transitions(value: &Value) -> Transitions {
    match value {
        Value::Made(name, _) if name == "Table" => Transitions::Table {
            class: list(value.field("class"), |class| class.number() as u16),
            width: value.field("width").number() as u32,
            next: numbers(value.field("next")),
        },
        _ => Transitions::Diagram {
            nodes: list(value.field("nodes"), |node| Node {
                proposition: node.field("proposition").number() as u32,
                low: node.field("low").number() as u32,
                high: node.field("high").number() as u32,
            }),
            roots: numbers(value.field("roots")),
        },
    }
}

fn guard(value: &Value) -> Guard {
    let cube = |cube: &Value| -> Cube { list(cube, |literal| literal.number() as i32) };
    list(value, cube)
}

fn numbers(value: &Value) -> &'static [u32] {
    list(value, |number| number.number() as u32)
}

fn list<T>(value: &Value, one: impl Fn(&Value) -> T) -> &'static [T] {
    let Value::List(values) = value else { panic!("no list") };
    values.iter().map(one).collect::<Vec<_>>().leak()
}

fn leak<T>(value: T) -> &'static T {
    Box::leak(Box::new(value))
}

impl Value {
    fn field(&self, name: &str) -> &Self {
        match self {
            Self::Made(_, fields) => &fields[name],
            _ => panic!("no field {name}"),
        }
    }

    fn number(&self) -> i64 {
        let Self::Number(number) = self else { panic!("no number") };
        *number
    }

    fn text(&self) -> &str {
        let Self::Text(text) = self else { panic!("no text") };
        text
    }
}

fn read(code: &Expr) -> Value {
    match code {
        Expr::Lit(ExprLit { lit: Lit::Int(number), .. }) => {
            Value::Number(number.base10_parse().unwrap())
        }
        Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Value::Text(text.value()),
        Expr::Unary(negated) => Value::Number(-read(&negated.expr).number()),
        Expr::Reference(reference) => read(&reference.expr),
        Expr::Array(array) => Value::List(array.elems.iter().map(read).collect()),
        Expr::Path(path) => Value::Made(last(&path.path), HashMap::new()),
        Expr::Call(call) => match &*call.func {
            Expr::Path(path) => {
                let field = ("0".to_owned(), read(&call.args[0]));
                Value::Made(last(&path.path), HashMap::from([field]))
            }
            _ => panic!("no constructor"),
        },
        Expr::Struct(made) => {
            let field = |field: &syn::FieldValue| match &field.member {
                Member::Named(name) => (name.to_string(), read(&field.expr)),
                Member::Unnamed(_) => panic!("no name"),
            };
            Value::Made(last(&made.path), made.fields.iter().map(field).collect())
        }
        _ => panic!("no constant"),
    }
}

fn last(path: &syn::Path) -> String {
    path.segments.last().unwrap().ident.to_string()
}

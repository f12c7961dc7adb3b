//! Emitted tables as data, without a compiler: the Rust text is read.

use std::collections::HashMap;

use syn::{Expr, ExprLit, Lit, Member, Stmt};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::emit::tables as emit;
use tltl_compiler::tables::{Tables, Transitions, tables};

/// A constant expression.
enum Value {
    Number(i64),
    Text(String),
    List(Vec<Value>),
    /// A variant or a struct, by the last part of its path, with its fields.
    Made(String, HashMap<String, Value>),
}

/// The tables of the automaton that the code for `dfa` makes.
pub(crate) fn emitted(dfa: &Dfa) -> Tables {
    let code: Expr = syn::parse2(emit::automaton(&tables(dfa), &quote::quote! { tltl })).unwrap();
    let value = read(&code);
    let optional = |name: &str| match value.field(name) {
        Value::Made(some, fields) if some == "Some" => Some(fields["0"].number() as u32),
        _ => None,
    };
    let numbers = |name: &str| numbers(value.field(name));
    Tables {
        propositions: list(value.field("propositions"), |name| name.text().to_owned()),
        states: value.field("states").number() as u32,
        accepting: optional("accepting"),
        trap: optional("trap"),
        transitions: transitions(value.field("transitions")),
        edges: numbers("edges"),
        targets: numbers("targets"),
        guards: numbers("guards"),
        literals: list(value.field("literals"), |literal| literal.number() as i32),
        distance: numbers("distance"),
    }
}

fn transitions(value: &Value) -> Transitions {
    match value {
        Value::Made(name, _) if name == "Table" => Transitions::Table {
            class: list(value.field("class"), |class| class.number() as u16),
            width: value.field("width").number() as u32,
            next: numbers(value.field("next")),
        },
        _ => Transitions::Diagram {
            nodes: list(value.field("nodes"), |node| numbers(node).try_into().unwrap()),
            roots: numbers(value.field("roots")),
        },
    }
}

fn numbers(value: &Value) -> Vec<u32> {
    list(value, |number| number.number() as u32)
}

fn list<T>(value: &Value, one: impl Fn(&Value) -> T) -> Vec<T> {
    let Value::List(values) = value else { panic!("no list") };
    values.iter().map(one).collect()
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
        Expr::Const(constant) => tail(&constant.block),
        Expr::Block(block) => tail(&block.block),
        Expr::Call(call) => match &*call.func {
            // What only passes on its argument.
            Expr::Path(path) if matches!(&*last(&path.path), "trusted" | "from_static") => {
                read(&call.args[0])
            }
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

/// The value of a block, after its imports.
fn tail(block: &syn::Block) -> Value {
    match block.stmts.last() {
        Some(Stmt::Expr(value, None)) => read(value),
        _ => panic!("no value"),
    }
}

fn last(path: &syn::Path) -> String {
    path.segments.last().unwrap().ident.to_string()
}

//! A formula as a type of the runtime, from which rustc makes straight-line code.
//!
//! `F (a && F b)` is `Eventually<And<Now<Is<0>>, Eventually<Now<Is<1>>>>>`, each name with its path. A
//! type is a tree: an operator that is used twice stands there twice. So not every formula has one.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

use crate::spec::{Formula, FormulaId, Spec};

/// A type has up to this many operators; a longer formula is interpreted. Optimized, each operator
/// costs the author's build some 15 ms where robustness is asked for, and half a second is enough.
const OPERATORS: usize = 32;
/// The windows of a type have up to this many cells together: 32 KB, of the 2 MB that the stack of a
/// thread has.
const CELLS: usize = 4096;

/// The type of a formula; `None` if it would be too large.
pub(super) fn formula(spec: &Spec, runtime: &TokenStream) -> Option<TokenStream> {
    let mut written: Vec<Option<Written>> = Vec::new();
    let reachable = spec.reachable();
    for (id, formula) in spec.formulas() {
        let operands: Option<Vec<&Written>> =
            formula.operands().map(|operand| written[operand.0 as usize].as_ref()).collect();
        let needed = operands.filter(|_| reachable[id.0 as usize]);
        let one = needed.map(|operands| Written::new(formula, &operands, runtime));
        written.push(one.filter(|one| one.operators <= OPERATORS && one.cells <= CELLS));
    }
    let FormulaId(root) = spec.root();
    written.swap_remove(root as usize).map(|root| root.temporal(runtime))
}

/// The type of a formula so far.
struct Written {
    code: TokenStream,
    /// Whether it is a state formula, which becomes a formula by `Now`.
    is_state: bool,
    operators: usize,
    cells: usize,
}

impl Written {
    fn new(formula: Formula, operands: &[&Self], runtime: &TokenStream) -> Self {
        let mut operands = operands.to_vec();
        if let Formula::And(..) = formula {
            // A state formula first: that is how the runtime tells what it can monitor online.
            operands.sort_by_key(|operand| !operand.is_state);
        }
        let is_state = !formula.is_temporal() && operands.iter().all(|operand| operand.is_state);
        let operand = |one: &&Self| match is_state {
            true => one.code.clone(),
            false => one.temporal(runtime),
        };
        let types: Vec<TokenStream> = operands.iter().map(operand).collect();
        let (name, number) = name(formula);
        let name = Ident::new(name, Span::call_site());
        let path = quote! { #runtime::robustness::typed::#name };
        let window = number.filter(|_| formula.is_temporal()).map(|n| n as usize + 2);
        let arguments = number.into_iter().map(|n| n as usize).chain(window);
        let arguments = arguments.map(Literal::usize_unsuffixed).map(|n| quote! { #n });
        let arguments: Vec<TokenStream> = arguments.chain(types).collect();
        let sum = |of: fn(&Self) -> usize| operands.iter().map(|one| of(one)).sum::<usize>();
        Self {
            code: if arguments.is_empty() {
                path
            } else {
                quote! { #path<#(#arguments),*> }
            },
            is_state,
            operators: 1 + sum(|one| one.operators),
            cells: window.unwrap_or(0).saturating_add(sum(|one| one.cells)),
        }
    }

    /// The type where a formula that relates instants can stand.
    fn temporal(&self, runtime: &TokenStream) -> TokenStream {
        let code = self.code.clone();
        if self.is_state {
            quote! { #runtime::robustness::typed::Now<#code> }
        } else {
            code
        }
    }
}

/// The name of an operator's type, and the number that it takes.
fn name(formula: Formula) -> (&'static str, Option<u32>) {
    match formula {
        Formula::True => ("True", None),
        Formula::False => ("False", None),
        Formula::Literal { proposition, negated: false } => ("Is", Some(proposition)),
        Formula::Literal { proposition, negated: true } => ("Not", Some(proposition)),
        Formula::And(..) => ("And", None),
        Formula::Or(..) => ("Or", None),
        Formula::Next(_) => ("Next", None),
        Formula::Delay(n, _) => ("Delay", Some(n)),
        Formula::Eventually(_) => ("Eventually", None),
        Formula::Within(n, _) => ("Within", Some(n)),
        Formula::Throughout(n, _) => ("Throughout", Some(n)),
        Formula::Until(..) => ("Until", None),
        Formula::UntilWithin(n, ..) => ("UntilWithin", Some(n)),
        Formula::Then(..) => ("Then", None),
    }
}

//! Collects the declarations and the uses of a syntax tree.

use rustc_hash::FxHashMap;
use tltl_compiler::ast::{Ast, Declaration, FieldType, Item, ItemKind, Node, NodeId, Quantifier};
use tltl_compiler::source::Span;

use super::{Kind, Symbol, SymbolId, Type, Use};

/// The declarations of a source, in its order but for the names that quantifiers bind, which come
/// last; and the uses, in any order.
pub(super) fn collect(ast: &Ast) -> (Vec<Symbol>, Vec<Use>) {
    let mut collecting = Collecting {
        ast,
        symbols: Vec::new(),
        uses: Vec::new(),
        items: FxHashMap::default(),
        types: FxHashMap::default(),
        values: FxHashMap::default(),
        fields: FxHashMap::default(),
        parameters: vec![FxHashMap::default(); ast.items().len()],
        state: None,
    };
    for (number, item) in ast.items().iter().enumerate() {
        collecting.declare(number, item);
    }
    for (number, item) in ast.items().iter().enumerate() {
        collecting.types_of(item);
        if let ItemKind::Constant(_, root)
        | ItemKind::Predicate(_, root)
        | ItemKind::Task(_, root) = item.kind
        {
            collecting.expression(number, root);
        }
    }
    (collecting.symbols, collecting.uses)
}

/// The names of a source while they are collected.
struct Collecting<'a> {
    ast: &'a Ast,
    symbols: Vec<Symbol>,
    uses: Vec<Use>,
    /// Constants, predicates and tasks.
    items: FxHashMap<&'a str, SymbolId>,
    /// Structs and enumerations.
    types: FxHashMap<&'a str, SymbolId>,
    values: FxHashMap<&'a str, Vec<SymbolId>>,
    fields: FxHashMap<(SymbolId, &'a str), SymbolId>,
    /// For each item.
    parameters: Vec<FxHashMap<&'a str, SymbolId>>,
    state: Option<SymbolId>,
}

impl<'a> Collecting<'a> {
    fn text(&self, span: Span) -> &'a str {
        self.ast.source().slice(span)
    }

    fn add(&mut self, symbol: Symbol) -> SymbolId {
        let id = SymbolId(self.symbols.len() as u32);
        self.uses.push(Use { span: symbol.name, means: vec![id] });
        self.symbols.push(symbol);
        id
    }

    /// Adds an item and what it declares.
    fn declare(&mut self, number: usize, item: &'a Item) {
        let kind = match &item.kind {
            ItemKind::State(_) => Kind::State,
            ItemKind::Struct(_) => Kind::Struct,
            ItemKind::Enum(_) => Kind::Enumeration,
            ItemKind::Constant(..) => Kind::Constant,
            ItemKind::Predicate(..) => Kind::Predicate,
            ItemKind::Task(..) | ItemKind::Broken(_) => Kind::Task,
            ItemKind::Host(_) | ItemKind::Step { .. } => return,
        };
        if item.name.start == item.name.end {
            return;
        }
        let name = self.text(item.name);
        let symbol = Symbol {
            kind,
            name: item.name,
            docs: item.docs.clone(),
            shown: self.without_comments(item),
            item: number,
            owner: None,
            scope: None,
            ty: None,
        };
        let id = self.add(symbol);
        match &item.kind {
            ItemKind::State(fields) | ItemKind::Struct(fields) => {
                if kind == Kind::State {
                    self.state.get_or_insert(id);
                } else {
                    self.types.entry(name).or_insert(id);
                }
                for field in fields {
                    let own = self.declaration(Kind::Field, number, field, Some(id), None);
                    self.fields.entry((id, self.text(field.name))).or_insert(own);
                }
            }
            ItemKind::Enum(values) => {
                self.types.entry(name).or_insert(id);
                for &value in values {
                    let own = self.add(Symbol {
                        kind: Kind::Value,
                        name: value,
                        docs: Vec::new(),
                        shown: value,
                        item: number,
                        owner: Some(id),
                        scope: None,
                        ty: None,
                    });
                    self.values.entry(self.text(value)).or_default().push(own);
                }
            }
            ItemKind::Predicate(parameters, _)
            | ItemKind::Task(parameters, _)
            | ItemKind::Broken(parameters) => {
                self.items.entry(name).or_insert(id);
                for parameter in parameters {
                    let scope = Some(item.span);
                    let own = self.declaration(Kind::Parameter, number, parameter, None, scope);
                    let name = self.text(parameter.name);
                    self.parameters[number].entry(name).or_insert(own);
                }
            }
            _ => {
                self.items.entry(name).or_insert(id);
            }
        }
    }

    /// An item up to its last token. The grammar ends it where the next one begins, and a comment
    /// between the two is about the next one.
    fn without_comments(&self, item: &Item) -> Span {
        match item.kind {
            ItemKind::Constant(_, root)
            | ItemKind::Predicate(_, root)
            | ItemKind::Task(_, root) => {
                Span { end: self.ast.entry(root).outer.end.min(item.span.end), ..item.span }
            }
            _ => item.span,
        }
    }

    fn declaration(
        &mut self,
        kind: Kind,
        item: usize,
        declared: &Declaration,
        owner: Option<SymbolId>,
        scope: Option<Span>,
    ) -> SymbolId {
        let end = declared.unit.as_ref().map_or(declared.ty.span, |unit| unit.span);
        self.add(Symbol {
            kind,
            name: declared.name,
            docs: declared.docs.clone(),
            shown: declared.name.to(end),
            item,
            owner,
            scope,
            ty: Some(Type { name: declared.ty.name, depth: declared.ty.lengths.len() }),
        })
    }

    /// Finds the types that an item names.
    fn types_of(&mut self, item: &'a Item) {
        let declared: &[Declaration] = match &item.kind {
            ItemKind::State(all)
            | ItemKind::Struct(all)
            | ItemKind::Predicate(all, _)
            | ItemKind::Task(all, _)
            | ItemKind::Broken(all) => all,
            _ => &[],
        };
        for Declaration { ty: FieldType { name, lengths, .. }, .. } in declared {
            for span in lengths.iter().chain([name]) {
                let text = self.text(*span);
                let means = self.types.get(text).or_else(|| self.items.get(text));
                let means = means.copied().into_iter().collect();
                self.found(*span, means);
            }
        }
    }

    /// Notes what a name means; one that is not declared here is left out.
    fn found(&mut self, span: Span, means: Vec<SymbolId>) {
        if !means.is_empty() {
            self.uses.push(Use { span, means });
        }
    }

    /// Finds the names of an expression. Its nodes are neighbours, operands first, so a quantifier
    /// binds its name in a range of them.
    fn expression(&mut self, item: usize, root: NodeId) {
        let ast = self.ast;
        let first = ast.first(root);
        let mut opening: FxHashMap<u32, Vec<(&'a str, SymbolId, NodeId)>> = FxHashMap::default();
        for id in (first.0..=root.0).map(NodeId) {
            if let Node::Quantified(quantifier) = ast.node(id) {
                let own = self.quantifier(item, id, quantifier);
                let start = ast.first(quantifier.body).0;
                let name = self.text(quantifier.name);
                opening.entry(start).or_default().push((name, own, quantifier.body));
            }
        }
        let mut bound: FxHashMap<&'a str, Vec<SymbolId>> = FxHashMap::default();
        let mut open: Vec<(&'a str, NodeId)> = Vec::new();
        let mut types: Vec<Option<Type>> = Vec::with_capacity((root.0 - first.0 + 1) as usize);
        for id in (first.0..=root.0).map(NodeId) {
            // Outer quantifiers come later in the arena, and bind first.
            for (name, own, body) in opening.remove(&id.0).into_iter().flatten().rev() {
                bound.entry(name).or_default().push(own);
                open.push((name, body));
            }
            let of = |id: NodeId| types.get((id.0 - first.0) as usize).copied().flatten();
            let ty = match ast.node(id) {
                Node::Name => self.leaf(item, id, &bound),
                Node::Field { base, field } => of(*base).and_then(|ty| self.field(ty, *field)),
                Node::Index { base, .. } => {
                    of(*base).map(|ty| Type { depth: ty.depth.saturating_sub(1), ..ty })
                }
                _ => None,
            };
            types.push(ty);
            while let Some((name, _)) = open.pop_if(|(_, body)| *body == id) {
                bound.entry(name).or_default().pop();
            }
        }
    }

    /// The name that a quantifier binds, and the set that it ranges over.
    fn quantifier(&mut self, item: usize, id: NodeId, quantifier: &Quantifier) -> SymbolId {
        let entry = self.ast.entry(id);
        let body = self.ast.entry(quantifier.body).outer;
        if quantifier.range.is_none() && quantifier.elements.is_empty() {
            let means = self.types.get(self.text(quantifier.set)).copied();
            self.found(quantifier.set, means.into_iter().collect());
        }
        self.add(Symbol {
            kind: Kind::Bound,
            name: quantifier.name,
            docs: Vec::new(),
            shown: Span { end: quantifier.set.end, ..entry.span },
            item,
            owner: None,
            scope: Some(body),
            ty: None,
        })
    }

    /// Notes what a single name or a path such as `Room::hall` means; returns the type of a field.
    fn leaf(
        &mut self,
        item: usize,
        id: NodeId,
        bound: &FxHashMap<&'a str, Vec<SymbolId>>,
    ) -> Option<Type> {
        let (span, text) = (self.ast.span(id), self.ast.text(id));
        if let Some(at) = text.rfind("::") {
            self.path(span, [&text[..at], &text[at + 2..]]);
            return None;
        }
        let local = bound.get(text).and_then(|all| all.last()).or(self.parameters[item].get(text));
        if let Some(&local) = local {
            self.found(span, vec![local]);
            return None;
        }
        let values = self.values.get(text).into_iter().flatten().copied();
        let field = self.state.and_then(|state| self.fields.get(&(state, text)).copied());
        let named = self.items.get(text).copied().or(field);
        let means = named.into_iter().chain(values).collect();
        self.found(span, means);
        self.symbols[field?.0 as usize].ty
    }

    /// Notes what both parts of `Room::hall` mean.
    fn path(&mut self, span: Span, [before, name]: [&'a str; 2]) {
        let part = |text: &str, from: usize| {
            let start = from + (text.len() - text.trim_start().len());
            Span::new(start, start + text.trim().len())
        };
        let Some(&owner) = self.types.get(before.trim()) else { return };
        self.found(part(before, span.start), vec![owner]);
        let all = self.values.get(name.trim()).into_iter().flatten().copied();
        let means = all.filter(|id| self.symbols[id.0 as usize].owner == Some(owner)).collect();
        self.found(part(name, span.end - name.len()), means);
    }

    /// Notes what the name behind a dot means; returns its type.
    fn field(&mut self, base: Type, name: Span) -> Option<Type> {
        let owner = self.types.get(self.text(base.name)).filter(|_| base.depth == 0).copied()?;
        let field = *self.fields.get(&(owner, self.text(name)))?;
        self.found(name, vec![field]);
        self.symbols[field.0 as usize].ty
    }
}

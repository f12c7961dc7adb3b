//! Attributes: how a task is compiled.

use super::Checker;
use crate::ast::{Attribute, ItemKind};
use crate::error::{Error, Kind};
use crate::predicate::Options;
use crate::source::Span;

impl Checker<'_> {
    /// What the attributes of the task `item` say.
    pub(super) fn options(&mut self, item: usize) -> Options {
        let mut options = Options::default();
        let attributes = self.written.items().get(item).map(|item| item.attributes.clone());
        for attribute in attributes.unwrap_or_default() {
            match self.written.source().slice(attribute.name) {
                "factored" if attribute.settings.is_empty() => options.factored = true,
                "budget" if !attribute.settings.is_empty() => {
                    self.budget(&attribute, &mut options);
                }
                _ => self.unknown_attribute(attribute.name),
            }
        }
        options
    }

    fn budget(&mut self, attribute: &Attribute, options: &mut Options) {
        for &(name, value) in &attribute.settings {
            let source = self.written.source();
            let number = source.slice(value).replace('_', "").parse::<usize>();
            let setting = match source.slice(name) {
                "states" => &mut options.states,
                "nodes" => &mut options.nodes,
                "edges" => &mut options.edges,
                "products" => &mut options.products,
                _ => {
                    self.unknown_attribute(name);
                    continue;
                }
            };
            match number {
                Ok(number) => *setting = Some(number),
                Err(_) => {
                    let message = "this number is too large for a budget";
                    self.mistakes.push(Error::new(Kind::Number, message, value));
                }
            }
        }
    }

    fn unknown_attribute(&mut self, span: Span) {
        let name = self.written.source().slice(span);
        let message = format!("`{name}` is not an attribute of a task");
        self.mistakes.push(Error::new(Kind::UnknownName, message, span).help(
            "write `#[factored]`, or `#[budget(states = 100000)]` with `states`, `nodes`, `edges` or `products`",
        ));
    }

    /// Refuses attributes of what is not a task.
    pub(super) fn check_attributes(&mut self) {
        for item in self.written.items() {
            if let (Some(attribute), false) =
                (item.attributes.first(), matches!(item.kind, ItemKind::Task(..)))
            {
                let message = "only a task has attributes";
                self.mistakes.push(Error::new(Kind::Syntax, message, attribute.name));
            }
        }
    }
}

// Generated from grammar.pest by tests/grammar.rs; do not edit.

pub(crate) struct Grammar;
type State<'i> = Box<::pest::ParserState<'i, Rule>>;
type Step = for<'i> fn(State<'i>) -> ::pest::ParseResult<State<'i>>;
/**The language: task files, bare formulas, and what stands inside `tltl!`.

An expression is a flat sequence of operands and operators. Brackets are tokens like any
other, and the operator-precedence parser pairs them, so no rule calls itself on the way down
an expression and no input is too deep.*/
#[allow(dead_code, non_camel_case_types, clippy::upper_case_acronyms)]
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub enum Rule {
    ///End-of-input
    EOI,
    r#WHITESPACE,
    r#COMMENT,
    r#block_comment,
    r#formula,
    r#fragment,
    r#prologue,
    r#next,
    r#heading,
    r#item,
    r#boundary,
    r#attribute,
    r#setting,
    r#doc,
    r#file_doc,
    r#state,
    r#record,
    r#enumeration,
    r#constant,
    r#predicate,
    r#task,
    r#step,
    r#fields,
    r#parameters,
    r#field_declaration,
    r#field_type,
    r#path,
    r#optional,
    r#array_open,
    r#array_close,
    r#unit,
    r#unit_one,
    r#unit_power,
    r#header,
    r#header_type,
    r#host_type,
    r#item_word,
    r#word_state,
    r#word_struct,
    r#word_enum,
    r#word_const,
    r#word_predicate,
    r#word_task,
    r#word_step,
    r#expression,
    r#operand,
    r#prefix,
    r#not,
    r#eventually,
    r#next_op,
    r#always,
    r#brackets,
    r#operand_start,
    r#minus,
    r#quantifier,
    r#set,
    r#element,
    r#range,
    r#end,
    r#inclusive,
    r#word_for,
    r#word_all,
    r#word_some,
    r#word_in,
    r#infix,
    r#implies,
    r#iff,
    r#or,
    r#and,
    r#until,
    r#ensuring,
    r#equal,
    r#unequal,
    r#at_most,
    r#at_least,
    r#less,
    r#greater,
    r#plus,
    r#times,
    r#divide,
    r#comma,
    r#call,
    r#index,
    r#bound,
    r#bound_end,
    r#amount,
    r#open,
    r#close,
    r#empty_call,
    r#field,
    r#position,
    r#primary,
    r#truth,
    r#falsity,
    r#name,
    r#trivia,
    r#reserved,
    r#number,
    r#text,
    r#verbatim,
    r#digits,
    r#fraction,
    r#exponent,
    r#suffix,
    r#identifier,
    r#word_rest,
    r#braces,
    r#string,
    r#character,
}
impl Rule {
    pub fn all_rules() -> &'static [Rule] {
        &[
            Rule::r#WHITESPACE,
            Rule::r#COMMENT,
            Rule::r#block_comment,
            Rule::r#formula,
            Rule::r#fragment,
            Rule::r#prologue,
            Rule::r#next,
            Rule::r#heading,
            Rule::r#item,
            Rule::r#boundary,
            Rule::r#attribute,
            Rule::r#setting,
            Rule::r#doc,
            Rule::r#file_doc,
            Rule::r#state,
            Rule::r#record,
            Rule::r#enumeration,
            Rule::r#constant,
            Rule::r#predicate,
            Rule::r#task,
            Rule::r#step,
            Rule::r#fields,
            Rule::r#parameters,
            Rule::r#field_declaration,
            Rule::r#field_type,
            Rule::r#path,
            Rule::r#optional,
            Rule::r#array_open,
            Rule::r#array_close,
            Rule::r#unit,
            Rule::r#unit_one,
            Rule::r#unit_power,
            Rule::r#header,
            Rule::r#header_type,
            Rule::r#host_type,
            Rule::r#item_word,
            Rule::r#word_state,
            Rule::r#word_struct,
            Rule::r#word_enum,
            Rule::r#word_const,
            Rule::r#word_predicate,
            Rule::r#word_task,
            Rule::r#word_step,
            Rule::r#expression,
            Rule::r#operand,
            Rule::r#prefix,
            Rule::r#not,
            Rule::r#eventually,
            Rule::r#next_op,
            Rule::r#always,
            Rule::r#brackets,
            Rule::r#operand_start,
            Rule::r#minus,
            Rule::r#quantifier,
            Rule::r#set,
            Rule::r#element,
            Rule::r#range,
            Rule::r#end,
            Rule::r#inclusive,
            Rule::r#word_for,
            Rule::r#word_all,
            Rule::r#word_some,
            Rule::r#word_in,
            Rule::r#infix,
            Rule::r#implies,
            Rule::r#iff,
            Rule::r#or,
            Rule::r#and,
            Rule::r#until,
            Rule::r#ensuring,
            Rule::r#equal,
            Rule::r#unequal,
            Rule::r#at_most,
            Rule::r#at_least,
            Rule::r#less,
            Rule::r#greater,
            Rule::r#plus,
            Rule::r#times,
            Rule::r#divide,
            Rule::r#comma,
            Rule::r#call,
            Rule::r#index,
            Rule::r#bound,
            Rule::r#bound_end,
            Rule::r#amount,
            Rule::r#open,
            Rule::r#close,
            Rule::r#empty_call,
            Rule::r#field,
            Rule::r#position,
            Rule::r#primary,
            Rule::r#truth,
            Rule::r#falsity,
            Rule::r#name,
            Rule::r#trivia,
            Rule::r#reserved,
            Rule::r#number,
            Rule::r#text,
            Rule::r#verbatim,
            Rule::r#digits,
            Rule::r#fraction,
            Rule::r#exponent,
            Rule::r#suffix,
            Rule::r#identifier,
            Rule::r#word_rest,
            Rule::r#braces,
            Rule::r#string,
            Rule::r#character,
        ]
    }
}
#[allow(clippy::all)]
impl ::pest::Parser<Rule> for Grammar {
    fn parse<'i>(
        rule: Rule,
        input: &'i str,
    ) -> ::std::result::Result<
        ::pest::iterators::Pairs<'i, Rule>,
        ::pest::error::Error<Rule>,
    > {
        mod rules {
            #![allow(clippy::upper_case_acronyms)]
            pub mod hidden {
                use super::super::Rule;
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                pub fn skip(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    if state.atomicity() == ::pest::Atomicity::NonAtomic {
                        state.sequence(step_4 as crate::grammar::Step)
                    } else {
                        Ok(state)
                    }
                }
                fn step_0(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(super::visible::WHITESPACE as crate::grammar::Step)
                }
                fn step_1(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::visible::COMMENT(state)
                        .and_then(step_0 as crate::grammar::Step)
                }
                fn step_2(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_1 as crate::grammar::Step)
                }
                fn step_3(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_2 as crate::grammar::Step)
                }
                fn step_4(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .repeat(super::visible::WHITESPACE as crate::grammar::Step)
                        .and_then(step_3 as crate::grammar::Step)
                }
            }
            pub mod visible {
                use super::super::Rule;
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#WHITESPACE(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_4 as crate::grammar::Step,
                        )
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#COMMENT(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_16 as crate::grammar::Step,
                        )
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#block_comment(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_26 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#formula(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_27 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#fragment(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_35 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#prologue(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_42 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#next(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_44 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#heading(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_53 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#item(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#item, step_60 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#boundary(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#doc(state)
                        .or_else(self::r#attribute as crate::grammar::Step)
                        .or_else(step_62 as crate::grammar::Step)
                        .or_else(step_64 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#attribute(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#attribute, step_85 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#setting(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#setting, step_88 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#doc(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#doc, step_92 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#file_doc(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#file_doc, step_95 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#state(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#state, step_101 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#record(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#record, step_103 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#enumeration(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#enumeration, step_118 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#constant(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#constant, step_123 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#predicate(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#predicate, step_126 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#task(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#task, step_128 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#step(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#step, step_130 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#fields(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#fields, step_143 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#parameters(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#parameters, step_145 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#field_declaration(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state
                        .rule(
                            Rule::r#field_declaration,
                            step_153 as crate::grammar::Step,
                        )
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#field_type(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#field_type, step_167 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#path(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#path, step_175 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#optional(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#optional, step_176 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#array_open(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#array_open, step_65 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#array_close(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#array_close, step_179 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#unit(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#unit, step_189 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#unit_one(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#unit_one, step_193 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#unit_power(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#unit_power, step_199 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#header(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#header, step_202 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#header_type(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#header_type, step_208 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#host_type(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#host_type, step_215 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#item_word(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#word_state(state)
                        .or_else(self::r#word_struct as crate::grammar::Step)
                        .or_else(self::r#word_enum as crate::grammar::Step)
                        .or_else(self::r#word_const as crate::grammar::Step)
                        .or_else(self::r#word_predicate as crate::grammar::Step)
                        .or_else(self::r#word_task as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_state(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_state, step_218 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_struct(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_struct, step_221 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_enum(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_enum, step_224 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_const(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_const, step_227 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_predicate(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_predicate, step_230 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_task(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_task, step_233 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_step(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_step, step_236 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#expression(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#expression, step_246 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#operand(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_260 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#prefix(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#not(state)
                        .or_else(step_263 as crate::grammar::Step)
                        .or_else(self::r#minus as crate::grammar::Step)
                        .or_else(self::r#quantifier as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#not(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#not, step_270 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#eventually(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#eventually, step_276 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#next_op(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#next_op, step_280 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#always(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#always, step_291 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#brackets(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.sequence(step_300 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#operand_start(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    state
                        .sequence(step_301 as crate::grammar::Step)
                        .or_else(step_266 as crate::grammar::Step)
                        .or_else(step_302 as crate::grammar::Step)
                        .or_else(step_273 as crate::grammar::Step)
                        .or_else(step_274 as crate::grammar::Step)
                        .or_else(step_278 as crate::grammar::Step)
                        .or_else(step_288 as crate::grammar::Step)
                        .or_else(step_289 as crate::grammar::Step)
                        .or_else(step_303 as crate::grammar::Step)
                        .or_else(step_304 as crate::grammar::Step)
                        .or_else(step_104 as crate::grammar::Step)
                        .or_else(step_305 as crate::grammar::Step)
                        .or_else(self::r#ASCII_DIGIT as crate::grammar::Step)
                        .or_else(step_321 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#minus(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#minus, step_327 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#quantifier(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#quantifier, step_330 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#set(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#set, step_343 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#element(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#element, step_344 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#range(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#range, step_348 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#end(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#end, step_177 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#inclusive(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#inclusive, step_86 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_for(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_for, step_351 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_all(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_all, step_354 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_some(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_some, step_357 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_in(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#word_in, step_360 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#infix(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#implies(state)
                        .or_else(self::r#iff as crate::grammar::Step)
                        .or_else(self::r#or as crate::grammar::Step)
                        .or_else(self::r#and as crate::grammar::Step)
                        .or_else(step_362 as crate::grammar::Step)
                        .or_else(self::r#ensuring as crate::grammar::Step)
                        .or_else(self::r#equal as crate::grammar::Step)
                        .or_else(self::r#unequal as crate::grammar::Step)
                        .or_else(self::r#at_most as crate::grammar::Step)
                        .or_else(self::r#at_least as crate::grammar::Step)
                        .or_else(self::r#less as crate::grammar::Step)
                        .or_else(self::r#greater as crate::grammar::Step)
                        .or_else(self::r#plus as crate::grammar::Step)
                        .or_else(self::r#minus as crate::grammar::Step)
                        .or_else(self::r#times as crate::grammar::Step)
                        .or_else(self::r#divide as crate::grammar::Step)
                        .or_else(self::r#comma as crate::grammar::Step)
                        .or_else(self::r#call as crate::grammar::Step)
                        .or_else(self::r#index as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#implies(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#implies, step_365 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#iff(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#iff, step_368 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#or(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#or, step_373 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#and(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#and, step_379 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#until(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#until, step_382 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#ensuring(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#ensuring, step_385 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#equal(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#equal, step_386 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#unequal(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#unequal, step_388 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#at_most(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#at_most, step_390 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#at_least(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#at_least, step_392 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#less(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#less, step_393 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#greater(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#greater, step_322 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#plus(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#plus, step_394 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#times(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#times, step_396 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#divide(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#divide, step_398 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#comma(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#comma, step_74 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#call(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#call, step_302 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#index(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#index, step_65 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#bound(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#bound, step_407 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#bound_end(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#bound_end, step_412 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#amount(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#amount, step_419 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#open(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#open, step_302 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#close(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#close, step_420 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#empty_call(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#empty_call, step_422 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#field(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#field, step_425 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#position(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#position, step_431 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#primary(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#truth(state)
                        .or_else(self::r#falsity as crate::grammar::Step)
                        .or_else(self::r#number as crate::grammar::Step)
                        .or_else(self::r#verbatim as crate::grammar::Step)
                        .or_else(self::r#text as crate::grammar::Step)
                        .or_else(self::r#name as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#truth(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#truth, step_435 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#falsity(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#falsity, step_439 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#name(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#name, step_452 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#trivia(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#WHITESPACE(state)
                        .or_else(self::r#COMMENT as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#reserved(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#reserved, step_458 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#number(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#number, step_469 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#text(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#text, step_470 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#verbatim(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#verbatim, step_471 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#digits(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#digits, step_476 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#fraction(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#fraction, step_476 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#exponent(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#exponent, step_483 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#suffix(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#suffix, step_493 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#identifier(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#identifier, step_498 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#word_rest(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    let state = state.check_stack_limit()?;
                    self::r#XID_CONTINUE(state).or_else(step_168 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#braces(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#braces, step_506 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#string(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#string, step_514 as crate::grammar::Step)
                }
                #[inline]
                #[allow(non_snake_case, unused_variables)]
                pub fn r#character(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::r#character, step_521 as crate::grammar::Step)
                }
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                pub fn ANY(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.skip(1)
                }
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                pub fn EOI(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.rule(Rule::EOI, step_522 as crate::grammar::Step)
                }
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                pub fn SOI(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.start_of_input()
                }
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                pub fn ASCII_DIGIT(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.match_range('0'..'9')
                }
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                fn XID_CONTINUE(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.match_char_by(::pest::unicode::XID_CONTINUE)
                }
                #[inline]
                #[allow(dead_code, non_snake_case, unused_variables)]
                fn XID_START(
                    state: ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                ) -> ::pest::ParseResult<
                    ::std::boxed::Box<::pest::ParserState<'_, Rule>>,
                > {
                    state.match_char_by(::pest::unicode::XID_START)
                }
                fn step_0(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("\t")
                }
                fn step_1(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("\r")
                }
                fn step_2(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("\n")
                }
                fn step_3(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("\u{feff}")
                }
                fn step_4(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(" ")
                        .or_else(step_0 as crate::grammar::Step)
                        .or_else(step_1 as crate::grammar::Step)
                        .or_else(step_2 as crate::grammar::Step)
                        .or_else(step_3 as crate::grammar::Step)
                }
                fn step_5(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("/")
                }
                fn step_6(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, step_5 as crate::grammar::Step)
                }
                fn step_7(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("/").and_then(step_6 as crate::grammar::Step)
                }
                fn step_8(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_7 as crate::grammar::Step)
                }
                fn step_9(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("!").or_else(step_8 as crate::grammar::Step)
                }
                fn step_10(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, step_9 as crate::grammar::Step)
                }
                fn step_11(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_2 as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_12(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_11 as crate::grammar::Step)
                }
                fn step_13(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_12 as crate::grammar::Step)
                }
                fn step_14(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("//")
                        .and_then(step_10 as crate::grammar::Step)
                        .and_then(step_13 as crate::grammar::Step)
                }
                fn step_15(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_14 as crate::grammar::Step)
                }
                fn step_16(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#block_comment(state).or_else(step_15 as crate::grammar::Step)
                }
                fn step_17(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("*/")
                }
                fn step_18(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_17 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_19(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_18 as crate::grammar::Step)
                }
                fn step_20(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_19 as crate::grammar::Step)
                }
                fn step_21(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_20 as crate::grammar::Step)
                }
                fn step_22(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_21 as crate::grammar::Step)
                }
                fn step_23(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_18 as crate::grammar::Step)
                        .and_then(step_22 as crate::grammar::Step)
                }
                fn step_24(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_23 as crate::grammar::Step)
                }
                fn step_25(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_24 as crate::grammar::Step)
                }
                fn step_26(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("/*")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_25 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_17 as crate::grammar::Step)
                }
                fn step_27(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#SOI(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#expression as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#EOI as crate::grammar::Step)
                }
                fn step_28(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state)
                        .and_then(self::r#attribute as crate::grammar::Step)
                }
                fn step_29(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_28 as crate::grammar::Step)
                }
                fn step_30(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_29 as crate::grammar::Step)
                }
                fn step_31(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#attribute(state).and_then(step_30 as crate::grammar::Step)
                }
                fn step_32(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_31 as crate::grammar::Step)
                }
                fn step_33(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_32 as crate::grammar::Step)
                }
                fn step_34(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#header as crate::grammar::Step)
                }
                fn step_35(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#SOI(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_33 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_34 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#expression as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#EOI as crate::grammar::Step)
                }
                fn step_36(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state)
                        .and_then(self::r#file_doc as crate::grammar::Step)
                }
                fn step_37(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_36 as crate::grammar::Step)
                }
                fn step_38(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_37 as crate::grammar::Step)
                }
                fn step_39(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#file_doc(state).and_then(step_38 as crate::grammar::Step)
                }
                fn step_40(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_39 as crate::grammar::Step)
                }
                fn step_41(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_40 as crate::grammar::Step)
                }
                fn step_42(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#SOI(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_41 as crate::grammar::Step)
                }
                fn step_43(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#item(state).or_else(self::r#EOI as crate::grammar::Step)
                }
                fn step_44(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#SOI(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_43 as crate::grammar::Step)
                }
                fn step_45(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#doc(state).or_else(self::r#attribute as crate::grammar::Step)
                }
                fn step_46(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_45 as crate::grammar::Step)
                }
                fn step_47(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_46 as crate::grammar::Step)
                }
                fn step_48(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_47 as crate::grammar::Step)
                }
                fn step_49(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#doc(state)
                        .or_else(self::r#attribute as crate::grammar::Step)
                        .and_then(step_48 as crate::grammar::Step)
                }
                fn step_50(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_49 as crate::grammar::Step)
                }
                fn step_51(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_50 as crate::grammar::Step)
                }
                fn step_52(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_predicate(state)
                        .or_else(self::r#word_task as crate::grammar::Step)
                }
                fn step_53(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#SOI(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_51 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_52 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#parameters as crate::grammar::Step)
                }
                fn step_54(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#state(state)
                        .or_else(self::r#record as crate::grammar::Step)
                        .or_else(self::r#enumeration as crate::grammar::Step)
                        .or_else(self::r#constant as crate::grammar::Step)
                        .or_else(self::r#predicate as crate::grammar::Step)
                        .or_else(self::r#task as crate::grammar::Step)
                        .or_else(self::r#step as crate::grammar::Step)
                }
                fn step_55(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(";")
                }
                fn step_56(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_55 as crate::grammar::Step)
                }
                fn step_57(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#boundary(state).or_else(self::r#EOI as crate::grammar::Step)
                }
                fn step_58(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(true, step_57 as crate::grammar::Step)
                }
                fn step_59(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_50 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_54 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_56 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_58 as crate::grammar::Step)
                }
                fn step_60(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_59 as crate::grammar::Step)
                }
                fn step_61(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#item_word(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                }
                fn step_62(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_61 as crate::grammar::Step)
                }
                fn step_63(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_step(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#digits as crate::grammar::Step)
                }
                fn step_64(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_63 as crate::grammar::Step)
                }
                fn step_65(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("[")
                }
                fn step_66(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(",")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#setting as crate::grammar::Step)
                }
                fn step_67(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_66 as crate::grammar::Step)
                }
                fn step_68(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_67 as crate::grammar::Step)
                }
                fn step_69(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_68 as crate::grammar::Step)
                }
                fn step_70(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_69 as crate::grammar::Step)
                }
                fn step_71(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_66 as crate::grammar::Step)
                        .and_then(step_70 as crate::grammar::Step)
                }
                fn step_72(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_71 as crate::grammar::Step)
                }
                fn step_73(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_72 as crate::grammar::Step)
                }
                fn step_74(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(",")
                }
                fn step_75(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_74 as crate::grammar::Step)
                }
                fn step_76(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#setting(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_73 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_75 as crate::grammar::Step)
                }
                fn step_77(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_76 as crate::grammar::Step)
                }
                fn step_78(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_77 as crate::grammar::Step)
                }
                fn step_79(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(")")
                }
                fn step_80(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("(")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_78 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_79 as crate::grammar::Step)
                }
                fn step_81(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_80 as crate::grammar::Step)
                }
                fn step_82(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_81 as crate::grammar::Step)
                }
                fn step_83(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("]")
                }
                fn step_84(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("#")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_65 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_82 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_83 as crate::grammar::Step)
                }
                fn step_85(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_84 as crate::grammar::Step)
                }
                fn step_86(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("=")
                }
                fn step_87(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#identifier(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_86 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#digits as crate::grammar::Step)
                }
                fn step_88(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_87 as crate::grammar::Step)
                }
                fn step_89(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    {
                        let strings = ["\n"];
                        state.skip_until(&strings)
                    }
                }
                fn step_90(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("///")
                        .and_then(step_6 as crate::grammar::Step)
                        .and_then(step_89 as crate::grammar::Step)
                }
                fn step_91(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_90 as crate::grammar::Step)
                }
                fn step_92(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_91 as crate::grammar::Step,
                        )
                }
                fn step_93(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("//!").and_then(step_89 as crate::grammar::Step)
                }
                fn step_94(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_93 as crate::grammar::Step)
                }
                fn step_95(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_94 as crate::grammar::Step,
                        )
                }
                fn step_96(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(true, step_55 as crate::grammar::Step)
                }
                fn step_97(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(":")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#host_type as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_96 as crate::grammar::Step)
                }
                fn step_98(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_97 as crate::grammar::Step)
                }
                fn step_99(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#fields(state).or_else(step_98 as crate::grammar::Step)
                }
                fn step_100(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_state(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_99 as crate::grammar::Step)
                }
                fn step_101(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_100 as crate::grammar::Step)
                }
                fn step_102(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_struct(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#fields as crate::grammar::Step)
                }
                fn step_103(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_102 as crate::grammar::Step)
                }
                fn step_104(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("{")
                }
                fn step_105(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(",")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                }
                fn step_106(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_105 as crate::grammar::Step)
                }
                fn step_107(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_106 as crate::grammar::Step)
                }
                fn step_108(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_107 as crate::grammar::Step)
                }
                fn step_109(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_108 as crate::grammar::Step)
                }
                fn step_110(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_105 as crate::grammar::Step)
                        .and_then(step_109 as crate::grammar::Step)
                }
                fn step_111(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_110 as crate::grammar::Step)
                }
                fn step_112(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_111 as crate::grammar::Step)
                }
                fn step_113(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#identifier(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_112 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_75 as crate::grammar::Step)
                }
                fn step_114(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_113 as crate::grammar::Step)
                }
                fn step_115(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_114 as crate::grammar::Step)
                }
                fn step_116(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("}")
                }
                fn step_117(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_enum(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_104 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_115 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_116 as crate::grammar::Step)
                }
                fn step_118(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_117 as crate::grammar::Step)
                }
                fn step_119(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_in(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#unit as crate::grammar::Step)
                }
                fn step_120(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_119 as crate::grammar::Step)
                }
                fn step_121(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_120 as crate::grammar::Step)
                }
                fn step_122(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_const(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_121 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_86 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#expression as crate::grammar::Step)
                }
                fn step_123(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_122 as crate::grammar::Step)
                }
                fn step_124(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#parameters as crate::grammar::Step)
                }
                fn step_125(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_predicate(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_124 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_86 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#expression as crate::grammar::Step)
                }
                fn step_126(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_125 as crate::grammar::Step)
                }
                fn step_127(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_task(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_124 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_86 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#expression as crate::grammar::Step)
                }
                fn step_128(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_127 as crate::grammar::Step)
                }
                fn step_129(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_step(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#amount as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                }
                fn step_130(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_129 as crate::grammar::Step)
                }
                fn step_131(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(",")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#field_declaration as crate::grammar::Step)
                }
                fn step_132(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_131 as crate::grammar::Step)
                }
                fn step_133(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_132 as crate::grammar::Step)
                }
                fn step_134(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_133 as crate::grammar::Step)
                }
                fn step_135(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_134 as crate::grammar::Step)
                }
                fn step_136(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_131 as crate::grammar::Step)
                        .and_then(step_135 as crate::grammar::Step)
                }
                fn step_137(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_136 as crate::grammar::Step)
                }
                fn step_138(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_137 as crate::grammar::Step)
                }
                fn step_139(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#field_declaration(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_138 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_75 as crate::grammar::Step)
                }
                fn step_140(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_139 as crate::grammar::Step)
                }
                fn step_141(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_140 as crate::grammar::Step)
                }
                fn step_142(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("{")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_141 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_116 as crate::grammar::Step)
                }
                fn step_143(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_142 as crate::grammar::Step)
                }
                fn step_144(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("(")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_141 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_79 as crate::grammar::Step)
                }
                fn step_145(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_144 as crate::grammar::Step)
                }
                fn step_146(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state)
                        .and_then(self::r#doc as crate::grammar::Step)
                }
                fn step_147(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_146 as crate::grammar::Step)
                }
                fn step_148(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_147 as crate::grammar::Step)
                }
                fn step_149(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#doc(state).and_then(step_148 as crate::grammar::Step)
                }
                fn step_150(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_149 as crate::grammar::Step)
                }
                fn step_151(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(":")
                }
                fn step_152(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_150 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_151 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#field_type as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_121 as crate::grammar::Step)
                }
                fn step_153(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_152 as crate::grammar::Step)
                }
                fn step_154(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state)
                        .and_then(self::r#array_open as crate::grammar::Step)
                }
                fn step_155(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_154 as crate::grammar::Step)
                }
                fn step_156(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_155 as crate::grammar::Step)
                }
                fn step_157(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#array_open(state).and_then(step_156 as crate::grammar::Step)
                }
                fn step_158(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_157 as crate::grammar::Step)
                }
                fn step_159(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#optional as crate::grammar::Step)
                }
                fn step_160(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state)
                        .and_then(self::r#array_close as crate::grammar::Step)
                }
                fn step_161(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_160 as crate::grammar::Step)
                }
                fn step_162(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_161 as crate::grammar::Step)
                }
                fn step_163(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#array_close(state).and_then(step_162 as crate::grammar::Step)
                }
                fn step_164(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_163 as crate::grammar::Step)
                }
                fn step_165(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_164 as crate::grammar::Step)
                }
                fn step_166(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_158 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#path as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_159 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_165 as crate::grammar::Step)
                }
                fn step_167(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_166 as crate::grammar::Step)
                }
                fn step_168(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("::")
                }
                fn step_169(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(self::r#trivia as crate::grammar::Step)
                }
                fn step_170(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .repeat(self::r#trivia as crate::grammar::Step)
                        .and_then(step_168 as crate::grammar::Step)
                        .and_then(step_169 as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                }
                fn step_171(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_170 as crate::grammar::Step)
                }
                fn step_172(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_171 as crate::grammar::Step)
                }
                fn step_173(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#identifier(state).and_then(step_172 as crate::grammar::Step)
                }
                fn step_174(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_173 as crate::grammar::Step)
                }
                fn step_175(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_174 as crate::grammar::Step,
                        )
                }
                fn step_176(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("?")
                }
                fn step_177(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#digits(state)
                        .or_else(self::r#identifier as crate::grammar::Step)
                }
                fn step_178(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(";")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_177 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_83 as crate::grammar::Step)
                }
                fn step_179(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_178 as crate::grammar::Step)
                }
                fn step_180(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#times(state)
                        .or_else(self::r#divide as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#unit_power as crate::grammar::Step)
                }
                fn step_181(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_180 as crate::grammar::Step)
                }
                fn step_182(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_181 as crate::grammar::Step)
                }
                fn step_183(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_182 as crate::grammar::Step)
                }
                fn step_184(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_183 as crate::grammar::Step)
                }
                fn step_185(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_180 as crate::grammar::Step)
                        .and_then(step_184 as crate::grammar::Step)
                }
                fn step_186(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_185 as crate::grammar::Step)
                }
                fn step_187(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_186 as crate::grammar::Step)
                }
                fn step_188(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#unit_one(state)
                        .or_else(self::r#unit_power as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_187 as crate::grammar::Step)
                }
                fn step_189(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_188 as crate::grammar::Step)
                }
                fn step_190(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, self::r#XID_CONTINUE as crate::grammar::Step)
                }
                fn step_191(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("1").and_then(step_190 as crate::grammar::Step)
                }
                fn step_192(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_191 as crate::grammar::Step)
                }
                fn step_193(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_192 as crate::grammar::Step,
                        )
                }
                fn step_194(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#minus as crate::grammar::Step)
                }
                fn step_195(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("^")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_194 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#digits as crate::grammar::Step)
                }
                fn step_196(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_195 as crate::grammar::Step)
                }
                fn step_197(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_196 as crate::grammar::Step)
                }
                fn step_198(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#identifier(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_197 as crate::grammar::Step)
                }
                fn step_199(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_198 as crate::grammar::Step)
                }
                fn step_200(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("|")
                }
                fn step_201(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("|")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_151 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#header_type as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_200 as crate::grammar::Step)
                }
                fn step_202(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_201 as crate::grammar::Step)
                }
                fn step_203(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_200 as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_204(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_203 as crate::grammar::Step)
                }
                fn step_205(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_204 as crate::grammar::Step)
                }
                fn step_206(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_203 as crate::grammar::Step)
                        .and_then(step_205 as crate::grammar::Step)
                }
                fn step_207(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_206 as crate::grammar::Step)
                }
                fn step_208(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_207 as crate::grammar::Step,
                        )
                }
                fn step_209(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(";")
                        .or_else(step_86 as crate::grammar::Step)
                        .or_else(step_104 as crate::grammar::Step)
                        .or_else(step_2 as crate::grammar::Step)
                }
                fn step_210(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_209 as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_211(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_210 as crate::grammar::Step)
                }
                fn step_212(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_211 as crate::grammar::Step)
                }
                fn step_213(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_210 as crate::grammar::Step)
                        .and_then(step_212 as crate::grammar::Step)
                }
                fn step_214(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_213 as crate::grammar::Step)
                }
                fn step_215(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_214 as crate::grammar::Step,
                        )
                }
                fn step_216(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("state")
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_217(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_216 as crate::grammar::Step)
                }
                fn step_218(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_217 as crate::grammar::Step,
                        )
                }
                fn step_219(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("struct")
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_220(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_219 as crate::grammar::Step)
                }
                fn step_221(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_220 as crate::grammar::Step,
                        )
                }
                fn step_222(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("enum").and_then(step_190 as crate::grammar::Step)
                }
                fn step_223(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_222 as crate::grammar::Step)
                }
                fn step_224(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_223 as crate::grammar::Step,
                        )
                }
                fn step_225(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("const")
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_226(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_225 as crate::grammar::Step)
                }
                fn step_227(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_226 as crate::grammar::Step,
                        )
                }
                fn step_228(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("predicate")
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_229(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_228 as crate::grammar::Step)
                }
                fn step_230(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_229 as crate::grammar::Step,
                        )
                }
                fn step_231(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("task").and_then(step_190 as crate::grammar::Step)
                }
                fn step_232(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_231 as crate::grammar::Step)
                }
                fn step_233(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_232 as crate::grammar::Step,
                        )
                }
                fn step_234(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("step").and_then(step_190 as crate::grammar::Step)
                }
                fn step_235(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_234 as crate::grammar::Step)
                }
                fn step_236(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_235 as crate::grammar::Step,
                        )
                }
                fn step_237(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#infix(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#operand as crate::grammar::Step)
                }
                fn step_238(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_237 as crate::grammar::Step)
                }
                fn step_239(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_238 as crate::grammar::Step)
                }
                fn step_240(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_239 as crate::grammar::Step)
                }
                fn step_241(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_240 as crate::grammar::Step)
                }
                fn step_242(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_237 as crate::grammar::Step)
                        .and_then(step_241 as crate::grammar::Step)
                }
                fn step_243(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_242 as crate::grammar::Step)
                }
                fn step_244(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_243 as crate::grammar::Step)
                }
                fn step_245(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#operand(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_244 as crate::grammar::Step)
                }
                fn step_246(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_245 as crate::grammar::Step)
                }
                fn step_247(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#prefix(state).or_else(self::r#open as crate::grammar::Step)
                }
                fn step_248(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_247 as crate::grammar::Step)
                }
                fn step_249(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_248 as crate::grammar::Step)
                }
                fn step_250(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_249 as crate::grammar::Step)
                }
                fn step_251(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#prefix(state)
                        .or_else(self::r#open as crate::grammar::Step)
                        .and_then(step_250 as crate::grammar::Step)
                }
                fn step_252(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_251 as crate::grammar::Step)
                }
                fn step_253(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#field(state)
                        .or_else(self::r#empty_call as crate::grammar::Step)
                        .or_else(self::r#close as crate::grammar::Step)
                }
                fn step_254(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_253 as crate::grammar::Step)
                }
                fn step_255(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_254 as crate::grammar::Step)
                }
                fn step_256(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_255 as crate::grammar::Step)
                }
                fn step_257(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#field(state)
                        .or_else(self::r#empty_call as crate::grammar::Step)
                        .or_else(self::r#close as crate::grammar::Step)
                        .and_then(step_256 as crate::grammar::Step)
                }
                fn step_258(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_257 as crate::grammar::Step)
                }
                fn step_259(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_258 as crate::grammar::Step)
                }
                fn step_260(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_252 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#primary as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_259 as crate::grammar::Step)
                }
                fn step_261(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#bound as crate::grammar::Step)
                }
                fn step_262(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#eventually(state)
                        .or_else(self::r#next_op as crate::grammar::Step)
                        .or_else(self::r#always as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_261 as crate::grammar::Step)
                }
                fn step_263(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_262 as crate::grammar::Step)
                }
                fn step_264(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, step_86 as crate::grammar::Step)
                }
                fn step_265(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("!").and_then(step_264 as crate::grammar::Step)
                }
                fn step_266(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("¬")
                }
                fn step_267(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("not").and_then(step_190 as crate::grammar::Step)
                }
                fn step_268(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_267 as crate::grammar::Step)
                }
                fn step_269(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_265 as crate::grammar::Step)
                        .or_else(step_266 as crate::grammar::Step)
                        .or_else(step_268 as crate::grammar::Step)
                }
                fn step_270(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_269 as crate::grammar::Step,
                        )
                }
                fn step_271(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, self::r#word_rest as crate::grammar::Step)
                }
                fn step_272(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("F").and_then(step_271 as crate::grammar::Step)
                }
                fn step_273(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("◇")
                }
                fn step_274(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("<>")
                }
                fn step_275(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_272 as crate::grammar::Step)
                        .or_else(step_273 as crate::grammar::Step)
                        .or_else(step_274 as crate::grammar::Step)
                }
                fn step_276(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_275 as crate::grammar::Step,
                        )
                }
                fn step_277(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("X").and_then(step_271 as crate::grammar::Step)
                }
                fn step_278(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("○")
                }
                fn step_279(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_277 as crate::grammar::Step)
                        .or_else(step_278 as crate::grammar::Step)
                }
                fn step_280(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_279 as crate::grammar::Step,
                        )
                }
                fn step_281(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#brackets(state).and_then(step_169 as crate::grammar::Step)
                }
                fn step_282(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_281 as crate::grammar::Step)
                }
                fn step_283(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_282 as crate::grammar::Step)
                }
                fn step_284(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .repeat(self::r#trivia as crate::grammar::Step)
                        .and_then(step_283 as crate::grammar::Step)
                        .and_then(self::r#operand_start as crate::grammar::Step)
                }
                fn step_285(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_284 as crate::grammar::Step)
                }
                fn step_286(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(true, step_285 as crate::grammar::Step)
                }
                fn step_287(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("G")
                        .and_then(step_271 as crate::grammar::Step)
                        .and_then(step_286 as crate::grammar::Step)
                }
                fn step_288(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("□")
                }
                fn step_289(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("[]")
                }
                fn step_290(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_287 as crate::grammar::Step)
                        .or_else(step_288 as crate::grammar::Step)
                        .or_else(step_289 as crate::grammar::Step)
                }
                fn step_291(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_290 as crate::grammar::Step,
                        )
                }
                fn step_292(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_83 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_293(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_292 as crate::grammar::Step)
                }
                fn step_294(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_293 as crate::grammar::Step)
                }
                fn step_295(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_294 as crate::grammar::Step)
                }
                fn step_296(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_295 as crate::grammar::Step)
                }
                fn step_297(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_292 as crate::grammar::Step)
                        .and_then(step_296 as crate::grammar::Step)
                }
                fn step_298(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_297 as crate::grammar::Step)
                }
                fn step_299(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_298 as crate::grammar::Step)
                }
                fn step_300(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("[")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_299 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_83 as crate::grammar::Step)
                }
                fn step_301(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("!")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_264 as crate::grammar::Step)
                }
                fn step_302(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("(")
                }
                fn step_303(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("⊤")
                }
                fn step_304(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("⊥")
                }
                fn step_305(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("\"")
                }
                fn step_306(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("T")
                }
                fn step_307(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("R")
                }
                fn step_308(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("W")
                }
                fn step_309(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("M")
                }
                fn step_310(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("V")
                }
                fn step_311(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("S")
                }
                fn step_312(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("and")
                }
                fn step_313(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("or")
                }
                fn step_314(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("in")
                }
                fn step_315(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("ensuring")
                }
                fn step_316(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("U")
                        .or_else(step_306 as crate::grammar::Step)
                        .or_else(step_307 as crate::grammar::Step)
                        .or_else(step_308 as crate::grammar::Step)
                        .or_else(step_309 as crate::grammar::Step)
                        .or_else(step_310 as crate::grammar::Step)
                        .or_else(step_311 as crate::grammar::Step)
                        .or_else(step_312 as crate::grammar::Step)
                        .or_else(step_313 as crate::grammar::Step)
                        .or_else(step_314 as crate::grammar::Step)
                        .or_else(step_315 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_317(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_316 as crate::grammar::Step)
                }
                fn step_318(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("_")
                }
                fn step_319(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#XID_START(state).or_else(step_318 as crate::grammar::Step)
                }
                fn step_320(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_317 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_319 as crate::grammar::Step)
                }
                fn step_321(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_320 as crate::grammar::Step)
                }
                fn step_322(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(">")
                }
                fn step_323(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, step_322 as crate::grammar::Step)
                }
                fn step_324(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("-").and_then(step_323 as crate::grammar::Step)
                }
                fn step_325(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("−")
                }
                fn step_326(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_324 as crate::grammar::Step)
                        .or_else(step_325 as crate::grammar::Step)
                }
                fn step_327(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_326 as crate::grammar::Step,
                        )
                }
                fn step_328(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_all(state)
                        .or_else(self::r#word_some as crate::grammar::Step)
                }
                fn step_329(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_for(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_328 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#word_in as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#set as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_151 as crate::grammar::Step)
                }
                fn step_330(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_329 as crate::grammar::Step)
                }
                fn step_331(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(",")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#element as crate::grammar::Step)
                }
                fn step_332(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_331 as crate::grammar::Step)
                }
                fn step_333(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    super::hidden::skip(state).and_then(step_332 as crate::grammar::Step)
                }
                fn step_334(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_333 as crate::grammar::Step)
                }
                fn step_335(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_334 as crate::grammar::Step)
                }
                fn step_336(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_331 as crate::grammar::Step)
                        .and_then(step_335 as crate::grammar::Step)
                }
                fn step_337(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_336 as crate::grammar::Step)
                }
                fn step_338(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_337 as crate::grammar::Step)
                }
                fn step_339(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#element(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_338 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_75 as crate::grammar::Step)
                }
                fn step_340(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_339 as crate::grammar::Step)
                }
                fn step_341(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_340 as crate::grammar::Step)
                }
                fn step_342(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("{")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_341 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_116 as crate::grammar::Step)
                }
                fn step_343(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_342 as crate::grammar::Step)
                        .or_else(self::r#range as crate::grammar::Step)
                        .or_else(self::r#identifier as crate::grammar::Step)
                }
                fn step_344(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#digits(state).or_else(self::r#path as crate::grammar::Step)
                }
                fn step_345(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("..")
                }
                fn step_346(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#inclusive as crate::grammar::Step)
                }
                fn step_347(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#end(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_345 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_346 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#end as crate::grammar::Step)
                }
                fn step_348(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_347 as crate::grammar::Step)
                }
                fn step_349(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("for").and_then(step_190 as crate::grammar::Step)
                }
                fn step_350(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_349 as crate::grammar::Step)
                }
                fn step_351(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_350 as crate::grammar::Step,
                        )
                }
                fn step_352(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("all").and_then(step_190 as crate::grammar::Step)
                }
                fn step_353(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_352 as crate::grammar::Step)
                }
                fn step_354(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_353 as crate::grammar::Step,
                        )
                }
                fn step_355(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("some").and_then(step_190 as crate::grammar::Step)
                }
                fn step_356(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_355 as crate::grammar::Step)
                }
                fn step_357(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_356 as crate::grammar::Step,
                        )
                }
                fn step_358(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("in").and_then(step_190 as crate::grammar::Step)
                }
                fn step_359(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_358 as crate::grammar::Step)
                }
                fn step_360(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_359 as crate::grammar::Step,
                        )
                }
                fn step_361(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#until(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_261 as crate::grammar::Step)
                }
                fn step_362(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_361 as crate::grammar::Step)
                }
                fn step_363(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("⇒")
                }
                fn step_364(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("->")
                }
                fn step_365(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("=>")
                        .or_else(step_363 as crate::grammar::Step)
                        .or_else(step_364 as crate::grammar::Step)
                }
                fn step_366(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("<->")
                }
                fn step_367(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("⇔")
                }
                fn step_368(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("<=>")
                        .or_else(step_366 as crate::grammar::Step)
                        .or_else(step_367 as crate::grammar::Step)
                }
                fn step_369(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("∨")
                }
                fn step_370(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("or").and_then(step_190 as crate::grammar::Step)
                }
                fn step_371(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_370 as crate::grammar::Step)
                }
                fn step_372(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("||")
                        .or_else(step_369 as crate::grammar::Step)
                        .or_else(step_200 as crate::grammar::Step)
                        .or_else(step_371 as crate::grammar::Step)
                }
                fn step_373(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_372 as crate::grammar::Step,
                        )
                }
                fn step_374(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("∧")
                }
                fn step_375(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("&")
                }
                fn step_376(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("and").and_then(step_190 as crate::grammar::Step)
                }
                fn step_377(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_376 as crate::grammar::Step)
                }
                fn step_378(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("&&")
                        .or_else(step_374 as crate::grammar::Step)
                        .or_else(step_375 as crate::grammar::Step)
                        .or_else(step_377 as crate::grammar::Step)
                }
                fn step_379(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_378 as crate::grammar::Step,
                        )
                }
                fn step_380(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("U")
                        .or_else(step_306 as crate::grammar::Step)
                        .or_else(step_307 as crate::grammar::Step)
                        .or_else(step_308 as crate::grammar::Step)
                        .or_else(step_309 as crate::grammar::Step)
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_381(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_380 as crate::grammar::Step)
                }
                fn step_382(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_381 as crate::grammar::Step,
                        )
                }
                fn step_383(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("ensuring")
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_384(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_383 as crate::grammar::Step)
                }
                fn step_385(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_384 as crate::grammar::Step,
                        )
                }
                fn step_386(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("==")
                }
                fn step_387(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("≠")
                }
                fn step_388(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("!=").or_else(step_387 as crate::grammar::Step)
                }
                fn step_389(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("≤")
                }
                fn step_390(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("<=").or_else(step_389 as crate::grammar::Step)
                }
                fn step_391(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("≥")
                }
                fn step_392(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(">=").or_else(step_391 as crate::grammar::Step)
                }
                fn step_393(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("<")
                }
                fn step_394(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("+")
                }
                fn step_395(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("×")
                }
                fn step_396(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("*").or_else(step_395 as crate::grammar::Step)
                }
                fn step_397(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("÷")
                }
                fn step_398(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("/").or_else(step_397 as crate::grammar::Step)
                }
                fn step_399(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#at_most(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#bound_end as crate::grammar::Step)
                }
                fn step_400(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(",")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(self::r#bound_end as crate::grammar::Step)
                }
                fn step_401(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_400 as crate::grammar::Step)
                }
                fn step_402(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_401 as crate::grammar::Step)
                }
                fn step_403(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#bound_end(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_402 as crate::grammar::Step)
                }
                fn step_404(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_403 as crate::grammar::Step)
                }
                fn step_405(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_399 as crate::grammar::Step)
                        .or_else(step_404 as crate::grammar::Step)
                }
                fn step_406(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("[")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_405 as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_83 as crate::grammar::Step)
                }
                fn step_407(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_406 as crate::grammar::Step)
                }
                fn step_408(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#identifier as crate::grammar::Step)
                }
                fn step_409(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#amount(state)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_408 as crate::grammar::Step)
                }
                fn step_410(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_409 as crate::grammar::Step)
                        .or_else(self::r#identifier as crate::grammar::Step)
                }
                fn step_411(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .optional(self::r#minus as crate::grammar::Step)
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_410 as crate::grammar::Step)
                }
                fn step_412(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_411 as crate::grammar::Step)
                }
                fn step_413(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(".")
                        .and_then(self::r#fraction as crate::grammar::Step)
                }
                fn step_414(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_413 as crate::grammar::Step)
                }
                fn step_415(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_414 as crate::grammar::Step)
                }
                fn step_416(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#exponent as crate::grammar::Step)
                }
                fn step_417(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#digits(state)
                        .and_then(step_415 as crate::grammar::Step)
                        .and_then(step_416 as crate::grammar::Step)
                }
                fn step_418(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_417 as crate::grammar::Step)
                }
                fn step_419(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_418 as crate::grammar::Step,
                        )
                }
                fn step_420(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(")").or_else(step_83 as crate::grammar::Step)
                }
                fn step_421(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("(")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_79 as crate::grammar::Step)
                }
                fn step_422(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_421 as crate::grammar::Step)
                }
                fn step_423(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#identifier(state)
                        .or_else(self::r#position as crate::grammar::Step)
                }
                fn step_424(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(".")
                        .and_then(super::hidden::skip as crate::grammar::Step)
                        .and_then(step_423 as crate::grammar::Step)
                }
                fn step_425(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_424 as crate::grammar::Step)
                }
                fn step_426(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(".")
                        .and_then(self::r#digits as crate::grammar::Step)
                }
                fn step_427(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_426 as crate::grammar::Step)
                }
                fn step_428(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_427 as crate::grammar::Step)
                }
                fn step_429(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#digits(state)
                        .and_then(step_428 as crate::grammar::Step)
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_430(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_429 as crate::grammar::Step)
                }
                fn step_431(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_430 as crate::grammar::Step,
                        )
                }
                fn step_432(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("true").and_then(step_190 as crate::grammar::Step)
                }
                fn step_433(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_432 as crate::grammar::Step)
                }
                fn step_434(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("⊤").or_else(step_433 as crate::grammar::Step)
                }
                fn step_435(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_434 as crate::grammar::Step,
                        )
                }
                fn step_436(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("false")
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_437(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_436 as crate::grammar::Step)
                }
                fn step_438(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("⊥").or_else(step_437 as crate::grammar::Step)
                }
                fn step_439(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_438 as crate::grammar::Step,
                        )
                }
                fn step_440(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#trivia(state).and_then(step_169 as crate::grammar::Step)
                }
                fn step_441(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_440 as crate::grammar::Step)
                }
                fn step_442(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#item_word(state)
                        .and_then(step_441 as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                }
                fn step_443(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_442 as crate::grammar::Step)
                }
                fn step_444(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#word_step(state)
                        .and_then(step_441 as crate::grammar::Step)
                        .and_then(self::r#ASCII_DIGIT as crate::grammar::Step)
                }
                fn step_445(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_444 as crate::grammar::Step)
                }
                fn step_446(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#reserved(state)
                        .or_else(step_443 as crate::grammar::Step)
                        .or_else(step_445 as crate::grammar::Step)
                }
                fn step_447(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("::").and_then(step_169 as crate::grammar::Step)
                }
                fn step_448(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_447 as crate::grammar::Step)
                }
                fn step_449(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_448 as crate::grammar::Step)
                }
                fn step_450(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_446 as crate::grammar::Step)
                        .and_then(step_449 as crate::grammar::Step)
                        .and_then(self::r#identifier as crate::grammar::Step)
                        .and_then(step_172 as crate::grammar::Step)
                }
                fn step_451(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_450 as crate::grammar::Step)
                }
                fn step_452(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_451 as crate::grammar::Step,
                        )
                }
                fn step_453(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("X")
                }
                fn step_454(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("U")
                }
                fn step_455(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("not")
                }
                fn step_456(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("F")
                        .or_else(step_453 as crate::grammar::Step)
                        .or_else(step_454 as crate::grammar::Step)
                        .or_else(step_306 as crate::grammar::Step)
                        .or_else(step_455 as crate::grammar::Step)
                        .or_else(step_312 as crate::grammar::Step)
                        .or_else(step_313 as crate::grammar::Step)
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_457(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_456 as crate::grammar::Step)
                }
                fn step_458(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_457 as crate::grammar::Step,
                        )
                }
                fn step_459(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string(".")
                        .or_else(step_318 as crate::grammar::Step)
                        .or_else(self::r#XID_START as crate::grammar::Step)
                }
                fn step_460(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.lookahead(false, step_459 as crate::grammar::Step)
                }
                fn step_461(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string(".").and_then(step_460 as crate::grammar::Step)
                }
                fn step_462(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_461 as crate::grammar::Step)
                }
                fn step_463(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_462 as crate::grammar::Step)
                }
                fn step_464(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#fraction as crate::grammar::Step)
                }
                fn step_465(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#digits(state)
                        .and_then(step_463 as crate::grammar::Step)
                        .and_then(step_464 as crate::grammar::Step)
                }
                fn step_466(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(self::r#suffix as crate::grammar::Step)
                }
                fn step_467(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_465 as crate::grammar::Step)
                        .or_else(step_414 as crate::grammar::Step)
                        .and_then(step_416 as crate::grammar::Step)
                        .and_then(step_466 as crate::grammar::Step)
                        .and_then(step_190 as crate::grammar::Step)
                }
                fn step_468(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_467 as crate::grammar::Step)
                }
                fn step_469(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_468 as crate::grammar::Step,
                        )
                }
                fn step_470(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            self::r#string as crate::grammar::Step,
                        )
                }
                fn step_471(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            self::r#braces as crate::grammar::Step,
                        )
                }
                fn step_472(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#ASCII_DIGIT(state).or_else(step_318 as crate::grammar::Step)
                }
                fn step_473(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_472 as crate::grammar::Step)
                }
                fn step_474(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#ASCII_DIGIT(state).and_then(step_473 as crate::grammar::Step)
                }
                fn step_475(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_474 as crate::grammar::Step)
                }
                fn step_476(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_475 as crate::grammar::Step,
                        )
                }
                fn step_477(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("E")
                }
                fn step_478(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("-")
                }
                fn step_479(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("+").or_else(step_478 as crate::grammar::Step)
                }
                fn step_480(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.optional(step_479 as crate::grammar::Step)
                }
                fn step_481(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("e")
                        .or_else(step_477 as crate::grammar::Step)
                        .and_then(step_480 as crate::grammar::Step)
                        .and_then(self::r#digits as crate::grammar::Step)
                }
                fn step_482(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_481 as crate::grammar::Step)
                }
                fn step_483(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_482 as crate::grammar::Step,
                        )
                }
                fn step_484(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("f32")
                }
                fn step_485(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("u")
                }
                fn step_486(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("16")
                }
                fn step_487(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("32")
                }
                fn step_488(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("64")
                }
                fn step_489(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("8")
                        .or_else(step_486 as crate::grammar::Step)
                        .or_else(step_487 as crate::grammar::Step)
                        .or_else(step_488 as crate::grammar::Step)
                }
                fn step_490(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("i")
                        .or_else(step_485 as crate::grammar::Step)
                        .and_then(step_489 as crate::grammar::Step)
                }
                fn step_491(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_490 as crate::grammar::Step)
                }
                fn step_492(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("f64")
                        .or_else(step_484 as crate::grammar::Step)
                        .or_else(step_491 as crate::grammar::Step)
                }
                fn step_493(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_492 as crate::grammar::Step,
                        )
                }
                fn step_494(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("r#")
                }
                fn step_495(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(self::r#XID_CONTINUE as crate::grammar::Step)
                }
                fn step_496(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .optional(step_494 as crate::grammar::Step)
                        .and_then(step_319 as crate::grammar::Step)
                        .and_then(step_495 as crate::grammar::Step)
                }
                fn step_497(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_496 as crate::grammar::Step)
                }
                fn step_498(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_497 as crate::grammar::Step,
                        )
                }
                fn step_499(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("{").or_else(step_116 as crate::grammar::Step)
                }
                fn step_500(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_499 as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_501(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_500 as crate::grammar::Step)
                }
                fn step_502(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    self::r#braces(state)
                        .or_else(self::r#string as crate::grammar::Step)
                        .or_else(self::r#character as crate::grammar::Step)
                        .or_else(step_501 as crate::grammar::Step)
                }
                fn step_503(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_502 as crate::grammar::Step)
                }
                fn step_504(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("{")
                        .and_then(step_503 as crate::grammar::Step)
                        .and_then(step_116 as crate::grammar::Step)
                }
                fn step_505(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_504 as crate::grammar::Step)
                }
                fn step_506(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_505 as crate::grammar::Step,
                        )
                }
                fn step_507(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("\\")
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_508(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .lookahead(false, step_305 as crate::grammar::Step)
                        .and_then(self::r#ANY as crate::grammar::Step)
                }
                fn step_509(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_508 as crate::grammar::Step)
                }
                fn step_510(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_507 as crate::grammar::Step)
                        .or_else(step_509 as crate::grammar::Step)
                }
                fn step_511(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.repeat(step_510 as crate::grammar::Step)
                }
                fn step_512(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("\"")
                        .and_then(step_511 as crate::grammar::Step)
                        .and_then(step_305 as crate::grammar::Step)
                }
                fn step_513(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_512 as crate::grammar::Step)
                }
                fn step_514(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_513 as crate::grammar::Step,
                        )
                }
                fn step_515(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    {
                        let strings = ["'"];
                        state.skip_until(&strings)
                    }
                }
                fn step_516(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("\\")
                        .and_then(self::r#ANY as crate::grammar::Step)
                        .and_then(step_515 as crate::grammar::Step)
                }
                fn step_517(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .sequence(step_516 as crate::grammar::Step)
                        .or_else(self::r#ANY as crate::grammar::Step)
                }
                fn step_518(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.match_string("'")
                }
                fn step_519(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .match_string("'")
                        .and_then(step_517 as crate::grammar::Step)
                        .and_then(step_518 as crate::grammar::Step)
                }
                fn step_520(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.sequence(step_519 as crate::grammar::Step)
                }
                fn step_521(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state
                        .atomic(
                            ::pest::Atomicity::Atomic,
                            step_520 as crate::grammar::Step,
                        )
                }
                fn step_522(
                    state: crate::grammar::State<'_>,
                ) -> ::pest::ParseResult<crate::grammar::State<'_>> {
                    state.end_of_input()
                }
            }
            pub use self::visible::*;
        }
        ::pest::state(
            input,
            |state| {
                match rule {
                    Rule::r#WHITESPACE => rules::r#WHITESPACE(state),
                    Rule::r#COMMENT => rules::r#COMMENT(state),
                    Rule::r#block_comment => rules::r#block_comment(state),
                    Rule::r#formula => rules::r#formula(state),
                    Rule::r#fragment => rules::r#fragment(state),
                    Rule::r#prologue => rules::r#prologue(state),
                    Rule::r#next => rules::r#next(state),
                    Rule::r#heading => rules::r#heading(state),
                    Rule::r#item => rules::r#item(state),
                    Rule::r#boundary => rules::r#boundary(state),
                    Rule::r#attribute => rules::r#attribute(state),
                    Rule::r#setting => rules::r#setting(state),
                    Rule::r#doc => rules::r#doc(state),
                    Rule::r#file_doc => rules::r#file_doc(state),
                    Rule::r#state => rules::r#state(state),
                    Rule::r#record => rules::r#record(state),
                    Rule::r#enumeration => rules::r#enumeration(state),
                    Rule::r#constant => rules::r#constant(state),
                    Rule::r#predicate => rules::r#predicate(state),
                    Rule::r#task => rules::r#task(state),
                    Rule::r#step => rules::r#step(state),
                    Rule::r#fields => rules::r#fields(state),
                    Rule::r#parameters => rules::r#parameters(state),
                    Rule::r#field_declaration => rules::r#field_declaration(state),
                    Rule::r#field_type => rules::r#field_type(state),
                    Rule::r#path => rules::r#path(state),
                    Rule::r#optional => rules::r#optional(state),
                    Rule::r#array_open => rules::r#array_open(state),
                    Rule::r#array_close => rules::r#array_close(state),
                    Rule::r#unit => rules::r#unit(state),
                    Rule::r#unit_one => rules::r#unit_one(state),
                    Rule::r#unit_power => rules::r#unit_power(state),
                    Rule::r#header => rules::r#header(state),
                    Rule::r#header_type => rules::r#header_type(state),
                    Rule::r#host_type => rules::r#host_type(state),
                    Rule::r#item_word => rules::r#item_word(state),
                    Rule::r#word_state => rules::r#word_state(state),
                    Rule::r#word_struct => rules::r#word_struct(state),
                    Rule::r#word_enum => rules::r#word_enum(state),
                    Rule::r#word_const => rules::r#word_const(state),
                    Rule::r#word_predicate => rules::r#word_predicate(state),
                    Rule::r#word_task => rules::r#word_task(state),
                    Rule::r#word_step => rules::r#word_step(state),
                    Rule::r#expression => rules::r#expression(state),
                    Rule::r#operand => rules::r#operand(state),
                    Rule::r#prefix => rules::r#prefix(state),
                    Rule::r#not => rules::r#not(state),
                    Rule::r#eventually => rules::r#eventually(state),
                    Rule::r#next_op => rules::r#next_op(state),
                    Rule::r#always => rules::r#always(state),
                    Rule::r#brackets => rules::r#brackets(state),
                    Rule::r#operand_start => rules::r#operand_start(state),
                    Rule::r#minus => rules::r#minus(state),
                    Rule::r#quantifier => rules::r#quantifier(state),
                    Rule::r#set => rules::r#set(state),
                    Rule::r#element => rules::r#element(state),
                    Rule::r#range => rules::r#range(state),
                    Rule::r#end => rules::r#end(state),
                    Rule::r#inclusive => rules::r#inclusive(state),
                    Rule::r#word_for => rules::r#word_for(state),
                    Rule::r#word_all => rules::r#word_all(state),
                    Rule::r#word_some => rules::r#word_some(state),
                    Rule::r#word_in => rules::r#word_in(state),
                    Rule::r#infix => rules::r#infix(state),
                    Rule::r#implies => rules::r#implies(state),
                    Rule::r#iff => rules::r#iff(state),
                    Rule::r#or => rules::r#or(state),
                    Rule::r#and => rules::r#and(state),
                    Rule::r#until => rules::r#until(state),
                    Rule::r#ensuring => rules::r#ensuring(state),
                    Rule::r#equal => rules::r#equal(state),
                    Rule::r#unequal => rules::r#unequal(state),
                    Rule::r#at_most => rules::r#at_most(state),
                    Rule::r#at_least => rules::r#at_least(state),
                    Rule::r#less => rules::r#less(state),
                    Rule::r#greater => rules::r#greater(state),
                    Rule::r#plus => rules::r#plus(state),
                    Rule::r#times => rules::r#times(state),
                    Rule::r#divide => rules::r#divide(state),
                    Rule::r#comma => rules::r#comma(state),
                    Rule::r#call => rules::r#call(state),
                    Rule::r#index => rules::r#index(state),
                    Rule::r#bound => rules::r#bound(state),
                    Rule::r#bound_end => rules::r#bound_end(state),
                    Rule::r#amount => rules::r#amount(state),
                    Rule::r#open => rules::r#open(state),
                    Rule::r#close => rules::r#close(state),
                    Rule::r#empty_call => rules::r#empty_call(state),
                    Rule::r#field => rules::r#field(state),
                    Rule::r#position => rules::r#position(state),
                    Rule::r#primary => rules::r#primary(state),
                    Rule::r#truth => rules::r#truth(state),
                    Rule::r#falsity => rules::r#falsity(state),
                    Rule::r#name => rules::r#name(state),
                    Rule::r#trivia => rules::r#trivia(state),
                    Rule::r#reserved => rules::r#reserved(state),
                    Rule::r#number => rules::r#number(state),
                    Rule::r#text => rules::r#text(state),
                    Rule::r#verbatim => rules::r#verbatim(state),
                    Rule::r#digits => rules::r#digits(state),
                    Rule::r#fraction => rules::r#fraction(state),
                    Rule::r#exponent => rules::r#exponent(state),
                    Rule::r#suffix => rules::r#suffix(state),
                    Rule::r#identifier => rules::r#identifier(state),
                    Rule::r#word_rest => rules::r#word_rest(state),
                    Rule::r#braces => rules::r#braces(state),
                    Rule::r#string => rules::r#string(state),
                    Rule::r#character => rules::r#character(state),
                    Rule::EOI => rules::EOI(state),
                }
            },
        )
    }
}

// Generated from grammar.pest by tests/grammar.rs; do not edit.

use super::Kind::{self, *};
use super::Peg::{self, *};
/// The rules of the grammar; `EOI` is the end of the text.
#[allow(
    non_camel_case_types,
    clippy::upper_case_acronyms,
    reason = "named as in the grammar"
)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rule {
    EOI,
    WHITESPACE,
    COMMENT,
    block_comment,
    formula,
    fragment,
    prologue,
    next,
    heading,
    item,
    boundary,
    attribute,
    setting,
    doc,
    file_doc,
    state,
    record,
    enumeration,
    constant,
    predicate,
    task,
    step,
    fields,
    parameters,
    field_declaration,
    field_type,
    path,
    optional,
    array_open,
    array_close,
    unit,
    unit_one,
    unit_power,
    header,
    header_type,
    host_type,
    item_word,
    word_state,
    word_struct,
    word_enum,
    word_const,
    word_predicate,
    word_task,
    word_step,
    expression,
    operand,
    prefix,
    not,
    eventually,
    next_op,
    always,
    brackets,
    operand_start,
    infix_word,
    minus,
    quantifier,
    set,
    element,
    range,
    end,
    inclusive,
    word_for,
    word_all,
    word_some,
    word_in,
    infix,
    implies,
    iff,
    or,
    and,
    until,
    ensuring,
    equal,
    unequal,
    at_most,
    at_least,
    less,
    greater,
    plus,
    times,
    divide,
    comma,
    call,
    index,
    bound,
    bound_end,
    amount,
    open,
    close,
    empty_call,
    field,
    position,
    primary,
    truth,
    falsity,
    name,
    trivia,
    reserved,
    number,
    text,
    verbatim,
    digits,
    fraction,
    exponent,
    suffix,
    identifier,
    word_rest,
    braces,
    string,
    character,
}
/// The definition of each rule, in the same order.
pub(super) static RULES: [(Kind, Peg); 110] = [
    (Pair, End),
    (Blank, Choice(&[Text(" "), Text("\t"), Text("\r"), Text("\n"), Text("\u{feff}")])),
    (
        Blank,
        Choice(
            &[
                Call(Rule::block_comment),
                Sequence(
                    &[
                        Text("//"),
                        Not(
                            &Choice(
                                &[Text("!"), Sequence(&[Text("/"), Not(&Text("/"))])],
                            ),
                        ),
                        Repeat(&Sequence(&[Not(&Text("\n")), Class(|_| true)])),
                    ],
                ),
            ],
        ),
    ),
    (
        Silent,
        Sequence(
            &[
                Text("/*"),
                Repeat(&Sequence(&[Not(&Text("*/")), Class(|_| true)])),
                Text("*/"),
            ],
        ),
    ),
    (Silent, Sequence(&[Start, Call(Rule::expression), Call(Rule::EOI)])),
    (
        Silent,
        Sequence(
            &[
                Start,
                Repeat(&Call(Rule::attribute)),
                Optional(&Call(Rule::header)),
                Call(Rule::expression),
                Call(Rule::EOI),
            ],
        ),
    ),
    (Silent, Sequence(&[Start, Repeat(&Call(Rule::file_doc))])),
    (Silent, Sequence(&[Start, Choice(&[Call(Rule::item), Call(Rule::EOI)])])),
    (
        Silent,
        Sequence(
            &[
                Start,
                Repeat(&Choice(&[Call(Rule::doc), Call(Rule::attribute)])),
                Choice(&[Call(Rule::word_predicate), Call(Rule::word_task)]),
                Call(Rule::identifier),
                Call(Rule::parameters),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Repeat(&Choice(&[Call(Rule::doc), Call(Rule::attribute)])),
                Choice(
                    &[
                        Call(Rule::state),
                        Call(Rule::record),
                        Call(Rule::enumeration),
                        Call(Rule::constant),
                        Call(Rule::predicate),
                        Call(Rule::task),
                        Call(Rule::step),
                    ],
                ),
                Optional(&Text(";")),
                Ahead(&Choice(&[Call(Rule::boundary), Call(Rule::EOI)])),
            ],
        ),
    ),
    (
        Silent,
        Choice(
            &[
                Call(Rule::doc),
                Call(Rule::attribute),
                Sequence(&[Call(Rule::item_word), Call(Rule::identifier)]),
                Sequence(&[Call(Rule::word_step), Call(Rule::digits)]),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Text("#"),
                Text("["),
                Call(Rule::identifier),
                Optional(
                    &Sequence(
                        &[
                            Text("("),
                            Optional(
                                &Sequence(
                                    &[
                                        Call(Rule::setting),
                                        Repeat(&Sequence(&[Text(","), Call(Rule::setting)])),
                                        Optional(&Text(",")),
                                    ],
                                ),
                            ),
                            Text(")"),
                        ],
                    ),
                ),
                Text("]"),
            ],
        ),
    ),
    (Pair, Sequence(&[Call(Rule::identifier), Text("="), Call(Rule::digits)])),
    (
        Token,
        Sequence(
            &[
                Text("///"),
                Not(&Text("/")),
                Repeat(&Sequence(&[Not(&Choice(&[Text("\n")])), Class(|_| true)])),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Text("//!"),
                Repeat(&Sequence(&[Not(&Choice(&[Text("\n")])), Class(|_| true)])),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_state),
                Call(Rule::identifier),
                Choice(
                    &[
                        Call(Rule::fields),
                        Sequence(&[Text(":"), Call(Rule::host_type), Ahead(&Text(";"))]),
                    ],
                ),
            ],
        ),
    ),
    (
        Pair,
        Sequence(&[Call(Rule::word_struct), Call(Rule::identifier), Call(Rule::fields)]),
    ),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_enum),
                Call(Rule::identifier),
                Text("{"),
                Optional(
                    &Sequence(
                        &[
                            Call(Rule::identifier),
                            Repeat(&Sequence(&[Text(","), Call(Rule::identifier)])),
                            Optional(&Text(",")),
                        ],
                    ),
                ),
                Text("}"),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_const),
                Call(Rule::identifier),
                Optional(&Sequence(&[Call(Rule::word_in), Call(Rule::unit)])),
                Text("="),
                Call(Rule::expression),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_predicate),
                Call(Rule::identifier),
                Optional(&Call(Rule::parameters)),
                Text("="),
                Call(Rule::expression),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_task),
                Call(Rule::identifier),
                Optional(&Call(Rule::parameters)),
                Text("="),
                Call(Rule::expression),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_step),
                Call(Rule::amount),
                Not(&Sequence(&[Call(Rule::item_word), Call(Rule::identifier)])),
                Call(Rule::identifier),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Text("{"),
                Optional(
                    &Sequence(
                        &[
                            Call(Rule::field_declaration),
                            Repeat(
                                &Sequence(&[Text(","), Call(Rule::field_declaration)]),
                            ),
                            Optional(&Text(",")),
                        ],
                    ),
                ),
                Text("}"),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Text("("),
                Optional(
                    &Sequence(
                        &[
                            Call(Rule::field_declaration),
                            Repeat(
                                &Sequence(&[Text(","), Call(Rule::field_declaration)]),
                            ),
                            Optional(&Text(",")),
                        ],
                    ),
                ),
                Text(")"),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Repeat(&Call(Rule::doc)),
                Call(Rule::identifier),
                Text(":"),
                Call(Rule::field_type),
                Optional(&Sequence(&[Call(Rule::word_in), Call(Rule::unit)])),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Repeat(&Call(Rule::array_open)),
                Call(Rule::path),
                Optional(&Call(Rule::optional)),
                Repeat(&Call(Rule::array_close)),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Call(Rule::identifier),
                Repeat(
                    &Sequence(
                        &[
                            Repeat(&Call(Rule::trivia)),
                            Text("::"),
                            Repeat(&Call(Rule::trivia)),
                            Call(Rule::identifier),
                        ],
                    ),
                ),
            ],
        ),
    ),
    (Pair, Text("?")),
    (Pair, Text("[")),
    (
        Pair,
        Sequence(
            &[
                Text(";"),
                Choice(&[Call(Rule::digits), Call(Rule::identifier)]),
                Text("]"),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Choice(&[Call(Rule::unit_one), Call(Rule::unit_power)]),
                Repeat(
                    &Sequence(
                        &[
                            Choice(&[Call(Rule::times), Call(Rule::divide)]),
                            Call(Rule::unit_power),
                        ],
                    ),
                ),
            ],
        ),
    ),
    (Token, Sequence(&[Text("1"), Not(&Class(unicode_ident::is_xid_continue))])),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::identifier),
                Optional(
                    &Sequence(
                        &[Text("^"), Optional(&Call(Rule::minus)), Call(Rule::digits)],
                    ),
                ),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Text("|"),
                Call(Rule::identifier),
                Text(":"),
                Call(Rule::header_type),
                Text("|"),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Sequence(&[Not(&Text("|")), Class(|_| true)]),
                Repeat(&Sequence(&[Not(&Text("|")), Class(|_| true)])),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Sequence(
                    &[
                        Not(&Choice(&[Text(";"), Text("="), Text("{"), Text("\n")])),
                        Class(|_| true),
                    ],
                ),
                Repeat(
                    &Sequence(
                        &[
                            Not(&Choice(&[Text(";"), Text("="), Text("{"), Text("\n")])),
                            Class(|_| true),
                        ],
                    ),
                ),
            ],
        ),
    ),
    (
        Silent,
        Choice(
            &[
                Call(Rule::word_state),
                Call(Rule::word_struct),
                Call(Rule::word_enum),
                Call(Rule::word_const),
                Call(Rule::word_predicate),
                Call(Rule::word_task),
            ],
        ),
    ),
    (Token, Sequence(&[Text("state"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("struct"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("enum"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("const"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("predicate"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("task"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("step"), Not(&Class(unicode_ident::is_xid_continue))])),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::operand),
                Repeat(&Sequence(&[Call(Rule::infix), Call(Rule::operand)])),
            ],
        ),
    ),
    (
        Silent,
        Sequence(
            &[
                Repeat(&Choice(&[Call(Rule::prefix), Call(Rule::open)])),
                Call(Rule::primary),
                Repeat(
                    &Choice(
                        &[Call(Rule::field), Call(Rule::empty_call), Call(Rule::close)],
                    ),
                ),
            ],
        ),
    ),
    (
        Silent,
        Choice(
            &[
                Call(Rule::not),
                Sequence(
                    &[
                        Choice(
                            &[
                                Call(Rule::eventually),
                                Call(Rule::next_op),
                                Call(Rule::always),
                            ],
                        ),
                        Optional(&Call(Rule::bound)),
                    ],
                ),
                Call(Rule::minus),
                Call(Rule::quantifier),
            ],
        ),
    ),
    (
        Token,
        Choice(
            &[
                Sequence(&[Text("!"), Not(&Text("="))]),
                Text("¬"),
                Sequence(&[Text("not"), Not(&Class(unicode_ident::is_xid_continue))]),
            ],
        ),
    ),
    (
        Token,
        Choice(
            &[
                Sequence(&[Text("F"), Not(&Call(Rule::word_rest))]),
                Text("◇"),
                Text("<>"),
            ],
        ),
    ),
    (Token, Choice(&[Sequence(&[Text("X"), Not(&Call(Rule::word_rest))]), Text("○")])),
    (
        Token,
        Choice(
            &[
                Sequence(
                    &[
                        Text("G"),
                        Not(&Call(Rule::word_rest)),
                        Ahead(
                            &Sequence(
                                &[
                                    Repeat(&Call(Rule::trivia)),
                                    Optional(
                                        &Sequence(
                                            &[Call(Rule::brackets), Repeat(&Call(Rule::trivia))],
                                        ),
                                    ),
                                    Call(Rule::operand_start),
                                ],
                            ),
                        ),
                    ],
                ),
                Text("□"),
                Text("[]"),
            ],
        ),
    ),
    (
        Silent,
        Sequence(
            &[
                Text("["),
                Repeat(
                    &Sequence(&[Not(&Choice(&[Text("["), Text("]")])), Class(|_| true)]),
                ),
                Text("]"),
            ],
        ),
    ),
    (
        Silent,
        Choice(
            &[
                Sequence(&[Text("!"), Not(&Text("="))]),
                Text("¬"),
                Text("("),
                Text("◇"),
                Text("<>"),
                Text("○"),
                Text("□"),
                Text("[]"),
                Text("⊤"),
                Text("⊥"),
                Text("{"),
                Text("\""),
                Class(|next| next.is_ascii_digit()),
                Sequence(
                    &[
                        Not(
                            &Sequence(
                                &[
                                    Call(Rule::infix_word),
                                    Not(&Class(unicode_ident::is_xid_continue)),
                                ],
                            ),
                        ),
                        Choice(&[Class(unicode_ident::is_xid_start), Text("_")]),
                    ],
                ),
            ],
        ),
    ),
    (
        Silent,
        Choice(
            &[
                Text("U"),
                Text("T"),
                Text("and"),
                Text("or"),
                Text("in"),
                Text("ensuring"),
                Sequence(
                    &[
                        Choice(&[Text("R"), Text("W"), Text("M"), Text("V"), Text("S")]),
                        Not(&Sequence(&[Repeat(&Call(Rule::trivia)), Text("::")])),
                    ],
                ),
            ],
        ),
    ),
    (Token, Choice(&[Sequence(&[Text("-"), Not(&Text(">"))]), Text("−")])),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::word_for),
                Choice(&[Call(Rule::word_all), Call(Rule::word_some)]),
                Call(Rule::identifier),
                Call(Rule::word_in),
                Call(Rule::set),
                Text(":"),
            ],
        ),
    ),
    (
        Pair,
        Choice(
            &[
                Sequence(
                    &[
                        Text("{"),
                        Optional(
                            &Sequence(
                                &[
                                    Call(Rule::element),
                                    Repeat(&Sequence(&[Text(","), Call(Rule::element)])),
                                    Optional(&Text(",")),
                                ],
                            ),
                        ),
                        Text("}"),
                    ],
                ),
                Call(Rule::range),
                Call(Rule::identifier),
            ],
        ),
    ),
    (Pair, Choice(&[Call(Rule::digits), Call(Rule::path)])),
    (
        Pair,
        Sequence(
            &[
                Call(Rule::end),
                Text(".."),
                Optional(&Call(Rule::inclusive)),
                Call(Rule::end),
            ],
        ),
    ),
    (Pair, Choice(&[Call(Rule::digits), Call(Rule::identifier)])),
    (Pair, Text("=")),
    (Token, Sequence(&[Text("for"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("all"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("some"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Token, Sequence(&[Text("in"), Not(&Class(unicode_ident::is_xid_continue))])),
    (
        Silent,
        Choice(
            &[
                Call(Rule::implies),
                Call(Rule::iff),
                Call(Rule::or),
                Call(Rule::and),
                Sequence(&[Call(Rule::until), Optional(&Call(Rule::bound))]),
                Call(Rule::ensuring),
                Call(Rule::equal),
                Call(Rule::unequal),
                Call(Rule::at_most),
                Call(Rule::at_least),
                Call(Rule::less),
                Call(Rule::greater),
                Call(Rule::plus),
                Call(Rule::minus),
                Call(Rule::times),
                Call(Rule::divide),
                Call(Rule::comma),
                Call(Rule::call),
                Call(Rule::index),
            ],
        ),
    ),
    (Pair, Choice(&[Text("=>"), Text("⇒"), Text("->")])),
    (Pair, Choice(&[Text("<=>"), Text("<->"), Text("⇔")])),
    (
        Token,
        Choice(
            &[
                Text("||"),
                Text("∨"),
                Text("|"),
                Sequence(&[Text("or"), Not(&Class(unicode_ident::is_xid_continue))]),
            ],
        ),
    ),
    (
        Token,
        Choice(
            &[
                Text("&&"),
                Text("∧"),
                Text("&"),
                Sequence(&[Text("and"), Not(&Class(unicode_ident::is_xid_continue))]),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Choice(&[Text("U"), Text("T"), Text("R"), Text("W"), Text("M")]),
                Not(&Class(unicode_ident::is_xid_continue)),
            ],
        ),
    ),
    (Token, Sequence(&[Text("ensuring"), Not(&Class(unicode_ident::is_xid_continue))])),
    (Pair, Text("==")),
    (Pair, Choice(&[Text("!="), Text("≠")])),
    (Pair, Choice(&[Text("<="), Text("≤")])),
    (Pair, Choice(&[Text(">="), Text("≥")])),
    (Pair, Text("<")),
    (Pair, Text(">")),
    (Pair, Text("+")),
    (Pair, Choice(&[Text("*"), Text("×")])),
    (Pair, Choice(&[Text("/"), Text("÷")])),
    (Pair, Text(",")),
    (Pair, Text("(")),
    (Pair, Text("[")),
    (
        Pair,
        Sequence(
            &[
                Text("["),
                Choice(
                    &[
                        Sequence(&[Call(Rule::at_most), Call(Rule::bound_end)]),
                        Sequence(
                            &[
                                Call(Rule::bound_end),
                                Optional(&Sequence(&[Text(","), Call(Rule::bound_end)])),
                            ],
                        ),
                    ],
                ),
                Text("]"),
            ],
        ),
    ),
    (
        Pair,
        Sequence(
            &[
                Optional(&Call(Rule::minus)),
                Choice(
                    &[
                        Sequence(
                            &[Call(Rule::amount), Optional(&Call(Rule::identifier))],
                        ),
                        Call(Rule::identifier),
                    ],
                ),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Call(Rule::digits),
                Optional(&Sequence(&[Text("."), Call(Rule::fraction)])),
                Optional(&Call(Rule::exponent)),
            ],
        ),
    ),
    (Pair, Text("(")),
    (Pair, Choice(&[Text(")"), Text("]")])),
    (Pair, Sequence(&[Text("("), Text(")")])),
    (
        Pair,
        Sequence(&[Text("."), Choice(&[Call(Rule::identifier), Call(Rule::position)])]),
    ),
    (
        Token,
        Sequence(
            &[
                Call(Rule::digits),
                Optional(&Sequence(&[Text("."), Call(Rule::digits)])),
                Not(&Class(unicode_ident::is_xid_continue)),
            ],
        ),
    ),
    (
        Silent,
        Choice(
            &[
                Call(Rule::truth),
                Call(Rule::falsity),
                Call(Rule::number),
                Call(Rule::verbatim),
                Call(Rule::text),
                Call(Rule::name),
            ],
        ),
    ),
    (
        Token,
        Choice(
            &[
                Text("⊤"),
                Sequence(&[Text("true"), Not(&Class(unicode_ident::is_xid_continue))]),
            ],
        ),
    ),
    (
        Token,
        Choice(
            &[
                Text("⊥"),
                Sequence(&[Text("false"), Not(&Class(unicode_ident::is_xid_continue))]),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Not(
                    &Choice(
                        &[
                            Call(Rule::reserved),
                            Sequence(
                                &[
                                    Call(Rule::item_word),
                                    Sequence(
                                        &[Call(Rule::trivia), Repeat(&Call(Rule::trivia))],
                                    ),
                                    Call(Rule::identifier),
                                ],
                            ),
                            Sequence(
                                &[
                                    Call(Rule::word_step),
                                    Sequence(
                                        &[Call(Rule::trivia), Repeat(&Call(Rule::trivia))],
                                    ),
                                    Class(|next| next.is_ascii_digit()),
                                ],
                            ),
                        ],
                    ),
                ),
                Optional(&Sequence(&[Text("::"), Repeat(&Call(Rule::trivia))])),
                Call(Rule::identifier),
                Repeat(
                    &Sequence(
                        &[
                            Repeat(&Call(Rule::trivia)),
                            Text("::"),
                            Repeat(&Call(Rule::trivia)),
                            Call(Rule::identifier),
                        ],
                    ),
                ),
            ],
        ),
    ),
    (Silent, Choice(&[Call(Rule::WHITESPACE), Call(Rule::COMMENT)])),
    (
        Token,
        Sequence(
            &[
                Choice(
                    &[
                        Text("F"),
                        Text("X"),
                        Text("U"),
                        Text("T"),
                        Text("not"),
                        Text("and"),
                        Text("or"),
                    ],
                ),
                Not(&Class(unicode_ident::is_xid_continue)),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Choice(
                    &[
                        Sequence(
                            &[
                                Call(Rule::digits),
                                Optional(
                                    &Sequence(
                                        &[
                                            Text("."),
                                            Not(
                                                &Choice(
                                                    &[Text("."), Text("_"), Class(unicode_ident::is_xid_start)],
                                                ),
                                            ),
                                        ],
                                    ),
                                ),
                                Optional(&Call(Rule::fraction)),
                            ],
                        ),
                        Sequence(&[Text("."), Call(Rule::fraction)]),
                    ],
                ),
                Optional(&Call(Rule::exponent)),
                Optional(&Call(Rule::suffix)),
                Not(&Class(unicode_ident::is_xid_continue)),
            ],
        ),
    ),
    (Token, Call(Rule::string)),
    (Token, Call(Rule::braces)),
    (
        Token,
        Sequence(
            &[
                Class(|next| next.is_ascii_digit()),
                Repeat(&Choice(&[Class(|next| next.is_ascii_digit()), Text("_")])),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Class(|next| next.is_ascii_digit()),
                Repeat(&Choice(&[Class(|next| next.is_ascii_digit()), Text("_")])),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Choice(&[Text("e"), Text("E")]),
                Optional(&Choice(&[Text("+"), Text("-")])),
                Call(Rule::digits),
            ],
        ),
    ),
    (
        Token,
        Choice(
            &[
                Text("f64"),
                Text("f32"),
                Sequence(
                    &[
                        Choice(&[Text("i"), Text("u")]),
                        Choice(&[Text("8"), Text("16"), Text("32"), Text("64")]),
                    ],
                ),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Optional(&Text("r#")),
                Choice(&[Class(unicode_ident::is_xid_start), Text("_")]),
                Repeat(&Class(unicode_ident::is_xid_continue)),
            ],
        ),
    ),
    (Silent, Choice(&[Class(unicode_ident::is_xid_continue), Text("::")])),
    (
        Token,
        Sequence(
            &[
                Text("{"),
                Repeat(
                    &Choice(
                        &[
                            Call(Rule::braces),
                            Call(Rule::string),
                            Call(Rule::character),
                            Sequence(
                                &[Not(&Choice(&[Text("{"), Text("}")])), Class(|_| true)],
                            ),
                        ],
                    ),
                ),
                Text("}"),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Text("\""),
                Repeat(
                    &Choice(
                        &[
                            Sequence(&[Text("\\"), Class(|_| true)]),
                            Sequence(&[Not(&Text("\"")), Class(|_| true)]),
                        ],
                    ),
                ),
                Text("\""),
            ],
        ),
    ),
    (
        Token,
        Sequence(
            &[
                Text("'"),
                Choice(
                    &[
                        Sequence(
                            &[
                                Text("\\"),
                                Class(|_| true),
                                Repeat(
                                    &Sequence(&[Not(&Choice(&[Text("'")])), Class(|_| true)]),
                                ),
                            ],
                        ),
                        Class(|_| true),
                    ],
                ),
                Text("'"),
            ],
        ),
    ),
];

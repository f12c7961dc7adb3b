//! Lays out a task file: the work of `tltlc fmt`.
//!
//! Only blanks change. Line breaks stay where the author put them (at most one empty line in a
//! row), a line that continues an item or stands within brackets is indented, and blanks stand as
//! in the reference: around operators, none inside brackets. Comments, spellings (`◇` or `F`) and
//! Rust code are kept. All lines end as the first one does, in `\n` or in `\r\n`; a byte order mark,
//! which means nothing in UTF-8, is left out.
//!
//! It works on tokens and not on the syntax tree, which has no comments. Its safety is checked, not
//! argued: the result is split into tokens again, and unless these are the tokens of the input, the
//! input is left alone. Laying out twice changes nothing more. The cost is linear.

mod lex;

use std::borrow::Cow;

use lex::{Kind, Token, lex};

/// The columns of one level of indentation.
const INDENT: usize = 4;

/// The text of a task file, laid out; `None` if its tokens would change, which would be a fault of
/// this module.
///
/// The text must be one that [`parse::file`](tltl_compiler::parse::file) accepts; on others the
/// result may lay out nonsense.
///
/// ```
/// let text = "task   go=F  (a&&b)\n||  X c // or so";
/// let laid_out = tltlc::format::format(text).ok_or("the tokens changed")?;
/// assert_eq!(laid_out, "task go = F (a && b)\n    || X c // or so\n");
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn format(text: &str) -> Option<String> {
    let first = text.find('\n').unwrap_or_default();
    let returns = text[..first].ends_with('\r');
    let mut plain = Cow::Borrowed(text);
    while plain.contains("\r\n") {
        plain = Cow::Owned(plain.replace("\r\n", "\n"));
    }
    let laid_out = with_line_feeds(&plain)?;
    Some(if returns { laid_out.replace('\n', "\r\n") } else { laid_out })
}

/// The same for a text whose lines end in `\n`.
fn with_line_feeds(text: &str) -> Option<String> {
    let tokens = lex(text);
    let mut layout = Layout::default();
    for (at, token) in tokens.iter().enumerate() {
        layout.token(token, &tokens[at + 1..]);
    }
    if !layout.out.is_empty() {
        layout.out.push('\n');
    }
    let again = lex(&layout.out);
    let same = again.len() == tokens.len()
        && again.iter().zip(&tokens).all(|(a, b)| a.text == b.text && a.kind == b.kind);
    same.then_some(layout.out)
}

/// An open bracket.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Open {
    /// A block of fields, which has blanks inside its braces.
    Fields,
    /// A bound of steps, which has none: `[0,3]`, but `[0.1 s, 0.3 s]`.
    Steps,
    Other,
}

/// The text so far, and what is known of the token before the next one.
#[derive(Default)]
struct Layout<'a> {
    out: String,
    before: Option<Token<'a>>,
    open: Vec<Open>,
    /// Whether the last token was an operator that stands before its operand.
    prefix: bool,
    /// Whether an item has begun on an earlier line, so that the next line continues it.
    within_item: bool,
}

impl<'a> Layout<'a> {
    /// Adds a token, with the line break or the blank that belongs before it.
    fn token(&mut self, token: &Token<'a>, rest: &[Token<'a>]) {
        let bracket = matches!(token.kind, Kind::Symbol | Kind::Bound);
        let closes = matches!(token.text, ")" | "]" | "}") && bracket;
        let was_block = closes && self.open.pop() == Some(Open::Fields);
        let prefix = self.is_prefix(token);
        if token.newlines > 0 || self.before.is_none() {
            self.start_line(token, rest.first());
        } else if self.blank(token, prefix, was_block) {
            self.out.push(' ');
        }
        self.out.push_str(token.text);
        if matches!(token.text, "(" | "[" | "{") && bracket {
            self.open.push(match token.kind {
                _ if token.text == "{" => Open::Fields,
                Kind::Bound if !has_time(rest) => Open::Steps,
                _ => Open::Other,
            });
        }
        self.prefix = prefix;
        self.within_item = !(token.text == ";" && self.open.is_empty())
            && (self.within_item || !matches!(token.kind, Kind::Comment | Kind::Doc));
        self.before = Some(*token);
    }

    /// Begins a line, indented by the open brackets, and by one level more if it continues an item.
    fn start_line(&mut self, token: &Token<'a>, next: Option<&Token<'a>>) {
        if self.before.is_some() {
            self.out.push_str(if token.newlines > 1 { "\n\n" } else { "\n" });
        }
        if self.open.is_empty() && begins_item(token, next) {
            self.within_item = false;
        }
        let continued = self.within_item && self.open.is_empty();
        let closing_line = matches!(token.text, ")" | "]" | "}") && self.open.is_empty();
        let depth = self.open.len() + usize::from(continued && !closing_line);
        self.out.push_str(&" ".repeat(INDENT * depth));
    }

    /// Whether a token is an operator that stands before its operand. A minus is one where no
    /// operand ends before it.
    fn is_prefix(&self, token: &Token<'_>) -> bool {
        match token.text {
            _ if token.kind == Kind::Unit => false,
            "!" | "¬" | "◇" | "○" | "<>" | "□" | "[]" => true,
            "F" | "X" | "G" | "not" => token.kind == Kind::Operator,
            // As in `[<=3]`.
            "<=" | "≤" => self.before.is_some_and(|before| before.kind == Kind::Bound),
            "-" | "−" => self.before.is_none_or(|before| !before.ends_operand()),
            _ => false,
        }
    }

    /// Whether a blank belongs before a token that does not begin a line. Rules are in order of
    /// precedence; the first that matches decides.
    fn blank(&self, token: &Token<'_>, prefix: bool, closes_block: bool) -> bool {
        let Some(before) = self.before else { return false };
        let symbol =
            |text: &str| matches!(before.kind, Kind::Symbol | Kind::Bound) && before.text == text;
        if before.kind == Kind::Comment || token.kind == Kind::Comment {
            return true;
        }
        let calls = before.ends_operand();
        match token.text {
            _ if token.kind == Kind::Unit => before.kind != Kind::Unit,
            _ if token.kind == Kind::Rust => !symbol("("),
            "," | ";" | ":" | "?" => false,
            "." => self.after_number(before),
            "::" | ".." | "..=" => false,
            _ if symbol("..") || symbol("..=") => false,
            ")" | "]" => false,
            "}" => closes_block && !symbol("{"),
            "{" => true,
            _ if symbol(",") && self.open.last() == Some(&Open::Steps) => false,
            "(" | "[" if calls || token.kind == Kind::Bound || symbol("#") => false,
            _ if symbol("(") || symbol("[") || symbol(".") || symbol("::") => false,
            _ if self.prefix && before.kind == Kind::Symbol => {
                prefix && token.text == before.text && token.text == "-"
            }
            _ => true,
        }
    }
}

impl Layout<'_> {
    /// Whether the token before is a number, which would take a dot after it for its own. The
    /// position of a field is none: `pose.0.1`.
    fn after_number(&self, before: Token<'_>) -> bool {
        let position = self.out[..self.out.len() - before.text.len()].ends_with('.');
        before.text.starts_with(|c: char| c == '.' || c.is_ascii_digit())
            && (!position || before.text.contains('.'))
    }
}

/// Whether the bound that `rest` begins within has a time, which is a number and its unit.
fn has_time(rest: &[Token<'_>]) -> bool {
    let end = rest.iter().position(|token| token.text == "]").unwrap_or(rest.len());
    let is_word = |token: &Token<'_>| token.kind == Kind::Word;
    let is_time = |text: &str| {
        text.starts_with(|c: char| c.is_ascii_digit() || c == '.')
            && text.ends_with(char::is_alphabetic)
    };
    rest[..end].iter().any(|token| is_word(token) && is_time(token.text))
        || rest[..end].windows(2).any(|pair| pair.iter().all(is_word))
}

/// Whether a line that starts with `token` begins an item, or a comment about one.
fn begins_item(token: &Token<'_>, next: Option<&Token<'_>>) -> bool {
    const ITEMS: [&str; 7] = ["state", "struct", "enum", "const", "predicate", "task", "step"];
    let named = next.is_some_and(|next| next.kind == Kind::Word);
    match token.kind {
        Kind::Doc => true,
        Kind::Comment => next.is_none_or(|next| {
            matches!(next.kind, Kind::Doc | Kind::Comment) || ITEMS.contains(&next.text)
        }),
        Kind::Word => ITEMS.contains(&token.text) && named,
        Kind::Symbol => token.text == "#",
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::format;

    fn laid_out(text: &str) -> String {
        let once = format(text).unwrap_or_else(|| panic!("{text}"));
        assert_eq!(format(&once).as_deref(), Some(once.as_str()), "laid out twice");
        once
    }

    #[test]
    fn lines_end_as_the_first_one_does() {
        let text = "\u{feff}/* one\r\n two */\r\ntask t=a\n&& b // so\r\n";
        let expected = "/* one\r\n two */\r\ntask t = a\r\n    && b // so\r\n";
        assert_eq!(laid_out(text), expected);
        assert_eq!(laid_out("task t=a\n/* x\r\r\n*/"), "task t = a\n/* x\n*/\n");
    }

    #[test]
    fn blanks_stand_where_the_reference_has_them() {
        for (text, expected) in [
            ("task  t=F  a&&F(b)", "task t = F a && F (b)\n"),
            ("task t=! a U(b T c)", "task t = !a U (b T c)\n"),
            ("predicate p=1<x&&- x<- 3", "predicate p = 1 < x && -x < -3\n"),
            ("predicate p = hypot( x ,y )<1.5e-3", "predicate p = hypot(x, y) < 1.5e-3\n"),
            ("predicate p = joints [ 2 ] . x > 0", "predicate p = joints[2].x > 0\n"),
            ("state S{x:f64,joints:[f64;6]}", "state S { x: f64, joints: [f64; 6] }\n"),
            ("state S {\nx : f64 ,\n  ok: bool\n}", "state S {\n    x: f64,\n    ok: bool\n}\n"),
            ("state s: Grid<'a, T>;\ntask t=F a;", "state s: Grid<'a, T>;\ntask t = F a;\n"),
            ("task t = ◇a∧◇ b", "task t = ◇a ∧ ◇b\n"),
            ("task t = - - x < 1", "task t = - -x < 1\n"),
            ("enum E{A,B}\n\n\n\nconst c=-1", "enum E { A, B }\n\nconst c = -1\n"),
            ("task t = F a\n&& F b\n// last", "task t = F a\n    && F b\n// last\n"),
            ("task t = (\nF a &&\nF b\n)", "task t = (\n    F a &&\n    F b\n)\n"),
            ("task t = for all r in rooms:F seen[r]", "task t = for all r in rooms: F seen[r]\n"),
            ("task t = for all i in 0 .. n:F a", "task t = for all i in 0..n: F a\n"),
            ("task t = for all i in 1..= 6 : F a", "task t = for all i in 1..=6: F a\n"),
            (
                "  \n//! File.  \n/// Doc\ntask t=a // why\n",
                "//! File.\n/// Doc\ntask t = a // why\n",
            ),
            ("predicate p = { s . ok( ) }", "predicate p = { s . ok( ) }\n"),
            ("task t = a /* x\n  y */ && b", "task t = a /* x\n  y */ && b\n"),
            (
                "state S{x:f64 in m,v:[f64;2]in m / s ^ - 2}",
                "state S { x: f64 in m, v: [f64; 2] in m/s^-2 }\n",
            ),
            ("const  r in  1 / s=- 2", "const r in 1/s = -2\n"),
            ("predicate p(d:f64 in N * m,e:u8)=x<d", "predicate p(d: f64 in N*m, e: u8) = x < d\n"),
            ("const g in F* /* ? */T = 1", "const g in F* /* ? */ T = 1\n"),
            ("state S{k:K?in m}", "state S { k: K? in m }\n"),
            ("task t=F [ 0,3 ]a&&◇[<= 2]!b", "task t = F[0,3] a && ◇[<=2] !b\n"),
            ("task t=a U[1 , 2](b T [≤3]c)", "task t = a U[1,2] (b T[≤3] c)\n"),
            ("task t=G [ 2 ](a)&&[] [0,1]-x<1", "task t = G[2] (a) && [][0,1] -x < 1\n"),
            ("task t=F[few,9]a&&F[ 0,-1 ]a", "task t = F[few,9] a && F[0,-1] a\n"),
            (
                "step 1s\ntask t=F[0,2s]a&&G[1 s,2 s]a",
                "step 1s\ntask t = F[0, 2s] a && G[1 s, 2 s] a\n",
            ),
            ("step  0.1s\ntask t=X[ 0.2s ]a", "step 0.1s\ntask t = X[0.2s] a\n"),
            ("step  0.1  s\ntask t=X[ 0.2 s ]a", "step 0.1 s\ntask t = X[0.2 s] a\n"),
            ("task t=F a\nstep 2 s", "task t = F a\nstep 2 s\n"),
            ("task t=F a ensuring-x<1", "task t = F a ensuring -x < 1\n"),
            ("task t=a R[0,1]-x<1<=>R-M<W", "task t = a R[0,1] -x < 1 <=> R - M < W\n"),
            ("task t=G-1<x&&G!=2&&s.G(x)", "task t = G - 1 < x && G != 2 && s.G(x)\n"),
            ("task t=1.5 . x<pose . 0 . 1&&2 . y", "task t = 1.5 .x < pose.0.1 && 2 .y\n"),
            ("task t=.51 .0<x", "task t = .51 .0 < x\n"),
            ("task t=a /*/ b  c */&&d", "task t = a /*/ b  c */ && d\n"),
            ("task t=pose . F [ 2 ]-x<1", "task t = pose.F[2] - x < 1\n"),
            ("task t=F a\n# [ factored ]\ntask u=F b", "task t = F a\n#[factored]\ntask u = F b\n"),
            ("task t = for all in in R: F in", "task t = for all in in R: F in\n"),
            ("task t = for all r in F:F r", "task t = for all r in F: F r\n"),
            ("", ""),
        ] {
            assert_eq!(laid_out(text), expected);
        }
    }
}

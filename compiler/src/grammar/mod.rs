//! The grammar as data, and the machine that reads it.
//!
//! The rules stand in `grammar.pest`, in the notation of [pest](https://pest.rs), a parsing
//! expression grammar (Ford, 2004): an ordered choice takes the first alternative that matches, a
//! repetition takes all it can, blanks and comments are skipped except within tokens. A test turns
//! them into the table `rules`, with pest's own reader and optimizer, and compares this machine with
//! pest's.
//!
//! Why not pest itself: every user of the macros builds it. With the 4,000 lines of functions that
//! pest generates and the crate below them, the cold build of a crate that uses `tltl!` takes a
//! tenth more CPU time (8.4 seconds instead of 7.6).
//!
//! The machine recurses on what the rules nest. One rule contains itself, the braces of Rust; their
//! depth is bounded before.

#[rustfmt::skip] // generated
mod rules;

use rules::RULES;
pub(crate) use rules::Rule;

/// A parsing expression.
pub(crate) enum Peg {
    /// This text.
    Text(&'static str),
    /// A character of a class.
    Class(fn(char) -> bool),
    /// The start of the text.
    Start,
    /// The end of the text.
    End,
    /// What a rule matches.
    Call(Rule),
    /// One after the other, with blanks between them unless within a token.
    Sequence(&'static [Peg]),
    /// The first that matches.
    Choice(&'static [Peg]),
    /// This, or nothing.
    Optional(&'static Peg),
    /// As many as there are, blanks between them as in a sequence.
    Repeat(&'static Peg),
    /// Nothing, where this matches.
    Ahead(&'static Peg),
    /// Nothing, where this does not match.
    Not(&'static Peg),
}

/// What a rule makes of its match.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A pair, with those of the rules inside it.
    Pair,
    /// A pair without blanks and without pairs inside it.
    Token,
    /// The pairs of the rules inside it.
    Silent,
    /// Nothing: blanks and comments.
    Blank,
}

/// A rule with the text that it matched, and the pairs inside it.
#[derive(Clone)]
pub(crate) struct Pair<'t> {
    text: &'t str,
    /// The pair and those inside it, in source order.
    nodes: &'t [Node],
}

/// The pair of a rule: bytes `start..end`.
#[derive(Clone, Copy)]
struct Node {
    rule: Rule,
    start: usize,
    end: usize,
    /// The number of nodes inside it.
    inside: usize,
}

/// A text that was read, as the pairs of its rules.
pub(crate) struct Tree<'t> {
    text: &'t str,
    nodes: Vec<Node>,
}

/// The place where reading stopped, and the rules that could have gone on there.
pub(crate) struct Stopped {
    pub(crate) at: usize,
    pub(crate) expected: Vec<Rule>,
}

/// Reads a text by a rule.
pub(crate) fn parse(rule: Rule, text: &str) -> Result<Tree<'_>, Stopped> {
    let mut machine = Machine {
        text,
        at: 0,
        nodes: Vec::new(),
        atomic: false,
        ahead: Ahead::No,
        farthest: 0,
        expected: Vec::new(),
        refused: Vec::new(),
    };
    if machine.rule(rule) {
        return Ok(Tree { text, nodes: machine.nodes });
    }
    let mut expected = Vec::new();
    for rule in machine.expected {
        let place = expected.partition_point(|known: &Rule| (*known as u8) < rule as u8);
        if expected.get(place) != Some(&rule) {
            expected.insert(place, rule);
        }
    }
    Err(Stopped { at: machine.farthest, expected })
}

impl Tree<'_> {
    /// The outermost pairs.
    pub(crate) fn pairs(&self) -> Pairs<'_> {
        Pairs { text: self.text, nodes: &self.nodes }
    }
}

/// Neighbouring pairs, in source order.
pub(crate) struct Pairs<'t> {
    text: &'t str,
    nodes: &'t [Node],
}

impl<'t> Iterator for Pairs<'t> {
    type Item = Pair<'t>;

    fn next(&mut self) -> Option<Pair<'t>> {
        let first = self.nodes.first()?;
        let (nodes, rest) = self.nodes.split_at(1 + first.inside);
        self.nodes = rest;
        Some(Pair { text: self.text, nodes })
    }
}

impl<'t> Pair<'t> {
    pub(crate) fn as_rule(&self) -> Rule {
        self.nodes[0].rule
    }

    /// Its first byte.
    pub(crate) fn start(&self) -> usize {
        self.nodes[0].start
    }

    /// The byte after its last one.
    pub(crate) fn end(&self) -> usize {
        self.nodes[0].end
    }

    pub(crate) fn as_str(&self) -> &'t str {
        &self.text[self.start()..self.end()]
    }

    /// The pairs inside it.
    pub(crate) fn into_inner(self) -> Pairs<'t> {
        Pairs { text: self.text, nodes: &self.nodes[1..] }
    }
}

/// Whether the machine only looks ahead, and whether a match is then what was asked for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ahead {
    No,
    Match,
    Mismatch,
}

/// The state of reading.
struct Machine<'t> {
    text: &'t str,
    at: usize,
    nodes: Vec<Node>,
    /// Whether it is within a token.
    atomic: bool,
    ahead: Ahead,
    /// The farthest byte at which a rule was tried in vain.
    farthest: usize,
    /// The rules that were tried there and did not match.
    expected: Vec<Rule>,
    /// The rules that matched there and must not.
    refused: Vec<Rule>,
}

impl Machine<'_> {
    /// Whether an expression matches; if so, the machine stands behind it.
    fn matches(&mut self, peg: &Peg) -> bool {
        match *peg {
            Peg::Text(text) => {
                let found = self.text[self.at..].starts_with(text);
                self.at += if found { text.len() } else { 0 };
                found
            }
            Peg::Class(contains) => {
                let next = self.text[self.at..].chars().next().filter(|next| contains(*next));
                self.at += next.map_or(0, char::len_utf8);
                next.is_some()
            }
            Peg::Start => self.at == 0,
            Peg::End => self.at == self.text.len(),
            Peg::Call(rule) => self.rule(rule),
            Peg::Sequence(parts) => self.sequence(parts),
            Peg::Choice(parts) => parts.iter().any(|part| self.matches(part)),
            Peg::Optional(part) => {
                self.matches(part);
                true
            }
            Peg::Repeat(part) => self.repeat(part),
            Peg::Ahead(part) => self.look(part, true),
            Peg::Not(part) => self.look(part, false),
        }
    }

    /// All parts, or none: the machine goes back to where it was.
    fn sequence(&mut self, parts: &[Peg]) -> bool {
        let (at, pairs) = (self.at, self.nodes.len());
        for (number, part) in parts.iter().enumerate() {
            if number > 0 {
                self.blanks();
            }
            if !self.matches(part) {
                self.back(at, pairs);
                return false;
            }
        }
        true
    }

    fn repeat(&mut self, part: &Peg) -> bool {
        let (mut at, mut pairs) = (self.at, self.nodes.len());
        while self.matches(part) {
            (at, pairs) = (self.at, self.nodes.len());
            self.blanks();
        }
        self.back(at, pairs);
        true
    }

    fn back(&mut self, at: usize, pairs: usize) {
        self.at = at;
        self.nodes.truncate(pairs);
    }

    /// Skips blanks and comments, unless within a token.
    fn blanks(&mut self) {
        while !self.atomic && (self.rule(Rule::WHITESPACE) || self.rule(Rule::COMMENT)) {}
    }

    /// Whether what comes matches, or does not, as `wanted`. The machine stays where it is.
    fn look(&mut self, part: &Peg, wanted: bool) -> bool {
        let (at, outer) = (self.at, self.ahead);
        self.ahead = match (outer, wanted) {
            (Ahead::Mismatch, true) | (Ahead::No | Ahead::Match, false) => Ahead::Mismatch,
            _ => Ahead::Match,
        };
        let found = self.matches(part);
        (self.at, self.ahead) = (at, outer);
        found == wanted
    }

    fn rule(&mut self, rule: Rule) -> bool {
        let (kind, ref peg) = RULES[rule as usize];
        let outer = self.atomic;
        self.atomic |= matches!(kind, Kind::Token | Kind::Blank);
        let matched = match kind {
            Kind::Pair | Kind::Token => self.pair(rule, peg, outer),
            Kind::Silent | Kind::Blank => self.matches(peg),
        };
        self.atomic = outer;
        matched
    }

    /// A rule that makes a pair, unless the machine looks ahead or is `within` a token.
    fn pair(&mut self, rule: Rule, peg: &Peg, within: bool) -> bool {
        let (start, index) = (self.at, self.nodes.len());
        let before = self.tried(start);
        let kept = self.ahead == Ahead::No && !within;
        if kept {
            self.nodes.push(Node { rule, start, end: start, inside: 0 });
        }
        let matched = self.matches(peg);
        if !within && matched == (self.ahead == Ahead::Mismatch) {
            self.note(rule, start, before);
        }
        if kept && matched {
            let inside = self.nodes.len() - index - 1;
            self.nodes[index] = Node { rule, start, end: self.at, inside };
        } else if kept {
            self.nodes.truncate(index);
        }
        matched
    }

    /// The numbers of rules that were tried in vain at a byte.
    fn tried(&self, at: usize) -> (usize, usize) {
        if at == self.farthest { (self.expected.len(), self.refused.len()) } else { (0, 0) }
    }

    /// Notes a rule that was tried in vain from `start` on; `before` is what had been tried there
    /// before. It stands for the rules inside it that failed at its own start, unless that is one.
    fn note(&mut self, rule: Rule, start: usize, before: (usize, usize)) {
        let now = self.tried(start);
        if now.0 + now.1 == before.0 + before.1 + 1 || start < self.farthest {
            return;
        }
        if start > self.farthest {
            self.farthest = start;
            self.expected.clear();
            self.refused.clear();
        } else {
            self.expected.truncate(before.0);
            self.refused.truncate(before.1);
        }
        match self.ahead {
            Ahead::Mismatch => self.refused.push(rule),
            _ => self.expected.push(rule),
        }
    }
}

//! The rules of the Hanoi Omega-Automata format, version 1, written from its specification: a
//! reader of its own, stricter than the tool's, that takes no automaton of another format, checks
//! every promise among the properties, and shares no code with what it judges.
//!
//! Without aliases, alternation and implicit labels, which the tool does not write.

use std::collections::BTreeMap;

/// An automaton that keeps the rules.
#[derive(Debug)]
pub(crate) struct Automaton {
    pub(crate) propositions: Vec<String>,
    pub(crate) start: usize,
    pub(crate) accepting: Vec<bool>,
    edges: Vec<Vec<(Label, usize)>>,
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Header(String),
    Word(String),
    Text(String),
    Int(usize),
    Symbol(char),
    Body,
    End,
}

#[derive(Debug)]
enum Label {
    Truth(bool),
    Proposition(usize),
    Not(Box<Label>),
    And(Box<Label>, Box<Label>),
    Or(Box<Label>, Box<Label>),
}

impl Label {
    fn holds(&self, letter: u32) -> bool {
        match self {
            Self::Truth(value) => *value,
            Self::Proposition(p) => letter >> p & 1 == 1,
            Self::Not(a) => !a.holds(letter),
            Self::And(a, b) => a.holds(letter) && b.holds(letter),
            Self::Or(a, b) => a.holds(letter) || b.holds(letter),
        }
    }
}

impl Automaton {
    pub(crate) fn next(&self, q: usize, letter: u32) -> usize {
        self.edges[q].iter().find(|(label, _)| label.holds(letter)).unwrap().1
    }
}

/// Reads an automaton, or says which rule it breaks.
pub(crate) fn read(text: &str) -> Result<Automaton, String> {
    let mut reader = Reader { tokens: tokens(text)?, at: 0 };
    let header = reader.header()?;
    let automaton = reader.body(&header)?;
    match reader.next() {
        Some(Token::End) if reader.at == reader.tokens.len() => {}
        other => return Err(format!("{other:?} where the automaton ends")),
    }
    promises(&header, &automaton)?;
    Ok(automaton)
}

fn tokens(text: &str) -> Result<Vec<Token>, String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    loop {
        rest = rest.trim_start_matches([' ', '\t', '\n', '\r']);
        let Some(first) = rest.chars().next() else { return Ok(tokens) };
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let (token, length) = if let Some(inner) = rest.strip_prefix("--") {
            match () {
                () if inner.starts_with("BODY--") => (Token::Body, 8),
                () if inner.starts_with("END--") => (Token::End, 7),
                () => return Err(format!("`{rest}` is neither --BODY-- nor --END--")),
            }
        } else if first == '"' {
            string(rest)?
        } else if first.is_ascii_digit() {
            let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            if end > 1 && first == '0' {
                return Err("an integer starts with 0".into());
            }
            (Token::Int(rest[..end].parse().map_err(|_| "an integer is too large")?), end)
        } else if first.is_ascii_alphabetic() || first == '_' {
            let end = rest.find(|c| !word(c)).unwrap_or(rest.len());
            match rest[end..].starts_with(':') {
                true => (Token::Header(rest[..end].to_owned()), end + 1),
                false => (Token::Word(rest[..end].to_owned()), end),
            }
        } else if "!&|()[]{}".contains(first) {
            (Token::Symbol(first), 1)
        } else {
            return Err(format!("`{first}` is no part of the format"));
        };
        tokens.push(token);
        rest = &rest[length..];
    }
}

fn string(rest: &str) -> Result<(Token, usize), String> {
    let mut text = String::new();
    let mut characters = rest.char_indices().skip(1);
    while let Some((at, c)) = characters.next() {
        match c {
            '"' => return Ok((Token::Text(text), at + 1)),
            '\\' => text.push(characters.next().ok_or("a string ends in a backslash")?.1),
            c => text.push(c),
        }
    }
    Err("a string is not closed".into())
}

#[derive(Default)]
struct Header {
    states: Option<usize>,
    start: Option<usize>,
    propositions: Option<Vec<String>>,
    sets: Option<usize>,
    acceptance: Vec<Token>,
    acc_name: Option<String>,
    properties: Vec<String>,
}

struct Reader {
    tokens: Vec<Token>,
    at: usize,
}

impl Reader {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    fn next(&mut self) -> Option<Token> {
        self.at += 1;
        self.tokens.get(self.at - 1).cloned()
    }

    fn eat(&mut self, symbol: char) -> bool {
        let found = self.peek() == Some(&Token::Symbol(symbol));
        self.at += usize::from(found);
        found
    }

    fn int(&mut self) -> Result<usize, String> {
        match self.next() {
            Some(Token::Int(value)) => Ok(value),
            other => Err(format!("{other:?} instead of an integer")),
        }
    }

    /// The tokens up to the next item.
    fn values(&mut self) -> Vec<Token> {
        let mut values = Vec::new();
        while let Some(token) = self.peek() {
            if matches!(token, Token::Header(_) | Token::Body | Token::End) {
                break;
            }
            values.extend(self.next());
        }
        values
    }

    fn header(&mut self) -> Result<Header, String> {
        let mut header = Header::default();
        let version = (self.next(), self.next());
        if version != (Some(Token::Header("HOA".into())), Some(Token::Word("v1".into()))) {
            return Err("it does not start with `HOA: v1`".into());
        }
        let mut seen = Vec::new();
        loop {
            let name = match self.next() {
                Some(Token::Header(name)) => name,
                Some(Token::Body) => break,
                other => return Err(format!("{other:?} among the header items")),
            };
            if seen.contains(&name) && name != "properties" {
                return Err(format!("`{name}:` stands twice"));
            }
            self.item(&name, &mut header)?;
            seen.push(name);
        }
        match header.sets {
            None => Err("`Acceptance:` is missing".into()),
            Some(_) => Ok(header),
        }
    }

    fn item(&mut self, name: &str, header: &mut Header) -> Result<(), String> {
        let values = self.values();
        let strings = |values: &[Token]| -> Option<Vec<String>> {
            let text = |token: &Token| match token {
                Token::Text(text) => Some(text.clone()),
                _ => None,
            };
            values.iter().map(text).collect()
        };
        match (name, values.as_slice()) {
            ("States", [Token::Int(count)]) => header.states = Some(*count),
            ("Start", [Token::Int(state)]) => header.start = Some(*state),
            ("AP", [Token::Int(count), names @ ..]) if names.len() == *count => {
                header.propositions = strings(names);
            }
            ("Acceptance", [Token::Int(sets), condition @ ..]) => {
                header.sets = Some(*sets);
                header.acceptance = condition.to_vec();
            }
            ("acc-name", [Token::Word(name)]) => header.acc_name = Some(name.clone()),
            ("tool", [Token::Text(_)] | [Token::Text(_), Token::Text(_)]) => {}
            ("name", [Token::Text(_)]) => {}
            ("properties", [_, ..]) => {
                for value in values {
                    let Token::Word(word) = value else {
                        return Err("a property is a word".into());
                    };
                    header.properties.push(word);
                }
            }
            _ => return Err(format!("`{name}:` cannot have {values:?}")),
        }
        Ok(())
    }

    fn body(&mut self, header: &Header) -> Result<Automaton, String> {
        let count = header.states.ok_or("`States:` is missing")?;
        let propositions = header.propositions.clone().ok_or("`AP:` is missing")?;
        let mut states: BTreeMap<usize, (bool, Vec<(Label, usize)>)> = BTreeMap::new();
        while self.peek() == Some(&Token::Header("State".into())) {
            self.next();
            let (state, marks) = (self.int()?, self.signature(header)?);
            let mut edges = Vec::new();
            while self.eat('[') {
                let label = self.or(propositions.len())?;
                if !self.eat(']') {
                    return Err("a label is not closed".into());
                }
                let to = self.int()?;
                if to >= count {
                    return Err(format!("there is no state {to}"));
                }
                edges.push((label, to));
            }
            if state >= count || states.insert(state, (marks, edges)).is_some() {
                return Err(format!("state {state} stands twice, or beyond the count"));
            }
        }
        if states.len() != count {
            return Err(format!("{} of {count} states are there", states.len()));
        }
        let start = header.start.filter(|start| *start < count).ok_or("it starts nowhere")?;
        let (accepting, edges) = states.into_values().unzip();
        Ok(Automaton { propositions, start, accepting, edges })
    }

    /// Whether a state is in the one acceptance set.
    fn signature(&mut self, header: &Header) -> Result<bool, String> {
        if !self.eat('{') {
            return Ok(false);
        }
        let set = self.int()?;
        if Some(set) >= header.sets || !self.eat('}') {
            return Err("the acceptance sets of a state are wrong".into());
        }
        Ok(true)
    }

    fn or(&mut self, count: usize) -> Result<Label, String> {
        let mut label = self.and(count)?;
        while self.eat('|') {
            label = Label::Or(Box::new(label), Box::new(self.and(count)?));
        }
        Ok(label)
    }

    fn and(&mut self, count: usize) -> Result<Label, String> {
        let mut label = self.unary(count)?;
        while self.eat('&') {
            label = Label::And(Box::new(label), Box::new(self.unary(count)?));
        }
        Ok(label)
    }

    fn unary(&mut self, count: usize) -> Result<Label, String> {
        match self.next() {
            Some(Token::Symbol('!')) => Ok(Label::Not(Box::new(self.unary(count)?))),
            Some(Token::Symbol('(')) => {
                let label = self.or(count)?;
                if self.eat(')') { Ok(label) } else { Err("`(` is not closed".into()) }
            }
            Some(Token::Word(word)) if word == "t" => Ok(Label::Truth(true)),
            Some(Token::Word(word)) if word == "f" => Ok(Label::Truth(false)),
            Some(Token::Int(p)) if p < count => Ok(Label::Proposition(p)),
            other => Err(format!("{other:?} in a label")),
        }
    }
}

/// What the header promises of the automaton.
fn promises(header: &Header, automaton: &Automaton) -> Result<(), String> {
    let names = &automaton.propositions;
    if (1..names.len()).any(|i| names[..i].contains(&names[i])) {
        return Err("two propositions have one name".into());
    }
    let inf = ["Inf", "(", "0", ")"].map(str::to_owned);
    let shown = header.acceptance.iter().map(|token| match token {
        Token::Word(word) => word.clone(),
        Token::Int(value) => value.to_string(),
        Token::Symbol(symbol) => symbol.to_string(),
        other => format!("{other:?}"),
    });
    let buchi = header.sets == Some(1) && shown.collect::<Vec<String>>() == inf;
    if header.acc_name.as_deref() != Some("Buchi") || !buchi {
        return Err("`Buchi` means `Acceptance: 1 Inf(0)`".into());
    }
    for property in &header.properties {
        let kept = match property.as_str() {
            // This reader takes nothing else.
            "trans-labels" | "explicit-labels" | "state-acc" => true,
            "deterministic" => exits(automaton).all(|count| count <= 1),
            "complete" => exits(automaton).all(|count| count >= 1),
            "terminal" => {
                automaton.edges.iter().zip(&automaton.accepting).all(|(edges, from)| {
                    !from || edges.iter().all(|(_, to)| automaton.accepting[*to])
                })
            }
            other => return Err(format!("nobody promised to check `{other}`")),
        };
        if !kept {
            return Err(format!("it is not `{property}`"));
        }
    }
    Ok(())
}

/// How many edges take each letter in each state.
fn exits(automaton: &Automaton) -> impl Iterator<Item = usize> {
    let letters = 0..1_u32 << automaton.propositions.len();
    let count = move |edges: &Vec<(Label, usize)>, letter: u32| {
        edges.iter().filter(|(label, _)| label.holds(letter)).count()
    };
    automaton
        .edges
        .iter()
        .flat_map(move |edges| letters.clone().map(move |letter| count(edges, letter)))
}

//! C headers: what a C compiler makes of them steps, reads and follows as the runtime does, on formulas
//! of the corpus and random ones, for numbers of every kind.
//!
//! Where there is no C compiler these tests say so and check nothing.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tltl::Acceptor;
use tltl::robustness::{self, Predicates};
use tltl_compiler::compile;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::predicate::{Module, Scalar, Task};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::emit::c;
use tltlc::evaluate::{Evaluator, Input, InputKind};
use tltlc::online::Online;
use tltlc::semantics;

use crate::random::{self, Bytes, Choices, NAMES, Seeded};
use crate::{columns, corpus};

const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"];

/// A compiler and the flags that say which language it is.
const C: (&str, &[&str], &str) = ("cc", &["-std=c99"], "c");
const CPP: (&str, &[&str], &str) = ("g++", &["-std=c++11"], "cc");

/// Compiles a program, and links it if it has a `main`; `None` if there is no such compiler.
fn built(
    name: &str,
    text: &str,
    (compiler, language, ending): (&str, &[&str], &str),
) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let source = folder.join(format!("{name}.{ending}"));
    let program = folder.join(format!("{name}_{ending}"));
    std::fs::write(&source, text).unwrap();
    let mut command = Command::new(compiler);
    command.args(language).args(WARNINGS).arg("-O1").arg("-o").arg(&program).arg(&source);
    let run = match command.arg("-lm").output() {
        Ok(run) => run,
        Err(error) => {
            eprintln!("skipped: there is no `{compiler}` ({error})");
            return None;
        }
    };
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    Some(program)
}

/// A task with its header, and the trajectories to try.
struct Case {
    text: String,
    module: Module,
    task: Task,
    dfa: Dfa,
    header: String,
    /// Whether the robustness is followed.
    follows: bool,
    evaluator: Evaluator,
    trajectories: Vec<Vec<Vec<f64>>>,
}

impl Case {
    /// The first task of a module, under a name of its own.
    fn new(number: usize, text: &str, module: Module, dfa: Dfa) -> Self {
        let mut task = module.tasks[0].clone();
        task.name = Some(format!("t{number}"));
        let header = c::header(&module, &task, &dfa).unwrap();
        let evaluator = Evaluator::new(&module, &task).unwrap();
        let follows = header.contains(&format!("int t{number}_step("));
        Self {
            text: text.to_owned(),
            module,
            task,
            dfa,
            header,
            follows,
            evaluator,
            trajectories: Vec::new(),
        }
    }

    fn of_formula(number: usize, formula: &str) -> Self {
        let compiled =
            compile::formula(&Source::new("formula", formula), Budget::default()).unwrap();
        let dfa = compiled.automata[0].dfa.clone();
        Self::new(number, formula, compiled.module, dfa)
    }

    fn prefix(&self) -> &str {
        self.task.name.as_deref().unwrap()
    }

    /// The statement that writes `v` to the place of an input.
    fn assignment(&self, input: &Input) -> String {
        let prefix = self.prefix();
        let Input { name, kind, .. } = input;
        let code = match kind {
            InputKind::Place(Scalar::Bool) => "v > 0".to_owned(),
            InputKind::Place(Scalar::Enum { of, .. }) => {
                format!("({prefix}_{})(int)v", self.module.enums[*of as usize].name)
            }
            InputKind::Place(Scalar::Number(numeric)) => match numeric.name() {
                "f64" => "v".to_owned(),
                "f32" => "(float)v".to_owned(),
                "i64" => "(int64_t)v".to_owned(),
                _ => "(uint8_t)v".to_owned(),
            },
            InputKind::Variable | InputKind::Proposition => "v".to_owned(),
        };
        format!("s.{name} = {code};")
    }

    /// The function that reads trajectories of this task, and writes a line for each state.
    fn reader(&self) -> String {
        let prefix = self.prefix();
        let mut text = format!(
            "static void run_{prefix}(void)\n{{\n    static {prefix}_state_ s;\n    uint16_t q = 0;\n"
        );
        if self.follows {
            let _ = writeln!(text, "    static {prefix}_monitor m;\n    {prefix}_start(&m);");
        }
        text += "    int rows = (int)number();\n    while (rows-- > 0) {\n        double v;\n        (void)v;\n";
        for input in self.evaluator.inputs() {
            let _ = writeln!(text, "        v = number(); {}", self.assignment(input));
        }
        let _ = writeln!(text, "        show({prefix}_progress(q, &s));");
        for i in 0..self.evaluator.propositions() {
            let _ = writeln!(text, "        show({prefix}_rho({i}, &s));");
            let _ = writeln!(text, "        printf(\"%d \", {prefix}_holds({i}, &s));");
        }
        let _ = writeln!(
            text,
            "        {{ const int failed = {prefix}_next(&q, &s); printf(\"%d %u \", failed, (unsigned)q); }}"
        );
        let _ = writeln!(
            text,
            "        printf(\"%d %u \", {prefix}_verdict(q), (unsigned){prefix}_distance(q));"
        );
        if self.follows {
            let _ = writeln!(
                text,
                "        {{ const int failed = {prefix}_step(&m, &s); printf(\"%d %u \", failed, (unsigned)m.q); }}\n        \
                 show(m.lower + 0.0); show(m.upper + 0.0);"
            );
        }
        text += "        printf(\"\\n\");\n    }\n}\n";
        let state = match &self.module.state {
            tltl_compiler::predicate::State::Declared(state) => format!("{prefix}_{}", state.name),
            _ => format!("{prefix}_state"),
        };
        text.replace(&format!("{prefix}_state_ s"), &format!("{state} s"))
    }

    /// The lines that the definition and the runtime have for a trajectory.
    fn expected(&self, trajectory: &[Vec<f64>], lines: &mut String) {
        let automaton = tltlc::tables::automaton(&self.dfa).unwrap();
        let spec = &self.task.spec;
        let mut online = Online::new(spec, Budget::default());
        let (mut q, mut followed, mut upper) = (0, 0, f64::INFINITY);
        let mut read: Vec<Vec<f64>> = Vec::new();
        for row in trajectory {
            let row = &row[..];
            let count = self.evaluator.propositions();
            let rho: Vec<f64> =
                (0..count).map(|i| Predicates::robustness(&self.evaluator, i, row)).collect();
            let holds: Vec<i32> =
                (0..count).map(|i| self.evaluator.holds(i, row).map_or(-1, i32::from)).collect();
            let guard = automaton.progress(q);
            let mut any = false;
            let progress = robustness::guard(guard, |i| {
                any |= rho[i].is_nan();
                rho[i]
            });
            show(lines, if any { f64::NAN } else { progress });
            for i in 0..count {
                show(lines, rho[i]);
                let _ = write!(lines, "{} ", holds[i]);
            }
            let next = |q: u32| {
                let holds = |i: usize| if holds[i] < 0 { Err(i) } else { Ok(holds[i] == 1) };
                automaton.next(q, holds).map_or_else(|i| (i + 1, q), |to| (0, to))
            };
            let failed;
            (failed, q) = next(q);
            let distance = automaton.distance(q).map_or(u16::MAX.into(), |moves| moves);
            let verdict = match q {
                q if automaton.accepting() == Some(q) => 1,
                q if automaton.trap() == Some(q) => -1,
                _ => 0,
            };
            let _ = write!(lines, "{failed} {q} {verdict} {distance} ");
            if self.follows {
                let (mut failed, to) = next(followed);
                if let (0, Some(i)) = (failed, rho.iter().position(|rho| rho.is_nan())) {
                    failed = i + 1;
                }
                if failed == 0 {
                    followed = to;
                    online.step(&rho);
                    upper = online.greatest().expect("the automaton over literals is small");
                    read.push(rho);
                }
                let lower = match read.len() {
                    0 => f64::NEG_INFINITY,
                    length => semantics::robustness(spec, length, |p, t| read[t][p as usize]),
                };
                let _ = write!(lines, "{failed} {followed} ");
                show(lines, lower + 0.0);
                show(lines, upper + 0.0);
            }
            lines.push('\n');
        }
    }
}

/// A number as its bits; of NaN there is one.
fn show(lines: &mut String, number: f64) {
    let bits = if number.is_nan() { u64::MAX } else { number.to_bits() };
    let _ = write!(lines, "{bits:016x} ");
}

const MAIN: &str = r#"
#include <stdio.h>
#include <string.h>

static double number(void)
{
    double v = 0;
    if (fread(&v, sizeof v, 1, stdin) != 1) v = 0;
    return v;
}

static void show(double v)
{
    uint64_t bits = UINT64_MAX;
    if (v == v) memcpy(&bits, &v, sizeof v);
    printf("%08lx%08lx ", (unsigned long)(bits >> 32), (unsigned long)(bits & 0xffffffffu));
}

"#;

/// Compiles all headers into one program, and compares what it says.
fn check(name: &str, cases: &[Case], language: (&str, &[&str], &str)) {
    let mut text: String = cases.iter().map(|case| &*case.header).collect();
    text += MAIN;
    let mut main = "int main(void)\n{\n    int task;\n    while ((task = (int)number()) != 0) {\n        switch (task) {\n".to_owned();
    let (mut input, mut expected): (Vec<f64>, String) = (Vec::new(), String::new());
    let mut about = Vec::new();
    for (number, case) in (1..).zip(cases) {
        text += &case.reader();
        let _ = writeln!(main, "        case {number}: run_{}(); break;", case.prefix());
        for trajectory in &case.trajectories {
            input.extend([number as f64, trajectory.len() as f64]);
            input.extend(trajectory.iter().flatten());
            case.expected(trajectory, &mut expected);
            about.extend(trajectory.iter().map(|row| (&case.text, row, trajectory)));
        }
    }
    text += &main;
    text += "        }\n    }\n    return 0;\n}\n";
    let Some(program) = built(name, &text, language) else { return };
    input.push(0.0);
    let mut child =
        Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    let bytes: Vec<u8> = input.iter().flat_map(|number| number.to_ne_bytes()).collect();
    let writer = std::thread::spawn(move || pipe.write_all(&bytes).unwrap());
    let run = child.wait_with_output().unwrap();
    writer.join().unwrap();
    let found = String::from_utf8(run.stdout).unwrap();
    assert_eq!(found.lines().count(), about.len());
    for ((found, expected), (task, row, trajectory)) in
        found.lines().zip(expected.lines()).zip(about)
    {
        assert_eq!(found, expected, "{task}\n{row:?} of {trajectory:?}");
    }
}

/// Trajectories of robustness values, with both zeros, both infinities and NaN among them.
fn trajectories(choices: &mut Seeded, width: usize) -> Vec<Vec<Vec<f64>>> {
    let numbers =
        [f64::NEG_INFINITY, -3.0, -1.5, -0.0, 0.0, 0.5, 1.0, 2.25, f64::INFINITY, f64::NAN];
    // A NaN stops nothing but its state; in most trajectories there is none.
    (0..6)
        .map(|kind| {
            let numbers = &numbers[..numbers.len() - usize::from(kind > 1)];
            let mut number = || numbers[choices.choose(numbers.len() as u32) as usize];
            (0..4 + 5 * kind).map(|_| (0..width).map(|_| number()).collect()).collect()
        })
        .collect()
}

/// Formulas of the corpus and random ones over free propositions.
fn formulas() -> Vec<Case> {
    let mut choices = Seeded(11);
    let rows = corpus::rows();
    let rows = rows.iter().filter(|row| row.states < 400).step_by(5);
    let known = rows.map(|row| row.formula.clone());
    let bounded = corpus::robustness().into_iter().step_by(2).map(|row| row.formula);
    let followed = [
        "F (a && X[5] b)",
        "F (a U[2,5] b)",
        "F (a U[5,5] b)",
        "F (b && X[3] G[0,2] a)",
        "F (a && G[0,5] b)",
        "F[0,6] (a && F[0,6] b)",
        "F[0,5] G[0,2] a",
        "a U[0,4] (b && F[0,3] c)",
        "F (a || b U c) && X[7] F (c && X a)",
        "F a && F b ensuring !c",
        "(a T[1,2] b) ensuring !c",
    ];
    let random = (0..40).map(|seed| random::formula(&mut Seeded(seed), NAMES.len() as u32, 7));
    let all = followed.map(str::to_owned).into_iter().chain(known).chain(bounded).chain(random);
    let compiles = |formula: &String| {
        compile::formula(&Source::new("formula", formula.as_str()), Budget::default()).is_ok()
    };
    let mut cases: Vec<Case> = all
        .filter(compiles)
        .enumerate()
        .map(|(number, formula)| Case::of_formula(number, &formula))
        .collect();
    assert!(cases.iter().take(followed.len()).all(|case| case.follows));
    for case in &mut cases {
        case.trajectories = trajectories(&mut choices, case.evaluator.inputs().len());
    }
    cases
}

#[test]
fn c_reads_formulas_as_rust_does() {
    let cases = formulas();
    let followed = cases.iter().filter(|case| case.follows).count();
    assert!(cases.len() > 110 && 2 * followed > cases.len(), "{followed} of {}", cases.len());
    check("formulas", &cases, C);
}

/// Random files: predicates of every type and operator.
#[test]
fn c_reads_states_as_rust_does() {
    let mut cases: Vec<Case> = Vec::new();
    let mut choices = Seeded(12);
    while cases.len() < 60 {
        let bytes: Vec<u8> = (0..150).map(|_| choices.choose(256) as u8).collect();
        let Some((text, module)) = columns::module(&mut Bytes(&bytes)) else { continue };
        let source = Source::new("random.tltl", text.as_str());
        let Ok(compiled) = compile::file(&source, Budget::EMITTED) else { continue };
        let dfa = compiled.automata[0].dfa.clone();
        let mut case = Case::new(cases.len(), &text, module, dfa);
        let inputs = case.evaluator.inputs().to_vec();
        let mut row =
            || inputs.iter().map(|one| columns::number(&mut choices, &one.name)).collect();
        case.trajectories = (0..4).map(|_| (0..12).map(|_| row()).collect()).collect();
        cases.push(case);
    }
    check("states", &cases, C);
    check("states", &cases[..20], CPP);
}

/// Names that are keywords, macros or not ASCII, and that differ in what C does not have.
#[test]
fn names_are_no_keywords() {
    let text = "enum class { new, NAN, r#int }
        struct union { double: f64, é: f64, è: f64, NULL: bool }
        state s { int: f64, int_: f64, class: class, near: [f64; class], m: union, p: f32, INFINITY: u8 }
        task while(register: class, bool: u8) = F (int < int_ && class == register
            && near[class] > m.double + m.é - m.è && !m.NULL && p > bool && INFINITY < 3) && F[0,4] p > 1";
    let compiled = compile::file(&Source::new("names.tltl", text), Budget::EMITTED).unwrap();
    let header =
        c::header(&compiled.module, &compiled.module.tasks[0], &compiled.automata[0].dfa).unwrap();
    let main = "int main(void)
{
    while_s s = {0, 1, while_class_new, {5, 5, 5}, {1, 1, 1, false}, 2, 1};
    const while_arguments p = {while_class_new, 1};
    while_monitor m;
    while_start(&m);
    return while_step(&m, &p, &s) || while_verdict(m.q) != 1 || m.lower != 1;
}
";
    for language in [C, CPP] {
        if let Some(program) = built("names", &format!("{header}{main}"), language) {
            assert!(Command::new(program).status().unwrap().success());
        }
    }
}

/// Arguments are read from where the caller has them, and an index beyond its array is reported.
#[test]
fn arguments_and_indices_are_read() {
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("data/kitchen.tltl"));
    let compiled =
        compile::file(&Source::new("kitchen.tltl", text.unwrap()), Budget::EMITTED).unwrap();
    let mut headers = String::new();
    for name in ["deliver", "come", "look_here", "empty_hand"] {
        let tasks = &compiled.module.tasks;
        let at = tasks.iter().position(|task| task.name.as_deref() == Some(name)).unwrap();
        headers += &c::header(&compiled.module, &tasks[at], &compiled.automata[at].dfa).unwrap();
    }
    let main = r"
static int delivers(void)
{
    static deliver_Kitchen s;
    deliver_arguments p = {deliver_Object_bowl, deliver_Receptacle_fridge};
    deliver_monitor m;
    deliver_start(&m);
    s.seen_in[deliver_Object_bowl] = deliver_Receptacle_cabinet;
    s.holding = deliver_Object_none;
    if (deliver_step(&m, &p, &s) || m.lower != -INFINITY || m.upper != INFINITY) return 1;
    s.holding = deliver_Object_bowl;
    if (deliver_step(&m, &p, &s) || deliver_distance(m.q) != 2) return 2;
    s.is_open[deliver_Receptacle_fridge] = true;
    if (deliver_step(&m, &p, &s) || deliver_distance(m.q) != 1) return 3;
    s.holding = deliver_Object_none;
    s.seen_in[deliver_Object_bowl] = deliver_Receptacle_fridge;
    if (deliver_step(&m, &p, &s) || deliver_verdict(m.q) != 1 || m.lower != 1) return 4;
    p.object = (deliver_Object)7;
    if (deliver_holds(2, &p, &s) != -1 || deliver_rho(2, &p, &s) == deliver_rho(2, &p, &s)) return 5;
    return deliver_step(&m, &p, &s) != 3;
}

static int comes(void)
{
    static come_Kitchen s;
    const come_arguments p = {2.5};
    come_monitor m;
    come_start(&m);
    s.distance = 3;
    if (come_step(&m, &p, &s) || m.lower != -0.5 || m.upper != 2.5) return 6;
    s.distance = NAN;
    return come_step(&m, &p, &s) != 1 || m.lower != -0.5 ? 7 : 0;
}

static int looks(void)
{
    static look_here_Kitchen s;
    uint16_t q = look_here_INITIAL;
    s.is_open[look_here_Receptacle_sink] = true;
    s.focus = look_here_Receptacle_sink;
    if (look_here_next(&q, &s) || q != look_here_ACCEPTING) return 8;
    s.focus = (look_here_Receptacle)3;
    if (look_here_next(&q, &s) != 1) return 9;
    q = look_here_STATES;
    return look_here_next(&q, &s) != -1;
}

int main(void)
{
    static empty_hand_Kitchen s;
    uint16_t q = 0;
    s.holding = empty_hand_Object_none;
    if (empty_hand_next(&q, &s) || empty_hand_verdict(q) != 1) return 10;
    return delivers() ? delivers() : comes() ? comes() : looks();
}
";
    for language in [C, CPP] {
        if let Some(program) = built("kitchen", &format!("{headers}{main}"), language) {
            assert_eq!(Command::new(program).status().unwrap().code(), Some(0), "{language:?}");
        }
    }
}

#[test]
fn what_c_cannot_do_is_refused_by_name() {
    let refused = |formula: &str| {
        let case = Case::of_formula(0, formula);
        assert!(!case.follows, "{formula}");
        let line = case.header.lines().find(|line| line.contains("There is no monitor"));
        line.unwrap().trim_start_matches(" * ").to_owned()
    };
    assert_eq!(
        refused("F (F a && F b)"),
        "There is no monitor of the robustness: below F, U, T and bounds one side of && is a \
         condition on one state, and `F b` is not."
    );
    assert_eq!(
        refused("(F a) U b"),
        "There is no monitor of the robustness: what U asks for meanwhile is a condition on one \
         state, and `F a` is not."
    );
    assert_eq!(
        refused("F[0,3000] a && F[0,2000] b"),
        "There is no monitor of the robustness: the bounds add up to 5004 steps, and a monitor \
         follows up to 4096."
    );
    let source = Source::new("formula", "F[0,70000] a");
    let long = compile::formula(&source, Budget::SHOWN).unwrap();
    let error = c::header(&long.module, &long.module.tasks[0], &long.automata[0].dfa).unwrap_err();
    assert_eq!(error.to_string(), "the automaton has 70003 states, and a C header up to 65535");
}

/// The blocks of a language in the page on firmware, in their order.
fn page(language: &str) -> Vec<String> {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/embedded.md"));
    let page = page.unwrap();
    let blocks = page.split("\n```").skip(1).step_by(2);
    let of = |block: &str| block.strip_prefix(language)?.strip_prefix('\n').map(str::to_owned);
    blocks.filter_map(of).collect()
}

/// The header of the page's task, to be read.
#[test]
fn the_page_on_firmware_says_what_its_program_prints() {
    let ([task], [program], [output]) = (&page("tltl")[..], &page("c")[..], &page("text")[..])
    else {
        panic!("a task, a program and what it prints")
    };
    let compiled =
        compile::file(&Source::new("robot.tltl", task.as_str()), Budget::EMITTED).unwrap();
    let (task, dfa) = (&compiled.module.tasks[0], &compiled.automata[0].dfa);
    let header = c::header(&compiled.module, task, dfa).unwrap();
    let program = program.replace("#include \"recharge.h\"\n", &header);
    insta::assert_snapshot!("header", header);
    for language in [C, CPP] {
        if let Some(program) = built("page", &program, language) {
            let run = Command::new(program).output().unwrap();
            assert_eq!(String::from_utf8(run.stdout).unwrap().trim_end(), output);
        }
    }
}

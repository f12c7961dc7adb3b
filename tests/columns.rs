//! Predicates by columns say, bit for bit, what they say row by row: on random declarations, with
//! random numbers in columns of every type and any stride.

use proptest::prelude::*;
use tltl_compiler::check;
use tltl_compiler::predicate::Module;
use tltl_compiler::source::Source;
use tltlc::evaluate::{Column, Columns, Evaluator, NotANumber, Scratch};
use tltlc::semantics;

use crate::random::{self, Bytes, Choices, NAMES};
use crate::rowwise::{Reading, Rowwise};

const STATE: &str = "enum Colour { red, green, blue }
    state Robot { x: f64, y: f32, k: i64, n: u8, on: bool, kind: Colour?, last: Colour, at: [f64; 2] }
";

/// A number that some choices make, of at most so many operators.
fn term(choices: &mut impl Choices, operators: u32) -> String {
    if operators == 0 {
        let leaves = ["x", "y", "k", "n", "at[0]", "at[1]", "0", "1.5", "-2", "3", "0.25"];
        return leaves[choices.choose(leaves.len() as u32) as usize].to_owned();
    }
    let mut part = || {
        let operators = choices.choose(operators);
        term(choices, operators)
    };
    let (a, b) = (part(), part());
    match choices.choose(24) {
        0 => format!("min({a}, {b})"),
        1 => format!("max({a}, {b}, x)"),
        2 => format!("hypot({a}, {b})"),
        3 => format!("atan2({a}, {b})"),
        4 => format!("pow({a}, {b})"),
        other @ 5..=15 => {
            let names =
                ["abs", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "ln", "floor"];
            format!("{}({a})", names[other as usize - 5])
        }
        16 => format!("ceil({a})"),
        17 => format!("-({a})"),
        other => {
            let operator = ["+", "-", "*", "/", "+", "-"][other as usize - 18];
            format!("({a}) {operator} ({b})")
        }
    }
}

/// A condition of one state.
fn condition(choices: &mut impl Choices, operators: u32, earlier: u32) -> String {
    if operators > 0 {
        let left = choices.choose(operators);
        let a = condition(choices, left, earlier);
        let b = condition(choices, operators - 1 - left, earlier);
        return match choices.choose(4) {
            0 => format!("!({a})"),
            1 => format!("({a}) || ({b})"),
            2 => format!("({a}) => ({b})"),
            _ => format!("({a}) && ({b})"),
        };
    }
    match choices.choose(12) {
        0 => "on".to_owned(),
        1 => "kind == green".to_owned(),
        2 => "kind != none".to_owned(),
        3 => "kind == last".to_owned(),
        4 => "last != blue".to_owned(),
        5 if earlier > 0 => NAMES[choices.choose(earlier) as usize].to_owned(),
        other => {
            let comparison = ["<", "<=", ">", ">=", "==", "!="][other as usize % 6];
            let (left, right) = (choices.choose(4), choices.choose(2));
            let (a, b) = (term(choices, left), term(choices, right));
            format!("{a} {comparison} {b}")
        }
    }
}

/// A file of random predicates and one task of them; `None` if that has a mistake.
pub(crate) fn module(choices: &mut impl Choices) -> Option<(String, Module)> {
    let mut text = STATE.to_owned();
    let names = 1 + choices.choose(NAMES.len() as u32);
    for (earlier, name) in (0..).zip(&NAMES[..names as usize]) {
        let operators = choices.choose(4);
        text += &format!("predicate {name} = {}\n", condition(choices, operators, earlier));
    }
    let operators = choices.choose(9);
    text += &format!("task t = {}\n", random::formula(choices, names, operators));
    let source = Source::new("random.tltl", text.as_str());
    check::file(&source).ok().map(|module| (text, module))
}

/// A place of the state in a row, with a number that the place can hold.
pub(crate) fn number(choices: &mut impl Choices, input: &str) -> f64 {
    let corners = [0.0, -0.0, 1.0, -1.0, 1.5, 3.0, f64::INFINITY, f64::NEG_INFINITY, 1e-310];
    match input {
        "on" => f64::from(choices.choose(2)),
        "kind" => f64::from(choices.choose(4)) - 1.0,
        "last" => f64::from(choices.choose(3)),
        "n" => f64::from(choices.choose(256)),
        "k" => [-3.0, 0.0, 2.0, 9_007_199_254_740_992.0][choices.choose(4) as usize],
        _ => match choices.choose(30) {
            corner @ 0..9 => f64::from(corners[corner as usize] as f32),
            9 => f64::NAN,
            other => f64::from(other) * 0.25 - 5.0,
        },
    }
}

/// The numbers of one input, in the type that its place has, at some stride.
enum Array {
    F64(Vec<f64>),
    F32(Vec<f32>),
    I64(Vec<i64>),
    U8(Vec<u8>),
    Bool(Vec<bool>),
    I8(Vec<i8>),
}

/// Spreads numbers over an array, so that the column with this stride is the numbers.
fn spread<T: Copy>(numbers: &[f64], stride: usize, fill: T, one: impl Fn(f64) -> T) -> Vec<T> {
    let mut array = vec![fill; numbers.len() * stride];
    for (i, &number) in numbers.iter().enumerate() {
        array[i * stride] = one(number);
    }
    array
}

impl Array {
    fn new(input: &str, numbers: &[f64], stride: usize) -> Self {
        match input {
            "y" => Self::F32(spread(numbers, stride, 7.0, |x| x as f32)),
            "k" => Self::I64(spread(numbers, stride, 7, |x| x as i64)),
            "n" => Self::U8(spread(numbers, stride, 7, |x| x as u8)),
            "on" => Self::Bool(spread(numbers, stride, true, |x| x == 1.0)),
            "kind" | "last" => Self::I8(spread(numbers, stride, 7, |x| x as i8)),
            _ => Self::F64(spread(numbers, stride, 7.0, |x| x)),
        }
    }

    /// The column of these numbers, from the end where `backwards`.
    fn column(&self, rows: usize, stride: usize, backwards: bool) -> Column<'_> {
        let stride = isize::try_from(stride).unwrap();
        let start = if backwards { (rows - 1) * stride.unsigned_abs() } else { 0 };
        let stride = if backwards { -stride } else { stride };
        let column = match self {
            Self::F64(array) => Column::strided(&array[..], start, stride, rows),
            Self::F32(array) => Column::strided(&array[..], start, stride, rows),
            Self::I64(array) => Column::strided(&array[..], start, stride, rows),
            Self::U8(array) => Column::strided(&array[..], start, stride, rows),
            Self::Bool(array) => Column::strided(&array[..], start, stride, rows),
            Self::I8(array) => Column::strided(&array[..], start, stride, rows),
        };
        column.unwrap()
    }
}

/// What the predicates say of all rows, or the first that is not a number.
fn by_rows(
    rowwise: &mut Rowwise<'_>,
    width: usize,
    numbers: &[f64],
    rows: usize,
) -> Result<Vec<Reading>, NotANumber> {
    let row = |row: usize| {
        let numbers = &numbers[row * width..][..width];
        rowwise.read(numbers).map_err(|predicate| NotANumber { row, predicate })
    };
    (0..rows).map(row).collect()
}

fn agree(
    text: &str,
    module: &Module,
    choices: &mut impl Choices,
    rows: usize,
) -> Result<(), TestCaseError> {
    let task = &module.tasks[0];
    let evaluator = Evaluator::new(module, task).unwrap();
    let width = evaluator.inputs().len();
    let names: Vec<_> = evaluator.inputs().iter().map(|input| input.name.as_str()).collect();
    let numbers: Vec<f64> =
        (0..rows * width).map(|at| number(choices, names[at % width])).collect();
    let backwards = choices.choose(2) == 1;
    let strides: Vec<_> = names.iter().map(|_| 1 + choices.choose(3) as usize).collect();
    let arrays = names.iter().enumerate().map(|(i, name)| {
        let mut column: Vec<f64> = numbers.iter().skip(i).step_by(width).copied().collect();
        if backwards {
            column.reverse();
        }
        Array::new(name, &column, strides[i])
    });
    let arrays: Vec<_> = arrays.collect();
    let columns: Vec<_> = arrays
        .iter()
        .zip(&strides)
        .map(|(array, &stride)| array.column(rows, stride, backwards))
        .collect();
    let expected =
        by_rows(&mut Rowwise::new(module, task, evaluator.inputs()), width, &numbers, rows);
    for columns in
        [Columns::new(rows, &columns).unwrap(), Columns::of_rows(rows, width, &numbers).unwrap()]
    {
        compare(text, module, &evaluator, &columns, &expected)?;
    }
    Ok(())
}

fn compare(
    text: &str,
    module: &Module,
    evaluator: &Evaluator,
    columns: &Columns<'_>,
    expected: &Result<Vec<Reading>, NotANumber>,
) -> Result<(), TestCaseError> {
    let (rows, width) = (columns.rows(), evaluator.propositions());
    let mut scratch = Scratch::default();
    let (mut labels, mut letters) = (vec![false; rows * width], vec![7; rows]);
    let mut rho = vec![0.0; rows * width];
    let results = [
        evaluator.labels(columns, &mut scratch, &mut labels),
        evaluator.letters(columns, &mut scratch, &mut letters),
        evaluator.rho(columns, &mut scratch, &mut rho),
    ];
    let robustness = evaluator.robustness(columns, &mut scratch);
    let readings = match expected {
        Err(nan) => {
            prop_assert_eq!(results, [Err(*nan); 3], "{}", text);
            prop_assert_eq!(robustness, Err(*nan), "{}", text);
            return Ok(());
        }
        Ok(readings) => readings,
    };
    prop_assert_eq!(results, [Ok(()); 3], "{}", text);
    for (row, reading) in readings.iter().enumerate() {
        let here = row * width..(row + 1) * width;
        prop_assert_eq!(&labels[here.clone()], &reading.holds[..], "{}row {}", text, row);
        let letter =
            reading.holds.iter().rev().fold(0, |bits, &holds| bits << 1 | u64::from(holds));
        prop_assert_eq!(letters[row], letter);
        let bits = |rho: &[f64]| rho.iter().map(|rho| rho.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&rho[here]), bits(&reading.robustness), "{}row {}", text, row);
    }
    let spec = &module.tasks[0].spec;
    let of = |p: u32, t: usize| readings[t].robustness[p as usize];
    prop_assert_eq!(robustness, Ok(semantics::robustness(spec, rows, of)), "{}", text);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    /// Some trajectories have more than two blocks.
    #[test]
    fn columns_say_what_rows_say(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        seed in any::<u64>(),
        rows in prop_oneof![4 => 1..8_usize, 1 => 200..700_usize],
    ) {
        if let Some((text, module)) = module(&mut Bytes(&bytes)) {
            agree(&text, &module, &mut random::Seeded(seed), rows)?;
        }
    }
}

fn evaluator(formula: &str) -> Evaluator {
    let module = check::formula(&Source::new("formula", formula)).unwrap();
    Evaluator::new(&module, &module.tasks[0]).unwrap()
}

#[test]
fn truth_values_are_one_and_minus_one_as_robustness() {
    let truths = [true, false];
    let column = [Column::from(&truths[..])];
    let columns = Columns::new(2, &column).unwrap();
    let mut rho = [0.0; 2];
    evaluator("F a").rho(&columns, &mut Scratch::default(), &mut rho).unwrap();
    assert_eq!(rho, [1.0, -1.0]);
    evaluator("F (x > 0.25)").rho(&columns, &mut Scratch::default(), &mut rho).unwrap();
    assert_eq!(rho, [0.75, -0.25]);
}

#[test]
fn a_trajectory_may_be_empty_and_a_task_may_read_nothing() {
    let mut scratch = Scratch::default();
    let none = Columns::of_rows(0, 1, &[]).unwrap();
    assert_eq!(evaluator("F a").robustness(&none, &mut scratch), Ok(f64::NEG_INFINITY));
    let nothing = evaluator("X true");
    let rows = |rows| Columns::new(rows, &[]).unwrap();
    nothing.labels(&rows(3), &mut scratch, &mut []).unwrap();
    assert_eq!(nothing.robustness(&rows(1), &mut scratch), Ok(f64::NEG_INFINITY));
    assert_eq!(nothing.robustness(&rows(2), &mut scratch), Ok(f64::INFINITY));
}

#[test]
fn columns_that_do_not_fit_are_refused() {
    let (long, short) = ([0.0; 3], [1_u8; 2]);
    let columns = [Column::from(&long[..]), Column::from(&short[..])];
    let error = Columns::new(3, &columns).unwrap_err();
    assert_eq!(error.to_string(), "2 numbers where 3 belong");
    assert!(Columns::of_rows(2, 2, &long).is_err());
    assert!(Columns::of_rows(usize::MAX, 2, &long).is_err());
    for (start, stride, rows) in
        [(0, 2, 3), (3, 1, 1), (2, -1, 4), (1, isize::MIN, 3), (0, 1, usize::MAX)]
    {
        assert!(
            Column::strided(&long[..], start, stride, rows).is_none(),
            "{start} {stride} {rows}"
        );
    }
    assert_eq!(Column::strided(&long[..], 9, 5, 0).map(|column| column.rows()), Some(0));
    assert_eq!(Column::strided(&long[..], 2, 0, 9).map(|column| column.rows()), Some(9));
}

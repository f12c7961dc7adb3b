//! Operations against the truth tables of small functions.

use super::{Bdd, Cube, Diagram, Operation};

/// The number of variables of the random functions.
const LEVELS: u32 = 5;
const ALL: u32 = u32::MAX;

/// Truth tables as bits, one for each valuation: deterministic, of every density.
fn tables() -> Vec<u32> {
    let mut x = 1_u32;
    let mut next = || {
        // xorshift32
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
        x
    };
    let random = (0..60).map(|i| match i % 3 {
        0 => next(),
        1 => next() & next() & next(),
        _ => next() | next() | next(),
    });
    [0, ALL, 0xaaaa_aaaa, 0xffff_0000].into_iter().chain(random).collect()
}

/// The function of a truth table, whose first bit is that of the valuation in which all is false.
fn function(diagram: &mut Diagram, table: u32) -> Bdd {
    let mut row: Vec<Bdd> = (0..1 << LEVELS).map(|v| Bdd::leaf(table >> v & 1)).collect();
    for level in (0..LEVELS).rev() {
        let (low, high) = row.split_at(row.len() / 2);
        row = low.iter().zip(high).map(|(&low, &high)| diagram.node(level, low, high)).collect();
    }
    row[0]
}

fn table(diagram: &Diagram, f: Bdd) -> u32 {
    (0..1 << LEVELS).map(|v| diagram.evaluate(f, &|level| v >> level & 1 == 1) << v).sum()
}

fn covers(cube: &Cube, v: u32) -> bool {
    cube.iter().all(|&(level, value)| (v >> level & 1 == 1) == value)
}

fn sum(cubes: &[Cube]) -> u32 {
    let holds = |v: u32| u32::from(cubes.iter().any(|cube| covers(cube, v)));
    (0..1 << LEVELS).map(|v| holds(v) << v).sum()
}

#[test]
fn operations_are_those_of_truth_tables_and_equal_functions_are_equal() {
    let mut diagram = Diagram::default();
    for a in tables() {
        let f = function(&mut diagram, a);
        assert_eq!(table(&diagram, f), a);
        let not = diagram.not(f);
        assert_eq!(not, function(&mut diagram, !a));
        for b in tables() {
            let g = function(&mut diagram, b);
            for (result, expected) in [
                (diagram.and(f, g), a & b),
                (diagram.or(f, g), a | b),
                (diagram.minus(f, g), a & !b),
            ] {
                assert_eq!(result, function(&mut diagram, expected), "{a:x} {b:x}");
            }
        }
    }
}

#[test]
fn what_is_constrained_depends_on_what_is_cared_for_alone() {
    let mut diagram = Diagram::default();
    for a in tables() {
        for care in tables().into_iter().filter(|&care| care != 0) {
            let [f, on, only] = [a, care, a & care].map(|table| function(&mut diagram, table));
            let constrained = diagram.constrain(f, on);
            assert_eq!(table(&diagram, constrained) & care, a & care);
            assert_eq!(diagram.constrain(only, on), constrained);
        }
    }
}

#[test]
fn sums_of_products_are_irredundant() {
    let mut diagram = Diagram::default();
    for a in tables() {
        for b in tables() {
            let (lower, upper) = (a & b, a | b);
            let [f, g] = [lower, upper].map(|table| function(&mut diagram, table));
            let cover = diagram.cover(f, g);
            let cubes = diagram.cubes(cover);
            let covered = sum(&cubes);
            assert_eq!((lower & !covered, covered & !upper), (0, 0), "{lower:x} {upper:x}");
            for (place, cube) in cubes.iter().enumerate() {
                let mut others = cubes.clone();
                others.remove(place);
                assert_ne!(lower & !sum(&others), 0, "{cube:?} is needed");
                for literal in 0..cube.len() {
                    let mut shorter = cube.clone();
                    shorter.remove(literal);
                    assert_ne!(sum(&[shorter]) & !upper, 0, "all of {cube:?} is needed");
                }
            }
            assert_eq!(diagram.products(cover), cubes.len());
            let covered = diagram.function(cover);
            assert_eq!(table(&diagram, covered), sum(&cubes));
            assert!(cubes.is_sorted_by_key(|cube| {
                cube.iter().map(|&(level, value)| (level, !value)).collect::<Vec<_>>()
            }));
        }
    }
}

/// The function that counts the variables which are true, and each of its leaves.
#[test]
fn leaves_are_numbers() {
    let mut diagram = Diagram::default();
    let mut counts = vec![Bdd::leaf(0); LEVELS as usize + 1];
    for level in (0..LEVELS).rev() {
        for count in 0..=level as usize {
            counts[count] = match level == LEVELS - 1 {
                true => diagram.node(level, Bdd::leaf(count as u32), Bdd::leaf(count as u32 + 1)),
                false => diagram.node(level, counts[count], counts[count + 1]),
            };
        }
    }
    let count = counts[0];
    assert_eq!(diagram.leaves(count), [0, 1, 2, 3, 4, 5]);
    for v in 0..1_u32 << LEVELS {
        assert_eq!(diagram.evaluate(count, &|level| v >> level & 1 == 1), v.count_ones());
    }

    let mut guards = Diagram::default();
    let of_count = &diagram.leaf_covers(&[count], &|_| true, &mut guards)[0];
    assert_eq!(of_count.iter().map(|(leaf, _)| *leaf).collect::<Vec<_>>(), diagram.leaves(count));
    for &(leaf, cover) in of_count {
        let function = guards.function(cover);
        let expected = (0..1_u32 << LEVELS).map(|v| u32::from(v.count_ones() == leaf) << v).sum();
        assert_eq!(table(&guards, function), expected);
        let direct = guards.cover(function, function);
        assert_eq!(guards.cubes(cover), guards.cubes(direct));
    }

    // Even or odd; the nodes that no root needs are left behind.
    let (parity, roots) = diagram.map_leaves(&[count], &|leaf| Bdd::leaf(leaf % 2));
    assert_eq!(parity.nodes().len(), 2 * LEVELS as usize - 1);
    let again = diagram.import(&parity, roots[0]);
    let difference = Operation::new(0);
    let difference = diagram
        .apply(difference, count, again, &mut |_, f, g| Some(Bdd::leaf(f.value()? - g.value()?)));
    assert_eq!(diagram.leaves(difference), [0, 2, 4]);
}

/// A chain of the levels 1 to 3 among five: operations on the valuations that it leaves, in which a
/// level of the chain is true only where those above it are.
#[test]
fn functions_of_a_chain_are_equal_where_they_agree_on_its_values() {
    let mut diagram = Diagram::default().chained(vec![(1, 3)]);
    let possible = |v: u32| matches!(v >> 1 & 7, 0 | 1 | 3 | 7);
    let care: u32 = (0..1 << LEVELS).filter(|&v| possible(v)).map(|v| 1 << v).sum();
    let mut known = std::collections::HashMap::new();
    let tables = tables();
    let functions: Vec<Bdd> =
        tables.iter().map(|&table| by_minterms(&mut diagram, table)).collect();
    for (&a, &f) in tables.iter().zip(&functions) {
        for (&b, &g) in tables.iter().zip(&functions) {
            for (result, expected) in [
                (diagram.and(f, g), a & b),
                (diagram.or(f, g), a | b),
                (diagram.minus(f, g), a & !b),
            ] {
                assert_eq!(table(&diagram, result) & care, expected & care, "{a:x} {b:x}");
                assert_eq!(*known.entry(expected & care).or_insert(result), result, "{a:x} {b:x}");
            }
        }
    }
    let all = diagram.variable(3);
    let levels = [1, 2, 3].map(|level| diagram.variable(level));
    assert_eq!(levels.into_iter().fold(Bdd::TRUE, |all, one| diagram.and(all, one)), all);
}

/// The function of a truth table as a disjunction of conjunctions of literals.
fn by_minterms(diagram: &mut Diagram, table: u32) -> Bdd {
    (0..1_u32 << LEVELS).filter(|v| table >> v & 1 == 1).fold(Bdd::FALSE, |sum, v| {
        let cube = (0..LEVELS).rev().fold(Bdd::TRUE, |cube, level| {
            let literal = diagram.literal((level, v >> level & 1 == 1));
            diagram.and(literal, cube)
        });
        diagram.or(sum, cube)
    })
}

/// Functions of two long chains that change at every level: too deep for the stack, and refused.
#[test]
fn an_operation_that_goes_too_deep_stops() {
    let levels = Diagram::MAX_LEVELS + 2;
    let mut diagram = Diagram::default().chained(vec![(0, levels - 1)]);
    let mut chain = |parity: u32| {
        (0..levels).rev().fold(Bdd::leaf(parity), |high, level| {
            diagram.node(level, Bdd::leaf((level + parity) % 2), high)
        })
    };
    let (f, g) = (chain(0), chain(1));
    diagram.and(f, g);
    assert!(diagram.is_too_deep() && diagram.is_exhausted());
}

/// As deep as it gets, on the small stack of a test's thread.
#[test]
fn no_operation_runs_out_of_stack() {
    let mut diagram = Diagram::default();
    let levels = 0..Diagram::MAX_LEVELS;
    let parity = |diagram: &mut Diagram, parts: u32| {
        let mut both = [Bdd::FALSE, Bdd::TRUE];
        for level in levels.clone().rev().filter(|level| level % 2 < parts) {
            let [even, odd] = both;
            both = [diagram.node(level, even, odd), diagram.node(level, odd, even)];
        }
        both[0]
    };
    let (f, g) = (parity(&mut diagram, 1), parity(&mut diagram, 2));
    let and = diagram.and(f, g);
    assert_eq!(diagram.level(and), 0);
    assert_eq!(diagram.constrain(g, f), diagram.constrain(and, f));
    let cover = diagram.cover(and, and);
    assert_eq!(diagram.products(cover), usize::MAX);
    let [mut conjunction, mut cube] = [Bdd::TRUE, Bdd::TRUE];
    for level in levels.clone().rev() {
        conjunction = diagram.node(level, Bdd::FALSE, conjunction);
        cube = if level % 2 == 0 { diagram.node(level, Bdd::FALSE, cube) } else { cube };
    }
    let sum = diagram.cover(conjunction, cube);
    assert_eq!(diagram.cubes(sum)[0].len(), levels.len() / 2);
}

#[test]
fn a_diagram_stops_growing_at_its_limit() {
    let mut diagram = Diagram::with_limit(1000);
    let mut all = Bdd::FALSE;
    // Pairs that stand far apart: exponential in their number.
    for level in 0..20 {
        let (a, b) = (diagram.variable(level), diagram.variable(level + 20));
        let pair = diagram.and(a, b);
        all = diagram.or(all, pair);
    }
    assert!(diagram.is_exhausted());
    assert!(diagram.nodes().len() < 1100);
}

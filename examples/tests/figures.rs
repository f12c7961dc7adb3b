//! Figures are the same bytes wherever they are drawn, and say what they are given.

use tltl_examples::chart::{self, Axis, Chart, Curve, Point, Row};
use tltl_examples::spread::{Panel, Spread};

/// Two charts with a curve and a level.
fn rows(title: &str) -> [Row; 1] {
    let point = |x: f64| Point { x, y: 0.5 / x, low: 0.4 / x, high: 0.6 / x };
    let curve = Curve { name: "a < b".to_owned(), points: [1.0, 2.0, 4.0].map(point).into() };
    let chart = |axis| Chart {
        title: "share".to_owned(),
        axis,
        curves: vec![curve.clone()],
        levels: vec![(0.25, "a quarter".to_owned())],
    };
    let charts = vec![chart(Axis::Share), chart(Axis::UpTo(2.0))];
    [Row { title: title.to_owned(), x: "steps".to_owned(), charts }]
}

#[test]
fn what_was_drawn_before_does_not_matter() {
    let draw = || chart::svg("a figure", &rows("F a && F b"), &[]);
    let first = draw();
    assert_eq!(first, draw());
}

#[test]
fn text_is_text() {
    let svg = chart::svg("a \"figure\"", &rows("F a && F b"), &["a remark".to_owned()]);
    for shown in ["F a &amp;&amp; F b<", ">a &lt; b<", ">a quarter<", ">a remark<", ">50 %<"] {
        assert!(svg.contains(shown), "{shown} in {svg}");
    }
    assert!(svg.starts_with("<svg viewBox=\"0 0 "), "it can be scaled");
    assert!(svg.contains("aria-label=\"a &quot;figure&quot;\""));
    assert!(svg.contains("fill=\"white\""), "it has a ground of its own");
}

/// Three curves that coincide: their letters stand at different places, and in the legend.
#[test]
fn curves_that_coincide_are_told_apart_by_letters() {
    let point = |x: f64| Point { x, y: 1.0, low: 1.0, high: 1.0 };
    let curve = |name: &str| Curve { name: name.to_owned(), points: [0.0, 2.0].map(point).into() };
    let chart = Chart {
        title: "success".to_owned(),
        axis: Axis::Share,
        curves: ["one", "two", "three"].map(curve).into(),
        levels: vec![(0.5, "half: of all".to_owned())],
    };
    let row = Row { title: String::new(), x: "steps".to_owned(), charts: vec![chart] };
    let svg = chart::svg("a figure", &[row], &[]);
    // Each twice on its curve and once in the legend, no two on one place.
    let lines = || svg.lines().filter(|line| line.contains("<circle"));
    let places: std::collections::BTreeSet<&str> = lines().collect();
    assert_eq!((lines().count(), places.len()), (9, 9));
    for letter in ["A", "B", "C"] {
        assert_eq!(svg.matches(&format!(">{letter}<")).count(), 3, "{letter}");
    }
    assert!(svg.contains(">half<"), "the level's name stands beside it");
}

/// A run ends with an episode, a few steps later than it was asked to.
#[test]
fn the_ends_of_an_axis_are_round() {
    let mut rows = rows("steps");
    for curve in rows[0].charts.iter_mut().flat_map(|chart| &mut chart.curves) {
        curve.points[2].x = 30_035.0;
    }
    let svg = chart::svg("a figure", &rows, &[]);
    for shown in [">15 k<", ">30 k<"] {
        assert!(svg.contains(shown), "{shown} in {svg}");
    }
}

#[test]
fn the_worst_is_a_number_or_never() {
    let panel = |worst: f64| Panel {
        title: ["losses", "two groups"].map(str::to_owned),
        axis: "%".to_owned(),
        range: (0.01, 100.0),
        bound: Some((0.1, "tolerated".to_owned())),
        groups: vec![vec![0.5, 2.25], vec![0.02, worst]],
    };
    let names = vec!["one".to_owned(), "other".to_owned()];
    let svg = Spread { names, panels: vec![panel(f64::INFINITY), panel(0.00025)] }.svg("losses");
    for shown in [">2.2<", ">never<", ">0.020<", ">tolerated<", ">≤ 0.01<"] {
        assert!(svg.contains(shown), "{shown} in {svg}");
    }
}

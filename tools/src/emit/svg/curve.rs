//! Lines with arrowheads, as SVG paths.
//!
//! Arrowheads are shapes of their own, not SVG markers: a marker needs an id, and ids clash when
//! drawings are put together.

use std::fmt::Write as _;

use super::number;
use crate::emit::layout::Route;

type Point = (f64, f64);

/// The length and half the width of an arrowhead. Lines end within it, so that they do not show at
/// its tip.
const HEAD: (f64, f64) = (7.5, 3.0);

/// A line and its arrowhead.
pub(super) struct Arrow {
    path: String,
    /// The tip, and the direction in which it points.
    head: (Point, Point),
}

impl Arrow {
    /// A straight, level arrow to the right.
    pub(super) fn line(from: Point, to: Point) -> Self {
        let path = format!("M{} H{}", point(from), number(to.0 - HEAD.0 + 1.0));
        Self { path, head: (to, (1.0, 0.0)) }
    }

    /// A self-loop over the top of a circle, `height` high.
    pub(super) fn loop_above((x, y): Point, radius: f64, height: f64) -> Self {
        // The feet are at 27° from the vertical (0.454 and 0.891 are sine and cosine), and the
        // lines from the feet to the control points lean outwards by 20° (tan 20° = 0.36). A cubic
        // curve rises to 3/4 of the height of its control points.
        let (foot_x, foot_y) = (0.454 * radius, 0.891 * radius);
        let reach = (height + radius - foot_y) / 0.75;
        let (bend_x, bend_y) = (foot_x + 0.36 * reach, foot_y + reach);
        let tip = (x + foot_x, y - foot_y);
        let (dx, dy) = unit((foot_x - bend_x, bend_y - foot_y));
        let end = (tip.0 - (HEAD.0 - 1.0) * dx, tip.1 - (HEAD.0 - 1.0) * dy);
        let path = format!(
            "M{} C{} {} {}",
            point((x - foot_x, y - foot_y)),
            point((x - bend_x, y - bend_y)),
            point((x + bend_x, y - bend_y)),
            point(end)
        );
        Self { path, head: (tip, (dx, dy)) }
    }

    /// An edge along its route: level within layers, bent in the gaps between them.
    pub(super) fn route(route: &Route) -> Self {
        let Route { start, end, .. } = *route;
        let short = HEAD.0 - 1.0;
        let (line_start, line_end) =
            if route.backward { (start.0 + short, end.0) } else { (start.0, end.0 - short) };
        let mut path = format!("M{}", point((line_start, start.1)));
        let mut at = (start.0, start.1);
        for pass in &route.passes {
            bend(&mut path, at, (pass.left, pass.y));
            at = (pass.right, pass.y);
        }
        let _ = write!(path, " H{}", number(line_end));
        let head = if route.backward { (start, (-1.0, 0.0)) } else { (end, (1.0, 0.0)) };
        Self { path, head }
    }

    /// The line and the head as elements of SVG.
    pub(super) fn draw(&self, colour: &str) -> String {
        let (tip, (dx, dy)) = self.head;
        let back = (tip.0 - HEAD.0 * dx, tip.1 - HEAD.0 * dy);
        let (side_x, side_y) = (-dy * HEAD.1, dx * HEAD.1);
        format!(
            "<path d=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.1\"/>\n\
             <path d=\"M{} L{} L{} Z\" fill=\"{colour}\"/>\n",
            self.path,
            point(tip),
            point((back.0 + side_x, back.1 + side_y)),
            point((back.0 - side_x, back.1 - side_y))
        )
    }
}

/// Goes on level to `from` and bends to `to`, level at both ends. A climb of less than a third of a
/// pixel is no bend.
fn bend(path: &mut String, from: Point, to: Point) {
    let middle = (from.0 + to.0) / 2.0;
    if (from.1 - to.1).abs() < 0.3 {
        return;
    }
    let _ = write!(
        path,
        " H{} C{} {} {}",
        number(from.0),
        point((middle, from.1)),
        point((middle, to.1)),
        point(to)
    );
}

/// The direction of a vector; downwards if it has no length.
fn unit((x, y): Point) -> Point {
    let length = (x * x + y * y).sqrt();
    if length == 0.0 { (0.0, 1.0) } else { (x / length, y / length) }
}

/// The coordinates of a point.
fn point((x, y): Point) -> String {
    format!("{} {}", number(x), number(y))
}

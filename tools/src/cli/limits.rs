//! The option `--budget`: limits of the work that replace the defaults of a command.

use std::num::{IntErrorKind, ParseIntError};
use std::str::FromStr;

use tltl_compiler::translate::Budget;

use crate::emit::labels::MOST_PRODUCTS;

/// The limits that the arguments set.
#[derive(clap::Args)]
pub(super) struct Limits {
    /// Limits of the work, instead of the defaults: `states=1000000,nodes=50000000`.
    ///
    /// There are `states`, `nodes` of decision diagrams (about 180 bytes each), `edges`, and
    /// `products` of one guard. `check` and `--format rust` have the limits of the
    /// macros: 16384 states, 1048576 nodes, 32768 edges, 4096 products. What is only shown has
    /// 262144 states, 4194304 nodes and 65536 products, and for `explain` and `run`, which ask for
    /// all guards, 1048576 edges.
    #[arg(long, value_delimiter = ',', value_name = "WHAT=NUMBER")]
    budget: Vec<Limit>,
}

/// One limit.
#[derive(Clone, Copy)]
struct Limit {
    what: What,
    most: usize,
}

/// What is limited.
#[derive(Clone, Copy)]
enum What {
    States,
    Nodes,
    Edges,
    Products,
}

impl Limits {
    /// The budget of what is only shown, with these limits.
    pub(super) fn shown(&self) -> Budget {
        self.over(Budget::SHOWN)
    }

    /// The budget of what asks for the guards of all edges, with these limits.
    pub(super) fn with_guards(&self) -> Budget {
        self.over(Budget { edges: MOST_PRODUCTS, ..Budget::SHOWN })
    }

    /// A budget with these limits in the place of its own.
    pub(super) fn over(&self, mut budget: Budget) -> Budget {
        for Limit { what, most } in &self.budget {
            *match what {
                What::States => &mut budget.states,
                What::Nodes => &mut budget.nodes,
                What::Edges => &mut budget.edges,
                What::Products => &mut budget.products,
            } = *most;
        }
        budget
    }
}

impl FromStr for Limit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (what, most) = text.split_once('=').unwrap_or((text, ""));
        let what = match what.trim() {
            "states" => What::States,
            "nodes" => What::Nodes,
            "edges" => What::Edges,
            "products" => What::Products,
            other => {
                return Err(format!(
                    "`{other}` has no limit; write `states`, `nodes`, `edges` or `products`"
                ));
            }
        };
        let most = most.trim().parse().map_err(|error: ParseIntError| match error.kind() {
            IntErrorKind::PosOverflow => format!("`{most}` is too large"),
            _ => format!("`{most}` is not a whole number"),
        })?;
        Ok(Self { what, most })
    }
}

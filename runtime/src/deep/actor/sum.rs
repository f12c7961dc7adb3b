//! Step 2 of composition for actors: the critics of skills, combined, and their slope in the actions.
//!
//! An actor follows slopes, so of the sum of critics both are needed: its values, for targets, and its
//! gradient in the components of an action, which is the sum of theirs.

use std::vec::Vec;

use super::trainer::{joined, matrix};
use crate::compose::Combine;
use crate::deep::Error;
use crate::deep::layers::{Layers, Pass, numbers};
use crate::deep::model::Batch;
use crate::network::Features;

/// The critic of a skill, ready to be evaluated.
pub(super) struct Part<'a, S> {
    pub features: &'a (dyn Features<S> + Sync),
    pub critic: Layers,
    /// The number of its heads.
    pub heads: usize,
    pub scale: f32,
}

/// States, each with an action: the number of the state, and the action within ±1.
pub(super) type Rows<'a> = &'a [(usize, &'a [f32])];

impl<S> Part<'_, S> {
    /// Through all layers.
    fn pass(&self, states: &[S], rows: Rows<'_>) -> Result<Pass, Error> {
        let mut batch = Batch::default();
        batch.encode(self.features, states).map_err(Error::Feature)?;
        let (rows, m) = (rows.iter().copied(), rows[0].1.len());
        Ok(self.critic.pass(joined(&batch, rows, m, &self.critic.device())))
    }

    /// The largest value of some states and actions.
    pub(super) fn largest(&self, states: &[S], rows: Rows<'_>) -> Result<f32, Error> {
        Ok(numbers(self.pass(states, rows)?.out).into_iter().fold(0.0, f32::max))
    }
}

/// The critics of skills, combined.
pub(super) struct Sum<'a, S> {
    pub parts: Vec<Part<'a, S>>,
    /// For each head of the product the skills that count there, and their heads.
    pub terms: Vec<Vec<(usize, usize)>>,
    pub combine: Combine,
}

impl<S> Sum<'_, S> {
    /// The values of all heads, indexed `row * heads + head`.
    pub(super) fn values(&self, states: &[S], rows: Rows<'_>) -> Result<Vec<f32>, Error> {
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        let of = self.outputs(&self.passes(states, rows)?);
        let all = (0..rows.len()).flat_map(|row| self.terms.iter().map(move |t| (row, t)));
        Ok(all.map(|(row, terms)| self.combined(&of, row, terms)).collect())
    }

    /// The values of each row's own head, and their slopes in the components of the actions, indexed
    /// `row * components + component`.
    pub(super) fn slopes(
        &self,
        states: &[S],
        rows: Rows<'_>,
        own: &[usize],
    ) -> Result<(Vec<f32>, Vec<f32>), Error> {
        let (passes, m) = (self.passes(states, rows)?, rows[0].1.len());
        let of = self.outputs(&passes);
        let mut weights: Vec<Vec<f32>> =
            self.parts.iter().map(|part| std::vec![0.0; rows.len() * part.heads]).collect();
        for (row, &head) in own.iter().enumerate() {
            let terms = &self.terms[head];
            let value = |&&term: &&(usize, usize)| self.value(&of, row, term);
            // Of a maximum the slope is that of the largest, the first of several.
            let largest = terms.iter().rev().max_by(|a, b| value(a).total_cmp(&value(b)));
            for term in terms {
                if self.combine != Combine::Max || Some(term) == largest {
                    let (i, head) = *term;
                    weights[i][row * self.parts[i].heads + head] = self.parts[i].scale;
                }
            }
        }
        let mut slopes = std::vec![0.0; rows.len() * m];
        for ((part, pass), weights) in self.parts.iter().zip(&passes).zip(weights) {
            let weights = matrix(weights, part.heads, &part.critic.device());
            let first = part.features.inputs();
            let own = numbers(part.critic.back_to_inputs(&pass.inputs, weights, first));
            slopes.iter_mut().zip(own).for_each(|(sum, slope)| *sum += slope);
        }
        let values = own.iter().enumerate();
        let values = values.map(|(row, &head)| self.combined(&of, row, &self.terms[head]));
        Ok((values.collect(), slopes))
    }

    fn passes(&self, states: &[S], rows: Rows<'_>) -> Result<Vec<Pass>, Error> {
        self.parts.iter().map(|part| part.pass(states, rows)).collect()
    }

    fn outputs(&self, passes: &[Pass]) -> Vec<Vec<f32>> {
        passes.iter().map(|pass| numbers(pass.out.clone())).collect()
    }

    /// What the skills of some terms say together.
    fn combined(&self, of: &[Vec<f32>], row: usize, terms: &[(usize, usize)]) -> f32 {
        let values = terms.iter().map(|&term| self.value(of, row, term));
        match self.combine {
            Combine::Max => values.reduce(f32::max).unwrap_or(0.0),
            Combine::Sum | Combine::NormalisedSum => values.sum(),
        }
    }

    /// What a skill says at its own head.
    fn value(&self, of: &[Vec<f32>], row: usize, (i, head): (usize, usize)) -> f32 {
        self.parts[i].scale * of[i][row * self.parts[i].heads + head]
    }
}

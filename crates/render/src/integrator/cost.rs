//! How much work each ray from the eye is: steps of techniques and tests of children.

use std::mem;

use nestray_core::counters::Counters;
use nestray_core::hit::Hit;

use super::{Integrate, note};
use crate::eye::{Seen, Start};
use crate::look::Look;
use crate::tracer::Tracer;

/// See [`Integrator::Cost`](crate::options::Integrator).
pub(crate) struct Cost;

impl Integrate for Cost {
    /// One ray at a time: only so is it known what each of them cost.
    fn trace(&mut self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>) {
        seen.clear();
        let mut all: Counters = mem::take(&mut tracer.scratch.counters);
        let mut hits: Vec<Hit> = Vec::new();
        for start in starts {
            let mut found = Seen::NOTHING;
            tracer.closest(&[start.ray], &mut hits);
            let counters = mem::take(&mut tracer.scratch.counters);
            let total = counters.total();
            found.cost = (total.all_steps() + total.all_tests()) as f32;
            all.add(&counters);
            if hits[0].is_some() {
                let point = tracer.point(&start.ray, &hits[0]);
                let look = Look::at(tracer.scene(), &point);
                note(&mut found, start, &start.ray, &hits[0], &point, &look);
            }
            seen.push(found);
        }
        tracer.scratch.counters = all;
    }
}

//! Where in a nest rays spend their time: what was counted there times its price.

use nestray_core::cost::CostModel;
use serde::Serialize;

use super::Part;
use crate::prices::test;

/// A part of a nest, and the nanoseconds that a ray of a mix spends in it, by rough prices.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spent {
    /// What it is, how many alike there are, and its settings.
    pub name: String,
    /// In steps and tests of its own.
    pub own: f64,
    /// And in all that is in it.
    pub total: f64,
    /// Parts in which something is spent.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inner: Vec<Self>,
}

impl Part {
    /// Where time is spent, if what rays did was [`counted`](Self::counted); `weight` is the share of
    /// the rays of a name in the mix.
    #[must_use]
    pub fn spent(&self, prices: &CostModel, weight: &dyn Fn(&str) -> f64) -> Spent {
        let inner: Vec<Spent> = self
            .children
            .iter()
            .map(|child| child.spent(prices, weight))
            .filter(|spent| spent.total > 0.0)
            .collect();
        let own = self.own_nanos(prices, weight);
        let total = own + inner.iter().map(|spent| spent.total).sum::<f64>();
        let count = if self.count > 1 { format!("{} × ", self.count) } else { String::new() };
        let settings =
            if self.settings.is_empty() { String::new() } else { format!(" {}", self.settings) };
        Spent { name: format!("{count}{}{settings}", self.kind), own, total, inner }
    }

    fn own_nanos(&self, prices: &CostModel, weight: &dyn Fn(&str) -> f64) -> f64 {
        let Some(doing) = &self.doing else { return 0.0 };
        let (step, test) = (prices.step(self.kind), self.mean_test(prices));
        let spent = doing
            .counted
            .iter()
            .map(|one| weight(&one.rays) * one.visits * (one.steps * step + one.tests * test));
        spent.sum()
    }

    /// The mean price of testing a child; packed triangles are no children.
    fn mean_test(&self, prices: &CostModel) -> f64 {
        let count: u64 = self.children.iter().map(|child| child.count).sum();
        if count == 0 {
            return prices.primitive("triangle");
        }
        let price = |child: &Self| child.count as f64 * test(prices, child.kind);
        self.children.iter().map(price).sum::<f64>() / count as f64
    }
}

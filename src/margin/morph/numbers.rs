//! Leaves of one structure, mixed number by number: there the space is Garg's own, and what lies between
//! two parametric leaves is a parametric leaf.

use serde::{Serialize, de::DeserializeOwned};
use toml::Value;

use super::super::lobes::LobeRecord;
use super::super::{MarginError, MarginKind, MarginSpec};

/// The leaves as margins of one structure; `None` when theirs differ.
pub(super) fn alike(specs: &[MarginSpec]) -> Result<Option<Vec<MarginSpec>>, MarginError> {
    let kind = specs[0].kind;
    if kind == MarginKind::Polygon || specs.iter().any(|spec| spec.kind != kind) {
        return Ok(None);
    }
    let plain: Vec<MarginSpec> =
        specs.iter().map(MarginSpec::spelt_out).collect::<Result<_, _>>()?;
    let same = match kind {
        MarginKind::Unilobed => {
            let extends = |spec: &MarginSpec| {
                [&spec.right, &spec.left]
                    .map(|s| [s.tail_depth, s.shoulder_height, s.drip_length].map(|x| x > 0.0))
            };
            plain.iter().all(|spec| extends(spec) == extends(&plain[0]))
        }
        _ => {
            let form = |lobe: &LobeRecord| (lobe.side, lobe.valley, lobe.flanks);
            let forms = |spec: &MarginSpec| spec.lobe.iter().map(form).collect::<Vec<_>>();
            plain.iter().all(|spec| forms(spec) == forms(&plain[0]))
        }
    };
    Ok(same.then_some(plain))
}

impl MarginSpec {
    /// The same with its shorthands written out: both sides as they are drawn, one record a lobe.
    fn spelt_out(&self) -> Result<Self, MarginError> {
        let mut spec = self.clone();
        let [right, left] = self.sides();
        (spec.right, spec.left, spec.asymmetry) = (right, left, self.asymmetry);
        if spec.kind == MarginKind::Lobed && spec.lobe.is_empty() {
            spec.lobe = self.lobing.records()?;
        }
        Ok(spec)
    }
}

/// The leaf between leaves of one structure, all else as `rest` has it.
pub(super) fn mixed(leaves: &[MarginSpec], shares: &[f64], rest: &MarginSpec) -> MarginSpec {
    let sum = |value: fn(&MarginSpec) -> f64| -> f64 {
        leaves.iter().zip(shares).map(|(leaf, share)| share * value(leaf)).sum()
    };
    MarginSpec {
        kind: leaves[0].kind,
        right: between(leaves, shares, |leaf| &leaf.right),
        left: between(leaves, shares, |leaf| &leaf.left),
        asymmetry: 1.0,
        midrib_bend_deg: sum(|leaf| leaf.midrib_bend_deg),
        base_inset: sum(|leaf| leaf.base_inset),
        lobe: between(leaves, shares, |leaf| &leaf.lobe),
        ..rest.clone()
    }
}

/// Settings of one structure with their numbers in between.
fn between<T: Serialize + DeserializeOwned>(
    leaves: &[MarginSpec],
    shares: &[f64],
    part: impl Fn(&MarginSpec) -> &T,
) -> T {
    let tree = |leaf: &MarginSpec| Value::try_from(part(leaf)).expect("settings are plain data");
    let trees: Vec<Value> = leaves.iter().map(tree).collect();
    let mixed = blend(&trees.iter().collect::<Vec<_>>(), shares);
    mixed.try_into().expect("the same settings with other numbers")
}

fn blend(trees: &[&Value], shares: &[f64]) -> Value {
    match trees[0] {
        Value::Float(_) => {
            let numbers = trees.iter().map(|tree| tree.as_float().unwrap_or(0.0));
            Value::Float(numbers.zip(shares).map(|(x, share)| x * share).sum())
        }
        Value::Table(table) => {
            let part = |key: &String| {
                let parts: Vec<&Value> = trees.iter().filter_map(|tree| tree.get(key)).collect();
                (key.clone(), blend(&parts, shares))
            };
            Value::Table(table.keys().map(part).collect())
        }
        Value::Array(list) => {
            let part = |i: usize| {
                let parts: Vec<&Value> = trees.iter().filter_map(|tree| tree.get(i)).collect();
                blend(&parts, shares)
            };
            Value::Array((0..list.len()).map(part).collect())
        }
        other => other.clone(),
    }
}

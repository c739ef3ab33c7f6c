//! A vein along the margin: at some distance (intramarginal) or on it (marginal).
//!
//! It is laid in pieces, each out of the secondary that has reached it and up to the next one, so that
//! its width comes from the veins that feed it.

use glam::DVec2;

use super::planter::{Planter, Vein};
use super::primary::Primaries;
use super::{GuideSpec, RimType};
use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::{NodeId, Rank, VeinKind};

/// A marginal vein keeps so many steps from the outline: room for a secondary to end in it.
const MARGINAL_STEPS: f64 = 1.2;

pub(super) struct Rim {
    rank: Rank,
    /// From base to apex, right and left; empty without a vein along the margin.
    lines: [Vec<DVec2>; 2],
    landings: [Vec<(f64, NodeId)>; 2],
}

fn of(side: f64) -> usize {
    usize::from(side < 0.0)
}

impl Rim {
    pub(super) fn new(spec: &GuideSpec, planter: &Planter<'_>) -> Self {
        let margin = planter.ground.margin();
        let (inset, kind) = match spec.rim {
            RimType::None => (0.0, VeinKind::Marginal),
            RimType::Marginal => (MARGINAL_STEPS * planter.step, VeinKind::Marginal),
            RimType::Intramarginal => {
                (spec.rim_inset * margin.length_mm(), VeinKind::Intramarginal)
            }
        };
        let mut rim = Self {
            rank: Rank { order: 2, kind },
            lines: [Vec::new(), Vec::new()],
            landings: [Vec::new(), Vec::new()],
        };
        if inset == 0.0 {
            return rim;
        }
        // The outline moved inwards, without what then lies too near to another part of it.
        let step = planter.step.max(0.25 * inset);
        let dense = polygon::resampled(margin.outline(), step);
        let edges = SegmentIndex::of_polygon(margin.outline());
        let n = dense.len();
        let tip = margin.apex();
        let apex = (0..n)
            .min_by(|&i, &j| dense[i].distance(tip).total_cmp(&dense[j].distance(tip)))
            .unwrap_or(0);
        for i in 0..n {
            let ahead = (dense[(i + 1) % n] - dense[(i + n - 1) % n]).normalize_or_zero();
            let p = dense[i] + ahead.perp() * inset;
            let near = edges.nearest(p, inset).map_or(inset, |(d2, _)| d2.sqrt());
            if near >= 0.97 * inset && edges.contains(p) && p.length() > 3.0 * inset {
                rim.lines[usize::from(i > apex)].push(p);
            }
        }
        rim.lines[1].reverse();
        let length = margin.length_mm();
        for line in &mut rim.lines {
            *line = super::curve::rounded(line, (0.004 * length / step).ceil() as usize);
        }
        rim
    }

    /// The beginning of a line, to where it meets the vein along the margin.
    pub(super) fn cut(&self, line: &[DVec2], side: f64) -> Vec<DVec2> {
        let mut kept = vec![line[0]];
        let rim = &self.lines[of(side)];
        for w in line.windows(2) {
            for r in rim.windows(2) {
                if polygon::segments_touch(w[0], w[1], r[0], r[1]) {
                    let (d, e) = (w[1] - w[0], r[1] - r[0]);
                    let across = d.perp_dot(e);
                    let share =
                        if across == 0.0 { 1.0 } else { (r[0] - w[0]).perp_dot(e) / across };
                    kept.push(w[0] + d * share.clamp(0.0, 1.0));
                    return kept;
                }
            }
            kept.push(w[1]);
        }
        kept
    }

    /// Notes a secondary that ends in the vein along the margin.
    pub(super) fn landed(&mut self, vein: &Vein, side: f64) {
        let (node, at, _) = vein.end();
        if let Some((along, _)) = self.nearest(at, side).filter(|_| vein.hit.is_none()) {
            self.landings[of(side)].push((along, node));
        }
    }

    /// The place of the vein along the margin nearest to `p`, and how far it is.
    fn nearest(&self, p: DVec2, side: f64) -> Option<(f64, f64)> {
        let rim = &self.lines[of(side)];
        (0..rim.len().saturating_sub(1))
            .map(|i| {
                let q = polygon::nearest_on_segment(rim[i], rim[i + 1], p);
                let part = q.distance(rim[i]) / rim[i].distance(rim[i + 1]).max(1e-300);
                (i as f64 + part, q.distance(p))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Lays it where nothing ends in it: past the branches that come to the margin.
    fn lay_past(&self, planter: &mut Planter<'_>, line: &[DVec2]) {
        let mut rest = line;
        while rest.len() > 4 {
            let Some(vein) = planter.lay_beside(rest, self.rank, 0.0) else {
                rest = &rest[1..];
                continue;
            };
            planter.join_hit(&vein);
            let (_, end, _) = vein.end();
            let distance = |i: &usize| rest[*i].distance_squared(end);
            let passed = (0..rest.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
            rest = &rest[passed.unwrap_or(0) + 1..];
        }
    }

    /// Lays it.
    pub(super) fn lay(mut self, planter: &mut Planter<'_>, primaries: &Primaries) {
        for side in [1.0, -1.0] {
            let line = self.lines[of(side)].clone();
            if line.len() < 4 {
                continue;
            }
            // Primaries that come near feed it as well.
            for lateral in primaries.laterals.iter().filter(|lateral| lateral.side == side) {
                let near =
                    lateral.vein.nodes.iter().zip(&lateral.vein.line).filter_map(|(&n, &p)| {
                        let (along, distance) = self.nearest(p, side)?;
                        (distance < 2.0 * planter.step).then_some((distance, along, n))
                    });
                if let Some((_, along, node)) = near.min_by(|a, b| a.0.total_cmp(&b.0)) {
                    self.landings[of(side)].push((along, node));
                }
            }
            let landings = &mut self.landings[of(side)];
            landings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let Some(&(lowest, node)) = landings.first() else {
                self.lay_past(planter, &line);
                continue;
            };
            // Down to the base, then from each one up to the next.
            let mut down: Vec<DVec2> = line[..=lowest as usize].to_vec();
            down.push(line[lowest as usize]);
            down.reverse();
            if let Some(vein) = planter.lay(node, &down, self.rank, 0.0) {
                planter.join_hit(&vein);
            }
            for (i, &(along, node)) in landings.iter().enumerate() {
                let end = landings.get(i + 1).map_or(line.len() as f64 - 1.0, |next| next.0);
                let mut piece = vec![line[along as usize]];
                piece.extend(&line[(along as usize + 1).min(line.len() - 1)..=end as usize]);
                if let Some(&(_, next)) = landings.get(i + 1) {
                    piece.push(planter.graph.positions()[next as usize]);
                }
                if let Some(vein) = planter.lay(node, &piece, self.rank, 0.0) {
                    planter.join_hit(&vein);
                }
            }
        }
    }
}

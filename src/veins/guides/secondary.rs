//! One secondary vein: how it runs and how it ends.

use glam::DVec2;

use super::course::{Course, decurrent};
use super::curve;
use super::ends::{arch_to, branch_to, festoon, fork};
use super::lobes;
use super::planter::{Planter, Vein};
use super::rows::Row;
use super::targets::Tip;
use super::tertiary::Bearer;
use super::{PrimaryType, RimType, SECONDARY, SecondaryType};

/// The least part of a secondary on its way to the margin that is worth laying, where it should reach
/// it.
const LEAST_CRASPEDODROMOUS: f64 = 0.6;

/// The same for others.
const LEAST: f64 = 0.45;

/// What one secondary is to be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    /// Where it leaves, as a share of its parent vein.
    pub(super) share: f64,
    pub(super) side: f64,
    pub(super) angle_deg: f64,
    pub(super) curvature: f64,
    /// To the next on its side (mm).
    pub(super) spacing: f64,
    /// −1 – 1, for what else varies.
    pub(super) sway: f64,
    /// The lobe that it is the vein of.
    pub(super) lobe: Option<Tip>,
}

impl Plan {
    pub(super) fn course(&self, parent: &Vein, share: f64) -> Course {
        let (_, from, ahead) = parent.at(share);
        Course {
            from,
            ahead,
            side: self.side,
            angle_deg: self.angle_deg,
            curvature: self.curvature,
        }
    }
}

/// A secondary that was laid.
pub(super) struct Laid {
    pub(super) vein: Vein,
    pub(super) arch: Option<Vein>,
}

impl Row<'_> {
    /// One secondary with its arches and branches, into the tooth `tip` if there is one for it.
    pub(super) fn secondary(
        &mut self,
        planter: &mut Planter<'_>,
        parent: &Vein,
        plan: &Plan,
        above: Option<&Laid>,
        tip: Option<Tip>,
    ) -> Option<Laid> {
        let ground = planter.ground;
        let spec = self.spec;
        let course = |share: f64| plan.course(parent, share);
        let mut share = plan.share.clamp(0.01, 0.99);
        let mut full = match plan.lobe {
            Some(lobe) => lobes::course(planter, parent, plan, lobe.at),
            None => course(share).to_margin(ground),
        };
        if let (Some(tip), None) = (tip, plan.lobe) {
            // Leave so as to keep the angle, then turn the rest of the way.
            let (_, _, ahead) = parent.at(share);
            let shift = (tip.at - full[full.len() - 1]).dot(ahead) / parent.length();
            let most = 0.4 * plan.spacing / parent.length();
            share = (share + (0.8 * shift).clamp(-most, most)).clamp(0.01, 0.99);
            full = curve::ended_at(&course(share).to_margin(ground), tip.at);
            self.taken.push(tip.at);
        }
        let line = match (spec.rim, spec.secondary) {
            (RimType::Intramarginal, _) => self.rim.cut(&full, plan.side),
            (_, SecondaryType::Craspedodromous) => full.clone(),
            _ if plan.lobe.is_some() => full.clone(),
            (_, SecondaryType::Eucamptodromous) => {
                course(share).along_margin(ground, spec.reach, 0.45)
            }
            (_, SecondaryType::Reticulodromous | SecondaryType::Cladodromous) => {
                curve::beginning(&full, 0.85 * spec.reach)
            }
            _ if above.is_none() => course(share).along_margin(ground, spec.reach, 0.3),
            _ => curve::beginning(&full, spec.reach * (1.0 + 0.1 * plan.sway)),
        };
        let craspedodromous =
            spec.secondary == SecondaryType::Craspedodromous || plan.lobe.is_some();
        let crosses = matches!(
            spec.primary,
            PrimaryType::Acrodromous | PrimaryType::Campylodromous | PrimaryType::Parallelodromous
        );
        let least = match (crosses, craspedodromous) {
            (true, _) => 0.02,
            (_, true) => LEAST_CRASPEDODROMOUS,
            _ => LEAST * curve::length(&full) / curve::length(&line),
        };
        let vein = self.attach(planter, parent, share, plan, &line, least)?;
        self.bearers.push(Bearer { vein: vein.clone(), ahead: parent.at(share).2 });
        if vein.hit.is_some() && crosses {
            planter.join_hit(&vein);
        }
        if spec.rim == RimType::Intramarginal || (spec.rim == RimType::Marginal && craspedodromous)
        {
            self.rim.landed(&vein, plan.side);
            return Some(Laid { vein, arch: None });
        }
        if plan.lobe.is_some() {
            return Some(Laid { vein, arch: None });
        }
        let arch = match spec.secondary {
            SecondaryType::Semicraspedodromous
            | SecondaryType::FestoonedSemicraspedodromous
            | SecondaryType::Brochidodromous
            | SecondaryType::FestoonedBrochidodromous => {
                above.and_then(|above| arch_to(planter, &vein, above, plan))
            }
            _ => None,
        };
        match spec.secondary {
            SecondaryType::Semicraspedodromous | SecondaryType::FestoonedSemicraspedodromous
                if above.is_some() =>
            {
                branch_to(planter, &vein, full[full.len() - 1]);
            }
            SecondaryType::Reticulodromous => fork(planter, &vein, plan, 3, 38.0, 0.9),
            SecondaryType::Cladodromous => fork(planter, &vein, plan, 2, 24.0, 0.97),
            _ => {}
        }
        let festooned = matches!(
            spec.secondary,
            SecondaryType::FestoonedSemicraspedodromous | SecondaryType::FestoonedBrochidodromous
        );
        if let (true, Some(arch), Some(upper)) =
            (festooned, &arch, above.and_then(|a| a.arch.as_ref()))
        {
            festoon(planter, arch, upper, plan);
        }
        Some(Laid { vein, arch })
    }

    /// Lays a line out of its parent, drawn along it for a while where secondaries are decurrent.
    fn attach(
        &self,
        planter: &mut Planter<'_>,
        parent: &Vein,
        share: f64,
        plan: &Plan,
        line: &[DVec2],
        least: f64,
    ) -> Option<Vein> {
        let back = 0.3 * self.spec.decurrence * plan.spacing.min(share * parent.length());
        if back > 2.0 * planter.step {
            let (node, base, _) = parent.at(share - back / parent.length());
            let bent = decurrent(line, base, back);
            if let Some(vein) = planter.lay(node, &bent, SECONDARY, least) {
                return Some(vein);
            }
        }
        planter.lay(parent.at(share).0, line, SECONDARY, least)
    }
}
